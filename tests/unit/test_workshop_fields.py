"""The workshop in a case file: what it orders, and what is refused."""

from __future__ import annotations

import csv
import datetime as dt
import io
import json
import re
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.fits import keyway_depth_deviations, size_deviations
from camwright.pipeline.base.spreadsheets import Excerpt, spreadsheet
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.finite_length.axial_drop import TabulatedCrown
from camwright.pipeline.results.workshop_files import part_title, stamp_solid, write_workshop

LIMITS = "[limits]\n"
ORDER = '[workshop]\ntable_step = "0.25 deg"\ntool_radius = "6 mm"\narc_error = "2 um"\n'


GROUND = '\n[tolerances]\nsource = "ground track"\n'


def case(workshop: str = ORDER, limits: str = "", cam: str = "", tail: str = "") -> Case:
    text = small_machine("part")
    own = text[text.index("[workshop]") : text.index("# --- Load cases")]
    text = text.replace(own, workshop).replace(LIMITS, LIMITS + limits)
    return parse_case(text.replace("[cam]\n", "[cam]\n" + cam) + tail)


def contour(of: Case) -> Contour:
    theta = uniform_turn(360)
    return of.contour(Lift(theta, 0.005 * (1 - np.cos(theta))))


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))


def test_the_files_are_those_ordered(tmp_path: Path) -> None:
    import ezdxf

    of = case(cam='profile_tolerance = "16 um"\n', tail=GROUND)
    drawn, said = contour(of), []
    write_workshop(tmp_path, of, drawn, said.append)
    assert said == []
    table, cutter = rows(tmp_path / "contour.csv"), rows(tmp_path / "cutter.csv")
    assert len(table) == len(cutter) == 1440
    assert [float(row["cam_angle_deg"]) for row in table[:3]] == [0.0, 0.25, 0.5]
    theta = np.radians([float(row["cam_angle_deg"]) for row in cutter])
    centre = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in cutter]).T
    # the writer rounds nothing: the same point to the last digits of a double
    np.testing.assert_allclose(1e-3 * centre, cutter_path(drawn, 6e-3, theta).centre, atol=1e-15)
    sheet = rows(tmp_path / "inspection.csv")
    assert {row["deviation_max_mm"] for row in sheet} == {"0.008"}  # half of the band
    notes = ezdxf.readfile(tmp_path / "contour.dxf").modelspace().query("TEXT[layer=='note']")
    assert "arcs within 0.002 mm" in notes[0].dxf.text


TITLE = (
    '\n[document]\npart_number = "4711"\nrevision = "B"\nproject = "press"\nauthor = "A. Meyer"\n'
    "date = 2026-01-31\n"
)


def test_the_solid_is_named_after_the_case_and_its_title_block(tmp_path: Path) -> None:
    of = case(tail=TITLE)
    write_workshop(tmp_path, of, contour(of))
    stamp_solid(tmp_path, "a" * 64, "b" * 64)
    text = (tmp_path / "cam.step").read_text(encoding="ascii")
    assert f"PRODUCT('4711','{of.name}','press'," in text
    assert f"FILE_NAME('{of.name}','2026-01-31T00:00:00',('A. Meyer')" in text
    assert f"'material {of.cam.material.name}" in text
    assert f"'results SHA-256 {'b' * 64}'" in text
    assert part_title(case()).number == part_title(case()).date == ""
    stamp_solid(tmp_path / "nowhere", "a" * 64, "b" * 64)  # no solid was made


def test_without_an_order_the_tables_are_half_a_degree_apart_and_the_roller_is_the_tool() -> None:
    order = case("").workshop_order
    assert np.degrees(order.step) == pytest.approx(0.5)
    assert (order.tool_radius, order.arc_error, order.tolerance) == (None, 1e-6, 1e-4)


def test_the_tool_of_the_limits_is_the_workshops_unless_it_has_its_own() -> None:
    assert case("", 'tool_radius = "9 mm"\n').workshop_order.tool_radius == pytest.approx(9e-3)
    both = case(limits='tool_radius = "9 mm"\n')
    assert both.workshop_order.tool_radius == pytest.approx(6e-3)
    assert both.largest_tool == pytest.approx(9e-3)  # which the hollows have to let in
    assert case().largest_tool == pytest.approx(6e-3)
    assert case("").largest_tool is None


def test_a_resolved_case_orders_the_same() -> None:
    of = case()
    again = parse_case(of.to_toml())
    assert again.workshop == of.workshop
    assert again.workshop_order == of.workshop_order


def test_a_tool_too_large_for_a_hollow_leaves_its_file_out_and_says_so(tmp_path: Path) -> None:
    of = case('[workshop]\ntool_radius = "400 mm"\n')
    theta = uniform_turn(360)
    hollow = of.contour(Lift(theta, 0.010 * (1 - np.cos(3 * theta))))
    assert hollow.concave_radius_min().value < 0.4
    said: list[str] = []
    write_workshop(tmp_path, of, hollow, said.append)
    assert "workshop/cutter.csv is left out" in said[0]
    assert not (tmp_path / "cutter.csv").exists()
    assert (tmp_path / "contour.dxf").is_file()


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            'table_step = "0.099 deg"',
            "workshop.table_step = 0.099 deg, must be >= 0.1 and <= 1 deg",
        ),
        (
            'table_step = "1.001 deg"',
            "workshop.table_step = 1.001 deg, must be >= 0.1 and <= 1 deg",
        ),
        ("table_step = 0.5", "workshop.table_step = 0.5, must be a number with a unit"),
        ('table_step = "nan deg"', "workshop.table_step = nan deg, must be finite"),
        ('table_step = "0.5 mm"', "workshop.table_step = 0.5 mm, must be in a unit of"),
        ("table_step = []", "workshop.table_step = "),
        ('tool_radius = "0 mm"', "workshop.tool_radius = 0 mm, must be > 0"),
        ('tool_radius = "-5 mm"', "workshop.tool_radius = -5 mm, must be > 0"),
        ('tool_radius = "inf mm"', "workshop.tool_radius = inf mm, must be finite"),
        ('tool_radius = "1e5 mm"', "workshop.tool_radius = 1e5 mm, must be > 0 and <= 10000 mm"),
        ("tool_radius = true", "workshop.tool_radius = true, must be a number with a unit"),
        ('arc_error = "0 um"', "workshop.arc_error = 0 um, must be >= 0.001 and <= 1000 um"),
        ('arc_error = "2 mm"', "workshop.arc_error = 2 mm, must be >= 0.001 and <= 1000 um"),
        ('arc_eror = "1 um"', "did you mean arc_error?"),
        ('tool_radius = "<script>alert(1)</script>"', "must be a number with a unit"),
    ],
)
def test_what_no_workshop_could_mean_is_refused(line: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        case(f"[workshop]\n{line}\n")
    assert message in str(refusal.value)


def test_a_tool_larger_than_the_hollows_are_checked_for_is_refused() -> None:
    with pytest.raises(InputError, match=r"tool_radius = 6 mm, must be <= limits\.tool_radius = "):
        case(limits='tool_radius = "5 mm"\n')


DOCUMENT = """
[document]
project = "Idle of a one-cylinder engine"
part_number = "CW-0042"
revision = "B"
author = "A. Engineer"
date = 2026-03-02
material = "16MnCr5, case-hardened"
"""


def test_title_block_is_read_back_and_stands_in_the_drawing(tmp_path: Path) -> None:
    import ezdxf

    of = case('[workshop]\nbore_fit = "H6"\n' + DOCUMENT)
    assert parse_case(of.to_toml()).document == of.document
    assert of.document.date == dt.date(2026, 3, 2)
    write_workshop(tmp_path, of, contour(of))
    notes = ezdxf.readfile(tmp_path / "contour.dxf").modelspace().query("TEXT[layer=='note']")
    text = "\n".join(note.dxf.text for note in notes)
    for words in ("CW-0042, revision B", "material 16MnCr5, case-hardened", " H6 (+"):
        assert words in text


def test_title_block_is_optional_and_its_entries_are_short_lines() -> None:
    assert set(case().document.model_dump().values()) == {None}
    for line in ('author = ""', f'project = "{"x" * 61}"', 'date = "today"', "date = 2026-13-01"):
        with pytest.raises(InputError):
            case(f"[workshop]\n[document]\n{line}\n")


def test_the_former_name_of_the_error_of_the_drawing_is_read() -> None:
    assert case('[workshop]\nchord_error = "2 um"\n').workshop.arc_error == pytest.approx(2e-6)


@pytest.mark.parametrize(
    ("size", "fit", "bounds"),
    [  # of ISO 286-2 and DIN 6885-1
        (17.0, "H7", (0.0, 18.0)), (18.0, "H7", (0.0, 18.0)), (18.1, "H7", (0.0, 21.0)),
        (25.0, "H6", (0.0, 13.0)), (50.0, "H8", (0.0, 39.0)), (3.0, "JS9", (-12.5, 12.5)),
        (5.0, "JS9", (-15.0, 15.0)), (5.0, "P9", (-42.0, -12.0)), (8.0, "P9", (-51.0, -15.0)),
        (500.0, "H7", (0.0, 63.0)),
    ],
)  # fmt: skip
def test_deviations_of_the_standard(size: float, fit: str, bounds: tuple[float, float]) -> None:
    assert size_deviations(1e-3 * size, fit) == pytest.approx(np.multiply(bounds, 1e-6))


def test_sizes_beyond_the_standard_have_no_deviations() -> None:
    assert size_deviations(0.501, "H7") is None
    assert keyway_depth_deviations(0.101) is None
    upper = {width: keyway_depth_deviations(1e-3 * width).upper for width in (6, 8, 32, 36)}
    assert upper == pytest.approx({6: 1e-4, 8: 2e-4, 32: 2e-4, 36: 3e-4})
    with pytest.raises(InputError):
        size_deviations(float("nan"), "H7")


def test_radii_of_the_dimensions_are_those_of_the_contour_table(tmp_path: Path) -> None:
    """Between the points of the table by a periodic spline, 0.25 deg apart."""
    of = case()
    write_workshop(tmp_path, of, contour(of))
    record = json.loads((tmp_path / "dimensions.json").read_text())
    table = rows(tmp_path / "contour.csv")
    polar = np.unwrap(np.radians([float(row["polar_angle_deg"]) for row in table]))
    radius = np.array([float(row["radius_mm"]) for row in table])
    start = polar[0]
    turn = CubicSpline(
        np.append(polar, start + 2 * np.pi), np.append(radius, radius[0]), bc_type="periodic"
    )
    stated = {np.radians(float(key)): value for key, value in record["radii_mm"].items()}
    assert len(stated) == 36
    at = np.array(list(stated))
    np.testing.assert_allclose(
        turn(start + (at - start) % (2 * np.pi)), list(stated.values()), rtol=1e-7
    )
    assert record["radius_max"]["radius_mm"] == pytest.approx(radius.max(), rel=1e-5)
    assert record["bore"]["nominal_mm"] == pytest.approx(2e3 * of.cam.bore_radius)
    assert record["arc_error_um"] == pytest.approx(2.0)


CROWN = 'crown = { kind = "lundberg", line_load = "200 N/mm" }\n'


def test_the_crown_of_a_body_is_a_sheet_that_a_case_reads(tmp_path: Path) -> None:
    """Drop by Lundberg's formula; at the ends, where it is not bounded, it is left out."""
    of = case(cam=CROWN)
    write_workshop(tmp_path, of, contour(of))
    sheet = rows(tmp_path / "crown_cam.csv")
    y, drop = (np.array([float(row[name]) for row in sheet]) for name in ("y_mm", "drop_um"))
    machine = machines(of)[0]
    share = 2e-3 * y / machine.contact_width
    expected = 1e6 * 200e3 / (np.pi * machine.contact_modulus) * -np.log(1.0 - share**2)
    np.testing.assert_allclose(drop, expected, rtol=1e-9, atol=1e-12)
    assert share.max() == pytest.approx(0.95)
    assert {row["measured_drop_um"] + row["deviation_um"] for row in sheet} == {""}
    table = TabulatedCrown.read(tmp_path / "crown_cam.csv")
    np.testing.assert_allclose(table.drop(1e-3 * y), 1e-6 * drop, rtol=1e-12)
    tracks = json.loads((tmp_path / "dimensions.json").read_text())["tracks"]
    assert tracks["cam"]["crown"]["drop_um"] == pytest.approx(drop.tolist())
    assert tracks["cam"]["end"] == {"kind": "sharp", "size_mm": 0.0}
    assert tracks["roller"]["crown"] is None
    assert tracks["roller"]["end"] == {"kind": "chamfer", "size_mm": 0.5}
    assert tracks["roller"]["flat_width_mm"] == pytest.approx(10.0)
    assert not (tmp_path / "crown_roller.csv").exists()


def test_the_workbook_of_the_inspection_has_a_sheet_of_the_crown(tmp_path: Path) -> None:
    of = case(cam=CROWN)
    write_workshop(tmp_path, of, contour(of))
    one = Excerpt("every 10 deg", "cam_angle_deg", 10.0, {"crown": "crown_cam.csv"})
    with zipfile.ZipFile(io.BytesIO(spreadsheet(tmp_path / "inspection.csv", one))) as book:
        names = re.findall('<sheet name="([^"]*)"', book.read("xl/workbook.xml").decode())
        texts = book.read("xl/sharedStrings.xml").decode()
    assert names == ["every 10 deg", "crown", "all"]
    assert "measured_drop_um" in texts
    other = replace(one, beside={"crown": "crown_roller.csv"})
    with zipfile.ZipFile(io.BytesIO(spreadsheet(tmp_path / "inspection.csv", other))) as book:
        assert "measured_drop_um" not in book.read("xl/sharedStrings.xml").decode()
