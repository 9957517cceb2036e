"""A machine is judged whole: no datum of a described part can be left out of a sign-off."""

import tomllib
from copy import deepcopy
from typing import Any

import made_trial as made
import pytest
from check_tools import BY_ID
from hypothesis import given, settings
from hypothesis import strategies as st
from trial_variants import (
    on_arm,
    with_extension_spring,
    with_gas_spring,
    with_second_arm,
    with_torsion_spring,
)

from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.base.verdict import verdict, within_depth
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.parts_section import Follower
from camwright.pipeline.case.scope_section import PART_WORDS
from camwright.pipeline.checks.check import Check
from camwright.pipeline.preview import preview_case

TABLES: dict[str, Any] = tomllib.loads(made.CASE_FILE.read_text(encoding="utf-8"))
NOT_OF_A_PART = ("schema_version", "name", "lift", "solver", "tolerances", "load_case", "limits")


def judged(tables: dict[str, Any]) -> tuple[Check, ...]:
    """Checks of a preview of the case, as if it were certified."""
    coarse = deepcopy(tables)
    coarse["solver"] = {"positions": 36}
    return within_depth(preview_case(case_of(coarse), corners=False).checks)


def without(*keys: str) -> dict[str, Any]:
    """The case without a key, by the names of its tables and its own."""
    tables = deepcopy(TABLES)
    table = tables
    for key in keys[:-1]:
        table = table[key]
    del table[keys[-1]]
    return tables


def data(table: dict[str, Any] = TABLES, above: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """Every key that the case states of a part, by its names."""
    found = []
    for key, value in table.items():
        if not above and key in NOT_OF_A_PART:
            continue
        # Of the oil only the advisory film ratio is known; no part is made of the bronze.
        if (*above, key) not in (("lubricant",), ("materials", "bronze")):
            found.append((*above, key))
        if isinstance(value, dict):
            found += data(value, (*above, key))
    return found


def test_the_case_that_describes_every_part_passes():
    assert verdict(judged(TABLES)) == "pass"


WORDS = {name for part in [*Part.__subclasses__(), Follower] for name in part.defaults}
"""Names of the fields whose absence has a documented meaning."""


def outcome(keys: tuple[str, ...]) -> tuple[str, bool]:
    """Verdict without a key, "error" if it cannot be read or solved; whether it has a default."""
    try:
        tables = without(*keys)
        case, judgement = case_of(tables), verdict(judged(tables))
    except CamError:
        return "error", False
    table: Any = case.tables()
    for key in keys:
        table = table.get(key) if isinstance(table, dict) else None
    return judgement, table is not None or keys[-1] in WORDS


@settings(max_examples=6, deadline=None, derandomize=True)
@given(st.sampled_from(data()))
def test_no_datum_of_a_described_part_can_be_left_out(keys):
    """A sample; `make verify` tries every one."""
    found, defaulted = outcome(keys)
    assert found in ("incomplete", "fail", "error") or defaulted, ".".join(keys)


@pytest.mark.slow
@pytest.mark.parametrize("keys", data(), ids=".".join)
def test_every_datum_left_out_keeps_the_verdict_from_pass(keys):
    found, defaulted = outcome(keys)
    assert found in ("incomplete", "fail", "error") or defaulted


@pytest.mark.parametrize("part", PART_WORDS)
def test_a_part_is_described_or_left_out_by_the_scope(part):
    declared = BY_ID[f"data_{part}"]
    kinds = {"gas_spring": with_gas_spring, "torsion_spring": with_torsion_spring,
             "extension_spring": with_extension_spring, "arm": on_arm,
             "rocker": with_second_arm, "pivot": made.arm_solution}  # fmt: skip
    whole = kinds.get(part, made.solution)()
    found = declared(whole)
    assert found is not None
    assert found.status == "pass"
    others = whole.case.scope.not_covered
    scope = made.changed(whole.case.scope, not_covered=(*others, part))
    left = made.changed(whole.case, scope=scope)
    assert declared(made.changed_solution(whole, case=left)) is None
    assert not any(
        one.part == part and one(made.changed_solution(whole, case=left)) for one in BY_ID.values()
    )


@pytest.mark.parametrize(
    ("keys", "name"),
    [(("camshaft",), "camshaft"), (("camshaft",), "gear"), (("camshaft",), "camshaft_bearings"),
     (("cam", "keyway"), "key"), (("roller", "pin"), "pin"), (("roller", "fork"), "fork"),
     (("spring", "design"), "spring")],
)  # fmt: skip
def test_a_part_that_is_neither_described_nor_left_out_is_a_row(keys, name):
    tables = without(*keys)
    if keys == ("cam", "keyway"):
        tables["cam"].pop("key", None)
    checks = {one.id: one for one in judged(tables)}
    row = checks[f"data_{name}"]
    assert (row.status, row.must_have) == ("not_evaluated", True)
    assert "[scope]" in row.note
    # the scope leaves the row out, see above; no need to solve the machine again
    tables["scope"] = {"not_covered": [name], "reason": "covered by the engine maker"}
    assert BY_ID[f"data_{name}"](made.solution(case=case_of(tables))) is None


FIXED = {"unbalance": "50 g mm", "angle": "30 deg", "position": "10 mm"}
BENCH = {"residual": "20 g mm", "position": "10 mm"}


def with_counterweight(table: dict[str, str]) -> dict[str, Any]:
    tables = deepcopy(TABLES)
    tables["camshaft"]["counterweight"] = table
    return tables


@pytest.mark.parametrize("table", [FIXED, BENCH])
def test_no_datum_of_a_counterweight_can_be_left_out(table):
    shaft = case_of(with_counterweight(table)).camshaft
    assert shaft is not None and shaft.counterweight is not None
    for key in table:
        left = {name: text for name, text in table.items() if name != key}
        with pytest.raises(InputError, match=r"camshaft\.counterweight\..* must be "):
            case_of(with_counterweight(left))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (FIXED | BENCH, "unbalance, residual = both, must be exactly one of the two"),
        ({"position": "0 mm"}, "unbalance, residual = neither, must be exactly one of the two"),
        (BENCH | {"angle": "30 deg"}, "angle = 30 deg, must be left out with residual"),
        (BENCH | {"residual": "0 g mm"}, "residual = 0 g mm, must be > 0 and <= 1e+09 g mm"),
        (BENCH | {"residual": "2e9 g mm"}, "residual = 2e9 g mm, must be > 0 and <= 1e+09 g mm"),
        (BENCH | {"residual": "20 g"}, "residual = 20 g, must be"),
    ],
)
def test_a_counterweight_is_stated_in_exactly_one_of_two_ways(table, message):
    with pytest.raises(InputError) as refusal:
        case_of(with_counterweight(table))
    assert str(refusal.value).startswith(f"camshaft.counterweight.{message}")


def test_a_scope_has_a_reason():
    tables = deepcopy(TABLES) | {"scope": {"not_covered": ["fork"]}}
    with pytest.raises(InputError, match=r"scope\.reason"):
        case_of(tables)
