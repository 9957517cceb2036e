"""The convex program of a trust region: many ripples, few of which bind."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.smoothing import cone_program
from camwright.pipeline.smoothing.cone_program import ConeSolution, Norm, solved

SIZE, PENALTY = 5, 5.0


@pytest.mark.parametrize("seed", range(6))
def test_many_ripples_have_the_least_greatest_one(seed):
    norms, slope, solution = _program(seed, count=14)
    assert solution.ripple == pytest.approx(max(_weighted(norms, solution.step)), abs=1e-6)
    ceiling = max(0.0, *(n.after(solution.step) - n.ceiling for n in norms if n.ceiling))
    assert solution.slack.get(TORQUE_REDUCTION.id, 0.0) == pytest.approx(ceiling, abs=1e-6)
    # 1e-4: the independent solver ends at changes of 1e-9 of a cost that has corners
    assert solution.objective == pytest.approx(_independent(norms, slope), rel=1e-4)


@pytest.mark.parametrize("seed", range(6))
def test_ripples_left_out_at_first_change_nothing(seed, monkeypatch):
    norms, _, few = _program(seed, count=14)
    monkeypatch.setattr(cone_program, "_FIRST_NORMS", len(norms))
    whole = _program(seed, count=14)[2]
    assert few.objective == pytest.approx(whole.objective, abs=1e-6)
    np.testing.assert_allclose(few.step, whole.step, atol=1e-4)
    # the prices of those that bind, and none of the others
    np.testing.assert_allclose(few.norms, whole.norms, atol=1e-3)


def test_a_ceiling_of_a_small_ripple_counts():
    """The last of the norms by their size is the one that is bounded."""
    large = [Norm(np.full(SIZE, 1.0 + 0.1 * k), np.eye(SIZE)) for k in range(5)]
    bounded = Norm(np.full(SIZE, 0.1), -np.eye(SIZE), weight=0.0, ceiling=0.2)
    solution = _solved([*large, bounded], np.zeros(SIZE), penalty=1e3)
    assert bounded.after(solution.step) == pytest.approx(0.2, abs=1e-5)


def _program(seed: int, count: int) -> tuple[list[Norm], np.ndarray, ConeSolution]:
    draw = np.random.default_rng(seed)
    norms = [
        Norm(
            level=draw.normal(1.0, 0.2, SIZE),
            slopes=draw.normal(0.0, 1.5, (SIZE, SIZE)),
            weight=float(draw.uniform(0.5, 1.5)),
            ceiling=float(draw.uniform(0.8, 1.6)) if draw.random() < 0.3 else None,
            number=number,
        )
        for number in range(count)
    ]
    slope = draw.normal(0.0, 0.1, SIZE)
    return norms, slope, _solved(norms, slope, PENALTY)


def _solved(norms: list[Norm], slope: np.ndarray, penalty: float) -> ConeSolution:
    box = np.array([np.full(SIZE, -2.0), np.full(SIZE, 2.0)])
    solution = solved(norms, [], 0.1 * np.eye(SIZE), slope, box, penalty)
    assert solution is not None
    return solution


def _weighted(norms: list[Norm], step: np.ndarray) -> list[float]:
    return [norm.weight * norm.after(step) for norm in norms]


def _independent(norms: list[Norm], slope: np.ndarray) -> float:
    """Least cost by sequential quadratic programs over step, greatest ripple and slack."""

    def room(x: np.ndarray) -> np.ndarray:
        step, ripple, slack = x[:SIZE], x[SIZE], x[SIZE + 1]
        over = [norm.ceiling + slack - norm.after(step) for norm in norms if norm.ceiling]
        return np.array([*(ripple - each for each in _weighted(norms, step)), *over])

    def cost(x: np.ndarray) -> float:
        step = x[:SIZE]
        return float(x[SIZE] + PENALTY * x[SIZE + 1] + slope @ step + 0.05 * step @ step)

    start = np.append(np.zeros(SIZE), [10.0, 10.0])
    optimum = scipy.optimize.minimize(
        cost,
        start,
        method="SLSQP",
        bounds=[*[(-2.0, 2.0)] * SIZE, (0.0, None), (0.0, None)],
        constraints={"type": "ineq", "fun": room},
        options={"maxiter": 500, "ftol": 1e-9},
    )
    assert optimum.success, optimum.message
    return float(optimum.fun)
