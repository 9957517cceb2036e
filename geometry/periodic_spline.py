"""Periodic splines of an angle: quintic and cubic interpolation on one turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import comb, factorial
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, freeze, readonly

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

DEGREE = 5
"""Quintic: the lowest odd degree with a continuous fourth derivative (C4)."""

LEAST_SAMPLES = 12
"""Minimum samples per turn: a spacing of 30 degrees."""


_KEPT_FROM, _KEPT_TO = 64, 1500  # angles: fewer are quick to compute, more are used once
_CACHED_ANGLES = 12  # sets of angles per function


@dataclass(frozen=True, eq=False)
class PeriodicPolynomial:
    """Periodic function of the angle, one polynomial per equal part of the turn.

    Parameters
    ----------
    coefficients : array (degree + 1, n)
        Of rising powers of the angle from the start of part i, 2 pi i / n, rad.
    """

    coefficients: Array

    def __post_init__(self) -> None:
        freeze(self, coefficients=self.coefficients)

    def __call__(self, theta: ArrayLike, derivative: int = 0) -> Array:
        """Value, or derivative of order `derivative` by the angle, at any angles (...), rad; the
        array is read-only where it is kept for the next call.
        """
        angles = np.asarray(theta, dtype=float)
        if _KEPT_FROM <= angles.size <= _KEPT_TO:
            rows = _kept.get(self, {}).get((angles.shape, angles.tobytes()))
            if derivative == 0 or (rows is not None and len(rows) > derivative):
                row: Array = self.derivatives(angles, derivative)[derivative]
                return row
        value: Array = self._evaluate(angles, derivative, derivative)[0]
        return value

    def derivatives(self, theta: ArrayLike, order: int) -> Array:
        """Values and derivatives up to `order` at angles (...), rad, in a read-only array (order +
        1, ...), row k in units per rad^k.

        Those at the same angles as in one of the last calls are kept: loads, contact and checks
        evaluate one lift at the same equal angles.
        """
        angles = np.asarray(theta, dtype=float)
        if not _KEPT_FROM <= angles.size <= _KEPT_TO:
            return self._evaluate(angles, 0, order)
        kept = _kept.setdefault(self, {})
        key = angles.shape, angles.tobytes()
        rows = kept.pop(key, None)
        if rows is None or len(rows) <= order:
            rows = self._evaluate(angles, 0, order)
            rows.setflags(write=False)
        kept[key] = rows  # the last in the order of use
        if len(kept) > _CACHED_ANGLES:
            kept.pop(next(iter(kept)))
        return rows[: order + 1]

    def _evaluate(self, theta: ArrayLike, first: int, last: int) -> Array:
        """Derivatives of order `first` to `last` at angles (...), rad, (last - first + 1, ...); NaN
        at an angle NaN.
        """
        degree, count = self.coefficients.shape[0] - 1, self.coefficients.shape[1]
        part = FULL_TURN / count
        angle = np.mod(np.asarray(theta, dtype=float), FULL_TURN)
        # NaN belongs to no part: part 0 propagates it
        known = np.where(np.isnan(angle), 0.0, angle)
        index = np.minimum((known / part).astype(np.intp), count - 1)
        step = angle - index * part
        local = self.coefficients.take(index, axis=1)
        values = np.empty((last - first + 1, *angle.shape))
        for order in range(first, last + 1):
            value = np.zeros_like(angle)
            for power in range(degree, order - 1, -1):
                value *= step
                front = _falling(power, order)
                value += local[power] if front == 1.0 else front * local[power]
            values[order - first] = value
        return values

    def antiderivative(self) -> tuple[PeriodicPolynomial, float]:
        """Integral from angle 0 as a function of the angle, in units times rad, and its change over
        the whole turn.

        The integral is periodic only if the change is zero, which the caller must check.
        """
        degree, count = self.coefficients.shape[0] - 1, self.coefficients.shape[1]
        powers = np.arange(1, degree + 2)[:, None]
        raised = self.coefficients / powers
        parts = np.sum(raised * (FULL_TURN / count) ** powers, axis=0)
        sums = np.concatenate([[0.0], np.cumsum(parts)])
        return PeriodicPolynomial(np.vstack([sums[:-1], raised])), float(sums[-1])


# Beside the functions, so that those sent to another process stay small.
_kept: WeakKeyDictionary[PeriodicPolynomial, dict[tuple[tuple[int, ...], bytes], Array]] = (
    WeakKeyDictionary()
)


def interpolant(knots: Array, values: Array) -> BSpline:
    """Periodic quintic B-spline through samples at any angles of one turn.

    Parameters
    ----------
    knots : array (n + 1,)    angles of the samples and the end of the turn, rad, increasing
    values : array (n,)       any unit

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. XIII: interpolation at the knots.
    """
    from scipy.interpolate import make_interp_spline

    closed = np.append(values, values[0])
    return make_interp_spline(knots, closed, DEGREE, bc_type="periodic")


def periodic_quintic(values: ArrayLike) -> PeriodicPolynomial:
    """Periodic quintic (C4) through samples at n equal angles of one turn, from angle 0.

    Parameters
    ----------
    values : array (n,)    any unit, n >= 12
    """
    return _through(values, DEGREE)


def periodic_cubic(values: ArrayLike) -> PeriodicPolynomial:
    """Periodic cubic (C2) through samples at n equal angles of one turn, from angle 0.

    Parameters
    ----------
    values : array (n,)    any unit, n >= 12
    """
    return _through(values, 3)


def _through(values: ArrayLike, degree: int) -> PeriodicPolynomial:
    """Periodic spline of odd degree through samples (n,) at n equal angles of one turn, from angle
    0; its B-spline weights by FFT.
    """
    samples = np.asarray(values, dtype=float)
    count, half = samples.size, degree // 2
    # The splines of equal knots are shifts of one another: a cyclic convolution, solved by FFT.
    shifts, at_knots = np.arange(-half, half + 1), np.zeros(count)
    at_knots[shifts] = _pieces(degree)[1:, 0]
    response = np.fft.rfft(at_knots)
    weights = np.fft.irfft(np.fft.rfft(samples) / response, count)
    # The FFT spreads its round-off over the turn; the residual, taken locally, keeps it out of a
    # dwell, where derivatives are differences of equal weights.
    residual = samples - sum(at_knots[k] * np.roll(weights, k) for k in shifts)
    weights += np.fft.irfft(np.fft.rfft(residual) / response, count)
    shifted = np.stack([np.roll(weights, piece - half - 1) for piece in range(degree + 1)])
    powers = (count / FULL_TURN) ** np.arange(degree + 1.0)
    coefficients = powers[:, None] * (_pieces(degree).T @ shifted)
    coefficients[0] = samples  # without the round-off of the convolution
    return PeriodicPolynomial(coefficients)


@cache
def _pieces(degree: int) -> Array:
    """Polynomials of the B-spline with knots at whole numbers, (degree + 1, degree + 1): row m over
    m to m + 1, in rising powers of x - m.

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. IX: truncated powers.
    """
    pieces = np.zeros((degree + 1, degree + 1))
    for piece in range(degree + 1):
        for power in range(degree + 1):
            truncated = sum(
                (-1) ** k * comb(degree + 1, k) * (piece - k) ** (degree - power)
                for k in range(piece + 1)
            )
            pieces[piece, power] = comb(degree, power) * truncated / factorial(degree)
    return readonly(pieces)


def knot_derivatives(values: ArrayLike, order: int) -> Array:
    """Periodic quintics through samples at equal angles, and their derivatives, at the samples.

    The same splines as `periodic_quintic`, many at once: interpolation and derivatives are
    convolutions with B-splines at whole steps, products in the harmonics of the samples.

    Parameters
    ----------
    values : array (..., n)    any unit, n >= 12, at n equal angles of one turn
    order : int                highest derivative, 0 to 4

    Returns
    -------
    array (order + 1, ..., n)    row k in units per rad^k

    References
    ----------
    Unser, Aldroubi and Eden, IEEE Trans. Signal Process. 41 (1993) 821: B-spline filters.
    """
    samples = np.asarray(values, dtype=float)
    count = samples.shape[-1]
    step, phase = FULL_TURN / count, FULL_TURN / count * np.arange(count // 2 + 1)
    one, two = np.exp(1j * phase), np.exp(2j * phase)
    weights = np.fft.rfft(samples, axis=-1) / (66.0 + 52.0 * one.real + 2.0 * two.real) * 120.0
    symbols = (
        1j * (20.0 * one.imag + 2.0 * two.imag) / 24.0,
        (-3.0 + 2.0 * one.real + two.real) / 3.0,
        1j * (two.imag - 2.0 * one.imag),
        6.0 - 8.0 * one.real + 2.0 * two.real,
    )
    rows = [
        np.fft.irfft(weights * symbol, n=count, axis=-1) / step**k
        for k, symbol in enumerate(symbols[:order], start=1)
    ]
    return np.stack([samples, *rows])


def knot_integrals(values: ArrayLike) -> Array:
    """Integrals, from the first sample, of the periodic quintics through samples, at the samples.

    Parameters
    ----------
    values : array (..., n)    any unit, n >= 12, at n equal angles of one turn, of zero mean

    Returns
    -------
    array (..., n)    in units times rad, the first zero

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. X: the integral of a B-spline series.
    """
    samples = np.asarray(values, dtype=float)
    count = samples.shape[-1]
    phase = FULL_TURN / count * np.arange(1, count // 2 + 1)
    half, three, five = (np.cos(0.5 * k * phase) for k in (1, 3, 5))
    # the integral of a B-spline is a sum of those of the next degree, at half steps
    integral = (302.0 * half + 57.0 * three + five) / 360.0
    interpolation = (66.0 + 52.0 * np.cos(phase) + 2.0 * np.cos(2.0 * phase)) / 120.0
    spectrum = np.fft.rfft(samples, axis=-1)
    spectrum[..., 0] = 0.0
    spectrum[..., 1:] *= integral / (interpolation * 2j * np.sin(0.5 * phase))
    whole = FULL_TURN / count * np.fft.irfft(spectrum, n=count, axis=-1)
    return np.asarray(whole - whole[..., :1])


@cache
def _falling(power: int, order: int) -> float:
    """power (power - 1) ..., `order` factors: from differentiating a power."""
    return float(np.prod(np.arange(power - order + 1, power + 1)))
