"""Compliance of pressure cells on half-spaces, with a mirrored load at each free end.

A half-space of infinite length carries the end of a body as if material followed: the end is too
stiff. A mirrored pressure beyond the end, times a factor, restores the compliance of the free face.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

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
    loaded = shift + (-cells.y if mirrored else cells.y)
    right = _double_integral(cells, cells.x, loaded)
    left = _double_integral(cells, -cells.x, loaded)
    count = cells.areas.size
    return np.asarray((right + left).transpose(2, 0, 3, 1).reshape(count, count))


def _double_integral(cells: PressureCells, across: Array, along: Array) -> Array:
    """Integral of 1/r over cells (x, y) and loaded cells (x, y): (k, k, m, m), m3.

    Loaded cells by their edges in the order of the cells, falling where they are mirrored.
    Axes: x of cell and of load, y of cell and of load.
    """
    x, y = np.subtract.outer(cells.x, across), np.subtract.outer(cells.y, along)
    values = _fourth_primitive(x[:, :, None, None], y)
    for axis in range(4):
        values = np.diff(values, axis=axis)
    turned = (-1.0 if across[-1] < across[0] else 1.0) * (-1.0 if along[-1] < along[0] else 1.0)
    return _far_field_replaced(turned * values, cells, across, along)


def _fourth_primitive(x: Array, y: Array) -> Array:
    """Primitive of 1/r, twice in x and twice in y, m3."""
    r = np.hypot(x, y)
    with np.errstate(divide="ignore", invalid="ignore"):
        first = np.where(x == 0, 0.0, 0.5 * x**2 * y * np.arcsinh(y / np.abs(x)))
        second = np.where(y == 0, 0.0, 0.5 * x * y**2 * np.arcsinh(x / np.abs(y)))
    return np.asarray(first + second - r**3 / 6.0)


def _far_field_replaced(near: Array, cells: PressureCells, across: Array, along: Array) -> Array:
    """Integrals with those of distant cells by the second moments of both cells."""
    (x, across_squares, across_areas), (y, along_squares, along_areas) = (
        _pairs(cells.x, across), _pairs(cells.y, along)
    )  # fmt: skip
    x, across_squares = x[:, :, None, None], across_squares[:, :, None, None]
    square = x**2 + y**2
    is_far = square > _FAR**2 * 12.0 * np.maximum(across_squares, along_squares)
    r2 = np.where(is_far, square, 1.0)
    bend = across_squares * (3.0 * x**2 - r2) + along_squares * (3.0 * y**2 - r2)
    area = across_areas[:, :, None, None] * along_areas
    far = area / np.sqrt(r2) * (1.0 + 0.5 * bend / r2**2)
    return np.asarray(np.where(is_far, far, near))


def _pairs(edges: Array, loaded: Array) -> tuple[Array, Array, Array]:
    """Distances of centres (m), second moments over length (m2), products of lengths (m2)."""
    steps, loads = np.diff(edges), np.abs(np.diff(loaded))
    centres, sources = edges[:-1] + 0.5 * steps, 0.5 * (loaded[1:] + loaded[:-1])
    squares = np.add.outer(steps**2, loads**2) / 12.0
    return np.subtract.outer(centres, sources), squares, np.multiply.outer(steps, loads)
