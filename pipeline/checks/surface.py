"""Limits of the surface besides those of the contact: fatigue, hardness, depth of the case."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, cam_card, greatest, worst_case
from camwright.pipeline.checks.surface_durability import torsion_limit

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Material
    from camwright.pipeline.cycle.cycle import Cycle

CASE_CARBURISED = 1500.0  # MPa, quality MQ


def dang_van(evidence: TrialEvidence) -> Check:
    """Dang Van's stress as the follower passes against the limit in torsion."""
    worst = worst_case(evidence, _dang_van)
    return Check(
        id="dang_van",
        title="Fatigue below the surface of the cam by Dang Van",
        demand=1e-6 * worst.value,
        **torsion_limit(evidence, "Dang Van (1993)"),
        method="shear amplitude plus weighted hydrostatic stress, no credit for compression"
        " (Desimone 2006), the load swept along the contour",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def case_depth(evidence: TrialEvidence) -> Check:
    """Depth of the hardened case over that of the greatest shear."""
    name, card = cam_card(evidence)
    depth = card.case_depth
    worst = greatest(evidence, lambda cycle: cycle.contact.tau_depth)
    loaded = worst.value > 0 or np.isnan(worst.value)
    return Check(
        id="case_depth",
        title="Depth of the case over that of the greatest shear",
        demand=float(depth / worst.value) if depth is not None and loaded else None,
        limit=evidence.case.limits.case_depth_ratio,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "case_depth_ratio", "2 to 3 times the depth, shop practice: verify", card.source
        ),
        method="effective depth of the card over the greatest depth of tau_max over the turn",
        must_have=False,
        lift_can_help=True,
        note="" if depth is not None else f"the card of {name} gives no case depth",
        **worst.place,
    )


def pressure_by_hardness(evidence: TrialEvidence) -> Check | None:
    """Contact pressure against Buckingham's estimate; None for a hardened surface."""
    name, card = cam_card(evidence)
    if card.case_depth is not None or card.treatment not in (None, "through_hardened"):
        return None
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = None if card.hardness is None else buckingham(card.hardness)
    return Check(
        id="pressure_by_hardness",
        title="Contact pressure against an estimate from the hardness",
        demand=1e-6 * worst.value,
        limit=limit,
        unit="MPa",
        source=f"2.76 HB - 70 MPa at 1e8 cycles, Buckingham, Shigley ch. 6: verify; {card.source}",
        method="greatest contact pressure by finite elements over the turn; an estimate for steel"
        " without a hardened case",
        must_have=False,
        lift_can_help=True,
        note="" if limit is not None else f"the card of {name} gives no hardness",
        **worst.place,
    )


def pressure_by_gear_limits(evidence: TrialEvidence) -> Check:
    """Contact pressure beside what gears of such steel bear, for comparison."""
    name, card = cam_card(evidence)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = gear_limit(card)
    return Check(
        id="pressure_by_gear_limits",
        title="Contact pressure beside the limit of gear flanks",
        demand=1e-6 * worst.value,
        limit=limit,
        unit="MPa",
        source=f"ISO 6336-5, quality MQ, recalled: verify; {card.source}",
        method="greatest contact pressure by finite elements over the turn; a comparison",
        must_have=False,
        lift_can_help=True,
        note="" if limit is not None else f"the card of {name} gives no treatment or no hardness",
        **worst.place,
    )


def buckingham(hardness: float) -> float:
    """Contact pressure (MPa) that steel of a Brinell hardness bears 1e8 times; >= 0.

    References
    ----------
    Shigley's Mechanical Engineering Design, ch. 6, after Buckingham: 2.76 HB - 70 MPa.
    """
    return max(2.76 * hardness - 70.0, 0.0)


def gear_limit(card: Material) -> float | None:
    """Allowable contact stress (MPa) of gear flanks of such steel; None where nobody says.

    References
    ----------
    ISO 6336-5, MQ, recalled (verify): carburised 1500; induction 0.541 HV + 882;
    through-hardened alloy steel 1.313 HV + 373.
    """
    if card.treatment == "case_hardened":
        return CASE_CARBURISED
    lines = {"induction_hardened": (0.541, 882.0), "through_hardened": (1.313, 373.0)}
    if card.treatment is None or card.hardness is None:
        return None
    slope, start = lines[card.treatment]
    return slope * card.hardness + start


def _dang_van(cycle: Cycle) -> float:
    found = None if cycle.rolling is None else cycle.rolling.envelope.dang_van
    return np.nan if found is None else float(found.max())


CHECKS = (dang_van, case_depth, pressure_by_hardness, pressure_by_gear_limits)
