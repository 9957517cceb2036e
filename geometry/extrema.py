"""Extreme values of periodic functions, found between samples too."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn

Function = Callable[[Array], Array]

_ZOOM_POINTS = np.linspace(-1.0, 1.0, 9)
_ZOOMS = 14
"""Each zoom keeps a quarter of the bracket; 14 leave 4e-9 of it, so its square is round-off."""

_VALLEYS_MAX = 256


class Extremum(NamedTuple):
    """A least or greatest value and the angle (rad) where it is reached."""

    value: float
    theta: float


def valleys(function: Function, count: int) -> tuple[Array, Array]:
    """Local minima of a smooth periodic function over the continuous turn.

    Every sample that is no higher than its neighbours brackets a local minimum, and all
    brackets are refined at once.

    Parameters
    ----------
    function : callable    array of angles (rad) of any shape -> array of the same shape
    count : int            samples of the turn; no two minima may share a sample interval

    Returns
    -------
    values, theta : array (m,)    m >= 1; of more than 256 minima the 256 of lowest sample;
        of a function that is NaN somewhere one NaN, since nobody knows how low it gets
    """
    theta = uniform_turn(count)
    values = function(theta)
    if (unknown := np.isnan(values)).any():
        return values[unknown][:1], theta[unknown][:1]
    low = np.flatnonzero((values <= np.roll(values, 1)) & (values <= np.roll(values, -1)))
    # a flat function brackets everywhere; its lowest samples say all there is to say
    low = low[np.argsort(values[low], kind="stable")[:_VALLEYS_MAX]]
    best, where = refined(function, theta[low], FULL_TURN / count, _ZOOMS)
    return best, np.mod(where, FULL_TURN)


def refined(function: Function, centre: Array, half: float, zooms: int) -> tuple[Array, Array]:
    """Minima (m,) within `half` of centres (m,), each by nine points a zoom, and their places.

    Parameters
    ----------
    function : callable    (m, 9) -> (m, 9), a row per centre
    """
    best = np.full(centre.shape, np.nan)
    for _ in range(zooms):
        trial = centre[:, None] + half * _ZOOM_POINTS
        values = function(trial)
        pick = np.argmin(values, axis=1)[:, None]
        centre = np.take_along_axis(trial, pick, axis=1)[:, 0]
        best = np.take_along_axis(values, pick, axis=1)[:, 0]
        half /= 4.0
    return best, centre


def least(function: Function, count: int) -> Extremum:
    """Least value of a smooth periodic function over the continuous turn; see `valleys`."""
    values, theta = valleys(function, count)
    lowest = int(np.argmin(values))
    return Extremum(float(values[lowest]), float(theta[lowest]))


def greatest(function: Function, count: int) -> Extremum:
    """Greatest value of a smooth periodic function over the continuous turn; see `valleys`."""
    value, theta = least(lambda angle: -function(angle), count)
    return Extremum(-value, theta)
