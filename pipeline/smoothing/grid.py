"""Array of the energy's spline at a set of cam angles, six entries a row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.energy_spline import basis_rows

ORDERS = 4  # E, E', E'', E'''


@dataclass(frozen=True, eq=False)
class Grid:
    """Cam angles (m,), the columns (m, 6) of the splines there, and their values by order."""

    theta: Array
    columns: NDArray[np.intp]
    entries: Array

    @classmethod
    def at(cls, theta: Array, count: int) -> Grid:
        """The grid of `count` splines at angles theta (m,), rad."""
        found = [basis_rows(theta, count, order) for order in range(ORDERS)]
        return cls(theta, found[0][1], np.stack([values for values, _ in found]))

    def energy(self, coefficients: Array) -> tuple[Array, ...]:
        """E, E', E'', E''' at the angles, J/rad^k, each (m,)."""
        local = coefficients[self.columns]
        return tuple(np.sum(entry * local, axis=1) for entry in self.entries)

    def chained(self, local: Array) -> Array:
        """Derivatives (m, 6) by the coefficients, from those (4, m) by E, E', E'', E'''."""
        return np.einsum("km,kmj->mj", local, self.entries)
