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
from oracle_limits import TORQUE_REDUCTION
from oracle_model import DEGREE, RESERVE, CamModel, periodic_basis
from oracle_numbers import FREE, NUMBERS, vector
from sparse_program import SparseProgram

_NEAR, _MEAN_NEAR = 0.1, 0.01  # distance from the limit of the first rows, and those of means
_EXCEEDED, _CLOSE = 1e-7, 0.02  # excess of rows added; distance from the limit of their neighbours
_SPREAD = 6  # angles between rows taken everywhere
_LEADS = 2e-3  # distance from the worst scenario of the rows taken
_ROUNDS = 20
_SUMMIT = 1e-9  # of the energy: the summit is the highest
_BEYOND = 0.3  # of a part between knots, by which the summit may leave it in one program
_TINY = 1e-5  # weight of the objective beside a violation


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


class Oracle(CamModel):
    """Nonlinear program of one problem; `changed`: other values of `NUMBERS`."""

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
            averaged = of in ("mean", "life")
            margin = -_EXCEEDED if near is None else _MEAN_NEAR if averaged else near
            worst, leader = np.max(tables, axis=0), np.argmax(tables, axis=0)
            for k, table in enumerate(tables):
                leads = table > worst - _LEADS
                taken = leads & (table > room - margin)
                if near is not None:  # everywhere a few, against escape to where no cam is
                    spread = np.arange(table.shape[1]) % _SPREAD == 0
                    taken |= spread & (leader == k)
                elif not averaged:  # and their neighbours
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
        cam = self._cam(c0, free0, self.numbers)
        worn = [self._worn((*cam, *state)) for state in self.states]
        for (of, k), rows in active.items():
            if of in self.rows and rows.any():
                self._bounded(program, of, k, rows, parts, shared, room, worn)
        known = before.ripple if before else self.objective(c0, free0)[0] + 1e-3
        ripple = program.unknown("ripple", known, 0.0)
        for k, item in enumerate(self.scenarios):
            charged, bounded = active["ripple", 0][k], active["ceiling", 0][k]
            if not charged and not bounded:
                continue
            inputs = (parts, *shared, *self.states[k])
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
            ca.vertcat(vector(self.numbers), ca.DM.zeros(len(self.names))),
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

    def _life_left(self, program, row, machine, parts, shared, room, known):
        """Shares of a life that the load cases of a machine spend, less 1; known: means by them.

        The means are unknowns: shares that are not linear in them keep sparse second derivatives.
        """
        life, part = self.lives[row], self.parts_of_life[row]
        function = self._mapped(self._of_rows("life", part), self.points)
        allowed, total = 1 - RESERVE + room[life.check], -1
        for k, duty in self.machines[machine]:
            level = known[k][part]
            unit = np.where(level != 0.0, np.abs(level), 1.0)
            mean = program.unknown(f"{life.check} {k}", level / unit)
            terms = ca.sum2(function(parts, *shared, *self.states[k])) / self.points
            program.zero(terms / unit - mean, ("mean", life.check, k))
            total += duty * life.spent(ca.vertsplit(mean * unit), allowed)
        return total

    def _bounded(self, program, of, k, rows, parts, shared, room, known):
        """Rows of the limits of one scenario or machine, or of the shape; rows (names, n) taken."""
        taken, where = np.flatnonzero(rows.any(axis=1)), np.flatnonzero(rows.any(axis=0))
        if of == "life":
            over = [self._life_left(program, row, k, parts, shared, room, known) for row in taken]
            program.negative(ca.vertcat(*over), (of, k, rows.shape), (taken, np.zeros_like(taken)))
            return
        function = self._of_rows(of, taken)
        room = [1 - RESERVE + room[self.rows[of][r]] for r in taken]
        if of == "mean":
            inputs = (parts, *shared, *self.states[k])
            means = ca.sum2(self._mapped(function, self.points)(*inputs)) / self.points
            power = self.power[taken, 0].tolist()
            bounds = ca.vertcat(
                *(each**exponent for each, exponent in zip(room, power, strict=True))
            )
            over = (means - bounds) * ca.DM(np.sign(power))
            program.negative(over, (of, k, rows.shape), (taken, np.zeros_like(taken)))
            return
        here = parts[:, where.tolist()]
        if of == "shape":
            inputs = (here, *shared[1:])
        else:
            numbers, fix = self.states[k]
            inputs = (here, *shared, numbers, fix[:, where.tolist()])
        table = self._mapped(function, where.size)(*inputs)
        row, column = np.nonzero(rows[np.ix_(taken, where)])
        uses = ca.vec(table)[(row + column * taken.size).tolist()]
        bounds = ca.vertcat(*(room[r] for r in row))
        program.negative(uses - bounds, (of, k, rows.shape), (taken[row], where[column]))
