"""Runs of earlier versions still report and are still judged, from their folders alone."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from camwright.pipeline.base.files import read_json
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.check_report import failing
from camwright.pipeline.results.signoff import changes
from camwright.reports import sections

RUNS = Path(__file__).parents[1] / "data" / "runs"
FOLDERS = sorted(folder.name for folder in RUNS.iterdir() if folder.is_dir())
ALWAYS = {"outline", "pressure-angle", "lift", "radii", "pressure", "stress", "normal-force",
          "forces", "guides", "jamming", "speed"}  # fmt: skip
BYTES_MAX = 300_000


@pytest.fixture(params=FOLDERS)
def run(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    return Path(shutil.copytree(RUNS / request.param, tmp_path / request.param))


def test_every_schema_has_a_run() -> None:
    found = {read_json(RUNS / name / "run.json")["schema"] for name in FOLDERS}
    assert found == set(range(1, run_reader.SCHEMA + 1))


@pytest.mark.parametrize("name", FOLDERS)
def test_a_kept_run_is_small(name: str) -> None:
    assert sum(f.stat().st_size for f in (RUNS / name).rglob("*") if f.is_file()) < BYTES_MAX


def test_an_old_run_is_reported(run: Path) -> None:
    made = sections.report(run)
    assert {path.stem for path in made["figures"]} >= ALWAYS
    text = made["page"][0].read_text(encoding="utf-8")
    summary = run_reader.read_summary(run)
    assert f"<title>{summary['verdict'].upper()}: " in text
    for record in json.loads((run / "trial_1" / "6_checks.json").read_text(encoding="utf-8")):
        assert str(record["title"]).replace("'", "&#39;") in text
    assert summary["input_sha256"] in text


def test_an_old_run_is_judged(run: Path) -> None:
    run_reader.verify_run(run)
    document = run_reader.read_verdict(run)
    assert document["verdict"] == "fail" and document["binding"] == ["pressure_angle"]
    assert failing(document["checks"], "must")
    if (run / "signoff.json").is_file():
        assert changes(run) == []


def test_a_changed_figure_of_an_old_run_is_found(run: Path) -> None:
    table = run / "trial_1" / "5_cycle.csv"
    table.write_text(table.read_text(encoding="utf-8").replace("1", "2", 1), encoding="utf-8")
    with pytest.raises(run_reader.ResultError, match="was changed since the run"):
        run_reader.verify_run(run)
