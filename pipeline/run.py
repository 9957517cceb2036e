"""Run of a case: trials, certificate, tolerance corners, run folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from dataclasses import replace as with_changes
from pathlib import Path
from typing import Any

from camwright.geometry.errors import CamError
from camwright.pipeline.base.progress import SILENT, Progress, utc
from camwright.pipeline.base.source import old_words
from camwright.pipeline.base.verdict import governing_id
from camwright.pipeline.base.worker_processes import ALONE, Crew, PendingCall, crew
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
from camwright.pipeline.iteration import solved_already, trials_of
from camwright.pipeline.remedies.remedy_search import order_of, texts_of, with_remedies
from camwright.pipeline.results.field_output import ENDS, Shown, write_end_field, write_fields
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_reader import Run, read_run
from camwright.pipeline.results.run_records import crank_speed_record, headline, torque_columns
from camwright.pipeline.results.trial import Trial, TrialPoint
from camwright.pipeline.results.trial_writer import TrialWriter
from camwright.pipeline.results.workshop_files import WORKSHOP, write_workshop
from camwright.pipeline.smoothing.required_lift import required_torque
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import certify_trial
from camwright.pipeline.torque.torque import Torque

START = "start"
"""Stage before the first: start of the program, imports, case file."""


def run_case(
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
    report: Callable[[Path], object] | None = None,
    ahead: Callable[[Path, Crew], object] | None = None,
    also: Callable[[Trial], Mapping[str, Any]] = lambda _: {},
    judged: Callable[[Mapping[str, Torque], Trial], object] = lambda *_: None,
    solved: Trial | None = None,
) -> Run:
    """Trials of a case until a cam passes or the limit that binds is named; writes the run folder.

    Parameters
    ----------
    depth : Tier         of the solution; below CERTIFIED the run has no verdict
    positions : int      per cam turn; None: those of the case
    jobs : int           processes for the certificate; None: number of processors, at most 4
    resume : bool        continue an interrupted run
    replace : bool       take the place of a run of an earlier version of the case
    fields : Shown       cam angles of the stress field
    began : float        `time.perf_counter` at the start of the program, for the times of the
                         stages; None: now
    report : callable    writes page and pictures into the run folder; None: none are written
    ahead : callable     begins pictures in the worker processes before the certificate
    also : callable      final trial -> further entries of ``run.json``
    judged : callable    receives engine torques and checked final trial; below CERTIFIED before
                         its files are written
    solved : Trial       the only trial, solved at `depth` below CERTIFIED; None: it is solved here

    Returns
    -------
    Run    read back from the folder

    Raises
    ------
    CamError
        If the case, a trial or a file cannot be solved, read or written.
    """
    out = Path(out)
    case = case if positions is None else case.with_positions(positions)
    with (
        refused_as_written(case),
        RunFolder(out, case, depth=depth, resume=resume, replace=replace) as folder,
        crew(jobs) as workers,
    ):
        watch = Stopwatch(progress, began)
        summary = _solved(folder, case, depth, workers, fields, watch, also, ahead, judged, solved)
        if report is not None:
            watch.stage("report")  # the solution, which takes most of the memory, is released
            folder.write_summary(summary | watch.record())
            report(folder.path)
        folder.finish(summary | watch.record())
    return read_run(out)


def _solved(
    folder: RunFolder,
    case: Case,
    depth: Tier,
    workers: Crew,
    fields: Shown,
    watch: Stopwatch,
    also: Callable[[Trial], Mapping[str, Any]],
    ahead: Callable[[Path, Crew], object] | None,
    judged: Callable[[Mapping[str, Torque], Trial], object],
    solved: Trial | None,
) -> dict[str, Any]:
    """Solve a case and write all files but report and records; the contents of ``run.json``."""
    watch.stage("torque")
    if depth is Tier.CERTIFIED:
        workers.prepare(order_of.__module__)
    torques = engine_torques(case)
    for words in (
        *old_words(case.written.tables),
        *(one.how for one in implausible(case, torques)),
    ):
        watch.note(f"warning: {words}")
    for line in measurement_words(case):
        watch.note(line)
    if torques:
        folder.write_torque(torque_columns(torques[case.load_cases[0].name]))
    writer = TrialWriter(folder)
    sought: list[PendingCall] = []

    def on_final(trial: Trial) -> None:
        if depth is Tier.CERTIFIED:
            sought.extend(_remedies_begun(trial, workers, folder.path))
        else:
            judged(torques, trial)

    if solved is None:
        final, statement, points = trials_of(
            case,
            torques,
            tier=depth,
            sink=writer,
            progress=watch,
            workers=workers if depth is Tier.CERTIFIED else ALONE,
            on_final=on_final,
        )
    else:
        final, statement, points = solved_already(solved, writer, on_final)
    if final.corners:
        folder.write_corners(corners_record(final.case, final.corners))
    summary = summary_of(folder, torques, final, points) | dict(also(final))

    if depth >= Tier.CYCLE:
        watch.stage("fields")
        write_fields(folder.fields, final, fields, watch.advance)
    if final.mesh is not None:  # else the contour is no body to machine
        watch.stage(WORKSHOP)
        write_workshop(folder.path / WORKSHOP, final.case, final.contour, note=watch.note)
    if depth < Tier.CERTIFIED:
        return summary | judged_of(final, statement)
    if ahead is not None:
        watch.stage("report")
        folder.write_summary(summary | judged_of(final, statement) | watch.record())
        ahead(folder.path, workers)
    failing = _failing(final)
    certified = certify_trial(final, workers, store=writer.store(final.number), progress=watch)
    judged(torques, certified)
    if sought:
        watch.stage("remedies")
        texts = {name: text for part in sought for name, text in part.result().items()}
        certified = with_changes(certified, checks=with_remedies(certified.checks, texts))
    if fields is not Shown.NONE:
        watch.stage("fields")
        write_end_field(folder.fields / ENDS, certified, workers)
    workers.dismiss()
    writer.judge(certified)
    return summary | judged_of(certified, restated(statement, failing, _failing(certified)))


def _remedies_begun(final: Trial, workers: Crew, folder: Path) -> list[PendingCall]:
    """Search of the remedies of a final trial in worker processes; empty if no check fails."""
    return [workers.submit(texts_of, part) for part in order_of(final, folder).parts]


def restated(statement: str, before: Sequence[str], after: Sequence[str]) -> str:
    """Stopping criterion, and the failing checks of the final trial that it does not know.

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
    torques: Mapping[str, Torque],
    final: Trial,
    points: Sequence[TrialPoint],
) -> dict[str, Any]:
    """Contents of ``run.json`` that no certificate changes; writes ``1_speed.csv``."""
    case, required = final.case, None
    if final.smoothing.strength is not None:
        smoother = Smoother.from_case(case.smoothing, case.period)
        smoother = smoother.stretched(final.smoothing.strength)
        required = required_torque(case, torques[case.load_cases[0].name], smoother)
    crank_speed, columns = crank_speed_record(torques, final, required)
    if columns is not None:
        folder.write_speed(columns)
    return {
        "trials": len(points),
        "final_trial": final.number,
        "trial_points": [point.as_record() for point in points],
        "scope": case.scope.as_record(),
        "headline": headline(torques, final),
        "load_ends": final.load_ends,
        "prices": None if final.synthesis is None else final.synthesis["prices"],
        "machine_prices": None
        if final.synthesis is None
        else final.synthesis.get("machine_prices"),
        "mesh_quality": None if final.mesh is None else asdict(final.mesh.quality),
        **crank_speed,
        "ripple_map": _ripple_map_record(torques, final),
        "measurement": measurement_record(case),
    }


def _ripple_map_record(torques: Mapping[str, Torque], final: Trial) -> Mapping[str, Any] | None:
    """Ripple map of the final cam; the reason where a working cycle cannot be solved."""
    try:
        mapped = ripple_map(final.case, torques, final.contour.pitch, final.cycles[0].loads.rubbing)
    except CamError as error:
        return {"refused": str(error)}
    return None if mapped is None else mapped.as_record()


def judged_of(final: Trial, statement: str) -> dict[str, Any]:
    """Contents of ``run.json`` that follow from the checks and the certificate."""
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
    """Progress that sums the time of each stage, s, over all trials.

    Every moment belongs to one stage, the first to `START`, so that the stages sum to the total.

    Parameters
    ----------
    began : float   `time.perf_counter` at the start; None: now
    """

    def __init__(self, progress: Progress, began: float | None = None) -> None:
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
        """Time by stage, the current one included, and total, s."""
        self._close()
        times = self._seconds | {"total": self._since - self._began}
        return {name: round(seconds, 3) for name, seconds in times.items()}

    def record(self) -> dict[str, str | dict[str, float]]:
        """Start and times of ``run.json``."""
        return {"started": self._started, "timings_s": self.read()}

    def _close(self) -> None:
        now = time.perf_counter()
        self._seconds[self._running] = self._seconds.get(self._running, 0.0) + now - self._since
        self._since = now
