"""Extreme values of smooth periodic functions over the continuous turn."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn

Function = Callable[[Array], Array]

_ZOOM_POINTS = np.linspace(-1.0, 1.0, 33)
_ZOOMS = 7
"""Each zoom keeps a sixteenth of the bracket: 7 leave 4e-9 of it, whose square is round-off."""

_MINIMA_MAX = 256

TIE = 1e-9
"""Values this close, over the greatest magnitude among them, are equal: round-off orders them."""

_GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)
_SECTIONS = 50
"""4e-11 of the range is left."""


class Extremum(NamedTuple):
    """Minimum or maximum value and its angle, rad."""

    value: float
    theta: float


def first_greatest(values: ArrayLike) -> int:
    """Index of the greatest of values (n,); the first of those equal within `TIE`.

    Which of equal values is the greatest depends on the processor and its libraries. The first NaN,
    where there is one.
    """
    array = np.asarray(values, dtype=float)
    # A value of the turn as a whole has no other beside it.
    return 0 if array.size == 1 else int(first_greatest_of_rows(array[None, :])[0])


def first_least(values: ArrayLike) -> int:
    """Index of the least of values (n,); the first of equal ones, see `first_greatest`."""
    return first_greatest(-np.asarray(values, dtype=float))


def first_greatest_of_rows(values: Array) -> NDArray[np.intp]:
    """Indices (m,) of the greatest value of each row (m, n); see `first_greatest`."""
    top = values.max(axis=1, keepdims=True)
    size = np.maximum(top, -values.min(axis=1, keepdims=True))
    if np.isfinite(size).all():
        return np.asarray((values >= top - TIE * size).argmax(axis=1))
    size = np.where(np.isfinite(values), np.abs(values), 0.0).max(axis=1, keepdims=True)
    near = np.where(np.isnan(top), np.isnan(values), values >= top - TIE * size)
    return np.asarray(near.argmax(axis=1))


def to_rank(value: float) -> float:
    """Sort key of a value, rounded to 9 digits and decimals: round-off orders no equal values."""
    return round(float(f"{value:.9g}"), 9)


def local_minima(function: Function, count: int, *, lowest: bool = False) -> tuple[Array, Array]:
    """Local minima of a smooth periodic function and their angles, rad.

    Every sample not above its neighbours brackets a local minimum; all brackets are refined at
    once.

    Parameters
    ----------
    function : callable    array of angles (rad) of any shape -> array of the same shape
    count : int            samples per turn; two minima must not share a sample interval
    lowest : bool          only those that may be the lowest one, in the order of their angles;
                           where the function is constant within `TIE`, its samples

    Returns
    -------
    values, theta : array (m,)    m >= 1; of more than 256 minima the 256 with the lowest
                                  samples; a single NaN if any sample is NaN
    """
    theta = uniform_turn(count)
    values = function(theta)
    if (unknown := np.isnan(values)).any():
        return values[unknown][:1], theta[unknown][:1]
    equal = TIE * float(np.abs(values).max()) if lowest else 0.0
    above = np.minimum(np.roll(values, 1), np.roll(values, -1)) + equal
    low = np.flatnonzero(values <= above)
    step = np.abs(values - np.roll(values, 1))
    reach = np.maximum(step, np.roll(step, -1))
    if lowest:
        # The vertex of a parabola is below its sample by an eighth of this at most.
        low = low[values[low] - reach[low] <= values.min() + equal]
    # a constant function brackets at every sample; the lowest samples are enough
    ranked = np.maximum(values[low], values.min() + equal)
    low = low[np.argsort(ranked, kind="stable")[:_MINIMA_MAX]]
    if not lowest:
        best, where = refined(function, theta[low], FULL_TURN / count, _ZOOMS)
        return best, np.mod(where, FULL_TURN)
    low.sort()
    best, where = values[low], theta[low]
    bent = reach[low] > equal
    if bent.any():
        best[bent], where[bent] = refined(function, where[bent], FULL_TURN / count, _ZOOMS)
    return best, np.mod(where, FULL_TURN)


def refined(function: Function, centre: Array, half: float, zooms: int) -> tuple[Array, Array]:
    """Minima (m,) and their arguments in brackets `centre` +- `half`, by nested grids of 33 points.

    Parameters
    ----------
    function : callable    (m, 33) -> (m, 33), one row per centre
    half : float           half-width of the first bracket; each zoom keeps a sixteenth
    """
    best = np.full(centre.shape, np.nan)
    for _ in range(zooms):
        trial = centre[:, None] + half * _ZOOM_POINTS
        values = function(trial)
        pick = np.argmin(values, axis=1)[:, None]
        centre = np.take_along_axis(trial, pick, axis=1)[:, 0]
        best = np.take_along_axis(values, pick, axis=1)[:, 0]
        half /= 16.0
    return best, centre


def least(function: Function, count: int) -> Extremum:
    """Minimum of a smooth periodic function over the continuous turn; see `local_minima`.

    Of equal minima the angle is that of the first, see `first_greatest`.
    """
    values, theta = local_minima(function, count, lowest=True)
    return Extremum(float(values.min()), float(theta[first_least(values)]))


def greatest(function: Function, count: int) -> Extremum:
    """Maximum of a smooth periodic function over the continuous turn; see `local_minima`."""
    value, theta = least(lambda angle: -function(angle), count)
    return Extremum(-value, theta)


def sampled_greatest(values: Array) -> Array:
    """Maxima (...) of smooth periodic functions sampled at equal angles (..., n).

    Vertex of the parabola through the greatest sample and its neighbours: the error is of order
    h^3 for a spacing h. At a kink or a step it is at most the intersection of the lines through the
    two samples on either side. NaN if any sample is NaN.
    """
    return _vertex(values, np.argmax(values, axis=-1))[0]


def sampled_peak(values: Array) -> Extremum:
    """Maximum of a function sampled at n equal angles from 0, and its angle, rad.

    As `sampled_greatest`; of equal samples the first, see `first_greatest`. A sample with an
    infinite or missing one beside it is not refined.

    Parameters
    ----------
    values : array (n,)
    """
    at = first_greatest(values)
    value, shift = float(values[at]), 0.0
    if np.isfinite(np.take(values, at + np.arange(-2, 3), mode="wrap")).all():
        value, shift = (float(each) for each in _vertex(values, np.asarray(at)))
    return Extremum(value, (at + shift) * FULL_TURN / values.size % FULL_TURN)


def _vertex(values: Array, at: NDArray[np.intp]) -> tuple[Array, Array]:
    """Maxima (...) near the greatest samples of periodic functions `values` (..., n), and their
    distances from it in samples; at : (...), number of that sample. By the parabola through three
    samples, or where that is higher at a kink, by the lines on both sides.
    """
    first, before, here, after, last = (
        np.take_along_axis(values, (at + step)[..., None] % values.shape[-1], axis=-1)[..., 0]
        for step in (-2, -1, 0, 1, 2)
    )
    second = before - 2.0 * here + after
    bent = second < 0.0
    rise = np.divide((after - before) ** 2, -8.0 * second, out=np.zeros_like(second), where=bent)
    shift = np.divide(before - after, 2.0 * second, out=np.zeros_like(second), where=bent)
    up, down = before - first, last - after
    turn = up - down
    place = np.divide(after - before - up - down, turn, out=np.zeros_like(turn), where=turn > 0.0)
    place = np.clip(place, -1.0, 1.0)
    above = np.minimum(before + up * (place + 1.0), after + down * (place - 1.0)) - here
    kink = np.maximum(above, 0.0)
    return np.asarray(here + np.minimum(rise, kink)), np.where(rise > kink, place, shift)


def sampled_least(values: Array) -> Array:
    """Minima (...) of smooth periodic functions; see `sampled_greatest`."""
    return -sampled_greatest(-values)


def least_argument(
    function: Callable[[float], float], low: float, high: float, sections: int = _SECTIONS
) -> float:
    """Argument of the minimum of a unimodal function between `low` and `high`.

    By golden sections, which leave 0.618^sections of the range; the function may have a kink.
    """
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    for _ in range(sections):
        if at_left <= at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = function(right)
    return 0.5 * (low + high)
