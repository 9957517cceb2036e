"""JUnit XML of the checks of runs and cases, as Jenkins and GitLab read it.

A suite is a run or the preview of a case, a test case a check. The last test case, `VERDICT`, is
the exit code of `camwright check`: missing data are skipped tests, and an incomplete suite has an
error all the same.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from camwright.pipeline.base.units import used
from camwright.pipeline.base.verdict import failing, in_order
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_records import RecordedCheck, of_records, records_of
from camwright.pipeline.results.check_report import (
    corner,
    not_proven,
    number,
    place,
    reason_without_data,
    status,
    unit_text,
    waiver_words,
    with_error,
)

VERDICT = "verdict"
"""Name of the test case that is the verdict of the suite."""
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TOTALS = ("tests", "failures", "errors")
"""Counts of a root of several suites: Jenkins knows no sum of the skipped tests."""


@dataclass(frozen=True)
class Clock:
    """Start of a run or preview, UTC as ``2026-01-31T12:00:00Z``, and duration, s."""

    started: str | None = None
    seconds: float | None = None

    @classmethod
    def of(cls, summary: Mapping[str, object]) -> Clock:
        """Clock of a run from its ``run.json``."""
        times, started = summary.get("timings_s"), summary.get("started")
        total = times.get("total") if isinstance(times, Mapping) else None
        return cls(
            started if isinstance(started, str) else None,
            total if isinstance(total, (int, float)) else None,
        )

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes ``timestamp``, without a zone as JUnit requires, and ``time`` of a suite."""
        made = {} if self.started is None else {"timestamp": self.started.removesuffix("Z")}
        return made if self.seconds is None else made | {"time": f"{self.seconds:.3f}"}


def junit(suites: Sequence[ET.Element]) -> str:
    """JUnit XML of one suite, or of several in order."""
    if len(suites) == 1:
        root = suites[0]
    else:
        root = ET.Element("testsuites")
        for count in _TOTALS:
            root.set(count, str(sum(int(suite.get(count, "0")) for suite in suites)))
        root.set("time", f"{sum(float(suite.get('time', '0')) for suite in suites):.3f}")
        root.extend(suites)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, "unicode") + "\n"


def unread_suite(name: str, message: str) -> ET.Element:
    """JUnit suite of a run or case that could not be read or solved."""
    suite = ET.Element("testsuite", name=_for_xml(name))
    case = _case(suite, name, "read")
    ET.SubElement(case, "error", type="error", message=_for_xml(message))
    return _counted(suite)


def junit_suite(
    records: Iterable[CheckRecord],
    name: str,
    fail_on: str,
    decided: str,
    properties: Mapping[str, str],
    clock: Clock = Clock(),
) -> ET.Element:
    """JUnit suite of a run: properties, a test case for each check, the verdict last.

    A check without data is skipped, with its reason. One that fails is a failure where it counts at
    the level `fail_on`, else a passed test whose output states its status. The checks share one
    solution: its time is that of the suite, and each test case has a time of zero.

    Parameters
    ----------
    records : iterable     of the checks
    name : str             of the suite
    fail_on : str          level of `camwright check --fail-on`
    decided : str          ``pass``, ``incomplete`` or ``fail``, as the exit code states it
    properties : mapping   such as the verdict in words, the scope, the exit code
    clock : Clock          start and time of the solution
    """
    checks = in_order(of_records(records))
    counting = {each.id for each in failing(checks, fail_on)}
    suite = ET.Element("testsuite", {"name": _for_xml(name), **clock.attributes})
    stated = ET.SubElement(suite, "properties")
    for key, value in properties.items():
        ET.SubElement(stated, "property", name=key, value=_for_xml(value))
    for record in records_of(checks):
        case, kind = _case(suite, name, record["id"]), record["status"]
        if kind == "not_evaluated":
            ET.SubElement(case, "skipped", message=_for_xml(_reason(record)))
        elif kind == "fail" and record["id"] in counting:
            message = _for_xml(_shortfall(record))
            failure = ET.SubElement(case, "failure", type=kind, message=message)
            failure.text = _for_xml("\n".join((_shortfall(record), *_details(record))))
        else:
            said = (_shortfall(record), *_details(record))
            ET.SubElement(case, "system-out").text = _for_xml("\n".join(said))
    _put_verdict(_case(suite, name, VERDICT), decided, properties.get("verdict", ""))
    return _counted(suite)


def _put_verdict(case: ET.Element, decided: str, words: str) -> None:
    """Failure of a failed verdict, error of an incomplete one; nothing of a passed one."""
    kinds = {"fail": "failure", "incomplete": "error"}
    if decided in kinds:
        ET.SubElement(case, kinds[decided], type=decided, message=_for_xml(words or decided))


def _case(suite: ET.Element, name: str, test: str) -> ET.Element:
    classname = f"camwright.{_for_xml(name)}"
    return ET.SubElement(suite, "testcase", classname=classname, name=_for_xml(test), time="0.000")


def _counted(suite: ET.Element) -> ET.Element:
    """The suite, given its numbers of tests, failures, errors and skipped tests as attributes."""
    cases = suite.findall("testcase")
    suite.set("tests", str(len(cases)))
    for count, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(count, str(sum(case.find(tag) is not None for case in cases)))
    return suite


def _reason(record: CheckRecord) -> str:
    """Reason why a check is not evaluated, with its title and the missing keys, in one line."""
    said = [reason_without_data(record)]
    judged_at = record["judged_at"]
    if judged_at and judged_at not in record["note"]:
        said.append(f"judged at the depth {judged_at}")
    keys = record.get("missing")
    if isinstance(keys, list) and not all(str(key) in record["note"] for key in keys):
        said.append(f"missing: {', '.join(map(str, keys))}")
    return f"{record['title']}: {'; '.join(said)}"


def _shortfall(record: CheckRecord) -> str:
    """Demand against limit with unit and status, the reason of a failure, in one line."""
    unit = unit_text(record["unit"])
    worst = RecordedCheck(record).worst
    demand = record["demand"] if worst is None else worst
    sign = "<=" if record["sense"] == "at_most" else ">="
    unbounded = demand is None and record["status"] == "fail"
    words = "unbounded" if unbounded else f"{with_error(demand, record['error'])}{unit}"
    text = f"{record['title']}: {words}, must be {sign} {number(record['limit'])}{unit}"
    reasons = [f"{status(record)}"]
    if record["status"] == "fail" and not record["not_proven"]:
        utilisation = used(record["utilisation"])
        beyond = "beyond its limit" if utilisation == "-" else f"{utilisation} of its limit"
        reasons.append(beyond)
    reasons += [not_proven(record)] if record["not_proven"] else []
    reasons += [record["note"]] if record["note"] else []
    return f"{text}: {'; '.join(reasons)}"


def _details(record: CheckRecord) -> list[str]:
    """Further lines on a check: demand, limit, place, corner, waiver, remedy, method, source."""
    unit = unit_text(record["unit"])
    named = {
        "demand": f"{with_error(record['demand'], record['error'])}{unit}",
        "limit": f"{number(record['limit'])}{unit}",
        "used": used(record["utilisation"]),
        "where": place(record),
        "worst corner": f"{corner(record)}{unit}" if corner(record) else "",
        "waiver": waiver_words(record),
        "remedy": str(record.get("remedy") or ""),
        "method": record["method"],
        "limit by": record["source"],
    }
    return [f"{name}: {words}" for name, words in named.items() if words]


def _for_xml(text: str) -> str:
    """Text with the characters that XML cannot hold replaced."""
    return _NOT_XML.sub("\ufffd", text)
