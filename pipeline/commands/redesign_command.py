"""The catalogues searched for a case: rollers, springs and bushes with the cam drawn for each."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import (
    FAILED,
    PASSED,
    CaseArgument,
    progress_shown,
    show_json,
    stdout,
)


def redesign(
    case: CaseArgument,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Where the points are to lie.")
    ] = None,
    against: Annotated[
        str, typer.Option("--against", help="What ripple is set against: size or mass.")
    ] = "size",
    jobs: Annotated[int | None, typer.Option(help="Processes; all cores by default.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="The record as JSON.")] = False,
) -> int:
    """Rollers, springs and bushes of the catalogues: the least ripple at every size of the cam.

    Exit 0: there is such a front, 1: no choice keeps all limits, 2: error. What is solved is
    kept in DIR; the same command goes on where it was stopped.
    """
    from camwright.pipeline.studies.redesign.redesign_study import RECORD
    from camwright.pipeline.studies.redesign.redesign_study import redesign as searched
    from camwright.reports import redesign_page as page

    if jobs is not None and not 1 <= jobs <= 256:
        raise InputError("--jobs", jobs, ">= 1 and <= 256")
    with progress_shown() as progress:
        folder = Path(f"{case.stem}_redesign") if out is None else out
        document = searched(case, folder, against, jobs, progress)
    made = page.write(folder, document)
    if as_json:
        show_json(document)
    else:
        _show(document)
        stdout.print(f"record: {folder / RECORD}\npage: {made}", markup=False)
    return PASSED if document["points"] else FAILED


def _show(document: dict[str, Any]) -> None:
    from rich.table import Table

    from camwright.reports.redesign_page import COLUMNS
    from camwright.reports.report_tables import listed

    table = Table(box=None, pad_edge=False)
    for _, words in COLUMNS:
        table.add_column(words)
    for row in document["points"]:
        table.add_row(*(listed(row.get(name)) for name, _ in COLUMNS))
    if document["points"]:
        stdout.print(table)
    else:
        stdout.print("no choice of the catalogues keeps all limits", markup=False)
    missing = sorted({name for row in document["points"] for name in row["open"]})
    if missing:
        stdout.print(f"not evaluated in these points: {', '.join(missing)}", markup=False)
    counts = f"{len(document['tried'])} tried, {len(document['pruned'])} left out by bounds"
    stdout.print(f"{counts} and dominance; next: camwright run point_01.toml", markup=False)
