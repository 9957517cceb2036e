"""Torque as a mean and harmonics of the shaft angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, readonly
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Cycle, In, Known, Part, Torsion, Used
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.machine_torque import MachineTorque, Role

HARMONICS_MAX = 360
_WHOLE = 1e-9  # of a number of waves: an order and a cycle written as decimals


@dataclass(frozen=True, kw_only=True)
class Harmonic(Part):
    """One harmonic of a torque over the shaft angle."""

    table: ClassVar[str] = "torque.harmonics"

    order: Annotated[float, In(above=0, at_most=360), Known("measured or computed", 2.0)]
    """waves per turn of the shaft"""
    cosine: Annotated[Torsion, Known("measured or computed")] = 0.0
    """amplitude of the cosine"""
    sine: Annotated[Torsion, Known("measured or computed")] = 0.0
    """amplitude of the sine"""


@dataclass(frozen=True, kw_only=True)
class HarmonicTorque(MachineTorque):
    """Torque T = mean + sum of a cos(k theta) + b sin(k theta) over the shaft angle.

    Raises
    ------
    InputError
        If there is no harmonic, two have the same order, or a cycle holds no whole number of the
        waves of one.
    """

    kind: Literal["harmonics"] = "harmonics"
    role: Role = "drive"
    cycle: Cycle = 2.0 * pi
    mean: Annotated[Torsion, Known("measured or computed")] = 0.0
    """mean of the torque, which a steady motor or load balances"""
    harmonics: Annotated[tuple[Harmonic, ...], Used("torque")]
    """one harmonic of the torque"""

    def __post_init__(self) -> None:
        """Refuse orders that are stated twice or make no whole number of waves in the cycle, and a
        constant torque.
        """
        super().__post_init__()
        if not 1 <= len(self.harmonics) <= HARMONICS_MAX:
            limit = f"from 1 to {HARMONICS_MAX} tables"
            raise InputError("torque.harmonics", f"{len(self.harmonics)} tables", limit)
        orders = [each.order for each in self.harmonics]
        for order in orders:
            waves = order * self.cycle / FULL_TURN
            if orders.count(order) > 1:
                raise InputError("torque.harmonics.order", order, "stated once")
            if abs(waves - round(waves)) > _WHOLE * waves or waves < 0.5:
                limit = f"a whole number of waves in a cycle of {shown(self.cycle, 'deg')}"
                raise InputError("torque.harmonics.order", order, limit)
        if not any(each.cosine or each.sine for each in self.harmonics):
            raise InputError("torque.harmonics", "constant", "a torque that varies")

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at shaft angles (n,), rad, equally spaced over the cycle, N m.

        Raises
        ------
        InputError
            If the angles are too few for the highest order.
        """
        angle = np.asarray(theta, dtype=float)
        highest = max(each.order for each in self.harmonics if each.cosine or each.sine)
        least = int(2.0 * highest * self.cycle / FULL_TURN) + 1
        if angle.size < least:
            limit = f"{least} or more for the order {highest:g}"
            raise InputError("torque.harmonics", f"{angle.size} angles per cycle", limit)
        waves = (
            each.cosine * np.cos(each.order * angle) + each.sine * np.sin(each.order * angle)
            for each in self.harmonics
        )
        torque = self.mean + sum(waves)
        return readonly(torque if self.role == "drive" else -torque)
