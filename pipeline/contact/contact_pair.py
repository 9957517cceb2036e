"""Cam and follower as a contact pair: shapes, materials, and the tiers that solve them.

Three tiers answer the same question with growing cost: the closed form; the two-scale
finite-element solution of every angle (`pair_history`); the full two-body finite elements at
chosen angles (`pair_certificate`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import HoleLike, KeywayLike
from camwright.geometry.errors import ContactError
from camwright.meshes.body_mesh import BodyMesh, cam_mesh
from camwright.meshes.element_size import Sizing
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.body_compliance import Correction, LoadedBody
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_patch import contact_patch, solve_patches
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, Springs
from camwright.pipeline.contact.follower_body import EDGES_ACROSS_WALL, FollowerBody

# Beyond this ratio of half-width to relative radius the flat patch is off by more than 0.5 %.
_FLAT_LIMIT = 0.1
# Finer changes the largest shear by less than 1e-4.
_GRID_OF_CYCLE_MESH = 120
TWO_SCALE = "two-scale finite elements: contact patch and bodies"


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Cam and follower: contour, effective width of the line contact (m), bodies, materials."""

    contour: Contour
    width: float
    bore_radius: float
    keyway: KeywayLike | None
    cam: Elastic
    follower: FollowerBody
    counter_hole: HoleLike | None = None

    @property
    def contact_modulus(self) -> float:
        other = self.follower.material
        return hertz.contact_modulus(
            self.cam.modulus, self.cam.poisson, other.modulus, other.poisson
        )

    def relative_radius(self, theta: ArrayLike) -> Array:
        """Relative radius of curvature (...), m; 1/R = 1/r_r + 1/r_c; a face is endlessly round.

        Raises
        ------
        ContactError
            If the cam is so hollow that the follower does not fit.
        """
        curvature = self.contour.follower_curvature + self.contour.curvature(theta)
        if not (curvature > 0).all():
            worst = float(np.degrees(np.atleast_1d(theta)[np.argmin(np.atleast_1d(curvature))]))
            name = self.follower.name
            raise ContactError(f"the {name} does not fit the hollow of the cam at {worst:.3f} deg")
        return 1 / curvature

    def gap(self, theta: Array, xi: Array) -> Array:
        """Distance (n, q) between contour and follower, along the normal, before loading.

        theta (n,) rad; xi (n, q) m along the tangent of a contact frame, which runs clockwise,
        against the contour's own.
        """
        return self.contour.follower_gap(xi) - self.contour.surface_offset(theta, -xi)


@dataclass(frozen=True, eq=False)
class CycleBodies:
    """Cam and follower on coarse meshes, factored once, for the contact at every angle."""

    cam: LoadedBody
    follower: LoadedBody

    @classmethod
    def meshed(cls, pair: ContactPair) -> CycleBodies:
        """Bodies of a pair; the element size follows the outline and the thinnest wall."""
        outline = float(pair.contour.perimeter())
        depth = 0.0 if pair.keyway is None else pair.keyway.depth
        wall = float(pair.contour.radius_min().value) - pair.bore_radius - depth
        cam = cam_mesh(
            pair.contour,
            pair.bore_radius,
            pair.keyway,
            Sizing(far_size=min(outline / _GRID_OF_CYCLE_MESH, wall / EDGES_ACROSS_WALL)),
            pair.counter_hole,
        )
        cut = tuple(name for name in ("keyway", "counter_hole") if name in cam.boundaries)
        other = pair.follower
        mesh = other.coarse_mesh()
        facing = elastic_body(mesh, other.material, other.held, other.springs(mesh, None, 0.0))
        return cls(
            LoadedBody(elastic_body(cam, pair.cam, "bore"), "contour", cut),
            LoadedBody(facing, other.surface, other.free),
        )


def elastic_body(
    mesh: BodyMesh, material: Elastic, held: str, springs: Springs | None = None
) -> ElasticBody:
    """A body on its mesh; held nowhere but by its springs where `held` is empty."""
    return ElasticBody(mesh, material.modulus, material.poisson, held or {}, springs)


def closed_form_history(pair: ContactPair, theta: Array, normal_force: Array) -> ContactHistory:
    """Contact by Hertz alone, every field of it; for a look ahead, not for a verdict."""
    load = np.maximum(normal_force, 0.0) / pair.width
    radius = pair.relative_radius(theta)
    half_width, p0 = hertz.line_contact(load, radius, pair.contact_modulus)
    mises, depth = hertz.von_mises_peak(pair.cam.poisson)
    nothing = np.zeros(theta.size)
    return ContactHistory(
        line_load=load,
        relative_radius=radius,
        p0_hertz=p0,
        half_width_hertz=half_width,
        p0=p0,
        half_width=half_width,
        tau_max=hertz.SHEAR_MAX * p0,
        tau_any_plane=hertz.shear_any_plane_peak(pair.cam.poisson) * p0,
        tau_depth=hertz.SHEAR_MAX_DEPTH * half_width,
        von_mises=mises * p0,
        von_mises_depth=depth * half_width,
        residual_equilibrium=nothing,
        residual_complementarity=nothing,
        pressure=p0[:, None] * hertz.ELLIPSE,
        pressure_xi=half_width[:, None] * hertz.ELLIPSE_XI,
        method="closed form: Hertz line contact",
    )


def pair_history(
    pair: ContactPair, bodies: CycleBodies, theta: Array, normal_force: Array
) -> ContactHistory:
    """Contact at the cam angles theta (n,) rad under normal forces (n,) N.

    Two scales: pressures and near stresses from the finite-element patch, with the gap of the
    true contour; stress and bending of the real bodies from their correction fields. Where the
    contact is wider than a tenth of the relative radius the flat patch has no answer, and what
    it would have found is not a number there; Hertz stands beside it all the same.

    Raises
    ------
    ContactError
        If the contact is too wide for a patch, or its solution fails.
    """
    load = np.maximum(normal_force, 0.0) / pair.width
    radius = pair.relative_radius(theta)
    half_width, p0 = hertz.line_contact(load, radius, pair.contact_modulus)
    flat = half_width <= _FLAT_LIMIT * radius
    on = (load > 0) & flat
    results = {
        name: np.zeros(theta.size)
        for name in (
            "p0", "half_width", "tau_max", "tau_any_plane", "tau_depth",
            "von_mises", "von_mises_depth",
            "residual_equilibrium", "residual_complementarity",
        )
    }  # fmt: skip
    knots = contact_patch(pair.cam.poisson).shapes.centres
    results["pressure"] = np.zeros((theta.size, knots.size))
    results["pressure_xi"] = half_width[:, None] * knots
    if on.any():
        loaded = _loaded_positions(
            pair, bodies, theta[on], load[on], radius[on], half_width[on], p0[on]
        )
        for name, values in loaded.items():
            results[name][on] = values
    for values in results.values():
        values[~flat] = np.nan
    return ContactHistory(
        line_load=load,
        relative_radius=radius,
        p0_hertz=p0,
        half_width_hertz=half_width,
        method=TWO_SCALE,
        **results,
    )


def _loaded_positions(
    pair: ContactPair,
    bodies: CycleBodies,
    theta: Array,
    load: Array,
    radius: Array,
    half_width: Array,
    p0: Array,
) -> dict[str, Array]:
    materials = (pair.cam, pair.follower.material)
    patches = (contact_patch(materials[0].poisson), contact_patch(materials[1].poisson))
    shares = tuple(pair.contact_modulus / each.plane_strain_modulus for each in materials)
    cam = bodies.cam.correction(pair.contour.points(theta), pair.contour.normal(theta))
    other = bodies.follower.correction(*pair.follower.contacts(pair.contour, theta))

    unit_xi, _ = patches[0].shapes.quadrature()
    xi = half_width[:, None] * unit_xi
    bend = load * (other.bend + cam.bend)
    # A surface that bulges under its load leaves less of a gap at the middle than beside it.
    gap = pair.gap(theta, xi) - 0.5 * bend[:, None] * xi**2
    contacts = solve_patches(
        patches, (shares[0], shares[1]), gap * (2 * radius / half_width**2)[:, None]
    )

    patch = patches[0]
    total = stress_on_patch(pair, cam, theta, load, half_width, p0, contacts.pressure * p0[:, None])
    shear, shear_at = patch.peaks(plane_stress_measures.shear_in_plane(total))
    mises, mises_at = patch.peaks(plane_stress_measures.von_mises(total, pair.cam.poisson))
    any_plane, _ = patch.peaks(plane_stress_measures.shear_any_plane(total, pair.cam.poisson))
    return {
        "p0": contacts.p0 * p0,
        "half_width": contacts.half_width * half_width,
        "tau_max": shear,
        "tau_any_plane": any_plane,
        "tau_depth": shear_at[1] * half_width,
        "von_mises": mises,
        "von_mises_depth": mises_at[1] * half_width,
        "residual_equilibrium": contacts.residual_equilibrium,
        "residual_complementarity": contacts.residual_complementarity,
        "pressure": contacts.pressure * p0[:, None],
    }


def stress_on_patch(
    pair: ContactPair,
    cam: Correction,
    theta: Array,
    load: Array,
    half_width: Array,
    p0: Array,
    pressure: Array,
) -> Array:
    """Stress (3, m, n), Pa, in the cam at the patch's m points for n positions.

    Components along the tangent of the contact frame and into the depth; the unit of length of
    the points is the position's Hertz half-width. From the pressures (n, k), Pa, at the knots,
    and what the real body adds.
    """
    patch = contact_patch(pair.cam.poisson)
    total = np.tensordot(patch.stress, pressure, axes=(2, 1))
    # Below a free curved surface the stress along it and the stress into it change so.
    curvature, depth = pair.contour.curvature(theta), patch.points[1][:, None] * half_width
    total[0] += load * (cam.along + depth * (cam.along_by_depth + 2 * curvature * cam.along))
    total[1] -= load * depth * curvature * cam.along
    total += hertz.curved_surface_stress(*patch.points)[:, :, None] * (p0 * half_width * curvature)
    return total
