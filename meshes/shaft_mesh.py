"""Meshes of a cam on its shaft, the nodes of bore and shaft at the same places."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.cutouts import KeywayLike
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.cam_outline import (
    ContourLike,
    cam_size,
    contour_piece,
    finer_at_fillets,
    hole_pieces,
    trace,
)
from camwright.meshes.element_size import ElementSize
from camwright.meshes.gmsh_mesher import Index, triangulate
from camwright.meshes.outline import Facets, arc, facets

_PER_FILLET, _AROUND_FILLET = 8.0, 1.5  # element edges along the root; reach, in its radii
_BESIDE_EDGE = 1.0 / 20.0  # element length at the edges of the keyway in the bore, over its width


class CamOnShaft(NamedTuple):
    """Meshes of cam and solid shaft, with the facing nodes (n,) of bore and shaft."""

    cam: BodyMesh
    shaft: BodyMesh
    of_bore: Index
    of_shaft: Index


def cam_on_shaft(
    contour: ContourLike,
    bore_radius: float,
    keyway: KeywayLike | None,
    sizing: ElementSize,
    refinement: float = 1.0,
) -> CamOnShaft:
    """Plane meshes of a cam and of the solid shaft in its bore, for their press fit: each node
    of the bore has one of the shaft at its place. The shaft itself has no keyway.

    Parameters
    ----------
    contour : ContourLike           of the cam, m, in its own axes
    bore_radius : float             m, bore centred on the origin
    keyway : KeywayLike or None     with its fillets
    sizing : ElementSize
    refinement : float              divides the element size everywhere

    Raises
    ------
    InputError
        If a dimension is out of bounds.
    GeometryError
        If the contour is undercut, or bore or keyway reaches it.
    MeshError
        If a region cannot be meshed.
    """
    hole, path = hole_pieces(bore_radius, keyway), trace(contour)
    size = cam_size(path, bore_radius, keyway, sizing)
    if keyway is not None:  # the pressure of the fit is singular at the edges of its mouth
        size = finer_at_fillets(size, bore_radius, keyway, _PER_FILLET, _AROUND_FILLET)
        mouth = float(np.arcsin(0.5 * keyway.width / bore_radius))
        for side in (-mouth, mouth):
            at = keyway.angle + side
            edge = bore_radius * np.array([np.cos(at), np.sin(at)])
            size = size.with_spot(edge, _BESIDE_EDGE * keyway.width, 0.0)
    size = size.refined(refinement)
    inner = [facets(piece, size) for piece in hole]
    cam = triangulate([[facets(contour_piece(path, sizing), size)], inner], size)
    bore = inner[0]  # clockwise: backwards along the shaft
    seat = [Facets("seat", bore.ends[:, ::-1], bore.middles[:, ::-1])]
    if keyway is not None:
        seat.append(facets(arc("mouth", bore_radius, keyway.angle - mouth, keyway.angle + mouth),
                           size))  # fmt: skip
    shaft = triangulate([seat], size)
    of_cam, of_shaft = (
        BodyMesh(each.points, each.triangles, each.boundaries) for each in (cam, shaft)
    )
    return CamOnShaft(of_cam, of_shaft, _in_order(of_cam, "bore"), _in_order(of_shaft, "seat"))


def _in_order(mesh: BodyMesh, name: str) -> Index:
    """Nodes (n,) of the boundary `name`, arcs about the origin, in the order of their
    polar angle.
    """
    nodes = mesh.boundary_nodes(name)
    angle = np.arctan2(*mesh.points[::-1, nodes]) % FULL_TURN
    # the node at zero, or a hair below it, comes first on both bodies
    order = np.argsort(np.where(angle > FULL_TURN - 1e-9, 0.0, angle))
    return np.asarray(nodes[order])
