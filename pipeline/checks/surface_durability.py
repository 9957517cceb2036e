"""Checks of the running surface: traction, oil film, fatigue, case depth."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from math import inf
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.hardness_rules import (
    BUCKINGHAM_MAX,
    buckingham,
    endurance_by_hardness,
    gear_limit,
)
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    CASE_DEPTH_RATIO,
    CASE_SAFETY,
    FATIGUE_SAFETY,
    FILM_RATIO,
    TRACTION_SHARE,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import demands
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import NONE, STATED, Demand, Kept, check, of_key
from camwright.pipeline.checks.contact_strength import (
    endurance_of,
    line_factor,
    middle_pressure,
    of_elements,
    with_its_track,
)
from camwright.pipeline.checks.extremes import (
    cycle_of,
    greatest,
    least,
    on_both_tracks,
    worst_case,
)
from camwright.pipeline.checks.missing_keys import (
    lacking,
    lacking_along_line,
    lacking_of_card,
)
from camwright.pipeline.contact.oil_film import Lubricant
from camwright.pipeline.contact.rolling_envelope import Envelope
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.traction import rolling_demand
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, not_negative, roller_of
from camwright.pipeline.cycle.rolling_history import SweptStress
from camwright.pipeline.cycle.solution import Solution

RULE_RATIO = 1.5


def _tangential(cam: LoadedCam) -> Array:
    """Magnitude of the tangential force at the roller that rolling without slip needs (..., n), N;
    NaN where the drag is not known.
    """
    path, drag = roller_of(cam.motion), cam.drag
    if drag is None:
        return np.full(np.shape(cam.normal), np.nan)
    acceleration = cam.speed**2 * path.slide_slope / path.size
    force = not_negative(cam.normal)
    bearing = drag.bearing_torque(force)
    return magnitude(rolling_demand(cam.rotor_inertia, bearing, cam.spin, acceleration, path.size))


def _traction(cam: LoadedCam) -> Array:
    """Tangential over normal force of rolling without slip; 0 where unloaded."""
    share = demands.over_contact_force(_tangential(cam), cam.normal, cam.least_spring)
    return np.where(np.real(cam.normal) <= 0.0, 0.0, share)


def _traction_kept(cam: LoadedCam, friction: float) -> Array | None:
    """No constraint without the drag of the roller."""
    if cam.drag is None:
        return None
    return demands.over_normal_force(cam, _tangential(cam) / friction)


_ROLLING = {
    "?": "roller.bearing.drag_torque None; roller.bearing.friction None",
    "T": "|roller.rotor_inertia roller_acceleration|/roller.radius [N]",
    "N": "normal_force",
}
"""Symbols of a roller whose bearing has no drag."""


traction_demand = check(
    id="traction_demand",
    title="Traction coefficient vs. friction coefficient",
    source=Source(
        "rolling without slip, Rothbart (ed.), Cam Design Handbook, McGraw-Hill 2004, p. 308,"
        " eq. 10.7, the inertia of the roller; the drag of its bearing is added",
        confirmed=True,
    ),
    method="(roller inertia + bearing drag) over roller radius and normal force",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    kept_as="friction of the roller on the cam",
    formula="T/N <= mu; T: tangential force of rolling without slip, from the inertia of the roller"
    " and the drag of its bearing, N: normal force, at least 1 % of the least spring force, mu:"
    " roller.friction",
    symbols=_ROLLING,
    reason="a roller that slips wears the track, and its endurance is that of sliding",
    values=given.TRACTION,
    closed_by="force",
    page="Contact",
).measured(
    "angles",
    allowed=of_key("roller.friction"),
    deviation=0.01,
    kept=Kept(_traction_kept, unit="-"),
)(_traction)


traction_reserve = check(
    TRACTION_SHARE,
    id="traction_reserve",
    title="Traction coefficient vs. share of the friction coefficient",
    method="(roller inertia + bearing drag) over roller radius and normal force",
    must_have=False,
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    formula="T/N <= c mu; c: limits.traction_share, others as of traction_demand",
    symbols={**_ROLLING, "mu": "roller.friction"},
    reason="a reserve against a friction coefficient lower than stated; grip itself is"
    " traction_demand",
    values=given.TRACTION,
    closed_by="force",
    page="Contact",
).measured(
    "angles",
    allowed=of_key("roller.friction", TRACTION_SHARE),
    # 1.6 % of a cam about to leave its roller: the quotient has a kink where the force is least
    deviation=0.02,
)(_traction)


@check(
    FILM_RATIO,
    title="Minimum film thickness ratio (lambda)",
    method="least film of Dowson and Higginson (1966) where loaded and running, over the rms"
    " roughness",
    must_have=False,
    formula="lambda = h_min / sqrt(Rq1^2 + Rq2^2) >= limits.film_ratio; h_min: film of smooth"
    " surfaces in line contact, Rq: rms roughness of cam and follower",
    symbols={
        "h_min": "film_thickness [um]",
        "Rq1": "cam.roughness",
        "Rq2": "roller.roughness",
        "?": "follower.face None",
    },
    reason="the endurance rows hold for lubricated cams in mixed lubrication too, and at"
    " reversals of the motion no film of steady rolling exists",
    values=(
        *given.CONTACT,
        "lubricant.*viscosity",
        "cam.roughness",
        "roller.roughness",
        "follower.face.roughness",
    ),
    page="Contact",
)
def film_ratio(solution: Solution) -> Demand:
    """Least film thickness over composite roughness; at standstill only if no load case runs."""
    machine = solution.machine
    oil, kind = machine.lubricant, machine.follower
    running = [cycle for cycle in solution.cycles if cycle.machine.speed > 0]
    turns = running or solution.cycles
    worst = least(turns, lambda cycle: -on_both_tracks(cycle, _thinness))
    if machine.cam.clearance > 0.0:
        # the film grows without bound where the load crosses zero: no parabola passes such a sample
        share = greatest(turns, lambda cycle: on_both_tracks(cycle, _scarcity)).error_share
        worst = worst._replace(error_share=share / (1.0 + share))
    crowned = machine.is_crowned
    missing = lacking(machine.cam.table, machine.cam, "roughness")
    missing += lacking(kind.table, kind, "roughness")
    judged = Demand(
        worst.value,
        machine.limits[FILM_RATIO],
        worst,
        missing if oil else (Lubricant.table, *missing),
        note="film of a line contact; that of an ellipse is thinner by its side flow"
        if crowned
        else "",
        figures=() if oil is None else (oil.source,),
    )
    return with_its_track(judged, solution, _thinness, {"h_min": _film_thickness})


def _torsion_demand(
    solution: Solution,
    measure: Callable[[Envelope], float],
    stated: Callable[[Envelope], dict[str, float]],
) -> Demand:
    """Demand of an equivalent fatigue stress, Pa, that `measure` takes from the map of stresses of
    a turn, against the fatigue limit in torsion of the cam.
    """
    card = solution.machine.cam.material
    endured, safety = card.fatigue_torsion, solution.machine.limits[FATIGUE_SAFETY]
    strengths_stated = endured is not None and card.fatigue_bending is not None
    worst = worst_case(
        solution.cycles,
        lambda cycle: measure(cycle.rolling.swept.governing) if strengths_stated else math.nan,
    )
    return Demand(
        worst.value,
        endured / safety if strengths_stated and endured else None,
        worst,
        lacking_of_card(card, "fatigue_torsion", "fatigue_bending"),
        figures=(f"{card.name}: {card.source}",),
        stated=stated(cycle_of(solution.cycles, worst).rolling.swept.governing)
        if strengths_stated
        else {},
    )


def _crossland(swept: Envelope) -> dict[str, float]:
    """Parts of the greatest Crossland stress, Pa: root of the second invariant "s_J" and
    hydrostatic tension "s_H"; empty where they are not known.
    """
    if swept.crossland is None or swept.root_j2 is None or swept.tension is None:
        return {}
    index = np.unravel_index(first_greatest(swept.crossland.ravel()), swept.crossland.shape)
    return {"s_J": float(swept.root_j2[index]), "s_H": float(swept.tension[index])}


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
    formula="s_J + a_C s_H <= t / S; a_C = max(3 t/f - sqrt(3), 0), s_J: sqrt(J2a), root of the"
    " amplitude of the second invariant of the deviator, s_H: greatest hydrostatic stress of the"
    " passage, 0 in compression, where the sum is greatest below the contour, t, f: fully reversed"
    " fatigue limits of the cam in torsion and bending, S: limits.fatigue_safety",
    symbols={
        **dict.fromkeys(("s_J", "s_H"), f"{STATED} [MPa]"),
        "t": "cam.material.fatigue_torsion",
        "f": "cam.material.fatigue_bending",
        "a_C": "[-]",
    },
    reason="the endurance pressure is measured, this criterion is transferred from"
    " torsion and bending",
    values=(*given.CONTACT, *given.CAM_FATIGUE),
    page="Contact",
)
def surface_fatigue(solution: Solution) -> Demand:
    """Maximum Crossland stress over a passage of the contact, Pa."""
    return _torsion_demand(solution, lambda swept: _greatest_of(swept.crossland), _crossland)


@check(
    FATIGUE_SAFETY,
    id="dang_van",
    title="Subsurface fatigue, Dang Van criterion",
    unit="MPa",
    method="Dang Van (1993): shear amplitude plus weighted hydrostatic stress, no credit for"
    " compression (Desimone 2006, to be confirmed), the load travelling along the contour",
    must_have=False,
    lift_can_help=True,
    error="contact",
    formula="tau_D <= t / S; tau_D: greatest tau_a + a_DV max(sigma_h, 0) below the contour, of the"
    " solved stresses of a passage, a_DV: 3 (t/f - 1/2), t, f, S: as of surface_fatigue",
    symbols={
        "tau_D": f"{STATED} [MPa]",
        "t": "cam.material.fatigue_torsion",
        "S": f"limits.{FATIGUE_SAFETY.id}",
    },
    reason="without credit for compression the criterion is on the safe side, but the"
    " published form of the cap is recalled, not read",
    values=(*given.CONTACT, *given.CAM_FATIGUE),
    page="Contact",
)
def dang_van(solution: Solution) -> Demand:
    """Maximum Dang Van stress over a passage of the contact, Pa."""
    return _torsion_demand(
        solution,
        lambda swept: _greatest_of(swept.dang_van),
        lambda swept: {"tau_D": _greatest_of(swept.dang_van)},
    )


@check(
    CASE_SAFETY,
    id="hardened_case",
    title="Subsurface stress vs. strength of case and core",
    method="greatest von Mises stress over the yield strength at its depth, which falls linearly"
    " from surface to core over the case depth; the worse of cam and follower, where hardened",
    lift_can_help=True,
    error="contact",
    kept_as="contact pressure at the strength of case and core",
    formula="max sigma_v/Y <= 1 / S; Y = Y_s + (Y_c - Y_s) min(z/d, 1): yield strength, linear from"
    " surface, Y_s, to core, Y_c, over the case depth d, sigma_v: von Mises stress at the depth z"
    " of the greatest quotient, S: limits.case_safety",
    symbols={
        **dict.fromkeys(("sigma_v", "Y_s", "Y_c"), f"{STATED} [MPa]"),
        **dict.fromkeys("zd", f"{STATED} [mm]"),
        "Y": "[MPa]",
    },
    reason="of a hardened surface: a core that yields lets the case break in",
    values=(
        *given.CONTACT,
        "cam.material.yield_strength",
        "cam.material.core_yield_strength",
        "cam.material.case_depth",
    ),
    levers=levers.CASE,
    page="Cam",
    certified_by="von_mises",
    scales_with=(demands.PRESSURE, 1.0),
)
def hardened_case(solution: Solution) -> Demand | None:
    """Greatest von Mises stress over the yield strength at its depth; None if no body is
    surface-hardened.
    """

    def use(swept: SweptStress, card: Material) -> _StrengthUse:
        strengths = card.yield_strength, card.core_yield_strength
        return _use_of_strength(swept, lambda at: at.von_mises, card.case_depth, strengths)

    allowed = 1.0 / solution.machine.limits[CASE_SAFETY]
    keys, symbols = ("case_depth", "core_yield_strength"), ("sigma_v", "Y_s", "Y_c", "z", "d")
    return _hardened_demand(solution, use, allowed, keys, symbols)


@check(
    FATIGUE_SAFETY,
    id="case_shear",
    title="Subsurface shear amplitude vs. shear fatigue strength of case and core",
    unit="-",
    method="greatest amplitude of the shear stress along the surface over the fatigue limit in"
    " torsion at its depth, which falls linearly from surface to core over the case depth; the"
    " worse of cam and follower, where hardened",
    lift_can_help=True,
    error="contact",
    kept_as="contact pressure at the shear fatigue of case and core",
    formula="max tau_a/t <= 1 / S; t = t_s + (t_c - t_s) min(z/d, 1): fully reversed fatigue limit"
    " in torsion, linear from fatigue_torsion, t_s, to core_fatigue_torsion, t_c, over the case"
    " depth d, tau_a: half of the range of tau_xz at the depth z of the greatest quotient, S:"
    " limits.fatigue_safety",
    symbols={
        **dict.fromkeys(("tau_a", "t_s", "t_c"), f"{STATED} [MPa]"),
        **dict.fromkeys("zd", f"{STATED} [mm]"),
        "t": "[MPa]",
    },
    reason="of a hardened surface: cracks start below the case, where the strength has"
    " fallen and the shear has not",
    values=(
        *given.CONTACT,
        *given.TRACTION,
        "cam.material.case_depth",
        "cam.material.fatigue_torsion",
        "cam.material.core_fatigue_torsion",
    ),
    levers=levers.CASE,
    page="Cam",
    certified_by="tau_max",
    scales_with=(demands.PRESSURE, 1.0),
)
def case_shear(solution: Solution) -> Demand | None:
    """Greatest shear amplitude over the fatigue limit in torsion at its depth; None if no body is
    surface-hardened.
    """

    def use(swept: SweptStress, card: Material) -> _StrengthUse:
        strengths = card.fatigue_torsion, card.core_fatigue_torsion
        return _use_of_strength(swept, lambda at: 0.5 * at.shear_range, card.case_depth, strengths)

    allowed = 1.0 / solution.machine.limits[FATIGUE_SAFETY]
    keys = "case_depth", "fatigue_torsion", "core_fatigue_torsion"
    return _hardened_demand(solution, use, allowed, keys, ("tau_a", "t_s", "t_c", "z", "d"))


def hardened_bodies(solution: Solution) -> dict[str, Material]:
    """Materials by body with a hardened case, or of unstated treatment."""
    bodies = solution.machine.bodies
    return {body: card for body, card in bodies.items() if card.surface_hardened is not False}


def _lacks(card: Material, *keys: str) -> tuple[str, ...]:
    """Those of some keys that a hardened body lacks, or the key that states its treatment."""
    return lacking_of_card(card, *keys) if card.surface_hardened else _untreated(card)


def _untreated(card: Material) -> tuple[str, ...]:
    return lacking_of_card(card, "treatment")


def _hardened_demand(
    solution: Solution,
    use: Callable[[SweptStress, Material], _StrengthUse],
    allowed: float,
    keys: tuple[str, ...],
    symbols: tuple[str, ...],
) -> Demand | None:
    """Demand of the greatest use of the strength at any depth, over the surface-hardened bodies,
    which needs the keys `keys` of their materials; None without such a body.

    symbols: of stress, strengths of surface and core, depth and case depth in the formula.

    Every point of the follower meets the greatest stress of the turn: the maximum over the contour
    is that of both bodies.
    """
    bodies = hardened_bodies(solution)
    if not bodies:
        return None

    def of_turn(card: Material) -> Callable[[Cycle], float]:
        return lambda cycle: use(cycle.rolling.swept, card).share

    worst = {body: worst_case(solution.cycles, of_turn(card)) for body, card in bodies.items()}
    incomplete = [body for body, card in bodies.items() if math.isnan(_probe(use, card))]
    complete = [body for body in bodies if body not in incomplete]
    judged = complete or list(bodies)
    governing = judged[first_greatest([worst[body].value for body in judged])]
    extreme = worst[governing]
    swept = cycle_of(solution.cycles, extreme).rolling.swept
    return Demand(
        None if incomplete and not extreme.value > allowed else extreme.value,
        allowed,
        extreme,
        tuple(key for body in incomplete for key in _lacks(bodies[body], *keys)),
        figures=tuple(f"{card.name}: {card.source}" for card in bodies.values()),
        stated=dict(zip(symbols, use(swept, bodies[governing])[1:], strict=True)),
    )


def _probe(use: Callable[[SweptStress, Material], _StrengthUse], card: Material) -> float:
    """Use of the strength in an envelope without stress: NaN where the card lacks data."""
    one = np.zeros((1, 1))
    return use(SweptStress(lambda: Envelope(one[0], one[0], one, one, one, one)), card).share


def _signed_depth(cycle: Cycle) -> Array:
    """Depth of the maximum shear (n,), m, where the signed pressure acts; NaN without the ends."""
    if cycle.length is None:
        return np.full(cycle.theta.size, np.nan)
    return cycle.length.factor * cycle.contact.tau_depth


@check(
    CASE_DEPTH_RATIO,
    id="case_depth",
    title="Effective case depth / depth of maximum shear stress",
    method="effective case depth of the material over the greatest depth of tau_max over the turn,"
    " at the signed contact pressure of edge_pressure; least of cam and follower, where hardened",
    lift_can_help=True,
    kept_as="normal force at the least case depth",
    formula="d / (r K z) >= limits.case_depth_ratio; d: case_depth, least of the hardened bodies,"
    " z: depth of the maximum shear stress of plane strain, r, K: factors of edge_pressure, of the"
    " greatest product over all load cases",
    symbols={"d": f"{STATED} [mm]", "r": STATED, "K": "length_factor", "z": "tau_depth [mm]"},
    reason="of a hardened surface: the maximum shear stress must lie within the case",
    values=(*given.LENGTH, "cam.material.case_depth"),
    levers=levers.CASE,
    page="Cam",
    scales_with=(demands.NORMAL_FORCE, 0.5),
)
def case_depth(solution: Solution) -> Demand | None:
    """Effective case depth over the greatest depth of the maximum shear stress; None if no body is
    surface-hardened.
    """
    bodies = hardened_bodies(solution)
    if not bodies:
        return None
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, _signed_depth))
    stated = {"d": min((card.case_depth or np.nan for card in bodies.values()), default=np.nan)}
    loaded = worst.value > 0 or np.isnan(worst.value)
    limit = solution.machine.limits[CASE_DEPTH_RATIO]
    depths = [card.case_depth for card in bodies.values() if card.case_depth is not None]
    ratio = min(depths) / worst.value if depths and loaded else None
    incomplete = [card for card in bodies.values() if card.case_depth is None]
    judged = Demand(
        None if incomplete and not (ratio is not None and ratio < limit) else ratio,
        limit,
        worst,
        (
            *(key for card in incomplete for key in _lacks(card, "case_depth")),
            *lacking_along_line(solution.machine),
        ),
        figures=tuple(f"{card.name}: {card.source}" for card in bodies.values()),
        stated=stated | of_elements(solution, worst, _signed_depth),
    )
    symbols = {"K": line_factor, "z": lambda cycle: cycle.contact.tau_depth}
    return with_its_track(judged, solution, _signed_depth, symbols)


@check(
    title="Peak contact pressure vs. Buckingham estimate",
    unit="MPa",
    source=Source(
        "2.76 HB - 70 MPa at 1e8 cycles, Shigley's Mechanical Engineering Design, 9th ed., p. 329,"
        " eq. 6-68; up to 400 HB alone here",
        confirmed=True,
    ),
    method="greatest contact pressure over the turn; an estimate for steel without a hardened case;"
    " least of the bodies of a stated Brinell hardness up to 400",
    must_have=False,
    lift_can_help=True,
    error="contact",
    formula="p0 <= 2.76 HB - 70 MPa; HB: hardness_brinell, at most 400",
    symbols={
        "p0": "p0_fe [MPa]",
    },
    reason="an estimate from the hardness alone; contact_pressure has the endurance of the card",
    values=(*given.CONTACT, "cam.material.hardness*"),
    page="Contact",
    certified_by="p0",
)
def pressure_by_hardness(solution: Solution) -> Demand | None:
    """Maximum contact pressure, Pa, against Buckingham's estimate of the softer body.

    None if the cam is surface-hardened and the follower has no hardness within the estimate.
    """
    bodies = solution.machine.bodies
    soft = {body: card for body, card in bodies.items() if not card.surface_hardened}
    if "cam" not in soft and not any(map(buckingham, soft.values())):
        return None

    def lacks(card: Material) -> tuple[str, ...]:
        return lacking_of_card(card, "hardness_brinell")

    def reason(card: Material) -> str:
        return f"has {card.hardness_brinell:g} HB, above the {BUCKINGHAM_MAX:g} HB of the estimate"

    return _estimate(solution, soft, buckingham, lacks, reason)


@check(
    title="Peak contact pressure vs. gear flank allowable",
    unit="MPa",
    source=Source(
        "ISO 6336-5, quality MQ: 1500 MPa of case-hardened steel, read second-hand; the lines by"
        " hardness are recalled",
        confirmed=False,
    ),
    method="greatest contact pressure over the turn; for comparison only; least of the bodies of a"
    " stated treatment and Vickers hardness",
    must_have=False,
    lift_can_help=True,
    error="contact",
    formula="p0 <= sigma_Hlim; carburised 1500 MPa, induction hardened 0.541 HV + 882 MPa,"
    " through-hardened 1.313 HV + 373 MPa; HV: hardness_vickers",
    symbols={
        "p0": "p0_fe [MPa]",
    },
    reason="allowable stress of gear flanks, for comparison",
    values=(*given.CONTACT, "cam.material.hardness*"),
    page="Contact",
    certified_by="p0",
)
def pressure_by_gear_limits(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against the allowable stress of gear flanks."""

    def lacks(card: Material) -> tuple[str, ...]:
        if card.treatment in (None, "not_hardened"):
            return _untreated(card)
        return lacking_of_card(card, "hardness_vickers")

    def reason(card: Material) -> str:
        if card.treatment == "not_hardened":
            return "is not hardened, and has no line"
        return "has no Vickers hardness within the range of its line"

    return _estimate(solution, solution.machine.bodies, gear_limit, lacks, reason)


def _estimate(
    solution: Solution,
    bodies: Mapping[str, Material],
    rule: Callable[[Material], float | None],
    lacks: Callable[[Material], tuple[str, ...]],
    reason: Callable[[Material], str],
) -> Demand:
    """Demand of the greatest contact pressure, Pa, against the least estimate by a rule of hardness
    over the bodies that have one.

    lacks: keys that the rule needs; reason: why it does not hold for a card that has them.
    """
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, middle_pressure))
    limits = {body: rule(card) for body, card in bodies.items()}
    stated = {body: value for body, value in limits.items() if value is not None}
    incomplete = {body: card for body, card in bodies.items() if body not in stated}
    notes = [
        f"the {body}, {card.name}, {reason(card)}"
        for body, card in incomplete.items()
        if not lacks(card)
    ]
    judged = Demand(
        worst.value,
        min(stated.values()) if stated else None,
        worst,
        tuple(key for card in incomplete.values() for key in lacks(card)),
        note="; ".join(notes),
        figures=tuple(f"{bodies[body].name}: {bodies[body].source}" for body in stated),
    )
    return with_its_track(judged, solution, middle_pressure, {"p0": middle_pressure})


@check(
    title="Greatest ratio of two endurance rules for one material",
    unit="-",
    source=Source(
        "two rules for one material that differ by 1.5 or more need a reason",
        confirmed=True,
    ),
    method="endurance pressure of the card, Buckingham estimate and gear flank allowable, of cam"
    " and follower",
    must_have=False,
    evidence=True,
    moved_by_tolerance=False,
    formula="p_1 / p_2 <= 1.5; p_1, p_2: greatest and least for one body of the endurance pressure"
    " of the card in this contact, 2.76 HB - 70 MPa, ISO 6336-5, where they apply",
    symbols=dict.fromkeys(("p_1", "p_2"), f"{STATED} [MPa]"),
    reason="rules for different tests may differ; a greater ratio shows that one of them"
    " does not hold for this card",
    load_cases=NONE,
    values=given.bodies("*endurance_pressure", "hardness*"),
)
def endurance_rules(solution: Solution) -> Demand:
    """Greatest ratio of two rules for the endurance pressure of one body, that of its card and
    those by its hardness; not evaluated where no body has two.
    """
    machine = solution.machine
    spread, notes, stated = None, [], dict[str, float]()
    for body, card in machine.bodies.items():
        rules = _rules(machine, card)
        if len(rules) < 2:
            notes.append(f"the {body}, {card.name}, has fewer than two rules")
            continue
        most, least_one = max(rules.values()), min(rules.values())
        if spread is None or most / least_one > spread:
            spread, stated = most / least_one, {"p_1": most, "p_2": least_one}
        words = ", ".join(f"{name} {shown(value, 'MPa')}" for name, value in rules.items())
        notes.append(f"{body}, {card.name}: {words}")
    return Demand(spread, RULE_RATIO, note="; ".join(notes), stated=stated)


def _rules(machine: Machine, card: Material) -> dict[str, float]:
    """Endurance pressures of a material, Pa, by name of the rule: stated by kind of motion, and
    estimated from its hardness.
    """
    row = endurance_of(machine, card)
    by_motion = {row.motion: row.pressure} if row.pressure else {}
    return by_motion | endurance_by_hardness(card)


def _thinness(cycle: Cycle) -> Array:
    """`_lambda` with its sign changed (n,), which is greatest where the film is thinnest."""
    return -_lambda(cycle)


def _scarcity(cycle: Cycle) -> Array:
    """Roughness over film thickness at each cam angle (n,), 0 where unloaded."""
    with np.errstate(divide="ignore"):
        return 1.0 / _lambda(cycle)


def _film_thickness(cycle: Cycle) -> Array:
    """Film thickness (n,), m; NaN where it is not known."""
    film = cycle.rolling.film
    return np.full(cycle.theta.size, np.nan) if film is None else film.thickness


def _lambda(cycle: Cycle) -> Array:
    """Film thickness over roughness at each cam angle (n,), infinite where unloaded; NaN where it
    is not known.
    """
    film = cycle.rolling.film
    ratio = None if film is None else film.ratio
    if ratio is None:
        return np.full(cycle.theta.size, np.nan)
    return np.where(np.isnan(ratio), inf, ratio)


def _greatest_of(field: Array | None) -> float:
    return np.nan if field is None else float(field.max())


def _use_of_strength(
    swept: SweptStress,
    stress: Callable[[Envelope], Array],
    case: float | None,
    strengths: tuple[float | None, float | None],
) -> _StrengthUse:
    """Greatest `stress` over the strength at its depth, which falls linearly from the surface to
    the end of the case, `case` deep, m; strengths : of surface and core, Pa. NaN without case depth
    or a strength.
    """
    surface, core = strengths
    if case is None or surface is None or core is None:
        return _StrengthUse(*(6 * [np.nan]))
    at = swept.governing if core <= surface else swept.envelope
    inward = np.clip(at.depth / case, 0.0, 1.0)
    share = stress(at) / (surface + (core - surface) * inward)
    index = np.unravel_index(first_greatest(share.ravel()), share.shape)
    values = float(share.max()), float(stress(at)[index])
    return _StrengthUse(*values, surface, core, float(at.depth[index]), case)


class _StrengthUse(NamedTuple):
    """Greatest stress over the strength at its depth, and what it is made of, SI."""

    share: float
    stress: float
    surface: float
    core: float
    depth: float
    case_depth: float
