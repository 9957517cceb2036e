"""Constrained synthesis: the cam of least delivered ripple that keeps every limit.

The unknowns are the coefficients of the stored energy, a periodic quintic B-spline, and what a
case frees of spring rate, preload, base radius and phase. The convex part of the problem, solved
to its global optimum, or the exact energy gives the start; each step from there linearises the
delivered torque and the limits, solves a convex program within a trust region, and is kept when
the ripple and the worst violation of each limit really fall together.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.smoothing.convex_relaxation import convex_start
from camwright.pipeline.smoothing.energy_spline import Grid
from camwright.pipeline.smoothing.linear_model import State
from camwright.pipeline.smoothing.sampled_problem import LEAST_ENERGY, Search
from camwright.pipeline.smoothing.synthesis_problem import FINEST, RESERVE, Design, Problem
from camwright.pipeline.smoothing.trust_region import PENALTY, Descent, descended

__all__ = [
    "RESERVE", "TORQUE_REDUCTION", "Design", "Problem", "Search", "started", "synthesise",
]  # fmt: skip

_ROUNDS = 4
_PRICE_LEAST = 1e-6


def synthesise(problem: Problem, ripple_weight: float = 1.0) -> Design:
    """The cam of least delivered ripple within all limits.

    Parameters
    ----------
    problem : Problem
    ripple_weight : float   0 asks for any cam within the limits

    Returns
    -------
    Design   not `feasible` where no cam near the way keeps the limits
    """
    extra: Array | None = None
    seed = replace(problem, seed=started(problem, ripple_weight))
    steps = 0
    for _ in range(_ROUNDS):
        search = Search(seed, extra)
        found = descended(search, ripple_weight)
        steps += found.steps
        between = _between(search, found.state)
        if not between.size:
            break
        extra = between if extra is None else np.unique(np.concatenate([extra, between]))
        seed = replace(problem, seed=found.state.coefficients, variables=found.state.variables)
    return _design(search, found, steps)


def started(problem: Problem, ripple_weight: float = 1.0) -> Array:
    """Coefficients to start from: those given, or the better of exact energy and convex part."""
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
    """Angles between the points where a limit is passed that holds on them."""
    fine = _fine(search)
    found: list[Array] = []
    for name, value in search.utilisations(state.coefficients, state.variables, fine).items():
        if np.size(value) == 1:
            continue
        bound = max(1.0 - 0.5 * RESERVE, state.utilisation[name] + 0.2 * RESERVE)
        peak = (value >= np.roll(value, 1)) & (value > np.roll(value, -1)) & (value > bound)
        found.append(fine.theta[peak])
    return np.unique(np.concatenate(found)) if found else np.zeros(0)


def _design(search: Search, found: Descent, steps: int) -> Design:
    state, prices = found.state, {}
    if found.answer is not None:
        for name, values in found.answer.multipliers.items():
            if name != LEAST_ENERGY and values.sum() > _PRICE_LEAST:
                prices[name] = float(values.sum())
    theta = search.turn.theta
    on_points = search.utilisations(state.coefficients, state.variables, search.turn)
    # Where a limit is the worst between its points, that is what a check will see.
    fine = search.utilisations(state.coefficients, state.variables, _fine(search))
    most = {name: max(state.utilisation[name], float(np.max(fine[name]))) for name in fine}
    return Design(
        coefficients=readonly(state.coefficients),
        variables=state.variables,
        ripple=state.ripple,
        utilisation=state.utilisation | most,
        multipliers=prices,
        strip={name: (theta, np.broadcast_to(use, theta.shape)) for name, use in on_points.items()},
        steps=steps,
        converged=found.converged,
    )
