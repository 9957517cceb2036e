"""Crank speed of a case with and without its mechanism, and whether its inputs agree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import CamError
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.periodic_spline import periodic_quintic
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.cylinder_section import Cylinder
from camwright.pipeline.case.engine_section import PressureTable
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.engine.crankshaft import (
    CrankMotion,
    Inertia,
    Load,
    MechanismTorque,
    crank_motion,
    equivalent_inertia,
)
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.engine.torque_consistency import (
    Finding,
    energy_finding,
    inertia_finding,
    ratio_finding,
    work_finding,
)
from camwright.pipeline.follower.follower_forces import FollowerSystem, Rubbing, follower_loads

POSITIONS = 720


@dataclass(frozen=True, eq=False)
class SpeedStudy:
    """Three motions of one crank under one torque.

    Parameters
    ----------
    before : CrankMotion           the engine alone
    inertia_alone : CrankMotion    with the mechanism mounted and its follower held off the cam
    after : CrankMotion            with the mechanism at work
    added_inertia : float          kg m2, of a flywheel that would steady the crank of the engine
                                   alone as much as the mechanism does
    """

    before: CrankMotion
    inertia_alone: CrankMotion
    after: CrankMotion
    added_inertia: float

    @property
    def columns(self) -> Mapping[str, Array]:
        """SI values of ``1_speed.csv``."""
        return {
            "crank_angle": self.before.theta,
            "speed_before": self.before.speed,
            "speed_inertia_alone": self.inertia_alone.speed,
            "speed_after": self.after.speed,
        }

    def flywheel_masses(self, outer_radius: float) -> tuple[float, float]:
        """Mass (kg) of that flywheel as a plain disc and as a thin rim of an outer radius (m)."""
        return 2.0 * self.added_inertia / outer_radius**2, self.added_inertia / outer_radius**2


def follower_inertia(pitch: FollowerPath, mass: float, gear_ratio: float, count: int) -> Array:
    """m (ds/dtheta_crank)^2 at equal angles of the cam turn, kg m2."""
    slope = pitch.lift(uniform_turn(count), 1) / gear_ratio
    return np.asarray(mass * slope**2)


def mechanism_torque(
    pitch: FollowerPath, system: FollowerSystem, gear_ratio: float, count: int
) -> MechanismTorque:
    """Torque of spring and friction on the crank; the follower's inertia is left to J(theta).

    Friction depends on the cam's push and so on the follower's acceleration at the speed and
    the acceleration of the crank.
    """
    theta = uniform_turn(count)

    def torque(speed: Array, acceleration: Array) -> Array:
        loads = follower_loads(pitch, system, speed / gear_ratio, theta, acceleration / gear_ratio)
        return np.asarray((loads.inertia_force * loads.lift_slope - loads.cam_torque) / gear_ratio)

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
    load: Load = Load(),  # noqa: B008 - frozen
) -> SpeedStudy:
    """Crank speed without, with the inertia of, and with a balancing cam.

    Parameters
    ----------
    torque : array (n,)          N m at equal crank angles, without the inertia that `inertia` holds
    inertia : Inertia            of the engine, at the same angles
    mean_speed : float           rad/s
    mechanism_inertia : float    kg m2, of what turns in the mechanism, at the crank

    Raises
    ------
    CamError
        If the engine would stall.
    """
    count = torque.size
    moved = follower_inertia(pitch, system.mass, gear_ratio, count)
    before = crank_motion(torque, inertia, mean_speed, load=load)
    mounted = inertia.plus(mechanism_inertia)
    alone = crank_motion(torque, mounted, mean_speed, load=load)
    after = crank_motion(
        torque,
        mounted.plus(0.0, moved),
        mean_speed,
        load=load,
        mechanism=mechanism_torque(pitch, system, gear_ratio, count),
    )
    wanted = after.statistics.std
    needed = equivalent_inertia(before.net_torque, mean_speed, wanted) if wanted > 0 else np.inf
    return SpeedStudy(before, alone, after, needed - inertia.mean)


def study_of(
    case: Case, torque: Torque, speed: float, pitch: FollowerPath, rubbing: Rubbing | None = None
) -> SpeedStudy | None:
    """The study of one load case; None where the case tells nothing of its crankshaft.

    The guides rub per side force as `rubbing` tells; without it, as point supports.

    Where the engine states its reciprocating masses they are part of J(theta), and the torque
    of their inertia at constant speed is taken out.
    """
    shaft = case.crankshaft
    if shaft is None:
        return None
    values, varying = torque.total, np.zeros(torque.theta_crank.size)
    if isinstance(case.engine, (Cylinder, PressureTable)) and "inertia" in torque.components:
        values = values - torque.components["inertia"]
        varying = case.engine.build().reciprocating_inertia(torque.theta_crank)
    return speed_study(
        values,
        Inertia(shaft.inertia, varying),
        speed,
        pitch,
        replace(FollowerSystem.from_case(case), rubbing=rubbing),
        gear_ratio=case.mechanism.gear_ratio,
        mechanism_inertia=shaft.mechanism_inertia,
        load=Load(shaft.load_exponent),
    )


def rubbing_of(turns: Iterable[Any], early: float = 0.0) -> dict[str, Rubbing]:
    """How the guides rub in each load case of these turns, of a cam `early` (rad of its own)."""
    found = {turn.load_case: turn.loads.rubbing for turn in turns}
    return {name: replace(each, theta=each.theta - early) for name, each in found.items()}


def cam_speed(
    case: Case,
    torque: Torque | None,
    speed: float,
    pitch: FollowerPath,
    rubbing: Rubbing,
) -> Array:
    """Speed of the cam at the angles of `rubbing`, equal parts of a turn, rad/s.

    That of the crank with the cam at work, where the case tells its inertia; constant where it
    does not, or where engine and inertia contradict each other.
    """
    steady = np.full(rubbing.theta.size, speed / case.mechanism.gear_ratio)
    if torque is None:
        return steady
    try:
        study = study_of(case, torque, speed, pitch, rubbing)
    except CamError:
        return steady
    if study is None:
        return steady
    return periodic_quintic(study.after.speed)(rubbing.theta) / case.mechanism.gear_ratio


def speed_record(study: SpeedStudy, radius: float) -> dict[str, Any]:
    """Contents of ``speed`` in ``run.json`` for one load case; radius (m) of the cam."""
    found: dict[str, Any] = {}
    for name in ("before", "inertia_alone", "after"):
        motion: CrankMotion = getattr(study, name)
        ripple = motion.statistics
        found[name] = {
            "mean_rad_per_s": ripple.mean,
            "std_rad_per_s": ripple.std,
            "p2p_rad_per_s": ripple.peak_to_peak,
            "fluctuation": ripple.fluctuation,
            "minimum_rad_per_s": ripple.minimum,
            "minimum_crank_angle_deg": float(np.degrees(ripple.minimum_angle)),
            "maximum_rad_per_s": ripple.maximum,
            "maximum_crank_angle_deg": float(np.degrees(ripple.maximum_angle)),
            "load_mean_Nm": float(motion.load_torque.mean()),
            "closure": motion.closure,
        }
    disc, rim = study.flywheel_masses(radius)
    return found | {
        "flywheel_for_the_same_std": {
            "added_inertia_kg_m2": study.added_inertia,
            "outer_radius_mm": 1e3 * radius,
            "disc_mass_kg": disc,
            "rim_mass_kg": rim,
        }
    }


def speed_ripple(
    case: Case,
    torques: Mapping[str, Torque],
    pitch: FollowerPath,
    rubbing: Mapping[str, Rubbing],
) -> dict[str, tuple[float, float]]:
    """Std of the crank speed (rad/s) of each running load case: engine alone, with the cam.

    In each load case the guides rub as `rubbing` tells. Empty where the case tells nothing of its
    crankshaft; a load case that stalls is NaN.
    """
    found: dict[str, tuple[float, float]] = {}
    for state in case.load_cases:
        if case.crankshaft is None or state.name not in torques or not state.speed > 0:
            continue
        try:
            study = study_of(
                case.at(state.name),
                torques[state.name],
                state.speed,
                pitch,
                rubbing.get(state.name),
            )
        except CamError:
            study = None
        if study is None:
            found[state.name] = (np.nan, np.nan)
        else:
            found[state.name] = (study.before.statistics.std, study.after.statistics.std)
    return found


def consistency(
    case: Case,
    state: LoadCase,
    torque: Torque,
    pitch: FollowerPath,
    study: SpeedStudy | None,
    asked: Array | None = None,
    rubbing: Rubbing | None = None,
) -> tuple[Finding, ...]:
    """What the inputs of a case say of one another in one of its states.

    `asked` (n,) is the crank torque the cam was drawn to take there, N m about its mean; without
    it, as where limits shape the lift, power and energy have nothing to agree with. What was
    measured of the speed belongs to the first state.
    """
    case = case.at(state.name)
    ratio = case.mechanism.gear_ratio
    system = replace(FollowerSystem.from_case(case), rubbing=rubbing)
    theta = uniform_turn(torque.theta_crank.size)
    loads = follower_loads(pitch, system, state.speed / ratio, theta)
    found = []
    if asked is not None:
        stroke = pitch.lift.stroke
        stored = stroke * (system.preload + 0.5 * system.spring_rate * stroke)
        found.append(ratio_finding(asked, loads.spring_force * loads.lift_slope, ratio))
        found.append(energy_finding(asked, stored))
    if study is not None:
        taken = -4.0 * pi * float(study.after.mechanism_torque.mean())
        found.append(work_finding(loads.friction_loss, taken))
    shaft = case.crankshaft
    measured = None if shaft is None else shaft.measured_speed_std
    if shaft is not None and measured is not None and state.name == case.load_cases[0].name:
        balanced = torque.without_mean().total
        found.append(inertia_finding(shaft.inertia, balanced, state.speed, measured))
    return tuple(found)
