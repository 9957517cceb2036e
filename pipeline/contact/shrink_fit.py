"""Shrink fit of the cam on its shaft: operating interference, pressure, slip torque, hoop stress.

The one pressure of the fit: slip of the seat, bore, wall and keyway root take it from here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, NamedTuple

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import ROOM, Material
from camwright.pipeline.base.quantities import In, Known, Part, TableSource, Temperature
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown

Interference = Annotated[float, In("um", above=-1000, below=1000)]


@dataclass(frozen=True, kw_only=True)
class SeatFit(Part):
    """Fit of the cam on its shaft.

    The fit counts at both, 20 degC and the temperatures in operation; its friction acts without the
    key.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the greatest interference is below the least.
    """

    table: ClassVar[str] = "cam.fit"

    least_interference: Annotated[
        Interference,
        Known("tolerance classes of ISO 286, less 0.8 (Rz1 + Rz2) by DIN 7190-1", "10 um"),
    ]
    """least interference of the diameters at 20 degC, without what assembly smooths; negative:
    clearance"""
    greatest_interference: Annotated[Interference, Known("tolerance classes of ISO 286", "24 um")]
    """greatest interference of the diameters at 20 degC; negative: clearance"""
    friction: Annotated[
        float,
        In(above=0, at_most=1),
        Known("DIN 7190-1: 0.12 of oiled steel on steel, to be confirmed"),
    ] = 0.12
    """friction coefficient of the seat at slip"""
    cam_temperature: Annotated[Temperature, Known("measurement or heat balance")] = ROOM
    """temperature of the cam in operation"""
    shaft_temperature: Annotated[Temperature, Known("measurement or heat balance")] = ROOM
    """temperature of the shaft under the cam in operation"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a greatest interference below the least."""
        super().__post_init__()
        if not self.greatest_interference >= self.least_interference:
            field, least = f"{self.table}.greatest_interference", self.least_interference
            limit = f">= {shown(least, 'um')}, the least interference"
            raise InputError(field, shown(self.greatest_interference, "um"), limit)

    @property
    def heated(self) -> bool:
        """Whether an operating temperature differs from that of the drawing."""
        return (self.cam_temperature, self.shaft_temperature) != (ROOM, ROOM)

    def growth(self, radius: Value, cam: Material, shaft: Material) -> Value:
        """Rise of the interference of the radii from 20 degC to operation, m; `radius`: of the
        seat, m.

        NaN where a temperature differs from 20 degC and a material has no coefficient of expansion.
        """
        if not self.heated:
            return 0.0
        of_cam, of_shaft = (
            np.nan if card.expansion is None else card.expansion for card in (cam, shaft)
        )
        free = of_shaft * (self.shaft_temperature - ROOM) - of_cam * (self.cam_temperature - ROOM)
        return free * radius


class FittedRing(NamedTuple):
    """Ring on a solid shaft: seat and outer radius, m, and materials."""

    radius: Value
    outer: Value
    cam: Material
    shaft: Material

    @property
    def _inner_share(self) -> Value:
        walled = np.asarray(self.outer) > self.radius
        return np.where(walled, (self.radius / self.outer) ** 2, np.nan)[()]

    def pressure(
        self, interference: Value, speed: Value = 0.0, farthest: Value | None = None
    ) -> Value:
        """Pressure of the fit, Pa, >= 0; NaN of a ring without a wall.

        Parameters
        ----------
        interference : float or array   of the radii at rest, m
        speed : float or array          of the cam, rad/s, which loosens the ring
        farthest : float or array       outer radius of the mass that turns, m; None: `outer`

        References
        ----------
        Timoshenko, Strength of Materials II (1956), secs. 41 and 43: thick rings and rotating
        discs in plane stress; DIN 7190-1.
        """
        share, a = self._inner_share, self.radius
        yielding = ((1.0 + share) / (1.0 - share) + self.cam.nu) / self.cam.E
        yielding = yielding + (1.0 - self.shaft.nu) / self.shaft.E
        left = interference
        if np.any(speed):
            b, nu = self.outer if farthest is None else farthest, self.cam.nu
            ring = self.cam.density * ((3.0 + nu) * b**2 + (1.0 - nu) * a**2) / self.cam.E
            disc = self.shaft.density * (1.0 - self.shaft.nu) * a**2 / self.shaft.E
            left = left - 0.25 * a * speed**2 * (ring - disc)
        closed = np.where(np.asarray(left) > 0.0, left, np.where(np.isnan(left), np.nan, 0.0))
        return (closed / (a * yielding))[()]

    def hoop(self, pressure: Value, radius: Value) -> Value:
        """Hoop stress of the ring at a radius, Pa."""
        share = self._inner_share
        return pressure * share / (1.0 - share) * (1.0 + (self.outer / radius) ** 2)

    def von_mises(self, pressure: Value) -> Value:
        """Von Mises stress of the ring at its bore, Pa."""
        along = self.hoop(pressure, self.radius)
        return np.sqrt(along**2 + along * pressure + pressure**2)


def slip_torque(pressure: Value, radius: Value, width: Value, friction: float) -> Value:
    """Slip torque of a seat under a pressure (Pa), N m.

    References
    ----------
    DIN 7190-1: 2 pi mu p a^2 b.
    """
    return 2.0 * np.pi * friction * pressure * radius**2 * width
