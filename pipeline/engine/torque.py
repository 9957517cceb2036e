"""Engine torque over one cycle, modelled or measured, as the sum of its components."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Literal

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.geometry.periodic_spline import periodic_cubic
from camwright.pipeline.base.quantities import FileName, Part
from camwright.pipeline.engine.angle_trace import read_trace
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine
from camwright.pipeline.engine.indicated_cycle import CylinderCycle
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle

SAMPLES = 720


@dataclass(frozen=True, kw_only=True)
class TorqueTable(Part):
    """Engine torque over one cycle from a file: a column of crank angle, one of torque."""

    table: ClassVar[str] = "engine"

    kind: Literal["table"] = "table"
    file: FileName


@dataclass(frozen=True, eq=False)
class Torque:
    """Torque of the engine on its crank over one cycle, positive when the gas drives.

    Parameters
    ----------
    theta_crank : array (n,)               rad, uniform over [0, 4 pi), 0 the TDC of intake
    components : mapping to array (n,)     N m, by name; the total is their sum
    varying_inertia : array (n,)           kg m2, of the reciprocating masses whose torque at
                                           constant speed is the component ``inertia``; None: not
                                           known
    error_bar : array (n,)                 N m, half-width of the band about a measured total that
                                           holds it at all angles at once, 95 %; None: not known

    Raises
    ------
    InputError
        If the angles are not those of a uniform cycle, or a component is of another length or
        not finite.
    """

    theta_crank: Array
    components: Mapping[str, Array]
    varying_inertia: Array | None = None
    error_bar: Array | None = None

    def __post_init__(self) -> None:
        theta = finite("torque.theta_crank", self.theta_crank)
        if theta.ndim != 1 or theta.size < 12:
            raise InputError("torque.theta_crank", f"{theta.shape} angles", "(12 or more,)")
        if not np.allclose(theta, uniform_cycle(theta.size), rtol=0.0, atol=1e-9):
            raise InputError("torque.theta_crank", "angles", "uniform over [0, 4 pi) rad")
        if not self.components:
            raise InputError("torque.components", "nothing", "one component or more")
        parts = {name: finite(f"torque.{name}", part) for name, part in self.components.items()}
        for name, part in parts.items():
            if part.shape != theta.shape:
                raise InputError(f"torque.{name}", f"{part.shape} values", f"{theta.shape}")
        freeze(self, theta_crank=theta)
        object.__setattr__(self, "components", MappingProxyType(parts))

    @property
    def total(self) -> Array:
        """Sum of the components, N m."""
        return np.asarray(sum(self.components.values()))

    @property
    def mean(self) -> float:
        return float(self.total.mean())

    @property
    def std(self) -> float:
        """Standard deviation about the mean, N m."""
        return float(self.total.std())

    @property
    def peak(self) -> float:
        return float(self.total.max())

    @property
    def peak_to_peak(self) -> float:
        return float(np.ptp(self.total))

    def without_mean(self) -> Torque:
        """The torque with a steady load, component `load`, that brings its mean to zero."""
        load = np.full_like(self.theta_crank, -self.mean)
        known = self.components.get("load", np.zeros_like(load))
        return replace(self, components={**self.components, "load": known + load})

    def resampled(self, n: int) -> Torque:
        """The torque at `n` angles: some of its own, or by a periodic cubic spline through each
        component.
        """
        if n == self.theta_crank.size:
            return self
        step, rest = divmod(self.theta_crank.size, n)
        if rest == 0:  # exactly: without the round-off of a spline
            parts = {name: part[::step] for name, part in self.components.items()}
            varying, bar = (
                None if values is None else values[::step]
                for values in (self.varying_inertia, self.error_bar)
            )
            return Torque(self.theta_crank[::step], parts, varying, bar)
        theta = uniform_cycle(n)
        parts = {name: _periodic(part, theta) for name, part in self.components.items()}
        varying, bar = (
            # The spline of an inertia undershoots at a dead centre.
            None if values is None else np.maximum(_periodic(values, theta), 0.0)
            for values in (self.varying_inertia, self.error_bar)
        )
        return Torque(theta, parts, varying, bar)


def uniform_cycle(count: int) -> Array:
    """`count` equally spaced crank angles of one cycle from 0, its end excluded, rad."""
    return np.arange(float(count)) * (CYCLE_ANGLE / count)


def _periodic(values: Array, theta: Array) -> Array:
    """Values on a uniform cycle at other crank angles (rad)."""
    return periodic_cubic(values)(theta * (FULL_TURN / CYCLE_ANGLE))


def torque_from_cycle(cycle: CylinderCycle) -> Torque:
    """Torque of an engine whose cylinders all have the same cycle, at their firing offsets."""
    parts = {
        "gas": cycle.gas_torque,
        "inertia": cycle.inertia_torque,
        "valve_train": cycle.valve_train_torque,
        "friction": cycle.friction_torque,
        "dipper": cycle.dipper_torque,
    }
    if cycle.engine.dipper_area == 0.0:
        del parts["dipper"]
    return Torque(
        cycle.theta,
        all_cylinders(parts, cycle.theta, cycle.engine.firing_offsets),
        cycle.engine.reciprocating_inertia(cycle.theta),
    )


def all_cylinders(
    parts: Mapping[str, Array], theta: Array, offsets: tuple[float, ...]
) -> dict[str, Array]:
    """Torques (n,) of one cylinder, summed over cylinders that lag by their firing offsets."""
    if offsets == (0.0,):
        return dict(parts)
    shifted = [theta - offset for offset in offsets]
    return {
        name: np.asarray(sum(_periodic(part, at) for at in shifted)) for name, part in parts.items()
    }


def torque_from_cylinder(engine: CylinderEngine, crank_speed: float) -> Torque:
    """Torque of an engine model at a steady crank speed (rad/s).

    Without a friction pressure the mean is zero; with one it is the brake torque, which
    `without_mean` balances by a steady load.

    Raises
    ------
    InputError
        If the speed is out of range.
    CamError
        If the working cycle does not become periodic.
    """
    return torque_from_cycle(working_cycle(engine, crank_speed))


def torque_from_csv(path: str | Path, column: str | None = None) -> Torque:
    """Torque measured over one cycle, on whole crank degrees, its one component `measured`.

    Raises
    ------
    InputError
        If the file is not one clean cycle; see `read_trace`.
    """
    trace = read_trace(path, "torque", column=column)
    return Torque(uniform_cycle(SAMPLES), {"measured": trace.uniform(SAMPLES)})
