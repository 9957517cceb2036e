"""Indicated torque of a cylinder pressure against the brake, and the dead centre of the trace."""

from dataclasses import replace

import numpy as np
import pytest
from test_measured import GEAR, THETA, case_text
from test_pressure_trace import ENGINE, RIG, trace_of

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import (
    engine_torques,
    measurement_record,
    measurement_words,
)
from camwright.pipeline.case.plausibility import implausible
from camwright.pipeline.engine.brake_balance import brake_balance
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle
from camwright.pipeline.engine.pressure_trace import torque_from_pressure
from camwright.reports import verification_tables

EXPANSION = (2.0 * np.pi <= THETA) & (3.0 * np.pi > THETA)


@pytest.fixture(scope="module")
def trace():
    return trace_of(working_cycle(ENGINE, 157.08).pressure)


def area(trace):
    """Area of the indicator diagram by its polygon, J."""
    volume, pressure = RIG.volume(trace.theta), trace.mean
    after = np.roll(volume, -1), np.roll(pressure, -1)
    return 0.5 * float(np.sum(volume * after[1] - after[0] * pressure)) * -1.0


def test_indicated_torque_is_the_area_of_the_diagram(trace):
    """Polygon of 720 chords against the integral by the rate of the volume: 1e-3."""
    balance = brake_balance(trace, RIG)
    assert balance.indicated == pytest.approx(area(trace) / (4.0 * np.pi), rel=1e-3)
    twin = replace(RIG, firing_offsets=(0.0, 2.0 * np.pi))
    assert brake_balance(trace, twin).indicated == pytest.approx(2.0 * balance.indicated)
    assert (balance.brake, balance.shift, balance.friction_pressure) == (None, None, None)


def test_slope_is_that_of_turned_traces(trace):
    """Central difference of 0.2 deg: 1e-4."""
    step = np.radians(0.1)
    late, early = (brake_balance(trace.turned(turn), RIG).indicated for turn in (step, -step))
    assert brake_balance(trace, RIG).slope == pytest.approx((late - early) / (2 * step), rel=1e-4)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_each_cause_alone_closes_the_difference(trace, share):
    """Shift, gain and drop of the zero, each applied to the trace: 1e-6, the drop by chords 1 %."""
    indicated = brake_balance(trace, RIG).indicated
    balance = brake_balance(trace, RIG, share * indicated)
    assert brake_balance(trace.turned(balance.shift), RIG).indicated == pytest.approx(
        share * indicated, rel=1e-6
    )
    scaled = replace(trace, cycles=share * trace.cycles)
    assert brake_balance(scaled, RIG).indicated == pytest.approx(share * indicated)
    raised = replace(trace, cycles=trace.cycles - balance.friction_pressure * EXPANSION)
    assert brake_balance(raised, RIG).indicated == pytest.approx(share * indicated, rel=0.01)
    pegged = replace(trace, cycles=trace.cycles + 30e3)
    assert brake_balance(pegged, RIG).indicated == pytest.approx(indicated, rel=1e-9)


def test_a_brake_above_the_indicated_torque_is_an_error_of_the_trace(trace):
    indicated = brake_balance(trace, RIG).indicated
    brake_balance(trace, RIG, 0.99 * indicated).guarded()
    with pytest.raises(InputError) as caught:
        brake_balance(trace, RIG, 1.01 * indicated).guarded()
    text = str(caught.value)
    assert text.startswith("engine.brake_torque = ")
    for words in ("dead centre 0.", "gain, pressures times 1.010", "pegging that falls by"):
        assert words in text
    far = brake_balance(trace, RIG, 40.0 * indicated)
    assert far.shift is None
    with pytest.raises(InputError, match="none within 10 deg"):
        far.guarded()


def test_friction_is_what_the_brake_leaves(trace):
    torque = torque_from_pressure(trace, RIG, 157.08, 0.8)
    assert torque.mean == pytest.approx(0.8, abs=1e-9)


PRESSURE = 0.4 + 7.0 * np.exp(-(((THETA - 6.6) / 0.5) ** 2))
MOTORED = 0.4 + 6.0 * np.exp(-(((THETA - 2.0 * np.pi + np.radians(2.6)) / 0.5) ** 2))


def case_of(folder, extra):
    for name, values in (("p", PRESSURE), ("m", MOTORED)):
        rows = "\n".join(
            f"{float(a)!r},{float(p)!r}" for a, p in zip(np.degrees(THETA), values, strict=True)
        )
        (folder / f"{name}.csv").write_text(f"angle_deg,p_bar\n{rows}\n", encoding="utf-8")
    text = case_text(f'kind = "pressure"\nfile = "p.csv"\n{GEAR}{extra}')
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return read_case(folder / "case.toml")


def warnings(case):
    return [one.how for one in implausible(case, engine_torques(case))]


def test_a_case_states_what_its_pressure_indicates(tmp_path):
    case = case_of(tmp_path, 'brake_torque = "0.5 N m"\n')
    record = measurement_record(case)
    assert record is not None
    indicated = record["indicated_torque_Nm"]
    assert engine_torques(case)["idle"].mean == pytest.approx(0.5, abs=1e-9)
    volume = case.engine.displacement
    mep = 4e-3 * np.pi * (indicated - 0.5) / volume
    assert record["friction_mep_kPa"] == pytest.approx(mep)
    shown = dict(verification_tables.measurement(record))
    assert shown["brake torque"].split() == ["0.5", "N", "m"]
    assert shown["indicated torque"].split() == [f"{indicated:.4g}", "N", "m"]
    (line,) = measurement_words(case)
    assert line.startswith(f"indicated torque of p.csv: {indicated:.4g} N m, +")
    assert "with the dead centre 1 deg earlier; brake torque 0.5 N m" in line
    speed = case.load_cases[0].speed
    power = case_of(tmp_path, f'brake_power = "{0.5 * speed!r} W"\n')
    assert measurement_record(power)["brake_torque_Nm"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("extra", "words"),
    [
        ('brake_torque = "50 N m"\n', "engine.brake_torque = 50 N m, must be <"),
        ('brake_power = "9 kW"\n', "engine.brake_power = "),
    ],
)
def test_a_case_with_too_much_brake_is_refused(tmp_path, extra, words):
    with pytest.raises(InputError, match=words):
        engine_torques(case_of(tmp_path, extra))


def test_both_torque_and_power_are_refused(tmp_path):
    engine = f'kind = "pressure"\nfile = "p.csv"\n{GEAR}brake_torque = "1 N m"\n'
    with pytest.raises(InputError, match=r"engine\.brake_power = 2 kW, must be left out"):
        parse_case(case_text(f'{engine}brake_power = "2 kW"\n'), tmp_path)


def test_a_brake_power_needs_a_speed():
    engine = replace(RIG, brake_power=100.0)
    assert engine.brake(50.0) == 2.0
    with pytest.raises(InputError, match=r"load_case\.speed = 0 rpm, must be > 0 rpm"):
        engine.brake(0.0)
    assert replace(RIG, brake_torque=1.0).brake(0.0) == 1.0


def test_the_dead_centre_is_checked_by_the_motored_peak(tmp_path):
    """The motored peak leads the dead centre of the file by 2.6 deg, and by 0.6 deg once set."""
    motored = 'motored_file = "m.csv"\n'
    case = case_of(tmp_path, motored)
    assert measurement_record(case)["motored_lead_deg"] == pytest.approx(2.6, abs=1e-3)
    (one,) = (line for line in warnings(case) if "motored" in line)
    assert one.startswith("engine.motored_file: peak 2.6 deg before the dead centre, usually 0.4")
    case = case_of(tmp_path, f'{motored}dead_centre = "loss_angle"\n')
    assert measurement_record(case)["motored_lead_deg"] == pytest.approx(0.6, abs=1e-3)
    assert not [line for line in warnings(case) if "motored" in line]


def test_friction_beside_that_of_the_brake(tmp_path):
    case = case_of(tmp_path, 'brake_torque = "0.5 N m"\nfriction_pressure = "1 kPa"\n')
    (one,) = (line for line in warnings(case) if line.startswith("engine.friction_pressure"))
    assert "= 1 kPa, but engine.brake_torque = 0.5 N m: indicated less brake torque" in one
