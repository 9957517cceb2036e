"""Jump speed of an elastic follower by a search over the speed, and the energy of its motion."""

import numpy as np
from scipy.optimize import brentq

from camwright.geometry.arrays import Array
from camwright.pipeline.follower.elastic_follower import ElasticFollower, harmonic_response
from camwright.pipeline.follower.follower_flight import Bounce


def energy_error(motion: Bounce) -> float:
    """Range of energy plus losses over maximum energy."""
    return float(np.ptp(motion.energy + motion.dissipated) / np.abs(motion.energy).max())


def elastic_jump_speed(
    lift: Array, follower: ElasticFollower, speed_max: float, steps: int = 160
) -> float:
    """Minimum cam speed up to `speed_max` with zero minimum contact force, rad/s.

    Infinite without one. Speeds are searched in equal steps: resonances narrower than a step may
    be missed.
    """

    def least(speed: float) -> float:
        return float(harmonic_response(lift, speed, follower).contact_force.min())

    before = 0.0
    if least(before) <= 0.0:
        return 0.0
    for speed in np.linspace(0.0, speed_max, steps + 1)[1:]:
        if least(float(speed)) <= 0.0:
            return float(brentq(least, before, float(speed), xtol=1e-6 * speed_max))
        before = float(speed)
    return np.inf
