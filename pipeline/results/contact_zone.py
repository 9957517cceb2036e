"""Fine mesh of a body below its contact, with fields at every cam angle.

A half-disc about the contact whose inner part scales with the half-width. The correction of the
body is interpolated from its coarse mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import scipy

from camwright.geometry.arrays import Array, readonly
from camwright.meshes.gmsh_mesher import Index
from camwright.pipeline.contact.body_compliance import LoadedBody
from camwright.pipeline.contact.contact_patch import contact_patch

MIDDLE = 0
"""Node at the contact itself."""

# Rings from the contact: equal ones, in half-widths, that pass the depth of the maximum von Mises
# stress, and a geometric series up to the edge of the zone.
_RING_SPACING, _EQUAL_RINGS, _OUTER_RINGS = 0.07, 25, 7
_SECTORS = 32
# Radius of the zone: at least these multiples of the longest element edge at the surface, so that
# the elements about the contact lie within it, and of the half-width.
_ZONE_EDGES, _ZONE_HALF_WIDTHS = 1.6, 5.2
# The stress of the contact patch fades into that of the body between these radii, in half-widths.
_PATCH_ALONE, _PATCH_END = 1.2, 1.5
_WALL = 0.98  # radius of the zone over the distance to the next boundary, at most
# Depth below the surface at which its correction is read, over the element edge.
_BELOW = 0.04


@lru_cache(maxsize=1)
def zone_triangles() -> Index:
    """Triangles (3, t) of node indices of the mesh of a zone below a contact, which all zones
    share; node 0 is the contact, then rings of `_SECTORS` + 1 nodes.
    """
    ring = _SECTORS + 1
    first = 1 + np.arange(_SECTORS)
    core = np.stack([np.zeros_like(first), first + 1, first])
    here = 1 + ring * np.arange(_EQUAL_RINGS + _OUTER_RINGS - 1)[:, None] + np.arange(_SECTORS)
    inner, outer = here.ravel(), here.ravel() + ring
    split = [np.stack([inner, inner + 1, outer]), np.stack([inner + 1, outer + 1, outer])]
    return np.hstack([core, *split]).astype(np.int64)


def zone_nodes() -> int:
    """Number of nodes of the zone."""
    return 1 + (_SECTORS + 1) * (_EQUAL_RINGS + _OUTER_RINGS)


@dataclass(frozen=True, eq=False)
class ZoneSite:
    """Interface of a body with contacts on its surface, for the zones below them."""

    body: LoadedBody

    @cached_property
    def _edge(self) -> float:
        """Longest edge, m, of the elements of the body that touch its surface."""
        mesh = self.body.body.mesh
        surface = mesh.boundary_nodes(self.body.surface)
        near = mesh.triangles[:3, np.isin(mesh.triangles[:3], surface).any(axis=0)]
        corners = mesh.points[:, near]
        return float(np.hypot(*(corners - np.roll(corners, 1, axis=1))).max())

    @cached_property
    def _nodes(self) -> scipy.spatial.Delaunay:
        return scipy.spatial.Delaunay(self.body.body.mesh.points.T)

    def radius(self, contacts: Array, half_width: Array) -> Array:
        """Radius (k,), m, of the zones of fine mesh below k contacts.

        A zone ends before the next boundary of the body, unless the contact is as wide as the wall.

        Parameters
        ----------
        contacts : array (2, c)   points of contact, m, c = 1 or k
        half_width : array (k,)   of the contacts, m
        """
        mesh = self.body.body.mesh
        others = [n for name, n in mesh.boundaries.items() if name != self.body.surface]
        far = mesh.points[:, np.unique(np.concatenate([n.ravel() for n in others]))]
        wall = _WALL * np.asarray(scipy.spatial.cKDTree(far.T).query(contacts.T)[0])
        wanted = np.maximum(_ZONE_EDGES * self._edge, _ZONE_HALF_WIDTHS * half_width)
        return np.maximum(np.minimum(wanted, wall), 1.1 * _RING_SPACING * _EQUAL_RINGS * half_width)

    def interpolated(
        self, correction: tuple[Array, Array], points: Array, normals: Array
    ) -> tuple[Array, Array]:
        """Displacement (2, m, k) and stress (3, m, k) of the correction at points of the zones.

        Linear between the nodes; read a little below the surface, which the elements cut off.

        Parameters
        ----------
        correction : (2, nodes, c), (3, nodes, c)   see `LoadedBody.correction_fields`
        points : (2, m, k)                          m
        normals : (2, c)                            of the surface at the contacts; c is 1 or k
        """
        fields = np.concatenate(correction)
        inward = points - _BELOW * self._edge * normals[:, None]
        at = inward.reshape(2, -1).T
        simplex = self._nodes.find_simplex(at)
        affine = self._nodes.transform[simplex]
        two = np.einsum("nij,nj->ni", affine[:, :2], at - affine[:, 2])
        shares = np.column_stack([two, 1 - two.sum(axis=1)])
        corners = self._nodes.simplices[simplex]
        lost = np.flatnonzero(simplex < 0)
        if lost.size:
            _, nearest = scipy.spatial.cKDTree(self._nodes.points).query(at[lost])
            corners[lost], shares[lost] = np.asarray(nearest)[:, None], 1 / 3
        column = np.zeros(1, dtype=int)
        if normals.shape[1] > 1:
            column = np.tile(np.arange(points.shape[2]), points.shape[1])[:, None]
        values = np.einsum("cni,ni->cn", fields[:, corners, column], shares)
        result = values.reshape(-1, *points.shape[1:])
        return result[:2], result[2:]


def zone_places(half_width: Array, radius: Array) -> Array:
    """Node positions (2, m, k), m, of k zones below contacts: along the surface, then depth.

    Parameters
    ----------
    half_width : array (k,)   of the contacts, m; zero without contact
    radius : array (k,)       of the zones, m
    """
    size = np.where(half_width > 0, half_width, radius / 16)
    inner = _RING_SPACING * np.arange(1, _EQUAL_RINGS + 1)
    share = np.arange(1, _OUTER_RINGS + 1)[:, None] / _OUTER_RINGS
    rings = size * np.concatenate(
        [np.repeat(inner[:, None], size.size, axis=1),
         inner[-1] * (radius / (inner[-1] * size)) ** share]
    )  # fmt: skip
    angle = np.linspace(0.0, np.pi, _SECTORS + 1)
    # The surface itself has no depth, not one of round-off.
    turned = np.stack(
        [np.cos(angle), np.where(np.arange(_SECTORS + 1) % _SECTORS, np.sin(angle), 0.0)]
    )
    places = rings[None, :, None, :] * turned[:, None, :, None]
    return np.concatenate([np.zeros((2, 1, size.size)), places.reshape(2, -1, size.size)], axis=1)


@lru_cache(maxsize=8)
def patch_weights(poisson: float) -> tuple[Index, Array, Array]:
    """Interpolation of stresses from the contact patch, of a body of Poisson's ratio `poisson`, to
    the inner nodes of a zone, and the weight of the patch there.

    Returns
    -------
    corners : array (3, i)   points of the patch about each node
    shares : array (3, i)    their weights
    blend : array (m,)       weight of the patch at all nodes of the zone, 1 below the contact; the
                             first i nodes alone have any
    """
    patch = contact_patch(poisson).points
    unit = zone_places(np.ones(1), np.full(1, _ZONE_HALF_WIDTHS))[:, :, 0]
    radius = np.hypot(*unit)
    blend = np.clip((_PATCH_END - radius) / (_PATCH_END - _PATCH_ALONE), 0.0, 1.0)
    inner = unit[:, blend > 0]
    mesh = scipy.spatial.Delaunay(patch.T)
    # Just inside, for the nodes on the surface, which is the edge of the patch.
    simplex = mesh.find_simplex(np.maximum(inner, [[-np.inf], [1e-12]]).T)
    affine = mesh.transform[simplex]
    two = np.einsum("nij,nj->ni", affine[:, :2], inner.T - affine[:, 2])
    shares = np.column_stack([two, 1 - two.sum(axis=1)]).T
    return mesh.simplices[simplex].T.astype(np.int64), readonly(shares), readonly(blend)
