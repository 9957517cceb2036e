"""Edge times from the voltage of a variable-reluctance pick-up."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In
from camwright.pipeline.engine.speed_file import WheelTable, speed_of_record
from camwright.pipeline.engine.speed_trace import Filter, SpeedTrace
from camwright.pipeline.engine.trace_file import columns_of, trace_text
from camwright.pipeline.engine.trigger_wheel import Edges, TriggerWheel, tooth_places
from camwright.pipeline.engine.wheel_calibration import Calibrator, EdgeRecord

THRESHOLD = 0.25  # of the usual peak, exceeded on both sides of a crossing
SAMPLES_PER_TOOTH_MIN = 6.0


@dataclass(frozen=True, kw_only=True)
class VoltageTable(WheelTable):
    """Voltage of a variable-reluctance pick-up at the trigger wheel, from a file."""

    kind: Literal["voltage"] = "voltage"
    threshold: Annotated[float, In(above=0, below=1)] = THRESHOLD


@dataclass(frozen=True, eq=False)
class Crossings:
    """Times of zero crossings of a voltage, s (n,), and whether it rises there."""

    times: Array
    rising: NDArray[np.bool_]


def zero_crossings(time: ArrayLike, voltage: ArrayLike, threshold: float = THRESHOLD) -> Crossings:
    """Zero crossings of an alternating voltage, by straight lines between the samples.

    A crossing counts if the voltage exceeds the threshold before and after it, with opposite
    signs; of several changes of sign in between, caused by noise, the mean of the first and the
    last is taken. In a gap of the wheel the voltage is near zero, and nothing counts.

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
    at, volts = finite("time", time), finite("voltage", voltage)
    if at.shape != volts.shape or at.ndim != 1 or at.size < 16:
        raise InputError("voltage", volts.shape, "as many values as times, 16 or more")
    if not (np.diff(at) > 0.0).all():
        k = int(np.flatnonzero(~(np.diff(at) > 0.0))[0]) + 1
        raise InputError(f"time, sample {k + 1}", f"{at[k]:.9g} s", f"after {at[k - 1]:.9g} s")
    if not 0.0 < threshold < 1.0:
        raise InputError("engine.threshold", threshold, "from 0 to 1")
    value = volts - float(np.median(volts))  # the mean would shift with an incomplete cycle
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
    """Time of the zero crossing between two samples on either side of it, s."""
    part = value[start : end + 1]
    signs = np.where(part >= 0.0, 1.0, -1.0)
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    crossings = []
    for k in (int(changes[0]), int(changes[-1])):
        low, high = part[k], part[k + 1]
        share = low / (low - high)
        crossings.append(time[start + k] + share * (time[start + k + 1] - time[start + k]))
    return float(0.5 * (crossings[0] + crossings[1]))


def edges_from_voltage(
    field: str,
    time: ArrayLike,
    voltage: ArrayLike,
    wheel: TriggerWheel,
    threshold: float = THRESHOLD,
) -> tuple[Edges, ...]:
    """Edges that passed a pick-up, both kinds, with the places of their teeth.

    The falling crossings, which are steep, are the middles of the teeth and are counted;
    `wheel.reference_angle` is that of the middle of the first tooth after the gap. Rising ones
    are the middles between teeth; those in the gap of the wheel are left out.

    Raises
    ------
    InputError
        As `zero_crossings` and `tooth_places`; if the sampling is too coarse for the teeth.
    """
    at = finite("time", time)
    crossings = zero_crossings(at, voltage, threshold)
    falling, rising = ~crossings.rising, crossings.rising
    middles, between = crossings.times[falling], crossings.times[rising]
    places = tooth_places(field, middles, wheel)
    spacing = float(np.median(np.diff(at)))
    per_tooth = float(np.median(np.diff(middles))) / spacing
    if per_tooth < SAMPLES_PER_TOOTH_MIN:
        limit = f"{SAMPLES_PER_TOOTH_MIN:g} or more"
        raise InputError(field, f"{per_tooth:.3g} samples per tooth", limit)
    edges = [Edges(middles, places, False)]
    # Rising crossings within a single pitch, half a pitch before their tooth.
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
    calibrator: Calibrator | None = None,
) -> SpeedTrace:
    """Crank speed from a CSV file of time and voltage; every voltage column is a run.

    Parameters
    ----------
    calibrator : Calibrator   None: a wheel without pitch errors

    Raises
    ------
    InputError
        As `edges_from_voltages` and `speed_of_record`.
    """

    def read(file: str | Path) -> EdgeRecord:
        return edges_from_voltages(file, wheel, threshold)

    return speed_of_record(read(path), band, calibrator, read)


def edges_from_voltages(
    path: str | Path, wheel: TriggerWheel, threshold: float = THRESHOLD
) -> EdgeRecord:
    """Edges from a CSV file of time and voltage; every voltage column is a run.

    Raises
    ------
    InputError
        As `read_trace` and `edges_from_voltage`.
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
    return EdgeRecord(text.name, runs, wheel)
