"""A trigger wheel on the crank: which edge passed when, and where the edges really are."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, Count, In, Part

FULL_TURN = 2.0 * pi
NEIGHBOURS = 9  # intervals in the local median
REGULAR = (0.6, 1.4)  # interval over local median; speed ripple stays well inside


Teeth = Annotated[int, Count(4, 720)]
MissingTeeth = Annotated[int, Count(0, 180)]
ToothShare = Annotated[float, In(above=0, below=1)]


@dataclass(frozen=True, eq=False)
class TriggerWheel(Part):
    """A wheel with `teeth` equal pitches whose last `missing_teeth` teeth are left out.

    Parameters
    ----------
    teeth : int                n, pitches of the wheel
    missing_teeth : int        m, <= n/4; 0: no gap, no reference
    reference_angle : float    rad, crank angle of the first rising edge after the first gap
                               recorded; without a gap that of the first edge recorded
    tooth_share : float        of the pitch, from the rising to the falling edge
    rising, falling : array (n - m,), optional   rad from the reference, instead of equal pitches

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    table: ClassVar[str] = "engine"
    labels: ClassVar[tuple[str, ...]] = ("rising", "falling")

    teeth: Teeth = 36
    missing_teeth: MissingTeeth = 0
    reference_angle: Angle = 0.0
    tooth_share: ToothShare = 0.5
    rising: Array | None = None
    falling: Array | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.missing_teeth > self.teeth // 4:
            limit = f"<= {self.teeth // 4}, a quarter of engine.teeth"
            raise InputError("engine.missing_teeth", self.missing_teeth, limit)
        for name in ("rising", "falling"):
            angles = getattr(self, name)
            if angles is not None:
                freeze(self, **{name: finite(f"wheel.{name}", angles)})

    @property
    def pitch(self) -> float:
        return FULL_TURN / self.teeth

    @property
    def present(self) -> int:
        return self.teeth - self.missing_teeth

    @property
    def regular(self) -> TriggerWheel:
        """The wheel with equal pitches."""
        return replace(self, rising=None, falling=None)

    def displaced(self, errors: Array) -> TriggerWheel:
        """The wheel of equal pitches with its edges later by angles (rad): rising edges (n - m,)
        first, then falling ones."""
        at = np.arange(self.present) * self.pitch
        rising, falling = errors[: self.present], errors[self.present :]
        between = at[: falling.size] + self.tooth_share * self.pitch
        return replace(
            self,
            rising=readonly(at + rising),
            falling=readonly(between + falling) if falling.size else None,
        )

    def angle(self, place: Array, falling: bool) -> Array:
        """Crank angle (rad) of edges at places of teeth, counted from the reference."""
        turn, tooth = np.divmod(place, self.teeth)
        known = self.falling if falling else self.rising
        at = tooth * self.pitch + (self.tooth_share * self.pitch if falling else 0.0)
        if known is not None:
            at = known[np.minimum(tooth, self.present - 1).astype(int)]
        return np.asarray(self.reference_angle + turn * FULL_TURN + at)


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges of one kind: times (n,), s, and places (n,) of their teeth, counted from the
    reference, gaps included."""

    times: Array
    places: Array
    falling: bool

    def __post_init__(self) -> None:
        freeze(self, times=self.times, places=self.places)

    def numbers(self, wheel: TriggerWheel) -> NDArray[np.intp]:
        """Numbers (n,) of the edges on the wheel: rising ones first, then falling ones."""
        tooth = np.mod(self.places, wheel.teeth).astype(np.intp)
        return np.asarray(tooth + (wheel.present if self.falling else 0))


def counted(field: str, times: ArrayLike, wheel: TriggerWheel, both: bool) -> tuple[Edges, ...]:
    """Edges of a run with the places of their teeth.

    Parameters
    ----------
    field : str          names the run in messages
    times : array (n,)   s, rising; every edge, the first a rising one, where `both`
    wheel : TriggerWheel

    Raises
    ------
    InputError
        If the times do not rise, the record is shorter than a turn, a tooth is missing
        elsewhere than in the gap, or the gap does not recur after n - m teeth.
    """
    at = finite(field, times)
    if at.ndim != 1 or at.size < wheel.present + 2:
        raise InputError(field, f"{at.size} edges", f"more than a turn of {wheel.present} teeth")
    falls = np.flatnonzero(~(np.diff(at) > 0.0))
    if falls.size:
        k = int(falls[0]) + 1
        raise InputError(f"{field} edge {k + 1}", f"{at[k]:.9g} s", f"after {at[k - 1]:.9g} s")
    rising = at[::2] if both else at
    places = tooth_places(field, rising, wheel)
    edges = [Edges(rising, places, False)]
    if both:
        edges.append(Edges(at[1::2], places[: at[1::2].size], True))
    return tuple(edges)


def tooth_places(field: str, times: Array, wheel: TriggerWheel) -> Array:
    """Places (n,) of the teeth whose edges of one kind have `times` (s).

    Raises
    ------
    InputError
        As `counted`.
    """
    intervals = np.diff(times)
    share = intervals / local_median(intervals)
    expected = np.ones_like(share)
    if wheel.missing_teeth:
        expected[share > 1.0 + 0.5 * wheel.missing_teeth] = 1.0 + wheel.missing_teeth
    off = (share / expected < REGULAR[0]) | (share / expected > REGULAR[1])
    if off.any():
        k = int(np.flatnonzero(off)[0])
        what = "a missing tooth" if share[k] > 1.0 else "an edge too many"
        value = f"{share[k]:.3g} times its neighbours ({what})"
        limit = f"1, or {1 + wheel.missing_teeth} in the gap" if wheel.missing_teeth else "near 1"
        raise InputError(f"{field} interval after {times[k]:.6g} s", value, limit)
    gaps = [int(k) for k in np.flatnonzero(expected > 1.0)]
    if wheel.missing_teeth:
        _guard_gaps(field, times, gaps, wheel)
    steps = np.concatenate([[0.0], np.cumsum(expected)])
    origin = steps[gaps[0] + 1] if wheel.missing_teeth else 0.0
    return np.asarray(steps - origin)


def local_median(intervals: Array) -> Array:
    """Median (n,) of `NEIGHBOURS` intervals around each one or, near an end, next to it, s."""
    if intervals.size <= NEIGHBOURS:
        return np.full(intervals.size, float(np.median(intervals)))
    medians = np.median(np.lib.stride_tricks.sliding_window_view(intervals, NEIGHBOURS), axis=1)
    first = np.arange(intervals.size) - NEIGHBOURS // 2
    return np.asarray(medians[np.clip(first, 0, medians.size - 1)])


def _guard_gaps(field: str, times: Array, gaps: list[int], wheel: TriggerWheel) -> None:
    """Refuse a gap that does not recur after every n - m teeth."""
    if not gaps:
        limit = f"a gap of {wheel.missing_teeth} missing teeth in every turn"
        raise InputError(field, "no gap", limit)
    ends = np.diff(gaps)
    wrong = np.flatnonzero(ends != wheel.present)
    first, last = gaps[0] + 1, times.size - 1 - gaps[-1]
    if wrong.size or first > wheel.present or last > wheel.present:
        k = int(wrong[0]) if wrong.size else 0
        number = int(ends[k]) if wrong.size else int(max(first, last))
        where = f"{field} between gaps from {times[gaps[k]]:.6g} s"
        raise InputError(where, f"{number} teeth", f"{wheel.present} of {wheel.teeth} places")
