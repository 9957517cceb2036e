"""What the torque of every kind of machine has: marks of its cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Characters, In, Part
from camwright.pipeline.base.units import shown

MARKS_MAX = 24
Role = Literal["drive", "load"]


@dataclass(frozen=True, kw_only=True)
class Mark(Part):
    """Name of a part of the cycle, which ends at the next mark."""

    table: ClassVar[str] = "torque.marks"

    angle: Annotated[float, In("deg", at_least=0, below=7200)]
    name: Annotated[str, Characters(1, 24)]


@dataclass(frozen=True, kw_only=True)
class MachineTorque(Part):
    """Torque of a machine on its shaft, positive when it drives it; pictures show the marks."""

    table: ClassVar[str] = "torque"

    marks: tuple[Mark, ...] = ()


def require_marks(marks: tuple[Mark, ...], cycle: float) -> None:
    """Refuse marks that are too many, out of order or beyond the cycle (rad)."""
    if len(marks) > MARKS_MAX:
        raise InputError("torque.marks", f"{len(marks)} tables", f"at most {MARKS_MAX}")
    last = -1.0
    for mark in marks:
        if not last < mark.angle < cycle * (1.0 - 1e-9):
            limit = f"above that of the mark before and below the cycle of {shown(cycle, 'deg')}"
            raise InputError("torque.marks.angle", shown(mark.angle, "deg"), limit)
        last = mark.angle
