"""Voltages of pick-ups on a crank with a known torque, made without the code under test.

Torque of a crank drive with compression, combustion and friction; speed by the energy integral on
a fine grid; time by the integral of the slowness; teeth as bells of flux; voltage as the rate of
the flux, then what amplifiers and converters make of it.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import CubicSpline

from camwright.pipeline.engine.pickup_voltage import VoltageTable, edges_of_signals
from camwright.pipeline.engine.speed_trace import speed_from_edges

TURN = 2.0 * np.pi
SHAPES = ("clean", "clipped", "clipped on one side", "squared", "one-sided", "negative half")
WHEELS = {"36-1": (36, 1, 0), "60-2": (60, 2, 0), "4+1": (4, 0, 1)}


@dataclass(frozen=True)
class PickupRecord:
    """A synthetic record: time (s), voltages (V) of each run, and what made them."""

    time: np.ndarray
    volts: np.ndarray
    wheel: tuple[int, int, int]
    shape: str
    inertia: float
    theta: np.ndarray
    torque: np.ndarray  # about its mean, on a fine grid over the cycle
    reference: float  # crank angle of the first tooth after the mark of the wheel, rad

    def torque_at(self, theta):
        knots = np.append(self.theta, 2.0 * TURN)
        return CubicSpline(knots, np.append(self.torque, self.torque[0]), bc_type="periodic")(
            np.mod(theta, 2.0 * TURN)
        )


def gas_torque(theta, rng):
    """Torque of one cylinder, N m, from a polytropic cycle with a burn; firing at 2 pi."""
    ratio, rod = rng.uniform(7.0, 12.0), rng.uniform(3.0, 4.0)
    bore, radius = rng.uniform(0.05, 0.09), rng.uniform(0.02, 0.04)
    sine = np.sin(theta) / rod
    x = 1.0 - np.cos(theta) + rod * (1.0 - np.sqrt(1.0 - sine**2))
    slope = np.sin(theta) * (1.0 + np.cos(theta) / np.sqrt(rod**2 - np.sin(theta) ** 2))
    volume = 2.0 / (ratio - 1.0) + x
    start = 2.0 / (ratio - 1.0) + 2.0
    burnt = 0.5 * (1.0 + np.tanh((theta - TURN - 0.25) / rng.uniform(0.3, 0.45)))
    inlet = rng.uniform(0.4e5, 1.0e5)
    peak = inlet * (start / volume) ** 1.32 * (1.0 + rng.uniform(1.0, 2.5) * burnt)
    fade = (
        0.25
        * (1.0 + np.tanh((theta - 1.25 * np.pi) / 0.3))
        * (1.0 - np.tanh((theta - 2.75 * np.pi) / 0.3))
    )
    pressure = 1e5 + fade * (peak - 1e5)
    return 0.25 * np.pi * bore**2 * radius * (pressure - 1e5) * slope


def smooth_torque(theta, rng):
    """Torque of a slow machine, N m: four harmonics of the cycle that fall off fast."""
    torque = np.zeros_like(theta)
    for order, size in enumerate((1.0, 0.4, 0.05, 0.005), start=1):
        torque += 20.0 * size * np.cos(0.5 * order * theta - rng.uniform(0.0, TURN))
    return torque


def pickup_record(seed, wheel=None, shape=None, runs=None, drift=True, noise=True):
    """One seeded record; noise 20 dB below the signal, an offset and a drift of the voltage."""
    rng = np.random.default_rng(seed)
    name = wheel or list(WHEELS)[seed % 3]
    teeth, missing, extra = WHEELS[name]
    shape = shape or SHAPES[(seed // 3) % len(SHAPES)]
    grid = np.linspace(0.0, 2.0 * TURN, 14_401)
    torque = gas_torque(grid, rng) if teeth > 8 else smooth_torque(grid, rng)
    torque -= np.trapezoid(torque, grid) / (2.0 * TURN)
    work = cumulative_trapezoid(torque, grid, initial=0.0)
    mean = rng.uniform(100.0, 250.0)
    # the flywheel leaves a ripple of 2 to 8 % from lowest to highest
    inertia = np.ptp(work) / (mean**2 * rng.uniform(0.02, 0.08))
    speed = np.sqrt(mean**2 + 2.0 * (work - work.mean()) / inertia)
    count = int(rng.integers(4, 9))
    elapsed = cumulative_trapezoid(1.0 / speed, grid, initial=0.0)
    all_angle = np.concatenate([grid[:-1] + 2.0 * TURN * k for k in range(count)])
    all_time = np.concatenate([elapsed[:-1] + elapsed[-1] * k for k in range(count)])
    angle_of = CubicSpline(all_time, all_angle)
    per_tooth = rng.uniform(24.0, 50.0) if teeth > 8 else rng.uniform(150.0, 400.0)
    sample = TURN / teeth / mean / per_tooth
    begin = all_time[-1] * rng.uniform(0.0, 0.02)
    time = np.arange(begin, all_time[-1], sample)
    angle = angle_of(time)
    pitch = TURN / teeth
    width = rng.uniform(0.16, 0.22) if teeth > 8 else rng.uniform(0.05, 0.08)
    start = rng.uniform(0.0, pitch)
    at = start + pitch * np.arange(teeth - missing)
    if extra:
        at = np.sort(np.append(at, start + pitch * (2.0 + rng.uniform(0.4, 0.6))))
    rate = np.zeros_like(angle)
    for middle in at:
        off = (np.mod(angle - middle + np.pi, TURN) - np.pi) / (width * pitch)
        rate -= off * np.exp(0.5 - 0.5 * off**2)
    amplitude = rng.uniform(0.5, 5.0)
    pure = amplitude * rate * CubicSpline(grid, speed)(np.mod(angle, 2.0 * TURN)) / mean
    volts = []
    for _ in range(runs or int(rng.integers(1, 4))):
        signal = pure + (
            rng.normal(0.0, 0.1 * np.sqrt((pure**2).mean()), pure.size) if noise else 0.0
        )
        signal = _shaped(signal, shape, amplitude, rng)
        if drift:
            slow = np.sin(TURN * rng.uniform(0.2, 0.8) * np.linspace(0, 1, time.size) + seed)
            signal = signal + amplitude * (rng.uniform(-2.0, 2.0) + 0.1 * slow)
        volts.append(signal)
    return PickupRecord(
        time,
        np.array(volts),
        WHEELS[name],
        shape,
        inertia,
        grid[:-1],
        torque[:-1],
        start + 3.0 * pitch if extra else start,
    )


def _shaped(signal, shape, amplitude, rng):
    if shape == "clipped":
        return np.clip(signal, -0.4 * amplitude, 0.4 * amplitude)
    if shape == "clipped on one side":
        return np.minimum(signal, 0.5 * amplitude)
    if shape == "squared":  # a comparator at zero, armed a third of the amplitude beyond
        beyond = np.where(np.abs(signal) > 0.33 * amplitude, np.sign(signal), 0.0)
        last = np.maximum.accumulate(np.where(beyond != 0.0, np.arange(signal.size), 0))
        state, output = 1.0, np.empty(signal.size)
        for k, (armed, value) in enumerate(zip(beyond[last], signal, strict=True)):
            if armed * value < 0.0 and state == armed:
                state = -armed
            elif armed * value > 0.0 and abs(value) > 0.33 * amplitude:
                state = armed
            output[k] = state
        return 2.5 * amplitude * output
    if shape == "one-sided":
        return np.maximum(signal, 0.0)
    if shape == "negative half":
        return np.minimum(signal, 0.0)
    return signal


def speed_of(record):
    """Speed in a record; three harmonics are what four teeth can show."""
    table = VoltageTable(file="record.csv", harmonics=3 if record.wheel[2] else 20)
    runs = {f"run {k}": volts for k, volts in enumerate(record.volts)}
    return speed_of_signals(record.time, runs, table)


def speed_of_signals(time, signals, table):
    """Speed in voltages by name."""
    edges, recording = edges_of_signals("record", time, signals, table)
    return replace(speed_from_edges(*edges, table.band).with_firing(), recording=recording)


def error_and_bar(record, trace):
    """Error of the torque and its bar, N m, at equal crank angles from the first tooth after the
    mark; a wheel on the crank leaves the turn of the cycle open where both are much alike."""
    torque = trace.torque(record.inertia)
    both = [np.abs(torque.total - record.torque_at(torque.theta + record.reference + turn))
            for turn in (0.0, TURN)]  # fmt: skip
    return min(both, key=np.max), torque.error_bar
