"""Runs below the certified depth: a screen, no verdict, no status better than the depth allows."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.commands.check_command import check
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results import signoff
from camwright.pipeline.results.run_reader import read_run, read_verdict
from camwright.pipeline.run import run_case
from camwright.reports.sections import report

CLOSED_FORMS = (Tier.SCREENING, Tier.PREVIEW)


@pytest.fixture(scope="module", params=CLOSED_FORMS, ids=lambda tier: tier.word)
def shallow(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The run of a new case by closed forms, without its page."""
    out = tmp_path_factory.mktemp("shallow") / request.param.word
    run_case(parse_case(small_machine("small")), out, depth=request.param, positions=36)
    return out


def test_a_shallow_run_has_a_screen_and_no_verdict(shallow: Path) -> None:
    run = read_run(shallow)
    assert (run.summary["depth"], run.summary["verdict"]) == (shallow.name, None)
    assert run.summary["screen"] in ("open", "fail")
    assert (run.verdict, run.screen) == (None, run.summary["screen"])
    signed = json.loads((shallow / "signoff.json").read_text())
    assert (signed["depth"], signed["verdict"]) == (shallow.name, None)
    assert signoff.changes(shallow) == []
    assert not list((shallow / "fields").glob("*")) and not (shallow / "8_report.html").exists()
    assert np.isnan(run.final.cycle["p0_fe_MPa"]).all()
    assert run.summary["headline"]["p0_max_MPa"] == run.summary["headline"]["p0_hertz_max_MPa"]


def test_no_check_above_the_depth_is_better_than_not_evaluated(shallow: Path) -> None:
    tier = Tier.of(shallow.name, "depth")
    checks = read_run(shallow).final.checks
    beyond = [
        each
        for each in checks
        if each["id"] in DECLARED
        and DECLARED[each["id"]].tier > tier
        and not (each["status"] == "fail" and DECLARED[each["id"]].is_bound(tier))
    ]
    assert beyond and {check["id"] for check in beyond} == {
        each["id"] for each in checks if each["judged_at"]
    }
    for each in beyond:
        assert each["status"] == "not_evaluated"
        assert each["judged_at"] == DECLARED[each["id"]].tier.word
        assert each["judged_at"] in each["note"]


def test_check_never_passes_a_shallow_run(
    shallow: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert check([shallow]) == {"fail": 1, "open": 3}[str(read_run(shallow).screen)]
    printed = capsys.readouterr().out
    assert "PASS" not in printed
    assert f"at the depth {shallow.name}: " in printed
    assert "no verdict below the certified depth" in printed


def test_a_verdict_is_not_written_into_a_shallow_run(shallow: Path, tmp_path: Path) -> None:
    text = (shallow / "run.json").read_text()
    record = json.loads(text)
    (shallow / "run.json").write_text(json.dumps(record | {"verdict": "pass", "screen": None}))
    with pytest.raises(ResultError, match=r"run\.json says pass, the checks of .* None"):
        read_verdict(shallow)
    (shallow / "run.json").write_text(json.dumps(record | {"depth": "certified"}))
    with pytest.raises(ResultError, match=r"run\.json says certified, the final trial "):
        read_verdict(shallow)
    (shallow / "run.json").write_text(text)


def test_the_page_of_a_shallow_run_states_its_screen(shallow: Path) -> None:
    if shallow.name == "screening":
        pytest.skip("the page is that of a preview")
    report(shallow)
    page = (shallow / "8_report.html").read_text(encoding="utf-8")
    assert "Screen, no verdict" in page
    assert "Judged at the depth certified" in page
    assert ">PASS<" not in page
    assert f"{shallow.name} without sign-off" in page


def test_an_unknown_depth_is_refused() -> None:
    with pytest.raises(InputError, match="--depth = deep, must be one of: screening, preview"):
        Tier.of("deep", "--depth")
