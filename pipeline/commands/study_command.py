"""Commands `study run` and `study report`: many designs, one dataset; answers and page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    PASSED,
    JobsOption,
    ResumeOption,
    progress_shown,
    stdout,
)
from camwright.pipeline.records.forms import DEPTHS

if TYPE_CHECKING:
    from camwright.pipeline.studies.batch.study_file import Study

JOBS_MAX = 256


def report(folder: Annotated[Path, Words("Study folder.", "DIR")]) -> int:
    """Write answers and page of a study folder again; nothing is solved.

    Example: camwright study report runs/roller
    """
    stdout.print(f"page: {write_study_report(folder)}", markup=False)
    return PASSED


def run(
    files: Annotated[list[Path], Words("Study file, or case files as designs.", "FILE")],
    *,
    out: Annotated[Path, Words("Study folder to write.", "DIR")],
    jobs: JobsOption = None,
    scheduler: Annotated[str | None, Words("Running Dask scheduler to use.", "ADDRESS")] = None,
    depth: Annotated[
        str | None,
        Words("Depth for case files; a study file states its own.", "DEPTH", choices=DEPTHS),
    ] = None,
    resume: ResumeOption = False,
) -> int:
    """Solve the designs of a study file, or case files as designs, into one dataset.

    Factors, sampling, depth and questions stand in the study file; the answers and their page
    follow the dataset. Needs the extra camwright[study].

    Example: camwright study run studies/roller.toml --out runs/roller
    """
    from camwright.pipeline.base.worker_processes import workers_for
    from camwright.pipeline.studies.batch.study_file import chosen_study
    from camwright.pipeline.studies.batch.study_run import run_study
    from camwright.pipeline.studies.batch.task_scheduler import require_address

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
    """Title and text of what the study file states, for the head of the page."""
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
