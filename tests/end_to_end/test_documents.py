"""Sheet to sign and shop drawing: one page, no text on text, whatever a case says."""

from __future__ import annotations

import dataclasses
import datetime as dt
import json
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import printed_text
import report_fixture
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import ResultError
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.results.workshop_files import dimensions_record
from camwright.reports import documents, figure_svg
from camwright.reports.drawing.part_view import scale_words, standard_scale
from camwright.reports.report_data import ReportMaterial, read_material
from camwright.reports.report_tables import input_tables

LONG = "W" * 60
DOCUMENT = {
    "project": LONG, "part_number": LONG, "revision": "W" * 12, "author": LONG,
    "date": dt.date(2026, 3, 2), "material": LONG,
}  # fmt: skip


def with_document(material: ReportMaterial, **more: object) -> ReportMaterial:
    return dataclasses.replace(material, case={**material.case, "document": DOCUMENT, **more})


def longest(folder: Path) -> ReportMaterial:
    """A run whose every text is as long as it may be, with more checks and values than fit."""
    one = report_fixture.checks()
    values = [f"materials.a_long_name_{k}.endurance_pressure" for k in range(90)]
    records = [
        one[k % len(one)] | {"id": f"check_{k}", "title": f"{k} " + 40 * "word ", "must_have": True,
                             "load_case": "w" * 40, "to_be_confirmed": values}
        for k in range(60)
    ]  # fmt: skip
    records += [one[0] | {"id": f"life_{k}", "title": 30 * "life ", "unit": "h"} for k in range(4)]
    report_fixture.write_run(
        folder, 36, title=40 * "title ", load_case="w" * 40, records=records, field=False,
        scope={"not_covered": ["key", "gear", "fork", "pin"], "reason": 100 * "because "},
    )  # fmt: skip
    lubricant = {"viscosity": "24 mPa s", "source": 60 * "oil ", "temperature": "353.15 K"}
    return with_document(read_material(folder), lubricant=lubricant)


def test_the_longest_sheet_is_one_page(tmp_path: Path) -> None:
    material = longest(tmp_path / "run")
    (page,) = printed_text.pages(documents.write_signoff(material)[0])
    assert printed_text.covered(page) == []
    words = printed_text.words_on(page)
    for text in ("Checked", "Signature", "Valuestobeconfirmed(90)", "more", "2026-03-02"):
        assert text in words
    low = min(glyph.y0 for glyph in printed_text.glyphs(page))
    assert low * printed_text.POINT > 5.0  # nothing runs off the sheet


def test_text_on_text_is_found(tmp_path: Path) -> None:
    """On the same page, with one glyph moved on another."""
    report_fixture.write_run(tmp_path / "run", 36, field=False)
    (page,) = printed_text.pages(documents.write_signoff(read_material(tmp_path / "run"))[0])
    assert printed_text.covered(page) == []
    every = printed_text.glyphs(page)
    every[0].x0, every[0].x1 = every[9].x0, every[9].x1
    every[0].y0, every[0].y1 = every[9].y0, every[9].y1
    assert len(printed_text.covered(page)) >= 1


def test_entries_left_out_are_fields_to_fill_and_bytes_repeat(tmp_path: Path) -> None:
    report_fixture.write_run(tmp_path / "run", 36, field=False)
    material = read_material(tmp_path / "run")
    content = documents.sheet_content(material)
    assert dict(content.block) == dict.fromkeys(
        ("Project", "Part number", "Revision", "Author", "Date", "Material"), ""
    )
    first = documents.write_signoff(material)[0].read_bytes()
    assert documents.write_signoff(read_material(tmp_path / "run"))[0].read_bytes() == first
    stated = documents.sheet_content(with_document(material))
    assert dict(stated.block)["Date"] == "2026-03-02"


def test_a_viscosity_of_an_oil_card_is_printed_to_four_digits(tmp_path: Path) -> None:
    """Interpolated to the temperature of the contact, it has as many digits as a number can."""
    folder = report_fixture.write_run(tmp_path / "run", 36, field=False)
    oil = {"viscosity": "244.02473435384217 mPa s", "source": "a card"}
    material = with_document(read_material(folder), lubricant=oil)
    facts = dict(documents.sheet_content(material).facts)
    assert facts["Lubricant"].endswith("244 mPa s, a card")


def test_a_source_to_be_confirmed_is_printed_as_such(tmp_path: Path) -> None:
    """In words wherever a sheet names it, never as the table of the case file."""
    folder = report_fixture.write_run(tmp_path / "run", 36, field=False)
    stated = {"text": "ISO VG 150, a card", "confirmed": False}
    oil = {"viscosity": "24 mPa s", "source": stated, "sources": {"viscosity": stated}}
    material = with_document(read_material(folder), lubricant=oil)
    facts = dict(documents.sheet_content(material).facts)
    words = "ISO VG 150, a card (to be confirmed)"
    assert facts["Lubricant"].endswith(f"24 mPa s, {words}")
    table = next(each for each in input_tables(material.case) if each.title == "lubricant")
    assert table.source == words and [row[-1] for row in table.rows] == [words]


def test_the_report_prints_the_title_block_with_its_date(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Figures left blank, whose printing `test_pdf` looks at."""
    blank = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 20"></svg>'
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: blank)
    folder = report_fixture.write_run(tmp_path / "run", 36, field=False)
    (table,) = input_tables({"document": DOCUMENT})
    assert ("date", "2026-03-02", "") in table.rows
    printed = documents.write_report(with_document(read_material(folder)))[0]
    pages = printed_text.pages(printed)
    assert "2026-03-02" in printed_text.words_on(pages[0])
    assert sum("2026-03-02" in printed_text.words_on(page) for page in pages) == 2  # and inputs


def test_the_table_of_safeties_states_required_beside_actual(tmp_path: Path) -> None:
    report_fixture.write_run(tmp_path / "run", 36, field=False)
    content = documents.sheet_content(read_material(tmp_path / "run"))
    by_title = {row.title: row for row in content.safeties}
    angle = by_title["Pressure angle"]
    assert (angle.actual, angle.required, angle.safety) == (
        "44.9\N{NO-BREAK SPACE}deg",
        "≤\N{NO-BREAK SPACE}30\N{NO-BREAK SPACE}deg",
        "0.668",
    )
    assert "Contact pressure, endurance" not in by_title  # optional
    safeties = [float(row.safety) for row in content.safeties]
    assert safeties == sorted(safeties)


def test_the_table_of_safeties_is_of_the_worst_tolerance_corner(tmp_path: Path) -> None:
    records = [
        record | ({"corner": "friction high", "corner_demand": 50.0, "utilisation": 50.0 / 30.0}
                  if record["id"] == "pressure_angle" else {})
        for record in report_fixture.checks()
    ]  # fmt: skip
    report_fixture.write_run(tmp_path / "run", 36, records=records, field=False)
    content = documents.sheet_content(read_material(tmp_path / "run"))
    row = next(row for row in content.safeties if row.title == "Pressure angle")
    assert (row.actual, row.safety) == ("50\N{NO-BREAK SPACE}deg", "0.6")


def drawing(folder: Path, scale: float, *, keyed: bool) -> ReportMaterial:
    """A run of the fixture with the dimensions of a small machine's cam, changed by a factor."""
    keyway = '\n[cam.keyway]\nwidth = "6 mm"\ndepth = "2.8 mm"\nangle = "35 deg"\n\n[roller]\n'
    text = small_machine("part")
    case = parse_case(text.replace("\n[roller]\n", keyway) if keyed else text)
    theta = uniform_turn(360)
    contour = case.contour(Lift(theta, 0.005 * (1 - np.cos(theta))))
    record = dimensions_record(case, contour)
    record["material"], record["hardness"] = 20 * "steel ", 20 * "hard "
    for key in ("thickness_mm", "profile_tolerance_mm"):
        record[key] *= scale
    report_fixture.write_run(folder, 36, title=40 * "title ", field=False)
    (folder / "workshop").mkdir()
    (folder / "workshop" / "dimensions.json").write_text(json.dumps(record))
    return with_document(read_material(folder))


@pytest.mark.parametrize("scale", [0.01, 1.0, 12.0])
@pytest.mark.parametrize("keyed", [True, False])
def test_the_drawing_is_one_sheet(tmp_path: Path, scale: float, keyed: bool) -> None:
    (path,) = documents.write_drawing(drawing(tmp_path / "run", scale, keyed=keyed))
    (page,) = printed_text.pages(path)
    assert printed_text.covered(page) == []
    size = np.array([page.width, page.height]) * printed_text.POINT
    np.testing.assert_allclose(size, (420.0, 297.0), atol=0.1)
    every = printed_text.glyphs(page)
    assert min(glyph.x0 for glyph in every) * printed_text.POINT > 20.0
    assert max(glyph.x1 for glyph in every) * printed_text.POINT < 410.0
    words = printed_text.words_on(page)
    assert [text for text in ("350°", "Checked", "2026-03-02", "H7") if text not in words] == []
    assert ("JS9" in words) == keyed


@pytest.mark.parametrize(
    ("end", "words", "crowned"),
    [(None, "edges:notstated", False), (("sharp", 0.0), "bothedgessharp,burr-free", True),
     (("chamfer", 0.3), "bothedges0.3×45°", False), (("radius", 1.2), "bothedgesR1.2", True)],
)  # fmt: skip
def test_the_drawing_shows_ends_and_crown_of_the_track(
    tmp_path: Path, end: tuple[str, float] | None, words: str, crowned: bool
) -> None:
    material = drawing(tmp_path / "run", 1.0, keyed=True)
    file = tmp_path / "run" / "workshop" / "dimensions.json"
    record = json.loads(file.read_text())
    drops = {"kind": "johns_gohar", "y_mm": [-4.0, -2.0, 0.0, 2.0, 4.0],
             "drop_um": [3.2, 0.7, 0.0, 0.7, 3.2]}  # fmt: skip
    size = 0.0 if end is None else end[1]
    record["tracks"]["cam"] = {
        "flat_width_mm": 10.0 - 2.0 * size,
        "end": None if end is None else {"kind": end[0], "size_mm": size},
        "crown": drops if crowned else None,
    }
    file.write_text(json.dumps(record))
    (page,) = printed_text.pages(documents.write_drawing(material)[0])
    assert printed_text.covered(page) == []
    printed = printed_text.words_on(page)
    assert words in printed
    assert f"{10.0 - 2.0 * size:.6g}" in printed
    assert (
        ("3.200" in printed)
        == ("CrownoftheCam,Johns-Gohar".lower() in printed.lower())
        == (crowned)
    )


def test_a_long_card_is_whole_in_the_title_block(tmp_path: Path) -> None:
    material = drawing(tmp_path / "run", 1.0, keyed=True)
    file = tmp_path / "run" / "workshop" / "dimensions.json"
    record = json.loads(file.read_text())
    record["material"] = " ".join(f"word{k}" for k in range(80)) + " end-of-card"
    file.write_text(json.dumps(record))
    (page,) = printed_text.pages(documents.write_drawing(material)[0])
    assert printed_text.covered(page) == []
    printed = printed_text.words_on(page)
    assert [
        each for each in ("word0", "word79", "end-of-card", "Approved") if each not in printed
    ] == []
    heights = [each * printed_text.POINT for glyph in printed_text.glyphs(page)
               for each in (glyph.y0, glyph.y1)]  # fmt: skip
    assert 10.0 < min(heights) < max(heights) < 287.0


def test_no_drawing_of_a_contour_that_encloses_no_body(tmp_path: Path) -> None:
    report_fixture.write_run(tmp_path / "run", 36, field=False)
    assert documents.write_drawing(read_material(tmp_path / "run")) == []


@pytest.mark.parametrize("text", ["[]", "{}", '{"bore": 1}', "nothing"])
def test_dimensions_of_another_form_are_refused(tmp_path: Path, text: str) -> None:
    report_fixture.write_run(tmp_path / "run", 36, field=False)
    (tmp_path / "run" / "workshop").mkdir()
    (tmp_path / "run" / "workshop" / "dimensions.json").write_text(text)
    with pytest.raises(ResultError, match=r"dimensions\.json"):
        documents.write_drawing(read_material(tmp_path / "run"))


@pytest.mark.parametrize(
    ("room", "size", "words"),
    [(80.0, 76.4, "1:1"), (80.0, 81.0, "1:2"), (80.0, 40.0, "2:1"), (80.0, 15.0, "5:1"),
     (80.0, 8.0, "10:1"), (80.0, 800.0, "1:10"), (80.0, 9000.0, "1:200"), (80.0, 160.0, "1:2")],
)  # fmt: skip
def test_scales_are_those_of_the_standard(room: float, size: float, words: str) -> None:
    assert scale_words(standard_scale(room, size)) == words
