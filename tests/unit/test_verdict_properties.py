"""The verdict never improves when anything becomes worse, and no data are never a pass."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st
from made_check import made_check

from camwright.pipeline.base.verdict import STATUSES, verdict
from camwright.pipeline.checks.check import Check, Waived
from camwright.pipeline.results import check_records

WORSE = ("pass", "incomplete", "fail")
LIMIT = 1.0
SHARES = st.one_of(st.none(), st.sampled_from([0.0, 1e-9]), st.floats(0.0, 0.5))
DEMANDS = st.one_of(
    st.none(),
    st.sampled_from([math.nan, math.inf, -math.inf, 0.0, 0.999, 1.0, 1.001]),
    st.floats(-3.0, 3.0),
)


@st.composite
def checks(draw: st.DrawFn, name: str = "x") -> Check:
    """A check of any kind: both senses, missing data, corner, error bar, waiver, optional."""
    sense = draw(st.sampled_from(["at_most", "at_least"]))
    corner = draw(DEMANDS)
    return made_check(
        name,
        draw(DEMANDS),
        draw(st.sampled_from([LIMIT, LIMIT, LIMIT, 0.0, None, math.inf])),
        sense=sense,
        must_have=draw(st.sampled_from([True, True, False])),
        corner="" if corner is None else "mass high",
        corner_demand=corner,
        error_share=draw(SHARES),
        waiver=draw(st.one_of(st.none(), st.builds(Waived, st.just("A"), st.floats(-3.0, 3.0)))),
    )


def severity(several: list[Check]) -> int:
    return WORSE.index(verdict(several))


def towards_failure(one: Check, step: float) -> float:
    """A positive step in the sense in which a demand becomes worse."""
    return step if one.sense == "at_most" else -step


SETS = st.lists(checks(), min_size=1, max_size=4)
STEPS = st.floats(0.0, 5.0)
QUICK = settings(max_examples=40, deadline=None)


@QUICK
@given(SETS, st.integers(0, 3), STEPS)
def test_a_tighter_limit(several: list[Check], place: int, step: float) -> None:
    one = several[place % len(several)]
    if one.limit is None or not math.isfinite(one.limit):
        return
    tighter = replace(one, limit=one.limit - towards_failure(one, step))
    assert severity([tighter if each is one else each for each in several]) >= severity(several)


@QUICK
@given(SETS, checks(name="added"))
def test_one_check_more(several: list[Check], added: Check) -> None:
    if any(each.must_have for each in several):  # without any the verdict is FAIL
        assert severity([*several, added]) >= severity(several)


@QUICK
@given(SETS, st.integers(0, 3), STEPS)
def test_one_load_case_more(several: list[Check], place: int, step: float) -> None:
    """The extreme over the load cases becomes worse, or is no longer known."""
    one = several[place % len(several)]
    if one.demand is None or math.isnan(one.demand):
        return
    for demand in (one.demand + towards_failure(one, step), math.nan, None):
        worse = replace(one, demand=demand)
        after = severity([worse if each is one else each for each in several])
        known = demand is not None and not math.isnan(demand)
        assert after >= severity(several) if known else after > 0 or not worse.must_have


@QUICK
@given(SETS, st.integers(0, 3), st.floats(0.0, 2.0))
def test_a_wider_error_bar(several: list[Check], place: int, more: float) -> None:
    one = several[place % len(several)]
    wider = replace(one, error_share=(one.error_share or 0.0) + more)
    assert severity([wider if each is one else each for each in several]) >= severity(several)


@QUICK
@given(SETS, st.integers(0, 3), STEPS)
def test_a_wider_tolerance(several: list[Check], place: int, step: float) -> None:
    """The demand at the governing corner becomes worse."""
    one = several[place % len(several)]
    if one.demand is None or math.isnan(one.demand):
        return
    before = one.demand if one.corner_demand is None else one.corner_demand
    if math.isnan(before):
        return
    corner = before + towards_failure(one, step)
    wider = replace(one, corner="rate low", corner_demand=corner)
    assert severity([wider if each is one else each for each in several]) >= severity(several)


@QUICK
@given(SETS, st.integers(0, 3), STEPS)
def test_a_waiver_that_accepts_less(several: list[Check], place: int, step: float) -> None:
    one = several[place % len(several)]
    if one.waiver is None:
        return
    up_to = one.waiver.up_to - towards_failure(one, step)
    for less in (None, replace(one.waiver, up_to=up_to)):
        stricter = replace(one, waiver=less)
        after = severity([stricter if each is one else each for each in several])
        assert after >= severity(several)


@QUICK
@given(checks())
def test_missing_data_are_never_a_pass_nor_waived(one: Check) -> None:
    for bare in (replace(one, demand=None), replace(one, limit=None), replace(one, limit=math.nan)):
        assert bare.status == "not_evaluated"


@settings(max_examples=100, deadline=None)
@given(st.lists(checks(), max_size=4))
def test_records_are_judged_as_the_checks(several: list[Check]) -> None:
    """A reader of the file reaches the same verdict, and no status is better than its numbers."""
    records = [one.as_record() for one in several]
    assert verdict(check_records.of_records(records)) == verdict(several)
    for one, record in zip(several, records, strict=True):
        if any(each in (math.inf, -math.inf) for each in (one.demand, one.corner_demand)):
            continue  # a record has no infinity: it counts as missing
        by_numbers = check_records.RecordedCheck(record).status_by_numbers
        assert STATUSES.index(one.status) >= STATUSES.index(by_numbers)
