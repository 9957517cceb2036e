"""Line contact of two cylinders: Hertz, finite elements with error bar, pin in a hole.

Bodies are half-planes with the gap of the circles. Conforming contacts, a pin in a hole of nearly
its radius, are solved by `pin_in_hole`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize
from scipy.spatial import cKDTree

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ContactError, InputError
from camwright.meshes.body_mesh import BodyMesh
from camwright.meshes.gmsh_mesher import Index
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_patch import (
    STRESS_REACH,
    ContactPatch,
    PatchContacts,
    contact_patch,
    patch_body,
    solve_patches,
)
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, elements_near
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.pin_in_hole import (
    persson_contact_angle,
    persson_pressure,
    pin_in_hole,
)
from camwright.pipeline.contact.tangential_patch import tangential_patch

HALF_ANGLE_MAX = np.radians(15.0)
"""Half contact angle up to which the theory of Hertz is valid, rad."""

_FINE_PATCH, _COARSE_PATCH = 16, 8  # elements per half-width
# Relative error of half-planes over the square of half-width over smaller radius. Compared with the
# full contact of two discs up to 15 deg: 0.12 for p0 and half-width, 0.31 for the shear after the
# first-order term of a disc; with Persson's pin in a hole: at most 0.25 for p0.
_FLATNESS = 0.35


@dataclass(frozen=True)
class TwoCylinders:
    """Two cylinders: radii (m; infinite: flat, negative: concave), materials, N/m, friction.

    Stresses are those of body 1, with a traction of `friction` times pressure.
    """

    radius_1: float
    radius_2: float
    body_1: Elastic
    body_2: Elastic
    line_load: float
    friction: float = 0.0

    def __post_init__(self) -> None:
        """Refuse radii of zero, bodies of which one does not fit into the other, and load, friction
        or elastic constants out of bounds.
        """
        for name in ("radius_1", "radius_2"):
            radius = getattr(self, name)
            if np.isnan(radius) or radius == 0:
                raise InputError(name, radius, "a length other than 0, or inf for a flat body")
        if not self.curvature > 0:
            self._refuse_the_concave_body()
        if not 0 <= self.line_load < np.inf:
            raise InputError("line_load", self.line_load, ">= 0 N/m")
        if not 0 <= self.friction < 2:
            raise InputError("friction", self.friction, "in [0, 2)")
        hertz.contact_modulus(*_elastic(self.body_1), *_elastic(self.body_2))

    def _refuse_the_concave_body(self) -> None:
        """Raise InputError that names the concave body, whose radius is not greater than that of
        the other body.
        """
        radii = {"radius_2": self.radius_2, "radius_1": self.radius_1}
        concave, other = sorted(radii, key=lambda name: 1.0 / radii[name])
        limit = "> 0, as the other body is flat or concave"
        if 0.0 < radii[other] < np.inf:
            limit = f"< {shown(-radii[other], 'mm')}: concave and wider than {other}"
        raise InputError(concave, shown(radii[concave], "mm"), limit)

    @property
    def curvature(self) -> float:
        """1/R = 1/r1 + 1/r2, 1/m."""
        return 1 / self.radius_1 + 1 / self.radius_2

    @property
    def contact_modulus(self) -> float:
        """E*, Pa."""
        return hertz.contact_modulus(*_elastic(self.body_1), *_elastic(self.body_2))

    @property
    def dundurs_beta(self) -> float:
        """Dundurs' constant beta; 0 for like materials."""
        return hertz.dundurs_beta(*_elastic(self.body_1), *_elastic(self.body_2))

    @property
    def smaller_radius(self) -> float:
        """Smaller of both radii, m."""
        return min(abs(self.radius_1), abs(self.radius_2))

    def gap(self, xi: Array) -> Array:
        """Distance (...), m, of the undeformed surfaces at xi (...), m, along the tangent."""
        return _circle(self.radius_1, xi) + _circle(self.radius_2, xi)


@dataclass(frozen=True)
class LineContact:
    """Results of a line contact, SI; stresses in body 1.

    tau_max: maximum in-plane shear; shear_any_plane: maximum shear on any plane.
    """

    p0: float
    half_width: float
    tau_max: float
    tau_depth: float
    von_mises: float
    von_mises_depth: float
    shear_any_plane: float


@dataclass(frozen=True, eq=False)
class FiniteElementContact:
    """Contact by finite elements, with relative error bar, unknowns and residual.

    stresses (3, m) Pa of bodies 1 and 2 at the points of their finer templates, components along
    the surface and into the depth; half_width_hertz (m): unit of length of the templates.
    """

    figures: LineContact
    error_bar: float
    dofs: int
    residual: float
    half_width_hertz: float
    stresses: tuple[Array, Array]


@dataclass(frozen=True)
class ConformingContact:
    """Pin in a hole: half contact angle (rad) and peak pressure (Pa).

    By Persson's closed form for equal materials, else None, and by complementarity with its
    residual.
    """

    persson_angle: float | None
    persson_p0: float | None
    angle: float
    p0: float
    residual: float


def closed_form(pair: TwoCylinders) -> LineContact:
    """Hertz line contact of two cylinders: half-width, pressure, and greatest stresses of body 1
    with their depths; under sliding friction by McEwen's stresses.
    """
    half_width, p0 = (
        float(v)
        for v in hertz.line_contact(pair.line_load, 1 / pair.curvature, pair.contact_modulus)
    )
    nu = pair.body_1.poisson
    mises, mises_depth = hertz.von_mises_peak(nu)
    shear, shear_depth = hertz.SHEAR_MAX, hertz.SHEAR_MAX_DEPTH
    if pair.friction > 0:
        shear, shear_depth = _highest(plane_stress_measures.shear_in_plane, pair.friction)
        mises, mises_depth = _highest(
            lambda s: plane_stress_measures.von_mises(s, nu), pair.friction
        )
    any_plane, _ = _highest(lambda s: plane_stress_measures.shear_any_plane(s, nu), pair.friction)
    return LineContact(
        p0=p0,
        half_width=half_width,
        tau_max=shear * p0,
        tau_depth=shear_depth * half_width,
        von_mises=mises * p0,
        von_mises_depth=mises_depth * half_width,
        shear_any_plane=any_plane * p0,
    )


def is_conforming(pair: TwoCylinders) -> bool:
    """Whether the half contact angle by Hertz exceeds its range of validity, `HALF_ANGLE_MAX`."""
    half_width = closed_form(pair).half_width
    return bool(half_width > np.sin(HALF_ANGLE_MAX) * pair.smaller_radius)


def finite_elements(pair: TwoCylinders) -> FiniteElementContact:
    """Line contact of two cylinders by finite elements, bodies taken as half-planes, with the
    stresses of both.

    The error bar, relative, is the greatest difference to a coarser mesh plus that of the
    half-planes, which grows with (a/R)^2.

    Raises
    ------
    ContactError
        If the half contact angle exceeds `HALF_ANGLE_MAX`.
    """
    if is_conforming(pair):
        raise ContactError(
            f"half contact angle > {shown(HALF_ANGLE_MAX, 'deg', 3)}: the bodies are no "
            "half-planes there; reduce the load or increase the radii"
        )
    fine, error = _solved(pair, _FINE_PATCH), 0.0
    if pair.line_load > 0:
        coarse = _solved(pair, _COARSE_PATCH).figures
        for name in ("p0", "half_width", "tau_max", "von_mises"):
            error = max(error, abs(getattr(coarse, name) / getattr(fine.figures, name) - 1))
        error += _FLATNESS * (fine.figures.half_width / pair.smaller_radius) ** 2
    return replace(fine, error_bar=error)


def conforming(pair: TwoCylinders) -> ConformingContact:
    """Conforming contact of a pin in a hole without friction, beyond the validity of Hertz.

    Raises
    ------
    ContactError
        If neither body is concave, or the half contact angle is too large.
    """
    if pair.radius_1 > 0 and pair.radius_2 > 0:
        raise ContactError(
            f"two convex bodies with a half contact angle > {shown(HALF_ANGLE_MAX, 'deg', 3)}: "
            "small strains do not hold; reduce the load or increase the radii"
        )
    hollow_first = pair.radius_1 < 0
    pin_body, hole_body = (pair.body_2, pair.body_1) if hollow_first else (pair.body_1, pair.body_2)
    clearance = abs(pair.radius_1 + pair.radius_2)
    radius = pair.smaller_radius
    alike = pin_body == hole_body
    angle = p0 = None
    if alike:
        stiffness = pin_body.plane_strain_modulus
        angle = persson_contact_angle(stiffness * clearance / pair.line_load)
        p0 = float(persson_pressure(angle)) * pair.line_load / radius
    numerical = pin_in_hole(
        pair.line_load,
        radius,
        clearance,
        SolidBar(pin_body.modulus, pin_body.poisson),
        Bush(hole_body.modulus, hole_body.poisson),
    )
    return ConformingContact(
        persson_angle=angle,
        persson_p0=p0,
        angle=numerical.contact_angle,
        p0=numerical.peak_pressure,
        residual=max(numerical.equilibrium, numerical.complementarity),
    )


def approach(pair: TwoCylinders, depths: tuple[float | None, float | None]) -> float:
    """Approach of two points remote from the contact, m: in plane strain it depends on the points.

    Of a convex body the point is the centre of the disc, unless a depth is given.

    Parameters
    ----------
    pair : TwoCylinders   radii, materials, line load
    depths : tuple        of the point of each body below the contact, m, much larger than the
                          half-width; None: the centre of the disc

    Raises
    ------
    InputError
        If the depth of a flat or concave body is missing, or one is not above the half-width.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 5.6 and 4.2(c).
    """
    if pair.line_load == 0:
        return 0.0
    half_width = closed_form(pair).half_width
    total = 0.0
    for number, radius, body, depth in (
        (1, pair.radius_1, pair.body_1, depths[0]),
        (2, pair.radius_2, pair.body_2, depths[1]),
    ):
        unit = pair.line_load / (np.pi * body.plane_strain_modulus)
        if depth is not None:
            if not depth > half_width:
                raise InputError(f"depth{number}", depth, "> the half-width")
            nu = body.poisson
            total += unit * (2 * np.log(2 * depth / half_width) - nu / (1 - nu))
        elif 0 < radius < np.inf:
            total += unit * (2 * np.log(4 * radius / half_width) - 1)
        else:
            raise InputError(f"depth{number}", "missing", "specified for a flat or concave body")
    return float(total)


def _solved(pair: TwoCylinders, elements: int) -> FiniteElementContact:
    """Line contact of two cylinders by finite elements, `elements` per half-width of Hertz, with
    the error bar left at 0.
    """
    half_width, p0 = (
        float(v)
        for v in hertz.line_contact(pair.line_load, 1 / pair.curvature, pair.contact_modulus)
    )
    patches = tuple(contact_patch(body.poisson, elements) for body in (pair.body_1, pair.body_2))
    dofs = patches[0].dofs + patches[1].dofs
    if half_width == 0:
        nothing = tuple(np.zeros((3, patch.points.shape[1])) for patch in patches)
        idle = LineContact(*[0.0] * 7)
        return FiniteElementContact(idle, 0.0, dofs, 0.0, 0.0, (nothing[0], nothing[1]))
    contacts = _pressures(pair, (patches[0], patches[1]), half_width)
    field, other = (patch.stress @ contacts.pressure[0] for patch in patches)
    nu = pair.body_1.poisson
    peaks = patches[0].peaks
    if pair.friction > 0:
        sliding = tangential_patch(nu, elements)
        field = field + pair.friction * (sliding.stress @ contacts.pressure[0])
        peaks = sliding.peaks
        # The traction on body 2 is opposite.
        dragged = tangential_patch(pair.body_2.poisson, elements)
        other = other - pair.friction * (dragged.stress @ contacts.pressure[0])
    shear, shear_at = peaks(plane_stress_measures.shear_in_plane(field)[:, None])
    mises, mises_at = peaks(plane_stress_measures.von_mises(field, nu)[:, None])
    figures = LineContact(
        p0=float(contacts.p0[0]) * p0,
        half_width=float(contacts.half_width[0]) * half_width,
        tau_max=float(shear[0]) * p0,
        tau_depth=float(shear_at[1, 0]) * half_width,
        von_mises=float(mises[0]) * p0,
        von_mises_depth=float(mises_at[1, 0]) * half_width,
        shear_any_plane=max(float(shear[0]), _beyond(field, nu)) * p0,
    )
    residual = max(contacts.residual_equilibrium[0], contacts.residual_complementarity[0])
    stresses = (field * p0, other * p0)
    return FiniteElementContact(figures, 0.0, dofs, float(residual), half_width, stresses)


def _beyond(field: Array, poisson: float) -> float:
    """Maximum shear on any plane where it exceeds the in-plane shear, else 0."""
    anywhere = plane_stress_measures.shear_any_plane(field, poisson)
    k = int(anywhere.argmax())
    return (
        float(anywhere[k])
        if anywhere[k] > 1.0001 * plane_stress_measures.shear_in_plane(field).max()
        else 0.0
    )


def patch_mesh(poisson: float) -> tuple[BodyMesh, Index]:
    """Mesh of the contact patch of a body of Poisson's ratio `poisson`, as far as its stresses
    reach, and the index of the stress point at each of its nodes.

    Lengths in half-widths; the surface is y = 0, the body below.
    """
    body, frame, _ = patch_body(poisson, _FINE_PATCH)
    triangles = body.mesh.triangles[:, elements_near(body, frame.origin, STRESS_REACH)]
    nodes = np.unique(triangles)  # corners before middles
    points = body.mesh.points[:, nodes]
    template = contact_patch(poisson, _FINE_PATCH).points * np.array([[1.0], [-1.0]])
    _, order = cKDTree(template.T).query(points.T)
    return BodyMesh(points, np.searchsorted(nodes, triangles), {}), np.asarray(order)


def _pressures(
    pair: TwoCylinders, patches: tuple[ContactPatch, ContactPatch], half_width: float
) -> PatchContacts:
    """Contact pressures between two patches, dimensionless: lengths in half-widths a, gaps in a^2 /
    (2 R), R: relative radius.

    Parameters
    ----------
    pair : TwoCylinders   radii and materials
    patches : tuple       patch of each body
    half_width : float    a, of Hertz, m
    """
    share = pair.contact_modulus / pair.body_1.plane_strain_modulus
    xi, _ = patches[0].shapes.quadrature()
    # In units of a^2 / (2 R); no underflow at small loads.
    gap = pair.gap(half_width * xi) * (2 / pair.curvature / half_width) / half_width
    return solve_patches(patches, (share, 1 - share), gap[None])


def _circle(radius: float, xi: Array) -> Array:
    """Distance (...), m, of a circle from its tangent; negative: concave, zero: flat."""
    if np.isinf(radius):
        return np.zeros_like(xi)
    return xi * (xi / radius) / (1 + np.sqrt(1 - (xi / radius) ** 2))


def _highest(measure: Callable[[Array], Array], friction: float) -> tuple[float, float]:
    """Maximum over the half-plane of a stress measure under a sliding Hertz contact, over p0, and
    its depth, over the half-width.

    Parameters
    ----------
    measure : callable   stresses (3, ...): xx, yy, xy -> measure (...)
    friction : float     traction over pressure
    """
    x, depth = np.meshgrid(np.linspace(-1.5, 1.5, 121), np.linspace(0, 1.5, 61))
    values = measure(hertz.subsurface_stress(x, depth, friction))
    k = int(np.argmax(values))
    start = np.array([x.flat[k], depth.flat[k]])

    def falling(place: Array) -> float:
        near = hertz.subsurface_stress(place[0], abs(place[1]), friction)
        return -float(measure(near))

    lowest = minimize(falling, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-13})
    return -float(lowest.fun), abs(float(lowest.x[1]))


def _elastic(body: Elastic) -> tuple[float, float]:
    return body.modulus, body.poisson
