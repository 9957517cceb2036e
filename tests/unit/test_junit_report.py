"""JUnit XML of `camwright check`: statuses, reasons, counts, clock, the rules of its readers."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from typing import Any

import pytest
from small_run import check

from camwright.pipeline.results.junit_report import (
    VERDICT,
    Clock,
    junit,
    junit_suite,
    unread_suite,
)

RECORDS: tuple[Any, ...] = (
    check("pass", id="a_one"),
    check("fail", id="a_two", note="surges <twice> & again", remedy="base radius 30 mm"),
    check("not_evaluated", id="b_open", must_have=False, note="no spring"),
    check("fail", id="b_optional", must_have=False, source="recalled: verify"),
    check("waived", id="c_waived", waiver="A. Engineer, 2025-01-02: proven"),
    check("not_evaluated", id="c_must", missing=["guides.a.wall", "limits.target_life"]),
    check(
        "not_evaluated", id="d_deep", judged_at="certified", note="judged at the depth certified"
    ),
)
CLOCK = Clock("2026-01-31T12:00:00Z", 12.3456)

# The elements, their attributes and their parts that the plugins of Jenkins read (JUnit and xUnit,
# form 10); GitLab reads a part of them. "!": the attribute must be there.
RULES: dict[str, tuple[set[str], set[str]]] = {
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, {"testsuite"}),
    "testsuite": (
        {"name!", "tests!", "failures!", "errors!", "group", "time", "skipped", "timestamp",
         "hostname", "id", "package", "file", "log", "url"},
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "properties": (set(), {"property"}),
    "property": ({"name!", "value!"}, set()),
    "testcase": (
        {"name!", "time", "classname", "group"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "skipped": ({"type", "message"}, set()),
    "error": ({"type", "message"}, set()),
    "failure": ({"type", "message"}, set()),
    "system-out": (set(), set()),
    "system-err": (set(), set()),
}  # fmt: skip
TEXT = {"skipped", "error", "failure", "system-out", "system-err"}


def broken_rules(root: ET.Element) -> list[str]:
    """Rules of `RULES` that a document breaks."""
    broken = [] if root.tag in ("testsuite", "testsuites") else [f"root {root.tag}"]
    for node in root.iter():
        known, parts = RULES.get(node.tag, (None, set()))
        if known is None:
            broken.append(f"element {node.tag}")
            continue
        names = {name.rstrip("!") for name in known}
        broken += [f"{node.tag}: attribute {name}" for name in set(node.attrib) - names]
        required = {name.rstrip("!") for name in known if name.endswith("!")}
        broken += [f"{node.tag} lacks {name}" for name in required - set(node.attrib)]
        broken += [f"{child.tag} in {node.tag}" for child in node if child.tag not in parts]
        if node.tag not in TEXT and (node.text or "").strip():
            broken.append(f"text in {node.tag}")
        if node.tag in ("testsuite", "testsuites") and "time" in node.attrib:
            seconds = re.fullmatch(r"\d+\.\d{3}", node.attrib["time"])
            broken += [] if seconds else [f"time = {node.attrib['time']}"]
        stamp = node.get("timestamp")
        if stamp is not None and not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", stamp):
            broken.append(f"timestamp = {stamp}")
        if node.tag == "testsuite":
            cases = node.findall("testcase")
            tags = {"failures": "failure", "errors": "error", "skipped": "skipped"}
            counts = {key: sum(c.find(tag) is not None for c in cases) for key, tag in tags.items()}
            counts["tests"] = len(cases)
            broken += [k for k, n in counts.items() if node.get(k) != str(n)]
    return broken


def suite_of(
    records: Any = RECORDS, fail_on: str = "must", decided: str = "fail", **more: str
) -> ET.Element:
    text = junit([junit_suite(records, "small", fail_on, decided, more, CLOCK)])
    root = ET.fromstring(text)
    assert broken_rules(root) == []
    return root


def tags(suite: ET.Element) -> dict[str, list[str]]:
    """Names of the test cases by the element that states their result."""
    kinds = ("failure", "error", "skipped", "system-out")
    return {
        kind: [str(c.get("name")) for c in suite.iter("testcase") if c.find(kind) is not None]
        for kind in kinds
    }


def test_missing_data_are_skipped_and_failures_are_failures() -> None:
    made = tags(suite_of())
    assert made["failure"] == ["a_two", VERDICT]
    assert made["error"] == []
    assert made["skipped"] == ["c_must", "d_deep", "b_open"]
    assert sorted(made["system-out"]) == ["a_one", "b_optional", "c_waived"]


def test_counts_time_and_timestamp() -> None:
    suite = suite_of()
    named = {key: suite.get(key) for key in ("tests", "failures", "errors", "skipped")}
    assert named == {"tests": "8", "failures": "2", "errors": "0", "skipped": "3"}
    assert (suite.get("timestamp"), suite.get("time")) == ("2026-01-31T12:00:00", "12.346")
    bare = junit_suite(RECORDS, "small", "must", "fail", {})
    assert bare.get("timestamp") is None and bare.get("time") is None


@pytest.mark.parametrize(
    ("decided", "tag"), [("pass", None), ("incomplete", "error"), ("fail", "failure")]
)
def test_the_verdict_is_a_test_of_its_own(decided: str, tag: str | None) -> None:
    """An incomplete suite has skipped tests alone; without this one it would look like a pass."""
    open_ = [check("not_evaluated", id="c_must")]
    suite = suite_of(open_, decided=decided, verdict="INCOMPLETE: 1 check without data")
    last = suite.findall("testcase")[-1]
    assert last.get("name") == VERDICT
    assert [child.tag for child in last] == ([] if tag is None else [tag])
    if tag is not None:
        assert last[0].attrib == {"type": decided, "message": "INCOMPLETE: 1 check without data"}


@pytest.mark.parametrize(
    ("fail_on", "failures"),
    [("must", ["a_two"]), ("open", ["a_two"]), ("any", ["a_two", "b_optional"]), ("never", [])],
)
def test_failures_are_those_that_count_at_the_level(fail_on: str, failures: list[str]) -> None:
    suite = suite_of(fail_on=fail_on, decided="pass")
    assert sorted(tags(suite)["failure"]) == failures
    assert tags(suite)["skipped"] == ["c_must", "d_deep", "b_open"]


def test_a_failure_states_demand_limit_unit_and_reason() -> None:
    (failure,) = (
        c.find("failure") for c in suite_of().iter("testcase") if c.get("name") == "a_two"
    )
    assert failure is not None
    message = failure.get("message", "")
    assert message == (
        "Pressure angle: 3 deg, must be <= 2 deg: fail; 150 % of its limit; surges <twice> & again"
    )
    text = (failure.text or "").splitlines()
    assert text[0] == message
    assert {"demand: 3 deg", "limit: 2 deg", "used: 150 %", "where: idle 12.5 deg",
            "remedy: base radius 30 mm", "limit by: Rothbart"} <= set(text)  # fmt: skip


def test_a_demand_without_bound_fails_in_words() -> None:
    one = check("fail", id="x", demand=None, utilisation=None)
    (failure,) = suite_of([one]).findall("testcase/failure[@type='fail']")[:1]
    said = "Pressure angle: unbounded, must be <= 2 deg: fail; beyond its limit"
    assert failure.get("message") == said


def test_a_failure_at_a_corner_states_the_demand_there() -> None:
    one = check("fail", id="x", demand=1.0, corner="friction high", corner_demand=3.0)
    (failure,) = suite_of([one]).findall("testcase/failure[@type='fail']")[:1]
    assert "Pressure angle: 3 deg, must be <= 2 deg" in failure.get("message", "")
    assert "worst corner: friction high: 3 deg" in (failure.text or "")


def test_a_skipped_check_states_its_reason_and_the_missing_keys() -> None:
    said = {
        str(case.get("name")): skipped.get("message")
        for case in suite_of().iter("testcase")
        if (skipped := case.find("skipped")) is not None
    }
    assert said == {
        "b_open": "Pressure angle: no spring",
        "c_must": "Pressure angle: a number is missing; missing: guides.a.wall, limits.target_life",
        "d_deep": "Pressure angle: judged at the depth certified",
    }


def test_a_waived_check_states_its_waiver() -> None:
    (said,) = (
        case.findtext("system-out")
        for case in suite_of().iter("testcase")
        if case.get("name") == "c_waived"
    )
    assert said is not None and "Pressure angle: 3 deg, must be <= 2 deg: waived" in said
    assert "waiver: up to 3.5 deg, A. Engineer, 2025-01-02: proven" in said


def test_several_suites_and_an_unread_one_keep_the_rules() -> None:
    suites = [
        junit_suite(RECORDS, "small", "must", "fail", {"verdict": "FAIL \x1b"}, CLOCK),
        junit_suite(RECORDS, "other", "never", "pass", {}, CLOCK),
        unread_suite("gone", "gone: no such folder"),
    ]
    root = ET.fromstring(junit(suites))
    assert broken_rules(root) == []
    assert root.attrib == {"tests": "17", "failures": "2", "errors": "1", "time": "24.692"}
    stated = [one.get("value") for one in root.iter("property")]
    assert stated == ["FAIL \ufffd"]


def test_the_rules_refuse_a_document_that_breaks_them() -> None:
    root = ET.fromstring(junit([junit_suite(RECORDS, "small", "must", "fail", {}, CLOCK)]))
    root.set("skipped", "9")
    root.set("timestamp", "2026-01-31T12:00:00Z")
    ET.SubElement(root[1], "note")
    del root[1].attrib["name"]
    assert sorted(broken_rules(root)) == [
        "element note", "note in testcase", "skipped", "testcase lacks name",
        "timestamp = 2026-01-31T12:00:00Z",
    ]  # fmt: skip


def test_the_clock_is_that_of_the_record() -> None:
    summary = {"started": "2026-01-31T12:00:00Z", "timings_s": {"total": 7.5}}
    assert Clock.of(summary).attributes == {"timestamp": "2026-01-31T12:00:00", "time": "7.500"}
    assert Clock.of({"started": None, "timings_s": {}}).attributes == {}
