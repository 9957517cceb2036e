"""Measured crank speed, and the torque that follows from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, Count, FileName, In, Part, Share
from camwright.pipeline.engine.angle_trace import guard_order, guard_span, without_end
from camwright.pipeline.engine.band_fit import (
    SHARE_MAX,
    fitted,
    integrals,
    observation_noise,
    points,
    shared_edges,
)
from camwright.pipeline.engine.crankshaft import SpeedStatistics, speed_statistics, torque_of_motion
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.torque import SAMPLES, Torque, uniform_cycle
from camwright.pipeline.engine.torque_error_bar import SlopeNoise
from camwright.pipeline.engine.trace_file import (
    QUANTITY_UNITS,
    HeaderText,
    TraceText,
    angle_column,
    columns_of,
    has_angle,
    trace_text,
)
from camwright.pipeline.engine.trigger_wheel import (
    Edges,
    MissingTeeth,
    Teeth,
    ToothShare,
    TriggerWheel,
    counted,
    learned_wheel,
)

HARMONICS = 20  # of the cycle, 10 per crank turn: least error at a noise of 0.2 rad/s
TAPER = 0.25
SPEED_RANGE = (5.0, 3000.0)  # rad/s, of a crank


Harmonics = Annotated[int, Count(1, SAMPLES // 4)]


@dataclass(frozen=True)
class Filter(Part):
    """Harmonics of the cycle kept of a speed, with a cosine edge from 1 - taper to 1 + taper.

    Parameters
    ----------
    harmonics : int    at the middle of the edge, the bandwidth; 2 are one per crank turn
    taper : float      half-width of the edge as a share; 0: a sharp edge

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    table: ClassVar[str] = "engine"

    harmonics: Harmonics = HARMONICS
    taper: Share = TAPER

    @property
    def last(self) -> int:
        """The highest harmonic that is not zero."""
        return int(np.floor(self.harmonics * (1.0 + self.taper) + 1e-9))

    @property
    def weights(self) -> Array:
        """Factor on harmonics 0 to `last`."""
        share = np.arange(self.last + 1) / self.harmonics
        if self.taper == 0.0:
            return np.ones_like(share)
        edge = np.clip((share - 1.0) / self.taper, -1.0, 1.0)
        return np.asarray(0.5 * (1.0 - np.sin(0.5 * pi * edge)))

    def bandwidth(self, mean_speed: float) -> float:
        """Frequency (Hz) at which the filter lets one half pass, at a crank speed (rad/s)."""
        return self.harmonics * mean_speed / CYCLE_ANGLE


@dataclass(frozen=True, kw_only=True)
class WheelTable(Part):
    """A measurement at a trigger wheel from a file: the wheel and the filter of the speed.

    Raises
    ------
    InputError
        As `TriggerWheel`.
    """

    table: ClassVar[str] = "engine"

    file: FileName
    teeth: Teeth = 36
    missing_teeth: MissingTeeth = 0
    reference_angle: Angle = 0.0
    harmonics: Harmonics = HARMONICS
    taper: Share = TAPER

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.wheel  # refuses too many missing teeth

    @property
    def wheel(self) -> TriggerWheel:
        return TriggerWheel(self.teeth, self.missing_teeth, self.reference_angle)

    @property
    def band(self) -> Filter:
        """Filter of the speed."""
        return Filter(self.harmonics, self.taper)


@dataclass(frozen=True, kw_only=True)
class SpeedTable(WheelTable):
    """Crank speed from a file: tooth times, or speed per tooth against crank angle."""

    kind: Literal["speed"] = "speed"
    column: HeaderText = ""
    speed_unit: HeaderText = ""
    edges: Annotated[int, Count(1, 2)] = 2
    tooth_share: ToothShare = 0.5
    averaged_over: Annotated[float, In("deg", at_least=0, at_most=60)] = 0.0
    reference_file: FileName | None = None

    @property
    def wheel(self) -> TriggerWheel:
        return replace(super().wheel, tooth_share=self.tooth_share)


@dataclass(frozen=True, eq=False)
class SpeedTrace:
    """Band-limited crank speed over a cycle, of several cycles or runs.

    Parameters
    ----------
    source : str               name of the file
    speeds : array (m, 720)    rad/s at equal crank angles, of each cycle of each run
    filter : Filter
    noise : float              rad/s, standard deviation of one tooth's speed about the curve
    slope_noise : SlopeNoise   what `noise` makes of domega/dtheta
    """

    source: str
    speeds: Array
    filter: Filter
    noise: float
    slope_noise: SlopeNoise

    def __post_init__(self) -> None:
        speeds = finite(f"{self.source} speed", self.speeds)
        low, high = SPEED_RANGE
        if not low <= float(speeds.min()) <= float(speeds.max()) <= high:
            worst = float(speeds.min() if speeds.min() < low else speeds.max())
            limit = f"from {low:g} to {high:g} rad/s; check unit, teeth and edges"
            raise InputError(f"{self.source} speed", f"{worst:.4g} rad/s", limit)
        freeze(self, speeds=speeds)

    @property
    def theta(self) -> Array:
        return uniform_cycle(self.speeds.shape[1])

    @property
    def count(self) -> int:
        """Cycles averaged."""
        return int(self.speeds.shape[0])

    @property
    def mean(self) -> Array:
        """Mean over the cycles at each angle, rad/s."""
        return np.asarray(self.speeds.mean(axis=0))

    @property
    def scatter(self) -> Array:
        """Standard deviation over the cycles at each angle, rad/s; zero for one cycle."""
        if self.count < 2:
            return np.zeros(self.speeds.shape[1])
        return np.asarray(self.speeds.std(axis=0, ddof=1))

    @property
    def statistics(self) -> SpeedStatistics:
        return speed_statistics(self.mean)

    @property
    def bandwidth(self) -> float:
        """Bandwidth of the speed, Hz."""
        return self.filter.bandwidth(self.statistics.mean)

    def noise_amplification(self, inertia: float) -> float:
        """Torque noise of one cycle per speed noise of one tooth, N m per rad/s."""
        return inertia * self.statistics.mean * self.slope_noise.mean_gain

    def noise_floor(self, inertia: float) -> float:
        """Standard deviation of the torque of the mean cycle due to noise, N m."""
        return self.noise_amplification(inertia) * self.noise / float(np.sqrt(self.count))

    def error_bar(self, inertia: float) -> Array:
        """Half-width (n,) of the band that holds the torque at all angles at once, N m, 95 %.

        It is that of noise and scatter of the cycles within the bandwidth; the inertia (kg m2) is
        taken as exact.
        """
        slopes = np.array([torque_of_motion(speed, 1.0) / speed for speed in self.speeds])
        return inertia * self.mean * self.slope_noise.half_width(slopes, self.noise)

    def torque(self, inertia: float) -> Torque:
        """J omega domega/dtheta of the mean speed, its one component `measured`.

        That is the torque of gas, friction and load about its mean, with the inertia torque of the
        reciprocating masses.

        Parameters
        ----------
        inertia : float    J, kg m2, of all parts that turn with the crank, > 0
        """
        if not 0.0 < inertia < np.inf:
            raise InputError("engine.inertia", inertia, "> 0 kg m^2")
        parts = {"measured": torque_of_motion(self.mean, inertia)}
        return Torque(self.theta, parts, error_bar=self.error_bar(inertia))

    def with_firing(self) -> SpeedTrace:
        """The trace with the expansion of each cycle in its second crank turn.

        A trigger wheel on the crank does not distinguish the two turns of a cycle: the one in which
        the speed rises more after its middle has the expansion.
        """
        energy = self.speeds**2
        quarter = self.speeds.shape[1] // 4
        fired = energy[:, 3 * quarter] - energy[:, 2 * quarter]
        turned = np.roll(self.speeds, 2 * quarter, axis=1)
        right = fired >= energy[:, quarter] - energy[:, 0]
        return replace(self, speeds=np.where(right[:, None], self.speeds, turned))


def speed_from_edges(
    source: str, runs: Sequence[Sequence[Edges]], wheel: TriggerWheel, band: Filter
) -> SpeedTrace:
    """Speed from the times of edges.

    The slowness 1/omega is a band-limited series over the cycle whose integral from edge to edge
    of one kind is the time between them, by least squares. Neither the width of a tooth nor the
    length of an interval, a gap included, distorts the speed.

    Parameters
    ----------
    runs : sequence of runs    each the edges of `counted`
    wheel : TriggerWheel
    band : Filter

    Raises
    ------
    InputError
        If no run holds a whole cycle, or the teeth are too few for the filter.
    """
    starts, ends, times = _cycles_of(source, runs, wheel)
    width = ends - starts
    matrix = integrals(starts, ends, band.last)
    jitter = shared_edges(starts, ends) / np.sqrt(2.0)
    _guard_unknowns(source, matrix, band)
    fit, slope_noise = fitted(matrix, band.weights, jitter, width.mean())
    slowness = times @ fit.T
    if not slowness.min() > 0.0:
        raise InputError(f"{source} speed", "below zero", "edges in order; check teeth and edges")
    mean_speed = float(width.sum() / times.sum(axis=1).mean())
    noise = observation_noise(times, matrix, jitter) / width.mean() * mean_speed**2
    return SpeedTrace(source, 1.0 / slowness, band, noise, slope_noise)


def speed_from_teeth(
    source: str, angle: ArrayLike, speeds: ArrayLike, band: Filter, width: float = 0.0
) -> SpeedTrace:
    """Speed from its values at crank angles.

    Parameters
    ----------
    angle : array (n,)        rad, over one cycle
    speeds : array (m, n)     rad/s, a row per cycle or run
    band : Filter
    width : float             rad, over which each value is a mean; 0: a point

    Raises
    ------
    InputError
        If a speed is not positive, or the values are too few for the filter.
    """
    at, values = finite(source, angle), positive(f"{source} speed", speeds, "rad/s")
    if not 0.0 <= width <= np.radians(60.0):
        raise InputError("engine.averaged_over", f"{np.degrees(width):g} deg", "from 0 to 60 deg")
    ends = at + 0.5 * width
    matrix = (
        integrals(at - 0.5 * width, ends, band.last) / width if width else points(at, band.last)
    )
    single = np.eye(at.size)
    _guard_unknowns(source, matrix, band)
    fit, slope_noise = fitted(matrix, band.weights, single, 1.0)
    noise = observation_noise(values, matrix, single)
    return SpeedTrace(source, values @ fit.T, band, noise, slope_noise)


def _guard_unknowns(source: str, matrix: Array, band: Filter) -> None:
    """Refuse a filter with too many harmonics for the intervals of a cycle."""
    if matrix.shape[1] > SHARE_MAX * matrix.shape[0]:
        most = int((0.5 * SHARE_MAX * matrix.shape[0] - 0.5) / (1.0 + band.taper))
        limit = f"<= {max(most, 1)} for {matrix.shape[0]} intervals in a cycle"
        raise InputError(f"{source}: engine.harmonics", band.harmonics, limit)


def _cycles_of(
    source: str, runs: Sequence[Sequence[Edges]], wheel: TriggerWheel
) -> tuple[Array, Array, Array]:
    """Intervals of the cycle, rad, (n,) and (n,), and their durations in each cycle, s, (m, n)."""
    durations: list[Array] = []
    spans: tuple[Array, Array] | None = None
    for run in runs:
        first = float(run[0].places[0])
        from_ = np.concatenate([wheel.angle(e.places[:-1], e.falling) for e in run])
        to = np.concatenate([wheel.angle(e.places[1:], e.falling) for e in run])
        times = np.concatenate([np.diff(edges.times) for edges in run])
        start = np.concatenate([edges.places[:-1] for edges in run])
        cycle = np.floor((start - first) / (2 * wheel.teeth))
        for k in range(int(cycle.max()) + 1):
            inside = cycle == k
            covered = float((to - from_)[inside].sum())
            if not np.isclose(covered, len(run) * CYCLE_ANGLE, rtol=0.0, atol=1e-6):
                continue  # the run begins or ends within the cycle
            begin = np.mod(from_[inside], CYCLE_ANGLE)
            order = np.argsort(begin, kind="stable")
            span = begin[order], begin[order] + (to - from_)[inside][order]
            if spans is None:
                spans = span
            elif span[0].shape != spans[0].shape or not np.allclose(span, spans, atol=1e-6):
                continue  # other edges, or a run with another start on the wheel
            durations.append(times[inside][order])
    if spans is None:
        held = max(sum(edges.times.size for edges in run) for run in runs)
        limit = f"a whole cycle, {len(runs[0]) * (2 * wheel.present + 1)} edges or more"
        raise InputError(source, f"{held} edges", limit)
    return spans[0], spans[1], np.array(durations)


def tooth_times(path: str | Path, column: str = "") -> tuple[str, Array]:
    """Times of edges from a CSV file, a column per run: array (runs, edges), s.

    Raises
    ------
    InputError
        As `read_trace`.
    """
    text = trace_text(Path(path), one_column=True)
    wanted = columns_of(text.header, "time", column)
    if not wanted:
        limit = f"a column of time with its unit ({', '.join(QUANTITY_UNITS['time'])})"
        raise InputError(f"{text.name} header", ", ".join(text.header), limit)
    table = text.numbers(tuple(wanted))
    return text.name, np.asarray((table * np.array(list(wanted.values()))).T)


def speed_from_csv(
    path: str | Path,
    wheel: TriggerWheel,
    band: Filter,
    *,
    both_edges: bool = True,
    column: str = "",
    unit: str = "",
    averaged_over: float = 0.0,
    reference: str | Path | None = None,
) -> SpeedTrace:
    """Crank speed from a CSV file: tooth times, or speed per tooth against crank angle.

    A file with a column of crank angle has speeds, a column per run; any other has the times of
    edges, a column per run. Without a gap the cycle begins with the record; the turn with the
    expansion follows from the speed.

    Parameters
    ----------
    wheel : TriggerWheel
    band : Filter
    both_edges : bool         times: every second edge is a falling one
    column : str              beginning of the headers of the columns to read
    unit : str                speeds: the unit of columns without one
    averaged_over : float     speeds: rad over which each is a mean
    reference : path          times: turns at steady speed, to learn the angles of the edges

    Raises
    ------
    InputError
        As `read_trace`, `counted` and `speed_from_edges`.
    """
    text = trace_text(Path(path), one_column=True)
    if has_angle(text.header):
        angle, speeds = _speed_table(text, column, unit)
        return speed_from_teeth(text.name, angle, speeds, band, averaged_over)
    if reference is not None:
        label, steady = tooth_times(reference)
        known = [counted(f"{label} run {k + 1}", run, wheel, both_edges)
                 for k, run in enumerate(steady)]  # fmt: skip
        wheel = learned_wheel(wheel, known)
    name, runs = tooth_times(path, column)
    edges = [counted(f"{name} run {k + 1}", run, wheel, both_edges) for k, run in enumerate(runs)]
    return speed_from_edges(name, edges, wheel, band).with_firing()


def _speed_table(text: TraceText, column: str, unit: str) -> tuple[Array, Array]:
    """Angles (n,), rad, and speeds (m, n), rad/s, of one cycle."""
    name, header = text.name, text.header
    at, factor = angle_column(name, header)
    wanted = columns_of(header, "speed", column)
    known = ", ".join(QUANTITY_UNITS["speed"])
    if unit:
        if unit not in QUANTITY_UNITS["speed"]:
            raise InputError("engine.speed_unit", unit, f"one of {known}")
        bare = [k for k, head in enumerate(header) if head.lower().startswith(column.lower())]
        wanted = {k: QUANTITY_UNITS["speed"][unit] for k in bare if k != at} | wanted
    if not wanted:
        limit = f"a column of speed with its unit ({known}), or of time"
        raise InputError(f"{name} header", ", ".join(header), limit)
    table = text.numbers((at, *wanted))
    guard_order(name, text.line_numbers, table[:, 0], header[at])
    angle, values = table[:, 0] * factor, table[:, 1:] * np.array(list(wanted.values()))
    guard_span(name, angle, factor, CYCLE_ANGLE)
    angle, values = without_end(angle, values, CYCLE_ANGLE)
    return angle, np.asarray(values.T)
