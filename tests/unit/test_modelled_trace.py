"""Trace files of a modelled engine, read back as a measurement is."""

import numpy as np
import pytest
from crank_traces import CYCLE, time_at

from camwright.pipeline.engine.crankshaft import speed_statistics
from camwright.pipeline.engine.engine_torque import torque_from_csv
from camwright.pipeline.engine.modelled_trace import (
    passing_times,
    tooth_times_text,
    torque_text,
    voltage_text,
)
from camwright.pipeline.engine.pickup_voltage import VoltageTable, speed_from_voltage
from camwright.pipeline.engine.speed_file import speed_from_csv
from camwright.pipeline.engine.speed_trace import Filter
from camwright.pipeline.engine.trigger_wheel import TriggerWheel
from camwright.pipeline.torque.torque import Torque, uniform_cycle

THETA = uniform_cycle(720)
SPEED = 151.0 - 5.0 * np.cos(THETA / 2 - 3.0) + 2.0 * np.sin(THETA)
WHEEL = TriggerWheel(teeth=36, missing_teeth=2)
VOLTAGE = VoltageTable(file="s.csv", harmonics=12)


def test_times_are_those_of_the_fourier_series_of_the_slowness():
    """The cubic through 720 values is exact to 1e-9 of a cycle for waves of 1 and 2 a cycle."""
    angle = np.linspace(-CYCLE, 3.0 * CYCLE, 101)
    np.testing.assert_allclose(passing_times(SPEED, angle), time_at(SPEED, angle), atol=1e-10)


def test_a_torque_is_read_back(tmp_path):
    torque = Torque(THETA, {"gas": 30.0 * np.sin(THETA), "friction": np.full(720, -1.0)})
    (tmp_path / "t.csv").write_text(torque_text(torque), encoding="utf-8")
    again = torque_from_csv(tmp_path / "t.csv").total
    # three decimals, and the makima spline between rows 2 deg apart
    np.testing.assert_allclose(again, torque.total, atol=6e-3)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        (tooth_times_text, lambda path: speed_from_csv(path, WHEEL, Filter(12))),
        (voltage_text, lambda path: speed_from_voltage(path, VOLTAGE)),
    ],
)
def test_a_speed_is_read_back(tmp_path, text, read):
    """Within 0.1 % of its swing: the voltage is sampled at 20 kHz, 22 times a tooth."""
    (tmp_path / "s.csv").write_text(text(SPEED, WHEEL), encoding="utf-8")
    trace = read(tmp_path / "s.csv")
    assert trace.count == 1
    either = min(np.abs(trace.mean - np.roll(SPEED, k)).max() for k in (0, 360))
    assert either < 1e-3 * np.ptp(SPEED)
    assert trace.statistics.mean == pytest.approx(speed_statistics(SPEED).mean, rel=1e-6)
