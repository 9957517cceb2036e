"""Mesh and field files, read back by the programs they are for."""

import meshio
import numpy as np
import pytest

from camwright.geometry.errors import MeshError, ResultError
from camwright.meshes.body_mesh import block_mesh, roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.meshes.gmsh_mesher import session
from camwright.meshes.mesh_files import write_msh, write_vtu
from camwright.meshes.vtu import QUADRATIC_TRIANGLE, VtuGrid, vtu


@pytest.fixture(scope="module")
def bodies():
    return {
        "cam": block_mesh(0.02, 0.01, ElementSize(far_size=2e-3)),
        "roller": roller_mesh(0.008, 0.003, 0.0, ElementSize(far_size=2e-3)),
    }


def test_gmsh_reads_names_and_second_order_back(tmp_path, bodies):
    write_msh(tmp_path / "mesh.msh", bodies)
    with session() as gmsh:
        gmsh.open(str(tmp_path / "mesh.msh"))
        nodes = {
            gmsh.model.getPhysicalName(*group): gmsh.model.mesh.getNodesForPhysicalGroup(*group)[1]
            for group in gmsh.model.getPhysicalGroups()
        }
        kinds = set(gmsh.model.mesh.getElementTypes())
        triangles, _ = gmsh.model.mesh.getElementsByType(9)
        worst = min(gmsh.model.mesh.getElementQualities(triangles, "minSJ"))
    assert kinds == {8, 9}  # three-node lines, six-node triangles
    assert worst > 0
    assert set(nodes) == {
        *("cam", "cam_top", "cam_bottom", "cam_left", "cam_right"),
        *("roller", "roller_rim", "roller_hub"),
    }
    for body, mesh in bodies.items():
        assert nodes[body].size == 3 * mesh.points.shape[1]
        for name in mesh.boundaries:
            x, y, z = nodes[f"{body}_{name}"].reshape(-1, 3).T
            found = np.sort(x + 1j * y)
            expected = np.sort([1, 1j] @ mesh.points[:, mesh.boundary_nodes(name)]) * 1e3
            np.testing.assert_allclose(found, expected, atol=1e-12)
            assert not z.any()


def test_msh_is_format_4_1_and_repeats_bit_for_bit(tmp_path, bodies):
    write_msh(tmp_path / "a.msh", bodies)
    write_msh(tmp_path / "b.msh", bodies)
    text = (tmp_path / "a.msh").read_bytes()
    assert text.startswith(b"$MeshFormat\n4.1 0 8\n")
    assert text == (tmp_path / "b.msh").read_bytes()
    nodes = sum(mesh.points.shape[1] for mesh in bodies.values())
    entities = sum(1 + len(mesh.boundaries) for mesh in bodies.values())
    assert f"$Nodes\n{entities} {nodes} 1 {nodes}\n".encode() in text  # each node once


def test_vtu_keeps_fields_units_and_curved_triangles(tmp_path, bodies):
    mesh = bodies["roller"]
    fields = {"displacement_mm": 2 * mesh.points, "von_mises_MPa": mesh.points[0]}
    write_vtu(tmp_path / "field.vtu", {"roller": mesh}, {"roller": fields})
    grid = meshio.read(tmp_path / "field.vtu")
    np.testing.assert_allclose(grid.points[:, :2].T, mesh.points * 1e3, rtol=1e-15)
    assert np.array_equal(grid.cells_dict["triangle6"].T, mesh.triangles)
    np.testing.assert_array_equal(
        grid.point_data["displacement_mm"][:, :2].T, fields["displacement_mm"]
    )
    assert grid.point_data["displacement_mm"].shape[1] == 3
    np.testing.assert_array_equal(grid.point_data["von_mises_MPa"], mesh.points[0])


def test_vtu_joins_bodies_and_numbers_them(tmp_path, bodies):
    data = {name: {"x_m": mesh.points[0]} for name, mesh in bodies.items()}
    write_vtu(tmp_path / "both.vtu", bodies, data)
    grid = meshio.read(tmp_path / "both.vtu")
    first = bodies["cam"].points.shape[1]
    assert (grid.point_data["body"] == (np.arange(len(grid.points)) >= first)).all()
    np.testing.assert_allclose(grid.point_data["x_m"] * 1e3, grid.points[:, 0], rtol=1e-14)
    triangles = grid.cells_dict["triangle6"]
    assert (grid.cell_data["body"][0] == grid.point_data["body"][triangles].T).all()


def test_vtu_carries_numbers_of_the_whole(tmp_path, bodies):
    import pyvista

    values = {"cam_angle_deg": 12.5, 'p0 "idle" <MPa>': 1234.5678901234567}
    write_vtu(tmp_path / "field.vtu", {"cam": bodies["cam"]}, field_data=values)
    grid = pyvista.read(tmp_path / "field.vtu")
    assert {name: grid.field_data[name][0] for name in values} == values
    assert set(grid.celltypes) == {22}  # VTK_QUADRATIC_TRIANGLE
    again = meshio.read(tmp_path / "field.vtu")
    assert {name: again.field_data[name][0] for name in values} == values


@pytest.mark.parametrize("values", [8192, 8193, 20000])
def test_vtu_keeps_what_fills_one_block_or_many(tmp_path, values):
    """VTK packs 64 KiB at a time: 8192 numbers fill a block to the last byte."""
    import pyvista

    rng = np.random.default_rng(7)
    points = rng.random((values, 3))
    field = np.r_[np.nan, np.inf, rng.standard_normal(values - 2)]
    cells = np.arange(values // 6 * 6).reshape(-1, 6)
    grid = VtuGrid(points, cells, QUADRATIC_TRIANGLE, {"x": field}, {}, {})
    path = tmp_path / "big.vtu"
    path.write_bytes(vtu(grid))
    for read in (meshio.read(path), pyvista.read(path)):
        np.testing.assert_array_equal(read.points, points)
        np.testing.assert_array_equal(read.point_data["x"], field)
        np.testing.assert_array_equal(next(iter(read.cells_dict.values())), cells)


def test_vtu_refuses_a_field_that_does_not_fit(tmp_path, bodies):
    with pytest.raises(MeshError, match="field 'p_MPa'"):
        write_vtu(tmp_path / "bad.vtu", {"cam": bodies["cam"]}, {"cam": {"p_MPa": np.zeros(3)}})
    with pytest.raises(MeshError, match="fields of bodies"):
        write_vtu(tmp_path / "bad.vtu", bodies, {"cam": {}})
    with pytest.raises(MeshError, match="fields of 'roller'"):
        write_vtu(
            tmp_path / "bad.vtu",
            bodies,
            {"cam": {"x_m": bodies["cam"].points[0]}, "roller": {}},
        )
    assert not list(tmp_path.iterdir())


def write_each(path, bodies):
    return {
        ".msh": lambda: write_msh(path, bodies),
        ".vtu": lambda: write_vtu(path, bodies),
    }[path.suffix]


@pytest.mark.parametrize("suffix", [".msh", ".vtu"])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path, bodies, suffix, monkeypatch):
    path = tmp_path / f"old{suffix}"
    path.write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(ResultError, match="No space left"):
        write_each(path, bodies)()
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", [".msh", ".vtu"])
def test_a_missing_folder_is_named(tmp_path, bodies, suffix):
    with pytest.raises(ResultError, match=r"nowhere.*No such file"):
        write_each(tmp_path / "nowhere" / f"x{suffix}", bodies)()


@pytest.mark.parametrize("suffix", [".msh", ".vtu"])
def test_a_full_disk_is_noticed(tmp_path, bodies, suffix):
    """A limit on the size of files stands in for the disk; gmsh itself would not complain."""
    resource = pytest.importorskip("resource")
    path = tmp_path / f"old{suffix}"
    path.write_text("old")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8192, hard))
    try:
        with pytest.raises(ResultError, match=path.name):
            write_each(path, bodies)()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
