"""Every key of a case is described once, and the examples are values that its field accepts."""

from __future__ import annotations

import datetime as dt
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Mapping

import pytest
from pydantic import TypeAdapter, ValidationError

from camwright.pipeline.base.field_texts import texts_below
from camwright.pipeline.base.quantities import Count, In, Known, Meaning, Part, Used
from camwright.pipeline.case.case_values import quantity_of
from camwright.pipeline.case.keys import (
    Key,
    case_keys,
    case_tables,
    keys_at,
    keys_in,
    nested,
    registry,
)
from camwright.pipeline.case.section import Section, words_at, written_as

KEYS = [key for key in case_keys() if not key.is_table]
TABLES = [key for key in case_keys() if key.is_table]
RESOLVED = {key.path for key in KEYS if not key.is_field}
"""Keys that the reader replaces by what they name."""
LONG = 25
"""Characters from which a text is no common word."""


def own_texts(kind: type) -> Mapping[str, str]:
    """Docstrings below the fields of a class, those of its bases left out."""
    above = [texts_below(base) for base in kind.__bases__]
    return {
        field: text
        for field, text in texts_below(kind).items()
        if all(each.get(field) != text for each in above)
    }


def classes() -> dict[type, None]:
    """Classes of the fields of a case and their bases, once each."""
    kinds = (written_as(key.section) for key in case_keys())
    return {
        base: None
        for kind in dict.fromkeys(kinds)
        for base in kind.__mro__
        if base.__module__.startswith("camwright.") and base not in (Part, Section)
    }


def test_every_key_of_a_case_has_a_meaning_a_source_and_an_example():
    fields = {
        f"{table.path}.{field.alias or name}".lstrip(".")
        for table in case_tables()
        for name, field in table.section.model_fields.items()
        if not any(nested(field))
    }
    assert {key.path for key in KEYS} == fields | RESOLVED
    for key in KEYS:
        assert key.meaning and key.source and key.used and key.accepted
        assert key.example is not None
    for key in TABLES:
        assert key.meaning and key.used


def test_a_key_without_a_description_is_refused():
    class Undescribed(Section):
        value: float

    key = Key("value", "", Undescribed, "value")
    with pytest.raises(KeyError):
        _ = key.meaning


def test_no_meaning_stands_twice():
    """Fields of one meaning have one type, which states it, or one class."""
    below = Counter(text for kind in classes() for text in own_texts(kind).values())
    shared = {
        mark.text
        for key in case_keys()
        if key.is_field
        for mark in words_at(key.section, key.field)
        if isinstance(mark, Meaning)
    }
    resolved = Counter(
        words.meaning for kind in classes() for words in vars(kind).get("resolved", {}).values()
    )
    every = below + Counter(shared) + resolved
    assert [text for text, count in every.items() if count > 1] == []


def test_a_key_is_described_at_one_place():
    """Of several kinds of a table one states source and example, and one the meaning."""
    for path, keys in registry().items():
        fields = [key for key in keys if key.is_field]
        for kind in (Known, Used, Meaning):
            marks = {
                repr(mark)
                for key in fields
                for mark in words_at(key.section, key.field)
                if isinstance(mark, kind)
            }
            assert len(marks) <= 1, (path, marks)
        below = {
            text
            for key in fields
            if (text := texts_below(written_as(key.section)).get(key.field)) is not None
        }
        assert len(below) <= 1, (path, below)


def test_every_text_below_a_field_is_that_of_a_key():
    known = {(base, key.field) for key in case_keys() for base in written_as(key.section).__mro__}
    stated = {(kind, field) for kind in classes() for field in own_texts(kind)}
    assert stated - known == set()


def test_the_docstring_of_a_class_does_not_repeat_the_meanings_of_its_fields():
    for kind in classes():
        words = " ".join((kind.__doc__ or "").split())
        assert "Parameters ---" not in words, kind
        for field, text in texts_below(kind).items():
            assert not re.search(rf"(?:^|[.;,] ){field} ?: ", words), (kind, field)
            assert len(text) < LONG or text not in words, (kind, field)


def test_the_meanings_are_not_read_on_import():
    """A command that explains no key parses no source."""
    code = (
        "import ast, inspect\n"
        "def refused(*args, **options): raise AssertionError('source is read')\n"
        "ast.parse = inspect.getsource = refused\n"
        "from camwright.pipeline.case.case_file import parse_case\n"
        "from camwright.pipeline.case.case_values import quantity_of\n"
        "from camwright.pipeline.case.template import first_case\n"
        "assert parse_case(first_case('own').text).name == 'own'\n"
        "assert quantity_of('cam.width').unit == 'mm'\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


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
    for table in case_tables():
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
