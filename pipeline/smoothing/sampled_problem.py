"""Functions of a synthesis problem at sampled cam angles, and their linear models."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, uniform_turn
from camwright.pipeline.case.limits import PRESSURE_ANGLE, TORQUE_REDUCTION
from camwright.pipeline.smoothing.cone_program import Norm
from camwright.pipeline.smoothing.constraints import (
    Jet,
    Mean,
    delivered_torque,
    lift_jet,
    load_utilisations,
    shape_utilisations,
)
from camwright.pipeline.smoothing.energy_spline import Grid, basis_matrix, exact_start
from camwright.pipeline.smoothing.gradients import FREED, Function, Gradient, differentiated
from camwright.pipeline.smoothing.linear_model import Linear, Model, State, Summit
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario
from camwright.pipeline.smoothing.synthesis_problem import (
    RESERVE,
    Problem,
    ripple_of,
    torque_ripple,
    triangle,
)

INITIAL_ENERGY = "initial_energy"
LEAST_ENERGY = "least_energy"


class Search:
    """Functions of one problem on a uniform grid, with extra angles between its points."""

    def __init__(self, problem: Problem, extra: Array | None = None) -> None:
        self.problem = problem
        count = problem.coefficients
        self.turn = Grid.at(uniform_turn(problem.points), count)
        self.extra = Grid.at(np.zeros(0) if extra is None else extra, count)
        self.exact = self._exact()
        self.start = self.exact if problem.seed is None else problem.seed
        self.scale = max(float(np.abs(self.exact).max()), 1e-9)
        exact = lift_jet(self.turn.energy(self.exact), problem.variables)
        # Scaled so that the second derivative of the exact energy has the norm 1.
        bend = basis_matrix(self.turn.theta, count, 2) * self.scale
        size = float(np.linalg.norm(bend @ self.exact)) / self.scale or 1.0
        self.bend = np.asarray(np.linalg.qr(bend.toarray() / size, mode="r"))
        self._jerk_scale = np.sqrt(problem.jerk_weight) / (float(np.linalg.norm(exact.jerk)) or 1.0)

    @property
    def size(self) -> int:
        """Number of unknowns: coefficients, then free variables."""
        return self.problem.coefficients + len(self.problem.freed)

    def _exact(self) -> Array:
        problem, variables = self.problem, self.problem.variables
        first = max(problem.scenarios, key=lambda item: item.weight)
        torque = problem.gear_ratio * first.torque
        ratings = problem.ratings
        travel = np.inf if ratings.travel is None else ratings.travel * (1.0 - RESERVE)
        exact = exact_start(
            torque - torque.mean(),
            problem.coefficients,
            rate=variables.rate,
            preload=variables.preload,
            prime_radius=variables.prime_radius,
            pressure_angle=ratings.limits.get(PRESSURE_ANGLE, np.pi / 3),
            energy_max=variables.preload * travel + 0.5 * variables.rate * travel**2,
        )
        rise = float(np.clip(0.0, problem.energy[0] - 1e-12, problem.energy[1]))
        least = float(self.turn.energy(exact)[0].min())
        return exact if least <= problem.energy[1] else exact - least + rise

    def _summit_angle(self, coefficients: Array) -> float:
        """Cam angle of maximum lift, refined between the points, rad."""
        theta = self.turn.theta
        energy = self.turn.energy(coefficients)[0]
        k = int(np.argmax(energy))
        step = theta[1]
        before, here, after = energy[k - 1], energy[k], energy[(k + 1) % energy.size]
        curve = before - 2.0 * here + after
        shift = 0.0 if curve >= 0 else 0.5 * (before - after) / curve
        angle = float(theta[k] + step * np.clip(shift, -1.0, 1.0))
        for _ in range(2):  # Newton on E' = 0
            _, slope, bend, _ = Grid.at(np.array([angle]), coefficients.size).energy(coefficients)
            if bend[0] < 0:
                angle -= float(np.clip(slope[0] / bend[0], -step, step))
        return angle

    def highest(self, coefficients: Array, variables: DesignVariables) -> float:
        """Maximum lift, refined between the points, m."""
        peak = Grid.at(np.array([self._summit_angle(coefficients)]), coefficients.size)
        return float(lift_jet(peak.energy(coefficients), variables).lift[0])

    def _summit(self, coefficients: Array, variables: DesignVariables) -> Summit:
        peak = Grid.at(np.array([self._summit_angle(coefficients)]), coefficients.size)
        freed = bool(self.problem.freed)
        lift = differentiated(_lift, peak.energy(coefficients), 0.0, variables, freed)["lift"]
        return Summit(
            float(lift.value[0]), peak.chained(lift.local)[0], peak.columns[0], lift.shared[:, 0]
        )

    def _scenarios(self, grid: Grid, variables: DesignVariables) -> list[Scenario]:
        """Scenarios with their corrections at the angles of a grid."""
        theta = grid.theta + float(variables.phase)
        return [
            replace(item, correction=item.correction.at(theta)) for item in self.problem.scenarios
        ]

    def _functions(self, grid: Grid, variables: DesignVariables) -> list[Function]:
        ratings = self.problem.ratings
        loads = [partial(_loads, item, ratings) for item in self._scenarios(grid, variables)]
        return [partial(_shape, ratings), *loads]

    def utilisations(
        self, coefficients: Array, variables: DesignVariables, grid: Grid
    ) -> dict[str, Array]:
        """Utilisations on a grid, (n,), or (1,) for means; the greatest of the scenarios."""
        jet = lift_jet(grid.energy(coefficients), variables)
        top = self.highest(coefficients, variables)
        uses: dict[str, Array] = {}
        for function in self._functions(grid, variables):
            for name, value in function(jet, top, variables).items():
                if name not in self.problem.left_out:
                    use = value.value if isinstance(value, Mean) else value
                    uses[name] = np.maximum(uses[name], use) if name in uses else use
        return uses

    def state(self, coefficients: Array, variables: DesignVariables) -> State:
        """State at coefficients, J, and variables."""
        uses = self.utilisations(coefficients, variables, self.turn)
        most = {name: float(np.max(value)) for name, value in uses.items()}
        if self.extra.theta.size:
            more = self.utilisations(coefficients, variables, self.extra)
            for name, value in more.items():
                if uses[name].size > 1:  # a mean over the extra angles is none over the turn
                    most[name] = max(most[name], float(np.max(value)))
        energy = self.turn.energy(coefficients)
        if np.isfinite(self.problem.energy[1]):
            over = float(energy[0].min()) - self.problem.energy[1]
            most[INITIAL_ENERGY] = 1.0 - RESERVE + over / self.scale
        ripple = 0.0
        for item, left in self.residual_torque(coefficients, variables):
            ripple = max(
                ripple, item.weight * float(np.linalg.norm(ripple_of(self.problem, item, left)))
            )
            if self.problem.ceiling is not None:
                over = float(np.linalg.norm(torque_ripple(item, left))) - self.problem.ceiling
                used = 1.0 - RESERVE + over
                most[TORQUE_REDUCTION.id] = max(most.get(TORQUE_REDUCTION.id, used), used)
        jerk = self._jerk_scale * lift_jet(energy, variables).jerk
        return State(coefficients, variables, ripple, 0.5 * float(jerk @ jerk), most)

    def residual_torque(
        self, coefficients: Array, variables: DesignVariables
    ) -> list[tuple[Scenario, Array]]:
        """Crank torque with the cam (n,), N m, of each scenario whose ripple counts."""
        jet = lift_jet(self.turn.energy(coefficients), variables)
        top = self.highest(coefficients, variables)
        problem, residuals = self.problem, []
        for item in self._scenarios(self.turn, variables):
            if item.weight > 0:
                torque = delivered_torque(jet, top, variables, item, problem.ratings.offset)
                engine = item.torque_at(float(variables.phase))[0]
                residuals.append((item, engine - torque / problem.gear_ratio))
        return residuals

    def model(self, state: State) -> Model:
        """Linear models of ripple and limits, quadratic model of the jerk, at a state."""
        summit = self._summit(state.coefficients, state.variables)
        energy = self.turn.energy(state.coefficients)
        freed = bool(self.problem.freed)
        gradient = differentiated(_jerk, energy, 0.0, state.variables, freed)["jerk"]
        jerk = self._jerk_scale * self._dense(gradient, state, summit)
        return Model(
            norms=self._norms(state, summit),
            limits=self._limits(state, summit),
            curvature=jerk.T @ jerk,
            slope=jerk.T @ (self._jerk_scale * gradient.value),
        )

    def _norms(self, state: State, summit: Summit) -> list[Norm]:
        problem, variables = self.problem, state.variables
        energy = self.turn.energy(state.coefficients)
        weighted = [item for item in self._scenarios(self.turn, variables) if item.weight > 0]
        norms = []
        for item in weighted:
            torque = partial(_torque, item, problem.ratings.offset)
            freed = bool(problem.freed)
            gradient = differentiated(torque, energy, summit.lift, variables, freed)["torque"]
            engine, by_phase = item.torque_at(float(variables.phase))
            left = engine - gradient.value / problem.gear_ratio
            slopes = -self._dense(gradient, state, summit) / problem.gear_ratio
            if "phase" in problem.freed:
                slopes[:, problem.coefficients + list(problem.freed).index("phase")] += by_phase
            columns = np.column_stack([slopes, left])
            charged = triangle(ripple_of(problem, item, columns))
            if problem.speed_weight == 0.0 and problem.torque_weight == 1.0:
                norms.append(Norm(*charged, item.weight, problem.ceiling))
                continue
            norms.append(Norm(*charged, item.weight))
            if problem.ceiling is not None:
                bounded = triangle(torque_ripple(item, columns))
                norms.append(Norm(*bounded, weight=0.0, ceiling=problem.ceiling))
        return norms

    def _dense(self, gradient: Gradient, state: State, summit: Summit) -> Array:
        model = self._linear("", gradient, self.turn, state, summit)
        every = np.ones(model.level.size, dtype=bool)
        return np.asarray(model.matrix(every, self.size).toarray())

    def _linear(
        self, name: str, gradient: Gradient, grid: Grid, state: State, summit: Summit
    ) -> Linear:
        """Linear model of one limit in the scaled unknowns: coefficients, then free variables."""
        own = grid.chained(gradient.local)
        columns: NDArray[np.intp] = grid.columns
        height = gradient.value.size
        if gradient.mean:
            count = self.problem.coefficients
            own = np.asarray(np.bincount(columns.ravel(), own.ravel(), count)[None], dtype=float)
            columns = np.arange(count, dtype=np.intp)[None]
        entries, places = [own * self.scale], [columns]
        by_top = gradient.shared[0]
        if by_top.any():
            entries.append(self.scale * by_top[:, None] * summit.entries)
            places.append(np.broadcast_to(summit.columns, (height, summit.columns.size)))
        for number, freed in enumerate(self.problem.freed):
            if freed in FREED:
                k = 1 + FREED.index(freed)
                side = gradient.shared[k] + by_top * summit.shared[k]
                entries.append(side[:, None] * getattr(state.variables, freed))
                places.append(np.full((height, 1), self.problem.coefficients + number))
        level = gradient.value - 1.0 + RESERVE
        return Linear(name, level, np.hstack(entries), np.hstack(places))

    def _limits(self, state: State, summit: Summit) -> list[Linear]:
        problem, models = self.problem, []
        for grid in (self.turn, self.extra):
            if not grid.theta.size:
                continue
            energy = grid.energy(state.coefficients)
            for function in self._functions(grid, state.variables):
                gradients = differentiated(
                    function, energy, summit.lift, state.variables, bool(problem.freed)
                )
                for name, gradient in gradients.items():
                    kept = name not in problem.left_out
                    if kept and not (gradient.mean and grid is self.extra):
                        models.append(self._linear(name, gradient, grid, state, summit))
        return models + self._least_energy(state)

    def _least_energy(self, state: State) -> list[Linear]:
        low, high = self.problem.energy
        energy = self.turn.energy(state.coefficients)[0]
        entries, columns = self.turn.entries[0], self.turn.columns
        models = [Linear(LEAST_ENERGY, (low - energy) / self.scale, -entries, columns, False)]
        if np.isfinite(high):
            k = int(np.argmin(energy))
            level = (energy[[k]] - high) / self.scale
            models.append(Linear(INITIAL_ENERGY, level, entries[[k]], columns[[k]]))
        return models

    def after(self, state: State, step: Array) -> tuple[Array, DesignVariables]:
        """Coefficients, J, and variables after a step in the scaled unknowns."""
        count, variables = self.problem.coefficients, state.variables
        for name, part in zip(self.problem.freed, step[count:], strict=True):
            value = getattr(variables, name) + _unit(name, variables) * float(part)
            variables = replace(variables, **{name: value})
        return state.coefficients + self.scale * step[:count], variables

    def box(self, state: State, trust: float) -> Array:
        """Least and greatest step within trust region and ranges, (2, size)."""
        count = self.problem.coefficients
        low, high = np.full(self.size, -trust), np.full(self.size, trust)
        for number, (name, (least, greatest)) in enumerate(self.problem.freed.items()):
            now, unit = getattr(state.variables, name), _unit(name, state.variables)
            low[count + number] = max((least - now) / unit, -trust)
            high[count + number] = min((greatest - now) / unit, trust)
        return np.stack([low, high])


def _unit(name: str, variables: DesignVariables) -> float:
    """Unit of a step of a free variable: its value, or 1 rad."""
    return 1.0 if name == "phase" else float(getattr(variables, name))


def _lift(jet: Jet, _top: float, _machine: DesignVariables) -> Mapping[str, Array | Mean]:
    return {"lift": jet.lift}


def _jerk(jet: Jet, _top: float, _machine: DesignVariables) -> Mapping[str, Array | Mean]:
    return {"jerk": jet.jerk}


def _torque(
    scenario: Scenario, offset: float, jet: Jet, top: float, variables: DesignVariables
) -> Mapping[str, Array | Mean]:
    return {"torque": delivered_torque(jet, top, variables, scenario, offset)}


def _shape(
    ratings: Ratings, jet: Jet, _top: float, variables: DesignVariables
) -> Mapping[str, Array | Mean]:
    return shape_utilisations(jet, variables, ratings)


def _loads(
    scenario: Scenario, ratings: Ratings, jet: Jet, top: float, variables: DesignVariables
) -> Mapping[str, Array | Mean]:
    return load_utilisations(jet, top, variables, ratings, scenario)
