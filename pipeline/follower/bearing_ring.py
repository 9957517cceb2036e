"""Outer ring of a ball bearing that rolls on the cam, bending on its balls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze
from camwright.geometry.errors import InputError


@dataclass(frozen=True)
class Ring:
    """Thin ring of rectangular section on equal balls.

    Parameters
    ----------
    radius : float            mean radius, m, > 0
    thickness, width : float  m, > 0; the thickness below half the radius
    modulus : float           E, Pa, > 0
    balls : int               >= 3
    ball_stiffness : float    of each ball with its raceways, N/m, > 0
    """

    radius: float
    thickness: float
    width: float
    modulus: float
    balls: int
    ball_stiffness: float

    def __post_init__(self) -> None:
        """Refuse sizes that are not positive, a thick ring and fewer than three balls."""
        for name in ("radius", "thickness", "width", "modulus", "ball_stiffness"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"ring.{name}", getattr(self, name), "> 0")
        if not self.thickness < 0.5 * self.radius:
            raise InputError("ring.thickness", self.thickness, "< half the radius, a thin ring")
        if self.balls < 3:
            raise InputError("ring.balls", self.balls, ">= 3")

    @property
    def bending_stiffness(self) -> float:
        """E I, N m2."""
        return self.modulus * self.width * self.thickness**3 / 12.0

    def stress_inside(self, moment: Array, hoop: Array) -> Array:
        """Circumferential stress at the inner radius (...), Pa, as of a curved bar.

        Parameters
        ----------
        moment : array (...)   N m; positive: the inner radius is in tension
        hoop : array (...)     hoop force, N, tension positive

        References
        ----------
        Winkler and Bach's curved bar; Timoshenko, Strength of Materials II.
        """
        inside, outside = self.radius - 0.5 * self.thickness, self.radius + 0.5 * self.thickness
        area, neutral = self.width * self.thickness, self.thickness / np.log(outside / inside)
        lever = area * (self.radius - neutral) * inside
        return np.asarray(hoop / area + moment * (neutral - inside) / lever)


@dataclass(frozen=True, eq=False)
class RingBending:
    """Bending of a ring per newton of contact force, over ball positions `phase` (n,), rad.

    `ball_load` (n, balls) over contact force, >= 0, first ball at the phase, the others in order;
    `moment_max`, `moment_min` (n,) in the ring, m, positive with tension at the inner radius;
    `stress_max`, `stress_min` (n,) circumferential at the inner radius, Pa/N; `compliance` (n,)
    at the contact force, m/N.
    """

    phase: Array
    ball_load: Array
    moment_max: Array
    moment_min: Array
    stress_max: Array
    stress_min: Array
    compliance: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def stress_amplitude(self) -> float:
        """Stress amplitude of a point of the groove, Pa/N.

        Each point of the ring passes the contact force and the balls: half the range over all
        places and ball positions.
        """
        return 0.5 * float(self.stress_max.max() - self.stress_min.min())

    @property
    def stress_mean(self) -> float:
        """Mean stress of a point of the groove, Pa/N, tension positive."""
        return 0.5 * float(self.stress_max.max() + self.stress_min.min())

    def carrying(self, position: int) -> tuple[float, ...]:
        """Angles of the loaded balls from the contact force, rad, at one ball position."""
        loads = self.ball_load[position]
        angles = self.phase[position] + FULL_TURN * np.arange(loads.size) / loads.size
        return tuple(float(angle) for angle in angles[loads > 0.0])


def goodman(amplitude: Array, mean: Array, tensile_strength: float) -> Array:
    """Goodman's equivalent fully reversed amplitude (...), Pa, of a stress that varies; infinite
    where the mean reaches the tensile strength.

    A compressive mean stress counts as zero; NaN where an input is.

    Parameters
    ----------
    amplitude, mean : arrays (...)   of the stress, Pa
    tensile_strength : float         Pa

    References
    ----------
    Shigley's Mechanical Engineering Design, ch. 6: modified Goodman line.
    """
    left = 1.0 - np.maximum(mean, 0.0) / tensile_strength
    broken = np.where(amplitude > 0.0, np.inf, 0.0)
    broken[np.isnan(amplitude + mean)] = np.nan
    return np.divide(amplitude, left, out=broken, where=left > 0.0)


def ball_stiffness(force: float, diameter: float, modulus: float, poisson: float) -> float:
    """Estimated secant stiffness of a ball between its two raceways, N/m.

    Each contact as ball on flat, d = (9 F^2/(16 E*^2 R))^(1/3), times a factor 1.3 on the stiffness
    for the osculation of the grooves (recalled, verify); the bending of the ring is insensitive to
    it.

    Parameters
    ----------
    force : float      F on the ball, N
    diameter : float   of the ball, m
    modulus : float    Young's modulus of ball and raceways, Pa
    poisson : float    their Poisson's ratio

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 4.2(a); Harris and Kotzalas (2007), ch. 6.
    """
    for name, value in (("force", force), ("diameter", diameter), ("modulus", modulus)):
        if not 0.0 < value < np.inf:
            raise InputError(f"ball.{name}", value, "> 0")
    contact = modulus / (2.0 * (1.0 - poisson**2))
    way = (9.0 * force**2 / (16.0 * contact**2 * 0.5 * diameter)) ** (1.0 / 3.0)
    return float(1.3 * force / (2.0 * way))
