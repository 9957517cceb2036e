"""Cam speed at which a rigid follower leaves its cam, by the measure of its check."""

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.checks.demands import greatest_unloading
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads


def rigid_jump_speed(
    pitch: FollowerPath, system: FollowerSystem, theta: Array
) -> tuple[float, float]:
    """Least cam speed, rad/s, and cam angle, rad; infinite and NaN without a jump."""
    loads = follower_loads(pitch, system, 1.0, theta)
    unloaded = greatest_unloading(loads.inertia_force, loads.closing_force)
    first = int(np.argmax(unloaded))
    if not unloaded[first] > 0.0:
        return np.inf, np.nan
    return float(unloaded[first] ** -0.5), float(theta[first])
