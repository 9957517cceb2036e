"""Values of a case by dotted key: unit, value, text; case with other numbers.

A key is that of the case file: ``spring.rate``, ``roller.bearing.C``, ``load_case[0].speed``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields, replace
from functools import cache, lru_cache
from typing import Any, TypeVar

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError, Refused
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import Count, In, Part
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.error_text import as_written
from camwright.pipeline.case.keys import MATERIAL, NAME, Key, keys_at, names_in
from camwright.pipeline.case.section import Section, suggestion
from camwright.pipeline.follower.wound_wire import WoundWire

_STEP = re.compile(r"([A-Za-z_0-9]+)(?:\[(0|[1-9][0-9]{0,3})\])?")
Node = TypeVar("Node", Section, Part)


@lru_cache(maxsize=4096)
def steps_of(key: str) -> tuple[str | int, ...]:
    """Steps of a dotted key: ``load_case[0].speed`` is load_case, 0, speed.

    Raises
    ------
    InputError
        If it is no dotted key.
    """
    steps: list[str | int] = []
    for part in key.split("."):
        match = _STEP.fullmatch(part)
        if match is None:
            raise InputError("factor", key, "a dotted key of the case file")
        steps += [match[1]] if match[2] is None else [match[1], int(match[2])]
    return tuple(steps)


@lru_cache(maxsize=4096)
def quantity_of(key: str) -> In | Count | None:
    """Unit and bounds of the number at a key; None for other values.

    Raises
    ------
    InputError
        If no case has such a key; with the closest one.
    """
    names = [step for step in steps_of(key) if isinstance(step, str)]
    keys = _fields_at(".".join(names)) or _fields_along(key, names)
    return next((each.mark for each in keys if each.mark is not None), None)


def unit_at(key: str) -> str:
    """Unit of the number at a key; "" for a pure number or another value."""
    quantity = quantity_of(key)
    return "" if quantity is None else quantity.unit


def _fields_at(path: str) -> tuple[Key, ...]:
    return tuple(each for each in keys_at(path) if each.is_field or each.mark is not None)


def following(keys: Iterable[str]) -> list[str]:
    """Keys whose values follow from others of the case file, such as a prime radius from a start
    angle.
    """
    every = (each for key in keys for each in keys_at(key))
    return [each.follows for each in every if each.follows]


def _fields_along(key: str, names: Iterable[str]) -> tuple[Key, ...]:
    """Keys of the case file at the end of a path of names, one per variant of its table; through
    the name of a material the path goes on in its card.

    Parameters
    ----------
    key : str          dotted, for the message
    names : iterable   steps of the path

    Raises
    ------
    InputError
        If no table has such a key.
    """
    keys: tuple[Key, ...] = ()
    path = ""
    for name in names:
        if any(each.accepted == MATERIAL for each in keys):
            path = f"materials.{NAME}"
        known = names_in(path)
        if path == "materials":
            path = f"{path}.{NAME}"
        elif name in known:
            path = f"{path}.{name}".lstrip(".")
        else:
            raise InputError("factor", key, f"a key of the case file{_beside(name, path, known)}")
        keys = _fields_at(path)
    return keys


def _beside(name: str, table: str, known: Sequence[str]) -> str:
    """The key that a misspelt one may be; else that its table is none."""
    if known:
        return suggestion(name, known)
    return f": {table.rpartition('.')[2]} is no table"


def value_of(case: Case, key: str) -> Any:
    """Value at a dotted key, SI; None where the case omits it."""
    node: Any = case
    for step in steps_of(key):
        if node is None:
            return None
        if isinstance(step, int):
            node = node[step] if step < len(node) else None
        elif isinstance(node, Mapping):
            node = node.get(step)
        else:
            node = getattr(node, _attribute(node, step), None)
    return node


def text_of(case: Case, key: str, digits: int = 4) -> str:
    """Value at a key as in the case file, rounded to `digits`; "missing" without one.

    A default, and a number that has replaced that of the file, are shown in the unit of the key.
    """
    value, quantity = value_of(case, key), quantity_of(key)
    stated = case.written.value(steps_of(key))
    if value is None:
        return "missing"
    if not isinstance(value, float) or not isinstance(quantity, In):
        return str(value)
    if stated is not None and quantity.read(stated) == value:
        return as_written(stated, digits)
    return units.shown(value, quantity.unit, digits)


@contextmanager
def refused_as_written(case: Case) -> Iterator[None]:
    """Context manager: refusals of a value at a key quote it as the case file writes it.

    A number other than that of the case is stated in the unit of the key.
    """
    try:
        yield
    except InputError as error:
        raise InputError(error.field, _refused_text(case, error), error.limit) from None


def _refused_text(case: Case, error: InputError) -> Refused:
    """Refused value of an error as text: as the case file has it, else with the unit of its key."""
    try:
        quantity, value = quantity_of(error.field), value_of(case, error.field)
        if not isinstance(quantity, In):
            return error.value
        refused = error.value if isinstance(error.value, float) else quantity.read(error.value)
    except InputError:  # no key of a case, or no number
        return error.value
    text = units.shown(refused, quantity.unit)
    same = isinstance(value, float) and units.shown(value, quantity.unit) == text
    return text_of(case, error.field) if same else text


def _attribute(node: Section | Part, key: str) -> str:
    """Name of the field with a key."""
    return key if isinstance(node, Part) else _attributes(type(node)).get(key, key)


@cache
def _attributes(kind: type[Section]) -> Mapping[str, str]:
    """Names of the fields by their keys."""
    return {field.alias or name: name for name, field in kind.model_fields.items()}


def replaced(case: Case, values: Mapping[str, float]) -> Case:
    """Case with other numbers, SI, by dotted key, checked against the bounds of their fields
    alone.

    Faster than `with_values`; the sections are not compared with one another.

    Raises
    ------
    InputError
        If a number is out of the bounds of its field, or contradicts its own table.
    """
    tables: dict[tuple[str | int, ...], dict[str | int, float]] = {}
    for key, value in values.items():
        mark = quantity_of(key)
        if mark is not None:
            mark.require(key, value)
        *path, last = steps_of(key)
        # the values of a table are compared with one another when all of them are there
        tables.setdefault(tuple(path), {})[last] = value
    for table, numbers in tables.items():
        try:
            case = _put(case, table, numbers)
        except InputError as error:
            head, _, rest = error.field.partition(".")
            if head == table[0] or not rest:
                raise
            # of a part that does not know its place: a guide
            place = ".".join(map(str, table))
            raise InputError(f"{place}.{rest}", error.value, error.limit) from None
    return case.with_spring_on_arm()


def _put(node: Any, path: Sequence[str | int], values: Mapping[str | int, Any]) -> Any:
    """Copy of a section, part or tuple in which values of one of its tables are replaced.

    Parameters
    ----------
    node : object      section, part or tuple
    path : sequence    steps from it to the table; empty: itself
    values : mapping   new values, SI, by name or index

    Raises
    ------
    InputError
        If a part has no such key, or it follows from others.
    """
    if path:
        first, *rest = path
        child = node[first] if isinstance(first, int) else getattr(node, _attribute(node, first))
        values = {first: _put(child, rest, values)}
    if isinstance(node, tuple):
        return tuple(values.get(k, each) for k, each in enumerate(node))
    named = {_attribute(node, str(name)): value for name, value in values.items()}
    if isinstance(node, Part):
        for name in named.keys() - {field.name for field in fields(node)}:  # type: ignore[arg-type]
            raise InputError("factor", name, f"a key of {node.table}")
        for name in named.keys() & set(node.derived):
            key = f"{node.table}.{name}"
            raise InputError(key, str(named[name]), "left out: it follows from other keys")
        return replace(node, **named).with_derived()  # type: ignore[type-var]
    return node.model_copy(update=named)


WIRE = (
    "wire_diameter", "mean_diameter", "coils", "free_length", "end_factor", "shear_modulus",
    "elastic_modulus", "density", "strength_at_1mm", "strength_exponent", "relaxation",
)  # fmt: skip
_LEFT_OUT = ("elastic_modulus", "relaxation")


def wound_spring(case: Case, at: Callable[[str], Value | None]) -> WoundWire[Value] | None:
    """Coil springs of one design, or of many (...), by the numbers of their wire, coils and ends;
    None where the case has no table ``spring.design``.

    A number that may be left out, and is by all designs, is None. Treatment and temperature, K, are
    those of the case.

    Parameters
    ----------
    at : callable   dotted key of the case -> number, or one a design (...), SI; None or NaN where
                    it is left out
    """
    design = case.spring.design
    if design is None:
        return None
    values: dict[str, Any] = {name: at(f"spring.design.{name}") for name in WIRE}
    values |= {
        name: None
        for name in _LEFT_OUT
        if values[name] is None or np.isnan(np.asarray(values[name])).all()
    }
    return WoundWire(**values, treatment=design.treatment, temperature=design.temperature)
