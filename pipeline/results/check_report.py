"""Text output of `camwright check`: selection, table, failures, remarks."""

from __future__ import annotations

import fnmatch
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import used
from camwright.pipeline.base.verdict import governing, in_order, within_depth
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.run_summary import Finding
from camwright.pipeline.results.check_records import AnyCheck, RecordedCheck, of_records, records_of

if TYPE_CHECKING:
    from rich.table import Table

HEADINGS = ("check", "demand", "limit", "used", "where, worst corner", "status")
OVERVIEW = ("run", "case", "depth", "result", "failed", "missing", "governing")
"""Columns of `overview`."""
STYLES = {"pass": "green", "fail": "red", "waived": "yellow", "not_evaluated": "magenta"}


def selected(records: Sequence[CheckRecord], only: Iterable[str]) -> tuple[CheckRecord, ...]:
    """Check records whose id matches one of some patterns such as ``guide_*``; without patterns
    all.

    Parameters
    ----------
    records : sequence   of the checks
    only : iterable      patterns

    Raises
    ------
    InputError
        If no check fits a pattern.
    """
    patterns = _patterns(only)
    for pattern in patterns:
        if not any(fnmatch.fnmatchcase(record["id"], pattern) for record in records):
            known = ", ".join(sorted(record["id"] for record in records))
            raise InputError("--only", pattern, f"the id of a check: {known}")
    return tuple(record for record in records if fits(record, patterns))


def fits(record: CheckRecord, only: Iterable[str]) -> bool:
    """Whether the id of a record matches one of the patterns; True without patterns."""
    patterns = _patterns(only)
    return not patterns or any(fnmatch.fnmatchcase(record["id"], p) for p in patterns)


def _patterns(only: Iterable[str]) -> list[str]:
    return [word for text in only for word in text.replace(",", " ").split()]


def not_proven(record: AnyCheck) -> str:
    """Text such as ``not proven: 1490 ± 20 against 1500`` of a demand whose error bar includes the
    limit; "" for any other.
    """
    one = RecordedCheck(record)
    if not record["not_proven"] or one.worst is None or one.limit is None:
        return ""
    decimals = 0 if not one.error else max(0, 1 - math.floor(math.log10(one.error)))
    error = f"{one.error:.{decimals}f}"
    return f"not proven: {one.worst:.{decimals}f} ± {error} against {one.limit:.6g}"


def waiver_words(record: CheckRecord) -> str:
    """Demand accepted by a waiver, with name, date and reason, in words; "" without a waiver."""
    if not record["waiver"]:
        return ""
    unit = unit_text(record["unit"])
    return f"up to {number(record['waived_up_to'])}{unit}, {record['waiver']}"


def rows(records: Iterable[CheckRecord]) -> list[tuple[str, ...]]:
    """Cells of the table of checks by `HEADINGS`, worst first."""
    return [
        (
            record["title"],
            f"{with_error(record['demand'], record['error'])}{_unit(record)}",
            number(record["limit"]),
            used(RecordedCheck(record).utilisation),
            "\n".join(filter(None, (place(record), corner(record)))),
            status(record),
        )
        for record in records_of(in_order(of_records(records)))
    ]


def _unit(record: CheckRecord) -> str:
    return "" if record["demand"] is None else unit_text(record["unit"])


def unit_text(unit: str) -> str:
    """Unit after a number with its space; "" for a ratio, whose unit is ``-``."""
    return "" if unit == "-" else f" {unit}"


def reason_without_data(record: AnyCheck) -> str:
    """Reason why a check is not evaluated."""
    return str(record["note"]) or "a number is missing"


def ids_by_reason(records: Iterable[CheckRecord]) -> dict[str, list[str]]:
    """Ids of checks that are not evaluated by their reason, each reason once."""
    ids: dict[str, list[str]] = {}
    for record in records:
        ids.setdefault(reason_without_data(record), []).append(record["id"])
    return ids


def status(record: CheckRecord) -> str:
    """Status of a check in words."""
    words = record["status"] + (", not proven" if record["not_proven"] else "")
    return words + ("" if record["must_have"] else " (optional)")


def table(records: Iterable[CheckRecord]) -> Table:
    """Table of checks for the terminal."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, header_style="")
    for heading in HEADINGS:
        right = heading in ("demand", "limit", "used")
        made.add_column(
            heading,
            justify="right" if right else "left",
            no_wrap=heading in ("limit", "used"),
        )
    for row in rows(records):
        style = STYLES.get(re.split("[ ,]", row[-1])[0], "")
        made.add_row(*(Text(cell) for cell in row[:-1]), Text(row[-1], style=style))
    return made


def overview(rows: Iterable[Sequence[str]]) -> Table:
    """Table of several runs for the terminal, a row each, by `OVERVIEW`."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, header_style="")
    for heading in OVERVIEW:
        right = heading in ("failed", "missing")
        made.add_column(
            heading, justify="right" if right else "left", no_wrap=heading != OVERVIEW[0]
        )
    for row in rows:
        made.add_row(*map(Text, row))
    return made


def overview_row(target: str, document: Mapping[str, Any]) -> tuple[str, ...]:
    """Row of `overview` for a run or case: name, depth, verdict or screen, numbers of failed
    required checks and of those without data, governing check.

    Parameters
    ----------
    target : str         run folder or case file, as typed
    document : mapping   as of `camwright check --json`
    """
    checks = within_depth(of_records(document["checks"]))
    required = [each.status for each in checks if each.must_have]
    first = governing(checks)
    worst = "" if first is None else f"{first.id} {used(first.utilisation)}"
    return (
        *(target, document["case"], document["depth"]),
        str(document["verdict"] or document["screen"]).upper(),
        *(str(required.count("fail")), str(required.count("not_evaluated")), worst),
    )


def remarks(records: Iterable[CheckRecord]) -> list[str]:
    """Lines below the table: missing data, not proven checks, waivers, remedies."""
    records = records_of(in_order(of_records(records)))
    waived = [f"{_waived(r)}: {r['id']}: {waiver_words(r)}" for r in records if r["waiver"]]
    unproven = [f"{r['id']}: {not_proven(r)}" for r in records if r["not_proven"]]
    still_open = [
        f"missing data{'' if must_have else ' (optional)'}: {', '.join(ids)}: {reason}"
        for must_have in (True, False)
        for reason, ids in ids_by_reason(
            r for r in records if r["status"] == "not_evaluated" and r["must_have"] is must_have
        ).items()
    ]
    remedies = [f"remedy: {r['id']}: {r['remedy']}" for r in records if r.get("remedy")]
    return [*still_open, *unproven, *waived, *remedies]


def deeper_lines(records: Iterable[CheckRecord]) -> list[str]:
    """Checks that need a deeper solution, a line for each depth."""
    by_depth: dict[str, list[str]] = {}
    for record in records_of(in_order(of_records(records))):
        if record["judged_at"]:
            by_depth.setdefault(record["judged_at"], []).append(record["id"])
    return [f"judged at the depth {depth}: {', '.join(ids)}" for depth, ids in by_depth.items()]


def _waived(record: CheckRecord) -> str:
    return {"waived": "waived", "pass": "waiver not needed"}.get(
        record["status"], "waiver without effect"
    )


def binding_lines(records: Iterable[CheckRecord], binding: Sequence[str]) -> list[str]:
    """Lines on the binding checks: one on those that failed, one on those without data.

    Parameters
    ----------
    records : iterable   of the checks
    binding : sequence   ids of the binding ones
    """
    missing = {r["id"] for r in records if r["status"] == "not_evaluated"}
    known = [name for name in binding if name not in missing]
    unknown = [name for name in binding if name in missing]
    lines = [f"binding: {', '.join(known)}"] if known else []
    return lines + ([f"binding, as data are missing: {', '.join(unknown)}"] if unknown else [])


def place(record: CheckRecord) -> str:
    """Load case and cam angle of the demand, in words."""
    angle = record["cam_angle_deg"]
    words = [record["load_case"]] if record["load_case"] else []
    words += [] if angle is None else [f"{angle:.1f} deg"]
    return " ".join(words)


def corner(record: CheckRecord) -> str:
    """Governing tolerance corner with its demand."""
    if not record["corner"]:
        return ""
    return f"{record['corner']}: {number(record['corner_demand'])}"


def number(value: float | None) -> str:
    """Number of a record as text."""
    return "-" if value is None else f"{value:.4g}"


def with_error(value: float | None, error: float | None) -> str:
    """Number with its error bar; the bar is omitted below the digits shown."""
    if value is None or error is None or error <= 5e-4 * abs(value):
        return number(value)
    return f"{value:.4g} ±{error:.2g}"


def consistency_line(finding: Finding) -> str:
    """Line on an input of the case that is unusual, or that differs from the value which other
    inputs imply.
    """
    if finding["id"] == "plausibility":
        return f"plausibility: {finding['how']}"
    share = finding["difference_percent"]
    off = "beyond bounds" if share is None else f"{share:+.1f} %"
    words = f"{finding['title']}: given {finding['given']:.4g}, implied {finding['implied']:.4g}"
    unit = unit_text(finding["unit"])
    mark = "; MORE THAN 10 % APART" if finding["flagged"] else ""
    return f"consistency, {finding['load_case']}: {words}{unit} ({off}){mark}"


def sentence(text: str) -> str:
    """Text as a sentence: full stop, capital letter unless it starts with a symbol."""
    is_word = re.match(r"(a|[a-z]{2,})(?=$|[,:;.]|-[a-z]| (?![-=<>/+]))", text) is not None
    start = text[:1].upper() if is_word else text[:1]
    return f"{start}{text[1:].rstrip('.')}."
