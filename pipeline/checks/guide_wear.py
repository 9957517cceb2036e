"""Checks of the guides, and of the bush of a pivot, over their life: expansion and wear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Value
from camwright.pipeline.base import levers
from camwright.pipeline.base.material import ROOM, Material
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import TARGET_LIFE, WEAR_DEPTH
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    LASTING,
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
    of_row,
)
from camwright.pipeline.checks.guide_strength import (
    ACROSS,
    ARM_LENGTH,
    PV,
    SEATS,
    TILTED,
    Place,
    bush_of,
    guide_of,
    has_bush,
    heat_path_lacks,
    hottest,
    locks_hot,
    table_of,
)
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_friction import bore_closure
from camwright.pipeline.follower.guide_reactions import Guide


def _guide_expansion(side: Place) -> Declaration:
    """Check that a bush, as it warms and swells, keeps a clearance to the stem or pin."""
    seat = SEATS[side]

    @check(
        id=seat.named("expansion"),
        title=f"Thermal and moisture expansion vs. clearance in {seat.words}",
        unit="mm",
        source=Source(
            "no seizure at temperature and moisture: Lame, thick ring in a rigid housing",
            confirmed=True,
        ),
        method="closure of the bore of an axially held bush in a rigid housing, and growth of the"
        " stem, at the temperature at the greatest friction",
        lift_can_help=True,
        part=seat.part,
        kept_as=f"friction power of {seat.words} at its least clearance",
        formula="max(c, c_f) d e + d a_s (T - T_0) <= C; e = a_b (T - T_0) + w: free strain of the"
        " bush by heat and moisture, k = (1 + 2 t/d)^2, c = (k - 1) (1 + nu) / (1 + (1 - 2 nu) k):"
        f" Lame's closure of the bore of a wall t, {seat.each}.wall, held axially,"
        " c_f = (k - 1) (1 + nu) / (1 + nu + (1 - nu) k): free to lengthen, d: bore, a_b, a_s:"
        " thermal expansion of bush and stem, w: growth by moisture, T: temperature of the guide,"
        f" T_0: 20 degC, C: {seat.each}.clearance.",
        symbols={
            "T": f"{STATED} [degC]",
            "T_0": "20 [degC]",
            "a_b": f"{table_of(side)}.material.expansion",
            "a_s": f"{seat.pin}.expansion",
            "w": STATED,
            "nu": f"{table_of(side)}.material.nu",
            "t": f"{table_of(side)}.wall",
            "d": f"{table_of(side)}.diameter",
            "C": f"{table_of(side)}.clearance",
            **dict.fromkeys(("c", "c_f", "k", "e"), "[-]"),
        },
        reason="a stem that binds in a hot or wet bush jams, whatever its loads.",
        values=(
            *given.LOADS,
            *given.of_guide(side, "material.expansion", "material.swelling"),
            f"{seat.pin}.expansion",
            *given.heat(side),
        ),
        levers=(levers.one(f"{table_of(side)}.clearance"),),
        page=seat.page,
    )
    def expansion(solution: Solution) -> Demand | None:
        """Expansion of bush and stem or pin, m, against the clearance between them."""
        if bush_of(solution.machine, side) is None:
            return None
        guide, stem = guide_of(solution.machine, side), pin_in(solution.case, side)
        bush = guide.material
        if stem is None:
            return Demand(None, guide.clearance, missing=(seat.pin,))
        growth_of_stem, moisture = stem.expansion, bush.moisture_growth
        hot, locks = hottest(solution, side), locks_hot(solution)
        missing = (
            *lacking(table_of(side), guide, "wall"),
            *lacking_of_card(bush, "expansion"),
            *lacking_of_card(stem, "expansion"),
            *(lacking_of_card(bush, "swelling") if moisture is None else ()),
            *(heat_path_lacks(solution.machine, side) if np.isnan(hot.value) else ()),
        )
        if (
            guide.wall is None
            or bush.expansion is None
            or growth_of_stem is None
            or moisture is None
            or locks
        ):
            return Demand(None, guide.clearance, missing=missing, note=locks)
        free, held = closures(guide, bush.expansion, growth_of_stem, moisture, hot.value)
        return Demand(
            max(free, held),
            guide.clearance,
            hot,
            missing,
            note="" if missing else f"{shown(free, 'mm', 3)} with a bush free to lengthen",
            figures=(bush.source, stem.source),
            stated={"T": float(celsius(hot.value)), "w": moisture},
        )

    return expansion


def pin_in(case: Case, side: Place) -> Material | None:
    """Material of the stem in a guide, or of the pin of a pivot; None: not known."""
    pivot = case.follower.pivot
    if side != "pivot" or pivot is None:
        return case.follower.stem_material
    return pivot.pin_material


def closures(
    guide: Guide, of_bush: float, of_stem: float, moisture: float, temperature: float
) -> tuple[float, float]:
    """Clearance lost by a guide at a temperature (K), m: bush axially free, and restrained.

    Parameters
    ----------
    of_bush, of_stem : float   thermal expansion, 1/K
    moisture : float           free strain of the bush by moisture
    """
    warmer = temperature - ROOM
    swelling = guide.diameter * (of_bush * warmer + moisture)
    grown = guide.diameter * of_stem * warmer
    free, held = (c * swelling + grown for c in bore_closure(guide.wall_share, guide.material.nu))
    return free, held


def seizure_temperature(guide: Guide, stem: Material) -> float | None:
    """Temperature at which a stem or pin of a material binds in its bush, K, by the clearance,
    which closes linearly; None: unknown, or at none.
    """
    of_bush, moisture = guide.material.expansion, guide.material.moisture_growth
    of_stem = stem.expansion
    if guide.wall is None or of_bush is None or of_stem is None or moisture is None:
        return None
    cold, warm = (
        max(closures(guide, of_bush, of_stem, moisture, ROOM + rise)) for rise in (0.0, 1.0)
    )
    # linear in the temperature
    return ROOM + (guide.clearance - cold) / (warm - cold) if warm > cold else None


def _guide_wear(side: Place) -> Declaration:
    """Check of the wear depth of a bush at the target life."""
    seat = SEATS[side]
    load, speed = f"guide_normal_load_{side}", "follower_velocity"
    if side == "pivot":
        load = "pivot_rubbing_load"
        speed = f"follower_velocity {seat.table}.diameter/(2 {ARM_LENGTH})"
    rate, life = f"{table_of(side)}.wear_rate", f"limits.{TARGET_LIFE.id}"

    def depth(worst: Value, numbers: Numbers) -> Value:
        """Wear depth over the target life, m, of a mean PV value, Pa m/s."""
        per_pv, time = numbers.get(rate), numbers.get(life)
        return np.nan if per_pv is None or time is None else per_pv * worst * time

    def pv_at(depth: float, numbers: Numbers) -> float | None:
        """PV value, Pa m/s, of a wear depth, m, in the target life."""
        per_pv, time = numbers.get(rate), numbers.get(life)
        return depth / float(per_pv * time) if per_pv and time else None

    def allowed(numbers: Numbers) -> Allowed:
        lacks = tuple(key for key in (rate, life) if numbers.get(key) is None)
        limit = of_row(WEAR_DEPTH)(numbers)
        return limit._replace(missing=(*limit.missing, *lacks))

    return check(
        WEAR_DEPTH,
        id=seat.named("wear"),
        title=f"Wear depth of {seat.words} at target life",
        method="wear rate times mean pressure times sliding distance, over the load cases by their"
        f" duty; without a duty all of the life in the worst load case; by the pushes on both"
        f" sides of the bore{TILTED if side == 'pivot' else ACROSS}",
        lift_can_help=True,
        tier=Tier.SCREENING,
        part=seat.part,
        kept_as=f"PV of {seat.words} at its wear depth",
        formula=f"K t PV <= h; K: {seat.each}.wear_rate, volume per load and distance, PV: sum of"
        " q_i PV_i, PV_i: mean PV value of the guide in a load case, q_i: load_case.duty, t:"
        " limits.target_life, h: limits.wear_depth. Without a duty PV is the greatest PV_i.",
        symbols={
            "K": rate,
            "t": life,
            "PV": f"mean(|{load} {speed}|)"
            f"/({table_of(side)}.diameter {table_of(side)}.length) [MPa m/s]",
        },
        reason="wear opens the clearance that jamming and edge pressure are computed"
        " with, and no other check limits it over the life.",
        load_cases=LASTING,
        values=(*given.LOADS, *given.of_guide(side, "wear_rate"), "limits.target_life"),
        levers=(
            levers.one(f"{table_of(side)}.wear_rate", -1),
            *levers.guide(side, "pv_limit"),
        ),
        page=seat.page,
    ).measured(
        "wear",
        applies=has_bush(side),
        value=depth,
        bound=pv_at,
        allowed=allowed,
        remark=lambda demand, solution: replace(
            demand, figures=(guide_of(solution.machine, side).source,)
        ),
        deviation=0.03,
        kept=Kept(unit="MPa m/s"),
    )(PV[side])


guide_expansion_a, guide_expansion_b = _guide_expansion("A"), _guide_expansion("B")
guide_wear_a, guide_wear_b = _guide_wear("A"), _guide_wear("B")
pivot_expansion, pivot_wear = _guide_expansion("pivot"), _guide_wear("pivot")
