"""Forces on an oscillating arm: moments about its pivot, the reaction there, and its friction.

Vectors are along the travel of the reference point, outwards, and across it, clockwise from that,
as the axial and the side force of the contact. All functions take arrays (..., n), real or complex.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Array, Value
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base.external_force import STANDARD_GRAVITY
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.rocker import RockerOutput
from camwright.pipeline.follower.spring_kinds import SpringShape

_QUARTER_TURN = 0.5 * np.pi
_LEAST_FORCE = 1.0  # N, of a contact force that a jam index is over


class Pull(NamedTuple):
    """Force on the arm along and across the travel of its reference point, N."""

    along: Array
    across: Array


class Slides(Protocol):
    """Forces of a contact over its axial force, see `Motion` and `Slide`."""

    @property
    def pressing(self) -> Value: ...
    @property
    def side(self) -> Array: ...
    @property
    def lock(self) -> Value: ...


class Pressed(NamedTuple):
    """Contact force along and across the travel over the axial force of the contact.

    share: of the axial force that the friction of a face leaves.
    """

    along: Array
    across: Array
    share: Value = 1.0

    @classmethod
    def of(cls, contact: Slides) -> Pressed:
        """From the motion of the follower, or the forces of its contact."""
        across = np.asarray(contact.side)
        return cls(contact.pressing + 0.0 * across, across, 1.0 - contact.lock)

    def total(self, axial: Array, pull: Pull) -> tuple[Array, Array]:
        """Sum of the contact force, of an axial force, and a pull, N: the load of the pivot."""
        return self.along * axial + pull.along, self.across * axial + pull.across


class PivotBalance(NamedTuple):
    """Equilibrium of the moments about the pivot, with its friction, (..., n), N.

    axial: axial force of the contact; below 0 where the arm locks, or the cam would have to pull;
    along, across: load of the pivot, along the travel and across it; friction: its moment over the
    length of the arm; jam_index: the friction over the axial force, of at least 1 N.
    """

    axial: Array
    along: Array
    across: Array
    friction: Array
    jam_index: Array

    @property
    def load(self) -> Array:
        """Magnitude of the load of the pivot (..., n), N."""
        return _size((self.along, self.across))


@dataclass(frozen=True)
class ArmPivot:
    """Pivot of an arm with what acts about it; scalars or arrays (..., 1).

    Parameters
    ----------
    length : float          l, pivot to the reference point, m
    sense : float           w of the arm, see `Arm`
    start : float           arm angle at zero lift, rad
    radius : float          of the pin, m
    friction : float        coefficient
    mass : float            of all that swings, kg
    mass_distance, mass_angle : float   of its centre, m from the pivot and rad from the arm,
                            positive in the outward swing
    gravity_angle : float   from the upward vertical to the line from the cam axis to the pivot, in
                            the sense of rotation of the cam, rad; None: without weight
    load_distance, load_angle : float   likewise, of the point at which the external force acts
                            square to the line from the pivot
    load_moment : float     external moment towards the cam, N m
    spring : SpringShape    with its resultant on the arm; None: at the reference point
    output : RockerOutput   of a second arm on the pivot, which it pushes; None: none

    References
    ----------
    Rothbart, Cam Design Handbook (2004), ch. 6: moments about the pivot of an oscillating follower.
    """

    length: Value
    sense: float
    start: Value
    radius: Value
    friction: Value
    mass: Value
    mass_distance: Value
    mass_angle: Value
    gravity_angle: Value | None
    load_distance: Value
    load_angle: Value
    load_moment: Value
    spring: SpringShape | None = None
    output: RockerOutput | None = None

    @property
    def _of_output(self) -> float:
        """Share of the output in the external force, N."""
        return 0.0 if self.output is None else self.output.reduced_force

    def applied(self, external: Value, direction: Value) -> Array:
        """Weight, external force and moment reduced to the reference point, N, towards the cam.

        Parameters
        ----------
        external : array (..., n)   external force, N
        direction : array (..., n)  of travel, rad
        """
        beyond = self._of_output
        moment = (external - beyond) * self.load_distance + self.load_moment
        moment = moment + beyond * self.length
        if self.gravity_angle is not None:
            lever = self.mass_distance * np.cos(self._from_vertical(direction, self.mass_angle))
            moment = moment + self.mass * STANDARD_GRAVITY * lever
        return np.asarray(moment / self.length)

    def direction(self, lift: Value) -> Value:
        """Direction of travel at a lift, m, rad; see `Arm.travel`."""
        return self.sense * (_QUARTER_TURN - self.start - lift / self.length)

    def _from_vertical(self, direction: Value, beyond: Value) -> Value:
        """Angle of the travel of a point beside the arm from the upward vertical, rad."""
        vertical = 0.0 if self.gravity_angle is None else self.gravity_angle
        return direction - self.sense * beyond - vertical

    def pull(
        self, spring: Value, external: Value, direction: Value, velocity: Value, acceleration: Value
    ) -> Pull:
        """Sum of all forces on the arm but those of contact and pivot, that of its inertia
        included, along and across the travel, N.

        A spring without a shape pulls at the reference point against its travel.

        Parameters
        ----------
        spring : array (..., n)                   force of the spring reduced to the reference
                                                  point, N
        external : array (..., n)                 external force towards the cam, that of an output
                                                  included, N
        direction : array (..., n)                of travel of the reference point, rad
        velocity, acceleration : array (..., n)   of the reference point, m/s and m/s2
        """
        cos, sin = np.cos(self.load_angle), self.sense * np.sin(self.load_angle)
        pulled = self.of_spring(spring, direction)
        pushed = self.of_output(direction, velocity, acceleration)
        acting = external - self._of_output
        along = pulled.along + pushed.along - acting * cos
        across = pulled.across + pushed.across - acting * sin
        cos, sin = np.cos(self.mass_angle), np.sin(self.mass_angle)
        radius = self.mass * self.mass_distance
        turning, outward = acceleration / self.length, (velocity / self.length) ** 2
        along = along - radius * (turning * cos - outward * sin)
        across = across - self.sense * radius * (turning * sin + outward * cos)
        if self.gravity_angle is not None:
            weight = self.mass * STANDARD_GRAVITY
            down = self._from_vertical(direction, 0.0)
            along, across = along - weight * np.cos(down), across - weight * np.sin(down)
        return Pull(along, across)

    def of_spring(self, force: Value, direction: Value) -> Pull:
        """Force on the arm by its spring, N; at the reference point against its travel where the
        pivot has no `spring`.

        Parameters
        ----------
        force : array (...)       of the spring, reduced to the reference point, N
        direction : array (...)   of travel of the reference point, rad, see `_lift`
        """
        if self.spring is None:
            return Pull(np.asarray(-force), np.asarray(0.0 * force))
        lift = np.asarray(self._lift(direction))
        along_arm, outwards = self.spring.pull_on_arm(np.asarray(force), lift)
        return Pull(outwards, -self.sense * along_arm)

    def of_output(self, direction: Value, velocity: Value, acceleration: Value) -> Pull:
        """Force on the arm by the output of a rocker, inertia of the output included, N; zero
        without an output.

        Parameters
        ----------
        direction : array (...)                of travel of the reference point, rad, see
                                               `_lift`
        velocity, acceleration : array (...)   of the reference point, m/s, m/s2
        """
        if self.output is None:
            return Pull(np.asarray(0.0 * direction), np.asarray(0.0 * direction))
        lift = np.asarray(self._lift(direction))
        force = np.asarray(self.output.push(lift, velocity, acceleration))
        along_arm, outwards = self.output.rocker.push_on_arm(force, lift, self.output.arm_length)
        return Pull(outwards, -self.sense * along_arm)

    def _lift(self, direction: Value) -> Value:
        """Lift of the reference point, m, at which it travels in a direction, rad."""
        return self.length * (_QUARTER_TURN - self.start - self.sense * direction)

    def locking(self, pressed: Pressed) -> Array:
        """Moment of the friction under a contact force alone over that of its axial force (...).

        Radius of the friction circle times the contact force, over the length times the axial one.
        """
        circle = self.friction * self.radius
        return np.asarray(circle / self.length * _size((pressed.along, pressed.across)))

    def balanced(
        self, required: Array, pressed: Pressed, pull: Pull, direction: Value
    ) -> PivotBalance:
        """Equilibrium of the moments about the pivot, with its friction, which depends on the
        unknown axial force.

        With F the force without friction, g the contact force over the axial one, e the share that
        the friction of a face leaves, Q the pull and k = mu r/l the axial force x fulfils e x - F =
        d k |x g + Q|: squared, a quadratic equation whose root is on the side of F to which the
        friction acts.

        Parameters
        ----------
        required : array (..., n)    F, N
        pressed : Pressed            g and e
        pull : Pull                  Q of all forces but the contact, N
        direction : array (..., n)   d, 1 on the rise, -1 on the return, 0 at rest
        """
        k = self.friction * self.radius / self.length
        signed, left = direction * k, pressed.share
        along, across = pressed.total(required, Pull(left * pull.along, left * pull.across))
        twist = pressed.along * pull.across - pressed.across * pull.along
        root = along**2 + across**2 - (signed * twist) ** 2
        root = np.sqrt(np.where(np.real(root) > 0.0, root, 0.0 * root))
        inwards = pressed.along * pull.along + pressed.across * pull.across
        middle = left * required + signed**2 * inwards
        size = pressed.along**2 + pressed.across**2
        axial = (middle + signed * root) / (left**2 - signed**2 * size)
        load = pressed.total(axial, pull)
        rubbed, push = k * _size(load), magnitude(axial)
        held = np.where(np.real(push) < _LEAST_FORCE, _LEAST_FORCE, push)
        return PivotBalance(axial, *load, rubbed, rubbed / held)

    def clipped(
        self, required: Array, pressed: Pressed, pull: Pull, direction: Array, least: float
    ) -> PivotBalance:
        """Equilibrium as by `balanced` on a cam that only pushes, with the axial force between zero
        and a bound; real arrays (..., n).

        The axial force is zero where no positive force is required or the friction holds the arm
        off the cam; where the arm locks it is the bound.

        Parameters
        ----------
        required : array (..., n)    axial force without friction, N
        pull : Pull                  of all forces but the contact, N
        direction : array (..., n)   1 on the rise, -1 on the return, 0 at rest
        least : float                least ratio of the required to the axial force; the bound is
                                     required / least
        """
        free = self.balanced(required, pressed, pull, direction)
        most, rises = required / least, direction > 0.0
        # the root of an arm that locks is negative
        locks = (free.axial < 0.0) & (rises | (pressed.share <= 0.0))
        axial = np.where(locks | (free.axial > most), most, np.maximum(free.axial, 0.0))
        axial = np.where(required > 0.0, axial, 0.0)
        rubbed = np.abs(pressed.share * axial - required)
        friction = np.where((axial > 0.0) & (direction != 0.0), rubbed, 0.0)
        return PivotBalance(axial, *pressed.total(axial, pull), friction, free.jam_index)

    def between(
        self, required: Array, pressed: tuple[Pressed, Pressed], pull: Pull, direction: Array
    ) -> tuple[PivotBalance, Array]:
        """Equilibrium as by `balanced` on the track of two that carries, and which one does: 1 the
        first, which pushes, -1 the second.

        Where the friction alone holds the arm, neither track is pressed. The jam index is
        that of the contact force alone, of which an arm locks at 1: that of the whole load has a
        pole where the axial force changes its sign.

        Parameters
        ----------
        required : array (..., n)    axial force without friction, N
        pressed : pair               of the first and of the second track
        pull : Pull                  of all forces but the contact, N
        direction : array (..., n)   1 on the rise, -1 on the return, 0 at rest
        """
        pushed, pulled = (self.balanced(required, one, pull, direction) for one in pressed)
        first = np.real(pushed.axial) > 0.0
        back = np.where(np.real(pulled.axial) < 0.0, pulled.axial, 0.0 * pulled.axial)
        wall, axial = np.where(first, 1.0, -1.0), np.where(first, pushed.axial, back)
        one = Pressed(*(np.where(first, *pair) for pair in zip(*pressed, strict=True)))
        rubbed = np.where(direction == 0.0, 0.0, magnitude(one.share * axial - required))
        return PivotBalance(axial, *one.total(axial, pull), rubbed, self._locking(one)), wall

    def _locking(self, pressed: Pressed) -> Array:
        """Friction of the contact force alone over the axial force."""
        size: Array = _size((pressed.along, pressed.across))
        return self.friction * self.radius / self.length * size

    def squeezed(
        self,
        required: Array,
        pressed: tuple[Pressed, Pressed],
        squeeze: Squeezed,
        pull: Pull,
        direction: Array,
    ) -> tuple[PivotBalance, Array]:
        """Equilibrium as by `between` with both tracks under a preload, which presses the pivot.

        A pair of forces P on both tracks has no moment; the share b of the axial force is borne by
        the first, the rest by the second.
        """
        first, second = pressed
        share, force = squeeze.share, squeeze.preload
        mixed = Pressed(
            *(share * a + (1.0 - share) * b for a, b in zip(first[:2], second[:2], strict=True))
        )
        both = Pull(
            pull.along + force * (first.along - second.along),
            pull.across + force * (first.across - second.across),
        )
        held = self.balanced(required, mixed, both, direction)
        alone, _ = self.between(required, pressed, pull, direction)
        pair = squeeze.both(held.axial)
        chosen = (np.where(pair, *each) for each in zip(held, alone, strict=True))
        balance = PivotBalance(*chosen)
        still = np.where(direction == 0.0, 0.0, balance.friction)
        jam = np.where(pair, self._locking(mixed), alone.jam_index)
        return balance._replace(friction=still, jam_index=jam), np.where(
            np.real(balance.axial) < 0.0, -1.0, 1.0
        )


def _size(vector: tuple[Array, Array]) -> Array:
    """Size of a vector (..., n), real or complex."""
    square = vector[0] ** 2 + vector[1] ** 2
    some = np.real(square) > 0.0
    return np.where(some, np.sqrt(np.where(some, square, 1.0)), 0.0 * square)


FRICTION = "follower.pivot.friction"
"""Key of the friction of the pivot, of a bush or a needle bearing."""


def arm_pivot(
    at: Callable[[str], Value | None], sense: float, output: RockerOutput | None = None
) -> ArmPivot | None:
    """Pivot of an arm from numbers by dotted key; None if its friction is not stated.

    Parameters
    ----------
    at : callable           dotted key -> number, SI; None where the case omits it
    sense : float           w of the arm, see `Arm`
    output : RockerOutput   of a second arm; None: none
    """

    def stated(key: str, default: Value) -> Value:
        value = at(key)
        return default if value is None else value

    def number(key: str) -> Value:
        return stated(key, np.nan)

    friction = at(FRICTION)
    if friction is None:
        return None
    length = number("follower.arm.length")
    beyond = 0.0 if output is None else output.reduced_mass
    arm = Arm(number("follower.arm.centre_distance"), length, sense)
    return ArmPivot(
        length=length,
        sense=sense,
        start=arm.start_angle(number("cam.prime_radius"), at("follower.face.offset")),
        radius=0.5 * number("follower.pivot.diameter"),
        friction=friction,
        mass=stated("follower.pivot.swinging_mass", number("follower.mass") - beyond),
        mass_distance=stated("follower.pivot.mass_distance", length),
        mass_angle=stated("follower.pivot.mass_angle", 0.0),
        gravity_angle=at("follower.pivot.gravity_angle"),
        load_distance=stated("follower.pivot.load_distance", length),
        load_angle=stated("follower.pivot.load_angle", 0.0),
        load_moment=stated("follower.pivot.load_moment", 0.0),
        output=output,
    )
