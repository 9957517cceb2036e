"""Tables and run folders read back: exact where sound, refused where not."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_run import ROWS, check, small_case, summary, values, write_run, write_trial

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import json_text
from camwright.pipeline.base.tables import read_table, table
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.run_folder import RunFolder


def test_cycle_columns_are_the_promised_ones() -> None:
    headers = [column.header for column in run_reader.CYCLE]
    assert headers[:9] == [
        "load_case",
        "cam_angle_deg",
        "crank_angle_deg",
        "lift_mm",
        "pressure_angle_deg",
        "pitch_radius_mm",
        "contour_radius_of_curvature_mm",
        "normal_force_N",
        "line_load_N_per_mm",
    ]
    for header in ("p0_hertz_MPa", "p0_fe_MPa", "p0_difference_percent", "half_width_fe_mm"):
        assert header in headers
    for header in ("velocity_m_per_s", "cam_torque_Nm", "torque_after_Nm", "jam_index"):
        assert header in headers
    assert len(set(headers)) == len(headers)
    assert [column.header for column in run_reader.LIFT][3:] == [
        "lift_d1_mm_per_rad",
        "lift_d2_mm_per_rad2",
        "lift_d3_mm_per_rad3",
    ]


def test_table_turns_si_into_the_unit_of_the_column() -> None:
    given = values(run_reader.LIFT, 720)
    given["lift"] = np.full(720, 0.0335)
    given["cam_angle"] = np.arange(720) * (2.0 * np.pi / 720.0)
    made = table(run_reader.LIFT, given)
    assert made["lift_mm"].tolist() == [33.5] * 720
    assert made["cam_angle_deg"].tolist() == [0.5 * k for k in range(720)]  # no 0.49999999999999994
    with pytest.raises(ValueError, match="read-only"):
        made["lift_mm"][0] = 1.0


def test_csv_reads_back_bit_for_bit(tmp_path: Path) -> None:
    made = table(run_reader.CYCLE, values(run_reader.CYCLE, 300))
    path = tmp_path / "5_cycle.csv"
    path.write_text(made.to_csv())
    again = read_table(path)
    assert list(again.columns) == list(made.columns)
    for header, column in made.columns.items():
        assert column.tolist() == again[header].tolist()
    assert again.to_csv() == made.to_csv()


def test_columns_that_do_not_apply_are_left_out() -> None:
    given = values(run_reader.CYCLE)
    del given["torque_before"], given["torque_after"]
    made = table(run_reader.CYCLE, given)
    assert "torque_before_Nm" not in made
    assert len(made) == ROWS


def test_what_could_not_be_found_is_left_empty(tmp_path: Path) -> None:
    made = table(run_reader.CYCLE, values(run_reader.CYCLE) | {"p0_fe": np.full(ROWS, np.nan)})
    path = tmp_path / "table.csv"
    path.write_text(made.to_csv())
    assert "nan" not in path.read_text()
    again = read_table(path, run_reader.CYCLE)
    assert np.isnan(again["p0_fe_MPa"]).all()
    assert again["p0_hertz_MPa"].tolist() == made["p0_hertz_MPa"].tolist()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"lift": None}, "column lift_mm was not given"),
        ({"lyft": np.zeros(ROWS)}, "no such column: lyft"),
        ({"lift": np.zeros(ROWS + 1)}, "columns of different length"),
        ({"lift": np.array([0.0, np.nan, 0.0, 0.0, 0.0])}, "column lift_mm holds NaN"),
    ],
)
def test_table_refuses(change: dict[str, Any], message: str) -> None:
    given = {name: v for name, v in (values(run_reader.LIFT) | change).items() if v is not None}
    with pytest.raises(ResultError, match=message):
        table(run_reader.LIFT, given)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no header"),
        ("a,a\n1,2\n", "a column twice"),
        ("a,b\n1\n", "line 2: 1 cells, must be 2"),
        ("a,b\n1,x\n", "line 2: b = 'x', must be a number"),
        ("a,b\n1,nan\n", "line 2: b = 'nan', must be a number"),
        ("a,b\n1,\n1,2\n", "line 2: b = '', must be a number"),
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
    assert read_table(path).where("load_case", "idle")["lift_mm"].tolist() == [1.0, 3.0]
    with pytest.raises(ResultError, match="column force_N is missing"):
        read_table(path)["force_N"]


@pytest.mark.parametrize(
    ("status", "verdict"),
    [("pass", "pass"), ("waived", "pass"), ("fail", "fail"), ("not_evaluated", "fail")],
)
def test_verdict_comes_from_the_checks(tmp_path: Path, status: str, verdict: str) -> None:
    run = run_reader.read_run(write_run(tmp_path / "run", status=status))
    assert run.verdict == verdict
    assert run.final.binding == (() if verdict == "pass" else ("pressure_angle",))
    assert run.summary["case"] == "small"
    assert run.torque is not None
    run_reader.verify_run(run.path)


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
        {"demand": "1"},
        {"demand": 1.0, "limit": 2.0, "sense": "at_least"},
    ],
)
def test_a_pass_that_its_numbers_do_not_bear_out(tmp_path: Path, change: dict[str, Any]) -> None:
    run = write_run(tmp_path / "run")
    path = run / "trial_1" / "6_checks.json"
    path.write_text(json.dumps([check() | change]))
    with pytest.raises(ResultError, match="its numbers say otherwise"):
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
        ("trial_1/trial.json", "[]", "must be an object"),
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
