"""Preview of a case: torque, lift, contour, loads and guides as in a run; Hertz contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import refused_as_written
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.trial import CONSTRAINED, GIVEN_LIFT, SmoothingRecord, Trial
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.solver import judged_at_corners, solve
from camwright.pipeline.torque.torque import Torque

_ROUNDS = 4  # of synthesis and correction


def preview_case(case: Case, *, corners: bool = True, progress: Progress = SILENT) -> Trial:
    """Cam of a case with the contact by closed forms; no sign-off.

    A constrained synthesis is corrected for length and clearance of the guides until no
    utilisation above one half changes.

    Parameters
    ----------
    corners : bool   judge each check at its worst tolerance corner

    Returns
    -------
    Trial   without a verdict; its checks by finite elements are not evaluated

    Raises
    ------
    CamError
        If the case has no such cam.
    """
    with refused_as_written(case):
        return _previewed(case, corners, progress)


def _previewed(case: Case, corners: bool, progress: Progress) -> Trial:
    torques = engine_torques(case)
    if case.smoothing.kind != "constrained":
        contour = case.contour(cam_lift(case, torques))
        trial = solve(
            case, contour, tier=Tier.PREVIEW, torques=torques, corners=corners, progress=progress
        )
        smoother = Smoother.from_case(case.smoothing, case.period) if case.balances else None
        return replace(trial, smoothing=smoothing_record(smoother))
    trial = _synthesised(case, torques, progress)
    return judged_at_corners(trial, torques) if corners else trial


def _synthesised(case: Case, torques: Mapping[str, Torque], progress: Progress) -> Trial:
    """Trial of the constrained synthesis, without tolerance corners."""
    # Most previews need no optimiser.
    from camwright.pipeline.smoothing.constrained_synthesis import synthesise
    from camwright.pipeline.smoothing.fe_correction import (
        Comparison,
        Rank,
        compared,
        corrected,
        design_record,
        rank,
        redrawn,
        solved_ripple,
    )
    from camwright.pipeline.smoothing.multistart import explored
    from camwright.pipeline.smoothing.problem_setup import problem_of

    problem = problem_of(case, torques)
    comparisons: list[Comparison] = []
    best: tuple[Rank, Trial] | None = None
    while True:
        if comparisons:
            design = synthesise(problem)
        else:
            first = explored(problem, 1)
            design, problem = first.design, replace(problem, coefficients=first.splines)
        drawn = redrawn(case, design.variables)
        contour = drawn.contour(design.lift())
        trial = replace(
            solve(
                drawn,
                contour,
                tier=Tier.PREVIEW,
                torques=torques,
                corners=False,
                synthesis_gain=design.gain,
                progress=progress,
            ),
            smoothing=CONSTRAINED,
            synthesis=design_record(design, problem),
        )
        comparisons.append(compared(problem, design, trial.solution))
        ranked = rank(trial.checks, solved_ripple(trial.cycles))
        if best is None or ranked <= best[0]:
            best = (ranked, trial)
        last = not design.feasible or len(comparisons) == _ROUNDS
        if last or comparisons[-1].settled:
            return best[1]
        problem = corrected(problem, design, comparisons)


def smoothing_record(smoother: Smoother | None) -> SmoothingRecord:
    """Record of a smoother; None: of a lift in the case file."""
    if smoother is None:
        return GIVEN_LIFT
    return SmoothingRecord(
        smoother.kind, smoother.width_in_words, smoother.strength, smoother.angular_width
    )
