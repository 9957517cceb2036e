"""Checks of ripple reduction and energy balance."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    ENERGY_CLOSURE,
    FRICTION_BALANCE,
    SPEED_REDUCTION,
    TORQUE_REDUCTION,
)
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import Extreme, worst_case
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution

# Exact for lift times slope on a quintic piece: degree 9.
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)


# A gentler lift lowers the reduction: lift_can_help stays False.
@check(
    TORQUE_REDUCTION,
    title="Torque ripple reduction",
    method="1 - std of the crank torque with the cam, friction and inertia included, over that"
    " without it",
    forecast=True,
)
def torque_reduction(solution: Solution) -> Demand | None:
    """Reduction of the torque ripple by the cam; None without an engine."""
    cycles = cycles_of_ripple(solution)
    if not cycles:
        return None
    loading = [m.load_case for m in solution.machines if not m.ripple_weight > 0]
    worst = worst_case(cycles, _reduction, at_least=True)
    return Demand(
        worst.value,
        solution.machine.limits[TORQUE_REDUCTION],
        worst,
        note=f"not required in {', '.join(loading)}" if loading else "",
    )


def cycles_of_ripple(solution: Solution) -> tuple[Cycle, ...]:
    """Cycles with an engine whose load case counts for the ripple."""
    return tuple(
        cycle
        for cycle in solution.cycles
        if cycle.turn.torque_before is not None and cycle.machine.ripple_weight > 0
    )


@check(
    SPEED_REDUCTION,
    title="Speed ripple reduction of the crank",
    method="1 - std of the crank speed with the cam over that of the engine alone,"
    " inertia of crank and follower included",
)
def speed_reduction(solution: Solution) -> Demand | None:
    """Reduction of the crank speed ripple by the cam; None without a crankshaft."""
    idle = {m.load_case for m in solution.machines if not m.ripple_weight > 0}
    shares = {
        name: 1.0 - after / before if before > 0 else np.nan
        for name, (before, after) in solution.crank_speed.items()
        if name not in idle
    }
    if not shares:
        return None
    worst = min(shares, key=lambda name: -np.inf if np.isnan(shares[name]) else shares[name])
    allowed = solution.machine.limits[SPEED_REDUCTION]
    return Demand(
        float(shares[worst]),
        allowed,
        Extreme(float(shares[worst]), worst),
        note="" if allowed is not None else "no reduction of the speed ripple is required",
        must_have=allowed is not None,
    )


def _reduction(cycle: Cycle) -> float:
    before, after = cycle.turn.torque_before, cycle.turn.torque_after
    if before is None or after is None:
        return np.nan
    return demands.ripple_reduction(before, after)


@check(
    ENERGY_CLOSURE,
    title="Energy balance of the cam without friction",
    method="integral of (F_s + m w^2 s'') s' over the spline of the lift, over the stored energy",
    evidence=True,
    moved_by_tolerance=False,
)
def energy_closure(solution: Solution) -> Demand:
    """Work of the cam without friction over a turn, over the stored energy."""
    worst = worst_case(solution.cycles, _imbalance)
    return Demand(worst.value, solution.machine.limits[ENERGY_CLOSURE], worst)


@check(
    FRICTION_BALANCE,
    title="Friction work vs. heat in guides and face",
    method="cam work less work of spring and inertia, against friction force times sliding distance"
    " of guides and face, relative",
    evidence=True,
    moved_by_tolerance=False,
)
def friction_balance(solution: Solution) -> Demand:
    """Difference of friction work from heat of guides and face, relative."""
    worst = worst_case(solution.cycles, _heat_mismatch)
    allowed = solution.machine.limits[FRICTION_BALANCE]
    return Demand(worst.value, allowed, worst, note="; ".join(map(_loss, solution.cycles)))


def _stored(cycle: Cycle) -> float:
    """Energy stored at maximum lift, J."""
    return cycle.machine.spring.energy(float(cycle.contour.pitch.lift.highest.value))


def _imbalance(cycle: Cycle) -> float:
    lift, spring = cycle.contour.pitch.lift, cycle.machine.spring
    step = FULL_TURN / len(lift.theta)
    theta = lift.theta[:, None] + 0.5 * step * (1.0 + GAUSS_POINTS)
    s, slope, bend = (lift(theta, order) for order in (0, 1, 2))
    force = spring.force(s) + cycle.machine.mass * cycle.cam_speed**2 * bend
    work = 0.5 * step * float(np.sum((force * slope) @ GAUSS_WEIGHTS))
    return _relative(work, _stored(cycle))


def _touching_slope(cycle: Cycle) -> Array:
    """Slope of the lift (n,), m/rad, 0 where cam and follower are separated."""
    return np.where(cycle.loads.normal_force > 0, cycle.loads.lift_slope, 0.0)


def _heat(cycle: Cycle) -> float:
    """Friction heat of a turn, J; of the guides, from the pressures in their bores."""
    loads, slope = cycle.loads, _touching_slope(cycle)
    heat_a, heat_b = cycle.parts.heat_a, cycle.parts.heat_b
    dragged = np.abs(loads.viscous_force * slope) + loads.sliding_torque
    rubbed = (heat_a.power + heat_b.power) / cycle.cam_speed
    return FULL_TURN / len(slope) * float(np.sum(rubbed + dragged))


def _loss(cycle: Cycle) -> str:
    """Friction loss of a load case in words: power, and share of the stored energy."""
    heat, stored = _heat(cycle), _stored(cycle)
    share = f" or {heat / stored:.1%} of the stored energy" if stored > 0 else ""
    return f"{cycle.load_case}: {shown(heat * cycle.cam_speed / FULL_TURN, 'W', 3)}{share}"


def _heat_mismatch(cycle: Cycle) -> float:
    loads, slope = cycle.loads, _touching_slope(cycle)
    spent = loads.cam_torque - (loads.spring_force + loads.inertia_force) * slope
    loss = FULL_TURN / len(slope) * float(np.sum(spent))
    heat = _heat(cycle)
    return _relative(loss - heat, max(heat, 1e-9 * _stored(cycle)))


def _relative(part: float, whole: float) -> float:
    """|part| / whole; 0 for a part of zero."""
    if np.isnan(part) or np.isnan(whole):
        return np.nan
    return 0.0 if part == 0.0 else float(np.divide(abs(part), whole)) if whole > 0 else np.inf
