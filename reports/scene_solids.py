"""Simple solids as triangles, for a scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array


@dataclass(frozen=True, eq=False)
class Solid:
    """Points (3, n) and triangles (3, m) of their numbers."""

    points: Array
    triangles: NDArray[np.int64]

    def upright(self, height: float) -> Solid:
        """What lay along z, along y with its middle at `height`."""
        x, y, z = self.points
        return Solid(np.stack([x, z + height, -y]), self.triangles)

    def moved(self, across: float) -> Solid:
        """Moved along x."""
        return Solid(self.points + np.array([[across], [0.0], [0.0]]), self.triangles)

    def as_record(self, digits: int) -> dict[str, Any]:
        """Plain lists by the names that Plotly gives them."""
        record: dict[str, Any] = {
            name: [float(f"{value:.{digits}g}") for value in part]
            for name, part in zip("xyz", self.points.tolist(), strict=True)
        }
        return record | dict(zip("ijk", self.triangles.tolist(), strict=True))


def ring(outline: Array, width: float) -> Solid:
    """A closed outline (2, n) drawn out along z, half to either side; without ends."""
    count = outline.shape[1]
    low, high = (np.vstack([outline, np.full(count, side * width / 2)]) for side in (-1, 1))
    here = np.arange(count)
    there = (here + 1) % count
    first = np.stack([here, there, there + count])
    second = np.stack([here, there + count, here + count])
    return Solid(np.hstack([low, high]), np.hstack([first, second]))


def tube(outer: Array, inner: Array, height: float) -> Solid:
    """The flat ring between two closed outlines (2, n) at a height along z."""
    count = outer.shape[1]
    points = np.vstack([np.hstack([outer, inner]), np.full(2 * count, height)])
    here = np.arange(count)
    there = (here + 1) % count
    first = np.stack([here, there, there + count])
    second = np.stack([here, there + count, here + count])
    return Solid(points, np.hstack([first, second]))


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Solid:
    """A box between two corners."""
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1])
                        for z in (low[2], high[2])])  # fmt: skip
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    halves = [half for a, b, c, d in sides for half in ((a, b, c), (a, c, d))]
    return Solid(corners.T, np.array(halves).T)


def joined(solids: Sequence[Solid]) -> Solid:
    """Several as one."""
    starts = np.cumsum([0, *(solid.points.shape[1] for solid in solids)])
    triangles = [solid.triangles + start for solid, start in zip(solids, starts, strict=False)]
    return Solid(np.hstack([solid.points for solid in solids]), np.hstack(triangles))
