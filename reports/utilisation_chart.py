"""Chart of the greatest utilisations, grouped by the part of the mechanism."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from camwright.pipeline.results.check_records import utilisation_of
from camwright.reports.check_parts import part_of
from camwright.reports.report_tables import (
    BAR_TOP,
    CheckRow,
    Record,
    check_rows,
    isolated,
    sorted_checks,
)

_BARS = 12
LIMIT_SHARE = 1.0 / BAR_TOP
"""Place of the limit on the axis, as a share."""


@dataclass(frozen=True)
class Bar:
    """A check: title, status, utilisation in words, share of the axis; whether beyond it."""

    title: str
    status: str
    utilisation: str
    share: float
    beyond: bool


@dataclass(frozen=True)
class BarGroup:
    """Bars of a part, the greatest first, and the number of its required checks without data."""

    part: str
    bars: tuple[Bar, ...]
    missing: int


def utilisation_chart(checks: Sequence[Record]) -> tuple[BarGroup, ...]:
    """The twelve greatest utilisations of required checks of the design, by part.

    Parts follow by their greatest utilisation; the others with missing data are one last group.
    """
    required = [c for c in sorted_checks(checks) if c["must_have"] and not c["evidence"]]
    known = [
        c for c in required if c["status"] != "not_evaluated" and utilisation_of(c) is not None
    ]
    missing = [c for c in required if c["status"] == "not_evaluated" and not c["judged_at"]]
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
