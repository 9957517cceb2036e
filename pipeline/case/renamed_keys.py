"""Keys of a case file that changed to the field's standard terms: old names are read as new."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from camwright.geometry.errors import InputError


@cache
def renamed_names() -> Mapping[str, Mapping[str, Any]]:
    """Old names by kind (``case``, ``values``, ``columns``, ...), each with its new name."""
    text = files(__package__).joinpath("renamed.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def with_new_keys(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a case file under today's names; the tables given stay as they are.

    Raises
    ------
    InputError
        If a table has a key under its old and its new name.
    """
    case = _copied(tables)
    names = renamed_names()
    for old, new in names["case"].items():
        table, key = _parent(case, old), old.rpartition(".")[2]
        if table is not None:
            _rename(table, key, new.rpartition(".")[2], old.removesuffix(key))
    for field, words in names["values"].items():
        table, key = _parent(case, field), field.rpartition(".")[2]
        if table is not None and isinstance(table.get(key), list):
            table[key] = [_new(each, words) for each in table[key]]
    waivers = case.get("waivers")
    for waiver in waivers if isinstance(waivers, list) else ():
        if isinstance(waiver, dict) and "check" in waiver:
            waiver["check"] = _new(waiver["check"], names["checks"])
    return case


def with_new_wire_keys(wire: Any, field: str) -> dict[str, Any]:
    """The table of a spring wire under today's names; `field` names it in messages.

    Raises
    ------
    InputError
        If it is no table, or a key has no such value.
    """
    if not isinstance(wire, dict):
        raise InputError(field, wire, "a table")
    table = dict(wire)
    for old, new in renamed_names()["wires"].items():
        _rename(table, old, new, f"{field}.")
    treatment = table.get("treatment")
    if isinstance(treatment, bool):
        table["treatment"] = "peened" if treatment else "plain"
    return table


def _rename(table: dict[str, Any], old: str, new: str, place: str) -> None:
    """Give a key its new name, where it stands; `place` is its table's for messages."""
    if old not in table:
        return
    if new in table:
        raise InputError(f"{place}{old}", "a second name", f"left out beside {place}{new}")
    entries = [(new if key == old else key, value) for key, value in table.items()]
    table.clear()
    table.update(entries)


def _new(name: Any, known: Mapping[str, str]) -> Any:
    return known.get(name, name) if isinstance(name, str) else name


def _copied(value: Any) -> Any:
    """Tables and arrays copied all the way down."""
    if isinstance(value, Mapping):
        return {key: _copied(entry) for key, entry in value.items()}
    return [_copied(entry) for entry in value] if isinstance(value, list) else value


def _parent(case: dict[str, Any], field: str) -> dict[str, Any] | None:
    """The table that holds a dotted field."""
    table: Any = case
    for part in field.split(".")[:-1]:
        table = table.get(part) if isinstance(table, dict) else None
    return table if isinstance(table, dict) else None
