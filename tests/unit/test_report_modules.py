"""The table in the docstring of `reports`: every module, each below those that it imports."""

from __future__ import annotations

import ast
from pathlib import Path

from camwright import reports

FOLDER = Path(reports.__file__).parent
PACKAGES = {path.parent.name for path in FOLDER.glob("*/__init__.py")}


def listed() -> list[str]:
    rows = (reports.__doc__ or "").split("======\n")[1].splitlines()
    return [row.split()[0] for row in rows if row and not row.startswith("=")]


def imported(module: str) -> set[str]:
    """Modules of `reports` that a module imports."""
    tree = ast.parse((FOLDER / f"{module}.py").read_text(encoding="utf-8"))
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "camwright.reports":
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            above, _, name = node.module.rpartition(".")
            names |= {name} if above == "camwright.reports" else set()
    return names - PACKAGES


def test_the_table_lists_every_module_once():
    assert sorted(listed()) == sorted(
        path.stem for path in FOLDER.glob("*.py") if path.stem != "__init__"
    )


def test_a_module_imports_only_those_above_it():
    names = listed()
    for place, name in enumerate(names):
        assert imported(name) <= set(names[:place]), name
