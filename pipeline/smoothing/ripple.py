"""What a cam leaves of the engine's ripple, in torque and in speed."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.smoothing.scenario import Scenario
from camwright.pipeline.smoothing.synthesis_problem import Problem


def ripple_of(problem: Problem, item: Scenario, values: Array) -> Array:
    """Torque and speed ripple of columns of crank torque, each over that of the engine."""
    parts = [np.sqrt(problem.torque_weight) * torque_ripple(item, values)]
    if problem.speed_weight > 0:
        before = _integral(item.torque - item.torque.mean())
        norm = np.sqrt(before.size) * float(np.std(before))
        parts.append(np.sqrt(problem.speed_weight) / norm * _integral(values))
    return np.concatenate(parts)


def torque_ripple(item: Scenario, values: Array) -> Array:
    """Columns of crank torque about their means; their norm is the std over the engine's."""
    before = item.torque - item.torque.mean()
    return (values - values.mean(axis=0)) / (np.sqrt(before.size) * np.std(before))


def triangle(columns: Array) -> tuple[Array, Array]:
    """Level and slopes of as few rows, the norm of which is that of all: slopes, then level."""
    triangle = np.asarray(np.linalg.qr(columns, mode="r"))
    return triangle[:, -1], triangle[:, :-1]


def _integral(values: Array) -> Array:
    """Integral of periodic columns by the angle, its mean taken off; of a turn of any length."""
    spectrum = np.fft.rfft(values, axis=0)
    order = np.arange(spectrum.shape[0]).reshape(-1, *[1] * (spectrum.ndim - 1))
    spectrum = np.divide(spectrum, 1j * order, out=np.zeros_like(spectrum), where=order > 0)
    return np.fft.irfft(spectrum, n=values.shape[0], axis=0)
