"""What is said of several starts of a synthesis."""

import pytest

from camwright.pipeline.smoothing.multistart import Starts


def test_starts_that_end_within_a_percent_agree():
    found = Starts((0.1, 0.1009, 0.1))
    assert found.agree and found.spread == pytest.approx(0.009)
    assert found.sentence == "3 starts agree on the ripple within 0.9 %"


def test_starts_that_do_not_agree_say_so():
    found = Starts((0.1, 0.12, None))
    assert not found.agree
    assert "do not agree" in found.sentence
    assert "1 lead to no cam" in found.sentence and "20 %" in found.sentence


def test_nothing_left_is_nothing_to_differ_by():
    assert Starts((1e-6, 5e-5)).agree


def test_no_start_within_the_limits():
    found = Starts((None, None))
    assert not found.agree
    assert found.sentence == "no start of 2 leads to a cam within all limits"


def test_one_start_tells_nothing_of_others():
    assert "not excluded" in Starts((0.1,)).sentence


def test_record_has_what_the_sentence_says():
    record = Starts((0.1, None)).as_record()
    assert record["tried"] == 2 and record["ripple_left"] == [0.1, None]
    assert record["agree"] is False and record["sentence"]
