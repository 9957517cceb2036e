"""State of a search, and the linear models of its functions there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cone_program import Norm, Rows
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import RESERVE


@dataclass(frozen=True, eq=False)
class State:
    """Coefficients, J, and variables, with ripple, jerk term and utilisations.

    Parameters
    ----------
    coefficients : array
    variables : DesignVariables
    ripple : float          greatest weighted ripple of the scenarios
    ripples : array (w,)    ripple of each weighted scenario
    jerk : float
    utilisation : mapping   greatest of each limit
    pointwise : mapping     of a limit, by scenario and angle, (s, n); (1, n) of the shape
    means : mapping         of a limit on a mean over the turn, by scenario, (s,)
    """

    coefficients: Array
    variables: DesignVariables
    ripple: float
    ripples: Array
    jerk: float
    utilisation: Mapping[str, float]
    pointwise: Mapping[str, Array]
    means: Mapping[str, Array]

    def merit(self, penalty: float, ripple_weight: float) -> float:
        """Merit function: ripple, jerk and penalised violations."""
        return ripple_weight * self.ripple + self.jerk + penalty * self.violation

    @property
    def violation(self) -> float:
        """Sum of the excess of each limit over its reserve."""
        return sum(max(0.0, value - 1.0 + RESERVE) for value in self.utilisation.values())


@dataclass(frozen=True, eq=False)
class Linear:
    """Linear model of rows of a limit: level (m,), entries (m, w) in the columns (m, w) of x.

    scenario, point (m,): of each row, -1 for a mean over the turn; power: of that mean.
    """

    name: str
    level: Array
    entries: Array
    columns: NDArray[np.intp]
    scenario: NDArray[np.intp]
    point: NDArray[np.intp]
    power: float | None = None
    elastic: bool = True

    def change(self, step: Array) -> Array:
        """Change after a step, (m,)."""
        return np.asarray(np.sum(self.entries * step[self.columns], axis=1))

    def rows(self, size: int) -> Rows:
        """The rows as constraints of a program."""
        starts = np.arange(len(self.entries) + 1) * self.entries.shape[1]
        matrix = scipy.sparse.csr_array(
            (self.entries.ravel(), self.columns.ravel(), starts), shape=(len(self.entries), size)
        )
        return Rows(self.name, self.level, matrix, self.elastic)


class Summit(NamedTuple):
    """Maximum lift, m, and its derivatives by the coefficients and by k, P, r0."""

    lift: float
    entries: Array
    columns: NDArray[np.intp]
    shared: Array


class Model(NamedTuple):
    """Models at a state: ripples, rows of limits; Hessian and slope of the jerk term."""

    summit: Summit
    norms: list[Norm]
    limits: list[Linear]
    curvature: Array
    slope: Array
