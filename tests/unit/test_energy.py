"""Torque to energy to lift, and what the spring refuses."""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.energy import (
    lift_from_torque,
    spring_deflection,
    stored_energy,
    without_mean,
)
from camwright.geometry.errors import InputError

THETA = uniform_turn(720)
TORQUE = 20 * np.sin(THETA - 1) + 15 * np.sin(2 * THETA) + 8 * np.cos(5 * THETA)
RATE, PRELOAD = 24.2e3, 242.0


def held_by_spring(lift):
    """Energy P s + k s^2 / 2 beyond that of the preload, J."""
    return lift * (PRELOAD + 0.5 * RATE * lift)


def integral(theta):
    """Of the torque above, from no particular angle."""
    return -20 * np.cos(theta - 1) - 7.5 * np.cos(2 * theta) + 1.6 * np.sin(5 * theta)


def test_removes_and_tells_the_mean():
    torque, mean = without_mean(TORQUE + 3.0)
    assert mean == pytest.approx(3.0, rel=1e-15)
    np.testing.assert_allclose(torque, TORQUE, rtol=0, atol=1e-13)


def test_energy_is_the_integral_above_its_least():
    """The quintic through 720 samples of 5 harmonics is 1e-13 J away from the function."""
    energy, gain = stored_energy(THETA, TORQUE)
    dense = integral(np.linspace(0, 2 * np.pi, 2_000_001))
    np.testing.assert_allclose(energy, integral(THETA) - dense.min(), rtol=0, atol=2e-11)
    assert abs(gain) < 1e-13


def test_least_energy_lies_between_samples():
    """12 samples, the least energy midway: the nearest samples hold (1 - cos(pi/12)) J more."""
    theta = uniform_turn(12)
    energy, _ = stored_energy(theta, np.sin(theta - np.pi / 12))
    assert energy.min() == pytest.approx(1 - np.cos(np.pi / 12), rel=2e-3)


def test_deflection_holds_the_energy():
    energy = np.geomspace(1e-18, 100, 50)
    np.testing.assert_allclose(
        held_by_spring(spring_deflection(energy, RATE, PRELOAD)), energy, rtol=1e-15
    )
    assert spring_deflection(0.0, RATE, 0.0) == 0.0


def test_initial_energy_lifts_the_whole_curve():
    """E0 = P x + k x^2 / 2 at the least lift, solved here by the quadratic formula."""
    plain = lift_from_torque(THETA, TORQUE, RATE, PRELOAD)
    raised = lift_from_torque(THETA, TORQUE, RATE, PRELOAD, initial_energy=8.0)
    least = (np.sqrt(PRELOAD**2 + 2 * RATE * 8.0) - PRELOAD) / RATE
    assert plain.lowest.value == pytest.approx(0.0, abs=1e-12)
    assert raised.lowest.value == pytest.approx(least, abs=1e-12)
    np.testing.assert_allclose(
        held_by_spring(raised.values) - held_by_spring(plain.values),
        8.0,
        rtol=1e-13,
    )


def test_initial_energy_stands_in_for_the_preload():
    lift = lift_from_torque(THETA, TORQUE, RATE, 0.0, initial_energy=1.0)
    assert lift.lowest.value == pytest.approx(np.sqrt(2 / RATE), rel=1e-9)
    with pytest.raises(InputError, match=r"spring.preload"):
        lift_from_torque(THETA, TORQUE, RATE, 0.0)


def test_keeps_the_phase_of_the_torque():
    """The least lift is where the torque turns from unloading to loading, not at angle 0."""
    lift = lift_from_torque(THETA, np.sin(THETA - 2.0), RATE, PRELOAD)
    assert lift.lowest.theta == pytest.approx(2.0, abs=1e-6)


@pytest.mark.parametrize("mean", [1e-6, -0.2, 3.0])
def test_refuses_torque_with_a_mean(mean):
    with pytest.raises(InputError, match=r"cam_torque.mean") as caught:
        lift_from_torque(THETA, TORQUE - TORQUE.mean() + mean, RATE, PRELOAD)
    assert caught.value.value == pytest.approx(mean, rel=1e-6)


@pytest.mark.parametrize(
    ("rate", "preload", "energy", "field"),
    [
        (0.0, 242.0, 0.0, "spring.rate"),
        (-1.0, 242.0, 0.0, "spring.rate"),
        (np.nan, 242.0, 0.0, "spring.rate"),
        (1.0, -242.0, 0.0, "spring.preload"),
        (1.0, np.nan, 0.0, "spring.preload"),
        (1.0, 242.0, -1.0, "spring.initial_energy"),
        (1.0, 242.0, np.nan, "spring.initial_energy"),
    ],
)
def test_refuses_a_spring(rate, preload, energy, field):
    with pytest.raises(InputError) as caught:
        lift_from_torque(THETA, TORQUE, rate, preload, energy)
    assert caught.value.field == field


def test_refuses_broken_torque():
    with pytest.raises(InputError, match="cam_torque"):
        stored_energy(THETA, np.where(THETA == 0, np.nan, TORQUE))
    with pytest.raises(InputError, match="cam_torque"):
        stored_energy(THETA, TORQUE[1:])
    with pytest.raises(InputError, match="theta"):
        stored_energy(THETA[::-1], TORQUE)
    with pytest.raises(InputError, match=r"spring.energy"):
        spring_deflection(-1e-9, RATE, PRELOAD)
