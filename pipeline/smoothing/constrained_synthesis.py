"""Constrained synthesis: the cam of least residual ripple within all limits.

The unknowns are the coefficients of the stored energy, a periodic quintic B-spline, and the free
ones of spring rate, preload, prime radius and phase. The search starts from the global optimum of
the convex part of the problem or from the exact energy. Each step linearises delivered torque and
limits, solves a convex program within a trust region, and is accepted when the merit decreases:
ripple plus penalised violations.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.smoothing.convex_relaxation import convex_start
from camwright.pipeline.smoothing.energy_spline import Grid
from camwright.pipeline.smoothing.linear_model import State
from camwright.pipeline.smoothing.sampled_problem import LEAST_ENERGY, Search
from camwright.pipeline.smoothing.synthesis_problem import FINEST, RESERVE, Design, Problem
from camwright.pipeline.smoothing.trust_region import PENALTY, Descent, descended

_ROUNDS = 4
_MULTIPLIER_LEAST = 1e-6


def synthesise(problem: Problem, ripple_weight: float = 1.0) -> Design:
    """Cam of least residual ripple within all limits.

    Parameters
    ----------
    problem : Problem
    ripple_weight : float   0: any cam within the limits

    Returns
    -------
    Design   not `feasible` where the search ends outside a limit
    """
    extra: Array | None = None
    seed = replace(problem, seed=started(problem, ripple_weight))
    steps = 0
    for _ in range(_ROUNDS):
        search = Search(seed, extra)
        descent = descended(search, ripple_weight)
        steps += descent.steps
        between = _between(search, descent.state)
        if not between.size:
            break
        extra = between if extra is None else np.unique(np.concatenate([extra, between]))
        seed = replace(problem, seed=descent.state.coefficients, variables=descent.state.variables)
    return _design(search, descent, steps)


def started(problem: Problem, ripple_weight: float = 1.0) -> Array:
    """Start coefficients, J: the seed, or the better of exact energy and convex optimum."""
    if problem.seed is not None:
        return problem.seed
    search = Search(problem)
    starts = [search.exact]
    core = convex_start(problem)
    if core is not None:
        starts.append(core.coefficients)
    states = [search.state(start, problem.variables) for start in starts]
    return min(states, key=lambda state: state.merit(PENALTY, ripple_weight)).coefficients


def _fine(search: Search) -> Grid:
    problem = search.problem
    return Grid.at(uniform_turn(FINEST * problem.points), problem.coefficients)


def _between(search: Search, state: State) -> Array:
    """Cam angles between the points at which a limit is exceeded more than at them."""
    fine = _fine(search)
    angles: list[Array] = []
    for name, value in search.utilisations(state.coefficients, state.variables, fine).items():
        if np.size(value) == 1:
            continue
        bound = max(1.0 - 0.5 * RESERVE, state.utilisation[name] + 0.2 * RESERVE)
        peak = (value >= np.roll(value, 1)) & (value > np.roll(value, -1)) & (value > bound)
        angles.append(fine.theta[peak])
    return np.unique(np.concatenate(angles)) if angles else np.zeros(0)


def _design(search: Search, descent: Descent, steps: int) -> Design:
    state, multipliers = descent.state, {}
    if descent.program is not None:
        for name, values in descent.program.multipliers.items():
            if name != LEAST_ENERGY and values.sum() > _MULTIPLIER_LEAST:
                multipliers[name] = float(values.sum())
    theta = search.turn.theta
    on_points = search.utilisations(state.coefficients, state.variables, search.turn)
    # The checks refine between points.
    fine = search.utilisations(state.coefficients, state.variables, _fine(search))
    most = {name: max(state.utilisation[name], float(np.max(fine[name]))) for name in fine}
    return Design(
        coefficients=readonly(state.coefficients),
        variables=state.variables,
        ripple=state.ripple,
        utilisation=state.utilisation | most,
        multipliers=multipliers,
        strip={name: (theta, np.broadcast_to(use, theta.shape)) for name, use in on_points.items()},
        steps=steps,
        converged=descent.converged,
    )
