"""Convex programs with linear limits and second-order cones, solved by Clarabel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import clarabel
import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import TORQUE_REDUCTION

_ACCEPTED = ("Solved", "AlmostSolved")


@dataclass(frozen=True, eq=False)
class Rows:
    """Linear constraints of one limit: level + slopes @ x <= slack; level (m,), slopes (m, n)."""

    name: str
    level: Array
    slopes: scipy.sparse.csr_array
    elastic: bool = True


@dataclass(frozen=True, eq=False)
class Norm:
    """A ripple |level + slopes @ x|, (m,) and (m, n): in the objective, bounded, or both.

    number: of the weighted scenario.
    """

    level: Array
    slopes: Array
    weight: float = 1.0
    ceiling: float | None = None
    number: int = 0


@dataclass(frozen=True, eq=False)
class Reach:
    """Trust region |slopes @ x| <= bound; slopes (m, w) of the first unknowns."""

    slopes: Array
    bound: float


@dataclass(frozen=True, eq=False)
class ConeSolution:
    """Solution of a convex program: unknowns x, slack by limit, multipliers.

    rows: multipliers (m,) of each of the rows, in their order; norms: of each norm in the objective
    and of its ceiling.
    """

    step: Array
    ripple: float
    slack: dict[str, float]
    rows: list[Array]
    norms: list[tuple[float, float]]
    objective: float


class Cones:
    """Convex program of `size` unknowns x: linear and quadratic cost, constraints.

    References
    ----------
    Goulart and Chen, Clarabel: an interior-point solver for conic programs (2024).
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.cost = np.zeros(size)
        self._quadratic = np.zeros((size, size))
        self._linear: list[tuple[scipy.sparse.csr_array, Array]] = []
        self._cones: list[tuple[scipy.sparse.csr_array, Array, int]] = []

    def columns(self, matrix: scipy.sparse.csr_array, start: int) -> scipy.sparse.csr_array:
        """Matrix (m, size) of all unknowns from one (m, w) of those from `start` on."""
        parts = (matrix.data, matrix.indices + start, matrix.indptr)
        return scipy.sparse.csr_array(parts, shape=(matrix.shape[0], self.size))

    def charge(self, slopes: ArrayLike, start: int = 0) -> None:
        """Add slopes (w,) @ x to the cost."""
        part = np.atleast_1d(np.asarray(slopes, dtype=float))
        self.cost[start : start + part.size] += part

    def charge_square(self, curvature: Array) -> None:
        """Add x' H x / 2 to the cost; H (w, w), of the first unknowns, positive semidefinite."""
        width = len(curvature)
        self._quadratic[:width, :width] += curvature

    def at_most(self, matrix: scipy.sparse.csr_array, bound: ArrayLike) -> None:
        """matrix (m, size) @ x <= bound (m,)."""
        self._linear.append((matrix, np.broadcast_to(bound, matrix.shape[:1])))

    def norm_at_most(
        self, slopes: Array, level: Array, variable: int | None, ceiling: float = 0.0
    ) -> None:
        """|level + slopes @ x| <= ceiling + x[variable]; slopes (m, w) of the first unknowns."""
        block = np.zeros((level.size + 1, self.size))
        if variable is not None:
            block[0, variable] = -1.0
        block[1:, : slopes.shape[1]] = -slopes
        side = np.concatenate([[ceiling], level])
        self._cones.append((scipy.sparse.csr_array(block), side, side.size))

    def square_at_most(
        self, matrix: scipy.sparse.csr_array, room: scipy.sparse.csr_array, level: float
    ) -> None:
        """(matrix @ x)^2 <= level + room @ x, row by row, each (m, size)."""
        rows = matrix.shape[0]
        stacked = scipy.sparse.vstack([-room, -room, -2.0 * matrix], format="csr")
        side = np.concatenate([np.full(rows, level + 1.0), np.full(rows, level - 1.0),
                               np.zeros(rows)])  # fmt: skip
        order = np.arange(3 * rows).reshape(3, rows).T.ravel()
        self._cones.append((stacked[order], side[order], 3))

    def solved(self) -> tuple[Array, Array, float] | None:
        """x, multipliers of the linear constraints in order, cost; None if not solved."""
        blocks = [block for block, _ in self._linear] + [block for block, _, _ in self._cones]
        sides = [side for _, side in self._linear] + [side for _, side, _ in self._cones]
        linear = sum(side.size for _, side in self._linear)
        cones = [clarabel.NonnegativeConeT(linear)]
        for _, side, height in self._cones:
            cones += [clarabel.SecondOrderConeT(height)] * (side.size // height)
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1
        matrix = scipy.sparse.csc_array(scipy.sparse.vstack(blocks, format="csc"))
        matrix.sum_duplicates()
        result = clarabel.DefaultSolver(
            scipy.sparse.csc_array(np.triu(self._quadratic)), self.cost, matrix,
            np.concatenate(sides),
            cones, settings,
        ).solve()  # fmt: skip
        if str(result.status) not in _ACCEPTED:
            return None
        return np.asarray(result.x), np.asarray(result.z)[:linear], float(result.obj_val)


def solved(
    norms: Sequence[Norm],
    rows: Sequence[Rows],
    curvature: Array,
    slope: Array,
    box: Array,
    penalty: float,
    ripple_weight: float = 1.0,
    reach: Reach | None = None,
) -> ConeSolution | None:
    """Least ripple_weight max(weight |norm|) + x'Hx/2 + h'x + penalty (sum of slacks).

    Parameters
    ----------
    norms : sequence of Norm   the greatest is minimised; those with a ceiling stay below it
    rows : sequence of Rows    rows of one limit share one slack: its penalty is exact
    curvature, slope : arrays (n, n), (n,)   H, positive semidefinite, and h
    box : array (2, n)         least and greatest x
    penalty : float            of a unit of slack
    reach : Reach              trust region within the box; None: the box alone

    Returns
    -------
    ConeSolution or None   None when not solved, as with conflicting hard constraints

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 14.3: the exact penalty.
    """
    size = slope.size
    names = list(dict.fromkeys(row.name for row in rows if row.elastic))
    if any(norm.ceiling is not None for norm in norms):
        names.append(TORQUE_REDUCTION.id)
    bounded = size + 1 + len(names)
    program = Cones(bounded + len(norms))  # x, ripple, slacks, bound of each norm
    program.charge_square(curvature)
    program.charge(np.concatenate([slope, [ripple_weight], np.full(len(names), penalty)]))
    for row in rows:
        matrix = program.columns(row.slopes, 0)
        if row.elastic:
            relief = scipy.sparse.csr_array(np.ones((row.level.size, 1)))
            matrix = matrix - program.columns(relief, size + 1 + names.index(row.name))
        program.at_most(matrix, -row.level)
    identity = scipy.sparse.eye_array(program.size, format="csr")
    for k, norm in enumerate(norms):
        bound = identity[[bounded + k]]
        program.at_most(norm.weight * bound - identity[[size]], 0.0)
        if norm.ceiling is not None:
            program.at_most(bound - identity[[bounded - 1]], norm.ceiling)
    program.at_most(identity[:size], box[1])
    program.at_most(-identity[:size], -box[0])
    program.at_most(-identity[size + 1 : bounded], 0.0)
    if reach is not None:
        rows_of = reach.slopes.shape[0]
        program.norm_at_most(reach.slopes, np.zeros(rows_of), None, reach.bound)
    for k, norm in enumerate(norms):
        program.norm_at_most(norm.slopes, norm.level, bounded + k)
    result = program.solved()
    if result is None:
        return None
    values, duals, objective = result
    parts = np.split(duals, np.cumsum([row.level.size for row in rows]))
    cones = iter(parts[-1])
    return ConeSolution(
        step=values[:size],
        ripple=float(values[size]),
        slack={name: float(values[size + 1 + k]) for k, name in enumerate(names)},
        rows=parts[:-1],
        norms=[
            (float(next(cones)), float(next(cones)) if norm.ceiling is not None else 0.0)
            for norm in norms
        ],
        objective=objective,
    )
