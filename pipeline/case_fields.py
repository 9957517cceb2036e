"""What the sections of a case file are made of: SI floats read from unit strings, safe texts."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, isfinite
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from geometry.errors import InputError
from pipeline import units

SAFE_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9_-])?")


_ALLOWED = "\n\t\u200c\u200d\u200e\u200f"


def refusal(limit: str, **context: str) -> PydanticCustomError:
    """A validation error that says what would be accepted."""
    return PydanticCustomError("limit", "must be {limit}", {"limit": limit, **context})


@dataclass(frozen=True)
class In:
    """Marks a float field: read from a unit string into SI, bounds in the unit shown.

    With no unit it is a pure number, written bare.
    """

    unit: str = ""
    above: float = -inf
    at_least: float = -inf
    below: float = inf
    at_most: float = inf

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, given: object) -> float:
        value = self._number(given)
        shown = [f"> {self.above:g}"] if self.above > -inf else []
        shown += [f">= {self.at_least:g}"] if self.at_least > -inf else []
        shown += [f"< {self.below:g}"] if self.below < inf else []
        shown += [f"<= {self.at_most:g}"] if self.at_most < inf else []
        inside = self._si(self.above) < value < self._si(self.below) and self._si(
            self.at_least
        ) <= value <= self._si(self.at_most)
        if not inside:
            raise refusal(f"{' and '.join(shown)} {self.unit}".rstrip())
        return value

    def _number(self, given: object) -> float:
        if self.unit:
            try:
                return units.parse(given, self.unit, "")
            except InputError as error:
                raise refusal(error.limit) from None
        if isinstance(given, bool) or not isinstance(given, (int, float)):
            raise refusal("a number without a unit")
        value = float(given) if abs(given) < 1e308 else inf
        if not isfinite(value):
            raise refusal("finite")
        return value

    def _si(self, bound: float) -> float:
        if not isfinite(bound) or not self.unit:
            return bound
        return units.parse(f"{bound!r} {self.unit}", self.unit, "")


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

Length = Annotated[float, In("mm", above=0, at_most=10_000)]
Angle = Annotated[float, In("deg")]
Duration = Annotated[float, In("deg", above=0, at_most=720)]
Mass = Annotated[float, In("g", above=0, at_most=1e6)]
Pressure = Annotated[float, In("MPa", above=0, at_most=1e6)]
GasPressure = Annotated[float, In("kPa", above=0, at_most=1e5)]
Temperature = Annotated[float, In("K", above=0, at_most=5000)]
Force = Annotated[float, In("N", at_least=0, at_most=1e9)]
Share = Annotated[float, In(at_least=0, at_most=1)]
Positive = Annotated[float, In(above=0, at_most=1e6)]
Fraction = Annotated[float, In(above=0, at_most=1)]
Safety = Annotated[float, In(above=0, at_most=100)]
Rate = Annotated[float, In("kN/m", above=0, at_most=1e6)]
Preload = Annotated[float, In("N", above=0, at_most=1e9)]
Residual = Annotated[float, In(above=0, at_most=1e-3)]


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
