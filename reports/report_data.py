"""What a report is made from: a finished run, read once and shared by all its parts."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from camwright.geometry.errors import ResultError
from camwright.pipeline.results.run_reader import Run, load_run
from camwright.reports.sheet_turn import Turn
from camwright.reports.verdict_text import governing_load_case

FIGURES = "figures"
"""Folder of the pictures, in a run folder."""


@dataclass(frozen=True, eq=False)
class Material:
    """A run folder, what was read from it, and the turn that its sheet draws.

    Each is itself alone, so that what parts have in common can be kept by it.
    """

    folder: Path
    run: Run
    case: Mapping[str, Any]
    turn: Turn


def read_material(folder: Path) -> Material:
    """The material of a run folder.

    Raises
    ------
    ResultError
        If the folder does not hold a finished run.
    """
    run = load_run(folder)
    case = _case(run)
    return Material(Path(folder), run, case, the_turn(run, case))


def the_turn(run: Run, case: Mapping[str, Any]) -> Turn:
    """What the sheet draws: the load case that governs, in the final trial."""
    final = run.final
    names = [str(name) for name in dict.fromkeys(final.cycle["load_case"].tolist())]
    if not names:
        raise ResultError(f"{final.path}: the cycle has no rows")
    by_name = {name: _numbers(final.cycle.where("load_case", name).columns) for name in names}
    drawn = governing_load_case(final.checks, names)
    return Turn(
        by_name[drawn], tuple(by_name.values()), final.lift.columns, final.contour.columns,
        None if run.torque is None else run.torque.columns, final.checks, case, drawn,
        None if run.speed is None else run.speed.columns, final.record.get("balance") or {},
        None if final.limits is None else final.limits.columns,
    )  # fmt: skip


def _numbers(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: values for name, values in columns.items() if values.dtype.kind == "f"}


def _case(run: Run) -> dict[str, Any]:
    try:
        return tomllib.loads(run.case_text)
    except tomllib.TOMLDecodeError as error:
        raise ResultError(f"{run.path / 'case.toml'}: {error}") from None
