"""Records and numbers that this program would read otherwise than another program or a reader."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from small_machine import small_machine
from small_run import write_run

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import parse_toml, read_json
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.signing_keys import read_trusted, write_key

Command = Callable[..., tuple[int, str, str]]
CHECKS = "trial_1/6_checks.json"
FOUR = "\u09ea"  # Bengali 4, which looks like an 8


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('{"status": "fail", "status": "pass"}', "a key stands twice"),
        ('[{"a": {"b": 1, "b": 1}}]', "a key stands twice"),
        ("1e999", "beyond the range"),
        ("-1e999", "beyond the range"),
        ("NaN", "no number"),
        ("1" + "0" * 400, "an integer of 401 digits"),
        ("1" + "0" * 5000, "an integer of 5001 digits"),
        ("9223372036854775808", "an integer of 19 digits"),
        (r'"\ud800"', "surrogates"),
        (r'{"a\uDFFF": 1}', "surrogates"),
    ],
)
def test_a_record_that_others_may_read_otherwise_is_refused(
    text: str, reason: str, tmp_path: Path
) -> None:
    file = tmp_path / "record.json"
    file.write_text(text)
    with pytest.raises(ResultError, match=rf"record\.json: not JSON \(.*{reason}"):
        read_json(file)


def test_another_record_is_read(tmp_path: Path) -> None:
    file = tmp_path / "record.json"
    numbers = [2**63 - 1, -(2**63), 1.7e308, 0, -0.5]
    file.write_text(json.dumps({"a": numbers, "b": "\U0001f600"}))
    assert read_json(file) == {"a": numbers, "b": "\U0001f600"}


@pytest.mark.parametrize(
    ("name", "key", "value"),
    [
        (CHECKS, "title", {}), (CHECKS, "id", 1), (CHECKS, "demand", "1"),
        (CHECKS, "cam_angle_deg", []), (CHECKS, "must_have", 1), (CHECKS, "limit", True),
        ("run.json", "case", []), ("run.json", "verdict", 1), ("run.json", "final_trial", None),
        ("run.json", "trials", True), ("run.json", "headline", 1), ("run.json", "binding", "a"),
        ("trial_1/trial.json", "why", 1), ("trial_1/trial.json", "certificate", {}),
    ],
)  # fmt: skip
def test_a_value_of_another_type_is_named(
    name: str, key: str, value: object, tmp_path: Path, command: Command
) -> None:
    run = write_run(tmp_path / "run")
    record = json.loads((run / name).read_text())
    (record[0] if isinstance(record, list) else record)[key] = value
    (run / name).write_text(json.dumps(record))
    with pytest.raises(ResultError, match=rf"{key} = .*, must be "):
        run_reader.read_run(run)
    for options in ([], ["--all"], ["--json"]):
        code, _, errors = command("check", run, *options)
        assert code in (2, 4)
        assert "unexpected" not in errors


@pytest.mark.parametrize("number", ["0x" + "f" * 5000, "0b" + "1" * 70, "9223372036854775808"])
def test_an_integer_beyond_64_bits_is_refused(
    number: str, tmp_path: Path, command: Command
) -> None:
    with pytest.raises(
        InputError, match=r"^given = an integer of \d+ bits, must be integers of 64"
    ):
        parse_toml(f"a = [{{ b = {number} }}]", "given")
    file = tmp_path / "case.toml"
    file.write_text(small_machine("part").replace("= 72", f"= {number}"))
    code, _, errors = command("check", file)
    assert code == 2
    assert "unexpected" not in errors


def test_digits_that_look_like_others_are_no_number(tmp_path: Path) -> None:
    assert float(FOUR) == 4.0
    with pytest.raises(InputError, match="a number with a unit"):
        units.parse(f"{FOUR}0 kN/m", "kN/m", "spring.rate")
    file = tmp_path / "table.csv"
    for cell in (f"{FOUR}0", "1_0"):
        file.write_text(f"cam_angle_deg\n0\n{cell}\n", encoding="utf-8")
        with pytest.raises(ResultError, match=r"line 3: cam_angle_deg = .*, must be a number"):
            read_table(file)


def test_a_trusted_key_has_the_roles_of_one_line(tmp_path: Path) -> None:
    write_key(tmp_path / "key")
    line, file = (tmp_path / "key.pub").read_text(), tmp_path / "trusted"
    file.write_text(f"prepared {line}prepared {line}")
    assert [one.roles for one in read_trusted(file).values()] == [("prepared",)]
    for text in (f"prepared {line}{line}", f"{line}prepared {line}", f", {line}"):
        file.write_text(text)
        with pytest.raises(InputError, match="--trusted"):
            read_trusted(file)
