"""Shop drawings of every kind of cam: all text within the frame, none on text, none in the title
block but its own.
"""

from __future__ import annotations

import hashlib
import json
import sys
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest
from pdfminer.layout import LTPage

sys.path.insert(0, str(Path(__file__).parents[1]))
import printed_text

from camwright.pipeline.base.tables import table
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import contour_columns
from camwright.pipeline.results.workshop_files import dimensions_record
from camwright.reports import documents
from camwright.reports.sheet_turn import SheetTurn

ROOT = Path(__file__).parents[2]
QUICK = "conjugate_arm", "groove_arm"
"""Two discs, and two walls with the swing of an arm: the fullest sheets."""
FILES = {
    each.stem: each
    for folder in ("tests/data", "cases", "cases/motions", "cases/machines")
    for each in sorted((ROOT / folder).glob("*.toml"))
    if each.stem not in ("impossible", "small_machine")  # refused, a text to be filled
}
LAST = "dimensions in mm · first angle projection, ISO 128 · SHA-256 of the results:"
SHA = hashlib.sha256().hexdigest()
"""Words of the last field of a title block, here of no results."""
SHEETS = [pytest.param(name, marks=[pytest.mark.slow] * (name not in QUICK)) for name in FILES]


@cache
def judged(name: str):
    case = read_case(FILES[name])
    return case, preview_case(case, corners=False).contour


def drawn(folder: Path, name: str, more: int = 0) -> tuple[documents.ShopDrawing, list[LTPage]]:
    """Contents and pages of the drawing of a case, with `more` notes on each sheet."""
    case, contour = judged(name)
    (folder / "workshop").mkdir()
    ends = documents.DIMENSIONS if case.cam.conjugate is not None else {"": ""}
    for end in ends:
        record = dimensions_record(case, contour, end)
        record["second_track"] = [
            *record["second_track"], *(f"note {k} {30 * 'word '}last{k}" for k in range(more)),
        ]  # fmt: skip
        file = folder / documents.DIMENSIONS[end]
        file.write_text(json.dumps(record), encoding="utf-8")
    columns = table(contour_columns(case, contour))
    turn = SimpleNamespace(contour=columns)
    turn.outer_wall = SheetTurn.outer_wall.fget(turn)
    run = SimpleNamespace(path=folder, summary={"files": {}})
    material = SimpleNamespace(run=run, case=case.tables(), turn=turn, folder=folder)
    content = documents.drawing_content(material)
    assert content is not None
    return content, printed_text.pages(documents.write_drawing(material)[0])


def assert_in_place(page: LTPage, sheet: documents.DrawingSheet) -> None:
    """Text within the frame and free of other text; lists and notes above the title block."""
    assert printed_text.covered(page) == []
    every = printed_text.glyphs(page)
    left, low, right, high = (
        pick(getattr(each, side) for each in every) * printed_text.POINT
        for pick, side in ((min, "x0"), (min, "y0"), (max, "x1"), (max, "y1"))
    )
    assert left > 20.0 and right < 410.0 and low > 10.0 and high < 287.0
    letters = "".join(each.get_text()[0] for each in every)
    title = every[letters.index("".join(("Title", *sheet.facts[0][1][:12].split())))]
    below = [each for each in every if each.x0 >= title.x0 - 1.0 and each.y0 < title.y1]
    own = (
        *(text for pair in (*sheet.facts, *sheet.block) for text in pair),
        *("Drawn", "Checked", "Approved", 3 * ": name, date, signature", "Sheet", LAST, SHA),
    )
    printed = sum(len(each.get_text().strip("\u200b")) for each in below)  # of a ligature two
    number = printed - sum(len("".join(text.split())) for text in own)
    assert number in (len("1of1"), len("1of1,continued"))  # and nothing else


@pytest.mark.parametrize("name", SHEETS)
def test_a_drawing_has_room_for_its_text(tmp_path: Path, name: str) -> None:
    content, pages = drawn(tmp_path, name)
    assert len(pages) == len(content.sheets)  # each disc on one sheet
    for page, sheet in zip(pages, content.sheets, strict=True):
        assert_in_place(page, sheet)
        printed = printed_text.words_on(page)
        words = " ".join((*sheet.notes, *(value for _, value in sheet.facts))).split()
        assert [word for word in words if word not in printed] == []


def test_notes_without_room_go_on_another_sheet(tmp_path: Path) -> None:
    content, pages = drawn(tmp_path, "groove_arm", more=60)
    assert len(content.sheets) == 1 < len(pages)
    printed = "".join(printed_text.words_on(page) for page in pages)
    assert "1of1,continued" in printed and "1of1,continued" not in printed_text.words_on(pages[0])
    ends = [printed.index(f"last{k}.") for k in range(60)]
    assert ends == sorted(ends)
    for page in pages:
        assert_in_place(page, content.sheets[0])
