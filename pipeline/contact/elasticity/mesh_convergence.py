"""Three meshes of one contact: extrapolation, observed order, error estimate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.errors import InputError

# Differences below this share are the scatter of mesh positions, not a trend.
_SCATTER = 2e-4


@dataclass(frozen=True)
class Convergence:
    """A quantity on meshes of falling size.

    values, coarse to fine; extrapolated to zero size; order observed (None when the values
    scatter rather than converge); gci, the grid convergence index, a relative error bar of the
    finest value.
    """

    values: tuple[float, ...]
    extrapolated: float
    order: float | None
    gci: float


def converged(values: Sequence[float], ratio: float) -> Convergence:
    """Richardson extrapolation of three values on meshes refined by a constant ratio.

    Values that do not settle monotonically have no order; their spread, with the safety factor
    of two meshes, is the error bar.

    Raises
    ------
    InputError
        If there are not three finite values or the ratio is below 1.1.

    References
    ----------
    Roache (1998); ASME V&V 20-2009, sec. 2-4.
    """
    if len(values) != 3 or not np.isfinite(values).all():
        raise InputError("values", tuple(values), "three finite numbers")
    if not ratio >= 1.1:
        raise InputError("ratio", ratio, ">= 1.1")
    coarse, middle, fine = (float(v) for v in values)
    scale = abs(fine) or 1.0
    first, second = middle - coarse, fine - middle
    spread = (max(values) - min(values)) / scale
    if first * second <= 0 or abs(second) >= abs(first) or spread < _SCATTER:
        return Convergence((coarse, middle, fine), fine, None, 3.0 * spread)
    order = float(np.log(first / second) / np.log(ratio))
    # An order below one or above that of the stresses would flatter the error bar.
    trusted = min(max(order, 1.0), 3.0)
    gain = ratio**trusted - 1
    return Convergence(
        (coarse, middle, fine), fine + second / gain, order, 1.25 * abs(second) / scale / gain
    )
