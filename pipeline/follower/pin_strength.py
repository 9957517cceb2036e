"""Roller pin: bending and shear stress, pressure in its seats."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError


def pin_moment(
    force: Value, moment: Value, width: Value, span: float, overhung: bool = False
) -> Array:
    """Greatest bending moment (...) of the roller pin, N m.

    The load along the bearing is linear, with the force as its sum and the moment about the middle
    of the bearing: q(y) = N/b + 12 M y/b^3. Between two supports the shear force vanishes at
    y = b u, u = k e/(1 + sqrt(1 + 12 k e^2)), e = M/(N b), k = 3 - 2 b/l, and the moment is
    N (l/4 - b/8 - b u^2/2) + M u (k/2 - 2 u^2).

    Parameters
    ----------
    force : array (...)    N, >= 0
    moment : array (...)   M, about the middle of the bearing, N m, >= 0
    width : float          b of the bearing, m, > 0
    span : float           l between the middles of the supports (straddled) or from the face of the
                           support to the middle of the bearing (overhung), m, > 0
    overhung : bool

    Raises
    ------
    InputError
        If width or span is out of these bounds, or a straddled span is below the bearing width.
    """
    widths = np.asarray(width)
    for name, value in (("width", float(np.min(widths))), ("span", span)):
        if not 0.0 < value < np.inf:
            raise InputError(f"roller.pin_{name}", value, "> 0 m")
    if overhung:
        return np.asarray(force * span + moment)
    if not np.all(widths <= span):
        limit = f">= {np.max(widths):g} m, the width of the bearing"
        raise InputError("roller.pin_span", span, limit)
    slope = 3.0 - 2.0 * width / span
    loaded = np.real(np.asarray(force)) > 0.0
    share = np.where(loaded, moment, 0.0) / (np.where(loaded, force, 1.0) * width)
    at = slope * share / (1.0 + np.sqrt(1.0 + 12.0 * slope * share**2))
    of_force = force * (span / 4.0 - width / 8.0 - 0.5 * width * at**2)
    return np.asarray(of_force + moment * at * (0.5 * slope - 2.0 * at**2))


def bending_per_moment(diameter: float) -> float:
    """Bending stress of a round pin per bending moment, 32/(pi d^3), 1/m^3."""
    return 32.0 / (np.pi * diameter**3)


def pin_shear_stress(force: Array, diameter: float) -> Array:
    """Greatest shear stress of a round pin, Pa: 4/3 of the mean over its section.

    Parameters
    ----------
    force : array (...)   across the section beside the bearing, N; see `support_force`
    diameter : float      m

    References
    ----------
    Shigley's Mechanical Engineering Design, sec. 3-11: transverse shear of a round bar.
    """
    return np.asarray(4.0 * force / (3.0 * 0.25 * np.pi * diameter**2))


def support_force(force: Value, moment: Value, span: float, overhung: bool = False) -> Array:
    """Force (...) of the more loaded support of the pin, N: N/2 + M/l, of an overhung pin N.

    Parameters
    ----------
    force, moment : array (...)   as of `pin_moment`
    """
    return np.asarray(force + 0.0 * moment if overhung else 0.5 * force + moment / span)


def seat_pressure(force: Value, moment: Value, diameter: float, width: Value) -> Array:
    """Greatest projected-area pressure (...) of the pin in the bearing's bore, Pa.

    Linear along the seat, on both sides of the bore where the force acts beyond its middle third:
    N/(d b) + 6 M/(d b^2).

    Parameters
    ----------
    force, moment : array (...)   as of `pin_moment`
    diameter, width : float       d of the pin, b of the bearing, m, > 0
    """
    return np.asarray((force + 6.0 * moment / width) / (diameter * width))


def cheek_pressure(
    force: Value,
    moment: Value,
    diameter: float,
    cheek_width: float,
    span: float,
    overhung: bool = False,
) -> Array:
    """Greatest projected-area pressure (...) of the pin of a roller in a cheek of its fork, Pa.

    Straddled: the force of the support, uniform. Overhung: force N and moment M in one cheek, (N (6
    l + 4 t) + 6 M)/(d t^2), linear along the seat.

    Parameters
    ----------
    force, moment : array (...)     N, M, as of `pin_moment`
    diameter, cheek_width : float   d, t, m, > 0
    span : float                    l, as of `pin_moment`
    overhung : bool                 whether one cheek alone holds the pin

    References
    ----------
    Roloff/Matek, Maschinenelemente, ch. 9: pins in a seat under a transverse force; recalled:
    verify.
    """
    if not overhung:
        return support_force(force, moment, span) / (diameter * cheek_width)
    edge = force * (6.0 * span + 4.0 * cheek_width) + 6.0 * moment
    return np.asarray(edge / (diameter * cheek_width**2))
