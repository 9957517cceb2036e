"""Endurance of a steel surface estimated from its hardness.

Rules for other tests than the contact of a cam: for comparison, and as the range of a card.
"""

from __future__ import annotations

from math import inf

from camwright.pipeline.base.material import Material

CASE_CARBURISED = 1500e6  # Pa, quality MQ
BUCKINGHAM_MAX = 400.0  # HB
THROUGH_HARDENED_MAX = 390.0  # HV


def endurance_by_hardness(card: Material) -> dict[str, float]:
    """Endurance pressure of a material card by each hardness rule that applies, Pa."""
    rules = {
        "Buckingham": None if card.surface_hardened else buckingham(card),
        "ISO 6336-5": gear_limit(card),
    }
    return {name: value for name, value in rules.items() if value}


def buckingham(card: Material) -> float | None:
    """Allowable contact pressure of steel at 1e8 load cycles, from the Brinell hardness, Pa.

    None without one and above 400 HB, where the estimate does not hold.

    References
    ----------
    Shigley's Mechanical Engineering Design, ch. 6, after Buckingham: 2.76 HB - 70 MPa.
    """
    hardness = card.hardness_brinell
    if hardness is None or hardness > BUCKINGHAM_MAX:
        return None
    return max(2.76e6 * hardness - 70e6, 0.0)


def gear_limit(card: Material) -> float | None:
    """Allowable contact stress of gear flanks of a steel, Pa; None where it is unknown.

    References
    ----------
    ISO 6336-5, MQ, as recalled: carburised 1500 MPa; induction 0.541 HV + 882 MPa;
    through-hardened alloy steel 1.313 HV + 373 MPa, up to 390 HV.
    """
    if card.treatment == "case_hardened":
        return CASE_CARBURISED
    lines = {
        "induction_hardened": (0.541e6, 882e6, inf),
        "through_hardened": (1.313e6, 373e6, THROUGH_HARDENED_MAX),
    }
    if card.treatment not in lines or card.hardness_vickers is None:
        return None
    slope, start, most = lines[card.treatment]
    return slope * card.hardness_vickers + start if card.hardness_vickers <= most else None
