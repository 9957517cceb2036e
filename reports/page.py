"""HTML page of the report, self-contained, and pages of studies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from camwright.pipeline.base.files import write_atomic
from camwright.reports import interactive
from camwright.reports.arrangement_data import arrangement_at, moving_data
from camwright.reports.drawing.drawing_svg import svg_of
from camwright.reports.figure_svg import COLOURS, drawn_groups
from camwright.reports.live_preview import live_view
from camwright.reports.report_content import SHORT, ReportSection, failed_checks, report_content
from camwright.reports.report_data import ReportMaterial
from camwright.reports.report_tables import plain, shortened
from camwright.reports.utilisation_chart import LIMIT_SHARE, utilisation_chart

PAGE = "8_report.html"
LONG = 700
LINKS = (
    ("Sign-off sheet", "8_signoff.pdf"), ("Report as PDF", "8_report.pdf"),
    ("Shop drawing", "workshop/drawing.pdf"), ("3-D view", "scene.html"), ("Motion", "motion.svg"),
    ("Stress field (VTK)", "fields/stress.vtkhdf"),
)  # fmt: skip
"""Other files of a run that the page links to where they are."""
_PAGE_COLOURS = {name: f"var(--{name})" for name in COLOURS}


def write(material: ReportMaterial) -> list[Path]:
    """Write ``8_report.html``."""
    return [write_atomic(material.folder / PAGE, text(material))]


def text(material: ReportMaterial) -> bytes:
    """HTML of the report's page, UTF-8, from its templates."""
    figures = [drawn.figure for _, group in drawn_groups(material) for drawn in group]
    report, drawing = report_content(material), arrangement_at(material.turn)
    svg = svg_of(drawing, _PAGE_COLOURS, "inherit", 'aria-hidden="true" focusable="false"')
    page: str = environment().get_template("report.html").render(
        report=report, live=interactive.bundle(figures),
        arrangement=Markup(svg), arrangement_alt=drawing.alt,  # noqa: S704 - escapes its text
        turn=Markup(interactive.script_safe_json(moving_data(material.turn))),  # noqa: S704
        chart=utilisation_chart(material.run.final.checks), limit_share=LIMIT_SHARE,
        sections=[failed_checks(material), *sorted(report.sections, key=_is_check_table)],
        links=links(material), preview=live_view(material),
    )  # fmt: skip
    return page.encode("utf-8", "replace")


def _is_check_table(section: ReportSection) -> bool:
    """Whether a section is the table of all checks, the last one of the page."""
    return section.id == "checks"


def links(material: ReportMaterial) -> list[tuple[str, str]]:
    """Pairs (words, relative address) of the files of the run that exist, to be linked."""
    places = (material.folder, material.run.path)
    return [(words, name) for words, name in LINKS if any((p / name).is_file() for p in places)]


def study_page(title: str, sections: Sequence[ReportSection], lead: str = "") -> str:
    """HTML page of a study: tables and pictures, no scripts."""
    page: str = environment().get_template("study.html").render(
        title=title, lead=lead, sections=sections
    )  # fmt: skip
    return page


def environment(*folders: Path) -> Environment:
    """Jinja environment of the templates, and of those of `folders`, with all text escaped."""
    made = Environment(
        loader=FileSystemLoader([Path(__file__).parent / "templates", *folders]), autoescape=True,
        undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    made.filters["plain"] = plain
    made.filters["cut"] = partial(shortened, length=SHORT)
    made.globals["LONG"] = LONG
    return made
