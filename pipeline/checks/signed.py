"""Limits a sign-off asks for besides: over-speed, life, edges, room."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from geometry.arrays import FULL_TURN, Array
from pipeline.checks import demands
from pipeline.checks.check import Check
from pipeline.checks.contact import softer
from pipeline.checks.trial import TrialEvidence, greatest, least, rollers_only
from pipeline.contact import hertz

RPM = 30.0 / math.pi
PSI = 6894.757293168  # Pa


def jump_speed(evidence: TrialEvidence) -> Check:
    """Crank speed at which the follower leaves the cam, against the over-speed."""
    worst = least(evidence, _jump_speed)
    factor = evidence.limit("jump_speed", 1.3)
    over, note = _overspeed(evidence)
    return Check(
        id="jump_speed",
        title="Crank speed of the first jump",
        demand=RPM * worst.value,
        limit=None if factor is None else RPM * factor * over,
        unit="rpm",
        sense="at_least",
        source=evidence.source(
            "jump_speed", f"{factor} times the over-speed, Norton (2009), Rothbart (2004): verify"
        ),
        method="least w sqrt(F_s / (-m w^2 s'')) where the follower slows, friction-free",
        lift_can_help=True,
        note=note,
        load_case="",
        cam_angle_deg=worst.cam_angle_deg,
        error_share=worst.error_share,
    )


def contact_at_overspeed(evidence: TrialEvidence) -> Check:
    """Least contact force at the over-speed beside the preload."""
    over, note = _overspeed(evidence)

    def force(cycle: Any) -> Array:
        scale = (over / cycle.crank_speed) ** 2
        loads = cycle.loads
        return np.asarray(
            demands.force_left(
                loads.spring_force, scale * loads.inertia_force, evidence.preload(cycle)
            )
        )

    worst = least(evidence, force)
    return Check(
        id="contact_at_overspeed",
        title="Least contact force over preload at the over-speed",
        demand=worst.value,
        limit=evidence.limit("contact_force_margin", 0.2),
        unit="-",
        sense="at_least",
        source=evidence.source(
            "contact_force_margin", "0.2 to 0.3 of the preload at the highest speed, Norton (2009)"
        ),
        method="least spring force plus m w^2 s'' at the over-speed, friction-free",
        lift_can_help=True,
        note=note,
        load_case="",
        cam_angle_deg=worst.cam_angle_deg,
        error_share=worst.error_share,
    )


def contact_pressure_at_life(evidence: TrialEvidence) -> Check:
    """Greatest contact pressure against the endurance at the life asked for."""
    case = evidence.case
    name = case.cam.material
    card, life = case.materials[name], evidence.limit("target_life")
    slope, intercept = (getattr(card, n, None) for n in ("endurance_slope", "endurance_intercept"))
    safety = evidence.limit("contact_safety", 1.0)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = None
    if None not in (slope, intercept, life, safety):
        speed = max((evidence.cam_speed(c) for c in evidence.cycles), default=math.nan)
        modulus = _contact_modulus(evidence)
        limit = pressure_at_life(life * speed / FULL_TURN, slope, intercept, modulus) / safety  # type: ignore[operator,arg-type]
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
    crowned = bool(getattr(evidence.facing, "crowned", False))
    factor = 1.0 if crowned else evidence.limit("edge_factor", 1.3)
    safety, endurance = evidence.limit("contact_safety", 1.0), material.endurance_pressure
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    known = endurance is not None and safety is not None
    return Check(
        id="edge_pressure",
        title=f"Pressure at the {evidence.facing_name}'s ends against surface endurance",
        demand=None if factor is None else 1e-6 * factor * worst.value,
        limit=1e-6 * endurance / safety if known and endurance and safety else None,
        unit="MPa",
        source=evidence.source(
            "edge_factor",
            f"derate 1.3 to 2 or crown the {evidence.facing_name}, shop practice: verify",
            f"{name}: {material.source}",
        ),
        method=f"greatest contact pressure times {factor}; two dimensions cannot see the ends",
        lift_can_help=True,
        note="" if known else f"the card of {name} gives no endurance pressure",
        **worst.place,
    )


def shakedown_traction(evidence: TrialEvidence) -> Check:
    """Contact pressure against elastic shakedown with the follower sliding."""
    name, material = softer(evidence)
    friction = getattr(evidence.facing, "friction", None)
    safety = evidence.limit("shakedown_safety", 1.0)
    worst = greatest(evidence, lambda cycle: cycle.contact.p0)
    limit = None
    if friction is not None and safety is not None:
        shear_yield = material.yield_strength / math.sqrt(3.0)
        limit = shakedown_factor(float(friction)) * shear_yield / safety
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


def guide_clearance(evidence: TrialEvidence) -> Check:
    """Gap between guide A and whatever of cam and follower comes nearest."""
    case, contour = evidence.case, evidence.contour
    pitch, guide = contour.pitch, case.guides.a
    overhang = case.follower.overhang_at_max_lift
    mouth = overhang - 0.5 * guide.length
    highest = pitch.height_base + pitch.lift.highest.value + mouth
    behind = contour.roller_radius if evidence.face is None else evidence.face.thickness
    gap = float(np.minimum(highest - contour.radius_max().value, mouth - behind))
    asked = evidence.limit("clearance", 1e-3)
    return Check(
        id="guide_clearance",
        title=f"Gap between guide A and cam or {evidence.facing_name}",
        demand=1e3 * gap,
        limit=None if asked is None else 1e3 * asked,
        unit="mm",
        sense="at_least",
        source=evidence.source("clearance", "1 to 2 mm, shop practice: verify"),
        method="guide's face less the greatest contour radius, and less the "
        f"{evidence.facing_name}, at full lift",
        lift_can_help=True,
        note="the spring's and the frame's places are not in the case",
    )


def cam_envelope(evidence: TrialEvidence) -> Check:
    """Greatest radius of the cam beside the room there is."""
    value, theta = evidence.contour.radius_max()
    room = evidence.limit("cam_radius")
    return Check(
        id="cam_envelope",
        title="Greatest radius of the cam",
        demand=1e3 * float(value),
        limit=None if room is None else 1e3 * room,
        unit="mm",
        cam_angle_deg=float(np.rad2deg(theta)) % 360.0,
        source=evidence.source("cam_radius", "room as given in the case"),
        method="greatest radius of the contour, refined between samples",
        lift_can_help=True,
        note="" if room is not None else "no room for the cam is given",
    )


@rollers_only
def roller_radial(evidence: TrialEvidence) -> Check:
    """Greatest force on the roller against what its outer ring bears unsupported."""
    bearing = evidence.case.roller.bearing
    limit = getattr(bearing, "radial_limit", None)
    worst = greatest(evidence, lambda cycle: cycle.loads.normal_force)
    return Check(
        id="roller_radial",
        title="Force on the roller against the rating of its outer ring",
        demand=worst.value,
        limit=limit,
        unit="N",
        source=evidence.source(
            "radial_limit", "F_r,max of a track roller", f"{bearing.name}: {bearing.source}"
        ),
        method="greatest normal force over the turn",
        lift_can_help=True,
        note=""
        if limit is not None
        else f"{bearing.name} has no rating for an outer ring without a housing",
        **worst.place,
    )


def guide_length(evidence: TrialEvidence) -> Check:
    """Distance of the guides beside the greatest overhang."""
    case = evidence.case
    overhang = case.follower.overhang_at_max_lift + evidence.contour.pitch.lift.highest.value
    spread = case.guides.spacing + 0.5 * (case.guides.a.length + case.guides.b.length)
    return Check(
        id="guide_length",
        title="Guided length over the greatest overhang",
        demand=spread / overhang,
        limit=evidence.limit("guide_length", 2.0),
        unit="-",
        sense="at_least",
        source=evidence.source(
            "guide_length", "bearing length at least twice the overhang, Rothbart (2004) ch. 6"
        ),
        method="outer ends of the two guides over the overhang at the least lift",
        must_have=False,
        lift_can_help=True,
    )


def _jump_speed(cycle: Any) -> Array:
    """Crank speed (n,), rad/s, at which each place of the turn lets go; a NaN stays."""
    pull = -np.asarray(cycle.loads.inertia_force, dtype=float)
    spring = np.asarray(cycle.loads.spring_force, dtype=float)
    slows = pull > 0
    ratio = np.sqrt(spring / np.where(slows, pull, 1.0))
    free = np.where(np.isnan(pull), np.nan, np.inf)
    return np.where(slows, cycle.crank_speed * ratio, free)


def _overspeed(evidence: TrialEvidence) -> tuple[float, str]:
    """Over-speed of the crank, rad/s, and what to say of it."""
    given = evidence.limit("overspeed")
    fastest = max((float(c.crank_speed) for c in evidence.cycles), default=math.nan)
    if given is not None and given >= fastest:
        return given, ""
    return fastest, "no over-speed is given: that of the fastest load case"


def _contact_modulus(evidence: TrialEvidence) -> float:
    case = evidence.case
    cam, other = case.materials[case.cam.material], case.materials[evidence.facing.material]
    return hertz.contact_modulus(cam.E, cam.nu, other.E, other.nu)


CHECKS = (
    jump_speed,
    contact_at_overspeed,
    contact_pressure_at_life,
    edge_pressure,
    shakedown_traction,
    guide_clearance,
    cam_envelope,
    roller_radial,
    guide_length,
)
