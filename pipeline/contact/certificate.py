"""Certificate: cam and follower by finite elements at one cam angle, on three meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import BodyMesh, cam_mesh
from camwright.meshes.element_size import Sizing
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair, elastic_body
from camwright.pipeline.contact.elasticity.mesh_convergence import converged
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.full_contact import ContactSide, ContactSolution, solve_contact

# Whole numbers of edges: the edge of the contact is a knot of every mesh.
REFINEMENT = 2.0
EDGES = (4.0, 8.0, 16.0)
# Distance of equal elements from the contact, in half-widths, and growth beyond. Finer elements
# change the extrapolated values by less than 2e-4 and take 1.5 times as long.
_REACH, _GROWTH = 1.8, 0.2
# Elements along the contour at the size far from the contact.
_FAR_ON_OUTLINE = 50


@dataclass(frozen=True, eq=False)
class SolvedPair:
    """Meshes of both bodies in the cam frame and their contact at one cam angle (rad)."""

    theta: float
    frame: ContactFrame
    cam: BodyMesh
    follower: BodyMesh
    sides: tuple[ContactSide, ContactSide]
    half_width_hertz: float
    solution: ContactSolution


def contact_meshes(
    pair: ContactPair, theta: float, half_width: float, edges: float
) -> tuple[BodyMesh, BodyMesh]:
    """Meshes of cam and follower in the cam frame with `edges` element edges per half-width."""
    contact = pair.contour.points(theta)

    def sizing(far_size: float) -> Sizing:
        return Sizing.from_half_width(
            half_width,
            far_size,
            contact_point=contact,
            edges=edges,
            reach=_REACH,
            growth=_GROWTH,
        )

    far = float(pair.contour.perimeter()) / _FAR_ON_OUTLINE
    cam = cam_mesh(pair.contour, pair.bore_radius, pair.keyway, sizing(far), pair.counter_hole)
    other = pair.follower
    return cam, other.mesh_at(pair.contour, theta, sizing(other.far_size))


def solve_pair(
    pair: ContactPair, theta: float, normal_force: float, edges: float = EDGES[1]
) -> SolvedPair:
    """Cam and follower by finite elements at a cam angle theta (rad) under a normal force (N).

    Raises
    ------
    ContactError
        If the load is not positive, or the solution fails.
    """
    load = normal_force / pair.width
    if not load > 0:
        raise ContactError(f"no load at {shown(theta, 'deg', 6)}: no contact to certify")
    half_width, _ = hertz.line_contact(load, pair.relative_radius(theta), pair.contact_modulus)
    other = pair.follower
    cam, facing = contact_meshes(pair, theta, float(half_width), edges)
    springs = other.springs(facing, pair.contour, theta)
    frame = ContactFrame(pair.contour.points(theta), pair.contour.normal(theta))
    sides = (
        ContactSide(elastic_body(cam, pair.cam, "bore"), "contour"),
        ContactSide(elastic_body(facing, other.material, other.held, springs), other.surface),
    )

    def gap(xi: Array) -> Array:
        return np.asarray(pair.gap(np.array([theta]), xi[None])[0])

    solution = solve_contact(sides, frame, gap, load, float(half_width))
    return SolvedPair(theta, frame, cam, facing, sides, float(half_width), solution)


def certificate_point(
    pair: ContactPair, history: ContactHistory, index: int, theta: float
) -> CertificatePoint:
    """Certificate at position `index` of a history, at the cam angle theta (rad)."""
    force = float(history.line_load[index]) * pair.width
    solutions = [solve_pair(pair, theta, force, edges).solution for edges in EDGES]

    def over_meshes(name: str) -> tuple[float, ...]:
        return tuple(float(getattr(s, name)) for s in solutions)

    return CertificatePoint(
        theta=theta,
        p0=converged(over_meshes("p0"), REFINEMENT),
        half_width=converged(over_meshes("half_width"), REFINEMENT),
        tau_max=converged(over_meshes("tau_max"), REFINEMENT),
        von_mises=converged(over_meshes("von_mises"), REFINEMENT),
        edges=EDGES,
        dofs=tuple(s.dofs for s in solutions),
        p0_hertz=float(history.p0_hertz[index]),
        p0_cycle=float(history.p0[index]),
        half_width_cycle=float(history.half_width[index]),
        tau_max_cycle=float(history.tau_max[index]),
        von_mises_cycle=float(history.von_mises[index]),
        residual_equilibrium=max(over_meshes("residual_equilibrium")),
        residual_complementarity=max(over_meshes("residual_complementarity")),
    )
