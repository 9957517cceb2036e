"""Solution and checks of a cam contour, without file output."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import replace

from camwright.geometry.contour import Contour
from camwright.geometry.track_deviation import EXACT, TrackDeviation
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.verdict import in_order
from camwright.pipeline.base.worker_processes import Crew, PendingCall, crew
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import all_checks
from camwright.pipeline.checks.tolerance_corners import Outcome, governed, outcomes, unsolved
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.contact_store import NOT_STORED, ContactStore
from camwright.pipeline.cycle.solution import (
    Solution,
    certified_solution,
    solution,
)
from camwright.pipeline.results.trial import GIVEN_LIFT, Trial
from camwright.pipeline.torque.torque import Torque

CHECKS = "checks"


def solve(
    case: Case,
    contour: Contour,
    *,
    tier: Tier = Tier.CERTIFIED,
    torques: Mapping[str, Torque] | None = None,
    positions: int | None = None,
    corners: bool = True,
    synthesis_gain: float | None = None,
    deviation: TrackDeviation = EXACT,
    store: ContactStore = NOT_STORED,
    progress: Progress = SILENT,
    jobs: int | None = 1,
    workers: Crew | None = None,
) -> Trial:
    """Trial: solution of a cam in every load case, with its checks.

    Parameters
    ----------
    case : Case
    contour : Contour     of the cam, such as from `synthesize`
    tier : Tier           depth of the solution
    torques : mapping     engine torque by load case; None: computed from the case
    positions : int       per cam turn; None: those of the case
    corners : bool        judge each check at its worst tolerance corner; not in a screening
    synthesis_gain : float   see `Solution`
    deviation : TrackDeviation   of measured tracks
    store : ContactStore  of partial contact solutions, to resume an interrupted run
    progress : Progress
    jobs : int            processes for corners and certificate; None: one a processor, at most 4
    workers : Crew        processes in their place that are running; None: start `jobs`

    Returns
    -------
    Trial

    Raises
    ------
    CamError
        If the loads, a mesh or the contact cannot be solved.
    """
    known = engine_torques(case) if torques is None else torques
    with crew(jobs) if workers is None else nullcontext(workers) as hands:
        tried: PendingCall | None = None
        if corners and tier > Tier.SCREENING:
            tried = hands.submit(outcomes, case, machines(case, known, deviation), contour)
        solved = solution(
            case,
            contour,
            min(tier, Tier.CYCLE),
            torques=known,
            positions=positions,
            deviation=deviation,
            store=store,
            progress=progress,
        )
        solved = replace(solved, synthesis_gain=synthesis_gain)
        if tier is Tier.CERTIFIED:
            solved = certified_solution(solved, hands, progress=progress)
        progress.stage(CHECKS)
        trial = checked(solved)
        return trial if tried is None else _at_corners(trial, tried.result())


def checked(solved: Solution) -> Trial:
    """Trial of a solution with its nominal checks."""
    return Trial(1, "", GIVEN_LIFT, solved, all_checks(solved))


def judged_at_corners(trial: Trial) -> Trial:
    """Trial with checks judged at their worst tolerance corners."""
    return _at_corners(trial, outcomes(trial.case, trial.solution.machines, trial.contour))


def _at_corners(trial: Trial, tried: tuple[Outcome, ...]) -> Trial:
    return replace(trial, corners=tried, checks=_judged(trial.checks, trial.solution, tried))


def certify_trial(
    trial: Trial,
    workers: Crew,
    *,
    store: ContactStore = NOT_STORED,
    progress: Progress = SILENT,
) -> Trial:
    """Trial with its certificate, its checks made again; see `certified_solution`."""
    solved = certified_solution(trial.solution, workers, store=store, progress=progress)
    return replace(
        trial, solution=solved, checks=_judged(all_checks(solved), solved, trial.corners)
    )


def _judged(
    checks: tuple[Check, ...], solved: Solution, tried: tuple[Outcome, ...]
) -> tuple[Check, ...]:
    """Checks of a solution at the worst corners tried; nominal without corners."""
    if not tried:
        return checks
    return in_order((*governed(checks, tried), unsolved(solved.machine, tried)))
