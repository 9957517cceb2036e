"""Page of ``camwright validate``: published and computed values of the papers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from camwright.pipeline.base.files import Json
from camwright.reports.page import study_page
from camwright.reports.report_content import Block, Section, Tabular
from camwright.reports.report_tables import DASH, Cell, Record, Status, Table, words

HEAD = (
    "row", "quantity", "kind", "published", "obtained", "difference", "unit", "verdict", "reason",
)  # fmt: skip
STATUS = {"reproduced": "pass", "not reproduced": "fail"}
INTRODUCTION = (
    "Values printed in the papers beside those that this version computes. Reproduced: equal "
    "within the tolerance stated as reason; values to which a model was tuned are marked. Not "
    "decidable: the paper does not print the inputs, or the value is not computed."
)


def page(document: Record) -> str:
    """HTML text of the page from the contents of ``validation.json``."""
    counts = ", ".join(f"{name} {number}" for name, number in document["counts"].items())
    sections = [_paper(document, key) for key in document["papers"]]
    return study_page("Reproduction of published studies", sections, f"{INTRODUCTION} {counts}.")


def _paper(document: Record, key: str) -> Section:
    paper = document["papers"][key]
    doi = f", doi {paper['doi']}" if paper.get("doi") else ""
    rows = [_row(row) for row in document["rows"] if row["paper"] == key]
    blocks = [Block(Tabular(Table(f"Figures of {key}", HEAD, rows, 3, 3)))]
    for name, study in document["studies"].get(key, {}).items():
        blocks.append(Block(Tabular(_study(name, study)), f"Study: {name}"))
    return Section(key, key, blocks, f"{paper['citation']}{doi}")


def _row(row: Record) -> list[Cell]:
    verdict = str(row["verdict"])
    return [
        row["id"], "; ".join(filter(None, (row["quantity"], row["condition"]))), row["kind"],
        *(_text(row[name]) for name in ("published", "obtained", "difference")), row["unit"],
        Status(STATUS.get(verdict, "not_evaluated"), verdict), row["reason"],
    ]  # fmt: skip


def _study(name: str, rows: Sequence[Record]) -> Table:
    first = list(rows[0].values())
    text = next((k for k, value in enumerate(first) if not isinstance(value, str)), len(first))
    cells = [[_text(value) for value in row.values()] for row in rows]
    return Table(name, [words(key) for key in rows[0]], cells, text)


def _text(value: Json) -> str:
    if value is None:
        return DASH
    if isinstance(value, (int, float)):
        return f"{value:.4g}"
    if isinstance(value, (str, Mapping)):
        return str(value)
    return ", ".join(_text(each) for each in value)
