"""Limits on the material under the follower."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pipeline.checks.check import Check
from pipeline.checks.trial import TrialEvidence, greatest

if TYPE_CHECKING:
    from pipeline.part_fields import Material

SHAKEDOWN = 4.0  # p0 / k, free rolling line contact
FIRST_YIELD = 1.79  # p0 / Y, von Mises, line contact, nu = 0.3


def contact_pressure(evidence: TrialEvidence) -> Check:
    """Greatest contact pressure against the endurance of the softer body."""
    name, material = softer(evidence)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    endurance, safety = material.endurance_pressure, evidence.limit("contact_safety", 1.0)
    limit = None if endurance is None or safety is None else 1e-6 * endurance / safety
    return Check(
        id="contact_pressure",
        title="Contact pressure against surface endurance",
        demand=1e-6 * worst.value,
        limit=limit,
        unit="MPa",
        source=evidence.source("contact_safety", f"surface endurance of {name}", material.source),
        method="greatest contact pressure by finite elements over the turn, softer body",
        lift_can_help=True,
        note="" if limit is not None else f"the card of {name} gives no endurance pressure",
        **worst.place,
    )


def first_yield(evidence: TrialEvidence) -> Check:
    """Greatest von Mises stress against yield; a rolling contact may live above it."""
    name, material = softer(evidence)
    worst = greatest(evidence, lambda cycle: cycle.contact.von_mises)
    safety = evidence.limit("yield_safety", 1.0)
    yields = 1e-6 * material.yield_strength
    return Check(
        id="first_yield",
        title="Von Mises stress below the surface against yield",
        demand=1e-6 * worst.value,
        limit=None if safety is None else yields / safety,
        unit="MPa",
        source=evidence.source(
            "yield_safety",
            f"yield of {name}; p0 = 1.79 Y, Johnson (1985) sec. 6.1",
            material.source,
        ),
        method="greatest von Mises stress by finite elements over the turn, softer body",
        must_have=False,
        lift_can_help=True,
        note=f"first yield at a contact pressure of {FIRST_YIELD * yields:.4g} MPa; "
        "above it the material may shake down",
        **worst.place,
    )


def shakedown(evidence: TrialEvidence) -> Check:
    """Greatest contact pressure against the limit of elastic shakedown."""
    name, material = softer(evidence)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    safety = evidence.limit("shakedown_safety", 1.0)
    shear_yield = material.yield_strength / math.sqrt(3.0)
    return Check(
        id="shakedown",
        title="Contact pressure against shakedown",
        demand=1e-6 * worst.value,
        limit=None if safety is None else 1e-6 * SHAKEDOWN * shear_yield / safety,
        unit="MPa",
        source=evidence.source(
            "shakedown_safety",
            f"p0 <= 4.0 k, free rolling, Johnson (1985) sec. 9.2; k = Y/sqrt(3) of {name}",
            material.source,
        ),
        method="greatest contact pressure by finite elements over the turn, softer body",
        lift_can_help=True,
        note="without traction; sliding at the surface lowers the limit",
        **worst.place,
    )


def softer(evidence: TrialEvidence) -> tuple[str, Material]:
    """Name and card of the body, cam or follower, that yields first."""
    case = evidence.case
    names = (case.cam.material, evidence.facing.material)
    cards = [(name, case.materials[name]) for name in names]
    return min(cards, key=lambda card: card[1].yield_strength)


CHECKS = (contact_pressure, first_yield, shakedown)
