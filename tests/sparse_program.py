"""Nonlinear programs of sparse blocks, collected piece by piece, solved by CasADi and IPOPT."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

_FRESH = {
    "print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.max_iter": 300,
    "ipopt.bound_relax_factor": 0.0, "ipopt.honor_original_bounds": "yes",
}  # fmt: skip
_WARM = {
    "ipopt.warm_start_init_point": "yes", "ipopt.mu_init": 1e-7,
    "ipopt.warm_start_bound_push": 1e-8, "ipopt.warm_start_mult_bound_push": 1e-8,
    "ipopt.warm_start_slack_bound_push": 1e-8,
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Solved:
    """End of a program: unknowns by name, slopes of the cost by the parameters, multipliers by key.

    `excess`: greatest violation of a row. `multipliers` serve a later program as its start.
    """

    values: dict[str, np.ndarray]
    slopes: np.ndarray
    multipliers: dict
    iterations: int
    excess: float
    status: str


class SparseProgram:
    """Unknowns and blocks of rows; a multiplier of an earlier program is found by its key."""

    def __init__(self, earlier=None):
        self.earlier = earlier or {}
        self._unknowns, self._start, self._low, self._high = [], [], [], []
        self._rows, self._keys, self._least, self._most, self._duals = [], [], [], [], []

    def unknown(self, name, start, low=-np.inf, high=np.inf):
        """Unknown (m,) from its start (m,)."""
        start = np.atleast_1d(np.asarray(start, dtype=float))
        symbol = ca.MX.sym(name, start.size)
        self._unknowns.append(symbol)
        self._start.append(start)
        self._low.append(np.broadcast_to(low, start.shape))
        self._high.append(np.broadcast_to(high, start.shape))
        return symbol

    def zero(self, rows, key):
        """rows = 0."""
        self._constrain(rows, 0.0, key, None)

    def negative(self, rows, key, entries=None):
        """rows <= 0; `entries`: places of the rows in a table, whose shape ends the key."""
        self._constrain(rows, -np.inf, key, entries)

    def _constrain(self, rows, least, key, entries):
        self._rows.append(rows)
        self._keys.append((key, entries))
        self._least.append(np.full(rows.numel(), least))
        self._most.append(np.zeros(rows.numel()))
        own = self.earlier.get(key, np.zeros(rows.numel() if entries is None else key[-1]))
        self._duals.append(own if entries is None else own[entries])

    def solved(self, cost, parameters, values, tolerance):
        """Local minimum of a cost; parameters, MX, at their values."""
        x, g = ca.vertcat(*self._unknowns), ca.vertcat(*self._rows)
        options = _FRESH | {"ipopt.tol": tolerance} | self._derivatives(x, parameters, cost, g)
        sides = {}
        if self.earlier:
            options |= _WARM
            bound = [self.earlier.get(s.name(), np.zeros(s.numel())) for s in self._unknowns]
            sides = {"lam_g0": np.concatenate(self._duals), "lam_x0": np.concatenate(bound)}
        solver = ca.nlpsol("oracle", "ipopt", {"x": x, "p": parameters, "f": cost, "g": g}, options)
        least, most = np.concatenate(self._least), np.concatenate(self._most)
        result = solver(
            **sides, p=values, x0=np.concatenate(self._start), lbx=np.concatenate(self._low),
            ubx=np.concatenate(self._high), lbg=least, ubg=most,
        )  # fmt: skip
        flat = {name: result[name].full().ravel() for name in ("x", "g", "lam_x", "lam_g", "lam_p")}
        stats = solver.stats()
        return Solved(
            values=self._by_name(flat["x"]),
            slopes=-flat["lam_p"],
            multipliers=self._by_key(flat["lam_g"]) | self._by_name(flat["lam_x"]),
            iterations=int(stats["iter_count"]),
            excess=float(np.maximum(flat["g"] - most, least - flat["g"]).max()),
            status=stats["return_status"],
        )

    def _derivatives(self, x, parameters, cost, g):
        """By blocks: rows dense in the unknowns and columns dense in the rows do not mix."""
        inputs = [x, parameters]
        jacobian = ca.vertcat(*(ca.jacobian(rows, x) for rows in self._rows))
        of_cost, of_rows = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.numel())
        hessian = of_cost * ca.hessian(cost, x)[0]
        first = 0
        for rows in self._rows:
            last = first + rows.numel()
            if not ca.is_linear(rows, x):
                hessian += ca.hessian(ca.dot(of_rows[first:last], rows), x)[0]
            first = last
        return {
            "jac_g": ca.Function("nlp_jac_g", inputs, [g, jacobian]),
            "hess_lag": ca.Function("nlp_hess_l", [*inputs, of_cost, of_rows], [ca.triu(hessian)]),
        }

    def _by_name(self, flat):
        ends = np.cumsum([symbol.numel() for symbol in self._unknowns])[:-1]
        parts = np.split(flat, ends)
        return {symbol.name(): part for symbol, part in zip(self._unknowns, parts, strict=True)}

    def _by_key(self, flat):
        ends = np.cumsum([rows.numel() for rows in self._rows])[:-1]
        carried = {}
        for (key, entries), part in zip(self._keys, np.split(flat, ends), strict=True):
            if entries is None:
                carried[key] = part
            else:
                carried[key] = np.zeros(key[-1])
                carried[key][entries] = part
        return carried
