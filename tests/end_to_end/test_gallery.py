"""`python -m validation gallery`: one page of machines; bad cases in one line."""

import json
import shutil
from pathlib import Path

import pytest

from validation.__main__ import main

MACHINES = Path(__file__).resolve().parents[2] / "cases" / "machines"


@pytest.mark.slow
def test_a_machine_is_shown_with_its_values(capsys, tmp_path):
    text = (MACHINES / "two-stroke.toml").read_text(encoding="utf-8")
    case = tmp_path / "two-stroke.toml"
    case.write_text(text.replace("positions = 360", "positions = 72"), encoding="utf-8")
    shutil.copy(MACHINES / "two-stroke.csv", tmp_path)
    assert main(["gallery", str(case), "--out", str(tmp_path / "page")]) == 0
    out = capsys.readouterr().out
    assert "two-stroke: torque ripple" in out
    document = json.loads((tmp_path / "page" / "gallery.json").read_text(encoding="utf-8"))
    (machine,) = document["machines"]
    values = machine["values"]
    assert machine["screen"] == "open" and machine["cycles_per_cam_turn"] == 2
    assert values["torque_std_with_cam_Nm"] < 0.6 * values["torque_std_without_cam_Nm"]
    titles = [panel["y"] for panel in machine["figure"]["panels"]]
    assert titles == ["torque about its mean, N m", "y, mm", "lift, mm", "shaft speed, rpm"]
    page = (tmp_path / "page" / "gallery.html").read_text(encoding="utf-8")
    assert page.count("<svg ") == 1 and "one cycle" not in page and "2 cycles" in page


def test_a_case_without_a_torque_is_refused_in_one_line(capsys, tmp_path):
    case = MACHINES.parent / "papers" / "petrescu_b3.toml"
    assert main(["gallery", str(case), "--out", str(tmp_path / "none")]) == 2
    errors = capsys.readouterr().err
    assert errors.splitlines()[-1].startswith("validation: CASE = petrescu_b3, must be with a tor")
    assert not (tmp_path / "none").exists()
