"""Finite-element tier: against scikit-fem's own assembly, Hertz, plane strain and a uniform state.

The whole block solved at once is the reference of the elimination by planes.
"""

import numpy as np
import pytest
import scipy

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.axial_shape import BodyEnd
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    FiniteBody,
    FinitePair,
    Straight,
)
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid, condensed
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells, graded

STEEL = Elastic(210e9, 0.3)
BLOCK = BrickGrid(
    np.array([0.0, 0.2, 0.5, 1.1]),
    np.array([0.0, 0.3, 0.4, 0.9]),
    np.array([0.0, 0.25, 0.8]),
    (2, 2),
)


def assembled(grid, poisson):
    """Compliances of the facets by scikit-fem: whole mesh, its own numbering, facet integrals."""
    from skfem import (
        Basis,
        BilinearForm,
        ElementHexS2,
        ElementVector,
        FacetBasis,
        LinearForm,
        MeshHex,
        asm,
    )
    from skfem.helpers import ddot, eye, sym_grad, trace

    mesh = MeshHex.init_tensor(grid.x, grid.y, grid.z)
    basis = Basis(mesh, ElementVector(ElementHexS2()), intorder=5)
    lame, shear = poisson / ((1 + poisson) * (1 - 2 * poisson)), 0.5 / (1 + poisson)

    @BilinearForm
    def stiffness(u, v, w):
        e = sym_grad(u)
        return ddot(lame * eye(trace(e), 3) + 2 * shear * e, sym_grad(v))

    @LinearForm
    def push(v, w):
        return v[2]

    matrix = asm(stiffness, basis).tocsc()
    loads = []
    for j in range(grid.cells[1]):
        for i in range(grid.cells[0]):
            centre = np.array([grid.x[i : i + 2].mean(), grid.y[j : j + 2].mean(), 0.0])
            facet = np.flatnonzero(
                np.abs(mesh.p[:, mesh.facets].mean(axis=1).T - centre).max(1) < 1e-9
            )
            loads.append(asm(push, FacetBasis(mesh, basis.elem, facets=facet, intorder=5)))
    loads = np.array(loads).T
    place = basis.doflocs
    component = np.empty(basis.N, dtype=int)
    for dofs in (basis.nodal_dofs, basis.edge_dofs):
        for c in range(3):
            component[dofs[c]] = c
    held = np.isclose(place[2], grid.z[-1]) | (np.isclose(place[0], 0) & (component == 0))
    middle = np.isclose(place[1], 0)
    results = []
    for at_middle in (component == 1, component != 1):
        free = np.flatnonzero(~(held | (middle & at_middle)))
        displaced = scipy.sparse.linalg.spsolve(matrix[free][:, free], loads[free])
        results.append(loads[free].T @ displaced)
    return results


def test_elimination_by_planes_is_the_whole_block_solved_at_once():
    quarter = condensed(BLOCK, 0.3)
    symmetric, antisymmetric = assembled(BLOCK, 0.3)
    np.testing.assert_allclose(quarter.symmetric, symmetric, rtol=1e-10)
    np.testing.assert_allclose(quarter.antisymmetric, antisymmetric, rtol=1e-9)


def test_uniform_pressure_compresses_a_bar_uniformly():
    """Patch test: without lateral strain a held base leaves the state uniform."""
    grid = BrickGrid(BLOCK.x, BLOCK.y, BLOCK.z, (3, 3))
    quarter = condensed(grid, 0.0)
    areas = np.outer(np.diff(grid.y), np.diff(grid.x)).ravel()
    settled = quarter.symmetric @ np.ones(9)
    np.testing.assert_allclose(settled, areas * grid.z[-1], rtol=1e-10)


def test_held_ends_confine_the_strain():
    """With nu = 0 there is nothing to confine under a uniform pressure."""
    grid = BrickGrid(BLOCK.x, BLOCK.y, BLOCK.z, (3, 3))
    held, free = (condensed(grid, 0.3, free_ends=ends).symmetric.sum() for ends in (False, True))
    assert held < free
    held, free = (condensed(grid, 0.0, free_ends=ends).symmetric.sum() for ends in (False, True))
    assert held == pytest.approx(free, rel=1e-10)


def test_both_sides_mirror_each_other():
    both = condensed(BLOCK, 0.3).both_sides(2)
    turned = np.arange(8).reshape(4, 2)[::-1].ravel()
    np.testing.assert_allclose(both, both.T, rtol=1e-10)
    np.testing.assert_allclose(both, both[np.ix_(turned, turned)], rtol=1e-12)
    quarter = condensed(BLOCK, 0.3)
    even = np.arange(1.0, 5.0)
    pressure = np.concatenate([even.reshape(2, 2)[::-1].ravel(), even])
    np.testing.assert_allclose((both @ pressure)[4:], quarter.symmetric @ even, rtol=1e-10)
    pressure[:4] *= -1
    np.testing.assert_allclose((both @ pressure)[4:], quarter.antisymmetric @ even, rtol=1e-10)


def block(cells, breadth, length, depth):
    """Elements under the cells, coarser beyond them."""
    x, y = cells.x, cells.y[cells.shape[0] // 2 :]
    beside = x[-1] + graded(breadth - x[-1], x[-1] - x[-2], 2.0, np.inf)[1:]
    if length / 2 > y[-1]:
        y = np.append(y, y[-1] + graded(length / 2 - y[-1], y[-1] - y[-2], 2.0, np.inf)[1:])
    grid = np.append(x, beside), y, graded(depth, x[1], 2.0, np.inf)
    return BrickGrid(*grid, (cells.shape[1], cells.shape[0] // 2))


def pressed(cells, grid, gap, force, **ends):
    """Contact of two equal blocks of steel."""
    compliance = condensed(grid, STEEL.poisson, **ends).both_sides(cells.shape[1])
    return length_contact.solve(cells, 2 * compliance / STEEL.modulus, gap, force)


@pytest.mark.slow
def test_sphere_of_hertz():
    radius, force = 10e-3, 100.0
    half_width = np.cbrt(1.5 * force * radius / STEEL.plane_strain_modulus)
    p0 = 1.5 * force / (np.pi * half_width**2)
    edges = half_width / 8 * np.arange(-10, 11)
    cells = PressureCells(edges[10:], edges)
    body = FiniteBody(STEEL, np.inf, BodyEnd(), 1.0)
    gap = cells.integrated_gap(FinitePair((body, body), 1 / radius, CircularCrown(radius)))
    size = 40 * half_width
    contact = pressed(cells, block(cells, size, 2 * size, size), gap, force)
    assert contact.greatest[0] == pytest.approx(p0, rel=5e-3)
    np.testing.assert_allclose(
        contact.pressure[0], contact.pressure[0, ::-1], atol=1e-10 * contact.greatest[0]
    )
    assert abs(contact.force[0] / force - 1) < 1e-10
    assert abs(contact.moment[0]) < 1e-10 * force * half_width


def test_slice_with_held_ends_is_plane_strain():
    load, radius = 200e3, 5.714e-3
    half_width = np.sqrt(8 * load * radius / (np.pi * STEEL.plane_strain_modulus))
    p0 = 2 * load / (np.pi * half_width)
    cells = PressureCells(half_width / 8 * np.arange(11), half_width * np.array([-1.0, 0.0, 1.0]))
    body = FiniteBody(STEEL, 2 * half_width, BodyEnd(), 1.0)
    gap = cells.integrated_gap(FinitePair((body, body), 1 / radius, Straight()))
    grid = block(cells, 100 * half_width, 2 * half_width, 100 * half_width)
    contact = pressed(cells, grid, gap, load * 2 * half_width, free_ends=False)
    np.testing.assert_allclose(contact.centre, p0, rtol=2e-3)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"x": np.array([0.1, 1.0])}, "grid.x"),
        ({"y": np.array([0.0, 1.0, 1.0])}, "grid.y"),
        ({"z": np.array([0.0])}, "grid.z"),
        ({"cells": (4, 1)}, "grid.cells"),
    ],
)
def test_bad_grids_are_named(change, field):
    sizes = {"x": BLOCK.x, "y": BLOCK.y, "z": BLOCK.z, "cells": BLOCK.cells}
    with pytest.raises(InputError, match=field):
        BrickGrid(**(sizes | change))
