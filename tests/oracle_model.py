"""Cams of the synthesis oracle: formulas at all angles, starts, utilisations of a cam.

Of the product's `Problem` only plain numbers are read: torque, ratings, scenarios, corrections.
"""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca
import numpy as np
from oracle_limits import LIMITS, TORQUE_REDUCTION
from oracle_numbers import (
    CORRECTION,
    FREE,
    NUMBERS,
    SCENARIO,
    numbers_of,
    scenario_numbers,
    vector,
)
from oracle_states import lift_of, loads_at, shape_at
from scipy.interpolate import BSpline
from scipy.optimize import brentq, minimize_scalar

from camwright.pipeline.smoothing.objective import TORQUE, Weighted

RESERVE = 1e-3  # of each limit, as the product keeps it
DEGREE = 5


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


_ROOM = 4.0  # log of the greatest room of a life


def _sides(use):
    return use if isinstance(use, tuple) else (use,)


def operated(scenarios):
    """Load cases that one machine runs in turn, (place, duty) each: by tolerance corner.

    Without a duty each load case by itself, all the time.
    """
    if any(item.duty is None for item in scenarios):
        return [[(k, 1.0)] for k in range(len(scenarios))]
    running = [(k, item) for k, item in enumerate(scenarios) if item.duty > 0.0]
    corners = dict.fromkeys(item.corner for _, item in running)
    return [[(k, item.duty) for k, item in running if item.corner == each] for each in corners]


STEM = SimpleNamespace(
    lift_of=lambda energy, rate, preload, _: lift_of(energy, rate, preload),
    shape_at=shape_at, loads_at=loads_at, limits=LIMITS,
)  # fmt: skip
"""Formulas of a roller on a stem; of an arm `OracleArm` has them."""


class CamModel:
    """Formulas of one problem; follower: of its kind; `changed`: other values of `NUMBERS`."""

    def __init__(self, problem, follower=STEM, **changed):
        assert problem.ratings.offset == 0.0
        assert problem.objective == (Weighted(TORQUE, 1.0),)
        assert not np.isfinite(problem.energy[1])
        self.follower = follower
        self.count, self.points = problem.coefficients, problem.points
        self.theta = 2 * np.pi * np.arange(self.points) / self.points
        self.basis = [periodic_basis(self.theta, self.count, k) for k in range(4)]
        self.freed = dict(problem.freed)
        self.least = problem.energy[0]
        self.jerk_weight = problem.jerk_weight
        self.scenarios = problem.scenarios
        self.states = [scenario_numbers(item, self.theta) for item in self.scenarios]
        self.machines = operated(self.scenarios)
        nominal = numbers_of(problem)
        self.numbers = nominal | changed
        left_out = problem.left_out
        self.limits = [
            each
            for each in follower.limits
            if each.check not in left_out
            and all(nominal[name] is not None for name in each.needs.split())
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

    def _functions(self):
        symbols = ca.SX.sym("p", len(NUMBERS))
        p = SimpleNamespace(**{name: symbols[k] for k, name in enumerate(NUMBERS)})
        energy, free, top = ca.SX.sym("E", 4), ca.SX.sym("free", 3), ca.SX.sym("top")
        numbers = ca.SX.sym("scenario", len(SCENARIO))
        scenario = SimpleNamespace(**{name: numbers[k] for k, name in enumerate(SCENARIO)})
        ratios = ca.SX.sym("fix", len(CORRECTION))
        fix = SimpleNamespace(**{name: ratios[k] for k, name in enumerate(CORRECTION)})
        cam = self.follower.shape_at(energy, free, p)
        at = self.follower.loads_at(cam, top, scenario, fix)
        self.rows, self._terms, self._at = {}, {}, {}
        inputs = {"shape": [energy, free, symbols]}
        inputs["loads"] = [energy, top, free, symbols, numbers, ratios]
        inputs["mean"] = inputs["life"] = inputs["loads"]
        for of, state in (("shape", cam), ("loads", at)):
            rows, names = [], []
            for each in self.limits:
                if each.of == of:
                    use = _sides(each.use(state))
                    rows += use
                    names += [each.check] * len(use)
            self.rows[of], self._terms[of] = names, (inputs[of], rows)
        means = [(each, each.use) for each in self.limits if each.of == "mean"]
        means += [(each, each.beside) for each in self.limits if each.beside]
        self.rows["mean"] = [each.check for each, _ in means]
        self._terms["mean"] = inputs["mean"], [use(at) for _, use in means]
        self.power = np.array([each.power for each, _ in means])[:, None]
        self.lives = [each for each in self.limits if each.of == "life"]
        terms = [_sides(each.use(at)) for each in self.lives]
        self.rows["life"] = [each.check for each in self.lives]
        self._terms["life"] = inputs["life"], [one for each in terms for one in each]
        self.parts_of_life = np.split(
            np.arange(sum(map(len, terms))), np.cumsum([len(each) for each in terms])[:-1]
        )
        self._torque = ca.Function("torque", inputs["loads"], [at.torque])
        self._jerk = ca.Function("jerk", [energy, free], [cam.jerk]).map(
            self.points, [False, True], [False]
        )
        lift = self.follower.lift_of(energy[0], *ca.vertsplit(free))
        self._lift = ca.Function("lift", [energy[0], free], [lift])

    def _of_rows(self, of, taken=None):
        """Function of the limits of one kind, or of those rows of them."""
        taken = tuple(range(len(self._terms[of][1])) if taken is None else (int(r) for r in taken))
        if (of, taken) not in self._at:
            inputs, rows = self._terms[of]
            self._at[of, taken] = ca.Function(of, inputs, [ca.vertcat(*(rows[r] for r in taken))])
        return self._at[of, taken]

    def _mapped(self, function, count):
        """The function at `count` angles; the numbers of the machine are common to all."""
        if function.n_in() == 3:
            return function.map(count, [False, True, True], [False])
        return function.map(count, [False, True, True, True, True, False], [False])

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
        """Utilisations at the points, ripples, jerk: ({of: [(rows, n) of each scenario]}, ...).

        Of a life (rows, 1) of each machine.
        """
        numbers = numbers or self.numbers
        parts, top, own, p = self._cam(coefficients, free, numbers)
        uses = {"shape": [self._mapped(self._of_rows("shape"), self.points)(parts, own, p).full()]}
        uses |= {"loads": [], "mean": []}
        ripples, worn = [], []
        for k, item in enumerate(self.scenarios):
            inputs = (parts, top, own, p, *self.states[k])
            for of in ("loads", "mean"):
                uses[of].append(self._mapped(self._of_rows(of), self.points)(*inputs).full())
            worn.append(self._worn(inputs))
            torque = self._mapped(self._torque, self.points)(*inputs).full().ravel()
            engine = np.asarray(ca.DM(self._engine(k, free.get("phase", 0.0)))).ravel()
            left = engine - torque / numbers["gear_ratio"]
            ripples.append(float(np.std(left) / np.std(item.torque)) if item.weight > 0 else 0.0)
        uses["life"] = [
            np.reshape(
                [self._life_used(row, worn, machine) for row in range(len(self.lives))], (-1, 1)
            )
            for machine in self.machines
        ]
        jerk = self._jerk(parts, own).full().ravel() / self.jerk_norm
        return uses, ripples, 0.5 * self.jerk_weight * float(jerk @ jerk)

    def _cam(self, coefficients, free, numbers):
        """Energies at the points, maximum lift, free variables, numbers of the machine."""
        own = ca.DM([free.get(name, numbers[name]) for name in FREE])
        parts = ca.DM(np.stack([basis @ coefficients for basis in self.basis]))
        summit = periodic_basis(np.array([self._summit(coefficients)]), self.count) @ coefficients
        return parts, self._lift(float(summit[0]), own), own, vector(numbers)

    def _worn(self, inputs):
        """Means of all lives of one scenario."""
        return self._mapped(self._of_rows("life"), self.points)(*inputs).full().mean(axis=1)

    def _life_used(self, row, worn, machine):
        """Room of a life at which its shares add to 1; 0 where they never do."""
        life, part = self.lives[row], self.parts_of_life[row]

        def excess(log_room):
            room = float(np.exp(log_room))
            return sum(float(life.spent(worn[k][part], room)) * duty for k, duty in machine) - 1.0

        if not excess(-_ROOM) > 0.0 > excess(_ROOM):
            return 0.0
        return float(np.exp(brentq(excess, -_ROOM, _ROOM, xtol=1e-15, rtol=1e-14)))

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
        for of in ("shape", "loads", "life"):
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
