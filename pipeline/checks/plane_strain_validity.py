"""Checks of the validity limits of the plane-strain model."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base import value_groups as given
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import BORE_SAFETY
from camwright.pipeline.checks.check import NONE, Demand, check
from camwright.pipeline.checks.extremes import greatest, least
from camwright.pipeline.contact.bore_stress import BoreStress
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution

HELD_DISTANCE = 10.0  # half-widths, beyond which the supports do not affect the contact
EXCLUDED_SHARE = 0.5  # of the keyway depth
SUBSURFACE = 0.3  # half-widths: a shallower maximum is a singularity or an element error


@check(
    title="Distance of the contact from fixed boundaries / half-width",
    formula="min(w, t)/max a >= 10; w: least wall from contour to bore or keyway, t: thickness of"
    " the outer ring, or of the roller to its hub, a: half-width of the contact",
    reason="Nearer supports change the contact itself, and with it every pressure.",
    unit="-",
    sense="at_least",
    source="Saint-Venant: the stress at a fixed boundary is that of the model, not of the part",
    method="least wall of the cam to bore or keyway, and thickness of the outer ring or of the"
    " roller to its hub, over the greatest half-width",
    evidence=True,
    tier=Tier.CYCLE,
    error="contact",
    rests_on="loads",
    certified_by="half_width",
)
def held_distance(solution: Solution) -> Demand:
    """Minimum distance of the contact from a fixed boundary, in half-widths."""
    machine = solution.machine
    wall = solution.contour.radius_min().value - machine.cam.held_radius
    depth = machine.follower.held_depth
    if depth is not None:
        wall = min(wall, depth)
    worst = greatest(solution.cycles, lambda cycle: cycle.contact.half_width)
    loaded = worst.value > 0 or np.isnan(worst.value)
    return Demand(float(wall / worst.value) if loaded else None, HELD_DISTANCE, worst)


@check(
    title="Radius of the excluded zone at keyway edges",
    formula="1.5 h <= t/2; h: element length at the keyway, t: depth of the keyway",
    reason="A larger zone would hide the stress of the keyway.",
    unit="mm",
    source="singular stress at an edge: at most half of the keyway depth is excluded",
    method="1.5 element lengths at the keyway; the stress within is stated separately",
    evidence=True,
    tier=Tier.CYCLE,
    load_cases=NONE,
)
def excluded_zone(solution: Solution) -> Demand | None:
    """Radius of the excluded zones at the keyway edges, m; None without a keyway."""
    key, bores = solution.machine.cam.keyway, _bores(solution)
    if key is None or not bores:
        return None
    radius = max(bore.excluded for bore in bores)
    return Demand(radius if radius > 0 else None, EXCLUDED_SHARE * key.depth)


@check(
    BORE_SAFETY,
    id="bore_stress",
    title="Von Mises stress at bore and keyway vs. yield strength",
    formula="max sigma <= Y / S; sigma: von Mises stress on bore and keyway outside the excluded"
    " zones, Y: yield strength of the core, S: limits.bore_safety",
    reason="Does not decide: the shaft is taken as rigid and bonded, which overestimates the"
    " stress beside the keyway and omits the fit.",
    unit="MPa",
    method="finite elements on a rigid shaft, keyway edges excluded, see excluded_zone",
    must_have=False,
    lift_can_help=True,
    tier=Tier.CYCLE,
    error="bore",
    values=(
        *given.CONTACT,
        "cam.material.yield_strength",
        "cam.material.core_yield_strength",
    ),
    page="Cam",
)
def bore_stress(solution: Solution) -> Demand | None:
    """Maximum von Mises stress at bore and keyway without the excluded zones, Pa."""
    bores = _bores(solution)
    if not bores:
        return None
    card = solution.machine.cam.material
    worst = greatest(solution.cycles, _away_from_edges)
    at_edges = max(float(np.max(bore.von_mises)) for bore in bores)
    core = card.core_yield_strength or card.yield_strength
    radius = max(bore.excluded for bore in bores)
    within = f"{shown(at_edges, 'MPa')} within {shown(radius, 'mm', 2)} of the keyway edges"
    return Demand(
        worst.value,
        core / solution.machine.limits[BORE_SAFETY],
        worst,
        note=f"{within}, where it diverges with refinement" if radius > 0 else "",
        figures=(f"{card.name}: {card.source}",),
    )


@check(
    title="Depth of maximum von Mises stress / half-width",
    formula="min z/a >= 0.3; z: depth of the maximum von Mises stress, a: half-width",
    reason="A maximum at the surface is that of an element, not of the contact.",
    unit="-",
    sense="at_least",
    source="0.70 half-widths under a frictionless line contact, Johnson (1985) sec. 4.2(c)",
    method="least depth over the turn; a maximum at the surface is a singularity or element error",
    evidence=True,
    tier=Tier.CYCLE,
)
def subsurface_depth(solution: Solution) -> Demand:
    """Minimum depth of the maximum von Mises stress, in half-widths."""

    def share(cycle: Cycle) -> Array:
        half = cycle.contact.half_width
        loaded = half > 0
        depth = cycle.contact.von_mises_depth / np.where(loaded, half, 1.0)
        return np.where(loaded, depth, np.where(np.isnan(half), np.nan, np.inf))

    worst = least(solution.cycles, share)
    return Demand(worst.value, SUBSURFACE, worst)


def _bores(solution: Solution) -> list[BoreStress]:
    return [c.rolling.bore for c in solution.cycles if c.rolling.bore is not None]


def _away_from_edges(cycle: Cycle) -> Array:
    bore = cycle.rolling.bore
    return np.full(cycle.theta.size, np.nan) if bore is None else bore.away_from_edges
