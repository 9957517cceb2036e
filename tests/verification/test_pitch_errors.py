"""Pitch errors of a trigger wheel, estimated from records made by integration of the motion.

Noise: 0.22 rad/s of a pitch of 10 deg at 151 rad/s is 0.0104 deg of an edge, that of the pick-up of
Cardoso et al., Energies 2025, sec. 2.1.2.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from crank_traces import voltage
from wheel_records import INERTIA, edge_times, gas_torque, motion, wheel

from camwright.geometry.errors import InputError
from camwright.pipeline.case.speed_notes import speed_notes
from camwright.pipeline.engine.cylinder import RunningGear
from camwright.pipeline.engine.pickup_voltage import VoltageTable, speed_from_voltage
from camwright.pipeline.engine.speed_file import speed_of_record
from camwright.pipeline.engine.speed_trace import Filter
from camwright.pipeline.engine.trigger_wheel import TriggerWheel, counted
from camwright.pipeline.engine.wheel_calibration import (
    PITCH_TOLERANCES,
    Calibrator,
    EdgeRecord,
)

GEAR = RunningGear(crank_radius=0.021, rod_length=0.073, piston_mass=0.144, rod_mass=0.123)
NOISE, TOLERANCE = np.radians(0.0104), np.radians(0.05)
SPEED, CYCLES, BAND = 151.0, 50, Filter()


@cache
def steady(speed, heat=3.0, intake=40e3):
    return motion(lambda angle: gas_torque(angle, heat, intake), speed)


@cache
def run_down():
    """From 380 to 130 rad/s without firing, slowed down by friction."""
    return motion(lambda angle: gas_torque(angle, heat=0.0), 380.0, cycles=40, drag=1.8)


def true_torque():
    """J omega domega/dtheta of the first record, on whole degrees, N m."""
    _, speed, slope, _ = steady(SPEED)
    return (INERTIA * speed * slope)[:-1:2]


def record(moved, made, seed, cycles=CYCLES, noise=NOISE, first_turn=0):
    # the first gap recorded ends a turn after the record began
    wheel_ = TriggerWheel(made.teeth, made.missing, 2.0 * np.pi if made.missing else 0.0)
    times = edge_times(moved, made, cycles, noise, seed, first_turn)
    return EdgeRecord("run", [counted("run", times, wheel_, made.edges == 2)], wheel_)


def measured(made, seed=0, second=None, kind="", tolerance=TOLERANCE, gear=GEAR):
    calibrator = Calibrator(tolerance, INERTIA, gear, Path("second") if kind else None, kind)
    first = record(steady(SPEED), made, 3 * seed)
    return speed_of_record(first, BAND, calibrator, lambda _: second)


def error(trace):
    """Greatest error of the torque, and greatest error over the error bar at its angle."""
    off = np.abs(trace.torque(INERTIA).total - true_torque())
    return float(off.max()), float((off / trace.error_bar(INERTIA)).max())


def spread(trace, made):
    """Errors of the estimate against their covariance, 1 on average."""
    estimate = trace.calibration.errors
    off = estimate.errors - made.errors.ravel()
    return float(off @ np.linalg.solve(estimate.covariance, off)) / off.size


def test_two_speeds_correct_the_wheel():
    """5 % of the swing is required of the whole torque, bandwidth included: 2 % are kept, of 24 %
    without correction. What remains of the 116 errors is stated: 1 within 3 sqrt(2 / 116)."""
    made, swing = wheel(60, 2, 2, 1), np.ptp(true_torque())
    second = record(steady(2.0 * SPEED), made, 2, first_turn=1)
    blind, seeing = measured(made), measured(made, 0, second, "second_speed")
    assert error(blind)[0] > 0.2 * swing
    assert error(seeing)[0] < 0.05 * swing
    for trace in (blind, seeing):
        assert error(trace)[1] < 1.0
    calibration = seeing.calibration
    assert spread(seeing, made) == pytest.approx(1.0, abs=0.4)
    assert calibration.errors.residual < np.radians(0.01)
    assert calibration.speeds == pytest.approx((SPEED, 2.0 * SPEED), rel=1e-3)
    assert calibration.errors.misfit == pytest.approx(1.0, abs=0.15)
    (note,) = speed_notes(seeing, INERTIA, GEAR)
    assert (
        "estimated from 1442 rpm to 2884 rpm, given the inertia of crankshaft and running" in note
    )
    assert "deg rms remain" in note
    (warning,) = speed_notes(blind, INERTIA, GEAR)
    assert warning.startswith("warning: pitch errors of the wheel, 0.05 deg by engine.pitch_tol")


def test_a_run_down_corrects_the_wheel():
    made, swing = wheel(36, 0, 2, 1), np.ptp(true_torque())
    second = record(run_down(), made, 2, cycles=39)
    trace = measured(made, 0, second, "run_down")
    assert error(trace)[0] < 0.05 * swing
    assert error(trace)[1] < 1.0
    assert spread(trace, made) == pytest.approx(1.0, abs=0.5)  # of 72 errors, 3 sqrt(2 / 72)
    assert "same gas torque at all speeds" in speed_notes(trace, INERTIA, GEAR)[0]


def test_a_wheel_driven_without_torque_shows_its_errors():
    """Errors of 0.4 deg are far beyond the tolerance, as is stated."""
    made = wheel(36, 1, 1, 3, rms=0.4)
    driven = motion(np.zeros_like, SPEED, cycles=12, drag=0.3)
    second = record(driven, made, 5, cycles=11, noise=0.0)
    trace = measured(made, 0, second, "no_torque")
    off = trace.calibration.errors.errors - made.errors.ravel()
    assert np.abs(off - off.mean()).max() < np.radians(1e-3)
    assert "exceed its tolerance of 0.05 deg" in " ".join(speed_notes(trace, INERTIA, GEAR))


def test_records_at_one_speed_separate_nothing():
    """The error bar stays that of the tolerance and holds the torque, and a warning is given."""
    made = wheel(60, 2, 2, 4)
    second = record(steady(1.001 * SPEED), made, 6)
    trace, alone = measured(made, 1, second, "second_speed"), measured(made, 1)
    bars = [one.wheel_bar(INERTIA).max() for one in (trace, alone)]
    assert 0.7 * bars[1] < bars[0] < 1.3 * bars[1]
    assert error(trace)[1] < 1.0
    assert "the pitch errors that remain make the torque uncertain" in speed_notes(
        trace, INERTIA, GEAR
    )[1]  # fmt: skip


def test_another_gas_torque_is_stated_and_widens_the_error_bar():
    made = wheel(60, 2, 2, 5)
    same = measured(made, 2, record(steady(2.0 * SPEED), made, 7), "second_speed")
    other = measured(made, 2, record(steady(2.0 * SPEED, 3.0, 60e3), made, 7), "second_speed")
    assert same.calibration.errors.torque_change < 0.1 < other.calibration.errors.torque_change
    assert other.wheel_bar(INERTIA).max() > 1.3 * same.wheel_bar(INERTIA).max()
    assert error(other)[1] < 1.0
    assert "the gas torque is not the same" in speed_notes(other, INERTIA, GEAR)[1]


def test_the_inertia_of_the_running_gear_is_needed():
    """Left out, its part of the speed, which does not fall with the mean speed, passes for pitch
    errors, so that the torque lacks that of inertia, - omega^2 I' / 2: to 10 % of its amplitude,
    as the speed varies by 10 %, and noise."""
    made = wheel(60, 2, 2, 6)
    second = record(steady(2.0 * SPEED), made, 8)
    known = measured(made, 3, second, "second_speed")
    unknown = measured(made, 3, second, "second_speed", gear=None)
    missing = known.torque(INERTIA).total - unknown.torque(INERTIA).total
    theta = np.arange(720) * np.pi / 180.0
    inertia = GEAR.inertia_torque(theta, SPEED)
    np.testing.assert_allclose(missing, inertia, atol=0.1 * np.ptp(inertia))


@pytest.mark.parametrize(("made", "half"), [("milled", 0.05), ("stamped", 0.1)])
def test_tolerances_of_the_classes_are_those_of_general_tolerances(made, half):
    """Equally probable within +- 0.05 or 0.1 mm at a radius of 75 mm; rounded to a digit, 14 %."""
    spread_ = np.degrees(half / 75.0) / np.sqrt(3.0)
    assert np.degrees(PITCH_TOLERANCES[made]) == pytest.approx(spread_, rel=0.14)


def test_voltages_at_two_speeds_show_a_wheel_without_errors(tmp_path):
    """Teeth, gap and edges are those of the signal; 2 cycles sampled at 50 kHz."""
    for name, factor in (("slow", 1.0), ("fast", 2.0)):
        speed = steady(factor * SPEED)[1][:-1:2]
        columns = np.column_stack(voltage(speed, 36, 2, 2, sample=2e-5 / factor, noise=0.005))
        np.savetxt(tmp_path / name, columns, "%.7g", ",", header="time_s,u [V]", comments="")
    calibrator = Calibrator(TOLERANCE, INERTIA, GEAR, tmp_path / "fast", "second_speed")
    trace = speed_from_voltage(tmp_path / "slow", VoltageTable(file="slow"), calibrator)
    calibration = trace.calibration
    assert calibration.speeds == pytest.approx((SPEED, 2.0 * SPEED), rel=1e-2)
    assert calibration.errors.residual < 0.5 * TOLERANCE
    assert calibration.errors.rms < 0.5 * TOLERANCE
    assert error(trace)[1] < 1.0


def test_a_reference_shorter_than_a_cycle_is_refused():
    made = wheel(60, 2, 2, 7)
    second = record(steady(2.0 * SPEED), made, 9, cycles=1)
    times = [edges.times[:70] for edges in second.runs[0]]
    short = [replace(edges, times=at, places=edges.places[:70])
             for edges, at in zip(second.runs[0], times, strict=True)]  # fmt: skip
    with pytest.raises(InputError, match="run = 140 edges, must be a whole cycle, 234 edges"):
        measured(made, 4, second._replace(runs=[short]), "second_speed")


def test_a_record_of_another_wheel_is_refused():
    made = wheel(60, 2, 2, 7)
    other = record(steady(2.0 * SPEED), wheel(36, 1, 2, 7), 9)
    with pytest.raises(InputError, match=r"engine.reference.file run = 36 teeth, 1 missing"):
        measured(made, 4, other, "second_speed")


@pytest.mark.slow
@pytest.mark.parametrize("made", [(60, 2, 2), (60, 2, 1), (36, 0, 2), (36, 1, 2)])
@pytest.mark.parametrize("kind", ["second_speed", "run_down", ""])
def test_many_wheels_keep_within_bound_and_error_bar(made, kind):
    """Within 5 % of the swing with correction; within the 95 % error bar in at least 85 %: of 40
    that is undercut with a probability of 0.3 % if 95 % hold, of 20 with 1.6 %."""
    swing, within, count = np.ptp(true_torque()), 0, 20 if kind == "run_down" else 40
    for seed in range(count):
        one, second = wheel(*made, seed), None
        if kind == "second_speed":
            second = record(steady(2.0 * SPEED), one, 3 * seed + 1, first_turn=seed % 2)
        elif kind == "run_down":
            second = record(run_down(), one, 3 * seed + 2, cycles=39)
        trace = measured(one, seed, second, kind)
        assert not kind or error(trace)[0] < 0.05 * swing
        within += error(trace)[1] < 1.0
    assert within >= 0.85 * count
