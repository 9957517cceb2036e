"""Compressor and piston pump with automatic valves: pressures and torque."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from math import exp, pi
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import GasPressure, In, Known
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.machine_torque import MachineTorque
from camwright.pipeline.torque.piston_drive import PistonDrive, require_cylinders, torque_sum


@dataclass(frozen=True, kw_only=True)
class _ValvedCylinder(PistonDrive):
    """Cylinder whose valves open by themselves at constant pressures of suction and discharge.

    The clearance is that of either side.
    """

    suction_pressure: Annotated[GasPressure, Known("measured", "100 kPa")]
    """absolute pressure of suction"""
    discharge_pressure: Annotated[GasPressure, Known("measured", "600 kPa")]
    """absolute pressure of discharge"""
    clearance: float

    def __post_init__(self) -> None:
        """Refuse a discharge pressure that is not above that of suction."""
        super().__post_init__()
        if not self.suction_pressure < self.discharge_pressure:
            least = f"> suction_pressure = {shown(self.suction_pressure, 'kPa')}"
            pressure = shown(self.discharge_pressure, "kPa")
            raise InputError(f"{self.table}.discharge_pressure", pressure, least)

    @abstractmethod
    def _shut(self, pressure: float, ratio: Array) -> Array:
        """Pressure of a shut volume, Pa, from that before, by the ratio of the volumes (n,)."""

    def _pressure(self, swept: Array, growing: NDArray[np.bool_]) -> Array:
        """Pressure of one side of the piston (n,), Pa, within suction and discharge pressure.

        Parameters
        ----------
        swept : array (n,)     share of the swept volume that is open
        growing : array (n,)   whether it grows: expansion and suction; else compression, discharge
        """
        volume = self.clearance + swept
        part = np.divide(self.clearance, volume, out=np.ones_like(volume), where=volume > 0.0)
        whole = np.divide(1.0 + self.clearance, volume, out=np.full_like(volume, np.inf),
                          where=volume > 0.0)  # fmt: skip
        expanding = np.maximum(self._shut(self.discharge_pressure, part), self.suction_pressure)
        compressed = np.minimum(self._shut(self.suction_pressure, whole), self.discharge_pressure)
        return np.where(growing, expanding, compressed)

    def pressures(self, theta: ArrayLike) -> tuple[Array, Array]:
        """Absolute pressures (n,), Pa, on the head side of the piston, then on its crank side, at
        shaft angles (n,), rad.

        The crank side of a single-acting piston has the back pressure.
        """
        crank = np.asarray(theta, dtype=float) - self.phase
        swept = np.clip(self.linkage.travel(crank) / self.linkage.stroke, 0.0, 1.0)
        growing = self.linkage.travel_rate(crank) > 0.0
        head = self._pressure(swept, growing)
        if not self.double_acting:
            return head, np.full_like(head, self.back_pressure)
        return head, self._pressure(1.0 - swept, ~growing)

    def torque(self, theta: ArrayLike) -> Array:
        """Torque of the pressures on the shaft at shaft angles (n,), rad, N m."""
        return self.torque_of(theta, *self.pressures(theta))


@dataclass(frozen=True, kw_only=True)
class CompressorCylinder(_ValvedCylinder):
    """Cylinder of a gas compressor: p V^n constant while both valves are shut.

    Raises
    ------
    InputError
        As `PistonDrive`; if the discharge pressure is not above that of suction, or is not reached
        with the clearance.

    References
    ----------
    Eastop and McConkey, Applied Thermodynamics for Engineering Technologists (5th ed.), sec. 12.2:
    ideal indicator diagram of a reciprocating compressor with clearance.
    """

    clearance: Annotated[float, In(above=0, at_most=1), Known("data sheet", 0.05)]
    """volume left at the dead centre over the swept volume"""
    exponent: Annotated[float, In(at_least=1, at_most=2), Known("indicator diagram; textbooks")] = (
        1.3
    )
    """exponent n of p V^n while both valves are shut"""

    def __post_init__(self) -> None:
        """Refuse a discharge pressure that compression into the clearance does not reach."""
        super().__post_init__()
        reached = self.suction_pressure * (1.0 + 1.0 / self.clearance) ** self.exponent
        if not self.discharge_pressure < reached:
            limit = f"< {shown(reached, 'kPa')}, which the clearance of {self.clearance:g} allows"
            pressure = shown(self.discharge_pressure, "kPa")
            raise InputError(f"{self.table}.discharge_pressure", pressure, limit)

    def _shut(self, pressure: float, ratio: Array) -> Array:
        return np.asarray(pressure * ratio**self.exponent)


@dataclass(frozen=True, kw_only=True)
class PumpCylinder(_ValvedCylinder):
    """Cylinder of a piston pump; with a bulk modulus K its pressure rises by K ln(V0 / V) over that
    of suction, V0: volume at the bottom dead centre.

    Without one the pressure changes at the dead centres at once.

    Raises
    ------
    InputError
        As `PistonDrive`; if the discharge pressure is not above that of suction, or is not reached
        with the clearance.
    """

    clearance: Annotated[float, In(at_least=0, at_most=100)] = 0.0
    bulk_modulus: Annotated[
        float | None, In("MPa", above=0, at_most=1e6), Known("textbooks", "2000 MPa")
    ] = None
    """bulk modulus of the liquid; left out, it is incompressible"""

    defaults: ClassVar = {"bulk_modulus": "incompressible"}

    def __post_init__(self) -> None:
        """Refuse a discharge pressure that a whole stroke, compressing the liquid into the
        clearance, does not reach.
        """
        super().__post_init__()
        if self.bulk_modulus is None:
            return
        rise = (self.discharge_pressure - self.suction_pressure) / self.bulk_modulus
        if not (1.0 + self.clearance) * exp(-min(rise, 700.0)) > self.clearance:
            limit = f"less over suction_pressure with a clearance of {self.clearance:g}"
            pressure = shown(self.discharge_pressure, "kPa")
            raise InputError(f"{self.table}.discharge_pressure", pressure, limit)

    def _shut(self, pressure: float, ratio: Array) -> Array:
        """Pressure (n,), Pa, of liquid shut into a volume that changes: p + K ln(V_before / V_now).

        Without a bulk modulus K it is at once infinite, with the sign of the change; unchanged
        where the volume is.

        Parameters
        ----------
        pressure : float     p, before, Pa
        ratio : array (n,)   V_before / V_now
        """
        with np.errstate(divide="ignore"):  # no clearance: log 0
            strain = np.log(ratio)
        if self.bulk_modulus is None:
            return np.where(strain == 0.0, pressure, np.copysign(np.inf, strain))
        return np.asarray(pressure + self.bulk_modulus * strain)


@dataclass(frozen=True, kw_only=True)
class CompressorTorque(MachineTorque):
    """Torque of a gas compressor on its shaft, whose cylinders may differ.

    Raises
    ------
    InputError
        Without a cylinder, or with more than 24.
    """

    kind: Literal["compressor"] = "compressor"
    cylinders: tuple[CompressorCylinder, ...]

    cycle: ClassVar[float] = 2.0 * pi

    def __post_init__(self) -> None:
        super().__post_init__()
        require_cylinders(self.cylinders)

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at shaft angles (n,), rad, N m."""
        return torque_sum([each.torque(theta) for each in self.cylinders])


@dataclass(frozen=True, kw_only=True)
class PumpTorque(MachineTorque):
    """Torque of a piston pump on its shaft, whose cylinders may differ.

    Raises
    ------
    InputError
        Without a cylinder, or with more than 24.
    """

    kind: Literal["pump"] = "pump"
    cylinders: tuple[PumpCylinder, ...]

    cycle: ClassVar[float] = 2.0 * pi

    def __post_init__(self) -> None:
        super().__post_init__()
        require_cylinders(self.cylinders)

    def torque(self, theta: ArrayLike) -> Array:
        """Torque at shaft angles (n,), rad, N m."""
        return torque_sum([each.torque(theta) for each in self.cylinders])
