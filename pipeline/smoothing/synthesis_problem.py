"""Constrained synthesis: problem, design, coarsening, ripple of a crank torque."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.follower.spring import stored_lift
from camwright.pipeline.smoothing.energy_spline import LEAST_COEFFICIENTS, Grid, basis_matrix
from camwright.pipeline.smoothing.objective import (
    TORQUE,
    Objective,
    Residual,
    Scale,
    Weighted,
    residuals,
    scale_of,
    torque_ripple,
)
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario

RESERVE = 1e-3  # of each limit, for extremes between the points
FEASIBLE = 1e-5  # tolerance on a utilisation at the reserve
COARSE_COEFFICIENTS, COARSE_POINTS = 36, 240  # for a ranking of cams
CONVERGED = 2e-6  # greatest foreseen gain of a converged search, of the engine's ripple
COEFFICIENTS = 64  # of the first synthesis where their number is chosen
FINEST = 10  # refinement of the points for extremes between them


@dataclass(frozen=True, eq=False)
class Problem:
    """Constrained synthesis problem: scenarios, limits, free variables, objective.

    Parameters
    ----------
    scenarios : tuple of Scenario   limits hold in each; the greatest weighted ripple is minimised
    ratings : Ratings
    variables : DesignVariables     start values
    gear_ratio : float              crank turns per cam turn
    freed : mapping                 free variables of `rate`, `preload`, `prime_radius`, `phase`:
                                    (least, greatest), SI
    energy : (float, float)         least and greatest energy at minimum lift, E0, J
    coefficients : int              number of splines of a lobe
    lobes : int                     equal lobes of the turn
    points : int                    number of cam angles, a whole number in a lobe
    objective : tuple of Weighted   terms that are minimised
    jerk_weight : float             of the lift jerk over that of the exact energy
    left_out : frozenset            checks whose limits are not kept
    judged : mapping                utilisation by which a run judges, at the worst tolerance corner
                                    and the end of the error bar, over that of the scenarios, by
                                    limit; of a limit that is not named 1
    seed : array (coefficients,)    start, J; None: convex optimum or exact energy
    effort : int                    tried steps after which a search ends; None: at an optimum
    """

    scenarios: tuple[Scenario, ...]
    ratings: Ratings
    variables: DesignVariables
    gear_ratio: float = 2.0
    freed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    energy: tuple[float, float] = (0.0, np.inf)
    coefficients: int = 96
    lobes: int = 1
    convergence: float | None = None
    points: int = 720
    objective: Objective = (Weighted(TORQUE, 1.0),)
    jerk_weight: float = 1e-5
    left_out: frozenset[str] = frozenset()
    judged: Mapping[str, float] = field(default_factory=dict)
    seed: Array | None = None
    effort: int | None = None

    def grid(self, theta: Array) -> Grid:
        """Splines of the energy at cam angles (m,), rad."""
        return Grid.at(theta, self.coefficients, self.lobes)

    def splines(self, count: int) -> int:
        """Number of splines of a lobe: `count`, of a lift of constant breadth an even number."""
        return count + count % 2 if self.variables.of_lift else count

    @property
    def coarse_points(self) -> int:
        """Number of cam angles of a coarse problem."""
        return min(self.points, COARSE_POINTS // self.lobes * self.lobes)

    @property
    def torque_alone(self) -> bool:
        """Whether the torque ripple is the only ripple in the objective, at a weight of 1."""
        ripples = [each for each in self.objective if isinstance(each.term, Residual)]
        return ripples == [Weighted(TORQUE, 1.0)]

    @property
    def scale(self) -> Scale:
        """References of the costs of the objective."""
        return scale_of(self.scenarios, self.gear_ratio, self.variables.prime_radius)

    def ceiling_of(self, item: Scenario) -> float | None:
        """Greatest allowed standard deviation of the torque that is left in a scenario, over that
        of its engine torque; None without a limit.

        1 less the required torque reduction, less the reserve, over the ratio by which a run judges
        it worse, see `judged`.
        """
        if item.torque_reduction is None or TORQUE_REDUCTION.id in self.left_out:
            return None
        judged = self.judged.get(TORQUE_REDUCTION.id, 1.0)
        return (1.0 - item.torque_reduction) * (1.0 - RESERVE) / judged

    @property
    def ceiling(self) -> float | None:
        """Least allowed residual ripple of the weighted scenarios; None without one."""
        counting = [self.ceiling_of(item) for item in self.scenarios if item.weight > 0]
        return min((each for each in counting if each is not None), default=None)


class OfProblems(Protocol):
    """Interface of a Lagrangian at an optimum, evaluated for other problems."""

    def at(self, problem: Problem, variables: DesignVariables | None = None) -> float:
        """Value for a problem of equal limits and splines, over the engine's ripple."""
        ...


@dataclass(frozen=True, eq=False)
class Design:
    """Result of a constrained synthesis: energy, variables, ripple, utilisations, multipliers.

    Parameters
    ----------
    coefficients : array    of the energy of a lobe, J
    variables : DesignVariables
    ripple : float          greatest weighted residual ripple over that of the engine
    cost : float            weighted costs of the objective
    utilisation : mapping   greatest of each limit over all scenarios, refined between points
    multipliers : mapping   decrease of the ripple per unit of utilisation, by limit
    strip : mapping         cam angle, rad, and utilisation at it, by limit
    steps : int             of the search
    gain : float            decrease of the objective that another step of the search foresees
    stuck : bool            whether no cam near it exceeds the limits by notably less
    ended : bool            whether the effort of the problem ended the search, not an optimum
    lobes : int             equal lobes of the turn
    lagrangian : OfProblems   of the optimum; None: no program was solved
    """

    coefficients: Array
    variables: DesignVariables
    ripple: float
    cost: float
    utilisation: Mapping[str, float]
    multipliers: Mapping[str, float]
    strip: Mapping[str, tuple[Array, Array]]
    steps: int
    gain: float
    stuck: bool = False
    ended: bool = False
    lobes: int = 1
    lagrangian: OfProblems | None = None

    @property
    def converged(self) -> bool:
        """Whether another step would gain next to nothing."""
        return self.gain <= CONVERGED

    @property
    def ripple_gain(self) -> float | None:
        """Foreseen `gain` of a feasible design; None otherwise, where violation outweighs it."""
        return self.gain if self.feasible else None

    @property
    def objective(self) -> float:
        """Ripple and costs, which the synthesis minimises."""
        return self.ripple + self.cost

    @property
    def violation(self) -> float:
        """Sum of the excess of each limit."""
        return sum(max(0.0, value - 1.0) for value in self.utilisation.values())

    @property
    def feasible(self) -> bool:
        """Whether all limits are kept, between the sampled points too."""
        return all(value <= 1.0 for value in self.utilisation.values())

    def lift(self, samples: int = 1440) -> Lift:
        """Lift of the cam, m, at `samples` equally spaced cam angles of a turn from 0, with the
        phase of the design.
        """
        theta = uniform_turn(samples) - float(self.variables.phase)
        splines = basis_matrix(theta, self.coefficients.size, lobes=self.lobes)
        energy = np.maximum(splines @ self.coefficients, 0.0)
        variables = self.variables
        if variables.of_lift:
            return Lift(uniform_turn(samples), energy)
        deflection = stored_lift(energy, variables.rate, variables.closing, variables.shape)
        return Lift(uniform_turn(samples), deflection)


def coarsened(problem: Problem) -> Problem:
    """Problem on fewer cam angles and splines, without a seed, for feasibility and ranking."""
    points = problem.coarse_points
    turns = tuple(replace(item, torque=thinned(item.torque, points)) for item in problem.scenarios)
    return replace(
        problem,
        scenarios=turns,
        points=points,
        coefficients=problem.splines(
            min(problem.coefficients, per_lobe(COARSE_COEFFICIENTS, problem.lobes))
        ),
        seed=None,
    )


def per_lobe(coefficients: int, lobes: int) -> int:
    """Splines of a lobe from those of the turn, at least as many as a periodic spline needs."""
    return max(-(-coefficients // lobes), LEAST_COEFFICIENTS)


def thinned(torque: Array, points: int) -> Array:
    """Torque over a turn resampled to `points` after low-pass filtering."""
    spectrum = np.fft.rfft(torque)[: points // 2]
    return readonly(np.fft.irfft(spectrum, n=points) * (points / torque.size))


def ripple_of(problem: Problem, item: Scenario, values: Array) -> Array:
    """Weighted residuals of crank torques (n, w), over those of the engine."""
    return residuals(problem.objective, item, values)


def torque_slope(item: Scenario, values: Array) -> Array:
    """Gradient (n,), 1/(N m), of the relative torque ripple, the norm of `torque_ripple`, by the
    crank torque at each of n angles; zero where the ripple is zero.

    Parameters
    ----------
    item : Scenario       with the engine torque to which the ripple is relative
    values : array (n,)   crank torque left, N m
    """
    level = torque_ripple(item, values)
    size = float(np.linalg.norm(level))
    spread = np.sqrt(values.size) * float(np.std(item.torque))
    return np.asarray(level / (size * spread)) if size > 0.0 else np.zeros_like(values)


def triangle(columns: Array) -> tuple[Array, Array]:
    """Level (m,) and slopes (m, w) of equal norm in w + 1 rows, by QR decomposition."""
    factor = np.asarray(np.linalg.qr(columns, mode="r"))
    return factor[:, -1], factor[:, :-1]
