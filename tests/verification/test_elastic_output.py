"""Elastic follower that moves an output by a rocker of changing ratio, by virtual work."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.pipeline.follower.elastic_follower import ElasticFollower, periodic_response
from camwright.pipeline.follower.follower_flight import bounce
from camwright.pipeline.follower.rocker import Rocker, RockerOutput

ARM, SECOND, RAISED, OUTPUT, OWN = 0.1, 0.06, -0.7, 0.5, 0.4
"""Lengths of both arms, m, angle of the second, rad; mass of the output and the rest, kg."""
ROCKER = Rocker(length=SECOND, angle=RAISED, output_mass=OUTPUT)
LIFT = SegmentMotion((
    Segment("cycloidal", 0.5 * FULL_TURN, 0.030), Segment("cycloidal", 0.5 * FULL_TURN, -0.030),
)).lift()  # fmt: skip


def train(preload=800.0, changes=True):
    ratio = SECOND * np.cos(RAISED) / ARM
    return ElasticFollower.with_damping_ratio(
        OWN + OUTPUT * ratio**2, 4e6, 8e3, preload, 0.05,
        output=RockerOutput(ROCKER, ARM) if changes else None,
    )  # fmt: skip


def pushed(follower, speed):
    """Force between cam and mass, N, and acceleration, m/s2, by time, position and speed."""

    def at(time, x, v):
        theta = speed * time
        s, slope = LIFT.derivatives(theta, 1)
        force = follower.stiffness * (s - x) + follower.damping * (slope * speed - v)
        # v(x): dv = SECOND cos(raised) dx/ARM; virtual work of the output's own inertia
        raised = RAISED + x / ARM
        first, second = SECOND * np.cos(raised) / ARM, -SECOND * np.sin(raised) / ARM**2
        held = follower.preload + follower.spring_rate * x
        return force, (force - held - OUTPUT * first * second * v**2) / (OWN + OUTPUT * first**2)

    return at


def test_periodic_response_by_integration_in_time():
    """Collocation against the fourth turn from rest, with e^-18 of its start.

    The mass is that at the lift of the foot, 0.3 mm beyond that of the mass itself, and the speed
    of the shortening counts to first order: 3e-4 of the force. With the mass at zero lift it is 3 %
    wrong.
    """
    speed = 150.0
    follower, theta = train(), uniform_turn(241)
    law = pushed(follower, speed)
    turn = FULL_TURN / speed
    rest = -follower.preload / (follower.stiffness + follower.spring_rate)
    run = solve_ivp(
        lambda t, y: [y[1], law(t, y[0], y[1])[1]], (0.0, 4.0 * turn), [rest, 0.0],
        t_eval=3.0 * turn + theta / speed, rtol=1e-9, atol=1e-12, method="DOP853", first_step=1e-5,
    )  # fmt: skip
    wanted = np.array([law(*each)[0] for each in zip(run.t, *run.y, strict=True)])
    assert wanted.min() > 0.0
    speeds = np.full(theta.size, speed)
    force = periodic_response(LIFT(theta), speeds, follower).contact_force
    off = np.abs(force - wanted).max() / wanted.max()
    plain = periodic_response(LIFT(theta), speeds, train(changes=False)).contact_force
    assert off < 5e-4
    assert np.abs(plain - wanted).max() > 50.0 * off * wanted.max()


def test_flight_with_an_output_by_integration_in_time():
    """Take-off within 1e-7 rad; energy and losses balance within 1e-9 of the energy."""
    follower, speed = train(preload=20.0), 200.0
    law, jump = pushed(follower, speed), bounce(LIFT, speed, follower, turns=1.0)
    rest = -follower.preload / (follower.stiffness + follower.spring_rate)

    def lost(t, y):
        return law(t, y[0], y[1])[0]

    lost.terminal, lost.direction = True, -1.0
    run = solve_ivp(
        lambda t, y: [y[1], law(t, y[0], y[1])[1]], (0.0, FULL_TURN / speed), [rest, 0.0],
        events=lost, rtol=1e-11, atol=1e-14, method="DOP853",
    )  # fmt: skip
    first = jump.flights[0]
    assert first.jump == pytest.approx(speed * run.t_events[0][0], abs=1e-7)
    balance = jump.energy + jump.dissipated
    assert np.ptp(balance) < 1e-9 * np.abs(jump.energy).max()
