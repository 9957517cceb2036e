"""Ten runs at the trigger wheel of the paper, modelled: voltage of the pick-up, edges, speed.

Cardoso et al., Energies 18 (2025) 3256, print pictures of their runs and no data. The voltage of a
known speed is sampled and rounded as their oscilloscope does, and read as any measurement is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.engine.modelled_trace import pickup_voltage
from camwright.pipeline.engine.pickup_voltage import VoltageTable, edges_of_signals
from camwright.pipeline.engine.speed_trace import Filter, SpeedTrace, speed_from_edges
from camwright.pipeline.engine.trigger_wheel import Edges, TriggerWheel

RUNS = 10
CYCLES = 2  # whole ones in 10 divisions of 20 ms at 1500 rpm
SAMPLE = 2e-5  # s, 10 000 points in 200 ms
RESOLUTION = 16.0 / 256.0  # V, 8 divisions of 2 V by 8 bit
VOLTAGE_NOISE = 0.5 * RESOLUTION  # std, assumed
WHEEL = TriggerWheel(teeth=36)
TABLE = VoltageTable(file="modelled.csv", teeth=WHEEL.teeth)
RIG_SPEED = 157.08  # rad/s, 1500 rpm
SENSOR_STD = 0.22  # rad/s, of the mean of ten runs at constant speed, printed
COMBUSTION_SCATTER = 0.05  # std of the expansion torque from run to run, assumed
BAND = Filter()
_SEED = 2025


@dataclass(frozen=True, eq=False)
class TenRuns:
    """Ten runs of the same state.

    Parameters
    ----------
    time, voltage : array (n,)      of the first run, s and V
    edges : sequence of Edges       of the first run
    teeth : array (cycles, 72)      speed from tooth to tooth, rad/s, of each cycle of each run
    trace : SpeedTrace              band-limited speed of these cycles
    """

    time: Array
    voltage: Array
    edges: Sequence[Edges]
    teeth: Array
    trace: SpeedTrace

    def __post_init__(self) -> None:
        freeze(self, time=self.time, voltage=self.voltage, teeth=self.teeth)

    @property
    def tooth_angle(self) -> Array:
        """Crank angles (72,) of `teeth`, the middles of the intervals, deg."""
        return np.asarray(np.degrees(WHEEL.pitch) * (np.arange(self.teeth.shape[1]) + 0.5))

    @property
    def tooth_mean(self) -> Array:
        """Mean speed (72,) over the cycles, rad/s."""
        return np.asarray(self.teeth.mean(axis=0))


def pitch_errors() -> Array:
    """Errors (36,) of the middles of the teeth, rad, that explain the printed std of the sensor.

    The mean of ten runs keeps only what repeats, which is the wheel: the speed from tooth to
    tooth has the relative error of the pitch.
    """
    errors = np.random.default_rng(_SEED).normal(size=WHEEL.teeth)
    pitches = np.diff(np.append(errors, errors[0]))
    return np.asarray(errors * (SENSOR_STD / RIG_SPEED * WHEEL.pitch / pitches.std()))


def scattered(torque: Array) -> list[Array]:
    """Torques (n,) of ten runs, N m: the expansion from 360 to 540 deg scatters from run to run."""
    expansion = np.zeros(torque.size)
    expansion[torque.size // 2 : 3 * torque.size // 4] = COMBUSTION_SCATTER
    factors = np.random.default_rng(_SEED + 1).normal(size=RUNS)
    return [torque * (1.0 + factor * expansion) for factor in factors]


def ten_runs(speeds: Sequence[Array]) -> TenRuns:
    """The runs of given speeds, read from their voltages.

    Parameters
    ----------
    speeds : sequence of array (n,)   rad/s at equal crank angles over the cycle, one each run
    """
    errors, random = pitch_errors(), np.random.default_rng(_SEED + 2)
    records, runs, teeth = [], [], []
    for k, speed in enumerate(speeds, start=1):
        time, clean = pickup_voltage(
            speed, WHEEL, cycles=CYCLES, sample=SAMPLE, pitch_errors=errors
        )
        noisy = clean + VOLTAGE_NOISE * random.normal(size=clean.size)
        voltage = RESOLUTION * np.round(noisy / RESOLUTION)
        record, _ = edges_of_signals(f"run {k}", time, {f"run {k}": voltage}, TABLE)
        edges = record.runs[0]
        intervals = np.diff(edges[0].times)[: CYCLES * 2 * WHEEL.teeth]
        records.append((time, voltage))
        teeth.append((WHEEL.pitch / intervals).reshape(CYCLES, -1))
        runs.append(edges)
    trace = speed_from_edges("modelled runs", runs, WHEEL, BAND)
    return TenRuns(*records[0], runs[0], np.concatenate(teeth), trace)
