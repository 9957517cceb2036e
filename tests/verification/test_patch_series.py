"""Series of patch and bodies, bushes and the view of a turn: they say what the cycle found."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import meshio
import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.meshes.mesh_files import UNITS
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.template import template
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.pin_in_hole import peak_pressure
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.guide_pressure import bore_pressure, guide_arrays, loaded_length
from camwright.pipeline.cycle.part_loads import guide_bodies
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.follower.guide_reactions import lobatto
from camwright.pipeline.results.contact_patch_series import (
    INDEX,
    patch_mesh,
    patch_stress,
    write_patches,
)
from camwright.pipeline.results.field_output import shown_positions
from camwright.pipeline.results.recorded_turn import bore_reach, turn_view
from camwright.pipeline.results.stress_fields import facing, write_bodies

POSITIONS = 12


@pytest.fixture(scope="module")
def series(tmp_path_factory: pytest.TempPathFactory):
    case = parse_case(template("series")).with_positions(72)
    theta = uniform_turn(360)
    contour = case.contour(Lift(theta, 0.006 * (1 - np.cos(theta))))
    turn = turns_of(machines(case), contour, case, {}, POSITIONS)[0]
    pair = contact_pair(turn.machine, contour)
    bodies = CycleBodies.meshed(pair)
    contact = two_scale_history(pair, bodies, turn.theta, turn.loads.normal_force)
    cycle = Cycle(turn, contour, pair, bodies, contact)
    folder = tmp_path_factory.mktemp("fields")
    return folder, write_patches(folder, pair, bodies, cycle, 1), pair, bodies, cycle


def test_series_has_as_many_steps_as_the_cycle_has_positions(series) -> None:
    folder, index, _, _, cycle = series
    assert index == folder / INDEX
    sets = ET.parse(index).getroot().findall("Collection/DataSet")
    times = [float(entry.get("timestep")) for entry in sets]
    np.testing.assert_allclose(times, np.degrees(cycle.theta), atol=1e-12)
    assert all((folder / entry.get("file")).is_file() for entry in sets)


def test_fields_read_back_are_those_of_the_cycle(series) -> None:
    folder, index, pair, bodies, cycle = series
    found = patch_stress(pair, bodies, cycle, slice(None))
    peaks = contact_patch(pair.cam.poisson).peaks
    mises = peaks(plane_stress_measures.von_mises(found, pair.cam.poisson))[0]
    # the very stress from which the cycle read its peaks, one summation order apart
    np.testing.assert_allclose(mises, cycle.contact.von_mises, rtol=1e-12)
    sets = ET.parse(index).getroot().findall("Collection/DataSet")
    for k, entry in enumerate(sets):
        mesh = meshio.read(folder / entry.get("file"))
        assert [block.type for block in mesh.cells] == ["triangle6"]
        for row, name in enumerate(("stress_along_MPa", "stress_into_depth_MPa", "shear_MPa")):
            np.testing.assert_allclose(mesh.point_data[name], found[row, :, k] / 1e6, rtol=1e-14)


def test_patch_lies_under_the_roller_at_its_size(series) -> None:
    folder, index, pair, _, cycle = series
    first = ET.parse(index).getroot().find("Collection/DataSet")
    points = meshio.read(folder / first.get("file")).points[:, :2].T * 1e-3
    at, normal = pair.contour.points(cycle.theta[0]), pair.contour.normal(cycle.theta[0])
    height = normal @ (points - at[:, None])
    half = cycle.contact.half_width_hertz[0]
    assert height.max() == pytest.approx(0.0, abs=1e-12)
    assert -2.0 * half < height.min() < -1.5 * half


def test_file_states_units_and_angle(series) -> None:
    import pyvista as pv

    folder, index, *_ = series
    first = ET.parse(index).getroot().find("Collection/DataSet")
    grid = pv.read(folder / first.get("file"))
    assert UNITS in grid.field_data and "mm_N_MPa" in UNITS
    assert float(grid.field_data["cam_angle_deg"][0]) == 0.0


def test_triangles_of_the_patch_fill_it_once() -> None:
    points, triangles = patch_mesh(0.3)
    a, b, c = (points[:, triangles[k]] * np.array([[1.0], [-1.0]]) for k in (0, 1, 2))
    areas = 0.5 * ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    assert areas.min() > 0
    half_disc = 0.5 * np.pi * 1.6**2
    # whole elements reach past 1.6 by half of their 0.07 on average
    assert half_disc < areas.sum() < 1.05 * half_disc


def sets_of(index) -> list[tuple[float, str]]:
    found = ET.parse(index).getroot().findall("Collection/DataSet")
    return [(float(entry.get("timestep")), entry.get("file")) for entry in found]


@pytest.fixture(scope="module")
def body_series(series):
    folder, _, pair, bodies, cycle = series
    indices = shown_positions(cycle, [7])
    return indices, write_bodies(folder, pair, bodies, cycle, indices, 1)


def test_bodies_are_shown_every_five_degrees_and_where_certified() -> None:
    class Turn:
        theta = uniform_turn(720)

    shown = 0.5 * shown_positions(Turn, [475, 10, 475])
    assert shown.tolist() == sorted([*np.arange(0, 360, 5.0), 237.5])


def test_fields_of_the_bodies_read_back_to_the_last_bit(series, body_series) -> None:
    folder, _, pair, bodies, cycle = series
    indices, index = body_series
    theta, contact = cycle.theta[indices], cycle.contact
    load = contact.line_load[indices], contact.half_width_hertz[indices]
    moved, nodal = bodies.cam.fields(pair.contour.points(theta), pair.contour.normal(theta), *load)
    _, own = bodies.follower.fields(*facing(pair, theta), *load)
    count = moved.shape[1]
    for k, (angle, name) in enumerate(sets_of(index)):
        mesh = meshio.read(folder / name)
        data = mesh.point_data
        assert angle == np.degrees(theta[k]) == mesh.field_data["cam_angle_deg"][0]
        assert [block.type for block in mesh.cells] == ["triangle6"]
        np.testing.assert_allclose(
            data["displacement_mm"][:count, :2].T, 1e3 * moved[:, :, k], rtol=1e-14
        )
        for row, component in enumerate(("xx", "yy", "xy")):
            cam = data[f"stress_{component}_MPa"][:count]
            np.testing.assert_allclose(cam, 1e-6 * nodal[row, :, k], rtol=1e-14)
        # the same stress in other axes; turning them costs a few bits
        mises = 1e-6 * plane_stress_measures.von_mises(own[:, :, k], pair.follower.material.poisson)
        np.testing.assert_allclose(data["von_mises_MPa"][count:], mises, rtol=1e-9, atol=1e-9)


def test_paraviews_own_reader_finds_every_step_and_its_names(series, body_series) -> None:
    import pyvista

    for index, count in ((body_series[1], body_series[0].size), (series[1], POSITIONS)):
        reader = pyvista.PVDReader(index)
        assert len(reader.time_values) == count
        reader.set_active_time_value(reader.time_values[-1])
        grid = reader.read()[0]
        assert set(grid.celltypes) == {pyvista.CellType.QUADRATIC_TRIANGLE}
        assert grid.field_data["cam_angle_deg"][0] == reader.time_values[-1]
        assert UNITS in grid.field_data and "von_mises_MPa" in grid.point_data


def test_the_roller_touches_the_cam_and_is_pressed_there(series, body_series) -> None:
    folder, _, _, bodies, cycle = series
    indices, index = body_series
    count = bodies.cam.body.mesh.points.shape[1]
    for k, (_, name) in zip(indices, sets_of(index), strict=True):
        mesh = meshio.read(folder / name)
        notes = {key: value[0] for key, value in mesh.field_data.items()}
        contact = np.array([notes["contact_x_mm"], notes["contact_y_mm"]])
        normal = np.array([notes["normal_x"], notes["normal_y"]])
        away = np.hypot(*(mesh.points[count:, :2] - contact).T)
        touching = count + int(away.argmin())
        assert away.min() < 1e-9
        xx, yy, xy = (mesh.point_data[f"stress_{c}_MPa"][touching] for c in ("xx", "yy", "xy"))
        pressed = normal @ np.array([[xx, xy], [xy, yy]]) @ normal
        # the pressure there, but for the small stress by which a real roller differs
        assert pressed == pytest.approx(-1e-6 * cycle.contact.p0_hertz[k], rel=5e-3)


def test_a_body_without_load_is_at_rest(series) -> None:
    _, _, pair, bodies, cycle = series
    theta = cycle.theta[:2]
    at, normal = pair.contour.points(theta), pair.contour.normal(theta)
    loaded = np.array([0.0, 1e5]), np.array([0.0, 1e-4])
    moved, nodal = bodies.cam.fields(at, normal, *loaded)
    assert not moved[:, :, 0].any() and not nodal[:, :, 0].any()
    assert np.isfinite(nodal).all() and nodal[:, :, 1].any()


@pytest.fixture(scope="module")
def view(series):
    _, _, pair, bodies, cycle = series
    return turn_view(pair, bodies, cycle)


def test_view_of_the_turn_has_the_contour_and_the_bore(series, view) -> None:
    _, _, pair, _, cycle = series
    assert view["position"].tolist() == list(range(POSITIONS))
    surface, bore = np.moveaxis(view["cam_mm"], -1, 0)
    np.testing.assert_allclose(surface[:, ::2], 1e3 * pair.contour.points(cycle.theta), rtol=1e-12)
    reach = bore_reach(pair.bore_radius, pair.keyway, np.arctan2(bore[1], bore[0]))
    np.testing.assert_allclose(np.hypot(*bore), 1e3 * reach, rtol=1e-12)
    np.testing.assert_allclose(surface[0] * bore[1], surface[1] * bore[0], atol=1e-9)  # one ray


def test_view_lays_the_follower_against_the_cam(series, view) -> None:
    _, _, pair, _, cycle = series
    centre = 1e-3 * view["follower_origin_mm"].T
    radius = pair.contour.roller_radius
    expected = pair.contour.points(cycle.theta) + radius * pair.contour.normal(cycle.theta)
    np.testing.assert_allclose(centre, expected, atol=1e-12)
    assert np.abs(np.hypot(*view["follower_mm"])).max() == pytest.approx(1e3 * radius, rel=1e-6)


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
    along, line = bushes[f"{side}_along_mm"], bushes[f"{side}_line_N_per_mm"]
    weights = lobatto(along.size)[1] * along.max()
    reaction = guides.reaction_a if side == "A" else -guides.reaction_b
    np.testing.assert_allclose(line @ weights, reaction, rtol=1e-9, atol=1e-9)
    # Round the bore: what presses along the line of action is the push of the slice.
    angle, row = np.radians(bushes[f"{side}_round_deg"]), int(bushes[f"{side}_row"])
    pressure, slices = bushes[f"{side}_pressure_MPa"], bushes[f"{side}_slices_mm"]
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
