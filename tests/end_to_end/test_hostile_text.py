"""Text that means harm, or that few programs expect, in every file that carries what users write.

The page, its scripts, the PDF and the scene have such tests beside their own.
"""

from __future__ import annotations

import io
import json
import os
import sys
import tomllib
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
import small_run
from rich.table import Table
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.meshes.gmsh_mesher import session
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.commands import terminal
from camwright.pipeline.results import run_reader, signoff
from camwright.pipeline.results.junit_report import junit, junit_suite
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.workshop_files import write_workshop

TECHNICIAN = "\U0001f469\u200d\U0001f527"  # two signs and a joiner
HARM = "<script>alert(1)</script> \"quoted\" 'so' ../../etc/passwd ]]> <!-- & %s {0} $(id) "
ABROAD = f"עברית \u200fعربي {TECHNICIAN} \U0001f600 "
LONG = HARM + ABROAD + "x" * (10_000 - len(HARM) - len(ABROAD))
FOLDER = f'a\'b "c" <d> & עברית {TECHNICIAN}'


def case() -> Case:
    lines = [
        f"title = {json.dumps(LONG, ensure_ascii=False)}",
        f"notes = {json.dumps(LONG, ensure_ascii=False)}",
    ]
    text = small_machine("hostile").replace('title = "What is this design for?"', "\n".join(lines))
    quoted = json.dumps(HARM + ABROAD, ensure_ascii=False)
    return parse_case(text.replace('"what this design is for"', quoted))


def records() -> list[dict[str, object]]:
    texts = {"title": LONG, "note": LONG, "source": HARM, "method": ABROAD}
    return [small_run.check(status, id=f"one_{status}", **texts)
            for status in ("pass", "fail", "not_evaluated")]  # fmt: skip


def test_a_case_keeps_its_words_to_the_letter() -> None:
    of = case()
    assert (of.title, of.notes) == (LONG, LONG)
    again = parse_case(of.to_toml())
    assert (again.title, again.sha256) == (LONG, of.sha256)
    assert tomllib.loads(of.to_toml())["limits"]["sources"]["torque_reduction"] == HARM + ABROAD


def test_a_run_keeps_them_in_a_folder_of_any_name(tmp_path: Path) -> None:
    out = tmp_path / FOLDER / "run"
    out.parent.mkdir()
    with RunFolder(out, case()) as folder:
        small_run.write_trial(folder, records())
        folder.finish(small_run.summary("fail") | {"binding": ["one_fail", "one_not_evaluated"]})
    assert list(out.parent.iterdir()) == [out]  # nothing beside it, nothing above it
    found = run_reader.read_run(out)
    assert [check["title"] for check in found.final.checks] == [LONG] * 3
    assert signoff.changes(out) == []


def test_junit_is_whole_xml() -> None:
    odd = small_run.check("fail", id="odd", title="bell \x07 and \x00 nothing")
    suite = ET.fromstring(
        junit([junit_suite([*records(), odd], "hostile", "must", "fail", {"scope": HARM + ABROAD})])
    )
    told = " ".join(
        text for node in suite.iter() for text in (*node.attrib.values(), node.text or "")
    )
    assert told.count(LONG) == 8  # title and note: twice of the failure, in message and text
    assert HARM in told and ABROAD in told
    assert "bell \ufffd and \ufffd nothing" in told
    assert {node.tag for node in suite.iter()} <= {
        "testsuite", "properties", "property", "testcase", "failure", "skipped", "system-out"
    }  # fmt: skip


def test_workshop_files_lie_in_a_folder_of_any_name_and_read_back(tmp_path: Path) -> None:
    import ezdxf

    of, folder, said = case(), tmp_path / FOLDER, []
    theta = uniform_turn(180)
    contour = of.contour(Lift(theta, 0.005 * (1 - np.cos(theta))))
    write_workshop(folder, of, contour, said.append)
    assert said == []
    assert sorted(path.name for path in folder.iterdir()) == [
        "cam.step", "contour.csv", "contour.dxf", "cutter.csv", "dimensions.json", "inspection.csv"
    ]  # fmt: skip
    document = ezdxf.readfile(folder / "contour.dxf")
    assert not document.audit().has_errors
    assert b"script" not in (folder / "cam.step").read_bytes()  # no word of the case
    with session() as gmsh:
        gmsh.model.occ.importShapes(str(folder / "cam.step"))
        gmsh.model.occ.synchronize()
        assert len(gmsh.model.getEntities(3)) == 1


@pytest.mark.parametrize("letter", ["\x00", "\x07", "\x1b", "\u202e", "\u2066", "\ufeff", "\x85"])
def test_what_steers_a_terminal_or_turns_a_text_round_is_refused(letter: str) -> None:
    escaped = json.dumps(f"a{letter}b")
    with pytest.raises(InputError, match="printable text"):
        parse_case(small_machine("part").replace('"What is this design for?"', escaped))


STEERING = "\x1b[31m\x1b]0;title\x07\x9b2J\r\x7f\u202e\x00"
"""Colour, title of the window, bell, clearing, carriage return, delete, override, nothing."""
NAME = STEERING.replace("\x00", "")  # of a file
RAW = "\x1b[31m\x1b]0;title\x07\x9b2J"  # in a text file, within a line
WRITTEN = "\x1b[31m\u202e"  # what no message may shorten away


def assert_steers_nothing(*texts: str) -> None:
    for text in texts:
        assert not {c for c in text if not c.isprintable()} - {"\n"}, ascii(text)


@pytest.mark.parametrize(
    ("was", "becomes"),
    [
        ("[follower]", f"[{json.dumps(WRITTEN)}]\n[follower]"),
        ("[follower]", f"[follower]\n{json.dumps(WRITTEN)} = 1"),
        ("[follower]", f"[follower]\nkind = {json.dumps(WRITTEN)}"),
        ("[follower]", f"[follower]\nviscous_damping = {json.dumps('1 ' + WRITTEN)}"),
        ("[follower]", f"[follower]\nexternal_force_file = {json.dumps(WRITTEN)}"),
        ("[cam]", f"[cam]\nmaterial = {json.dumps(WRITTEN)}"),
        ("[cam]", f"[cam]\nsource = {json.dumps(WRITTEN)}"),
        ("[[load_case]]", f"[sources]\n{json.dumps(WRITTEN)} = 'x'\n\n[[load_case]]"),
        ("schema_version", f"{json.dumps(WRITTEN)}.x = {json.dumps(WRITTEN)}\nschema_version"),
        ("schema_version", f"# {WRITTEN}\nschema_version"),
    ],
)
def test_no_word_of_a_case_file_steers_the_terminal(
    was: str, becomes: str, tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    text = small_machine("part")
    assert was in text
    file = tmp_path / "case.toml"
    file.write_text(text.replace(was, becomes, 1), encoding="utf-8")
    for words in (["check", file], ["check", file, "--json"], ["explain", WRITTEN]):
        code, out, err = command(*words)
        assert code == 2
        assert_steers_nothing(out, err)


@pytest.mark.parametrize("name", [NAME, os.fsdecode(b"no\xffutf8")])
def test_no_name_of_a_file_steers_the_terminal(
    name: str, tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    folder = tmp_path / name
    folder.mkdir()
    (folder / "case.toml").write_text("schema_version = 2", encoding="utf-8")
    table, keys = folder / f"{name}.csv", folder / "key"
    table.write_text(f"angle {RAW},torque {RAW}\n1,2{RAW}\n", encoding="utf-8")
    absent = folder / "absent"
    for words in (
        ["check", absent], ["check", folder / "case.toml"], ["check", folder], ["run", absent],
        ["report", folder], ["sign", folder], ["sign", "run", folder],
        ["inspect", folder, table], ["contact", "deck", folder], ["deck", folder],
        ["design", "sizes", absent], ["study", "run", absent, "--out", absent],
        ["design", "parts", absent], ["design", "crown", absent], ["size", absent],
        ["design", "machine", table, "--speed", "100 rpm", "--out", folder / "made.toml"],
        ["sign", "key", keys], ["sign", "key", keys], [name], ["design", name],
        ["check", f"--{name}"], ["check", absent, absent, "--seed", name],
    ):  # fmt: skip
        _, out, err = command(*words)
        assert out or err, words
        assert_steers_nothing(out, err)


def test_no_line_of_a_data_file_or_study_steers_the_terminal(
    tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    table, study = tmp_path / "table.csv", tmp_path / "study.toml"
    for header, row in ((f"{RAW}a,{RAW}b", "1,2"), ("crank_angle_deg,torque_Nm", f"1,2{RAW}")):
        table.write_text(f"{header}\n{row}\n" * 2, encoding="utf-8")
        code, out, err = command(
            "design", "machine", table, "--speed", "100 rpm", "--out", tmp_path / "made.toml"
        )
        assert code == 2
        assert_steers_nothing(out, err)
    study.write_text(f"{json.dumps(WRITTEN)} = 1\n", encoding="utf-8")
    code, out, err = command("study", "run", study, "--out", tmp_path / "out")
    assert code == 2
    assert_steers_nothing(out, err)


def test_no_word_of_a_run_steers_the_terminal(
    tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    """Also of a run whose records were written by another program than this one."""
    run = tmp_path / "run"
    words = {"title": STEERING, "note": STEERING, "source": STEERING, "method": STEERING}
    with RunFolder(run, case()) as folder:
        small_run.write_trial(folder, [
            small_run.check(status, id=f"one_{status}", **words)
            for status in ("pass", "fail", "not_evaluated")
        ])  # fmt: skip
        folder.finish(small_run.summary("fail") | {"binding": [f"one{STEERING}"]})
    for options in ([], ["--all"], ["--json"], ["--missing"], ["--verify-record"]):
        _, out, err = command("check", run, *options)
        assert out or err
        assert_steers_nothing(out, err)
    document = json.loads(command("check", run, "--json")[1])
    assert STEERING in {check["title"] for check in document["checks"]}  # whole, to a program


def test_bars_and_tables_on_a_terminal_have_their_own_escapes_alone() -> None:
    table = Table(STEERING)
    table.add_row(STEERING, style="red")
    screen = io.StringIO()
    console = terminal._Console(force_terminal=True, file=screen, color_system="standard")
    options: dict[str, Any] = {"markup": False}
    console.print(table, STEERING, f"a {STEERING}", **options)
    with terminal.Bars(console) as bars:
        bars.stage(STEERING)
        bars.note(STEERING)
    written = screen.getvalue()
    assert "\x1b[31m" in written  # the red of the row
    assert not any(sign in written for sign in ("\x1b]", "\x9b", "\x07", "\x7f", "\u202e"))
