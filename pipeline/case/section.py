"""Base of all sections of a case file, and the texts and names they accept."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    model_validator,
)
from pydantic_core import PydanticCustomError

SAFE_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9_-])?")
_ALLOWED = "\n\t\u200c\u200d\u200e\u200f"


def refusal(limit: str, **context: str) -> PydanticCustomError:
    """A validation error that says what would be accepted."""
    return PydanticCustomError("limit", "must be {limit}", {"limit": limit, **context})


def printable(text: str) -> str:
    """The text, refused if it holds control characters.

    Joiners and direction marks, which scripts and emoji are made with, are none; overrides of the
    direction, which make a text read as another, are.
    """
    if not all(character.isprintable() or character in _ALLOWED for character in text):
        raise refusal("printable text")
    return text


def _safe_name(name: str) -> str:
    if not SAFE_NAME.fullmatch(name):
        raise refusal("1 to 40 letters, digits, '_', '-' or '.', starting with a letter or digit")
    return name


Name = Annotated[str, AfterValidator(_safe_name)]


Text = Annotated[str, Field(max_length=10_000), AfterValidator(printable)]


FileName = Annotated[str, Field(min_length=1, max_length=200), AfterValidator(printable)]


class Section(BaseModel):
    """Base of all sections: frozen, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    @model_validator(mode="before")
    @classmethod
    def _know_every_key(cls, given: Any) -> Any:
        """Refuse unknown keys before missing ones: a slip of the pen is both."""
        known = [field.alias or name for name, field in cls.model_fields.items()]
        for key in given if isinstance(given, dict) else ():
            if key not in known:
                raise refusal(f"a known key{suggestion(key, known)}", unknown_key=str(key))
        return given


def suggestion(word: str, known: Iterable[str]) -> str:
    """What may have been meant, else what is known."""
    close = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {close[0]}?" if close else f": {', '.join(known)}"
