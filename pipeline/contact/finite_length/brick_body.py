"""Compliance of pressure cells on an elastic block by finite elements.

Hexahedra of 20 nodes on a tensor grid, the base held, constant pressure on the cells of the top.
A quarter is modelled: loads are symmetric in x, and in y symmetric or antisymmetric. The nodes are
eliminated plane by plane from the free end towards the middle; both symmetries differ in the last
plane alone. The compliance is the product of the forward substitution with itself, so that neither
the stiffness nor its factors are kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.contact.elasticity.elastic_body import lame_parameters

Index = NDArray[np.intp]

_NODES = 20
# The 27 Gauss points of the element integrate its stiffness exactly.
_ORDER = 5


@dataclass(frozen=True, eq=False)
class BrickGrid:
    """Edges of the elements of a quarter block, m: x, y from its middle, z from the top, from 0.

    The pressure cells are the first `cells` = (across, along) elements of the top.
    """

    x: Array
    y: Array
    z: Array
    cells: tuple[int, int]

    def __post_init__(self) -> None:
        freeze(self, x=self.x, y=self.y, z=self.z)
        for name in ("x", "y", "z"):
            edges = getattr(self, name)
            if edges.ndim != 1 or edges.size < 2 or edges[0] != 0 or not (np.diff(edges) > 0).all():
                raise InputError(f"grid.{name}", edges.size, "two or more edges ascending from 0")
        if not (1 <= self.cells[0] < self.x.size and 1 <= self.cells[1] < self.y.size):
            raise InputError("grid.cells", str(self.cells), "within the top of the block")

    @property
    def unknowns(self) -> int:
        """Unknowns of the quarter without its supports."""
        section, count = _Section(self), self.y.size
        return 3 * (section.planar * count + section.between * (count - 1))


@dataclass(frozen=True, eq=False)
class QuarterCompliance:
    """Displacement integrated over each cell per pressure on each and on its images, (n, n), m3.

    Times Young's modulus; of pressures symmetric and antisymmetric in y. Cells run in x first.
    """

    symmetric: Array
    antisymmetric: Array

    def __post_init__(self) -> None:
        freeze(self, symmetric=self.symmetric, antisymmetric=self.antisymmetric)

    def both_sides(self, across: int) -> Array:
        """Compliance (2n, 2n) of the cells of y < 0 and y > 0, y ascending, `across` cells in x."""
        count = len(self.symmetric)
        same = 0.5 * (self.symmetric + self.antisymmetric)
        other = 0.5 * (self.symmetric - self.antisymmetric)
        mirrored = np.arange(count).reshape(-1, across)[::-1].ravel()
        return np.block(
            [
                [same[np.ix_(mirrored, mirrored)], other[mirrored]],
                [other[:, mirrored], same],
            ]
        )


def condensed(grid: BrickGrid, poisson: float, *, free_ends: bool = True) -> QuarterCompliance:
    """Compliance of the pressure cells of a block.

    Parameters
    ----------
    poisson : float     nu
    free_ends : bool    else the ends are held in y: plane strain

    References
    ----------
    Block elimination of a block tridiagonal matrix: Golub and Van Loan, Matrix Computations (2013),
    sec. 4.5.
    """
    section = _Section(grid)
    across, along = grid.cells
    count = across * along
    stiffness = _SlabStiffness(section, poisson)
    compliance = np.zeros((count, count))
    schur = np.zeros((3 * section.planar, 3 * section.planar))
    right = np.zeros((3 * section.planar, count))
    kept = section.supported
    if not free_ends:
        kept = np.delete(kept, np.flatnonzero(kept % 3 == 1))
    steps = np.diff(grid.y)
    for slab in range(steps.size - 1, -1, -1):
        outer, cross, inner, middle = stiffness.condensed(float(steps[slab]))
        ahead = np.zeros_like(right)
        if slab < along:
            columns = slice(slab * across, (slab + 1) * across)
            loads = section.facet_loads(float(steps[slab]))
            half = middle.forward(loads.between)
            compliance[columns, columns] += half.T @ half
            right[:, columns] += loads.plane - middle.outer.T @ half
            ahead[:, columns] += loads.plane - middle.inner.T @ half
        block = (schur + outer)[np.ix_(kept, kept)]
        factor = _cholesky(block)
        carried = _forward(factor, right[kept])
        compliance += carried.T @ carried
        coupling = _forward(factor, cross[kept])
        schur = inner - _gram(coupling)
        right = ahead - coupling.T @ carried
        kept = section.supported
    results = []
    for fixed in ((1,), (0, 2)):
        free = kept[~np.isin(kept % 3, fixed)]
        last = _forward(_cholesky(schur[np.ix_(free, free)]), right[free])
        results.append(compliance + last.T @ last)
    return QuarterCompliance(*results)


@dataclass(frozen=True, eq=False)
class _Loads:
    """Nodal forces (3 nodes, across) of unit pressures on a slab's facets, each plane, between."""

    plane: Array
    between: Array


class _Section:
    """Nodes of the planes across y: `planar` on element faces, `between` on the edges along y."""

    def __init__(self, grid: BrickGrid) -> None:
        self.grid = grid
        self.x, self.z = grid.x, grid.z
        nx, nz = grid.x.size - 1, grid.z.size - 1
        refined_x, refined_z = np.meshgrid(
            np.arange(2 * nx + 1), np.arange(2 * nz + 1), indexing="ij"
        )
        is_planar = (refined_x % 2 == 0) | (refined_z % 2 == 0)
        is_between = (refined_x % 2 == 0) & (refined_z % 2 == 0)
        self.planar, self.between = int(is_planar.sum()), int(is_between.sum())
        self._planar = np.full(is_planar.shape, -1)
        self._planar[is_planar] = np.arange(self.planar)
        self._between = np.full(is_planar.shape, -1)
        self._between[is_between] = np.arange(self.between)
        self.supported = self._supported(refined_x[is_planar], refined_z[is_planar])
        self.supported_between = self._supported(refined_x[is_between], refined_z[is_between])

    def _supported(self, place_x: Index, place_z: Index) -> Index:
        """Unknowns that are not held by the base or the symmetry of x."""
        free = np.ones((place_x.size, 3), dtype=bool)
        free[place_z == 2 * (self.z.size - 1)] = False
        free[place_x == 0, 0] = False
        return np.flatnonzero(free)

    def unknowns_of_elements(self) -> Index:
        """Unknowns (elements, 60) of a slab: outer plane, inner plane, between.

        The outer plane is that of the larger y.
        """
        corners = _reference().places
        nx, nz = self.x.size - 1, self.z.size - 1
        i, k = (v.ravel() for v in np.meshgrid(np.arange(nx), np.arange(nz), indexing="ij"))
        nodes = np.empty((i.size, _NODES), dtype=np.intp)
        for node, (px, py, pz) in enumerate(corners):
            place = (2 * i + px, 2 * k + pz)
            if py == 1:
                nodes[:, node] = 2 * self.planar + self._between[place]
            else:
                nodes[:, node] = (0 if py == 2 else self.planar) + self._planar[place]
        return (3 * nodes[:, :, None] + np.arange(3)).reshape(i.size, 3 * _NODES)

    def facet_loads(self, thickness: float) -> _Loads:
        """Loads of the facets of a slab of a thickness, m, along z: into the block."""
        across = self.grid.cells[0]
        widths = np.diff(self.x)[:across]
        plane = np.zeros((3 * self.planar, across))
        between = np.zeros((3 * self.between, across))
        for facet, width in enumerate(widths):
            # Serendipity facet of 8 nodes: -1/12 at each corner, 1/3 at each middle.
            area = width * thickness
            for place in (2 * facet, 2 * facet + 2):
                plane[3 * self._planar[place, 0] + 2, facet] -= area / 12.0
                between[3 * self._between[place, 0] + 2, facet] += area / 3.0
            plane[3 * self._planar[2 * facet + 1, 0] + 2, facet] += area / 3.0
        return _Loads(plane, between)


@dataclass(frozen=True, eq=False)
class _Middle:
    """Eliminated nodes between two planes: factor, forward-substituted coupling to each plane."""

    factor: Array
    supported: Index
    outer: Array
    inner: Array

    def forward(self, loads: Array) -> Array:
        """Forward substitution of loads on all nodes between the planes."""
        return _forward(self.factor, loads[self.supported])


class _SlabStiffness:
    """Stiffness of a slab of one element along y: polynomial of its thickness; E = 1."""

    def __init__(self, section: _Section, poisson: float) -> None:
        self._section = section
        lame, shear = lame_parameters(1.0, poisson)
        unknowns = section.unknowns_of_elements()
        rows = np.repeat(unknowns, 3 * _NODES, axis=1).ravel()
        columns = np.tile(unknowns, (1, 3 * _NODES)).ravel()
        size = 3 * (2 * section.planar + section.between)
        widths, depths = np.diff(section.x), np.diff(section.z)
        width, depth = (v.ravel() for v in np.meshgrid(widths, depths, indexing="ij"))
        # Parts in proportion to the thickness, independent of it, and to its inverse.
        self._parts = [
            scipy.sparse.coo_array((part.ravel(), (rows, columns)), shape=(size, size)).tocsr()
            for part in _element_stiffness(width, depth, lame, shear)
        ]
        self._of_thickness: dict[float, tuple[Array, Array, Array, _Middle]] = {}

    def condensed(self, thickness: float) -> tuple[Array, Array, Array, _Middle]:
        """Stiffness of the outer plane, its coupling to the inner one, the latter's; the middle."""
        if thickness not in self._of_thickness:
            self._of_thickness = {thickness: self._computed(thickness)}
        return self._of_thickness[thickness]

    def _computed(self, thickness: float) -> tuple[Array, Array, Array, _Middle]:
        first, second, third = self._parts
        whole = thickness * first + second + third / thickness
        planar = 3 * self._section.planar
        planes = whole[: 2 * planar, : 2 * planar].toarray()
        supported = self._section.supported_between
        free = 2 * planar + supported
        factor = _cholesky(whole[free][:, free].toarray())
        coupling = _forward(factor, whole[free][:, : 2 * planar].toarray())
        planes -= _gram(coupling)
        middle = _Middle(factor, supported, coupling[:, :planar], coupling[:, planar:])
        return planes[:planar, :planar], planes[:planar, planar:], planes[planar:, planar:], middle


@dataclass(frozen=True, eq=False)
class _Reference:
    """Unit cube: places (20, 3) of its nodes in half edges, integrals (3, 3, 20, 20) of slopes."""

    places: Index
    slopes: Array


@cache
def _reference() -> _Reference:
    from skfem import Basis, BilinearForm, ElementHexS2, MeshHex

    basis = Basis(MeshHex(), ElementHexS2(), intorder=_ORDER)
    slopes = np.empty((3, 3, _NODES, _NODES))
    for a in range(3):
        for b in range(3):
            form = BilinearForm(lambda u, v, w, a=a, b=b: v.grad[a] * u.grad[b])  # noqa: ARG005
            slopes[a, b] = form.assemble(basis).toarray()
    return _Reference(np.rint(2.0 * basis.doflocs.T).astype(np.intp), slopes)


def _element_stiffness(
    width: Array, depth: Array, lame: float, shear: float
) -> tuple[Array, Array, Array]:
    """Stiffness of bricks (elements, 60, 60) by powers 1, 0 and -1 of their size along y."""
    slopes = _reference().slopes
    count = width.size
    parts = np.zeros((3, count, _NODES, 3, _NODES, 3))
    ones = np.ones(count)
    # Size along each axis but for y, whose power is counted.
    sizes = (width, ones, depth)
    volume = width * depth

    def add(c: int, d: int, a: int, b: int, factor: float) -> None:
        power = int(a == 1) + int(b == 1)
        scale = factor * volume / (sizes[a] * sizes[b])
        parts[power, :, :, c, :, d] += scale[:, None, None] * slopes[a, b]

    for c in range(3):
        for d in range(3):
            add(c, d, c, d, lame)
            add(c, d, d, c, shear)
        for a in range(3):
            add(c, c, a, a, shear)
    whole = parts.reshape(3, count, 3 * _NODES, 3 * _NODES)
    return whole[0], whole[1], whole[2]


def _cholesky(matrix: Array) -> Array:
    try:
        return np.asarray(scipy.linalg.cholesky(matrix, lower=True, check_finite=False))
    except scipy.linalg.LinAlgError as error:
        raise ContactError("stiffness of the block: not positive definite") from error


def _forward(factor: Array, right: Array) -> Array:
    solved = scipy.linalg.solve_triangular(factor, right, lower=True, check_finite=False)
    return np.asarray(solved)


def _gram(matrix: Array) -> Array:
    """Product of the transposed matrix and itself, by half of the multiplications."""
    upper = scipy.linalg.blas.dsyrk(1.0, matrix, trans=1)
    return np.asarray(upper + np.triu(upper, 1).T)
