"""Crank drive of a piston: areas of both sides, torque of their pressures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank
from camwright.pipeline.base.quantities import (
    Angle,
    CrankRadius,
    GasPressure,
    In,
    Known,
    Length,
    Part,
    RodLength,
)
from camwright.pipeline.base.units import shown

ATMOSPHERE = 101.325e3
"""Standard atmosphere, Pa."""

CYLINDERS_MAX = 24


@dataclass(frozen=True, kw_only=True)
class PistonDrive(Part):
    """Crank drive of one cylinder with the areas of both piston sides.

    At `phase` the crank lies along the cylinder, which without an offset is the dead centre. The
    offset is positive on the side to which the crank pin moves from there.

    Raises
    ------
    InputError
        If a value is out of its bounds, the crank cannot rotate fully, or the piston rod leaves no
        area.
    """

    table: ClassVar[str] = "torque.cylinders"

    bore: Annotated[Length, Known("data sheet", "60 mm")]
    """diameter of the piston"""
    crank_radius: Annotated[CrankRadius, Known("data sheet", "25 mm")]
    rod_length: Annotated[RodLength, Known("drawing", "100 mm")]
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000), Known("drawing")] = 0.0
    """offset of the line of the piston from the crank axis"""
    phase: Annotated[Angle, Known("drawing")] = 0.0
    """shaft angle of the outer dead centre"""
    double_acting: Annotated[bool, Known("drawing")] = False
    """whether both sides of the piston work"""
    piston_rod_diameter: Annotated[
        float, In("mm", at_least=0, at_most=10_000), Known("drawing")
    ] = 0.0
    """diameter of the piston rod"""
    back_pressure: Annotated[GasPressure, Known("ambient")] = ATMOSPHERE
    """absolute pressure behind a single-acting piston, and on the piston rod"""
    reciprocating_mass: Annotated[
        float, In("kg", at_least=0, at_most=1e6), Known("weighed, or drawing")
    ] = 0.0
    """piston, piston rod and crosshead with the small end of the connecting rod"""

    def __post_init__(self) -> None:
        """Refuse a connecting rod that is not longer than crank radius plus pin offset, and a
        piston rod not thinner than the bore.
        """
        super().__post_init__()
        least = self.crank_radius + abs(self.pin_offset)
        if not self.rod_length > least:
            limit = f"> {shown(least, 'mm')}, crank_radius and pin_offset"
            raise InputError(f"{self.table}.rod_length", shown(self.rod_length, "mm"), limit)
        if not self.piston_rod_diameter < self.bore:
            diameter, limit = shown(self.piston_rod_diameter, "mm"), shown(self.bore, "mm")
            raise InputError(f"{self.table}.piston_rod_diameter", diameter, f"< bore = {limit}")

    @property
    def linkage(self) -> SliderCrank:
        return SliderCrank(self.crank_radius, self.rod_length, self.pin_offset)

    @property
    def head_area(self) -> float:
        """m2."""
        return 0.25 * pi * self.bore**2

    @property
    def rod_area(self) -> float:
        """Section of the piston rod, m2."""
        return 0.25 * pi * self.piston_rod_diameter**2

    @property
    def displacement(self) -> float:
        """Swept volume of the working sides, m3."""
        area = 2.0 * self.head_area - self.rod_area if self.double_acting else self.head_area
        return area * self.linkage.stroke

    def torque_of(self, theta: ArrayLike, head: ArrayLike, crank_side: ArrayLike) -> Array:
        """Torque on the shaft of the pressures (n,), Pa, on both sides of the piston, N m.

        By virtual work, T = F dx/dtheta with the force of the pressures on the piston.

        Parameters
        ----------
        theta : array (n,)         shaft angle, rad
        head, crank_side : array   Pa, absolute; that of the crank side acts on the ring about the
                                   piston rod
        """
        ring = self.head_area - self.rod_area
        force = np.asarray(head) * self.head_area - np.asarray(crank_side) * ring
        force = force - self.back_pressure * self.rod_area
        return np.asarray(force * self.linkage.travel_rate(np.asarray(theta) - self.phase))

    def inertia(self, theta: ArrayLike) -> Array:
        """m (dx/dtheta)^2 at shaft angles (...), rad: inertia of the mass at the shaft, kg m2."""
        rate = self.linkage.travel_rate(np.asarray(theta) - self.phase)
        return np.asarray(self.reciprocating_mass * rate**2)


def require_cylinders(cylinders: Sequence[PistonDrive]) -> None:
    """Refuse a machine without a cylinder, or with more than 24."""
    if not 1 <= len(cylinders) <= CYLINDERS_MAX:
        limit = f"from 1 to {CYLINDERS_MAX} tables"
        raise InputError("torque.cylinders", f"{len(cylinders)} tables", limit)


def torque_sum(parts: Sequence[Array]) -> Array:
    """Sum of the torques of all cylinders, N m."""
    return readonly(np.sum(parts, axis=0))
