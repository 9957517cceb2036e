"""Trigger wheels with gaps at any speed, with several gaps, in logs and with exchanged leads."""

import gzip
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cranked_wheels import (
    TURN,
    WHEELS,
    conditioned_voltage,
    cranking,
    edge_times,
    motion,
)
from pickup_records import pickup_record, speed_of

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import crank_speed, measurement_record
from camwright.pipeline.engine.pickup_voltage import (
    VoltageTable,
    edges_of_signals,
    speed_from_voltage,
)
from camwright.pipeline.engine.pitch_errors import PitchErrors
from camwright.pipeline.engine.speed_file import edges_from_csv, speed_from_csv
from camwright.pipeline.engine.speed_trace import Filter, speed_from_edges
from camwright.pipeline.engine.tooth_pattern import ToothPattern, tooth_pattern
from camwright.pipeline.engine.trigger_wheel import MISSING_MAX, TriggerWheel

DATA = Path(__file__).parents[1] / "data" / "strangers"
LOG, LEADS = DATA / "10-composite-log", DATA / "20-vr-reversed-leads"
HARMONICS = {"8-1": 4, "12-1": 6, "24-2": 12, "36-1": 16, "60-2": 20, "36-2-2-2": 12, "24-1-1": 10}


def torque_of(case_file, old="", new=""):
    """Torque of a case's engine, with its error bar, and the record of the measurement."""
    text = case_file.read_text(encoding="utf-8")
    case_file.write_text(text.replace(old, new), encoding="utf-8")
    case = read_case(case_file)
    return crank_speed(case, case.engine).torque(case.crankshaft.inertia), measurement_record(case)


def error(torque, known):
    """Error (n,) in the better of the two turns: a wheel on the crank leaves the turn open."""
    angles = torque.theta
    both = (np.abs(torque.total - known(angles + turn)) for turn in (0.0, TURN))
    return min(both, key=np.max)


def test_a_composite_log_of_a_cranked_engine(tmp_path):
    """Two header lines, other events between, a swing of the speed that makes the gap 2.9 pitches
    long at the dead centre: the torque that made the log is within the bar."""
    known = np.loadtxt(LOG / "known.csv", delimiter=",", skiprows=1)
    shutil.copytree(LOG, tmp_path / "log")
    torque, record = torque_of(tmp_path / "log" / "composite.toml")
    off = error(torque, lambda at: np.interp(np.degrees(at) % 720.0, *known.T))
    assert (off <= torque.error_bar).all()
    assert record["wheel"] == "8-1"
    # six harmonics of the cycle hold 90 % of the torque's peak to peak of 150.1 N m
    assert torque.peak_to_peak == pytest.approx(135.8, abs=0.1)


@pytest.mark.parametrize("low", [0, 1])
@pytest.mark.parametrize("beside", [",0", ""])
def test_levels_are_edges_at_their_changes(tmp_path, low, beside):
    """A logic analyser writes the level at the start and after each change; a second channel, or
    one that is low at a tooth, changes nothing."""
    made = motion(cranking, 21.0, 0.3)
    times = edge_times(made, "12-1", 0.0, 4)
    (tmp_path / "times.csv").write_text("time_s\n" + "".join(f"{t:.9f}\n" for t in times))
    head = "Time[s], Channel 0" + (", Channel 1" if beside else "")
    rows = [f"{times[0] - 0.01:.9f}, {low}{beside}"]
    rows += [f"{t:.9f}, {(k + 1 + low) % 2}{beside}" for k, t in enumerate(times)]
    (tmp_path / "levels.csv").write_text("\n".join([head, *rows]) + "\n")
    wheel = TriggerWheel(12, 1)
    one, other = (
        speed_from_csv(tmp_path / name, wheel, Filter(6)) for name in ("times.csv", "levels.csv")
    )
    assert one.count == other.count
    np.testing.assert_allclose(one.mean, other.mean, rtol=1e-6)  # times to 1 ns
    single = edges_from_csv(tmp_path / "levels.csv", wheel, both_edges=False)
    assert len(single.runs[0]) == 1


def test_one_of_several_levels_is_named(tmp_path):
    rows = "".join(f"{0.01 * k:.3f},{k % 2},{(k // 2) % 2}\n" for k in range(200))
    (tmp_path / "f.csv").write_text("time_s,crank,cam\n" + rows)
    with pytest.raises(InputError, match=r"engine\.column = missing, must be the header of a lev"):
        edges_from_csv(tmp_path / "f.csv", TriggerWheel(12))
    assert edges_from_csv(tmp_path / "f.csv", TriggerWheel(12), column="crank").runs


def test_a_wheel_of_three_gaps(tmp_path):
    """t = a x + 2e-4 s sin(x/2): torque 0.4 kg m2 omega^3 5e-5 s sin(x/2), 33.50 N m peak to peak;
    the reference is the first tooth of the longest row, at 150 deg of the record."""
    shutil.copytree(LOG, tmp_path / "log")
    torque, record = torque_of(tmp_path / "log" / "wheel222.toml", '"28.75 deg"', '"150 deg"')
    assert record["wheel"] == "36-2-2-2"

    def known(angle):
        speed = 1.0 / (60.0 / 900.0 / TURN + 1e-4 * np.cos(0.5 * angle))
        return 0.4 * speed**3 * 5e-5 * np.sin(0.5 * angle)

    assert torque.peak_to_peak == pytest.approx(33.50, abs=0.005)
    assert error(torque, known).max() < 0.02
    assert (error(torque, known) <= torque.error_bar).all()


@pytest.mark.parametrize("sign", [1, -1])
def test_a_pick_up_with_exchanged_leads_behind_a_conditioner(tmp_path, sign):
    """Speed 100 pi (1 + 0.01 cos(x/2) + 0.004 cos(x)): 21.64 N m peak to peak at 0.0139 kg m2; the
    voltage is cut at 4 V and -0.7 V, so that both kinds of crossings are steep."""
    lines = gzip.decompress((LEADS / "vr.csv.gz").read_bytes()).decode().splitlines()
    if sign < 0:
        cells = (line.split(",") for line in lines[1:])
        lines[1:] = [f"{at},{-float(volts):.4f}" for at, volts in cells]
    (tmp_path / "vr.csv").write_text("\n".join(lines) + "\n")
    shutil.copy(LEADS / "case.toml", tmp_path)
    torque, record = torque_of(tmp_path / "case.toml", "[engine]\n", "[engine]\nharmonics = 4\n")
    assert record["wheel"] == "60-2"

    def known(angle):
        share = 1.0 + 0.01 * np.cos(0.5 * angle) + 0.004 * np.cos(angle)
        slope = -0.005 * np.sin(0.5 * angle) - 0.004 * np.sin(angle)
        return 0.0139 * (100.0 * np.pi) ** 2 * share * slope

    off = error(torque, known)
    assert (off <= torque.error_bar).all()
    assert torque.peak_to_peak == pytest.approx(22.16, abs=0.005)  # of either polarity
    assert off.max() == pytest.approx(1.14, abs=0.01)
    assert torque.error_bar.max() == pytest.approx(6.16, abs=0.01)


@pytest.mark.parametrize("name", ["12-1", "36-1", "60-2", "36-2-2-2", "24-1-1"])
@pytest.mark.parametrize("sign", [1, -1])
def test_conditioned_voltages_of_every_wheel_and_polarity(name, sign):
    """Noise of 0.1 to 2 % of the swing; the bar holds the torque with pitches within 0.05 deg."""

    def driven(angle):
        return -5.0 * np.sin(0.5 * angle) - 4.0 * np.sin(angle)

    made = motion(driven, 314.0, 0.05)
    for seed, noise in enumerate((0.004, 0.03, 0.08)):
        time, volts = conditioned_voltage(made, name, 5, seed, noise)
        table = VoltageTable(file="u.csv", harmonics=4)
        record, recording = edges_of_signals("u", time, {"u": sign * volts}, table)
        assert recording.pattern.words == name
        torque = speed_of_edges(record, 4, np.radians(0.05)).torque(made.inertia)
        assert (error(torque, made.torque_at) <= torque.error_bar).all()


def speed_of_edges(record, harmonics, tolerance):
    edges = len(record.runs[0]) * record.wheel.present
    return speed_from_edges(*record, Filter(harmonics), PitchErrors.unknown(edges, tolerance))


@pytest.mark.parametrize("shape", ["clean", "one-sided", "clipped", "clipped on one side"])
@pytest.mark.parametrize("wheel", ["36-1", "60-2", "4+1"])
def test_either_polarity_of_a_pick_up_shows_the_same_wheel(shape, wheel):
    record = pickup_record(7, wheel, shape, runs=1)
    patterns = {
        speed_of(replace(record, volts=s * record.volts)).recording.pattern for s in (1, -1)
    }
    assert [each.words for each in patterns] == [wheel]


def record_of(times, wheel, folder, edges=2):
    (folder / "t.csv").write_text("time_s\n" + "".join(f"{t:.12g}\n" for t in times))
    return edges_from_csv(folder / "t.csv", wheel, edges == 2)


def stated(name):
    return TriggerWheel(*WHEELS[name][:2])


@pytest.mark.parametrize("name", WHEELS)
@pytest.mark.parametrize("edges", [1, 2])
def test_the_bar_holds_the_torque_of_a_cranked_engine(tmp_path, name, edges):
    """Energy swings of 30 to 90 % of the mean, edges within 0.4 % of a pitch, any start."""
    rng = np.random.default_rng(len(name) + edges)
    for swing in (0.3, 0.6, 0.9):
        made, reference = motion(cranking, 21.0, swing), float(rng.uniform(0.0, TURN))
        times = edge_times(made, name, reference, 5, 0.004, 7, edges == 2)
        start = int(rng.integers(0, 3)) * edges
        record = record_of(times[start:], stated(name), tmp_path, edges)
        assert record.wheel.rows == (WHEELS[name][2] if len(WHEELS[name][2]) > 1 else ())
        tolerance = 0.004 * TURN / WHEELS[name][0]
        torque = speed_of_edges(record, HARMONICS[name], tolerance).torque(made.inertia)
        off = error(torque, lambda at, made=made, by=reference: made.torque_at(at + by))
        assert (off <= torque.error_bar).all(), swing


@pytest.mark.parametrize("name", WHEELS)
def test_other_wheels_than_stated_and_faulty_edges_are_refused(tmp_path, name):
    """Each other wheel of nearly as many teeth; an edge lost or one too many after the first gap,
    of which a record before it cannot tell."""
    teeth, missing, rows = WHEELS[name]
    rng = np.random.default_rng(teeth)
    for swing in (0.02, 0.3):
        times = edge_times(motion(cranking, 21.0, swing), name, 1.0, 4, 0.004, 1)
        for other in [(n, m) for n in range(teeth - 2, teeth + 3) for m in range(4)]:
            if other != (teeth, missing) and other[1] <= other[0] // 4 and other[0] > 3:
                with pytest.raises(InputError):
                    record_of(times, TriggerWheel(*other), tmp_path)
        for at in rng.integers(2 * sum(rows) + 4, times.size - 2 * sum(rows), 8):
            between = times[at - 1] + rng.uniform(0.2, 0.8) * (times[at] - times[at - 1])
            for faulty in (np.delete(times, at), np.insert(times, at, between)):
                with pytest.raises(InputError):
                    record_of(faulty, stated(name), tmp_path)


def test_an_edge_list_that_begins_with_a_falling_edge_is_refused(tmp_path):
    times = edge_times(motion(cranking, 21.0, 0.1), "36-1", 0.0, 4)
    with pytest.raises(InputError, match="must be one that rises; the first edge falls"):
        record_of(times[1:], stated("36-1"), tmp_path)


@pytest.mark.parametrize("name", WHEELS)
def test_patterns_of_cranked_wheels(name):
    """Without a statement of the teeth: energy swings to 60 % of the mean."""
    for swing in (0.02, 0.3, 0.6):
        times = edge_times(motion(cranking, 21.0, swing), name, 0.5, 5, 0.002, 3, both=False)
        assert tooth_pattern(times).words == name, swing


def test_a_pause_of_a_record_is_a_gap_of_bounded_memory():
    """A digit too many in one time: a gap of 1e9 pitches, tried up to the most a wheel can miss."""
    times = edge_times(motion(cranking, 21.0, 0.02), "36-1", 0.5, 5, 0.0, both=False)
    times[-1] = times[-2] + 1e9 * float(np.median(np.diff(times)))
    assert 1 <= tooth_pattern(times).missing_teeth <= MISSING_MAX


def test_a_wheel_that_repeats_within_a_turn_is_not_taken_for_one_of_several_gaps():
    even = np.array([k + tooth / 12.0 for k in range(6) for tooth in range(11)])
    assert tooth_pattern(even) == ToothPattern(12, 1)
    with pytest.raises(InputError, match=r"wheel\.rows"):
        TriggerWheel(36, 2, rows=(16, 13))


def test_a_named_voltage_is_read_beside_another(tmp_path):
    made = motion(np.sin, 314.0, 0.02)
    time, volts = conditioned_voltage(made, "36-1", 3, 1)
    table = np.column_stack([time, volts, np.full(time.size, 12.6)])
    np.savetxt(
        tmp_path / "u.csv", table, "%.6g", ",", header="time_s,u [V],battery [V]", comments=""
    )
    with pytest.raises(InputError, match=r"battery \[V\] = constant"):
        speed_from_voltage(tmp_path / "u.csv", VoltageTable(file="u.csv", harmonics=4))
    named = VoltageTable(file="u.csv", harmonics=4, column="u")
    assert speed_from_voltage(tmp_path / "u.csv", named).recording.pattern.words == "36-1"
