"""JSON Schemas of the records: complete, closed, described; they refuse what is no record."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from made_check import made_check
from record_validation import schema_errors

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import STATUSES
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.run_summary import Summary
from camwright.pipeline.results import check_records, run_reader
from camwright.pipeline.results.record_schemas import NAMES, record_schema
from camwright.pipeline.run import run_case
from camwright.pipeline.studies.valve_train import valve_record

CASES = Path(__file__).parents[2] / "cases"
SHIPPED = sorted(path for path in CASES.rglob("*.toml") if path.name != "mechanisms.toml")
QUICK = {"eccentric", "petrescu_b3"}


def subschemas(schema: Any, path: str = "$") -> Iterator[tuple[str, dict[str, Any]]]:
    """Every object of a schema with its place."""
    if isinstance(schema, dict):
        yield path, schema
        for key, value in schema.items():
            yield from subschemas(value, f"{path}.{key}")
    elif isinstance(schema, list):
        for k, value in enumerate(schema):
            yield from subschemas(value, f"{path}[{k}]")


def conditional(path: str) -> bool:
    """Whether a place lies in a condition, which restricts properties described elsewhere."""
    return not {"if", "then", "else"}.isdisjoint(path.split("."))


@pytest.mark.parametrize("name", NAMES)
def test_schemas_are_of_the_draft_and_describe_every_property(name: str) -> None:
    schema = record_schema(name)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    Draft202012Validator.check_schema(schema)
    described = 0
    for path, each in subschemas(schema):
        if conditional(path) or path.endswith(".properties"):
            continue
        for key, value in each.get("properties", {}).items():
            assert len(value.get("description", "")) > 3, f"{path}: {key}"
            described += 1
    assert described >= 25


@pytest.mark.parametrize("name", NAMES)
def test_objects_of_fixed_keys_are_closed(name: str) -> None:
    for path, each in subschemas(record_schema(name)):
        named = isinstance(each.get("properties"), dict) and each.get("type") == "object"
        if named and not conditional(path):
            assert each["additionalProperties"] is False, path
            assert set(each["required"]) <= set(each["properties"]), path


def test_an_unknown_schema_is_refused() -> None:
    with pytest.raises(InputError, match="schema = runs, must be one of: run, checks, check"):
        record_schema("runs")


def test_the_command_prints_a_schema(command: Callable[..., tuple[int, str, str]]) -> None:
    code, out, _ = command("schema", "signoff")
    assert code == 0
    assert json.loads(out) == record_schema("signoff")


# --- the schemas say what the modules say


def common() -> dict[str, Any]:
    return dict(record_schema("run")["$defs"]["common"]["$defs"])


def test_keys_and_words_are_those_of_the_modules() -> None:
    check = common()["check"]
    record = made_check("stress", 1.0, 2.0).as_record()
    assert set(check["required"]) <= set(record) <= set(check["properties"])
    assert CheckRecord.__required_keys__ <= set(check["required"])
    assert common()["status"]["enum"] == list(STATUSES)
    assert common()["depth"]["enum"] == [tier.word for tier in Tier]
    assert set(run_reader.HEADLINE) <= set(common()["headline"]["required"])
    run = record_schema("run")
    assert run["properties"]["schema"]["const"] == run_reader.SCHEMA
    assert record_schema("signoff")["properties"]["schema"]["const"] == run_reader.SCHEMA
    assert Summary.__required_keys__ <= set(run["required"])


# --- records of the shipped cases


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=() if path.stem in QUICK else pytest.mark.slow)
        for path in SHIPPED
    ],
)
def test_records_of_a_shipped_case_keep_the_schemas(path: Path, tmp_path: Path) -> None:
    out = tmp_path / "run"
    run_case(read_case(path), out, depth=Tier.PREVIEW, jobs=1, also=valve_record)
    for name, file in (
        ("run", "run.json"),
        ("checks", "trial_1/6_checks.json"),
        ("signoff", "signoff.json"),
    ):
        assert schema_errors(name, json.loads((out / file).read_text(encoding="utf-8"))) == []
    document = run_reader.read_verdict(out)
    assert schema_errors("check", document) == []


# --- records that are none


def records() -> list[dict[str, Any]]:
    return [
        made_check("stress", 1.0, 2.0, unit="MPa").as_record(),
        made_check("life", None, 2.0, note="no life").as_record(),
        made_check("jump", 3.0, 2.0).as_record(),
    ]


def test_made_records_keep_the_schema() -> None:
    assert schema_errors("checks", records()) == []


CHANGES: tuple[tuple[str, Any], ...] = (
    ("status", "passed"),
    ("status", None),
    ("sense", "less"),
    ("demand", "1 MPa"),
    ("demand", None),
    ("utilisation", -0.5),
    ("must_have", "yes"),
    ("error", -1.0),
    ("unit", ""),
    ("id", "a check"),
    ("judged_at", "deep"),
    ("to_be_confirmed", "C0"),
    ("missing", [1]),
    ("status", "waived"),  # without a waiver
    ("further", 1),
)


@pytest.mark.parametrize(("key", "value"), CHANGES)
def test_a_changed_check_is_refused(key: str, value: Any) -> None:
    changed = records()
    changed[0][key] = value
    assert schema_errors("checks", changed)


@pytest.mark.parametrize("key", sorted(made_check("a", 1.0, 2.0).as_record()))
def test_a_check_without_a_key_is_refused(key: str) -> None:
    optional = set(common()["check"]["properties"]) - set(common()["check"]["required"])
    changed = records()
    del changed[0][key]
    assert bool(schema_errors("checks", changed)) == (key not in optional)


def document() -> dict[str, Any]:
    """Output of `check --json` on a case file."""
    made: Any = records()
    return {
        "case": "small",
        "input_sha256": "5f" * 32,
        **check_records.judgement(made, "preview"),
        "to_be_confirmed": [],
        "binding": ["life", "jump"],
        "governing": "jump",
        "load_ends": [],
        "scope": {"not_covered": [], "reason": "", "statement": ""},
        "checks": made,
    }


def test_one_target_and_several_keep_the_schema_of_the_output() -> None:
    one = document()
    assert schema_errors("check", one) == []
    several = {"runs": [{"target": "a"} | one, {"target": "b", "error": "b: no such folder"}]}
    assert schema_errors("check", several) == []
    assert schema_errors("check", {"runs": [{"target": "b"}]})
    assert schema_errors("check", [one])


@pytest.mark.parametrize(
    "change",
    [
        {"verdict": "fail"},  # below the certified depth
        {"depth": "certified"},  # without a verdict
        {"screen": "closed"},
        {"input_sha256": "5f"},
        {"scope": {"not_covered": []}},
        {"checks": {}},
        {"binding": "jump"},
        {"mood": "good"},
    ],
)
def test_a_changed_output_is_refused(change: dict[str, Any]) -> None:
    assert schema_errors("check", document() | change)


@pytest.mark.parametrize("key", sorted(document()))
def test_an_output_without_a_key_is_refused(key: str) -> None:
    changed = copy.deepcopy(document())
    del changed[key]
    assert schema_errors("check", changed)
