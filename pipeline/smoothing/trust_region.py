"""Descent from a start to a local optimum: convex programs within a trust region."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cone_program import ConeSolution, Reach, solved
from camwright.pipeline.smoothing.linear_model import Model, State
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import FEASIBLE, RESERVE

PENALTY, _PENALTY_MAX = 20.0, 2e3
_STEPS_MAX = 60
_CONVERGED = 2e-6
_TRUST, _TRUST_LEAST = 0.3, 1e-7
# Distance from the limit of the rows in the first program, and of those added to it.
_NEAR, _ADDED = 0.05, 0.01
_VIOLATED = 1e-9


class Descent(NamedTuple):
    """End of a descent: state, last accepted program, number of steps."""

    state: State
    program: ConeSolution | None
    steps: int
    converged: bool


def descended(search: Search, ripple_weight: float) -> Descent:
    """Local optimum of a search from its start.

    Parameters
    ----------
    ripple_weight : float   0: any cam within the limits

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
            # The box alone does not bound short waves, which a speed ripple does not contain.
            reach = Reach(search.bend, trust)
            program = _solved(model, search.box(state, trust), reach, penalty, ripple_weight)
            if program is None:
                trust *= 0.3
                if trust < _TRUST_LEAST:
                    return Descent(state, last, step, False)
                continue
            there = search.state(*search.after(state, program.step))
            now = state.merit(penalty, ripple_weight)
            predicted = now - program.objective - state.jerk
            actual = now - there.merit(penalty, ripple_weight)
            if predicted <= _CONVERGED:
                if penalty < _PENALTY_MAX and not _within(state):
                    penalty *= 10.0
                    trust = max(trust, 0.1)
                    continue
                return Descent(there if actual > 0 else state, program, step, True)
            share = actual / predicted
            if share > 0.05:
                state, last = there, program
                trust = min(trust * (2.0 if share > 0.7 else 1.0 if share > 0.25 else 0.5), 1.0)
                break
            trust *= 0.35
            if trust < _TRUST_LEAST:
                return Descent(state, last, step, False)
    return Descent(state, last, _STEPS_MAX, False)


def _within(state: State) -> bool:
    return all(value <= 1.0 - RESERVE + FEASIBLE for value in state.utilisation.values())


def _solved(
    model: Model, box: Array, bend: Reach, penalty: float, ripple_weight: float
) -> ConeSolution | None:
    """Solution with all rows that can be active in the box; violated rows are added in turn."""
    reach, size = np.abs(box).max(axis=0), box.shape[1]
    active = [limit.highest(reach) >= 0.0 for limit in model.limits]
    chosen = [
        useful & (limit.level >= -_NEAR) for useful, limit in zip(active, model.limits, strict=True)
    ]
    while True:
        rows = [
            limit.rows(taken, size)
            for limit, taken in zip(model.limits, chosen, strict=True)
            if taken.any()
        ]
        program = solved(
            model.norms, rows, model.curvature, model.slope, box, penalty, ripple_weight, bend
        )
        if program is None or not _violated_rows_added(model, program, active, chosen):
            return program


def _violated_rows_added(
    model: Model,
    program: ConeSolution,
    active: list[NDArray[np.bool_]],
    chosen: list[NDArray[np.bool_]],
) -> bool:
    """Add the rows that a solution violates, and those near them; whether there are any."""
    added = False
    for place, limit in enumerate(model.limits):
        over = limit.at(program.step) - program.slack.get(limit.name, 0.0)
        left_out = active[place] & ~chosen[place]
        if (over[left_out] > _VIOLATED).any():
            chosen[place] = chosen[place] | (active[place] & (over > -_ADDED))
            added = True
    return added
