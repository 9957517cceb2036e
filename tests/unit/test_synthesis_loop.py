"""What the trials of a synthesis take over from finite elements, and when they end."""

from dataclasses import replace

import numpy as np
import pytest
from made_check import made_check
from synthesis_problems import measured
from synthesis_ratings import rated
from synthesis_scenarios import loaded_with

from camwright.pipeline.checks.check import Check
from camwright.pipeline.smoothing.fe_correction import (
    SETTLED,
    SETTLED_RIPPLE,
    Comparison,
    LimitShift,
    corrected,
    judged_over,
    rank,
    shares,
)
from camwright.pipeline.smoothing.linear_model import Linear
from camwright.pipeline.smoothing.sampled_problem import Search
from camwright.pipeline.smoothing.scenario import Correction, DesignVariables
from camwright.pipeline.smoothing.synthesis_problem import RESERVE, Design, Problem


def comparison(ripple_shift=0.0, converged=True, **shifts):
    """A comparison whose shifts end at 1 of their limit."""
    changes = (LimitShift(name, 1.0 - change, 1.0) for name, change in shifts.items())
    return Comparison((), (), rated(roller_radius=0.01), tuple(changes), ripple_shift, converged)


def test_first_corrections_are_taken_over_whole():
    np.testing.assert_array_equal(shares([[0.05]]), [1.0])


def test_corrections_that_change_nothing_are_those_of_the_latest_cam():
    np.testing.assert_array_equal(shares(np.zeros((2, 3))), [0.0, 0.0, 1.0])


def test_alternating_changes_end_where_a_geometric_series_does():
    """x -> 1 - q x has its fixed point at 1/(1 + q): two cams and their mean reach it."""
    q, start = 0.6, 0.2
    first = 1 - q * start
    second = 1 - q * first
    weights = shares([[first - start, second - first]])
    # the sum of the shares is held by a weight of 1e3
    assert weights @ [first, second] == pytest.approx(1 / (1 + q), abs=1e-6)


def test_a_series_that_goes_one_way_is_not_held_back():
    np.testing.assert_allclose(shares([[0.05, 0.02]]), [0.0, 1.0])


def test_a_growing_series_still_takes_over_part_of_the_latest():
    np.testing.assert_allclose(shares([[0.02, 0.05]]), [0.75, 0.25])


def changes_by_turns(slopes: np.ndarray, count: int, mixed: bool) -> list[float]:
    """Greatest change of each round of x -> 1 - slopes x, a limit a component."""
    level, after, changes = np.zeros(len(slopes)), [], []
    for _ in range(count):
        after.append(1.0 - slopes * level)
        changes.append(after[-1] - level)
        weights = shares(np.array(changes).T) if mixed else np.eye(len(after))[-1]
        level = weights @ after
    return [float(np.abs(change).max()) for change in changes]


def test_several_limits_that_alternate_settle_within_six_trials():
    """Limits that alternate by 0.95, 0.7 and 0.4: mixing settles, a plain repetition does not."""
    slopes = np.array([0.95, 0.7, 0.4])
    plain, mixed = (changes_by_turns(slopes, 6, mixed=each) for each in (False, True))
    assert plain[-1] > 0.7
    assert mixed[-1] < SETTLED


def check(demand, lift_can_help=True, name="x") -> Check:
    return made_check(name, demand, 1.0, lift_can_help=lift_can_help)


@pytest.mark.parametrize(
    ("before", "after", "ends"),
    [
        (0.9, 0.9 + 0.99 * SETTLED, True),
        (0.9, 0.9 + 1.01 * SETTLED, False),
        (1.0 - 0.99 * SETTLED, 1.001, False),  # a limit is exceeded that the lift may still meet
        (1.001 - 0.99 * RESERVE, 1.001, True),
        (0.4, 0.49, True),  # used by less than one half
    ],
)
def test_trials_end_where_no_used_limit_shifts(before, after, ends):
    still = LimitShift("jump", 0.9, 0.9)
    shifts = (still, LimitShift("travel", before, after))
    made = Comparison((), (), rated(roller_radius=0.01), shifts, 0.0)
    assert made.settled is ends
    assert made.agree is (abs(after - before) < SETTLED or after < 0.5)


@pytest.mark.parametrize(
    ("ripple", "converged", "ends"),
    [
        (0.99 * SETTLED_RIPPLE, True, True),
        (-1.01 * SETTLED_RIPPLE, True, False),
        (0.0, False, False),  # the multipliers of an unconverged design forecast nothing
    ],
)
def test_trials_end_where_a_further_one_leaves_the_ripple(ripple, converged, ends):
    assert comparison(ripple, converged, jump=0.0).settled is ends


def test_the_best_trial_passes_with_the_least_ripple_else_violates_least():
    passing, gentler = rank([check(0.99)], 0.5), rank([check(0.9)], 0.6)
    slightly, strongly = rank([check(1.001)], 0.3), rank([check(1.4), check(1.001)], 0.2)
    assert sorted([strongly, gentler, slightly, passing]) == [passing, gentler, slightly, strongly]
    # where contact is lost, the other limits still count
    lost_contact = check(np.inf)
    lost_and_far = rank([lost_contact, check(1.4)], 0.2)
    assert sorted([lost_and_far, rank([lost_contact], 0.5), strongly])[0] == strongly
    assert rank([lost_contact], 0.5) < lost_and_far
    # a check that no lift changes, or that a deeper solution judges, does not count
    assert rank([check(1.4, lift_can_help=False)], 0.5) == passing
    lost = made_check("torque_reduction", 0.3, 0.4, sense="at_least", lift_can_help=False)
    assert rank([lost], 0.5) > passing
    # neither does one beyond its limit by the error bar alone pass
    unproven = made_check("jump", 0.999, 1.0, lift_can_help=True, error_share=0.01)
    assert unproven.status == "fail"
    assert rank([unproven], 0.5) > passing


def test_next_trial_starts_from_the_design_with_the_mean_of_two_cams_that_alternate():
    """Bearing loads of 1.2 and 1.4 times the closed form, each the correction of the other cam."""
    variables = DesignVariables(1e4, 1e2, 0.05)
    running = loaded_with("idle", 78.5, np.sin(np.arange(12.0)), 0.2, 0.08, 0.038, 0.06, 0.06)
    ratings = rated(roller_radius=0.016, guide_pressure=(1e4, None), guide_area=(4e-4, 4e-4))
    problem = Problem((running,), ratings, variables, coefficients=12, points=12)
    energy = 0.3 + 0.2 * np.cos(2 * np.pi * np.arange(12) / 12)
    design = Design(energy, variables, 0.5, 0.0, {}, {}, {}, 3, 0.0)
    none = Correction.none(12)
    low, high = (replace(none, guide_a=np.full(12, level)) for level in (1.2, 1.4))
    tighter = rated(ratings, guide_pressure=(0.9e4, None))
    after = corrected(
        problem,
        design,
        [
            Comparison((low,), (high,), ratings, (), 0.0),
            Comparison((high,), (low,), tighter, (), 0.0),
        ],
    )
    assert after.ratings is tighter
    assert after.seed is design.coefficients
    np.testing.assert_allclose(after.scenarios[0].correction.guide_a, 1.3, rtol=1e-6)


def test_part_of_the_way_from_one_correction_to_another():
    coarse, fine = Correction.none(8), replace(Correction.none(12), jam=np.full(12, 1.4))
    half = coarse.towards(fine, 0.5)
    assert half.contact.shape == (12,)
    np.testing.assert_allclose(half.jam, 1.2, rtol=1e-12)
    assert coarse.towards(fine, 1.0) is fine


def test_sentence_names_the_limit_and_both_shares():
    assert "guide_pv_A from 0.95 to 1 of" in comparison(guide_pv_A=0.05, jump=-0.01).sentence
    assert "no utilisation" in comparison().sentence


def test_failed_checks_are_judged_over_the_synthesis_at_corner_and_error_bar():
    """A corner 4 % above the nominal, which the synthesis sees, with an error bar of 1 %."""
    at_corner = {"lift_can_help": True, "corner": "rate high", "corner_demand": 1.04}
    failed = made_check("guide_pressure_A", 1.0, 1.0, error_share=0.01, **at_corner)
    passed = made_check("jump", 0.5, 1.0, lift_can_help=True, corner="m", corner_demand=0.6)
    uses = {"guide_pressure_A": 0.999, "jump": 0.5, "travel": 0.9}
    ratios = judged_over(uses, [failed, passed], known={})
    assert ratios == {"guide_pressure_A": pytest.approx(1.04 * 1.01 / 0.999)}
    # one that was known stays so where it passes by it; all are known where limits conflict
    assert judged_over(uses, [passed], known={"jump": 1.5}) == {"jump": pytest.approx(1.2)}
    assert judged_over(uses, [passed], known={"jump": 1.1}) == {"jump": pytest.approx(1.2**2 / 1.1)}
    assert set(judged_over(uses, [failed, passed], known=None)) == {"guide_pressure_A", "jump"}
    # a least value; the ripple by what is left of it; none below the synthesis
    least = made_check("margin", 1.2, 1.0, sense="at_least", corner="m", corner_demand=0.8)
    assert judged_over({"margin": 1 / 1.2}, [least], known={}) == {"margin": pytest.approx(1.5)}
    ripple = made_check(
        "torque_reduction", 0.5, 0.5, sense="at_least", corner="phase", corner_demand=0.4
    )
    assert judged_over({"torque_reduction": 1.0}, [ripple], known={}) == {
        "torque_reduction": pytest.approx(1.2)
    }
    assert judged_over({"guide_pressure_A": 2.0}, [failed], known={}) == {"guide_pressure_A": 1.0}
    assert judged_over(uses, [], known=None) == {}


def test_utilisations_and_their_slopes_are_those_by_which_a_run_judges():
    problem = replace(measured("v10"), coefficients=36, points=240)
    problem = replace(
        problem,
        scenarios=tuple(replace(one, torque=one.torque[::3]) for one in problem.scenarios),
    )
    plain = Search(problem)
    before = plain.state(plain.exact, problem.variables)
    ratios = {name: 1.1 + 0.01 * k for k, name in enumerate(sorted(before.utilisation))}
    ratios["torque_reduction"] = 1.25
    search = Search(replace(problem, judged=ratios))
    state = search.state(plain.exact, problem.variables)
    assert len(before.pointwise) > 5 and before.means
    for name, use in (before.pointwise | before.means).items():
        now = (state.pointwise | state.means)[name]
        np.testing.assert_allclose(now, ratios[name] * use, rtol=1e-12)

    def entries(own: Search, at) -> dict[str, np.ndarray]:
        summit = own.summit(at)
        one = np.ones(1, dtype=bool)
        rows = {name: np.ones_like(use, dtype=bool) for name, use in at.pointwise.items()}
        means, _ = own.means(
            at, summit, {name: np.repeat(one, use.size) for name, use in at.means.items()}
        )
        models: list[Linear] = [*own.rows(at, summit, rows), *means]
        return {f"{each.name} {k}": each.entries for k, each in enumerate(models)}

    slopes = entries(plain, before)
    for key, now in entries(search, state).items():
        np.testing.assert_allclose(now, ratios[key.split()[0]] * slopes[key], rtol=1e-9, atol=1e-12)
    assert search.problem.ceiling == pytest.approx(problem.ceiling / 1.25)


def test_no_ratio_leaves_a_synthesis_as_it_was():
    problem = replace(measured("v08"), coefficients=36, points=240)
    problem = replace(
        problem,
        scenarios=tuple(replace(one, torque=one.torque[::3]) for one in problem.scenarios),
    )
    one = dict.fromkeys(Search(problem).state(Search(problem).exact, problem.variables).utilisation)
    for judged in ({}, dict.fromkeys(one, 1.0)):
        search = Search(replace(problem, judged=judged))
        state = search.state(search.exact, problem.variables)
        plain = Search(problem).state(search.exact, problem.variables)
        assert state.utilisation == plain.utilisation
