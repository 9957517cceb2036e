"""Band-limited least-squares fit of a series over a cycle, and its noise."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from camwright.geometry.arrays import Array, readonly
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE
from camwright.pipeline.engine.pitch_errors import PitchErrors
from camwright.pipeline.engine.torque_error_bar import SlopeNoise
from camwright.pipeline.torque.torque import SAMPLES, uniform_cycle

SHARE_MAX = 0.95
"""Unknowns of the series per observation, at most."""


def fitted(matrix: Array, weights: Array, noise: Array, unit: float) -> tuple[Array, SlopeNoise]:
    """Linear maps of the fit: observations to the filtered series, and their noise to its slope.

    Parameters
    ----------
    matrix : array (n, 2 last + 1)   from the series to the observations
    weights : array (last + 1,)      factor of the filter on each harmonic
    noise : array (n, k)             from independent sources of noise to the observations
    unit : float                     observation per speed: that of the noise

    Returns
    -------
    fit : array (720, n)   of the filtered series
    slope_noise : SlopeNoise
    """
    solve = np.linalg.pinv(matrix) * np.concatenate([weights, weights[1:]])[:, None]
    theta, last = uniform_cycle(SAMPLES), weights.size - 1
    slope = points(theta, last, derivative=True) @ (solve @ noise) * unit
    left = _residual(matrix) @ noise
    spread = left.T @ left
    freedom = float(np.trace(spread) ** 2 / (spread**2).sum())
    return readonly(points(theta, last) @ solve), SlopeNoise.of(slope, freedom)


def remaining_band(matrix: Array, weights: Array, late: Array, errors: PitchErrors) -> Array:
    """Half-width (720,) of the 95 % band about domega/dtheta from remaining pitch errors.

    It comes beside that of the noise: the covariance of both, which stems from the same record, is
    in it.

    Parameters
    ----------
    matrix, weights : array   as in `fitted`
    late : array (n, 2 e)     rad/s, from the angles by which edges are seen too late, in the first
                              turn and the second, to the observations, over their mean slowness
    errors : PitchErrors
    """

    def gain(noise: Array) -> SlopeNoise:
        return fitted(matrix, weights, late @ noise, 1.0)[1]

    twice = np.tile(errors.covariance, (2, 2))
    if not twice.any():
        return np.zeros(SAMPLES)
    of_pitch = gain(_root(twice))
    if not errors.shared.size:
        return of_pitch.band
    together = gain(_root(errors.of_edges)).gain ** 2
    alone = gain(errors.noise * np.eye(twice.shape[0])).gain ** 2
    return replace(of_pitch, gain=np.sqrt(np.maximum(together - alone, 0.0))).band


def _root(covariance: Array) -> Array:
    """Map (n, n) from independent values of unit variance to values of a covariance."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def observation_noise(values: Array, matrix: Array, noise: Array) -> float:
    """Standard deviation of one observation, from its scatter over cycles or about the fit.

    Parameters
    ----------
    values : array (m, n)   observations of each cycle
    matrix, noise : array   as in `fitted`
    """
    if values.shape[0] > 1:
        return float(np.sqrt(values.var(axis=0, ddof=1).mean()))
    left = _residual(matrix)
    return float(np.sqrt(((left @ values[0]) ** 2).sum() / ((left @ noise) ** 2).sum()))


def _residual(matrix: Array) -> Array:
    """Map (n, n) of observations to their residuals about the fit."""
    return np.asarray(np.eye(matrix.shape[0]) - matrix @ np.linalg.pinv(matrix))


def shared_edges(start: Array, end: Array) -> Array:
    """Matrix (n, n) from the lateness of each edge to the durations of the intervals.

    Each edge begins one interval and ends another of its kind; edge k begins interval k.
    """
    closes = np.abs(np.mod(end[:, None] - start + 1e-6, CYCLE_ANGLE) - 1e-6) < 1e-6
    return np.asarray(closes.astype(float) - np.eye(start.size))


def points(angle: Array, last: int, derivative: bool = False) -> Array:
    """Fourier basis of the engine cycle at crank angles (n,), rad: 1, cosines and then sines of
    harmonics 1 to `last`, (n, 2 last + 1); with `derivative` its slope, 1/rad.

    Harmonic k has k periods in a cycle, `CYCLE_ANGLE`.
    """
    order = np.arange(1, last + 1) * (2.0 * pi / CYCLE_ANGLE)
    phase = np.outer(angle, order)
    if derivative:
        return np.hstack([np.zeros((angle.size, 1)), -order * np.sin(phase), order * np.cos(phase)])
    return np.hstack([np.ones((angle.size, 1)), np.cos(phase), np.sin(phase)])


def integrals(start: Array, end: Array, last: int) -> Array:
    """Integrals of the Fourier basis of `points` over the crank angle from `start` (n,) to `end`
    (n,), rad, (n, 2 last + 1).
    """
    order = np.arange(1, last + 1) * (2.0 * pi / CYCLE_ANGLE)
    from_, to = np.outer(start, order), np.outer(end, order)
    cosines, sines = (np.sin(to) - np.sin(from_)) / order, (np.cos(from_) - np.cos(to)) / order
    return np.hstack([(end - start)[:, None], cosines, sines])
