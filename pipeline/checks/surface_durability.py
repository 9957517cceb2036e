"""Checks of the running surface: traction, oil film, fatigue, case depth."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.limits import (
    CASE_DEPTH_RATIO,
    CASE_SAFETY,
    FATIGUE_SAFETY,
    FILM_RATIO,
    TRACTION_SHARE,
)
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.contact_strength import peak_pressure
from camwright.pipeline.checks.extremes import greatest, least, worst_case
from camwright.pipeline.contact.rolling_envelope import Envelope
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution

CASE_CARBURISED = 1500e6  # Pa, quality MQ


@check(
    TRACTION_SHARE,
    id="traction_demand",
    title="Traction coefficient vs. friction limit",
    method="(roller inertia + bearing drag) over roller radius and normal force",
    must_have=False,
    lift_can_help=True,
    needs="roller",
)
def traction_demand(solution: Solution) -> Demand:
    """Maximum tangential over normal force of rolling without slip."""
    machine = solution.machine
    worst, friction = greatest(solution.cycles, _traction), machine.follower.friction
    return Demand(
        worst.value,
        None if friction is None else machine.limits[TRACTION_SHARE] * friction,
        worst,
        note="" if friction is not None else "no friction of the roller on the cam is given",
    )


@check(
    FILM_RATIO,
    title="Minimum film thickness ratio (lambda)",
    method="least film of Dowson and Higginson (1966) where loaded, over the rms roughness",
    must_have=False,
)
def film_ratio(solution: Solution) -> Demand:
    """Minimum film thickness over roughness."""
    machine = solution.machine
    oil, kind = machine.lubricant, machine.follower
    worst, missing = least(solution.cycles, _lambda), []
    if oil is None:
        missing.append("no lubricant")
    if machine.cam.roughness is None:
        missing.append("no roughness of the cam")
    if kind.roughness is None:
        missing.append(f"no roughness of the {kind.word}")
    return Demand(
        worst.value,
        machine.limits[FILM_RATIO],
        worst,
        note=f"{', '.join(missing)} is given" if missing else "",
        figures=() if oil is None else (oil.source,),
    )


def _torsion_demand(solution: Solution, measure: Callable[[Envelope], float]) -> Demand:
    """Equivalent fatigue stress against the fatigue limit in torsion of the cam, Pa."""
    worst = worst_case(solution.cycles, lambda cycle: measure(cycle.rolling.envelope))
    card = solution.machine.cam.material
    torsion, safety = card.fatigue_torsion, solution.machine.limits[FATIGUE_SAFETY]
    known = torsion is not None and card.fatigue_bending is not None
    return Demand(
        worst.value,
        torsion / safety if known and torsion else None,
        worst,
        note="" if known else f"the card of {card.name} gives no fatigue limits",
        figures=(f"{card.name}: {card.source}",),
    )


@check(
    FATIGUE_SAFETY,
    id="surface_fatigue",
    title="Subsurface fatigue, Crossland criterion",
    unit="MPa",
    method="Crossland (1956): root of J2's amplitude plus weighted hydrostatic stress, the load"
    " travelling along the contour",
    must_have=False,
    lift_can_help=True,
    error="contact",
)
def surface_fatigue(solution: Solution) -> Demand:
    """Maximum Crossland stress of a passage of the contact, Pa."""
    return _torsion_demand(solution, lambda swept: _greatest_of(swept.crossland))


@check(
    FATIGUE_SAFETY,
    id="dang_van",
    title="Subsurface fatigue, Dang Van criterion",
    unit="MPa",
    method="Dang Van (1993): shear amplitude plus weighted hydrostatic stress, no credit for"
    " compression (Desimone 2006), the load travelling along the contour",
    must_have=False,
    lift_can_help=True,
    error="contact",
)
def dang_van(solution: Solution) -> Demand:
    """Maximum Dang Van stress of a passage of the contact, Pa."""
    return _torsion_demand(solution, lambda swept: _greatest_of(swept.dang_van))


@check(
    CASE_SAFETY,
    id="hardened_case",
    title="Subsurface stress vs. strength of case and core",
    method="greatest von Mises stress over the yield strength at its depth, which falls linearly"
    " from surface to core over the case depth",
    must_have=False,
    lift_can_help=True,
    error="contact",
)
def hardened_case(solution: Solution) -> Demand:
    """Maximum von Mises stress over the yield strength at its depth."""
    card = solution.machine.cam.material
    known = card.case_depth is not None and card.core_yield_strength is not None
    worst = worst_case(
        solution.cycles, lambda cycle: _use_of_strength(cycle.rolling.envelope, card)
    )
    return Demand(
        worst.value if known else None,
        1.0 / solution.machine.limits[CASE_SAFETY],
        worst,
        note="" if known else f"the card of {card.name} gives no case depth or no core",
        figures=(f"{card.name}: {card.source}",),
    )


@check(
    CASE_DEPTH_RATIO,
    id="case_depth",
    title="Effective case depth / depth of maximum shear stress",
    method="effective case depth of the material over the greatest depth of tau_max over the turn",
    must_have=False,
    lift_can_help=True,
)
def case_depth(solution: Solution) -> Demand:
    """Effective case depth over the greatest depth of maximum shear stress."""
    card = solution.machine.cam.material
    depth, worst = card.case_depth, greatest(solution.cycles, lambda c: c.contact.tau_depth)
    loaded = worst.value > 0 or np.isnan(worst.value)
    return Demand(
        float(depth / worst.value) if depth is not None and loaded else None,
        solution.machine.limits[CASE_DEPTH_RATIO],
        worst,
        note="" if depth is not None else f"the card of {card.name} gives no case depth",
        figures=(card.source,),
    )


@check(
    title="Peak contact pressure vs. Buckingham estimate",
    unit="MPa",
    source="2.76 HB - 70 MPa at 1e8 cycles, Buckingham, Shigley ch. 6: verify",
    method="greatest contact pressure over the turn; an estimate for steel without a hardened case",
    must_have=False,
    lift_can_help=True,
    error="contact",
)
def pressure_by_hardness(solution: Solution) -> Demand | None:
    """Maximum contact pressure, Pa, against the Buckingham estimate; None if surface-hardened."""
    card = solution.machine.cam.material
    if card.case_depth is not None or card.treatment not in (None, "through_hardened"):
        return None
    worst = peak_pressure(solution)
    allowed = None if card.hardness is None else buckingham(card.hardness)
    return Demand(
        worst.value,
        allowed,
        worst,
        note="" if allowed is not None else f"the card of {card.name} gives no hardness",
        figures=(card.source,),
    )


@check(
    title="Peak contact pressure vs. gear flank allowable",
    unit="MPa",
    source="ISO 6336-5, quality MQ, recalled: verify",
    method="greatest contact pressure over the turn; for comparison only",
    must_have=False,
    lift_can_help=True,
    error="contact",
)
def pressure_by_gear_limits(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against the allowable stress of gear flanks."""
    worst, card = peak_pressure(solution), solution.machine.cam.material
    allowed = gear_limit(card)
    return Demand(
        worst.value,
        allowed,
        worst,
        note=""
        if allowed is not None
        else f"the card of {card.name} gives no treatment or no hardness",
        figures=(card.source,),
    )


def buckingham(hardness: float) -> float:
    """Allowable contact pressure of steel at 1e8 load cycles, from the Brinell hardness, Pa.

    References
    ----------
    Shigley's Mechanical Engineering Design, ch. 6, after Buckingham: 2.76 HB - 70 MPa.
    """
    return max(2.76e6 * hardness - 70e6, 0.0)


def gear_limit(card: Material) -> float | None:
    """Allowable contact stress of gear flanks of a steel, Pa; None where it is unknown.

    References
    ----------
    ISO 6336-5, MQ, recalled (verify): carburised 1500 MPa; induction 0.541 HV + 882 MPa;
    through-hardened alloy steel 1.313 HV + 373 MPa.
    """
    if card.treatment == "case_hardened":
        return CASE_CARBURISED
    lines = {"induction_hardened": (0.541e6, 882e6), "through_hardened": (1.313e6, 373e6)}
    if card.treatment is None or card.hardness is None:
        return None
    slope, start = lines[card.treatment]
    return slope * card.hardness + start


def _traction(cycle: Cycle) -> Array:
    """Traction coefficient (n,), 0 where unloaded; NaN where it is not known."""
    demand = cycle.rolling.traction_demand
    if demand is None:
        return np.full(cycle.theta.size, np.nan)
    return np.where(np.isnan(demand), 0.0, demand)


def _lambda(cycle: Cycle) -> Array:
    """Film thickness ratio (n,), infinite where unloaded; NaN where it is not known."""
    film = cycle.rolling.film
    ratio = None if film is None else film.ratio
    if ratio is None:
        return np.full(cycle.theta.size, np.nan)
    return np.where(np.isnan(ratio), inf, ratio)


def _greatest_of(field: Array | None) -> float:
    return np.nan if field is None else float(field.max())


def _use_of_strength(swept: Envelope, card: Material) -> float:
    depth, core = card.case_depth, card.core_yield_strength
    if depth is None or core is None:
        return np.nan
    inward = np.clip(swept.depth / depth, 0.0, 1.0)
    strength = card.yield_strength + (core - card.yield_strength) * inward
    return float((swept.von_mises / strength).max())
