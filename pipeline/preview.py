"""Preview of a case: torque, lift, contour, loads and guides as in a run, Hertz contact."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.lift import Lift
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import refused_as_written
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.check import depends_on_lift
from camwright.pipeline.checks.registry import DECLARED, checks_of
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.results.trial import CONSTRAINED, GIVEN_LIFT, SmoothingRecord, Trial
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.scenario import DesignVariables, redrawn
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import CHECKS, checked, judged_at_corners, solve
from camwright.pipeline.torque.torque import Torque

if TYPE_CHECKING:
    from camwright.pipeline.records.trial_contents import SynthesisRecord

_CONVERGENCE = 2.0  # of a preview over that of a run
_PREVIEW_ROUNDS = 3  # of synthesis and correction
_MOST_ROUNDS = 6  # of them, where each brings a cam that exceeds a limit nearer to it
_NEARER = 0.7  # of the excess of the round before: most that counts as nearer
_ENDED_ROUNDS = 2  # of them, where the effort ends the search
_ENDED = "the preview ends the search for the cam before it has converged; a run goes on"
_EFFORT = 16  # tried steps of a search: most need fewer


def preview_case(
    case: Case,
    *,
    corners: bool = True,
    kept: bool = False,
    progress: Progress = SILENT,
    torques: Mapping[str, Torque] | None = None,
    nominal: Callable[[Trial], None] = lambda _: None,
) -> Trial:
    """Trial of a case with Hertz contact in closed form; no sign-off.

    A constrained synthesis is corrected for length and clearance of the guides until no
    utilisation above one half changes.

    Parameters
    ----------
    corners : bool   judge each check at its worst tolerance corner
    kept : bool      read the cam of a constrained synthesis from the disk cache, where an earlier
                     preview of the same case by the same program has kept it
    torques : mapping    engine torque by load case; None: computed from the case
    nominal : callable   takes the trial before it is judged at the corners

    Returns
    -------
    Trial   without a verdict; its checks by finite elements are not evaluated

    Raises
    ------
    CamError
        If the case has no such cam.
    """
    with refused_as_written(case):
        known = engine_torques(case) if torques is None else torques
        trial = _nominal(case, known, kept, progress)
        nominal(trial)
        return judged_at_corners(trial) if corners else trial


def _nominal(case: Case, torques: Mapping[str, Torque], kept: bool, progress: Progress) -> Trial:
    """Trial of a case at preview depth without tolerance corners; kept : take the cam of a
    synthesis from the disk cache.
    """
    if case.smoothing.kind != "constrained":
        contour = case.contour(cam_lift(case, torques))
        trial = solve(
            case, contour, tier=Tier.PREVIEW, torques=torques, corners=False, progress=progress
        )
        smoother = Smoother.from_case(case.smoothing, case.period) if case.balances else None
        return replace(trial, smoothing=smoothing_record(smoother))
    made = _kept if kept else _synthesised
    return made(case, torques, progress)


def _kept(case: Case, torques: Mapping[str, Torque], progress: Progress) -> Trial:
    """Trial of the constrained synthesis, whose cam is taken from the disk cache where it is there;
    loads and checks are solved again.
    """
    solved: list[Trial] = []

    def compute() -> disk_cache.Arrays:
        """Arrays of the cam of a new synthesis for the disk cache: spring rate, N/m, preload, N,
        prime radius, m, lift, gain and record.
        """
        trial = _synthesised(case, torques, progress)
        solved.append(trial)
        spring, lift = trial.case.spring, trial.contour.pitch.lift
        gain = trial.solution.synthesis_gain
        drawn = spring.rate, spring.preload, trial.case.cam.prime_radius
        return {
            "variables": np.array(drawn),
            "theta": lift.theta,
            "lift": lift.values,
            "gain": np.array(np.nan if gain is None else gain),
            "record": np.frombuffer(json.dumps(trial.synthesis).encode(), dtype=np.uint8),
        }

    inputs = case.sha256, tuple(versions().items())
    cam = disk_cache.kept("synthesis", inputs, compute, ())
    if solved:
        return solved[0]
    drawn = redrawn(case, DesignVariables(*cam["variables"].tolist()))
    record = json.loads(cam["record"].tobytes())
    lift, gain = Lift(cam["theta"], cam["lift"]), float(cam["gain"])
    again = _solved(drawn, lift, None if np.isnan(gain) else gain, torques, progress)
    return _trial_of(again, record, progress)


def _solved(
    drawn: Case,
    lift: Lift,
    gain: float | None,
    torques: Mapping[str, Torque],
    progress: Progress,
) -> Solution:
    """Cam of a synthesis by closed forms."""
    solved = solution(drawn, drawn.contour(lift), Tier.PREVIEW, torques=torques, progress=progress)
    return replace(solved, synthesis_gain=gain)


def _trial_of(solved: Solution, record: SynthesisRecord, progress: Progress) -> Trial:
    """Trial of the cam of a synthesis, without tolerance corners."""
    if record.get("ended"):
        progress.note(_ENDED)
    progress.stage(CHECKS)
    return replace(checked(solved), smoothing=CONSTRAINED, synthesis=record)


def _synthesised(case: Case, torques: Mapping[str, Torque], progress: Progress) -> Trial:
    """Trial of the constrained synthesis, without tolerance corners.

    A search that has not converged after `_EFFORT` ends, as a note tells: a run goes on.
    """
    # Most previews need no optimiser.
    from camwright.pipeline.smoothing.fe_correction import design_record, rank, solved_ripple
    from camwright.pipeline.smoothing.problem_setup import problem_of
    from camwright.pipeline.smoothing.synthesis_rounds import rounds

    problem = replace(problem_of(case, torques), effort=_EFFORT)
    if problem.convergence is not None:
        problem = replace(problem, convergence=_CONVERGENCE * problem.convergence)
    tried: list[tuple[Solution, SynthesisRecord]] = []
    excess = 0.0
    for each in rounds(problem, late=True):
        design = each.design
        drawn, gain = redrawn(case, design.variables), design.ripple_gain
        solved = _solved(drawn, design.lift(), None if design.ended else gain, torques, progress)
        tried.append((solved, design_record(design, each.problem)))
        if not design.feasible and len(tried) == 1:
            break
        comparison, before = each.compare(solved), excess
        settled, excess = comparison.settled, comparison.excess
        # After a search that its effort has ended, corrections do not settle.
        most = _ENDED_ROUNDS if design.ended else _PREVIEW_ROUNDS
        nearer = 0.0 < excess <= _NEARER * before and not design.ended
        over = each.number >= (_MOST_ROUNDS if nearer else most)
        if not design.feasible or over or (settled and not each.rises):
            break
    if len(tried) == 1 or settled:
        return _trial_of(*tried[-1], progress)
    ranking = [each for each in DECLARED.values() if each.must_have and depends_on_lift(each)]
    ranks = [rank(checks_of(each, ranking), solved_ripple(each.cycles)) for each, _ in tried]
    best = max(k for k, each in enumerate(ranks) if each == min(ranks))
    return _trial_of(*tried[best], progress)


def smoothing_record(smoother: Smoother | None) -> SmoothingRecord:
    """Record of a smoother; for None of a lift in the case file."""
    if smoother is None:
        return GIVEN_LIFT
    return SmoothingRecord(
        smoother.kind, smoother.width_in_words, smoother.strength, smoother.angular_width
    )
