"""Torque of measured or computed pressures on pistons, over a cycle of any length."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, readonly
from camwright.geometry.errors import InputError
from camwright.geometry.periodic_spline import periodic_cubic
from camwright.pipeline.base.quantities import Cycle, FileName, Known, Used
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.angle_trace import Trace, read_trace
from camwright.pipeline.torque.machine_torque import MachineTorque
from camwright.pipeline.torque.piston_drive import PistonDrive, require_cylinders, torque_sum
from camwright.pipeline.torque.trace_file import HeaderText

_WHOLE = 1e-9  # of the turns in a cycle


@dataclass(frozen=True, kw_only=True)
class PressureCylinder(PistonDrive):
    """Cylinder with its pressure in a file.

    Raises
    ------
    InputError
        As `PistonDrive`; if a double-acting piston lacks the pressure of its crank side.
    """

    column: Annotated[HeaderText, Known("the file")] = ""
    """column of its pressure, by the beginning of the header"""
    crank_side_column: Annotated[HeaderText, Known("the file")] = ""
    """column of the pressure on the crank side of a double-acting piston"""

    def __post_init__(self) -> None:
        """Refuse a double-acting piston without the pressure of its crank side, and one beside a
        single-acting piston.
        """
        super().__post_init__()
        if self.double_acting != bool(self.crank_side_column):
            limit = "given for a double-acting piston, and for no other"
            stated = self.crank_side_column or "missing"
            raise InputError(f"{self.table}.crank_side_column", stated, limit)


@dataclass(frozen=True, kw_only=True)
class PressureTorqueFile(MachineTorque):
    """Case table: file of absolute pressures over one cycle, and the cylinders they act in.

    Equal cylinders share a column of angles from their outer dead centres.

    Raises
    ------
    InputError
        If the cycle is no whole number of turns, or the cylinders are none or more than 24.
    """

    kind: Literal["pressure"] = "pressure"
    cycle: Cycle = 2.0 * pi
    file: FileName
    angles: Annotated[Literal["cylinder", "shaft"], Known("the file")] = "cylinder"
    """whether the angles of the file are those of the shaft, or those of each cylinder from its
    outer dead centre"""
    cylinders: Annotated[tuple[PressureCylinder, ...], Used("torque")]
    """one cylinder; several may differ"""

    def __post_init__(self) -> None:
        """Refuse a cycle that is no whole number of turns, and a wrong number of cylinders."""
        super().__post_init__()
        turns = self.cycle / FULL_TURN
        if abs(turns - round(turns)) > _WHOLE * turns or turns < 0.5:
            limit = "a whole number of turns of 360 deg, as the pistons repeat with each"
            raise InputError("torque.cycle", shown(self.cycle, "deg"), limit)
        require_cylinders(self.cylinders)


@dataclass(frozen=True, eq=False)
class PressureTorque:
    """Torque of pressures on the pistons of a machine.

    Parameters
    ----------
    source : PressureTorqueFile     its file is not read
    head : tuple of Trace           Pa, absolute, one per cylinder
    crank_side : tuple              Trace of each double-acting cylinder, None of others

    Raises
    ------
    InputError
        If a trace is over another cycle, or a pressure not above zero.
    """

    source: PressureTorqueFile
    head: tuple[Trace, ...]
    crank_side: tuple[Trace | None, ...]

    def __post_init__(self) -> None:
        """Refuse traces of another cycle, and pressures that are not absolute."""
        for trace in filter(None, (*self.head, *self.crank_side)):
            name = f"{trace.source}, {trace.column}"
            if not np.isclose(trace.period, self.cycle, rtol=_WHOLE, atol=0.0):
                limit = f"{shown(self.cycle, 'deg')}, the cycle"
                raise InputError(name, shown(trace.period, "deg"), limit)
            if not trace.values.min() > 0.0:
                least = f"{float(trace.values.min()):.4g} Pa"
                raise InputError(name, least, "> 0 Pa: absolute, not gauge")

    @property
    def cycle(self) -> float:
        """Shaft angle of one cycle, rad."""
        return self.source.cycle

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at equal shaft angles (n,), rad, of one cycle from 0, N m."""
        angle = np.asarray(theta, dtype=float)
        parts = []
        for drive, head, other in zip(
            self.source.cylinders, self.head, self.crank_side, strict=True
        ):
            lag = drive.phase if self.source.angles == "cylinder" else 0.0
            against = drive.back_pressure if other is None else _lagging(other, angle, lag)
            parts.append(drive.torque_of(angle, _lagging(head, angle, lag), against))
        return torque_sum(parts)


def _lagging(trace: Trace, theta: Array, lag: float) -> Array:
    """Values (n,) of a trace at equal shaft angles theta less `lag`, so that they come later by
    that angle; by periodic cubic splines.

    Parameters
    ----------
    trace : Trace        over one period
    theta : array (n,)   equal shaft angles of the period from 0, rad
    lag : float          rad
    """
    values = trace.kept_uniform(theta.size)
    if lag == 0.0:
        return values
    return readonly(periodic_cubic(values)((theta - lag) * (FULL_TURN / trace.period)))


def pressure_torque(source: PressureTorqueFile, path: str | Path) -> PressureTorque:
    """Torque of the pressures in a file.

    Raises
    ------
    InputError
        If a column is not one clean cycle (see `read_trace`), or a pressure not above zero.
    """

    def read(column: str) -> Trace:
        return read_trace(path, "pressure", column=column or None, period=source.cycle)

    return PressureTorque(
        source,
        tuple(read(each.column) for each in source.cylinders),
        tuple(
            read(each.crank_side_column) if each.double_acting else None
            for each in source.cylinders
        ),
    )
