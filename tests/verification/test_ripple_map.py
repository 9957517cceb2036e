"""Ripple by speed and engine load: against solved cycles and against the loads of a turn."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torque, engine_torques
from camwright.pipeline.case.machine import machines
from camwright.pipeline.cycle.ripple_map import ripple_map
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.preview import preview_case
from camwright.pipeline.torque.torque import Torque, uniform_cycle

CASES = Path(__file__).parents[2] / "cases"


@pytest.fixture(scope="module")
def solved():
    """The case of the papers with its torques, a cam by previews, and its ripple map."""
    case = read_case(CASES / "gx120.toml")
    torques = engine_torques(case)
    trial = preview_case(case, corners=False)
    return case, torques, trial, mapped(case, torques, trial)


def mapped(case, torques, trial):
    states = machines(case, torques)
    return ripple_map(case, states, trial.contour.pitch, trial.cycles[0].loads.rubbing)


def test_map_contains_the_ripple_of_the_first_load_case(solved):
    """The turn has twice as many angles: the spectrum beyond is below 1e-4 of the ripple."""
    case, _, trial, ripples = solved
    first = trial.cycles[0].turn
    at = int(np.argmin(np.abs(ripples.crank_speed - case.load_cases[0].speed)))
    assert ripples.crank_speed[at] == pytest.approx(case.load_cases[0].speed, rel=1e-12)
    ratio = np.std(first.torque_after) / np.std(first.torque_before)
    assert ripples.ratio[0, at] == pytest.approx(ratio, rel=1e-3)


@pytest.mark.parametrize(("load", "speed"), [(0, 8), (1, 3), (2, 20), (3, 24)])
def test_interpolated_torque_is_that_of_solved_cycles(solved, load, speed):
    """Three speeds and one full load carry the map: the ripple of the engine within 1 %.

    The rubbing of the guides is that of the first load case, which changes the ratio by up to 2 %.
    """
    case, _, trial, ripples = solved
    state = case.load_cases[0].model_copy(
        update={
            "speed": float(ripples.crank_speed[speed]),
            "intake_pressure": float(ripples.intake_pressure[load]),
        }
    )
    torque = engine_torque(case, state)
    running = replace(trial.cycles[0].machine, speed=state.speed, torque=torque)
    there = turn(running, trial.contour, positions=360)
    before, after = np.std(there.torque_before), np.std(there.torque_after)
    assert ripples.before[load, speed] == pytest.approx(before, rel=0.01)
    assert ripples.ratio[load, speed] == pytest.approx(after / before, rel=0.02)


def test_engine_of_a_file_keeps_its_torque_and_scales_its_inertia(solved):
    case, torques, trial, _ = solved
    angle = uniform_cycle(720)
    gas, inertia = 30.0 * np.sin(angle / 2), 5.0 * np.sin(2 * angle)
    first = case.load_cases[0]
    states = [first.model_copy(update={"torque": "trace.csv"}), *case.load_cases[1:]]
    told = case.model_copy(update={"load_cases": tuple(states)})

    def with_parts(**parts):
        return mapped(told, torques | {first.name: Torque(angle, parts)}, trial)

    fixed, scaled = with_parts(total=gas + inertia), with_parts(gas=gas, inertia=inertia)
    assert fixed.intake_pressure is None
    assert np.ptp(fixed.before) == pytest.approx(0.0, abs=1e-12)
    share = (scaled.crank_speed / first.speed) ** 2
    expected = np.hypot(30.0, 5.0 * share) / np.sqrt(2.0)
    np.testing.assert_allclose(scaled.before[0], expected, rtol=1e-12)
    assert fixed.engine != scaled.engine


def test_a_case_without_a_running_engine_has_no_map(solved):
    case, _, trial, _ = solved
    assert mapped(case, {}, trial) is None


def test_record_has_a_row_a_load(solved):
    *_, ripples = solved
    record = ripples.as_record()
    assert np.shape(record["ratio"]) == (
        len(record["intake_pressure_kPa"]),
        ripples.crank_speed.size,
    )
    after = np.array(record["ratio"]) * np.array(record["ripple_before_Nm"])
    np.testing.assert_allclose(after, record["ripple_after_Nm"], rtol=1e-12)
