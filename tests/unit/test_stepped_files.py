"""Files of a groove of two steps: walls, paths of the cutter, solid, drawing file, dimensions."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from held_cams import volume_of

from camwright.geometry.arrays import uniform_turn
from camwright.meshes import step_solid
from camwright.meshes.step_solid import write_step
from camwright.meshes.step_text import PartTitle
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.hand_check.hand_sheet import SheetRun
from camwright.pipeline.results.file_differences import Origin, classes_of
from camwright.pipeline.results.workshop_files import (
    measured_surface,
    notes_of,
    outline_of,
    write_workshop,
)
from camwright.pipeline.run import run_case
from camwright.reports.arrangement_data import arrangement_at, mechanism_of
from camwright.reports.report_data import read_material
from camwright.reports.scene_groove import scene_groove

FILE = Path(__file__).parents[1] / "data" / "stepped_groove.toml"
ENDS = {"": -23.51, "_outer": 21.01, "_inner_relief": -21.5, "_outer_relief": 24.0}  # mm


@cache
def stepped():
    case = read_case(FILE)
    return case, case.contour(given_lift(case))


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    folder, left_out = tmp_path_factory.mktemp("stepped"), []
    write_workshop(folder, *stepped(), left_out.append)
    assert left_out == []
    return folder


def rows(path):
    return np.genfromtxt(path, delimiter=",", names=True)


@pytest.mark.parametrize("end", ENDS)
def test_walls_and_paths_of_the_cutter(workshop, end):
    """Each wall at its distance from the path of the rollers; a tool of 21 mm runs within it."""
    _, contour = stepped()
    points, side = rows(workshop / f"contour{end}.csv"), np.sign(ENDS[end])
    theta = np.radians(points["cam_angle_deg"])
    path, normal = 1e3 * contour.pitch.points(theta), contour.pitch.normal(theta)
    wall = np.stack([points["x_mm"], points["y_mm"]])
    assert wall == pytest.approx(path + ENDS[end] * normal, abs=1e-6)
    tool = rows(workshop / f"cutter{end}.csv")
    centre = np.stack([tool["x_mm"], tool["y_mm"]])
    aside = ENDS[end] - 21.0 * side
    assert centre == pytest.approx(path + aside * normal, abs=1e-6)
    assert (workshop / f"inspection{end}.csv").exists() == (end in ("", "_outer"))


def test_every_file_is_of_one_class_that_a_recomputation_compares(workshop):
    for file in workshop.iterdir():
        (of,) = classes_of(f"workshop/{file.name}", 1)
        assert of.origin is (Origin.DRAWN if file.suffix in {".pdf", ".xlsx"} else Origin.SOLVED)


def closed_form(case, contour):
    """Disc less bore, keyway and both steps, m3; a strip by its width and that of the path."""
    cam, path, theta = case.cam, contour.pitch, uniform_turn(7200)
    speed, curvature = path.speed_and_curvature(theta)
    length, turned = speed.mean() * 2.0 * np.pi, (speed * curvature).mean() * 2.0 * np.pi
    volume = np.pi * (cam.groove.outer_radius**2 - cam.bore_radius**2) * cam.width
    for step in cam.groove.steps(case.roller.radius):
        width, bent = step.inner + step.outer, step.outer**2 - step.inner**2
        volume -= (step.bottom - step.top) * (width * length + 0.5 * bent * turned)
    half, bore = 0.5 * cam.keyway.width, cam.bore_radius
    at = np.sqrt(bore**2 - half**2)  # the keyway less the segment of the bore in it
    segment = bore**2 * np.arcsin(half / bore) - half * at
    return volume - (2.0 * half * (bore + cam.keyway.depth - at) - segment) * cam.width


@pytest.mark.slow
def test_the_solid_has_the_volume_of_the_disc_less_both_steps(workshop):
    """As written, within 1e-8 m: OpenCASCADE reads its splines for 10 s."""
    volume = volume_of(workshop / "cam.step")
    assert volume == pytest.approx(closed_form(*stepped()), rel=1e-5)


@pytest.mark.parametrize("radius", [0.021, 0.0235, 0.0255])
def test_solids_of_a_smaller_an_equal_and_a_larger_second_roller(tmp_path, monkeypatch, radius):
    """The case, equal rollers, whose lower step reaches under the upper one, and the second at the
    face; walls within 10 um of the contours, and the same faces.
    """
    monkeypatch.setattr(step_solid, "_STEP_ERROR", 1e-5)
    case, contour = stepped()
    second = replace(case.cam.groove.second, radius=radius)
    cam = replace(case.cam, groove=replace(case.cam.groove, second=second))
    other = case.model_copy(update={"cam": cam})
    words = " ".join(notes_of(other))
    assert ("lower step cut 0.49 mm under the wall above it" in words) == (radius == 0.0235)
    path = tmp_path / "cam.step"
    write_step(path, outline_of(other, contour), cam.width, PartTitle("cam"))
    assert volume_of(path) == pytest.approx(closed_form(other, contour), rel=1e-5)


def test_all_walls_are_in_the_drawing_file(workshop):
    space = ezdxf.readfile(workshop / "contour.dxf").modelspace()
    lines = [each for each in space.query("LWPOLYLINE") if each.dxf.layer == "groove"]
    assert len(lines) == 4
    words = " ".join(each.dxf.text for each in space.query("TEXT"))
    assert "groove 47.51 mm wide and 18 mm deep, below 42.51 mm wide and 36 mm deep" in words
    assert "rollers 47 mm on the inner and 42 mm on the outer wall" in words
    assert "walls opposite to each roller 0.5 mm from it" in words


def test_dimensions_of_both_steps(workshop):
    groove = json.loads((workshop / "dimensions.json").read_text(encoding="utf-8"))["groove"]
    assert (groove["width_mm"], groove["depth_mm"]) == pytest.approx((47.51, 36.0))
    steps = [[step[f"{name}_mm"] for name in ("bottom", "inner", "outer")]
             for step in groove["steps"]]  # fmt: skip
    assert steps == [pytest.approx([18, 23.51, 24]), pytest.approx([36, 21.5, 21.01])]


@pytest.mark.parametrize(("track", "away"), [("inner", -23.51e-3), ("outer", 21.01e-3)])
def test_the_measured_walls_are_those_on_which_a_roller_runs(track, away):
    case, contour = stepped()
    wall, theta = measured_surface(case, contour, track), uniform_turn(36)
    nominal = contour.pitch.points(theta) + away * contour.pitch.normal(theta)
    assert wall.points(theta) == pytest.approx(nominal, abs=1e-12)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stepped_run") / "run"
    return run_case(stepped()[0], folder, depth=Tier.PREVIEW, positions=72)


@pytest.mark.slow
def test_the_run_folder_has_both_walls_and_its_sheets_agree(run):
    contour = run.final.contour
    path, outer, inner = (
        np.stack([contour[f"{name}_{axis}_mm"] for axis in "xy"])
        for name in ("pitch", "outer", "contour")
    )
    assert np.hypot(*(outer - path)) == pytest.approx(21.0, abs=1e-9)
    assert np.hypot(*(inner - path)) == pytest.approx(23.5, abs=1e-9)
    sheets = SheetRun(run.path)
    second = "outer_undercut", "second_roller_life", "second_roller_static", "crossover_slip"
    for name in (*second, "roller_speed"):
        assert sheets.sheet(name).agrees, name


@pytest.mark.slow
def test_the_pictures_have_both_steps_and_both_rollers(run):
    """The contact of each wall is at its roller; the scene has the floor, a ledge, the solids."""
    turn = read_material(run.path).turn
    mechanism = mechanism_of(turn)
    for side, radius in ((1.0, 23.5), (-1.0, 21.0)):
        carries = np.flatnonzero(turn.columns["wall"] == side)
        row = int(carries[np.argmax(turn.columns["normal_force_N"][carries])])
        (force,) = (each for group in arrangement_at(turn, row).groups if group.name == "forces"
                    for each in group.shapes if each.name == "contact")  # fmt: skip
        centre = mechanism.lowest + turn.columns["lift_mm"][row]
        away = np.hypot(force.tip[0] - mechanism.axis, force.tip[1] - centre)
        assert away == pytest.approx(radius)
    inner, around = mechanism.contour, uniform_turn(mechanism.contour.shape[1])
    bore = 15.0 * np.stack([np.cos(around), np.sin(around)])
    scene = scene_groove(turn, mechanism.groove, inner, bore, 46.0)
    heights = np.unique(np.round(scene.disc().points[2], 6))
    # the middle of the first roller is 8.75 + 0.4 + 18 mm above the floor, 36 mm below the face
    assert {8.85, -9.15, -27.15, -37.15} <= set(heights.tolist())
    assert scene.second.height == -18.0
    assert scene.follower(20.0, 100.0, 8.5).points[2].min() == pytest.approx(-18.0 - 8.75)
    # the second roller turns against the first, by the length of the outer wall over a turn
    angle, centre = np.array([0.0, 180.0, 360.0]), np.zeros((2, 3))
    for body in scene.moving(angle, centre, 4):
        path = np.stack([run.final.contour[f"pitch_{axis}_mm"] for axis in "xy"])
        length = np.hypot(*np.diff(path, axis=1, append=path[:, :1])).sum() + 2.0 * np.pi * 21.0
        assert body["turn"][0] == 0.0
        assert body["turn"][1:] == pytest.approx([-length / 42.0, -length / 21.0], rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("second", [21.0, 26.0])
def test_each_roller_is_drawn_in_its_own_step(run, second):
    """The larger one in the upper step, before the other; neither crosses a wall at any angle."""
    turn = read_material(run.path).turn
    groove = dict(turn.case["cam"]["groove"])
    groove["second"] = {**groove["second"], "radius": f"{second} mm"}
    table = dict(turn.contour)
    for axis in "xy":
        table[f"outer_{axis}_mm"] = table[f"pitch_{axis}_mm"] + second * table[f"normal_{axis}"]
    case = {**turn.case, "cam": {**turn.case["cam"], "groove": groove}}
    changed = replace(turn, case=case, contour=table)
    mechanism = mechanism_of(changed)
    (follower,) = (each for each in arrangement_at(changed).groups if each.name == "follower")
    sizes = [float(np.hypot(*each.lines[0]).max()) for each in follower.shapes
             if np.ptp(np.hypot(*each.lines[0])) < 1e-9]  # fmt: skip
    assert sizes[0] == pytest.approx(max(second, 23.5))
    assert sizes[-1] == pytest.approx(min(second, 23.5))
    path = np.stack([table[f"pitch_{axis}_mm"] for axis in "xy"])
    for step, radius in zip(mechanism.groove.steps, (sizes[0], sizes[-1]), strict=True):
        for wall in step.walls:
            for centre in path.T[::60]:
                away = np.hypot(*(wall - centre[:, None])).min()
                assert away > radius - 1e-3
