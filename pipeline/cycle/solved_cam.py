"""Loaded cam of a solution: the unloaded cam of a contour at any cam angles, and a solved cycle."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import Extremum
from camwright.geometry.follower_path import Motion
from camwright.geometry.lift import Jet
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution


@dataclass(frozen=True, eq=False, kw_only=True)
class ContourCam(LoadedCam):
    """The unloaded cam of a contour, which at a tolerance corner is not that of the case."""

    contour: Contour

    @cached_property
    def motion(self) -> Motion:
        return self.contour.motion(self.jet)


def numbers_of(solution: Solution) -> Numbers:
    """Numbers of a solution, those of no load case."""
    machine = solution.machine
    known = {"cam.held_radius": machine.cam.held_radius}
    return Numbers(known, solution.case)


def on_contour(solution: Solution, theta: Array, order: int) -> ContourCam:
    """The unloaded cam of a solution at cam angles (...), rad; order: of its jet."""
    lift = solution.contour.lift
    jet, numbers = lift.jet(theta, order), numbers_of(solution)
    return ContourCam(jet, numbers, lift.highest.value, contour=solution.contour)


def at_top(solution: Solution) -> tuple[ContourCam, float]:
    """The unloaded cam of a solution at its maximum lift (1,), and the cam angle, rad."""
    top: Extremum = solution.contour.lift.highest
    lift = np.array([top.value])
    jet, numbers = Jet(lift, np.zeros(1), np.zeros(1)), numbers_of(solution)
    cam = ContourCam(jet, numbers, top.value, contour=solution.contour)
    return cam, float(np.mod(top.theta, FULL_TURN))
