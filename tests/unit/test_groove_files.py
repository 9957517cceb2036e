"""Files and drawings of a disc with a groove: both walls, solid, drawing, run folder."""

import csv
import json
from functools import cache
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from dxf_arcs import arc_points, away_from
from held_cams import volume_of

from camwright.geometry.arrays import rotation, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.form_closure import groove_wall
from camwright.geometry.measured_contour import inspected, real_contour
from camwright.meshes import step_solid
from camwright.meshes.step_solid import write_step
from camwright.meshes.step_text import PartTitle
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cam_balance import undrilled
from camwright.pipeline.hand_check.hand_sheet import SheetRun
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.workshop_files import measured_surface, outline_of, write_workshop
from camwright.pipeline.run import run_case
from camwright.reports.arrangement_data import arrangement_at, mechanism_of
from camwright.reports.report_data import read_material

FILE = Path(__file__).parents[2] / "cases" / "motions" / "feeder-groove.toml"


@cache
def feeder():
    case = read_case(FILE)
    return case, preview_case(case, corners=False).contour


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    folder, said = tmp_path_factory.mktemp("workshop"), []
    write_workshop(folder, *feeder(), said.append)
    assert said == []
    return folder


def rows(file: Path) -> dict[str, np.ndarray]:
    with file.open(encoding="utf-8") as text:
        table = list(csv.DictReader(text))
    return {name: np.array([float(row[name] or "nan") for row in table]) for name in table[0]}


@pytest.mark.parametrize(("end", "side"), [("", -1.0), ("_outer", 1.0)])
def test_tables_of_either_wall(workshop, end, side):
    """The walls are 23.51 mm from the path, normals point to it, the tool leaves 0.01 mm of it."""
    _, contour = feeder()
    points = rows(workshop / f"contour{end}.csv")
    theta = np.radians(points["cam_angle_deg"])
    path, normal = 1e3 * contour.pitch.points(theta), contour.pitch.normal(theta)
    wall = np.stack([points["x_mm"], points["y_mm"]])
    assert wall == pytest.approx(path + side * 23.51 * normal, abs=1e-9)
    own = np.stack([points["normal_x"], points["normal_y"]])
    assert own == pytest.approx(-side * normal, abs=1e-12)
    tool = rows(workshop / f"cutter{end}.csv")
    centre = np.stack([tool["x_mm"], tool["y_mm"]])
    assert centre == pytest.approx(path + side * 0.01 * normal, abs=1e-9)
    sheet = rows(workshop / f"inspection{end}.csv")
    assert np.hypot(sheet["nominal_x_mm"], sheet["nominal_y_mm"]) == pytest.approx(
        sheet["nominal_radius_mm"]
    )
    assert sheet["deviation_max_mm"] == pytest.approx(0.004)


@pytest.mark.parametrize("error", [1e-5, pytest.param(None, marks=pytest.mark.slow)])
def test_the_solid_has_the_mass_of_the_disc_less_its_groove(workshop, tmp_path, monkeypatch, error):
    """Walls within 10 um of the contours, and as written, within 10 nm: OpenCASCADE reads 5 s."""
    case, contour = feeder()
    solid = workshop / "cam.step"
    if error is not None:
        monkeypatch.setattr(step_solid, "_STEP_ERROR", error)
        solid = tmp_path / "cam.step"
        write_step(solid, outline_of(case, contour), case.cam.width, PartTitle("cam"))
    mass = undrilled(case.cam, contour).mass
    assert volume_of(solid) * case.cam.material.density == pytest.approx(mass, rel=5e-6)


def test_both_walls_and_the_circle_are_in_the_drawing_file(workshop):
    """Arcs within 1 um of the walls to be made, and areas by the closed form of their segments."""
    space = ezdxf.readfile(workshop / "contour.dxf").modelspace()
    lines = [each for each in space.query("LWPOLYLINE") if each.dxf.layer == "groove"]
    circles = [each.dxf.radius for each in space.query("CIRCLE") if each.dxf.layer == "cut"]
    assert circles == [125.0]
    areas = []
    for line in lines:
        x, y, bulge = np.array(line.get_points("xyb")).T
        to_x, to_y, half = np.roll(x, -1), np.roll(y, -1), 2.0 * np.arctan(bulge)
        chord, bent = np.hypot(to_x - x, to_y - y), np.abs(half) > 1e-12
        sine = np.where(bent, np.sin(half), 1.0)
        cap = np.where(bent, 0.25 * chord**2 * (half - np.sin(half) * np.cos(half)) / sine**2, 0.0)
        areas.append(0.5 * np.sum(x * to_y - to_x * y) + cap.sum())
    _, contour = feeder()
    walls = [groove_wall(contour, side, 23.51e-3) for side in ("inner", "outer")]
    assert areas == pytest.approx([1e6 * wall.area() for wall in walls], rel=2e-6)
    away = [away_from(wall, arc_points(line)) for wall, line in zip(walls, lines, strict=True)]
    assert max(away) < 1.001e-3  # mm, the error of the arcs


def test_dimensions_of_the_groove(workshop):
    record = json.loads((workshop / "dimensions.json").read_text(encoding="utf-8"))
    groove, (_, contour) = record["groove"], feeder()
    assert (groove["width_mm"], groove["depth_mm"]) == pytest.approx((47.02, 18.0))
    assert (groove["corner_radius_mm"], groove["outer_radius_mm"]) == pytest.approx((0.4, 125.0))
    at_zero = 1e3 * float(contour.pitch.radius_base)
    assert record["radii_mm"]["0"] == pytest.approx(at_zero - 23.51, abs=1e-3)
    assert groove["outer_radii_mm"]["0"] == pytest.approx(at_zero + 23.51, abs=1e-3)


@pytest.mark.parametrize("side", ["inner", "outer"])
def test_a_measured_wall_is_fitted_to_its_own_nominal(side):
    """A wave of 3 um, its size and its phase; the roller on it runs on the wave of its lift."""
    case, contour = feeder()
    wall, theta = measured_surface(case, contour, side), uniform_turn(720)
    wave = 5e-6 + 3e-6 * np.cos(4.0 * theta)
    points = rotation(0.01) @ (wall.points(theta) + wave * wall.normal(theta))
    fit = inspected(wall, points)
    # two equal strokes a turn: the phase is that of half a turn
    assert (fit.phase % np.pi, fit.size) == pytest.approx((0.01, 5e-6), abs=1e-6)
    assert fit.wave(4) == pytest.approx(3e-6, rel=0.2)
    real = real_contour(wall, fit)
    outwards = 1.0 if side == "inner" else -1.0
    height = real.pitch.height(theta) - contour.pitch.height(theta)
    along = outwards * fit.form(theta) / np.cos(contour.pitch.pressure_angle(theta))
    assert height == pytest.approx(along, abs=5e-8)


def test_only_a_groove_has_walls_to_measure():
    case, contour = feeder()
    with pytest.raises(InputError, match="--track = floor, must be inner or outer"):
        measured_surface(case, contour, "floor")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("groove") / "run"
    return run_case(read_case(FILE), folder, depth=Tier.PREVIEW, positions=72)


def test_the_run_folder_has_both_walls_and_says_which_carries(run):
    contour, cycle = run.final.contour, run.final.cycle
    outer = np.stack([contour["outer_x_mm"], contour["outer_y_mm"]])
    path = np.stack([contour["pitch_x_mm"], contour["pitch_y_mm"]])
    assert np.hypot(*(outer - path)) == pytest.approx(23.5, abs=1e-9)
    assert set(np.unique(cycle["wall"])) == {-1.0, 1.0}
    _, nominal = feeder()
    assert contour["contour_x_mm"] == pytest.approx(
        1e3 * nominal.points(uniform_turn(contour["contour_x_mm"].size))[0], abs=1e-9
    )


def test_the_sheets_of_a_bearing_without_a_wound_spring_agree(run):
    """The speed is greatest on the outer wall, on which the roller turns the other way."""
    sheets = SheetRun(run.path)
    assert sheets.sheet("roller_life").agrees and sheets.sheet("roller_speed").agrees
    assert sheets.sheet("roller_speed").result is not None


def test_the_arrangement_has_a_disc_with_its_groove_and_no_spring(run):
    """The contact force starts on the wall that carries; nothing of the stand-in spring."""
    turn = read_material(run.path).turn
    mechanism = mechanism_of(turn)
    assert not mechanism.sprung and mechanism.groove is not None
    assert mechanism.radius_max == 125.0
    for side in (1.0, -1.0):
        carries = np.flatnonzero(turn.columns["wall"] == side)
        row = int(carries[np.argmax(turn.columns["normal_force_N"][carries])])
        drawn = arrangement_at(turn, row)
        names = {group.name for group in drawn.groups}
        assert not any(name.startswith("spring") for name in names)
        (force,) = (each for group in drawn.groups if group.name == "forces"
                    for each in group.shapes if each.name == "contact")  # fmt: skip
        centre = mechanism.lowest + turn.columns["lift_mm"][row]
        assert np.hypot(force.tip[0] - mechanism.axis, force.tip[1] - centre) == pytest.approx(23.5)
        assert side * (force.tip[1] - centre) < 0.0
        assert side * (force.tip[1] - force.tail[1]) > 0.0
