"""Hertz line contact and its subsurface stress in closed form.

Subsurface fields: `x` along the surface and `depth` into the solid over the half-width, stresses
over the peak pressure.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, Values, finite, positive
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import refined
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_any_plane, von_mises

# In-plane maximum shear under a frictionless line contact (Johnson 1985, sec. 4.2(a)),
# with more digits than printed there.
SHEAR_MAX = 0.300283106
SHEAR_MAX_DEPTH = 0.786151366
_PEAK_ZOOMS = 16  # in the search of the greatest von Mises stress: 2e-10 of the bracket
# Hertz pressure p/p0 at x/a, for piecewise-linear records.
ELLIPSE_XI = np.cos(np.linspace(np.pi, 0.0, 65))
ELLIPSE = np.sqrt(1 - ELLIPSE_XI**2)


def contact_modulus(
    modulus_1: float, poisson_1: float, modulus_2: float, poisson_2: float
) -> float:
    """Contact modulus E*, Pa, of two elastic bodies in plane strain: 1/E* = sum of (1 - nu^2)/E.

    Parameters
    ----------
    modulus_1, modulus_2 : float   Young's moduli, Pa
    poisson_1, poisson_2 : float   Poisson's ratios

    Raises
    ------
    InputError
        If a modulus is not positive or a Poisson ratio is outside [0, 0.5).

    References
    ----------
    Johnson, Contact Mechanics (1985), eq. 4.26.
    """
    compliance = 0.0
    for name, modulus, poisson in (("1", modulus_1, poisson_1), ("2", modulus_2, poisson_2)):
        if not modulus > 0:
            raise InputError(f"modulus_{name}", modulus, "> 0 Pa")
        if not 0 <= poisson < 0.5:
            raise InputError(f"poisson_{name}", poisson, "in [0, 0.5)")
        compliance += (1 - poisson**2) / modulus
    return 1 / compliance


def dundurs_beta(modulus_1: float, poisson_1: float, modulus_2: float, poisson_2: float) -> float:
    """Dundurs' constant beta of two elastic bodies in plane strain, in (-0.5, 0.5).

    Zero: both surfaces strain alike under a pressure, which is then that of a frictionless contact
    for any friction. Positive where body 1 strains more. Parameters as for `contact_modulus`.

    References
    ----------
    Johnson, Contact Mechanics (1985), eq. 5.3.
    """
    shear, bulk = 0.0, 0.0
    bodies = ((modulus_1, poisson_1, 1.0), (modulus_2, poisson_2, -1.0))
    for modulus, poisson, sign in bodies:
        softness = 2.0 * (1.0 + poisson) / modulus  # 1/G
        shear += sign * (1.0 - 2.0 * poisson) * softness
        bulk += (1.0 - poisson) * softness
    return 0.5 * shear / bulk


def line_contact(
    line_load: ArrayLike, relative_radius: ArrayLike, modulus: float
) -> tuple[Array, Array]:
    """Half-width and peak pressure of a Hertz line contact.

    Parameters
    ----------
    line_load : array (...)        P', N/m, >= 0
    relative_radius : array (...)  R, m, 1/R = 1/R1 + 1/R2
    modulus : float                E*, Pa

    Returns
    -------
    half_width, peak_pressure : array (...)   a, m; p0, Pa; both zero where the load is

    Raises
    ------
    InputError
        If a load is negative, a radius or the modulus not positive; NaN included.

    References
    ----------
    Johnson, Contact Mechanics (1985), eqs. 4.43 and 4.45.
    """
    load = finite("line_load", line_load)
    if (load < 0).any():
        raise InputError("line_load", float(load.min()), ">= 0 N/m")
    radius = positive("relative_radius", relative_radius, "m")
    stiffness = float(positive("modulus", modulus, "Pa"))
    half_width = np.sqrt(half_width_square(load, radius, stiffness))
    return half_width, np.sqrt(peak_pressure_square(load, 1 / radius, stiffness))


def peak_pressure_square(line_load: Values, curvature: Values | float, modulus: Value) -> Values:
    """Square p0^2 (...), Pa^2, of the Hertz pressure at the curvature 1/R = 1/R1 + 1/R2, 1/m."""
    return line_load * curvature * (modulus / np.pi)


def half_width_square(line_load: Values, radius: Values | float, modulus: Value) -> Values:
    """Square a^2 (...), m^2, of the Hertz half-width at the relative radius R, m."""
    return line_load * radius * (4.0 / (np.pi * modulus))


def subsurface_stress(x: ArrayLike, depth: ArrayLike, friction: float = 0.0) -> Array:
    """Stress under a Hertz line contact, with a sliding traction `friction` times pressure.

    Parameters
    ----------
    x, depth : array (...)   in half-widths, depth >= 0 into the solid
    friction : float         traction on the solid over pressure, acting along +x

    Returns
    -------
    array (3, ...)   sigma_xx, sigma_zz, tau_xz over p0; tension positive; z is the depth

    References
    ----------
    McEwen (1949), in Johnson, Contact Mechanics (1985), eqs. 4.49 and 7.3; sign of the shear for a
    depth into the solid.
    """
    x, z = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(depth, dtype=float))
    a_term = 1 - x**2 + z**2
    b_term = np.sqrt(a_term**2 + 4 * x**2 * z**2)
    m = np.sqrt(np.maximum(b_term + a_term, 0) / 2)
    n = np.copysign(np.sqrt(np.maximum(b_term - a_term, 0) / 2), x)
    square = np.maximum(m**2 + n**2, np.finfo(float).tiny)
    ratio = (z**2 + n**2) / square
    stress_xx = 2 * z - m * (1 + ratio)
    stress_zz = -m * (1 - ratio)
    shear = -n * (m**2 - z**2) / square
    sliding_xx = n * (2 - (z**2 - m**2) / square) - 2 * x
    return np.stack(
        [
            stress_xx + friction * sliding_xx,
            stress_zz + friction * shear,
            shear + friction * stress_xx,
        ]
    )


def subsurface_displacement(x: ArrayLike, depth: ArrayLike, poisson: float) -> Array:
    """Displacement under a frictionless Hertz line contact.

    Parameters
    ----------
    x, depth : array (...)   in half-widths, depth into the solid

    Returns
    -------
    array (2, ...)   along the surface and into the solid, in units of line load over plane-strain
                     modulus E / (1 - nu^2); rigid motion as in `halfplane.point_force_displacement`
                     with the half-width as the unit of length

    References
    ----------
    Derived here: Flamant's solution superposed with the complex potential
    ``w/(w + r) + ln((w + r)/2) - 1/2``, ``r = sqrt(w^2 - 1)``, ``w = x + i z``, of the Hertz
    pressure (Johnson, Contact Mechanics (1985), sec. 2.6 and 4.2).
    """
    x, z = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(depth, dtype=float))
    w = x + 1j * np.where(np.abs(x) < 1, np.maximum(z, 1e-12), z + 0.0)
    total = w + np.sqrt(w - 1) * np.sqrt(w + 1)
    slope = 2 / total
    # Divided by i, the cut of the logarithm runs outside the solid.
    potential = w / total + np.log(total / 2j) - 0.5
    nu = poisson / (1 - poisson)
    along = (1 - nu) * potential.imag + (1 + nu) * z * slope.real
    into = -2 * potential.real - (1 + nu) * (1 + z * slope.imag)
    return np.stack([along, into]) / np.pi


@lru_cache(maxsize=32)
def von_mises_peak(poisson: float) -> tuple[float, float]:
    """Maximum von Mises stress under a frictionless contact over p0, and its depth over a.

    The maximum on the axis; for small nu it is at the surface.
    """

    def falling(depth: Array) -> Array:
        return -von_mises(subsurface_stress(0.0, depth), poisson)

    lowest, depth = refined(falling, np.array([1.15]), 0.85, _PEAK_ZOOMS)
    # Two local maxima: one below the surface, one at it, the larger for small nu.
    at_surface = falling(np.zeros(1))
    if at_surface[0] <= lowest[0]:
        return -float(at_surface[0]), 0.0
    return -float(lowest[0]), float(depth[0])


def curved_surface_stress(x: ArrayLike, depth: ArrayLike) -> Array:
    """First-order stress of the curvature of the loaded surface under a Hertz pressure.

    On a convex body the pressure beside the centre acts below the tangent of the half-plane.
    Multiply by p0 times half-width times curvature of the body (1/R, convex positive). Pressures
    act along the common normal at the centre of the contact.

    Parameters
    ----------
    x, depth : array (...)   in half-widths; depth is counted from the curved surface

    Returns
    -------
    array (3, ...)   sigma_xx, sigma_zz, tau_xz over ``p0 a / R``; tension positive

    References
    ----------
    Derived here: the half-plane field with each pressure element lowered by ``xi^2/(2R)``,
    to first order, with the complex potential ``pi (w - sqrt(w^2 - 1))``, ``w = x + i z``, of
    the Hertz pressure (Johnson, Contact Mechanics (1985), sec. 2.8 and 4.2).
    """
    x, z = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(depth, dtype=float))
    w = x + 1j * np.maximum(z, 1e-9)
    root = np.sqrt(w - 1) * np.sqrt(w + 1)
    potential, first, second = np.pi * (w - root), np.pi * (1 - w / root), np.pi / root**3
    # The pressure times xi^2 has the potential w^2 F - pi w / 2.
    slope = x**2 * first - (2 * w * potential + w**2 * first - np.pi / 2)
    bend = x**2 * second - (2 * potential + 4 * w * first + w**2 * second)
    total = slope.real / np.pi
    difference = -(slope.real - z * bend.imag) / np.pi
    shear = -(slope.imag + z * bend.real) / (2 * np.pi)
    return np.stack([(total - difference) / 2, (total + difference) / 2, shear])


@lru_cache(maxsize=32)
def shear_any_plane_peak(poisson: float) -> float:
    """Maximum shear on any plane on the axis of a frictionless contact, over p0."""
    depth = np.linspace(0.0, 2.0, 2001)
    return float(shear_any_plane(subsurface_stress(0.0, depth), poisson).max())


def disc_correction(line_load: ArrayLike, radius: ArrayLike) -> Array:
    """Increase of the maximum in-plane shear (...), Pa, of a disc over the half-plane.

    For a disc loaded along a diameter, to first order in half-width over radius. The far load and
    the free rim add ``sigma_xx = P'/(pi R)`` along the surface and nothing along the load, half of
    which is shear; the curvature of the surface reduces it by a quarter.

    Parameters
    ----------
    line_load : array (...)   P', N/m
    radius : array (...)      of the disc, m

    References
    ----------
    Timoshenko and Goodier, Theory of Elasticity (1970), art. 41 (disc under two opposite
    forces), with `curved_surface_stress`.
    """
    xx, zz, _ = curved_surface_stress(0.0, SHEAR_MAX_DEPTH)
    # p0 a = 2 P' / pi
    share = 1 / (2 * np.pi) + (xx - zz) / np.pi
    return np.asarray(share * np.asarray(line_load, dtype=float) / np.asarray(radius, dtype=float))
