"""Registry of the keys of a case: unit, range, default, meaning and example of each field."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from types import MappingProxyType, UnionType
from typing import Annotated, Literal, NamedTuple, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Count, In, Part
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import LIMITS, Limit
from camwright.pipeline.case.section import Section, number_in, section_of
from camwright.pipeline.case.toml_text import TomlValue

NAME = "NAME"
"""Stands in a path for a name that the case chooses: ``materials.NAME.E``."""
REQUIRED = "required"
MATERIAL = "name of a material"
SOURCE = "text, or `{ text, confirmed }`"
"""What the key of a material, and that of a source, accepts."""
DIGITS = 6
"""Digits of a default."""
_SAME_TEXTS = {
    "guides.b": "guides.a",
    **{f"{part}.{table}": f"cam.{table}"
       for part in ("roller", "follower.face") for table in ("end", "crown")},
}  # fmt: skip
_RESOLVED: Mapping[str, str] = {
    "added": "list of tables",
    "spring.catalogue": "`shipped`, or a file name",
    **dict.fromkeys(
        ("spring.design.card", "spring.gas.card", "roller.bearing.card", "guides.a.card",
         "guides.b.card", "lubricant.card", "materials.NAME.card"), "name of a card",
    ),
}  # fmt: skip
"""Keys that the reader replaces by what they name: none is a field of `Case`."""


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
        return self.field in self.section.model_fields

    @cached_property
    def mark(self) -> In | Count | None:
        """Unit and bounds of its number; None: it holds none."""
        if self.is_table or not self.is_field:
            return None
        return number_in(self.section.model_fields[self.field])

    @cached_property
    def accepted(self) -> str:
        """Unit and bounds, words, or kind of value; of a table ""."""
        if self.is_table:
            return ""
        if not self.is_field:
            return _RESOLVED[self.path]
        return accepted(self.section.model_fields[self.field])

    @cached_property
    def default(self) -> str:
        """Value or meaning of its absence; "required", or "": a datum that is missing."""
        if self.is_table:
            return ""
        return of_field(self.section, self.field) if self.is_field else "none"

    @cached_property
    def meaning(self) -> str:
        """What it states, in the terms of the field."""
        return LIMITS[self.name].title if self._is_limit else str(self._text["meaning"])

    @cached_property
    def source(self) -> str:
        """Where such a value comes from; of a table ""."""
        if not self._is_limit:
            return str(self._text.get("source", ""))
        row = LIMITS[self.name]
        return str(row.source) if isinstance(row, Limit) else row.found

    @property
    def example(self) -> TomlValue:
        """Value as a case file has it, without one of its own its default; of a table {}."""
        return self._example if self.instead is None else self.instead

    @cached_property
    def _example(self) -> TomlValue:
        if self._is_limit:
            row = LIMITS[self.name]
            return (
                written(row.default, row.quantity.unit) if isinstance(row, Limit) else row.example
            )
        if self.name == "kind" and " or " not in self.accepted:
            return self.accepted.strip("`")  # one of several tables, told apart by it
        if self.is_table or "example" in self._text:
            return self._text.get("example", {})
        return _default_value(self.section.model_fields[self.field])

    @cached_property
    def used(self) -> str:
        """Stages that use its table."""
        return str(_text(self.path if self.is_table else self.table, "table")["used"])

    @property
    def _is_limit(self) -> bool:
        return self.table == "limits" and self.name in LIMITS

    @property
    def _text(self) -> Mapping[str, TomlValue]:
        if self.is_table:
            return _text(self.path, "table")
        return _text(self.table, self.name)


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
    return registry().get(".".join(_words(path)), ())


def _words(path: str) -> list[str]:
    words = re.sub(r"\[\d*\]", "", path).split(".")
    if words[0] == "materials" and len(words) > 1:
        words[1] = NAME
    return words


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


@cache
def _texts() -> Mapping[str, Mapping[str, Mapping[str, TomlValue]]]:
    """Texts of `keys.toml` by table and key."""
    content = files(__package__).joinpath("keys.toml").read_text(encoding="utf-8")
    return tomllib.loads(content)


def _text(path: str, name: str) -> Mapping[str, TomlValue]:
    known = _texts()
    table = known[path]
    same = known[_SAME_TEXTS.get(path, path)]
    return table.get(name) or same.get(name) or known["*"][name]


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
    for resolved in _RESOLVED:
        if resolved.rpartition(".")[0] == path:
            yield Key(resolved, header, section, resolved.rpartition(".")[2])


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
        raise KeyError("a key without a default has its example in keys.toml")
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
