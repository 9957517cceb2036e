"""Path of a reference point of the follower in the cam frame."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, positive
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError, in_millimetres
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.lift import Jet, Lift


class Reaction(NamedTuple):
    """Reaction of a guide over the axial force on the stem, (..., n).

    whole: sum of the loads of point supports by the side force and by the couple, which the finite
    elements correct; slack: that sum less the load by both at once, None without a couple.
    """

    whole: Array
    slack: Array | None = None

    @property
    def on_points(self) -> Array:
        """Reaction of a point support over the axial force."""
        return self.whole if self.slack is None else self.whole - self.slack

    def corrected(self, fix: Array) -> Array:
        """Reaction over the axial force (..., n) with a finite-element correction `fix` (..., n),
        >= 0; at 1 that of a point support. Zero where the couple outweighs it.
        """
        if self.slack is None:
            return self.whole * fix
        load = self.whole * fix - self.slack
        return np.where(np.real(load) > 0.0, load, 0.0 * load)


class Sliding(ABC):
    """Kinematics of a surface that slides on the cam, beside those of `Motion`.

    Arrays (..., n), real or complex, per cam speed.
    """

    @property
    @abstractmethod
    def slip(self) -> Array:
        """Speed of the cam surface on the face, m."""

    @property
    @abstractmethod
    def along_face(self) -> Array:
        """Speed of the contact along the face, m."""

    @property
    @abstractmethod
    def on_face(self) -> Array:
        """Place of the contact from the middle of the face, along v, m."""


class Motion(Protocol):
    """Kinematics and force ratios of a follower on the unloaded cam at given cam angles.

    Arrays (..., n), real or complex, m. Contour, checks, screening and synthesis evaluate them.
    """

    @property
    def jet(self) -> Jet:
        """Lift and its derivatives."""

    @property
    def height(self) -> Array:
        """Height of the reference point of the follower over the cam axis, m."""

    @property
    def travel(self) -> Value:
        """Direction of travel from the follower axis, counter-clockwise, rad; 0 of a stem."""

    @property
    def pressure_angle(self) -> Array:
        """Pressure angle, rad."""

    @property
    def path_speed(self) -> Array:
        """Path length of the reference point per radian, m/rad."""

    @property
    def path_curvature(self) -> Array:
        """Curvature of the path of the reference point, 1/m, positive where convex."""

    @property
    def sharpness(self) -> Array:
        """1 less the undercut factor: 1 at a cusp."""

    @property
    def size(self) -> Value:
        """Relative radius of curvature of the contact over the undercut factor, m."""

    @property
    def gain(self) -> Value:
        """Normal over axial force."""

    @property
    def side(self) -> Array:
        """Side force on the stem over the axial force."""

    @property
    def arm(self) -> Array:
        """Lever arm of the axial force about the stem axis, m."""

    @property
    def sliding(self) -> Value:
        """Torque of the sliding friction on the cam over the axial force, m."""

    @property
    def pressing(self) -> Value:
        """Contact force along the travel over the axial force."""

    @property
    def lock(self) -> Value:
        """Moment of the friction of a face about the pivot of its arm over that of the contact."""

    @property
    def rolling(self) -> Value:
        """Angular speed of the roller relative to the stem over cam speed."""

    @property
    def contact_point(self) -> tuple[Array, Array]:
        """Contact point from the cam axis, along the line of travel and across it, m."""

    @property
    def contour_radius(self) -> Array:
        """Distance of the contact from the cam axis, m."""

    @property
    def contour_speed(self) -> Array:
        """Speed of the contact along the contour, m/rad; negative where undercut."""

    @property
    def curvature_slope(self) -> Array:
        """Derivative of the contour's curvature by its arc length, 1/m^2."""

    def radius_at(self, lift: Value) -> Array:
        """Radius of the contour in a dwell at a lift."""

    def reactions(self, lever: tuple[Array, Array], spacing: Value) -> tuple[Reaction, Reaction]:
        """Loads of guides on points over the axial force."""


class Slide(NamedTuple):
    """Forces of a contact that slides, over its axial force, and its speeds over cam speed.

    The axial force is that along the travel of the reference point with the moment of the normal
    force; arrays (...).

    lever: of the normal along the arm over the length, with a flat face; pressing: force along the
    travel; side: force across it, signed like the pressure angle; torque: of the friction on the
    cam, m; lock: axial force that the friction takes; slip: speed of the cam surface on the face,
    m; along_face: speed of the contact along the face, m; on_face: place of the contact from the
    middle of the face, along v, m.
    """

    side: Array
    torque: Array
    lever: Array | float = 1.0
    pressing: Array | float = 1.0
    lock: Array | float = 0.0
    slip: Array | float = 0.0
    along_face: Array | float = 0.0
    on_face: Array | float = 0.0


@dataclass(frozen=True, eq=False, repr=False)
class FollowerPath(Displayed, ABC):
    """Path of a reference point of the follower in the cam frame.

    The follower's axes are u = (cos theta, sin theta), outwards along the line of travel of a stem
    or towards the pivot of an arm, and v = (-sin theta, cos theta); angles grow counter-clockwise.
    With an offset the cam angle is that of the follower's axis, not the polar angle of the point.

    Parameters
    ----------
    lift : Lift    s(theta)
    """

    lift: Lift

    @property
    @abstractmethod
    def radius_base(self) -> float:
        """Distance of the reference point from the cam axis at zero lift, m."""

    @property
    @abstractmethod
    def height_base(self) -> float:
        """Height of the reference point along u at zero lift, m."""

    @abstractmethod
    def with_lift(self, lift: Lift, height_base: float) -> Self:
        """The same follower with another lift, from another height (m) at zero lift."""

    @abstractmethod
    def enlarged(self, growth: float) -> Self:
        """The same follower with a `radius_base` larger by `growth`, m."""

    @abstractmethod
    def _position(self, theta: ArrayLike) -> tuple[Array, Array | float]:
        """Reference point along u and v, m."""

    @abstractmethod
    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Derivative of the reference point by the cam angle, along u and v, m/rad."""

    @abstractmethod
    def tangent(self, theta: ArrayLike) -> Array:
        """Unit tangent of the contact, counter-clockwise, (2, ...)."""

    @abstractmethod
    def normal(self, theta: ArrayLike) -> Array:
        """Outward unit normal of the contact, (2, ...)."""

    @abstractmethod
    def pressure_angle(self, theta: ArrayLike) -> Array:
        """Angle from the follower's travel to the contact normal, rad, positive on the rise."""

    @abstractmethod
    def push_arm(self, theta: ArrayLike) -> Array:
        """Lever arm of the contact force about the stem's axis, along v, m."""

    @abstractmethod
    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Path length per radian, m, and signed curvature, 1/m, by one evaluation of the lift."""

    @abstractmethod
    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m, positive where convex."""

    def slide(self, theta: ArrayLike, friction: Value = 0.0) -> Slide:
        """Forces and speeds of the contact with a friction coefficient of its surface."""
        side = np.tan(self.pressure_angle(theta)) + friction
        return Slide(side, friction * self.height(theta))

    def travel(self, theta: ArrayLike) -> Array:
        """Direction of travel from u, counter-clockwise, rad: zero of a stem."""
        return np.zeros(np.shape(theta))

    def height(self, theta: ArrayLike) -> Array:
        """Height of the reference point along u, m; of an arm its arc from the line of centres."""
        return self.height_base + self.lift(theta)

    def points(self, theta: ArrayLike) -> Array:
        """Reference point, (2, ...), m."""
        return cam_axes(theta, *self._position(theta))

    def velocity(self, theta: ArrayLike) -> Array:
        """Derivative of the reference point by the cam angle, (2, ...), m/rad."""
        return cam_axes(theta, *self._velocity(theta))

    def curvature(self, theta: ArrayLike) -> Array:
        """Signed curvature, 1/m, positive where convex."""
        return self.speed_and_curvature(theta)[1]

    def pressure_angle_max(self) -> Extremum:
        """Maximum magnitude of the pressure angle, rad, and its cam angle."""
        return self._pressure_angle_max

    def curvature_max(self) -> Extremum:
        """Maximum signed curvature, 1/m, and its cam angle."""
        return self._curvature_max

    def curvature_min(self) -> Extremum:
        """Minimum signed curvature, 1/m, and its cam angle: negative on a concave flank."""
        return self._curvature_min

    def least_convex_radius(self) -> Extremum:
        """Minimum convex radius of curvature, m, and its cam angle."""
        curvature, theta = self.curvature_max()
        return Extremum(1.0 / curvature, theta)

    @cached_property
    def _pressure_angle_max(self) -> Extremum:
        return greatest(lambda theta: np.abs(self.pressure_angle(theta)), self.lift.search_count)

    @cached_property
    def _curvature_max(self) -> Extremum:
        return greatest(self.curvature, self.lift.search_count)

    @cached_property
    def _curvature_min(self) -> Extremum:
        return least(self.curvature, self.lift.search_count)


def require_offset(offset: float, name: str, radius: float) -> None:
    """Check that a follower's offset (m) lies within its prime or base radius (m).

    Raises
    ------
    InputError
        If the radius is not positive or the offset not below it; NaN included.
    """
    positive("cam.prime_radius", radius, "m")
    if not abs(offset) < radius:
        shown, most = in_millimetres(offset, radius)
        raise InputError("cam.offset", shown, f"below the {name} of {most}")


def cam_axes(theta: ArrayLike, along: Array, across: Array | float) -> Array:
    """Vector (2, ...) in the cam frame from its components along the follower's u and v."""
    cos, sin = np.cos(theta), np.sin(theta)
    return np.stack([along * cos - across * sin, along * sin + across * cos])


def reciprocal(values: Array) -> Array:
    """1 / values, positive infinity where a value is zero."""
    return np.divide(1.0, values, out=np.full_like(values, np.inf), where=values != 0)
