"""Size of a cam by its lift: smallest radius, best offset, width of a face.

A smallest radius is the one from which on every larger radius keeps the limits as well: curvature
need not fall steadily as a cam grows.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, positive
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, least_argument
from camwright.geometry.lift import Jet
from camwright.geometry.lift_parts import LiftPart, LiftParts
from camwright.geometry.pitch_curve import RollerMotion

_ZERO_OFFSET = 1e-9
"""Offset over the range of its search, below which rise and return are alike: no offset."""
_ROOT_HALVINGS = 60  # of the bracket of a prime radius, to round-off
_SCANNED = 25
"""Offsets of a scan where a curvature limits the radius, which need not be convex in the offset."""
_OFFSET_SECTIONS = 32
"""Of the two steps of the scan about its least: 2e-8 of the greatest offset is left."""
_REAL = 1e-6
"""Imaginary over real part up to which a computed root is real: a double root within round-off."""
_BESIDE_AXIS = 1e-9
"""Least distance of the prime radius from the offset, over the offset."""
_OFFSET_SHARE = 0.999
"""Greatest offset over the prime radius."""
_EXTREME_SAMPLES = 721  # of the turn of an eccentric, between which extremes are refined
# Share of a radius of curvature left for the rounding of an offset; use of an offset beyond it.
_OFFSET_ROUNDING, _REFUSED_USE = 1e-3, 100.0


@dataclass(frozen=True)
class PitchLimits:
    """Limits of the pitch curve.

    Parameters
    ----------
    rise, back : float       greatest pressure angle on the rise and on the return, rad
    convex_radius : float    least convex radius of curvature, m; 0: any
    concave_radius : float   least concave radius of curvature, m; 0: any

    Raises
    ------
    InputError
        If an angle is not within 0 to 90 deg, or a radius is negative; NaN included.
    """

    rise: float
    back: float
    convex_radius: float = 0.0
    concave_radius: float = 0.0

    def __post_init__(self) -> None:
        """Refuse angles beyond 0 to 90 deg and negative radii."""
        for name in ("rise", "back"):
            if not 0.0 < getattr(self, name) < 0.25 * FULL_TURN:
                raise InputError(f"pressure angle, {name}", getattr(self, name), "> 0 and < 90 deg")
        for name in ("convex_radius", "concave_radius"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(name, getattr(self, name), ">= 0 m")


class PitchExtremes(NamedTuple):
    """Extremes of a pitch curve over the continuous turn.

    rise, back : Extremum       greatest magnitude of the pressure angle on rise and return, rad
    convex_radius : Extremum    least convex radius of curvature, m
    concave_radius : Extremum   least concave radius of curvature, m; infinite without one
    """

    rise: Extremum
    back: Extremum
    convex_radius: Extremum
    concave_radius: Extremum

    @property
    def pressure_angle(self) -> Extremum:
        """Greatest magnitude of the pressure angle, rad."""
        return max(self.rise, self.back)


class RollerSize(NamedTuple):
    """Prime radius and offset, m."""

    prime_radius: float
    offset: float


class RollerCam(ABC):
    """Cam of a translating roller follower whose prime radius and offset are open.

    Of an arm the centre distance is in place of the offset, see `ArmCam`.
    """

    aside: ClassVar[str] = "offset"
    """Name of what is in place of an offset."""
    has_offset: ClassVar[bool] = True

    def reach(self, offset: float) -> tuple[float, float]:
        """Bounds of the prime radius, m, with an offset, m."""
        return abs(offset), np.inf

    @abstractmethod
    def parts(self, prime_radius: float, offset: float) -> LiftParts:
        """Lift with a prime radius and an offset, m."""

    @abstractmethod
    def least_prime_radius(self, limits: PitchLimits, offset: float = 0.0) -> float:
        """Smallest prime radius, m, with an offset, m."""

    @abstractmethod
    def _by_angle(self, limits: PitchLimits, offset: float) -> float:
        """Smallest prime radius by the pressure angle alone, m."""

    def extremes(self, prime_radius: float, offset: float = 0.0) -> PitchExtremes:
        """Pressure angles and radii of curvature with a prime radius and an offset, m.

        Raises
        ------
        InputError
            If the radius is not positive or the offset not below it; NaN included.
        """
        positive("cam.prime_radius", prime_radius, "m")
        if not abs(offset) < prime_radius:
            raise InputError("cam.offset", offset, f"below {prime_radius:.6g} m, the prime radius")
        parts = self.parts(prime_radius, offset)
        height = float(np.sqrt(prime_radius**2 - offset**2))

        def curvature(s: Array, s1: Array, s2: Array) -> Array:
            return _motion(Jet(s, s1, s2), height, offset).path_curvature

        convex, concave = parts.greatest(curvature), parts.least(curvature)
        return PitchExtremes(
            *_angles(parts, height, offset),
            Extremum(1.0 / convex.value, convex.theta),
            Extremum(-1.0 / concave.value if concave.value < 0.0 else np.inf, concave.theta),
        )

    def best_offset(self, prime_radius: float, limits: PitchLimits) -> float:
        """Offset, m, at which rise and return use equal shares of their pressure-angle limits.

        Within the limits of the curvature, less a thousandth for a rounded offset; where no offset
        keeps them, the offset of the least curvature.
        """
        positive("cam.prime_radius", prime_radius, "m")
        most = _OFFSET_SHARE * prime_radius

        def use(offset: float) -> float:
            height = float(np.sqrt(prime_radius**2 - offset**2))
            rise, back = _angles(self.parts(prime_radius, offset), height, offset)
            return max(rise.value / limits.rise, back.value / limits.back)

        def curved(offset: float) -> float:
            """Use of the limits of curvature at an offset, m: greatest limit over radius."""
            pitch = self.extremes(prime_radius, offset)
            least = limits.convex_radius, limits.concave_radius
            radii = pitch.convex_radius.value, pitch.concave_radius.value
            return max(bound / radius for bound, radius in zip(least, radii, strict=True))

        offset = _zero_if_tiny(least_argument(use, -most, most), most)
        if not max(limits.convex_radius, limits.concave_radius) > 0.0 or curved(offset) <= 1.0:
            return offset

        def within(offset: float) -> float:
            share = curved(offset)
            return use(offset) if share <= 1.0 - _OFFSET_ROUNDING else _REFUSED_USE + share

        return _zero_if_tiny(least_argument(within, -most, most), most)

    def smallest(self, limits: PitchLimits) -> RollerSize:
        """Smallest prime radius over all offsets, and the offset at which it is reached, m; by
        golden sections in the offset, after a scan where the curvature governs.
        """
        most = self.least_prime_radius(limits)
        by_angle = least_argument(lambda each: self._by_angle(limits, each), -most, most)
        offset = _zero_if_tiny(by_angle, most)
        # Convex in the offset by the angle alone: the least of all if the curvature agrees.
        if not self.least_prime_radius(limits, offset) <= self._by_angle(limits, offset):
            offset = _least_of_scan(lambda each: self.least_prime_radius(limits, each), most)
        return RollerSize(self.least_prime_radius(limits, offset), offset)


@dataclass(frozen=True, eq=False)
class GivenLiftCam(RollerCam):
    """Roller cam of a lift that does not depend on the size of the cam.

    Parameters
    ----------
    lift : LiftParts
    """

    lift: LiftParts

    def parts(self, prime_radius: float, offset: float) -> LiftParts:  # noqa: ARG002
        return self.lift

    def least_prime_radius(self, limits: PitchLimits, offset: float = 0.0) -> float:
        """Smallest prime radius, m, with an offset, m.

        Each cam angle needs a height d = d0 + s of |s' - e| / tan(alpha), and the largest root of
        kappa(d) = 1/rho by the curvature; d0 is the greatest of d - s.

        References
        ----------
        Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: pressure angle, curvature.
        """
        height = self._height_by_angle(limits, offset)
        if limits.convex_radius > 0.0:
            height = max(height, self._height_by_curvature(1.0 / limits.convex_radius, offset))
        if limits.concave_radius > 0.0:
            height = max(height, self._height_by_curvature(-1.0 / limits.concave_radius, offset))
        return float(np.hypot(height, offset))

    def _by_angle(self, limits: PitchLimits, offset: float) -> float:
        return float(np.hypot(self._height_by_angle(limits, offset), offset))

    def _height_by_angle(self, limits: PitchLimits, offset: float) -> float:
        """Least height of the roller centre at zero lift, m, by the limits of the pressure angle,
        with an offset, m.
        """
        rise, back = np.tan(limits.rise), np.tan(limits.back)
        return max(
            self.lift.greatest(lambda s, s1, _: abs(np.maximum(s1, 0) - offset) / rise - s).value,
            self.lift.greatest(lambda s, s1, _: abs(np.minimum(s1, 0) - offset) / back - s).value,
        )

    def _height_by_curvature(self, curvature: float, offset: float) -> float:
        """Least height of the roller centre at zero lift, m, with the curvature of the pitch curve
        within `curvature`, 1/m, positive convex, negative concave.
        """
        return self.lift.greatest(
            lambda s, s1, s2: _height_of_curvature(s1, s2, offset, curvature) - s
        ).value


@dataclass(frozen=True)
class EccentricCam(RollerCam):
    """Eccentric disc under a roller: its pitch curve is a circle about the crank pin.

    Parameters
    ----------
    eccentricity : float   m, > 0
    """

    eccentricity: float

    def __post_init__(self) -> None:
        positive("lift.eccentricity", self.eccentricity, "m")

    def parts(self, prime_radius: float, offset: float) -> LiftParts:
        """Lift of the roller on the disc, which depends on prime radius and offset, m."""
        disc = Eccentric(self.eccentricity, prime_radius + self.eccentricity, offset)

        def derivatives(x: Array) -> Array:
            phi = FULL_TURN * (x - 0.25)
            height = disc.height(phi) - disc.height_base
            return np.stack([height, disc.height_rate(phi), disc.height_rate_slope(phi)])

        return LiftParts((LiftPart(0.0, FULL_TURN, derivatives, _EXTREME_SAMPLES),))

    def least_prime_radius(self, limits: PitchLimits, offset: float = 0.0) -> float:
        """Smallest prime radius at an offset, m; the pitch curve has the curvature of a circle."""
        by_angle = self._by_angle(limits, offset)
        return max(by_angle, limits.convex_radius - self.eccentricity)

    def smallest(self, limits: PitchLimits) -> RollerSize:
        """Smallest prime radius over all offsets, and its offset, m, in closed form."""
        rise, back = np.sin(limits.rise), np.sin(limits.back)
        offset = float(self.eccentricity * (back - rise) / (back + rise))
        return RollerSize(self.least_prime_radius(limits, offset), offset)

    def _by_angle(self, limits: PitchLimits, offset: float) -> float:
        """Smallest prime radius, m, by the pressure angle alone, with an offset, m: in closed form
        up to an offset of the eccentricity, by bisection beyond.
        """
        if abs(offset) <= self.eccentricity:
            # sin(alpha) = (l1 cos(phi) - e) / l2, greatest with the crank square to the travel
            rise, back = np.sin(limits.rise), np.sin(limits.back)
            rod = max((self.eccentricity - offset) / rise, (self.eccentricity + offset) / back)
            return float(max(rod - self.eccentricity, abs(offset) * (1.0 + _BESIDE_AXIS)))
        sine = np.sin(min(limits.rise, limits.back))
        low = abs(offset) * (1.0 + _BESIDE_AXIS)
        high = max((self.eccentricity + abs(offset)) / sine - self.eccentricity, low)
        for _ in range(_ROOT_HALVINGS):
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            height = float(np.sqrt(middle**2 - offset**2))
            at_rise, at_back = _angles(self.parts(middle, offset), height, offset)
            kept = at_rise.value <= limits.rise and at_back.value <= limits.back
            low, high = (low, middle) if kept else (middle, high)
        return float(high)


class PlaneCam(ABC):
    """Cam of a flat face whose base radius, offset and face are open.

    Of an arm the centre distance is in place of the offset, see `ArmFaceCam`.
    """

    lift: LiftParts

    def reach(self, offset: float) -> tuple[float, float]:  # noqa: ARG002
        """Bounds of the base radius, m, with an offset, m."""
        return 0.0, np.inf

    @abstractmethod
    def least_base_radius(
        self,
        least_radius: float = 0.0,
        undercut_factor: float = 0.0,
        offset: float | None = None,
    ) -> float:
        """Smallest base radius, m: radius of curvature >= rho, and >= c times the height of the
        face.

        Parameters
        ----------
        least_radius : float      rho, least radius of curvature, m, >= 0
        undercut_factor : float   c, 0 <= c < 1
        offset : float            m; None: the best one of each base radius

        References
        ----------
        Norton, Cam Design and Manufacturing Handbook (2009), ch. 7: flat-faced followers.
        """

    @abstractmethod
    def least_radius(self, base_radius: float, offset: float = 0.0) -> Extremum:
        """Least radius of curvature, m, with a base radius and an offset, m."""

    @abstractmethod
    def undercut_factor(self, base_radius: float, offset: float = 0.0) -> float:
        """Least radius of curvature over the height of the face, with a base radius, m, > 0."""

    @abstractmethod
    def best_offset(self, base_radius: float = 0.0) -> float:
        """Offset of the narrowest face, m, with a base radius, m."""

    @abstractmethod
    def face_width(self, offset: float = 0.0, base_radius: float = 0.0) -> float:
        """Least width of a face centred on its reference point, m, with an offset and a base
        radius, m.
        """


@dataclass(frozen=True, eq=False)
class FaceCam(PlaneCam):
    """Cam of a translating flat face whose base radius, offset and face are open.

    Parameters
    ----------
    lift : LiftParts
    """

    lift: LiftParts

    def least_base_radius(
        self,
        least_radius: float = 0.0,
        undercut_factor: float = 0.0,
        offset: float | None = None,  # noqa: ARG002
    ) -> float:
        """Smallest base radius, m: r + s + s'' >= rho and (r + s + s'')/(r + s) >= c."""
        share = 1.0 - undercut_factor
        by_factor = self.lift.greatest(lambda s, _, s2: -s2 / share - s).value
        return max(least_radius - self.least_radius(0.0).value, by_factor)

    def least_radius(self, base_radius: float, offset: float = 0.0) -> Extremum:  # noqa: ARG002
        """Least radius of curvature r + s + s'' with a base radius, m."""
        return self.lift.least(lambda s, _, s2: base_radius + s + s2)

    def undercut_factor(self, base_radius: float, offset: float = 0.0) -> float:  # noqa: ARG002
        """Least factor (r + s + s'')/(r + s) with a base radius, m, > 0."""
        return self.lift.least(lambda s, _, s2: 1.0 + s2 / (base_radius + s)).value

    @cached_property
    def contact_travel(self) -> tuple[float, float]:
        """Least and greatest distance s' of the contact from the cam axis, m."""
        low, high = self.lift.least(_slope), self.lift.greatest(_slope)
        return low.value, high.value

    def best_offset(self, base_radius: float = 0.0) -> float:  # noqa: ARG002
        """Offset of the narrowest face, m: the middle of the travel of the contact."""
        return 0.5 * sum(self.contact_travel)

    def face_width(self, offset: float = 0.0, base_radius: float = 0.0) -> float:  # noqa: ARG002
        """Least width 2 max|s' - e| of a face centred on the stem, m, with an offset, m."""
        low, high = self.contact_travel
        return 2.0 * max(high - offset, offset - low)


def _slope(_: Array, slope: Array, __: Array) -> Array:
    return slope


def _angles(parts: LiftParts, height: float, offset: float) -> tuple[Extremum, Extremum]:
    """Greatest magnitudes of the pressure angle on rise and on return, rad, with their cam angles;
    height : of the roller centre at zero lift, m.

    On the other stroke s' counts as zero, which the bottom of the lift has in any case.
    """

    def angle(jet: Jet) -> Array:
        return np.abs(_motion(jet, height, offset).pressure_angle)

    return (
        parts.greatest(lambda s, s1, s2: angle(Jet(s, np.maximum(s1, 0.0), s2))),
        parts.greatest(lambda s, s1, s2: angle(Jet(s, np.minimum(s1, 0.0), s2))),
    )


def _motion(jet: Jet, height: float, offset: float) -> RollerMotion:
    """Motion of the roller centre; its radius is not needed."""
    return RollerMotion(jet, height, offset, np.nan)


def _height_of_curvature(slope: Array, lift_d2: Array, offset: float, curvature: float) -> Array:
    """Largest height d (...), m, >= 0, of the roller centre over the cam axis at which the pitch
    curve has a curvature; 0 where it has it at no height.

    Root of (a^2 + z^2)^3 = (z^2 - b z + c)^2 with lengths over the radius of curvature, by the
    eigenvalues of its companion matrix; the sign of the curvature excludes the others.

    Parameters
    ----------
    slope, lift_d2 : array (...)   first and second derivative of the lift, m/rad, m/rad^2
    offset : float                 of the follower's axis, m
    curvature : float              of the pitch curve, 1/m, not 0; convex positive
    """
    k = abs(curvature)
    a = ((slope - offset) * k) ** 2
    b, c = lift_d2 * k, (slope - offset) * (2.0 * slope - offset) * k**2
    companion = np.zeros((*np.shape(slope), 6, 6))
    companion[..., range(1, 6), range(5)] = 1.0
    for power, coefficient in enumerate(
        (a**3 - c**2, 2.0 * b * c, 3.0 * a**2 - b**2 - 2.0 * c, 2.0 * b, 3.0 * a - 1.0)
    ):
        companion[..., power, 5] = -coefficient
    z = np.linalg.eigvals(companion)
    real = z.real
    turning = real**2 - b[..., None] * real + c[..., None]
    fits = (np.abs(z.imag) <= _REAL * (1.0 + np.abs(real))) & (turning * np.sign(curvature) > 0.0)
    return np.asarray(np.max(np.where(fits & (real > 0.0), real, 0.0), axis=-1) / k)


def _zero_if_tiny(offset: float, most: float) -> float:
    """The offset, m, or zero where it is round-off of its greatest value `most`, m."""
    return 0.0 if abs(offset) <= _ZERO_OFFSET * most else offset


def _least_of_scan(function: Callable[[float], float], most: float) -> float:
    """Argument of the least value of a function within +- `most`: a scan, then golden sections
    about its least.
    """
    offsets = np.linspace(-most, most, _SCANNED)
    k = int(np.argmin([function(float(each)) for each in offsets]))
    step = 2.0 * most / (_SCANNED - 1)
    low, high = float(offsets[k]) - step, float(offsets[k]) + step
    return least_argument(function, low, high, _OFFSET_SECTIONS)
