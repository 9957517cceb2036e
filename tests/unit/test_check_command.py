"""`camwright check`: choice, failure, JUnit, baseline, record, preview."""

from __future__ import annotations

import json
import re
import tomllib
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from small_machine import small_machine
from small_run import TORQUE, check, small_case, summary, values, write_run, write_trial

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import failing, outcome
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.results.baseline_comparison import changes, lines
from camwright.pipeline.results.check_records import of_records
from camwright.pipeline.results.check_report import (
    binding_lines,
    not_proven,
    remarks,
    rows,
    selected,
)
from camwright.pipeline.results.junit_report import junit, junit_suite
from camwright.pipeline.results.run_folder import RunFolder

RECORDS = (
    check("pass", id="a_one"),
    check("fail", id="a_two"),
    check("not_evaluated", id="b_open", must_have=False, note="no spring"),
    check("fail", id="b_optional", must_have=False, source="recalled: verify"),
    check("waived", id="c_waived", waiver="A. Engineer, 2025-01-02: proven"),
    check("not_evaluated", id="c_must"),
)

Command = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(tmp_path: Path) -> Path:
    with RunFolder(tmp_path / "run", small_case()) as folder:
        write_trial(folder, list(RECORDS))
        folder.finish(summary("fail") | {"binding": ["a_two", "c_must"]})
    return tmp_path / "run"


@pytest.mark.parametrize(
    ("level", "failed"),
    [
        ("must", ["a_two", "c_must"]),
        ("open", ["a_two", "b_open", "c_must"]),
        ("any", ["a_two", "b_open", "b_optional", "c_must"]),
        ("never", []),
    ],
)
def test_levels_of_failure(level: str, failed: list[str]) -> None:
    assert [each.id for each in failing(of_records(RECORDS), level)] == failed


@pytest.mark.parametrize(
    ("level", "statuses"),
    [
        # of: all pass, optional without data, optional fails, required without data, required fails
        ("must", ("pass", "pass", "pass", "incomplete", "fail")),
        ("open", ("pass", "incomplete", "pass", "incomplete", "fail")),
        ("any", ("pass", "incomplete", "fail", "incomplete", "fail")),
        ("never", ("pass",) * 5),
    ],
)
def test_outcome_of_a_level(level: str, statuses: tuple[str, ...]) -> None:
    good = [check("pass"), check("waived", id="w")]
    added = (
        check("pass", id="x"),
        check("not_evaluated", id="x", must_have=False),
        check("fail", id="x", must_have=False),
        check("not_evaluated", id="x"),
        check("fail", id="x"),
    )
    assert tuple(outcome(of_records([*good, one]), level) for one in added) == statuses
    worst = outcome(of_records([*good, *added]), level)
    assert worst == ("pass" if level == "never" else "fail")


def test_patterns_choose() -> None:
    assert [r["id"] for r in selected(RECORDS, ["a_*", "c_must"])] == ["a_one", "a_two", "c_must"]
    assert selected(RECORDS, ()) == RECORDS
    with pytest.raises(InputError, match="--only = x"):
        selected(RECORDS, ["x*"])


def test_table_worst_first_with_error_and_corner() -> None:
    one = check("pass", error=0.1, corner="friction high", corner_demand=1.5)
    (row,) = rows([one])
    assert row[1:4] == ("1 ±0.1 deg", "2", "50 %")
    assert row[4] == "idle 12.5 deg\nfriction high: 1.5"
    assert [row[-1].split()[0] for row in rows(RECORDS)][:2] == ["not_evaluated"] * 2


def test_waivers_and_missing_data_are_told() -> None:
    told = "\n".join(remarks(RECORDS))
    assert "waived: c_waived: up to 3.5 deg, A. Engineer, 2025-01-02: proven" in told
    assert "missing data: c_must: a number is missing" in told
    assert "missing data (optional): b_open: no spring" in told


def test_a_waiver_that_does_not_act_says_so() -> None:
    more = {"waiver": "A. Engineer", "waived_up_to": 2.5}
    told = remarks([check("fail", id="beyond", **more), check("pass", id="spare", **more)])
    assert told == [
        "waiver without effect: beyond: up to 2.5 deg, A. Engineer",
        "waiver not needed: spare: up to 2.5 deg, A. Engineer",
    ]


@pytest.mark.parametrize(
    ("demand", "error", "more", "words"),
    [
        (1.02, 0.03, {}, "not proven: 1.020 ± 0.030 against 1.04"),
        (1.0399, 0.00021, {}, "not proven: 1.03990 ± 0.00021 against 1.04"),
        (1000.0, 60.0, {"limit": 1040.0}, "not proven: 1000 ± 60 against 1040"),
        (0.51, 0.015, {"corner": "mass low", "corner_demand": 1.02},
         "not proven: 1.020 ± 0.030 against 1.04"),
        (1.06, 0.03, {"sense": "at_least"}, "not proven: 1.060 ± 0.030 against 1.04"),
    ],
)  # fmt: skip
def test_a_demand_that_is_not_proven_is_shown_with_its_error_bar(
    demand: float, error: float, more: dict[str, Any], words: str
) -> None:
    known = {"demand": demand, "error": error, "limit": 1.04, "not_proven": True}
    record = check("fail", id="grip", **(known | more))
    assert not_proven(record) == words
    assert f"grip: {words}" in remarks([record])
    assert rows([record])[0][-1] == "fail, not proven"
    assert words in junit([junit_suite([record], "small", "must", "fail", {})])
    assert not_proven(check("fail")) == ""


def test_baseline_tells_changes_beyond_the_error_bars_only() -> None:
    old = [check(id="p", demand=1.0, error=0.05), check(id="q"), check(id="r"), check(id="s")]
    new = [
        check(id="p", demand=1.09, error=0.05),
        check(id="q", demand=1.01, error=0.001),
        check("fail", id="r"),
        check(id="t"),
    ]
    found = {entry["id"]: entry["kinds"] for entry in changes(old, new)}
    assert found == {"q": ["demand"], "r": ["status", "demand"], "t": ["new"], "s": ["gone"]}
    assert lines([]) == ["nothing changed beyond the error bars"]
    assert changes(old, old) == []


def test_residuals_differ_where_their_status_does() -> None:
    """5e-15 instead of 4e-15 is no news; a residual that fails is."""
    old = [check(id="r", demand=4e-15, unit="-", evidence=True), check(id="m", unit="deg")]
    same = [check(id="r", demand=5e-15, unit="-", evidence=True), check(id="m", unit="deg")]
    worse = [check("fail", id="r", demand=1.0, unit="-", evidence=True), check(id="m", unit="deg")]
    assert changes(old, same) == []
    assert [entry["kinds"] for entry in changes(old, worse)] == [["status"]]


def test_exit_codes_and_files(run: Path, command: Command, tmp_path: Path) -> None:
    assert command("check", run)[0] == 1
    assert command("check", run, "--fail-on", "never")[0] == 0
    assert command("check", run, "--only", "a_one")[0] == 0
    assert command("check", run, "--only", "nothing")[0] == 2
    file = tmp_path / "junit.xml"
    assert command("check", run, "--only", "a_*", "--junit", file)[0] == 1
    assert file.read_text().startswith("<?xml")
    code, out, _ = command("check", run, "--json", "--baseline", run, "--only", "a_*,b_*")
    document = json.loads(out)
    assert (code, document["changes"], len(document["checks"])) == (1, [], 4)


def test_several_runs_give_one_table_one_file_and_the_worst_code(
    run: Path, tmp_path: Path, command: Command
) -> None:
    good, open_ = write_run(tmp_path / "good"), tmp_path / "open"
    write_run(open_, status="not_evaluated")
    gone, file = tmp_path / "gone", tmp_path / "junit.xml"
    assert command("check", good, good)[0] == 0
    assert command("check", good, open_)[0] == 3
    assert command("check", open_, run, good)[0] == 1
    code, out, err = command("check", good, run, gone, open_, "--junit", file)
    assert code == 2
    assert re.findall(r"PASS|FAIL|ERROR|INCOMPLETE", out) == ["PASS", "FAIL", "ERROR", "INCOMPLETE"]
    assert err == f"camwright: {gone}: no such case file or run folder\n"
    root = ET.parse(file).getroot()
    assert [suite.get("name") for suite in root] == [str(each) for each in (good, run, gone, open_)]
    for count, expected in (("tests", 12), ("failures", 2), ("errors", 2), ("skipped", 3)):
        assert sum(int(suite.get(count, "")) for suite in root) == expected
        assert root.get(count) == (None if count == "skipped" else str(expected))
    code, out, _ = command("check", good, gone, "--json")
    first, second = json.loads(out)["runs"]
    assert (code, first["verdict"], first["target"]) == (2, "pass", str(good))
    assert second == {"target": str(gone), "error": f"{gone}: no such case file or run folder"}


def test_several_runs_and_their_records(run: Path, tmp_path: Path, command: Command) -> None:
    good, other = write_run(tmp_path / "good"), write_run(tmp_path / "other")
    assert command("check", good, other)[0] == 0
    (other / "trial_1" / "5_cycle.csv").write_text("")
    code, out, err = command("check", good, other)
    assert code == 4
    assert "ALTERED" in out and "5_cycle.csv: was changed" in err
    assert command("check", good, tmp_path / "none")[0] == 2
    code, _, err = command("check", good, run, "--baseline", good)
    assert code == 2 and "--baseline" in err


def test_a_changed_byte_fails_the_record_and_is_named(run: Path, command: Command) -> None:
    assert command("check", run, "--fail-on", "never")[0] == 0
    file = run / "trial_1" / "5_cycle.csv"
    content = bytearray(file.read_bytes())
    content[-3] ^= 1
    file.write_bytes(bytes(content))
    code, _, err = command("check", run, "--fail-on", "never")
    assert code == 4
    assert "5_cycle.csv: was changed" in err


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "No such file or directory"),
        ("", "not JSON"),
        ("[]", "holds no hashes"),
        ("{}", "holds no hashes"),
        ('{"schema": 1, "files": {}}', "schema = 1, must be"),
        ('{"files": {"case.toml": -1}}', "holds no hashes"),
        ({"verdict": "fail"}, "verdict is not what the files of the run say"),
        ({"scope": {}}, "scope is not what the files of the run say"),
        ({"figures": 1e99}, "figures is not what the files of the run say"),
        ({"approved": True}, "approved is not what the files of the run say"),
        ({"files": {}}, "holds no hash of trial_1/6_checks.json"),
    ],
)
def test_a_record_that_is_missing_empty_or_absurd_is_named(
    tmp_path: Path, command: Command, content: object, words: str
) -> None:
    out = write_run(tmp_path / "good")
    file = out / "signoff.json"
    if content is None:
        file.unlink()
    elif isinstance(content, str):
        file.write_text(content)
    else:
        file.write_text(json.dumps(json.loads(file.read_text()) | content))
    code, _, err = command("check", out)
    assert words in err
    assert code == 4


def test_a_case_file_is_previewed_and_never_passes(tmp_path: Path, command: Command) -> None:
    file = tmp_path / "early.toml"
    file.write_text(small_machine("early"))
    code, out, _ = command("check", file, "--json")
    document = json.loads(out)
    assert code == 1
    assert (document["depth"], document["verdict"], document["screen"]) == ("preview", None, "fail")
    assert document["verdict_line"].startswith("FAIL at the depth preview: ")
    for record in document["checks"]:
        if record["judged_at"]:
            assert record["status"] == "not_evaluated"
            assert record["judged_at"] in ("cycle", "certified")
        elif record["id"] != "tolerance_corners":
            assert record["method"].startswith("preview: ")
    made_up = "made up for this template: replace by the maker's table"
    file.write_text(small_machine("early").replace(made_up, "maker: verify"))
    _, text, told = command("check", file, "--all")
    assert 'warning: source "maker: verify" is to be confirmed by its words' in told
    assert "no verdict below the certified depth" in text
    assert "judged at the depth certified: " in text


def test_a_finished_run_is_checked_from_its_folder(tmp_path: Path, command: Command) -> None:
    out = write_run(tmp_path / "good")
    assert command("check", out)[0] == 0
    (out / "notes.txt").write_text("mine")
    code, _, err = command("check", out)
    assert (code, err) == (0, f"camwright: {out}/notes.txt: was added since the sign-off\n")


SCOPE = {"not_covered": ["key", "gear"], "reason": "<b>rig</b> & 'key' [red]\n\t{0} %s $(id) עברית"}
STATED = (
    "Not covered by this sign-off: key, driving gear: <b>rig</b> & 'key' [red] {0} %s $(id) עברית"
)


def test_the_scope_is_stated_in_every_record(tmp_path: Path, command: Command) -> None:
    """Hostile text in its reason is printed unchanged, on one line."""
    case = case_of(tomllib.loads(small_machine("small")) | {"scope": SCOPE})
    out = tmp_path / "run"
    with RunFolder(out, case) as folder:
        write_trial(folder, [check("pass", to_be_confirmed=["[bold]PV[/bold]", "C0"])])
        folder.finish(summary() | {"scope": case.scope.as_record()})
    code, text, _ = command("check", out, "--all")
    assert code == 0
    assert f"\n{STATED}\n" in text
    assert "verdict: PASS, 2 values to be confirmed\n" in text
    assert "\nvalues to be confirmed: [bold]PV[/bold]; C0\n" in text
    document = json.loads(command("check", out, "--json")[1])
    signed = json.loads((out / "signoff.json").read_text())
    for record in (document, signed):
        assert record["scope"] == SCOPE | {"statement": STATED}
        assert record["verdict_line"] == "PASS, 2 values to be confirmed"
        assert record["to_be_confirmed"] == ["[bold]PV[/bold]", "C0"]
    file = tmp_path / "junit.xml"
    command("check", out, "--junit", file)
    stated = [one.get("value") for one in ET.parse(file).iter("property")]
    assert [stated[0], stated[-1]] == ["PASS, 2 values to be confirmed", STATED]
    edited = json.loads((out / "run.json").read_text())
    edited["scope"]["not_covered"] = ["key"]
    (out / "run.json").write_text(json.dumps(edited))
    assert command("check", out)[0] == 4


def test_a_run_without_data_is_incomplete_and_without_checks_fails(
    tmp_path: Path, command: Command
) -> None:
    out = write_run(tmp_path / "open", status="not_evaluated")
    code, text, _ = command("check", out)
    assert code == 3
    assert "verdict: INCOMPLETE: 1 check without data\n" in text
    assert command("check", out, "--fail-on", "never")[0] == 0
    with RunFolder(tmp_path / "none", small_case()) as folder:
        write_trial(folder, [check("pass", must_have=False)])
        folder.finish(summary("fail") | {"binding": []})
    code, text, _ = command("check", tmp_path / "none")
    assert code == 1
    assert "verdict: FAIL: no check decides\n" in text


def test_what_binds_is_told_apart_from_what_nobody_can_judge():
    records = [
        {"id": "roller_static", "status": "fail"},
        {"id": "guide_pv_B", "status": "not_evaluated"},
        {"id": "closure", "status": "pass"},
    ]
    assert binding_lines(records, ["guide_pv_B", "roller_static"]) == [
        "binding: roller_static",
        "binding, as data are missing: guide_pv_B",
    ]
    assert binding_lines(records, []) == []


def test_remedies_are_those_of_one_case(command: Command, tmp_path: Path) -> None:
    code, _, err = command("check", tmp_path / "a.toml", tmp_path / "b.toml", "--missing")
    assert code == 2 and "--missing = 2 targets, must be stated with one run or case alone" in err


def test_recorded_remedies_of_a_run_are_printed(command: Command, tmp_path: Path) -> None:
    failed = check("fail", id="a_two", remedy="follower.mass: 99 g; saves 76 g")
    folder = tmp_path / "run"
    with RunFolder(folder, small_case()) as made:
        made.write("1_torque.csv", values(TORQUE))
        write_trial(made, [failed])
        made.finish(summary("fail"))
    for option in ((), ("--all",)):
        code, out, _ = command("check", folder, *option)
        assert code == 1 and "follower.mass: 99 g; saves 76 g" in out
