"""Faces of an oscillating follower: a flat one along its arm, and a curved one at its end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arm_path import Arm, ArmContour, ArmMotion, ArmPath, Turned, disc_seen
from camwright.geometry.arrays import Array, Value, finite, positive, uniform_turn
from camwright.geometry.contour import Contour, RoundContour, require_round
from camwright.geometry.errors import InputError, in_millimetres
from camwright.geometry.extrema import greatest
from camwright.geometry.flat_face_contour import FacedContour, PlaneContour, PlaneMotion
from camwright.geometry.follower_height import arm_angle
from camwright.geometry.follower_path import (
    FollowerPath,
    Reaction,
    Slide,
    Sliding,
    cam_axes,
    reciprocal,
)
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import magnitude


@dataclass(frozen=True, eq=False)
class ArmFaceMotion(PlaneMotion):
    """Kinematics and force ratios of a flat face along an arm; see `Motion`.

    At each angle it is a translating flat face of height c sin(psi) - f, whose line turns in the
    cam frame at D = 1 - w psi'. The contact lies c cos(psi) / D from the pivot along the face: the
    lever q of the normal force, whose axial force is that at the length, N q / l.

    Parameters
    ----------
    jet : Jet          arc of the end of the arm and its derivatives
    linkage : Arm
    start : float      psi at zero lift, rad
    offset : float     f, of the plane of the face from the pivot towards the cam, m
    friction : float   of the face on the cam

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: oscillating flat-faced followers.
    """

    jet: Jet
    linkage: Arm
    start: Value
    offset: Value
    friction: Value

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
    def _parts(self) -> tuple[Array, Array]:
        """c sin(psi) and c cos(psi), m."""
        c, angle = self.linkage.centre_distance, self.turned.angle
        return c * np.sin(angle), c * np.cos(angle)

    @cached_property
    def height(self) -> Array:
        return self._parts[0] - self.offset

    @cached_property
    def from_pivot(self) -> Array:
        """Distance of the contact from the pivot along the face, m."""
        return self._parts[1] / self.turning

    @property
    def beside(self) -> Array:
        return self.from_pivot * self.turned.rate

    @cached_property
    def radius(self) -> Array:
        (sine, cosine), turning = self._parts, self.turning
        _, rate, rate_d1, _ = self.turned
        return self.height - sine * (rate / turning) ** 2 + cosine * rate_d1 / turning**3

    @property
    def contour_speed(self) -> Array:
        return self.radius * self.turning

    @property
    def curvature_slope(self) -> Array:
        """Derivative of the curvature of the contour by its arc length, 1/m^2."""
        (sine, cosine), turning = self._parts, self.turning
        _, rate, rate_d1, rate_d2 = self.turned
        drawn = rate - rate**3 / turning**2 + rate_d2 / turning**3
        drawn = drawn + 3.0 * self.linkage.sense * rate_d1**2 / turning**4
        change = cosine * drawn - 3.0 * sine * rate * rate_d1 / turning**3
        return -change / (self.radius**3 * turning)

    @property
    def on_face(self) -> Array:
        return self.linkage.sense * (self.from_pivot - self.linkage.length)

    @property
    def slip(self) -> Array:
        return magnitude(self._slip)

    @cached_property
    def _slip(self) -> Array:
        """`slip`, negative where the cam surface runs outwards over the face."""
        return self._parts[0] - self.offset * self.turning

    @property
    def along_face(self) -> Array:
        """Speed of the contact along the face over cam speed (..., n), m."""
        sense, (_, rate, rate_d1, _) = self.linkage.sense, self.turned
        sine, cosine = self._parts
        change = cosine * rate_d1 / self.turning - sense * sine * rate
        return change / self.turning

    @property
    def arm(self) -> Array:
        """Zero: there is no stem that the force could bend."""
        return np.zeros(self.jet.slope.shape)

    @cached_property
    def lever(self) -> Array:
        """Lever q of the normal force about the pivot over the length."""
        return self.from_pivot / self.linkage.length

    @property
    def gain(self) -> Array:
        return 1.0 / self.lever

    @property
    def pressing(self) -> Array:
        return self.gain

    @property
    def _rubbing(self) -> Array:
        """Friction over axial force, signed like the pressure angle."""
        return self.friction * np.sign(np.real(self._slip)) / self.lever

    @property
    def side(self) -> Array:
        return self._rubbing

    @property
    def sliding(self) -> Array:
        return self._rubbing * self.height

    @property
    def lock(self) -> Array:
        return self._rubbing * self.linkage.sense * self.offset / self.linkage.length

    def reactions(
        self,
        lever: tuple[Array, Array],  # noqa: ARG002
        spacing: Value,  # noqa: ARG002
    ) -> tuple[Reaction, Reaction]:
        """Zero: an arm has no guides."""
        return Reaction(self.arm), Reaction(self.arm)

    def radius_at(self, lift: Value) -> Array:
        return np.asarray(
            self.linkage.face_radius(self.start + lift / self.linkage.length, self.offset)
            + np.zeros(self.jet.lift.shape)
        )


@dataclass(frozen=True, eq=False, repr=False)
class ArmFacePath(FollowerPath):
    """Path of the contact point on a flat face along an arm, in the cam frame.

    Parameters
    ----------
    lift : Lift       arc of the end of the arm, m
    arm : Arm
    start : float     psi at zero lift, rad, within 0 and pi / 2
    offset : float    f, of the plane of the face from the pivot towards the cam, m

    Raises
    ------
    InputError
        If the face does not stay between the cam axis and the line square to it, or turns with the
        cam as fast as it does; NaN included.
    """

    arm: Arm
    start: float
    offset: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a face that leaves the quarter turn between the cam axis and the line square to
        it, or turns with the cam as fast as it does.
        """
        swing = self.lift.lowest.value / self.arm.length, self.lift.highest.value / self.arm.length
        low, high = (self.start + each for each in swing)
        if not high < 0.5 * np.pi:
            value = "none" if np.isnan(high) else f"{np.degrees(high):.6g} deg"
            limit = "< 90 deg over the whole swing of a flat face"
            raise InputError("follower.arm angle", value, limit)
        base = float(self.arm.face_radius(low, self.offset))
        if not base > 0.0:
            shown, _ = in_millimetres(base, 0.0)
            raise InputError("height of the face over the cam axis", shown, "> 0 mm")
        fastest = (
            self.arm.sense
            * greatest(
                lambda theta: self.arm.sense * self.lift(theta, 1), self.lift.search_count
            ).value
            / self.arm.length
        )
        if not self.arm.sense * fastest < 1.0:
            limit = "< 1 rad of the arm per rad of the cam that turns with it"
            raise InputError("follower.arm swing", f"{fastest:.6g} rad/rad", limit)

    @cached_property
    def radius_base(self) -> float:
        return float(self.arm.face_radius(self.start, self.offset))

    @property
    def height_base(self) -> float:
        """Arc from the line of centres to the reference point at zero lift, m."""
        return float(self.arm.length * self.start)

    def with_lift(self, lift: Lift, height_base: float) -> Self:
        return replace(self, lift=lift, start=float(height_base / self.arm.length))

    def enlarged(self, growth: float) -> Self:
        start = self.arm.face_angle(self.radius_base + growth, self.offset)
        return replace(self, start=float(start))

    def face_motion(self, jet: Jet, friction: Value = 0.0) -> ArmFaceMotion:
        """Motion at the angles of a jet with the friction of the face on the cam."""
        return ArmFaceMotion(jet, self.arm, self.start, self.offset, friction)

    def _at(self, theta: ArrayLike) -> ArmFaceMotion:
        return self.face_motion(self.lift.jet(theta, 2))

    def slide(self, theta: ArrayLike, friction: Value = 0.0) -> Slide:
        return sliding_of(self.face_motion(self.lift.jet(theta, 2), friction))

    def travel(self, theta: ArrayLike) -> Array:
        return self.arm.travel(self.start + self.lift(theta) / self.arm.length)

    def _position(self, theta: ArrayLike) -> tuple[Array, Array]:
        motion = self._at(theta)
        return _turned(motion.travel, motion.height, motion.beside)

    def _velocity(self, theta: ArrayLike) -> tuple[Array, Array]:
        motion = self._at(theta)
        return _turned(motion.travel, np.zeros(np.shape(theta)), motion.contour_speed)

    def tangent(self, theta: ArrayLike) -> Array:
        travel = self.travel(theta)
        return cam_axes(theta, -np.sin(travel), np.cos(travel))

    def normal(self, theta: ArrayLike) -> Array:
        travel = self.travel(theta)
        return cam_axes(theta, np.cos(travel), np.sin(travel))

    def pressure_angle(self, theta: ArrayLike) -> Array:
        """Zero: the face is square to the arc of its points but for the offset."""
        return np.zeros(np.shape(theta))

    def push_arm(self, theta: ArrayLike) -> Array:
        """Zero: there is no stem that the force could bend."""
        return np.zeros(np.shape(theta))

    def radius_of_curvature(self, theta: ArrayLike) -> Array:
        """Radius of curvature, m; zero at a cusp, negative where undercut."""
        return self._at(theta).radius

    def speed_and_curvature(self, theta: ArrayLike) -> tuple[Array, Array]:
        motion = self._at(theta)
        return motion.path_speed, reciprocal(motion.radius)


def _turned(travel: Array, along: Array, across: Array) -> tuple[Array, Array]:
    """Components along u and v of a vector given along the travel and square to it; travel :
    direction of the travel from u, counter-clockwise, rad.
    """
    cos, sin = np.cos(travel), np.sin(travel)
    return along * cos - across * sin, along * sin + across * cos


def sliding_of(motion: ArmFaceMotion | CurvedFaceMotion) -> Slide:
    """Forces and speeds of the contact of a face on an arm."""
    return Slide(
        motion.side,
        motion.sliding,
        motion.lever,
        motion.pressing,
        motion.lock,
        motion.slip,
        motion.along_face,
        motion.on_face,
    )


@dataclass(frozen=True, eq=False, repr=False)
class ArmFaceContour(PlaneContour):
    """Cam surface under a flat face along an arm.

    Parameters
    ----------
    pitch : ArmFacePath    path of the contact point
    """

    from_middle: ClassVar[str] = "distance of the contact from the end of the arm"

    pitch: ArmFacePath

    def motion(self, jet: Jet, friction: Value = 0.0) -> ArmFaceMotion:
        return self.pitch.face_motion(jet, friction)

    def curvature_slope(self, theta: ArrayLike) -> Array:
        motion = self.motion(self.lift.jet(theta, 3))
        return np.asarray(motion.curvature_slope * motion.contour_speed)

    def standing(self, polygon: ArrayLike, theta: ArrayLike) -> Array:
        """Positions (m,) of the follower touching points of a cam, m: arm angle,
        between the arm and the line from pivot to cam axis, times the length of the arm.

        The greatest angle at which the face, of any length, touches a point; a point nearer to the
        pivot than the face is none.

        Parameters
        ----------
        polygon : array (2, n)   points of the cam surface in its own axes, m
        theta : array (m,)       cam angles, rad
        """
        arm, offset = self.pitch.arm, self.pitch.offset

        def beyond(distance: Array) -> Array:
            sine = offset / distance
            return np.where(np.abs(sine) <= 1.0, np.arcsin(np.clip(sine, -1.0, 1.0)), -np.inf)

        return np.asarray(arm.length * arm_angle(polygon, arm.pivot, beyond, theta))

    def _track(self, theta: Array) -> tuple[Array, Array, Array]:
        return self.pitch.points(theta), self.pitch.tangent(theta), self.speed(theta)

    def _gap(self, contact: Array, other: Array) -> Array:
        height = self.motion(self.lift.jet(contact, 2)).height
        gap: Array = height - np.sum(self.normal(contact) * self.points(other), 0)
        return gap


@dataclass(frozen=True, eq=False)
class CurvedFaceMotion(ArmMotion, Sliding):
    """Kinematics and force ratios of a round face at the end of an arm, which slides.

    Its friction has the levers l sin(alpha) and w r about the pivot.

    Parameters
    ----------
    friction : float   of the face on the cam
    """

    friction: Value = 0.0

    @property
    def rolls(self) -> bool:
        return False

    @property
    def rolling(self) -> float:  # type: ignore[override]
        """Zero: the face slides."""
        return 0.0

    @property
    def slip(self) -> Array:
        return magnitude(self._slip)

    @cached_property
    def _slip(self) -> Array:
        """`slip`, negative where the cam surface runs clockwise under the face."""
        return self.path_speed - self.size * self.turning

    @property
    def along_face(self) -> Array:
        return self.contour_speed - self._slip

    @property
    def on_face(self) -> Array:
        return self.size * self.along / self.path_speed

    @property
    def lever(self) -> float:
        """One: the normal passes through the end of the arm."""
        return 1.0

    @property
    def _rubbing(self) -> Array:
        """Friction coefficient, signed like the pressure angle."""
        return self.friction * np.sign(np.real(self._slip))

    @property
    def pressing(self) -> Array:
        return 1.0 - self._rubbing * self.tangent

    @property
    def side(self) -> Array:
        return self.tangent + self._rubbing

    @property
    def lock(self) -> Array:
        arm = self.linkage
        return self._rubbing * (self.tangent + arm.sense * self.size * self.gain / arm.length)

    @property
    def sliding(self) -> Array:  # type: ignore[override]
        height, along = self.height, self.along
        lever = (height**2 - self.travel_offset * along) / self.path_speed - self.size
        return self._rubbing * self.gain * lever


@dataclass(frozen=True, eq=False, repr=False)
class CurvedFacePath(ArmPath):
    """Path of the centre of a round face at the end of an arm, in the cam frame.

    Parameters
    ----------
    radius : float    of the face, m
    """

    radius: float

    def slide(self, theta: ArrayLike, friction: Value = 0.0) -> Slide:
        return sliding_of(self.curved_motion(self.lift.jet(theta, 2), friction))

    def curved_motion(self, jet: Jet, friction: Value = 0.0) -> CurvedFaceMotion:
        """Motion at the angles of a jet with the friction of the face on the cam."""
        return CurvedFaceMotion(jet, self.arm, self.start, self.radius, friction)


@dataclass(frozen=True, eq=False, repr=False)
class CurvedFaceContour(FacedContour, ArmContour):
    """Cam surface under a round face at the end of an arm, which slides.

    Parameters
    ----------
    pitch : CurvedFacePath    path of the centre of the face
    roller_radius : float     of the face, that of its path, m

    Raises
    ------
    InputError
        If the face does not fit; NaN included.
    """

    from_middle: ClassVar[str] = "distance of the contact from the middle of the round face"

    pitch: CurvedFacePath

    def __post_init__(self) -> None:
        require_round("follower.face.radius", self.roller_radius, self.pitch.radius_base)

    @classmethod
    def of(cls, path: CurvedFacePath) -> Self:
        """Cam under the face of a path."""
        return cls(path, path.radius)

    def require_roller(self) -> RoundContour:
        return Contour.require_roller(self)

    def motion(self, jet: Jet, friction: Value = 0.0) -> CurvedFaceMotion:
        return self.pitch.curved_motion(jet, friction)


def face_disc_lift(
    eccentricity: float, base_radius: float, arm: Arm, offset: float, count: int = 720
) -> Lift:
    """Lift of a flat face along an arm on an eccentric disc, zero at cam angle 0.

    The disc has the radius r + e and its centre e from the cam axis, opposite to the face at zero
    lift.

    Parameters
    ----------
    eccentricity : float   e, m, > 0
    base_radius : float    r, of the base circle, m
    offset : float         of the plane of the face from the pivot towards the cam, m

    Raises
    ------
    InputError
        If the eccentricity is not positive, or the face does not reach the disc; NaN included.
    """
    positive("lift.eccentricity", eccentricity, "m")
    start = float(arm.face_angle(base_radius, offset))
    first = float(arm.travel(np.asarray(start)))
    seen, distance = disc_seen(eccentricity, arm, first, uniform_turn(count))
    with np.errstate(invalid="ignore"):
        angle = seen + np.arcsin((base_radius + eccentricity + offset) / distance)
    lift = arm.length * (angle - start)
    return Lift(uniform_turn(count), finite("lift.eccentricity", lift))
