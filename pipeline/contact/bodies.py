"""What a real body adds to the half-plane under a contact load.

The field of a loaded body is the half-plane's field under the same pressure plus a correction
that cancels the half-plane's tractions on the real boundary and its displacements where the
body is held. The correction is smooth right up to the contact (on a circle of radius R the
tractions of a point force vanish there), so one coarse mesh, factored once, gives it for the
contact at every angle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from geometry.arrays import Array, freeze
from pipeline.contact.elastic_body import ElasticBody, StressRecovery
from pipeline.contact.halfplane import point_force_displacement
from pipeline.contact.hertz import subsurface_stress

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
_BLIND_SHARE = 0.05
# Right-hand sides solved together: enough to keep SuperLU busy, few enough to stay small.
_BATCH = 180


@dataclass(frozen=True, eq=False)
class Correction:
    """Correction field of a body per unit line load, at `count` contact points.

    displacement (2, nodes, count) m per N/m; stress (3, count) in the contact's own frame
    (along the surface, into the body, shear of both), Pa per N/m; bend (count,) second
    derivative of the outward displacement along the surface, 1/m per N/m.
    """

    displacement: Array
    stress: Array
    bend: Array

    def __post_init__(self) -> None:
        freeze(self, **{n: getattr(self, n) for n in ("displacement", "stress", "bend")})


@dataclass(frozen=True, eq=False)
class LoadedBody:
    """A body with a free surface that carries the contact, and other free boundaries."""

    body: ElasticBody
    surface: str
    also_free: tuple[str, ...] = ()

    @cached_property
    def _free_facets(self) -> Array:
        mesh = self.body.mesh
        return np.hstack([mesh.facet_triples(n) for n in (self.surface, *self.also_free)])

    @cached_property
    def _quadrature(self) -> tuple[Array, Array, Any]:
        """Points (2, q), outward normals times weights (2, q), shape values (nodes, q)."""
        triples = self._free_facets
        corners = self.body.mesh.points[:, triples]
        s = (1 + _GAUSS_POINTS) / 2
        shapes = np.stack([(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)])
        slopes = np.stack([4 * s - 3, 4 * s - 1, 4 - 8 * s])
        points = np.einsum("ckf,kq->cfq", corners, shapes)
        tangents = np.einsum("ckf,kq->cfq", corners, slopes)
        # The body lies on the left of a facet, so the outward normal is on its right.
        outward = np.stack([tangents[1], -tangents[0]]) * (_GAUSS_WEIGHTS / 2)
        facets, per_facet = triples.shape[1], s.size
        columns = np.arange(facets * per_facet).reshape(facets, per_facet)
        rows = np.broadcast_to(triples[:, :, None], (3, facets, per_facet))
        values = np.broadcast_to(shapes[:, None, :], rows.shape)
        columns = np.broadcast_to(columns, rows.shape)
        entries: Any = (values.ravel(), (rows.ravel(), columns.ravel()))
        shape = (self.body.mesh.points.shape[1], facets * per_facet)
        operator = sparse.coo_array(entries, shape=shape).tocsr()
        return points.reshape(2, -1), outward.reshape(2, -1), operator

    @cached_property
    def _facet_length(self) -> float:
        start, end, _ = self.body.mesh.facet_triples(self.surface)
        steps = self.body.mesh.points[:, end] - self.body.mesh.points[:, start]
        return float(np.hypot(*steps).max())

    def correction(self, contacts: Array, normals: Array) -> Correction:
        """Correction at contact points (2, count) with outward normals (2, count)."""
        parts = [
            self._correction(contacts[:, k : k + _BATCH], normals[:, k : k + _BATCH])
            for k in range(0, contacts.shape[1], _BATCH)
        ]
        return Correction(
            displacement=np.concatenate([p.displacement for p in parts], axis=2),
            stress=np.concatenate([p.stress for p in parts], axis=1),
            bend=np.concatenate([p.bend for p in parts]),
        )

    def field(
        self, contact: Array, normal: Array, line_load: float, half_width: float
    ) -> tuple[Array, Array]:
        """Displacement (2, nodes) m and stress (3, nodes) Pa of the body under one contact.

        contact, normal (2, 1); the half-plane part is that of a Hertz pressure, in closed form.
        """
        moved = self.correction(contact, normal).displacement
        nodal = np.zeros((3, self.body.mesh.points.shape[1]))
        nodal[:, self._everywhere.nodes] = self._everywhere(moved)[:, :, 0]
        if line_load <= 0:
            return np.zeros_like(moved[:, :, 0]), np.zeros_like(nodal)
        tangent = np.array([normal[1, 0], -normal[0, 0]])
        arm = self.body.mesh.points - contact
        x, depth = tangent @ arm, -normal[:, 0] @ arm
        # A hollow flank rises above the tangent: its points take the stress of the surface.
        near = subsurface_stress(x / half_width, np.maximum(depth, 0.0) / half_width)
        along, into, shear = near * (2 / (np.pi * half_width))
        t, n = tangent[:, None], normal
        half_plane = np.stack(
            [
                along * t[0] ** 2 + into * n[0] ** 2 - 2 * shear * t[0] * n[0],
                along * t[1] ** 2 + into * n[1] ** 2 - 2 * shear * t[1] * n[1],
                along * t[0] * t[1] + into * n[0] * n[1] - shear * (t[0] * n[1] + t[1] * n[0]),
            ]
        )
        # The logarithm of a point force stops where its pressure spreads out.
        deep = np.where(np.hypot(x, depth) < half_width, half_width, depth)
        sideways, down = self._unit_displacement(x, deep)
        settled = sideways * t - down * n
        return line_load * (moved[:, :, 0] + settled), line_load * (nodal + half_plane)

    @cached_property
    def _everywhere(self) -> StressRecovery:
        return StressRecovery(self.body, np.arange(self.body.mesh.triangles.shape[1]))

    def _unit_displacement(self, x: Array, depth: Array) -> Array:
        modulus = self.body.modulus / (1 - self.body.poisson**2)
        return point_force_displacement(x, depth, self.body.poisson) / modulus

    def _correction(self, contacts: Array, normals: Array) -> Correction:
        points, outward, operator = self._quadrature
        arm = points[:, :, None] - contacts[:, None, :]
        depth = -np.einsum("cqk,ck->qk", arm, normals)
        square = (arm**2).sum(axis=0)
        flux = np.einsum("cqk,cq->qk", arm, outward)
        # Towards the contact the traction vanishes like its distance; nearer than this it is
        # less than the round-off in the depth of a boundary that runs along the tangent.
        near = square < (_BLIND_SHARE * self._facet_length) ** 2
        intensity = np.where(near, 0.0, 2 / np.pi * depth * flux / np.where(near, 1, square) ** 2)
        traction = arm * intensity
        loads = np.stack([operator @ component for component in traction])
        held = self._half_plane_displacement(contacts, normals)
        displacement = self.body.displacement(loads, -held)
        stress = self._stress_at(displacement, contacts, normals)
        return Correction(displacement, stress, self._bend(displacement, contacts, normals))

    def _half_plane_displacement(self, contacts: Array, normals: Array) -> Array:
        """Displacement (2, nodes, count) of the half-plane field on the held boundary."""
        mesh, body = self.body.mesh, self.body
        nodes = mesh.boundary_nodes(body.held)
        arm = mesh.points[:, nodes, None] - contacts[:, None, :]
        tangents = np.stack([normals[1], -normals[0]])
        x = np.einsum("cqk,ck->qk", arm, tangents)
        depth = -np.einsum("cqk,ck->qk", arm, normals)
        along, into = self._unit_displacement(x, depth)
        field = np.zeros((2, mesh.points.shape[1], contacts.shape[1]))
        field[:, nodes] = along * tangents[:, None, :] - into * normals[:, None, :]
        return field

    @cached_property
    def _recovery(self) -> StressRecovery:
        triples = self.body.mesh.facet_triples(self.surface)
        on_surface = np.zeros(self.body.mesh.points.shape[1], dtype=bool)
        on_surface[triples] = True
        touching = on_surface[self.body.mesh.triangles[:3]].any(axis=0)
        return StressRecovery(self.body, np.flatnonzero(touching))

    @cached_property
    def _surface_nodes(self) -> Array:
        return np.unique(self.body.mesh.facet_triples(self.surface))

    def _nearest(self, contacts: Array, count: int) -> Array:
        """The `count` surface nodes nearest to each contact (count, contacts)."""
        surface = self.body.mesh.points[:, self._surface_nodes]
        distance = np.hypot(*(surface[:, :, None] - contacts[:, None, :]))
        return self._surface_nodes[np.argpartition(distance, count, axis=0)[:count]]

    def _stress_at(self, displacement: Array, contacts: Array, normals: Array) -> Array:
        """Recovered stress (3, count) at the contacts, fitted along the surface nodes."""
        nodal = self._recovery(displacement)
        row = np.full(self.body.mesh.points.shape[1], -1)
        row[self._recovery.nodes] = np.arange(self._recovery.nodes.size)
        near = self._nearest(contacts, 7)
        column = np.arange(contacts.shape[1])
        values = nodal[:, row[near], column]
        fitted = self._fit(near, contacts, normals, values)[:, 0]
        xx, yy, xy = fitted
        t, n = np.stack([normals[1], -normals[0]]), normals
        along = xx * t[0] ** 2 + yy * t[1] ** 2 + 2 * xy * t[0] * t[1]
        into = xx * n[0] ** 2 + yy * n[1] ** 2 + 2 * xy * n[0] * n[1]
        shear = -(xx * t[0] * n[0] + yy * t[1] * n[1] + xy * (t[0] * n[1] + t[1] * n[0]))
        return np.stack([along, into, shear])

    def _bend(self, displacement: Array, contacts: Array, normals: Array) -> Array:
        near = self._nearest(contacts, 7)
        column = np.arange(contacts.shape[1])
        outward = np.einsum("cmk,ck->mk", displacement[:, near, column], normals)
        return 2 * self._fit(near, contacts, normals, outward[None])[0, 2]

    def _fit(self, near: Array, contacts: Array, normals: Array, values: Array) -> Array:
        """Quadratics along the tangent (values, 3, count) through values at nearby nodes."""
        arm = self.body.mesh.points[:, near] - contacts[:, None, :]
        x = arm[0] * normals[1] - arm[1] * normals[0]
        scale = np.abs(x).max(axis=0)
        terms = np.stack([np.ones_like(x), x / scale, (x / scale) ** 2], axis=-1)
        inverse = np.linalg.pinv(terms.transpose(1, 0, 2))
        powers = np.stack([np.ones_like(scale), 1 / scale, 1 / scale**2])
        return np.einsum("kij,vjk->vik", inverse, values) * powers
