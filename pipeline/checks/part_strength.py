"""Checks of the parts at the cam: roller pin, outer ring, bore, unbalance."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    BORE_SHARE,
    PIN_SHARE,
    UNBALANCE,
    LimitValues,
)
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import greatest, worst_case
from camwright.pipeline.cycle.cam_balance import Balance, balance, rotor_unbalance
from camwright.pipeline.cycle.part_loads import PartLoads
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.bearing_ring import goodman
from camwright.pipeline.follower.roller_parts import Pin


@check(
    PIN_SHARE,
    id="roller_pin",
    title="Bending stress of the roller pin",
    unit="MPa",
    method="32 M/(pi d^3), load uniform over the bearing width",
    lift_can_help=True,
    needs="roller",
)
def roller_pin(solution: Solution) -> Demand:
    """Bending stress of the roller pin, Pa."""
    roller = solution.machine.roller
    pin = None if roller is None else roller.pin
    if pin is None:
        return Demand(None, None, note="no pin is given")
    worst = greatest(solution.cycles, lambda cycle: _known(cycle.parts.pin_stress))
    return Demand(
        worst.value,
        allowed_pin_stress(pin, solution.machine.limits),
        worst,
        figures=(f"{pin.material.name}: {pin.material.source}",),
        method=f"32 M/(pi d^3), {pin.mounting}, load uniform over the bearing width",
    )


def allowed_pin_stress(pin: Pin, limits: LimitValues) -> float:
    """Maximum bending stress of the roller pin, Pa."""
    return limits[PIN_SHARE] * pin.material.yield_strength


@check(
    id="roller_ring_fatigue",
    title="Bending fatigue of the roller's outer ring",
    unit="MPa",
    source="fatigue strength in bending",
    method="stress at the groove of the turning ring, finite elements on balls without tension, all"
    " ball positions; amplitude reduced to zero mean stress by the Goodman line",
    must_have=False,
    lift_can_help=True,
    needs="roller",
)
def roller_ring_fatigue(solution: Solution) -> Demand:
    """Stress amplitude of the outer ring rolling on the cam, Pa."""
    roller = solution.machine.roller
    ring = None if roller is None else roller.bearing.ring
    if roller is None or ring is None or roller.solid_reason:
        reason = "there is no roller" if roller is None else roller.solid_reason
        return Demand(None, None, note=f"{reason}: the roller is modelled as solid on its hub")
    tensile = ring.tensile_strength
    worst = greatest(solution.cycles, lambda cycle: _ring_amplitude(cycle.parts, tensile))
    missing = [
        f"no {name} of the ring is given"
        for name, value in (
            ("fatigue strength", ring.fatigue_bending),
            ("tensile strength", tensile),
        )
        if value is None
    ]
    return Demand(
        None if tensile is None else worst.value,
        ring.fatigue_bending,
        worst,
        note="; ".join(missing),
        figures=(ring.source,),
    )


def _ring_amplitude(parts: PartLoads, tensile_strength: float | None) -> Array:
    amplitude, mean = _known(parts.ring_amplitude), _known(parts.ring_mean)
    if tensile_strength is None:
        return np.full_like(amplitude, np.nan)
    return goodman(amplitude, mean, tensile_strength)


@check(
    BORE_SHARE,
    id="bore_pressure",
    title="Mean bore pressure on the camshaft",
    unit="MPa",
    method="greatest normal force over bore diameter and cam width",
    lift_can_help=True,
    formula="F_n/(d b) <= limits.bore_share R_m; F_n: greatest normal force over all load cases and"
    " angles, d: bore diameter, b: cam width, R_m: lower tensile strength of cam and camshaft",
    reason="must-have: a widened bore loosens the cam on its shaft",
)
def bore_pressure(solution: Solution) -> Demand:
    """Mean pressure of the bore on the shaft, Pa."""
    machine = solution.machine
    worst = greatest(solution.cycles, lambda cycle: cycle.parts.bore_pressure)
    shaft = machine.camshaft
    cards = [machine.cam.material]
    missing = []
    if machine.scope.covers("camshaft"):
        card = None if shaft is None else shaft.material
        cards += [] if card is None else [card]
        missing += ["no material of the camshaft is given"] if card is None else []
    known = [card.tensile_strength for card in cards if card.tensile_strength is not None]
    missing += [
        f"the card of {card.name} gives no tensile strength"
        for card in cards
        if card.tensile_strength is None
    ]
    return Demand(
        worst.value,
        None if missing else machine.limits[BORE_SHARE] * min(known),
        worst,
        note="; ".join(missing),
        figures=tuple(dict.fromkeys(f"{card.name}: {card.source}" for card in cards)),
    )


@check(
    title="Torque reversals per turn at gear and key",
    unit="-",
    source="crossover shock, Rothbart, Cam Design Handbook (2004)",
    method="sign changes of cam torque plus drag",
    must_have=False,
    formula="n <= 0; n: sign changes of T + drag over the turn, greatest over the load cases",
    reason="not a must-have: the torque of a balancing cam reverses by its purpose; the effects"
    " decide: key_pressure, key_shear, cam_slip, gear_bending, pinion_bending",
)
def torque_reversals(solution: Solution) -> Demand:
    """Number of torque reversals at gear and key per turn."""
    worst = worst_case(solution.cycles, lambda cycle: float(len(cycle.parts.reversals)))
    slopes = [abs(one.slope) for cycle in solution.cycles for one in cycle.parts.reversals]
    steepest = max(slopes, default=0.0)
    note = f"backlash is crossed; steepest {steepest:.1f} N m/rad" if worst.value > 0 else ""
    return Demand(worst.value, 0.0, worst, note=note)


@check(
    UNBALANCE,
    id="cam_unbalance",
    title="Unbalance of the camshaft with its cam",
    method="exact first moment of the area of the contour less bore, keyway and counter-hole",
    moved_by_tolerance=False,
    formula="e w <= limits.unbalance; e = U/m, U: unbalance of cam and counterweight, m:"
    " camshaft.rotor_mass, or the mass of the cam alone, w: greatest cam speed of all load cases",
    reason="must-have: the force m e w^2 loads shaft, bearings and frame at every speed",
)
def cam_unbalance(solution: Solution) -> Demand:
    """Eccentricity times speed of the rotor, m/s, and the counter-hole for it."""
    balanced, shaft = balance(solution.machine.cam, solution.contour), solution.machine.camshaft
    made, speed = balanced.as_made, max(machine.cam_speed for machine in solution.machines)
    rotor = made.mass if shaft is None else max(made.mass, shaft.rotor_mass or 0.0)
    angle = f"{np.degrees(made.angle) % 360:.1f} deg"
    whole = "cam alone" if rotor == made.mass else "cam, shaft and gear"
    return Demand(
        rotor_unbalance(made, shaft) / rotor * speed,
        solution.machine.limits[UNBALANCE],
        note=f"{made.force(speed):.1f} N at {angle} of the cam; mass of {whole},"
        f" {shown(rotor, 'g')}{_hole(balanced)}",
    )


def _hole(balanced: Balance) -> str:
    """The counter-hole in words."""
    hole, missed = balanced.hole, f"; {balanced.missed}" if balanced.missed else ""
    if hole is None:
        return missed
    x, y = (shown(round(float(each), 9), "mm", 4) for each in hole.centre)
    share = 1.0 - balanced.left.product / balanced.unbalance.product
    removes = "removes" if balanced.drilled else "would remove"
    diameter = shown(2.0 * hole.radius, "mm", 4)
    return f"{missed}; a hole of {diameter} at ({x}, {y}) {removes} {share:.0%} of it"


def _known(values: Array | None) -> Array:
    return np.array([np.nan]) if values is None else values
