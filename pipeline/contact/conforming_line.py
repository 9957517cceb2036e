"""Conforming line contact of a roller in a concave wall, solved in full, beside that of Hertz.

The roller is a solid bar loaded on its axis, the wall a hole in an infinite body; no friction, gap
and loads as of `pin_in_hole`, whose complementarity it replaces by collocation at a stated contact
angle. The ratios to Hertz depend on the materials and on one number, the half-width of Hertz over
the radius sqrt(r rho) of a roller r in a wall rho; a polynomial in it serves many positions.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, freeze, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.elasticity.plane_stress_measures import all_measures
from camwright.pipeline.contact.elasticity.radial_compliance import (
    Bush,
    SolidBar,
    bush_compliance,
    pin_compliance,
)

CONFORMING_FROM = 0.02
"""Half-width of Hertz over sqrt(r rho) from which a concave contact is solved in full.

Below it the pressure of Hertz errs by at most 0.5 % for any two elastic materials.
"""

ANGLE_MAX = np.radians(70.0)
"""Greatest half contact angle, rad; beyond it the contact is not known."""

FINITE_STRAIN = 0.4
"""Relative error of the pressure over p0/E*, that of one radius of both bodies and small strains.

Finite elements of a roller in a recess wider by up to 0.3 of its radius: at most 0.36.
"""

_TERMS, _FEWER = 12, 8  # of the pressure
_NODES = 18  # of the polynomials
_QUADRATURE = 120  # nodes on half the contact, of the harmonics of the pressure
_DEPTHS = np.append(0.0, np.linspace(0.06, 1.2, 115))  # of the stresses, over the half-width
_STRESS_ANGLES = np.radians([1, 2, 3.5, 5, 7.5, 10, 12.5, 15, 20, 25, 30, 35, 40, 45, 50, 60, 70])
_V, _W = np.polynomial.legendre.leggauss(48)
# Between two singular ends: v^3 (10 - 15 v + 6 v^2) has no slope at either.
_V, _W = 0.5 * (1.0 + _V), 0.5 * _W
_STEP, _SLOPE = _V**3 * (10.0 - 15.0 * _V + 6.0 * _V**2), 30.0 * _W * (_V * (1.0 - _V)) ** 2


class Collocated(NamedTuple):
    """Contact at a stated half angle at unit line load and radius.

    clearance : radial, over line load times the mean of both compliances (1 - nu^2)/E
    terms : (k,) of the pressure over load and radius sqrt(1 - t^2) sum_k terms T_2k(t), t: angle
    over half angle
    """

    clearance: float
    terms: Array

    @property
    def peak(self) -> float:
        """Pressure on the line of action over load and radius."""
        return float(self.terms[::2].sum() - self.terms[1::2].sum())

    @property
    def slenderness(self) -> float:
        """Half-width of Hertz over the radius at the same load and clearance."""
        return float(np.sqrt(8.0 / (np.pi * self.clearance)))

    @property
    def ratio(self) -> float:
        """Peak pressure over that of Hertz."""
        return 0.5 * np.pi * self.slenderness * self.peak


def collocated(
    half_angle: float, roller: Elastic, wall: Elastic, terms: int = _TERMS
) -> Collocated:
    """Pressure and clearance of a roller in a wall at a stated half contact angle, by collocation.

    The gap closes at `terms` + 1 Chebyshev points of one half of the contact.

    Parameters
    ----------
    half_angle : float       half of the angle in contact, rad, > 0 and below pi/2
    roller, wall : Elastic   materials
    terms : int              number of terms of the pressure, see `Collocated`

    References
    ----------
    Integral equation of Persson (1964) and of Ciavarella and Decuzzi, Int. J. Solids Struct. 38
    (2001) 4525, for unlike materials, here by displacements; collocation of pressures with
    square-root ends by Erdogan and Gupta, Q. Appl. Math. 29 (1972) 525.
    """
    bar, hole = SolidBar(roller.modulus, roller.poisson), Bush(wall.modulus, wall.poisson)
    mean = 0.5 * (1.0 / bar.plane_strain_modulus + 1.0 / hole.plane_strain_modulus)
    w = (pin_compliance(4, bar) + bush_compliance(4, hole)) / mean
    # w_n = sooner/(n - 1) + later/(n + 1) from the second harmonic on
    later = 12.0 * w[3] - 6.0 * w[2]
    sooner = w[2] - later / 3.0
    count = terms + 1
    t = np.cos(0.25 * np.pi * (2.0 * np.arange(count) + 1.0) / count)[:, None]
    s = np.hstack([(1.0 + t) * _STEP - 1.0, t + (1.0 - t) * _STEP])
    weight = half_angle / np.pi * np.hstack([(1.0 + t) * _SLOPE, (1.0 - t) * _SLOPE])
    x = half_angle * np.abs(t - s)
    # Sums of w_n cos(n x), by those of cos(m x)/m and sin(m x)/m.
    kernel = 0.5 * w[0] - (sooner + later) * np.cos(x) * np.log(2.0 * np.sin(0.5 * x))
    kernel += 0.5 * (later - sooner) * np.sin(x) * (np.pi - x) - later * (1.0 + 0.5 * np.cos(x))
    shapes = np.sqrt(1.0 - s**2) * np.cos(2.0 * np.arange(terms)[:, None, None] * np.arccos(s))
    cosine = np.cos(half_angle * t[:, 0])
    system = np.zeros((count + 1, count + 1))
    system[:count, :terms] = np.einsum("kms,ms->mk", shapes, kernel * weight)
    system[:count, terms], system[:count, count] = 1.0 - cosine, -cosine
    nodes = np.pi * (np.arange(64) + 0.5) / 64.0
    carried = np.cos(2.0 * np.outer(np.arange(terms), nodes)) * np.sin(nodes) ** 2
    system[count, :terms] = carried @ np.cos(half_angle * np.cos(nodes)) * (half_angle * np.pi / 64)
    solved = np.linalg.solve(system, np.append(np.zeros(count), 1.0))
    return Collocated(float(solved[terms]), solved[:terms])


def axis_stress(contact: Collocated, half_angle: float, poisson: float, depth: Array) -> Array:
    """Stress of the wall on the line of action, below the middle of the contact.

    Parameters
    ----------
    contact : Collocated   pressure on the wall
    half_angle : float     of `contact`, rad
    poisson : float        Poisson's ratio of the wall
    depth : array (k,)     into the wall over the radius, ascending, the first 0

    Returns
    -------
    array (2, k)   stress along the wall and into its depth, over line load per radius; tension
        positive

    References
    ----------
    Barber, Elasticity (2010), Michell's solution, tables 8.1 and 9.1, for a hole under pressures
    p_n cos(n phi), whose force is held at infinity.
    """
    kappa = 3.0 - 4.0 * poisson
    n = np.arange(max(int(18.0 / depth[1]), 8))
    nodes = 0.5 * np.pi * (np.arange(_QUADRATURE) + 0.5) / _QUADRATURE
    shape = contact.terms @ np.cos(2.0 * np.outer(np.arange(contact.terms.size), nodes))
    shape *= np.sin(nodes) ** 2 * (half_angle / _QUADRATURE)
    p = np.cos(np.outer(n * half_angle, np.cos(nodes))) @ shape
    p[0] *= 0.5
    r = 1.0 + depth[1:]
    shrink, first = 1.0 / r**2, 0.5 * p[1] * (kappa - 1.0) / (kappa + 1.0)
    decay = r[:, None] ** -n[2:]
    rise, level = decay @ (n[2:] * p[2:]), decay @ p[2:]
    into = 0.5 * (shrink - 1.0) * rise - level - p[0] * shrink
    into += first * (1.0 - shrink) / r - p[1] / r
    along = 0.5 * (1.0 - shrink) * rise - level + p[0] * shrink + first * (1.0 + shrink) / r
    hoop = 2.0 * (p[0] + p[1] * kappa / (kappa + 1.0)) - contact.peak  # at the surface
    return np.stack([np.append(hoop, along), np.append(-contact.peak, into)])


class _Ratios(NamedTuple):
    """Chebyshev coefficients of pressure and half angle over those of Hertz and of the terms of the
    pressure over its peak, over the arctangent of the slenderness from 0 to `most`; relative error
    of the pressure.
    """

    pressure: Array
    angle: Array
    terms: Array
    most: float
    error: float


@lru_cache(maxsize=32)
def _ratios(roller: Elastic, wall: Elastic) -> _Ratios:
    """Table of the contacts of two materials, by polynomials through contacts at angles up to
    `ANGLE_MAX`; the contact of Hertz at slenderness 0.
    """
    angles = 0.5 * ANGLE_MAX * (1.0 - np.cos(np.pi * np.arange(1, _NODES + 1) / _NODES))
    fine = [collocated(float(each), roller, wall) for each in angles]
    coarse = [collocated(float(each), roller, wall, _FEWER) for each in angles]
    reach = np.array([each.slenderness for each in fine])
    abscissa = 2.0 * np.arctan(np.append(0.0, reach)) / np.arctan(reach[-1]) - 1.0
    peak, other = (np.array([each.ratio for each in some]) for some in (fine, coarse))
    pressure = chebyshev.chebfit(abscissa, np.append(1.0, peak), _NODES)
    angle = chebyshev.chebfit(abscissa, np.append(1.0, angles / reach), _NODES)
    shapes = [np.eye(1, _TERMS)[0], *(each.terms / each.peak for each in fine)]
    terms = chebyshev.chebfit(abscissa, np.stack(shapes), _NODES)
    # The last coefficients are the error of the polynomial, the coarse one that of the collocation.
    error = np.abs(pressure[-2:]).sum() + np.abs(other / peak - 1.0).max()
    return _Ratios(pressure, angle, terms, float(np.arctan(reach[-1])), float(error))


@lru_cache(maxsize=32)
def _stresses(roller: Elastic, wall: Elastic) -> Array:
    """Table of the greatest stresses on the axis of the wall: columns by half contact angle, that
    of Hertz first.

    Returns
    -------
    array (6, k)   half angle, rad; in-plane shear and its depth; shear on any plane; von Mises
        stress and its depth; stresses over the peak pressure, depths over the half-width
    """
    mises, depth = hertz.von_mises_peak(wall.poisson)
    any_plane = hertz.shear_any_plane_peak(wall.poisson)
    rows = [[0.0, hertz.SHEAR_MAX, hertz.SHEAR_MAX_DEPTH, any_plane, mises, depth]]
    for angle in _STRESS_ANGLES:
        contact = collocated(float(angle), roller, wall)
        into = axis_stress(contact, angle, wall.poisson, _DEPTHS * np.sin(angle)) / contact.peak
        measures = all_measures(np.stack([*into, np.zeros(_DEPTHS.size)]), wall.poisson)
        shear, any_plane, mises = (each.max() for each in measures)
        shear_at, _, mises_at = (_DEPTHS[each.argmax()] for each in measures)
        rows.append([angle, shear, shear_at, any_plane, mises, mises_at])
    return np.array(rows).T


@dataclass(frozen=True, eq=False)
class ConformingLine:
    """Line contacts (n,) of a roller in a concave wall, SI, solved in full, and those of Hertz.

    half_angle, rad, half of that in contact on the radius sqrt(r rho); half_width along the
    tangent; p0 on the line of action; error, relative, of p0; greatest stresses in the wall, Pa, as
    of `ContactHistory`, and their depths; terms (k, n) of the pressure over its peak, see
    `Collocated`. NaN beyond `ANGLE_MAX`.
    """

    half_angle: Array
    half_width: Array
    p0: Array
    error: Array
    half_width_hertz: Array
    p0_hertz: Array
    tau_max: Array
    tau_depth: Array
    tau_any_plane: Array
    von_mises: Array
    von_mises_depth: Array
    radius: Array
    terms: Array

    def __post_init__(self) -> None:
        freeze(self, **{each.name: getattr(self, each.name) for each in fields(self)})

    def pressure(self, xi: Array) -> Array:
        """Pressure (n, q), Pa, at distances (n, q), m, from the middle along the tangent."""
        turned = np.arcsin(np.clip(xi / self.radius[:, None], -1.0, 1.0))
        inside = np.clip(turned / self.half_angle[:, None], -1.0, 1.0)
        even = np.cos(2.0 * np.arange(_TERMS)[:, None, None] * np.arccos(inside))
        shape = np.sqrt(1.0 - inside**2) * np.einsum("kn,knq->nq", self.terms, even)
        return np.asarray(self.p0[:, None] * shape)


def conforming_line(
    line_load: ArrayLike,
    roller_radius: ArrayLike,
    wall_radius: ArrayLike,
    roller: Elastic,
    wall: Elastic,
) -> ConformingLine:
    """Contact of a roller in a concave wall under line loads, by the table of its materials.

    Parameters
    ----------
    line_load : array (n,)      P', N/m, >= 0
    roller_radius : float or array (n,)   r, m, > 0
    wall_radius : array (n,)    rho, m, > r

    Raises
    ------
    InputError
        If a value is out of these bounds; NaN included.
    """
    radius = positive("wall_radius", wall_radius, "m")
    inner = positive("roller_radius", roller_radius, "m")
    if not (inner < radius).all():
        raise InputError("roller_radius", float(inner.max()), "below the radius of the wall")
    modulus = hertz.contact_modulus(roller.modulus, roller.poisson, wall.modulus, wall.poisson)
    relative = inner * radius / (radius - inner)
    half_width, p0 = hertz.line_contact(line_load, relative, modulus)
    middle = np.sqrt(inner * radius)
    slenderness, ratios = half_width / middle, _ratios(roller, wall)
    at = np.arctan(slenderness) / ratios.most
    abscissa = 2.0 * np.where(at <= 1.0, at, np.nan) - 1.0
    peak = p0 * chebyshev.chebval(abscissa, ratios.pressure)
    angle = slenderness * chebyshev.chebval(abscissa, ratios.angle)
    wide = middle * np.sin(angle)
    rows = _stresses(roller, wall)
    shear, shear_depth, any_plane, mises, mises_depth = (
        np.interp(angle, rows[0], each) for each in rows[1:]
    )
    return ConformingLine(
        half_angle=angle,
        half_width=wide,
        p0=peak,
        error=ratios.error + FINITE_STRAIN * peak / modulus,
        half_width_hertz=half_width,
        p0_hertz=p0,
        tau_max=shear * peak,
        tau_depth=shear_depth * wide,
        tau_any_plane=any_plane * peak,
        von_mises=mises * peak,
        von_mises_depth=mises_depth * wide,
        radius=middle,
        terms=np.asarray(chebyshev.chebval(abscissa, ratios.terms)),
    )


def concave_line(
    line_load: Array, relative_radius: Array, roller_radius: Array, roller: Elastic, wall: Elastic
) -> tuple[NDArray[np.bool_], ConformingLine | None]:
    """Whether a contact is that of a concave wall, to be solved in full (n,), bool, and these
    contacts.

    In full from a half-width of Hertz of `CONFORMING_FROM` times sqrt(r rho).

    Parameters
    ----------
    line_load : array (n,)         P', N/m, >= 0
    relative_radius : array (n,)   R, m, 1/R = 1/r - 1/rho: above r on a concave wall
    roller_radius : array (n,)     r, m
    roller, wall : Elastic         materials

    Returns
    -------
    full : array (n,)               bool
    line : ConformingLine or None   the contacts where `full`; None without one
    """
    modulus = hertz.contact_modulus(roller.modulus, roller.poisson, wall.modulus, wall.poisson)
    half_width, _ = hertz.line_contact(line_load, relative_radius, modulus)
    # 1/(r rho) = (1/r)(1/r - 1/R)
    square = np.maximum(1.0 / roller_radius - 1.0 / relative_radius, 0.0) / roller_radius
    full = half_width * np.sqrt(square) >= CONFORMING_FROM
    if not full.any():
        return full, None
    inner = roller_radius[full]
    return full, conforming_line(line_load[full], inner, 1.0 / (inner * square[full]), roller, wall)
