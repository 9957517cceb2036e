"""Extreme values over the turns of all load cases, with load case and cam angle."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.cycle.cycle import Cycle


class Extreme(NamedTuple):
    """Extreme value with load case and cam angle.

    Parameters
    ----------
    value : float
    load_case : str        "": none
    cam_angle : float      rad; None: none
    error_share : float    sampling error of the extreme over its value
    """

    value: float
    load_case: str = ""
    cam_angle: float | None = None
    error_share: float = 0.0


NOWHERE = Extreme(np.nan)


def greatest(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """Greatest value over all load cases and angles; NaN if any is.

    Parameters
    ----------
    measure : callable   cycle -> array (n,), by cam angle
    """
    return _extreme(cycles, measure, 1.0)


def least(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """Least value over all load cases and angles; NaN if any is."""
    return _extreme(cycles, measure, -1.0)


def worst_case(
    cycles: Iterable[Cycle], measure: Callable[[Cycle], float], *, at_least: bool = False
) -> Extreme:
    """Greatest (or least) over the load cases of one value per turn; NaN if any is."""
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
        share = _sampling_error(values, worst) if angle and values.size > 2 else 0.0
        extreme = Extreme(value, cycle.load_case, theta, share)
    return extreme


def _sampling_error(values: Array, worst: int) -> float:
    """Vertex of the parabola through three samples less the middle one, relative.

    At a kink it is below half of the difference of neighbouring samples: the sampling error there.
    """
    before, here, after = values[worst - 1], values[worst], values[(worst + 1) % values.size]
    if not np.isfinite([before, here, after]).all():
        return 0.0
    bend = before - 2.0 * here + after
    if bend == 0.0 or here == 0.0:
        return 0.0
    return float(abs((after - before) ** 2 / (8.0 * bend) / here))
