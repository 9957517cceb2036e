"""Compliance of pressure cells on half-spaces, with a mirrored load at each free end.

A half-space of infinite length carries the end of a body as if material followed: the end is too
stiff. A mirrored pressure beyond the end, times a factor, restores the compliance of the free face.
The factor of a quarter-space depends on the ratio of the distances of load and displacement from
the end; the remainder, of the other end, is smooth.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, sealed
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells

# Distance of two cells over their size beyond which an expansion is used: there the closed form
# loses digits.
_FAR_CELL = 20.0
# Distance from an end over the greatest half-width of the cells from which images are far.
_FAR_IMAGE = 3.0
# Difference of symmetric edges from their mirror over the length of the body.
_SYMMETRIC = 1e-12
# One and the mirror factor, times 1 - nu^2: constant, over nu, over the likeness of the distances
# from the end. Fitted to the finite elements of this package, at nu = 0.05 to 0.45 within 0.3 %.
_MIRROR, _MIRROR_POISSON, _MIRROR_LIKE = 2.07, 0.667, 0.314
# Remainder over half the length, of a body as deep as long: squares, product times squares.
_SQUARES, _ODD = -0.145, 0.21
_TINY = np.finfo(float).tiny  # of a logarithm whose factor is zero


def mirror_factor(poisson: float, likeness: ArrayLike = 1.0) -> Array:
    """Factor (...) on the mirrored pressure at a free end.

    Parameters
    ----------
    likeness : array (...)   4 d1 d2/(d1 + d2)^2 of the distances d1 and d2 of load and displacement

    References
    ----------
    Guilbault, J. Tribol. 133 (2011) 031404, has one factor: verify. A quarter-space has no length
    scale, so that its factor depends on ratios of lengths alone.
    """
    whole = _MIRROR + _MIRROR_POISSON * poisson + _MIRROR_LIKE * np.asarray(likeness, dtype=float)
    return np.asarray(whole / (1.0 - poisson**2) - 1.0)


def half_space_compliance(cells: PressureCells, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    """Cell displacements of both bodies, integrated, per pressure on each cell (n, n), m3/Pa.

    Symmetric; of the half x > 0 under pressures symmetric about x = 0.
    """
    softness = [1.0 / (np.pi * body.material.plane_strain_modulus) for body in bodies]
    pairs = sum(softness) * _between_cells(cells.x.tobytes(), cells.y.tobytes())
    free: dict[tuple[float, float], float] = {}  # softness of the bodies with the same ends
    for body, soft in zip(bodies, softness, strict=True):
        if np.isfinite(body.length):
            key = body.length, body.material.poisson
            free[key] = free.get(key, 0.0) + soft
    if free:
        _add_free_ends(pairs, cells, free)
    m, k = cells.shape
    return np.asarray(pairs.transpose(0, 2, 1, 3).reshape(m * k, m * k))


class _Image(NamedTuple):
    """Influence of the loads mirrored at one end.

    Parameters
    ----------
    mean : array (m, m)         of distant cells along the line, over the areas of both, 1/m; 0 of
                                the near
    across_d2 : array (m, m)    half the second derivative of mean across the line, 1/m3: factor of
                                the second moments of the cells across
    first : int                 number of the first cell along the line that is near the end
    near : array (n, n, k, k)   influence of the n cells near it, m3
    """

    mean: Array
    across_d2: Array
    first: int
    near: Array

    @property
    def mirrored(self) -> _Image:
        """That of the other end of symmetric cells."""
        first = len(self.mean) - self.first - len(self.near)
        return _Image(
            self.mean[::-1, ::-1], self.across_d2[::-1, ::-1], first, self.near[::-1, ::-1]
        )


def _add_free_ends(
    pairs: Array, cells: PressureCells, free: Mapping[tuple[float, float], float]
) -> None:
    """Add what the free ends of the bodies yield more than half-spaces, to displacements over
    pressures of pairs of cells `pairs` (m, m, k, k), in place.

    free: softness, 1/Pa, of each body by its length, m, and Poisson's ratio; axes of `pairs` as
    those of `influence`. Loads mirrored at both ends, and a smooth rest in powers of the place.
    """
    m, k = cells.shape
    place, mean, across_d2 = cells.centres_along, np.zeros((m, m)), np.zeros((m, m))
    for (length, poisson), soft in free.items():
        half, end = 0.5 * length, _image(cells, length, poisson)
        is_even = np.allclose(cells.y, -cells.y[::-1], rtol=0.0, atol=_SYMMETRIC * length)
        other = end.mirrored if is_even else _image(cells, -length, poisson)
        at = place / half
        smooth = (_SQUARES + _ODD * np.outer(at, at)) * np.add.outer(at**2, at**2) * (2.0 / half)
        mean += soft * (end.mean + other.mean + smooth)
        across_d2 += soft * (end.across_d2 + other.across_d2)
        for each in (end, other):
            near = slice(each.first, each.first + len(each.near))
            pairs[near, near] += soft * each.near
    x_squares = 0.25 * (cells.x[1:] + cells.x[:-1]) ** 2 + np.diff(cells.x) ** 2 / 12.0
    along, across = (np.outer(size, size) for size in (np.diff(cells.y), np.diff(cells.x)))
    by_length = np.stack([mean * along, across_d2 * along])
    by_width = np.stack([across, np.add.outer(x_squares, x_squares) * across])
    pairs += (by_length.reshape(2, -1).T @ by_width.reshape(2, -1)).reshape(m, m, k, k)


def _image(cells: PressureCells, shift: float, poisson: float) -> _Image:
    """Influence of the loads mirrored at one end of a body, times the factor of Poisson's ratio
    that frees this end of stress: integral of 1/r over displaced and mirrored loaded cell, m3.

    Distant loads by their mean and second moments over the cells, near ones exactly.

    Parameters
    ----------
    shift : float     twice the axial coordinate y of the end, m
    poisson : float   Poisson's ratio of the body
    """
    along = cells.centres_along
    # Cells of a rounded end may reach beyond the end of the other body.
    apart = np.abs(0.5 * shift) - np.sign(shift) * along
    apart = np.maximum(apart, 0.5 * np.diff(cells.y))
    factor = mirror_factor(poisson, 4.0 * np.outer(apart, apart) / np.add.outer(apart, apart) ** 2)
    distance, y_squares = np.abs(np.add.outer(along, along) - shift), np.diff(cells.y) ** 2 / 12.0
    mean = 2.0 / distance + 2.0 * np.add.outer(y_squares, y_squares) / distance**3
    across_d2 = -1.0 / distance**3
    beside = np.flatnonzero(apart < _FAR_IMAGE * cells.x[-1])
    if not beside.size:
        width = cells.x.size - 1
        return _Image(mean * factor, across_d2 * factor, 0, np.zeros((0, 0, width, width)))
    near = np.s_[beside[0] : beside[-1] + 1]
    block = PressureCells(cells.x, cells.y[beside[0] : beside[-1] + 2])
    mean[near, near] = across_d2[near, near] = 0.0
    values = influence(block, shift, mirrored=True) * factor[near, near, None, None]
    return _Image(mean * factor, across_d2 * factor, int(beside[0]), values)


def shared_compliance(cells: PressureCells, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    """As `half_space_compliance`, cached for the last few cells and bodies."""
    return _of_edges(cells.x.tobytes(), cells.y.tobytes(), bodies)


@lru_cache(maxsize=16)
def _of_edges(x: bytes, y: bytes, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    return half_space_compliance(PressureCells(np.frombuffer(x), np.frombuffer(y)), bodies)


@lru_cache(maxsize=16)
def _between_cells(x: bytes, y: bytes) -> Array:
    """Influence of cells on half-spaces without ends, kept for bodies of other lengths."""
    cells = PressureCells(np.frombuffer(x), np.frombuffer(y))
    return sealed(influence(cells, 0.0, mirrored=False))


def influence(cells: PressureCells, shift: float, *, mirrored: bool) -> Array:
    """Influence matrix: integral of 1/r over each cell and each loaded cell, m3.

    (m, m, k, k): displaced and loaded cell along the line, displaced and loaded cell across. The
    loads of x < 0 are included.

    Parameters
    ----------
    shift : float     of the loads along y, m
    mirrored : bool   whether the loads are mirrored at y = 0 before the shift
    """
    along = _Pairs(cells.y, -1.0 if mirrored else 1.0, shift)
    right, left = (_Pairs(cells.x, sign) for sign in (1.0, -1.0))
    values = _double_integral(right, along) + _double_integral(left, along)
    across, lengthwise = (_places(edges.size - 1) for edges in (cells.x, cells.y))
    # Whole blocks across are gathered for each pair along the line.
    blocks = np.ascontiguousarray(values.T[:, across])
    return np.asarray(blocks[lengthwise])


@lru_cache(maxsize=64)
def _rising(count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """First and second numbers (p,) of the pairs in rising order."""
    first, second = np.triu_indices(count)
    return sealed(first), sealed(second)


@lru_cache(maxsize=64)
def _places(count: int) -> NDArray[np.intp]:
    """Indices (count, count) of all pairs of numbers, in any order, among the pairs in rising
    order.
    """
    first, second = _rising(count)
    places = np.empty((count, count), dtype=np.intp)
    places[first, second] = places[second, first] = np.arange(first.size)
    return sealed(places)


class _Pairs:
    """Pairs of cells along one axis, p of them: the first at x, the second at sign x + shift.

    Two cells that change places have the same distance, so that the pairs whose first is not behind
    the second are enough.

    Attributes: edges (e,), m, distances of the edges of both cells, each once; centres (p,), m,
    those of the middles, signed; squares (p,), m2, sum of h^2/12 of both cells of length h; areas
    (p,), m2, products of the lengths.
    """

    def __init__(self, edges: Array, sign: float, shift: float = 0.0) -> None:
        """From the edges of the cells, rising, (cells + 1,), m.

        Parameters
        ----------
        sign : float    1: the second cell is where it is; -1: it is a mirror image
        shift : float   of an image, m: twice the coordinate of its mirror
        """
        first, second = _rising(edges.size)
        apart = np.abs(edges[first] - sign * edges[second] - shift)
        self.edges, among = np.unique(apart, return_inverse=True)
        self._sign = sign
        self._corners = among[_places(edges.size)]
        self._cells = first, second = _rising(edges.size - 1)
        steps, centres = np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
        self.centres = centres[first] - sign * centres[second] - shift
        self.squares = (steps[first] ** 2 + steps[second] ** 2) / 12.0
        self.areas = steps[first] * steps[second]

    def integrated(self, primitive: Array) -> Array:
        """Integrals (p, ...) over both cells of each pair, from the twofold primitive (e, ...) at
        the distances of the edges.
        """
        i, j = self._cells
        corner = self._corners
        rising = primitive[corner[i + 1, j + 1]] - primitive[corner[i, j + 1]]
        falling = primitive[corner[i + 1, j]] - primitive[corner[i, j]]
        return np.asarray(-self._sign * (rising - falling))


def _double_integral(across: _Pairs, along: _Pairs) -> Array:
    """Integrals of 1/r over both cells of each pair, m3: exact when near, by mean and second
    moments when far apart.

    Parameters
    ----------
    across, along : _Pairs   p pairs of cells in x, and q pairs in y

    Returns
    -------
    array (p, q)   by pair in x and pair in y
    """
    primitive = _fourth_primitive(across.edges[:, None], along.edges)
    values = along.integrated(across.integrated(primitive).T).T
    square = across.centres[:, None] ** 2 + along.centres**2
    size = np.maximum(across.squares[:, None], along.squares)
    i, j = np.nonzero(square > _FAR_CELL**2 * 12.0 * size)
    x_squares, y_squares, r2 = across.squares[i], along.squares[j], square[i, j]
    spread = x_squares * (3.0 * across.centres[i] ** 2 - r2)
    spread += y_squares * (3.0 * along.centres[j] ** 2 - r2)
    areas = across.areas[i] * along.areas[j]
    values[i, j] = areas / np.sqrt(r2) * (1.0 + 0.5 * spread / r2**2)
    return values


def _fourth_primitive(x: Array, y: Array) -> Array:
    """Primitive of 1/r, twice in x and twice in y, m3, for x and y >= 0."""
    # arsinh(y/x) = ln(y + r) - ln(x), to the round-off of r^3; the logarithms are vectorised.
    r = np.sqrt(x * x + y * y)
    logs = [np.log(np.where(each == 0, 1.0, each)) for each in (x, y)]
    first = x * x * y * (np.log(np.maximum(y + r, _TINY)) - logs[0])
    second = x * y * y * (np.log(np.maximum(x + r, _TINY)) - logs[1])
    return np.asarray(0.5 * (first + second) - r * r * r / 6.0)
