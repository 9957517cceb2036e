"""Height of a follower that rests on a contour of measured or computed points.

The points alone determine it: neither the lift nor its derivatives nor the cam angle of a point
enters. An interpolated closed curve is searched for the point that supports the follower.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.extrema import refined

_ZOOMS = 7
_LEAST_POINTS = 24

Support = Callable[[Array, Array, Array], Array]
"""Contour points x, y (m) and angles (rad) -> height (m) or arm angle (rad) at which the point
touches the follower."""


def roller_height(
    polygon: ArrayLike, roller_radius: float, offset: float, theta: ArrayLike
) -> Array:
    """Height d of the centre of a roller resting on a contour, (m,), m.

    The maximum of p.u + sqrt(r^2 - (p.v - e)^2) over the points p of the contour.

    Parameters
    ----------
    polygon : array (2, n)     points of the closed contour, counter-clockwise, m
    roller_radius : float      m
    offset : float             e, m
    theta : array (m,)         angles of the follower's axis in the cam frame, rad

    Raises
    ------
    GeometryError
        If the roller's path does not cross the contour.
    """

    def support(x: Array, y: Array, angle: Array) -> Array:
        """Height of the roller centre, m, with the roller on a point (x, y), m, of the cam turned
        by `angle`, rad; -infinity where the point is out of its reach.
        """
        along = x * np.cos(angle) + y * np.sin(angle)
        across = y * np.cos(angle) - x * np.sin(angle) - offset
        square = roller_radius**2 - across**2
        return np.where(square >= 0, along + np.sqrt(np.maximum(square, 0.0)), -np.inf)

    return _highest(polygon, support, theta)


def pulled_height(
    polygon: ArrayLike, roller_radius: float, offset: float, theta: ArrayLike
) -> Array:
    """Height d of the centre of a roller pulled from within against a closed wall, (m,), m.

    The least of p.u - sqrt(r^2 - (p.v - e)^2) over the points p of the wall beyond the cam axis;
    parameters and errors as for `roller_height`.
    """

    def support(x: Array, y: Array, angle: Array) -> Array:
        """Negative height of the roller centre, m, with a point (x, y), m, of the wall on it;
        -infinity where the point is out of its reach.
        """
        along = x * np.cos(angle) + y * np.sin(angle)
        across = y * np.cos(angle) - x * np.sin(angle) - offset
        square = roller_radius**2 - across**2
        reached = (square >= 0) & (along > 0)
        return np.where(reached, np.sqrt(np.maximum(square, 0.0)) - along, -np.inf)

    return -_highest(polygon, support, theta)


def face_height(polygon: ArrayLike, theta: ArrayLike) -> Array:
    """Height of a flat face resting on a contour, (m,), m: its support function.

    Parameters
    ----------
    polygon : array (2, n)     points of the closed contour, counter-clockwise, m
    theta : array (m,)         angles of the follower's axis in the cam frame, rad
    """

    def support(x: Array, y: Array, angle: Array) -> Array:
        return x * np.cos(angle) + y * np.sin(angle)

    return _highest(polygon, support, theta)


def arm_angle(
    polygon: ArrayLike,
    pivot: tuple[float, float],
    beyond: Callable[[Array], Array],
    theta: ArrayLike,
    *,
    pulled: bool = False,
) -> Array:
    """Angle of an arm on a fixed pivot that rests on a contour, (m,), rad.

    From the line to the cam axis, the maximum over the points of the contour of their own angle at
    the pivot and that from there to the arm; of a roller that is pulled against a wall around it
    the minimum of the difference, over the points on its side of that line.

    Parameters
    ----------
    polygon : array (2, n)   points of the closed contour, counter-clockwise, m
    pivot : tuple            centre distance, m, and sense of the outward swing: 1 with the rotation
                             of the cam, -1 against it
    beyond : function        distances of points from the pivot, m -> angle from the point to the
                             arm that touches it, rad; -inf where it cannot
    theta : array (m,)       angles from the cam axis to the pivot in the cam frame, rad
    pulled : bool            against a wall around the roller

    Raises
    ------
    GeometryError
        If the arm does not reach the contour.
    """
    centre_distance, sense = pivot

    def support(x: Array, y: Array, angle: Array) -> Array:
        """Arm angle, rad, with the follower on a point (x, y), m, of the cam turned by `angle`,
        rad; negative of a roller that is pulled.
        """
        along = centre_distance - x * np.cos(angle) - y * np.sin(angle)
        across = sense * (y * np.cos(angle) - x * np.sin(angle))
        of_point, to_arm = np.arctan2(across, along), beyond(np.hypot(along, across))
        if pulled:
            return np.where(across > 0.0, to_arm - of_point, -np.inf)
        angles: Array = of_point + to_arm
        return angles

    highest = _highest(polygon, support, theta)
    return -highest if pulled else highest


def _highest(polygon: ArrayLike, support: Support, theta: ArrayLike) -> Array:
    """Greatest of the heights, m, or arm angles, rad, (m,) at which points of a contour touch the
    follower at each angle `theta` (m,), rad; between the points (2, n), m, of `polygon` by a
    periodic cubic spline over the chord length.

    GeometryError where no point reaches the follower.
    """
    from scipy.interpolate import CubicSpline

    points, angle = finite("polygon", polygon), finite("theta", theta)
    if points.ndim != 2 or points.shape[0] != 2 or points.shape[1] < _LEAST_POINTS:
        raise InputError("polygon", f"shape {points.shape}", f"(2, n) with n >= {_LEAST_POINTS}")
    closed = np.concatenate([points, points[:, :1]], axis=1)
    # chord length as parameter: the cam angles of the points are unknown
    chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=1)))])
    parameter = chord * (FULL_TURN / chord[-1])
    curve = CubicSpline(parameter, closed, axis=1, bc_type="periodic")
    first = support(points[0][:, None], points[1][:, None], angle[None, :])
    best = np.argmax(first, axis=0)
    top = first[best, np.arange(angle.size)]
    if not np.isfinite(top).all():
        raise GeometryError("contour = out of the follower's reach, must cross its line of travel")

    def depth(trial: Array) -> Array:
        x, y = curve(np.mod(trial, FULL_TURN))
        return -support(x, y, angle[:, None])

    lowest, _ = refined(depth, parameter[best], np.diff(parameter).max(), _ZOOMS)
    height: Array = np.maximum(top, -lowest)
    return height
