"""Form closure: the walls of a groove, parallel curves of the path of its roller."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, readonly, uniform_turn
from camwright.geometry.contour import Frame, RoundContour, Undercut, require_round
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum
from camwright.geometry.follower_path import reciprocal
from camwright.geometry.interference import SecondContact, second_contact
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import CentrePath, RoundMotion

Side = Literal["inner", "outer"]
WALLS: tuple[Side, Side] = ("inner", "outer")


class GrooveStep(NamedTuple):
    """Step of a groove between two depths below the face of its disc.

    top, bottom : depths, m; inner, outer : distances of its walls from the path of the roller, m
    """

    top: float
    bottom: float
    inner: float
    outer: float

    @property
    def depth(self) -> float:
        """Along the shaft, m."""
        return self.bottom - self.top

    @property
    def width(self) -> float:
        """Across the path, m."""
        return self.inner + self.outer

    def section(self, path: CentrePath) -> tuple[float, Array]:
        """Area of the step, m2, and its first moment about the cam axis (2,), m3."""
        theta = uniform_turn(path.lift.search_count)
        speed, curvature = path.speed_and_curvature(theta)
        # a strip across the groove is as long as the path at its distance n: 1 + n kappa
        step, half, aside = theta[1] - theta[0], 0.5 * self.width, 0.5 * (self.outer - self.inner)
        normal = path.normal(theta)
        middle = 2.0 * half * speed * step * (1.0 + aside * curvature)
        beside = (2.0 / 3.0) * half**3 * speed * curvature * step
        moment = (middle * (path.points(theta) + aside * normal)).sum(axis=1)
        moment = moment + (beside * normal).sum(axis=1)
        return float(middle.sum()), readonly(moment)


@dataclass(frozen=True, eq=False, repr=False)
class Groove(Displayed):
    """Groove around the path of a roller: two walls, one on either side.

    The roller runs on one of them at a time; between them it has the clearance of the groove.

    Parameters
    ----------
    pitch : CentrePath       path of the roller centre in the middle of the groove
    roller_radius : float    r, m, > 0
    clearance : float        width of the groove less the roller diameter, m, >= 0

    Raises
    ------
    InputError
        If the roller does not fit or the clearance is negative; NaN included. An undercut is a
        result, not an error.

    References
    ----------
    Rothbart, Cam Design Handbook (2004), sec. 6.4: parallel curves of the pitch curve.
    """

    pitch: CentrePath
    roller_radius: float
    clearance: float = 0.0

    def __post_init__(self) -> None:
        require_round("roller.radius", self.roller_radius, self.pitch.radius_base)
        if not 0.0 <= self.clearance < np.inf:
            raise InputError("cam.groove.clearance", self.clearance, ">= 0 m")

    @property
    def half_width(self) -> float:
        """Distance of each wall from the middle of the groove, m."""
        return self.roller_radius + 0.5 * self.clearance

    def _outward(self, side: Side) -> float:
        return self.half_width if side == "outer" else -self.half_width

    def points(self, theta: ArrayLike, side: Side) -> Array:
        """Wall, (2, ...), m, where the roller touches it at cam angles, rad."""
        wall: Array = self.pitch.points(theta) + self._outward(side) * self.pitch.normal(theta)
        return wall

    def second_contact(self, side: Side) -> SecondContact:
        """Minimum gap between the roller and a wall away from their contact."""

        def gap(contact: Array, other: Array) -> Array:
            away = self.points(other, side) - self.pitch.points(contact)
            return np.asarray(np.hypot(*away) - self.half_width)

        return second_contact(gap, len(self.pitch.lift.theta))


@dataclass(frozen=True, eq=False, repr=False)
class OuterWall(RoundContour):
    """Outer wall of a groove: the path of the roller centre offset outwards by the roller radius.

    Its material is outside: normal and tangent point into the groove and against the cam angle,
    and the wall is concave where the path is convex.

    Parameters
    ----------
    pitch : CentrePath       path of the roller centre
    roller_radius : float    m, > 0

    Raises
    ------
    InputError
        If the roller does not fit; NaN included. An undercut is a result, not an error.
    """

    wall: ClassVar[float] = -1.0

    def __post_init__(self) -> None:
        require_round("roller.radius", self.roller_radius, self.pitch.radius_base)

    def local_frame(self, theta: ArrayLike) -> Frame:
        normal = self.pitch.normal(theta)
        return Frame(self._outset(theta, normal), -normal, -self.pitch.tangent(theta))

    def points(self, theta: ArrayLike) -> Array:
        return self._outset(theta, self.pitch.normal(theta))

    def _outset(self, theta: ArrayLike, normal: Array) -> Array:
        outset: Array = self.pitch.points(theta) + self.roller_radius * normal
        return outset

    def normal(self, theta: ArrayLike) -> Array:
        """Unit normal out of the material into the groove, (2, ...)."""
        return -self.pitch.normal(theta)

    def tangent(self, theta: ArrayLike) -> Array:
        """Unit tangent against the cam angle, (2, ...), with the material on its left."""
        return -self.pitch.tangent(theta)

    def motion(self, jet: Jet, friction: Value = 0.0) -> RoundMotion:  # noqa: ARG002
        return self.pitch.centre_motion(jet, -self.roller_radius)

    def speed(self, theta: ArrayLike) -> Array:
        """Velocity of the contact point along the tangent, m/rad: negative, but where undercut."""
        return -super().speed(theta)

    def undercut(self) -> Undercut:
        curvature, theta = self.pitch.curvature_min()
        return Undercut(theta, 1.0 + self.roller_radius * curvature)

    def curvature(self, theta: ArrayLike) -> Array:
        curvature = self.pitch.curvature(theta)
        return -curvature * reciprocal(1.0 + self.roller_radius * curvature)

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        return -self.pitch.radius_of_curvature(theta) - self.roller_radius

    def curvature_slope(self, theta: ArrayLike) -> Array:
        motion = self.motion(self.lift.jet(theta, 3))
        return np.asarray(-motion.curvature_slope * motion.contour_speed)

    def concave_radius_min(self) -> Extremum:
        """Least concave radius of the wall, m, with its cam angle; infinite where no part of the
        path is convex.
        """
        curvature, theta = self.pitch.curvature_max()
        if curvature <= 0:
            return Extremum(np.inf, theta)
        return Extremum(self.roller_radius + 1.0 / curvature, theta)

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        """Height (m,) of the roller pulled against another closed wall (2, n), m."""
        return self.pitch.pulled(polygon, self.roller_radius, theta)

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        frame = self.local_frame(theta)
        return frame.point, frame.tangent, self.speed(theta)


def groove_wall(contour: RoundContour, side: Side, radius: float) -> RoundContour:
    """Wall of a groove at a distance from the path of a roller, m, on either side.

    Parameters
    ----------
    contour : RoundContour   inner wall at the radius of the roller
    """
    if side == "inner":
        return replace(contour, roller_radius=radius)
    return OuterWall(contour.pitch, radius)
