"""Commented texts of a case file: values in TOML, words in comments, comments in one column."""

from __future__ import annotations

import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.pipeline.base.source import Source, source_in
from camwright.pipeline.case.case_writer import (
    COMMENT_COLUMN,
    added_text,
    filled,
    line_text,
    value_text,
)

TEXT = """\
# --- A cam of @name@
[cam]
name = @name@ # of the drawing
width = @width@ # @words@
offset = @offset@ # left out where there is none
note = "not # a comment"
"""
VALUES = st.recursive(
    st.text() | st.integers(-(2**53), 2**53) | st.booleans() | st.floats(allow_nan=False),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=12,
)


def test_marks_become_values_before_a_comment_and_words_in_it() -> None:
    text = filled(TEXT, name='a "b" # c', width=12.5, words="as drawn", offset=None)
    lines = text.splitlines()
    assert lines[0] == '# --- A cam of a "b" # c'
    assert tomllib.loads(text)["cam"] == {
        "name": 'a "b" # c', "width": 12.5, "note": "not # a comment",
    }  # fmt: skip
    assert [line.index("# ", 20) for line in lines[2:4]] == [COMMENT_COLUMN] * 2
    assert lines[3].endswith("# as drawn")
    assert "offset" not in text
    assert "offset = 3 " in filled(TEXT, name="", width=1, words="", offset=3)


def test_a_long_line_keeps_two_spaces_before_its_comment() -> None:
    line = filled("name = @name@ # short\n", name=60 * "x")
    assert line == f'name = "{60 * "x"}"  # short\n'


def test_a_mark_without_a_value_is_refused() -> None:
    with pytest.raises(KeyError, match="width"):
        filled("width = @width@\n", wide=1)


@settings(deadline=None)
@given(VALUES)
def test_a_value_reads_back_from_its_line(value: object) -> None:
    assert "\n" not in value_text(value)
    assert tomllib.loads(line_text("key", value)) == {"key": value}


@settings(deadline=None)
@given(st.text(), st.booleans())
def test_a_source_reads_back_in_its_form(words: str, confirmed: bool) -> None:
    source = Source(words, confirmed and bool(words.strip()))
    read = tomllib.loads(line_text("source", source))["source"]
    assert source_in(read) == source or not words.strip()


def test_added_tables_are_a_block_of_their_own() -> None:
    text = added_text({"cam": {"width": "12 mm"}})
    assert tomllib.loads(text) == {"added": [{"cam": {"width": "12 mm"}}]}
