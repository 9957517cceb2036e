"""Synthesis from several starts: best design, agreement of the optima."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np
import scipy

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.energy_spline import basis_matrix
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem, coarsened

AGREE = 0.01  # relative difference of the residual ripple of equal designs
NEGLIGIBLE = 1e-3  # of the engine's ripple: residual ripples below it are equal
_SEED = 1989


class StartsRecord(TypedDict):
    """JSON record of `Starts`."""

    tried: int
    ripple_left: list[float | None]
    spread_percent: float
    agree: bool
    sentence: str


@dataclass(frozen=True)
class Starts:
    """Residual ripple of the coarse design of each start; None where a limit is not kept.

    The first start is that of the problem, the others are random.
    """

    ripples: tuple[float | None, ...]

    @property
    def kept(self) -> tuple[float, ...]:
        """Residual ripples of the designs within all limits."""
        return tuple(ripple for ripple in self.ripples if ripple is not None)

    @property
    def spread(self) -> float:
        """Greatest over least residual ripple, less 1; negligible ripples count as equal."""
        if not self.kept:
            return 0.0
        return max(self.kept) / max(min(self.kept), NEGLIGIBLE) - 1.0

    @property
    def agree(self) -> bool:
        """Whether all starts keep the limits and their ripples differ by at most 1 %."""
        return len(self.kept) == len(self.ripples) and self.spread <= AGREE

    @property
    def sentence(self) -> str:
        """The agreement in words."""
        tried, kept = len(self.ripples), len(self.kept)
        if tried == 1:
            return "one start: other optima are not excluded"
        if not kept:
            return f"no start of {tried} leads to a cam within all limits"
        if self.agree:
            return f"{tried} starts agree on the ripple within {100 * max(self.spread, 1e-5):.2g} %"
        lost = f"{tried - kept} lead to no cam within all limits; " if kept < tried else ""
        return (
            f"{tried} starts do not agree: {lost}their residual ripples differ by "
            f"{100 * self.spread:.2g} %, and the best of them may be no global optimum"
        )

    def as_record(self) -> StartsRecord:
        """The JSON record."""
        return {
            "tried": len(self.ripples),
            "ripple_left": list(self.ripples),
            "spread_percent": 100.0 * self.spread,
            "agree": self.agree,
            "sentence": self.sentence,
        }


def explored(problem: Problem, count: int) -> tuple[Design, Starts]:
    """Best design from several starts, and their agreement.

    The starts are compared at fewer cam angles. The design is that from the start of the problem,
    unless a random start has less ripple by more than `AGREE`.

    Parameters
    ----------
    problem : Problem
    count : int          number of starts, that of the problem included
    """
    coarse = coarsened(problem)
    random = np.random.default_rng(_SEED)
    starts = [coarse, *(_random(coarse, random) for _ in range(count - 1))]
    designs = [synthesise(each) for each in starts] if count > 1 else []
    own = synthesise(problem)
    candidates = [own]
    better = _best(designs)
    if better is not None and (
        not designs[0].feasible or better.ripple * (1.0 + AGREE) < designs[0].ripple
    ):
        fine = refined(better.coefficients, problem.coefficients)
        candidates.append(synthesise(replace(problem, seed=fine, variables=better.variables)))
    ripples = tuple(each.ripple if each.feasible else None for each in designs or candidates)
    return _best(candidates) or own, Starts(ripples)


def _best(designs: Sequence[Design]) -> Design | None:
    kept = [each for each in designs if each.feasible]
    return min(kept, key=lambda each: each.ripple) if kept else None


def _random(problem: Problem, random: np.random.Generator) -> Problem:
    """The problem with a smooth random energy and random free variables to start from."""
    size = float(np.abs(Search(problem).exact).max())
    count = problem.coefficients
    order = np.arange(1, count // 4)
    theta = uniform_turn(count)
    phase = random.uniform(0.0, 2.0 * np.pi, order.size)
    waves = (random.normal(size=order.size) / order**2) @ np.cos(
        order[:, None] * theta + phase[:, None]
    )
    low = max(problem.energy[0], 0.0) + 0.02 * size
    energy = low + size * random.uniform(0.3, 1.2) * (waves - waves.min()) / np.ptp(waves)
    variables = problem.variables
    for name, (least, greatest) in problem.freed.items():
        variables = replace(variables, **{name: float(random.uniform(least, greatest))})
    return replace(problem, seed=readonly(energy), variables=variables)


def refined(coefficients: Array, count: int) -> Array:
    """Coefficients (count,) of an energy on finer splines, by least squares."""
    theta = uniform_turn(8 * count)
    level = basis_matrix(theta, count)
    energy = basis_matrix(theta, coefficients.size) @ coefficients
    return readonly(scipy.sparse.linalg.spsolve((level.T @ level).tocsc(), level.T @ energy))
