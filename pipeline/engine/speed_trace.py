"""Band-limited crank speed from measured edge times, and its torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, median, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Count, Meaning, Part, Share
from camwright.pipeline.engine.band_fit import (
    SHARE_MAX,
    fitted,
    integrals,
    observation_noise,
    points,
    remaining_band,
    shared_edges,
)
from camwright.pipeline.engine.crankshaft import SpeedStatistics, speed_statistics, torque_of_motion
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.pitch_errors import PitchErrors
from camwright.pipeline.engine.tooth_pattern import Recording
from camwright.pipeline.engine.torque_error_bar import SlopeNoise, cut_off
from camwright.pipeline.engine.trigger_wheel import (
    Edges,
    TriggerWheel,
)
from camwright.pipeline.engine.wheel_calibration import (
    Calibration,
)
from camwright.pipeline.torque.torque import SAMPLES, Torque, uniform_cycle

HARMONICS = 20  # of the cycle, 10 per crank turn: least error at a noise of 0.2 rad/s
TAPER = 0.25
TAPERED = Meaning("half-width of the cosine edge of the filter, as a share of its harmonics")
SPEED_RANGE = (5.0, 3000.0)  # rad/s, of a crank


Harmonics = Annotated[int, Count(1, SAMPLES // 4)]


@dataclass(frozen=True)
class Filter(Part):
    """Low-pass filter over harmonics of the cycle, cosine edge from 1 - taper to 1 + taper.

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
        """Highest harmonic of non-zero gain."""
        return int(np.floor(self.harmonics * (1.0 + self.taper) + 1e-9))

    @property
    def weights(self) -> Array:
        """Factors (last + 1,) by which the low-pass filter multiplies harmonics 0 to `last` of the
        cycle: 1, then a cosine flank to 0 centred on the bandwidth.
        """
        share = np.arange(self.last + 1) / self.harmonics
        if self.taper == 0.0:
            return np.ones_like(share)
        edge = np.clip((share - 1.0) / self.taper, -1.0, 1.0)
        return np.asarray(0.5 * (1.0 - np.sin(0.5 * pi * edge)))

    def bandwidth(self, mean_speed: float) -> float:
        """Cut-off frequency (Hz) of half gain, at a crank speed (rad/s)."""
        return self.harmonics * mean_speed / CYCLE_ANGLE


@dataclass(frozen=True, eq=False)
class SpeedTrace:
    """Band-limited crank speed over the cycle, of one or more cycles or runs.

    Parameters
    ----------
    source : str               name of the file
    speeds : array (m, 720)    rad/s at equal crank angles, of each cycle of each run
    filter : Filter
    noise : float              rad/s, standard deviation of one tooth's speed about the curve
    slope_noise : SlopeNoise   what `noise` makes of domega/dtheta
    wheel_band : array (720,)  rad/s per rad, half-width of the 95 % band about domega/dtheta that
                               the pitch errors of the wheel leave, noise apart; None: no wheel
    calibration : Calibration  None: pitch errors not considered
    recording : Recording      None: speeds against crank angle
    """

    source: str
    speeds: Array
    filter: Filter
    noise: float
    slope_noise: SlopeNoise
    wheel_band: Array | None = None
    calibration: Calibration | None = None
    recording: Recording | None = None

    def __post_init__(self) -> None:
        """Refuse speeds that are not finite or out of the range of engines; the arrays become
        read-only.
        """
        speeds = finite(f"{self.source} speed", self.speeds)
        low, high = SPEED_RANGE
        if not low <= float(speeds.min()) <= float(speeds.max()) <= high:
            worst = float(speeds.min() if speeds.min() < low else speeds.max())
            limit = f"from {low:g} to {high:g} rad/s; check unit, teeth and edges"
            raise InputError(f"{self.source} speed", f"{worst:.4g} rad/s", limit)
        freeze(self, speeds=speeds)
        if self.wheel_band is not None:
            freeze(self, wheel_band=self.wheel_band)

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
        """Half-width (n,) of the simultaneous 95 % band of the torque over all angles, N m.

        It adds what the filter cuts off to the root of the squares of noise and scatter of the
        cycles within the bandwidth and of the pitch errors of the wheel; the inertia (kg m2) is
        taken as exact.
        """
        slopes = np.array([torque_of_motion(speed, 1.0) / speed for speed in self.speeds])
        noise = inertia * self.mean * self.slope_noise.half_width(slopes, self.noise)
        random = np.hypot(noise, self.wheel_bar(inertia))
        return np.asarray(random + self.cut_off(inertia))

    def cut_off(self, inertia: float) -> float:
        """Estimated greatest torque of the harmonics above the filter, N m."""
        floor = self.noise_floor(inertia)
        return cut_off(self.speeds, self.filter.weights, inertia, floor)

    def wheel_bar(self, inertia: float) -> Array:
        """The part of the pitch errors of the wheel in `error_bar` (n,), N m."""
        if self.wheel_band is None:
            return np.zeros(self.speeds.shape[1])
        return np.asarray(inertia * self.mean * self.wheel_band)

    @property
    def half_order_share(self) -> float:
        """Share of the half orders, by which the two turns of a cycle differ, in the variance of
        the speed: (1 - r) / 2 with the correlation r of the two turns.
        """
        ripple = self.mean - self.mean.mean()
        unlike = 0.5 * (ripple - np.roll(ripple, ripple.size // 2))
        whole = float(ripple.var())
        return float(unlike.var()) / whole if whole > 0.0 else 0.0

    def torque(self, inertia: float) -> Torque:
        """Torque J omega domega/dtheta of the mean speed; its one component is `measured`.

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
        """Trace with the expansion of each cycle in its second crank turn.

        A trigger wheel on the crank does not distinguish the two turns of a cycle: the one in which
        the speed rises more after its middle has the expansion. All cycles are first brought to
        the turn in which they resemble the others.
        """
        half = self.speeds.shape[1] // 2
        means = self.speeds.mean(axis=1, keepdims=True)
        ripple = self.speeds - means
        alike = ripple[0]
        for _ in range(2):
            turned = np.roll(ripple, half, axis=1)
            ripple = np.where((ripple @ alike >= turned @ alike)[:, None], ripple, turned)
            alike = ripple.mean(axis=0)
        speeds = ripple + means
        energy = (speeds**2).mean(axis=0)
        quarter = half // 2
        fired = energy[3 * quarter] - energy[half] >= energy[quarter] - energy[0]
        return replace(self, speeds=speeds if fired else np.roll(speeds, half, axis=1))


def speed_from_edges(
    source: str,
    runs: Sequence[Sequence[Edges]],
    wheel: TriggerWheel,
    band: Filter,
    errors: PitchErrors | None = None,
) -> SpeedTrace:
    """Band-limited crank speed over the cycle from edge times.

    The slowness 1/omega is a band-limited series over the cycle whose integral from edge to edge of
    one kind is the time between them, by least squares. Neither the width of a tooth nor the length
    of an interval, a gap included, distorts the speed.

    Parameters
    ----------
    source : str              name of the record
    runs : sequence of runs   each the edges of `counted`
    wheel : TriggerWheel      angles of the edges
    band : Filter             of the slowness
    errors : PitchErrors      corrected; what remains of them is in the error bar; None: a wheel
                              without errors

    Raises
    ------
    InputError
        If no run holds a whole cycle, the teeth are too few for the filter, or the slowness is not
        positive.
    """
    if errors is not None:
        wheel = errors.corrected(wheel)
    starts, ends, bounds, times = _cycles_of(source, runs, wheel)
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
    remaining = None
    if errors is not None:
        late = np.zeros((width.size, 2 * errors.errors.size))
        late[np.arange(width.size), bounds[1]] += mean_speed
        late[np.arange(width.size), bounds[0]] -= mean_speed
        remaining = remaining_band(matrix, band.weights, late, errors)
    return SpeedTrace(source, 1.0 / slowness, band, noise, slope_noise, remaining)


def speed_from_teeth(
    source: str,
    angle: ArrayLike,
    speeds: ArrayLike,
    band: Filter,
    width: float = 0.0,
    tolerance: float = 0.0,
) -> SpeedTrace:
    """Band-limited crank speed over the cycle from speeds at crank angles, by least squares.

    Parameters
    ----------
    source : str            name of the record
    angle : array (n,)      rad, over one cycle
    speeds : array (m, n)   rad/s, a row per cycle or run
    band : Filter           of the speed
    width : float           rad, over which each value is a mean; 0: a point
    tolerance : float       rad, standard deviation of the place of an edge, if each value is a
                            pitch over its time

    Raises
    ------
    InputError
        If a speed is not positive, the width is above 60 deg, or the values are too few for the
        filter.
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
    pitch = median(np.diff(at))
    teeth = max(round(FULL_TURN / pitch), 1)
    tooth = np.mod(np.round((at - at[0]) / pitch), teeth).astype(int)
    late = np.zeros((at.size, 2 * teeth))
    late[np.arange(at.size), np.mod(tooth + 1, teeth)] += values.mean() / pitch
    late[np.arange(at.size), tooth] -= values.mean() / pitch
    errors = PitchErrors.unknown(teeth, tolerance)
    remaining = remaining_band(matrix, band.weights, late, errors)
    return SpeedTrace(source, values @ fit.T, band, noise, slope_noise, remaining,
                      Calibration(errors))  # fmt: skip


def _guard_unknowns(source: str, matrix: Array, band: Filter) -> None:
    """Refuse a filter whose harmonics have more unknowns than `SHARE_MAX` of the intervals of a
    cycle.

    Parameters
    ----------
    source : str            name of the record, for the message
    matrix : array (n, u)   from u unknowns to n intervals
    band : Filter           with its harmonics
    """
    if matrix.shape[1] > SHARE_MAX * matrix.shape[0]:
        most = int((0.5 * SHARE_MAX * matrix.shape[0] - 0.5) / (1.0 + band.taper))
        limit = f"<= {max(most, 1)} for {matrix.shape[0]} intervals in a cycle"
        raise InputError(f"{source}: engine.harmonics", band.harmonics, limit)


def _cycles_of(
    source: str, runs: Sequence[Sequence[Edges]], wheel: TriggerWheel
) -> tuple[Array, Array, NDArray[np.intp], Array]:
    """Intervals between edges of one kind in the whole cycles of a record: start and end, rad, (n,)
    each; numbers of the two edges, in both turns, (2, n); durations, s, (m, n), a row per cycle.

    Cycles whose intervals differ from those of the first are left out.

    Parameters
    ----------
    source : str              name of the record, for messages
    runs : sequence of runs   each the edges of `counted`
    wheel : TriggerWheel      angles of the edges

    Raises
    ------
    InputError
        If no run holds a whole cycle.
    """
    durations: list[Array] = []
    spans: tuple[Array, Array] | None = None
    edges = len(runs[0]) * wheel.present
    for run in runs:
        first = float(run[0].places[0])
        from_ = np.concatenate([wheel.angle(e.places[:-1], e.falling) for e in run])
        to = np.concatenate([wheel.angle(e.places[1:], e.falling) for e in run])
        times = np.concatenate([np.diff(e.times) for e in run])
        start = np.concatenate([e.places[:-1] for e in run])
        turn = [np.mod(e.places // wheel.teeth, 2.0).astype(np.intp) for e in run]
        each = [e.numbers(wheel) + edges * t for e, t in zip(run, turn, strict=True)]
        passed = np.hstack([np.stack([one[:-1], one[1:]]) for one in each])
        cycle = np.floor((start - first) / (2 * wheel.teeth))
        for k in range(int(cycle.max()) + 1):
            inside = cycle == k
            covered = float((to - from_)[inside].sum())
            if not np.isclose(covered, len(run) * CYCLE_ANGLE, rtol=0.0, atol=1e-6):
                continue  # the run begins or ends within the cycle
            begin = np.mod(from_[inside] + 1e-6, CYCLE_ANGLE) - 1e-6  # round-off at the origin
            order = np.argsort(begin, kind="stable")
            span = begin[order], begin[order] + (to - from_)[inside][order]
            if spans is None:
                spans, bounds = span, passed[:, inside][:, order]
            elif span[0].shape != spans[0].shape or not np.allclose(span, spans, atol=1e-6):
                continue  # other edges, or a run with another start on the wheel
            durations.append(times[inside][order])
    if spans is None:
        held = max(sum(edges.times.size for edges in run) for run in runs)
        limit = f"a whole cycle, {len(runs[0]) * (2 * wheel.present + 1)} edges or more"
        raise InputError(source, f"{held} edges", limit)
    return spans[0], spans[1], bounds, np.array(durations)
