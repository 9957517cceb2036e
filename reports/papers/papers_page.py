"""Page of ``camwright papers``: figures of the papers beside their published values."""

from __future__ import annotations

import re
from dataclasses import dataclass

from camwright.reports.page import environment
from camwright.reports.papers.paper_chart import Chart
from camwright.reports.report_tables import DASH, Cell, Record, Table, number

NO_BREAK = "\N{NON-BREAKING HYPHEN}"
HEAD = ("quantity", "unit", "published", "computed", "difference", "basis")
INTRODUCTION = (
    "Each figure is drawn from data computed by this version, with the values that the paper "
    "prints beside them; diamonds are printed values. Rows such as C25-03 are those of camwright "
    "validate, which judges them. Basis: what the computed value rests on; tuned, fitted and "
    "imposed values prove nothing by their agreement."
)


@dataclass(frozen=True, eq=False)
class Entry:
    """A figure with the table of its values."""

    chart: Chart
    table: Table | None


@dataclass(frozen=True, eq=False)
class Paper:
    """Figures of one paper."""

    key: str
    citation: str
    entries: tuple[Entry, ...]


def page(document: Record) -> str:
    """HTML text of the page from the contents of ``papers.json``."""
    papers = []
    for key, paper in document["papers"].items():
        doi = f", doi {paper['doi']}" if paper.get("doi") else ""
        entries = tuple(_entry(one) for one in document["figures"] if one["paper"] == key)
        if entries:
            papers.append(Paper(key, f"{paper['citation']}{doi}", entries))
    text: str = environment().get_template("papers.html").render(
        title="Figures of the papers", lead=INTRODUCTION, papers=papers
    )  # fmt: skip
    return text


def _entry(record: Record) -> Entry:
    rows = [_row(value) for value in record["values"]]
    table = Table(f"Values of {record['name']}", HEAD, rows, 2, 3, wide=True) if rows else None
    return Entry(Chart(record), table)


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
