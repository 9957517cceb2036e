"""The constants that docs/theory.md and docs/search.md list have the values of the program."""

from __future__ import annotations

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
ROW = re.compile(r"^\| `([\w.]+)\.(\w+)` \| ([^|]+) \| ([^|]+) \| ([^|]+) \|$", re.MULTILINE)
ROWS = [
    row
    for page in ("theory.md", "search.md")
    for table in re.findall(
        r"^\| constant \|.*?(?=^[^|]|\Z)",
        (DOCS / page).read_text(encoding="utf-8"),
        re.MULTILINE | re.DOTALL,
    )
    for row in ROW.findall(table)
]


def test_every_row_of_the_tables_is_read() -> None:
    text = "".join((DOCS / page).read_text(encoding="utf-8") for page in ("theory.md", "search.md"))
    listed = re.findall(r"^\| `(?:geometry|meshes|pipeline)\.[\w.]+` \|", text, re.MULTILINE)
    assert len(ROWS) == len(listed) >= 40
    assert len({row[:2] for row in ROWS}) == len(ROWS)


@pytest.mark.parametrize("row", ROWS, ids=[f"{row[0]}.{row[1]}" for row in ROWS])
def test_a_listed_constant_has_the_value_of_the_program(row: tuple[str, ...]) -> None:
    module, name, value, unit, why = row
    assert getattr(import_module(f"camwright.{module}"), name) == ast.literal_eval(value)
    assert unit.strip() and len(why.split()) >= 3
