"""VTU files of the contact and of both bodies over the turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.mesh_files import write_pvd, write_vtu
from camwright.pipeline.contact.certificate import SolvedPair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures as stress
from camwright.pipeline.contact.elasticity.elastic_body import ElasticBody, StressRecovery
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.cycle import Cycle

_MILLIMETRE, _MEGAPASCAL = 1e-3, 1e6
_TOGETHER = 24  # positions whose fields are in memory at once
BODIES_INDEX = "bodies_cycle.pvd"

IntArray = NDArray[np.int64]


def write_contact(path: Path, solved: SolvedPair, name: str) -> None:
    """Displacement and stress of both bodies at one angle, in the cam frame.

    `name` is that of the body of the follower in the file.
    """
    sides = zip(("cam", name), solved.sides, solved.solution.displacements, strict=True)
    # The follower is fixed in the solution; the approach is its rigid motion.
    rigid = {"cam": np.zeros(2), name: -solved.solution.approach * solved.frame.normal}
    data = {
        body: _point_data(side.body, field + rigid[body][:, None], _recovered(side.body, field))
        for body, side, field in sides
    }
    write_vtu(
        path,
        {"cam": solved.cam, name: solved.follower},
        data,
        {
            "cam_angle_deg": float(np.degrees(solved.theta)),
            "half_width_mm": solved.solution.half_width / _MILLIMETRE,
            "peak_pressure_MPa": solved.solution.p0 / _MEGAPASCAL,
            "contact_x_mm": float(solved.frame.origin[0]) / _MILLIMETRE,
            "contact_y_mm": float(solved.frame.origin[1]) / _MILLIMETRE,
            "normal_x": float(solved.frame.normal[0]),
            "normal_y": float(solved.frame.normal[1]),
        },
    )


def write_bodies(
    folder: Path,
    pair: ContactPair,
    bodies: CycleBodies,
    cycle: Cycle,
    indices: IntArray,
    number: int,
    advance: Callable[[int, int], None] = lambda *_: None,
) -> Path:
    """Both bodies at some positions of a turn, as ``bodies_cycle.pvd`` with its pieces.

    In the cam frame, in which the follower rotates. Displacements are relative to the support of
    each body. The stress is that of the Hertz pressure on the half-plane plus the finite-element
    correction; the meshes are too coarse to resolve the contact. Times are cam angles in degrees.

    Parameters
    ----------
    indices : (n,)   positions of the cycle, in order
    number : int     of the load case, from 1
    """
    pieces = folder / "bodies"
    pieces.mkdir(exist_ok=True)
    entries, other = [], pair.follower.name
    for start in range(0, indices.size, _TOGETHER):
        part = indices[start : start + _TOGETHER]
        places = follower_places(pair, cycle.theta[part])
        fields = _loaded(pair, bodies, cycle, part)
        for k, place, (on_cam, facing) in zip(part, places, fields, strict=True):
            angle = float(np.degrees(cycle.theta[k]))
            name = f"bodies_{round(1000 * angle):06d}.vtu"
            there = facing.turned(place.turn)
            write_vtu(
                pieces / name,
                {"cam": bodies.cam.body.mesh, other: place.mesh(bodies.follower.body.mesh)},
                {
                    "cam": _point_data(bodies.cam.body, on_cam.displacement, on_cam.stress),
                    other: _point_data(bodies.follower.body, there.displacement, there.stress),
                },
                position_notes(pair, cycle, int(k), number),
            )
            entries.append((angle, f"bodies/{name}"))
        advance(min(start + _TOGETHER, indices.size), indices.size)
    index = folder / BODIES_INDEX
    write_pvd(index, entries)
    return index


@dataclass(frozen=True, eq=False)
class BodyField:
    """Displacement (2, n), m, and stress xx, yy, xy (3, n), Pa, at the nodes of a body."""

    displacement: Array
    stress: Array

    def turned(self, turn: Array) -> BodyField:
        """The field in rotated axes; `turn` (2, 2) transforms a vector to them."""
        xx, yy, xy = self.stress
        tensor = turn @ np.array([[xx, xy], [xy, yy]]).transpose(2, 0, 1) @ turn.T
        turned = np.stack([tensor[:, 0, 0], tensor[:, 1, 1], tensor[:, 0, 1]])
        return BodyField(turn @ self.displacement, turned)


@dataclass(frozen=True, eq=False)
class Place:
    """Pose of a body: origin (2,), m, of its own frame, and rotation (2, 2) of its axes."""

    origin: Array
    turn: Array

    @property
    def angle(self) -> float:
        """Rotation, rad."""
        return float(np.arctan2(self.turn[1, 0], self.turn[0, 0]))

    def mesh(self, own: BodyMesh) -> BodyMesh:
        return own.transformed(self.angle, self.origin)


def follower_places(pair: ContactPair, theta: Array) -> list[Place]:
    """Poses of the follower's body in the cam frame at cam angles (n,)."""
    contacts, normals = pair.contour.points(theta), pair.contour.normal(theta)
    at, up = (np.broadcast_to(v, contacts.shape) for v in facing(pair, theta))
    places = []
    for k in range(theta.size):
        n, u = -normals[:, k], up[:, k]
        cosine, sine = u @ n, u[0] * n[1] - u[1] * n[0]
        turn = np.array([[cosine, -sine], [sine, cosine]])
        places.append(Place(contacts[:, k] - turn @ at[:, k], turn))
    return places


def facing(pair: ContactPair, theta: Array) -> tuple[Array, Array]:
    """Contacts (2, n) on the follower and outward normals (2, n), in its own frame."""
    at, up = pair.follower.contacts(pair.contour, theta)
    return np.repeat(at, theta.size // at.shape[1], 1), np.repeat(up, theta.size // up.shape[1], 1)


def position_notes(pair: ContactPair, cycle: Cycle, k: int, number: int) -> dict[str, float]:
    """Data of a position of the cycle; `number` is that of its load case, from 1."""
    contact, theta = cycle.contact, float(cycle.theta[k])
    point, normal = pair.contour.points(theta), pair.contour.normal(theta)
    return {
        "cam_angle_deg": float(np.degrees(theta)),
        "load_case_number": float(number),
        "line_load_N_per_mm": float(contact.line_load[k]) * _MILLIMETRE,
        "half_width_mm": float(contact.half_width[k]) / _MILLIMETRE,
        "half_width_hertz_mm": float(contact.half_width_hertz[k]) / _MILLIMETRE,
        "peak_pressure_MPa": float(contact.p0[k]) / _MEGAPASCAL,
        "contact_x_mm": float(point[0]) / _MILLIMETRE,
        "contact_y_mm": float(point[1]) / _MILLIMETRE,
        "normal_x": float(normal[0]),
        "normal_y": float(normal[1]),
    }


def _loaded(
    pair: ContactPair, bodies: CycleBodies, cycle: Cycle, part: IntArray
) -> Iterator[tuple[BodyField, BodyField]]:
    """Cam and follower, each in its own frame, at some positions."""
    theta, contact = cycle.theta[part], cycle.contact
    load = contact.line_load[part], contact.half_width_hertz[part]
    cam = bodies.cam.fields(pair.contour.points(theta), pair.contour.normal(theta), *load)
    other = bodies.follower.fields(*facing(pair, theta), *load)
    for k in range(part.size):
        yield (
            BodyField(cam[0][..., k], cam[1][..., k]),
            BodyField(other[0][..., k], other[1][..., k]),
        )


def _recovered(body: ElasticBody, displacement: Array) -> Array:
    recovery = StressRecovery(body, np.arange(body.mesh.triangles.shape[1]))
    nodal = np.zeros((3, body.mesh.points.shape[1]))
    nodal[:, recovery.nodes] = recovery(displacement[:, :, None])[:, :, 0]
    return nodal


def _point_data(body: ElasticBody, displacement: Array, nodal: Array) -> dict[str, Array]:
    shown = nodal / _MEGAPASCAL
    return {
        "displacement_mm": displacement / _MILLIMETRE,
        "von_mises_MPa": stress.von_mises(shown, body.poisson),
        "tau_max_MPa": stress.shear_in_plane(shown),
        "stress_xx_MPa": shown[0],
        "stress_yy_MPa": shown[1],
        "stress_xy_MPa": shown[2],
    }
