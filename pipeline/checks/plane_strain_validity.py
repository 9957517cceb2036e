"""What a plane model cannot see, and the places where it must not be believed.

Each statement of the sign-off that limits what the figures mean stands here as a check that can
fail, so that nobody signs for a plane solution where it does not hold.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, greatest, least

if TYPE_CHECKING:
    from camwright.pipeline.contact.bore_stress import BoreStress
    from camwright.pipeline.cycle.cycle import Cycle

LEAST_EDGE_FACTOR = 1.3  # on a contact without a crown: 1.3 to 2, shop practice: verify
CLEAR_OF_HOLDS = 10.0  # half-widths, beyond which a contact no longer feels how a body is held
EXCLUDED_SHARE = 0.5  # of the keyway's depth


def edge_derating(evidence: TrialEvidence) -> Check:
    """Whether the pressure at the ends of the contact is raised by what nobody computed."""
    crowned = evidence.facing.crowned
    return Check(
        id="edge_derating",
        title="Edge factor on the plane contact pressure",
        demand=1.0 if crowned else evidence.case.limits.edge_factor,
        limit=1.0 if crowned else LEAST_EDGE_FACTOR,
        unit="-",
        sense="at_least",
        source="derate 1.3 to 2 or crown the roller, shop practice: verify",
        method="factor that edge_pressure puts on the plane solution; 1 where the ends are crowned",
        note="plane strain sees neither the ends of the contact, nor a tilt of its axis",
        evidence=True,
    )


def clear_of_holds(evidence: TrialEvidence) -> Check:
    """Least steel between the contact and where its bodies are held, in half-widths."""
    case = evidence.case
    key = case.cam.keyway
    held = case.cam.bore_radius + (0.0 if key is None else key.depth)
    wall = evidence.contour.radius_min().value - held
    if evidence.rolls:
        roller_radius = evidence.contour.require_roller().roller_radius
        wall = min(wall, roller_radius - case.roller.hub_radius)
    worst = greatest(evidence, lambda cycle: cycle.contact.half_width)
    loaded = worst.value > 0 or np.isnan(worst.value)
    return Check(
        id="clear_of_holds",
        title="Contact's distance from held places over its half-width",
        demand=float(wall / worst.value) if loaded else None,
        limit=CLEAR_OF_HOLDS,
        unit="-",
        sense="at_least",
        source="held places are excluded: their stress is that of the model, not of the part",
        method="least wall to bore, keyway or hub over the greatest half-width of the turn",
        evidence=True,
        **worst.place,
    )


def excluded_zone(evidence: TrialEvidence) -> Check | None:
    """Size of the zones at the keyway's edges whose stress is not counted; None without a key."""
    key = evidence.case.cam.keyway
    if key is None or not _bores(evidence):
        return None
    radius = max(bore.excluded for bore in _bores(evidence))
    return Check(
        id="excluded_zone",
        title="Hot-spot distance from the keyway's edges",
        demand=1e3 * radius if radius > 0 else None,
        limit=1e3 * EXCLUDED_SHARE * key.depth,
        unit="mm",
        source="an edge has no finite stress: a zone about it is left out, half the depth at most",
        method="1.5 lengths of the elements at the keyway; what is found within is given apart",
        evidence=True,
    )


def bore_stress(evidence: TrialEvidence) -> Check | None:
    """Von Mises stress at bore and keyway, the zones at its edges left out; None without one."""
    if not _bores(evidence):
        return None
    name = evidence.case.cam.material
    card = evidence.case.materials[name]
    worst = greatest(evidence, _away_from_edges)
    at_edges = max(float(np.max(bore.von_mises)) for bore in _bores(evidence))
    core = card.core_yield_strength or card.yield_strength
    radius = 1e3 * max(bore.excluded for bore in _bores(evidence))
    return Check(
        id="bore_stress",
        title="Von Mises stress at the bore",
        demand=1e-6 * worst.value,
        limit=1e-6 * core / evidence.case.limits.bore_safety,
        unit="MPa",
        source=evidence.source("bore_safety", f"yield of the core of {name}", card.source),
        method="finite elements on a rigid shaft, edges of the keyway left out by excluded_zone",
        must_have=False,
        lift_can_help=True,
        note=f"{1e-6 * at_edges:.4g} MPa within {radius:.2g} mm of the keyway's edges, where it"
        " grows with refinement"
        if radius > 0
        else "",
        **worst.place,
    )


def stress_inside(evidence: TrialEvidence) -> Check:
    """Whether the greatest stress of the contact lies in the steel and not in a wall's reach."""

    def share(cycle: Cycle) -> Array:
        half = cycle.contact.half_width
        loaded = half > 0
        depth = cycle.contact.von_mises_depth / np.where(loaded, half, 1.0)
        return np.where(loaded, depth, np.where(np.isnan(half), np.nan, np.inf))

    worst = least(evidence, share)
    return Check(
        id="stress_inside",
        title="Depth of the greatest von Mises stress over the half-width",
        demand=worst.value,
        limit=0.3,
        unit="-",
        sense="at_least",
        source="0.70 half-widths under a frictionless line contact, Johnson (1985) sec. 4.2(c)",
        method="least depth over the turn: a maximum at the surface is an edge's or an element's",
        evidence=True,
        **worst.place,
    )


def _bores(evidence: TrialEvidence) -> list[BoreStress]:
    turns = [cycle.rolling for cycle in evidence.cycles]
    return [turn.bore for turn in turns if turn is not None and turn.bore is not None]


def _away_from_edges(cycle: Cycle) -> Array:
    bore = None if cycle.rolling is None else cycle.rolling.bore
    return np.full(cycle.theta.size, np.nan) if bore is None else bore.away_from_edges


CHECKS = (edge_derating, clear_of_holds, stress_inside, excluded_zone, bore_stress)
