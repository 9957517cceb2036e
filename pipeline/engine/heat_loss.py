"""Heat transfer from the gas to the walls by the laws of Hohenberg and Woschni."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.cylinder import CYCLE_ANGLE, CylinderEngine

# W/(m2 K), of node, pressure (Pa) and temperature (K)
FilmCoefficient = Callable[[int, float, float], float]

MOTORED_EXPONENT = 1.32  # of the polytropic compression Woschni compares with


@dataclass(frozen=True)
class Charge:
    """State of the gas at intake valve closing: pressure Pa, temperature K, volume m3."""

    pressure: float
    temperature: float
    volume: float


def wall_area(engine: CylinderEngine, theta: ArrayLike) -> Array:
    """Area of piston crown, flat head and exposed liner at crank angles (rad), m2."""
    crown = 0.25 * pi * engine.bore**2
    liner = pi * engine.bore * (engine.linkage.travel(theta) + engine.clearance)
    return np.asarray(2.0 * crown + liner)


def film_coefficient(
    engine: CylinderEngine, crank_speed: float, theta: Array, volume: Array, charge: Charge
) -> FilmCoefficient:
    """Film coefficient of the heat transfer from the gas to the walls, W/(m2 K), as a function of
    node number in the cycle, pressure, Pa, and temperature, K.

    Parameters
    ----------
    engine : CylinderEngine      with the law, "hohenberg" or else Woschni's, and a factor on it
    crank_speed : float          rad/s
    theta, volume : array (n,)   crank angle, rad, and cylinder volume, m3, at the nodes
    charge : Charge              at intake valve close; used by Woschni only

    References
    ----------
    Hohenberg, SAE 790825 (1979): 130 V^-0.06 p^0.8 T^-0.4 (c_m + 1.4)^0.8, p in bar.
    Woschni, SAE 670931 (1967): 3.26 B^-0.2 p^0.8 T^-0.55 w^0.8, p in kPa;
    Heywood (1988), eqs 12.19 to 12.21.
    """
    piston_speed = engine.stroke * crank_speed / pi
    factor = engine.heat_loss_factor
    if engine.heat_loss == "hohenberg":
        flow = (piston_speed + 1.4) ** 0.8
        hohenberg: list[float] = (factor * 130.0 * flow * volume**-0.06 * 1e-5**0.8).tolist()

        def by_hohenberg(node: int, pressure: float, temperature: float) -> float:
            return float(hohenberg[node] * pressure**0.8 * temperature**-0.4)

        return by_hohenberg

    valve_opens, valve_closes = engine.exhaust_window[0], engine.intake_window[1]
    exchange = np.mod(theta - valve_opens, CYCLE_ANGLE) < (valve_closes - valve_opens) % CYCLE_ANGLE
    burnt = np.mod(theta - engine.spark, CYCLE_ANGLE) < (valve_opens - engine.spark) % CYCLE_ANGLE
    displaced = engine.displacement * charge.temperature / (charge.pressure * charge.volume)
    stirring: list[float] = (np.where(exchange, 6.18, 2.28) * piston_speed).tolist()
    burning: list[float] = np.where(burnt, 3.24e-3 * displaced, 0.0).tolist()
    motored: list[float] = (charge.pressure * (charge.volume / volume) ** MOTORED_EXPONENT).tolist()
    scale = factor * 3.26 * engine.bore**-0.2 * 1e-3**0.8

    def by_woschni(node: int, pressure: float, temperature: float) -> float:
        rise = pressure - motored[node]
        flow = stirring[node] + (burning[node] * rise if rise > 0.0 else 0.0)
        return float(scale * (pressure * flow) ** 0.8 * temperature**-0.55)

    return by_woschni
