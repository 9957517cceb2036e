"""Elastic body in plane strain: stiffness matrix, assembled and factorised once for many loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.pipeline.contact.elasticity.sparse_factor import Condensed, factorised

if TYPE_CHECKING:
    from skfem import Basis


def lame_parameters(modulus: float, poisson: float) -> tuple[float, float]:
    """First Lame parameter and shear modulus, Pa, of plane strain."""
    shear = modulus / (2 * (1 + poisson))
    return modulus * poisson / ((1 + poisson) * (1 - 2 * poisson)), shear


@dataclass(frozen=True)
class Elastic:
    """Elastic constants: Young's modulus (Pa), Poisson ratio."""

    modulus: float
    poisson: float

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2), Pa."""
        return self.modulus / (1 - self.poisson**2)


@dataclass(frozen=True, eq=False)
class Springs:
    """Springs between body and ground, each on a weighted mean of nodal displacements.

    ways (m, 2, nodes) weights of the mean; stiffness (m,), N/m per m of width.
    """

    ways: Array
    stiffness: Array

    def __post_init__(self) -> None:
        freeze(self, ways=self.ways, stiffness=self.stiffness)

    def forces(self, displacement: Array) -> Array:
        """Nodal forces of the springs (2, nodes, k), N/m, at displacements (2, nodes, k), m."""
        return np.asarray(-np.einsum("mcn,mk->cnk", self.ways, self.pulls(displacement)))

    def pulls(self, displacement: Array) -> Array:
        """Force (m, k), N/m, in each spring, positive at a positive mean displacement."""
        return np.asarray(
            self.stiffness[:, None] * np.einsum("mcn,cnk->mk", self.ways, displacement)
        )


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """Quadratic triangles with curved edges, supported on named boundaries or by springs.

    `held` names the boundary held fully, or maps boundaries to the components held there, such
    as ``{"bottom": "y", "left": "x"}``. Displacements are arrays (2, nodes, ...) in the node order
    of the mesh.
    """

    mesh: BodyMesh
    modulus: float
    poisson: float
    held: str | Mapping[str, str]
    springs: Springs | None = None

    @cached_property
    def basis(self) -> Basis:
        from skfem import Basis, ElementTriP2, ElementVector

        return Basis(self.mesh.to_skfem(), ElementVector(ElementTriP2()), intorder=4)

    @cached_property
    def dofs(self) -> NDArray[np.int64]:
        """Degrees of freedom (2, nodes) of the mesh's nodes."""
        return self.mesh.dof_map(self.basis)

    @cached_property
    def stiffness(self) -> scipy.sparse.csc_matrix:
        """Stiffness matrix of linear elasticity and the springs, over all degrees of freedom, N/m
        per m of width; faster than the assembly of skfem.
        """
        from skfem import ElementTriP2

        scalar = self.basis.with_element(ElementTriP2())
        slopes = np.stack([shape[0].grad for shape in scalar.basis])  # (6, 2, elements, points)
        count = slopes.shape[2]
        slopes = slopes.reshape(12, count, -1).transpose(1, 0, 2)
        products = (slopes * np.asarray(scalar.dx)[:, None, :]) @ slopes.transpose(0, 2, 1)
        products = products.reshape(count, 6, 2, 6, 2)
        lam, shear = lame_parameters(self.modulus, self.poisson)
        local = lam * products + shear * products.transpose(0, 1, 4, 3, 2)
        both = shear * (products[:, :, 0, :, 0] + products[:, :, 1, :, 1])
        for component in range(2):
            local[:, :, component, :, component] += both
        dofs = self.basis.element_dofs.T
        rows = np.broadcast_to(dofs[:, :, None], (count, 12, 12))
        columns = np.broadcast_to(dofs[:, None, :], rows.shape)
        entries = (local.ravel(), (rows.ravel(), columns.ravel()))
        own = scipy.sparse.coo_matrix(entries, shape=(self.basis.N, self.basis.N)).tocsc()
        return own if self.springs is None else own + self._stiffness_of(self.springs)

    def _stiffness_of(self, springs: Springs) -> scipy.sparse.csc_array:
        """Stiffness matrix of the springs, all degrees of freedom, N/m2."""
        spring, component, node = np.nonzero(springs.ways)
        entries = (springs.ways[spring, component, node], (spring, self.dofs[component, node]))
        ways = scipy.sparse.csc_matrix(entries, shape=(springs.stiffness.size, self.basis.N))
        return (ways.T @ scipy.sparse.diags_array(springs.stiffness) @ ways).tocsc()

    @cached_property
    def held_dofs(self) -> NDArray[np.int64]:
        """Numbers of the held degrees of freedom, ascending.

        Raises
        ------
        MeshError
            If the mesh has no such boundary.
        InputError
            If a held component is neither x nor y.
        """
        held = {self.held: "xy"} if isinstance(self.held, str) else self.held
        parts = []
        for name, components in held.items():
            if not components or set(components) - {"x", "y"}:
                raise InputError(f"held.{name}", components, "x, y or xy")
            nodes = self.mesh.boundary_nodes(name)
            parts += [self.dofs["xy".index(component), nodes] for component in components]
        return np.unique(np.concatenate(parts)) if parts else np.empty(0, dtype=int)

    @cached_property
    def free_dofs(self) -> NDArray[np.int64]:
        return np.setdiff1d(np.arange(self.basis.N), self.held_dofs)

    @property
    def held_nodes(self) -> NDArray[np.int64]:
        """Nodes with at least one held component."""
        return np.flatnonzero(np.isin(self.dofs, self.held_dofs).any(axis=0))

    @cached_property
    def beside_held(self) -> NDArray[np.int64]:
        """Nodes coupled by the stiffness to held degrees of freedom."""
        felt = np.zeros(self.basis.N, dtype=bool)
        coupling = self.stiffness[:, self.held_dofs].tocsr()
        felt[self.free_dofs] = np.diff(coupling.indptr)[self.free_dofs] > 0
        return np.flatnonzero(felt[self.dofs].any(axis=0))

    @cached_property
    def _solver(self) -> tuple[Callable[[Array], Array], scipy.sparse.csc_matrix]:
        rows = self.stiffness[self.free_dofs]
        return factorised(rows[:, self.free_dofs]), rows[:, self.held_dofs]

    @property
    def dof_count(self) -> int:
        return int(self.basis.N)

    def displacement(self, loads: ArrayLike, held_at: ArrayLike | None = None) -> Array:
        """Displacement (2, nodes, k) under nodal forces (2, nodes, k), N/m.

        `held_at` (2, nodes, k) is the displacement of the held nodes, m; None: zero.
        """
        forces = np.asarray(loads, dtype=float)
        held, free = self.held_dofs, self.free_dofs
        solve, coupling = self._solver
        right = np.zeros((self.basis.N, forces.shape[2]))
        right[self.dofs] = forces
        solution = np.zeros_like(right)
        if held_at is not None:
            solution[self.dofs] = np.asarray(held_at, dtype=float)
            solution[free] = 0.0
            right[free] -= coupling @ solution[held]
        solution[free] = solve(right[free])
        return solution[self.dofs]

    def condensed(self, nodes: ArrayLike) -> CondensedBody:
        """Static condensation of the body to some of its nodes."""
        return CondensedBody(self, nodes)

    def surface_forces(self, displacement: Array, boundary: str) -> Array:
        """Nodal forces (2, nodes), N/m, that act on the nodes of a boundary at a displacement (2,
        nodes), m, by the stiffness; zero at the other nodes.
        """
        flat = np.zeros(self.basis.N)
        flat[self.dofs] = displacement
        nodes = self.mesh.boundary_nodes(boundary)
        forces = np.zeros_like(displacement)
        forces[:, nodes] = (self.stiffness[self.dofs[:, nodes].ravel()] @ flat).reshape(2, -1)
        return forces

    def reaction(self, displacement: Array) -> Array:
        """Resultant support reaction (2,) on the body, N/m, at a displacement (2, nodes), m."""
        flat = np.zeros(self.basis.N)
        flat[self.dofs] = displacement
        forces = np.zeros(self.basis.N)
        forces[self.held_dofs] = self.stiffness[self.held_dofs] @ flat
        return np.asarray(forces[self.dofs].sum(axis=1))


class CondensedBody:
    """Body condensed to the few nodes that are loaded or evaluated.

    Parameters
    ----------
    body : ElasticBody
    nodes : array (m,)   node numbers; held components of them have zero displacement
    """

    def __init__(self, body: ElasticBody, nodes: ArrayLike) -> None:
        self.body, self.nodes = body, np.asarray(nodes, dtype=int)
        row = np.full(body.basis.N, -1)
        row[body.free_dofs] = np.arange(body.free_dofs.size)
        pairs = row[body.dofs]
        seen = pairs[:, self.nodes].ravel()
        self._kept = seen >= 0
        stiffness = body.stiffness[body.free_dofs][:, body.free_dofs]
        self._matrix = Condensed(stiffness, pairs[:, (pairs >= 0).all(axis=0)], seen[self._kept])

    def displacement(self, loads: ArrayLike, held_at: ArrayLike | None = None) -> Array:
        """Displacement (2, m, k), m, of the condensed nodes under forces (2, m, k), N/m, on them.

        `held_at` (2, all nodes, k) is the displacement of the held nodes, m; the condensed nodes
        must then include `ElasticBody.beside_held`. None: zero.
        """
        forces = np.asarray(loads, dtype=float)
        right = forces.reshape(-1, forces.shape[2]).copy()
        solution = np.zeros_like(right)
        if held_at is not None:
            place, coupling, rows = self._held
            held = np.asarray(held_at, dtype=float).reshape(-1, forces.shape[2])[place]
            right -= coupling @ held
            solution[~self._kept] = held[rows]
        solution[self._kept] = self._matrix.solve_last(right[self._kept])
        return solution.reshape(forces.shape)

    @cached_property
    def _held(self) -> tuple[NDArray[np.int64], scipy.sparse.sparray, NDArray[np.int64]]:
        """Places of the held degrees of freedom in a flat displacement (2, all nodes), the
        stiffness that couples the condensed nodes to them, and which of them belong to condensed
        nodes.
        """
        body, seen = self.body, self.body.dofs[:, self.nodes].ravel()
        place = np.empty(body.basis.N, dtype=int)
        place[body.dofs.ravel()] = np.arange(body.dofs.size)
        held = body.held_dofs
        coupling = body.stiffness[seen][:, held].tocsr()
        return place[held], coupling, np.searchsorted(held, seen[~self._kept])

    def everywhere(self, loads: ArrayLike) -> Array:
        """Displacement (2, all nodes, k), m, of the body under forces (2, m, k), N/m, on the
        condensed nodes; held nodes at rest.
        """
        forces = np.asarray(loads, dtype=float)
        body = self.body
        right = np.zeros((body.basis.N, forces.shape[2]))
        right[body.dofs[:, self.nodes]] = forces
        solution = np.zeros_like(right)
        solution[body.free_dofs] = self._matrix.solve(right[body.free_dofs])
        return solution[body.dofs]


def elements_near(body: ElasticBody, point: ArrayLike, reach: float) -> NDArray[np.int64]:
    """Indices of the elements with a corner within `reach` (m) of a point (2,), m."""
    corners = body.mesh.points[:, body.mesh.triangles[:3]]
    distance = np.hypot(*(corners - np.reshape(point, (2, 1, 1))))
    return np.flatnonzero((distance < reach).any(axis=0))


class StressRecovery:
    """Nodal stress of some elements by L2 projection onto continuous quadratic shapes.

    Linear in the displacement; one instance evaluates any number of load columns.
    """

    def __init__(self, body: ElasticBody, elements: ArrayLike) -> None:
        """Assemble the operators from displacement to stress at the points of integration, and from
        there to the nodes, of the elements with the numbers `elements`.
        """
        from skfem import Basis, ElementTriP2, ElementVector

        ix = np.asarray(elements, dtype=int)
        vector = Basis(body.basis.mesh, ElementVector(ElementTriP2()), elements=ix, intorder=4)
        scalar = vector.with_element(ElementTriP2())
        weights = np.asarray(vector.dx).ravel()
        points = weights.size
        nodal = np.unique(scalar.element_dofs)
        column = np.full(scalar.N, -1)
        column[nodal] = np.arange(nodal.size)

        shapes = _stacked(
            [np.broadcast_to(np.asarray(f[0]), vector.dx.shape) for f in scalar.basis],
            column[scalar.element_dofs],
            (points, nodal.size),
        )
        lam, shear = lame_parameters(body.modulus, body.poisson)
        gradients = [f[0].grad for f in vector.basis]
        strain = [
            _stacked([g[i, j] for g in gradients], vector.element_dofs, (points, vector.N))
            for i, j in ((0, 0), (1, 1), (0, 1), (1, 0))
        ]
        trace = lam * (strain[0] + strain[1])
        self._stress_at_points = (
            trace + 2 * shear * strain[0],
            trace + 2 * shear * strain[1],
            shear * (strain[2] + strain[3]),
        )
        self._weighted_shapes = shapes.T @ scipy.sparse.diags_array(weights)
        self._solve = factorised(self._weighted_shapes @ shapes)
        node_of_dof = np.full(vector.N, -1)
        node_of_dof[body.dofs[0]] = np.arange(body.dofs.shape[1])
        x_dof = np.full(scalar.N, -1)
        x_dof[scalar.nodal_dofs[0]] = vector.nodal_dofs[0]
        x_dof[scalar.facet_dofs[0]] = vector.facet_dofs[0]
        self.nodes = node_of_dof[x_dof[nodal]]
        self._dofs = body.dofs
        self._size = vector.N

    def __call__(self, displacement: Array) -> Array:
        """Stress (3, n, k): xx, yy, xy at `nodes`, from a displacement (2, nodes, k)."""
        flat = np.zeros((self._size, displacement.shape[2]))
        flat[self._dofs] = displacement
        return np.stack(
            [self._solve(self._weighted_shapes @ (part @ flat)) for part in self._stress_at_points]
        )

    def operator(self, nodes: ArrayLike) -> Array:
        """Stress xx, yy, xy (3, m, 2, n), Pa/m, at `nodes` (m,) under a unit displacement x or y of
        each of the n nodes of the recovered elements; `nodes`: numbers of the mesh, among them.
        """
        order = np.argsort(self.nodes)
        rows = order[np.searchsorted(self.nodes, np.asarray(nodes, dtype=int), sorter=order)]
        columns = self._dofs[:, self.nodes].ravel()
        parts = [
            self._solve((self._weighted_shapes @ part[:, columns]).toarray())[rows]
            for part in self._stress_at_points
        ]
        return np.stack(parts).reshape(3, rows.size, 2, self.nodes.size)


def _stacked(
    values: list[Array], dofs: NDArray[np.int64], shape: tuple[int, int]
) -> scipy.sparse.csr_array:
    """Sparse matrix of shape `shape` that evaluates a field at the points of integration of all
    elements from its degrees of freedom.

    Parameters
    ----------
    values : list of array (elements, points)   of each local shape at the points
    dofs : array (shapes, elements)             column of each local shape
    shape : two ints                            elements times points, and number of columns
    """
    elements, quadrature = values[0].shape
    rows = np.arange(elements * quadrature)
    parts = [
        scipy.sparse.csr_array((v.ravel(), (rows, np.repeat(d, quadrature))), shape=shape)
        for v, d in zip(values, dofs, strict=True)
    ]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
