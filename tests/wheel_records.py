"""Times of edges of a wheel with pitch errors on an engine of known torque, by integration.

The equation of motion of a slider-crank mechanism, I omega' omega + omega^2 I'/2 = T, is integrated
by Runge-Kutta steps over the crank angle, with closed forms of inertia and gas torque.
"""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

CYCLE = 4.0 * np.pi
RADIUS, ROD, MASS, AREA = 0.021, 0.073, 0.185, 2.83e-3  # Honda GX120
INERTIA = 0.0139
STEPS = 1440  # a cycle


class Wheel(NamedTuple):
    """Teeth, missing ones, edges a tooth, and pitch errors (kinds, teeth), rad."""

    teeth: int
    missing: int
    edges: int
    errors: np.ndarray


def wheel(teeth, missing, edges, seed, rms=0.05):
    rng = np.random.default_rng(seed)
    errors = np.radians(rms) * rng.standard_normal((edges, teeth - missing))
    return Wheel(teeth, missing, edges, errors)


def travel_rate(theta):
    """dx/dtheta of the piston, m/rad."""
    ratio = RADIUS / ROD
    swing = np.sqrt(1.0 - (ratio * np.sin(theta)) ** 2)
    return RADIUS * np.sin(theta) * (1.0 + ratio * np.cos(theta) / swing)


def gas_torque(theta, heat=3.0, intake=40e3, ambient=101.3e3):
    """Torque of polytropic compression and expansion, N m; firing dead centre at 360 deg.

    The heat of combustion, released over 50 deg, multiplies the pressure by up to 1 + `heat`.
    """
    at = np.mod(theta, CYCLE)
    ratio = RADIUS / ROD
    height = RADIUS * (1.0 - np.cos(at)) + ROD * (1.0 - np.sqrt(1.0 - (ratio * np.sin(at)) ** 2))
    clearance = 2.0 * RADIUS / 7.5
    closed = intake * ((clearance + 2.0 * RADIUS) / (clearance + height)) ** 1.3
    share = np.clip((at - 2.0 * np.pi + 0.25) / np.radians(50.0), 0.0, 1.0)
    closed = closed * (1.0 + heat * share**2 * (3.0 - 2.0 * share))
    pressure = np.where(at < np.pi, intake, np.where(at < 3.0 * np.pi, closed, ambient))
    return (pressure - ambient) * AREA * travel_rate(at)


def motion(torque, mean_speed, cycles=1, drag=0.0):
    """Crank angle (rad), speed (rad/s), its slope and time (s) at each step.

    Parameters
    ----------
    torque : function   N m, of the crank angle; a load balances its mean
    mean_speed : float  rad/s; about it at the start where `drag`, N m, slows the crank down
    """
    half = np.arange(2 * STEPS) * (CYCLE / STEPS / 2)
    values = torque(half)
    values = values - values.mean() - drag
    rate = travel_rate(half)
    inertia = INERTIA + MASS * rate**2
    step = 1e-6
    slope = MASS * (travel_rate(half + step) ** 2 - travel_rate(half - step) ** 2) / (2.0 * step)

    def run(start, count):
        size, speed, time = CYCLE / STEPS, start, 0.0
        speeds, times = [start], [0.0]
        force, mass, change = (list(map(float, part)) for part in (values, inertia, slope))

        def accelerated(k, w):
            k %= 2 * STEPS
            return (force[k] - 0.5 * w * w * change[k]) / (mass[k] * w)

        for n in range(count * STEPS):
            k = 2 * n
            a = accelerated(k, speed)
            b = accelerated(k + 1, speed + 0.5 * size * a)
            c = accelerated(k + 1, speed + 0.5 * size * b)
            d = accelerated(k + 2, speed + size * c)
            after = speed + size / 6.0 * (a + 2.0 * b + 2.0 * c + d)
            middle = 0.5 * (speed + after) + size / 8.0 * (a - accelerated(k + 2, after))
            time += size / 6.0 * (1.0 / speed + 4.0 / middle + 1.0 / after)
            speed = after
            speeds.append(speed)
            times.append(time)
        return np.array(speeds), np.array(times)

    start = mean_speed
    for _ in range(8):
        _, times = run(start, 1)
        start *= mean_speed / (CYCLE / times[-1])
    speeds, times = run(start, cycles)
    angle = np.arange(speeds.size) * (CYCLE / STEPS)
    place = np.mod(2 * np.arange(speeds.size), 2 * STEPS)
    slopes = (values[place] - 0.5 * speeds**2 * slope[place]) / (inertia[place] * speeds)
    return angle, speeds, slopes, times


def edge_times(moved, made, cycles, noise, seed, first_turn=0):
    """Times (s) of the edges of a wheel that pass in some cycles, with noise (rad).

    The motion of one cycle recurs; the record begins with tooth 0 of turn `first_turn`.
    """
    angle, speeds, _, times = moved
    passed = CubicHermiteSpline(angle, times, 1.0 / speeds)
    pitch = 2.0 * np.pi / made.teeth
    place = np.arange(2 * made.teeth * cycles + 1) + made.teeth * first_turn
    tooth = np.mod(place, made.teeth)
    place, tooth = (
        place[tooth < made.teeth - made.missing],
        tooth[tooth < made.teeth - made.missing],
    )
    at = np.stack([
        (place + 0.5 * kind) * pitch + made.errors[kind][tooth] for kind in range(made.edges)
    ])  # fmt: skip
    at = at.T.ravel()
    span = angle[-1]
    turn = np.floor(at / span) if np.isclose(span, CYCLE) else np.zeros_like(at)
    rng = np.random.default_rng(seed)
    jitter = noise / speeds.mean() * rng.standard_normal(at.size)
    return turn * times[-1] + passed(at - turn * span) + jitter
