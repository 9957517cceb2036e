"""Extreme values over the turns of all load cases, and where they are."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.cycle.cycle import Cycle


class Extreme(NamedTuple):
    """The value that decides, and where.

    Parameters
    ----------
    value : float
    load_case : str        "" where there is none
    cam_angle : float      rad; None where there is none
    error_share : float    difference of the samples' peak from the true one, over the value
    """

    value: float
    load_case: str = ""
    cam_angle: float | None = None
    error_share: float = 0.0


NOWHERE = Extreme(np.nan)


def greatest(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """The greatest of a measure over all load cases and angles; a NaN wins.

    Parameters
    ----------
    measure : callable   cycle -> array (n,), one value an angle
    """
    return _extreme(cycles, measure, 1.0)


def least(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """The least of a measure over all load cases and angles; a NaN wins."""
    return _extreme(cycles, measure, -1.0)


def worst_case(
    cycles: Iterable[Cycle], measure: Callable[[Cycle], float], *, at_least: bool = False
) -> Extreme:
    """The load case with the greatest (or least) value of a measure of the whole turn."""
    return _extreme(cycles, lambda c: np.array([measure(c)]), -1.0 if at_least else 1.0, False)


def _extreme(
    cycles: Iterable[Cycle], measure: Callable[[Cycle], Array], sign: float, angle: bool = True
) -> Extreme:
    extreme = NOWHERE
    for cycle in cycles:
        values = np.asarray(measure(cycle), dtype=float)
        worst = int(np.argmax(sign * values))  # the first NaN, where there is one
        value = float(values[worst])
        if extreme.load_case and not (np.isnan(value) or sign * value > sign * extreme.value):
            continue
        theta = float(cycle.theta[worst]) if angle else None
        share = _missed_between_samples(values, worst) if angle and values.size > 2 else 0.0
        extreme = Extreme(value, cycle.load_case, theta, share)
    return extreme


def _missed_between_samples(values: Array, worst: int) -> float:
    """Distance of the parabola's vertex through three samples beyond the middle one, relative.

    A kink has no vertex; the parabola then gives less than half a step of the slope, which is
    what the samples are good for.
    """
    before, here, after = values[worst - 1], values[worst], values[(worst + 1) % values.size]
    if not np.isfinite([before, here, after]).all():
        return 0.0
    bend = before - 2.0 * here + after
    if bend == 0.0 or here == 0.0:
        return 0.0
    return float(abs((after - before) ** 2 / (8.0 * bend) / here))
