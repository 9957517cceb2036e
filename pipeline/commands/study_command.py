"""Command `study`: many designs on a cluster, one dataset."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import PASSED, progress_shown, stdout

JOBS_MAX = 256


def study(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE...", help="Study file, or case files.")
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Study folder to write.")],
    jobs: Annotated[
        int | None, typer.Option(help="Number of processes; default: number of cores, at most 4.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option("--scheduler", metavar="ADDRESS", help="Running Dask scheduler to use."),
    ] = None,
    depth: Annotated[
        str | None,
        typer.Option("--depth", help="Depth for case files; a study file states its own."),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Complete the study in DIR.")] = False,
) -> int:
    """Solve the designs of a study file, or case files as designs, into one dataset."""
    from camwright.pipeline.base.worker_processes import workers_for
    from camwright.pipeline.studies.batch.study_file import chosen_study
    from camwright.pipeline.studies.batch.study_run import run_study

    if jobs is not None and not 1 <= jobs <= JOBS_MAX:
        raise InputError("--jobs", jobs, f">= 1 and <= {JOBS_MAX}")
    chosen, text, folder = chosen_study(files, depth)
    with progress_shown() as progress:
        record = run_study(
            chosen,
            text,
            folder,
            out,
            jobs=workers_for(jobs, JOBS_MAX),
            scheduler=scheduler,
            resume=resume,
            progress=progress,
        )
    for word in ("depth", "screen", "verdict"):
        counts = record[word]
        if isinstance(counts, dict) and counts:
            words = ", ".join(f"{name} {count}" for name, count in counts.items())
            stdout.print(f"{word}: {words}", markup=False)
    stopped = f", stopped by {record['stopped']}" if record["stopped"] else ""
    stdout.print(f"{record['designs']} designs{stopped}: {out / 'dataset.parquet'}", markup=False)
    return PASSED
