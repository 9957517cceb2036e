"""Checks of the guides of the stem: pressure, PV value, temperature, length."""

from __future__ import annotations

from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import GUIDE_LENGTH
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.checks.extremes import Extreme, greatest, worst_case
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import PartLoads
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_friction import NYLON_PV, GuideHeat
from camwright.pipeline.follower.guide_reactions import Guide

Side = Literal["A", "B"]


def guide_of(machine: Machine, side: Side) -> Guide:
    """Guide A or B."""
    return machine.guides.a if side == "A" else machine.guides.b


def heat_of(parts: PartLoads, side: Side) -> GuideHeat:
    """Friction heat of guide A or B."""
    return parts.heat_a if side == "A" else parts.heat_b


def _reaction(cycle: Cycle, side: Side) -> Array:
    return cycle.guides.reaction_a if side == "A" else cycle.guides.reaction_b


def _guide_pressure(side: Side) -> Declaration:
    @check(
        id=f"guide_pressure_{side}",
        title=f"Mean bearing pressure in guide {side}",
        unit="MPa",
        method="greatest reaction over diameter x length",
        lift_can_help=True,
        forecast=True,
        error="guides",
    )
    def pressure(solution: Solution) -> Demand:
        """Maximum over the turn of the mean pressure in a guide, Pa."""
        guide = guide_of(solution.machine, side)
        worst = greatest(
            solution.cycles,
            lambda c: demands.guide_pressure(_reaction(c, side), guide.projected_area),
        )
        missing = [] if guide.pressure_limit is not None else [_no_limit("pressure", side)]
        return Demand(
            worst.value,
            guide.pressure_limit,
            worst,
            note="; ".join([*missing, _contributions(solution, side, worst)]),
            source=_maker(guide),
        )

    return pressure


def _no_limit(quantity: str, side: Side) -> str:
    return f"no {quantity} limit is given for guide {side}"


def _maker(guide: Guide) -> str:
    return guide.source or f"{guide.material.name} bush"


def _contributions(solution: Solution, side: Side, worst: Extreme) -> str:
    """Contributions of point supports, length and clearance to the maximum pressure."""
    if solution.coarse:
        return ""
    cycle = next(each for each in solution.cycles if each.load_case == worst.load_case)
    share, guides = cycle.parts.shares.reaction_a, cycle.guides
    statics = guides.statics_a if side == "A" else guides.statics_b
    reaction = _reaction(cycle, side)
    k = int(np.argmax(np.abs(reaction)))
    per_newton = np.sign(reaction[k]) / guide_of(cycle.machine, side).projected_area
    points, length, clearance = (
        shown(float(per_newton * each[k]), "MPa", 3)
        for each in (statics, share.by_length, share.by_clearance)
    )
    return f"{points} on point supports, {length} from length, {clearance} from clearance"


def mean_pv(cycle: Cycle, side: Side) -> float:
    """PV value in guide A or B, mean over the turn, Pa m/s."""
    guides = cycle.guides
    load = guides.rubbing_load_a if side == "A" else guides.rubbing_load_b
    area = guide_of(cycle.machine, side).projected_area
    return float(np.mean(demands.guide_pv(load, cycle.loads.velocity, area)))


def _pv_of_reaction(cycle: Cycle, side: Side) -> float:
    """PV value by the net reaction, in which loads on opposite sides of the bore cancel, Pa m/s."""
    load, area = np.abs(_reaction(cycle, side)), guide_of(cycle.machine, side).projected_area
    return float(np.mean(demands.guide_pv(load, cycle.loads.velocity, area)))


def _guide_pv(side: Side) -> Declaration:
    @check(
        id=f"guide_pv_{side}",
        title=f"PV value in guide {side}",
        unit="MPa m/s",
        method="mean |R v| over the turn over diameter x length; R: sum of the loads on both sides"
        " of the bore",
        lift_can_help=True,
        forecast=True,
        error="guides",
    )
    def pv(solution: Solution) -> Demand:
        """PV value in a guide, mean over the turn, Pa m/s."""
        guide = guide_of(solution.machine, side)
        worst = worst_case(solution.cycles, lambda cycle: mean_pv(cycle, side))
        alone = worst_case(solution.cycles, lambda cycle: _pv_of_reaction(cycle, side))
        limit = pv_limit(guide)
        notes = [] if limit is not None else [_no_limit("PV", side)]
        notes += _lubrication(guide, worst.value)
        notes.append(f"{shown(alone.value, 'MPa m/s', 3)} by the net reaction")
        return Demand(worst.value, limit, worst, note="; ".join(notes), source=_pv_source(guide))

    return pv


def pv_limit(guide: Guide) -> float | None:
    """PV limit of a guide, or of nylon by its lubrication, Pa m/s."""
    state = _graded_state(guide)
    return guide.pv_limit if state is None else NYLON_PV[state]


def _pv_source(guide: Guide) -> str:
    state = _graded_state(guide)
    if state is None:
        return _maker(guide)
    words = state.replace("_", " ")
    graded = f"nylon, {words}: Mott, table 16-1, and a bush maker's graded limits: verify"
    return "; ".join(each for each in (graded, guide.source) if each)


def _graded_state(guide: Guide) -> str | None:
    """Lubrication of a nylon guide without a PV limit of its own; None for others."""
    graded = guide.pv_limit is None and _is_nylon(guide)
    return guide.lubrication if graded else None


def _lubrication(guide: Guide, demand: float) -> list[str]:
    """Least lubrication of nylon for a PV value, Pa m/s; empty for other materials."""
    if not _is_nylon(guide):
        return []
    states = [state.replace("_", " ") for state, limit in NYLON_PV.items() if demand <= limit]
    return [f"permissible for nylon {states[0]}" if states else "above all PV limits of nylon"]


def _is_nylon(guide: Guide) -> bool:
    return "nylon" in guide.material.name.lower()


def _guide_edge_pressure(side: Side) -> Declaration:
    @check(
        id=f"guide_edge_pressure_{side}",
        title=f"Guide edge pressure in guide {side} vs. yield strength",
        unit="MPa",
        method="pin in a bore with clearance, bush in a rigid housing, at the greatest line load of"
        " the beam",
        must_have=False,
        lift_can_help=True,
        error="guides",
    )
    def edge(solution: Solution) -> Demand:
        """Maximum guide edge pressure, Pa."""
        card = guide_of(solution.machine, side).material
        worst = greatest(solution.cycles, lambda cycle: _edge(cycle.parts, side))
        source = f"yield strength of {card.name}: {card.source}"
        return Demand(worst.value, card.yield_strength, worst, source=source)

    return edge


def _edge(parts: PartLoads, side: Side) -> Array:
    return parts.guide_edge_pressure_a if side == "A" else parts.guide_edge_pressure_b


def _guide_temperature(side: Side) -> Declaration:
    @check(
        id=f"guide_temperature_{side}",
        title=f"Temperature of guide {side}",
        unit="degC",
        method="friction heat through the wall of the bush, or the thermal resistance of the case;"
        " an estimate",
        must_have=False,
        lift_can_help=True,
    )
    def temperature(solution: Solution) -> Demand:
        """Steady temperature of a guide, degC."""
        guide = guide_of(solution.machine, side)
        card = guide.material
        worst = worst_case(solution.cycles, lambda c: celsius(heat_of(c.parts, side).temperature))
        limit = card.temperature_limit
        notes = _hottest(solution, side, worst.value)
        if guide.thermal_resistance is None and card.conductivity is None:
            notes.append("no thermal resistance and no conductivity are given")
        if limit is None:
            notes.append(f"no temperature limit of {card.name} is given")
        return Demand(
            worst.value,
            None if limit is None else celsius(limit),
            worst,
            note="; ".join(notes),
            source=f"{card.name}: {card.source}",
        )

    return temperature


def _hottest(solution: Solution, side: Side, nominal: float) -> list[str]:
    """Temperature at maximum friction, if above the nominal one, degC."""
    ambient, hot = solution.machine.guides.ambient_temperature, []
    for cycle in solution.cycles:
        heat, worst = heat_of(cycle.parts, side), cycle.parts.friction.greatest
        friction = worst.friction_force_a if side == "A" else worst.friction_force_b
        power = float(np.mean(friction * np.abs(worst.velocity)))
        if heat.mean_power > 0.0:
            rise = (heat.temperature - ambient) * power / heat.mean_power
            hot.append(celsius(ambient + rise))
    hottest = max(hot, default=np.nan)
    return [f"{shown(hottest, 'degC', 3)} at maximum friction"] if hottest > nominal else []


guide_pressure_a, guide_pressure_b = _guide_pressure("A"), _guide_pressure("B")
guide_pv_a, guide_pv_b = _guide_pv("A"), _guide_pv("B")
guide_edge_pressure_a, guide_edge_pressure_b = _guide_edge_pressure("A"), _guide_edge_pressure("B")
guide_temperature_a, guide_temperature_b = _guide_temperature("A"), _guide_temperature("B")


@check(
    GUIDE_LENGTH,
    title="Guided length / maximum overhang",
    method="distance of the outer ends of the guides over the overhang at minimum lift",
    must_have=False,
    lift_can_help=True,
    moved_by_tolerance=False,
)
def guide_length(solution: Solution) -> Demand:
    """Distance of the outer ends of the guides over the maximum overhang."""
    machine, guides = solution.machine, solution.machine.guides
    overhang = machine.overhang_at_max_lift + solution.contour.pitch.lift.highest.value
    spread = guides.spacing + 0.5 * (guides.a.length + guides.b.length)
    return Demand(spread / overhang, machine.limits[GUIDE_LENGTH])
