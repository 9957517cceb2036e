"""Registry of the keys of a case: unit, range, default, meaning and example of each field."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from types import MappingProxyType, UnionType
from typing import Annotated, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from camwright.pipeline.base.field_texts import texts_below
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Count, In, Known, Meaning, Part, Resolved, Used
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.section import (
    Section,
    number_in,
    section_of,
    words_at,
    written_as,
)
from camwright.pipeline.case.toml_text import TomlValue

NAME = "NAME"
"""Stands in a path for a name that the case chooses: ``materials.NAME.E``."""
REQUIRED = "required"
MATERIAL = "name of a material"
SOURCE = "text, or `{ text, confirmed }`"
"""What the key of a material, and that of a source, accepts."""
DIGITS = 6
"""Digits of a default."""
Words = TypeVar("Words", Known, Meaning, Used)


@dataclass(frozen=True)
class Key:
    """A key of the case file, or one of its tables.

    Parameters
    ----------
    path : str        dotted, with ``NAME`` for a name that the case chooses
    header : str      of its table, such as ``[cam]``
    section : type    section that has its field
    field : str       name of the field
    is_table : bool   whether it is a table, with keys of its own
    instead : object  example in place of its own; None: its own
    """

    path: str
    header: str
    section: type[Section]
    field: str
    is_table: bool = False
    instead: TomlValue | None = None

    @property
    def name(self) -> str:
        """Last word of the path."""
        return self.path.rpartition(".")[2]

    @property
    def table(self) -> str:
        """Path of its table; "": the top of the file."""
        return self.path.rpartition(".")[0]

    @property
    def needed(self) -> bool:
        """Whether its table is not complete without it."""
        return self.default in ("", REQUIRED) and self.name != "source"

    @property
    def is_field(self) -> bool:
        """Whether a case has it as a field; else the reader replaces it by what it names."""
        return self.field not in self.section.resolved

    @cached_property
    def mark(self) -> In | Count | None:
        """Unit and bounds of its number; None: it holds none."""
        return number_in(self._info) if self.is_field and not self.is_table else None

    @cached_property
    def accepted(self) -> str:
        """Unit and bounds, words, or kind of value; of a table ""."""
        if self.is_table:
            return ""
        return accepted(self._info) if self.is_field else self._resolved.accepted

    @cached_property
    def default(self) -> str:
        """Value or meaning of its absence; "required", or "": a datum that is missing."""
        if self.is_table:
            return ""
        return of_field(self.section, self.field) if self.is_field else "none"

    @cached_property
    def meaning(self) -> str:
        """What it states, in the terms of the field: the docstring below its field.

        Raises
        ------
        KeyError
            If no kind of its table describes it.
        """
        if not self.is_field:
            return self._resolved.meaning
        for each in self._alike:
            text = texts_below(written_as(each.section)).get(each.field)
            if text is not None:
                return text
        return self._stated(Meaning).text

    @property
    def source(self) -> str:
        """Where such a value comes from; "" of a table that is not stated as a value."""
        return self._known.source

    @property
    def example(self) -> TomlValue:
        """Value as a case file has it: that beside its field, else the default; of a table {}."""
        return self._example if self.instead is None else self.instead

    @cached_property
    def _example(self) -> TomlValue:
        if self.name == "kind" and " or " not in self.accepted:
            return self.accepted.strip("`")  # one of several tables, told apart by it
        if self._known.example is not None:
            return _as_toml(self._known.example)
        return {} if self.is_table else _default_value(self._info)

    @cached_property
    def used(self) -> str:
        """Stages that use its table."""
        if self.is_table:
            return self._stated(Used).stages
        return registry()[self.table][0].used if self.table else "all stages"

    @property
    def _info(self) -> FieldInfo:
        return self.section.model_fields[self.field]

    @property
    def _resolved(self) -> Resolved:
        return self.section.resolved[self.field]

    @property
    def _alike(self) -> tuple[Key, ...]:
        """Keys of its path: one that several kinds of a table have is described in one of them."""
        return registry()[self.path]

    @property
    def _known(self) -> Known:
        if not self.is_field:
            return self._resolved.known
        return self._stated(Known, Known("") if self.is_table else None)

    def _stated(self, kind: type[Words], absent: Words | None = None) -> Words:
        """The first mark of a kind on the fields of its path."""
        marks = (mark for each in self._alike for mark in words_at(each.section, each.field))
        words = next((mark for mark in marks if isinstance(mark, kind)), absent)
        if words is None:
            raise KeyError(f"{self.path} has no {kind.__name__}")
        return words


def _as_toml(example: TomlValue | tuple[TomlValue, ...]) -> TomlValue:
    return list(example) if isinstance(example, tuple) else example


@cache
def case_keys() -> tuple[Key, ...]:
    """Every key of a case file in the order of its tables, each table before its keys."""
    return tuple(key for table in case_tables() for key in _keys_of(table))


@cache
def case_tables() -> tuple[TableKeys, ...]:
    """Every table of a case file in its order, the top of the file first."""
    return tuple(sections(Case))


@cache
def registry() -> Mapping[str, tuple[Key, ...]]:
    """Keys of a case file by path, one for each kind of its table that has it."""
    by_path: dict[str, tuple[Key, ...]] = {}
    for key in case_keys():
        by_path[key.path] = (*by_path.get(key.path, ()), key)
    return MappingProxyType(by_path)


def keys_at(path: str) -> tuple[Key, ...]:
    """Keys at a dotted path of a case, one for each kind of its table that has it; () if none.

    Parameters
    ----------
    path : str   ``materials.steel.E`` and ``load_case[0].speed`` are read as
                 ``materials.NAME.E`` and ``load_case.speed``
    """
    names = re.sub(r"\[\d*\]", "", path).split(".")
    if names[0] == "materials" and len(names) > 1:
        names[1] = NAME
    return registry().get(".".join(names), ())


def names_in(table: str) -> tuple[str, ...]:
    """Names of the fields of a table by its path, tables within it included; () if it is none."""
    names = (
        field.alias or name
        for each in case_tables()
        if each.path == table
        for name, field in each.section.model_fields.items()
    )
    return tuple(dict.fromkeys(names))


def keys_in(table: str) -> tuple[Key, ...]:
    """Keys of a table by its path, each once, tables within it left out."""
    within = {key.path: key for key in case_keys() if key.table == table and not key.is_table}
    return tuple(within.values())


class TableKeys(NamedTuple):
    """A table of a file by its dotted path: its header and section, and the field that holds it."""

    path: str
    header: str
    section: type[Section]
    holder: type[Section]
    field: str


def _keys_of(table: TableKeys) -> Iterator[Key]:
    path, header, section, holder, held_as = table
    if path:
        yield Key(path, header, holder, held_as, is_table=True)
    for name, field in section.model_fields.items():
        if not any(nested(field)):
            yield Key(f"{path}.{field.alias or name}".lstrip("."), header, section, name)
    for name in section.resolved:
        yield Key(f"{path}.{name}".lstrip("."), header, section, name)


def sections(section: type[Section]) -> Iterator[TableKeys]:
    """A section and those within it, by their headers in its file."""
    yield TableKeys("", "top of the file", section, section, "")
    yield from _within(section, "")


def _within(section: type[Section], path: str) -> Iterator[TableKeys]:
    for name, field in section.model_fields.items():
        for kind, inner in nested(field):
            key = f"{path}.{field.alias or name}".lstrip(".")
            key += f".{NAME}" if kind == "names" else ""
            header = f"[[{key}]]" if kind == "rows" else f"[{key}]"
            word = inner.model_fields.get("kind")
            marks = (
                get_args(word.annotation) if word and get_origin(word.annotation) is Literal else ()
            )
            mark = f' kind = "{marks[0]}"' if len(marks) == 1 else ""
            yield TableKeys(key, header + mark, inner, section, name)
            yield from _within(inner, key)


def nested(field: FieldInfo) -> Iterator[tuple[str, type[Section]]]:
    """Sections that a field holds: as a table, as rows, or by names; none of a value."""
    yield from _nested(field.annotation, "table")


def _nested(hint: object, kind: str) -> Iterator[tuple[str, type[Section]]]:
    origin = get_origin(hint)
    if origin is Annotated:
        yield from _nested(get_args(hint)[0], kind)
    elif origin in (Union, UnionType):
        for each in get_args(hint):
            yield from _nested(each, kind)
    elif origin is tuple:
        yield from _nested(get_args(hint)[0], "rows")
    elif origin is dict:
        yield from _nested(get_args(hint)[1], "names")
    elif isinstance(hint, type) and issubclass(hint, Section):
        yield kind, hint
    elif hint is Material and kind != "names":
        return  # of a part: written as its name
    elif isinstance(hint, type) and issubclass(hint, Part):
        yield kind, section_of(hint)


def accepted(field: FieldInfo) -> str:
    """What a key may hold: unit and bounds, words, or kind of value."""
    mark = number_in(field)
    if isinstance(mark, In):
        return mark.limit.replace("finite ", "any, ").replace(" and ", ", ")
    if isinstance(mark, Count):
        return f"whole number, {mark.at_least} to {mark.at_most}"
    words = [
        word
        for hint in _leaves(field.annotation)
        if get_origin(hint) is Literal
        for word in get_args(hint)
    ]
    if words:
        return " or ".join(f"`{word}`" for word in words)
    names = {
        str: "text", Source: SOURCE, bool: "`true` or `false`", float: "number",
        int: "whole number", Material: MATERIAL,
    }  # fmt: skip
    leaves = [
        names.get(hint, getattr(hint, "__name__", ""))
        for hint in _leaves(field.annotation)
        if isinstance(hint, type)
    ]
    if SOURCE in leaves:
        return SOURCE  # of a table of sources: the name of each is a text, too
    listed = "list of " if get_origin(field.annotation) in (tuple, list) else ""
    return listed + " or ".join(
        dict.fromkeys(word for word in leaves if word and word != "NoneType")
    )


def _leaves(hint: object) -> Iterator[object]:
    inner = get_args(hint)
    if get_origin(hint) is Literal or not inner:
        yield hint
    elif get_origin(hint) is Annotated:
        yield from _leaves(inner[0])
    else:
        for each in inner:
            yield from _leaves(each)


def of_field(section: type[Section], name: str) -> str:
    """Default of a field, or the meaning of its absence; "": a datum that is missing."""
    return default(section.model_fields[name]) or section.defaults.get(name, "")


def default(field: FieldInfo) -> str:
    """Default of a field with its unit; "" where it has none."""
    if field.is_required():
        return REQUIRED
    value = field.default
    if value is None or value is PydanticUndefined or value in ("", NO_SOURCE):
        return ""
    unit = _unit_of(field)
    if isinstance(value, float):
        return shown(value, unit or "", DIGITS)
    if isinstance(value, tuple):
        if unit is None:
            return f"`{list(value)}`".replace("'", '"')
        return "[" + ", ".join(f'"{shown(each, unit, DIGITS)}"' for each in value) + "]"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f"`{value}`"


def _default_value(field: FieldInfo | None) -> TomlValue:
    """Default of a field as a case file has it."""
    value = None if field is None else field.default
    if field is None or value is None or value is PydanticUndefined:
        raise KeyError("a key without a default has an example beside its field")
    unit = _unit_of(field) or ""
    if isinstance(value, float):
        return written(value, unit)
    if isinstance(value, tuple):
        return [written(each, unit) if isinstance(each, float) else each for each in value]
    words: TomlValue = value
    return words


def _unit_of(field: FieldInfo) -> str | None:
    mark = number_in(field)
    return mark.unit if isinstance(mark, In) else None


def written(value: float, unit: str) -> TomlValue:
    """A value, SI, as a case file has it: text with the unit, or a number without."""
    return shown(value, unit, DIGITS) if unit else float(f"{value:.{DIGITS}g}")
