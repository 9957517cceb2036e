"""Frictionless contact of two elastic bodies by finite elements.

Quadratic elements; continuous piecewise-linear pressure on the facets of one surface; integrals
split at the knots and facets of both; the gap of the exact contours; bodies condensed to the
compliance of the pressures; complementarity under the prescribed load. Linear pressures give the
extent of the contact and overshoot at its edge; within that extent they are then multiplied by an
ellipse, the edge behaviour of a contact pressure.

Frictionless, so that the coupling of unlike materials (Dundurs' beta) is neglected; pressures act
along the normal of the frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.contact.elasticity import active_set
from camwright.pipeline.contact.elasticity.elastic_body import (
    CondensedBody,
    ElasticBody,
    StressRecovery,
    elements_near,
)
from camwright.pipeline.contact.elasticity.fitted_stress import (
    FittedStress,
    fitted_stress,
    greatest_fitted,
)
from camwright.pipeline.contact.elasticity.plane_stress_measures import (
    PeakFinder,
    shear_in_plane,
    von_mises,
)
from camwright.pipeline.contact.elasticity.pressure_distribution import (
    Ellipses,
    EllipticShapes,
    PressureShapes,
    fitted_ellipses,
)
from camwright.pipeline.contact.elasticity.surface_integrals import (
    ContactFrame,
    knots_of,
    normal_loads,
)

# Half-width of the window of the pressures, in Hertz half-widths.
_WINDOW = 1.4
# Radius of stress recovery about the contact, in Hertz half-widths.
_STRESS_REACH = 2.0
# Radius of the nodes to which the stress about its maximum is fitted, in half-widths.
_FIT_REACH = 0.6
_EQUILIBRIUM = 1e-8
# The error of the second moment is of second order in that of the edges.
_EDGE_UPDATES = 2
# Overlap beside the contact over the largest gap, by round-off and mesh.
_OVERLAP = 1e-3


@dataclass(frozen=True, eq=False)
class ContactSide:
    """Body of a contact with the name of its contact surface."""

    body: ElasticBody
    surface: str


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """Contact of two bodies under a line load.

    xi (k,) m and pressure (k,) Pa at the knots; p0, centre and half_width of the fitted ellipse;
    tau_max, von_mises and their depths in body 1 (Pa, m); displacements (2, nodes) m of both
    bodies; residuals of equilibrium and complementarity of that pressure, relative, its overlap
    beside the contact included. `linear_because` is the reason for a pressure without elliptic
    edges, empty for an elliptic one.
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
    linear_because: str = ""

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
    """Pressure, stress and displacement of two bodies in contact.

    Parameters
    ----------
    sides : two ContactSide        body 1 below the frame's normal, body 2 above it
    frame : ContactFrame
    gap : function xi -> array     distance of the undeformed surfaces along the normal, m
    line_load : float              N/m, > 0
    half_width : float             Hertz half-width that sets the window, m
    pressure_on : int              index of the side whose surface nodes are the pressure knots
    shapes : PressureShapes        pressure shapes to use instead

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
    seen = (_LoadedNodes.of(sides[0], frame, shapes), _LoadedNodes.of(sides[1], frame, shapes))
    linear = _pressed(seen, shapes, gap, line_load, np.abs(shapes.centres) < half_width)
    linear_pressure = linear.solution.pressure[0]
    if not shapes.open_ends and (linear_pressure[0] > 0 or linear_pressure[-1] > 0):
        raise ContactError("contact wider than the window of its pressure knots")
    pressed, overlap, linear_because = _with_elliptic_edges(linear, gap, line_load)
    seen, solution = pressed.seen, pressed.solution
    pressure = solution.pressure[0]
    displacements = (seen[0].displacement(-pressure), seen[1].displacement(pressure))
    support = sides[0].body.reaction(displacements[0]) - line_load * frame.normal
    equilibrium = max(float(solution.equilibrium[0]), float(np.linalg.norm(support)) / line_load)
    if not equilibrium <= _EQUILIBRIUM:
        raise ContactError(f"equilibrium = {equilibrium:.1e}, must be <= {_EQUILIBRIUM:.0e}")
    ellipse = pressed.ellipse
    fitted = float(ellipse.half_width[0])
    peak = _peak_stress(sides[0].body, displacements[0], frame, fitted)
    return ContactSolution(
        xi=shapes.centres,
        pressure=pressed.shapes.values(shapes.centres).T @ pressure,
        p0=float(ellipse.p0[0]),
        centre=float(ellipse.centre[0]),
        half_width=fitted,
        tau_max=peak[0],
        tau_depth=peak[1],
        von_mises=peak[2],
        von_mises_depth=peak[3],
        approach=float(solution.approach[0]),
        displacements=displacements,
        residual_equilibrium=equilibrium,
        residual_complementarity=max(float(solution.complementarity[0]), overlap),
        dofs=sum(side.body.dof_count for side in sides),
        linear_because=linear_because,
    )


@dataclass(frozen=True, eq=False)
class _LoadedNodes:
    """A body condensed to the nodes under the pressures, with their loads (2, m, n)."""

    side: ContactSide
    frame: ContactFrame
    body: CondensedBody
    loads: Array

    @classmethod
    def of(cls, side: ContactSide, frame: ContactFrame, shapes: PressureShapes) -> _LoadedNodes:
        loads = normal_loads(side.body.mesh, side.surface, frame, shapes)
        nodes = np.flatnonzero((loads != 0).any(axis=(0, 2)))
        return cls(side, frame, side.body.condensed(nodes), loads[:, nodes])

    def under(self, shapes: EllipticShapes) -> _LoadedNodes:
        """The same nodes under pressure shapes within the former window."""
        loads = normal_loads(self.side.body.mesh, self.side.surface, self.frame, shapes)
        return replace(self, loads=loads[:, self.body.nodes])

    @property
    def compliance(self) -> Array:
        """Weighted surface displacement (n, n) per pressure."""
        weighted = np.tensordot(
            self.loads, self.body.displacement(self.loads), axes=([0, 1], [0, 1])
        )
        return (weighted + weighted.T) / 2

    def displacement(self, pressure: Array) -> Array:
        """Displacement (2, nodes) of the whole body."""
        return self.body.everywhere((self.loads @ pressure)[:, :, None])[:, :, 0]


@dataclass(frozen=True, eq=False)
class _Pressed:
    """Both bodies under the contact pressures of some shapes."""

    seen: tuple[_LoadedNodes, _LoadedNodes]
    shapes: PressureShapes | EllipticShapes
    solution: active_set.Complementarity

    @cached_property
    def ellipse(self) -> Ellipses:
        """Ellipse fitted to the pressure."""
        return fitted_ellipses(self.shapes, self.solution.pressure)

    @property
    def edges(self) -> Array:
        """Ends (2,) of the fitted ellipse, m."""
        reach = self.ellipse.half_width[0]
        return np.asarray(self.ellipse.centre[0] + np.array([-reach, reach]))


def _pressed(
    seen: tuple[_LoadedNodes, _LoadedNodes],
    shapes: PressureShapes | EllipticShapes,
    gap: Callable[[Array], Array],
    line_load: float,
    guess: ArrayLike | None = None,
) -> _Pressed:
    xi, weights = shapes.quadrature()
    solution = active_set.solve(
        seen[0].compliance + seen[1].compliance,
        shapes.integrated(gap(xi), xi, weights),
        shapes.integrals,
        [line_load],
        guess=guess,
    )
    return _Pressed(seen, shapes, solution)


def _with_elliptic_edges(
    linear: _Pressed, gap: Callable[[Array], Array], line_load: float
) -> tuple[_Pressed, float, str]:
    """Contact with elliptic shapes, its overlap beside the contact over the greatest gap, and "";
    else the linear contact, 0, and the reason in words.

    On every second knot, the resolution of the displacements.

    Parameters
    ----------
    linear : _Pressed            contact with linear pressure shapes
    gap : function xi -> array   distance of the undeformed surfaces along the normal, m
    line_load : float            N/m
    """
    shapes = linear.shapes
    if not isinstance(shapes, PressureShapes) or shapes.open_ends:
        return linear, 0.0, "the pressure does not end within the surface"
    step = float(np.diff(shapes.knots).max())
    carrying = np.flatnonzero(linear.solution.pressure[0] > 0)
    ends = shapes.centres[carrying[[0, -1]]]
    if np.diff(carrying).max() > 1 or np.abs(ends - linear.edges).max() > 2 * step:
        return linear, 0.0, "the contact is not a single ellipse"
    elliptic = linear
    for _ in range(_EDGE_UPDATES):
        cut = EllipticShapes.within(shapes.knots[::2], elliptic.edges)
        seen = (linear.seen[0].under(cut), linear.seen[1].under(cut))
        elliptic = _pressed(seen, cut, gap, line_load)
    overlap = _overlap(linear, elliptic, gap)
    if not overlap <= _OVERLAP:
        return linear, 0.0, "the surfaces would overlap beside the ellipse"
    return elliptic, overlap, ""


def _overlap(linear: _Pressed, elliptic: _Pressed, gap: Callable[[Array], Array]) -> float:
    """Maximum overlap of the surfaces beside the elliptic contact over the maximum gap, -, both
    weighted by the linear shapes.

    Parameters
    ----------
    linear, elliptic : _Pressed   contact with linear and with elliptic pressure shapes
    gap : function xi -> array    distance of the undeformed surfaces along the normal, m
    """
    shapes, pressure = linear.shapes, elliptic.solution.pressure[0]
    xi, weights = shapes.quadrature()
    apart = shapes.integrated(gap(xi), xi, weights)
    for before, after in zip(linear.seen, elliptic.seen, strict=True):
        displaced = before.body.displacement((after.loads @ pressure)[:, :, None])[:, :, 0]
        apart += np.tensordot(before.loads, displaced, axes=([0, 1], [0, 1]))
    apart -= elliptic.solution.approach[0] * shapes.integrals
    low, high = elliptic.edges
    beside = (shapes.knots[2:] <= low) | (shapes.knots[:-2] >= high)
    return max(0.0, float(-apart[beside].min() / apart.max()))


def _peak_stress(
    body: ElasticBody, displacement: Array, frame: ContactFrame, half_width: float
) -> tuple[float, float, float, float]:
    """Maximum in-plane shear, Pa, its depth, m, maximum von Mises stress, Pa, its depth, m, below
    the contact.

    Fitted to the nodal displacements about the maximum; near the surface that of the recovered
    nodal stress.

    Parameters
    ----------
    displacement : array (2, nodes)   of the body, m
    half_width : float                of the contact, m
    """
    recovery = StressRecovery(body, elements_near(body, frame.origin, _STRESS_REACH * half_width))
    nodal = recovery(displacement[:, :, None])
    nodes = body.mesh.points[:, recovery.nodes]
    points = np.stack([frame.along(nodes), frame.above(nodes)])
    own = np.stack([frame.tangent, frame.normal]) @ displacement[:, recovery.nodes]
    find = PeakFinder(points * [[1.0], [-1.0]] / half_width)

    def fit_about(place: Array) -> FittedStress | None:
        """Stress fitted to the displacements about a place (2,), m, along the tangent and the
        outward normal; None where the region of the fit would reach beyond the surface.
        """
        reach = _FIT_REACH * half_width
        if not -place[1] >= reach:  # a fit that the surface cuts has no nodes on one side: 3 % off
            return None
        return fitted_stress(points, own, (body.modulus, body.poisson), place, reach)

    def peak(measure: Callable[[Array], Array]) -> tuple[float, float]:
        recovered, (along, depth) = find(measure(nodal))
        place = half_width * np.array([along[0], -depth[0]])
        fitted = greatest_fitted(fit_about, measure, place)
        value, place = (float(recovered[0]), place) if fitted is None else fitted
        return value, -float(place[1])

    return *peak(shear_in_plane), *peak(lambda stress: von_mises(stress, body.poisson))
