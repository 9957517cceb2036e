"""Crank speed with and without the mechanism; consistency of the inputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, readonly, uniform_turn
from camwright.geometry.errors import CamError, InputError
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.periodic_spline import periodic_quintic
from camwright.pipeline.base.tables import CRANK_ANGLE, Column
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.engine.crankshaft import (
    CrankMotion,
    Crankshaft,
    Inertia,
    Load,
    MechanismTorque,
    StallError,
    crank_motion,
    equivalent_inertia,
)
from camwright.pipeline.engine.torque_consistency import (
    Implied,
    energy_finding,
    inertia_finding,
    ratio_finding,
    work_finding,
)
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    Rubbing,
    follower_loads,
    torque_on_cam,
)
from camwright.pipeline.torque.motor_line import MotorLine
from camwright.pipeline.torque.period import FOUR_STROKE
from camwright.pipeline.torque.torque import Torque

POSITIONS = 720


@dataclass(frozen=True, eq=False)
class SpeedStudy:
    """Crank motions under one engine torque: alone, with the follower's inertia, with the cam.

    Parameters
    ----------
    before : CrankMotion           engine alone
    inertia_alone : CrankMotion    with the rotating parts of the mechanism, without cam force
    after : CrankMotion            with the cam
    added_inertia : float          kg m2, of a flywheel with which the engine alone has the standard
                                   deviation of the speed with the cam
    """

    before: CrankMotion
    inertia_alone: CrankMotion
    after: CrankMotion
    added_inertia: float

    def columns(self) -> dict[Column, Array]:
        """Columns of ``1_speed.csv``."""
        return {
            CRANK_ANGLE: self.before.theta,
            Column("speed_before", "rad/s", "Crank speed of the engine alone"): self.before.speed,
            Column(
                "speed_inertia_alone",
                "rad/s",
                "Crank speed with the inertia of the mechanism alone",
            ): self.inertia_alone.speed,
            Column("speed_after", "rad/s", "Crank speed with the cam"): self.after.speed,
        }

    def flywheel_masses(self, outer_radius: float) -> tuple[float, float]:
        """Mass (kg) of the equivalent flywheel as disc and as thin rim of an outer radius (m)."""
        return 2.0 * self.added_inertia / outer_radius**2, self.added_inertia / outer_radius**2


def follower_inertia(
    pitch: FollowerPath, system: FollowerSystem, gear_ratio: float, count: int
) -> Array:
    """Inertia of the follower at the crank, m (ds/dtheta_crank)^2, kg m2, at equal cam angles."""
    theta = uniform_turn(count)
    mass, slope = system.moving_mass(pitch.lift(theta)), pitch.lift(theta, 1) / gear_ratio
    return np.asarray(mass * slope**2)


def mechanism_torque(
    pitch: FollowerPath, system: FollowerSystem, gear_ratio: float, count: int
) -> MechanismTorque:
    """Function of crank speed (count,), rad/s, and acceleration (count,), rad/s2, at equal angles
    of a cam turn, for the torque of spring, weight, external force and friction on the crank, N m.

    The inertia of the follower is in J(theta), not in this torque. Friction depends on the contact
    force, and thus on speed and acceleration of the crank.

    Parameters
    ----------
    gear_ratio : float   crank speed over cam speed
    """
    on_cam = torque_on_cam(pitch, system, uniform_turn(count))

    def torque(speed: Array, acceleration: Array) -> Array:
        return on_cam(speed / gear_ratio, acceleration / gear_ratio) / gear_ratio

    return torque


def speed_study(
    torque: Array,
    inertia: Inertia,
    mean_speed: float,
    pitch: FollowerPath,
    system: FollowerSystem,
    *,
    gear_ratio: float = 2.0,
    mechanism_inertia: float = 0.0,
    load: Load | MotorLine = Load(),  # noqa: B008 - frozen
    span: float = FOUR_STROKE.angle,
) -> SpeedStudy:
    """Crank speed without the mechanism, with its inertia alone, and with the cam.

    Parameters
    ----------
    torque : array (n,)                            N m at equal shaft angles of a cam turn, without
        the torque of `inertia`
    inertia : Inertia                              of the engine, at the same angles
    mean_speed : float                             of the crank, rad/s
    pitch, system : FollowerPath, FollowerSystem   motion of the follower on the cam, and what acts
        on it
    gear_ratio : float                             crank speed over cam speed
    mechanism_inertia : float                      kg m2, of the rotating parts of the mechanism, at
        the crank
    load : Load or MotorLine                       torque that the engine drives, by speed
    span : float                                   rad of the shaft in a cam turn

    Raises
    ------
    CamError
        If the engine stalls.
    """
    before = crank_motion(torque, inertia, mean_speed, load=load, span=span)
    mounted = inertia.plus(mechanism_inertia)
    alone = crank_motion(torque, mounted, mean_speed, load=load, span=span)
    after = _motion_with_cam(torque, mounted, mean_speed, pitch, system, gear_ratio, load, span)
    std = after.statistics.std
    needed = equivalent_inertia(before.net_torque, mean_speed, std, span) if std > 0 else np.inf
    return SpeedStudy(before, alone, after, needed - inertia.mean)


def _motion_with_cam(
    torque: Array,
    mounted: Inertia,
    mean_speed: float,
    pitch: FollowerPath,
    system: FollowerSystem,
    gear_ratio: float,
    load: Load | MotorLine,
    span: float,
) -> CrankMotion:
    """Motion of the crank with the cam; `mounted` includes the rotating parts of the mechanism."""
    follower = follower_inertia(pitch, system, gear_ratio, torque.size)
    return crank_motion(
        torque,
        mounted.plus(0.0, follower),
        mean_speed,
        load=load,
        mechanism=mechanism_torque(pitch, system, gear_ratio, torque.size),
        span=span,
    )


def study_of(
    machine: Machine, pitch: FollowerPath, rubbing: Rubbing | None = None
) -> SpeedStudy | None:
    """Crank speed study of one load case; None without a crankshaft or torque.

    Guide friction follows from `rubbing`, without it from point supports. Reciprocating masses that
    the engine states are part of J(theta); their inertia torque at constant speed is subtracted.
    """
    shaft, torque = machine.crankshaft, machine.torque
    if shaft is None or torque is None:
        return None
    values, inertia = _driving(torque, shaft.inertia)
    return speed_study(
        values,
        inertia,
        machine.speed,
        pitch,
        replace(machine.system, rubbing=rubbing),
        gear_ratio=machine.gear_ratio,
        mechanism_inertia=shaft.mechanism_inertia,
        load=shaft.load,
        span=torque.span,
    )


def _driving(torque: Torque, constant: float) -> tuple[Array, Inertia]:
    """Engine torque over the cycle (n,), N m, without that of the varying inertia, and the inertia
    of the engine with that part; constant : inertia, kg m2.
    """
    if torque.varying_inertia is None:
        return torque.total, Inertia(constant, np.zeros(torque.theta.size))
    without = torque.total - torque.components["inertia"]
    return without, Inertia(constant, torque.varying_inertia)


class DrivenCam(NamedTuple):
    """Cam speed (n,), rad/s, and cam angle of a stall, rad; None: the crank turns."""

    speed: Array
    stall: float | None = None


def driven_cam(machine: Machine, pitch: FollowerPath, rubbing: Rubbing) -> DrivenCam:
    """Cam speed (n,), rad/s, at equal angles of the turn, with the cam driven through the inertia
    of the crank, and the angle of a stall.

    With a torque and a crankshaft the speed is that of the crank with the cam; constant without
    them, and where the crank stalls, whose loads no check may rest on.
    """
    steady = readonly(np.full(rubbing.theta.size, machine.cam_speed))
    torque, shaft = machine.torque, machine.crankshaft
    if torque is None or shaft is None or not machine.speed > 0:
        return DrivenCam(steady)
    try:
        _, after = _motions(machine, shaft, torque, pitch, rubbing)
    except StallError as stall:
        return DrivenCam(steady, stall.crank_angle / machine.gear_ratio % FULL_TURN)
    except InputError:  # an engine torque that does not vary
        return DrivenCam(steady)
    return DrivenCam(readonly(periodic_quintic(after.speed)(rubbing.theta) / machine.gear_ratio))


@dataclass(frozen=True, eq=False)
class SpeedRipple(Mapping[str, tuple[float, float]]):
    """Standard deviation of the crank speed, rad/s, by load case: engine alone, with the cam.

    Empty without a crankshaft; NaN for a load case that stalls. Computed when it is first read.
    """

    machines: Sequence[Machine]
    pitch: FollowerPath
    rubbing: Mapping[str, Rubbing]

    @cached_property
    def _ripple(self) -> dict[str, tuple[float, float]]:
        """Standard deviations of the crank speed by load case; those at standstill are left out."""
        ripple: dict[str, tuple[float, float]] = {}
        for machine in self.machines:
            name, shaft, torque = machine.load_case, machine.crankshaft, machine.torque
            if shaft is None or torque is None or not machine.speed > 0:
                continue
            try:
                motions = _motions(machine, shaft, torque, self.pitch, self.rubbing.get(name))
            except CamError:
                ripple[name] = (np.nan, np.nan)
            else:
                before, after = (each.statistics.std for each in motions)
                ripple[name] = (before, after)
        return ripple

    def __getitem__(self, load_case: str) -> tuple[float, float]:
        return self._ripple[load_case]

    def __iter__(self) -> Iterator[str]:
        return iter(self._ripple)

    def __len__(self) -> int:
        return len(self._ripple)


def _motions(
    machine: Machine,
    shaft: Crankshaft,
    torque: Torque,
    pitch: FollowerPath,
    rubbing: Rubbing | None,
) -> tuple[CrankMotion, CrankMotion]:
    """Motion of the crank without and with the cam, as of `study_of`.

    Raises
    ------
    CamError
        If the engine stalls, or its torque is constant.
    """
    values, inertia = _driving(torque, shaft.inertia)
    speed, load = machine.speed, shaft.load
    before = crank_motion(values, inertia, speed, load=load, span=torque.span)
    if not np.ptp(before.net_torque) > 0.0:
        raise InputError("engine_torque", "constant", "a torque that varies over the cycle")
    mounted = inertia.plus(shaft.mechanism_inertia)
    system = replace(machine.system, rubbing=rubbing)
    ratio, span = machine.gear_ratio, torque.span
    after = _motion_with_cam(values, mounted, speed, pitch, system, ratio, load, span)
    return before, after


def consistency(
    machine: Machine,
    pitch: FollowerPath,
    study: SpeedStudy | None,
    *,
    demand: Array | None = None,
    rubbing: Rubbing | None = None,
    measured: bool = False,
) -> tuple[Implied, ...]:
    """Findings on inertia, power, energy and work against the values implied by other inputs.

    Empty without a torque.

    Parameters
    ----------
    study : SpeedStudy or None    for the work of the mechanism; None: not compared
    demand : array (n,) or None   crank torque about its mean, N m, for which the lift is drawn;
        None where limits shape the lift: power and energy are then not compared, as for a torque of
        zero
    rubbing : Rubbing or None     normal loads of the guides; None: those of point supports
    measured : bool               the measured speed is that of this load case
    """
    ratio, shaft, torque = machine.gear_ratio, machine.crankshaft, machine.torque
    if torque is None:
        return ()
    system = replace(machine.system, rubbing=rubbing)
    theta = uniform_turn(torque.theta.size)
    loads = follower_loads(pitch, system, machine.speed / ratio, theta)
    findings = []
    if demand is not None and demand.any():
        stored = machine.spring.energy(pitch.lift.stroke) + system.dead_load * pitch.lift.stroke
        storing = loads.spring_force + system.dead_load
        findings.append(ratio_finding(demand, storing * loads.lift_slope, ratio))
        findings.append(energy_finding(demand, stored, span=torque.span))
    if study is not None:
        taken = -torque.span * float(study.after.mechanism_torque.mean())
        findings.append(work_finding(loads.friction_loss + loads.applied_work, taken))
    std = None if shaft is None else shaft.measured_speed_std
    if shaft is not None and std is not None and measured:
        balanced = torque.without_mean().total
        finding = inertia_finding(shaft.inertia, balanced, machine.speed, std, torque.span)
        findings.append(finding)
    return tuple(findings)
