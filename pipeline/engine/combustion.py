"""Burnt fraction of the fuel against crank angle, by Wiebe functions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine


def wiebe(progress: ArrayLike, a: float, m: float) -> Array:
    """Wiebe function: burnt fraction at a progress of the burn, 0 at start to 1 at end, (...).

    The exponential leaves exp(-a) unburnt at the end (0.7 % for a = 5); it is scaled to reach 1,
    so that the heat released is the share `combustion_efficiency` of that of the fuel.

    References
    ----------
    Heywood (1988), eq. 9.1; Ghojel, Int. J. Engine Res. 11 (2010) 297.
    """
    reached = np.clip(progress, 0.0, 1.0)
    return np.asarray(np.expm1(-a * reached ** (m + 1.0)) / np.expm1(-a))


def _burns(engine: CylinderEngine) -> tuple[tuple[float, float, float, float], ...]:
    """Wiebe burns of the fuel: (share of the fuel, duration in crank angle, rad, a, m) of each, a
    and m being the exponents of the Wiebe function.

    One burn, or with a premixed share first that of the premixed fuel, then the main one.
    """
    main = (1.0 - engine.premixed_share, engine.burn_duration, engine.wiebe_a, engine.wiebe_m)
    if engine.premixed_share == 0.0:
        return (main,)
    first = (engine.premixed_share, engine.premixed_duration, engine.wiebe_a, engine.premixed_m)
    return (first, main)


def _since_start(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Crank angle from the start of the burn, rad, within half a cycle of it."""
    past = np.asarray(theta, dtype=float) - (engine.spark + engine.ignition_delay)
    return np.asarray(np.mod(past + 0.5 * CYCLE_ANGLE, CYCLE_ANGLE) - 0.5 * CYCLE_ANGLE)


def burnt_fraction(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Burnt fuel fraction at crank angles (rad, ...), 0 before the spark.

    With compression ignition the share `premixed_share` burns in a first, short burn.
    """
    past = _since_start(engine, theta)
    parts = [s * wiebe(past / length, a, m) for s, length, a, m in _burns(engine)]
    return np.asarray(sum(parts))
