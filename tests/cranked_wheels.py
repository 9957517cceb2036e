"""Edges and voltages of trigger wheels with gaps on cranks of known motion, made without the code
under test.

Cranking: gas torque of one cylinder against compression, speed by the energy integral on a fine
grid, times by the integral of the slowness. Conditioned pick-up: one sine over each pitch or gap,
through zero at the middles of the teeth, cut softly at 4 V and by a diode at -0.7 V.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

TURN = 2.0 * np.pi
WHEELS = {
    "8-1": (8, 1, (7,)),
    "12-1": (12, 1, (11,)),
    "24-2": (24, 2, (22,)),
    "36-1": (36, 1, (35,)),
    "60-2": (60, 2, (58,)),
    "36-2-2-2": (36, 2, (16, 1, 13)),
    "24-1-1": (24, 1, (17, 5)),
}


@dataclass(frozen=True)
class Motion:
    """Crank angle (rad), torque about its mean (N m) and time (s) over one cycle, steady."""

    angle: np.ndarray
    torque: np.ndarray
    time: np.ndarray
    inertia: float

    def time_at(self, angle):
        cycle, rest = np.divmod(angle, 2.0 * TURN)
        return cycle * self.time[-1] + np.interp(rest, self.angle, self.time)

    def angle_at(self, time):
        cycle, rest = np.divmod(time, self.time[-1])
        return cycle * 2.0 * TURN + np.interp(rest, self.time, self.angle)

    def torque_at(self, angle):
        return np.interp(np.mod(angle, 2.0 * TURN), self.angle, self.torque)


def motion(torque, mean, swing):
    """Motion under a torque, by function of the angle; `swing` is that of the energy over its
    mean."""
    angle = np.linspace(0.0, 2.0 * TURN, 72_001)
    values = torque(angle)
    values = values - np.trapezoid(values, angle) / (2.0 * TURN)
    work = cumulative_trapezoid(values, angle, initial=0.0)
    inertia = np.ptp(work) / (swing * 0.5 * mean**2)
    speed = np.sqrt(mean**2 + 2.0 * (work - work.mean()) / inertia)
    return Motion(angle, values, cumulative_trapezoid(1.0 / speed, angle, initial=0.0), inertia)


def cranking(angle):
    """Torque of compression and expansion of one cylinder of 70 mm stroke, unfired, N m."""
    radius, rod, area, ratio = 0.035, 0.115, 0.25 * np.pi * 0.075**2, 9.0
    travel = radius * (1.0 - np.cos(angle)) + rod
    travel = travel - np.sqrt(rod**2 - (radius * np.sin(angle)) ** 2)
    slope = np.gradient(travel, angle)
    volume = travel + 2.0 * radius / (ratio - 1.0)
    start = np.interp(np.radians(220.0), angle, volume)
    closed = (angle > np.radians(220.0)) & (angle < np.radians(500.0))
    pressure = np.where(closed, 1e5 * (start / volume) ** 1.3 - 1e5, 0.0)
    return pressure * area * slope


def tooth_middles(name, turns):
    """Angles of the middles of the teeth, in pitches from the first one of the longest row."""
    teeth, missing, rows = WHEELS[name]
    places, at = [], 0
    for row in rows:
        places += range(at, at + row)
        at += row + missing
    return np.add.outer(np.arange(turns) * teeth, np.array(places)).ravel()


def edge_times(made, name, reference, cycles, noise=0.0, seed=0, both=True):
    """Times of the edges of teeth half a pitch wide, s, the first of a rising edge; noise in
    pitches."""
    pitch = TURN / WHEELS[name][0]
    middles = tooth_middles(name, 2 * cycles) * pitch + reference + 0.25 * pitch
    edges = np.stack([middles - 0.25 * pitch, middles + 0.25 * pitch])
    edges += np.random.default_rng(seed).normal(0.0, noise * pitch, edges.shape)
    return made.time_at(edges.T.ravel() if both else edges[0])


def conditioned_voltage(made, name, cycles, seed, noise=0.004, sample=1e-5):
    """Time (s) and voltage (V) of a pick-up whose voltage rises at the middles of the teeth, the
    first of which stands at crank angle 0."""
    teeth = WHEELS[name][0]
    time = np.arange(0.0, cycles * made.time[-1] * 1.01, sample)
    place = np.mod(made.angle_at(time) * teeth / TURN, teeth)
    known = tooth_middles(name, 1)
    last = np.searchsorted(known, place, side="right") - 1
    length = np.diff(np.append(known, teeth))[last]
    wave = np.sin(TURN * (place - known[last]) / length)
    size = np.where(length > 1, 1.1, 1.0)
    high = 4.0 * (1.0 - np.exp(-size * np.maximum(wave, 0.0) / 0.12)) * (1.0 + 0.15 * size * wave)
    low = -0.73 * (1.0 - np.exp(np.minimum(wave, 0.0) / 0.02))
    volts = np.where(wave > 0.0, high, low)
    return time, volts + np.random.default_rng(seed).normal(0.0, noise, time.size)
