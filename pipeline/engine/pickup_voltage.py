"""Trigger-wheel edges from the voltage of a variable-reluctance pick-up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Count, In, Known
from camwright.pipeline.engine.speed_file import WheelTable, speed_of_record
from camwright.pipeline.engine.speed_trace import SpeedTrace
from camwright.pipeline.engine.tooth_pattern import (
    Recording,
    ToothPattern,
    extra_teeth,
    middles_by_gaps,
    regular,
    runs_of,
    tooth_pattern,
)
from camwright.pipeline.engine.trigger_wheel import (
    Edges,
    TriggerWheel,
    local_median,
    tooth_places,
)
from camwright.pipeline.engine.wheel_calibration import Calibrator, EdgeRecord
from camwright.pipeline.torque.trace_file import columns_of, trace_text

THRESHOLD = 0.25  # of half the swing, exceeded on both sides of a crossing
NOISE_TIMES = 4.0  # the threshold is at least as many times the noise
NOISE_MAX = 0.8  # of half the swing: the greatest threshold
RAILS = (0.01, 0.99)  # quantiles between which the voltage swings
NEAR_RAIL = 0.15  # of the swing
HALF_WAVE = 0.45  # share of the samples near one rail of a rectified voltage
HALF_WAVE_OTHER = 0.25  # of that share, near the other rail
BLOCKS = 12  # of the record, whose centres show a drift
DRIFT_ORDER = 4  # of the polynomial through them
INSIDE = 0.8  # of half the swing, between the rails
NOISE_SAMPLES = 50  # between the rails, to show the noise there
DRIFT_LEAST = 0.05  # of the swing; less is the effect of the gap on a block
DRIFT_CLEAR = 6.0  # times the scatter of the blocks about it
CROSSINGS_MIN = 8
VOLTAGE_MAX = 1e4
SAMPLES_PER_TOOTH_MIN = 6.0
FLANK_PITCHES = 1.5  # a crossing that takes longer lies in a gap or a pause
FLANK_MAX = 64  # samples of the straight line through a crossing
STEEPER = 1.5  # slope of rising crossings over falling ones: the leads are exchanged
SHOWN = "as the signal shows"
VAGUE = 4.0  # jitter of one kind of crossings over that of the other: left out


@dataclass(frozen=True, kw_only=True)
class VoltageTable(WheelTable):
    """Voltage of a variable-reluctance pick-up at the trigger wheel, from a file.

    Numbers of teeth left out are those that the signal shows.
    """

    defaults: ClassVar[Mapping[str, str]] = {
        **WheelTable.defaults, "teeth": SHOWN, "missing_teeth": SHOWN, "extra_teeth": SHOWN,
    }  # fmt: skip

    kind: Literal["voltage"] = "voltage"
    extra_teeth: Annotated[int | None, Count(0, 1), Known("counted", 1)] = None
    """additional teeth between two others of the wheel"""
    threshold: Annotated[float, In(above=0, below=1), Known("own choice")] = THRESHOLD
    """share of the amplitude at which the voltage is switched"""

    def wheel_shown(self, field: str, shown: ToothPattern) -> TriggerWheel:
        """Trigger wheel as stated in the case, completed by what the signal shows.

        Parameters
        ----------
        field : str            name of the signal, for messages
        shown : ToothPattern   teeth seen in the signal

        Raises
        ------
        InputError
            If case and signal contradict each other, by the key; if neither has the number of
            teeth.
        """
        known = {
            "teeth": shown.teeth, "missing_teeth": shown.missing_teeth,
            "extra_teeth": shown.extra_teeth,
        }  # fmt: skip
        for key, value in known.items():
            stated = getattr(self, key)
            if value is not None and stated is not None and stated != value:
                limit = f"{value}, or left out: {field} shows {shown.words}"
                raise InputError(f"engine.{key}", stated, limit)
        teeth = shown.teeth or self.teeth
        if teeth is None:
            limit = f"stated, as {field} shows {shown.words}"
            raise InputError("engine.teeth", "missing", limit)
        stated = replace(self, teeth=teeth, missing_teeth=shown.missing_teeth).wheel
        return replace(stated, rows=shown.rows)


@dataclass(frozen=True, eq=False)
class Crossings:
    """Crossings of a voltage through its switching level.

    Parameters
    ----------
    times : array (n,)    s
    rising : array (n,)   whether the voltage rises there
    slopes : array (n,)   V/s
    """

    times: Array
    rising: NDArray[np.bool_]
    slopes: Array

    def __post_init__(self) -> None:
        freeze(self, times=self.times, slopes=self.slopes)

    @property
    def mirrored(self) -> bool:
        """Whether the middles of the teeth are at the rising crossings, as with a pick-up of
        reversed polarity.

        The crossings at the middles of teeth divide the gaps of the wheel in two, those of the
        other kind do not. Without a gap, or a crossing in it, the crossings of the steep kind are
        at the teeth; of equally steep ones those with less jitter.
        """
        middles = middles_by_gaps(self.times[~self.rising], self.times[self.rising])
        if middles:
            return middles == 2
        falling, rising = (
            float(np.median(np.abs(self.slopes[kind]))) for kind in (~self.rising, self.rising)
        )
        if max(falling, rising) > STEEPER * min(falling, rising):
            return rising > falling
        return jitter(self.times[~self.rising]) > VAGUE * jitter(self.times[self.rising])


@dataclass(frozen=True, eq=False)
class Swing:
    """Voltage about the middle between its rails, offset and drift removed.

    Parameters
    ----------
    time : array (n,)    s
    value : array (n,)   V, from the middle
    half : float         V, from the middle to either rail
    noise : float        V, standard deviation
    base : float         V, from the middle to the voltage without a tooth
    """

    time: Array
    value: Array
    half: float
    noise: float
    base: float

    def __post_init__(self) -> None:
        freeze(self, time=self.time, value=self.value)

    def crossings(self, threshold: float, speed: Array | float = 1.0) -> Crossings:
        """Zero crossings, interpolated linearly on the samples of each flank.

        A crossing counts if the voltage exceeds the threshold before and after it, on opposite
        sides. The voltage is proportional to the speed. So is the height of the level above the
        voltage without a tooth, which it then crosses at one angle of the tooth.

        Parameters
        ----------
        threshold : float   share of `half`
        speed : array (n,)  over its mean
        """
        value = self.value - self.base * (1.0 - np.asarray(speed))
        bound = max(threshold * self.half, NOISE_TIMES * self.noise)
        beyond = np.flatnonzero(np.abs(value) > bound)
        side = np.sign(value[beyond])
        turn = np.flatnonzero(side[1:] != side[:-1])
        before, after = beyond[turn], beyond[turn + 1]
        rising = side[turn] < 0.0
        if rising.sum() > 1:  # a flank is shorter than a pitch, unless in a gap or a pause
            pitch = float(np.median(np.diff(self.time[before[rising]])))
            short = self.time[after] - self.time[before] < FLANK_PITCHES * pitch
            before, after, rising = before[short], after[short], rising[short]
        times, slopes = _lines(self.time, value, self.noise, before, after)
        return Crossings(times, rising, slopes)

    def upright(self, threshold: float) -> Swing:
        """Voltage with the polarity with which the middles of the teeth are at falling crossings;
        unchanged where the crossings are too few to show it.

        Parameters
        ----------
        threshold : float   of half the swing, exceeded on both sides of a crossing
        """
        crossings = self.crossings(threshold)
        if crossings.times.size < CROSSINGS_MIN or not crossings.mirrored:
            return self
        return replace(self, value=-self.value, base=-self.base)


def swing_of(field: str, time: ArrayLike, voltage: ArrayLike) -> Swing:
    """Voltage about the middle between its rails, offset and drift removed.

    The middle is that between robust quantiles, over blocks of the record, so that neither a
    clipped, squared or rectified wave nor a drift displaces it.

    Parameters
    ----------
    time : array (n,)       s, rising
    voltage : array (n,)    V

    Raises
    ------
    InputError
        If the times do not rise, or the voltage is constant or drowned in noise.
    """
    at, volts = finite("time", time), finite(field, voltage)
    if at.shape != volts.shape or at.ndim != 1 or at.size < 16:
        raise InputError(field, f"{volts.size} samples", "as many as times, 16 or more")
    if not (np.diff(at) > 0.0).all():
        k = int(np.flatnonzero(~(np.diff(at) > 0.0))[0]) + 1
        raise InputError(f"time, sample {k + 1}", f"{at[k]:.9g} s", f"after {at[k - 1]:.9g} s")
    highest = float(np.abs(volts).max())
    if not highest <= VOLTAGE_MAX:
        raise InputError(field, f"{highest:.3g} V", f"at most {VOLTAGE_MAX:g} V; check its unit")
    centred, live = _without_drift(volts)
    low, high = (float(level) for level in np.quantile(centred[live], RAILS))
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    if not half > 1e-9 * highest:
        limit = "an alternating voltage; check channel, cable and gap of the pick-up"
        raise InputError(field, f"constant at {float(np.median(volts)):.4g} V", limit)
    value = centred - middle
    noise = _noise(value, half)
    if not NOISE_TIMES * noise <= NOISE_MAX * half:
        swing = NOISE_TIMES / NOISE_MAX * 2.0 * noise
        limit = f">= {swing:.3g} V, as its noise is {noise:.3g} V, or finer sampling"
        raise InputError(f"{field}, peak to peak", f"{2.0 * half:.3g} V", limit)
    return Swing(_even(at), value, half, noise, _base(value[live], half))


def _base(value: Array, half: float) -> float:
    """Voltage without a tooth, V, from the middle between the rails: a rail of a rectified wave,
    the median of any other, 0 where that is near a rail.

    The median of a squared wave is at a rail as well; it crosses any level at once.

    Parameters
    ----------
    value : array (n,)   V, from the middle between the rails
    half : float         half the distance of the rails, V
    """
    near = [float((np.abs(value - rail) < NEAR_RAIL * 2.0 * half).mean()) for rail in (-half, half)]
    if max(near) > HALF_WAVE and min(near) < HALF_WAVE_OTHER * max(near):
        return -half if near[0] > near[1] else half
    median = float(np.median(value))
    return median if abs(median) < INSIDE * half else 0.0


def _without_drift(volts: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Voltage (n,) less its drift, V, and which samples (n,) are in blocks of the record in which
    teeth pass.

    The drift is a polynomial through the middles between the rails of these blocks; it is left in
    where it is small against swing and scatter.
    """
    edges = np.linspace(0, volts.size, BLOCKS + 1).astype(int)
    rails = np.array([np.quantile(volts[a:b], RAILS) for a, b in pairwise(edges)])
    swings = rails[:, 1] - rails[:, 0]
    live = swings >= 0.5 * np.quantile(swings, 0.8)
    order = min(DRIFT_ORDER, int(live.sum()) - 1)
    middles = 0.5 * (edges[:-1] + edges[1:])[live]
    drift = np.polynomial.Polynomial.fit(
        middles, rails[live].mean(axis=1), order, domain=[0.0, float(volts.size)]
    )
    slow = drift(np.arange(volts.size))
    left = rails[live].mean(axis=1) - drift(middles)
    drifts = np.ptp(slow) > max(DRIFT_LEAST * np.median(swings[live]), DRIFT_CLEAR * left.std())
    return volts - slow if drifts else volts, np.repeat(live, np.diff(edges))


def _noise(value: Array, half: float) -> float:
    """Standard deviation, V, of white noise in a voltage, from fourth differences of samples
    between the rails.

    A clipped voltage has no noise at its rails; a squared one is nowhere between them: all samples
    are then used.

    Parameters
    ----------
    value : array (n,)   V, from the middle between the rails
    half : float         half the distance of the rails, V
    """
    between = np.convolve(np.abs(value) > INSIDE * half, np.ones(5), "valid") < 0.5
    fourth = np.abs(np.diff(value, 4))
    usual = np.median(fourth[between] if between.sum() > NOISE_SAMPLES else fourth)
    return float(1.4826 / np.sqrt(70.0) * usual)


def _even(time: Array) -> Array:
    """Times of even samples where those stated are their rounded values, else as stated."""
    even = np.linspace(time[0], time[-1], time.size)
    return even if np.abs(time - even).max() < even[1] - even[0] else time


def _lines(
    time: Array, value: Array, noise: float, before: NDArray[np.intp], after: NDArray[np.intp]
) -> tuple[Array, Array]:
    """Times (k,), s, and slopes (k,), V/s, at which straight lines through k flanks of a voltage
    cross zero.

    A line is that of least squares through the samples that noise may bring to zero; where they are
    fewer than three, through the two beside the first change of sign.

    Parameters
    ----------
    time, value : arrays (n,)     s; V, less the switching level
    noise : float                 standard deviation, V
    before, after : arrays (k,)   indices of the samples at both ends of each flank
    """
    if before.size == 0:
        return np.zeros(0), np.zeros(0)
    middle = (before + after) // 2
    first = np.maximum(before, middle - FLANK_MAX // 2)
    last = np.minimum(after, middle + FLANK_MAX // 2)
    offset = np.arange(int((last - first).max()) + 1)
    place = np.minimum(first[:, None] + offset, last[:, None])
    at, volts = time[place] - time[first][:, None], value[place]
    near = (np.abs(volts) <= NOISE_TIMES * noise) & (first[:, None] + offset < last[:, None])
    few = near.sum(axis=1) < 3
    change = (volts * value[before][:, None] <= 0.0).argmax(axis=1)
    pair = (offset == change[:, None]) | (offset == change[:, None] - 1)
    used = np.where(few[:, None], pair, near)
    count = used.sum(axis=1)
    at_mean, volts_mean = ((used * part).sum(axis=1) / count for part in (at, volts))
    off = used * (at - at_mean[:, None])
    slope = (off * volts).sum(axis=1) / np.maximum((off**2).sum(axis=1), np.finfo(float).tiny)
    chord = (value[after] - value[before]) / (time[after] - time[before])
    slope = np.where(slope * chord > 0.0, slope, chord)  # else noise on a plateau
    zero = time[first] + at_mean - volts_mean / slope
    return np.clip(zero, time[before], time[after]), slope


def jitter(times: Array) -> float:
    """Standard deviation of single edge times of one kind, s, by their third differences.

    Where the intervals differ, such as at a gap, none is taken; infinite without any.
    """
    even = regular(np.diff(times))
    third = np.abs(np.diff(times, 3)[even[:-2] & even[1:-1] & even[2:]])
    return float(1.4826 / np.sqrt(20.0) * np.median(third)) if third.size else np.inf


def crossings_of(field: str, swing: Swing, threshold: float) -> Crossings:
    """Crossings of a voltage of correct polarity; the falling ones are at tooth middles.

    Raises
    ------
    InputError
        If too few teeth pass.
    """
    crossings = _enough(field, swing.crossings(threshold))
    speed = _relative_speed(swing.time, crossings.times[~crossings.rising])
    return _enough(field, swing.crossings(threshold, speed))


def _relative_speed(time: Array, middles: Array) -> Array:
    """Speed of the wheel over its mean (n,), by a cubic spline of the places of the teeth over
    their times.

    Parameters
    ----------
    time : array (n,)      at which it is wanted, s
    middles : array (m,)   times of the middles of the teeth, s
    """
    middles = np.delete(middles, extra_teeth(middles))
    intervals = np.diff(middles)
    pitches = np.maximum(np.round(intervals / local_median(intervals)), 1.0)
    places = np.concatenate([[0.0], np.cumsum(pitches)])
    rate = scipy.interpolate.CubicSpline(middles, places).derivative()
    inside = np.clip(time, middles[0], middles[-1])
    return np.asarray(rate(inside) * (middles[-1] - middles[0]) / places[-1])


def _enough(field: str, crossings: Crossings) -> Crossings:
    """The crossings themselves; InputError, naming `field`, if they are too few for a wheel."""
    if crossings.times.size < CROSSINGS_MIN:
        limit = f"{CROSSINGS_MIN} or more; check channel, record and engine.threshold"
        raise InputError(field, f"{crossings.times.size} crossings", limit)
    return crossings


@dataclass(frozen=True, eq=False)
class PickupRun:
    """Edges of one run past a pick-up.

    Parameters
    ----------
    edges : tuple       those of the falling crossings and, unless vague, of the rising ones
    lead : float        of the falling crossings before the middles of the teeth, in pitches
    tooth_share : float of the rising crossings behind the falling ones, in pitches
    """

    edges: tuple[Edges, ...]
    lead: float
    tooth_share: float


def passage(
    field: str, crossings: Crossings, base: float, wheel: TriggerWheel, extra: int
) -> PickupRun:
    """Edges of one run past the pick-up, with the positions of their teeth: of the falling
    crossings, then of the rising ones.

    The falling crossings, which are steep, are counted. Rising ones in the gap of the wheel are
    left out, and all of them where they jitter more.

    Parameters
    ----------
    field : str             name of the signal, for messages
    crossings : Crossings   of the run
    base : float            V, of `Swing`: the middle of a tooth is where the flank reaches it
    wheel : TriggerWheel    with its number of teeth
    extra : int             additional teeth between two others, 0 or 1; the first one is the origin

    Raises
    ------
    InputError
        As `tooth_places`.
    """
    middles, between = crossings.times[~crossings.rising], crossings.times[crossings.rising]
    slopes = crossings.slopes[~crossings.rising]
    vague = jitter(between) > VAGUE * jitter(middles)
    lead = base / float(np.median(slopes)) / float(np.median(np.diff(middles)))
    origin = 0
    if extra:
        marks = extra_teeth(middles)
        origin = int(marks[0]) if marks.size else 0
        middles = np.delete(middles, marks)
    places = tooth_places(field, middles, wheel) - origin
    edges = [Edges(middles, places, False)]
    # Rising crossings alone within a single pitch.
    index = np.searchsorted(middles, between)
    inside = (index > 0) & (index < middles.size)
    index, between = index[inside], between[inside]
    single = places[index] - places[index - 1] == 1.0
    single &= np.bincount(index, minlength=middles.size)[index] == 1
    index, between = index[single], between[single]
    if vague or between.size < 2:
        return PickupRun(tuple(edges), lead, wheel.tooth_share)
    after = (between - middles[index - 1]) / (middles[index] - middles[index - 1])
    edges.append(Edges(between, places[index - 1], True))
    return PickupRun(tuple(edges), lead, float(np.median(after)))


def speed_from_voltage(
    path: str | Path, table: VoltageTable, calibrator: Calibrator | None = None
) -> SpeedTrace:
    """Crank speed from a CSV file of time and voltage of a pick-up.

    Every voltage column, or each of those that `column` of the table names, is a run, or several
    between which the crank stood still.

    Parameters
    ----------
    path : path               of the file
    table : VoltageTable      wheel, threshold, filter of the speed
    calibrator : Calibrator   of the pitch errors; None: a wheel without pitch errors

    Raises
    ------
    InputError
        As `read_trace`, `edges_of_signals` and `speed_of_record`.
    """

    def read(file: str | Path) -> tuple[EdgeRecord, Recording]:
        return edges_of_signals(*_signals(file, table.column), table)

    record, recording = read(path)
    trace = speed_of_record(record, table.band, calibrator, lambda file: read(file)[0])
    return replace(trace, recording=recording)


def _signals(path: str | Path, column: str) -> tuple[str, Array, dict[str, Array]]:
    """Name of a CSV file, times (n,), s, and voltages (n,), V, by column.

    Parameters
    ----------
    column : str   beginning of the headers of the columns to read; "": all of voltage

    Raises
    ------
    InputError
        If there is not one column of time, or none of voltage.
    """
    text = trace_text(Path(path), "time_s,voltage_V")
    times, volts = columns_of(text.header, "time"), columns_of(text.header, "voltage", column)
    if len(times) != 1 or not volts:
        limit = "one column of time (s, ms, us) and one or more of voltage (V, mV)"
        raise InputError(f"{text.name} header", ", ".join(text.header), limit)
    columns = text.numbers((*times, *volts))
    signals = {
        f"{text.name} {text.header[at]}": factor * columns[:, k]
        for k, (at, factor) in enumerate(volts.items(), start=1)
    }
    return text.name, columns[:, 0] * next(iter(times.values())), signals


def edges_of_signals(
    source: str, time: ArrayLike, signals: Mapping[str, Array], table: VoltageTable
) -> tuple[EdgeRecord, Recording]:
    """Edges of a trigger wheel in the voltages of a record, with the wheel, and what the record
    shows of the wheel.

    Parameters
    ----------
    source : str                name of the record, for messages
    time : array (n,)           s
    signals : mapping to (n,)   V, by name
    table : VoltageTable        wheel and threshold as stated

    Raises
    ------
    InputError
        As `swing_of` and `passage`; if the sampling is too coarse for the teeth, the runs show
        different wheels, or another one is stated.
    """
    at = finite("time", time)
    spacing = float(np.median(np.diff(at))) if at.size > 1 else np.nan
    parts: list[tuple[str, Crossings, float]] = []
    for field, volts in signals.items():
        swing = swing_of(field, at, volts).upright(table.threshold)
        crossings = crossings_of(field, swing, table.threshold)
        middles = crossings.times[~crossings.rising]
        per_tooth = float(np.median(np.diff(middles))) / spacing
        if per_tooth < SAMPLES_PER_TOOTH_MIN:
            limit = f"{SAMPLES_PER_TOOTH_MIN:g} or more, at a sampling rate of"
            rate = SAMPLES_PER_TOOTH_MIN / per_tooth / spacing
            raise InputError(field, f"{per_tooth:.3g} samples per tooth", f"{limit} {rate:.3g} Hz")
        parts += [(field, part, swing.base) for part in _runs(crossings)]
    shown = _common([(field, tooth_pattern(part.times[~part.rising])) for field, part, _ in parts])
    wheel = table.wheel_shown(source, shown)
    runs = [passage(field, part, base, wheel, shown.extra_teeth) for field, part, base in parts]
    wheel = replace(
        wheel,
        reference_angle=wheel.reference_angle
        - wheel.pitch * float(np.mean([run.lead for run in runs])),
        tooth_share=float(np.mean([run.tooth_share for run in runs])),
    )
    kinds = min(len(run.edges) for run in runs)
    record = EdgeRecord(source, [run.edges[:kinds] for run in runs], wheel)
    return record, Recording(len(runs), replace(shown, teeth=wheel.teeth), 1.0 / spacing)


def _runs(crossings: Crossings) -> list[Crossings]:
    """Crossings of each run of a record."""
    return [
        Crossings(crossings.times[part], crossings.rising[part], crossings.slopes[part])
        for part in runs_of(crossings.times)
    ]


def _common(patterns: Sequence[tuple[str, ToothPattern]]) -> ToothPattern:
    """Tooth pattern that all runs show, of pairs of run name and pattern; InputError if two differ.

    A run without a recurring mark agrees with any.
    """
    whole = [one for one in patterns if one[1].teeth is not None] or patterns[:1]
    field, shown = whole[0]
    for other, pattern in whole[1:]:
        if pattern != shown:
            limit = f"as {field}, which shows {shown.words}"
            raise InputError(other, f"a wheel {pattern.words}", limit)
    return shown
