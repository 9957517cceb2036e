"""Names in the report of the machine's shaft and of the parts of its cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from camwright.geometry.errors import InputError
from camwright.geometry.figures import AxisMark
from camwright.pipeline.base import units
from camwright.pipeline.base.files import Json
from camwright.reports.report_tables import Record

STROKES = ("intake", "compression", "expansion", "exhaust")
"""Strokes of a four-stroke engine, 180 deg of crank each."""
_CYCLE = 720.0  # deg of crank
_WHOLE = 1e-6  # of the cycles in a cam turn


@dataclass(frozen=True)
class MachineWords:
    """Names of shaft, cycle and strokes of a machine.

    Parameters
    ----------
    shaft : str    "crank" of an engine; else "shaft"
    alone : str    the machine without the cam, in pictures
    origin : str   one sentence on the shaft angle 0; "" where the case has none
    marks : tuple  named parts of all cycles of a cam turn, deg of the shaft; every second is shaded
    """

    shaft: str
    alone: str
    origin: str
    marks: tuple[AxisMark, ...] = ()

    @property
    def title(self) -> str:
        """Name of the shaft at the beginning of a title."""
        return self.shaft.capitalize()


def words_of(case: Record, gear_ratio: float, *, balances: bool = True) -> MachineWords:
    """Names for the machine of a case, from its ``case.toml``.

    Parameters
    ----------
    gear_ratio : float   turns of the machine's shaft per cam turn
    balances : bool      whether the run has a torque
    """
    torque = case.get("torque")
    turn = 360.0 * gear_ratio
    engine = "engine" in case or not isinstance(torque, Mapping)
    marks = _marks_of(torque, turn) if isinstance(torque, Mapping) else ()
    if not engine:
        return MachineWords("shaft", "machine alone", "", marks)
    if balances and not marks:
        starts = [180.0 * k for k in range(len(STROKES))]
        marks = _repeated(starts, STROKES, _CYCLE, turn)
    origin = (
        "Crank angle 0 is the top dead centre of gas exchange, 360 deg the firing top dead centre."
    )
    return MachineWords("crank", "engine alone", origin, marks)


def _marks_of(torque: Mapping[str, Json], turn: float) -> tuple[AxisMark, ...]:
    """Marks of the case's torque, repeated in every cycle of a cam turn; () without marks or where
    an angle cannot be read.

    Parameters
    ----------
    torque : mapping   torque of the case, with its cycle and marks of angle and name
    turn : float       angle of the machine's shaft in a cam turn, deg
    """
    stated = torque.get("marks")
    rows = [row for row in stated if isinstance(row, Mapping)] if isinstance(stated, list) else []
    try:
        starts = [_degrees(row.get("angle")) for row in rows]
        cycle = _degrees(torque.get("cycle", "360 deg"))
    except InputError:
        return ()
    return _repeated(starts, [str(row.get("name", "")) for row in rows], cycle, turn)


def _repeated(
    starts: list[float], names: list[str] | tuple[str, ...], cycle: float, turn: float
) -> tuple[AxisMark, ...]:
    """Marks in every cycle of a cam turn, each from its start to the next one, every second one
    shaded; () without starts or where the turn is no whole number of cycles.

    Parameters
    ----------
    starts : list of float   in a cycle, ascending, deg of the machine's shaft
    names : sequence         of the marks
    cycle, turn : float      angle of the shaft in a cycle and in a cam turn, deg
    """
    count = round(turn / cycle)
    if not starts or count < 1 or abs(turn / cycle - count) > _WHOLE * count:
        return ()
    ends = [*starts[1:], cycle]
    return tuple(
        AxisMark(k * cycle + start, name, k * cycle + end, place % 2 == 1)
        for k in range(count)
        for place, (start, end, name) in enumerate(zip(starts, ends, names, strict=True))
    )


def _degrees(text: Json) -> float:
    return units.parse(text, "deg", "torque") / units.factor("deg")
