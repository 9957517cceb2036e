"""A case written back as TOML: section headings, unit strings, nothing left to defaults."""

from __future__ import annotations

import datetime as dt
import json
import re
from collections.abc import Iterator, Mapping
from typing import Any, get_args

from pydantic import BaseModel

from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import In


def to_toml(case: BaseModel, renamed: Mapping[str, str]) -> str:
    """TOML text of a case; `renamed` gives included files the names they are kept under."""
    lines = ["# Camwright case, resolved: every default is written out."]
    lines += _table(case, (), renamed)
    return "\n".join(lines) + "\n"


def _table(model: BaseModel, path: tuple[str, ...], renamed: Mapping[str, str]) -> Iterator[str]:
    """Lines of one table: plain values first, as TOML wants it, then the tables in it."""
    tables: list[tuple[str, Any]] = []
    for name, field in type(model).model_fields.items():
        key, value = field.alias or name, getattr(model, name)
        if value is None or value in ((), {}):
            continue
        unit = _unit_of(field.annotation, field.metadata)
        if isinstance(value, tuple) and isinstance(value[0], (float, str)):
            yield f"{key} = [{', '.join(_value(each, unit) for each in value)}]"
        elif isinstance(value, (BaseModel, dict, tuple)):
            tables.append((key, value))
        else:
            if key in ("file", "torque", "motored_file", "reference_file"):
                value = renamed[value]
            yield f"{key} = {_value(value, unit)}"
    for key, value in tables:
        yield from _subtable(value, (*path, key), renamed)


def _subtable(value: Any, path: tuple[str, ...], renamed: Mapping[str, str]) -> Iterator[str]:
    heading = ".".join(_key(part) for part in path)
    if isinstance(value, tuple):
        for entry in value:
            yield from ("", f"# {_title(entry)}", f"[[{heading}]]")
            yield from _table(entry, path, renamed)
    elif isinstance(value, BaseModel):
        yield from ("", f"# {_title(value)}", f"[{heading}]")
        yield from _table(value, path, renamed)
    elif all(isinstance(entry, BaseModel) for entry in value.values()):
        for key, entry in value.items():
            yield from _subtable(entry, (*path, key), renamed)
    else:
        yield from ("", f"[{heading}]")
        yield from (f"{_key(key)} = {_value(entry, None)}" for key, entry in value.items())


def _title(model: BaseModel) -> str:
    return (type(model).__doc__ or "").splitlines()[0]


def _key(text: str) -> str:
    return text if re.fullmatch(r"[A-Za-z0-9_-]+", text) else json.dumps(text)


def _value(value: Any, unit: str | None) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return json.dumps(units.format(value, unit)) if unit else repr(value)
    if isinstance(value, dt.date):
        return value.isoformat()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return str(value)


def _unit_of(annotation: Any, metadata: list[Any]) -> str | None:
    """The unit a float field is read in; looks through ``X | None``."""
    for mark in metadata:
        if isinstance(mark, In):
            return mark.unit
    for inner in get_args(annotation):
        found = _unit_of(inner, list(getattr(inner, "__metadata__", ())))
        if found is not None:
            return found
    return None
