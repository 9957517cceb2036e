"""Pattern of a trigger wheel in the times of its teeth: missing teeth, an additional tooth."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.trigger_wheel import local_median

GAP = 1.5  # interval over local median: teeth are missing
EVEN = (0.8, 1.25)  # of a single pitch; an additional tooth halves one
WHOLE = (0.75, 1.3)  # of both intervals beside an additional tooth
PAUSE = 30.0  # interval over the usual one: the crank stood still between two runs


@dataclass(frozen=True)
class ToothPattern:
    """Teeth of a wheel as they pass.

    Parameters
    ----------
    teeth : int or None    pitches of a turn; None: no mark recurs, so that a turn is not seen
    missing_teeth : int    at the gap
    extra_teeth : int      additional teeth between two others, 0 or 1
    """

    teeth: int | None
    missing_teeth: int = 0
    extra_teeth: int = 0

    @property
    def words(self) -> str:
        """Such as 60-2 or 4+1; n of an unknown number."""
        mark = f"-{self.missing_teeth}" if self.missing_teeth else ""
        mark += f"+{self.extra_teeth}" if self.extra_teeth else ""
        return f"{self.teeth or 'n'}{mark or ' teeth without a mark'}"


@dataclass(frozen=True)
class Recording:
    """What the record of a trigger wheel shows of itself.

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
    """Pattern that recurs most in the times (s) of edges of one kind."""
    intervals = np.diff(times)
    extra = extra_teeth(times)
    share = intervals / local_median(intervals)
    gaps = np.flatnonzero(share > GAP)
    if extra.size > gaps.size:
        return ToothPattern(_recurrence(extra, -1), 0, 1)
    if gaps.size:
        missing = int(np.round(np.median(share[gaps]))) - 1
        return ToothPattern(_recurrence(gaps, missing), missing)
    return ToothPattern(None)


def _recurrence(marks: NDArray[np.intp], added: int) -> int | None:
    """Pitches from mark to mark: the usual number of intervals, and those added at the mark."""
    if marks.size < 2:
        return None
    values, counts = np.unique(np.diff(marks), return_counts=True)
    return int(values[counts.argmax()]) + added


def regular(intervals: Array) -> NDArray[np.bool_]:
    """Whether each interval (n,) is a single pitch."""
    share = intervals / local_median(intervals)
    return np.asarray((share > EVEN[0]) & (share < EVEN[1]))


def extra_teeth(times: Array) -> NDArray[np.intp]:
    """Indices of teeth that stand between two others at the usual distance."""
    intervals = np.diff(times)
    share = intervals / local_median(intervals)
    short, both = share < EVEN[0], share[:-1] + share[1:]
    pair = short[:-1] & short[1:] & (both > WHOLE[0]) & (both < WHOLE[1])
    return np.asarray(np.flatnonzero(pair) + 1)


def runs_of(times: Array) -> list[slice[int, int, None]]:
    """Parts of a record between pauses of the crank."""
    intervals = np.diff(times)
    ends = np.flatnonzero(intervals > PAUSE * np.median(intervals)) + 1
    bounds = [0, *(int(end) for end in ends), times.size]
    return [slice(a, b) for a, b in pairwise(bounds)]
