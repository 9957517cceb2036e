"""Text that means harm, or that few programs expect, in every file that carries what users write.

The page, its scripts, the PDF and the scene have such tests beside their own.
"""

from __future__ import annotations

import json
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
import small_run
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.meshes.gmsh_mesher import session
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
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
