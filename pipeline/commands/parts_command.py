"""Command `design parts`: search of the catalogues for rollers, springs and bushes of a case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, get_args

from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    FAILED,
    INCOMPLETE,
    PASSED,
    CaseArgument,
    JobsOption,
    JsonOption,
    progress_shown,
    show_json,
    stdout,
)
from camwright.pipeline.records.redesign_document import Against, RedesignDocument


def parts(
    case: CaseArgument,
    *,
    out: Annotated[
        Path | None, Words("Folder for the points; default: CASE_redesign.", "DIR")
    ] = None,
    against: Annotated[
        str,
        Words(
            "Second objective besides torque ripple; default: size.",
            "OBJECTIVE",
            choices=get_args(Against),
        ),
    ] = "size",
    jobs: JobsOption = None,
    as_json: JsonOption = False,
) -> int:
    """Search the catalogues for rollers, springs and bushes of a case.

    Pareto front of torque ripple and size (or mass), with the cam synthesised for each choice.
    Exit code 3: points within all limits lack data. Solved points are cached in DIR; run the
    command again to resume.

    Example: camwright design parts pump.toml --against mass
    """
    from camwright.pipeline.search.parts.redesign_study import RECORD
    from camwright.pipeline.search.parts.redesign_study import redesign as searched
    from camwright.reports.comparisons import redesign_page as page

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
    """Print the result of a redesign: front as a table, what was tried and, without a front, why.

    Parameters
    ----------
    document : dict   contents of ``redesign.json``
    folder : Path     with the case files of the front
    """
    from rich.table import Table

    from camwright.reports.comparisons.redesign_page import COLUMNS
    from camwright.reports.report_tables import listed

    table = Table(box=None, pad_edge=False)
    for _, words in COLUMNS:
        table.add_column(words)
    rows: Sequence[Mapping[str, Any]] = document["points"]
    for row in rows:
        table.add_row(*(listed(row.get(name)) for name, _ in COLUMNS))
    for line in document["as_given"]:
        stdout.print(line, markup=False)
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
