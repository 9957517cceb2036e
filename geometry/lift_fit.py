"""Lift from a table: interpolation of few points, or a least-squares fit of noisy ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift, one_turn
from camwright.geometry.periodic_spline import DEGREE, LEAST_SAMPLES, interpolant

POINTS_MIN = DEGREE + 1
_SAMPLED = 1440
_GROWTH = 1.25
"""Ratio of successive numbers of spline parts."""
_POINTS_PER_PART = 2.0
"""Minimum: fewer would fit the noise."""


@dataclass(frozen=True, eq=False)
class FittedLift:
    """Lift fitted to a noisy table, with its residual.

    lift : Lift
    parts : int                 spline parts per turn
    residual : array (n,)       table minus lift, m
    """

    lift: Lift
    parts: int
    residual: Array

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual)

    @property
    def residual_rms(self) -> float:
        """Root mean square of the residual, m."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def residual_max(self) -> float:
        """Maximum magnitude of the residual, m."""
        return float(np.abs(self.residual).max())


def lift_through(theta: ArrayLike, values: ArrayLike) -> Lift:
    """Lift as the periodic quintic B-spline through a few points of the turn.

    Parameters
    ----------
    theta : array (n,)     rad, strictly increasing within one turn, n >= 6; the end of the turn
                           may repeat the start
    values : array (n,)    s, m

    Raises
    ------
    InputError
        For points that do not increase or are too few, an open end, NaN, or a negative lift.
    """
    angle, value = _table(theta, values)
    if len(angle) < POINTS_MIN:
        raise InputError("lift.point", f"{len(angle)} points", f">= {POINTS_MIN} points")
    spline = interpolant(np.append(angle, angle[0] + FULL_TURN), value)
    even = uniform_turn(_SAMPLED)
    return Lift(even, spline(even))


def fitted_lift(theta: ArrayLike, values: ArrayLike, noise: float) -> FittedLift:
    """Least-squares periodic quintic of fewest parts whose residual is within the noise.

    Parts are added until the root mean square of the residual is at most the noise.

    Parameters
    ----------
    theta : array (n,)     rad, strictly increasing within one turn, n >= 24
    values : array (n,)    s, m
    noise : float          standard deviation of the table's errors, m, > 0

    Raises
    ------
    InputError
        If no spline with at least two points per part fits: the noise is understated or the
        lift has corners.

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. XIV: least squares, the residual as guide.
    """
    if not 0.0 < noise < np.inf:
        raise InputError("lift.noise", noise, "> 0 m")
    angle, value = _table(theta, values)
    parts_max = int(len(angle) / _POINTS_PER_PART)
    if parts_max < LEAST_SAMPLES:
        raise InputError("lift.file", f"{len(angle)} rows", f">= {2 * LEAST_SAMPLES} rows")
    parts = LEAST_SAMPLES
    while True:
        fit = _least_squares(angle, value, parts)
        if fit.residual_rms <= noise:
            return fit
        if parts == parts_max:
            limit = (
                f">= {1e6 * fit.residual_rms:.4g} um, the rms residual of the closest smooth lift"
            )
            raise InputError("lift.noise", f"{1e6 * noise:.4g} um", limit)
        parts = min(int(np.ceil(parts * _GROWTH)), parts_max)


def _least_squares(angle: Array, value: Array, parts: int) -> FittedLift:
    from scipy.interpolate import BSpline

    step = FULL_TURN / parts
    knots = step * np.arange(-DEGREE, parts + DEGREE + 1)
    # rounding must not move an angle past the last knot
    inside = np.clip(np.mod(angle, FULL_TURN), 0.0, np.nextafter(FULL_TURN, 0.0))
    open_basis = BSpline.design_matrix(inside, knots, DEGREE).toarray()
    basis = np.zeros((len(angle), parts))
    basis += open_basis[:, :parts]
    basis[:, :DEGREE] += open_basis[:, parts:]
    weights = np.linalg.lstsq(basis, value, rcond=None)[0]
    at_knots = BSpline(knots, weights[np.arange(parts + DEGREE) % parts], DEGREE)
    values = _not_below_zero(at_knots(uniform_turn(parts)))
    spacing = float(np.diff(angle, append=angle[0] + FULL_TURN).max())
    lift = Lift(uniform_turn(parts), values, spacing=spacing)
    return FittedLift(lift, parts, value - lift(angle))


def _not_below_zero(values: Array) -> Array:
    """Values raised to zero where noise takes a dwell below it, m."""
    return values - min(float(values.min()), 0.0)


def _table(theta: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    angle, value = finite("lift.angle", theta), finite("lift.lift", values)
    return one_turn(angle, value, "lift.angle")[:2]
