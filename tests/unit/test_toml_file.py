"""TOML files of the user's: what cannot be read is refused in one line."""

import tomllib

import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import parse_toml, read_toml
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.cards.spring_catalogue import read_catalogue

DEEP = "a = " + "[" * 20_000


def test_a_small_file_is_read(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text('[oils.mine]\nname = "Öl"\n', encoding="utf-8")
    assert read_toml(path, "cards", path.stat().st_size) == {"oils": {"mine": {"name": "Öl"}}}


@pytest.mark.parametrize(
    ("content", "limit"),
    [
        (b"a = 1 #" + b"x" * 1018, "at most 1 KiB"),
        (b"a = ", "KEY = VALUE"),
        (b"a = '\xff'", "text in UTF-8"),
        (None, "a readable TOML file"),
    ],
)
def test_another_is_refused_by_its_field(tmp_path, content, limit):
    path = tmp_path / "given.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=f"^given = .*{limit}"):
        read_toml(path, "given", 1024)


def test_cards_and_springs_nested_too_deeply_are_refused(tmp_path):
    for name, read in (
        ("cards.toml", lambda: known_cards(tmp_path)),
        ("springs.toml", lambda: read_catalogue(tmp_path / "springs.toml")),
    ):
        (tmp_path / name).write_text(DEEP)
        with pytest.raises(InputError, match="nested too deeply"):
            read()


@pytest.mark.parametrize(
    "key", ["a." * 120_000 + "b", "a . " * 60_000 + "b", "'a'." * 30_000 + "b"]
)
@pytest.mark.parametrize("form", ["{} = 1", "[{}]", "[[{}]]", "a = {{ {} = 1 }}", "{}"])
def test_a_key_of_many_parts_is_refused_before_it_is_parsed(form: str, key: str) -> None:
    """The parser alone takes a minute for each."""
    with pytest.raises(InputError, match=r"^given = nested too deeply, must be at most 16"):
        parse_toml(form.format(key), "given")


def test_parts_in_a_text_or_a_comment_are_no_key() -> None:
    dotted = "a." * 40
    text = f"""a = "{dotted}\\"{dotted}" # "{dotted}
b = '{dotted}\\'
c = \'\'\'{dotted}''{dotted}
\'\'\'
d = [1.5, 2.5, 1979-05-27T07:32:00.5Z]
"e.{dotted}".{"a" * 10_000}.f = 1
"""
    assert parse_toml(text, "given") == tomllib.loads(text)


@pytest.mark.parametrize(
    ("text", "place", "limit"),
    [
        ('a = 1\nname = "x\n[cam]\n', "line 2, column 10", "closing quote"),
        ("a = 1\n\nname = x\n", "line 3, column 8", "in quotes"),
        ("[cam]\nwidth = 10 mm  # c\n", "line 2, column 12", "in quotes"),
        ("[cam]\nwidth = 10,5\n", "line 2, column 11", "number such as 0.5"),
        ("a = True\n", "line 1, column 5", "must be true"),
        ("[cam]\na = 1\n[cam]\n", "line 3, column 5", "opened once"),
        ("[cam]\na = 1\na = 2", "line 3, column 6", "stated once"),
        ("a = 1\nname = \u201cx\u201d\n", "line 2, column 8", "straight quotes"),
        ('name : "a"\n', "line 1, column 6", "KEY = VALUE"),
        ("name =\n", "line 1, column 7", "KEY = VALUE"),
        ("a = 1\n[cam\n", "line 2, column 5", "closing bracket"),
        ("[[cam]\n", "line 1, column 6", "closing brackets"),
        ('file = "C:\\users"\n', "line 1", "single quotes"),
        ("a = [1, 2\n", "line 1", "must be"),
    ],
)
def test_a_slip_is_named_with_its_place(text: str, place: str, limit: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_toml(text, "case")
    assert str(caught.value).startswith(f"case = {place}"), caught.value
    assert limit in str(caught.value)
    # A link may make any file an input: nothing of it is repeated.
    assert not any(line in str(caught.value) for line in text.split("\n") if len(line) > 5)
    assert "\n" not in str(caught.value)


def test_a_byte_of_another_encoding_is_named_with_its_place() -> None:
    with pytest.raises(InputError, match=r"byte 0xe4 in line 2, column 9, must be text in UTF-8"):
        parse_toml(b'"\xc3\xa4" = 1\nname = "\xe4"\n', "case")
