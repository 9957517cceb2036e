"""The elastic follower: limits, resonance, energy, jump and landing."""

from dataclasses import replace

import numpy as np
import pytest
from elastic_jump import elastic_jump_speed, energy_error

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import periodic_quintic
from camwright.pipeline.follower.elastic_follower import (
    ElasticFollower,
    collocation_response,
    harmonic_response,
    periodic_response,
    quasi_static,
)
from camwright.pipeline.follower.follower_flight import bounce

THETA = uniform_turn(360)
HIGH = 12e-3
LIFT = Lift(THETA, 0.5 * HIGH * (1 - np.cos(THETA)) + 0.05 * HIGH * (1 - np.cos(3 * THETA)))
S = LIFT.values
PLAIN = ElasticFollower(0.175, 2e6, 24.2e3, 242.0)
DAMPED = replace(PLAIN, damping=40.0, guide_damping=5.0)


def test_stiff_stem_is_the_rigid_follower():
    """x misses s by F/K and the force the rigid one by as much again: both fall with 1/K."""
    rigid = 242.0 + 24.2e3 * S + 0.175 * 100.0**2 * LIFT(THETA, 2)
    misses = []
    for K in (1e9, 1e11, 1e13):
        found = harmonic_response(S, 100.0, replace(PLAIN, stiffness=K))
        misses.append(np.abs(found.contact_force - rigid).max() / rigid.max())
        np.testing.assert_allclose(found.position, S, atol=2 * rigid.max() / K)
    assert misses[2] < 1e-8
    assert misses[0] / misses[1] == pytest.approx(100.0, rel=2e-3)


def test_slow_cam_is_quasi_static():
    """At 0.1 rad/s inertia is 1e-6 of the stem's way and less."""
    found = harmonic_response(S, 0.1, PLAIN)
    np.testing.assert_allclose(found.position, quasi_static(S, PLAIN), rtol=0, atol=1e-6 * HIGH)
    np.testing.assert_allclose(
        quasi_static(S, PLAIN), (2e6 * S - 242.0) / (2e6 + 24.2e3), rtol=1e-14
    )


def test_one_mode_resonates_at_its_speed():
    """The third harmonic alone, 1 % damping: the peak lies at sqrt((K + k)/m) / 3."""
    lift = 1e-4 * np.cos(3 * THETA)
    own = np.sqrt((PLAIN.stiffness + PLAIN.spring_rate) / PLAIN.mass) / 3.0
    light = ElasticFollower.with_damping_ratio(0.175, 2e6, 24.2e3, 242.0, 0.01)
    speeds = own * np.linspace(0.95, 1.05, 401)
    size = [np.ptp(harmonic_response(lift, w, light).position) for w in speeds]
    assert speeds[np.argmax(size)] == pytest.approx(own, rel=5e-4)
    assert max(size) / 2e-4 == pytest.approx(1 / 0.02, rel=0.02)
    with pytest.raises(InputError, match="resonance"):
        harmonic_response(lift, own, PLAIN)


def test_energy_balance_with_damping():
    """What the cam gives over a turn is what the dampers take: 1e-9, sums being spectral."""
    found = harmonic_response(S, 150.0, DAMPED)
    foot = 150.0 * LIFT(THETA, 1)
    given = np.mean(found.contact_force * foot)
    taken = np.mean(40.0 * (foot - found.velocity) ** 2 + 5.0 * found.velocity**2)
    assert taken > 0.0
    assert given == pytest.approx(taken, rel=1e-9)


@pytest.mark.parametrize("count", [120, 121])
def test_collocation_is_harmonic_balance_at_constant_speed(count):
    s = LIFT(uniform_turn(count))
    one = harmonic_response(s, 150.0, DAMPED)
    two = collocation_response(s, np.full(count, 150.0), DAMPED)
    np.testing.assert_allclose(two.position, one.position, atol=1e-9 * HIGH)
    np.testing.assert_allclose(two.contact_force, one.contact_force, rtol=1e-8)


def test_varying_speed_agrees_with_integration():
    """Three per cent of ripple, against a Runge-Kutta run that has forgotten its start."""
    from scipy.integrate import solve_ivp

    count = 181
    theta = uniform_turn(count)
    f = replace(PLAIN, damping=400.0)

    def speed(t):
        return 150.0 * (1 + 0.03 * np.cos(2 * t))

    found = collocation_response(LIFT(theta), speed(theta), f)

    def rates(t, y):
        angle, x, v = y
        s, slope = LIFT.derivatives(angle, 1)
        push = f.stiffness * (s - x) + f.damping * (slope * speed(angle) - v)
        return [speed(angle), v, (push - f.spring_rate * x - f.preload) / f.mass]

    def turned(_, y):
        return y[0] - 4 * np.pi

    turned.terminal = True
    start = [0.0, found.position[0], found.velocity[0]]
    run = solve_ivp(rates, (0, 1), start, "DOP853", events=turned, rtol=1e-9, atol=1e-13)
    assert run.y[1, -1] == pytest.approx(found.position[0], abs=1e-6 * HIGH)
    assert run.y[2, -1] == pytest.approx(found.velocity[0], abs=1e-5)


def test_no_jump_where_the_contact_holds():
    """Without loss the integration stays on the harmonic balance."""
    steady = harmonic_response(S, 150.0, DAMPED)
    assert not steady.lost
    start = (steady.position[0], steady.velocity[0])
    run = bounce(LIFT, 150.0, DAMPED, 1.0, start)
    assert not run.flights
    assert run.position[-1] == pytest.approx(start[0], abs=1e-8 * HIGH)
    assert energy_error(run) < 1e-8


def test_energy_is_kept_through_jump_and_landing():
    """Free of losses, to 1e-6, over flights and impacts."""
    run = bounce(LIFT, 420.0, PLAIN, 1.0)
    assert run.flights
    assert energy_error(run) < 1e-6
    assert run.contact_force.min() > -1e-3
    first = run.flights[0]
    assert first.landing > first.jump
    assert first.height > 0.0
    assert first.landing_speed > 0.0


def test_losses_account_for_the_energy_after_a_jump():
    """With both dampers, energy and losses together stand still, impacts included: 1e-6."""
    run = bounce(LIFT, 600.0, DAMPED, 1.0)
    assert run.flights
    assert run.dissipated[-1] > 0.0
    assert energy_error(run) < 1e-6


def test_flight_is_that_of_a_mass_on_the_spring():
    """Between jump and landing m x'' + k x + P = 0 has a closed form."""
    run = bounce(LIFT, 420.0, PLAIN, 1.0)
    first = run.flights[0]
    t0, t1 = first.jump / 420.0, first.landing / 420.0
    part = (run.time >= t0 - 1e-12) & (run.time <= t1 + 1e-12)
    inside = np.flatnonzero(part)[1:-1]
    t = run.time[inside] - run.time[inside[0]]
    own = np.sqrt(24.2e3 / 0.175)
    rest = -242.0 / 24.2e3
    x0, v0 = run.position[inside[0]], run.velocity[inside[0]]
    exact = rest + (x0 - rest) * np.cos(own * t) + v0 / own * np.sin(own * t)
    np.testing.assert_allclose(run.position[inside], exact, atol=1e-9)


SWING = 150.0 * (1 + 0.03 * np.cos(2 * THETA))


def test_a_constant_speed_is_the_limit_of_a_varying_one():
    """Collocation at equal speeds against harmonic balance, one formed by angles, one by orders."""
    one = harmonic_response(S, 150.0, DAMPED)
    two = collocation_response(S, np.full(360, 150.0), DAMPED)
    np.testing.assert_allclose(two.position, one.position, atol=1e-8 * HIGH)
    np.testing.assert_allclose(two.contact_force, one.contact_force, rtol=1e-8)
    small = collocation_response(S, 150.0 + 1e-7 * np.cos(THETA), DAMPED)
    np.testing.assert_allclose(small.contact_force, one.contact_force, rtol=1e-8)


def test_periodic_response_takes_the_speed_it_is_given():
    steady = periodic_response(S, np.full(360, 150.0), DAMPED)
    np.testing.assert_array_equal(steady.position, harmonic_response(S, 150.0, DAMPED).position)
    varying = periodic_response(S, SWING, DAMPED)
    np.testing.assert_array_equal(varying.position, collocation_response(S, SWING, DAMPED).position)
    assert np.abs(varying.contact_force - steady.contact_force).max() > 1.0


def rigid_force(speed):
    """P + k s + m d(s' w)/dt with d/dt = w d/dtheta, of a lift whose harmonics are known."""
    slope, bend = LIFT(THETA, 1), LIFT(THETA, 2)
    steepening = -0.06 * 150.0 * np.sin(2 * THETA)
    return 242.0 + 24.2e3 * S + 0.175 * speed * (speed * bend + steepening * slope)


def test_stiff_stem_is_the_rigid_follower_at_varying_speed():
    """The force misses that of the rigid follower by a share that falls with 1/K."""
    rigid = rigid_force(SWING)
    misses = [
        np.abs(
            collocation_response(S, SWING, replace(PLAIN, stiffness=K)).contact_force - rigid
        ).max()
        / rigid.max()
        for K in (1e9, 1e11, 1e13)
    ]
    assert misses[2] < 1e-7
    assert misses[0] / misses[1] == pytest.approx(100.0, rel=5e-3)


def test_slow_cam_is_quasi_static_at_varying_speed():
    found = collocation_response(S, 0.1 * SWING / 150.0, PLAIN)
    np.testing.assert_allclose(found.position, quasi_static(S, PLAIN), rtol=0, atol=1e-6 * HIGH)


def test_energy_balance_with_damping_at_varying_speed():
    """Over the time of a turn, dtheta/w, the cam gives what the dampers take: 1e-9."""
    found = collocation_response(S, SWING, DAMPED)
    foot = SWING * LIFT(THETA, 1)
    given = np.mean(found.contact_force * foot / SWING)
    losses = 40.0 * (foot - found.velocity) ** 2 + 5.0 * found.velocity**2
    assert given == pytest.approx(np.mean(losses / SWING), rel=1e-9)
    assert given > 0.0


def test_no_jump_stays_on_the_collocation_at_varying_speed():
    steady = collocation_response(S, SWING, DAMPED)
    start = (steady.position[0], steady.velocity[0])
    run = bounce(LIFT, periodic_quintic(SWING), DAMPED, 1.0, start)
    assert not run.flights
    assert run.position[-1] == pytest.approx(start[0], abs=1e-7 * HIGH)
    assert run.time[-1] == pytest.approx(np.mean(2 * np.pi / SWING), rel=1e-9)
    assert energy_error(run) < 1e-8


def test_energy_is_kept_through_impacts_at_varying_speed():
    """Free of losses, over flights and landings of a cam whose speed swings by 6 %: 1e-6."""
    run = bounce(LIFT, periodic_quintic(2.8 * SWING), PLAIN, 1.0)
    assert run.flights
    assert energy_error(run) < 1e-6
    assert (np.diff(run.theta) >= 0.0).all()
    other = bounce(LIFT, 420.0, PLAIN, 1.0)
    assert run.flights[0].height != pytest.approx(other.flights[0].height, rel=1e-3)


def test_jump_speed_tends_to_the_rigid_one():
    """Norton, Cam Design and Manufacturing Handbook (2009), ch. 15: least sqrt(F/(-m s''))."""
    lift, _, bend = LIFT.derivatives(THETA, 2)
    falls = bend < 0.0
    rigid = float(np.sqrt(np.min((242.0 + 24.2e3 * lift[falls]) / (-0.175 * bend[falls]))))
    stiff = replace(PLAIN, stiffness=1e11)
    assert elastic_jump_speed(S, stiff, 1.5 * rigid) == pytest.approx(rigid, rel=2e-3)
    soft = elastic_jump_speed(S, replace(PLAIN, stiffness=5e5), 1.5 * rigid)
    assert soft < rigid
    assert elastic_jump_speed(S, stiff, 0.5 * rigid) == np.inf


@pytest.mark.parametrize("name", ["mass", "stiffness", "damping", "preload"])
def test_refusals(name):
    with pytest.raises(InputError, match=name):
        replace(PLAIN, **{name: -1.0})
    with pytest.raises(InputError, match=name):
        replace(PLAIN, **{name: float("nan")})


def test_refuses_speeds():
    with pytest.raises(InputError, match="cam_speed"):
        bounce(LIFT, 0.0, PLAIN)
    with pytest.raises(InputError, match="cam_speed"):
        collocation_response(S, np.zeros(360), PLAIN)
    with pytest.raises(InputError, match="shape"):
        collocation_response(S, np.ones(3), PLAIN)
