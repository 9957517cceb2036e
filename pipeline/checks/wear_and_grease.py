"""Checks of service life: expansion and wear of the guides.

A check without data in the case is left out.
"""

from __future__ import annotations

import numpy as np

from camwright.pipeline.case.limits import TARGET_LIFE, WEAR_DEPTH
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.checks.extremes import worst_case
from camwright.pipeline.checks.guide_strength import Side, guide_of, heat_of, mean_pv
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_reactions import WALL_SHARE

ROOM = 293.15  # K, temperature of the clearance measurement


def _guide_expansion(side: Side) -> Declaration:
    @check(
        id=f"guide_expansion_{side}",
        title=f"Thermal and moisture expansion vs. clearance in guide {side}",
        unit="mm",
        source="no seizure at temperature and moisture, bush makers",
        method="inward expansion of a wall of a quarter of the bore, in a rigid housing, at the"
        " running temperature",
        must_have=False,
        lift_can_help=True,
    )
    def expansion(solution: Solution) -> Demand | None:
        """Expansion of guide and stem, m, against the clearance between them."""
        guide = guide_of(solution.machine, side)
        bush, stem = guide.material, solution.case.follower.stem_material
        coefficient, of_stem = bush.expansion, stem.expansion or 0.0
        if coefficient is None:
            return None

        def growth(cycle: Cycle) -> float:
            warmer = heat_of(cycle.parts, side).temperature - ROOM
            swelling = coefficient * warmer + bush.swelling
            wall = 2.0 * WALL_SHARE * guide.diameter * swelling
            return float(wall + guide.diameter * of_stem * warmer)

        worst = worst_case(solution.cycles, growth)
        note = "the temperature of the guide is not known" if np.isnan(worst.value) else ""
        return Demand(worst.value, guide.clearance, worst, note=note, figures=(bush.source,))

    return expansion


def _guide_wear(side: Side) -> Declaration:
    @check(
        WEAR_DEPTH,
        id=f"guide_wear_{side}",
        title=f"Wear depth of guide {side} at target life",
        method="wear rate times mean pressure times sliding distance, all of the life in the worst"
        " load case",
        must_have=False,
        lift_can_help=True,
    )
    def wear(solution: Solution) -> Demand | None:
        """Wear depth of a guide over the target life, m; None without a wear rate."""
        guide, limits = guide_of(solution.machine, side), solution.machine.limits
        rate, life = guide.wear_rate, limits[TARGET_LIFE]
        if rate is None:
            return None
        worst = worst_case(solution.cycles, lambda cycle: mean_pv(cycle, side))
        return Demand(
            None if life is None else rate * worst.value * life,
            limits[WEAR_DEPTH],
            worst,
            note="" if life is not None else "no target life is given",
            figures=(guide.source,),
        )

    return wear


guide_expansion_a, guide_expansion_b = _guide_expansion("A"), _guide_expansion("B")
guide_wear_a, guide_wear_b = _guide_wear("A"), _guide_wear("B")
