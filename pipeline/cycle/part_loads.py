"""What guides, stem, spring, roller pin, key and shaft carry over one turn of a load case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.outer_ring import OuterRing
from camwright.pipeline.case.parts_section import Guide
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, Pin
from camwright.pipeline.contact.pin_in_hole import peak_pressure
from camwright.pipeline.cycle.cam_balance import unbalance_force
from camwright.pipeline.cycle.elastic_response import ElasticHistory, elastic_history
from camwright.pipeline.follower.bearing_ring import pin_bending_stress
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    Reversal,
    key_stress,
    shaft_loads,
    torque_reversals,
)
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.follower.guide_effects import GuideShares, guide_shares
from camwright.pipeline.follower.guide_friction import (
    FrictionBounds,
    GuideHeat,
    bush_resistance,
    friction_bounds,
    guide_heat,
)
from camwright.pipeline.follower.guide_reactions import WALL_SHARE, GuidePair
from camwright.pipeline.follower.roller_motion import roller_motion
from camwright.pipeline.follower.spring import HelicalSpring, case_spring, surge_force
from camwright.pipeline.follower.stem_beam import Stem

if TYPE_CHECKING:
    from camwright.pipeline.cycle.turn import Turn


@dataclass(frozen=True, eq=False)
class PartsHistory:
    """One turn; arrays (n,) SI, None where the case does not describe the part.

    bush_peak_* are the pressures of the stem in the bore where the line pressure is greatest.
    shares tell why the guides answer otherwise than point supports.
    ring_amplitude and ring_mean are of the stress along a bearing's outer ring at its groove as
    it turns under the load; ring_correction is the share by which the contact's peak pressure
    changes from a contact over a ball, for which it stands, to one between two balls.
    """

    bush_peak_a: Array
    bush_peak_b: Array
    rubbing_load_a: Array
    rubbing_load_b: Array
    heat_a: GuideHeat
    heat_b: GuideHeat
    friction: FrictionBounds
    viscous_force: Array
    shares: GuideShares
    elastic: ElasticHistory
    reversals: tuple[Reversal, ...]
    bore_pressure: Array
    key_pressure: Array | None
    shaft_bearing_1: Array | None
    shaft_bearing_2: Array | None
    spring_stress: Array | None
    surge_force: Array | None
    pin_stress: Array | None
    roller_spin: Array | None
    roller_spin_acceleration: Array | None
    ring_amplitude: Array | None
    ring_mean: Array | None
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
            "elastic_contact_force": self.elastic.response.contact_force,
            "elastic_deflection": self.elastic.deflection,
            "bore_pressure": self.bore_pressure,
            "key_pressure": self.key_pressure,
            "shaft_bearing_1": self.shaft_bearing_1,
            "shaft_bearing_2": self.shaft_bearing_2,
            "spring_stress": self.spring_stress,
            "spring_surge_force": self.surge_force,
            "pin_stress": self.pin_stress,
            "roller_speed": self.roller_spin,
            "roller_acceleration": self.roller_spin_acceleration,
            "ring_stress_amplitude": self.ring_amplitude,
            "ring_stress_mean": self.ring_mean,
            "ring_correction": self.ring_correction,
        }
        known = {name: values for name, values in found.items() if values is not None}
        return known | dict(self.shares.columns())


def parts_history(
    case: Case,
    contour: Contour,
    given: Turn,
    ring: OuterRing | None = None,
    flights: bool = True,
) -> PartsHistory:
    """All parts of a turn at equal angles, of a case at its load case."""
    loads, guides = given.loads, given.guides
    cam_speed = given.crank_speed / case.mechanism.gear_ratio
    friction, shares = _guided(case, contour, given, cam_speed)
    spring = case_spring(case)
    shaft = _shaft(case, contour, loads, cam_speed)
    amplitude, mean, correction = _ring(case, contour, loads, ring)
    spin, spin_acceleration = _spin(case, contour, loads, cam_speed)
    return PartsHistory(
        bush_peak_a=_bush_peak(case, case.guides.a, guides.line_pressure_max_a),
        bush_peak_b=_bush_peak(case, case.guides.b, guides.line_pressure_max_b),
        rubbing_load_a=guides.rubbing_load_a,
        rubbing_load_b=guides.rubbing_load_b,
        heat_a=_heat(case, case.guides.a, guides.rubbing_load_a, loads.velocity),
        heat_b=_heat(case, case.guides.b, guides.rubbing_load_b, loads.velocity),
        friction=friction,
        viscous_force=loads.viscous_force,
        shares=shares,
        elastic=elastic_history(
            case, contour.pitch.lift, loads.lift, given.cam_speed, flights_too=flights
        ),
        reversals=torque_reversals(loads.theta, loads.cam_torque, _drag(case)),
        bore_pressure=loads.normal_force / (2.0 * case.cam.bore_radius * case.cam.width),
        key_pressure=_key(case, loads),
        shaft_bearing_1=None if shaft is None else shaft[0],
        shaft_bearing_2=None if shaft is None else shaft[1],
        spring_stress=None if spring is None else spring.stress(loads.spring_force),
        surge_force=None if spring is None else _surge(spring, loads, cam_speed),
        pin_stress=_pin(case, loads),
        roller_spin=spin,
        roller_spin_acceleration=spin_acceleration,
        ring_amplitude=amplitude,
        ring_mean=mean,
        ring_correction=correction,
    )


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


def _guided(
    case: Case, contour: Contour, given: Turn, cam_speed: float
) -> tuple[FrictionBounds, GuideShares]:
    """The turn at the bounds of friction, and its guides beside point supports."""
    a, b, pitch = case.guides.a, case.guides.b, contour.pitch
    system, stem, pair = (
        FollowerSystem.from_case(case), Stem.from_case(case), GuidePair.from_case(case)
    )  # fmt: skip
    knots = given.guides.knots_a.size

    def bound(guide: Guide, value: float | None) -> float:
        return guide.friction if value is None else value

    def solved(rubbing: FollowerSystem) -> Loads:
        if rubbing == system:
            return given.loads
        return guided_loads(pitch, rubbing, stem, pair, cam_speed, given.theta, knots).loads

    least = (bound(a, a.friction_min), bound(b, b.friction_min))
    greatest = (bound(a, a.friction_max), bound(b, b.friction_max))
    return (
        friction_bounds(solved, system, least, greatest),
        guide_shares(pitch, system, stem, pair, cam_speed, given.loads, given.guides),
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


def _shaft(
    case: Case, contour: Contour, loads: Loads, cam_speed: float
) -> tuple[Array, Array] | None:
    given = case.camshaft
    if given is None:
        return None
    thrown = unbalance_force(case, contour, cam_speed, loads.theta)
    found = shaft_loads(
        loads.axial_force,
        loads.tangential_force,
        loads.cam_torque,
        Camshaft.of(given),
        thrown,
    )
    return found.load_1, found.load_2


def _surge(spring: HelicalSpring, loads: Loads, cam_speed: float) -> Array:
    return surge_force(loads.lift, cam_speed, spring.rate, spring.surge_frequency)


def _pin(case: Case, loads: Loads) -> Array | None:
    per_newton = pin_stress_per_newton(case)
    return None if per_newton is None else per_newton * loads.normal_force


def pin_stress_per_newton(case: Case) -> float | None:
    """Bending of the roller's pin under a newton of contact force, Pa; None without a pin."""
    pin = None if case.roller_given is None else case.roller.pin
    if pin is None:
        return None
    overhung = pin.mounting == "overhung"
    return float(pin_bending_stress(1.0, pin.diameter, case.roller.width, pin.span, overhung))


def _spin(
    case: Case, contour: Contour, loads: Loads, cam_speed: float
) -> tuple[Array | None, Array | None]:
    """Speed and acceleration of a roller that does not slip, against the follower."""
    if case.roller_given is None:
        return None, None
    rolling = contour.require_roller()
    motion = roller_motion(rolling.pitch, rolling.roller_radius, cam_speed, loads.theta)
    return motion.spin, motion.spin_acceleration


def _ring(
    case: Case, contour: Contour, loads: Loads, ring: OuterRing | None
) -> tuple[Array | None, Array | None, Array | None]:
    if ring is None:
        return None, None, None
    force, curvature = loads.normal_force, contour.curvature(loads.theta)
    radius = 1.0 / (1.0 / case.roller.radius + curvature)
    bending = ring.bending
    return (
        bending.stress_amplitude * force,
        bending.stress_mean * force,
        ring.midway(np.maximum(force, 0.0) / ring.body.width, radius),
    )
