"""The two guides of the stem: pressure, PV value, temperature, length."""

from __future__ import annotations

from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import GUIDE_LENGTH
from camwright.pipeline.checks import demands
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.checks.extremes import Extreme, greatest, worst_case
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import PartLoads
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_friction import NYLON_PV, GuideHeat
from camwright.pipeline.follower.guide_reactions import Guide

Side = Literal["A", "B"]


def guide_of(cycle: Cycle, side: Side) -> Guide:
    """Guide A or B of a load case."""
    guides = cycle.machine.guides
    return guides.a if side == "A" else guides.b


def heat_of(parts: PartLoads, side: Side) -> GuideHeat:
    """Friction heat of guide A or B."""
    return parts.heat_a if side == "A" else parts.heat_b


def _guide(solution: Solution, side: Side) -> Guide:
    guides = solution.machine.guides
    return guides.a if side == "A" else guides.b


def _reaction(cycle: Cycle, side: Side) -> Array:
    return cycle.guides.reaction_a if side == "A" else cycle.guides.reaction_b


def _guide_pressure(side: Side) -> Declaration:
    @check(
        id=f"guide_pressure_{side}",
        title=f"Bearing pressure in guide {side}",
        unit="MPa",
        method="greatest reaction over diameter x length",
        lift_can_help=True,
        forecast=True,
        error="guides",
    )
    def pressure(solution: Solution) -> Demand:
        """Greatest mean pressure in a guide, Pa."""
        guide = _guide(solution, side)
        worst = greatest(
            solution.cycles,
            lambda c: demands.bush_pressure(_reaction(c, side), guide.projected_area),
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
    """Contributions of point supports, of length and of clearance to the greatest pressure."""
    if solution.coarse:
        return ""
    cycle = next(each for each in solution.cycles if each.load_case == worst.load_case)
    share, guides = cycle.parts.shares.reaction_a, cycle.guides
    statics = guides.statics_a if side == "A" else guides.statics_b
    reaction = _reaction(cycle, side)
    k = int(np.argmax(np.abs(reaction)))
    per_newton = np.sign(reaction[k]) / guide_of(cycle, side).projected_area
    points, length, clearance = (
        shown(float(per_newton * each[k]), "MPa", 3)
        for each in (statics, share.by_length, share.by_clearance)
    )
    return f"{points} on point supports, {length} from length, {clearance} from clearance"


def mean_pv(cycle: Cycle, side: Side) -> float:
    """Pressure times sliding speed in guide A or B, mean over the turn, Pa m/s."""
    guides = cycle.guides
    load = guides.rubbing_load_a if side == "A" else guides.rubbing_load_b
    area = guide_of(cycle, side).projected_area
    return float(np.mean(demands.bush_pv(load, cycle.loads.velocity, area)))


def _pv_of_reaction(cycle: Cycle, side: Side) -> float:
    """The same by the reaction, in which loads of opposite sides cancel though both rub."""
    load, area = np.abs(_reaction(cycle, side)), guide_of(cycle, side).projected_area
    return float(np.mean(demands.bush_pv(load, cycle.loads.velocity, area)))


def _guide_pv(side: Side) -> Declaration:
    @check(
        id=f"guide_pv_{side}",
        title=f"PV value in guide {side}",
        unit="MPa m/s",
        method="mean |R v| over the turn over diameter x length; R sums the loads of both sides"
        " of the bore",
        lift_can_help=True,
        forecast=True,
        error="guides",
    )
    def pv(solution: Solution) -> Demand:
        """Pressure times sliding speed in a guide, mean over the turn, Pa m/s."""
        guide = _guide(solution, side)
        worst = worst_case(solution.cycles, lambda cycle: mean_pv(cycle, side))
        alone = worst_case(solution.cycles, lambda cycle: _pv_of_reaction(cycle, side))
        limit = pv_limit(guide)
        notes = [] if limit is not None else [_no_limit("PV", side)]
        notes += _lubrication(guide, worst.value)
        notes.append(f"{shown(alone.value, 'MPa m/s', 3)} by the net reaction")
        return Demand(worst.value, limit, worst, note="; ".join(notes), source=_pv_source(guide))

    return pv


def pv_limit(guide: Guide) -> float | None:
    """PV limit of a guide, or that of nylon in its state of lubrication, Pa m/s."""
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
    """Lubrication whose graded limit holds; None where the guide has a limit of its own."""
    graded = guide.pv_limit is None and _is_nylon(guide)
    return guide.lubrication if graded else None


def _lubrication(guide: Guide, demand: float) -> list[str]:
    """Least lubrication in which nylon carries a PV (Pa m/s); nothing of another material."""
    if not _is_nylon(guide):
        return []
    states = [state.replace("_", " ") for state, limit in NYLON_PV.items() if demand <= limit]
    return [f"nylon carries it {states[0]}" if states else "nylon carries it in no lubrication"]


def _is_nylon(guide: Guide) -> bool:
    return "nylon" in guide.material.name.lower()


def _guide_edge_pressure(side: Side) -> Declaration:
    @check(
        id=f"guide_edge_pressure_{side}",
        title=f"Edge pressure in guide {side}",
        unit="MPa",
        method="pin in a hole with clearance, bush in a rigid housing, where the beam's line"
        " pressure is greatest; yield strength of the bush",
        must_have=False,
        lift_can_help=True,
        error="guides",
    )
    def edge(solution: Solution) -> Demand:
        """Greatest pressure of the stem in a bore, Pa."""
        card = _guide(solution, side).material
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
        method="friction heat through the bush's wall (or the thermal resistance given), an"
        " estimate",
        must_have=False,
        lift_can_help=True,
    )
    def temperature(solution: Solution) -> Demand:
        """Steady temperature of a bush, degC."""
        guide = _guide(solution, side)
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
    """Temperature at the greatest friction, where it exceeds the nominal one (degC)."""
    ambient, hot = solution.machine.guides.ambient_temperature, []
    for cycle in solution.cycles:
        heat, worst = heat_of(cycle.parts, side), cycle.parts.friction.greatest
        friction = worst.friction_force_a if side == "A" else worst.friction_force_b
        power = float(np.mean(friction * np.abs(worst.velocity)))
        if heat.mean_power > 0.0:
            rise = (heat.temperature - ambient) * power / heat.mean_power
            hot.append(celsius(ambient + rise))
    hottest = max(hot, default=np.nan)
    return [f"{shown(hottest, 'degC', 3)} at the greatest friction"] if hottest > nominal else []


guide_pressure_a, guide_pressure_b = _guide_pressure("A"), _guide_pressure("B")
guide_pv_a, guide_pv_b = _guide_pv("A"), _guide_pv("B")
guide_edge_pressure_a, guide_edge_pressure_b = _guide_edge_pressure("A"), _guide_edge_pressure("B")
guide_temperature_a, guide_temperature_b = _guide_temperature("A"), _guide_temperature("B")


@check(
    GUIDE_LENGTH,
    title="Guided length / maximum overhang",
    method="outer ends of the two guides over the overhang at the least lift",
    must_have=False,
    lift_can_help=True,
    moved_by_tolerance=False,
)
def guide_length(solution: Solution) -> Demand:
    """Distance of the outer ends of the guides over the greatest overhang."""
    machine, guides = solution.machine, solution.machine.guides
    overhang = machine.overhang_at_max_lift + solution.contour.pitch.lift.highest.value
    spread = guides.spacing + 0.5 * (guides.a.length + guides.b.length)
    return Demand(spread / overhang, machine.limits[GUIDE_LENGTH])
