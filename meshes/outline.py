"""Outlines of bodies, and the element edges along them.

The nodes lie on the curve itself, not on a CAD spline, spaced by arc length according to the size
field; the facets in the contact are equal.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import MeshError
from camwright.meshes.element_size import SizeField

_SIZE_SAMPLES = 4001  # of the size along a piece of outline, besides those clustered at its ends

_CROSSING_BLOCK = 256  # segments compared with all others at once


@dataclass(frozen=True, eq=False)
class Zone:
    """Equal facets about the arc length `centre`, m: `steps` of length `step`, m, on each side."""

    centre: float
    step: float
    steps: int


@dataclass(frozen=True, eq=False)
class OutlinePiece:
    """Named piece of outline, the body on its left.

    `at` maps arc length (n,), 0..`length`, m, to points (2, n), m. A `closed` piece is a loop of
    its own, and its `at` is periodic.
    """

    name: str
    at: Callable[[Array], Array]
    length: float
    zone: Zone | None = None
    closed: bool = False


@dataclass(frozen=True, eq=False)
class Facets:
    """Element edges along a piece: ends (2, k + 1) and middles (2, k) on the curve, m."""

    name: str
    ends: Array
    middles: Array

    def __post_init__(self) -> None:
        freeze(self, ends=self.ends, middles=self.middles)


def facets(piece: OutlinePiece, size: SizeField) -> Facets:
    """Element edges along a piece of an outline: equal in its contact zone, graded to the local
    element size outside it.

    A closed piece starts at the zone; on an open one the zone ends at the ends of the piece.

    Parameters
    ----------
    piece : OutlinePiece   curve by its arc length, m
    size : SizeField       element size, m, by place

    Returns
    -------
    Facets   end points (2, n + 1) and midpoints (2, n) of the edges, m

    Raises
    ------
    MeshError
        If the contact zone is longer than 0.9 of the piece.
    """
    at, zone, length = piece.at, piece.zone, piece.length
    if zone is None:
        ends = _graded(at, 0.0, length, size)
    elif 2 * zone.steps * zone.step > 0.9 * length:
        raise MeshError(
            f"contact zone on '{piece.name}' = {2 * zone.steps * zone.step:.3g} m, "
            f"must be <= 0.9 of its length {length:.3g} m"
        )
    elif piece.closed:
        first = zone.centre - zone.steps * zone.step
        equal = first + zone.step * np.arange(2 * zone.steps + 1)
        ends = np.r_[equal[:-1], _graded(at, equal[-1], first + length, size)]
    else:
        before = min(zone.steps, int(zone.centre / zone.step + 1e-9))
        after = min(zone.steps, int((length - zone.centre) / zone.step + 1e-9))
        equal = zone.centre + zone.step * np.arange(-before, after + 1)
        ends = np.r_[
            _graded(at, 0.0, equal[0], size)[:-1], equal, _graded(at, equal[-1], length, size)[1:]
        ]
    points = at(ends)
    if piece.closed:
        points[:, -1] = points[:, 0]
    return Facets(piece.name, points, at(0.5 * (ends[1:] + ends[:-1])))


def _graded(at: Callable[[Array], Array], start: float, stop: float, size: SizeField) -> Array:
    """Arc lengths from `start` to `stop`, m, spaced by the local element size, both ends included;
    only `stop` where the span is at most 1e-3 of the element size. `at`: points (2, n), m, by arc
    length.
    """
    span = stop - start
    if not span > 1e-3 * float(size(at(np.array([start])))[0]):
        return np.array([stop])
    # samples clustered at the ends, where the size is smallest, next to the contact
    near = np.geomspace(1e-8, 0.5, 1500)
    u = np.unique(np.r_[np.linspace(0.0, 1.0, _SIZE_SAMPLES), near, 1.0 - near])
    density = span / size(at(start + span * u))
    count = np.r_[0.0, np.cumsum(np.diff(u) * 0.5 * (density[1:] + density[:-1]))]
    edges = max(1, int(np.ceil(count[-1] - 1e-6)))
    return start + span * np.interp(np.linspace(0.0, count[-1], edges + 1), count, u)


def crossing(starts: Array, ends: Array) -> Array | None:
    """Point (2,) near a crossing of segments `starts` to `ends`, each (2, n); None without one.

    Segments that share an end do not cross.
    """
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    for first in range(0, starts.shape[1], _CROSSING_BLOCK):
        rows = slice(first, first + _CROSSING_BLOCK)
        boxes_meet = (low[:, rows, None] < high[:, None, first:]).all(axis=0) & (
            high[:, rows, None] > low[:, None, first:]
        ).all(axis=0)
        i, j = np.nonzero(np.triu(boxes_meet, k=1))
        a, b, c, d = (
            starts[:, i + first],
            ends[:, i + first],
            starts[:, j + first],
            ends[:, j + first],
        )
        cross = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
        if cross.any():
            return 0.5 * (a[:, cross] + b[:, cross])[:, 0]
    return None


def _side(a: Array, b: Array, p: Array) -> Array:
    """Positive where `p` is on the left of the line from `a` to `b`."""
    return np.sign((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]))


def line(name: str, start: Array, stop: Array, zone: Zone | None = None) -> OutlinePiece:
    """Straight outline piece from `start` to `stop`, (2,), m."""
    length = float(np.hypot(*(stop - start)))
    along = (stop - start) / length
    return OutlinePiece(name, lambda s: start[:, None] + along[:, None] * s, length, zone)


def arc(
    name: str,
    radius: float,
    start: float,
    stop: float,
    centre: tuple[float, float] = (0.0, 0.0),
    zone: Zone | None = None,
) -> OutlinePiece:
    """Circular outline piece of a radius, m, about `centre`, m, between two angles, rad; clockwise
    if `stop` < `start`. `zone`: of equal facets.
    """
    sense = 1.0 if stop > start else -1.0

    def at(s: Array) -> Array:
        angle = start + sense * s / radius
        return np.array([centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)])

    turn = abs(stop - start)
    return OutlinePiece(name, at, radius * turn, zone, closed=bool(np.isclose(turn, 2 * np.pi)))
