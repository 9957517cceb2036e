"""Body of a counterweight about the camshaft: its width, how much it balances, its distances.

A sector of a ring on the shaft, as wide as stated or as a half ring needs to be. Lengths in m,
floats or arrays (...).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, Value

_HALF_RING = 2.0 / 3.0  # of R^3 - a^3: first moment of its area


def moment_per_width(radius: Value, inner: Value, density: Value) -> Array:
    """Unbalance of a half ring per width (...), kg; none where it has no room about the shaft."""
    room = np.asarray(radius**3 - inner**3, dtype=float)
    return np.asarray(_HALF_RING * density * np.where(room > 0.0, room, np.nan))


def width_beside(width: Value, apart: Value, cam_width: Value) -> Array:
    """Part (...), m, of the width of a counterweight that lies beside the cam, not in the plane of
    it.

    Parameters
    ----------
    width : (...)       of the counterweight, m
    apart : (...)       distance of the middles of counterweight and cam, m, >= 0
    cam_width : (...)   m
    """
    half, near, far = 0.5 * width, apart - 0.5 * cam_width, apart + 0.5 * cam_width
    away = np.where(np.asarray(near) < 0.0, np.maximum(half + near, 0.0), half)
    towards = np.minimum(half, np.maximum(near, 0.0)) + np.maximum(half - far, 0.0)
    return np.asarray(away + towards)


def width_for(beside: Value, apart: Value, cam_width: Value) -> Array:
    """Width (...), m, of a counterweight of which a given part lies beside the cam: inverse of
    `width_beside`.

    Parameters
    ----------
    beside : (...)      this part, m
    apart : (...)       distance of the middles of counterweight and cam, m, >= 0
    cam_width : (...)   m
    """
    near, far = apart - 0.5 * cam_width, apart + 0.5 * cam_width
    to_the_cam = np.asarray(beside - near)  # its half, with one face within the cam
    around = 0.5 * (beside + cam_width)
    within = np.where(to_the_cam <= far, to_the_cam, around)
    return 2.0 * np.where(np.asarray(beside <= 2.0 * near), 0.5 * beside, within)


@dataclass(frozen=True, eq=False)
class CounterweightBody:
    """Counterweight about the shaft: middle from that of the cam, outer radius, width.

    beside: part of the width beside the cam; capacity: unbalance of a half ring of these sizes,
    kg m.
    """

    position: Value
    radius: Value
    width: Value
    beside: Value
    capacity: Value

    @classmethod
    def of(
        cls, position: Value, cam_width: Value, sizes: tuple[Value, Value | None], inner: Value,
        density: Value, product: Value,
    ) -> CounterweightBody:  # fmt: skip
        """Counterweight of an outer radius and a width; without a width that of a half ring with a
        given unbalance.

        Parameters
        ----------
        position : float    middle of the counterweight from that of the cam along the shaft, m
        cam_width : float   m
        sizes : tuple       outer radius, m, and width, m, or None
        inner : float       radius of the shaft below it, m
        density : float     kg/m3
        product : float     unbalance for a width that is not given, kg m
        """
        radius, stated = sizes
        per_width, apart = moment_per_width(radius, inner, density), np.abs(position)
        width = width_for(product / per_width, apart, cam_width) if stated is None else stated
        beside = width_beside(width, apart, cam_width)
        return cls(position, radius, width, beside, per_width * beside)

    def half_angle(self, product: float) -> float:
        """Half of the angle of the sector that has an unbalance, kg m; at most a right angle."""
        share = product / float(self.capacity) if self.capacity > 0.0 else 1.0
        return float(np.arcsin(min(max(share, 0.0), 1.0)))

    def beyond(self, low: Value, high: Value) -> Value:
        """Axial gap (...) from a part between two places from the middle of the cam.

        Negative where they overlap.
        """
        half = 0.5 * self.width
        gap: Value = np.maximum(low - (self.position + half), (self.position - half) - high)
        return gap

    def under(self, half_depth: Value, lowest: Value) -> Array:
        """Least distance (...), m, of the counterweight from a follower that moves in the plane of
        the cam.

        Parameters
        ----------
        half_depth : (...)   half of the length of the follower along the shaft, m
        lowest : (...)       least distance of the follower from the axis of the shaft, m
        """
        aside, above = self.beyond(-half_depth, half_depth), lowest - self.radius
        apart = np.hypot(np.maximum(aside, 0.0), np.maximum(above, 0.0))
        both = (np.asarray(aside) > 0.0) & (np.asarray(above) > 0.0)
        return np.where(both, apart, np.maximum(aside, above))
