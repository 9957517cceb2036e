"""Tables and run folders read back: exact where sound, refused where not."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_run import (
    CYCLE,
    LIFT,
    ROWS,
    check,
    small_case,
    summary,
    values,
    write_run,
    write_trial,
)

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import ResultError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.files import json_text
from camwright.pipeline.base.tables import CAM_ANGLE, LOAD_CASE, Column, read_table, table
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results import check_records, run_reader, signoff
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_records import column_table
from camwright.pipeline.solver import solve

THETA = uniform_turn(36)


def test_cycle_columns_are_the_promised_ones() -> None:
    case = small_case().with_positions(36)
    contour = case.contour(Lift(THETA, 0.004 * (1 - np.cos(THETA))))
    files = column_table(solve(case, contour, tier=Tier.PREVIEW, corners=False))
    assert list(files) == [
        "2_lift.csv",
        "2_spline.csv",
        "3_contour.csv",
        "5_cycle.csv",
        "5_speed_sweep.csv",
    ]
    for column in (column for columns in files.values() for column in columns):
        assert column.meaning, column.header
    headers = [column.header for column in files["5_cycle.csv"]]
    assert headers[:9] == [
        "load_case",
        "cam_angle_deg",
        "crank_angle_deg",
        "lift_mm",
        "pressure_angle_deg",
        "pitch_radius_of_curvature_mm",
        "contour_radius_of_curvature_mm",
        "normal_force_N",
        "line_load_N_per_mm",
    ]
    for header in ("p0_hertz_MPa", "p0_fe_MPa", "p0_difference_percent", "half_width_fe_mm"):
        assert header in headers
    for header in (
        "follower_velocity_m_per_s",
        "cam_torque_Nm",
        "jam_index",
        "guide_edge_pressure_A_MPa",
    ):
        assert header in headers
    assert len(set(headers)) == len(headers)
    assert [column.header for column in files["2_lift.csv"]][3:] == [
        "lift_d1_mm_per_rad",
        "lift_d2_mm_per_rad2",
        "lift_d3_mm_per_rad3",
    ]


def test_table_turns_si_into_the_unit_of_the_column() -> None:
    given = values(LIFT, 720)
    given[LIFT[2]] = np.full(720, 0.0335)
    given[CAM_ANGLE] = np.arange(720) * (2.0 * np.pi / 720.0)
    made = table(given)
    assert made["lift_mm"].tolist() == [33.5] * 720
    assert made["cam_angle_deg"].tolist() == [0.5 * k for k in range(720)]  # no 0.49999999999999994
    with pytest.raises(ValueError, match="read-only"):
        made["lift_mm"][0] = 1.0


def test_csv_reads_back_bit_for_bit(tmp_path: Path) -> None:
    made = table(values(CYCLE, 300))
    path = tmp_path / "5_cycle.csv"
    path.write_text(made.to_csv())
    again = read_table(path)
    assert list(again.columns) == list(made.columns)
    assert again.load_cases == made.load_cases == ("idle",)
    for header, column in made.columns.items():
        assert column.tolist() == again[header].tolist()
    assert again.to_csv() == made.to_csv()


def test_columns_that_do_not_apply_are_left_out() -> None:
    given = {c: v for c, v in values(CYCLE).items() if not c.name.startswith("torque")}
    made = table(given)
    assert "torque_before_Nm" not in made
    assert len(made) == ROWS


def test_what_could_not_be_found_is_left_empty(tmp_path: Path) -> None:
    given = values(CYCLE)
    given |= {column: np.full(ROWS, np.nan) for column in given if column.name == "p0_fe"}
    made = table(given)
    path = tmp_path / "table.csv"
    path.write_text(made.to_csv())
    assert "nan" not in path.read_text()
    again = read_table(path)
    assert np.isnan(again["p0_fe_MPa"]).all()
    assert again["p0_hertz_MPa"].tolist() == made["p0_hertz_MPa"].tolist()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({Column("lift", "mm", "again"): np.zeros(ROWS)}, "column lift_mm = twice, must be once"),
        ({LIFT[2]: np.zeros(ROWS + 1)}, "columns of different length"),
        ({LOAD_CASE: np.array(["idle"])}, "columns of different length"),
        ({LIFT[2]: np.zeros((ROWS, 1))}, "column lift_mm holds 2 dimensions"),
        ({LIFT[2]: np.array([0.0, np.nan, 0.0, 0.0, 0.0])}, "column lift_mm holds NaN"),
    ],
)
def test_table_refuses(change: dict[Column, Any], message: str) -> None:
    with pytest.raises(ResultError, match=message):
        table(values(LIFT) | change)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no header"),
        ("a,a\n1,2\n", "a column twice"),
        ("a,b\n1\n", "line 2: 1 cells, must be 2"),
        ("a,b\n1,x\n", "line 2: b = 'x', must be a number"),
        ("a,b\n1,nan\n", "line 2: b = 'nan', must be a number"),
        ("a,b\n1,2\n1, \n", "line 3: b = ' ', must be a number"),
    ],
)
def test_broken_csv_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(ResultError, match=message):
        read_table(path)


def test_rows_of_one_load_case(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("load_case,lift_mm\nidle,1\nrated,2\nidle,3\n")
    assert read_table(path).load_cases == ("idle", "rated")
    assert read_table(path).of_load_case("idle")["lift_mm"].tolist() == [1.0, 3.0]
    assert len(read_table(path).of_load_case("full load")) == 0
    with pytest.raises(ResultError, match="column force_N is missing"):
        read_table(path)["force_N"]


@pytest.mark.parametrize(
    ("status", "verdict"),
    [("pass", "pass"), ("waived", "pass"), ("fail", "fail"), ("not_evaluated", "incomplete")],
)
def test_verdict_comes_from_the_checks(tmp_path: Path, status: str, verdict: str) -> None:
    run = run_reader.read_run(write_run(tmp_path / "run", status=status))
    assert run.verdict == verdict
    assert run.final.binding == (() if verdict == "pass" else ("pressure_angle",))
    assert run.summary["case"] == "small"
    assert run.torque is not None
    run_reader.verify_run(run.path)


def test_the_result_is_the_final_trial_whether_or_not_it_is_the_last(tmp_path: Path) -> None:
    out = tmp_path / "run"
    with RunFolder(out, small_case()) as folder:
        write_trial(folder, [check()], 1)
        write_trial(folder, [check("fail")], 2)
        folder.finish(summary(trials=2) | {"final_trial": 1})
    run = run_reader.read_run(out)
    assert len(run.trials) == 2
    assert run.final.number == 1
    assert run.verdict == run_reader.read_verdict(out)["verdict"] == "pass"
    record = json.loads((out / "signoff.json").read_text())
    assert record["trial"] == 1
    assert record["verdict"] == "pass"


@pytest.mark.parametrize("final", [0, 3])
def test_a_final_trial_that_was_not_solved_is_refused(tmp_path: Path, final: int) -> None:
    out = write_run(tmp_path / "run")
    record = json.loads((out / "run.json").read_text())
    (out / "run.json").write_text(json.dumps(record | {"final_trial": final}))
    with pytest.raises(ResultError, match=rf"final_trial = {final}, must be from 1 to 1$"):
        run_reader.read_run(out)


def test_the_line_of_the_verdict_counts_its_reasons() -> None:
    line = check_records.verdict_line
    good = check(to_be_confirmed=["a", "b"])
    waived = check("waived", id="w", to_be_confirmed=["b", "c"])
    assert line([check()]) == "PASS"
    assert line([good, waived, waived]) == "PASS, 2 waived, 3 values to be confirmed"
    optional = check("fail", must_have=False, to_be_confirmed=["d"])
    missing = check("not_evaluated", id="m")
    assert line([missing, optional]) == "INCOMPLETE: 1 check without data"
    beyond, unproven = check("fail"), check("fail", not_proven=True)
    assert line([missing, beyond, beyond, unproven, waived]) == (
        "FAIL: 2 checks beyond their limit, 1 check not proven, 1 check without data, 1 waived,"
        " 2 values to be confirmed"
    )
    assert line([optional]) == line([]) == "FAIL: no check decides"
    assert check_records.to_be_confirmed([good, waived, optional]) == ["a", "b", "c"]


def test_an_optional_check_does_not_fail_the_verdict(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "run", small_case()) as folder:
        write_trial(folder, [check(), check("not_evaluated", id="film", must_have=False)])
        folder.finish(summary())
    run = run_reader.read_run(tmp_path / "run")
    assert run.verdict == "pass"
    assert run.torque is None


def test_no_checks_is_no_pass(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "run", small_case()) as folder:
        write_trial(folder, [])
        folder.finish(summary("pass"))
    with pytest.raises(ResultError, match=r"run\.json says pass, the checks .* fail"):
        run_reader.read_run(tmp_path / "run")


@pytest.mark.parametrize(
    "change",
    [
        {"demand": None},
        {"limit": None},
        {"demand": 3.0},
        {"demand": 1.0, "limit": 2.0, "sense": "at_least"},
        {"corner": "mass high", "corner_demand": 2.01},
        {"corner": "mass high", "corner_demand": None},
        {"demand": 1.99, "error": 0.02},
        {"corner": "mass high", "corner_demand": 1.9, "error": 0.1},
        {"demand": 2.0, "limit": 1.9, "sense": "at_least", "error": 0.11},
        {"not_proven": True},
    ],
)
def test_a_pass_that_its_numbers_do_not_bear_out(tmp_path: Path, change: dict[str, Any]) -> None:
    with pytest.raises(ResultError, match="marked pass, its numbers say otherwise"):
        _read_with(tmp_path / "run", check() | change)


@pytest.mark.parametrize(
    "change",
    [
        {"demand": None},
        {"limit": None},
        {"waiver": None},
        {"waived_up_to": None},
        {"waived_up_to": 2.99},
        {"error": 0.6},
        {"corner": "mass high", "corner_demand": 3.51},
        {"demand": 1.0, "sense": "at_least", "waived_up_to": 1.5},
    ],
)
def test_a_waiver_that_does_not_cover_the_numbers(tmp_path: Path, change: dict[str, Any]) -> None:
    with pytest.raises(ResultError, match="marked waived, its numbers say otherwise"):
        _read_with(tmp_path / "run", check("waived") | change)


def test_a_failed_check_marked_as_missing_data_is_refused(tmp_path: Path) -> None:
    forged = check("fail") | {"status": "not_evaluated"}
    with pytest.raises(ResultError, match="marked not_evaluated, its numbers say otherwise"):
        _read_with(tmp_path / "run", forged)


@pytest.mark.parametrize(
    "change",
    [
        {"demand": 2.0},
        {"demand": 1.9, "error": 0.1},
        {"demand": 2.0, "error": 2e-9},  # rounding of a closed form
        {"demand": 2.0, "sense": "at_least"},
        {"corner": "nominal", "corner_demand": 1.0, "error": 0.5},
    ],
)
def test_a_pass_at_its_limit_is_read(tmp_path: Path, change: dict[str, Any]) -> None:
    (record,) = _read_with(tmp_path / "run", check() | change)
    assert record["status"] == "pass"


def _read_with(run: Path, record: dict[str, Any]) -> tuple[check_records.CheckRecord, ...]:
    """Checks of a run folder whose record of the checks was edited."""
    write_run(run)
    (run / "trial_1" / "6_checks.json").write_text(json.dumps([record]))
    return run_reader.read_checks(run / "trial_1")


def test_a_scope_that_is_not_of_the_case_is_refused(tmp_path: Path) -> None:
    run = write_run(tmp_path / "run")
    other = r"the scope in run\.json is not that of case"
    for scope, words in (
        ({"not_covered": ["key"], "reason": "", "statement": ""}, other),
        ({}, other),
        ("key", "has scope = 'key', must be an object"),
    ):
        summary = json.loads((run / "run.json").read_text())
        (run / "run.json").write_text(json.dumps(summary | {"scope": scope}))
        for read in (run_reader.read_run, run_reader.read_verdict):
            with pytest.raises(ResultError, match=words):
                read(run)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("synthesis", "an object or null"),
        ("balance", "an object"),
        ("certificate", "a list"),
        ("depth", "text"),
    ],
)
def test_a_value_of_a_trial_of_another_form_is_refused(
    tmp_path: Path, key: str, words: str
) -> None:
    run = write_run(tmp_path / "run")
    file = run / "trial_1" / "trial.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {key: 3}))
    with pytest.raises(ResultError, match=rf"trial\.json: has {key} = 3, must be {words}$"):
        run_reader.read_run(run)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("run.json", "{", "not JSON"),
        ("run.json", "[]", "lacks schema"),
        ("run.json", "{}", "lacks schema"),
        ("run.json", None, "holds no finished run"),
        ("case.toml", None, "No such file"),
        ("trial_1/5_cycle.csv", None, "No such file"),
        ("trial_1/6_checks.json", "[{}]", "a check lacks id"),
        ("trial_1/6_checks.json", "{}", "must be a list"),
        ("trial_1/6_checks.json", '[{"a": NaN}]', "not JSON"),
        ("trial_1/trial.json", "[]", "lacks number"),
        ("trial_1/2_lift.csv", "\xff", "must be"),
    ],
)
def test_broken_run_is_one_line(
    tmp_path: Path, name: str, content: str | None, message: str
) -> None:
    run = write_run(tmp_path / "run")
    if content is None:
        (run / name).unlink()
    else:
        (run / name).write_text(content + "\n1,2\n" if name.endswith("csv") else content)
    with pytest.raises(ResultError, match=message) as caught:
        run_reader.read_run(run)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "read",
    [
        run_reader.read_run,
        run_reader.read_verdict,
        run_reader.verify_run,
        signoff.changes,
        signoff.record,
        drawn_cam,
        lambda run: RunFolder(run, small_case()),
    ],
)
def test_a_folder_of_another_schema_is_refused(
    tmp_path: Path, read: Callable[[Path], object]
) -> None:
    run = write_run(tmp_path / "run")
    for name in ("run.json", "signoff.json"):
        (run / name).write_text(json.dumps({"schema": 1, "case": "small"}))
    with pytest.raises(ResultError, match=r"\.json: schema = 1, must be 7: run the case again$"):
        read(run)


def test_no_folder() -> None:
    with pytest.raises(ResultError, match="no such folder"):
        run_reader.read_run("nowhere")


@pytest.mark.parametrize("name", ["case.toml", "trial_1/5_cycle.csv", "1_torque.csv"])
def test_a_changed_file_is_found(tmp_path: Path, name: str) -> None:
    run = write_run(tmp_path / "run")
    with (run / name).open("a") as file:
        file.write("#")
    with pytest.raises(ResultError, match=r"case\.toml|was changed since the run"):
        run_reader.verify_run(run)
    (run / name).unlink()
    with pytest.raises(ResultError, match=r"No such file|is missing since the run"):
        run_reader.verify_run(run)


def test_json_holds_no_nan() -> None:
    with pytest.raises(ResultError, match="cannot be written"):
        json_text({"a": float("nan")})
    assert json.loads(json_text({"a": np.float64(1.5), "b": np.arange(2)})) == {
        "a": 1.5,
        "b": [0, 1],
    }
