"""Temperature of a sliding line contact: flash of the contact, bulk of the bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, positive

BULK_SHARE = 0.47 * 1.2
"""Rise of the bulk over the oil as a share of the mean flash temperature, of bodies that dip into
the oil or are splashed: ISO/TS 6336-20, recalled: verify."""


def bulk_rise(flash: Array) -> Array:
    """Bulk temperature rise over the oil (...), K, from flash temperatures (..., n) of a turn."""
    return np.asarray(BULK_SHARE * flash.mean(axis=-1))


def effusivity(conductivity: float, density: float, specific_heat: float) -> float:
    """Thermal effusivity sqrt(k rho c), W s^0.5/(m^2 K)."""
    return float(np.sqrt(conductivity * density * specific_heat))


def flash_temperature(
    heat: ArrayLike,
    speeds: tuple[ArrayLike, ArrayLike],
    effusivities: tuple[float, float],
    half_width: ArrayLike,
) -> Array:
    """Maximum flash temperature rise (...) of a fast band contact, K; 0 without heat.

    Parameters
    ----------
    heat : array (...)         friction power per length of the line, W/m
    speeds : two arrays (...)  of both surfaces through the contact, m/s
    effusivities : two floats  of both bodies, W s^0.5/(m^2 K)
    half_width : array (...)   m

    Raises
    ------
    InputError
        If heat or half-width is not finite, or negative.

    References
    ----------
    Blok (1937): a band source on two half-planes that share its heat.
    """
    power, half = finite("heat", heat), positive("half_width", half_width, "m")
    taken = sum(
        each * np.sqrt(np.abs(finite("speed", speed)))
        for each, speed in zip(effusivities, speeds, strict=True)
    )
    warm = power > 0
    rise = 1.11 * power / np.where(warm, taken * np.sqrt(2.0 * half), 1.0)
    return np.where(warm, rise, 0.0)
