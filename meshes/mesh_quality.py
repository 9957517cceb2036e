"""Mesh quality: corner angles, scaled Jacobians and edges per contact half-width."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, positive
from camwright.geometry.errors import MeshError
from camwright.meshes.body_mesh import BodyMesh

# Reference coordinates of the six nodes of a triangle: corners, then mid-side 01, 12, 20.
_NODES = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5))
_EQUILATERAL = 2.0 / np.sqrt(3.0)

# Limits of a mesh to be solved on: usual in finite elements, verify.
LEAST_ANGLE_DEG = 20.0
LEAST_SCALED_JACOBIAN = 0.3
FACET_SHARE = 0.99
"""Of the required edges: a facet on a curve is slightly longer than its size."""


@dataclass(frozen=True)
class Quality:
    """Quality figures of a mesh.

    Parameters
    ----------
    min_angle_deg : float              minimum corner angle between the curved edges, deg
    min_scaled_jacobian : float        minimum over all nodes; 1 for an equilateral triangle, <= 0
                                       where a curved triangle folds
    edges_across_half_width : float    half-width over the longest facet in the contact; 0 for a
                                       mesh without a contact
    elements, nodes : int
    """

    min_angle_deg: float
    min_scaled_jacobian: float
    edges_across_half_width: float
    elements: int
    nodes: int


def quality(
    mesh: BodyMesh, contact_point: ArrayLike | None = None, half_width: float | None = None
) -> Quality:
    """Quality of a mesh, and of its facets within `half_width` (m) of `contact_point` (2,), m.

    Raises
    ------
    InputError
        If the half-width is not positive; NaN included.
    """
    edges = 0.0
    if contact_point is not None and half_width is not None:
        positive("half_width", half_width, "m")
        edges = half_width / longest_facet(mesh, contact_point, half_width)
    return Quality(
        min_angle_deg=float(np.degrees(corner_angles(mesh).min())),
        min_scaled_jacobian=float(scaled_jacobians(mesh).min()),
        edges_across_half_width=edges,
        elements=mesh.triangles.shape[1],
        nodes=mesh.points.shape[1],
    )


def corner_angles(mesh: BodyMesh) -> Array:
    """Corner angles between the curved edges, (3, m), rad."""
    sides = np.array([[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]])  # along edges 01, 12, 20
    angles = []
    for k, (xi, eta) in enumerate(_NODES[:3]):
        jacobian = mesh.jacobian(xi, eta)
        forth, back = jacobian @ sides[k], -jacobian @ sides[k - 1]
        cross = forth[:, 0] * back[:, 1] - forth[:, 1] * back[:, 0]
        angles.append(np.arctan2(cross, (forth * back).sum(axis=1)))
    return np.array(angles)


def scaled_jacobians(mesh: BodyMesh) -> Array:
    """Scaled Jacobian at the nodes of every triangle, (6, m).

    Jacobian determinant over the product of the two longer edge vectors at the node, 1 for the
    equilateral triangle.

    References
    ----------
    Knupp, SIAM J. Sci. Comput. 22 (2000) 193-218.
    """
    values = []
    for xi, eta in _NODES:
        jacobian = mesh.jacobian(xi, eta)
        lengths = np.hypot(
            *np.stack(
                [jacobian[..., 0], jacobian[..., 1], jacobian[..., 1] - jacobian[..., 0]]
            ).transpose(2, 0, 1)
        )
        lengths.sort(axis=0)
        values.append(_EQUILATERAL * np.linalg.det(jacobian) / (lengths[1] * lengths[2]))
    return np.array(values)


def longest_facet(mesh: BodyMesh, contact_point: ArrayLike, half_width: float) -> float:
    """Length, m, of the longest boundary facet that overlaps the contact, or of the nearest one.

    Parameters
    ----------
    contact_point : array (2,)   centre of the contact, m
    half_width : float           of the contact, m
    """
    point = finite("contact_point", contact_point)
    triples = np.hstack(list(mesh.boundaries.values()))
    start, end, middle = (mesh.points[:, row] for row in triples)
    length = np.hypot(*(middle - start)) + np.hypot(*(end - middle))
    distance = np.hypot(*(middle - point[:, None])) - 0.5 * length
    inside = distance < max(half_width * (1 - 1e-9), float(distance.min()) * (1 + 1e-9))
    return float(length[inside].max())


def gate(
    measured: Quality,
    *,
    angle_min_deg: float = LEAST_ANGLE_DEG,
    scaled_jacobian_min: float = LEAST_SCALED_JACOBIAN,
    edges_min: float = 0.0,
) -> Quality:
    """The mesh quality itself, if it is within its limits.

    Parameters
    ----------
    measured : Quality            of the mesh
    angle_min_deg : float         least angle of a triangle, deg
    scaled_jacobian_min : float   least scaled Jacobian
    edges_min : float             least edges across the half-width of the contact, of which
        `FACET_SHARE` is required

    Raises
    ------
    MeshError
        If a figure is below its limit; NaN included.
    """
    limits = (
        ("min_angle_deg", measured.min_angle_deg, angle_min_deg),
        ("min_scaled_jacobian", measured.min_scaled_jacobian, scaled_jacobian_min),
        ("edges_across_half_width", measured.edges_across_half_width, FACET_SHARE * edges_min),
    )
    for name, value, limit in limits:
        if not value >= limit:
            raise MeshError(f"mesh.{name} = {value:.4g}, must be >= {limit:.4g}")
    return measured
