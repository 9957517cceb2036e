"""Voltage of a pick-up: wave forms, wheels, runs and noise that are read; refusals."""

import numpy as np
import pytest
from crank_traces import CYCLE, voltage
from pickup_records import SHAPES, WHEELS, error_and_bar, pickup_record, speed_of, speed_of_signals

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.pickup_voltage import (
    THRESHOLD,
    VoltageTable,
    speed_from_voltage,
    swing_of,
)
from camwright.pipeline.engine.tooth_pattern import ToothPattern, tooth_pattern

THETA = np.arange(720) * CYCLE / 720
SPEED = 150.0 + 4.0 * np.sin(THETA / 2) - 3.0 * np.cos(THETA)
TABLE = VoltageTable(file="volts.csv", teeth=36, harmonics=12)


def speed_in(time, volts, table=TABLE):
    return speed_of_signals(time, {"u": volts}, table)


def test_crossings_of_a_sine_are_those_of_its_phase():
    """Straight lines over 1/200 of the wave: within 1e-6 of its period."""
    time = np.arange(0.0, 5.0, 0.005)
    wave = 2.0 * np.sin(2.0 * np.pi * (time - 0.1234))
    crossings = swing_of("u", time, 3.0 + wave).crossings(THRESHOLD)
    expected = 0.1234 + 0.5 * np.arange(crossings.times.size)
    assert crossings.times.size in (9, 10)
    shift = np.round((crossings.times[0] - 0.1234) / 0.5) * 0.5
    # quantiles of two digits of a wave sampled 200 times set the middle to 1e-4 of its height
    np.testing.assert_allclose(crossings.times, expected + shift, atol=2e-5)
    assert np.array_equal(crossings.rising[1:], ~crossings.rising[:-1])


def test_noise_about_the_middle_makes_no_crossings():
    """Noise of 5 %: a line through eight samples each 1/200 of the wave apart, within 0.01."""
    time = np.arange(0.0, 5.0, 0.005)
    noise = np.random.default_rng(2).normal(0.0, 0.1, time.size)
    wave = 2.0 * np.sin(2.0 * np.pi * time)
    clean, noisy = (swing_of("u", time, each).crossings(THRESHOLD) for each in (wave, wave + noise))
    assert noisy.times.size == clean.times.size
    np.testing.assert_allclose(noisy.times, clean.times, atol=0.01)


@pytest.mark.parametrize("missing", [0, 1, 2])
def test_speed_is_recovered_and_the_gap_is_seen(missing):
    """The voltage of a pulse whose height follows the speed crosses a little beside the tooth's
    middle: 0.1 rad/s of 7."""
    trace = speed_in(*voltage(SPEED, 36, missing, 3, noise=0.0))
    assert trace.recording.pattern == ToothPattern(36, missing)
    turned = min(np.abs(np.roll(trace.mean, k) - SPEED).max() for k in _STARTS[missing])
    assert turned < 0.1


# Degrees by which the record's first tooth, or the first after the first gap, may be off zero:
# the other turn of the cycle, or the first tooth that was seen in full.
_STARTS = {0: (0, 10, 20, 360, 370), 1: (0, 360), 2: (0, 360)}


@pytest.mark.parametrize("wheel", WHEELS)
@pytest.mark.parametrize("shape", SHAPES)
def test_the_error_bar_holds_the_torque_of_every_wave_form(wheel, shape):
    """One record each, seeded; 200 more stand in the validation."""
    record = pickup_record(SHAPES.index(shape), wheel, shape)
    trace = speed_of(record)
    teeth, missing, extra = WHEELS[wheel]
    assert trace.recording.pattern == ToothPattern(teeth, missing, extra)
    assert trace.recording.runs == record.volts.shape[0]
    assert trace.recording.sampling_rate == pytest.approx(1.0 / np.diff(record.time)[0], rel=1e-6)
    error, bar = error_and_bar(record, trace)
    assert (error <= bar).all()


@pytest.mark.parametrize("shape", ["clean", "one-sided", "clipped on one side"])
def test_exchanged_leads_are_seen(shape):
    record = pickup_record(5, "36-1", shape, runs=1, noise=False)
    straight = speed_in(record.time, record.volts[0])
    reversed_ = speed_in(record.time, -record.volts[0])
    # the middle between the rails may lie on either side of the zero line, by 1e-4 of the swing
    np.testing.assert_allclose(reversed_.mean, straight.mean, rtol=1e-7)


def test_a_file_of_two_runs(tmp_path):
    time, one = voltage(SPEED, 36, 2, 2, noise=0.01, seed=1)
    _, two = voltage(SPEED, 36, 2, 2, noise=0.01, seed=2)
    path = tmp_path / "volts.csv"
    table = np.column_stack([1e3 * time, one, two])
    np.savetxt(path, table, delimiter=",", fmt="%.6g", header="time_ms,a [V],b [V]", comments="")
    trace = speed_from_voltage(path, VoltageTable(file="volts.csv", harmonics=12))
    assert trace.count >= 2
    assert (trace.recording.runs, trace.recording.pattern.words) == (2, "36-2")
    assert trace.recording.sampling_rate == pytest.approx(5e4, rel=1e-3)
    # as above, 0.1 rad/s of 10.7, at either end
    assert trace.statistics.peak_to_peak == pytest.approx(np.ptp(SPEED), rel=0.02)


def test_runs_between_which_the_crank_stood_still():
    time, volts = voltage(SPEED, 36, 2, 2, noise=0.02)
    quiet = np.random.default_rng(3).normal(0.0, 0.02, volts.size // 2)
    whole = np.concatenate([volts, quiet, volts])
    trace = speed_in(np.arange(whole.size) * (time[1] - time[0]), whole)
    assert trace.recording.runs == 2
    assert np.ptp(trace.mean) == pytest.approx(np.ptp(SPEED), rel=0.02)


def test_patterns_of_teeth():
    def passed(*at, turns=3):
        return np.concatenate([np.array(at) + k for k in range(turns)])

    even = np.arange(12) / 12
    assert tooth_pattern(passed(*even)) == ToothPattern(None)
    assert tooth_pattern(passed(*even[:-1])) == ToothPattern(12, 1)
    assert tooth_pattern(passed(*even[:-3])) == ToothPattern(12, 3)
    assert tooth_pattern(passed(0.0, 0.25, 0.5, 0.63, 0.75)) == ToothPattern(4, 0, 1)
    assert tooth_pattern(passed(*even[:-1], turns=1)) == ToothPattern(None)
    assert [ToothPattern(60, 2).words, ToothPattern(4, 0, 1).words] == ["60-2", "4+1"]


REFUSED = {
    "constant": (np.ones_like, {}, r"constant at 1 V, must be an alternating"),
    "noise": (
        lambda volts: np.random.default_rng(1).normal(0.0, 1.0, volts.size), {},
        r"u, peak to peak = 4.* V, must be >= 8.* V, as its noise is 0.* V",
    ),
    "one pulse": (lambda volts: np.where(np.arange(volts.size) < 80, volts, 0.0), {}, "crossings"),
    "other teeth": (lambda volts: volts, {"teeth": 60}, r"engine\.teeth = 60, must be 36, or left"),
    "other gap": (
        lambda volts: volts, {"missing_teeth": 1}, r"engine\.missing_teeth = 1, must be 2, .* 36-2",
    ),
    "no additional tooth": (
        lambda volts: volts, {"extra_teeth": 1}, r"engine\.extra_teeth = 1, must be 0",
    ),
    "a broken tooth": (
        lambda volts: np.where(np.abs(np.arange(volts.size) - 1530) < 30, 0.0, volts), {},
        r"missing tooth|teeth, must be",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_signals_that_cannot_be_read_say_why(name):
    change, stated, pattern = REFUSED[name]
    time, volts = voltage(SPEED, 36, 2, 2)
    with pytest.raises(InputError, match=pattern) as caught:
        speed_in(time, change(volts), VoltageTable(file="volts.csv", harmonics=12, **stated))
    assert "\n" not in str(caught.value)


def test_records_that_cannot_be_read_say_why(tmp_path):
    time, volts = voltage(SPEED, 36, 2, 2)
    with pytest.raises(InputError, match="must be after"):
        speed_in(time[::-1], volts)
    _, even = voltage(SPEED, 36, 0, 2)
    bare = VoltageTable(file="volts.csv", harmonics=12)
    with pytest.raises(InputError, match=r"engine\.teeth = missing, must be stated"):
        speed_in(time, even, bare)
    with pytest.raises(InputError, match=r"b = a wheel 60-2, must be as a, which shows 36-2"):
        _, other = voltage(SPEED, 60, 2, 2)
        speed_of_signals(time, {"a": volts, "b": other[: time.size]}, bare)
    with pytest.raises(InputError, match="finer sampling"):
        speed_in(time[::12], np.sin(150.0 * 36.0 * time[::12]))
    path = tmp_path / "volts.csv"
    path.write_text("time_s,pressure_bar\n0,1\n")
    with pytest.raises(InputError, match="one or more of voltage"):
        speed_from_voltage(path, TABLE)
