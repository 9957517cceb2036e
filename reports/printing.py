"""The page on paper: A4 with page numbers and embedded fonts."""

from __future__ import annotations

import html
import tempfile
from pathlib import Path

from reports import browser, page
from reports.material import Material

PDF = "8_report.pdf"


def write(material: Material) -> list[Path]:
    """Print the page, without its scripts, beside it.

    Raises
    ------
    ResultError
        If there is nothing to print with, or the file cannot be written.
    """
    pdf = material.folder / PDF
    footer = html.escape(f"Camwright · {page.shortened(str(material.run.summary['case']), 60)}")
    with tempfile.TemporaryDirectory() as folder:
        still = Path(folder) / page.PAGE
        still.write_bytes(page.text(material, live=False))
        browser.print_pdf(still, pdf, footer)
    return [pdf]
