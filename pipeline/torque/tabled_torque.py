"""Torque against shaft angle from a table."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from functools import partial
from math import pi
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.base.quantities import Cycle, FileName, Known
from camwright.pipeline.torque import angle_trace
from camwright.pipeline.torque.angle_trace import Trace, read_trace
from camwright.pipeline.torque.machine_torque import MachineTorque, Role
from camwright.pipeline.torque.trace_file import HeaderText

CLOSURE_MAX = 0.02
"""Greatest difference of the torque at both ends of the cycle over its peak to peak."""

HALVED_MAX = 0.1
"""Greatest change of the work with every other row left out, over its swing; the work of the whole
table is then some ten times as near."""


@dataclass(frozen=True, kw_only=True)
class TabledTorqueFile(MachineTorque):
    """Case table: file with columns of shaft angle and torque over one cycle."""

    kind: Annotated[Literal["table"], Known("own choice")] = "table"
    """origin of the torque"""
    role: Annotated[Role, Known("own choice")] = "drive"
    """whether the torque drives the shaft, or loads it: then stated positive, it acts against the
    shaft"""
    cycle: Annotated[Cycle, Known("the machine")] = 2.0 * pi
    """shaft angle after which the torque repeats"""
    file: Annotated[FileName, Known("measured or computed", "torque.csv")]
    """data file, relative to the case file; of a press: travel above the lower dead centre and
    force"""
    column: Annotated[HeaderText, Known("the file")] = ""
    """column of the file, by the beginning of its header; needed where several are of the
    quantity"""


@dataclass(frozen=True, eq=False)
class TabledTorque:
    """Torque through a table, periodic over its cycle.

    Parameters
    ----------
    trace : Trace    N m against shaft angle over one cycle
    role : str       "drive", or "load": stated positive, acts against the shaft

    Raises
    ------
    InputError
        If the torque is constant, differs at the ends of the cycle by more than 2 % of its peak to
        peak, or has too few rows for its harmonics.
    """

    trace: Trace
    role: Role = "drive"

    def __post_init__(self) -> None:
        """Refuse a constant torque, and one that does not close or has too few rows; see
        `require_cycle`.
        """
        if not float(np.ptp(self.trace.values)) > 0.0:
            text = f"constant, {float(self.trace.values[0]):.6g} N m"
            limit = "a torque that varies over the cycle"
            raise InputError(f"{self.trace.source}, {self.trace.column}", text, limit)
        require_cycle(self.trace, "N m")

    @property
    def cycle(self) -> float:
        """Shaft angle of one cycle, rad."""
        return self.trace.period

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at equal shaft angles (n,), rad, of one cycle from 0, N m.

        Where the table is at least twice as dense, the mean over each step.
        """
        values = self.trace.kept_uniform(np.size(theta))
        return readonly(values if self.role == "drive" else -values)


def require_cycle(trace: Trace, unit: str) -> None:
    """Refuse values over a cycle that do not close at its ends, or are too few for their harmonics.

    Parameters
    ----------
    trace : Trace   over one cycle
    unit : str      of the values, SI, for the message

    Raises
    ------
    InputError
        If the values differ at the ends of the cycle by more than 2 % of their peak to peak, or
        their integral changes by more than 10 % of its swing with every other row left out.
    """
    name, peak_to_peak = f"{trace.source}, {trace.column}", float(np.ptp(trace.values))
    if not trace.closure <= CLOSURE_MAX * peak_to_peak:
        text = f"not closed, {trace.closure:.4g} {unit} between both ends of the cycle"
        limit = f"<= {CLOSURE_MAX * peak_to_peak:.4g} {unit}, {CLOSURE_MAX:.0%} of peak to peak"
        raise InputError(name, text, limit)
    if peak_to_peak > 0.0 and (change := _change_halved(trace)) > HALVED_MAX:
        text = f"{trace.angle.size} rows; the work changes by {change:.0%} with half of them"
        limit = f"more rows, so that it changes by {HALVED_MAX:.0%} or less: these are aliased"
        raise InputError(name, text, limit)


def _change_halved(trace: Trace) -> float:
    """Change of the work about its mean with every other row left out, over its swing; kept."""
    modules = sys.modules[__name__], angle_trace
    compute = partial(_halved, trace)
    return float(disk_cache.kept("halved", trace.key, compute, modules)["change"])


def _halved(trace: Trace) -> dict[str, Array]:
    """Greatest change of the integral of a trace about its mean when every other row is left out,
    over the range of the integral; as an array named "change" for the disk cache.
    """
    count = 4 * trace.angle.size
    whole = _swing(trace, count)
    halves = (
        _swing(replace(trace, angle=trace.angle[k::2], values=trace.values[k::2]), count)
        for k in (0, 1)
    )
    largest = max(float(np.abs(half - whole).max()) for half in halves)
    return {"change": np.array(largest / float(np.ptp(whole)))}


def _swing(trace: Trace, count: int) -> Array:
    """Work of a torque less its mean, at equal angles, of zero mean, any unit."""
    values = trace(np.arange(count) * (trace.period / count))
    work = np.cumsum(values - values.mean())
    return np.asarray(work - work.mean())


def tabled_torque(source: TabledTorqueFile, path: str | Path) -> TabledTorque:
    """Torque of a table, N m, over the cycle (rad) of `source`, read from a file; as driving or
    loading torque by its role.

    Raises
    ------
    InputError
        If the file is not one clean cycle; see `read_trace` and `TabledTorque`.
    """
    column = source.column or None
    trace = read_trace(path, "torque", column=column, period=source.cycle)
    return TabledTorque(trace, source.role)
