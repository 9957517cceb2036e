"""Status, utilisation, verdict and order against a second formulation: signed, over all at once."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np
import pytest
from made_check import made_check
from numpy.typing import NDArray

from camwright.geometry.errors import InputError
from camwright.pipeline.base import verdict as meaning
from camwright.pipeline.checks.check import Check, Waived, check, made_from_others
from camwright.pipeline.results.check_records import RecordedCheck, of_records

COUNT, TOGETHER = 10_000, 10
NUMBERS = (np.nan, np.inf, -np.inf, 0.0, -1.0, 0.5, 0.999, 1.0, 1.0 + 5e-10, 1.001, 2.0, 1e12)
"""Demands at the edges of a limit of 1."""
LIMITS = (np.nan, np.inf, 0.0, -1.0, 0.5, 1.0, 1.0, 1.0, 2.0)
SHARES = (np.nan, 0.0, 1e-9, 2e-9, 1e-3, 0.5)
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


class Drawn(NamedTuple):
    """Numbers of `COUNT` checks; NaN: missing."""

    demand: Floats
    corner: Floats
    limit: Floats
    share: Floats
    up_to: Floats
    at_least: Flags
    without: Flags
    must_have: Flags
    evidence: Flags
    deeper: Flags


def drawn(seed: int) -> Drawn:
    """Edges and numbers between them, with corners, error bars and waivers of a part of them."""
    rng = np.random.default_rng(seed)

    def mixed(edges: tuple[float, ...], low: float, high: float) -> Floats:
        between = rng.uniform(low, high, COUNT)
        return np.where(rng.random(COUNT) < 0.5, rng.choice(edges, COUNT), between)

    def some(values: Floats, share: float) -> Floats:
        return np.where(rng.random(COUNT) < share, values, np.nan)

    demand = mixed(NUMBERS, -2.0, 3.0)
    return Drawn(
        demand=demand,
        corner=some(mixed(NUMBERS[1:], -2.0, 3.0), 0.4),
        limit=np.where(rng.random(COUNT) < 0.05, demand, mixed(LIMITS, -1.0, 2.0)),
        share=mixed(SHARES, 0.0, 0.6),
        up_to=some(np.where(rng.random(COUNT) < 0.2, demand, rng.uniform(-2.0, 4.0, COUNT)), 0.5),
        at_least=rng.random(COUNT) < 0.5,
        without=rng.random(COUNT) < 0.1,
        must_have=(rng.random(COUNT) < 0.7) & (np.arange(COUNT) >= TOGETHER),
        evidence=rng.random(COUNT) < 0.2,
        deeper=rng.random(COUNT) < 0.1,
    )


def checks_of(many: Drawn) -> list[Check]:
    """The checks of the drawn numbers."""

    def known(value: float) -> float | None:
        return None if np.isnan(value) else float(value)

    made = []
    for k in range(COUNT):
        declared = check(
            id=f"c{k:05d}",
            title="made up",
            unit="-",
            sense="at_least" if many.at_least[k] else "at_most",
            method="none: made up",
            evidence=bool(many.evidence[k]),
        )(made_from_others)
        corner, up_to = known(many.corner[k]), known(many.up_to[k])
        made.append(Check(
            declared, known(many.demand[k]), known(many.limit[k]), "made up", "", "",
            must_have=bool(many.must_have[k]), corner="" if corner is None else "mass high",
            corner_demand=corner, error_share=known(many.share[k]),
            waiver=None if up_to is None else Waived("A", up_to),
            without="over-speed" if many.without[k] else "",
            judged_at="cycle" if many.deeper[k] else "",
        ))  # fmt: skip
    return made


class Expected(NamedTuple):
    """Status, utilisation, that at the end of the error bar and whether it is not proven."""

    status: NDArray[np.str_]
    use: Floats
    upper: Floats
    not_proven: Flags
    worst: Floats


def expected(many: Drawn) -> Expected:
    """All demands as greatest ones: of a least value, demand and limit change their sign."""
    sign = np.where(many.at_least, -1.0, 1.0)
    demand, corner, limit = (sign * each for each in (many.demand, many.corner, many.limit))
    worst = np.where(np.isnan(demand), np.nan, np.fmax(demand, corner))
    share = np.nan_to_num(many.share, nan=0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        reach = worst + np.abs(worst) * share
        excess = worst > limit
        known = ~np.isnan(worst) & np.isfinite(limit) & ~(many.without & ~excess)
        open_ = ~excess & (share > 1e-9) & ~(reach <= limit)
        covered = reach <= sign * many.up_to
        status = np.select(
            [~known, ~excess & ~open_, covered], ["not_evaluated", "pass", "waived"], "fail"
        )
        uses = []
        for value in (worst, reach):
            part, whole = (
                np.where(many.at_least, -limit, value),
                np.where(many.at_least, -value, limit),
            )
            use = np.where(whole > 0.0, part / whole, np.where(part <= whole, 0.0, np.inf))
            uses.append(np.where(known, use, np.nan))
    return Expected(status, uses[0], uses[1], known & open_, sign * worst)


def same(value: float | None, wanted: float) -> bool:
    return np.isnan(wanted) if value is None or np.isnan(value) else value == wanted


@pytest.fixture(scope="module")
def many() -> tuple[Drawn, list[Check], Expected]:
    numbers = drawn(20261129)
    return numbers, checks_of(numbers), expected(numbers)


def test_checks_are_judged_exactly(many: tuple[Drawn, list[Check], Expected]) -> None:
    _, checks, wanted = many
    assert {*wanted.status} == {*meaning.STATUSES}
    for k, one in enumerate(checks):
        assert one.status == wanted.status[k], one
        assert same(one.worst, wanted.worst[k]), one
        assert same(one.utilisation, wanted.use[k]), one
        assert same(one.upper_utilisation, wanted.upper[k]), one
        assert one.not_proven == wanted.not_proven[k], one


def read(checks: list[Check]) -> list[RecordedCheck[dict[str, Any]]]:
    """The checks as their records are read from a file."""
    records: list[dict[str, Any]] = json.loads(json.dumps([one.as_record() for one in checks]))
    return list(of_records(records))


def test_records_are_judged_as_their_checks(many: tuple[Drawn, list[Check], Expected]) -> None:
    """To their digits; an infinite number is recorded as missing."""
    numbers, checks, wanted = many
    infinite = np.isinf(numbers.demand) | np.isinf(numbers.corner)
    compared = 0
    for k, one in enumerate(read(checks)):
        assert one.status == wanted.status[k]
        if infinite[k]:
            continue
        place, stated = map(meaning.STATUSES.index, (one.status_by_numbers, one.status))
        assert place <= stated, one.record
        if numbers.demand[k] != 0.0:  # else its error bar is a share of nothing
            assert one.status_by_numbers == one.status, one.record
            worst = np.nan if checks[k].is_bound else wanted.worst[k]
            assert same(one.worst, float(f"{worst:.15g}")), one.record
            compared += 1
    assert compared > COUNT / 2


SEVERITY = {"pass": 0, "waived": 0, "not_evaluated": 1, "fail": 2}


def test_groups_of_checks_and_of_records(many: tuple[Drawn, list[Check], Expected]) -> None:
    numbers, checks, wanted = many
    recorded = read(checks)
    ids = np.array([one.id for one in checks])
    rank = np.array([round(float(f"{use:.9g}"), 9) for use in wanted.use])
    for first in range(0, COUNT, TOGETHER):
        span = np.arange(first, first + TOGETHER)
        must = span[numbers.must_have[span]]
        severity = max((SEVERITY[wanted.status[k]] for k in must), default=2)
        design = [k for k in must if not numbers.evidence[k]
                  and wanted.status[k] in ("pass", "fail")]  # fmt: skip
        greatest = max((rank[k] for k in design), default=np.nan)
        governing = next((ids[k] for k in design if rank[k] == greatest), None)
        unknown = np.isnan(rank[span])
        required = numbers.must_have[span]
        order = [*span[unknown & required], *span[unknown & ~required],
                 *span[~unknown][np.argsort(-rank[span][~unknown], kind="stable")]]  # fmt: skip
        blocking = [k for k in order if k in must and SEVERITY[wanted.status[k]]
                    and not numbers.deeper[k]]  # fmt: skip
        groups: list[list[Any]] = [checks[first : first + TOGETHER]]
        if not np.isneginf(rank[span]).any():  # a record has no demand infinitely within its limit
            groups.append(recorded[first : first + TOGETHER])
        for group in groups:
            ordered = meaning.in_order(reversed(group))
            assert meaning.verdict(group) == meaning.VERDICTS[severity]
            assert meaning.screen(group) == ("fail" if severity == 2 and must.size else "open")
            assert meaning.governing_id(group) == governing
            assert [one.id for one in ordered] == list(ids[order])
            assert meaning.binding(ordered) == tuple(ids[blocking])
            kept = [one.id for one in meaning.within_depth(group)]
            assert kept == list(ids[span[~numbers.deeper[span]]])


@pytest.mark.parametrize("sense", ["at_most", "at_least"])
def test_the_digits_of_a_record_turn_no_solved_check_to_pass(sense: Any) -> None:
    beyond = 1.0 + 5e-13 if sense == "at_most" else 1.0 - 5e-13
    one = made_check("x", beyond, 1.0, sense=sense)
    assert one.status == "fail"
    assert RecordedCheck(one.as_record()).status_by_numbers == "pass"
    assert meaning.status(one, digits=1e-12) == "pass"


def test_a_record_that_states_no_proof_does_not_pass() -> None:
    record = made_check("x", 0.9, 1.0).as_record() | {"not_proven": True}
    assert RecordedCheck(record).status_by_numbers == "fail"
    accepted = record | {"waiver": "A", "waived_up_to": 1.0}
    assert RecordedCheck(accepted).status_by_numbers == "waived"


@pytest.mark.parametrize(
    ("judged", "word"),
    [
        (("pass", None), "pass"),
        (("incomplete", None), "incomplete"),
        (("fail", None), "fail"),
        ((None, "open"), "incomplete"),
        ((None, "fail"), "fail"),
    ],
)
def test_the_word_of_the_exit_code(judged: tuple[Any, Any], word: str) -> None:
    assert meaning.exit_word(*judged) == word
    assert [*meaning.OUTCOMES] == ["pass", "incomplete", "open", "fail"]


def test_an_unknown_level_is_refused() -> None:
    with pytest.raises(InputError, match="--fail-on = some, must be one of: must"):
        meaning.failing((), "some")
