"""Compliance of pressure cells on half-spaces, with a mirrored load at each free end.

A half-space of infinite length carries the end of a body as if material followed: the end is too
stiff. A mirrored pressure beyond the end, times a factor, restores the compliance of the free face.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells

# Distance of two cells over their size beyond which an expansion is used: there the closed form
# loses digits.
_FAR = 20.0
# Mirror factor less that of Guilbault, by the finite elements of this package at nu = 0.3.
_MIRROR_EXCESS = 0.12


def mirror_factor(poisson: float) -> float:
    """Factor of the mirrored pressure at a free end.

    References
    ----------
    Guilbault, J. Tribol. 133 (2011) 031404: 1.29 - (0.08 - 0.5 nu)/(1 - nu), verify; raised by
    0.12 to the axial pressure of the finite elements here.
    """
    return 1.29 - (0.08 - 0.5 * poisson) / (1.0 - poisson) + _MIRROR_EXCESS


def half_space_compliance(cells: PressureCells, bodies: tuple[FiniteBody, FiniteBody]) -> Array:
    """Displacement integrated over each cell per pressure on each, of both bodies (n, n), m3/Pa.

    Symmetric; of the half x > 0 under pressures symmetric about x = 0.
    """
    direct = influence(cells, 0.0, mirrored=False)
    total = np.zeros_like(direct)
    mirrored: dict[float, Array] = {}
    for body in bodies:
        whole = direct
        if np.isfinite(body.length):
            if body.length not in mirrored:
                mirrored[body.length] = _both_images(cells, body.length)
            whole = direct + mirror_factor(body.material.poisson) * mirrored[body.length]
        total += whole / (np.pi * body.material.plane_strain_modulus)
    return total


def _both_images(cells: PressureCells, length: float) -> Array:
    """Influence of the loads mirrored at both ends of a length, m; cells symmetric in y."""
    image = influence(cells, length, mirrored=True)
    count = cells.shape
    other = image.reshape(*count, *count)[::-1, :, ::-1].reshape(image.shape)
    return np.asarray(image + other)


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
