"""Ratings of a synthesis: limits of the case in the form of its constraints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import Array, Value
from camwright.geometry.lift import Jet
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    CONTACT_FORCE_MARGIN,
    KEYWAY_SAFETY,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
)
from camwright.pipeline.case.machine import Machine, machines
from camwright.pipeline.checks.assembly import machine_shaft_gap, room_beside_shaft
from camwright.pipeline.checks.cam_shape import lift, spring_travel
from camwright.pipeline.checks.check import Declaration, Measured
from camwright.pipeline.checks.contact_strength import (
    LoadCycles,
    endurance_allowed,
    life_turns,
    middle_pressure,
    passes,
    pressure_allowables,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE, PRESSURE
from camwright.pipeline.checks.extremes import on_both_tracks
from camwright.pipeline.checks.form_closure import preload_least, preload_pressure
from camwright.pipeline.checks.guide_strength import pivot_temperature, power_at
from camwright.pipeline.checks.guide_wear import pivot_expansion, seizure_temperature
from camwright.pipeline.checks.jump_and_jamming import cam_speed_without_jump, jump_speed
from camwright.pipeline.checks.key_strength import keyway_root, keyway_root_of
from camwright.pipeline.checks.registry import CHECKS, DECLARED
from camwright.pipeline.checks.roller_bearing import grease_life, grease_of
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers, presses
from camwright.pipeline.cycle.part_loads import edge_pressure_of
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solved_cam import ContourCam, numbers_of
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.follower.wound_wire import SpringWork
from camwright.pipeline.smoothing.scenario import Ratings

_TRAVEL_LEAST, _TRAVEL_MOST = 1e-6, 1.0  # m, of any spring
_LINE_LOADS = (1.0, 1e9)  # N/m, of any guide


def ratings_of(case: Case) -> Ratings:
    """Ratings of a case: its limits as bounds of the constraints of a synthesis, with the numbers
    of the machine.

    The wall over the bore limits a prime radius that is a variable, and the second of two discs,
    whose radius follows from the lift. The root of a keyway under a
    fit is left to finite elements: its bound is too wide.
    """
    states = machines(case)
    numbers, machine = numbers_of(case, states), states[0]
    varies = "prime_radius" in case.smoothing.free or case.cam.conjugate is not None
    held = machine.cam.held_radius if varies else None
    keyway, preload = keyway_root_of(numbers), machine.disc_preload
    ratings = Ratings(
        numbers | {"cam.held_radius": held, "guides.a.mouth": numbers["guides.a.mouth"]},
        drag=machine.follower.drag,
        keyway=None if presses(numbers) or np.isnan(keyway.per_stress) else keyway,
        grease=grease_of(machine, numbers),
        compliances=None if preload is None else preload.compliances,
    )
    return ratings.least(limits_of(case))


def limits_of(case: Case) -> dict[str, dict[str, float]]:
    """Limits of a case, SI, by constraint and, within it, by check; those outside the scope left
    out.

    The limit is the value of its row or, where the constraint is on a part or group, of the measure
    of the check.
    """
    states = machines(case)
    numbers, machine = numbers_of(case, states), states[0]
    limits: dict[str, dict[str, float]] = {PRESSURE: {}, NORMAL_FORCE: {}}
    for each in CHECKS:
        how = each.measured
        if how is None or how.kept is None or how.reduce == "top" or not each.concerns(machine):
            continue
        of_part = how.kept.unit or how.kept.group
        limit = how.limit_of_measure(numbers) if of_part else how.allowed(numbers).value
        if limit is not None:
            limits.setdefault(each.kept_at, {})[each.id] = float(limit)
        for stroke, stroke_limit in zip(
            how.strokes[1:], how.limits_of_strokes(numbers)[1:], strict=False
        ):
            limits[stroke.limit.id] = {each.id: float(stroke_limit)}
    limits[PRESSURE] |= pressure_allowables(machine, greatest_cycles(case))
    if (room := room_beside_shaft(machine)) is not None:
        limits.setdefault(CAM_RADIUS.id, {})[machine_shaft_gap.id] = room
    limits[spring_travel.id] = _travel_limit(case)
    if jump_speed.concerns(machine):
        limits[jump_speed.id] = {jump_speed.id: cam_speed_without_jump(numbers)}
    limits[KEYWAY_SAFETY.id] = {keyway_root.id: machine.limits[KEYWAY_SAFETY]}
    if case.scope.covers("guides"):
        for side, guide in machine.guides.both:
            seizure = seizure_temperature(guide, case.follower.stem_material)
            for name, key, limit in (
                ("guide_expansion", "guide_temperature", power_at(side, seizure, numbers)),
                ("guide_edge_pressure", "guide_edge_pressure", edge_load(machine, guide, ROOM)),
            ):
                if limit is not None:
                    limits.setdefault(f"{key}_{side}", {})[f"{name}_{side}"] = limit
    pivot = machine.pivot
    if case.scope.covers("pivot") and pivot is not None and pivot.bush is not None:
        pin = pivot.pin_material
        seizure = None if pin is None else seizure_temperature(pivot.bush, pin)
        if (limit := power_at("pivot", seizure, numbers)) is not None:
            limits.setdefault(pivot_temperature.kept_at, {})[pivot_expansion.id] = limit
    if machine.disc_preload is not None:
        limits[preload_least.id] = {preload_least.id: machine.limits[CONTACT_FORCE_MARGIN]}
        if (endured := endurance_allowed(numbers).value) is not None:
            limits[preload_pressure.id] = {preload_pressure.id: float(endured)}
    grease = grease_of(machine, numbers)
    if grease is not None:
        limits[grease_life.id] = {grease_life.id: grease.rating}
    return limits


def edge_load(machine: Machine, guide: Guide, temperature: float) -> float | None:
    """Line load of a guide, N/m, at which the pressure of the stem at the edge of its bore reaches
    the yield strength of the guide.

    None where the strength is not known, the guide has no clearance, or no line load between
    `_LINE_LOADS` reaches it.

    Parameters
    ----------
    machine : Machine     with the stem in the guide
    guide : Guide         one of its guides
    temperature : float   of the guide, K, at which the strength holds
    """
    strength, peak = guide.material.yield_strength_at(temperature), edge_pressure_of(machine, guide)
    if not strength > 0.0 or guide.clearance <= 0.0:
        return None

    def excess(log_load: float) -> float:
        return float(peak(np.exp([log_load]))[0]) / strength - 1.0

    ends = np.log(_LINE_LOADS[0]), np.log(_LINE_LOADS[1])
    if not excess(ends[0]) < 0.0 < excess(ends[1]):
        return None
    return float(np.exp(scipy.optimize.brentq(excess, *ends, xtol=1e-12)))


def softening(machine: Machine, guide: Guide, temperature: float) -> tuple[float, float]:
    """Shares of the limits of a guide that are left at a temperature, relative to room temperature:
    of its pressure limit, then of the line load at which its edge yields, see `edge_load`.

    A share is 1 where the limit is not known at either temperature: the check is then not
    evaluated.

    Parameters
    ----------
    machine : Machine     with the stem in the guide
    guide : Guide         one of its guides
    temperature : float   of the guide, K
    """
    cold, hot = (edge_load(machine, guide, each) for each in (ROOM, temperature))
    stated, left = guide.pressure_limit, guide.pressure_limit_at(temperature)
    pressure = 1.0 if not stated or left is None or np.isnan(left) else left / stated
    return pressure, 1.0 if cold is None or hot is None else hot / cold


def greatest_cycles(case: Case) -> LoadCycles:
    """Upper bound, over all lifts within the limits of a case, of the load cycles of cam and
    follower in the target life.

    A cycle of the follower is a pass of its most loaded point through the contact. Per radian of
    the cam the roller centre moves by at most r/cos(alpha): r, prime radius with the greatest
    allowed travel, or twice the prime radius where no check limits the travel; alpha, greatest
    allowed pressure angle.
    """
    turns, smoothing = life_turns(machines(case)), case.smoothing
    travel = min(travel_limits(case).values(), default=None)
    prime = max(case.cam.prime_radius, *(smoothing.prime_radius_range or ()), 0.0)
    radius = prime + (prime if travel is None else travel)
    angles = case.limits[PRESSURE_ANGLE], case.limits[RETURN_PRESSURE_ANGLE] or 0.0
    path = radius / np.cos(max(angles))
    return LoadCycles(turns, turns * max(passes(case.facing, path), 1.0))


class Surge(NamedTuple):
    """Increase of the hardest spring's forces by surge at a lift, N.

    travel: maximum lift, m; stress: of the greatest force; most, least: of greatest and least
    force, where the wire is fatigued most.
    """

    travel: float
    stress: float
    most: float
    least: float


def surge_of(solved: Solution) -> Surge | None:
    """Forces, N, that surge of the hardest spring adds over the speed range of a solved cam; None
    without a spring design or a speed sweep.
    """
    design, sweep = solved.machine.spring.design, solved.hardest_spring
    if design is None or sweep is None:
        return None
    top = ContourCam.at_top(solved.contour, solved.numbers)
    rest, hard = (float(np.ravel(each)[0]) for each in (top.hardest.greatest, top.hardest.preload))
    end, speed = np.unravel_index(
        np.argmax(design.fatigue_use(sweep.least, sweep.greatest)), sweep.least.shape
    )
    return Surge(
        travel=float(top.jet.lift[0]),
        stress=float(sweep.greatest.max()) - rest,
        most=float(sweep.greatest[end, speed]) - rest,
        least=float(sweep.least[end, speed]) - hard,
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class TopCam(LoadedCam):
    """Cam at maximum lift, with the surge of the last solved cam scaled to its lift."""

    last: Surge

    @property
    def _share(self) -> Array:
        return self.jet.lift / self.last.travel

    @property
    def stressed(self) -> SpringWork[Value]:
        rest = self.hardest
        return rest._replace(greatest=rest.greatest + self.last.stress * self._share)

    @property
    def fatigued(self) -> SpringWork[Value]:
        rest, last, share = self.hardest, self.last, self._share
        return rest._replace(
            preload=rest.preload + last.least * share, greatest=rest.greatest + last.most * share
        )


def scaled_limits(solved: Solution) -> dict[str, dict[str, float]]:
    """Normal force, N, and contact pressure, Pa, at which checks without a closed form would reach
    their limits: by group, `NORMAL_FORCE` or `PRESSURE`, and within it by check.

    Extrapolated from a solved cam: with its greatest force or pressure x and the utilisation u of a
    check that grows with x^p, the limit is x / u^(1/p). These checks depend on the whole turn, on
    the unbalance or on the stress below the surface.
    """
    greatest = {
        group: max(float(of(cycle).max()) for cycle in solved.cycles)
        for group, of in _GROUPS.items()
    }
    limits: dict[str, dict[str, float]] = {name: {} for name in greatest}
    for declared in CHECKS:
        if not declared.scales_with:
            continue
        group, power = declared.scales_with
        check, value = declared(solved), greatest[group]
        use = None if check is None else check.utilisation
        if use is not None and 0.0 < use < np.inf and value > 0.0:
            limits[group][declared.id] = value / use ** (1.0 / power)
    return limits


def corrected_ratings(ratings: Ratings, solved: Solution) -> Ratings:
    """Ratings with the limits that follow from a solved cam: of the lift by its surge, and those of
    `scaled_limits`, of which some are kept along the turn, see `weights_of`.
    """
    case = solved.case
    limits = limits_of(case)
    scaled = {
        group: {
            name: value
            for name, value in (limits[group] | scaled_limit).items()
            if name not in scaled_limit or DECLARED[name].along is None
        }
        for group, scaled_limit in scaled_limits(solved).items()
    }
    return ratings.least({spring_travel.id: _travel_limit(case, surge_of(solved))} | scaled)


class Weights(NamedTuple):
    """Greatest utilisation of the checks that are judged along the turn over that of the limit of
    their group, see `Correction`.

    by: check with the greatest use of the limit of a group, where the weight makes it; values: by
    group and load case, (n,).
    """

    by: Mapping[str, str]
    values: Mapping[str, Mapping[str, Array]]


def weights_of(solved: Solution, ratings: Ratings) -> Weights:
    """Weights of the contact pressure and of the normal force at the angles of a solved cam.

    With x of the group, its limit X and the utilisation u of a check, which grows with x^p and is
    distributed over the turn as its declaration says: u^(1/p) X/x, at least 1. The place of the
    greatest u is not that of the greatest x: a limit of the greatest x would press on other angles
    than the check.

    Parameters
    ----------
    ratings : Ratings   with the limits of the groups, see `corrected_ratings`
    """
    by, weighted = dict[str, str](), dict[str, Mapping[str, Array]]()
    for group, of in _GROUPS.items():
        loads = {cycle.load_case: of(cycle) for cycle in solved.cycles}
        most, limit = max(float(each.max()) for each in loads.values()), ratings.bounds.get(group)
        weights = {name: np.ones(each.size) for name, each in loads.items()}
        greatest = most
        for declared in CHECKS:
            if limit is None or declared.along is None or not declared.scales_with:
                continue
            grows_with, power = declared.scales_with
            check = declared(solved) if grows_with == group else None
            use = None if check is None else check.utilisation
            if use is None or not 0.0 < use < np.inf:
                continue
            along = {each.load_case: declared.along(solved, each) for each in solved.cycles}
            top = max(float(each.max()) for each in along.values())
            for name, load in loads.items():
                counts = load > LOADED_SHARE * most
                used = np.where(counts, use * along[name] / top, 0.0)
                equal = limit * used ** (1.0 / power)
                weights[name] = np.maximum(weights[name], equal / np.where(counts, load, 1.0))
                if equal.max() > greatest:
                    greatest, by[group] = float(equal.max()), declared.id
        weighted[group] = weights
    return Weights(by, weighted)


LOADED_SHARE = 0.05  # of the maximum: least load of a meaningful ratio
_GROUPS: Mapping[str, Callable[[Cycle], Array]] = {
    NORMAL_FORCE: lambda cycle: on_both_tracks(cycle, lambda one: one.loads.normal_force),
    PRESSURE: lambda cycle: on_both_tracks(cycle, middle_pressure),
}
"""Load of a group at each cam angle of a cycle (n,), N or Pa; of preloaded discs the greater
pressure of both.
"""


def _travel_limit(case: Case, surge: Surge | None = None) -> dict[str, float]:
    """Least of `travel_limits`, m, as one of the spring travel."""
    limits = travel_limits(case, surge)
    return {spring_travel.id: min(limits.values())} if limits else {}


def travel_limits(case: Case, surge: Surge | None = None) -> dict[str, float]:
    """Greatest lift, m, that each check at maximum lift allows, by id; a check that passes or fails
    at every lift in range is left out.

    The checks of the spring are left out where its rate or preload is a variable of the synthesis.

    Parameters
    ----------
    surge : Surge   forces that surge adds to the spring, of a solved cam; None: none, the limits by
                    stress and fatigue are then too high
    """
    states = machines(case)
    numbers, last = numbers_of(case, states), surge or Surge(1.0, 0.0, 0.0, 0.0)
    is_open = bool(case.smoothing.of_spring)
    allowed = {}
    for one in CHECKS:
        how = one.measured
        if how is None or how.reduce != "top" or how.kept is None or not one.concerns(states[0]):
            continue
        travel = None if is_open and one.part == "spring" else _travel(one, how, numbers, last)
        if travel is not None:
            allowed[one.id] = travel
    return allowed


def _travel(one: Declaration, how: Measured, numbers: Numbers, last: Surge) -> float | None:
    """Maximum lift, m, at which the demand of a check at maximum lift equals its limit, by root
    finding.

    None where a number that the check needs is not known, or where it does not change from passed
    to failed between the least and greatest lift tried, or the reach of the spring.

    Parameters
    ----------
    one : Declaration   the check
    how : Measured      its measure
    numbers : Numbers   of the machine, SI
    last : Surge        forces that surge adds to the spring, N
    """
    measure, limit = one.measure, how.allowed(numbers).value
    lacks = any(numbers.get(key) is None for key in how.needed)
    if measure is None or limit is None or lacks:
        return None
    if measure is lift:
        return float(limit)
    sign = -1.0 if one.sense == "at_least" else 1.0

    def excess(travel: float) -> float:
        jet = Jet(np.array([travel]), np.zeros(1), np.zeros(1))
        worst = measure(TopCam(jet, numbers, travel, last=last))
        return sign * float((np.asarray(how.value(worst, numbers)) - limit)[0])

    shape = None if numbers.case is None else numbers.case.spring.shape
    least, most = (_TRAVEL_LEAST, _TRAVEL_MOST) if shape is None else (0.0, float(shape.reach))
    if not excess(least) < 0.0 < excess(most):
        return None
    return float(scipy.optimize.brentq(excess, least, most, xtol=1e-12))
