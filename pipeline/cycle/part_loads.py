"""Loads of guides, stem, spring, roller pin, key and shaft over one turn of a load case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value, freeze
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.second_track import relative_radius
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.pin_in_hole import peak_pressure
from camwright.pipeline.cycle.cam_balance import camshaft_loads
from camwright.pipeline.cycle.elastic_response import ElasticHistory
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.follower.camshaft_loads import (
    Reversal,
    ShaftLoads,
    key_stress,
    torque_reversals,
)
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.follower_tilt import couple_of_second
from camwright.pipeline.follower.guide_friction import (
    FrictionBounds,
    friction_power,
)
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.follower.pivot_bush import PressedBush, bush_lines, pressed_bush
from camwright.pipeline.follower.ring_on_balls import RingOnBalls
from camwright.pipeline.follower.roller import on_second_track
from camwright.pipeline.follower.spring import end_travel, lever, surge_force
from camwright.pipeline.follower.wound_wire import natural_frequency


@dataclass(frozen=True, eq=False, repr=False)
class PartLoads(Displayed):
    """Loads of the parts over one turn; arrays (n,), SI, None for a part not described.

    guide_edge_pressure_* are the pressures of the stem in the bore where its line load is greatest;
    heat_* is the friction power of the guides, heat_max_* that at the greatest friction of both,
    NaN where the follower locks at it.
    pivot_edge_pressure is that of the pin in the bush of an arm's pivot where its line load is
    greatest, pivot_rubbing and pivot_bearing are as of `BushLoad`.
    ring_amplitude and ring_mean are of the stress in the groove of the bearing's outer ring, which
    rotates under the load; ring_correction is the relative change of the maximum contact pressure
    from a contact over a ball, as solved, to one between two balls.
    """

    guide_edge_pressure_a: Array
    guide_edge_pressure_b: Array
    heat_a: Array
    heat_b: Array
    heat_max_a: Array
    heat_max_b: Array
    friction: FrictionBounds
    viscous_force: Array
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
    pivot_edge_pressure: Array | None = None
    pivot_rubbing: Array | None = None
    pivot_bearing: Array | None = None

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if isinstance(getattr(self, name), np.ndarray):
                freeze(self, **{name: getattr(self, name)})

    def columns(self, elastic: ElasticHistory) -> dict[Column, Array]:
        """Columns of ``5_cycle.csv`` for the parts of the machine."""
        friction = self.friction
        columns = {
            Column(
                "guide_edge_pressure_A", "MPa", "Maximum pressure of the stem in guide A"
            ): self.guide_edge_pressure_a,
            Column(
                "guide_edge_pressure_B", "MPa", "Maximum pressure of the stem in guide B"
            ): self.guide_edge_pressure_b,
            Column(
                "pivot_edge_pressure", "MPa", "Maximum pressure of the pin in the bush of the pivot"
            ): self.pivot_edge_pressure,
            Column(
                "pivot_rubbing_load",
                "N",
                "Pushes on both sides of the bush of the pivot, load of needles",
            ): self.pivot_rubbing,
            Column("guide_friction_power_A", "W", "Friction power of guide A"): self.heat_a,
            Column("guide_friction_power_B", "W", "Friction power of guide B"): self.heat_b,
            Column("viscous_force", "N", "Viscous drag on the follower"): self.viscous_force,
            Column(
                "normal_force_friction_min", "N", "Normal force at minimum guide friction"
            ): friction.normal_force_min,
            Column(
                "normal_force_friction_max",
                "N",
                "Normal force at maximum guide friction; unknown where the follower locks",
                unknown=True,
            ): friction.normal_force_max,
            Column(
                "jam_index_friction_max", "", "Jam index at maximum guide friction, rise"
            ): friction.jam_index_max,
            Column(
                "contact_force_elastic_stem", "N", "Contact force with an elastic follower"
            ): elastic.response.contact_force,
            Column(
                "stem_shortening", "um", "Shortening of bearing, pin, fork, stem and camshaft"
            ): elastic.deflection,
            Column(
                "bore_pressure", "MPa", "Normal force over projected area of the cam bore"
            ): self.bore_pressure,
            Column("key_pressure", "MPa", "Pressure on the flank of the key"): self.key_pressure,
            Column("shaft_bearing_load_1", "N", "Load on camshaft bearing 1"): self.shaft_bearing_1,
            Column("shaft_bearing_load_2", "N", "Load on camshaft bearing 2"): self.shaft_bearing_2,
            Column("spring_stress", "MPa", "Shear stress of the spring wire"): self.spring_stress,
            Column(
                "spring_surge_force", "N", "Change of the spring force on the follower by surge"
            ): self.surge_force,
            Column("pin_stress", "MPa", "Bending stress of the roller pin"): self.pin_stress,
            Column("roller_speed", "rpm", "Rotational speed of the roller"): self.roller_spin,
            Column(
                "roller_acceleration", "rad/s^2", "Angular acceleration of the roller"
            ): self.roller_spin_acceleration,
            Column(
                "ring_stress_amplitude",
                "MPa",
                "Stress amplitude of the bearing's outer ring",
                unknown=True,
            ): self.ring_amplitude,
            Column(
                "ring_stress_mean",
                "MPa",
                "Mean stress of the bearing's outer ring",
                unknown=True,
            ): self.ring_mean,
            Column(
                "p0_change_between_balls",
                "percent",
                "Change of the maximum contact pressure from over a ball to between two balls",
                unknown=True,
            ): self.ring_correction,
        }
        return {column: values for column, values in columns.items() if values is not None}


def part_loads(
    turn: Turn,
    contour: Contour,
    contact_width: float,
    shaft: ShaftLoads | None,
    guide_lines: tuple[Array, Array],
    hot: tuple[Array, Array],
    moment: Array,
) -> PartLoads:
    """Loads of all parts over a turn.

    Parameters
    ----------
    shaft : ShaftLoads      of the turn; None without a camshaft
    contact_width : float   of the line contact, m
    guide_lines : pair      greatest line loads in guides A and B (n,), N/m
    hot : pair              friction forces of guides A and B at maximum friction (n,), N
    moment : array (n,)     of the contact about the middle of the follower, N m
    """
    machine, loads, guides = turn.machine, turn.loads, turn.guides
    friction = turn.friction
    spring = machine.spring.design
    amplitude, mean, correction = _ring(machine, contour, loads, contact_width)
    motion = machine.follower.rolling(contour, loads, machine.cam_speed)
    pair = machine.guides
    nominal, worst = machine.guide_friction.nominal, friction.greatest
    bush = BushLoad.of(machine, loads, moment)
    pivot = PivotPush.of(machine, loads, moment)
    locked = np.where(worst.bounded, np.nan, 0.0)
    return PartLoads(
        guide_edge_pressure_a=edge_pressure_of(machine, pair.a)(guide_lines[0]),
        guide_edge_pressure_b=edge_pressure_of(machine, pair.b)(guide_lines[1]),
        heat_a=friction_power(nominal[0] * guides.rubbing_load_a, loads.velocity),
        heat_b=friction_power(nominal[1] * guides.rubbing_load_b, loads.velocity),
        heat_max_a=locked + friction_power(hot[0], worst.velocity),
        heat_max_b=locked + friction_power(hot[1], worst.velocity),
        friction=friction,
        viscous_force=loads.viscous_force,
        reversals=torque_reversals(
            loads.theta,
            loads.cam_torque,
            0.0 if machine.camshaft is None else machine.camshaft.drag,
        ),
        bore_pressure=loads.normal_force / (2.0 * machine.cam.bore_radius * machine.cam.width),
        key_pressure=_key_pressure(machine, loads),
        shaft_bearing_1=None if shaft is None else shaft.load_1,
        shaft_bearing_2=None if shaft is None else shaft.load_2,
        spring_stress=None if spring is None else spring.stress(_own_force(machine, loads)),
        surge_force=spring_surge(machine, loads.lift),
        pin_stress=machine.follower.pin_stress(
            loads.normal_force, moment + beside_first(machine, loads)
        ),
        roller_spin=None if motion is None else motion.spin,
        roller_spin_acceleration=None if motion is None else motion.spin_acceleration,
        ring_amplitude=amplitude,
        ring_mean=mean,
        ring_correction=correction,
        pivot_edge_pressure=None if pivot is None else pivot.edge_pressure,
        pivot_rubbing=_rubbing(machine, loads) if bush is None else bush.rubbing,
        pivot_bearing=None if bush is None else bush.bearing,
    )


def _rubbing(machine: Machine, loads: Loads) -> Array | None:
    """Load of the needles of a pivot (n,), N; None without a pivot."""
    return None if machine.pivot is None else np.hypot(*loads.pivot_load)


def beyond_first(machine: Machine, loads: Loads) -> Array:
    """Distance (n,), m, by which the roller that carries is farther into a groove than the first,
    on the same pin; 0 of one roller.
    """
    second = machine.cam.on_pin
    if second is None:
        return np.zeros(loads.theta.size)
    return np.where(loads.wall < 0.0, second.beyond(machine.roller.radius), 0.0)


def beside_first(machine: Machine, loads: Loads) -> Array:
    """Moment (n,), N m, of the roller that carries about the middle of the first on a pin."""
    return couple_of_second(loads.normal_force, beyond_first(machine, loads))


@dataclass(frozen=True, eq=False)
class BushLoad:
    """Load of an arm on the bush of its pivot (..., n), in the plane of the contact normal and
    beside.

    force, couple: in that plane, N and N m, >= 0; beside: line load across it, N/m.
    """

    bush: Guide
    force: Array
    couple: Array
    beside: Array

    @classmethod
    def of(cls, machine: Machine, loads: Loads, moment: Array) -> BushLoad | None:
        """Load of the bush over a turn, by the forces of the turn; None without one.

        moment : array (n,)   of the contact about the middle of the follower, N m
        """
        if machine.arm is None or machine.pivot is None or machine.pivot.bush is None:
            return None
        offset, spacing = machine.arm.plane_offset, machine.cam.spacing
        forces = (np.maximum(loads.normal_force, 0.0),) if spacing is None else loads.track_forces
        beside = beside_middle(offset, spacing, forces) + beside_first(machine, loads)
        normal = loads.pressure_angle - loads.turned
        return cls.under(machine.pivot.bush, loads.pivot_load, normal, moment + beside)

    @classmethod
    def under(cls, bush: Guide, load: Array, normal: Array, couple: Array) -> BushLoad:
        """Load of a bush.

        Parameters
        ----------
        load : array (2, ..., n)   of the pivot, along the travel of the follower and across it, N
        normal : array (..., n)    angle of the contact normal from the travel, rad
        couple : array (..., n)    in the plane of the contact normal, N m
        """
        cos, sin = np.cos(normal), np.sin(normal)
        along, across = load
        pressed, aside = along * cos + across * sin, across * cos - along * sin
        return cls(bush, np.abs(pressed), couple, aside / bush.length)

    @cached_property
    def pressed(self) -> PressedBush:
        """Pin in the bush, in the plane of the contact normal."""
        return pressed_bush(self.bush, self.force, self.couple)

    @property
    def bearing(self) -> Array:
        """Load (..., n), N, on the more loaded side of the bush over the loaded share of its
        length: half of the greatest line load where that side is not loaded over the whole length.
        """
        length = self.bush.length
        half = 0.5 * length * self.pressed.line_load
        return np.hypot(np.maximum(self.force, half), length * self.beside)

    @property
    def rubbing(self) -> Array:
        """Pushes on both sides of the bush together (..., n), N: the integral of the line load."""
        length, beside = self.bush.length, np.abs(self.beside)
        tilt, end, reach, beyond = self.pressed
        slope = self.bush.foundation_modulus * tilt
        pushes = (length - reach - beyond) * beside
        for side, least in ((reach, end - slope * reach), (beyond, 0.0 * end)):
            for at, weight in zip(*_ON_A_SIDE, strict=True):
                pushes = pushes + weight * side * np.hypot(least + at * slope * side, beside)
        return np.asarray(pushes)


_ON_A_SIDE = tuple(0.5 * (shift + each) for shift, each in zip(
    (1.0, 0.0), np.polynomial.legendre.leggauss(8), strict=True
))  # fmt: skip
"""Places along a loaded side of a bush, over its length, and their weights, of its mean."""


class PivotPush(NamedTuple):
    """Load of the pin of a pivot in its bush (n,), see `BushLoad`."""

    bush: Guide
    pin: SolidBar
    force: Array
    couple: Array
    beside: Array

    @classmethod
    def of(cls, machine: Machine, loads: Loads, moment: Array) -> PivotPush | None:
        """Load of the pin over a turn; None without a bush, or the material of the pin."""
        load, pivot = BushLoad.of(machine, loads, moment), machine.pivot
        if load is None or pivot is None or pivot.bush is None or pivot.pin_material is None:
            return None
        return cls.under(pivot.bush, pivot.pin_material, load)

    @classmethod
    def under(cls, bush: Guide, card: Material, load: BushLoad) -> PivotPush:
        """Load of a pin of a material, of that of its bush."""
        return cls(bush, SolidBar(card.E, card.nu), load.force, load.couple, load.beside)

    @property
    def size(self) -> Array:
        """Load of the pin (n,), N."""
        return np.hypot(self.force, self.beside * self.bush.length)

    @property
    def edge_pressure(self) -> Array:
        """Greatest pressure (n,) between pin and bush, Pa, by the slices of a rigid pin."""
        pressed = pressed_bush(self.bush, self.force, self.couple)
        load = np.hypot(pressed.line_load, self.beside)
        return _in_bore(self.pin, self.bush, self.bush.diameter)(load)

    def lines(self, places: Array) -> Array:
        """Line load (k, n), N/m, at places (k,), m, towards the end that the couple presses.

        Of the plane of the couple and of that across it together; negative where the couple
        presses the pin against the force.
        """
        lines = bush_lines(self.bush, self.force, self.couple, places)
        return np.asarray(np.where(lines < 0.0, -1.0, 1.0) * np.hypot(lines, self.beside))


def beside_middle(offset: Value, spacing: Value | None, forces: Sequence[Array]) -> Array:
    """Moment (n,), N m, of contacts beside the middle of an arm at an offset, m, from its roller;
    of two discs the second is their spacing less the offset from it, and the sum is of their sizes.

    forces : sequence of arrays (n,)   normal force on each disc, N
    """
    if spacing is None:
        return np.asarray(offset * forces[0])
    return np.asarray(offset * forces[0] + np.abs(spacing - offset) * forces[1])


def spring_surge(machine: Machine, lift: Array) -> Array | None:
    """Change of the spring force on the follower by the surge of the coils over the turn (n,), N;
    lift : (n,), m, at equal angles.

    None without a spring design.
    """
    rate, shape, design = machine.spring.own.rate, machine.spring.shape, machine.spring.design
    if design is None:
        return None
    frequency = natural_frequency(rate, design.active_mass)
    travel = np.asarray(end_travel(shape, lift))
    surge = surge_force(travel, machine.cam_speed, rate, frequency, design.damping)
    return surge * lever(shape, lift)


def _own_force(machine: Machine, loads: Loads) -> Array:
    """Force of the spring itself (n,), N."""
    return np.asarray(loads.spring_force / lever(machine.spring.shape, loads.lift))


def guide_bodies(machine: Machine, guide: Guide) -> tuple[SolidBar, Bush]:
    """Stem and bush of a guide as pin and hole."""
    stem = machine.stem
    return SolidBar(stem.elastic_modulus, stem.poisson_ratio), bore_of(guide)


def bore_of(guide: Guide) -> Bush:
    """Bush of a guide as a hole."""
    return Bush(guide.material.E, guide.material.nu, 2.0 * guide.wall_share)


def edge_pressure_of(machine: Machine, guide: Guide) -> Callable[[Array], Array]:
    """Pressure of the stem in a guide's bore (...), Pa, by its line load, N/m."""
    return _in_bore(guide_bodies(machine, guide)[0], guide, machine.stem.diameter)


def _in_bore(pin: SolidBar, guide: Guide, diameter: float) -> Callable[[Array], Array]:
    """Pressure of a pin of a diameter, m, in a bore (...), Pa, by its line load, N/m."""
    radius, clearance, bore = 0.5 * diameter, 0.5 * guide.clearance, bore_of(guide)
    return lambda line_load: peak_pressure(line_load, radius, clearance, pin, bore)[0]


def _key_pressure(machine: Machine, loads: Loads) -> Array | None:
    """Pressure of the key on the flank of the keyway in the cam (n,), Pa, application factor
    included; None without a key.
    """
    cam = machine.cam
    key, flanks = cam.key, cam.key_flanks
    if key is None or flanks is None:
        return None
    return key_stress(key.application_factor * loads.seat_torque, 2.0 * cam.bore_radius, flanks).hub


def shaft_of(turn: Turn, contour: Contour) -> ShaftLoads | None:
    """Camshaft loads over a turn; None where the case describes no camshaft."""
    machine = turn.machine
    if machine.camshaft is None:
        return None
    shaft, cam = machine.camshaft, machine.cam
    return camshaft_loads(turn.loads, shaft, cam, contour, machine.cam_speed)


def _ring(
    machine: Machine, contour: Contour, loads: Loads, contact_width: float
) -> tuple[Array | None, Array | None, Array | None]:
    """Amplitude and mean of the stress in the outer ring (n,), Pa, and relative change of the
    contact pressure from over to between balls (n,); None for a solid roller.
    """
    force, wall, follower = loads.normal_force, loads.wall, machine.follower

    def of(ring: RingOnBalls | None) -> Array | None:
        if ring is None:
            return None
        radius = relative_radius(contour, loads.second, loads.theta, wall)
        bent = ring.bending.stress_amplitude * force, ring.bending.stress_mean * force
        return np.stack([*bent, ring.midway(np.maximum(force, 0.0) / ring.body.width, radius)])

    values = of(follower.ring(contact_width, machine.spring.preload))
    if machine.cam.on_pin is not None:
        roller = on_second_track(machine.roller, machine.cam)
        other = of(roller.ring(contact_width, machine.spring.preload))
        if not (values is None and other is None):
            here, there = (np.nan if each is None else each for each in (values, other))
            values = np.where(wall < 0.0, there, here)
    return (None, None, None) if values is None else (values[0], values[1], values[2])
