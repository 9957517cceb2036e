"""Checks of the roller bearing: ratings, life, speed, outer ring, lubrication.

The load of the bearing is the normal force: radial, without an axial share. A life is that by the
duty of the load cases; without one that in the worst load case, run all the time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import Array, Values
from camwright.geometry.errors import InputError
from camwright.pipeline.base import levers
from camwright.pipeline.base import value_groups as given
from camwright.pipeline.base.units import factor, in_unit
from camwright.pipeline.case.limits import (
    ROLLER_LIFE,
    ROLLER_LOAD_SHARE,
    ROLLER_RELIABILITY,
    ROLLER_SPEED_SHARE,
    ROLLER_STATIC_SAFETY,
    TARGET_LIFE,
    VISCOSITY_RATIO,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.check import BY_DUTY, NONE, Declaration, Demand, check
from camwright.pipeline.checks.extremes import (
    NOWHERE,
    Extreme,
    duty_parts,
    greatest,
    over_duty,
    worst_case,
)
from camwright.pipeline.checks.missing_keys import lacking, unset
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.roller import Roller
from camwright.pipeline.follower.roller_motion import (
    equivalent_load,
    rating_life,
    roller_motion,
    static_safety,
)
from camwright.pipeline.follower.roller_parts import Bearing

STANDSTILL = 1.0  # rpm of the roller, below which the viscosity ratio does not apply
FASTEST = 1e7  # rpm, of any roller


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


def _card(bearing: Bearing) -> tuple[str]:
    return (f"{bearing.name}: {bearing.source}".rstrip(": "),)


def _known(force: Array) -> bool:
    return bool(np.isfinite(force).all())


@check(
    ROLLER_STATIC_SAFETY,
    id="roller_static",
    title="Static safety factor of the roller bearing",
    method="static rating over the greatest normal force",
    lift_can_help=True,
    tier=Tier.SCREENING,
    forecast=True,
    needs="roller",
    part="roller_bearing",
    formula="C0/N >= S; C0: static rating, N: greatest normal force over all load cases and angles,"
    " S: limits.roller_static_safety",
    reason="beyond it the balls dent the raceways",
    values=(*given.LOADS, "roller.bearing.C0"),
    levers=(levers.Catalogued(levers.BEARING, "C0", inverse=True), *levers.LOAD),
    page="Roller",
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
        lacking(bearing.table, bearing, "C0"),
        figures=_card(bearing),
    )


@check(
    ROLLER_LOAD_SHARE,
    id="roller_load_share",
    title="Greatest load over dynamic rating of the roller bearing",
    method="greatest normal force over the dynamic rating",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="roller_bearing",
    formula="N/C <= x; N: greatest normal force over all load cases and angles, C: dynamic rating,"
    " x: limits.roller_load_share",
    reason="beyond it the balls yield in their raceways and no rating life is valid",
    values=(*given.LOADS, "roller.bearing.C"),
    levers=(levers.Catalogued(levers.BEARING, "C", inverse=True), *levers.LOAD),
    page="Roller",
)
def roller_load_share(solution: Solution) -> Demand:
    """Greatest normal force over the dynamic rating."""
    bearing, worst = bearing_of(solution), _force(solution)
    rating = bearing.C
    return Demand(
        worst.value / rating if rating else None,
        solution.machine.limits[ROLLER_LOAD_SHARE],
        worst,
        lacking(bearing.table, bearing, "C"),
        figures=_card(bearing),
    )


@check(
    ROLLER_LIFE,
    title="L10 rating life of the roller bearing",
    method="(C / P_m)^3 million revolutions, P_m the cube mean of the normal force,"
    " surge of a coil spring included",
    lift_can_help=True,
    tier=Tier.SCREENING,
    forecast=True,
    needs="roller",
    part="roller_bearing",
    formula="(C/P_m)^3 10^6/n >= L; C: dynamic rating, P_m: cube mean of the normal force over the"
    " revolutions of the roller, n: its mean speed, L: limits.roller_life. Over the load cases"
    f" {BY_DUTY}.",
    reason="the bearing has to last; a clean bearing that lasts longer is not credited",
    values=(
        *given.LOADS,
        *given.SURGE,
        "roller.bearing.C",
        "roller.bearing.fatigue_load_limit",
        "roller.bearing.viscosity",
    ),
    levers=(levers.Catalogued(levers.BEARING, "C"), *levers.LOAD),
    page="Roller",
)
def roller_life(solution: Solution) -> Demand:
    """L10 rating life of the bearing, s."""
    bearing, target = bearing_of(solution), solution.machine.limits[ROLLER_LIFE]

    def life(cycle: Cycle) -> float:
        return _life(cycle, bearing.C)

    worst = over_duty(solution.cycles, life, life=True)
    return Demand(
        worst.value,
        target,
        worst,
        (*lacking(bearing.table, bearing, "C"), *unset(solution.machine.limits, ROLLER_LIFE)),
        note="; ".join(damage_note(solution, life)),
        figures=_card(bearing),
    )


def damage_note(solution: Solution, life: Callable[[Cycle], float]) -> list[str]:
    """Shares of the load cases in the damage of a life; none without a duty."""
    parts = duty_parts(solution.cycles, life, life=True)
    whole = sum(parts.values())
    if not whole > 0.0:
        return []
    shares = (f"{part / whole:.0%} {name}" for name, part in parts.items())
    return [f"damage by duty: {', '.join(shares)}"]


def _life(cycle: Cycle, rating: float | None) -> float:
    """L10, s; NaN without a rating or a force."""
    force = cycle.surged_force
    if rating is None or not _known(force):
        return np.nan
    return float(rating_life(force, spin(cycle), rating).seconds)


@check(
    ROLLER_LIFE,
    id="roller_modified_life",
    title="Modified rating life of the roller bearing",
    method="a1 a_ISO (C / P)^3 million revolutions, the damage of the positions of a turn added;"
    " infinite at rest",
    lift_can_help=True,
    needs="roller",
    part="roller_bearing",
    formula="a1 a_ISO (C/P)^3 10^6/n >= L; a1: of limits.roller_reliability, a_ISO: of the"
    " viscosity ratio and of e_C P_u/P, e_C: of roller.bearing.contamination, P_u: fatigue load"
    f" limit, L: limits.roller_life. Over the load cases {BY_DUTY}.",
    reason="a thin or dirty film shortens the life to a tenth",
    values=(
        *given.LOADS,
        *given.SURGE,
        "roller.bearing.C",
        "roller.bearing.C0",
        "roller.bearing.fatigue_load_limit",
        "roller.bearing.viscosity",
        "roller.bearing.*pitch_diameter",
        "limits.roller_reliability",
    ),
    levers=(
        levers.Catalogued(levers.BEARING, "C"),
        levers.one("roller.bearing.viscosity"),
        *levers.LOAD,
    ),
    page="Roller",
)
def roller_modified_life(solution: Solution) -> Demand:
    """Modified rating life L_nm of the bearing, s."""
    bearing, limits = bearing_of(solution), solution.machine.limits
    rating, endured, circle = bearing.C, bearing.fatigue_load_limit, bearing.ball_circle
    cleanliness, viscosity = bearing.contamination, bearing.viscosity
    missing = lacking(
        bearing.table, bearing, "C", "fatigue_load_limit", "contamination", "viscosity"
    )
    missing += _no_ball_circle(bearing) + unset(limits, ROLLER_LIFE)
    worst, notes = NOWHERE, list[str]()
    if rating and endured and cleanliness and viscosity and circle:
        share = bearing_life.contamination_factor(cleanliness, circle)

        def life(cycle: Cycle) -> float:
            force, kappa = cycle.surged_force, _viscosity_ratio(cycle, bearing)
            if np.isinf(kappa):
                return np.inf
            if not _known(force) or not kappa >= bearing_life.LEAST_VISCOSITY_RATIO:
                return np.nan
            return bearing_life.modified_life(
                force, spin(cycle), rating, share * endured, kappa, limits[ROLLER_RELIABILITY]
            )

        worst = over_duty(solution.cycles, life, life=True)
        if np.isnan(worst.value):
            notes.append("not known for a viscosity ratio below 0.1: outside of ISO 281")
        else:
            notes += damage_note(solution, life)
    return Demand(
        worst.value,
        limits[ROLLER_LIFE],
        worst,
        missing,
        note="; ".join(notes),
        figures=(limits.source(ROLLER_RELIABILITY), bearing_life.SOURCE, *_card(bearing)),
    )


@check(
    ROLLER_SPEED_SHARE,
    id="roller_speed",
    title="Maximum roller speed vs. limiting speed",
    unit="rpm",
    method="rolling without slip: w (|dP/dtheta| - r) / r",
    lift_can_help=True,
    tier=Tier.SCREENING,
    forecast=True,
    needs="roller",
    part="roller_bearing",
    formula="w (|dP/dtheta| - r)/r <= x n_g; P: pitch curve, r: roller radius, n_g: limiting speed,"
    " x: limits.roller_speed_share",
    reason="beyond it seals and grease overheat",
    values=("roller.bearing.speed_limit", "limits.overspeed"),
    levers=(
        levers.Catalogued(levers.BEARING, "speed_limit", inverse=True),
        *levers.SPRING,
        *levers.GENTLER,
    ),
    page="Roller",
)
def roller_speed(solution: Solution) -> Demand:
    """Maximum speed of the roller on its pin, rad/s."""
    bearing, allowed = bearing_of(solution), allowed_spin(solution.machine)
    worst = greatest(solution.cycles, lambda cycle: np.abs(spin(cycle)))
    return Demand(
        worst.value,
        allowed,
        worst,
        lacking(bearing.table, bearing, "speed_limit"),
        figures=(bearing.source,),
    )


def _outer_ring(name: str, words: str, symbol: str, reason: str, key: str) -> Declaration:
    @check(
        id=name,
        title=f"Normal force vs. maximum {words} load of the outer ring",
        unit="N",
        source=f"{symbol} of a track roller",
        method="greatest normal force over the turn",
        lift_can_help=True,
        tier=Tier.SCREENING,
        needs="roller",
        part="roller_bearing",
        formula=f"N <= {symbol}; N: greatest normal force over all load cases and angles, {symbol}:"
        f" maximum {words} load of an outer ring without a housing",
        reason=reason,
        values=(*given.LOADS, f"roller.bearing.{key}"),
        levers=(levers.Catalogued(levers.BEARING, key, inverse=True), *levers.LOAD),
        page="Roller",
    )
    def against_the_ring(solution: Solution) -> Demand:
        """Maximum normal force, N, against the rating of an unsupported outer ring."""
        bearing, worst = bearing_of(solution), _force(solution)
        return Demand(
            worst.value,
            getattr(bearing, key),
            worst,
            lacking(bearing.table, bearing, key),
            figures=_card(bearing),
        )

    return against_the_ring


roller_radial = _outer_ring(
    "roller_radial",
    "dynamic radial",
    "F_r,max",
    "an outer ring on a cam bends, and breaks in fatigue",
    "radial_limit",
)
roller_static_radial = _outer_ring(
    "roller_static_radial",
    "static radial",
    "F_0r,max",
    "an outer ring on a cam bends, and breaks under a single overload",
    "static_radial_limit",
)


@check(
    VISCOSITY_RATIO,
    id="bearing_lubrication",
    title="Viscosity ratio (kappa) of the roller bearing",
    method="viscosity over v1 at the mean speed of the roller; infinite at rest",
    needs="roller",
    part="roller_bearing",
    formula="v/v1 >= k; v: viscosity in operation, v1: rated viscosity of ISO 281 at the mean speed"
    " of the roller and the pitch diameter of its balls, k: limits.viscosity_ratio",
    reason="below it the film is torn, and the modified life does not count the wear",
    values=("roller.bearing.viscosity", "roller.bearing.*pitch_diameter"),
    levers=(levers.one("roller.bearing.viscosity"),),
    page="Roller",
)
def bearing_lubrication(solution: Solution) -> Demand:
    """Viscosity ratio of the roller bearing."""
    bearing = bearing_of(solution)
    worst = worst_case(
        solution.cycles, lambda cycle: _viscosity_ratio(cycle, bearing), at_least=True
    )
    return Demand(
        worst.value,
        solution.machine.limits[VISCOSITY_RATIO],
        worst,
        lacking(bearing.table, bearing, "viscosity") + _no_ball_circle(bearing),
        figures=(bearing_life.SOURCE, bearing.source),
    )


def _no_ball_circle(bearing: Bearing) -> tuple[str, ...]:
    """Key of the pitch diameter of the balls where neither the bearing nor its ring has one."""
    return () if bearing.ball_circle else lacking(bearing.table, bearing, "pitch_diameter")


def least_speed(viscosity: float, circle: float, ratio: float) -> float | None:
    """Mean speed of the roller at a viscosity ratio, rad/s; None where every speed has more.

    Parameters
    ----------
    viscosity : float   in operation, m2/s
    circle : float      pitch diameter of the balls, m
    """

    def excess(log_speed: float) -> float:
        rated = bearing_life.rated_viscosity(np.exp(np.asarray(log_speed)), circle)
        return float(np.log(viscosity / rated / ratio))

    ends = np.log(STANDSTILL), np.log(FASTEST)
    if not excess(ends[0]) < 0.0 < excess(ends[1]):
        return None
    speed = float(np.exp(scipy.optimize.brentq(excess, *ends, xtol=1e-13)))
    return speed * factor("rpm")


def _viscosity_ratio(cycle: Cycle, bearing: Bearing) -> float:
    """Viscosity ratio at the mean speed; infinite at rest, NaN without its data."""
    speed, viscosity, circle = _mean_speed(cycle), bearing.viscosity, bearing.ball_circle
    if viscosity is None or circle is None or np.isnan(speed):
        return np.nan
    if speed < STANDSTILL:
        return np.inf
    return viscosity / float(bearing_life.rated_viscosity(np.asarray(speed), circle))


def _mean_speed(cycle: Cycle) -> float:
    """Mean speed of the roller, rpm."""
    return in_unit(float(np.mean(np.abs(spin(cycle)))), "rpm")


@check(
    id="grease_life",
    title="Life of the grease in the roller bearing",
    unit="h",
    sense="at_least",
    source="JTEKT's estimate for sealed ball bearings, with n D for a turning outer ring as SKF"
    " does: recalled, verify",
    method="of n D, P/C and temperature; the manufacturer's where it is given",
    lift_can_help=True,
    needs="roller",
    part="roller_bearing",
    formula="log10 F = 6.10 - 4.40e-6 D n - 2.50 (P/C - 0.05) - (0.021 - 1.80e-8 D n) T; F >= L;"
    " D: outer diameter in mm, n: mean speed in rpm, P: equivalent load, C: dynamic rating, T:"
    " temperature in degC, L: limits.target_life of a bearing greased for life, else"
    " roller.bearing.relubrication_interval. Oil has no such life. Over the load cases"
    f" {BY_DUTY}.",
    reason="a bearing greased for life ends with its grease",
    load_cases=NONE,
    rests_on="loads",
    values=(
        *given.LOADS,
        "roller.bearing.C",
        "roller.bearing.temperature",
        "roller.bearing.grease_life",
        "roller.bearing.relubrication_interval",
        "limits.target_life",
    ),
    levers=(levers.Catalogued(levers.BEARING, "C"), *levers.LOAD),
    page="Roller",
)
def grease_life(solution: Solution) -> Demand | None:
    """Life of the grease, s; None with oil."""
    bearing = bearing_of(solution)
    if bearing.lubrication == "oil":
        return None
    if bearing.lubrication is None:
        return Demand(None, None, missing=lacking(bearing.table, bearing, "lubrication"))
    target = _grease_target(solution.machine, bearing)
    if bearing.lubrication == "grease_for_life":
        missing = unset(solution.machine.limits, TARGET_LIFE)
    else:
        missing = lacking(bearing.table, bearing, "relubrication_interval")
    if bearing.grease_life is not None:
        stated = Extreme(bearing.grease_life)
        return Demand(stated.value, target, stated, missing, figures=_card(bearing))
    missing += lacking(bearing.table, bearing, "C", "temperature")
    worst, note = NOWHERE, ""
    if not missing:
        worst = over_duty(solution.cycles, lambda cycle: _grease_life(cycle, solution), life=True)
        if np.isnan(worst.value):
            missing = lacking(bearing.table, bearing, "grease_life")
            note = "outside the range of the estimate"
    return Demand(worst.value, target, worst, missing, note=note, figures=_card(bearing))


def _grease_life(cycle: Cycle, solution: Solution) -> float:
    """Estimated life of the grease in a load case, s; NaN without its data or out of its range."""
    bearing, force, roller = bearing_of(solution), cycle.loads.normal_force, solution.machine.roller
    if not bearing.C or bearing.temperature is None or roller is None or not _known(force):
        return np.nan
    share = float(equivalent_load(force, spin(cycle))) / bearing.C
    across = _greased_diameter(roller)
    return bearing_life.grease_life(_mean_speed(cycle), across, share, bearing.temperature)


def _greased_diameter(roller: Roller) -> float:
    """Outer diameter of the bearing, m."""
    ring = roller.bearing.ring
    return 2.0 * roller.radius if ring is None else ring.outer_diameter


class Grease(NamedTuple):
    """Grease of the roller bearing: required life, s; C, N; outer diameter, m; temperature, K."""

    life: float
    rating: float
    diameter: float
    temperature: float

    def load_share(self, speed: Values, *, unbounded: bool = False) -> Values:
        """Greatest P/C (...) at a mean speed of the roller, rad/s; see `grease_load_share`."""
        return bearing_life.grease_load_share(
            self.life, speed / factor("rpm"), self.diameter, self.temperature, unbounded=unbounded
        )


def grease_of(machine: Machine) -> Grease | None:
    """Grease whose life is estimated; None where it is stated, without grease or its data."""
    roller = machine.roller
    if roller is None or not machine.scope.covers("roller_bearing"):
        return None
    bearing = roller.bearing
    target, rating, temperature = _grease_target(machine, bearing), bearing.C, bearing.temperature
    if bearing.lubrication in (None, "oil") or bearing.grease_life is not None:
        return None
    if target is None or rating is None or temperature is None:
        return None
    return Grease(target, rating, _greased_diameter(roller), temperature)


def _grease_target(machine: Machine, bearing: Bearing) -> float | None:
    """Required life of the grease, s."""
    for_life = bearing.lubrication == "grease_for_life"
    return machine.limits[TARGET_LIFE] if for_life else bearing.relubrication_interval
