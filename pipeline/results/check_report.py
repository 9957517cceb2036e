"""Checks of a run for `camwright check`: selection, order, failure, table, JUnit XML."""

from __future__ import annotations

import fnmatch
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from camwright.geometry.errors import InputError
from camwright.pipeline.results.run_reader import CheckRecord, Finding

if TYPE_CHECKING:
    from rich.table import Table

FAIL_ON = ("must", "open", "any", "never")
"""Checks that make `check` exit with 1: must-haves that fail or are not evaluated; also any check
not evaluated; also any optional check that fails; none."""

HEADINGS = (
    *("check", "demand", "limit", "unit", "used", "margin", "where", "worst corner", "status"),
)
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
STYLES = {"pass": "green", "fail": "red", "waived": "yellow", "not_evaluated": "magenta"}


def selected(records: Sequence[CheckRecord], only: Iterable[str]) -> tuple[CheckRecord, ...]:
    """Records whose id fits a pattern such as ``guide_*``; all records without a pattern.

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
    """Whether the id of a record fits one of the patterns; True without patterns."""
    patterns = _patterns(only)
    return not patterns or any(fnmatch.fnmatchcase(record["id"], p) for p in patterns)


def _patterns(only: Iterable[str]) -> list[str]:
    return [word for text in only for word in text.replace(",", " ").split()]


def failing(records: Iterable[CheckRecord], fail_on: str) -> tuple[str, ...]:
    """Ids of the checks that count as failed at a level of `FAIL_ON`.

    Raises
    ------
    InputError
        If the level is unknown.
    """
    if fail_on not in FAIL_ON:
        raise InputError("--fail-on", fail_on, f"one of: {', '.join(FAIL_ON)}")
    return tuple(record["id"] for record in records if _counts(record, fail_on))


def _counts(record: CheckRecord, fail_on: str) -> bool:
    status = record["status"]
    if fail_on == "never" or status in ("pass", "waived"):
        return False
    if record["must_have"] or fail_on == "any":
        return True
    return fail_on == "open" and status == "not_evaluated"


def rank(record: CheckRecord) -> tuple[bool, float, str]:
    """Not evaluated first, then by falling utilisation; an infinite one has no number."""
    used = record["utilisation"]
    return record["status"] != "not_evaluated", -(math.inf if used is None else used), record["id"]


def rows(records: Iterable[CheckRecord]) -> list[tuple[str, ...]]:
    """Text of the table by `HEADINGS`, worst first."""
    return [
        (
            record["title"],
            with_error(record["demand"], record["error"]),
            number(record["limit"]),
            record["unit"],
            share(record["utilisation"]),
            share(None if record["utilisation"] is None else 1.0 - record["utilisation"]),
            place(record),
            corner(record),
            record["status"] + ("" if record["must_have"] else " (optional)"),
        )
        for record in sorted(records, key=rank)
    ]


def table(records: Iterable[CheckRecord]) -> Table:
    """The checks as a table for the terminal."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, header_style="")
    for heading in HEADINGS:
        right = heading in ("demand", "limit", "used", "margin")
        made.add_column(
            heading,
            justify="right" if right else "left",
            no_wrap=heading not in ("check", "where", "worst corner"),
        )
    for row in rows(records):
        style = STYLES.get(row[-1].split()[0], "")
        made.add_row(*(Text(cell) for cell in row[:-1]), Text(row[-1], style=style))
    return made


def remarks(records: Iterable[CheckRecord]) -> list[str]:
    """Lines below the table: checks not evaluated, waivers, limits to be verified."""
    records = sorted(records, key=rank)
    waived = [f"waived: {r['id']}: {r['waiver']}" for r in records if r["waiver"]]
    verify = [r["id"] for r in records if "verify" in r["source"]]
    still_open = [
        f"not evaluated: {r['id']}: {r['note'] or 'a number is missing'}"
        for r in records
        if r["status"] == "not_evaluated"
    ]
    recalled = [f"recalled limits, to be verified: {', '.join(verify)}"] if verify else []
    return [*still_open, *waived, *recalled]


def binding_lines(records: Iterable[CheckRecord], binding: Sequence[str]) -> list[str]:
    """Binding checks: those that fail, and those not evaluated."""
    missing = {r["id"] for r in records if r["status"] == "not_evaluated"}
    known = [name for name in binding if name not in missing]
    unknown = [name for name in binding if name in missing]
    lines = [f"binding: {', '.join(known)}"] if known else []
    return lines + ([f"binding, as a number is missing: {', '.join(unknown)}"] if unknown else [])


def place(record: CheckRecord) -> str:
    """Load case and cam angle of the demand."""
    angle = record["cam_angle_deg"]
    words = [record["load_case"]] if record["load_case"] else []
    words += [] if angle is None else [f"{angle:.1f} deg"]
    return " ".join(words)


def corner(record: CheckRecord) -> str:
    """Governing tolerance corner, and the demand there."""
    if not record["corner"]:
        return ""
    return f"{record['corner']}: {number(record['corner_demand'])}"


def number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def with_error(value: float | None, error: float | None) -> str:
    """A number with its error bar, unless that is below the digits shown."""
    if value is None or error is None or error < 5e-4 * abs(value):
        return number(value)
    return f"{value:.4g} ±{error:.2g}"


def share(value: float | None) -> str:
    return "-" if value is None else f"{value:.0%}"


def junit(records: Iterable[CheckRecord], name: str, fail_on: str) -> str:
    """JUnit XML: one test case a check; an optional one not evaluated is skipped."""
    records = sorted(records, key=rank)
    failed = set(failing(records, fail_on))
    skipped = {r["id"] for r in records if r["status"] == "not_evaluated"} - failed
    suite = ET.Element(
        "testsuite",
        name=name,
        tests=str(len(records)),
        failures=str(len(failed)),
        errors="0",
        skipped=str(len(skipped)),
    )
    for record in records:
        case = ET.SubElement(suite, "testcase", classname=f"camwright.{name}", name=record["id"])
        text = _for_xml(
            f"{record['title']}: {number(record['demand'])} against {number(record['limit'])}"
            f" {record['unit']}, {record['status']}; {record['source']}"
        )
        if record["id"] in failed:
            ET.SubElement(case, "failure", type=record["status"], message=text)
        elif record["id"] in skipped:
            ET.SubElement(case, "skipped", message=text)
        else:
            waiver = record["waiver"]
            words = f"{text}; {_for_xml(str(waiver))}" if waiver else text
            ET.SubElement(case, "system-out").text = words
    ET.indent(suite)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(suite, "unicode") + "\n"


def _for_xml(text: str) -> str:
    """Text with the characters that XML cannot hold replaced."""
    return _NOT_XML.sub("\ufffd", text)


def consistency_line(finding: Finding) -> str:
    """An input beside the value that the other inputs imply, as a line."""
    share = finding["difference_percent"]
    off = "beyond bounds" if share is None else f"{share:+.1f} %"
    words = f"{finding['title']}: given {finding['given']:.4g}, implied {finding['implied']:.4g}"
    unit = "" if finding["unit"] == "-" else f" {finding['unit']}"
    mark = "; MORE THAN 10 % APART" if finding["flagged"] else ""
    return f"consistency, {finding['load_case']}: {words}{unit} ({off}){mark}"
