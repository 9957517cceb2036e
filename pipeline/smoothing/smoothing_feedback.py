"""Choice of the next trial: wider smoother, repetition of the best, or stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import used
from camwright.pipeline.base.verdict import binding, in_order, verdict
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check
from camwright.pipeline.smoothing.smoothers import Smoother
from camwright.pipeline.smoothing.smoothing_forecast import (
    Attempt,
    Forecast,
    best_candidate,
    keeps_torque,
    score,
)

WIDEST = 0.5  # of a cycle; a wider window leaves no ripple to compensate


@dataclass(frozen=True)
class Next:
    """Smoother of a further trial, with its reason."""

    smoother: Smoother
    why: str


@dataclass(frozen=True)
class Stop:
    """End of the trials; `best`: number from 1 of the result."""

    reason: str
    binding: tuple[str, ...]
    best: int


def next_smoother(attempts: Sequence[Attempt], max_trials: int, forecast: Forecast) -> Next | Stop:
    """Smoother of the next trial, or the reason to stop.

    A failed must-have check that a gentler lift can pass is a reason for a wider smoother. The
    torque reduction is kept: the search ends at the widest smoother that keeps it. The last trial
    is the best one: torque reduction kept, fewest must-have checks failed, least utilisation,
    fewest without data. Missing data are no reason to smooth.

    Parameters
    ----------
    attempts : sequence    trials so far, in order, at least one
    max_trials : int       maximum number of trials, >= 1
    forecast : callable    quick checks of the cams of smoothers, see `Forecast`

    Returns
    -------
    Next or Stop

    Raises
    ------
    InputError
        If there is no attempt yet, or `max_trials` is not positive.
    """
    if not attempts:
        raise InputError("attempts", 0, "at least one trial")
    if not max_trials >= 1:
        raise InputError("solver.max_trials", max_trials, ">= 1")
    latest, room = attempts[-1], max_trials - len(attempts)
    judged = verdict(latest.checks)
    if judged == "pass":
        return Stop(f"trial {len(attempts)} passes every must-have check", (), len(attempts))
    if judged == "incomplete":
        cause = f"no check of trial {len(attempts)} fails, but data are missing"
        return _end(attempts, room, cause)
    if latest.smoother.kind == "none":
        return _end(attempts, room, "the case has no smoother to widen")
    if keeps_torque(latest.checks) and not lift_failures(latest.checks):
        return _end(attempts, room, "no gentler lift can help")
    if room <= 0:
        return _end(attempts, room, f"the maximum of {max_trials} trials is reached")
    widest = WIDEST * latest.smoother.period.angle
    candidate = best_candidate(attempts, forecast, widest)
    if candidate is None:
        return _end(attempts, room, _reached(attempts))
    return Next(candidate, _why(latest, candidate))


def lift_failures(checks: Sequence[Check]) -> tuple[Check, ...]:
    """Failed must-have checks that a gentler lift can cure, worst first."""
    failing = [c for c in checks if c.must_have and c.lift_can_help and c.status == "fail"]
    return tuple(sorted(failing, key=lambda check: -(check.utilisation or 0.0)))


def best_attempt(attempts: Sequence[Attempt]) -> int:
    """Index of the best attempt, the latest of equal ones."""
    scores = [score(attempt.checks) for attempt in attempts]
    return max(i for i, item in enumerate(scores) if item == min(scores))


def _end(attempts: Sequence[Attempt], room: int, cause: str) -> Next | Stop:
    """End of the trials: stop where the latest trial is the best or none is left; else the smoother
    of the best trial, repeated as the last one.

    Parameters
    ----------
    attempts : sequence   the trials, at least one
    room : int            trials left
    cause : str           reason of the end, in words
    """
    best = best_attempt(attempts)
    latest, chosen = attempts[-1], attempts[best]
    is_best = best == len(attempts) - 1 or latest.smoother == chosen.smoother
    if not is_best and room > 0:
        why = f"trial {best + 1} is the best; it is repeated as the last one"
        return Next(chosen.smoother, f"{cause}: {why}")
    text = _statement(attempts, latest, cause)
    if not is_best:
        text += f"; trial {best + 1} was better, but no trial was left to repeat it"
    return Stop(text, binding(in_order(latest.checks)), len(attempts) if is_best else best + 1)


def _statement(attempts: Sequence[Attempt], latest: Attempt, cause: str) -> str:
    """Reason of the end in words: the cause, then each check that binds in the latest trial with
    its utilisation at trial 1 and now.

    Parameters
    ----------
    attempts : sequence   all trials
    latest : Attempt      the last of them
    cause : str           first part of the reason
    """
    first = {check.id: check for check in attempts[0].checks}
    by_id = {check.id: check for check in latest.checks}
    parts, unknown = [cause], []
    for name in binding(in_order(latest.checks)):
        check = by_id[name]
        if check.utilisation is None:
            unknown.append(name)
            continue
        before = first[name].utilisation if name in first else None
        history = f"{used(before)} at trial 1, " if before is not None and len(attempts) > 1 else ""
        remark = "" if check.lift_can_help else ", independent of the smoothing"
        remark += ", not proven" if check.not_proven else ""
        parts.append(f"{name} at {history}{used(check.utilisation)} of its limit now{remark}")
    if unknown:
        limits = "one check" if len(unknown) == 1 else f"{len(unknown)} checks"
        parts.append(f"{limits} not evaluated, as an input is missing")
    return "; ".join(parts)


def _reached(attempts: Sequence[Attempt]) -> str:
    """Sentence on why no smoother passes: every trial loses the torque reduction, or the other
    checks fail with all smoothers that keep it, and which tried one is the best.
    """
    if not any(keeps_torque(item.checks) for item in attempts):
        failed = any(c.status == "fail" for c in attempts[0].checks if c.id == TORQUE_REDUCTION.id)
        state = "fails" if failed else "is not evaluated"
        return (
            f"{TORQUE_REDUCTION.id} {state} with the smoother of the case, "
            "and a gentler lift lowers it further"
        )
    best = attempts[best_attempt(attempts)].smoother
    return (
        f"no smoother that keeps {TORQUE_REDUCTION.id} passes the other checks: "
        f"the best tried is {best.width_in_words}"
    )


def _why(latest: Attempt, candidate: Smoother) -> str:
    """Sentence on why the lift is smoothed anew: the check that failed with the width of the
    latest smoother, and the width of the next.

    That check is the torque reduction or, where it is kept, the worst that a gentler lift can cure;
    one of the two has failed.
    """
    change = f"{latest.smoother.width_in_words}; next: {candidate.width_in_words}"
    if not keeps_torque(latest.checks):
        return f"{TORQUE_REDUCTION.id} is lost at {change}"
    worst = lift_failures(latest.checks)[0]
    return f"{worst.id} at {used(worst.utilisation)} of its limit with {change}"
