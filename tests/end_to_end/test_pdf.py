"""The page on paper by either engine: numbered pages, no plot cut, fonts inside, room to sign."""

from __future__ import annotations

import importlib
import importlib.util
import io
import re
import sys
import unicodedata
from pathlib import Path

import pypdf
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.geometry.errors import ResultError
from camwright.reports import browser, page, pdf, sections
from camwright.reports.figure_svg import drawn_groups
from camwright.reports.report_data import Material, read_material

HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית\U0001f600 </script><!--"
A4 = (595.0, 842.0)  # points


@pytest.fixture(scope="module")
def material(tmp_path_factory: pytest.TempPathFactory) -> Material:
    folder = tmp_path_factory.mktemp("paper") / "run"
    report_fixture.write_run(folder, positions=36, title=HOSTILE, field=False)
    return read_material(folder)


def by_chromium(material: Material) -> bytes:
    if browser.executable() is None:
        pytest.skip("no Chromium here: Debian has it in the package chromium")
    return pdf.write(material)[0].read_bytes()


def by_weasyprint(material: Material) -> bytes:
    try:
        importlib.import_module("weasyprint")
    except (ImportError, OSError) as error:
        pytest.skip(f"no WeasyPrint here, or no Pango for it: {error}")
    text = page.text(material).decode()
    return pdf.by_weasyprint(text, "Camwright · gx120")


@pytest.fixture(scope="module", params=[by_chromium, by_weasyprint])
def printed(request: pytest.FixtureRequest, material: Material) -> pypdf.PdfReader:
    return pypdf.PdfReader(io.BytesIO(request.param(material)))


@pytest.fixture(scope="module")
def words(printed: pypdf.PdfReader) -> list[str]:
    """What each page says, spaces left out: engines set them apart differently."""
    return [squeezed(one.extract_text()) for one in printed.pages]


def squeezed(text: str) -> str:
    return re.sub(r"\s+", "", unicodedata.normalize("NFKC", text))  # no ligatures either


def pages_with(words: list[str], text: str) -> set[int]:
    return {number for number, said in enumerate(words) if squeezed(text) in said}


def test_every_page_is_a4_and_numbered(printed: pypdf.PdfReader, words: list[str]) -> None:
    assert len(words) >= 8
    for number, (sheet, said) in enumerate(zip(printed.pages, words, strict=True), start=1):
        size = (float(sheet.mediabox.width), float(sheet.mediabox.height))
        assert size == pytest.approx(A4, abs=2)
        assert f"page{number}of{len(words)}" in said
        assert "Camwright·gx120" in said


def test_no_plot_is_cut(material: Material, words: list[str]) -> None:
    """Its title above it and its caption below it stand on one page, and so does the plot."""
    figures = [one.figure for _, group in drawn_groups(material) for one in group]
    assert len(figures) >= 12
    for figure in figures:
        assert pages_with(words, figure.title) & pages_with(words, figure.caption), figure.id


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


def test_a_place_to_sign_comes_last(words: list[str]) -> None:
    end = words[-1]
    assert all(f"{role}NameDateSignature" in end or role in end
               for role in ("Prepared", "Checked", "Approved"))  # fmt: skip
    assert end.count("Signature") >= 3


def test_hostile_titles_are_printed_as_words(words: list[str]) -> None:
    # what follows the right-to-left mark runs the other way, as on any page
    assert "<script>window.broken=1</script>\"'&../" in words[0]
    assert "עברית" in words[0] and "\U0001f600" in words[0]


def test_without_an_engine_it_says_what_to_install(
    material: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(browser, "executable", lambda: None)
    real = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "weasyprint" else real(name)
    )
    with pytest.raises(ResultError, match=r"install Chromium.*camwright\[pdf\]"):
        sections.build(material.folder, sections.chosen(["pdf"]))


def test_without_chromium_weasyprint_prints(
    material: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(browser, "executable", lambda: None)
    monkeypatch.setattr(pdf, "by_weasyprint", lambda text, footer: f"%PDF {footer}".encode())
    assert pdf.write(material)[0].read_bytes() == "%PDF Camwright · gx120".encode()
