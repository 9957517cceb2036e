"""One cylinder of a four-stroke engine: what is known of it before its cycle is solved."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians
from typing import Literal

from geometry.linkage import SliderCrank

Ignition = Literal["spark", "compression"]
HeatLoss = Literal["hohenberg", "woschni"]
Friction = Literal["closing"] | float
LiftTable = tuple[tuple[float, float], ...]

CYCLE_ANGLE = 4.0 * pi


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

    intake_pressure: float = 28.0e3
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

    @property
    def linkage(self) -> SliderCrank:
        return SliderCrank(self.crank_radius, self.rod_length, self.pin_offset)


COMPRESSION_IGNITION: dict[str, float | str] = {
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
