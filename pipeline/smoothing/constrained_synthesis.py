"""Constrained synthesis: the cam of least residual ripple within all limits.

The unknowns are the coefficients of the stored energy, a periodic quintic B-spline, of one lobe
where the lobes are equal, and the free
ones of spring rate, preload, prime radius and phase. The search starts from the global optimum of
the convex part of the problem or from the exact energy. Each step solves a convex program within a
trust region: linear models of delivered torque and limits, second derivatives of the Lagrangian. It
is accepted when the merit decreases: ripple plus penalised violations.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, readonly
from camwright.pipeline.smoothing.convex_relaxation import convex_start
from camwright.pipeline.smoothing.energy_spline import Grid, lowest
from camwright.pipeline.smoothing.lagrangian import Lagrangian
from camwright.pipeline.smoothing.linear_model import State
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import FINEST, RESERVE, Design, Problem
from camwright.pipeline.smoothing.trust_region import PENALTY, Descent, descended

_REFINING_ROUNDS = 4  # descents, each with extra angles between the points
_MULTIPLIER_LEAST = 1e-6
_NEAR_PEAK = 0.01  # of a limit: peaks this near to it, or the greatest, are refined between points


def synthesise(
    problem: Problem,
    ripple_weight: float = 1.0,
    enough: float | None = None,
    worth: float = 0.0,
) -> Design:
    """Design of least residual ripple within all limits.

    Parameters
    ----------
    problem : Problem
    ripple_weight : float   of the ripple in the objective; 0: any cam within the limits
    enough : float          ripple over that of the engine at which the search may end; None: the
                            least
    worth : float           progress of the merit below which it may end, see `descended`

    Returns
    -------
    Design   not `feasible` where the search ends outside a limit
    """
    search = started(problem, ripple_weight)
    descent = descended(search, ripple_weight, enough=enough, worth=worth)
    steps, peaks = descent.steps, _Peaks.of(search, descent.state)
    for _ in range(_REFINING_ROUNDS - 1):
        between = _between(descent.state, peaks)
        if descent.stuck or not between.size:
            break
        search = Search(problem, np.concatenate([search.extra, between]))
        descent = descended(search, ripple_weight, descent, enough, worth)
        steps, peaks = steps + descent.steps, _Peaks.of(search, descent.state)
    return _design(search, descent, steps, peaks)


def approached(problem: Problem) -> State:
    """Local optimum on the sampled angles alone, as a start on more splines."""
    return descended(started(problem), 1.0).state


def started(problem: Problem, ripple_weight: float = 1.0) -> Search:
    """Search for a cam, with its start set: the seed of the problem or, without one, of the energy
    that balances the torque and the optimum of the convex part that of less merit, which is
    minimised.

    Parameters
    ----------
    ripple_weight : float   of ripple and costs against violated limits in the merit; 0: limits
                            alone
    """
    search = Search(problem)
    core = convex_start(problem) if problem.seed is None else None
    if core is not None:
        states = [search.state(start, problem.variables) for start in
                  (search.exact, core.coefficients)]  # fmt: skip
        best = min(states, key=lambda state: state.merit(PENALTY, ripple_weight))
        search.start = best.coefficients
    return search


class _Peaks(NamedTuple):
    """Cam angles beside the greatest utilisations, finer than the points, and all limits there."""

    fine: Grid
    uses: Mapping[str, Array]

    @classmethod
    def of(cls, search: Search, state: State) -> _Peaks:
        fine = _beside_peaks(search, state)
        return cls(fine, search.pointwise(state.coefficients, state.variables, fine))


def _beside_peaks(search: Search, state: State) -> Grid:
    """Splines at cam angles between the points of the turn, spaced a `FINEST`-th of theirs, beside
    each point at which the utilisation of a limit has a peak near 1 or near its maximum over the
    turn.

    Parameters
    ----------
    search : Search   with the points of the turn
    state : State     with the utilisations at them
    """
    points, step = search.problem.points, search.turn.theta[1]
    near = np.zeros(points, dtype=bool)
    for each in state.pointwise.values():
        value = each.max(axis=0)[:points]
        peak = (value >= np.roll(value, 1)) & (value >= np.roll(value, -1))
        near |= peak & (value >= min(1.0 - RESERVE - _NEAR_PEAK, value.max()))
    offsets = np.arange(1 - FINEST, FINEST) * (step / FINEST)
    theta = np.unique(np.round((search.turn.theta[near, None] + offsets).ravel() / step, 6)) * step
    return search.problem.grid(theta)


def _between(state: State, peaks: _Peaks) -> Array:
    """Cam angles between the points, rad, to be added to those at which the limits hold: peaks of a
    utilisation above 1 less half the reserve and above its maximum at the points by a fifth of the
    reserve. Empty where there is none.

    Parameters
    ----------
    state : State    with the utilisations at the points
    peaks : _Peaks   finer cam angles, with the utilisations there
    """
    angles: list[Array] = []
    for name, value in peaks.uses.items():
        bound = max(1.0 - 0.5 * RESERVE, state.utilisation[name] + 0.2 * RESERVE)
        peak = (value >= np.roll(value, 1)) & (value > np.roll(value, -1)) & (value > bound)
        angles.append(peaks.fine.theta[peak])
    return np.unique(np.concatenate(angles)) if angles else np.zeros(0)


def _design(search: Search, descent: Descent, steps: int, peaks: _Peaks) -> Design:
    """Design from the last state of a search, with utilisations, multipliers and Lagrangian.

    Where the energy is below the least allowed between the points, all of it is raised by the
    difference.

    Parameters
    ----------
    search : Search     at its last refinement
    descent : Descent   the last one, with state, model and program
    steps : int         of all descents
    peaks : _Peaks      utilisations between the points, which count as well
    """
    state, theta, points = descent.state, search.turn.theta, search.problem.points
    # Between the points the energy may dip below its least value by their spacing squared.
    rise = search.problem.energy[0] - lowest(state.coefficients)
    if rise > 0.0:
        state = search.state(state.coefficients + rise, state.variables)
        uses = search.pointwise(state.coefficients, state.variables, peaks.fine)
        peaks = peaks._replace(uses=uses)
    on_points = {name: use[:, :points].max(axis=0) for name, use in state.pointwise.items()}
    on_points |= {name: use.max(keepdims=True) for name, use in state.means.items()}
    # The checks refine between points.
    most = {
        name: max(state.utilisation[name], float(use.max())) for name, use in peaks.uses.items()
    }
    return Design(
        coefficients=readonly(state.coefficients),
        lobes=search.problem.lobes,
        variables=state.variables,
        ripple=state.ripple,
        cost=state.cost,
        utilisation=dict(state.utilisation) | most,
        multipliers=_multipliers(descent),
        strip={name: (theta, np.broadcast_to(use, theta.shape)) for name, use in on_points.items()},
        steps=steps,
        gain=descent.gain,
        stuck=descent.stuck,
        ended=descent.ended,
        lagrangian=None
        if descent.model is None or descent.program is None
        else Lagrangian.of(search, state, descent.model, descent.program),
    )


def _multipliers(descent: Descent) -> dict[str, float]:
    """Multipliers of the limits, by name, from the last cone program of a descent: decrease of the
    objective per unit of utilisation, summed over the rows of a limit.

    Those below `_MULTIPLIER_LEAST` are left out; empty where no program was solved.
    """
    model, program = descent.model, descent.program
    if model is None or program is None:
        return {}
    totals: dict[str, float] = {}
    for limit, prices in zip(model.limits, program.rows, strict=True):
        if limit.cost or not limit.elastic:
            continue
        totals[limit.name] = totals.get(limit.name, 0.0) + float(prices.sum())
    return {name: total for name, total in totals.items() if total > _MULTIPLIER_LEAST}
