"""Bar chart of the greatest utilisations, grouped by part of the mechanism."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from camwright.pipeline.base.verdict import in_order, within_depth
from camwright.pipeline.results.check_records import of_records, records_of
from camwright.reports.check_parts import part_of
from camwright.reports.report_tables import (
    BAR_TOP,
    CheckRow,
    Record,
    check_rows,
    isolated,
)

_BARS = 12
LIMIT_SHARE = 1.0 / BAR_TOP
"""Place of the limit on the axis, as a share."""


@dataclass(frozen=True)
class Bar:
    """Bar of a check: title, status, utilisation in words, length; whether it is cut off."""

    title: str
    status: str
    utilisation: str
    share: float
    beyond: bool


@dataclass(frozen=True)
class BarGroup:
    """Bars of a part, the greatest first, and its number of required checks without data."""

    part: str
    bars: tuple[Bar, ...]
    missing: int


def utilisation_chart(checks: Sequence[Record]) -> tuple[BarGroup, ...]:
    """Bars of the twelve greatest utilisations of required design checks, grouped by part.

    Parts follow by their greatest utilisation; the others with missing data are one last group.
    """
    ordered = in_order(of_records(checks))
    required = [each for each in ordered if each.must_have and not each.evidence]
    known = records_of(each for each in required if each.utilisation is not None)
    missing = records_of(each for each in within_depth(required) if each.status == "not_evaluated")
    shown = known[:_BARS]
    parts = list(dict.fromkeys(map(part_of, shown)))
    groups = [
        BarGroup(
            part,
            tuple(_bar(row) for row in check_rows([c for c in shown if part_of(c) == part])),
            sum(part_of(c) == part for c in missing),
        )
        for part in parts
    ]
    others = [part_of(c) for c in missing if part_of(c) not in parts]
    if others:
        groups.append(BarGroup(", ".join(dict.fromkeys(others)), (), len(others)))
    return tuple(groups)


def _bar(row: CheckRow) -> Bar:
    share = (row.bar or 0.0) / BAR_TOP
    return Bar(isolated(row.title), row.status.id, row.utilisation, share, share >= 1.0)
