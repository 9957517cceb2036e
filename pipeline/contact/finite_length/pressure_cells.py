"""Rectangular cells of constant contact pressure: uniform across, graded along the contact.

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
# Peak at a rounded end: cells over its width per cell over the half-width; widths beyond the flat
# with cells of that size, and up to which there are cells; narrowest peak over the radius for which
# the growth of the cells is not exceeded.
_PER_PEAK, _PEAK_RESOLVED, _PEAK_WIDTHS, _LEAST_CELL = 0.5, 3.0, 7.0, 2e-3


@dataclass(frozen=True)
class CellSizes:
    """Grading of cells: number per half-width, size at the ends, growth, greatest size, m.

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
        """Refuse sizes and shares that are not positive, and a growth below 1."""
        for name in ("per_half_width", "at_end", "uniform", "largest", "largest_share", "window"):
            if not getattr(self, name) > 0:
                raise InputError(name, getattr(self, name), "> 0")
        if not self.growth >= 1:
            raise InputError("growth", self.growth, ">= 1")

    def coarser(self, ratio: float) -> CellSizes:
        """The grading with cells larger by a ratio."""
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
    """Cell edges, m: x (k + 1,) from 0, y (m + 1,) ascending, symmetric about 0.

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
    """Cells of a contact of a Hertz half-width, m.

    Beyond the flat they cover a rounded end as far as it may touch, and no chamfer.
    """
    return PressureCells(edges_across(half_width, sizes), edges_along(pair, half_width, sizes))


def edges_across(half_width: float, sizes: CellSizes) -> Array:
    """Edges (k + 1,), m, from 0 of the cells across a contact of a Hertz half-width, m: equal up to
    4/3 of it, then growing until they reach the window.
    """
    h = half_width / sizes.per_half_width
    x = [h * k for k in range(int(np.ceil(_UNIFORM * sizes.per_half_width)) + 1)]
    while x[-1] < sizes.window * half_width:
        x.append(x[-1] + _ACROSS_GROWTH * (x[-1] - x[-2]))
    return np.array(x)


def edges_along(pair: FinitePair, half_width: float, sizes: CellSizes) -> Array:
    """Edges (m + 1,), m, of the cells along a contact of a Hertz half-width, m, symmetric about 0.

    At a rounded end the cells resolve the width of its peak, which depends on the half-width; their
    number does not.
    """
    flat = 0.5 * pair.contact_length
    largest = max(sizes.largest, sizes.largest_share * 2.0 * flat)
    radius = _end_radius(pair)
    if radius is None:
        fine = min(sizes.uniform * sizes.at_end, 0.5 * flat)
        steps = np.linspace(0.0, fine, sizes.uniform + 1)
        inwards = graded(flat - fine, steps[1] * sizes.growth, sizes.growth, largest)
        half = np.concatenate(
            [[0.0], (flat - np.concatenate([steps[:-1], fine + inwards]))[-2::-1]]
        )
    else:
        half = _rounded(flat, radius, rounded_peak(radius, half_width, pair.curvature), sizes)
    return np.concatenate([-half[:0:-1], half])


def rounded_peak(radius: float, half_width: float, curvature: float) -> float:
    """Width, m, of the pressure peak at a rounded end; radius, half-width m, curvature 1/m.

    Over it the drop of the arc is the difference of the indentation of a half-space under the sharp
    end of a line contact, which grows with the root of the distance.
    """
    drop = 0.5 * half_width * curvature * radius
    return float(np.cbrt(drop**2 * half_width))


def _end_radius(pair: FinitePair) -> float | None:
    """Radius, m, of the ends of the contact; None where they are not rounded."""
    radii = [
        body.end.size
        for body in pair.bodies
        if body.end.kind == "radius" and body.flat_length == pair.contact_length
    ]
    return min(radii, default=None)


def _rounded(flat: float, radius: float, peak: float, sizes: CellSizes) -> Array:
    """Edges, m, of the cells of the half y >= 0 of a line with a rounded end.

    Parameters
    ----------
    flat : float     half the length of the flat part, m
    radius : float   of the rounded end, m
    peak : float     width of the pressure peak at the end, m
    """
    per_peak = sizes.per_half_width * _PER_PEAK
    resolved = int(np.ceil(_PEAK_RESOLVED * per_peak))
    beyond = np.arange(resolved + 1) / per_peak
    while beyond[-1] < _PEAK_WIDTHS:
        beyond = np.append(beyond, beyond[-1] + sizes.growth * (beyond[-1] - beyond[-2]))
    width = min(peak, radius / beyond[-1], 0.25 * flat)
    # As many cells as the narrowest peak takes, of the growth that fits.
    largest = max(sizes.largest, sizes.largest_share * 2.0 * flat)
    count = graded(flat, _LEAST_CELL * radius / per_peak, sizes.growth, largest).size - 1
    first = width / per_peak
    inwards = np.concatenate([[0.0], np.cumsum(_steps(flat, first, count, largest))])
    inwards[-1] = flat  # the edge in the middle is at 0, without round-off
    return np.asarray(np.concatenate([flat - inwards[::-1], flat + width * beyond[1:]]))


def _steps(length: float, first: float, count: int, largest: float) -> Array:
    """Steps (count,), m, which sum up to `length`, m, and grow from about `first`, m, by a constant
    ratio up to `largest`, m.
    """

    def steps(ratio: float) -> Array:
        return np.asarray(np.minimum(first * ratio ** np.arange(count), largest))

    low, high = 1.0, 10.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if steps(middle).sum() < length else (low, middle)
    fitted = steps(high)
    return np.asarray(fitted * (length / fitted.sum()))


def graded(length: float, first: float, growth: float, largest: float) -> Array:
    """Edges (k,) from 0 to `length`, m; steps grow from `first`, m, by the ratio `growth` to at
    most about `largest`, m. One step where the first is longer than the length.
    """
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
