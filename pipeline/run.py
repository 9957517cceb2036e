"""Run of a case: trials, certificate, tolerance corners, run folder."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace as with_changes
from pathlib import Path
from types import TracebackType
from typing import Self, TypedDict, Unpack

from camwright.geometry.errors import CamError
from camwright.pipeline.base.progress import SILENT, Progress, utc
from camwright.pipeline.base.source import old_words
from camwright.pipeline.base.verdict import governing_id
from camwright.pipeline.base.worker_processes import ALONE, PendingCall, crew
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import refused_as_written
from camwright.pipeline.case.load_case_torque import (
    engine_torques,
    measurement_record,
    measurement_words,
)
from camwright.pipeline.case.plausibility import implausible
from camwright.pipeline.checks.tolerance_corners import corners_record
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.ripple_map import ripple_map
from camwright.pipeline.iteration import Iteration, solved_already, trials
from camwright.pipeline.records.run_summary import (
    ClockRecord,
    JudgedSummary,
    Refused,
    RippleMapRecord,
    SolvedSummary,
)
from camwright.pipeline.results.field_output import ENDS, Shown, write_end_field, write_fields
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_reader import Run, read_run
from camwright.pipeline.results.run_records import (
    crank_speed_record,
    headline,
    quality_record,
    torque_columns,
)
from camwright.pipeline.results.trial import Trial, TrialPoint
from camwright.pipeline.results.trial_writer import write_judgement, write_trial_files
from camwright.pipeline.results.valve_train import valve_record
from camwright.pipeline.results.workshop_files import WORKSHOP, write_workshop
from camwright.pipeline.search.remedies.remedy_search import order_of, texts_of, with_remedies
from camwright.pipeline.smoothing.required_lift import required_torque
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import certify_trial
from camwright.pipeline.torque.torque import Torque

START = "start"
"""Stage before the first: start of the program, imports, case file."""
_ORDER = "the steps of a run are solve, write, certify and finish, each once"


class RunOptions(TypedDict, total=False):
    """Options of `run_case`, with the defaults and the meaning of `CaseRun`."""

    depth: Tier
    positions: int | None
    jobs: int | None
    resume: bool
    replace: bool
    fields: Shown
    progress: Progress
    began: float | None


class CaseRun:
    """Run of a case in steps: solve, write, certify, finish; a context manager.

    The steps in order: `solve`, `write`, `certify`, `finish`; pages are drawn from the folder of
    `draft` while it is written. The live preview of a certified run is fitted meanwhile. A run that
    is left before `finish` can be resumed.

    Parameters
    ----------
    out : Path           run folder to write
    depth : Tier         of the solution; below CERTIFIED the run has no verdict
    positions : int      per cam turn; None: those of the case
    jobs : int           processes for the certificate; None: number of processors, at most 4
    resume : bool        continue an interrupted run
    replace : bool       take the place of a run of an earlier version of the case
    fields : Shown       cam angles of the stress field
    began : float        `time.perf_counter` at the start of the program, for the times of the
                         stages; None: now

    Raises
    ------
    CamError
        In every step, if the case, a trial or a file cannot be solved, read or written.
    """

    def __init__(
        self,
        case: Case,
        out: str | Path,
        *,
        depth: Tier = Tier.CERTIFIED,
        positions: int | None = None,
        jobs: int | None = None,
        resume: bool = False,
        replace: bool = False,
        fields: Shown = Shown.DEFAULT,
        progress: Progress = SILENT,
        began: float | None = None,
    ) -> None:
        """Options of the run; nothing is read or written before the context is entered."""
        self.case = case if positions is None else case.with_positions(positions)
        self.out, self.depth = Path(out), depth
        self._jobs, self._resume, self._replace = jobs, resume, replace
        self._shown, self._progress, self._began = fields, progress, began
        self._last: Trial | None = None  # until its files are written
        self._final: Trial | None = None  # until its solution is released
        self._remedies: list[PendingCall] = []
        self._live: PendingCall | None = None
        self._statement = ""
        self._points: tuple[TrialPoint, ...] = ()
        self._solved: SolvedSummary | None = None
        self._judged: JudgedSummary | None = None

    def __enter__(self) -> Self:
        """Open the run folder and the worker processes."""
        with ExitStack() as stack:
            stack.enter_context(refused_as_written(self.case))
            self._folder = stack.enter_context(
                RunFolder(
                    self.out,
                    self.case,
                    depth=self.depth,
                    resume=self._resume,
                    replace=self._replace,
                )
            )
            self.workers = stack.enter_context(crew(self._jobs))
            self._stack = stack.pop_all()
        self._watch = Stopwatch(self._progress, self._began)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.__exit__(kind, error, trace)

    def solve(self, trial: Trial | None = None) -> Trial:
        """Torque and trials; the final trial, whose files are not written yet.

        Of a certified run the search of its remedies begins in the worker processes.

        Parameters
        ----------
        trial : Trial   the only trial, solved at the depth of the run below CERTIFIED; None: it is
                        solved here
        """
        torques = self._torques()
        last, iteration = self._tried(torques) if trial is None else (trial, solved_already(trial))
        final, self._statement, self._points = iteration
        self._last, self._final = last, final
        if self.depth is Tier.CERTIFIED:
            parts = order_of(final, self._folder.path).parts
            self._remedies = [self.workers.submit(texts_of, part) for part in parts]
        return final

    def _torques(self) -> dict[str, Torque]:
        """Engine torque of each load case; writes that of the first, and notes old names,
        implausible values and measurements.
        """
        case, watch = self.case, self._watch
        watch.stage("torque")
        if self.depth is Tier.CERTIFIED:
            self.workers.prepare(order_of.__module__)
        torques = engine_torques(case)
        for words in (
            *old_words(case.written.tables),
            *(one.how for one in implausible(case, torques)),
        ):
            watch.note(f"warning: {words}")
        for line in measurement_words(case):
            watch.note(line)
        if torques:
            self._folder.write("1_torque.csv", torque_columns(torques[case.load_cases[0].name]))
        return torques

    def _tried(self, torques: Mapping[str, Torque]) -> tuple[Trial, Iteration]:
        """Last trial with the iteration that led to it; the files of those before it are
        written.
        """
        made = trials(
            self.case,
            torques,
            tier=self.depth,
            stores=self._folder.contact_store,
            progress=self._watch,
            workers=self.workers if self.depth is Tier.CERTIFIED else ALONE,
        )
        while True:
            trial, iteration = next(made)
            if iteration is not None:
                return trial, iteration
            write_trial_files(self._folder, trial)
            del trial  # its solution takes most of the memory

    def write(self) -> None:
        """Write the files of the last trial, tolerance corners, stress fields and workshop
        files.
        """
        folder, watch, final = self._folder, self._watch, _made(self._final)
        write_trial_files(folder, _made(self._last))
        self._last = None
        if final.corners:
            folder.write("corners.json", corners_record(final.case, final.corners))
        self._solved = summary_of(folder, final, self._points)
        self._judged = judged_of(final, self._statement)
        if self.depth >= Tier.CYCLE:
            watch.stage("fields")
            write_fields(folder.fields, final, self._shown, watch.advance)
        if final.mesh is not None:  # else the contour is no body to machine
            watch.stage(WORKSHOP)
            write_workshop(folder.path / WORKSHOP, final.case, final.contour, note=watch.note)

    def certify(self) -> Trial:
        """Final trial with its certificate; unchanged below the depth CERTIFIED."""
        final = _made(self._final)
        if self.depth < Tier.CERTIFIED:
            return final
        self._folder.write_summary(self._summary())
        self._live = self.workers.submit(_write_live, self._folder.path)
        store = self._folder.contact_store(final.number)
        certified = certify_trial(final, self.workers, store=store, progress=self._watch)
        self._statement = restated(self._statement, _failing(final), _failing(certified))
        self._final = certified
        return certified

    def draft(self) -> Path:
        """Folder of the run with its ``run.json`` so far, from which pages are drawn.

        The solution, which takes most of the memory, is released after the certificate.
        """
        self._settle()
        self._watch.stage("report")
        self._folder.write_summary(self._summary())
        return self._folder.path

    def finish(self) -> Run:
        """Write ``run.json`` and the sign-off record, and move the folder to its final path.

        Returns
        -------
        Run    read back from the folder
        """
        self._settle()
        if self._final is not None:
            raise RuntimeError(_ORDER)
        self._folder.finish(self._summary())
        return read_run(self.out)

    def _settle(self) -> None:
        """Write what the certificate changes, the remedies among it, once; nothing before the
        certificate. RuntimeError if the steps are out of order.
        """
        final = self._final
        if self._solved is None:
            raise RuntimeError(_ORDER)
        if final is None or final.depth is not self.depth:
            return
        self._final = None
        if self.depth is Tier.CERTIFIED:
            if self._live is not None:
                self._watch.stage("live preview")
                self._live.result()  # it reads the checks before the certificate
            if self._remedies:
                self._watch.stage("remedies")
                texts = {
                    name: text for part in self._remedies for name, text in part.result().items()
                }
                final = with_changes(final, checks=with_remedies(final.checks, texts))
            if self._shown is not Shown.NONE:
                self._watch.stage("fields")
                write_end_field(self._folder.fields / ENDS, final, self.workers)
            self.workers.dismiss()
            write_judgement(self._folder, final)
        self._judged = judged_of(final, self._statement)

    def _summary(self) -> Mapping[str, object]:
        """Contents of ``run.json`` of this run, with the times up to here."""
        if self._solved is None or self._judged is None:
            raise RuntimeError(_ORDER)
        return {**self._solved, **self._judged, **self._watch.record()}


def run_case(case: Case, out: str | Path, **options: Unpack[RunOptions]) -> Run:
    """Run a case and write its run folder, without pages.

    Parameters
    ----------
    options   see `CaseRun`

    Returns
    -------
    Run    read back from the folder

    Raises
    ------
    CamError
        If the case, a trial or a file cannot be solved, read or written.
    """
    with CaseRun(case, out, **options) as run:
        run.solve()
        run.write()
        run.certify()
        return run.finish()


def _write_live(folder: Path) -> None:
    """Fit and write the live preview of a run; the process that does so imports the screening."""
    from camwright.pipeline.screening.live_preview import live_of, write_live

    write_live(folder, live_of(folder))


def _made(trial: Trial | None) -> Trial:
    """A trial of a step before."""
    if trial is None:
        raise RuntimeError(_ORDER)
    return trial


def restated(statement: str, before: Sequence[str], after: Sequence[str]) -> str:
    """Stopping criterion, completed by failing checks of the final trial that it omits.

    Parameters
    ----------
    before, after : sequence   ids of failing checks, without and with certificate
    """
    further = [name for name in after if name not in before]
    if not further:
        return statement
    return f"{statement}; failing by the certificate: {', '.join(further)}"


def _failing(trial: Trial) -> list[str]:
    return [one.id for one in trial.checks if one.must_have and one.status == "fail"]


def summary_of(
    folder: RunFolder,
    final: Trial,
    points: Sequence[TrialPoint],
) -> SolvedSummary:
    """Part of ``run.json`` that no certificate changes; writes ``1_speed.csv`` as well."""
    case, torque, required = final.case, final.solution.machine.torque, None
    if torque is not None and final.smoothing.strength is not None:
        smoother = Smoother.from_case(case.smoothing, case.period)
        smoother = smoother.stretched(final.smoothing.strength)
        required = required_torque(case, torque, smoother)
    crank_speed, columns = crank_speed_record(final, required)
    if columns is not None:
        folder.write("1_speed.csv", columns)
    return {
        "trials": len(points),
        "final_trial": final.number,
        "trial_points": [point.as_record() for point in points],
        "scope": case.scope_record,
        "headline": headline(final.solution),
        "load_ends": final.load_ends,
        "prices": None if final.synthesis is None else final.synthesis["prices"],
        "machine_prices": None
        if final.synthesis is None
        else final.synthesis.get("machine_prices"),
        "mesh_quality": None if final.mesh is None else quality_record(final.mesh.quality),
        **crank_speed,
        "ripple_map": _ripple_map_record(final),
        "measurement": measurement_record(case),
        "valve_train": valve_record(final),
    }


def _ripple_map_record(final: Trial) -> RippleMapRecord | Refused | None:
    """Ripple map of the final cam; the reason where a working cycle cannot be solved."""
    try:
        rubbing = final.cycles[0].loads.rubbing
        mapped = ripple_map(final.case, final.solution.machines, final.contour.pitch, rubbing)
    except CamError as error:
        return {"refused": str(error)}
    return None if mapped is None else mapped.as_record()


def judged_of(final: Trial, statement: str) -> JudgedSummary:
    """Part of ``run.json`` that follows from checks and certificate."""
    benchmarks = final.solution.benchmarks
    return {
        "depth": final.depth.word,
        "verdict": final.verdict,
        "screen": final.screen,
        "binding": list(final.binding),
        "governing": governing_id(final.checks),
        "statement": statement,
        "benchmarks": None if benchmarks is None else dict(benchmarks),
    }


class Stopwatch:
    """Progress that adds up the time of each stage, s, over all trials.

    Every moment belongs to one stage, the first to `START`, so that the stages sum to the total.

    Parameters
    ----------
    began : float   `time.perf_counter` at the start; None: now
    """

    def __init__(self, progress: Progress, began: float | None = None) -> None:
        """Start the clock of the first stage."""
        self._progress = progress
        self._began = time.perf_counter() if began is None else began
        self._started = utc(time.perf_counter() - self._began)
        self._running, self._since = START, self._began
        self._seconds: dict[str, float] = {}

    def stage(self, name: str) -> None:
        self._close()
        self._running = name.rpartition(": ")[2]
        self._progress.stage(name)

    def advance(self, k: int, total: int) -> None:
        self._progress.advance(k, total)

    def note(self, text: str) -> None:
        self._progress.note(text)

    def read(self) -> dict[str, float]:
        """Time by stage, s, the current one included, and total time, s."""
        self._close()
        times = self._seconds | {"total": self._since - self._began}
        return {name: round(seconds, 3) for name, seconds in times.items()}

    def record(self) -> ClockRecord:
        """Start and times of ``run.json``."""
        return {"started": self._started, "timings_s": self.read()}

    def _close(self) -> None:
        now = time.perf_counter()
        self._seconds[self._running] = self._seconds.get(self._running, 0.0) + now - self._since
        self._since = now
