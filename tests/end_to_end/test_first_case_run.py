"""The first case of each kind, run to its certificate: PASS, and `check` says so."""

import json
import re
from pathlib import Path

import pytest
from record_validation import schema_errors

from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.template import KINDS
from camwright.pipeline.commands.check_command import check
from camwright.pipeline.commands.new_command import new
from camwright.pipeline.commands.terminal import INCOMPLETE, PASSED
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.run import run_case

LEAST_MARGIN = 0.05
PREVIEWED = ("torque", "harmonics", "compressor", "pump")
"""Machines that test_first_case.py previews; the press stands for them here."""


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind not in PREVIEWED])
def test_a_first_case_passes(tmp_path, monkeypatch, kind):
    monkeypatch.chdir(tmp_path)
    assert new("first", kind=kind) == PASSED
    run_case(read_case(Path("first.toml")), Path("run"), progress=Silent())
    run = read_run(Path("run"))
    assert run.verdict == "pass"
    assert check([Path("run")]) == PASSED
    for name in ("run", "signoff"):
        assert schema_errors(name, json.loads(Path("run", f"{name}.json").read_text())) == []
    required = [each for each in run.final.checks if each["must_have"]]
    assert all(each["status"] == "pass" for each in required)
    design = {each["id"]: each["margin"] for each in required if not each["evidence"]}
    assert min(design.values()) >= LEAST_MARGIN, min(design, key=lambda each: design[each])


@pytest.mark.slow
def test_without_a_datum_it_is_incomplete_until_the_printed_block_is_pasted(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert new("first", kind="eccentric") == PASSED
    path = tmp_path / "first.toml"
    text, count = re.subn(r"^roller_life = .*\n", "", path.read_text(), flags=re.MULTILINE)
    assert count == 1
    path.write_text(text)
    run_case(read_case(path), Path("run"), progress=Silent())
    assert read_run(Path("run")).verdict == "incomplete"
    assert check([Path("run")]) == INCOMPLETE

    capsys.readouterr()
    assert check([path], missing=True) == INCOMPLETE
    block, count = re.subn('roller_life = ".*?"', 'roller_life = "1000 h"', capsys.readouterr().out)
    assert count == 1
    path.write_text(f"{text}\n{block}")
    run_case(read_case(path), Path("cured"), progress=Silent())
    assert read_run(Path("cured")).verdict == "pass"
    assert check([Path("cured")]) == PASSED
