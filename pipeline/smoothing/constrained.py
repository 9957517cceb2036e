"""Constrained synthesis: the cam of least delivered ripple that keeps every limit.

The unknowns are the coefficients of the stored energy, a periodic quintic B-spline, and what a
case frees of spring rate, preload and base radius. Each step linearises the delivered torque and
the limits, solves a convex program within a trust region, and is kept when the ripple and the
worst violation of each limit really fall together.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, hstack

from geometry.arrays import Array, readonly, uniform_turn
from geometry.lift import Lift
from pipeline.smoothing.constraints import (
    FREED,
    Gradient,
    Jet,
    Machine,
    Mean,
    Ratings,
    Scenario,
    Values,
    delivered_torque,
    differentiated,
    lift_jet,
    load_utilisations,
    shape_utilisations,
)
from pipeline.smoothing.convex import Answer, Norm, Rows, solved
from pipeline.smoothing.spline_energy import basis_matrix, basis_rows, exact_start

TORQUE_REDUCTION = "torque_reduction"
RESERVE = 1e-3  # share of every limit kept in hand, for what lies between the points
FEASIBLE = 1e-5  # greatest utilisation above the reserve's that counts as none
_PENALTY, _PENALTY_MAX = 20.0, 2e3
_STEPS_MAX = 60
_CONVERGED = 2e-6
_FINEST = 10


@dataclass(frozen=True, eq=False)
class Problem:
    """What a synthesis is asked for.

    Parameters
    ----------
    scenarios : tuple of Scenario   all limits hold in each; the worst weighted ripple counts
    ratings : Ratings
    machine : Machine               spring and base radius to start from
    gear_ratio : float              crank turns per cam turn
    freed : mapping                 of `rate`, `preload`, `base_radius` to (least, greatest), SI
    energy : (float, float)         least and greatest energy at the lowest lift, E0, J
    coefficients : int              splines of the turn
    torque_reduction : float        least share of the ripple to take away; None: as much as can be
    torque_weight, speed_weight : float   of torque ripple and of speed ripple
    jerk_weight : float             of the third derivative of the energy beside that of the start
    left_out : frozenset            names of limits that are not asked for
    seed : array (coefficients,)    where to start instead of the exact energy, J
    """

    scenarios: tuple[Scenario, ...]
    ratings: Ratings
    machine: Machine
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


@dataclass(frozen=True, eq=False)
class Design:
    """An answer: energy coefficients (J) and machine, what it leaves and what it uses.

    ripple is the worst weighted ripple over that without a cam. utilisation has the greatest of
    each limit over the turn and all scenarios, and multipliers, by limit, the ripple a unit of
    utilisation would buy, at the angles of `strip` (rad).
    """

    coefficients: Array
    machine: Machine
    ripple: float
    utilisation: Mapping[str, float]
    multipliers: Mapping[str, float]
    strip: Mapping[str, tuple[Array, Array]]
    steps: int
    converged: bool

    @property
    def feasible(self) -> bool:
        """Whether every limit holds, its reserve kept."""
        return all(value <= 1.0 - RESERVE + FEASIBLE for value in self.utilisation.values())

    def lift(self, samples: int = 1440) -> Lift:
        """The lift, sampled from the spline of the energy."""
        theta = uniform_turn(samples)
        energy = basis_matrix(theta, self.coefficients.size) @ self.coefficients
        force = np.sqrt(self.machine.preload**2 + 2.0 * self.machine.rate * np.maximum(energy, 0.0))
        values = 2.0 * np.maximum(energy, 0.0) / (force + self.machine.preload)
        return Lift(theta, readonly(values))


@dataclass(frozen=True, eq=False)
class _Grid:
    """Spline values at a set of angles, six entries a row."""

    theta: Array
    columns: NDArray[np.intp]
    entries: tuple[Array, ...]

    @classmethod
    def at(cls, theta: Array, count: int) -> _Grid:
        found = [basis_rows(theta, count, order) for order in range(3)]
        return cls(theta, found[0][1], tuple(values for values, _ in found))

    def energy(self, coefficients: Array) -> tuple[Array, Array, Array]:
        local = coefficients[self.columns]
        first, second, third = (np.sum(entry * local, axis=1) for entry in self.entries[:3])
        return first, second, third

    def sparse(self, local: Array, count: int) -> csr_array:
        """Rows of the derivatives by the coefficients, from those by E, E', E''."""
        values = np.einsum("km,kmj->mj", local, np.stack(self.entries[: len(local)]))
        rows = np.repeat(np.arange(self.theta.size), 6)
        return csr_array(
            (np.ravel(values), (rows, self.columns.ravel())), shape=(self.theta.size, count)
        )


@dataclass(frozen=True, eq=False)
class _State:
    """A place in the search: coefficients, machine, and all that depends on them."""

    coefficients: Array
    machine: Machine
    ripple: float
    jerk: float
    utilisation: dict[str, float]

    def merit(self, penalty: float, ripple_weight: float) -> float:
        over = sum(max(0.0, value - 1.0 + RESERVE) for value in self.utilisation.values())
        return ripple_weight * self.ripple + self.jerk + penalty * over


class Search:
    """The functions of one problem on one grid, and their linear models."""

    def __init__(self, problem: Problem, extra: Array | None = None) -> None:
        self.problem = problem
        count = problem.coefficients
        self.turn = _Grid.at(uniform_turn(problem.points), count)
        more = np.zeros(0) if extra is None else extra
        self.extra = _Grid.at(more, count)
        self.scenarios = [
            (item, replace(item, correction=item.correction.at(self.turn.theta)),
             replace(item, correction=item.correction.at(more)))
            for item in problem.scenarios
        ]  # fmt: skip
        third = basis_matrix(self.turn.theta, count, 3)
        self.start = self._start()
        norm = float(np.sum((third @ self.start) ** 2)) or 1.0
        self.jerk = (problem.jerk_weight / norm) * (third.T @ third).toarray()
        self.scale = max(float(np.abs(self.start).max()), 1e-9)

    def _start(self) -> Array:
        problem, machine = self.problem, self.problem.machine
        if problem.seed is not None:
            return problem.seed
        first = max(problem.scenarios, key=lambda item: item.weight)
        torque = problem.gear_ratio * first.torque
        ratings = problem.ratings
        travel = np.inf if ratings.travel is None else ratings.travel * (1.0 - RESERVE)
        found = exact_start(
            torque - torque.mean(),
            problem.coefficients,
            rate=machine.rate,
            preload=machine.preload,
            base_radius=machine.base_radius,
            pressure_angle=ratings.pressure_angle or np.pi / 3,
            energy_max=machine.preload * travel + 0.5 * machine.rate * travel**2,
        )
        rise = float(np.clip(0.0, problem.energy[0] - 1e-12, problem.energy[1]))
        least = float(self.turn.energy(found)[0].min())
        return found if least <= problem.energy[1] else found - least + rise

    def highest(self, coefficients: Array, machine: Machine) -> tuple[float, float]:
        """Greatest lift and its angle, between the points too."""
        theta = self.turn.theta
        energy = self.turn.energy(coefficients)[0]
        k = int(np.argmax(energy))
        step = theta[1]
        before, here, after = energy[k - 1], energy[k], energy[(k + 1) % energy.size]
        curve = before - 2.0 * here + after
        shift = 0.0 if curve >= 0 else 0.5 * (before - after) / curve
        angle = float(theta[k] + step * np.clip(shift, -1.0, 1.0))
        for _ in range(2):  # Newton on E' = 0
            grid = _Grid.at(np.array([angle]), coefficients.size)
            _, slope, bend = grid.energy(coefficients)
            if bend[0] < 0:
                angle -= float(np.clip(slope[0] / bend[0], -step, step))
        peak = _Grid.at(np.array([angle]), coefficients.size).energy(coefficients)
        return float(lift_jet(*peak, machine).lift[0]), angle

    def shape(self, jet: Jet, _top: Values, machine: Machine) -> Mapping[str, Values | Mean]:
        return shape_utilisations(jet, machine, self.problem.ratings)

    def _kept(self, found: Mapping[str, Values | Mean]) -> dict[str, Values | Mean]:
        return {k: v for k, v in found.items() if k not in self.problem.left_out}

    def utilisations(self, coefficients: Array, machine: Machine, grid: _Grid) -> dict[str, Values]:
        """Every limit on a grid: (n,) or, for means, one number; the worst of the scenarios."""
        jet = lift_jet(*grid.energy(coefficients), machine)
        top = self.highest(coefficients, machine)[0]
        found = self._kept(self.shape(jet, top, machine))
        for item, *_ in self.scenarios:
            there = replace(item, correction=item.correction.at(grid.theta))
            loads = load_utilisations(jet, top, machine, self.problem.ratings, there)
            for name, value in self._kept(loads).items():
                use = value.value if isinstance(value, Mean) else value
                found[name] = np.maximum(found[name], use) if name in found else use
        return found

    def state(self, coefficients: Array, machine: Machine) -> _State:
        found = self.utilisations(coefficients, machine, self.turn)
        most = {name: float(np.max(value)) for name, value in found.items()}
        if self.extra.theta.size:
            more = self.utilisations(coefficients, machine, self.extra)
            for name, value in more.items():
                if np.size(value) > 1:
                    most[name] = max(most[name], float(np.max(value)))
        least = float(self.turn.energy(coefficients)[0].min())
        if np.isfinite(self.problem.energy[1]):
            most["initial_energy"] = 1.0 - RESERVE + (least - self.problem.energy[1]) / self.scale
        ripples = [float(np.linalg.norm(level)) for level in self.residuals(coefficients, machine)]
        weighted = [w * r for w, r in zip(self.weights, ripples, strict=True)]
        floor = self.problem.torque_reduction
        if floor is not None and TORQUE_REDUCTION not in self.problem.left_out:
            most[TORQUE_REDUCTION] = 1.0 - RESERVE + max(ripples) - (1.0 - floor) * (1.0 - RESERVE)
        jerk = 0.5 * float(coefficients @ self.jerk @ coefficients)
        return _State(coefficients, machine, max(weighted), jerk, most)

    @property
    def weights(self) -> list[float]:
        return [item.weight for item, *_ in self.scenarios if item.weight > 0]

    def residuals(self, coefficients: Array, machine: Machine) -> list[Array]:
        """What is left of the ripple in each weighted scenario, over that without the cam."""
        jet = lift_jet(*self.turn.energy(coefficients), machine)
        top = self.highest(coefficients, machine)[0]
        found = []
        for _, item, _ in self.scenarios:
            if item.weight > 0:
                torque = delivered_torque(jet, top, machine, item, self.problem.ratings.offset)
                found.append(self.ripple_of(item, item.torque - torque / self.problem.gear_ratio))
        return found

    def ripple_of(self, item: Scenario, values: Array) -> Array:
        """Torque and speed ripple of columns of crank torque, each over that of the engine."""
        problem = self.problem
        before = item.torque - item.torque.mean()
        size = np.sqrt(before.size)
        rest = values - values.mean(axis=0)
        parts = [np.sqrt(problem.torque_weight) / (size * np.std(before)) * rest]
        if problem.speed_weight > 0:
            norm = size * float(np.std(_integral(before)))
            parts.append(np.sqrt(problem.speed_weight) / norm * _integral(rest))
        return np.concatenate(parts)

    def norms(self, state: _State) -> list[Norm]:
        problem, count = self.problem, self.problem.coefficients
        top, angle = self.highest(state.coefficients, state.machine)
        energy = self.turn.energy(state.coefficients)
        levels, found = self.residuals(state.coefficients, state.machine), []
        floor = problem.torque_reduction
        kept = floor is not None and TORQUE_REDUCTION not in problem.left_out
        ceiling = (1.0 - floor) * (1.0 - RESERVE) if kept and floor is not None else None
        weighted = [item for _, item, _ in self.scenarios if item.weight > 0]
        for item, level in zip(weighted, levels, strict=True):
            torque = partial(_torque, item, problem.ratings.offset)
            gradient = differentiated(torque, energy, top, state.machine, bool(problem.freed))
            slopes = self._dense(gradient["torque"], state, angle, count)
            change = self.ripple_of(item, -slopes / problem.gear_ratio)
            triangle = np.asarray(np.linalg.qr(np.column_stack([change, level]), mode="r"))
            found.append(Norm(triangle[:, -1], triangle[:, :-1], item.weight, ceiling))
        return found

    def _dense(self, gradient: Gradient, state: _State, angle: float, count: int) -> Array:
        return self._rows(gradient, self.turn, state, angle, count).toarray()

    def _rows(
        self, gradient: Gradient, grid: _Grid, state: _State, angle: float, count: int
    ) -> csr_array:
        """Derivatives by the scaled unknowns: coefficients, then what is freed."""
        machine = state.machine
        if gradient.value.size == 1 and gradient.local.shape[1] > 1:  # a mean of the turn
            whole = grid.sparse(gradient.local, count).sum(axis=0)
            own = csr_array(np.asarray(whole).reshape(1, count))
        else:
            own = grid.sparse(gradient.local, count)
        peak = _Grid.at(np.array([angle]), count)
        top = differentiated(
            _lift, peak.energy(state.coefficients), 0.0, machine, bool(self.problem.freed)
        )["lift"]
        summit = peak.sparse(top.local, count)
        own = own + csr_array(gradient.shared[0][:, None]) @ summit
        columns = [own * self.scale]
        for name in self.problem.freed:
            k = 1 + FREED.index(name)
            side = gradient.shared[k] + gradient.shared[0] * top.shared[k][0]
            columns.append(csr_array(side[:, None] * getattr(machine, name)))
        return hstack(columns, format="csr")

    def limits(self, state: _State, box: Array) -> list[Rows]:
        """Linear models of the limits, those left out that cannot matter within the box."""
        problem, count = self.problem, self.problem.coefficients
        top, angle = self.highest(state.coefficients, state.machine)
        reach = np.maximum(np.abs(box[0]), np.abs(box[1]))
        found: list[Rows] = []
        for grid, which in ((self.turn, 1), (self.extra, 2)):
            if not grid.theta.size:
                continue
            energy = grid.energy(state.coefficients)
            functions = [self.shape]
            functions += [partial(_loads, trio[which], problem.ratings) for trio in self.scenarios]
            for function in functions:
                gradients = differentiated(
                    function, energy, top, state.machine, bool(problem.freed)
                )
                for name, gradient in gradients.items():
                    mean = gradient.value.size == 1 and grid.theta.size > 1
                    if name in problem.left_out or (mean and which == 2):
                        continue
                    slopes = self._rows(gradient, grid, state, angle, count)
                    level = gradient.value - 1.0 + RESERVE
                    near = level + abs(slopes) @ reach >= 0
                    if near.any():
                        found.append(Rows(name, level[near], slopes[near]))
        return found + self._least_energy(state)

    def _least_energy(self, state: _State) -> list[Rows]:
        grid, extra = self.turn, len(self.problem.freed)
        low, high = self.problem.energy
        count = self.problem.coefficients
        energy = grid.energy(state.coefficients)[0]
        slopes = hstack(
            [grid.sparse(np.ones((1, grid.theta.size)), count),
             csr_array((grid.theta.size, extra))], format="csr",
        )  # fmt: skip
        found = [Rows("least_energy", (low - energy) / self.scale, -slopes, elastic=False)]
        if np.isfinite(high):
            k = int(np.argmin(energy))
            found.append(Rows("initial_energy", (energy[[k]] - high) / self.scale, slopes[[k]]))
        return found

    def moved(self, state: _State, step: Array) -> tuple[Array, Machine]:
        count = self.problem.coefficients
        machine = state.machine
        for name, part in zip(self.problem.freed, step[count:], strict=True):
            machine = replace(machine, **{name: getattr(machine, name) * (1.0 + float(part))})
        return state.coefficients + self.scale * step[:count], machine

    def box(self, state: _State, trust: float) -> Array:
        count = self.problem.coefficients
        low, high = [np.full(count, -trust)], [np.full(count, trust)]
        for name, (least, greatest) in self.problem.freed.items():
            now = getattr(state.machine, name)
            low.append(np.array([max(least / now - 1.0, -trust)]))
            high.append(np.array([min(greatest / now - 1.0, trust)]))
        return np.stack([np.concatenate(low), np.concatenate(high)])


def synthesise(problem: Problem, ripple_weight: float = 1.0) -> Design:
    """The cam of least delivered ripple within all limits.

    Parameters
    ----------
    problem : Problem
    ripple_weight : float   0 asks for any cam within the limits

    Returns
    -------
    Design   not `feasible` where no cam near the way keeps the limits

    References
    ----------
    Fletcher, Practical Methods of Optimization (1987), sec. 14.4: sequential programming with an
    exact penalty and a trust region.
    """
    extra: Array | None = None
    seed = problem
    for _ in range(4):
        search = Search(seed, extra)
        state, answer, steps, converged = _descended(search, ripple_weight)
        between = _between(search, state)
        if not between.size:
            break
        extra = between if extra is None else np.unique(np.concatenate([extra, between]))
        seed = replace(problem, seed=state.coefficients, machine=state.machine)
    return _design(search, state, answer, steps, converged)


def _descended(search: Search, ripple_weight: float) -> tuple[_State, Answer | None, int, bool]:
    state = search.state(search.start, search.problem.machine)
    trust, penalty = 0.3, _PENALTY
    last: Answer | None = None
    for step in range(1, _STEPS_MAX + 1):
        norms = search.norms(state)
        while True:
            box = search.box(state, trust)
            slope = np.zeros(box.shape[1])
            count = search.problem.coefficients
            slope[:count] = search.scale * (search.jerk @ state.coefficients)
            curvature = np.zeros((slope.size, slope.size))
            curvature[:count, :count] = search.scale**2 * search.jerk
            rows = search.limits(state, box)
            answer = solved(norms, rows, curvature, slope, box, penalty, ripple_weight)
            if answer is None:
                trust *= 0.3
                if trust < 1e-7:
                    return state, last, step, False
                continue
            there = search.state(*search.moved(state, answer.step))
            now = state.merit(penalty, ripple_weight)
            foreseen = now - answer.objective - state.jerk
            gained = now - there.merit(penalty, ripple_weight)
            if foreseen <= _CONVERGED:
                feasible = all(v <= 1.0 - RESERVE + FEASIBLE for v in state.utilisation.values())
                if not feasible and penalty < _PENALTY_MAX:
                    penalty *= 10.0
                    trust = max(trust, 0.1)
                    continue
                return (there if gained > 0 else state), answer, step, True
            share = gained / foreseen
            if share > 0.05:
                state, last = there, answer
                trust = min(trust * (2.0 if share > 0.7 else 1.0 if share > 0.25 else 0.5), 1.0)
                break
            trust *= 0.35
            if trust < 1e-7:
                return state, last, step, False
    return state, last, _STEPS_MAX, False


def _between(search: Search, state: _State) -> Array:
    """Angles between the points where a limit is passed that holds on them."""
    fine = _Grid.at(uniform_turn(_FINEST * search.problem.points), search.problem.coefficients)
    found: list[Array] = []
    for name, value in search.utilisations(state.coefficients, state.machine, fine).items():
        if np.size(value) == 1:
            continue
        bound = max(1.0 - 0.5 * RESERVE, state.utilisation[name] + 0.2 * RESERVE)
        peak = (value >= np.roll(value, 1)) & (value > np.roll(value, -1)) & (value > bound)
        found.append(fine.theta[peak])
    return np.unique(np.concatenate(found)) if found else np.zeros(0)


def _design(
    search: Search, state: _State, answer: Answer | None, steps: int, converged: bool
) -> Design:
    prices: dict[str, float] = {}
    strip: dict[str, tuple[Array, Array]] = {}
    if answer is not None:
        for name, values in answer.multipliers.items():
            if name != "least_energy" and values.sum() > 1e-6:
                prices[name] = float(values.sum())
    for name, value in search.utilisations(state.coefficients, state.machine, search.turn).items():
        strip[name] = (search.turn.theta, np.broadcast_to(value, search.turn.theta.shape))
    return Design(
        coefficients=readonly(state.coefficients),
        machine=state.machine,
        ripple=state.ripple,
        utilisation=state.utilisation,
        multipliers=prices,
        strip=strip,
        steps=steps,
        converged=converged,
    )


def _lift(jet: Jet, _top: Values, _machine: Machine) -> Mapping[str, Values | Mean]:
    return {"lift": jet.lift}


def _torque(
    scenario: Scenario, offset: float, jet: Jet, top: Values, machine: Machine
) -> Mapping[str, Values | Mean]:
    return {"torque": delivered_torque(jet, top, machine, scenario, offset)}


def _loads(
    scenario: Scenario, ratings: Ratings, jet: Jet, top: Values, machine: Machine
) -> Mapping[str, Values | Mean]:
    return load_utilisations(jet, top, machine, ratings, scenario)


def _integral(values: Array) -> Array:
    """Integral of periodic columns by the angle, its mean taken off; of a turn of any length."""
    spectrum = np.fft.rfft(values, axis=0)
    order = np.arange(spectrum.shape[0]).reshape(-1, *[1] * (spectrum.ndim - 1))
    spectrum = np.divide(spectrum, 1j * order, out=np.zeros_like(spectrum), where=order > 0)
    return np.fft.irfft(spectrum, n=values.shape[0], axis=0)
