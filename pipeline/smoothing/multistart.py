"""Several starts of a synthesis: whether they end at one optimum, and the best of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypedDict

import numpy as np
from scipy.sparse.linalg import spsolve

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.energy_spline import basis_matrix
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem, coarsened

AGREE = 0.01  # of the ripple left: designs that differ by less are one
NOTHING_LEFT = 1e-3  # of the engine's ripple: below it no design is better than another
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
    """Ripple left by each start's coarse design; None where it keeps not all limits.

    The first start is the synthesis's own, the others are random.
    """

    ripples: tuple[float | None, ...]

    @property
    def kept(self) -> tuple[float, ...]:
        """Of the designs that keep all limits."""
        return tuple(ripple for ripple in self.ripples if ripple is not None)

    @property
    def spread(self) -> float:
        """Greatest over least ripple left, less one; of ripples that matter."""
        if not self.kept:
            return 0.0
        return max(self.kept) / max(min(self.kept), NOTHING_LEFT) - 1.0

    @property
    def agree(self) -> bool:
        """Whether all starts keep the limits and end within 1 % of the same ripple."""
        return len(self.kept) == len(self.ripples) and self.spread <= AGREE

    @property
    def sentence(self) -> str:
        tried, kept = len(self.ripples), len(self.kept)
        if tried == 1:
            return "one start was tried, so that nothing is known of other optima"
        if not kept:
            return f"none of {tried} starts finds a cam within all limits"
        if self.agree:
            return f"{tried} starts agree on the ripple within {100 * max(self.spread, 1e-5):.2g} %"
        lost = f"{tried - kept} find no cam within all limits; " if kept < tried else ""
        return (
            f"{tried} starts do not agree: {lost}the ripple they leave differs by "
            f"{100 * self.spread:.2g} %, so that the best of them is not known to be the best"
        )

    def as_record(self) -> StartsRecord:
        return {
            "tried": len(self.ripples),
            "ripple_left": list(self.ripples),
            "spread_percent": 100.0 * self.spread,
            "agree": self.agree,
            "sentence": self.sentence,
        }


def explored(problem: Problem, count: int, seed: int = _SEED) -> tuple[Design, Starts]:
    """The best design that several starts lead to, and how far they agree.

    The starts are compared on a coarser turn. The design is that from the problem's own start,
    unless a random one leads to less ripple by more than `AGREE`.

    Parameters
    ----------
    problem : Problem
    count : int          starts, the problem's own among them
    seed : int           of the random ones
    """
    coarse = coarsened(problem)
    random = np.random.default_rng(seed)
    asked = [coarse, *(_random(coarse, random) for _ in range(count - 1))]
    designs = [synthesise(each) for each in asked] if count > 1 else []
    own = synthesise(problem)
    found = [own]
    better = _best(designs)
    if better is not None and (
        not designs[0].feasible or better.ripple * (1.0 + AGREE) < designs[0].ripple
    ):
        fine = refined(better.coefficients, problem.coefficients)
        found.append(synthesise(replace(problem, seed=fine, variables=better.variables)))
    ripples = tuple(each.ripple if each.feasible else None for each in designs or found)
    return _best(found) or own, Starts(ripples)


def _best(designs: Sequence[Design]) -> Design | None:
    kept = [each for each in designs if each.feasible]
    return min(kept, key=lambda each: each.ripple) if kept else None


def _random(problem: Problem, random: np.random.Generator) -> Problem:
    """The problem from a smooth random energy and, of what is freed, a random variables."""
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
    """Coefficients (count,) of the same energy on finer splines, by least squares."""
    theta = uniform_turn(8 * count)
    level = basis_matrix(theta, count)
    energy = basis_matrix(theta, coefficients.size) @ coefficients
    return readonly(spsolve((level.T @ level).tocsc(), level.T @ energy))
