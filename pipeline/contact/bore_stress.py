"""Stress at the bore and the keyway of the cam over the turn.

The shaft is rigid and fills the bore: the bore is held. At the edges of the keyway in the bore,
held and free surface meet, and the corners of its floor are meshed without their fillet; the exact
stress is singular at both and that of a mesh grows with refinement. These places are included and
marked. The stress at the fillet of the floor is that of the check `keyway_root`.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.meshes.body_mesh import BodyMesh, facet_shapes
from camwright.pipeline.contact.body_compliance import RECIPE, LoadedBody
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import StressRecovery
from camwright.pipeline.contact.elasticity.halfplane import point_force_stress

_SHARP = np.deg2rad(45.0)
"""Least turn of the boundary at a corner: the edges of a meshed fillet turn by half as much."""


@dataclass(frozen=True, eq=False)
class BoreStress:
    """Maximum von Mises stress (n,), Pa, on bore and keyway, and its location.

    x, y (n,) m in the cam frame; at_edge (n,) 1 where the place is an edge of the keyway, in the
    bore or at its floor, else 0; away_from_edges (n,) Pa, the maximum elsewhere; excluded m, the
    distance from an edge up to which a place counts as at the edge, 0 without a keyway.
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

    def where(self, at: NDArray[np.bool_], other: BoreStress) -> BoreStress:
        """This stress with that of another bore at some angles: `at` (n,), and its k values."""

        def chosen(name: str) -> Array:
            values = np.array(getattr(self, name))
            values[at] = getattr(other, name)
            return values

        return BoreStress(
            von_mises=chosen("von_mises"),
            x=chosen("x"),
            y=chosen("y"),
            at_edge=chosen("at_edge"),
            away_from_edges=chosen("away_from_edges"),
            excluded=self.excluded,
        )


def bore_stress(
    cam: LoadedBody,
    contacts: Array,
    normals: Array,
    line_load: Array,
    *,
    excluded: float | None = None,
) -> BoreStress:
    """Stress of bore and keyway under contacts at points (2, n), m, outward normals (2, n).

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
    # Without load every place is the first one.
    worst = np.where(line_load > 0, kept["worst"], 0)
    return BoreStress(
        von_mises=line_load * kept["von_mises"],
        x=kept["place"][0, worst],
        y=kept["place"][1, worst],
        at_edge=kept["by_edge"][worst].astype(float),
        away_from_edges=line_load * kept["away_from_edges"],
        excluded=float(kept["excluded"]),
    )


def _under_unit_load(
    cam: LoadedBody, contacts: Array, normals: Array, excluded: float | None
) -> dict[str, Array]:
    """Fields of `BoreStress` by name under a unit line load at each contact, 1/m, with the places
    (2, p), m, the number of the worst place (count,), and which places are within a zone about an
    edge (p,).

    Places are the nodes of bore and keyway and the rims of the excluded zones: towards an edge the
    stress rises, so that its maximum outside would follow the distance of the next node.

    Parameters
    ----------
    contacts, normals : array (2, count)   points of the contour, m; outward normals
    excluded : float or None               radius of the zones, m; None: by the element size
    """
    nodes, recovery = _held(cam)
    mesh = cam.body.mesh
    zones = _zones(mesh, nodes, excluded)
    of_nodes = recovery.operator(nodes).reshape(3, nodes.size, -1)
    rims = np.einsum("rk,ckd->crd", zones.rims, of_nodes)
    operator = np.concatenate([of_nodes, rims], axis=1)
    stress = operator.reshape(-1, operator.shape[2])
    places = mesh.points[:, nodes]
    places = np.concatenate([places, places @ zones.rims.T], axis=1)
    by_edge = np.append(zones.by_edge, np.zeros(len(zones.rims), dtype=bool))
    seen = np.searchsorted(cam.condensed_nodes, recovery.nodes)
    count = contacts.shape[1]
    highest, regular, worst = np.empty(count), np.empty(count), np.empty(count, dtype=int)
    for part, displaced in cam.displacements(contacts, normals):
        own = stress @ displaced[:, seen].reshape(stress.shape[1], -1)
        far = _half_plane(places, contacts[:, part], normals[:, part])
        mises = plane_stress_measures.von_mises(own.reshape(far.shape) + far, cam.body.poisson)
        worst[part], highest[part] = mises.argmax(axis=0), mises.max(axis=0)
        regular[part] = mises[~by_edge].max(axis=0)
    return {
        "von_mises": highest,
        "away_from_edges": regular,
        "worst": worst,
        "place": places,
        "by_edge": by_edge,
        "excluded": np.array(zones.radius),
    }


class _Zones(NamedTuple):
    """Excluded zones at the keyway edges: radius m, nodes within (m,), weights of rims (r, m)."""

    radius: float
    by_edge: NDArray[np.bool_]
    rims: Array


def _held(cam: LoadedBody) -> tuple[NDArray[np.int64], StressRecovery]:
    """Nodes (m,) of bore and keyway and the stress recovery of the elements at them."""
    mesh = cam.body.mesh
    names = [name for name in ("bore", "keyway") if name in mesh.boundaries]
    nodes = np.unique(np.concatenate([mesh.boundary_nodes(name) for name in names]))
    held = np.zeros(mesh.points.shape[1], dtype=bool)
    held[nodes] = True
    return nodes, StressRecovery(cam.body, np.flatnonzero(held[mesh.triangles].any(axis=0)))


def _zones(mesh: BodyMesh, nodes: NDArray[np.int64], excluded: float | None) -> _Zones:
    """Zones about the edges of the keyway, in which the stress is singular; none without a keyway.

    A rim lies on the boundary where its distance from the edge is the radius; the weights are those
    of the quadratic shapes of its facet.

    Parameters
    ----------
    nodes : array (m,)         numbers of the nodes of bore and keyway
    excluded : float or None   radius of the zones, m; None: 1.5 times the longest facet of the
        keyway
    """
    if "keyway" not in mesh.boundaries:
        return _Zones(0.0, np.zeros(nodes.size, dtype=bool), np.zeros((0, nodes.size)))
    facets = mesh.facet_triples("keyway")
    ends = mesh.points[:, facets]
    if excluded is None:
        excluded = 1.5 * float(np.hypot(*(ends[:, 1] - ends[:, 0])).max())
    facets = np.concatenate([mesh.facet_triples("bore"), facets], axis=1)
    within = np.zeros(nodes.size, dtype=bool)
    rims = []
    for corner in mesh.points[:, _edges(mesh)].T:
        away = np.hypot(*(mesh.points - corner[:, None])) - excluded
        within |= away[nodes] < 0
        for facet in facets[:, away[facets[0]] * away[facets[1]] < 0].T:
            arm = mesh.points[:, facet] - corner[:, None]
            at = scipy.optimize.brentq(
                lambda s, arm=arm: np.hypot(*(arm @ facet_shapes(s))) - excluded, 0.0, 1.0
            )
            weights = np.zeros(nodes.size)
            weights[np.searchsorted(nodes, facet)] = facet_shapes(at)
            rims.append(weights)
    return _Zones(excluded, within, np.array(rims).reshape(-1, nodes.size))


def _edges(mesh: BodyMesh) -> NDArray[np.int64]:
    """Nodes at the edges of the keyway in the bore and at the sharp corners of its floor."""
    start, end, _ = mesh.facet_triples("keyway")
    chord = mesh.points[:, end] - mesh.points[:, start]
    chord /= np.hypot(*chord)
    at, before, after = np.intersect1d(end, start, return_indices=True)
    sharp = np.sum(chord[:, before] * chord[:, after], axis=0) < np.cos(_SHARP)
    in_bore = np.intersect1d(mesh.boundary_nodes("bore"), mesh.boundary_nodes("keyway"))
    return np.concatenate([in_bore, at[sharp]])


def _half_plane(points: Array, contacts: Array, normals: Array) -> Array:
    """Stress xx, yy, xy (3, m, k), 1/m, in the body frame, at points (2, m), m, of half-planes
    under unit line forces at contacts (2, k), m, with outward normals (2, k).
    """
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
