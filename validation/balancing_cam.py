"""Balancing cam of the papers under an engine torque: residual torque and speed ripple."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from camwright.geometry.arrays import Array, freeze, uniform_turn
from camwright.geometry.energy import lift_from_torque
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.cycle.crank_speed import SpeedStudy, speed_study
from camwright.pipeline.engine.crankshaft import Inertia
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads, follower_loads
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed

RATIO = 2.0
POSITIONS = 720

# Energies 18 (2025) 3256: k, P, follower mass, b, friction; overhang at full lift assumed.
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
TWELVE_TEETH = replace(TWELVE_VALUES, spacing=float(np.radians(10.0)))


@dataclass(frozen=True, eq=False)
class Balanced:
    """A cam synthesised for a torque, and its residual.

    Parameters
    ----------
    pitch : PitchCurve
    loads : Loads            of the follower at constant speed
    residual : array (n,)    residual crank torque at constant speed without its mean, N m
    ideal : array (n,)       the same without friction and inertia of the follower, N m
    study : SpeedStudy
    """

    pitch: PitchCurve
    loads: Loads
    residual: Array
    ideal: Array
    study: SpeedStudy

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual, ideal=self.ideal)

    @property
    def spring_torque(self) -> Array:
        """Crank torque that the spring takes (n,), N m."""
        return self.loads.spring_force * self.loads.lift_slope / RATIO

    @property
    def inertia_torque(self) -> Array:
        """Crank torque that the inertia of the follower takes (n,), N m."""
        return self.loads.inertia_force * self.loads.lift_slope / RATIO

    @property
    def friction_torque(self) -> Array:
        """Crank torque that the friction of the guides takes (n,), N m, >= 0."""
        return self.loads.cam_torque / RATIO - self.spring_torque - self.inertia_torque

    def figures(self) -> dict[str, float]:
        """Ripple of torque and speed, and cam radius, names with units."""
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
    """Pitch curve of a cam for `multiplier` times a smoothed crank torque (n,), N m."""
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
    """A cam synthesised at the design preload and run at another.

    Parameters
    ----------
    torque : array (n,)     crank torque at equal angles of the cycle, N m
    inertia, added : float  of the engine and of the mechanism, kg m2
    mean_speed : float      rad/s
    multiplier : float      design cam torque over crank torque; 2: by power
    preload : float         in operation, N; None: as designed
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
    study = speed_study(
        about,
        Inertia.constant_only(inertia, torque.size),
        mean_speed,
        pitch,
        runs,
        gear_ratio=RATIO,
        mechanism_inertia=added,
    )
    spring = loads.spring_force * loads.lift_slope / RATIO
    return Balanced(pitch, loads, left - left.mean(), about - spring, study)
