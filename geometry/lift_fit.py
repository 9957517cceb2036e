"""Lift from a table: interpolation of few points, or a least-squares fit of noisy ones."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import NEGATIVE_TOLERANCE, Lift, one_turn
from camwright.geometry.periodic_spline import DEGREE, LEAST_SAMPLES, interpolant

POINTS_MIN = DEGREE + 1
_SAMPLED = 1440
_PARTS_GROWTH = 1.25
"""Ratio of successive numbers of spline parts."""
_POINTS_PER_PART = 2.0
"""Minimum: fewer would fit the noise."""
_DIFFERENCE_ORDER = 4
"""Of the differences from which the noise is estimated: a smooth lift leaves nothing in them."""
_SIGMA = 1.4826
"""Standard deviation of a normal distribution over its median magnitude."""
EVEN = 1e-3
"""Of a step: departure of angles that count as evenly spaced, the last digit of a table."""
BELOW_ZERO = 5.0
"""Depth below zero that errors explain, over their standard deviation: one value of 3e6."""


@dataclass(frozen=True, eq=False)
class FittedLift:
    """Lift fitted to a noisy table, with its residual.

    lift : Lift
    parts : int                 spline parts per turn
    residual : array (n,)       table minus lift, m
    noise : float               standard deviation of the table's errors, m
    """

    lift: Lift
    parts: int
    residual: Array
    noise: float

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
    _refuse_overshoot(angle, value, even, spline(even))
    return Lift(even, spline(even))


def _refuse_overshoot(angle: Array, value: Array, theta: Array, lift: Array) -> None:
    """Refuse a spline, `lift` (m,) over `theta` (m,), that falls below zero between points, `value`
    (n,) over `angle` (n,), that do not; m, rad.
    """
    depth, place = float(lift.min()), float(theta[lift.argmin()])
    if depth >= -NEGATIVE_TOLERANCE or value.min() < -NEGATIVE_TOLERANCE:
        return
    after = int(np.searchsorted(angle, place)) % angle.size
    ends = (after - 1) % angle.size, after
    turned = np.array([0.0, FULL_TURN if after == 0 else 0.0])  # the last point and the first
    points = " and ".join(
        f"{np.degrees(angle[k] + turn):.6g} deg ({1e3 * value[k]:.4g} mm)"
        for k, turn in zip(ends, turned, strict=True)
    )
    raise InputError(
        "lift.point",
        f"a spline down to {1e3 * depth:.4g} mm",
        f">= 0 mm: it overshoots at {np.degrees(place):.4g} deg, between the points at {points};"
        ' write dwells as segments (lift.kind = "segments", law = "dwell") or set more points',
    )


def overshoot(
    theta: ArrayLike, values: ArrayLike, lift: Lift, *, level: bool = False
) -> tuple[float, float]:
    """Greatest excursion of a lift beyond its two neighbouring points, m, and its cam angle.

    Parameters
    ----------
    theta : array (n,)     of the points, rad, increasing
    values : array (n,)    s of the points, m
    level : bool           between equal neighbours alone, as in a dwell

    Returns
    -------
    away, place : float    m, < 0 below the points; rad
    """
    angle, value = _table(theta, values)
    even = uniform_turn(_SAMPLED)
    after = np.searchsorted(angle, even, side="right") % angle.size
    ends = np.stack([value[(after - 1) % angle.size], value[after]])
    drawn = lift(even)
    away = drawn - np.clip(drawn, ends.min(axis=0), ends.max(axis=0))
    if level:
        away = np.where(ends[0] == ends[1], away, 0.0)
    most = int(np.abs(away).argmax())
    return float(away[most]), float(even[most])


def estimated_noise(theta: ArrayLike, values: ArrayLike) -> float | None:
    """Standard deviation of the errors of a table, m, from its differences; None: uneven angles.

    The fourth difference of white noise has the variance of the noise times 70, the sum of the
    squares of its weights; the median magnitude ignores the few at steps of the acceleration.

    Parameters
    ----------
    theta : array (n,)     rad, strictly increasing within one turn
    values : array (n,)    s, m

    References
    ----------
    von Neumann, Ann. Math. Stat. 12 (1941) 367: variance from successive differences.
    """
    angle, value = _table(theta, values)
    even = uniform_turn(angle.size) + angle[0]
    if np.abs(angle - even).max() > EVEN * (FULL_TURN / angle.size):
        return None
    rounds = np.append(value, value[:_DIFFERENCE_ORDER])
    scale = np.sqrt(float(comb(2 * _DIFFERENCE_ORDER, _DIFFERENCE_ORDER)))
    return float(_SIGMA * np.median(np.abs(np.diff(rounds, _DIFFERENCE_ORDER))) / scale)


def measured_lift(theta: ArrayLike, values: ArrayLike) -> FittedLift | None:
    """Spline fitted to a measured lift table, theta (n,), rad, values (n,), m, within the noise
    that is estimated from its differences.

    None where no noise can be estimated, of unevenly spaced angles or exact values, and where no
    spline lies within it.

    Raises
    ------
    InputError
        As `fitted_lift`, for a table; not for its noise.
    """
    noise = estimated_noise(theta, values)
    if not noise:
        return None
    angle, value = _table(theta, values)
    return _fit_within(angle, value, noise)[0]


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
        lift has corners; if a value lies further below zero than noise explains.

    References
    ----------
    de Boor, A Practical Guide to Splines (1978), ch. XIV: least squares, the residual as guide.
    """
    if not 0.0 < noise < np.inf:
        raise InputError("lift.noise", noise, "> 0 m")
    angle, value = _table(theta, values)
    fit, closest = _fit_within(angle, value, noise)
    if fit is None:
        limit = f">= {1e6 * closest:.4g} um, the rms residual of the closest smooth lift"
        raise InputError("lift.noise", f"{1e6 * noise:.4g} um", limit)
    return fit


def _fit_within(angle: Array, value: Array, noise: float) -> tuple[FittedLift | None, float]:
    """Fit of fewest spline parts whose rms residual is within `noise`, m, None where none is, and
    the rms residual of the last fit, m; angle (n,), rad, value (n,), m.
    """
    lowest = float(value.min())
    if not lowest >= -BELOW_ZERO * noise:
        at = f"{1e3 * lowest:.4g} mm at {np.degrees(angle[value.argmin()]):.4g} deg"
        limit = (
            f">= {-BELOW_ZERO * 1e3 * noise:.4g} mm, {BELOW_ZERO:g} times the noise of"
            f" {1e6 * noise:.4g} um: state the lift from the base circle"
        )
        raise InputError("lift.values", at, limit)
    parts_max = int(len(angle) / _POINTS_PER_PART)
    if parts_max < LEAST_SAMPLES:
        raise InputError("lift.file", f"{len(angle)} rows", f">= {2 * LEAST_SAMPLES} rows")
    parts = LEAST_SAMPLES
    while True:
        fit = _least_squares(angle, value, parts, noise)
        if fit.residual_rms <= noise:
            return fit, fit.residual_rms
        if parts == parts_max:
            return None, fit.residual_rms
        parts = min(int(np.ceil(parts * _PARTS_GROWTH)), parts_max)


def _least_squares(angle: Array, value: Array, parts: int, noise: float) -> FittedLift:
    """Periodic quintic spline of `parts` equal parts fitted to a table, angle (n,), rad, value
    (n,), m, by least squares; noise : that of the table, m, which the result records.
    """
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
    return FittedLift(lift, parts, value - lift(angle), noise)


def _not_below_zero(values: Array) -> Array:
    """Values raised to zero where noise takes a dwell below it, m."""
    return values - min(float(values.min()), 0.0)


def _table(theta: ArrayLike, values: ArrayLike) -> tuple[Array, Array]:
    """Angles, rad, and lifts, m, of a table over one turn, both (n,), without its repeated end;
    InputError as `one_turn`.
    """
    angle, value = finite("lift.angle", theta), finite("lift.lift", values)
    return one_turn(angle, value, "lift.angle")[:2]
