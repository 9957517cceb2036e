"""Oscillating follower: an arm on a fixed pivot, the path of its roller and the cam under it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, finite, positive, uniform_turn
from camwright.geometry.contour import Frame, RoundContour, require_round
from camwright.geometry.errors import InputError
from camwright.geometry.follower_height import arm_angle
from camwright.geometry.follower_path import cam_axes, reciprocal
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import CentrePath, RoundMotion

_QUARTER_TURN, _HALF_TURN = 0.5 * np.pi, np.pi


class Turned(NamedTuple):
    """An angle and its derivatives by the cam angle, rad/rad^k, (..., n), real or complex."""

    angle: Array
    rate: Array
    rate_d1: Array
    rate_d2: Array


@dataclass(frozen=True, eq=False)
class Arm:
    """Arm on a fixed pivot; its lift is the arc at its length.

    The arm angle psi lies between the lines from the pivot to the cam axis and along the arm; it
    grows with the lift, away from the cam. With u from the cam axis to the pivot and v square to
    it, the end of the arm is at c - l cos(psi) along u and w l sin(psi) along v.

    Parameters
    ----------
    centre_distance : float   c, cam axis to pivot, m, > 0
    length : float            l, pivot to the reference point, m, > 0
    sense : float             w, of the outward swing: 1 with the rotation of the cam, -1 against it

    Raises
    ------
    InputError
        If a length is not positive; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: oscillating followers.
    """

    centre_distance: Value
    length: Value
    sense: float

    def __post_init__(self) -> None:
        """Refuse a centre distance or a length, m, that is not positive; complex ones, of a
        derivative by a complex step, are not checked.
        """
        if not np.iscomplexobj(self.centre_distance):
            positive("follower.arm.centre_distance", self.centre_distance, "m")
        if not np.iscomplexobj(self.length):
            positive("follower.arm.length", self.length, "m")

    @property
    def pivot(self) -> tuple[float, float]:
        """Centre distance, m, and sense, as of `arm_angle`."""
        return float(self.centre_distance), self.sense

    def to_roller(self, radius: float) -> Callable[[Array], Array]:
        """Angle, rad, from points at distances from the pivot, m, to the arm whose roller of a
        radius, m, touches them; -inf where it cannot.
        """

        def beyond(distance: Array) -> Array:
            cosine = (distance**2 + self.length**2 - radius**2) / (2.0 * distance * self.length)
            return np.where(cosine <= 1.0, np.arccos(np.clip(cosine, -1.0, 1.0)), -np.inf)

        return beyond

    def angle(self, radius: Value) -> Value:
        """Arm angle, rad, with the end of the arm at a radius, m, from the cam axis.

        NaN where the arm does not reach it.
        """
        c, length = self.centre_distance, self.length
        with np.errstate(invalid="ignore"):
            angle: Value = np.arccos((c**2 + length**2 - radius**2) / (2.0 * c * length))
        return angle

    def radius(self, angle: Value) -> Value:
        """Distance of the end of the arm from the cam axis, m, at an arm angle, rad."""
        # cos = 1 - 2 sin^2 of the half keeps the digits of a long arm
        c, length = self.centre_distance, self.length
        sine = np.sin(0.5 * angle)
        radius: Value = np.sqrt((c - length) ** 2 + 4.0 * c * length * sine**2)
        return radius

    def start_angle(self, prime_radius: Value, offset: Value | None = None) -> Value:
        """Arm angle at zero lift, rad; offset: of a flat face, as of `face_angle`, None: none.

        prime_radius: of the reference point, or of the base circle under a flat face, m
        """
        return self.angle(prime_radius) if offset is None else self.face_angle(prime_radius, offset)

    def face_angle(self, height: Value, offset: Value) -> Value:
        """Arm angle, rad, of a flat face along the arm at a height, m, over the cam axis.

        offset: of its plane from the pivot towards the cam, m; NaN where the face does not reach it
        """
        with np.errstate(invalid="ignore"):
            angle: Value = np.arcsin((height + offset) / self.centre_distance)
        return angle

    def face_radius(self, angle: Value, offset: Value) -> Value:
        """Height of a flat face along the arm over the cam axis, m, at an arm angle, rad."""
        radius: Value = self.centre_distance * np.sin(angle) - offset
        return radius

    def travel(self, angle: Array) -> Array:
        """Direction of the arc at an arm angle from u, counter-clockwise, rad."""
        return self.sense * (_QUARTER_TURN - angle)

    def turned(self, jet: Jet, start: Value) -> Turned:
        """Arm angle under a lift from a start angle, rad, with its derivatives."""
        length = self.length
        return Turned(
            start + jet.lift / length,
            jet.slope / length,
            jet.lift_d2 / length,
            jet.jerk / length,
        )


@dataclass(frozen=True, eq=False)
class ArmMotion(RoundMotion):
    """Kinematics and force ratios of a roller on an arm on the unloaded cam; see `Motion`.

    At each angle the arm is a translating follower along the tangent of its arc, of height
    c sin(psi) and offset w (l - c cos(psi)), whose line turns in the cam frame at 1 - w psi'.

    Parameters
    ----------
    jet : Jet          arc of the end of the arm and its derivatives
    linkage : Arm
    start : float      psi at zero lift, rad
    size : float       roller radius, m
    """

    jet: Jet
    linkage: Arm
    start: Value
    size: Value

    @property
    def rolls(self) -> bool:
        return True

    @cached_property
    def turned(self) -> Turned:
        """Arm angle with its derivatives."""
        return self.linkage.turned(self.jet, self.start)

    @property
    def travel(self) -> Array:
        return self.linkage.travel(self.turned.angle)

    @cached_property
    def turning(self) -> Array:
        """Angle by which the arm turns in the cam frame per cam angle, 1 - w psi'."""
        return 1.0 - self.linkage.sense * self.turned.rate

    @cached_property
    def _along_pivot(self) -> Array:
        """c cos(psi), m."""
        return self.linkage.centre_distance * np.cos(self.turned.angle)

    @cached_property
    def height(self) -> Array:
        return self.linkage.centre_distance * np.sin(self.turned.angle)

    @cached_property
    def travel_offset(self) -> Array:
        return self.linkage.sense * (self.linkage.length - self._along_pivot)

    @cached_property
    def along(self) -> Array:
        return self.jet.slope - self.travel_offset

    @cached_property
    def _changes(self) -> tuple[Array, Array]:
        """Derivatives of `along` and `height` by the cam angle, m/rad."""
        rate = self.turned.rate
        return (
            self.jet.lift_d2 - self.linkage.sense * self.height * rate,
            self._along_pivot * rate,
        )

    @cached_property
    def _bend(self) -> Array:
        """Speed of the path squared times its turning, m2/rad."""
        along, height = self.along, self.height
        along_d1, height_d1 = self._changes
        turning = self.turning * (along**2 + height**2)
        return turning + along * height_d1 - height * along_d1

    @cached_property
    def _path(self) -> tuple[Array, Array]:
        speed = np.sqrt(self.along**2 + self.height**2)
        return speed, self._bend / speed**3

    @property
    def path_curvature_slope(self) -> Array:
        """Derivative of the curvature of the path by the cam angle, 1/(m rad), from those of the
        velocity along the travel and of the height.
        """
        jet, sense, (_, rate, rate_d1, _) = self.jet, self.linkage.sense, self.turned
        along, height, beside = self.along, self.height, self._along_pivot
        along_d1, height_d1 = self._changes
        along_d2 = jet.jerk - sense * (beside * rate**2 + height * rate_d1)
        height_d2 = beside * rate_d1 - height * rate**2
        square, stretching = along**2 + height**2, along * along_d1 + height * height_d1
        change = along * height_d2 - height * along_d2
        change = change - sense * rate_d1 * square + 2.0 * self.turning * stretching
        return (change - 3.0 * self._bend * stretching / square) / square**1.5

    @property
    def sliding(self) -> float:
        """Zero: the roller rolls."""
        return 0.0

    @property
    def rolling(self) -> Array:
        """Angular speed of the roller relative to the arm over cam speed."""
        return self.path_speed / self.size - self.turning

    @property
    def slide_slope(self) -> Array:
        along_d1, height_d1 = self._changes
        stretching = self.along * along_d1 + self.height * height_d1
        return stretching / self.path_speed + self.linkage.sense * self.turned.rate_d1 * self.size

    @property
    def prime_radius(self) -> Array:
        return np.asarray(self.linkage.radius(self.start) + np.zeros(self.jet.lift.shape))

    def radius_at(self, lift: Value) -> Array:
        angle = self.start + lift / self.linkage.length
        return np.asarray(self.linkage.radius(angle) - self.size)


@dataclass(frozen=True, eq=False, repr=False)
class ArmPath(CentrePath):
    """Path of the centre of the roller of an arm, in the cam frame.

    Parameters
    ----------
    lift : Lift      arc of the end of the arm, m
    arm : Arm
    start : float    psi at zero lift, rad, within 0 and pi

    Raises
    ------
    InputError
        If the swing leaves the half turn away from the cam; NaN included.
    """

    arm: Arm
    start: float

    def __post_init__(self) -> None:
        require_swing(self.arm, self.start, self.lift)

    @cached_property
    def radius_base(self) -> float:
        return float(self.arm.radius(self.start))

    @property
    def height_base(self) -> float:
        """Arc from the line of centres to the reference point at zero lift, m."""
        return float(self.arm.length * self.start)

    def with_lift(self, lift: Lift, height_base: float) -> Self:
        return replace(self, lift=lift, start=float(height_base / self.arm.length))

    def enlarged(self, growth: float) -> Self:
        return replace(self, start=float(self.arm.angle(self.radius_base + growth)))

    def centre_motion(self, jet: Jet, radius: Value) -> ArmMotion:
        return ArmMotion(jet, self.arm, self.start, radius)

    def motion(self, theta: ArrayLike) -> ArmMotion:
        """Motion of the centre alone."""
        return self.centre_motion(self.lift.jet(theta, 2), 0.0)

    def pulled(self, polygon: ArrayLike, radius: float, theta: ArrayLike) -> Array:
        reach = self.arm.to_roller(radius)
        angle = arm_angle(polygon, self.arm.pivot, reach, theta, pulled=True)
        return np.asarray(self.arm.length * angle)

    def travel(self, theta: ArrayLike) -> Array:
        return self.arm.travel(self.start + self.lift(theta) / self.arm.length)

    def _position(self, theta: ArrayLike) -> tuple[Array, Array]:
        angle = self.start + self.lift(theta) / self.arm.length
        beside = self.arm.length * np.cos(angle)
        return self.arm.centre_distance - beside, self.arm.sense * self.arm.length * np.sin(angle)

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Velocity of the roller centre in the cam frame along u and v, m/rad, at cam angles (...),
        rad.
        """
        s, s1 = self.lift.derivatives(theta, 1)
        arm, angle = self.arm, self.start + s / self.arm.length
        drawn = s1 - arm.sense * arm.length
        across = arm.centre_distance + arm.sense * drawn * np.cos(angle)
        return drawn * np.sin(angle), across

    def _direction(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Unit tangent along u and v."""
        along, across = self._velocity(theta)
        speed = np.hypot(along, across)
        return along / speed, across / speed

    def tangent(self, theta: ArrayLike) -> Array:
        return cam_axes(theta, *self._direction(theta))

    def normal(self, theta: ArrayLike) -> Array:
        along, across = self._direction(theta)
        return cam_axes(theta, across, -along)

    def pressure_angle(self, theta: ArrayLike) -> Array:
        return self.motion(theta).pressure_angle

    def push_arm(self, theta: ArrayLike) -> Array:
        """Zero: the contact force passes through the reference point."""
        return np.zeros(np.shape(theta))

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        motion = self.motion(theta)
        return motion.path_speed, motion.path_curvature

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Signed radius of curvature, m; infinite at an inflection."""
        return reciprocal(self.curvature(theta))


def require_swing(arm: Arm, start: float, lift: Lift) -> None:
    """Check that an arm reaches the cam and stays between both lines of centres.

    Raises
    ------
    InputError
        If the start angle is not within 0 and pi, or the swing leaves it; NaN included.
    """
    if not 0.0 < start < _HALF_TURN:
        value = "none" if np.isnan(start) else f"{np.degrees(start):.6g} deg"
        raise InputError("follower.arm.start_angle", value, "> 0 and < 180 deg: the arm reaches it")
    high = start + lift.highest.value / arm.length
    low = start + lift.lowest.value / arm.length
    for angle in (low, high):
        if not 0.0 < angle < _HALF_TURN:
            limit = "> 0 and < 180 deg over the whole swing"
            raise InputError("follower.arm angle", f"{np.degrees(angle):.6g} deg", limit)


def disc_lift(eccentricity: float, prime_radius: float, arm: Arm, count: int = 720) -> Lift:
    """Lift of the roller of an arm on an eccentric disc, zero at cam angle 0.

    The roller centre is on a circle of radius r + e about the centre of the disc, which lies e from
    the cam axis, opposite to the roller at zero lift.

    Parameters
    ----------
    eccentricity : float   e, m, > 0
    prime_radius : float   r, of the roller centre at zero lift, m

    Raises
    ------
    InputError
        If the eccentricity is not positive, or the arm does not reach the disc; NaN included.
    """
    positive("lift.eccentricity", eccentricity, "m")
    theta, start = uniform_turn(count), float(arm.angle(prime_radius))
    c, length = arm.centre_distance, arm.length
    first = np.arctan2(arm.sense * length * np.sin(start), c - length * np.cos(start))
    seen, distance = disc_seen(eccentricity, arm, first, theta)
    reach = distance**2 + length**2 - (prime_radius + eccentricity) ** 2
    with np.errstate(invalid="ignore"):
        angle = seen + np.arccos(reach / (2.0 * distance * length))
    return Lift(theta, finite("lift.eccentricity", length * (angle - start)))


def disc_seen(eccentricity: float, arm: Arm, first: float, theta: Array) -> tuple[Array, Array]:
    """Centre of an eccentric disc from the pivot at cam angles (n,), rad: angle from the line to
    the cam axis (n,), rad, and distance (n,), m.

    The angle grows with the lift. At cam angle 0 the centre is opposite to the direction `first`
    from the line of centres, rad.
    """
    around = first + np.pi - theta
    along = arm.centre_distance - eccentricity * np.cos(around)
    across = arm.sense * eccentricity * np.sin(around)
    return np.arctan2(across, along), np.hypot(along, across)


@dataclass(frozen=True, eq=False, repr=False)
class ArmContour(RoundContour):
    """Cam surface under the roller of an arm.

    Parameters
    ----------
    pitch : ArmPath           path of the roller centre
    roller_radius : float     m, > 0, below the prime radius

    Raises
    ------
    InputError
        If the roller does not fit; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: oscillating followers.
    """

    pitch: ArmPath

    def __post_init__(self) -> None:
        require_round("roller.radius", self.roller_radius, self.pitch.radius_base)

    def local_frame(self, theta: ArrayLike) -> Frame:
        normal = self.pitch.normal(theta)
        return Frame(self._inset(theta, normal), normal, self.pitch.tangent(theta))

    def points(self, theta: ArrayLike) -> Array:
        return self._inset(theta, self.pitch.normal(theta))

    def _inset(self, theta: ArrayLike, normal: Array) -> Array:
        inset: Array = self.pitch.points(theta) - self.roller_radius * normal
        return inset

    def motion(self, jet: Jet, friction: Value = 0.0) -> ArmMotion:  # noqa: ARG002
        return self.pitch.centre_motion(jet, self.roller_radius)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        motion = self.motion(self.lift.jet(theta, 3))
        return np.asarray(motion.curvature_slope * motion.contour_speed)

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        """Heights of the follower at rest on a polygon (2, n), m, at cam angles (m,), rad: arc of
        the roller centre from the line of centres (m,), m.
        """
        arm = self.pitch.arm
        reach = arm.to_roller(self.roller_radius)
        return np.asarray(arm.length * arm_angle(polygon, arm.pivot, reach, theta))

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        frame = self.local_frame(theta)
        return frame.point, frame.tangent, self.speed(theta)
