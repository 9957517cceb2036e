"""The motion a finished contour gives its follower, found by touching alone.

Nothing of how the contour was drawn is used: not the lift, nor its derivatives, nor the angle a
point belongs to. The follower is let down on a closed curve until it rests on it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.extrema import refined

_ZOOMS = 13
_LEAST_POINTS = 24

Standing = Callable[[Array, Array, Array], Array]
"""Coordinates x, y of contour points (m) and angles (rad) -> height the follower stands at (m)."""


def roller_height(
    polygon: ArrayLike, roller_radius: float, offset: float, theta: ArrayLike
) -> Array:
    """Height d of the centre of a roller that rests on a contour, (m,), m.

    The highest place at which the circle still touches: over every point of the curve the roller
    would stand at p.u + sqrt(r^2 - (p.v - e)^2), and the greatest of these counts.

    Parameters
    ----------
    polygon : array (2, n)     points of the closed contour, counter-clockwise, m
    roller_radius : float      m
    offset : float             e, m
    theta : array (m,)         angles of the follower's axis in the cam frame, rad

    Raises
    ------
    GeometryError
        If the follower's axis misses the contour.
    """

    def standing(x: Array, y: Array, angle: Array) -> Array:
        along = x * np.cos(angle) + y * np.sin(angle)
        across = y * np.cos(angle) - x * np.sin(angle) - offset
        square = roller_radius**2 - across**2
        return np.where(square >= 0, along + np.sqrt(np.maximum(square, 0.0)), -np.inf)

    return _highest(polygon, standing, theta)


def face_height(polygon: ArrayLike, theta: ArrayLike) -> Array:
    """Height of a flat face that rests on a contour, (m,), m: the support of the curve.

    Parameters
    ----------
    polygon : array (2, n)     points of the closed contour, counter-clockwise, m
    theta : array (m,)         angles of the follower's axis in the cam frame, rad
    """

    def standing(x: Array, y: Array, angle: Array) -> Array:
        return x * np.cos(angle) + y * np.sin(angle)

    return _highest(polygon, standing, theta)


def _highest(polygon: ArrayLike, standing: Standing, theta: ArrayLike) -> Array:
    from scipy.interpolate import CubicSpline

    points, angle = finite("polygon", polygon), finite("theta", theta)
    if points.ndim != 2 or points.shape[0] != 2 or points.shape[1] < _LEAST_POINTS:
        raise InputError("polygon", f"shape {points.shape}", f"(2, n) with n >= {_LEAST_POINTS}")
    closed = np.concatenate([points, points[:, :1]], axis=1)
    # chord length as parameter: the points' own angles are not known here
    chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=1)))])
    parameter = chord * (FULL_TURN / chord[-1])
    curve = CubicSpline(parameter, closed, axis=1, bc_type="periodic")
    first = standing(points[0][:, None], points[1][:, None], angle[None, :])
    best = np.argmax(first, axis=0)
    top = first[best, np.arange(angle.size)]
    if not np.isfinite(top).all():
        raise GeometryError("the follower's axis misses the contour")

    def depth(trial: Array) -> Array:
        x, y = curve(np.mod(trial, FULL_TURN))
        return -standing(x, y, angle[:, None])

    lowest, _ = refined(depth, parameter[best], np.diff(parameter).max(), _ZOOMS)
    return np.maximum(top, -lowest)
