"""The GX120 smoothed until its checks pass: trials of the feedback, in files and in words."""

from pathlib import Path

import pytest

from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.results.verdict_summary import trial_lines
from camwright.pipeline.run import run_case
from camwright.reports.analysis_sheet import groups
from camwright.reports.report_data import read_material

CASE = Path(__file__).parents[2] / "cases" / "gx120-feedback.toml"


@pytest.mark.slow
def test_fails_at_its_first_trial_and_passes_at_its_last_at_the_price_of_ripple(tmp_path):
    summary = run_case(read_case(CASE), tmp_path / "run", positions=180).summary
    assert summary["verdict"] == "pass", summary["binding"]
    run = read_run(tmp_path / "run")
    assert len(run.trials) >= 3 and run.final is run.trials[-1]
    required = [
        {each["id"] for each in trial.checks if each["must_have"] and each["status"] == "fail"}
        for trial in run.trials
    ]
    assert {"pressure_angle", "curvature_ratio", "friction_power"} <= required[0]
    assert [len(each) for each in required] == sorted(map(len, required), reverse=True)
    assert not required[-1]
    widths = [trial.record["smoothing_width_deg"] for trial in run.trials]
    assert widths == sorted(set(widths)), "each trial is smoother than the one before"
    assert list(run.ripples) == sorted(set(run.ripples)), "and leaves more ripple"
    shown = read_material(tmp_path / "run").turn
    assert {"trial-points", "trial-contours", "trial-torque"} <= {
        each.id for _, figures in groups(shown) for each in figures
    }
    first, *_, last = trial_lines(run)[1:]
    assert f"{len(required[0])}: " in first and last.endswith("none")
