"""Run of a study: plan, shards on a cluster, deeper stage, dataset, kept runs, summary."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.extras import require_extra
from camwright.pipeline.base.files import sha256_of
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.study_document import StudyDocument
from camwright.pipeline.studies.batch.answers_yield import FAILS, PASSES, UNKNOWN, Yield
from camwright.pipeline.studies.batch.case_template import (
    Template,
    UnpackedTemplates,
    read_templates,
)
from camwright.pipeline.studies.batch.dataset import (
    DATASET,
    DESIGN,
    FACTOR,
    HEADLINE,
    column_of,
    is_text,
    table_from,
)
from camwright.pipeline.studies.batch.design_plan import Plan, study_versions
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted
from camwright.pipeline.studies.batch.factor_axes import Axis, axis_of
from camwright.pipeline.studies.batch.row_selection import RowFigures, states_in
from camwright.pipeline.studies.batch.sampling import SampledDesigns, designs_of
from camwright.pipeline.studies.batch.study_file import StageEnd, Study
from camwright.pipeline.studies.batch.study_folder import Shard, StudyFolder
from camwright.pipeline.studies.batch.task_scheduler import TaskScheduler
from camwright.reports.report_tables import HEADLINES

if TYPE_CHECKING:
    import pyarrow as pa

_NOTE_EVERY_S = 10.0


def run_study(
    study: Study,
    text: str,
    folder: Path,
    out: Path,
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    resume: bool = False,
    progress: Progress = SILENT,
) -> StudyDocument:
    """Solve the designs of a study and write its folder.

    Parameters
    ----------
    study, text : Study, str   study file, read and as text
    folder : Path              of the study file, from which the cases are read
    out : Path                 study folder
    jobs : int                 local processes
    scheduler : str            address of a running Dask cluster; None: local processes
    resume : bool              complete an earlier study in `out`
    progress : Progress        told each stage

    Returns
    -------
    dict   contents of ``study.json``

    Raises
    ------
    CamError
        If the study, a case or the folder is refused, a library is missing, or the cluster is lost.
    """
    require_extra("study", "a study")
    progress.stage("designs")
    templates = read_templates(folder, study.cases)
    axes, settings = _axes(study, templates), _settings(study, templates)
    home = StudyFolder(out, resume=resume)
    home.require_free()
    with TaskScheduler(jobs, scheduler, templates, settings) as workers:
        if not resume:  # else all shards may be there
            workers.begin()
        plan = _plan(study, templates, axes, settings)
        with home:
            home.write_inputs(text, templates)
            return _Run(study, plan, home, workers, progress).finish()


def planned(study: Study, templates: Sequence[Template]) -> Plan:
    """Designs of a study with their tasks.

    Raises
    ------
    InputError
        If a factor does not fit the first case, the sampling does not fit the factors, or an
        objective is no column of numbers.
    """
    return _plan(study, templates, _axes(study, templates), _settings(study, templates))


def _axes(study: Study, templates: Sequence[Template]) -> list[Axis]:
    """Axis of each factor of a study; none without sampling.

    Raises
    ------
    InputError
        If a factor does not fit the first case, or an objective is no column of numbers.
    """
    axes: list[Axis] = []
    if study.sampling is not None:
        cases = UnpackedTemplates(templates)
        base = cases[templates[0].name]
        axes = [axis_of(factor, base) for factor in study.factors]
    for each in study.objectives:
        _require_numbers(each.column, {axis.key: axis.unit for axis in axes})
    return axes


def _settings(study: Study, templates: Sequence[Template]) -> Settings:
    wanted = [each.column for each in study.objectives]
    return Settings(
        templates={each.name: each.sha256 for each in templates},
        versions=study_versions(),
        cam=study.cam,
        positions=study.positions,
        corners=study.corners,
        outputs=(*study.outputs, *wanted) if study.outputs else (),
        seconds=study.limits.time,
        bytes=study.limits.bytes,
    )


def _plan(
    study: Study, templates: Sequence[Template], axes: Sequence[Axis], settings: Settings
) -> Plan:
    """Plan of the study: its sampled designs for every case, equal ones merged."""
    designs: SampledDesigns | None = None
    if study.sampling is not None:
        designs = designs_of(axes, study.sampling, study.correlations)
    return Plan.of([each.name for each in templates], designs, settings)


def _require_numbers(name: str, units: Mapping[str, str | None]) -> None:
    """Refuse an objective that is no column of numbers of the dataset, by InputError.

    Parameters
    ----------
    name : str        of the column
    units : mapping   unit of each factor by dotted key; None: its values are text
    """
    limit = "a column of numbers of the dataset, such as headline.p0_hertz_max_MPa"
    try:
        column_of(name, units)
    except ResultError:
        raise InputError("objective.column", name, limit) from None
    unknown = (name.startswith(HEADLINE) and name.removeprefix(HEADLINE) not in HEADLINES) or (
        name.startswith(FACTOR) and name.removeprefix(FACTOR) not in units
    )
    if unknown or name == DESIGN.name or is_text(name, units):
        raise InputError("objective.column", name, limit)


@dataclass(eq=False)
class _Run:
    """A study while it is solved."""

    study: Study
    plan: Plan
    home: StudyFolder
    scheduler: TaskScheduler
    progress: Progress
    stopped: str | None = None
    solved: int = 0
    figures: RowFigures = field(init=False)

    def __post_init__(self) -> None:
        self.figures = RowFigures(self.study.objectives)

    def finish(self) -> StudyDocument:
        """Solve all designs, up to the stop rule, then those chosen for the second stage, if there
        is one; write dataset, run folders of the designs kept, and summary. Gives the contents of
        ``study.json``.
        """
        study, plan, home = self.study, self.plan, self.home
        first = self._stage(study.tier, plan.tasks(study.tier), len(plan.ids), stop=True)
        deeper: list[Shard] = []
        if study.deeper is not None:
            rule = study.deeper
            chosen = (
                self.figures.best(rule.count)
                if rule.take == "best"
                else self.figures.borderline(rule.count)
            )
            tasks = self._tasks_of(self._second, chosen)
            deeper = self._stage(self._second, tasks, len(chosen), stop=False)
        kept = sorted(self.figures.kept(*study.kept))
        if not kept:
            self.scheduler.release()
        self.progress.stage("dataset")
        self.solved = sum(len(shard.ids) for shard in first)
        home.write_dataset(plan.place[: plan.whole(self.solved)], first, deeper, plan.ids)
        home.forget_others([*first, *deeper], kept)
        self._keep(kept, {name for shard in deeper for name in shard.ids})
        record = self._record(kept)
        home.write_summary(record)
        return record

    def _tasks_of(self, tier: Tier, ids: Sequence[str]) -> Iterator[Task]:
        order = {name: k for k, name in enumerate(self.plan.ids)}
        return self.plan.tasks(tier, sorted(order[name] for name in ids))

    def _stage(self, tier: Tier, tasks: Iterable[Task], count: int, *, stop: bool) -> list[Shard]:
        """Solve the tasks of one depth that have no shard in the folder yet; returns the shards of
        all, in order.

        Parameters
        ----------
        tier : Tier        depth
        tasks : iterable   of all designs of the stage
        count : int        number of these designs
        stop : bool        whether the stop rule of the study ends the stage
        """
        self.progress.stage(f"{tier.word}: {count} designs")
        watch = _Watch(self, count, self.study.stop if stop else None)

        def missing() -> Iterator[Task]:
            for task in tasks:
                if watch.stopped:
                    return
                shard = Shard(task.name, task.ids)
                watch.expect(shard)
                table = self.home.read_whole(shard)
                if table is None:
                    yield task
                else:
                    watch.take(shard, table)

        pending = missing()
        start = next(pending, None)
        if start is not None:
            waiting, made = chain([start], pending), set[str]()
            for task, (rows, clock, runs) in self.scheduler.shards(
                waiting, lambda: self._wanted(tier, watch)
            ):
                for name, files in runs.items():  # before their rows, by which they are known
                    self.home.write_run(name, files)
                self.home.write_shard(task.name, rows, clock)
                watch.take(Shard(task.name, task.ids), table_from(rows))
                if runs:
                    made = self._delete_unwanted(made | set(runs), tier, watch)
                if watch.stopped:
                    break
        shards = watch.shards()
        if watch.stopped:
            self.stopped = watch.stopped
            self.figures.keep({name for shard in shards for name in shard.ids})
        return shards

    def _wanted(self, tier: Tier, watch: _Watch) -> Wanted | None:
        """Rule for the designs of a depth whose run folder is made together with their row; None
        where no run is kept, or the depth is screening, whose arrays hold no curves.

        With a stop rule it rests on the designs alone that the dataset has wherever it stops.

        Parameters
        ----------
        tier : Tier      depth
        watch : _Watch   designs solved so far
        """
        kind, most = self.study.kept
        if not kind or tier < Tier.PREVIEW:
            return None
        return self.figures.of(tier, watch.certain).wanted(kind, most)

    def _delete_unwanted(self, made: set[str], tier: Tier, watch: _Watch) -> set[str]:
        """Delete the run folders that cannot be among those that the study keeps in the end; ids of
        the others. None is deleted as long as each of them may be kept.

        Parameters
        ----------
        made : set       ids of the designs with a run folder
        tier : Tier      depth at which the designs are solved now
        watch : _Watch   designs solved so far
        """
        wanted = self._wanted(tier, watch)
        still = made if wanted is None else self.figures.taken(made, wanted)
        for name in made - still:
            self.home.delete_run(name)
        return still

    def _keep(self, kept: Sequence[str], deeper: set[str]) -> None:
        """Solve and write the run folders of the designs to be kept that are not there yet, then
        their pages.

        Parameters
        ----------
        kept : sequence   ids of the designs
        deeper : set      ids of those solved at the depth of the second stage
        """
        tasks: list[Task] = []
        for tier, ids in (
            (self.study.tier, [name for name in kept if name not in deeper]),
            (self._second, [name for name in kept if name in deeper]),
        ):
            for task in self._tasks_of(tier, ids):
                tasks += [task.alone(row) for row in range(len(task.ids))]
        missing = [
            task
            for task in tasks
            if not self.home.holds_run(task.ids[0], task.tier.word, self.plan.settings.versions)
        ]
        if missing:
            self.progress.stage(f"runs: {len(missing)} designs")
            for k, (task, files) in enumerate(self.scheduler.runs(missing), start=1):
                self.home.write_run(task.ids[0], files)
                self.progress.advance(k, len(missing))
        self._present(kept)

    def _present(self, kept: Sequence[str]) -> None:
        """Write the pages of the runs that were made with their rows."""
        bare = (name for name in kept if self.home.lacks_page(name))
        runs = ((name, self.home.files_of_run(name)) for name in bare)
        first = next(runs, None)
        if first is None:
            return
        self.progress.stage("pages")
        for (name, _), files in self.scheduler.pages(chain([first], runs)):
            if files:
                self.home.write_run(name, files)

    @property
    def _second(self) -> Tier:
        """Depth of the second stage; that of the first without one."""
        rule = self.study.deeper
        return self.study.tier if rule is None else Tier.of(rule.depth, "deeper.depth")

    def _record(self, kept: Sequence[str]) -> StudyDocument:
        study, plan = self.study, self.plan
        return {
            "name": study.name,
            "title": study.title,
            "designs": plan.whole(self.solved),
            "planned": len(plan.place),
            "unique": self.solved,
            "stopped": self.stopped,
            **self.figures.record(),
            "kept": list(kept),
            "dataset_sha256": sha256_of(self.home.path / DATASET),
            "templates": dict(plan.settings.templates),
            "versions": dict(plan.settings.versions),
        }


class _Watch:
    """Progress of a stage, and its stop rule on the shards that are complete in their order.

    The width of the interval is that of the same designs whatever the number of processes: those
    before the first shard that is not complete. Their yield is counted as in the answers. certain:
    their ids, of the dataset wherever it stops; None without a rule: those of all rows.
    """

    def __init__(self, run: _Run, count: int, rule: StageEnd | None) -> None:
        """Watch `count` designs of a stage of a run, to be ended by `rule`; None: by none."""
        self._run, self._count, self._rule = run, count, rule
        self._order: list[Shard] = []
        self.certain: set[str] | None = None if rule is None else set()
        self._ready: dict[str, NDArray[np.uint8]] = {}
        self._states = np.full(len(run.plan.ids), UNKNOWN, dtype=np.uint8)  # of unique designs
        self._solved = self._failed = self._lost = 0
        self._whole = self._unique = self._designs = self._passes = self._judged = 0
        self._began = self._spoke = time.monotonic()
        self.stopped = ""

    def expect(self, shard: Shard) -> None:
        """The next shard in order."""
        self._order.append(shard)

    def take(self, shard: Shard, table: pa.Table) -> None:
        """Enter a complete shard with its rows, report progress, and apply the stop rule."""
        self._run.figures.add(table)
        states = self._ready[shard.name] = states_in(table)
        self._solved += len(shard.ids)
        self._failed += int((states == FAILS).sum())
        self._lost += int((states == UNKNOWN).sum())
        self._run.progress.advance(self._solved, self._count)
        now = time.monotonic()
        if now - self._spoke >= _NOTE_EVERY_S:
            self._spoke = now
            rate = self._solved / (now - self._began)
            words = f"{self._failed} of {self._solved} fail, {self._lost} without result"
            self._run.progress.note(f"{words}, {rate:.3g} designs a second")
        self._judge(now - self._began)

    def _judge(self, seconds: float) -> None:
        """Apply the stop rule to the shards complete without a gap from the first.

        Parameters
        ----------
        seconds : float   since the start of the stage
        """
        rule = self._rule
        while not self.stopped and self._whole < len(self._order):
            shard = self._order[self._whole]
            if shard.name not in self._ready:
                break
            self._whole += 1
            if self.certain is not None:
                self.certain |= set(shard.ids)
            if rule is not None and rule.interval is not None:
                self._count_in(self._ready[shard.name])
                width = Yield(self._passes, self._judged).width
                self.stopped = "interval" if width <= rule.interval else ""
        if rule is not None and rule.time is not None and seconds >= rule.time:
            self.stopped = self.stopped or "time"

    def _count_in(self, states: NDArray[np.uint8]) -> None:
        """Count the drawn designs whose results are known with the next shard, and those of them
        that pass.

        Parameters
        ----------
        states : array   of the unique designs of the shard; one drawn several times counts as often
        """
        plan, start = self._run.plan, self._unique
        self._unique += len(states)
        self._states[start : self._unique] = states
        whole = plan.whole(self._unique)
        drawn = self._states[plan.place[self._designs : whole]]
        self._designs = whole
        self._passes += int((drawn == PASSES).sum())
        self._judged += int((drawn != UNKNOWN).sum())

    def shards(self) -> list[Shard]:
        """Shards of the stage: all, or those before the stop."""
        return self._order[: self._whole]
