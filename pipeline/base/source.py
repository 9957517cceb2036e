"""Source of a value: text, whether it confirms the value, notation in a case file.

A text is a source. ``{ text = "...", confirmed = false }`` says that the value is yet to be
confirmed. Files of version 0.1 said so in words: a plain text with one of them is read as
unconfirmed, with a warning, and ``confirmed = true`` keeps the words of a text that is a source.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

_TO_BE_CONFIRMED = " (to be confirmed)"
FORM = 'a text, or { text = "...", confirmed = false }'
"""Forms of a source in a case file."""
_WORDS_OF_0_1 = re.compile(r"\b(recalled|verify|assum\w*|estimat\w*)\b", re.IGNORECASE)
_KEYS = ("source", "sources")
_STATED = {"text", "confirmed"}


@dataclass(frozen=True)
class Source:
    """Source of a value, false if empty; an unconfirmed one is printed with a mark.

    Parameters
    ----------
    text : str         title, edition and place, drawing, test report
    confirmed : bool   False: recalled, assumed or estimated, whatever the words of the text
    """

    text: str
    confirmed: bool

    def __bool__(self) -> bool:
        return bool(self.text.strip())

    def of(self, name: str) -> Source:
        """Source with the name of its value in front."""
        return replace(self, text=f"{name}: {self.text}")

    def __str__(self) -> str:
        return self.text if self.confirmed or not self else f"{self.text}{_TO_BE_CONFIRMED}"


NO_SOURCE = Source("", confirmed=False)
"""Source of a value that is stated without one."""


def source_in(entry: object) -> Source:
    """Source from its entry in a table of a case: text, or a table of text and `confirmed`; empty
    if it is neither.
    """
    if isinstance(entry, str):
        return Source(entry, confirmed=bool(entry.strip()) and not _of_0_1(entry))
    if not isinstance(entry, Mapping) or set(entry) != _STATED:
        return NO_SOURCE
    text, confirmed = entry["text"], entry["confirmed"]
    if not isinstance(text, str) or not isinstance(confirmed, bool):
        return NO_SOURCE
    return Source(text, confirmed and bool(text.strip()))


def entry_of(source: Source) -> Any:
    """Table entry of a source: plain text where `source_in` reads it back, else text and mark."""
    if not _of_0_1(source.text) and source_in(source.text) == source:
        return source.text
    return {"text": source.text, "confirmed": source.confirmed}


def reworded(entry: Any, words: Callable[[str], str]) -> Any:
    """Entry of a source, see `source_in`, with its text changed; whether it confirms the value
    stays.

    Plain text stays plain, unless the new one would be read as unconfirmed or confirmed otherwise.

    Parameters
    ----------
    entry : object     text, or table of text and `confirmed`
    words : callable   text -> new text
    """
    source = source_in(entry)
    new = replace(source, text=words(source.text))
    plain = isinstance(entry, str) and source_in(new.text) == new
    return new.text if plain else entry_of(new)


def old_words(tables: Mapping[str, Any]) -> tuple[str, ...]:
    """Warnings for plain texts that version 0.1 reads as unconfirmed by their words."""
    return tuple(
        f'source "{text}" is to be confirmed by its words, as in version 0.1; written as'
        " { text = ..., confirmed = false }, or with confirmed = true if it confirms the value"
        for text in dict.fromkeys(filter(_of_0_1, _plain(tables)))
    )


def _plain(table: object, key: str = "") -> Iterator[str]:
    """Sources within a table of a case that are plain texts, not tables of text and confirmation.

    Parameters
    ----------
    table : object   table, list or value
    key : str        that holds it; "": the whole
    """
    if isinstance(table, str) and key in _KEYS:
        yield table
    elif isinstance(table, Mapping) and set(table) != _STATED:
        of_values = key == "sources"
        for name, entry in table.items():
            yield from _plain(entry, key if of_values else name)
    elif isinstance(table, list):
        for entry in table:
            yield from _plain(entry)


def _of_0_1(text: str) -> bool:
    return _WORDS_OF_0_1.search(text) is not None
