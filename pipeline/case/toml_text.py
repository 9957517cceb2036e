"""TOML text of a case: values with units, every default included."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from typing import TypeAlias

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import In, Part
from camwright.pipeline.base.source import Source, entry_of
from camwright.pipeline.case.section import Section, number_in, section_of

TomlValue: TypeAlias = (
    "str | int | float | bool | dt.date | dt.time | list[TomlValue] | dict[str, TomlValue]"
)
"""A value of a TOML file."""
Tables: TypeAlias = dict[str, TomlValue]
"""A table of a TOML file, or the tables of a whole file."""
_FieldValue: TypeAlias = (
    "str | int | float | bool | dt.date | Source | Section | Part | tuple[_FieldValue, ...]"
    " | Mapping[str, _FieldValue]"
)

_FILE_KEYS = ("file", "torque", "motored_file", "external_force_file")


def tables_of(model: Section | Part, renamed: Mapping[str, str] | None = None) -> Tables:
    """Tables of a section or part as in a case file, values as text with unit; absent fields are
    omitted.

    Parameters
    ----------
    model : Section or Part   with its values, SI
    renamed : mapping         file names in place of those stated; None: as they are
    """
    section = section_of(type(model)) if isinstance(model, Part) else type(model)
    tables: Tables = {}
    left_out = model.derived if isinstance(model, Part) else ()
    for name, field in section.model_fields.items():
        key, value = field.alias or name, getattr(model, name)
        if value is None or value in ((), {}) or name in left_out:
            continue
        if renamed is not None and key in _FILE_KEYS and isinstance(value, str):
            value = renamed[value]
        number = number_in(field)
        unit = number.unit if isinstance(number, In) else ""
        tables[key] = _written(value, unit, renamed)
    return tables


def table_in(tables: Tables, name: str) -> Tables:
    """Table of a name within tables, to be changed in place.

    Raises
    ------
    InputError
        If there is none of this name.
    """
    table = tables.get(name)
    if not isinstance(table, dict):
        raise InputError(name, "missing" if table is None else str(table), "a table")
    return table


def _written(value: _FieldValue, unit: str, renamed: Mapping[str, str] | None) -> TomlValue:
    """Value of a field as in a case file: with its unit, a material by its name, a part as a table.

    Parameters
    ----------
    value : object      of the field, SI
    unit : str          in which a number is written; "": without
    renamed : mapping   file names in place of those stated; None: as they are
    """
    if isinstance(value, Material):
        return value.name
    if isinstance(value, Source):
        stated: TomlValue = entry_of(value)
        return stated
    if isinstance(value, (Section, Part)):
        return tables_of(value, renamed)
    if isinstance(value, Mapping):
        return {
            key: tables_of(entry, renamed)
            if isinstance(entry, Part)
            else _written(entry, unit, renamed)
            for key, entry in value.items()
        }
    if isinstance(value, tuple):
        return [_written(entry, unit, renamed) for entry in value]
    return units.format(value, unit) if unit and isinstance(value, float) else value
