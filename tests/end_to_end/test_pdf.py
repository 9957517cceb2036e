"""The report as PDF: numbered A4 pages, no plot cut, fonts inside, input text as text alone."""

from __future__ import annotations

import io
import re
import sys
import unicodedata
from itertools import takewhile
from pathlib import Path

import pypdf
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import printed_text
import report_fixture

from camwright.pipeline.results.model_limits import MODEL_LIMITS
from camwright.reports import documents, figure_svg, pdf, report_content
from camwright.reports.figure_svg import drawn_groups
from camwright.reports.report_data import ReportMaterial, read_material

HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית\U0001f600 </script><!--"
TYPST = (
    '#read("/etc/passwd")', "#panic()", '#import "@preview/a:0.1.0": *', "$ x^2 $", "]#[", "`raw`",
    "\\u{41}", "<label> @label", "*bold* _thin_", "// gone", "/* gone */", "#{1/0}", "\\", "~--",
)  # fmt: skip
A4 = (595.0, 842.0)  # points


@pytest.fixture(scope="module")
def material(tmp_path_factory: pytest.TempPathFactory) -> ReportMaterial:
    folder = tmp_path_factory.mktemp("paper") / "run"
    report_fixture.write_run(folder, positions=36, title=HOSTILE, field=False)
    return read_material(folder)


def test_a_long_key_breaks_behind_its_marks_and_a_long_word_anywhere():
    key = "roller.bearing.fatigue_bending_strength"
    parts = pdf._broken(key).split("\u200b")
    assert parts == ["roller.", "bearing.", "fatigue_", "bending_", "strength"]
    assert pdf._broken("follower.mass") == "follower.mass"
    assert pdf._broken(40 * "m") == "\u200b".join(40 * "m")
    assert pdf._broken(64 * "a") == 64 * "a"  # SHA-256


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Plots left blank, for tests of words."""
    blank = '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>'
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: blank)


@pytest.fixture(scope="module")
def printed(material: ReportMaterial) -> pypdf.PdfReader:
    return pypdf.PdfReader(io.BytesIO(documents.write_report(material)[0].read_bytes()))


@pytest.fixture(scope="module")
def words(printed: pypdf.PdfReader) -> list[str]:
    """What each page says, spaces left out."""
    return [squeezed(one.extract_text()) for one in printed.pages]


def squeezed(text: str) -> str:
    """Without spaces, places to break a word, marks of direction and ligatures."""
    return re.sub(r"[\s\u200b\u2066-\u2069]+", "", unicodedata.normalize("NFKC", text))


def pages_with(words: list[str], text: str) -> set[int]:
    return {number for number, said in enumerate(words) if squeezed(text) in said}


def test_every_page_is_a4_and_numbered(printed: pypdf.PdfReader, words: list[str]) -> None:
    assert len(words) >= 8
    for number, (sheet, said) in enumerate(zip(printed.pages, words, strict=True), start=1):
        size = (float(sheet.mediabox.width), float(sheet.mediabox.height))
        assert size == pytest.approx(A4, abs=2)
        assert f"page{number}of{len(words)}" in said
        assert "Camwright·gx120" in said


def test_no_plot_is_cut(material: ReportMaterial, words: list[str]) -> None:
    """Its title above it and its caption below it stand on one page, and so does the plot."""
    figures = [one.figure for _, group in drawn_groups(material) for one in group]
    assert len(figures) >= 12
    for figure in figures:
        assert pages_with(words, figure.title) & pages_with(words, figure.caption), figure.id


def test_plots_are_drawn_as_lines_with_text(words: list[str]) -> None:
    """The names along their axes can be searched for, so they are no rasters."""
    assert sum(said.count("crankangle,deg") for said in words) >= 12


def test_pdf_says_what_the_page_says(material: ReportMaterial, words: list[str]) -> None:
    """Across the ends of pages, too, where head and foot of the page interrupt a paragraph."""
    alike = takewhile(lambda marks: len(set(marks)) == 1, zip(*words[1:], strict=False))
    head = "".join(marks[0] for marks in alike)
    said = "".join(re.sub(r"Camwright·gx120page\d+of\d+$", "", one) for one in words)
    said = said.replace(head, "")
    content = report_content.report_content(material)
    assert squeezed(content.verdict.sentence) in words[1]
    assert squeezed(content.tiles[0].value) in words[1]
    start, titles = 0, [section.title for section in content.sections]
    for title in (*titles, *titles):  # the contents, then the sections in the same order
        start = said.index(squeezed(title), start) + 1
    for section in content.sections:
        assert squeezed(section.lead) in said
        for block in section.blocks:
            assert squeezed(block.title) in said
    for row in report_fixture.checks():
        assert squeezed(row["title"]) in said
    for limit in MODEL_LIMITS:
        assert squeezed(limit.statement) in said


def test_every_font_is_in_the_file(printed: pypdf.PdfReader) -> None:
    fonts = {}
    for sheet in printed.pages:
        for font in (sheet["/Resources"].get("/Font") or {}).values():
            known = font.get_object()
            inner = known.get("/DescendantFonts")
            fonts[known.get("/BaseFont")] = inner[0].get_object() if inner else known
    assert fonts
    for name, font in fonts.items():
        if font["/Subtype"] == "/Type3":
            continue  # drawn glyph by glyph in the file itself
        described = font["/FontDescriptor"].get_object()
        assert {"/FontFile", "/FontFile2", "/FontFile3"} & set(described), name


def test_it_is_an_archive_file_with_tags_and_nothing_that_runs(
    material: ReportMaterial, printed: pypdf.PdfReader
) -> None:
    raw = (material.folder / documents.PDF).read_bytes()
    assert b"<pdfaid:part>2</pdfaid:part>" in raw and b"<pdfuaid:part>1</pdfuaid:part>" in raw
    assert printed.trailer["/Root"]["/MarkInfo"]["/Marked"]
    assert not any(name in raw for name in (b"/JavaScript", b"/Launch", b"/EmbeddedFile", b"/URI"))
    pictured = [node for node in tags(printed) if node.get("/S") == "/Figure"]
    assert len(pictured) >= 12 and all(str(node["/Alt"]).strip() for node in pictured)


def tags(printed: pypdf.PdfReader) -> list[pypdf.generic.DictionaryObject]:
    """Nodes of the structure tree."""
    nodes, waiting = [], [printed.trailer["/Root"]["/StructTreeRoot"]]
    while waiting:
        node = waiting.pop().get_object()
        if isinstance(node, list):
            waiting += node
        elif isinstance(node, dict):
            nodes.append(node)
            waiting += [node["/K"]] if "/K" in node else []
    return nodes


def test_the_first_page_is_the_sheet_to_sign(material: ReportMaterial, words: list[str]) -> None:
    sheet = pypdf.PdfReader(io.BytesIO(documents.write_signoff(material)[0].read_bytes()))
    alone = squeezed(sheet.pages[0].extract_text()).replace("page1of1", "")
    assert alone == words[0].replace(f"page1of{len(words)}", "")
    assert words[0].count("Signature") == 3
    assert sum(said.count("Signature") for said in words[1:]) == 0  # signed in one place


def test_no_text_lies_on_text_and_no_page_is_half_empty(material: ReportMaterial) -> None:
    pages = printed_text.pages(documents.write_report(material)[0])
    assert len(pages) <= 20
    assert [printed_text.covered(page) for page in pages] == [[]] * len(pages)
    for page in pages[:-1]:
        body = [glyph.y0 for glyph in printed_text.glyphs(page) if glyph.y0 > 0.07 * page.height]
        assert min(body) < 0.5 * page.height


def test_hostile_titles_are_printed_as_words(words: list[str]) -> None:
    # what follows the right-to-left mark runs the other way, as on any page
    assert "<script>window.broken=1</script>\"'&../" in words[0]
    assert "עברית" in words[0] and "\U0001f600" in words[0]  # pypdf turns a whole word round


@pytest.mark.usefixtures("undrawn")
def test_typst_source_in_an_input_is_printed_and_never_run(tmp_path: Path) -> None:
    records = report_fixture.checks()
    for record, text in zip(records, TYPST, strict=False):
        record.update(title=text, note=text, source=text, method=text)
    text = " ".join(TYPST)
    folder = report_fixture.write_run(
        tmp_path / "run", 36, title=text, notes=text, load_case=text, records=records, field=False
    )
    said = squeezed("".join(page.extract_text() for page in read(folder).pages))
    assert said.count(squeezed(text)) >= 3  # title, load case, notes
    for line in TYPST[: len(records)]:
        assert said.count(squeezed(line)) >= 4, line
    passwords = Path("/etc/passwd")
    if passwords.is_file():
        assert squeezed(passwords.read_text().splitlines()[0]) not in said


@pytest.mark.usefixtures("undrawn")
def test_huge_and_unprintable_text_stays_on_the_pages(tmp_path: Path) -> None:
    text = "a\x00b\x1bc\ufffe " + 5000 * "x" + " 中 \U0010ffff"
    records = report_fixture.checks()[:2]
    for record in records:
        record.update(title=text, note=text)
    folder = report_fixture.write_run(
        tmp_path / "run", 36, title=text, notes=text, records=records, field=False
    )
    pages = [page.extract_text() for page in read(folder).pages]
    assert squeezed("".join(pages)).count(20 * "x") >= 4 * 5000 // 20 - 20
    longest = max(line.count("x") for page in pages for line in page.splitlines())
    assert longest < 150  # of the least type a line holds less


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("character", ["\ue000", "\U0010ffff", "中", "\u0378"])
def test_characters_the_font_lacks_stop_nothing(tmp_path: Path, character: str) -> None:
    """Private use, no character at all, another script, unassigned: text about them stays."""
    title = f"one {character} two"
    folder = report_fixture.write_run(tmp_path / "run", 36, title=title, field=False)
    said = squeezed(read(folder).pages[0].extract_text())
    assert f"one{character}two" in said or "one\ufffdtwo" in said


def read(folder: Path) -> pypdf.PdfReader:
    return pypdf.PdfReader(
        io.BytesIO(documents.write_report(read_material(folder))[0].read_bytes())
    )


def test_the_same_run_gives_the_same_bytes(
    material: ReportMaterial, printed: pypdf.PdfReader
) -> None:
    first = (material.folder / documents.PDF).read_bytes()
    drawn_groups.cache_clear()
    assert documents.write_report(read_material(material.folder))[0].read_bytes() == first


def test_the_second_page_states_scope_missing_data_and_values_to_be_confirmed(
    tmp_path: Path, undrawn: None
) -> None:
    """With text in the language of the typesetter, which is shown and never evaluated."""
    source = " ".join(TYPST)
    records = [r for r in report_fixture.checks() if r["status"] in ("pass", "waived")]
    records[0]["to_be_confirmed"] = [f"value {source}"]
    bare = {"id": "shaft", "title": "Shaft", "note": f"state {source}", "status": "not_evaluated"}
    records.append(records[1] | bare | {"demand": None, "limit": None, "utilisation": None})
    folder = report_fixture.write_run(
        tmp_path / "run", positions=36, records=records, field=False,
        scope={"not_covered": ["key"], "reason": f"rig {source}"},
    )  # fmt: skip
    said = squeezed(read(folder).pages[1].extract_text())
    expected = (
        "INCOMPLETE", "INCOMPLETE: 1 check without data, 1 waived, 1 value to be confirmed",
        f"Not covered by this sign-off: key: rig {source}",
        "Missing data:", f"Shaft: state {source}", "Waived:",
        "Values to be confirmed:", f"value {source}",
    )  # fmt: skip
    places = [said.index(squeezed(text)) for text in expected]
    assert places == sorted(places)
