"""Checks of follower jump and of jamming in the guides."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.extrema import first_greatest, first_least, sampled_least
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown, shown_up
from camwright.pipeline.case.limits import (
    CONTACT_FORCE_MARGIN,
    JAM_INDEX,
    JUMP,
    JUMP_SPEED,
    OVERSPEED,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import demands
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    FACTOR_MAX,
    SPEED_RANGE,
    STATED,
    Allowed,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.extremes import (
    Extreme,
    cam_of,
    cycle_of,
    greatest,
    least,
    row_of,
    worst_measure,
)
from camwright.pipeline.checks.guide_strength import ACROSS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle, least_spring_force
from camwright.pipeline.cycle.elastic_response import ElasticHistory
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.speed_sweep import SpeedSweep, highest_speed
from camwright.pipeline.follower.follower_flight import LONGEST, Flight

_FORCE_DIGITS = 5  # of the force and of the preload of a follower that leaves the cam
_TIE = 1e-9  # relative difference up to which two forces are equal, and one is none
_LEAST_FORCE = dict.fromkeys(("N", "F_0"), f"{STATED} [N]")


def _with_lift_off(demand: Demand, solution: Solution) -> Demand:
    """Demand with the least contact force; where the follower leaves the cam, a demand of zero at
    the place and a note on it.
    """
    lowest = worst_measure(solution, _required, "forces", float, at_least=True, order=2)
    if lowest.value < 0.0:
        note, stated = _lifts_off(solution.cycles, lowest), {"N": 0.0}
        return replace(demand, value=0.0, at=lowest, note=note, stated=stated)
    if demand.at is None or not demand.at.load_case:
        return demand
    cam = solution.cams_between[cycle_of(solution.cycles, demand.at)]
    return replace(demand, stated={"N": float(sampled_least(cam.normal))})


def _required(cam: LoadedCam) -> Array:
    """Axial force without guide friction, N; negative where the follower leaves the cam."""
    return cam.required


@check(
    CONTACT_FORCE_MARGIN,
    title="Minimum contact force / least spring force",
    method="least normal force over the turn, guide friction and inertia included, refined between"
    " samples",
    lift_can_help=True,
    tier=Tier.SCREENING,
    formula="N / F_0 >= limits.contact_force_margin; N: least normal force over all load cases and"
    " angles with guide friction and inertia, without surge, 0 where the follower leaves the cam,"
    " F_0: spring force at minimum lift",
    symbols={"N": f"{STATED} [N]", "F_0": "least_spring_force"},
    reason="A follower that leaves the cam lands on it with an impact.",
    rests_on="",
    values=given.LOADS,
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
).measured(
    "forces",
    worst="least",
    value=lambda worst, _: np.maximum(worst, 0.0),
    remark=_with_lift_off,
    deviation=0.02,
    kept=Kept(),
)
def contact_force_margin(cam: LoadedCam) -> Array:
    """Contact force over the least spring force."""
    return cam.normal / cam.least_spring


@check(
    JUMP,
    title="Maximum unloading inertia force / closing force",
    method="greatest -m w^2 s'' / F_c over the turn, refined between samples; the jump speed is"
    " w / sqrt of it",
    lift_can_help=True,
    tier=Tier.SCREENING,
    formula="max(-m w^2 s'' / F_c) <= limits.jump over all load cases and angles; m: moving mass,"
    " w: cam speed, s'': second derivative of the lift, F_c: closing force, of the spring with"
    " weight and external force",
    symbols={
        "m": "follower.mass",
        "w": "cam.speed",
        "s''": "lift_d2",
        "F_c": "closing_force",
    },
    reason="At 1 the inertia of the follower lifts it off the cam.",
    rests_on="",
    values=given.MOTION,
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
).measured(
    "forces",
    deviation=0.003,
    kept=Kept(lambda cam, limit: demands.unloading(cam.inertia, cam.closing) / limit),
)
def jump(cam: LoadedCam) -> Array:
    """Unloading inertia force over the closing force, >= 0."""
    return demands.greatest_unloading(cam.inertia, cam.closing)


def _on_points(demand: Demand, solution: Solution) -> Demand:
    """With that on point supports: c |tan alpha|, c = (mu_A (a + b) + mu_B a) / b."""
    statics = greatest(
        solution.cycles, lambda c: np.where(c.loads.lift_slope > 0, c.loads.jam_index_statics, 0.0)
    )
    return replace(demand, note=f"{statics.value:.3g} on point supports")


@check(
    JAM_INDEX,
    title="Maximum jam index",
    method="greatest friction of both guides over the axial cam force on the rise; guides of finite"
    f" length with clearance{ACROSS}",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="guides",
    formula="max((mu_A R_A + mu_B R_B) / F_a) <= j on the rise; R: sum of the pushes on both sides"
    " of a guide, mu: its nominal friction, F_a: axial force of the cam, of preloaded discs"
    " that of both, j: limits.jam_index.",
    symbols={
        "mu_A": "guides.a.friction",
        "mu_B": "guides.b.friction",
        "R_A": "guide_normal_load_A",
        "R_B": "guide_normal_load_B",
        "F_a": "stem_force",
    },
    reason="at 1 the follower locks on the rise and the cam or the stem breaks.",
    rests_on="contact",
    values=given.LOADS,
    levers=levers.JAM,
    page="Guides",
).measured("angles", remark=_on_points, deviation=0.01, kept=Kept(factor_max=FACTOR_MAX))
def jam_index(cam: LoadedCam) -> Array:
    """Guide friction over axial cam force on the rise."""
    return outward(cam, np.asarray(cam.jam * cam.jam_tilted))


def outward(cam: LoadedCam, index: Array) -> Array:
    """Jam index on the rise, 0 on the return: there friction cannot lock the follower."""
    return np.where(np.real(cam.slope) > 0, index, 0.0 * index)


def _at_greatest_friction(demand: Demand, solution: Solution) -> Demand:
    """Demand with the numbers of the jam index at its cam angle: friction coefficients, loads of
    the guides and axial force, N.
    """
    if demand.at is None or not demand.at.load_case:
        return demand
    cycle, k = row_of(solution.cycles, demand.at)
    loads, (mu_a, mu_b) = cycle.parts.friction.greatest, cycle.machine.guide_friction.greatest
    if not loads.lift_slope[k] > 0.0:
        return demand
    rubbed = (loads.friction_force_a[k], mu_a), (loads.friction_force_b[k], mu_b)
    tilted = cam_of(solution, cycle).jam_tilted[k]
    pushes = [float(force) / mu * float(tilted) if mu else 0.0 for force, mu in rubbed]
    stated = {"mu_A": mu_a, "mu_B": mu_b, "R_A": pushes[0], "R_B": pushes[1]}
    return replace(demand, stated=stated | {"F_a": float(loads.stem_force[k] * loads.wall[k])})


def _worst_friction_kept(cam: LoadedCam, limit: float) -> Array | None:
    """No constraint where the maximum friction is not known."""
    worst = cam.jam_worst
    return None if worst is None else outward(cam, np.asarray(worst * cam.jam_tilted)) / limit


@check(
    JAM_INDEX,
    id="jam_index_friction_max",
    title="Maximum jam index at maximum friction",
    method="greatest friction of both guides over the axial cam force on the rise, at the maximum"
    f" friction coefficients{ACROSS}",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="guides",
    formula="max((mu_A R_A + mu_B R_B) / F_a) <= j on the rise, at guides.*.friction_max or the"
    " tolerance of friction; mu: that friction, R: sum of the pushes on both sides of a guide under"
    " it, F_a: axial force of the cam, of preloaded discs that of both, j: limits.jam_index.",
    symbols={
        "mu_A": STATED,
        "mu_B": STATED,
        **dict.fromkeys(("R_A", "R_B", "F_a"), f"{STATED} [N]"),
    },
    reason="friction of bushes scatters by a factor, and it is the greatest that locks"
    " the follower.",
    rests_on="contact",
    values=given.LOADS,
    levers=levers.JAM,
    page="Guides",
).measured("angles", remark=_at_greatest_friction, deviation=0.01, kept=Kept(_worst_friction_kept))
def jam_index_friction_max(cam: LoadedCam) -> Array:
    """Jam index at the maximum friction coefficients of both guides."""
    worst = cam.jam_worst
    if worst is None:
        return np.full_like(cam.jam, np.nan)
    return outward(cam, np.asarray(worst * cam.jam_tilted))


def _speed_of_jump(worst: Value, numbers: Numbers) -> Value:
    """Crank speed (...), rad/s, at which the contact is lost; worst (...) : share of the closing
    force that the inertia takes at a cam speed of 1 rad/s. Infinite where it takes none.
    """
    root = np.sqrt(np.asarray(worst))
    some = ~(root <= 0.0)  # NaN stays
    speed = numbers["mechanism.gear_ratio"] / np.where(some, root, 1.0)
    return np.where(some, speed, np.inf)


def _jump_speed_allowed(numbers: Numbers) -> Allowed:
    """Least crank speed of the jump, rad/s: a share of the overspeed."""
    key = f"limits.{OVERSPEED.id}"
    if (over := numbers.get(key)) is None:
        return Allowed(None, (key,))
    fastest = numbers["cam.fastest"] * numbers["mechanism.gear_ratio"]
    fastest = np.where(np.isnan(over), np.nan, fastest)[()]
    return Allowed(numbers[f"limits.{JUMP_SPEED.id}"] * fastest)


def cam_speed_without_jump(numbers: Numbers) -> float:
    """Required jump speed of the cam, rad/s: of the overspeed, else of the fastest load case."""
    return float(numbers.limit(JUMP_SPEED) * numbers["cam.fastest"])


def _at_no_load_case(demand: Demand, _: Solution) -> Demand:
    """At its cam angle alone: the speed is that of no load case."""
    return replace(demand, at=demand.at and demand.at._replace(load_case=""))


@check(
    JUMP_SPEED,
    title="Machine speed at follower jump",
    unit="rpm",
    method="w over the root of the greatest -m w^2 s'' / F_c, without friction, refined between"
    " samples",
    lift_can_help=True,
    tier=Tier.SCREENING,
    kept_as="cam speed without follower jump",
    formula="min(i sqrt(F_c / (-m s''))) >= c w; i: mechanism.gear_ratio, F_c: closing force, of"
    " the spring with weight and external force, m: moving mass, s'': second derivative of the"
    " lift, c: limits.jump_speed, w: overspeed of the machine, at least its fastest load case",
    symbols={
        "i": "mechanism.gear_ratio",
        "m": "follower.mass",
        "s''": "lift_d2",
        "F_c": "closing_force",
        "w": "cam.fastest mechanism.gear_ratio [rpm]",
    },
    reason="An engine exceeds its governed speed, and damping and tolerances are not known"
    " closely.",
    load_cases=SPEED_RANGE,
    values=given.MOTION,
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
).measured(
    "forces",
    value=_speed_of_jump,
    error=0.5,
    bound=lambda _, numbers: cam_speed_without_jump(numbers),
    allowed=_jump_speed_allowed,
    applies=lambda speed, _: ~np.isposinf(speed),
    remark=_at_no_load_case,
    deviation=0.003,
    kept=Kept(
        lambda cam, limit: demands.unloading(cam.inertia_at(limit), cam.closing),
        unit="rpm",
        falls=-2.0,
    ),
)
def jump_speed(cam: LoadedCam) -> Array:
    """Measure: unloading at 1 rad/s of the cam; demand: crank speed at which it reaches 1.

    None for a round cam, which has no jump.
    """
    return demands.greatest_unloading(cam.inertia / cam.speed**2, cam.closing)


def _force_at(cam: LoadedCam, speed: Value) -> Array:
    """Closing and inertia force at a cam speed, rad/s, over the least spring force."""
    return demands.force_left(cam.closing, cam.inertia_at(speed), cam.least_spring)


@check(
    CONTACT_FORCE_MARGIN,
    id="contact_at_overspeed",
    title="Minimum contact force / least spring force at overspeed",
    method="least closing force plus m w^2 s'' at the overspeed, without friction, refined between"
    " samples",
    lift_can_help=True,
    tier=Tier.SCREENING,
    formula="min(F_c + m w^2 s'') / F_0 >= limits.contact_force_margin at w of limits.overspeed;"
    " F_c: closing force, of the spring with weight and external force, m: moving mass, s'': second"
    " derivative of the lift, F_0: spring force at minimum lift",
    symbols={
        "m": "follower.mass",
        "w": "limits.overspeed/mechanism.gear_ratio [rad/s]",
        "s''": "lift_d2",
        "F_c": "closing_force",
        "F_0": "least_spring_force",
    },
    reason="The synthesis keeps the contact by this closed form; the sweep adds friction"
    " and surge.",
    load_cases=SPEED_RANGE,
    values=given.LOADS,
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
).measured(
    "forces",
    worst="least",
    needed=(f"limits.{OVERSPEED.id}",),
    remark=_at_no_load_case,
    deviation=0.02,
    kept=Kept(),
)
def contact_at_overspeed(cam: LoadedCam) -> Array:
    """Contact force at overspeed over least spring force, without friction."""
    return _force_at(cam, cam.numbers["cam.fastest"])


@check(
    CONTACT_FORCE_MARGIN,
    id="contact_over_speed",
    title="Minimum contact force / least spring force over the speed range",
    method="normal force of the rigid follower with inertia, guide friction and the surge of the"
    " spring by the wave equation, at each speed from standstill to over-speed",
    lift_can_help=True,
    part="spring",
    formula="N / F_0 >= limits.contact_force_margin over all speeds from standstill to over-speed;"
    " N: least of (P + k s + F_e + m w^2 s'' + c w s' + F_w) / ((1 - j) cos(alpha)), F_e: weight"
    " and external force, F_0: spring force at minimum lift, F_w: sum over the harmonics of"
    " k (phi cot phi - 1) s_h, phi = pi h w / w_1 sqrt(1 - 2 i zeta), j: jam index with the sign of"
    " the motion, w_1: first natural frequency of the spring, zeta: spring.design.damping_ratio; if"
    " the case does not state it, 0.01 with an error bar down to 0.002",
    symbols=_LEAST_FORCE,
    reason="Between the load cases a harmonic of the lift may meet a natural frequency of"
    " the spring and lift the follower off the cam.",
    load_cases=SPEED_RANGE,
    values=(*given.LOADS, *given.SURGE),
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
)
def contact_over_speed(solution: Solution) -> Demand:
    """Least contact force over least spring force, with surge, over all speeds."""
    swept = _least_over_speed(
        solution,
        lambda sweep: (sweep.contact_force_min, sweep.contact_angle, sweep.contact_error),
    )
    worst, limit = swept.barred(swept.worst), solution.machine.limits[CONTACT_FORCE_MARGIN]
    return Demand(worst.value, limit, worst, note=swept.words, stated=swept.stated)


@check(
    CONTACT_FORCE_MARGIN,
    id="elastic_contact",
    title="Minimum contact force / least spring force with elastic stem",
    method="one mass on the stiffness of the stem, without friction",
    lift_can_help=True,
    tier=Tier.PREVIEW,
    within=("stem", "arm"),
    formula="N / F_0 >= limits.contact_force_margin over all speeds from standstill to over-speed"
    " and over the load cases at their varying speed; N: least contact force of one mass on the"
    " stiffness between cam and mass, on the spring with its surge, F_0: spring force at minimum"
    " lift",
    symbols=_LEAST_FORCE,
    reason="The resonance of the follower on its own stiffness unloads the contact more"
    " than the rigid follower shows.",
    load_cases=SPEED_RANGE,
    values=(
        *given.LOADS,
        "follower.stiffness",
        "follower.damping_ratio",
        "roller.material.E",
        "roller.material.nu",
        "roller.bearing.ring.*",
    ),
    levers=levers.CONTACT,
    closed_by="force",
    page="Follower",
)
def elastic_contact(solution: Solution) -> Demand:
    """Least contact force over least spring force of a follower on an elastic stem, over the load
    cases and all speeds.
    """
    worst = least(
        solution.cycles,
        lambda c: c.elastic.response.contact_force / c.least_spring_force,
    )
    swept = _least_over_speed(
        solution,
        lambda sweep: (sweep.elastic_force_min, sweep.elastic_angle, sweep.elastic_error),
    )
    histories = [cycle.elastic for cycle in solution.cycles]
    methods = "; ".join(dict.fromkeys(history.method for history in histories))
    carrier = solution.machine.carrier
    note, (cycle, k) = "", row_of(solution.cycles, worst)
    stated = {
        "N": float(cycle.elastic.response.contact_force[k]),
        "F_0": cycle.least_spring_force,
    }
    # A load case at constant speed is in the sweep, too: equal but for round-off.
    if np.isnan(swept.worst.value) or swept.worst.value < worst.value + _TIE * abs(worst.value):
        worst, note, stated = swept.worst, swept.words, dict(swept.stated)
    worst = swept.barred(worst)
    return Demand(
        worst.value,
        solution.machine.limits[CONTACT_FORCE_MARGIN],
        worst,
        note="; ".join(each for each in (note, _flights(histories)) if each),
        method=f"one mass on the stiffness of the {carrier}, without friction: harmonic response"
        f" with the surge of a coil spring over the speed range; load cases by {methods}",
        stated=stated,
    )


_RIGID_RATIO = 10.0  # least natural over rotational frequency of a rigid follower


@check(
    title="Natural frequency of the follower / rotational frequency of the cam",
    unit="-",
    sense="at_least",
    source=Source(
        "VDI 2149-1, abstract of the publisher: rigid where the lowest natural frequency is at"
        " least ten times the rotational frequency of the driving crank",
        confirmed=True,
    ),
    method="one mass on the stiffness of stem and spring, at the greatest speed of the cam",
    must_have=False,
    lift_can_help=False,
    tier=Tier.PREVIEW,
    within=("stem", "arm"),
    formula="sqrt((k_s + k)/m)/w >= 10; k_s: follower.stiffness, else that of the parts between cam"
    " and mass in series, k: spring.rate, m: mass of the follower without its share of the spring,"
    " w: greatest cam speed of all load cases",
    symbols={
        "k_s": f"{STATED} [kN/m]",
        "k": "spring.rate",
        "m": f"{STATED} [g]",
        "w": "cam.fastest [rad/s]",
    },
    reason="The rule for a mechanism that may be taken as rigid. elastic_contact computes what the"
    " vibration does, and decides.",
    load_cases=SPEED_RANGE,
    values=(
        *given.LOADS,
        *given.SURGE,
        "follower.stiffness",
        "roller.material.E",
        "roller.material.nu",
        "roller.bearing.ring.*",
        "roller.bearing.C0",
    ),
    page="Follower",
)
def rigid_follower(solution: Solution) -> Demand:
    """Natural frequency of the follower on its stiffness over the greatest rotational speed of the
    cam.
    """
    machine, fastest = solution.machine, float(solution.numbers["cam.fastest"])
    frequency = shown(machine.follower_frequency / FULL_TURN, "Hz")
    stiffness = shown(machine.axial_stiffness, "kN/m")
    return Demand(
        machine.follower_frequency / fastest if fastest > 0.0 else np.inf,
        _RIGID_RATIO,
        note=f"{frequency} at {stiffness} of the {machine.carrier}",
        stated={"k_s": machine.axial_stiffness, "m": machine.mass_without_spring},
    )


def _lifts_off(cycles: Sequence[Cycle], worst: Extreme) -> str:
    """Least axial force of a follower that leaves the cam, and the preload that keeps it on."""
    preload = max(each.machine.spring.preload for each in cycles) - worst.value
    return (
        "the follower leaves the cam: axial force without friction"
        f" {shown(worst.value, 'N', _FORCE_DIGITS)} at {shown(worst.cam_angle or 0.0, 'deg')};"
        f" a preload above {shown_up(preload, 'N', _FORCE_DIGITS)} keeps it on the cam"
    )


class Swept(NamedTuple):
    """Least contact over spring force over the speed; `least_damped`: at least damping.

    stated: both forces by their symbol, N
    """

    worst: Extreme
    least_damped: float
    words: str
    stated: Mapping[str, float]

    def barred(self, worst: Extreme) -> Extreme:
        """Extreme with an error bar that reaches down to the value at the least damping of the
        surge.
        """
        further = worst.value - self.least_damped
        if not further > 0.0 or worst.value == 0.0:
            return worst
        return worst._replace(error_share=max(worst.error_share, further / abs(worst.value)))


def _least_over_speed(
    solution: Solution, measure: Callable[[SpeedSweep], tuple[Array, Array, Array]]
) -> Swept:
    """Least force over the least spring force in all sweeps with its angle, and its speed in words.

    Parameters
    ----------
    measure : callable   sweep -> force, N, cam angle and sampling error of the force, (m,)
    """
    worst, at, spring = Extreme(np.inf), 0.0, solution.machine.spring
    forces = dict[str, float]()

    def held(sweep: SpeedSweep) -> float:
        return least_spring_force(replace(spring, preload=sweep.preload), solution.contour)

    for sweep in solution.speed_sweeps:
        force, angle, error = measure(sweep)
        k = first_least(force)  # the first NaN, where there is one
        value = float(force[k]) / held(sweep)
        if np.isnan(value) or value < worst.value:
            share = float(error[k] / abs(force[k])) if force[k] else 0.0
            worst = Extreme(value, "", float(angle[k]), share)
            at = float(sweep.crank_speed[k])
            forces = {"N": float(force[k]), "F_0": held(sweep)}
        if np.isnan(value):
            break
    damped = solution.least_damped
    sweeps = () if damped is None else damped.speed_sweeps
    least_damped = min((float(measure(one)[0].min()) / held(one) for one in sweeps), default=np.inf)
    top = max(float(sweep.crank_speed[-1]) for sweep in solution.speed_sweeps)
    stated = overspeed(solution.machines) is not None
    end = shown(top, "rpm", 4) + (
        "" if stated else ", the fastest load case, without limits.overspeed"
    )
    words = f"at {shown(at, 'rpm', 4)} of the machine; swept from standstill to {end}"
    return Swept(worst, least_damped, words, forces)


def _flights(histories: list[ElasticHistory]) -> str:
    """Note on the number of losses of contact per turn, the highest flight and the greatest impact
    force; empty without any.
    """
    flights = [flight for history in histories for flight in history.flights]
    if not flights:
        return ""
    highest = [flight for flight in flights if not flight.lands] or flights
    high = highest[first_greatest([flight.height for flight in highest])]
    force = max(history.force_max for history in histories)
    return (
        f"{len(flights)} losses of contact per turn; the highest flight starts at"
        f" {_place(high.jump)} and {_landing(high)}; greatest impact force {shown(force, 'N')}"
    )


def _landing(flight: Flight) -> str:
    """Landing of a flight, and its height, in words."""
    height = f"{shown(flight.height, 'mm', 3)} high"
    if not flight.lands:
        return f"has not landed after {LONGEST:g} turns, {height}"
    later = {0: "", 1: " of the next turn"}.get(
        flight.turns_later, f", {flight.turns_later} turns later"
    )
    speed = shown(flight.landing_speed, "m/s", 3)
    return f"ends at {_place(flight.landing)}{later}, {height}, with {speed}"


def _place(angle: float) -> str:
    return f"{np.degrees(angle) % 360.0:.1f} deg"


def overspeed(machines: Sequence[Machine]) -> float | None:
    """Overspeed of the crank, rad/s, at least the fastest load case; None if not stated."""
    stated = machines[0].limits[OVERSPEED] is not None
    return highest_speed(machines) if stated else None
