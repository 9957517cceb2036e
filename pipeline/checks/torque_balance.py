"""What the cam is for: the ripple it takes away, the energy it gives back."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, worst_case

if TYPE_CHECKING:
    from camwright.pipeline.cycle.cycle import Cycle

TORQUE_REDUCTION = "torque_reduction"

# Exact for the degree 9 of lift times slope on a quintic piece.
GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(5)


def torque_reduction(evidence: TrialEvidence) -> Check | None:
    """Share of the torque ripple the cam takes away; None when there is no engine."""
    only_loads = [s.name for s in evidence.case.load_cases if not s.ripple_weight > 0]
    running = cycles_of_ripple(evidence)
    if not running:
        return None
    worst = worst_case(replace(evidence, cycles=running), _reduction, at_least=True)
    return Check(
        id=TORQUE_REDUCTION,
        title="Torque ripple taken away",
        demand=worst.value,
        limit=evidence.case.limits.torque_reduction,
        unit="-",
        sense="at_least",
        source=evidence.source("torque_reduction", "least value asked for by the case"),
        method="1 - std of the crank torque with the cam, as delivered, over that without it",
        # A gentler lift only takes less ripple away: this one is never traded.
        lift_can_help=False,
        note=f"not asked for in {', '.join(only_loads)}" if only_loads else "",
        **worst.place,
    )


def cycles_of_ripple(evidence: TrialEvidence) -> tuple[Cycle, ...]:
    """The cycles with an engine whose load case counts for the ripple."""
    weights = {state.name: state.ripple_weight for state in evidence.case.load_cases}
    return tuple(
        cycle
        for cycle in evidence.cycles
        if cycle.torque_before is not None and weights[cycle.load_case] > 0
    )


def speed_reduction(evidence: TrialEvidence) -> Check | None:
    """Share of the crank speed's ripple the cam takes away; None without a crankshaft."""
    idle = {state.name for state in evidence.case.load_cases if not state.ripple_weight > 0}
    shares = {
        name: 1.0 - after / before if before > 0 else np.nan
        for name, (before, after) in evidence.speed_ripple.items()
        if name not in idle
    }
    if not shares:
        return None
    worst = min(shares, key=lambda name: -np.inf if np.isnan(shares[name]) else shares[name])
    limit = evidence.case.limits.speed_reduction
    return Check(
        id="speed_reduction",
        title="Speed ripple of the crank taken away",
        demand=float(shares[worst]),
        limit=limit,
        unit="-",
        sense="at_least",
        load_case=worst,
        source=evidence.source("speed_reduction", "least value asked for by the case"),
        method="1 - std of the crank speed with the cam over that of the engine alone,"
        " inertia of crank and follower included",
        must_have=limit is not None,
        note="" if limit is not None else "no reduction of the speed ripple is asked for",
    )


def _reduction(cycle: Cycle) -> float:
    before, after = cycle.torque_before, cycle.residual_torque
    if before is None or after is None or not np.std(before) > 0:
        return np.nan
    return float(1.0 - np.std(after) / np.std(before))


def energy_closure(evidence: TrialEvidence) -> Check:
    """Free of friction, the cam gives back what it takes."""
    worst = worst_case(evidence, lambda cycle: _imbalance(evidence, cycle))
    return Check(
        id="energy_closure",
        title="Energy not given back by the friction-free cam",
        demand=worst.value,
        limit=evidence.case.limits.energy_closure,
        unit="-",
        source=evidence.source("energy_closure", "conservation of energy over one turn"),
        method="integral of (F_s + m w^2 s'') s' over the lift's spline, over the energy stored",
        evidence=True,
        **worst.place,
    )


def friction_balance(evidence: TrialEvidence) -> Check:
    """The torque spent on friction heats guides and face, no more and no less."""
    worst = worst_case(evidence, lambda cycle: _heat_mismatch(evidence, cycle))
    return Check(
        id="friction_balance",
        title="Friction loss against heat in guides and face",
        demand=worst.value,
        limit=evidence.case.limits.friction_balance,
        unit="-",
        source=evidence.source("friction_balance", "conservation of energy over one turn"),
        method="cam work less that of spring and inertia, against friction times way of what rubs"
        " in the bores, relative",
        evidence=True,
        note=_loss_in_words(evidence),
        **worst.place,
    )


def _stored(evidence: TrialEvidence, cycle: Cycle) -> float:
    spring, lift = evidence.case.spring, evidence.contour.pitch.lift.highest.value
    return float(evidence.preload(cycle) * lift + 0.5 * spring.rate * lift**2)


def _imbalance(evidence: TrialEvidence, cycle: Cycle) -> float:
    lift, spring = evidence.contour.pitch.lift, evidence.case.spring
    step = FULL_TURN / len(lift.theta)
    theta = lift.theta[:, None] + 0.5 * step * (1.0 + GAUSS_POINTS)
    s, slope, bend = (lift(theta, order) for order in (0, 1, 2))
    mass_rate = evidence.case.follower.mass * evidence.cam_speed(cycle) ** 2
    force = evidence.preload(cycle) + spring.rate * s + mass_rate * bend
    work = 0.5 * step * float(np.sum((force * slope) @ GAUSS_WEIGHTS))
    return _relative(work, _stored(evidence, cycle))


def _touching_slope(cycle: Cycle) -> Array:
    """Slope of the lift (n,), nothing where cam and follower are apart: there nothing rubs."""
    return np.where(cycle.loads.normal_force > 0, cycle.loads.lift_slope, 0.0)


def _heat(evidence: TrialEvidence, cycle: Cycle) -> float:
    """Heat of all that rubs over a turn, J; of the guides, from the pushes in their bores."""
    loads, slope = cycle.loads, _touching_slope(cycle)
    parts = cycle.parts
    if parts is None:
        friction = np.abs(loads.friction_force_a) + np.abs(loads.friction_force_b)
        rubbed = friction * np.abs(slope)
    else:
        rubbed = (parts.heat_a.power + parts.heat_b.power) / evidence.cam_speed(cycle)
    dragged = np.abs(loads.viscous_force * slope) + loads.sliding_torque
    return FULL_TURN / len(slope) * float(np.sum(rubbed + dragged))


def _loss_in_words(evidence: TrialEvidence) -> str:
    """What friction costs in each load case: power, and share of the energy stored."""
    found = []
    for cycle in evidence.cycles:
        heat, stored = _heat(evidence, cycle), _stored(evidence, cycle)
        power = heat * evidence.cam_speed(cycle) / FULL_TURN
        share = f" or {heat / stored:.1%} of the energy stored" if stored > 0 else ""
        found.append(f"{cycle.load_case}: {power:.3g} W{share}")
    return "; ".join(found)


def _heat_mismatch(evidence: TrialEvidence, cycle: Cycle) -> float:
    loads, slope = cycle.loads, _touching_slope(cycle)
    spent = loads.cam_torque - (loads.spring_force + loads.inertia_force) * slope
    loss = FULL_TURN / len(slope) * float(np.sum(spent))
    heat = _heat(evidence, cycle)
    return _relative(loss - heat, max(heat, 1e-9 * _stored(evidence, cycle)))


def _relative(part: float, whole: float) -> float:
    """Share of the whole; a cam that stores nothing and owes nothing owes no share."""
    if np.isnan(part) or np.isnan(whole):
        return np.nan
    return 0.0 if part == 0.0 else float(np.divide(abs(part), whole)) if whole > 0 else np.inf


CHECKS = (torque_reduction, speed_reduction, energy_closure, friction_balance)
