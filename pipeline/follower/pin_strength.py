"""Roller pin: bending and shear stress, pressure in its seats."""

from __future__ import annotations

import numpy as np

from camwright.geometry.errors import InputError


def pin_bending_stress(
    force: float, diameter: float, width: float, span: float, overhung: bool = False
) -> float:
    """Maximum bending stress of the roller pin, Pa, the load uniform over the bearing width.

    Parameters
    ----------
    force : float      N, >= 0
    diameter : float   of the pin, m, > 0
    width : float      of the bearing, m, > 0
    span : float       between the middles of the supports (straddled) or from the face of the
                       support to the middle of the bearing (overhung), m, > 0
    overhung : bool

    Raises
    ------
    InputError
        If a value is out of these bounds, or a straddled span is below the bearing width.
    """
    for name, value in (("diameter", diameter), ("width", width), ("span", span)):
        if not 0.0 < value < np.inf:
            raise InputError(f"roller.pin_{name}", value, "> 0 m")
    if not 0.0 <= force < np.inf:
        raise InputError("roller.force", force, ">= 0 N")
    if not overhung and span < width:
        raise InputError("roller.pin_span", span, f">= {width:g} m, the width of the bearing")
    moment = force * span if overhung else force * (span / 4.0 - width / 8.0)
    return 32.0 * moment / (np.pi * diameter**3)


def pin_shear_stress(force: float, diameter: float, overhung: bool = False) -> float:
    """Maximum shear stress of a round pin, Pa: 4/3 of the mean over its section.

    A straddled pin (diameter in m) has half of the force (N) in each of two sections.

    References
    ----------
    Shigley's Mechanical Engineering Design, sec. 3-11: transverse shear of a round bar.
    """
    shear = force if overhung else 0.5 * force
    return 4.0 * shear / (3.0 * 0.25 * np.pi * diameter**2)


def cheek_pressure(
    force: float, diameter: float, cheek_width: float, span: float, overhung: bool = False
) -> float:
    """Maximum projected-area pressure of the pin in a cheek of its fork, Pa.

    Straddled: half of the force in each cheek, uniform. Overhung: force and moment in one cheek,
    F (6 l + 4 t)/(d t^2), linear along the seat.

    Parameters
    ----------
    force : float                           N
    diameter, cheek_width : float           d, t, m, > 0
    span : float                            l of an overhung pin, cheek to bearing centre, m

    References
    ----------
    Roloff/Matek, Maschinenelemente, ch. 9: pins in a seat under a transverse force; recalled:
    verify.
    """
    if not overhung:
        return force / (2.0 * diameter * cheek_width)
    return force * (6.0 * span + 4.0 * cheek_width) / (diameter * cheek_width**2)
