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
    cycles: Iterable[Cycle],
    measure: Callable[[Cycle], float],
    *,
    at_least: bool = False,
    integral: bool = True,
) -> Extreme:
    """Greatest (or least) over the load cases of one value per turn; NaN if any is.

    The error of an integral over the turn is the grid convergence index of two meshes at the second
    order, 3 |f1 - f2|/(r^2 - 1): against every second and every third position, the greater. One
    alone can coincide with the full turn by its phase.

    Parameters
    ----------
    measure : callable   cycle -> value
    integral : bool      False: a residual or a value without quadrature, of no such error

    References
    ----------
    Roache (1998), sec. 5.6; ASME V&V 20-2009, sec. 2-4.
    """

    def values(cycle: Cycle) -> Array:
        return np.array([measure(cycle)])

    def error(cycle: Cycle, value: float) -> float:
        if not integral:
            return 0.0
        coarse = {step: measure(each) for step, each in cycle.thinned.items()}
        return max(_index(value, each, step) for step, each in coarse.items())

    return _extreme(cycles, values, -1.0 if at_least else 1.0, error)


def _index(value: float, coarse: float, ratio: int) -> float:
    """Grid convergence index of a value on two meshes at the second order, relative."""
    if value == coarse or np.isnan(value):
        return 0.0
    change = abs(coarse - value) / abs(value) if value != 0.0 else np.inf
    return np.inf if np.isnan(change) else float(3.0 * change / (ratio**2 - 1.0))


def _extreme(
    cycles: Iterable[Cycle],
    measure: Callable[[Cycle], Array],
    sign: float,
    error: Callable[[Cycle, float], float] | None = None,
) -> Extreme:
    """Extreme with its cam angle and sampling error, or with the error of a value per turn."""
    extreme, at = NOWHERE, None
    for cycle in cycles:
        values = np.asarray(measure(cycle), dtype=float)
        worst = int(np.argmax(sign * values))  # the first NaN, where there is one
        value = float(values[worst])
        if extreme.load_case and not (np.isnan(value) or sign * value > sign * extreme.value):
            continue
        theta = float(cycle.theta[worst]) if error is None else None
        share = _sampling_error(values, worst) if error is None and values.size > 2 else 0.0
        extreme, at = Extreme(value, cycle.load_case, theta, share), cycle
    if error is None or at is None:
        return extreme
    return extreme._replace(error_share=error(at, extreme.value))


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
