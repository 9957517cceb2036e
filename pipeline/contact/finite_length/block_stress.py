"""Displacement and stress of an elastic block under known contact pressures, at element corners."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.elasticity import elastic_body
from camwright.pipeline.contact.elasticity.elastic_body import lame_parameters
from camwright.pipeline.contact.finite_length import brick_body
from camwright.pipeline.contact.finite_length.axial_drop import FiniteBody
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid
from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.length_tiers import block_grid

_SHEARS = ((0, 1), (1, 2), (0, 2))  # XY, YZ, XZ


@dataclass(frozen=True, eq=False)
class BlockField:
    """Displacement and stress of the half x >= 0 of a block; z from its top into the depth.

    points (n, 3), m; cells (m, 8) of points, in the order of VTK; displacement (n, 3), m; stress
    (n, 6), Pa, XX, YY, ZZ, XY, YZ, XZ, of the elements at a corner their mean; pressure (m,), Pa,
    of the contact on a cell, 0 off it.
    """

    points: Array
    cells: NDArray[np.int64]
    displacement: Array
    stress: Array
    pressure: Array

    def __post_init__(self) -> None:
        freeze(self, points=self.points, displacement=self.displacement)
        freeze(self, stress=self.stress, pressure=self.pressure)

    @property
    def von_mises(self) -> Array:
        """Von Mises stress (n,), Pa."""
        xx, yy, zz, xy, yz, xz = self.stress.T
        normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
        return np.asarray(np.sqrt(0.5 * normal + 3.0 * (xy**2 + yz**2 + xz**2)))


def block_field(body: FiniteBody, contact: LengthContact) -> BlockField:
    """Fields of a block, its base held, under the pressure of a contact, the first of `contact`, by
    quadratic bricks.
    """
    grid, material = block_grid(contact.cells, body), body.material
    pressure = contact.pressure[0]
    middle = len(pressure) // 2
    right, left = pressure[middle:], pressure[middle - 1 :: -1]
    halves = np.stack([0.5 * (right + left), 0.5 * (right - left)])
    parts = _displacement(grid, material.poisson, halves) / material.modulus
    mirrored = parts[:, :, ::-1].copy()
    # Symmetric fields: u_y changes its sign; antisymmetric ones: u_x and u_z.
    mirrored[0, ..., 1] *= -1.0
    mirrored[1, ..., [0, 2]] *= -1.0
    lattice = np.concatenate([mirrored.sum(axis=0)[:, :-1], parts.sum(axis=0)], axis=1)
    axes = grid.x, np.concatenate([-grid.y[:0:-1], grid.y]), grid.z
    loads = np.zeros([axis.size - 1 for axis in axes])
    beside = grid.y.size - 1 - grid.cells[1]
    loads[: grid.cells[0], beside : beside + len(pressure), 0] = pressure.T
    stress = _corner_stress(axes, lattice, *lame_parameters(material.modulus, material.poisson))
    return BlockField(
        np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3),
        _hexahedra([axis.size for axis in axes]),
        lattice[::2, ::2, ::2].reshape(-1, 3),
        stress.reshape(-1, 6),
        loads.ravel(),
    )


def _displacement(grid: BrickGrid, poisson: float, pressure: Array) -> Array:
    """Displacement times Young's modulus (2, i, j, k, 3), m Pa, under the symmetric and the
    antisymmetric part of a pressure, read from the disk cache or computed; see
    `brick_body.displacement`.

    Parameters
    ----------
    pressure : array (2, along, across)   Pa, on the cells: symmetric and antisymmetric in y
    """
    inputs = (tuple(grid.x), tuple(grid.y), tuple(grid.z), grid.cells, poisson, pressure.tobytes())

    def compute() -> dict[str, Array]:
        return {"displacement": brick_body.displacement(grid, poisson, pressure)}

    return disk_cache.kept("field", inputs, compute, (brick_body, elastic_body))["displacement"]


def _hexahedra(sizes: list[int]) -> NDArray[np.int64]:
    """Numbers of the corners (m, 8) of the bricks of a lattice of points, in the order of VTK;
    `sizes`: numbers of points along x, y and z, which runs fastest.
    """
    numbers = np.arange(np.prod(sizes)).reshape(sizes)
    low, high = slice(None, -1), slice(1, None)
    corners = [(low, low), (high, low), (high, high), (low, high)]
    return np.stack(
        [numbers[x, y, z].ravel() for z in (low, high) for x, y in corners], axis=1
    ).astype(np.int64)


def _corner_stress(
    axes: tuple[Array, Array, Array], lattice: Array, lame: float, shear: float
) -> Array:
    """Stress XX, YY, ZZ, XY, YZ, XZ (nx, ny, nz, 6), Pa, at the corners of the elements: mean of
    all elements at a corner.

    Within an element it is that of the eight points of reduced integration, extrapolated: there the
    stress of these elements is most exact (Barlow, Int. J. Numer. Meth. Eng. 10 (1976) 243).

    Parameters
    ----------
    axes : three arrays (nx,), (ny,), (nz,)             element edges, m
    lattice : array (2 nx - 1, 2 ny - 1, 2 nz - 1, 3)   displacement at half edges, m
    lame, shear : float                                 first Lame parameter and shear modulus, Pa
    """
    near, far = 0.5 - 0.5 / np.sqrt(3.0), 0.5 + 0.5 / np.sqrt(3.0)
    corners = np.array(list(product((0, 1), repeat=3)))
    places, slopes = brick_body.shape_slopes(np.where(corners == 0, near, far))
    steps = np.meshgrid(*(np.diff(axis) for axis in axes), indexing="ij")
    counts = steps[0].shape
    nodes = np.stack(
        [
            lattice[tuple(slice(p, p + 2 * n, 2) for p, n in zip(place, counts, strict=True))]
            for place in places.tolist()
        ]
    )
    inside = []
    for slope in slopes:
        # Gradient (..., a, c) of the displacement c along the axis a.
        gradient = np.einsum("an,nijkc->ijkac", slope, nodes) / np.stack(steps, axis=-1)[..., None]
        dilation = np.einsum("ijkaa->ijk", gradient)
        values = [lame * dilation + 2.0 * shear * gradient[..., a, a] for a in range(3)]
        values += [shear * (gradient[..., a, b] + gradient[..., b, a]) for a, b in _SHEARS]
        inside.append(np.stack(values, axis=-1))
    # Linear along each axis: weight of the points at the end of a corner, and at the other one.
    same, other = 0.5 * (1.0 + np.sqrt(3.0)), 0.5 * (1.0 - np.sqrt(3.0))
    total = np.zeros([*(axis.size for axis in axes), 6])
    weight = np.zeros([*total.shape[:3], 1])
    for corner in corners:
        shares = np.where(corners == corner, same, other).prod(axis=1)
        at = tuple(slice(c, c + n) for c, n in zip(corner.tolist(), counts, strict=True))
        total[at] += sum(share * each for share, each in zip(shares, inside, strict=True))
        weight[at] += 1.0
    return np.asarray(total / weight)
