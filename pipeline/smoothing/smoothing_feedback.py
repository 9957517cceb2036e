"""What to try after a trial that failed: a gentler smoother, the best one again, or nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from camwright.geometry.errors import InputError
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check, binding, verdict
from camwright.pipeline.smoothing.smoothers import CYCLE, Smoother
from camwright.pipeline.smoothing.smoothing_forecast import (
    Attempt,
    Predict,
    keeps_torque,
    plan,
    score,
)

WIDEST = CYCLE / 2.0  # rad of crank; a wider window leaves nothing of the ripple to work with
STEP_LEAST, STEP_MOST = 1.15, 2.0


@dataclass(frozen=True)
class Next:
    """One more trial: with which smoother, and why. `final`: the best one again, to end on it."""

    smoother: Smoother
    why: str
    final: bool = False


@dataclass(frozen=True)
class Stop:
    """No more trials. `best` counts from 1 and is the last trial unless no place was left."""

    reason: str
    binding: tuple[str, ...]
    best: int

    @property
    def passed(self) -> bool:
        """Whether the answer passes every must-have."""
        return not self.binding


def next_smoother(
    attempts: Sequence[Attempt],
    max_trials: int,
    predict: Predict | None = None,
    tolerance: float = 0.02,
) -> Next | Stop:
    """The next trial, or why there is none.

    A failed must-have that the lift can influence asks for a gentler smoother. The reduction
    of the torque is never traded for it: the search stays on the side where it holds, and ends
    when the strongest smoothing that keeps it is known within `tolerance`. The trials end on
    the best of them: torque reduction kept, fewest must-haves failing, least utilisation.

    Parameters
    ----------
    attempts : sequence    the trials so far, at least one, in order
    max_trials : int       trials there may be in all
    predict : callable     smoother -> checks from closed forms; None: learn from trials alone
    tolerance : float      share of strength within which the strongest smoothing is known

    Returns
    -------
    Next or Stop

    Raises
    ------
    InputError
        If there is no attempt yet, or `max_trials` or `tolerance` is not positive.
    """
    if not attempts:
        raise InputError("attempts", 0, "at least one trial")
    if not max_trials >= 1:
        raise InputError("solver.max_trials", max_trials, ">= 1")
    if not tolerance > 0:
        raise InputError("tolerance", tolerance, "> 0")
    latest, room = attempts[-1], max_trials - len(attempts)
    if verdict(latest.checks) == "pass":
        return Stop(f"trial {len(attempts)} passes every must-have check", (), len(attempts))
    if latest.smoother.kind == "none":
        return _end(attempts, room, "the case asks for no smoothing, so none can be made gentler")
    if keeps_torque(latest.checks) and not lift_failures(latest.checks):
        return _end(attempts, room, "no gentler lift can help")
    if room <= 0:
        return _end(attempts, room, f"the bound of {max_trials} trials is reached")
    candidate = _candidate(attempts, predict, tolerance)
    if candidate is None:
        return _end(attempts, room, _reached(attempts))
    if room == 1 and predict is None and any(keeps_torque(item.checks) for item in attempts):
        # Unforeseen, the last place could end on a trial worse than one already made.
        return _end(attempts, room, f"the bound of {max_trials} trials leaves no place to try more")
    return Next(candidate, _why(latest, candidate))


def lift_failures(checks: Sequence[Check]) -> tuple[Check, ...]:
    """Must-haves that fail and that a gentler lift can lower, worst first."""
    failing = [c for c in checks if c.must_have and c.lift_can_help and c.status == "fail"]
    return tuple(sorted(failing, key=lambda check: -(check.utilisation or 0.0)))


def best_attempt(attempts: Sequence[Attempt]) -> int:
    """Index of the best attempt; of equals the latest."""
    scores = [score(attempt.checks) for attempt in attempts]
    return max(i for i, item in enumerate(scores) if item == min(scores))


def _candidate(
    attempts: Sequence[Attempt], predict: Predict | None, tolerance: float
) -> Smoother | None:
    if predict is not None:
        return plan(attempts, predict, tolerance, WIDEST)
    kept = [item for item in attempts if keeps_torque(item.checks)]
    if not kept:
        return None
    lower = max(kept, key=lambda item: item.smoother.strength)
    lost = [item for item in attempts if item.smoother.strength > lower.smoother.strength]
    if lost:
        strength = _between(lower, min(lost, key=lambda item: item.smoother.strength), tolerance)
    else:
        strength = _stepped(lower, tolerance)
    return None if strength is None else lower.smoother.stretched(strength)


def _stepped(lower: Attempt, tolerance: float) -> float | None:
    """A stronger smoothing, by a factor that follows the worst utilisation within bounds."""
    failing = lift_failures(lower.checks)
    wanted = failing[0].utilisation if failing else None
    factor = min(max(wanted if wanted is not None else STEP_LEAST, STEP_LEAST), STEP_MOST)
    widest = WIDEST / lower.smoother.angular_width
    factor = min(factor, widest)
    return lower.smoother.strength * factor if factor > 1.0 + tolerance else None


def _between(lower: Attempt, upper: Attempt, tolerance: float) -> float | None:
    """A strength just on the safe side of where the torque reduction is lost.

    None when that place lies within the tolerance of what is already known to be safe.
    """
    safe, unsafe = lower.smoother.strength, upper.smoother.strength
    if unsafe <= safe * (1.0 + tolerance):
        return None
    spare, lack = _torque_spare(lower.checks), _torque_spare(upper.checks)
    if spare is None or lack is None or not lack < 0:
        return math.sqrt(safe * unsafe)
    reach = safe + (unsafe - safe) * spare / (spare - lack)
    if reach <= safe * (1.0 + tolerance):
        return None
    # Nine tenths of the way: a straight line misses a curve by less than that.
    aimed = safe + 0.9 * (reach - safe)
    return max(aimed, safe * (1.0 + 0.5 * tolerance))


def _torque_spare(checks: Sequence[Check]) -> float | None:
    """Torque reduction above its least value; None when unknown."""
    for check in checks:
        if check.id == TORQUE_REDUCTION.id and check.evaluated:
            spare = (check.demand or 0.0) - (check.limit or 0.0)
            return spare if math.isfinite(spare) else None
    return None


def _end(attempts: Sequence[Attempt], room: int, cause: str) -> Next | Stop:
    """Stop if the latest trial is the best; else go back to the best while there is room."""
    best = best_attempt(attempts)
    latest, chosen = attempts[-1], attempts[best]
    is_best = best == len(attempts) - 1 or latest.smoother == chosen.smoother
    if not is_best and room > 0:
        why = f"trial {best + 1} is the best; the last trial is the answer, so it is repeated"
        return Next(chosen.smoother, f"{cause}: {why}", final=True)
    text = _statement(attempts, latest, cause)
    if not is_best:
        text += f"; trial {best + 1} was better, but no trial was left to repeat it"
    return Stop(text, binding(latest.checks), len(attempts) if is_best else best + 1)


def _statement(attempts: Sequence[Attempt], latest: Attempt, cause: str) -> str:
    """Which limits bind, how far smoothing moved them, and what it cannot do."""
    first = {check.id: check for check in attempts[0].checks}
    by_id = {check.id: check for check in latest.checks}
    parts, unknown = [cause], []
    for name in binding(latest.checks):
        check = by_id[name]
        if check.utilisation is None:
            unknown.append(name)
            continue
        began = first[name].utilisation if name in first else None
        history = f"{began:.3g} at trial 1, " if began is not None and len(attempts) > 1 else ""
        remark = "" if check.lift_can_help else ", not a matter of a gentler lift"
        parts.append(f"{name} at {history}{check.utilisation:.3g} of its limit now{remark}")
    if unknown:
        limits = "one limit" if len(unknown) == 1 else f"{len(unknown)} limits"
        parts.append(f"{limits} not judged, as the case leaves a number out")
    return "; ".join(parts)


def _reached(attempts: Sequence[Attempt]) -> str:
    if not any(keeps_torque(item.checks) for item in attempts):
        return (
            f"{TORQUE_REDUCTION.id} is not met by the smoothing the case asks for, "
            "and a gentler lift lowers it further"
        )
    answer = attempts[best_attempt(attempts)].smoother
    return (
        f"smoothing cannot reach the limits while it keeps {TORQUE_REDUCTION.id}: "
        f"the best is {answer.width_in_words}"
    )


def _why(latest: Attempt, candidate: Smoother) -> str:
    change = f"{latest.smoother.width_in_words}; next: {candidate.width_in_words}"
    if not keeps_torque(latest.checks):
        return f"{TORQUE_REDUCTION.id} is lost at {change}"
    worst = lift_failures(latest.checks)[0]
    return f"{worst.id} at {worst.utilisation or 0.0:.3g} of its limit with {change}"
