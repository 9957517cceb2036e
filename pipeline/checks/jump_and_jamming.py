"""Checks of follower jump and of jamming in the guides."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    CONTACT_FORCE_MARGIN,
    JAM_INDEX,
    JUMP,
    JUMP_SPEED,
    OVERSPEED,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import greatest, least
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.elastic_response import ElasticHistory
from camwright.pipeline.cycle.solution import Solution


@check(
    CONTACT_FORCE_MARGIN,
    title="Minimum contact force / preload",
    method="least normal force over the turn, guide friction and inertia included",
    lift_can_help=True,
    forecast=True,
)
def contact_force_margin(solution: Solution) -> Demand:
    """Minimum contact force over the preload."""
    worst = least(solution.cycles, lambda c: c.loads.normal_force / c.machine.spring.preload)
    return Demand(worst.value, solution.machine.limits[CONTACT_FORCE_MARGIN], worst)


@check(
    JUMP,
    title="Maximum unloading inertia force / spring force",
    method="greatest -m w^2 s'' / F_s over the turn; the jump speed is w / sqrt of it",
    lift_can_help=True,
    forecast=True,
)
def jump(solution: Solution) -> Demand:
    """Maximum unloading inertia force over the spring force."""
    worst = greatest(
        solution.cycles,
        lambda cycle: np.maximum(
            demands.unloading(cycle.loads.inertia_force, cycle.loads.spring_force), 0.0
        ),
    )
    return Demand(worst.value, solution.machine.limits[JUMP], worst)


@check(
    JAM_INDEX,
    title="Maximum jam index",
    method="greatest friction of both guides over the axial cam force on the rise; guides of finite"
    " length with clearance",
    lift_can_help=True,
    forecast=True,
    part="guides",
    formula="max((mu_A R_A + mu_B R_B) / F_a) <= j on the rise; R: sum of the pushes on both sides"
    " of a guide, mu: its nominal friction, F_a: axial force of the cam, j: limits.jam_index.",
    reason="Must-have: at 1 the follower locks on the rise and the cam or the stem breaks.",
)
def jam_index(solution: Solution) -> Demand:
    """Friction of the guides over the axial cam force on the rise."""
    worst = greatest(
        solution.cycles, lambda c: demands.jam_outward(c.loads.lift_slope, c.loads.jam_index)
    )
    # On point supports c |tan alpha| with c = (mu_A (a + b) + mu_B a) / b.
    statics = greatest(
        solution.cycles,
        lambda c: demands.jam_outward(c.loads.lift_slope, c.loads.jam_index_statics),
    )
    note = f"{statics.value:.3g} on point supports"
    return Demand(worst.value, solution.machine.limits[JAM_INDEX], worst, note=note)


@check(
    JAM_INDEX,
    id="jam_index_friction_max",
    title="Maximum jam index at maximum friction",
    method="greatest friction of both guides over the axial cam force on the rise, at the maximum"
    " friction coefficients",
    lift_can_help=True,
    part="guides",
    formula="max((mu_A R_A + mu_B R_B) / F_a) <= j on the rise, at guides.*.friction_max or the"
    " tolerance of friction; R: sum of the pushes on both sides of a guide, F_a: axial force of the"
    " cam, j: limits.jam_index.",
    reason="Must-have: friction of bushes scatters by a factor, and it is the greatest that locks"
    " the follower.",
)
def jam_index_friction_max(solution: Solution) -> Demand:
    """Jam index at the maximum friction coefficients of both guides."""
    bounded = solution.machine.friction.bounded
    worst = greatest(solution.cycles, lambda cycle: cycle.parts.friction.jam_index_max)
    return Demand(
        worst.value if bounded else None,
        solution.machine.limits[JAM_INDEX],
        worst,
        note="" if bounded else "no greatest friction is given for both guides",
    )


@check(
    JUMP_SPEED,
    title="Crank speed at follower jump",
    unit="rpm",
    method="least w sqrt(F_s / (-m w^2 s'')) where the follower decelerates, without friction",
    lift_can_help=True,
)
def jump_speed(solution: Solution) -> Demand:
    """Minimum crank speed of follower jump, rad/s."""
    worst = least(solution.cycles, _jump_speed)
    over, note = _overspeed(solution)
    allowed = solution.machine.limits[JUMP_SPEED] * over
    return Demand(worst.value, allowed, worst._replace(load_case=""), note=note)


@check(
    CONTACT_FORCE_MARGIN,
    id="contact_at_overspeed",
    title="Minimum contact force / preload at overspeed",
    method="least spring force plus m w^2 s'' at the overspeed, without friction",
    lift_can_help=True,
)
def contact_at_overspeed(solution: Solution) -> Demand:
    """Minimum contact force at the overspeed over the preload."""
    over, note = _overspeed(solution)

    def force(cycle: Cycle) -> Array:
        scale, loads = (over / cycle.machine.crank_speed) ** 2, cycle.loads
        preload = cycle.machine.spring.preload
        inertia = scale * loads.inertia_force
        return np.asarray(demands.force_left(loads.spring_force, inertia, preload))

    worst = least(solution.cycles, force)._replace(load_case="")
    return Demand(worst.value, solution.machine.limits[CONTACT_FORCE_MARGIN], worst, note=note)


@check(
    CONTACT_FORCE_MARGIN,
    id="elastic_contact",
    title="Minimum contact force / preload with elastic stem",
    method="one mass on the stiffness of the stem, without friction",
    must_have=False,
    lift_can_help=True,
)
def elastic_contact(solution: Solution) -> Demand:
    """Minimum contact force with an elastic stem over the preload."""
    worst = least(
        solution.cycles,
        lambda c: c.parts.elastic.response.contact_force / c.machine.spring.preload,
    )
    histories = [cycle.parts.elastic for cycle in solution.cycles]
    methods = "; ".join(dict.fromkeys(history.method for history in histories))
    return Demand(
        worst.value,
        solution.machine.limits[CONTACT_FORCE_MARGIN],
        worst,
        note=_flights(histories),
        method=f"one mass on the stiffness of the stem, without friction: {methods}",
    )


def _flights(histories: list[ElasticHistory]) -> str:
    """Number of losses of contact per turn, and the highest flight."""
    flights = [flight for history in histories for flight in history.flights]
    if not flights:
        return ""
    high = max(flights, key=lambda flight: flight.height)
    lift_off, landing = (
        f"{np.degrees(angle) % 360.0:.1f} deg" for angle in (high.jump, high.landing)
    )
    force = max(history.force_max for history in histories)
    return (
        f"{len(flights)} losses of contact per turn; the highest flight starts at"
        f" {lift_off} and ends at {landing}, {shown(high.height, 'mm', 3)} high,"
        f" with {shown(high.landing_speed, 'm/s', 3)}; greatest impact force {shown(force, 'N')}"
    )


def _jump_speed(cycle: Cycle) -> Array:
    """Crank speed of follower jump by cam angle (n,), rad/s; NaN where not known."""
    pull = -cycle.loads.inertia_force
    slows = pull > 0
    ratio = np.sqrt(cycle.loads.spring_force / np.where(slows, pull, 1.0))
    free = np.where(np.isnan(pull), np.nan, np.inf)
    return np.where(slows, cycle.machine.crank_speed * ratio, free)


def overspeed(machines: tuple[Machine, ...]) -> float:
    """Overspeed of the crank, rad/s; at least the speed of the fastest load case."""
    fastest = max(machine.crank_speed for machine in machines)
    return max(machines[0].limits[OVERSPEED] or fastest, fastest)


def _overspeed(solution: Solution) -> tuple[float, str]:
    """Overspeed of the crank, rad/s, and a note where the case has none."""
    over = overspeed(solution.machines)
    prescribed = solution.machine.limits[OVERSPEED] == over
    return over, "" if prescribed else "no overspeed is given: speed of the fastest load case"
