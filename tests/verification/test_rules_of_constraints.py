"""Rules of every constraint: pointwise over stacked scenarios, and derivatives by complex steps.

A search evaluates constraints on the grid of scenarios and angles and at scattered pairs of both. A
mean over the rows of the pairs, or a magnitude that drops the imaginary part, raises nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest
from synthesis_problems import constrained, described, with_corrections
from synthesis_ratings import rated

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet
from camwright.pipeline.smoothing.cam_state import Mean, lift_jet, loaded
from camwright.pipeline.smoothing.constraints import (
    CONSTRAINTS,
    shape_utilisations,
    utilisations_of,
)
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Scenario, taken
from camwright.pipeline.smoothing.synthesis_problem import Problem

PATHS = {"roller": "cases/gx120-redesign.toml", "face": "cases/gx120-flat-face.toml",
         "arm": "cases/gx120-arm.toml"}  # fmt: skip
NAMES = [
    (follower, each.name)
    for follower in PATHS
    for each in CONSTRAINTS
    if each.needs in ("", *(("face",) if follower == "face" else ("roller", "round")))
]


class State(NamedTuple):
    """Problem with corrections, its stacked scenarios and the lift of its start."""

    problem: Problem
    stack: Scenario
    jet: Jet
    highest: float

    def uses(self, jet: Jet, stack: Scenario) -> Mapping[str, Array | Mean]:
        variables, ratings = self.problem.variables, self.problem.ratings
        shape = shape_utilisations(jet, variables, ratings)
        return {**shape, **utilisations_of(loaded(jet, self.highest, variables, ratings, stack))}


@cache
def state(follower: str) -> State:
    problem = constrained(PATHS[follower])
    if follower == "roller":
        problem = described(problem)
        ratings = rated(problem.ratings, return_pressure_angle=np.radians(20.0))
        problem = replace(problem, ratings=ratings)
    problem = with_corrections(problem, 3)
    search = Search(problem)
    variables = problem.variables
    jet = Jet(*lift_jet(search.turn.energy(search.start), variables))
    stack = search.stack(search.turn, variables)
    return State(problem, stack, jet, search.highest(search.start, variables))


@cache
def on_the_grid(follower: str) -> Mapping[str, Array | Mean]:
    at = state(follower)
    return at.uses(at.jet, at.stack)


def of(follower: str, name: str) -> Array | Mean:
    uses = on_the_grid(follower)
    if name not in uses:
        pytest.skip("no limit in the problem")
    return uses[name]


@pytest.mark.parametrize(("follower", "name"), NAMES)
def test_a_constraint_at_pairs_is_that_of_the_grid(follower: str, name: str) -> None:
    grid, at = of(follower, name), state(follower)
    if isinstance(grid, Mean):
        pytest.skip("a mean over the turn")
    shape = (len(at.problem.scenarios), at.jet.lift.size)
    rows, points = np.array([0, 1, 1, 0, 1]), np.array([5, 5, 300, 611, 2])

    def take(each: Array) -> Array:
        return np.broadcast_to(each, shape)[rows, points]

    pairs = at.uses(at.jet.at(lambda each: each[points]), taken(at.stack, take))
    own = np.broadcast_to(pairs[name], rows.shape)
    np.testing.assert_array_equal(own, np.broadcast_to(grid, shape)[rows, points])


@cache
def along(follower: str) -> tuple[Mapping[str, Array], Mapping[str, Array]]:
    """Derivatives along a random change of the lift: by a complex step, by differences."""
    at, draw = state(follower), np.random.default_rng(1)
    way = [draw.normal(size=each.size) * np.abs(each).max() for each in at.jet]

    def terms(step: complex) -> Mapping[str, Array]:
        jet = Jet(*(a + step * b for a, b in zip(at.jet, way, strict=True)))
        with np.errstate(all="ignore"):
            uses = at.uses(jet, at.stack)
        return {k: each.terms if isinstance(each, Mean) else each for k, each in uses.items()}

    exact = {name: np.imag(each) / 1e-30 for name, each in terms(1e-30j).items()}
    up, down = terms(1e-7), terms(-1e-7)
    return exact, {name: (up[name] - down[name]) / 2e-7 for name in exact}


@pytest.mark.parametrize(("follower", "name"), NAMES)
def test_the_complex_step_of_a_constraint_is_the_difference_quotient(
    follower: str, name: str
) -> None:
    of(follower, name)
    exact, quotient = (each[name] for each in along(follower))
    near = np.abs(exact - quotient) <= 1e-5 * np.abs(exact).max() + 1e-12
    assert np.mean(near) > 0.98  # but where a magnitude has its kink
    assert np.any(exact != 0.0) or not np.any(np.abs(quotient) > 1e-9)
