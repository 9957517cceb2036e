"""Contour of the cam: surface of any follower type, and the contour under a roller."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, Value, positive, readonly, uniform_turn
from camwright.geometry.display import Displayed
from camwright.geometry.errors import GeometryError, InputError, in_millimetres
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.figures import Curve, DrawnAxes, Figure, outline, outline_panel, plotted
from camwright.geometry.follower_height import roller_height
from camwright.geometry.follower_path import FollowerPath, Motion, cam_axes, reciprocal
from camwright.geometry.interference import SecondContact, crossings, second_contact
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import CentrePath, PitchCurve, RollerMotion

_OFFSET_TOLERANCE = 1e-14
"""Over the path's radius at zero lift: round-off in the coordinates of a contour point."""

_OFFSET_STEPS_MAX = 20
_OFFSET_STEP_MAX = 0.5
"""rad: a longer step of Newton's method has left the neighbourhood of the contact."""

_DRAWN = 721
_MEASURED = 20001


class Undercut(NamedTuple):
    """Minimum undercut factor of a contour, and its cam angle, rad.

    The factor is 1 - r kappa under a roller and (r + s + s'')/(r + s) under a flat face: zero at a
    cusp, negative where the follower cuts the contour away.
    """

    theta: float
    factor: float

    @property
    def present(self) -> bool:
        """Whether the contour is undercut or has a cusp; true for NaN."""
        return not self.factor > 0


class Frame(NamedTuple):
    """Contact point (m), outward unit normal, counter-clockwise unit tangent, each (2, ...)."""

    point: Array
    normal: Array
    tangent: Array


@dataclass(frozen=True, eq=False, repr=False)
class Contour(Displayed, ABC):
    """Cam surface by cam angle: at each angle the point that touches the follower.

    A kind of follower is a class of its own that defines the abstract members: the contact point
    with its derivatives, the undercut factor and the follower's own surface. Areas, extremes,
    self-intersections and second contacts follow from these.

    Parameters
    ----------
    pitch : FollowerPath    path of the follower's reference point
    """

    pitch: FollowerPath

    @property
    def lift(self) -> Lift:
        """Lift of the follower, s(theta)."""
        return self.pitch.lift

    @property
    @abstractmethod
    def rolls(self) -> bool:
        """Whether the follower rolls on the cam; otherwise it slides."""

    @property
    @abstractmethod
    def follower_curvature(self) -> float:
        """Curvature of the follower's surface, 1/m, >= 0."""

    @abstractmethod
    def follower_gap(self, xi: Array) -> Array:
        """Gap between follower and common tangent at distance `xi` (m) along it, m, >= 0."""

    def require_roller(self) -> RoundContour:
        """This contour as that of a roller; refused for any other follower.

        Raises
        ------
        GeometryError
            For any other follower.
        """
        raise GeometryError(f"contour = {type(self).__name__}, must be that of a roller")

    @abstractmethod
    def local_frame(self, theta: ArrayLike) -> Frame:
        """Contact point with its outward normal and its tangent."""

    @abstractmethod
    def motion(self, jet: Jet, friction: Value = 0.0) -> Motion:
        """Motion of the follower under the lift of this cam, at the angles of its jet.

        friction: of the follower on the cam
        """

    def speed(self, theta: ArrayLike) -> Array:
        """Velocity of the contact point along the tangent, m/rad; negative where undercut."""
        return self.motion(self.lift.jet(theta, 2)).contour_speed

    @abstractmethod
    def factor(self, theta: ArrayLike) -> Array:
        """Undercut factor; see `Undercut`."""

    @abstractmethod
    def undercut(self) -> Undercut:
        """Minimum undercut factor over the continuous turn."""

    def require_no_undercut(self) -> None:
        """Check that the contour bounds a body.

        Raises
        ------
        GeometryError
            If the contour is undercut.
        """
        theta, factor = self.undercut()
        if not factor > 0:
            where = f"at cam angle {np.degrees(theta):.2f} deg"
            raise GeometryError(
                f"undercut factor of the contour = {factor:.4g} {where}, must be > 0"
            )

    @abstractmethod
    def curvature(self, theta: ArrayLike) -> Array:
        """Signed curvature, 1/m, positive where convex; infinite at a cusp."""

    @abstractmethod
    def curvature_slope(self, theta: ArrayLike) -> Array:
        """Derivative of the curvature by the cam angle, 1/(m rad)."""

    @abstractmethod
    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m, positive where convex."""

    @abstractmethod
    def concave_radius_min(self) -> Extremum:
        """Minimum concave radius of curvature, m > 0, and its cam angle.

        Infinite, at the angle of least curvature, where the cam is convex. The grinding wheel
        must be smaller.
        """

    @property
    @abstractmethod
    def fitting_tool(self) -> float:
        """Greatest radius of a round tool that reaches every point the follower touches, m."""

    @abstractmethod
    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        """Height (m,) of the follower resting on another closed contour (2, n), m."""

    @abstractmethod
    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        """Contour point, unit tangent and speed by one evaluation of the lift."""

    @abstractmethod
    def _gap(self, contact: Array, other: Array) -> Array:
        """Gap between the follower in contact at one cam angle and the contour at another, m."""

    def points(self, theta: ArrayLike) -> Array:
        """Contour point, (2, ...), m."""
        return self.local_frame(theta).point

    def normal(self, theta: ArrayLike) -> Array:
        """Outward unit normal, (2, ...)."""
        return self.pitch.normal(theta)

    def tangent(self, theta: ArrayLike) -> Array:
        """Unit tangent, (2, ...), of the follower's path; opposite to the contour's if undercut."""
        return self.pitch.tangent(theta)

    def velocity(self, theta: ArrayLike) -> Array:
        """Derivative of the contour point by the cam angle, (2, ...), m/rad."""
        return self.speed(theta) * self.tangent(theta)

    def radius(self, theta: ArrayLike) -> Array:
        """Distance of the contour point from the cam axis, m."""
        x, y = self.points(theta)
        radius: Array = np.hypot(x, y)
        return radius

    def surface_offset(self, theta: ArrayLike, xi: ArrayLike) -> Array:
        """Height of the contour over its tangent line at the contact, m, outward positive.

        Newton's method on the cam angle of the contour point whose tangential distance from the
        contact is `xi`.

        Parameters
        ----------
        theta : array (...)     cam angle of the contact, rad
        xi : array (..., k)     distance from the contact along the tangent, counter-clockwise,
                                m; (k,) applies to every angle

        Returns
        -------
        array (..., k)    negative where the contour bends away from the follower

        Raises
        ------
        GeometryError
            If the contour has no such point near the contact: undercut, or `xi` too large.
        """
        theta = np.asarray(theta, dtype=float)[..., None]
        contact, speed = self.local_frame(theta), self.speed(theta)
        xi = np.asarray(xi, dtype=float)
        miss = np.zeros(np.broadcast(theta, xi).shape) - xi
        angle, rate, tolerance = theta, speed, _OFFSET_TOLERANCE * self.pitch.radius_base
        for _ in range(_OFFSET_STEPS_MAX):
            step = np.divide(miss, rate, out=np.full_like(miss, np.nan), where=rate != 0)
            angle = angle - np.clip(step, -_OFFSET_STEP_MAX, _OFFSET_STEP_MAX)
            point, tangent, rate = self._track(angle)
            away = point - contact.point
            miss = np.sum(away * contact.tangent, axis=0) - xi
            if np.all(np.abs(miss) <= tolerance):
                offset: Array = np.sum(away * contact.normal, axis=0)
                return offset
            rate = rate * np.sum(tangent * contact.tangent, axis=0)
        lost = ~np.all(np.abs(miss) <= tolerance, axis=-1)
        where = float(np.broadcast_to(theta[..., 0], lost.shape)[lost][0])
        raise GeometryError(
            f"contour at cam angle {where:.6g} rad: no surface point at the distance xi"
        )

    def self_intersections(self) -> tuple[tuple[float, float], ...]:
        """Pairs of cam angles, rad, at which the contour passes through the same point.

        Chords of the turn, finer about every undercut so that its swallow-tail is resolved;
        crossings are refined to round-off.
        """
        return self._crossings

    def second_contact(self) -> SecondContact:
        """Minimum gap between the follower and the contour away from their contact."""
        return self._second_contact

    @cached_property
    def _crossings(self) -> tuple[tuple[float, float], ...]:
        return crossings(self.points, self.velocity, self.factor, self.lift.search_count)

    @cached_property
    def _second_contact(self) -> SecondContact:
        return second_contact(self._gap, len(self.lift.theta))

    def least_convex_pitch_radius(self) -> Extremum:
        """Minimum convex radius of curvature of the follower's path, m, and its cam angle."""
        return self.pitch.least_convex_radius()

    def pressure_angle_max(self) -> Extremum:
        """Maximum magnitude of the pressure angle, rad, and its cam angle."""
        return self.pitch.pressure_angle_max()

    def radius_max(self) -> Extremum:
        """Maximum distance of the contour from the cam axis, m, and its cam angle."""
        return self._radius_max

    def radius_min(self) -> Extremum:
        """Minimum distance of the contour from the cam axis, m, and its cam angle."""
        return self._radius_min

    def polygon(self, count: int) -> Array:
        """`count` contour points at equal steps of the cam angle, (2, count), m."""
        return readonly(self.points(uniform_turn(count)))

    def area(self) -> float:
        """Area within the contour, m^2, including bore and keyway."""
        x, y = self._ring
        dx, dy = self._ring_step
        return float(0.5 * np.sum(x * dy - y * dx))

    def centroid(self) -> Array:
        """Centroid of the area within the contour, (2,), m."""
        x, y = self._ring
        dx, dy = self._ring_step
        return readonly([np.sum(x**2 * dy), -np.sum(y**2 * dx)]) / (2 * self.area())

    def polar_moment(self) -> float:
        """Polar second moment about the cam axis of the area within the contour, m^4."""
        x, y = self._ring
        dx, dy = self._ring_step
        return float(0.25 * np.sum((x**2 + y**2) * (x * dy - y * dx)))

    def perimeter(self) -> float:
        """Length of the contour, m."""
        return float(np.sum(np.hypot(*self._ring_step)))

    def arc_length(self, theta: Array) -> Array:
        """Length (n,) along the contour from angle 0, m."""
        return np.asarray(np.interp(theta, *self._lengths))

    def plot(self) -> DrawnAxes:
        """Contour in the cam frame: under a round follower with pitch curve and prime circle, under
        a flat face with the base circle; see `Table.plot`."""
        return plotted(self.figure())

    def figure(self, *more: Curve) -> Figure:
        """Figure of contour, pitch curve and prime or base circle, mm, with further outlines."""
        theta = np.linspace(0.0, FULL_TURN, _DRAWN)
        curves = [outline(1e3 * self.points(theta), "contour")]
        if self.follower_curvature > 0.0:
            path = 1e3 * self.pitch.points(theta)
            curves.append(outline(path, "pitch curve", "vermillion", "dashed"))
        circle = 1e3 * cam_axes(theta, np.asarray(self.pitch.radius_base), 0.0)
        name = "prime circle" if self.follower_curvature > 0.0 else "base circle"
        curves.append(outline(circle, name, "muted", "dotted"))
        panel = outline_panel((*curves, *more), names=("x (along cam angle zero)", "y"))
        return Figure("contour", "Contour", "", (panel,))

    @cached_property
    def _radius_max(self) -> Extremum:
        return greatest(self.radius, self.lift.search_count)

    @cached_property
    def _radius_min(self) -> Extremum:
        return least(self.radius, self.lift.search_count)

    @cached_property
    def _lengths(self) -> tuple[Array, Array]:
        """Cam angles (n,), rad, from 0 to a turn, and the length of the contour up to each (n,),
        m.
        """
        theta = np.linspace(0.0, FULL_TURN, _MEASURED)
        speed = np.abs(self.speed(theta))
        steps = np.diff(theta) * (speed[1:] + speed[:-1]) / 2
        return theta, np.concatenate([[0.0], np.cumsum(steps)])

    @cached_property
    def _ring(self) -> Array:
        return self.points(uniform_turn(self.lift.search_count))

    @cached_property
    def _ring_step(self) -> Array:
        # the trapezoidal rule, which on a smooth periodic function is of spectral accuracy
        angle = uniform_turn(self.lift.search_count)
        step: Array = self.velocity(angle) * (angle[1] - angle[0])
        return step


@dataclass(frozen=True, eq=False, repr=False)
class RoundContour(Contour):
    """Cam surface under a roller on any path.

    The path of the roller centre offset inwards by the radius of the roller.

    Parameters
    ----------
    pitch : CentrePath       path of the roller centre
    roller_radius : float    m

    References
    ----------
    Rothbart, Cam Design Handbook (2004), sec. 6.4.
    """

    pitch: CentrePath
    roller_radius: float
    wall: ClassVar[float] = 1.0
    """1, or -1 of an outer wall, on which the roller turns the other way"""

    @property
    def rolls(self) -> bool:
        return True

    @property
    def follower_radius(self) -> float:
        """Radius of the follower's surface, m."""
        return self.roller_radius

    def require_roller(self) -> RoundContour:
        return self

    @property
    def follower_curvature(self) -> float:
        return 1 / self.follower_radius

    def follower_gap(self, xi: Array) -> Array:
        radius = self.follower_radius
        return xi**2 / (radius + np.sqrt(radius**2 - xi**2))

    def factor(self, theta: ArrayLike) -> Array:
        """Undercut factor 1 - radius x path curvature; zero at a cusp, 1 if straight."""
        return 1.0 - self.motion(self.lift.jet(theta, 2)).sharpness

    def undercut(self) -> Undercut:
        curvature, theta = self.pitch.curvature_max()
        return Undercut(theta, 1.0 - self.follower_radius * curvature)

    def relative_radius(self, theta: ArrayLike, wall: Array) -> Array:
        """Relative radius of curvature, m, on the inner wall of a groove (1) or the outer (-1).

        r (1 - r kappa) and r (1 + r kappa), kappa: curvature of the path; negative if undercut.
        """
        radius = self.follower_radius
        relative: Array = radius * (1.0 - wall * radius * self.pitch.curvature(theta))
        return relative

    def curvature(self, theta: ArrayLike) -> Array:
        curvature = self.pitch.curvature(theta)
        return curvature * reciprocal(1.0 - self.follower_radius * curvature)

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m, positive where convex; infinite at an inflection.

        Negative both on a concave flank and where a convex one is undercut.
        """
        return self.pitch.radius_of_curvature(theta) - self.follower_radius

    def concave_radius_min(self) -> Extremum:
        """Least concave radius of the contour, m, with its cam angle; infinite where no part is
        concave.
        """
        curvature, theta = self.pitch.curvature_min()
        if curvature >= 0:
            return Extremum(np.inf, theta)
        return Extremum(self.follower_radius - 1.0 / curvature, theta)

    @property
    def fitting_tool(self) -> float:
        """The radius of the follower's surface, m."""
        return self.follower_radius

    def _gap(self, contact: Array, other: Array) -> Array:
        away = self.points(other) - self.pitch.points(contact)
        gap: Array = np.hypot(away[0], away[1]) - self.follower_radius
        return gap


@dataclass(frozen=True, eq=False, repr=False)
class RollerContour(RoundContour):
    """Cam surface under the roller of a translating follower.

    Parameters
    ----------
    pitch : PitchCurve        path of the roller centre
    roller_radius : float     m, > 0, below the prime radius

    Raises
    ------
    InputError
        If the roller does not fit; NaN included. An undercut is a result, not an error.
    """

    pitch: PitchCurve

    def __post_init__(self) -> None:
        require_round("roller.radius", self.roller_radius, self.pitch.prime_radius)

    def local_frame(self, theta: ArrayLike) -> Frame:
        height, along, across = self._direction(theta)
        normal, tangent = cam_axes(theta, across, -along), cam_axes(theta, along, across)
        return Frame(self._inset(theta, height, along, across), normal, tangent)

    def points(self, theta: ArrayLike) -> Array:
        return self._inset(theta, *self._direction(theta))

    def _direction(self, theta: ArrayLike) -> tuple[Array, Array, Array]:
        """Height of the roller centre, m, and unit tangent along and across the travel."""
        s, s1 = self.lift.derivatives(theta, 1)
        along, height = s1 - self.pitch.offset, self.pitch.height_base + s
        speed = np.hypot(along, height)
        return height, along / speed, height / speed

    def _inset(self, theta: ArrayLike, height: Array, along: Array, across: Array) -> Array:
        """Contour point: the roller centre moved inwards by the roller radius."""
        inset = self.roller_radius
        return cam_axes(theta, height - inset * across, self.pitch.offset + inset * along)

    def motion(self, jet: Jet, friction: Value = 0.0) -> RollerMotion:  # noqa: ARG002
        return self.pitch.centre_motion(jet, self.roller_radius)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        return self.pitch.curvature_slope(theta) * reciprocal(self.factor(theta) ** 2)

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        return roller_height(polygon, self.roller_radius, self.pitch.offset, theta)

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        """Points (2, n), m, unit tangents (2, n) and speed (n,), m/rad, of the contour at cam
        angles (n,), rad; one evaluation of the lift serves all.
        """
        pitch = self.pitch
        s, s1, s2 = pitch.lift.derivatives(theta, 2)
        along, across = s1 - pitch.offset, pitch.height_base + s
        square = along**2 + across**2
        speed = np.sqrt(square)
        inset = self.roller_radius / speed
        turning = (along * (along + s1) - across * (s2 - across)) / square
        cos, sin = np.cos(theta), np.sin(theta)
        d, e = across * (1 - inset), pitch.offset + inset * along
        point = np.stack([d * cos - e * sin, d * sin + e * cos])
        tangent = np.stack([along * cos - across * sin, along * sin + across * cos]) / speed
        return point, tangent, speed - self.roller_radius * turning


def require_round(field: str, radius: float, prime_radius: float) -> None:
    """Check that a round follower of a radius, m, is within its prime circle.

    Raises
    ------
    InputError
        If the radius is not positive, or not below the prime radius; NaN included.
    """
    positive(field, radius, "m")
    if not radius < prime_radius:
        shown, most = in_millimetres(radius, prime_radius)
        raise InputError(field, shown, f"below the prime radius of {most}")
