"""The page of ``camwright validate``: every published figure beside the one obtained."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

_STYLE = """
:root { color-scheme: light dark; --ink: #1b1f24; --muted: #59616b; --line: #d7dce2;
  --good: #00694c; --bad: #b3261e; --open: #7a5b00; --paper: #ffffff; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ed; --muted: #9aa3ad; --line: #3a4149;
  --good: #5fd0a8; --bad: #ff8a80; --open: #e6c35c; --paper: #15181c; } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 75rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; width: 100%; margin: 1rem 0 2rem; font-size: 13.5px; }
th, td { text-align: left; vertical-align: top; padding: .3rem .6rem;
  border-bottom: 1px solid var(--line); }
th { color: var(--muted); font-weight: 600; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.reproduced { color: var(--good); } .not-reproduced { color: var(--bad); }
.not-decidable { color: var(--open); } .note { color: var(--muted); }
.wide { overflow-x: auto; }
"""
_HEADINGS = ("row", "quantity", "kind", "published", "obtained", "difference", "unit", "verdict")
_INTRODUCTION = (
    "Each figure the papers print stands beside what this version computes. A row is reproduced "
    "where both agree within the tolerance its reason names; a figure a model was tuned to says "
    "so. Not decidable are rows whose inputs the paper does not print, and rows not computed."
)


def page(document: Mapping[str, Any]) -> str:
    """The page as HTML text, from the contents of ``validation.json``."""
    return "\n".join(_lines(document)) + "\n"


def _lines(document: Mapping[str, Any]) -> Iterator[str]:
    counts = ", ".join(f"{escape(name)} {number}" for name, number in document["counts"].items())
    yield '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
    yield '<meta name="viewport" content="width=device-width, initial-scale=1">'
    yield f"<title>Camwright validation</title><style>{_STYLE}</style></head><body>"
    yield f"<h1>The published studies, run again</h1><p>{_INTRODUCTION}</p><p>{counts}</p>"
    for key, paper in document["papers"].items():
        doi = f", doi {escape(paper['doi'])}" if paper.get("doi") else ""
        yield f"<h2>{escape(key)}</h2><p>{escape(paper['citation'])}{doi}</p>"
        yield from _rows([row for row in document["rows"] if row["paper"] == key])
        for name, rows in document["studies"].get(key, {}).items():
            yield from _study(name, rows)
    yield "</body></html>"


def _rows(rows: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    yield '<div class="wide"><table><thead><tr>'
    yield "".join(f'<th scope="col">{name}</th>' for name in _HEADINGS) + "</tr></thead><tbody>"
    for row in rows:
        verdict = str(row["verdict"])
        condition = f'<br><span class="note">{escape(str(row["condition"]))}</span>'
        yield (
            f"<tr><td>{escape(row['id'])}</td>"
            f"<td>{escape(row['quantity'])}{condition if row['condition'] else ''}</td>"
            f"<td>{escape(row['kind'])}</td>"
            + "".join(_cell(row[name]) for name in ("published", "obtained", "difference"))
            + f"<td>{escape(row['unit'])}</td>"
            f'<td><span class="{verdict.replace(" ", "-")}">{escape(verdict)}</span>'
            f'<br><span class="note">{escape(row["reason"])}</span></td></tr>'
        )
    yield "</tbody></table></div>"


def _study(name: str, rows: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    yield f'<h3>Study: {escape(name)}</h3><div class="wide"><table><thead><tr>'
    yield "".join(f'<th scope="col">{escape(key.replace("_", " "))}</th>' for key in rows[0])
    yield "</tr></thead><tbody>"
    for row in rows:
        yield "<tr>" + "".join(_cell(value) for value in row.values()) + "</tr>"
    yield "</tbody></table></div>"


def _cell(value: Any) -> str:
    kind = "" if isinstance(value, str) else ' class="n"'
    return f"<td{kind}>{escape(_text(value))}</td>"


def _text(value: Any) -> str:
    if value is None:
        return "\N{EN DASH}"
    if isinstance(value, (list, tuple)):
        return ", ".join(_text(each) for each in value)
    return f"{value:.4g}" if isinstance(value, (int, float)) else str(value)
