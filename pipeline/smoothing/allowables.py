"""Ratings of a synthesis: the limits of a case as the checks apply them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple, TypedDict

import numpy as np
import scipy

from camwright.geometry.arrays import Array, Value
from camwright.geometry.lift import Jet
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    GUIDE_GAP,
    JAM_INDEX,
    JUMP_SPEED,
    PRESSURE_ANGLE,
    ROLLER_STATIC_SAFETY,
)
from camwright.pipeline.case.machine import Machine, machines
from camwright.pipeline.checks import roller_bearing
from camwright.pipeline.checks.cam_shape import least_concave_radius, lift
from camwright.pipeline.checks.check import Declaration, Measured
from camwright.pipeline.checks.contact_strength import (
    FACE_PASSES,
    LoadCycles,
    life_turns,
    pressure_allowables,
)
from camwright.pipeline.checks.demands import CAM_TORQUE, NORMAL_FORCE, PRESSURE, TOOTH_TORQUE
from camwright.pipeline.checks.guide_strength import pv_limit
from camwright.pipeline.checks.guide_wear import greatest_temperatures, pv_of_wear
from camwright.pipeline.checks.key_strength import keyway_root_of
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.checks.roller_bearing import Grease, grease_of
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.part_loads import edge_pressure_of
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solved_cam import ContourCam, numbers_of
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.follower.guide_friction import thermal_resistance
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.follower.roller import Roller
from camwright.pipeline.follower.spring import SpringWork
from camwright.pipeline.follower.spring_kinds import GasSpring
from camwright.pipeline.smoothing.constraints import rows_kept
from camwright.pipeline.smoothing.scenario import Face, ModifiedLife, Ratings

_TRAVEL_LEAST, _TRAVEL_MOST = 1e-6, 1.0  # m, of any spring
_LINE_LOADS = (1.0, 1e9)  # N/m, of any guide


def ratings_of(case: Case) -> Ratings:
    """Ratings of a case."""
    states = machines(case)
    machine, covers, numbers = states[0], case.scope.covers, numbers_of(case, states)
    limits, guides = machine.limits, machine.guides
    roller, face = machine.roller, machine.face
    # Without a stated over-speed the contact is kept at the fastest load case.
    over = highest_speed(states) / machine.gear_ratio
    follower: Literal["roller", "face"] = "face" if roller is None else "roller"
    kept = [row for row in rows_kept(follower) if row is not JAM_INDEX or covers("guides")]
    gas = machine.spring.gas if covers("gas_spring") else None
    by_guide: _GuideRatings = {}
    if covers("guides"):
        by_guide = _of_guides(case, machine, fastest=over)
    torque, torque_by = _least(part_limits(case, CAM_TORQUE))
    tooth, tooth_by = _least(part_limits(case, TOOTH_TORQUE))
    shaft, cam = machine.camshaft, machine.cam
    band = cam.profile_tolerance
    by_roller: _RollerRatings = {}
    if roller is not None:
        by_roller = _of_roller(machine, roller)
    if roller is not None and covers("roller_bearing"):
        by_roller |= _of_bearing(numbers)
    ratings = Ratings(
        roller_radius=machine.follower.contact_radius or 0.0,
        face=None if face is None else Face(face.width, face.side_friction, face.pv_limit),
        offset=machine.cam.offset,
        limits={row: value for row in kept if (value := limits[row]) is not None},
        travel=_least(travel_limits(case))[0],
        hollow_radius=least_concave_radius(case),
        contact_width=machine.contact_width,
        contact_modulus=machine.contact_modulus,
        overspeed=over,
        fastest=over,
        jump_speed=limits[JUMP_SPEED] * over,
        guide_gap=limits[GUIDE_GAP],
        guide_mouth=machine.overhang_at_max_lift - 0.5 * guides.a.length,
        held_radius=cam.held_radius if "prime_radius" in case.smoothing.free else None,
        waves=None if band is None else (0.5 * band, cam.waviness_length),
        cam_torque=torque,
        cam_torque_by=torque_by,
        tooth_torque=tooth,
        tooth_torque_by=tooth_by,
        shaft_drag=0.0 if shaft is None else shaft.drag,
        keyway=keyway_root_of(machine),
        gas_slope=None if gas is None else _slope_limit(gas, over),
        **by_roller,
        **by_guide,
    )
    return _with_contact(ratings, case, {}, {})


def _with_contact(
    ratings: Ratings, case: Case, forces: Mapping[str, float], pressures: Mapping[str, float]
) -> Ratings:
    """Ratings with the least limits of contact pressure and normal force.

    forces, pressures: further limits, N and Pa, by their checks
    """
    estimated = pressure_allowables(machines(case)[0], greatest_cycles(case))
    pressure, pressure_by = _least({**part_limits(case, PRESSURE), **estimated, **pressures})
    force, force_by = _least({**part_limits(case, NORMAL_FORCE), **forces})
    by_rating = force_by == roller_bearing.roller_static.id
    return replace(
        ratings,
        pressure=pressure,
        pressure_by=pressure_by,
        normal_force=force,
        normal_force_by=force_by,
        force_safety=case.limits[ROLLER_STATIC_SAFETY] if by_rating else 1.0,
    )


class _RollerRatings(TypedDict, total=False):
    friction: float | None
    drag: Drag
    grease: Grease | None
    dynamic_rating: float | None
    life_force_cubed: float | None
    roller_spin: float | None
    modified: ModifiedLife
    modified_rate: float
    roller_spin_least: float | None


def _of_roller(machine: Machine, roller: Roller) -> _RollerRatings:
    """Ratings of the roller besides those of its bearing by speed, film and cleanliness."""
    return {
        "friction": roller.friction,
        "drag": roller.drag,
        "grease": grease_of(machine),
        "dynamic_rating": roller.bearing.C,
    }


def _of_bearing(numbers: Numbers) -> _RollerRatings:
    """Ratings of the roller bearing by life, speed, film and cleanliness."""
    life = limit_of(roller_bearing.roller_life, numbers)
    rated: _RollerRatings = {
        "roller_spin": limit_of(roller_bearing.roller_speed, numbers),
        "life_force_cubed": life,
        "roller_spin_least": limit_of(roller_bearing.bearing_lubrication, numbers),
    }
    rate = limit_of(roller_bearing.roller_modified_life, numbers)
    if rate is not None:
        rated["modified"] = ModifiedLife(
            float(numbers["roller.bearing.C"]),
            roller_bearing.cleanliness_load(numbers),
            float(numbers["roller.bearing.viscosity"]),
            float(numbers["roller.bearing.pitch_diameter"]),
        )
        rated["modified_rate"] = rate
    return rated


def limit_of(declared: Declaration, numbers: Numbers) -> float | None:
    """Limit of a check in terms of its measure, SI; None where it is not known or not kept."""
    return None if declared.measured is None else declared.measured.limit_of_measure(numbers)


class _GuideRatings(TypedDict, total=False):
    guide_pressure: tuple[float | None, float | None]
    guide_pv: tuple[float | None, float | None]
    guide_wear_pv: tuple[float | None, float | None]
    guide_area: tuple[float, float]
    guide_edge_load: tuple[float | None, float | None]
    guide_power: tuple[float | None, float | None]
    guide_power_by: tuple[str, str]
    guide_slope: tuple[float | None, float | None]
    guide_length: tuple[float, float]


def _of_guides(case: Case, machine: Machine, fastest: float) -> _GuideRatings:
    """Ratings of guides A and B; fastest: greatest cam speed of the load cases, rad/s."""
    both = machine.guides.both
    powers = [_least(power_limits(side, guide, case, machine)) for side, guide in both]
    edges = [edge_load(machine, guide, ROOM) for _, guide in both]
    (a, b) = (guide for _, guide in both)
    return {
        "guide_pressure": (a.pressure_limit, b.pressure_limit),
        "guide_pv": (pv_limit(a), pv_limit(b)),
        "guide_wear_pv": (pv_of_wear(a, machine.limits), pv_of_wear(b, machine.limits)),
        "guide_area": (a.projected_area, b.projected_area),
        "guide_edge_load": (edges[0], edges[1]),
        "guide_power": (powers[0][0], powers[1][0]),
        "guide_power_by": (powers[0][1], powers[1][1]),
        "guide_slope": (_slope_limit(a, fastest), _slope_limit(b, fastest)),
        "guide_length": (a.length, b.length),
    }


def _slope_limit(part: Guide | GasSpring, fastest: float) -> float | None:
    """Greatest lift per cam angle by the speed limit of a part, m/rad."""
    return None if part.speed_limit is None else part.speed_limit / fastest


def power_limits(side: str, guide: Guide, case: Case, machine: Machine) -> dict[str, float]:
    """Greatest mean friction power of a guide allowed by each of its checks, W, by its id.

    Without those that no lift can pass, below the ambient temperature.
    """
    resistance, ambient = thermal_resistance(guide), machine.guides.ambient_temperature
    if resistance is None or ambient is None:
        return {}
    allowed = greatest_temperatures(guide, case.follower.stem_material)
    return {
        f"{name}_{side}": (temperature - ambient) / resistance
        for name, temperature in allowed.items()
        if temperature > ambient
    }


def edge_load(machine: Machine, guide: Guide, temperature: float) -> float | None:
    """Line load in a guide whose edge pressure is the yield strength, N/m; None if not known."""
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
    """Shares of pressure limit and line load of a guide that are left at a temperature, K.

    1 where they are not known at the temperature: the check is then not evaluated.
    """
    cold, hot = (edge_load(machine, guide, each) for each in (ROOM, temperature))
    stated, left = guide.pressure_limit, guide.pressure_limit_at(temperature)
    pressure = 1.0 if not stated or left is None or np.isnan(left) else left / stated
    return pressure, 1.0 if cold is None or hot is None else hot / cold


def greatest_cycles(case: Case) -> LoadCycles:
    """Upper bound of the load cycles in the target life, for any lift within the limits.

    The roller centre moves by at most the greatest pitch radius over the cosine of the greatest
    pressure angle per cam angle.
    """
    turns, smoothing = life_turns(machines(case)), case.smoothing
    roller = case.roller_given
    if roller is None:
        return LoadCycles(turns, FACE_PASSES * turns)
    travel = _least(travel_limits(case))[0]
    prime = max(case.cam.prime_radius, *(smoothing.prime_radius_range or ()), 0.0)
    radius = prime + (prime if travel is None else travel)
    path = radius / np.cos(case.limits[PRESSURE_ANGLE])
    return LoadCycles(turns, turns * max(path / roller.radius - 1.0, 1.0))


class Surge(NamedTuple):
    """Rise of the forces of the hardest spring by its surge at a lift, N.

    travel: maximum lift, m; stress: of the greatest force; most, least: of greatest and least
    force, where the wire is fatigued most.
    """

    travel: float
    stress: float
    most: float
    least: float


def surge_of(solved: Solution) -> Surge | None:
    """Surge of the spring of a solved cam; None without a spring design."""
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
    """A cam at a maximum lift, with the surge of the last solved one, which grows with the lift."""

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


def scaled_limits(solved: Solution) -> tuple[dict[str, float], dict[str, float]]:
    """Normal force, N, and contact pressure, Pa, at the limit of further checks, by their ids.

    From their utilisation on a solved cam: they depend on the whole turn, on the unbalance or on
    the stress below the surface, and have no closed form by cam angle.
    """
    force = max(float(cycle.loads.normal_force.max()) for cycle in solved.cycles)
    pressure = max(float(cycle.surface.p0.max()) for cycle in solved.cycles)
    greatest = {"normal_force": force, "contact_pressure": pressure}
    limits: dict[str, dict[str, float]] = {name: {} for name in greatest}
    for declared in CHECKS:
        if not declared.scales_with:
            continue
        measure, power = declared.scales_with
        made, value = declared(solved), greatest[measure]
        use = None if made is None else made.utilisation
        if use is not None and 0.0 < use < np.inf and value > 0.0:
            limits[measure][declared.id] = value / use ** (1.0 / power)
    return limits["normal_force"], limits["contact_pressure"]


def corrected_ratings(ratings: Ratings, solved: Solution) -> Ratings:
    """Ratings with the limits that follow from a solved cam; see `surge_of`, `scaled_limits`."""
    case = solved.case
    forces, pressures = scaled_limits(solved)
    travel, _ = _least(travel_limits(case, surge_of(solved)))
    return _with_contact(replace(ratings, travel=travel), case, forces, pressures)


def travel_limits(case: Case, surge: Surge | None = None) -> dict[str, float]:
    """Greatest lift allowed by each check at maximum lift that is kept, m, by its id.

    Without those that no lift, or every lift of the law of the spring, passes. Where rate or
    preload is free, the spring design is open. Without a surge, which depends on the lift, stress
    and fatigue are a lower bound.
    """
    states = machines(case)
    numbers, last = numbers_of(case, states), surge or Surge(1.0, 0.0, 0.0, 0.0)
    is_open = bool({"spring_rate", "preload"} & set(case.smoothing.free))
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
    """Maximum lift, m, at which a check is at its limit; None where there is none."""
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
    least, most = (_TRAVEL_LEAST, _TRAVEL_MOST) if shape is None else (0.0, shape.reach)
    if not excess(least) < 0.0 < excess(most):
        return None
    return float(scipy.optimize.brentq(excess, least, most, xtol=1e-12))


def part_limits(case: Case, group: str) -> dict[str, float]:
    """Greatest force, torque or pressure, SI, allowed by each check of a group, by its id.

    Without those outside the scope.
    """
    states, limits = machines(case), {}
    numbers = numbers_of(case, states)
    for each in CHECKS:
        how = each.measured
        if how is None or how.kept is None or how.kept.group != group:
            continue
        limit = how.limit_of_measure(numbers) if each.concerns(states[0]) else None
        if limit is not None:
            limits[each.id] = limit
    return limits


def _least(limits: dict[str, float]) -> tuple[float | None, str]:
    """Least limit and its name."""
    if not limits:
        return None, ""
    name = min(limits, key=lambda each: limits[each])
    return float(limits[name]), name
