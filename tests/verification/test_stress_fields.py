"""Stress field over the turn, bushes and the view of a turn, against the cycle they show."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.meshes.mesh_files import UNITS
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.body_compliance import hertz_stress
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import StressRecovery
from camwright.pipeline.contact.elasticity.halfplane import point_force_stress
from camwright.pipeline.contact.pin_in_hole import peak_pressure
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.guide_pressure import bore_pressure, guide_arrays, loaded_length
from camwright.pipeline.cycle.part_loads import guide_bodies
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.follower.guide_reactions import lobatto
from camwright.pipeline.results.contact_zone import zone_places, zone_triangles
from camwright.pipeline.results.field_file import ZONE, read_series
from camwright.pipeline.results.field_output import (
    FIELDS,
    VIEW,
    Shown,
    bore_reach,
    shown_positions,
    turn_view,
    write_stress,
)
from camwright.pipeline.results.stress_fields import TurnFields

POSITIONS = 12


@pytest.fixture(scope="module")
def series(tmp_path_factory: pytest.TempPathFactory):
    case = parse_case(small_machine("series")).with_positions(72)
    theta = uniform_turn(360)
    contour = case.contour(Lift(theta, 0.006 * (1 - np.cos(theta))))
    turn = turns_of(machines(case), contour, POSITIONS)[0]
    pair = contact_pair(turn.machine, contour)
    bodies = CycleBodies.meshed(pair)
    contact = two_scale_history(pair, bodies, turn.theta, turn.loads.normal_force)
    cycle = Cycle(turn, contour, pair, bodies, contact)
    path = tmp_path_factory.mktemp("fields") / "stress.vtkhdf"
    write_stress(path, TurnFields(pair, bodies, cycle), np.arange(POSITIONS))
    return read_series(path), pair, bodies, cycle


def test_times_are_the_cam_angles_without_round_off(series) -> None:
    file, *_ = series
    assert file.times.tolist() == [30.0 * k for k in range(POSITIONS)]
    assert file.notes["cam_angle_deg"].tolist() == file.times.tolist()
    assert {name.decode() for name in file.notes["load_case"]} == {series[-1].load_case}
    assert set(file.notes[UNITS]) == {1.0} and "mm_N_MPa" in UNITS


def test_every_block_has_the_same_fields(series) -> None:
    blocks = series[0].step(3)
    assert list(blocks) == ["cam", "roller", "cam" + ZONE, "roller" + ZONE]
    for step in blocks.values():
        assert {n: int(np.prod(v.shape[1:])) for n, v in step.data.items()} == FIELDS


def test_greatest_von_mises_stress_of_the_cam_is_that_of_the_record(series) -> None:
    file, *_, cycle = series
    for k, listed in enumerate(1e-6 * cycle.contact.von_mises):
        blocks = file.step(k)
        shown = [blocks["cam"].data["von_mises_MPa"][visible(blocks["cam"])]]
        peak = max(v.max() for v in (*shown, blocks["cam" + ZONE].data["von_mises_MPa"]))
        # nodes 0.07 half-widths apart beside a maximum fitted between nodes
        assert peak == pytest.approx(listed, rel=1e-3)


def visible(step) -> np.ndarray:
    """Nodes of triangles that are not hidden."""
    return np.unique(step.triangles[:, ~step.hidden])


def test_field_is_that_of_the_certificate(series) -> None:
    """The whole contact by finite elements on its own fine mesh, against the nodes of the file."""
    file, pair, _, cycle = series
    k = int(cycle.contact.p0.argmax())
    solved = solve_pair(pair, float(cycle.theta[k]), float(cycle.loads.normal_force[k]))
    blocks, half_width = file.step(k), file.notes["half_width_mm"][k]
    for name, side, displacement in zip(
        ("cam", "roller"), solved.sides, solved.solution.displacements, strict=True
    ):
        body = side.body
        recovery = StressRecovery(body, np.arange(body.mesh.triangles.shape[1]))
        nodal = recovery(displacement[:, :, None])[:, :, 0]
        mises = 1e-6 * plane_stress_measures.von_mises(nodal, body.poisson)
        at = 1e3 * body.mesh.points[:, recovery.nodes]
        fine = blocks[name + ZONE]
        away = np.hypot(*(at - fine.points[:, :1]))
        near = np.flatnonzero((away > 0.3 * half_width) & (away < 1.4 * half_width))[::7]
        apart = np.hypot(*(fine.points[:, :, None] - at[:, None, near]))
        nearest, weight = apart.argmin(axis=0), apart.min(axis=0) < 0.03 * half_width
        # a thirtieth of a half-width aside, and 8 elements across it in the certificate
        shown = fine.data["von_mises_MPa"][nearest[weight]]
        np.testing.assert_allclose(shown, mises[near[weight]], atol=0.06 * mises.max())
        assert weight.sum() > 20


def test_displaced_surfaces_touch(series) -> None:
    """The follower moves by the approach: closed along the contact, at any enlargement."""
    file, *_ = series
    for k in np.flatnonzero(file.notes["line_load_N_per_mm"] > 0):
        blocks = file.step(k)
        normal = np.array([file.notes["normal_x"][k], file.notes["normal_y"][k]])
        cam, roller = (
            np.array([s.points[:, 0], s.data["displacement_mm"][0, :2]])
            for s in (blocks["cam" + ZONE], blocks["roller" + ZONE])
        )
        together = float((cam[1] - roller[1]) @ normal)
        along = blocks["roller"].data["displacement_mm"][:, :2] @ normal
        assert along.min() < 0  # towards the cam
        approach = -along.min()
        # digits of point data, and of points in single precision
        assert abs(together) < 2e-5 * approach
        assert abs((roller[0] - cam[0]) @ normal) < 1e-5


def test_displaced_surfaces_coincide_along_the_contact(series) -> None:
    file, *_ = series
    k = int(np.argmax(file.notes["p0_hertz_MPa"]))
    blocks, half_width = file.step(k), file.notes["half_width_hertz_mm"][k]
    contact = np.array([file.notes[f"contact_{c}_mm"][k] for c in "xy"])
    normal = np.array([file.notes[f"normal_{c}"][k] for c in "xy"])
    heights = []
    for name in ("cam", "roller"):
        fine = blocks[name + ZONE]
        displaced = fine.points + fine.data["displacement_mm"].T[:2] - contact[:, None]
        along = displaced[0] * normal[1] - displaced[1] * normal[0]
        surface = np.flatnonzero(np.arange(along.size) % 33 <= 1)  # both ends of each ring
        order = surface[np.argsort(along[surface])]
        inside = np.linspace(-0.9, 0.9, 19) * half_width
        heights.append(np.interp(inside, along[order], normal @ displaced[:, order]))
    depth = half_width**2 * 0.5 * (1 / 8.0)
    # Hertz pressure on real bodies: their bending is corrected, the pressure is not
    np.testing.assert_allclose(heights[0], heights[1], atol=0.05 * depth)


def test_pressure_presses_on_the_roller(series) -> None:
    file, *_, cycle = series
    for k in np.flatnonzero(cycle.contact.line_load > 0):
        fine = file.step(k)["roller" + ZONE]
        normal = np.array([file.notes["normal_x"][k], file.notes["normal_y"][k]])
        xx, yy, _, xy, yz, xz = fine.data["stress_MPa"][0]
        pressed = normal @ np.array([[xx, xy], [xy, yy]]) @ normal
        assert yz == xz == 0.0
        # the pressure there, but for the small stress by which a real roller differs
        assert pressed == pytest.approx(-1e-6 * cycle.contact.p0_hertz[k], rel=1e-2)


def test_fine_mesh_replaces_the_hidden_elements(series) -> None:
    file, *_ = series
    for step in (0, 5):
        blocks = file.step(step)
        for name in ("cam", "roller"):
            whole, fine = blocks[name], blocks[name + ZONE]
            assert whole.hidden.any() and not fine.hidden.any()
            away = np.hypot(*(whole.points - fine.points[:, :1]))
            reach = np.hypot(*(fine.points - fine.points[:, :1])).max()
            assert away[whole.triangles[:, whole.hidden]].max() < 1.01 * reach
            assert whole.hidden[(away[whole.triangles] < 0.3 * reach).any(axis=0)].all()


def test_triangles_of_the_zone_fill_a_half_disc_once() -> None:
    places = zone_places(np.ones(1), np.full(1, 12.0))[:, :, 0] * np.array([[1.0], [-1.0]])
    a, b, c = (places[:, corner] for corner in zone_triangles())
    areas = 0.5 * ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    assert areas.min() > 0
    # a polygon of 32 sides
    assert areas.sum() == pytest.approx(16 * 12.0**2 * np.sin(np.pi / 32), rel=1e-12)


def test_concave_flank_is_free_of_traction() -> None:
    """Above the tangent the half-plane's field continues: with its correction, a free surface."""
    places = np.array([[3.0, -8.0, 30.0], [-0.2, -1.0, -4.0]])
    at, up = np.zeros((2, 1)), np.array([[0.0], [1.0]])
    stress = hertz_stress(places * np.array([[1.0], [-1.0]]), at, up, np.array([0.01]))[:, :, 0]
    flamant = point_force_stress(*places) * np.array([[1.0], [1.0], [-1.0]])
    # a point force in place of the ellipse: half-width over distance, squared
    np.testing.assert_allclose(stress, flamant, rtol=1e-3, atol=1e-7)


def test_shown_cam_angles() -> None:
    class Contact:
        p0_hertz = np.arange(720.0)

    class Turn:
        theta, contact = uniform_turn(720), Contact

    def angles(shown: Shown) -> list[float]:
        return list(0.5 * shown_positions(Turn, shown, [475, 10, 475]))

    assert angles(Shown.WORST) == [359.5]
    assert angles(Shown.DEFAULT) == sorted([*np.arange(0, 360, 15.0), 5.0, 237.5, 359.5])
    assert angles(Shown.ALL) == list(np.arange(0, 360, 0.5))


def test_file_has_the_same_bytes_again(series, tmp_path) -> None:
    _, pair, bodies, cycle = series
    for name in ("a", "b"):
        write_stress(tmp_path / name, TurnFields(pair, bodies, cycle), np.array([2, 7]))
    first, second = (hashlib.sha256((tmp_path / n).read_bytes()).digest() for n in "ab")
    assert first == second


def test_positions_without_load_or_without_a_patch_have_a_field(series, tmp_path) -> None:
    file, pair, bodies, cycle = series
    contact = cycle.contact
    load, size, pressure = (
        v.copy() for v in (contact.line_load, contact.half_width_hertz, contact.pressure)
    )
    load[3] = size[3] = pressure[3] = 0.0
    pressure[4] = np.nan
    changed = replace(contact, line_load=load, half_width_hertz=size, pressure=pressure)
    fields = TurnFields(pair, bodies, replace(cycle, contact=changed))
    write_stress(tmp_path / "x.vtkhdf", fields, np.array([3, 4]))
    written = read_series(tmp_path / "x.vtkhdf")
    for step in written.step(0).values():
        assert not any(values.any() for values in step.data.values())
    closed, whole = (f["cam" + ZONE].data["von_mises_MPa"] for f in (written.step(1), file.step(4)))
    # Hertz in closed form instead of the finite-element patch
    assert closed.max() == pytest.approx(whole.max(), rel=2e-2)


def test_vtk_reads_every_step_by_name(series) -> None:
    import pyvista

    file, *_ = series
    reader = pyvista.get_reader(str(file.path)).reader
    for k in (0, POSITIONS - 1):
        reader.SetStep(k)
        reader.Update()
        grid = pyvista.wrap(reader.GetOutputDataObject(0))
        assert grid.field_data["cam_angle_deg"][0] == file.times[k]
        assert grid.field_data["load_case"][0] == series[-1].load_case
        for name, step in file.step(k).items():
            block = grid[name][0]
            assert set(block.celltypes) == {pyvista.CellType.TRIANGLE}
            np.testing.assert_allclose(block.points[:, :2], step.points.T, rtol=1e-6)
            for field, components in FIELDS.items():
                assert block[field].size == components * block.n_points
                np.testing.assert_allclose(block[field], step.data[field], rtol=1e-6)
            assert (block["vtkGhostType"] > 0).sum() == step.hidden.sum()


@pytest.mark.slow
def test_script_draws_the_nearest_cam_angle(series, tmp_path) -> None:
    file, *_ = series
    script = Path(sys.modules[TurnFields.__module__].__file__).parent / "templates" / VIEW
    (tmp_path / VIEW).write_bytes(script.read_bytes())
    (tmp_path / file.path.name).write_bytes(file.path.read_bytes())
    drawing = subprocess.run(
        [sys.executable, VIEW, "118", "picture.png"],
        cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False,
        env=os.environ | {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"},
    )  # fmt: skip
    if drawing.returncode < 0:
        pytest.skip("no OpenGL device")
    assert "cam angle 120 deg" in drawing.stdout, drawing.stderr
    assert (tmp_path / "picture.png").stat().st_size > 10_000


@pytest.fixture(scope="module")
def view(series):
    _, pair, bodies, cycle = series
    return turn_view(pair, bodies, cycle)


def test_view_of_the_turn_has_the_contour_and_the_bore(series, view) -> None:
    _, pair, _, cycle = series
    assert view["cycle_row"].tolist() == list(range(POSITIONS))
    surface, bore = np.moveaxis(view["cam_outline_mm"], -1, 0)
    np.testing.assert_allclose(surface[:, ::2], 1e3 * pair.contour.points(cycle.theta), rtol=1e-12)
    reach = bore_reach(pair.bore_radius, pair.keyway, np.arctan2(bore[1], bore[0]))
    np.testing.assert_allclose(np.hypot(*bore), 1e3 * reach, rtol=1e-12)
    np.testing.assert_allclose(surface[0] * bore[1], surface[1] * bore[0], atol=1e-9)  # one ray


def test_view_lays_the_follower_against_the_cam(series, view) -> None:
    _, pair, _, cycle = series
    centre = 1e-3 * view["follower_origin_mm"].T
    radius = pair.contour.roller_radius
    expected = pair.contour.points(cycle.theta) + radius * pair.contour.normal(cycle.theta)
    np.testing.assert_allclose(centre, expected, atol=1e-12)
    assert np.abs(np.hypot(*view["follower_nodes_mm"])).max() == pytest.approx(
        1e3 * radius, rel=1e-6
    )


def test_edge_of_bore_and_keyway() -> None:
    from cam_parts import Keyway

    angle = np.radians([0.0, 20.0, 90.0, 180.0])
    np.testing.assert_allclose(bore_reach(0.01, None, angle), 0.01)
    reach = bore_reach(0.01, Keyway(0.01, 0.003, np.pi), angle)
    np.testing.assert_allclose(reach, [0.01, 0.01, 0.01, 0.013])
    edge = np.pi - np.arctan2(0.005, 0.013)  # corner of the slot
    assert bore_reach(0.01, Keyway(0.01, 0.003, np.pi), np.array([edge]))[0] == pytest.approx(
        np.hypot(0.005, 0.013)
    )


@pytest.fixture(scope="module")
def bushes(series):
    return guide_arrays([series[-1]])


@pytest.mark.parametrize("side", ["A", "B"])
def test_pressure_in_a_bush_adds_up_to_the_reaction(series, bushes, side) -> None:
    cycle = series[-1]
    guides = cycle.guides
    along, line = (bushes[f"guide_{side}_{name}"] for name in ("position_mm", "line_load_N_per_mm"))
    weights = lobatto(along.size)[1] * along.max()
    reaction = guides.reaction_a if side == "A" else -guides.reaction_b
    np.testing.assert_allclose(line @ weights, reaction, rtol=1e-9, atol=1e-9)
    # Round the bore: what presses along the line of action is the push of the slice.
    angle, row = (
        np.radians(bushes[f"guide_{side}_bore_angle_deg"]),
        int(bushes[f"guide_{side}_worst_row"]),
    )
    pressure, slices = (
        bushes[f"guide_{side}_{name}"] for name in ("bore_pressure_MPa", "slice_position_mm")
    )
    force = np.trapezoid(pressure * np.cos(angle), angle, axis=1)
    force *= 0.5e3 * cycle.machine.stem.diameter
    pushes = np.interp(slices, along, line[row])
    # loads between those solved, straight lines between angles: less than 1 % together
    np.testing.assert_allclose(force, pushes, rtol=0.01, atol=1e-3 * np.abs(line).max())
    assert np.abs(line).max() == np.abs(line[row]).max() == np.abs(pushes).max()


def test_pressure_in_a_bush_is_that_of_a_pin_in_its_hole(series) -> None:
    machine = series[-1].machine
    guide, pushes = machine.guides.a, np.array([-3e3, 0.0, 5e2, 2.2e4, 7e4])
    pressure = bore_pressure(machine, guide, pushes)
    assert not pressure[1].any()
    assert pressure[0].argmax() == 0 and pressure[4].argmax() == pressure.shape[1] // 2
    pin, bush = guide_bodies(machine, guide)
    radius, clearance = 0.5 * machine.stem.diameter, 0.5 * guide.clearance
    peak, _ = peak_pressure(np.abs(pushes), radius, clearance, pin, bush)
    np.testing.assert_allclose(pressure.max(axis=1), peak, rtol=0.01)


def test_slices_cover_what_is_loaded_and_its_neighbours() -> None:
    knots = np.linspace(-1.0, 1.0, 9)
    assert loaded_length(knots, np.eye(9)[0])[[0, -1]].tolist() == [-1.0, -0.75]
    assert loaded_length(knots, np.eye(9)[4])[[0, -1]].tolist() == [-0.25, 0.25]
    assert loaded_length(knots, np.zeros(9))[[0, -1]].tolist() == [-1.0, 1.0]
