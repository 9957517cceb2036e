"""What cams that hold their follower on both sides have in common in tests."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import InputError
from camwright.meshes.gmsh_mesher import session
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.check import Check
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.follower.crossover import Landing
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial

FORCES = ("axial_force", "normal_force", "cam_torque", "friction_force_a", "reaction_a")


def running_in(trial: Trial) -> tuple[Cycle, Machine]:
    """Cycle and machine of the load case "running"."""
    (cycle,) = (each for each in trial.cycles if each.load_case == "running")
    return cycle, cycle.machine


@dataclass(frozen=True)
class PreviewedFile:
    """Case file with its preview without tolerance corners, made once."""

    file: Path

    @cached_property
    def trial(self) -> Trial:
        """The preview."""
        return preview_case(read_case(self.file), corners=False)

    @property
    def running(self) -> tuple[Cycle, Machine]:
        """Cycle and machine of the load case "running"."""
        return running_in(self.trial)

    def check(self, name: str) -> Check:
        """The check of this id."""
        return next(each for each in self.trial.checks if each.id == name)


def ids_where_all_pass(trial: Trial) -> set[str]:
    """Ids of the checks of a preview, of which none of the design fails or lacks data."""
    must = [each for each in trial.checks if each.must_have and not each.judged_at]
    assert [each.id for each in must if each.status != "pass"] == []
    return {each.id for each in trial.checks}


def assert_refused(file: Path, old: str, new: str, message: str) -> None:
    """A case file with other words in one place is refused by a message that begins so."""
    text = file.read_text(encoding="utf-8")
    assert old in text
    with pytest.raises(InputError) as error:
        parse_case(text.replace(old, new, 1))
    assert str(error.value).startswith(message)


def volume_of(path: Path) -> float:
    """Volume, m3, of the only solid of a STEP file, by OpenCASCADE."""
    with session() as gmsh:
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        ((_, solid),) = gmsh.model.getEntities(3)
        return 1e-9 * float(gmsh.model.occ.getMass(3, solid))


def assert_as_closed_by_a_strong_spring(cycle: Cycle, machine: Machine) -> None:
    """Under a strong spring the first track alone carries: forces, guides and torque to 1e-9."""
    sprung = replace(machine.spring, preload=900.0, rate=20e3)
    closed = replace(machine.system, spring=sprung, held=False, second=None)
    args = (machine.stem, machine.guides, machine.cam_speed, uniform_turn(90))
    path = cycle.contour.pitch
    plate = guided_loads(path, closed, *args)
    held = guided_loads(path, replace(closed, held=True, second=machine.cam.second), *args)
    assert not plate.loads.separated.any()
    for name in FORCES:
        plain, own = (getattr(each.loads, name) for each in (plate, held))
        assert own == pytest.approx(plain, rel=1e-9, abs=1e-9), name


def landing_of(
    flight: Landing, falls: Callable[[float], float], gap: Callable[[float], float], speed: float
) -> tuple[float, float]:
    """Cam angle, rad, and speed against the track, m/s, of a landing by an integrator of events.

    Parameters
    ----------
    flight : Landing   of which take-off, tracks and speed of leaving are taken
    falls : callable   acceleration of the free follower towards the first track by cam angle, m/s2
    gap : callable     clearance between the tracks by cam angle, m
    speed : float      of the cam, rad/s
    """
    start, first = flight.take_off, flight.wall > 0.0

    def opening(theta: float) -> float:
        return speed * (gap(theta + 1e-5) - gap(theta - 1e-5)) / 2e-5

    def flown(time: float, state: Array) -> tuple[float, float]:  # distance from the first track
        return state[1], -falls(start + speed * time)

    def lands(time: float, state: Array) -> float:
        return float(state[0] - (0.0 if first else gap(start + speed * time)))

    lands.terminal, lands.direction = True, -1.0 if first else 1.0  # type: ignore[attr-defined]
    off = flight.leaving
    begin = (0.0, off) if flight.start > 0.0 else (gap(start), opening(start) - off)
    exact = solve_ivp(flown, (0.0, 0.1), begin, events=lands, rtol=1e-10, atol=1e-14)
    theta, moving = start + speed * exact.t_events[0][0], exact.y_events[0][0][1]
    return float(theta), float(-moving if first else moving - opening(theta))


def turned_by_friction(
    targets: Array, limit: Array, inertia: float, step: float, turns: int = 4
) -> Array:
    """Speed of the surface of a roller past its centre (n,), m/s, over the last of some turns after
    rolling: it follows the track as far as friction moves the mass of its rim. Where friction never
    suffices, what it begins with remains.

    Parameters
    ----------
    targets : array (n,)   speed of rolling, m/s
    limit : array (n,)     greatest friction, N
    inertia : float        moment of inertia over the radius squared, kg
    step : float           time between the angles, s
    """
    surface, speed = np.zeros(targets.size), float(targets[-1])
    for _ in range(turns):
        for k, (target, most) in enumerate(zip(targets.tolist(), limit.tolist(), strict=True)):
            change = most * step / inertia
            speed = min(max(target, speed - change), speed + change)
            surface[k] = speed
    return surface
