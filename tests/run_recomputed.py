"""Demands of checks recomputed from the files of a finished run, by formulations of their own.

Meshes by their nodes in ``4_mesh.msh``, the certificate from its raw values on three meshes, the
bore by the elements of scikit-fem, the crank speed by Runge and Kutta in the crank angle.
"""

from __future__ import annotations

import csv
import json
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, fsolve
from scipy.spatial import cKDTree
from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, FacetBasis, LinearForm, MeshTri
from skfem.helpers import ddot, dot, eye, sym_grad, trace
from skfem.utils import condense, solve

FIGURES = ("p0", "half_width", "tau_max", "von_mises")


class RunFiles:
    """Files of a finished run, its last trial."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.trial = max(folder.glob("trial_*"), key=lambda path: int(path.name[6:]))
        self.record: dict[str, Any] = json.loads((self.trial / "trial.json").read_text())
        self.case: dict[str, Any] = tomllib.loads((folder / "case.toml").read_text())
        self.checks: dict[str, dict[str, Any]] = {
            each["id"]: each for each in json.loads((self.trial / "6_checks.json").read_text())
        }

    def columns(self, name: str, load_case: str = "") -> dict[str, np.ndarray]:
        """Columns of a table of the trial or of the run, of one load case."""
        path = self.trial / name if (self.trial / name).exists() else self.folder / name
        with path.open(newline="", encoding="utf-8") as stream:
            rows = [row for row in csv.DictReader(stream)
                    if not load_case or row["load_case"] == load_case]  # fmt: skip
        return {key: np.array([float(row[key] or "nan") for row in rows])
                for key in rows[0] if key != "load_case"}  # fmt: skip

    def mesh(self, body: str) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Nodes (n, 2), m, triangles (m, 6), and sides (k, 3) by their name, of a body."""
        return _meshes(self.trial / "4_mesh.msh")[body]

    def value(self, text: str) -> float:
        """A quantity of the case by its dotted name, in the unit that the case states."""
        table: Any = self.case
        for key in text.split("."):
            table = table[key]
        return float(str(table).split()[0])


@cache
def _meshes(path: Path) -> dict[str, tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]]:
    read = meshio.read(path)
    bodies = {}
    for body in ("cam", "roller"):
        parts = {
            name: np.vstack([block.data[members] for block, members in zip(
                read.cells, sets, strict=True) if members is not None and len(members)])
            for name, sets in read.cell_sets.items() if name.split("_")[0] == body
        }  # fmt: skip
        inside = parts.pop(body)
        own, place = np.unique(inside, return_inverse=True)
        sides = {name.split("_")[1]: np.searchsorted(own, part) for name, part in parts.items()}
        bodies[body] = 1e-3 * read.points[own, :2], place.reshape(inside.shape), sides
    return bodies


# --- meshes ----------------------------------------------------------------------------------

_CORNERS = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])


def _tangents(run: RunFiles) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives (2, 6, m, 2), m, of the curved triangles along xi and eta at their nodes.

    By central differences of the quadratic through the six nodes, which are exact.
    """

    def monomials(at: np.ndarray) -> np.ndarray:
        x, y = at.T
        return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)

    to_nodes = np.linalg.inv(monomials(_CORNERS))
    both = []
    for step in (np.array([0.5, 0.0]), np.array([0.0, 0.5])):
        weights = (monomials(_CORNERS + step) - monomials(_CORNERS - step)) @ to_nodes
        both.append([
            np.einsum("kj,mjc->kmc", weights, run.mesh(body)[0][run.mesh(body)[1]])
            for body in ("cam", "roller")
        ])  # fmt: skip
    return np.concatenate(both[0], axis=1), np.concatenate(both[1], axis=1)


def least_scaled_jacobian(run: RunFiles) -> float:
    """Twice the area by Heron over the product of the longer two edges, 1 if equilateral."""
    one, two = _tangents(run)
    lengths = np.sort([np.linalg.norm(each, axis=-1) for each in (one, two, two - one)], axis=0)
    half = 0.5 * lengths.sum(axis=0)
    area = np.sqrt(np.maximum(half * np.prod(half - lengths, axis=0), 0.0))
    sense = np.sign(one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0])
    return float(np.min(sense * 4.0 / np.sqrt(3.0) * area / (lengths[1] * lengths[2])))


def least_angle(run: RunFiles) -> float:
    """Least angle of two edges at a corner by the law of cosines, deg."""
    one, two = _tangents(run)
    least = 180.0
    for k, (first, second) in enumerate(((one, two), (two - one, -one), (-two, one - two))):
        a, b = first[k], second[k]
        c = np.linalg.norm(a - b, axis=-1)
        a, b = np.linalg.norm(a, axis=-1), np.linalg.norm(b, axis=-1)
        cosine = (a * a + b * b - c * c) / (2.0 * a * b)
        least = min(least, float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))).min()))
    return least


def spacings_in_contact(run: RunFiles) -> float:
    """Half-width over the widest gap between neighbouring nodes of either surface in it."""
    half_width = 1e-3 * run.record["mesh"]["half_width_mm"]
    surfaces = []
    for body, side in (("cam", "contour"), ("roller", "rim")):
        points, _, sides = run.mesh(body)
        surfaces.append(points[np.unique(sides[side])])
    apart = np.linalg.norm(surfaces[0][:, None] - surfaces[1][None], axis=-1)
    contact = surfaces[0][np.unravel_index(apart.argmin(), apart.shape)[0]]
    widest = 0.0
    for points in surfaces:
        arm = points - contact
        near = arm[np.linalg.norm(arm, axis=1) < 1.02 * half_width]
        along = near[np.argmax(np.linalg.norm(near, axis=1))]
        places = np.sort(near @ along / np.linalg.norm(along))
        widest = max(widest, float(np.diff(places).max()))
    return half_width / widest


def keyway_zone(run: RunFiles) -> float:
    """One and a half times the longest chord of the keyway's sides, mm."""
    points, _, sides = run.mesh("cam")
    ends = points[sides["keyway"][:, :2]]
    return 1.5e3 * float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max())


# --- certificate -----------------------------------------------------------------------------


def convergence_index(coarse: float, middle: float, fine: float) -> tuple[float, float]:
    """Grid convergence index, %, and value at zero size, of meshes refined by 2; by Roache.

    f = f0 + C h^p through the three values, p by bisection of the ratio of the differences; without
    such a p three times the spread, and what p = 1/2 gives where the values are monotone.
    """
    first, second = middle - coarse, fine - middle
    spread = np.ptp([coarse, middle, fine]) / abs(fine)
    least = 3.0 * abs(second / fine) / (np.sqrt(2.0) - 1.0)
    if first * second <= 0.0 or abs(second) >= abs(first) or spread < 2e-4:
        bar = 3.0 * spread
        return 100.0 * (max(bar, least) if first * second > 0.0 else bar), fine
    order = brentq(lambda p: first / second - 2.0**p, 1e-9, 60.0)
    bound = float(np.clip(order, 0.5, 3.0))
    zero = fine + second / (2.0**bound - 1.0)
    return 100.0 * (1.25 if order >= 1.0 else 3.0) * abs(zero / fine - 1.0), zero


def _certified(run: RunFiles) -> list[dict[str, tuple[float, float, float]]]:
    """At each certified angle the index, the value at zero size and that of the cycle."""
    keys = {name: "mm" if name == "half_width" else "MPa" for name in FIGURES}
    return [
        {
            name: (
                *convergence_index(*point[f"{name}_{unit}"]["meshes"]),
                point[f"{name}_{unit}"]["cycle"],
            )
            for name, unit in keys.items()
        }
        for point in run.record["certificate"]
    ]


def index_of(name: str) -> Callable[[RunFiles], float]:
    """Greatest index of one quantity, %."""
    return lambda run: max(point[name][0] for point in _certified(run))


def greatest_index(run: RunFiles) -> float:
    return max(index_of(name)(run) for name in FIGURES)


def greatest_spread(run: RunFiles) -> float:
    """Greatest difference of the cycle from the value at zero size, %."""
    return 100.0 * max(
        abs(cycle / zero - 1.0) for point in _certified(run) for _, zero, cycle in point.values()
    )


# --- bore ------------------------------------------------------------------------------------


def bore_stress(run: RunFiles) -> float:
    """Greatest von Mises stress of the held bore under the line load at its worst angle, MPa.

    The load is spread over the sides of the contour about the contact; bore and keyway are held on
    the bore alone, as by a rigid shaft in it.
    """
    row = run.checks["bore_stress"]
    loads = run.columns("5_cycle.csv", row["load_case"])
    k = int(np.argmin(np.abs(loads["cam_angle_deg"] - row["cam_angle_deg"])))
    shape = run.columns("3_contour.csv")
    at = int(np.argmin(np.abs(shape["cam_angle_deg"] - row["cam_angle_deg"])))
    contact = 1e-3 * np.array([shape["contour_x_mm"][at], shape["contour_y_mm"][at]])
    normal = np.array([shape["normal_x"][at], shape["normal_y"][at]])
    points, triangles, sides = run.mesh("cam")
    four = triangles[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    mesh = MeshTri(np.ascontiguousarray(points.T), np.ascontiguousarray(four.T))
    facets = mesh.boundary_facets()
    middle = mesh.p[:, mesh.facets].mean(axis=1)
    tree = cKDTree(middle[:, facets].T)
    halves = {name: np.vstack([part[:, [0, 2]], part[:, [2, 1]]]) for name, part in sides.items()}
    on = {name: facets[tree.query(points[half].mean(axis=1))[1]] for name, half in halves.items()}
    card = run.case["materials"][run.case["cam"]["material"]]
    young, nu = float(card["E"].split()[0]) * 1e9, float(card["nu"])
    mu, lam = 0.5 * young / (1.0 + nu), young * nu / (1.0 + nu) / (1.0 - 2.0 * nu)
    basis = Basis(mesh, ElementVector(ElementTriP2()))

    @BilinearForm
    def energy(u: Any, v: Any, _: Any) -> Any:
        strain = sym_grad(u)
        return ddot(2.0 * mu * strain + lam * eye(trace(strain), 2), sym_grad(v))

    width = 2e-3
    near = on["contour"][
        np.linalg.norm(middle[:, on["contour"]] - contact[:, None], axis=0) < width
    ]
    assert near.size >= 2
    rim = FacetBasis(mesh, ElementVector(ElementTriP2()), facets=near)
    length = float(np.sum(rim.dx))

    @LinearForm
    def load(v: Any, _: Any) -> Any:
        return -dot(v, normal[:, None, None] * np.ones_like(v)) / length

    push = load.assemble(rim) * loads["line_load_N_per_mm"][k] * 1e3
    held = basis.get_dofs(on["bore"])
    displacement = solve(*condense(energy.assemble(basis), push, D=held))
    corners = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    at_nodes = Basis(mesh, basis.elem, quadrature=(corners, np.ones(3)))
    strain = np.asarray(sym_grad(at_nodes.interpolate(displacement)))
    share, mean = np.bincount(mesh.t.T.ravel()), np.zeros((2, 2, len(points)))
    for i, j in np.ndindex(2, 2):
        mean[i, j] = np.bincount(mesh.t.T.ravel(), strain[i, j].ravel())
    mean /= share
    plane = 2.0 * mu * mean + lam * eye(trace(mean), 2)
    axial = nu * (plane[0, 0] + plane[1, 1])
    spread = (plane[0, 0] - plane[1, 1], plane[1, 1] - axial, axial - plane[0, 0])
    mises = np.sqrt(0.5 * sum(each**2 for each in spread) + 3.0 * plane[0, 1] ** 2)
    nodes = np.unique(np.concatenate([sides[name] for name in ("bore", "keyway") if name in sides]))
    if "keyway" in sides:
        edges = points[np.intersect1d(sides["bore"], sides["keyway"])]
        apart = np.linalg.norm(points[nodes, None] - edges[None], axis=-1).min(axis=1)
        nodes = nodes[apart >= 1e-3 * keyway_zone(run)]
    return float(mises[nodes].max()) / 1e6


# --- benchmarks ------------------------------------------------------------------------------


def line_contact_by_quadrature(load: float, radius: float, modulus: float) -> tuple[float, float]:
    """Half-width, m, and peak pressure, Pa, of a cylinder on a half-plane, N/m, m, Pa.

    Pressure p of the singular equation  int p(s)/(x - s) ds = pi E* x/(2 R)  by Gauss-Chebyshev
    quadrature; the half-width by bisection of the load.
    """
    count = 41
    t = np.cos(np.arange(1, count + 1) * np.pi / (count + 1))
    x = np.cos((np.arange(1, count + 2) - 0.5) * np.pi / (count + 1))
    weights = np.pi * (1.0 - t**2) / (count + 1)
    unit = np.linalg.lstsq(weights / (x[:, None] - t), x, rcond=None)[0]  # for pi E* a/(2 R) = 1
    scale = np.pi * modulus / (2.0 * radius)
    half_width = brentq(lambda a: a * a * scale * (weights @ unit) - load, 0.0, radius)
    return half_width, half_width * scale * float(unit[count // 2])


# --- speed of the crank ----------------------------------------------------------------------


def _ripple(theta: np.ndarray, torque: np.ndarray, inertia: np.ndarray, mean: float) -> float:
    """Standard deviation of the crank speed, rad/s: J w dw/dtheta = T - T_load - w^2 J'/2."""
    span = np.r_[theta, theta[0] + 4.0 * np.pi]
    push = CubicSpline(span, np.r_[torque, torque[0]], bc_type="periodic")
    mass = CubicSpline(span, np.r_[inertia, inertia[0]], bc_type="periodic")
    slope = mass.derivative()

    def turned(start: float, load: float) -> Any:
        def rate(at: float, speed: np.ndarray) -> np.ndarray:
            return (push(at) - load - 0.5 * slope(at) * speed**2) / (mass(at) * speed)

        return solve_ivp(
            rate, (span[0], span[-1]), [start], t_eval=span, rtol=1e-8, max_step=0.05
        ).y[0]

    def misses(guess: np.ndarray) -> list[float]:
        speed = turned(*guess)
        time = CubicSpline(span, 1.0 / speed).integrate(span[0], span[-1])
        return [speed[-1] - speed[0], 4.0 * np.pi / time - mean]

    start, load = fsolve(misses, [mean, float(torque.mean())], xtol=1e-8)
    return float(np.std(turned(start, load)[:-1]))


def speed_reduction(run: RunFiles) -> float:
    """Of the first load case: torque of the engine and forces of the cycle on the crank."""
    state = run.case["load_case"][0]
    mean = float(str(state["speed"]).split()[0]) * np.pi / 30.0
    torque = run.columns("1_torque.csv")
    theta = np.radians(torque["crank_angle_deg"])
    step = theta[1] - theta[0]
    # at the mean speed the reciprocating masses give the torque -w^2 J'/2; J = 0 at dead centre
    inertia = torque["inertia_Nm"]
    varying = -2.0 / mean**2 * np.r_[0.0, np.cumsum(0.5 * step * (inertia[1:] + inertia[:-1]))]
    outer = torque["total_Nm"] - inertia
    plain = run.value("crankshaft.inertia")
    before = _ripple(theta, outer, plain + varying, mean)
    loads = run.columns("5_cycle.csv", state["name"])
    lift = run.columns("2_lift.csv")
    cam = np.radians(loads["cam_angle_deg"])
    ends = np.r_[np.radians(lift["cam_angle_deg"]), 2.0 * np.pi]
    rise = CubicSpline(ends, 1e-3 * np.r_[lift["lift_mm"], lift["lift_mm"][0]], bc_type="periodic")
    along = rise(cam, 1)
    driven = loads["cam_torque_Nm"] - loads["inertia_force_N"] * along
    whole = np.r_[cam, 2.0 * np.pi]
    drive = CubicSpline(whole, np.r_[driven, driven[0]], bc_type="periodic")
    at = np.mod(0.5 * theta, 2.0 * np.pi)
    mass = run.value("follower.mass") * 1e-3
    total = plain + run.value("crankshaft.mechanism_inertia") + varying
    total += mass * (0.5 * rise(at, 1)) ** 2
    after = _ripple(theta, outer - 0.5 * drive(at), total, mean)
    return 1.0 - after / before


# --- shape ------------------------------------------------------------------------------------
def closure(run: RunFiles) -> float:
    """Where a polynomial through the last values of the lift ends, less the first, um."""
    values, count = run.columns("workshop/contour.csv")["lift_mm"], 8
    last = np.polynomial.Polynomial.fit(np.arange(-count, 0.0), values[-count:], count - 1)
    return 1e3 * abs(float(last(0.0)) - float(values[0]))


def acceleration_step(run: RunFiles) -> float:
    """Greatest change of the second difference over its range: a step stays, a bend halves."""
    values = run.columns("workshop/contour.csv")["lift_mm"]

    def steps(spacing: int) -> float:
        every = values[::spacing]
        second = np.roll(every, 1) - 2.0 * every + np.roll(every, -1)
        return float(np.max(np.abs(np.diff(second, append=second[0]))) / np.ptp(second))

    return max(0.0, 2.0 * steps(1) - steps(2))


def gouge(run: RunFiles) -> float:
    """Greatest depth of the nearest point of the contour within the wheel on any other, mm."""
    table, tool = run.columns("workshop/contour.csv"), run.value("workshop.tool_radius")
    points = np.column_stack([table["x_mm"], table["y_mm"]])
    whole = np.arange(len(points) + 1.0)
    curve = CubicSpline(whole, np.vstack([points, points[:1]]), bc_type="periodic")
    at = np.arange(0.0, len(points), 0.025)
    along = curve(at, 1)
    normal = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    nearest, _ = cKDTree(curve(at)).query(curve(at) + tool * normal)
    return float(np.max(tool - nearest))


RECOMPUTED: dict[str, tuple[Callable[[RunFiles], float], float, float]] = {
    # function, relative and absolute tolerance in the unit of the check
    "mesh_jacobian": (least_scaled_jacobian, 1e-9, 0.0),
    "mesh_angle": (least_angle, 1e-7, 0.0),
    "mesh_edges": (spacings_in_contact, 0.02, 0.0),  # chords in place of arcs
    "excluded_zone": (keyway_zone, 1e-9, 0.0),
    **{f"mesh_{name}": (index_of(name), 1e-6, 1e-9) for name in FIGURES},
    "certificate_gci": (greatest_index, 1e-6, 1e-9),
    "certificate_spread": (greatest_spread, 1e-6, 1e-9),
    "bore_stress": (bore_stress, 0.05, 0.0),  # the error bar of the check is 3 to 5 %
    "closure": (closure, 0.0, 0.01),  # of the polynomial, a hundredth of the limit
    "acceleration_step": (acceleration_step, 0.0, 0.02),  # a tenth of the limit
    "tool_gouge": (gouge, 0.01, 2e-4),  # points 15 um apart; um of a spline through the table
    "speed_reduction": (speed_reduction, 5e-3, 0.0),  # friction at the mean speed
}
"""Checks whose demand the files of a run give again, with the tolerance of the formulation."""
