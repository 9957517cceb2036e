"""The body of the follower that touches the cam: a roller or the block of a flat face."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.meshes.body_mesh import BodyMesh, face_mesh, roller_mesh
from camwright.meshes.element_size import Sizing
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, Springs

# What a body adds varies over its wall's thickness; fewer would smooth it away.
EDGES_ACROSS_WALL = 4
# Of a face: what bends it under a push beside the stem varies over its thickness.
_EDGES_ACROSS_FACE = 8
_EDGES_ALONG_FACE = 60


class FollowerBody(Protocol):
    """What the contact asks of the second body.

    `name` is that of the body in files, `surface` and `held` are those boundaries of its mesh
    that touch the cam and that hold it, `free` others that carry nothing. Where `held` is empty
    `springs` hold it.
    """

    @property
    def material(self) -> Elastic: ...
    @property
    def name(self) -> str: ...
    @property
    def surface(self) -> str: ...
    @property
    def held(self) -> str: ...
    @property
    def free(self) -> tuple[str, ...]: ...
    @property
    def far_size(self) -> float:
        """Element size far from the contact of a certificate, m."""
        ...

    def coarse_mesh(self) -> BodyMesh:
        """Mesh in the body's own frame for the contact anywhere on it."""
        ...

    def contacts(self, contour: Contour, theta: Array, /) -> tuple[Array, Array]:
        """Contacts (2, n) and outward normals (2, n) on it, (2, 1) where all are alike."""
        ...

    def mesh_at(self, contour: Contour, theta: float, sizing: Sizing) -> BodyMesh:
        """Mesh in the cam's frame, fine at the contact."""
        ...

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> Springs | None:
        """What holds it besides, on its mesh at a cam angle; no contour: in its own frame."""
        ...


@dataclass(frozen=True)
class RollerBody:
    """A roller, held at its hub; radii in m."""

    radius: float
    hub_radius: float
    material: Elastic
    name: str = "roller"
    surface: str = "rim"
    held: str = "hub"
    free: tuple[str, ...] = ()

    @property
    def far_size(self) -> float:
        return self.radius

    def coarse_mesh(self) -> BodyMesh:
        wall = (self.radius - self.hub_radius) / EDGES_ACROSS_WALL
        size = Sizing(far_size=min(self.radius / 8, wall))
        return roller_mesh(self.radius, self.hub_radius, 0.5 * np.pi, size)

    def contacts(self, _contour: Contour, _theta: Array, /) -> tuple[Array, Array]:
        """One place for all: a roller is round."""
        return np.array([[0.0], [self.radius]]), np.array([[0.0], [1.0]])

    def mesh_at(self, contour: Contour, theta: float, sizing: Sizing) -> BodyMesh:
        contact, normal = contour.points(theta), contour.normal(theta)
        facing = float(np.arctan2(-normal[1], -normal[0]))
        mesh = roller_mesh(self.radius, self.hub_radius, facing, sizing)
        return mesh.transformed(0.0, contact + self.radius * normal)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> None:
        """None: the hub holds it."""


@dataclass(frozen=True)
class FaceBody:
    """The block of a flat face, centred on the stem and held where the stem stands on its back.

    Its frame has the middle of the face as origin and looks along y at the cam; x runs along v of
    the cam's angle. width along the face in the plane of motion, thickness along the stem, m.
    """

    width: float
    thickness: float
    stem_diameter: float
    material: Elastic
    name: str = "face"
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
        return face_mesh(self.width, self.thickness, self.stem_diameter, Sizing(far_size=size))

    def contacts(self, contour: Contour, theta: Array, /) -> tuple[Array, Array]:
        """At s' - e along the face."""
        along = contour.pitch.push_arm(theta)
        nothing, one = np.zeros_like(along), np.ones_like(along)
        return np.stack([along, nothing]), np.stack([nothing, one])

    def mesh_at(self, contour: Contour, theta: float, sizing: Sizing) -> BodyMesh:
        arm = float(contour.pitch.push_arm(theta))
        here = replace(sizing, contact_point=np.array([arm, 0.0]))
        mesh = face_mesh(self.width, self.thickness, self.stem_diameter, here)
        middle = contour.points(theta) - arm * contour.tangent(theta)
        return mesh.transformed(theta + 0.5 * np.pi, middle)

    def springs(self, mesh: BodyMesh, contour: Contour | None, theta: float) -> None:
        """None: the stem holds it."""
