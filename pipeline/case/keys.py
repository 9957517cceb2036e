"""Registry of case-file keys: unit, range, default, meaning and example."""

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
    """Key of the case file, a value or a table.

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
        """Path of the table that holds the key; "": top of the file."""
        return self.path.rpartition(".")[0]

    @property
    def needed(self) -> bool:
        """Whether its table is incomplete without it."""
        return self.default in ("", REQUIRED) and self.name != "source"

    @property
    def is_field(self) -> bool:
        """Whether the case has it as a field; else the reader replaces it, as ``card``."""
        return self.field not in self.section.resolved

    @cached_property
    def mark(self) -> In | Count | None:
        """Unit and bounds of its number; None for other values."""
        if not self.is_field:
            return self._resolved.quantity
        return None if self.is_table else number_in(self._info)

    @property
    def follows(self) -> str:
        """Key that follows from it, which a case with it leaves out; "": none."""
        return "" if self.is_field else self._resolved.follows

    @cached_property
    def accepted(self) -> str:
        """Unit and bounds, words, or kind of value; of a table ""."""
        if self.is_table:
            return ""
        return accepted(self._info) if self.is_field else self._resolved.accepted

    @cached_property
    def default(self) -> str:
        """Default, or the meaning of its absence; "required", or "" for missing data."""
        if self.is_table:
            return ""
        return of_field(self.section, self.field) if self.is_field else "none"

    @cached_property
    def meaning(self) -> str:
        """Meaning in the terms of the field: the docstring below the field.

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
        """Where such a value is found; "" for a table not stated as a value."""
        return self._known.source

    @property
    def example(self) -> TomlValue:
        """Example as in a case file, else the default; {} for a table."""
        return self._example if self.instead is None else self.instead

    @cached_property
    def _example(self) -> TomlValue:
        """Example of the key as a TOML value: the word of its kind, its own example, or its
        default.
        """
        if self.name == "kind" and " or " not in self.accepted:
            return self.accepted.strip("`")  # one of several tables, told apart by it
        if self._known.example is not None:
            return _as_toml(self._known.example)
        return {} if self.is_table else _default_value(self._info)

    @cached_property
    def used(self) -> str:
        """Stages of the calculation that use its table."""
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
        """Where a value of the key is found, and its example."""
        if not self.is_field:
            return self._resolved.known
        return self._stated(Known, Known("") if self.is_table else None)

    def _stated(self, kind: type[Words], absent: Words | None = None) -> Words:
        """First mark of a kind, such as `Known`, on the fields of the path of the key.

        Parameters
        ----------
        kind : type      class of the mark
        absent : Words   returned where there is none; None: KeyError is raised
        """
        marks = (mark for each in self._alike for mark in words_at(each.section, each.field))
        words = next((mark for mark in marks if isinstance(mark, kind)), absent)
        if words is None:
            raise KeyError(f"{self.path} has no {kind.__name__}")
        return words


def _as_toml(example: TomlValue | tuple[TomlValue, ...]) -> TomlValue:
    return list(example) if isinstance(example, tuple) else example


@cache
def case_keys() -> tuple[Key, ...]:
    """All keys of a case file, each table before its keys."""
    return tuple(key for table in case_tables() for key in _keys_of(table))


@cache
def case_tables() -> tuple[TableKeys, ...]:
    """All tables of a case file in order, the top of the file first."""
    return tuple(sections(Case))


@cache
def registry() -> Mapping[str, tuple[Key, ...]]:
    """Keys of a case file by path; several of one path where a table has variants (kinds) with the
    same key.
    """
    by_path: dict[str, tuple[Key, ...]] = {}
    for key in case_keys():
        by_path[key.path] = (*by_path.get(key.path, ()), key)
    return MappingProxyType(by_path)


def keys_at(path: str) -> tuple[Key, ...]:
    """Keys at a dotted path, one for each variant of their table; () if none.

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
    """Names of the fields of the table at a path, nested tables included; () without one."""
    names = (
        field.alias or name
        for each in case_tables()
        if each.path == table
        for name, field in each.section.model_fields.items()
    )
    return tuple(dict.fromkeys(names))


def keys_in(table: str) -> tuple[Key, ...]:
    """Keys of the table at a path, each once, without nested tables."""
    within = {key.path: key for key in case_keys() if key.table == table and not key.is_table}
    return tuple(within.values())


class TableKeys(NamedTuple):
    """Table of a file: header, section class, and field that holds it."""

    path: str
    header: str
    section: type[Section]
    holder: type[Section]
    field: str


def _keys_of(table: TableKeys) -> Iterator[Key]:
    """Key of a table itself, then those of its values; tables within it are left out."""
    path, header, section, holder, held_as = table
    if path:
        yield Key(path, header, holder, held_as, is_table=True)
    for name, field in section.model_fields.items():
        if not any(nested(field)):
            yield Key(f"{path}.{field.alias or name}".lstrip("."), header, section, name)
    for name in section.resolved:
        yield Key(f"{path}.{name}".lstrip("."), header, section, name)


def sections(section: type[Section]) -> Iterator[TableKeys]:
    """Section and its nested sections, by their headers in the file."""
    yield TableKeys("", "top of the file", section, section, "")
    yield from _within(section, "")


def _within(section: type[Section], path: str) -> Iterator[TableKeys]:
    """Tables below a section of the case file, each before those within it; NAME stands for a name
    that the case chooses.

    Parameters
    ----------
    section : type   class of the section
    path : str       its dotted name
    """
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
    """Sections in a field: a table, rows of tables, or tables by name; none for a value."""
    yield from _nested(field.annotation, "table")


def _nested(hint: object, kind: str) -> Iterator[tuple[str, type[Section]]]:
    """Sections within a type hint, each with how it is written: "rows" of an array of tables,
    "names" of a table of named ones, else `kind`.
    """
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
    """Values that a key accepts, in words: unit and bounds, the words themselves, or its type."""
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
    """Types at the ends of a type hint: members of unions, entries of tuples; a Literal as one."""
    inner = get_args(hint)
    if get_origin(hint) is Literal or not inner:
        yield hint
    elif get_origin(hint) is Annotated:
        yield from _leaves(inner[0])
    else:
        for each in inner:
            yield from _leaves(each)


def of_field(section: type[Section], name: str) -> str:
    """Default of a field, or the meaning of its absence; "" for missing data."""
    return default(section.model_fields[name]) or section.defaults.get(name, "")


def default(field: FieldInfo) -> str:
    """Default of a field as text with its unit; `REQUIRED` where it has to be stated, "" without
    one.
    """
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
    """Default of a field as a TOML value, with its unit; KeyError without one."""
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
    """SI value as in a case file: text with unit, or plain number."""
    return shown(value, unit, DIGITS) if unit else float(f"{value:.{DIGITS}g}")
