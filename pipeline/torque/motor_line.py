"""Torque of a motor over its speed."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.base.quantities import In, Known, Part, Torsion
from camwright.pipeline.base.units import shown

POINTS = (2, 200)
"""Least and most points of a line."""


@dataclass(frozen=True, kw_only=True)
class MotorPoint(Part):
    """One point of a motor line, at the shaft whose torque is balanced."""

    table: ClassVar[str] = "crankshaft.motor_line"

    speed: Annotated[
        float, In("rpm", at_least=0, at_most=1e6), Known("torque curve of the motor", "1500 rpm")
    ]
    """speed of the shaft"""
    torque: Annotated[Torsion, Known("torque curve of the motor", "0 N m")]
    """torque of the motor at the shaft, at this speed"""


@dataclass(frozen=True)
class MotorLine:
    """Torque of a motor over speed, linear between its points and beyond them.

    Two points are a linear line: rated speed and torque, no-load speed and none. A table of an
    induction motor may rise to its pull-out torque; it runs on the falling part.

    Raises
    ------
    InputError
        If the points are fewer than 2 or more than 200, their speeds do not increase, or the
        torque does not fall from the last but one to the last.
    """

    points: tuple[MotorPoint, ...]

    def __post_init__(self) -> None:
        """Refuse fewer or more points than allowed, speeds, rad/s, that do not increase, and a
        torque, N m, that does not fall from the last point but one to the last.
        """
        least, most = POINTS
        if not least <= len(self.points) <= most:
            limit = f"from {least} to {most} points"
            raise InputError("crankshaft.motor_line", f"{len(self.points)} points", limit)
        for lower, upper in pairwise(self.points):
            if not lower.speed < upper.speed:
                limit = f"> {shown(lower.speed, 'rpm')}, the point before"
                raise InputError("crankshaft.motor_line.speed", shown(upper.speed, "rpm"), limit)
        before, last = self.points[-2:]
        if not last.torque < before.torque:
            limit = f"< {shown(before.torque, 'N m')}, the point before: the line falls at its end"
            raise InputError("crankshaft.motor_line.torque", shown(last.torque, "N m"), limit)

    def torque(self, speed: ArrayLike) -> Array:
        """Torque of the motor (...), N m, at speeds (...), rad/s: linear between the points, and
        beyond the ends as in the first and last interval.
        """
        omega = np.asarray(speed, dtype=float)
        place = self._place(omega)
        rest = omega - self._speeds[place]
        return np.asarray(self._torques[place] + self._slopes[place] * rest)

    def slope(self, speed: ArrayLike) -> Array:
        """Derivative of the torque by the speed at speeds (...), rad/s, N m s."""
        return np.asarray(self._slopes[self._place(np.asarray(speed, dtype=float))])

    def balance(self, load: float) -> float:
        """Highest speed at which the motor carries a steady load (N m), rad/s.

        Raises
        ------
        CamError
            If the load is above the greatest torque of the line.
        """
        speeds, torques = self._speeds, self._torques
        if load < torques[-1]:
            return float(speeds[-1] + (load - torques[-1]) / self._slopes[-1])
        for place in range(len(self.points) - 2, -1, -1):
            if torques[place] >= load:
                return float(speeds[place] + (load - torques[place]) / self._slopes[place])
        raise CamError(
            f"the motor cannot carry its load: {load:.4g} N m against {torques.max():.4g} N m,"
            " the greatest torque of its line"
        )

    @property
    def _speeds(self) -> Array:
        return np.array([each.speed for each in self.points])

    @property
    def _torques(self) -> Array:
        return np.array([each.torque for each in self.points])

    @property
    def _slopes(self) -> Array:
        return np.asarray(np.diff(self._torques) / np.diff(self._speeds))

    def _place(self, speed: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.intp]]:
        """Number of the part of the line of each speed."""
        place = np.searchsorted(self._speeds, speed, side="right") - 1
        return np.asarray(np.clip(place, 0, len(self.points) - 2))
