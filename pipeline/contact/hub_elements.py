"""Cam on its shaft by plane finite elements: fit pressure, stress at the keyway root.

Plane stress: the flanks of the cam are free. The cam is a ring of its contour with bore, keyway and
fillets; the shaft is a solid disc, stiffer than with its own keyway. Bore and shaft touch without
friction and without tension at nodes that face one another; nothing touches within the mouth of
the keyway. All loads but the contact are solved once as unit loads. The force of the follower is
carried by the section of the shaft, the torque by the key alone; what the couples of contact
and key do not balance acts along the contour.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, rotation, uniform_turn
from camwright.geometry.errors import ContactError
from camwright.meshes import body_mesh, cam_outline, shaft_mesh
from camwright.meshes.body_mesh import BodyMesh, facet_shapes
from camwright.meshes.cam_outline import ContourLike
from camwright.meshes.element_size import ElementSize
from camwright.meshes.shaft_mesh import cam_on_shaft
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.elasticity import elastic_body, sparse_factor
from camwright.pipeline.contact.elasticity.elastic_body import (
    Elastic,
    ElasticBody,
    Springs,
    StressRecovery,
)

CONTACTS = 90
"""Contacts along the contour at which the unit force is solved; between them a periodic spline."""
_KEY_SAMPLES = 3600  # of the contour, for the key of the cache
_FAR_SIZE = 0.12  # element length over the bore radius
_SOFT = 1e-5  # of the modulus: springs against rigid motion, which carry no force
_ITERATIONS = 25
_SEAT_CONVERGED = 1e-9  # over the greatest nodal force, or over the greatest gap
_HEAVY = 1e3  # weight of the equilibrium in the first set of nodes in contact
_COMPLIANCE_ROUND_OFF = 1e-12  # over the greatest compliance
_LEAST_NODES = 3  # in contact, which hold the cam on its shaft
_LOADS_AT_ONCE = 16  # whose fields stay in the cache of the processor
_ROOT = 1.6  # root radii from a corner of the floor up to which the boundary counts as the root


class Slot(NamedTuple):
    """Keyway in the mesh: width, depth beyond the bore, fillet, m; angle, rad."""

    width: float
    depth: float
    angle: float
    fillet: float


class RotatingBody(NamedTuple):
    """Elastic constants and density, kg/m3, of a rotating body."""

    elastic: Elastic
    density: float


@dataclass(frozen=True, eq=False)
class SeatedCam:
    """Cam pressed on its shaft: meshes, materials, keyway, interference.

    Parameters
    ----------
    contour : ContourLike
    bore_radius : float         m
    slot : Slot                 None: no keyway
    flank_height : float        from the bore up to which the key presses on the hub, m
    cam, shaft : RotatingBody
    refinement : float          divides the element size
    """

    contour: ContourLike
    bore_radius: float
    slot: Slot | None
    flank_height: float
    cam: RotatingBody
    shaft: RotatingBody
    refinement: float = 1.0

    @cached_property
    def units(self) -> HubUnits:
        """Solutions under unit loads, cached on disk."""
        theta = uniform_turn(_KEY_SAMPLES)
        outline = np.ascontiguousarray(self.contour.points(theta), dtype="<f8")
        inputs = (
            hashlib.sha256(np.round(outline, 12).tobytes()).hexdigest(),
            (float(self.bore_radius), float(self.flank_height), float(self.refinement)),
            None if self.slot is None else tuple(float(each) for each in self.slot),
            tuple((b.elastic, float(b.density)) for b in (self.cam, self.shaft)),
            sparse_factor.back_end(),
        )
        modules = (
            *(sys.modules[__name__], shaft_mesh, body_mesh, cam_outline),
            *(elastic_body, sparse_factor),
        )
        return HubUnits(disk_cache.kept("hub", inputs, lambda: _solved(self), modules))


def plane_stress(elastic: Elastic) -> Elastic:
    """Equivalent elastic constants by which plane strain has the stiffness of plane stress."""
    e, nu = elastic.modulus, elastic.poisson
    return Elastic(e * (1.0 + 2.0 * nu) / (1.0 + nu) ** 2, nu / (1.0 + nu))


class HubLoads(NamedTuple):
    """Loads on a seated cam at n cam angles, per unit width.

    theta (n,) rad; force (n,) of the contact, N/m; couple (n,) of the key on the cam, N, positive
    counter-clockwise; speed of the cam, rad/s; interference: of the radii at rest, m, negative for
    a clearance.
    """

    theta: Array
    force: Array
    couple: Array
    speed: float
    interference: float


class HubState(NamedTuple):
    """Stress (n, m), Pa, along the boundary at the keyway root; seat pressure (n, k), Pa.

    opened (n,): whether a part of the seat has lost its contact.
    """

    stress: Array
    pressure: Array
    opened: NDArray[np.bool_]


class HubUnits:
    """Solutions of a cam on its shaft under unit loads.

    Parameters
    ----------
    arrays : mapping
        places (2, m) of the root, m; normals (2, k) of the seat; share (k,) length of the seat per
        node, m; compliance (k, k) of the gap under nodal forces, m per N/m; gap (k, l), stress
        (m, l) and resultant (2, l) of the unit loads: couples 1 and -1 N m of the key, spin of
        1 rad/s, `CONTACTS` contacts;
        of_seat (m, k) stress under nodal forces
    """

    def __init__(self, arrays: Mapping[str, Array]) -> None:
        self._arrays = arrays
        self.places, self.normals = arrays["places"], arrays["normals"]
        self._matrix = self._saddle(np.ones(self.normals.shape[1], dtype=bool))

    def _saddle(self, closed: NDArray[np.bool_]) -> Array:
        """Matrix of nodal forces and translation of the cam with the closed nodes in contact."""
        normals = self.normals[:, closed]
        compliance = self._arrays["compliance"][np.ix_(closed, closed)]
        return np.block([[compliance, normals.T], [normals, np.zeros((2, 2))]])

    def _bonded(self, right: Array) -> Array:
        """Nodal forces (k, n) with every node in contact; right (k + 2, n)."""
        return np.asarray(np.linalg.solve(self._matrix, right)[: self.normals.shape[1]])

    def state(self, loads: HubLoads) -> HubState:
        """State under loads; by superposition where the seat stays closed, else by contact search.

        Raises
        ------
        ContactError
            If the search of the contact does not converge.
        """
        known = self._arrays
        closed_seat = np.append(np.full(self.normals.shape[1], loads.interference), [0.0, 0.0])
        rows = np.concatenate([-known["gap"], -known["resultant"]])
        right = closed_seat[:, None] + self._amplitudes(rows, loads)
        forces = self._bonded(right)
        torn = (forces < -_SEAT_CONVERGED * np.abs(forces).max()).any(axis=0)
        if torn.any():
            forces[:, torn] = self._searched(right[:, torn], forces[:, torn])
        stress = known["of_seat"] @ forces + self._amplitudes(known["stress"], loads)
        return HubState(stress.T, (forces / known["share"][:, None]).T, torn)

    def unloaded(self, interference: float) -> float:
        """Mean pressure of the fit at rest without load, Pa; 0 of a clearance. Interference of the
        radii in m.
        """
        if interference <= 0.0:
            return 0.0
        still = np.zeros(1)
        pressed = self.state(HubLoads(still, still, still, 0.0, interference)).pressure[0]
        share = self._arrays["share"]
        return float(pressed @ share / share.sum())

    def _amplitudes(self, units: Array, loads: HubLoads) -> Array:
        """Values (r, n) of a quantity under n loads, from its values `units` (r, l) under the unit
        loads; the contact force is interpolated over the cam angle.
        """
        ahead, behind, spin = units[:, :3].T
        contacts = units[:, 3:]
        turn = np.append(uniform_turn(contacts.shape[1]), FULL_TURN)
        around = scipy.interpolate.CubicSpline(
            turn, np.concatenate([contacts, contacts[:, :1]], axis=1), axis=1, bc_type="periodic"
        )
        key = np.where(loads.couple > 0, ahead[:, None], behind[:, None]) * np.abs(loads.couple)
        pushed = around(np.mod(loads.theta, FULL_TURN)) * loads.force
        return np.asarray(pushed + key + spin[:, None] * loads.speed**2)

    def _searched(self, right: Array, start: Array) -> Array:
        """Nodal forces (k, n) of the seat without tension, by the set of nodes in contact at each
        angle; right (k + 2, n): closing of the gap, m, and resultant; start (k, n): forces of a
        closed seat.
        """
        forces, closed = np.zeros_like(start), start[:, 0] > 0.0
        for column in range(right.shape[1]):
            forces[:, column], closed = self._touching(right[:, column], closed)
        return forces

    def _touching(self, right: Array, closed: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
        """Nodal forces (k,), N/m, without tension and the nodes in contact (k,), bool, at one
        angle.

        All nodes that pull or overlap change at once. Where that does not settle, the set of the
        least complementary energy, by non-negative least squares, is the next first one.

        Parameters
        ----------
        right : array (k + 2,)        closing of the gap at the nodes, m, and the resultant force
        closed : array (k,) of bool   nodes taken to be in contact at first

        Raises
        ------
        ContactError
            If the nodes in contact do not settle from either set.
        """
        touching = self._settled(right, closed)
        if touching is None:
            touching = self._settled(right, self._nodes_of_least_energy(right))
        if touching is None:
            raise ContactError(f"contact of the seat = not found in {_ITERATIONS} steps")
        return touching

    def _settled(
        self, right: Array, closed: NDArray[np.bool_]
    ) -> tuple[Array, NDArray[np.bool_]] | None:
        """Nodal forces (k,) without tension and the nodes in contact, by exchange from the set
        `closed`; None where the nodes do not settle. See `_touching`.
        """
        count, known = closed.size, self._arrays["compliance"]
        deep, give = _SEAT_CONVERGED * float(np.abs(right[:count]).max()), np.diag(known)
        for _ in range(_ITERATIONS):
            if closed.sum() < _LEAST_NODES:
                return None
            solved = np.zeros(count + 2)
            rows = np.append(closed, [True, True])
            solved[rows] = np.linalg.solve(self._saddle(closed), right[rows])
            nodal = solved[:count]
            gap = known @ nodal + self.normals.T @ solved[count:] - right[:count]
            wrong = np.where(closed, -nodal * give, -gap) > deep
            if not wrong.any():
                return np.maximum(nodal, 0.0), closed
            closed = closed ^ wrong
        return None

    def _nodes_of_least_energy(self, right: Array) -> NDArray[np.bool_]:
        """Whether each node (k,) is in contact, by non-negative least squares of the complementary
        energy.
        """
        count = self.normals.shape[1]
        root, inverse = self._roots
        # of the size of the compliance, so that equilibrium outweighs the energy
        heavy = _HEAVY * np.sqrt(np.trace(self._arrays["compliance"]) / count)
        rows = np.concatenate([root, heavy * self.normals])
        goal = np.concatenate([inverse @ right[:count], heavy * right[count:]])
        return np.asarray(scipy.optimize.nnls(rows, goal, maxiter=30 * count)[0] > 0.0)

    @cached_property
    def _roots(self) -> tuple[Array, Array]:
        """Square root of the compliance and its inverse."""
        values, ways = np.linalg.eigh(self._arrays["compliance"])
        size = np.sqrt(np.maximum(values, _COMPLIANCE_ROUND_OFF * values[-1]))
        return (ways * size) @ ways.T, (ways / size) @ ways.T


def _solved(seated: SeatedCam) -> dict[str, Array]:
    """The arrays of `HubUnits`, by finite elements: free cam and shaft, under nodal forces between
    them and under the unit loads.
    """
    radius, slot = seated.bore_radius, seated.slot
    sizing = ElementSize(far_size=_FAR_SIZE * radius)
    meshes = cam_on_shaft(seated.contour, radius, slot, sizing, seated.refinement)
    cam = _Free(meshes.cam, seated.cam, "contour")
    shaft = _Free(meshes.shaft, seated.shaft, "seat")
    normals = meshes.cam.points[:, meshes.of_bore] / radius
    loads = np.concatenate(
        [_key_forces(cam, seated), cam.spun()[..., None], _contact_forces(cam, seated)], 2
    )
    resultant = loads.sum(axis=1)
    seat = _at_nodes(cam, meshes.of_bore, normals)
    of_loads = cam.displacement(np.concatenate([seat, loads], axis=2))
    back = np.concatenate([_at_nodes(shaft, meshes.of_shaft, normals), shaft.spun()[..., None]], 2)
    yielded = shaft.displacement(back)
    of_cam = np.einsum("ck,ckl->kl", normals, of_loads[:, meshes.of_bore])
    of_shaft = np.einsum("ck,ckl->kl", normals, yielded[:, meshes.of_shaft])
    count = normals.shape[1]
    compliance = of_cam[:, :count] + of_shaft[:, :count]
    gap = of_cam[:, count:].copy()
    gap[:, 2] -= of_shaft[:, count]
    places, stress = _along_root(cam, seated, of_loads)
    return {
        "places": places,
        "normals": normals,
        "share": _shares(meshes.cam, "bore", meshes.of_bore),
        "compliance": 0.5 * (compliance + compliance.T),
        "gap": gap,
        "resultant": resultant,
        "of_seat": stress[:, :count],
        "stress": stress[:, count:],
    }


class _Free:
    """A body without supports, in plane stress; its loads are put in equilibrium first."""

    def __init__(self, mesh: BodyMesh, body: RotatingBody, outside: str) -> None:
        """Elastic body in plane stress on three soft springs against rigid motion, at nodes of the
        boundary `outside`, with its mass matrix.
        """
        from skfem import ElementTriP2
        from skfem.models.poisson import mass

        constants, count = plane_stress(body.elastic), mesh.points.shape[1]
        edge = mesh.facet_triples(outside)[0]
        third = edge.size // 3
        ways = np.zeros((3, 2, count))
        ways[0, 0, edge[0]] = ways[1, 1, edge[0]] = ways[2, 1, edge[third]] = 1.0
        ways[2, 0, edge[third]] = 1.0
        springs = Springs(ways=ways, stiffness=np.full(3, _SOFT * body.elastic.modulus))
        self.mesh = mesh
        self.body = ElasticBody(mesh, constants.modulus, constants.poisson, {}, springs)
        scalar = self.body.basis.with_element(ElementTriP2())
        weights = mass.assemble(scalar)
        number = np.empty(count, dtype=int)
        for k, nodes in enumerate(mesh.triangles):
            number[nodes] = scalar.element_dofs[k]
        self._mass = weights[number][:, number]
        self._even = np.asarray(self._mass @ np.ones(count))
        self._density = body.density
        self._turn = self._without_resultant(_tangential(mesh, outside)[..., None])

    def spun(self) -> Array:
        """Centrifugal forces (2, nodes), N/m, at 1 rad/s."""
        return np.stack([self._density * (self._mass @ each) for each in self.mesh.points])

    def couple(self, loads: Array) -> Array:
        """Couples (k,) of loads (2, nodes, k) about the axis."""
        x, y = self.mesh.points
        return np.asarray(x @ loads[1] - y @ loads[0])

    def displacement(self, loads: Array) -> Array:
        """Displacement (2, nodes, k), m, under loads (2, nodes, k), N/m, put in equilibrium first:
        their resultant acts evenly on the section, their couple along the boundary `outside`.
        """
        displacement = np.empty_like(loads)
        for first in range(0, loads.shape[2], _LOADS_AT_ONCE):
            few = slice(first, first + _LOADS_AT_ONCE)
            left = self._without_resultant(loads[..., few])
            left -= self._turn * (self.couple(left) / self.couple(self._turn))
            displacement[..., few] = self.body.displacement(left)
        return displacement

    def _without_resultant(self, loads: Array) -> Array:
        """Loads (2, nodes, k) with their resultant taken evenly by the section."""
        share = self._even[:, None] / self._even.sum()
        return np.asarray(loads - share * loads.sum(axis=1)[:, None])


def _tangential(mesh: BodyMesh, name: str) -> Array:
    """Nodal forces (2, nodes), m2, along the outline `name`, counter-clockwise, each the length
    that the node carries times its radius.
    """
    forces, radius = np.zeros_like(mesh.points), mesh.boundary_nodes(name)
    start, end, _ = mesh.facet_triples(name)
    weight = _nodal(mesh, name, np.hypot(*(mesh.points[:, end] - mesh.points[:, start])))
    forces[0, radius] = -(weight * mesh.points[1])[radius]
    forces[1, radius] = (weight * mesh.points[0])[radius]
    return forces


def _shares(mesh: BodyMesh, name: str, nodes: NDArray[np.int64]) -> Array:
    """Length (k,), m, of a round boundary about the axis that each of its nodes carries; `nodes`
    (k,): their numbers.
    """
    start, end, _ = mesh.facet_triples(name)
    chord = np.hypot(*(mesh.points[:, end] - mesh.points[:, start]))
    radius = np.hypot(*mesh.points[:, start])
    return _nodal(mesh, name, 2.0 * radius * np.arcsin(0.5 * chord / radius))[nodes]


def _nodal(mesh: BodyMesh, name: str, length: Array) -> Array:
    """Length (all nodes,), m, of a boundary that each node of the mesh carries, by Simpson's rule;
    zero off the boundary.

    Parameters
    ----------
    length : array (facets,)   of the facets of the boundary, m
    """
    carried = np.zeros(mesh.points.shape[1])
    for nodes, part in zip(mesh.facet_triples(name), (1.0, 1.0, 4.0), strict=True):
        np.add.at(carried, nodes, part / 6.0 * length)
    return carried


def _at_nodes(body: _Free, nodes: NDArray[np.int64], normals: Array) -> Array:
    """Unit forces (2, all nodes, k) on nodes (k,) along normals (2, k)."""
    loads = np.zeros((*body.mesh.points.shape, nodes.size))
    loads[:, nodes, np.arange(nodes.size)] = normals
    return loads


def _contact_forces(cam: _Free, seated: SeatedCam) -> Array:
    """Nodal forces (2, nodes, contacts) of a unit force, N/m, against the outward normal at each of
    the contacts, equally spaced in cam angle.
    """
    mesh, theta = cam.mesh, uniform_turn(CONTACTS)
    points, normals = seated.contour.points(theta), seated.contour.normal(theta)
    triples = mesh.facet_triples("contour")
    ends = mesh.points[:, triples]
    loads = np.zeros((*mesh.points.shape, CONTACTS))
    for k in range(CONTACTS):
        arm, chord = points[:, k, None] - ends[:, 0], ends[:, 1] - ends[:, 0]
        s = np.clip((arm * chord).sum(axis=0) / (chord * chord).sum(axis=0), 0.0, 1.0)
        facet = int(np.argmin(np.hypot(*(arm - s * chord))))
        for node, shape in zip(triples[:, facet], facet_shapes(s[facet]), strict=True):
            loads[:, node, k] -= shape * normals[:, k]
    return loads


def _key_forces(cam: _Free, seated: SeatedCam) -> Array:
    """Nodal forces (2, nodes, 2), 1/m, of an even pressure of the key on one flank, with a
    counter-clockwise couple of 1, and on the other, with one of -1; zero without a keyway.
    """
    mesh, slot = cam.mesh, seated.slot
    loads = np.zeros((*mesh.points.shape, 2))
    if slot is None:
        return loads
    local = rotation(-slot.angle) @ mesh.points
    top = seated.bore_radius + seated.flank_height
    across = rotation(slot.angle)[:, 1]
    triples = mesh.facet_triples("keyway")
    s, weights = np.polynomial.legendre.leggauss(8)
    for column, side in enumerate((1.0, -1.0)):
        on = (np.abs(side * local[1, triples] - 0.5 * slot.width) < 1e-9).all(axis=0)
        for facet in triples[:, on].T:
            low, high = sorted(local[0, facet[:2]])
            high_loaded = min(high, top)
            if high_loaded <= low:
                continue
            # exact integral of the shapes over the loaded part of a straight facet
            x = 0.5 * (low + high_loaded) + 0.5 * (high_loaded - low) * s
            at = (x - local[0, facet[0]]) / (local[0, facet[1]] - local[0, facet[0]])
            for node, shape in zip(facet, facet_shapes(at), strict=True):
                push = 0.5 * (high_loaded - low) * float(weights @ shape)
                loads[:, node, column] += side * push * across
    return loads / np.abs(cam.couple(loads))


def _along_root(cam: _Free, seated: SeatedCam, displacement: Array) -> tuple[Array, Array]:
    """Places (2, m), m, of the nodes at the root of the keyway, or of the bore without one, and
    stress (m, k) along the boundary there under displacements (2, nodes, k).
    """
    mesh, slot = cam.mesh, seated.slot
    name = "bore" if slot is None else "keyway"
    triples = mesh.facet_triples(name)
    tangent = np.zeros_like(mesh.points)
    start, end, middle = (mesh.points[:, row] for row in triples)
    ways = 4.0 * middle - 3.0 * start - end, 3.0 * end + start - 4.0 * middle, end - start
    for row, way in zip(triples, ways, strict=True):
        for component in range(2):
            np.add.at(tangent[component], row, way[component] / np.hypot(*way))
    nodes = mesh.boundary_nodes(name)
    if slot is not None:
        floor, half = seated.bore_radius + slot.depth, 0.5 * slot.width
        least = max(floor - _ROOT * slot.fillet, seated.bore_radius + seated.flank_height)
        x, y = rotation(-slot.angle) @ mesh.points[:, nodes]
        nodes = nodes[(x > least) & (np.abs(y) > half - _ROOT * slot.fillet)]
    near = np.flatnonzero(np.isin(mesh.triangles, nodes).any(axis=0))
    recovery = StressRecovery(cam.body, near)
    rows = np.searchsorted(np.sort(recovery.nodes), nodes)
    xx, yy, xy = recovery(displacement)[:, np.argsort(recovery.nodes)[rows]]
    cosine, sine = (tangent[:, nodes] / np.hypot(*tangent[:, nodes]))[..., None]
    along = xx * cosine**2 + yy * sine**2 + 2.0 * xy * cosine * sine
    return mesh.points[:, nodes], along
