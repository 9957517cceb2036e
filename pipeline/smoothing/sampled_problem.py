"""Functions of a synthesis problem at sampled cam angles, with linear models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.lift import Jet
from camwright.pipeline.case.limits import PRESSURE_ANGLE, TORQUE_REDUCTION
from camwright.pipeline.checks.cam_shape import spring_travel
from camwright.pipeline.follower.spring import spring_energy
from camwright.pipeline.smoothing.cam_state import Mean, ScenarioCam, lift_jet, loaded
from camwright.pipeline.smoothing.cone_program import IdleForces, Linear, Norm
from camwright.pipeline.smoothing.constraints import (
    SHAPE,
    delivered_torque,
    shape_utilisations,
    utilisations_of,
)
from camwright.pipeline.smoothing.energy_spline import (
    Grid,
    basis_matrix,
    breadth_changes,
    exact_start,
    odd_part,
    of_constant_breadth,
    reversals,
    spline_of,
)
from camwright.pipeline.smoothing.gradients import (
    FREED,
    Function,
    Gradient,
    Point,
    differentiated,
)
from camwright.pipeline.smoothing.linear_model import Model, State, Summit
from camwright.pipeline.smoothing.objective import (
    LOSS,
    Cost,
    costs,
    residuals_slope,
    torque_ripple,
)
from camwright.pipeline.smoothing.scenario import (
    DesignVariables,
    Ratings,
    Scenario,
    joined,
    stacked,
    taken,
)
from camwright.pipeline.smoothing.synthesis_problem import (
    RESERVE,
    Problem,
    ripple_of,
    triangle,
)

INITIAL_ENERGY = "initial_energy"
LEAST_ENERGY = "least_energy"
HIGHEST_PEAK = "highest_peak"
KEPT_SIDE = "kept_side"
SHAPE_LIMITS = frozenset(each.name for each in SHAPE)
# Distance from a limit within which a row is in the model; from another scenario at that angle.
_NEAR_LIMIT, _BEHIND_WORST = 0.05, 0.01
_RIPPLE_BEHIND = 0.005  # of the engine's ripple: the same for the ripples of the scenarios
_PEAKS = 0.1  # of the range of the energy, below its maximum, of peaks that may become the highest
_NEAR_CROSSING = 0.02  # of the greatest force, below which a step may change the track
_FORCE_STEP = 1e-30  # N, complex step of a force
_FARTHEST = 1.0  # greatest step of a coefficient, of the scale
_SIGN_SLOPE = 1e-6  # of the greatest slope of the energy: least slope where its sign is to be kept


class Means(NamedTuple):
    """Limits and costs by means over the turn, in some scenarios.

    function, at      of the terms by scenario and point, and its arguments
    scenarios         numbers of the scenarios
    places : mapping  numbers of the utilisations that the function gives, by limit
    """

    function: Function
    at: Point
    scenarios: NDArray[np.intp]
    places: Mapping[str, NDArray[np.intp]]


class Search:
    """Problem sampled on a uniform grid of cam angles, with extra angles in between.

    Friction of the guides changes its sign where the follower reverses, and with a roller of an
    offset loads jump there. The limits then hold at the reversals too, before and after each: these
    angles move with the cam, so that the greatest utilisation of a limit does not jump as one
    passes a point. At the points beside one the friction is the mean over their cells, see
    `Scenario.cell`, so that means over the turn do not jump either.

    Parameters
    ----------
    extra : array (e,)   cam angles, rad, at which the limits hold too
    """

    def __init__(self, problem: Problem, extra: Array | None = None) -> None:
        """Set up the cam angles, the start and the scales of the unknowns; `extra`: further cam
        angles of the limits, rad.
        """
        self.problem = problem
        theta = uniform_turn(problem.points)
        self.extra = np.zeros(0) if extra is None else extra
        self.turn = problem.grid(theta)
        self.grid = (
            problem.grid(np.concatenate([theta, self.extra])) if self.extra.size else self.turn
        )
        self.every = np.arange(problem.points, dtype=np.intp)
        self._jumps = problem.ratings.tilting * problem.ratings.offset != 0.0
        self.weighted = [
            k
            for k, item in enumerate(problem.scenarios)
            if item.weight > 0 or problem.ceiling_of(item) is not None
        ]
        self._weights = np.array([[item.weight] for item in problem.scenarios])
        # Lives add over the load cases at a tolerance corner, without a duty in none.
        apart = any(item.duty is None for item in problem.scenarios)
        self._corners = np.array(
            [k if apart else item.corner for k, item in enumerate(problem.scenarios)]
        )
        self._scale = problem.scale
        self.costs = frozenset(
            each.term.key for each in problem.objective if isinstance(each.term, Cost)
        )
        self._last: tuple[Array, Grid] | None = None  # coefficients and their peak
        self._stacks: dict[float, Scenario] = {}
        self._engines: dict[float, Array] = {}
        of_lift, count = problem.variables.of_lift, problem.coefficients
        self.still = breadth_changes(count) if of_lift else None
        self.exact = self._drawn(self._exact())
        self.start = self.exact if problem.seed is None else problem.seed
        self.scale = max(float(np.abs(self.exact).max()), 1e-9)
        exact = lift_jet(self.turn.energy(self.exact), problem.variables)
        # Scaled so that the second derivative of the exact energy has the norm 1.
        curved = basis_matrix(theta, problem.coefficients, 2, problem.lobes) * self.scale
        size = float(np.linalg.norm(curved @ self.exact)) / self.scale or 1.0
        self.root_hessian = np.asarray(np.linalg.qr(curved.toarray() / size, mode="r"))
        self._jerk_scale = np.sqrt(problem.jerk_weight) / (float(np.linalg.norm(exact.jerk)) or 1.0)

    @property
    def size(self) -> int:
        """Number of unknowns: coefficients and free variables."""
        return self.problem.coefficients + len(self.problem.freed)

    def _drawn(self, energy: Array) -> Array:
        """Coefficients of the unknowns from those of an energy, J: the same, or of the lift of
        constant breadth nearest to its own, m.
        """
        variables, count = self.problem.variables, self.problem.coefficients
        if not variables.of_lift:
            return energy
        lobe = self.problem.grid(uniform_turn(8 * count) / self.problem.lobes)
        lift = lift_jet(lobe.energy(energy), replace(variables, of_lift=False)).lift
        return of_constant_breadth(spline_of(lift, count))

    def _exact(self) -> Array:
        """Coefficients of the energy, J, that balances the torque of the scenario of greatest
        weight, within the limits of travel and pressure angle, or face width; see `exact_start`.

        Shifted as a whole where its minimum is above the greatest initial energy allowed.
        """
        problem, variables = self.problem, self.problem.variables
        first = max(problem.scenarios, key=lambda item: item.weight)
        torque = problem.gear_ratio * first.torque
        ratings = problem.ratings
        travel = ratings.bounds.get(spring_travel.id, np.inf) * (1.0 - RESERVE)
        exact = exact_start(
            torque - torque.mean(),
            problem.coefficients,
            rate=variables.rate,
            preload=variables.closing,
            shape=variables.shape,
            prime_radius=variables.prime_radius,
            lobes=problem.lobes,
            pressure_angle=ratings.bounds.get(PRESSURE_ANGLE.id, np.pi / 3),
            slope_max=ratings.slope_max,
            energy_max=float(
                spring_energy(variables.closing, variables.rate, travel, variables.shape)
            ),
        )
        rise = float(np.clip(0.0, problem.energy[0] - 1e-12, problem.energy[1]))
        least = float(self.turn.energy(exact)[0].min())
        return exact if least <= problem.energy[1] else exact - least + rise

    def highest(self, coefficients: Array, variables: DesignVariables) -> float:
        """Maximum lift, refined between the points, m."""
        return float(lift_jet(self._peaks(coefficients).energy(coefficients), variables).lift[0])

    def _peaks(self, coefficients: Array) -> Grid:
        """Splines at the cam angles of the local maxima of the energy, so of the lift, that are
        within `_PEAKS` of its range below the maximum; the highest first.

        Refined between the points by a parabola and Newton's method; of equal lobes those of one.

        Parameters
        ----------
        coefficients : array   of the energy of a lobe, J
        """
        if self._last is not None and self._last[0] is coefficients:
            return self._last[1]
        lobe, step = self.problem.points // self.problem.lobes, self.turn.theta[1]
        energy = self.turn.energy(coefficients)[0][:lobe]
        before, after = np.roll(energy, 1), np.roll(energy, -1)
        high = energy >= energy.max() - _PEAKS * np.ptp(energy)
        k = np.flatnonzero(high & (energy >= before) & (energy > after))
        k = k if k.size else np.array([int(np.argmax(energy))])
        curve = before[k] - 2.0 * energy[k] + after[k]
        shift = np.divide(
            0.5 * (before[k] - after[k]), curve, out=np.zeros(k.size), where=curve < 0.0
        )
        angle = self.turn.theta[k] + step * np.clip(shift, -1.0, 1.0)
        for _ in range(2):  # Newton on E' = 0
            _, slope, energy_d2, _ = self.problem.grid(angle).energy(coefficients)
            newton = np.divide(slope, energy_d2, out=np.zeros(k.size), where=energy_d2 < 0.0)
            angle = angle - np.clip(newton, -step, step)
        peaks = self.problem.grid(angle)
        order = np.argsort(-peaks.energy(coefficients)[0], kind="stable")
        self._last = (
            coefficients,
            Grid(angle[order], peaks.columns[order], peaks.entries[:, order]),
        )
        return self._last[1]

    def summit(self, state: State) -> Summit:
        """Maximum lift at a state, m, with its derivatives by coefficients and free variables."""
        peaks = self._peaks(state.coefficients)
        at = Point(peaks.energy(state.coefficients), 0.0, state.variables)
        lift = differentiated(_lift, at, self.freed)["lift"]
        return Summit(
            float(lift.terms[0]), peaks.chained(lift.local)[0], peaks.columns[0], lift.shared[:, 0]
        )

    def _lower_peaks(self, state: State) -> list[Linear]:
        """Linear rows that keep the other peaks of the lift below the highest one, whose
        derivatives the models have.
        """
        peaks = self._peaks(state.coefficients)
        energy = peaks.energy(state.coefficients)[0][1:] - peaks.energy(state.coefficients)[0][0]
        count = energy.size
        if not count:
            return []
        entries, columns = peaks.entries[0], peaks.columns
        first = np.broadcast_to(entries[0], (count, entries.shape[1]))
        places = np.broadcast_to(columns[0], first.shape)
        none = np.full(count, -1)
        return [
            Linear(
                HIGHEST_PEAK,
                energy / self.scale,
                np.hstack([entries[1:], -first]),
                np.hstack([columns[1:], places]),
                none,
                none,
                elastic=False,
            )
        ]

    @property
    def freed(self) -> bool:
        """Whether a design variable is free."""
        return bool(self.problem.freed)

    def stack(self, grid: Grid, variables: DesignVariables) -> Scenario:
        """All scenarios as one, (s, n), with torques and corrections at the cam angles (n,) of a
        grid advanced by the phase of the cam.
        """
        phase = float(variables.phase)
        if grid is not self.grid:
            return stacked(self.problem.scenarios, grid.theta + phase)
        if phase not in self._stacks:
            self._stacks = {phase: stacked(self.problem.scenarios, grid.theta + phase)}
        return self._stacks[phase]

    def _angles(self, coefficients: Array, variables: DesignVariables) -> tuple[Grid, Scenario]:
        """Splines and stacked scenarios at the cam angles at which the limits hold.

        Where loads jump at a reversal of the follower, its angle is added, from either side, and
        the points beside it stand for their cell; see `Scenario`.

        Parameters
        ----------
        coefficients : array          of the energy of a lobe, J
        variables : DesignVariables   with the phase
        """
        stack = self.stack(self.grid, variables)
        if not self._jumps:
            return self.grid, stack
        moving = reversals(self.turn, coefficients, self.problem.lobes)
        if not moving.theta.size:
            return self.grid, stack
        beside = (moving.theta / self.turn.theta[1]).astype(np.intp)
        cell = np.zeros(self.grid.theta.size)
        cell[np.append(beside, beside + 1) % self.every.size] = self.turn.theta[1]
        stack = replace(stack, cell=np.broadcast_to(cell, stack.external.shape))
        return self.grid.joined(moving), joined(stack, self.stack(moving, variables))

    def shape(self, names: frozenset[str] | None = None) -> Function:
        """Limits on the shape of the cam."""
        return partial(self._shape, names)

    def at_pairs(
        self,
        names: frozenset[str],
        state: State,
        rows: NDArray[np.intp],
        points: NDArray[np.intp],
    ) -> Function:
        """As `function`, at pairs (m,) of row and angle of a state: the row is the scenario of a
        limit on loads, the disc of one on a contour.
        """
        if not names <= SHAPE_LIMITS:
            return self.function(names, state, self.pairs(state, rows, points))

        def on_discs(
            jet: Jet, top: float, variables: DesignVariables
        ) -> Mapping[str, Array | Mean]:
            uses = self._shape(names, jet, top, variables)
            return {
                name: use if isinstance(use, Mean) or use.ndim == 1
                else use[rows, np.arange(points.size)]
                for name, use in uses.items()
            }  # fmt: skip

        return on_discs

    def function(
        self, names: frozenset[str], state: State, take: Callable[[Array], Array]
    ) -> Function:
        """Function of energy and derivatives, maximum lift and variables that gives the
        utilisations of some limits, or costs, by name, for differentiation.

        Parameters
        ----------
        names : frozenset   limits of the shape alone, or limits of the loads and costs
        state : State       with the stacked scenarios
        take : callable     selects scenarios and angles from a stacked array
        """
        if names <= SHAPE_LIMITS:
            return self.shape(names)
        stack = taken(state.stack, take)
        return partial(self._loads, names, stack, take(self._weights))

    def _loads(
        self, names: frozenset[str], stack: Scenario, weights: Array, jet: Jet, top: float,
        variables: DesignVariables,
    ) -> Mapping[str, Array | Mean]:  # fmt: skip
        """Limits and costs of those names, of stacked scenarios of these weights (s, 1)."""
        loads = loaded(jet, top, variables, self.problem.ratings, stack)
        charged = self._charged(names, weights, loads, variables)
        return {**self._judged(utilisations_of(loads, names)), **charged}

    def _shape(
        self, names: frozenset[str] | None, jet: Jet, top: float, variables: DesignVariables
    ) -> Mapping[str, Array | Mean]:
        return self._judged(shape_utilisations(jet, variables, self.problem.ratings, names, top))

    def _judged(self, uses: Mapping[str, Array | Mean]) -> Mapping[str, Array | Mean]:
        """Utilisations as a run judges them, see `Problem`."""
        ratios = self.problem.judged
        return {
            name: use
            if name not in ratios
            else use._replace(factor=ratios[name])
            if isinstance(use, Mean)
            else ratios[name] * use
            for name, use in uses.items()
        }

    def _charged(
        self, names: frozenset[str], weights: Array, loads: ScenarioCam, variables: DesignVariables
    ) -> Mapping[str, Array | Mean]:
        """Costs of those names, of a cam in stacked scenarios of these weights (s, 1)."""
        objective = tuple(each for each in self.problem.objective if each.term.key in names)
        return costs(objective, self._scale, weights, loads, variables)

    def pairs(
        self, state: State, rows: NDArray[np.intp], points: NDArray[np.intp]
    ) -> Callable[[Array], Array]:
        """Values at pairs (m,) of scenario and angle of a state."""
        shape = (len(self.problem.scenarios), state.grid.theta.size)
        return lambda each: np.broadcast_to(each, shape)[rows, points]

    def level(self, name: str, value: Array) -> Array:
        """Row level of a limit, <= 0 within its reserve; of a cost its value."""
        return value if name in self.costs else value - 1.0 + RESERVE

    def torque(self, state: State, weighted: NDArray[np.intp]) -> Function:
        """Cam torque of some of the weighted scenarios at the points of the turn, (w, n)."""
        return partial(_torque, self._weighted_stack(state, weighted), self.problem.ratings)

    def _weighted_stack(self, state: State, weighted: NDArray[np.intp] | None = None) -> Scenario:
        rows = np.array(self.weighted, dtype=np.intp)
        rows = rows if weighted is None else rows[weighted]
        return taken(state.stack, self.turns(rows))

    def point(self, state: State, highest: float, points: NDArray[np.intp]) -> Point:
        """Arguments of a function at some angles of a state."""
        energy = state.grid.energy(state.coefficients)
        return Point(tuple(part[points] for part in energy), highest, state.variables)

    def utilisations(
        self, coefficients: Array, variables: DesignVariables, grid: Grid
    ) -> dict[str, Array]:
        """Utilisation of each limit by name, greatest over the scenarios: (n,) at the cam angles of
        a uniform grid; (1,) for a limit on a mean over the turn.

        Parameters
        ----------
        coefficients : array          of the energy of a lobe, J
        variables : DesignVariables   with which it is a cam
        grid : Grid                   n equal cam angles
        """
        loads = self.loads_at(coefficients, variables, grid)
        pointwise, means = self._uses(loads, variables, grid.theta.size)
        worst = {name: value.max(axis=0) for name, value in pointwise.items()}
        return worst | {name: each.value.max(keepdims=True) for name, each in means.items()}

    def pointwise(
        self, coefficients: Array, variables: DesignVariables, grid: Grid
    ) -> dict[str, Array]:
        """Utilisation (n,) of each limit at single cam angles by name, greatest over the scenarios;
        limits on means over the turn and costs are left out.

        Parameters
        ----------
        coefficients : array          of the energy of a lobe, J
        variables : DesignVariables   with which it is a cam
        grid : Grid                   n cam angles
        """
        loads = self.loads_at(coefficients, variables, grid)
        values, _ = self._uses(loads, variables, 0)
        limits = values.keys() - self.costs
        return {name: value.max(axis=0) for name, value in values.items() if name in limits}

    def loads_at(self, coefficients: Array, variables: DesignVariables, grid: Grid) -> ScenarioCam:
        """Cam of an energy, by its coefficients, J, in all scenarios at the angles of a grid."""
        return self._loaded(coefficients, variables, grid, self.stack(grid, variables))

    def _loaded(
        self, coefficients: Array, variables: DesignVariables, grid: Grid, stack: Scenario
    ) -> ScenarioCam:
        """Cam at the angles of a grid in the stacked scenarios."""
        return loaded(
            lift_jet(grid.energy(coefficients), variables),
            self.highest(coefficients, variables),
            variables,
            self.problem.ratings,
            stack,
        )

    def _uses(
        self, loads: ScenarioCam, variables: DesignVariables, points: int
    ) -> tuple[dict[str, Array], dict[str, Mean]]:
        """Utilisations and costs by name: those at single cam angles, (s, n) or (1, n); then those
        of means over the turn.

        Parameters
        ----------
        loads : ScenarioCam           cam in s stacked scenarios at n angles
        variables : DesignVariables   of the cam
        points : int                  the first angles, which are equally spaced and give the means;
                                      0: no means
        """
        shape = self.shape()(loads.jet, float(loads.highest), variables)
        charged = self._charged(self.costs, self._weights, loads, variables)
        pointwise: dict[str, Array] = {}
        means: dict[str, Mean] = {}
        uses = self._judged(utilisations_of(loads))
        for name, value in (*shape.items(), *uses.items(), *charged.items()):
            if name in self.problem.left_out:
                continue
            if isinstance(value, Mean):
                if points and value.members.size:
                    means[name] = value._replace(terms=value.terms[:, :points])
            else:
                pointwise[name] = np.atleast_2d(value)
        return pointwise, means

    def state(self, coefficients: Array, variables: DesignVariables) -> State:
        """State of the search for given unknowns: ripples, costs, jerk, and utilisations of all
        limits.

        Parameters
        ----------
        coefficients : array          of the energy of a lobe, J
        variables : DesignVariables   spring, prime radius, phase
        """
        problem = self.problem
        grid, stack = self._angles(coefficients, variables)
        loads = self._loaded(coefficients, variables, grid, stack)
        pointwise, totals = self._uses(loads, variables, problem.points)
        means = {name: each.value for name, each in totals.items()}
        greatest = {name: float(value.max()) for name, value in (pointwise | means).items()}
        most = {name: value for name, value in greatest.items() if name not in self.costs}
        energy = self.turn.energy(coefficients)
        if np.isfinite(problem.energy[1]):
            over = float(energy[0].min()) - problem.energy[1]
            most[INITIAL_ENERGY] = 1.0 - RESERVE + over / self.scale
        torque = loads.torque[self.weighted, : problem.points]
        left = self._engine(variables) - torque / problem.gear_ratio
        items = [problem.scenarios[k] for k in self.weighted]
        sizes = _norms(partial(ripple_of, problem), items, left)
        ripples = sizes * [item.weight for item in items]
        alone = problem.torque_alone
        ceilings = [problem.ceiling_of(item) for item in items]
        excess = (sizes if alone else _norms(torque_ripple, items, left)) - [
            np.inf if each is None else each for each in ceilings
        ]
        if np.isfinite(excess).any():
            most[TORQUE_REDUCTION.id] = 1.0 - RESERVE + float(excess.max())
        jerk = self._jerk_scale * lift_jet(energy, variables).jerk
        charged = LOSS.key in self.costs
        return State(
            coefficients=coefficients,
            variables=variables,
            ripple=float(ripples.max(initial=0.0)),
            ripples=ripples,
            excess=excess,
            cost=sum(greatest[name] for name in sorted(self.costs)),
            jerk=0.5 * float(jerk @ jerk),
            utilisation=most,
            pointwise=pointwise,
            means=means,
            members={name: each.members for name, each in totals.items()},
            grid=grid,
            stack=replace(stack, wall=loads.wall) if charged and loads.crosses else stack,
        )

    def residual_torque(self, state: State) -> Array:
        """Engine torque less the torque that the cam delivers (w, n), at the crank, N m, in each of
        the w scenarios whose ripple is minimised or limited.
        """
        coefficients, variables = state.coefficients, state.variables
        jet = lift_jet(self.turn.energy(coefficients), variables)
        top, stack = self.highest(coefficients, variables), self._weighted_stack(state)
        cam = delivered_torque(jet, top, variables, stack, self.problem.ratings)
        return self._engine(variables) - cam / self.problem.gear_ratio

    def _engine(self, variables: DesignVariables) -> Array:
        """Engine torque (w, n), N m, at the points of the turn, of the scenarios whose ripple is
        minimised or limited, advanced by the phase of the cam.
        """
        phase = float(variables.phase)
        if phase not in self._engines:
            items = [self.problem.scenarios[k] for k in self.weighted]
            turned = [item.torque_at(phase)[0] for item in items]
            self._engines = {phase: np.reshape(turned, (-1, self.problem.points))}
        return self._engines[phase]

    def near(self, state: State) -> dict[str, NDArray[np.bool_]]:
        """By limit or cost, which of its utilisations (s, n), scenario by cam angle, enter the
        linear model: near the limit, of a cost near its maximum, and not far below that of another
        scenario at the same angle.
        """
        rows = {}
        for name, value in state.pointwise.items():
            level = self.level(name, value)
            least = level.max() * (1.0 - _NEAR_LIMIT) if name in self.costs else -_NEAR_LIMIT
            rows[name] = (level >= least) & (level >= level.max(axis=0) - _BEHIND_WORST)
        return rows

    def near_means(self, state: State) -> dict[str, NDArray[np.bool_]]:
        """By limit or cost, which of its utilisations (r,) from means over the turn enter the
        linear model: near the limit, of a cost near its maximum.
        """
        rows = {}
        for name, value in state.means.items():
            level = self.level(name, value)
            rows[name] = level >= (
                level.max() * (1.0 - _NEAR_LIMIT) if name in self.costs else -_NEAR_LIMIT
            )
        return rows

    def model(self, state: State) -> Model:
        """Linear models, at a state, of the ripples, of the limits that are nearly reached and of
        the jerk.
        """
        summit = self.summit(state)
        at = self.point(state, 0.0, self.every)
        gradient = differentiated(_jerk, at, self.freed)["jerk"]
        jerk = self._jerk_scale * self._dense(gradient.local, gradient.shared, state, summit)
        rows = self.rows(state, summit, self.near(state))
        means, slopes = self.means(state, summit, self.near_means(state))
        idle = self._idle_forces(state, summit)
        if idle is not None:
            means = [self._crossed(each, idle) if each.name == LOSS.key else each for each in means]
        return Model(
            summit=summit,
            norms=self.norms(state, summit, self._near_ripples(state), idle),
            limits=[*rows, *means, *self._least_energy(state), *self._lower_peaks(state)],
            means=slopes,
            curvature=jerk.T @ jerk,
            slope=jerk.T @ (self._jerk_scale * gradient.terms),
            idle=idle,
        )

    def _idle_forces(self, state: State, summit: Summit) -> IdleForces | None:
        """Forces on the track that does not carry, at the points of the turn at which a step may
        change the track; None of a search that charges no friction, and of cams of one track.

        The friction has a kink where the force is zero: it is that of the track that carries plus
        the change of its slope times the force on the other track, which a program that charges
        it leaves at zero unless that track carries. So is the torque where the ripple rises with
        that force; elsewhere it is that of the track that carries.
        """
        if state.stack.wall is None:
            return None
        jet, top, variables = _of_point(self.point(state, summit.lift, self.every))
        stack, ratings = self._weighted_stack(state), self.problem.ratings
        force = loaded(jet, top, variables, ratings, stack).required
        most = np.abs(force).max(axis=1, keepdims=True)
        row, point = np.nonzero(np.abs(force) < _NEAR_CROSSING * most)
        if not row.size:
            return None
        at = self.point(state, summit.lift, point)
        stack = taken(state.stack, self.pairs(state, np.array(self.weighted)[row], point))
        weights = self._weights[self.weighted][row, 0]
        by_torque, by_loss = self._kinks(stack, weights, *_of_point(at))
        left = self.residual_torque(state)
        rise = [
            residuals_slope(self.problem.objective, self.problem.scenarios[k], values)
            for k, values in zip(self.weighted, left, strict=True)
        ]
        by_torque = np.where(np.array(rise)[row, point] * by_torque < 0.0, by_torque, 0.0)
        gradient = differentiated(partial(_required, stack, ratings), at, self.freed)["force"]
        entries, columns = self._entries(point, gradient.local, gradient.shared, state, summit)
        size = -most[row, 0] * stack.wall  # towards the other track
        return IdleForces(
            gradient.terms / size,
            entries / size[:, None],
            columns,
            np.abs(size) * by_torque,
            np.abs(size) * np.maximum(by_loss, 0.0) / self.every.size,
            np.array(self.weighted)[row],
            point,
        )

    def _kinks(
        self, stack: Scenario, weights: Array, jet: Jet, top: float, variables: DesignVariables
    ) -> tuple[Array, Array]:
        """Changes, by the track, of the slopes of crank torque and charged friction by the force
        (m,), at pairs of scenario, with its weight, and cam angle.
        """
        slopes = list[tuple[Array, Array]]()
        for wall in (1.0, -1.0):
            external: Array = np.add(stack.external, 1j * _FORCE_STEP)
            there = replace(stack, wall=np.full(weights.size, wall), external=external)
            loads = loaded(jet, top, variables, self.problem.ratings, there)
            loss = self._charged(frozenset({LOSS.key}), weights, loads, variables)[LOSS.key]
            terms = loss.terms if isinstance(loss, Mean) else loss
            slopes.append((np.imag(loads.torque), np.imag(terms)))
        by_torque, by_loss = (
            (push - pull) / _FORCE_STEP for push, pull in zip(*slopes, strict=True)
        )
        return by_torque / self.problem.gear_ratio, by_loss

    def _crossed(self, cost: Linear, idle: IdleForces) -> Linear:
        """Row of the charged friction with the forces on the track that does not carry."""
        slopes = idle.by_loss * (idle.scenario == cost.scenario[:, None])
        columns = self.size + np.arange(idle.level.size)
        return replace(
            cost,
            entries=np.hstack([cost.entries, slopes]),
            columns=np.hstack([cost.columns, np.broadcast_to(columns, slopes.shape)]),
        )

    def _near_ripples(self, state: State) -> NDArray[np.intp]:
        """Scenarios of the greatest ripple, or near their ceiling."""
        greatest = state.ripples >= state.ripple - _RIPPLE_BEHIND
        most = max(float(state.excess.max(initial=-np.inf)), -_NEAR_LIMIT)
        return np.flatnonzero(greatest | (state.excess >= most - _RIPPLE_BEHIND))

    def norms(
        self,
        state: State,
        summit: Summit,
        wanted: NDArray[np.intp],
        idle: IdleForces | None = None,
    ) -> list[Norm]:
        """Linear models of the ripples of some scenarios, as cones.

        Parameters
        ----------
        state : State           at which they are linearised
        summit : Summit         maximum lift there
        wanted : array          indices of the scenarios among the weighted ones
        idle : IdleForces   unknowns after those of the step
        """
        problem, variables = self.problem, state.variables
        at = self.point(state, summit.lift, self.every)
        gradient = differentiated(self.torque(state, wanted), at, self.freed)["torque"]
        engine = self._engine(variables)
        norms = []
        for row, k in enumerate(wanted):
            item = problem.scenarios[self.weighted[k]]
            left = engine[k] - gradient.terms[row] / problem.gear_ratio
            local, shared = gradient.local[:, row], gradient.shared[:, row]
            slopes = self._dense(local, shared, state, summit)
            slopes /= -problem.gear_ratio
            if "phase" in problem.freed:
                column = problem.coefficients + list(problem.freed).index("phase")
                slopes[:, column] += item.torque_at(float(variables.phase))[1]
            if idle is not None:
                of_item = idle.scenario == self.weighted[k]
                forces = np.zeros((self.every.size, of_item.size))
                forces[idle.point, np.arange(of_item.size)] = of_item * -idle.by_torque
                slopes = np.hstack([slopes, forces])
            columns = np.column_stack([slopes, left])
            charged = triangle(ripple_of(problem, item, columns))
            ceiling = problem.ceiling_of(item)
            norms.append(
                Norm(*charged, item.weight, ceiling if problem.torque_alone else None, int(k))
            )
            if ceiling is not None and not problem.torque_alone:
                bounded = triangle(torque_ripple(item, columns))
                norms.append(Norm(*bounded, 0.0, ceiling, int(k)))
        return norms

    def _dense(self, local: Array, shared: Array, state: State, summit: Summit) -> Array:
        """Derivatives (n, size), by the scaled unknowns, of values at the n points of the turn.

        Parameters
        ----------
        local, shared : arrays   derivatives by the local and the shared arguments; see `Gradient`
        state : State            at which they are taken
        summit : Summit          maximum lift there, with its derivatives
        """
        entries, columns = self._entries(self.every, local, shared, state, summit)
        dense = np.zeros((self.every.size, self.size))
        np.add.at(dense, (self.every[:, None], columns), entries)
        return dense

    def _entries(
        self, points: NDArray[np.intp], local: Array, shared: Array, state: State, summit: Summit
    ) -> tuple[Array, NDArray[np.intp]]:
        """Derivatives by the scaled unknowns, (m, w), and their columns, of rows at angles (m,).

        local (4, m), shared (1 or 4, m): see `Gradient`.
        """
        scaled = self.scale * np.einsum("km,kmj->mj", local, state.grid.entries[:, points])
        by_unknowns, places = self._shared(shared, state, summit)
        return (
            np.hstack([scaled, by_unknowns]),
            np.hstack(
                [state.grid.columns[points], np.broadcast_to(places, (points.size, places.size))]
            ),
        )

    def _shared(
        self, shared: Array, state: State, summit: Summit
    ) -> tuple[Array, NDArray[np.intp]]:
        """Derivatives (m, w) by way of the maximum lift and of the free variables; columns (w,)."""
        matrix = self.shared_columns(state, summit)
        used = np.flatnonzero(np.any(matrix[np.any(shared, axis=1)] != 0.0, axis=0))
        return shared.T @ matrix[:, used], used.astype(np.intp)

    def shared_columns(self, state: State, summit: Summit) -> Array:
        """Derivatives (q, size), by the scaled unknowns, of the arguments that all cam angles
        share: the maximum lift and, where some variable is free, k, P, r0; q is 1 or 4.
        """
        freed = self.problem.freed
        matrix = np.zeros((1 + (len(FREED) if freed else 0), self.size))
        np.add.at(matrix[0], summit.columns, self.scale * summit.entries)
        for number, name in enumerate(freed):
            if name in FREED:
                column, unit = self.problem.coefficients + number, getattr(state.variables, name)
                k = 1 + FREED.index(name)
                matrix[k, column] = unit
                matrix[0, column] = summit.shared[k] * unit
        return matrix

    def rows(
        self, state: State, summit: Summit, wanted: Mapping[str, NDArray[np.bool_]]
    ) -> list[Linear]:
        """Linear models of limits and costs at single cam angles.

        Parameters
        ----------
        state : State      at which they are linearised
        summit : Summit    maximum lift there
        wanted : mapping   by limit, which scenarios and angles (s, n)
        """
        models = []
        for names in self.families(name for name, rows in wanted.items() if rows.any()):
            any_row = np.any(np.broadcast_arrays(*(wanted[name] for name in names)), axis=0)
            scenario, point = np.nonzero(any_row)
            function = self.at_pairs(names, state, scenario, point)
            at = self.point(state, summit.lift, point)
            for name, gradient in differentiated(function, at, self.freed).items():
                here = _of_rows(wanted[name], len(any_row))[scenario, point]
                if here.any():
                    entries = self._entries(
                        point[here], gradient.local[:, here], gradient.shared[:, here],
                        state, summit,
                    )  # fmt: skip
                    level = self.level(name, gradient.terms[here])
                    models.append(
                        Linear(name, level, *entries, scenario[here], point[here],
                               cost=name in self.costs)
                    )  # fmt: skip
        return models

    def families(self, names: Iterable[str]) -> list[frozenset[str]]:
        """Limit names split into shape, and loads with costs; empty groups are left out."""
        every = frozenset(names)
        return [each for each in (every & SHAPE_LIMITS, every - SHAPE_LIMITS) if each]

    def means(
        self, state: State, summit: Summit, wanted: Mapping[str, NDArray[np.bool_]]
    ) -> tuple[list[Linear], dict[str, tuple[NDArray[np.intp], Array]]]:
        """Linear models of limits and costs that are means over the turn; then, by limit, scenarios
        and derivatives of the means, see `Model`.

        Parameters
        ----------
        state : State      at which they are linearised
        summit : Summit    maximum lift there
        wanted : mapping   by limit, which of its r utilisations (r,)
        """
        models, slopes = list[Linear](), {}
        for names in self.families(name for name, rows in wanted.items() if rows.any()):
            turn = self.of_means(state, summit, {name: wanted[name] for name in names})
            for name, gradient in differentiated(turn.function, turn.at, self.freed).items():
                if gradient.mean is None:
                    continue
                mean_slopes = self._means_slopes(gradient, state, summit)
                slopes[name] = turn.scenarios, mean_slopes
                entries, numbers = gradient.mean.slopes @ mean_slopes, turn.places[name]
                models += [
                    self._mean(name, state, entries[[number]], numbers[[number]])
                    for number in np.flatnonzero(wanted[name][numbers])
                ]
        return models, slopes

    def of_means(
        self, state: State, summit: Summit, rows: Mapping[str, NDArray[np.bool_]]
    ) -> Means:
        """Mean-based limits and costs for chosen utilisations (r,), in the scenarios they need."""
        needed = [state.members[name][chosen].any(axis=0) for name, chosen in rows.items()]
        scenarios = np.flatnonzero(np.isin(self._corners, self._corners[np.any(needed, axis=0)]))
        return Means(
            self.function(frozenset(rows), state, self.turns(scenarios)),
            self.point(state, summit.lift, self.every),
            scenarios,
            {name: np.flatnonzero(state.members[name][:, scenarios].any(axis=1)) for name in rows},
        )

    def means_slopes(self, means: Means, state: State, summit: Summit, name: str) -> Array:
        """Derivatives (m, size) of the means of a limit by the scaled unknowns."""
        gradient = differentiated(means.function, means.at, self.freed)[name]
        return self._means_slopes(gradient, state, summit)

    def _means_slopes(self, gradient: Gradient, state: State, summit: Summit) -> Array:
        """Derivatives (m, size), by the scaled unknowns, of the means over the turn of m terms.

        Parameters
        ----------
        gradient : Gradient   derivatives of the terms (m, n) by their local and shared arguments
        state : State         at which they are taken
        summit : Summit       maximum lift there, with its derivatives
        """
        slopes = np.zeros((gradient.terms.shape[0], self.size))
        for each, local in zip(slopes, np.moveaxis(gradient.local, 1, 0), strict=True):
            np.add.at(each, self.turn.columns, self.scale * self.turn.chained(local))
        slopes += gradient.shared.sum(axis=2).T @ self.shared_columns(state, summit)
        return slopes / self.every.size

    def turns(self, rows: NDArray[np.intp]) -> Callable[[Array], Array]:
        """Values of scenarios (m,) at the points of the turn."""
        return lambda each: each[rows, : self.problem.points]

    def _mean(self, name: str, state: State, entries: Array, number: NDArray[np.intp]) -> Linear:
        """Linear model of one utilisation from means over the turn."""
        return Linear(
            name,
            self.level(name, state.means[name][number]),
            entries,
            np.arange(self.size, dtype=np.intp)[None],
            number,
            np.array([-1]),
            mean=True,
            cost=name in self.costs,
        )

    def new_reversals(self, state: State, there: State) -> NDArray[np.intp]:
        """Indices of the points at which the follower moves the other way after a step, in a stroke
        that it did not have before.

        Points that an existing reversal has passed in moving do not count; empty where loads do not
        jump at a reversal.

        Parameters
        ----------
        state, there : State   before and after the step
        """
        sides = [self.turn.energy(each.coefficients)[1] > 0.0 for each in (state, there)]
        flipped = np.flatnonzero(sides[0] != sides[1])
        if not self._jumps or not flipped.size or flipped.size == self.every.size:
            return np.zeros(0, dtype=np.intp)
        runs = np.split(flipped, np.flatnonzero(np.diff(flipped) > 1) + 1)
        if len(runs) > 1 and flipped[0] == 0 and flipped[-1] == self.every.size - 1:
            runs[0] = np.concatenate([runs.pop() - self.every.size, runs[0]])
        new = [
            run for run in runs
            if np.unique(sides[0].take([*run, run[0] - 1, run[-1] + 1], mode="wrap")).size == 1
        ]  # fmt: skip
        return np.concatenate([*new, np.zeros(0, dtype=np.intp)]) % self.every.size

    def kept_sides(self, state: State, points: NDArray[np.intp]) -> list[Linear]:
        """Linear rows by which a step keeps the direction of the follower, the sign of E', at some
        points.

        Parameters
        ----------
        state : State    before the step
        points : array   indices of the points
        """
        if not points.size:
            return []
        slope = self.turn.energy(state.coefficients)[1]
        size, side = np.abs(slope).max(), -np.sign(slope[points])
        level = side * slope[points] / size
        # A slope of zero, which a program meets to its tolerance, may have the other sign.
        level += np.minimum(_SIGN_SLOPE, -0.5 * level)
        entries = self.scale * side[:, None] * self.turn.entries[1][points]
        none = np.full(points.size, -1)
        return [
            Linear(KEPT_SIDE, level, entries / size, self.turn.columns[points], none, points,
                   elastic=False)
        ]  # fmt: skip

    def _least_energy(self, state: State) -> list[Linear]:
        """Linear rows that keep the energy above its least value, at each point that a step could
        bring there, and, where it is bounded, the energy at its minimum below the greatest initial
        energy.
        """
        low, high = self.problem.energy
        energy = self.turn.energy(state.coefficients)[0]
        entries, columns = self.turn.entries[0], self.turn.columns
        points = np.arange(energy.size)
        level = (low - energy) / self.scale
        # A step of one in each coefficient changes the energy by one.
        near = np.flatnonzero(level >= -_FARTHEST)
        none = np.full(points.size, -1)
        models = [
            Linear(LEAST_ENERGY, level[near], -entries[near], columns[near], none[near], near,
                   elastic=False)
        ]  # fmt: skip
        if np.isfinite(high):
            k = points[[int(np.argmin(energy))]]
            level = (energy[k] - high) / self.scale
            models.append(Linear(INITIAL_ENERGY, level, entries[k], columns[k], none[k], k))
        return models

    def after(self, state: State, step: Array) -> tuple[Array, DesignVariables]:
        """Coefficients of the energy, J, and variables after a step from a state.

        Parameters
        ----------
        state : State          before the step
        step : array (size,)   in the scaled unknowns: coefficients, then free variables
        """
        count, variables = self.problem.coefficients, state.variables
        for name, part in zip(self.problem.freed, step[count:], strict=True):
            value = getattr(variables, name) + _unit(name, variables) * float(part)
            variables = replace(variables, **{name: value})
        coefficients = state.coefficients + self.scale * step[:count]
        if self.still is not None:  # the solver meets an equality to its tolerance
            coefficients = odd_part(coefficients) + coefficients.mean()
        return coefficients, variables

    def box(self, state: State, trust: float) -> Array:
        """Least and greatest step (2, size) in the scaled unknowns, within the trust region and, of
        the free variables, their ranges.

        Parameters
        ----------
        trust : float   size of the trust region, in scaled unknowns
        """
        count = self.problem.coefficients
        low, high = np.full(self.size, -trust), np.full(self.size, trust)
        for number, (name, (least, greatest)) in enumerate(self.problem.freed.items()):
            now, unit = getattr(state.variables, name), _unit(name, state.variables)
            low[count + number] = max((least - now) / unit, -trust)
            high[count + number] = min((greatest - now) / unit, trust)
        return np.stack([low, high])


def _norms(
    columns: Callable[[Scenario, Array], Array], items: Sequence[Scenario], left: Array
) -> Array:
    """Norms (w,) of the residuals of each scenario."""
    return np.array(
        [np.linalg.norm(columns(item, values)) for item, values in zip(items, left, strict=True)]
    )


def _of_rows(wanted: NDArray[np.bool_], count: int) -> NDArray[np.bool_]:
    """Which of (count, n) rows are wanted, from those of a limit that has as many or a single one:
    that of two discs, of one on the lift alone.
    """
    return np.pad(wanted, ((0, count - len(wanted)), (0, 0)))


def _unit(name: str, variables: DesignVariables) -> float:
    """Unit of a step of a free variable: its value, or 1 rad."""
    return 1.0 if name == "phase" else float(getattr(variables, name))


def _lift(jet: Jet, _top: float, _variables: DesignVariables) -> Mapping[str, Array | Mean]:
    return {"lift": jet.lift}


def _jerk(jet: Jet, _top: float, _variables: DesignVariables) -> Mapping[str, Array | Mean]:
    return {"jerk": jet.jerk}


def _of_point(at: Point) -> tuple[Jet, float, DesignVariables]:
    """Lift, maximum lift and variables of arguments."""
    return lift_jet(at.energy, at.variables), at.highest, at.variables


def _required(
    scenario: Scenario, ratings: Ratings, jet: Jet, top: float, variables: DesignVariables
) -> Mapping[str, Array | Mean]:
    return {"force": loaded(jet, top, variables, ratings, scenario).required}


def _torque(
    scenario: Scenario, ratings: Ratings, jet: Jet, top: float, variables: DesignVariables
) -> Mapping[str, Array | Mean]:
    return {"torque": delivered_torque(jet, top, variables, scenario, ratings)}
