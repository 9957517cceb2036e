"""Fields on a fixed window of pixels, sampled anew for every picture of a film.

Between two pictures of a turn only angles and values change, so that what can be found once per
pixel is. This needs no graphics device and gives the same picture everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.spatial import Delaunay

from camwright.geometry.arrays import Array

Pixels = Any
_OWN = 220  # samples across a body's own raster


@dataclass(frozen=True)
class Window:
    """A window of pixels on a plane: its left lower corner and the size of a pixel, mm."""

    left: float
    lower: float
    pixel: float
    width: int
    height: int

    @cached_property
    def across(self) -> Array:
        """Middles of the columns (width,), mm."""
        return np.asarray(self.left + self.pixel * (np.arange(self.width) + 0.5))

    @cached_property
    def upwards(self) -> Array:
        """Middles of the rows (height,), mm, the highest first."""
        return np.asarray(self.lower + self.pixel * (np.arange(self.height)[::-1] + 0.5))

    @cached_property
    def points(self) -> Array:
        """Middles of the pixels (2, height, width), mm."""
        return np.stack(np.broadcast_arrays(self.across[None, :], self.upwards[:, None]))

    def part(self, low: Array, high: Array) -> tuple[slice, slice]:
        """Rows and columns that hold a box between two corners (2,), mm, and a pixel more."""
        columns = np.searchsorted(self.across, (low[0] - self.pixel, high[0] + self.pixel))
        rows = np.searchsorted(-self.upwards, (-high[1] - self.pixel, self.pixel - low[1]))
        return slice(int(rows[0]), int(rows[1])), slice(int(columns[0]), int(columns[1]))


@dataclass(frozen=True, eq=False)
class Layer:
    """What one body puts on a part of a window: values, how much of it and its outline is there."""

    part: tuple[slice, slice]
    values: Array
    cover: Array
    outline: Array


@dataclass(frozen=True, eq=False)
class CamRaster:
    """A cam whose grid (2, stations, layers) runs straight from contour to bore."""

    grid: Array
    window: Window
    stroke: float = 1.6

    def __call__(self, turn: float, values: Array) -> Layer:
        """The cam turned by `turn` rad, with values (stations, layers)."""
        angle, inside, outer, inner, steep = self._polar
        radius, direction = self._pixels
        own = (direction - turn + np.pi) % (2 * np.pi) - np.pi
        place = np.interp(own, angle, inside)
        rim, hole, lean = (_between(table, place) for table in (outer, inner, steep))
        share = np.clip((rim - radius) / (rim - hole), 0.0, 1.0)
        found = _bilinear(
            values, place, np.interp(share, self._shares, np.arange(len(self._shares)))
        )
        out, into = ((rim - radius) * lean / self.window.pixel, (radius - hole) / self.window.pixel)
        cover = np.clip(out + 0.5, 0, 1) * np.clip(into + 0.5, 0, 1)
        near = np.minimum(np.abs(out), np.abs(into))
        outline = np.clip(0.5 * self.stroke + 0.5 - near, 0.0, 1.0)
        return Layer(self._part, found, cover, outline)

    @cached_property
    def _part(self) -> tuple[slice, slice]:
        reach = np.full(2, float(np.hypot(*self.grid[:, :, 0]).max()) + self.window.pixel)
        return self.window.part(-reach, reach)

    @cached_property
    def _pixels(self) -> tuple[Array, Array]:
        x, y = self.window.points[:, *self._part]
        return np.hypot(x, y), np.arctan2(y, x)

    @cached_property
    def _shares(self) -> Array:
        """Share of the way from contour to bore (layers,), the same at every station."""
        radius = np.hypot(*self.grid[:, 0])
        return (radius[0] - radius) / (radius[0] - radius[-1])

    @cached_property
    def _polar(self) -> tuple[Array, Array, Array, Array, Array]:
        """Directions in order with their stations; by station both radii and the lean's cosine.

        The first direction comes again at the end, one turn on, and the last at the start.
        """
        x, y = self.grid[:, :, 0]
        outer, inner = np.hypot(x, y), np.hypot(*self.grid[:, :, -1])
        direction = np.arctan2(y, x)
        order = np.argsort(direction)
        turned = np.unwrap(direction)
        slope = np.gradient(np.r_[outer[-1], outer, outer[0]])[1:-1]
        step = np.gradient(np.r_[2 * turned[0] - turned[1], turned, 2 * turned[-1] - turned[-2]])
        lean = outer / np.hypot(outer, slope / step[1:-1])
        station = np.unwrap(order.astype(float), period=order.size)
        whole = np.copysign(order.size, station[-1] - station[0])
        around = np.r_[direction[order[-1]] - 2 * np.pi, direction[order],
                       direction[order[0]] + 2 * np.pi]  # fmt: skip
        place = np.r_[station[-1] - whole, station, station[0] + whole]
        return around, place, outer, inner, lean


@dataclass(frozen=True, eq=False)
class BodyRaster:
    """A body on a mesh: points (2, n) mm in its own frame, triangles (3 or 6, m)."""

    points: Array
    triangles: Pixels
    window: Window

    def __call__(self, origin: Array, turn: float, values: Array) -> Layer:
        """The body with its frame's origin (2,) mm there, turned by `turn` rad."""
        own = (self._weights @ values).reshape(_OWN, _OWN)
        low, step = self._frame
        reach = 0.75 * _OWN * step
        part = self.window.part(origin - reach, origin + reach)
        x, y = self.window.points[:, *part] - origin[:, None, None]
        cosine, sine = np.cos(turn), np.sin(turn)
        column = (cosine * x + sine * y - low[0]) / step
        row = (cosine * y - sine * x - low[1]) / step
        inside = (column > 0) & (column < _OWN - 1) & (row > 0) & (row < _OWN - 1)
        layers = []
        for image in (own, self._mask):
            there = np.zeros(x.shape)
            there[inside] = _patch(image, row[inside], column[inside])
            layers.append(there)
        cover = layers[1]
        values = layers[0] / np.maximum(cover, 1e-9)
        return Layer(part, values, cover, 4 * cover * (1 - cover))

    @cached_property
    def _frame(self) -> tuple[Array, float]:
        low, high = self.points.min(axis=1), self.points.max(axis=1)
        size = 1.06 * float((high - low).max())
        return (low + high - size) / 2, size / (_OWN - 1)

    @cached_property
    def _grid(self) -> Array:
        low, step = self._frame
        along = np.arange(_OWN) * step
        y, x = np.meshgrid(low[1] + along, low[0] + along, indexing="ij")
        return np.stack([x.ravel(), y.ravel()])

    @cached_property
    def _weights(self) -> sparse.csr_array:
        return interpolation(self.points, self._grid)

    @cached_property
    def _mask(self) -> Array:
        """One inside of the body, softened over a sample or two as its edge on the screen is."""
        hole = np.hypot(*self.points).min()
        inside = np.asarray(self._weights.sum(axis=1)).ravel() > 0.5
        if hole > 0.05 * np.hypot(*self.points).max():
            inside &= np.hypot(*self._grid) >= hole
        sharp = inside.reshape(_OWN, _OWN).astype(float)
        padded = np.pad(sharp, 1)
        rows = padded[:-2] + 2 * padded[1:-1] + padded[2:]
        return np.asarray((rows[:, :-2] + 2 * rows[:, 1:-1] + rows[:, 2:]) / 16)


def interpolation(nodes: Array, points: Array) -> sparse.csr_array:
    """What takes values at nodes (2, n) to points (2, m) by straight lines; nothing outside."""
    mesh = Delaunay(nodes.T)
    simplex = mesh.find_simplex(points.T)
    inside = np.flatnonzero(simplex >= 0)
    frame = mesh.transform[simplex[inside]]
    part = np.einsum("mij,mj->mi", frame[:, :2], points.T[inside] - frame[:, 2])
    weights = np.column_stack([part, 1 - part.sum(axis=1)])
    entries: Any = (
        weights.ravel(),
        (np.repeat(inside, 3), mesh.simplices[simplex[inside]].ravel()),
    )
    return sparse.coo_array(entries, shape=(points.shape[1], nodes.shape[1])).tocsr()


def painted(picture: Pixels, colour: Array, share: Array) -> None:
    """Lay a colour (3,) or (rows, columns, 3), 0 to 255, over a picture by its share (0 to 1)."""
    picture += share[..., None] * (colour - picture)


def paint_box(
    picture: Pixels,
    window: Window,
    low: tuple[float, float],
    high: tuple[float, float],
    colour: Array,
) -> None:
    """Fill a box between two corners, mm."""
    rows, columns = window.part(np.array(low), np.array(high))
    covers = [
        np.clip((at - a) / window.pixel + 0.5, 0, 1) * np.clip((b - at) / window.pixel + 0.5, 0, 1)
        for at, a, b in (
            (window.upwards[rows], low[1], high[1]), (window.across[columns], low[0], high[0])
        )
    ]  # fmt: skip
    painted(picture[rows, columns], colour, np.outer(*covers))


def paint_disc(
    picture: Pixels, window: Window, centre: Array, radius: float, colour: Array
) -> None:
    """Fill a disc; mm."""
    part = window.part(centre - radius, centre + radius)
    x, y = window.points[:, *part] - centre[:, None, None]
    share = np.clip((radius - np.hypot(x, y)) / window.pixel + 0.5, 0, 1)
    painted(picture[part], colour, share)


def _between(table: Array, place: Array) -> Array:
    """Values of a table by station, straight between stations, the last joining the first."""
    first = np.floor(place).astype(np.int64)
    share = place - first
    count = len(table)
    return np.asarray((1 - share) * table[first % count] + share * table[(first + 1) % count])


def _bilinear(values: Array, place: Array, layer: Array) -> Array:
    stations, layers = values.shape
    first = np.floor(place).astype(np.int64)
    upper = np.minimum(layer.astype(np.int64), layers - 2)
    along, down = place - first, layer - upper
    flat = values.ravel()
    start, end = (first % stations) * layers + upper, ((first + 1) % stations) * layers + upper
    return np.asarray(
        (1 - along) * ((1 - down) * flat[start] + down * flat[start + 1])
        + along * ((1 - down) * flat[end] + down * flat[end + 1])
    )


def _patch(image: Array, row: Array, column: Array) -> Array:
    r, c = row.astype(np.int64), column.astype(np.int64)
    down, along = row - r, column - c
    return np.asarray(
        (1 - down) * ((1 - along) * image[r, c] + along * image[r, c + 1])
        + down * ((1 - along) * image[r + 1, c] + along * image[r + 1, c + 1])
    )
