"""What a constrained synthesis is asked for, and what it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from camwright.geometry.arrays import Array, readonly, uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.limits import TORQUE_REDUCTION
from camwright.pipeline.smoothing.energy_spline import basis_matrix
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario

RESERVE = 1e-3  # share of every limit kept in hand, for what lies between the points
FEASIBLE = 1e-5  # greatest utilisation above the reserve's that counts as none
COARSE_COEFFICIENTS, COARSE_POINTS = 36, 240  # enough to tell one cam from another
FINEST = 10  # times the points: where limits are looked at between them


@dataclass(frozen=True, eq=False)
class Problem:
    """What a synthesis is asked for.

    Parameters
    ----------
    scenarios : tuple of Scenario   all limits hold in each; the worst weighted ripple counts
    ratings : Ratings
    variables : DesignVariables               spring and base radius to start from
    gear_ratio : float              crank turns per cam turn
    freed : mapping                 of `rate`, `preload`, `prime_radius`, `phase` to (least,
                                    greatest), SI
    energy : (float, float)         least and greatest energy at the lowest lift, E0, J
    coefficients : int              splines of the turn
    torque_reduction : float        least share of the ripple to take away; None: as much as can be
    torque_weight, speed_weight : float   of torque ripple and of speed ripple
    jerk_weight : float             of the lift's third derivative beside that of the exact energy
    left_out : frozenset            names of limits that are not asked for
    seed : array (coefficients,)    where to start instead of the convex part's answer, J
    """

    scenarios: tuple[Scenario, ...]
    ratings: Ratings
    variables: DesignVariables
    gear_ratio: float = 2.0
    freed: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    energy: tuple[float, float] = (0.0, np.inf)
    coefficients: int = 96
    points: int = 720
    torque_reduction: float | None = None
    torque_weight: float = 1.0
    speed_weight: float = 0.0
    jerk_weight: float = 1e-5
    left_out: frozenset[str] = frozenset()
    seed: Array | None = None

    @property
    def ceiling(self) -> float | None:
        """Greatest share of the ripple that may be left; None where nothing is asked."""
        if self.torque_reduction is None or TORQUE_REDUCTION.id in self.left_out:
            return None
        return (1.0 - self.torque_reduction) * (1.0 - RESERVE)


@dataclass(frozen=True, eq=False)
class Design:
    """An answer: energy coefficients (J) and variables, what it leaves and what it uses.

    ripple is the worst weighted ripple over that without a cam. utilisation has the greatest of
    each limit over the turn, between its points too, and all scenarios; multipliers, by limit,
    the ripple a unit of utilisation would buy; strip the utilisation at cam angles (rad).
    """

    coefficients: Array
    variables: DesignVariables
    ripple: float
    utilisation: Mapping[str, float]
    multipliers: Mapping[str, float]
    strip: Mapping[str, tuple[Array, Array]]
    steps: int
    converged: bool

    @property
    def feasible(self) -> bool:
        """Whether every limit holds, between the points too."""
        return all(value <= 1.0 for value in self.utilisation.values())

    def lift(self, samples: int = 1440) -> Lift:
        """The lift, sampled from the spline of the energy."""
        theta = uniform_turn(samples) - float(self.variables.phase)
        energy = np.maximum(basis_matrix(theta, self.coefficients.size) @ self.coefficients, 0.0)
        force = np.sqrt(self.variables.preload**2 + 2.0 * self.variables.rate * energy)
        return Lift(
            uniform_turn(samples), readonly(2.0 * energy / (force + self.variables.preload))
        )


def coarsened(problem: Problem) -> Problem:
    """The problem on a coarser turn and from its own start: quick, for a yes, a no, a ranking."""
    points = min(problem.points, COARSE_POINTS)
    turns = tuple(replace(item, torque=thinned(item.torque, points)) for item in problem.scenarios)
    return replace(
        problem,
        scenarios=turns,
        points=points,
        coefficients=min(problem.coefficients, COARSE_COEFFICIENTS),
        seed=None,
    )


def thinned(torque: Array, points: int) -> Array:
    """A torque over one turn at another number of points, its waves beyond them left out."""
    spectrum = np.fft.rfft(torque)[: points // 2]
    return readonly(np.fft.irfft(spectrum, n=points) * (points / torque.size))


def ripple_of(problem: Problem, item: Scenario, values: Array) -> Array:
    """Torque and speed ripple of columns of crank torque, each over that of the engine."""
    parts = [np.sqrt(problem.torque_weight) * torque_ripple(item, values)]
    if problem.speed_weight > 0:
        before = _integral(item.torque - item.torque.mean())
        norm = np.sqrt(before.size) * float(np.std(before))
        parts.append(np.sqrt(problem.speed_weight) / norm * _integral(values))
    return np.concatenate(parts)


def torque_ripple(item: Scenario, values: Array) -> Array:
    """Columns of crank torque about their means; their norm is the std over the engine's."""
    before = item.torque - item.torque.mean()
    return np.asarray((values - values.mean(axis=0)) / (np.sqrt(before.size) * np.std(before)))


def triangle(columns: Array) -> tuple[Array, Array]:
    """Level and slopes of as few rows, the norm of which is that of all: slopes, then level."""
    factor = np.asarray(np.linalg.qr(columns, mode="r"))
    return factor[:, -1], factor[:, :-1]


def _integral(values: Array) -> Array:
    """Integral of periodic columns by the angle, its mean taken off; of a turn of any length."""
    spectrum = np.fft.rfft(values, axis=0)
    order = np.arange(spectrum.shape[0]).reshape(-1, *[1] * (spectrum.ndim - 1))
    spectrum = np.divide(spectrum, 1j * order, out=np.zeros_like(spectrum), where=order > 0)
    return np.fft.irfft(spectrum, n=values.shape[0], axis=0)
