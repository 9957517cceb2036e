"""Every key of a case has its text, and the examples are values that its field accepts."""

from __future__ import annotations

import datetime as dt

import pytest
from pydantic import TypeAdapter, ValidationError

from camwright.pipeline.base.quantities import Count, In
from camwright.pipeline.case import keys
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import quantity_of
from camwright.pipeline.case.keys import Key, case_keys, keys_at, keys_in

KEYS = [key for key in case_keys() if not key.is_table]
RESOLVED = {key.path for key in KEYS if key.default == "none"}
"""Keys that the reader replaces by what they name."""


def test_every_key_of_a_case_has_a_meaning_a_source_and_an_example():
    """A key without its text raises on reading the table of keys."""
    fields = {
        f"{table.path}.{field.alias or name}".lstrip(".")
        for table in keys.sections(Case)
        for name, field in table.section.model_fields.items()
        if not any(keys.nested(field))
    }
    assert {key.path for key in KEYS} == fields | RESOLVED
    for key in KEYS:
        assert key.meaning and key.source and key.used and key.accepted
        assert key.example is not None


def test_no_text_is_without_a_key():
    known = {key.path for key in case_keys()} | {""}
    stated = {
        f"{table}.{name}".lstrip(".") if name != "table" else table
        for table, entries in keys._texts().items()
        if table != "*"
        for name in entries
    }
    assert stated - known == set()


@pytest.mark.parametrize(
    "key", [key for key in KEYS if key.path not in RESOLVED], ids=lambda key: key.path
)
def test_an_example_is_a_value_that_its_key_accepts(key: Key):
    quantity = None if key.path.startswith(("sources", "limits.sources")) else quantity_of(key.path)
    for value in key.example if isinstance(key.example, list) else [key.example]:
        if isinstance(quantity, In | Count):
            quantity.require(key.path, quantity.read(value))
        elif key.accepted.startswith("`") and "true" not in key.accepted:
            assert f"`{value}`" in key.accepted
        else:
            assert isinstance(value, str | bool | int | dict | dt.date)


def test_an_example_of_a_whole_number_is_within_its_bounds():
    for table in keys.sections(Case):
        for name, field in table.section.model_fields.items():
            if field.annotation is not int:
                continue
            (key, *_) = keys_at(f"{table.path}.{field.alias or name}".lstrip("."))
            adapter = TypeAdapter(field.rebuild_annotation())
            adapter.validate_python(key.example)
            with pytest.raises(ValidationError):
                adapter.validate_python(-(10**9))


def test_a_name_of_the_case_stands_for_the_word_of_the_table():
    (key,) = keys_at("materials.steel.expansion")
    assert (key.path, key.accepted) == ("materials.NAME.expansion", ">= 0, <= 0.01 1/K")
    assert keys_at("load_case[0].speed") == keys_at("load_case.speed") != ()
    assert keys_at("guides.a.wal") == ()


def test_a_key_that_some_kinds_of_a_table_share_has_one_entry_for_each():
    assert [key.header for key in keys_at("engine.bore")] == [
        '[engine] kind = "cylinder"', '[engine] kind = "pressure"',
    ]  # fmt: skip


def test_needed_are_the_data_without_which_a_part_is_not_whole():
    needed = [key.name for key in keys_in("roller.fork") if key.needed]
    assert needed == ["cheek_width", "cheek_height", "cheek_length", "bridge_length", "material"]


def test_the_guides_share_the_texts_of_their_keys_alone():
    a, b = (keys_at(f"guides.{side}")[0].meaning for side in "ab")
    assert (a, b) == ("guide A next to the cam", "guide B beyond guide A")
    assert keys_at("guides.a.wall")[0].meaning == keys_at("guides.b.wall")[0].meaning
