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
    CrankRadius,
    Duration,
    Force,
    Fraction,
    GasPressure,
    In,
    Known,
    Length,
    Mass,
    Part,
    Positive,
    RodLength,
    Share,
    Temperature,
    Used,
)
from camwright.pipeline.base.units import shown
from camwright.pipeline.torque.period import FOUR_STROKE

CYCLE_ANGLE = FOUR_STROKE.angle
LIFT_ROWS = (4, 720)  # least and most rows of a lift table

FrictionPressure = Annotated[float, In("kPa", at_least=0, at_most=1e4)]


@dataclass(frozen=True, kw_only=True)
class LiftPoint(Part):
    """Row of a valve lift table: crank angle and lift."""

    table: ClassVar[str] = "lift_point"

    angle: Annotated[Angle, Known("measured", "30 deg")]
    """crank angle"""
    lift: Annotated[float, In("mm", at_least=0, at_most=1000), Known("measured", "2.5 mm")]
    """lift of the valve at this crank angle"""


@dataclass(frozen=True, kw_only=True)
class ExhaustLiftPoint(LiftPoint):
    """Row of an exhaust valve's lift table."""

    angle: Annotated[Angle, Known("measured", "500 deg")]


@dataclass(frozen=True, kw_only=True)
class RunningGear(Part):
    """Crank, connecting rods and pistons of equal cylinders, with their firing order.

    The pin offset is positive on the side to which the crank pin moves from angle 0.

    Raises
    ------
    InputError
        If a value is out of its bounds, the crank cannot rotate fully, or no cylinder fires.
    """

    table: ClassVar[str] = "engine.running_gear"

    crank_radius: Annotated[CrankRadius, Known("engine data sheet", "21 mm")]
    rod_length: Annotated[RodLength, Known("drawing", "73 mm")]
    piston_mass: Annotated[Mass, Known("weighed, or drawing", "144 g")]
    """piston with rings and pin"""
    rod_mass: Annotated[Mass, Known("weighed, or drawing", "123 g")]
    """connecting rod"""
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000), Known("drawing")] = 0.0
    """offset of the piston pin from the crank axis"""
    rod_big_end_share: Annotated[Share, Known("centre of gravity of the rod")] = 2.0 / 3.0
    """share of the rod mass that turns with the crank"""
    firing_offsets: Annotated[tuple[Angle, ...], Known("firing order")] = (0.0,)
    """crank angle of each cylinder behind the first"""

    def __post_init__(self) -> None:
        """Refuse a rod that is not longer than crank radius plus pin offset, and firing offsets
        that are none or not finite.
        """
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
        """Exact torque on the crank of one reciprocating mass at constant speed, N m."""
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
    bore: Annotated[Length, Known("engine data sheet", "60 mm")]
    """cylinder bore"""
    compression_ratio: Annotated[float, In(above=1, at_most=40), Known("engine data sheet", 8.5)]
    """volume at bottom over that at top dead centre"""

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
    -10 deg. With compression ignition the premixed share of the fuel burns in a first, short Wiebe
    burn. An oil dipper is immersed about BDC.

    Raises
    ------
    InputError
        As `CrankDrive`; if valve timing, lift tables, spark and burn contradict one another.
    """

    kind: Literal["cylinder"] = "cylinder"
    intake_valve_open: Annotated[Angle, Known("engine data sheet")] = 0.0
    """crank angle at which the intake valve opens; 0 is the top dead centre of intake"""
    intake_valve_close: Annotated[Angle, Known("engine data sheet")] = radians(220.0)
    """crank angle at which the intake valve closes"""
    exhaust_valve_open: Annotated[Angle, Known("engine data sheet")] = radians(470.0)
    """crank angle at which the exhaust valve opens"""
    exhaust_valve_close: Annotated[Angle, Known("engine data sheet")] = radians(720.0)
    """crank angle at which the exhaust valve closes"""
    valve_lift: Annotated[Length, Known("engine data sheet or measured")] = 0.0055
    """maximum lift at the valve"""
    intake_lift_table: Annotated[tuple[LiftPoint, ...], Used("torque")] = ()
    """lift of the intake valve, in place of its timing"""
    exhaust_lift_table: Annotated[tuple[ExhaustLiftPoint, ...], Used("torque")] = ()
    """lift of the exhaust valve, in place of its timing"""
    intake_valve_diameter: Annotated[Length, Known("drawing or measured")] = 0.025
    """diameter of the intake valve seat"""
    exhaust_valve_diameter: Annotated[Length, Known("drawing or measured")] = 0.022
    """diameter of the exhaust valve seat"""
    valve_discharge_coefficient: Annotated[Fraction, Known("flow bench; textbooks")] = 0.6
    """flow through the valve over that of its opening"""
    valve_spring_rate: Annotated[
        float, In("N/m", at_least=0, at_most=1e9), Known("spring drawing")
    ] = 5884.0
    """rate of each valve spring"""
    valve_spring_preload: Annotated[Force, Known("spring drawing")] = 47.0
    """force of the closed valve's spring"""
    rocker_ratio: Annotated[Positive, Known("drawing")] = 1.0
    """valve lift over cam lift"""

    intake_pressure: Annotated[GasPressure, Known("measured", "30.5 kPa")] = 30.5e3
    """absolute pressure in the intake manifold: the engine load; measured cycles are pegged to
    it"""
    exhaust_pressure: Annotated[GasPressure, Known("measured")] = 101.3e3
    """absolute pressure in the exhaust port"""
    crankcase_pressure: Annotated[GasPressure, Known("measured; ambient")] = 101.3e3
    """absolute pressure below the piston"""
    intake_temperature: Annotated[Temperature, Known("measured")] = 305.0
    """temperature of the fresh charge"""
    exhaust_temperature: Annotated[Temperature, Known("measured")] = 700.0
    """temperature of exhaust gas that flows back"""
    wall_temperature: Annotated[Temperature, Known("measured; textbooks")] = 400.0
    """mean temperature of the cylinder wall"""

    ignition: Annotated[Literal["spark", "compression"], Known("engine data sheet")] = "spark"
    """spark or compression ignition"""
    spark: Annotated[Angle, Known("engine data sheet")] = radians(335.0)
    """crank angle of the spark, or start of injection"""
    ignition_delay: Annotated[
        float, In("deg", at_least=0, at_most=180), Known("heat release analysis")
    ] = radians(8.0)
    """crank angle from the spark to the start of the burn"""
    burn_duration: Annotated[Duration, Known("heat release analysis")] = radians(80.0)
    """crank angle of the Wiebe burn"""
    wiebe_a: Annotated[Positive, Known("textbooks")] = 5.0
    """completeness of the Wiebe burn"""
    wiebe_m: Annotated[Positive, Known("textbooks")] = 2.0
    """shape of the Wiebe burn"""
    premixed_share: Annotated[Share, Known("heat release analysis")] = 0.0
    """share of the fuel in the premixed burn of compression ignition"""
    premixed_duration: Annotated[Duration, Known("heat release analysis")] = radians(8.0)
    """crank angle of the premixed burn"""
    premixed_m: Annotated[Positive, Known("textbooks")] = 1.5
    """shape of the Wiebe burn of the premixed fuel"""
    combustion_efficiency: Annotated[Share, Known("exhaust analysis; textbooks")] = 0.9
    """share of the fuel that burns"""
    air_fuel_ratio: Annotated[float, In(above=1, at_most=1000), Known("measured")] = 13.5
    """mass of air over mass of fuel"""
    lower_heating_value: Annotated[
        float, In("MJ/kg", above=0, at_most=1000), Known("fuel data sheet")
    ] = 43.5e6
    """heating value of the fuel"""

    heat_loss: Annotated[Literal["hohenberg", "woschni"], Known("own choice")] = "hohenberg"
    """correlation of the heat transfer to the wall"""
    heat_loss_factor: Annotated[
        float, In(at_least=0, at_most=100), Known("tuned to a measurement")
    ] = 1.0
    """factor on the heat transfer"""
    friction_pressure: Annotated[FrictionPressure | None, Known("motoring test", "150 kPa")] = None
    """friction mean effective pressure; left out, friction closes the torque balance"""
    dipper_area: Annotated[float, In("mm^2", at_least=0, at_most=1e6), Known("drawing")] = 0.0
    """area of an oil dipper on the rod; 0: none"""
    dipper_radius: Annotated[Length, Known("drawing")] = 0.035
    """radius of the dipper about the crank"""
    dipper_drag_coefficient: Annotated[Positive, Known("textbooks")] = 1.2
    """drag coefficient of the dipper"""
    dipper_immersion: Annotated[float, In("deg", above=0, at_most=180), Known("drawing")] = radians(
        40.0
    )
    """half of the crank angle under oil"""
    oil_density: Annotated[float, In("kg/m^3", above=0, at_most=1e5), Known("oil data sheet")] = (
        870.0
    )
    """density of the oil in the sump"""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._guard_valves()
        self._guard_burn()

    def _guard_valves(self) -> None:
        """InputError for a lift table that is not closed at its ends, or a valve that is open for a
        whole cycle.
        """
        for name in ("intake", "exhaust"):
            table: tuple[LiftPoint, ...] = getattr(self, f"{name}_lift_table")
            if table:
                _guard_lift_table(f"engine.{name}_lift_table", table)
            opens, closes = getattr(self, f"{name}_window")
            if not opens < closes < opens + CYCLE_ANGLE:
                limit = f"within 720 deg after {name}_valve_open = {shown(opens, 'deg')}"
                raise InputError(f"engine.{name}_valve_close", shown(closes, "deg"), limit)

    def _guard_burn(self) -> None:
        """InputError for a spark or combustion outside the time in which both valves are shut."""
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
