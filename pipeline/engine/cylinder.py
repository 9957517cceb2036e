"""One cylinder of a four-stroke engine: geometry, valves, charge, combustion, friction."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import isfinite, pi, radians
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank
from camwright.pipeline.base.quantities import (
    Angle,
    Duration,
    Force,
    Fraction,
    GasPressure,
    In,
    Length,
    Mass,
    Part,
    Positive,
    Share,
    Temperature,
)
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.period import FOUR_STROKE

CYCLE_ANGLE = FOUR_STROKE.angle
LIFT_ROWS = (4, 720)  # least and most rows of a lift table

FrictionPressure = Annotated[float, In("kPa", at_least=0, at_most=1e4)]


@dataclass(frozen=True, kw_only=True)
class LiftPoint(Part):
    """One row of a lift table: an angle and the lift there."""

    table: ClassVar[str] = "lift_point"

    angle: Angle
    lift: Annotated[float, In("mm", at_least=0, at_most=1000)]


@dataclass(frozen=True, kw_only=True)
class RunningGear(Part):
    """Crank, connecting rods and pistons of equal cylinders, and their firing order.

    The piston mass includes rings and pin. The pin offset is that of the cylinder axis from the
    crank axis, positive on the side to which the crank pin moves from angle 0; the big-end share
    that of the rod mass that rotates with the crank pin; a firing offset the crank angle by which
    the cycle of a cylinder lags.

    Raises
    ------
    InputError
        If a value is out of its bounds, the crank cannot rotate fully, or no cylinder fires.
    """

    table: ClassVar[str] = "engine.running_gear"

    crank_radius: Length
    rod_length: Length
    piston_mass: Mass
    rod_mass: Mass
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000)] = 0.0
    rod_big_end_share: Share = 2.0 / 3.0
    firing_offsets: tuple[Angle, ...] = (0.0,)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.rod_length > self.crank_radius + abs(self.pin_offset):
            limit = f"> crank_radius = {shown(self.crank_radius, 'mm')}"
            if self.pin_offset:
                limit += f" plus pin_offset = {shown(abs(self.pin_offset), 'mm')}"
            raise InputError(f"{self.table}.rod_length", shown(self.rod_length, "mm"), limit)
        if not self.firing_offsets or not all(isfinite(angle) for angle in self.firing_offsets):
            stated = self.firing_offsets or "empty"
            raise InputError(f"{self.table}.firing_offsets", stated, "one angle per cylinder")

    @property
    def linkage(self) -> SliderCrank:
        return SliderCrank(self.crank_radius, self.rod_length, self.pin_offset)

    @property
    def reciprocating_mass(self) -> float:
        """Mass of piston and small end of the rod, kg."""
        return self.piston_mass + (1.0 - self.rod_big_end_share) * self.rod_mass

    def inertia_torque(self, theta: ArrayLike, crank_speed: float) -> Array:
        """Torque of one reciprocating mass on the crank at constant speed, exact, N m."""
        acceleration = crank_speed**2 * self.linkage.travel_acceleration(theta)
        force = -self.reciprocating_mass * acceleration
        return np.asarray(force * self.linkage.travel_rate(theta))

    def reciprocating_inertia(self, theta: ArrayLike) -> Array:
        """m x'^2 of all reciprocating masses, their part of the inertia at the crank, kg m2."""
        at = np.asarray(theta, dtype=float)
        rates = [self.linkage.travel_rate(at - offset) for offset in self.firing_offsets]
        return np.asarray(self.reciprocating_mass * sum(rate**2 for rate in rates))


@dataclass(frozen=True, kw_only=True)
class CrankDrive(RunningGear):
    """Running gear with the gas volume of its cylinders.

    Raises
    ------
    InputError
        As `RunningGear`.
    """

    table: ClassVar[str] = "engine"

    kind: str
    bore: Length
    compression_ratio: Annotated[float, In(above=1, at_most=40)]

    @property
    def stroke(self) -> float:
        """m."""
        return self.linkage.stroke

    @property
    def piston_area(self) -> float:
        """m2."""
        return 0.25 * pi * self.bore**2

    @property
    def displacement(self) -> float:
        """Swept volume of one cylinder, m3."""
        return self.piston_area * self.stroke

    @property
    def clearance(self) -> float:
        """Height of the gas above the piston at its top dead centre, m."""
        return self.stroke / (self.compression_ratio - 1.0)

    def volume(self, theta: ArrayLike) -> Array:
        """Gas volume of the cylinder at crank angles (rad), any shape, m3."""
        return np.asarray(self.piston_area * (self.clearance + self.linkage.travel(theta)))

    def volume_rate(self, theta: ArrayLike) -> Array:
        """Derivative of the gas volume by the crank angle, m3/rad."""
        return np.asarray(self.piston_area * self.linkage.travel_rate(theta))

    def friction_torque(self, pressure: float | None, driving: float) -> float:
        """Mean friction torque of one cylinder on the crank, N m, <= 0.

        Parameters
        ----------
        pressure : float or None   friction mean effective pressure (FMEP), Pa; None: the friction
                                   that closes the torque balance of the cycle
        driving : float            mean torque of all other components, N m

        Raises
        ------
        InputError
            If friction has to close the balance of a cycle with a negative mean torque.
        """
        if pressure is not None:
            return -pressure * self.displacement / CYCLE_ANGLE
        if driving < 0.0:
            limit = f"given, as the cycle itself needs {-driving:.3g} N m to turn"
            raise InputError("engine.friction_pressure", "missing", limit)
        return -driving


@dataclass(frozen=True, kw_only=True)
class CylinderEngine(CrankDrive):
    """Model of a four-stroke engine of equal cylinders; crank angle 0 is the TDC of intake.

    Firing TDC is at 360 deg. Valve angles may leave [0, 720 deg): an intake valve may open at
    -10 deg. A lift table replaces timing and lift of its valve. `valve_lift` is at the valve,
    `rocker_ratio` valve lift over cam lift. `exhaust_temperature` is that of exhaust gas that
    flows back. `spark` is the start of injection with compression ignition, where
    `premixed_share` of the fuel burns in a first, short Wiebe burn. Without a friction pressure
    friction closes the torque balance. A dipper area of 0 means no oil dipper; `dipper_immersion`
    is half the crank angle under oil about BDC.

    Raises
    ------
    InputError
        As `CrankDrive`; if valve timing, lift tables, spark and burn contradict one another.
    """

    kind: Literal["cylinder"] = "cylinder"
    intake_valve_open: Angle = 0.0
    intake_valve_close: Angle = radians(220.0)
    exhaust_valve_open: Angle = radians(470.0)
    exhaust_valve_close: Angle = radians(720.0)
    valve_lift: Length = 0.0055
    intake_lift_table: tuple[LiftPoint, ...] = ()
    exhaust_lift_table: tuple[LiftPoint, ...] = ()
    intake_valve_diameter: Length = 0.025
    exhaust_valve_diameter: Length = 0.022
    valve_discharge_coefficient: Fraction = 0.6
    valve_spring_rate: Annotated[float, In("N/m", at_least=0, at_most=1e9)] = 5884.0
    valve_spring_preload: Force = 47.0
    rocker_ratio: Positive = 1.0

    intake_pressure: GasPressure = 30.5e3
    exhaust_pressure: GasPressure = 101.3e3
    crankcase_pressure: GasPressure = 101.3e3
    intake_temperature: Temperature = 305.0
    exhaust_temperature: Temperature = 700.0
    wall_temperature: Temperature = 400.0

    ignition: Literal["spark", "compression"] = "spark"
    spark: Angle = radians(335.0)
    ignition_delay: Annotated[float, In("deg", at_least=0, at_most=180)] = radians(8.0)
    burn_duration: Duration = radians(80.0)
    wiebe_a: Positive = 5.0
    wiebe_m: Positive = 2.0
    premixed_share: Share = 0.0
    premixed_duration: Duration = radians(8.0)
    premixed_m: Positive = 1.5
    combustion_efficiency: Share = 0.9
    air_fuel_ratio: Annotated[float, In(above=1, at_most=1000)] = 13.5
    lower_heating_value: Annotated[float, In("MJ/kg", above=0, at_most=1000)] = 43.5e6

    heat_loss: Literal["hohenberg", "woschni"] = "hohenberg"
    heat_loss_factor: Annotated[float, In(at_least=0, at_most=100)] = 1.0
    friction_pressure: FrictionPressure | None = None
    dipper_area: Annotated[float, In("mm^2", at_least=0, at_most=1e6)] = 0.0
    dipper_radius: Length = 0.035
    dipper_drag_coefficient: Positive = 1.2
    dipper_immersion: Annotated[float, In("deg", above=0, at_most=180)] = radians(40.0)
    oil_density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)] = 870.0

    def __post_init__(self) -> None:
        super().__post_init__()
        self._guard_valves()
        self._guard_burn()

    def _guard_valves(self) -> None:
        for name in ("intake", "exhaust"):
            table: tuple[LiftPoint, ...] = getattr(self, f"{name}_lift_table")
            if table:
                _guard_lift_table(f"engine.{name}_lift_table", table)
            opens, closes = getattr(self, f"{name}_window")
            if not opens < closes < opens + CYCLE_ANGLE:
                limit = f"within 720 deg after {name}_valve_open = {shown(opens, 'deg')}"
                raise InputError(f"engine.{name}_valve_close", shown(closes, "deg"), limit)

    def _guard_burn(self) -> None:
        if not pi <= self.spark <= 3.0 * pi:
            limit = "from 180 to 540 deg, with firing TDC at 360 deg"
            raise InputError("engine.spark", shown(self.spark, "deg"), limit)
        for name, (opens, closes) in (
            ("intake", self.intake_window),
            ("exhaust", self.exhaust_window),
        ):
            if (self.spark - opens) % CYCLE_ANGLE < closes - opens:
                limit = f"while the {name} valve is shut"
                raise InputError("engine.spark", shown(self.spark, "deg"), limit)
        burning = self.ignition_delay + max(self.burn_duration, self.premixed_duration)
        room = min(2.0 * pi, CYCLE_ANGLE - (self.spark - self.intake_window[1]) % CYCLE_ANGLE)
        if not burning < room:
            limit = f"less than {shown(room, 'deg')} with the ignition delay"
            raise InputError("engine.burn_duration", shown(self.burn_duration, "deg"), limit)

    @property
    def intake_window(self) -> tuple[float, float]:
        """Crank angles at which the intake valve opens and closes, rad."""
        if self.intake_lift_table:
            return self.intake_lift_table[0].angle, self.intake_lift_table[-1].angle
        return self.intake_valve_open, self.intake_valve_close

    @property
    def exhaust_window(self) -> tuple[float, float]:
        """Crank angles at which the exhaust valve opens and closes, rad."""
        if self.exhaust_lift_table:
            return self.exhaust_lift_table[0].angle, self.exhaust_lift_table[-1].angle
        return self.exhaust_valve_open, self.exhaust_valve_close


def _guard_lift_table(field: str, table: tuple[LiftPoint, ...]) -> None:
    """Refuse a lift table that does not open from the seat and close upon it again."""
    least, most = LIFT_ROWS
    if not least <= len(table) <= most:
        raise InputError(field, f"{len(table)} rows", f"from {least} to {most} rows")
    if not all(here.angle < there.angle for here, there in pairwise(table)):
        raise InputError(field, "angles", "strictly increasing")
    if table[0].lift != 0.0 or table[-1].lift != 0.0:
        raise InputError(field, "first and last lift", "0 m")
