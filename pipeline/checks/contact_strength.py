"""Limits on the material under the follower."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, greatest
from camwright.pipeline.contact import hertz

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Material

PSI = 6894.757293168  # Pa
SHAKEDOWN = 4.0  # p0 / k, free rolling line contact
FIRST_YIELD = 1.79  # p0 / Y, von Mises, line contact, nu = 0.3


def contact_pressure(evidence: TrialEvidence) -> Check:
    """Greatest contact pressure against the endurance of the softer body."""
    name, material = softer(evidence)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    endurance = material.endurance_pressure
    safety = evidence.case.limits.contact_safety
    limit = None if endurance is None else 1e-6 * endurance / safety
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
    yields = 1e-6 * material.yield_strength
    return Check(
        id="first_yield",
        title="Von Mises stress below the surface against yield",
        demand=1e-6 * worst.value,
        limit=yields / evidence.case.limits.yield_safety,
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
    shear_yield = material.yield_strength / math.sqrt(3.0)
    return Check(
        id="shakedown",
        title="Contact pressure against shakedown",
        demand=1e-6 * worst.value,
        limit=1e-6 * SHAKEDOWN * shear_yield / evidence.case.limits.shakedown_safety,
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


def contact_pressure_at_life(evidence: TrialEvidence) -> Check:
    """Greatest contact pressure against the endurance at the life asked for."""
    case = evidence.case
    name = case.cam.material
    card, life = case.materials[name], case.limits.target_life
    slope, intercept = card.endurance_slope, card.endurance_intercept
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = None
    if slope is not None and intercept is not None and life is not None:
        turns = life * max(map(evidence.cam_speed, evidence.cycles)) / FULL_TURN
        bears = pressure_at_life(turns, slope, intercept, _contact_modulus(evidence))
        limit = bears / case.limits.contact_safety
    missing = [text for value, text in (
        (life, "no target life is asked for"),
        (slope, f"the card of {name} gives no slope of endurance"),
    ) if value is None]  # fmt: skip
    return Check(
        id="contact_pressure_at_life",
        title="Contact pressure against surface endurance at the target life",
        demand=1e-6 * worst.value,
        limit=None if limit is None else 1e-6 * limit,
        unit="MPa",
        source=evidence.source(
            "target_life", "log10 K = (B - log10 n)/A, Rothbart (2004) eq. 9.15", card.source
        ),
        method="greatest contact pressure by finite elements; every turn loads each place once,"
        " all turns as bad as the worst load case",
        lift_can_help=True,
        note="; ".join(missing),
        **worst.place,
    )


def pressure_at_life(cycles: float, slope: float, intercept: float, modulus: float) -> float:
    """Contact pressure (Pa) that a surface bears `cycles` times.

    Parameters
    ----------
    slope, intercept : float   A and B of log10 K = (B - log10 n)/A with K in psi
    modulus : float            E*, Pa

    References
    ----------
    Rothbart, Cam Design Handbook (2004), eq. 9.15; p0 = sqrt(K E*/pi).
    """
    factor = PSI * 10.0 ** ((intercept - math.log10(max(cycles, 1.0))) / slope)
    return math.sqrt(factor * modulus / math.pi)


def edge_pressure(evidence: TrialEvidence) -> Check:
    """Pressure at the ends of the line contact, which a plane model cannot see."""
    name, material = softer(evidence)
    limits, endurance = evidence.case.limits, material.endurance_pressure
    factor = 1.0 if evidence.facing.crowned else limits.edge_factor
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    return Check(
        id="edge_pressure",
        title=f"Pressure at the {evidence.facing_name}'s ends against surface endurance",
        demand=1e-6 * factor * worst.value,
        limit=None if endurance is None else 1e-6 * endurance / limits.contact_safety,
        unit="MPa",
        source=evidence.source(
            "edge_factor",
            f"derate 1.3 to 2 or crown the {evidence.facing_name}, shop practice: verify",
            f"{name}: {material.source}",
        ),
        method=f"greatest contact pressure times {factor}; two dimensions cannot see the ends",
        lift_can_help=True,
        note="" if endurance is not None else f"the card of {name} gives no endurance pressure",
        **worst.place,
    )


def shakedown_traction(evidence: TrialEvidence) -> Check:
    """Contact pressure against elastic shakedown with the follower sliding."""
    name, material = softer(evidence)
    friction = evidence.facing.friction
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = None
    if friction is not None:
        shear_yield = material.yield_strength / math.sqrt(3.0)
        limit = shakedown_factor(friction) * shear_yield / evidence.case.limits.shakedown_safety
    return Check(
        id="shakedown_traction",
        title="Contact pressure against shakedown under sliding",
        demand=1e-6 * worst.value,
        limit=None if limit is None else 1e-6 * limit,
        unit="MPa",
        source=evidence.source(
            "shakedown_safety",
            f"greatest shear along the surface <= k, Johnson (1985) sec. 9.2; k of {name}",
            material.source,
        ),
        method="greatest contact pressure by finite elements; traction of full sliding",
        lift_can_help=True,
        note=""
        if friction is not None
        else f"no friction of the {evidence.facing_name} on the cam is given",
        **worst.place,
    )


@lru_cache(maxsize=64)
def shakedown_factor(friction: float) -> float:
    """p0/k at the limit of elastic shakedown of a sliding line contact: 4 without friction.

    Residual stress may take every share of the stress but the shear along the surface, which
    therefore must stay within the yield in shear: the limit is 1/max|tau_xz| at p0 = 1.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 9.2; Melan's theorem.
    """
    x, depth = np.meshgrid(np.linspace(-1.5, 1.5, 601), np.linspace(0.0, 1.5, 301))
    shear = np.abs(hertz.subsurface_stress(x, depth, friction)[2])
    return 1.0 / float(shear.max())


def _contact_modulus(evidence: TrialEvidence) -> float:
    case = evidence.case
    cam, other = case.materials[case.cam.material], case.materials[evidence.facing.material]
    return hertz.contact_modulus(cam.E, cam.nu, other.E, other.nu)


CHECKS = (contact_pressure, first_yield, shakedown)
SIGNED = (
    contact_pressure_at_life,
    edge_pressure,
    shakedown_traction,
)
"""What a sign-off asks for besides; a look ahead does without."""
