"""Rectangular cells of constant contact pressure: uniform across the contact, finer at its ends.

The pressure is symmetric about x = 0, so that the cells of x > 0 are enough.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair

_GAUSS = np.polynomial.legendre.leggauss(5)
# Uniform cells across the contact up to this multiple of the half-width, coarser ones beyond.
_UNIFORM = 4.0 / 3.0
_ACROSS_GROWTH = 1.4
# Drop of a rounded end, over half-width squared times curvature, up to which there are cells, and
# cells per radius.
_ROUNDED, _PER_RADIUS = 4.0, 32


@dataclass(frozen=True)
class CellSizes:
    """Cells per half-width; size at the ends, m, of `uniform` cells, and growth from there.

    The largest size is that in m or, if larger, the share of the length of contact. The cells reach
    `window` half-widths across: at a chamfer the contact is twice as wide as in the middle.
    """

    per_half_width: float = 6.0
    at_end: float = 20e-6
    uniform: int = 5
    growth: float = 1.6
    largest: float = 4e-4
    largest_share: float = 1.0 / 12.0
    window: float = 2.2

    def __post_init__(self) -> None:
        for name in ("per_half_width", "at_end", "uniform", "largest", "largest_share", "window"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "> 0")
        if not self.growth >= 1:
            raise InputError("growth", self.growth, ">= 1")

    def coarser(self, ratio: float) -> CellSizes:
        """The same grading with cells larger by a ratio."""
        return replace(
            self,
            per_half_width=self.per_half_width / ratio,
            at_end=self.at_end * ratio,
            uniform=int(np.ceil(self.uniform / ratio)),
            largest=self.largest * ratio,
            largest_share=self.largest_share * ratio,
        )


@dataclass(frozen=True, eq=False)
class PressureCells:
    """Edges of the cells, m: x (k + 1,) from 0, y (m + 1,) ascending and symmetric about 0.

    Values of cells are (..., m k), the x running faster.
    """

    x: Array
    y: Array

    def __post_init__(self) -> None:
        freeze(self, x=self.x, y=self.y)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of cells along y and x."""
        return self.y.size - 1, self.x.size - 1

    @property
    def areas(self) -> Array:
        """Areas (m k,), m2, of the half x > 0."""
        return np.outer(np.diff(self.y), np.diff(self.x)).ravel()

    @property
    def centres_along(self) -> Array:
        """y (m,), m, of the centres."""
        return _middles(self.y)

    @property
    def centres(self) -> tuple[Array, Array]:
        """x and y (m k,), m, of the centres."""
        along, across = np.meshgrid(_middles(self.y), _middles(self.x), indexing="ij")
        return across.ravel(), along.ravel()

    def integrated_gap(self, pair: FinitePair) -> Array:
        """Gap (m k,) of the undeformed surfaces integrated over each cell, m3."""
        points, weights = _GAUSS
        x, y = (_middles(v)[:, None] + 0.5 * np.diff(v)[:, None] * points for v in (self.x, self.y))
        gap = pair.gap(x[None, :, None, :], y[:, None, :, None])
        mean = np.einsum("yxab,a,b->yx", gap, weights, weights) / 4.0
        return np.asarray(mean.ravel() * self.areas)


def pressure_cells(pair: FinitePair, half_width: float, sizes: CellSizes) -> PressureCells:
    """Cells of a contact of a half-width, m, by Hertz.

    Beyond the flat they cover a rounded end as far as it may touch, and no chamfer.
    """
    h = half_width / sizes.per_half_width
    x = [h * k for k in range(int(np.ceil(_UNIFORM * sizes.per_half_width)) + 1)]
    while x[-1] < sizes.window * half_width:
        x.append(x[-1] + _ACROSS_GROWTH * (x[-1] - x[-2]))
    flat = 0.5 * pair.contact_length
    radii = [
        b.end.size for b in pair.bodies if b.end.kind == "radius" and b.flat_length == 2 * flat
    ]
    at_end, cells_beyond = sizes.at_end, 0
    if radii:
        at_end = min(at_end, min(radii) / _PER_RADIUS)
        drop = _ROUNDED * half_width**2 * pair.curvature
        cells_beyond = int(np.ceil(min(np.sqrt(2.0 * min(radii) * drop), *radii) / at_end))
    fine = min(sizes.uniform * at_end, 0.5 * flat)
    steps = np.linspace(0.0, fine, sizes.uniform + 1)
    largest = max(sizes.largest, sizes.largest_share * 2.0 * flat)
    inwards = graded(flat - fine, steps[1] * sizes.growth, sizes.growth, largest)
    inside = flat - np.concatenate([steps[:-1], fine + inwards])
    beyond = at_end * np.arange(1, cells_beyond + 1)
    half = np.concatenate([[0.0], inside[-2::-1], flat + beyond])
    return PressureCells(np.array(x), np.concatenate([-half[:0:-1], half]))


def graded(length: float, first: float, growth: float, largest: float) -> Array:
    """Edges (k,) from 0 to `length`, their distances growing from `first` to `largest` at most."""
    if first >= length:
        return np.array([0.0, length])
    step, ends = first, [0.0, first]
    while ends[-1] < length:
        step = min(step * growth, largest)
        ends.append(ends[-1] + step)
    edges = np.array(ends)
    # The first step is kept, the others are scaled to end at `length`.
    scaled = first + (edges[1:] - first) * (length - first) / (edges[-1] - first)
    return np.concatenate([[0.0], scaled])


def _middles(edges: Array) -> Array:
    return np.asarray(0.5 * (edges[1:] + edges[:-1]))
