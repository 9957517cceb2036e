"""Workshop files of conjugate discs and yokes: tables, solid, drawing and inspection of each."""

import csv
import json
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
from dxf_arcs import arc_points, away_from
from held_cams import volume_of

from camwright.geometry.arrays import rotation, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.measured_contour import inspected, real_contour
from camwright.meshes import step_solid
from camwright.meshes.step_solid import write_step
from camwright.meshes.step_text import PartTitle
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.follower.camshaft_loads import unbalance
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.workshop_files import (
    made_surfaces,
    measured_surface,
    notes_of,
    outline_of,
    real_cam,
    second_track_notes,
    write_workshop,
)
from camwright.pipeline.solver import solve
from camwright.pipeline.studies import cam_inspection
from camwright.pipeline.studies.cam_inspection import (
    RealPart,
    measured_tracks,
    write_inspection,
)

DATA = Path(__file__).parents[1] / "data"
PAIRS = ("conjugate_feeder", "conjugate_arm")
SLOW = pytest.mark.slow
DISCS = [*((name, end) for name in PAIRS for end in ("", "_second")), ("yoke_pump", "")]


@cache
def judged(name: str):
    case = read_case(DATA / f"{name}.toml")
    return case, preview_case(case, corners=False).contour


@pytest.fixture(scope="module")
def workshops(tmp_path_factory):
    folders = {}
    for name in (*PAIRS, "yoke_pump"):
        folders[name], said = tmp_path_factory.mktemp(name), []
        write_workshop(folders[name], *judged(name), said.append)
        assert said == []
    return folders


def test_every_disc_has_its_files(workshops):
    own = {"dimensions{}.json", "contour{}.dxf", "cam{}.step", "contour{}.csv", "cutter{}.csv",
           "inspection{}.csv"}  # fmt: skip
    for name, folder in workshops.items():
        ends = ("", "_second") if name in PAIRS else ("",)
        names = {each.format(end) for each in own for end in ends}
        assert {file.name for file in folder.iterdir()} == names


def test_the_second_disc_of_a_stem_keeps_distance_and_clearance(workshops):
    """Half a turn apart both contours are at the distance of the rollers less their radii and the
    clearance, where the roller runs on a circle: tables at 0 and 80 deg are in dwells.
    """
    radii = [json.loads((workshops["conjugate_feeder"] / f"dimensions{end}.json").read_text())
             ["radii_mm"] for end in ("", "_second")]  # fmt: skip
    for first, second in (("0", "180"), ("80", "260"), ("170", "350")):
        assert radii[0][first] + radii[1][second] == pytest.approx(154.0 - 47.0 - 0.02, abs=1e-6)


def test_the_second_disc_of_a_preloaded_stem_is_too_great_by_the_interference():
    """As above, by the surfaces of which the files are made."""
    surfaces = made_surfaces(*judged("preloaded_feeder"))
    first, second = (1e3 * surfaces[end].polygon(3600) for end in ("", "_second"))
    for angle in (0.0, 80.0, 170.0):
        radii = []
        for points, turn in ((first, 0.0), (second, 180.0)):
            off = np.angle(
                np.exp(1j * (np.arctan2(points[1], points[0]) - np.radians(angle + turn)))
            )
            radii.append(np.hypot(*points[:, np.abs(off).argmin()]))
        assert sum(radii) == pytest.approx(154.0 - 47.0 + 0.013, abs=1e-6)


@pytest.mark.parametrize(("name", "gap"), [("conjugate_arm", 0.02), ("preloaded_arm", -0.02)])
def test_the_second_disc_of_an_arm_is_off_its_roller_by_the_clearance(name, gap):
    """Centre by both arms, 79 deg apart at the pivot; 22 mm roller, clearance 0.02 mm."""
    case, contour = judged(name)
    theta = uniform_turn(36)
    first = contour.pitch.points(theta)
    pivot = 0.1 * np.stack([np.cos(theta), np.sin(theta)])
    turned = np.stack([rotation(np.radians(79.0)), rotation(-np.radians(79.0))])
    along = np.einsum("kij,jn->kin", turned, first - pivot) * (0.085 / 0.09)
    centres = pivot + along  # on either side of the first arm
    centre = centres[int(np.argmin(np.hypot(*centres.transpose(1, 0, 2)).max(axis=1)))]
    surface = 1e3 * made_surfaces(case, contour)["_second"].polygon(36_000)
    away = np.array([np.hypot(*(surface - 1e3 * at[:, None])).min() for at in centre.T])
    assert away == pytest.approx(22.0 + gap, abs=1e-6)


def assert_volume(solid, case, surface):
    """That of disc less bore and keyway; OpenCASCADE integrates along splines of the contour."""
    cam = case.cam
    area = unbalance(surface, cam.bore_radius, cam.keyway, 1.0, 1.0).mass
    assert volume_of(solid) == pytest.approx(area * cam.width, rel=1e-6)


@pytest.mark.parametrize(("name", "end"), DISCS)
def test_the_solid_is_that_of_the_contour(tmp_path, monkeypatch, name, end):
    """Walls within 10 um of the contour."""
    monkeypatch.setattr(step_solid, "_STEP_ERROR", 1e-5)
    case, contour = judged(name)
    solid = tmp_path / "cam.step"
    write_step(solid, outline_of(case, contour, end), case.cam.width, PartTitle("cam"))
    assert_volume(solid, case, made_surfaces(case, contour)[end])


@SLOW
@pytest.mark.parametrize(("name", "end"), DISCS)
def test_the_solid_as_written_is_that_of_the_contour(workshops, name, end):
    """Within 10 nm: OpenCASCADE reads its splines for 3 s."""
    case, contour = judged(name)
    assert_volume(workshops[name] / f"cam{end}.step", case, made_surfaces(case, contour)[end])


@pytest.mark.parametrize(("name", "end"), DISCS)
def test_the_drawing_is_that_of_the_contour(workshops, name, end):
    case, contour = judged(name)
    surface = made_surfaces(case, contour)[end]
    space = ezdxf.readfile(workshops[name] / f"contour{end}.dxf").modelspace()
    lines = space.query('LWPOLYLINE[layer=="cut"]')
    drawn = max(lines, key=lambda line: np.abs(line.get_points("xy")).max())
    assert away_from(surface, arc_points(drawn)) < 1.001e-3  # mm, the error of the arcs
    notes = [each.dxf.text for each in space.query('TEXT[layer=="note"]')]
    assert notes[1:] == [*notes_of(case, end), *second_track_notes(case, contour, end)]


def test_notes_state_the_other_disc_and_the_faces(workshops):
    def of(name, end=""):
        record = json.loads((workshops[name] / f"dimensions{end}.json").read_text())
        return " ".join(record["second_track"])

    assert "disc 1 is 34 mm from it along the shaft" in of("conjugate_feeder", "_second")
    assert "0 deg between" in of("conjugate_feeder")
    assert "centres of both rollers 154 mm apart" in of("conjugate_feeder")
    assert "79 deg between the arms to both rollers, the second 85 mm" in of("conjugate_arm")
    # base radius 35 mm, stroke 3 mm
    assert "breadth 73 mm" in of("yoke_pump")
    assert "faces 73.05 mm apart" in of("yoke_pump")
    swing = json.loads((workshops["conjugate_arm"] / "dimensions_second.json").read_text())["arm"]
    assert (swing["length_mm"], swing["swing"]) == (pytest.approx(85.0), "against")
    radius, angle = np.radians(swing["by_cam_angle"]["0"])
    assert np.degrees(radius) ** 2 == pytest.approx(
        100.0**2 + 85.0**2 - 2.0 * 8500.0 * np.cos(angle)
    )


@pytest.mark.parametrize(
    ("name", "track"),
    [
        ("conjugate_feeder", "second"),
        *(pytest.param("conjugate_arm", each, marks=SLOW) for each in ("first", "second")),
    ],
)
def test_a_measured_disc_is_fitted_to_its_own_nominal(name, track):
    """Size and a wave of 3 um are fitted; the roller runs on the disc, the other disc matches:
    the second path that follows from the first one of the measured cam is the measured one.
    """
    case, contour = judged(name)
    surface, theta = measured_surface(case, contour, track), uniform_turn(720)
    wave = 5e-6 + 3e-6 * np.cos(4.0 * theta)
    fit = inspected(surface, surface.points(theta) + wave * surface.normal(theta))
    assert fit.size == pytest.approx(5e-6, abs=1e-7)
    assert fit.wave(4) == pytest.approx(3e-6, rel=0.01)
    real = real_contour(surface, fit)
    cam = real_cam(case, contour, track, real)
    path = cam.pitch if track == "first" else case.cam.second.track(cam.pitch).contour.pitch
    assert path.points(theta) == pytest.approx(real.pitch.points(theta), abs=1e-12)


def test_a_cam_with_one_track_has_no_other_to_measure():
    for name, wanted in (("yoke_pump", "left out"), ("conjugate_arm", "first or second")):
        with pytest.raises(InputError, match=f"--track = outer, must be {wanted}"):
            measured_surface(*judged(name), "outer")


def test_tables_of_a_disc_are_on_it(workshops):
    case, contour = judged("conjugate_feeder")
    with (workshops["conjugate_feeder"] / "inspection_second.csv").open() as text:
        rows = list(csv.DictReader(text))
    points = np.array([[float(row[f"nominal_{axis}_mm"]) for row in rows] for axis in "xy"])
    theta = np.radians([float(row["cam_angle_deg"]) for row in rows])
    second = case.cam.second.path(contour.pitch)
    assert 1e-3 * points == pytest.approx(
        second.points(theta) - 23.52e-3 * second.normal(theta), abs=1e-12
    )


def test_the_record_of_an_inspection_has_the_nominal_of_the_measured_disc(tmp_path, monkeypatch):
    """Points of the second disc, smaller by the clearance: roller 23.5 mm, clearance 0.02 mm."""
    case, contour = judged("conjugate_feeder")
    surface, theta = measured_surface(case, contour, "second"), uniform_turn(360)
    fit = inspected(surface, surface.points(theta) + 4e-6 * surface.normal(theta))
    deviation = measured_tracks(case, "second", fit)
    trial = solve(case, contour, tier=Tier.PREVIEW, corners=False, deviation=deviation)
    part = RealPart(fit, surface, contour, trial, "second")
    run = SimpleNamespace(summary={"headline": headline(trial.solution)})
    monkeypatch.setattr(cam_inspection.run_reader, "read_run", lambda _: run)
    record = write_inspection(tmp_path, part, 8e-6, tmp_path)
    least = min(cycle.loads.normal_force.min() for cycle in trial.cycles)
    assert least > 0.0  # of the sampled angles: the force passes through zero between two of them
    assert (
        record["measured"]["normal_force_min_N"] == 0.0 == record["nominal"]["normal_force_min_N"]
    )
    assert (record["track"], record["size_um"]) == ("second", pytest.approx(4.0, abs=0.01))
    # of 0.02 mm less 4 um, by which the landing is judged, too
    assert record["clearance_um"] == pytest.approx([16.0, 16.0], abs=0.01)
    assert "clearance 16.00 to 16.00 um over the turn" in cam_inspection.lines(record)
    (landing,) = (each.demand for each in trial.checks if each.id == "landing_speed")
    drawn = preview_case(case, corners=False)
    (nominal,) = (each.demand for each in drawn.checks if each.id == "landing_speed")
    assert landing == pytest.approx(nominal * 0.8 ** (2.0 / 3.0), rel=0.01)  # of small clearances
    written = read_table(tmp_path / "deviation.csv")
    path = case.cam.second.path(contour.pitch)
    at = np.radians(written["cam_angle_deg"])
    points = np.stack([written["nominal_x_mm"], written["nominal_y_mm"]])
    assert points == pytest.approx(1e3 * (path.points(at) - 23.52e-3 * path.normal(at)), abs=1e-9)
