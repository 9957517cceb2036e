"""Certificate: both bodies by finite elements at one cam angle, on two or three meshes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_history import CertificatePoint, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair, elastic_body
from camwright.pipeline.contact.elasticity.mesh_convergence import (
    Convergence,
    converged,
    converged_on_two,
)
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.full_contact import ContactSide, ContactSolution, solve_contact
from camwright.pipeline.records.trial_contents import ContactFigure

# Whole numbers of edges: the edge of the contact is a knot of every mesh.
REFINEMENT = 2.0
EDGES = (4.0, 8.0, 16.0)
# Distance of equal elements from the contact, in half-widths, and growth beyond. Finer elements
# change the extrapolated values by less than 2e-4 and take 1.5 times as long.
_MESH_REACH, _MESH_GROWTH = 1.8, 0.2
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
    """Meshes of cam, then follower, in the cam frame, refined at their contact.

    Parameters
    ----------
    theta : float        cam angle, rad
    half_width : float   of the Hertz contact, m
    edges : float        element edges per half-width at the contact
    """
    contact, _ = pair.touched(theta)

    def sizing(far_size: float) -> ElementSize:
        return ElementSize.from_half_width(
            half_width,
            far_size,
            contact_point=contact,
            edges=edges,
            reach=_MESH_REACH,
            growth=_MESH_GROWTH,
        )

    far = float(pair.contour.perimeter()) / _FAR_ON_OUTLINE
    other, angle = pair.follower, float(pair.angle(theta))
    return pair.cam_mesh(sizing(far)), other.mesh_at(pair.contour, angle, sizing(other.far_size))


def solve_pair(
    pair: ContactPair, theta: float, normal_force: float, edges: float = EDGES[1]
) -> SolvedPair:
    """Contact of cam and follower by finite elements at a cam angle theta, rad.

    Parameters
    ----------
    normal_force : float   N, > 0
    edges : float          element edges per Hertz half-width at the contact

    Raises
    ------
    ContactError
        If the load is not positive, or the solution fails.
    """
    pair, load = pair.carrying(theta), normal_force / pair.width
    if not load > 0:
        raise ContactError(f"no load at {shown(theta, 'deg', 6)}: no contact to certify")
    half_width, _ = hertz.line_contact(load, pair.relative_radius(theta), pair.contact_modulus)
    other = pair.follower
    cam, facing = contact_meshes(pair, theta, float(half_width), edges)
    springs = other.springs(facing, pair.contour, float(pair.angle(theta)))
    frame = ContactFrame(*pair.touched(theta))
    sides = (
        ContactSide(elastic_body(cam, pair.cam, pair.held), "contour"),
        ContactSide(elastic_body(facing, other.material, other.held, springs), other.surface),
    )

    def gap(xi: Array) -> Array:
        return np.asarray(pair.gap(np.array([theta]), xi[None])[0])

    solution = solve_contact(sides, frame, gap, load, float(half_width))
    return SolvedPair(theta, frame, cam, facing, sides, float(half_width), solution)


@dataclass(frozen=True)
class MeshFigures:
    """Pressure, half-width and stresses of the contact on one mesh.

    edges per half-width; degrees of freedom; p0, tau_max, von_mises Pa; half_width m; residuals,
    relative.
    """

    edges: float
    dofs: int
    p0: float
    half_width: float
    tau_max: float
    von_mises: float
    residual_equilibrium: float
    residual_complementarity: float


def mesh_figures(pair: ContactPair, theta: float, normal_force: float, edges: float) -> MeshFigures:
    """Pressure, half-width and stresses at a cam angle (rad) and normal force (N), on one mesh.

    Raises
    ------
    ContactError
        If the load is not positive, or the solution fails.
    """
    solved = solve_pair(pair, theta, normal_force, edges).solution
    names = [each.name for each in fields(MeshFigures) if each.name not in ("edges", "dofs")]
    return MeshFigures(edges, solved.dofs, **{name: float(getattr(solved, name)) for name in names})


def certificate_point(
    history: ContactHistory,
    index: int,
    theta: float,
    meshes: Sequence[MeshFigures],
    worst: Sequence[CertificatePoint] = (),
) -> CertificatePoint:
    """Certificate of position `index` of a history, at cam angle theta (rad): convergence of each
    figure over the meshes, beside its value in the cycle.

    Parameters
    ----------
    meshes : sequence   coarse to fine: three, or two with the points `worst`
    worst : sequence    points on three meshes, whose orders are assumed on two
    """

    def over_meshes(name: str) -> tuple[float, ...]:
        return tuple(float(getattr(mesh, name)) for mesh in meshes)

    def figure(name: ContactFigure) -> Convergence:
        if not worst:
            return converged(over_meshes(name), REFINEMENT)
        observed = [point.figures[name][0] for point in worst]
        return converged_on_two(over_meshes(name), REFINEMENT, observed)

    return CertificatePoint(
        theta=theta,
        p0=figure("p0"),
        half_width=figure("half_width"),
        tau_max=figure("tau_max"),
        von_mises=figure("von_mises"),
        edges=over_meshes("edges"),
        dofs=tuple(mesh.dofs for mesh in meshes),
        p0_hertz=float(history.p0_hertz[index]),
        p0_cycle=float(history.p0[index]),
        half_width_cycle=float(history.half_width[index]),
        tau_max_cycle=float(history.tau_max[index]),
        von_mises_cycle=float(history.von_mises[index]),
        residual_equilibrium=max(over_meshes("residual_equilibrium")),
        residual_complementarity=max(over_meshes("residual_complementarity")),
        order_from=tuple(point.theta for point in worst),
    )
