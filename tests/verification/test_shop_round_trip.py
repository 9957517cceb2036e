"""What the shop reads back is the contour: DXF by ezdxf, tables, cutter path."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from cam_parts import Keyway
from ezdxf.math import bulge_center
from scipy.spatial import cKDTree

from camwright.geometry.arc_polyline import ARC_ERROR, arc_polyline
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.cad_drawing import CUT, LAYERS, Outline, write_dxf
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.cutouts import keyway_corners
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.results.workshop_files import contour_table, inspection_sheet

THETA = uniform_turn(360)
BORE, KEYWAY = 0.010, Keyway(0.005, 0.0023, 0.4)
WITHIN = 1e-6  # relative, of area, perimeter and greatest radius: what the drawing promises
MM = 1e-3


def wavy(offset: float = 0.002) -> Contour:
    """Convex and hollow flanks, an offset follower."""
    lift = Lift(THETA, 0.005 * (1 - np.cos(THETA - 0.4)) + 0.010 * np.sin(2 * THETA) ** 2)
    return RollerContour(PitchCurve(lift, 0.050, offset), 0.008)


def circle() -> Contour:
    return RollerContour(PitchCurve(Lift(THETA, np.zeros(360)), 0.050), 0.008)


def keyed_hole() -> tuple[float, float]:
    """Area and perimeter of bore and keyway, m^2 and m."""
    half, turn = 0.5 * KEYWAY.width, np.arcsin(0.5 * KEYWAY.width / BORE)
    mouth = BORE * np.cos(turn)
    area = np.pi * BORE**2 + 2 * half * (BORE + KEYWAY.depth - mouth)
    area -= BORE**2 * turn - half * mouth  # the cap of the bore that the slot takes in
    return area, 2 * (BORE * (np.pi - turn) + BORE + KEYWAY.depth - mouth + half)


def polygon_measures(points: np.ndarray) -> tuple[float, float]:
    """Area and perimeter of a closed polygon (2, n)."""
    step = np.roll(points, -1, axis=1) - points
    area = 0.5 * np.sum(points[0] * step[1] - points[1] * step[0])
    return float(area), float(np.sum(np.hypot(*step)))


def swept(line) -> np.ndarray:
    """Points (2, n), m, along a closed polyline, with the centres that ezdxf reads of its arcs."""
    rows = line.get_points("xyb")
    share = np.arange(4000) / 4000
    points = []
    for (x, y, bulge), (to_x, to_y, _) in zip(rows, rows[1:] + rows[:1], strict=True):
        if bulge == 0.0:
            points.append(np.array([[x], [y]]) + np.outer((to_x - x, to_y - y), share))
            continue
        centre = bulge_center((x, y), (to_x, to_y), bulge)
        reach = complex(x - centre.x, y - centre.y)
        turned = complex(centre.x, centre.y) + reach * np.exp(4j * np.arctan(bulge) * share)
        points.append(np.stack([turned.real, turned.imag]))
    return np.hstack(points) * MM


@pytest.fixture(scope="module", params=[wavy, circle], ids=["wavy", "circle"])
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    """A contour, its drawing read back, and the arcs that it returned."""
    contour = request.param()
    path = tmp_path_factory.mktemp("dxf") / "contour.dxf"
    arcs = write_dxf(path, Outline(contour, BORE, KEYWAY), notes=("bore\n17 H7",))
    document = ezdxf.readfile(path)
    assert not document.audit().has_errors
    return contour, arcs, document


def on_layer(document, layer: str, kind: str):
    return [e for e in document.modelspace() if e.dxf.layer == layer and e.dxftype() == kind]


def test_the_cutting_layer_has_one_contour_and_one_hole(drawn) -> None:
    contour, arcs, document = drawn
    cut = document.modelspace().query(f"*[layer=='{CUT}']")
    assert [(e.dxftype(), e.closed) for e in cut] == 2 * [("LWPOLYLINE", True)]
    outer, hole = (swept(line) for line in cut)
    area, perimeter = polygon_measures(outer)
    assert area == pytest.approx(contour.area(), rel=WITHIN)
    assert perimeter == pytest.approx(contour.perimeter(), rel=1e-5)
    assert arcs.area == pytest.approx(area, rel=2e-7)
    assert np.hypot(*outer).max() == pytest.approx(contour.radius_max().value, abs=ARC_ERROR)
    assert len(cut[0]) == arcs.bulges.size <= 300
    area, perimeter = polygon_measures(hole)
    exact, around = keyed_hole()
    assert (area, perimeter) == (pytest.approx(exact, rel=WITHIN), pytest.approx(around, rel=1e-5))
    assert max(abs(bulge) for *_, bulge in cut[1].get_points("xyb")) < 1.0  # no more than half


def test_arcs_are_within_the_stated_error(drawn) -> None:
    """Each point of the arcs against the nearest of a dense polygon on the contour."""
    contour, arcs, document = drawn
    outer = swept(on_layer(document, CUT, "LWPOLYLINE")[0])
    tree = cKDTree(contour.polygon(400_000).T)
    apart = tree.query(outer.T)[0]
    spacing = contour.perimeter() / 400_000
    assert apart.max() <= 1.05 * ARC_ERROR + spacing
    assert arcs.error <= ARC_ERROR
    texts = [e.dxf.text for e in on_layer(document, "note", "TEXT")]
    assert "arcs within 0.001 mm" in texts[0]
    assert texts[1] == "bore 17 H7"  # on one line


def test_other_layers_do_not_plot_and_extents_are_set(drawn) -> None:
    contour, _, document = drawn
    assert document.header["$INSUNITS"] == 4
    plots = {layer.dxf.name: bool(layer.dxf.plot) for layer in document.layers}
    assert {name: plots[name] for name in LAYERS} == dict(LAYERS)
    assert len(on_layer(document, "pitch", "SPLINE")) == 1
    low, high = (np.array(document.header[f"$EXT{end}"])[:2] * MM for end in ("MIN", "MAX"))
    corners = contour.polygon(10_000)
    assert (low <= corners.min(axis=1)).all()
    assert (corners.max(axis=1) <= high).all()
    assert (np.abs([low, high]) < 5 * contour.radius_max().value).all()


def test_line_of_angle_zero_goes_through_the_contour_there(drawn) -> None:
    contour, _, document = drawn
    (line, *_) = on_layer(document, "mark", "LINE")
    assert (line.dxf.start.x, line.dxf.start.y, line.dxf.end.y) == (0.0, 0.0, 0.0)
    assert line.dxf.end.x * MM >= contour.radius_max().value


@pytest.mark.parametrize("error", [3e-7, 1e-7])
def test_a_smaller_error_takes_more_arcs(error: float) -> None:
    arcs, finer = arc_polyline(wavy(), error), arc_polyline(wavy(), error / 10.0)
    assert 0.2 * error < arcs.error <= error
    # the distance of a pair grows with the cube of its length
    assert finer.bulges.size / arcs.bulges.size == pytest.approx(10 ** (1 / 3), rel=0.3)


def test_arcs_finer_than_numbers_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.modules[arc_polyline.__module__], "_PART_HALVINGS", 5)
    with pytest.raises(GeometryError, match="must be <= 1e-21 m"):
        arc_polyline(wavy(), 1e-21)
    with pytest.raises(InputError):
        arc_polyline(wavy(), 0.0)


def test_drawing_is_the_same_whatever_the_process(tmp_path: Path) -> None:
    """Another hash seed orders sets otherwise."""
    lines = f"""
import sys
from pathlib import Path
sys.path[:0] = {sys.path!r}
from test_shop_round_trip import BORE, KEYWAY, Outline, circle, write_dxf
write_dxf(Path(sys.argv[1]), Outline(circle(), BORE, KEYWAY))
"""
    for seed in ("3", "4"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        command = [sys.executable, "-c", lines, str(tmp_path / seed)]
        subprocess.run(command, env=environment, check=True)
    assert (tmp_path / "3").read_bytes() == (tmp_path / "4").read_bytes()


def test_circle_cam_gives_a_circle(tmp_path: Path) -> None:
    path = tmp_path / "circle.dxf"
    arcs = write_dxf(path, Outline(circle(), BORE))
    space = ezdxf.readfile(path).modelspace()
    (line,) = space.query(f"LWPOLYLINE[layer=='{CUT}']")
    (bore,) = space.query(f"CIRCLE[layer=='{CUT}']")
    np.testing.assert_allclose(np.hypot(*swept(line)) / MM, 42.0, atol=1e-6)
    np.testing.assert_allclose(arcs.bulges, np.tan(np.pi / arcs.bulges.size / 2), rtol=1e-9)
    assert arcs.area == pytest.approx(np.pi * 0.042**2, rel=1e-12)
    assert bore.dxf.radius == pytest.approx(10.0, rel=1e-12)


def test_cutter_of_the_rollers_radius_walks_the_pitch_curve() -> None:
    contour = wavy()
    path = cutter_path(contour, contour.roller_radius, THETA)
    np.testing.assert_allclose(path.centre, contour.pitch.points(THETA), atol=1e-15)
    np.testing.assert_allclose(
        path.radius_of_curvature, contour.pitch.radius_of_curvature(THETA), rtol=1e-12
    )


def test_cutter_stays_off_the_contour_by_its_radius() -> None:
    contour = wavy()
    radius = 0.9 * contour.concave_radius_min().value
    centre = cutter_path(contour, radius, THETA[::20]).centre
    surface = contour.polygon(20_000)
    least = [np.hypot(*(surface - c[:, None])).min() for c in centre.T]
    np.testing.assert_allclose(least, radius, rtol=1e-6)


def test_cutter_larger_than_a_hollow_is_refused() -> None:
    contour = wavy()
    hollow = contour.concave_radius_min().value
    assert np.isfinite(hollow)
    cutter_path(contour, 0.99 * hollow, THETA)
    with pytest.raises(GeometryError, match="concave radius"):
        cutter_path(contour, 1.01 * hollow, THETA)
    with pytest.raises(InputError):
        cutter_path(contour, 0.0, THETA)


def test_tables_hold_the_contour_to_the_last_digit() -> None:
    contour, theta = wavy(), uniform_turn(720)
    rows = list(csv.DictReader(contour_table(contour, theta).splitlines()))
    assert len(rows) == 720
    got = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in rows]).T * MM
    np.testing.assert_allclose(got, contour.points(theta), rtol=0, atol=1e-16)
    third = np.array([float(row["lift_d3_mm_per_rad3"]) for row in rows]) * MM
    np.testing.assert_allclose(third, contour.pitch.lift(theta, 3), rtol=1e-14, atol=1e-16)


def test_inspection_sheet_leaves_the_measured_columns_empty() -> None:
    rows = list(csv.DictReader(inspection_sheet(wavy(), THETA, 20e-6).splitlines()))
    assert {row["measured_x_mm"] + row["measured_y_mm"] + row["deviation_mm"] for row in rows} == {
        ""
    }
    assert {(row["deviation_min_mm"], row["deviation_max_mm"]) for row in rows} == {
        ("-0.01", "0.01")
    }


def test_keyway_wider_than_the_bore_is_refused() -> None:
    with pytest.raises(InputError):
        keyway_corners(0.002, KEYWAY)
