"""The balancing cam of the papers under a torque: what it stores, delivers and leaves over."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.energy import lift_from_torque
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.cycle.crank_speed import SpeedStudy, speed_study
from camwright.pipeline.engine.crankshaft import Inertia
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed

RATIO = 2.0
POSITIONS = 720

# Energies 2025: k, P, follower mass, b, friction; the overhang at full lift is assumed.
FOLLOWER_2025 = FollowerSystem(
    mass=0.175,
    spring=Spring(rate=24_200.0, preload=242.0),
    guide_spacing=0.080,
    overhang_at_max_lift=0.030,
    friction_a=0.04,
    friction_b=0.20,
)
PRIME_RADIUS = 0.050
TWELVE_VALUES = Smoother("moving_average", points=12, spacing=float(np.radians(5.0)))
TWELVE_DEGREES = replace(TWELVE_VALUES, spacing=float(np.radians(1.0)))


@dataclass(frozen=True, eq=False)
class Balanced:
    """A cam cut for a torque and run under it.

    Parameters
    ----------
    pitch : PitchCurve
    residual : array (n,)    N m about its mean, crank torque left over at constant speed
    ideal : array (n,)       N m, the same without friction and inertia of the follower
    study : SpeedStudy
    """

    pitch: PitchCurve
    residual: Array
    ideal: Array
    study: SpeedStudy

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual, ideal=self.ideal)

    def figures(self) -> dict[str, float]:
        """Ripple of torque and speed, N m and rad/s."""
        ripple = self.study.after.statistics
        return {
            "torque_std_Nm": float(self.residual.std()),
            "torque_p2p_Nm": float(np.ptp(self.residual)),
            "torque_std_without_friction_and_inertia_Nm": float(self.ideal.std()),
            "speed_std_rad_per_s": ripple.std,
            "speed_p2p_rad_per_s": ripple.peak_to_peak,
            "radius_max_mm": 1e3 * (PRIME_RADIUS + self.pitch.lift.highest.value),
        }


def designed_pitch(
    torque: Array, multiplier: float, smoother: Smoother, system: FollowerSystem
) -> PitchCurve:
    """Pitch curve of a cam cut for `multiplier` times a smoothed crank torque (n,)."""
    target = multiplier * smoothed(torque - torque.mean(), smoother)
    theta = uniform_turn(torque.size)
    lift = lift_from_torque(
        theta, target - target.mean(), system.spring.rate, system.spring.preload
    )
    return PitchCurve(lift, PRIME_RADIUS)


def balanced(
    torque: Array,
    inertia: float,
    mean_speed: float,
    *,
    multiplier: float = 2.0,
    smoother: Smoother = TWELVE_VALUES,
    preload: float | None = None,
    added: float = 0.0,
    system: FollowerSystem = FOLLOWER_2025,
) -> Balanced:
    """A cam cut at the design preload and run at another.

    Parameters
    ----------
    torque : array (n,)     N m on the crank at equal angles of the cycle
    inertia, added : float  kg m2, of the engine and of what turns in the mechanism
    mean_speed : float      rad/s
    multiplier : float      cam torque over crank torque that the cam is cut for: 2 by power
    preload : float         N, at which it runs; None: as designed
    """
    pitch = designed_pitch(torque, multiplier, smoother, system)
    runs = (
        system
        if preload is None
        else replace(system, spring=replace(system.spring, preload=preload))
    )
    loads = follower_loads(pitch, runs, mean_speed / RATIO, uniform_turn(torque.size))
    about = torque - torque.mean()
    left = about - loads.cam_torque / RATIO
    spring = loads.spring_force * loads.lift_slope / RATIO
    study = speed_study(
        about,
        Inertia.constant_only(inertia, torque.size),
        mean_speed,
        pitch,
        runs,
        gear_ratio=RATIO,
        mechanism_inertia=added,
    )
    return Balanced(pitch, left - left.mean(), about - spring, study)
