"""Mean effective pressures of a working cycle, Pa."""

from math import pi

import numpy as np

from camwright.pipeline.engine.cylinder import CYCLE_ANGLE


def mean_effective_pressure(cycle, torque):
    return float(torque.mean()) * CYCLE_ANGLE / cycle.engine.displacement


def net_imep(cycle):
    """Indicated mean effective pressure over all four strokes."""
    return mean_effective_pressure(cycle, cycle.gas_torque)


def gross_imep(cycle):
    """Indicated mean effective pressure of compression and expansion alone."""
    fired = (cycle.theta >= pi - 1e-9) & (cycle.theta < 3.0 * pi - 1e-9)
    return mean_effective_pressure(cycle, np.where(fired, cycle.gas_torque, 0.0))


def fmep(cycle):
    """Friction mean effective pressure."""
    return mean_effective_pressure(cycle, -cycle.friction_torque)
