"""Pitch curve: path of the roller centre in the cam frame.

Speed and curvature at single angles are functions of real or complex arrays: the checks evaluate
them, and the synthesis differentiates the same functions by a complex step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, Values
from camwright.geometry.errors import GeometryError
from camwright.geometry.follower_height import pulled_height
from camwright.geometry.follower_path import (
    FollowerPath,
    Reaction,
    cam_axes,
    reciprocal,
    require_offset,
)
from camwright.geometry.lift import Jet, Lift


class CentrePath(FollowerPath):
    """Path of the centre of a follower's round surface, in the cam frame."""

    @abstractmethod
    def centre_motion(self, jet: Jet, radius: Value) -> RoundMotion:
        """Motion at the angles of a jet with a roller of a radius, m."""

    def pulled(self, polygon: ArrayLike, radius: float, theta: ArrayLike) -> Array:  # noqa: ARG002
        """Height (m,), m, of a roller of a radius, m, that is pulled against a closed wall around
        it, (2, n), m.

        Raises
        ------
        GeometryError
            If the path is not that of a stem.
        """
        raise GeometryError(f"path = {type(self).__name__}, must be that of a stem")


@dataclass(frozen=True, eq=False, repr=False)
class PitchCurve(CentrePath):
    """Path of the centre of a translating roller follower, in the cam frame.

    The centre is d u + e v with d = sqrt(r^2 - e^2) + s.

    Parameters
    ----------
    lift : Lift            s(theta)
    prime_radius : float   r, of the roller centre at zero lift, m, > 0: base circle and roller
    offset : float         e, from the follower's axis to the cam's, m, |e| < r

    Raises
    ------
    InputError
        If the prime radius is not positive or the offset not below it; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7.
    """

    prime_radius: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        require_offset(self.offset, "prime radius", self.prime_radius)

    @property
    def radius_base(self) -> float:
        return self.prime_radius

    @cached_property
    def height_base(self) -> float:
        return float(np.sqrt(self.prime_radius**2 - self.offset**2))

    def with_lift(self, lift: Lift, height_base: float) -> Self:
        return replace(self, lift=lift, prime_radius=float(np.hypot(height_base, self.offset)))

    def enlarged(self, growth: float) -> Self:
        return replace(self, prime_radius=self.prime_radius + growth)

    def _position(self, theta: ArrayLike) -> tuple[Array, float]:
        return self.height(theta), self.offset

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        s, s1 = self.lift.derivatives(theta, 1)
        return s1 - self.offset, self.height_base + s

    def tangent(self, theta: ArrayLike) -> Array:
        along, across = self._velocity(theta)
        speed = np.hypot(along, across)
        return cam_axes(theta, along / speed, across / speed)

    def normal(self, theta: ArrayLike) -> Array:
        along, across = self._velocity(theta)
        speed = np.hypot(along, across)
        return cam_axes(theta, across / speed, -along / speed)

    def pressure_angle(self, theta: ArrayLike) -> Array:
        along, across = self._velocity(theta)
        return np.arctan2(along, across)

    def push_arm(self, theta: ArrayLike) -> Array:
        """Zero: the contact force passes through the roller centre, on the stem's axis."""
        return np.zeros(np.shape(theta))

    def pulled(self, polygon: ArrayLike, radius: float, theta: ArrayLike) -> Array:
        return pulled_height(polygon, radius, self.offset, theta)

    def centre_motion(self, jet: Jet, radius: Value) -> RollerMotion:
        return RollerMotion(jet, self.height_base, self.offset, radius)

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        s, s1, s2 = self.lift.derivatives(theta, 2)
        return speed_and_curvature(s1 - self.offset, self.height_base + s, s1, s2)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        """Derivative of the curvature by the cam angle, 1/(m rad)."""
        s, s1, s2, s3 = self.lift.derivatives(theta, 3)
        return curvature_slope(s1 - self.offset, self.height_base + s, s1, s2, s3)

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m; infinite at an inflection."""
        return reciprocal(self.curvature(theta))


class RoundMotion(ABC):
    """Kinematics and force ratios of a follower whose surface is round about its reference point.

    See `Motion`. At each angle it is a translating follower of its own height and offset along the
    travel of the reference point, whose line turns with an arm.
    """

    jet: Jet
    size: Value
    """radius of the surface, m"""

    @property
    @abstractmethod
    def rolls(self) -> bool:
        """Whether the surface is that of a roller; otherwise it slides."""

    @property
    @abstractmethod
    def height(self) -> Array:
        """Height of the reference point, m; also its velocity across its travel, m/rad."""

    @property
    @abstractmethod
    def travel_offset(self) -> Value:
        """Offset of the line of travel from the cam axis, m."""

    @property
    @abstractmethod
    def travel(self) -> Value:
        """Direction of travel from the follower axis, counter-clockwise, rad; 0 of a stem."""

    @property
    @abstractmethod
    def sliding(self) -> Value:
        """Torque of the sliding friction on the cam over the axial force, m."""

    @abstractmethod
    def radius_at(self, lift: Value) -> Array:
        """Radius of the contour in a dwell at a lift, m."""

    @property
    @abstractmethod
    def along(self) -> Array:
        """Velocity of the reference point along its travel, s' - e, m/rad."""

    @property
    @abstractmethod
    def _path(self) -> tuple[Array, Array]:
        """Speed, m/rad, and curvature, 1/m, of the path."""

    @property
    @abstractmethod
    def path_curvature_slope(self) -> Array:
        """Derivative of the path's curvature by the cam angle, 1/(m rad)."""

    @property
    @abstractmethod
    def rolling(self) -> Value:
        """Angular speed of a roller relative to the follower over cam speed."""

    @property
    @abstractmethod
    def slide_slope(self) -> Array:
        """Derivative by the cam angle of its surface speed against a follower at rest, m/rad2."""

    @property
    @abstractmethod
    def prime_radius(self) -> Array:
        """Radius of the prime circle, m."""

    @cached_property
    def tangent(self) -> Array:
        """Tangent of the pressure angle."""
        return self.along / self.height

    @property
    def pressure_angle(self) -> Array:
        return np.arctan(self.tangent)

    @property
    def side(self) -> Array:
        return self.tangent

    @property
    def arm(self) -> Array:
        """Zero: the contact force passes through the reference point."""
        return np.zeros(self.jet.slope.shape)

    @property
    def pressing(self) -> Value:
        """One: without friction the axial force is that along the travel."""
        return 1.0

    @property
    def lock(self) -> Value:
        """Zero: without friction none takes a moment."""
        return 0.0

    @property
    def path_speed(self) -> Array:
        """Path length of the reference point per radian, m/rad."""
        return self._path[0]

    @property
    def path_curvature(self) -> Array:
        """Curvature of the path, 1/m, positive where convex."""
        return self._path[1]

    @cached_property
    def sharpness(self) -> Array:
        """Radius of the surface times curvature of the path: 1 at a cusp."""
        return self.size * self.path_curvature

    @cached_property
    def gain(self) -> Array:
        return np.sqrt(1.0 + self.tangent**2)

    @cached_property
    def contact_point(self) -> tuple[Array, Array]:
        return self.inside(self.size)

    def inside(self, distance: Value) -> tuple[Array, Array]:
        """Point at a distance, m, from the path towards the cam, below zero away from it, along and
        across the travel, m.
        """
        inset = distance / self.path_speed
        return self.height * (1.0 - inset), self.travel_offset + inset * self.along

    @property
    def contour_radius(self) -> Array:
        along, across = self.contact_point
        return np.sqrt(along**2 + across**2)

    @property
    def contour_speed(self) -> Array:
        return self.path_speed * (1.0 - self.sharpness)

    @property
    def curvature_slope(self) -> Array:
        """Derivative of the contour's curvature by its arc length, 1/m^2.

        The contour is shorter than the path by the undercut factor, its curvature greater.
        """
        return self.path_curvature_slope / ((1.0 - self.sharpness) ** 3 * self.path_speed)

    def reactions(
        self,
        lever: tuple[Array, Array],
        spacing: Value,  # noqa: ARG002
    ) -> tuple[Reaction, Reaction]:
        """Loads of guides on points by the side force through the reference point.

        An arm has none; those that stand for them are without friction.
        """
        side = magnitude(self.tangent)
        return Reaction(side * lever[0]), Reaction(side * lever[1])


@dataclass(frozen=True, eq=False)
class RollerMotion(RoundMotion):
    """Kinematics and force ratios of a roller on the unloaded cam; see `Motion`.

    Parameters
    ----------
    jet : Jet             lift and its derivatives
    base_height : float   height of the roller centre at zero lift, sqrt(r^2 - e^2)
    offset : float        e
    size : float          roller radius
    """

    jet: Jet
    base_height: Value
    offset: Value
    size: Value

    @property
    def rolls(self) -> bool:
        return True

    @property
    def travel(self) -> float:
        """Zero: along the axis of the stem."""
        return 0.0

    @property
    def travel_offset(self) -> Value:
        return self.offset

    @cached_property
    def along(self) -> Array:
        return self.jet.slope - self.offset

    @cached_property
    def height(self) -> Array:
        return self.base_height + self.jet.lift

    @cached_property
    def _path(self) -> tuple[Array, Array]:
        return speed_and_curvature(self.along, self.height, self.jet.slope, self.jet.lift_d2)

    @property
    def path_curvature_slope(self) -> Array:
        jet = self.jet
        return curvature_slope(self.along, self.height, jet.slope, jet.lift_d2, jet.jerk)

    @property
    def sliding(self) -> float:
        """Zero: the roller rolls."""
        return 0.0

    @property
    def rolling(self) -> Array:
        return rolling_share(self.path_speed, self.size)

    @property
    def slide_slope(self) -> Array:
        stretching = self.along * self.jet.lift_d2 + self.height * self.jet.slope
        return stretching / self.path_speed

    @property
    def prime_radius(self) -> Array:
        height = self.height - self.jet.lift
        return np.sqrt(height**2 + self.offset**2)

    def radius_at(self, lift: Value) -> Array:
        height = self.height - self.jet.lift + lift
        return np.sqrt(height**2 + self.offset**2) - self.size


def rolling_share(pitch_speed: Values, roller_radius: Value) -> Values:
    """Angular speed of the roller relative to the stem over cam speed; path speed in m/rad."""
    return pitch_speed / roller_radius - 1.0


def magnitude(values: Values) -> Values:
    """Absolute value |x| that a complex step differentiates: x times the sign of its real part."""
    return values * np.sign(values.real) if np.iscomplexobj(values) else np.abs(values)


def speed_and_curvature(
    along: Values, across: Values, slope: Values, lift_d2: Values
) -> tuple[Values, Values]:
    """Speed of a path, m/rad, and its curvature, 1/m, positive where convex.

    Parameters
    ----------
    along, across : array (...)   s' - e and d, m/rad and m
    slope, lift_d2 : array (...)     s' and s'', m/rad^k
    """
    speed = np.sqrt(along**2 + across**2)
    turning = along * (along + slope) - across * (lift_d2 - across)
    return speed, turning / speed**3


def curvature_slope(
    along: Values, across: Values, slope: Values, lift_d2: Values, jerk: Values
) -> Values:
    """Derivative of the path's curvature by the cam angle, 1/(m rad).

    Parameters
    ----------
    along, across : array (...)       s' - e and d, m/rad and m
    slope, lift_d2, jerk : array (...)   s', s'', s''', m/rad^k
    """
    square = along**2 + across**2
    turning = along * (along + slope) - across * (lift_d2 - across)
    change = lift_d2 * (3.0 * along + slope) - slope * (lift_d2 - across) - across * (jerk - slope)
    stretching = along * lift_d2 + across * slope
    return (change - 3.0 * turning * stretching / square) / square**1.5
