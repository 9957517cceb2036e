"""Answers of a study against closed forms: Sobol indices, shares of variance, yield, front."""

from __future__ import annotations

import numpy as np
import pytest
from SALib.sample import sobol
from scipy import stats

from camwright.pipeline.studies.batch.answers import answered
from camwright.pipeline.studies.batch.answers_sensitivity import (
    independent,
    main_effect,
    sobol_indices,
)
from camwright.pipeline.studies.batch.answers_yield import Yield
from camwright.pipeline.studies.batch.dataset import Dataset
from camwright.pipeline.studies.batch.study_file import Study, study_of

A, B = 7.0, 0.1
SEEDS = 100


def ishigami(x: np.ndarray) -> np.ndarray:
    return np.sin(x[:, 0]) + A * np.sin(x[:, 1]) ** 2 + B * x[:, 2] ** 4 * np.sin(x[:, 0])


def ishigami_indices() -> tuple[list[float], list[float]]:
    """First-order and total indices, Saltelli et al., Global Sensitivity (2008), p. 179."""
    one = 0.5 * (1.0 + B * np.pi**4 / 5.0) ** 2
    two, both = A**2 / 8.0, B**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    whole = one + two + both
    return [one / whole, two / whole, 0.0], [(one + both) / whole, two / whole, both / whole]


def saltelli(blocks: int, seed: int) -> np.ndarray:
    problem = {"num_vars": 3, "names": list("abc"), "bounds": [[-np.pi, np.pi]] * 3}
    return sobol.sample(problem, blocks, calc_second_order=False, seed=seed)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_sobol_indices_of_ishigami_lie_within_their_intervals(seed: int) -> None:
    indices = sobol_indices(ishigami(saltelli(1024, seed)), 3)
    for index, first, total in zip(indices, *ishigami_indices(), strict=True):
        assert index.first_interval[0] <= first <= index.first_interval[1]
        assert index.total_interval[0] <= total <= index.total_interval[1]
        assert index.first_interval[1] - index.first_interval[0] < 0.2


def test_a_block_without_a_result_is_left_out_whole() -> None:
    output = ishigami(saltelli(64, 5))
    broken = output.copy()
    broken[7] = np.nan  # in block 1
    kept = np.delete(output.reshape(-1, 5), 1, axis=0).ravel()
    assert sobol_indices(broken, 3) == sobol_indices(kept, 3)


def test_the_independent_designs_are_the_matrices_a_and_b() -> None:
    sample = saltelli(16, 1)
    rows = independent(len(sample), 3)
    assert len(rows) == 32
    for low, high in rows.reshape(-1, 2):
        mixed = sample[low + 1 : high]
        for k, row in enumerate(mixed):
            expected = sample[low].copy()
            expected[k] = sample[high][k]
            np.testing.assert_array_equal(row, expected)


def test_shares_of_a_linear_output_lie_within_their_intervals() -> None:
    """Y = sum a_j x_j + noise; share a_j^2 / var(Y); coverage of 95 % intervals at least 90 %."""
    slopes, noise, n = np.array([1.0, 0.5, 0.2, 0.0]), 0.5, 500
    shares = slopes**2 / (slopes @ slopes + noise**2)
    hits = np.zeros(4)
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        x = rng.random((n, 4))
        y = np.sqrt(12.0) * (x @ slopes) + noise * rng.standard_normal(n)
        for k, share in enumerate(shares):
            low, high = main_effect(x[:, k], y).share_interval
            hits[k] += low <= share <= high
    assert hits.min() >= 90


def test_means_by_level_of_a_linear_output() -> None:
    """Levels of a uniform factor hold equally many designs; means against the middle of each."""
    x = (np.arange(4000) + 0.5) / 4000
    effect = main_effect(x, 3.0 * x)
    np.testing.assert_allclose(effect.means, 3.0 * (np.arange(8) + 0.5) / 8, rtol=1e-3)
    assert effect.counts == (500,) * 8
    assert effect.swing == pytest.approx(3.0 * 7 / 8, rel=1e-3)
    assert effect.share > 0.99  # what is lost lies within the levels, 1/k^2


def test_levels_of_text_are_its_values() -> None:
    kind = np.array(["b", "a"] * 50)
    effect = main_effect(kind, np.where(kind == "a", 1.0, 2.0) + 0.01 * np.arange(100))
    assert effect.levels == ("a", "b")
    assert main_effect(np.full(100, "a"), np.arange(100.0)) is None


def rows(count: int, **columns: np.ndarray) -> Dataset:
    """A dataset of screened designs with these columns."""
    made = {
        "design": np.arange(count), "id": np.array([f"{k:08x}" for k in range(count)]),
        "depth": np.full(count, "screening"), "screen": np.full(count, "open"),
        "verdict": np.full(count, ""), "governing": np.full(count, ""),
        "message": np.full(count, ""),
    }  # fmt: skip
    return Dataset(made | columns, {}, {})


def study(**tables: object) -> Study:
    """A study of two factors by random sampling."""
    factors = [{"key": key, "range": {"low": 0, "high": 1}} for key in ("a", "b")]
    sampling = {"method": "random", "count": 300}
    plain = {"name": "made", "case": ["made.toml"], "factor": factors, "sampling": sampling}
    return study_of(plain | tables)


def test_the_analytic_yield_lies_within_its_interval() -> None:
    """Strength less stress, both normal: yield Phi(beta). 95 % intervals, 100 fixed seeds."""
    strength, stress, spread = 100.0, 80.0, (8.0, 12.0)
    true = stats.norm.cdf((strength - stress) / np.hypot(*spread))
    n, hits = 300, 0
    for seed in range(SEEDS):
        rng = np.random.default_rng(seed)
        margin = rng.normal(strength, spread[0], n) - rng.normal(stress, spread[1], n)
        data = rows(n, screen=np.where(margin >= 0.0, "open", "fail"))
        low, high = answered(data, study())["yield"]["interval"]
        hits += low <= true <= high
        assert high - low < 0.1
    assert hits >= 90


@pytest.mark.parametrize(("passed", "count"), [(0, 20), (7, 20), (19, 20), (20, 20)])
def test_interval_of_the_yield_against_the_binomial_distribution(passed: int, count: int) -> None:
    """At each end the observed number or a more extreme one has probability 2.5 %."""
    low, high = Yield(passed, count).interval()
    if passed:
        assert stats.binom.sf(passed - 1, count, low) == pytest.approx(0.025, rel=1e-9)
    else:
        assert low == 0.0
    if passed < count:
        assert stats.binom.cdf(passed, count, high) == pytest.approx(0.025, rel=1e-9)
    else:
        assert high == 1.0
    assert Yield(passed, count).width == high - low


def test_the_front_against_every_pair() -> None:
    rng = np.random.default_rng(4)
    x, y = rng.random((2, 200))
    screen = np.where(rng.random(200) < 0.7, "open", "fail")
    data = rows(200, **{"headline.x": x, "headline.y": y, "screen": screen})
    goals = [{"column": "headline.x"}, {"column": "headline.y", "goal": "max"}]
    front = {row["design"] for row in answered(data, study(objective=goals))["front"]["designs"]}
    valid = np.flatnonzero(screen == "open")
    by_hand = {
        int(k) for k in valid
        if not any(x[j] <= x[k] and y[j] >= y[k] and j != k for j in valid)
    }  # fmt: skip
    assert front == by_hand
