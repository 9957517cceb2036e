"""Page of ``python -m validation figures``: figures of the papers beside their published values."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from camwright.reports.page import environment
from camwright.reports.report_tables import DASH, Cell, Record, ReportTable, number, words
from validation.pages.paper_chart import Chart

TEMPLATES = Path(__file__).parent / "templates"
UNITS = {unit: unit for unit in ("mm", "deg", "MPa", "N", "J")} | {"Nm": "N m"}
NO_BREAK = "\N{NON-BREAKING HYPHEN}"
HEAD = ("quantity", "unit", "published", "computed", "difference", "basis")
INTRODUCTION = (
    "Each figure is drawn from data computed by this version, with the values that the paper "
    "prints beside them; diamonds are printed values. Rows such as C25-03 are those of python -m "
    "validation values, which judges them. Basis: what the computed value rests on; tuned, fitted "
    "and imposed values prove nothing by their agreement."
)


@dataclass(frozen=True, eq=False)
class PaperEntry:
    """A figure with its values beside the published ones, and a table of further ones."""

    chart: Chart
    tables: tuple[ReportTable, ...]


@dataclass(frozen=True, eq=False)
class Paper:
    """Figures of one paper."""

    key: str
    citation: str
    entries: tuple[PaperEntry, ...]


def page(document: Record) -> str:
    """HTML text of the page from the contents of ``figures.json``."""
    papers = []
    for key, paper in document["papers"].items():
        doi = f", doi {paper['doi']}" if paper.get("doi") else ""
        entries = tuple(_entry(one) for one in document["figures"] if one["paper"] == key)
        if entries:
            papers.append(Paper(key, f"{paper['citation']}{doi}", entries))
    text: str = environment(TEMPLATES).get_template("figures.html").render(
        title="Figures of the papers", lead=INTRODUCTION, papers=papers
    )  # fmt: skip
    return text


def _entry(record: Record) -> PaperEntry:
    rows = [_row(value) for value in record["values"]]
    tables = (
        [ReportTable(f"Values of {record['name']}", HEAD, rows, 2, 3, wide=True)] if rows else []
    )
    if record["table"]:
        tables.append(_columns(f"Table of {record['name']}", record["table"]))
    return PaperEntry(Chart(record), tuple(tables))


def _columns(label: str, rows: Sequence[Record]) -> ReportTable:
    """Rows of a table as columns, the first value of each as its heading."""
    first, *names = rows[0]
    cells: list[list[Cell]] = [
        [_quantity(name), *(DASH if row[name] is None else _text(row[name]) for row in rows)]
        for name in names
    ]
    return ReportTable(label, [first, *(str(row[first]) for row in rows)], cells, wide=True)


def _quantity(name: str) -> str:
    """Words of a name whose last part is a unit."""
    quantity, _, unit = name.rpartition("_")
    return f"{words(quantity)}, {UNITS[unit]}" if unit in UNITS else words(name)


def _row(value: Record) -> list[Cell]:
    difference, share = value["difference"], value["difference_percent"]
    text = DASH if difference is None else _signed(difference, 1e-4 * abs(value["published"]))
    if share is not None:
        text = f"{text} ({_signed(share, 0.05)}\N{NO-BREAK SPACE}%)"
    row = f" ({value['row']})".replace("-", NO_BREAK) if value["row"] else ""
    return [
        f"{value['quantity']}{row}", _unit(value["unit"]), _text(value["published"]),
        _text(value["computed"]), text, value["basis"],
    ]  # fmt: skip


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else number(float(value))


def _unit(unit: str) -> str:
    return DASH if unit in ("", "-") else re.sub(r"(?<=[a-z])2\b", "²", unit)


def _signed(value: float, negligible: float) -> str:
    """A difference with its sign and two digits; 0 where it is negligible."""
    shown = 0.0 if abs(value) < negligible else float(value)
    return f"{'+' if shown > 0 else ''}{number(shown, 2)}"
