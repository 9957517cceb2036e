"""Roller in a circular recess by quadratic finite elements, mortar contact, true circles.

Independent of `conforming_line` and `pin_in_hole`: both bodies are meshed with their own radii, the
gap is the distance of the two circles along the normal of the roller, the pressure is a multiplier
on the surface of the roller, whose active set is determined here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pin_in_hole_elements import _circle
from scipy.optimize import minimize_scalar
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad, MeshQuad2
from skfem.models.elasticity import lame_parameters, linear_elasticity

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.elasticity.elastic_body import Elastic

_CORE, _FAR = 0.01, 400.0  # radii over that of the roller at which the bodies are held
_EDGE_KNOTS = 5  # beside the edge, which lies between knots: their pressures oscillate by 4 %
_GROWTH, _LARGEST = 1.3, 0.3  # of the elements, and their greatest size over the radius


class RollerInRecess(NamedTuple):
    """Peak pressure, Pa, half contact angle on the roller, rad, and pressure (k,), Pa, at angles
    on the roller, rad; radius of the roller 1.
    """

    peak: float
    half_angle: float
    angle: Array
    pressure: Array


def roller_in_recess(
    load: float, clearance: float, window: float, roller: Elastic, wall: Elastic, knots: int = 48
) -> RollerInRecess:
    """Contact of a roller of radius 1 in a recess of radius 1 + clearance under a line load.

    A point of the roller meets the wall along its own normal, while both circles touch at angle 0.

    Parameters
    ----------
    window : float   angle on the roller up to which it can touch, rad
    """
    outer = 1.0 + clearance
    angles = np.linspace(0.0, window, knots + 1)

    def turn(angle: Array) -> Array:  # from the normal of the roller to that of the wall
        return np.asarray(np.arcsin(clearance / outer * np.sin(angle)))

    fine = np.linspace(0.0, window, 40001)
    on_wall = fine - turn(fine)

    def across(angle: Array) -> tuple[Array, Array]:
        here = np.interp(angle, on_wall, fine, right=2.0 * window)
        slope = clearance / outer * np.cos(here) / np.cos(turn(here))
        return here, 1.0 / (outer * (1.0 - slope))

    ring = _ring(angles, 1.0, _CORE)
    compliance = _compliance(ring, roller, 1.0, _CORE, angles, lambda x: (x, np.ones_like(x)))
    ring = _ring(angles - turn(angles), outer, _FAR)
    compliance += _compliance(ring, wall, outer, _FAR, angles, across)

    points, weights = np.polynomial.legendre.leggauss(8)
    step = angles[1]
    s = step * np.concatenate([points - 1.0, points + 1.0]) / 2.0
    hat = np.tile(0.5 * step * weights, 2) * (1.0 - np.abs(s) / step)
    at = angles[:-1, None] + s
    hats = np.broadcast_to(hat, at.shape) * (at > 0.0)
    distance = np.sqrt(outer**2 - (clearance * np.sin(at)) ** 2) - clearance * np.cos(at) - 1.0
    gap, cosine = (hats * distance).sum(axis=1), (hats * np.cos(at)).sum(axis=1)
    pressure = _pressed(compliance, gap, cosine, 0.5 * load)
    peak, edge = _fitted(angles[:-1], pressure)
    return RollerInRecess(peak, edge, angles[:-1], pressure)


def _ring(angles: Array, surface: float, other: float) -> MeshQuad2:
    """Half ring from the loaded circle `surface` to the `other`, elements growing from it; fine at
    the angles, rad, on to pi.
    """
    step = angles[-1] - angles[-2]
    steps = step * _GROWTH ** np.arange(1, 200)
    beyond = angles[-1] + np.cumsum(steps)
    beyond = beyond[beyond < np.pi - steps[: beyond.size]]
    depth, last = [0.0], np.log(other / surface)
    while depth[-1] < abs(last):
        depth.append(depth[-1] + min(step * _GROWTH ** (len(depth) - 1), _LARGEST))
    heights = np.sort(np.log(surface) + np.sign(last) * np.array(depth) * abs(last) / depth[-1])
    flat = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.r_[angles, beyond, np.pi], heights))
    angle, radius = flat.doflocs[0], np.exp(flat.doflocs[1])
    return MeshQuad2(np.stack([radius * np.cos(angle), radius * np.sin(angle)]), flat.t)


def _fitted(angle: Array, pressure: Array) -> tuple[float, float]:
    """Peak and edge of a pressure that ends as a square root, by least squares; the last knots
    in contact, which carry the error of the edge between knots, are left out.
    """
    last = int((pressure > 0.0).sum()) - _EDGE_KNOTS
    at, values = angle[:last], pressure[:last]

    def fit(edge: float) -> tuple[float, float]:
        shape = np.sqrt(1.0 - (at / edge) ** 2)[:, None] * at[:, None] ** np.array([0, 2, 4])
        found, *_ = np.linalg.lstsq(shape, values, rcond=None)
        return float(np.sum((shape @ found - values) ** 2)), float(found[0])

    step = angle[1]
    bounds = at[-1] + (_EDGE_KNOTS - 1.0) * step, at[-1] + (_EDGE_KNOTS + 2.5) * step
    edge = minimize_scalar(
        lambda x: fit(x)[0] / values[0] ** 2, bounds=bounds, method="bounded",
        options={"xatol": 1e-7},
    ).x  # fmt: skip
    return fit(edge)[1], float(edge)


def _pressed(compliance: Array, gap: Array, cosine: Array, load: float) -> Array:
    """Pressure (k,) >= 0 at the hats under a load, no penetration: primal-dual active set."""
    active = np.ones(gap.size, dtype=bool)
    for _ in range(60):
        n = int(active.sum())
        matrix = np.zeros((n + 1, n + 1))
        matrix[:n, :n] = compliance[np.ix_(active, active)]
        matrix[:n, n] = -cosine[active]
        matrix[n, :n] = cosine[active]
        solved = np.linalg.solve(matrix, np.r_[-gap[active], load])
        pressure = np.zeros(gap.size)
        pressure[active] = solved[:n]
        left = compliance @ pressure + gap - solved[n] * cosine
        carrying = np.where(active, pressure > 0.0, left < 0.0)
        if (carrying == active).all():
            return pressure
        active = carrying
    raise RuntimeError("the active set of the contact cycles")


def _compliance(
    mesh: MeshQuad2,
    body: Elastic,
    loaded: float,
    held: float,
    knots: Array,
    on_roller: Callable[[Array], tuple[Array, Array]],
) -> Array:
    """Displacement along the normal of the roller weighted with each hat under each hat (k, k).

    on_roller : angle on the loaded circle -> angle on the roller, its length over that here
    """
    basis, free = _held(mesh, held)
    border = FacetBasis(mesh, basis.elem, facets=_circle(mesh, loaded), intorder=9)

    def load(k: int) -> Array:
        heights = np.eye(knots.size)[k]

        @LinearForm
        def push(v: Any, w: Any) -> Any:
            angle, stretch = on_roller(np.arctan2(w.x[1], w.x[0]))
            hat = np.interp(angle, knots, heights, right=0.0) * stretch
            return hat * (np.cos(angle) * v[0] + np.sin(angle) * v[1])

        return np.asarray(push.assemble(border)[free])

    loads = np.stack([load(k) for k in range(knots.size - 1)], axis=1)
    matrix = _stiffness(basis, body)[free][:, free]
    return np.asarray(loads.T @ splu(matrix.tocsc()).solve(loads))


def _held(mesh: MeshQuad2, circle: float) -> tuple[Basis, NDArray[np.intp]]:
    """Basis of the displacements, and its free degrees: one circle is held, the axis a mirror."""
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=5)
    ends = mesh.facets_satisfying(lambda x: np.abs(x[1]) < 1e-9)
    held = basis.get_dofs(_circle(mesh, circle)).all(), basis.get_dofs(ends).all(["u^2"])
    return basis, np.setdiff1d(np.arange(basis.N), np.union1d(*held))


def _stiffness(basis: Basis, body: Elastic) -> Any:
    return linear_elasticity(*lame_parameters(body.modulus, body.poisson)).assemble(basis)


def wall_axis_stress(
    pressure: Callable[[Array], Array], half_angle: float, wall: Elastic, depth: Array
) -> Array:
    """Stress (2, k), Pa, along the wall and into it, below the middle of a hole of radius 1 under a
    pressure by the angle, rad, at depths (k,).
    """
    angles = np.linspace(0.0, 1.1 * half_angle, 45)
    mesh = _ring(angles, 1.0, _FAR)
    basis, free = _held(mesh, _FAR)
    border = FacetBasis(mesh, basis.elem, facets=_circle(mesh, 1.0), intorder=9)

    @LinearForm
    def push(v: Any, w: Any) -> Any:
        angle = np.arctan2(w.x[1], w.x[0])
        return pressure(angle) * (np.cos(angle) * v[0] + np.sin(angle) * v[1])

    shift, matrix = np.zeros(basis.N), _stiffness(basis, wall)[free][:, free]
    shift[free] = splu(matrix.tocsc()).solve(push.assemble(border)[free])
    strain = basis.interpolate(shift).grad
    lame, shear = lame_parameters(wall.modulus, wall.poisson)
    x, y = basis.global_coordinates()
    # Through the Gauss points of the elements beside the axis.
    beside = (np.abs(y) < angles[1]) & (x < 1.0 + 1.5 * depth.max())
    fitted = []
    for i in (1, 0):
        stress = lame * (strain[0, 0] + strain[1, 1]) + 2.0 * shear * strain[i, i]
        line = np.polynomial.Polynomial.fit(x[beside] - 1.0, stress[beside], 9)
        fitted.append(line(depth))
    return np.array(fitted)
