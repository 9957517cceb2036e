"""What the shop reads back is the contour: DXF by ezdxf, STEP by gmsh, tables, cutter path."""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from cam_parts import Keyway

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.cad_drawing import LAYERS, Outline, chords, write_dxf
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.cutouts import keyway_corners
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.gmsh_mesher import session
from camwright.meshes.step_solid import write_step
from camwright.pipeline.results.workshop_files import contour_table, inspection_sheet

THETA = uniform_turn(360)
BORE, WIDTH, KEYWAY = 0.010, 0.015, Keyway(0.005, 0.0023, 0.4)
WITHIN = 1e-6  # relative, of area, perimeter and greatest radius: what the drawing promises
MM = 1e-3


def wavy(offset: float = 0.002) -> Contour:
    """Convex and hollow flanks, an offset follower."""
    lift = Lift(THETA, 0.005 * (1 - np.cos(THETA - 0.4)) + 0.010 * np.sin(2 * THETA) ** 2)
    return RollerContour(PitchCurve(lift, 0.050, offset), 0.008)


def circle() -> Contour:
    return RollerContour(PitchCurve(Lift(THETA, np.zeros(360)), 0.050), 0.008)


def polygon_measures(points: np.ndarray) -> tuple[float, float]:
    """Area and perimeter of a closed polygon (2, n)."""
    step = np.roll(points, -1, axis=1) - points
    area = 0.5 * np.sum(points[0] * step[1] - points[1] * step[0])
    return float(area), float(np.sum(np.hypot(*step)))


@pytest.fixture(scope="module", params=[wavy, circle], ids=["wavy", "circle"])
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    """A contour and its drawing read back."""
    import ezdxf

    contour = request.param()
    path = tmp_path_factory.mktemp("dxf") / "contour.dxf"
    error = write_dxf(path, Outline(contour, BORE, KEYWAY))
    document = ezdxf.readfile(path)
    assert not document.audit().has_errors
    return contour, error, document


def on_layer(document, layer: str, kind: str):
    return [e for e in document.modelspace() if e.dxf.layer == layer and e.dxftype() == kind]


def test_chords_of_the_drawing_are_the_contour(drawn) -> None:
    contour, error, document = drawn
    (line,) = on_layer(document, "surface", "LWPOLYLINE")
    points = np.array(line.get_points("xy")).T * MM
    area, perimeter = polygon_measures(points)
    assert line.closed
    assert area == pytest.approx(contour.area(), rel=WITHIN)
    assert perimeter == pytest.approx(contour.perimeter(), rel=WITHIN)
    assert np.hypot(*points).max() == pytest.approx(contour.radius_max().value, rel=WITHIN)
    # the sagitta of every chord, measured on the contour itself, is as the drawing states
    theta = chords(contour).theta
    middle = contour.points(0.5 * (theta + np.append(theta[1:], theta[0] + 2 * np.pi)))
    chord = np.roll(points, -1, axis=1) - points
    across = np.abs(chord[0] * (middle - points)[1] - chord[1] * (middle - points)[0])
    sagitta = across / np.hypot(*chord)
    assert sagitta.max() <= error
    assert sagitta.max() >= 0.8 * error  # no finer than said either: a drawing is to be small
    (note,) = on_layer(document, "note", "TEXT")
    assert f"{error / MM:.6g} mm" in note.dxf.text


def test_spline_of_the_drawing_is_the_contour(drawn) -> None:
    contour, _, document = drawn
    (spline,) = on_layer(document, "surface", "SPLINE")
    tool = spline.construction_tool()
    at = np.linspace(0.0, tool.max_t, 20_001)[:-1]
    points = np.array([(p.x, p.y) for p in tool.points(at)]).T * MM
    area, perimeter = polygon_measures(points)
    assert spline.closed
    assert area == pytest.approx(contour.area(), rel=WITHIN)
    assert perimeter == pytest.approx(contour.perimeter(), rel=WITHIN)
    assert np.hypot(*points).max() == pytest.approx(contour.radius_max().value, rel=WITHIN)


def test_drawing_has_its_layers_in_millimetres(drawn) -> None:
    _, _, document = drawn
    assert document.header["$INSUNITS"] == 4
    assert {layer.dxf.name for layer in document.layers} >= set(LAYERS)
    assert len(on_layer(document, "pitch", "SPLINE")) == 1
    (arc,) = on_layer(document, "bore", "ARC")
    (slot,) = on_layer(document, "keyway", "LWPOLYLINE")
    corners = np.array(slot.get_points("xy")) * MM
    assert arc.dxf.radius == pytest.approx(BORE / MM, rel=1e-12)
    assert np.hypot(*corners[0]) == pytest.approx(BORE, rel=1e-12)
    assert np.hypot(*(corners[2] - corners[1])) == pytest.approx(KEYWAY.width, rel=1e-12)
    ends = np.array([(arc.start_point.x, arc.start_point.y), (arc.end_point.x, arc.end_point.y)])
    np.testing.assert_allclose(ends * MM, corners[[3, 0]], atol=1e-12)


def test_files_are_the_same_whatever_day_and_process(tmp_path: Path) -> None:
    """Another hash seed orders sets otherwise; the CAD kernel numbers the solids of a process."""
    lines = f"""
import sys
from pathlib import Path
sys.path[:0] = {sys.path!r}
from test_shop_round_trip import BORE, KEYWAY, WIDTH, Outline, circle, write_dxf, write_step
outline, folder = Outline(circle(), BORE, KEYWAY), Path(sys.argv[1])
write_dxf(folder / "contour.dxf", outline)
for name in ("cam.step", "again.step"):
    write_step(folder / name, outline, WIDTH)
"""
    written = []
    for seed in ("3", "4"):
        folder = tmp_path / seed
        folder.mkdir()
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        subprocess.run([sys.executable, "-c", lines, str(folder)], env=environment, check=True)
        written.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert set(written[0]) == {"contour.dxf", "cam.step", "again.step"}
    assert written[0] == written[1]
    assert written[0]["cam.step"] == written[0]["again.step"]
    assert b"1970-01-01T00:00:00" in written[0]["cam.step"]


def test_circle_cam_gives_a_circle(tmp_path: Path) -> None:
    import ezdxf

    path = tmp_path / "circle.dxf"
    write_dxf(path, Outline(circle(), BORE))
    space = ezdxf.readfile(path).modelspace()
    (spline,) = space.query("SPLINE[layer=='surface']")
    (line,) = space.query("LWPOLYLINE[layer=='surface']")
    (bore,) = space.query("CIRCLE[layer=='bore']")
    tool = spline.construction_tool()
    radii = [np.hypot(p.x, p.y) for p in tool.points(np.linspace(0, tool.max_t, 5001))]
    np.testing.assert_allclose(radii, 42.0, atol=2e-6)  # mm: the spline's own bound is 1e-6
    np.testing.assert_allclose(np.hypot(*np.array(line.get_points("xy")).T), 42.0, atol=1e-11)
    assert bore.dxf.radius == pytest.approx(10.0, rel=1e-12)


@pytest.mark.parametrize("make", [wavy, circle])
def test_solid_read_back_by_gmsh(make, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    contour, path = make(), tmp_path / "cam.step"
    write_step(path, Outline(contour, BORE, KEYWAY), WIDTH)
    assert capfd.readouterr().out == ""
    half, turn = 0.5 * KEYWAY.width, np.arcsin(0.5 * KEYWAY.width / BORE)
    mouth = BORE * np.cos(turn)
    hole = np.pi * BORE**2 + 2 * half * (BORE + KEYWAY.depth - mouth)
    hole -= BORE**2 * turn - half * mouth  # the cap of the bore that the slot takes in
    with session() as gmsh:
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        ((_, solid),) = gmsh.model.getEntities(3)
        volume = gmsh.model.occ.getMass(3, solid) * MM**3
        box = np.array(gmsh.model.occ.getBoundingBox(3, solid)) * MM
        length, radius = 0.0, 0.0
        for _, curve in gmsh.model.getEntities(1):
            if gmsh.model.getType(1, curve) == "BSpline":
                length += gmsh.model.occ.getMass(1, curve) * MM
                low, high = (bound[0] for bound in gmsh.model.getParametrizationBounds(1, curve))
                at = np.linspace(low, high, 20_001)
                x, y, _ = np.array(gmsh.model.getValue(1, curve, at)).reshape(-1, 3).T * MM
                radius = max(radius, float(np.hypot(x, y).max()))
    assert volume / WIDTH + hole == pytest.approx(contour.area(), rel=WITHIN)
    assert length == pytest.approx(2 * contour.perimeter(), rel=WITHIN)  # top and bottom
    assert radius == pytest.approx(contour.radius_max().value, rel=WITHIN)
    assert box[5] - box[2] == pytest.approx(WIDTH, abs=1e-8)


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


def test_stated_chord_error_is_kept_at_any_size() -> None:
    for error in (1e-5, 1e-6):
        found = chords(wavy(), error)
        assert found.error == error
        close = chords(wavy(), 0.25 * error)
        # a quarter of the error takes twice the chords; three more are cut at any size, and one
        # may be owed to rounding up
        assert 2 * found.theta.size - close.theta.size in (3, 4)


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
