"""The cam of a translating flat-faced follower: contour, curvature and width of the face."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour, Frame, Undercut
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.follower_height import face_height
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve, cam_axes, reciprocal


class FaceTravel(NamedTuple):
    """Least and greatest way of the contact along the face from the stem's axis, m."""

    low: Extremum
    high: Extremum


@dataclass(frozen=True, eq=False)
class FacePath(PitchCurve):
    """Path of the place where a flat face touches the cam, in the cam frame.

    It stands in for the path of a roller's centre, which for a face is infinitely far away. The
    face, square to the follower's way, stands at r + s along u and touches the cam at s' along v.
    The pressure angle is zero; what a roller does by its side force, a face does by the moment
    of a push off the stem's axis.

    Parameters
    ----------
    lift : Lift            s(theta)
    base_radius : float    r, of the cam's base circle, m, > 0
    offset : float         e, from the stem's axis to the cam's along v, m, |e| < r

    Raises
    ------
    InputError
        If the base radius is not positive or the offset not below it; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: flat-faced followers.
    """

    @property
    def height_base(self) -> float:
        return self.base_radius

    def moved(self, lift: Lift, height_base: float) -> Self:
        return replace(self, lift=lift, base_radius=height_base)

    def radius(self, theta: ArrayLike) -> Array:
        """Distance of the contact from the cam axis, m."""
        return np.hypot(self.height(theta), self.lift(theta, 1))

    def points(self, theta: ArrayLike) -> Array:
        """Contact point, (2, ...), m."""
        s, s1 = self.lift.derivatives(theta, 1)
        return cam_axes(theta, self.base_radius + s, s1)

    def tangent(self, theta: ArrayLike) -> Array:
        return np.stack([-np.sin(theta), np.cos(theta)])

    def normal(self, theta: ArrayLike) -> Array:
        return np.stack([np.cos(theta), np.sin(theta)])

    def pressure_angle(self, theta: ArrayLike) -> Array:
        """Zero: the face is square to its way."""
        return np.zeros(np.shape(theta))

    def push_arm(self, theta: ArrayLike) -> Array:
        """Way s' - e from the stem's axis to the line of the cam's push, along v, m."""
        return self.lift(theta, 1) - self.offset

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """r + s + s'', m; zero at a cusp, negative where undercut: a flat face needs it positive.

        It is the way of the contact point per radian too.
        """
        s, _, s2 = self.lift.derivatives(theta, 2)
        return self.base_radius + s + s2

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        radius = self.radius_of_curvature(theta)
        return np.abs(radius), reciprocal(radius)

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        along = self.radius_of_curvature(theta)
        return np.zeros_like(along), along

    def speed(self, theta: ArrayLike) -> Array:
        """Way of the contact along the contour, m/rad, >= 0."""
        return np.abs(self.radius_of_curvature(theta))


@dataclass(frozen=True, eq=False)
class FlatFaceContour(Contour):
    """Cam surface under a flat face: that under a roller whose radius grows beyond all bounds.

    Parameters
    ----------
    pitch : FacePath    lift, base circle and offset of the stem

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: flat-faced followers.
    """

    pitch: FacePath
    roller_radius: float = field(default=np.inf, init=False)

    def __post_init__(self) -> None:
        """Nothing to refuse beyond what the path does: a face fits every base circle."""

    def local_frame(self, theta: ArrayLike) -> Frame:
        return Frame(self.pitch.points(theta), self.normal(theta), self.tangent(theta))

    def speed(self, theta: ArrayLike) -> Array:
        return self.radius_of_curvature(theta)

    def factor(self, theta: ArrayLike) -> Array:
        """Radius of curvature over the height of the face; zero at a cusp, 1 in a dwell."""
        return self.radius_of_curvature(theta) / self.pitch.height(theta)

    def curvature(self, theta: ArrayLike) -> Array:
        return reciprocal(self.radius_of_curvature(theta))

    def curvature_slope(self, theta: ArrayLike) -> Array:
        _, s1, _, s3 = self.pitch.lift.derivatives(theta, 3)
        return -(s1 + s3) * self.curvature(theta) ** 2

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """r + s + s'', m; negative where undercut."""
        return self.pitch.radius_of_curvature(theta)

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        pitch = self.pitch
        return pitch.points(theta), pitch.tangent(theta), pitch.radius_of_curvature(theta)

    def undercut(self) -> Undercut:
        """Whether the envelope of the face turns back: a part of the motion cannot be had."""
        value, theta = least(self.factor, self.pitch.lift.search_count)
        return Undercut(not value > 0, theta, value)

    def _gap(self, contact: Array, other: Array) -> Array:
        return self.pitch.height(contact) - np.sum(self.normal(contact) * self.points(other), 0)

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        return face_height(polygon, theta)

    @property
    def fitting_tool(self) -> float:
        """The base circle's radius, m: on a convex contour any would do."""
        return self.pitch.base_radius

    def concave_radius_min(self) -> Extremum:
        """Infinite: a face rests on convex places alone."""
        return Extremum(np.inf, self.pitch.curvature_min().theta)

    def radius_of_curvature_min(self) -> Extremum:
        """Least radius of curvature, m, between samples too; at or below zero: undercut."""
        return least(self.radius_of_curvature, self.pitch.lift.search_count)

    def face_travel(self) -> FaceTravel:
        """How far the contact wanders on the face, to the extremes of s' - e."""
        count = self.pitch.lift.search_count
        return FaceTravel(least(self.pitch.push_arm, count), greatest(self.pitch.push_arm, count))

    def face_width_min(self, half_width: float = 0.0) -> float:
        """Width that a face centred on the stem needs, m.

        `half_width` (m) is the room for the contact itself at either edge.
        """
        low, high = self.face_travel()
        return 2.0 * (max(high.value, -low.value) + half_width)

    def require_face(self, width: float, half_width: float = 0.0) -> None:
        """Refuse a face that the contact would run off.

        Raises
        ------
        InputError
            If the face is not wider than the travel of the contact asks for.
        """
        needed = self.face_width_min(half_width)
        if not width > needed:
            limit = f"> {needed:.6g} m, twice the greatest |s' - cam.offset|"
            raise InputError("follower.face.width", f"{width:g} m", limit)

    def base_radius_min(self, curvature_radius: float = 0.0) -> float:
        """Least base radius (m) that keeps the radius of curvature at `curvature_radius` (m)."""
        return self.pitch.base_radius + curvature_radius - self.radius_of_curvature_min().value
