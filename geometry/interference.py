"""Self-intersections of the contour, and second contacts of the follower."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, distinct, uniform_turn
from camwright.geometry.extrema import Function, local_minima

Curve = Callable[[Array], Array]
"""Angles (...) -> coordinates (2, ...)."""

_LOOP_CHORDS = 64
_LOOP_REACH = 3.0
"""Multiple of the cusps' distance within which a small swallow-tail closes: sqrt(3)."""

_POLISH_STEPS = 30
_POLISHED = 1e-12
"""rad: step at which Newton's method has converged; in the smallest loops round-off is larger."""
_ANGLE_RESOLVED = 0.01
"""Maximum last step, over the angle between the two passes, of an accepted crossing."""

_POSITIONS_MAX = 720
_CANDIDATES_MAX = 32
_ZOOM_POINTS = np.linspace(-1.0, 1.0, 9)
_GAP_ZOOMS = 20  # of the search of the least gap

Gap = Callable[[Array, Array], Array]
"""Cam angles of the contact and of another contour point, broadcast -> gap at that point, m."""


class SecondContact(NamedTuple):
    """Minimum gap between follower and contour away from their contact.

    clearance : gap, m; negative where the follower cuts in, infinite (angles NaN) where no other
                part of the contour faces it
    theta     : cam angle of the contact, rad
    other     : cam angle of the contour point nearest to the follower, rad
    """

    clearance: float
    theta: float
    other: float


def crossings(
    points: Curve, velocity: Curve, factor: Function, count: int
) -> tuple[tuple[float, float], ...]:
    """Pairs of cam angles at which an offset curve passes through the same point.

    Parameters
    ----------
    points, velocity : callable    angles (n,) -> (2, n), m and m/rad
    factor : callable              angles -> undercut factor; negative between two cusps, where
                                   the offset curve runs backwards
    count : int                    chords per turn

    Returns
    -------
    tuple of (theta1, theta2)    rad, theta1 < theta2, ascending
    """
    theta = _knots(factor, count)
    start = points(theta)
    chord = np.roll(start, -1, axis=1) - start
    one, two = _overlapping(start, chord)
    angle = np.diff(theta, append=theta[0] + FULL_TURN)
    across = _cross(chord[:, one], chord[:, two])
    between = start[:, two] - start[:, one]
    with np.errstate(divide="ignore", invalid="ignore"):
        part_one = _cross(between, chord[:, two]) / across
        part_two = _cross(between, chord[:, one]) / across
    hit = (part_one >= 0) & (part_one <= 1) & (part_two >= 0) & (part_two <= 1)
    first = (theta[one] + part_one * angle[one])[hit]
    second = (theta[two] + part_two * angle[two])[hit]
    return _distinct(*_polished(points, velocity, first, second))


def second_contact(gap: Gap, count: int) -> SecondContact:
    """Minimum gap between follower and contour away from their contact.

    Every local minimum of the gap along the contour counts except the contact itself; the
    smallest are refined in both angles.

    Parameters
    ----------
    gap : callable    angles of contact and other point, broadcast -> gap, m
    count : int       follower positions, at most 720 of them used, against twice as many contour
                      points
    """
    count = min(count, _POSITIONS_MAX)
    position, along = uniform_turn(count), uniform_turn(2 * count)
    distance = gap(position[:, None], along[None, :])
    minimum = distance <= np.roll(distance, 1, axis=1)
    minimum &= distance < np.roll(distance, -1, axis=1)
    minimum[np.arange(count), 2 * np.arange(count)] = False
    row, column = np.nonzero(minimum)
    if len(row) == 0:
        return SecondContact(np.inf, np.nan, np.nan)
    near = np.argsort(distance[row, column], kind="stable")[:_CANDIDATES_MAX]
    contact, other, half = position[row[near]], along[column[near]], 0.5 * FULL_TURN / count
    for _ in range(_GAP_ZOOMS):
        step = half * _ZOOM_POINTS
        contacts = contact[:, None] + np.repeat(step, len(step))
        others = other[:, None] + np.tile(step, len(step))
        pick = np.argmin(gap(contacts, others), axis=1)[:, None]
        contact = np.take_along_axis(contacts, pick, axis=1)[:, 0]
        other = np.take_along_axis(others, pick, axis=1)[:, 0]
        half *= 0.5
    final = gap(contact, other)
    best = int(np.argmin(final))
    angles = np.mod([contact[best], other[best]], FULL_TURN)
    return SecondContact(float(final[best]), float(angles[0]), float(angles[1]))


def _knots(factor: Function, count: int) -> Array:
    """Angles (m,), rad, ascending: `count` equal ones, with finer ones about each undercut, where a
    short loop would fall between them.
    """
    step = FULL_TURN / count
    values, bottoms = local_minima(factor, count)
    bottoms, values = bottoms[values < 0], values[values < 0]
    probe = 0.1 * step
    second = (factor(bottoms + probe) + factor(bottoms - probe) - 2 * values) / probe**2
    with np.errstate(divide="ignore", invalid="ignore"):
        cusp = np.sqrt(-2 * values / second)
    # the equal angles resolve an undercut of many steps
    short = cusp < _LOOP_CHORDS / 4 * step
    window = _LOOP_REACH * cusp[short, None] * np.linspace(-1, 1, _LOOP_CHORDS)
    finer = np.mod(bottoms[short, None] + window, FULL_TURN)
    return distinct(np.concatenate([uniform_turn(count), finer.ravel()]))


def _overlapping(start: Array, chord: Array) -> tuple[Array, Array]:
    """Numbers (k,) and (k,), the lesser first, of pairs of non-adjacent chords whose bounding boxes
    overlap, by a sweep along x; start, chord : (2, n), start points and vectors of the chords of a
    closed polygon, m.
    """
    low, high = np.minimum(start, start + chord), np.maximum(start, start + chord)
    order = np.argsort(low[0], kind="stable")
    count = len(order)
    partners = np.searchsorted(low[0][order], high[0][order], side="right") - np.arange(count) - 1
    left = np.repeat(np.arange(count), partners)
    right = left + 1 + np.arange(len(left)) - np.repeat(np.cumsum(partners) - partners, partners)
    one = np.minimum(order[left], order[right])
    two = np.maximum(order[left], order[right])
    keep = (low[1][one] <= high[1][two]) & (low[1][two] <= high[1][one])
    keep &= (two - one > 1) & (two - one < count - 1)
    return one[keep], two[keep]


def _polished(points: Curve, velocity: Curve, first: Array, second: Array) -> tuple[Array, Array]:
    """Pairs of cam angles (m,), rad, at which the curve passes through the same point, by Newton's
    method from `first` and `second` (n,). Pairs that converge to one angle, or not at all, are
    discarded.
    """
    apart = np.abs(second - first)
    one, two, change = first, second, np.full_like(first, np.inf)
    for _ in range(_POLISH_STEPS):
        gap, along, other = points(two) - points(one), velocity(one), velocity(two)
        # parallel passes do not cross; touching ones are second contacts
        across = _cross(along, other)
        across = np.where(across == 0, np.nan, across)
        step = np.clip([_cross(gap, other), _cross(gap, along)] / across, -1.0, 1.0)
        one, two = one + step[0], two + step[1]
        change = np.abs(step).max(axis=0)
        if not (change > _POLISHED).any():
            break
    true = (change <= _ANGLE_RESOLVED * apart) & (np.abs(two - one) > 0.25 * apart)
    return one[true], two[true]


def _distinct(first: Array, second: Array) -> tuple[tuple[float, float], ...]:
    """Pairs of angles, rad, within the turn, the lesser first, in ascending order, without
    duplicates.
    """
    pairs = np.sort(np.mod([first, second], FULL_TURN), axis=0)
    kept: list[tuple[float, float]] = []
    for one, two in sorted(zip(*pairs.tolist(), strict=True)):
        same = _ANGLE_RESOLVED * min(two - one, FULL_TURN - two + one)
        start = bisect_left(kept, (one - same, 0.0))
        if all(abs(two - other) > same for _, other in kept[start:]):
            kept.append((one, two))
    return tuple(kept)


def _cross(a: Array, b: Array) -> Array:
    product: Array = a[0] * b[1] - a[1] * b[0]
    return product
