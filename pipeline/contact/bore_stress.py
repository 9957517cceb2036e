"""Stress at the bore and the keyway of the cam over the turn.

The shaft is rigid and fills the bore: the bore is held. At the edges of the keyway in the bore,
held and free surface meet; the exact stress is singular there and that of a mesh grows with
refinement. These places are included and marked.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.contact.body_compliance import RECIPE, LoadedBody
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import StressRecovery
from camwright.pipeline.contact.elasticity.halfplane import point_force_stress


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
    kept = cam.kept(
        "bore",
        contacts,
        normals,
        lambda: _under_unit_load(cam, contacts, normals, excluded),
        (sys.modules[__name__], plane_stress_measures, *RECIPE),
        excluded,
    )
    points = cam.body.mesh.points
    # Without load every place is the first one.
    worst = kept["node"][np.where(line_load > 0, kept["worst"], 0)]
    return BoreStress(
        von_mises=line_load * kept["von_mises"],
        x=points[0, worst],
        y=points[1, worst],
        at_edge=np.isin(worst, kept["node"][kept["by_edge"]]).astype(float),
        away_from_edges=line_load * kept["away_from_edges"],
        excluded=float(kept["excluded"]),
    )


def _under_unit_load(
    cam: LoadedBody, contacts: Array, normals: Array, excluded: float | None
) -> dict[str, Array]:
    """Values of `BoreStress` per unit line load, with the nodes (m,) and which are at an edge."""
    nodes, by_edge, recovery, excluded = _holes(cam, excluded)
    stress = recovery.operator(nodes).reshape(3 * nodes.size, -1)
    seen = np.searchsorted(cam.condensed_nodes, recovery.nodes)
    points, count = cam.body.mesh.points[:, nodes], contacts.shape[1]
    highest, regular, worst = np.empty(count), np.empty(count), np.empty(count, dtype=int)
    for part, displaced in cam.displacements(contacts, normals):
        own = stress @ displaced[:, seen].reshape(stress.shape[1], -1)
        far = _half_plane(points, contacts[:, part], normals[:, part])
        mises = plane_stress_measures.von_mises(own.reshape(far.shape) + far, cam.body.poisson)
        worst[part], highest[part] = mises.argmax(axis=0), mises.max(axis=0)
        regular[part] = mises[~by_edge].max(axis=0)
    return {
        "von_mises": highest,
        "away_from_edges": regular,
        "worst": worst,
        "node": nodes,
        "by_edge": by_edge,
        "excluded": np.array(excluded),
    }


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
