"""Checks of the camshaft: key shear, fatigue, bearings, driving gear."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import (
    GEAR_BENDING_SAFETY,
    GEAR_CONTACT_SAFETY,
    KEY_SHEAR,
    SHAFT_BEARING_LIFE,
    SHAFT_SAFETY,
)
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import greatest, worst_case
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.cycle.cam_balance import unbalance_force
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    CamshaftGear,
    ShaftLoads,
    key_stress,
    shaft_loads,
)
from camwright.pipeline.follower.roller_motion import rating_life
from camwright.pipeline.follower.shaft_strength import (
    Section,
    bending_moment,
    fatigue_safety,
    tooth_contact_stress,
    tooth_root_stress,
)

NO_SHAFT = "no camshaft is given"
REVERSED = 0.7  # of the bending limit, for reversed torque


@check(
    KEY_SHEAR,
    title="Key shear stress",
    method="2 T/(d b l) at the greatest cam torque",
    must_have=False,
    lift_can_help=True,
)
def key_shear(solution: Solution) -> Demand:
    """Shear stress in the section of the cam's key, Pa."""
    cam = solution.machine.cam
    key = cam.keyway
    if key is None:
        return Demand(None, None, note="no keyway is given")
    diameter, height = 2.0 * cam.bore_radius, 2.0 * key.depth

    def shear(cycle: Cycle) -> Array:
        torque = cycle.loads.cam_torque
        known = np.where(np.isnan(torque), 0.0, torque)
        stress = np.abs(key_stress(known, diameter, key.width, height, cam.width).shear)
        return np.where(np.isnan(torque), np.nan, stress)

    worst = greatest(solution.cycles, shear)
    return Demand(worst.value, solution.machine.limits[KEY_SHEAR], worst)


@check(
    SHAFT_SAFETY,
    id="shaft_fatigue",
    title="Fatigue safety factor of the camshaft at the cam keyway",
    method="rotating bending and torsion of the cam torque",
    must_have=False,
    lift_can_help=True,
)
def shaft_fatigue(solution: Solution) -> Demand:
    """Fatigue safety of the shaft at the cam in bending and torsion."""
    shaft = solution.machine.camshaft
    if shaft is None or shaft.diameter is None or shaft.material is None:
        note = NO_SHAFT if shaft is None else "no diameter or no material of the camshaft is given"
        return Demand(None, None, note=note)
    card = shaft.material
    endurance, tensile = card.fatigue_bending, card.tensile_strength
    known = endurance is not None and tensile is not None
    section = Section(
        shaft.diameter, shaft.notch_bending, shaft.notch_torsion, endurance or 1.0, tensile or 1.0
    )

    def safety(cycle: Cycle) -> float:
        moment = bending_moment(_loads(cycle, shaft), shaft, shaft.cam_position)
        return fatigue_safety(cycle.theta, moment, cycle.loads.cam_torque, section)

    worst = worst_case(solution.cycles, safety, at_least=True)
    return Demand(
        worst.value if known else None,
        solution.machine.limits[SHAFT_SAFETY],
        worst,
        note="" if known else f"the card of {card.name} gives no fatigue or tensile strength",
        figures=(f"{card.name}: {card.source}",),
        method="rotating bending and torsion of the cam torque; fatigue notch factors"
        f" {shaft.notch_bending:g} and {shaft.notch_torsion:g}",
    )


@check(
    SHAFT_BEARING_LIFE,
    title="L10 rating life of the camshaft bearings",
    method="(C/P_m)^3 million turns, P_m the cube mean of the bearing's load",
    must_have=False,
    lift_can_help=True,
)
def shaft_bearing_life(solution: Solution) -> Demand:
    """Rating life of the camshaft bearing with the greater load, s."""
    shaft = solution.machine.camshaft
    rating = None if shaft is None else shaft.bearing_rating
    if shaft is None or rating is None:
        note = NO_SHAFT if shaft is None else "no rating of the camshaft's bearings is given"
        return Demand(None, None, note=note)

    def life(cycle: Cycle) -> float:
        loads = _loads(cycle, shaft)
        both = (loads.load_1, loads.load_2)
        if not all(np.isfinite(load).all() for load in both):
            return float(np.nan)
        spin = np.full(cycle.theta.size, cycle.cam_speed)
        return min(rating_life(load, spin, rating).seconds for load in both)

    worst = worst_case(solution.cycles, life, at_least=True)
    target = solution.machine.limits[SHAFT_BEARING_LIFE]
    return Demand(
        worst.value,
        target,
        worst,
        note="" if target is not None else "no life of the camshaft's bearings is required",
        figures=(shaft.source,),
    )


@check(
    GEAR_BENDING_SAFETY,
    id="gear_bending",
    title="Tooth root bending stress of the driving gear",
    unit="MPa",
    method="F K/(b m pi y) at the greatest torque, load on the tip of one tooth",
    must_have=False,
    lift_can_help=True,
)
def gear_bending(solution: Solution) -> Demand | None:
    """Tooth root bending stress of the driving gear, Pa; None without a gear."""
    shaft = solution.machine.camshaft
    gear = None if shaft is None else shaft.gear
    if shaft is None or gear is None:
        return None
    module = 2.0 * shaft.gear_radius / gear.teeth

    def stress(cycle: Cycle) -> Array:
        return tooth_root_stress(_tooth_force(cycle, shaft, gear), gear.width, module, gear.teeth)

    worst, limit = greatest(solution.cycles, stress), gear.bending_limit
    safety = solution.machine.limits[GEAR_BENDING_SAFETY]
    return Demand(
        worst.value,
        None if limit is None else REVERSED * limit / safety,
        worst,
        note="" if limit is not None else "no bending limit of the gear is given",
        figures=(f"{gear.material.name}: {gear.source}".rstrip(": "),),
    )


@check(
    GEAR_CONTACT_SAFETY,
    id="gear_contact",
    title="Tooth flank contact pressure of the driving gear",
    unit="MPa",
    method="Z_H Z_E sqrt(F K (u + 1)/(b d u)) at the pitch point, at the greatest torque",
    must_have=False,
    lift_can_help=True,
)
def gear_contact(solution: Solution) -> Demand | None:
    """Contact pressure on the tooth flanks of the driving gear, Pa; None without a gear."""
    shaft = solution.machine.camshaft
    gear = None if shaft is None else shaft.gear
    if shaft is None or gear is None:
        return None
    card = gear.material
    ratio = max(gear.teeth, gear.pinion_teeth) / min(gear.teeth, gear.pinion_teeth)
    pinion = 2.0 * shaft.gear_radius * min(1.0, gear.pinion_teeth / gear.teeth)
    modulus = contact_modulus(card.E, card.nu, card.E, card.nu)

    def stress(cycle: Cycle) -> Array:
        force = _tooth_force(cycle, shaft, gear)
        angle = shaft.pressure_angle
        return tooth_contact_stress(force, gear.width, pinion, ratio, angle, modulus)

    worst, limit = greatest(solution.cycles, stress), gear.contact_limit
    safety = solution.machine.limits[GEAR_CONTACT_SAFETY]
    return Demand(
        worst.value,
        None if limit is None else limit / safety,
        worst,
        note="" if limit is not None else "no contact limit of the gear is given",
        figures=(f"{card.name}: {gear.source}".rstrip(": "),),
    )


def _tooth_force(cycle: Cycle, shaft: Camshaft, gear: CamshaftGear) -> Array:
    """Force on the pitch circle (n,), application factor included, N."""
    torque = np.abs(cycle.loads.cam_torque + shaft.drag)
    return np.asarray(gear.application_factor * torque / shaft.gear_radius)


def _loads(cycle: Cycle, shaft: Camshaft) -> ShaftLoads:
    loads, speed = cycle.loads, cycle.cam_speed
    thrown = unbalance_force(cycle.machine.cam, cycle.contour, speed, cycle.theta)
    forces = (loads.axial_force, loads.tangential_force, loads.cam_torque)
    return shaft_loads(*forces, shaft, thrown)
