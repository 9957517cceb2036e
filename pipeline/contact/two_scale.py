"""Two-scale contact over the turn: finite-element patch with compliance of the real bodies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.body_compliance import CorrectionField, LoadedBody
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.contact_history import GAP_ROUND_OFF_MAX, ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair, elastic_body
from camwright.pipeline.contact.contact_patch import contact_patch, solve_patches
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.plane_stress_measures import Index
from camwright.pipeline.contact.follower_body import EDGES_ACROSS_WALL, FollowerBody
from camwright.pipeline.contact.tiers import Tier

# Half-width over relative radius beyond which the error of the flat patch exceeds 0.5 %.
FLAT_LIMIT = 0.1
# Nodes of the gap along a patch, and the share of its last coefficients below which they suffice.
_GAP_NODES, _GAP_REST = 15, 1e-9
# Elements along the contour; more change the maximum shear by less than 1e-4.
_GRID_OF_CYCLE_MESH = 120


@dataclass(frozen=True, eq=False)
class CycleBodies:
    """Cam and follower on coarse meshes, factorised once for all cam angles.

    pulling : those of the pair by which a cam pulls, such as the rim around a groove; or None
    """

    cam: LoadedBody
    follower: LoadedBody
    pulling: CycleBodies | None = None

    @classmethod
    def meshed(cls, pair: ContactPair) -> CycleBodies:
        """Bodies of a pair; the element size follows from the contour and the minimum wall."""
        cam = loaded_cam(pair)
        pulling, other = pair.pulling, _loaded_follower(pair.follower)
        if pulling is None:
            return cls(cam, other)
        same = pulling.follower == pair.follower
        second = cls(
            loaded_cam(pulling) if pulling.own_body else cam,
            other if same else _loaded_follower(pulling.follower),
        )
        return cls(cam, other, second)

    def of(self, pair: ContactPair) -> CycleBodies:
        """Bodies of a pair by whose surface the cam pushes or pulls; see `ContactPair.on_walls`."""
        return self if self.pulling is None or pair.pulling is not None else self.pulling


def _loaded_follower(other: FollowerBody) -> LoadedBody:
    """Body of the follower on its coarse mesh, factorised."""
    mesh = other.coarse_mesh()
    facing = elastic_body(mesh, other.material, other.held, other.springs(mesh, None, 0.0))
    return LoadedBody(facing, other.surface, other.free)


def loaded_cam(pair: ContactPair, refinement: float = 1.0) -> LoadedBody:
    """Cam on the coarse mesh of a cycle, factorised; its element sizes divided by `refinement`.

    Raises
    ------
    InputError
        If bore and keyway leave no wall below the contour.
    """
    outline = float(pair.contour.perimeter())
    if pair.rim_radius is not None:
        return _loaded_rim(pair, pair.rim_radius, outline / _GRID_OF_CYCLE_MESH, refinement)
    depth = 0.0 if pair.keyway is None else pair.keyway.depth
    least = pair.contour.radius_min()
    wall = float(least.value) - pair.bore_radius - depth
    if not wall > 0.0:
        less = "" if pair.keyway is None else f" less cam.keyway.depth = {shown(depth, 'mm')}"
        limit = (
            f"< {shown(pair.bore_radius + wall, 'mm')}, the least radius of the contour, "
            f"{shown(float(least.value), 'mm')} at {shown(float(least.theta), 'deg')}{less}"
        )
        raise InputError("cam.bore_radius", shown(pair.bore_radius, "mm"), limit)
    edge = outline / _GRID_OF_CYCLE_MESH
    sizing = ElementSize(far_size=min(edge, wall / EDGES_ACROSS_WALL))
    if wall < edge:  # fine everywhere it would be a million triangles: fine where the wall is thin
        sizing = ElementSize(far_size=edge, wall_edges=EDGES_ACROSS_WALL)
    cam = pair.cam_mesh(sizing, refinement)
    cut = tuple(name for name in ("keyway", "counter_hole") if name in cam.boundaries)
    return LoadedBody(elastic_body(cam, pair.cam, pair.held), "contour", cut)


def _loaded_rim(pair: ContactPair, radius: float, edge: float, refinement: float) -> LoadedBody:
    """Rim of a radius, m, around a groove; `edge`: element size along its wall, m."""
    thick = radius - float(pair.contour.radius_max().value)
    sizing = ElementSize(far_size=edge, wall_edges=EDGES_ACROSS_WALL)
    if thick > edge:
        sizing = ElementSize(far_size=min(edge, thick / EDGES_ACROSS_WALL))
    rim = pair.cam_mesh(sizing, refinement)
    return LoadedBody(elastic_body(rim, pair.cam, pair.held), "contour")


def two_scale_history(
    pair: ContactPair, bodies: CycleBodies, theta: Array, normal_force: Array
) -> ContactHistory:
    """Two-scale contact at cam angles (n,) rad under normal forces (n,) N, on the surface that
    carries at each; see `_one_surface`.
    """
    parts = pair.on_walls(theta)
    if len(parts) == 1:
        ((each, _),) = parts
        return _one_surface(each, bodies.of(each), theta, normal_force)
    arrays: dict[str, Array] = {}
    for each, at in parts:
        solved = _one_surface(each, bodies.of(each), theta[at], normal_force[at]).arrays
        for name, values in solved.items():
            arrays.setdefault(name, np.empty((theta.size, *values.shape[1:])))[at] = values
    return ContactHistory(**arrays, tier=Tier.CYCLE)


def _one_surface(
    pair: ContactPair, bodies: CycleBodies, theta: Array, normal_force: Array
) -> ContactHistory:
    """Two-scale contact at cam angles (n,) rad under normal forces (n,) N.

    Pressure and stress from the finite-element patch with the gap of the exact contour; stress and
    bending of the real bodies from their correction fields. Where the half-width exceeds a tenth of
    the relative radius the flat patch is not valid: its quantities are NaN, those of Hertz are
    not. Where a vanishing load leaves a gap within round-off the contact is that of Hertz.

    Raises
    ------
    ContactError
        If the contact is too wide for a patch, or its solution fails.
    """
    load = np.maximum(normal_force, 0.0) / pair.width
    radius = pair.relative_radius(theta)
    half_width, p0 = hertz.line_contact(load, radius, pair.contact_modulus)
    flat = half_width <= FLAT_LIMIT * radius
    round_off = _gap_round_off(pair, theta, load, radius, half_width)
    on = (load > 0) & flat & (round_off <= GAP_ROUND_OFF_MAX)
    results = {
        name: np.zeros(theta.size)
        for name in (
            "p0", "half_width", "tau_max", "tau_any_plane", "tau_depth",
            "von_mises", "von_mises_depth",
            "residual_equilibrium", "residual_complementarity",
            "bending_cam", "bending_follower",
        )
    }  # fmt: skip
    shapes = contact_patch(pair.cam.poisson).shapes
    results["gap_round_off"] = round_off
    results["pressure"] = np.zeros((theta.size, shapes.centres.size))
    results["pressure_xi"] = half_width[:, None] * shapes.centres
    if (tiny := (load > 0) & ~on & flat).any():
        hertzian = closed_form_history(pair, theta[tiny], normal_force[tiny]).arrays
        for name in results.keys() - {"gap_round_off", "pressure", "pressure_xi"}:
            results[name][tiny] = hertzian[name]
        ellipse = np.sqrt(np.maximum(1 - shapes.centres**2, 0.0))
        ellipse *= np.pi / 2 / (shapes.integrals @ ellipse)  # of the load
        results["pressure"][tiny] = p0[tiny, None] * ellipse
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
        tier=Tier.CYCLE,
        **results,
    )


def _gap_round_off(
    pair: ContactPair, theta: Array, load: Array, radius: Array, half_width: Array
) -> Array:
    """Round-off (n,) of the coordinates of the contour over the gap at the half-width, at most 1.

    p0 scatters by a fifth of it. Zero without load.
    """
    gap = half_width**2 / (2 * radius)
    size = np.hypot(*pair.touched(theta)[0])
    error = np.minimum(np.finfo(float).eps * size, gap)
    share: Array = np.divide(error, gap, out=np.where(load > 0, 1.0, 0.0), where=gap > 0)
    return share


def _loaded_positions(
    pair: ContactPair,
    bodies: CycleBodies,
    theta: Array,
    load: Array,
    radius: Array,
    half_width: Array,
    p0: Array,
) -> dict[str, Array]:
    """Quantities of `ContactHistory` by name, each (n,), at the cam angles with a loaded, locally
    flat contact; line load, N/m, relative radius and half-width, m, p0, Pa, all (n,).
    """
    materials = (pair.cam, pair.follower.material)
    patches = (contact_patch(materials[0].poisson), contact_patch(materials[1].poisson))
    shares = tuple(pair.contact_modulus / each.plane_strain_modulus for each in materials)
    cam = bodies.cam.correction(*pair.touched(theta))
    other = bodies.follower.correction(*pair.follower_contacts(theta))

    bend = load * (other.bend + cam.bend)
    unit_xi, _, _ = patches[0].shapes.sampled
    gap = patch_gap(pair, theta, half_width, unit_xi)
    # The outward curvature of the corrections reduces the gap beside the centre.
    gap -= 0.5 * bend[:, None] * (half_width[:, None] * unit_xi) ** 2
    contacts = solve_patches(
        patches, (shares[0], shares[1]), gap * (2 * radius / half_width**2)[:, None]
    )

    pressure = contacts.pressure * p0[:, None]

    def measured(points: Index) -> tuple[Array, ...]:
        stress = stress_on_patch(pair, cam, theta, load, half_width, p0, pressure, points)
        return plane_stress_measures.all_measures(stress, pair.cam.poisson)

    (shear, shear_at), (any_plane, _), (mises, mises_at) = patches[0].peaks.where_likely(measured)
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
        # To first order p0 changes by half as much as the relative curvature.
        "bending_cam": -0.5 * load * cam.bend * radius,
        "bending_follower": -0.5 * load * other.bend * radius,
        "pressure": pressure,
    }


def patch_gap(pair: ContactPair, theta: Array, half_width: Array, unit_xi: Array) -> Array:
    """Gap (n, q), m, at `unit_xi` (q,) half-widths beside the contacts; symmetric about 0.

    Interpolated between Chebyshev nodes where the last coefficients are below `_GAP_REST`.
    """
    count, reach = _GAP_NODES, float(np.abs(unit_xi).max())
    unit = np.polynomial.chebyshev.chebpts1(count)
    inverse = np.polynomial.chebyshev.chebvander(unit, count - 1).T * (2.0 / count)
    inverse[0] *= 0.5
    coefficients = pair.gap(theta, half_width[:, None] * (reach * unit)) @ inverse.T
    gap: Array = coefficients @ np.polynomial.chebyshev.chebvander(unit_xi / reach, count - 1).T
    rest = np.abs(coefficients[:, -3:]).max(axis=1)
    rough = ~(rest <= _GAP_REST * np.abs(coefficients).max(axis=1))
    if rough.any():
        gap[rough] = pair.gap(theta[rough], half_width[rough, None] * unit_xi)
    return gap


def stress_on_patch(
    pair: ContactPair,
    cam: CorrectionField,
    theta: Array,
    load: Array,
    half_width: Array,
    p0: Array,
    pressure: Array,
    points: Index | None = None,
) -> Array:
    """Stress (3, m, n), Pa, in the cam at the points of the patch at n positions.

    Components along the tangent of the contact frame and into the depth; points in Hertz
    half-widths of the position.

    Parameters
    ----------
    cam : CorrectionField         of the cam at the positions
    theta : array (n,)            cam angles, rad
    load : array (n,)             line load, N/m
    half_width, p0 : array (n,)   of Hertz, m; Pa
    pressure : array (n, k)       at the knots of the patch, Pa
    points : array (m,) or None   numbers of the points of the patch; None: all
    """
    patch = contact_patch(pair.cam.poisson)
    unit, added = patch.stress, patch.body_stress
    if points is not None:
        unit, added = unit[:, points], added[:, points]
    # First-order change of the stress with the depth below a free curved surface.
    curvature = pair.curvature(theta)
    of_added = np.stack(
        [
            load * cam.along,
            load * half_width * (cam.along_by_depth + 2 * curvature * cam.along),
            -load * half_width * curvature * cam.along,
            p0 * half_width * curvature,
        ]
    )
    return np.asarray(unit @ pressure.T + added @ of_added)
