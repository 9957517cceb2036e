"""Demand and limit of each check that screening judges, of many designs at once.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.base.units import celsius
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    CONTACT_FORCE_MARGIN,
    CONTACT_SAFETY,
    CURVATURE_RATIO,
    EDGE_FACTOR,
    GUIDE_GAP,
    GUIDE_LENGTH,
    JAM_INDEX,
    JUMP,
    JUMP_SPEED,
    MINIMUM_WALL,
    OVERSPEED,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    ROLLER_LIFE,
    ROLLER_LOAD_SHARE,
    ROLLER_SPEED_SHARE,
    ROLLER_STATIC_SAFETY,
    SHAKEDOWN_SAFETY,
    SPRING_FATIGUE,
    SPRING_SOLID,
    SPRING_SURGE,
    TOOL_RADIUS,
    UNDERCUT_FACTOR,
    WAVINESS,
    Limit,
)
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.checks.contact_strength import LeastLimit, LoadCycles, pressure_limits
from camwright.pipeline.checks.guide_strength import pv_limit
from camwright.pipeline.checks.spring_strength import (
    PRELOAD_TOLERANCE,
    RATE_TOLERANCE,
    Work,
    gas_pressure_at,
    hardest_work,
    torsion_strength,
    torsion_stress_at,
)
from camwright.pipeline.follower.roller_motion import rating_life, rolling_share
from camwright.pipeline.follower.spring_kinds import GasSpring, TorsionSpring
from camwright.pipeline.screening.design_arrays import Designs, Turns
from camwright.pipeline.screening.design_factors import WoundSprings

Judged = tuple[Array, Array | float | None]
"""Demand (m,) and limit (m,), SI; NaN and None are missing."""
Side = Literal["a", "b"]


def _to_all(designs: Designs) -> NDArray[np.bool_]:
    return np.ones(designs.count, dtype=bool)


class Screened(NamedTuple):
    """A check that screening judges.

    deviation: from the demand of the preview, over the greater of demand and limit, as
    `tests/verification/test_screening.py` measures it; applies: to which designs, (m,).
    """

    check: str
    judged: Callable[[Designs], Judged | None]
    deviation: float
    applies: Callable[[Designs], NDArray[np.bool_]] = _to_all


def _worst(designs: Designs, measure: Callable[[Turns], Array]) -> Array:
    """Greatest over load cases and cam angles (m,) of a measure (m, n)."""
    return np.max([sampled_greatest(measure(turns)) for turns in designs.turns], axis=0)


def _least(designs: Designs, measure: Callable[[Turns], Array]) -> Array:
    """Least over load cases and cam angles (m,) of a measure (m, n)."""
    return np.min([sampled_least(measure(turns)) for turns in designs.turns], axis=0)


def _pressure_angle(designs: Designs) -> Judged:
    allowed, on_return = designs.limit(PRESSURE_ANGLE), designs.limit(RETURN_PRESSURE_ANGLE)
    either = sampled_greatest(np.abs(designs.pressure_angle))
    if np.isnan(on_return).all():
        return either, allowed
    offset, slope = designs.value("cam.offset"), designs.jets[1]
    rise, back = (
        sampled_greatest(np.arctan2(np.abs(of_stroke - offset), designs.across))
        for of_stroke in (np.maximum(slope, 0.0), np.minimum(slope, 0.0))
    )
    steeper = back / on_return > rise / allowed  # false for NaN: no limit of the return
    demand = np.where(np.isnan(on_return), either, np.where(steeper, back, rise))
    return demand, np.where(steeper, on_return, allowed)


def _curvature_ratio(designs: Designs) -> Judged:
    convex = 1.0 / sampled_greatest(designs.pitch_curvature)
    return convex / designs.value("roller.radius")[:, 0], designs.limit(CURVATURE_RATIO)


def _undercut(designs: Designs) -> Judged:
    return designs.least_factor, designs.limit(UNDERCUT_FACTOR)


def _is_concave(designs: Designs) -> NDArray[np.bool_]:
    """Whether a cam has concave places; any tool fits a convex one."""
    return sampled_least(designs.pitch_curvature) < -np.finfo(float).tiny


def _concave_radius(designs: Designs) -> Judged:
    hollow = np.minimum(sampled_least(designs.pitch_curvature), -np.finfo(float).tiny)
    radius = designs.value("roller.radius")[:, 0] - 1.0 / hollow
    tool, stated = designs.limit(TOOL_RADIUS), designs.case.workshop.tool_radius
    largest = np.where(np.isnan(tool), np.nan if stated is None else stated, tool)
    return np.where(_is_concave(designs), radius, np.nan), TOOL_ALLOWANCE * largest


def _minimum_wall(designs: Designs) -> Judged:
    keyway = designs.case.cam.held_radius - designs.case.cam.bore_radius
    held = designs.value("cam.bore_radius")[:, 0] + keyway
    return sampled_least(designs.contour_radius) / held, designs.limit(MINIMUM_WALL)


def _cam_radius(designs: Designs) -> Judged:
    return sampled_greatest(designs.contour_radius), designs.limit(CAM_RADIUS)


def _spring_travel(designs: Designs) -> Judged:
    return designs.highest, designs.value("spring.travel_max")[:, 0]


def _guide_gap(designs: Designs) -> Judged:
    base = designs.value("cam.prime_radius"), designs.value("cam.offset")
    overhang, length = (
        designs.value("follower.overhang_at_max_lift"),
        designs.value("guides.a.length"),
    )
    mouth = (overhang - 0.5 * length)[:, 0]
    highest = np.sqrt(base[0] ** 2 - base[1] ** 2)[:, 0] + designs.highest + mouth
    over_cam = highest - sampled_greatest(designs.contour_radius)
    gap = np.minimum(over_cam, mouth - designs.value("roller.radius")[:, 0])
    return gap, designs.limit(GUIDE_GAP)


def _guide_length(designs: Designs) -> Judged:
    lengths = designs.value("guides.a.length") + designs.value("guides.b.length")
    spread = (designs.value("guides.spacing") + 0.5 * lengths)[:, 0]
    overhang = designs.value("follower.overhang_at_max_lift")[:, 0] + designs.highest
    return spread / overhang, designs.limit(GUIDE_LENGTH)


def _least_spring_force(turns: Turns) -> Array:
    """Spring force at minimum lift (m, 1), N."""
    return sampled_least(turns.loads.spring_force)[:, None]


def _contact_force_margin(designs: Designs) -> Judged:
    least = _least(designs, lambda turns: turns.loads.normal_force / _least_spring_force(turns))
    return np.maximum(least, 0.0), designs.limit(CONTACT_FORCE_MARGIN)


def _jump(designs: Designs) -> Judged:
    worst = _worst(
        designs,
        lambda turns: demands.greatest_unloading(
            turns.loads.inertia_force, turns.loads.closing_force
        ),
    )
    return worst, designs.limit(JUMP)


def _jump_speed(designs: Designs) -> Judged:
    """From the greatest quotient of unloading inertia and spring force, at the crank speed."""
    speeds = []
    for turns in designs.turns:
        use = demands.greatest_unloading(turns.loads.inertia_force, turns.loads.closing_force)
        greatest = np.maximum(sampled_greatest(use), 0.0)
        with np.errstate(divide="ignore"):
            speeds.append(turns.crank_speed[:, 0] / np.sqrt(greatest))
    over = np.where(np.isnan(designs.limit(OVERSPEED)), np.nan, designs.fastest)
    return np.min(speeds, axis=0), designs.limit(JUMP_SPEED) * over


def _contact_at_overspeed(designs: Designs) -> Judged:
    over = np.where(np.isnan(designs.limit(OVERSPEED)), np.nan, designs.fastest)[:, None]

    def force(turns: Turns) -> Array:
        inertia = (over / turns.crank_speed) ** 2 * turns.loads.inertia_force
        return demands.force_left(turns.loads.closing_force, inertia, _least_spring_force(turns))

    return _least(designs, force), designs.limit(CONTACT_FORCE_MARGIN)


def _jam_index(designs: Designs) -> Judged:
    worst = _worst(
        designs, lambda turns: demands.jam_outward(turns.loads.lift_slope, turns.loads.jam_index)
    )
    return worst, designs.limit(JAM_INDEX)


def _jam_index_friction_max(designs: Designs) -> Judged:
    return _worst(designs, lambda turns: turns.jam_index_max), designs.limit(JAM_INDEX)


def _pressure(_: Designs, turns: Turns) -> Array:
    return turns.p0


def _pressure_at_edge(designs: Designs, turns: Turns) -> Array:
    """The edge factor stands in the demand, the limit is that of the contact pressure."""
    return np.where(turns.edged, designs.limit(EDGE_FACTOR)[:, None], 1.0) * turns.p0


def _contact(
    name: str, safety: Limit, pressure: Callable[[Designs, Turns], Array] = _pressure
) -> Callable[[Designs], Judged]:
    """Contact pressure (m, n) against the least limit of cam and roller."""

    def judged(designs: Designs) -> Judged:
        limits = pressure_limits(designs.machine, LoadCycles(0.0, 0.0))
        demand = _worst(designs, lambda turns: pressure(designs, turns))
        return demand, _least_limit(designs, limits[name], safety, demand)

    return judged


def _least_limit(designs: Designs, least: LeastLimit, safety: Limit, demand: Array) -> Array:
    """Limit (m,) at the safety of each design; missing where a body lacks it, unless exceeded."""
    if least.value is None:
        return np.full(designs.count, np.nan)
    limit = least.value * designs.machine.limits[safety] / designs.limit(safety)
    return np.where(demand > limit, limit, np.nan) if least.missing else limit


def _greatest_force(designs: Designs) -> Array:
    return _worst(designs, lambda turns: turns.loads.normal_force)


def _bearing(key: str, designs: Designs) -> Array:
    return designs.value(f"roller.bearing.{key}")[:, 0]


def _roller_static(designs: Designs) -> Judged:
    force = _greatest_force(designs)
    safety = np.divide(
        _bearing("C0", designs), force, out=np.full_like(force, np.nan), where=force > 0.0
    )
    return safety, designs.limit(ROLLER_STATIC_SAFETY)


def _roller_load_share(designs: Designs) -> Judged:
    return _greatest_force(designs) / _bearing("C", designs), designs.limit(ROLLER_LOAD_SHARE)


def _roller_radial(designs: Designs) -> Judged:
    return _greatest_force(designs), _bearing("radial_limit", designs)


def _roller_static_radial(designs: Designs) -> Judged:
    return _greatest_force(designs), _bearing("static_radial_limit", designs)


def _spin(designs: Designs, turns: Turns) -> Array:
    """Speed of the roller on its pin (m, n), rad/s."""
    speed = designs.at_loads(designs.pitch_speed)
    return np.asarray(turns.cam_speed * rolling_share(speed, designs.value("roller.radius")))


def _roller_speed(designs: Designs) -> Judged:
    worst = _worst(designs, lambda turns: np.abs(_spin(designs, turns)))
    return worst, designs.limit(ROLLER_SPEED_SHARE) * _bearing("speed_limit", designs)


def _roller_life(designs: Designs) -> Judged:
    rating = _bearing("C", designs)
    known = np.where(np.isnan(rating), 1.0, rating)
    lives = [
        (rating_life(turns.loads.normal_force, _spin(designs, turns), known).seconds, each.duty)
        for turns in designs.turns
        if (each := turns.state).duty != 0.0
    ]
    if not lives:
        life = np.full(designs.count, np.nan)
    elif all(duty is None for _, duty in lives):
        life = np.min([each for each, _ in lives], axis=0)
    else:
        life = 1.0 / np.sum([(duty or 0.0) / each for each, duty in lives], axis=0)
    return np.where(np.isnan(rating), np.nan, life), designs.limit(ROLLER_LIFE)


def _area(designs: Designs, side: Side) -> Array:
    """Projected area of a guide (m, 1), m^2."""
    return designs.value(f"guides.{side}.length") * designs.value(f"guides.{side}.diameter")


def _reaction(turns: Turns, side: Side) -> Array:
    """Reaction of a guide as a point support (m, n), N."""
    return turns.loads.reaction_a if side == "a" else turns.loads.reaction_b


def _guide_pressure(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        area = _area(designs, side)

        def pressure(turns: Turns) -> Array:
            guides = turns.guides
            ratio = guides.bearing_a if side == "a" else guides.bearing_b
            return demands.guide_pressure(ratio * _reaction(turns, side), area)

        return _worst(designs, pressure), designs.value(f"guides.{side}.pressure_limit")[:, 0]

    return judged


def _guide_pv(side: Side) -> Callable[[Designs], Judged]:
    def pv(designs: Designs, turns: Turns) -> Array:
        guides = turns.guides
        load = (guides.rubbing_a if side == "a" else guides.rubbing_b) * _reaction(turns, side)
        means = demands.guide_pv(load, turns.loads.velocity, _area(designs, side)).mean(axis=-1)
        return np.asarray(means)

    def judged(designs: Designs) -> Judged:
        guides = designs.machine.guides
        worst = np.max([pv(designs, turns) for turns in designs.turns], axis=0)
        return worst, pv_limit(guides.a if side == "a" else guides.b)

    return judged


def _guide_speed(side: Side) -> Callable[[Designs], Judged]:
    def judged(designs: Designs) -> Judged:
        worst = _worst(designs, lambda turns: np.abs(turns.loads.velocity))
        return worst, designs.value(f"guides.{side}.speed_limit")[:, 0]

    return judged


def _profile_waviness(designs: Designs) -> Judged:
    band, length = designs.value("cam.profile_tolerance"), designs.value("cam.waviness_length")
    along = designs.at_loads(designs.pitch_speed * designs.undercut_factor)

    def share(turns: Turns) -> Array:
        speed = turns.cam_speed * along
        added = demands.waviness_force(designs.value("follower.mass"), 0.5 * band, speed, length)
        force = turns.loads.normal_force
        return np.divide(added, force, out=np.full_like(force, np.inf), where=force > 0.0)

    worst = np.max([share(turns).max(axis=-1) for turns in designs.turns], axis=0)
    return worst, designs.limit(WAVINESS)


def torque_after(designs: Designs, turns: Turns) -> Array:
    """Crank torque of engine and cam (m, n), N m."""
    before = np.zeros(1) if turns.state.torque is None else turns.state.torque
    return np.asarray(before - turns.loads.cam_torque / designs.case.mechanism.gear_ratio)


def _torque_reduction(designs: Designs) -> Judged | None:
    shares = [
        (demands.ripple_reduction(turns.state.torque, torque_after(designs, turns)), required)
        for turns in designs.turns
        if turns.state.torque is not None and (required := turns.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)


def _of_spring(
    judged: Callable[[Designs, WoundSprings, Work[Array]], Judged],
) -> Callable[[Designs], Judged | None]:
    """Of the hardest spring in tolerance of each design."""

    def of_designs(designs: Designs) -> Judged | None:
        wound = designs.wound_spring
        if wound is None:
            return None
        preload = np.max([turns.state.preload[:, 0] for turns in designs.turns], axis=0)
        work = hardest_work(designs.case.spring, wound, preload, designs.highest)
        return judged(designs, wound, work)

    return of_designs


def _spring_stress(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.stress(work.greatest) / design.static_strength, 1.0


def _spring_fatigue(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return 1.0 / design.fatigue_use(work.preload, work.greatest), designs.limit(SPRING_FATIGUE)


def _spring_solid(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.solid_clearance(work.preload, work.travel), designs.limit(SPRING_SOLID)


def _spring_coil_gap(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.gap_left(work.preload, work.travel), design.minimum_gaps


def _spring_solid_stress(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.solid_stress(work.rate), design.static_strength


def _spring_buckling(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return (design.deflection(work.preload) + work.travel) / design.buckling_deflection, 1.0


def _spring_rate(designs: Designs, design: WoundSprings, _: Work[Array]) -> Judged:
    rate = designs.value("spring.rate")[:, 0]
    return np.abs(design.rate / rate - 1.0), designs.case.spring.rate_tolerance or RATE_TOLERANCE


def _spring_relaxation(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    lost = design.relaxed_preload(work.preload, work.greatest)
    allowed = designs.case.spring.preload_tolerance or PRELOAD_TOLERANCE
    return np.full(designs.count, np.nan) if lost is None else np.asarray(lost), allowed


def _spring_surge(designs: Designs, design: WoundSprings, _: Work[Array]) -> Judged:
    turns_per_second = designs.fastest / designs.case.mechanism.gear_ratio / FULL_TURN
    return design.surge_frequency / turns_per_second, designs.limit(SPRING_SURGE)


def _of_gas(
    demand: Callable[[Designs, GasSpring], Array], allowed: str
) -> Callable[[Designs], Judged | None]:
    """Of a gas spring, against the limit of its maker."""

    def of_designs(designs: Designs) -> Judged | None:
        gas = designs.case.spring.gas
        if gas is None:
            return None
        return demand(designs, gas), getattr(gas, allowed)

    return of_designs


def _gas_pressure(designs: Designs, gas: GasSpring) -> Array:
    return gas_pressure_at(designs.case.spring, gas, designs.highest)


def _gas_speed(designs: Designs, _: GasSpring) -> Array:
    return _worst(designs, lambda turns: np.abs(turns.loads.velocity))


def _gas_temperature(designs: Designs) -> Judged | None:
    gas = designs.case.spring.gas
    if gas is None:
        return None
    warm, limit = (
        None if each is None else celsius(each) for each in (gas.temperature, gas.temperature_limit)
    )
    return np.full(designs.count, np.nan if warm is None else warm), limit


def _of_torsion(
    demand: Callable[[Array, Array], Array], allowed: Callable[[TorsionSpring], float | None]
) -> Callable[[Designs], Judged | None]:
    """Of the bending stress of a torsion spring at zero and maximum lift."""

    def of_designs(designs: Designs) -> Judged | None:
        spring = designs.case.spring
        if spring.torsion is None:
            return None
        stress = torsion_stress_at(spring, spring.torsion, designs.highest)
        figure = np.full(designs.count, np.nan) if stress is None else demand(*stress)
        return figure, allowed(spring.torsion)

    return of_designs


SCREENED: tuple[Screened, ...] = (
    Screened("pressure_angle", _pressure_angle, 0.0001),
    Screened("curvature_ratio", _curvature_ratio, 0.0001),
    Screened("undercut", _undercut, 0.0001),
    Screened("concave_radius", _concave_radius, 0.0001, _is_concave),
    Screened("minimum_wall", _minimum_wall, 0.0001),
    Screened("cam_radius", _cam_radius, 0.0001),
    Screened("spring_travel", _spring_travel, 0.0001),
    Screened("guide_gap", _guide_gap, 0.0001),
    Screened("guide_length", _guide_length, 0.0001),
    Screened("torque_reduction", _torque_reduction, 0.001),
    Screened("contact_force_margin", _contact_force_margin, 0.02),
    Screened("jump", _jump, 0.003),
    Screened("jump_speed", _jump_speed, 0.003),
    Screened("contact_at_overspeed", _contact_at_overspeed, 0.02),
    Screened("jam_index", _jam_index, 0.01),
    Screened("jam_index_friction_max", _jam_index_friction_max, 0.01),
    Screened("contact_pressure", _contact("contact_pressure", CONTACT_SAFETY), 0.001),
    # A crown that is longer than the contact: the edge factor sets in between two samples.
    Screened(
        "edge_pressure", _contact("contact_pressure", CONTACT_SAFETY, _pressure_at_edge), 0.05
    ),
    Screened("shakedown", _contact("shakedown", SHAKEDOWN_SAFETY), 0.001),
    Screened("roller_static", _roller_static, 0.005),
    Screened("roller_load_share", _roller_load_share, 0.005),
    Screened("roller_radial", _roller_radial, 0.005),
    Screened("roller_static_radial", _roller_static_radial, 0.005),
    Screened("roller_speed", _roller_speed, 0.0002),
    Screened("roller_life", _roller_life, 0.03),
    Screened("guide_speed_A", _guide_speed("a"), 0.002),
    Screened("guide_speed_B", _guide_speed("b"), 0.002),
    Screened("guide_pressure_A", _guide_pressure("a"), 0.1),
    Screened("guide_pressure_B", _guide_pressure("b"), 0.1),
    Screened("guide_pv_A", _guide_pv("a"), 0.03),
    Screened("guide_pv_B", _guide_pv("b"), 0.03),
    Screened("profile_waviness", _profile_waviness, 0.05),
    Screened("spring_stress", _of_spring(_spring_stress), 0.1),
    Screened("spring_fatigue", _of_spring(_spring_fatigue), 0.1),
    Screened("spring_solid", _of_spring(_spring_solid), 0.0001),
    Screened("spring_coil_gap", _of_spring(_spring_coil_gap), 0.0001),
    Screened("spring_solid_stress", _of_spring(_spring_solid_stress), 0.0001),
    Screened("spring_buckling", _of_spring(_spring_buckling), 0.0001),
    Screened("spring_rate", _of_spring(_spring_rate), 0.0001),
    Screened("spring_relaxation", _of_spring(_spring_relaxation), 0.0001),
    Screened("spring_surge", _of_spring(_spring_surge), 0.0001),
    Screened("gas_pressure", _of_gas(_gas_pressure, "pressure_limit"), 0.0001),
    Screened("gas_stroke", _of_gas(lambda designs, _: designs.highest, "stroke"), 0.0001),
    Screened("gas_speed", _of_gas(_gas_speed, "speed_limit"), 0.002),
    Screened("gas_temperature", _gas_temperature, 0.0),
    Screened("torsion_stress", _of_torsion(lambda _, most: most, torsion_strength), 0.0001),
    Screened(
        "torsion_fatigue",
        _of_torsion(lambda least, most: most - least, lambda torsion: torsion.stress_range),
        0.0001,
    ),
)
"""Checks that screening judges, in the order of the calculation."""
