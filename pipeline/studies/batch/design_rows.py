"""Rows of designs: cells by column, refusals, columns and files of a shard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any

from camwright.pipeline.studies.batch.dataset import (
    DEPTH,
    FACTOR,
    FIXED,
    GOVERNING,
    ID,
    MESSAGE,
    SCREEN,
    parquet_bytes,
    table_of,
    timings_of,
)
from camwright.pipeline.studies.batch.design_task import Settings, Task

Cell = float | str | None
Row = dict[str, Cell]
Files = dict[str, bytes]
"""Contents by relative name."""
FAILED, NO_RESULT = "fail", "error"
OUT_OF_TIME = "not solved within {seconds:g} s"
OUT_OF_MEMORY = "not solved within {megabytes:.0f} MB of memory"
DIED = "the process of the solution died {times} times"
CLOCK = "timings.json"


def lost(message: str) -> Row:
    """Cells of a design without a result, refused or unsolved."""
    return {SCREEN.name: NO_RESULT, MESSAGE.name: message}


def out_of_time(settings: Settings) -> Row:
    """Cells of a design that exceeded its time limit."""
    return lost(OUT_OF_TIME.format(seconds=settings.seconds))


def out_of_memory(settings: Settings) -> Row:
    """Cells of a design that exceeded its memory limit."""
    return lost(OUT_OF_MEMORY.format(megabytes=settings.bytes / 1e6))


def died(times: int) -> Row:
    """Cells of a design whose process died."""
    return lost(DIED.format(times=times))


def columns_of(rows: Sequence[Row]) -> dict[str, list[Any]]:
    """Columns of a shard from the cells of its designs."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: [row.get(name) for row in rows] for name in names}


def completed(
    task: Task, columns: Mapping[str, Sequence[Any]], outputs: Sequence[str]
) -> dict[str, Any]:
    """Columns of the rows of a task for the dataset: those solved that match `outputs`, with fixed
    columns, factors, and the utilisation of governing checks.

    Parameters
    ----------
    task : Task          designs of the rows
    columns : mapping    solved values by name of column
    outputs : sequence   patterns of the names to be kept; empty: all

    Raises
    ------
    ResultError
        Of `table_of`, for a column that no dataset has.
    """
    count = len(task.ids)
    fixed = {each.name for each in FIXED}
    wanted = {
        name: values
        for name, values in columns.items()
        if name in fixed or not outputs or any(fnmatchcase(name, each) for each in outputs)
    }
    if GOVERNING.name in columns:  # by which borderline designs are ranked
        for name in {f"{each}.utilisation" for each in columns[GOVERNING.name] if each}:
            wanted.setdefault(name, columns[name])
    return {
        **{each.name: [None] * count for each in FIXED if each.name != "design"},
        ID.name: list(task.ids),
        DEPTH.name: [task.tier.word] * count,
        **{FACTOR + key: values for key, values in task.shown.items()},
        **wanted,
    }


def encoded(
    task: Task,
    columns: Mapping[str, Sequence[Any]],
    walls: Sequence[float],
    outputs: Sequence[str],
) -> tuple[bytes, bytes]:
    """Rows and clock figures of a task as Parquet files.

    Parameters
    ----------
    columns : mapping   values (n,) by column
    walls : sequence    wall time of each design, s
    outputs : sequence  as of `completed`

    Raises
    ------
    ResultError
        As `completed`.
    """
    rows = completed(task, columns, outputs)
    return parquet_bytes(table_of(rows, task.units)), parquet_bytes(timings_of(rows, walls))
