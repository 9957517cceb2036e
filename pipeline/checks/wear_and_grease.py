"""Limits of what runs for long: grease of the bearing, growth and wear of the guides.

Each is made where the case has its data, and left out (None) where it has none of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, cited, rollers_only, worst_case
from camwright.pipeline.checks.guide_bushes import mean_pv
from camwright.pipeline.follower.guide_reactions import WALL_SHARE
from camwright.pipeline.follower.roller_motion import roller_motion

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Guide
    from camwright.pipeline.cycle.cycle import Cycle

ROOM = 293.15  # K, at which play is measured
RPM = 30.0 / np.pi
STANDS = 1.0  # rpm of the roller, below which nothing is greased by motion
HOURS = 3600.0


@rollers_only
def bearing_lubrication(evidence: TrialEvidence) -> Check | None:
    """Viscosity of the bearing's oil over that it needs; None where it is not given."""
    bearing = evidence.case.roller.bearing
    viscosity, ring, pitch = bearing.viscosity, bearing.ring, bearing.pitch_diameter
    if viscosity is None:
        return None
    if pitch is None and ring is not None:
        pitch = ring.pitch_diameter
    contour = evidence.contour.require_roller()

    def ratio(cycle: Cycle) -> float:
        motion = roller_motion(
            contour.pitch, contour.roller_radius, evidence.cam_speed(cycle), cycle.theta
        )
        speed = RPM * float(np.mean(np.abs(motion.spin)))
        if pitch is None or np.isnan(speed):
            return np.nan
        return np.inf if speed < STANDS else viscosity / rated_viscosity(speed, pitch)

    worst = worst_case(evidence, ratio, at_least=True)
    return Check(
        id="bearing_lubrication",
        title="Viscosity ratio of the roller bearing",
        demand=worst.value,
        limit=evidence.case.limits.viscosity_ratio,
        unit="-",
        sense="at_least",
        source=evidence.source("viscosity_ratio", "kappa = v/v1 >= 1, ISO 281", bearing.source),
        method="viscosity given over v1 at the mean speed of the roller, where it turns",
        must_have=False,
        note="" if pitch is not None else "no pitch diameter of the bearing is given",
        **worst.place,
    )


def rated_viscosity(speed: float, pitch_diameter: float) -> float:
    """Kinematic viscosity v1 (m2/s) that a bearing needs at a speed (rpm, > 0); diameter in m.

    References
    ----------
    ISO 281:2007, 9.3.3.2: 45000 n^-0.83 D^-0.5 below 1000 rpm, 4500 n^-0.5 D^-0.5 above, in
    mm2/s and mm; recalled: verify.
    """
    slow = 45_000.0 * speed**-0.83 if speed < 1000.0 else 4500.0 * speed**-0.5
    return float(1e-6 * slow / np.sqrt(1e3 * pitch_diameter))


def bush_growth_a(evidence: TrialEvidence) -> Check | None:
    """Growth of bush A and stem over the play between them."""
    return _growth(evidence, "A", evidence.case.guides.a)


def bush_growth_b(evidence: TrialEvidence) -> Check | None:
    """Growth of bush B and stem over the play between them."""
    return _growth(evidence, "B", evidence.case.guides.b)


def _growth(evidence: TrialEvidence, side: str, guide: Guide) -> Check | None:
    case, parts = evidence.case, evidence.parts
    bush = case.material(guide.material)
    expansion, of_stem = bush.expansion, case.material(case.follower.stem_material).expansion or 0.0
    if expansion is None or parts is None:
        return None

    def growth(cycle: Cycle) -> float:
        heat = parts[cycle].heat_a if side == "A" else parts[cycle].heat_b
        warmer = heat.temperature - ROOM
        wall = 2.0 * WALL_SHARE * guide.diameter * (expansion * warmer + bush.swelling)
        return float(wall + guide.diameter * of_stem * warmer)

    worst = worst_case(evidence, growth)
    return Check(
        id=f"bush_growth_{side}",
        title=f"Growth of bush and stem in guide {side} over the play",
        demand=1e3 * worst.value,
        limit=1e3 * guide.clearance,
        unit="mm",
        source=cited("no seizure when hot and wet, bush makers", bush.source),
        method="wall of a quarter of the bore swells inwards, in a housing that does not give, at"
        " the bush's running temperature",
        must_have=False,
        lift_can_help=True,
        note="the bush's temperature is not known" if np.isnan(worst.value) else "",
        **worst.place,
    )


def guide_wear_a(evidence: TrialEvidence) -> Check | None:
    """Depth worn off guide A over the target life."""
    return _wear(evidence, "A", evidence.case.guides.a)


def guide_wear_b(evidence: TrialEvidence) -> Check | None:
    """Depth worn off guide B over the target life."""
    return _wear(evidence, "B", evidence.case.guides.b)


def _wear(evidence: TrialEvidence, side: str, guide: Guide) -> Check | None:
    rate, life = guide.wear_rate, evidence.case.limits.target_life
    if rate is None:
        return None
    worst = worst_case(evidence, lambda cycle: mean_pv(cycle, side, guide))
    return Check(
        id=f"guide_wear_{side}",
        title=f"Wear of guide {side} over the target life",
        demand=None if life is None else 1e3 * rate * worst.value * life,
        limit=1e3 * evidence.case.limits.wear_depth,
        unit="mm",
        source=evidence.source(
            "wear_depth", "0.05 mm, shop practice: verify; Archard (1953)", guide.source
        ),
        method="wear rate times mean pressure times way, all the life in the worst load case",
        must_have=False,
        lift_can_help=True,
        note="" if life is not None else "no target life is asked for",
        **worst.place,
    )


CHECKS = (bearing_lubrication, bush_growth_a, bush_growth_b, guide_wear_a, guide_wear_b)
