"""The Honda GX120 at idle and the 800 rpm engine of the papers.

Cardoso, Fael, Gaspar, Espirito-Santo, Energies 2025, 18, 3256 (measured idle, sec. 3) and
Designs 2024, 8, 47 (table 1). Tuned to the measured torque: intake pressure 30.5 kPa (28.2 kPa at
800 rpm), spark, burn duration, combustion efficiency. Not tuned: the valves, the heat loss, the
masses. The effective inertia of 0.0139 kg m2 follows from the published speeds and torques; the
printed one, 2.603e-3, contradicts both by a factor of five.
"""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from cycle_pressures import fmep, gross_imep

from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cycle
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle

GX120 = CylinderEngine(
    bore=0.060,
    crank_radius=0.021,
    rod_length=0.073,
    compression_ratio=8.5,
    piston_mass=0.144,
    rod_mass=0.123,
    intake_pressure=30.5e3,
    spark=radians(335.0),
    burn_duration=radians(80.0),
    combustion_efficiency=0.9,
)
IDLE_800 = replace(
    GX120,
    crank_radius=0.022,
    intake_pressure=28.2e3,
    spark=radians(345.0),
    burn_duration=radians(65.0),
    combustion_efficiency=0.85,
)
INERTIA = 0.0139


def stroke_means(torque):
    return torque.reshape(4, 180).mean(axis=1)


def swing(torque):
    """Energy stored and given back over the cycle by the torque about its mean, J."""
    return np.cumsum(torque - torque.mean()) * CYCLE_ANGLE / torque.size


@pytest.fixture(scope="module")
def idle():
    return working_cycle(GX120, 157.08)


@pytest.fixture(scope="module")
def slow_idle():
    return working_cycle(IDLE_800, 83.8)


def test_measured_torque_of_the_gx120(idle):
    """Published: peak 25, amplitude 29.79, standard deviation 6.25 N m.

    10 % is asked of a tuned model; the peak needs half of it, the rest is nearer.
    """
    torque = torque_from_cycle(idle)
    assert torque.peak == pytest.approx(25.0, rel=0.10)
    assert torque.peak_to_peak == pytest.approx(29.79, rel=0.06)
    assert torque.std == pytest.approx(6.25, rel=0.03)
    assert abs(int(torque.total.argmax()) - 399) <= 5


def test_cylinder_pressure_and_friction_of_the_gx120_are_ordinary(idle):
    """Against an independent single-zone model of the same engine: 7.7, 2.38 and 1.65 bar."""
    assert idle.pressure.max() == pytest.approx(7.7e5, rel=0.04)
    assert gross_imep(idle) == pytest.approx(2.38e5, rel=0.04)
    assert fmep(idle) == pytest.approx(1.65e5, rel=0.03)


def test_measured_speed_of_the_gx120(idle):
    """Published: standard deviation 3.74, amplitude 11.57 rad/s about 151 rad/s."""
    energy = swing(torque_from_cycle(idle).total)
    assert np.ptp(energy) == pytest.approx(23.8, rel=0.04)
    speed = np.sqrt(151.0**2 + 2.0 / INERTIA * (energy - energy.mean()))
    assert speed.std() == pytest.approx(3.74, rel=0.01)
    assert np.ptp(speed) == pytest.approx(11.57, rel=0.01)
    # 145 to 155 rad/s are printed, the least at firing top dead centre
    assert speed.min() == pytest.approx(145.0, rel=0.01)
    assert abs(int(speed.argmin()) - 363) <= 5


def test_printed_inertia_contradicts_the_printed_speeds(idle):
    energy = swing(torque_from_cycle(idle).total)
    speed_squared = 151.0**2 + 2.0 / 2.603e-3 * (energy - energy.mean())
    assert np.ptp(np.sqrt(np.maximum(speed_squared, 0.0))) > 4.0 * 11.57


def test_torques_of_the_800_rpm_idle(slow_idle):
    """Against the independent model: peak 22, least -6.5, std 5.65 N m, 6.3 bar, 1507 N.

    The least torque, at the end of the compression, is 9 % apart: within the 10 % asked of a tuned
    model.
    """
    torque = torque_from_cycle(slow_idle)
    assert torque.peak == pytest.approx(22.0, rel=0.04)
    assert torque.total.min() == pytest.approx(-6.5, rel=0.10)
    assert torque.std == pytest.approx(5.65, rel=0.04)
    assert np.ptp(swing(torque.total)) == pytest.approx(20.0, rel=0.04)
    assert slow_idle.pressure.max() == pytest.approx(6.3e5, rel=0.045)
    assert fmep(slow_idle) == pytest.approx(1.2e5, rel=0.02)
    force = (slow_idle.pressure.max() - 101.3e3) * IDLE_800.piston_area
    assert force == pytest.approx(1507.0, rel=0.045)


def test_valve_inertia_and_pumping_torque_are_of_one_magnitude(slow_idle):
    """The 2024 paper says so of its engine; 0.29, 0.41 and 3.6 N m in the independent model.

    The mean over the intake stroke holds friction too and depends on how fast the residual gas
    blows back, which is not published: 15 %.
    """
    torque = torque_from_cycle(slow_idle)
    assert np.abs(torque.components["valve_train"]).max() == pytest.approx(0.29, rel=0.025)
    assert np.abs(torque.components["inertia"]).max() == pytest.approx(0.41, rel=0.035)
    assert stroke_means(torque.total)[0] == pytest.approx(-3.6, rel=0.15)


def test_expansion_carries_fifteen_times_the_other_strokes_at_full_load():
    """Designs 2024, sec. 2: about fifteen times the mean of the other strokes.

    Stroke means of the independent model: -0.17, -9.5, 51.24, -0.02 N m, friction left out.
    """
    full = replace(
        IDLE_800,
        intake_pressure=98e3,
        spark=radians(340.0),
        burn_duration=radians(50.0),
        combustion_efficiency=0.95,
        friction_pressure=0.0,
    )
    means = stroke_means(torque_from_cycle(working_cycle(full, 83.8)).total)
    assert means[1] == pytest.approx(-9.5, rel=0.02)
    assert means[2] == pytest.approx(51.24, rel=0.01)
    others = np.abs(np.delete(means, 2)).mean()
    assert means[2] / others == pytest.approx(15.0, rel=0.10)  # "about" is all that is printed


def test_displacement_is_the_makers():
    """118 cm3 by the maker; 124.4 follows from the crank radius printed in 2024."""
    assert GX120.displacement == pytest.approx(118e-6, rel=0.01)
    assert IDLE_800.displacement == pytest.approx(pi * 0.03**2 * 0.044, rel=1e-12)
