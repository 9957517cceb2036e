"""Conforming contact of a pin in a hole, by Persson's solution and by complementarity.

Positions are angles phi from the line of action; loads are per length, N/m; `clearance` is radial,
hole less pin. Under a frictionless pressure p(phi) the gap is

    gap(phi) = clearance (1 - cos phi) - approach cos phi + sum_n w_n p_n cos(n phi),

where w_n is the radial compliance of both bodies to the n-th harmonic of the pressure.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.monotone_cubic import MonotoneCubic
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact.elasticity import active_set, radial_compliance
from camwright.pipeline.contact.elasticity.active_set import solve
from camwright.pipeline.contact.elasticity.radial_compliance import (
    Bush,
    SolidBar,
    bush_compliance,
    pin_compliance,
)

KNOTS = 96  # of the pressure on half the contact
WINDOW_MAX = np.radians(120.0)
_HARMONICS = 10  # per knot: the remainder decreases with the fifth power of the number
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
_LEAST_ANGLE = np.radians(2.0)  # below, two cylinders of Hertz to 1e-3
_FILLED = (0.6, 0.9)  # share of the window in contact
# Modules whose source enters the cache key.
RECIPE = (sys.modules[__name__], active_set, radial_compliance)


@dataclass(frozen=True, eq=False)
class Conforming:
    """Contact of a pin in a hole: pressure (knots,), Pa, over the angle, rad, of one side.

    `contact_angle`: half the angle in contact, rad; `peak_pressure` Pa; `approach` m; relative
    residuals of equilibrium and complementarity, see `active_set`.
    """

    angle: Array
    pressure: Array
    contact_angle: float
    peak_pressure: float
    approach: float
    equilibrium: float
    complementarity: float

    def __post_init__(self) -> None:
        freeze(self, angle=self.angle, pressure=self.pressure)


def persson_clearance(contact_angle: ArrayLike) -> Array:
    """Persson's load parameter E' dR / Q (...) at half contact angles (...), rad, of two bodies of
    one material; < 0 for a press fit.

    E' is E in plane stress and E/(1 - nu^2) in plane strain, dR the radial clearance, m, and Q the
    load per length, N/m.

    References
    ----------
    Persson, On the stress distribution of cylindrical elastic bodies in contact (1964);
    Ciavarella and Decuzzi, Int. J. Solids Struct. 38 (2001) 4507.
    """
    b = np.tan(np.asarray(contact_angle, dtype=float) / 2.0)[..., None]
    S = np.sqrt(1.0 + b**2)
    # t = b sin(u) removes the root singularities at the ends
    u = 0.25 * np.pi * (1.0 + _NODES)
    s, t = b * np.cos(u), b * np.sin(u)
    weight = 0.25 * np.pi * _WEIGHTS * b * np.cos(u)
    integral = 2.0 * np.sum(weight * np.log((S + s) / (S - s)) / (1.0 + t**2), axis=-1)
    square = b[..., 0] ** 2
    return np.asarray(
        2.0 * (1.0 - square) / (np.pi * square) - integral / (np.pi**2 * square * (1.0 + square))
    )


def persson_pressure(contact_angle: ArrayLike, angle: ArrayLike = 0.0) -> Array:
    """Persson's pressure p R / Q (...) at an angle from the line of action, rad; 0 beyond the
    contact.

    Parameters
    ----------
    contact_angle : array (...)   half the angle in contact, rad
    angle : array (...)           from the line of action, rad
    """
    b = np.tan(np.asarray(contact_angle, dtype=float) / 2.0)
    y = np.tan(np.asarray(angle, dtype=float) / 2.0)
    S, s = np.sqrt(1.0 + b**2), np.sqrt(np.maximum(b**2 - y**2, 0.0))
    root = 2.0 / (np.pi * S) * s / (1.0 + y**2)
    return np.asarray(root + np.log((S + s) / (S - s)) / (2.0 * np.pi * b**2 * (1.0 + b**2)))


def persson_contact_angle(clearance_number: float) -> float:
    """Persson's half contact angle, rad, at a load parameter `clearance_number` = E' dR / Q >= 0,
    see `persson_clearance`.

    Raises
    ------
    InputError
        If the number is negative (press fit), NaN or infinite.
    """
    if not 0.0 <= clearance_number < np.inf:
        raise InputError("clearance", clearance_number, ">= 0: a press fit cannot slide")

    def miss(angle: float) -> float:
        return float(persson_clearance(angle)) - clearance_number

    low = 1e-3
    while miss(low) < 0.0:
        low *= 0.1
    return float(scipy.optimize.brentq(miss, low, np.pi / 2.0, xtol=1e-14, rtol=1e-13))


def pin_in_hole(
    load: float, radius: float, clearance: float, pin: SolidBar, bush: Bush, knots: int = KNOTS
) -> Conforming:
    """Pressure between pin and hole at angular knots, by complementarity.

    Parameters
    ----------
    load : float        Q, N/m, > 0
    radius : float      R, m, > 0
    clearance : float   dR, radial, m, >= 0; 0 is a perfect fit
    pin, bush : SolidBar, Bush
    knots : int         of the pressure on half the contact

    Returns
    -------
    Conforming

    Raises
    ------
    InputError
        If a value is out of these bounds; a negative clearance is a press fit.
    ContactError
        If the half contact angle exceeds `WINDOW_MAX`, or its extent does not settle.

    References
    ----------
    Gap by Persson (1964); solution by `active_set`.
    """
    for name, value, unit in (("load", load, "N/m"), ("radius", radius, "m")):
        if not 0.0 < value < np.inf:
            raise InputError(f"pin_in_hole.{name}", value, f"> 0 {unit}")
    if not 0.0 <= clearance < np.inf:
        raise InputError("pin_in_hole.clearance", clearance, ">= 0 m: a press fit cannot slide")
    unit_load = _mean_compliance(pin, bush) * load
    window = min(1.3 * persson_contact_angle(clearance / unit_load), WINDOW_MAX)
    for _ in range(12):
        contact = _in_window(window, clearance / unit_load, pin, bush, knots)
        share = contact.contact_angle / window
        if _FILLED[0] <= share <= _FILLED[1]:
            break
        if share > _FILLED[1] and window >= WINDOW_MAX:
            raise ContactError(
                f"pin in hole: half contact angle = {shown(contact.contact_angle, 'deg', 3)},"
                f" must be < {shown(WINDOW_MAX, 'deg', 3)}"
            )
        window = min(window * (1.4 if share > _FILLED[1] else share / 0.75), WINDOW_MAX)
    else:
        raise ContactError("pin in hole: the extent of the contact did not settle")
    return Conforming(
        angle=contact.angle,
        pressure=contact.pressure * load / radius,
        contact_angle=contact.contact_angle,
        peak_pressure=contact.peak_pressure * load / radius,
        approach=contact.approach * unit_load,
        equilibrium=contact.equilibrium,
        complementarity=contact.complementarity,
    )


def hat_coefficients(window: float, knots: int, count: int) -> Array:
    """Cosine coefficients (knots, count) of hat functions on [0, window], order n < count.

    Knots at equal steps from 0; the first is half a hat function, as the pressure is even; the last
    knot carries no pressure.
    """
    step = window / knots
    n = np.arange(1, count)
    sharpness = (2.0 * np.sin(0.5 * n * step)) ** 2 / (step * n**2)
    coefficients = np.empty((knots, count))
    coefficients[:, 0] = step
    coefficients[:, 1:] = np.cos(np.outer(np.arange(knots) * step, n)) * sharpness
    coefficients[0] *= 0.5
    return coefficients


def _mean_compliance(pin: SolidBar, bush: Bush) -> float:
    """Mean of the compliances 1/E' of both bodies, 1/Pa."""
    return 0.5 * (1.0 / pin.plane_strain_modulus + 1.0 / bush.plane_strain_modulus)


def _in_window(
    window: float, clearance_number: float, pin: SolidBar, bush: Bush, knots: int
) -> Conforming:
    """Contact at unit load and radius: pressure p R / Q, approach over load times mean compliance.

    Parameters
    ----------
    window : float             half the angle that the knots cover, rad
    clearance_number : float   radial clearance over load times mean compliance, >= 0
    knots : int                of the pressure on half the contact
    """
    count = int(_HARMONICS * knots / window) + 8
    mean_compliance = _mean_compliance(pin, bush)
    w = (pin_compliance(count, pin) + bush_compliance(count, bush)) / mean_compliance
    a = hat_coefficients(window, knots, count)
    compliance = (2.0 / np.pi) * (a[:, 1:] * w[1:]) @ a[:, 1:].T
    compliance += w[0] / np.pi * np.outer(a[:, 0], a[:, 0])
    gap = clearance_number * (a[:, 0] - a[:, 1])
    solution = solve(compliance, gap[None], a[:, 1], np.array([0.5]))
    angle: Array = window / knots * np.arange(knots, dtype=np.float64)
    pressure = solution.pressure[0]
    return Conforming(
        angle=angle,
        pressure=pressure,
        contact_angle=_edge(angle, pressure, window),
        peak_pressure=_peak(angle, pressure),
        approach=float(solution.approach[0]),
        equilibrium=float(solution.equilibrium[0]),
        complementarity=float(solution.complementarity[0]),
    )


def _edge(angle: Array, pressure: Array, window: float) -> float:
    """Half contact angle, rad: zero of the squared pressure, which is smooth at the edge.

    With fewer than twelve knots in contact the angle of the last one; where the fit has no zero
    near, one knot spacing more, at most the window.

    Parameters
    ----------
    angle, pressure : array (knots,)   angle from the line of action, rad; pressure, any unit
    window : float                     angle of the end of the knots, rad
    """
    touching = np.flatnonzero(pressure > 0.0)
    if len(touching) < 12:
        return float(angle[touching[-1]])
    last = int(touching[-1])
    part = slice(last - 10, last - 1)  # the last knots oscillate
    fit = np.polynomial.Polynomial.fit(angle[part], pressure[part] ** 2, 2)
    roots = fit.roots()
    real = roots[np.abs(roots.imag) < 1e-12].real
    near = real[(real > angle[last - 2]) & (real < angle[last] + 3.0 * angle[1])]
    return float(near.min()) if len(near) else min(float(angle[last] + angle[1]), window)


def _peak(angle: Array, pressure: Array) -> float:
    """Pressure on the line of action, by an even quartic through the inner half of the contact.

    Parameters
    ----------
    angle, pressure : array (knots,)   angle from the line of action, rad; pressure, any unit
    """
    last = int(np.flatnonzero(pressure > 0.0)[-1])
    inner = slice(0, max(last // 2, 4))
    square = angle[inner] ** 2
    return float(np.polynomial.Polynomial.fit(square, pressure[inner], 2)(0.0))


@lru_cache(maxsize=16)
def _peak_table(pin: SolidBar, bush: Bush) -> tuple[MonotoneCubic, MonotoneCubic, float]:
    """Logarithms of the peak p R/Q and of half the contact angle, rad, as functions of log(1 + c),
    and the largest c tabulated; c: clearance over load times mean compliance.

    The solutions are cached on disk.
    """
    table = disk_cache.kept("pin", (pin, bush), lambda: _solved_table(pin, bush), RECIPE)
    at = np.log1p(table["number"])
    peaks = MonotoneCubic(at, np.log(table["peak"]))
    angles = MonotoneCubic(at, np.log(table["angle"]))
    return peaks, angles, float(table["number"][-1])


def _solved_table(pin: SolidBar, bush: Bush) -> dict[str, Array]:
    """Clearance over load times mean compliance, peak p R/Q and half contact angle, rad, each (n,),
    by complementarity, under the names `number`, `peak`, `angle`.
    """
    largest = float(persson_clearance(_LEAST_ANGLE)) / 2.0
    numbers = np.r_[0.0, np.geomspace(1e-2, largest, 28)]
    mean_compliance = _mean_compliance(pin, bush)
    contacts = [pin_in_hole(1.0, 1.0, c * mean_compliance, pin, bush, knots=48) for c in numbers]
    return {
        "number": numbers,
        "peak": np.array([one.peak_pressure for one in contacts]),
        "angle": np.array([one.contact_angle for one in contacts]),
    }


def peak_pressure(
    load: ArrayLike, radius: float, clearance: float, pin: SolidBar, bush: Bush
) -> tuple[Array, Array]:
    """Peak pressure and half contact angle under many loads, interpolated in a table.

    Half contact angles below two degrees are those of two cylinders of nearly equal radius.

    Parameters
    ----------
    load : array (...)   Q, N/m, >= 0
    radius, clearance, pin, bush   as for `pin_in_hole`

    Returns
    -------
    peak, contact_angle : array (...)   Pa, rad

    Raises
    ------
    InputError
        If a load is negative or NaN, or the clearance negative.

    References
    ----------
    `pin_in_hole`; Johnson, Contact Mechanics (1985), sec. 4.2(c) for low loads.
    """
    Q = finite("pin_in_hole.load", load)
    if (Q < 0.0).any():
        raise InputError("pin_in_hole.load", float(Q.min()), ">= 0 N/m")
    if not 0.0 <= clearance < np.inf:
        raise InputError("pin_in_hole.clearance", clearance, ">= 0 m: a press fit cannot slide")
    mean_compliance = _mean_compliance(pin, bush)
    peaks, angles, largest = _peak_table(pin, bush)
    number = np.divide(clearance, mean_compliance * Q, out=np.full_like(Q, np.inf), where=Q > 0.0)
    inside = np.log1p(np.minimum(number, largest))
    light = number > largest
    # 1/E* is twice the mean compliance, 1/R_rel = clearance/R^2
    stretch = 8.0 * mean_compliance * radius**2 / (np.pi * max(clearance, np.finfo(float).tiny))
    half_width = np.sqrt(np.where(light, Q, 0.0) * stretch)
    hertz = np.divide(2.0 * Q, np.pi * half_width, out=np.zeros_like(Q), where=half_width > 0.0)
    peak = np.where(light, hertz, np.exp(peaks(inside)) * Q / radius)
    angle = np.where(light, half_width / radius, np.exp(angles(inside)))
    return peak, angle
