"""Quantities of an input: SI floats read from text with a unit, within bounds.

A bound stands once, beside its field, and holds for the text of a case file and for a value set in
Python alike.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from inspect import get_annotations
from math import inf, isfinite
from types import MappingProxyType, NoneType, UnionType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    Self,
    Union,
    get_args,
    get_origin,
)

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.printed_text import is_printed
from camwright.pipeline.base.source import Source

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from pydantic import GetCoreSchemaHandler
    from pydantic_core import CoreSchema


PURE = "a number without a unit"
"""Limit of a pure number."""


@dataclass(frozen=True)
class In:
    """Mark of a float field: unit and bounds in a case file; the field itself is in SI.

    Without a unit the field is a pure number.
    """

    unit: str = ""
    above: float = -inf
    at_least: float = -inf
    below: float = inf
    at_most: float = inf

    def __get_pydantic_core_schema__(
        self, source: type[float], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Schema by which pydantic reads the field: text with a unit, or a number, into SI within
        the bounds.
        """
        from pydantic_core import PydanticCustomError, core_schema

        def read(value: object) -> float:
            try:
                return self.read(value)
            except InputError as error:
                limit = {"limit": error.limit}
                raise PydanticCustomError("limit", "must be {limit}", limit) from None

        return _nullable(source, core_schema.no_info_plain_validator_function(read))

    def read(self, value: object) -> float:
        """Value of a case file in SI, within the bounds.

        Parameters
        ----------
        value : object   text with a unit; a number where the field has no unit

        Raises
        ------
        InputError
            If it is no finite number with a unit of this dimension, or out of bounds; without the
            name of the field.
        """
        number = self._number(value)
        if not self.holds(number):
            raise InputError("", str(value), self.limit)
        return number

    def require(self, field: str, value: object) -> None:
        """Refuse a value that is no number, or out of bounds.

        Parameters
        ----------
        field : str      dotted name, for the message
        value : object   SI

        Raises
        ------
        InputError
            Naming the field, the value in the unit of the field, and the bounds; NaN included.
        """
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError(field, _text(value), "a number in SI")
        if not self.holds(value):
            shown = units.shown(value, self.unit) if self.unit and isfinite(value) else value
            raise InputError(field, shown, self.limit)

    def holds(self, value: float) -> bool:
        """Whether a value in SI is finite and within the bounds."""
        low, high, least, most = self._bounds
        return isfinite(value) and low < value < high and least <= value <= most

    def holds_each(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether each value (...) in SI is finite and within the bounds."""
        low, high, least, most = self._bounds
        return (
            (abs(values) < inf)
            & (low < values)
            & (values < high)
            & (least <= values)
            & (values <= most)
        )

    @property
    def limit(self) -> str:
        """The bounds in words, such as ``> 0 and <= 1e+04 mm``."""
        shown = [f"> {self.above:g}"] if self.above > -inf else []
        shown += [f">= {self.at_least:g}"] if self.at_least > -inf else []
        shown += [f"< {self.below:g}"] if self.below < inf else []
        shown += [f"<= {self.at_most:g}"] if self.at_most < inf else []
        return f"{' and '.join(shown) or 'finite'} {self.unit}".rstrip()

    def _number(self, value: object) -> float:
        """Number in SI from text with a unit, or from a pure number where the field has no unit;
        InputError otherwise.
        """
        if self.unit:
            return units.parse(value, self.unit, "")
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise InputError("", str(value), PURE)
        number = float(value) if abs(value) < 1e308 else inf
        if not isfinite(number):
            raise InputError("", value, "finite")
        return number

    @property
    def _bounds(self) -> tuple[float, float, float, float]:
        """Above, below, least and greatest in SI."""
        return _bounds_in_si(self)


def _nullable(source: object, schema: CoreSchema) -> CoreSchema:
    """A schema that lets None pass where the field may be left out."""
    from pydantic_core import core_schema

    return core_schema.nullable_schema(schema) if NoneType in get_args(source) else schema


@dataclass(frozen=True)
class Ratio(In):
    """Mark of a pure number, which a case file may state as whole numbers, such as ``"3:2"``."""

    def _number(self, value: object) -> float:
        match = _RATIO.fullmatch(value) if isinstance(value, str) else None
        return super()._number(value) if match is None else int(match[1]) / int(match[2])


_RATIO = re.compile(r"([1-9][0-9]{0,5}):([1-9][0-9]{0,5})", re.ASCII)


@cache
def _bounds_in_si(quantity: In) -> tuple[float, float, float, float]:
    """Bounds of a quantity in SI: above, below, least, greatest; infinite where there is none."""

    def si(bound: float) -> float:
        if not isfinite(bound) or bound == 0.0 or not quantity.unit:
            return bound
        return units.parse(f"{bound!r} {quantity.unit}", quantity.unit, "")

    return si(quantity.above), si(quantity.below), si(quantity.at_least), si(quantity.at_most)


@dataclass(frozen=True)
class Count:
    """Mark of an int field: a whole number within bounds."""

    unit: ClassVar[str] = ""
    at_least: int
    at_most: int

    def __get_pydantic_core_schema__(
        self, source: type[int], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        number = core_schema.int_schema(ge=self.at_least, le=self.at_most, strict=True)
        return _nullable(source, number)

    def read(self, value: object) -> int:
        """Whole number of a case file within the bounds, as `In.read`; InputError, without the name
        of the field, for any other value.
        """
        if isinstance(value, bool) or not isinstance(value, int):
            raise InputError("", str(value), "a whole number")
        self.require("", value)
        return value

    def require(self, field: str, value: object) -> None:
        """Refuse a value that is no whole number, or out of bounds, by InputError with the name
        `field`.
        """
        if isinstance(value, bool) or not isinstance(value, int):
            raise InputError(field, _text(value), "a whole number")
        if not self.at_least <= value <= self.at_most:
            raise InputError(field, value, f">= {self.at_least} and <= {self.at_most}")


@dataclass(frozen=True)
class Characters:
    """Mark of a str field: printable text, its number of characters within bounds.

    Line ends, and the joiners and direction marks that scripts and emoji need, are allowed;
    overrides of the direction, which make a text read as another, are refused.
    """

    at_least: int
    at_most: int

    def __get_pydantic_core_schema__(
        self, source: type[str], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Schema by which pydantic reads the field: printable text of a number of characters within
        bounds.
        """
        from pydantic_core import PydanticCustomError, core_schema

        def printable(text: str) -> str:
            if not _is_printable(text):
                raise PydanticCustomError("limit", "must be {limit}", {"limit": "printable text"})
            return text

        text = core_schema.str_schema(
            min_length=self.at_least, max_length=self.at_most, strict=True
        )
        return _nullable(source, core_schema.no_info_after_validator_function(printable, text))

    def require(self, field: str, value: object) -> None:
        """Refuse a value that is no text, too short, too long or not printable, by InputError with
        the name `field`.
        """
        if not isinstance(value, str):
            raise InputError(field, _text(value), "text")
        if not self.at_least <= len(value) <= self.at_most:
            limit = f">= {self.at_least} and <= {self.at_most} characters"
            raise InputError(field, f"{len(value)} characters", limit)
        if not _is_printable(value):
            raise InputError(field, repr(value), "printable text")


def _is_printable(text: str) -> bool:
    return all(map(is_printed, text))


@dataclass(frozen=True)
class OneOf:
    """Mark of a str field: the words that it may hold."""

    words: tuple[str, ...]

    def require(self, field: str, value: object) -> None:
        """Refuse a value that is not among the words."""
        if value not in self.words:
            raise InputError(field, _text(value), " or ".join(f'"{word}"' for word in self.words))


def _text(value: object) -> str:
    return "missing" if value is None else str(value)


class _Words:
    """Base of the marks that describe a field and rule none of its values."""

    def __get_pydantic_core_schema__(
        self, source: type[object], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return handler(source)


@dataclass(frozen=True)
class Known(_Words):
    """Mark of a field: where its value is found, and an example.

    Parameters
    ----------
    source : str       drawing, data sheet, measurement or choice
    example : object   value as a case file has it, a list as a tuple; None: the default
    """

    source: str
    example: Any = None


@dataclass(frozen=True)
class Used(_Words):
    """Mark of a field that holds a table: the stages of the calculation that use it."""

    stages: str


@dataclass(frozen=True)
class Meaning(_Words):
    """Mark shared by fields of one type: their meaning; a single field states its own below it."""

    text: str


def describes(mark: object) -> bool:
    """Whether a mark only describes a field, without a rule on its value."""
    return isinstance(mark, _Words)


@dataclass(frozen=True)
class Resolved:
    """Key of a table without a field, such as ``card``, replaced on reading by what it names.

    A number has the quantity, and in `follows` the dotted key of the value that follows from it.
    """

    accepted: str
    meaning: str
    known: Known
    quantity: In | None = None
    follows: str = ""


def card_of(meaning: str, file: str, example: str) -> Mapping[str, Resolved]:
    """Key ``card`` of a table, the name of a card that completes it."""
    source = f"pipeline/case/cards/{file}, or cards.toml beside the case"
    return {"card": Resolved("name of a card", meaning, Known(source, example))}


class Part:
    """Base of the frozen dataclasses that describe a part of the machine, values in SI.

    A part is a table of a case file and a value of the physics at once: its annotations (`In`,
    `Count`, `Characters`) give unit and bounds of both. `table` names it in messages; the fields
    of `labels` are set by the reader and stand in no table, the keys of `resolved` stand in the
    table and are no field. `defaults` has, in words, what a field without a value means; any other
    field that is None is a datum that the part lacks. The docstring below a field is the meaning of
    its key, `Known` its source and example.

    Raises
    ------
    InputError
        On making, for the first value out of its bounds; NaN included.
    """

    table: ClassVar[str] = ""
    labels: ClassVar[tuple[str, ...]] = ()
    resolved: ClassVar[Mapping[str, Resolved]] = {}
    defaults: ClassVar[Mapping[str, str]] = {}

    @property
    def derived(self) -> tuple[str, ...]:
        """Names of fields derived from others, which a case leaves out."""
        return ()

    def with_derived(self) -> Self:
        """Copy with the derived fields computed."""
        return self

    def with_values(self, values: Mapping[str, float], table: str = "") -> Self:
        """Copy with new values by their case-file keys; keys of other parts are ignored.

        Parameters
        ----------
        values : mapping   SI, by dotted key
        table : str        key of the part, where it is one of another; "": its own
        """
        known = {f"{table or self.table}.{each.name}": each.name for each in fields(self)}  # type: ignore[arg-type]
        own = {name: getattr(self, name) for name in known.values()}
        changed = {
            name: own[name].with_values(values, key)
            if isinstance(own[name], Part)
            else values.get(key, own[name])
            for key, name in known.items()
        }
        return replace(self, **changed)  # type: ignore[type-var]

    def of_many(self, values: Mapping[str, object]) -> Self:
        """Copy of a part for m designs at once, some of its fields replaced by arrays (m, 1), SI.

        The arrays are not compared with their bounds: a screening refuses designs before.

        Parameters
        ----------
        values : mapping   array by name of the field; further names are ignored
        """
        copy = object.__new__(type(self))
        for each in fields(self):  # type: ignore[arg-type]
            object.__setattr__(copy, each.name, values.get(each.name, getattr(self, each.name)))
        return copy

    @property
    def lacking(self) -> tuple[str, ...]:
        """Names of the fields without a value; `defaults` lists those whose default counts."""
        return tuple(
            name
            for name, rule in _rules_of(type(self)).items()
            if rule.optional and getattr(self, name) is None and name not in self.defaults
        )

    def __post_init__(self) -> None:
        """Refuse values out of the bounds of their fields; see the class."""
        for name, rule in _rules_of(type(self)).items():
            value = getattr(self, name)
            if value is not None or not rule.optional:
                rule.mark.require(f"{self.table}.{name}".lstrip("."), value)


class _Rule(NamedTuple):
    """Unit and bounds of a field, and whether it may be None."""

    mark: In | Count | Characters | OneOf
    optional: bool = False


_RULES: dict[type[Part], Mapping[str, _Rule]] = {}  # read once


_HINTS: dict[type, Mapping[str, Any]] = {}  # evaluated once


def hints_of(part: type[Part]) -> Mapping[str, Any]:
    """Type annotations of a part and its bases by field name, marks included."""
    hints: dict[str, Any] = {}
    for kind in reversed(part.__mro__):
        if kind not in _HINTS:
            _HINTS[kind] = get_annotations(kind, eval_str=True)
        hints |= _HINTS[kind]
    return hints


def _rules_of(part: type[Part]) -> Mapping[str, _Rule]:
    """Rules on the values of the fields of a part by name; fields without a rule are left out."""
    if part not in _RULES:
        hints = hints_of(part)
        rules = {
            field.name: rule
            for field in fields(part)  # type: ignore[arg-type]
            if (rule := _rule_of(hints[field.name])) is not None
        }
        _RULES[part] = MappingProxyType(rules)
    return _RULES[part]


def _rule_of(hint: object) -> _Rule | None:
    """Rule on the values of a type hint: the mark within ``Annotated``, or the words of a
    ``Literal``; optional with ``| None``. None without a rule; tuples are not looked into.
    """
    if get_origin(hint) is Annotated:
        inner, *marks = get_args(hint)
        for mark in marks:
            if isinstance(mark, (In, Count, Characters)):
                return _Rule(mark, optional=NoneType in get_args(inner))
        return _rule_of(inner)
    if get_origin(hint) is Literal:
        return _Rule(OneOf(get_args(hint)))
    if get_origin(hint) in (Union, UnionType):
        for inner in get_args(hint):
            rule = _rule_of(inner)
            if rule is not None:
                return rule._replace(optional=True)
    return None


def marks_of(part: type[Part]) -> Mapping[str, In | Count]:
    """Unit and bounds of the number fields of a part by name."""
    return {
        name: rule.mark
        for name, rule in _rules_of(part).items()
        if isinstance(rule.mark, (In, Count))
    }


Length = Annotated[float, In("mm", above=0, at_most=10_000)]
Angle = Annotated[float, In("deg")]
Duration = Annotated[float, In("deg", above=0, at_most=720)]
MASS = In("g", above=0, at_most=1e6)
Mass = Annotated[float, MASS]
Pressure = Annotated[float, In("MPa", above=0, at_most=1e6)]
GasPressure = Annotated[float, In("kPa", above=0, at_most=1e5)]
Temperature = Annotated[float, In("K", above=0, at_most=5000)]
Force = Annotated[float, In("N", at_least=0, at_most=1e9)]
Share = Annotated[float, In(at_least=0, at_most=1)]
Positive = Annotated[float, In(above=0, at_most=1e6)]
Fraction = Annotated[float, In(above=0, at_most=1)]
Rate = Annotated[float, In("kN/m", above=0, at_most=1e6)]
Preload = Annotated[float, In("N", above=0, at_most=1e9)]
SignedForce = Annotated[float, In("N", at_least=-1e9, at_most=1e9)]
Torsion = Annotated[float, In("N m", at_least=-1e8, at_most=1e8)]
Cycle = Annotated[float, In("deg", above=0, at_most=7200)]
Residual = Annotated[float, In(above=0, at_most=1e-3)]
FileName = Annotated[str, Characters(1, 200)]
CrankRadius = Annotated[Length, Meaning("half of the stroke")]
RodLength = Annotated[Length, Meaning("connecting rod, centre to centre")]
TableSource = Annotated[
    Source,
    Meaning(
        'source of the values of this table; { text = "...", confirmed = false } is to be confirmed'
    ),
    Known("data sheet, standard, drawing or test report", "drawing 4711, rev. B"),
]
