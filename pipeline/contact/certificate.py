"""Two bodies in contact by finite elements, nothing assumed but linear elasticity.

Second-order bodies, continuous linear pressure on the facets of one surface, integrals split at
the knots and facets of both, the gap from the true shapes and not from the facets, the bodies
condensed to a compliance of the pressures, complementarity solved exactly under the given load.

Frictionless: the surfaces may slide past each other, also where unlike materials would drag each
other along (Dundurs' beta is not felt), and pressures act along the one normal of the frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array, freeze
from geometry.errors import ContactError, InputError
from pipeline.contact import active_set
from pipeline.contact.elastic_body import (
    CondensedBody,
    ElasticBody,
    StressRecovery,
    elements_near,
)
from pipeline.contact.pressure import PressureShapes, fitted_ellipses
from pipeline.contact.stress import PeakFinder, shear_in_plane, von_mises
from pipeline.contact.surface import ContactFrame, knots_of, normal_loads

# Pressures are sought within this many half-widths of the centre.
_WINDOW = 1.4
# Stresses are recovered within this many half-widths of the contact.
_STRESS_REACH = 2.0
_EQUILIBRIUM = 1e-8


@dataclass(frozen=True, eq=False)
class ContactSide:
    """One body with the name of its contact surface."""

    body: ElasticBody
    surface: str


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """Contact of two bodies under a line load.

    xi (k,) m and pressure (k,) Pa at the knots; p0 and half_width from the pressure's square,
    which is a parabola in xi; tau_max, von_mises and their depths below the contact in body 1
    (Pa, m); displacements (2, nodes) m of both bodies; equilibrium and complementarity
    residuals, relative.
    """

    xi: Array
    pressure: Array
    p0: float
    centre: float
    half_width: float
    tau_max: float
    tau_depth: float
    von_mises: float
    von_mises_depth: float
    approach: float
    displacements: tuple[Array, Array]
    residual_equilibrium: float
    residual_complementarity: float
    dofs: int

    def __post_init__(self) -> None:
        freeze(self, xi=self.xi, pressure=self.pressure)


def solve_contact(
    sides: tuple[ContactSide, ContactSide],
    frame: ContactFrame,
    gap: Callable[[Array], Array],
    line_load: float,
    half_width: float,
    *,
    pressure_on: int = 0,
    shapes: PressureShapes | None = None,
) -> ContactSolution:
    """Contact pressures, stresses and displacements of two bodies.

    Parameters
    ----------
    sides : two ContactSide        body 1 below the frame's normal, body 2 above it
    frame : ContactFrame
    gap : function xi -> array     distance of the undeformed surfaces along the normal, m
    line_load : float              N/m, > 0
    half_width : float             Hertz half-width that sets the window, m
    pressure_on : int              the side whose surface nodes are the pressure knots
    shapes : PressureShapes        knots of the caller's choice instead

    Raises
    ------
    InputError
        If the load or the half-width is not positive.
    ContactError
        If the contact reaches the end of its window, or equilibrium or complementarity is not
        met to 1e-8.
    """
    for name, value, si in (("line_load", line_load, "N/m"), ("half_width", half_width, "m")):
        if not value > 0:
            raise InputError(name, value, f"> 0 {si}")
    if shapes is None:
        chosen = sides[pressure_on]
        reach = _WINDOW * half_width
        shapes = PressureShapes(knots_of(chosen.body.mesh, chosen.surface, frame, reach))
    seen = [_LoadedNodes.of(side, frame, shapes) for side in sides]
    compliance = seen[0].compliance + seen[1].compliance
    xi, weights = shapes.quadrature()
    solution = active_set.solve(
        compliance,
        shapes.integrated(gap(xi), xi, weights),
        shapes.integrals,
        [line_load],
        guess=np.abs(shapes.centres) < half_width,
    )
    pressure = solution.pressure[0]
    if not shapes.open_ends and (pressure[0] > 0 or pressure[-1] > 0):
        raise ContactError("the contact is wider than the window it was sought in")
    displacements = (seen[0].displacement(-pressure), seen[1].displacement(pressure))
    support = sides[0].body.reaction(displacements[0]) - line_load * frame.normal
    equilibrium = max(float(solution.equilibrium[0]), float(np.linalg.norm(support)) / line_load)
    if not equilibrium <= _EQUILIBRIUM:
        raise ContactError(f"equilibrium = {equilibrium:.1e}, must be <= {_EQUILIBRIUM:.0e}")
    ellipse = fitted_ellipses(shapes, pressure[None])
    width = float(ellipse.half_width[0])
    peak = _peak_stress(sides[0].body, displacements[0], frame, width)
    return ContactSolution(
        xi=shapes.centres,
        pressure=pressure,
        p0=float(ellipse.p0[0]),
        centre=float(ellipse.centre[0]),
        half_width=width,
        tau_max=peak[0],
        tau_depth=peak[1],
        von_mises=peak[2],
        von_mises_depth=peak[3],
        approach=float(solution.approach[0]),
        displacements=displacements,
        residual_equilibrium=equilibrium,
        residual_complementarity=float(solution.complementarity[0]),
        dofs=sum(side.body.dof_count for side in sides),
    )


@dataclass(frozen=True, eq=False)
class _LoadedNodes:
    """A body condensed to the nodes under the pressures, with their loads (2, m, n)."""

    body: CondensedBody
    loads: Array

    @classmethod
    def of(cls, side: ContactSide, frame: ContactFrame, shapes: PressureShapes) -> _LoadedNodes:
        loads = normal_loads(side.body.mesh, side.surface, frame, shapes)
        nodes = np.flatnonzero((loads != 0).any(axis=(0, 2)))
        return cls(side.body.condensed(nodes), loads[:, nodes])

    @property
    def compliance(self) -> Array:
        """Weighted surface displacement (n, n) per pressure."""
        found = np.tensordot(self.loads, self.body.displacement(self.loads), axes=([0, 1], [0, 1]))
        return (found + found.T) / 2

    def displacement(self, pressure: Array) -> Array:
        """Displacement (2, nodes) of the whole body."""
        return self.body.everywhere((self.loads @ pressure)[:, :, None])[:, :, 0]


def _peak_stress(
    body: ElasticBody, displacement: Array, frame: ContactFrame, half_width: float
) -> tuple[float, float, float, float]:
    """Largest in-plane shear and von Mises stress near the contact, and their depths."""
    recovery = StressRecovery(body, elements_near(body, frame.origin, _STRESS_REACH * half_width))
    nodal = recovery(displacement[:, :, None])
    points = body.mesh.points[:, recovery.nodes]
    find = PeakFinder(np.stack([frame.along(points), -frame.above(points)]) / half_width)
    shear, shear_place = find(shear_in_plane(nodal))
    mises, mises_place = find(von_mises(nodal, body.poisson))
    return (
        float(shear[0]),
        float(shear_place[1, 0]) * half_width,
        float(mises[0]),
        float(mises_place[1, 0]) * half_width,
    )
