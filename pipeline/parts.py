"""What guides, stem, spring, roller pin, key and shaft carry over one turn of a load case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array, freeze
from geometry.contour import Contour
from pipeline.case import Case
from pipeline.contact.harmonics import Bush, Pin
from pipeline.contact.pin_in_hole import peak_pressure
from pipeline.follower.bearing_cards import read_cards
from pipeline.follower.cam_body import Camshaft, Reversal, key_stress, shaft_loads, torque_reversals
from pipeline.follower.dynamics import (
    ElasticFollower,
    Flight,
    Response,
    bounce,
    harmonic_response,
)
from pipeline.follower.forces import FollowerSystem, Loads
from pipeline.follower.friction import (
    FrictionBounds,
    GuideHeat,
    bush_resistance,
    friction_bounds,
    guide_heat,
)
from pipeline.follower.guides import WALL_SHARE, GuideReactions
from pipeline.follower.ring import (
    Ring,
    ball_stiffness,
    flattening,
    pin_bending_stress,
    ring_bending,
)
from pipeline.follower.spring import HelicalSpring, case_spring, surge_force
from pipeline.follower.stem import Stem
from pipeline.part_fields import Guide

BOUNCE_TURNS = 1.0


@dataclass(frozen=True, eq=False)
class PartsHistory:
    """One turn; arrays (n,) SI, None where the case does not describe the part.

    bush_peak_* are the pressures of the stem in the bore where the line pressure is greatest.
    elastic is the stem's steady response with the contact held; flights the losses of contact
    in one turn from there, where it does not hold, and bounce_force the greatest force of it.
    ring_correction is the share by which a flattened outer ring changes the peak pressure.
    """

    bush_peak_a: Array
    bush_peak_b: Array
    rubbing_load_a: Array
    rubbing_load_b: Array
    heat_a: GuideHeat
    heat_b: GuideHeat
    friction: FrictionBounds
    viscous_force: Array
    elastic: Response
    elastic_deflection: Array
    flights: tuple[Flight, ...]
    bounce_force: float
    reversals: tuple[Reversal, ...]
    bore_pressure: Array
    key_pressure: Array | None
    shaft_bearing_1: Array | None
    shaft_bearing_2: Array | None
    spring_stress: Array | None
    surge_force: Array | None
    pin_stress: Array | None
    ring_stress: Array | None
    ring_correction: Array | None

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if isinstance(getattr(self, name), np.ndarray):
                freeze(self, **{name: getattr(self, name)})

    def columns(self) -> Mapping[str, Array]:
        """SI values by the names of the columns of ``5_cycle.csv``."""
        found = {
            "bush_peak_A": self.bush_peak_a,
            "bush_peak_B": self.bush_peak_b,
            "rubbing_load_A": self.rubbing_load_a,
            "rubbing_load_B": self.rubbing_load_b,
            "friction_heat_A": self.heat_a.power,
            "friction_heat_B": self.heat_b.power,
            "viscous_force": self.viscous_force,
            "normal_force_friction_min": self.friction.normal_force_min,
            "normal_force_friction_max": self.friction.normal_force_max,
            "jam_index_friction_max": self.friction.jam_index_max,
            "elastic_contact_force": self.elastic.contact_force,
            "elastic_deflection": self.elastic_deflection,
            "bore_pressure": self.bore_pressure,
            "key_pressure": self.key_pressure,
            "shaft_bearing_1": self.shaft_bearing_1,
            "shaft_bearing_2": self.shaft_bearing_2,
            "spring_stress": self.spring_stress,
            "spring_surge_force": self.surge_force,
            "pin_stress": self.pin_stress,
            "ring_stress_range": self.ring_stress,
            "ring_correction": self.ring_correction,
        }
        return {name: values for name, values in found.items() if values is not None}


def parts_history(
    case: Case, contour: Contour, loads: Loads, guides: GuideReactions, cam_speed: float
) -> PartsHistory:
    """All parts of a turn whose loads and guide reactions are known, at equal angles."""
    elastic, deflection, flights, force = _elastic(case, contour, loads, cam_speed)
    spring = case_spring(case)
    shaft = _shaft(case, loads)
    ring = _ring(case, contour, loads)
    return PartsHistory(
        bush_peak_a=_bush_peak(case, case.guides.a, guides.line_pressure_max_a),
        bush_peak_b=_bush_peak(case, case.guides.b, guides.line_pressure_max_b),
        rubbing_load_a=guides.rubbing_load_a,
        rubbing_load_b=guides.rubbing_load_b,
        heat_a=_heat(case, case.guides.a, guides.rubbing_load_a, loads.velocity),
        heat_b=_heat(case, case.guides.b, guides.rubbing_load_b, loads.velocity),
        friction=_friction(case, contour, loads, cam_speed),
        viscous_force=loads.viscous_force,
        elastic=elastic,
        elastic_deflection=deflection,
        flights=flights,
        bounce_force=force,
        reversals=torque_reversals(loads.theta, loads.cam_torque, _drag(case)),
        bore_pressure=loads.normal_force / (2.0 * case.cam.bore_radius * case.cam.width),
        key_pressure=_key(case, loads),
        shaft_bearing_1=None if shaft is None else shaft[0],
        shaft_bearing_2=None if shaft is None else shaft[1],
        spring_stress=None if spring is None else spring.stress(loads.spring_force),
        surge_force=None if spring is None else _surge(spring, loads, cam_speed),
        pin_stress=_pin(case, loads),
        ring_stress=None if ring is None else ring[0],
        ring_correction=None if ring is None else ring[1],
    )


def elastic_follower(case: Case) -> ElasticFollower:
    """The follower on its stem: a stiffness given, or E A/l of the stem up to guide B."""
    given, stem = case.follower, Stem.from_case(case)
    length = given.overhang_at_max_lift + case.guides.spacing
    stiffness = given.stiffness
    if stiffness is None:
        stiffness = stem.elastic_modulus * 0.25 * np.pi * stem.diameter**2 / length
    return ElasticFollower.with_damping_ratio(
        given.mass, stiffness, case.spring.rate, case.spring.preload, given.damping_ratio
    )


def _elastic(
    case: Case, contour: Contour, loads: Loads, cam_speed: float
) -> tuple[Response, Array, tuple[Flight, ...], float]:
    follower = elastic_follower(case)
    response = harmonic_response(loads.lift, cam_speed, follower)
    deflection = loads.lift - response.position
    force = float(response.contact_force.max())
    if not response.lost:
        return response, deflection, (), force
    start = (float(response.position[0]), float(response.velocity[0]))
    jump = bounce(contour.pitch.lift, cam_speed, follower, BOUNCE_TURNS, start)
    return response, deflection, jump.flights, float(jump.contact_force.max())


def bush_pair(case: Case, guide: Guide) -> tuple[Pin, Bush]:
    """Stem and bore of a guide as the bodies of a pin in a hole."""
    stem, bush = case.material(case.follower.stem_material), case.material(guide.material)
    return Pin(stem.E, stem.nu), Bush(bush.E, bush.nu, 2.0 * WALL_SHARE)


def _bush_peak(case: Case, guide: Guide, line_pressure: Array) -> Array:
    radius, clearance = 0.5 * case.follower.stem_diameter, 0.5 * guide.clearance
    peak, _ = peak_pressure(line_pressure, radius, clearance, *bush_pair(case, guide))
    return peak


def _heat(case: Case, guide: Guide, rubbing: Array, velocity: Array) -> GuideHeat:
    resistance, conductivity = guide.thermal_resistance, case.material(guide.material).conductivity
    if resistance is None and conductivity is not None:
        resistance = bush_resistance(guide.diameter, guide.length, conductivity)
    ambient = case.guides.ambient_temperature
    return guide_heat(rubbing, velocity, guide.friction, resistance, ambient)


def _friction(case: Case, contour: Contour, loads: Loads, cam_speed: float) -> FrictionBounds:
    a, b = case.guides.a, case.guides.b

    def bound(guide: Guide, value: float | None) -> float:
        return guide.friction if value is None else value

    return friction_bounds(
        contour.pitch,
        FollowerSystem.from_case(case),
        (bound(a, a.friction_min), bound(b, b.friction_min)),
        (bound(a, a.friction_max), bound(b, b.friction_max)),
        cam_speed,
        loads.theta,
    )


def _drag(case: Case) -> float:
    return 0.0 if case.camshaft is None else case.camshaft.drag


def _key(case: Case, loads: Loads) -> Array | None:
    """Pressure on the flank in the cam: the keyway's depth is half the key's height."""
    key = case.cam.keyway
    if key is None:
        return None
    diameter = 2.0 * case.cam.bore_radius
    return key_stress(
        loads.cam_torque, diameter, key.width, 2.0 * key.depth, case.cam.width
    ).pressure


def _shaft(case: Case, loads: Loads) -> tuple[Array, Array] | None:
    given = case.camshaft
    if given is None:
        return None
    shaft = Camshaft(
        given.bearing_spacing,
        given.cam_position,
        given.gear_position,
        given.gear_radius,
        given.mesh_angle,
        given.pressure_angle,
    )
    found = shaft_loads(loads.axial_force, loads.tangential_force, loads.cam_torque, shaft)
    return found.load_1, found.load_2


def _surge(spring: HelicalSpring, loads: Loads, cam_speed: float) -> Array:
    return surge_force(loads.lift, cam_speed, spring.rate, spring.surge_frequency)


def _pin(case: Case, loads: Loads) -> Array | None:
    pin = case.roller.pin
    if pin is None:
        return None
    overhung = pin.mounting == "overhung"
    per_newton = pin_bending_stress(1.0, pin.diameter, case.roller.width, pin.span, overhung)
    return per_newton * loads.normal_force


def _ring(case: Case, contour: Contour, loads: Loads) -> tuple[Array, Array] | None:
    """Range of the bending stress in the outer ring of a bearing taken from a card, Pa; and the
    share by which its flattening under the push changes the contact's greatest pressure, <= 0.
    """
    name, force = case.roller.bearing.card, float(loads.normal_force.max())
    if name is None or not force > 0.0:
        return None
    card, steel = read_cards()[name], case.material(case.roller.material)
    # Between the raceways: what the section leaves beside both rings, near enough for the balls.
    ball = 0.5 * (card.outer_diameter - card.bore) - 2.0 * card.ring_thickness
    ring = Ring(
        radius=0.5 * (card.outer_diameter - card.ring_thickness),
        thickness=card.ring_thickness,
        width=card.width,
        modulus=steel.E,
        balls=card.balls,
        ball_stiffness=ball_stiffness(force, ball, steel.E, steel.nu),
    )
    bending = ring_bending(ring)
    curvature = 1.0 / case.roller.radius + contour.curvature(loads.theta)
    return (
        bending.stress_range(ring, 1.0) * loads.normal_force,
        flattening(ring, bending, loads.normal_force, curvature),
    )
