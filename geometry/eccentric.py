"""Eccentric circle as a cam, and the slider-crank of the same motion."""

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
    """Slider-crank, or the eccentric disc whose roller follower has the motion of its slider.

    The disc's centre is the crank pin; its pitch curve has the length of the rod as radius. The
    crank angle phi grows from -y towards +x, the line of the slider.

    Parameters
    ----------
    crank : float     l1, eccentricity, m, > 0
    rod : float       l2, radius of the pitch curve, m, > l1 + |offset|
    offset : float    epsilon, m; the slider moves along y = -epsilon

    Raises
    ------
    InputError
        If the mechanism cannot rotate fully; NaN included.

    References
    ----------
    Energy loss comparison between kinematically equivalent mechanisms (2024), eqs 1-4, 20-24.
    """

    crank: float
    rod: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a mechanism that cannot rotate fully."""
        if not 0.0 < self.crank < np.inf:
            raise InputError("mechanism.crank", self.crank, "> 0 m")
        if not abs(self.offset) < self.rod - self.crank < np.inf:
            limit = f"> {self.crank + abs(self.offset):g} m, crank and offset"
            raise InputError("mechanism.rod", self.rod, limit)

    @property
    def prime_radius(self) -> float:
        """Minimum distance of the roller centre from the axis, l2 - l1, m."""
        return self.rod - self.crank

    @property
    def height_base(self) -> float:
        """Minimum height d, at the dead centre, m."""
        return float(np.sqrt(self.prime_radius**2 - self.offset**2))

    def rod_angle(self, phi: ArrayLike) -> Array:
        """Angle phi_2 of the rod from the slider's line, rad: the pressure angle of the cam."""
        return np.arcsin((self.crank * np.cos(phi) - self.offset) / self.rod)

    def rod_rate(self, phi: ArrayLike) -> Array:
        """First derivative of the rod angle by phi, rad/rad."""
        return -self.crank * np.sin(phi) / (self.rod * np.cos(self.rod_angle(phi)))

    def rod_rate_slope(self, phi: ArrayLike) -> Array:
        """Second derivative of the rod angle by phi, 1/rad."""
        angle, rate = self.rod_angle(phi), self.rod_rate(phi)
        across = self.rod * np.sin(angle) * rate**2 - self.crank * np.cos(phi)
        return np.asarray(across / (self.rod * np.cos(angle)))

    def height(self, phi: ArrayLike) -> Array:
        """Height d = x of the slider or the roller centre along its line, m."""
        return self.crank * np.sin(phi) + self.rod * np.cos(self.rod_angle(phi))

    def height_rate(self, phi: ArrayLike) -> Array:
        """First derivative of the height by phi, m/rad."""
        angle = self.rod_angle(phi)
        return self.crank * np.cos(np.subtract(phi, angle)) / np.cos(angle)

    def height_rate_slope(self, phi: ArrayLike) -> Array:
        """Second derivative of the height by phi, m/rad^2."""
        angle, rate, rod_d2 = self.rod_angle(phi), self.rod_rate(phi), self.rod_rate_slope(phi)
        turning = np.cos(angle) * rate**2 + np.sin(angle) * rod_d2
        return np.asarray(-self.rod * turning - self.crank * np.sin(phi))

    def lift(self, count: int = 720) -> Lift:
        """Lift (count,), m, over the cam angle theta = phi + 90 deg, phi the crank angle: `height`
        less its minimum; without offset zero at theta = 0.
        """
        theta = uniform_turn(count)
        values = self.height(theta - _QUARTER_TURN) - self.height_base
        return Lift(theta, values)


def face_lift(eccentricity: float, count: int = 720) -> Lift:
    """Lift e (1 - cos theta) of a flat face on an eccentric disc.

    Raises
    ------
    InputError
        If the eccentricity (m) is not positive; NaN included.
    """
    positive("lift.eccentricity", eccentricity, "m")
    theta = uniform_turn(count)
    return Lift(theta, eccentricity * (1.0 - np.cos(theta)))
