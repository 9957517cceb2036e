"""Command `redesign`: search of the catalogues for rollers, springs and bushes of a case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import (
    FAILED,
    INCOMPLETE,
    PASSED,
    CaseArgument,
    progress_shown,
    show_json,
    stdout,
)

if TYPE_CHECKING:
    from camwright.pipeline.records.redesign_document import RedesignDocument


def redesign(
    case: CaseArgument,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for the points.")
    ] = None,
    against: Annotated[
        str, typer.Option("--against", help="Second objective besides torque ripple: size or mass.")
    ] = "size",
    jobs: Annotated[
        int | None, typer.Option(help="Number of processes; default: number of cores, at most 4.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the record as JSON.")] = False,
) -> int:
    """Search the catalogues for the parts of a case.

    Pareto front of torque ripple and size (or mass) over rollers, springs and bushes, with the cam
    synthesised for each. Exit code 0: the points of the front pass in the preview, 1: every choice
    fails, 2: error, 3: the points lack data. Solved points are cached in DIR; run the command again
    to resume.
    """
    from camwright.pipeline.search.parts.redesign_study import RECORD
    from camwright.pipeline.search.parts.redesign_study import redesign as searched
    from camwright.reports.comparisons import redesign_page as page

    if jobs is not None and not 1 <= jobs <= 256:
        raise InputError("--jobs", jobs, ">= 1 and <= 256")
    with progress_shown() as progress:
        folder = Path(f"{case.stem}_redesign") if out is None else out
        document = searched(case, folder, against, jobs, progress)
    made = page.write(folder, document)
    if as_json:
        show_json(document)
    else:
        _show(document, folder)
        stdout.print(f"record: {folder / RECORD}\npage: {made}", markup=False)
    if not document["points"]:
        return FAILED
    lacking = any(row["open"] for row in document["points"])
    return INCOMPLETE if lacking else PASSED


def _show(document: RedesignDocument, folder: Path) -> None:
    from rich.table import Table

    from camwright.reports.comparisons.redesign_page import COLUMNS
    from camwright.reports.report_tables import listed

    table = Table(box=None, pad_edge=False)
    for _, words in COLUMNS:
        table.add_column(words)
    rows: Sequence[Mapping[str, Any]] = document["points"]
    for row in rows:
        table.add_row(*(listed(row.get(name)) for name, _ in COLUMNS))
    counts = f"{len(document['tried'])} tried, {len(document['pruned'])} left out by bounds"
    if document["without_result"] is not None:
        for line in document["without_result"]["lines"]:
            stdout.print(line, markup=False)
        stdout.print(f"{counts} and dominance", markup=False)
        return
    stdout.print(table)
    missing = sorted({name for row in document["points"] for name in row["open"]})
    if missing:
        stdout.print(f"missing data of these points: {', '.join(missing)}", markup=False)
    first = folder / document["points"][0]["file"]
    stdout.print(
        f"{counts} and dominance; next: camwright run {first} --out runs/{first.stem}", markup=False
    )
