"""Demands of the checks as functions of motion and forces, each written once.

The checks judge them; the constrained synthesis differentiates them by complex steps and holds
them below the same limits, so that a check and its constraint cannot disagree. All arrays (...).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from camwright.geometry.pitch_curve import magnitude

Values = Any
"""Real, or complex while a derivative is taken by a complex step."""


def unloading(inertia: Values, spring: Values) -> Values:
    """Share of the spring force that inertia takes away: -m w^2 s'' / F_s."""
    return -inertia / spring


def force_left(spring: Values, inertia: Values, preload: Values) -> Values:
    """What spring and inertia leave to press the roller on the cam, over the preload."""
    return (spring + inertia) / preload


def jam_outward(lift_slope: Values, jam_index: Values) -> Values:
    """Jam index on the way out; coming back, friction holds the cam and cannot lock it."""
    return np.where(np.real(lift_slope) > 0, jam_index, 0.0 * jam_index)


def bush_pressure(reaction: Values, area: float) -> Values:
    """Mean pressure of a guide's reaction (N) on diameter times length (m^2), Pa."""
    return magnitude(reaction) / area


def bush_pv(rubbing_load: Values, velocity: Values, area: float) -> Values:
    """Pressure times sliding speed, Pa m/s, of the load that rubs (N) at a velocity (m/s)."""
    return magnitude(rubbing_load * velocity) / area


def contour_radius(along: Values, across: Values, offset: float, inset: Values) -> Values:
    """Distance of the contour from the cam axis, m; inset is r / |dP/dtheta|, see `Contour`."""
    return np.sqrt((across * (1.0 - inset)) ** 2 + (offset + inset * along) ** 2)
