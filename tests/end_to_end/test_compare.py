"""`camwright compare`: every smoother on one case."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.results.run_reader import VERDICTS
from camwright.reports import smoother_page

CASE = Path(__file__).parents[1] / "data" / "soft_spring.toml"


SCOPE = """
[scope]
not_covered = ["guides", "spring"]
reason = "a comparison of lifts: bushes and spring of this case do not bear any of them"
"""


def whole(folder):
    """The case at idle without its bushes and its spring, which no lift satisfies."""
    text, over = CASE.read_text(encoding="utf-8"), 'overspeed = "3960 rpm"'
    idle = text[: text.index('[[load_case]]\nname = "overspeed"')]
    assert idle.count(over) == 1
    assert idle.count("positions = 720") == 1
    idle = idle.replace("positions = 720", "positions = 180")
    path = folder / "case.toml"
    path.write_text(idle.replace(over, 'unbalance = "9999 mm/s"') + SCOPE, encoding="utf-8")
    return path


def one_at_a_time(folder):
    """The same without the sample of all tolerances at once."""
    path = whole(folder)
    text, header = path.read_text(encoding="utf-8"), "\n[tolerances]\n"
    assert text.count(header) == 1 and "samples" not in text
    path.write_text(text.replace(header, f"{header}samples = 0\n"), encoding="utf-8")
    return path


@pytest.mark.parametrize("case", [one_at_a_time, pytest.param(whole, marks=pytest.mark.slow)])
def test_compare_tabulates_and_draws(tmp_path, case):
    done = subprocess.run(
        [sys.executable, "-m", "camwright", "compare", str(case(tmp_path)),
         "--out", str(tmp_path)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with (tmp_path / "smoothers.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    ours = rows[-1]
    severity = [VERDICTS.index(row["verdict"]) for row in rows]
    assert ours["smoother"] == "constrained"
    assert severity[-1] == min(severity)
    others = [float(row["residual_std_Nm"]) for row in rows[:-1] if row["residual_std_Nm"]]
    assert 2.0 * float(ours["residual_std_Nm"]) < min(others)
    kinds = {"none", "moving_average", "savitzky_golay", "harmonic", "smoothing_spline"}
    assert kinds <= {row["smoother"] for row in rows}
    assert all((row["binding"] != "") == (row["verdict"] != "pass") for row in rows)
    page = (tmp_path / "smoothers.html").read_text(encoding="utf-8")
    assert "required checks not passed" in page and "smoothing spline of curvature weight" in page
    assert (tmp_path / "smoothers.png").read_bytes().startswith(b"\x89PNG")


def test_page_escapes_what_it_shows(tmp_path):
    rows = [{"smoother": "<b>", "verdict": "incomplete", "lift_max_mm": 1.0}]
    page = smoother_page.write(tmp_path, "a & b", rows, {"x": uniform_turn(12)})
    text = page.read_text(encoding="utf-8")
    assert "&lt;b&gt;" in text and "a &amp; b" in text and "<b>" not in text
    assert 'class="chip incomplete"' in text and "INCOMPLETE" in text
