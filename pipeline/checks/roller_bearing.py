"""Checks of the roller bearing: static rating, life, speed, outer ring."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.case.limits import ROLLER_LIFE, ROLLER_SPEED_SHARE, ROLLER_STATIC_SAFETY
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import Extreme, greatest, worst_case
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.roller_motion import rating_life, roller_motion, static_safety
from camwright.pipeline.follower.roller_parts import Bearing


def bearing_of(solution: Solution) -> Bearing:
    """Bearing of the roller.

    Raises
    ------
    InputError
        If the follower has a flat face.
    """
    roller = solution.machine.roller
    if roller is None:
        raise InputError("roller", "missing", "given for the checks of its bearing")
    return roller.bearing


def spin(cycle: Cycle) -> Array:
    """Speed of the roller on its pin, rad/s, (n,)."""
    contour = cycle.contour.require_roller()
    return roller_motion(contour.pitch, contour.roller_radius, cycle.cam_speed, cycle.theta).spin


def allowed_spin(machine: Machine) -> float | None:
    """Maximum speed of the roller on its pin, rad/s; None without a limiting speed."""
    speed = None if machine.roller is None else machine.roller.bearing.speed_limit
    return None if speed is None else machine.limits[ROLLER_SPEED_SHARE] * speed


def _force(solution: Solution) -> Extreme:
    return greatest(solution.cycles, lambda cycle: cycle.loads.normal_force)


@check(
    ROLLER_STATIC_SAFETY,
    id="roller_static",
    title="Static safety factor of the roller bearing",
    method="static rating over the greatest normal force",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def roller_static(solution: Solution) -> Demand:
    """Static safety factor s0 of the bearing."""
    bearing, worst = bearing_of(solution), _force(solution)
    rating = bearing.C0
    rated = rating is not None and worst.value > 0
    return Demand(
        static_safety(worst.value, rating) if rated and rating is not None else None,
        solution.machine.limits[ROLLER_STATIC_SAFETY],
        worst,
        note="" if rating is not None else f"no static rating is given for {bearing.name}",
        figures=(f"{bearing.name}: {bearing.source}",),
    )


@check(
    ROLLER_LIFE,
    title="L10 rating life of the roller bearing",
    method="(C / P_m)^3 million revolutions, P_m the cube mean of the normal force,"
    " surge of the spring included",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def roller_life(solution: Solution) -> Demand:
    """L10 rating life of the bearing, s."""
    bearing, target = bearing_of(solution), solution.machine.limits[ROLLER_LIFE]
    worst = worst_case(solution.cycles, lambda c: _life(c, bearing.C), at_least=True)
    missing = ["no dynamic rating is given"] if bearing.C is None else []
    missing += ["no life is required"] if target is None else []
    return Demand(
        worst.value,
        target,
        worst,
        note="; ".join(missing),
        figures=(f"{bearing.name}: {bearing.source}".rstrip(": "),),
    )


def _life(cycle: Cycle, rating: float | None) -> float:
    """L10, s; NaN without a rating or a force."""
    force = cycle.surged_force
    if rating is None or not np.isfinite(force).all():
        return np.nan
    return rating_life(force, spin(cycle), rating).seconds


@check(
    ROLLER_SPEED_SHARE,
    id="roller_speed",
    title="Maximum roller speed vs. limiting speed",
    unit="rpm",
    method="rolling without slip: w (|dP/dtheta| - r) / r",
    lift_can_help=True,
    forecast=True,
    needs="roller",
)
def roller_speed(solution: Solution) -> Demand:
    """Maximum speed of the roller on its pin, rad/s."""
    bearing, allowed = bearing_of(solution), allowed_spin(solution.machine)
    worst = greatest(solution.cycles, lambda cycle: np.abs(spin(cycle)))
    return Demand(
        worst.value,
        allowed,
        worst,
        note="" if allowed is not None else f"no limiting speed is given for {bearing.name}",
        figures=(bearing.source,),
    )


@check(
    title="Normal force vs. maximum radial load of the outer ring",
    unit="N",
    source="F_r,max of a track roller",
    method="greatest normal force over the turn",
    lift_can_help=True,
    needs="roller",
)
def roller_radial(solution: Solution) -> Demand:
    """Maximum normal force, N, against the rating of an unsupported outer ring."""
    bearing, worst = bearing_of(solution), _force(solution)
    return Demand(
        worst.value,
        bearing.radial_limit,
        worst,
        note=""
        if bearing.radial_limit is not None
        else f"{bearing.name} has no rating for an outer ring without a housing",
        figures=(f"{bearing.name}: {bearing.source}",),
    )
