"""Energy synthesis: closure, conservation, the torque given back, scaling."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.energy import lift_from_torque, stored_energy, without_mean
from camwright.geometry.periodic_spline import periodic_quintic
from camwright.geometry.pitch_curve import PitchCurve

RATE, PRELOAD = 24.2e3, 242.0


def held_by_spring(lift):
    """Energy P s + k s^2 / 2 beyond that of the preload, J."""
    return lift * (PRELOAD + 0.5 * RATE * lift)


def harmonic_torque(theta, highest, peak=40.0):
    """Harmonics of amplitude 1/k and scattered phase, N m."""
    orders = np.arange(1, highest + 1)
    phases = np.random.default_rng(highest).uniform(0, 2 * np.pi, highest)
    torque = np.cos(np.multiply.outer(theta, orders) + phases) @ (1 / orders)
    return torque * (peak / np.abs(torque).max())


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(12, 900),
    peak=st.floats(1e-3, 300),
    rate=st.floats(1e3, 1e6),
    preload=st.floats(20, 2e3),
)
def test_any_torque_of_zero_mean_closes(seed, count, peak, rate, preload):
    """Noise of any strength: 1e-9 m is the demand, round-off what is left of it."""
    noise = np.random.default_rng(seed).uniform(-peak, peak, count)
    lift = lift_from_torque(uniform_turn(count), without_mean(noise)[0], rate, preload)
    assert lift.closure <= 1e-9
    assert lift.closure <= 1e-12 * max(lift.stroke, 1e-3)


def test_closure_is_that_of_the_integral():
    """A mean within tolerance leaves 2 pi mean / F at the start: the closure is measured."""
    theta = uniform_turn(720)
    mean = 3e-11
    lift = lift_from_torque(theta, harmonic_torque(theta, 5) + mean, RATE, PRELOAD)
    force = PRELOAD + RATE * float(lift(0.0))
    assert lift.closure == pytest.approx(2 * np.pi * mean / force, rel=1e-2, abs=0)


@pytest.mark.parametrize("initial_energy", [0.0, 8.0])
def test_spring_holds_the_stored_energy(initial_energy):
    """At the samples by the closed form: 1e-9 is the demand, 1e-13 is met."""
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 20))[0]
    lift = lift_from_torque(theta, torque, RATE, PRELOAD, initial_energy)
    energy, _ = stored_energy(theta, torque)
    held = held_by_spring(lift.values) - initial_energy
    np.testing.assert_allclose(held, energy, rtol=0, atol=1e-13 * energy.max())


@pytest.mark.parametrize("highest", [5, 12])
def test_spring_holds_the_work_of_the_torque_between_samples(highest):
    """Work of the torque by its own integral, against the spline's spring energy: 1e-9."""
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, highest))[0]
    lift = lift_from_torque(theta, torque, RATE, PRELOAD)
    work, _ = periodic_quintic(torque).antiderivative()
    middle = theta + np.pi / 720
    held = held_by_spring(lift(middle)) - held_by_spring(lift(0.0))
    np.testing.assert_allclose(held, work(middle), rtol=0, atol=1e-9 * np.ptp(held))


def test_torque_is_given_back_to_sixth_order():
    """F s' at the samples misses the target by order h^6; 30 harmonics at 720 by < 1e-7."""
    misses = []
    for count in (180, 360, 720):
        theta = uniform_turn(count)
        torque = without_mean(harmonic_torque(theta, 8))[0]
        lift = lift_from_torque(theta, torque, RATE, PRELOAD)
        delivered = (PRELOAD + RATE * lift(theta)) * lift(theta, 1)
        misses.append(np.abs(delivered - torque).max() / 40.0)
    assert misses[-1] < 1e-9
    assert np.log2(misses[0] / misses[1]) > 5.5
    assert np.log2(misses[1] / misses[2]) > 5.5

    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 30))[0]
    lift = lift_from_torque(theta, torque, RATE, PRELOAD)
    delivered = (PRELOAD + RATE * lift(theta)) * lift(theta, 1)
    np.testing.assert_allclose(delivered, torque, rtol=0, atol=1e-7 * 40.0)


def test_cam_returns_what_it_takes():
    """Work of the spring's torque over one turn, free of friction: 1e-9 of the energy kept."""
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 20))[0]
    lift = lift_from_torque(theta, torque, RATE, PRELOAD)
    delivered = (PRELOAD + RATE * lift(theta)) * lift(theta, 1)
    taken = delivered.clip(min=0).mean() * 2 * np.pi
    assert abs(delivered.mean() * 2 * np.pi) <= 1e-9 * taken


def test_no_torque_no_lift():
    theta = uniform_turn(360)
    lift = lift_from_torque(theta, np.zeros(360), RATE, PRELOAD)
    assert (lift.values == 0).all()
    assert lift.stroke == 0.0


@pytest.mark.parametrize("scale", [1e-2, 3.0, 50.0])
def test_scaling_spring_and_torque_leaves_the_cam(scale):
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 20))[0]
    plain = lift_from_torque(theta, torque, RATE, PRELOAD)
    scaled = lift_from_torque(theta, scale * torque, scale * RATE, scale * PRELOAD)
    np.testing.assert_allclose(scaled.values, plain.values, rtol=1e-12, atol=1e-12 * plain.stroke)
    angle = np.linspace(0, 2 * np.pi, 333)
    one, two = (PitchCurve(lift, 0.05).curvature(angle) for lift in (plain, scaled))
    np.testing.assert_allclose(two, one, rtol=1e-8)


def test_twice_the_torque_stores_twice_the_energy():
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 20))[0]
    one, two = stored_energy(theta, torque)[0], stored_energy(theta, 2 * torque)[0]
    np.testing.assert_allclose(two, 2 * one, rtol=1e-12, atol=1e-12)


def test_marching_does_not_close_where_the_integral_does():
    """Forward Euler, as published, over-stores k dr^2 / 2 a step; at 0.5 deg it ends 0.2-2 mm off.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256.
    """
    theta = uniform_turn(720)
    torque = without_mean(harmonic_torque(theta, 5))[0]
    exact = lift_from_torque(theta, torque, RATE, PRELOAD)
    start = int(np.argmin(exact.values))
    lift = exact.values[start]
    for moment in np.roll(torque, -start):
        lift += moment / (PRELOAD + RATE * lift) * (2 * np.pi / 720)
    assert 2e-4 < lift - exact.values[start] < 2e-3
    assert exact.closure < 1e-15
