"""Wiebe burn: how much of the fuel has burnt at a crank angle."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine


def wiebe(progress: ArrayLike, a: float, m: float) -> Array:
    """Burnt fraction at a progress of the burn (0 at its start, 1 at its end), any shape.

    The exponential leaves exp(-a) unburnt at the end (0.7 % for a = 5); it is scaled to reach 1,
    so that all fuel set free by `combustion_efficiency` is indeed set free.

    References
    ----------
    Heywood (1988), eq. 9.1; Ghojel, Int. J. Engine Res. 11 (2010) 297.
    """
    reached = np.clip(progress, 0.0, 1.0)
    return np.asarray(np.expm1(-a * reached ** (m + 1.0)) / np.expm1(-a))


def _burns(engine: CylinderEngine) -> tuple[tuple[float, float, float, float], ...]:
    """Share, duration (rad), a and m of each Wiebe burn of the engine."""
    main = (1.0 - engine.premixed_share, engine.burn_duration, engine.wiebe_a, engine.wiebe_m)
    if engine.premixed_share == 0.0:
        return (main,)
    first = (engine.premixed_share, engine.premixed_duration, engine.wiebe_a, engine.premixed_m)
    return (first, main)


def _since_start(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Crank angle past the start of the burn, counted from half a cycle before it (rad)."""
    past = np.asarray(theta, dtype=float) - (engine.spark + engine.ignition_delay)
    return np.asarray(np.mod(past + 0.5 * CYCLE_ANGLE, CYCLE_ANGLE) - 0.5 * CYCLE_ANGLE)


def burnt_fraction(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Fraction of the fuel burnt at crank angles (rad, any shape), 0 before the spark.

    A compression-ignition engine burns `premixed_share` of it in a first, short burn.
    """
    past = _since_start(engine, theta)
    parts = [s * wiebe(past / length, a, m) for s, length, a, m in _burns(engine)]
    return np.asarray(sum(parts))
