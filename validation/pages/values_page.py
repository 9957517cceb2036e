"""Page of ``python -m validation values``: published and computed values of the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from camwright.pipeline.base.files import Json
from camwright.reports.figure_svg import png_of
from camwright.reports.page import study_page
from camwright.reports.picture_list import Picture
from camwright.reports.report_content import Pictures, ReportSection, SectionBlock, Tabular
from camwright.reports.report_tables import DASH, Cell, Record, ReportTable, Status, words
from validation.pages.paper_chart import Chart

HEAD = (
    "row", "quantity", "published", "obtained", "unit", "verdict", "reason", "tolerance", "basis",
)  # fmt: skip
COUNTS_HEAD = ("basis", "reproduced", "not reproduced", "not decidable", "computed value")
STATUS = {"reproduced": "pass", "not reproduced": "fail"}
BASES = {
    "independent": "from the physics and printed inputs: the only test of the physics",
    "tuned": "a model or a choice was adjusted to such values",
    "fitted": "unknowns were solved for from values of the paper",
    "imposed": "an input of the calculation",
    "arithmetic": "from other printed values",
}
INTRODUCTION = (
    "Values printed in the papers beside those that this version computes. Reproduced: within the "
    "tolerance of the row. Not decidable: the paper does not print the inputs, or the value is not "
    "computed. A reproduced value tests the physics where its basis is independent."
)


def page(document: Record) -> str:
    """HTML text of the page from the contents of ``values.json``."""
    sections = [_summary(document), *(_paper(document, key) for key in document["papers"])]
    return study_page("Reproduction of published studies", sections, INTRODUCTION)


def _summary(document: Record) -> ReportSection:
    rows = [
        [basis, *(str(numbers[name]) for name in COUNTS_HEAD[1:4]), BASES[basis]]
        for basis, numbers in document["counts"].items()
    ]
    table = ReportTable("Published values by basis and verdict", COUNTS_HEAD, rows, 1, 3)
    return ReportSection("summary", "Summary", [SectionBlock(Tabular(table))], "")


def _paper(document: Record, key: str) -> ReportSection:
    paper = document["papers"][key]
    doi = f", doi {paper['doi']}" if paper.get("doi") else ""
    rows = [row for row in document["rows"] if row["paper"] == key]
    blocks = []
    for group in dict.fromkeys(row["group"] for row in rows):
        cells = [_row(row) for row in rows if row["group"] == group]
        table = ReportTable(f"Figures of {key}: {group}", HEAD, cells, 2, 2)
        blocks.append(SectionBlock(Tabular(table), f"{key}: {group}"))
        pictures = [
            _picture(figure)
            for figure in document["figures"]
            if (figure["paper"], figure["title"]) == (key, group)
        ]
        blocks.append(SectionBlock(Pictures(pictures)))
    for name, study in document["studies"].get(key, {}).items():
        blocks.append(SectionBlock(Tabular(_study(name, study)), f"Study: {name}"))
    return ReportSection(key, key, blocks, f"{paper['citation']}{doi}")


def _picture(record: Record) -> Picture:
    """Curves behind a group of rows."""
    figure = Chart(record).figure
    return Picture(figure.title, figure.caption, figure.alt, png=png_of(figure))


def _row(row: Record) -> list[Cell]:
    verdict, tolerance = str(row["verdict"]), row["tolerance"]
    return [
        row["id"], "; ".join(filter(None, (row["quantity"], row["condition"], row["kind"]))),
        *(_text(row[name]) for name in ("published", "obtained")), row["unit"],
        Status(STATUS.get(verdict, "not_evaluated"), verdict), row["reason"],
        f"{tolerance}: {row['tolerance_reason']}", f"{row['basis']}: {row['basis_reason']}",
    ]  # fmt: skip


def _study(name: str, rows: Sequence[Record]) -> ReportTable:
    first = list(rows[0].values())
    text = next((k for k, value in enumerate(first) if not isinstance(value, str)), len(first))
    cells = [[_text(value) for value in row.values()] for row in rows]
    return ReportTable(name, [words(key) for key in rows[0]], cells, text)


def _text(value: Json) -> str:
    if value is None:
        return DASH
    if isinstance(value, (int, float)):
        return f"{value:.4g}"
    if isinstance(value, (str, Mapping)):
        return str(value)
    return ", ".join(_text(each) for each in value)
