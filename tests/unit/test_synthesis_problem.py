"""From a case to the synthesis it asks for: load cases, corners, what is freed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.problem_setup import problem_of

DATA = Path(__file__).parents[1] / "data"


def section(given, **changes):
    """A section of a case with other values."""
    return given.model_copy(update=changes)


@pytest.fixture(scope="module")
def case():
    return read_case(DATA / "soft_spring.toml")


@pytest.fixture(scope="module")
def torques(case):
    return engine_torques(case)


def test_every_load_case_is_a_scenario(case, torques):
    idle, over, still, most = problem_of(case, torques).scenarios
    assert (idle.name, over.name) == ("idle", "overspeed")
    assert (still.name, most.name) == ("standstill", "over-speed")
    assert (idle.weight, over.weight, still.weight, most.weight) == (1.0, 0.0, 0.0, 0.0)
    assert over.cam_speed == pytest.approx(3600 * np.pi / 30 / 2)
    assert abs(idle.torque.mean()) < 1e-12 and idle.torque.size == 720


def test_weight_and_required_reduction_of_a_load_case_are_apart(case, torques):
    idle, over = case.load_cases
    problem = problem_of(case, torques)
    required = [item.torque_reduction for item in problem.scenarios]
    assert required == [0.5, None, None, None]
    assert problem.ceiling == pytest.approx(0.5, rel=2e-3)
    states = (
        section(idle, torque_reduction=0.0),
        section(over, ripple_weight=0.5, torque_reduction=0.1),
    )
    own = problem_of(section(case, load_cases=states), torques)
    weights = [(item.weight, item.torque_reduction) for item in own.scenarios]
    assert weights == [(1.0, None), (0.5, 0.1), (0.0, None), (0.0, None)]
    assert own.ceiling == own.ceiling_of(own.scenarios[1]) == pytest.approx(0.9, rel=2e-3)
    assert own.ceiling_of(own.scenarios[0]) is None
    left_out = replace(own, left_out=frozenset({"torque_reduction"}))
    assert left_out.ceiling_of(own.scenarios[1]) is None and left_out.ceiling is None


def test_corners_are_all_of_spring_and_friction_and_each_of_mass_and_phase(case, torques):
    wide = section(
        case,
        spring=replace(case.spring, rate_tolerance=0.05, preload_tolerance=0.1),
        guides=replace(
            case.guides,
            a=replace(case.guides.a, friction=0.1, friction_min=0.05, friction_max=0.15),
            b=replace(case.guides.b, friction=0.1, friction_min=None, friction_max=None),
        ),
        tolerances=section(case.tolerances, friction=0.2, mass=0.1, phase=np.radians(4.0)),
        smoothing=section(case.smoothing, corners=True),
    )
    found = [item for item in problem_of(wide, torques).scenarios if item.name.startswith("idle")]
    nominal, corners = found[0], found[1:]
    assert len(corners) == 8 + 2 + 2
    assert {item.weight for item in corners} == {nominal.weight}
    ends = {(item.friction_a, item.friction_b) for item in corners[:8]}
    assert sorted(ends) == [(0.05, pytest.approx(0.08)), (0.15, pytest.approx(0.12))]
    assert {item.rate_factor for item in corners[:8]} == {0.95, 1.05}
    assert {item.preload_factor for item in corners[:8]} == {0.9, 1.1}
    assert [item.mass / nominal.mass for item in corners[8:10]] == pytest.approx([0.9, 1.1])
    # 4 deg of crank are 2 deg of cam: 4 of 720 points
    late, early = corners[10:]
    np.testing.assert_allclose(late.torque, np.roll(nominal.torque, 4), atol=1e-9)
    np.testing.assert_allclose(early.torque, np.roll(nominal.torque, -4), atol=1e-9)


def test_preload_of_a_load_case_is_that_of_its_scenario(case, torques):
    idle, over = case.load_cases
    own = section(case, load_cases=(idle, section(over, preload=300.0)))
    problem = problem_of(own, torques)
    assert problem.scenarios[0].preload_factor == 1.0
    found = problem.scenarios[1].preload_factor * problem.variables.preload
    assert found == pytest.approx(300.0)


def test_preload_is_not_freed_where_a_load_case_has_its_own(case, torques):
    idle, over = case.load_cases
    own = section(
        case,
        load_cases=(idle, section(over, preload=300.0)),
        smoothing=section(case.smoothing, free=("preload",), preload_range=(200.0, 400.0)),
    )
    with pytest.raises(InputError, match=r"smoothing\.free = preload"):
        problem_of(own, torques)


def test_what_is_freed_has_its_range(case, torques):
    smoothing = section(
        case.smoothing, free=("spring_rate", "phase"), spring_rate_range=(2e4, 3e4),
        phase_range=(-0.1, 0.2),
    )  # fmt: skip
    problem = problem_of(section(case, smoothing=smoothing), torques)
    assert problem.freed == {"rate": (2e4, 3e4), "phase": (-0.1, 0.2)}
    assert problem.energy == (0.0, 0.0)  # the initial energy is not among them


def test_a_lift_that_is_given_has_nothing_to_lower(case):
    with pytest.raises(InputError, match=r"smoothing\.kind"):
        problem_of(case, {})
