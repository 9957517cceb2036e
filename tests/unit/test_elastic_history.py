"""The elastic stem in a run: on the speed of the crank where it is known, else a constant one."""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline import solver as road
from camwright.pipeline.case.case_file import load_case_file
from camwright.pipeline.cycle.crank_speed import study_of
from camwright.pipeline.cycle.cycle import finished
from camwright.pipeline.cycle.elastic_response import elastic_follower, elastic_history
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.follower.elastic_follower import harmonic_response
from camwright.pipeline.follower.follower_forces import FollowerSystem

CASES = Path(__file__).parents[2] / "cases"
POSITIONS = 72


@pytest.fixture(scope="module")
def gx120():
    case = load_case_file(CASES / "gx120.toml")
    theta = uniform_turn(720)
    lift = Lift(theta, 0.008 * (1 - np.cos(theta)) + 0.002 * (1 - np.cos(2 * theta)))
    return case, road.engine_torques(case)["idle"], road.cam_contour(case, lift)


def test_the_cam_turns_with_the_crank_that_it_drives(gx120):
    case, torque, contour = gx120
    given = turn(case, contour, torque, "idle", POSITIONS)
    idle = case.load_cases[0].speed
    assert np.ptp(given.cam_speed) > 0.005 * 0.5 * idle
    study = study_of(case, torque, idle, contour.pitch, given.loads.rubbing)
    np.testing.assert_allclose(given.cam_speed, 0.5 * study.after.speed[::10], rtol=1e-12)
    # over the time of the turn it is the speed of the load case; 72 samples of it
    assert 1.0 / np.mean(1.0 / given.cam_speed) == pytest.approx(0.5 * idle, rel=1e-5)


def test_the_stem_rides_on_that_speed_and_says_so(gx120):
    case, torque, contour = gx120
    given = turn(case, contour, torque, "idle", POSITIONS)
    done = finished(case, contour, given, road.unknown_contact(given))
    elastic = done.parts.elastic
    assert "varies by" in elastic.method
    columns = done.columns(2.0)
    np.testing.assert_array_equal(columns["cam_speed"], given.cam_speed)
    np.testing.assert_array_equal(columns["elastic_contact_force"], elastic.response.contact_force)
    steady = harmonic_response(
        given.loads.lift, 0.5 * case.load_cases[0].speed, elastic_follower(case)
    )
    assert np.abs(elastic.response.contact_force - steady.contact_force).max() > 0.5


@pytest.mark.parametrize("known", ["no crankshaft", "no engine", "a crank that stalls", "ahead"])
def test_the_speed_is_constant_where_it_is_not_known(gx120, known):
    case, torque, contour = gx120
    if known == "no crankshaft":
        case = case.model_copy(update={"crankshaft": None})
    if known == "a crank that stalls":
        light = case.crankshaft.model_copy(update={"inertia": 1e-7, "mechanism_inertia": 0.0})
        case = case.model_copy(update={"crankshaft": light})
    given = turn(
        case, contour, None if known == "no engine" else torque, "idle", POSITIONS, known == "ahead"
    )
    np.testing.assert_array_equal(given.cam_speed, 0.5 * case.load_cases[0].speed)
    lift = contour.pitch.lift
    found = elastic_history(case, lift, given.loads.lift, given.cam_speed)
    assert found.method == "harmonic balance at constant speed"
    assert not found.flights


def test_lost_contact_on_a_varying_speed_is_integrated_through(gx120):
    case, _, contour = gx120
    lift, theta = contour.pitch.lift, uniform_turn(POSITIONS)
    swing = 700.0 * (1.0 + 0.05 * np.cos(theta))
    found = elastic_history(case, lift, lift(theta), swing)
    assert found.response.lost
    assert found.flights
    assert found.flights[0].height > 0.0
    system = FollowerSystem.from_case(case)
    assert found.force_max > system.preload + system.spring_rate * lift.stroke
