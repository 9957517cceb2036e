"""Lifts from points: a spline through all of them, or a smoother one that states its residual."""

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
"""Between the numbers of spline parts that are tried in turn."""
_POINTS_PER_PART = 2.0
"""Fewer would follow the noise from point to point."""


@dataclass(frozen=True, eq=False)
class FittedLift:
    """A lift near a noisy table, and how near.

    lift : Lift
    parts : int                 spline parts over the turn
    residual : array (n,)       table minus lift, m
    """

    lift: Lift
    parts: int
    residual: Array

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual)

    @property
    def residual_rms(self) -> float:
        """Root of the mean square, m."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def residual_max(self) -> float:
        """Greatest miss, m."""
        return float(np.abs(self.residual).max())


def lift_through(theta: ArrayLike, values: ArrayLike) -> Lift:
    """The periodic B-spline of degree five through a few points of the turn.

    Parameters
    ----------
    theta : array (n,)     rad, strictly increasing within one turn, n >= 6; the end of the turn
                           may repeat the start
    values : array (n,)    s, m

    Raises
    ------
    InputError
        For shuffled or too few points, an open end, NaN, and where the spline dips below zero.
    """
    angle, value = _table(theta, values)
    if len(angle) < POINTS_MIN:
        raise InputError("lift.point", f"{len(angle)} points", f">= {POINTS_MIN} points")
    spline = interpolant(np.append(angle, angle[0] + FULL_TURN), value)
    even = uniform_turn(_SAMPLED)
    return Lift(even, spline(even))


def fitted_lift(theta: ArrayLike, values: ArrayLike, noise: float) -> FittedLift:
    """The least-squares periodic quintic of fewest parts that a noisy table allows.

    Parts are added until the root mean square of the residual is no more than the noise.

    Parameters
    ----------
    theta : array (n,)     rad, strictly increasing within one turn, n >= 24
    values : array (n,)    s, m
    noise : float          standard deviation of the table's errors, m, > 0

    Raises
    ------
    InputError
        If no spline with two points a part comes that near: the noise is understated or the
        lift has corners.

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. XIV: least squares, the residual as guide.
    """
    if not 0.0 < noise < np.inf:
        raise InputError("lift.noise", noise, "> 0 m")
    angle, value = _table(theta, values)
    most = int(len(angle) / _POINTS_PER_PART)
    if most < LEAST_SAMPLES:
        raise InputError("lift.file", f"{len(angle)} rows", f">= {2 * LEAST_SAMPLES} to be fitted")
    parts = LEAST_SAMPLES
    while True:
        found = _least_squares(angle, value, parts)
        if found.residual_rms <= noise:
            return found
        if parts == most:
            missed = f"{noise:.6g} m, but {found.residual_rms:.6g} m rms are left"
            raise InputError("lift.noise", missed, "no less than a smooth lift leaves of the table")
        parts = min(int(np.ceil(parts * _GROWTH)), most)


def _least_squares(angle: Array, value: Array, parts: int) -> FittedLift:
    from scipy.interpolate import BSpline

    step = FULL_TURN / parts
    knots = step * np.arange(-DEGREE, parts + DEGREE + 1)
    # a knot is one part wide however far the rounding of an angle takes it
    inside = np.clip(np.mod(angle, FULL_TURN), 0.0, np.nextafter(FULL_TURN, 0.0))
    open_basis = BSpline.design_matrix(inside, knots, DEGREE).toarray()
    basis = np.zeros((len(angle), parts))
    basis += open_basis[:, :parts]
    basis[:, :DEGREE] += open_basis[:, parts:]
    weights = np.linalg.lstsq(basis, value, rcond=None)[0]
    at_knots = BSpline(knots, weights[np.arange(parts + DEGREE) % parts], DEGREE)
    lift = Lift(uniform_turn(parts), _not_below_zero(at_knots(uniform_turn(parts))))
    return FittedLift(lift, parts, value - lift(angle))


def _not_below_zero(values: Array) -> Array:
    """Lifts are counted from the lowest; noise about a dwell at zero may not go below."""
    return values - min(float(values.min()), 0.0)


def _table(theta: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    angle, value = finite("lift.angle", theta), finite("lift.lift", values)
    return one_turn(angle, value, "lift.angle")[:2]
