"""A place of a search and the linear models there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.cone_program import Norm, Rows
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import RESERVE


@dataclass(frozen=True, eq=False)
class State:
    """A place in the search: coefficients, variables, and all that depends on them."""

    coefficients: Array
    variables: DesignVariables
    ripple: float
    jerk: float
    utilisation: dict[str, float]

    def merit(self, penalty: float, ripple_weight: float) -> float:
        """What the descent lowers: ripple, jerk, and how far each limit is passed."""
        over = sum(max(0.0, value - 1.0 + RESERVE) for value in self.utilisation.values())
        return ripple_weight * self.ripple + self.jerk + penalty * over


@dataclass(frozen=True, eq=False)
class Linear:
    """A limit near a state: level (m,), entries (m, w) in the columns (m, w) of the unknowns."""

    name: str
    level: Array
    entries: Array
    columns: NDArray[np.intp]
    elastic: bool = True

    def at(self, step: Array) -> Array:
        """The model at a step, (m,)."""
        return np.asarray(self.level + np.sum(self.entries * step[self.columns], axis=1))

    def highest(self, reach: Array) -> Array:
        """The most that the model can come to while each unknown moves by its reach, (m,)."""
        return np.asarray(self.level + np.sum(np.abs(self.entries) * reach[self.columns], axis=1))

    def matrix(self, chosen: NDArray[np.bool_], size: int) -> csr_array:
        """The entries of some rows, (rows, size)."""
        entries, columns = self.entries[chosen], self.columns[chosen]
        starts = np.arange(len(entries) + 1) * self.entries.shape[1]
        return csr_array((entries.ravel(), columns.ravel(), starts), shape=(len(entries), size))

    def rows(self, chosen: NDArray[np.bool_], size: int) -> Rows:
        return Rows(self.name, self.level[chosen], self.matrix(chosen, size), self.elastic)


class Model(NamedTuple):
    """A synthesis near a state: ripples, limits, and the jerk's curvature and slope."""

    norms: list[Norm]
    limits: list[Linear]
    curvature: Array
    slope: Array


class Summit(NamedTuple):
    """The greatest lift, m, and its derivatives by the coefficients and by k, P, r0."""

    lift: float
    entries: Array
    columns: NDArray[np.intp]
    shared: Array
