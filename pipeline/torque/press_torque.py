"""Torque of a mechanical press: force over the ram's stroke through a slider-crank."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze, readonly
from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank
from camwright.pipeline.base.quantities import Angle, FileName, In, Known, Length, RodLength
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.machine_torque import MachineTorque
from camwright.pipeline.torque.trace_file import HeaderText, trace_text, value_column

GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s2."""

_STROKE_ROUND_OFF = 1e-9  # of a stroke


@dataclass(frozen=True, kw_only=True)
class Press(MachineTorque):
    """Crank drive of a press with its force: constant near the end of the stroke, or a file.

    The force opposes the ram on its way down.

    Raises
    ------
    InputError
        If a value is out of its bounds, the eccentric cannot rotate fully, there is no force or
        there are two, or it begins above the stroke.
    """

    kind: Literal["press"] = "press"
    eccentric_radius: Annotated[Length, Known("drawing", "40 mm")]
    """eccentricity of the press shaft: half of the stroke without an offset"""
    rod_length: Annotated[RodLength, Known("drawing", "300 mm")]
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000), Known("drawing")] = 0.0
    """offset of the line of the ram from the shaft axis"""
    phase: Annotated[Angle, Known("drawing")] = 0.0
    """shaft angle at which the eccentric points to the upper dead centre of the ram"""
    force: Annotated[
        float | None, In("kN", above=0, at_most=1e6), Known("process data", "60 kN")
    ] = None
    """force of the press over its working travel"""
    working_travel: Annotated[Length | None, Known("process data", "6 mm")] = None
    """travel above the lower dead centre over which the force acts"""
    file: FileName | None = None
    column: HeaderText = ""
    ram_mass: Annotated[float, In("kg", at_least=0, at_most=1e6), Known("weighed, or drawing")] = (
        0.0
    )
    """mass that moves with the ram"""

    cycle: ClassVar[float] = 2.0 * pi
    defaults: ClassVar = {
        "force": "that of the file",
        "working_travel": "that of the file",
        "file": "a constant force",
    }

    def __post_init__(self) -> None:
        """Refuse a connecting rod that is too short, a force that is missing or stated twice, and a
        working travel beyond the stroke.
        """
        super().__post_init__()
        least = self.eccentric_radius + abs(self.pin_offset)
        if not self.rod_length > least:
            limit = f"> {shown(least, 'mm')}, eccentric_radius and pin_offset"
            raise InputError("torque.rod_length", shown(self.rod_length, "mm"), limit)
        if (self.force is None) == (self.file is None):
            stated = "missing" if self.force is None else shown(self.force, "kN")
            raise InputError("torque.force", stated, "given, unless a file has the force")
        if (self.force is None) != (self.working_travel is None):
            stated = shown(self.working_travel, "mm") if self.working_travel else "missing"
            raise InputError("torque.working_travel", stated, "given with torque.force")
        stroke = self.linkage.stroke
        if self.working_travel is not None and not self.working_travel <= stroke:
            limit = f"<= {shown(stroke, 'mm')}, the stroke"
            raise InputError("torque.working_travel", shown(self.working_travel, "mm"), limit)

    @property
    def linkage(self) -> SliderCrank:
        return SliderCrank(self.eccentric_radius, self.rod_length, self.pin_offset)

    def inertia(self, theta: ArrayLike) -> Array:
        """m (dx/dtheta)^2 at shaft angles (...), rad: inertia of the ram at the shaft, kg m2."""
        rate = self.linkage.travel_rate(np.asarray(theta) - self.phase)
        return np.asarray(self.ram_mass * rate**2)


@dataclass(frozen=True, eq=False)
class PressTorque:
    """Torque of a press force over the ram's travel.

    Parameters
    ----------
    press : Press
    height : array (m,)    of the ram above its lower dead centre, m, strictly increasing from 0 or
                           above to the stroke or below
    force : array (m,)     N, >= 0, linear between the heights, zero outside

    Raises
    ------
    InputError
        If the heights do not increase or exceed the stroke, or the force is negative or zero
        everywhere.
    """

    press: Press
    height: Array
    force: Array

    def __post_init__(self) -> None:
        """Refuse a force table that does not ascend in height, leaves the stroke or has a negative
        force.
        """
        height, force = finite("torque.height", self.height), finite("torque.force", self.force)
        stroke = self.press.linkage.stroke
        if height.shape != force.shape or height.ndim != 1 or height.size < 2:
            raise InputError("torque.force", f"{force.size} values", "2 or more, one per height")
        if not (np.diff(height) > 0.0).all():
            raise InputError("torque.height", "not in order", "strictly increasing")
        within = -_STROKE_ROUND_OFF * stroke <= height[0] and height[-1] <= stroke * (
            1.0 + _STROKE_ROUND_OFF
        )
        if not within:
            text = f"{shown(float(height[0]), 'mm')} to {shown(float(height[-1]), 'mm')}"
            raise InputError("torque.height", text, f"from 0 mm to {shown(stroke, 'mm')}")
        if not force.min() >= 0.0:
            raise InputError("torque.force", f"{float(force.min()):.6g} N", ">= 0 N")
        if not force.max() > 0.0:
            raise InputError("torque.force", "0 N at every height", "> 0 N at one")
        freeze(self, height=height, force=force)

    @property
    def cycle(self) -> float:
        """Shaft angle of one cycle, rad."""
        return self.press.cycle

    @property
    def work(self) -> float:
        """Work of the force in one cycle, J."""
        return float(self._work_below(np.array([self.height[-1]]))[0])

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at n equal shaft angles of one cycle from 0, N m.

        The force's share is its mean over each step, work over angle: a force that starts at once
        leaves the work of the cycle exact. The weight of the ram drives on the way down.
        """
        angle = np.asarray(theta, dtype=float)
        press, step = self.press, self.cycle / angle.size
        ends = np.append(angle, angle[0] + self.cycle) - 0.5 * step
        pressed = np.diff(self._work_until(ends - press.phase)) / step
        weight = press.ram_mass * GRAVITY * press.linkage.travel_rate(angle - press.phase)
        return readonly(weight - pressed)

    def _work_until(self, crank: Array) -> Array:
        """Work of the press force, J, since the upper dead centre at the angle `top_angle` of the
        linkage, up to crank angles (n,), rad, increasing, counted from `press.phase`; negative
        before it.
        """
        linkage = self.press.linkage
        turns, past = np.divmod(crank - linkage.top_angle, FULL_TURN)
        height = np.clip(linkage.stroke - linkage.travel(crank), 0.0, linkage.stroke)
        height[past >= linkage.bottom_angle - linkage.top_angle] = 0.0
        return np.asarray((turns + 1.0) * self.work - self._work_below(height))

    def _work_below(self, height: Array) -> Array:
        """Work of the force, J, from the lowest height of its table to heights (n,), m."""
        known, force = self.height, self.force
        parts = 0.5 * np.diff(known) * (force[1:] + force[:-1])
        sums = np.append(0.0, np.cumsum(parts))
        at = np.clip(height, known[0], known[-1])
        place = np.clip(np.searchsorted(known, at, side="right") - 1, 0, known.size - 2)
        rest, slope = at - known[place], np.diff(force) / np.diff(known)
        return np.asarray(sums[place] + rest * (force[place] + 0.5 * slope[place] * rest))


def press_torque(press: Press, path: str | Path | None = None) -> PressTorque:
    """Torque of a press; a force table is read from `path`.

    Raises
    ------
    InputError
        With file, line, value and limit, if the file is not one clean table; see `PressTorque`.
    """
    if press.force is not None and press.working_travel is not None:
        return PressTorque(press, np.array([0.0, press.working_travel]), np.full(2, press.force))
    if path is None:
        raise InputError("torque.file", "missing", "a table of force over travel")
    text = trace_text(Path(path), "travel_mm,force_kN")
    travel_at, travel_factor = value_column(text.name, text.header, "travel", None)
    force_at, force_factor = value_column(text.name, text.header, "force", press.column or None)
    table = text.numbers((travel_at, force_at)) * np.array([travel_factor, force_factor])
    if table.shape[0] < 2:
        raise InputError(text.name, f"{table.shape[0]} rows", "2 rows or more")
    upward = table if table[-1, 0] > table[0, 0] else table[::-1]
    falls = ~(np.diff(upward[:, 0]) > 0.0)
    if falls.any():
        between = upward[int(np.argmax(falls)) + 1, 0]
        limit = "strictly increasing or strictly falling"
        field = f"{text.name}, {text.header[travel_at]}"
        raise InputError(field, f"{shown(float(between), 'mm')} out of order", limit)
    return PressTorque(press, upward[:, 0], upward[:, 1])
