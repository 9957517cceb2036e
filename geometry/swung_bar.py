"""Straight bar along the arm of an oscillating follower: distances over its swing and the turn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry import extrema
from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Array, Value, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import Extremum, refined

_BAR_SAMPLES, _BAR_ZOOMS = 360, 4
"""Cam angles, and points of the contour at each; the zooms leave 3e-7 rad, of a smooth minimum."""


class SwungBar(NamedTuple):
    """Piece of the centre line of an arm, from a distance `inner` to `outer` of the pivot, m.

    `low`, `high`: least and greatest arm angle, rad. Values broadcast.
    """

    arm: Arm
    low: Value
    high: Value
    inner: Value
    outer: Value

    def from_point(self, along: Value, across: Value) -> Value:
        """Least distance of a point from the piece over the swing (...), m.

        Parameters
        ----------
        along, across : float or array   u and v of the frame of `Arm`, m
        """
        towards, aside = self._from_pivot(along, across)
        facing = np.arctan2(aside, towards)
        # the distance grows with the angle between arm and point
        angles = self.low, self.high, np.clip(facing, self.low, self.high)
        nearest: Value = np.min(
            np.broadcast_arrays(*(self._at(each, towards, aside) for each in angles)), axis=0
        )
        return nearest

    def from_contour(self, contour: Contour) -> Extremum:
        """Least distance of a contour from the piece over the turn, m, and its cam angle.

        Zero where the contour crosses it.
        """
        lift, places = contour.lift, uniform_turn(_BAR_SAMPLES)
        lowest = lift.lowest.value
        polygon = contour.points(places)

        def apart(points: Array, theta: Array) -> Array:
            """Distances of contour points from the bar at cam angles, m."""
            cos, sin = np.cos(theta), np.sin(theta)
            along, across = points[0] * cos + points[1] * sin, points[1] * cos - points[0] * sin
            angle = self.low + (lift(theta) - lowest) / self.arm.length
            return np.asarray(self._at(angle, *self._from_pivot(along, across)))

        def least(theta: Array) -> Array:
            """Least distance of the contour from the bar at each cam angle, m."""
            turn = theta.ravel()[:, None]
            nearest = places[np.argmin(apart(polygon[:, None, :], turn), axis=1)]
            step = 2.0 * np.pi / _BAR_SAMPLES
            values, _ = refined(
                lambda trial: apart(contour.points(trial), turn), nearest, step, _BAR_ZOOMS
            )
            return values.reshape(theta.shape)

        return extrema.least(least, _BAR_SAMPLES)

    def _from_pivot(self, along: Value, across: Value) -> tuple[Value, Value]:
        """Components of a point from the pivot, to the cam axis and to the side of the arm, m."""
        return self.arm.centre_distance - along, self.arm.sense * across

    def _at(self, angle: Value, towards: Value, aside: Value) -> Value:
        """Distance, m, of a point from the piece of the centre line at an arm angle, rad; towards,
        aside : coordinates of the point from the pivot, m, to the cam axis and square to it.
        """
        cos, sin = np.cos(angle), np.sin(angle)
        length, square = towards * cos + aside * sin, aside * cos - towards * sin
        beyond = length - np.clip(length, self.inner, self.outer)
        distance: Value = np.hypot(beyond, square)
        return distance
