"""Frictionless contact under a prescribed force as a linear complementarity problem.

Pressures p and approach d satisfy

    gap = C p + g - d m >= 0,   p >= 0,   p . gap = 0,   m . p = F,

where C is the pressure compliance (symmetric, positive definite on pressures of zero
resultant), g the weighted initial gap and m the integrals of the pressure shapes. Under a
prescribed moment M the gap has a further term - t l, with the tilt t and the moments l of the
shapes, and l . p = M. No penalty parameter enters. Problems that differ in gap, force and moment
alone are solved together: those with the same active set share one factorisation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, alike, freeze
from camwright.geometry.errors import ContactError

_SWEEPS = 60
# Relative magnitude of pressure or gap below which its sign is round-off.
_SIGN_ROUND_OFF = 1e-11
_COMPLEMENTARITY = 1e-9


@dataclass(frozen=True, eq=False)
class Complementarity:
    """Solution of `count` contact problems: pressures, approach, residuals.

    pressure (count, n) Pa, gap (count, n) weighted, approach (count,), tilt (count,), zero
    without a prescribed moment; equilibrium (count,) |m.p - F| / F, of a moment |l.p - M| over
    F and the longest lever where that is larger; complementarity (count,) worst violation of the
    signs and of p.gap = 0, relative to the largest pressure and gap.
    """

    pressure: Array
    gap: Array
    approach: Array
    tilt: Array
    equilibrium: Array
    complementarity: Array

    def __post_init__(self) -> None:
        names = ("pressure", "gap", "approach", "tilt", "equilibrium", "complementarity")
        freeze(self, **{name: getattr(self, name) for name in names})


def solve(
    compliance: ArrayLike,
    gap: ArrayLike,
    shape_integrals: ArrayLike,
    force: ArrayLike,
    guess: ArrayLike | None = None,
    *,
    levers: ArrayLike | None = None,
    moment: ArrayLike = 0.0,
) -> Complementarity:
    """Contact pressures under prescribed forces and moments, by a primal-dual active set method.

    In any consistent units; `count` problems with n pressure shapes each.

    Parameters
    ----------
    compliance : array (n, n)      displacement under unit pressures, integrated with the shapes
    gap : array (count, n)         initial gap, integrated with the shapes
    shape_integrals : array (n,)   resultant of a unit pressure on each knot
    force : array (count,)         prescribed resultant, > 0
    guess : array (n,) of bool     initial active set; the solution does not depend on it
    levers : array (n,)            moments of the shapes; without them no moment is prescribed
    moment : array (count,)        prescribed with `levers`

    Raises
    ------
    ContactError
        If a problem has no finite solution, or complementarity is not met to 1e-9.

    References
    ----------
    Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003) 865 (primal-dual active set). A
    problem whose active set recurs is solved by the primal method, which cannot cycle.
    """
    g = np.atleast_2d(np.asarray(gap, dtype=float))
    count, size = g.shape
    C, m = np.asarray(compliance, dtype=float), np.asarray(shape_integrals, dtype=float)
    F = np.broadcast_to(np.asarray(force, dtype=float), (count,))
    # Each problem is scaled to pressures and gaps of order 1.
    pressure_scale = F / m.sum()
    softness = np.abs(np.diagonal(C)).max()
    gap_scale = softness * pressure_scale
    C, g = C / softness, g / gap_scale[:, None]
    weights, targets, lever = m[:, None] / m.sum(), np.ones((count, 1)), 1.0
    if levers is not None:
        arms = np.asarray(levers, dtype=float)
        lever = float(np.abs(arms / m).max())
        weights = np.column_stack([weights, arms / (lever * m.sum())])
        targets = np.column_stack(
            [targets, np.broadcast_to(np.asarray(moment, dtype=float), (count,)) / (F * lever)]
        )

    start = np.ones(size, dtype=bool) if guess is None else np.asarray(guess, dtype=bool)
    p, d = _together(C, g, weights, targets, start)
    settlement = p @ C.T
    residual_gap = settlement + g - d @ weights.T
    largest = np.maximum(p.max(axis=1), 1e-300)
    # With all knots in contact the gap is the round-off of the terms that cancel in it.
    gap_largest = np.maximum(np.abs(residual_gap), 1e-3 * np.abs(settlement)).max(axis=1)
    gap_largest = np.maximum(gap_largest, 1e-300)
    violation = np.max(
        [
            np.maximum(-p, 0).max(axis=1) / largest,
            np.maximum(-residual_gap, 0).max(axis=1) / gap_largest,
            np.abs(p * residual_gap).max(axis=1) / (largest * gap_largest),
        ],
        axis=0,
    )
    if not violation.max(initial=0.0) <= _COMPLEMENTARITY:
        raise ContactError(
            f"complementarity = {violation.max():.1e}, must be <= {_COMPLEMENTARITY:.0e}"
        )
    return Complementarity(
        pressure=p * pressure_scale[:, None],
        gap=residual_gap * gap_scale[:, None],
        approach=d[:, 0] * gap_scale / m.sum(),
        tilt=d[:, 1:].sum(axis=1) * gap_scale / (m.sum() * lever),
        equilibrium=np.abs(p @ weights - targets).max(axis=1),
        complementarity=violation,
    )


def _together(
    C: Array, g: Array, weights: Array, targets: Array, start: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Pressures (count, n) and rigid motions (count, k) of all problems by primal-dual sweeps at
    once; those that do not settle by `_primal`. All inputs are scaled to order 1.

    Parameters
    ----------
    C : array (n, n)             compliance
    g : array (count, n)         weighted initial gap
    weights : array (n, k)       resultants of a unit pressure on each knot: force, with k = 2
        moment
    targets : array (count, k)   prescribed resultants
    start : array (n,) of bool   knots in contact at first; all if none is
    """
    count, size = g.shape
    pressures, motions = np.zeros((count, size)), np.zeros(targets.shape)
    unsettled = np.arange(count)
    active = np.tile(start if start.any() else np.ones_like(start), (count, 1))
    seen: list[set[bytes]] = [set() for _ in range(count)]
    stragglers: list[int] = []
    for _ in range(_SWEEPS):
        if unsettled.size == 0:
            break
        current = active[unsettled]
        p, d = _equality_solutions(C, g[unsettled], weights, targets[unsettled], current)
        gaps = p @ C.T + g[unsettled] - d @ weights.T
        tolerance_p = _SIGN_ROUND_OFF * np.abs(p).max(axis=1, keepdims=True)
        tolerance_g = _SIGN_ROUND_OFF * np.abs(gaps).max(axis=1, keepdims=True)
        updated = (current & (p > -tolerance_p)) | (~current & (gaps < -tolerance_g))
        changed = (updated != current).any(axis=1)
        pressures[unsettled], motions[unsettled] = p, d
        active[unsettled] = updated
        remaining = []
        for row in np.flatnonzero(changed):
            case, key = int(unsettled[row]), np.packbits(updated[row]).tobytes()
            if key in seen[case] or not _determined(weights, updated[row]):
                stragglers.append(case)
            else:
                seen[case].add(key)
                remaining.append(case)
        unsettled = np.array(remaining, dtype=int)
    for case in [*stragglers, *unsettled.tolist()]:
        pressures[case], motions[case] = _primal(C, g[case], weights, targets[case])
    return np.maximum(pressures, 0), motions


def _determined(weights: Array, active: NDArray[np.bool_]) -> bool:
    """Whether the active pressures can balance any force and moment."""
    on = weights[active]
    return bool(active.any() and np.linalg.matrix_rank(on) == weights.shape[1])


def _equality_solutions(
    C: Array, g: Array, weights: Array, targets: Array, active: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Pressures (count, n) and rigid motions (count, k) with zero gap where `active` (count, n),
    zero pressure elsewhere; other inputs as those of `_together`.

    Raises
    ------
    ContactError
        If the compliance is singular.
    """
    pressures, motions = np.zeros_like(g), np.zeros(targets.shape)
    for rows in alike(active.T):
        knots = np.flatnonzero(active[rows[0]])
        few, on = knots.size, weights[knots]
        system = np.zeros((few + on.shape[1], few + on.shape[1]))
        system[:few, :few] = C[np.ix_(knots, knots)]
        system[:few, few:], system[few:, :few] = -on, on.T
        right = np.concatenate([-g[np.ix_(rows, knots)].T, targets[rows].T])
        try:
            solution = np.linalg.solve(system, right)
        except np.linalg.LinAlgError as error:
            raise ContactError("the pressure compliance is singular") from error
        pressures[np.ix_(rows, knots)], motions[rows] = solution[:few].T, solution[few:].T
    return pressures, motions


def _primal(C: Array, g: Array, weights: Array, targets: Array) -> tuple[Array, Array]:
    """Pressures (n,) and rigid motion (k,) of one problem by the primal active-set method; the
    energy decreases, so no set recurs.

    Parameters
    ----------
    C : array (n, n)         compliance
    g : array (n,)           weighted initial gap
    weights : array (n, k)   resultants of a unit pressure on each knot
    targets : array (k,)     prescribed resultants

    Raises
    ------
    ContactError
        If it does not converge, or the force acts beyond the end of the contact.
    """
    p = _balanced(weights, targets)
    active = np.ones(g.size, dtype=bool)
    for _ in range(20 * g.size):
        solved = _equality_solutions(C, g[None], weights, targets[None], active[None])
        target, d = solved[0][0], solved[1][0]
        falling = active & (target < 0)
        if falling.any():
            steps = np.where(falling, p / np.where(falling, p - target, 1), np.inf)
            first = int(np.argmin(steps))
            p = p + min(1.0, steps[first]) * (target - p)
            p[first] = 0.0
            active[first] = False
            continue
        p = target
        gaps = C @ p + g - weights @ d
        gaps[active] = 0.0
        worst = int(np.argmin(gaps))
        if gaps[worst] >= -_SIGN_ROUND_OFF * max(np.abs(gaps).max(), 1e-300):
            return p, d
        active[worst] = True
    raise ContactError("contact pressures: active set not converged")


def _balanced(weights: Array, targets: Array) -> Array:
    """Pressures (n,), >= 0, of the prescribed resultants `targets` (k,): uniform, and with a moment
    a point pressure at one end.

    Parameters
    ----------
    weights : array (n, k)   resultants of a unit pressure on each knot: force, with k = 2 moment

    Raises
    ------
    ContactError
        If the force acts beyond the end of the contact.
    """
    uniform = np.full(len(weights), 1 / weights[:, 0].sum())
    if weights.shape[1] == 1:
        return uniform
    arms = weights[:, 1] / weights[:, 0]
    centre = float(weights[:, 1] @ uniform)
    end = int(np.argmax(arms if targets[1] >= centre else -arms))
    share = (targets[1] - centre) / (arms[end] - centre)
    if not share < 1:
        raise ContactError("the force acts beyond the end of the contact: the bodies tip over")
    p = (1 - share) * uniform
    p[end] += share / weights[end, 0]
    return np.asarray(p)
