"""Cardoso et al., Designs 8, 47 (2024): engine at 800 rpm and cam without losses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from camwright.pipeline.follower.follower_forces import FollowerSystem
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.smoothing.smoothers import Smoother
from validation import validation_figures
from validation.balancing_cam import PRIME_RADIUS, RATIO, designed_pitch
from validation.paper_engines import ENGINE_800, FULL_LOAD_800, SLOW_IDLE
from validation.paper_figure import records
from validation.published_figures import (
    FigureOutcome,
    PaperResult,
    Target,
    judged,
)

PRINTED_VALVE_SPRING = 588_000.0  # N/m, table 1
# Table 2: k and P; guides and mass have no effect without losses.
SPRING = Spring(rate=100_000.0, preload=100.0)
FOLLOWER = FollowerSystem(0.0, SPRING, 0.08, 0.03, 0.0, 0.0)
UNSMOOTHED = Smoother("none")


def study(targets: Mapping[str, Target]) -> PaperResult:
    """Outcome of each value of the paper."""
    torque = torque_from_cylinder(ENGINE_800, SLOW_IDLE).without_mean()
    cams = {
        name: designed_pitch(torque.total, multiplier, UNSMOOTHED, FOLLOWER)
        for name, multiplier in (("full", 2.0), ("half", 1.0))
    }
    full_load = torque_from_cylinder(FULL_LOAD_800, SLOW_IDLE).total
    outcomes = {
        "C24-01": _expansion(targets["C24-01"], full_load),
        "C24-02": _magnitudes(targets["C24-02"]),
        **_cam_rows(targets, torque.total, cams["full"]),
    }
    rows = [
        {
            "cut_for": name,
            "lift_mm": 1e3 * pitch.lift.stroke,
            "radius_max_mm": 1e3 * (PRIME_RADIUS + pitch.lift.highest.value),
            "spring_force_max_N": float(SPRING.force(np.array(pitch.lift.stroke))),
            "pressure_angle_max_deg": float(
                np.degrees(np.abs(pitch.pressure_angle(uniform_turn(720))).max())
            ),
        }
        for name, pitch in cams.items()
    ]
    left = _left(torque.total, cams["full"])
    lift = cams["full"].lift.derivatives(uniform_turn(torque.total.size), 0)[0]
    drawn = (
        validation_figures.engine_at_800(targets, torque, full_load),
        validation_figures.cam_without_losses(
            targets, torque.total, left, 1e3 * (PRIME_RADIUS + lift)
        ),
    )
    return PaperResult(outcomes, {"cam of the 800 rpm engine": rows}, records(drawn))


def _expansion(target: Target, torque: Array) -> FigureOutcome:
    strokes = torque.reshape(4, -1).mean(axis=1)
    share = float(strokes[2] / np.abs(np.delete(strokes, 2)).mean())
    return judged(target, share, "mean torque of the strokes at full load, 98 kPa")


def _magnitudes(target: Target) -> FigureOutcome:
    torque = torque_from_cylinder(ENGINE_800, SLOW_IDLE)
    parts = torque.components
    printed = torque_from_cylinder(
        replace(ENGINE_800, valve_spring_rate=PRINTED_VALVE_SPRING), SLOW_IDLE
    ).components["valve_train"]
    strokes = parts["gas"].reshape(4, -1)
    gas = float(np.abs(strokes[0].mean()))
    valve, inertia = (float(np.abs(parts[name]).max()) for name in ("valve_train", "inertia"))
    values = [round(value, 2) for value in (valve, inertia, gas)]
    return judged(
        target,
        values,
        "valve, inertia and intake torque in N m with a valve spring of 5884 N/m; the printed "
        f"588 000 N/m gives {np.abs(printed).max():.3g} N m",
    )


def _left(torque: Array, pitch: PitchCurve) -> Array:
    """Torque about its mean (n,) that a cam leaves without losses, N m."""
    lift, slope = pitch.lift.derivatives(uniform_turn(torque.size), 1)
    return np.asarray(torque - torque.mean() - SPRING.force(lift) * slope / RATIO)


def _cam_rows(
    targets: Mapping[str, Target], torque: Array, pitch: PitchCurve
) -> dict[str, FigureOutcome]:
    left = float(np.std(_left(torque, pitch)))
    radius = 1e3 * (PRIME_RADIUS + pitch.lift.highest.value)
    return {
        "C24-03": judged(
            targets["C24-03"], left, "std in N m left over without losses", published=0.0
        ),
        "C24-04": judged(
            targets["C24-04"],
            radius,
            "the radius must grow from 50 mm: below it the preload stores 0.05 J",
        ),
    }
