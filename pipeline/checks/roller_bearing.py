"""Checks of the roller bearing: ratings, life, speed, outer ring, lubrication.

The load of the bearing is the normal force: radial, without an axial share. A life is that by the
duty of the load cases; without one that in the worst load case, run all the time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import FULL_TURN, Array, Value, Values
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import factor, shown
from camwright.pipeline.case.limits import (
    AXIS_PARALLELISM,
    CAM_RUN_OUT,
    ROLLER_LIFE,
    ROLLER_LOAD_SHARE,
    ROLLER_MISALIGNMENT,
    ROLLER_RELIABILITY,
    ROLLER_SPEED_SHARE,
    ROLLER_STATIC_SAFETY,
    TARGET_LIFE,
    VISCOSITY_RATIO,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    BY_DUTY,
    LASTING,
    STATED,
    ClosedBy,
    Declaration,
    Demand,
    Kept,
    check,
    of_key,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE, force_over, rating_over
from camwright.pipeline.checks.extremes import (
    NOWHERE,
    Extreme,
    Measure,
    cam_of,
    cycle_of,
    duty_parts,
    mean_of,
    over_duty,
    row_of,
)
from camwright.pipeline.checks.missing_keys import lacking, unset
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, TurningRoller, not_negative
from camwright.pipeline.cycle.numbers import Numbers, base_radius
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.roller_motion import (
    BALL_LIFE_EXPONENT,
    RATED_REVOLUTIONS,
    equivalent_load,
    wear,
)
from camwright.pipeline.follower.roller_parts import Bearing

STANDSTILL = factor("rpm")
"""Mean speed of the roller below which the viscosity ratio does not apply, rad/s."""
FASTEST = 1e7  # rpm, of any roller
MILLION_TURNS = RATED_REVOLUTIONS * FULL_TURN  # rad
_LEAST_FORCE = 1.0  # N, of a force that damages a bearing
_AMPLE = 100.0  # times the least mean speed, of a roller at rest, which needs no film
_RATING = "roller.bearing.C"
_VISCOSITY, _CIRCLE = "roller.bearing.viscosity", "roller.bearing.pitch_diameter"
_SURGED = (
    "normal_force + spring_surge_force/((1 - sign(follower_velocity) jam_index)"
    " cos(pressure_angle))"
)
"""Normal force with the surge of the spring, in the columns of a run."""


def _cube_mean(rating: str, force: str) -> dict[str, str]:
    """Symbols C, P_m, n of a rating life: key of the rating, and an expression of the force."""
    mean = f"(mean(({force})^3 |roller_speed|)/mean(|roller_speed|))^(1/3) [N]"
    return {"C": rating, "P_m": mean, "n": "mean(|roller_speed|)/(2 pi) [1/s]"}


_CUBE_MEAN = _cube_mean(_RATING, _SURGED)
"""Dynamic rating, cube mean of the force and mean speed of a roller in the symbols of a formula."""
_PRESSED = "cam.conjugate.interference None"
_ALONE = {"?": f"cam.groove.second.radius None; {_PRESSED}"}
"""Symbols of a formula that holds for one roller on all tracks."""


def _with_card(demand: Demand, solution: Solution) -> Demand:
    return replace(demand, figures=_card(solution.machine.roller.bearing))


def _card(bearing: Bearing) -> tuple[str]:
    return (f"{bearing.name}: {bearing.source}".rstrip(": "),)


def _life(worst: Value, numbers: Numbers, rating: str = _RATING) -> Value:
    """L10 (...), s, of a mean N^3 |n|; rating : key of C."""
    return rating_over(_cube(numbers, rating), worst, np.inf)


def _cube(numbers: Numbers, rating: str = _RATING) -> Value:
    """C^3 million turns, N^3 rad; rating : key of C."""
    return numbers[rating] ** BALL_LIFE_EXPONENT * MILLION_TURNS


def _damage(cam: LoadedCam) -> Array:
    """N^3 |n|, N^3 rad/s; of the demand, L10 = (C/P_m)^3 10^6/n, s: P_m^3 n is the mean.

    Of two preloaded rollers at each angle the greater one, so that neither lives shorter.
    """
    every = [wear(not_negative(each.force), each.spin) for each in cam.rollers]
    return _on_first(cam, _greatest(every))


def _greatest(every: Sequence[Array]) -> Array:
    """Greatest (...) of the values of each roller."""
    most = every[0]
    for other in every[1:]:
        most = np.where(np.real(other) > np.real(most), other, most)
    return most


def _on_first(cam: LoadedCam, each: Array) -> Array:
    """Damage or force (...) of the first roller: of two in a groove that on the inner wall."""
    case = cam.numbers.case
    if case is None or case.cam.on_pin is None:
        return each
    return np.where(cam.wall > 0.0, each, 0.0 * each)


def _on_second(cam: LoadedCam, each: Array) -> Array:
    """Damage or force (...) of the second roller of a groove: that on the outer wall."""
    return np.where(cam.wall < 0.0, each, 0.0 * each)


def _second_damage(cam: LoadedCam) -> Array:
    """`_damage` of the second roller of a groove."""
    return _on_second(cam, wear(not_negative(cam.surged), cam.spin))


def first_force(cam: LoadedCam) -> Array:
    """Normal force on the first roller, N."""
    return _on_first(cam, cam.normal)


def second_force(cam: LoadedCam) -> Array:
    """Normal force on the second roller of a groove, N."""
    return _on_second(cam, not_negative(cam.normal))


def _with_damage(demand: Demand, solution: Solution) -> Demand:
    """Demand of the rating life with the shares of the load cases in the damage, and the bearing
    card.
    """
    notes = [] if demand.value is None else _damage_note(solution, _damage, _life)
    return _with_card(replace(demand, note="; ".join(notes)), solution)


def _modified_life(worst: Value, numbers: Numbers) -> Value:
    """L_nm (...), s, of a mean |n| (P/C)^3/a_ISO."""
    return rating_over(_reliable(numbers), worst, np.inf)


def _reliable(numbers: Numbers) -> Value:
    """a1 million turns, rad."""
    return numbers.each(_reliability, (f"limits.{ROLLER_RELIABILITY.id}",))[0] * MILLION_TURNS


def _reliability(numbers: Numbers) -> tuple[float]:
    """a1"""
    return (bearing_life.reliability_factor(float(numbers.limit(ROLLER_RELIABILITY))),)


def _modified_damage(cam: LoadedCam) -> Array:
    """|n| (P/C)^3/a_ISO, rad/s; NaN where the viscosity ratio is outside of ISO 281."""

    def rate(roller: TurningRoller) -> Array:
        kappa = _viscosity_ratio(roller.mean, cam.numbers)
        within = np.real(kappa) >= bearing_life.LEAST_VISCOSITY_RATIO
        return _damage_rate(cam, roller, np.where(within, kappa, np.nan))

    return _greatest([rate(each) for each in cam.rollers])


def _modified_kept(cam: LoadedCam, limit: float) -> Array | None:
    """Use of the limit of the modified life (n,) as constraint of the synthesis, at a viscosity
    ratio of at least that where ISO 281 begins; None without data.
    """
    if cam.numbers.get(_VISCOSITY) is None:
        return None
    least = bearing_life.LEAST_VISCOSITY_RATIO

    def rate(roller: TurningRoller) -> Array:
        kappa = _viscosity_ratio(roller.mean, cam.numbers)
        return _damage_rate(cam, roller, np.where(np.real(kappa) > least, kappa, least))

    return _greatest([rate(each) for each in cam.rollers]) / limit


def _damage_rate(cam: LoadedCam, roller: TurningRoller, kappa: Array) -> Array:
    """Damage per time, |n| (P/C)^3/a_ISO (n,), rad/s, at a viscosity ratio `kappa`; zero of a
    roller at rest.
    """
    numbers, surged = cam.numbers, not_negative(roller.force)
    force = np.where(np.real(surged) < _LEAST_FORCE, _LEAST_FORCE, surged)
    rating, clean = numbers[_RATING], numbers["roller.bearing.cleanliness_load"]
    used = bearing_life.life_used(force, rating, clean, kappa) * magnitude(roller.spin)
    used = _on_first(cam, used)
    return np.where(np.real(roller.mean) < STANDSTILL, 0.0, used)


def _with_modified_damage(demand: Demand, solution: Solution) -> Demand:
    """Demand of the modified life with the shares of the load cases in the damage, its sources, and
    the mean factor a_ISO.
    """
    limits, notes = solution.machine.limits, list[str]()
    if demand.value is not None and np.isnan(demand.value):
        notes.append("not known for a viscosity ratio below 0.1: outside of ISO 281")
    elif demand.value is not None:
        notes = _damage_note(solution, _modified_damage, _modified_life)
    reliability, card = limits.source(ROLLER_RELIABILITY), _card(solution.machine.roller.bearing)
    figures = reliability, bearing_life.SOURCE, *card
    noted = replace(demand, note="; ".join(notes), figures=figures)
    if demand.value is None or demand.at is None:
        return noted
    cycle = cycle_of(solution.cycles, demand.at)
    plain, used = (mean_of(solution, each, cycle) for each in (_damage, _modified_damage))
    rating = float(solution.numbers[_RATING]) ** BALL_LIFE_EXPONENT
    return replace(noted, stated={"a_ISO": plain / rating / used} if used > 0.0 else {})


def _viscosity_ratio(mean: Value, numbers: Numbers) -> Array:
    """Viscosity over v1 (...) at a mean speed of the roller, rad/s, at least that of standstill."""
    held = np.where(np.real(np.asarray(mean)) < STANDSTILL, STANDSTILL, mean)
    rated = bearing_life.rated_viscosity(held / factor("rpm"), float(numbers[_CIRCLE]))
    return np.asarray(numbers[_VISCOSITY] / rated)


def _film_ratio(mean: Value, numbers: Numbers) -> Value:
    """Viscosity ratio (...) at a mean speed of the roller, rad/s; infinite at rest."""
    return np.where(mean < STANDSTILL, np.inf, _viscosity_ratio(mean, numbers))[()]


def _with_line_of_viscosity(demand: Demand, solution: Solution) -> Demand:
    """Demand with factor "a" and power "b" of the rated viscosity at the mean speed of the
    roller.
    """
    noted = replace(demand, figures=(bearing_life.SOURCE, solution.machine.roller.bearing.source))
    if demand.at is None or not demand.at.load_case:
        return noted
    mean = mean_of(solution, _slowest, cycle_of(solution.cycles, demand.at))
    line = bearing_life.viscosity_line(mean / factor("rpm"))
    return replace(noted, stated=dict(zip("ab", line, strict=True)))


def _film_kept(cam: LoadedCam, limit: float) -> Array:
    """Speed over the least mean speed; no film is necessary at rest."""
    spin = _slowest(cam)
    turns = np.real(cam.spin_mean) >= STANDSTILL
    return np.where(turns, spin / limit, _AMPLE + 0.0 * spin)


def _damage_note(
    solution: Solution, measure: Measure, life: Callable[[Value, Numbers], Value]
) -> list[str]:
    """Note, in a list, on the shares of the load cases in the damage of a life; empty without a
    duty. life : of a mean measure, s.
    """

    def of_turn(cycle: Cycle) -> float:
        return float(life(mean_of(solution, measure, cycle), solution.numbers))

    parts = duty_parts(solution.cycles, of_turn, life=True)
    total = sum(parts.values())
    if not total > 0.0:
        return []
    shares = (f"{part / total:.0%} {name}" for name, part in parts.items())
    return [f"damage by duty: {', '.join(shares)}"]


def _with_slope(demand: Demand, solution: Solution) -> Demand:
    """Demand of the misalignment of the bearing with the part of the camshaft in it."""
    if demand.at is None or not demand.at.load_case:
        return demand
    cycle, row = row_of(solution.cycles, demand.at)
    tilts = cam_of(solution, cycle).shaft_tilts
    slope = max(float(abs(each[row])) for each in tilts)
    figures = tuple(map(solution.machine.limits.source, (AXIS_PARALLELISM, CAM_RUN_OUT)))
    note = f"{shown(slope, 'mrad', 3)} of it by the camshaft"
    return replace(demand, note=note, figures=figures, stated={"phi": slope})


_of_roller = partial(
    check,
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="roller_bearing",
    page="Roller",
)
"""Declaration of a check of the bearing that a gentler lift can help."""


class _JudgedRoller(NamedTuple):
    """Roller whose bearing is judged: that in which its checks differ from those of another.

    Parameters
    ----------
    name : str           with which the ids of its checks begin
    table : str          of the case, with its ratings
    bearing, ring : str  its bearing and the outer ring, in words
    force : str          greatest normal force on it, in words
    greatest : str       that over all load cases and angles, in words
    closed_by : str      closure with such a roller, see `Declaration`
    first : bool         its bearing is of the catalogue, and the synthesis keeps its limits
    normal : callable    normal force on it, N
    """

    name: str
    table: str
    bearing: str
    ring: str
    force: str
    greatest: str
    closed_by: ClosedBy
    first: bool
    normal: Measure

    def lever(self, rating: str, *, inverse: bool = False) -> Lever:
        """Lever of a rating; inverse: the utilisation is inverse to it."""
        if self.first:
            return levers.Catalogued(levers.BEARING, rating, inverse=inverse)
        return levers.one(f"{self.table}.{rating}")


_FIRST = _JudgedRoller(
    *("roller", "roller.bearing", "the roller bearing", "the outer ring", "greatest normal force"),
    greatest="greatest normal force over all load cases and angles, of two rollers in a groove that"
    " of the inner wall",
    closed_by="",
    first=True,
    normal=first_force,
)
_SECOND = _JudgedRoller(
    *("second_roller", "cam.groove.second", "the bearing of the second roller"),
    *("the outer ring of the second roller", "greatest normal force on the outer wall"),
    greatest="greatest normal force on the outer wall over all load cases and angles",
    closed_by="rollers",
    first=False,
    normal=second_force,
)


def _static_safety(at: _JudgedRoller) -> Declaration:
    """Static safety factor of a bearing."""
    key = f"{at.table}.C0"
    return _of_roller(
        ROLLER_STATIC_SAFETY,
        id=f"{at.name}_static",  # of the first NORMAL_FORCE, the group of all these limits
        title=f"Static safety factor of {at.bearing}",
        method=f"static rating over the {at.force}",
        closed_by=at.closed_by,
        kept_as="static load rating of the roller" if at.first else "",
        formula=f"C0/N >= S; C0: static rating, N: {at.greatest}, S: limits.roller_static_safety",
        symbols={"N": "normal_force", "C0": key},
        reason="beyond it the balls dent the raceways",
        values=(*given.LOADS, key),
        levers=(at.lever("C0", inverse=True), *levers.LOAD),
    ).measured(
        "angles",
        value=lambda worst, numbers: rating_over(numbers[key], worst, np.nan),
        bound=lambda limit, numbers: float(numbers[key]) / limit,
        needed=(key,),
        remark=_with_card,
        deviation=0.005,
        kept=Kept(force_over, group=NORMAL_FORCE, unit="N") if at.first else None,
    )(at.normal)


roller_static = _static_safety(_FIRST)


_AXES = f"limits.{AXIS_PARALLELISM.id}", f"limits.{CAM_RUN_OUT.id}"


@check(
    ROLLER_MISALIGNMENT,
    title="Angle between the rings of the roller's bearing",
    method="slope of the camshaft at the cam in the plane of the contact, parallelism, run-out and"
    " tilt of the stem in its guides, of which the contact turns the roller by all; each in its"
    " worst direction",
    tier=Tier.SCREENING,
    needs="roller",
    part="roller_bearing",
    formula="phi + p + r/(2 r_b) + (c_A + c_B)/(2 (b + (L_A + L_B)/2)) <="
    " limits.roller_misalignment; phi: greatest slope of the camshaft at the cam over the turn, 0"
    " where its diameter or material is not stated, p: limits.axis_parallelism, r:"
    " limits.cam_run_out, r_b: base radius, c, L, b: clearances, lengths and spacing of the guides",
    symbols={
        "phi": f"{STATED} [mrad]",
        "p": _AXES[0],
        "r": _AXES[1],
        "r_b": "cam.prime_radius - roller.radius [mm]",
        **{f"c_{each}": f"guides.{each.lower()}.clearance" for each in "AB"},
        **{f"L_{each}": f"guides.{each.lower()}.length" for each in "AB"},
        "b": "guides.spacing",
    },
    reason="beyond it the balls run on the edge of the groove under a moment, and neither rating"
    " nor life of the bearing holds",
    values=(
        *given.LOADS,
        *_AXES,
        "camshaft.material.E",
        "guides.a.clearance",
        "guides.b.clearance",
    ),
    levers=(
        levers.one("camshaft.diameter", most=2.0),
        levers.Scaled(("guides.spacing", "follower.stem_length"), 1, 2.0),
    ),
    page="Roller",
).measured("angles", remark=_with_slope, deviation=0.01)
def roller_misalignment(cam: LoadedCam) -> Array:
    """Angle between the rings of the roller's bearing (..., n), rad: slope of the camshaft,
    parallelism, run-out and clearance of the guides.
    """
    numbers = cam.numbers
    guides = numbers.known_case.guides.tilt_at(numbers["guides.spacing"])
    run_out = numbers.limit(CAM_RUN_OUT) / (2.0 * base_radius(numbers))
    tilt = _greatest([magnitude(each) for each in cam.shaft_tilts])
    return tilt + (numbers.limit(AXIS_PARALLELISM) + run_out + guides)


def _load_share(at: _JudgedRoller) -> Declaration:
    """Greatest load of a bearing over its dynamic rating."""
    key = f"{at.table}.C"
    return _of_roller(
        ROLLER_LOAD_SHARE,
        id=f"{at.name}_load_share",
        title=f"Greatest load over dynamic rating of {at.bearing}",
        method=f"{at.force} over the dynamic rating",
        closed_by=at.closed_by,
        kept_as="share of the dynamic load rating of the roller" if at.first else "",
        formula=f"N/C <= x; N: {at.greatest}, C: dynamic rating, x: limits.roller_load_share",
        symbols={"N": "normal_force", "C": key},
        reason="beyond it the balls yield in their raceways and no rating life is valid",
        values=(*given.LOADS, key),
        levers=(at.lever("C", inverse=True), *levers.LOAD),
    ).measured(
        "angles",
        value=lambda worst, numbers: worst / numbers[key],
        bound=lambda limit, numbers: float(numbers[key]) * limit,
        needed=(key,),
        remark=_with_card,
        deviation=0.005,
        kept=Kept(group=NORMAL_FORCE) if at.first else None,
    )(at.normal)


roller_load_share = _load_share(_FIRST)
second_roller_load_share = _load_share(_SECOND)


def _rating_life(
    at: _JudgedRoller,
    damage: Measure,
    *,
    method: str,
    mean: str,
    symbols: Mapping[str, str],
    reason: str,
    film: tuple[str, ...],
    remark: Callable[[Demand, Solution], Demand],
) -> Declaration:
    """L10 life of a bearing.

    Parameters
    ----------
    damage : callable   N^3 |n|, N^3 rad/s
    mean : str          cube mean of the force, in words
    film : tuple        keys of which a modified life is made, where the bearing has one
    """
    key = f"{at.table}.C"
    return _of_roller(
        ROLLER_LIFE,
        id=f"{at.name}_life",
        title=f"L10 rating life of {at.bearing}",
        method=method,
        closed_by=at.closed_by,
        kept_as="dynamic load rating of the roller" if at.first else "",
        formula=f"(C/P_m)^3 10^6/n >= L; C: dynamic rating, P_m: cube mean of the {mean}, n: its"
        f" mean speed, L: limits.roller_life. Over the load cases {BY_DUTY}.",
        symbols=symbols,
        reason=reason,
        load_cases=LASTING,
        values=(*given.LOADS, *given.SURGE, key, *film),
        levers=(at.lever("C"), *levers.LOAD),
    ).measured(
        "life",
        value=partial(_life, rating=key),
        bound=lambda limit, numbers: float(_cube(numbers, key)) / limit,
        needed=(key,),
        remark=remark,
        deviation=0.03,
        bounded="surge",
        kept=Kept(power=1.0 / BALL_LIFE_EXPONENT, unit="N") if at.first else None,
    )(damage)


roller_life = _rating_life(
    _FIRST,
    _damage,
    method="(C / P_m)^3 million revolutions, P_m the cube mean of the normal force,"
    " surge of a coil spring included",
    mean="normal force over the revolutions of the roller",
    symbols=_CUBE_MEAN | _ALONE,
    reason="the bearing has to last; a clean bearing that lasts longer is not credited",
    film=("roller.bearing.fatigue_load_limit", _VISCOSITY),
    remark=_with_damage,
)
second_roller_life = _rating_life(
    _SECOND,
    _second_damage,
    method="as of roller_life, by the forces of the outer wall alone",
    mean="normal force on the outer wall, 0 elsewhere, over the revolutions of the roller that"
    " carries",
    symbols=_cube_mean("cam.groove.second.C", f"0.5 (1 - wall) ({_SURGED})"),
    reason="each roller of a groove has its own wall and its own forces",
    film=(),
    remark=_with_card,
)
second_roller_static = _static_safety(_SECOND)


roller_modified_life = _of_roller(
    ROLLER_LIFE,
    id="roller_modified_life",
    title="Modified rating life of the roller bearing",
    method="a1 a_ISO (C / P)^3 million revolutions, the damage of the positions of a turn added;"
    " infinite at rest",
    kept_as="dynamic load rating of the roller at its modified life",
    formula="a1 a_ISO (C/P_m)^3 10^6/n >= L; a1 = 0.05 + 0.95 (ln(1/R)/ln(1/0.9))^(1/1.5): of"
    " the reliability R, limits.roller_reliability, C, P_m, n: as of roller_life, a_ISO: of the"
    " viscosity ratio and of e_C P_u/P, mean over the damage of the turn, e_C: of"
    " roller.bearing.contamination, P_u: fatigue load"
    f" limit, L: limits.roller_life. Over the load cases {BY_DUTY}.",
    symbols={
        **_CUBE_MEAN,
        **_ALONE,
        "R": f"limits.{ROLLER_RELIABILITY.id}",
        "a1": "[-]",
        "a_ISO": STATED,
    },
    reason="a thin or dirty film shortens the life to a tenth",
    load_cases=LASTING,
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
).measured(
    "life",
    value=_modified_life,
    bound=lambda limit, numbers: float(_reliable(numbers)) / limit,
    needed=(
        _RATING,
        "roller.bearing.fatigue_load_limit",
        "roller.bearing.contamination",
        _VISCOSITY,
        _CIRCLE,
    ),
    remark=_with_modified_damage,
    deviation=0.03,
    bounded="surge",
    kept=Kept(_modified_kept, power=1.0 / BALL_LIFE_EXPONENT, unit="N"),
)(_modified_damage)


@_of_roller(
    ROLLER_SPEED_SHARE,
    id="roller_speed",
    title="Maximum roller speed vs. limiting speed",
    unit="rpm",
    method="rolling without slip: w (|dP/dtheta| - r) / r",
    kept_as="limiting speed of the roller",
    formula="w |(|P'| - r)/r| <= x n_g; P': pitch curve by cam angle, r: radius of the roller that"
    " carries, negative on the outer wall of a groove, n_g: limiting speed, x:"
    " limits.roller_speed_share",
    symbols={
        "w": "cam.speed",
        "P'": "pitch_speed",
        "r": "surface_radius",
        "n_g": "roller.bearing.speed_limit",
        "?": f"follower.kind roller; {_PRESSED}",
    },
    reason="beyond it seals and grease overheat",
    values=("roller.bearing.speed_limit", "limits.overspeed"),
    levers=(
        levers.Catalogued(levers.BEARING, "speed_limit", inverse=True),
        *levers.SPRING,
        *levers.GENTLER,
    ),
).measured(
    "angles",
    allowed=of_key("roller.bearing.speed_limit", ROLLER_SPEED_SHARE),
    remark=lambda demand, solution: replace(
        demand, figures=(solution.machine.roller.bearing.source,)
    ),
    deviation=0.0002,
    kept=Kept(unit="rpm"),
)
def roller_speed(cam: LoadedCam) -> Array:
    """Speed of the roller on its pin, of two preloaded ones the higher at each angle, rad/s."""
    return _greatest([magnitude(each.spin) for each in cam.rollers])


def _outer_ring(at: _JudgedRoller, name: str, words: str, symbol: str, breaks: str) -> Declaration:
    """Load of the outer ring of a bearing; name : of the rated load, in id and key."""
    key = f"{at.table}.{name}_limit"
    rated = name.replace("_", " ")
    return _of_roller(
        id=f"{at.name}_{name}",
        title=f"Normal force vs. maximum {words} load of {at.ring}",
        unit="N",
        source=Source(f"{symbol} of a track roller", confirmed=True),
        method=f"{at.force} over the turn",
        closed_by=at.closed_by,
        kept_as=f"maximum {rated} load of the roller's outer ring" if at.first else "",
        formula=f"N <= {symbol}; N: {at.greatest}, {symbol}: maximum {words} load of an outer ring"
        " without a housing",
        symbols={"N": "normal_force", symbol: key},
        reason=f"an outer ring on a cam bends, and breaks {breaks}",
        values=(*given.LOADS, key),
        levers=(at.lever(f"{name}_limit", inverse=True), *levers.LOAD),
    ).measured(
        "angles",
        allowed=of_key(key),
        remark=_with_card,
        deviation=0.005,
        kept=Kept(group=NORMAL_FORCE) if at.first else None,
    )(at.normal)


_RADIAL = "radial", "dynamic radial", "F_r,max", "in fatigue"
_STATIC_RADIAL = "static_radial", "static radial", "F_0r,max", "under a single overload"
roller_radial = _outer_ring(_FIRST, *_RADIAL)
roller_static_radial = _outer_ring(_FIRST, *_STATIC_RADIAL)
second_roller_radial = _outer_ring(_SECOND, *_RADIAL)
second_roller_static_radial = _outer_ring(_SECOND, *_STATIC_RADIAL)


@check(
    VISCOSITY_RATIO,
    id="bearing_lubrication",
    title="Viscosity ratio (kappa) of the roller bearing",
    method="viscosity over v1 at the mean speed of the roller; infinite at rest",
    tier=Tier.SCREENING,
    needs="roller",
    part="roller_bearing",
    kept_as="mean speed of the roller at the least viscosity ratio",
    formula="v/v1 >= k; v1 = a n^b / sqrt(D): rated viscosity of ISO 281, n: mean speed of the"
    " roller in rpm, D: pitch diameter of its balls in mm, a, b: 45000 and -0.83 below 1000 rpm,"
    " else 4500 and -0.5, v: viscosity in operation, both in mm2/s, k: limits.viscosity_ratio",
    symbols={
        "?": _PRESSED,
        "v": "1000000 roller.bearing.viscosity",
        "D": "1000 roller.bearing.pitch_diameter",
        "n": "60 mean(|roller_speed|)/(2 pi)",
        "a": STATED,
        "b": STATED,
        "v1": "[-]",
    },
    reason="below it ISO 281 gives no modified life; above, roller_modified_life counts the film",
    values=("roller.bearing.viscosity", "roller.bearing.*pitch_diameter"),
    levers=(levers.one("roller.bearing.viscosity"),),
    page="Roller",
).measured(
    "mean",
    worst="least",
    value=_film_ratio,
    bound=lambda limit, numbers: least_speed(
        float(numbers[_VISCOSITY]), float(numbers[_CIRCLE]), limit
    ),
    needed=(_VISCOSITY, _CIRCLE),
    remark=_with_line_of_viscosity,
    deviation=0.0001,
    kept=Kept(_film_kept, power=-1.0, unit="rpm", falls=-1.0),
)
def bearing_lubrication(cam: LoadedCam) -> Array:
    """Measure: roller speed, rad/s; demand: viscosity ratio at its mean."""
    return _slowest(cam)


def _slowest(cam: LoadedCam) -> Array:
    """Speed of the roller on its pin, of two preloaded ones the lower at each angle, rad/s."""
    return -_greatest([-magnitude(each.spin) for each in cam.rollers])


def least_speed(viscosity: float, circle: float, ratio: float) -> float | None:
    """Mean roller speed, rad/s, at which viscosity over rated viscosity is `ratio`.

    None where it is above the ratio at 1 rpm already, so that any speed holds, or below it at
    `FASTEST` still, so that none does; the check itself tells which.

    Parameters
    ----------
    viscosity : float   in operation, m2/s
    circle : float      pitch diameter of the balls, m
    ratio : float       viscosity over rated viscosity (kappa of ISO 281), > 0
    """

    def excess(log_speed: float) -> float:
        rated = bearing_life.rated_viscosity(np.exp(np.asarray(log_speed)), circle)
        return float(np.log(viscosity / rated / ratio))

    ends = np.log(STANDSTILL / factor("rpm")), np.log(FASTEST)
    if not excess(ends[0]) < 0.0 < excess(ends[1]):
        return None
    speed = float(np.exp(scipy.optimize.brentq(excess, *ends, xtol=1e-13)))
    return speed * factor("rpm")


@_of_roller(
    id="grease_life",
    title="Life of the grease in the roller bearing",
    unit="h",
    sense="at_least",
    source=Source(
        "JTEKT's estimate for sealed ball bearings, with n D for a turning outer ring as SKF does;"
        " SKF states its own for a turning inner ring and P <= 0.05 C, NSK for P up to about 0.1 C",
        confirmed=False,
    ),
    method="of n D, P/C and temperature; the manufacturer's where it is given",
    kept_as="dynamic load rating of the roller at the life of its grease",
    formula="h 10^(6.10 - 4.40e-6 x - 2.50 (max(P/C, 0.05) - 0.05) - (0.021 - 1.80e-8 x)"
    " max(T, 50)) >= L; h: one hour, x = max(D n/u, 125000), D: outer diameter, u: 1 mm, n: mean"
    " speed in rpm, P: equivalent load, C: dynamic rating, T: temperature in degC, L:"
    " limits.target_life of a bearing greased for life, else roller.bearing.relubrication_interval."
    " Oil has no such life. Over the load cases"
    f" {BY_DUTY}.",
    symbols={
        "?": _PRESSED,
        "h": "3600 [s]",
        "x": "[-]",
        "D": f"{STATED} [mm]",
        "u": "0.001 [mm]",
        "n": "60 mean(|roller_speed|)/(2 pi)",
        "P": f"{STATED} [N]",
        "C": _RATING,
        "T": "roller.bearing.temperature - 273.15 [degC]",
    },
    reason="a bearing greased for life ends with its grease",
    load_cases=LASTING,
    values=(
        *given.LOADS,
        "roller.bearing.C",
        "roller.bearing.temperature",
        "roller.bearing.grease_life",
        "roller.bearing.relubrication_interval",
        "limits.target_life",
    ),
    levers=(levers.Catalogued(levers.BEARING, "C"), *levers.LOAD),
)
def grease_life(solution: Solution) -> Demand | None:
    """Life of the grease, s, stated or estimated; None for oil."""
    bearing = solution.machine.roller.bearing
    if bearing.lubrication == "oil":
        return None
    if bearing.lubrication is None:
        return Demand(None, None, missing=lacking(bearing.table, bearing, "lubrication"))
    required = grease_target(solution.numbers)
    target = None if required is None else float(required)
    if bearing.lubrication == "grease_for_life":
        missing = unset(solution.machine.limits, TARGET_LIFE)
    else:
        missing = lacking(bearing.table, bearing, "relubrication_interval")
    if bearing.grease_life is not None:
        stated = Extreme(bearing.grease_life)
        return Demand(stated.value, target, stated, missing, figures=_card(bearing))
    missing += lacking(bearing.table, bearing, "C", "temperature")
    worst, note, known = NOWHERE, "", dict[str, float]()
    if not missing:
        worst = over_duty(
            solution.cycles,
            lambda cycle: float(np.ravel(greased(cam_of(solution, cycle)))[0]),
            life=True,
        )
        if np.isnan(worst.value):
            missing = lacking(bearing.table, bearing, "grease_life")
            note = "outside the range of the estimate"
        elif all(cycle.machine.duty is None for cycle in solution.cycles):
            cam = cam_of(solution, cycle_of(solution.cycles, worst))
            load = float(np.ravel(equivalent_load(cam.normal, cam.spin))[0])
            known = {"P": load, "D": float(_greased_diameter(solution.numbers))}
    figures = _card(bearing)
    return Demand(worst.value, target, worst, missing, note=note, figures=figures, stated=known)


def greased(cam: LoadedCam) -> Array:
    """Estimated life of the grease, s, in load cases, (1,) or (m, 1).

    That of the maker where it is stated; NaN without its data or out of its range.
    """
    numbers, bearing = cam.numbers, cam.numbers.known_case.roller.bearing
    rating, temperature = numbers.get(_RATING), bearing.temperature
    if bearing.grease_life is not None:
        return np.array([bearing.grease_life])
    if rating is None or temperature is None:
        return np.array([np.nan])
    lives = list[Array]()
    for roller in cam.rollers:
        force = cam.normal if len(cam.rollers) == 1 else roller.force
        loads_finite = np.isfinite(force).all(axis=-1, keepdims=True)
        load = equivalent_load(np.where(loads_finite, force, 0.0), roller.spin)[..., None]
        share = np.where(loads_finite, load, np.nan) / rating
        speed = np.asarray(roller.mean / factor("rpm"))
        lives.append(
            bearing_life.grease_life(speed, _greased_diameter(numbers), share, temperature)
        )
    return np.asarray(np.min(lives, axis=0))


def _greased_diameter(numbers: Numbers) -> Value:
    """Outer diameter of the bearing, m."""
    ring = numbers.known_case.roller.bearing.ring
    return 2.0 * numbers["roller.radius"] if ring is None else ring.outer_diameter


class Grease(NamedTuple):
    """Data of a grease-life estimate: required life, s; C, N; outer diameter, m; temperature, K."""

    life: float
    rating: float
    diameter: float
    temperature: float

    def load_share(self, speed: Values, *, unbounded: bool = False) -> Values:
        """Greatest P/C (...) at a mean speed of the roller, rad/s; see `grease_load_share`."""
        return bearing_life.grease_load_share(
            self.life, speed / factor("rpm"), self.diameter, self.temperature, unbounded=unbounded
        )


def grease_of(machine: Machine, numbers: Numbers) -> Grease | None:
    """Data of a grease-life estimate; None where the check does not apply, with oil, and where the
    life is stated or data are missing.
    """
    if not grease_life.concerns(machine):
        return None
    bearing = machine.roller.bearing
    target, rating, temperature = grease_target(numbers), bearing.C, bearing.temperature
    if bearing.lubrication in (None, "oil") or bearing.grease_life is not None:
        return None
    if target is None or rating is None or temperature is None:
        return None
    return Grease(float(target), rating, float(_greased_diameter(numbers)), temperature)


def grease_target(numbers: Numbers) -> Value | None:
    """Required life of the grease, s."""
    bearing = numbers.known_case.roller.bearing
    for_life = bearing.lubrication == "grease_for_life"
    return numbers.get(f"limits.{TARGET_LIFE.id}") if for_life else bearing.relubrication_interval
