"""Flights over the end of the turn and over whole turns, against the free motion on the spring."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.base.external_force import ExternalForce
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import jump_and_jamming
from camwright.pipeline.cycle.elastic_response import elastic_follower, elastic_history
from camwright.pipeline.follower.elastic_follower import ElasticFollower
from camwright.pipeline.follower.follower_flight import LONGEST, Bounce, Flight, bounce
from camwright.pipeline.smoothing.required_lift import cam_lift

SNAIL = Path(__file__).parents[1] / "data" / "strangers" / "14-missing-kinds" / "snail_table.toml"
SPEED = 10.0  # rad/s
SOFT = ElasticFollower(mass=7.5, stiffness=4e6, spring_rate=100.0, preload=10.0, damping=500.0)


def snail(count: int) -> Lift:
    """A rise of 20 mm over 350 deg and a fall over 10 deg, at equal angles."""
    deg = np.degrees(uniform_turn(count))
    return Lift(
        uniform_turn(count), np.where(deg <= 350, 0.02 * deg / 350, 0.02 * (360 - deg) / 10)
    )


def flown(lift: Lift, speed: float, f: ElasticFollower, run: Bounce, flight: Flight) -> Flight:
    """The same flight of the mass on the spring alone, by an integration in time."""
    k = int(np.flatnonzero(run.theta == flight.jump)[-1])
    start = run.position[k], run.velocity[k]

    def gap(t: float, y: np.ndarray) -> float:
        opened = t > 0.02 / speed  # the stem has relaxed
        return float(y[0] - lift(flight.jump + speed * t)) if opened else 1.0

    gap.terminal, gap.direction = True, -1.0
    end = (LONGEST * FULL_TURN) / speed
    free = solve_ivp(
        lambda t, y: [y[1], (-f.spring_rate * y[0] - f.preload - float(f.load.force[0])) / f.mass],
        (0.0, end), start, "LSODA", events=gap, rtol=1e-10, atol=1e-13,
        dense_output=True, max_step=0.01 / speed,
    )  # fmt: skip
    time, v = free.t[-1], free.y[1, -1]
    t = np.linspace(0.0, time, 200_001)
    height = (free.sol(t)[0] - lift(flight.jump + speed * t)).max()
    angle = flight.jump + speed * time
    return Flight(flight.jump, angle, float(height), float(lift(angle, 1)) * speed - v)


def highest(flights: tuple[Flight, ...]) -> Flight:
    return max(flights, key=lambda one: one.height)


def same(one: Flight, other: Flight) -> None:
    assert one.landing == pytest.approx(other.landing, rel=1e-6)
    assert one.height == pytest.approx(other.height, rel=1e-5)
    assert one.landing_speed == pytest.approx(other.landing_speed, rel=1e-4)


def test_a_snail_cam_lets_its_follower_fall_beyond_the_turn() -> None:
    """Rigid, by hand: from 350 deg to 82.5 deg of the next turn, 20.33 mm high, with 0.249 m/s.

    Within 0.1 %, 0.12 deg of 92.5 deg: an elastic stem, and corners of a spline at 0.0125 deg.
    """
    run = bounce(snail(28800), SPEED, SOFT, 0.2, first=np.radians(300.0))
    fall = highest(run.flights)
    assert np.degrees(fall.landing) - 360.0 == pytest.approx(82.5, abs=0.12)
    assert fall.turns_later == 1
    assert fall.height == pytest.approx(20.33e-3, rel=1e-3)
    assert fall.landing_speed == pytest.approx(0.249, rel=2e-3)


def cliff(theta: np.ndarray) -> np.ndarray:
    """A fall of 12 mm over 40 deg and a rise over the rest, both cycloidal."""
    fall = np.mod(theta, FULL_TURN) / np.radians(40.0)
    rise = (np.mod(theta, FULL_TURN) - np.radians(40.0)) / np.radians(320.0)
    x = np.where(fall <= 1.0, 1.0 - fall, rise)
    return 0.012 * (x - np.sin(FULL_TURN * x) / FULL_TURN)


def rigid_fall() -> tuple[float, float, float]:
    """Angles of jump and flight, rad, and greatest gap, m, of 7.5 kg on 100 N/m and 10 N, rigid."""
    base, own, rest = np.radians(40.0), np.sqrt(100.0 / 7.5), -10.0 / 100.0

    def force(theta: float) -> float:  # m w^2 s'' + P + k s
        bend = -0.012 * FULL_TURN / base**2 * np.sin(FULL_TURN * theta / base)
        return 7.5 * SPEED**2 * bend + 10.0 + 100.0 * float(cliff(np.array(theta)))

    jump = brentq(force, 0.0, 0.25 * base)
    speed = -0.012 * SPEED / base * (1.0 - np.cos(FULL_TURN * jump / base))
    t = np.linspace(0.0, 0.2, 2_000_001)
    high = float(cliff(np.array(jump))) - rest
    gap = rest + high * np.cos(own * t) + speed / own * np.sin(own * t) - cliff(jump + SPEED * t)
    landing = np.flatnonzero((gap < 0.0) & (t > 0.01))[0]
    return jump, SPEED * t[landing], float(gap[:landing].max())


@pytest.mark.parametrize("shift", [0, 180, 350, 359])
def test_a_flight_does_not_depend_on_the_beginning_of_the_turn(shift: int) -> None:
    """A cliff anywhere in the turn, over its end as well: the flight of a rigid follower."""
    theta = uniform_turn(720)
    lift = Lift(theta, cliff(theta - np.radians(shift)))
    machine = next(one for one in machines(read_case(SNAIL)) if one.load_case == "running")
    found = elastic_history(machine, lift, lift(theta), np.full(720, SPEED)).flights
    jump, flew, height = rigid_fall()
    after = [np.mod(one.jump - np.radians(shift) - 0.5 * jump, FULL_TURN) for one in found]
    first = found[int(np.argmin(after))]
    assert min(after) == pytest.approx(0.5 * jump, abs=1e-3)
    assert first.landing - first.jump == pytest.approx(flew, rel=1e-3)
    assert first.height == pytest.approx(height, rel=1e-3)
    assert max(after) - min(after) < FULL_TURN


def test_a_snail_cam_by_a_table_is_that_of_its_spline() -> None:
    """The flight of the mass alone from the same jump, on the spline through points of 2 deg."""
    case = read_case(SNAIL)
    lift = case.contour(cam_lift(case, {})).pitch.lift
    machine = next(one for one in machines(case) if one.load_case == "running")
    f = elastic_follower(machine)
    run = bounce(lift, SPEED, f, 0.2, first=np.radians(300.0))
    fall = highest(run.flights)
    assert fall.turns_later == 1
    same(fall, flown(lift, SPEED, f, run, fall))
    note = jump_and_jamming._flights([SimpleNamespace(flights=run.flights, force_max=1.0)])
    assert f"{np.degrees(fall.landing) % 360.0:.1f} deg of the next turn" in note


def test_a_flight_lasts_longer_than_a_turn() -> None:
    """Half a period of 7.5 kg on 100 N/m is five turns at 40 rad/s."""
    lift = snail(720)
    run = bounce(lift, 40.0, SOFT, 0.2, first=np.radians(300.0))
    fall = highest(run.flights)
    assert fall.turns_later >= 2
    same(fall, flown(lift, 40.0, SOFT, run, fall))
    note = jump_and_jamming._flights([SimpleNamespace(flights=run.flights, force_max=1.0)])
    assert f"{fall.turns_later} turns later" in note


def test_a_follower_that_is_pulled_off_never_lands() -> None:
    pulled = ElasticFollower(7.5, 4e6, 0.0, 10.0, 500.0, load=ExternalForce.constant(-10.5))
    run = bounce(snail(720), SPEED, pulled, 1.0, first=np.radians(300.0))
    last = run.flights[-1]
    assert not last.lands
    assert np.isnan(last.landing_speed)
    assert run.theta[-1] == pytest.approx(last.jump + LONGEST * FULL_TURN)
    note = jump_and_jamming._flights([SimpleNamespace(flights=run.flights, force_max=1.0)])
    assert "has not landed after 100 turns" in note


def test_a_follower_lands_on_a_nose_narrower_than_a_step() -> None:
    """A nose of 0.5 deg, 30 mm high, after the drop: less than the step of a free flight."""
    theta = uniform_turn(7200)
    deg = np.degrees(theta)
    lift = Lift(theta, snail(7200).values + 0.03 * np.exp(-(((deg - 20.0) / 0.25) ** 2)))
    run = bounce(lift, SPEED, SOFT, 0.2, first=np.radians(300.0))
    fall = run.flights[-1]
    same(fall, flown(lift, SPEED, SOFT, run, fall))
    assert 19.0 < np.degrees(fall.landing) - 360.0 < 20.0
