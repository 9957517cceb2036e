"""Tooth pattern of a trigger wheel in its edge times: missing and additional teeth."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.trigger_wheel import MISSING_MAX, local_median

GAP = 1.5  # interval over local median: teeth are missing
EVEN = (0.8, 1.25)  # of a single pitch; an additional tooth halves one
WHOLE = (0.75, 1.3)  # of both intervals beside an additional tooth
CLEAR = 0.8  # of the gaps, the excess of undivided ones in one kind of crossings
PAUSE = 30.0  # interval over the usual one: the crank stood still between two runs


@dataclass(frozen=True)
class ToothPattern:
    """Sequence of tooth intervals of a wheel in passing order.

    Parameters
    ----------
    teeth : int or None    pitches of a turn; None: no mark recurs, so that a turn is not seen
    missing_teeth : int    at the gap
    extra_teeth : int      additional teeth between two others, 0 or 1
    rows : tuple of int    teeth in the rows between several gaps, the longest first; empty: one gap
    """

    teeth: int | None
    missing_teeth: int = 0
    extra_teeth: int = 0
    rows: tuple[int, ...] = ()

    @property
    def words(self) -> str:
        """Usual notation, such as 60-2, 36-2-2-2 or 4+1; n for an unknown number."""
        mark = f"-{self.missing_teeth}" * max(len(self.rows), 1) if self.missing_teeth else ""
        mark += f"+{self.extra_teeth}" if self.extra_teeth else ""
        return f"{self.teeth or 'n'}{mark or ' teeth without a mark'}"


@dataclass(frozen=True)
class Recording:
    """Properties of a trigger wheel that its record shows.

    Parameters
    ----------
    runs : int
    pattern : ToothPattern
    sampling_rate : float or None   Hz; None of tooth times
    """

    runs: int
    pattern: ToothPattern
    sampling_rate: float | None = None


def tooth_pattern(times: Array) -> ToothPattern:
    """Most frequent tooth pattern of a wheel, pitches of a turn with missing or additional teeth,
    seen in the times (n,), s, of edges of one kind.
    """
    intervals = np.diff(times)
    extra = extra_teeth(times)
    share = intervals / local_median(intervals)
    gaps = np.flatnonzero(share > GAP)
    if extra.size > gaps.size:
        row = _usual(np.diff(extra))
        return ToothPattern(None if row is None else row - 1, 0, 1)
    if not gaps.size:
        return ToothPattern(None)
    gaps = _gaps(intervals, int(np.round(np.median(share[gaps]))) - 1)
    missing = _missing(intervals, gaps, min(int(np.ceil(share.max())), MISSING_MAX))
    between = np.diff(gaps)
    rows = _recurring(between)
    if rows:
        return ToothPattern(sum(rows) + len(rows) * missing, missing, rows=rows)
    row = _usual(between)
    return ToothPattern(None if row is None else row + missing, missing)


def _gaps(intervals: Array, missing: int) -> NDArray[np.intp]:
    """Indices of the intervals that are gaps of `missing` teeth.

    Of all choices that for which the speed, pitch over time, changes least from interval to
    interval; by dynamic programming.

    Parameters
    ----------
    intervals : array (n,)   times between edges of one kind, s
    missing : int            teeth left out at a gap
    """
    slowness = np.log(intervals)[:, None] - np.array([0.0, np.log1p(missing)])
    change = np.abs(slowness[1:, :, None] - slowness[:-1, None, :])  # to either from either
    total, came = np.zeros(2), np.zeros((intervals.size, 2), dtype=np.intp)
    for k, step in enumerate(change, start=1):
        both = step + total
        came[k] = both.argmin(axis=1)
        total = both.min(axis=1)
    state, gaps = int(total.argmin()), []
    for k in range(intervals.size - 1, -1, -1):
        gaps += [k] * state
        state = int(came[k, state])
    return np.array(gaps[::-1], dtype=np.intp)


def _missing(intervals: Array, gaps: NDArray[np.intp], most: int) -> int:
    """Number of teeth left out at each gap for which the speed, pitch over time, changes least from
    interval to interval.

    Parameters
    ----------
    intervals : array (n,)   times between edges of one kind, s
    gaps : array             indices of those that are gaps
    most : int               greatest number tried
    """
    pitches = np.ones((most, intervals.size))
    pitches[:, gaps] += np.arange(1, most + 1)[:, None]
    changes = np.abs(np.diff(np.log(intervals / pitches), axis=1)).sum(axis=1)
    return int(changes.argmin()) + 1


def _recurring(between: NDArray[np.intp]) -> tuple[int, ...]:
    """Numbers of teeth in the rows between the several gaps of a turn, the longest row first; empty
    where they do not recur or a turn has one gap.

    Parameters
    ----------
    between : array   numbers of teeth between the gaps of a record, in order
    """
    for count in range(1, between.size - 1):
        if (between[count:] == between[:-count]).all():
            rows = tuple(int(teeth) for teeth in between[:count])
            return max(rows[k:] + rows[:k] for k in range(count)) if count > 1 else ()
    return ()


def _usual(between: NDArray[np.intp]) -> int | None:
    """The most frequent number of intervals from mark to mark."""
    values, counts = np.unique(between, return_counts=True)
    return int(values[counts.argmax()]) if values.size else None


def middles_by_gaps(one: Array, other: Array) -> int:
    """Kind of crossing at the tooth middles, 1 or 2; 0 where gaps do not show it.

    A gap of the wheel is one long interval between middles of teeth. The crossing of the other kind
    in its middle makes two of it.

    Parameters
    ----------
    one, other : array (n,), (m,)   times of the crossings of each kind, s
    """
    undivided, most = [], 0
    for times in (one, other):
        intervals = np.diff(times)
        long = np.pad(intervals / local_median(intervals) > EVEN[1], 1)
        alone = int((long[1:-1] & ~long[:-2] & ~long[2:]).sum())
        pairs = int((long[1:] & long[:-1]).sum())
        if extra_teeth(times).size > alone + pairs:
            return 0
        undivided.append(alone - pairs)
        most = max(most, alone + pairs)
    if abs(undivided[0] - undivided[1]) <= CLEAR * most:
        return 0
    return 1 if undivided[0] > undivided[1] else 2


def regular(intervals: Array) -> NDArray[np.bool_]:
    """Mask (n,) of intervals, s, that span a single tooth pitch, by their local median."""
    share = intervals / local_median(intervals)
    return np.asarray((share > EVEN[0]) & (share < EVEN[1]))


def extra_teeth(times: Array) -> NDArray[np.intp]:
    """Indices of the edges of additional teeth, which stand between two teeth at the usual
    distance, in the times (n,), s, of edges of one kind.
    """
    intervals = np.diff(times)
    share = intervals / local_median(intervals)
    short, both = share < EVEN[0], share[:-1] + share[1:]
    pair = short[:-1] & short[1:] & (both > WHOLE[0]) & (both < WHOLE[1])
    return np.asarray(np.flatnonzero(pair) + 1)


def runs_of(times: Array) -> list[slice[int, int, None]]:
    """Slices of the edge times of a record, s, one for each run between pauses of the crank,
    intervals above `PAUSE` times the median.
    """
    intervals = np.diff(times)
    ends = np.flatnonzero(intervals > PAUSE * np.median(intervals)) + 1
    bounds = [0, *(int(end) for end in ends), times.size]
    return [slice(a, b) for a, b in pairwise(bounds)]
