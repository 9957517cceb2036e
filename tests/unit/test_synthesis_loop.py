"""What the trials of a synthesis take over from finite elements, and when they end."""

import numpy as np
import pytest
from made_check import made_check

from camwright.pipeline.smoothing.fe_correction import SETTLED, LimitShift, settled
from camwright.pipeline.smoothing.scenario import Correction


def shift(before, after, limit="guide_pv_A"):
    return LimitShift(limit, before, after)


def test_first_corrections_are_taken_over_whole():
    assert shift(0.9, 0.95).relaxation(None) == 1.0
    assert shift(0.9, 0.95).relaxation(shift(0.9, 0.95, "jump")) == 1.0
    assert shift(0.9, 0.95).relaxation(shift(0.9, 0.9)) == 1.0


def test_swinging_corrections_end_where_a_geometric_series_does():
    """x -> 1 - q x has its fixed point at 1/(1 + q): two steps and one of Aitken's reach it."""
    q, start = 0.6, 0.2
    first = 1 - q * start
    second = 1 - q * first
    share = shift(first, second).relaxation(shift(start, first))
    assert first + share * (second - first) == pytest.approx(1 / (1 + q), abs=1e-12)


def test_a_series_that_goes_one_way_is_left_alone():
    assert shift(0.95, 0.97).relaxation(shift(0.9, 0.95)) == 1.0


def check(demand, lift_can_help=True):
    return made_check("x", demand, 1.0, lift_can_help=lift_can_help)


@pytest.mark.parametrize(
    ("share", "checks", "ends"),
    [
        (0.99 * SETTLED, [check(0.9)], True),
        (1.01 * SETTLED, [check(0.9)], False),
        (0.99 * SETTLED, [check(1.1)], False),  # a limit fails that the lift may still meet
        (0.99 * SETTLED, [check(1.1, lift_can_help=False)], True),
        (0.0009, [check(1.1)], True),
    ],
)
def test_trials_end_where_nothing_moves_that_the_lift_can_help(share, checks, ends):
    assert settled(shift(0.9, 0.9 + share), checks) is ends


def test_part_of_the_way_from_one_correction_to_another():
    coarse, fine = Correction.none(8), Correction(*np.full((6, 12), 1.4))
    half = coarse.towards(fine, 0.5)
    assert half.contact.shape == (12,)
    np.testing.assert_allclose(half.jam, 1.2)
    assert coarse.towards(fine, 1.0) is fine


def test_sentence_names_the_limit_and_both_shares():
    assert "guide_pv_A from 0.9 to 0.95" in shift(0.9, 0.95).sentence
    assert "no utilisation" in LimitShift("", 0.0, 0.0).sentence
