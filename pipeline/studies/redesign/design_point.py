"""One case to one point of a front. The full point is a pure function of its case.

That is the door for studies of many cases: `point_of` needs nothing but a case and gives plain
numbers, so that any scheduler may spread it over processes or machines.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.pipeline import solver as road
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.torque_balance import TORQUE_REDUCTION
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.follower.camshaft_loads import unbalance
from camwright.pipeline.follower.spring import case_spring
from camwright.pipeline.preview import look_ahead
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.fe_correction import redrawn
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.shadow_prices import prices
from camwright.pipeline.smoothing.synthesis_problem import coarsened

SIGNED_OFF = "signed_off"  # of a look ahead: that finite elements have not been asked


@dataclass(frozen=True)
class Rough:
    """A case on a coarse turn: worst ripple left over that without a cam, size m, mass kg."""

    feasible: bool
    ripple: float
    cam_radius: float
    mass: float

    @classmethod
    def impossible(cls) -> Rough:
        """What there is no cam of."""
        return cls(feasible=False, ripple=1.0, cam_radius=0.0, mass=0.0)


@dataclass(frozen=True)
class Point:
    """A case as closed forms foresee it, SI.

    ripple_before and ripple_left are the standard deviations of the crank torque, N m; mass is
    that of cam, follower and the half of the spring that the follower does not count. failing and
    open are the must-haves that fail or that a number is missing for, what only a run answers left
    out; binding are the limits that cost ripple, the dearest first. p0_max is NaN where there is no
    body.
    """

    feasible: bool
    ripple_before: float
    ripple_left: float
    cam_radius: float
    mass: float
    base_radius: float
    preload: float
    spring_rate: float
    lift_max: float
    pressure_angle_max: float
    normal_force_max: float
    p0_max: float
    failing: tuple[str, ...]
    open: tuple[str, ...]
    binding: tuple[str, ...]

    def as_record(self) -> dict[str, Any]:
        """For JSON: each name with its unit."""
        return {
            "feasible": self.feasible,
            "ripple_before_Nm": self.ripple_before,
            "ripple_left_Nm": self.ripple_left,
            "torque_reduction": 1.0 - self.ripple_left / self.ripple_before,
            "cam_radius_mm": 1e3 * self.cam_radius,
            "mass_g": 1e3 * self.mass,
            "pitch_base_radius_mm": 1e3 * self.base_radius,
            "preload_N": self.preload,
            "spring_rate_N_per_mm": 1e-3 * self.spring_rate,
            "lift_max_mm": 1e3 * self.lift_max,
            "pressure_angle_max_deg": float(np.degrees(self.pressure_angle_max)),
            "normal_force_max_N": self.normal_force_max,
            "p0_max_MPa": 1e-6 * self.p0_max if np.isfinite(self.p0_max) else None,
            "failing": list(self.failing),
            "open": list(self.open),
            "binding": list(self.binding),
        }


def point_of(case: Case) -> Point:
    """The case by constrained synthesis and closed forms, as `camwright check CASE` sees it.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    seen = look_ahead(case)
    design, drawn, contour = seen.design, seen.case, seen.contour
    rest, torque = seen.cycles[0].residual_torque, seen.cycles[0].torque_before
    if rest is None or torque is None:
        raise InputError("engine", "missing", "given: a redesign balances its torque")
    dearest = []
    if design is not None and seen.problem is not None and design.feasible:
        dearest = prices(design, seen.problem)
    blocking = [check for check in seen.checks if check.blocks and check.id != SIGNED_OFF]
    return Point(
        feasible=design is not None and design.feasible,
        ripple_before=float(np.std(torque)),
        ripple_left=float(np.std(rest)),
        cam_radius=float(contour.radius_max().value),
        mass=_mass(drawn, contour),
        base_radius=drawn.cam.pitch_base_radius,
        preload=drawn.spring.preload,
        spring_rate=drawn.spring.rate,
        lift_max=float(contour.pitch.lift.highest.value),
        pressure_angle_max=float(contour.pressure_angle_max().value),
        normal_force_max=max(float(c.loads.normal_force.max()) for c in seen.cycles),
        p0_max=max(float(np.max(c.contact.p0)) for c in seen.cycles),
        failing=tuple(check.id for check in blocking if check.status == "fail"),
        open=tuple(check.id for check in blocking if check.status == "not_evaluated"),
        binding=tuple(record["limit"] for record in dearest),
    )


def rough_point(case: Case, torques: Mapping[str, Torque]) -> Rough:
    """The same on a coarse turn, and no checks but the limits of the synthesis.

    What is asked of the ripple is compared with the least that is found: as a limit it would
    only keep the synthesis from telling how far off a hopeless case is.
    """
    problem = coarsened(problem_of(case, torques))
    design = synthesise(replace(problem, left_out=frozenset({TORQUE_REDUCTION})))
    contour = road.contour_of(redrawn(case, design), design.lift(problem.points))
    enough = problem.ceiling is None or design.ripple <= problem.ceiling
    return Rough(
        design.feasible and enough,
        design.ripple,
        float(contour.radius_max().value),
        _mass(case, contour),
    )


def _mass(case: Case, contour: Contour) -> float:
    cam = case.cam
    density = case.material(cam.material).density
    disc = unbalance(contour, cam.bore_radius, cam.keyway, cam.width, density).mass
    spring = case_spring(case)
    return float(disc + case.follower.mass + (0.0 if spring is None else 0.5 * spring.mass))
