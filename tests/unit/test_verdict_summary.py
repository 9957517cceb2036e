"""Verdict of a run in at most 15 lines of 100 columns."""

from __future__ import annotations

import io
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from small_run import check

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.pipeline.base.units import used
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.check_records import judgement
from camwright.pipeline.results.check_report import remarks, table
from camwright.pipeline.results.run_reader import read_run, read_verdict
from camwright.pipeline.results.verdict_summary import (
    LINES,
    WIDTH,
    Places,
    advisory_lines,
    failure_lines,
    figure_lines,
    missing_lines,
    next_lines,
    summary_lines,
    trial_lines,
)
from camwright.pipeline.run import run_case

CASES = sorted(Path(__file__).parents[2].glob("cases/**/*.toml"))
SOLVED = [
    each for each in CASES if each.stem != "mechanisms" and each.parent.name != "machines"
]  # the machines are solved by tests/verification/test_shipped_machines.py
PLACES = Places("runs/gx120", "cases/gx120.toml", "runs/gx120/8_report.html", 14.47)
REMEDY = "roller.radius = 45 mm instead of 32 mm; the cam radius grows by 13 mm to 89 mm, its limit"


def document(checks: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    base = {
        **judgement(checks, "certified"),
        "checks": checks,
        "scope": {"statement": ""},
        "trials": 1,
        "headline": {"torque_std_before_Nm": 6.339, "torque_std_after_Nm": 1.847},
    }
    return base | more


def every_check(depth: str = "certified") -> dict[str, Any]:
    """Each declared check beyond its limit, with the longest words that a run has."""
    checks: list[Any] = [
        check(
            "fail", id=one.id, title=one.title.format(follower="roller"), unit=one.unit,
            must_have=one.must_have, evidence=one.evidence, demand=1.234e-05, limit=-9.876e-05,
            load_case="over-speed", cam_angle_deg=184.5, remedy=REMEDY,
            to_be_confirmed=[f"value of {one.id}"],
        )
        for one in DECLARED.values()
    ]  # fmt: skip
    checks += [check("not_evaluated", id=f"x{k}", missing=[f"key.{k}"]) for k in range(42)]
    scope = {"statement": f"Not covered by this sign-off: {'camshaft bearings, ' * 9}: no data"}
    return document(checks, scope=scope) | judgement(checks, depth)


def fits(lines: list[str]) -> bool:
    return len(lines) <= LINES and max(map(len, lines)) <= WIDTH


@pytest.mark.parametrize("depth", ["certified", "preview"])
def test_the_longest_summary_fits(depth: str) -> None:
    lines = summary_lines(every_check(depth), PLACES)
    assert fits(lines)
    assert sum(line.startswith("     remedy: ") for line in lines) == 3
    assert (
        "missing: 42 keys of the case, listed by camwright check cases/gx120.toml --missing"
        in lines
    )
    assert (
        f"  {sum(d.must_have for d in DECLARED.values()) - 3} more: camwright check runs/gx120"
        in lines
    )
    assert lines[-1] == (
        "page: runs/gx120/8_report.html, analysis sheet: #sheet in it; 1 trial; 14.5 s"
    )


def test_the_worst_three_of_the_design_come_before_evidence() -> None:
    checks: list[Any] = [
        check("fail", id="mesh", title="Mesh", demand=90.0, utilisation=45.0, evidence=True),
        check("fail", id="a", title="A", demand=3.0),
        check("fail", id="b", title="B", demand=None, utilisation=None),
        check("fail", id="c", title="C", demand=4.0, utilisation=2.0, remedy="give up 5 %"),
        check("fail", id="o", title="O", demand=99.0, utilisation=49.5, must_have=False),
    ]
    lines = summary_lines(document(checks), PLACES)
    assert lines[:6] == [
        "verdict: FAIL: 4 checks beyond their limit",
        "  1. B: - deg, limit <= 2 deg (> 999 %), idle 12.5 deg",
        "  2. C: 4 deg, limit <= 2 deg (200 %), idle 12.5 deg",
        "     remedy: give up 5 %",
        "  3. A: 3 deg, limit <= 2 deg (150 %), idle 12.5 deg",
        "  1 more: camwright check runs/gx120",
    ]
    assert lines[6] == "headline: torque ripple 6.34 to 1.85 N m (-71 %)"
    every = "\n".join(failure_lines(checks))
    assert "fails: Mesh: 90 deg" in every and "O: 99 deg" not in every
    assert advisory_lines(checks)[0].startswith("beyond its limit, decides nothing: O: 99 deg")


def test_a_pass_names_what_governs() -> None:
    checks: list[Any] = [
        check(id="p", title="P", utilisation=0.9996),
        check(id="q", evidence=True, utilisation=1.0),
    ]
    lines = summary_lines(document(checks), PLACES._replace(page="", seconds=None))
    assert lines == [
        "verdict: PASS",
        "headline: torque ripple 6.34 to 1.85 N m (-71 %)",
        "governing: P, 99.96 % used, idle 12.5 deg",
        "1 trial",
    ]


def test_a_check_that_governs_beside_a_lesser_failure_is_named() -> None:
    checks: list[Any] = [
        check("fail", id="a", title="A", demand=1.9, utilisation=0.95, not_proven=True),
        check(id="p", title="P", utilisation=0.99),
    ]
    lines = summary_lines(document(checks), PLACES)
    assert "governing: P, 99 % used, idle 12.5 deg" in lines


def test_missing_keys_are_listed_once_with_the_checks_that_need_them() -> None:
    checks: list[Any] = [
        check("not_evaluated", id="a", missing=["guides.a.wall", "limits.target_life"]),
        check("not_evaluated", id="b", missing=["guides.a.wall"]),
        check("not_evaluated", id="c", note="judged elsewhere"),
        check("not_evaluated", id="o", missing=["cam.mass"], must_have=False),
    ]
    assert missing_lines(checks, "x.toml") == [
        "missing: guides.a.wall, for a, b",
        "missing: limits.target_life, for a",
        "not evaluated: c: judged elsewhere",
        "missing: 2 keys of the case, listed by camwright check x.toml --missing",
    ]


def test_trials_stand_side_by_side(tmp_path: Path) -> None:
    """Smoothing, ripple and the worst failures of each trial; nothing of a single one."""
    report_fixture.write_run(tmp_path, positions=36, field=False)
    run = read_run(tmp_path)
    head, first, second = trial_lines(run)
    assert max(map(len, (head, first, second))) <= WIDTH
    assert first[:46] == "    1  moving_average, 60 deg     3.4 N m     "
    failed = [each for each in run.trials[0].checks
              if each["must_have"] and each["status"] == "fail"]  # fmt: skip
    worst = max(failed, key=lambda each: each["utilisation"])
    assert f"{len(failed)}: {worst['id']} {used(worst['utilisation'])}" in first
    assert "moving_average, 120 deg    3.1 N m" in second
    assert trial_lines(replace(run, trials=run.trials[1:])) == []
    assert run.ripples == (3.4, 3.1)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "-"), (math.nan, "-"), (0.0, "0 %"), (0.004, "< 1 %"), (0.5, "50 %"),
        (0.99996, "99.996 %"), (1.0, "100 %"), (1.004, "100.4 %"), (9.99, "999 %"),
        (9.991, "> 999 %"), (math.inf, "> 999 %"),
    ],
)  # fmt: skip
def test_used_is_capped_and_never_rounded_across_its_limit(value: float | None, words: str) -> None:
    assert used(value) == words


def test_the_summary_of_the_published_cam_fits() -> None:
    trial = preview_case(read_case(SOLVED[[each.stem for each in SOLVED].index("gx120")]))
    checks: list[Any] = [one.as_record() for one in trial.checks]
    scope = trial.case.scope.as_record()
    printed = io.StringIO()
    Console(file=printed, width=WIDTH, soft_wrap=True).print(table(checks))
    assert max(map(len, printed.getvalue().split("\n"))) <= WIDTH
    assert fits(summary_lines(document(checks, scope=scope) | judgement(checks, "preview"), PLACES))


@pytest.mark.slow
@pytest.mark.parametrize("case", SOLVED, ids=[each.stem for each in SOLVED])
def test_the_summary_of_a_run_of_a_shipped_case_fits(case: Path, tmp_path: Path) -> None:
    run_case(read_case(case), tmp_path / "run", positions=72, depth=Tier.CYCLE)
    places = Places("runs/x", str(case.name), "runs/x/8_report.html", 100.0)
    assert fits(summary_lines(read_verdict(tmp_path / "run"), places))


def test_a_reason_or_need_shared_by_many_checks_stands_once() -> None:
    keys: dict[str, Any] = {"missing": ["cam.end", "roller.end"], "note": "missing: both"}
    checks: list[Any] = [
        *(check("not_evaluated", id=name, **keys) for name in ("a", "b", "c")),
        *(check("not_evaluated", id=name, note="the follower leaves the cam") for name in "de"),
    ]
    assert missing_lines(checks, "x.toml") == [
        "missing: cam.end, roller.end, for a, b, c",
        "not evaluated: d, e: the follower leaves the cam",
        "missing: 2 keys of the case, listed by camwright check x.toml --missing",
    ]
    assert remarks(checks) == [
        "missing data: a, b, c: missing: both",
        "missing data: d, e: the follower leaves the cam",
    ]


def test_an_open_screen_is_followed_by_the_next_step() -> None:
    opened: dict[str, Any] = {"screen": "open", "depth": "preview", "binding": [], "checks": []}
    assert next_lines(opened, Places("runs/x", "x.toml")) == [
        "all is well so far: every check that a preview can judge passes. OPEN, as deeper ones "
        "need finite elements;",
        "next: camwright run x.toml --out runs/x",
    ]
    lacking = opened | {"binding": ["grip"]}
    assert "missing data" in next_lines(lacking, Places("", "x.toml"))[0]
    assert next_lines(opened | {"screen": "fail"}, Places("", "x.toml")) == []
    assert next_lines(opened | {"screen": None}, Places("", "x.toml")) == []
    lacking["checks"] = [check("not_evaluated", missing=["shaft"])]
    assert next_lines(lacking, Places("", "x.toml"))[-1] == "next: camwright check x.toml --missing"


def test_a_failure_without_a_remedy_is_followed_by_the_command_that_seeks_one() -> None:
    failed: dict[str, Any] = {"screen": "fail", "depth": "preview", "binding": ["grip"]}
    failed["checks"] = [check("fail")]
    assert next_lines(failed, Places("", "x.toml")) == ["next: camwright design remedies x.toml"]
    failed["checks"] = [check("fail", remedy="spring.rate 20 kN/m instead of 10 kN/m")]
    assert next_lines(failed, Places("", "x.toml")) == []


def test_figures_of_a_load_case_without_loads_are_left_out() -> None:
    row = {
        "load_case": "idle", "speed_rpm": 600.0, "cam_speed_rpm": 300.0, "normal_force_min_N": -3.0,
        "normal_force_max_N": None, "drive_torque_min_Nm": -0.0, "drive_torque_max_Nm": None,
        "p0_hertz_max_MPa": None, "half_width_max_mm": None,
    }  # fmt: skip
    cam = {"lift_max_mm": 20.0, "pressure_angle_max_deg": 23.2333, "convex_radius_min_mm": None,
           "cam_radius_max_mm": 60.0}  # fmt: skip
    assert figure_lines(cam | {"load_cases": [row]}) == [
        "figures: lift 20 mm, pressure angle 23.233 deg, cam radius 60 mm",
        "figures of idle at 600 rpm, cam 300 rpm: contact force -3 N, torque on the cam 0 N m",
    ]
