"""Compliance of an elastic block to contact pressure cells, by quadratic bricks.

Hexahedra of 20 nodes on a tensor grid, the base held, constant pressure on the cells of the top.
A quarter is modelled: loads are symmetric in x, and in y symmetric or antisymmetric. The nodes are
eliminated plane by plane from the free end towards the middle; both symmetries differ in the last
plane alone. The compliance is the product of the forward substitution with itself, so that neither
the stiffness nor its factors are kept; the displacement under known pressures needs the factors of
all planes.
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

_BRICK_NODES = 20  # of a quadratic brick of serendipity shapes
# The 27 Gauss points of the element integrate its stiffness exactly.
_QUADRATURE_ORDER = 5


@dataclass(frozen=True, eq=False)
class BrickGrid:
    """Element edges of a quarter block, m: x, y from its middle, z from the top.

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
        """Number of unknowns of the quarter, supports excluded."""
        section, count = _Section(self), self.y.size
        return 3 * (section.planar * count + section.between * (count - 1))


@dataclass(frozen=True, eq=False)
class QuarterCompliance:
    """Cell displacements, integrated, per pressure on each cell and its images, (n, n), m3.

    Times Young's modulus; of pressures symmetric and antisymmetric in y. Cells run in x first.
    """

    symmetric: Array
    antisymmetric: Array

    def __post_init__(self) -> None:
        freeze(self, symmetric=self.symmetric, antisymmetric=self.antisymmetric)

    def both_sides(self, across: int) -> Array:
        """Compliance (2n, 2n), m3, of the cells of both halves y < 0 and y > 0, from those of one:
        y ascending, x running first, with `across` cells in x.
        """
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
    """Compliance matrix of the pressure cells of a block.

    Parameters
    ----------
    poisson : float     nu
    free_ends : bool    else the ends are held in y: plane strain

    References
    ----------
    Block elimination of a block tridiagonal matrix: Golub and Van Loan, Matrix Computations (2013),
    sec. 4.5.
    """
    across, along = grid.cells
    count = across * along
    compliance = np.zeros((count, count))
    elimination = _Elimination(grid, poisson, count, free_ends=free_ends)
    for slab in range(grid.y.size - 2, -1, -1):
        columns = np.arange(slab * across, (slab + 1) * across)
        loads = elimination.facets(slab)
        gone = elimination.without_outer_plane(slab, loads, columns)
        if gone.between is not None:
            compliance[np.ix_(columns, columns)] += gone.between.T @ gone.between
        compliance += gone.carried.T @ gone.carried
        del gone  # its dense factors, before the next ones are made
    results = []
    for symmetry in _SYMMETRIES:
        _, _, last = elimination.last_plane(symmetry)
        results.append(compliance + last.T @ last)
    return QuarterCompliance(*results)


def displacement(grid: BrickGrid, poisson: float, pressure: Array) -> Array:
    """Displacement times Young's modulus (2, i, j, k, 3), m Pa, of a block with free ends, its base
    held.

    On the lattice of half edges along x, y and z, NaN where it has no node; z into the block. First
    the field under the pressures symmetric in y, then that under the antisymmetric ones.

    Parameters
    ----------
    pressure : array (2, along, across)   Pa, on the cells: symmetric and antisymmetric in y
    """
    elimination = _Elimination(grid, poisson, 2)
    section, slabs = elimination.section, range(grid.y.size - 1)
    stored = {}
    for slab in reversed(slabs):
        loads = elimination.facets(slab)
        if loads is not None:
            here = pressure[:, slab].T
            loads = _Loads(loads.plane @ here, loads.between @ here)
        stored[slab] = _Stored.of(elimination.without_outer_plane(slab, loads, np.arange(2)))
    shape = (2 * grid.x.size - 1, 2 * grid.y.size - 1, 2 * grid.z.size - 1, 3)
    field = np.full((2, *shape), np.nan)
    planes = []
    for number, symmetry in enumerate(_SYMMETRIES):
        free, factor, right = elimination.last_plane(symmetry)
        plane = np.zeros(3 * section.planar)
        plane[free] = _backward(factor, right[:, number])
        section.place(field[number, :, 0], plane)
        planes.append(plane)
    for slab in slabs:
        part, (cross, middle) = stored.pop(slab), elimination.coupled(slab)
        factor = part.factor
        for number, inner in enumerate(planes):
            plane = np.zeros_like(inner)
            right = part.carried[:, number] - _forward(factor, cross[part.kept] @ inner)
            plane[part.kept] = _backward(factor, right)
            between = np.zeros(3 * section.between)
            loaded = 0.0 if part.between is None else part.between[:, number]
            right = loaded - middle.outer @ plane - middle.inner @ inner
            between[middle.supported] = _backward(middle.factor, right)
            section.place(field[number, :, 2 * slab + 1], between)
            section.place(field[number, :, 2 * slab + 2], plane)
            planes[number] = plane
    return field


# Displacements that vanish in the middle plane under symmetric and antisymmetric loads.
_SYMMETRIES = ((1,), (0, 2))


@dataclass(frozen=True, eq=False)
class _Gone:
    """Eliminated outer plane of a slab, and the nodes between its planes.

    kept: its unknowns; factor: of their stiffness; loads `carried` and loads `between`,
    forward-substituted.
    """

    kept: Index
    factor: Array
    carried: Array
    between: Array | None


@dataclass(frozen=True, eq=False)
class _Stored:
    """An eliminated plane until it is solved for: its factor in packed form, half of the memory."""

    kept: Index
    packed: Array
    carried: Array
    between: Array | None

    @classmethod
    def of(cls, gone: _Gone) -> _Stored:
        packed, _ = scipy.linalg.lapack.dtrttp(gone.factor, uplo="L")
        return cls(gone.kept, packed, gone.carried, gone.between)

    @property
    def factor(self) -> Array:
        """The lower factor (n, n)."""
        full, _ = scipy.linalg.lapack.dtpttr(self.kept.size, self.packed, uplo="L")
        return np.asarray(full)


class _Elimination:
    """Elimination of the planes of a block from its end to the middle, under columns of loads."""

    def __init__(
        self, grid: BrickGrid, poisson: float, columns: int, *, free_ends: bool = True
    ) -> None:
        self.section = section = _Section(grid)
        self._steps, self._along = np.diff(grid.y), grid.cells[1]
        self._stiffness = _SlabStiffness(section, poisson)
        self._schur = np.zeros((3 * section.planar, 3 * section.planar))
        self._right = np.zeros((3 * section.planar, columns))
        self._kept = section.supported
        if not free_ends:
            self._kept = np.delete(self._kept, np.flatnonzero(self._kept % 3 == 1))

    def facets(self, slab: int) -> _Loads | None:
        """Loads of unit pressures on the facets of a slab; None beside the cells."""
        return self.section.facet_loads(float(self._steps[slab])) if slab < self._along else None

    def without_outer_plane(self, slab: int, loads: _Loads | None, columns: Index) -> _Gone:
        """Eliminate the outer plane of a slab, of larger y, with the nodes between its planes; what
        is left acts on the inner plane.

        Parameters
        ----------
        slab : int               number of the element along y, from the middle
        loads : _Loads or None   on the facets of the slab
        columns : array of int   columns of the right-hand sides in which the loads count
        """
        outer, cross, inner, middle = self._stiffness.condensed(float(self._steps[slab]))
        ahead, half, kept = np.zeros_like(self._right), None, self._kept
        if loads is not None:
            half = middle.forward(loads.between)
            self._right[:, columns] += loads.plane - middle.outer.T @ half
            ahead[:, columns] += loads.plane - middle.inner.T @ half
        # Dense matrices of a plane take most of the memory: each is overwritten by the next.
        self._schur += outer
        factor = _cholesky(self._schur[np.ix_(kept, kept)])
        carried = _forward(factor, self._right[kept])
        coupling = _forward(factor, cross[kept])
        np.matmul(coupling.T, coupling, out=self._schur)
        np.subtract(inner, self._schur, out=self._schur)
        self._right = ahead - coupling.T @ carried
        self._kept = self.section.supported
        return _Gone(kept, factor, carried, half)

    def coupled(self, slab: int) -> tuple[Array, _Middle]:
        """Coupling of the outer plane of a slab to the inner one; the nodes between them."""
        _, cross, _, middle = self._stiffness.condensed(float(self._steps[slab]))
        return cross, middle

    def last_plane(self, fixed: tuple[int, ...]) -> tuple[Index, Array, Array]:
        """Middle plane: unknowns, factor of their stiffness, forward-substituted loads."""
        free = self._kept[~np.isin(self._kept % 3, fixed)]
        factor = _cholesky(self._schur[np.ix_(free, free)])
        return free, factor, _forward(factor, self._right[free])


@dataclass(frozen=True, eq=False)
class _Loads:
    """Nodal forces (3 nodes, across) of unit pressures on a slab's facets, each plane, between."""

    plane: Array
    between: Array


class _Section:
    """Nodes of the planes across y: `planar` on element faces, `between` on the edges along y."""

    def __init__(self, grid: BrickGrid) -> None:
        """Number the nodes on the lattice of half edges across y, and the unknowns that
        are free.
        """
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
        """Numbers of the unknowns, three per node, that are neither held by the base nor by the
        symmetry of x.

        Parameters
        ----------
        place_x, place_z : array of int (nodes,)   places of the nodes, in half edges
        """
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
        nodes = np.empty((i.size, _BRICK_NODES), dtype=np.intp)
        for node, (px, py, pz) in enumerate(corners):
            place = (2 * i + px, 2 * k + pz)
            if py == 1:
                nodes[:, node] = 2 * self.planar + self._between[place]
            else:
                nodes[:, node] = (0 if py == 2 else self.planar) + self._planar[place]
        return (3 * nodes[:, :, None] + np.arange(3)).reshape(i.size, 3 * _BRICK_NODES)

    def place(self, lattice: Array, values: Array) -> None:
        """Write unknowns of a plane, or of the nodes between two, on the lattice (i, k, 3)."""
        numbers = self._planar if values.size == 3 * self.planar else self._between
        lattice[numbers >= 0] = values.reshape(-1, 3)[numbers[numbers >= 0]]

    def facet_loads(self, thickness: float) -> _Loads:
        """Nodal forces of unit pressures, along z into the block, on the facets of a slab; its
        thickness along y, m.
        """
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
        """Assemble the parts of the stiffness in proportion to the thickness, independent of it,
        and to its inverse.
        """
        self._section = section
        lame, shear = lame_parameters(1.0, poisson)
        unknowns = section.unknowns_of_elements()
        rows = np.repeat(unknowns, 3 * _BRICK_NODES, axis=1).ravel()
        columns = np.tile(unknowns, (1, 3 * _BRICK_NODES)).ravel()
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
        """Stiffness of the outer plane, its coupling to the inner plane, stiffness of the inner
        plane, all without the nodes between, and these eliminated nodes; thickness in m.
        """
        if thickness not in self._of_thickness:
            self._of_thickness.clear()
            self._of_thickness[thickness] = self._computed(thickness)
        return self._of_thickness[thickness]

    def _computed(self, thickness: float) -> tuple[Array, Array, Array, _Middle]:
        """What `condensed` returns, by elimination of the nodes between both planes."""
        first, second, third = self._parts
        whole = thickness * first + second + third / thickness
        planar = 3 * self._section.planar
        supported = self._section.supported_between
        free = 2 * planar + supported
        factor = _cholesky(whole[free][:, free].toarray())
        planes = slice(planar), slice(planar, 2 * planar)
        to_planes = [_forward(factor, whole[free][:, each].toarray()) for each in planes]
        blocks: list[Array] = []
        for i, j in ((0, 0), (0, 1), (1, 1)):
            block = whole[planes[i], planes[j]].toarray()
            block -= to_planes[i].T @ to_planes[j]
            blocks.append(block)
        return blocks[0], blocks[1], blocks[2], _Middle(factor, supported, *to_planes)


@dataclass(frozen=True, eq=False)
class _Reference:
    """Unit cube: places (20, 3) of its nodes in half edges, integrals (3, 3, 20, 20) of slopes."""

    places: Index
    slopes: Array


@cache
def _reference() -> _Reference:
    """Nodes and integrals of the products of slopes of the quadratic serendipity brick, on the unit
    cube.
    """
    from skfem import Basis, BilinearForm, ElementHexS2, MeshHex

    basis = Basis(MeshHex(), ElementHexS2(), intorder=_QUADRATURE_ORDER)
    slopes = np.empty((3, 3, _BRICK_NODES, _BRICK_NODES))
    for a in range(3):
        for b in range(3):
            form = BilinearForm(lambda u, v, w, a=a, b=b: v.grad[a] * u.grad[b])  # noqa: ARG005
            slopes[a, b] = form.assemble(basis).toarray()
    return _Reference(np.rint(2.0 * basis.doflocs.T).astype(np.intp), slopes)


def shape_slopes(points: Array) -> tuple[Index, Array]:
    """Node positions (20, 3) of a brick in half edges, and slopes (n, 3, 20) of its shape functions
    along the axes of the unit cube, at points (n, 3) of it.
    """
    from skfem import Basis, ElementHexS2, MeshHex

    element = ElementHexS2()
    mapping = Basis(MeshHex(), element, intorder=_QUADRATURE_ORDER).mapping
    inside = np.concatenate([mapping.invF(each[:, None, None]) for each in points], axis=2)
    columns = [
        element.gbasis(mapping, inside[:, 0], node)[0].grad[:, 0] for node in range(_BRICK_NODES)
    ]
    return _reference().places, np.moveaxis(np.array(columns), -1, 0).transpose(0, 2, 1)


def _element_stiffness(
    width: Array, depth: Array, lame: float, shear: float
) -> tuple[Array, Array, Array]:
    """Stiffness of bricks in three parts (elements, 60, 60), those in proportion to the powers 1, 0
    and -1 of their size along y.

    Parameters
    ----------
    width, depth : array (elements,)   sizes along x and z, m
    lame, shear : float                first Lame parameter and shear modulus, over Young's modulus
    """
    slopes = _reference().slopes
    count = width.size
    parts = np.zeros((3, count, _BRICK_NODES, 3, _BRICK_NODES, 3))
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
    whole = parts.reshape(3, count, 3 * _BRICK_NODES, 3 * _BRICK_NODES)
    return whole[0], whole[1], whole[2]


def _cholesky(matrix: Array) -> Array:
    """Lower factor of a matrix, which is overwritten."""
    try:
        return np.asarray(
            scipy.linalg.cholesky(matrix.T, lower=True, check_finite=False, overwrite_a=True)
        )
    except scipy.linalg.LinAlgError as error:
        raise ContactError("stiffness of the block: not positive definite") from error


def _forward(factor: Array, right: Array) -> Array:
    solved = scipy.linalg.solve_triangular(
        factor, np.asfortranarray(right), lower=True, check_finite=False, overwrite_b=True
    )
    return np.asarray(solved)


def _backward(factor: Array, right: Array) -> Array:
    solved = scipy.linalg.solve_triangular(factor, right, lower=True, trans=1, check_finite=False)
    return np.asarray(solved)
