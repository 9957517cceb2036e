"""State of a search, and the linear models of its functions there."""

from __future__ import annotations

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
    """Coefficients, J, and variables, with ripple, jerk term and utilisations."""

    coefficients: Array
    variables: DesignVariables
    ripple: float
    jerk: float
    utilisation: dict[str, float]

    def merit(self, penalty: float, ripple_weight: float) -> float:
        """Merit function: ripple, jerk and penalised violations."""
        over = sum(max(0.0, value - 1.0 + RESERVE) for value in self.utilisation.values())
        return ripple_weight * self.ripple + self.jerk + penalty * over


@dataclass(frozen=True, eq=False)
class Linear:
    """Linear model of a limit: level (m,), entries (m, w) in the columns (m, w) of x."""

    name: str
    level: Array
    entries: Array
    columns: NDArray[np.intp]
    elastic: bool = True

    def at(self, step: Array) -> Array:
        """Value after a step, (m,)."""
        return np.asarray(self.level + np.sum(self.entries * step[self.columns], axis=1))

    def highest(self, reach: Array) -> Array:
        """Greatest value for steps of at most `reach` in each unknown, (m,)."""
        return np.asarray(self.level + np.sum(np.abs(self.entries) * reach[self.columns], axis=1))

    def matrix(self, chosen: NDArray[np.bool_], size: int) -> scipy.sparse.csr_array:
        """Chosen rows as a sparse matrix, (rows, size)."""
        entries, columns = self.entries[chosen], self.columns[chosen]
        starts = np.arange(len(entries) + 1) * self.entries.shape[1]
        return scipy.sparse.csr_array(
            (entries.ravel(), columns.ravel(), starts), shape=(len(entries), size)
        )

    def rows(self, chosen: NDArray[np.bool_], size: int) -> Rows:
        """Chosen rows as constraints of a program."""
        return Rows(self.name, self.level[chosen], self.matrix(chosen, size), self.elastic)


class Model(NamedTuple):
    """Models at a state: ripples, limits; Hessian and slope of the jerk term."""

    norms: list[Norm]
    limits: list[Linear]
    curvature: Array
    slope: Array


class Summit(NamedTuple):
    """Maximum lift, m, and its derivatives by the coefficients and by k, P, r0."""

    lift: float
    entries: Array
    columns: NDArray[np.intp]
    shared: Array
