"""Working cycle of one cylinder: gas state, torques, energy and mass balance."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from camwright.geometry.arrays import Array, finite, freeze
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.valves import valve_train_torque


@dataclass(frozen=True)
class CycleBalance:
    """Balance of energy (J) and mass (kg) of one cylinder over its last cycle."""

    heat_released: float
    heat_lost: float
    work: float  # of the gas on the piston
    enthalpy_in: float  # net, through both valves
    energy_change: float
    intake_mass: float  # net
    exhaust_mass: float  # net, out of the cylinder
    mass_change: float


@dataclass(frozen=True, eq=False)
class CylinderCycle:
    """Periodic cycle of one cylinder at whole crank degrees, 0 the TDC of intake.

    Arrays are (720,): `theta` rad, `pressure` Pa, `temperature` K, `mass` kg.
    """

    engine: CylinderEngine
    crank_speed: float  # rad/s
    theta: Array
    pressure: Array
    temperature: Array
    mass: Array
    fuel_mass: float  # kg per cycle
    residual_fraction: float  # burnt mass over all mass as the intake valve closes
    balance: CycleBalance
    closure: float  # relative pressure difference of the last two cycles at intake valve close

    def __post_init__(self) -> None:
        names = ("theta", "pressure", "temperature", "mass")
        freeze(self, **{name: finite(f"cycle.{name}", getattr(self, name)) for name in names})

    @property
    def volume(self) -> Array:
        return self.engine.volume(self.theta)

    @property
    def gas_torque(self) -> Array:
        """Torque of the gas on the crank, N m."""
        over = self.pressure - self.engine.crankcase_pressure
        return np.asarray(over * self.engine.volume_rate(self.theta))

    @property
    def inertia_torque(self) -> Array:
        """Torque of the reciprocating mass on the crank at constant speed, exact, N m."""
        return self.engine.inertia_torque(self.theta, self.crank_speed)

    @property
    def valve_train_torque(self) -> Array:
        return valve_train_torque(self.engine, self.theta)

    @property
    def dipper_torque(self) -> Array:
        """Drag torque of the oil dipper on the crank, N m, <= 0, at each angle of the cycle.

        Drag of a flow at the speed of the dipper, times a cosine from 1 at bottom dead centre to 0
        at the immersion angle on either side.
        """
        engine = self.engine
        if engine.dipper_area == 0.0:
            return np.zeros_like(self.theta)
        from_bottom = np.mod(self.theta, 2.0 * pi) - pi
        reached = np.minimum(np.abs(from_bottom) / engine.dipper_immersion, 1.0)
        dipped = 0.5 * (1.0 + np.cos(pi * reached))
        flow_pressure = 0.5 * engine.oil_density * (self.crank_speed * engine.dipper_radius) ** 2
        drag = flow_pressure * engine.dipper_drag_coefficient * engine.dipper_area
        return np.asarray(-drag * engine.dipper_radius * dipped)

    @property
    def friction_torque(self) -> Array:
        """Friction torque of one cylinder on the crank, N m, <= 0, the same at every angle: that of
        the friction mean effective pressure or, where none is stated, as much as leaves no mean
        torque.

        Raises
        ------
        InputError
            As `CrankDrive.friction_torque`.
        """
        others = self.gas_torque + self.inertia_torque
        mean = float((others + self.valve_train_torque + self.dipper_torque).mean())
        friction = self.engine.friction_torque(self.engine.friction_pressure, mean)
        return np.full_like(self.theta, friction)
