"""TOML files of the user's: what cannot be read is refused in one line."""

import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
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
        (b"a = ", "a readable TOML file"),
        (b"a = '\xff'", "a readable TOML file"),
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
