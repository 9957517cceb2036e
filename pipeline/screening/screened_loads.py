"""Demand and limit of the checks of forces, guides and torque, of many designs at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import sampled_least
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.guide_strength import pv_limit
from camwright.pipeline.screening.design_arrays import Designs, Judged
from camwright.pipeline.screening.screened_cam import ScreenedCam

Side = Literal["a", "b"]


def _least_spring_force(cam: ScreenedCam) -> Array:
    """Spring force at minimum lift (m, 1), N."""
    return sampled_least(cam.spring_force)[:, None]


def _area(designs: Designs, side: Side) -> Array:
    """Projected area of a guide (m, 1), m^2."""
    return designs.value(f"guides.{side}.length") * designs.value(f"guides.{side}.diameter")


def guide_pressure(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        area = _area(designs, side)

        def pressure(cam: ScreenedCam) -> Array:
            load = cam.bearing.a if side == "a" else cam.bearing.b
            return demands.guide_pressure(load, area)

        return designs.worst(pressure), designs.value(f"guides.{side}.pressure_limit")[:, 0]

    return judged


def guide_pv(side: Side) -> Callable[[Designs], Judged]:
    def pv(designs: Designs, cam: ScreenedCam) -> Array:
        load = cam.rubbing.a if side == "a" else cam.rubbing.b
        means = demands.guide_pv(load, cam.velocity, _area(designs, side)).mean(axis=-1)
        return np.asarray(means)

    def judged(designs: Designs) -> Judged:
        guides = designs.machine.guides
        worst = np.max([pv(designs, cam) for cam in designs.cams], axis=0)
        return worst, pv_limit(guides.a if side == "a" else guides.b)

    return judged


def guide_speed(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        worst = designs.worst(lambda cam: np.abs(cam.velocity))
        return worst, designs.value(f"guides.{side}.speed_limit")[:, 0]

    return judged


def torque_after(designs: Designs, cam: ScreenedCam) -> Array:
    """Crank torque of engine and cam (m, n), N m."""
    before = np.zeros(1) if cam.state.torque is None else cam.state.torque
    return np.asarray(before - cam.torque / designs.case.mechanism.gear_ratio)


def torque_reduction(designs: Designs) -> Judged | None:
    shares = [
        (demands.ripple_reduction(cam.state.torque, torque_after(designs, cam)), required)
        for cam in designs.cams
        if cam.state.torque is not None and (required := cam.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)
