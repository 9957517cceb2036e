"""Display of a result in an interpreter and a notebook: one line, table in HTML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from html import escape
from pathlib import PurePath

import numpy as np

_LINE, _TEXT = 400, 120
"""Most characters of a line, and of a text in it."""


class Displayed:
    """Base of results that print as one line of facts, and as an HTML table in a notebook.

    A dataclass takes this display in place of the generated one with ``repr=False``.
    """

    @property
    def facts(self) -> Mapping[str, object]:
        """Facts by name, SI; by default the fields of the dataclass."""
        if not is_dataclass(self):
            return {}
        return {each.name: getattr(self, each.name) for each in fields(self) if each.repr}

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={in_brief(value)}" for name, value in self.facts.items())
        return clipped(f"{type(self).__name__}({inside})", _LINE)

    def _repr_html_(self) -> str:
        rows = [(name, in_brief(value)) for name, value in self.facts.items()]
        return html_table(type(self).__name__, (), rows)


def in_brief(value: object) -> str:
    """Short text of a value: a number with six digits, the shape of an array, the length of a
    collection, the class of anything else.
    """
    if value is None or isinstance(value, bool | int):
        return str(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str):
        return clipped(" ".join(value.split()), _TEXT)
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    if isinstance(value, Mapping | Sequence | set | frozenset):
        return f"{len(value)} entries" if len(value) != 1 else "1 entry"
    return clipped(str(value), _TEXT) if isinstance(value, PurePath) else type(value).__name__


def clipped(text: str, most: int) -> str:
    """Text cut to a maximum length, with an ellipsis."""
    return text if len(text) <= most else f"{text[: most - 4]} ..."


def html_table(caption: str, header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Table in HTML with its caption, the names of its columns, which may be none, and its rows;
    every text is escaped.
    """
    lines = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if header:
        lines.append(_html_row("th", header))
    lines += (_html_row("td", row) for row in rows)
    return "\n".join([*lines, "</table>"])


def _html_row(kind: str, cells: Sequence[str]) -> str:
    return f"<tr>{''.join(f'<{kind}>{escape(cell)}</{kind}>' for cell in cells)}</tr>"
