"""From a start to the best design near it: convex programs within a trust region."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cone_program import Answer, Reach, solved
from camwright.pipeline.smoothing.linear_model import Model, State
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import FEASIBLE, RESERVE

PENALTY, _PENALTY_MAX = 20.0, 2e3
_STEPS_MAX = 60
_CONVERGED = 2e-6
_TRUST, _TRUST_LEAST = 0.3, 1e-7
# Rows of a limit that a program begins with, and joins by: this near to the limit.
_NEAR, _JOINS = 0.05, 0.01
_MISSED = 1e-9


class Descent(NamedTuple):
    """Where a descent ended, the last program it kept, its steps, and whether it converged."""

    state: State
    answer: Answer | None
    steps: int
    converged: bool


def descended(search: Search, ripple_weight: float) -> Descent:
    """The design that a search comes to from its start.

    Parameters
    ----------
    ripple_weight : float   0 asks for any cam within the limits

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 14.4: sequential programming with an
    exact penalty and a trust region.
    """
    state = search.state(search.start, search.problem.variables)
    trust, penalty, last = _TRUST, PENALTY, None
    for step in range(1, _STEPS_MAX + 1):
        model = search.model(state)
        while True:
            # The box alone would let short waves grow that no ripple of the speed sees.
            reach = Reach(search.bend, trust)
            answer = _answered(model, search.box(state, trust), reach, penalty, ripple_weight)
            if answer is None:
                trust *= 0.3
                if trust < _TRUST_LEAST:
                    return Descent(state, last, step, False)
                continue
            there = search.state(*search.moved(state, answer.step))
            now = state.merit(penalty, ripple_weight)
            foreseen = now - answer.objective - state.jerk
            gained = now - there.merit(penalty, ripple_weight)
            if foreseen <= _CONVERGED:
                if penalty < _PENALTY_MAX and not _within(state):
                    penalty *= 10.0
                    trust = max(trust, 0.1)
                    continue
                return Descent(there if gained > 0 else state, answer, step, True)
            share = gained / foreseen
            if share > 0.05:
                state, last = there, answer
                trust = min(trust * (2.0 if share > 0.7 else 1.0 if share > 0.25 else 0.5), 1.0)
                break
            trust *= 0.35
            if trust < _TRUST_LEAST:
                return Descent(state, last, step, False)
    return Descent(state, last, _STEPS_MAX, False)


def _within(state: State) -> bool:
    return all(value <= 1.0 - RESERVE + FEASIBLE for value in state.utilisation.values())


def _answered(
    model: Model, box: Array, bend: Reach, penalty: float, ripple_weight: float
) -> Answer | None:
    """The program of all rows that matter within the box, found by taking in those it misses."""
    reach, size = np.abs(box).max(axis=0), box.shape[1]
    matter = [limit.highest(reach) >= 0.0 for limit in model.limits]
    chosen = [
        useful & (limit.level >= -_NEAR) for useful, limit in zip(matter, model.limits, strict=True)
    ]
    while True:
        rows = [
            limit.rows(taken, size)
            for limit, taken in zip(model.limits, chosen, strict=True)
            if taken.any()
        ]
        answer = solved(
            model.norms, rows, model.curvature, model.slope, box, penalty, ripple_weight, bend
        )
        if answer is None or not _taken_in(model, answer, matter, chosen):
            return answer


def _taken_in(
    model: Model, answer: Answer, matter: list[NDArray[np.bool_]], chosen: list[NDArray[np.bool_]]
) -> bool:
    """Whether the answer passes a row left out; such rows and those near them join the chosen."""
    grown = False
    for place, limit in enumerate(model.limits):
        over = limit.at(answer.step) - answer.slack.get(limit.name, 0.0)
        missed = matter[place] & ~chosen[place]
        if (over[missed] > _MISSED).any():
            chosen[place] = chosen[place] | (matter[place] & (over > -_JOINS))
            grown = True
    return grown
