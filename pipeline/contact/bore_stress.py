"""Stress at the bore and the keyway of the cam over the turn.

The shaft is rigid and fills the bore: the bore is held. At the edges of the keyway in the bore,
held and free surface meet; the exact stress is singular there and that of a mesh grows with
refinement. These places are included and marked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.contact.body_compliance import LoadedBody
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import StressRecovery
from camwright.pipeline.contact.elasticity.halfplane import point_force_stress

_BATCH = 90


@dataclass(frozen=True, eq=False)
class BoreStress:
    """Maximum von Mises stress (n,), Pa, on bore and keyway, and its place.

    x, y (n,) m in the cam frame; at_edge (n,) 1 where the place is an edge of the keyway at the
    bore, else 0; away_from_edges (n,) Pa, the maximum elsewhere; excluded m, the distance from an
    edge up to which a place counts as at the edge, 0 without a keyway.
    """

    von_mises: Array
    x: Array
    y: Array
    at_edge: Array
    away_from_edges: Array
    excluded: float = 0.0

    def __post_init__(self) -> None:
        names = ("von_mises", "x", "y", "at_edge", "away_from_edges")
        freeze(self, **{name: getattr(self, name) for name in names})


def bore_stress(
    cam: LoadedBody,
    contacts: Array,
    normals: Array,
    line_load: Array,
    *,
    excluded: float | None = None,
) -> BoreStress:
    """Stress of bore and keyway under contacts at points (2, n), m, with outward normals (2, n).

    line_load (n,) N/m acts as a line force: the bore lies many half-widths below the contact. The
    radius excluded at the keyway edges, m, is by default 1.5 elements.
    """
    nodes, by_edge, recovery, excluded = _holes(cam, excluded)
    rows = _rows(recovery, nodes)
    points = cam.body.mesh.points[:, nodes]
    measured = np.empty((nodes.size, contacts.shape[1]))
    for start in range(0, contacts.shape[1], _BATCH):
        part = slice(start, start + _BATCH)
        own = recovery(cam.correction_displacement(contacts[:, part], normals[:, part]))[:, rows]
        far = _half_plane(points, contacts[:, part], normals[:, part])
        measured[:, part] = plane_stress_measures.von_mises(
            (own + far) * line_load[part], cam.body.poisson
        )
    worst = measured.argmax(axis=0)
    regular = measured[~by_edge].max(axis=0)
    return BoreStress(
        von_mises=measured.max(axis=0),
        x=points[0, worst],
        y=points[1, worst],
        at_edge=by_edge[worst].astype(float),
        away_from_edges=regular,
        excluded=excluded,
    )


def _holes(
    cam: LoadedBody, excluded: float | None
) -> tuple[NDArray[np.int64], NDArray[np.bool_], StressRecovery, float]:
    """Nodes (m,) of bore and keyway, those at an edge (m,), stress recovery, edge distance in m."""
    mesh = cam.body.mesh
    bore = mesh.boundary_nodes("bore")
    nodes, by_edge, near = bore, np.zeros(bore.size, dtype=bool), 0.0
    if "keyway" in mesh.boundaries:
        keyway = mesh.boundary_nodes("keyway")
        nodes = np.union1d(bore, keyway)
        edges = mesh.points[:, np.intersect1d(bore, keyway)]
        start, end, _ = mesh.facet_triples("keyway")
        length = float(np.hypot(*(mesh.points[:, end] - mesh.points[:, start])).max())
        near = 1.5 * length if excluded is None else excluded
        arm = mesh.points[:, nodes, None] - edges[:, None, :]
        by_edge = (np.hypot(*arm) < near).any(axis=1)
    held = np.zeros(mesh.points.shape[1], dtype=bool)
    held[nodes] = True
    return (
        nodes,
        by_edge,
        StressRecovery(cam.body, np.flatnonzero(held[mesh.triangles].any(axis=0))),
        near,
    )


def _half_plane(points: Array, contacts: Array, normals: Array) -> Array:
    """Half-plane stress (3, m, k) at points (2, m) under unit line forces, in the body frame."""
    arm = points[:, :, None] - contacts[:, None, :]
    t, n = np.stack([normals[1], -normals[0]]), normals
    x, depth = np.einsum("cmk,ck->mk", arm, t), -np.einsum("cmk,ck->mk", arm, n)
    along, into, shear = point_force_stress(x, depth)
    return np.stack(
        [
            along * t[0] ** 2 + into * n[0] ** 2 - 2 * shear * t[0] * n[0],
            along * t[1] ** 2 + into * n[1] ** 2 - 2 * shear * t[1] * n[1],
            along * t[0] * t[1] + into * n[0] * n[1] - shear * (t[0] * n[1] + t[1] * n[0]),
        ]
    )


def _rows(recovery: StressRecovery, nodes: NDArray[np.int64]) -> NDArray[np.intp]:
    order = np.argsort(recovery.nodes)
    return order[np.searchsorted(recovery.nodes, nodes, sorter=order)]
