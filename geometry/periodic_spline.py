"""Periodic splines of the cam angle: quintic interpolation on one turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, freeze

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

DEGREE = 5
"""Quintic: the lowest odd degree with a continuous fourth derivative (C4)."""

LEAST_SAMPLES = 12
"""Minimum samples per turn: a spacing of 30 degrees."""


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
        """Value, or derivative of order `derivative`, at any angle, rad."""
        value: Array = self._evaluate(theta, derivative, derivative)[0]
        return value

    def derivatives(self, theta: ArrayLike, order: int) -> Array:
        """Value and derivatives up to `order`, (order + 1, ...), by one look-up."""
        return self._evaluate(theta, 0, order)

    def _evaluate(self, theta: ArrayLike, first: int, last: int) -> Array:
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
                value = value * step + _falling(power, order) * local[power]
            values[order - first] = value
        return values

    def antiderivative(self) -> tuple[PeriodicPolynomial, float]:
        """Integral from angle 0, and its change over the whole turn.

        The integral is periodic only if the change is zero, which the caller must check.
        """
        degree, count = self.coefficients.shape[0] - 1, self.coefficients.shape[1]
        powers = np.arange(1, degree + 2)[:, None]
        raised = self.coefficients / powers
        parts = np.sum(raised * (FULL_TURN / count) ** powers, axis=0)
        sums = np.concatenate([[0.0], np.cumsum(parts)])
        return PeriodicPolynomial(np.vstack([sums[:-1], raised])), float(sums[-1])


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
    from scipy.interpolate import PPoly

    samples = np.asarray(values, dtype=float)
    spline = interpolant(np.linspace(0.0, FULL_TURN, len(samples) + 1), samples)
    # the spline has DEGREE more knots on either side of the turn
    inside = PPoly.from_spline((spline.t, spline.c, spline.k)).c[::-1, DEGREE:-DEGREE]
    return PeriodicPolynomial(inside)


@cache
def _falling(power: int, order: int) -> float:
    """power (power - 1) ..., `order` factors: from differentiating a power."""
    return float(np.prod(np.arange(power - order + 1, power + 1)))
