"""State of a search, and linear models of its functions there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cone_program import IdleForces, Linear, Norm
from camwright.pipeline.smoothing.energy_spline import Grid
from camwright.pipeline.smoothing.scenario import DesignVariables, Scenario
from camwright.pipeline.smoothing.synthesis_problem import RESERVE


@dataclass(frozen=True, eq=False)
class State:
    """Iterate of a search: coefficients, J, variables, ripple, costs, utilisations.

    Parameters
    ----------
    coefficients : array
    variables : DesignVariables
    ripple : float          greatest weighted ripple of the scenarios
    ripples : array (w,)    weighted ripple of each scenario whose ripple counts or is limited
    excess : array (w,)     of its torque ripple over its ceiling; -inf: it has none
    cost : float            sum of the costs
    jerk : float
    utilisation : mapping   greatest of each limit
    pointwise : mapping     of limits and costs, by scenario and angle, (s, n); (1, n) of the shape
    means : mapping         of limits and costs from means over the turn, (r,)
    members : mapping       whether a scenario counts in each of those, (r, s)
    grid : Grid             cam angles (n,) of the limits: points, extra angles, reversals
    stack : Scenario        stacked scenarios (s, n) there
    """

    coefficients: Array
    variables: DesignVariables
    ripple: float
    ripples: Array
    excess: Array
    cost: float
    jerk: float
    utilisation: Mapping[str, float]
    pointwise: Mapping[str, Array]
    means: Mapping[str, Array]
    members: Mapping[str, NDArray[np.bool_]]
    grid: Grid
    stack: Scenario

    def merit(self, penalty: float, ripple_weight: float) -> float:
        """Merit function: ripple, costs, jerk and penalised violations."""
        return ripple_weight * (self.ripple + self.cost) + self.jerk + penalty * self.violation

    @property
    def violation(self) -> float:
        """Sum over the limits of the excess over their reserve."""
        return sum(max(0.0, value - 1.0 + RESERVE) for value in self.utilisation.values())


class Summit(NamedTuple):
    """Maximum lift, m, with derivatives by the coefficients and by k, P, r0."""

    lift: float
    entries: Array
    columns: NDArray[np.intp]
    shared: Array


class Model(NamedTuple):
    """Linear model at a state: ripple cones, limit rows, Hessian and gradient of the jerk.

    means: by limit the scenarios (s,) and the derivatives (m, size) of their means over the turn by
    the scaled unknowns.
    """

    summit: Summit
    norms: list[Norm]
    limits: list[Linear]
    means: Mapping[str, tuple[NDArray[np.intp], Array]]
    curvature: Array
    slope: Array
    idle: IdleForces | None = None

    def slopes_of(self, name: str, scenarios: NDArray[np.intp]) -> Array | None:
        """Derivatives (m, size), by the scaled unknowns, of the means over the turn from which a
        limit is evaluated; None where the model lacks those of a scenario.

        Parameters
        ----------
        name : str          of the limit
        scenarios : array   ascending indices of the scenarios whose means are wanted
        """
        if name not in self.means:
            return None
        modelled, slopes = self.means[name]
        if not np.isin(scenarios, modelled).all():
            return None
        by_scenario = slopes.reshape(-1, modelled.size, slopes.shape[1])
        return by_scenario[:, np.searchsorted(modelled, scenarios)].reshape(-1, slopes.shape[1])
