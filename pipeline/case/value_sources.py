"""Sources of the values of a case, and its values to be confirmed.

A value has the dotted name of its key, such as ``materials.s355.yield_strength``. Its source is the
entry of ``[sources]`` under that name, else that of its limit, else the ``source`` of its table.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import get_close_matches
from fnmatch import fnmatchcase

from camwright.geometry.errors import InputError
from camwright.pipeline.base.source import NO_SOURCE, Source, source_in
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.case.toml_text import Tables, TomlValue

UNSTATED = Source("stated without a source", confirmed=False)
OF_A_CHECK = "checks."
"""Prefix of a value that the program holds: the limit that a check declares."""
_WILD = re.compile(r"[*?[]")
_WORDS = ("source", "sources", "name", "condition", "closure")
_NO_VALUES = (
    "schema_version",
    "name",
    "title",
    "notes",
    "sources",
    "confirmed",
    "scope",
    "document",
)


def values_in(entry: TomlValue, name: str = "") -> Iterator[str]:
    """Dotted names of the values of a case, or of a table of it with the dotted name `name`; tables
    that have no values, such as sources, are left out.
    """
    if isinstance(entry, dict):
        for key, inner in entry.items():
            if key not in (_WORDS if name else _NO_VALUES):
                yield from values_in(inner, f"{name}.{key}".lstrip("."))
    else:
        yield name


def values_at(tables: Tables, path: str) -> tuple[str, ...]:
    """Dotted names of the values at a path; those of a material follow its name.

    Parameters
    ----------
    tables : Tables   of the case
    path : str        dotted; its last word may have wildcards: ``cam.material.endurance_*``
    """
    *parents, last = path.split(".")
    table, name = tables, ""
    for part in parents:
        inner = table.get(part)
        name = f"{name}.{part}".lstrip(".")
        if isinstance(inner, str):
            materials = tables.get("materials")
            name = f"materials.{inner}"
            inner = materials.get(inner) if isinstance(materials, dict) else None
        if not isinstance(inner, dict):
            return ()
        table = inner
    if _WILD.search(last) is None:
        keys = [last] if last in table else []
    else:
        keys = [key for key in table if fnmatchcase(key, last)]
    return tuple(
        f"{name}.{key}" for key in keys if key not in _WORDS and not isinstance(table[key], dict)
    )


def source_of(tables: Tables, value: str) -> Source:
    """Source of a value by its dotted name: that in [sources], of its limit or of its table, the
    first stated; empty if none is.
    """
    *parents, key = value.split(".")
    table: TomlValue = tables
    for part in parents:
        table = table.get(part, {}) if isinstance(table, dict) else {}
    stated = [source_in(_entry(tables.get("sources"), value))]
    if parents == ["limits"]:
        stated += [source_in(_entry(_entry(table, "sources"), key)), LIMITS[key].source]
    stated.append(source_in(_entry(table, "source")))
    return next(filter(None, stated), NO_SOURCE)


def _entry(table: TomlValue | None, key: str) -> TomlValue:
    return table.get(key, "") if isinstance(table, dict) else ""


def require_known(tables: Tables, field: str, value: str) -> None:
    """Refuse the name of a value that the case does not state.

    Parameters
    ----------
    tables : Tables   of the case
    field : str       key under which the name stands, for the message
    value : str       dotted name

    Raises
    ------
    InputError
        With the closest name.
    """
    if not value.startswith(OF_A_CHECK) and value not in values_in(tables):
        close = get_close_matches(value, tuple(values_in(tables)), n=1)
        hint = f"; did you mean {close[0]}?" if close else ", by its dotted name"
        raise InputError(field, value, f"a value of the case{hint}")


def put_sources(case: Tables, field: str, table: TomlValue, entries: Tables) -> None:
    """Write sources of numbers into ``[sources]`` of a case, in place, where it states none.

    Parameters
    ----------
    case : Tables      changed
    field : str        dotted name of the table of the numbers
    table : table      the table; a source of a key that it lacks is left out
    entries : Tables   sources by key
    """
    stated, numbers = case.setdefault("sources", {}), set(values_in(table, field))
    if isinstance(stated, dict):
        for key, entry in entries.items():
            if f"{field}.{key}" in numbers:
                stated.setdefault(f"{field}.{key}", entry)


def forget_sources(tables: Tables, part: str) -> None:
    """Remove sources and confirmations of the values of a part that is replaced from the tables of
    a case, in place.

    Parameters
    ----------
    tables : Tables   changed
    part : str        dotted name of the part
    """

    def kept(value: TomlValue) -> bool:
        return not f"{value}.".startswith(f"{part}.")

    sources, confirmed = tables.get("sources"), tables.get("confirmed")
    if isinstance(sources, dict):
        tables["sources"] = {value: text for value, text in sources.items() if kept(value)}
    if isinstance(confirmed, list):
        tables["confirmed"] = [each for each in confirmed if kept(_entry(each, "value"))]
