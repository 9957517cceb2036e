"""Wire wound to a helical spring: rate, stress, fatigue, solid length, buckling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Literal, NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value, finite
from camwright.geometry.errors import InputError

INDEX_MIN, INDEX_MAX = 3.0, 20.0  # D/d that can be coiled
DEAD_COILS = 2.0  # of squared and ground ends
SHEAR_STRENGTH_SHARE = 0.67  # shear over tensile strength, S_su / R_m
ZIMMERLI = {"plain": (241e6, 379e6), "peened": (398e6, 534e6)}  # S_sa, S_sm by treatment, Pa
_STRENGTH_DIAMETER = 0.001  # m, of strength_at_1mm
STATIC_STRENGTH = 0.56  # permissible shear stress over R_m, also at solid length, cold coiled
DYNAMIC_GAP = 1.5  # minimum gaps of a dynamic load over those of a static one, cold coiled
ISOTROPIC = 2.6  # E / G at a Poisson ratio of 0.3

Number = TypeVar("Number", float, Array, Value)
"""A value, values of many designs, or either."""

Treatment = Literal["plain", "peened"]


class SpringWork(NamedTuple, Generic[Number]):
    """Operating range of a spring: preload, force at maximum lift, N; travel, m; rate, N/m."""

    preload: Number
    greatest: Number
    travel: Number
    rate: Number


@dataclass(frozen=True, eq=False, kw_only=True)
class WoundWire(Generic[Number]):
    """Wire wound to a helical spring of one design, or as arrays (m,) of many.

    See `HelicalSpring` for the values; those of an extension spring that has no such ends are NaN.
    """

    wire_diameter: Number
    mean_diameter: Number
    coils: Number
    free_length: Number
    end_factor: Number
    shear_modulus: Number
    elastic_modulus: Number | None
    density: Number
    strength_at_1mm: Number
    strength_exponent: Number
    treatment: Treatment
    temperature: float | None
    relaxation: Number | None

    @property
    def tensile_strength(self) -> Number:
        """Tensile strength R_m of the wire, Pa."""
        drawn = self.wire_diameter / _STRENGTH_DIAMETER
        share: Number = drawn**-self.strength_exponent
        return self.strength_at_1mm * share

    @property
    def index(self) -> Number:
        """Spring index C = D/d."""
        return self.mean_diameter / self.wire_diameter

    @property
    def can_be_coiled(self) -> NDArray[np.bool_]:
        """Whether the index is within the range of coiling."""
        return np.asarray((self.index >= INDEX_MIN) & (self.index <= INDEX_MAX))

    @property
    def is_open(self) -> NDArray[np.bool_]:
        """Whether the free length is above the solid length."""
        return np.asarray(self.solid_length < self.free_length)

    @property
    def rate(self) -> Number:
        """Rate k = G d^4 / (8 D^3 n), N/m."""
        bend = self.shear_modulus * self.wire_diameter**4
        return bend / (8.0 * self.mean_diameter**3 * self.coils)

    @property
    def active_mass(self) -> Number:
        """Mass of the active coils, kg."""
        return self._mass(self.coils)

    @property
    def mass(self) -> Number:
        """Mass with the end coils, kg."""
        return self._mass(self.coils + DEAD_COILS)

    def _mass(self, coils: Number) -> Number:
        section = 0.25 * np.pi * self.wire_diameter**2
        return self.density * section * np.pi * self.mean_diameter * coils

    @property
    def solid_length(self) -> Number:
        """Length with all coils closed, m."""
        return self.wire_diameter * (self.coils + DEAD_COILS)

    @property
    def wahl_factor(self) -> Number:
        """Wahl factor (4C - 1)/(4C - 4) + 0.615/C for curvature and direct shear."""
        C = self.index
        return (4.0 * C - 1.0) / (4.0 * C - 4.0) + 0.615 / C

    @property
    def surge_frequency(self) -> Number:
        """First natural frequency between fixed ends, sqrt(k/m)/2, Hz."""
        return natural_frequency(self.rate, self.active_mass)

    def surge_ratio(self, cam_speed: Value) -> Value:
        """First natural frequency over the turns of the cam at a speed, rad/s."""
        return self.surge_frequency * FULL_TURN / cam_speed

    @property
    def _stress_per_newton(self) -> Number:
        """Shear stress of the wire without correction factor, 8 D / (pi d^3), Pa/N."""
        return 8.0 * self.mean_diameter / (np.pi * self.wire_diameter**3)

    def stress(self, force: ArrayLike) -> Array:
        """Maximum shear stress (...) of the wire with Wahl factor, Pa.

        Raises
        ------
        InputError
            If a force is not finite.
        """
        newtons = np.asarray(force)
        finite("spring.force", np.abs(newtons))
        return np.asarray(self.wahl_factor * self._stress_per_newton * newtons)

    def deflection(self, force: Number) -> Number:
        """Deflection from the free length, m."""
        return force / self.rate

    def solid_clearance(self, preload: Number, travel: Number) -> Number:
        """Clearance to the solid length at full lift over the maximum deflection.

        Negative: the spring is solid.
        """
        deflection = self.deflection(preload) + travel
        return (self.free_length - self.solid_length - deflection) / deflection

    def gap_left(self, preload: Number, travel: Number) -> Number:
        """Sum of the gaps between the active coils at full lift, m; negative: solid."""
        return self.free_length - self.solid_length - self.deflection(preload) - travel

    @property
    def minimum_gaps(self) -> Number:
        """Minimum sum of the gaps between the active coils under a dynamic load, 1.5 S_a, m.

        S_a = n (0.0015 D^2/d + 0.1 d) of a cold-coiled spring.

        References
        ----------
        EN 13906-1:2013, 9.9 (by the formulas of an open implementation of it: verify).
        """
        D, d = self.mean_diameter, self.wire_diameter
        return DYNAMIC_GAP * self.coils * (0.0015 * D**2 / d + 0.1 * d)

    def solid_stress(self, rate: Number) -> Number:
        """Shear stress at the solid length with a rate, N/m, without correction factor, Pa.

        References
        ----------
        EN 13906-1:2013, read second-hand: at most 0.56 R_m, cold coiled, uncorrected.
        """
        return self._stress_per_newton * rate * (self.free_length - self.solid_length)

    @property
    def static_strength(self) -> Number:
        """Permissible shear stress under a static load and at solid length, 0.56 R_m, Pa."""
        return STATIC_STRENGTH * self.tensile_strength

    def static_use(self, force: ArrayLike) -> Array:
        """Static utilisation (...): shear stress over 0.56 R_m.

        References
        ----------
        0.56 R_m of EN 13906-1 is that of the uncorrected stress at solid length; the corrected one
        here is greater. Shigley's Mechanical Engineering Design, ch. 10.
        """
        return self.stress(force) / self.static_strength

    @property
    def fatigue_strengths(self) -> tuple[Number, Number]:
        """Ends of the Goodman line: amplitude without mean, mean without amplitude, Pa.

        The line passes the shear strength 0.67 R_m on the axis of mean stress and the amplitude and
        mean of Zimmerli for infinite life. The first is below zero for a shear strength below the
        mean stress of Zimmerli.

        References
        ----------
        Shigley's Mechanical Engineering Design, ch. 10: Zimmerli's data, torsional Goodman.
        """
        shear_strength, left = self._goodman
        return ZIMMERLI[self.treatment][0] / left, shear_strength

    def fatigue_stress(self, force_min: ArrayLike, force_max: ArrayLike) -> tuple[Array, Array]:
        """Amplitude and mean of the shear stress of the wire (...), Pa, between two forces; a mean
        below zero counts as zero.

        Parameters
        ----------
        force_min, force_max : arrays (...)   of the spring, N

        Raises
        ------
        InputError
            If a minimum is above its maximum, or a force is not finite.
        """
        low, high = self.stress(force_min), self.stress(force_max)
        if not (np.real(low) <= np.real(high)).all():
            greatest = float(np.max(np.real(force_min)))
            raise InputError("spring.force", greatest, "minimum <= maximum, N")
        mean = 0.5 * (high + low)
        return 0.5 * (high - low), np.where(np.real(mean) > 0.0, mean, 0.0 * mean)

    def fatigue_use(self, force_min: ArrayLike, force_max: ArrayLike) -> Array:
        """Utilisation (...) of the fatigue strength of the wire between two forces, by the Goodman
        line of `fatigue_strengths`.

        Infinite for a shear strength not above the mean stress of Zimmerli.

        Parameters
        ----------
        force_min, force_max : arrays (...)   of the spring, N

        Raises
        ------
        InputError
            If a minimum is above its maximum, or a force is not finite.
        """
        amplitude, mean = self.fatigue_stress(force_min, force_max)
        shear_strength, left = self._goodman
        use = amplitude * left / ZIMMERLI[self.treatment][0] + mean / shear_strength
        return np.where(left > 0.0, use, np.inf)

    @property
    def _goodman(self) -> tuple[Number, Number]:
        """Shear strength 0.67 R_m, Pa, and one less the mean stress of Zimmerli over it."""
        shear_strength = SHEAR_STRENGTH_SHARE * self.tensile_strength
        return shear_strength, 1.0 - ZIMMERLI[self.treatment][1] / shear_strength

    @property
    def known_modulus(self) -> Number:
        """Young's modulus as stated, else from the shear modulus of an isotropic wire, Pa."""
        isotropic: Number = ISOTROPIC * self.shear_modulus
        return isotropic if self.elastic_modulus is None else self.elastic_modulus

    @property
    def buckling_deflection(self) -> Number:
        """Deflection at which the spring buckles, m; infinite if it is always stable.

        s_K = L0 / (2 (1 - G/E)) (1 - sqrt(1 - (1 - G/E)/(0.5 + G/E) (pi D/(nu L0))^2)).

        References
        ----------
        EN 13906-1:2013, 9.14 (by the formulas of an open implementation of it: verify); Haringx,
        Philips Research Reports 3 (1948) 401-449.
        """
        ratio = self.shear_modulus / self.known_modulus
        slender = np.pi * self.mean_diameter / (self.end_factor * self.free_length)
        root = 1.0 - (1.0 - ratio) / (0.5 + ratio) * slender**2
        longest = self.free_length * 0.5 / (1.0 - ratio)
        deflection = longest * (1.0 - np.sqrt(np.maximum(root, 0.0)))
        least = np.where(root < 0.0, np.inf, deflection)
        return cast("Number", least[()])  # a number of numbers

    def rate_error(self, rate: Number) -> Number:
        """Deviation of the rate from another, N/m, relative."""
        error: Number = np.abs(self.rate / rate - 1.0)
        return error

    def relaxed_preload(self, preload: Number, greatest: Number) -> Number | float:
        """Loss of preload by relaxation over the preload; NaN without data.

        The share of the greatest force that is lost acts at every deflection.
        """
        if self.temperature is None or self.relaxation is None:
            return np.nan
        return self.relaxation * greatest / preload

    def at_work(
        self,
        preload: Number,
        travel: Number,
        preload_tolerance: Number | float,
        rate_tolerance: Number | float,
    ) -> SpringWork[Number]:
        """Work of the hardest spring in tolerance.

        Parameters
        ----------
        preload : Number   greatest of the load cases, N
        travel : Number    maximum lift, m
        preload_tolerance, rate_tolerance : relative
        """
        hard = preload * (1.0 + preload_tolerance)
        rate = self.rate * (1.0 + rate_tolerance)
        return SpringWork(hard, hard + rate * travel, travel, rate)


def natural_frequency(rate: Number, active_mass: Number) -> Number:
    """First natural frequency of a spring between fixed ends, sqrt(k/m)/2, Hz."""
    frequency: Number = 0.5 * np.sqrt(rate / active_mass)
    return frequency
