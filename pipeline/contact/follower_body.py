"""Body of the follower in the contact: roller, or block of a face."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.meshes.body_mesh import BodyMesh, face_mesh, roller_mesh, sagitta
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, Springs

# The correction field of a body varies over the thickness of its wall.
EDGES_ACROSS_WALL = 4
# The bending of a face under a force beside the stem varies over its thickness.
_EDGES_ACROSS_FACE = 8
_EDGES_ALONG_FACE = 60


class FollowerBody(Protocol):
    """Interface of the follower's body: mesh, contact surface, supports.

    `name` names the body in files, `part` what bends under the contact; `surface` is the boundary
    of its mesh in contact with the cam, `held` the held one, `free` are the unloaded ones. Where
    `held` is empty, `springs` support the body.
    """

    @property
    def material(self) -> Elastic: ...
    @property
    def name(self) -> str: ...
    @property
    def part(self) -> str: ...
    @property
    def surface(self) -> str: ...
    @property
    def held(self) -> str: ...
    @property
    def free(self) -> tuple[str, ...]: ...
    @property
    def far_size(self) -> float:
        """Element size far from the contact in a certificate, m."""
        ...

    def coarse_mesh(self) -> BodyMesh:
        """Mesh in the frame of the body, of uniform size."""
        ...

    def contacts(self, contour: Contour, theta: Array, /) -> tuple[Array, Array]:
        """Contact points (2, n), m, and outward normals (2, n); (2, 1) where all are equal."""
        ...

    def mesh_at(self, contour: Contour, theta: float, sizing: ElementSize) -> BodyMesh:
        """Mesh in the cam frame, refined at the contact."""
        ...

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> Springs | None:
        """Spring supports on its mesh at a cam angle; in the body's frame for contour None."""
        ...


@dataclass(frozen=True)
class RollerBody:
    """Roller held at its hub; radii in m."""

    radius: float
    hub_radius: float
    material: Elastic
    name: str = "roller"
    part: str = "roller"
    surface: str = "rim"
    held: str = "hub"
    free: tuple[str, ...] = ()

    @property
    def far_size(self) -> float:
        return self.radius

    def coarse_mesh(self) -> BodyMesh:
        wall = (self.radius - self.hub_radius) / EDGES_ACROSS_WALL
        size = ElementSize(far_size=min(self.radius / 8, wall))
        return roller_mesh(self.radius, self.hub_radius, 0.5 * np.pi, size)

    def contacts(self, _contour: Contour, _theta: Array, /) -> tuple[Array, Array]:
        """The top of the roller, for every cam angle."""
        return np.array([[0.0], [self.radius]]), np.array([[0.0], [1.0]])

    def mesh_at(self, contour: Contour, theta: float, sizing: ElementSize) -> BodyMesh:
        """Mesh of the roller in the cam frame at cam angle `theta`, rad, refined at the contact."""
        contact, normal = contour.points(theta), contour.normal(theta)
        facing = float(np.arctan2(-normal[1], -normal[0]))
        mesh = roller_mesh(self.radius, self.hub_radius, facing, sizing)
        return mesh.transformed(0.0, contact + self.radius * normal)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> None:
        """None: the hub is held."""


@dataclass(frozen=True)
class FaceBody:
    """Block of a face, its back held in the middle: over the cross-section of a stem, or whole.

    The frame has its origin in the middle of the face, y towards the cam and x along the face.
    width along the face in the plane of motion, thickness along the stem, stem_diameter: width held
    at the back, radius: of a curved face, None of a flat one, m.
    """

    width: float
    thickness: float
    stem_diameter: float
    material: Elastic
    radius: float | None = None
    name: str = "face"
    part: str = "flat face"
    surface: str = "top"
    held: str = "stem"

    @property
    def free(self) -> tuple[str, ...]:
        backs = ("back_left", "back_right") if self.stem_diameter < self.width else ()
        return ("left", "right", *backs)

    @property
    def far_size(self) -> float:
        return self.thickness

    def coarse_mesh(self) -> BodyMesh:
        size = min(self.thickness / _EDGES_ACROSS_FACE, self.width / _EDGES_ALONG_FACE)
        sizing = ElementSize(far_size=size)
        return face_mesh(self.width, self.thickness, self.stem_diameter, sizing, self.radius)

    def contacts(self, contour: Contour, theta: Array, /) -> tuple[Array, Array]:
        """Contact points (2, n), m, and outward normals (2, n) in the frame of the face, at cam
        angles (n,), rad.
        """
        along = np.asarray(contour.pitch.slide(theta).on_face)
        if self.radius is None:
            nothing, one = np.zeros_like(along), np.ones_like(along)
            return np.stack([along, nothing]), np.stack([nothing, one])
        sine = along / self.radius
        normal = np.stack([sine, np.sqrt(1.0 - sine**2)])
        return np.stack([along, -sagitta(along, self.radius)]), normal

    def mesh_at(self, contour: Contour, theta: float, sizing: ElementSize) -> BodyMesh:
        """Mesh of the face in the cam frame at cam angle `theta`, rad, refined at the contact."""
        arm = float(contour.pitch.slide(theta).on_face)
        here = replace(sizing, contact_point=np.array([arm, -float(sagitta(arm, self.radius))]))
        mesh = face_mesh(self.width, self.thickness, self.stem_diameter, here, self.radius)
        travel = theta + float(contour.pitch.travel(theta))
        middle = contour.points(theta) - arm * contour.tangent(theta)
        if self.radius is not None:
            outwards = np.array([np.cos(travel), np.sin(travel)])
            middle = contour.pitch.points(theta) - self.radius * outwards
        return mesh.transformed(travel + 0.5 * np.pi, middle)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> None:
        """None: the back is held."""
