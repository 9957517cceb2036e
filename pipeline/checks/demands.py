"""Demands of the checks as functions of motion and forces, each written once.

The checks judge them; the constrained synthesis differentiates them by complex steps and holds
them below the same limits, so that a check and its constraint cannot disagree. All arrays (...).
"""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.pitch_curve import magnitude


def unloading(inertia: Array, spring: Array) -> Array:
    """Share of the spring force that inertia takes away: -m w^2 s'' / F_s."""
    return -inertia / spring


def force_left(spring: Array, inertia: Array, preload: float) -> Array:
    """What spring and inertia leave to press the roller on the cam, over the preload."""
    return (spring + inertia) / preload


def jam_outward(lift_slope: Array, jam_index: Array) -> Array:
    """Jam index on the way out; coming back, friction holds the cam and cannot lock it."""
    return np.where(np.real(lift_slope) > 0, jam_index, 0.0 * jam_index)


def bush_pressure(reaction: Array, area: float) -> Array:
    """Mean pressure of a guide's reaction (N) on diameter times length (m^2), Pa."""
    return magnitude(reaction) / area


def bush_pv(rubbing_load: Array, velocity: Array, area: float) -> Array:
    """Pressure times sliding speed, Pa m/s, of the load that rubs (N) at a velocity (m/s)."""
    return magnitude(rubbing_load * velocity) / area


def contour_radius(along: Array, across: Array, offset: float, inset: Array) -> Array:
    """Distance of the contour from the cam axis, m; inset is r / |dP/dtheta|, see `Contour`."""
    return np.sqrt((across * (1.0 - inset)) ** 2 + (offset + inset * along) ** 2)
