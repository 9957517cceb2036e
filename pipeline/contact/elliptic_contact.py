"""Hertz contact of a crowned follower on a straight cam: ellipse, pressure, stress on its axis.

The rolling direction is that of the relative radius R, the axial one that of the crown radius. The
ellipse has the semi-axes b in the rolling and a in the axial direction; where the crown is rounder
than the cam they change places, and the formulas hold for the longer one as a.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.contact.contact_history import ContactHistory

_RATIO_MIN, _RATIO_MAX = 1e-5, 0.995
_BISECTIONS = 60
_TABLE, _FINE_TABLE = 200, 4000


@dataclass(frozen=True, eq=False)
class Ellipse:
    """Elliptic contact at n loads: half_width b (rolling), half_length a (axial), m; p0, Pa."""

    half_width: Array
    half_length: Array
    p0: Array

    def __post_init__(self) -> None:
        freeze(self, half_width=self.half_width, half_length=self.half_length, p0=self.p0)


def elliptic_contact(
    force: ArrayLike,
    relative_radius: ArrayLike,
    crown_radius: ArrayLike,
    modulus: float,
    *,
    interpolated: bool = False,
) -> Ellipse:
    """Semi-axes and peak pressure of a Hertz contact of crossed curvatures.

    Parameters
    ----------
    force : array (...)            N, >= 0
    relative_radius : array (...)  R in the rolling direction, m, 1/R = 1/R1 + 1/R2
    crown_radius : array (...)     in the axial direction, m, of the follower on a straight cam
    modulus : float                E*, Pa
    interpolated : bool            axis ratio from a table: 1e-6, of many contacts

    Returns
    -------
    Ellipse   zero where the force is

    Raises
    ------
    InputError
        If a force is negative, a radius or the modulus not positive; NaN included.

    References
    ----------
    Johnson, Contact Mechanics (1985), eqs. 4.26 to 4.32: (E/k^2 - K)/(K - E) = R'/R'',
    a^3 = 3 P R' (K - E)/(pi E* m), k = b/a, m = 1 - k^2; p0 = 3 P/(2 pi a b).
    """
    load = finite("force", force)
    if (load < 0).any():
        raise InputError("force", float(load.min()), ">= 0 N")
    radius = positive("relative_radius", relative_radius, "m")
    axial = positive("crown_radius", crown_radius, "m")
    stiffness = float(positive("modulus", modulus, "Pa"))
    load, radius, axial = np.broadcast_arrays(load, radius, axial)
    longer, shorter = np.maximum(axial, radius), np.minimum(axial, radius)
    ratio = (_axis_ratio_of_table if interpolated else axis_ratio)(longer / shorter)
    _, first, second = _integrals(ratio)
    major = np.cbrt(3.0 * load * longer * (first - second) / (np.pi * stiffness * (1 - ratio**2)))
    minor = ratio * major
    area = np.pi * major * minor
    peak = np.divide(1.5 * load, area, out=np.zeros(area.shape), where=area > 0)
    along = axial >= radius
    return Ellipse(np.where(along, minor, major), np.where(along, major, minor), peak)


def axis_ratio(radii: ArrayLike) -> Array:
    """Shorter over longer semi-axis (...), at the ratio of the radii (...), >= 1, by bisection.

    A circle is an ellipse of 0.995.
    """
    wanted = np.asarray(radii, dtype=float)
    low = np.full(wanted.shape, np.log(_RATIO_MIN))
    high = np.full(wanted.shape, np.log(_RATIO_MAX))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        steeper = _radii(np.exp(middle)) > wanted
        low, high = np.where(steeper, middle, low), np.where(steeper, high, middle)
    return np.asarray(np.exp(0.5 * (low + high)))


def _axis_ratio_of_table(radii: Array) -> Array:
    """As `axis_ratio`, from a table."""
    logs, ratios = _axis_ratios()
    return np.asarray(np.exp(np.interp(np.log(radii), logs, ratios)))


@lru_cache(maxsize=1)
def _axis_ratios() -> tuple[Array, Array]:
    """Logarithms of ratios of the radii, rising, and of the axis ratios there, (q,)."""
    ratio = np.linspace(np.log(_RATIO_MAX), np.log(_RATIO_MIN), _FINE_TABLE)
    return np.log(_radii(np.exp(ratio))), ratio


def pressure_cubed_per_force(curvature: ArrayLike, crown_radius: float, modulus: float) -> Array:
    """p0^3 over the force (...), Pa^3/N, at the relative curvature 1/R (...), 1/m."""
    radius = 1.0 / np.asarray(curvature, dtype=float)
    return np.asarray(elliptic_contact(1.0, radius, crown_radius, modulus).p0 ** 3)


def _integrals(ratio: Array) -> tuple[Array, Array, Array]:
    """Parameter m, and complete elliptic integrals K(m), E(m), of an axis ratio (...)."""
    parameter = 1.0 - ratio**2
    return (
        parameter,
        np.asarray(scipy.special.ellipkm1(ratio**2)),
        np.asarray(scipy.special.ellipe(parameter)),
    )


def _radii(ratio: Array) -> Array:
    _, first, second = _integrals(ratio)
    return np.asarray((second / ratio**2 - first) / (first - second))


def axis_stress(ratio: float, depth: ArrayLike, poisson: float) -> Array:
    """Principal stresses on the axis below an elliptic Hertz contact.

    Parameters
    ----------
    ratio : float         k = b/a, in (0, 1)
    depth : array (...)   over the shorter semi-axis b
    poisson : float

    Returns
    -------
    array (3, ...)   along the longer and the shorter axis, and normal, over p0; tension positive

    References
    ----------
    Thomas and Hoersch (1930), in Johnson, Contact Mechanics (1985), eq. 3.69.
    """
    z = np.asarray(depth, dtype=float) * ratio
    parameter, square = 1.0 - ratio**2, 1.0 / ratio**2
    t = np.sqrt((ratio**2 + z**2) / (1.0 + z**2))
    angle = np.arctan2(1.0, z)
    first, second = (
        scipy.special.ellipkinc(angle, parameter),
        scipy.special.ellipeinc(angle, parameter),
    )
    inner, outer = z * (first - second), z * (square * second - first)
    along = -0.5 * (1.0 - t) + inner + poisson * (1.0 - square * t + outer)
    across = 0.5 + 0.5 / t - square * t + outer + poisson * (t - 1.0 + inner)
    normal = -0.5 * (1.0 - t**2) / t
    return np.asarray(2.0 * ratio / parameter * np.stack([along, across, normal]))


@lru_cache(maxsize=8)
def _peaks(poisson: float) -> tuple[Array, Array]:
    """Logarithms of axis ratios (q,), and peaks over p0 and depths over b there, (5, q).

    Rows: shear across the rolling direction and its depth, shear on any plane, von Mises and its
    depth.
    """
    ratios = np.geomspace(_RATIO_MIN * 10.0, _RATIO_MAX, _TABLE)
    depth = np.linspace(0.2, 1.5, 1301)
    rows = np.empty((5, ratios.size))
    for column, ratio in enumerate(ratios):
        along, across, normal = axis_stress(float(ratio), depth, poisson)
        shear = 0.5 * np.abs(across - normal)
        whole = np.maximum(shear, 0.5 * np.maximum(np.abs(along - normal), np.abs(along - across)))
        squares = (along - across) ** 2 + (across - normal) ** 2 + (normal - along) ** 2
        mises = np.sqrt(0.5 * squares)
        rows[:, column] = (
            shear.max(), depth[shear.argmax()], whole.max(), mises.max(), depth[mises.argmax()],
        )  # fmt: skip
    return np.log(ratios), rows


@dataclass(frozen=True, eq=False)
class CrownedContact:
    """Contact history of a crowned follower: peaks and depths of the ellipse in place of the line.

    Finite elements over Hertz stay those of the plane problem. half_length (n,), m, is the axial
    semi-axis; truncated (n,), bool, where the ellipse is longer than the width of the contact:
    there the pressure is at least that of the line, and the ends carry an edge pressure.
    """

    history: ContactHistory
    half_length: Array
    truncated: NDArray[np.bool_]


def crowned_contact(
    plane: ContactHistory, width: float, crown_radius: float, modulus: float, poisson: float
) -> CrownedContact:
    """Contact of a crowned follower from that of a straight one of a width, m.

    Parameters
    ----------
    plane : ContactHistory   of the straight follower under the same forces
    width : float            of its line contact, m
    crown_radius : float     m
    modulus : float          E*, Pa
    poisson : float          of the cam
    """
    loaded = plane.p0_hertz > 0
    force = np.where(loaded, plane.line_load, 0.0) * width
    ellipse = elliptic_contact(
        force, np.where(loaded, plane.relative_radius, 1.0), crown_radius, modulus
    )
    truncated = loaded & (2.0 * ellipse.half_length > width)
    line = truncated & (ellipse.p0 < plane.p0_hertz)
    use = loaded & ~line

    def over(part: Array, whole: Array) -> Array:
        return np.divide(part, whole, out=np.ones(use.shape), where=use)

    pressure = over(ellipse.p0, plane.p0_hertz)
    half = over(ellipse.half_width, plane.half_width_hertz)
    shorter = np.minimum(ellipse.half_width, ellipse.half_length)
    ratio = over(shorter, np.maximum(ellipse.half_width, ellipse.half_length))
    size = over(shorter, plane.half_width_hertz)
    logs, rows = _peaks(poisson)
    shear, shear_depth, whole, mises, mises_depth = (
        np.where(use, np.interp(np.log(ratio), logs, row) / row[0], 1.0) for row in rows
    )
    history = replace(
        plane,
        p0=plane.p0 * pressure,
        half_width=plane.half_width * half,
        tau_max=plane.tau_max * pressure * shear,
        tau_depth=plane.tau_depth * size * shear_depth,
        tau_any_plane=plane.tau_any_plane * pressure * whole,
        von_mises=plane.von_mises * pressure * mises,
        von_mises_depth=plane.von_mises_depth * size * mises_depth,
    )
    return CrownedContact(history, ellipse.half_length, truncated)
