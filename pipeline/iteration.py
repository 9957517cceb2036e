"""Trials of a case until a cam passes; synthesis of its cam."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError
from camwright.geometry.figures import Curve, DrawnAxes, plotted
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
from camwright.pipeline.cycle.solution import Solution, is_body, solution
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
from camwright.pipeline.smoothing.fe_correction import (
    Comparison,
    Rank,
    design_record,
    rank,
    solved_ripple,
)
from camwright.pipeline.smoothing.infeasibility import infeasibility
from camwright.pipeline.smoothing.problem_setup import problem_of, roller_problems
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.scenario import redrawn
from camwright.pipeline.smoothing.shadow_prices import limits_in_use, machine_prices
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.smoothing_feedback import Stop, next_smoother
from camwright.pipeline.smoothing.smoothing_forecast import Attempt, Forecast
from camwright.pipeline.smoothing.synthesis_problem import Design
from camwright.pipeline.smoothing.synthesis_rounds import rounds
from camwright.pipeline.solver import solve
from camwright.pipeline.torque.torque import Torque

FORECAST_POSITIONS = 360
_RESULT: Mapping[Verdict, str] = {
    "pass": "passes every must-have check",
    "incomplete": "fails no must-have check, but data are missing",
    "fail": "fails",
}


@dataclass(frozen=True, eq=False, repr=False)
class Synthesis(Tabled):
    """Cam of a case: contour, drawn case, record of a constrained synthesis.

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

    def plot(self, *headers: str) -> DrawnAxes:
        """Figure of the contour with its bore; with headers, curves as of `Table.plot`."""
        if headers:
            return super().plot(*headers)
        radius = in_unit(self.case.cam.bore_radius, "mm")
        x, y = cam_axes(np.linspace(0.0, FULL_TURN, 181), np.asarray(radius), 0.0)
        return plotted(self.contour.figure(Curve(x, y, "bore", "ink")))


class Iteration(NamedTuple):
    """Final trial of a run, the stopping criterion in words, and a point of each trial in order."""

    final: Trial
    statement: str
    points: tuple[TrialPoint, ...]


class Tried(NamedTuple):
    """Solved trial, with the whole iteration if it is the last; else None."""

    trial: Trial
    iteration: Iteration | None


def synthesize(case: Case, *, progress: Progress = SILENT) -> Synthesis:
    """Cam of a case: lift from the smoothed torque or as stated, or by a constrained synthesis, and
    its contour.

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


def trials(
    case: Case,
    torques: Mapping[str, Torque],
    *,
    tier: Tier = Tier.CYCLE,
    stores: Callable[[int], ContactStore] = lambda _: NOT_STORED,
    progress: Progress = SILENT,
    workers: Crew = ALONE,
) -> Iterator[Tried]:
    """Trials until one passes the checks of its tier, or no better one is forecast.

    Only one solution is in memory at a time, and the best of a constrained synthesis, if the caller
    holds no trial while the next is solved.

    Parameters
    ----------
    torques : mapping    engine torque by load case
    tier : Tier          depth of the trials, at most CYCLE: the last one alone is certified
    stores : callable    number of a trial -> store of its contact solutions
    workers : Crew       processes for tolerance corners and forecasts

    Raises
    ------
    CamError
        If a trial cannot be solved.
    """
    task = _Task(case, torques, min(tier, Tier.CYCLE), stores, progress, workers)
    if case.smoothing.kind == "constrained":
        return _constrained(task)
    return _smoothed(task) if case.balances else _prescribed(task)


def trials_of(case: Case, torques: Mapping[str, Torque], *, tier: Tier = Tier.CYCLE) -> Iteration:
    """Final trial and statement of the trials of a case; see `trials`."""
    made = trials(case, torques, tier=tier)
    while True:
        trial, iteration = next(made)
        if iteration is not None:
            return iteration
        del trial  # its solution takes most of the memory


def solved_already(trial: Trial) -> Iteration:
    """Iteration that consists of one trial, already solved."""
    return _alone(trial, f"one trial, {_result(trial)}")


def _alone(trial: Trial, statement: str) -> Iteration:
    return Iteration(trial, statement, (TrialPoint.of(trial),))


@dataclass(frozen=True, eq=False)
class _Task:
    """Input common to all trials of a case."""

    case: Case
    torques: Mapping[str, Torque]
    tier: Tier
    stores: Callable[[int], ContactStore]
    progress: Progress
    workers: Crew

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
            store=self.stores(number),
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

    def previewed(self, design: Design) -> Solution:
        """Preview of a design: guides of finite length, Hertz contact."""
        drawn = redrawn(self.case, design.variables)
        contour = drawn.contour(design.lift())
        return solution(drawn, contour, Tier.PREVIEW, torques=self.torques)


def _prescribed(task: _Task) -> Iterator[Tried]:
    """The trial of a lift in the case file."""
    case = task.case
    trial = task.solved(1, case, given_lift(case), lift_origin(case), GIVEN_LIFT)
    yield Tried(trial, _alone(trial, f"prescribed lift: {_result(trial)}, not smoothed"))


def _smoothed(task: _Task) -> Iterator[Tried]:
    """Trials of ever wider smoothers of the torque, until a cam passes or the trials end; the last
    has the whole iteration.
    """
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
            yield Tried(trial, Iteration(trial, after.reason, tuple(points)))
            return
        yield Tried(trial, None)
        del trial  # its solution takes most of the memory
        task.progress.note(f"trial {len(attempts)} fails: {after.why}")
        smoother, why = after.smoother, after.why


def _forecast_of(task: _Task) -> Forecast:
    """Function that gives the checks of the cams of some smoothers, each computed once in the
    worker processes.
    """
    known: dict[Smoother, tuple[Check, ...]] = {}

    def forecast(smoothers: Sequence[Smoother]) -> list[tuple[Check, ...]]:
        """Checks of the cams of smoothers in their order; those that are not known yet are computed
        in the worker processes.
        """
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
    """Checks by a coarse preview of the cam of each smoother, in their order; an empty tuple where
    no cam exists.
    """
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


def _constrained(task: _Task) -> Iterator[Tried]:
    """Trials of a constrained synthesis, whose limits are corrected by the finite elements of each,
    until both agree; the last has the iteration with the best as final trial.
    """
    case, torques = task.case, task.torques
    margin, why = case.smoothing.correction_margin, "least ripple within all limits"
    points: list[TrialPoint] = []
    best: Rank | None = None
    for each in rounds(
        problem_of(case, torques),
        starts=case.smoothing.starts,
        guided=task.previewed if task.tier is Tier.CYCLE else None,
        progress=task.progress,
    ):
        number, problem, design = each.number, each.problem, each.design
        record = design_record(design, problem, each.first if number == 1 else None)
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
        comparison = each.compare(trial.solution, trial.checks if margin > 0.0 else ())
        unmeshed = task.tier is Tier.CYCLE and trial.mesh is None
        ends = each.conflicts or unmeshed or comparison.settled
        last = ends or number == case.solver.max_trials
        conflict = None
        if last and not design.feasible:
            task.progress.stage("conflicting limits")
            after = each.corrected() if margin > 0.0 else problem
            rollers = roller_problems(case, torques, after)
            conflict = infeasibility(problem, rollers, after, margin)
            record["infeasible"] = conflict.as_record()
        ranked = rank(trial.checks, solved_ripple(trial.cycles))
        if best is None or ranked <= best:
            best, final = ranked, trial
        points.append(TrialPoint.of(trial))
        if last:
            parts = [_ending(final, number, comparison, settled=ends or comparison.agree)]
            if conflict is None:
                parts += [each.first.starts.sentence, each.first.resolution.sentence]
            else:
                parts.append(conflict.sentence)
            yield Tried(trial, Iteration(final, "; ".join(parts), tuple(points)))
            return
        yield Tried(trial, None)
        del trial  # its solution takes most of the memory
        why = comparison.sentence
        task.progress.note(f"trial {number}: {why}")


def _ending(final: Trial, count: int, latest: Comparison, *, settled: bool) -> str:
    """Sentence on the final trial and on the reason for the end of the trials; count : number of
    trials.
    """
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
