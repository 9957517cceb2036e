"""Compliance of pressure cells on half-spaces, with a mirrored load at each free end.

A half-space of infinite length carries the end of a body as if material followed: the end is too
stiff. A mirrored pressure beyond the end, times a factor, restores the compliance of the free face.
The factor of a quarter-space depends on the ratio of the distances of load and displacement from
the end; the remainder, of the other end, is smooth.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells

# Distance of two cells over their size beyond which an expansion is used: there the closed form
# loses digits.
_FAR = 20.0
# Distance from an end over the greatest half-width of the cells from which images are far.
_FAR_IMAGE = 3.0
# Difference of symmetric edges from their mirror over the length of the body.
_SYMMETRIC = 1e-12
# One and the mirror factor, times 1 - nu^2: constant, over nu, over the likeness of the distances
# from the end. Fitted to the finite elements of this package, at nu = 0.05 to 0.45 within 0.3 %.
_MIRROR, _MIRROR_POISSON, _MIRROR_LIKE = 2.07, 0.667, 0.314
# Remainder over half the length, of a body as deep as long: squares, product times squares.
_SQUARES, _ODD = -0.145, 0.21


def mirror_factor(poisson: float, likeness: ArrayLike = 1.0) -> Array:
    """Factor (...) of the mirrored pressure at a free end.

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
    """Displacement integrated over each cell per pressure on each, of both bodies (n, n), m3/Pa.

    Symmetric; of the half x > 0 under pressures symmetric about x = 0.
    """
    direct = influence(cells, 0.0, mirrored=False)
    total = np.zeros_like(direct)
    ends: dict[tuple[float, float], Array] = {}
    for body in bodies:
        whole = direct
        if np.isfinite(body.length):
            key = body.length, body.material.poisson
            if key not in ends:
                ends[key] = _free_ends(cells, *key)
            whole = direct + ends[key]
        total += whole / (np.pi * body.material.plane_strain_modulus)
    return total


def _free_ends(cells: PressureCells, length: float, poisson: float) -> Array:
    """What both ends of a length add to the influence, m3."""
    half, along, count = 0.5 * length, cells.centres_along, cells.shape
    whole = _image(cells, length, poisson)
    if np.allclose(cells.y, -cells.y[::-1], rtol=0.0, atol=_SYMMETRIC * length):
        whole = whole + whole[::-1, :, ::-1]
    else:
        whole = whole + _image(cells, -length, poisson)
    place = along / half
    squares = np.add.outer(place**2, place**2)
    smooth = (_SQUARES + _ODD * np.outer(place, place)) * squares * (2.0 / half)
    areas = cells.areas.reshape(count)
    whole += np.einsum("ij,ik,jl->ikjl", smooth, areas, areas)
    return np.asarray(whole.reshape(cells.areas.size, -1))


def _image(cells: PressureCells, shift: float, poisson: float) -> Array:
    """Influence of the loads mirrored at y = shift/2, times their factor, (m, k, m, k), m3."""
    # Cells of a rounded end may reach beyond the end of the other body.
    apart = np.abs(0.5 * shift) - np.sign(shift) * cells.centres_along
    apart = np.maximum(apart, 0.5 * np.diff(cells.y))
    likeness = 4.0 * np.outer(apart, apart) / np.add.outer(apart, apart) ** 2
    near = np.flatnonzero(apart < _FAR_IMAGE * cells.x[-1])
    if near.size == apart.size:
        image = influence(cells, shift, mirrored=True).reshape(*cells.shape, *cells.shape)
    else:
        image = _far_image(cells, shift)
        if near.size:
            edges = cells.y[near[0] : near[-1] + 2]
            beside = PressureCells(cells.x, edges)
            block = influence(beside, shift, mirrored=True).reshape(*beside.shape, *beside.shape)
            image[near[0] : near[-1] + 1, :, near[0] : near[-1] + 1] = block
    return np.asarray(image * mirror_factor(poisson, likeness)[:, None, :, None])


def _far_image(cells: PressureCells, shift: float) -> Array:
    """Influence of mirrored loads whose distance is large to the width, (m, k, m, k), m3.

    By the mean and the second moments of the cells.
    """
    along, across = cells.centres_along, 0.5 * (cells.x[1:] + cells.x[:-1])
    distance = np.abs(np.add.outer(along, along) - shift)
    x_squares, y_squares = across**2 + np.diff(cells.x) ** 2 / 12.0, np.diff(cells.y) ** 2 / 12.0
    inverse = 2.0 / distance + 2.0 * np.add.outer(y_squares, y_squares) / distance**3
    bend = np.add.outer(x_squares, x_squares)[None, :, None, :] / distance[:, None, :, None] ** 3
    areas = cells.areas.reshape(cells.shape)
    return np.asarray((inverse[:, None, :, None] - bend) * areas[:, :, None, None] * areas)


def shared_compliance(cells: PressureCells, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    """As `half_space_compliance`, computed once for the last few cells and bodies."""
    return _of_edges(cells.x.tobytes(), cells.y.tobytes(), bodies)


@lru_cache(maxsize=16)
def _of_edges(x: bytes, y: bytes, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    return half_space_compliance(PressureCells(np.frombuffer(x), np.frombuffer(y)), bodies)


def influence(cells: PressureCells, shift: float, *, mirrored: bool) -> Array:
    """Integral of 1/r over each cell and each loaded cell, (n, n), m3.

    The loads of x < 0 are included.

    Parameters
    ----------
    shift : float     of the loads along y, m
    mirrored : bool   whether the loads are mirrored at y = 0 before the shift
    """
    along = _Pairs(cells.y, -1.0 if mirrored else 1.0, shift)
    right, left = (_Pairs(cells.x, sign) for sign in (1.0, -1.0))
    values = _double_integral(right, along) + _double_integral(left, along)
    (k, across), (m, lengthwise) = (_places(edges.size - 1) for edges in (cells.x, cells.y))
    full = values[np.ix_(across.ravel(), lengthwise.ravel())].reshape(k, k, m, m)
    return np.asarray(full.transpose(2, 0, 3, 1).reshape(k * m, k * m))


def _places(count: int) -> tuple[int, NDArray[np.intp]]:
    """A count, and the places (count, count) of pairs in any order among those in rising order."""
    first, second = np.triu_indices(count)
    places = np.empty((count, count), dtype=np.intp)
    places[first, second] = places[second, first] = np.arange(first.size)
    return count, places


class _Pairs:
    """Pairs of cells along one axis in rising order, the second mirrored by its sign and shifted.

    Two cells that change places have the same distance, so that half of the pairs is enough.

    Attributes: distances of the edges (e,), of the centres (p,), m; squares (p,), m2, the second
    moments of both cells over their lengths; areas (p,), m2, products of the lengths.
    """

    def __init__(self, edges: Array, sign: float, shift: float = 0.0) -> None:
        first, second = np.triu_indices(edges.size)
        self.edges = np.abs(edges[first] - sign * edges[second] - shift)
        self._sign = sign
        self._corners = _places(edges.size)[1]
        self._cells = first, second = np.triu_indices(edges.size - 1)
        steps, centres = np.diff(edges), 0.5 * (edges[1:] + edges[:-1])
        self.centres = centres[first] - sign * centres[second] - shift
        self.squares = (steps[first] ** 2 + steps[second] ** 2) / 12.0
        self.areas = steps[first] * steps[second]

    def integrated(self, primitive: Array) -> Array:
        """Integrals (p, ...) over both cells from a primitive (e, ...) taken twice."""
        i, j = self._cells
        corner = self._corners
        rising = primitive[corner[i + 1, j + 1]] - primitive[corner[i, j + 1]]
        falling = primitive[corner[i + 1, j]] - primitive[corner[i, j]]
        return np.asarray(-self._sign * (rising - falling))


def _double_integral(across: _Pairs, along: _Pairs) -> Array:
    """Integral of 1/r over pairs of cells, (p across, p along), m3."""
    primitive = _fourth_primitive(across.edges[:, None], along.edges)
    near = along.integrated(across.integrated(primitive).T).T
    x, y = across.centres[:, None], along.centres
    x_squares, y_squares = across.squares[:, None], along.squares
    square = x**2 + y**2
    is_far = square > _FAR**2 * 12.0 * np.maximum(x_squares, y_squares)
    r2 = np.where(is_far, square, 1.0)
    bend = x_squares * (3.0 * x**2 - r2) + y_squares * (3.0 * y**2 - r2)
    far = across.areas[:, None] * along.areas / np.sqrt(r2) * (1.0 + 0.5 * bend / r2**2)
    return np.asarray(np.where(is_far, far, near))


def _fourth_primitive(x: Array, y: Array) -> Array:
    """Primitive of 1/r, twice in x and twice in y, m3, for x and y >= 0."""
    r = np.hypot(x, y)
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.where(x == 0, 0.0, 0.5 * x**2 * y * np.arcsinh(y / x))
        second = np.where(y == 0, 0.0, 0.5 * x * y**2 * np.arcsinh(x / y))
    return np.asarray(first + second - r**3 / 6.0)
