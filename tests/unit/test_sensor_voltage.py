"""Zero crossings of a pick-up's voltage: both edges, missing teeth, noise, refusals."""

import numpy as np
import pytest
from crank_traces import CYCLE, voltage

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.pickup_voltage import (
    edges_from_voltage,
    speed_from_voltage,
    zero_crossings,
)
from camwright.pipeline.engine.speed_trace import Filter, speed_from_edges
from camwright.pipeline.engine.trigger_wheel import TriggerWheel

THETA = np.arange(720) * CYCLE / 720
SPEED = 150.0 + 4.0 * np.sin(THETA / 2) - 3.0 * np.cos(THETA)


def test_crossings_of_a_sine_are_those_of_its_phase():
    """Straight lines over 1/200 of the wave: within 1e-6 of its period."""
    time = np.arange(0.0, 5.0, 0.005)
    found = zero_crossings(time, 2.0 * np.sin(2.0 * np.pi * (time - 0.1234)))
    expected = 0.1234 + 0.5 * np.arange(found.times.size)
    assert found.times.size == 9 or found.times.size == 10
    shift = np.round((found.times[0] - 0.1234) / 0.5) * 0.5
    np.testing.assert_allclose(found.times, expected + shift, atol=2e-6)
    assert np.array_equal(found.rising[1:], ~found.rising[:-1])


def test_noise_about_zero_makes_no_crossings():
    time = np.arange(0.0, 5.0, 0.005)
    noise = np.random.default_rng(2).normal(0.0, 0.1, time.size)
    clean = zero_crossings(time, 2.0 * np.sin(2.0 * np.pi * time))
    noisy = zero_crossings(time, 2.0 * np.sin(2.0 * np.pi * time) + noise)
    assert noisy.times.size == clean.times.size
    np.testing.assert_allclose(noisy.times, clean.times, atol=0.02)


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_speed_is_recovered_and_the_gap_is_found(missing):
    """The voltage of a pulse whose height follows the speed crosses a little beside the tooth's
    middle: 0.1 rad/s of 7."""
    time, volts = voltage(SPEED, 36, missing, 3, noise=0.0)
    wheel = TriggerWheel(36, missing, 0.0)
    edges = edges_from_voltage("run", time, volts, wheel)
    assert [edge.falling for edge in edges] == [False, True]
    if missing:
        assert 0.0 in edges[0].places
        places = np.mod(edges[0].places, 36)
        assert places.max() == 35 - missing
    found = speed_from_edges("run", [edges], wheel, Filter(12))
    turned = min(np.abs(np.roll(found.mean, k) - SPEED).max() for k in _STARTS[missing])
    assert turned < 0.1


# Degrees by which the record's first tooth, or the first after the first gap, may be off zero:
# the other turn of the cycle, or the first tooth that was seen in full.
_STARTS = {0: (0, 10, 20), 1: (0, 360), 2: (0, 360)}


def test_a_file_of_two_runs(tmp_path):
    time, one = voltage(SPEED, 36, 2, 2, noise=0.01, seed=1)
    _, two = voltage(SPEED, 36, 2, 2, noise=0.01, seed=2)
    path = tmp_path / "volts.csv"
    table = np.column_stack([1e3 * time, one, two])
    np.savetxt(path, table, delimiter=",", fmt="%.6g", header="time_ms,a [V],b [V]", comments="")
    found = speed_from_voltage(path, TriggerWheel(36, 2), Filter(12))
    assert found.count >= 2
    # as above, 0.1 rad/s of 10.7, at either end
    assert found.statistics.peak_to_peak == pytest.approx(np.ptp(SPEED), rel=0.02)


def test_what_is_no_pick_up_signal_is_refused(tmp_path):
    time, volts = voltage(SPEED, 36, 2, 2)
    wheel = TriggerWheel(36, 2)
    gap = (time > 0.03) & (time < 0.0312)  # a tooth that broke off
    with pytest.raises(InputError, match=r"missing tooth|teeth, must be"):
        edges_from_voltage("run", time, np.where(gap, 0.0, volts), wheel)
    with pytest.raises(InputError, match="alternating"):
        zero_crossings(time, np.ones_like(time))
    with pytest.raises(InputError, match="must be after"):
        zero_crossings(time[::-1], volts)
    with pytest.raises(InputError, match="threshold"):
        zero_crossings(time, volts, 1.0)
    with pytest.raises(InputError, match="samples per tooth"):
        edges_from_voltage("run", time[::12], np.sin(150.0 * 36.0 * time[::12]), TriggerWheel())
    path = tmp_path / "volts.csv"
    path.write_text("time_s,pressure_bar\n0,1\n")
    with pytest.raises(InputError, match="one or more of voltage"):
        speed_from_voltage(path, wheel, Filter())
