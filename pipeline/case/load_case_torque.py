"""Engine torque of a load case, modelled or measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.case.engine_section import Engine
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.case.speed_notes import calibration_record, speed_notes
from camwright.pipeline.case.torque_section import ShaftTorque, shaft_torque
from camwright.pipeline.engine import (
    combustion,
    cylinder,
    heat_loss,
    indicated_cycle,
    indicated_cycle_solver,
    valves,
    working_gas,
)
from camwright.pipeline.engine import engine_torque as engine_torque_module
from camwright.pipeline.engine.brake_balance import BrakeBalance, brake_balance
from camwright.pipeline.engine.crankshaft import Crankshaft
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import (
    TorqueTable,
    torque_from_csv,
    torque_from_cylinder,
)
from camwright.pipeline.engine.indicated_cycle_solver import SPEED_RANGE
from camwright.pipeline.engine.pickup_voltage import VoltageTable, speed_from_voltage
from camwright.pipeline.engine.pressure_trace import (
    PressureTable,
    PressureTrace,
    cycle_statistics,
    dead_centre_offset,
    pressure_from_csv,
    torque_from_pressure,
)
from camwright.pipeline.engine.speed_file import SpeedTable, speed_from_csv
from camwright.pipeline.engine.speed_trace import SpeedTrace
from camwright.pipeline.records.run_summary import Measurement, WheelRecording
from camwright.pipeline.torque import torque as torque_module
from camwright.pipeline.torque.period import Period
from camwright.pipeline.torque.tabled_torque import TabledTorqueFile
from camwright.pipeline.torque.torque import Torque, over_cam_turn, together

_COMPONENT = "component."
_MODULES = (
    *(cylinder, working_gas, valves, combustion, heat_loss),
    *(indicated_cycle, indicated_cycle_solver, engine_torque_module, torque_module),
)
RIPPLE_MIN = 1e-6  # N m; no machine has less
ROUND_OFF = 1e-9  # of the greatest torque
CRANKING = SPEED_RANGE[0]
"""Cranking speed of an engine at rest, rad/s."""


class TorqueSource(Protocol):
    """Sections of a case that determine its torque."""

    @property
    def engine(self) -> Engine | None: ...

    @property
    def torque(self) -> ShaftTorque | None: ...

    @property
    def crankshaft(self) -> Crankshaft | None: ...

    @property
    def load_cases(self) -> tuple[LoadCase, ...]: ...

    @property
    def balances(self) -> bool: ...

    @property
    def period(self) -> Period: ...

    def path(self, name: str) -> Path: ...


def engine_torques(case: TorqueSource) -> dict[str, Torque]:
    """Torque of each load case by name; empty where the case states the lift.

    A load case at speed 0 has a torque only from a file, or of a cylinder model cranked unfired.
    """
    if not case.balances:
        return {}
    return {
        state.name: engine_torque(case, state)
        for state in case.load_cases
        if has_torque(case, state)
    }


def engine_torque(case: TorqueSource, state: LoadCase) -> Torque:
    """Torque of engine and machine in a load case, over a cam turn.

    Raises
    ------
    InputError
        If a file cannot be read or has wrong contents; by file and line.
    """
    return over_cam_turn(_torque_of_cycle(case, state), case.period)


def torque_key(case: TorqueSource, load_case: str) -> str:
    """Key of the case, such as `engine.file`, that supplies the torque of the load case of this
    name.
    """
    number = [state.name for state in case.load_cases].index(load_case)
    if case.load_cases[number].torque is not None:
        return f"load_case[{number}].torque"
    key, source = ("torque", case.torque) if case.engine is None else ("engine", case.engine)
    return f"{key}.file" if hasattr(source, "file") else key


def require_ripple(case: TorqueSource, torques: Mapping[str, Torque]) -> None:
    """Refuse a torque that is constant to round-off, where its ripple is to be minimised.

    Parameters
    ----------
    torques : mapping   torque by load case

    Raises
    ------
    InputError
        By the key of the torque, in a load case whose ripple counts or is to be reduced.
    """
    for state in case.load_cases:
        counts = state.ripple_weight > 0.0 or state.torque_reduction
        if not counts or state.name not in torques:
            continue
        total = torques[state.name].total
        if float(np.ptp(total)) > max(RIPPLE_MIN, ROUND_OFF * float(np.abs(total).max())):
            continue
        text = f"a constant torque of {float(total.mean()):.4g} N m"
        limit = "one that varies over the cycle, for smoothing.kind = constrained: there is no"
        limit += " ripple to balance"
        raise InputError(torque_key(case, state.name), text, limit)


def _torque_of_cycle(case: TorqueSource, state: LoadCase) -> Torque:
    """Torque at the shaft in a load case over a cycle, N m, of engine and driven machine together;
    a file of the load case replaces both.
    """
    machine = case.torque
    if state.torque is not None:
        if machine is None:
            return torque_from_csv(case.path(state.torque))
        source = TabledTorqueFile(file=state.torque, cycle=case.period.angle)
        return shaft_torque(source, state.speed, case.path)
    if machine is None:
        return _of_engine(case, state)
    own = shaft_torque(machine, state.speed, case.path)
    return own if case.engine is None else together(own, _of_engine(case, state))


def _of_engine(case: TorqueSource, state: LoadCase) -> Torque:
    """Torque of the engine in a load case over a cycle, N m, by its kind: table, cylinder model,
    measured pressure or measured crank speed.
    """
    engine = case.engine
    if isinstance(engine, TorqueTable):
        return torque_from_csv(case.path(engine.file))
    if isinstance(engine, CylinderEngine):
        return _cylinder_torque(_loaded(engine, state), state.speed or CRANKING)
    if isinstance(engine, PressureTable):
        balance, trace = pressure(case, engine)
        return torque_from_pressure(trace, engine, state.speed, balance.brake or 0.0)
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is not None:
        return crank_speed(case, engine).torque(case.crankshaft.inertia)
    raise InputError("engine", "missing", "given")


def _cylinder_torque(engine: CylinderEngine, speed: float) -> Torque:
    """Torque of a cylinder model over a cycle at a crank speed, rad/s; kept in the disk cache."""

    def compute() -> dict[str, Array]:
        """Angles, rad, components of the torque, N m, and varying inertia, kg m2, by name."""
        torque = torque_from_cylinder(engine, speed)
        arrays = {_COMPONENT + name: part for name, part in torque.components.items()}
        if torque.varying_inertia is not None:
            arrays["varying_inertia"] = torque.varying_inertia
        return arrays | {"theta": torque.theta}

    kept = disk_cache.kept("torque", (engine, speed), compute, _MODULES)
    parts = {
        name.removeprefix(_COMPONENT): part
        for name, part in kept.items()
        if name.startswith(_COMPONENT)
    }
    return Torque(kept["theta"], parts, kept.get("varying_inertia"))


def has_torque(case: TorqueSource, state: LoadCase) -> bool:
    """Whether a load case has an engine torque: running, or cranked."""
    cranked = isinstance(case.engine, CylinderEngine) and not state.fired
    return state.speed > 0 or state.torque is not None or cranked


def _loaded(engine: CylinderEngine, state: LoadCase) -> CylinderEngine:
    """Engine with the intake pressure of a load case; where this is not fired, without heat of
    combustion and with the stated friction, or none.
    """
    if state.intake_pressure is not None:
        engine = replace(engine, intake_pressure=state.intake_pressure)
    if state.fired:
        return engine
    # The starter drives an unfired engine: no friction could close the torque balance.
    friction = engine.friction_pressure or 0.0
    return replace(engine, combustion_efficiency=0.0, friction_pressure=friction)


def pressure(case: TorqueSource, engine: PressureTable) -> tuple[BrakeBalance, PressureTrace]:
    """Measured cylinder pressure of a case, pegged and checked, with its brake balance.

    A brake power is that at the speed of the first load case.

    Raises
    ------
    InputError
        As `pressure_from_csv`, `PressureTrace.guarded` and `BrakeBalance.guarded`.
    """

    def read(name: str) -> PressureTrace:
        return pressure_from_csv(
            case.path(name),
            column=engine.column,
            units=engine.units,
            firing_angle=engine.firing_angle,
            gap_max=engine.gap_max,
        )

    trace = read(engine.file)
    motored = None if engine.motored_file is None else read(engine.motored_file)
    if motored is not None and engine.dead_centre != "given":
        offset = dead_centre_offset(motored, engine.dead_centre, engine.loss_angle)
        trace, motored = trace.turned(offset), motored.turned(offset)
    if engine.intake_pressure is None:
        trace = trace.guarded()
    else:
        trace = trace.pegged(engine.intake_pressure).guarded()
        trace.guard_scale(engine, engine.intake_pressure)
    brake = engine.brake(case.load_cases[0].speed)
    balance = brake_balance(trace, engine, brake, motored)
    field = "engine.brake_torque" if engine.brake_power is None else "engine.brake_power"
    return balance.guarded(field), trace


def crank_speed(case: TorqueSource, engine: SpeedTable | VoltageTable) -> SpeedTrace:
    """Measured crank speed of a case over the cycle, from tooth times or the voltage of a pick-up;
    InputError without the inertia of the crankshaft.
    """
    if case.crankshaft is None:
        raise InputError("crankshaft.inertia", "missing", "given")
    calibrator = engine.calibrator(case.crankshaft.inertia, case.path)
    if isinstance(engine, VoltageTable):
        return speed_from_voltage(case.path(engine.file), engine, calibrator)
    return speed_from_csv(
        case.path(engine.file),
        engine.wheel,
        engine.band,
        both_edges=engine.edges == 2,
        column=engine.column,
        unit=engine.speed_unit,
        averaged_over=engine.averaged_over,
        calibrator=calibrator,
    )


def measurement_record(case: TorqueSource) -> Measurement | None:
    """Statistics of a measured pressure or speed for ``run.json``; None for a model."""
    engine = case.engine
    if isinstance(engine, PressureTable):
        balance, trace = pressure(case, engine)
        statistics = cycle_statistics(trace, engine)
        return {
            "kind": engine.kind,
            "cycles": int(trace.cycles.shape[0]),
            "imep_mean_kPa": 1e-3 * float(statistics.imep.mean()),
            "imep_std_kPa": 1e-3 * statistics.imep_std,
            "imep_cov_percent": 100.0 * statistics.imep_variation,
            "peak_mean_MPa": 1e-6 * float(statistics.peak.mean()),
            "peak_angle_mean_deg": float(np.degrees(statistics.peak_angle.mean())),
            "scatter_max_kPa": 1e-3 * float(trace.scatter.max()),
            "pegging_mean_kPa": 1e-3 * float(np.mean(trace.pegging)),
            "dead_centre": engine.dead_centre,
            "turned_by_deg": float(np.degrees(trace.offset)),
            **balance.as_record(),
        }
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is not None:
        speed, inertia = crank_speed(case, engine), case.crankshaft.inertia
        bar = float(speed.error_bar(inertia).max())
        return {
            "kind": engine.kind,
            "cycles": speed.count,
            **_recording(speed),
            "mean_rad_per_s": speed.statistics.mean,
            "std_rad_per_s": speed.statistics.std,
            "p2p_rad_per_s": speed.statistics.peak_to_peak,
            "scatter_max_rad_per_s": float(speed.scatter.max()),
            "tooth_noise_rad_per_s": speed.noise,
            "bandwidth_Hz": speed.bandwidth,
            "bandwidth_harmonics_of_cycle": speed.filter.harmonics,
            "noise_amplification_Nm_per_rad_per_s": speed.noise_amplification(inertia),
            "torque_noise_floor_Nm": speed.noise_floor(inertia),
            "torque_error_bar_max_Nm": bar,
            "torque_error_bar_percent": 100.0 * bar / speed.torque(inertia).peak_to_peak,
            "torque_wheel_bar_max_Nm": float(speed.wheel_bar(inertia).max()),
            "half_orders_percent": 100.0 * speed.half_order_share,
            **calibration_record(speed.calibration),
            "notes": list(speed_notes(speed, inertia, engine.running_gear)),
        }
    return None


def measurement_words(case: TorqueSource) -> Iterator[str]:
    """Lines of text on a measurement: indicated torque, trigger wheel, working cycle."""
    engine = case.engine
    if isinstance(engine, PressureTable):
        yield pressure(case, engine)[0].words()
    if isinstance(engine, (SpeedTable, VoltageTable)) and case.crankshaft is not None:
        trace = crank_speed(case, engine)
        yield from speed_notes(trace, case.crankshaft.inertia, engine.running_gear)


def _recording(speed: SpeedTrace) -> WheelRecording:
    """Runs, tooth pattern and sampling rate of a recorded trigger wheel, for ``run.json``; empty
    for a table of speeds.
    """
    recording = speed.recording
    if recording is None:
        return {}
    known: WheelRecording = {"runs": recording.runs, "wheel": recording.pattern.words}
    if recording.sampling_rate is not None:
        known["sampling_rate_Hz"] = recording.sampling_rate
    return known
