"""Ripple map: torque ripple with the cam over that without, by speed and engine load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.load_case_torque import engine_torque
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.follower.follower_forces import Rubbing, follower_loads
from camwright.pipeline.records.run_summary import RippleMapRecord
from camwright.pipeline.torque.torque import Torque

ANGLES = 360
_SPEEDS, _MAP_LOADS = 25, 4  # of a map, at most
_ONE_LOAD_SHARE = 0.9  # share of the pressure at full load, from which on a case has one load only
_MODELLED = (
    "Working cycle solved at the least, mean and greatest speed, at the mean one at full load too; "
    "gas torque interpolated between them, inertia by the square of the speed."
)
_SCALED = (
    "Torque of the load case at every speed, its component of inertia by the square of the "
    "speed; the rest is taken as at the speed of the load case."
)
_FIXED = "Torque of the load case at every speed: its inertia is not separated."


@dataclass(frozen=True, eq=False)
class RippleMap:
    """Standard deviation of the crank torque without and with the cam, by speed and load.

    Parameters
    ----------
    load_case : str            whose spring preload, friction and intake pressure apply
    engine : str               origin of the engine torque, in words
    crank_speed : array (m,)   rad/s
    intake_pressure : array (k,)   Pa, by which the engine load is set; None: one load alone
    before, after : arrays (k, m)  N m
    """

    load_case: str
    engine: str
    crank_speed: Array
    intake_pressure: Array | None
    before: Array
    after: Array

    def __post_init__(self) -> None:
        freeze(self, crank_speed=self.crank_speed, before=self.before, after=self.after)

    @property
    def ratio(self) -> Array:
        """Torque ripple with the cam over that without, (k, m)."""
        return self.after / self.before

    def as_record(self) -> RippleMapRecord:
        """The JSON record."""
        pressure = self.intake_pressure
        return {
            "load_case": self.load_case,
            "engine": self.engine,
            "crank_speed_rpm": [float(in_unit(n, "rpm")) for n in self.crank_speed],
            "intake_pressure_kPa": None
            if pressure is None
            else [float(in_unit(p, "kPa")) for p in pressure],
            "ratio": self.ratio.tolist(),
            "ripple_before_Nm": self.before.tolist(),
            "ripple_after_Nm": self.after.tolist(),
        }


def ripple_map(
    case: Case, states: Sequence[Machine], pitch: FollowerPath, rubbing: Rubbing
) -> RippleMap | None:
    """Ripple map from slowest load case to over-speed; None without a running engine, and where its
    torque without the cam does not vary.

    The cam torque is quasi-static at constant speed, with follower inertia, viscous drag and guide
    friction, without surge. Of a cylinder model the load varies from that of the first running load
    case to full load, at an intake pressure of that of the exhaust.

    Parameters
    ----------
    states : sequence   machine in each load case, with its torque
    rubbing : Rubbing   of the guides, from the solved first load case

    Raises
    ------
    CamError
        If a working cycle cannot be solved.
    """
    torques = {each.load_case: each.torque for each in states if each.torque is not None}
    running = [
        state
        for state in case.load_cases
        if state.speed > 0 and state.fired and state.name in torques
    ]
    if not running:
        return None
    state = running[0]
    machine = next(each for each in states if each.load_case == state.name)
    top, least = highest_speed(states), min(each.speed for each in running)
    speeds = np.linspace(least if least < top else 0.5 * top, top, _SPEEDS)
    engine = case.engine
    if isinstance(engine, CylinderEngine) and state.torque is None:
        loads = _loads(engine, state)
        torque, words = _modelled(case, state, speeds, loads), _MODELLED
    else:
        loads = None
        torque, words = _scaled(torques[state.name], state.speed, speeds)
    cam = _cam_torque(machine, pitch, rubbing, speeds) / machine.gear_ratio
    before, after = np.std(torque, axis=-1), np.std(torque - cam, axis=-1)
    if not (before > 0.0).all():
        return None
    return RippleMap(state.name, words, speeds, loads, before, after)


def _loads(engine: CylinderEngine, state: LoadCase) -> Array:
    """Intake pressures from that of a load case to full load, Pa."""
    pressure = engine.intake_pressure if state.intake_pressure is None else state.intake_pressure
    full = engine.exhaust_pressure
    return (
        np.linspace(pressure, full, _MAP_LOADS)
        if pressure < _ONE_LOAD_SHARE * full
        else np.array([pressure])
    )


def _modelled(case: Case, state: LoadCase, speeds: Array, loads: Array) -> Array:
    """Torque of a cylinder model (loads, speeds, ANGLES), N m, at speeds, rad/s, and intake
    pressures `loads`, Pa, in increasing order; few are solved.

    The gas torque is quadratic in the speed at the least load, and linear in the load as at the
    mean speed.
    """
    middle, top = float(speeds.mean()), float(speeds[-1])

    def at(speed: float, load: float) -> tuple[Array, Array]:
        changed = {"speed": speed, "intake_pressure": load}
        return _parted(engine_torque(case, state.model_copy(update=changed)))

    bottom = float(speeds[0])
    nodes = [at(speed, float(loads[0])) for speed in (bottom, middle, top)]
    part = ((speeds - bottom) / (top - bottom))[:, None]
    gas = (
        2.0 * (part - 0.5) * (part - 1.0) * nodes[0][0]
        + 4.0 * part * (1.0 - part) * nodes[1][0]
        + 2.0 * part * (part - 0.5) * nodes[2][0]
    )
    inertia = nodes[2][1] * (speeds[:, None] / top) ** 2
    torque = (gas + inertia)[None]
    if loads.size > 1:
        more = at(middle, float(loads[-1]))[0] - nodes[1][0]
        torque = torque + ((loads - loads[0]) / (loads[-1] - loads[0]))[:, None, None] * more
    return torque


def _scaled(torque: Torque, speed: float, speeds: Array) -> tuple[Array, str]:
    """Torque of one load case at other speeds (1, speeds, ANGLES), N m, and its origin."""
    gas, inertia = _parted(torque)
    words = _SCALED if "inertia" in torque.components else _FIXED
    return (gas + inertia * (speeds[:, None] / speed) ** 2)[None], words


def _parted(torque: Torque) -> tuple[Array, Array]:
    """Torque without its mean and inertia, and the component of inertia, (ANGLES,) each, N m."""
    sampled = torque.without_mean().resampled(ANGLES)
    inertia = sampled.components.get("inertia", np.zeros(ANGLES))
    return sampled.total - inertia, inertia


def _cam_torque(machine: Machine, pitch: FollowerPath, rubbing: Rubbing, speeds: Array) -> Array:
    """Torque of the cam (speeds, ANGLES), N m, at constant crank speeds, rad/s."""
    system, theta = replace(machine.system, rubbing=rubbing), uniform_turn(ANGLES)
    return np.stack(
        [
            follower_loads(pitch, system, float(speed) / machine.gear_ratio, theta).cam_torque
            for speed in speeds
        ]
    )
