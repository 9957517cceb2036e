"""Loaded cam: lift, motion, forces, guides and contact at cam angles, as arrays.

The formulas of checks, screening and synthesis, once, for arrays of any shape, real or complex. A
subclass replaces what it knows better than point supports and half-planes: its members are the list
of what enters as data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arm_face import ArmFaceMotion, CurvedFaceMotion
from camwright.geometry.arm_path import Arm, ArmMotion
from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.flat_face_contour import FaceMotion
from camwright.geometry.follower_path import Motion, Reaction, Sliding
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import RollerMotion, RoundMotion, magnitude, rolling_share
from camwright.geometry.second_track import SecondMotion
from camwright.pipeline.case.case_values import wound_spring
from camwright.pipeline.contact.hertz import half_width_square, peak_pressure_square
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.numbers import Numbers, base_radii
from camwright.pipeline.follower.camshaft_loads import NO_TORQUE, gear_force
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import Carrying, levers, wall_of
from camwright.pipeline.follower.follower_tilt import couple_of_second
from camwright.pipeline.follower.pivot_forces import (
    FRICTION,
    ArmPivot,
    PivotBalance,
    Pressed,
    Pull,
    arm_pivot,
)
from camwright.pipeline.follower.rocker import RockerOutput
from camwright.pipeline.follower.shaft_strength import (
    CamSlope,
    couple_compliance,
    in_the_normal,
    of_disc,
    slopes_of,
)
from camwright.pipeline.follower.spring import end_travel, lever
from camwright.pipeline.follower.spring_kinds import SpringShape, rise
from camwright.pipeline.follower.spring_link import SpringBehindRocker
from camwright.pipeline.follower.wound_wire import SpringWork, WoundWire


def motion_of(jet: Jet, numbers: Numbers) -> Motion:
    """Kinematics of the unloaded cam under its follower at the angles of a jet, by the kind of
    follower that the numbers describe.
    """
    prime, offset = numbers["cam.prime_radius"], numbers["cam.offset"]
    if numbers.get("follower.arm.length") is not None:
        return _on_an_arm(jet, numbers)
    if numbers.get("follower.face.width") is not None:
        return FaceMotion(jet, prime, offset, _friction(numbers))
    return RollerMotion(jet, np.sqrt(prime**2 - offset**2), offset, numbers["roller.radius"])


def _sense(numbers: Numbers) -> float:
    """Sense of the outward swing of an arm."""
    stated = numbers.known_case.follower.arm
    if stated is None:
        raise InputError("follower.arm", "missing", "given for its motion")
    return stated.sense


def pivot_of(numbers: Numbers) -> ArmPivot | None:
    """Pivot of the arm of a follower, with the friction and output of its numbers; None of a
    follower without the friction of a pivot.
    """
    if numbers.get(FRICTION) is None:
        return None
    output = None if numbers.case is None else numbers.case.output
    return arm_pivot(numbers.get, _sense(numbers), output)


def _on_an_arm(jet: Jet, numbers: Numbers) -> Motion:
    """Kinematics under roller or face of an arm, whose start angle follows from the prime
    radius.
    """
    distance, length = numbers["follower.arm.centre_distance"], numbers["follower.arm.length"]
    arm, prime = Arm(distance, length, _sense(numbers)), numbers["cam.prime_radius"]
    offset, radius = (numbers.get(f"follower.face.{name}") for name in ("offset", "radius"))
    start = arm.start_angle(prime, offset)
    if offset is not None:
        return ArmFaceMotion(jet, arm, start, offset, _friction(numbers))
    if radius is not None:
        return CurvedFaceMotion(jet, arm, start, radius, _friction(numbers))
    return ArmMotion(jet, arm, start, numbers["roller.radius"])


def _friction(numbers: Numbers) -> Value:
    """Friction coefficient of a face on the cam; 0 where the case has none."""
    friction = numbers.get("follower.face.friction")
    return 0.0 if friction is None else friction


def on_wall(motion: Motion, wall: Array) -> Motion:
    """Motion of a roller on the wall of a groove that carries: 1 the inner, -1 the outer.

    The outer wall is the parallel curve at the negative radius of the roller, which rolls on it in
    the other direction: contact, undercut factor and spin are those of that radius.
    """
    if not isinstance(motion, RollerMotion | ArmMotion):
        raise GeometryError("the follower in the groove is no roller")
    return replace(motion, size=wall * motion.size)


def carried(first: Motion, second: SecondMotion | None, wall: Array) -> Motion:
    """Motion of the roller or face on the track that carries, from that of the first; wall (...) as
    of `LoadedCam.wall`. second: None in a groove.
    """
    return on_wall(first, wall) if second is None else second.carried(first, wall < 0.0)


def roller_of(path: Motion) -> RoundMotion:
    """Kinematics of a roller, of a stem or an arm; refused for a face.

    Raises
    ------
    GeometryError
        If it is that of a face.
    """
    if isinstance(path, RoundMotion) and path.rolls:
        return path
    raise GeometryError("the follower of the cam is no roller")


def round_of(path: Motion) -> RoundMotion:
    """Kinematics of a round surface, of a roller or curved face; refused for a flat face.

    Raises
    ------
    GeometryError
        If it is that of a flat face.
    """
    if isinstance(path, RoundMotion):
        return path
    raise GeometryError("the follower of the cam is flat")


def face_of(path: Motion) -> Sliding:
    """Kinematics of a face that slides; refused for a roller.

    Raises
    ------
    GeometryError
        If it is that of a roller.
    """
    if isinstance(path, Sliding):
        return path
    raise GeometryError("the follower of the cam is no face")


def not_negative(values: Array) -> Array:
    """Positive part of real or complex values, for complex steps."""
    return np.where(np.real(values) > 0.0, values, 0.0 * values)


class BodyContact(NamedTuple):
    """Contact of one roller or face with its disc: motion in its own travel, axial force there and
    normal force (..., n), N, both 0 where another one carries all; turned: travel from that of the
    first, rad.
    """

    motion: Motion
    axial: Array
    normal: Array
    turned: Value = 0.0

    @classmethod
    def of(cls, motion: Motion, axial: Array, turned: Value = 0.0) -> BodyContact:
        """From the axial force of a roller along its own travel (..., n), N."""
        return cls(motion, axial, np.asarray(axial * motion.gain), turned)


_EVERYWHERE = np.array([True])


class TurningRoller(NamedTuple):
    """Force on a roller with the surge (..., n), N; its speed, that in its mean, see
    `LoadedCam.turning`, and the mean over the turn, rad/s; whether it carries (..., n), of two on a
    pin.
    """

    force: Array
    spin: Array
    turning: Array
    mean: Array
    carries: NDArray[np.bool_] = _EVERYWHERE


class OfGuides(NamedTuple):
    """Pair of values of guides A and B."""

    a: Array
    b: Array


def greatest_friction(numbers: Numbers) -> OfGuides | None:
    """Maximum friction coefficients of both guides; None where not known."""
    on_a, on_b = (numbers.get(f"guides.{side}.friction_greatest") for side in "ab")
    return None if on_a is None or on_b is None else OfGuides(np.asarray(on_a), np.asarray(on_b))


def wire_of(numbers: Numbers) -> WoundWire[Value]:
    """Wound spring of the machine.

    Raises
    ------
    InputError
        If the case has no spring design.
    """
    wire = None if numbers.case is None else wound_spring(numbers.case, numbers.get)
    if wire is None:
        raise InputError("spring.design", "missing", "given for the limits of the spring")
    return wire


@dataclass(frozen=True, eq=False)
class LoadedCam:
    """Cam at n angles under the loads of its follower: measures of the checks, (..., n), SI.

    The forces are not clipped at loss of contact and at jamming: a search needs their slope beyond
    both. Leading axes are those of load cases, tolerance corners or designs; pairs of one and a cam
    angle are (m,).

    Parameters
    ----------
    jet : Jet
    numbers : Numbers      of machine and load case
    highest : float        maximum lift, m
    least_lift : float     minimum lift, m
    external : array       external force, N, towards the cam
    gravity : float        component of g along the axis towards the cam, m/s2
    """

    jet: Jet
    numbers: Numbers
    highest: Value = np.nan
    least_lift: Value = 0.0
    external: Value = 0.0
    gravity: Value = 0.0

    @cached_property
    def motion(self) -> Motion:
        """Motion of the follower on the unloaded cam."""
        return motion_of(self.jet, self.numbers)

    @property
    def travel(self) -> Value:
        """Direction of travel of the first roller or face from the follower axis, rad."""
        return self.motion.travel

    @property
    def turned(self) -> Value:
        """Travel of the roller or face that carries from that of the first, rad."""
        return 0.0

    @property
    def pulls(self) -> bool:
        """Whether the cam pulls the follower, too, as the outer wall of a groove does."""
        case = self.numbers.case
        return case is not None and case.cam.pulls

    @property
    def least_radius(self) -> Value:
        """Minimum radius of the contour, m: in a dwell at minimum lift; of two discs the lesser."""
        return self.motion.radius_at(self.least_lift)

    @property
    def spring_shape(self) -> SpringShape | None:
        """Force rise of a nonlinear spring; None for a linear one."""
        return self.numbers.spring_shape

    @property
    def drag(self) -> Drag | None:
        """Inertia and bearing drag of the roller; None without one."""
        case = self.numbers.case
        return None if case is None else case.facing.drag

    @property
    def rotor_inertia(self) -> Value:
        """Moment of inertia of the roller, kg m2; 0 without one."""
        inertia = self.numbers.get("roller.rotor_inertia")
        return 0.0 if inertia is None else inertia

    @property
    def speed(self) -> Value:
        """Cam speed, rad/s."""
        return self.numbers["cam.speed"]

    @property
    def slope(self) -> Array:
        """Slope of the lift, m/rad, > 0 on the rise."""
        return self.jet.slope

    @cached_property
    def velocity(self) -> Array:
        """Velocity of the follower, m/s."""
        return self.speed * self.slope

    @property
    def acceleration(self) -> Array:
        """Acceleration of the follower, m/s2."""
        return np.asarray(self.speed**2 * self.jet.lift_d2)

    @cached_property
    def spin(self) -> Array:
        """Angular speed of the roller on its pin, rad/s."""
        return np.asarray(self.speed * self.motion.rolling)

    @property
    def spin_mean(self) -> Array:
        """Mean angular speed of the roller over the turn (..., 1), rad/s, on the prime circle."""
        numbers = self.numbers
        rolling = rolling_share(np.asarray(numbers["cam.prime_radius"]), numbers["roller.radius"])
        return np.asarray(self.speed * rolling)

    @cached_property
    def turning(self) -> Array:
        """Speed of the roller without its sign (..., n), rad/s, whose mean over equal cam angles is
        that of the turn, by the weight of each where another track carries.
        """
        return magnitude(self.spin)

    def _turning_by(self, force: Array, on_track: Callable[[Array], Motion]) -> Array:
        """Turning over a whole turn by the force whose sign says which track carries (..., n), N,
        and the motion on that track; of preloaded rollers, both of which are pressed, and of one
        track the speed itself.
        """
        case = self.numbers.case
        if case is None or not case.cam.clearance > 0.0:
            return magnitude(self.spin)
        carrying = Carrying.of(force, self.closing, self.slope)
        spin = np.asarray(self.speed * on_track(carrying.wall).rolling)
        return magnitude(spin) * carrying.weights

    @cached_property
    def rollers(self) -> tuple[TurningRoller, ...]:
        """The roller that carries; both on a pin, each as it rolls on its own wall all the turn;
        both of preloaded discs, which are pressed at once all the turn.
        """
        case = self.numbers.case
        if case is not None and case.cam.on_pin is not None:
            return self._on_walls("roller.radius", "cam.groove.second.radius")
        pair = None if case is None else case.cam.conjugate
        if pair is None or pair.interference is None:
            return (TurningRoller(self.surged, self.spin, self.turning, self.spin_mean),)
        turning = list[TurningRoller]()
        for each, carries in zip(self.on_bodies, (self.wall > 0.0, self.wall < 0.0), strict=True):
            spin = np.asarray(self.speed * each.motion.rolling)
            force = np.where(carries, self.surged, each.normal)
            mean = np.mean(magnitude(spin), axis=-1, keepdims=True)
            turning.append(TurningRoller(force, spin, magnitude(spin), mean))
        return tuple(turning)

    def _on_walls(self, *radii: str) -> tuple[TurningRoller, ...]:
        """Rollers on inner and outer wall, by the dotted keys of their radii."""
        turning, motion = list[TurningRoller](), round_of(self.motion)
        for wall, key in zip((1.0, -1.0), radii, strict=True):
            carries, size = np.asarray(wall * self.wall > 0.0), wall * self.numbers[key]
            force = np.where(carries, self.surged, 0.0 * self.surged)
            beside = motion.path_speed * (1.0 / size - 1.0 / motion.size)
            spin = np.asarray(self.speed * (motion.rolling + beside))
            mean = np.mean(magnitude(spin), axis=-1, keepdims=True)
            turning.append(TurningRoller(force, spin, magnitude(spin), mean, carries))
        return tuple(turning)

    @property
    def on_other_track(self) -> Self | None:
        """The cam seen from the track that bears less, of preloaded discs; None of others."""
        return None

    @property
    def squeeze(self) -> Squeezed | None:
        """Preload of both discs with their interference; None without one."""
        return None

    @cached_property
    def reactions(self) -> tuple[Reaction, Reaction]:
        """Loads of guides on points over the axial force."""
        numbers, spacing = self.numbers, self.numbers["guides.spacing"]
        overhang = numbers["follower.overhang_at_max_lift"] + self.highest - self.jet.lift
        overhang = overhang + self.reach
        return self.motion.reactions(levers(overhang, spacing), spacing)

    @property
    def reach(self) -> Value:
        """Distance of the roller that carries from the first, away from the guides, m."""
        return 0.0

    @cached_property
    def rubbing_share(self) -> OfGuides:
        """Normal loads of the friction in the guides over the axial force."""
        return OfGuides(*(each.on_points for each in self.reactions))

    def _spring_at(self, lift: Value) -> Array:
        """Spring force at a lift, m, N."""
        shape = self.spring_shape
        travel = lift if shape is None else rise(shape, np.asarray(lift)).travel
        return np.asarray(self.numbers["spring.preload"] + self.numbers["spring.rate"] * travel)

    @cached_property
    def spring_force(self) -> Array:
        """N"""
        return self._spring_at(self.jet.lift)

    @cached_property
    def least_spring(self) -> Array:
        """Spring force at minimum lift, N."""
        return self._spring_at(self.least_lift)

    def travel_of_spring(self, lift: Value) -> Value:
        """Travel of the ends of the spring at a lift, m; on a stem the lift."""
        return end_travel(self.spring_shape, lift)

    @property
    def spring_travel(self) -> Array:
        """Travel of the ends of the spring, m."""
        return np.asarray(self.travel_of_spring(self.jet.lift))

    @property
    def spring_lever(self) -> Array:
        """Travel of the ends of the spring per lift; 1 on a stem."""
        return np.asarray(lever(self.spring_shape, self.jet.lift))

    @property
    def spring_preload(self) -> Value:
        """Force of the spring itself at zero lift, N; on a stem `spring.preload`."""
        return self._own(self.numbers["spring.preload"])

    @property
    def spring_rate(self) -> Value:
        """Rate of the spring itself at zero lift, N/m; on a stem `spring.rate`."""
        shape = self.spring_shape
        return self.numbers["spring.rate"] * (1.0 if shape is None else shape.own_share)

    def _own(self, preload: Value) -> Value:
        return preload / lever(self.spring_shape, 0.0)

    @cached_property
    def wire(self) -> WoundWire[Value]:
        """Wire of the spring as wound."""
        return wire_of(self.numbers)

    @cached_property
    def hardest(self) -> SpringWork[Value]:
        """Preload, greatest force, N, travel, m, and rate, N/m, of the hardest spring in tolerance
        up to the lift, without surge.

        With the greatest preload of the load cases; a wound spring has the rate of its wire. Force
        and travel are those of the spring itself.
        """
        numbers, travel = self.numbers, self.spring_travel
        preload = self._own(numbers["spring.preload_greatest"])
        spreads = numbers["spring.preload_tolerance"], numbers["spring.rate_tolerance"]
        if numbers.case is not None and numbers.case.spring.design is not None:
            return self.wire.at_work(preload, travel, *spreads)
        # a preload that pulls is greatest at its low end
        side = np.where(np.asarray(preload).real < 0.0, -1.0, 1.0)
        hard, rate = preload * (1.0 + side * spreads[0]), self.spring_rate * (1.0 + spreads[1])
        law = None if self.spring_shape is None else self.spring_shape.own
        risen = travel if law is None else rise(law, travel).travel
        return SpringWork(hard, hard + rate * risen, travel, rate)

    @property
    def stressed(self) -> SpringWork[Value]:
        """Operating range of the hardest spring at greatest force, with surge where known."""
        return self.hardest

    @property
    def fatigued(self) -> SpringWork[Value]:
        """Operating range of the hardest spring at worst fatigue, with surge where known."""
        return self.hardest

    @cached_property
    def closing(self) -> Array:
        """Spring, weight and external force, N."""
        if self.pivot is not None:
            return self.spring_force + self.pivot.applied(self.external, self.travel)
        return self.spring_force + (self.numbers["follower.mass"] * self.gravity + self.external)

    @cached_property
    def pivot(self) -> ArmPivot | None:
        """Pivot of an arm with what acts about it; None without one."""
        pivot = pivot_of(self.numbers)
        return pivot and replace(pivot, spring=self.spring_shape)

    def _about(self, pivot: ArmPivot, added: Value = 0.0) -> PivotBalance:
        """Equilibrium of an arm about a pivot with its friction.

        Parameters
        ----------
        added : float or array   force of the spring besides that of its travel, such as surge, N
        """
        return self._balanced(pivot, self.required + added, self._pull(pivot, added))

    def _pull(self, pivot: ArmPivot, added: Value = 0.0) -> Pull:
        """All forces on an arm but those of contact and pivot, see `ArmPivot.pull`; `added` as in
        `_about`.
        """
        spring = self.spring_force + added
        return pivot.pull(spring, self.external, self.travel, self.velocity, self.acceleration)

    def _balanced(self, pivot: ArmPivot, required: Array, pull: Pull) -> PivotBalance:
        outward = np.asarray(np.sign(np.real(self.slope)))
        return pivot.balanced(required, Pressed.of(self.motion), pull, outward)

    @cached_property
    def pivoted(self) -> PivotBalance | None:
        """Axial force, load and friction of the pivot; None without one."""
        return None if self.pivot is None else self._about(self.pivot)

    @cached_property
    def pivoted_worst(self) -> PivotBalance | None:
        """Axial force, load and friction of the pivot at its maximum friction coefficient; None
        without a pivot or where that coefficient is not known.
        """
        most = self.numbers.get(f"{FRICTION}_greatest")
        if self.pivot is None or most is None:
            return None
        return self._about(replace(self.pivot, friction=most))

    @property
    def pivot_load(self) -> Array:
        """Load of the pivot, N; NaN without one."""
        return self._of_pivot(self.pivoted, "load")

    @property
    def pivot_heat(self) -> Array | None:
        """Friction power of the pivot at maximum friction, W, of the pushes on both sides of its
        bush; None where not known.
        """
        if self.pivoted_worst is None:
            return None
        friction = self._of_pivot(self.pivoted_worst, "friction") * self.bush_rubbing
        return magnitude(friction * self.velocity)

    @property
    def bush_rubbing(self) -> Value:
        """Pushes on both sides of the bush of a pivot over its load; here of a level pin."""
        return 1.0

    @property
    def bush_bearing(self) -> Value:
        """Load on the more loaded side of the bush of a pivot over the loaded share of its length,
        over the load of the pivot; here of a level pin.
        """
        return 1.0

    @property
    def pin_velocity(self) -> Array:
        """Sliding speed of the arm on the pin of its pivot, m/s; NaN without one."""
        pivot = self.pivot
        if pivot is None:
            return np.full_like(self.velocity, np.nan)
        return self.velocity * (pivot.radius / pivot.length)

    def _of_pivot(self, balanced: PivotBalance | None, name: str) -> Array:
        """Field of the equilibrium about the pivot by its name (..., n); NaN without a pivot."""
        if balanced is None:
            return np.full_like(self.velocity, np.nan)
        return np.asarray(getattr(balanced, name))

    def inertia_at(self, speed: Value) -> Array:
        """Inertia force along the follower at a cam speed, rad/s, N: of its mass and, with a
        rocker, of the output.
        """
        lift, acceleration = self.jet.lift, speed**2 * self.jet.lift_d2
        force: Array = self.numbers["follower.mass"] * acceleration
        output = self.output
        if output is None:
            return force
        return np.asarray(force + output.inertia(lift, speed * self.jet.slope, acceleration))

    @property
    def output(self) -> RockerOutput | None:
        """Mass and force that a rocker moves; None without them."""
        return None if self.numbers.case is None else self.numbers.case.output

    @property
    def output_inertia(self) -> Value:
        """Inertia force of the output of a rocker on the follower, N; 0 without one."""
        if self.output is None:
            return 0.0
        return self.output.whole_inertia(self.jet.lift, self.velocity, self.acceleration)

    @property
    def on_bodies(self) -> tuple[BodyContact, ...]:
        """Contact of the follower with the cam; of two discs of each roller with its own."""
        return (BodyContact(self.motion, self.axial, self.normal),)

    @property
    def output_closing(self) -> Value:
        """Share of `closing` that acts on the second arm of a rocker, N: of a constant force on the
        output and of a spring there; 0 without them.
        """
        sprung = isinstance(self.spring_shape, SpringBehindRocker)
        force: Value = self.spring_force if sprung else 0.0
        return force if self.output is None else force + self.output.reduced_force

    @property
    def output_force(self) -> Array:
        """Force on the output of a rocker against its lift, N: of its mass, of a constant force and
        of a spring on it.
        """
        shape, force = self.spring_shape, np.zeros_like(self.velocity)
        if self.output is not None:
            force = force + self.output.push(self.jet.lift, self.velocity, self.acceleration)
        if isinstance(shape, SpringBehindRocker):
            force = force + self.spring_force / shape.lever(self.jet.lift)
        return np.asarray(force)

    @cached_property
    def inertia(self) -> Array:
        """Inertia force, N."""
        return self.inertia_at(self.speed)

    @cached_property
    def viscous(self) -> Array:
        """Force of the viscous damping, N."""
        force: Array = self.numbers["follower.viscous_damping"] * self.speed * self.jet.slope
        return force

    @cached_property
    def required(self) -> Array:
        """Axial force without guide friction, N; negative where the cam would have to pull."""
        return self.closing + self.inertia + self.viscous

    @cached_property
    def jam(self) -> Array:
        """Jam index: friction of guides or pivot over the axial force."""
        if self.pivoted is not None:
            return self.pivoted.jam_index
        numbers, rubbing = self.numbers, self.rubbing_share
        on_a, on_b = numbers["guides.a.friction"], numbers["guides.b.friction"]
        index: Array = on_a * rubbing.a + on_b * rubbing.b
        return index

    @cached_property
    def wall(self) -> Array:
        """Wall that carries: 1 the inner, which pushes outward, -1 the outer of a groove."""
        return wall_of(self.required, held=self.pulls)

    @property
    def heading(self) -> Array:
        """Direction of the follower: 1 rising, 0 at rest, -1 falling."""
        return np.asarray(np.sign(np.real(self.slope)))

    @property
    def direction(self) -> Array:
        """Direction of the friction of the guides: 1 where the cam drives the follower, 0 at
        rest, else -1.

        Of a cam that does not pull that of the follower.
        """
        return np.asarray(self.heading * self.wall)

    @property
    def jam_worst(self) -> Array | None:
        """Jam index at maximum friction; None where that is not known."""
        if self.pivot is not None:
            return None if self.pivoted_worst is None else self.pivoted_worst.jam_index
        most = greatest_friction(self.numbers)
        if most is None:
            return None
        on_a, on_b = self.reactions
        index: Array = most.a * on_a.on_points + most.b * on_b.on_points
        return index

    @cached_property
    def share(self) -> Array:
        """Axial force without friction over axial force."""
        return 1.0 - self.direction * self.jam - self.motion.lock

    @cached_property
    def axial(self) -> Array:
        """Axial force, with implicit friction, N; see `follower_loads`."""
        if self.pivoted is not None:
            return self.pivoted.axial
        return self.required / self.share

    @cached_property
    def normal(self) -> Array:
        """Contact force, N."""
        return self.axial * self.wall * self.motion.gain

    @property
    def surge(self) -> Value:
        """Force of the surge of the spring, N."""
        return 0.0

    @cached_property
    def surged(self) -> Array:
        """Contact force with the surge of the spring, N."""
        if self.pivot is not None:
            return self._about(self.pivot, self.surge).axial * self.wall * self.motion.gain
        return (self.axial + self.surge / self.share) * self.wall * self.motion.gain

    @cached_property
    def torque(self) -> Array:
        """Cam torque, N m."""
        return self.axial * (self.slope + self.motion.sliding)

    @property
    def seat_torque(self) -> Array:
        """Torque that the seat of a disc bears, N m: that of the cam, or that of the preloaded disc
        that bears more, which the other gives back.
        """
        return np.asarray(of_disc(self.disc_torques, self.wall < 0.0))

    @property
    def disc_torques(self) -> tuple[Array, ...]:
        """Torque that each disc bears of its own contact, N m."""
        if self.numbers.case is None or self.numbers.case.cam.spacing is None:
            return (self.torque,)
        return tuple(np.asarray(each.axial * each.motion.jet.slope) for each in self.on_bodies)

    @property
    def friction_work(self) -> Array:
        """Friction power of guides, pivot, roller bearing and face over the cam speed, N m."""
        guides = (self.axial - self.closing - self.inertia) * self.slope
        work, other = guides + self._bearing_work, self.on_other_track
        if other is not None:
            work = work + other._bearing_work
        return work + self.axial * self.motion.sliding

    @property
    def _bearing_work(self) -> Array:
        """Friction power of the bearing of the roller over the cam speed, N m."""
        drag = 0.0 if self.drag is None else self.drag.bearing_torque(self.normal)
        return np.asarray(drag * magnitude(np.asarray(self.motion.rolling)))

    @cached_property
    def reverses(self) -> NDArray[np.bool_]:
        """Whether the torque on a disc changes sign over the turn, or is not known, (...) or
        (m, 1).
        """
        ways = list[NDArray[np.bool_]]()
        for each in self.disc_torques:
            torque = np.real(each)
            signs = (torque >= -NO_TORQUE).all(axis=-1), (torque <= NO_TORQUE).all(axis=-1)
            ways.append(np.asarray(np.logical_or(*signs)))
        one_way = np.all(ways, axis=0)
        return ~one_way[..., None] if one_way.ndim else ~one_way

    @cached_property
    def rubbing(self) -> OfGuides:
        """Sum of the pushes on both sides of a guide, N, those across the cam's plane included."""
        return OfGuides(*(self.axial * each for each in self.rubbing_share))

    @property
    def jam_tilted(self) -> Value:
        """Jam index under a couple across the cam's plane, too, over that without; here of none."""
        return 1.0

    def friction_over(self, plane: OfGuides) -> Array:
        """Friction of both guides by `rubbing` over that by their pushes in the cam's plane alone,
        N; 1 without these.
        """
        numbers = self.numbers
        on_a, on_b = numbers["guides.a.friction"], numbers["guides.b.friction"]
        both, part = (on_a * each.a + on_b * each.b for each in (self.rubbing, plane))
        return np.divide(both, part, out=np.ones_like(both), where=part != 0.0)

    @cached_property
    def bearing(self) -> OfGuides:
        """Load on the loaded side of a guide over its loaded share of length, N."""
        return OfGuides(*(self.axial * each.on_points for each in self.reactions))

    @property
    def hot_share(self) -> OfGuides:
        """`rubbing_share` at maximum friction."""
        return OfGuides(*(each.on_points for each in self.reactions))

    @cached_property
    def hot(self) -> OfGuides | None:
        """Friction forces of guides A and B at maximum friction (..., n), N; None where it is not
        known.
        """
        friction, jam = greatest_friction(self.numbers), self.jam_worst
        if friction is None or jam is None:
            return None
        axial = self.axial * self.share / (1.0 - self.direction * jam - self.motion.lock)
        loads = self.hot_share
        return OfGuides(friction.a * loads.a * axial, friction.b * loads.b * axial)

    @property
    def heat(self) -> OfGuides | None:
        """Friction power of the guides at maximum friction, W; None where not known."""
        hot = self.hot
        return None if hot is None else OfGuides(*(magnitude(each * self.velocity) for each in hot))

    @property
    def thrown(self) -> tuple[tuple[Value, ...], Value]:
        """Centrifugal forces on each disc and the counterweight, N; here of a balanced shaft."""
        return tuple(0.0 for _ in self.on_bodies), 0.0

    @cached_property
    def shaft_slopes(self) -> tuple[CamSlope, ...]:
        """Slopes of the camshaft at each disc; () of a rigid one."""
        case = self.numbers.case
        if case is None or case.cam.spacing is None:
            return slopes_of(None if case is None else case.camshaft)
        flat, size = self.numbers.each(_disc_slopes, (_SPACING,)), len(CamSlope._fields)
        return tuple(CamSlope(*flat[k : k + size]) for k in range(0, len(flat), size))

    @property
    def shaft_compliance(self) -> Value:
        """Slope of the camshaft at the disc that carries per moment there, rad/(N m)."""
        return couple_compliance(self.shaft_slopes, self.wall < 0.0)

    @cached_property
    def shaft_tilt(self) -> Array:
        """Slope of the camshaft at the cam in the plane of the contact normal (..., n), rad; 0 of a
        rigid one.

        As of `Cycle.shaft_tilt`.
        """
        return np.asarray(of_disc(self._disc_tilts, self.wall < 0.0))

    @property
    def base_radii(self) -> tuple[Value, ...]:
        """Radius of the base circle, m, of each disc of `shaft_tilts`."""
        return (self.base_radius,) if len(self.shaft_tilts) == 1 else base_radii(self.numbers)

    @property
    def base_radius(self) -> Array:
        """Radius of the base circle of the disc that carries (..., n), m."""
        first, second = base_radii(self.numbers)
        return np.where(self.wall < 0.0, second, first)

    @property
    def shaft_tilts(self) -> tuple[Array, ...]:
        """`shaft_tilt`; of two preloaded discs, both of which are pressed, that of each."""
        return (self.shaft_tilt,) if len(self.rollers) == 1 else self._disc_tilts

    @cached_property
    def _disc_tilts(self) -> tuple[Array, ...]:
        """Slope at each disc in the plane of the normal of its own contact (..., n), rad."""
        shaft = None if self.numbers.case is None else self.numbers.case.camshaft
        bodies, slopes = self.on_bodies, self.shaft_slopes
        if shaft is None or not slopes:
            return tuple(np.zeros(self.normal.shape) for _ in bodies)
        travel, (on_discs, held), pushes = self.motion.travel, self.thrown, list[Array]()
        for (motion, axial, _, turned), thrown in zip(bodies, on_discs, strict=True):
            cos, sin = np.cos(travel + turned), np.sin(travel + turned)
            along, across = axial * motion.pressing, axial * motion.side
            pushes.append(
                thrown - np.stack([along * cos + across * sin, across * cos - along * sin])
            )
        gear = gear_force(self.torque, shaft)
        if len(bodies) == 1:
            bent = slopes[0].under(pushes[0], gear, held)
            return (in_the_normal(bent, self.motion.pressure_angle - travel - self.turned),)
        return tuple(
            in_the_normal(
                at.under(on, gear, held, beside),
                each.motion.pressure_angle - travel - each.turned,
            )
            for each, at, on, beside in zip(bodies, slopes, pushes, pushes[::-1], strict=True)
        )

    @property
    def contact_radius(self) -> Value:
        """Size of the contact of `Motion`, m, on either track."""
        return magnitude(np.asarray(self.motion.size))

    @cached_property
    def follower_moment(self) -> Array:
        """Greatest moment of the contact about the middle of the follower, N m, >= 0.

        In the plane of its normal and the cam axis; here of a level line of contact.
        """
        return 0.0 * self.normal

    @property
    def beyond(self) -> Value:
        """Distance by which the roller that carries is farther into a groove than the first, on the
        same pin, m; 0 of one roller.
        """
        case = self.numbers.case
        second = None if case is None else case.cam.on_pin
        if second is None:
            return 0.0
        farther = self.numbers.of_part(second).beyond(self.numbers["roller.radius"])
        return np.where(self.wall < 0.0, farther, 0.0)

    @property
    def pin_couple(self) -> Array:
        """Greatest moment of the contact on the pin about the middle of the first roller, N m:
        `follower_moment`, and the force of a second one beside it.
        """
        return np.asarray(self.follower_moment + couple_of_second(self.normal, self.beyond))

    @property
    def pressure_factor(self) -> Value:
        """Contact pressure over that of plane-strain half-planes."""
        return 1.0

    @property
    def pressure_weight(self) -> Value:
        """Share by which a limit of the pressure is used over that by the pressure in the middle of
        the line, of a synthesis; here 1.
        """
        return 1.0

    @property
    def force_weight(self) -> Value:
        """Share by which a limit of the normal force is used over that by the force, as above."""
        return 1.0

    @cached_property
    def flat_square(self) -> Array:
        """p0^2 by half-planes at an undercut factor of 1, Pa^2."""
        line_load = self.normal / self.numbers["contact.width"]
        modulus = self.numbers["contact.modulus"]
        return peak_pressure_square(line_load, 1.0 / self.contact_radius, modulus)

    @cached_property
    def p0(self) -> Array:
        """Contact pressure in the middle of the line of contact, Pa."""
        return self.pressure_factor * np.sqrt(self.flat_square / (1.0 - self.motion.sharpness))

    @property
    def p0_signed(self) -> Array:
        """Contact pressure with ends and tilt, Pa; here of a line without ends."""
        return self.p0

    @property
    def half_width(self) -> Array:
        """Half-width of the contact (..., n), m, less where the line has a greater pressure than in
        plane strain.
        """
        numbers, size = self.numbers, self.contact_radius
        radius = size * (1.0 - self.motion.sharpness)
        force = np.where(np.real(self.normal) < _LEAST_FORCE, _LEAST_FORCE, self.normal)
        radius = np.where(np.real(radius) < _LEAST_RADIUS, _LEAST_RADIUS, radius)
        load = force / numbers["contact.width"]
        square = half_width_square(load, radius, numbers["contact.modulus"])
        return np.sqrt(square) / self.pressure_factor


@dataclass(frozen=True, eq=False, kw_only=True)
class DiscCam(LoadedCam):
    """Unloaded cam of which the motion on a disc is known."""

    track: Motion

    @property
    def motion(self) -> Motion:
        return self.track


@dataclass(frozen=True, eq=False, kw_only=True)
class CarriedCam(LoadedCam):
    """Loaded cam whose motion is that on the track that carries: of a cam that pulls its follower
    one of two, at each cam angle.

    facing: the same cam seen from the track that carries, of one seen from the other track.
    """

    facing: CarriedCam | None = field(default=None, repr=False)

    @cached_property
    def on_other_track(self) -> Self | None:
        """Contact and normal force are those of that track, the rest is of both."""
        if self.squeeze is None or not self.pulls:
            return None
        return replace(self, facing=self)

    @cached_property
    def first(self) -> Motion:
        """Motion on the first track, of the unloaded cam."""
        return motion_of(self.jet, self.numbers)

    @property
    def second(self) -> SecondMotion | None:
        """Motion of a second roller or face; None without one."""
        return None

    @cached_property
    def motion(self) -> Motion:
        return carried(self.first, self.second, self.wall) if self.pulls else self.first

    @property
    def travel(self) -> Value:
        return self.first.travel

    @property
    def turned(self) -> Value:
        second = self.second
        return 0.0 if second is None else np.where(self.wall < 0.0, second.turned, 0.0)

    @property
    def reach(self) -> Value:
        second = self.second
        return 0.0 if second is None else np.asarray(second.reach * (self.wall < 0.0))

    @cached_property
    def _between(self) -> tuple[PivotBalance, Array] | None:
        """Equilibrium of an arm between two tracks, and the track that carries; None of a stem and
        of a cam that does not pull.
        """
        if self.facing is not None:
            return self.facing._between
        if self.pivot is None or not self.pulls:
            return None
        return self._swung(self.pivot, self.required, self._pull(self.pivot))

    @cached_property
    def wall(self) -> Array:
        if self.facing is not None:
            return -self.facing.wall
        return super().wall if self._between is None else self._between[1]

    @cached_property
    def pivoted(self) -> PivotBalance | None:
        return super().pivoted if self._between is None else self._between[0]

    def _balanced(self, pivot: ArmPivot, required: Array, pull: Pull) -> PivotBalance:
        if self.pulls:
            return self._swung(pivot, required, pull)[0]
        return super()._balanced(pivot, required, pull)

    def _swung(self, pivot: ArmPivot, required: Array, pull: Pull) -> tuple[PivotBalance, Array]:
        """Equilibrium of an arm between two tracks, and the track that carries (..., n)."""
        one = np.ones(np.shape(self.first.jet.lift))
        push, pulled = (
            Pressed.of(carried(self.first, self.second, side * one)) for side in (1.0, -1.0)
        )
        pressed, direction = (push, pulled), np.asarray(np.sign(np.real(self.slope)))
        squeeze = self.squeeze
        if squeeze is None:
            return pivot.between(required, pressed, pull, direction)
        return pivot.squeezed(required, pressed, squeeze, pull, direction)

    @cached_property
    def axial(self) -> Array:
        return super().axial if self.facing is None else self.facing.axial

    @property
    def on_bodies(self) -> tuple[BodyContact, ...]:
        second, squeeze, axial = self.second, self.squeeze, self.axial
        if second is None or self.numbers.known_case.cam.conjugate is None:
            return super().on_bodies
        alone = not_negative(axial), not_negative(-axial)
        push, pull = alone if squeeze is None else squeeze.forces(axial)
        pulled = BodyContact.of(second.motion, second.leverage * pull, second.turned)
        return BodyContact.of(self.first, push), pulled

    @cached_property
    def normal(self) -> Array:
        squeeze = self.squeeze if self.pulls else None
        if squeeze is None:
            return super().normal
        first, second = squeeze.forces(self.axial)
        return np.asarray(np.where(self.wall > 0.0, first, second) * self.motion.gain)

    @cached_property
    def surged(self) -> Array:
        return self.normal if self.pulls and self.squeeze is not None else super().surged


_SPACING = "cam.conjugate.spacing"


def _disc_slopes(numbers: Numbers) -> tuple[Value, ...]:
    """Fields of the slopes of the camshaft at each disc of a pair, one disc after another."""
    slopes = slopes_of(numbers.known_case.camshaft, float(numbers[_SPACING]))
    return tuple(value for each in slopes for value in each)


_LEAST_FORCE = 1.0  # N, of a half-width
_LEAST_RADIUS = 1e-6  # m, of curvature, of a half-width
