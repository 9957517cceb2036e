"""Displacement and stress of a block under the pressure of a contact, and their file."""

from types import SimpleNamespace

import numpy as np
import pytest

from camwright.geometry.errors import ResultError
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.axial_drop import (
    BodyEnd,
    FiniteBody,
    FinitePair,
    Straight,
)
from camwright.pipeline.contact.finite_length.block_stress import block_field
from camwright.pipeline.contact.finite_length.brick_body import BrickGrid, condensed, displacement
from camwright.pipeline.contact.finite_length.length_tiers import (
    SIZES,
    block_compliance,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.pressure_cells import pressure_cells
from camwright.pipeline.contact.finite_length.subsurface_stress import stress_below
from camwright.pipeline.results.field_file import read_end_field
from camwright.pipeline.results.field_output import write_end_field

STEEL = Elastic(210e9, 0.3)
PAIR = FinitePair(
    (FiniteBody(STEEL, 3e-3, BodyEnd(), 2e-3), FiniteBody(STEEL, 2e-3, BodyEnd(), 2e-3)),
    175.0,
    Straight(),
)
FORCE, MOMENT = 400.0, 0.06
SERENDIPITY = np.array([[-1.0, 4.0, -1.0], [4.0, 0.0, 4.0], [-1.0, 4.0, -1.0]]) / 12.0


def test_displacement_integrates_to_the_compliance():
    x, y, z = (np.array(edges) for edges in (
        [0, 0.1, 0.25, 0.6, 2.0], [0, 0.5, 1.0, 1.3, 1.7], [0, 0.1, 0.4, 2.0],
    ))  # fmt: skip
    grid = BrickGrid(x, y, z, (2, 3))
    pressure = np.random.default_rng(7).random((2, 3, 2))
    fields, quarter = displacement(grid, 0.3, pressure), condensed(grid, 0.3)
    for field, load, matrix in zip(
        fields, pressure, (quarter.symmetric, quarter.antisymmetric), strict=True
    ):
        top = np.nan_to_num(field[:, :, 0, 2])
        integrals = [
            (x[i + 1] - x[i]) * (y[j + 1] - y[j])
            * (SERENDIPITY * top[2 * i : 2 * i + 3, 2 * j : 2 * j + 3]).sum()
            for j in range(3) for i in range(2)
        ]  # fmt: skip
        np.testing.assert_allclose(integrals, matrix @ load.ravel(), rtol=1e-11)
        assert (field[:, ::2, -1][~np.isnan(field[:, ::2, -1])] == 0).all()  # the base is held


@pytest.fixture(scope="module")
def contact():
    half_width, _ = plane_strain(PAIR, FORCE)
    cells = pressure_cells(PAIR, half_width, SIZES.coarser(1.5))
    matrix, _ = block_compliance(cells, PAIR.bodies)
    return length_contact.solve(cells, matrix, cells.integrated_gap(PAIR), FORCE, moment=MOMENT)


@pytest.fixture(scope="module")
def field(contact):
    return block_field(PAIR.bodies[1], contact)


def test_stress_carries_the_load(contact, field):
    x, y, z = (np.unique(axis) for axis in field.points.T)
    normal = field.stress[:, 2].reshape(x.size, y.size, z.size)[:, :, 3]
    along_y = np.trapezoid(normal, x, axis=0)
    assert -2.0 * np.trapezoid(along_y, y) == pytest.approx(FORCE, rel=0.01)
    assert -2.0 * np.trapezoid(along_y * y, y) == pytest.approx(MOMENT, rel=0.03)
    areas = np.diff(x)[:, None, None] * np.diff(y)[:, None] * np.ones(z.size - 1)
    assert 2.0 * (field.pressure * areas.ravel()).sum() == pytest.approx(FORCE, rel=1e-10)


def test_stress_below_the_middle_is_that_of_the_pressure_on_a_half_space(contact, field):
    half_width, p0 = plane_strain(PAIR, FORCE)
    middle = np.flatnonzero((field.points[:, 0] == 0) & (field.points[:, 1] == 0))
    surface = middle[field.points[middle, 2] == 0]
    assert field.stress[surface, 2] == pytest.approx(-contact.centre[0], rel=0.03)
    depth = field.points[middle, 2]
    near = middle[(depth > 0.2 * half_width) & (depth < half_width)]
    love = stress_below(contact.cells, contact.pressure[0], 0.3, np.zeros(1),
                        field.points[near, 2])[0]  # fmt: skip
    np.testing.assert_allclose(field.stress[near, 2], love[:, 2, 2], atol=0.04 * p0)
    free = np.abs(np.abs(field.points[:, 1]) - 1e-3) < 1e-12
    below = free & (field.points[:, 2] > half_width)
    assert np.abs(field.stress[below, 1]).max() < 0.05 * p0  # no load on the end faces


def test_file_has_both_bodies_on_either_side_of_the_contact(contact, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    load = SimpleNamespace(pair=PAIR, theta=0.5, force=FORCE, moment=MOMENT)
    point = SimpleNamespace(load=load, finite_elements=SimpleNamespace(coarser=contact))
    certificate = SimpleNamespace(points=(point,))
    trial = SimpleNamespace(solution=SimpleNamespace(length_certificate=certificate))
    write_end_field(tmp_path / "ends.vtu", trial)
    first = (tmp_path / "ends.vtu").read_bytes()
    grid = pyvista.read(tmp_path / "ends.vtu")
    assert grid.compute_cell_sizes()["Volume"].min() > 0
    top, below = grid.points[:, 2].max(), grid.points[:, 2].min()
    assert top == pytest.approx(-below) and top > 1.9
    pressed = grid["displacement_mm"][np.abs(grid.points).max(axis=1) < 1e-12, 2]
    assert pressed[0] < 0 < pressed[1]  # into the cam, into the follower
    assert grid["contact_pressure_MPa"].max() == pytest.approx(1e-6 * contact.pressure.max())
    assert set(np.unique(grid.cell_data["body"])) == {0, 1}
    assert grid["stress_MPa"].shape[1] == 6
    back = read_end_field(tmp_path / "ends.vtu")
    np.testing.assert_array_equal(back.points, grid.points)
    np.testing.assert_array_equal(back.cells.ravel(), grid.cells_dict[12].ravel())
    np.testing.assert_array_equal(back.von_mises, grid["von_mises_MPa"])
    np.testing.assert_array_equal(back.pressure, grid["contact_pressure_MPa"])
    np.testing.assert_array_equal(back.body, grid["body"])
    assert (back.force, back.moment) == (FORCE, 1e3 * MOMENT)
    for broken in (b"", b"<VTKFile>", first[:5000], first[:-5000]):
        (tmp_path / "broken.vtu").write_bytes(broken)
        with pytest.raises(ResultError, match=r"broken\.vtu"):
            read_end_field(tmp_path / "broken.vtu")
    write_end_field(tmp_path / "ends.vtu", trial)
    assert (tmp_path / "ends.vtu").read_bytes() == first
    for missing in (None, SimpleNamespace(points=())):
        bare = SimpleNamespace(solution=SimpleNamespace(length_certificate=missing))
        write_end_field(tmp_path / "none.vtu", bare)
    assert not (tmp_path / "none.vtu").exists()
