"""Synthesis of the cam of a case, and the trials until a cam passes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError
from camwright.geometry.follower_path import cam_axes
from camwright.geometry.lift import Lift
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.tables import Table, Tabled, table
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.base.verdict import Verdict, verdict, within_depth
from camwright.pipeline.base.worker_processes import ALONE, Crew
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.given_lift import given_lift, lift_origin
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import FORECAST, checks_of
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.contact_store import NOT_STORED, ContactStore
from camwright.pipeline.cycle.solution import is_body, solution
from camwright.pipeline.preview import preview_case, smoothing_record
from camwright.pipeline.records.trial_contents import SynthesisRecord
from camwright.pipeline.results.run_records import contour_columns, lift_columns
from camwright.pipeline.results.trial import (
    CONSTRAINED,
    GIVEN_LIFT,
    SmoothingRecord,
    Trial,
    TrialPoint,
)
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.fe_correction import (
    Comparison,
    Rank,
    compared,
    corrected,
    design_record,
    rank,
    solved_ripple,
)
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.multistart import Explored, explored
from camwright.pipeline.smoothing.problem_setup import problem_of, roller_problems
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.scenario import redrawn
from camwright.pipeline.smoothing.shadow_prices import limits_in_use, machine_prices
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.smoothing_feedback import Stop, next_smoother
from camwright.pipeline.smoothing.smoothing_forecast import Attempt, Forecast
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem
from camwright.pipeline.solver import solve
from camwright.pipeline.torque.torque import Torque

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FORECAST_POSITIONS = 360
_RESULT: Mapping[Verdict, str] = {
    "pass": "passes every must-have check",
    "incomplete": "fails no must-have check, but data are missing",
    "fail": "fails",
}


@dataclass(frozen=True, eq=False, repr=False)
class Synthesis(Tabled):
    """Cam of a case.

    Parameters
    ----------
    case : Case         with the spring and prime radius of a constrained synthesis
    contour : Contour
    record : mapping    of a constrained synthesis; None without one
    """

    case: Case
    contour: Contour
    record: Mapping[str, Any] | None = None

    @property
    def facts(self) -> Mapping[str, object]:
        """Name of the case, maximum lift, prime radius and pressure angle."""
        pitch = self.contour.pitch
        return {
            "case": self.case.name,
            "lift": shown(pitch.lift.highest.value, "mm"),
            "prime_radius": shown(self.case.cam.prime_radius, "mm"),
            "pressure_angle": shown(pitch.pressure_angle_max().value, "deg"),
        }

    @cached_property
    def table(self) -> Table:
        """The columns of ``2_lift.csv`` and ``3_contour.csv``, in the units of their headers."""
        lift = lift_columns(self.case, self.contour.lift)
        return table(lift | contour_columns(self.case, self.contour))

    def plot(self, *headers: str) -> tuple[Axes, ...]:
        """The contour with its bore; with headers curves, see `Table.plot`."""
        if headers:
            return super().plot(*headers)
        (axes,) = self.contour.plot()
        radius = in_unit(self.case.cam.bore_radius, "mm")
        x, y = cam_axes(np.linspace(0.0, FULL_TURN, 181), np.asarray(radius), 0.0)
        axes.plot(x, y, color="black", label="bore")
        axes.legend(fontsize="small")
        return (axes,)


class Iteration(NamedTuple):
    """Final trial of a run, the stopping criterion in words, and a point of each trial in order."""

    final: Trial
    statement: str
    points: tuple[TrialPoint, ...]


class TrialSink(Protocol):
    """Receives each trial when it is solved."""

    def store(self, number: int) -> ContactStore:
        """Store of the contact solutions of a trial."""
        ...

    def keep(self, trial: Trial) -> None:
        """Keep a solved and checked trial."""
        ...


class NotKept:
    """Sink that discards the trials."""

    def store(self, number: int) -> ContactStore:  # noqa: ARG002
        return NOT_STORED

    def keep(self, trial: Trial) -> None: ...


def synthesize(case: Case, *, progress: Progress = SILENT) -> Synthesis:
    """Cam of a case: torque, lift, contour.

    The smoother is that of the case; `run_case` widens it until the cam passes. A constrained
    synthesis minimises the ripple within all limits, corrected by previews.

    Raises
    ------
    CamError
        If the case has no such cam.
    """
    if case.smoothing.kind == "constrained":
        trial = preview_case(case, progress=progress)
        return Synthesis(trial.case, trial.contour, trial.synthesis)
    lift = cam_lift(case, engine_torques(case))
    return Synthesis(case, case.contour(lift))


def trials_of(
    case: Case,
    torques: Mapping[str, Torque],
    *,
    tier: Tier = Tier.CYCLE,
    sink: TrialSink | None = None,
    progress: Progress = SILENT,
    workers: Crew = ALONE,
    on_final: Callable[[Trial], object] = lambda _: None,
) -> Iteration:
    """Trials until one passes the checks of its tier or no better one is forecast.

    Parameters
    ----------
    torques : mapping    engine torque by load case
    tier : Tier          depth of the trials, at most CYCLE: the last one alone is certified
    sink : TrialSink     receives each trial when it is solved
    workers : Crew       processes for tolerance corners and forecasts
    on_final : callable  called with the final trial, before its files are written

    Raises
    ------
    CamError
        If a trial cannot be solved.
    """
    depth = min(tier, Tier.CYCLE)
    task = _Task(case, torques, depth, sink or NotKept(), progress, workers, on_final)
    if case.smoothing.kind == "constrained":
        return _constrained(task)
    if not case.balances:
        trial = task.solved(1, case, given_lift(case), lift_origin(case), GIVEN_LIFT)
        reason = f"prescribed lift: {_result(trial)}, not smoothed"
        task.on_final(trial)
        task.sink.keep(trial)
        return Iteration(trial, reason, (TrialPoint.of(trial),))
    return _smoothed(task)


def solved_already(trial: Trial, sink: TrialSink, on_final: Callable[[Trial], object]) -> Iteration:
    """Iteration of one trial that is solved; sink, on_final: as of `trials_of`."""
    on_final(trial)
    sink.keep(trial)
    return Iteration(trial, f"one trial, {_result(trial)}", (TrialPoint.of(trial),))


@dataclass(frozen=True, eq=False)
class _Task:
    """Input common to all trials of a case."""

    case: Case
    torques: Mapping[str, Torque]
    tier: Tier
    sink: TrialSink
    progress: Progress
    workers: Crew
    on_final: Callable[[Trial], object]

    def solved(
        self,
        number: int,
        case: Case,
        lift: Lift,
        why: str,
        smoothing: SmoothingRecord,
        synthesis: SynthesisRecord | None = None,
        uses: tuple[Array, Mapping[str, Array]] | None = None,
        gain: float | None = None,
    ) -> Trial:
        """Trial of a lift; uses: see `Trial.limits_in_use`."""
        self.progress.stage(f"trial {number}: lift and contour")
        trial = solve(
            case,
            case.contour(lift),
            tier=self.tier,
            torques=self.torques,
            synthesis_gain=gain,
            store=self.sink.store(number),
            workers=self.workers,
            progress=_Prefixed(self.progress, f"trial {number}: "),
        )
        return replace(
            trial,
            number=number,
            why=why,
            smoothing=smoothing,
            synthesis=synthesis,
            limits_in_use=uses,
        )


def _smoothed(task: _Task) -> Iteration:
    """Trials of ever wider smoothers."""
    case, torques = task.case, task.torques
    forecast = _forecast_of(task)
    smoother, why = Smoother.from_case(case.smoothing, case.period), "smoother of the case"
    attempts: list[Attempt] = []
    points: list[TrialPoint] = []
    while True:
        lift = cam_lift(case, torques, smoother)
        record = smoothing_record(smoother)
        trial = task.solved(len(attempts) + 1, case, lift, why, record)
        points.append(TrialPoint.of(trial))
        attempts.append(Attempt(smoother, within_depth(trial.checks)))
        after = next_smoother(attempts, case.solver.max_trials, forecast)
        if isinstance(after, Stop):
            task.on_final(trial)
        task.sink.keep(trial)
        if isinstance(after, Stop):
            return Iteration(trial, after.reason, tuple(points))
        del trial  # its solution takes most of the memory
        task.progress.note(f"trial {len(attempts)} fails: {after.why}")
        smoother, why = after.smoother, after.why


def _forecast_of(task: _Task) -> Forecast:
    """Forecast in the worker processes; of each smoother once."""
    known: dict[Smoother, tuple[Check, ...]] = {}

    def forecast(smoothers: Sequence[Smoother]) -> list[tuple[Check, ...]]:
        left = [each for each in dict.fromkeys(smoothers) if each not in known]
        count = task.workers.workers
        parts = [part for part in (left[k::count] for k in range(count)) if part]
        tasks = [task.workers.submit(forecasts, task.case, task.torques, part) for part in parts]
        for part, begun in zip(parts, tasks, strict=True):
            known.update(zip(part, begun.result(), strict=True))
        return [known[each] for each in smoothers]

    return forecast


def forecasts(
    case: Case, torques: Mapping[str, Torque], smoothers: Sequence[Smoother]
) -> list[tuple[Check, ...]]:
    """Quick checks of the cam of each smoother, by a coarse preview; none where no cam exists."""
    made: list[tuple[Check, ...]] = []
    for smoother in smoothers:
        try:
            contour = case.contour(cam_lift(case, torques, smoother))
            checks: tuple[Check, ...] = ()
            if is_body(contour):
                solved = solution(
                    case, contour, torques=torques, tier=Tier.PREVIEW,
                    positions=FORECAST_POSITIONS, coarse=True,
                )  # fmt: skip
                checks = checks_of(solved, FORECAST)
        except CamError:
            checks = ()
        made.append(checks)
    return made


def _constrained(task: _Task) -> Iteration:
    """Synthesis and finite elements in turn, until they agree; the best trial is the final one."""
    case, torques = task.case, task.torques
    problem, margin = problem_of(case, torques), case.smoothing.correction_margin
    why = "least ripple within all limits"
    first: Explored | None = None
    comparisons: list[Comparison] = []
    points: list[TrialPoint] = []
    best: tuple[Rank, Trial] | None = None
    # Without corrections the synthesis sees lower bounds: limits that conflict there conflict.
    conflicts = False
    while True:
        number = len(points) + 1
        task.progress.stage(f"trial {number}: synthesis")
        if number > 1:  # starts from the optimum of the trial before
            design = synthesise(problem)
        else:
            first = explored(problem, case.smoothing.starts)
            design, problem = first.design, replace(problem, coefficients=first.splines)
            conflicts = not design.feasible
            if task.tier is Tier.CYCLE and not conflicts:
                problem = _with_guides(task, problem, design)
                design = synthesise(problem)
        record = design_record(design, problem, first if number == 1 else None)
        record["machine_prices"] = machine_prices(design, problem, case, torques)
        trial = task.solved(
            number,
            redrawn(case, design.variables),
            design.lift(),
            why,
            CONSTRAINED,
            synthesis=record,
            uses=limits_in_use(design),
            gain=design.ripple_gain,
        )
        judged = trial.checks if margin > 0.0 else ()
        comparisons.append(compared(problem, design, trial.solution, judged))
        unmeshed = task.tier is Tier.CYCLE and trial.mesh is None
        ends = conflicts or unmeshed or comparisons[-1].settled
        last = ends or number == case.solver.max_trials
        conflict = None
        if last and not design.feasible:
            task.progress.stage("conflicting limits")
            after = corrected(problem, design, comparisons) if margin > 0.0 else problem
            rollers = roller_problems(case, torques, after)
            conflict = infeasibility(problem, rollers, after, margin)
            record["infeasible"] = conflict.as_record()
        ranked = rank(trial.checks, solved_ripple(trial.cycles))
        if best is None or ranked <= best[0]:
            best = (ranked, trial)
        if last:
            task.on_final(best[1])
        task.sink.keep(trial)
        points.append(TrialPoint.of(trial))
        if last:
            final = best[1]
            parts = [_ending(final, number, comparisons[-1], settled=ends or comparisons[-1].agree)]
            parts += [] if conflict is None else [conflict.sentence]
            if first is not None and conflict is None:
                parts += [first.starts.sentence, first.resolution.sentence]
            return Iteration(final, "; ".join(parts), tuple(points))
        del trial  # its solution takes most of the memory
        why = comparisons[-1].sentence
        task.progress.note(f"trial {number}: {why}")
        problem = corrected(problem, design, comparisons)


def _with_guides(task: _Task, problem: Problem, design: Design) -> Problem:
    """The problem corrected by a preview of its design: guides of finite length, Hertz contact."""
    task.progress.stage("trial 1: preview")
    drawn = redrawn(task.case, design.variables)
    contour = drawn.contour(design.lift())
    solved = solution(drawn, contour, Tier.PREVIEW, torques=task.torques)
    return corrected(problem, design, [compared(problem, design, solved)])


def _ending(final: Trial, count: int, latest: Comparison, *, settled: bool) -> str:
    """Result of the final trial and the reason for the end of the trials, in words."""
    chosen = f"trial {final.number} {_result(final)}"
    if final.number < count:
        chosen += f"; it is the best of {count} trials"
    reason = latest.sentence if settled else f"the trials do not settle: {latest.sentence}"
    return f"{chosen}; {reason}"


def _result(trial: Trial) -> str:
    """Result of the checks that the depth of a trial judges, in words."""
    return _RESULT[verdict(within_depth(trial.checks))]


@dataclass(frozen=True)
class _Prefixed:
    """Progress whose stages have a common prefix."""

    progress: Progress
    prefix: str

    def stage(self, name: str) -> None:
        self.progress.stage(self.prefix + name)

    def advance(self, k: int, total: int) -> None:
        self.progress.advance(k, total)

    def note(self, text: str) -> None:
        self.progress.note(text)
