"""The cam of a translating flat-faced follower: contour, curvature and width of the face."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from geometry.arrays import Array, positive, readonly, uniform_turn
from geometry.errors import InputError
from geometry.extrema import Extremum, greatest, least
from geometry.interference import crossings
from geometry.lift import Lift
from geometry.pitch_curve import cam_axes, reciprocal


class FaceTravel(NamedTuple):
    """Least and greatest way of the contact along the face from the follower's axis, m."""

    low: Extremum
    high: Extremum


@dataclass(frozen=True, eq=False)
class FlatFaceContour:
    """Cam surface under a flat face square to the follower's way.

    With u = (cos theta, sin theta) and v = (-sin theta, cos theta) the face stands at r + s along
    u, and touches the cam at s' along v. The pressure angle is zero at every angle; what a
    roller does by its side force the face does by the moment of a push off the axis.

    Parameters
    ----------
    lift : Lift            s(theta)
    base_radius : float    r, of the cam's base circle, m, > 0

    Raises
    ------
    InputError
        If the base radius is not positive; NaN included. An undercut is a result, not an error.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: flat-faced followers.
    """

    lift: Lift
    base_radius: float

    def __post_init__(self) -> None:
        positive("cam.base_radius", self.base_radius, "m")

    def height(self, theta: ArrayLike) -> Array:
        """Distance of the face from the cam axis, m."""
        return self.base_radius + self.lift(theta)

    def points(self, theta: ArrayLike) -> Array:
        """Contact point in the cam frame, (2, ...), m."""
        s, s1 = self.lift.derivatives(theta, 1)
        return cam_axes(theta, self.base_radius + s, s1)

    def normal(self, theta: ArrayLike) -> Array:
        """Outward unit normal, (2, ...): the follower's axis."""
        return np.stack([np.cos(theta), np.sin(theta)])

    def tangent(self, theta: ArrayLike) -> Array:
        """Unit tangent, counter-clockwise, (2, ...)."""
        return np.stack([-np.sin(theta), np.cos(theta)])

    def velocity(self, theta: ArrayLike) -> Array:
        """Derivative of the contact point by the angle, (2, ...), m/rad."""
        return self.radius_of_curvature(theta) * self.tangent(theta)

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """r + s + s'', m; zero at a cusp, negative where undercut: a flat face needs it positive.

        It is the way of the contact point per radian too.
        """
        s, _, s2 = self.lift.derivatives(theta, 2)
        return self.base_radius + s + s2

    def curvature(self, theta: ArrayLike) -> Array:
        """Signed curvature, 1/m."""
        return reciprocal(self.radius_of_curvature(theta))

    def radius(self, theta: ArrayLike) -> Array:
        """Distance of the contact point from the cam axis, m."""
        return np.hypot(*self.points(theta))

    def radius_of_curvature_min(self) -> Extremum:
        """Least radius of curvature, m, between samples too; at or below zero: undercut."""
        return least(self.radius_of_curvature, self.lift.search_count)

    def undercut(self) -> bool:
        """Whether the envelope of the face turns back: a part of the motion cannot be had."""
        return not self.radius_of_curvature_min().value > 0

    def self_intersections(self) -> tuple[tuple[float, float], ...]:
        """Pairs of cam angles, rad, at which the contour passes through the same point."""
        return self._crossings

    @cached_property
    def _crossings(self) -> tuple[tuple[float, float], ...]:
        return crossings(
            self.points, self.velocity, self.radius_of_curvature, self.lift.search_count
        )

    def face_travel(self) -> FaceTravel:
        """How far the contact wanders on the face, to the extremes of s'."""

        def slope(theta: Array) -> Array:
            return self.lift(theta, 1)

        count = self.lift.search_count
        return FaceTravel(least(slope, count), greatest(slope, count))

    def face_width_min(self, half_width: float = 0.0, face_offset: float = 0.0) -> float:
        """Width that a face centred `face_offset` (m) from the axis needs, m.

        `half_width` (m) is the room for the contact itself at either edge.
        """
        low, high = self.face_travel()
        reach = max(high.value - face_offset, face_offset - low.value)
        return 2.0 * (reach + half_width)

    def require_face(self, width: float, half_width: float = 0.0, face_offset: float = 0.0) -> None:
        """Refuse a face that the contact would run off.

        Raises
        ------
        InputError
            If the face is narrower than the travel of the contact asks for.
        """
        needed = self.face_width_min(half_width, face_offset)
        if not width >= needed:
            limit = f">= {needed:.6g} m, twice the greatest |s'|"
            raise InputError("follower.face_width", width, limit)

    def base_radius_min(self, curvature_radius: float = 0.0) -> float:
        """Least base radius (m) that keeps the radius of curvature at `curvature_radius` (m)."""
        return self.base_radius + curvature_radius - self.radius_of_curvature_min().value

    def polygon(self, count: int) -> Array:
        """`count` contour points at equal steps of the cam angle, (2, count), m."""
        return readonly(self.points(uniform_turn(count)))
