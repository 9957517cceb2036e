"""The engine of a case file: a model, or what was measured of it; and its crankshaft."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import radians
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Angle, GasPressure, In, Share
from camwright.pipeline.case.cylinder_section import CrankDrive, Cylinder, EngineKind, TorqueTable
from camwright.pipeline.case.section import FileName, Section

if TYPE_CHECKING:
    from camwright.pipeline.engine.cylinder import CylinderEngine
    from camwright.pipeline.engine.speed_trace import Filter
    from camwright.pipeline.engine.trigger_wheel import TriggerWheel

Prefix = Annotated[str, Field(max_length=80)]
Harmonics = Annotated[int, Field(ge=1, le=180)]


class _PressureFile(EngineKind):
    """The file of a measured cylinder pressure, and how it is read."""

    file: FileName
    column: Prefix = ""
    angle_unit: Prefix = ""
    pressure_unit: Prefix = ""
    firing_angle: Angle = radians(360.0)
    gap_max: Annotated[float, In("deg", above=0, at_most=90)] = radians(20.0)
    dead_centre: Literal["given", "symmetry", "loss_angle"] = "given"
    motored_file: FileName | None = None
    loss_angle: Annotated[float, In("deg", at_least=0, at_most=5)] = radians(0.6)


class PressureTable(CrankDrive, _PressureFile):
    """Cylinder pressure against crank angle, from a file: one column a cycle, or cycles in a row.

    `angle_unit` and `pressure_unit` together say that the file has no header. With an
    `intake_pressure` each cycle is pegged to it; without, the file is taken as absolute.
    """

    kind: Literal["pressure"] = "pressure"
    intake_pressure: GasPressure | None = None
    crankcase_pressure: GasPressure = 101.3e3
    friction_pressure: Annotated[float, In("kPa", at_least=0, at_most=1e4)] | None = None

    @model_validator(mode="after")
    def _hangs_together(self) -> Self:
        if bool(self.angle_unit) != bool(self.pressure_unit):
            raise InputError("engine.pressure_unit", self.pressure_unit, "given with angle_unit")
        if self.dead_centre != "given" and self.motored_file is None:
            raise InputError("engine.motored_file", "missing", f"given for {self.dead_centre}")
        return self

    @property
    def units(self) -> tuple[str, str] | None:
        return (self.angle_unit, self.pressure_unit) if self.angle_unit else None

    def build(self) -> CylinderEngine:
        """The running gear as the cycle model has it; its gas and valves are not used."""
        from camwright.pipeline.engine.cylinder import CylinderEngine

        names = (*CrankDrive.model_fields, "crankcase_pressure")
        given = {name: getattr(self, name) for name in names}
        if self.intake_pressure is not None:
            given["intake_pressure"] = self.intake_pressure
        pressure = self.friction_pressure
        return CylinderEngine(**given, friction="closing" if pressure is None else pressure)


class _WheelTable(Section):
    """What tooth times and sensor voltage share: the wheel and the filter."""

    file: FileName
    teeth: Annotated[int, Field(ge=4, le=720)] = 36
    missing_teeth: Annotated[int, Field(ge=0, le=180)] = 0
    reference_angle: Angle = 0.0
    harmonics: Harmonics = 20
    taper: Share = 0.25

    def wheel(self) -> TriggerWheel:
        from camwright.pipeline.engine.trigger_wheel import TriggerWheel

        return TriggerWheel(self.teeth, self.missing_teeth, self.reference_angle)

    def band(self) -> Filter:
        from camwright.pipeline.engine.speed_trace import Filter

        return Filter(self.harmonics, self.taper)


class SpeedTable(_WheelTable):
    """Crank speed from a file: tooth times, or speed per tooth against crank angle."""

    kind: Literal["speed"] = "speed"
    column: Prefix = ""
    speed_unit: Prefix = ""
    edges: Annotated[int, Field(ge=1, le=2)] = 2
    tooth_share: Annotated[float, In(above=0, below=1)] = 0.5
    averaged_over: Annotated[float, In("deg", at_least=0, at_most=60)] = 0.0
    reference_file: FileName | None = None

    def wheel(self) -> TriggerWheel:
        return replace(super().wheel(), tooth_share=self.tooth_share)


class VoltageTable(_WheelTable):
    """Raw voltage of a variable-reluctance pick-up at the wheel, from a file."""

    kind: Literal["voltage"] = "voltage"
    threshold: Annotated[float, In(above=0, below=1)] = 0.25


Engine = Annotated[
    TorqueTable | Cylinder | PressureTable | SpeedTable | VoltageTable, Field(discriminator="kind")
]
KINDS = ("cylinder", "table", "pressure", "speed", "voltage")


def engine_files(engine: Engine | None) -> Iterator[tuple[str, str]]:
    """Dotted field and name of every file an engine draws in."""
    if engine is None or isinstance(engine, Cylinder):
        return
    yield "engine.file", engine.file
    if isinstance(engine, PressureTable) and engine.motored_file is not None:
        yield "engine.motored_file", engine.motored_file
    if isinstance(engine, SpeedTable) and engine.reference_file is not None:
        yield "engine.reference_file", engine.reference_file
