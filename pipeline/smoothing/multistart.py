"""Multistart synthesis with spline refinement: best design, agreement, convergence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.pipeline.records.trial_contents import ResolutionRecord, StartsRecord
from camwright.pipeline.smoothing.constrained_synthesis import approached, synthesise
from camwright.pipeline.smoothing.energy_spline import (
    basis_matrix,
    of_constant_breadth,
    spline_of,
)
from camwright.pipeline.smoothing.linear_model import State
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.synthesis_problem import Design, Problem, coarsened

AGREE = 0.01  # relative difference of the residual ripple of equal designs
NEGLIGIBLE = 1e-3  # of the engine's ripple: residual ripples below it are equal
COEFFICIENTS_MAX = 240
REMOVABLE = 0.01  # sum of the excess of each limit that more splines may still remove
_REFINEMENT = 1.5  # of the number of splines
_SEED = 1989
_OF_EXACT = 0.5
"""Share of random waves beside the exact lift at a start of a yoke."""


@dataclass(frozen=True)
class Starts:
    """Residual ripple by start; None where a limit is not kept.

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
        """Sentence on whether the starts agree on the ripple: their number, spread, and how many
        lead to no cam within all limits.
        """
        tried, feasible = len(self.ripples), len(self.kept)
        if tried == 1:
            return "one start: other optima are not excluded"
        if not feasible:
            return f"no start of {tried} leads to a cam within all limits"
        if self.agree:
            return f"{tried} starts agree on the ripple within {100 * max(self.spread, 1e-5):.2g} %"
        lost = f"{tried - feasible} lead to no cam within all limits; " if feasible < tried else ""
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


@dataclass(frozen=True)
class Resolution:
    """Convergence of the ripple with the number of splines.

    Parameters
    ----------
    coefficients : int   splines of the turn of the design
    coarser : int        of the design before; None: the number is that of the case, or not settled
                         since the limits conflict
    change : float       of the ripple between both, over that of the design
    settled : bool       whether it is within the required convergence
    """

    coefficients: int
    coarser: int | None = None
    change: float = 0.0
    settled: bool = True

    @property
    def sentence(self) -> str:
        """Sentence on the number of splines and the change of the ripple against fewer."""
        if self.coarser is None and not self.settled:
            return f"{self.coefficients} splines, no more where the limits conflict"
        if self.coarser is None:
            return f"{self.coefficients} splines, as the case states"
        change = f"{self.coarser} splines leave {100 * abs(self.change):.2g} %"
        more = "more" if self.change > 0 else "less"
        excess = "" if self.settled else ", more than the required convergence"
        return f"{self.coefficients} splines; {change} {more} ripple{excess}"

    def as_record(self) -> ResolutionRecord:
        """The JSON record."""
        return {
            "splines": self.coefficients,
            "coarser_splines": self.coarser,
            "change_percent": 100.0 * self.change,
            "settled": self.settled,
            "sentence": self.sentence,
        }


class Explored(NamedTuple):
    """Best design of several starts, their agreement, convergence with the splines."""

    design: Design
    starts: Starts
    resolution: Resolution

    @property
    def splines(self) -> int:
        """Number of splines of a lobe of the design."""
        return int(self.design.coefficients.size)


def explored(problem: Problem, count: int) -> Explored:
    """Best design of several starts, their agreement, and its convergence with the splines.

    Each start is solved on fewer splines and cam angles, and then on those of the design. The
    number of splines rises until the ripple changes by less than `Problem.convergence`. Where few
    splines exceed the limits by more than others remove, a bounded effort is halved on more.

    Parameters
    ----------
    problem : Problem
    count : int          number of starts, that of the problem included
    """
    coarse = coarsened(problem)
    random = np.random.default_rng(_SEED)
    start = approached(coarse)
    first = problem
    if problem.effort is not None and start.violation > REMOVABLE:
        first = replace(problem, effort=problem.effort // 2)
    designs, resolution = resolved(problem, continued(first, start))
    fine = replace(problem, coefficients=designs[-1].coefficients.size)
    exact = Search(coarse).exact
    others = [continued(fine, approached(_random(coarse, exact, random))) for _ in range(count - 1)]
    alike = [designs[-1], *others]
    ripples = tuple(each.ripple if each.feasible else None for each in alike)
    best = _best([*alike, *designs]) or min(alike, key=lambda each: each.violation)
    return Explored(best, Starts(ripples), resolution)


def resolved(problem: Problem, first: Design) -> tuple[list[Design], Resolution]:
    """Designs on a rising number of splines, the finest last, and the change of their ripple.

    Parameters
    ----------
    first : Design   of the problem
    """
    designs = [first]
    if problem.convergence is None:
        return designs, Resolution(problem.lobes * problem.coefficients)
    most = COEFFICIENTS_MAX // problem.lobes
    if designs[0].stuck or designs[0].ended:
        return designs, Resolution(problem.lobes * problem.coefficients, settled=False)
    change = problem.convergence
    while True:
        before, count = designs[-1], designs[-1].coefficients.size
        # As often as the change must be halved, which a refinement does at best.
        halvings = max(1, round(np.log2(abs(change) / problem.convergence)))
        finer = problem.splines(min(round(_REFINEMENT**halvings * count), most))
        designs.append(continued(replace(problem, coefficients=finer), before))
        after = designs[-1]
        least = max(after.ripple, NEGLIGIBLE)  # below, ripples are equal
        change = max(before.ripple, NEGLIGIBLE) / least - 1.0
        settled = abs(change) <= problem.convergence
        further = finer < most and not after.ended
        if settled or not further or not (before.feasible and after.feasible):
            lobes = problem.lobes
            return designs, Resolution(lobes * finer, lobes * count, change, settled)


def continued(problem: Problem, start: Design | State) -> Design:
    """Design of a problem, started from a design on another number of splines."""
    seed = refined(start.coefficients, problem.coefficients)
    return synthesise(replace(problem, seed=seed, variables=start.variables))


def _best(designs: Sequence[Design]) -> Design | None:
    feasible = [each for each in designs if each.feasible and each.converged]
    return min(feasible, key=lambda each: each.objective) if feasible else None


def _random(problem: Problem, exact: Array, random: np.random.Generator) -> Problem:
    """Problem whose search starts from a random smooth energy, a Fourier series of random phases
    and amplitudes falling with 1/order^2, and from random values of the free variables within their
    ranges.

    Parameters
    ----------
    problem : Problem    whose start is replaced
    exact : array        coefficients that balance the torque; the range of the energy is 0.3 to 1.2
                         of the greatest of them
    random : Generator   of the random numbers
    """
    count, size = problem.coefficients, float(np.abs(exact).max())
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
        variables = variables.with_value(name, float(random.uniform(least, greatest)))
    if variables.of_lift:  # a lift of the other sign would have to pass none
        seed = of_constant_breadth(exact + _OF_EXACT * energy)
        return replace(problem, seed=seed, variables=variables)
    return replace(problem, seed=readonly(energy), variables=variables)


def refined(coefficients: Array, count: int) -> Array:
    """Coefficients (count,), J, of the energy of a lobe on another number of splines, by least
    squares.

    Parameters
    ----------
    coefficients : array   on the present splines, J
    count : int            new number of splines
    """
    energy = basis_matrix(uniform_turn(8 * count), coefficients.size) @ coefficients
    return spline_of(energy, count)
