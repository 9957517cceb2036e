"""Reasons for a redesign without result: excluding limits, and relaxations."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence

from camwright.pipeline.case.cards.substitution import Choice
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.records.judgement_record import (
    ConflictJudgement,
    DraftJudgement,
    PreviewJudgement,
    RefusedJudgement,
    Shortfall,
    is_refused,
    is_whole,
)
from camwright.pipeline.records.redesign_document import (
    ExcludingLimit,
    ExclusionReasons,
    ExclusionRecord,
    PrunedRecord,
)
from camwright.pipeline.results.check_report import number, unit_text

_SHOWN = 3  # relaxations in a line
_TITLES = {row.id: row.title for row in LIMITS.values()}


def exclusions(
    tried: Sequence[tuple[Choice, DraftJudgement | RefusedJudgement]],
    refused: Sequence[tuple[Choice, PreviewJudgement | RefusedJudgement]],
    pruned: Sequence[PrunedRecord],
    conflict: Callable[[Choice | None], ConflictJudgement | RefusedJudgement],
) -> ExclusionRecord:
    """Reasons why no choice is on the front.

    A choice counts once, for the limit that it exceeds most: of its preview if it was judged in
    full, else of its synthesis, else of the bounds.

    Parameters
    ----------
    tried : sequence      choices with their judgements by the synthesis alone
    refused : sequence    choices with their judgements in full; none is on the front
    pruned : sequence     parts excluded without solution
    conflict : callable   choice, None of the unchanged case -> record of its infeasibility
    """
    whole: dict[Choice, DraftJudgement | PreviewJudgement | RefusedJudgement] = dict(refused)
    reasons = [_reason(whole.get(choice, record)) for choice, record in tried]
    reasons += [each["limit"] for each in pruned if each["limit"]]
    counts = Counter(reason for reason in reasons if reason)
    first = sorted(counts, key=lambda name: (-counts[name], name))
    excluded: list[ExcludingLimit] = [
        {"limit": name, "title": _TITLES.get(name, ""), "count": counts[name]} for name in first
    ]
    failing = [(each, record) for each, record in refused if is_whole(record)]
    short = [pair for pair in failing if pair[1]["shortfalls"] and _reason(pair[1]) == first[0]]
    if short:
        nearest = min(short, key=lambda pair: _excess(pair[1]))
        ways, conflicting = [_way(nearest[1]["shortfalls"][0])], list[str]()
        choice: Choice | None = nearest[0]
    else:
        rough = [(each, record) for each, record in tried if not is_refused(record)]
        solved = [(each, record["utilisation"]) for each, record in rough if record["limit"]]
        choice = min(solved, key=lambda pair: pair[1])[0] if solved else None
        found = conflict(choice)
        conflicting = [] if is_refused(found) else found["conflict"]
        ways = [] if is_refused(found) else [str(each["sentence"]) for each in found["relaxations"]]
    made: ExclusionReasons = {
        "excluded": excluded,
        "nearest": None if choice is None else choice.words,
        "conflict": conflicting,
        "ways": ways,
    }
    return {**made, "lines": _lines(made)}


def _lines(record: ExclusionReasons) -> list[str]:
    """Lines of text on a redesign without result: limits by the number of choices that they
    exclude, the nearest choice, its limits in conflict, and the smallest changes that make it
    feasible.
    """
    counts = [
        f"{each['limit']}{' (' + each['title'] + ')' if each['title'] else ''}: {each['count']}"
        for each in record["excluded"]
    ]
    said = ["no choice of the catalogues keeps all limits"]
    if counts:
        total = sum(each["count"] for each in record["excluded"])
        said.append(f"excluded most by {counts[0]} of {total} choices and parts")
    if counts[1:]:
        said.append(f"excluded further by {'; '.join(counts[1:])}")
    which = record["nearest"] or "the parts of the case"
    said.append(f"nearest: {which}")
    if record["conflict"]:
        said.append(f"its limits in conflict: {', '.join(record['conflict'])}")
    ways = "; or ".join(record["ways"][:_SHOWN])
    said.append(
        f"changes that make it feasible: {ways}"
        if ways
        else "no single change of a limit, the spring or the prime radius makes it feasible"
    )
    return said


def _reason(record: DraftJudgement | PreviewJudgement | RefusedJudgement) -> str:
    """Name of the limit that a judged case exceeds most, or of the key that refuses it; "" where it
    exceeds none.
    """
    if is_refused(record):
        return record["why"].partition(" = ")[0][:60]
    if is_whole(record):
        return record["shortfalls"][0]["check"] if record["shortfalls"] else ""
    return record["limit"]


def _excess(record: PreviewJudgement) -> tuple[int, float]:
    """Number of failing checks, and the utilisation of the worst."""
    used = record["shortfalls"][0]["utilisation"]
    return len(record["shortfalls"]), math.inf if used is None else used


def _way(shortfall: Shortfall) -> str:
    """Words on what would let a failing check pass: its demand in place of its limit, with unit."""
    unit = unit_text(shortfall["unit"])
    demand, limit = shortfall["demand"], shortfall["limit"]
    if demand is None or limit is None:
        return f"{shortfall['title']}: unbounded against {number(limit)}{unit}"
    return f"{shortfall['title']}: {demand:.4g}{unit} instead of {limit:.4g}{unit}"
