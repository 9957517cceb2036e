"""The series of the contact patch: a step per position, its peaks those of the cycle."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import meshio
import numpy as np
import pytest

from geometry.arrays import uniform_turn
from geometry.lift import Lift
from meshes.files import UNITS
from pipeline import trial as road
from pipeline.case import parse_case
from pipeline.case_template import template
from pipeline.contact import stress
from pipeline.contact.pair import CycleBodies, pair_history
from pipeline.contact.patch import contact_patch
from pipeline.cycle import contact_pair, finished
from pipeline.patch_series import INDEX, patch_mesh, patch_stress, write_patches

POSITIONS = 12


@pytest.fixture(scope="module")
def series(tmp_path_factory: pytest.TempPathFactory):
    case = parse_case(template("series")).with_positions(72)
    theta = uniform_turn(360)
    contour = road.cam_contour(case, Lift(theta, 0.006 * (1 - np.cos(theta))))
    given = road.turns_of(case, contour, {}, POSITIONS)[0]
    pair = contact_pair(case, contour)
    bodies = CycleBodies.meshed(pair)
    contact = pair_history(pair, bodies, given.theta, given.loads.normal_force)
    cycle = finished(case, contour, given, contact)
    folder = tmp_path_factory.mktemp("fields")
    return folder, write_patches(folder, pair, bodies, cycle), pair, bodies, cycle


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
    mises = peaks(stress.von_mises(found, pair.cam.poisson))[0]
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
    assert areas.sum() == pytest.approx(half_disc, rel=0.1)  # whole elements reach past 1.6
