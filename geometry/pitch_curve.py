"""Pitch curve: the path of the roller centre in the cam frame.

Its speed and curvature at single places are functions that a complex step passes through, so
that the checks and the synthesis, which differentiates them, use the same formulas.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, positive
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.lift import Lift

Values = Any
"""Real, or complex while a derivative is taken by a complex step."""


@dataclass(frozen=True, eq=False)
class PitchCurve:
    """Path of the centre of a translating roller follower, seen from the cam.

    With u = (cos theta, sin theta) and v = (-sin theta, cos theta) the centre is d u + e v,
    d = sqrt(r^2 - e^2) + s. Angles grow counter-clockwise. The angle is that of the follower's
    axis in the cam frame, which with an offset is not the polar angle of the centre.

    Parameters
    ----------
    lift : Lift            s(theta)
    base_radius : float    r, radius of the roller centre at zero lift, m, > 0
    offset : float         e, from the follower's axis to the cam's, m, |e| < r

    Raises
    ------
    InputError
        If the base radius is not positive or the offset not below it; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7.
    """

    lift: Lift
    base_radius: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        positive("cam.pitch_base_radius", self.base_radius, "m")
        if not abs(self.offset) < self.base_radius:
            limit = f"below the base radius of {self.base_radius:g} m"
            raise InputError("cam.offset", self.offset, limit)

    @property
    def height_base(self) -> float:
        """d at zero lift, m."""
        return float(np.sqrt(self.base_radius**2 - self.offset**2))

    def moved(self, lift: Lift, height_base: float) -> Self:
        """The path under another lift, from another height d (m) at zero lift."""
        return replace(self, lift=lift, base_radius=float(np.hypot(height_base, self.offset)))

    def height(self, theta: ArrayLike) -> Array:
        """d, distance of the roller centre from the cam axis along the follower, m."""
        return self.height_base + self.lift(theta)

    def radius(self, theta: ArrayLike) -> Array:
        """Distance of the roller centre from the cam axis, m."""
        return np.hypot(self.height(theta), self.offset)

    def points(self, theta: ArrayLike) -> Array:
        """Roller centre, (2, ...), m."""
        return cam_axes(theta, self.height(theta), self.offset)

    def velocity(self, theta: ArrayLike) -> Array:
        """Derivative of the roller centre by the angle, (2, ...), m/rad."""
        along, across = self._velocity(theta)
        return cam_axes(theta, along, across)

    def speed(self, theta: ArrayLike) -> Array:
        """Length of the path a radian of cam angle, m/rad."""
        along, across = self._velocity(theta)
        return np.hypot(along, across)

    def tangent(self, theta: ArrayLike) -> Array:
        """Unit tangent, counter-clockwise, (2, ...)."""
        along, across = self._velocity(theta)
        speed = np.hypot(along, across)
        return cam_axes(theta, along / speed, across / speed)

    def normal(self, theta: ArrayLike) -> Array:
        """Outward unit normal, (2, ...), common to the pitch curve and the contour."""
        along, across = self._velocity(theta)
        speed = np.hypot(along, across)
        return cam_axes(theta, across / speed, -along / speed)

    def pressure_angle(self, theta: ArrayLike) -> Array:
        """Angle from the follower's axis to the contact normal, rad, positive on the rise."""
        along, across = self._velocity(theta)
        return np.arctan2(along, across)

    def push_arm(self, theta: ArrayLike) -> Array:
        """Way from the stem's axis to the line of the cam's push, m: none through a roller."""
        return np.zeros(np.shape(theta))

    def curvature(self, theta: ArrayLike) -> Array:
        """Signed curvature, 1/m, positive where convex."""
        return self.speed_and_curvature(theta)[1]

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Speed, m/rad, and curvature, 1/m, for the price of one."""
        s, s1, s2 = self.lift.derivatives(theta, 2)
        return speed_and_curvature(s1 - self.offset, self.height_base + s, s1, s2)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        """Change of the curvature per radian of cam angle, 1/(m rad)."""
        s, s1, s2, s3 = self.lift.derivatives(theta, 3)
        return curvature_slope(s1 - self.offset, self.height_base + s, s1, s2, s3)

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m; infinite at an inflection."""
        return reciprocal(self.curvature(theta))

    def pressure_angle_max(self) -> Extremum:
        """Greatest pressure angle of either sign, rad >= 0, and its cam angle."""
        return greatest(lambda theta: np.abs(self.pressure_angle(theta)), self.lift.search_count)

    def curvature_max(self) -> Extremum:
        """Greatest signed curvature, 1/m, and its cam angle: the sharpest convex place."""
        return greatest(self.curvature, self.lift.search_count)

    def curvature_min(self) -> Extremum:
        """Least signed curvature, 1/m, and its cam angle: negative where the flank is hollow."""
        return least(self.curvature, self.lift.search_count)

    def least_convex_radius(self) -> Extremum:
        """Least radius of curvature of the convex parts, m, and its cam angle."""
        curvature, theta = self.curvature_max()
        return Extremum(1.0 / curvature, theta)

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Derivative of the centre along and across the follower, m/rad."""
        s, s1 = self.lift.derivatives(theta, 1)
        return s1 - self.offset, self.height_base + s


def cam_axes(theta: ArrayLike, along: Array, across: Array | float) -> Array:
    """A vector given along and across the follower, (2, ...) in the cam frame."""
    cos, sin = np.cos(theta), np.sin(theta)
    return np.stack([along * cos - across * sin, along * sin + across * cos])


def reciprocal(values: Array) -> Array:
    """1 / values, positive infinity where they are zero."""
    return np.divide(1.0, values, out=np.full_like(values, np.inf), where=values != 0)


def magnitude(values: Values) -> Values:
    """|x| of the real part, its sign put to the whole, so that a complex step passes through."""
    return values * np.sign(np.real(values))


def speed_and_curvature(
    along: Values, across: Values, slope: Values, bend: Values
) -> tuple[Values, Values]:
    """Length of the path per radian, m, and its curvature, 1/m, positive where convex.

    Parameters
    ----------
    along, across : array (...)   s' - e and d, m/rad and m
    slope, bend : array (...)     s' and s'', m/rad^k
    """
    speed = np.sqrt(along**2 + across**2)
    turning = along * (along + slope) - across * (bend - across)
    return speed, turning / speed**3


def curvature_slope(
    along: Values, across: Values, slope: Values, bend: Values, jerk: Values
) -> Values:
    """Change of the path's curvature per radian of cam angle, 1/(m rad).

    Parameters
    ----------
    along, across : array (...)       s' - e and d, m/rad and m
    slope, bend, jerk : array (...)   s', s'', s''', m/rad^k
    """
    square = along**2 + across**2
    turning = along * (along + slope) - across * (bend - across)
    change = bend * (3.0 * along + slope) - slope * (bend - across) - across * (jerk - slope)
    stretching = along * bend + across * slope
    return (change - 3.0 * turning * stretching / square) / square**1.5
