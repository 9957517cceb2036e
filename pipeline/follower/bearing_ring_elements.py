"""Outer ring of a ball bearing on its balls, by plane finite elements.

The balls are unilateral springs without clearance, the contact force acts at one section: the
solution is proportional to the force.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.errors import ContactError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.follower import bearing_ring
from camwright.pipeline.follower.bearing_ring import Ring, RingBending

if TYPE_CHECKING:
    from skfem import Basis, MeshQuad2

_PER_GAP = 24  # elements between two balls, at least
_LAYERS = 2
_HOLD = 1e-6  # over the ball stiffness: support against rotation of the ring
_SIMPSON = np.array([1.0, 4.0, 2.0, 4.0, 1.0]) / 12.0  # weights of the mean over two layers


class RingElements:
    """Mesh of a ring: quadratic quadrilaterals in plane stress, sections at equal angles.

    Displacements of a section are means over its thickness, and forces act on the section
    likewise: local indentation is part of `ball_stiffness`.

    Parameters
    ----------
    ring : Ring
    sections : int    with two elements over the thickness
    poisson : float

    Attributes
    ----------
    stiffness : (d, d)       sparse, N/m
    radial, along : (n, d)   mean radial and tangential displacement of a section
    moment : (n, d)          bending moment, positive with tension at the inner radius
    hoop : (n, d)            hoop force, tension positive
    """

    def __init__(self, ring: Ring, sections: int, poisson: float = 0.3) -> None:
        """Assemble the stiffness and the operators from the displacements to motion, moment and
        hoop force of each section.
        """
        from skfem import Basis, ElementQuad2, ElementVector
        from skfem.models.elasticity import lame_parameters, linear_elasticity

        mesh = annulus(ring.radius, ring.thickness, sections)
        element = ElementVector(ElementQuad2())
        first, shear = lame_parameters(ring.modulus, poisson)
        form = linear_elasticity(2.0 * first * shear / (first + 2.0 * shear), shear)
        basis = Basis(mesh, element, intorder=4)
        self.stiffness = scipy.sparse.csc_array(ring.width * form.assemble(basis))
        local = ring.width * form.elemental(basis).tolocal()
        nodes, height = _nodes(basis, ring.radius, sections)
        turn = FULL_TURN * np.arange(sections) / sections
        outward = np.stack([np.cos(turn), np.sin(turn)], axis=1)[:, :, None]
        ahead = np.stack([-np.sin(turn), np.cos(turn)], axis=1)[:, :, None]
        self.radial, self.along = (
            _rows(nodes, way * _SIMPSON, basis.N) for way in (outward, ahead)
        )
        # the elements between a section and the next one
        after = (np.arange(sections)[:, None] + sections * np.arange(_LAYERS)).ravel()
        dofs = basis.element_dofs[:, after].T
        at = np.repeat(np.arange(sections), _LAYERS)

        def transmitted(virtual: Array) -> scipy.sparse.csr_array:
            """Work of the forces that these elements put on a section in a virtual motion of it."""
            motion = np.zeros((sections, basis.N))
            motion[np.arange(sections)[:, None, None], nodes] = virtual
            work = np.einsum("ei,eij->ej", motion[at[:, None], dofs], local[after])
            return _rows(dofs.reshape(sections, -1), work.reshape(sections, -1), basis.N)

        self.moment = transmitted(ahead * height[:, None])
        self.hoop = transmitted(-ahead * np.ones_like(height)[:, None])


def _nodes(basis: Basis, radius: float, sections: int) -> tuple[NDArray[np.intp], Array]:
    """Degrees of freedom of the nodes of each section of a ring, (sections, 2, nodes), x and y, the
    nodes from inside outwards; and heights of these nodes over the mean radius (sections, nodes),
    m.

    Parameters
    ----------
    basis : Basis    of the finite elements of the ring
    radius : float   mean radius of the ring, m
    sections : int   at equal angles
    """
    angle = np.arctan2(*basis.doflocs[::-1]) / FULL_TURN * sections
    height = np.hypot(*basis.doflocs) - radius
    section = np.rint(angle).astype(np.intp)
    on = np.flatnonzero(np.abs(angle - section) < 0.25)
    order = np.lexsort((height[on], _second(basis)[on], section[on] % sections))
    nodes = on[order].reshape(sections, 2, -1)
    return nodes, height[nodes[:, 0]]


def _second(basis: Basis) -> Array:
    """Component of each degree of freedom: 0 for x, 1 for y."""
    way = np.zeros(basis.N)
    way[basis.get_dofs(elements=True).all(["u^2"])] = 1.0
    return way


def _rows(dofs: NDArray[np.intp], values: Array, size: int) -> scipy.sparse.csr_array:
    """Rows (n, size) of values (n, ...) at dofs (n, ...); values at the same place are added."""
    count = dofs.shape[0]
    rows = np.repeat(np.arange(count), dofs[0].size)
    return scipy.sparse.coo_array((values.ravel(), (rows, dofs.ravel())), (count, size)).tocsr()


@lru_cache(maxsize=16)
def ring_bending(ring: Ring, phases: int = 5, poisson: float = 0.3) -> RingBending:
    """Bending of a ring under unit contact force, from over a ball to midway between two.

    Cached on disk.

    Raises
    ------
    ContactError
        If the set of loaded balls does not converge.

    References
    ----------
    Harris and Kotzalas, Advanced Concepts of Bearing Technology (2007): flexibly supported
    outer rings.
    """
    inputs = ring, int(phases), float(poisson)
    modules = sys.modules[__name__], bearing_ring
    return RingBending(
        **disk_cache.kept("ring", inputs, lambda: _bending_by_ball_position(*inputs), modules)
    )


def _bending_by_ball_position(ring: Ring, phases: int, poisson: float) -> dict[str, Array]:
    """Fields of `RingBending` by name, each (phases, ...), under a unit inward force on the ring.

    phases : positions of the balls, >= 2, from a ball under the force to the force midway between
    two balls, by equal angles. Each is solved apart, with elements so many that its balls are at
    nodes.
    """
    count = 2 * (phases - 1) * -(-_PER_GAP // (2 * (phases - 1)))
    body = RingElements(ring, ring.balls * count, poisson)
    results = [
        _solved_at_position(body, ring, count, k * count // (2 * (phases - 1)))
        for k in range(phases)
    ]
    phase = np.linspace(0.0, 0.5 * FULL_TURN / ring.balls, phases)
    names = ("ball_load", "moment_max", "moment_min", "stress_max", "stress_min", "compliance")
    columns = (np.array(part) for part in zip(*results, strict=True))
    return {"phase": phase, **dict(zip(names, columns, strict=True))}


def _solved_at_position(
    body: RingElements, ring: Ring, count: int, shift: int
) -> tuple[Array, float, float, float, float, float]:
    """Ball loads, greatest and least moment, greatest and least stress, compliance, as in
    `RingBending`, of one ball position under a unit inward force on section 0.

    shift : sections from the force to the first ball; count : sections between two balls. The balls
    that carry are found by iteration.
    """
    sections = body.radial.shape[0]
    at = (shift + count * np.arange(ring.balls)) % sections
    carrying = np.cos(FULL_TURN * at / sections) > 0.0
    held = body.along[[0]]
    seen: set[bytes] = set()
    while carrying.tobytes() not in seen:
        seen.add(carrying.tobytes())
        balls = body.radial[at[carrying]]
        system = body.stiffness + ring.ball_stiffness * (balls.T @ balls + _HOLD * (held.T @ held))
        motion = scipy.sparse.linalg.splu(scipy.sparse.csc_matrix(system)).solve(
            -body.radial[[0]].toarray()[0]
        )
        way = body.radial @ motion
        squeezed = way[at] < 0.0
        if (squeezed == carrying).all():
            share = np.where(carrying, -ring.ball_stiffness * way[at], 0.0)
            moment = body.moment @ motion
            stress = ring.stress_inside(moment, body.hoop @ motion)
            most, least = float(stress.max()), float(stress.min())
            return share, float(moment.max()), float(moment.min()), most, least, float(-way[0])
        carrying = squeezed
    raise ContactError("ring: set of loaded balls not converged")


def annulus(radius: float, thickness: float, sections: int) -> MeshQuad2:
    """Mesh of a closed ring about the origin, of curved quadratic quadrilaterals, two over the
    thickness.

    Parameters
    ----------
    radius : float      mean radius, m
    thickness : float   m
    sections : int      elements around the ring
    """
    from skfem import MeshQuad, MeshQuad2

    angle = FULL_TURN / sections * np.arange(sections)
    depth = radius + thickness * np.linspace(-0.5, 0.5, _LAYERS + 1)
    points = np.stack(
        [np.multiply.outer(depth, np.cos(angle)), np.multiply.outer(depth, np.sin(angle))]
    ).reshape(2, -1)
    k = np.arange(sections)
    after = (k + 1) % sections
    quads = [
        np.stack([row + k, row + sections + k, row + sections + after, row + after])
        for row in sections * np.arange(_LAYERS)
    ]
    flat = MeshQuad2.from_mesh(MeshQuad(points, np.concatenate(quads, axis=1)))
    # Midside nodes along the ring lie on the chord: move them to the arc.
    step = FULL_TURN / sections
    half = np.abs(np.arctan2(flat.doflocs[1], flat.doflocs[0]) / step * 2.0)
    between = np.round(half) % 2 == 1
    return MeshQuad2(flat.doflocs * np.where(between, 1.0 / np.cos(0.5 * step), 1.0), flat.t)
