"""Checks of service life: lubrication of the roller bearing, expansion and wear of the guides.

A check without data in the case is left out.
"""

from __future__ import annotations

import numpy as np

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import TARGET_LIFE, VISCOSITY_RATIO, WEAR_DEPTH
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.checks.extremes import worst_case
from camwright.pipeline.checks.guide_strength import Side, guide_of, heat_of, mean_pv
from camwright.pipeline.checks.roller_bearing import bearing_of, spin
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_reactions import WALL_SHARE

ROOM = 293.15  # K, temperature of the clearance measurement
STANDSTILL = 1.0  # rpm of the roller, below which the viscosity ratio does not apply


@check(
    VISCOSITY_RATIO,
    id="bearing_lubrication",
    title="Viscosity ratio (kappa) of the roller bearing",
    method="viscosity over v1 at the mean speed of the roller; infinite at rest",
    must_have=False,
    needs="roller",
)
def bearing_lubrication(solution: Solution) -> Demand | None:
    """Viscosity ratio of the roller bearing; None without a viscosity."""
    bearing = bearing_of(solution)
    viscosity, ring, pitch = bearing.viscosity, bearing.ring, bearing.pitch_diameter
    if viscosity is None:
        return None
    if pitch is None and ring is not None:
        pitch = ring.pitch_diameter

    def ratio(cycle: Cycle) -> float:
        speed = in_unit(float(np.mean(np.abs(spin(cycle)))), "rpm")
        if pitch is None or np.isnan(speed):
            return np.nan
        return np.inf if speed < STANDSTILL else viscosity / rated_viscosity(speed, pitch)

    worst = worst_case(solution.cycles, ratio, at_least=True)
    return Demand(
        worst.value,
        solution.machine.limits[VISCOSITY_RATIO],
        worst,
        note="" if pitch is not None else "no pitch diameter of the bearing is given",
        figures=(bearing.source,),
    )


def rated_viscosity(speed: float, pitch_diameter: float) -> float:
    """Rated kinematic viscosity v1 of a bearing, m2/s, at a speed, rpm, > 0; diameter in m.

    References
    ----------
    ISO 281:2007, 9.3.3.2: 45000 n^-0.83 D^-0.5 below 1000 rpm, 4500 n^-0.5 D^-0.5 above, in
    mm2/s and mm; recalled: verify.
    """
    slow = 45_000.0 * speed**-0.83 if speed < 1000.0 else 4500.0 * speed**-0.5
    return float(1e-6 * slow / np.sqrt(1e3 * pitch_diameter))


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
