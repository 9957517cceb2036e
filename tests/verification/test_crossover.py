"""Flight through the clearance of a groove against closed forms and an integrator of events.

The closed forms are those of a linear force for small clearance; the landing of a large one is
solved a second time by an adaptive Runge-Kutta method on the law itself.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.pipeline.follower.crossover import INNER, OUTER, Walls

COUNT = 14400
THETA = uniform_turn(COUNT)
SPEED = 120.0 * FULL_TURN / 60.0
MASS, STROKE = 2.0, 0.030
QUARTER = np.radians(90.0)


def motion(law):
    return SegmentMotion((
        Segment(law, QUARTER, STROKE), Segment("dwell", QUARTER),
        Segment(law, QUARTER, -STROKE), Segment("dwell", QUARTER),
    ))  # fmt: skip


def inertia(law):
    return MASS * SPEED**2 * motion(law)(THETA, 2)


def landings(force, gap, mass, speed, restitution=0.0, **beside):
    return Walls.of(force, gap, mass, speed, **beside).landings(restitution)


def rise(crossings):
    """The landing of the first crossover on the rise."""
    return min((one for one in crossings if one.wall != one.start), key=lambda one: one.take_off)


LAWS = (
    ("cycloidal", 4.0 * np.pi**2, 10.296), ("modified_trapezoid", 61.43, 11.931),
    ("polynomial_345", 30.0, 9.396), ("polynomial_4567", 52.5, 11.322),
)  # fmt: skip
"""Law, jerk in the middle by the greatest of its kind, landing speed at 20 um, mm/s."""


def closed_form_landing(clearance, jerk):
    """Time, s, and landing speed, m/s, under inertia: (6 c/j)^(1/3), (9/2 c^2 j)^(1/3).

    clearance, m, along the travel; jerk, m/s3, at the zero of the acceleration.
    """
    return (6.0 * clearance / jerk) ** (1.0 / 3.0), (4.5 * clearance**2 * jerk) ** (1.0 / 3.0)


@pytest.mark.parametrize(("law", "jerk", "landed"), LAWS)
def test_landing_speed_of_a_small_clearance(law, jerk, landed):
    """The closed form has the figures computed independently, mm/s at 20 um, to their digits.

    It is that of a constant jerk: within 0.1 % of the flight at 0.1 um, up to 1.3 % above it at
    20 um, as the jerk falls over the flight of 4 deg.
    """
    rate = jerk * STROKE * (SPEED / QUARTER) ** 3
    assert 1e3 * closed_form_landing(20e-6, rate)[1] == pytest.approx(landed, abs=5e-4)
    one = rise(landings(inertia(law), np.full(COUNT, 1e-7), MASS, SPEED))
    time, speed = closed_form_landing(1e-7, rate)
    assert (one.start, one.wall) == (INNER, OUTER)
    assert one.take_off == pytest.approx(np.radians(45.0), abs=1e-6)
    assert (one.time, one.speed) == pytest.approx((time, speed), rel=1e-3)
    wide = rise(landings(inertia(law), np.full(COUNT, 20e-6), MASS, SPEED))
    assert 1e3 * wide.speed == pytest.approx(landed, rel=1.5e-2)


def test_time_of_a_small_clearance():
    """Of a cycloid 5.827 ms at 20 um; the flight approaches it as the square of its angle."""
    jerk = 4.0 * np.pi**2 * STROKE * (SPEED / QUARTER) ** 3
    assert 1e3 * closed_form_landing(20e-6, jerk)[0] == pytest.approx(5.827, abs=5e-4)
    misses = []
    for clearance in (64e-6, 8e-6, 1e-6):
        one = rise(landings(inertia("cycloidal"), np.full(COUNT, clearance), MASS, SPEED))
        misses.append(one.time / closed_form_landing(clearance, jerk)[0] - 1.0)
    orders = np.log2(np.array(misses[:-1]) / misses[1:])
    assert orders == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("clearance", [1e-4, 1e-3, 5e-3])
def test_a_large_clearance_against_an_adaptive_integrator(clearance):
    """Time and speed within 1e-4, up to a clearance of a sixth of the stroke, beside a spring."""
    law, rate, damping = motion("polynomial_345"), 400.0, 3.0
    force = inertia("polynomial_345")
    landing = rise(
        landings(force, np.full(COUNT, clearance), MASS, SPEED, stiffness=rate, damping=damping)
    )

    def flown(time, state):
        accelerated = SPEED**2 * law(np.array([landing.take_off + SPEED * time]), 2)[0]
        return state[1], -accelerated - (rate * state[0] + damping * state[1]) / MASS

    def lands(_, state):
        return state[0] - clearance

    lands.terminal = True
    exact = solve_ivp(flown, (0.0, 0.1), (0.0, 0.0), events=lands, rtol=1e-10, atol=1e-14)
    assert landing.time == pytest.approx(exact.t_events[0][0], rel=1e-4)
    assert landing.speed == pytest.approx(exact.y_events[0][0][1], rel=1e-4)


@pytest.mark.parametrize("phase", [0.0, 1.0])
def test_a_roller_leaves_a_wall_that_bends_away_from_a_straight_step_once(phase):
    """Four flights a turn, from the outer wall, too, whose force goes through zero as it bends.

    Take-off by the zero of the force of each wall, time and speed by an adaptive integrator between
    the bent walls, within 1e-4.
    """
    width, wave, speed = 20e-6, 2e-6, 30.0

    def force(theta):
        return 100.0 * np.cos(2.0 * theta) + 20.0 * np.cos(theta)

    def gap(theta):
        return width + wave * np.cos(4.0 * theta + phase)

    def opening(theta):
        return -4.0 * wave * speed * np.sin(4.0 * theta + phase)

    series = landings(force(THETA), gap(THETA), MASS, speed)
    assert len(series) == 4
    assert all(one.wall != one.start for one in series)
    for one in series:
        outer, start = one.start == OUTER, one.take_off
        bend = -16.0 * wave * speed**2 * np.cos(4.0 * start + phase) if outer else 0.0
        assert force(start) + MASS * bend == pytest.approx(0.0, abs=1e-3)
        begin = (gap(start), opening(start)) if outer else (0.0, 0.0)

        def flown(time, state, start=start):
            return state[1], -force(start + speed * time) / MASS

        def lands(time, state, start=start, outer=outer):
            return state[0] - (0.0 if outer else gap(start + speed * time))

        lands.terminal, lands.direction = True, -1.0 if outer else 1.0
        exact = solve_ivp(flown, (0.0, 0.1), begin, events=lands, rtol=1e-10, atol=1e-14)
        time, (_, moving) = exact.t_events[0][0], exact.y_events[0][0]
        against = -moving if outer else moving - opening(start + speed * time)
        assert (one.time, one.speed) == pytest.approx((time, against), rel=1e-4)


@pytest.mark.parametrize("restitution", [0.3, 0.7])
def test_rebounds_against_an_integrator_of_events(restitution):
    """Times, walls and speeds of the flights after the first take-off within 1e-4, until rest.

    The roller rests where it would rise by less than a thousandth of the clearance: the speed of
    its last landing is then below that of a fall from there.
    """
    law, clearance, rate, damping = motion("polynomial_345"), 2e-4, 400.0, 3.0
    walls = np.full(COUNT, clearance)
    spring = {"stiffness": rate, "damping": damping}
    series = landings(
        inertia("polynomial_345"), walls, MASS, SPEED, restitution=restitution, **spring
    )

    def flown(time, state):
        accelerated = SPEED**2 * law(np.array([first.take_off + SPEED * time]), 2)[0]
        return state[1], -accelerated - (rate * state[0] + damping * state[1]) / MASS

    events = [lambda _, state: state[0], lambda _, state: state[0] - clearance]
    for event, direction in zip(events, (-1.0, 1.0), strict=True):
        event.terminal, event.direction = True, direction
    first = rise(series)
    begin, state, series = 0.0, (0.0, 0.0), series[series.index(first) :]
    count = next(k for k, one in enumerate(series) if one.rebound == 0.0) + 1
    for one in series[:count]:
        flight = solve_ivp(
            flown, (begin, begin + 0.1), state, events=events, rtol=1e-11, atol=1e-15
        )
        begin, speed = flight.t[-1], flight.y[1][-1]
        wall = OUTER if flight.t_events[1].size else INNER
        assert one.wall == wall
        landed = (one.landing - first.take_off) % FULL_TURN / SPEED
        assert (landed, one.speed) == pytest.approx((begin, abs(speed)), rel=1e-4)
        assert one.rebound == pytest.approx(restitution * one.speed) or one is series[count - 1]
        state = (clearance if wall == OUTER else 0.0, -restitution * speed)
    assert count >= 3
    last = series[count - 1]
    height = 0.5 * MASS * (restitution * last.speed) ** 2 / last.force
    assert 0.0 < height < 1e-3 * clearance


def test_energy_of_a_turn_with_landings():
    """Work of the walls equals the energy lost in the landings: 1e-6 of the work in a turn.

    The follower's motion is built again from the landings: the groove's where it is carried, the
    flight's between; the impulses of the landings act at the speed of the groove.
    """
    law, clearance = motion("cycloidal"), 2e-4
    series = landings(inertia("cycloidal"), np.full(COUNT, clearance), MASS, SPEED)
    spent = sum(0.5 * MASS * one.speed**2 for one in series)
    work = 0.0
    places = [(one.take_off, one.landing) for one in series]
    for (_, begin), (end, _) in zip(places, places[1:] + places[:1], strict=True):
        span = (end - begin) % FULL_TURN
        grid = begin + np.linspace(0.0, span, 20001)
        power = MASS * SPEED**2 * law(grid, 2) * law(grid, 1)
        work += np.trapezoid(power, grid)
    for one in series:
        slope = SPEED * law(np.array([one.landing]), 1)[0]
        work += one.wall * MASS * one.speed * slope
    swing = 0.5 * MASS * (SPEED * law(THETA, 1)).max() ** 2
    assert len(series) == 2
    assert spent > 1e-5 * swing
    assert work == pytest.approx(spent, abs=1e-6 * swing)


def test_a_closing_force_keeps_one_wall():
    """No landing where the force does not change its sign, or only by the ripple of a dwell."""
    force = inertia("cycloidal")
    assert landings(force - 1.1 * force.min(), np.full(COUNT, 1e-4), MASS, SPEED) == ()
    assert len(landings(force + 1e-9, np.full(COUNT, 1e-5), MASS, SPEED)) == 2


def test_refusals():
    with pytest.raises(InputError, match=r"clearance = -1e-06, must be >= 0 m"):
        landings(np.ones(9), np.full(9, -1e-6), MASS, SPEED)
    with pytest.raises(InputError, match=r"restitution = 1, must be in \[0, 1\)"):
        landings(np.ones(9), np.zeros(9), MASS, SPEED, restitution=1.0)
