"""The page on paper: A4 with page numbers and embedded fonts, by Chromium or by WeasyPrint."""

from __future__ import annotations

import html
import importlib.util
import re
import tempfile
from pathlib import Path

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.reports import browser, page
from camwright.reports.figure_svg import COLOURS
from camwright.reports.report_data import Material
from camwright.reports.report_tables import shortened

PDF = "8_report.pdf"
_NUMBERED = """@page {
  @bottom-left { content: %s; font: 6pt sans-serif; }
  @bottom-right { content: "page " counter(page) " of " counter(pages); font: 6pt sans-serif; }
}"""


def write(material: Material) -> list[Path]:
    """Print the page, without its scripts, beside it.

    Raises
    ------
    ResultError
        If there is nothing to print with, or the file cannot be written.
    """
    pdf = material.folder / PDF
    footer = f"Camwright · {shortened(str(material.run.summary['case']), 60)}"
    text = page.text(material)
    if browser.executable() is not None:
        _by_chromium(text, pdf, footer)
    elif importlib.util.find_spec("weasyprint") is not None:
        write_atomic(pdf, by_weasyprint(text.decode(), footer))
    else:
        raise ResultError(
            "nothing to print with: install Chromium (Debian: chromium), name one in "
            "CAMWRIGHT_CHROMIUM, or install WeasyPrint (pip install 'camwright[pdf]')"
        )
    return [pdf]


def _by_chromium(text: bytes, pdf: Path, footer: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        still = Path(folder) / page.PAGE
        still.write_bytes(text)
        browser.print_pdf(still, pdf, html.escape(footer))


def by_weasyprint(text: str, footer: str) -> bytes:
    """A page as PDF; colours become those of the light theme, which its drawings know no other.

    Raises
    ------
    ResultError
        If a library that WeasyPrint stands on is missing.
    """
    try:
        import weasyprint
    except OSError as error:  # Pango, of which pip knows nothing
        raise ResultError(f"WeasyPrint does not start: {' '.join(str(error).split())}") from None
    coloured = re.sub(r"var\(--([a-z]+)\)", lambda name: COLOURS.get(name[1], name[0]), text)
    quoted = '"' + footer.replace("\\", "\\\\").replace('"', '\\"') + '"'
    numbered = weasyprint.CSS(string=_NUMBERED % quoted)
    printed: bytes = weasyprint.HTML(string=coloured).write_pdf(stylesheets=[numbered])
    return printed
