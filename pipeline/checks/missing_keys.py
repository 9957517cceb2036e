"""Dotted keys missing in a case that a check needs."""

from __future__ import annotations

from camwright.pipeline.base.material import Material
from camwright.pipeline.case.limits import AnyLimit, LimitValues
from camwright.pipeline.case.machine import Machine


def lacking(table: str, part: object, *keys: str) -> tuple[str, ...]:
    """Dotted keys, among `keys`, of a part without a value; table : name of its table in the
    case.
    """
    return tuple(f"{table}.{key}" for key in keys if getattr(part, key) is None)


def lacking_of_card(card: Material, *keys: str) -> tuple[str, ...]:
    """Keys of a material of the case without a value, among given ones."""
    return lacking(f"materials.{card.name}", card, *keys)


def unset(limits: LimitValues, *rows: AnyLimit) -> tuple[str, ...]:
    """Keys of limits without a value."""
    return tuple(f"limits.{row.id}" for row in rows if limits[row] is None)


def no_friction(machine: Machine) -> tuple[str, ...]:
    """Key of the friction between follower and cam, where it is missing."""
    return lacking(machine.follower.table, machine.follower, "friction")


def lacking_along_line(machine: Machine) -> tuple[str, ...]:
    """Dotted keys that the case lacks for the pressure along the line of contact: ends of cam and
    follower, diameter and material of the camshaft.
    """
    parts, shaft = (machine.cam, machine.follower), machine.camshaft
    ends = tuple(key for part in parts for key in lacking(part.table, part, "end"))
    return ends if shaft is None else (*ends, *lacking(shaft.table, shaft, "diameter", "material"))
