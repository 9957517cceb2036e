"""The convex program within each step of the synthesis, solved by Clarabel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import clarabel
import numpy as np
from scipy.sparse import csc_array, csr_array, eye_array, hstack, vstack

from geometry.arrays import Array

_ACCEPTED = ("Solved", "AlmostSolved")


@dataclass(frozen=True, eq=False)
class Rows:
    """Linear limits of one name: level + slopes @ x <= slack; level (m,), slopes (m, n)."""

    name: str
    level: Array
    slopes: csr_array
    elastic: bool = True


@dataclass(frozen=True, eq=False)
class Norm:
    """A ripple that is charged or bounded: |level + slopes @ x|, level (m,), slopes (m, n)."""

    level: Array
    slopes: Array
    weight: float = 1.0
    ceiling: float | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """Solution of a convex program: x, slack and multipliers by the name of the limit."""

    step: Array
    ripple: float
    slack: dict[str, float]
    multipliers: dict[str, Array]
    objective: float


def solved(
    norms: Sequence[Norm],
    rows: Sequence[Rows],
    curvature: Array,
    slope: Array,
    box: Array,
    penalty: float,
    ripple_weight: float = 1.0,
) -> Answer | None:
    """Least ripple_weight max(weight |norm|) + x'Hx/2 + h'x + penalty (sum of slacks).

    Parameters
    ----------
    norms : sequence of Norm   the worst of them is charged; those with a ceiling stay below it
    rows : sequence of Rows    rows of one name share one slack, so that its penalty is exact
    curvature, slope : arrays (n, n), (n,)   H, positive semidefinite, and h
    box : array (2, n)         least and greatest x
    penalty : float            of a unit of slack

    Returns
    -------
    Answer or None   None when the program is not solved, as where the hard limits conflict

    References
    ----------
    Goulart and Chen, Clarabel: an interior-point solver for conic programs (2024);
    Fletcher, Practical Methods of Optimization (1987), sec. 14.3: the exact penalty.
    """
    size = slope.size
    names = list(dict.fromkeys(row.name for row in rows if row.elastic))
    bounded = any(norm.ceiling is not None for norm in norms)
    total = size + 1 + len(names) + bounded  # x, ripple, slacks, slack of the ceilings
    blocks, sides, cones = _linear_part(rows, names, total, size, box)
    for norm in norms:
        block, side = _cone(norm.slopes * norm.weight, norm.level * norm.weight, total, size, None)
        blocks.append(block)
        sides.append(side)
        cones.append(clarabel.SecondOrderConeT(side.size))
        if norm.ceiling is not None:
            block, side = _cone(norm.slopes, norm.level, total, total - 1, norm.ceiling)
            blocks.append(block)
            sides.append(side)
            cones.append(clarabel.SecondOrderConeT(side.size))
    cost = np.concatenate([slope, [ripple_weight], np.full(total - size - 1, penalty)])
    quadratic = np.zeros((total, total))
    quadratic[:size, :size] = np.triu(curvature)
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    found = clarabel.DefaultSolver(
        csc_array(quadratic), cost, vstack(blocks, format="csc"), np.concatenate(sides),
        cones, settings,
    ).solve()  # fmt: skip
    if str(found.status) not in _ACCEPTED:
        return None
    values, duals = np.asarray(found.x), np.asarray(found.z)
    return _answer(values, duals, rows, names, size, float(found.obj_val), bounded)


def _linear_part(
    rows: Sequence[Rows], names: list[str], total: int, size: int, box: Array
) -> tuple[list[csr_array], list[Array], list[object]]:
    blocks, sides = [], []
    for row in rows:
        height = row.level.size
        right = csr_array((height, total - size))
        if row.elastic:
            place = 1 + names.index(row.name)
            right = csr_array(
                (-np.ones(height), (np.arange(height), np.full(height, place))),
                shape=(height, total - size),
            )
        blocks.append(hstack([row.slopes, right], format="csr"))
        sides.append(-row.level)
    identity = eye_array(total, format="csr")
    blocks += [identity[:size], -identity[:size], -identity[size + 1 :]]
    sides += [box[1], -box[0], np.zeros(total - size - 1)]
    return blocks, sides, [clarabel.NonnegativeConeT(sum(side.size for side in sides))]


def _cone(
    slopes: Array, level: Array, total: int, bound: int, ceiling: float | None
) -> tuple[csr_array, Array]:
    """|level + slopes x| <= the variable `bound`, with the ceiling on top where there is one."""
    block = np.zeros((level.size + 1, total))
    block[0, bound] = -1.0
    block[1:, : slopes.shape[1]] = -slopes
    return csr_array(block), np.concatenate([[ceiling or 0.0], level])


def _answer(
    values: Array,
    duals: Array,
    rows: Sequence[Rows],
    names: list[str],
    size: int,
    objective: float,
    bounded: bool,
) -> Answer:
    multipliers: dict[str, Array] = {}
    start = 0
    for row in rows:
        part = duals[start : start + row.level.size]
        multipliers[row.name] = np.concatenate([multipliers.get(row.name, np.zeros(0)), part])
        start += row.level.size
    slack = {name: float(values[size + 1 + k]) for k, name in enumerate(names)}
    if bounded:
        slack["torque_reduction"] = float(values[-1])
    return Answer(
        step=values[:size],
        ripple=float(values[size]),
        slack=slack,
        multipliers=multipliers,
        objective=objective,
    )
