"""The convex part of the synthesis against two solvers of another kind."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import NonlinearConstraint, minimize
from synthesis_ratings import named, rated
from synthesis_scenarios import changed, loaded_with

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.case.limits import PRESSURE_ANGLE
from camwright.pipeline.smoothing.constrained_synthesis import started
from camwright.pipeline.smoothing.convex_relaxation import convex_start
from camwright.pipeline.smoothing.energy_spline import basis_matrix
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Problem
from camwright.pipeline.smoothing.trust_region import descended

COUNT, POINTS = 14, 60
RATE, PRELOAD, BASE = 24.2e3, 242.0, 0.05
THETA = uniform_turn(POINTS)
LEVEL, SLOPE = (basis_matrix(THETA, COUNT, order).toarray() for order in (0, 1))
# what binds: the travel; the pressure angle; the normal force; two of them at once
LIMITS = {
    "travel": {"travel": 0.02},
    "angle": {"travel": 0.045, "pressure_angle": np.radians(22.0)},
    "force": {"travel": 0.045, "normal_force": 800.0},
    "angle and travel": {"travel": 0.025, "pressure_angle": np.radians(18.0)},
}


def problem(**ratings):
    torque = 14.0 * np.sin(2 * THETA) + 6.0 * np.cos(3 * THETA)
    still = loaded_with("still", 0.0, torque, 0.0, 0.08, 0.03, 0.0, 0.0)
    return Problem(
        (still,), rated(roller_radius=0.008, **ratings), DesignVariables(RATE, PRELOAD, BASE),
        coefficients=COUNT, points=POINTS, jerk_weight=0.0,
    )  # fmt: skip


def cost(given):
    torque = given.scenarios[0].torque

    def value(c):
        rest = torque - SLOPE @ c / 2
        return float(rest @ rest / (torque @ torque))

    return value, lambda c: -SLOPE.T @ (torque - SLOPE @ c / 2) / (torque @ torque)


def room(given, c):
    """Every limit with its left room, scaled to about one; the angle by F_s r as it stands."""
    ratings, held = given.ratings, 1 - RESERVE
    square = PRELOAD**2 + 2 * RATE * np.maximum(LEVEL @ c, -1.0)
    lift = (np.sqrt(square) - PRELOAD) / RATE
    slope = SLOPE @ c
    found = [LEVEL @ c, (named(ratings).travel * held - lift) / named(ratings).travel]
    if PRESSURE_ANGLE.id in ratings.bounds:
        steepest = (
            np.tan(ratings.bounds[PRESSURE_ANGLE.id] * held) * np.sqrt(square) * (BASE + lift)
        )
        found += [(steepest - slope) / 10.0, (steepest + slope) / 10.0]
    if named(ratings).normal_force is not None:
        top = (named(ratings).normal_force * held) ** 2
        found.append(1.0 - (square + (slope / BASE) ** 2) / top)
    return np.concatenate(found)


@pytest.mark.parametrize("name", LIMITS)
def test_global_optimum_is_that_of_sequential_quadratic_programming(name):
    given = problem(**LIMITS[name])
    ours = convex_start(given)
    value, slope = cost(given)
    starts = np.random.default_rng(2).uniform(0.5, 6.0, (2, COUNT))
    rules = [{"type": "ineq", "fun": lambda c: room(given, c)}]
    for start in starts:
        theirs = minimize(value, start, jac=slope, constraints=rules, method="SLSQP",
                          options={"maxiter": 300, "ftol": 1e-14})  # fmt: skip
        assert theirs.success
        # Clarabel's gap and feasibility are 1e-8
        assert ours.ripple == pytest.approx(np.sqrt(theirs.fun), rel=1e-6)
    assert ours.ripple > 0.02  # a limit binds
    assert room(given, ours.coefficients).min() > -1e-6


def test_global_optimum_is_that_of_an_interior_point_method():
    given = problem(**LIMITS["angle"])
    value, slope = cost(given)
    rule = NonlinearConstraint(lambda c: room(given, c), 0.0, np.inf)
    theirs = minimize(value, np.full(COUNT, 3.0), jac=slope, constraints=[rule],
                      method="trust-constr", options={"gtol": 1e-9, "xtol": 1e-12,
                                                      "maxiter": 400})  # fmt: skip
    # its barrier ends at 1e-8 of the square
    assert convex_start(given).ripple == pytest.approx(np.sqrt(theirs.fun), rel=1e-4)


@pytest.mark.parametrize("name", ["travel", "angle", "angle and travel"])
def test_descent_from_the_exact_energy_ends_at_the_global_optimum(name):
    given = problem(**LIMITS[name])
    search = Search(given)
    found = descended(search, 1.0)
    assert search.state(search.start, given.variables).ripple != pytest.approx(found.state.ripple)
    # the descent stops at a foreseen gain of 2e-6
    assert found.state.ripple == pytest.approx(convex_start(given).ripple, abs=1e-5)


def test_real_synthesis_starts_from_the_convex_part():
    given = problem(**LIMITS["angle"])
    rubbing = changed(given.scenarios[0], cam_speed=78.0, mass=0.2, friction_a=0.15, friction_b=0.1)
    real = replace(given, scenarios=(rubbing,))
    np.testing.assert_array_equal(started(real).start, convex_start(real).coefficients)
    seed = np.full(COUNT, 2.0)
    np.testing.assert_array_equal(started(replace(real, seed=seed)).start, seed)


def test_energy_held_at_zero_leaves_more_ripple():
    free = problem(**LIMITS["angle"])
    held = replace(free, energy=(0.0, 0.0))
    found = convex_start(held)
    assert found.ripple > convex_start(free).ripple
    assert (LEVEL @ found.coefficients).min() == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    "change",
    [
        {"variables": DesignVariables(RATE, PRELOAD, 0.009)},
        {"ratings": rated(roller_radius=8e-3, offset=2e-3)},
    ],
)
def test_what_is_not_convex_has_no_convex_part(change):
    given = replace(problem(**LIMITS["angle"]), **change)
    assert convex_start(given) is None
