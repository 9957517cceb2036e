"""Trace files as a test bench would record them, from a modelled engine."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.periodic_spline import periodic_cubic
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.indicated_cycle import CylinderCycle
from camwright.pipeline.engine.trigger_wheel import TriggerWheel
from camwright.pipeline.torque.torque import Torque

ANGLE_STEP = 2  # deg, of torque and pressure
SAMPLE = 5e-5  # s, of the voltage: 20 kHz
PEAK = 3.0  # V
TOOTH_WIDTH = 0.18  # of the pitch, standard deviation of the bell of flux over a tooth


def torque_text(torque: Torque) -> str:
    """Trace file of torque over the crank angle of a cycle, for `read_trace`."""
    degrees = np.arange(0.0, 720.0, ANGLE_STEP)
    return _text("crank_angle_deg,torque_Nm", "%d,%.3f", degrees, torque.total[::ANGLE_STEP])


def pressure_text(cycle: CylinderCycle) -> str:
    """Trace file of cylinder pressure over the crank angle of a cycle, for `pressure_from_csv`."""
    degrees = np.arange(0.0, 720.0, ANGLE_STEP)
    return _text("crank_angle_deg,pressure_Pa", "%d,%.0f", degrees, cycle.pressure[::ANGLE_STEP])


def tooth_times_text(speed: Array, wheel: TriggerWheel) -> str:
    """Trace file of rising and falling edge times of a cycle, for `speed_from_csv`.

    Parameters
    ----------
    speed : array (n,)     rad/s at equal crank angles over a cycle, from 0
    wheel : TriggerWheel   the record begins with the tooth at its reference
    """
    places = np.arange(2.0 * wheel.teeth + 1.0)
    places = places[np.mod(places, wheel.teeth) < wheel.present]
    edges = np.stack([wheel.angle(places, falling=False), wheel.angle(places, falling=True)])
    times = passing_times(speed, edges.T.ravel())
    return _text("time_s", "%.9f", times - times[0])


def voltage_text(speed: Array, wheel: TriggerWheel) -> str:
    """Trace file of a variable-reluctance pick-up's voltage over a cycle, for `speed_from_voltage`.

    Parameters
    ----------
    speed : array (n,)     rad/s at equal crank angles over a cycle, from 0
    wheel : TriggerWheel   the record begins half a pitch before the tooth at its reference
    """
    times, volts = pickup_voltage(speed, wheel)
    return _text("time_s,voltage_V", "%.6f,%.4f", times, volts)


def pickup_voltage(
    speed: Array,
    wheel: TriggerWheel,
    *,
    cycles: int = 1,
    sample: float = SAMPLE,
    pitch_errors: Array | None = None,
) -> tuple[Array, Array]:
    """Times (n,), s, and voltages (n,), V, of a variable-reluctance pick-up over a periodic cycle.

    The flux rises by a bell over each tooth, and the voltage is its rate: it falls through zero in
    the middle of a tooth, in proportion to the speed.

    Parameters
    ----------
    speed : array (n,)          rad/s at equal crank angles over a cycle, from 0
    wheel : TriggerWheel        the record begins half a pitch before the tooth at its reference
    cycles : int                recorded, with one tooth more
    sample : float              s, between two values
    pitch_errors : array (teeth,)   rad, of the middles of the teeth; None: none
    """
    places = np.linspace(
        -0.5, 2.0 * cycles * wheel.teeth + 1.5, 128 * (cycles * wheel.teeth + 1) + 1
    )
    fine = wheel.reference_angle + wheel.pitch * places
    passed = passing_times(speed, fine)
    times = np.arange(passed[0], passed[-1], sample)
    angle = np.interp(times, passed, fine)
    place = (angle - wheel.reference_angle) / wheel.pitch
    tooth = np.round(place) + np.array([[-1.0], [0.0], [1.0]])
    off = place - tooth
    if pitch_errors is not None:
        off = off - pitch_errors[np.mod(tooth, wheel.teeth).astype(int)] / wheel.pitch
    off = off / TOOTH_WIDTH
    bells = np.where(np.mod(tooth, wheel.teeth) < wheel.present, -off * np.exp(-0.5 * off**2), 0.0)
    local = periodic_cubic(speed)(angle * (FULL_TURN / CYCLE_ANGLE)) / speed.mean()
    volts = PEAK * np.exp(0.5) * local * bells.sum(axis=0)
    return times - times[0], volts


def passing_times(speed: Array, angle: Array) -> Array:
    """Times, s, at which the crank passes given angles, rad; 0 at angle 0.

    Parameters
    ----------
    speed : array (n,)   rad/s at equal crank angles over a cycle, from 0, n >= 12
    """
    slowness, cycle = periodic_cubic(1.0 / speed).antiderivative()
    turns = CYCLE_ANGLE / FULL_TURN
    count = np.floor(angle / CYCLE_ANGLE)
    return np.asarray(turns * (count * cycle + slowness((angle - count * CYCLE_ANGLE) / turns)))


def _text(header: str, row: str, *columns: Array) -> str:
    rows = (row % values for values in zip(*columns, strict=True))
    return "\n".join([header, *rows, ""])
