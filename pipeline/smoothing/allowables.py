"""The limits of a case as a synthesis keeps them: those of the checks, in SI."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from camwright.geometry.arrays import FULL_TURN
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.parts_section import Guide
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.checks.contact_strength import SHAKEDOWN, pressure_at_life, shakedown_factor
from camwright.pipeline.checks.guide_bushes import pv_limit
from camwright.pipeline.checks.spring_strength import Work, hardest_work
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.cycle.contact_setup import contact_width
from camwright.pipeline.cycle.part_loads import pin_stress_per_newton
from camwright.pipeline.cycle.turn import CREEP
from camwright.pipeline.follower.roller_motion import HOUR
from camwright.pipeline.follower.spring import case_spring
from camwright.pipeline.smoothing.scenario import LIFE_UNIT, Ratings

_TRAVEL_LEAST, _TRAVEL_MOST = 1e-6, 1.0  # m, of any spring


def ratings_of(case: Case) -> Ratings:
    """Limits of a case as the checks apply them."""
    limits, roller, guides = case.limits, case.roller, case.guides
    cam, ring = case.material(case.cam.material), case.material(roller.material)
    bearing, tool = roller.bearing, case.largest_tool
    wear = None
    if bearing.C is not None and limits.roller_life is not None:
        wear = bearing.C**3 * LIFE_UNIT / (limits.roller_life / HOUR)
    pressure, pressure_by = _least(pressure_limits(case))
    normal_force, normal_force_by = _least(force_limits(case))
    fastest = max(state.speed for state in case.load_cases)
    over = max(limits.overspeed or fastest, fastest, CREEP) / case.mechanism.gear_ratio
    return Ratings(
        roller_radius=roller.radius,
        offset=case.cam.offset,
        travel=_least(travel_limits(case))[0],
        pressure_angle=limits.pressure_angle,
        jam_index=limits.jam_index,
        curvature_ratio=limits.curvature_ratio,
        undercut_factor=limits.undercut_factor,
        hollow_radius=None if tool is None else TOOL_ALLOWANCE * tool,
        curvature_rate=limits.curvature_rate,
        cam_radius=limits.cam_radius,
        pressure=pressure,
        pressure_by=pressure_by,
        contact_width=contact_width(case),
        contact_modulus=contact_modulus(cam.E, cam.nu, ring.E, ring.nu),
        contact_force_margin=limits.contact_force_margin,
        overspeed=over,
        jump=limits.jump,
        jump_speed=limits.jump_speed * over,
        normal_force=normal_force,
        normal_force_by=normal_force_by or "roller_static",
        force_safety=limits.roller_static_safety if normal_force_by == "roller_static" else 1.0,
        dynamic_rating=bearing.C,
        life_force_cubed=wear,
        roller_spin=None
        if bearing.speed_limit is None
        else limits.roller_speed_share * bearing.speed_limit,
        bush_pressure=(guides.a.pressure_limit, guides.b.pressure_limit),
        bush_pv=(pv_limit(guides.a), pv_limit(guides.b)),
        bush_area=(_area(guides.a), _area(guides.b)),
    )


def pressure_limits(case: Case) -> dict[str, float]:
    """What each check allows as the greatest contact pressure, Pa, by its id."""
    limits, roller = case.limits, case.roller
    cam = case.material(case.cam.material)
    softer = min((cam, case.material(roller.material)), key=lambda card: card.yield_strength)
    shear_yield = softer.yield_strength / np.sqrt(3.0) / limits.shakedown_safety
    found = {"shakedown": SHAKEDOWN * shear_yield}
    if roller.friction is not None:
        found["shakedown_traction"] = shakedown_factor(roller.friction) * shear_yield
    if softer.endurance_pressure is not None:
        endurance = softer.endurance_pressure / limits.contact_safety
        found["contact_pressure"] = endurance
        found["edge_pressure"] = endurance / (1.0 if roller.crowned else limits.edge_factor)
    slope, intercept = cam.endurance_slope, cam.endurance_intercept
    if limits.target_life is not None and slope is not None and intercept is not None:
        ring = case.material(roller.material)
        fastest = max(max(state.speed, CREEP) for state in case.load_cases)
        turns = limits.target_life * fastest / case.mechanism.gear_ratio / FULL_TURN
        modulus = contact_modulus(cam.E, cam.nu, ring.E, ring.nu)
        allowed = pressure_at_life(turns, slope, intercept, modulus)
        found["contact_pressure_at_life"] = allowed / limits.contact_safety
    return found


def travel_limits(case: Case) -> dict[str, float]:
    """What each check of the spring allows as the greatest lift, m, by its id.

    A spring that is to be found anew, as its rate or preload is freed, allows what is said of it.
    """
    found = {}
    if case.spring.travel_max is not None:
        found["spring_travel"] = case.spring.travel_max
    spring = case_spring(case)
    if spring is None or {"spring_rate", "preload"} & set(case.smoothing.free):
        return found
    own = [case.spring.preload if s.preload is None else s.preload for s in case.load_cases]
    over: dict[str, Callable[[Work], float]] = {
        "spring_stress": lambda work: spring.static_use(work.greatest) - 1.0,
        "spring_fatigue": lambda work: (
            case.limits.spring_fatigue - spring.fatigue_safety(work.preload, work.greatest)
        ),
        "spring_solid": lambda work: (
            case.limits.spring_solid - spring.solid_clearance(work.preload, work.travel)
        ),
    }
    for name, excess in over.items():

        def at(travel: float, excess: Callable[[Work], float] = excess) -> float:
            return excess(hardest_work(case, spring, max(own), travel))

        if at(_TRAVEL_LEAST) < 0.0 < at(_TRAVEL_MOST):
            found[name] = float(brentq(at, _TRAVEL_LEAST, _TRAVEL_MOST, xtol=1e-12))
    return found


def force_limits(case: Case) -> dict[str, float]:
    """What each check allows as the greatest normal force, N, by its id."""
    bearing = case.roller.bearing
    found = {}
    if bearing.C0 is not None:
        found["roller_static"] = bearing.C0 / case.limits.roller_static_safety
    if bearing.radial_limit is not None:
        found["roller_radial"] = bearing.radial_limit
    per_newton, pin = pin_stress_per_newton(case), case.roller.pin
    if per_newton is not None and pin is not None:
        strength = case.limits.pin_share * case.material(pin.material).yield_strength
        found["roller_pin"] = strength / per_newton
    return found


def _least(limits: dict[str, float]) -> tuple[float | None, str]:
    """The least of some limits and whose it is."""
    if not limits:
        return None, ""
    name = min(limits, key=lambda each: limits[each])
    return float(limits[name]), name


def _area(guide: Guide) -> float:
    return guide.diameter * guide.length
