"""Displacement and stress of cam and follower over the turn, in the cam frame.

On the coarse mesh of each body, and on a fine mesh below its contact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.gmsh_mesher import Index
from camwright.pipeline.contact.body_compliance import (
    CorrectionField,
    LoadedBody,
    from_contact_axes,
)
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.two_scale import CycleBodies, stress_on_patch
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.results.contact_zone import (
    MIDDLE,
    ZoneSite,
    patch_weights,
    zone_places,
    zone_triangles,
)
from camwright.pipeline.results.field_file import ZONE

IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class BodyField:
    """Displacement and stress on a mesh at k cam angles.

    points (2, n, k), m; displacement (2, n, k), m; stress xx, yy, xy (3, n, k), Pa; hidden (t, k)
    triangles that another mesh replaces.
    """

    points: Array
    displacement: Array
    stress: Array
    hidden: NDArray[np.bool_]

    def nothing(self, count: int) -> BodyField:
        """A field of zeros on its mesh at `count` angles."""

        def zeros(own: NDArray[Any]) -> NDArray[Any]:
            return np.zeros((*own.shape[:-1], count), dtype=own.dtype)

        return BodyField(
            zeros(self.points), zeros(self.displacement), zeros(self.stress), zeros(self.hidden)
        )

    def put(self, among: BodyField, here: NDArray[np.bool_]) -> BodyField:
        """Field at all angles: this one at some of them, `among` at the others.

        Parameters
        ----------
        among : BodyField   at all k angles
        here : array (k,)   whether this field is of the angle
        """

        def whole(own: NDArray[Any], others: NDArray[Any]) -> NDArray[Any]:
            every = others.copy()
            every[..., here] = own
            return every

        return BodyField(
            whole(self.points, among.points),
            whole(self.displacement, among.displacement),
            whole(self.stress, among.stress),
            whole(self.hidden, among.hidden),
        )

    def placed(self, places: Poses) -> BodyField:
        """Field of a body transformed to the cam frame: points, displacement and stress turned,
        points moved.

        Parameters
        ----------
        places : Poses   of the body in the cam frame at the k cam angles
        """
        turn = places.turn
        xx, yy, xy = self.stress
        tensor = np.einsum(
            "kab,bcnk,kdc->adnk", turn, np.array([[xx, xy], [xy, yy]]), turn, optimize=True
        )
        return replace(
            self,
            points=np.einsum("kab,bnk->ank", turn, self.points) + places.origin.T[:, None],
            displacement=np.einsum("kab,bnk->ank", turn, self.displacement),
            stress=np.stack([tensor[0, 0], tensor[1, 1], tensor[0, 1]]),
        )


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of a body at k cam angles: origins (k, 2), m, rotations (k, 2, 2)."""

    origin: Array
    turn: Array

    @property
    def angle(self) -> Array:
        """Rotation (k,), rad."""
        return np.arctan2(self.turn[:, 1, 0], self.turn[:, 0, 0])


def follower_places(pair: ContactPair, theta: Array) -> Poses:
    """Poses of the body of the follower in the cam frame at k cam angles, by which its contact
    point and normal meet those of the cam.

    Parameters
    ----------
    pair : ContactPair   cam and follower
    theta : array (k,)   cam angles, rad
    """
    contacts, normals = pair.contacts(theta)
    normals = -normals
    at, up = np.empty((2, *contacts.shape))
    for each, here in pair.on_walls(theta):
        at[:, here], up[:, here] = each.follower_contacts(theta[here])
    cosine, sine = (up * normals).sum(axis=0), up[0] * normals[1] - up[1] * normals[0]
    turn = np.array([[cosine, -sine], [sine, cosine]]).transpose(2, 0, 1)
    return Poses(contacts.T - np.einsum("kab,bk->ka", turn, at), turn)


@dataclass(frozen=True, eq=False)
class TurnFields:
    """Stress fields of both bodies over a cycle, computed in blocks of angles."""

    pair: ContactPair
    bodies: CycleBodies
    cycle: Cycle

    @property
    def names(self) -> tuple[str, str]:
        """Cam and follower."""
        return "cam", self.pair.follower.name

    @property
    def poisson(self) -> dict[str, float]:
        """Poisson ratio by block."""
        cam, other = self.pair.cam.poisson, self.pair.follower.material.poisson
        first, second = self.names
        return {first: cam, second: other, first + ZONE: cam, second + ZONE: other}

    @cached_property
    def _surfaces(self) -> tuple[TurnFields, ...]:
        """Fields of each surface of the cam by itself: of the first, which pushes the follower, and
        of a second one, which pulls it.
        """
        if self.pair.pulling is None:
            return (self,)
        pairs = replace(self.pair, pulling=None), self.pair.pulling
        return tuple(TurnFields(each, self.bodies.of(each), self.cycle) for each in pairs)

    @cached_property
    def coarse_points(self) -> dict[str, Array]:
        """Corners (2, n), m, of the coarse meshes by block; the block of the cam has all its
        bodies.
        """
        return {
            name: np.hstack([mesh.points[:, : mesh.corners] for mesh in self._meshes(name)])
            for name in self.names
        }

    def _meshes(self, name: str) -> list[BodyMesh]:
        """Meshes of all bodies of a block: of the cam or the follower."""
        return [each.body.mesh for each in dict.fromkeys(self._bodies(name))]

    def _bodies(self, name: str) -> list[LoadedBody]:
        """Body of a block that each surface of the cam loads."""
        every = [each.bodies for each in self._surfaces]
        return [each.cam if name == self.names[0] else each.follower for each in every]

    @cached_property
    def triangles(self) -> dict[str, Index]:
        """Triangles (3, t), as indices of the corners of their mesh, by block."""
        joined = {}
        for name in self.names:
            meshes = self._meshes(name)
            starts = np.cumsum([0, *(mesh.corners for mesh in meshes[:-1])])
            parts = [mesh.triangles[:3] + start for mesh, start in zip(meshes, starts, strict=True)]
            joined[name] = np.hstack(parts)
        return joined | {name + ZONE: zone_triangles() for name in self.names}

    @cached_property
    def _sites(self) -> tuple[ZoneSite, ZoneSite]:
        return ZoneSite(self.bodies.cam), ZoneSite(self.bodies.follower)

    def at(self, part: IntArray) -> dict[str, BodyField]:
        """Fields of both bodies by name of the block, on coarse and fine meshes, at k positions of
        the cycle, in the cam frame.

        The displacement of the follower includes its rigid motion by the approach, so that the
        displaced surfaces touch.

        Parameters
        ----------
        part : array (k,)   indices of the positions
        """
        surfaces = self._surfaces
        if len(surfaces) == 1:
            return self._carried(part)
        joined = dict[str, BodyField]()
        for carrying, here in self.pair.on_walls(self.cycle.theta[part]):
            number = int(carrying is self.pair.pulling)
            each = surfaces[number]
            fields = each._carried(part[here])
            fields |= {name: self._among_all(fields[name], name, number) for name in self.names}
            for name, field in fields.items():
                joined[name] = field.put(joined.get(name, field.nothing(here.size)), here)
        return joined

    def _among_all(self, field: BodyField, name: str, number: int) -> BodyField:
        """Field on the coarse mesh of all bodies of a block, of which one is loaded; the others are
        at rest, and hidden where they lie in a plane of their own: discs of a pair.

        Parameters
        ----------
        field : BodyField   on the coarse mesh of the loaded body
        name : str          of the block
        number : int        of the surface of the cam that carries, from 0
        """
        meshes, loaded = self._meshes(name), self._bodies(name)[number].body.mesh
        if len(meshes) == 1:
            return field
        number = [each is loaded for each in meshes].index(True)
        points = self.coarse_points[name]
        triangles, count = self.triangles[name].shape[1], field.points.shape[2]
        node = sum(mesh.corners for mesh in meshes[:number])
        cell = sum(mesh.triangles.shape[1] for mesh in meshes[:number])
        nodes = slice(node, node + meshes[number].corners)
        cells = slice(cell, cell + meshes[number].triangles.shape[1])
        displacement, stress = (np.zeros((k, points.shape[1], count)) for k in (2, 3))
        one_plane = self.pair.pulling is None or self.pair.pulling.rim_radius is not None
        hidden = np.full((triangles, count), not one_plane)
        displacement[:, nodes], stress[:, nodes] = field.displacement, field.stress
        hidden[cells] = field.hidden
        still = np.repeat(points[:, :, None], count, axis=2)
        still[:, nodes] = field.points
        return BodyField(still, displacement, stress, hidden)

    def _carried(self, part: IntArray) -> dict[str, BodyField]:
        """Fields by block at positions of the cycle at which the first surface of the cam carries.

        Parameters
        ----------
        part : array (k,)   positions in the cycle
        """
        pair, theta, contact = self.pair, self.cycle.theta[part], self.cycle.contact
        load = contact.line_load[part], contact.half_width_hertz[part]
        contour, (points, normals) = pair.contour, pair.touched(theta)
        first, second = self.names
        angle = pair.angle(theta)
        cam = Loaded(
            self._sites[0], points, normals, *load, lambda along: fallen_back(contour, angle, along)
        )
        facing = self._sites[1], *pair.follower_contacts(theta)
        other = Loaded(*facing, *load, contour.follower_gap)
        places = follower_places(pair, theta)
        fields = {
            first: cam.coarse,
            second: other.coarse.placed(places),
            first + ZONE: self._with_patch(cam, part),
            second + ZONE: other.fine.placed(places),
        }
        closing = approach(fields[first + ZONE], fields[second + ZONE], normals)
        for name in (second, second + ZONE):
            displacement = fields[name].displacement - closing * normals[:, None]
            fields[name] = replace(fields[name], displacement=displacement)
        return fields

    def _with_patch(self, cam: Loaded, part: IntArray) -> BodyField:
        """Field of the cam below its contact, whose stress near the contact is that of the
        finite-element patch, from which the maxima of the cycle are; where no pressure is solved,
        that of closed forms.

        Parameters
        ----------
        cam : Loaded        cam under its loads at k positions
        part : array (k,)   indices of the positions in the cycle
        """
        field, contact = cam.fine, self.cycle.contact
        pressure = contact.pressure[part]
        solved = np.isfinite(pressure).all(axis=1) & (cam.line_load > 0)
        if not solved.any():
            return field
        chosen, poisson = part[solved], self.pair.cam.poisson
        corners, shares, blend = patch_weights(poisson)
        stress = stress_on_patch(
            self.pair, cam.reduced(solved), self.cycle.theta[chosen], cam.line_load[solved],
            cam.half_width[solved], contact.p0_hertz[chosen], pressure[solved],
        )  # fmt: skip
        inner = np.einsum("cink,in->cnk", stress[:, corners], shares, optimize=True)
        inner = from_contact_axes(inner, cam.normals[:, solved])
        total, count = field.stress.copy(), corners.shape[1]
        weight = blend[:count, None]
        below = total[:, :count]
        below[:, :, solved] += weight * (inner - below[:, :, solved])
        return replace(field, stress=total)


def fallen_back(contour: Contour, theta: Array, along: Array) -> Array:
    """Depth (m, k), m, of the contour below its tangent at k contacts; by the circle of curvature
    where the contour does not reach as far.

    Parameters
    ----------
    contour : Contour      of the cam
    theta : array (k,)     cam angles of the contacts, rad
    along : array (m, k)   distances along the tangent, m
    """
    try:
        return -contour.surface_offset(theta, -along.T).T
    except GeometryError:
        inclination = contour.curvature(theta) * along
        return inclination * along / (1 + np.sqrt(np.maximum(1 - inclination**2, 0.0)))


def approach(cam: BodyField, follower: BodyField, normals: Array) -> Array:
    """Approach (k,), m, of the supports of both bodies, from their displacements at the contact.

    From the fields below the contact, each relative to its support; `normals` (2, k) of the cam.
    """
    apart = follower.displacement[:, MIDDLE] - cam.displacement[:, MIDDLE]
    return np.asarray((apart * normals).sum(axis=0))


@dataclass(frozen=True, eq=False)
class Loaded:
    """Body under contact loads, in its own frame.

    contacts, normals (2, c) with c = 1 where all are equal; line_load N/m and half_width m (k,);
    height of the tangent above the surface, m, at distances (m, k) along it, m.
    """

    site: ZoneSite
    contacts: Array
    normals: Array
    line_load: Array
    half_width: Array
    height: Callable[[Array], Array]

    @cached_property
    def correction(self) -> tuple[Array, Array]:
        """Correction (2, nodes, c), (3, nodes, c) on the coarse mesh."""
        return self.site.body.correction_fields(self.contacts, self.normals)

    def reduced(self, chosen: NDArray[np.bool_]) -> CorrectionField:
        """Correction at some of k different contacts."""
        displaced = self.correction[0][:, :, chosen]
        return self.site.body.correction_of(
            displaced, self.contacts[:, chosen], self.normals[:, chosen]
        )

    @cached_property
    def radius(self) -> Array:
        """Radius (k,) of the fine mesh, m."""
        return self.site.radius(self.contacts, self.half_width)

    @property
    def coarse(self) -> BodyField:
        """Field at the corners of the coarse mesh; elements within the fine mesh are hidden."""
        mesh = self.site.body.body.mesh
        corners, count = mesh.corners, self.line_load.size
        points = mesh.points[:, :corners]
        displaced, nodal = (values[:, :corners] for values in self.correction)
        field = self._superposed(points, (displaced, nodal))
        distance = np.hypot(*(points[:, :, None] - self.contacts[:, None]))
        inside = distance < self.radius
        still = np.broadcast_to(points[:, :, None], (2, corners, count))
        return BodyField(still, *field, inside[mesh.triangles[:3]].all(axis=0))

    @property
    def fine(self) -> BodyField:
        """Field at the nodes of the fine mesh below the contact."""
        along, depth = zone_places(self.half_width, self.radius)
        depth = depth + self.height(along)
        normals = self.normals[:, None]
        tangents = np.stack([normals[1], -normals[0]])
        points = self.contacts[:, None] + tangents * along - normals * depth
        correction = self.site.interpolated(self.correction, points, self.normals)
        field = self._superposed(points, correction)
        shown = np.zeros((zone_triangles().shape[1], self.line_load.size), dtype=bool)
        return BodyField(points, *field, shown)

    def _superposed(self, points: Array, correction: tuple[Array, Array]) -> tuple[Array, Array]:
        return self.site.body.superposed(
            points, correction, self.contacts, self.normals, self.line_load, self.half_width
        )
