"""Work of the follower system over a turn: what the cam gives, the spring or the guides have."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.energy import lift_from_torque, stored_energy, without_mean
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    turn_integral,
)
from camwright.pipeline.follower.spring import Spring

SPRING = Spring(rate=24.2e3, preload=242.0)
SYSTEM = FollowerSystem(0.175, SPRING, 0.08, 0.03, 0.04, 0.2)
FREE = replace(SYSTEM, friction_a=0.0, friction_b=0.0)
SPEED = 75.0


def wavy_lift(count, seed=7):
    """A lift without symmetry: six harmonics of random phase, from zero."""
    rng = np.random.default_rng(seed)
    theta = uniform_turn(count)
    order = np.arange(1, 7)[:, None]
    phase = rng.uniform(0.0, 2 * np.pi, (6, 1))
    wave = (np.cos(order * theta + phase) / order**2.5).sum(axis=0)
    return Lift(theta, 0.012 * (wave - wave.min()))


def spring_store(lift):
    return 242.0 * lift.stroke + 0.5 * 24.2e3 * lift.stroke**2


@pytest.mark.parametrize("offset", [0.0, 0.012])
@pytest.mark.parametrize("positions", [180, 720, 1000])
def test_friction_free_cam_returns_what_it_takes(offset, positions):
    """1e-9 of the stored energy; the trapezoidal rule is spectral on a smooth lift."""
    lift = wavy_lift(720)
    theta = uniform_turn(positions)
    loads = follower_loads(PitchCurve(lift, 0.05, offset), FREE, SPEED, theta)
    assert not loads.separated.any()
    assert abs(turn_integral(loads.theta, loads.cam_torque)) <= 1e-9 * spring_store(lift)


@pytest.mark.parametrize("offset", [0.0, 0.012, -0.012])
def test_cam_work_is_the_heat_of_the_guides(offset):
    """1e-6 is asked; the identity holds angle by angle, so 1e-9 is kept."""
    theta = uniform_turn(720)
    loads = follower_loads(PitchCurve(wavy_lift(720), 0.05, offset), SYSTEM, SPEED, theta)
    rate = 0.04 * np.abs(loads.reaction_a) + 0.2 * np.abs(loads.reaction_b)
    heat = float(np.sum(rate * np.abs(loads.lift_slope)) * 2 * np.pi / 720)
    assert heat > 0.1
    assert turn_integral(loads.theta, loads.cam_torque) == pytest.approx(heat, rel=1e-9)
    assert loads.friction_loss == pytest.approx(heat, rel=1e-12)
    assert loads.friction_power.mean() * 2 * np.pi / SPEED == pytest.approx(heat, rel=1e-12)


def test_heat_is_the_same_on_finer_angles():
    """|s'| has corners only where s' itself is zero and F_t with it: the rule stays spectral."""
    pitch = PitchCurve(wavy_lift(720), 0.05)
    heat = [
        follower_loads(pitch, SYSTEM, SPEED, uniform_turn(n)).friction_loss for n in (720, 7200)
    ]
    assert heat[0] == pytest.approx(heat[1], rel=1e-7)


def test_quasi_static_torque_is_the_one_the_lift_was_made_from():
    """At rest and without friction F_a s' gives the torque back: 1e-6 of its peak."""
    theta = uniform_turn(720)
    torque, _ = without_mean(20.0 * np.sin(theta) + 12.0 * np.cos(2 * theta + 1.0))
    lift = lift_from_torque(theta, torque, SPRING.rate, SPRING.preload)
    loads = follower_loads(PitchCurve(lift, 0.05), FREE, 0.0, theta)
    np.testing.assert_allclose(loads.cam_torque, torque, atol=1e-6 * np.abs(torque).max())
    energy, _ = stored_energy(theta, torque)
    held = 242.0 * lift.values + 0.5 * 24.2e3 * lift.values**2
    np.testing.assert_allclose(held, energy, atol=1e-9 * energy.max())


def test_power_balance_at_every_angle_with_inertia():
    """Cam power less heat is the rate of spring and kinetic energy; central differences, 1e-6."""
    pitch = PitchCurve(wavy_lift(720), 0.05)
    theta, step = uniform_turn(90), 1e-4
    loads = follower_loads(pitch, SYSTEM, SPEED, theta)

    def energy(angle):
        s, slope = pitch.lift.derivatives(angle, 1)
        return 242.0 * s + 0.5 * 24.2e3 * s**2 + 0.5 * 0.175 * (slope * SPEED) ** 2

    rate = (energy(theta + step) - energy(theta - step)) / (2 * step)
    given = loads.cam_torque - loads.friction_force * np.abs(loads.lift_slope)
    np.testing.assert_allclose(given, rate, atol=1e-6 * np.abs(rate).max())


def test_more_friction_more_heat_and_steeper_cam_more_side_force():
    theta = uniform_turn(360)
    lift = wavy_lift(720)
    heat = [
        follower_loads(
            PitchCurve(lift, 0.05), replace(SYSTEM, friction_b=mu), SPEED, theta
        ).friction_loss
        for mu in (0.0, 0.1, 0.2, 0.3)
    ]
    assert (np.diff(heat) > 0.0).all()
    side = [
        np.abs(follower_loads(PitchCurve(lift, r), SYSTEM, SPEED, theta).tangential_force).max()
        for r in (0.08, 0.05, 0.04)
    ]
    assert (np.diff(side) > 0.0).all()


def test_scaling_spring_mass_and_friction_free_load():
    """Doubling k, P and m doubles every force and leaves the angles alone."""
    theta = uniform_turn(360)
    pitch = PitchCurve(wavy_lift(720), 0.05)
    twice = replace(SYSTEM, mass=0.35, spring=Spring(rate=48.4e3, preload=484.0))
    one, two = (follower_loads(pitch, system, SPEED, theta) for system in (SYSTEM, twice))
    for name in ("normal_force", "reaction_a", "friction_force_b", "cam_torque"):
        np.testing.assert_allclose(getattr(two, name), 2 * getattr(one, name), rtol=1e-13)
    np.testing.assert_array_equal(two.jam_index, one.jam_index)
