"""Command `study`: many designs on a cluster, one dataset; answers and page of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.terminal import PASSED, progress_shown, stdout

if TYPE_CHECKING:
    from camwright.pipeline.studies.batch.study_file import Study

JOBS_MAX = 256
REPORT = "report"


def study(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE... | report DIR",
            help="Study file, or case files; or report and the folder of a study.",
        ),
    ],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Study folder to write.")
    ] = None,
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
    """Solve the designs of a study file, or case files as designs, into one dataset.

    `camwright study report DIR` writes answers and page of a study folder again; nothing is solved.
    """
    if files[0] == Path(REPORT):
        if len(files) != 2:
            raise InputError("study report", len(files) - 1, "one study folder")
        stdout.print(f"page: {write_study_report(files[1])}", markup=False)
        return PASSED
    if out is None:
        raise InputError("--out", "missing", "the study folder to write")
    from camwright.pipeline.base.worker_processes import workers_for
    from camwright.pipeline.studies.batch.study_file import chosen_study
    from camwright.pipeline.studies.batch.study_run import run_study
    from camwright.pipeline.studies.batch.task_scheduler import require_address

    if jobs is not None and not 1 <= jobs <= JOBS_MAX:
        raise InputError("--jobs", jobs, f">= 1 and <= {JOBS_MAX}")
    if scheduler is not None:
        require_address(scheduler)
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
    for word, counts in (
        ("depth", record["depth"]), ("screen", record["screen"]), ("verdict", record["verdict"]),
    ):  # fmt: skip
        if counts:
            words = ", ".join(f"{name} {count}" for name, count in counts.items())
            stdout.print(f"{word}: {words}", markup=False)
    stopped = f", stopped by {record['stopped']}" if record["stopped"] else ""
    stdout.print(f"{record['designs']} designs{stopped}: {out / 'dataset.parquet'}", markup=False)
    stdout.print(f"page: {write_study_report(out)}", markup=False)
    return PASSED


def write_study_report(folder: Path) -> Path:
    """Write ``answers.json`` and ``study.html`` from ``study.toml`` and the dataset.

    Returns
    -------
    Path   the page

    Raises
    ------
    InputError, ResultError
        If the study file or the dataset cannot be read, they contradict each other, or a library
        is missing.
    """
    from camwright.pipeline.base.extras import require_extra
    from camwright.pipeline.base.files import json_text, require_plain, write_atomic
    from camwright.pipeline.studies.batch import answers
    from camwright.pipeline.studies.batch.dataset import (
        ANSWERS,
        FACTOR,
        PAGE,
        RUNS,
        STUDY,
        read_dataset,
    )
    from camwright.pipeline.studies.batch.study_file import read_study
    from camwright.reports import page
    from camwright.reports.study import study_page

    require_extra("study", "the report of a study")
    require_plain(folder)
    study = read_study(folder / STUDY)
    data = read_dataset(folder)
    record = answers.answered(data, study)
    write_atomic(folder / ANSWERS, json_text(record))
    outputs = {row["name"] for row in record["outputs"]}
    objectives = {each.column for each in study.objectives}
    columns = {
        name: data[name] for name in data.columns
        if name.startswith(FACTOR) or name in outputs | objectives
    }  # fmt: skip
    state, _ = answers.states(data)
    kept = {path.parent.name for path in (folder / RUNS).glob(f"*/{page.PAGE}")}
    links = {
        int(number): f"{RUNS}/{name}/{page.PAGE}"
        for number, name in zip(data["design"], data["id"], strict=True) if name in kept
    }  # fmt: skip
    designs = study_page.DesignRows(
        data["design"], state, data["governing"],
        columns | {answers.UTILISATION: answers.governing_utilisation(data)}, data.units, links,
    )  # fmt: skip
    return study_page.write(
        folder / PAGE, study.title or study.name, _facts(study), record, designs
    )


def _facts(study: Study) -> list[tuple[str, str]]:
    """What the study file states, for the head of the page."""
    cases = study.cases[0] if len(study.cases) == 1 else f"{len(study.cases)} cases"
    depth: str = study.depth
    if study.deeper is not None:
        depth += f"; {study.deeper.take} {study.deeper.count} {study.deeper.depth}"
    facts = [("Case", cases), ("Depth", depth), ("Factors", str(len(study.factors)))]
    if study.sampling is not None:
        method = study.sampling.method.replace("_", " ")
        count = "" if study.sampling.count is None else f", seed {study.sampling.seed}"
        facts.append(("Sampling", method + count))
    return facts
