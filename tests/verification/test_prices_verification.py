"""What limits cost: the radius of the cam as a limit, and prices against designs solved again."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthesis_ratings import rated
from synthesis_scenarios import loaded_with

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.bounds import bounds_of
from camwright.pipeline.smoothing.constrained_synthesis import synthesise
from camwright.pipeline.smoothing.constraints import shape_utilisations
from camwright.pipeline.smoothing.objective import objective_of
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.shadow_prices import (
    FLOOR,
    NUMBERS,
    PHASE,
    limits_in_use,
    machine_prices,
    prices,
    problem_like,
)
from camwright.pipeline.smoothing.synthesis_problem import Problem


@pytest.mark.parametrize("offset", [0.0, 0.004])
def test_room_for_the_cam_is_that_of_its_contour(offset):
    theta = uniform_turn(360)
    lift = Lift(theta, 0.01 * (1 - np.cos(2 * theta)))
    radius = np.hypot(*RollerContour(PitchCurve(lift, 0.05, offset), 0.008).points(theta))
    ratings = rated(roller_radius=0.008, offset=offset, cam_radius=0.06)
    jet, variables = Jet(*lift.derivatives(theta, 3)), DesignVariables(1e4, 1e2, 0.05)
    utilisations = shape_utilisations(jet, variables, ratings)
    np.testing.assert_allclose(0.06 * utilisations["cam_radius"], radius, rtol=1e-12)


TURN = uniform_turn(240)
TORQUE = 8.0 * np.sin(2 * TURN) + 5.0 * np.cos(3 * TURN) + 2.0 * np.sin(5 * TURN + 0.5)
RATINGS = rated(
    roller_radius=0.016, travel=0.05, pressure_angle=np.radians(40.0), jam_index=0.8,
    curvature_ratio=1.2, undercut_factor=0.1, contact_width=0.014, contact_modulus=115e9,
    guide_area=(4e-4, 4e-4),
)  # fmt: skip
LIFE = 8e10  # N^3 rad/s


def asked(**ratings):
    running = loaded_with("idle", 78.5, TORQUE, 0.2, 0.08, 0.038, 0.06, 0.06)
    return Problem(
        (running,), rated(RATINGS, **ratings), DesignVariables(24.2e3, 242.0, 0.056),
        coefficients=36, points=240,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("limit", "given", "unit"),
    [
        ("roller_static", {"normal_force": 700.0, "force_safety": 1.5}, 1.0 / 1.5),
        ("pressure_angle", {"pressure_angle": np.radians(20.0), "travel": 0.03}, np.radians(1.0)),
        (
            "return_pressure_angle",
            {
                "return_pressure_angle": np.radians(20.0),
                "pressure_angle": np.radians(25.0),
                "travel": 0.03,
            },
            np.radians(1.0),
        ),
        ("contact_pressure", {"pressure": 400e6}, 1e6),
        ("spring_travel", {"travel": 0.018}, 1e-3),
        ("concave_radius", {"hollow_radius": 0.15, "travel": 0.03}, 1.1e-3),
        ("cam_radius", {"cam_radius": 0.058}, 1e-3),
        ("curvature_ratio", {"curvature_ratio": 3.2, "travel": 0.03}, 1.0),
        ("jump_speed", {"jump_speed": 420.0}, np.pi / 30.0),
        ("roller_life", {"life_force_cubed": LIFE, "dynamic_rating": 5000.0}, None),
        ("guide_pv_A", {"guide_pv": (0.35e6, None)}, 1e6),
        ("guide_pressure_A", {"guide_pressure": (0.7e6, None)}, 1e6),
    ],
)
def test_price_is_the_difference_of_designs_solved_again(limit, given, unit):
    """Two thousandths more and less of each limit, everything designed anew."""
    problem = asked(**given)
    design = synthesise(problem)
    assert design.feasible
    record = next(r for r in prices(design, problem) if r["limit"] == limit)
    name = next(iter(given))
    # the price of the hollow is so small that the ripple needs a greater step to show it
    share = 1e-2 if limit == "concave_radius" else 2e-3

    def ripple(factor):
        value = given[name]
        changed = (value[0] * factor, None) if isinstance(value, tuple) else value * factor
        other = replace(problem, ratings=rated(problem.ratings, **{name: changed}))
        return synthesise(replace(other, seed=design.coefficients)).ripple * np.std(TORQUE)

    gained = ripple(1.0 - share) - ripple(1.0 + share)
    if unit is None:  # the life's limit grows with the cube of the rating
        step = 2.0 * share * given["dynamic_rating"] / 3.0
    else:
        whole = given[name][0] if isinstance(given[name], tuple) else given[name]
        step = 2.0 * share * whole / unit
    # second order in the step, and the designs are solved to 2e-6 of the ripple
    assert record["ripple_per_unit_Nm"] == pytest.approx(gained / step, rel=0.01)
    assert record["sentence"].endswith("N m off the ripple")


@pytest.mark.parametrize(
    ("limit", "given", "unit"),
    [
        ("roller_static", {"normal_force": 700.0, "force_safety": 1.5}, 1.0 / 1.5),
        ("spring_travel", {"travel": 0.018}, 1e-3),
        ("pressure_angle", {"pressure_angle": np.radians(20.0), "travel": 0.03}, np.radians(1.0)),
    ],
)
def test_price_with_a_size_weight_is_that_of_the_objective(limit, given, unit):
    objective = objective_of({"torque": 1.0, "size": 0.05})
    problem = replace(asked(**given), objective=objective)
    design, bare = synthesise(problem), synthesise(asked(**given))
    assert design.feasible and design.converged
    assert design.cost > 0.0 and design.ripple > bare.ripple
    record = next(r for r in prices(design, problem) if r["limit"] == limit)
    name, share = next(iter(given)), 2e-3

    def merit(factor):
        ratings = rated(problem.ratings, **{name: given[name] * factor})
        other = synthesise(replace(problem, ratings=ratings, seed=design.coefficients))
        return other.objective * np.std(TORQUE)

    gained = merit(1.0 - share) - merit(1.0 + share)
    step = 2.0 * share * given[name] / unit
    # second order in the step, and the designs are solved to 2e-6 of the ripple
    assert record["ripple_per_unit_Nm"] == pytest.approx(gained / step, rel=0.01)


def test_what_is_said_of_a_limit_has_its_size_and_unit():
    ratings = rated(RATINGS, normal_force=700.0, force_safety=1.5, hollow_radius=0.066,
                      life_force_cubed=LIFE, dynamic_rating=9e3)  # fmt: skip
    bounds = bounds_of(ratings)
    assert bounds["roller_static"].value == pytest.approx(1050.0)  # the rating, its safety inside
    assert bounds["concave_radius"].value == pytest.approx(60.0)  # the tool's, a tenth left off
    assert bounds["concave_radius"].slope < 0 < bounds["roller_static"].slope
    assert (bounds["roller_life"].value, bounds["roller_life"].unit) == (9e3, "N")
    assert bounds["pressure_angle"].value == pytest.approx(40.0)


def test_limits_in_use_stand_at_the_cam_angles_of_the_lift():
    """The spring travel is all in use where the lift is greatest, the phase of the cam inside."""
    problem = asked(travel=0.018)
    design = synthesise(problem)
    turned = replace(design, variables=replace(design.variables, phase=0.3))
    for each in (design, turned):
        angles, uses = limits_in_use(each)
        assert np.all(np.diff(angles) > 0)
        lift = each.lift(1440)(angles)
        # the lift is sampled at 1440 angles and interpolated
        np.testing.assert_allclose(uses["spring_travel"], lift / 0.018, atol=1e-4)
    assert next(iter(uses)) == "spring_travel"  # the most used is named first


CASES = Path(__file__).parents[2] / "cases"


def optimum_of(jerk_weight, corners=False, **tolerances):
    """The redesigned case at its nominal values by default: case, torques, problem, design.

    Without speed limits of the guides, and with a lower limit of the curvature ratio: the optimum
    is so near those of the case that a step would reach them.
    """
    case = read_case(CASES / "gx120-redesign.toml")
    slow, fast = case.guides, {"speed_limit": None}
    guides = replace(slow, a=replace(slow.a, **fast), b=replace(slow.b, **fast))
    case = case.model_copy(update={"guides": guides})
    changed = {"corners": corners, "jerk_weight": jerk_weight, "loss_weight": 0.0}
    case = case.model_copy(update={"smoothing": case.smoothing.model_copy(update=changed)})
    case = replaced(case, {"limits.curvature_ratio": 1.5} | tolerances)
    torques = engine_torques(case)
    problem = problem_of(case, torques)
    return case, torques, problem, synthesise(problem)


@pytest.fixture(scope="module")
def optimum():
    """An optimum whose objective is the ripple."""
    return optimum_of(1e-5)


def objective_value(problem, design):
    state = Search(problem).state(design.coefficients, design.variables)
    return state.ripple + state.cost + state.jerk


def difference_of_new_optima(optimum, key):
    """Decrease of the objective by 1 % more of a number, N m: 1 % less and more, solved again."""
    case, torques, problem, design = optimum
    number, share = next(each for each in NUMBERS if each.key == key), 1e-2

    def solved_again(side):
        changed = number.increased(case, side * share * number.value(case))
        other = replace(problem_like(problem, changed, torques), seed=design.coefficients)
        solved = synthesise(other)
        assert solved.converged
        assert solved.feasible
        return objective_value(other, solved)

    before = max(np.std(item.torque) for item in problem.scenarios if item.weight > 0)
    return before * (solved_again(-1.0) - solved_again(1.0)) / (200.0 * share)


def price_of(optimum, key):
    case, torques, problem, design = optimum
    records = machine_prices(design, problem, case, torques)
    return next(each for each in records if each["parameter"] == key)


@pytest.mark.parametrize(
    "key",
    [
        "roller.radius",
        *(
            pytest.param(key, marks=pytest.mark.slow)
            for key in ("spring.rate", "cam.base_radius", "follower.mass")
        ),
    ],
)
def test_price_of_a_number_of_the_machine_is_the_difference_of_new_optima(optimum, key):
    """Within 1 %: second order in the step, and optima converged to 1e-6 of the ripple."""
    expected = difference_of_new_optima(optimum, key)
    record = price_of(optimum, key)
    assert record["ripple_per_percent_Nm"] == pytest.approx(expected, rel=0.01)
    per_percent = record["ripple_per_unit_Nm"] * record["value"] / 100.0
    assert per_percent == pytest.approx(record["ripple_per_percent_Nm"], rel=1e-12)
    assert record["sentence"].endswith("N m off the ripple")


@pytest.mark.slow
def test_price_with_a_jerk_weight_is_that_of_the_objective():
    weighted = optimum_of(4.0)
    for key in ("roller.radius", "spring.preload"):
        record = price_of(weighted, key)
        expected = difference_of_new_optima(weighted, key)
        # second order in the step, and optima converged to 1e-6 of the ripple
        assert record["ripple_per_percent_Nm"] == pytest.approx(expected, rel=0.01)
        assert record["sentence"].endswith("N m off the objective")


@pytest.mark.slow
def test_price_of_the_phase_tolerance_is_the_difference_of_new_optima():
    """Of a tolerance wide enough for its ends to have the greatest ripples, both of them."""
    wide = optimum_of(1e-5, corners=True, **{
        "tolerances.phase": np.radians(8.0), "tolerances.mass": 1e-6,
        "spring.rate_tolerance": 1e-6, "spring.preload_tolerance": 1e-6,
    })  # fmt: skip
    record = price_of(wide, "tolerances.phase")
    expected = difference_of_new_optima(wide, "tolerances.phase")
    assert record["ripple_per_percent_Nm"] < 0
    # second order in the step, and optima converged to 1e-6 of the ripple
    assert record["ripple_per_percent_Nm"] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(
    ("splines", "spacings", "tolerance"),
    [
        (64, 5.0, 1e-5),  # of the convergence; the points of the cam angle remain
        # of the splines, which do not shift: 2.4e-3 with 64
        pytest.param(96, 2.5, 5e-4, marks=pytest.mark.slow),
    ],
)
def test_phase_on_the_shaft_has_no_price_as_the_lift_shifts(optimum, splines, spacings, tolerance):
    """Engine torque delayed by spacings of the splines, solved again from its own start."""
    case, torques, problem, design = optimum
    if splines != problem.coefficients:
        problem = replace(problem, coefficients=splines)
        design = synthesise(problem)
    shift = 2.0 * np.pi * spacings / splines
    turned = [replace(item, torque=item.torque_at(-shift)[0]) for item in problem.scenarios]
    solved = synthesise(replace(problem, scenarios=tuple(turned)))
    assert solved.feasible
    assert solved.converged
    assert solved.ripple == pytest.approx(design.ripple, rel=tolerance)
    theta, top = np.linspace(0.0, 2.0 * np.pi, 90), design.lift().highest.value
    # the lift is flat in the ripple: of second order
    tight = np.sqrt(tolerance) * top
    np.testing.assert_allclose(solved.lift()(theta + shift), design.lift()(theta), atol=tight)
    record = machine_prices(design, problem, case, torques)[-1]
    assert record["parameter"] == PHASE
    assert record["ripple_per_unit_Nm"] == 0.0
    assert "no limit depends on the angle" in record["sentence"]


def test_numbers_stand_as_in_the_case_and_change_together(optimum):
    case, *_ = optimum
    radius = {each.key: each for each in NUMBERS if "radius" in each.key}
    assert radius["cam.base_radius"].value(case) == case.cam.prime_radius - case.roller.radius
    larger = radius["roller.radius"].increased(case, 1e-3)
    assert larger.roller.radius == pytest.approx(case.roller.radius + 1e-3, abs=1e-15)
    # the base radius stays
    base = radius["cam.base_radius"]
    assert base.value(larger) == pytest.approx(base.value(case), abs=1e-15)


def test_prices_belong_to_a_converged_feasible_design_alone(optimum):
    case, torques, problem, design = optimum
    for changed in ({"gain": 1.0}, {"utilisation": {"jump": 1.1}}):
        other = replace(design, **changed)
        assert machine_prices(other, problem, case, torques) == []
        assert prices(other, problem) == []


def test_prices_below_the_floor_and_of_free_numbers_are_left_out(optimum):
    case, torques, problem, design = optimum
    keys = [each["parameter"] for each in machine_prices(design, problem, case, torques)]
    freed = replace(problem, freed={"rate": (1e4, 1e5)})
    left = [each["parameter"] for each in machine_prices(design, freed, case, torques)]
    assert "spring.rate" in keys
    assert left == [key for key in keys if key != "spring.rate"]
    assert left[-1] == PHASE
    turned = replace(problem, freed={"phase": (-0.1, 0.1)})
    ours = [each["parameter"] for each in machine_prices(design, turned, case, torques)]
    assert ours == keys[:-1]
    assert prices(replace(design, multipliers={"jump": 0.5 * 100.0 * FLOOR}), problem) == []
