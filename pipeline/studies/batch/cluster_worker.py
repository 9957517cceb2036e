"""Dask worker side of a study: keeps the templates, solves one shard after another.

Imported where Dask is, by `task_scheduler` and by the workers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

from distributed import Reschedule, WorkerPlugin, get_worker

from camwright.pipeline.studies.batch.case_template import Template
from camwright.pipeline.studies.batch.design_rows import Files
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted
from camwright.pipeline.studies.batch.solver_process import EndedError, SolverProcess

Shard = tuple[bytes, bytes, Mapping[str, Files]]
"""Rows and clock figures of a task as Parquet files; files of runs made with the rows, by id."""
Bare = tuple[str, Files]
"""Id of a design and the files of its run without the page."""


class StudyPlugin(WorkerPlugin):
    """Worker plugin with the templates, sent once, to later workers as well."""

    def __init__(self, name: str, templates: Sequence[Template], settings: Settings) -> None:
        self.name, self.templates, self.settings = name, tuple(templates), settings

    def setup(self, worker: Any) -> None:  # noqa: ARG002 - signature of Dask
        """Start of the worker."""
        self.process = SolverProcess(self.templates, self.settings)
        self.process.begin()

    def teardown(self, worker: Any) -> None:  # noqa: ARG002
        """End of the worker."""
        self.process.end()


def solve_shard(task: Task, plugin: str, wanted: Wanted | None) -> Shard:
    """Rows, clock figures and run files of a task, solved in the process of the worker; a process
    that was ended lets the scheduler hand the task out again.

    Parameters
    ----------
    task : Task       designs of one case
    plugin : str      name of the plugin of the worker, which holds the process
    wanted : Wanted   designs whose run files are made, too; None: of none
    """
    study = cast(StudyPlugin, get_worker().plugins[plugin])
    try:
        return study.process.rows(task, wanted)
    except EndedError:
        raise Reschedule from None


def solve_run(task: Task, plugin: str) -> Files:
    """Files of the run folder, by name, of a task with one design, solved in the process of the
    worker.
    """
    study = cast(StudyPlugin, get_worker().plugins[plugin])
    try:
        return study.process.run_folder(task, 0)
    except EndedError:
        raise Reschedule from None


def make_page(run: Bare, plugin: str) -> Files:
    """Files of a run folder with the page added, made in the process of the worker.

    Parameters
    ----------
    run : tuple    id of the design, and the files without the page, by name
    plugin : str   name of the plugin of the worker
    """
    study = cast(StudyPlugin, get_worker().plugins[plugin])
    try:
        return study.process.presented(run[1])
    except EndedError:
        raise Reschedule from None
