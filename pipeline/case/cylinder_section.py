"""The lumped single-cylinder engine of a case file, and a torque read from a file."""

from __future__ import annotations

from math import radians
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field

from camwright.pipeline.base.quantities import (
    Angle,
    Duration,
    Force,
    Fraction,
    GasPressure,
    In,
    Length,
    Mass,
    Positive,
    Share,
    Temperature,
)
from camwright.pipeline.case.section import FileName, Section

if TYPE_CHECKING:
    from camwright.pipeline.engine.cylinder import CylinderEngine


class LiftPoint(Section):
    """One row of a valve's lift table, at the valve."""

    angle: Angle
    lift: Annotated[float, In("mm", at_least=0, at_most=1000)]


LiftRows = Annotated[tuple[LiftPoint, ...], Field(strict=False, max_length=720)]


class TorqueTable(Section):
    """Engine torque over one cycle, from a file: crank angle column, torque column."""

    kind: Literal["table"] = "table"
    file: FileName


class EngineKind(Section):
    """What an engine section starts with, as a case is written back and hashed.

    Fields come in the order of the bases from the last to the first: this one is named last.
    """

    kind: str


class CrankDrive(Section):
    """Piston, rod and crank of each cylinder, and when the cylinders fire."""

    bore: Length
    crank_radius: Length
    rod_length: Length
    compression_ratio: Annotated[float, In(above=1, at_most=40)]
    piston_mass: Mass
    rod_mass: Mass
    pin_offset: Annotated[float, In("mm", above=-1000, below=1000)] = 0.0
    rod_big_end_share: Share = 2.0 / 3.0
    firing_offsets: Annotated[tuple[Angle, ...], Field(strict=False, min_length=1)] = (0.0,)


class Cylinder(CrankDrive, EngineKind):
    """Lumped single-cylinder model; crank angle 0 is the top dead centre where intake starts."""

    kind: Literal["cylinder"] = "cylinder"
    intake_valve_open: Angle = 0.0
    intake_valve_close: Angle = radians(220.0)
    exhaust_valve_open: Angle = radians(470.0)
    exhaust_valve_close: Angle = radians(720.0)
    valve_lift: Length = 0.0055
    intake_lift_table: LiftRows = ()
    exhaust_lift_table: LiftRows = ()
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
    combustion_efficiency: Fraction = 0.9
    air_fuel_ratio: Annotated[float, In(above=1, at_most=1000)] = 13.5
    lower_heating_value: Annotated[float, In("MJ/kg", above=0, at_most=1000)] = 43.5e6

    heat_loss: Literal["hohenberg", "woschni"] = "hohenberg"
    heat_loss_factor: Annotated[float, In(at_least=0, at_most=100)] = 1.0
    friction_pressure: Annotated[float, In("kPa", at_least=0, at_most=1e4)] | None = None
    dipper_area: Annotated[float, In("mm^2", at_least=0, at_most=1e6)] = 0.0
    dipper_radius: Length = 0.035
    dipper_drag_coefficient: Positive = 1.2
    dipper_immersion: Annotated[float, In("deg", above=0, at_most=180)] = radians(40.0)
    oil_density: Annotated[float, In("kg/m^3", above=0, at_most=1e5)] = 870.0

    def build(self) -> CylinderEngine:
        """The engine as the cycle model takes it; no friction pressure means the closing one."""
        from camwright.pipeline.engine.cylinder import CylinderEngine

        tables = ("intake_lift_table", "exhaust_lift_table")
        values = self.model_dump(exclude={"kind", "friction_pressure", *tables})
        for name in tables:
            rows = tuple((row.angle, row.lift) for row in getattr(self, name))
            values[name] = rows or None
        pressure = self.friction_pressure
        return CylinderEngine(**values, friction="closing" if pressure is None else pressure)
