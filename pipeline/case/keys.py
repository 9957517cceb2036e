"""Every key of a case: unit, range and default of its field, meaning and example of `keys.toml`."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import UnionType
from typing import Annotated, Literal, NamedTuple, Union, get_args, get_origin

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Count, In, Part
from camwright.pipeline.base.source import NO_SOURCE, Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import LIMITS, Limit
from camwright.pipeline.case.section import Section, section_of
from camwright.pipeline.case.toml_text import TomlValue

NAME = "NAME"
"""Stands in a path for a name that the case chooses: ``materials.NAME.E``."""
REQUIRED = "required"
TABLE = "table"
"""What a key that is a table accepts."""
MATERIAL = "name of a material"
SOURCE = "text, or `{ text, confirmed }`"
"""What the key of a material accepts."""
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


class TableKeys(NamedTuple):
    """Keys of a table by its dotted path; its header as in a case file, and its kind."""

    path: str
    header: str
    section: type[Section]


@dataclass(frozen=True)
class Key:
    """A key of the case file, or one of its tables.

    Parameters
    ----------
    path : str        dotted, with ``NAME`` for a name that the case chooses
    header : str      of its table, such as ``[cam]``
    accepted : str    unit and bounds, words, or kind of value; of a table `TABLE`
    default : str     value or meaning of its absence; "required", or "": a datum that is missing
    meaning : str     what it states, in the terms of the field
    source : str      where such a value comes from
    example : object  value as a case file has it
    used : str        stages that use its table
    """

    path: str
    header: str
    accepted: str
    default: str
    meaning: str
    source: str
    example: TomlValue
    used: str

    @property
    def name(self) -> str:
        """Last word of the path."""
        return self.path.rpartition(".")[2]

    @property
    def needed(self) -> bool:
        """Whether its table is not complete without it."""
        return self.default in ("", REQUIRED) and self.name != "source"


@cache
def case_keys() -> tuple[Key, ...]:
    """Every key of a case file in the order of its tables, each table before its keys.

    Raises
    ------
    KeyError
        If a key has no text in `keys.toml`.
    """
    return tuple(key for table in sections(Case, "") for key in _keys_of(table))


def keys_at(path: str) -> tuple[Key, ...]:
    """Keys at a dotted path of a case, one for each kind of its table that has it; () if none.

    Parameters
    ----------
    path : str   ``materials.steel.E`` and ``load_case[0].speed`` are read as
                 ``materials.NAME.E`` and ``load_case.speed``
    """
    words = re.sub(r"\[\d*\]", "", path).split(".")
    if words[0] == "materials" and len(words) > 1:
        words[1] = NAME
    return tuple(key for key in case_keys() if key.path == ".".join(words))


def keys_in(table: str) -> tuple[Key, ...]:
    """Keys of a table by its path, each once, tables within it left out."""
    within = {
        key.path: key
        for key in case_keys()
        if key.path.rpartition(".")[0] == table and key.accepted != TABLE
    }
    return tuple(within.values())


def _keys_of(table: TableKeys) -> Iterator[Key]:
    path, header, section = table
    about = _text(path, TABLE)
    used = str(about["used"])
    if path:
        source = str(about.get("source", ""))
        yield Key(path, header, TABLE, "", str(about["meaning"]), source,
                  about.get("example", {}), used)  # fmt: skip
    for name, field in section.model_fields.items():
        if not any(nested(field)):
            yield _key(table, field.alias or name, accepted(field), of_field(section, name), used)
    for resolved, words in _RESOLVED.items():
        parent, _, name = resolved.rpartition(".")
        if parent == path:
            yield _key(table, name, words, "none", used)


def _key(table: TableKeys, name: str, words: str, default: str, used: str) -> Key:
    path = f"{table.path}.{name}".lstrip(".")
    if table.path == "limits" and name in LIMITS:
        row = LIMITS[name]
        if isinstance(row, Limit):
            value = written(row.default, row.quantity.unit)
            return Key(path, table.header, words, default, row.title, str(row.source), value, used)
        return Key(path, table.header, words, "", row.title, row.found, row.example, used)
    text = _text(table.path, name)
    field = table.section.model_fields.get(name)
    example: TomlValue
    if name == "kind" and " or " not in words:  # one of several tables, told apart by it
        example = words.strip("`")
    else:
        example = text["example"] if "example" in text else _default_value(field)
    return Key(path, table.header, words, default, str(text["meaning"]), str(text["source"]),
               example, used)  # fmt: skip


@cache
def texts() -> Mapping[str, Mapping[str, Mapping[str, TomlValue]]]:
    """Texts of `keys.toml` by table and key."""
    content = files(__package__).joinpath("keys.toml").read_text(encoding="utf-8")
    return tomllib.loads(content)


def _text(path: str, name: str) -> Mapping[str, TomlValue]:
    known = texts()
    table = known[path]
    same = known[_SAME_TEXTS.get(path, path)]
    return table.get(name) or same.get(name) or known["*"][name]


def sections(section: type[Section], path: str) -> Iterator[TableKeys]:
    """A section and those within it, by their headers in a case file."""
    if not path:
        yield TableKeys("", "top of the file", section)
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
            yield TableKeys(key, header + mark, inner)
            yield from sections(inner, key)


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
    for mark in _marks_of(field):
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


def _marks_of(field: FieldInfo) -> list[object]:
    return [*field.metadata, *_marks(field.annotation)]


def _marks(hint: object) -> Iterator[object]:
    yield from getattr(hint, "__metadata__", ())
    for each in get_args(hint):
        yield from _marks(each)


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
    return next((mark.unit for mark in _marks_of(field) if isinstance(mark, In)), None)


def written(value: float, unit: str) -> TomlValue:
    """A value, SI, as a case file has it: text with the unit, or a number without."""
    return shown(value, unit, DIGITS) if unit else float(f"{value:.{DIGITS}g}")
