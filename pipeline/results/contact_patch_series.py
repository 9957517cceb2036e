"""Stress below the contact at every position of a turn, as a time series for ParaView."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.gmsh_mesher import Index
from camwright.meshes.mesh_files import write_pvd, write_vtu
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.contact_patch import (
    ELEMENTS_PER_HALF_WIDTH,
    STRESS_REACH,
    contact_patch,
    patch_body,
)
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import elements_near
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.two_scale import CycleBodies, stress_on_patch
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.results.stress_fields import position_notes

_MILLIMETRE, _MEGAPASCAL = 1e-3, 1e6
_TOGETHER = 45  # positions whose stress is in memory at once
INDEX = "patch_cycle.pvd"


def write_patches(
    folder: Path,
    pair: ContactPair,
    bodies: CycleBodies,
    cycle: Cycle,
    number: int,
    advance: Callable[[int, int], None] = lambda *_: None,
) -> Path:
    """Write ``patch_cycle.pvd`` with a piece for every position, in the cam frame.

    The stress is that whose maxima the cycle lists: by the pressure of the position and the
    correction of the real body; zero without contact. Times are cam angles in degrees; `number` is
    that of the load case, from 1.
    """
    pieces = folder / "patch"
    pieces.mkdir(exist_ok=True)
    points, triangles = patch_mesh(pair.cam.poisson)
    entries, count = [], cycle.theta.size
    for start in range(0, count, _TOGETHER):
        part = slice(start, start + _TOGETHER)
        stress = patch_stress(pair, bodies, cycle, part)
        for k, nodal in enumerate(np.moveaxis(stress, 2, 0), start=start):
            angle = float(np.degrees(cycle.theta[k]))
            name = f"patch_{round(1000 * angle):06d}.vtu"
            mesh = BodyMesh(_placed(pair, cycle, k, points), triangles, {})
            notes = position_notes(pair, cycle, k, number)
            fields = _fields(nodal, pair.cam.poisson)
            write_vtu(pieces / name, {"cam": mesh}, {"cam": fields}, notes)
            entries.append((angle, f"patch/{name}"))
        advance(min(start + _TOGETHER, count), count)
    index = folder / INDEX
    write_pvd(index, entries)
    return index


def patch_mesh(poisson: float) -> tuple[Array, Index]:
    """Points (2, m) of the patch, along and depth in half-widths, and its triangles (6, t).

    Raises
    ------
    ResultError
        If the cached template is of another mesh.
    """
    patch = contact_patch(poisson)
    body, frame, _ = patch_body(poisson, ELEMENTS_PER_HALF_WIDTH)
    chosen = body.mesh.triangles[:, elements_near(body, frame.origin, STRESS_REACH)]
    nodes = np.unique(chosen)
    seen = body.mesh.points[:, nodes] * np.array([[1.0], [-1.0]])
    distance, nearest = cKDTree(patch.points.T).query(seen.T)
    apart, column = np.asarray(distance), np.asarray(nearest, dtype=np.int64)
    if nodes.size != patch.points.shape[1] or apart.max() > 1e-12:
        raise ResultError("the cached contact patch is of another mesh")
    return patch.points, column[np.searchsorted(nodes, chosen)]


def patch_stress(pair: ContactPair, bodies: CycleBodies, cycle: Cycle, part: slice) -> Array:
    """Stress (3, m, n), Pa, at some positions of a cycle; zero without contact."""
    theta, contact = cycle.theta[part], cycle.contact
    on = contact.line_load[part] > 0
    stress = np.zeros((3, contact_patch(pair.cam.poisson).points.shape[1], theta.size))
    if on.any():
        at = theta[on]
        cam = bodies.cam.correction(pair.contour.points(at), pair.contour.normal(at))
        stress[:, :, on] = stress_on_patch(
            pair,
            cam,
            at,
            contact.line_load[part][on],
            contact.half_width_hertz[part][on],
            contact.p0_hertz[part][on],
            contact.pressure[part][on],
        )
    return stress


def _placed(pair: ContactPair, cycle: Cycle, k: int, points: Array) -> Array:
    """Points of the patch in the cam frame, m; of a minimum size without contact."""
    theta = float(cycle.theta[k])
    frame = ContactFrame(pair.contour.points(theta), pair.contour.normal(theta))
    size = float(cycle.contact.half_width_hertz[k]) or _MILLIMETRE * 1e-3
    along, depth = size * points
    return frame.origin[:, None] + frame.tangent[:, None] * along - frame.normal[:, None] * depth


def _fields(nodal: Array, poisson: float) -> dict[str, Array]:
    shown = nodal / _MEGAPASCAL
    return {
        "von_mises_MPa": plane_stress_measures.von_mises(shown, poisson),
        "stress_along_MPa": shown[0],
        "stress_into_depth_MPa": shown[1],
        "shear_MPa": shown[2],
    }
