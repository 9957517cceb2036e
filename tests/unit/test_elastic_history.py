"""The elastic stem in a run: on the speed of the crank where it is known, else a constant one."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_run import named

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.crank_speed import study_of
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.elastic_response import elastic_follower, elastic_history
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.follower.elastic_follower import harmonic_response

CASES = Path(__file__).parents[2] / "cases"
POSITIONS = 72


@pytest.fixture(scope="module")
def gx120():
    case = read_case(CASES / "gx120.toml")
    theta = uniform_turn(720)
    lift = Lift(theta, 0.008 * (1 - np.cos(theta)) + 0.002 * (1 - np.cos(2 * theta)))
    return case, engine_torques(case)["idle"], case.contour(lift)


def idle(case, torque=None):
    """The machine in its one load case."""
    return machines(case, {} if torque is None else {"idle": torque})[0]


def test_the_cam_turns_with_the_crank_that_it_drives(gx120):
    case, torque, contour = gx120
    machine, speed = idle(case, torque), case.load_cases[0].speed
    given = turn(machine, contour, POSITIONS)
    assert np.ptp(given.driven.speed) > 0.005 * 0.5 * speed
    study = study_of(machine, contour.pitch, given.loads.rubbing)
    np.testing.assert_allclose(given.driven.speed, 0.5 * study.after.speed[::10], rtol=1e-12)
    # over the time of the turn it is the speed of the load case; 72 samples of it
    assert 1.0 / np.mean(1.0 / given.driven.speed) == pytest.approx(0.5 * speed, rel=1e-5)


def test_the_stem_rides_on_that_speed_and_says_so(gx120):
    case, torque, contour = gx120
    machine = idle(case, torque)
    given = turn(machine, contour, POSITIONS)
    pair, unknown = contact_pair(machine, contour), ContactHistory.unknown(POSITIONS)
    cycle = Cycle(given, contour, pair, None, unknown)
    elastic = cycle.elastic
    assert "varies by" in elastic.method
    columns = named(cycle.columns())
    np.testing.assert_array_equal(columns["cam_speed"], given.driven.speed)
    np.testing.assert_array_equal(
        columns["contact_force_elastic_stem"], elastic.response.contact_force
    )
    speed = 0.5 * case.load_cases[0].speed
    steady = harmonic_response(given.loads.lift, speed, elastic_follower(machine))
    assert np.abs(elastic.response.contact_force - steady.contact_force).max() > 0.5


@pytest.mark.parametrize("known", ["no crankshaft", "no engine", "a crank that stalls", "coarse"])
def test_the_speed_is_constant_where_it_is_not_known(gx120, known):
    case, torque, contour = gx120
    machine = idle(case, None if known == "no engine" else torque)
    if known == "no crankshaft":
        machine = replace(machine, crankshaft=None)
    if known == "a crank that stalls":
        light = replace(machine.crankshaft, inertia=1e-7, mechanism_inertia=0.0)
        machine = replace(machine, crankshaft=light)
    given = turn(machine, contour, POSITIONS, coarse=known == "coarse")
    np.testing.assert_array_equal(given.driven.speed, 0.5 * case.load_cases[0].speed)
    lift = contour.pitch.lift
    found = elastic_history(machine, lift, given.loads.lift, given.driven.speed)
    assert found.method == "harmonic balance at constant speed"
    assert not found.flights


def test_lost_contact_on_a_varying_speed_is_integrated_through(gx120):
    case, _, contour = gx120
    machine, lift, theta = idle(case), contour.pitch.lift, uniform_turn(POSITIONS)
    swing = 700.0 * (1.0 + 0.05 * np.cos(theta))
    found = elastic_history(machine, lift, lift(theta), swing)
    assert found.response.lost
    assert found.flights
    assert found.flights[0].height > 0.0
    assert found.force_max > machine.spring.force(lift.stroke)


def test_a_preview_does_not_follow_the_flights(gx120):
    """Its greatest force is that of the response with the contact held."""
    case, _, contour = gx120
    lift, theta = contour.pitch.lift, uniform_turn(POSITIONS)
    found = elastic_history(idle(case), lift, lift(theta), np.full(POSITIONS, 700.0), flights=False)
    assert found.response.lost
    assert found.flights == ()
    assert found.force_max == found.response.contact_force.max()
