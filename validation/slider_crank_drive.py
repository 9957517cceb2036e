"""Slider-crank and eccentric cam with roller: forces, friction energy, reduced inertia.

Signs, roots and fractions of the equations are not legible in the source; they are derived from
the mechanics and tested by power balance.

References
----------
Energy loss comparison between kinematically equivalent mechanisms: slider-crank and eccentric cam
(2024), equations 1 to 51, cited by number.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze, uniform_turn
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError

POSITIONS = 720


@dataclass(frozen=True)
class PairFriction:
    """Viscous friction of the pairs: shaft O, pins A and B (N m s/rad), guide (N s/m)."""

    shaft: float
    pin_a: float
    pin_b: float
    guide: float

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"friction.{name}", getattr(self, name), ">= 0")


@dataclass(frozen=True)
class Masses:
    """Masses, kg, and inertias about the own centres, kg m^2; centre of the rod at its middle.

    common: inertia about the shaft of the parts that both mechanisms share.
    """

    slider: float
    rod: float = 0.0
    rod_inertia: float = 0.0
    roller: float = 0.0
    roller_inertia: float = 0.0
    disc: float = 0.0
    disc_inertia: float = 0.0
    common: float = 0.0

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"masses.{name}", getattr(self, name), ">= 0")


@dataclass(frozen=True)
class HoldingSpring:
    """Spring force preload + rate (d - minimum d), N (eqs 38 and 39)."""

    preload: float
    rate: float

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"spring.{name}", getattr(self, name), ">= 0")


@dataclass(frozen=True, eq=False)
class Reactions:
    """Forces over one turn, arrays (n,), SI, in the axes of the source.

    o, a, b (2, n): on the crank at O and A, on the slider at B as in eqs 5 to 12; for the cam `a`
    is the contact force on the disc. normal and traction of the contact, zero for the slider-crank;
    side: force of the guide; motor: torque T_m.
    """

    phi: Array
    o: Array
    a: Array
    b: Array
    normal: Array
    traction: Array
    side: Array
    motor: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})


@dataclass(frozen=True)
class Losses:
    """Energy of one turn by pair, J (eqs 18 and 40)."""

    shaft: float
    guide: float
    pin_a: float
    pin_b: float
    sliding: float = 0.0

    @property
    def total(self) -> float:
        """Energy of all viscous pairs and of sliding, J."""
        return self.shaft + self.guide + self.pin_a + self.pin_b + self.sliding


@dataclass(frozen=True)
class SliderCrankDrive:
    """Slider-crank: balanced crank, rod with its centre in the middle, slider."""

    linkage: Eccentric
    friction: PairFriction
    masses: Masses
    spring: HoldingSpring

    def losses(self, speed: float, count: int = POSITIONS) -> Losses:
        """Viscous friction energy of a turn at constant speed (rad/s), by pair (eq. 18)."""
        phi, c = uniform_turn(count), self.friction
        spin = self.linkage.rod_rate(phi)
        return Losses(
            shaft=_turn_loss(np.full(count, c.shaft), speed),
            guide=_turn_loss(c.guide * self.linkage.height_rate(phi) ** 2, speed),
            pin_a=_turn_loss(c.pin_a * (1.0 - spin) ** 2, speed),
            pin_b=_turn_loss(c.pin_b * spin**2, speed),
        )

    def reduced_inertia(self, phi: Array) -> Array:
        """Reduced inertia about the shaft (eq. 49), kg m^2."""
        l1, angle = self.linkage.crank, self.linkage.rod_angle(phi)
        sin, cos = np.sin(phi), np.cos(angle)
        middle = 1.0 - sin / cos * np.sin(phi - angle) + 0.25 * sin**2 / cos**2
        turned = self.masses.rod_inertia / self.linkage.rod**2 * sin**2 / cos**2
        pushed = self.masses.slider * np.cos(phi - angle) ** 2 / cos**2
        total = self.masses.rod * middle + turned + pushed
        return np.asarray(self.masses.common + l1**2 * total)

    def reactions(self, phi: Array, speed: float, acceleration: float = 0.0) -> Reactions:
        """Newton-Euler equations of slider, rod and balanced crank (eqs 5 to 12)."""
        linkage, c, m = self.linkage, self.friction, self.masses
        l1, l2 = linkage.crank, linkage.rod
        angle = linkage.rod_angle(phi)
        spin = linkage.rod_rate(phi) * speed
        spin_up = linkage.rod_rate_slope(phi) * speed**2 + linkage.rod_rate(phi) * acceleration
        way = linkage.height_rate(phi) * speed
        pull = linkage.height_rate_slope(phi) * speed**2
        pull = pull + linkage.height_rate(phi) * acceleration
        sin1, cos1, sin2, cos2 = np.sin(phi), np.cos(phi), np.sin(angle), np.cos(angle)

        # eqs 8 and 9: acceleration of the middle of the rod
        x = acceleration * l1 * cos1 - speed**2 * l1 * sin1
        x = m.rod * (x - 0.5 * l2 * (spin_up * sin2 + spin**2 * cos2))
        y = acceleration * l1 * sin1 + speed**2 * l1 * cos1
        y = m.rod * (y + 0.5 * l2 * (spin_up * cos2 - spin**2 * sin2))
        torque_a, torque_b = c.pin_a * (speed - spin), c.pin_b * spin

        b_x = -c.guide * way - holding_force(self.spring, linkage, phi) - m.slider * pull
        a_x = b_x - x
        # eq. 10 with R_yA = R_yB - y
        turning = m.rod_inertia * spin_up - torque_a + torque_b
        b_y = 0.5 * (y + (2.0 * turning / l2 + (a_x + b_x) * sin2) / cos2)
        a_y = b_y - y
        motor = m.common * acceleration + c.shaft * speed + torque_a
        motor = motor - l1 * (a_x * cos1 + a_y * sin1)
        zero = np.zeros_like(phi)
        a = np.stack([a_x, a_y])
        return Reactions(phi, -a, a, np.stack([b_x, b_y]), zero, zero, b_y, motor)


@dataclass(frozen=True)
class EccentricDrive:
    """Eccentric cam with a roller on a slider, rolling without slip."""

    linkage: Eccentric
    roller_radius: float
    friction: PairFriction
    masses: Masses
    spring: HoldingSpring

    def __post_init__(self) -> None:
        if not 0.0 < self.roller_radius < self.linkage.rod:
            limit = f"> 0 m and < {self.linkage.rod:g} m, the pitch radius"
            raise InputError("roller.radius", self.roller_radius, limit)

    def rolling_way(self, phi: Array) -> Array:
        """Rolling distance |I13 J| per radian (eq. 35), m/rad."""
        side = self.linkage.height_rate(phi) - self.linkage.offset
        return np.asarray(np.hypot(self.linkage.height(phi), side) - self.roller_radius)

    def rolling_way_slope(self, phi: Array) -> Array:
        """Derivative of the rolling distance by the angle (in eq. 37), m/rad^2."""
        d, d1 = self.linkage.height(phi), self.linkage.height_rate(phi)
        side = d1 - self.linkage.offset
        rate_slope = self.linkage.height_rate_slope(phi)
        return np.asarray((d * d1 + side * rate_slope) / np.hypot(d, side))

    def losses(self, speed: float, count: int = POSITIONS) -> Losses:
        """Viscous friction energy of a turn at constant speed (rad/s), without slip (eq. 40)."""
        phi, c = uniform_turn(count), self.friction
        spin = self.rolling_way(phi) / self.roller_radius
        return Losses(
            shaft=_turn_loss(np.full(count, c.shaft), speed),
            guide=_turn_loss(c.guide * self.linkage.height_rate(phi) ** 2, speed),
            pin_a=0.0,
            pin_b=_turn_loss(c.pin_b * spin**2, speed),
        )

    def reduced_inertia(self, phi: Array) -> Array:
        """Reduced inertia about the shaft (eqs 50 and 51), kg m^2."""
        m, spin = self.masses, self.rolling_way(phi) / self.roller_radius
        pushed = (m.roller + m.slider) * self.linkage.height_rate(phi) ** 2
        own = m.common + m.disc_inertia + m.disc * self.linkage.crank**2
        return np.asarray(own + m.roller_inertia * spin**2 + pushed)

    def reactions(self, phi: Array, speed: float, acceleration: float = 0.0) -> Reactions:
        """Newton-Euler equations of slider, roller and disc (eqs 25 to 31), without slip."""
        way, c, m = self.rolling_way(phi), self.friction, self.masses
        spin = way * speed / self.roller_radius
        spin_up = (self.rolling_way_slope(phi) * speed**2 + way * acceleration) / self.roller_radius
        traction = (c.pin_b * spin + m.roller_inertia * spin_up) / self.roller_radius
        return self._with_traction(phi, speed, acceleration, traction)

    def push(self, phi: Array, speed: float, acceleration: float = 0.0) -> Array:
        """Axial force on the cam by slider, roller, guide and spring, N."""
        d1, d2 = self.linkage.height_rate(phi), self.linkage.height_rate_slope(phi)
        inertia = (self.masses.slider + self.masses.roller) * (d2 * speed**2 + d1 * acceleration)
        held = holding_force(self.spring, self.linkage, phi)
        return np.asarray(inertia + self.friction.guide * d1 * speed + held)

    def _with_traction(
        self, phi: Array, speed: float, acceleration: float, traction: Array
    ) -> Reactions:
        linkage, m, r = self.linkage, self.masses, self.roller_radius
        angle, d, offset = linkage.rod_angle(phi), linkage.height(phi), linkage.offset
        sin2, cos2 = np.sin(angle), np.cos(angle)
        normal = (self.push(phi, speed, acceleration) + traction * sin2) / cos2
        on_roller = np.stack([normal * cos2 - traction * sin2, normal * sin2 + traction * cos2])
        d1, d2 = linkage.height_rate(phi), linkage.height_rate_slope(phi)
        b_x = m.roller * (d2 * speed**2 + d1 * acceleration) - on_roller[0]
        b = np.stack([b_x, -on_roller[1]])
        lever = np.stack([
            acceleration * np.cos(phi) - speed**2 * np.sin(phi),
            acceleration * np.sin(phi) + speed**2 * np.cos(phi),
        ])  # fmt: skip
        o = on_roller + m.disc * linkage.crank * lever
        own = m.common + m.disc_inertia + m.disc * linkage.crank**2
        motor = normal * (d * sin2 + offset * cos2) - traction * (r - d * cos2 + offset * sin2)
        motor = motor + own * acceleration + self.friction.shaft * speed
        return Reactions(phi, o, -on_roller, b, normal, traction, b[1], motor)

    def traction_needed(self, phi: Array, speed: float) -> Array:
        """Traction coefficient |F_t| / F_n of rolling without slip."""
        reactions = self.reactions(phi, speed)
        return np.abs(reactions.traction) / reactions.normal

    def sliding_loss(
        self,
        speed: float,
        friction: float,
        slide_ratio: float,
        normal_force: float | None = None,
        count: int = POSITIONS,
    ) -> float:
        """Creep loss mu F_n SRR v over a turn, J (eqs 41 and 42), with rolling speed v of eq. 35.

        Small against the kinematics without slip and not part of the total. normal_force: mean
        normal force, N; None: that of each angle.
        """
        phi = uniform_turn(count)
        normal = self.reactions(phi, speed).normal if normal_force is None else normal_force
        power = friction * normal * slide_ratio * self.rolling_way(phi) * speed
        return float(np.mean(power) * FULL_TURN / speed)

    def slipping_losses(self, speed: float, friction: float, count: int = POSITIONS) -> Losses:
        """Friction energy of a turn with the traction limited to mu F_n, J.

        The roller rolls within the limit; beyond it mu F_n drives the pin, and the rest of the
        rolling speed is slip. The inertia of the roller is neglected.
        """
        phi, c, r = uniform_turn(count), self.friction, self.roller_radius
        angle, surface = self.linkage.rod_angle(phi), self.rolling_way(phi) * speed
        load = self.push(phi, speed)
        normal = load / (np.cos(angle) - friction * np.sin(angle))
        rolled = surface / r
        spin = rolled if c.pin_b == 0.0 else np.minimum(rolled, friction * normal * r / c.pin_b)
        slid = friction * normal * (surface - spin * r)
        rolling = self.losses(speed, count)
        turn = FULL_TURN / speed
        return Losses(
            shaft=rolling.shaft,
            guide=rolling.guide,
            pin_a=0.0,
            pin_b=float(np.mean(c.pin_b * spin**2) * turn),
            sliding=float(np.mean(slid) * turn),
        )


def stroke_efficiency(drive: SliderCrankDrive | EccentricDrive, speed: float) -> float:
    """Work on the spring over work of the motor on the outward stroke at constant speed."""
    phi = uniform_turn(7200)
    out = drive.linkage.height_rate(phi) > 0.0
    held = holding_force(drive.spring, drive.linkage, phi) * drive.linkage.height_rate(phi)
    return float(np.sum(held[out]) / np.sum(drive.reactions(phi, speed).motor[out]))


@dataclass(frozen=True)
class DryFriction:
    """Dry friction of the pairs: coefficient of the guide; times radius of shaft and pins, m."""

    guide: float = 0.0
    shaft: float = 0.0
    pin_a: float = 0.0
    pin_b: float = 0.0

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"dry_friction.{name}", getattr(self, name), ">= 0")


def dry_losses(drive: SliderCrankDrive | EccentricDrive, speed: float, dry: DryFriction) -> Losses:
    """Dry friction energy of a turn by pair, J: mu |R| times sliding distance.

    With the reactions of the viscous mechanism: their change by dry friction is of second order in
    mu and neglected.
    """
    phi = uniform_turn(POSITIONS)
    reactions, linkage = drive.reactions(phi, speed), drive.linkage
    if isinstance(drive, SliderCrankDrive):
        spin = linkage.rod_rate(phi)
        pin_a = _rubbed(dry.pin_a, reactions.a, 1.0 - spin)
    else:
        spin, pin_a = drive.rolling_way(phi) / drive.roller_radius, 0.0
    return Losses(
        shaft=_rubbed(dry.shaft, reactions.o, np.ones_like(phi)),
        guide=_rubbed(dry.guide, reactions.side[None], linkage.height_rate(phi)),
        pin_a=pin_a,
        pin_b=_rubbed(dry.pin_b, reactions.b, spin),
    )


def _rubbed(friction: float, force: Array, way: Array) -> float:
    """Integral of mu |F| |ds/dphi| over a turn, J; force (1 or 2, n), ds/dphi (n,)."""
    size = np.sqrt(np.sum(force**2, axis=0))
    return float(np.mean(friction * size * np.abs(way)) * FULL_TURN)


def holding_force(spring: HoldingSpring, linkage: Eccentric, phi: Array) -> Array:
    """Spring force (n,), N."""
    travel = linkage.height(phi) - linkage.height_base
    return np.asarray(spring.preload + spring.rate * travel)


def _turn_loss(damping: Array, speed: float) -> float:
    """Energy of a turn, J, of damping coefficients (n,), N m s."""
    if not 0.0 < speed < np.inf:
        raise InputError("speed", speed, "> 0 rad/s")
    return float(np.mean(damping) * speed * FULL_TURN)
