"""Limits of the rolling surface: grip, oil film, fatigue, hardened case."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import (
    TrialEvidence,
    cam_card,
    greatest,
    least,
    rollers_only,
    worst_case,
)

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Material
    from camwright.pipeline.contact.rolling_envelope import Envelope
    from camwright.pipeline.cycle.cycle import Cycle


@rollers_only
def roller_grip(evidence: TrialEvidence) -> Check:
    """Tangential force that rolling asks for against friction."""
    friction = evidence.case.roller.friction
    worst = greatest(evidence, _demand)
    return Check(
        id="roller_grip",
        title="Grip that keeps the roller rolling",
        demand=worst.value,
        limit=None if friction is None else evidence.case.limits.skid * friction,
        unit="-",
        source=evidence.source(
            "skid", "half of friction, Rothbart, Cam Design Handbook (2004), eq. 10.7: verify"
        ),
        method="(roller inertia + bearing drag) over roller radius and normal force",
        must_have=False,
        lift_can_help=True,
        note="" if friction is not None else "no friction of the roller on the cam is given",
        **worst.place,
    )


def film_ratio(evidence: TrialEvidence) -> Check:
    """Least film over roughness."""
    case = evidence.case
    worst = least(evidence, _lambda)
    missing = [
        text
        for value, text in (
            (case.lubricant, "no lubricant"),
            (case.cam.roughness, "no roughness of the cam"),
            (evidence.facing.roughness, f"no roughness of the {evidence.facing_name}"),
        )
        if value is None
    ]
    return Check(
        id="film_ratio",
        title="Oil film over roughness",
        demand=worst.value,
        limit=case.limits.film_ratio,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "film_ratio",
            "below 1 boundary, 1 to 3 mixed, above 3 full film",
            "" if case.lubricant is None else case.lubricant.source,
        ),
        method="least film of Dowson and Higginson (1966) where loaded, over the rms roughness",
        must_have=False,
        note=f"{', '.join(missing)} is given" if missing else "",
        **worst.place,
    )


def surface_fatigue(evidence: TrialEvidence) -> Check:
    """Crossland's stress as the follower passes against the limit in torsion."""
    worst = worst_case(evidence, lambda cycle: _of_map(cycle, _crossland))
    return Check(
        id="surface_fatigue",
        title="Fatigue below the surface of the cam",
        demand=1e-6 * worst.value,
        **torsion_limit(evidence, "Crossland (1956)"),
        method="root of J2's amplitude plus weighted hydrostatic stress, the load swept along "
        "the contour",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def torsion_limit(evidence: TrialEvidence, author: str) -> dict[str, Any]:
    """The limit in torsion of the cam's material, against which an author's stress is held."""
    name, card = cam_card(evidence)
    torsion, safety = card.fatigue_torsion, evidence.case.limits.fatigue_safety
    known = torsion is not None and card.fatigue_bending is not None
    return {
        "limit": 1e-6 * torsion / safety if known and torsion else None,
        "unit": "MPa",
        "source": evidence.source("fatigue_safety", f"{author}; limits of {name}", card.source),
        "note": "" if known else f"the card of {name} gives no fatigue limits",
    }


def hardened_case(evidence: TrialEvidence) -> Check:
    """Von Mises stress over the yield strength there is at its depth."""
    name, card = cam_card(evidence)
    known = card.case_depth is not None and card.core_yield_strength is not None
    worst = worst_case(
        evidence, lambda cycle: _of_map(cycle, lambda map_: _use_of_strength(map_, card))
    )
    return Check(
        id="hardened_case",
        title="Strength of case and core below the surface",
        demand=worst.value if known else None,
        limit=1.0 / evidence.case.limits.case_safety,
        unit="-",
        source=evidence.source("case_safety", f"yield of case and core of {name}", card.source),
        method="greatest von Mises stress over the yield strength at its depth, which falls "
        "evenly from surface to core over the case depth",
        must_have=False,
        lift_can_help=True,
        note="" if known else f"the card of {name} gives no case depth or no core",
        **worst.place,
    )


def _demand(cycle: Cycle) -> Array:
    """Demand on grip (n,) where loaded; NaN where it is not known."""
    rolling = cycle.rolling
    if rolling is None or rolling.traction_demand is None:
        return np.full(cycle.theta.size, np.nan)
    return np.where(np.isnan(rolling.traction_demand), 0.0, rolling.traction_demand)


def _lambda(cycle: Cycle) -> Array:
    """Lambda ratio (n,), beyond all bounds where there is no load; NaN where it is not known."""
    film = None if cycle.rolling is None else cycle.rolling.film
    ratio = None if film is None else film.ratio
    if ratio is None:
        return np.full(cycle.theta.size, np.nan)
    return np.where(np.isnan(ratio), np.inf, ratio)


def _of_map(cycle: Cycle, measure: Callable[[Envelope], float]) -> float:
    return np.nan if cycle.rolling is None else measure(cycle.rolling.envelope)


def _crossland(found: Envelope) -> float:
    return np.nan if found.crossland is None else float(found.crossland.max())


def _use_of_strength(found: Envelope, card: Material) -> float:
    depth, core = card.case_depth, card.core_yield_strength
    if depth is None or core is None:
        return np.nan
    inward = np.clip(found.depth / depth, 0.0, 1.0)
    strength = card.yield_strength + (core - card.yield_strength) * inward
    return float((found.von_mises / strength).max())


CHECKS = (roller_grip, film_ratio, surface_fatigue, hardened_case)
