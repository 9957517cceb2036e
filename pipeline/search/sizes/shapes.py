"""Prime or base radius, offset, roller and face of an open case, by geometric limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from camwright.geometry.arm_path import Arm
from camwright.geometry.arm_size import ArmCam, ArmFaceCam
from camwright.geometry.arrays import Array
from camwright.geometry.cam_size import (
    EccentricCam,
    FaceCam,
    GivenLiftCam,
    PitchLimits,
    PlaneCam,
    RollerCam,
    RollerSize,
)
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import least_argument
from camwright.geometry.lift_parts import LiftParts
from camwright.pipeline.base.crossing import first_passing
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import unit_at, value_of
from camwright.pipeline.case.lift_section import LiftEccentric, LiftSegments, motion_of
from camwright.pipeline.case.limits import (
    CURVATURE_RATIO,
    MINIMUM_WALL,
    PRESSURE_ANGLE,
    RETURN_PRESSURE_ANGLE,
    UNDERCUT_FACTOR,
)
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.cam_shape import least_concave_radius
from camwright.pipeline.contact.cam_body import CamConjugate
from camwright.pipeline.records.size_document import FaceSizeRecord, RollerSizeRecord, SizeLengths
from camwright.pipeline.search.sizes.open_case import (
    APART,
    ARMS_ANGLE,
    DISTANCE,
    FACE,
    OFFSET,
    PLACES,
    PRIME,
    ROLLER,
    SECOND_ROLLER,
    OpenCase,
)
from camwright.pipeline.smoothing.required_lift import cam_lift

DIGITS = 6
"""Decimal digits of a sized length in m: a micrometre."""
_ROLLER_HALVINGS = 10
"""Of the range of a roller; a thousandth of the tool radius is left."""
_DRAWN_DEGREES = 1e4
"""Parts of a degree in an angle between arms on a drawing."""
_RADII_THAT_TIE = 1e-9
"""Relative difference of two radii up to which they are equal."""


BALANCE = "least pressure angle of rise against return within the curvature"
SMALLEST = "smallest base radius"
NARROWEST = "narrowest face"


class Shape(NamedTuple):
    """Prime or base radius, offset, roller radius or face width, m; governing limit in words.

    Under a flat face the prime radius is the base radius; of an arm the centre distance is in place
    of the offset. second_place: of the second roller of a pair of discs, distance of the rollers on
    a stem, m, or angle between the arms, rad.
    """

    prime_radius: float
    offset: float
    roller_radius: float
    face_width: float
    governs: str
    offset_governs: str = BALANCE
    second_place: float = 0.0
    second_roller: float = 0.0

    @property
    def base_radius(self) -> float:
        """Radius of the base circle, m."""
        return self.prime_radius - self.roller_radius


@dataclass(frozen=True, eq=False)
class SecondDiscShape:
    """Second disc of a conjugate pair, whose size follows from that of the first and the place of
    its roller.

    Parameters
    ----------
    case : Case           with the arms of the rollers, or their stem
    pair : CamConjugate   of the case
    gaps : tuple          open keys
    """

    case: Case
    pair: CamConjugate
    gaps: tuple[str, ...]

    @property
    def placed(self) -> bool:
        """Whether the case states the place of its roller."""
        return not {*PLACES} & {*self.gaps}

    @property
    def rolls_as_first(self) -> bool:
        """Whether its roller is open, and then like the first."""
        return SECOND_ROLLER in self.gaps

    @property
    def _stated(self) -> float:
        """Place of the roller in the case: distance, m, or angle, rad."""
        apart = self.pair.arm_angle if self.pair.distance is None else self.pair.distance
        return float("nan") if apart is None else apart

    def roller(self, shape: Shape) -> float:
        """Radius of its roller, m."""
        return shape.roller_radius if self.rolls_as_first else self.pair.roller_radius

    def cam(self, lift: LiftParts) -> RollerCam:
        """Cam of its roller, by the lift of the first."""
        arm, length = self.case.follower.arm, self.pair.arm_length
        if arm is None or length is None:
            return GivenLiftCam(lift.sunk())
        return ArmCam(lift.sunk(length / arm.length), length, -arm.sense)

    def aside(self, shape: Shape) -> float:
        """Offset of its roller, m; of an arm the centre distance."""
        return shape.offset if self.case.follower.arm is not None else -shape.offset

    def _first(self, shape: Shape, lift: LiftParts) -> float:
        """Part of the place by the first roller at maximum lift: height, m, or arm angle, rad."""
        arm, top = self.case.follower.arm, lift.greatest(lambda s, *_: s).value
        if arm is None:
            return float(np.sqrt(shape.prime_radius**2 - shape.offset**2)) + top
        linkage = Arm(shape.offset, arm.length, arm.sense)
        return float(linkage.angle(shape.prime_radius)) + top / arm.length

    def _linkage(self, shape: Shape) -> Arm | None:
        """Arm of its roller; None of a stem."""
        arm, length = self.case.follower.arm, self.pair.arm_length
        if arm is None or length is None:
            return None
        return Arm(shape.offset, length, -arm.sense)

    def place(self, shape: Shape, lift: LiftParts, prime: float) -> float:
        """Place of its roller, m or rad, with a prime radius, m, rounded up to that of a drawing;
        that of the case where it is stated.
        """
        if self.placed:
            return self._stated
        arm, first = self._linkage(shape), self._first(shape, lift)
        if arm is None:
            return rounded_up(first + float(np.sqrt(prime**2 - shape.offset**2)))
        degrees = np.degrees(first + float(arm.angle(prime)))
        return float(np.radians(np.ceil(_DRAWN_DEGREES * degrees) / _DRAWN_DEGREES))

    def prime_radius(self, shape: Shape, lift: LiftParts) -> float:
        """Its prime radius, m, with the place of its roller; NaN where that is beyond the axis."""
        left, arm = shape.second_place - self._first(shape, lift), self._linkage(shape)
        if not left > 0.0:
            return np.nan
        return float(np.hypot(left, shape.offset) if arm is None else arm.radius(left))


@dataclass(frozen=True, eq=False)
class RollerShapes:
    """Shapes of a cam under a roller or the curved face of an arm within the geometric limits of a
    case.

    Parameters
    ----------
    case : Case            with provisional values of the open keys
    gaps : tuple           open keys
    cam : RollerCam
    least_radius : float   least convex radius of the contour, m, >= 0
    second : SecondDiscShape    of a pair of discs; None without one
    """

    case: Case
    gaps: tuple[str, ...]
    cam: RollerCam
    least_radius: float = 0.0
    second: SecondDiscShape | None = None

    @property
    def _aside(self) -> str:
        """Key of the offset, or of the centre distance of an arm."""
        return aside_of(self.case)

    @property
    def _stated(self) -> float:
        """Offset or centre distance of the case, m."""
        return float(value_of(self.case, self._aside))

    @cached_property
    def angle_limits(self) -> PitchLimits:
        """Limits of the pressure angle alone."""
        return PitchLimits(*self._angles)

    @property
    def _angles(self) -> tuple[float, float]:
        """Limits of the pressure angle on rise and return, rad."""
        rise = self.case.limits[PRESSURE_ANGLE]
        return rise, self.case.limits[RETURN_PRESSURE_ANGLE] or rise

    @property
    def _convex_share(self) -> float:
        """Least convex radius of the pitch curve over the roller radius."""
        limits = self.case.limits
        return max(limits[CURVATURE_RATIO], 1.0 / (1.0 - limits[UNDERCUT_FACTOR]))

    def limits(self, roller_radius: float) -> PitchLimits:
        """Limits of the pitch curve of a roller radius, m."""
        tool = least_concave_radius(self.case) or 0.0
        convex = max(self._convex_share * roller_radius, roller_radius + self.least_radius)
        return PitchLimits(*self._angles, convex, max(tool - roller_radius, 0.0))

    @property
    def _least_roller(self) -> float:
        """Radius of roller or curved face, m; the smallest roller that fits its bearing where it is
        open.
        """
        return self.case.contact_radius

    def smallest(self) -> Shape:
        """Smallest shape of the cam within the geometric limits, with the smallest roller, and the
        limits that govern it.

        The prime radius is the greatest of those by pressure angle, curvature and wall around the
        bore; a stated one is kept.

        Raises
        ------
        InputError
            If a stated prime radius is too small for any.
        """
        if PRIME not in self.gaps:
            prime, roller = self.case.cam.prime_radius, self._least_roller
            stated = Shape(prime, self._offset(prime, roller), roller, 0.0, "given")
            return self._paired(self._faced(stated))
        roller = self._roller_of_tool()
        limits = self.limits(roller)
        offset = rounded(self._smallest(limits).offset)
        prime = by_angle = self.cam.least_prime_radius(self.angle_limits, offset)
        governs, by_offset = f"pressure angle of {shown(limits.rise, 'deg')}", SMALLEST
        if limits.back != limits.rise:
            governs += f", {shown(limits.back, 'deg')} on the return"
        by_curvature = self.cam.least_prime_radius(limits, offset)
        if by_curvature > by_angle * (1.0 + _RADII_THAT_TIE):
            prime, governs = by_curvature, "curvature of the pitch curve"
        wall = least_base_circle(self.case) + roller
        if wall > prime:
            prime, governs = wall, "wall around the bore"
            offset, by_offset = self._offset(prime, roller), BALANCE
        return self._paired(self._faced(Shape(prime, offset, roller, 0.0, governs, by_offset)))

    def _paired(self, shape: Shape, prime: float = 0.0) -> Shape:
        """Shape with the second disc of a pair: of a prime radius, m, but not smaller than its
        limits allow.

        Raises
        ------
        InputError
            If a stated place of its roller leaves it a smaller one.
        """
        if self.second is None:
            return shape
        lift, roller = self.parts(shape), self.second.roller(shape)
        cam, aside = self.second.cam(lift), self.second.aside(shape)
        least = cam.least_prime_radius(self.limits(roller), aside)
        least = max(least, least_base_circle(self.case) + roller)
        apart = self.second.place(shape, lift, max(least, prime))
        paired = shape._replace(second_place=apart, second_roller=roller)
        left = self.second.prime_radius(paired, lift)
        if not left >= least * (1.0 - _RADII_THAT_TIE):
            key = APART if self.case.follower.arm is None else ARMS_ANGLE
            least_words = f"farther: the second disc needs a prime radius of {shown(least, 'mm')}"
            raise InputError(key, shown(apart, unit_at(key)), least_words)
        return paired

    def _second_prime(self, shape: Shape) -> float:
        """Prime radius of the second disc of a pair, m; 0 without one."""
        return 0.0 if self.second is None else self.second.prime_radius(shape, self.parts(shape))

    def _faced(self, shape: Shape) -> Shape:
        """Shape with the narrowest curved face, whose contact lies r sin(alpha) from its middle;
        unchanged where the face is not open.
        """
        if FACE not in self.gaps:
            return shape
        angle = self.cam.extremes(shape.prime_radius, shape.offset).pressure_angle.value
        return shape._replace(face_width=2.0 * shape.roller_radius * float(np.sin(angle)))

    def _smallest(self, limits: PitchLimits) -> RollerSize:
        """Smallest prime radius within limits of the pitch curve, and its offset, m: the best one
        where the offset is open, else that of the case.
        """
        if self._aside in self.gaps:
            return self.cam.smallest(limits)
        offset = self._stated
        return RollerSize(self.cam.least_prime_radius(limits, offset), offset)

    def _roller_of_tool(self) -> float:
        """Radius of the smallest roller, m; where the radius is open, of the smallest one from
        which on the tool requires no larger cam.

        A concave contour has the radius of its pitch curve and that of the roller: the greater the
        roller, the better a tool fits.
        """
        low, tool = self._least_roller, least_concave_radius(self.case) or 0.0

        def fits(roller: float) -> float | None:
            """The roller radius, m, if the tool machines the contour under it without a larger cam;
            else None.
            """
            if not roller < tool:
                return roller
            without = self._smallest(replace(self.limits(roller), concave_radius=0.0))
            concave = self.cam.extremes(*without).concave_radius.value
            return None if concave * (1.0 + _RADII_THAT_TIE) < tool - roller else roller

        if ROLLER not in self.gaps or fits(low) is not None:
            return low
        return first_passing(fits, low, (tool,), _ROLLER_HALVINGS) or tool

    def _offset(self, prime: float, roller: float) -> float:
        if self._aside not in self.gaps:
            return self._stated
        return rounded(self.cam.best_offset(prime, self.limits(roller)))

    def enlarged(self, shape: Shape, prime: float, governs: str) -> Shape:
        """Shape with a larger prime radius, m, and its best offset; the second disc of a pair in
        proportion, alone where the prime radius is stated.
        """
        share = prime / shape.prime_radius
        if PRIME not in self.gaps:
            return self._paired(shape, share * self._second_prime(shape))
        offset = self._offset(prime, shape.roller_radius)
        larger = Shape(prime, offset, shape.roller_radius, shape.face_width, governs, BALANCE)
        return self._paired(self._faced(larger), share * self._second_prime(shape))

    def with_radius(self, shape: Shape, prime: float) -> Shape:
        """A shape with another prime radius, m, and the narrowest face for it where it is open; the
        second disc of a pair larger by the profile tolerance.
        """
        larger = self._faced(shape._replace(prime_radius=prime))
        return self._paired(larger, self._second_prime(shape) + allowance(self.case))

    def parts(self, shape: Shape) -> LiftParts:
        """Lift of a shape."""
        return self.cam.parts(shape.prime_radius, shape.offset)

    def words(self, shape: Shape) -> str:
        """Sentence on the extremes of a shape: pressure angles, convex pitch radius, and the range
        of the roller where it is open.
        """
        pitch = self.cam.extremes(shape.prime_radius, shape.offset)
        words = (
            f"pressure angle {shown(pitch.rise.value, 'deg')} on the rise,"
            f" {shown(pitch.back.value, 'deg')} on the return; convex pitch radius"
            f" {shown(pitch.convex_radius.value, 'mm')}"
        )
        if self.second is not None:
            other = self.second.cam(self.parts(shape))
            prime = self._second_prime(shape)
            pair = other.extremes(prime, self.second.aside(shape))
            words += (
                f"; second disc: prime radius {shown(prime, 'mm', 6)}, pressure angle"
                f" {shown(pair.pressure_angle.value, 'deg')}, convex pitch radius"
                f" {shown(pair.convex_radius.value, 'mm')}"
            )
        if ROLLER not in self.gaps:
            return words
        low, high = self.roller_range(shape)
        return f"{words}; roller {shown(low, 'mm')} to {shown(high, 'mm')}"

    def record(self, shape: Shape) -> RollerSizeRecord:
        """Record of a shape with its extremes on the exact lift."""
        pitch = self.cam.extremes(shape.prime_radius, shape.offset)
        concave, swings = pitch.concave_radius.value, self._aside == DISTANCE
        record: RollerSizeRecord = {
            **_lengths(shape._replace(offset=0.0) if swings else shape),
            "prime_radius_mm": in_unit(shape.prime_radius, "mm"),
            "roller_radius_mm": in_unit(shape.roller_radius, "mm"),
            "pressure_angle_rise_deg": in_unit(pitch.rise.value, "deg"),
            "pressure_angle_rise_at_deg": in_unit(pitch.rise.theta, "deg"),
            "pressure_angle_return_deg": in_unit(pitch.back.value, "deg"),
            "pressure_angle_return_at_deg": in_unit(pitch.back.theta, "deg"),
            "convex_pitch_radius_min_mm": in_unit(pitch.convex_radius.value, "mm"),
            "concave_pitch_radius_min_mm": in_unit(concave, "mm") if np.isfinite(concave) else None,
        }
        if swings:
            record["centre_distance_mm"] = in_unit(shape.offset, "mm")
        if self.second is not None:
            record["second_prime_radius_mm"] = in_unit(self._second_prime(shape), "mm")
            record["second_roller_radius_mm"] = in_unit(shape.second_roller, "mm")
        return record

    def roller_range(self, shape: Shape) -> tuple[float, float]:
        """Least and greatest roller radius of a shape by bearing, curvature, tool and wall, m."""
        least, most = self._range_on(self.cam, shape.prime_radius, shape.offset)
        if self.second is None or not self.second.rolls_as_first:
            return least, most
        other = self.second.cam(self.parts(shape))
        on = self._range_on(other, self._second_prime(shape), self.second.aside(shape))
        return max(least, on[0]), min(most, on[1])

    def _range_on(self, cam: RollerCam, prime: float, aside: float) -> tuple[float, float]:
        """Least and greatest roller radius on a disc of a prime radius, m; see `roller_range`."""
        small = prime - allowance(self.case)
        pitch = cam.extremes(small, aside)
        convex = pitch.convex_radius.value
        most = min(convex / self._convex_share, convex - self.least_radius)
        most = min(most, small - least_base_circle(self.case))
        tool = least_concave_radius(self.case) or 0.0
        return max(self._least_roller, tool - pitch.concave_radius.value), most

    def best_roller(self, shape: Shape, force: Array, curvature: Array) -> Shape:
        """The shape with the roller of the least contact pressure, p0^2 ~ F (1/r + kappa_c).

        A bearing whose ring fits is the roller itself.

        Parameters
        ----------
        force, curvature : array (...)   normal force, N, and curvature of the pitch curve, 1/m
        """
        least, most = self.roller_range(shape)
        if not least <= most:
            limit = f"<= {shown(most, 'mm')} by curvature and wall at this prime radius"
            raise InputError(ROLLER, shown(least, "mm"), limit)
        ring = self.case.roller.bearing.ring
        if ring is not None:
            return self._rolling(shape, least)

        def pressed(radius: float) -> float:
            return float(np.max(force / (radius * (1.0 - radius * curvature))))

        radius = rounded(least_argument(pressed, least, most))
        return self._rolling(shape, float(np.clip(radius, least, most)))

    def _rolling(self, shape: Shape, radius: float) -> Shape:
        """A shape with another roller, m; on both discs where both are open."""
        rolling = shape._replace(roller_radius=radius)
        if self.second is None:
            return rolling
        return rolling._replace(second_roller=self.second.roller(rolling))


@dataclass(frozen=True, eq=False)
class FaceShapes:
    """Shapes of a flat-face cam within the geometric limits of a case; see `RollerShapes`."""

    case: Case
    gaps: tuple[str, ...]
    cam: PlaneCam
    least_radius: float = 0.0

    @property
    def _aside(self) -> str:
        """Key of the offset, or of the centre distance of an arm."""
        return aside_of(self.case)

    @property
    def _stated(self) -> float | None:
        """Offset or centre distance of the case, m; None: open."""
        return None if self._aside in self.gaps else float(value_of(self.case, self._aside))

    def smallest(self) -> Shape:
        """Smallest shape of the cam within the geometric limits, with the narrowest face, and the
        limits that govern it.

        The base radius is the greatest of those by undercut factor, radius of curvature and wall
        around the bore; a stated one is kept.
        """
        case, base, governs = self.case, self.case.cam.prime_radius, "given"
        if PRIME in self.gaps:
            factor, stated = case.limits[UNDERCUT_FACTOR], self._stated
            base = self.cam.least_base_radius(undercut_factor=factor, offset=stated)
            governs = f"undercut factor of {factor:g}"
            by_radius = self.cam.least_base_radius(self.least_radius, offset=stated)
            if by_radius > base:
                base = by_radius
                governs = f"radius of curvature of {shown(self.least_radius, 'mm')}"
            wall = least_base_circle(case)
            if wall > base:
                base, governs = wall, "wall around the bore"
        return self._of(base, governs)

    def _of(self, base: float, governs: str) -> Shape:
        """Shape of a base radius, m, with the narrowest face and its offset where they are open."""
        stated = self._stated
        offset = rounded(self.cam.best_offset(base)) if stated is None else stated
        if FACE in self.gaps:
            width = self.cam.face_width(offset, base)
        else:
            width = float(value_of(self.case, FACE))
        return Shape(base, offset, 0.0, width, governs, NARROWEST)

    def with_radius(self, shape: Shape, prime: float) -> Shape:
        """A shape with another base radius, m, and the narrowest face for it where it is open."""
        shape = shape._replace(prime_radius=prime)
        if FACE not in self.gaps:
            return shape
        return shape._replace(face_width=self.cam.face_width(shape.offset, prime))

    def parts(self, _: Shape) -> LiftParts:
        """Lift of any shape."""
        return self.cam.lift

    def words(self, shape: Shape) -> str:
        """Extremes of a shape in words."""
        base, offset = shape.prime_radius, shape.offset
        least = self.cam.least_radius(base, offset)
        return (
            f"least radius of curvature {shown(least.value, 'mm')}, undercut factor"
            f" {self.cam.undercut_factor(base, offset):.4g}, face at least"
            f" {shown(self.cam.face_width(offset, base), 'mm')} wide"
        )

    def record(self, shape: Shape) -> FaceSizeRecord:
        """Record of a shape with its extremes on the exact lift."""
        base, offset = shape.prime_radius, shape.offset
        swings = self._aside == DISTANCE
        record: FaceSizeRecord = {
            **_lengths(shape._replace(offset=0.0) if swings else shape),
            "face_width_mm": in_unit(shape.face_width, "mm"),
            "radius_of_curvature_min_mm": in_unit(self.cam.least_radius(base, offset).value, "mm"),
            "undercut_factor_min": self.cam.undercut_factor(base, offset),
        }
        if swings:
            record["centre_distance_mm"] = in_unit(offset, "mm")
        return record

    def enlarged(self, shape: Shape, prime: float, governs: str) -> Shape:
        """A shape with a larger base radius, m, at least as wide as it is."""
        larger = self._of(prime, governs)
        return larger._replace(face_width=max(larger.face_width, shape.face_width))


Shapes = RollerShapes | FaceShapes


def _lengths(shape: Shape) -> SizeLengths:
    return {
        "base_radius_mm": in_unit(shape.base_radius, "mm"),
        "offset_mm": in_unit(shape.offset, "mm"),
        "governs": shape.governs,
    }


def shapes_of(opened: OpenCase, least_radius: float = 0.0) -> Shapes:
    """Shapes of the cam that an open case allows, of a roller on stem or arm or of a flat face.

    Parameters
    ----------
    opened : OpenCase      case with its open keys
    least_radius : float   least convex radius of the contour, m, >= 0

    Raises
    ------
    InputError
        If the lift cannot be read or follows from no torque, the radius is negative, or the sizes
        of such a follower are not known.
    """
    if not 0.0 <= least_radius < np.inf:
        raise InputError("least radius", least_radius, ">= 0 m")
    case, section, gaps = opened.case, opened.case.lift, opened.gaps
    arm, pair = case.follower.arm, case.cam.conjugate
    second = None if pair is None else SecondDiscShape(case, pair, gaps)
    if isinstance(section, LiftEccentric) and case.follower.kind != "flat":
        if arm is not None:
            limit = "segments, points or a file for the sizes of an arm"
            raise InputError("lift.kind", "eccentric", limit)
        return RollerShapes(case, gaps, EccentricCam(section.eccentricity), least_radius, second)
    if isinstance(section, LiftSegments):
        parts = LiftParts.of_motion(motion_of(section))
    else:
        parts = LiftParts.of_lift(cam_lift(case, engine_torques(case)))
    if case.follower.kind == "flat":
        return FaceShapes(case, gaps, FaceCam(parts), least_radius)
    if arm is not None:
        plane = None if case.follower.face is None else case.follower.face.offset
        if plane is not None:
            of_face = ArmFaceCam(parts, arm.length, arm.sense, plane)
            return FaceShapes(case, gaps, of_face, least_radius)
        return RollerShapes(case, gaps, ArmCam(parts, arm.length, arm.sense), least_radius, second)
    return RollerShapes(case, gaps, GivenLiftCam(parts), least_radius, second)


def aside_of(case: Case) -> str:
    """Key of the offset of a case, or of the centre distance of its arm."""
    return OFFSET if case.follower.arm is None else DISTANCE


def allowance(case: Case) -> float:
    """Half of the profile tolerance, m: possible undersize of the cam."""
    return 0.5 * case.cam.profile_tolerance


def least_base_circle(case: Case) -> float:
    """Least base radius by the wall around the bore, m."""
    return case.limits[MINIMUM_WALL] * case.cam.held_radius


def rounded(length: float) -> float:
    """Length rounded to the last digit of a drawing, m."""
    return round(float(length), DIGITS) + 0.0  # no negative zero


def rounded_up(length: float) -> float:
    """Length rounded up by at least half a drawing digit, m."""
    return round(float(np.ceil(length * 10**DIGITS + 0.5)) / 10**DIGITS, DIGITS)


def values_of(shape: Shape, gaps: tuple[str, ...]) -> Mapping[str, float]:
    """Values of the open keys of a shape, SI."""
    values = {
        PRIME: shape.prime_radius,
        OFFSET: shape.offset,
        DISTANCE: shape.offset,
        ROLLER: shape.roller_radius,
        FACE: shape.face_width,
        APART: shape.second_place,
        ARMS_ANGLE: shape.second_place,
        SECOND_ROLLER: shape.second_roller,
    }
    return {key: value for key, value in values.items() if key in gaps}
