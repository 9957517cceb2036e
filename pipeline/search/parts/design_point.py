"""Point of a Pareto front, from a case.

`point_of` is a pure function of a case with plain numbers as result, for studies of many cases in
parallel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.contour import Contour
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import Verdict, in_order, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import KEYWAY_SAFETY, TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.key_strength import keyway_root
from camwright.pipeline.cycle.hub_history import hub_fatigue
from camwright.pipeline.follower.camshaft_loads import unbalance
from camwright.pipeline.preview import preview_case
from camwright.pipeline.records.redesign_document import PointRecord, RoughRecord, Shortfall
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.smoothing.constrained_synthesis import approached, synthesise
from camwright.pipeline.smoothing.multistart import continued
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.scenario import redrawn
from camwright.pipeline.smoothing.synthesis_problem import coarsened
from camwright.pipeline.solver import judged_at_corners
from camwright.pipeline.torque.torque import Torque

_BINDING_USE = 0.99  # utilisation
# Of the safety of the keyway root: least over the limit, for tolerance corners and error bar.
_ROOT_SPARE = 1.06
_COARSE_PROGRESS = 1e-3  # of the engine's ripple: progress at which a coarse search goes on


@dataclass(frozen=True)
class Rough:
    """Result of a coarse synthesis: residual ripple ratio, lengths m, mass kg.

    limit, utilisation: id and utilisation of the limit furthest exceeded; "" and 0: feasible;
    preload: N; binding: ids of the limits that are used up, the most used first.
    """

    feasible: bool
    ripple: float
    cam_radius: float
    mass: float
    limit: str = ""
    utilisation: float = 0.0
    prime_radius: float = 0.0
    preload: float = 0.0
    lift_max: float = 0.0
    binding: Sequence[str] = ()

    @classmethod
    def impossible(cls) -> Rough:
        """Result of a case without a cam."""
        return cls(feasible=False, ripple=1.0, cam_radius=0.0, mass=0.0)

    def as_record(self) -> RoughRecord:
        """JSON record, SI, which reads back equal."""
        return {
            "feasible": self.feasible,
            "ripple": self.ripple,
            "cam_radius": self.cam_radius,
            "mass": self.mass,
            "limit": self.limit,
            "utilisation": self.utilisation,
            "prime_radius": self.prime_radius,
            "preload": self.preload,
            "lift_max": self.lift_max,
            "binding": list(self.binding),
        }


@dataclass(frozen=True)
class DesignPoint:
    """Result of a previewed case, SI.

    ripple_before, ripple_left: standard deviation of the crank torque without and with the cam,
    N m; mass: of cam, follower and the half of the spring not part of the follower; shortfalls:
    blocking checks that fail, the worst first; open: ids of those that lack data, without those of
    a sign-off; binding: limits by decreasing shadow price. p0_max is NaN where the contour does not
    bound a body.
    """

    feasible: bool
    ripple_before: float
    ripple_left: float
    cam_radius: float
    mass: float
    prime_radius: float
    preload: float
    spring_rate: float
    lift_max: float
    pressure_angle_max: float
    normal_force_max: float
    p0_max: float
    shortfalls: tuple[Shortfall, ...]
    open: tuple[str, ...]
    binding: tuple[str, ...]

    @property
    def verdict(self) -> Verdict:
        """Verdict of the preview, without the certificate of a sign-off."""
        if self.shortfalls or not self.feasible:
            return "fail"
        return "incomplete" if self.open else "pass"

    def as_record(self) -> PointRecord:
        """Record for JSON, names with units."""
        return {
            "feasible": self.feasible,
            "verdict": self.verdict,
            "ripple_before_Nm": self.ripple_before,
            "ripple_left_Nm": self.ripple_left,
            "torque_reduction": 1.0 - self.ripple_left / self.ripple_before,
            "cam_radius_mm": in_unit(self.cam_radius, "mm"),
            "mass_g": in_unit(self.mass, "g"),
            "prime_radius_mm": in_unit(self.prime_radius, "mm"),
            "preload_N": self.preload,
            "spring_rate_N_per_mm": in_unit(self.spring_rate, "N/mm"),
            "lift_max_mm": in_unit(self.lift_max, "mm"),
            "pressure_angle_max_deg": in_unit(self.pressure_angle_max, "deg"),
            "normal_force_max_N": self.normal_force_max,
            "p0_max_MPa": in_unit(self.p0_max, "MPa") if np.isfinite(self.p0_max) else None,
            "failing": [each["check"] for each in self.shortfalls],
            "shortfalls": list(self.shortfalls),
            "open": list(self.open),
            "binding": list(self.binding),
        }


def point_of(case: Case) -> DesignPoint:
    """Point of a case by constrained synthesis with corrections, and preview.

    Each check is judged at its worst tolerance corner, unless one fails nominally, and where none
    fails the keyway root by finite elements, if its bound does not prove it.

    Raises
    ------
    CamError
        If there is no such cam.
    """
    trial = preview_case(case, corners=False)
    if not any(check.blocks and check.status == "fail" for check in trial.checks):
        trial = judged_at_corners(trial)
    drawn, contour, turn = trial.case, trial.contour, trial.cycles[0].turn
    rest, torque = turn.torque_after, turn.torque_before
    if rest is None or torque is None:
        raise InputError("engine", "missing", "specified: a redesign balances its torque")
    record = trial.synthesis
    blocking = [check for check in in_order(within_depth(trial.checks)) if check.blocks]
    failing = [check for check in blocking if check.status == "fail"]
    shortfalls = tuple(_shortfall(check) for check in failing)
    if not failing:
        shortfalls = _root_shortfall(trial)
    return DesignPoint(
        feasible=record is not None and record["feasible"],
        ripple_before=float(np.std(torque)),
        ripple_left=float(np.std(rest)),
        cam_radius=float(contour.radius_max().value),
        mass=_mass(drawn, contour),
        prime_radius=drawn.cam.prime_radius,
        preload=drawn.spring.preload,
        spring_rate=drawn.spring.rate,
        lift_max=float(trial.lift.highest.value),
        pressure_angle_max=float(contour.pressure_angle_max().value),
        normal_force_max=max(float(c.loads.normal_force.max()) for c in trial.cycles),
        p0_max=max(float(np.max(c.contact.p0)) for c in trial.cycles),
        shortfalls=shortfalls,
        open=tuple(check.id for check in blocking if check.status == "not_evaluated"),
        binding=() if record is None else tuple(price["limit"] for price in record["prices"]),
    )


def rough_point(case: Case, torques: Mapping[str, Torque], *, fine: bool = True) -> Rough:
    """Point of a case by the synthesis alone, without corrections and checks.

    The limit of the ripple is compared with its minimum afterwards: as a constraint it would hide
    the ripple of an infeasible case.

    Parameters
    ----------
    fine : bool   with the splines and cam angles of the case; else with those of a start, whose
                  fewer splines leave more ripple
    """
    every = problem_of(case, torques)
    problem = replace(every, left_out=frozenset({TORQUE_REDUCTION.id}))
    coarse = coarsened(problem)
    design = (
        continued(problem, approached(coarse))
        if fine
        else synthesise(coarse, worth=_COARSE_PROGRESS)
    )
    drawn, lift = redrawn(case, design.variables), design.lift()
    contour = drawn.contour(lift)
    uses = dict(design.utilisation)
    if every.ceiling is not None:
        uses[TORQUE_REDUCTION.id] = design.ripple / every.ceiling
    limit = max(uses, key=lambda name: uses[name])
    beyond = uses[limit] > 1.0
    return Rough(
        not beyond,
        design.ripple,
        float(contour.radius_max().value),
        _mass(case, contour),
        limit if beyond else "",
        uses[limit] if beyond else 0.0,
        drawn.cam.prime_radius,
        drawn.spring.preload,
        float(lift.highest.value),
        tuple(sorted((name for name in uses if uses[name] > _BINDING_USE), key=lambda n: -uses[n])),
    )


def _shortfall(check: Check) -> Shortfall:
    record = check.as_record()
    demand, limit, used = (_finite(record[key]) for key in ("demand", "limit", "utilisation"))
    return {
        "check": check.id,
        "title": check.title,
        "demand": demand,
        "limit": limit,
        "unit": check.unit,
        "utilisation": used,
    }


def _root_shortfall(trial: Trial) -> tuple[Shortfall, ...]:
    """Of the keyway root by finite elements, where the preview leaves it to them."""
    numbers = trial.solution.numbers
    left = [check for check in trial.checks if check.id == keyway_root.id and check.judged_at]
    solved = hub_fatigue(trial.contour, trial.cycles, numbers) if left else None
    least = _ROOT_SPARE * float(numbers.limit(KEYWAY_SAFETY))
    if solved is None or solved.governing.safety >= least:
        return ()
    return tuple(
        _shortfall(replace(check, demand=solved.governing.safety, limit=least)) for check in left
    )


def _finite(value: object) -> float | None:
    return value if isinstance(value, float) else None


def _mass(case: Case, contour: Contour) -> float:
    """Mass of cam, follower and half of the spring, kg."""
    cam, design = case.cam, case.spring.design
    disc = unbalance(contour, cam.bore_radius, cam.keyway, cam.width, cam.material.density).mass
    return float(disc + case.follower.mass + (0.0 if design is None else 0.5 * design.mass))
