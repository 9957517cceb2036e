"""Spreadsheets of the tables: numbers as numbers, rounded, the inspection sheet on one page."""

from __future__ import annotations

import io
import math
import os
import shutil
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from camwright.pipeline.base.spreadsheets import Excerpt, rounded, spreadsheet
from camwright.pipeline.base.tables import CAM_ANGLE, LOAD_CASE, Column, table

MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"


def csv(folder: Path, count: int = 72) -> Path:
    """A table with a load case, lengths, an unknown value and negative zeros."""
    angle = np.radians(np.arange(count) * 360.0 / count)
    file = folder / "part.csv"
    measured = np.full(count, np.nan)
    file.write_text(
        table({
            LOAD_CASE: np.array(["=1+1"] * count), CAM_ANGLE: angle,
            Column("x", "mm"): 0.0421234567 * np.cos(angle) - 0.0, Column("force", "N"):
            -1234.56789 * np.ones(count), Column("measured", "mm", unknown=True): measured,
        }).to_csv()
    )  # fmt: skip
    return file


def sheets(content: bytes) -> list[ET.Element]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = sorted(n for n in archive.namelist() if n.startswith("xl/worksheets/sheet"))
        return [ET.fromstring(archive.read(name)) for name in names]


def test_numbers_are_numbers_rounded_and_unknown_ones_are_empty(tmp_path: Path) -> None:
    (sheet,) = sheets(spreadsheet(csv(tmp_path)))
    rows = sheet.findall(f".//{MAIN}row")
    assert len(rows) == 73
    cells = {cell.get("r"): cell for cell in rows[1]}
    assert cells["A2"].get("t") == "s"  # a text, no formula
    assert {name: cells[name].get("t") for name in ("B2", "C2", "D2")} == dict.fromkeys(
        ("B2", "C2", "D2")
    )
    assert [cells[name].find(f"{MAIN}v").text for name in ("C2", "D2")] == ["42.1235", "-1234.57"]
    assert "E2" not in cells
    texts = [value.text for value in sheet.iter(f"{MAIN}v")]
    assert "-0" not in texts and "-0.0" not in texts
    assert sheet.find(f".//{MAIN}f") is None


def test_an_excerpt_is_one_page_to_fill(tmp_path: Path) -> None:
    excerpt = Excerpt("every 10 deg", "cam_angle_deg", 10.0)
    first, whole = sheets(spreadsheet(csv(tmp_path), excerpt))
    assert len(first.findall(f".//{MAIN}row")) == 37 and len(whole.findall(f".//{MAIN}row")) == 73
    page = first.find(f"{MAIN}pageSetup")
    assert page.get("fitToHeight", "1") == "1" and page.get("orientation") == "landscape"
    angles = [float(c.find(f"{MAIN}v").text) for c in first.iter(f"{MAIN}c")
              if c.get("r").startswith("B") and c.get("t") is None]  # fmt: skip
    assert angles == [10.0 * k for k in range(36)]
    with zipfile.ZipFile(io.BytesIO(spreadsheet(csv(tmp_path), excerpt))) as archive:
        book = archive.read("xl/workbook.xml").decode()
    assert book.count("_xlnm.Print_Area") == 2 and book.count("_xlnm.Print_Titles") == 2


def test_the_same_table_gives_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = spreadsheet(csv(tmp_path))
    monkeypatch.setenv("TZ", "Asia/Tokyo")
    assert spreadsheet(csv(tmp_path)) == first
    with zipfile.ZipFile(io.BytesIO(first)) as archive:
        assert {entry.date_time[0] for entry in archive.infolist()} == {1980}
        assert b"1980-01-01" in archive.read("docProps/core.xml")


def test_rounding_has_no_negative_zero() -> None:
    values = np.array([-1e-9, -0.0, 0.0, 123456.789, -1.23456789e-7, math.nan])
    fixed, digits = rounded(values, 4), rounded(values, None)
    assert not np.signbit(fixed[:3]).any()
    assert not np.signbit(digits[1:3]).any()
    np.testing.assert_allclose(digits[3:5], [123457.0, -1.23457e-7], rtol=1e-12)
    assert math.isnan(digits[5]) and math.isnan(fixed[5])


def test_tables_have_no_negative_zero() -> None:
    text = table({Column("x", "mm"): np.array([-0.0, 0.0, -1e-300])}).to_csv()
    assert text.splitlines()[1:3] == ["0.0", "0.0"]


PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Setup/L10N"><prop oor:name="ooSetupSystemLocale" oor:op="fuse">
<value>{locale}</value></prop></item></oor:items>
"""


@pytest.mark.slow
@pytest.mark.parametrize("locale", ["pt-PT", "de-DE"])
def test_an_office_program_reads_numbers_in_any_language(tmp_path: Path, locale: str) -> None:
    """LibreOffice writes numbers with the comma of the language, and texts as they are."""
    office = shutil.which("soffice") or shutil.which("libreoffice")
    if office is None:
        pytest.skip("LibreOffice is not installed")
    file = tmp_path / "part.xlsx"
    file.write_bytes(spreadsheet(csv(tmp_path)))
    profile = tmp_path / "profile"
    (profile / "user").mkdir(parents=True)
    (profile / "user" / "registrymodifications.xcu").write_text(PROFILE.format(locale=locale))
    subprocess.run(
        [office, f"-env:UserInstallation={profile.as_uri()}", "--headless", "--convert-to",
         "csv:Text - txt - csv (StarCalc):59,34,76,1", "--outdir", str(tmp_path / "out"),
         str(file)],
        check=True, timeout=180, capture_output=True, env={**os.environ, "HOME": str(tmp_path)},
    )  # fmt: skip
    lines = next((tmp_path / "out").glob("*.csv")).read_text().splitlines()
    assert lines[0].split(";")[1:3] == ['"cam_angle_deg"', '"x_mm"']  # texts are quoted
    assert lines[1].split(";")[:4] == ['"=1+1"', "0,000", "42,1235", "-1234,57"]
