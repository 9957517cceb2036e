"""Valve lift, mass flow through the valves, torque of the valve springs on the crank."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.monotone_cubic import MonotoneCubic
from camwright.geometry.rocker_lift import RockerLinkage
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine, LiftPoint

# At equal pressures the slope of the nozzle flow is infinite; below this relative difference the
# flow is linearised, which changes the cylinder pressure by some 10 Pa.
NEARLY_EQUAL = 1e-3
# Pressure ratios above which the throat is not choked: exp(-1/2), that of a gamma of 1.
_NOT_CHOKED = 0.607


@dataclass(frozen=True)
class Valve:
    """A poppet valve: timing (crank angle of a cycle, rad), lift and diameter of the head (m).

    Between opening and closing the lift is `lift_max` times (1 - cos)/2, or a monotone curve
    through a table.
    """

    opens: float
    closes: float
    lift_max: float
    diameter: float
    discharge_coefficient: float
    table: tuple[LiftPoint, ...] = ()

    def lift(self, theta: ArrayLike, derivative: int = 0) -> Array:
        """Valve lift (...), m, at crank angles (...), rad, or its derivative by the crank angle,
        m/rad, where `derivative` is 1.
        """
        past = np.mod(np.asarray(theta, dtype=float) - self.opens, CYCLE_ANGLE)
        duration = self.closes - self.opens
        is_open = past < duration
        if self.table:
            angle = np.array([point.angle for point in self.table])
            curve = MonotoneCubic(
                angle - self.opens, np.array([point.lift for point in self.table])
            )
            return np.where(is_open, curve(np.minimum(past, duration), derivative), 0.0)
        phase = 2.0 * pi * past / duration
        if derivative == 0:
            return np.where(is_open, 0.5 * self.lift_max * (1.0 - np.cos(phase)), 0.0)
        return np.where(is_open, pi * self.lift_max / duration * np.sin(phase), 0.0)

    def flow_area(self, theta: ArrayLike) -> Array:
        """Effective flow area (...), m2, at crank angles (...), rad: the curtain below the head, at
        most a port of 0.85 of its diameter, times the discharge coefficient.
        """
        curtain = pi * self.diameter * self.lift(theta)
        port = 0.25 * pi * (0.85 * self.diameter) ** 2
        return np.asarray(self.discharge_coefficient * np.minimum(curtain, port))


def intake_valve(engine: CylinderEngine) -> Valve:
    """Intake valve of a cylinder model."""
    return Valve(
        *engine.intake_window,
        engine.valve_lift,
        engine.intake_valve_diameter,
        engine.valve_discharge_coefficient,
        engine.intake_lift_table,
    )


def exhaust_valve(engine: CylinderEngine) -> Valve:
    """Exhaust valve of a cylinder model."""
    return Valve(
        *engine.exhaust_window,
        engine.valve_lift,
        engine.exhaust_valve_diameter,
        engine.valve_discharge_coefficient,
        engine.exhaust_lift_table,
    )


def nozzle_flow(
    pressure_up: float,
    temperature_up: float,
    pressure_down: float,
    gas_constant: float,
    gamma: float,
) -> float:
    """Isentropic nozzle mass flow per area, choked or not, kg/(s m2).

    Parameters
    ----------
    pressure_up, temperature_up : float    of the gas at rest upstream, Pa and K
    pressure_down : float                  Pa, at most `pressure_up`
    gas_constant, gamma : float            J/(kg K) and 1, of the gas upstream

    References
    ----------
    Heywood (1988), appendix C, eqs C.8 and C.9.
    """
    ratio = pressure_down / pressure_up
    if not ratio > _NOT_CHOKED:
        ratio = max(ratio, (2.0 / (gamma + 1.0)) ** (gamma / (gamma - 1.0)))
    opened: float = ratio ** (1.0 / gamma)
    expansion = 1.0 - ratio / opened
    speed = 0.0 if expansion <= 0.0 else 2.0 * gamma / (gamma - 1.0) * expansion
    difference = 1.0 - ratio
    straight = difference / (difference + NEARLY_EQUAL)
    return pressure_up / sqrt(gas_constant * temperature_up) * opened * sqrt(speed * straight)


def rocker_of(engine: CylinderEngine) -> RockerLinkage:
    """Rocker between the cam and each valve."""
    return RockerLinkage.of_ratio(engine.rocker_ratio)


def tappet_force(engine: CylinderEngine, valve: Valve, theta: ArrayLike) -> Array:
    """Force of the valve spring on the cam, through the rocker, at crank angles (...), rad, while
    the valve is open, else zero, N.
    """
    lift = valve.lift(theta)
    spring = engine.valve_spring_rate * lift + engine.valve_spring_preload
    rocker = rocker_of(engine)
    return np.where(lift > 0.0, rocker.ratio(rocker.follower(lift)) * spring, 0.0)


def valve_train_torque(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Torque of the springs of both valves on the crank, N m, at crank angles (...), rad, positive
    when they drive it.

    Without friction the rocker ratio cancels: it raises the force on the cam by as much as it
    reduces the cam lift.
    """
    total, rocker = np.zeros(np.shape(theta)), rocker_of(engine)
    for valve in (intake_valve(engine), exhaust_valve(engine)):
        cam_travel_rate = valve.lift(theta, 1) / rocker.ratio(rocker.follower(valve.lift(theta)))
        total = total - tappet_force(engine, valve, theta) * cam_travel_rate
    return total
