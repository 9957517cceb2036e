"""Provenance of card values: source, place in it, condition, read or recalled.

A card states it in its table ``provenance``, one entry for each number or, by wildcards, for
several; the first entry that fits holds. An entry has the id of a title in ``sources.toml``, the
table or page, the condition, and how the number is known: read in that source, or recalled.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.source import Source, source_in
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.section import Section, Text
from camwright.pipeline.case.toml_text import Tables, TomlValue

PROVENANCE = "provenance"
_TITLES = Path(__file__).parent / "sources.toml"
_BYTES = 256 * 1024
_NUMBER = re.compile(r"[-+]?\.?\d")
_WORDS = ("source", "name", "condition")


class Provenance(Section):
    """Origin of a card value: id or title of the source, place, condition."""

    source: Text
    at: Text = ""
    condition: Text = ""
    known: Literal["read", "recalled"]

    @property
    def stated(self) -> Source:
        """Source of the value: title, place and condition as its text, confirmed if the number was
        read there.
        """
        title = titles().get(self.source, self.source)
        placed = ", ".join(each for each in (title, self.at) if each)
        words = "; ".join(each for each in (placed, self.condition) if each)
        return Source(words, confirmed=self.known == "read")


@cache
def titles() -> Mapping[str, str]:
    """Titles and editions of the sources by id."""
    return {name: str(title) for name, title in read_toml(_TITLES, _TITLES.name, _BYTES).items()}


def numbers_of(card: Tables) -> Iterator[str]:
    """Keys of a card whose values are numbers, with or without unit, or lists of them."""
    for key, value in card.items():
        plain = isinstance(value, (int, float, list)) and not isinstance(value, bool)
        if plain or (key not in _WORDS and isinstance(value, str) and _NUMBER.match(value)):
            yield key


def provenance_of(card: Tables, key: str, field: str) -> Provenance | None:
    """Provenance of a value of a card: the first entry whose pattern fits the key; None if the card
    states no provenance.

    Parameters
    ----------
    card : Tables   with its table `provenance`
    key : str       of the value
    field : str     dotted name of the card, for messages

    Raises
    ------
    InputError
        If the entry is incomplete, or none fits the number.
    """
    entries = card.get(PROVENANCE)
    if entries is None:
        return None
    field = f"{field}.{PROVENANCE}"
    if not isinstance(entries, dict):
        raise InputError(field, str(entries), "a table")
    for pattern, entry in entries.items():
        if fnmatchcase(key, pattern):
            return _read(entry, f"{field}.{pattern}")
    raise InputError(f"{field}.{key}", "missing", "given, as other numbers of the card have theirs")


def source_in_card(card: Tables, key: str, field: str) -> Source:
    """Source of a card value: its provenance, else the source of the whole card."""
    known = provenance_of(card, key, field)
    return source_in(card.get("source", "")) if known is None else known.stated


def without_provenance(card: Tables) -> Tables:
    """Card without provenance, as the table of its part."""
    return {key: value for key, value in card.items() if key != PROVENANCE}


def _read(entry: TomlValue, field: str) -> Provenance:
    """Provenance of an entry of a card; InputError with its field."""
    try:
        return Provenance.model_validate(entry)
    except ValidationError as error:
        raise refusal_of(error, field) from None
