"""Contact patch under tangential tractions, by finite elements.

The half-disc of `contact_patch` with linear traction shapes on the same knots and the displacement
of the half-plane on its arc. For equal materials pressure and traction are uncoupled: the stresses
of both templates are added.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import contact_patch
from camwright.pipeline.contact.elasticity.halfplane import point_force_displacement
from camwright.pipeline.contact.elasticity.plane_stress_measures import PeakFinder
from camwright.pipeline.contact.elasticity.pressure_distribution import PressureShapes
from camwright.pipeline.contact.elasticity.surface_integrals import normal_loads

# With traction the maximum is near the surface, where the stress varies strongly.
_PEAK_REACH = 0.25


@dataclass(frozen=True, eq=False)
class TangentialPatch:
    """Finite-element half-plane under unit linear tractions along +x, for one Poisson ratio.

    points (2, m) along the surface and depth, in half-widths; stress (3, m, n) over the traction;
    points and knots are those of `ContactPatch`.
    """

    poisson: float
    points: Array
    stress: Array

    def __post_init__(self) -> None:
        freeze(self, points=self.points, stress=self.stress)

    @cached_property
    def peaks(self) -> PeakFinder:
        """Maxima of stress fields with traction on the points."""
        return PeakFinder(self.points, _PEAK_REACH)


@lru_cache(maxsize=8)
def tangential_patch(poisson: float, elements_per_half_width: int = 16) -> TangentialPatch:
    """`TangentialPatch` of a Poisson ratio, cached on disk."""
    arrays = disk_cache.kept(
        "traction",
        (float(poisson), int(elements_per_half_width)),
        lambda: _computed(poisson, elements_per_half_width),
        (sys.modules[__name__], *contact_patch.RECIPE),
    )
    return TangentialPatch(poisson, **arrays)


def _computed(poisson: float, elements_per_half_width: int) -> dict[str, Array]:
    """Points and stress by their names in `TangentialPatch`."""
    body, frame, shapes = contact_patch.patch_body(poisson, elements_per_half_width)
    along = normal_loads(body.mesh, "top", frame, shapes)[1]
    loads = np.stack([along, np.zeros_like(along)])
    arc = body.mesh.boundary_nodes("arc")
    held = _arc_displacement(body.mesh.points, arc, shapes, poisson)
    recovery = contact_patch.stress_near(body)
    nodal = recovery(body.displacement(loads, held))
    # Depth is counted into the body, opposite to y: the shear changes sign.
    nodal[2] *= -1
    points = body.mesh.points[:, recovery.nodes] * np.array([[1.0], [-1.0]])
    return {"points": points, "stress": nodal}


def _arc_displacement(
    points: Array, arc: NDArray[np.int64], shapes: PressureShapes, poisson: float
) -> Array:
    """Displacement (2, nodes, n) of a half-plane under each traction shape at the nodes of the arc;
    zero at the others.

    The displacement of a point force depends on the angle from its line of action alone: that of a
    tangential force is the field of the normal force turned by 90 deg.

    Parameters
    ----------
    points : array (2, nodes)   nodes, over the half-width; y = 0 at the surface
    arc : array of int          numbers of the nodes of the arc
    """
    xi, weights = shapes.quadrature()
    x, depth = points[0, arc], -points[1, arc]
    sideways = np.broadcast_to(depth[:, None], (arc.size, xi.size))
    into, along = point_force_displacement(sideways, x[:, None] - xi, poisson)
    field = np.zeros((2, points.shape[1], shapes.centres.size))
    field[:, arc] = np.stack([along, -into]) @ (shapes.values(xi) * weights).T
    return field
