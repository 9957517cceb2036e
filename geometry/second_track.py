"""Second track of a cam that pulls its follower: a second disc, or the same under a second face or
with an outer wall under a second roller.

The second roller or face is fixed to the first, on the same stem, arm or pin; its disc is on the
same shaft. Its path follows from that of the first.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arm_path import Arm, ArmContour, ArmMotion, ArmPath
from camwright.geometry.arrays import FULL_TURN, Array, Value, positive
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.errors import GeometryError, InputError, in_millimetres
from camwright.geometry.flat_face_contour import FaceMotion, FacePath, FlatFaceContour
from camwright.geometry.follower_path import FollowerPath, Motion, Slide
from camwright.geometry.form_closure import OuterWall
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import CentrePath, PitchCurve, RollerMotion, RoundMotion

_HALF_TURN = np.pi


class SecondFollower(ABC):
    """Roller or face that is fixed to the first and pulls the follower back."""

    own_disc: ClassVar[bool] = True
    """whether its track is on a disc of its own"""
    radius: float
    """of its surface, m; infinite of a face"""

    @abstractmethod
    def of(self, first: FollowerPath) -> SecondTrack:
        """Track under it, from the path of the first roller or face."""

    def linkage(self, first: Arm) -> Arm:
        """Arm to this roller, from that to the first; of a stem there is none."""
        return first

    @abstractmethod
    def seen_from(self, first: Contour) -> SecondFollower:
        """The first roller or face as that fixed to this one, from its contour."""

    @abstractmethod
    def motion(self, first: Motion, highest: Value) -> SecondMotion:
        """Motion of the second roller or face from that of the first, of one cam or many.

        Parameters
        ----------
        first : Motion            on the unloaded cam at equal cam angles of the turn
        highest : float or array  maximum lift of the first, m
        """

    def along(self, first: Motion, highest: Value) -> SecondMotion:
        """As `motion`, at any cam angles; under a yoke of a cam of constant breadth whose minimum
        lift is zero.
        """
        return self.motion(first, highest)

    def track(self, first: FollowerPath) -> SecondTrack:
        """`of`, computed once for a path."""
        return _kept(self, first)


@dataclass(frozen=True)
class OppositeRoller(SecondFollower):
    """Second roller on the same stem, opposite the first across the cam axis.

    Both centres are a distance apart: r1(theta) + r2(theta + 180 deg) is constant.

    Parameters
    ----------
    distance : float   between the roller centres, m
    radius : float     m
    """

    distance: float
    radius: float

    def path(self, first: PitchCurve) -> PitchCurve:
        """Path of the second roller in the cam frame; its cam angle is half a turn ahead.

        Raises
        ------
        InputError
            If the second roller would reach the cam axis.
        """
        positive("cam.conjugate.distance", self.distance, "m")
        lift = first.lift
        height = self.distance - first.height_base - lift.highest.value
        if not height > 0.0:
            shown, most = in_millimetres(self.distance, first.height_base + lift.highest.value)
            raise InputError("cam.conjugate.distance", shown, f"> {most}: beyond the cam axis")
        values = np.maximum(lift.highest.value - lift(lift.theta - _HALF_TURN), 0.0)
        prime = float(np.hypot(height, first.offset))
        return PitchCurve(replace(lift, values=values), prime, -first.offset)

    def of(self, first: FollowerPath) -> SecondTrack:
        if not isinstance(first, PitchCurve):
            raise InputError("cam.conjugate.distance", "stated", "left out without a stem")
        contour = RollerContour(self.path(first), self.radius)
        return SecondTrack(first, contour, _HALF_TURN, 1.0, self.distance)

    def motion(self, first: Motion, highest: Value) -> SecondMotion:
        if not isinstance(first, RollerMotion):
            raise InputError("cam.conjugate.distance", "stated", "left out without a stem")
        height = self.distance - first.base_height - highest
        jet = _sunk(first.jet, highest, 1.0)
        motion = RollerMotion(jet, height, -np.asarray(first.offset), self.radius)
        return SecondMotion(motion, np.full(jet.lift.shape, _HALF_TURN), 1.0, self.distance)

    def seen_from(self, first: Contour) -> OppositeRoller:
        return replace(self, radius=first.require_roller().roller_radius)


@dataclass(frozen=True)
class ConjugateArm(SecondFollower):
    """Second arm on the same pivot, on the other side of the line of centres.

    Parameters
    ----------
    length : float   pivot to roller centre, m
    angle : float    from the second arm to the first, rad, > the greatest angle of the first
    radius : float   of its roller, m
    """

    length: float
    angle: float
    radius: float

    def path(self, first: ArmPath) -> ArmPath:
        """Path of the second roller in the cam frame.

        Its arm angle is that between the arms less the first one: it swings away from the cam where
        the first swings towards it. Its lift is counted from its own innermost position.

        Raises
        ------
        InputError
            If the second arm does not stay on the other side of the line of centres.
        """
        positive("cam.conjugate.arm_length", self.length, "m")
        top, lift = first.lift.highest.value, first.lift
        start = self.angle - (first.start + top / first.arm.length)
        if not start > 0.0:
            limit = (
                f"> {np.degrees(self.angle - start):.5g} deg, the greatest arm angle of the first"
            )
            raise InputError("cam.conjugate.arm_angle", f"{np.degrees(self.angle):.5g} deg", limit)
        ratio = self.length / first.arm.length
        values = np.maximum(ratio * (top - lift.values), 0.0)
        return ArmPath(replace(lift, values=values), self.linkage(first.arm), float(start))

    def linkage(self, first: Arm) -> Arm:
        return Arm(first.centre_distance, self.length, -first.sense)

    def of(self, first: FollowerPath) -> SecondTrack:
        if not isinstance(first, ArmPath):
            raise InputError("cam.conjugate.arm_length", "stated", "left out without an arm")
        contour = ArmContour(self.path(first), self.radius)
        return SecondTrack(first, contour, 0.0, float(first.arm.length / self.length), 0.0)

    def motion(self, first: Motion, highest: Value) -> SecondMotion:
        if not isinstance(first, ArmMotion):
            raise InputError("cam.conjugate.arm_length", "stated", "left out without an arm")
        linkage, leverage = first.linkage, first.linkage.length / self.length
        start = self.angle - (first.start + highest / linkage.length)
        jet = _sunk(first.jet, highest, 1.0 / leverage)
        motion = ArmMotion(jet, self.linkage(linkage), start, self.radius)
        return SecondMotion(motion, np.asarray(motion.travel - first.travel), leverage, 0.0)

    def seen_from(self, first: Contour) -> ConjugateArm:
        if not isinstance(first.pitch, ArmPath):
            raise InputError("cam.conjugate.arm_length", "stated", "left out without an arm")
        radius = first.require_roller().roller_radius
        return ConjugateArm(float(first.pitch.arm.length), self.angle, radius)


@dataclass(frozen=True)
class OppositeFace(SecondFollower):
    """Second face of a yoke, parallel to the first on the other side of the same cam.

    It touches the contour half a turn after the first, whose breadth h(theta) + h(theta + 180 deg)
    is constant.
    """

    own_disc: ClassVar[bool] = False
    radius: float = np.inf

    def of(self, first: FollowerPath) -> SecondTrack:
        if not isinstance(first, FacePath):
            raise InputError("cam.yoke", "a table", "left out without a flat face on a stem")
        contour = FlatFaceContour(replace(first, offset=-first.offset))
        breadth = 2.0 * first.base_radius + first.lift.highest.value
        return SecondTrack(first, contour, _HALF_TURN, 1.0, breadth)

    def motion(self, first: Motion, highest: Value) -> SecondMotion:
        if not isinstance(first, FaceMotion):
            raise InputError("cam.yoke", "a table", "left out without a flat face on a stem")
        count = first.jet.lift.shape[-1]
        if count % 2:
            raise InputError("positions", count, "even: a yoke has faces half a turn apart")
        jet = first.jet.at(lambda values: np.roll(values, count // 2, axis=-1))
        return self._under(first, jet, highest)

    def along(self, first: Motion, highest: Value) -> SecondMotion:
        if not isinstance(first, FaceMotion):
            raise InputError("cam.yoke", "a table", "left out without a flat face on a stem")
        return self._under(first, _sunk(first.jet, highest, 1.0), highest)

    @staticmethod
    def _under(first: FaceMotion, jet: Jet, highest: Value) -> SecondMotion:
        """Motion of the second face from its lift at the cam angles of the first."""
        base = np.asarray(first.base_height)
        motion = FaceMotion(jet, base, -np.asarray(first.offset), first.friction)
        turned = np.full(jet.lift.shape, _HALF_TURN)
        return SecondMotion(motion, turned, 1.0, 2.0 * base + highest)

    def seen_from(self, first: Contour) -> OppositeFace:  # noqa: ARG002
        return self


@dataclass(frozen=True)
class CoaxialRoller(SecondFollower):
    """Second roller on the pin of the first, on the outer wall of a groove of two steps.

    Both have one path; the outer wall is its parallel curve at the radius of the second roller, as
    the inner one is at that of the first.

    Parameters
    ----------
    radius : float   m
    """

    own_disc: ClassVar[bool] = False
    radius: float

    def of(self, first: FollowerPath) -> SecondTrack:
        if not isinstance(first, CentrePath):
            raise InputError("cam.groove.second", "a table", "left out without a roller")
        return SecondTrack(first, OuterWall(first, self.radius), 0.0, 1.0, 0.0, _HALF_TURN)

    def motion(self, first: Motion, highest: Value) -> SecondMotion:  # noqa: ARG002
        if not isinstance(first, RollerMotion | ArmMotion):
            raise InputError("cam.groove.second", "a table", "left out without a roller")
        turned = np.full(first.jet.lift.shape, _HALF_TURN)
        return SecondMotion(replace(first, size=-self.radius), turned, 1.0, 0.0)

    def seen_from(self, first: Contour) -> CoaxialRoller:
        return CoaxialRoller(first.require_roller().roller_radius)


def _sunk(jet: Jet, highest: Value, ratio: Value) -> Jet:
    """Lift of a roller that goes down as another goes up, times a ratio; at the same places."""
    sunk = jet.at(lambda values: -ratio * values)
    return sunk._replace(lift=ratio * highest + sunk.lift)


class Touch(NamedTuple):
    """Contact of one track (...): forces over the axial force at the first roller.

    slide; push_arm: lever arm of the axial force about the axis of the stem, m; pressure_angle: in
    the travel of its own roller, rad; turned: that travel from the one of the first, rad.
    """

    slide: Slide
    push_arm: Array
    pressure_angle: Array
    turned: Array


def touch_of(path: FollowerPath, theta: Array, friction: Value = 0.0) -> Touch:
    """Contact of the first track at cam angles, rad, with the friction of a face."""
    angle = path.pressure_angle(theta)
    return Touch(path.slide(theta, friction), path.push_arm(theta), angle, np.zeros(angle.shape))


@dataclass(frozen=True, eq=False)
class SecondTrack:
    """Disc under the second roller; all cam angles are those of the first roller, rad.

    The axial force at the first roller is negative where this track carries.

    Parameters
    ----------
    first : FollowerPath     path of the first roller
    contour : Contour        of the disc, at the cam angles of the second roller
    turn : float             by which these are ahead of those of the first, rad
    leverage : float         force along the travel of the second over that of the first roller
    reach : float            by which it is farther from the guides of a stem, m
    against : float          direction in which it is loaded from that of its travel, rad: half a
                             turn of a roller on the pin of the first
    """

    first: FollowerPath
    contour: Contour
    turn: float
    leverage: float
    reach: float
    against: float = 0.0

    def touch(self, theta: Array, friction: Value = 0.0) -> Touch:
        """Contact with the second roller or face, over the axial force at the first one.

        friction : of a face
        """
        touch = touch_of(self.contour.pitch, theta + self.turn, friction)
        return _from_first(touch, self.turned(theta), self.leverage)

    def turned(self, theta: Array) -> Array:
        """Direction of travel of the second roller from that of the first, rad."""
        travel = self.contour.pitch.travel(theta + self.turn)
        return np.asarray(travel + self.turn - self.first.travel(theta)) + self.against

    def relative_radius(self, theta: Array) -> Array:
        """Relative radius of curvature of the contact, m; negative if undercut."""
        return _relative_radius(self.contour, theta + self.turn)

    def carried(
        self, first: Motion, theta: Array, pulls: NDArray[np.bool_], friction: Value
    ) -> Motion:
        """Motion at cam angles (n,), rad, of the track that carries: this one where it pulls.

        Parameters
        ----------
        first : Motion      of the first roller or face there
        friction : float    of a face
        """
        second = SecondMotion(
            self.motion(theta, friction), self.turned(theta), self.leverage, self.reach
        )
        return second.carried(first, pulls)

    def motion(self, theta: Array, friction: Value = 0.0) -> Motion:
        """Motion of the second roller or face in its own travel at cam angles (n,), rad.

        friction : of a face
        """
        return self.contour.motion(self.contour.lift.jet(theta + self.turn, 2), friction)


def _from_first(touch: Touch, turned: Array, leverage: Value) -> Touch:
    """Contact of a second roller or face in its own travel, over the axial force at the first.

    Parameters
    ----------
    turned : array (...)   direction of its travel from that of the first, rad
    leverage : float       force along it over that along the travel of the first
    """
    cos, sin = np.cos(turned), np.sin(turned)
    side, along, scale = touch.slide.side, touch.slide.pressing, -leverage
    slide = touch.slide._replace(
        side=scale * (side * cos - along * sin),
        torque=scale * touch.slide.torque,
        lever=touch.slide.lever / leverage,
        pressing=scale * (along * cos + side * sin),
    )
    return Touch(slide, scale * touch.push_arm, touch.pressure_angle, turned)


class SecondMotion(NamedTuple):
    """Motion of a second roller or face, of one cam or many, at the cam angles of the first.

    Parameters
    ----------
    motion : Motion       of its own travel
    turned : array (...)  direction of its travel from that of the first, rad
    leverage : float      force along its travel over that along the travel of the first
    reach : float         by which it is farther from the guides of a stem, m
    """

    motion: Motion
    turned: Array
    leverage: Value
    reach: Value

    @property
    def touch(self) -> Touch:
        """Contact of a roller over the axial force at the first one."""
        motion = self.motion
        slide = Slide(motion.side, np.asarray(motion.sliding), 1.0, motion.pressing)
        contact = Touch(slide, motion.arm, motion.pressure_angle, self.turned)
        return _from_first(contact, self.turned, self.leverage)

    def carried(self, first: Motion, pulls: NDArray[np.bool_]) -> Motion:
        """Motion (...) of the track that carries: this one where it pulls."""
        if isinstance(first, FaceMotion):
            base = first.base_height
            return CarriedFaceMotion.of(first, base, self.motion.jet, pulls)
        return CarriedMotion.of(first, self.motion, pulls, self.touch)


class CamDisc(NamedTuple):
    """Contour of a disc, and by how much its cam angles are ahead of those of the first, rad."""

    contour: Contour
    turn: float

    def angle(self, theta: float) -> float:
        """Cam angle of the first roller at one of this disc, rad."""
        return float(np.mod(theta - self.turn, FULL_TURN))


def discs_of(contour: Contour, second: SecondFollower | None) -> tuple[CamDisc, ...]:
    """Disc of the first contour, and that of a second roller."""
    first = CamDisc(contour, 0.0)
    if second is None or not second.own_disc:
        return (first,)
    track = second.track(contour.pitch)
    return first, CamDisc(track.contour, track.turn)


def relative_radius(
    contour: Contour, second: SecondFollower | None, theta: Array, wall: Array
) -> Array:
    """Relative radius of curvature (...), m, on the track that carries: 1 the first or inner wall,
    -1 the second, or without one the outer wall of a groove; negative if undercut.
    """
    if second is None:
        return contour.require_roller().relative_radius(theta, wall)
    first = _relative_radius(contour, theta)
    return np.where(wall < 0.0, second.track(contour.pitch).relative_radius(theta), first)


def _relative_radius(contour: Contour, theta: Array) -> Array:
    """Relative radius of curvature (...), m, of a contour and its follower."""
    return np.asarray(1.0 / (contour.follower_curvature + contour.curvature(theta)))


@lru_cache(maxsize=64)
def _kept(second: SecondFollower, first: FollowerPath) -> SecondTrack:
    return second.of(first)


@dataclass(frozen=True, eq=False)
class CarriedFaceMotion(FaceMotion):
    """Kinematics and force ratios of the face of a yoke that carries; see `Motion`.

    jet and offset are those of the face that carries, in its own axes.

    Parameters
    ----------
    sense : array (..., n)   1 where the first face carries, -1 the second
    """

    sense: Array

    @classmethod
    def of(
        cls, first: FaceMotion, base: Value, jet: Jet, pulls: NDArray[np.bool_]
    ) -> CarriedFaceMotion:
        """From the motion of the first face, height at zero lift and lift of the second at its cam
        angles.
        """
        mixed = Jet(*(np.where(pulls, *pair) for pair in zip(jet[:3], first.jet[:3], strict=True)))
        sense = np.where(pulls, -1.0, 1.0)
        offset = sense * first.offset
        return cls(mixed, base, offset, first.friction, sense)

    @cached_property
    def arm(self) -> Array:
        """Lever arm of the axial force at the first face about the stem axis."""
        return self.sense * (self.jet.slope - self.offset)

    @property
    def sliding(self) -> Array:
        return self.sense * self.friction * self.height

    @property
    def on_face(self) -> Array:
        return self.jet.slope - self.offset


def _chosen(pulls: NDArray[np.bool_], second: Value, first: Value) -> Array:
    return np.asarray(np.where(pulls, second, first))


@dataclass(frozen=True, eq=False)
class CarriedMotion(RoundMotion):
    """Kinematics and force ratios of the roller that carries at each cam angle; see `Motion`.

    Those of the first roller or of the second one, each in its own travel; forces are over the
    axial force at the first.

    Parameters
    ----------
    jet : Jet                   lift of the first roller
    size : array (..., n)       radius of the roller that carries, m
    first, second : RoundMotion of a roller
    pulls : array (..., n)      bool: whether the second track carries
    touch : Touch               of the second track
    """

    jet: Jet
    size: Value
    first: RollerMotion | ArmMotion
    second: RollerMotion | ArmMotion
    pulls: NDArray[np.bool_]
    touch: Touch

    @classmethod
    def of(
        cls, first: Motion, second: Motion, pulls: NDArray[np.bool_], touch: Touch
    ) -> CarriedMotion:
        """From both motions at the same angles, and the contact of the second track.

        Raises
        ------
        GeometryError
            If one of them is not that of a roller.
        """
        rollers = RollerMotion, ArmMotion
        if not (isinstance(first, rollers) and isinstance(second, rollers)):
            raise GeometryError("the follower on the second track is no roller")
        size = np.where(pulls, second.size, first.size)
        return cls(first.jet, size, first, second, pulls, touch)

    def _of(self, name: str) -> Array:
        return _chosen(self.pulls, getattr(self.second, name), getattr(self.first, name))

    def _force(self, name: str) -> Array:
        pulled = getattr(self.touch.slide, name)
        return _chosen(self.pulls, pulled, getattr(self.first, name))

    @property
    def rolls(self) -> bool:
        return True

    @property
    def sliding(self) -> float:
        """Zero: both rollers roll."""
        return 0.0

    @property
    def travel(self) -> Value:
        """Direction of travel of the first roller."""
        return self.first.travel

    @property
    def turned(self) -> Array:
        """Direction of travel of the roller that carries from that of the first, rad."""
        return np.where(self.pulls, self.touch.turned, 0.0)

    @property
    def height(self) -> Array:
        return self._of("height")

    @property
    def travel_offset(self) -> Value:
        return self._of("travel_offset")

    @property
    def along(self) -> Array:
        return self._of("along")

    @cached_property
    def _path(self) -> tuple[Array, Array]:
        return self._of("path_speed"), self._of("path_curvature")

    @property
    def path_curvature_slope(self) -> Array:
        return self._of("path_curvature_slope")

    @property
    def rolling(self) -> Array:
        return self._of("rolling")

    @property
    def slide_slope(self) -> Array:
        return self._of("slide_slope")

    @property
    def prime_radius(self) -> Array:
        return self._of("prime_radius")

    @property
    def side(self) -> Array:
        return self._force("side")

    @property
    def pressing(self) -> Value:
        return self._force("pressing")

    @cached_property
    def gain(self) -> Array:
        levered = np.where(self.pulls, self.touch.slide.lever, 1.0)
        return np.sqrt(1.0 + self.tangent**2) / levered

    def radius_at(self, lift: Value) -> Array:
        """Of the first disc."""
        return self.first.radius_at(lift)
