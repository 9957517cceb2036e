"""Pin in a hole by quadratic finite elements: an independent way to `pin_in_hole`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad, MeshQuad2
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.contact.elasticity.active_set import Complementarity, solve
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar

_CORE = 0.01  # radius at which the pin is held: its force comes in from along the bar
_FAR = 400.0  # outer radius of a body without another surface
_BEYOND = 24  # elements from the window's end to the far side


def half_annulus(knots: Array, inner: float, outer: float, layers: int) -> MeshQuad2:
    """Quadratic quads of a half ring, nodes on the circles; elements grow with the radius.

    Parameters
    ----------
    knots : array (k,)     angles of the fine part, rad, from 0; coarser steps go on to pi
    inner, outer : float   radii
    layers : int           elements from one to the other
    """
    step = (np.pi - knots[-1]) / _BEYOND
    angles = np.r_[knots, knots[-1] + step * np.arange(1, _BEYOND + 1)]
    depths = np.linspace(np.log(inner), np.log(outer), layers + 1)
    flat = MeshQuad2.from_mesh(MeshQuad.init_tensor(angles, depths))
    angle, radius = flat.doflocs[0], np.exp(flat.doflocs[1])
    return MeshQuad2(np.stack([radius * np.cos(angle), radius * np.sin(angle)]), flat.t)


def radial_compliance(knots: Array, body: SolidBar, inner: float, outer: float) -> Array:
    """Radial displacement weighted with each hat under each hat's pressure on radius 1, (k, k).

    The hats stand at `knots` but the last, on one half of the circumference. The other circle
    is held; the loaded one is `inner` or `outer`, whichever is 1.
    """
    layers = int(np.clip(np.log(outer / inner) / 0.06, 12, 60))
    mesh = half_annulus(knots, inner, outer, layers)
    element = ElementVector(ElementQuad2())
    basis = Basis(mesh, element, intorder=5)
    stiffness = linear_elasticity(*lame_parameters(body.modulus, body.poisson)).assemble(basis)
    loaded, held = (_circle(mesh, r) for r in ((inner, outer) if inner == 1.0 else (outer, inner)))
    ends = mesh.facets_satisfying(lambda x: np.abs(x[1]) < 1e-9)
    fixed = np.union1d(basis.get_dofs(held).all(), basis.get_dofs(ends).all(["u^2"]))
    free = np.setdiff1d(np.arange(basis.N), fixed)
    border = FacetBasis(mesh, element, facets=loaded, intorder=7)
    loads = np.stack([_hat_load(border, knots, k)[free] for k in range(len(knots) - 1)], axis=1)
    return np.asarray(loads.T @ splu(stiffness[free][:, free].tocsc()).solve(loads))


def pin_in_hole_by_elements(
    load: float, clearance: float, pin: SolidBar, bush: Bush, window: float, knots: int = 32
) -> tuple[Array, Complementarity]:
    """Pressures at equal angles (knots,) up to a window, both bodies by finite elements; radius 1.

    Parameters
    ----------
    load, clearance : float   per length and radial, radius 1
    window : float            rad, beyond the contact, below 90 deg

    Raises
    ------
    InputError
        If the clearance is negative or the window not between 0 and 90 deg.
    ContactError
        If the contact law is not met.
    """
    if not 0.0 <= clearance < np.inf:
        raise InputError("pin_in_hole.clearance", clearance, ">= 0 m: a press fit cannot slide")
    if not 0.0 < window <= 0.5 * np.pi:
        raise InputError("pin_in_hole.window", window, "> 0 and <= pi/2")
    angles = np.linspace(0.0, window, knots + 1)
    outer = _FAR if bush.wall is None else 1.0 + bush.wall
    compliance = radial_compliance(angles, pin, _CORE, 1.0)
    compliance = compliance + radial_compliance(angles, bush, 1.0, outer)
    step = angles[1]
    level, cosine = (
        np.full(knots, step),
        (4.0 * np.sin(0.5 * step) ** 2 / step) * np.cos(angles[:-1]),
    )
    level[0], cosine[0] = 0.5 * level[0], 0.5 * cosine[0]
    found = solve(compliance, clearance * (level - cosine)[None], cosine, np.array([0.5 * load]))
    return angles[:-1], found


def _circle(mesh: MeshQuad2, radius: float) -> NDArray[np.intp]:
    """Facets on a circle; their straight middles lie inside it, their ends on it."""
    ends = np.hypot(*mesh.p)[mesh.facets]
    return np.flatnonzero((np.abs(ends - radius) < 1e-9 * radius).all(axis=0))


def _hat_load(border: FacetBasis, knots: Array, k: int) -> Array:
    """Load vector of the k-th hat of pressure, directed against the surface's outward normal."""
    heights = np.zeros(len(knots))
    heights[k] = 1.0

    @LinearForm
    def push(v: Any, w: Any) -> Any:
        angle = np.arctan2(w.x[1], w.x[0])
        return -np.interp(angle, knots, heights, right=0.0) * dot(w.n, v)

    return np.asarray(push.assemble(border))
