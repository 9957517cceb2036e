"""The cam of a translating flat-faced follower: contour, curvature and width of the face."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value
from camwright.geometry.contour import Contour, Frame, Undercut
from camwright.geometry.errors import InputError, in_millimetres
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.follower_height import face_height
from camwright.geometry.follower_path import (
    FollowerPath,
    Reaction,
    Slide,
    Sliding,
    reciprocal,
    require_offset,
)
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import magnitude

OF_STEM = "|s' - cam.offset|"
"""Distance of the contact from the middle of a face on a stem, in words."""


@dataclass(frozen=True, eq=False, repr=False)
class FacePath(FollowerPath):
    """Path of the contact point on a translating flat face, in the cam frame.

    The face, square to the stem, stands at r + s along u and touches the cam at s' along v. The
    pressure angle is zero; the contact force bends the stem by its lever arm instead.

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

    base_radius: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        require_offset(self.offset, "base radius", self.base_radius)

    @property
    def radius_base(self) -> float:
        return self.base_radius

    @property
    def height_base(self) -> float:
        return self.base_radius

    def with_lift(self, lift: Lift, height_base: float) -> Self:
        return replace(self, lift=lift, base_radius=height_base)

    def enlarged(self, growth: float) -> Self:
        return replace(self, base_radius=self.base_radius + growth)

    def _position(self, theta: ArrayLike) -> tuple[Array, Array]:
        s, s1 = self.lift.derivatives(theta, 1)
        return self.base_radius + s, s1

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        across = self.radius_of_curvature(theta)
        return np.zeros_like(across), across

    def tangent(self, theta: ArrayLike) -> Array:
        return np.stack([-np.sin(theta), np.cos(theta)])

    def normal(self, theta: ArrayLike) -> Array:
        return np.stack([np.cos(theta), np.sin(theta)])

    def pressure_angle(self, theta: ArrayLike) -> Array:
        """Zero: the face is square to the stem."""
        return np.zeros(np.shape(theta))

    def push_arm(self, theta: ArrayLike) -> Array:
        """Lever arm s' - e of the contact force about the stem's axis, along v, m."""
        return self.lift(theta, 1) - self.offset

    def slide(self, theta: ArrayLike, friction: Value = 0.0) -> Slide:
        return (
            super()
            .slide(theta, friction)
            ._replace(
                slip=self.height(theta),
                along_face=self.lift(theta, 2),
                on_face=self.push_arm(theta),
            )
        )

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Radius of curvature r + s + s'', m; zero at a cusp, negative where undercut.

        It is the derivative of the contact point along v as well, m/rad.
        """
        s, _, s2 = self.lift.derivatives(theta, 2)
        radius: Array = self.base_radius + s + s2
        return radius

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        radius = self.radius_of_curvature(theta)
        return np.abs(radius), reciprocal(radius)


class PlaneMotion(Sliding):
    """Kinematics of a plane face: its contact is the envelope of its line.

    See `Motion`.
    """

    jet: Jet

    @property
    @abstractmethod
    def height(self) -> Array:
        """Height of the face over the cam axis."""

    @property
    @abstractmethod
    def beside(self) -> Array:
        """Contact from the cam axis across the travel, m."""

    @property
    @abstractmethod
    def radius(self) -> Array:
        """Radius of curvature of the contour."""

    @property
    def size(self) -> Array:
        return self.height

    @property
    def pressure_angle(self) -> Array:
        """Zero: the face is square to its travel."""
        return np.zeros(self.jet.slope.shape)

    @property
    def contour_speed(self) -> Array:
        return self.radius

    @property
    def path_speed(self) -> Array:
        """Speed of the contact point, m/rad."""
        return magnitude(self.contour_speed)

    @property
    def path_curvature(self) -> Array:
        """Curvature of the contour, 1/m; infinite at a cusp."""
        return reciprocal(self.radius)

    @cached_property
    def sharpness(self) -> Array:
        """1 less the radius of curvature over the height: 1 at a cusp."""
        return 1.0 - self.radius / self.height

    @property
    def contact_point(self) -> tuple[Array, Array]:
        return self.height, self.beside

    @cached_property
    def contour_radius(self) -> Array:
        along, across = self.contact_point
        return np.sqrt(along**2 + across**2)

    @property
    def rolling(self) -> float:
        """Zero: the face slides."""
        return 0.0

    def radius_at(self, lift: Value) -> Array:
        return self.height - self.jet.lift + lift


@dataclass(frozen=True, eq=False)
class FaceMotion(PlaneMotion):
    """Kinematics of a flat face on the unloaded cam; the contact lies s' beside the cam axis.

    See `Motion`.

    Parameters
    ----------
    jet : Jet             lift and its derivatives
    base_height : float   r, height of the face at zero lift
    offset : float        e
    friction : float      of the face on the cam
    """

    jet: Jet
    base_height: Value
    offset: Value
    friction: Value

    @cached_property
    def height(self) -> Array:
        return self.base_height + self.jet.lift

    @property
    def beside(self) -> Array:
        return self.jet.slope

    @cached_property
    def radius(self) -> Array:
        """Radius of curvature of the contour, r + s + s''."""
        return self.height + self.jet.lift_d2

    @property
    def travel(self) -> float:
        """Zero: along the axis of the stem."""
        return 0.0

    @property
    def side(self) -> Array:
        """Side force on the stem over the axial force: friction along the face."""
        return np.broadcast_to(self.friction, self.jet.slope.shape)

    @cached_property
    def arm(self) -> Array:
        """Lever arm s' - e of the contact force about the stem axis."""
        return self.jet.slope - self.offset

    @property
    def gain(self) -> float:
        """Normal over axial force: one, the face is square to the stem."""
        return 1.0

    @property
    def pressing(self) -> float:
        """One: the normal is along the travel."""
        return 1.0

    @property
    def lock(self) -> float:
        """Zero: the friction is square to the travel."""
        return 0.0

    @property
    def sliding(self) -> Array:
        return self.friction * self.height

    @property
    def slip(self) -> Array:
        return self.height

    @property
    def along_face(self) -> Array:
        return self.jet.lift_d2

    @property
    def on_face(self) -> Array:
        return self.arm

    @property
    def curvature_slope(self) -> Array:
        return -(self.jet.slope + self.jet.jerk) / self.radius**3

    def reactions(self, lever: tuple[Array, Array], spacing: Value) -> tuple[Reaction, Reaction]:
        """Reactions of guides A and B over the axial force: of the friction along the face, and of
        the axial force beside the stem axis.

        lever : of the side force at each guide, over their spacing
        spacing : of the guides, m
        """
        tilt = self.arm / spacing
        along = [self.friction * each for each in lever]
        whole = [each + magnitude(tilt) for each in along]
        on_a, on_b = (
            Reaction(one, one - magnitude(each - tilt))
            for one, each in zip(whole, along, strict=True)
        )
        return on_a, on_b


@dataclass(frozen=True, eq=False, repr=False)
class FacedContour(Contour):
    """Cam surface under a face, on which it slides."""

    from_middle: ClassVar[str] = OF_STEM
    """Distance of the contact from the middle of the face, in words."""

    @property
    def rolls(self) -> bool:
        return False

    def face_width_min(self) -> float:
        """Minimum width of a face centred on its reference point, m: twice the travel from it."""
        count = self.lift.search_count
        low, high = least(self.on_face, count), greatest(self.on_face, count)
        return 2.0 * max(high.value, -low.value)

    def on_face(self, theta: ArrayLike) -> Array:
        """Place of the contact from the middle of the face, along v, m."""
        return np.asarray(self.pitch.slide(theta).on_face)

    def require_face(self, width: float) -> None:
        """Check that the contact stays on a face of `width`, m; see `require_face_width`."""
        require_face_width(width, self.face_width_min(), self.from_middle)


@dataclass(frozen=True, eq=False, repr=False)
class PlaneContour(FacedContour):
    """Cam surface under a plane face: the envelope of its line, convex in every part.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: flat-faced followers.
    """

    @property
    def follower_curvature(self) -> float:
        """Zero: the face is plane."""
        return 0.0

    def follower_gap(self, xi: Array) -> Array:
        """Gap between the face and the common tangent: zero, the face is plane."""
        return np.zeros_like(xi)

    def points(self, theta: ArrayLike) -> Array:
        return self.pitch.points(theta)

    def local_frame(self, theta: ArrayLike) -> Frame:
        return Frame(self.pitch.points(theta), self.normal(theta), self.tangent(theta))

    def factor(self, theta: ArrayLike) -> Array:
        """Undercut factor, radius of curvature over height of the face; zero at a cusp."""
        return 1.0 - self.motion(self.lift.jet(theta, 2)).sharpness

    def undercut(self) -> Undercut:
        return self._undercut

    @cached_property
    def _undercut(self) -> Undercut:
        value, theta = least(self.factor, self.lift.search_count)
        return Undercut(theta, value)

    def curvature(self, theta: ArrayLike) -> Array:
        return reciprocal(self.radius_of_curvature(theta))

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Radius of curvature, m; negative where undercut."""
        return self.pitch.radius_of_curvature(theta)

    def concave_radius_min(self) -> Extremum:
        """Infinite: a face touches convex parts alone."""
        return Extremum(np.inf, self.pitch.curvature_min().theta)

    @property
    def fitting_tool(self) -> float:
        """The base circle's radius, m: any tool reaches a convex contour."""
        return self.pitch.radius_base


@dataclass(frozen=True, eq=False, repr=False)
class FlatFaceContour(PlaneContour):
    """Cam surface under the flat face of a translating follower.

    Parameters
    ----------
    pitch : FacePath    path of the contact point
    """

    pitch: FacePath

    def motion(self, jet: Jet, friction: Value = 0.0) -> FaceMotion:
        return FaceMotion(jet, self.pitch.base_radius, self.pitch.offset, friction)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        _, s1, _, s3 = self.lift.derivatives(theta, 3)
        slope: Array = -(s1 + s3) * self.curvature(theta) ** 2
        return slope

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        return face_height(polygon, theta)

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        pitch = self.pitch
        return pitch.points(theta), pitch.tangent(theta), pitch.radius_of_curvature(theta)

    def _gap(self, contact: Array, other: Array) -> Array:
        gap: Array = self.pitch.height(contact) - np.sum(
            self.normal(contact) * self.points(other), 0
        )
        return gap


def require_face_width(width: float, needed: float, travel: str = OF_STEM) -> None:
    """Check that a face of `width`, m, covers the travel of the contact.

    Parameters
    ----------
    needed : float   twice the greatest distance of the contact from the middle of the face, m
    travel : str     this distance, in words

    Raises
    ------
    InputError
        If the face is not wider than this; NaN included.
    """
    if not width > needed:
        shown, least = in_millimetres(width, needed)
        limit = f"> {least}, twice the greatest {travel}"
        raise InputError("follower.face.width", shown, limit)
