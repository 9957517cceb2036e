"""Compliance of a real body beyond the half-plane: correction for its boundary and supports.

The field of a loaded body is that of the half-plane under the same pressure plus a correction,
which cancels the tractions of the half-plane on the free boundary and its displacements at held
boundaries and springs. The correction is smooth up to the contact (on a circle of radius R the
tractions of a point force vanish there): one coarse mesh, factorised once, gives it for the
contact at every cam angle.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Hashable, Iterator
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.elasticity import elastic_body, halfplane, sparse_factor
from camwright.pipeline.contact.elasticity.elastic_body import (
    CondensedBody,
    ElasticBody,
    StressRecovery,
)
from camwright.pipeline.contact.elasticity.halfplane import point_force_displacement
from camwright.pipeline.contact.elasticity.sparse_factor import back_end
from camwright.pipeline.contact.hertz import subsurface_displacement, subsurface_stress

_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
_BLIND_SHARE = 0.05
# Contacts solved together, limited by memory.
_BATCH = 180
# Contacts up to which the full body is faster than its condensation.
_FEW_CONTACTS = 8
# Parts of the displacements kept in memory: a turn of 720 positions.
_PARTS_KEPT = 4
# Surface nodes about a contact for the fit of its stress and bending.
_NEIGHBOURS = 10
# Modules whose source enters the cache key.
RECIPE = (sys.modules[__name__], elastic_body, sparse_factor, halfplane)


@dataclass(frozen=True, eq=False)
class CorrectionField:
    """Stress along the surface, and its curvature, of a real body beyond the half-plane, per N/m.

    along (count,) stress along the surface, Pa per N/m, the only component on a free surface;
    bend (count,) second derivative of the outward displacement along the surface, 1/m per N/m;
    along_by_depth (count,) its derivative by the depth, Pa/m per N/m, by beam bending.
    """

    along: Array
    bend: Array
    along_by_depth: Array

    def __post_init__(self) -> None:
        freeze(self, along=self.along, bend=self.bend, along_by_depth=self.along_by_depth)


@dataclass(frozen=True, eq=False)
class LoadedBody:
    """Elastic body with the free surface in contact and its other free boundaries."""

    body: ElasticBody
    surface: str
    also_free: tuple[str, ...] = ()

    @cached_property
    def _free_facets(self) -> Array:
        mesh = self.body.mesh
        return np.hstack([mesh.facet_triples(n) for n in (self.surface, *self.also_free)])

    @cached_property
    def _quadrature(self) -> tuple[Array, Array, scipy.sparse.csr_array]:
        """Gauss points (2, q) on the free surface, m, outward normals times weights (2, q), m, and
        values of the nodal shapes there (nodes, q).
        """
        triples = self._free_facets
        corners = self.body.mesh.points[:, triples]
        s = (1 + _GAUSS_POINTS) / 2
        shapes = np.stack([(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)])
        slopes = np.stack([4 * s - 3, 4 * s - 1, 4 - 8 * s])
        points = np.einsum("ckf,kq->cfq", corners, shapes)
        tangents = np.einsum("ckf,kq->cfq", corners, slopes)
        # The body lies on the left of a facet: the outward normal points to its right.
        outward = np.stack([tangents[1], -tangents[0]]) * (_GAUSS_WEIGHTS / 2)
        facets, per_facet = triples.shape[1], s.size
        columns = np.arange(facets * per_facet).reshape(facets, per_facet)
        rows = np.broadcast_to(triples[:, :, None], (3, facets, per_facet))
        values = np.broadcast_to(shapes[:, None, :], rows.shape)
        columns = np.broadcast_to(columns, rows.shape)
        entries = (values.ravel(), (rows.ravel(), columns.ravel()))
        shape = (self.body.mesh.points.shape[1], facets * per_facet)
        operator = scipy.sparse.coo_array(entries, shape=shape).tocsr()
        return points.reshape(2, -1), outward.reshape(2, -1), operator

    @cached_property
    def _facet_length(self) -> float:
        start, end, _ = self.body.mesh.facet_triples(self.surface)
        steps = self.body.mesh.points[:, end] - self.body.mesh.points[:, start]
        return float(np.hypot(*steps).max())

    def correction(self, contacts: Array, normals: Array) -> CorrectionField:
        """Correction at contact points (2, count) with outward normals (2, count).

        Cached on disk by mesh, supports, material and contacts.
        """
        kept = self.kept(
            "body", contacts, normals, lambda: self._displacement_slopes(contacts, normals), RECIPE
        )
        return self._as_correction(kept["slope"], kept["bend"])

    def kept(
        self,
        kind: str,
        contacts: Array,
        normals: Array,
        compute: Callable[[], disk_cache.Arrays],
        modules: tuple[ModuleType, ...],
        *more: Hashable,
    ) -> disk_cache.Arrays:
        """Arrays of the body under unit loads at contacts, from the disk cache or computed.

        See `disk_cache.kept`; `more` are further inputs that decide the arrays.
        """
        return disk_cache.kept(kind, (*self._key(contacts, normals), *more), compute, modules)

    def _key(self, contacts: Array, normals: Array) -> tuple[Hashable, ...]:
        """Inputs of a correction for the cache key: mesh with contour, bore, keyway and hub,
        supports, springs, elastic constants, library of the solver, contacts (2, count), m, and
        normals (2, count).
        """
        body = self.body
        free = np.ascontiguousarray(self._free_facets, dtype="<i8")
        places = np.ascontiguousarray([contacts, normals], dtype="<f8")
        return (
            body.mesh.sha256,
            *(hashlib.sha256(v.tobytes()).hexdigest() for v in (free, body.held_dofs, places)),
            *self._springs_key,
            (float(body.modulus), float(body.poisson)),
            back_end(),
        )

    @property
    def _springs_key(self) -> tuple[str, ...]:
        """Hashes of the springs for the cache key; () without springs."""
        springs = self.body.springs
        if springs is None:
            return ()
        return tuple(
            hashlib.sha256(np.ascontiguousarray(part, dtype="<f8").tobytes()).hexdigest()
            for part in (springs.ways, springs.stiffness)
        )

    def _displacement_slopes(self, contacts: Array, normals: Array) -> dict[str, Array]:
        """Slope of the tangential and bend of the outward displacement (count,) by name."""
        parts = [
            self._at_contacts(displaced, contacts[:, part], normals[:, part])
            for part, displaced in self.displacements(contacts, normals)
        ]
        slope, bend = np.concatenate(parts, axis=1)
        return {"slope": slope, "bend": bend}

    def displacements(
        self, contacts: Array, normals: Array
    ) -> Iterator[tuple[slice[int, int, None], Array]]:
        """Contacts in parts, and the displacement (2, m, part), m per N/m, that the correction has
        at the nodes `condensed_nodes` (m,) under a unit line load at each contact of the part.

        The last parts are kept in memory: corrections and stress at a bore follow from the same
        displacement.

        Parameters
        ----------
        contacts, normals : array (2, count)   points on the free surface, m; outward normals
        """
        few = contacts.shape[1] <= _FEW_CONTACTS
        for start in range(0, contacts.shape[1], _BATCH):
            part = slice(start, start + _BATCH)
            at, up = contacts[:, part], normals[:, part]
            places = few, at.tobytes(), up.tobytes()
            displaced = self._last.pop(places, None)
            if displaced is None:
                loads, held = self._cancelling_loads(at, up)
                if few:
                    displaced = self.body.displacement(loads, held)[:, self.condensed_nodes]
                else:
                    loads = loads[:, self.condensed_nodes]
                    displaced = self._condensed.displacement(loads, held)
            self._last[places] = displaced
            if len(self._last) > _PARTS_KEPT:
                del self._last[next(iter(self._last))]
            yield part, displaced

    @cached_property
    def _last(self) -> dict[tuple[bool, bytes, bytes], Array]:
        """Last parts of `displacements`, by whether contacts are few, contacts and normals."""
        return {}

    @cached_property
    def condensed_nodes(self) -> NDArray[np.int64]:
        """Numbers of the nodes loaded by the correction, and of those of elements at holes and
        supports, ascending (m,).
        """
        mesh = self.body.mesh
        at = np.zeros(mesh.points.shape[1], dtype=bool)
        at[self.body.held_nodes] = True
        for name in self.also_free:
            at[mesh.boundary_nodes(name)] = True
        beside = mesh.triangles[:, at[mesh.triangles].any(axis=0)]
        return np.unique(
            np.concatenate([self._free_facets.ravel(), beside.ravel(), self.body.beside_held])
        )

    @cached_property
    def _condensed(self) -> CondensedBody:
        return self.body.condensed(self.condensed_nodes)

    @property
    def _plane_strain_modulus(self) -> float:
        return self.body.modulus / (1 - self.body.poisson**2)

    def correction_displacement(self, contacts: Array, normals: Array) -> Array:
        """Displacement (2, nodes, count) by the correction in the whole body, m per N/m."""
        return self.body.displacement(*self._cancelling_loads(contacts, normals))

    def superposed(
        self, points: Array, correction: tuple[Array, Array], contacts: Array, normals: Array,
        line_load: Array, half_width: Array,
    ) -> tuple[Array, Array]:  # fmt: skip
        """Displacement (2, m, k), m, and stress (3, m, k), Pa, of the loaded body at points.

        The correction plus the field of a half-plane under a Hertz pressure in closed form.

        Parameters
        ----------
        points : (2, m) or (2, m, k)         m
        correction : (2, m, c), (3, m, c)    at the points, see `correction_fields`; c is 1 or k
        contacts, normals : (2, c)           m; outward normals
        line_load, half_width : (k,)         N/m, m; zero without contact
        """
        displaced, nodal = correction
        near = hertz_stress(points, contacts, normals, half_width)
        x, depth, tangents = _surface_coordinates(points, contacts, normals)
        size = np.where(half_width > 0, half_width, 1.0)
        sideways, down = subsurface_displacement(x / size, depth / size, self.body.poisson)
        down = down - 2 / np.pi * np.log(size)
        settled = sideways * tangents[:, None, :] - down * normals[:, None, :]
        load = np.where(line_load > 0, line_load, 0.0)
        return (
            load * (displaced + settled / self._plane_strain_modulus),
            load * (nodal + near),
        )

    def correction_of(self, displaced: Array, contacts: Array, normals: Array) -> CorrectionField:
        """Correction at contacts (2, count) from their `correction_fields`, m per N/m."""
        at_surface = displaced[:, self.condensed_nodes]
        return self._as_correction(*self._at_contacts(at_surface, contacts, normals))

    def _as_correction(self, slope: Array, bend: Array) -> CorrectionField:
        """Correction of the slopes of its displacement, see `_displacement_slopes`."""
        modulus = self._plane_strain_modulus
        return CorrectionField(along=modulus * slope, bend=bend, along_by_depth=modulus * bend)

    def correction_fields(self, contacts: Array, normals: Array) -> tuple[Array, Array]:
        """Displacement (2, nodes, count), m, and stress xx, yy, xy (3, nodes, count), Pa, of the
        correction in the whole body, per N/m of line load at each contact.

        Parameters
        ----------
        contacts, normals : array (2, count)   points on the free surface, m; outward normals
        """
        displaced = self.correction_displacement(contacts, normals)
        nodal = np.zeros((3, *displaced.shape[1:]))
        nodal[:, self._everywhere.nodes] = self._everywhere(displaced)
        return displaced, nodal

    @cached_property
    def _everywhere(self) -> StressRecovery:
        return StressRecovery(self.body, np.arange(self.body.mesh.triangles.shape[1]))

    def _unit_displacement(self, x: Array, depth: Array) -> Array:
        unit = point_force_displacement(x, depth, self.body.poisson)
        return unit / self._plane_strain_modulus

    def _cancelling_loads(self, contacts: Array, normals: Array) -> tuple[Array, Array]:
        """Nodal forces, -, and displacements of the held nodes, m per N/m, both (2, nodes, count),
        that cancel the half-plane under unit line loads at contacts: its tractions on the free
        boundary, its displacements at supports and springs.

        Parameters
        ----------
        contacts, normals : array (2, count)   points on the free surface, m; outward normals
        """
        points, outward, operator = self._quadrature
        arm = points[:, :, None] - contacts[:, None, :]
        depth = -np.einsum("cqk,ck->qk", arm, normals)
        square = (arm**2).sum(axis=0)
        flux = np.einsum("cqk,cq->qk", arm, outward)
        # The traction vanishes linearly towards the contact; nearer than this it is below the
        # round-off in the depth of the boundary.
        near = square < (_BLIND_SHARE * self._facet_length) ** 2
        intensity = np.where(near, 0.0, 2 / np.pi * depth * flux / np.where(near, 1, square) ** 2)
        traction = arm * intensity
        loads = np.stack([operator @ component for component in traction])
        far = self._half_plane_displacement(contacts, normals)
        if self.body.springs is not None:
            loads += self.body.springs.forces(far)
        return loads, np.negative(far, out=far)

    def _half_plane_displacement(self, contacts: Array, normals: Array) -> Array:
        """Displacement (2, nodes, count), m per N/m, of a half-plane under a unit line force at
        each contact, at the nodes that are held or on springs; zero elsewhere.

        Parameters
        ----------
        contacts, normals : array (2, count)   points on the free surface, m; outward normals
        """
        mesh, body = self.body.mesh, self.body
        nodes = body.held_nodes
        if body.springs is not None:
            nodes = np.union1d(nodes, np.flatnonzero(body.springs.ways.any(axis=(0, 1))))
        x, depth, tangents = _surface_coordinates(mesh.points[:, nodes], contacts, normals)
        along, into = self._unit_displacement(x, depth)
        field = np.zeros((2, mesh.points.shape[1], contacts.shape[1]))
        field[:, nodes] = along * tangents[:, None, :] - into * normals[:, None, :]
        return field

    def _at_contacts(self, displaced: Array, contacts: Array, normals: Array) -> Array:
        """Slope of the tangential displacement, 1 per N/m, and second derivative of the outward
        one, 1/m per N/m, along the surface at the contacts, (2, count).

        A cubic is fitted to the surface nodes about each contact, with weights that vanish at the
        outermost one: continuous when the contact passes a node.

        Parameters
        ----------
        displaced : array (2, m, count)        displacement at the condensed nodes, m per N/m
        contacts, normals : array (2, count)   points on the free surface, m; outward normals
        """
        mesh = self.body.mesh
        surface = np.searchsorted(self.condensed_nodes, mesh.boundary_nodes(self.surface))
        points = mesh.points[:, self.condensed_nodes[surface]]
        distance = np.hypot(*(points[:, :, None] - contacts[:, None, :]))
        nearest = np.argpartition(distance, _NEIGHBOURS, axis=0)[: _NEIGHBOURS + 1]
        distance = np.take_along_axis(distance, nearest, axis=0)
        reach = distance.max(axis=0)
        arm = points[:, nearest] - contacts[:, None, :]
        tangents = np.stack([normals[1], -normals[0]])
        x = np.einsum("cmk,ck->mk", arm, tangents) / reach
        weights = (1 - (distance / reach) ** 2) ** 2
        terms = np.stack([np.ones_like(x), x, x**2, x**3], axis=-1).transpose(1, 0, 2)
        inverse = np.linalg.pinv(terms * weights.T[:, :, None])
        near = displaced[:, surface[nearest], np.arange(contacts.shape[1])]
        sideways = np.einsum("cmk,ck->km", near, tangents) * weights.T
        outward = np.einsum("cmk,ck->km", near, normals) * weights.T
        slope = np.einsum("km,km->k", inverse[:, 1], sideways) / reach
        bend = 2 * np.einsum("km,km->k", inverse[:, 2], outward) / reach**2
        return np.stack([slope, bend])


def hertz_stress(points: Array, contacts: Array, normals: Array, half_width: Array) -> Array:
    """Stress xx, yy, xy (3, m, count), 1/m, of a half-plane under Hertz pressures of 1 N/m.

    At points (2, m) or (2, m, count), m; surfaces at contacts (2, count), m, with outward normals
    (2, count); half_width (count,), m; no stress where it is not positive. Of one contact there
    may be any number of half-widths.
    """
    x, depth, _ = _surface_coordinates(points, contacts, normals)
    size = np.where(half_width > 0, half_width, np.inf)
    x, depth = x / size, depth / size
    # A concave flank rises above the tangent. Beside the pressure the field continues there, as
    # that of a point force does: normal stresses are odd in the depth, the shear is even.
    above = np.where(depth < 0, -1.0, 1.0)
    near = subsurface_stress(x, np.where(np.abs(x) < 1, np.maximum(depth, 0.0), np.abs(depth)))
    near = near * (2 / (np.pi * size)) * np.stack([above, above, np.ones_like(above)])
    return from_contact_axes(near, normals)


def from_contact_axes(stress: Array, normals: Array) -> Array:
    """Stress xx, yy, xy (3, m, k) in the frame of the body from its components at the surface:
    normal stress along it, normal stress into the depth, and their shear (3, m, k).

    Parameters
    ----------
    normals : array (2, k) or (2, 1)   outward normals; the tangent is the normal turned by -90 deg
    """
    along, into, shear = stress
    n = normals[:, None, :]
    t = np.stack([n[1], -n[0]])
    return np.stack(
        [
            along * t[0] ** 2 + into * n[0] ** 2 - 2 * shear * t[0] * n[0],
            along * t[1] ** 2 + into * n[1] ** 2 - 2 * shear * t[1] * n[1],
            along * t[0] * t[1] + into * n[0] * n[1] - shear * (t[0] * n[1] + t[1] * n[0]),
        ]
    )


def _surface_coordinates(
    points: Array, contacts: Array, normals: Array
) -> tuple[Array, Array, Array]:
    """Coordinates along the tangents and depths below the contacts, both (m, count), m, of points,
    and the tangents (2, count).

    Parameters
    ----------
    points : array (2, m) or (2, m, count)   m
    contacts, normals : array (2, count)     m; outward normals, or one of each (2, 1)
    """
    arm = (points if points.ndim == 3 else points[:, :, None]) - contacts[:, None, :]
    tangents = np.stack([normals[1], -normals[0]])
    x = np.einsum("cmk,ck->mk", arm, np.broadcast_to(tangents, (2, arm.shape[2])))
    return x, -np.einsum("cmk,ck->mk", arm, np.broadcast_to(normals, (2, arm.shape[2]))), tangents
