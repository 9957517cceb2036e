"""The film of a turn: whole files, a still camera, bodies and colours where they belong."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture
import turn_fixture

from camwright.geometry.errors import ResultError
from camwright.reports import film, sections
from camwright.reports.film_frames import Stage
from camwright.reports.film_raster import BodyRaster, CamRaster, Window, interpolation
from camwright.reports.report_data import read_material
from camwright.reports.scene_turn import read_turn_view

POSITIONS = 36
BYTES_MAX = 20 << 20
HOSTILE = "<b>$x^{ \\frac</b> \u202eעברית\U0001f600 \x00" + 10_000 * "long "


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = report_fixture.write_run(
        tmp_path_factory.mktemp("film"), POSITIONS, title=HOSTILE, field=False
    )
    (made / "figures").mkdir()
    return turn_fixture.add_turn(made, POSITIONS)


@pytest.fixture(scope="module")
def stage(folder: Path) -> Stage:
    return Stage.of(read_material(folder), read_turn_view(folder))


def test_film_is_whole_in_both_formats_and_tells_how_far_it_is(folder: Path) -> None:
    imageio_ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="optional extra film")
    told: list[tuple[int, int]] = []
    before = {path.name for path in (folder / "figures").iterdir()}
    made = sections.build(
        folder, sections.chosen(["film"]), lambda *told_now: told.append(told_now)
    )
    mp4, gif = made["film"]
    assert told == [(k + 1, turn_fixture.FRAMES) for k in range(turn_fixture.FRAMES)]
    count, _ = imageio_ffmpeg.count_frames_and_secs(str(mp4))
    assert count == turn_fixture.FRAMES
    with Image.open(gif) as pictures:
        assert pictures.n_frames == turn_fixture.FRAMES and pictures.info["loop"] == 0
        assert pictures.size == (640, 360)
    assert max(mp4.stat().st_size, gif.stat().st_size) <= BYTES_MAX
    assert {p.name for p in (folder / "figures").iterdir()} - before == {film.MP4, film.GIF}


def test_film_is_drawn_only_when_asked_for() -> None:
    assert "film" not in [part.name for part in sections.chosen()]


def test_a_film_without_its_encoder_says_what_to_install(folder: Path, monkeypatch) -> None:
    real = importlib.util.find_spec
    monkeypatch.setattr(
        film.importlib.util, "find_spec",
        lambda name, *more: None if name == "imageio_ffmpeg" else real(name, *more),
    )  # fmt: skip
    with pytest.raises(ResultError, match=r"imageio-ffmpeg.*camwright\[film\]"):
        film.write(read_material(folder))


def test_a_run_without_its_turn_says_so(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(ResultError, match="run the case again"):
        read_turn_view(tmp_path)
    material = replace(read_material(folder), folder=tmp_path)
    with pytest.raises(ResultError, match="patch_cycle"):
        Stage.of(material, read_turn_view(folder))


def test_camera_and_colours_stay(stage: Stage) -> None:
    first, later = stage.picture(0).astype(int), stage.picture(3).astype(int)
    assert first.shape == (720, 1280, 3)
    moved = np.abs(first - later).max(axis=2) > 0
    # title, both colour bars with their numbers, and the axes of the trace below its curves
    for rows, columns in (((0, 40), (0, 1280)), ((90, 680), (580, 680)), ((64, 364), (1155, 1280)),
                          ((660, 720), (690, 1280))):  # fmt: skip
        assert not moved[slice(*rows), slice(*columns)].any()
    assert moved[84:700, 20:568].mean() > 0.05 and moved[64:364, 742:1142].any()


def test_follower_stands_on_its_axis_and_touches_the_cam(stage: Stage) -> None:
    lab = stage.view.lab_origin()
    np.testing.assert_allclose(lab[0], 0.0, atol=1e-9)  # no offset in this case
    turn = stage.view.to_lab
    for k in range(turn_fixture.FRAMES):
        surface = stage.view.cam[:, :, 0]
        cosine, sine = np.cos(turn[k]), np.sin(turn[k])
        there = np.array([[cosine, -sine], [sine, cosine]]) @ surface
        gap = np.hypot(*(there - lab[:, k : k + 1])).min()
        assert gap == pytest.approx(1e3 * report_fixture.ROLLER, abs=1e-3)


def star(stations: int = 720, layers: int = 12) -> np.ndarray:
    """A cam (2, stations, layers) about a bore of 8, with its stations the other way about."""
    angle = -np.linspace(0, 2 * np.pi, stations, endpoint=False) + 0.7
    outer = (40 + 8 * np.cos(angle) + 3 * np.sin(3 * angle)) * np.stack(
        [np.cos(angle), np.sin(angle)]
    )
    inner = 8 * outer / np.hypot(*outer)
    return outer[:, :, None] + (inner - outer)[:, :, None] * np.linspace(0, 1, layers) ** 2


@pytest.mark.parametrize("turn", [0.0, 1.3, -2.9])
def test_a_cam_is_sampled_where_it_has_turned_to(turn: float) -> None:
    grid, window = star(), Window(-60.0, -60.0, 0.3, 400, 400)
    layer = CamRaster(grid, window)(turn, 100 + grid[0] - 2 * grid[1])
    x, y = window.points[:, *layer.part]
    own = np.cos(turn) * x + np.sin(turn) * y, np.cos(turn) * y - np.sin(turn) * x
    inside = layer.cover == 1
    # a field that is linear between points of the grid comes out as it is, but for the arcs
    # between stations and the layers' steps, both far below a colour
    expected = (100 + own[0] - 2 * own[1])[inside]
    np.testing.assert_allclose(layer.values[inside], expected, atol=0.05)
    outline = grid[:, :, 0]
    area = 0.5 * abs(
        np.sum(outline[0] * np.roll(outline[1], 1) - outline[1] * np.roll(outline[0], 1))
    )
    assert layer.cover.sum() * 0.3**2 == pytest.approx(area - np.pi * 8**2, rel=1e-3)


def test_a_body_on_a_mesh_keeps_its_hole_and_its_field() -> None:
    angle, radius = np.meshgrid(np.linspace(0, 2 * np.pi, 97)[:-1], np.linspace(3, 8, 9))
    points = np.stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()])
    window = Window(-20.0, -20.0, 0.2, 200, 200)
    raster = BodyRaster(points, np.empty((3, 0)), window)
    origin, turn = np.array([4.0, -6.0]), 0.8
    layer = raster(origin, turn, 10 + points[0])
    assert layer.cover.sum() * 0.2**2 == pytest.approx(np.pi * (64 - 9), rel=0.01)
    x, y = window.points[:, *layer.part] - origin[:, None, None]
    deep = np.abs(np.hypot(x, y) - 5.5) < 2.0
    own = np.cos(turn) * x + np.sin(turn) * y
    np.testing.assert_allclose(layer.values[deep], (10 + own)[deep], atol=0.02)


def test_interpolation_takes_straight_lines_and_gives_nothing_outside() -> None:
    nodes = np.array([[0.0, 1.0, 0.0, 1.0, 0.4], [0.0, 0.0, 1.0, 1.0, 0.6]])
    at = np.array([[0.2, 0.9, 2.0], [0.7, 0.1, 0.5]])
    weights = interpolation(nodes, at)
    np.testing.assert_allclose(
        weights @ (1 + nodes[0] - 3 * nodes[1]), [-0.9, 1.6, 0.0], atol=1e-12
    )


def test_a_roller_rolls_the_length_of_the_contour(stage: Stage) -> None:
    arc = stage.view.arc()
    surface = stage.view.cam[:, :, 0]
    whole = np.hypot(*(np.roll(surface, -1, axis=1) - surface)).sum()
    assert arc[0] == 0.0 and (np.diff(arc) > 0).all()
    assert arc[3] == pytest.approx(
        np.hypot(*np.diff(surface[:, : POSITIONS // 2 + 1], axis=1)).sum(), rel=1e-9
    )
    assert arc[-1] < whole
