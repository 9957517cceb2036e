"""Lagrangian of a synthesis: value for changed machine numbers, Hessian.

Ripples and limits are functions of the energy and its derivatives at each cam angle, of the maximum
lift and of the free variables. Their second derivatives are small matrices by cam angle, which the
splines assemble.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cam_state import Mean
from camwright.pipeline.smoothing.cone_program import ConeSolution, Linear
from camwright.pipeline.smoothing.gradients import second_derivatives, values_of
from camwright.pipeline.smoothing.linear_model import Model, State, Summit
from camwright.pipeline.smoothing.objective import residuals_slope, torque_ripple
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import (
    Problem,
    ripple_of,
    torque_slope,
)

_PHASE_STEP = 1e-4  # rad
_PRICE_LEAST = 1e-9  # multiplier below which a row does not count


@dataclass(frozen=True, eq=False)
class Lagrangian:
    """Lagrangian at an optimum: ripples and limits times their multipliers.

    By the envelope theorem the derivative of the ripple by a number of the machine is that of the
    Lagrangian at the optimum.

    Parameters
    ----------
    coefficients, variables   of the optimum
    extra : array (e,)        cam angles between the points, rad
    limits : sequence         rows and their multipliers (m,)
    ripples : sequence        number of a weighted scenario, multipliers of its ripple and ceiling
    """

    coefficients: Array
    variables: DesignVariables
    extra: Array
    limits: Sequence[tuple[Linear, Array]]
    ripples: Sequence[tuple[int, float, float]]

    @classmethod
    def of(cls, search: Search, state: State, model: Model, program: ConeSolution) -> Lagrangian:
        """Lagrangian at the last state of a search."""
        return cls(
            coefficients=state.coefficients,
            variables=state.variables,
            extra=search.extra,
            limits=[
                pair
                for pair in zip(model.limits, program.rows, strict=True)
                if (pair[1] > _PRICE_LEAST).any() and (pair[0].scenario >= 0).all()
            ],
            ripples=[
                (norm.number, *prices)
                for norm, prices in zip(model.norms, program.norms, strict=True)
            ],
        )

    def at(self, problem: Problem, variables: DesignVariables | None = None) -> float:
        """Value for a problem of equal limits and splines, over the engine's ripple.

        Parameters
        ----------
        variables : DesignVariables   of the design; None: those of the optimum
        """
        search = Search(problem, self.extra)
        variables = self.variables if variables is None else variables
        state = search.state(self.coefficients, variables)
        total = 0.0
        for limit, prices in self.limits:
            if limit.mean:
                uses = state.means[limit.name][limit.scenario]
            else:
                uses = state.pointwise[limit.name][limit.scenario, limit.point]
            total += float(prices @ uses)
        left = search.residual_torque(state)
        for number, objective, ceiling in self.ripples:
            item, values = problem.scenarios[search.weighted[number]], left[number]
            ripple = float(np.linalg.norm(ripple_of(problem, item, values)))
            total += objective * item.weight * ripple
            total += ceiling * float(np.linalg.norm(torque_ripple(item, values)))
        return total


def lagrangian_curvature(
    search: Search, state: State, here: Model, model: Model, program: ConeSolution
) -> Array:
    """Hessian (size, size) of the Lagrangian of a synthesis at a state, by the scaled unknowns:
    coefficients and free variables.

    The norms of the ripples, as functions of their linear residuals, are left out: the cone program
    holds them exactly. So is the second derivative of the maximum lift.

    Parameters
    ----------
    search : Search          the sampled problem
    state : State            after the step of the program
    here : Model             linear model at this state
    model : Model            of the program; its rows have the multipliers
    program : ConeSolution   with the multipliers
    """
    total = np.zeros((search.size, search.size))
    priced = [
        (limit, price)
        for limit, price in zip(model.limits, program.rows, strict=True)
        if (price > _PRICE_LEAST).any()
    ]
    pointwise = [pair for pair in priced if not pair[0].mean and (pair[0].scenario >= 0).all()]
    means = [pair for pair in priced if pair[0].mean]
    total += _of_rows(search, state, here.summit, pointwise)
    total += _of_means(search, state, here, means)
    return total + _of_ripples(search, state, here.summit, model, program)


def _of_rows(
    search: Search, state: State, summit: Summit, priced: Sequence[tuple[Linear, Array]]
) -> Array:
    """Part of the Hessian (size, size) of the Lagrangian from limits at single cam angles.

    Parameters
    ----------
    search : Search     the sampled problem
    state : State       at which it is taken
    summit : Summit     maximum lift there
    priced : sequence   rows of a limit, with the multiplier (m,) of each row
    """
    total = np.zeros((search.size, search.size))
    for names in search.families(limit.name for limit, _ in priced):
        pairs = [pair for pair in priced if pair[0].name in names]
        # Reversals may end.
        last = state.grid.theta.size
        active = [(price > _PRICE_LEAST) & (each.point < last) for each, price in pairs]
        point = np.concatenate([each.point[k] for (each, _), k in zip(pairs, active, strict=True)])
        if not point.size:
            continue  # all their reversals have ended
        row = np.concatenate([each.scenario[k] for (each, _), k in zip(pairs, active, strict=True)])
        starts = np.cumsum([0, *(int(k.sum()) for k in active)])
        weights = {name: np.zeros(point.size) for name in names}
        for (each, price), k, start in zip(pairs, active, starts, strict=False):
            weights[each.name][start : start + int(k.sum())] = price[k]
        function = search.at_pairs(names, state, row, point)
        at = search.point(state, summit.lift, point)
        second = second_derivatives(function, at, search.freed, weights)
        total += _assembled(search, state, summit, second, point)
    return total


def _of_means(
    search: Search, state: State, here: Model, priced: Sequence[tuple[Linear, Array]]
) -> Array:
    """Part of the Hessian (size, size) of the Lagrangian from limits and costs that are means over
    the turn.

    Parameters
    ----------
    search : Search     the sampled problem
    state : State       at which it is taken
    here : Model        linear model there, with the derivatives of means
    priced : sequence   rows of a limit, with the multiplier (m,) of each row
    """
    summit = here.summit
    total = np.zeros((search.size, search.size))
    by_name = {name: np.zeros(rows.size) for name, rows in state.means.items()}
    for limit, price in priced:
        by_name[limit.name][limit.scenario] += price
    for names in search.families(limit.name for limit, _ in priced):
        rows = {name: by_name[name] > 0.0 for name in names}
        turn = search.of_means(state, summit, rows)
        weights = {}
        for name, mean in values_of(turn.function, turn.at).items():
            if not isinstance(mean, Mean):
                continue
            price = by_name[name][turn.places[name]]
            slopes = here.slopes_of(name, turn.scenarios)
            if slopes is None:
                slopes = search.means_slopes(turn, state, summit, name)
            total += slopes.T @ mean.hessian(price) @ slopes
            weights[name] = (price @ mean.slopes / search.every.size)[:, None]
        second = second_derivatives(turn.function, turn.at, search.freed, weights)
        total += _assembled(search, state, summit, second, search.every)
    return total


def _of_ripples(
    search: Search, state: State, summit: Summit, model: Model, program: ConeSolution
) -> Array:
    """Part of the Hessian (size, size) of the Lagrangian from the curvature of the torque that the
    cam delivers and, where the phase is free, of the engine torque by the phase; weighted by the
    derivative of the ripples by the torque.

    Parameters
    ----------
    search : Search          the sampled problem
    state : State            at which it is taken
    summit : Summit          maximum lift there
    model : Model            of the program
    program : ConeSolution   with the multipliers of the ripples
    """
    problem, variables = search.problem, state.variables
    left = search.residual_torque(state)
    slope = np.zeros_like(left)
    for norm, (objective, ceiling) in zip(model.norms, program.norms, strict=True):
        item = problem.scenarios[search.weighted[norm.number]]
        values = left[norm.number]
        if objective > _PRICE_LEAST:
            slope[norm.number] += (
                objective * item.weight * residuals_slope(problem.objective, item, values)
            )
        if ceiling > _PRICE_LEAST:
            slope[norm.number] += ceiling * torque_slope(item, values)
    if not slope.any():
        return np.zeros((search.size, search.size))
    priced = np.flatnonzero(slope.any(axis=1))
    points = search.every
    second = second_derivatives(
        search.torque(state, priced),
        search.point(state, summit.lift, points),
        search.freed,
        {"torque": -slope[priced] / problem.gear_ratio},
    )
    total = _assembled(search, state, summit, second, points)
    if "phase" in problem.freed:
        phase_column = problem.coefficients + list(problem.freed).index("phase")
        for k in priced:
            item, phase = problem.scenarios[search.weighted[k]], float(variables.phase)
            ends = [item.torque_at(phase + side * _PHASE_STEP)[1] for side in (1.0, -1.0)]
            total[phase_column, phase_column] += float(slope[k] @ (ends[0] - ends[1])) / (
                2.0 * _PHASE_STEP
            )
    return total


def _assembled(
    search: Search, state: State, summit: Summit, second: Array, points: NDArray[np.intp]
) -> Array:
    """Hessian (size, size) by the scaled unknowns from second derivatives at single cam angles.

    Parameters
    ----------
    search : Search            the sampled problem
    state : State              with the splines
    summit : Summit            maximum lift, with its derivatives
    second : array (q, q, m)   by the q local arguments: E to E''', maximum lift, k, P, r0
    points : array (m,)        indices of the cam angles of the grid
    """
    size, orders = search.size, state.grid.entries.shape[0]
    entries = search.scale * state.grid.entries[:, points]
    columns = state.grid.columns[points]
    local = np.einsum("abm,bmj->amj", second[:orders, :orders], entries)
    blocks = np.einsum("ami,amj->mij", entries, local)
    entry = columns[:, :, None] * size + columns[:, None, :]
    total = np.bincount(entry.ravel(), blocks.ravel(), size * size).reshape(size, size)
    shared = search.shared_columns(state, summit)
    sides = np.einsum("sam,amj->smj", second[orders:, :orders], entries)
    mixed = np.stack([np.bincount(columns.ravel(), side.ravel(), size) for side in sides])
    cross = mixed.T @ shared
    common = second[orders:, orders:].sum(axis=2)
    return np.asarray(total + cross + cross.T + shared.T @ common @ shared)
