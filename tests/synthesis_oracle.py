"""Constrained synthesis as a nonlinear program of CasADi, solved by IPOPT.

Independent of the search of the product: other formulas (`oracle_limits`), derivatives by
algorithmic differentiation, second derivatives exact, an interior-point method in place of cone
programs. Of the product's `Problem` only plain numbers are read: torque, ratings, scenarios.

Unknowns: coefficients of the stored energy, a periodic quintic B-spline, and the free ones of
spring rate, preload, prime radius and phase. The energy and its derivatives at the cam angles are
unknowns too, tied to the coefficients by linear equations: all second derivatives become sparse.
Rows of the limits are added where a solution exceeds them, until it exceeds none. The angle of the
maximum lift, on which the overhang depends, is an unknown: there the energy is level.

References
----------
Andersson et al., CasADi, Math. Prog. Comp. 11 (2019) 1; Waechter and Biegler, Math. Prog. 106
(2006) 25: IPOPT. Fiacco, Introduction to Sensitivity and Stability Analysis (1983): the derivative
of an optimum by a parameter is that of the Lagrange function.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace

import casadi as ca
import numpy as np
from oracle_limits import (
    CORRECTION,
    FREE,
    LIMITS,
    NUMBERS,
    SCENARIO,
    TORQUE_REDUCTION,
    lift_of,
    loads_at,
    shape_at,
)
from scipy.interpolate import BSpline
from scipy.optimize import brentq, minimize_scalar
from sparse_program import SparseProgram

from camwright.pipeline.smoothing.objective import TORQUE, Weighted

RESERVE = 1e-3  # of each limit, as the product keeps it
DEGREE = 5
_NEAR, _MEAN_NEAR = 0.1, 0.01  # distance from the limit of the first rows, and those of means
_EXCEEDED, _CLOSE = 1e-7, 0.02  # excess of rows added; distance from the limit of their neighbours
_SPREAD = 6  # angles between rows taken everywhere
_LEADS = 2e-3  # distance from the worst scenario of the rows taken
_ROUNDS = 20
_SUMMIT = 1e-9  # of the energy: the summit is the highest
_BEYOND = 0.3  # of a part between knots, by which the summit may leave it in one program
_TINY = 1e-5  # weight of the objective beside a violation


def periodic_basis(theta, count, derivative=0):
    """Periodic quintic B-splines on `count` uniform knots, (n, count), by scipy."""
    part = 2 * np.pi / count
    knots = part * (np.arange(count + 2 * DEGREE + 1) - DEGREE)
    angle = np.mod(theta, 2 * np.pi)
    if derivative == 0:
        wide = BSpline.design_matrix(angle, knots, DEGREE).toarray()
    else:
        wide = BSpline(knots, np.eye(count + DEGREE), DEGREE)(angle, derivative)
    basis = wide[:, :count].copy()
    basis[:, :DEGREE] += wide[:, count:]
    return basis


@dataclass(frozen=True, eq=False)
class Optimum:
    """Local optimum: coefficients, J; free values; ripple over that of the engine.

    `objective`: ripple and weighted jerk. `utilisation`: greatest at the points, by check;
    `violation`: excess over 1 less the reserve. `multipliers`: decrease of the objective per unit
    of utilisation; `slopes`: derivative of the objective by each number of `NUMBERS`.
    `iterations`: of IPOPT in all programs; `constraint_violation`, `status`: of the last. `active`,
    `state`: rows and last program, to go on from.
    """

    coefficients: np.ndarray
    free: dict[str, float]
    ripple: float
    objective: float
    utilisation: dict[str, float]
    violation: dict[str, float]
    multipliers: dict[str, float]
    slopes: dict[str, float]
    iterations: int
    constraint_violation: float
    status: str
    active: dict = field(repr=False)
    state: SimpleNamespace = field(repr=False)

    @property
    def feasible(self):
        return sum(self.violation.values()) <= 1e-6


class Oracle:
    """Nonlinear program of one problem; `changed`: other values of `NUMBERS`."""

    def __init__(self, problem, **changed):
        assert problem.ratings.offset == 0.0
        assert problem.ratings.crown_radius is None
        assert problem.objective == (Weighted(TORQUE, 1.0),)
        assert not np.isfinite(problem.energy[1])
        self.count, self.points = problem.coefficients, problem.points
        self.theta = 2 * np.pi * np.arange(self.points) / self.points
        self.basis = [periodic_basis(self.theta, self.count, k) for k in range(4)]
        self.freed = dict(problem.freed)
        self.least = problem.energy[0]
        self.jerk_weight = problem.jerk_weight
        self.scenarios = problem.scenarios
        nominal = numbers_of(problem)
        self.numbers = nominal | changed
        left_out = set(problem.left_out)
        if (nominal["hollow_radius"] or 0.0) <= nominal["roller_radius"]:
            left_out.add("concave_radius")  # the roller cannot roll in a smaller hollow
        if any(item.friction_worst is None for item in self.scenarios):
            left_out.add("jam_index_friction_max")
        self.limits = [
            each
            for each in LIMITS
            if each.check not in left_out and nominal[each.needs] is not None
        ]
        self.bounded = nominal["torque_reduction"] is not None and TORQUE_REDUCTION not in left_out
        self.names = [each.check for each in self.limits] + [TORQUE_REDUCTION] * self.bounded
        self._functions()
        self.exact = self._exact(nominal)
        self.scale = float(np.abs(self.exact).max())
        parts = np.stack([basis @ self.exact for basis in self.basis])
        self.sizes = np.maximum(np.abs(parts).max(axis=1), 1e-6 * self.scale)
        free = [nominal[name] for name in FREE]
        self.jerk_norm = float(np.linalg.norm(self._jerk(parts, free).full()))

    # formulas -----------------------------------------------------------------------------------

    def _functions(self):
        symbols = ca.SX.sym("p", len(NUMBERS))
        p = SimpleNamespace(**{name: symbols[k] for k, name in enumerate(NUMBERS)})
        energy, free, top = ca.SX.sym("E", 4), ca.SX.sym("free", 3), ca.SX.sym("top")
        numbers = ca.SX.sym("scenario", len(SCENARIO))
        scenario = SimpleNamespace(**{name: numbers[k] for k, name in enumerate(SCENARIO)})
        ratios = ca.SX.sym("fix", len(CORRECTION))
        fix = SimpleNamespace(**{name: ratios[k] for k, name in enumerate(CORRECTION)})
        cam = shape_at(energy, free, p)
        at = loads_at(cam, top, scenario, fix)
        self.rows, self._at = {}, {}
        inputs = {"shape": [energy, free, symbols]}
        inputs["loads"] = inputs["mean"] = [energy, top, free, symbols, numbers, ratios]
        for of, state in (("shape", cam), ("loads", at), ("mean", at)):
            rows, names = [], []
            for each in self.limits:
                if each.of == of:
                    use = each.use(state)
                    use = use if isinstance(use, tuple) else (use,)
                    rows += use
                    names += [each.check] * len(use)
            self.rows[of] = names
            self._at[of] = ca.Function(of, inputs[of], [ca.vertcat(*rows)])
        self.power = np.array([e.power for e in self.limits if e.of == "mean"])[:, None]
        self._torque = ca.Function("torque", inputs["loads"], [at.torque])
        self._jerk = ca.Function("jerk", [energy, free], [cam.jerk]).map(
            self.points, [False, True], [False]
        )
        self._lift = ca.Function("lift", [energy[0], free], [lift_of(energy[0], free[0], free[1])])

    def _mapped(self, function, count):
        """The function at `count` angles; the numbers of the machine are common to all."""
        if function.n_in() == 3:
            return function.map(count, [False, True, True], [False])
        return function.map(count, [False, True, True, True, True, False], [False])

    def _scenario(self, k):
        item = self.scenarios[k]
        worst = item.friction_worst or (0.0, 0.0)
        named = {"worst_a": worst[0], "worst_b": worst[1]}
        numbers = [named.get(name, getattr(item, name, None)) for name in SCENARIO]
        turn = np.linspace(0, 2 * np.pi, item.correction.contact.size, endpoint=False)
        fix = np.stack([
            np.interp(self.theta, turn, getattr(item.correction, name), period=2 * np.pi)
            for name in CORRECTION
        ])  # fmt: skip
        return ca.DM(numbers), ca.DM(fix)

    def _engine(self, k, phase):
        """Engine torque (n,), advanced by a phase, from its Fourier series."""
        torque = np.asarray(self.scenarios[k].torque)
        if "phase" not in self.freed:
            return ca.DM(torque)
        spectrum = np.fft.rfft(torque) / torque.size
        spectrum[1 : (torque.size + 1) // 2] *= 2
        order = np.arange(spectrum.size)
        waves = np.exp(1j * np.outer(self.theta, order)) * spectrum
        turned = order.copy()
        if torque.size % 2 == 0:
            turned[-1] = 0
        return ca.DM(waves.real) @ ca.cos(turned * phase) - ca.DM(waves.imag) @ ca.sin(
            turned * phase
        )

    # starts -------------------------------------------------------------------------------------

    def _exact(self, p):
        """Coefficients of the energy of the cam torque, raised until the pressure angle is kept."""
        first = max(self.scenarios, key=lambda item: item.weight)
        torque = p["gear_ratio"] * np.asarray(first.torque)
        flat = np.linalg.lstsq(self.basis[1], torque - torque.mean(), rcond=None)[0]
        fine = np.linspace(0, 2 * np.pi, max(1440, 16 * self.count), endpoint=False)
        energy, slope = (periodic_basis(fine, self.count, k) @ flat for k in (0, 1))
        place = fine[np.argmin(energy)]
        lowest = minimize_scalar(
            lambda angle: float((periodic_basis([angle], self.count, 0) @ flat)[0]),
            bounds=(place - fine[1], place + fine[1]), options={"xatol": 1e-9},
        ).fun  # fmt: skip
        flat, energy = flat - lowest, energy - lowest
        highest, limit = np.inf, p["pressure_angle"] or np.pi / 3
        if p["travel"] is not None:
            travel = p["travel"] * (1 - RESERVE)
            highest = p["preload"] * travel + 0.5 * p["rate"] * travel**2
        if energy.max() > highest:
            return flat * highest / energy.max()

        def excess(rise):
            force = np.sqrt(p["preload"] ** 2 + 2 * p["rate"] * (energy + rise))
            lift = (force - p["preload"]) / p["rate"]
            return float((np.abs(slope) / force / (p["prime_radius"] + lift)).max()) - np.tan(limit)

        rise = 0.0
        if excess(0.0) > 0:
            rise = brentq(excess, 0.0, 1e3 * energy.max(), xtol=1e-12)
        return flat + min(rise, highest - energy.max())

    def random_start(self, seed):
        """Smooth random energy and free variables."""
        random = np.random.default_rng(seed)
        order = np.arange(1, self.count // 4)
        shift = random.uniform(0, 2 * np.pi, (order.size, 1))
        turn = 2 * np.pi * np.arange(self.count) / self.count
        waves = (random.normal(size=order.size) / order**2) @ np.cos(order[:, None] * turn + shift)
        energy = self.scale * (
            0.05 + random.uniform(0.3, 1.0) * (waves - waves.min()) / np.ptp(waves)
        )
        return energy, {name: random.uniform(*ends) for name, ends in self.freed.items()}

    # evaluation ---------------------------------------------------------------------------------

    def _summit(self, coefficients):
        fine = np.linspace(0, 2 * np.pi, 40 * self.count, endpoint=False)
        angle = fine[np.argmax(periodic_basis(fine, self.count) @ coefficients)]
        for _ in range(8):
            here = np.array([angle])
            slope = periodic_basis(here, self.count, 1) @ coefficients
            bend = periodic_basis(here, self.count, 2) @ coefficients
            if bend[0] < 0:
                angle -= float(np.clip(slope[0] / bend[0], -fine[1], fine[1]))
        return angle

    def _powers(self, span):
        """Splines on a part of the turn between knots, by powers of the share of it, (6, count)."""
        share = np.linspace(0.0, 1.0, DEGREE + 1)
        there = periodic_basis(2 * np.pi / self.count * (span + share), self.count)
        return ca.sparsify(ca.DM(np.linalg.solve(np.vander(share, increasing=True), there)), 1e-12)

    def values(self, coefficients, free, numbers=None):
        """Utilisations at the points, ripples, jerk: ({of: [(rows, n) of each scenario]}, ...)."""
        numbers = numbers or self.numbers
        p = _vector(numbers)
        own = ca.DM([free.get(name, numbers[name]) for name in FREE])
        parts = ca.DM(np.stack([basis @ coefficients for basis in self.basis]))
        summit = periodic_basis(np.array([self._summit(coefficients)]), self.count) @ coefficients
        top = self._lift(float(summit[0]), own)
        uses = {"shape": [self._mapped(self._at["shape"], self.points)(parts, own, p).full()]}
        uses |= {"loads": [], "mean": []}
        ripples = []
        for k, item in enumerate(self.scenarios):
            numbers_k, fix = self._scenario(k)
            inputs = (parts, top, own, p, numbers_k, fix)
            for of in ("loads", "mean"):
                uses[of].append(self._mapped(self._at[of], self.points)(*inputs).full())
            torque = self._mapped(self._torque, self.points)(*inputs).full().ravel()
            engine = np.asarray(ca.DM(self._engine(k, free.get("phase", 0.0)))).ravel()
            left = engine - torque / numbers["gear_ratio"]
            ripples.append(float(np.std(left) / np.std(item.torque)) if item.weight > 0 else 0.0)
        jerk = self._jerk(parts, own).full().ravel() / self.jerk_norm
        return uses, ripples, 0.5 * self.jerk_weight * float(jerk @ jerk)

    def utilisation(self, coefficients, free, numbers=None):
        """Greatest utilisation of each limit at the points."""
        uses, ripples, _ = self.values(coefficients, free, numbers)
        return self._greatest(uses, ripples, numbers or self.numbers)

    def objective(self, coefficients, free):
        """Greatest weighted ripple over that of the engine; weighted jerk."""
        _, ripples, jerk = self.values(coefficients, free)
        return max(r * s.weight for r, s in zip(ripples, self.scenarios, strict=True)), jerk

    def _greatest(self, uses, ripples, numbers):
        most = dict.fromkeys(self.names, -np.inf)
        for of in ("shape", "loads"):
            for table in uses[of]:
                for name, row in zip(self.rows[of], table, strict=True):
                    most[name] = max(most[name], float(row.max()))
        for table in uses["mean"]:
            for name, row, power in zip(self.rows["mean"], table, self.power[:, 0], strict=True):
                most[name] = max(most[name], max(float(row.mean()), 0.0) ** (1 / int(power)))
        if self.bounded:
            ceiling = (1 - numbers["torque_reduction"]) * (1 - RESERVE)
            most[TORQUE_REDUCTION] = 1 - RESERVE + max(ripples) - ceiling
        return most

    # solution -----------------------------------------------------------------------------------

    def solved(
        self, start=None, free=None, *, after=None, penalty=50.0, ripple_weight=1.0, tolerance=1e-9
    ):
        """Local optimum from a start: least objective and penalty times the sum of violations.

        Parameters
        ----------
        start : array (count,)   J; None: the exact energy
        after : Optimum          of nearly the same problem, in place of a start
        penalty : float          of one slack for each limit
        ripple_weight : float    of ripple and jerk beside the violations
        """
        if after is None:
            c = self.exact if start is None else np.asarray(start)
            free = {name: (free or {}).get(name, self._nominal(name)) for name in self.freed}
            active, state = self._near(c, free, None), None
        else:
            c, free, active, state = after.coefficients, after.free, after.active, after.state
        for _ in range(_ROUNDS):
            state = self._program(c, free, active, penalty, ripple_weight, tolerance, state)
            c, free = state.coefficients, state.free
            more = self._near(c, free, state)
            new = any((more[key] & ~active[key]).any() for key in active)
            active = {key: active[key] | more[key] for key in active}
            both = periodic_basis(np.array([state.summit, self._summit(c)]), self.count) @ c
            if not new and both[1] - both[0] <= _SUMMIT * self.scale:
                break
        else:
            state.status = "Rows_Not_Settled"
        most = self.utilisation(c, free)
        ripple, jerk = self.objective(c, free)
        return Optimum(
            c, free, ripple, ripple + jerk, most,
            {name: max(0.0, value - 1 + RESERVE) for name, value in most.items()},
            state.multipliers, state.slopes, state.iterations, state.excess, state.status,
            active, state,
        )  # fmt: skip

    def best(self, starts=3, **options):
        """Best of the exact start and of random ones, and all of them."""
        ends = [self.solved(**options)]
        for seed in range(1, starts):
            energy, free = self.random_start(seed)
            ends.append(self.solved(energy, free, **options))
        return min(ends, key=lambda e: (round(sum(e.violation.values()), 6), e.objective)), ends

    def least_violation(self, start=None, free=None):
        """Optimum of least sum of violations, one for each limit."""
        return self.solved(start, free, penalty=1.0, ripple_weight=_TINY)

    def _nominal(self, name):
        return 0.0 if name == "phase" else self.numbers[name]

    def _unit(self, name):
        return 1.0 if name == "phase" else self.numbers[name]

    def _near(self, c, free, state):
        """Rows of the first program, or those that a program exceeds, with their neighbours."""
        near, slack, ripple = _NEAR, {}, 0.0
        if state is not None:
            near, slack, ripple = None, state.slack, state.ripple
        uses, ripples, _ = self.values(c, free)
        uses["mean"] = [
            np.maximum(table.mean(axis=1, keepdims=True), 0.0) ** (1 / self.power)
            for table in uses["mean"]
        ]
        chosen = {}
        for of, tables in uses.items():
            room = np.array([1 - RESERVE + slack.get(name, 0.0) for name in self.rows[of]])[:, None]
            margin = -_EXCEEDED if near is None else near if of != "mean" else _MEAN_NEAR
            worst, leader = np.max(tables, axis=0), np.argmax(tables, axis=0)
            for k, table in enumerate(tables):
                leads = table > worst - _LEADS
                taken = leads & (table > room - margin)
                if near is not None:  # everywhere a few, against escape to where no cam is
                    spread = np.arange(table.shape[1]) % _SPREAD == 0
                    taken |= spread & (leader == k)
                elif of != "mean":  # and their neighbours
                    taken = leads & (table > room - _CLOSE) & taken.any(axis=1, keepdims=True)
                chosen[of, k] = taken
        weights = np.array([item.weight for item in self.scenarios])
        ripples = np.where(weights > 0, ripples, 0.0)
        charged = ripples * weights
        least = 0.0 if near else (1 + 1e-9) * ripple
        chosen["ripple", 0] = (charged > least) & (charged >= charged.max() * (1 - _LEADS))
        bounded = ripples >= (ripples.max() * (1 - _LEADS) if self.bounded else np.inf)
        if self.bounded and not near:
            ceiling = (1 - self.numbers["torque_reduction"]) * (1 - RESERVE)
            bounded &= ripples > ceiling + slack[TORQUE_REDUCTION] + _EXCEEDED
        chosen["ceiling", 0] = bounded & (weights > 0)
        return chosen

    def _program(self, c0, free0, active, penalty, ripple_weight, tolerance, before):
        """One nonlinear program with the active rows."""
        p, relief = ca.MX.sym("p", len(NUMBERS)), ca.MX.sym("relief", len(self.names))
        number = dict(zip(NUMBERS, ca.vertsplit(p), strict=True))
        program = SparseProgram(before and before.multipliers_of_rows)
        parts, peak, summit = self._energies(program, c0)
        variables = {}
        for name, ends in self.freed.items():
            unit = self._unit(name)
            ratio = program.unknown(name, free0[name] / unit, ends[0] / unit, ends[1] / unit)
            variables[name] = unit * ratio
        own = ca.vertcat(*(variables.get(name, number[name]) for name in FREE))
        shared = (self._lift(self.scale * peak, own), own, p)
        violated = [before.slack[name] if before else 0.01 for name in self.names]
        slack = program.unknown("slack", violated, 0.0)
        room = dict(zip(self.names, ca.vertsplit(slack + relief), strict=True))
        for (of, k), rows in active.items():
            if of in self.rows and rows.any():
                self._bounded(program, of, k, rows, parts, shared, room)
        known = before.ripple if before else self.objective(c0, free0)[0] + 1e-3
        ripple = program.unknown("ripple", known, 0.0)
        for k, item in enumerate(self.scenarios):
            charged, bounded = active["ripple", 0][k], active["ceiling", 0][k]
            if not charged and not bounded:
                continue
            inputs = (parts, *shared, *self._scenario(k))
            torque = self._mapped(self._torque, self.points)(*inputs).T
            left = self._engine(k, variables.get("phase", 0.0)) - torque / number["gear_ratio"]
            level = float(np.std(item.torque))
            mean = program.unknown(f"mean {k}", 0.0)
            program.zero(ca.sum1(left) / (self.points * level) - mean, ("mean torque", k))
            square = ca.sumsqr(left / level - mean) / self.points
            if charged:
                program.negative(square - (ripple / item.weight) ** 2, ("ripple", k))
            if bounded:
                ceiling = (1 - number["torque_reduction"]) * (1 - RESERVE)
                bound = ceiling + room[TORQUE_REDUCTION]
                program.negative(square - bound**2, ("ceiling", k))
        jerk = self._jerk(parts, own) / self.jerk_norm
        objective = ripple + 0.5 * self.jerk_weight * ca.sumsqr(jerk)
        end = program.solved(
            ripple_weight * objective + penalty * ca.sum1(slack),
            ca.vertcat(p, relief),
            ca.vertcat(_vector(self.numbers), ca.DM.zeros(len(self.names))),
            tolerance,
        )
        slopes = dict(zip(NUMBERS, end.slopes[: len(NUMBERS)].tolist(), strict=True))
        return SimpleNamespace(
            coefficients=self.scale * end.values["c"],
            free={name: self._unit(name) * float(end.values[name][0]) for name in self.freed},
            slack=dict(zip(self.names, end.values["slack"].tolist(), strict=True)),
            ripple=float(end.values["ripple"][0]),
            summit=summit(end),
            multipliers=dict(zip(self.names, (-end.slopes[len(NUMBERS) :]).tolist(), strict=True)),
            slopes={
                name: slope
                for name, slope in slopes.items()
                if self.numbers[name] is not None and name not in self.freed
            },
            multipliers_of_rows=end.multipliers,
            iterations=end.iterations + (before.iterations if before else 0),
            excess=end.excess,
            status=end.status,
        )

    def _energies(self, program, c0):
        """E to E''' at the angles (4, n), E at the summit over its scale, angle of the summit."""
        c = program.unknown("c", c0 / self.scale)
        levels = []
        for k, (basis, size) in enumerate(zip(self.basis, self.sizes, strict=True)):
            least = self.least / size if k == 0 else -np.inf
            level = program.unknown(f"E, derivative {k}", basis @ c0 / size, least)
            rows = ca.sparsify(ca.DM(basis * (self.scale / size)))
            program.zero(ca.mtimes(rows, c) - level, ("spline", k))
            levels.append(size * level)
        part = 2 * np.pi / self.count
        angle = self._summit(c0)
        span, beyond = divmod(angle, part)
        powers = self._powers(int(span))
        share = program.unknown("summit", beyond / part, -_BEYOND, 1 + _BEYOND)
        highest = periodic_basis(np.array([angle]), self.count) @ c0 / self.scale
        peak = program.unknown("peak", highest)
        rising = ca.vertcat(*(share**k for k in range(DEGREE + 1)))
        steepness = ca.vertcat(*(k * share ** (k - 1) for k in range(1, DEGREE + 1)))
        program.zero(ca.mtimes([rising.T, powers, c]) - peak, ("peak",))
        program.zero(ca.mtimes([steepness.T, powers[1:, :], c]), ("level summit",))
        return ca.horzcat(*levels).T, peak, lambda end: part * (span + end.values["summit"][0])

    def _bounded(self, program, of, k, rows, parts, shared, room):
        """Rows of the limits of one scenario, or of the shape; rows (names, n) that are taken."""
        room = [1 - RESERVE + room[name] for name in self.rows[of]]
        if of == "mean":
            inputs = (parts, *shared, *self._scenario(k))
            means = ca.sum2(self._mapped(self._at[of], self.points)(*inputs)) / self.points
            for r in np.flatnonzero(rows[:, 0]):
                bound = room[r] ** int(self.power[r, 0])
                program.negative(means[int(r)] - bound, (of, k, int(r)))
            return
        where = np.flatnonzero(rows.any(axis=0))
        here = parts[:, where.tolist()]
        if of == "shape":
            inputs = (here, *shared[1:])
        else:
            numbers, fix = self._scenario(k)
            inputs = (here, *shared, numbers, fix[:, where.tolist()])
        table = self._mapped(self._at[of], where.size)(*inputs)
        row, column = np.nonzero(rows[:, where])
        uses = ca.vec(table)[(row + column * rows.shape[0]).tolist()]
        bounds = ca.vertcat(*(room[r] for r in row))
        program.negative(uses - bounds, (of, k, rows.shape), (row, where[column]))


def numbers_of(problem):
    """Values of `NUMBERS` of a problem, SI; None: no such limit."""
    ratings, variables = problem.ratings, problem.variables
    rows = {row.id: value for row, value in ratings.limits.items()}
    sides = {
        f"{name}_{side}": getattr(ratings, name)[k]
        for name in ("guide_pressure", "guide_pv", "guide_area")
        for k, side in enumerate("ab")
    }
    known = {
        "rate": variables.rate, "preload": variables.preload,
        "prime_radius": variables.prime_radius, "gear_ratio": problem.gear_ratio,
        "torque_reduction": required_reduction(problem),
    }  # fmt: skip
    numbers = {}
    for name in NUMBERS:
        if name.endswith("_factor") and name not in ("undercut_factor",):
            numbers[name] = 1.0
        elif name in known or name in sides:
            numbers[name] = (known | sides)[name]
        else:
            numbers[name] = rows[name] if name in rows else getattr(ratings, name, None)
    return numbers


def required_reduction(problem):
    """Reduction of the torque ripple, the same wherever the ripple counts; None: none is."""
    (required,) = {item.torque_reduction for item in problem.scenarios if item.weight > 0}
    assert all(item.torque_reduction is None for item in problem.scenarios if item.weight == 0)
    return required


def _vector(numbers):
    return ca.DM([np.nan if numbers[name] is None else numbers[name] for name in NUMBERS])
