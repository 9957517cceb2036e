"""The scene: solids that hold together, and the page in a real browser."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture
import turn_fixture
from browser_fixture import Tab, chromium

from camwright.geometry.errors import ResultError
from camwright.meshes.mesh_files import write_hexahedra
from camwright.reports import scene_page, sections, stress_map
from camwright.reports.report_data import read_material
from camwright.reports.scene_page import TurnView, read_turn_view
from camwright.reports.scene_solids import Lattice, Solid, box, joined, ring, tube

POSITIONS = 36
BYTES_MAX = 10 << 20
HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית\U0001f600 </script><!--"
SHOWN = "#scene[data-shown='{}']"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scene") / "run"
    report_fixture.write_run(folder, POSITIONS, title=HOSTILE, field=False)
    turn_fixture.add_turn(folder, POSITIONS)
    below = {"cam_angle_deg": [0.0, 180.0], "depth_mm": [[0.0, 0.5], [0.0, 0.5]]}
    below |= {name: [[200.0, 250.0], [400.0, 350.0]] for name, _ in stress_map.MAPS}
    np.savez(
        folder / "trial_2" / stress_map.FILE,
        **{f"idle.{name}": np.array(values) for name, values in below.items()},
    )
    write_ends(folder / scene_page.ENDS)
    (made,) = sections.report(folder, sections.chosen(["scene"]))["scene"]
    return made


PRESSURE = (900.0, 1200.0, 1500.0)


def write_ends(path: Path) -> None:
    """Two blocks 4 mm long and 1 mm deep, in contact up to 0.1 mm beside the middle."""
    axes = np.array([0.0, 0.1, 0.2, 1.0]), np.array([-2.0, -1.0, 1.0, 2.0]), np.array([0, 0.1, 1.0])
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    numbers = np.arange(len(points)).reshape([axis.size for axis in axes])
    low, high = slice(None, -1), slice(1, None)
    around = [(low, low), (high, low), (high, high), (low, high)]
    cells = np.stack([numbers[x, y, z].ravel() for z in (low, high) for x, y in around], axis=1)
    pressed = np.zeros([axis.size - 1 for axis in axes])
    pressed[0, :, 0] = PRESSURE
    stress = 600.0 - 100.0 * points[:, 2]
    write_hexahedra(
        path,
        1e-3 * np.concatenate([points * (1, 1, -1), points]),
        np.concatenate([cells, cells + len(points)]),
        {"von_mises_MPa": np.concatenate([stress, stress + 10.0])},
        {
            "contact_pressure_MPa": np.tile(pressed.ravel(), 2),
            "body": np.repeat([0, 1], len(cells)),
        },
        {"cam_angle_deg": 240.0, "force_N": 812.5, "moment_Nmm": 40.0},
    )


@pytest.fixture(scope="module")
def view(page: Path) -> TurnView:
    return read_turn_view(page.parent)


@pytest.fixture(scope="module")
def tab() -> Iterator[Tab]:
    with chromium() as opened:
        yield opened


def test_scene_is_one_small_file_that_reaches_for_nothing(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert page.name == "scene.html" and page.stat().st_size <= BYTES_MAX
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy and "default-src 'none'" in policy[1] and "unsafe-eval" not in policy[1]
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)=.?https?:", text)


def test_a_report_has_a_scene_unless_told_otherwise() -> None:
    assert "scene" in [part.name for part in sections.chosen()]


def test_a_run_without_its_turn_has_no_scene(tmp_path: Path) -> None:
    folder = report_fixture.write_run(tmp_path / "old", POSITIONS, field=False)
    assert sections.report(folder, sections.chosen(["scene"]))["scene"] == []
    assert not (folder / scene_page.FILE).exists()
    with pytest.raises(ResultError, match="run the case again"):
        read_turn_view(folder)


@pytest.mark.parametrize("drilled", [True, False])
def test_the_hole_that_balances_the_cam_is_in_the_scene(
    tmp_path: Path, view: TurnView, drilled: bool
) -> None:
    """Wall and both mouths at the place and diameter of the record, if the cam has it."""
    folder = tmp_path / "run"
    report_fixture.write_run(folder, POSITIONS, field=False)
    turn_fixture.add_turn(folder, POSITIONS)
    trial = folder / "trial_2" / "trial.json"
    record = json.loads(trial.read_text())
    record["balance"]["hole_drilled"] = drilled
    trial.write_text(json.dumps(record))
    material = read_material(folder)
    x, y, diameter = (record["balance"][f"hole_{key}_mm"] for key in ("x", "y", "diameter"))
    body = scene_page.scene(material, view)["bodies"]["bore"]
    points = np.array([body[axis] for axis in "xyz"])
    around = np.hypot(points[0] - x, points[1] - y)
    on_wall = np.isclose(around, 0.5 * diameter, atol=1e-2)
    assert on_wall.any() == drilled
    if drilled:
        width = material.turn.length("cam", "width") or 0.0
        assert np.ptp(points[2, on_wall]) == pytest.approx(width, rel=0.02)
        angle = np.sort(np.arctan2(points[1] - y, points[0] - x)[on_wall])
        assert np.diff(angle).max() < 0.3  # all around
        mouths = np.isclose(around, 0.0, atol=1e-3)
        assert set(np.sign(points[2, mouths])) == {-1.0, 1.0}


def test_follower_stands_on_its_axis_and_touches_the_cam(view: TurnView) -> None:
    lab = view.lab_origin()
    np.testing.assert_allclose(lab[0], 0.0, atol=1e-9)  # no offset in this case
    turn = view.to_lab
    for k in range(turn_fixture.FRAMES):
        surface = view.contour
        cosine, sine = np.cos(turn[k]), np.sin(turn[k])
        there = np.array([[cosine, -sine], [sine, cosine]]) @ surface
        gap = np.hypot(*(there - lab[:, k : k + 1])).min()
        assert gap == pytest.approx(1e3 * report_fixture.ROLLER, abs=1e-3)


def test_a_roller_rolls_the_length_of_the_contour(view: TurnView) -> None:
    arc = view.arc()
    surface = view.contour
    whole = np.hypot(*(np.roll(surface, -1, axis=1) - surface)).sum()
    assert arc[0] == 0.0 and (np.diff(arc) > 0).all()
    assert arc[3] == pytest.approx(
        np.hypot(*np.diff(surface[:, : POSITIONS // 2 + 1], axis=1)).sum(), rel=1e-9
    )
    assert arc[-1] < whole


def test_slider_and_keys_turn_the_cam(page: Path, view: TurnView, tab: Tab) -> None:
    tab.open(page, 390, 700)
    tab.page.wait_for_selector(SHOWN.format(0))
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390
    place = "(([flank]) => [flank.x[7], flank.y[7]])(document.getElementById('scene').data)"
    corner = view.contour[:, 7]

    def expected(n: int) -> np.ndarray:
        cosine, sine = np.cos(view.to_lab[n]), np.sin(view.to_lab[n])
        return np.array([[cosine, -sine], [sine, cosine]]) @ corner

    # five digits of each coordinate are kept
    np.testing.assert_allclose(tab.evaluate(place), expected(0), atol=2e-3)
    slider = tab.page.locator("#turn")
    slider.fill("3")
    tab.page.wait_for_selector(SHOWN.format(3))
    np.testing.assert_allclose(tab.evaluate(place), expected(3), atol=2e-3)
    slider.press("ArrowRight")
    tab.page.wait_for_selector(SHOWN.format(4))
    said = tab.page.locator("#readout").text_content()
    assert said.startswith("cam 240.0°, crank 480.0°") and "MPa" in said
    assert slider.get_attribute("aria-valuetext")
    assert tab.errors == []
    assert tab.outside == []
    assert tab.evaluate("window.broken") is None
    assert "עברית" in tab.page.locator("h1").text_content()


BOXES = """["#scene", "#scene .colorbar", "#scene .gl-container > div"].map((name) => {
    const box = document.querySelector(name).getBoundingClientRect();
    return [box.left, box.top, box.right, box.bottom]; })"""
DRAWN = "Boolean(document.querySelector('#scene .colorbar'))"


def test_the_colour_bar_lies_beside_the_bodies(page: Path, tab: Tab) -> None:
    def is_clear() -> bool:
        if not tab.evaluate(DRAWN):
            return False
        place, bar, bodies = (np.array(box) for box in tab.evaluate(BOXES))
        inside = (bar[:2] >= place[:2] - 1).all() and (bar[2:] <= place[2:] + 1).all()
        large = (bodies[2:] - bodies[:2] > 0.6 * (place[2:] - place[:2])).all()
        return bool(inside and large and (bar[:2] >= bodies[2:]).any())

    def stands_clear() -> None:
        for _ in range(50):  # the page forbids what Playwright's own waiting evaluates
            if is_clear():
                return
            tab.page.wait_for_timeout(100.0)
        pytest.fail(f"scene, colour bar, bodies: {tab.evaluate(BOXES)}")

    for width, height in ((400, 800), (1300, 900)):
        tab.open(page, width, height)
        tab.page.wait_for_selector(SHOWN.format(0))
        stands_clear()
    for width, height in ((400, 800), (800, 500), (1000, 700)):  # the same page, its window resized
        tab.page.set_viewport_size({"width": width, "height": height})
        stands_clear()
    assert tab.errors == []


def test_the_field_at_the_ends_is_selected_and_left_again(page: Path, tab: Tab) -> None:
    tab.open(page, 900, 700)
    tab.page.wait_for_selector(SHOWN.format(0))
    shown = "document.getElementById('scene').data.map((t) => t.intensity)"
    tab.page.click("[data-field=stress]")
    tab.page.wait_for_selector("#scene[data-field=stress]")
    cam, follower = (np.array(values) for values in tab.evaluate(shown))
    # Cut 2.5 half-widths of contact beside and below it.
    assert (cam.min(), cam.max()) == pytest.approx((590.0, 600.0))
    assert (follower.min(), follower.max()) == pytest.approx((600.0, 610.0))
    words = tab.page.locator("#readout").text_content()
    assert words == "cam angle 240°: force 812.5 N, moment 40 N mm"
    assert "at 5 times the scale" in tab.page.locator("#of-ends").text_content()
    assert tab.page.locator("#turn").is_disabled()
    tab.page.click("[data-field=pressure]")
    tab.page.wait_for_selector("#scene[data-field=pressure]")
    (pressure,) = tab.evaluate(shown)
    assert sorted(set(pressure)) == [0.0, *PRESSURE]
    assert sorted(value for value in pressure if value) == sorted(2 * PRESSURE)
    tab.page.click("[data-field=turn]")
    tab.page.wait_for_selector("#scene[data-field=turn]")
    tab.page.locator("#turn").fill("2")
    tab.page.wait_for_selector(SHOWN.format(2))
    assert tab.page.locator("#readout").text_content().startswith("cam 120.0°")
    assert tab.errors == [] and tab.outside == []


def test_scene_says_what_the_run_found(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    data = json.loads(re.search(r'id="scene-data">(.*?)</script>', text, re.DOTALL)[1])
    material = read_material(page.parent)
    view = read_turn_view(page.parent)
    rows = material.run.final.cycle
    shown = {one["words"]: one["values"] for one in data["readout"]}
    np.testing.assert_allclose(
        shown["peak pressure p0"], rows["p0_fe_MPa"][view.position], rtol=1e-4
    )
    touching, centre = np.array(data["contact"][:2]), np.array(data["origin"])
    assert np.hypot(*(touching - centre)) == pytest.approx(
        np.full(turn_fixture.FRAMES, 1e3 * report_fixture.ROLLER), rel=1e-4
    )


def volume(solid: Solid) -> float:
    """Enclosed by triangles that all look outwards, by the divergence theorem."""
    a, b, c = (solid.points[:, numbers] for numbers in solid.triangles)
    return float(np.einsum("cm,cm->", a, np.cross(b, c, axis=0)) / 6)


def area(solid: Solid) -> float:
    a, b, c = (solid.points[:, numbers] for numbers in solid.triangles)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a, axis=0), axis=0).sum())


def test_solids_have_the_size_they_should() -> None:
    angle = np.linspace(0, 2 * np.pi, 7)[:-1]
    hexagon = np.stack([np.cos(angle), np.sin(angle)])
    assert area(ring(3 * hexagon, 5.0)) == pytest.approx(6 * 3 * 5.0)
    assert area(tube(3 * hexagon, 1 * hexagon, 2.0)) == pytest.approx(1.5 * np.sqrt(3) * (9 - 1))
    block = box((-1, 0, 2), (2, 4, 3))
    assert area(block) == pytest.approx(2 * (3 * 4 + 4 * 1 + 3 * 1))
    assert abs(volume(block)) == pytest.approx(12.0)
    axes = np.array([-1.0, 0.5, 2.0]), np.array([0.0, 1.0, 3.0, 4.0]), np.array([2.0, 3.0])
    lattice = Lattice(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
    faces, nodes, cells = lattice.surface()
    assert area(faces) == pytest.approx(area(block))
    np.testing.assert_array_equal(lattice.points.reshape(-1, 3)[nodes].T, faces.points)
    assert sorted(set(cells.tolist())) == list(range(6))
    assert (faces.points[2, faces.triangles[:, :12]] == 2.0).all()
    both = joined([block, block.shifted(10.0)])
    assert abs(volume(both)) == pytest.approx(24.0)
    standing = ring(hexagon, 4.0).upright(7.0)
    assert (standing.points[1].min(), standing.points[1].max()) == (5.0, 9.0)
