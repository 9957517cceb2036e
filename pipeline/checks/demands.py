"""Measures of motion and force shared by checks and synthesis constraints.

The synthesis differentiates them by complex steps. All arrays (...), SI.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.case.limits import CONTACT_FORCE_MARGIN
from camwright.pipeline.checks.extremes import on_both_tracks
from camwright.pipeline.cycle.loaded_cam import LoadedCam, not_negative
from camwright.pipeline.cycle.numbers import Numbers

CONTACT_FLOOR = 0.01
"""Least normal force over the least spring force in the quotients by the normal force."""
NORMAL_FORCE, CAM_TORQUE, TOOTH_TORQUE = "roller_static", "key_pressure", "gear_bending"
PRESSURE = "contact_pressure"
"""Groups of checks of one measure, which are one constraint of the synthesis, by its check."""
_DEFAULT_FORCE_MARGIN = 0.2
"""Contact over least spring force below which quotients rise linearly, if no margin is stated."""


class FatiguePoint(NamedTuple):
    """Mean stress and amplitude of a part in its Goodman diagram, Pa.

    Amplitude and mean; endurance: amplitude without mean; strength: mean without amplitude.
    """

    name: str
    amplitude: float
    mean: float
    endurance: float
    strength: float


class PerLoad(NamedTuple):
    """Stress of a part per force, Pa/N, or torque, Pa/(N m), from the machine's numbers."""

    factor: Callable[[Numbers], Value]

    def value(self, worst: Value, numbers: Numbers) -> Value:
        """Stress, Pa, under the greatest load, N or N m."""
        return self.factor(numbers) * worst

    def bound(self, limit: float, numbers: Numbers) -> float:
        """Load, N or N m, at a stress, Pa."""
        return float(limit / self.factor(numbers))


def normal_force(cam: LoadedCam) -> Array:
    """Measure: normal force between cam and follower, N, of preloaded discs the greater of both."""
    return on_both_tracks(cam, lambda each: each.normal)


def force_over(cam: LoadedCam, limit: float) -> Array:
    """Normal force over its limit, N, with the weight of the checks that grow with it."""
    return cam.force_weight * normal_force(cam) / limit


def cam_torque(cam: LoadedCam) -> Array:
    """Magnitude of the cam torque, N m."""
    return magnitude(cam.torque)


def seat_torque(cam: LoadedCam) -> Array:
    """Magnitude of the torque that the seat of a disc bears, N m."""
    return magnitude(cam.seat_torque)


def tooth_torque(cam: LoadedCam) -> Array:
    """Magnitude of the torque of the driving gear, with the drag of the camshaft, N m."""
    drag = cam.numbers.get("camshaft.drag")
    return magnitude(cam.torque + (0.0 if drag is None else drag))


def follower_speed(cam: LoadedCam) -> Array:
    """Measure: speed of the follower along its axis, m/s."""
    return magnitude(cam.velocity)


def slope_at(speed: float, numbers: Numbers) -> float:
    """Lift slope, m/rad, at a follower speed, m/s, in the fastest load case."""
    return speed / float(numbers["cam.fastest"])


def slope_over(cam: LoadedCam, limit: float) -> Array:
    """Lift slope over its value at the greatest follower speed of the fastest load case."""
    return magnitude(cam.jet.slope) / limit


def rating_over(rating: Value, worst: Value, unloaded: float) -> Array:
    """Rating (...) over a load or damage `worst` (...), in its unit; `unloaded` where that is zero,
    NaN where it is unknown.
    """
    load: Array = np.asarray(worst, dtype=float)
    loaded = load > 0.0
    without = np.where(np.isnan(load), np.nan, unloaded)
    return np.where(loaded, rating / np.where(loaded, load, 1.0), without)[()]


def ripple_reduction(before: Array, after: Array) -> Array:
    """1 - std(torque after) / std(torque before) over (..., n); NaN without a ripple."""
    ripple, left = np.std(before, axis=-1), np.std(after, axis=-1)
    none = np.full(np.broadcast(ripple, left).shape, np.nan)
    return np.asarray(1.0 - np.divide(left, ripple, out=none, where=ripple > 0))


def common_reduction(
    reduction: float | Array, required: float | Array, common: float | Array
) -> Array:
    """Reduction with an equal share of the allowed ripple at another requirement, (...).

    1 - (1 - r) (1 - c)/(1 - c_i): it is at least c where r is at least c_i.
    """
    return np.asarray(1.0 - (1.0 - reduction) * ((1.0 - common) / (1.0 - required)))


def unloading(inertia: Array, closing: Array) -> Array:
    """Unloading inertia force -m w^2 s'' over closing force F_c."""
    return -inertia / closing


def greatest_unloading(inertia: Array, closing: Array) -> Array:
    """`unloading`, >= 0; infinite where no force closes the contact at rest."""
    closed = np.where(closing == 0.0, np.nan, closing)
    return np.where(np.real(closing) <= 0.0, np.inf, not_negative(unloading(inertia, closed)))


def force_left(closing: Array, inertia: Array, least_spring: float | Array) -> Array:
    """Closing plus inertia force over the least spring force, without friction."""
    return (closing + inertia) / least_spring


def over_contact_force(needed: Array, normal: Array, least_spring: Value) -> Array:
    """Force `needed` (...), N, over the normal force (...), N, the latter at least `CONTACT_FLOOR`
    of the least spring force.

    About to lose the contact, no quotient by its force says more than that; infinite without
    contact, NaN where the normal force is.
    """
    floor = CONTACT_FLOOR * least_spring
    held = np.where(np.real(normal) > np.real(np.asarray(floor)), normal, floor)
    loaded = np.real(held) > 0.0
    share = np.where(loaded, needed / np.where(loaded, held, 1.0), np.inf)
    return np.where(np.real(normal) <= 0.0, np.inf, np.where(np.isnan(normal), np.nan, share))


def over_normal_force(cam: LoadedCam, needed: Array) -> Array:
    """Required normal force `needed` (n,), N, over the available one; below the margin of the
    contact force 1 plus the shortfall over it.

    For the synthesis: the quotient has a pole where the search passes through a loss of contact.
    """
    stated = cam.numbers.get(f"limits.{CONTACT_FORCE_MARGIN.id}")
    margin = _DEFAULT_FORCE_MARGIN if stated is None else stated
    normal, least = cam.normal, margin * cam.least_spring
    scale = np.where(np.real(normal) > np.real(least), normal, least)
    return 1.0 + (needed - normal) / scale
