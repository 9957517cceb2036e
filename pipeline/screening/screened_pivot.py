"""Screening of the edge pressure in the bush of the pivot of an arm, by slices."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.material import ROOM
from camwright.pipeline.case.case import Case
from camwright.pipeline.cycle.part_loads import BushLoad, PivotPush
from camwright.pipeline.follower.follower_forces import JAM_FLOOR, share_left
from camwright.pipeline.follower.guide_friction import bush_temperature, thermal_resistance
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.screening.design_arrays import Designs, Judged
from camwright.pipeline.screening.screened_cam import ScreenedCam


def edge_pressure(designs: Designs) -> Judged | None:
    """Greatest pressure between pin and bush of a pivot and the yield strength of the bush at its
    temperature (m,), Pa; None without a bush.
    """
    if designs.case.follower.pivot is None or designs.case.follower.pivot.bush is None:
        return None
    limits = np.full(designs.count, np.nan)
    pressures = limits.copy()
    for k, case in enumerate(designs.cases):
        pivot = case.follower.pivot
        if pivot is not None and pivot.bush is not None:
            pressures[k] = np.max([_pressure(cam, case, k) for cam in designs.cams])
            heat = np.max([_heat(cam)[k] for cam in designs.cams])
            path = thermal_resistance(pivot.bush), pivot.ambient_temperature
            warm = float(bush_temperature(float(heat), *path))
            limits[k] = _strength(pivot.bush, warm, float(pressures[k]))
    return pressures, limits


def _pressure(cam: ScreenedCam, case: Case, k: int) -> float:
    """Greatest pressure in the bush over the turn of design k, Pa; NaN where it is not known."""
    pivot, load = case.follower.pivot, cam.bush_load
    if load is None or pivot is None or pivot.bush is None or pivot.pin_material is None:
        return np.nan
    force, couple, beside = load.force[k], load.couple[k], load.beside[k]
    bush = BushLoad(pivot.bush, force, couple, beside)
    push = PivotPush.under(pivot.bush, pivot.pin_material, bush)
    return float(push.edge_pressure.max()) if np.isfinite([force, couple]).all() else np.nan


def _heat(cam: ScreenedCam) -> Array:
    """Mean friction power of the pivot at its greatest friction (m,), W; NaN where it is not known
    or the follower locks.
    """
    if cam.pivot_heat is None:
        return np.full(len(cam.normal), np.nan)
    locks = share_left(cam.direction, cam.jam_worst, cam.motion.lock) <= JAM_FLOOR
    return np.mean(np.where(locks, np.nan, cam.pivot_heat), axis=-1)


def _strength(bush: Guide, temperature: float, pressure: float) -> float:
    """Yield strength of a bush at its temperature, K, Pa: that at 20 degC without one, and NaN
    beyond its card unless a pressure, Pa, is above that.
    """
    strength = bush.material.yield_strength_at
    cold = float(strength(ROOM))
    warm = cold if np.isnan(temperature) else float(strength(temperature))
    return cold if np.isnan(warm) and pressure > cold else warm
