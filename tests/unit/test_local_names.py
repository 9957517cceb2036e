"""Locals and constants are named by what they hold: names that say nothing become fewer."""

from __future__ import annotations

import ast
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("geometry", "meshes", "pipeline", "reports", "validation")
VAGUE = frozenset({"known", "place", "whole", "made", "own", "kept"})
MOST = {
    "geometry": 20,
    "meshes": 9,
    "pipeline": 13,
    "pipeline/base": 26,
    "pipeline/case": 39,
    "pipeline/case/cards": 23,
    "pipeline/checks": 8,
    "pipeline/commands": 13,
    "pipeline/contact": 15,
    "pipeline/contact/elasticity": 11,
    "pipeline/contact/finite_length": 19,
    "pipeline/cycle": 1,
    "pipeline/engine": 28,
    "pipeline/follower": 8,
    "pipeline/hand_check": 5,
    "pipeline/records": 4,
    "pipeline/results": 42,
    "pipeline/screening": 29,
    "pipeline/search": 12,
    "pipeline/search/crown": 8,
    "pipeline/search/machine": 19,
    "pipeline/search/parts": 7,
    "pipeline/search/remedies": 8,
    "pipeline/search/sizes": 3,
    "pipeline/smoothing": 2,
    "pipeline/studies": 4,
    "pipeline/studies/batch": 32,
    "pipeline/torque": 15,
    "reports": 37,
    "reports/comparisons": 1,
    "reports/drawing": 13,
    "reports/study": 8,
    "validation": 6,
    "validation/pages": 2,
}
"""Assignments to the names of `VAGUE` by folder; a folder without an entry has none."""


@cache
def tree(text: str) -> ast.Module:
    """Syntax tree of a module, parsed once for both counts."""
    return ast.parse(text)


def assignments(text: str) -> list[int]:
    """Lines in which a name of `VAGUE` is assigned, by a statement, a loop or a field."""
    return [
        node.lineno
        for node in ast.walk(tree(text))
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in VAGUE
    ]


@pytest.mark.parametrize("text", ["known = 1", "for place in x: pass", "a, own = b", "made: int"])
def test_an_assignment_to_a_vague_name_is_seen(text: str) -> None:
    assert assignments(text) == [1]


def test_vague_names_of_locals_become_fewer() -> None:
    counts: Counter[str] = Counter()
    for path in (each for name in FOLDERS for each in sorted((ROOT / name).rglob("*.py"))):
        folder = path.parent.relative_to(ROOT).as_posix()
        counts[folder] += len(assignments(path.read_text(encoding="utf-8")))
    grown = {name: count for name, count in counts.items() if count > MOST.get(name, 0)}
    assert grown == {}, "name the local by its contents; where a folder has moved, move its entry"


SHARED = 20
"""Private names of numeric constants that stand for several values, each in another module."""


def numbers(text: str) -> dict[str, str]:
    """Values, as source, of the private numeric constants of a module by name."""
    values: dict[str, str] = {}
    for node in tree(text).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name | ast.Tuple):
            target = node.targets[0]
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            parts = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value]
            for name, value in zip(names, parts, strict=False):
                is_number = isinstance(value, ast.Constant) and isinstance(value.value, int | float)
                if isinstance(name, ast.Name) and name.id.startswith("_") and is_number:
                    values[name.id] = ast.unparse(value)
    return values


def test_a_private_number_is_read() -> None:
    assert numbers("_A, _B = 1.0, 2\n_C = 'x'\n_D = 3e-9  # m\nE = 1") == {
        "_A": "1.0", "_B": "2", "_D": "3e-09",
    }  # fmt: skip


def test_names_of_several_private_numbers_become_fewer() -> None:
    """A name such as `_MARGIN` or `_ROUND_OFF` does not say of which quantity."""
    values: dict[str, set[str]] = {}
    for path in (each for name in FOLDERS for each in sorted((ROOT / name).rglob("*.py"))):
        for name, value in numbers(path.read_text(encoding="utf-8")).items():
            values.setdefault(name, set()).add(value)
    assert sum(len(each) > 1 for each in values.values()) <= SHARED
