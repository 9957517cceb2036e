"""Raw voltage of a variable-reluctance pick-up: the moments at which edges passed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In
from camwright.pipeline.engine.speed_trace import Filter, SpeedTrace, WheelTable, speed_from_edges
from camwright.pipeline.engine.trace_file import columns_of, trace_text
from camwright.pipeline.engine.trigger_wheel import Edges, TriggerWheel, tooth_places

THRESHOLD = 0.25  # of the usual peak, which the voltage must pass on both sides of a crossing
SAMPLES_PER_TOOTH_MIN = 6.0


@dataclass(frozen=True, kw_only=True)
class VoltageTable(WheelTable):
    """Voltage of a variable-reluctance pick-up at the trigger wheel, from a file."""

    kind: Literal["voltage"] = "voltage"
    threshold: Annotated[float, In(above=0, below=1)] = THRESHOLD


@dataclass(frozen=True, eq=False)
class Crossings:
    """When a voltage crosses zero, s (n,), and whether it rises there."""

    times: Array
    rising: NDArray[np.bool_]


def zero_crossings(time: ArrayLike, voltage: ArrayLike, threshold: float = THRESHOLD) -> Crossings:
    """Zero crossings of an alternating voltage, by straight lines between the samples.

    A crossing counts where the voltage goes from beyond the threshold on one side to beyond it
    on the other; of several changes of sign in between, which noise makes, the mean of the first
    and the last is taken. So nothing counts in a gap of the wheel, where the voltage rests.

    Parameters
    ----------
    time : array (n,)       s, rising
    voltage : array (n,)    V
    threshold : float       share of the usual peak, the 90 % quantile of the magnitude

    Raises
    ------
    InputError
        If the times do not rise, or the voltage does not alternate.
    """
    at, given = finite("time", time), finite("voltage", voltage)
    if at.shape != given.shape or at.ndim != 1 or at.size < 16:
        raise InputError("voltage", given.shape, "as many values as times, 16 or more")
    if not (np.diff(at) > 0.0).all():
        k = int(np.flatnonzero(~(np.diff(at) > 0.0))[0]) + 1
        raise InputError(f"time, sample {k + 1}", f"{at[k]:.9g} s", f"after {at[k - 1]:.9g} s")
    if not 0.0 < threshold < 1.0:
        raise InputError("engine.threshold", threshold, "from 0 to 1")
    value = given - float(np.median(given))  # the mean would follow a cycle cut off half way
    bound = threshold * float(np.quantile(np.abs(value), 0.9))
    if not bound > 0.0:
        raise InputError("voltage", "constant", "an alternating voltage")
    beyond = np.flatnonzero(np.abs(value) > bound)
    side = np.sign(value[beyond])
    turn = np.flatnonzero(side[1:] != side[:-1])
    if turn.size < 2:
        raise InputError("voltage", f"{turn.size} crossings", "an alternating voltage")
    before, after = beyond[turn], beyond[turn + 1]
    moments = [_between(at, value, int(a), int(b)) for a, b in zip(before, after, strict=True)]
    return Crossings(np.array(moments), side[turn] < 0.0)


def _between(time: Array, value: Array, start: int, end: int) -> float:
    """Where the voltage crosses zero between two samples on either side of it, s."""
    part = value[start : end + 1]
    signs = np.where(part >= 0.0, 1.0, -1.0)
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    found = []
    for k in (int(changes[0]), int(changes[-1])):
        low, high = part[k], part[k + 1]
        share = low / (low - high)
        found.append(time[start + k] + share * (time[start + k + 1] - time[start + k]))
    return float(0.5 * (found[0] + found[1]))


def edges_from_voltage(
    field: str,
    time: ArrayLike,
    voltage: ArrayLike,
    wheel: TriggerWheel,
    threshold: float = THRESHOLD,
) -> tuple[Edges, ...]:
    """Edges that passed a pick-up, both kinds, missing teeth found.

    The falling crossings, steep ones, are the middles of the teeth and carry the count; so
    `wheel.reference_angle` is that of the middle of the first tooth after the gap. Rising ones
    are the middles of the gaps between teeth; in the wheel's gap there is none worth having.

    Raises
    ------
    InputError
        As `zero_crossings` and `tooth_places`; if the sampling is too coarse for the teeth.
    """
    at = finite("time", time)
    found = zero_crossings(at, voltage, threshold)
    middles, between = found.times[~found.rising], found.times[found.rising]
    places = tooth_places(field, middles, wheel)
    spacing = float(np.median(np.diff(at)))
    per_tooth = float(np.median(np.diff(middles))) / spacing
    if per_tooth < SAMPLES_PER_TOOTH_MIN:
        limit = f"{SAMPLES_PER_TOOTH_MIN:g} or more"
        raise InputError(field, f"{per_tooth:.3g} samples per tooth", limit)
    edges = [Edges(middles, places, False)]
    # Each rising crossing that lies in a single pitch, taken half a pitch before its tooth.
    index = np.searchsorted(middles, between)
    inside = (index > 0) & (index < middles.size)
    index, between = index[inside], between[inside]
    regular = places[index] - places[index - 1] == 1.0
    edges.append(Edges(between[regular], places[index - 1][regular], True))
    return tuple(edges)


def speed_from_voltage(
    path: str | Path,
    wheel: TriggerWheel,
    band: Filter,
    threshold: float = THRESHOLD,
) -> SpeedTrace:
    """Crank speed from a CSV file of time and voltage; each column of voltage is a run.

    Raises
    ------
    InputError
        As `read_trace`, `edges_from_voltage` and `speed_from_edges`.
    """
    text = trace_text(Path(path))
    times, volts = columns_of(text.header, "time"), columns_of(text.header, "voltage")
    if len(times) != 1 or not volts:
        limit = "one column of time (s, ms, us) and one or more of voltage (V, mV)"
        raise InputError(f"{text.name} header", ", ".join(text.header), limit)
    table = text.numbers((*times, *volts))
    at = table[:, 0] * next(iter(times.values()))
    runs = []
    for k, (column, factor) in enumerate(volts.items(), start=1):
        field = f"{text.name} {text.header[column]}"
        runs.append(edges_from_voltage(field, at, factor * table[:, k], wheel, threshold))
    return speed_from_edges(text.name, runs, wheel, band).with_firing()
