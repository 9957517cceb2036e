"""Limits of the camshaft: its key, its fatigue, its bearings, the teeth that drive it.

A shaft that the case does not describe is not evaluated; a gear is asked for by describing it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks.check import Check, not_described
from camwright.pipeline.checks.extremes import TrialEvidence, greatest, worst_case
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.cycle.cam_balance import unbalance_force
from camwright.pipeline.follower.camshaft_loads import Camshaft, ShaftLoads, key_stress, shaft_loads
from camwright.pipeline.follower.roller_motion import rating_life
from camwright.pipeline.follower.shaft_strength import (
    Section,
    bending_moment,
    fatigue_safety,
    tooth_contact_stress,
    tooth_root_stress,
)

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Camshaft as CaseShaft
    from camwright.pipeline.case.parts_section import CamshaftGear
    from camwright.pipeline.cycle.cycle import Cycle

HOURS = 3600.0
NO_SHAFT = "no camshaft is given"
REVERSED = 0.7  # of the limit, where the torque changes its sign


def key_shear(evidence: TrialEvidence) -> Check:
    """Shear in the section of the cam's key."""
    cam = evidence.case.cam
    key, title = cam.keyway, "Shear of the key"
    if key is None:
        return not_described("key_shear", title, "MPa", "no keyway is given", must_have=False)

    def shear(cycle: Cycle) -> Array:
        diameter, height = 2.0 * cam.bore_radius, 2.0 * key.depth
        torque = cycle.loads.cam_torque
        known = np.where(np.isnan(torque), 0.0, torque)
        found = np.abs(key_stress(known, diameter, key.width, height, cam.width).shear)
        return np.where(np.isnan(torque), np.nan, found)

    worst = greatest(evidence, shear)
    return Check(
        id="key_shear",
        title=title,
        demand=1e-6 * worst.value,
        limit=1e-6 * evidence.case.limits.key_shear,
        unit="MPa",
        source=evidence.source("key_shear", "60 MPa under reversed torque, DIN 6892: verify"),
        method="2 T/(d b l) at the greatest cam torque",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def shaft_fatigue(evidence: TrialEvidence) -> Check:
    """Safety of the shaft under the cam against fatigue in bending and torsion."""
    case, title = evidence.case, "Fatigue safety of the camshaft at the cam's key"
    given = case.camshaft
    if given is None or given.diameter is None or given.material is None:
        note = NO_SHAFT if given is None else "no diameter or no material of the camshaft is given"
        return not_described("shaft_fatigue", title, "-", note, must_have=False)
    card = case.materials[given.material]
    endurance, tensile = card.fatigue_bending, card.tensile_strength
    known = endurance is not None and tensile is not None
    section = Section(
        given.diameter,
        given.notch_bending,
        given.notch_torsion,
        endurance or 1.0,
        tensile or 1.0,
    )

    def safety(cycle: Cycle) -> float:
        loads, shaft = _loads(evidence, cycle)
        moment = bending_moment(loads, shaft, shaft.cam_position)
        return fatigue_safety(cycle.theta, moment, cycle.loads.cam_torque, section)

    worst = worst_case(evidence, safety, at_least=True)
    return Check(
        id="shaft_fatigue",
        title=title,
        demand=worst.value if known else None,
        limit=case.limits.shaft_safety,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "shaft_safety",
            "Goodman, Shigley sec. 7-4; notch of an end-milled key, table 7-1: verify",
            f"{given.material}: {card.source}",
        ),
        method="bending turns through every fibre, torsion of the cam's torque; fatigue notch"
        f" factors {given.notch_bending:g} and {given.notch_torsion:g}",
        must_have=False,
        lift_can_help=True,
        note="" if known else f"the card of {given.material} gives no fatigue or tensile strength",
        **worst.place,
    )


def shaft_bearing_life(evidence: TrialEvidence) -> Check:
    """Rating life of the harder loaded bearing of the camshaft."""
    case, title = evidence.case, "Rating life L10 of the camshaft's bearings"
    given = case.camshaft
    rating = None if given is None else given.bearing_rating
    if given is None or rating is None:
        note = NO_SHAFT if given is None else "no rating of the camshaft's bearings is given"
        return not_described("shaft_bearing_life", title, "h", note, must_have=False)

    def life(cycle: Cycle) -> float:
        loads, _ = _loads(evidence, cycle)
        if not (np.isfinite(loads.load_1).all() and np.isfinite(loads.load_2).all()):
            return float(np.nan)
        spin = np.full(cycle.theta.size, evidence.cam_speed(cycle))
        return min(rating_life(load, spin, rating).hours for load in (loads.load_1, loads.load_2))

    worst = worst_case(evidence, life, at_least=True)
    target = case.limits.shaft_bearing_life
    return Check(
        id="shaft_bearing_life",
        title=title,
        demand=worst.value,
        limit=None if target is None else target / HOURS,
        unit="h",
        sense="at_least",
        source=evidence.source("shaft_bearing_life", "ISO 281", given.source),
        method="(C/P_m)^3 million turns, P_m the cube mean of the bearing's load",
        must_have=False,
        lift_can_help=True,
        note="" if target is not None else "no life of the camshaft's bearings is asked for",
        **worst.place,
    )


def gear_bending(evidence: TrialEvidence) -> Check | None:
    """Bending at the root of the driving teeth; None without a gear."""
    driven = _driven(evidence)
    if driven is None:
        return None
    shaft, gear = driven
    module = 2.0 * shaft.gear_radius / gear.teeth
    clause = f"Lewis (1892); {REVERSED} for a reversed load, ISO 6336-3: verify"

    def stress(cycle: Cycle) -> Array:
        force = _tooth_force(shaft, gear, cycle)
        return tooth_root_stress(force, gear.width, module, gear.teeth)

    worst = greatest(evidence, stress)
    return Check(
        id="gear_bending",
        title="Bending stress of the driving gear's teeth",
        demand=1e-6 * worst.value,
        **_tooth_limit(evidence, gear, "bending", clause, REVERSED),
        method="F K/(b m pi y) at the greatest torque, one tooth bearing all of it at its tip",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def gear_contact(evidence: TrialEvidence) -> Check | None:
    """Hertz's pressure on the flanks of the driving teeth; None without a gear."""
    driven = _driven(evidence)
    if driven is None:
        return None
    shaft, gear = driven
    card = evidence.case.materials[gear.material]
    ratio = max(gear.teeth, gear.pinion_teeth) / min(gear.teeth, gear.pinion_teeth)
    pinion = 2.0 * shaft.gear_radius * min(1.0, gear.pinion_teeth / gear.teeth)
    modulus = contact_modulus(card.E, card.nu, card.E, card.nu)

    def stress(cycle: Cycle) -> Array:
        force = _tooth_force(shaft, gear, cycle)
        angle = shaft.pressure_angle
        return tooth_contact_stress(force, gear.width, pinion, ratio, angle, modulus)

    worst = greatest(evidence, stress)
    return Check(
        id="gear_contact",
        title="Contact pressure of the driving gear's teeth",
        demand=1e-6 * worst.value,
        **_tooth_limit(evidence, gear, "contact", "ISO 6336-2: verify"),
        method="Z_H Z_E sqrt(F K (u + 1)/(b d u)) at the pitch point, at the greatest torque",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def _tooth_limit(
    evidence: TrialEvidence,
    gear: CamshaftGear,
    kind: Literal["bending", "contact"],
    clause: str,
    share: float = 1.0,
) -> dict[str, Any]:
    """A share of what the gear's teeth bear, over the safety asked for, and who says so."""
    limits = evidence.case.limits
    limit, safety = (
        (gear.bending_limit, limits.gear_bending_safety)
        if kind == "bending"
        else (gear.contact_limit, limits.gear_contact_safety)
    )
    return {
        "limit": None if limit is None else 1e-6 * share * limit / safety,
        "unit": "MPa",
        "source": evidence.source(
            f"gear_{kind}_safety", clause, f"{gear.material}: {gear.source}".rstrip(": ")
        ),
        "note": "" if limit is not None else f"no {kind} limit of the gear is given",
    }


def _driven(evidence: TrialEvidence) -> tuple[CaseShaft, CamshaftGear] | None:
    """Camshaft and gear of a case that has both."""
    shaft = evidence.case.camshaft
    return None if shaft is None or shaft.gear is None else (shaft, shaft.gear)


def _tooth_force(shaft: CaseShaft, gear: CamshaftGear, cycle: Cycle) -> Array:
    """Force on the pitch circle (n,), application factor included, N."""
    torque = np.abs(cycle.loads.cam_torque + shaft.drag)
    return np.asarray(gear.application_factor * torque / shaft.gear_radius)


def _loads(evidence: TrialEvidence, cycle: Cycle) -> tuple[ShaftLoads, Camshaft]:
    shaft, loads = Camshaft.of(evidence.case.camshaft), cycle.loads
    speed = evidence.cam_speed(cycle)
    thrown = unbalance_force(evidence.case, evidence.contour, speed, cycle.theta)
    forces = (loads.axial_force, loads.tangential_force, loads.cam_torque)
    return shaft_loads(*forces, shaft, thrown), shaft


CHECKS = (key_shear, shaft_fatigue, shaft_bearing_life, gear_bending, gear_contact)
