"""`camwright design smoother`: every smoother on one case."""

import csv
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.base.verdict import VERDICTS
from camwright.pipeline.search.smoothers import (
    Compared,
    lines,
    ranked,
    recommendation,
)
from camwright.reports.comparisons import smoother_page

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
    idle = idle.replace("positions = 720", "positions = 90")
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
def test_compare_tabulates_and_draws(tmp_path, case, command):
    code, said, errors = command("design", "smoother", case(tmp_path), "--out", tmp_path)
    assert code == 0, errors
    with (tmp_path / "smoothers.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    ours = rows[0]
    severity = [VERDICTS.index(row["verdict"]) for row in rows]
    assert ours["smoother"] == "constrained"
    assert severity[0] == min(severity)
    others = [float(row["residual_std_Nm"]) for row in rows[1:] if row["residual_std_Nm"]]
    assert 2.0 * float(ours["residual_std_Nm"]) < min(others)
    counts = [len(row["failing"].split("; ")) if row["failing"] else 0 for row in rows]
    assert counts == sorted(counts)
    shown = said.splitlines()
    assert shown[0].startswith("recommended: constrained: no must-have check fails; ")
    assert [line.split()[1 if line[0] == ">" else 0] for line in shown[2 : 2 + len(rows)]] == [
        row["smoother"] for row in rows
    ]
    assert max(map(len, shown[:-1])) <= 100  # the last one is the path of the page
    kinds = {"none", "moving_average", "savitzky_golay", "harmonic", "smoothing_spline"}
    assert kinds <= {row["smoother"] for row in rows}
    assert all((row["failing"] != "") == (row["verdict"] == "fail") for row in rows)
    page = (tmp_path / "smoothers.html").read_text(encoding="utf-8")
    assert "failing must-have checks, the worst first" in page and "1, recommended" in page
    assert "recommended: constrained" in page and "smoothing spline of curvature weight" in page
    assert (tmp_path / "smoothers.png").read_bytes().startswith(b"\x89PNG")


def test_page_escapes_what_it_shows(tmp_path):
    rows = [{"smoother": "<b>", "verdict": "incomplete", "lift_max_mm": 1.0}]
    page = smoother_page.write(tmp_path, "a & b", rows, {"x": uniform_turn(12)})
    text = page.read_text(encoding="utf-8")
    assert "&lt;b&gt;" in text and "a &amp; b" in text and "<b>" not in text
    assert 'class="chip incomplete"' in text and "INCOMPLETE" in text


def made(kind, failing=(), missing=(), left=2.0, before=6.0, why=""):
    """A result as the previews give it; without a cam where a reason is stated."""
    record = {"failing": list(failing), "missing": list(missing), "verdict": "fail"}
    if why:
        return Compared(kind, kind, None, record | {"why": why})
    figures = {"residual_std_Nm": left, "initial_std_Nm": before, "p0_max_MPa": 1234.5}
    lift = Lift(uniform_turn(12), np.zeros(12))
    return Compared(kind, kind, lift, record | figures, np.radians(60.0))


def test_rank_is_by_failing_checks_then_ripple_and_missing_data_are_no_failure():
    results = [
        made("no_cam", why="undercut of the roller"),
        made("useless", left=5.99),
        made("two", ["jump", "heat"], left=0.1),
        made("rough", ["jump"], left=3.0),
        made("smooth", ["jump"], ["film", "wear"], left=2.0),
    ]
    order = [one.smoother for one in ranked(results)]
    assert order == ["smooth", "rough", "two", "useless", "no_cam"]
    assert recommendation(ranked(results)[0]) == (
        "recommended: smooth 60 deg: fewest failing must-have checks, 1; none passes; "
        "2 N m of ripple left of 6 N m"
    )


def test_lines_state_the_recommendation_first_and_the_missing_data_once():
    ids = [f"check_of_a_long_name_{k}" for k in range(30)]
    results = ranked(
        [made("a", ids, ["x", "y"]), made("b", [], ["x", "y", "z"]), made("c", why="word " * 60)]
    )
    text = lines(results)
    assert text[0].startswith("recommended: b 60 deg: no must-have check fails; ")
    assert text[2] == "> b 60 deg            2     1234  none fails"
    assert text[3].startswith("  a 60 deg            2     1234  30 fail: check_of_a_long_name_0")
    assert text[3].endswith(", +28")
    assert text[4].endswith("…") and "no cam: word word" in text[4]
    said = [line for line in text if "not evaluated" in line]
    assert said == [
        "missing data: must-have checks not evaluated: 2 (3 with some smoothers); "
        "they count as no failure"
    ]
    assert max(map(len, text)) <= 100


def test_without_a_cam_or_a_reduction_nothing_is_recommended():
    assert recommendation(made("a", why="undercut")) == "no smoother gives a cam"
    idle = [made("a", ["torque_reduction"], left=6.1)]
    assert recommendation(idle[0]).startswith("no smoother reduces the ripple; a 60 deg")
    assert not any(line.startswith(">") for line in lines(idle))
    assert lines([made("a", why="undercut")])[2].endswith("no cam: undercut")
