"""Checks of the guides of the stem, and of the bush of an arm's pivot: pressure, PV value,
temperature, speed, length, rotation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import GUIDE_LENGTH
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.case.scope_section import PartName
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    NONE,
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    Page,
    check,
    of_key,
)
from camwright.pipeline.checks.demands import NORMAL_FORCE, follower_speed, slope_at, slope_over
from camwright.pipeline.checks.extremes import (
    NOWHERE,
    Extreme,
    Measure,
    cycle_of,
    greatest,
    mean_of,
    row_of,
    worst_case,
    worst_measure,
)
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.part_loads import BushLoad, PartLoads
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_friction import (
    NYLON_PV,
    bush_temperature,
    thermal_resistance,
)
from camwright.pipeline.follower.guide_reactions import Guide

ARM_LENGTH = "follower.arm.length"
Side = Literal["A", "B"]
Place = Literal["A", "B", "pivot"]
GUIDES: tuple[Side, ...] = ("A", "B")
TILTED = ", the pin tilted by the greatest moment of the contact"
"""Words of the pushes on the bush of a pivot."""
ACROSS = ", with the pushes of the couple across the plane of the cam"
"""Words of the pushes on a guide of a stem."""
PLACES: tuple[Place, ...] = (*GUIDES, "pivot")
"""Guides of a stem, and the pivot of an arm, which has a bush, too."""


class BushSeat(NamedTuple):
    """Bush of a place: its name in words, its table and the one around it, as in a formula for
    all of its kind, material of the pin in it, part of the scope, and page of the report.
    """

    words: str
    table: str
    around: str
    each: str
    pin: str
    part: PartName
    page: Page
    suffix: str = ""

    def named(self, quantity: str) -> str:
        """Id of the check of a quantity."""
        return f"{self.part.rstrip('s')}_{quantity}{self.suffix}"


SEATS: Mapping[Place, BushSeat] = {
    **{
        side: BushSeat(
            f"guide {side}", f"guides.{side.lower()}", "guides", "guides.*",
            "follower.stem_material", "guides", "Guides", f"_{side}",
        )
        for side in GUIDES
    },
    "pivot": BushSeat(
        "the pivot", "follower.pivot.bush", "follower.pivot", "follower.pivot.bush",
        "follower.pivot.pin_material", "pivot", "Pivot",
    ),
}  # fmt: skip


def bush_of(stated: Machine | Case, place: Place) -> Guide | None:
    """Bush of a place of a machine or case; None of a pivot in needles, or not described."""
    if place != "pivot":
        return dict(stated.guides.both)[place]
    pivot = stated.pivot if isinstance(stated, Machine) else stated.follower.pivot
    return None if pivot is None else pivot.bush


def guide_of(machine: Machine, place: Place) -> Guide:
    """Guide A or B of a machine, or the bush of its pivot.

    Raises
    ------
    InputError
        If its pivot has none.
    """
    bush = bush_of(machine, place)
    if bush is None:
        raise InputError(table_of(place), "missing", "given for its checks")
    return bush


def table_of(place: Place) -> str:
    """Dotted name of the table of a bush."""
    return SEATS[place].table


def has_bush(place: Place) -> Callable[[Value, Numbers], NDArray[np.bool_]]:
    """Whether a place has a bush: a pivot may have needles."""
    return lambda _, numbers: np.array(numbers.get(f"{table_of(place)}.length") is not None)


def _reaction(cycle: Cycle, side: Place) -> Array:
    """Net load of a bush (n,), N."""
    if side == "pivot":
        return np.asarray(np.hypot(*cycle.loads.pivot_load))
    return cycle.guides.reaction_a if side == "A" else cycle.guides.reaction_b


def _rubbing_load(cycle: Cycle, side: Place) -> Array:
    """Pushes on both sides of a bush (n,), N."""
    if side == "pivot":
        return _known(cycle.parts.pivot_rubbing)
    return cycle.guides.rubbing_load_a if side == "A" else cycle.guides.rubbing_load_b


def _bearing_load(cycle: Cycle, side: Place) -> Array:
    """Load on the more loaded side of a bush over the loaded share of its length (n,), N."""
    if side == "pivot":
        return _known(cycle.parts.pivot_bearing)
    return cycle.guide_pushes[GUIDES.index(side)]


def _known(push: Array | None) -> Array:
    """Push on the bush of a pivot (n,), N.

    Raises
    ------
    InputError
        If the pivot has none.
    """
    if push is None:
        raise InputError(table_of("pivot"), "missing", "given for its checks")
    return push


def _heat_of(cam: LoadedCam, place: Place) -> Array | None:
    """Friction power of a bush at the greatest friction, W; None where not known."""
    if place == "pivot":
        return cam.pivot_heat
    return None if cam.heat is None else cam.heat[GUIDES.index(place)]


def _heat_in(place: Place) -> Measure:
    """Measure of the friction power of a bush at the greatest friction, W."""

    def heat(cam: LoadedCam) -> Array:
        """Friction power of a bush at the greatest friction, W."""
        power = _heat_of(cam, place)
        return np.full_like(cam.velocity, np.nan) if power is None else power

    return heat


HEAT: Mapping[Place, Measure] = {side: _heat_in(side) for side in PLACES}


def _heat_path(side: Place, numbers: Numbers) -> tuple[float | None, Value | None]:
    """Thermal resistance of a bush, K/W, and ambient temperature, K; None: not known."""
    bush = None if numbers.case is None else bush_of(numbers.case, side)
    resistance = None if bush is None else thermal_resistance(bush)
    return resistance, numbers.get(f"{SEATS[side].around}.ambient_temperature")


def _temperature(side: Place, power: Value, numbers: Numbers) -> Value:
    """Steady temperature of a guide, K, by its mean friction power, W."""
    return bush_temperature(power, *_heat_path(side, numbers))


def power_at(side: Place, temperature: float | None, numbers: Numbers) -> float | None:
    """Mean friction power of a bush, W, at which it reaches a steady temperature, K; None where
    temperature or heat path is not known, or the temperature is not above the ambient one.

    Parameters
    ----------
    side : Place        guide A or B, or the pivot of an arm
    numbers : Numbers   of the case, with thermal resistance, K/W, and ambient temperature, K
    """
    resistance, ambient = _heat_path(side, numbers)
    if temperature is None or resistance is None or ambient is None or temperature <= ambient:
        return None
    return (temperature - float(ambient)) / resistance


def hottest(solution: Solution, side: Place) -> Extreme:
    """Temperature of a bush at maximum friction in the hottest load case, K.

    NaN where ambient or thermal resistance is not known, and where the follower locks.
    """
    return worst_measure(
        solution,
        HEAT[side],
        "mean",
        lambda power: float(_temperature(side, power, solution.numbers)),
        at_least=False,
        order=2,
    )


def locks_hot(solution: Solution) -> str:
    """Why the bushes have no steady temperature, in words; "" unless the follower locks."""
    locks = [
        each.load_case for each in solution.cycles if each.parts.friction.greatest.bounded.any()
    ]
    return f"the follower locks at the greatest friction ({', '.join(locks)})" if locks else ""


class _Limit(NamedTuple):
    """Limit at the temperature of a guide, SI; the keys that it lacks, and notes on it."""

    value: float | None
    missing: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def _at_temperature(
    solution: Solution, side: Place, demand: float, limit_at: Callable[[float], float | None]
) -> _Limit:
    """Limit at the temperature of a guide.

    Without a temperature it is the limit at 20 degC: the check of the temperature is then missing.
    Where the card ends below the temperature the limit is missing, unless the demand is above that
    at 20 degC, which a warm bush does not exceed.

    Parameters
    ----------
    side : Place          guide A or B, or the pivot of an arm
    demand : float        to be judged, in the unit of the limit
    limit_at : callable   temperature, K -> limit; None without one, NaN beyond the card
    """
    cold = limit_at(ROOM)
    if cold is None:
        return _Limit(None)
    if solution.tier is Tier.SCREENING:
        return _Limit(cold, notes=("limit at 20 degC, an upper bound",))
    temperature = hottest(solution, side).value
    if np.isnan(temperature):
        why = locks_hot(solution) or "the temperature of the guide is not known"
        return _Limit(cold, notes=(f"{why}: limit at 20 degC",))
    limit = limit_at(temperature)
    at = shown(celsius(temperature), "degC", 3)
    if limit is None or np.isnan(limit):
        name = guide_of(solution.machine, side).material.name
        needed, words = f"materials.{name}.strength_at", f"the strength of {name} ends below {at}"
        return _Limit(cold if demand > cold else None, (needed,), (words,))
    return _Limit(limit, notes=(f"limit at {at}",) if limit < cold else ())


def _guide_pressure(side: Place) -> Declaration:
    """Check of the mean bearing pressure of a bush."""
    seat = SEATS[side]

    def at_its_temperature(demand: Demand, solution: Solution) -> Demand:
        guide, worst = guide_of(solution.machine, side), demand.at or NOWHERE
        limit = _at_temperature(solution, side, worst.value, guide.pressure_limit_at)
        return replace(
            demand,
            allowed=limit.value,
            missing=(*demand.missing, *limit.missing),
            note="; ".join((*limit.notes, *_pushes(solution, side, worst))),
            source=_maker(guide),
            stated=_loaded_side(solution, side, worst),
        )

    @check(
        id=seat.named("pressure"),
        title=f"Mean bearing pressure in {seat.words}",
        unit="MPa",
        source=Source("limit of the bush's maker, source of the guide", confirmed=True),
        method="greatest push on one side of the bore over diameter x loaded length, with that of a"
        " forced tilt at right angles; at most the limit at the temperature of the guide"
        if side != "pivot"
        else "greatest push on one side of the bush over diameter x loaded length, of a rigid pin"
        " in slices of a bush with clearance, tilted by the greatest moment of the contact, with"
        " the load at right angles; at most the limit at the temperature of the bush",
        lift_can_help=True,
        fails_from=Tier.SCREENING,
        error="sampling" if side == "pivot" else "guide_edges",
        part=seat.part,
        kept_as=f"bearing pressure of {seat.words}",
        formula="F / (d l) <= p R(T) / R(T_p); F: push on one side of the bore, the integral of its"
        " line load, with that of the moment of a forced tilt at right angles, l: loaded length of"
        " that side, d: diameter of the bore, of the side and angle with the greatest quotient; p:"
        f" {seat.each}.pressure_limit, R: yield strength of the bush at its temperature T and at"
        f" T_p, {seat.each}.pressure_limit_temperature.",
        symbols={
            "F": f"{STATED} [N]",
            "d": f"{table_of(side)}.diameter",
            "l": f"{STATED} [mm]",
        },
        reason="a bush above the pressure of its maker creeps and wears; opposite pushes"
        " at both ends of a guide load it although they cancel in the reaction.",
        values=(
            *given.LOADS,
            *given.TILT,
            *given.of_guide(
                side, "pressure_limit*", "material.yield_strength", "material.strength_at"
            ),
            *given.heat(side),
        ),
        levers=levers.guide(side, "pressure_limit"),
        page=seat.page,
    ).measured(
        "angles",
        allowed=of_key(f"{table_of(side)}.pressure_limit"),
        applies=has_bush(side),
        remark=at_its_temperature,
        deviation=0.1,
        kept=Kept(unit="MPa"),
    )
    def pressure(cam: LoadedCam) -> Array:
        """Mean pressure in a bush, Pa."""
        if side == "pivot":
            push = cam.pivot_load * cam.bush_bearing
        else:
            push = cam.bearing[GUIDES.index(side)]
        return magnitude(push) / cam.numbers[f"{table_of(side)}.area"]

    return pressure


def _maker(guide: Guide) -> Source:
    return guide.source or Source(f"{guide.material.name} bush", confirmed=True)


def _loaded_side(solution: Solution, side: Place, worst: Extreme) -> dict[str, float]:
    """Force on the more loaded side of the bore, N, as "F", and its loaded length, m, as "l", at
    the worst angle.
    """
    cycle, k = row_of(solution.cycles, worst)
    if side == "pivot":
        length = guide_of(cycle.machine, side).length
        load = BushLoad.of(cycle.machine, cycle.loads, cycle.follower_moment)
        reach = length if load is None else float(load.pressed.reach[k])
        return {"F": float(_bearing_load(cycle, side)[k]) * reach / length, "l": reach}
    index = GUIDES.index(side)
    push, length = cycle.guides.loaded_side(index, k)
    if cycle.sideways is not None:
        push = float(cycle.guide_pushes[index][k]) * length / guide_of(cycle.machine, side).length
    return {"F": push, "l": length}


def _pushes(solution: Solution, side: Place, worst: Extreme) -> tuple[str, ...]:
    """Note on the forces on both sides of the bore at the greatest pressure, and on the pressure by
    the reaction alone.

    Their sum is the rubbing load, their difference the reaction, but for what acts on a pivot
    across the plane of its couple.
    """
    cycle = next(each for each in solution.cycles if each.load_case == worst.load_case)
    k = first_greatest(_bearing_load(cycle, side))
    both, net = float(_rubbing_load(cycle, side)[k]), abs(float(_reaction(cycle, side)[k]))
    alone = shown(net / guide_of(cycle.machine, side).projected_area, "MPa", 3)
    if side == "pivot":
        return (f"pushes of {shown(both, 'N', 4)} on both sides; {alone} by the load alone",)
    tilted = ""
    if (across := cycle.sideways) is not None:
        load = float((across.reaction_a if side == "A" else across.reaction_b)[k])
        tilted = f"; {shown(abs(load), 'N', 4)} across them by the forced tilt of the contact"
    greater, less = (shown(0.5 * each, "N", 4) for each in (both + net, both - net))
    both_sides = f"pushes of {greater} and {less} on opposite sides"
    return (f"{both_sides}; {alone} by the net reaction{tilted}",)


def _pv_in(side: Place) -> Measure:
    """Measure of the PV value of a bush."""

    def pv(cam: LoadedCam) -> Array:
        """PV value in a bush at each angle, Pa m/s: of the sum of the pushes on both sides."""
        if side == "pivot":
            power = cam.pivot_load * cam.bush_rubbing * cam.pin_velocity
        else:
            power = cam.rubbing[GUIDES.index(side)] * cam.velocity
        return magnitude(power) / cam.numbers[f"{table_of(side)}.area"]

    return pv


PV: Mapping[Place, Measure] = {side: _pv_in(side) for side in PLACES}


def _pv_of_reaction(side: Place, cycle: Cycle) -> float:
    """PV value by the net reaction, in which loads on opposite sides of the bore cancel, Pa m/s."""
    guide, arm = guide_of(cycle.machine, side), cycle.machine.arm if side == "pivot" else None
    share = 1.0 if arm is None else 0.5 * guide.diameter / arm.length
    rubbed = np.mean(np.abs(_reaction(cycle, side) * cycle.loads.velocity))
    return float(rubbed) * share / guide.projected_area


def _pv_allowed(side: Place, numbers: Numbers) -> Allowed:
    """Allowed PV value, Pa m/s: as stated, or of nylon by its lubrication."""
    key, case = f"{table_of(side)}.pv_limit", numbers.case
    stated, bush = numbers.get(key), None if case is None else bush_of(case, side)
    if stated is None and bush is not None:
        stated = pv_limit(bush)
    return Allowed(stated, (key,) if stated is None else ())


def _guide_pv(side: Place) -> Declaration:
    """Check of the mean PV value of a bush."""
    seat, speed = SEATS[side], "follower_velocity"
    load = f"guide_normal_load_{side}"
    if side == "pivot":
        load = "pivot_rubbing_load"
        speed = f"follower_velocity {seat.table}.diameter/(2 {ARM_LENGTH})"

    def in_words(demand: Demand, solution: Solution) -> Demand:
        """Demand with the lubrication that bears it and the PV value by the net reaction, in words,
        and the source of its limit.
        """
        guide = guide_of(solution.machine, side)
        notes = _lubrication(guide, (demand.at or NOWHERE).value)
        alone = worst_case(solution.cycles, partial(_pv_of_reaction, side))
        notes.append(f"{shown(alone.value, 'MPa m/s', 3)} by the net reaction")
        return replace(demand, note="; ".join(notes), source=_pv_source(guide))

    return check(
        id=seat.named("pv"),
        title=f"PV value in {seat.words}",
        unit="MPa m/s",
        source=Source(
            "limit of the bush's maker; of nylon by its lubrication, Mott, table 16-1",
            confirmed=False,
        ),
        method="mean |R v| over the turn over diameter x length; R: sum of the loads on both sides"
        f" of the bore{TILTED if side == 'pivot' else ACROSS}",
        lift_can_help=True,
        tier=Tier.SCREENING,
        error="sampling" if side == "pivot" else "guides",
        part=seat.part,
        kept_as=f"PV of {seat.words}",
        formula="mean(|R v|) / (d L) <= PV; R: sum of the pushes on both sides of the bore, v:"
        " sliding speed, mean over the turn, d, L: diameter and length of the guide; PV:"
        f" {seat.each}.pv_limit, or the limit of nylon by {seat.each}.lubrication.",
        symbols={
            "mean(|R v|)": f"mean(|{load} {speed}|) [N m/s]",
            "d": f"{table_of(side)}.diameter",
            "L": f"{table_of(side)}.length",
            "PV": f"{table_of(side)}.pv_limit",
        },
        reason="the heat that a bush can carry off and its wear rate are stated by its"
        " maker as a PV value.",
        values=(*given.LOADS, *given.of_guide(side, "pv_limit")),
        levers=levers.guide(side, "pv_limit"),
        page=seat.page,
    ).measured(
        "mean",
        allowed=partial(_pv_allowed, side),
        applies=has_bush(side),
        remark=in_words,
        deviation=0.03,
        kept=Kept(unit="MPa m/s"),
    )(PV[side])


def pv_limit(guide: Guide) -> float | None:
    """PV limit of a guide, for nylon by its lubrication, Pa m/s."""
    state = _graded_state(guide)
    return guide.pv_limit if state is None else NYLON_PV[state]


def _pv_source(guide: Guide) -> Source:
    """Source of the PV limit: the maker's, or the table of nylon."""
    state = _graded_state(guide)
    if state is None:
        return _maker(guide)
    words = state.replace("_", " ")
    graded = f"nylon, {words}: Mott, table 16-1, and a bush maker's graded limits"
    return Source("; ".join(filter(None, (graded, guide.source.text))), confirmed=False)


def _graded_state(guide: Guide) -> str | None:
    """Lubrication of a nylon guide without a PV limit of its own; None for others."""
    graded = guide.pv_limit is None and _is_nylon(guide)
    return guide.lubrication if graded else None


def _lubrication(guide: Guide, demand: float) -> list[str]:
    """Note on the least lubrication at which nylon bears a PV value, Pa m/s; empty for other
    materials.
    """
    if not _is_nylon(guide):
        return []
    states = [state.replace("_", " ") for state, limit in NYLON_PV.items() if demand <= limit]
    return [f"permissible for nylon {states[0]}" if states else "above all PV limits of nylon"]


def _is_nylon(guide: Guide) -> bool:
    return "nylon" in guide.material.name.lower()


def _guide_edge_pressure(side: Place) -> Declaration:
    """Check of the greatest pressure between pin or stem and bore of a bush."""
    seat = SEATS[side]
    inside, column = f"Guide edge pressure in {seat.words}", f"guide_edge_pressure_{side}"
    if side == "pivot":
        inside, column = "Edge pressure in the bush of the pivot", f"{side}_edge_pressure"

    @check(
        id=column,
        title=f"{inside} vs. yield strength",
        unit="MPa",
        source=Source(
            "yield strength of the bush at its temperature, source of the material",
            confirmed=True,
        ),
        method="pin in a bore with clearance, bush in a rigid housing, at the greatest line load of"
        " the beam, with that of a forced tilt at right angles; modulus at 20 degC, an upper bound;"
        " yield strength at the temperature of the guide"
        if side != "pivot"
        else "rigid pin in slices of a bush with clearance in a rigid housing, tilted by the"
        " greatest moment of the contact; pin and bush by finite elements where the contact of the"
        " cam is; modulus at 20 degC, an upper bound; yield strength at the temperature of the"
        " bush",
        lift_can_help=True,
        tier=Tier.SCREENING if side == "pivot" else Tier.PREVIEW,
        error="pivot" if side == "pivot" else "guide_edges",
        part=seat.part,
        kept_as=f"line load of {seat.words} at the yield strength",
        formula="p <= R(T); p: greatest pressure between pin or stem and bore, where the line load"
        " along the bush is greatest, R: yield strength of the bush at its temperature T.",
        symbols={"p": column},
        reason="an edge above the yield strength is pressed out, and the guide loses its"
        " length and its clearance.",
        values=(
            *given.LOADS,
            *given.TILT,
            *given.of_guide(side, "material.yield_strength", "material.strength_at"),
            *given.heat(side),
        ),
        levers=levers.guide(side, "pressure_limit"),
        page=seat.page,
        scales_with=(NORMAL_FORCE, 1.0) if side == "pivot" else (),
        along=(lambda _, cycle: _edge(cycle.parts, side)) if side == "pivot" else None,
    )
    def edge(solution: Solution) -> Demand | None:
        """Maximum edge pressure, Pa; None of a pivot without a bush."""
        bush = bush_of(solution.machine, side)
        if bush is None:
            return None
        card, missing = bush.material, _lacking_pin(solution.machine, side)
        if missing:
            return Demand(None, card.yield_strength, missing=missing)
        worst = greatest(solution.cycles, lambda cycle: _edge(cycle.parts, side))
        limit = _at_temperature(solution, side, worst.value, card.yield_strength_at)
        demand = Demand(
            worst.value,
            limit.value,
            worst,
            limit.missing,
            note="; ".join(limit.notes),
            source=card.source.of(f"yield strength of {card.name}"),
        )
        return _by_elements(demand, solution) if side == "pivot" else demand

    return edge


def _by_elements(demand: Demand, solution: Solution) -> Demand:
    """Demand on the edge of the bush of a pivot with the method and figures of the finite elements
    where it is one of them.
    """
    cycle, row = row_of(solution.cycles, demand.at or NOWHERE)
    if cycle.pivot is None:
        pressed = cycle.contact.tier is Tier.CYCLE and cycle.end is None and demand.value
        if not pressed:
            return demand
        words = "by slices: the contact is narrower than the grid of finite elements"
        return replace(demand, note="; ".join(filter(None, (demand.note, words))))
    pivot = cycle.pivot
    notes = (
        f"{shown(float(pivot.foundation[row]), 'MPa', 3)} by a rigid pin in slices",
        f"the pin tilts by {shown(float(pivot.tilt[row]), 'mrad', 3)}, its clearance included",
        f"error bar {100.0 * pivot.error:.2g} % of two meshes",
        f"solved at {pivot.solved} angles, halfway between fewer of which at most"
        f" {100.0 * pivot.difference:.2g} % of it were missed",
    )
    method = (
        "pin and bush by finite elements along their axis and harmonics around it, in contact with"
        " clearance under force and couple; bush bonded into a rigid housing, pin held along its"
        " axis; at an end the mean over limits.end_mean_length; modulus at 20 degC, an upper bound;"
        " yield strength at the temperature of the bush"
    )
    return replace(demand, method=method, note="; ".join(filter(None, (demand.note, *notes))))


def _lacking_pin(machine: Machine, place: Place) -> tuple[str, ...]:
    """Key of the material of the pin of a pivot, where it is missing."""
    pivot = machine.pivot
    return lacking(pivot.table, pivot, "pin_material") if place == "pivot" and pivot else ()


def _edge(parts: PartLoads, side: Place) -> Array:
    """Greatest pressure in a bush (n,), Pa."""
    if side == "pivot":
        unknown = np.full_like(parts.guide_edge_pressure_a, np.nan)
        return unknown if parts.pivot_edge_pressure is None else parts.pivot_edge_pressure
    return parts.guide_edge_pressure_a if side == "A" else parts.guide_edge_pressure_b


def _guide_temperature(side: Place) -> Declaration:
    """Check of the steady temperature of a bush."""
    seat = SEATS[side]

    def of_card(numbers: Numbers) -> float | None:
        bush = None if numbers.case is None else bush_of(numbers.case, side)
        return None if bush is None else bush.material.temperature_limit

    def allowed(numbers: Numbers) -> Allowed:
        stated = of_card(numbers)
        return Allowed(None if stated is None else celsius(stated))

    def in_words(demand: Demand, solution: Solution) -> Demand:
        """Demand with the keys that it lacks, the source of its limit and the mean friction power
        "Q", W.
        """
        machine = solution.machine
        card = guide_of(machine, side).material
        missing = (*heat_path_lacks(machine, side), *lacking_of_card(card, "temperature_limit"))
        sourced = replace(
            demand, missing=missing, source=card.source.of(card.name), note=locks_hot(solution)
        )
        if sourced.note or demand.at is None or not demand.at.load_case:
            return sourced
        cycle = cycle_of(solution.cycles, demand.at)
        return replace(sourced, stated={"Q": mean_of(solution, HEAT[side], cycle)})

    return check(
        id=seat.named("temperature"),
        title=f"Temperature of {seat.words}",
        unit="degC",
        source=Source("temperature limit of the bush, source of the material", confirmed=True),
        method="ambient plus mean friction power at the greatest friction times the thermal"
        f" resistance of wall and housing, steady state{TILTED if side == 'pivot' else ACROSS}",
        lift_can_help=True,
        part=seat.part,
        kept_as=f"friction power of {seat.words} at its greatest temperature",
        formula="T_amb + Q (R_wall + R_housing) <= T_max; Q: mean friction power over the turn at"
        " the greatest friction, R_wall = ln(1 + 2 t/d) / (2 pi lambda L): of a wall t:"
        f" {seat.each}.wall, R_housing: {seat.each}.housing_resistance;"
        f" {seat.each}.thermal_resistance in place of both; T_amb:"
        f" {seat.around}.ambient_temperature; T_max: temperature limit of the bush.",
        symbols={
            "?": f"{table_of(side)}.thermal_resistance None",
            "T_amb": f"{seat.around}.ambient_temperature - 273.15 [degC]",
            "Q": f"{STATED} [W]",
            "R_wall": "[K/W]",
            "R_housing": f"{table_of(side)}.housing_resistance",
            "t": f"{table_of(side)}.wall",
            "d": f"{table_of(side)}.diameter",
            "L": f"{table_of(side)}.length",
            "lambda": f"{table_of(side)}.material.conductivity",
        },
        reason="strength, clearance and wear of a bush depend on its temperature.",
        values=(
            *given.LOADS,
            *given.of_guide(side, "material.temperature_limit"),
            *given.heat(side),
        ),
        levers=(
            levers.one(f"{table_of(side)}.housing_resistance", -1),
            *levers.guide(side, "friction_max"),
        ),
        page=seat.page,
    ).measured(
        "mean",
        applies=has_bush(side),
        value=lambda power, numbers: celsius(_temperature(side, power, numbers)),
        bound=lambda _, numbers: power_at(side, of_card(numbers), numbers),
        allowed=allowed,
        remark=in_words,
        kept=Kept(
            lambda cam, limit: None if _heat_of(cam, side) is None else HEAT[side](cam) / limit,
            group=seat.named("temperature"),
            unit="W",
        ),
    )(HEAT[side])


def heat_path_lacks(machine: Machine, side: Place) -> tuple[str, ...]:
    """Dotted keys that the case lacks for the temperature of a bush."""
    guide, ambient = guide_of(machine, side), "ambient_temperature"
    around = machine.pivot if side == "pivot" and machine.pivot else machine.guides
    missing = lacking(SEATS[side].around, around, ambient)
    if guide.thermal_resistance is not None:
        return missing
    wall = lacking(table_of(side), guide, "wall", "housing_resistance")
    return (*missing, *wall, *lacking_of_card(guide.material, "conductivity"))


def _pin_speed(cam: LoadedCam) -> Array:
    """Measure: sliding speed on the pin of a pivot, m/s."""
    return magnitude(cam.pin_velocity)


def _slope_on_pin(speed: float, numbers: Numbers) -> float:
    """Lift slope, m/rad, at a sliding speed on the pin of a pivot in the fastest load case."""
    radius = 0.5 * float(numbers["follower.pivot.diameter"])
    return slope_at(speed, numbers) * float(numbers[ARM_LENGTH]) / radius


def _guide_speed(side: Place) -> Declaration:
    seat, pinned = SEATS[side], side == "pivot"
    speed = f"follower_velocity {seat.table}.diameter/(2 {ARM_LENGTH}) [m/s]"
    return check(
        id=seat.named("speed"),
        title=f"Maximum sliding speed in {seat.words}",
        unit="m/s",
        source=Source("limit of the bush's maker, source of the guide", confirmed=True),
        method="greatest sliding speed on the pin over the turn"
        if pinned
        else "greatest speed of the follower over the turn",
        lift_can_help=True,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part=seat.part,
        kept_as=f"lift per radian at the maximum sliding speed in {seat.words}",
        formula=f"max |v| <= v_max; v: speed of the {'pin' if pinned else 'stem'} in the bush,"
        f" v_max: {seat.each}.speed_limit.",
        symbols={
            "v": speed if pinned else "follower_velocity",
            "v_max": f"{table_of(side)}.speed_limit",
        },
        reason="a PV limit holds up to the greatest speed of the bush; above it the"
        " rubbing surface overheats at any load.",
        values=(*given.LOADS, *given.of_guide(side, "speed_limit")),
        levers=levers.rubbing_speed(side),
        page=seat.page,
    ).measured(
        "angles",
        allowed=of_key(f"{table_of(side)}.speed_limit"),
        applies=has_bush(side),
        remark=lambda demand, solution: replace(
            demand, source=_maker(guide_of(solution.machine, side))
        ),
        deviation=0.002,
        bound=_slope_on_pin if pinned else slope_at,
        kept=Kept(slope_over, unit="mm", unloaded=True),
    )(_pin_speed if pinned else follower_speed)


guide_pressure_a, guide_pressure_b = _guide_pressure("A"), _guide_pressure("B")
guide_pv_a, guide_pv_b = _guide_pv("A"), _guide_pv("B")
guide_edge_pressure_a, guide_edge_pressure_b = _guide_edge_pressure("A"), _guide_edge_pressure("B")
guide_temperature_a, guide_temperature_b = _guide_temperature("A"), _guide_temperature("B")
guide_speed_a, guide_speed_b = _guide_speed("A"), _guide_speed("B")
pivot_pressure, pivot_pv = _guide_pressure("pivot"), _guide_pv("pivot")
pivot_edge_pressure = _guide_edge_pressure("pivot")
pivot_temperature, pivot_speed = _guide_temperature("pivot"), _guide_speed("pivot")


@check(
    GUIDE_LENGTH,
    title="Guided length / maximum overhang",
    method="distance of the outer ends of the guides over the overhang at minimum lift",
    must_have=False,
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="guides",
    formula="(b + (L_A + L_B) / 2) / a >= n; b: spacing of guides, L: their lengths, a: overhang"
    " of the roller centre or face at minimum lift, n: limits.guide_length.",
    symbols={
        "b": "guides.spacing",
        "L_A": "guides.a.length",
        "L_B": "guides.b.length",
        "a": "follower.overhang_at_max_lift + lift_highest [mm]",
    },
    reason="a rule of proportion; the reactions, jam index and pressures that it"
    " guards on the drawing board are computed, and are must-have.",
    load_cases=NONE,
    page="Guides",
).measured(
    "top",
    worst="least",
    remark=lambda demand, _: replace(demand, at=None),
    deviation=1e-4,
)
def guide_length(cam: LoadedCam) -> Array:
    """Distance between the outer ends of the guides over the overhang."""
    numbers = cam.numbers
    ends = 0.5 * (numbers["guides.a.length"] + numbers["guides.b.length"])
    overhang: Array = numbers["follower.overhang_at_max_lift"] + cam.jet.lift
    return (numbers["guides.spacing"] + ends) / overhang


@check(
    id="anti_rotation",
    title="Free rotation of the stem",
    unit="rotations",
    source=Source(
        "a round stem turns freely in round guides; a cylindrical roller follows the cam only"
        " with its axis parallel to the camshaft",
        confirmed=True,
    ),
    method="0 where the case states a means against rotation, or a flat face that needs none",
    moved_by_tolerance=False,
    part="guides",
    formula="n <= 0; n: rotations of the stem about its axis that nothing prevents, by"
    ' follower.anti_rotation; "not_needed" holds for a flat face alone.',
    symbols={"n": STATED},
    reason="a roller that turns about the stem runs on its edge, and no other check sees it.",
    load_cases=NONE,
    page="Follower",
)
def anti_rotation(solution: Solution) -> Demand:
    """Number of free rotations of the stem about its axis."""
    means = solution.case.follower.anti_rotation
    if means is None:
        return Demand(None, 0.0, missing=("follower.anti_rotation",))
    free = means == "not_needed" and solution.machine.follower.contact_radius is not None
    note = "a roller needs a means against rotation" if free else means.replace("_", " ")
    return Demand(float(free), 0.0, note=note, stated={"n": float(free)})
