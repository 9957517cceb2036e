"""Interface of machine torques, and marks of the parts of their cycle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Characters, In, Known, Part, Used
from camwright.pipeline.base.units import shown

MARKS_MAX = 24
Role = Literal["drive", "load"]


@dataclass(frozen=True, kw_only=True)
class Mark(Part):
    """Named part of the cycle, by the shaft angle at which it begins."""

    table: ClassVar[str] = "torque.marks"

    angle: Annotated[float, In("deg", at_least=0, below=7200), Known("the machine", "0 deg")]
    """shaft angle at which the part begins"""
    name: Annotated[str, Characters(1, 24), Known("own choice", "forming")]
    """name in the pictures"""


@dataclass(frozen=True, kw_only=True)
class MachineTorque(Part):
    """Torque of a machine on its shaft, positive when it drives; with marks for figures."""

    table: ClassVar[str] = "torque"

    marks: Annotated[tuple[Mark, ...], Used("report")] = ()
    """name of a part of the cycle, up to the next mark"""


def require_marks(marks: tuple[Mark, ...], cycle: float) -> None:
    """Refuse marks of parts of a cycle that are too many, not in ascending order, or outside the
    cycle.

    Parameters
    ----------
    marks : tuple of Mark   with their angles, rad
    cycle : float           shaft angle of the cycle, rad
    """
    if len(marks) > MARKS_MAX:
        raise InputError("torque.marks", f"{len(marks)} tables", f"at most {MARKS_MAX}")
    last = -1.0
    for mark in marks:
        if not last < mark.angle < cycle * (1.0 - 1e-9):
            limit = f"above that of the mark before and below the cycle of {shown(cycle, 'deg')}"
            raise InputError("torque.marks.angle", shown(mark.angle, "deg"), limit)
        last = mark.angle
