"""Cubic interpolation that keeps the monotony of its samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError


@dataclass(frozen=True, eq=False)
class MonotoneCubic:
    """Monotone cubic (C1) through samples; the end cubics extrapolate.

    Parameters
    ----------
    places : array (n,)    strictly increasing, n >= 3
    values : array (n,)    any unit

    Raises
    ------
    InputError
        If the places do not increase, there are fewer than three, or a value is not finite.

    References
    ----------
    Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300; ends: Moler, Numerical Computing
    with MATLAB (2004), sec. 3.6.
    """

    places: Array
    values: Array

    def __post_init__(self) -> None:
        """Refuse fewer than three places, places that do not increase, and values that are not
        finite.
        """
        freeze(
            self,
            places=finite("interpolation.places", self.places),
            values=finite("interpolation.values", self.values),
        )
        if self.places.size < 3 or self.values.shape != self.places.shape:
            counts = f"{self.places.size} places, {self.values.size} values"
            raise InputError("interpolation", counts, "as many values as places, 3 or more")
        steps = np.diff(self.places)
        if not (steps > 0.0).all():
            raise InputError("interpolation.places", float(steps.min()), "strictly increasing")

    @cached_property
    def _slopes(self) -> Array:
        """Slope at each sample (n,), value per place: weighted harmonic mean of the slopes of the
        two pieces beside it, 0 at an extreme.
        """
        step, rise = np.diff(self.places), np.diff(self.values) / np.diff(self.places)
        before, after = rise[:-1], rise[1:]
        first, second = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
        same = before * after > 0.0
        whole = np.where(same, first / np.where(same, before, 1.0), 1.0)
        whole = whole + np.where(same, second / np.where(same, after, 1.0), 0.0)
        inner = np.where(same, (first + second) / whole, 0.0)
        return np.concatenate(
            [[_end_slope(step, rise)], inner, [_end_slope(step[::-1], rise[::-1])]]
        )

    def __call__(self, at: ArrayLike, derivative: int = 0) -> Array:
        """Value, or with `derivative` 1 the slope, at any places (...); cubic Hermite pieces."""
        x = np.asarray(at, dtype=float)
        k = np.clip(np.searchsorted(self.places, x, side="right") - 1, 0, self.places.size - 2)
        step, slope = np.diff(self.places)[k], self._slopes
        rise = np.diff(self.values)[k] / step
        square = (3.0 * rise - 2.0 * slope[k] - slope[k + 1]) / step
        twist = (slope[k] + slope[k + 1] - 2.0 * rise) / step**2
        t = x - self.places[k]
        if derivative == 1:
            return np.asarray(slope[k] + t * (2.0 * square + 3.0 * t * twist))
        return np.asarray(self.values[k] + t * (slope[k] + t * (square + t * twist)))


def _end_slope(step: Array, rise: Array) -> float:
    """Slope at the first sample by the parabola through three, limited to keep the monotony; step,
    rise : lengths and slopes of the pieces, that at this end first.
    """
    slope = float(((2.0 * step[0] + step[1]) * rise[0] - step[0] * rise[1]) / (step[0] + step[1]))
    if slope * rise[0] <= 0.0:
        return 0.0
    if rise[0] * rise[1] < 0.0 and abs(slope) > 3.0 * abs(rise[0]):
        return float(3.0 * rise[0])
    return slope
