"""Limits of the parts around the cam: bush, stem, spring, pin, key, shaft.

A check is left out (None) where a look ahead has no history of the parts; where the case does
not describe a part, it is not evaluated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.case.outer_ring import why_solid
from camwright.pipeline.checks.check import Check, not_described
from camwright.pipeline.checks.extremes import (
    TrialEvidence,
    greatest,
    least,
    rollers_only,
    worst_case,
)
from camwright.pipeline.checks.jump_and_jamming import contact_margin, jam_limit
from camwright.pipeline.cycle.cam_balance import Balance, balance
from camwright.pipeline.follower.bearing_ring import goodman

if TYPE_CHECKING:
    from camwright.pipeline.case.parts_section import Guide
    from camwright.pipeline.cycle.elastic_response import ElasticHistory
    from camwright.pipeline.cycle.part_loads import PartsHistory
    from camwright.pipeline.follower.guide_friction import GuideHeat


def jam_at_worst_friction(evidence: TrialEvidence) -> Check | None:
    """How near the guides are to locking at the greatest friction."""
    parts = evidence.parts
    if parts is None:
        return None
    guides = evidence.case.guides
    bounded = guides.a.friction_max is not None and guides.b.friction_max is not None
    worst = greatest(evidence, lambda cycle: parts[cycle].friction.jam_index_max)
    return Check(
        id="jam_at_worst_friction",
        title="Jam index at the greatest friction",
        demand=worst.value if bounded else None,
        **jam_limit(evidence),
        method="greatest c |tan alpha| on the way out at friction_max of both guides",
        lift_can_help=True,
        note="" if bounded else "no greatest friction is given for both guides",
        **worst.place,
    )


def elastic_contact(evidence: TrialEvidence) -> Check | None:
    """Least contact force with an elastic stem."""
    parts = evidence.parts
    if parts is None:
        return None
    worst = least(
        evidence,
        lambda cycle: parts[cycle].elastic.response.contact_force / evidence.preload(cycle),
    )
    histories = [each.elastic for each in parts.values()]
    methods = "; ".join(dict.fromkeys(history.method for history in histories))
    return Check(
        id="elastic_contact",
        title="Least contact force over preload, elastic stem",
        demand=worst.value,
        **contact_margin(evidence),
        method=f"one mass on the stem's stiffness, free of friction: {methods}",
        must_have=False,
        lift_can_help=True,
        note=_flights(histories),
        **worst.place,
    )


def _flights(histories: list[ElasticHistory]) -> str:
    """How often the contact is lost in a turn, and the highest of the flights."""
    flights = [flight for history in histories for flight in history.flights]
    if not flights:
        return ""
    high = max(flights, key=lambda flight: flight.height)
    jump, landing = (np.degrees(angle) % 360.0 for angle in (high.jump, high.landing))
    force = max(history.force_max for history in histories)
    return (
        f"{len(flights)} losses of contact in a turn; the highest jumps at {jump:.1f} deg and lands"
        f" at {landing:.1f} deg, {1e3 * high.height:.3g} mm up, with {high.landing_speed:.3g} m/s;"
        f" greatest force of impact {force:.4g} N"
    )


def bush_peak_a(evidence: TrialEvidence) -> Check | None:
    """Greatest pressure of the stem in bore A."""
    return _peak(evidence, "A", evidence.case.guides.a, lambda parts: parts.bush_peak_a)


def bush_peak_b(evidence: TrialEvidence) -> Check | None:
    """Greatest pressure of the stem in bore B."""
    return _peak(evidence, "B", evidence.case.guides.b, lambda parts: parts.bush_peak_b)


def _peak(
    evidence: TrialEvidence, side: str, guide: Guide, of: Callable[[PartsHistory], Array]
) -> Check | None:
    parts = evidence.parts
    if parts is None:
        return None
    worst = greatest(evidence, lambda cycle: of(parts[cycle]))
    material = evidence.case.material(guide.material)
    return Check(
        id=f"bush_peak_{side}",
        title=f"Peak pressure at the edge of guide {side}",
        demand=1e-6 * worst.value,
        limit=1e-6 * material.yield_strength,
        unit="MPa",
        source=f"yield strength of {guide.material}: {material.source}",
        method="pin in a hole with clearance, bush in a rigid housing, where the beam's line"
        " pressure is greatest",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def bush_temperature_a(evidence: TrialEvidence) -> Check | None:
    """Temperature of bush A in steady running."""
    return _temperature(evidence, "A", evidence.case.guides.a)


def bush_temperature_b(evidence: TrialEvidence) -> Check | None:
    """Temperature of bush B in steady running."""
    return _temperature(evidence, "B", evidence.case.guides.b)


def _temperature(evidence: TrialEvidence, side: str, guide: Guide) -> Check | None:
    parts = evidence.parts
    if parts is None:
        return None
    material = evidence.case.material(guide.material)
    worst = worst_case(evidence, lambda cycle: _heat(parts[cycle], side).temperature)
    notes = _hottest(evidence, parts.values(), side, worst.value)
    if guide.thermal_resistance is None and material.conductivity is None:
        notes.append("no way of the heat is given")
    if material.temperature_limit is None:
        notes.append(f"no temperature limit of {guide.material} is given")
    return Check(
        id=f"bush_temperature_{side}",
        title=f"Temperature of guide {side}",
        demand=None if np.isnan(worst.value) else worst.value - 273.15,
        limit=None if material.temperature_limit is None else material.temperature_limit - 273.15,
        unit="degC",
        source=f"{guide.material}: {material.source}",
        method="heat of friction through the bush's wall (or the resistance given), an estimate",
        must_have=False,
        lift_can_help=True,
        note="; ".join(notes),
        **worst.place,
    )


def _heat(parts: PartsHistory, side: str) -> GuideHeat:
    return parts.heat_a if side == "A" else parts.heat_b


def _hottest(
    evidence: TrialEvidence, histories: Iterable[PartsHistory], side: str, nominal: float
) -> list[str]:
    """What the temperature (K) becomes at the greatest friction, where it is known and higher."""
    ambient, found = evidence.case.guides.ambient_temperature, []
    for parts in histories:
        heat, worst = _heat(parts, side), parts.friction.greatest
        friction = worst.friction_force_a if side == "A" else worst.friction_force_b
        power = float(np.mean(friction * np.abs(worst.velocity)))
        if heat.mean_power > 0.0:
            found.append(ambient + (heat.temperature - ambient) * power / heat.mean_power)
    hottest = max(found, default=np.nan)
    return [f"{hottest - 273.15:.0f} degC at the greatest friction"] if hottest > nominal else []


@rollers_only
def roller_pin(evidence: TrialEvidence) -> Check | None:
    """Bending of the roller's pin."""
    parts = evidence.parts
    if parts is None:
        return None
    pin, share = evidence.case.roller.pin, evidence.case.limits.pin_share
    if pin is None:
        return not_described(
            "roller_pin",
            "Bending of the roller's pin",
            "MPa",
            "no pin is given",
            must_have=True,
        )
    material = evidence.case.material(pin.material)
    worst = greatest(evidence, lambda cycle: _given(parts[cycle].pin_stress))
    return Check(
        id="roller_pin",
        title="Bending of the roller's pin",
        demand=1e-6 * worst.value,
        limit=1e-6 * share * material.yield_strength,
        unit="MPa",
        source=evidence.source("pin_share", f"{share:g} of the yield strength", material.source),
        method=f"32 M/(pi d^3), {pin.mounting}, the load spread over the bearing",
        lift_can_help=True,
        **worst.place,
    )


@rollers_only
def roller_ring(evidence: TrialEvidence) -> Check | None:
    """Fatigue of the bearing's outer ring, which bends on its balls as it rolls on the cam."""
    parts = evidence.parts
    if parts is None:
        return None
    case, title = evidence.case, "Bending of the roller's outer ring on its balls"
    ring = case.roller.bearing.ring
    solid = why_solid(case)
    if ring is None or solid:
        note = f"{solid}: the contact takes the roller as solid on its hub"
        return not_described("roller_ring", title, "MPa", note, must_have=False)
    strength, tensile = ring.fatigue_bending, ring.tensile_strength
    worst = greatest(evidence, lambda cycle: _ring_amplitude(parts[cycle], tensile))
    missing = [
        f"no {name} of the ring is given"
        for name, value in (("fatigue strength", strength), ("tensile strength", tensile))
        if value is None
    ]
    return Check(
        id="roller_ring",
        title=title,
        demand=None if tensile is None else 1e-6 * worst.value,
        limit=None if strength is None else 1e-6 * strength,
        unit="MPa",
        source=f"fatigue strength in bending; {ring.source}".rstrip("; "),
        method="stress at the groove as the ring turns, finite elements on balls that only push,"
        " all ball positions; its amplitude about no mean stress by Goodman's line",
        must_have=False,
        lift_can_help=True,
        note="; ".join(missing),
        **worst.place,
    )


def _ring_amplitude(parts: PartsHistory, tensile_strength: float | None) -> Array:
    amplitude, mean = _given(parts.ring_amplitude), _given(parts.ring_mean)
    if tensile_strength is None:
        return np.full_like(amplitude, np.nan)
    return goodman(amplitude, mean, tensile_strength)


def key_pressure(evidence: TrialEvidence) -> Check | None:
    """Pressure on the flank of the cam's key."""
    parts = evidence.parts
    if parts is None:
        return None
    if evidence.case.cam.keyway is None:
        return not_described(
            "key_pressure", "Pressure on the key", "MPa", "no keyway is given", must_have=False
        )
    worst = greatest(evidence, lambda cycle: np.abs(_given(parts[cycle].key_pressure)))
    return Check(
        id="key_pressure",
        title="Pressure on the key",
        demand=1e-6 * worst.value,
        limit=1e-6 * evidence.case.limits.key_pressure,
        unit="MPa",
        source=evidence.source("key_pressure", "100 to 150 MPa static, DIN 6892: verify"),
        method="4 T/(d h l) at the greatest cam torque, the key's height twice the keyway's depth",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def bore_pressure(evidence: TrialEvidence) -> Check | None:
    """Mean pressure of the cam's bore on its shaft."""
    parts = evidence.parts
    if parts is None:
        return None
    worst = greatest(evidence, lambda cycle: parts[cycle].bore_pressure)
    return Check(
        id="bore_pressure",
        title="Pressure of the bore on the shaft",
        demand=1e-6 * worst.value,
        limit=1e-6 * evidence.case.limits.bore_pressure,
        unit="MPa",
        source=evidence.source("bore_pressure", "100 MPa as for a key, DIN 6892: verify"),
        method="greatest normal force over bore diameter and cam width",
        must_have=False,
        lift_can_help=True,
        **worst.place,
    )


def torque_reversals(evidence: TrialEvidence) -> Check | None:
    """Whether the gear's and the key's flanks stay together."""
    parts = evidence.parts
    if parts is None:
        return None
    worst = worst_case(evidence, lambda cycle: float(len(parts[cycle].reversals)))
    slopes = [abs(one.slope) for each in parts.values() for one in each.reversals]
    steepest = max(slopes, default=0.0)
    return Check(
        id="torque_reversals",
        title="Reversals of the torque through gear and key in a turn",
        demand=worst.value,
        limit=0.0,
        unit="-",
        source="crossover shock, Rothbart, Cam Design Handbook (2004)",
        method="changes of sign of cam torque and drag",
        must_have=False,
        note=f"backlash is crossed; steepest {steepest:.1f} N m/rad" if worst.value > 0 else "",
        **worst.place,
    )


def cam_unbalance(evidence: TrialEvidence) -> Check | None:
    """Unbalance of the cam as made, and the hole that would take it away."""
    if evidence.parts is None:
        return None
    found = balance(evidence.case, evidence.contour)
    made = found.as_made
    speed = max(evidence.cam_speed(cycle) for cycle in evidence.cycles)
    limit = evidence.case.limits.unbalance
    return Check(
        id="cam_unbalance",
        title="Unbalance of the cam",
        demand=1e3 * made.eccentricity * speed,
        limit=None if limit is None else 1e3 * limit,
        unit="mm/s",
        source=evidence.source("unbalance", "e w of the balance grade, ISO 21940-11: verify"),
        method="exact first moment of the contour's area; bore, keyway and drilled hole taken off",
        must_have=False,
        note=f"{made.force(speed):.1f} N at {np.degrees(made.angle) % 360:.1f} deg of the cam"
        f"{_hole_in_words(found)}",
    )


def _hole_in_words(found: Balance) -> str:
    hole, missed = found.hole, f"; {found.missed}" if found.missed else ""
    if hole is None:
        return missed
    x, y = 1e3 * hole.centre
    share = 1.0 - found.left.product / found.unbalance.product
    does = "takes" if found.drilled else "would take"
    return (
        f"{missed}; a hole of {2e3 * hole.radius:.2f} mm at ({x:.2f}, {y:.2f}) mm"
        f" {does} {share:.0%} of it"
    )


def _given(values: Array | None) -> Array:
    return np.array([np.nan]) if values is None else values


CHECKS = (
    jam_at_worst_friction,
    elastic_contact,
    bush_peak_a,
    bush_peak_b,
    bush_temperature_a,
    bush_temperature_b,
    roller_pin,
    roller_ring,
    key_pressure,
    bore_pressure,
    torque_reversals,
    cam_unbalance,
)
