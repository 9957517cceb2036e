"""Forecast of the checks under a wider smoother, corrected by previous trials."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.checks.check import Check
from camwright.pipeline.smoothing.smoothers import Smoother

Forecast = Callable[[Sequence[Smoother]], Sequence[Sequence[Check]]]
"""Quick checks of the cam of each smoother; none where no cam exists."""
Score = tuple[bool, int, float, int]

MARGIN = 0.005  # of the limit, between a forecast demand and its limit
TOLERANCE = 0.02  # relative difference of strength of two distinct trials
COARSE_STEP = 1.2  # ratio of neighbouring strengths in the first sweep
FINE_STEPS = 10  # in each of the two intervals beside the best of the first sweep


@dataclass(frozen=True)
class Attempt:
    """Smoother of a trial with its checks."""

    smoother: Smoother
    checks: tuple[Check, ...]


def keeps_torque(checks: Sequence[Check]) -> bool:
    """Whether the torque reduction passes or is not required; a missing number fails."""
    return all(c.status in ("pass", "waived") for c in checks if c.id == TORQUE_REDUCTION.id)


def score(checks: Sequence[Check]) -> Score:
    """Score by which trials are ordered, the least is best: whether the torque reduction is lost;
    number of failed required checks; their greatest utilisation; number of required checks without
    data.

    A failed check is worse than any number of missing data.
    """
    blocking = [check for check in checks if check.blocks]
    failing = [check for check in blocking if check.status == "fail"]
    worst = max((check.utilisation or 0.0 for check in failing), default=0.0)
    return (not keeps_torque(checks), len(failing), worst, len(blocking) - len(failing))


def best_candidate(
    attempts: Sequence[Attempt], forecast: Forecast, widest: float
) -> Smoother | None:
    """Narrowest smoother forecast to pass, else that of the best forecast.

    The forecast at a strength is the nearest trial plus the difference of the closed forms.
    Strengths are swept from that of the first trial up to the widest window, coarsely, then
    finely beside the best; the score need not be monotonic.

    Parameters
    ----------
    attempts : sequence   trials so far
    forecast : callable   see `Forecast`
    widest : float        maximum angular width, rad of crank

    Returns
    -------
    Smoother or None      None when no forecast is better than the best trial
    """
    first = attempts[0].smoother
    reach = math.log(max(widest / first.angular_width, 1.0))
    count = 1 + math.ceil(reach / math.log(COARSE_STEP))
    coarse = first.strength * np.exp(np.linspace(0.0, reach, count))
    wider = [first.stretched(s) for s in coarse]
    forecasts = [_by_id(each) for each in forecast([*(item.smoother for item in attempts), *wider])]
    compared = tuple(
        (item, checks) for item, checks in zip(attempts, forecasts, strict=False) if checks
    )
    ahead = zip(coarse, wider, forecasts[len(attempts) :], strict=True)
    scores = {float(s): _score(smoother, compared, checks) for s, smoother, checks in ahead}
    index = int(np.searchsorted(coarse, _best(scores)))
    beside = coarse[max(index - 1, 0) : index + 2]
    fine = [
        s
        for low, high in pairwise(beside)
        for s in np.geomspace(low, high, FINE_STEPS, endpoint=False)[1:]
    ]
    wider = [first.stretched(s) for s in fine]
    for s, smoother, checks in zip(fine, wider, forecast(wider), strict=True):
        scores[float(s)] = _score(smoother, compared, _by_id(checks))
    chosen = _best(scores)
    if scores[chosen][0]:
        return None  # the torque reduction would be lost
    # A pass is worth a small step, a little less of a failure is not.
    near = 0.25 * TOLERANCE if scores[chosen][1] == 0 else TOLERANCE
    steps = [abs(math.log(chosen / item.smoother.strength)) for item in attempts]
    gains = scores[chosen] < min(score(item.checks) for item in attempts)
    return first.stretched(chosen) if gains and min(steps) > near else None


def _best(scores: Mapping[float, Score]) -> float:
    """The strength with the least score; of equals the least strength."""
    return min(scores, key=lambda strength: (scores[strength], strength))


def _by_id(checks: Sequence[Check]) -> Mapping[str, Check]:
    return {check.id: check for check in checks}


def _score(
    smoother: Smoother,
    known: Sequence[tuple[Attempt, Mapping[str, Check]]],
    candidate: Mapping[str, Check],
) -> Score:
    """Score, see `score`, of the forecast checks of a smoother that was not tried.

    Each check is that of the solved trial of nearest strength, its demand changed by the difference
    of the forecasts for the two smoothers. The worst score where the smoother has no forecast.

    Parameters
    ----------
    smoother : Smoother   to be scored
    known : sequence      trials with the forecast checks of their smoothers, by id
    candidate : mapping   forecast checks of the smoother, by id; empty: it has no cam
    """
    if not candidate:
        return (True, sys.maxsize, math.inf, sys.maxsize)
    if not known:  # no trial so far had a cam
        return score([_with_margin(check) for check in candidate.values()])
    nearest, solved_checks = min(
        known, key=lambda pair: abs(math.log(pair[0].smoother.strength / smoother.strength))
    )
    return score([_corrected(check, candidate, solved_checks) for check in nearest.checks])


def _corrected(check: Check, candidate: Mapping[str, Check], own: Mapping[str, Check]) -> Check:
    """Check of a solved trial, its demand changed by the difference of two forecasts; unchanged
    without a forecast.

    The demand at its tolerance corner changes in proportion, and the margin of the forecast is
    added; without a demand in one of the three the check has none.

    Parameters
    ----------
    check : Check         of the trial
    candidate : mapping   forecast checks of the new smoother, by id
    own : mapping         forecast checks of the smoother of the trial, by id
    """
    there, here = candidate.get(check.id), own.get(check.id)
    if there is None or here is None:
        return check
    if check.without or there.without:
        return _with_margin(there)
    if check.demand is None or there.demand is None or here.demand is None:
        return replace(check, demand=None)
    return _with_margin(_moved(check, there.demand - here.demand))


def _with_margin(check: Check) -> Check:
    """Check with its demand made worse by the share `MARGIN` of the magnitude of the limit;
    unchanged without demand or limit.
    """
    if check.demand is None or check.limit is None:
        return check
    side = 1.0 if check.sense == "at_most" else -1.0
    return _moved(check, side * MARGIN * abs(check.limit))


def _moved(check: Check, by: float) -> Check:
    """Check with `by`, SI, added to its demand; that at its tolerance corner changes by `by` times
    the ratio of both magnitudes.
    """
    demand, corner = float(check.demand or 0.0), check.corner_demand
    if corner is not None:
        corner += by * (abs(corner / demand) if demand else 1.0)
    return replace(check, demand=demand + by, corner_demand=corner)
