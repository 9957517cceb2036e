"""One cylinder of a four-stroke engine: what is known of it before its cycle is solved."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import degrees, inf, isfinite, pi, radians
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank

Ignition = Literal["spark", "compression"]
HeatLoss = Literal["hohenberg", "woschni"]
Friction = Literal["closing"] | float
LiftTable = tuple[tuple[float, float], ...]

CYCLE_ANGLE = 4.0 * pi

_POSITIVE = (
    "bore",
    "valve_lift",
    "intake_valve_diameter",
    "exhaust_valve_diameter",
    "valve_discharge_coefficient",
    "rocker_ratio",
    "intake_pressure",
    "exhaust_pressure",
    "crankcase_pressure",
    "intake_temperature",
    "exhaust_temperature",
    "wall_temperature",
    "burn_duration",
    "wiebe_a",
    "premixed_duration",
    "air_fuel_ratio",
    "lower_heating_value",
)
_NOT_NEGATIVE = (
    "piston_mass",
    "rod_mass",
    "valve_spring_rate",
    "valve_spring_preload",
    "ignition_delay",
    "wiebe_m",
    "premixed_m",
    "heat_loss_factor",
    "dipper_area",
    "dipper_radius",
    "dipper_drag_coefficient",
    "dipper_immersion",
    "oil_density",
)


@dataclass(frozen=True)
class CylinderEngine:
    """A four-stroke engine of equal cylinders; SI units, crank angles in rad.

    Crank angle 0 is the top dead centre at the start of intake, 2 pi that of firing. Angles of
    the valves may leave [0, 4 pi): they wrap, so an intake valve may open at -10 deg.

    The defaults past the running gear are those of a small spark-ignition engine;
    `COMPRESSION_IGNITION` holds the set to lay over them for a small diesel.
    """

    bore: float
    crank_radius: float
    rod_length: float
    compression_ratio: float
    piston_mass: float  # piston, rings and pin
    rod_mass: float
    pin_offset: float = 0.0  # of the cylinder axis from the crank axis, towards positive angles
    rod_big_end_share: float = 2.0 / 3.0  # of the rod mass that turns with the crank pin
    firing_offsets: tuple[float, ...] = (0.0,)  # one per cylinder, delay of its cycle

    intake_valve_open: float = 0.0
    intake_valve_close: float = radians(220.0)
    exhaust_valve_open: float = radians(470.0)
    exhaust_valve_close: float = radians(720.0)
    valve_lift: float = 0.0055  # at the valve
    intake_lift_table: LiftTable | None = None  # (angle, lift), in place of timing and lift
    exhaust_lift_table: LiftTable | None = None
    intake_valve_diameter: float = 0.025
    exhaust_valve_diameter: float = 0.022
    valve_discharge_coefficient: float = 0.6
    valve_spring_rate: float = 5884.0
    valve_spring_preload: float = 47.0
    rocker_ratio: float = 1.0  # valve lift over cam lift

    intake_pressure: float = 30.5e3
    exhaust_pressure: float = 101.3e3
    crankcase_pressure: float = 101.3e3
    intake_temperature: float = 305.0
    exhaust_temperature: float = 700.0  # of exhaust gas that flows back
    wall_temperature: float = 400.0

    ignition: Ignition = "spark"
    spark: float = radians(335.0)  # or the start of injection
    ignition_delay: float = radians(8.0)
    burn_duration: float = radians(80.0)
    wiebe_a: float = 5.0
    wiebe_m: float = 2.0
    premixed_share: float = 0.0  # of the fuel burnt in a first, short Wiebe burn (compression)
    premixed_duration: float = radians(8.0)
    premixed_m: float = 1.5
    combustion_efficiency: float = 0.9
    air_fuel_ratio: float = 13.5
    lower_heating_value: float = 43.5e6

    heat_loss: HeatLoss = "hohenberg"
    heat_loss_factor: float = 1.0

    friction: Friction = "closing"  # a mean effective pressure (Pa), or what closes the balance
    dipper_area: float = 0.0  # of the oil dipper across its motion; 0: no dipper
    dipper_radius: float = 0.035
    dipper_drag_coefficient: float = 1.2
    dipper_immersion: float = radians(40.0)  # half the crank angle under oil, about BDC
    oil_density: float = 870.0

    def __post_init__(self) -> None:
        for name in _POSITIVE:
            if not 0.0 < getattr(self, name) < inf:
                raise InputError(f"engine.{name}", getattr(self, name), "> 0")
        for name in _NOT_NEGATIVE:
            if not 0.0 <= getattr(self, name) < inf:
                raise InputError(f"engine.{name}", getattr(self, name), ">= 0")
        for name in ("rod_big_end_share", "combustion_efficiency", "premixed_share"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise InputError(f"engine.{name}", getattr(self, name), "from 0 to 1")
        if not 1.0 < self.compression_ratio <= 40.0:
            raise InputError("engine.compression_ratio", self.compression_ratio, "from 1 to 40")
        _ = self.linkage  # refuses what cannot turn over
        self._guard_choices()
        self._guard_valves()
        self._guard_burn()
        if not self.firing_offsets or not all(isfinite(angle) for angle in self.firing_offsets):
            raise InputError("engine.firing_offsets", self.firing_offsets, "one angle per cylinder")

    def _guard_choices(self) -> None:
        for name, choices in (("ignition", Ignition), ("heat_loss", HeatLoss)):
            if getattr(self, name) not in get_args(choices):
                limit = " or ".join(get_args(choices))
                raise InputError(f"engine.{name}", getattr(self, name), limit)
        if self.friction != "closing" and not (
            isinstance(self.friction, (int, float)) and 0.0 <= self.friction < inf
        ):
            raise InputError("engine.friction", self.friction, '"closing", or a pressure >= 0 Pa')

    def _guard_valves(self) -> None:
        for name in ("intake", "exhaust"):
            table = getattr(self, f"{name}_lift_table")
            if table is not None:
                _guard_lift_table(f"engine.{name}_lift_table", table)
            opens, closes = getattr(self, f"{name}_window")
            if not opens < closes < opens + CYCLE_ANGLE:
                limit = f"within 720 deg after {name}_valve_open, {degrees(opens):g} deg"
                raise InputError(f"engine.{name}_valve_close", f"{degrees(closes):g} deg", limit)

    def _guard_burn(self) -> None:
        if not pi <= self.spark <= 3.0 * pi:
            limit = "from 180 to 540 deg, with firing TDC at 360 deg"
            raise InputError("engine.spark", f"{degrees(self.spark):g} deg", limit)
        for name, (opens, closes) in (
            ("intake", self.intake_window),
            ("exhaust", self.exhaust_window),
        ):
            if (self.spark - opens) % CYCLE_ANGLE < closes - opens:
                limit = f"while the {name} valve is shut"
                raise InputError("engine.spark", f"{degrees(self.spark):g} deg", limit)
        burning = self.ignition_delay + max(self.burn_duration, self.premixed_duration)
        room = min(2.0 * pi, CYCLE_ANGLE - (self.spark - self.intake_window[1]) % CYCLE_ANGLE)
        if not burning < room:
            limit = f"less than {degrees(room):g} deg with the ignition delay"
            raise InputError("engine.burn_duration", f"{degrees(self.burn_duration):g} deg", limit)

    @property
    def linkage(self) -> SliderCrank:
        return SliderCrank(self.crank_radius, self.rod_length, self.pin_offset)

    @property
    def stroke(self) -> float:
        return self.linkage.stroke

    @property
    def piston_area(self) -> float:
        return 0.25 * pi * self.bore**2

    @property
    def displacement(self) -> float:
        """Swept volume of one cylinder, m3."""
        return self.piston_area * self.stroke

    @property
    def clearance(self) -> float:
        """Height of the gas over the piston at its top dead centre, m."""
        return self.stroke / (self.compression_ratio - 1.0)

    @property
    def reciprocating_mass(self) -> float:
        return self.piston_mass + (1.0 - self.rod_big_end_share) * self.rod_mass

    @property
    def intake_window(self) -> tuple[float, float]:
        """Crank angles at which the intake valve opens and closes, rad."""
        if self.intake_lift_table is not None:
            return self.intake_lift_table[0][0], self.intake_lift_table[-1][0]
        return self.intake_valve_open, self.intake_valve_close

    @property
    def exhaust_window(self) -> tuple[float, float]:
        """Crank angles at which the exhaust valve opens and closes, rad."""
        if self.exhaust_lift_table is not None:
            return self.exhaust_lift_table[0][0], self.exhaust_lift_table[-1][0]
        return self.exhaust_valve_open, self.exhaust_valve_close

    def volume(self, theta: ArrayLike) -> Array:
        """Gas volume of the cylinder at crank angles (rad), any shape, m3."""
        return np.asarray(self.piston_area * (self.clearance + self.linkage.travel(theta)))

    def volume_rate(self, theta: ArrayLike) -> Array:
        """Derivative of the gas volume by the crank angle, m3/rad."""
        return np.asarray(self.piston_area * self.linkage.travel_rate(theta))

    def inertia_torque(self, theta: ArrayLike, crank_speed: float) -> Array:
        """Torque of one reciprocating mass on the crank at constant speed, exact, N m."""
        acceleration = crank_speed**2 * self.linkage.travel_acceleration(theta)
        force = -self.reciprocating_mass * acceleration
        return np.asarray(force * self.linkage.travel_rate(theta))

    def reciprocating_inertia(self, theta: ArrayLike) -> Array:
        """m x'^2 of all reciprocating masses, what they add to the crank's inertia, kg m2."""
        at = np.asarray(theta, dtype=float)
        rates = [self.linkage.travel_rate(at - offset) for offset in self.firing_offsets]
        return np.asarray(self.reciprocating_mass * sum(rate**2 for rate in rates))


def _guard_lift_table(field: str, table: LiftTable) -> None:
    """Refuse a lift table that does not open from the seat and close upon it again."""
    if len(table) < 4:
        raise InputError(field, f"{len(table)} rows", "4 rows or more")
    if not all(isfinite(angle) and 0.0 <= lift < inf for angle, lift in table):
        raise InputError(field, "a cell", "a finite angle and a lift >= 0 m")
    if not all(here[0] < there[0] for here, there in pairwise(table)):
        raise InputError(field, "angles", "strictly increasing")
    if table[0][1] != 0.0 or table[-1][1] != 0.0:
        raise InputError(field, "first and last lift", "0 m")


# What to lay over the defaults for a small naturally aspirated diesel, as keyword arguments.
COMPRESSION_IGNITION: dict[str, Any] = {
    "ignition": "compression",
    "compression_ratio": 20.0,
    "intake_pressure": 98.0e3,
    "spark": radians(342.0),
    "ignition_delay": radians(8.0),
    "burn_duration": radians(60.0),
    "wiebe_a": 5.0,
    "wiebe_m": 0.9,
    "premixed_share": 0.35,
    "combustion_efficiency": 0.98,
    "air_fuel_ratio": 40.0,
    "lower_heating_value": 42.8e6,
}
