"""Meshes of the bodies: curved quadratic triangles with named boundaries."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze, positive, rotation
from camwright.geometry.cutouts import HoleLike, KeywayLike
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError, MeshError
from camwright.meshes.cam_outline import (
    Backwards,
    ContourLike,
    cam_size,
    contour_piece,
    hole_pieces,
    hole_size,
    rim_size,
    trace,
)
from camwright.meshes.element_size import EDGES_PER_TURN, ElementSize, SizeField
from camwright.meshes.gmsh_mesher import Index, Triangulation, triangulate
from camwright.meshes.outline import Facets, OutlinePiece, Zone, arc, facets, line

if TYPE_CHECKING:
    from skfem import MeshTri2
    from skfem.assembly.basis import AbstractBasis


@dataclass(frozen=True, eq=False, repr=False)
class BodyMesh(Displayed):
    """Body as curved quadratic triangles.

    Parameters
    ----------
    points : (2, n)        nodes, m, corners before mid-side nodes
    triangles : (6, m)     node numbers: corners counter-clockwise, then mid-side nodes of the
                           edges 01, 12, 20
    boundaries : mapping   name -> (3, k) node numbers of consecutive facets: start, end, middle.
                           The body is on the left of a facet, its outward normal on the right

    Raises
    ------
    MeshError
        If shapes or node numbers disagree, corners are not numbered first, or a triangle is
        inverted.
    """

    points: Array
    triangles: Index
    boundaries: Mapping[str, Index]

    def __post_init__(self) -> None:
        """Check shapes, node numbers and numbering, and that no triangle is inverted; MeshError if
        not.
        """
        freeze(self, points=self.points)
        if self.points.ndim != 2 or self.points.shape[0] != 2:
            raise MeshError(f"points of a mesh = {self.points.shape}, must be (2, n)")
        named = {name: _index(part, 3, self.points) for name, part in self.boundaries.items()}
        object.__setattr__(self, "triangles", _index(self.triangles, 6, self.points))
        object.__setattr__(self, "boundaries", MappingProxyType(named))
        if self.triangles[:3].max() >= self.triangles[3:].min():
            raise MeshError("node numbers of a mesh = mixed, must be corners before mid-side nodes")
        a, b, c = (self.points[:, self.triangles[k]] for k in range(3))
        doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if not (doubled > 0).all():
            raise MeshError(f"inverted triangles = {int((~(doubled > 0)).sum())}, must be 0")

    @property
    def corners(self) -> int:
        """Number of corner nodes; all further nodes are mid-side nodes."""
        return int(self.triangles[:3].max()) + 1

    @cached_property
    def sha256(self) -> str:
        """SHA-256 of points and triangles."""
        digest = hashlib.sha256(np.ascontiguousarray(self.points, dtype="<f8").tobytes())
        digest.update(np.ascontiguousarray(self.triangles, dtype="<i8").tobytes())
        return digest.hexdigest()

    def jacobian(self, xi: float, eta: float) -> Array:
        """Jacobian (m, 2, 2) of the position by the reference coordinates (xi, eta), m.

        Entry [k, i, j] is component i by coordinate j; corners are (0, 0), (1, 0), (0, 1).
        """
        a, b, c, ab, bc, ca = (self.points[:, row] for row in self.triangles)
        rest = 1.0 - xi - eta
        by_xi = (4 * xi - 1) * b - (4 * rest - 1) * a + 4 * (rest - xi) * ab + 4 * eta * (bc - ca)
        by_eta = (4 * eta - 1) * c - (4 * rest - 1) * a + 4 * (rest - eta) * ca + 4 * xi * (bc - ab)
        return np.stack([by_xi, by_eta]).transpose(2, 1, 0)

    def facet_triples(self, name: str) -> Index:
        """Facets (3, k) of a boundary: start, end and mid-side node.

        Raises
        ------
        MeshError
            If there is no boundary of that name.
        """
        if name not in self.boundaries:
            raise MeshError(f"boundary '{name}', must be one of {', '.join(self.boundaries)}")
        return self.boundaries[name]

    def boundary_nodes(self, name: str) -> Index:
        """Node numbers of a boundary, ascending."""
        return np.unique(self.facet_triples(name))

    def transformed(self, angle: float, shift: ArrayLike) -> BodyMesh:
        """Body rotated by `angle` (rad) about the origin, then translated by `shift` (2,), m."""
        points = rotation(angle) @ self.points + finite("shift", shift)[:, None]
        return replace(self, points=points)

    def to_skfem(self) -> MeshTri2:
        """Mesh as ``skfem.MeshTri2``: same elements in the same order, boundaries by name.

        Corners keep their numbers; mid-side nodes may not, see `dof_map`.

        ``skfem.FacetBasis`` inverts the curved mapping to 1e-12 of a facet, which round-off
        permits only for coordinates below about 1000 facet lengths. Shift the contact to the
        origin first (`transformed`), or integrate along `facet_triples`.
        """
        from skfem import MeshTri2

        mesh = MeshTri2(
            np.ascontiguousarray(self.points), np.ascontiguousarray(self.triangles, dtype=np.int32)
        )
        count = self.corners
        keys = mesh.facets.min(axis=0).astype(np.int64) * count + mesh.facets.max(axis=0)
        order = np.argsort(keys)
        named = {}
        for name, (start, end, _) in self.boundaries.items():
            own = np.minimum(start, end) * count + np.maximum(start, end)
            named[name] = order[np.searchsorted(keys, own, sorter=order)].astype(np.int32)
        return mesh.with_boundaries(named)

    def dof_map(self, basis: AbstractBasis) -> NDArray[np.int64]:
        """Degrees of freedom (2, n) of the x and y components at every node.

        Parameters
        ----------
        basis : AbstractBasis    of ``ElementVector(ElementTriP2())`` on the mesh of `to_skfem`

        Returns
        -------
        array (2, n)    ``u[mesh.dof_map(basis)]`` is a solution ``u`` at the nodes of this mesh
        """
        rows = basis.dofs.element_dofs
        if rows.shape != (12, self.triangles.shape[1]):
            raise MeshError(
                f"degrees of freedom = {rows.shape}, "
                f"must be (12, {self.triangles.shape[1]}): a vector P2 basis of this mesh"
            )
        dofs = np.empty((2, self.points.shape[1]), dtype=np.int64)
        for k, nodes in enumerate(self.triangles):
            dofs[:, nodes] = rows[2 * k : 2 * k + 2]
        return dofs


def _index(values: ArrayLike, rows: int, points: Array) -> Index:
    """`values` as read-only node numbers (rows, k) of `points` (2, n).

    Raises
    ------
    MeshError
        If they do not have that shape, or a number is not one of the n nodes.
    """
    array = np.array(values, dtype=np.int64)
    if array.ndim != 2 or array.shape[0] != rows or array.shape[1] == 0:
        raise MeshError(f"node numbers of a mesh = {array.shape}, must be ({rows}, k)")
    if array.min() < 0 or array.max() >= points.shape[1]:
        raise MeshError(f"node number of a mesh = {array.max()}, must be in 0..{points.shape[1]}")
    array.setflags(write=False)
    return array


def _body(mesh: Triangulation) -> BodyMesh:
    return BodyMesh(mesh.points, mesh.triangles, mesh.boundaries)


def _discretised(loops: list[list[OutlinePiece]], size: SizeField) -> list[list[Facets]]:
    return [[facets(piece, size) for piece in loop] for loop in loops]


def _zone(sizing: ElementSize, centre: float) -> Zone | None:
    """Zone of equal facets about the arc length `centre`, m, shifted by the sizing's phase; None
    without a contact.
    """
    if sizing.contact_size is None or not sizing.refined:
        return None
    step = sizing.contact_size
    return Zone(centre + sizing.phase * step, step, sizing.steps)


def roller_mesh(
    radius: float, hub_radius: float, contact_angle: float, sizing: ElementSize
) -> BodyMesh:
    """Mesh of a roller disc centred on the origin, refined at the rim point at `contact_angle`.

    Parameters
    ----------
    radius, hub_radius : float    outer radius and radius of the hole, m; 0 makes a full disc
    contact_angle : float         angle of the contact, rad; sets ``sizing.contact_point``
    sizing : ElementSize

    Returns
    -------
    BodyMesh
        With boundaries "rim" and, if there is a hole, "hub".

    Raises
    ------
    InputError
        If a radius is out of bounds.
    MeshError
        If the region cannot be meshed.
    """
    positive("roller.radius", radius, "m")
    if not 0 <= hub_radius < 0.99 * radius:
        raise InputError("roller.hub_radius", hub_radius, f"in 0..{0.99 * radius:g} m")
    direction = np.array([np.cos(contact_angle), np.sin(contact_angle)])
    sizing = replace(sizing, contact_point=radius * direction)
    size = sizing.field().capped(2 * np.pi * radius / EDGES_PER_TURN)
    turn = 2 * np.pi
    loops = [[arc("rim", radius, contact_angle, contact_angle + turn, zone=_zone(sizing, 0.0))]]
    if hub_radius > 0:
        size = size.with_spot((0.0, 0.0), turn * hub_radius / EDGES_PER_TURN, hub_radius)
        size = size.capped(radius - hub_radius)
        loops.append([arc("hub", hub_radius, turn, 0.0)])
    return _body(triangulate(_discretised(loops, size), size))


def block_mesh(width: float, depth: float, sizing: ElementSize) -> BodyMesh:
    """Mesh of the rectangle [-width/2, width/2] x [-depth, 0], m, refined at the contact point of
    `sizing`, if it has one.

    Returns
    -------
    BodyMesh
        With boundaries "top" (y = 0), "bottom", "left" and "right".

    Raises
    ------
    InputError
        If a length is not positive, or the contact is not on the top.
    """
    positive("block.width", width, "m")
    positive("block.depth", depth, "m")
    half = 0.5 * width
    back = [line("bottom", np.array([-half, -depth]), np.array([half, -depth]))]
    return _rectangle(width, depth, back, sizing)


def face_mesh(
    width: float,
    thickness: float,
    stem_diameter: float,
    sizing: ElementSize,
    radius: float | None = None,
) -> BodyMesh:
    """Mesh of the block of a follower's face; the cross-section of the stem is a boundary of its
    back.

    The face, on which the cam runs, is the top of the block and touches y = 0 at the origin.

    Parameters
    ----------
    width : float            along the face, in x, m
    thickness : float        of the block, in y, along the stem, m
    stem_diameter : float    m; a stem wider than the face counts as wide as the face
    sizing : ElementSize     refined at its contact point, on the top, if it has one
    radius : float or None   of a curved face, m; None: flat

    Returns
    -------
    BodyMesh
        With boundaries "top", "left", "right", "stem" and, where the stem is narrower than the
        face, "back_left" and "back_right".

    Raises
    ------
    InputError
        If a length is not positive, a curved top is wider than its circle or deeper than the block,
        or the contact is not on the top.
    """
    positive("follower.face.width", width, "m")
    positive("follower.face.thickness", thickness, "m")
    positive("follower.stem_diameter", stem_diameter, "m")
    half, stem = 0.5 * width, 0.5 * min(stem_diameter, width)
    corners = [(x, -thickness) for x in (-half, -stem, stem, half)]
    names = ("back_left", "stem", "back_right")
    back = [
        line(name, np.array(start), np.array(end))
        for name, start, end in zip(names, corners[:-1], corners[1:], strict=True)
        if start != end
    ]
    if radius is not None and not half <= radius:
        raise InputError("follower.face.width", width, f"<= {2.0 * radius:g} m, twice the radius")
    if not (sunk := float(sagitta(half, radius))) < thickness:
        raise InputError("follower.face.thickness", thickness, f"> {sunk:g} m, of the curved face")
    return _rectangle(width, thickness, back, sizing, radius)


def sagitta(x: ArrayLike, radius: float | None) -> Array:
    """Depth (...), m, of a round surface below its tangent at a distance x, m; 0 of a flat one."""
    if radius is None:
        return np.zeros(np.shape(x))
    square = np.square(x)
    return np.asarray(square / (radius + np.sqrt(radius**2 - square)))


def _rectangle(
    width: float,
    depth: float,
    back: list[OutlinePiece],
    sizing: ElementSize,
    radius: float | None = None,
) -> BodyMesh:
    """Mesh of the rectangle [-width/2, width/2] x [-depth, 0], m; `back` are the pieces of its
    lower edge from left to right, named as boundaries.

    A contact point in `sizing` must be on the upper edge, which is refined beside it; `radius`: of
    a curved upper edge, see `face_mesh`.
    """
    half = 0.5 * width
    zone = None
    if sizing.contact_point is not None:
        x, y = sizing.contact_point
        if not (abs(x) < half and abs(y + sagitta(x, radius)) <= 1e-9 * width):
            raise InputError("sizing.contact_point", f"({x:g}, {y:g})", "on the top of the block")
        along = half - x
        if radius is not None:
            along = radius * (np.arcsin(half / radius) - np.arcsin(x / radius))
        zone = _zone(sizing, float(along))
    sunk = float(sagitta(half, radius))
    a, b, c, d = np.array([[-half, -depth], [half, -depth], [half, -sunk], [-half, -sunk]])
    size = sizing.field().capped(0.5 * min(width, depth))
    for piece in back:  # a shoulder shorter than the elements beside it would make slivers
        middle = piece.at(np.array([0.5 * piece.length]))
        if piece.length < float(size(middle)[0]):
            size = size.with_spot(middle[:, 0], piece.length, piece.length)
    top = line("top", c, d, zone)
    if radius is not None:
        turned = float(np.arcsin(half / radius))
        ends = 0.5 * np.pi - turned, 0.5 * np.pi + turned
        top = arc("top", radius, *ends, centre=(0.0, -radius), zone=zone)
    loop = [*back, line("right", b, c), top, line("left", d, a)]
    return _body(triangulate(_discretised([loop], size), size))


def half_disc_mesh(radius: float, sizing: ElementSize) -> BodyMesh:
    """Mesh of the half disc y <= 0 of a radius, m, about the origin, refined there, where the
    contact patch is.

    One quarter is meshed and mirrored: the mesh is symmetric about x = 0 to the last bit.

    Returns
    -------
    BodyMesh
        With boundaries "top" (y = 0) and "arc".

    Raises
    ------
    InputError
        If the radius is not positive, or ``sizing.phase`` is not 0, as symmetry requires.
    """
    positive("patch.radius", radius, "m")
    if sizing.phase != 0:
        raise InputError("sizing.phase", sizing.phase, "0 for a symmetric patch")
    sizing = replace(sizing, contact_point=np.zeros(2))
    size = sizing.field().capped(2 * np.pi * radius / EDGES_PER_TURN)
    origin, right, below = np.array([[0.0, 0.0], [radius, 0.0], [0.0, -radius]])
    quarter = [
        line("axis", origin, below, _zone(sizing, 0.0)),
        arc("arc", radius, -0.5 * np.pi, 0.0),
        line("top", right, origin, _zone(sizing, radius)),
    ]
    # Its outline does not follow from a solution: only the last bits of sine and cosine differ.
    half = triangulate(_discretised([quarter], size), size, grid_bits=18)
    return _mirrored(half, "axis")


def _mirrored(half: Triangulation, axis: str) -> BodyMesh:
    """Mesh of `half` (x >= 0) and its mirror image in x = 0, joined at the nodes of its boundary
    `axis`.
    """
    shared = np.unique(half.boundaries[axis])
    count, corners = half.points.shape[1], int(half.triangles[:3].max()) + 1
    own = np.setdiff1d(np.arange(count), shared)
    new_corners = int((own < corners).sum())
    # the mid-side nodes of the half are numbered after the corners of the image
    kept = np.arange(count) + np.where(np.arange(count) < corners, 0, new_corners)
    image = kept.copy()
    image[own[:new_corners]] = corners + np.arange(new_corners)
    image[own[new_corners:]] = count + np.arange(new_corners, own.size)
    points = np.empty((2, count + own.size))
    points[:, image] = half.points * [[-1.0], [1.0]]
    points[:, kept] = half.points
    points[0, kept[shared]] = 0.0
    triangles = np.hstack([kept[half.triangles], image[half.triangles[[0, 2, 1, 5, 4, 3]]]])
    boundaries = {}
    for name, facet in half.boundaries.items():
        if name != axis:
            mirrored = image[facet[[1, 0, 2], ::-1]]
            parts = [kept[facet], mirrored]
            # consecutive facets: the half that ends on the axis is first
            boundaries[name] = np.hstack(parts if facet[1, -1] in shared else parts[::-1])
    return BodyMesh(points, triangles, boundaries)


def cam_mesh(
    contour: ContourLike,
    bore_radius: float,
    keyway: KeywayLike | None,
    sizing: ElementSize,
    counter_hole: HoleLike | None = None,
    refinement: float = 1.0,
) -> BodyMesh:
    """Mesh of the cam, refined at the contact point on its contour.

    Parameters
    ----------
    contour : ContourLike           ``points(theta)``, ``normal(theta)``, ``curvature(theta)``
    bore_radius : float             m, bore centred on the origin
    keyway : KeywayLike or None     slot into the bore: width, depth (m), angle (rad)
    sizing : ElementSize
    counter_hole : HoleLike or None   round hole, clear of bore and contour
    refinement : float              divides the element size everywhere outside the contact zone

    Returns
    -------
    BodyMesh
        With boundaries "contour", "bore" and, if there is one, "keyway" and "counter_hole".
        All nodes of "contour" lie on the contour itself.

    Raises
    ------
    InputError
        If a dimension is out of bounds or the contact point is not on the contour.
    GeometryError
        If the contour is undercut or crosses itself, or bore, keyway or hole reaches it.
    MeshError
        If the region cannot be meshed.
    """
    hole = hole_pieces(bore_radius, keyway)
    path = trace(contour)
    size = cam_size(path, bore_radius, keyway, sizing)
    loops = [[contour_piece(path, sizing)], hole]
    if counter_hole is not None:
        size = hole_size(size, path, counter_hole)
        x, y = counter_hole.centre.tolist()
        turn = 2 * np.pi
        loops.append([arc("counter_hole", counter_hole.radius, turn, 0.0, (x, y))])
    size = size.refined(refinement)
    return _body(triangulate(_discretised(loops, size), size))


def rim_mesh(
    wall: ContourLike, outer_radius: float, sizing: ElementSize, refinement: float = 1.0
) -> BodyMesh:
    """Mesh of the rim of a disc between the outer wall of its groove and its outer circle.

    Parameters
    ----------
    wall : ContourLike      outer wall: its normals point inwards, into the groove
    outer_radius : float    of the disc, m
    sizing : ElementSize    refined at a contact point on the wall
    refinement : float      divides the element size everywhere outside the contact zone

    Returns
    -------
    BodyMesh
        With boundaries "contour", the wall, whose nodes lie on it, and "outer", the outer circle.

    Raises
    ------
    InputError
        If the contact point is not on the wall.
    GeometryError
        If the wall is undercut or crosses itself, or reaches the outer circle.
    MeshError
        If the region cannot be meshed.
    """
    path = trace(Backwards(wall))
    size = rim_size(path, outer_radius, sizing)
    turn = 2 * np.pi
    loops = [[arc("outer", outer_radius, 0.0, turn)], [contour_piece(path, sizing)]]
    size = size.refined(refinement)
    return _body(triangulate(_discretised(loops, size), size))


def facet_shapes(s: Array | float) -> Array:
    """Quadratic shape functions (3, ...) of start, end and mid-side node at s in 0 to 1."""
    s = np.asarray(s)
    return np.array([(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)])
