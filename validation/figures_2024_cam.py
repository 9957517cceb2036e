"""Figures of Cardoso et al. (2024): torques at 800 rpm, cam without losses, torque and speed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.engine.crankshaft import Inertia, crank_motion
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from validation.balancing_cam import PRIME_RADIUS, RATIO, designed_pitch
from validation.cardoso_2024 import FOLLOWER, SPRING, UNSMOOTHED
from validation.figures_2025_cam import (
    X,
    Y,
    roller_outlines,
)
from validation.figures_2025_engine import on_cycle
from validation.follower_contours import ROLLER_RADIUS
from validation.paper_engines import (
    EFFECTIVE_INERTIA,
    ENGINE_800,
    FULL_LOAD_800,
    SLOW_IDLE,
)
from validation.paper_figure import (
    CRANK,
    MUTED,
    SPEED,
    TORQUE,
    PaperFigure,
    PaperPanel,
    beside,
)
from validation.published_figures import Target

PRELOAD_ENERGY = 0.5 * SPRING.preload**2 / SPRING.rate
"""Energy of the preloaded spring, J."""
COMPONENTS = {"gas": "gas", "inertia": "inertia of piston and rod", "valve_train": "valve train"}


def figures(targets: Mapping[str, Target]) -> tuple[PaperFigure, ...]:
    """Figures 4, 6, 8, 15 to 18, 20 and 21 of the paper."""
    idle = torque_from_cylinder(ENGINE_800, SLOW_IDLE)
    about = idle.without_mean().total
    pitch = designed_pitch(about, RATIO, UNSMOOTHED, FOLLOWER)
    parts = {COMPONENTS[name]: idle.components[name] for name in COMPONENTS}
    return (
        _torques(targets, parts, about),
        _outlines(targets, pitch),
        _balance(targets, about, pitch),
    )


def _torques(
    targets: Mapping[str, Target], parts: Mapping[str, Array], about: Array
) -> PaperFigure:
    loaded = torque_from_cylinder(FULL_LOAD_800, SLOW_IDLE)
    strokes = loaded.total.reshape(4, -1).mean(axis=1)
    share = float(strokes[2] / np.abs(np.delete(strokes, 2)).mean())
    peaks = [float(np.abs(parts[COMPONENTS[name]]).max()) for name in ("valve_train", "inertia")]
    intake = abs(float(parts["gas"].reshape(4, -1)[0].mean()))
    alike = ", ".join(f"{value:.2f}" for value in (*peaks, intake))
    return PaperFigure(
        "c24-torque", "C24", "4, 6, 8 and 15", "Torques of the engine at 800 rpm",
        "Above: torque of the gas at idle and at full load. Middle: the two small torques at "
        "idle. Below: their sum with the gas about its mean, for which the cam is cut. The valve "
        "spring has 5884 N/m (0.6 kgf/mm); the 588 000 N/m printed would give a hundred times "
        "the torque.",
        (
            PaperPanel(CRANK, TORQUE, (
                on_cycle("gas, idle", parts["gas"]),
                on_cycle("gas, full load", loaded.components["gas"], 1),
            )),
            PaperPanel(CRANK, TORQUE, tuple(
                on_cycle(COMPONENTS[name], parts[COMPONENTS[name]], k)
                for k, name in enumerate(("inertia", "valve_train"), start=2)
            )),
            PaperPanel(CRANK, TORQUE, (on_cycle("idle, all torques about their mean", about),)),
        ),
        (
            beside(targets, "C24-01", share),
            beside(targets, "C24-02", alike, note="N m"),
        ),
    )  # fmt: skip


def _outlines(targets: Mapping[str, Target], pitch: PitchCurve) -> PaperFigure:
    radius = PRIME_RADIUS + pitch.lift.highest.value
    stored = SPRING.energy(pitch.lift.stroke)
    return PaperFigure(
        "c24-cam", "C24", "16", "Cam with and without a roller, 800 rpm",
        "Cam without losses for the idle torque, spring of 100 kN/m and 100 N. The roller has "
        "8 mm; the 80 mm printed is larger than the cam. The radius grows from 50 mm: below it "
        f"the preload stores {PRELOAD_ENERGY:.2g} J, and the cycle of the engine needs "
        f"{stored:.3g} J.",
        (PaperPanel(X, Y, roller_outlines(pitch, ROLLER_RADIUS), kind="outline"),),
        (beside(targets, "C24-04", 1e3 * radius, note="maximum"),),
    )  # fmt: skip


def _balance(targets: Mapping[str, Target], about: Array, pitch: PitchCurve) -> PaperFigure:
    lift, slope = pitch.lift.derivatives(uniform_turn(about.size), 1)
    delivered = -SPRING.force(lift) * slope / RATIO
    left = about + delivered
    inertia = Inertia.constant_only(EFFECTIVE_INERTIA, about.size)
    without, with_cam = (crank_motion(t, inertia, SLOW_IDLE).speed for t in (about, left))
    return PaperFigure(
        "c24-balance", "C24", "17, 18, 20 and 21", "Torque and speed with and without the cam",
        "800 rpm, without losses. The cam from the stored energy takes the torque to round-off, "
        "apart from the corners where the valves move; the recursion printed, at steps of 1 deg, "
        f"does not close by {1e3 * printed_gap(about, pitch):.2f} mm. Speed with "
        f"{EFFECTIVE_INERTIA:g} kg m\u00b2, tuned to the engine at 1500 rpm; none is printed.",
        (
            PaperPanel(CRANK, TORQUE, (
                on_cycle("engine without the cam", about, MUTED, "dashed"),
                on_cycle("mechanism", delivered, 0),
                on_cycle("engine with the cam", left, 1),
            )),
            PaperPanel(CRANK, SPEED, (
                on_cycle("engine without the cam", without, MUTED, "dashed"),
                on_cycle("engine with the cam", with_cam, 1),
            )),
        ),
        (beside(targets, "C24-03", float(left.std()), note="standard deviation"),),
    )  # fmt: skip


def printed_gap(about: Array, pitch: PitchCurve) -> float:
    """Gap of the recursion printed (eqs 17 and 18) after a turn from the minimum radius, m."""
    start = int(pitch.lift(uniform_turn(about.size)).argmin())
    step, radius = 2.0 * np.pi / about.size, PRIME_RADIUS
    for torque in np.roll(RATIO * about, -start):
        radius += step * float(torque) / float(SPRING.force(np.array(radius - PRIME_RADIUS)))
    return abs(radius - PRIME_RADIUS)
