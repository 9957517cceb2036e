"""Engine section of a case file: cylinder model or measurement."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from camwright.pipeline.case.section import Table
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import TorqueTable
from camwright.pipeline.engine.pickup_voltage import VoltageTable
from camwright.pipeline.engine.pressure_trace import PressureTable
from camwright.pipeline.engine.speed_file import SpeedTable

Engine = Annotated[
    Table[TorqueTable]
    | Table[CylinderEngine]
    | Table[PressureTable]
    | Table[SpeedTable]
    | Table[VoltageTable],
    Field(discriminator="kind"),
]
KINDS = ("cylinder", "table", "pressure", "speed", "voltage")


def engine_files(engine: Engine | None) -> Iterator[tuple[str, str]]:
    """Key and file name of every file that an engine refers to."""
    if engine is None or isinstance(engine, CylinderEngine):
        return
    yield "engine.file", engine.file
    if isinstance(engine, PressureTable) and engine.motored_file is not None:
        yield "engine.motored_file", engine.motored_file
    if isinstance(engine, (SpeedTable, VoltageTable)) and engine.reference is not None:
        yield "engine.reference.file", engine.reference.file
