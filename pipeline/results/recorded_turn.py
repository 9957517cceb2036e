"""Stress of both bodies over the turn, made to be looked at: for the film of a report.

The cam's mesh is too coarse for the eye: the load would flicker from node to node as it passes. So
the cam has a grid with a line of points under every contact shown, graded towards the surface;
the half-plane's part of the field is taken there in closed form, the smooth rest from the mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.spatial import cKDTree

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.cutouts import KeywayLike
from camwright.meshes.body_mesh import BodyMesh
from camwright.pipeline.contact.body_compliance import LoadedBody, hertz_stress
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.results.stress_fields import IntArray, facing, follower_places

FRAMES = 360
"""Positions shown at most; a turn of fewer is shown whole."""

_MM, _MPA = 1e3, 1e-6
_LAYERS, _GRADING = 19, 4.5
_TOGETHER = 12
_NEAR = 16  # elements about a point among which the one that holds it is looked for


def turn_view(
    pair: ContactPair,
    bodies: CycleBodies,
    cycle: Cycle,
    tell: Callable[[int, int], None] = lambda *_: None,
) -> Mapping[str, NDArray[Any]]:
    """Arrays of ``fields/turn.npz``.

    Returns
    -------
    mapping   load_case; position (f,) and cam_angle_deg (f,) of what is shown; cam_mm
              (2, stations, layers) in the cam's frame, the surface first, and the follower's
              mesh, follower_mm (2, n) with follower_triangles (6, m), in its own frame, which
              has its origin at follower_origin_mm (f, 2) of the cam's and is turned by
              follower_turn_deg (f,); cam_MPa (f, stations, layers) and follower_MPa (f, n), von
              Mises stress in half precision, which is finer than any colour shows
    """
    count = cycle.theta.size
    shown = np.arange(0, count, -(-count // FRAMES))
    points = cam_points(pair, 2 * shown.size)
    between = linear(bodies.cam.body.mesh, points)
    places = follower_places(pair, cycle.theta[shown])
    on_cam, on_other = [], []
    for start in range(0, shown.size, _TOGETHER):
        part = shown[start : start + _TOGETHER]
        on_cam.append(_cam_stress(pair, bodies.cam, cycle, part, points, between))
        on_other.append(_follower_stress(pair, bodies.follower, cycle, part))
        tell(start + part.size, shown.size)
    mesh = bodies.follower.body.mesh
    return {
        "load_case": np.array(cycle.load_case),
        "position": shown,
        "cam_angle_deg": np.degrees(cycle.theta[shown]),
        "cam_mm": _MM * points,
        "cam_MPa": (_MPA * np.concatenate(on_cam)).astype(np.float16),
        "follower_mm": _MM * mesh.points,
        "follower_triangles": mesh.triangles,
        "follower_origin_mm": _MM * np.stack([place.origin for place in places]),
        "follower_turn_deg": np.degrees([place.angle for place in places]),
        "follower_MPa": (_MPA * np.concatenate(on_other)).astype(np.float16),
    }


def _cam_stress(
    pair: ContactPair,
    cam: LoadedBody,
    cycle: Cycle,
    part: IntArray,
    points: Array,
    between: sparse.csr_array,
) -> Array:
    """Von Mises stress (k, stations, layers), Pa."""
    theta, contact = cycle.theta[part], cycle.contact
    at, normal = pair.contour.points(theta), pair.contour.normal(theta)
    _, nodal = cam.correction_fields(at, normal)
    half_plane = hertz_stress(points.reshape(2, -1), at, normal, contact.half_width_hertz[part])
    whole = np.stack([between @ component for component in nodal]) + half_plane
    found = contact.line_load[part] * plane_stress_measures.von_mises(whole, cam.body.poisson)
    return np.asarray(found.T.reshape(part.size, *points.shape[1:]))


def _follower_stress(pair: ContactPair, other: LoadedBody, cycle: Cycle, part: IntArray) -> Array:
    """Von Mises stress (k, nodes), Pa; a roller has a node where it touches."""
    load, half_width = cycle.contact.line_load[part], cycle.contact.half_width_hertz[part]
    _, nodal = other.fields(*facing(pair, cycle.theta[part]), load, half_width)
    return np.asarray(plane_stress_measures.von_mises(nodal, other.body.poisson).T)


def cam_points(pair: ContactPair, stations: int) -> Array:
    """Points (2, stations, layers) of the cam, m, from the contour straight towards the axis."""
    outer = pair.contour.points(uniform_turn(stations))
    radius, angle = np.hypot(*outer), np.arctan2(outer[1], outer[0])
    return _graded(outer, outer * (bore_reach(pair.bore_radius, pair.keyway, angle) / radius))


def bore_reach(bore_radius: float, keyway: KeywayLike | None, angle: Array) -> Array:
    """Distance (...) from the axis to the edge of bore and keyway, m, in directions (...), rad."""
    reach = np.full(angle.shape, bore_radius)
    if keyway is None:
        return reach
    off = np.abs((angle - keyway.angle + np.pi) % (2 * np.pi) - np.pi)
    half, floor = 0.5 * keyway.width, bore_radius + keyway.depth
    with np.errstate(divide="ignore"):
        slot = np.minimum(floor / np.maximum(np.cos(off), 1e-9), half / np.sin(off))
    return np.where(off < np.arcsin(half / bore_radius), slot, reach)


def _graded(outer: Array, inner: Array) -> Array:
    """Points (2, stations, layers) between two rings (2, stations), closest at the outer one."""
    share = np.expm1(_GRADING * np.linspace(0.0, 1.0, _LAYERS)) / np.expm1(_GRADING)
    return outer[:, :, None] + (inner - outer)[:, :, None] * share


def linear(mesh: BodyMesh, points: Array) -> sparse.csr_array:
    """What takes values at the nodes of a mesh to points (2, ...) of the body, by straight lines.

    A point on a curved edge, just beyond its chord, takes the value of the chord.
    """
    flat = points.reshape(2, -1)
    corners = mesh.triangles[:3]
    places = mesh.points[:, corners]
    near = cKDTree(places.mean(axis=1).T).query(flat.T, k=min(_NEAR, corners.shape[1]))[1]
    a, b, c = (places[:, k, near] for k in range(3))
    parts = np.stack([_twice_area(flat[:, :, None], b, c), _twice_area(a, flat[:, :, None], c),
                      _twice_area(a, b, flat[:, :, None])]) / _twice_area(a, b, c)  # fmt: skip
    chosen = parts.min(axis=0).argmax(axis=1)
    each = np.arange(flat.shape[1])
    weights = np.maximum(parts[:, each, chosen], 0.0)
    weights /= weights.sum(axis=0)
    columns = corners[:, near[each, chosen]]
    entries: Any = (weights.ravel(), (np.tile(each, 3), columns.ravel()))
    return sparse.coo_array(entries, shape=(flat.shape[1], mesh.points.shape[1])).tocsr()


def _twice_area(a: Array, b: Array, c: Array) -> Array:
    return np.asarray((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
