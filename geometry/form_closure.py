"""Form closure: walls of a groove, the second disc of a conjugate pair, the yoke.

A cam that also pulls its follower has a second track. The walls of a groove are parallel curves of
one path; a second disc is the cam under a second roller, whose motion follows from the first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arm_path import Arm, ArmPath
from camwright.geometry.arrays import Array, finite, positive, readonly, uniform_turn
from camwright.geometry.contour import Undercut, require_round
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError, in_millimetres
from camwright.geometry.extrema import Extremum, greatest, least
from camwright.geometry.interference import SecondContact, second_contact
from camwright.geometry.pitch_curve import CentrePath, PitchCurve

Side = Literal["inner", "outer"]
_HALF_TURN = np.pi
_SAME_TOOL = 1e-9  # m: a tool of the width of the groove cuts both walls at once


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

    def radius_of_curvature(self, theta: ArrayLike, side: Side) -> Array:
        """Signed radius of the wall as a curve, m: positive where its centre is within the cam."""
        return self.pitch.radius_of_curvature(theta) + self._outward(side)

    def undercut(self, side: Side) -> Undercut:
        """Minimum undercut factor of a wall: 1 - r kappa of the inner, 1 + r kappa of the outer."""
        bent = self.pitch.curvature_min() if side == "outer" else self.pitch.curvature_max()
        return Undercut(bent.theta, 1.0 + self._outward(side) * bent.value)

    def radius_max(self) -> Extremum:
        """Maximum distance of the outer wall from the cam axis, m, and its cam angle."""
        return greatest(
            lambda theta: np.hypot(*self.points(theta, "outer")), self.pitch.lift.search_count
        )

    def second_contact(self, side: Side) -> SecondContact:
        """Minimum gap between the roller and a wall away from their contact."""

        def gap(contact: Array, other: Array) -> Array:
            away = self.points(other, side) - self.pitch.points(contact)
            return np.asarray(np.hypot(*away) - self.half_width)

        return second_contact(gap, len(self.pitch.lift.theta))

    def section(self) -> tuple[float, Array]:
        """Area of the groove, m2, and its first moment about the cam axis (2,), m3."""
        return self._section

    @cached_property
    def _section(self) -> tuple[float, Array]:
        theta = uniform_turn(self.pitch.lift.search_count)
        speed, curvature = self.pitch.speed_and_curvature(theta)
        # a strip across the groove is as long as the path at its distance n: 1 + n kappa
        step, half = theta[1] - theta[0], self.half_width
        middle = 2.0 * half * speed * step
        aside = (2.0 / 3.0) * half**3 * speed * curvature * step
        moment = (middle * self.pitch.points(theta)).sum(axis=1)
        moment = moment + (aside * self.pitch.normal(theta)).sum(axis=1)
        return float(middle.sum()), readonly(moment)

    def cutter_paths(self, tool_radius: float, theta: Array) -> tuple[Array, ...]:
        """Paths of the centre of a tool (2, n), m: one of the width of the groove, else one a wall.

        Raises
        ------
        InputError
            If the tool is wider than the groove.
        """
        positive("tool.radius", tool_radius, "m")
        beside = self.half_width - tool_radius
        if beside < -_SAME_TOOL:
            shown, most = in_millimetres(tool_radius, self.half_width)
            raise InputError("tool.radius", shown, f"at most half of the groove, {most}")
        middle, normal = self.pitch.points(theta), self.pitch.normal(theta)
        if beside <= _SAME_TOOL:
            return (readonly(middle),)
        return readonly(middle - beside * normal), readonly(middle + beside * normal)


class SecondArm(NamedTuple):
    """Second arm of a lever on the same pivot, on the other side of the line of centres.

    length, m; angle: from the second arm to the first, rad, > the greatest angle of the first.
    """

    length: float
    angle: float


def conjugate_path(first: ArmPath, second: SecondArm) -> ArmPath:
    """Path of the roller of a second arm that is fixed to the first.

    Its arm angle is that between the arms less the first one: it swings away from the cam where
    the first swings towards it. Its lift is counted from its own innermost position.

    Raises
    ------
    InputError
        If the second arm does not stay on the other side of the line of centres.
    """
    positive("follower.arm.second.length", second.length, "m")
    top, lift = first.lift.highest.value, first.lift
    start = second.angle - (first.start + top / first.arm.length)
    if not start > 0.0:
        limit = f"> {second.angle - start:.5g} rad, the greatest arm angle of the first arm"
        raise InputError("follower.arm.second.angle", f"{second.angle:.5g} rad", limit)
    ratio = second.length / first.arm.length
    values = np.maximum(ratio * (top - lift.values), 0.0)
    arm = Arm(first.arm.centre_distance, second.length, -first.arm.sense)
    return ArmPath(replace(lift, values=values), arm, float(start))


def opposite_path(first: PitchCurve, distance: float) -> PitchCurve:
    """Path of a second roller on the same stem, opposite the first across the cam axis.

    Both centres are a distance apart: r1(theta) + r2(theta + 180 deg) is constant.

    Parameters
    ----------
    distance : float   between the roller centres, m

    Raises
    ------
    InputError
        If the second roller would reach the cam axis.
    """
    positive("follower.opposite.distance", distance, "m")
    lift = first.lift
    height = distance - first.height_base - lift.highest.value
    if not height > 0.0:
        shown, most = in_millimetres(distance, first.height_base + lift.highest.value)
        raise InputError("follower.opposite.distance", shown, f"> {most}: beyond the cam axis")
    values = np.maximum(lift.highest.value - lift(lift.theta - _HALF_TURN), 0.0)
    prime = float(np.hypot(height, first.offset))
    return PitchCurve(replace(lift, values=values), prime, -first.offset)


def yoke_breadth(radii: ArrayLike) -> Array:
    """Distance of parallel faces on opposite sides of a cam (n,), m: h(t) + h(t + 180 deg).

    Parameters
    ----------
    radii : array (n,)   h(t): distance of a face from the cam axis at n equal cam angles, m, n even
    """
    height = finite("height", radii)
    if height.size % 2:
        raise InputError("height", f"{height.size} angles", "an even number")
    return np.asarray(height + np.roll(height, height.size // 2))


def least_thickness(groove: Groove, outer_radius: float) -> Extremum:
    """Minimum radial thickness of the rim around a groove in a disc, m, and its cam angle."""
    return least(
        lambda theta: outer_radius - np.hypot(*groove.points(theta, "outer")),
        groove.pitch.lift.search_count,
    )
