"""The notebook of the documentation, executed in a kernel of its own."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOK = Path(__file__).parents[2] / "docs" / "notebook.ipynb"
MOST = 50_000
"""Bytes of an output that is no picture."""


@pytest.fixture(scope="module")
def executed(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """Cells of code with their outputs."""
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    assert not any(cell.outputs for cell in notebook.cells if cell.cell_type == "code")
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    folder = tmp_path_factory.mktemp("notebook")
    client = NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(folder)}})
    client.execute(env={**os.environ, "PATH": path, "IPYTHONDIR": str(folder / "ipython")})
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def shown(cell: Any) -> dict[str, list[str]]:
    """Texts of the outputs of a cell by their kind."""
    kinds: dict[str, list[str]] = {}
    for output in cell.outputs:
        assert output.output_type != "error"
        for kind, text in output.get("data", {"text/plain": output.get("text", "")}).items():
            kinds.setdefault(kind, []).append(text)
    return kinds


def test_no_output_is_large_but_pictures(executed: list[Any]) -> None:
    for cell in executed:
        for kind, texts in shown(cell).items():
            if not kind.startswith("image/"):
                assert sum(len(text.encode()) for text in texts) <= MOST, cell.source


def test_it_reads_solves_runs_and_draws(executed: list[Any]) -> None:
    named = {cell.source.splitlines()[-1]: shown(cell) for cell in executed}
    for name in ("case", "synthesis", "trial", "run"):
        (table,) = named[name]["text/html"]
        assert table.startswith("<table>")
    drawn = {name: len(kinds.get("image/png", ())) for name, kinds in named.items()}
    assert {name for name, count in drawn.items() if count == 1} == {
        "synthesis", "trial", "cycle.keys()[:8]", "run"
    }  # fmt: skip
    assert max(drawn.values()) == 1  # none twice
    (last,) = shown(executed[-1])["text/html"]
    for text in ("running", "standstill", "over-speed", "normal_force_N"):
        assert text in last


def test_every_public_result_is_small_in_a_notebook(executed: list[Any]) -> None:
    """As text: what a terminal prints of the same objects."""
    for cell in executed:
        for text in shown(cell).get("text/plain", []):
            assert len(text) <= 2_000, cell.source
