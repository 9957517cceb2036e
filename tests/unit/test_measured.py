"""A case takes its engine from a measured file; what does not fit is refused by its name."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from crank_traces import CYCLE, noisy_times, tooth_angles, voltage
from small_run import named
from wheel_records import edge_times, gas_torque, motion, wheel

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import (
    engine_torque,
    engine_torques,
    measurement_record,
    measurement_words,
)
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.speed_notes import HALF_ORDERS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.crank_speed import consistency, study_of
from camwright.pipeline.cycle.solution import solution
from camwright.pipeline.engine.crankshaft import energy_swing
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from camwright.pipeline.results.run_records import crank_speed_record
from camwright.pipeline.results.trial import GIVEN_LIFT, Trial
from camwright.pipeline.results.verdict_summary import measured_line
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).resolve().parents[2]
GX120 = (ROOT / "cases" / "gx120.toml").read_text(encoding="utf-8")
GEAR = (
    'bore = "60 mm"\ncrank_radius = "21 mm"\nrod_length = "73 mm"\ncompression_ratio = 8.5\n'
    'piston_mass = "144 g"\nrod_mass = "123 g"\n'
)
DRIVE = {"bore": 0.060, "crank_radius": 0.021, "rod_length": 0.073, "compression_ratio": 8.5,
         "piston_mass": 0.144, "rod_mass": 0.123}  # fmt: skip
THETA = np.arange(720) * CYCLE / 720
SPEED = 151.0 - 5.0 * np.cos(THETA / 2 - 3.0) + 2.0 * np.sin(THETA)


def case_text(engine):
    return re.sub(r"\[engine\].*?(?=\n\[crankshaft\])", f"[engine]\n{engine}", GX120, flags=re.S)


def measured(folder, engine, name, columns, header):
    rows = "\n".join(",".join(repr(float(v)) for v in row) for row in np.column_stack(columns))
    (folder / name).write_text(f"{header}\n{rows}\n", encoding="utf-8")
    (folder / "case.toml").write_text(case_text(engine), encoding="utf-8")
    return read_case(folder / "case.toml")


def test_cylinder_pressure(tmp_path):
    pressure = 0.4 + 7.0 * np.exp(-(((THETA - 6.6) / 0.5) ** 2))
    engine = f'kind = "pressure"\nfile = "p.csv"\n{GEAR}'
    case = measured(tmp_path, engine, "p.csv", [np.degrees(THETA), pressure], "angle_deg,p_bar")
    torque = engine_torque(case, case.load_cases[0])
    assert set(torque.components) == {"gas", "inertia", "friction"}
    record = measurement_record(case)
    assert record is not None
    assert record["cycles"] == 1
    json.dumps(record)
    again = parse_case(case.to_toml().replace("inputs/", ""), tmp_path)
    assert again.engine == case.engine


def test_tooth_times(tmp_path):
    angles = tooth_angles(36, 0, 2, 1)
    runs = [noisy_times(SPEED, angles, 0.2, k, np.radians(10)) for k in range(3)]
    engine = 'kind = "speed"\nfile = "t.csv"\n'
    case = measured(tmp_path, engine, "t.csv", runs, "a_s,b_s,c_s")
    torque = engine_torque(case, case.load_cases[0])
    assert list(torque.components) == ["measured"]
    record = measurement_record(case)
    assert record is not None
    assert record["cycles"] == 3
    # two standard errors: 3 runs of 144 edges, neighbours sharing a time, 1.2 / sqrt(2 * 288)
    assert record["tooth_noise_rad_per_s"] == pytest.approx(0.2, rel=0.1)
    assert record["torque_noise_floor_Nm"] > 0.0


def test_sensor_voltage(tmp_path):
    time, volts = voltage(SPEED, 36, 2, 2, sample=5e-5)
    engine = 'kind = "voltage"\nfile = "v.csv"\nharmonics = 12\n'
    case = measured(tmp_path, engine, "v.csv", [time, volts], "time_s,u [V]")
    record = measurement_record(case)
    assert record is not None
    assert record["p2p_rad_per_s"] == pytest.approx(np.ptp(SPEED), rel=1e-3)
    assert engine_torque(case, case.load_cases[0]).std > 1.0
    assert (record["runs"], record["cycles"], record["wheel"]) == (1, 1, "36-2")
    assert record["sampling_rate_Hz"] == pytest.approx(2e4)
    (line,) = measured_line({"measurement": record})
    assert line.startswith("measured: 1 run, 1 cycle, trigger wheel 36-2, sampled at 20 kHz; 95 %")
    assert measured_line({"measurement": None}) == []


def test_a_stated_wheel_that_the_signal_contradicts_is_refused_by_its_key(tmp_path):
    time, volts = voltage(SPEED, 36, 2, 2, sample=5e-5)
    engine = 'kind = "voltage"\nfile = "v.csv"\nteeth = 60\nmissing_teeth = 2\n'
    case = measured(tmp_path, engine, "v.csv", [time, volts], "time_s,u [V]")
    with pytest.raises(InputError, match=r"engine\.teeth = 60, must be 36, or left out: v\.csv"):
        measurement_record(case)


REFERENCE = """kind = "speed"
file = "t.csv"
edges = 1
[engine.reference]
file = "fast.csv"
kind = "second_speed"
[engine.running_gear]
crank_radius = "21 mm"
rod_length = "73 mm"
piston_mass = "144 g"
rod_mass = "123 g"
"""


def test_a_second_record_corrects_the_wheel(tmp_path):
    """The errors are 0.05 deg rms, and 10 cycles an edge have 0.01 deg of noise."""
    made = wheel(36, 0, 1, 1)
    slow, fast = (
        edge_times(motion(gas_torque, speed), made, 10, np.radians(0.01), seed)
        for seed, speed in enumerate((151.0, 302.0))
    )
    (tmp_path / "fast.csv").write_text("time_s\n" + "\n".join(map(repr, fast.tolist())) + "\n")
    case = measured(tmp_path, REFERENCE, "t.csv", [slow], "time_s")
    record, lines = measurement_record(case), list(measurement_words(case))
    assert record is not None
    assert record["notes"] == lines
    # 0.011 deg rms remain; uncorrelated with 0.047 deg, they change its rms by 2.8 %
    assert record["pitch_errors_rms_deg"] == pytest.approx(np.degrees(made.errors.std()), rel=0.05)
    assert record["pitch_errors_left_deg"] < 0.015
    assert 0.0 < record["torque_wheel_bar_max_Nm"] < record["torque_error_bar_max_Nm"]
    assert f"{record['pitch_errors_left_deg']:.2g} deg rms remain" in lines[0]
    bare = REFERENCE.partition("[")[0]
    alone = measured(tmp_path, bare, "t.csv", [slow], "time_s")
    blind = measurement_record(alone)
    assert blind is not None
    assert "pitch_errors_rms_deg" not in blind
    assert blind["pitch_tolerance_deg"] == pytest.approx(0.05)
    assert blind["torque_wheel_bar_max_Nm"] > 3.0 * record["torque_wheel_bar_max_Nm"]
    assert any("cannot be separated" in line for line in measurement_words(alone))
    again = parse_case(case.to_toml().replace("inputs/", ""), tmp_path)
    assert again.engine == case.engine


def test_half_orders_out_of_proportion_are_stated(tmp_path):
    """A speed alike in both turns but for half orders of 1 % has no certain cycle phase, unless
    two cylinders fire evenly; a speed of half orders alone is not that of such an engine."""
    twin = '[engine.running_gear]\nfiring_offsets = ["0 deg", "360 deg"]\n' + "\n".join(
        line for line in GEAR.splitlines() if "bore" not in line and "compression" not in line
    )
    angle = np.arange(0.0, 720.0, 5.0)
    phase = np.radians(angle)
    alike = 150.0 + 5.0 * np.sin(phase) + 0.3 * np.sin(0.5 * phase)
    unlike = 150.0 + 5.0 * np.sin(0.5 * phase)
    for speed, gear, text in (
        (alike, "", "the two turns of the cycle correlate to 0.99"),
        (alike, twin, None),
        (unlike, "", None),
        (unlike, twin, "cylinders that fire evenly correlate to nearly 1"),
    ):
        engine = f'kind = "speed"\nfile = "t.csv"\npitch_tolerance = "0 deg"\n{gear}\n'
        case = measured(tmp_path, engine, "t.csv", [angle, speed], "angle_deg,speed_rad/s")
        lines = list(measurement_words(case))
        assert len(lines) == (text is not None)
        assert text is None or text in lines[0]


def test_half_orders_of_one_cylinder_are_most_of_its_speed():
    low, high = HALF_ORDERS
    for intake, burnt in ((95e3, 0.0), (30e3, 0.9), (95e3, 0.9)):
        engine = CylinderEngine(**DRIVE, intake_pressure=intake, combustion_efficiency=burnt,
                                friction_pressure=0.0 if burnt == 0.0 else None)  # fmt: skip
        work = energy_swing(torque_from_cylinder(engine, 157.0).total)
        share = (0.5 * (work - np.roll(work, 360))).var() / work.var()
        assert low < share < high


PRESSURE = f'kind = "pressure"\nfile = "p.csv"\n{GEAR}'
REFUSED = {
    "unit alone": (f'{PRESSURE}angle_unit = "deg"\n', "pressure_unit"),
    "no motored file": (
        f'kind = "pressure"\nfile = "p.csv"\ndead_centre = "symmetry"\n{GEAR}', "motored_file"),
    "another kind": ('kind = "guess"\nfile = "p.csv"', "engine.kind = guess"),
    "unknown key": ('kind = "speed"\nfile = "p.csv"\nteth = 36', "did you mean teeth"),
    "three edges": ('kind = "speed"\nfile = "p.csv"\nedges = 3', "engine.edges = 3"),
    "out of the folder": ('kind = "voltage"\nfile = "../p.csv"', "engine.file"),
    "a short rod": (PRESSURE.replace("73 mm", "20 mm"), "rod_length"),
    "a short rod of the wheel": (
        REFERENCE.replace("73 mm", "20 mm"), r"engine\.running_gear\.rod_length = 20 mm"),
    "a second speed without masses": (
        REFERENCE.partition("[engine.running_gear]")[0], r"engine\.running_gear = missing"),
    "a reference of an exact wheel": (
        REFERENCE.replace("edges = 1", 'pitch_tolerance = "0 deg"'), r"pitch_tolerance = 0 deg"),
    "no kind of reference": (REFERENCE.replace('kind = "second_speed"\n', ""), "reference.kind"),
    "a wheel of wood": ('kind = "speed"\nfile = "t.csv"\nwheel_class = "carved"', "wheel_class"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_bad_engines_are_refused_in_one_line(tmp_path, name):
    engine, pattern = REFUSED[name]
    with pytest.raises(InputError, match=pattern) as caught:
        parse_case(case_text(engine), tmp_path)
    assert "\n" not in str(caught.value)


def test_a_speed_needs_the_inertia(tmp_path):
    whole = case_text('kind = "speed"\nfile = "t"')
    text = re.sub(r"\[crankshaft\].*?(?=\n\[mechanism\])", "", whole, flags=re.S)
    with pytest.raises(InputError, match=r"crankshaft\.inertia = missing"):
        parse_case(text, tmp_path)


def test_two_gigabytes_are_refused_unread(tmp_path):
    (tmp_path / "case.toml").write_text(case_text('kind = "voltage"\nfile = "v.csv"'))
    with (tmp_path / "v.csv").open("wb") as file:
        file.truncate(2 * 2**30)
    with pytest.raises(InputError, match=r"engine\.file = .*v\.csv is larger, must be at most"):
        read_case(tmp_path / "case.toml")


@pytest.fixture(scope="module")
def gx120():
    case = parse_case(GX120)
    torques = engine_torques(case)
    return case, torques["idle"], case.contour(cam_lift(case, torques))


def test_speed_of_the_published_case(gx120):
    """Engine alone 3.59 rad/s at 157 rad/s, 3.44 with the mechanism's inertia, 0.40 at work."""
    case, torque, contour = gx120
    idle = machines(case, {"idle": torque})[0]
    study = study_of(idle, contour.pitch)
    assert study is not None
    motions = (study.before, study.inertia_alone, study.after)
    stds = [motion.statistics.std for motion in motions]
    assert stds == pytest.approx([3.59, 3.44, 0.40], rel=0.02)
    assert max(study.before.closure, study.after.closure) < 1e-10
    assert study.added_inertia == pytest.approx(0.11, abs=0.005)  # two digits are published
    assert {column.name for column in study.columns()} == {
        "crank_angle", "speed_before", "speed_inertia_alone", "speed_after"
    }  # fmt: skip
    whole, pitch = torque.without_mean().total, contour.pitch
    agreement = consistency(idle, pitch, study, demand=whole, measured=True)
    found = {one.id: one for one in agreement}
    assert set(found) == {"power", "energy", "work", "inertia"}
    assert not found["work"].flagged
    assert not found["inertia"].flagged
    assert found["power"].flagged  # smoothing takes 14 % of the torque away


def trial_of(case, torques, contour):
    """A trial of few positions, its contact by closed forms."""
    solved = solution(case, contour, Tier.PREVIEW, torques=torques, positions=72)
    return Trial(1, "", GIVEN_LIFT, solved, ())


def test_the_record_of_a_run_holds_the_crank_speed_of_the_guides_that_rub(gx120):
    case, torque, contour = gx120
    trial, whole = trial_of(case, {"idle": torque}, contour), torque.without_mean().total
    record, columns = crank_speed_record(trial, whole)
    json.dumps(record)
    cycle = trial.cycles[0]
    study = study_of(cycle.machine, contour.pitch, cycle.loads.rubbing)
    found = record["speed"]["idle"]
    for name in ("before", "inertia_alone", "after"):
        motion = getattr(study, name)
        assert found[name]["std_rad_per_s"] == motion.statistics.std
        assert found[name]["closure"] == motion.closure
    flywheel, radius = found["flywheel_for_the_same_std"], contour.radius_max().value
    assert flywheel["added_inertia_kg_m2"] == study.added_inertia
    assert flywheel["outer_radius_mm"] == pytest.approx(1e3 * radius, rel=1e-12)
    assert flywheel["disc_mass_kg"] == pytest.approx(2.0 * flywheel["rim_mass_kg"], rel=1e-12)
    np.testing.assert_array_equal(named(columns)["speed_after"], study.after.speed)
    agreement = {one["id"]: one for one in record["consistency"]}
    assert set(agreement) == {"power", "energy", "work", "inertia"}
    assert {one["load_case"] for one in agreement.values()} == {"idle"}


def test_no_crankshaft_no_speed(gx120):
    case, torque, contour = gx120
    bare = case.model_copy(update={"crankshaft": None})
    idle = machines(bare, {"idle": torque})[0]
    assert study_of(idle, contour.pitch) is None
    whole, pitch = torque.without_mean().total, contour.pitch
    agreement = consistency(idle, pitch, None, demand=whole, measured=True)
    assert {one.id for one in agreement} == {"power", "energy"}
    record, columns = crank_speed_record(trial_of(bare, {"idle": torque}, contour), None)
    assert (record, columns) == ({"speed": None, "consistency": []}, None)


def test_nothing_asked_of_the_cam_and_nothing_measured_there_is_nothing_to_agree_with(gx120):
    case, torque, contour = gx120
    idle = machines(case, {"idle": torque})[0]
    found = [one.id for one in consistency(idle, contour.pitch, None, measured=True)]
    assert found == ["inertia"]
    assert consistency(idle, contour.pitch, None) == ()


def test_what_was_measured_of_the_speed_belongs_to_the_design_load_case(gx120):
    case, torque, contour = gx120
    (idle,) = case.load_cases
    both = case.model_copy(update={"load_cases": (idle, idle.model_copy(update={"name": "rated"}))})
    torques = {"idle": torque, "rated": torque}
    record, _ = crank_speed_record(trial_of(both, torques, contour), None)
    found = [(one["load_case"], one["id"]) for one in record["consistency"]]
    assert found == [("idle", "work"), ("idle", "inertia"), ("rated", "work")]


def test_firing_order_and_lift_tables_of_a_cylinder():
    rows = ((0, 0), (50, 3), (150, 3), (220, 0))
    table = ", ".join(f'{{angle = "{a} deg", lift = "{s} mm"}}' for a, s in rows)
    extra = f'firing_offsets = ["0 deg", "360 deg"]\nintake_lift_table = [{table}]\nheat_loss ='
    case = parse_case(GX120.replace("heat_loss =", extra, 1))
    engine = case.engine
    assert engine.firing_offsets == (0.0, pytest.approx(2.0 * np.pi))
    second = engine.intake_lift_table[1]
    assert (second.angle, second.lift) == (pytest.approx(np.radians(50.0)), 0.003)
    assert engine.exhaust_lift_table == ()
    assert parse_case(case.to_toml()) == case
    twin = engine_torque(case, case.load_cases[0]).total
    np.testing.assert_allclose(twin[:360], twin[360:], atol=1e-9)  # fires once a turn
