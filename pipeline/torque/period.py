"""Period of a machine: shaft angle of its cycle, and number of cycles in a cam turn."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import shown

CYCLES_MAX = 12
"""Most lobes of a cam."""
_WHOLE = 1e-9  # of the number of cycles of a cam turn: a ratio and an angle written as decimals


@dataclass(frozen=True)
class Period:
    """Cycle of a machine and ratio of its cam drive; a cam turn holds whole cycles.

    Parameters
    ----------
    angle : float   of the shaft in one cycle of the machine, rad, > 0
    ratio : float   shaft turns per cam turn, > 0

    Raises
    ------
    InputError
        If no whole number of cycles, 1 to 12, fits into a cam turn: with the two nearest ratios
        at which one does; NaN included.
    """

    angle: float
    ratio: float

    def __post_init__(self) -> None:
        """Refuse a cam turn that does not hold a whole number of machine cycles."""
        if not 0.0 < self.angle < inf:
            raise InputError("torque.cycle", self.angle, "> 0 rad")
        if not 0.0 < self.ratio < inf:
            raise InputError("mechanism.gear_ratio", self.ratio, "> 0")
        exact = self.ratio * FULL_TURN / self.angle
        cycles = round(exact)
        if not 1 <= cycles <= CYCLES_MAX or abs(exact - cycles) > _WHOLE * cycles:
            below = min(max(int(exact), 1), CYCLES_MAX - 1)
            near = " or ".join(ratio_text(k * self.angle / FULL_TURN) for k in (below, below + 1))
            limit = (
                f"{near}: a cam turn holds a whole number of cycles of {shown(self.angle, 'deg')}"
            )
            raise InputError("mechanism.gear_ratio", ratio_text(self.ratio), limit)

    @property
    def cycles(self) -> int:
        """Cycles of the machine in a cam turn: lobes of the cam."""
        return round(self.ratio * FULL_TURN / self.angle)

    @property
    def cam_turn(self) -> float:
        """Angle of the shaft in a cam turn, rad."""
        return self.ratio * FULL_TURN

    def on_cam(self, values: ArrayLike) -> Array:
        """Values over a cam turn from values over one machine cycle.

        Parameters
        ----------
        values : array (..., n)   at equal shaft angles of one cycle from 0, its end excluded

        Returns
        -------
        array (..., n cycles)     at equal cam angles of one turn from 0, its end excluded
        """
        one = np.asarray(values, dtype=float)
        return readonly(np.tile(one, (*[1] * (one.ndim - 1), self.cycles)))


def ratio_text(ratio: float) -> str:
    """Ratio as a fraction of small whole numbers, such as ``3:2``, or as a decimal."""
    exact = _fraction(ratio)
    if exact:
        return exact
    rounded = f"{ratio:.4g}"  # which may be a fraction that the ratio is not
    return f"{ratio:.6g}" if _fraction(float(rounded)) else rounded


def _fraction(ratio: float) -> str:
    """Ratio as a fraction of small whole numbers; "" if it is none."""
    for below in range(1, 13):
        above = round(ratio * below)
        if above and abs(ratio * below - above) <= _WHOLE * above:
            return f"{above}:{below}" if below > 1 else f"{above}"
    return ""


FOUR_STROKE = Period(4.0 * pi, 2.0)
"""Period of a four-stroke engine whose cam turns at half the speed of the crank."""
