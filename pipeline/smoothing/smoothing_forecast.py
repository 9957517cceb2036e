"""What closed forms foresee for a gentler smoother, corrected by the trials already made."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from camwright.geometry.errors import CamError
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check
from camwright.pipeline.smoothing.smoothers import Smoother

Predict = Callable[[Smoother], Sequence[Check]]
Score = tuple[bool, int, float]

MARGIN = 0.005  # share of a limit kept in hand when a candidate is aimed at it
COARSE_STEP = 1.2  # ratio of neighbouring strengths in the first sweep
FINE_STEPS = 10  # in each of the two intervals beside the best of the first sweep


@dataclass(frozen=True)
class Attempt:
    """A trial as the feedback sees it."""

    smoother: Smoother
    checks: tuple[Check, ...]


def keeps_torque(checks: Sequence[Check]) -> bool:
    """Whether the torque reduction holds, or is not asked for; a missing number does not."""
    return all(c.status in ("pass", "waived") for c in checks if c.id == TORQUE_REDUCTION.id)


def score(checks: Sequence[Check]) -> Score:
    """Less is better: torque reduction lost, must-haves failing, worst utilisation of those.

    A missing number counts among the failing; that it is missing says nothing of how badly.
    """
    failing = [check for check in checks if check.blocks]
    known = [check.utilisation for check in failing if check.utilisation is not None]
    return (not keeps_torque(checks), len(failing), max(known, default=0.0))


def plan(
    attempts: Sequence[Attempt], predict: Predict, tolerance: float, widest: float
) -> Smoother | None:
    """The gentlest change that is foreseen to pass; else the smoother foreseen as the best.

    What is foreseen at a strength is the nearest trial, each demand moved by the difference
    the closed forms see. Strengths are swept from that of the first trial up to the widest
    window, coarsely and then finely beside the winner; nothing is assumed of their order.

    Parameters
    ----------
    attempts : sequence   the trials so far
    predict : callable    smoother -> checks; may raise a CamError where no cam exists
    tolerance : float     strengths nearer than this share to a trial are not worth another
    widest : float        angular width not to exceed, rad of crank

    Returns
    -------
    Smoother or None      None when nothing better than the best trial is foreseen
    """
    first = attempts[0].smoother
    looked_at = tuple((item, _ahead(predict, item.smoother)) for item in attempts)
    known = tuple(pair for pair in looked_at if pair[1])
    reach = math.log(max(widest / first.angular_width, 1.0))
    count = 1 + math.ceil(reach / math.log(COARSE_STEP))
    coarse = first.strength * np.exp(np.linspace(0.0, reach, count))
    seen = {float(s): _foreseen(first.stretched(s), known, predict) for s in coarse}
    place = int(np.searchsorted(coarse, _least(seen)))
    beside = coarse[max(place - 1, 0) : place + 2]
    for low, high in pairwise(beside):
        for s in np.geomspace(low, high, FINE_STEPS, endpoint=False)[1:]:
            seen[float(s)] = _foreseen(first.stretched(s), known, predict)
    chosen = _least(seen)
    if seen[chosen][0]:
        return None  # whatever it helps, it would be paid for with the torque
    # A pass is worth a small step, a little less of a failure is not.
    near = 0.25 * tolerance if seen[chosen][1] == 0 else tolerance
    steps = [abs(math.log(chosen / item.smoother.strength)) for item in attempts]
    gains = seen[chosen] < min(score(item.checks) for item in attempts)
    return first.stretched(chosen) if gains and min(steps) > near else None


def _least(seen: Mapping[float, Score]) -> float:
    """The strength with the least score; of equals the least strength."""
    return min(seen, key=lambda strength: (seen[strength], strength))


def _ahead(predict: Predict, smoother: Smoother) -> Mapping[str, Check]:
    """Foreseen checks by id; none where no cam exists."""
    try:
        return {check.id: check for check in predict(smoother)}
    except CamError:
        return {}


def _foreseen(
    smoother: Smoother,
    known: Sequence[tuple[Attempt, Mapping[str, Check]]],
    predict: Predict,
) -> Score:
    ahead = _ahead(predict, smoother)
    if not ahead:
        return (True, sys.maxsize, math.inf)
    if not known:  # no trial so far had a cam to learn from
        return score([_in_hand(check) for check in ahead.values()])
    attempt, behind = min(
        known, key=lambda pair: abs(math.log(pair[0].smoother.strength / smoother.strength))
    )
    return score([_moved(check, ahead, behind) for check in attempt.checks])


def _moved(check: Check, ahead: Mapping[str, Check], behind: Mapping[str, Check]) -> Check:
    """A trial's check as foreseen elsewhere; as it was where nobody foresees it."""
    there, here = ahead.get(check.id), behind.get(check.id)
    if there is None or here is None:
        return check
    if check.demand is None or there.demand is None or here.demand is None:
        return replace(check, demand=None)
    return _in_hand(replace(check, demand=check.demand + there.demand - here.demand))


def _in_hand(check: Check) -> Check:
    """The check with a margin of its limit kept in hand."""
    if check.demand is None or check.limit is None:
        return check
    side = 1.0 if check.sense == "at_most" else -1.0
    return replace(check, demand=check.demand + side * MARGIN * abs(check.limit))
