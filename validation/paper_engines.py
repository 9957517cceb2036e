"""Engines of the papers in the cylinder model, with tuned parameters."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import degrees, radians

from scipy.optimize import brentq

from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from camwright.pipeline.torque.torque import Torque

IDLE_SPEED = 157.08  # rad/s, 1500 rpm
SLOW_IDLE = 83.8  # rad/s, 800 rpm
EFFECTIVE_INERTIA = 0.0139  # kg m2, tuned to the measured ripple

# Tuned to the measured idle: intake pressure, spark, burn duration, combustion efficiency.
GX120 = CylinderEngine(
    bore=0.060,
    crank_radius=0.021,
    rod_length=0.073,
    compression_ratio=8.5,
    piston_mass=0.144,
    rod_mass=0.123,
    intake_pressure=30.5e3,
    spark=radians(335.0),
    burn_duration=radians(80.0),
    combustion_efficiency=0.9,
)
TUNED = {
    "intake_pressure_kPa": 1e-3 * GX120.intake_pressure,
    "spark_deg": degrees(GX120.spark),
    "burn_duration_deg": degrees(GX120.burn_duration),
    "combustion_efficiency": GX120.combustion_efficiency,
    "inertia_kg_m2": EFFECTIVE_INERTIA,
}

ENGINE_800 = replace(
    GX120,
    crank_radius=0.022,
    intake_pressure=28.2e3,
    spark=radians(345.0),
    burn_duration=radians(65.0),
    combustion_efficiency=0.85,
)
FULL_LOAD_800 = replace(
    ENGINE_800,
    intake_pressure=98e3,
    spark=radians(340.0),
    burn_duration=radians(50.0),
    combustion_efficiency=0.95,
    friction_pressure=0.0,
)


@cache
def balanced_torque(engine: CylinderEngine, speed: float) -> Torque:
    """Torque of an engine about its mean at a speed (rad/s), computed once."""
    return torque_from_cylinder(engine, speed).without_mean()


@cache
def with_peak_torque(peak: float) -> CylinderEngine:
    """GX120 with faster, later burn and the intake pressure of a peak torque (N m)."""
    fast = replace(GX120, spark=radians(342.0), burn_duration=radians(50.0))

    def excess(pressure: float) -> float:
        engine = replace(fast, intake_pressure=pressure)
        return torque_from_cylinder(engine, IDLE_SPEED).peak - peak

    pressure_for_peak = brentq(excess, 34e3, 60e3, xtol=20.0, maxiter=12)
    return replace(fast, intake_pressure=float(pressure_for_peak))
