"""An elastic body in plane strain: assembled and factored once, solved for many loads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP2, ElementVector
from skfem.models.elasticity import linear_elasticity

from geometry.arrays import Array
from geometry.errors import MeshError
from meshes.body import BodyMesh


def lame_parameters(modulus: float, poisson: float) -> tuple[float, float]:
    """First Lame parameter and shear modulus (Pa); plane strain needs no others."""
    shear = modulus / (2 * (1 + poisson))
    return modulus * poisson / ((1 + poisson) * (1 - 2 * poisson)), shear


def factorised(matrix: sparse.spmatrix) -> Callable[[Array], Array]:
    """Solver of a sparse symmetric positive definite matrix.

    Minimum degree on A + A^T without pivoting is legitimate for such a matrix and about three
    times faster than the default of SuperLU.
    """
    factor = splu(
        sparse.csc_matrix(matrix),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return factor.solve


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """Second-order finite elements on curved triangles, held on one named boundary.

    Displacements are arrays (2, nodes, ...) in the node order of the mesh.
    """

    mesh: BodyMesh
    modulus: float
    poisson: float
    held: str

    @cached_property
    def basis(self) -> Any:
        return Basis(self.mesh.to_skfem(), ElementVector(ElementTriP2()), intorder=4)

    @cached_property
    def dofs(self) -> Any:
        """Degrees of freedom (2, nodes) of the mesh's nodes."""
        return self.mesh.dof_map(self.basis)

    @cached_property
    def stiffness(self) -> Any:
        form = linear_elasticity(*lame_parameters(self.modulus, self.poisson))
        return form.assemble(self.basis).tocsc()

    @cached_property
    def _partition(self) -> tuple[Any, Any, Any]:
        held = np.unique(self.dofs[:, self.mesh.boundary_nodes(self.held)])
        if held.size == 0:
            raise MeshError(f"the mesh has no boundary named {self.held}")
        free = np.setdiff1d(np.arange(self.basis.N), held)
        rows = self.stiffness[free]
        return held, free, (factorised(rows[:, free]), rows[:, held])

    @property
    def dof_count(self) -> int:
        return int(self.basis.N)

    def displacement(self, loads: ArrayLike, held_at: ArrayLike | None = None) -> Array:
        """Displacement (2, nodes, k) under nodal forces (2, nodes, k), N/m.

        `held_at` (2, nodes, k) gives the displacement of the held boundary; zero without it.
        """
        forces = np.asarray(loads, dtype=float)
        count = forces.shape[2]
        held, free, (solve, coupling) = self._partition
        right = np.zeros((self.basis.N, count))
        right[self.dofs] = forces
        solution = np.zeros_like(right)
        if held_at is not None:
            given = np.zeros_like(right)
            given[self.dofs] = np.asarray(held_at, dtype=float)
            solution[held] = given[held]
            right[free] -= coupling @ solution[held]
        solution[free] = solve(right[free])
        return solution[self.dofs]

    def reaction(self, displacement: Array) -> Array:
        """Resultant force (2,) of the held boundary on the body, N/m."""
        flat = np.zeros(self.basis.N)
        flat[self.dofs] = displacement
        forces = (self.stiffness @ flat)[self.dofs]
        return forces[:, self.mesh.boundary_nodes(self.held)].sum(axis=1)


def elements_near(body: ElasticBody, point: ArrayLike, reach: float) -> Any:
    """Elements with a corner within `reach` of a point (2,)."""
    corners = body.mesh.points[:, body.mesh.triangles[:3]]
    distance = np.hypot(*(corners - np.reshape(point, (2, 1, 1))))
    return np.flatnonzero((distance < reach).any(axis=0))


class StressRecovery:
    """Nodal stress of some elements of a body by projection onto continuous quadratics.

    Linear in the displacement, so one instance serves any number of load columns.
    """

    def __init__(self, body: ElasticBody, elements: ArrayLike) -> None:
        ix = np.asarray(elements, dtype=int)
        vector = Basis(body.basis.mesh, ElementVector(ElementTriP2()), elements=ix, intorder=4)
        scalar = vector.with_element(ElementTriP2())
        weights = np.asarray(vector.dx).ravel()
        points = weights.size
        nodal = np.unique(scalar.element_dofs)
        column = np.full(scalar.N, -1)
        column[nodal] = np.arange(nodal.size)

        shapes = _stacked(
            [np.broadcast_to(f[0].value, vector.dx.shape) for f in scalar.basis],
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
        self._weighted_shapes = shapes.T @ sparse.diags_array(weights)
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


def _stacked(values: list[Any], dofs: Any, shape: tuple[int, int]) -> Any:
    """Sparse matrix (quadrature points, degrees of freedom) from values per local shape."""
    elements, quadrature = values[0].shape
    rows = np.arange(elements * quadrature)
    parts = [
        sparse.csr_array((v.ravel(), (rows, np.repeat(d, quadrature))), shape=shape)
        for v, d in zip(values, dofs, strict=True)
    ]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
