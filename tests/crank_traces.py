"""Tooth times and pick-up voltages of a crank whose motion is known."""

import numpy as np

CYCLE = 4.0 * np.pi


def time_at(speed, angle):
    """Time (s) at crank angles (rad, any turn) of a speed given at equal angles of the cycle."""
    spectrum = np.fft.rfft(1.0 / speed) / speed.size
    order = np.arange(1, 61) * 0.5
    wave = (np.exp(1j * np.outer(angle, order)) - 1.0) @ (spectrum[1:61] / (1j * order))
    return spectrum[0].real * angle + 2.0 * wave.real


def tooth_angles(teeth, missing, edges, cycles):
    """Crank angles of the edges that pass from 0 on, one more than fills the cycles."""
    pitch = 2.0 * np.pi / teeth
    places = np.arange(2 * teeth * cycles + 1)
    places = places[np.mod(places, teeth) < teeth - missing]
    if edges == 1:
        return places * pitch
    return (np.repeat(places, 2) + np.tile([0.0, 0.5], places.size)) * pitch


def noisy_times(speed, angles, noise, seed, pitch):
    """Times with a jitter that gives each tooth's speed a standard deviation (rad/s)."""
    jitter = noise * pitch / speed.mean() ** 2 / np.sqrt(2.0)
    rng = np.random.default_rng(seed)
    return time_at(speed, angles) + rng.normal(0.0, jitter, angles.size)


def voltage(speed, teeth, missing, cycles, sample=2e-5, noise=0.0, seed=1):
    """Time and voltage of a variable-reluctance pick-up, tooth middles from angle 0 on."""
    angle = np.linspace(0.0, cycles * CYCLE, 40_000 * cycles)
    passed = time_at(speed, angle)
    time = np.arange(0.0, passed[-1], sample)
    at = np.interp(time, passed, angle)
    place = at * teeth / (2.0 * np.pi)
    wave = np.zeros_like(at)
    for near in (-1, 0, 1):
        tooth = np.round(place) + near
        off = place - tooth
        wave -= np.where(np.mod(tooth, teeth) < teeth - missing, 8 * off, 0) * np.exp(-16 * off**2)
    knots = np.arange(speed.size + 1) * CYCLE / speed.size
    local = np.interp(np.mod(at, CYCLE), knots, np.append(speed, speed[0]))
    rng = np.random.default_rng(seed)
    return time, 3.0 * wave * local / speed.mean() + rng.normal(0.0, noise, time.size)
