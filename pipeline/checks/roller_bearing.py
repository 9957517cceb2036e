"""Checks of the roller bearing: ratings, life, speed, outer ring, lubrication.

The load of the bearing is the normal force: radial, without an axial share. A life is that by the
duty of the load cases; without one that in the worst load case, run all the time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import FULL_TURN, Array, Value, Values, greatest_of
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.levers import Lever
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import factor, shown
from camwright.pipeline.case.case import Case
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
from camwright.pipeline.contact.cam_body import SECOND_BEARING
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, TurningRoller, not_negative, round_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.roller import Roller, on_second_track
from camwright.pipeline.follower.roller_motion import (
    BALL_LIFE_EXPONENT,
    RATED_REVOLUTIONS,
    equivalent_load,
    wear,
)

STANDSTILL = factor("rpm")
"""Mean speed of the roller below which the viscosity ratio does not apply, rad/s."""
FASTEST = 1e7  # rpm, of any roller
MILLION_TURNS = RATED_REVOLUTIONS * FULL_TURN  # rad
_LEAST_FORCE = 1.0  # N, of a force that damages a bearing
_AMPLE = 100.0  # times the least mean speed, of a roller at rest, which needs no film
_SURGED = (
    "normal_force + spring_surge_force/((1 - sign(follower_velocity) jam_index)"
    " cos(pressure_angle))"
)
"""Normal force with the surge of the spring, in the columns of a run."""


def _cube_mean(rating: str, force: str) -> dict[str, str]:
    """Symbols C, P_m, n of a rating life: key of the rating, and an expression of the force."""
    mean = f"(mean(({force})^3 |roller_speed|)/mean(|roller_speed|))^(1/3) [N]"
    return {"C": rating, "P_m": mean, "n": "mean(|roller_speed|)/(2 pi) [1/s]"}


class JudgedRoller(NamedTuple):
    """Roller whose bearing is judged: that in which its checks differ from those of another.

    Parameters
    ----------
    name : str           with which the ids of its checks begin
    table : str          of its bearing, dotted
    radius : str         dotted key of its radius
    bearing, ring : str  its bearing and the outer ring, in words
    force : str          greatest normal force on it, in words
    greatest : str       that over all load cases and angles, in words
    spin : str           wall on which it rolls all the turn, in words
    closed_by : str      closure with such a roller, see `Declaration`
    first : bool         its bearing is of the catalogue
    """

    name: str
    table: str
    radius: str
    bearing: str
    ring: str
    force: str
    greatest: str
    spin: str
    closed_by: ClosedBy
    first: bool

    def key(self, name: str) -> str:
        """Dotted key of a number of the bearing."""
        return f"{self.table}.{name}"

    @property
    def roller(self) -> str:
        """The roller in words."""
        return self.name.replace("_", " ")

    def roller_in(self, case: Case) -> Roller:
        """The roller of a case."""
        return case.roller if self.first else on_second_track(case.roller, case.cam)

    def bearing_in(self, case: Case) -> Bearing:
        """Its bearing."""
        return self.roller_in(case).bearing

    def figures(self, solution: Solution) -> tuple[str]:
        """Source of the bearing."""
        bearing = self.bearing_in(solution.case)
        return (f"{bearing.name}: {bearing.source}".rstrip(": "),)

    def with_card(self, demand: Demand, solution: Solution) -> Demand:
        """Demand with the source of the bearing."""
        return replace(demand, figures=self.figures(solution))

    def rollers(self, cam: LoadedCam) -> tuple[TurningRoller, ...]:
        """Rollers of a cam with this bearing: of two on a pin the one, of others all."""
        every = cam.rollers
        if cam.numbers.case is None or cam.numbers.case.cam.on_pin is None:
            return every
        return every[:1] if self.first else every[1:]

    def force_on(self, cam: LoadedCam) -> Array:
        """Normal force, N; of two rollers on a pin 0 where the other one carries."""
        if cam.numbers.case is None or cam.numbers.case.cam.on_pin is None:
            return cam.normal
        carries = cam.wall > 0.0 if self.first else cam.wall < 0.0
        return np.where(carries, cam.normal, 0.0 * cam.normal)

    def damage(self, cam: LoadedCam) -> Array:
        """N^3 |n|, N^3 rad/s; of the demand, L10 = (C/P_m)^3 10^6/n, s: P_m^3 n is the mean.

        Of two preloaded rollers at each angle the greater one, so that neither lives shorter.
        """
        rollers = self.rollers(cam)
        return greatest_of(*(wear(not_negative(each.force), each.spin) for each in rollers))

    def modified_damage(self, cam: LoadedCam) -> Array:
        """|n| (P/C)^3/a_ISO, rad/s; NaN where the viscosity ratio is outside of ISO 281."""

        def rate(roller: TurningRoller) -> Array:
            kappa = _viscosity_ratio(roller.mean, cam.numbers, self)
            within = np.real(kappa) >= bearing_life.LEAST_VISCOSITY_RATIO
            return _damage_rate(cam, roller, np.where(within, kappa, np.nan), self)

        return greatest_of(*(rate(each) for each in self.rollers(cam)))

    def fastest(self, cam: LoadedCam) -> Array:
        """Speed on the pin where it carries, rad/s; of two preloaded ones the higher."""
        return greatest_of(*(each.carries * magnitude(each.spin) for each in self.rollers(cam)))

    def slowest(self, cam: LoadedCam) -> Array:
        """Speed on the pin in its mean, of two preloaded ones the lower at each angle, rad/s.

        Measure: roller speed; demand: viscosity ratio at its mean.
        """
        return -greatest_of(*(-each.turning for each in self.rollers(cam)))

    def kept_force(self, *, limits: bool = False) -> Kept:
        """Form of a limit of the normal force, of a group of one measure; limits: the constraint of
        the group.
        """
        if self.first:
            return (
                Kept(force_over, group=NORMAL_FORCE, unit="N")
                if limits
                else Kept(group=NORMAL_FORCE)
            )
        group = f"{self.name}_static"
        return Kept(group=group, unit="N", needs=self.closed_by) if limits else Kept(group=group)

    def lever(self, rating: str, *, inverse: bool = False) -> Lever:
        """Lever of a rating; inverse: the utilisation is inverse to it."""
        if self.first:
            return levers.Catalogued(levers.BEARING, rating, inverse=inverse)
        return levers.one(self.key(rating))


FIRST_ROLLER = JudgedRoller(
    *("roller", "roller.bearing", "roller.radius", "the roller bearing", "the outer ring"),
    force="greatest normal force",
    greatest="greatest normal force over all load cases and angles, of two rollers in a groove that"
    " of the inner wall",
    spin="",
    closed_by="",
    first=True,
)
SECOND_ROLLER = JudgedRoller(
    *("second_roller", SECOND_BEARING, "cam.groove.second.radius"),
    *("the bearing of the second roller", "the outer ring of the second roller"),
    force="greatest normal force on the outer wall",
    greatest="greatest normal force on the outer wall over all load cases and angles",
    spin=" on the outer wall all the turn",
    closed_by="rollers",
    first=False,
)


def _life(worst: Value, numbers: Numbers, at: JudgedRoller) -> Value:
    """L10 (...), s, of a mean N^3 |n|."""
    return rating_over(_cube(numbers, at), worst, np.inf)


def _cube(numbers: Numbers, at: JudgedRoller) -> Value:
    """C^3 million turns, N^3 rad."""
    return numbers[at.key("C")] ** BALL_LIFE_EXPONENT * MILLION_TURNS


def _with_damage(demand: Demand, solution: Solution, at: JudgedRoller) -> Demand:
    """Demand of the rating life with the shares of the load cases in the damage, and the bearing
    card.
    """
    life = partial(_life, at=at)
    notes = [] if demand.value is None else _damage_note(solution, at.damage, life)
    stated = _of_two_rollers(demand, solution, at)
    return at.with_card(replace(demand, note="; ".join(notes), stated=stated), solution)


def _of_two_rollers(demand: Demand, solution: Solution, at: JudgedRoller) -> dict[str, float]:
    """Cube mean "P_m", N, and mean speed "n", 1/s, of a roller beside another one, in place of
    columns of the cycle, which are of the roller that carries; empty for one roller.
    """
    if not at.first or demand.at is None or not demand.at.load_case:
        return {}
    cycle = cycle_of(solution.cycles, demand.at)
    cam = cam_of(solution, cycle)
    speed = float(np.squeeze(at.rollers(cam)[0].mean))
    if len(cam.rollers) == 1 or not speed > 0.0:
        return {}
    force = (mean_of(solution, at.damage, cycle) / speed) ** (1.0 / BALL_LIFE_EXPONENT)
    return {"P_m": force, "n": speed / FULL_TURN}


def _with_speed(demand: Demand, solution: Solution, at: JudgedRoller) -> Demand:
    """Demand of the speed with the source of the bearing, and pitch speed and radius of the faster
    of two preloaded rollers.
    """
    noted = replace(demand, figures=(at.bearing_in(solution.case).source,))
    conjugate = solution.machine.cam.conjugate
    if conjugate is None or not conjugate.interference:
        return noted
    if demand.at is None or not demand.at.load_case:
        return noted
    cycle, k = row_of(solution.cycles, demand.at)
    motions = [round_of(each.motion) for each in cam_of(solution, cycle).on_bodies]
    every = [
        [float(np.broadcast_to(part, cycle.theta.shape)[k]) for part in parts]
        for parts in ((each.rolling, each.path_speed, each.size) for each in motions)
    ]
    _, speed, radius = max(every, key=lambda each: abs(each[0]))
    return replace(noted, stated={"P'": speed, "r": radius})


def _modified_life(worst: Value, numbers: Numbers) -> Value:
    """L_nm (...), s, of a mean |n| (P/C)^3/a_ISO."""
    return rating_over(_reliable(numbers), worst, np.inf)


def _reliable(numbers: Numbers) -> Value:
    """a1 million turns, rad."""
    return numbers.each(_reliability, (f"limits.{ROLLER_RELIABILITY.id}",))[0] * MILLION_TURNS


def _reliability(numbers: Numbers) -> tuple[float]:
    """a1"""
    return (bearing_life.reliability_factor(float(numbers.limit(ROLLER_RELIABILITY))),)


def _modified_kept(cam: LoadedCam, limit: float, at: JudgedRoller) -> Array | None:
    """Use of the limit of the modified life (n,) as constraint of the synthesis, at a viscosity
    ratio of at least that where ISO 281 begins; None without data.
    """
    if cam.numbers.get(at.key("viscosity")) is None:
        return None
    least = bearing_life.LEAST_VISCOSITY_RATIO

    def rate(roller: TurningRoller) -> Array:
        kappa = _viscosity_ratio(roller.mean, cam.numbers, at)
        return _damage_rate(cam, roller, np.where(np.real(kappa) > least, kappa, least), at)

    return greatest_of(*(rate(each) for each in at.rollers(cam))) / limit


def _damage_rate(cam: LoadedCam, roller: TurningRoller, kappa: Array, at: JudgedRoller) -> Array:
    """Damage per time, |n| (P/C)^3/a_ISO (n,), rad/s, at a viscosity ratio `kappa`; zero of a
    roller at rest, and where another one carries.
    """
    numbers, surged = cam.numbers, not_negative(roller.force)
    force = np.where(np.real(surged) < _LEAST_FORCE, _LEAST_FORCE, surged)
    rating, clean = numbers[at.key("C")], numbers[at.key("cleanliness_load")]
    used = bearing_life.life_used(force, rating, clean, kappa) * magnitude(roller.spin)
    return np.where((np.real(roller.mean) < STANDSTILL) | ~roller.carries, 0.0, used)


def _with_modified_damage(demand: Demand, solution: Solution, at: JudgedRoller) -> Demand:
    """Demand of the modified life with the shares of the load cases in the damage, its sources, and
    the mean factor a_ISO.
    """
    limits, notes = solution.machine.limits, list[str]()
    if demand.value is not None and np.isnan(demand.value):
        notes.append("not known for a viscosity ratio below 0.1: outside of ISO 281")
    elif demand.value is not None:
        notes = _damage_note(solution, at.modified_damage, _modified_life)
    figures = limits.source(ROLLER_RELIABILITY), bearing_life.SOURCE, *at.figures(solution)
    stated = _of_two_rollers(demand, solution, at)
    noted = replace(demand, note="; ".join(notes), figures=figures, stated=stated)
    if demand.value is None or demand.at is None:
        return noted
    cycle = cycle_of(solution.cycles, demand.at)
    plain, used = (mean_of(solution, each, cycle) for each in (at.damage, at.modified_damage))
    rating = float(solution.numbers[at.key("C")]) ** BALL_LIFE_EXPONENT
    modified = {"a_ISO": plain / rating / used} if used > 0.0 else {}
    return replace(noted, stated=stated | modified)


def _viscosity_ratio(mean: Value, numbers: Numbers, at: JudgedRoller) -> Array:
    """Viscosity over v1 (...) at a mean speed of the roller, rad/s, at least that of standstill."""
    held = np.where(np.real(np.asarray(mean)) < STANDSTILL, STANDSTILL, mean)
    circle = float(numbers[at.key("pitch_diameter")])
    rated = bearing_life.rated_viscosity(held / factor("rpm"), circle)
    return np.asarray(numbers[at.key("viscosity")] / rated)


def _film_ratio(mean: Value, numbers: Numbers, at: JudgedRoller) -> Value:
    """Viscosity ratio (...) at a mean speed of the roller, rad/s; infinite at rest."""
    return np.where(mean < STANDSTILL, np.inf, _viscosity_ratio(mean, numbers, at))[()]


def _with_line_of_viscosity(demand: Demand, solution: Solution, at: JudgedRoller) -> Demand:
    """Demand with factor "a" and power "b" of the rated viscosity at the mean speed "n" of the
    roller, rpm, between two tracks not that of the cycle at equal weights.
    """
    noted = replace(demand, figures=(bearing_life.SOURCE, at.bearing_in(solution.case).source))
    if demand.at is None or not demand.at.load_case:
        return noted
    cycle = cycle_of(solution.cycles, demand.at)
    speed = mean_of(solution, at.slowest, cycle) / factor("rpm")
    line = bearing_life.viscosity_line(speed)
    mean = {"n": speed} if solution.machine.cam.pulls else {}
    return replace(noted, stated=dict(zip("ab", line, strict=True)) | mean)


def _film_kept(cam: LoadedCam, limit: float, at: JudgedRoller) -> Array:
    """Speed over the least mean speed; no film is necessary at rest."""
    spin, (roller, *_) = at.slowest(cam), at.rollers(cam)
    turns = np.real(roller.mean) >= STANDSTILL
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
    cam, run_out = cam_of(solution, cycle), solution.machine.limits[CAM_RUN_OUT]
    discs = [
        (float(abs(tilt[row])), float(np.broadcast_to(base, tilt.shape)[row]))
        for tilt, base in zip(cam.shaft_tilts, cam.base_radii, strict=True)
    ]
    slope, base = max(discs, key=lambda disc: disc[0] + run_out / (2.0 * disc[1]))
    figures = tuple(map(solution.machine.limits.source, (AXIS_PARALLELISM, CAM_RUN_OUT)))
    note = f"{shown(slope, 'mrad', 3)} of it by the camshaft"
    return replace(demand, note=note, figures=figures, stated={"phi": slope, "r_b": base})


_of_roller = partial(
    check,
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="roller_bearing",
    page="Roller",
)
"""Declaration of a check of the bearing that a gentler lift can help."""


def _static_safety(at: JudgedRoller) -> Declaration:
    """Static safety factor of a bearing."""
    key = at.key("C0")
    return _of_roller(
        ROLLER_STATIC_SAFETY,
        id=f"{at.name}_static",  # the group of all these limits
        title=f"Static safety factor of {at.bearing}",
        method=f"static rating over the {at.force}",
        closed_by=at.closed_by,
        kept_as=f"static load rating of the {at.roller}",
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
        remark=at.with_card,
        deviation=0.005,
        kept=at.kept_force(limits=True),
    )(at.force_on)


roller_static = _static_safety(FIRST_ROLLER)


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
    " limits.cam_run_out, r_b: base radius of the disc, c, L, b: clearances, lengths and"
    " spacing of the guides",
    symbols={
        "phi": f"{STATED} [mrad]",
        "p": _AXES[0],
        "r": _AXES[1],
        "r_b": f"{STATED} [mm]",
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
    parallel, run_out = numbers.limit(AXIS_PARALLELISM), numbers.limit(CAM_RUN_OUT)
    discs = zip(cam.shaft_tilts, cam.base_radii, strict=True)
    return greatest_of(
        *(magnitude(tilt) + (parallel + run_out / (2.0 * base) + guides) for tilt, base in discs)
    )


def _load_share(at: JudgedRoller) -> Declaration:
    """Greatest load of a bearing over its dynamic rating."""
    key = at.key("C")
    return _of_roller(
        ROLLER_LOAD_SHARE,
        id=f"{at.name}_load_share",
        title=f"Greatest load over dynamic rating of {at.bearing}",
        method=f"{at.force} over the dynamic rating",
        closed_by=at.closed_by,
        kept_as=f"share of the dynamic load rating of the {at.roller}",
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
        remark=at.with_card,
        deviation=0.005,
        kept=at.kept_force(),
    )(at.force_on)


roller_load_share = _load_share(FIRST_ROLLER)
second_roller_load_share = _load_share(SECOND_ROLLER)


def _rating_life(
    at: JudgedRoller, *, method: str, mean: str, symbols: Mapping[str, str], reason: str
) -> Declaration:
    """L10 life of a bearing.

    Parameters
    ----------
    mean : str   cube mean of the force, in words
    """
    key = at.key("C")
    return _of_roller(
        ROLLER_LIFE,
        id=f"{at.name}_life",
        title=f"L10 rating life of {at.bearing}",
        method=method,
        closed_by=at.closed_by,
        kept_as=f"dynamic load rating of the {at.roller}",
        formula=f"(C/P_m)^3 10^6/n >= L; C: dynamic rating, P_m: cube mean of the {mean}, n: its"
        f" mean speed, L: limits.roller_life. Over the load cases {BY_DUTY}.",
        symbols=symbols,
        reason=reason,
        load_cases=LASTING,
        values=(*given.LOADS, *given.SURGE, *map(at.key, ("C", "fatigue_load_limit", "viscosity"))),
        levers=(at.lever("C"), *levers.LOAD),
    ).measured(
        "life",
        value=partial(_life, at=at),
        bound=lambda limit, numbers: float(_cube(numbers, at)) / limit,
        needed=(key,),
        remark=partial(_with_damage, at=at),
        deviation=0.03,
        bounded="surge",
        kept=Kept(power=1.0 / BALL_LIFE_EXPONENT, unit="N", needs=at.closed_by),
    )(at.damage)


_ON_FIRST = _cube_mean(FIRST_ROLLER.key("C"), _SURGED)
_ON_SECOND = _cube_mean(SECOND_ROLLER.key("C"), f"0.5 (1 - wall) ({_SURGED})")
"""Dynamic rating, cube mean of the force and mean speed of a roller in the symbols of a formula."""
roller_life = _rating_life(
    FIRST_ROLLER,
    method="(C / P_m)^3 million revolutions, P_m the cube mean of the normal force,"
    " surge of a coil spring included",
    mean="normal force over the revolutions of the roller, of two in a groove on its own wall, of"
    " two preloaded ones of that with the greater damage at each angle",
    symbols=_ON_FIRST,
    reason="the bearing has to last; a clean bearing that lasts longer is not credited",
)
second_roller_life = _rating_life(
    SECOND_ROLLER,
    method="as of roller_life, by the forces of the outer wall alone",
    mean="normal force on the outer wall, 0 elsewhere, over the revolutions of the roller that"
    " carries",
    symbols=_ON_SECOND,
    reason="each roller of a groove has its own wall and its own forces",
)
second_roller_static = _static_safety(SECOND_ROLLER)


def _modified_rating_life(at: JudgedRoller, symbols: Mapping[str, str]) -> Declaration:
    """Modified life of a bearing; symbols : of its cube mean."""
    keys = [at.key(name) for name in ("C", "fatigue_load_limit", "viscosity")]
    rating, limit, viscosity = keys
    return _of_roller(
        ROLLER_LIFE,
        id=f"{at.name}_modified_life",
        title=f"Modified rating life of {at.bearing}",
        method="a1 a_ISO (C / P)^3 million revolutions, the damage of the positions of a turn"
        " added; infinite at rest",
        closed_by=at.closed_by,
        kept_as=f"dynamic load rating of the {at.roller} at its modified life",
        formula="a1 a_ISO (C/P_m)^3 10^6/n >= L; a1 = 0.05 + 0.95 (ln(1/R)/ln(1/0.9))^(1/1.5): of"
        f" the reliability R, limits.roller_reliability, C, P_m, n: as of {at.name}_life, a_ISO: of"
        " the viscosity ratio and of e_C P_u/P, mean over the damage of the turn, e_C: of"
        f" {at.key('contamination')}, P_u: fatigue load"
        f" limit, L: limits.roller_life. Over the load cases {BY_DUTY}.",
        symbols={**symbols, "R": f"limits.{ROLLER_RELIABILITY.id}", "a1": "[-]", "a_ISO": STATED},
        reason="a thin or dirty film shortens the life to a tenth",
        load_cases=LASTING,
        values=(
            *given.LOADS,
            *given.SURGE,
            rating,
            at.key("C0"),
            limit,
            viscosity,
            at.key("*pitch_diameter"),
            "limits.roller_reliability",
        ),
        levers=(at.lever("C"), levers.one("roller.bearing.viscosity"), *levers.LOAD),
    ).measured(
        "life",
        value=_modified_life,
        bound=lambda limit, numbers: float(_reliable(numbers)) / limit,
        needed=(rating, limit, at.key("contamination"), viscosity, at.key("pitch_diameter")),
        remark=partial(_with_modified_damage, at=at),
        deviation=0.03,
        bounded="surge",
        kept=Kept(
            partial(_modified_kept, at=at),
            power=1.0 / BALL_LIFE_EXPONENT,
            unit="N",
            needs=at.closed_by,
        ),
    )(at.modified_damage)


roller_modified_life = _modified_rating_life(FIRST_ROLLER, _ON_FIRST)
second_roller_modified_life = _modified_rating_life(SECOND_ROLLER, _ON_SECOND)


def _speed(at: JudgedRoller, radius: str) -> Declaration:
    """Speed of a roller; radius : r, in words."""
    key = at.key("speed_limit")
    return _of_roller(
        ROLLER_SPEED_SHARE,
        id=f"{at.name}_speed",
        title=f"Maximum {at.roller} speed vs. limiting speed",
        unit="rpm",
        method="rolling without slip: w (|dP/dtheta| - r) / r",
        closed_by=at.closed_by,
        kept_as=f"limiting speed of the {at.roller}",
        formula=f"w |(|P'| - r)/r| <= x n_g; P': pitch curve by cam angle, r: {radius}, n_g:"
        " limiting speed, x: limits.roller_speed_share",
        symbols={
            "w": "cam.speed",
            "P'": "pitch_speed [mm/rad]",
            "r": "surface_radius [mm]",
            "n_g": key,
            "?": "follower.kind roller",
        },
        reason="beyond it seals and grease overheat",
        values=(key, "limits.overspeed"),
        levers=(at.lever("speed_limit", inverse=True), *levers.SPRING, *levers.GENTLER),
    ).measured(
        "angles",
        allowed=of_key(key, ROLLER_SPEED_SHARE),
        remark=partial(_with_speed, at=at),
        deviation=0.0002,
        kept=Kept(unit="rpm", needs=at.closed_by),
    )(at.fastest)


roller_speed = _speed(
    FIRST_ROLLER,
    "radius of the roller that carries, negative on the outer wall of a groove, of two rollers that"
    " of the inner wall",
)
second_roller_speed = _speed(SECOND_ROLLER, "radius of the second roller, negative")


def _outer_ring(at: JudgedRoller, name: str, words: str, symbol: str, breaks: str) -> Declaration:
    """Load of the outer ring of a bearing; name : of the rated load, in id and key."""
    key = at.key(f"{name}_limit")
    rated = name.replace("_", " ")
    return _of_roller(
        id=f"{at.name}_{name}",
        title=f"Normal force vs. maximum {words} load of {at.ring}",
        unit="N",
        source=Source(f"{symbol} of a track roller", confirmed=True),
        method=f"{at.force} over the turn",
        closed_by=at.closed_by,
        kept_as=f"maximum {rated} load of the {at.roller}'s outer ring",
        formula=f"N <= {symbol}; N: {at.greatest}, {symbol}: maximum {words} load of an outer ring"
        " without a housing",
        symbols={"N": "normal_force", symbol: key},
        reason=f"an outer ring on a cam bends, and breaks {breaks}",
        values=(*given.LOADS, key),
        levers=(at.lever(f"{name}_limit", inverse=True), *levers.LOAD),
    ).measured(
        "angles",
        allowed=of_key(key),
        remark=at.with_card,
        deviation=0.005,
        kept=at.kept_force(),
    )(at.force_on)


_RADIAL = "radial", "dynamic radial", "F_r,max", "in fatigue"
_STATIC_RADIAL = "static_radial", "static radial", "F_0r,max", "under a single overload"
roller_radial = _outer_ring(FIRST_ROLLER, *_RADIAL)
roller_static_radial = _outer_ring(FIRST_ROLLER, *_STATIC_RADIAL)
second_roller_radial = _outer_ring(SECOND_ROLLER, *_RADIAL)
second_roller_static_radial = _outer_ring(SECOND_ROLLER, *_STATIC_RADIAL)


def _lubrication(at: JudgedRoller, name: str) -> Declaration:
    """Viscosity ratio of a bearing; name : of the check."""
    viscosity, circle = at.key("viscosity"), at.key("pitch_diameter")
    return check(
        VISCOSITY_RATIO,
        id=name,
        title=f"Viscosity ratio (kappa) of {at.bearing}",
        method=f"viscosity over v1 at the mean speed of the roller{at.spin}; infinite at rest",
        tier=Tier.SCREENING,
        needs="roller",
        closed_by=at.closed_by,
        part="roller_bearing",
        kept_as=f"mean speed of the {at.roller} at the least viscosity ratio",
        formula="v/v1 >= k; v1 = a n^b / sqrt(D): rated viscosity of ISO 281, n: mean speed of the"
        f" roller in rpm{at.spin}, D: pitch diameter of its balls in mm, a, b: 45000 and -0.83"
        " below 1000 rpm, else 4500 and -0.5, v: viscosity in operation, both in mm2/s, k:"
        " limits.viscosity_ratio",
        symbols={
            "v": f"1000000 {viscosity}",
            "D": f"1000 {circle}",
            "n": "60 mean(|roller_speed|)/(2 pi)" if at.first else f"{STATED} [rpm]",
            "a": STATED,
            "b": STATED,
            "v1": "[-]",
        },
        reason="below it ISO 281 gives no modified life; above, roller_modified_life counts the"
        " film",
        values=(viscosity, at.key("*pitch_diameter")),
        levers=(levers.one("roller.bearing.viscosity"),),
        page="Roller",
    ).measured(
        "mean",
        worst="least",
        value=partial(_film_ratio, at=at),
        bound=lambda limit, numbers: least_speed(
            float(numbers[viscosity]), float(numbers[circle]), limit
        ),
        needed=(viscosity, circle),
        remark=partial(_with_line_of_viscosity, at=at),
        deviation=0.0001,
        kept=Kept(
            partial(_film_kept, at=at), power=-1.0, unit="rpm", falls=-1.0, needs=at.closed_by
        ),
    )(at.slowest)


bearing_lubrication = _lubrication(FIRST_ROLLER, "bearing_lubrication")
second_roller_lubrication = _lubrication(SECOND_ROLLER, "second_roller_lubrication")


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


def _grease(at: JudgedRoller, name: str) -> Declaration:
    """Life of the grease in a bearing; name : of the check."""

    @_of_roller(
        id=name,
        title=f"Life of the grease in {at.bearing}",
        unit="h",
        sense="at_least",
        source=Source(
            "JTEKT's estimate for sealed ball bearings, with n D for a turning outer ring as SKF"
            " does; SKF states its own for a turning inner ring and P <= 0.05 C, NSK for P up to"
            " about 0.1 C",
            confirmed=False,
        ),
        method="of n D, P/C and temperature; the manufacturer's where it is given",
        closed_by=at.closed_by,
        kept_as="dynamic load rating of the roller at the life of its grease" if at.first else "",
        formula="h 10^(6.10 - 4.40e-6 x - 2.50 (max(P/C, 0.05) - 0.05) - (0.021 - 1.80e-8 x)"
        " max(T, 50)) >= L; h: one hour, x = max(D n/u, 125000), D: outer diameter, u: 1 mm, n:"
        f" mean speed in rpm{at.spin}, P: equivalent load, C: dynamic rating, T: temperature in"
        " degC, L: limits.target_life of a bearing greased for life, else"
        f" {at.key('relubrication_interval')}. Oil has no such life. Over the load cases"
        f" {BY_DUTY}.",
        symbols={
            "h": "3600 [s]",
            "x": "[-]",
            "D": f"{STATED} [mm]",
            "u": "0.001 [mm]",
            "n": "60 mean(|roller_speed|)/(2 pi)" if at.first else f"{STATED} [rpm]",
            "P": f"{STATED} [N]",
            "C": at.key("C"),
            "T": f"{at.key('temperature')} - 273.15 [degC]",
        },
        reason="a bearing greased for life ends with its grease",
        load_cases=LASTING,
        values=(
            *given.LOADS,
            at.key("C"),
            at.key("temperature"),
            at.key("grease_life"),
            at.key("relubrication_interval"),
            "limits.target_life",
        ),
        levers=(at.lever("C"), *levers.LOAD),
    )
    def demand(solution: Solution) -> Demand | None:
        """Life of the grease, s, stated or estimated; None for oil."""
        bearing = at.bearing_in(solution.case)
        if bearing.lubrication == "oil":
            return None
        if bearing.lubrication is None:
            return Demand(None, None, missing=lacking(at.table, bearing, "lubrication"))
        required = grease_target(solution.numbers, at)
        target = None if required is None else float(required)
        if bearing.lubrication == "grease_for_life":
            missing = unset(solution.machine.limits, TARGET_LIFE)
        else:
            missing = lacking(at.table, bearing, "relubrication_interval")
        figures = at.figures(solution)
        if bearing.grease_life is not None:
            stated = Extreme(bearing.grease_life)
            return Demand(stated.value, target, stated, missing, figures=figures)
        missing += lacking(at.table, bearing, "C", "temperature")
        worst, note, known = NOWHERE, "", dict[str, float]()
        if not missing:
            worst = over_duty(
                solution.cycles,
                lambda cycle: float(np.ravel(greased(cam_of(solution, cycle), at))[0]),
                life=True,
            )
            if np.isnan(worst.value):
                missing = lacking(at.table, bearing, "grease_life")
                note = "outside the range of the estimate"
            elif all(cycle.machine.duty is None for cycle in solution.cycles):
                cam = cam_of(solution, cycle_of(solution.cycles, worst))
                turning = (_greased(cam, each, at) for each in at.rollers(cam))
                shortest = min(turning, key=lambda each: float(each.life.item()))
                known = {"D": float(_greased_diameter(solution.numbers, at))}
                known["P"] = float(shortest.load.item())
                if solution.machine.cam.pulls:
                    known["n"] = float(shortest.speed.item())
        return Demand(worst.value, target, worst, missing, note=note, figures=figures, stated=known)

    return demand


grease_life = _grease(FIRST_ROLLER, "grease_life")
second_roller_grease = _grease(SECOND_ROLLER, "second_roller_grease")


def greased(cam: LoadedCam, at: JudgedRoller) -> Array:
    """Estimated life of the grease, s, in load cases, (1,) or (m, 1).

    That of the maker where it is stated; NaN without its data or out of its range.
    """
    numbers, bearing = cam.numbers, at.bearing_in(cam.numbers.known_case)
    rating, temperature = numbers.get(at.key("C")), bearing.temperature
    if bearing.grease_life is not None:
        return np.array([bearing.grease_life])
    if rating is None or temperature is None:
        return np.array([np.nan])
    return np.asarray(np.min([_greased(cam, each, at).life for each in at.rollers(cam)], axis=0))


class _Greased(NamedTuple):
    """Life of grease in a roller, s, equivalent load, N, and mean speed, rpm: (1,) or (m, 1)."""

    life: Array
    load: Array
    speed: Array


def _greased(cam: LoadedCam, roller: TurningRoller, at: JudgedRoller) -> _Greased:
    """Estimate for the grease in a roller; its life is NaN where a force is not finite."""
    force = cam.normal if len(cam.rollers) == 1 else roller.force
    loads_finite = np.isfinite(force).all(axis=-1, keepdims=True)
    load = equivalent_load(np.where(loads_finite, force, 0.0), roller.turning)[..., None]
    share = np.where(loads_finite, load, np.nan) / cam.numbers[at.key("C")]
    speed, diameter = np.asarray(roller.mean / factor("rpm")), _greased_diameter(cam.numbers, at)
    degrees = at.bearing_in(cam.numbers.known_case).temperature
    life = bearing_life.grease_life(speed, diameter, share, np.nan if degrees is None else degrees)
    return _Greased(life, load, speed)


def _greased_diameter(numbers: Numbers, at: JudgedRoller) -> Value:
    """Outer diameter of the bearing, m."""
    ring = at.bearing_in(numbers.known_case).ring
    return 2.0 * numbers[at.radius] if ring is None else ring.outer_diameter


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
    target, rating = grease_target(numbers, FIRST_ROLLER), bearing.C
    temperature = bearing.temperature
    if bearing.lubrication in (None, "oil") or bearing.grease_life is not None:
        return None
    if target is None or rating is None or temperature is None:
        return None
    return Grease(
        float(target), rating, float(_greased_diameter(numbers, FIRST_ROLLER)), temperature
    )


def grease_target(numbers: Numbers, at: JudgedRoller) -> Value | None:
    """Required life of the grease, s."""
    bearing = at.bearing_in(numbers.known_case)
    for_life = bearing.lubrication == "grease_for_life"
    return numbers.get(f"limits.{TARGET_LIFE.id}") if for_life else bearing.relubrication_interval
