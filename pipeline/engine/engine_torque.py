"""Engine torque over one cycle, modelled or measured, as a sum of components."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from camwright.pipeline.base.quantities import FileName, Known, Part
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.indicated_cycle import CylinderCycle
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle
from camwright.pipeline.torque.angle_trace import read_trace
from camwright.pipeline.torque.torque import SAMPLES, Torque, all_cylinders, uniform_cycle


@dataclass(frozen=True, kw_only=True)
class TorqueTable(Part):
    """Engine torque over one cycle from a file: a column of crank angle, one of torque."""

    table: ClassVar[str] = "engine"

    kind: Annotated[Literal["table"], Known("own choice")] = "table"
    """origin of the engine torque"""
    file: Annotated[FileName, Known("test bench or simulation", "torque.csv")]
    """data file, relative to the case file"""


def torque_from_cycle(cycle: CylinderCycle) -> Torque:
    """Torque of an engine of equal cylinders, by component, from the cycle of one: repeated at the
    firing offsets and summed.

    Gas, inertia of the reciprocating masses, valve train, friction and, where there is one, oil
    dipper.
    """
    parts = {
        "gas": cycle.gas_torque,
        "inertia": cycle.inertia_torque,
        "valve_train": cycle.valve_train_torque,
        "friction": cycle.friction_torque,
        "dipper": cycle.dipper_torque,
    }
    if cycle.engine.dipper_area == 0.0:
        del parts["dipper"]
    return Torque(
        cycle.theta,
        all_cylinders(parts, cycle.theta, cycle.engine.firing_offsets),
        cycle.engine.reciprocating_inertia(cycle.theta),
    )


def torque_from_cylinder(engine: CylinderEngine, crank_speed: float) -> Torque:
    """Torque of an engine model at a steady crank speed (rad/s).

    Without a friction pressure the mean is zero; with one it is the brake torque, which
    `without_mean` balances by a steady load.

    Raises
    ------
    InputError
        If the speed is out of range.
    CamError
        If the working cycle does not become periodic.
    """
    return torque_from_cycle(working_cycle(engine, crank_speed))


def torque_from_csv(path: str | Path, column: str | None = None) -> Torque:
    """Measured torque over one cycle at whole crank degrees; its one component is `measured`.

    Raises
    ------
    InputError
        If the file is not one clean cycle; see `read_trace`.
    """
    trace = read_trace(path, "torque", column=column)
    return Torque(uniform_cycle(SAMPLES), {"measured": trace.uniform(SAMPLES)})
