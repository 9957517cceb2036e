"""Torque as the sum of its parts."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from cycle_pressures import fmep, net_imep

from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.case import load_case_torque
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.engine import indicated_cycle_solver
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine
from camwright.pipeline.engine.engine_torque import (
    torque_from_csv,
    torque_from_cycle,
    torque_from_cylinder,
)
from camwright.pipeline.torque.torque import Torque, together, uniform_cycle

ENGINE = CylinderEngine(
    bore=0.060,
    crank_radius=0.021,
    rod_length=0.073,
    compression_ratio=8.5,
    piston_mass=0.144,
    rod_mass=0.123,
)
SPEED = 157.08
CASES = Path(__file__).parents[2] / "cases"


def uniform(count):
    return np.arange(count) * CYCLE_ANGLE / count


@pytest.fixture(scope="module")
def cycle():
    return indicated_cycle_solver.working_cycle(ENGINE, SPEED)


@pytest.fixture(scope="module")
def torque(cycle):
    return torque_from_cycle(cycle)


def test_total_is_the_sum_of_the_parts(torque):
    assert list(torque.components) == ["gas", "inertia", "valve_train", "friction"]
    np.testing.assert_array_equal(torque.total, sum(torque.components.values()))
    assert torque.theta.shape == (720,)


def test_arrays_and_components_cannot_be_written_to(torque):
    with pytest.raises(ValueError, match="read-only"):
        torque.components["gas"][0] = 1.0
    with pytest.raises(TypeError):
        torque.components["gas"] = torque.total


def test_figures_of_a_known_torque():
    theta = uniform(360)
    torque = Torque(theta, {"gas": 3.0 + 2.0 * np.sin(theta)})
    assert torque.mean == pytest.approx(3.0, abs=1e-14)
    assert torque.std == pytest.approx(np.sqrt(2.0), rel=1e-12)
    assert torque.peak_to_peak == pytest.approx(4.0, rel=1e-3)
    assert torque.mean * CYCLE_ANGLE == pytest.approx(12.0 * np.pi, rel=1e-14)


def test_throughput_is_what_drives_or_loads_the_shaft_in_the_mean():
    theta = uniform_cycle(12)
    wave = np.sin(theta)
    parts = {"gas": 3.0 + wave, "belt": np.full(12, 1.0), "inertia": wave, "pump": -5.0 + wave}
    assert Torque(theta, parts).throughput == pytest.approx(5.0)
    assert Torque(theta, {"gas": parts["gas"]}).without_mean().throughput == pytest.approx(3.0)


def test_mean_is_taken_away_as_a_steady_load():
    theta = uniform(360)
    once = Torque(theta, {"gas": 3.0 + np.sin(theta)}).without_mean()
    assert once.mean == pytest.approx(0.0, abs=1e-14)
    np.testing.assert_allclose(once.components["load"], -3.0, rtol=1e-14)
    twice = replace(once, components={**once.components, "gas": 5.0 + np.sin(theta)})
    np.testing.assert_allclose(twice.without_mean().components["load"], -5.0, rtol=1e-14)


def test_resampling_keeps_the_parts_and_their_sum(torque):
    fine = torque.resampled(2880)
    np.testing.assert_allclose(fine.total[::4], torque.total, atol=1e-11)
    assert fine.mean * CYCLE_ANGLE == pytest.approx(torque.mean * CYCLE_ANGLE, abs=1e-2)
    assert torque.resampled(720) is torque


def test_every_second_angle_keeps_its_values_exactly():
    """An inertia of zero at a dead centre stays zero: below it the crank motion is refused."""
    theta = uniform(720)
    inertia = np.maximum(np.sin(theta), 0.0) ** 2
    half = Torque(theta, {"gas": np.sin(3.0 * theta)}, inertia).resampled(360)
    np.testing.assert_array_equal(half.varying_inertia, inertia[::2])
    np.testing.assert_array_equal(half.total, np.sin(3.0 * theta)[::2])


@pytest.mark.parametrize(
    ("theta", "parts"),
    [
        (uniform(720)[::-1], {"gas": np.zeros(720)}),
        (uniform(720) / 2.0, {"gas": np.zeros(720)}),
        (uniform(720), {"gas": np.zeros(719)}),
        (uniform(720), {"gas": np.full(720, np.nan)}),
        (uniform(720), {}),
        (uniform(8), {"gas": np.zeros(8)}),
    ],
)
def test_what_is_no_cycle_is_refused(theta, parts):
    with pytest.raises(InputError, match="torque"):
        Torque(theta, parts)


def test_closing_friction_brings_the_mean_to_zero(torque):
    assert abs(torque.mean) < 1e-12
    assert np.ptp(torque.components["friction"]) == 0.0
    assert torque.components["friction"][0] < 0.0


def test_given_friction_pressure_leaves_the_brake_torque(cycle):
    loaded = replace(cycle, engine=replace(ENGINE, friction_pressure=1.0e5))
    torque = torque_from_cycle(loaded)
    expected = (net_imep(loaded) - 1.0e5) * ENGINE.displacement / CYCLE_ANGLE
    assert fmep(loaded) == pytest.approx(1.0e5, rel=1e-12)
    assert torque.mean == pytest.approx(expected, abs=1e-6)  # the springs' mean on 1 deg


def test_friction_cannot_close_the_balance_of_a_motored_engine():
    with pytest.raises(InputError, match="the cycle itself needs"):
        torque_from_cylinder(replace(ENGINE, combustion_efficiency=0.0), SPEED)


def test_dipper_drags_about_bottom_dead_centre_alone(cycle):
    dipped = torque_from_cycle(replace(cycle, engine=replace(ENGINE, dipper_area=1e-4)))
    drag = dipped.components["dipper"]
    # 1/2 rho c_d A (r omega)^2 r in full dip
    expected = -0.5 * 870.0 * 1.2 * 1e-4 * (0.035 * SPEED) ** 2 * 0.035
    np.testing.assert_allclose(drag[[180, 540]], expected, rtol=1e-12)
    assert not drag[np.r_[0:139, 222:499, 582:720]].any()
    assert abs(dipped.mean) < 1e-12


def test_cylinders_add_up_in_their_firing_order(cycle, torque):
    four = replace(ENGINE, firing_offsets=tuple(np.pi * np.array([0.0, 1.0, 2.0, 3.0])))
    inline = torque_from_cycle(replace(cycle, engine=four))
    shifts = [np.roll(torque.total, 180 * k) for k in range(4)]
    np.testing.assert_allclose(inline.total, sum(shifts), atol=1e-11)
    order = np.abs(np.fft.rfft(inline.total))
    order[::4] = 0.0
    assert order.max() < 1e-9 * np.abs(np.fft.rfft(torque.total)).max()


def test_an_odd_firing_offset_delays_the_torque(cycle, torque):
    late = torque_from_cycle(replace(cycle, engine=replace(ENGINE, firing_offsets=(np.pi / 2,))))
    np.testing.assert_allclose(late.total, np.roll(torque.total, 90), atol=1e-11)


def test_measured_torque_comes_back_on_whole_degrees(tmp_path, torque):
    path = tmp_path / "torque.csv"
    table = zip(np.degrees(torque.theta).tolist(), torque.total.tolist(), strict=True)
    text = "".join(f"{angle!r},{value!r}\n" for angle, value in table)
    path.write_text("crank_angle_deg,torque_Nm\n" + text)
    measured = torque_from_csv(path)
    np.testing.assert_allclose(measured.total, torque.total, atol=1e-9)
    assert list(measured.components) == ["measured"]


def test_a_cycle_that_does_not_settle_raises(monkeypatch):
    monkeypatch.setattr(indicated_cycle_solver, "CYCLES_MAX", 2)
    with pytest.raises(CamError, match="did not become periodic within 2 cycles"):
        torque_from_cylinder(ENGINE, SPEED)


@pytest.mark.parametrize("speed", [0.0, -157.0, 9.9, 2020.0, np.nan])
def test_speeds_out_of_range_are_refused(speed):
    with pytest.raises(InputError, match="crank_speed"):
        torque_from_cylinder(ENGINE, speed)


def test_torque_of_a_case_is_kept_between_runs(tmp_path, monkeypatch):
    """Read back to the bit, and not computed again."""
    monkeypatch.delenv(disk_cache.OFF, raising=False)
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path))
    case = read_case(CASES / "gx120.toml")
    first = engine_torques(case)["idle"]
    monkeypatch.setattr(load_case_torque, "torque_from_cylinder", None)
    second = engine_torques(case)["idle"]
    computed = torque_from_cylinder(case.engine, case.load_cases[0].speed)
    for torque in (first, second):
        assert list(torque.components) == list(computed.components)
        np.testing.assert_array_equal(torque.total, computed.total)
        np.testing.assert_array_equal(torque.varying_inertia, computed.varying_inertia)
        np.testing.assert_array_equal(torque.theta, computed.theta)


@pytest.mark.parametrize("count", [360, 240, 90, 77])
def test_resampled_inertia_is_not_negative(count):
    """It vanishes at the dead centres, where a spline may fall below zero by round-off."""
    varying = torque_from_cylinder(ENGINE, SPEED).resampled(count).varying_inertia
    assert varying.min() >= 0.0


@pytest.mark.parametrize("measured", ["longer", "shorter", "both"])
def test_the_error_bars_of_two_machines_on_a_shaft_are_added(measured):
    """Over the longer cycle; the bar of the machine of the shorter one recurs."""

    def made(span, bar):
        theta = uniform_cycle(72, span)
        return Torque(theta, {"gas": np.sin(theta)}, None, bar * np.ones(72) if bar else None, span)

    short = made(2.0 * np.pi, 0.2 if measured != "longer" else 0.0)
    long = made(4.0 * np.pi, 0.5 if measured != "shorter" else 0.0)
    bar = together(long, short).error_bar
    expected = {"longer": 0.5, "shorter": 0.2, "both": 0.7}[measured]
    np.testing.assert_allclose(bar, expected, rtol=1e-12)
    assert together(made(2.0 * np.pi, 0.0), made(4.0 * np.pi, 0.0)).error_bar is None
