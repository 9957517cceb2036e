"""Ratings of a synthesis: the limits of a case as the checks apply them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from camwright.geometry.arrays import FULL_TURN
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    JAM_INDEX,
    JUMP_SPEED,
    PRESSURE_ANGLE,
    ROLLER_LIFE,
    ROLLER_LOAD_SHARE,
    ROLLER_STATIC_SAFETY,
    SPRING_FATIGUE,
    SPRING_SOLID,
)
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.cam_shape import least_concave_radius
from camwright.pipeline.checks.contact_strength import LoadCycles, life_turns, pressure_allowables
from camwright.pipeline.checks.guide_strength import pv_limit
from camwright.pipeline.checks.part_strength import (
    allowed_pin_stress,
    fork_pressure,
    pin_shear,
    seat_pressure,
)
from camwright.pipeline.checks.roller_bearing import allowed_spin
from camwright.pipeline.checks.spring_strength import Work, hardest_work, relaxation_allowed
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.smoothing.constraints import ROWS
from camwright.pipeline.smoothing.scenario import Ratings

MILLION_TURNS = 1e6 * FULL_TURN  # rad
_TRAVEL_LEAST, _TRAVEL_MOST = 1e-6, 1.0  # m, of any spring


def ratings_of(case: Case) -> Ratings:
    """Ratings of a case.

    Raises
    ------
    InputError
        If the follower has no roller.
    """
    states, roller = machines(case), case.roller
    machine, bearing = states[0], roller.bearing
    limits, guides, life = machine.limits, machine.guides, machine.limits[ROLLER_LIFE]
    covers, cubed = case.scope.covers, None
    if bearing.C is not None and life is not None and covers("roller_bearing"):
        cubed = bearing.C**3 * MILLION_TURNS / life
    pressure, pressure_by = _least(pressure_allowables(machine, greatest_cycles(case)))
    normal_force, normal_force_by = _least(force_limits(case))
    by_rating = normal_force_by == "roller_static"
    # Without a stated over-speed the contact is kept at the fastest load case.
    over = highest_speed(states) / machine.gear_ratio
    kept = [row for row in ROWS if row is not JAM_INDEX or covers("guides")]
    pressures = (guides.a.pressure_limit, guides.b.pressure_limit)
    return Ratings(
        roller_radius=roller.radius,
        offset=machine.cam.offset,
        limits={row: value for row in kept if (value := limits[row]) is not None},
        travel=_least(travel_limits(case))[0],
        hollow_radius=least_concave_radius(case),
        pressure=pressure,
        pressure_by=pressure_by,
        contact_width=machine.contact_width,
        contact_modulus=machine.contact_modulus,
        crown_radius=roller.crown_radius,
        overspeed=over,
        jump_speed=limits[JUMP_SPEED] * over,
        normal_force=normal_force,
        normal_force_by=normal_force_by or "roller_static",
        force_safety=limits[ROLLER_STATIC_SAFETY] if by_rating else 1.0,
        dynamic_rating=bearing.C,
        bearing_drag=bearing.drag_torque or 0.0,
        bearing_friction_arm=(bearing.friction or 0.0) * roller.hub_radius,
        life_force_cubed=cubed,
        roller_spin=allowed_spin(machine) if covers("roller_bearing") else None,
        guide_pressure=pressures if covers("guides") else (None, None),
        guide_pv=((pv_limit(guides.a), pv_limit(guides.b)) if covers("guides") else (None, None)),
        guide_area=(guides.a.projected_area, guides.b.projected_area),
    )


def greatest_cycles(case: Case) -> LoadCycles:
    """Upper bound of the load cycles in the target life, for any lift within the limits.

    The roller centre moves by at most the greatest pitch radius over the cosine of the greatest
    pressure angle per cam angle.
    """
    turns, smoothing = life_turns(machines(case)), case.smoothing
    travel = _least(travel_limits(case))[0]
    prime = max(case.cam.prime_radius, *(smoothing.prime_radius_range or ()), 0.0)
    radius = prime + (prime if travel is None else travel)
    path = radius / np.cos(case.limits[PRESSURE_ANGLE])
    return LoadCycles(turns, turns * max(path / case.roller.radius - 1.0, 1.0))


def travel_limits(case: Case) -> dict[str, float]:
    """Greatest lift allowed by each check of the spring, m, by its id.

    Where rate or preload is free, the spring design is open and the spring travel alone limits
    the lift. Stress and fatigue are those without surge, which depends on the lift: a lower bound
    of their demands.
    """
    spring, limits = case.spring, case.limits
    allowed = {}
    if spring.travel_max is not None:
        allowed["spring_travel"] = spring.travel_max
    design = spring.design if case.scope.covers("spring") else None
    if design is None or {"spring_rate", "preload"} & set(case.smoothing.free):
        return allowed
    preload = max(machine.spring.preload for machine in machines(case))
    over: dict[str, Callable[[Work[float]], float]] = {
        "spring_stress": lambda work: design.static_use(work.greatest) - 1.0,
        "spring_fatigue": lambda work: (
            limits[SPRING_FATIGUE] - design.fatigue_safety(work.preload, work.greatest)
        ),
        "spring_solid": lambda work: (
            limits[SPRING_SOLID] - design.solid_clearance(work.preload, work.travel)
        ),
        "spring_coil_gap": lambda work: (
            design.minimum_gaps - design.gap_left(work.preload, work.travel)
        ),
        "spring_buckling": lambda work: (
            design.deflection(work.preload) + work.travel - design.buckling_deflection
        ),
        "spring_relaxation": lambda work: (
            (design.relaxed_preload(work.preload, work.greatest) or 0.0)
            - relaxation_allowed(spring)
        ),
    }
    for name, excess in over.items():

        def at(travel: float, excess: Callable[[Work[float]], float] = excess) -> float:
            return excess(hardest_work(spring, design, preload, travel))

        if at(_TRAVEL_LEAST) < 0.0 < at(_TRAVEL_MOST):
            allowed[name] = float(
                scipy.optimize.brentq(at, _TRAVEL_LEAST, _TRAVEL_MOST, xtol=1e-12)
            )
    return allowed


def force_limits(case: Case) -> dict[str, float]:
    """Greatest normal force allowed by each check that the scope covers, N, by its id."""
    roller, limits, covers = case.roller, case.limits, case.scope.covers
    bearing, pin = roller.bearing, roller.pin if covers("pin") else None
    fork = roller.fork if covers("fork") else None
    rated = {
        "roller_static": None if bearing.C0 is None else bearing.C0 / limits[ROLLER_STATIC_SAFETY],
        "roller_radial": bearing.radial_limit,
        "roller_static_radial": bearing.static_radial_limit,
        "roller_load_share": None if bearing.C is None else bearing.C * limits[ROLLER_LOAD_SHARE],
    }
    allowed = {}
    if covers("roller_bearing"):
        allowed = {name: force for name, force in rated.items() if force is not None}
    if pin is not None and roller.pin_stress_per_newton is not None:
        allowed["roller_pin"] = allowed_pin_stress(pin, limits) / roller.pin_stress_per_newton
    stresses = {}
    if pin is not None:
        stresses["roller_pin_shear"] = pin_shear(pin, limits)
        stresses["roller_pin_pressure"] = seat_pressure(roller, pin, limits)
    if pin is not None and fork is not None:
        stresses["cheek_pressure"] = fork_pressure(fork, pin, limits)
    for name, stress in stresses.items():
        if stress.allowed is not None:
            allowed[name] = stress.allowed / stress.per_newton
    return allowed


def _least(limits: dict[str, float]) -> tuple[float | None, str]:
    """Least limit and its name."""
    if not limits:
        return None, ""
    name = min(limits, key=lambda each: limits[each])
    return float(limits[name]), name
