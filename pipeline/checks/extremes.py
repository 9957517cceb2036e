"""Extreme values over the turns of all load cases, with their load case and cam angle."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Literal, NamedTuple, Protocol, Self, TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from camwright.geometry import extrema
from camwright.geometry.arrays import FULL_TURN, Array, greatest_of
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import TIE, first_greatest, first_least
from camwright.geometry.second_track import CamDisc
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solved_cam import ContourCam, SolvedCam


class Extreme(NamedTuple):
    """Extreme value with its load case and cam angle.

    Parameters
    ----------
    value : float
    load_case : str        "": none
    cam_angle : float      rad; None: none
    error_share : float    sampling error of the extreme over its value
    """

    value: float
    load_case: str = ""
    cam_angle: float | None = None
    error_share: float = 0.0


NOWHERE = Extreme(np.nan)
_LEAST_SAMPLES = 5  # samples, for the bends on either side of a peak
_KINK_SHARPNESS = 3.0  # second difference at a kink over those two samples away; 1 on a parabola
_VERTEX_SAFETY = 1.25  # on the vertex of the parabola: bound of the sampling error


def cycle_of(cycles: Iterable[Cycle], worst: Extreme) -> Cycle:
    """Cycle of the load case of an extreme; the first cycle without a load case."""
    every = tuple(cycles)
    return next((each for each in every if each.load_case == worst.load_case), every[0])


def row_of(cycles: Iterable[Cycle], worst: Extreme) -> tuple[Cycle, int]:
    """Cycle of an extreme, and the index of its solved angle."""
    cycle = cycle_of(cycles, worst)
    return cycle, first_least(np.abs(cycle.theta - (worst.cam_angle or 0.0)))


class _Tracked(Protocol):
    """A cycle or cam, which may be seen from the track that bears less, as one of its own kind."""

    @property
    def on_other_track(self) -> Self | None: ...


Seen = TypeVar("Seen", bound=_Tracked)


def on_both_tracks(seen: Seen, measure: Callable[[Seen], Array]) -> Array:
    """Measure (..., n) of a cycle or cam, of preloaded discs the greater of both tracks at each cam
    angle: a smaller roller may be pressed harder by less force. NaN where either is.
    """
    here, other = measure(seen), seen.on_other_track
    if other is None:
        return here
    return greatest_of(here, measure(other))


def pressed_row(
    cycles: Iterable[Cycle], worst: Extreme, measure: Callable[[Cycle], Array]
) -> tuple[Cycle, int, bool]:
    """Cycle of an extreme of `on_both_tracks` seen from its track, index of its solved angle, and
    whether that is the track that bears less.
    """
    cycle, k = row_of(cycles, worst)
    other = cycle.on_other_track
    if other is None or not measure(other)[k] > measure(cycle)[k]:
        return cycle, k, False
    return other, k, True


def tracks_of(cycles: Iterable[Cycle]) -> list[Cycle]:
    """The cycles, of preloaded discs also seen from the track that bears less."""
    both = ((each, each.on_other_track) for each in cycles)
    return [track for pair in both for track in pair if track is not None]


def greatest(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """Greatest value over all load cases and angles; NaN if any is.

    Parameters
    ----------
    measure : callable   cycle -> array (n,), by cam angle
    """
    return _extreme(cycles, measure, 1.0)


def least(cycles: Iterable[Cycle], measure: Callable[[Cycle], Array]) -> Extreme:
    """Least value over all load cases and angles; NaN if any is."""
    return _extreme(cycles, measure, -1.0)


def _vertex(cycles: Sequence[Cycle], measure: Callable[[Cycle], Array], sign: float) -> Extreme:
    """Greatest (sign 1) or least (-1) value of a measure of forces over the load cases, by a
    parabola between the solved angles; see `sampled_peak`.
    """
    values = {cycle.load_case: measure(cycle) for cycle in cycles}
    worst = _extreme(cycles, lambda cycle: values[cycle.load_case], sign)
    if worst.cam_angle is None:
        return worst
    peak = extrema.sampled_peak(sign * values[worst.load_case])
    return worst._replace(value=sign * peak.value, cam_angle=peak.theta)


def lasting(cycles: Iterable[Cycle]) -> list[Cycle]:
    """Cycles with a share of the operating time, those of unknown duty included."""
    return [cycle for cycle in cycles if cycle.machine.duty is None or cycle.machine.duty > 0.0]


def steady(solution: Solution) -> list[Cycle]:
    """Cycles of the case's own load cases: in standstill and over-speed nothing warms up."""
    declared = {state.name for state in solution.case.load_cases}
    return [cycle for cycle in solution.cycles if cycle.load_case in declared]


def fired(solution: Solution) -> list[Cycle]:
    """Cycles of the fired load cases, where the machine has a power."""
    states = {
        state.name: state for state in solution.case.load_cases if state.fired and state.speed > 0
    }
    cycles = [cycle for cycle in solution.cycles if cycle.load_case in states]
    return [
        cycle
        for cycle in cycles
        if cycle.turn.throughput is not None or states[cycle.load_case].power is not None
    ]


def worst_case(
    cycles: Iterable[Cycle],
    measure: Callable[[Cycle], float],
    *,
    at_least: bool = False,
    integral: bool = True,
) -> Extreme:
    """Greatest (or least) over the load cases of one value per turn; NaN if any is.

    The error of an integral over the turn is the grid convergence index of two meshes at the second
    order, 3 |f1 - f2|/(r^2 - 1): against every second and every third position, the greater. One
    alone can coincide with the full turn by its phase.

    Parameters
    ----------
    measure : callable   cycle -> value
    integral : bool      False: a residual or a value without quadrature, of no such error

    References
    ----------
    Roache (1998), sec. 5.6; ASME V&V 20-2009, sec. 2-4.
    """

    def values(cycle: Cycle) -> Array:
        return np.array([measure(cycle)])

    def error(cycle: Cycle, value: float) -> float:
        """Grid convergence index of the value of a load case with respect to coarser turns."""
        if not integral:
            return 0.0
        coarse = {step: measure(each) for step, each in cycle.thinned.items()}
        return max(_convergence_index(value, each, step) for step, each in coarse.items())

    return _extreme(cycles, values, -1.0 if at_least else 1.0, error)


def over_duty(
    cycles: Iterable[Cycle], measure: Callable[[Cycle], float], *, life: bool = False
) -> Extreme:
    """Duty-weighted mean of one value per turn; lives combine by their damage.

    A mean rate is sum q_i r_i, a life 1/sum(q_i/L_i), q_i: share of the operating time of a load
    case; those of zero do not count. Without a duty the worst load case. The load case is that of
    the greatest share of wear or damage; the error is that of `worst_case`.

    Parameters
    ----------
    measure : callable   cycle -> rate >= 0, or life > 0

    References
    ----------
    Palmgren (1924), Miner (1945): shares of life add up; ISO 281:2007, 5 for varying load.
    """
    turns = tuple(cycles)
    if any(cycle.machine.duty is None for cycle in turns):
        return worst_case(turns, measure, at_least=life)
    running = lasting(turns)
    if not running:
        return NOWHERE
    parts = duty_parts(running, measure, life=life)
    value = _in_all(parts, life)
    most = list(parts)[first_greatest(list(parts.values()))]
    error = 0.0
    if all(cycle.error_bars for cycle in running):
        steps = set.intersection(*(set(cycle.thinned) for cycle in running))
        for step in steps:
            coarse = duty_parts([cycle.thinned[step] for cycle in running], measure, life=life)
            error = max(error, _convergence_index(value, _in_all(coarse, life), step))
    return Extreme(value, most, None, error)


def duty_parts(
    cycles: Iterable[Cycle], measure: Callable[[Cycle], float], *, life: bool = False
) -> dict[str, float]:
    """Contributions of the load cases, by name, to the wear or damage per time: duty times
    `measure`, a wear rate, or with `life` duty over `measure`, a life. Load cases without a duty
    are left out.
    """
    parts = {}
    for cycle in cycles:
        duty = cycle.machine.duty
        if duty:
            value = measure(cycle)
            parts[cycle.load_case] = duty / value if life else duty * value
    return parts


def _in_all(parts: Mapping[str, float], life: bool) -> float:
    """Rate or life of all load cases from their contributions by name, as of `duty_parts`.

    The rate is their sum, in the unit of the contributions; the life, with `life`, is the inverse
    of the summed damage per time, s, infinite where there is none.
    """
    total = sum(parts.values())
    if not life:
        return total
    return 1.0 / total if total != 0.0 else np.inf


def _convergence_index(value: float, coarse: float, ratio: int) -> float:
    """Relative grid convergence index of a value on two meshes whose element sizes have a ratio, at
    order 2.
    """
    if value == coarse or np.isnan(value):
        return 0.0
    change = abs(coarse - value) / abs(value) if value != 0.0 else np.inf
    return np.inf if np.isnan(change) else float(3.0 * change / (ratio**2 - 1.0))


def _extreme(
    cycles: Iterable[Cycle],
    measure: Callable[[Cycle], Array],
    sign: float,
    error: Callable[[Cycle, float], float] | None = None,
) -> Extreme:
    """Greatest (sign 1) or least (-1) value of a measure (n,) over the load cases: with its cam
    angle and sampling error or, given `error`, without angle and with the error that this gives for
    a value of a turn. NaN, where there is one.
    """
    extreme, at = NOWHERE, None
    for cycle in cycles:
        values = np.asarray(measure(cycle), dtype=float)
        signed = sign * values
        value = sign * float(signed.max())
        if extreme.load_case and not (math.isnan(value) or _beyond(value, extreme.value, sign)):
            continue
        # the first NaN, where there is one
        theta = FULL_TURN * first_greatest(signed) / values.size if error is None else None
        share = _sampling_error(values, sign) if error is None and cycle.error_bars else 0.0
        extreme, at = Extreme(value, cycle.load_case, theta, share), cycle
    if error is None or at is None or not at.error_bars:
        return extreme
    return extreme._replace(error_share=error(at, extreme.value))


def _beyond(value: float, other: float, sign: float) -> bool:
    """Whether a value is greater than another, or less at sign -1, and not equal within `TIE`."""
    tie = TIE * abs(other) if math.isfinite(other) else 0.0
    return sign * value > sign * other + tie


def _sampling_error(values: Array, sign: float) -> float:
    """Relative sampling error of the greatest of values (n,) at equal angles, or of the least at
    sign -1: greatest value between the samples less the greatest sample.

    At a smooth peak the vertex of the parabola through three samples, with the safety factor 1.25;
    at a kink or a jump the lines through the two samples on either side, up to their crossing.
    Every peak counts: another than that of the greatest sample may be the greatest.
    """
    finite = np.isfinite(values)
    if values.size < _LEAST_SAMPLES or not finite.any() or np.isnan(values).any():
        return 0.0
    # an infinite value, such as a ratio without load, has no peak beside it
    peaks = np.where(finite, sign * values, 0.0)
    before, after = np.roll(peaks, 1), np.roll(peaks, -1)
    second = before - 2.0 * peaks + after
    vertex = np.divide(
        (after - before) ** 2, -8.0 * second, out=np.zeros_like(peaks), where=second < 0.0
    )
    above = _VERTEX_SAFETY * vertex
    for way in (1, -1):
        rise, fall = peaks - np.roll(peaks, way), np.roll(peaks, -way) - np.roll(peaks, -2 * way)
        drop = peaks - np.roll(peaks, -way)
        part = np.divide(fall - drop, rise + fall, out=np.ones_like(peaks), where=rise + fall > 0.0)
        line = np.maximum(rise, 0.0) * np.where(part < 0.0, 1.0, np.minimum(part, 1.0))
        sharp = np.abs(second) + np.abs(np.roll(second, -way))
        outer = np.abs(np.roll(second, 2)) + np.abs(np.roll(second, -2))
        above = np.where(sharp > _KINK_SHARPNESS * outer, np.maximum(above, line), above)
    beside = np.all([np.roll(finite, shift) for shift in (-2, -1, 0, 1, 2)], axis=0)
    peaked = (peaks >= before) & (peaks >= after) & beside
    top = float(peaks[finite].max())
    error = float(np.max(np.where(peaked, peaks + above, top))) - top
    return error / abs(top) if top != 0.0 else 0.0


Reduce = Literal["case", "contour", "top", "angles", "forces", "mean", "wear", "life"]
"""How a measure is reduced over the cam.

case: a figure of the numbers alone; contour: extreme on the unloaded contour, refined between
samples; top: at maximum lift; angles: extreme of all load cases at the solved angles; forces: the
same between them, of the forces alone; mean: over the turn, of the worst load case; wear: the same,
over the load cases by their duty; life: mean damage over the turn, whose lives are summed by the
duty.
"""
BY_DUTY: tuple[Reduce, ...] = ("wear", "life")
"""Reductions over the load cases by their duty."""
Measure = Callable[[LoadedCam], Array]
"""Loaded cam -> measure by cam angle (..., n), real or complex; never reduced over the angles."""
_OF_CONTOURS: WeakKeyDictionary[Contour, dict[tuple[Measure, bool], Extreme]] = WeakKeyDictionary()
_OF_CYCLES: WeakKeyDictionary[Solution, dict[tuple[Measure, Reduce, bool], Extreme]] = (
    WeakKeyDictionary()
)


def worst_measure(
    solution: Solution,
    measure: Measure,
    reduce: Reduce,
    value: Callable[[float], float],
    *,
    at_least: bool,
    order: int,
) -> Extreme:
    """Demand from the worst value of a measure over a solution; NaN if any is.

    The extreme of a contour is kept with it, as checks of the same measure and tolerance corners
    share it: such a measure reads the motion alone.

    Parameters
    ----------
    value : callable  worst measure -> demand
    at_least : bool   the least measure is the worst
    order : int       highest derivative of the lift in the measure of a contour, 2 or 3
    """

    def of_turn(cycle: Cycle) -> float:
        return value(mean_of(solution, measure, cycle))

    if reduce == "life":
        return over_duty(solution.cycles, of_turn, life=True)
    if reduce == "mean":
        return worst_case(solution.cycles, of_turn, at_least=at_least)
    worst = _worst(solution, measure, reduce, at_least=at_least, order=order)
    return worst._replace(value=value(worst.value))


def _worst(
    solution: Solution, measure: Measure, reduce: Reduce, *, at_least: bool, order: int
) -> Extreme:
    """Extreme of a measure, reduced over lift, contour or load cases as `reduce` says; order :
    highest derivative of the lift that it needs. Kept per contour or solution.
    """
    contour, numbers = solution.contour, solution.numbers
    if reduce in ("case", "top"):
        value = float(np.ravel(measure(ContourCam.at_top(contour, numbers)))[0])
        top = np.mod(contour.lift.highest.theta, FULL_TURN)
        return Extreme(value, "", None if reduce == "case" else float(top))
    if reduce == "contour":
        every = [
            _of_contour(disc, numbers, measure, at_least=at_least, order=order)
            for disc in solution.discs
        ]
        sign = -1.0 if at_least else 1.0
        return every[first_greatest([sign * each.value for each in every])]
    cached = _OF_CYCLES.setdefault(solution, {})
    if (key := (measure, reduce, at_least)) not in cached:
        cached[key] = _worst_of_cycles(solution, measure, reduce, at_least=at_least)
    return cached[key]


def _of_contour(
    disc: CamDisc, numbers: Numbers, measure: Measure, *, at_least: bool, order: int
) -> Extreme:
    """Extreme of a measure on the unloaded contour of a disc, at the cam angle of the first."""
    contour = disc.contour
    shapes = _OF_CONTOURS.setdefault(contour, {})
    if (shape := (measure, at_least)) not in shapes:
        refined = extrema.least if at_least else extrema.greatest
        found = refined(
            lambda theta: measure(ContourCam.at(contour, numbers, theta, order)),
            contour.lift.search_count,
        )
        shapes[shape] = Extreme(found.value, "", disc.angle(found.theta))
    return shapes[shape]


def _worst_of_cycles(
    solution: Solution, measure: Measure, reduce: Reduce, *, at_least: bool
) -> Extreme:
    """Extreme of a measure over the load cases: by their duty ("wear"), between the solved angles
    ("forces"), or at them.
    """
    cycles, sign = solution.cycles, -1.0 if at_least else 1.0
    if reduce == "wear":
        return over_duty(cycles, lambda cycle: mean_of(solution, measure, cycle))
    if reduce == "forces":
        return _vertex(cycles, lambda cycle: measure(solution.cams_between[cycle]), sign)
    return _extreme(cycles, lambda cycle: measure(solution.cams[cycle]), sign)


def mean_of(solution: Solution, measure: Measure, cycle: Cycle) -> float:
    """Mean of a measure over the turn of a solved cycle, or over some of its angles."""
    return float(np.mean(measure(cam_of(solution, cycle))))


def cam_of(solution: Solution, cycle: Cycle) -> SolvedCam:
    """Loaded cam of a solved cycle, or of some of its angles."""
    cam = solution.cams.get(cycle)
    return SolvedCam.of(cycle, solution.numbers) if cam is None else cam
