"""Trigger wheel on the crank: numbering of its edges, and their true angles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi
from typing import Annotated, ClassVar, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, Count, In, Part

FULL_TURN = 2.0 * pi
NEIGHBOURS = 9  # intervals in the local median
CYCLES_MIN = 3  # of a record, to compare intervals with those of other cycles
REGULAR = (0.6, 1.4)  # time of a pitch over those beside it; an edge missed makes 1.5 or 2


Teeth = Annotated[int, Count(4, 720)]
MISSING_MAX = 180
MissingTeeth = Annotated[int, Count(0, MISSING_MAX)]
ToothShare = Annotated[float, In(above=0, below=1)]


@dataclass(frozen=True, eq=False)
class TriggerWheel(Part):
    """Wheel with `teeth` equal pitches, of which the last `missing_teeth` teeth are missing.

    One with several gaps of so many teeth has `rows` of teeth between them.

    Parameters
    ----------
    teeth : int                n, pitches of the wheel
    missing_teeth : int        m, <= n/4; 0: no gap, no reference
    reference_angle : float    rad, crank angle of the first rising edge after the first gap
                               recorded, of several gaps that before the first row; without a gap
                               that of the first edge recorded
    tooth_share : float        of the pitch, from the rising to the falling edge
    rows : tuple of int        teeth of each row, the longest first; empty: one row
    rising, falling : array (n - m,), optional   rad from the reference, instead of equal pitches

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    table: ClassVar[str] = "engine"
    labels: ClassVar[tuple[str, ...]] = ("rows", "rising", "falling")

    teeth: Teeth = 36
    missing_teeth: MissingTeeth = 0
    reference_angle: Angle = 0.0
    tooth_share: ToothShare = 0.5
    rows: tuple[int, ...] = ()
    rising: Array | None = None
    falling: Array | None = None

    def __post_init__(self) -> None:
        """Refuse more missing teeth than a quarter of the pitches, and rows that do not add up to
        them; the arrays become read-only.
        """
        super().__post_init__()
        if self.missing_teeth > self.teeth // 4:
            limit = f"<= {self.teeth // 4}, a quarter of engine.teeth"
            raise InputError("engine.missing_teeth", self.missing_teeth, limit)
        if self.rows and self.present + len(self.rows) * self.missing_teeth != self.teeth:
            raise InputError("wheel.rows", self.rows, f"{self.teeth} teeth with their gaps")
        for name in ("rising", "falling"):
            angles = getattr(self, name)
            if angles is not None:
                freeze(self, **{name: finite(f"wheel.{name}", angles)})

    @property
    def pitch(self) -> float:
        return FULL_TURN / self.teeth

    @property
    def present(self) -> int:
        """Number of teeth that exist."""
        return sum(self.rows) if self.rows else self.teeth - self.missing_teeth

    @property
    def steps(self) -> Array:
        """Distance from each tooth to the next, in pitches (n - m,), of n teeth of which m are
        missing.
        """
        rows = self.rows or (self.present,)
        steps = np.ones(self.present)
        steps[np.cumsum(rows) - 1] += self.missing_teeth
        return steps

    @property
    def places(self) -> Array:
        """Places of the teeth (n - m,), in pitches from the reference."""
        return np.cumsum(self.steps) - self.steps

    def number(self, place: Array) -> NDArray[np.intp]:
        """Number of the tooth at a position from the reference, or of the last one before it."""
        return np.searchsorted(self.places, np.mod(place, self.teeth), side="right") - 1

    @property
    def regular(self) -> TriggerWheel:
        """The wheel with equal pitches."""
        return replace(self, rising=None, falling=None)

    def displaced(self, errors: Array) -> TriggerWheel:
        """Wheel of equal pitches with its edges displaced by pitch errors, rad, positive: later.

        Parameters
        ----------
        errors : array   of the rising edges (n - m,), then of the falling ones, if any
        """
        at = self.places * self.pitch
        rising, falling = errors[: self.present], errors[self.present :]
        between = at[: falling.size] + self.tooth_share * self.pitch
        return replace(
            self,
            rising=readonly(at + rising),
            falling=readonly(between + falling) if falling.size else None,
        )

    def angle(self, place: Array, falling: bool) -> Array:
        """Crank angle of edges, rad (...), at places of teeth, in pitches, counted from the
        reference tooth over all turns.

        Parameters
        ----------
        place : array (...)   whole numbers, gaps included
        falling : bool        falling edges of the teeth; else the rising ones
        """
        turn, tooth = np.divmod(place, self.teeth)
        known = self.falling if falling else self.rising
        at = tooth * self.pitch + (self.tooth_share * self.pitch if falling else 0.0)
        if known is not None:
            at = known[self.number(tooth)]
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
        """Numbers (n,) of the edges on the wheel, rising ones first, then falling ones."""
        return wheel.number(self.places) + (wheel.present if self.falling else 0)


def counted(field: str, times: ArrayLike, wheel: TriggerWheel, both: bool) -> tuple[Edges, ...]:
    """Edges of a run assigned to tooth positions.

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
        _guard_kinds(field, at, np.diff(places) > 1.0)
        edges.append(Edges(at[1::2], places[: at[1::2].size], True))
    return tuple(edges)


def _guard_kinds(field: str, times: Array, gaps: NDArray[np.bool_]) -> None:
    """Refuse edges whose gaps lie before falling edges: one before was missed or is too many, or
    the first edge is a falling one.

    Parameters
    ----------
    field : str         name of the run, for the message
    times : array       of all edges, s, rising and falling in turn
    gaps : array (n,)   which intervals between rising edges are gaps
    """
    rising, falling = times[::2], times[1::2]
    late = falling[: gaps.size] - rising[:-1] > 0.5 * np.diff(rising)
    if (gaps & late).any():
        k = int(np.argmax(gaps & late))
        limit = "one that rises; the first edge falls, or one is missing or too many"
        raise InputError(f"{field} gap after {rising[k]:.6g} s", "before an edge that falls", limit)


def tooth_places(field: str, times: Array, wheel: TriggerWheel) -> Array:
    """Tooth positions (n,), in pitches from the reference tooth, of edges of one kind, gaps
    counted.

    The first edge is that of the tooth with which the speed changes least from interval to
    interval, so that a gap may pass at another speed than its neighbours.

    Parameters
    ----------
    field : str            name of the run, for messages
    times : array (n,)     of the edges, s
    wheel : TriggerWheel   with its gaps

    Raises
    ------
    InputError
        As `counted`.
    """
    intervals = np.diff(times)
    steps = np.resize(wheel.steps, intervals.size + wheel.present)
    starts = range(wheel.present if wheel.missing_teeth else 1)
    changes = [
        np.abs(np.diff(np.log(intervals / steps[first : first + intervals.size]))).sum()
        for first in starts
    ]
    first = int(np.argmin(changes))
    expected = steps[first : first + intervals.size]
    origin = wheel.present - first if wheel.missing_teeth else 0
    slowness, cycle = np.log(intervals / expected), 2 * wheel.present
    gaps = np.flatnonzero(expected > 1.0)
    fits = not wheel.missing_teeth or (
        origin <= intervals.size and _fits_gap(slowness, gaps, cycle, wheel.missing_teeth)
    )
    if not fits or not _is_steady(slowness, cycle):
        _refuse(field, times, wheel)
    places = np.concatenate([[0.0], np.cumsum(expected)])
    return np.asarray(places - places[origin])


def _is_steady(slowness: Array, cycle: int) -> bool:
    """Whether no interval between teeth stands out from its neighbours, as it would if an edge were
    missed.

    Where the speed changes much within a pitch, an interval is compared with those at the same
    place in other cycles; what then stands out in both turns of a cycle is a fault of the wheel.

    Parameters
    ----------
    slowness : array (n,)   logarithm of the time of a pitch in each interval
    cycle : int             intervals of a cycle, two turns
    """
    if all(_regular(_off_neighbours(slowness, reach)).all() for reach in (1, 2)):
        return True
    whole = slowness.size // cycle * cycle
    if whole < CYCLES_MIN * cycle:
        return False
    usual = np.median(slowness[:whole].reshape(-1, cycle), axis=0)
    turns = (usual - 0.5 * (np.roll(usual, 1) + np.roll(usual, -1))).reshape(2, -1)
    alike = _regular(slowness - np.resize(usual, slowness.size))
    return bool(alike.all() and _regular(turns).any(axis=0).all())


def _regular(off: Array) -> NDArray[np.bool_]:
    """Whether logarithms of ratios are within `REGULAR`."""
    return np.asarray((off > np.log(REGULAR[0])) & (off < np.log(REGULAR[1])))


def _off_neighbours(values: Array, reach: int) -> Array:
    """Values (n,) less the mean of the two `reach` before and behind."""
    padded = np.pad(values, reach, mode="reflect") if values.size > 1 else np.resize(values, 3)
    return np.asarray(values - 0.5 * (padded[: values.size] + padded[-values.size :]))


def _fits_gap(slowness: Array, gaps: NDArray[np.intp], cycle: int, missing: int) -> bool:
    """Whether the gaps have the stated number of missing teeth rather than one more or less, judged
    at the place in the cycle where the speed changes least.

    Parameters
    ----------
    slowness : array (n,)   logarithm of the time of a pitch in each interval, with the stated
                            number
    gaps : array            indices of the intervals that are gaps
    cycle : int             intervals of a cycle, two turns
    missing : int           stated number of teeth left out at a gap
    """
    off, places = _off_neighbours(slowness, 1)[gaps], np.mod(gaps, cycle)
    usual = [float(np.median(off[places == place])) for place in np.unique(places)]
    low, high = -0.5 * np.log1p(1.0 / missing), 0.5 * np.log1p(1.0 / (missing + 1.0))
    return bool(low < min(usual, key=abs) < high)


def _refuse(field: str, times: Array, wheel: TriggerWheel) -> NoReturn:
    """Raise InputError for edge times that do not fit the wheel, naming the first interval that
    shows it and what is wrong there.

    Parameters
    ----------
    field : str            name of the run
    times : array (n,)     of edges of one kind, s
    wheel : TriggerWheel   as stated
    """
    intervals = np.diff(times)
    share = intervals / local_median(intervals)
    expected = np.ones_like(share)
    if wheel.missing_teeth:
        expected[share > 1.0 + 0.5 * wheel.missing_teeth] = 1.0 + wheel.missing_teeth
    off = (share / expected < REGULAR[0]) | (share / expected > REGULAR[1])
    gaps = np.flatnonzero(expected > 1.0)
    if wheel.missing_teeth and not off.any():
        if not gaps.size:
            limit = f"a gap of {wheel.missing_teeth} missing teeth in every turn"
            raise InputError(field, "no gap", limit)
        ends = np.diff(gaps)
        beyond = np.array([gaps[0] + 1, times.size - 1 - gaps[-1]])
        wrong = np.flatnonzero(ends != wheel.present)
        k = int(wrong[0]) if wrong.size else 0
        number = int(ends[k]) if wrong.size else int(beyond.max())
        where = f"{field} between gaps from {times[gaps[k]]:.6g} s"
        raise InputError(where, f"{number} teeth", f"{wheel.present} of {wheel.teeth} places")
    k = int(np.abs(np.log(share / expected)).argmax()) if not off.any() else int(off.argmax())
    what = "a missing tooth" if share[k] > 1.0 else "an edge too many"
    value = f"{share[k]:.3g} times its neighbours ({what})"
    limit = f"1, or {1 + wheel.missing_teeth} in the gap" if wheel.missing_teeth else "near 1"
    raise InputError(f"{field} interval after {times[k]:.6g} s", value, limit)


def local_median(intervals: Array) -> Array:
    """Running median (n,), s, of `NEIGHBOURS` intervals (n,), s, about each one; near the ends that
    of the first or last ones.
    """
    if intervals.size <= NEIGHBOURS:
        return np.full(intervals.size, float(np.median(intervals)))
    medians = np.median(np.lib.stride_tricks.sliding_window_view(intervals, NEIGHBOURS), axis=1)
    first = np.arange(intervals.size) - NEIGHBOURS // 2
    return np.asarray(medians[np.clip(first, 0, medians.size - 1)])
