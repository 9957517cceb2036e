"""The eccentric circle as a cam, and the slider-crank that moves its follower alike."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, positive, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift

_QUARTER_TURN = 0.5 * np.pi


@dataclass(frozen=True)
class Eccentric:
    """A slider-crank, or the eccentric disc whose roller follower moves like its slider.

    The disc's centre is the crank pin, and the radius of its pitch curve the length of the rod.
    The crank angle phi grows from -y towards +x, the line of the slider.

    Parameters
    ----------
    crank : float     l1, eccentricity, m, > 0
    rod : float       l2, radius of the pitch curve, m, > l1 + |offset|
    offset : float    epsilon, m: the slider runs along y = -epsilon

    Raises
    ------
    InputError
        If the mechanism cannot turn over; NaN included.

    References
    ----------
    Energy loss comparison between kinematically equivalent mechanisms (2024), eqs 1-4, 20-24.
    """

    crank: float
    rod: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < self.crank < np.inf:
            raise InputError("mechanism.crank", self.crank, "> 0 m")
        if not abs(self.offset) < self.rod - self.crank < np.inf:
            limit = "> the crank and the offset together"
            raise InputError("mechanism.rod", self.rod, limit)

    @property
    def prime_radius(self) -> float:
        """Least distance of the roller's centre from the axis, m."""
        return self.rod - self.crank

    @property
    def height_base(self) -> float:
        """Least d, at the dead centre, m."""
        return float(np.sqrt(self.prime_radius**2 - self.offset**2))

    def rod_angle(self, phi: ArrayLike) -> Array:
        """phi_2 of the rod from the slider's line, rad; the pressure angle of the cam."""
        return np.arcsin((self.crank * np.cos(phi) - self.offset) / self.rod)

    def rod_rate(self, phi: ArrayLike) -> Array:
        """d phi_2 / d phi."""
        return -self.crank * np.sin(phi) / (self.rod * np.cos(self.rod_angle(phi)))

    def rod_rate_slope(self, phi: ArrayLike) -> Array:
        """d2 phi_2 / d phi2, 1/rad."""
        angle, rate = self.rod_angle(phi), self.rod_rate(phi)
        across = self.rod * np.sin(angle) * rate**2 - self.crank * np.cos(phi)
        return np.asarray(across / (self.rod * np.cos(angle)))

    def height(self, phi: ArrayLike) -> Array:
        """d = x, of the slider or the roller's centre along the line, m."""
        return self.crank * np.sin(phi) + self.rod * np.cos(self.rod_angle(phi))

    def height_rate(self, phi: ArrayLike) -> Array:
        """d', m/rad."""
        angle = self.rod_angle(phi)
        return self.crank * np.cos(np.subtract(phi, angle)) / np.cos(angle)

    def height_rate_slope(self, phi: ArrayLike) -> Array:
        """d'', m/rad^2."""
        angle, rate, bend = self.rod_angle(phi), self.rod_rate(phi), self.rod_rate_slope(phi)
        turning = np.cos(angle) * rate**2 + np.sin(angle) * bend
        return np.asarray(-self.rod * turning - self.crank * np.sin(phi))

    def lift(self, count: int = 720) -> Lift:
        """s = d - least d, against theta = phi + 90 deg: without offset lowest at theta = 0."""
        theta = uniform_turn(count)
        values = self.height(theta - _QUARTER_TURN) - self.height_base
        return Lift(theta, values)


def face_lift(eccentricity: float, count: int = 720) -> Lift:
    """Lift e (1 - cos theta) of a flat face on a disc that turns about a place off its centre.

    Raises
    ------
    InputError
        If the eccentricity (m) is not positive; NaN included.
    """
    positive("lift.eccentricity", eccentricity, "m")
    theta = uniform_turn(count)
    return Lift(theta, eccentricity * (1.0 - np.cos(theta)))
