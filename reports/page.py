"""The report as one self-contained HTML page, and the pages of studies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from camwright.pipeline.base.files import write_atomic
from camwright.reports import interactive
from camwright.reports.figure_svg import drawn_groups
from camwright.reports.report_content import SHORT, Section, report_content
from camwright.reports.report_data import Material
from camwright.reports.report_tables import plain, shortened

PAGE = "8_report.html"
LONG = 700


def write(material: Material) -> list[Path]:
    """Write ``8_report.html``."""
    return [write_atomic(material.folder / PAGE, text(material))]


def text(material: Material) -> bytes:
    """The page in UTF-8."""
    figures = [drawn.figure for _, group in drawn_groups(material) for drawn in group]
    page: str = environment().get_template("report.html").render(
        report=report_content(material), live=interactive.bundle(figures)
    )  # fmt: skip
    return page.encode("utf-8", "replace")


def study_page(title: str, sections: Sequence[Section], lead: str = "") -> str:
    """Page of a study: tables and pictures, no scripts."""
    page: str = environment().get_template("study.html").render(
        title=title, lead=lead, sections=sections
    )  # fmt: skip
    return page


def environment() -> Environment:
    """The templates, with escaping of all text."""
    made = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates"), autoescape=True,
        undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    made.filters["plain"] = plain
    made.filters["cut"] = partial(shortened, length=SHORT)
    made.globals["LONG"] = LONG
    return made
