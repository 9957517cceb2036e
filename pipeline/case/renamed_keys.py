"""Renamed keys of case files: old names are read as new ones."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from copy import deepcopy
from functools import cache
from importlib.resources import files

from camwright.geometry.errors import InputError
from camwright.pipeline.case.toml_text import Tables, TomlValue


@cache
def renamed_names() -> Mapping[str, Mapping[str, TomlValue]]:
    """New names by old name, by kind (``case``, ``values``, ``columns``, ...)."""
    text = files(__package__).joinpath("renamed.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def with_new_keys(tables: Tables) -> Tables:
    """Copy of the tables of a case file with old names replaced.

    Raises
    ------
    InputError
        If a table has a key under its old and its new name, or a key that is replaced.
    """
    case = deepcopy(tables)
    for old, form in _words(renamed_names()["replaced"]).items():
        table, key = _parent(case, old), old.rpartition(".")[2]
        if table is not None and key in table:
            raise InputError(old, str(table[key]), form)
    for old, new in _words(renamed_names()["case"]).items():
        table, key = _parent(case, old), old.rpartition(".")[2]
        if table is not None:
            _rename(table, key, new.rpartition(".")[2], old.removesuffix(key))
    for field, words in renamed_names()["values"].items():
        table, key = _parent(case, field), field.rpartition(".")[2]
        values = None if table is None else table.get(key)
        if isinstance(values, list):
            values[:] = [_new(each, _words(words)) for each in values]
    checks, waivers = _words(renamed_names()["checks"]), case.get("waivers")
    for waiver in waivers if isinstance(waivers, list) else ():
        if isinstance(waiver, dict) and "check" in waiver:
            waiver["check"] = _new(waiver["check"], checks)
    return case


def with_new_wire_keys(wire: TomlValue, field: str) -> Tables:
    """Table of a spring wire with old names replaced; `field` is its dotted name for messages.

    Raises
    ------
    InputError
        If it is no table, or a table has a key under its old and its new name.
    """
    if not isinstance(wire, dict):
        raise InputError(field, str(wire), "a table")
    table = dict(wire)
    for old, new in _words(renamed_names()["wires"]).items():
        _rename(table, old, new, f"{field}.")
    treatment = table.get("treatment")
    if isinstance(treatment, bool):
        table["treatment"] = "peened" if treatment else "plain"
    return table


def _rename(table: Tables, old: str, new: str, place: str) -> None:
    """Give a key of a table its new name, in place, its order kept.

    Parameters
    ----------
    table : Tables   changed; without the old name it stays as it is
    old, new : str   names of the key
    place : str      dotted name of the table with a point at its end, for messages

    Raises
    ------
    InputError
        If the table has both names.
    """
    if old not in table:
        return
    if new in table:
        raise InputError(f"{place}{old}", "a second name", f"left out beside {place}{new}")
    entries = [(new if key == old else key, value) for key, value in table.items()]
    table.clear()
    table.update(entries)


def _words(names: Mapping[str, TomlValue] | TomlValue) -> dict[str, str]:
    """Old names and their new ones, where both are words."""
    entries = names.items() if isinstance(names, Mapping) else ()
    return {old: new for old, new in entries if isinstance(new, str)}


def _new(name: TomlValue, known: Mapping[str, str]) -> TomlValue:
    return known.get(name, name) if isinstance(name, str) else name


def _parent(case: Tables, field: str) -> Tables | None:
    """The table that holds a dotted field; None where the case has none."""
    table = case
    for part in field.split(".")[:-1]:
        inner = table.get(part)
        if not isinstance(inner, dict):
            return None
        table = inner
    return table
