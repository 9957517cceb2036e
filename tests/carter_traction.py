"""Traction over the line contact in steady rolling."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.traction import stick_half_width


def rolling_traction(x: ArrayLike, ratio: float) -> Array:
    """Carter's traction (...) of steady rolling; the stick zone starts at the leading edge x = -1.

    References
    ----------
    Carter (1926); Johnson, Contact Mechanics (1985), sec. 8.3.
    """
    stick = float(stick_half_width(ratio))
    at = np.asarray(x, dtype=float)
    full = np.sqrt(np.maximum(1 - at**2, 0.0))
    if stick == 0:
        return np.asarray(full)
    in_stick = np.sqrt(np.maximum(1 - ((at - (stick - 1)) / stick) ** 2, 0.0))
    return np.asarray(full - stick * in_stick)
