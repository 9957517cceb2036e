"""Mesh convergence on three meshes: Richardson extrapolation, observed order, error estimate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.errors import InputError

# Relative differences below this are scatter of the mesh position, not convergence.
_SCATTER = 2e-4


@dataclass(frozen=True)
class Convergence:
    """A quantity on meshes of decreasing element size.

    values, coarse to fine; extrapolated to zero element size; order, the observed one (None where
    the values scatter); gci, the grid convergence index: relative error bar of the finest value.
    """

    values: tuple[float, ...]
    extrapolated: float
    order: float | None
    gci: float


def converged(values: Sequence[float], ratio: float) -> Convergence:
    """Richardson extrapolation of three values on meshes refined by a constant ratio.

    Values that do not converge monotonically have no order; their error bar is their spread times
    the safety factor of two meshes.

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
    # An order above that of the stresses, or below one, would give too small an error bar.
    trusted = min(max(order, 1.0), 3.0)
    gain = ratio**trusted - 1
    return Convergence(
        (coarse, middle, fine), fine + second / gain, order, 1.25 * abs(second) / scale / gain
    )
