"""Torque section of a case file: table, harmonics, pressures, compressor, pump or press."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import ceil
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.case.section import Table
from camwright.pipeline.torque.harmonic_torque import HarmonicTorque
from camwright.pipeline.torque.press_torque import Press, press_torque
from camwright.pipeline.torque.pressure_torque import PressureTorqueFile, pressure_torque
from camwright.pipeline.torque.tabled_torque import TabledTorqueFile, tabled_torque
from camwright.pipeline.torque.torque import SAMPLES, Torque, uniform_cycle
from camwright.pipeline.torque.valved_cylinder import CompressorTorque, PumpTorque

ShaftTorque = Annotated[
    Table[TabledTorqueFile]
    | Table[HarmonicTorque]
    | Table[PressureTorqueFile]
    | Table[CompressorTorque]
    | Table[PumpTorque]
    | Table[Press],
    Field(discriminator="kind"),
]
TORQUE_KINDS = ("table", "harmonics", "pressure", "compressor", "pump", "press")


def torque_files(torque: ShaftTorque | None) -> Iterator[tuple[str, str]]:
    """Key and file name of every file that a torque refers to."""
    if isinstance(torque, (TabledTorqueFile, PressureTorqueFile)):
        yield "torque.file", torque.file
    if isinstance(torque, Press) and torque.file is not None:
        yield "torque.file", torque.file


def shaft_torque(torque: ShaftTorque, speed: float, path: Callable[[str], Path]) -> Torque:
    """Torque of a machine over its cycle at a steady shaft speed (rad/s).

    Reciprocating masses are the component ``inertia``, their torque at that speed.

    Parameters
    ----------
    path : callable   place of an included file, by its name

    Raises
    ------
    InputError
        If a file cannot be read or has wrong contents; by file and line.
    """
    turns = ceil(torque.cycle / FULL_TURN * (1.0 - 1e-9))
    theta = uniform_cycle(SAMPLES * turns, torque.cycle)  # as dense however long the cycle is
    parts: dict[str, Array] = {torque.kind: _values(torque, theta, path)}
    inertia = _inertia(torque, theta)
    if not inertia.any():
        return Torque(theta, parts, span=torque.cycle)
    slope = _derivative(inertia, torque.cycle)
    parts["inertia"] = -0.5 * speed**2 * slope
    return Torque(theta, parts, inertia, span=torque.cycle)


def _values(torque: ShaftTorque, theta: Array, path: Callable[[str], Path]) -> Array:
    """Torque of a machine at its shaft (n,), N m, positive when it drives the shaft.

    Parameters
    ----------
    torque : ShaftTorque   section of the case
    theta : array (n,)     equal shaft angles of a cycle, rad
    path : callable        file name -> path
    """
    if isinstance(torque, TabledTorqueFile):
        return tabled_torque(torque, path(torque.file)).torque(theta)
    if isinstance(torque, PressureTorqueFile):
        return pressure_torque(torque, path(torque.file)).torque(theta)
    if isinstance(torque, Press):
        return press_torque(torque, torque.file and path(torque.file)).torque(theta)
    return torque.torque(theta)


def _inertia(torque: ShaftTorque, theta: Array) -> Array:
    """Inertia of the reciprocating masses of a machine, reduced to its shaft (n,), kg m2, at shaft
    angles (n,), rad; zero without such masses.
    """
    if isinstance(torque, Press):
        return torque.inertia(theta)
    if isinstance(torque, (PressureTorqueFile, CompressorTorque, PumpTorque)):
        return np.asarray(sum(each.inertia(theta) for each in torque.cylinders))
    return np.zeros_like(theta)


def _derivative(values: Array, span: float) -> Array:
    """Derivative by the shaft angle of a smooth function over its cycle."""
    order = np.arange(values.size // 2 + 1) * (2.0 * np.pi / span)
    return np.asarray(np.fft.irfft(1j * order * np.fft.rfft(values), n=values.size))
