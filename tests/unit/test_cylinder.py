"""The parts of the cylinder model, each against its definition, and what it refuses."""

from dataclasses import replace
from math import pi, radians, sqrt

import numpy as np
import pytest
from small_diesel import SMALL_DIESEL

from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank
from camwright.pipeline.engine.combustion import burnt_fraction, wiebe
from camwright.pipeline.engine.cylinder import CylinderEngine, LiftPoint
from camwright.pipeline.engine.heat_loss import Charge, film_coefficient, wall_area
from camwright.pipeline.engine.valves import (
    NEARLY_EQUAL,
    intake_valve,
    nozzle_flow,
    tappet_force,
    valve_train_torque,
)
from camwright.pipeline.engine.working_gas import AIR_AND_FUEL, Gas

ENGINE = CylinderEngine(
    bore=0.060,
    crank_radius=0.021,
    rod_length=0.073,
    compression_ratio=8.5,
    piston_mass=0.144,
    rod_mass=0.123,
)
DEGREES = np.radians(np.arange(720.0))


def rows(*pairs):
    return tuple(LiftPoint(angle=angle, lift=lift) for angle, lift in pairs)


def test_derived_measures_of_the_engine():
    assert ENGINE.displacement == pytest.approx(118.75e-6, rel=1e-4)  # 42 mm of stroke
    assert ENGINE.volume(0.0) * 7.5 == pytest.approx(ENGINE.displacement, rel=1e-12)
    assert ENGINE.volume(pi) == pytest.approx(8.5 * ENGINE.volume(0.0), rel=1e-12)
    assert ENGINE.reciprocating_mass == pytest.approx(0.144 + 0.123 / 3.0, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "pattern"),
    [
        ({"bore": 0.0}, "engine.bore"),
        ({"bore": float("nan")}, "engine.bore"),
        ({"intake_pressure": -1.0}, "engine.intake_pressure"),
        ({"piston_mass": -0.1}, "engine.piston_mass"),
        ({"compression_ratio": 1.0}, "compression_ratio = 1, must be > 1 and <= 40"),
        ({"compression_ratio": 41.0}, "compression_ratio"),
        ({"rod_length": 0.020}, "rod_length = 20 mm, must be > crank_radius"),
        ({"pin_offset": 0.053}, "rod_length"),
        ({"combustion_efficiency": 1.01}, "combustion_efficiency = 1.01, must be >= 0 and <= 1"),
        ({"ignition": "laser"}, 'engine.ignition = laser, must be "spark" or "compression"'),
        ({"heat_loss": "none"}, '"hohenberg" or "woschni"'),
        ({"friction_pressure": "open"}, "engine.friction_pressure"),
        ({"friction_pressure": -1.0}, "engine.friction_pressure = -0.001 kPa, must be >= 0"),
        ({"friction_pressure": float("nan")}, "engine.friction_pressure"),
        ({"intake_valve_close": -0.1}, "intake_valve_close"),
        ({"exhaust_valve_close": radians(1191.0)}, "exhaust_valve_close"),
        ({"spark": radians(25.0)}, "engine.spark = 25 deg, must be from 180 to 540 deg"),
        ({"spark": radians(210.0)}, "while the intake valve is shut"),
        ({"spark": radians(480.0)}, "while the exhaust valve is shut"),
        ({"burn_duration": radians(353.0)}, "burn_duration = 353 deg"),
        ({"firing_offsets": ()}, "firing_offsets"),
        ({"intake_lift_table": rows((0.0, 0.0), (1.0, 0.005), (2.0, 0.0))}, "3 rows"),
        ({"intake_lift_table": rows((0.0, 0.0), (1.0, 0.1), (0.9, 0.1), (2.0, 0.0))}, "increasing"),
        ({"intake_lift_table": rows((0.0, 0.0), (1.0, 0.1), (1.5, 0.1), (2.0, 0.1))}, "last lift"),
    ],
)
def test_impossible_engines_are_refused(changes, pattern):
    with pytest.raises(InputError, match=pattern):
        replace(ENGINE, **changes)


@pytest.mark.parametrize(
    ("angle", "lift", "pattern"),
    [
        (1.0, -0.1, "lift_point.lift = -100 mm, must be >= 0"),
        (float("nan"), 0.1, "lift_point.angle = nan"),
        (1.0, float("inf"), "lift_point.lift = inf"),
    ],
)
def test_impossible_rows_of_a_lift_table_are_refused(angle, lift, pattern):
    with pytest.raises(InputError, match=pattern):
        LiftPoint(angle=angle, lift=lift)


def test_slider_crank_dead_centres():
    linkage = SliderCrank(0.021, 0.073)
    assert linkage.stroke == pytest.approx(0.042, rel=1e-14)
    assert linkage.travel(0.0) == pytest.approx(0.0, abs=1e-17)
    assert linkage.travel(pi) == pytest.approx(0.042, rel=1e-14)
    offset = SliderCrank(0.021, 0.073, 0.004)
    assert offset.stroke > 0.042
    stretched = np.arcsin(0.004 / (0.021 + 0.073))
    assert offset.travel(stretched) == pytest.approx(0.0, abs=1e-16)
    assert offset.travel_rate(stretched) == pytest.approx(0.0, abs=1e-16)
    assert offset.travel(DEGREES).min() >= 0.0


@pytest.mark.parametrize("lengths", [(0.0, 1.0), (1.0, 1.0), (1.0, 1.5, 0.6), (1.0, np.inf)])
def test_slider_cranks_that_cannot_turn_are_refused(lengths):
    with pytest.raises(InputError):
        SliderCrank(*lengths)


def test_gas_energy_and_temperature_are_inverse():
    temperature = np.linspace(200.0, 3500.0, 50)
    back = AIR_AND_FUEL.temperature(AIR_AND_FUEL.energy(temperature))
    np.testing.assert_allclose(back, temperature, rtol=1e-14)
    rigid = Gas(heat_capacity_rise=0.0)
    assert rigid.temperature(rigid.energy(300.0)) == pytest.approx(300.0, rel=1e-15)
    assert rigid.gamma(300.0) == pytest.approx(1.4, rel=1e-15)


def test_gamma_falls_as_the_fits_of_the_literature():
    temperature = np.linspace(300.0, 2300.0, 41)
    egnell = 1.38 - 0.2 * np.exp(-900.0 / temperature)
    np.testing.assert_allclose(AIR_AND_FUEL.gamma(temperature), egnell, rtol=0.015)


def test_burnt_fraction_runs_from_zero_to_one_within_the_burn():
    start, end = 343.0, 423.0
    burnt = burnt_fraction(ENGINE, np.radians([0.0, start, 0.5 * (start + end), end, 500.0]))
    assert burnt[:2].tolist() == [0.0, 0.0]
    assert burnt[2] == pytest.approx(-np.expm1(-5.0 / 8.0) / -np.expm1(-5.0), rel=1e-12)
    np.testing.assert_allclose(burnt[3:], 1.0, rtol=1e-12)
    assert wiebe(0.5, 5.0, 2.0) == pytest.approx(burnt[2], rel=1e-12)


@pytest.mark.parametrize("engine", [ENGINE, replace(ENGINE, **SMALL_DIESEL)])
def test_burnt_fraction_grows_at_the_rate_of_wiebe(engine):
    """Derivative of each Wiebe burn by hand: a (m + 1) y^m exp(-a y^(m + 1)) / (1 - exp(-a))."""
    theta = np.radians(np.arange(351.5, 420.0, 1.0))
    past = theta - (engine.spark + engine.ignition_delay)
    burns = [(1.0 - engine.premixed_share, engine.burn_duration, engine.wiebe_m)]
    burns += [(engine.premixed_share, engine.premixed_duration, engine.premixed_m)]
    rate = np.zeros_like(theta)
    for share, duration, m in burns:
        y, a = past / duration, engine.wiebe_a
        inside = (y >= 0.0) & (y <= 1.0)
        reached = np.clip(y, 0.0, 1.0)
        slope = a * (m + 1.0) * reached**m * np.exp(-a * reached ** (m + 1.0)) / -np.expm1(-a)
        rate += np.where(inside, share / duration * slope, 0.0)
    step = 1e-6
    ahead, behind = burnt_fraction(engine, theta + step), burnt_fraction(engine, theta - step)
    np.testing.assert_allclose(rate, (ahead - behind) / (2 * step), atol=1e-7)


def test_premixed_fuel_burns_first():
    plain = replace(ENGINE, **(SMALL_DIESEL | {"premixed_share": 0.0}))
    mixed = replace(ENGINE, **SMALL_DIESEL)
    after = plain.spark + plain.ignition_delay + mixed.premixed_duration
    assert burnt_fraction(mixed, after) > burnt_fraction(plain, after) + 0.15
    assert burnt_fraction(mixed, 3.0 * pi) == pytest.approx(1.0, rel=1e-12)


def test_valve_lift_by_timing_and_by_table():
    valve = intake_valve(ENGINE)
    assert valve.lift(radians(110.0)) == pytest.approx(0.0055, rel=1e-14)
    assert not valve.lift(np.radians([220.0, 300.0, 719.0])).any()
    angles = np.radians(np.arange(0.0, 221.0, 10.0))
    table = rows(*zip(angles.tolist(), np.abs(valve.lift(angles)).tolist(), strict=True))
    table = (*table[:-1], replace(table[-1], lift=0.0))
    tabled = intake_valve(replace(ENGINE, intake_lift_table=table))
    # a pchip through 10 deg is second order at the top and the seats: 1 % of the lift
    np.testing.assert_allclose(tabled.lift(DEGREES), valve.lift(DEGREES), atol=5.5e-5)


def test_valve_that_opens_before_dead_centre_wraps():
    early = intake_valve(replace(ENGINE, intake_valve_open=radians(-15.0)))
    assert early.lift(radians(710.0)) > 0.0
    assert early.lift(radians(700.0)) == 0.0


def test_flow_area_is_the_curtain_until_the_port_chokes_it():
    valve = intake_valve(ENGINE)
    low = radians(20.0)
    assert valve.flow_area(low) == pytest.approx(0.6 * pi * 0.025 * valve.lift(low), rel=1e-12)
    port = 0.25 * pi * (0.85 * 0.025) ** 2
    assert valve.flow_area(radians(110.0)) == pytest.approx(0.6 * port, rel=1e-12)


def test_nozzle_chokes_at_the_critical_ratio():
    choked = nozzle_flow(2e5, 400.0, 0.2e5, 287.0, 1.4)
    assert nozzle_flow(2e5, 400.0, 0.9e5, 287.0, 1.4) == choked
    # 0.0404 p / sqrt(T) for air: the discharge every gas dynamics table gives; the straight part
    # near equal pressures takes NEARLY_EQUAL of it at most
    assert choked == pytest.approx(0.04042 * 2e5 / sqrt(400.0), rel=2e-3)
    assert nozzle_flow(2e5, 400.0, 2e5, 287.0, 1.4) == 0.0


def test_nozzle_follows_bernoulli_at_small_differences():
    difference = 20.0 * NEARLY_EQUAL
    flow = nozzle_flow(1e5, 300.0, 1e5 * (1.0 - difference), 287.0, 1.4)
    density = 1e5 / (287.0 * 300.0)
    # compressibility takes 1 %, the straight part 2.5 %
    assert flow == pytest.approx(sqrt(2.0 * density * difference * 1e5), rel=0.04)


def test_valve_train_torque_is_power_conserving_and_blind_to_the_rocker():
    torque = valve_train_torque(ENGINE, DEGREES)
    valve = intake_valve(ENGINE)
    fine = np.linspace(0.0, radians(110.0), 20001)
    force = tappet_force(ENGINE, valve, fine[1:])
    stored = 0.5 * 5884.0 * 0.0055**2 + 47.0 * 0.0055
    lift = valve.lift(fine)
    assert np.sum(force * np.diff(lift)) == pytest.approx(stored, rel=1e-3)
    np.testing.assert_allclose(
        valve_train_torque(replace(ENGINE, rocker_ratio=1.4), DEGREES), torque
    )
    assert torque[55] < 0.0 < torque[165]  # opening takes, closing gives back


def film(engine, speed, pressure, temperature, theta):
    theta = np.array([theta])
    charge = Charge(3.0e4, 380.0, float(engine.volume(radians(220.0))))
    return film_coefficient(engine, speed, theta, engine.volume(theta), charge)(
        0, pressure, temperature
    )


def test_hohenberg_coefficient_by_hand():
    volume = float(ENGINE.volume(2.0 * pi))
    by_hand = 130.0 * volume**-0.06 * 5.0**0.8 * 900.0**-0.4 * (2 * 0.042 * 25.0 + 1.4) ** 0.8
    got = film(ENGINE, 2.0 * pi * 25.0, 5e5, 900.0, 2.0 * pi)
    assert got == pytest.approx(by_hand, rel=1e-12)
    assert film(replace(ENGINE, heat_loss_factor=0.5), 50.0 * pi, 5e5, 900.0, 2.0 * pi) == (
        pytest.approx(0.5 * by_hand, rel=1e-12)
    )


def test_woschni_coefficient_by_hand():
    engine = replace(ENGINE, heat_loss="woschni")
    speed, piston = 50.0 * pi, 2.1
    # compression, before the spark: 2.28 c_m alone
    cold = 3.26 * 0.06**-0.2 * 200.0**0.8 * 600.0**-0.55 * (2.28 * piston) ** 0.8
    assert film(engine, speed, 2e5, 600.0, radians(300.0)) == pytest.approx(cold, rel=1e-12)
    # gas exchange: 6.18 c_m
    open_valve = 3.26 * 0.06**-0.2 * 100.0**0.8 * 600.0**-0.55 * (6.18 * piston) ** 0.8
    assert film(engine, speed, 1e5, 600.0, radians(600.0)) == pytest.approx(open_valve, rel=1e-12)
    # after the spark the pressure rise over the motored one stirs too
    start = float(engine.volume(radians(220.0)))
    motored = 3.0e4 * (start / float(engine.volume(radians(400.0)))) ** 1.32
    rise = 3.24e-3 * engine.displacement * 380.0 / (3.0e4 * start) * (7e5 - motored)
    fired = 3.26 * 0.06**-0.2 * 700.0**0.8 * 1800.0**-0.55 * (2.28 * piston + rise) ** 0.8
    assert film(engine, speed, 7e5, 1800.0, radians(400.0)) == pytest.approx(fired, rel=1e-12)


def test_wall_area_at_the_dead_centres():
    crown = 0.25 * pi * 0.06**2
    at_top, at_bottom = wall_area(ENGINE, np.array([0.0, pi]))
    assert at_top == pytest.approx(2.0 * crown + pi * 0.06 * 0.042 / 7.5, rel=1e-12)
    assert at_bottom - at_top == pytest.approx(pi * 0.06 * 0.042, rel=1e-12)
