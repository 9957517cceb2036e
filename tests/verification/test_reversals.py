"""Synthesis with an offset follower, whose loads jump where it reverses."""

from functools import cache
from pathlib import Path

import numpy as np

from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.smoothing.constrained_synthesis import started
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.synthesis_problem import CONVERGED, coarsened
from camwright.pipeline.smoothing.trust_region import descended

MACHINES = Path(__file__).parents[2] / "cases" / "machines"
OFFSET = 'offset = "11.02 mm"\nwaviness_height = "5 um"'


@cache
def offset_search():
    """Search of the shipped compressor with a heavier follower on a smaller cam and an offset."""
    text = (MACHINES / "compressor.toml").read_text(encoding="utf-8")
    for before, after in (
        ('prime_radius = "60 mm"', f'prime_radius = "57.023 mm"\n{OFFSET}'),
        ('mass = "1.1 kg"', 'mass = "1.64193 kg"'),
    ):
        assert text.count(before) == 1
        text = text.replace(before, after)
    case = parse_case(text, MACHINES)
    return started(coarsened(problem_of(case, engine_torques(case))))


@cache
def optimum():
    return descended(offset_search(), 1.0)


def test_a_search_with_an_offset_converges():
    """Not stopped by a limit that jumps as a reversal passes a cam angle: 25 steps, gain < 0."""
    end = optimum()
    assert 0.0 <= end.gain <= CONVERGED
    assert end.steps <= 20
    assert end.state.violation <= 1e-6


def test_limits_hold_on_both_sides_of_a_reversal():
    """The slope of the lift vanishes there; the friction has the sign of the side."""
    search, state = offset_search(), optimum().state
    moving = slice(search.grid.theta.size, None)
    slope, top = state.grid.energy(state.coefficients)[1], np.abs(state.coefficients).max()
    assert slope[moving].size == 4
    before, after = (search.problem.grid(state.grid.theta[moving] + side).energy(state.coefficients)
                     for side in (-1e-6, 1e-6))  # fmt: skip
    np.testing.assert_array_less(np.abs(before[1]), 1e-4 * top)
    np.testing.assert_array_equal(np.sign(slope[moving][::2]), np.sign(before[1][::2]))
    np.testing.assert_array_equal(np.sign(slope[moving][1::2]), np.sign(after[1][1::2]))


def test_slopes_of_limits_at_a_reversal_follow_its_angle():
    """Against a step of 1e-6 of the scale; 1e-4: its second order."""
    search, state = offset_search(), optimum().state
    summit, first = search.summit(state), search.grid.theta.size
    rows = {}
    for name, value in state.pointwise.items():
        rows[name] = np.zeros(value.shape, dtype=bool)
        rows[name][:, first:] = True
    step = 1e-6 * np.random.default_rng(1).normal(size=search.size)
    there = search.state(*search.after(state, step))
    models = search.rows(state, summit, rows)
    assert len(models) > 5
    for each in models:
        now = search.level(each.name, there.pointwise[each.name][each.scenario, each.point])
        change, size = now - each.level, np.abs(each.entries * step[each.columns]).max()
        np.testing.assert_allclose(each.change(step), change, atol=1e-4 * size + 1e-13)
