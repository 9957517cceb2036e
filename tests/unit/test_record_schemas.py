"""JSON Schemas of the records: complete, closed, described; they refuse what is no record."""

from __future__ import annotations

import copy
import itertools
import json
import math
import random
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType, NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    NotRequired,
    Required,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)  # fmt: skip

import pytest
from jsonschema import Draft202012Validator
from made_check import made_check
from record_validation import keeps_schema, schema_errors

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import STATUSES
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks.check import Waived
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.check_document import CheckDocument
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.corners_document import CornersDocument
from camwright.pipeline.records.crown_document import CrownDocument
from camwright.pipeline.records.design_document import DesignDocument
from camwright.pipeline.records.inspection_document import InspectionDocument
from camwright.pipeline.records.redesign_document import RedesignDocument
from camwright.pipeline.records.run_summary import Summary
from camwright.pipeline.records.signoff_record import SignoffRecord
from camwright.pipeline.records.size_document import SizeDocument
from camwright.pipeline.records.study_document import StudyDocument
from camwright.pipeline.records.trial_contents import TrialContents
from camwright.pipeline.results import check_records, run_reader
from camwright.pipeline.results.record_schemas import NAMES, record_schema
from camwright.pipeline.run import run_case

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
    assert described >= {"corners": 17, "inspect": 24, "study": 16}.get(name, 25)


@pytest.mark.parametrize("name", NAMES)
def test_objects_of_fixed_keys_are_closed(name: str) -> None:
    for path, each in subschemas(record_schema(name)):
        named = isinstance(each.get("properties"), dict) and each.get("type") == "object"
        if named and not conditional(path):
            assert each["additionalProperties"] is False, path
            assert set(each["required"]) <= set(each["properties"]), path


def test_an_unknown_schema_is_refused() -> None:
    with pytest.raises(
        InputError, match="schema = runs, must be one of: run, trial, checks, check"
    ):
        record_schema("runs")


def test_the_command_prints_a_schema(command: Callable[..., tuple[int, str, str]]) -> None:
    code, out, _ = command("explain", "--schema", "signoff")
    assert code == 0
    assert json.loads(out) == record_schema("signoff")


def test_the_documentation_lists_every_schema(command: Callable[..., tuple[int, str, str]]) -> None:
    root = CASES.parent
    table = (root / "docs" / "run-folder.md").read_text(encoding="utf-8")
    (row,) = [
        line
        for line in (root / "README.md").read_text(encoding="utf-8").splitlines()
        if line.startswith("| `camwright explain WORD...`")
    ]
    _, shown, _ = command("explain", "--help")
    for name in NAMES:
        assert f"| `{name}` |\n" in table
        assert f"`{name}`" in row
        assert re.search(rf"\b{name}\b", shown)


# --- the schemas say what the modules say


def check_schema() -> dict[str, Any]:
    return dict(record_schema("checks")["$defs"]["CheckRecord"])


def test_keys_and_words_are_those_of_the_modules() -> None:
    check = check_schema()
    record = made_check("stress", 1.0, 2.0).as_record()
    assert set(check["required"]) <= set(record) <= set(check["properties"])
    assert CheckRecord.__required_keys__ <= set(check["required"])
    assert check["properties"]["status"]["enum"] == list(STATUSES)
    run = record_schema("run")
    assert run["properties"]["depth"]["enum"] == [tier.word for tier in Tier]
    assert {*run_reader.HEADLINE} == {*run["$defs"]["HeadlineRecord"]["required"]}
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
    case = read_case(path)
    run = run_case(case, out, depth=Tier.PREVIEW, jobs=1)
    assert (run.summary["valve_train"] is None) is (case.valve_train is None)
    for name, file in (
        ("run", "run.json"),
        ("trial", "trial_1/trial.json"),
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
    unbounded = made_check("crossings", 4.0, 0.0, waiver=Waived("A. Meyer: a trial", 4.0))
    assert (unbounded.status, unbounded.utilisation) == ("waived", math.inf)
    assert schema_errors("checks", [*records(), unbounded.as_record()]) == []


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
    optional = set(check_schema()["properties"]) - set(check_schema()["required"])
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


# --- records drawn from the types of their forms, and the same with one value that is none


JUDGED = ("certified", "pass", None), ("preview", None, "open"), ("cycle", None, "fail")
WORDS = {
    "^[A-Za-z][A-Za-z0-9_]*$": "stress",
    "^[0-9a-f]{64}$": "5f" * 32,
    "^SHA256:[A-Za-z0-9+/]{43}$": "SHA256:" + "a" * 43,
    "^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$": "2026-01-31T12:00:00Z",
}
"""A text for each pattern."""


class Draw:
    """Records of a form by its types and bounds, with the places of their values."""

    def __init__(self, seed: int) -> None:
        self.rng = random.Random(seed)

    def of(self, hint: Any, bounds: Mapping[str, Any] = MappingProxyType({})) -> Any:
        """A value of an annotation."""
        origin, inner = get_origin(hint), get_args(hint)
        if origin in (NotRequired, Required):
            return self.of(inner[0])
        if origin is Annotated:
            return self.of(inner[0], {k: v for each in inner[1:] for k, v in each.keywords.items()})
        if origin in (Union, UnionType):
            return self.of(self.rng.choice(inner), bounds)
        if origin is Literal:
            return self.rng.choice(inner)
        if origin is tuple:
            return [self.of(each) for each in inner]
        if origin is list:
            count = self.rng.randint(bounds.get("minItems", 0), 2)
            made = [self.of(inner[0]) for _ in range(count)]
            return list(dict.fromkeys(made)) if bounds.get("uniqueItems") else made
        if origin is dict:
            keys = (*bounds.get("required", ()), *self.rng.sample(["a", "b"], 1))
            return {key: self.of(inner[1]) for key in keys}
        if hasattr(hint, "__required_keys__"):
            return self.of_form(hint)
        return {
            str: WORDS.get(bounds.get("pattern", ""), "words"), bool: self.rng.random() < 0.5,
            int: self.rng.randint(1, 9), float: round(self.rng.uniform(0.0, 9.0), 3),
            NoneType: None,
        }[hint]  # fmt: skip

    def of_form(self, form: Any) -> dict[str, Any]:
        """A record with all its keys, its status and verdict as its conditions have them."""
        hints = get_type_hints(form, include_extras=True)
        record = {key: self.of(hint) for key, hint in hints.items()}
        if "screen" in record and not isinstance(record["screen"], dict):
            names = ("depth", "verdict", "screen")
            record |= dict(zip(names, self.rng.choice(JUDGED), strict=True))
        if "waived_up_to" in record:
            known = record["status"] != "not_evaluated"
            numbers = dict.fromkeys(("demand", "limit", "utilisation"), 1.5 if known else None)
            record |= numbers | {"waiver": "A", "waived_up_to": 2.0}
        return record


def mutations(record: Any, place: str = "$") -> Iterator[tuple[str, Callable[[], None]]]:
    """Changes of a record with which it is none: a key more, a value of another type."""
    if isinstance(record, dict):
        for key, value in record.items():
            inside = f"{place}.{key}"

            def exchange(key: str = key, value: Any = value) -> None:
                record[key] = [value] if isinstance(value, dict) else {"further": [value]}

            yield inside, exchange
            yield from mutations(value, inside)
    elif isinstance(record, list):
        for k, value in enumerate(record):
            yield from mutations(value, f"{place}[{k}]")


FORMS = {
    "run": Summary, "trial": TrialContents, "check": CheckDocument, "signoff": SignoffRecord,
    "corners": CornersDocument, "crown": CrownDocument, "size": SizeDocument,
    "redesign": RedesignDocument, "design": DesignDocument, "study": StudyDocument,
    "inspect": InspectionDocument,
}  # fmt: skip


@pytest.mark.parametrize("name", FORMS)
def test_drawn_records_keep_their_schema_and_mutated_ones_do_not(name: str) -> None:
    draw, changed = Draw(20261129), 0
    for _ in range(60):
        record = draw.of_form(FORMS[name])
        assert schema_errors(name, record) == []
        text = json.dumps(record)
        for k in draw.rng.sample(range(sum(1 for _ in mutations(record))), 4):
            other = json.loads(text)
            place, change = next(itertools.islice(mutations(other), k, None))
            change()
            assert not keeps_schema(name, other), place
            changed += 1
        assert not keeps_schema(name, record | {"further": 1})
    assert changed == 240


@pytest.mark.parametrize("name", FORMS)
def test_a_drawn_record_without_a_key_that_is_always_written_is_refused(name: str) -> None:
    schema = record_schema(name)
    required = schema.get("required") or schema["$defs"]["CheckDocument"]["required"]
    assert len(set(required)) == len(required) >= {"corners": 5, "size": 10}.get(name, 11)
    record = Draw(7).of_form(FORMS[name])
    for key in record:
        lacking = {other: value for other, value in record.items() if other != key}
        assert keeps_schema(name, lacking) == (key not in required), key


def test_bounds_and_patterns_of_a_form_hold() -> None:
    record = Draw(3).of_form(CheckRecord)
    assert schema_errors("checks", [record]) == []
    for change in ({"error": -1.0}, {"utilisation": -0.1}, {"unit": ""}, {"id": "a b"},
                   {"missing": ["a", "a"]}, {"status": "waived", "waiver": None}):  # fmt: skip
        assert schema_errors("checks", [record | change]), change
