"""Contact patch: finite-element template of a half-plane, solved once for all cam angles.

A half-disc with a radius of forty half-widths, in units of the half-width: compliance and stresses
hold for any size and load. Its arc has the displacement of the half-plane, so that there is no
truncation error. The effect of boundary, bore and supports of the real body is smooth and is added
by `body_compliance`. Frictionless: the coupling of unlike materials (Dundurs' beta) is neglected,
as in the certificate.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, freeze, readonly
from camwright.geometry.errors import ContactError
from camwright.meshes import body_mesh, element_size, gmsh_mesher, outline
from camwright.meshes.body_mesh import half_disc_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import (
    active_set,
    elastic_body,
    halfplane,
    pressure_distribution,
    sparse_factor,
    surface_integrals,
)
from camwright.pipeline.contact.elasticity.elastic_body import (
    ElasticBody,
    StressRecovery,
    elements_near,
)
from camwright.pipeline.contact.elasticity.halfplane import point_force_displacement
from camwright.pipeline.contact.elasticity.plane_stress_measures import PeakFinder
from camwright.pipeline.contact.elasticity.pressure_distribution import (
    Ellipses,
    PressureShapes,
    fitted_ellipses,
)
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame, normal_loads

_RADIUS = 40.0
_WINDOW = 1.4
STRESS_REACH = 1.6
ELEMENTS_PER_HALF_WIDTH = 16
# Piecewise-linear functions times the ellipse across a contact; more of them would overshoot.
_ELLIPTIC = 17
# Residual of an elliptic pressure above which the linear one is kept; as in `active_set`.
_COMPLEMENTARITY = 1e-9
# Modules whose source enters the cache key.
MESH_RECIPE = (body_mesh, gmsh_mesher, element_size, outline)
RECIPE = (
    *(sys.modules[__name__], *MESH_RECIPE),
    *(elastic_body, sparse_factor, halfplane, pressure_distribution, surface_integrals),
)


@dataclass(frozen=True, eq=False)
class ContactPatch:
    """Finite-element half-plane under unit linear pressures, for one Poisson ratio.

    Lengths over half-width, stresses over pressure, displacements over pressure times half-width
    over plane-strain modulus E / (1 - nu^2): knots (n + 2,), compliance (n, n) weighted
    settlement, points (2, m) along the surface and depth, stress (3, m, n), dofs.
    """

    poisson: float
    knots: Array
    compliance: Array
    points: Array
    stress: Array
    dofs: int

    def __post_init__(self) -> None:
        names = ("knots", "compliance", "points", "stress")
        freeze(self, **{name: getattr(self, name) for name in names})

    @cached_property
    def shapes(self) -> PressureShapes:
        """Linear pressure shapes on the knots."""
        return PressureShapes(self.knots)

    @cached_property
    def body_stress(self) -> Array:
        """Four stress fields xx, yy, xy at the patch points, (3, m, 4), by which the stress of a
        real body differs from that of the half-plane.

        Uniform stress along the surface; stress along the surface, and into the depth, that grows
        with the depth by 1 per half-width; `hertz.curved_surface_stress`.
        """
        depth = self.points[1]
        added = np.zeros((3, depth.size, 4))
        added[0, :, 0], added[0, :, 1], added[1, :, 2] = 1.0, depth, depth
        added[:, :, 3] = hertz.curved_surface_stress(*self.points)
        return readonly(added)

    @cached_property
    def peaks(self) -> PeakFinder:
        """Maxima of stress fields on the points."""
        return PeakFinder(self.points)


@lru_cache(maxsize=8)
def contact_patch(
    poisson: float, elements_per_half_width: int = ELEMENTS_PER_HALF_WIDTH
) -> ContactPatch:
    """`ContactPatch` of a Poisson ratio, cached on disk."""
    arrays = disk_cache.kept(
        "patch",
        (float(poisson), int(elements_per_half_width)),
        lambda: _computed(poisson, elements_per_half_width),
        RECIPE,
    )
    kept = {name: arrays[name] for name in ("knots", "compliance", "points", "stress")}
    return ContactPatch(poisson, **kept, dofs=int(arrays["dofs"]))


@lru_cache(maxsize=1)
def patch_body(
    poisson: float, elements_per_half_width: int
) -> tuple[ElasticBody, ContactFrame, PressureShapes]:
    """Half-disc of a contact patch with its contact frame and pressure shapes, lengths in
    half-widths.

    The last one is kept, as both templates of a Poisson ratio share its factors.
    """
    size = 1 / elements_per_half_width
    mesh = half_disc_mesh(
        _RADIUS,
        ElementSize(
            contact_point=readonly((0.0, 0.0)), contact_size=size, contact_extent=1.7, far_size=5.0
        ),
    )
    body = ElasticBody(mesh, modulus=1 - poisson**2, poisson=poisson, held="arc")
    frame = ContactFrame(np.zeros(2), np.array([0.0, 1.0]))
    # Knots at ends and middles of facets, as in the certificate.
    count = round(2 * _WINDOW / size)
    return body, frame, PressureShapes(readonly(np.arange(-count, count + 1) * (size / 2)))


@lru_cache(maxsize=1)
def stress_near(body: ElasticBody) -> StressRecovery:
    """Stress recovery on the elements of a half-disc within `STRESS_REACH`."""
    return StressRecovery(body, elements_near(body, np.zeros(2), STRESS_REACH))


def _computed(poisson: float, elements_per_half_width: int) -> dict[str, Array]:
    """Arrays of a template by their names in `ContactPatch`, by finite elements.

    The mesh is symmetric about the middle: the shapes of the right half are solved, those of the
    left half are their mirror images.
    """
    body, frame, shapes = patch_body(poisson, elements_per_half_width)
    mesh, left = body.mesh, shapes.centres.size // 2
    loads = normal_loads(mesh, "top", frame, shapes)
    held = _far_displacement(mesh.points, shapes, poisson)
    displacement = body.displacement(-loads[..., left:], held[..., left:])
    right = -np.tensordot(loads, displacement, axes=([0, 1], [0, 1]))
    compliance = np.hstack([right[::-1, :0:-1], right])
    recovery = stress_near(body)
    points = mesh.points[:, recovery.nodes] * np.array([[1.0], [-1.0]])
    nodal = recovery(displacement)
    # Depth is counted into the body, opposite to y: the shear changes sign.
    nodal[2] *= -1
    images = nodal[:, _mirrored(points), :0:-1] * np.array([1.0, 1.0, -1.0])[:, None, None]
    return {
        "knots": shapes.knots,
        "compliance": (compliance + compliance.T) / 2,
        "points": points,
        "stress": np.concatenate([images, nodal], axis=2),
        "dofs": np.array(body.dof_count),
    }


def _mirrored(points: Array) -> NDArray[np.intp]:
    """Numbers (m,) of the mirror images in x = 0 of points (2, m)."""
    images = np.empty(points.shape[1], dtype=np.intp)
    images[np.lexsort((-points[0], points[1]))] = np.lexsort(points)
    return images


def _far_displacement(points: Array, shapes: PressureShapes, poisson: float) -> Array:
    """Displacement (2, nodes, n) of a half-plane under each unit pressure shape at the nodes beyond
    0.9 of the patch's radius, its arc; zero at the others.

    Parameters
    ----------
    points : array (2, nodes)   nodes, over the half-width; y = 0 at the surface
    """
    xi, weights = shapes.quadrature()
    weighted = shapes.values(xi) * weights
    far = np.hypot(*points) > 0.9 * _RADIUS
    field = np.zeros((2, points.shape[1], shapes.centres.size))
    x, depth = points[0, far], -points[1, far]
    displaced = point_force_displacement(
        x[:, None] - xi, np.broadcast_to(depth[:, None], (x.size, xi.size)), poisson
    )
    field[:, far] = displaced @ weighted.T * np.array([1.0, -1.0])[:, None, None]
    return field


@dataclass(frozen=True, eq=False)
class PatchContacts:
    """Contact at `count` positions, over Hertz p0 and half-width of each position.

    pressure (count, n) at the knots, elliptic at the edges where the contact is one ellipse; p0,
    half_width, centre (count,) of the fitted ellipse; residuals (count,) of `pressure`.
    """

    pressure: Array
    p0: Array
    half_width: Array
    centre: Array
    residual_equilibrium: Array
    residual_complementarity: Array


def solve_patches(
    patches: tuple[ContactPatch, ContactPatch], shares: tuple[float, float], gap: ArrayLike
) -> PatchContacts:
    """Contact of two patches at many positions, solved together.

    Parameters
    ----------
    patches : two ContactPatch   body 1 and 2
    shares : two floats          contact modulus over each body's plane-strain modulus; sum 1
    gap : array (count, q)       at the quadrature points of the knots, over a^2 / (2 R)

    Raises
    ------
    ContactError
        If a contact reaches the end of the patch.
    """
    shapes = patches[0].shapes
    compliance = shares[0] * patches[0].compliance + shares[1] * patches[1].compliance
    _, weights, values = shapes.sampled
    weighted_gap = (np.asarray(gap) * weights) @ values.T
    count = weighted_gap.shape[0]
    solution = active_set.solve(
        compliance,
        weighted_gap,
        shapes.integrals,
        np.full(count, np.pi / 2),
        guess=np.abs(shapes.centres) < 1,
    )
    outside = (solution.pressure[:, 0] > 0) | (solution.pressure[:, -1] > 0)
    if outside.any():
        raise ContactError(
            f"contact wider than {_WINDOW} Hertz half-widths at {int(outside.sum())} positions: "
            "the surfaces are not locally cylindrical"
        )
    ellipses = fitted_ellipses(shapes, solution.pressure)
    elliptic, violation = _elliptic_pressure(shapes, compliance, weighted_gap, ellipses)
    one = _one_ellipse(shapes, solution.pressure, ellipses) & (violation <= _COMPLEMENTARITY)
    pressure = np.where(one[:, None], elliptic, solution.pressure)
    return PatchContacts(
        pressure=pressure,
        p0=ellipses.p0,
        half_width=ellipses.half_width,
        centre=ellipses.centre,
        residual_equilibrium=np.abs(pressure @ shapes.integrals / (np.pi / 2) - 1),
        residual_complementarity=np.where(one, violation, solution.complementarity),
    )


def _one_ellipse(shapes: PressureShapes, pressure: Array, ellipses: Ellipses) -> NDArray[np.bool_]:
    """Where (count,) a pressure (count, n) is one ellipse, bool: the loaded knots are contiguous
    and their ends within two knot spacings of those of the fitted ellipse.
    """
    carrying = pressure > 0
    first, last = carrying.argmax(axis=1), carrying.shape[1] - 1 - carrying[:, ::-1].argmax(axis=1)
    low, high = (ellipses.centre + side * ellipses.half_width for side in (-1, 1))
    apart = np.maximum(np.abs(shapes.centres[first] - low), np.abs(shapes.centres[last] - high))
    step = float(np.diff(shapes.knots).max())
    return np.asarray((carrying.sum(axis=1) == last - first + 1) & (apart <= 2 * step))


def _elliptic_pressure(
    shapes: PressureShapes, compliance: Array, weighted_gap: Array, ellipses: Ellipses
) -> tuple[Array, Array]:
    """Pressures (count, n) at the knots, as linear functions times the fitted ellipse, and their
    residuals (count,).

    Linear pressures overshoot by 9 % at their last knot. The elliptic ones have zero gap in the
    mean over each function, under the same force. Residual: the greater of tension over the
    greatest pressure, and of mean gap over a function or overlap beside the ellipse over the
    greatest gap.

    Parameters
    ----------
    compliance : array (n, n)         of both bodies, weighted settlement
    weighted_gap : array (count, n)   initial gap times each pressure shape, integrated
    ellipses : Ellipses               fitted to the linear pressures
    """
    count, few = weighted_gap.shape[0], _ELLIPTIC
    at = (shapes.centres - ellipses.centre[:, None]) / ellipses.half_width[:, None]
    nodes = np.linspace(-1.0, 1.0, few)
    hats = np.maximum(1 - np.abs(at[:, :, None] - nodes) * (few - 1) / 2, 0.0)
    basis = hats * np.sqrt(np.maximum(1 - at**2, 0.0))[:, :, None]
    turned = basis.transpose(0, 2, 1)
    force = turned @ shapes.integrals
    system = np.zeros((count, few + 1, few + 1))
    system[:, :few, :few] = turned @ (compliance @ basis)
    system[:, :few, few], system[:, few, :few] = -force, force
    right = np.full((count, few + 1, 1), np.pi / 2)
    right[:, :few] = -turned @ weighted_gap[:, :, None]
    pressure = (basis @ np.linalg.solve(system, right)[:, :few])[:, :, 0]
    gap = pressure @ compliance + weighted_gap
    gap -= np.outer((pressure * gap).sum(axis=1) / (np.pi / 2), shapes.integrals)
    under = (turned @ gap[:, :, None])[:, :, 0] / force
    gap /= shapes.integrals
    low, high = (ellipses.centre + side * ellipses.half_width for side in (-1, 1))
    beside = (shapes.knots[2:] <= low[:, None]) | (shapes.knots[:-2] >= high[:, None])
    violation = np.maximum(np.abs(under).max(axis=1), np.where(beside, -gap, 0.0).max(axis=1))
    violation /= np.abs(gap).max(axis=1)
    return pressure, np.maximum(violation, -pressure.min(axis=1) / pressure.max(axis=1))
