"""Size of a cam under an arm: smallest prime or base radius, best centre distance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arm_face import ArmFaceMotion
from camwright.geometry.arm_path import Arm, ArmMotion
from camwright.geometry.arrays import Array
from camwright.geometry.cam_size import (
    PitchExtremes,
    PitchLimits,
    PlaneCam,
    RollerCam,
    RollerSize,
)
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, least_argument
from camwright.geometry.lift import Jet
from camwright.geometry.lift_parts import LiftParts

_SCANNED_DISTANCES = np.linspace(0.2, 3.0, 71)
"""Centre distances tried, over the length of the arm."""
_SCANNED_RADII = 161  # prime radii of a scan, between which the limits are not met twice
_RADIUS_HALVINGS = 45
_CREEP = 0.5**10  # of a step of the scan, from what the samples pass to what the turn does
_NO_SIZE = 1e3
"""Use of a size out of reach, beyond that of any within."""
_SECTIONS = 40  # golden ones, which leave 4e-9 of the range of centre distances
_SCANNED_BASES, _MOST_OF_FACE = 81, 3.0
"""Base radii of a scan under a flat face; the greatest, and the greatest centre distance, over the
length of the arm.
"""
_SWING_MARGIN = 1e-6  # rad, of the swing from both lines of centres


@dataclass(frozen=True, eq=False)
class ArmCam(RollerCam):
    """Roller cam of an arm of given length, whose centre distance is in place of the offset.

    Parameters
    ----------
    lift : LiftParts   arc of the roller centre
    length : float     pivot to roller centre, m
    sense : float      of the outward swing: 1 with the rotation of the cam, -1 against it
    """

    aside: ClassVar[str] = "centre distance"
    has_offset: ClassVar[bool] = False

    lift: LiftParts
    length: float
    sense: float

    def parts(self, prime_radius: float, offset: float) -> LiftParts:  # noqa: ARG002
        return self.lift

    @cached_property
    def _swing(self) -> tuple[float, float]:
        """Least and greatest swing from zero lift, rad; refused beyond a half turn."""
        low = self.lift.least(lambda s, *_: s).value / self.length
        high = self.lift.greatest(lambda s, *_: s).value / self.length
        if not high - low < np.pi - 2.0 * _SWING_MARGIN:
            raise InputError("follower.arm.length", self.length, "> the lift over pi")
        return low, high

    def reach(self, offset: float) -> tuple[float, float]:
        """Prime radii between which the arm swings within its half turn, m."""
        arm, (low, high) = self._arm(offset), self._swing
        ends = max(-low, 0.0) + _SWING_MARGIN, np.pi - high - _SWING_MARGIN
        return float(arm.radius(ends[0])), float(arm.radius(ends[1]))

    def extremes(self, prime_radius: float, offset: float = 0.0) -> PitchExtremes:
        """Pressure angles and radii of curvature with a prime radius and a centre distance, m.

        Raises
        ------
        InputError
            If the arm does not reach the prime circle, or swings past a line of centres.
        """
        low, high = self.reach(offset)
        if not low <= prime_radius <= high:
            limit = f">= {low:.6g} and <= {high:.6g} m, which the arm reaches"
            raise InputError("cam.prime_radius", prime_radius, limit)
        arm = self._arm(offset)
        start = arm.angle(prime_radius)

        def motion(s: Array, s1: Array, s2: Array) -> ArmMotion:
            return ArmMotion(Jet(s, s1, s2), arm, start, np.nan)

        def angle(s: Array, s1: Array, s2: Array) -> Array:
            return np.abs(motion(s, s1, s2).pressure_angle)

        def curvature(s: Array, s1: Array, s2: Array) -> Array:
            return motion(s, s1, s2).path_curvature

        convex, concave = self.lift.greatest(curvature), self.lift.least(curvature)
        return PitchExtremes(
            self.lift.greatest(lambda s, s1, s2: angle(s, np.maximum(s1, 0.0), s2)),
            self.lift.greatest(lambda s, s1, s2: angle(s, np.minimum(s1, 0.0), s2)),
            Extremum(1.0 / convex.value, convex.theta),
            Extremum(-1.0 / concave.value if concave.value < 0.0 else np.inf, concave.theta),
        )

    def least_prime_radius(self, limits: PitchLimits, offset: float = 0.0) -> float:
        """Smallest prime radius, m, with a centre distance, m.

        The first of a scan within the limits, and the halved step before it: a larger one turns
        the arm on, and need not keep them.

        Raises
        ------
        InputError
            If none keeps them.
        """
        prime = self._sampled_least(limits, offset)
        if prime >= _NO_SIZE:
            limit = "another for this swing: no prime radius keeps pressure angle and curvature"
            raise InputError("follower.arm.centre_distance", offset, limit)
        low, high = self.reach(offset)
        step = (high - low) / _SCANNED_RADII
        while not self._keeps(limits, prime, offset) and prime < high:
            low, prime = prime, min(prime + _CREEP * step, high)  # of the samples, not of the turn
        low = max(low, prime - step)
        for _ in range(_RADIUS_HALVINGS):
            middle = 0.5 * (low + prime)
            low, prime = (low, middle) if self._keeps(limits, middle, offset) else (middle, prime)
        return prime

    def best_offset(self, prime_radius: float, limits: PitchLimits) -> float:
        """Centre distance, m, at which rise and return use equal shares of their limits.

        Within the limits of the curvature; where none keeps them, that of the least curvature.
        """

        def use(distance: float) -> float:
            angles, curved = self._uses(limits, np.array([prime_radius]), distance)
            return float(angles[0] if curved[0] <= 1.0 else _NO_SIZE + curved[0])

        return self._best_of_scan(use)

    def smallest(self, limits: PitchLimits) -> RollerSize:
        """Smallest prime radius over all centre distances, and that distance, m."""
        distance = self._best_of_scan(lambda each: self._sampled_least(limits, each))
        return RollerSize(self.least_prime_radius(limits, distance), distance)

    def _by_angle(self, limits: PitchLimits, offset: float) -> float:
        return self.least_prime_radius(PitchLimits(limits.rise, limits.back), offset)

    def _arm(self, distance: float) -> Arm:
        return Arm(distance, self.length, self.sense)

    def _best_of_scan(self, use: Callable[[float], float]) -> float:
        """Centre distance, m, at which `use` is least, a function of the centre distance, m: by a
        scan, then golden sections about its least.
        """
        distances = self.length * _SCANNED_DISTANCES
        k = int(np.argmin([use(float(each)) for each in distances]))
        low, high = distances[max(k - 1, 0)], distances[min(k + 1, distances.size - 1)]
        best = least_argument(use, float(low), float(high))
        return best if use(best) <= use(float(distances[k])) else float(distances[k])

    def _keeps(self, limits: PitchLimits, prime_radius: float, distance: float) -> bool:
        pitch = self.extremes(prime_radius, distance)
        return (
            pitch.rise.value <= limits.rise
            and pitch.back.value <= limits.back
            and pitch.convex_radius.value >= limits.convex_radius
            and pitch.concave_radius.value >= limits.concave_radius
        )

    def _sampled_least(self, limits: PitchLimits, distance: float) -> float:
        """Smallest prime radius, m, within the limits at the samples of the lift; `_NO_SIZE` where
        none is.

        Parameters
        ----------
        distance : float   centre distance, m
        """

        def keeping(primes: Array) -> NDArray[np.bool_]:
            return np.maximum(*self._uses(limits, primes, distance)) <= 1.0

        primes = np.linspace(*self.reach(distance), _SCANNED_RADII)
        within = np.flatnonzero(keeping(primes))
        if not within.size:
            return _NO_SIZE
        low, prime = primes[max(within[0] - 1, 0)], primes[within[0]]
        for _ in range(_RADIUS_HALVINGS):
            middle = 0.5 * (low + prime)
            low, prime = (low, middle) if keeping(np.array([middle]))[0] else (middle, prime)
        return float(prime)

    def _uses(self, limits: PitchLimits, primes: ArrayLike, distance: float) -> tuple[Array, Array]:
        """Greatest pressure angle over its limit, and greatest limit over radius of curvature, by
        the samples of the lift, each (m,); `_NO_SIZE` where the arm does not reach so far.

        Parameters
        ----------
        primes : array (m,)   prime radii, m
        distance : float      centre distance, m
        """
        s, s1, s2 = np.concatenate([part.samples for part in self.lift.parts], axis=1)
        arm = self._arm(distance)
        start = np.asarray(arm.angle(np.asarray(primes)))[:, None]
        reached = start[:, 0] + s.max() / self.length < np.pi

        def motion(slope: Array) -> ArmMotion:
            return ArmMotion(Jet(s, slope, s2), arm, start, np.nan)

        rise, back = (
            np.abs(motion(each).pressure_angle).max(axis=1)
            for each in (np.maximum(s1, 0.0), np.minimum(s1, 0.0))
        )
        curvature = motion(s1).path_curvature
        angles = np.maximum(rise / limits.rise, back / limits.back)
        curved = np.maximum(
            curvature.max(axis=1) * limits.convex_radius,
            -curvature.min(axis=1) * limits.concave_radius,
        )
        return np.where(reached, angles, _NO_SIZE), np.where(reached, curved, _NO_SIZE)


@dataclass(frozen=True, eq=False)
class ArmFaceCam(PlaneCam):
    """Cam of a flat face along an arm of given length, whose centre distance is in place of the
    offset.

    Parameters
    ----------
    lift : LiftParts   arc of the end of the arm
    length : float     pivot to end of the arm, m
    sense : float      of the outward swing: 1 with the rotation of the cam, -1 against it
    plane : float      distance of the plane of the face from the pivot towards the cam, m
    """

    lift: LiftParts
    length: float
    sense: float
    plane: float

    @cached_property
    def _swing(self) -> tuple[float, float]:
        """Least and greatest swing from zero lift, rad.

        Refused where the arm turns with the cam as fast as it does.
        """
        low, high = (
            each.value / self.length for each in (self.lift.least(_lift), self.lift.greatest(_lift))
        )
        fastest = self.lift.greatest(lambda _, s1, __: self.sense * s1).value / self.length
        if not fastest < 1.0:
            limit = "< 1 rad of the arm per rad of the cam that turns with it"
            raise InputError("follower.arm swing", f"{fastest:.6g} rad/rad", limit)
        return low, high

    def reach(self, offset: float) -> tuple[float, float]:
        """Base radii, m, between which the face stays over the cam axis and turns by less than a
        quarter from it, with a centre distance, m.
        """
        low, high = self._swing
        level = float(np.arcsin(np.clip(self.plane / offset, -1.0, 1.0)))
        ends = level + max(-low, 0.0) + _SWING_MARGIN, 0.5 * np.pi - high - _SWING_MARGIN
        arm = self._arm(offset)
        least, greatest = (float(arm.face_radius(each, self.plane)) for each in ends)
        return least, greatest

    def least_base_radius(
        self,
        least_radius: float = 0.0,
        undercut_factor: float = 0.0,
        offset: float | None = None,
    ) -> float:
        """Smallest base radius, m, with a centre distance, m; None: the best one of each radius.

        The first of a scan within the limits, and the halved step before it.

        Raises
        ------
        InputError
            If none keeps them.
        """

        def keeps(base: float) -> bool:
            distance = self.best_offset(base) if offset is None else offset
            low, high = self.reach(distance)
            return (
                low <= base <= high
                and self.least_radius(base, distance).value >= least_radius
                and self.undercut_factor(base, distance) >= undercut_factor
            )

        most = _MOST_OF_FACE * self.length
        low, high = (0.0, most) if offset is None else self.reach(offset)
        bases = np.linspace(low, high, _SCANNED_BASES)
        k = next((k for k, each in enumerate(bases) if keeps(float(each))), None)
        if k is None:
            stated = "open" if offset is None else offset
            limit = "another for this swing: no base radius keeps the curvature"
            raise InputError("follower.arm.centre_distance", stated, limit)
        low, base = float(bases[max(k - 1, 0)]), float(bases[k])
        for _ in range(_RADIUS_HALVINGS):
            middle = 0.5 * (low + base)
            low, base = (low, middle) if keeps(middle) else (middle, base)
        return base

    def least_radius(self, base_radius: float, offset: float = 0.0) -> Extremum:
        motion = self._motion(base_radius, offset)
        return self.lift.least(lambda *jet: motion(*jet).radius)

    def undercut_factor(self, base_radius: float, offset: float = 0.0) -> float:
        motion = self._motion(base_radius, offset)

        def factor(*jet: Array) -> Array:
            of = motion(*jet)
            return of.radius / of.height

        return self.lift.least(factor).value

    def best_offset(self, base_radius: float = 0.0) -> float:
        """Centre distance of the narrowest face, m, with a base radius, m, by the samples of the
        lift: the contact travels as far beyond the end of the arm as before it.
        """
        _, high = self._swing
        reached = base_radius + self.plane
        least = (1.0 + _SWING_MARGIN) * abs(reached) / np.cos(high)
        most = _MOST_OF_FACE * float(np.hypot(self.length, reached))
        samples = np.concatenate([part.samples for part in self.lift.parts], axis=1)

        def width(distance: float) -> float:
            return float(np.abs(self._motion(base_radius, distance)(*samples).on_face).max())

        return least_argument(width, least, most, _SECTIONS)

    def face_width(self, offset: float = 0.0, base_radius: float = 0.0) -> float:
        motion = self._motion(base_radius, offset)
        return 2.0 * self.lift.greatest(lambda *jet: np.abs(motion(*jet).on_face)).value

    def _arm(self, distance: float) -> Arm:
        return Arm(distance, self.length, self.sense)

    def _motion(
        self, base_radius: float, distance: float
    ) -> Callable[[Array, Array, Array], ArmFaceMotion]:
        """Motion of the face by lift, s' and s'' (...)."""
        arm = self._arm(distance)
        start = arm.face_angle(base_radius, self.plane)
        return lambda s, s1, s2: ArmFaceMotion(Jet(s, s1, s2), arm, start, self.plane, 0.0)


def _lift(lift: Array, _: Array, __: Array) -> Array:
    return lift
