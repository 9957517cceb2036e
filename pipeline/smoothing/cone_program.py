"""Second-order cone programs with linear and quadratic terms, solved by Clarabel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import clarabel
import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.case.limits import TORQUE_REDUCTION

_ACCEPTED = ("Solved", "AlmostSolved")
_FIRST_NORMS = 4  # norms that enter a program at first
_NORM_TOLERANCE = 1e-7  # of a norm over its bound, ten times the tolerance of the solver


@dataclass(frozen=True, eq=False)
class Linear:
    """Linear rows of one limit: level + entries @ x[columns] <= slack; (m,), (m, w).

    scenario, point (m,): of each row. mean: from means over the turn; the scenario is the number of
    the utilisation, the point -1. A cost has its greatest row in the objective, a row that is not
    elastic has no slack.
    """

    name: str
    level: Array
    entries: Array
    columns: NDArray[np.intp]
    scenario: NDArray[np.intp]
    point: NDArray[np.intp]
    mean: bool = False
    elastic: bool = True
    cost: bool = False

    def change(self, step: Array) -> Array:
        """Change after a step, (m,)."""
        return np.asarray(np.sum(self.entries * step[self.columns], axis=1))


@dataclass(frozen=True, eq=False)
class Norm:
    """Ripple |level + slopes @ x| as a cone, (m,) and (m, n): minimised, bounded, or both.

    number: of the weighted scenario.
    """

    level: Array
    slopes: Array
    weight: float = 1.0
    ceiling: float | None = None
    number: int = 0

    def after(self, step: Array) -> float:
        """Norm after a step."""
        return float(np.linalg.norm(self.level + self.slopes @ step[: self.slopes.shape[1]]))


@dataclass(frozen=True, eq=False)
class Reach:
    """Trust-region cone |slopes @ x| <= bound; slopes (m, w) of the first unknowns.

    still (e, w): rows of them that no step changes; None: none.
    """

    slopes: Array
    bound: float
    still: Array | None = None


@dataclass(frozen=True, eq=False)
class IdleForces:
    """Forces y on the track that does not carry, further unknowns of a cone program after x: y >= 0
    and y >= level + entries @ x[columns]; (m,), (m, w).

    by_torque : array         change of the crank torque at its angle by y, N m
    by_loss : array           that of the charged friction
    scenario, point : array   of each force
    """

    level: Array
    entries: Array
    columns: NDArray[np.intp]
    by_torque: Array
    by_loss: Array
    scenario: NDArray[np.intp]
    point: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class ConeSolution:
    """Solution of a cone program: step x, slack by limit, multipliers.

    unknowns: x, and forces of the track that does not carry, see `IdleForces`.
    rows: multipliers (m,) of each of the rows, in their order; norms: of each norm in the objective
    and of its ceiling.
    """

    step: Array
    ripple: float
    slack: dict[str, float]
    rows: list[Array]
    norms: list[tuple[float, float]]
    objective: float
    unknowns: Array


class _Block(NamedTuple):
    """Entries of a matrix by row and column, (e,), and the right side (m,)."""

    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    values: Array
    side: Array

    @classmethod
    def of(cls, matrix: scipy.sparse.csr_array, side: ArrayLike) -> _Block:
        """Entries of a sparse matrix."""
        rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
        right_side = np.broadcast_to(np.asarray(side, dtype=float), matrix.shape[:1])
        return cls(rows, matrix.indices.astype(np.intp), matrix.data, right_side)


class Cones:
    """Builder of a cone program in `size` unknowns: costs and constraints.

    References
    ----------
    Goulart and Chen, Clarabel: an interior-point solver for conic programs (2024).
    """

    def __init__(self, size: int) -> None:
        self.size = size
        self.cost = np.zeros(size)
        self._quadratic = np.zeros((size, size))
        self._linear: list[_Block] = []
        self._cones: list[tuple[_Block, int]] = []

    def columns(self, matrix: scipy.sparse.csr_array, start: int) -> scipy.sparse.csr_array:
        """Matrix (m, size) in all unknowns from a matrix (m, w) in those from `start` on."""
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
        self._linear.append(_Block.of(matrix, bound))

    def rows_at_most(self, entries: ArrayLike, columns: NDArray[np.intp], bound: ArrayLike) -> None:
        """Add m linear constraints with w unknowns each: sum over w of entries x[columns] <= bound.

        Parameters
        ----------
        entries : array (m, w)   coefficients
        columns : array (m, w)   indices of the unknowns
        bound : array (m,)       right-hand sides
        """
        rows = np.broadcast_to(np.arange(len(columns))[:, None], columns.shape)
        values = np.broadcast_to(np.asarray(entries, dtype=float), columns.shape)
        side = np.broadcast_to(np.asarray(bound, dtype=float), (len(columns),))
        self._linear.append(_Block(rows.ravel(), columns.ravel(), values.ravel(), side))

    def norm_at_most(
        self, slopes: Array, level: Array, variable: int | None, ceiling: float = 0.0
    ) -> None:
        """Add the second-order cone |level + slopes @ x[:w]| <= ceiling + x[variable].

        Parameters
        ----------
        slopes : array (m, w)    by the first w unknowns
        level : array (m,)       constant part
        variable : int or None   index of the unknown that bounds the norm; None: the ceiling alone
        ceiling : float          constant bound
        """
        rows, columns = np.nonzero(slopes)
        values = -slopes[rows, columns]
        rows = rows + 1
        if variable is not None:
            rows, columns = np.append(rows, 0), np.append(columns, variable)
            values = np.append(values, -1.0)
        side = np.concatenate([[ceiling], level])
        self._cones.append((_Block(rows, columns, values, side), side.size))

    def zero(self, slopes: Array) -> None:
        """slopes (m, w) @ x[:w] = 0."""
        rows, columns = np.nonzero(slopes)
        side = np.zeros(len(slopes))
        self._cones.append((_Block(rows, columns, slopes[rows, columns], side), 0))

    def square_at_most(
        self, matrix: scipy.sparse.csr_array, room: scipy.sparse.csr_array, level: float
    ) -> None:
        """Add m cones, one per row: (matrix @ x)^2 <= level + room @ x.

        Parameters
        ----------
        matrix, room : sparse arrays (m, size)   by all unknowns
        level : float                            the same in each row
        """
        rows = matrix.shape[0]
        stacked = scipy.sparse.vstack([-room, -room, -2.0 * matrix], format="csr")
        side = np.concatenate([np.full(rows, level + 1.0), np.full(rows, level - 1.0),
                               np.zeros(rows)])  # fmt: skip
        order = np.arange(3 * rows).reshape(3, rows).T.ravel()
        self._cones.append((_Block.of(stacked[order], side[order]), 3))

    def solved(self) -> tuple[Array, Array, float] | None:
        """Optimum of the program: x (size,), multipliers of the linear constraints in the order
        added, least cost; None where the solver finds none.

        Solved with unscaled data first, then with the equilibration of the solver.
        """
        blocks = [*self._linear, *(block for block, _ in self._cones)]
        linear = sum(block.side.size for block in self._linear)
        cones = [clarabel.NonnegativeConeT(linear)]
        for block, height in self._cones:
            count = block.side.size
            square = [clarabel.SecondOrderConeT(height)] * (count // height) if height else None
            cones += [clarabel.ZeroConeT(count)] if square is None else square
        starts = np.cumsum([0, *(block.side.size for block in blocks)])
        rows = [block.rows + start for block, start in zip(blocks, starts, strict=False)]
        columns, values = (
            np.concatenate([getattr(block, name) for block in blocks])
            for name in ("columns", "values")
        )
        matrix = scipy.sparse.csc_array(
            (values, (np.concatenate(rows), columns)), shape=(int(starts[-1]), self.size)
        )
        quadratic = scipy.sparse.csc_array(np.triu(self._quadratic))
        side = np.concatenate([block.side for block in blocks])
        # The unknowns are scaled: equilibration takes a third more iterations.
        for equilibrated in (False, True):
            settings = clarabel.DefaultSettings()
            settings.verbose = False
            settings.max_threads = 1
            # With dense cones the supernodal solver that is chosen else takes half as long again.
            settings.direct_solve_method = "qdldl"
            settings.equilibrate_enable = equilibrated
            solver = clarabel.DefaultSolver(quadratic, self.cost, matrix, side, cones, settings)
            result = solver.solve()
            if str(result.status) in _ACCEPTED:
                return np.asarray(result.x), np.asarray(result.z)[:linear], float(result.obj_val)
        return None


def solved(
    norms: Sequence[Norm],
    rows: Sequence[Linear],
    curvature: Array,
    slope: Array,
    box: Array,
    penalty: float,
    ripple_weight: float = 1.0,
    reach: Reach | None = None,
    idle: IdleForces | None = None,
) -> ConeSolution | None:
    """Step of least objective by a cone program: w (max weighted |norm| + costs) + x'Hx/2 + h'x +
    penalty x slacks.

    Parameters
    ----------
    norms : sequence of Norm                 ripples: the greatest weighted one is minimised, those
                                             with a ceiling stay below it
    rows : sequence of Linear                linear models of limits and costs; rows of one limit
                                             share one slack, whose penalty is exact
    curvature, slope : arrays (n, n), (n,)   H, positive semidefinite, and h
    box : array (2, n)                       least and greatest x
    penalty : float                          of a unit of slack
    ripple_weight : float                    w, 0: feasibility alone
    reach : Reach or None                    trust region within the box; None: the box alone
    idle : IdleForces or None            further unknowns of norms and costs

    Returns
    -------
    ConeSolution or None   None when not solved, as with conflicting hard constraints

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 14.3: the exact penalty.
    """
    # Of many norms few bind, and each is a dense cone: the others enter where they are exceeded.
    order = np.argsort([-norm.weight * np.linalg.norm(norm.level) for norm in norms], kind="stable")
    chosen = sorted(order[:_FIRST_NORMS].tolist())
    while True:
        some = [norms[k] for k in chosen]
        solution = _solved(some, rows, curvature, slope, box, penalty, ripple_weight, reach, idle)
        if solution is None:
            return None
        beyond = [k for k, norm in enumerate(norms) if k not in chosen and _exceeds(norm, solution)]
        if not beyond:
            prices = dict(zip(chosen, solution.norms, strict=True))
            return replace(solution, norms=[prices.get(k, (0.0, 0.0)) for k in range(len(norms))])
        chosen = sorted([*chosen, *beyond])


def _exceeds(norm: Norm, solution: ConeSolution) -> bool:
    """Whether a ripple that a cone program left out is, after the step of its solution, above its
    ceiling or, weighted, above the greatest ripple of the program.
    """
    value = norm.after(solution.unknowns)
    allowed = solution.slack.get(TORQUE_REDUCTION.id, 0.0) + _NORM_TOLERANCE
    over = norm.ceiling is not None and value > norm.ceiling + allowed
    return over or norm.weight * value > solution.ripple + _NORM_TOLERANCE


def _solved(
    norms: Sequence[Norm],
    rows: Sequence[Linear],
    curvature: Array,
    slope: Array,
    box: Array,
    penalty: float,
    ripple_weight: float,
    reach: Reach | None,
    idle: IdleForces | None,
) -> ConeSolution | None:
    """Solution of the cone program of `solved`, with the same arguments, with all of `norms` in it;
    None where the solver finds none.
    """
    steps, forces = slope.size, 0 if idle is None else idle.level.size
    size = steps + forces
    costs = list(dict.fromkeys(row.name for row in rows if row.cost))
    names = costs + list(dict.fromkeys(r.name for r in rows if r.elastic and not r.cost))
    if any(norm.ceiling is not None for norm in norms):
        names.append(TORQUE_REDUCTION.id)
    bounded = size + 1 + len(names)
    program = Cones(bounded + len(norms))  # x, ripple, slacks, bound of each norm
    program.charge_square(curvature)
    charges = [ripple_weight] * (1 + len(costs)) + [penalty] * (len(names) - len(costs))
    program.charge(slope)
    program.charge(charges, size)
    for row in rows:
        entries, columns = row.entries, row.columns
        if row.elastic:
            slack = np.full((len(columns), 1), size + 1 + names.index(row.name))
            entries = np.hstack([entries, np.full(slack.shape, -1.0)])
            columns = np.hstack([columns, slack])
        program.rows_at_most(entries, columns, -row.level)
    for k, norm in enumerate(norms):
        program.rows_at_most([[norm.weight, -1.0]], np.array([[bounded + k, size]]), 0.0)
        if norm.ceiling is not None:
            columns = np.array([[bounded + k, bounded - 1]])
            program.rows_at_most([[1.0, -1.0]], columns, norm.ceiling)
    every = np.arange(bounded)[:, None]
    program.rows_at_most(1.0, every[:steps], box[1])
    program.rows_at_most(-1.0, every[:steps], -box[0])
    program.rows_at_most(-1.0, every[size + 1 + len(costs) :], 0.0)
    if reach is not None:
        rows_of = reach.slopes.shape[0]
        program.norm_at_most(reach.slopes, np.zeros(rows_of), None, reach.bound)
        if reach.still is not None:
            program.zero(reach.still)
    if idle is not None:
        program.rows_at_most(-1.0, every[steps:size], 0.0)
        program.rows_at_most(
            np.hstack([idle.entries, np.full((forces, 1), -1.0)]),
            np.hstack([idle.columns, every[steps:size]]),
            -idle.level,
        )
    for k, norm in enumerate(norms):
        program.norm_at_most(norm.slopes, norm.level, bounded + k)
    result = program.solved()
    if result is None:
        return None
    values, duals, objective = result
    parts = np.split(duals, np.cumsum([row.level.size for row in rows]))
    cones = iter(parts[-1])
    return ConeSolution(
        step=values[:steps],
        ripple=float(values[size]),
        slack={name: float(values[size + 1 + k]) for k, name in enumerate(names)},
        rows=parts[:-1],
        norms=[
            (float(next(cones)), float(next(cones)) if norm.ceiling is not None else 0.0)
            for norm in norms
        ],
        objective=objective,
        unknowns=values[:size],
    )
