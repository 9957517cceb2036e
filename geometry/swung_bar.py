"""Bars on an oscillating follower, arm and spring: distances over its swing and the turn."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from typing import NamedTuple

import numpy as np

from camwright.geometry import extrema
from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Array, Value, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import Extremum, refined
from camwright.geometry.lift import Lift

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
        towards, aside = _from_pivot(self.arm, along, across)
        facing = np.arctan2(aside, towards)
        # the distance grows with the angle between arm and point
        angles = self.low, self.high, np.clip(facing, self.low, self.high)
        nearest: Value = np.min(
            np.broadcast_arrays(*(self._at(each, towards, aside) for each in angles)), axis=0
        )
        return nearest

    def from_contour(self, contour: Contour, lift: Lift | None = None) -> Extremum:
        """Least distance of a contour from the piece over the turn, m, and its cam angle.

        Zero where the contour crosses it. The lift of the arm is that of the contour, or stated.
        """
        return _from_contour(contour, lift or contour.lift, self.arm, self.low, self._at)

    def from_bar(self, other: SwungBar, between: Value) -> Value:
        """Distance of a piece of another arm on the same pivot, which swings with this one (...),
        m, where not both begin at the pivot; between : angle of both arms, rad.
        """
        ends = [
            one._at(between, each * np.ones_like(between), 0.0 * between)
            for one, bar in ((self, other), (other, self))
            for each in (bar.inner, bar.outer)
        ]
        return reduce(np.minimum, ends)

    def _at(self, angle: Value, towards: Value, aside: Value) -> Value:
        """Distance, m, of a point from the piece of the centre line at an arm angle, rad; towards,
        aside : coordinates of the point from the pivot, m, to the cam axis and square to it.
        """
        cos, sin = np.cos(angle), np.sin(angle)
        length, square = towards * cos + aside * sin, aside * cos - towards * sin
        beyond = length - np.clip(length, self.inner, self.outer)
        distance: Value = np.hypot(beyond, square)
        return distance


class SwungLink(NamedTuple):
    """Straight bar from a point of an arm, which swings, to a fixed point, as the axis of a spring.

    Both ends in polar coordinates about the pivot, `radius` in m: `angle`, rad, of the end on the
    arm from the arm, `fixed_angle` of the other from the line to the cam axis, both positive in the
    sense of the outward swing. `low`, `high`: least and greatest arm angle, rad. Values broadcast.
    """

    arm: Arm
    low: Value
    high: Value
    radius: Value
    angle: Value
    fixed_radius: Value
    fixed_angle: Value

    def from_point(self, along: Value, across: Value) -> Value:
        """Least distance of a point from the bar over the swing (...), m.

        Parameters
        ----------
        along, across : float or array   u and v of the frame of `Arm`, m
        """
        towards, aside = _from_pivot(self.arm, along, across)
        middle, half = 0.5 * (self.high + self.low), 0.5 * (self.high - self.low)
        # ends of the swing; else the point is before the end on the arm, or the bar passes through
        # it, or does not turn, square to the radius of that end
        swings = [self.low, self.high]
        for at in (np.arctan2(aside, towards), *self._through(towards, aside), *self._square()):
            from_middle = (at - self.angle - middle + np.pi) % (2.0 * np.pi) - np.pi
            swings.append(middle + np.clip(from_middle, -half, half))
        nearest: Value = reduce(np.minimum, (self._at(each, towards, aside) for each in swings))
        return nearest

    def from_contour(self, contour: Contour, lift: Lift | None = None) -> Extremum:
        """Least distance of a contour from the bar over the turn, m, and its cam angle; the lift of
        the arm is that of the contour, or stated.
        """
        return _from_contour(contour, lift or contour.lift, self.arm, self.low, self._at)

    @property
    def _fixed(self) -> tuple[Value, Value]:
        """Components of the fixed end from the pivot, m; see `_from_pivot`."""
        radius, angle = self.fixed_radius, self.fixed_angle
        return radius * np.cos(angle), radius * np.sin(angle)

    def _through(self, towards: Value, aside: Value) -> tuple[Value, Value]:
        """Directions from the pivot, rad, to the circle of the end on the arm along the line from
        the fixed end through a point from the pivot, m; where it misses the circle, square to it.
        """
        x, y = self._fixed
        along = np.arctan2(aside - y, towards - x)
        # of the chord: distance from the pivot, to the left of the line
        off = np.clip((np.cos(along) * y - np.sin(along) * x) / self.radius, -1.0, 1.0)
        turned = np.arccos(off)
        normal = along + 0.5 * np.pi
        return normal + turned, normal - turned

    def _square(self) -> tuple[Value, Value]:
        """Directions from the pivot, rad, in which the end on the arm moves along the bar."""
        opened = np.arccos(np.clip(self.radius / self.fixed_radius, -1.0, 1.0))
        return self.fixed_angle + opened, self.fixed_angle - opened

    def _at(self, angle: Value, towards: Value, aside: Value) -> Value:
        """Distance, m, of a point from the bar at an arm angle, rad; see `SwungBar`."""
        turn, (x, y) = angle + self.angle, self._fixed
        across, up = self.radius * np.cos(turn) - x, self.radius * np.sin(turn) - y
        square = across**2 + up**2
        share = np.clip(((towards - x) * across + (aside - y) * up) / square, 0.0, 1.0)
        distance: Value = np.hypot(towards - x - share * across, aside - y - share * up)
        return distance


def _from_pivot(arm: Arm, along: Value, across: Value) -> tuple[Value, Value]:
    """Components of a point from the pivot, to the cam axis and to the side of the arm, m."""
    return arm.centre_distance - along, arm.sense * across


def _from_contour(
    contour: Contour,
    lift: Lift,
    arm: Arm,
    low: Value,
    at: Callable[[Value, Value, Value], Value],
) -> Extremum:
    """Least distance of a contour from a bar over the turn, m, and its cam angle.

    Parameters
    ----------
    lift : Lift     of the arm
    low : float     arm angle at the lowest lift, rad
    at : function   arm angle, rad, and coordinates of a point from the pivot, m, to its distance, m
    """
    places = uniform_turn(_BAR_SAMPLES)
    lowest = lift.lowest.value
    polygon = contour.points(places)

    def apart(points: Array, theta: Array) -> Array:
        """Distances of contour points from the bar at cam angles, m."""
        cos, sin = np.cos(theta), np.sin(theta)
        along, across = points[0] * cos + points[1] * sin, points[1] * cos - points[0] * sin
        angle = low + (lift(theta) - lowest) / arm.length
        return np.asarray(at(angle, *_from_pivot(arm, along, across)))

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
