"""Pictures of conjugate discs and yokes: arrangement and outline on the track that carries."""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import rotation
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.run import run_case
from camwright.reports import analysis_sheet, scene_page, scene_solids
from camwright.reports.arrangement_data import arrangement_at, mechanism_of, motion_of
from camwright.reports.drawing import arrangement
from camwright.reports.report_data import read_material

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(
    scope="module",
    params=[
        "conjugate_arm",
        pytest.param("conjugate_feeder", marks=pytest.mark.slow),
        pytest.param("yoke_pump", marks=pytest.mark.slow),
    ],
)
def material(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param) / "run"
    run_case(read_case(DATA / f"{request.param}.toml"), folder, positions=72, jobs=1,
             depth=Tier.PREVIEW)  # fmt: skip
    return read_material(folder)


@pytest.fixture(scope="module")
def turn(material):
    return material.turn


@pytest.fixture(scope="module")
def view(turn):
    """The recorded turn of a deeper run: first roller or face at every cam angle."""
    m, c, angle = mechanism_of(turn), turn.contour, turn.columns["cam_angle_deg"]
    around = scene_solids.unit_circle()
    body = np.array([[-12.0, 12.0, 12.0, -12.0], [0.0, 0.0, -10.0, -10.0]])
    if m.roller is not None:
        body = np.hstack([m.roller * around, 0.6 * m.roller * around])
    step = c["cam_angle_deg"].size // angle.size
    touch = np.stack([c[f"contour_{axis}_mm"][::step] for axis in "xy"])
    origin = np.stack([c[f"pitch_{axis}_mm"][::step] for axis in "xy"], axis=1)
    return scene_page.TurnView(
        turn.load_case, np.arange(angle.size), angle, touch, 15.0 * touch / np.hypot(*touch), body,
        origin, np.zeros(angle.size),
    )  # fmt: skip


def worst_rows(turn) -> dict[float, int]:
    """Row of the greatest contact force on each track."""
    wall, force = turn.walls, turn.columns["normal_force_N"]
    return {side: int(np.argmax(np.where(wall == side, force, -1.0))) for side in (1.0, -1.0)}


def shapes(drawing, name):
    group = next(each for each in drawing.groups if each.name == name)
    return [group.pose.of(line) for shape in group.shapes for line in shape.lines]


def test_second_roller_or_face_touches_its_track_at_every_angle(turn):
    """Within the clearance, 0.02 or 0.05 mm, and the chords of the drawn outline."""
    m = mechanism_of(turn)
    assert not m.sprung
    for row in range(0, turn.crank.size, 9):
        drawing = arrangement_at(turn, row)
        if m.second.disc is None:  # breadth of the cam is 73 mm, faces 73.05 mm apart
            (outside, opening) = shapes(drawing, "frame")
            cam = rotation(arrangement.cam_turn(np.radians(turn.columns["cam_angle_deg"][row])))
            height = (cam @ m.contour)[1]
            assert opening[1].max() == pytest.approx(height.max(), abs=0.02)
            assert opening[1].min() == pytest.approx(height.min() - 0.05, abs=0.02)
            assert np.ptp(outside[1]) > np.ptp(opening[1])
            continue
        (disc, _) = shapes(drawing, "second-cam")
        rim = shapes(drawing, "second-roller")[0]
        centre = rim.mean(axis=1)
        gap = np.hypot(*(disc - centre[:, None])).min() - m.second.radius
        assert gap == pytest.approx(0.0, abs=0.1)


def test_the_force_starts_on_the_track_that_carries_and_points_to_the_follower(turn):
    m, motion = mechanism_of(turn), motion_of(turn)
    for side, row in worst_rows(turn).items():
        tip = arrangement.contact_point(m, motion)[:, row]
        disc = m.contour if side > 0.0 or m.second.disc is None else m.second.disc
        surface = rotation(arrangement.cam_turn(motion.theta[row])) @ disc
        nearest = surface[:, np.hypot(*(surface - tip[:, None])).argmin()]
        assert np.hypot(*(nearest - tip)) < 2.5  # mm, between two points of the outline
        (force,) = (each for each in arrangement.arrows(m, motion, row) if each.name == "contact")
        push = np.subtract(force.tip, force.tail)
        assert push @ tip > 0.0  # out of the disc
        if m.arm is None:
            assert side * push[1] > 0.0
        else:
            assert side * push[0] < 0.0  # the first arm is on the left


def test_envelope_encloses_both_discs_and_the_second_roller(turn):
    m = mechanism_of(turn)
    for row in (0, 18, 45):
        for group in arrangement_at(turn, row).groups:
            if group.name in ("cam", "second-cam", "second-roller"):
                lines = [group.pose.of(line) for shape in group.shapes
                         for line in getattr(shape, "lines", ())]  # fmt: skip
                x, y = np.hstack(lines) if lines else np.zeros((2, 1))
                (left, right), (low, high), _ = m.envelope
                assert left - 1e-6 <= x.min()
                assert x.max() <= right + 1e-6
                assert low - 1e-6 <= y.min()
                assert y.max() <= high + 1e-6
    if m.second.disc is not None:
        assert m.envelope.depth[1] >= m.second.spacing + 0.5 * m.sizes.cam_width


def test_outline_has_the_second_disc_and_the_follower_that_carries(turn):
    figure = analysis_sheet._outline(turn)
    labels = [curve.label for curve in figure.curves]
    assert ("second disc" in labels) == (turn.second_disc is not None)
    carried = "second " if turn.walls[turn.worst] < 0.0 else ""
    assert figure.follower_name == carried + turn.follower_name
    away = np.hypot(*(figure.follower - figure.touches[:, None])) if carried else np.zeros(1)
    assert away.min() < 2.0
    assert "hole" not in figure.caption


def test_scene_moves_disc_and_roller_and_marks_the_contact_on_the_track_that_carries(
    material, view
):
    turn, m = material.turn, mechanism_of(material.turn)
    scene = scene_page.scene(material, view)
    x, y, along = np.array(scene["contact"])
    pulls = turn.walls < 0.0
    assert np.unique(along[pulls]) == pytest.approx(m.second.spacing)
    assert not along[~pulls].any()
    touch = arrangement.contact_point(m, motion_of(turn))
    assert np.stack([x, y])[:, pulls] == pytest.approx(touch[:, pulls], rel=1e-3, abs=1e-3)
    assert scene["reach"]["deep"] >= m.second.spacing
    if m.second.disc is None:
        assert scene["moving"] == []
        assert min(scene["bodies"]["follower"]["y"]) < -73.0
        return
    flank, _, roller, *_ = scene["moving"]
    assert len(flank["body"]["z"]) == 2 * view.contour.shape[1]
    middle = [0.5 * (min(each["body"]["z"]) + max(each["body"]["z"])) for each in (flank, roller)]
    assert middle == pytest.approx([m.second.spacing] * 2)
    for row in (0, 30, 50):
        places = [
            rotation(each["turn"][row]) @ np.array([each["body"]["x"], each["body"]["y"]])
            + np.array([[each["x"][row]], [each["y"][row]]])
            for each in (flank, roller)
        ]
        centre = 0.5 * (places[1].min(axis=1) + places[1].max(axis=1))
        gap = np.hypot(*(places[0] - centre[:, None])).min() - m.second.radius
        assert gap == pytest.approx(0.0, abs=0.15)


def test_colours_are_of_the_track_that_carries(material, view, monkeypatch):
    """Stress 100 MPa and the cam angle in degrees: 0 where the other track carries."""
    monkeypatch.setattr(
        scene_page, "_greatest", lambda _m, _v, count: 100.0 + np.arange(count) * 360.0 / count
    )
    turn, scene = material.turn, scene_page.scene(material, view)
    values = np.array(scene["bodies"]["flank"]["values"])[: view.contour.shape[1]]
    first, second = (np.where(turn.walls == side, 100.0 + view.angle, 0.0) for side in (1.0, -1.0))
    if turn.second_disc is None:
        wanted = np.maximum(first, np.roll(second, second.size // 2))
        assert values == pytest.approx(wanted, abs=0.01)
        return
    assert values == pytest.approx(first, abs=0.01)
    body = scene["moving"][0]["body"]
    at = np.linspace(0.0, 360.0, len(body["values"]) // 2, endpoint=False)
    drawn = np.interp(view.angle, at, body["values"][: at.size])
    assert drawn == pytest.approx(second, abs=0.01)
    assert body["words"][0].startswith("second disc, cam 0.0")


def test_both_preloaded_discs_are_under_stress():
    """At two angles of which either disc has the greater pressure once; without a preload one."""
    rows = {
        "cam_angle_deg": np.array([0.0, 90.0, 180.0, 270.0]),
        "wall": np.array([1.0, -1.0, 1.0, -1.0]),
        "p0_hertz_MPa": np.array([100.0, 120.0, 80.0, 50.0]),
    }
    angle = np.array([0.0, 90.0, 180.0])
    first, second = scene_page.shares_of_tracks(rows, angle)
    assert (first.tolist(), second.tolist()) == ([1.0, 0.0, 1.0], [0.0, 1.0, 0.0])
    pressed = rows | {"idle_p0_hertz_MPa": np.array([50.0, 90.0, 100.0, 40.0])}
    first, second = scene_page.shares_of_tracks(pressed, angle)
    assert first == pytest.approx([1.0, 0.75, 0.8])
    assert second == pytest.approx([0.5, 1.0, 1.0])
