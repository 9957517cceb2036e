"""Cardoso et al., Energies 18 (2025) 3256: GX120 at idle and its balancing cam.

The torque of the published cam is not printed. Values of the stock engine are compared with the
cylinder model, tuned to the measured idle; values of the cam with a cam for the speed
reconstructed from the published statistics, as the paper designed its cam from a measured speed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.crankshaft import CrankMotion, Inertia, crank_motion
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from camwright.pipeline.engine.torque_consistency import implied_inertia
from camwright.pipeline.torque.torque import Torque
from validation import speed_reconstruction, validation_figures
from validation.balancing_cam import (
    POSITIONS,
    RATIO,
    TWELVE_DEGREES,
    TWELVE_TEETH,
    TWELVE_VALUES,
    Balanced,
    balanced,
)
from validation.follower_contours import follower_contours
from validation.paper_engines import (
    EFFECTIVE_INERTIA,
    GX120,
    IDLE_SPEED,
    TUNED,
    with_peak_torque,
)
from validation.paper_figure import PaperFigure, records
from validation.published_figures import (
    FigureOutcome,
    PaperResult,
    Target,
    judged,
)

PRELOADS = (121.0, 242.0, 363.0)
MULTIPLIERS = {"full": 2.0, "half": 1.0}
MOUNTED = (
    3.74 / 3.58 - 1.0
)  # inertia of the mounted mechanism over that of the engine, by the printed speeds
SPRING_RATE = 24_200.0


def study(targets: Mapping[str, Target]) -> PaperResult:
    """Outcome of each value of the paper that can be computed, the studies and figures."""
    idle = torque_from_cylinder(GX120, IDLE_SPEED).without_mean()
    rebuilt = speed_reconstruction.load()
    stock = _motion(idle.total)
    mounted = _motion(idle.total, 1.0 + MOUNTED)
    engine = with_peak_torque(targets["C25-02"].value)
    fast = torque_from_cylinder(engine, IDLE_SPEED).without_mean()
    fast_motion = _motion(fast.total)
    cams, windows = _cams(rebuilt.torque_at(POSITIONS), rebuilt.inertia), _windows(rebuilt)
    outcomes = {
        **_stock(targets, idle, stock),
        **_fast_burn(targets, engine, fast, fast_motion),
        **_mounted(targets, stock, mounted),
        **_engaged(targets, cams, windows),
        **_arithmetic(targets),
        "C25-29": _inertia(targets["C25-29"], rebuilt, idle, stock),
    }
    drawn = (
        validation_figures.engine_simulation(targets, fast, fast_motion),
        validation_figures.stock_engine(targets, rebuilt, idle, stock, mounted.speed),
        _engaged_figure(targets, rebuilt, cams),
    )
    return PaperResult(outcomes, _studies(idle.total, cams, windows, rebuilt, stock),
                       records(drawn))  # fmt: skip


def _motion(torque: Array, times: float = 1.0) -> CrankMotion:
    """Crank motion under a torque (n,), N m, with a multiple of the effective inertia."""
    return crank_motion(
        torque, _constant(times * EFFECTIVE_INERTIA), speed_reconstruction.SPEED_MEAN
    )


def _constant(value: float) -> Inertia:
    return Inertia.constant_only(value, POSITIONS)


Cams = Mapping[tuple[str, float], Balanced]


def _cams(torque: Array, inertia: float) -> Cams:
    """Cams for the full and half the torque at the three preloads."""
    return {
        (name, preload): balanced(
            torque,
            inertia,
            speed_reconstruction.SPEED_MEAN,
            multiplier=multiplier,
            preload=preload,
            added=MOUNTED * inertia,
        )
        for name, multiplier in MULTIPLIERS.items()
        for preload in PRELOADS
    }


def _stock(
    targets: Mapping[str, Target], torque: Torque, motion: CrankMotion
) -> dict[str, FigureOutcome]:
    """Values of the measured stock engine by the cylinder model."""
    ripple, speed = motion.statistics, motion.speed
    late = speed[int(450 / 720 * speed.size) :]
    model = "of the cylinder model"

    def near(row: str, obtained: float, reason: str, angle: float | None = None) -> FigureOutcome:
        return judged(
            targets[row],
            float(obtained),
            f"{reason}{model}",
            angle_deg=None if angle is None else float(np.degrees(angle)),
        )

    return {
        "C25-03": near("C25-03", torque.peak, "peak "),
        "C25-06": near("C25-06", ripple.minimum,
                       f"at {np.degrees(ripple.minimum_angle):.0f} deg ", ripple.minimum_angle),
        "C25-07": near("C25-07", ripple.maximum,
                       f"at {np.degrees(ripple.maximum_angle):.0f} instead of about 450 deg ",
                       ripple.maximum_angle),
        "C25-08": near("C25-08", ripple.std, f"with {EFFECTIVE_INERTIA:g} kg m2, "),
        "C25-11": near("C25-11", torque.std, ""),
        "C25-12": near("C25-12", torque.peak_to_peak, ""),
        "C25-31": near("C25-31", speed[speed.size // 4], ""),
        "C25-32": near("C25-32", float(late.mean()), "mean from 450 to 720 deg "),
        "C25-33": _pumping(targets["C25-33"], torque),
    }  # fmt: skip


def _pumping(target: Target, torque: Torque) -> FigureOutcome:
    """Sign of the torque about 90 deg: pumping against the throttled intake."""
    at = np.degrees(torque.theta)
    pumping = float(torque.total[(at >= 40.0) & (at <= 140.0)].mean())
    sign = "negative" if pumping < 0.0 else "positive"
    return judged(target, sign, f"mean torque from 40 to 140 deg of {pumping:.3g} N m")


def _fast_burn(
    targets: Mapping[str, Target], engine: CylinderEngine, torque: Torque, motion: CrankMotion
) -> dict[str, FigureOutcome]:
    """Values of the engine simulation of the paper, by the model at its peak torque."""
    ripple = motion.statistics
    least, most = (
        float(np.degrees(angle)) for angle in (ripple.minimum_angle, ripple.maximum_angle)
    )
    swing = targets["C25-05"].value - targets["C25-04"].value
    reason = (
        f"swing of {ripple.peak_to_peak:.3g} against {swing:g} rad/s with the effective inertia"
    )
    return {
        "C25-01": judged(targets["C25-01"], torque.peak_to_peak,
                         "with a peak of 45 N m the compression takes more than the 5 N m printed"),
        "C25-02": judged(targets["C25-02"], torque.peak,
                         f"intake pressure {1e-3 * engine.intake_pressure:.3g} kPa; not an "
                         "unloaded idle"),
        "C25-04": judged(targets["C25-04"], ripple.minimum, reason, angle_deg=least),
        "C25-05": judged(targets["C25-05"], ripple.maximum, reason, angle_deg=most),
    }  # fmt: skip


def _mounted(
    targets: Mapping[str, Target], stock: CrankMotion, mounted: CrankMotion
) -> dict[str, FigureOutcome]:
    """Values with the mechanism mounted and disengaged: its inertia alone."""
    ripple = mounted.statistics
    why = f"{100 * MOUNTED:.2g} % more inertia"
    return {
        "C25-09": judged(targets["C25-09"], ripple.std, why),
        "C25-10": judged(targets["C25-10"], ripple.peak_to_peak,
                         f"{why}; stock {stock.statistics.peak_to_peak:.4g} rad/s"),
    }  # fmt: skip


ENGAGED = {
    "C25-14": ("torque_std_Nm", 242.0), "C25-15": ("torque_p2p_Nm", 242.0),
    "C25-16": ("torque_std_Nm", 242.0), "C25-17": ("torque_p2p_Nm", 242.0),
    "C25-18": ("speed_std_rad_per_s", 242.0), "C25-19": ("speed_p2p_rad_per_s", 242.0),
    "C25-20": ("speed_std_rad_per_s", 242.0), "C25-21": ("speed_p2p_rad_per_s", 242.0),
    "C25-22": ("speed_std_rad_per_s", 121.0), "C25-23": ("speed_p2p_rad_per_s", 121.0),
    "C25-24": ("speed_std_rad_per_s", 363.0), "C25-25": ("speed_p2p_rad_per_s", 363.0),
}  # fmt: skip
"""Values of the engaged mechanism: figure of the cam, and preload in N. One rule judges all."""


def _engaged(
    targets: Mapping[str, Target], cams: Cams, windows: Sequence[Mapping[str, Any]]
) -> dict[str, FigureOutcome]:
    """Values of the engaged mechanism; by power the cam torque is twice the crank torque."""
    figures = {key: cam.figures() for key, cam in cams.items()}
    outcomes = {
        row: judged(
            targets[row],
            figures["full", preload][name],
            "cam cut for the full torque, by power; for half of it, the printed equation without "
            f"the gear ratio, {figures['half', preload][name]:.3g}",
        )
        for row, (name, preload) in ENGAGED.items()
    }
    chosen, *others = (row for row in windows if row["cut_for"] == "full")
    beside = ", ".join(f"{row['window_deg']:.0f} deg {row['torque_std_Nm']:.3g}" for row in others)
    outcomes["C25-13"] = judged(
        targets["C25-13"],
        chosen["torque_std_Nm"],
        f"12 values over {chosen['window_deg']:.0f} deg, a chosen window; {beside} N m",
    )
    stds = {p: figures["full", p]["speed_std_rad_per_s"] for p in PRELOADS}
    halves = {p: figures["half", p]["speed_std_rad_per_s"] for p in PRELOADS}
    outcomes["C25-26"] = judged(
        targets["C25-26"],
        _order(stds),
        f"speed std with the full torque; half the torque gives {_order(halves)}",
    )
    return outcomes


def _engaged_figure(
    targets: Mapping[str, Target], rebuilt: speed_reconstruction.Reconstruction, cams: Cams
) -> PaperFigure:
    stds = {
        name: {p: cams[name, p].study.after.statistics.std for p in PRELOADS}
        for name in MULTIPLIERS
    }
    printed = {
        preload: float(targets[row].value)
        for preload, row in zip(PRELOADS, ("C25-22", "C25-18", "C25-24"), strict=True)
    }
    return validation_figures.engaged_mechanism(
        targets,
        rebuilt.torque_at(POSITIONS),
        {name: cams[name, PRELOADS[1]] for name in MULTIPLIERS},
        stds,
        printed,
    )


def _order(stds: Mapping[float, float]) -> str:
    return " < ".join(f"{preload:g}" for preload in sorted(stds, key=lambda p: stds[p]))


def _arithmetic(targets: Mapping[str, Target]) -> dict[str, FigureOutcome]:
    """Values that follow from other printed values, or are inputs."""

    def value(number: int) -> float:
        return float(targets[f"C25-{number:02d}"].value)

    pairs = ((12, 15), (11, 14), (10, 19), (9, 18))
    reductions = [round(100 * (1 - value(after) / value(before)), 1) for before, after in pairs]
    return {
        "C25-27": judged(targets["C25-27"], reductions, "one less the ratio of printed values"),
        "C25-28": FigureOutcome(None, "not decidable",
                          "a property of the sensor; it enters as the noise of tooth times"),
        "C25-30": judged(targets["C25-30"], SPRING_RATE * 0.01, "k times 10 mm of compression"),
    }  # fmt: skip


def _inertia(
    target: Target, rebuilt: speed_reconstruction.Reconstruction, idle: Torque, stock: CrankMotion
) -> FigureOutcome:
    printed = sum(target.value)
    ripple = stock.statistics
    implied = implied_inertia(idle.total, ripple.mean, 3.74)
    sums = sorted((round(rebuilt.inertia, 5), round(implied, 5)))
    return judged(
        target,
        sums,
        f"sum implied by the printed speeds with the printed torque and with the model's, against "
        f"{printed:.4g} kg m2 printed: {sums[0] / printed:.2g} times as much",
        published=printed,
    )


def _windows(rebuilt: speed_reconstruction.Reconstruction) -> list[dict[str, Any]]:
    """Cams by the window of the moving average, that of the judged rows first."""
    return [
        {
            "window_deg": float(np.degrees(smoother.angular_width)),
            "cut_for": name,
            **balanced(
                rebuilt.torque_at(POSITIONS), rebuilt.inertia, speed_reconstruction.SPEED_MEAN,
                multiplier=multiplier, smoother=smoother, added=MOUNTED * rebuilt.inertia,
            ).figures(),
        }
        for smoother in (TWELVE_VALUES, TWELVE_DEGREES, TWELVE_TEETH)
        for name, multiplier in MULTIPLIERS.items()
    ]  # fmt: skip


def _studies(
    idle: Array,
    cams: Cams,
    windows: Sequence[Mapping[str, Any]],
    rebuilt: speed_reconstruction.Reconstruction,
    stock: CrankMotion,
) -> dict[str, Any]:
    """Studies of preload, torque multiplier, smoothing window, equivalent flywheel, tuning."""
    rows = [
        {"torque": "reconstruction", "cut_for": name, "preload_N": preload, **cam.figures()}
        for (name, preload), cam in cams.items()
    ]
    modelled = _cams(idle, EFFECTIVE_INERTIA)
    rows += [
        {"torque": "cylinder model", "cut_for": name, "preload_N": preload, **cam.figures()}
        for (name, preload), cam in modelled.items()
    ]
    return {
        "preload, full and half torque": rows,
        "smoothing window": windows,
        "flat face and roller for the same torque": [
            {"cut_for": name, **each.row}
            for name in MULTIPLIERS
            for each in follower_contours(
                cams[name, 242.0].pitch.lift, speed_reconstruction.SPEED_MEAN / RATIO
            )
        ],
        "flywheel of the same speed ripple": [
            _flywheel(name, cams[name, 242.0], rebuilt.inertia) for name in MULTIPLIERS
        ],
        "tuned": [TUNED | {"speed_std_rad_per_s": stock.statistics.std}],
    }


def _flywheel(name: str, cam: Balanced, inertia: float) -> dict[str, Any]:
    """Flywheel of equal speed ripple, its mass at the outer radius of the cam."""
    radius = 0.050 + cam.pitch.lift.highest.value - 0.008
    disc, rim = cam.study.flywheel_masses(radius)
    return {
        "cut_for": name,
        "speed_std_rad_per_s": cam.study.after.statistics.std,
        "added_inertia_kg_m2": cam.study.added_inertia,
        "times_the_engine": cam.study.added_inertia / inertia,
        "outer_radius_mm": 1e3 * radius,
        "disc_mass_kg": disc,
        "rim_mass_kg": rim,
    }
