"""Dotted keys that the case lacks and a check needs."""

from __future__ import annotations

from camwright.pipeline.base.material import Material
from camwright.pipeline.case.limits import AnyLimit, LimitValues
from camwright.pipeline.case.machine import Machine


def lacking(table: str, part: object, *keys: str) -> tuple[str, ...]:
    """Those keys of a table of the case whose value is None in the part that it describes."""
    return tuple(f"{table}.{key}" for key in keys if getattr(part, key) is None)


def lacking_of_card(card: Material, *keys: str) -> tuple[str, ...]:
    """Those keys of a material in the case whose value is None."""
    return lacking(f"materials.{card.name}", card, *keys)


def unset(limits: LimitValues, *rows: AnyLimit) -> tuple[str, ...]:
    """Keys of the limits that have no value."""
    return tuple(f"limits.{row.id}" for row in rows if limits[row] is None)


def no_friction(machine: Machine) -> tuple[str, ...]:
    """Key of the friction of the follower on the cam where the case lacks it."""
    return lacking(machine.follower.table, machine.follower, "friction")


def lacking_along_line(machine: Machine) -> tuple[str, ...]:
    """Keys of the ends of the contact that the case lacks, and of the slope of its camshaft."""
    parts, shaft = (machine.cam, machine.follower), machine.camshaft
    ends = tuple(key for part in parts for key in lacking(part.table, part, "end"))
    return ends if shaft is None else (*ends, *lacking(shaft.table, shaft, "diameter", "material"))
