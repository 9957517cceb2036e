"""Figures of Cardoso et al. (2025) from the cam on: smoothing, outlines, friction, preloads."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.limits import UNDERCUT_FACTOR
from camwright.pipeline.smoothing.smoothers import smoothed
from validation import speed_reconstruction
from validation.balancing_cam import (
    POSITIONS,
    RATIO,
    TWELVE_DEGREES,
    TWELVE_TEETH,
    TWELVE_VALUES,
    Balanced,
    balanced,
)
from validation.cardoso_2025 import MOUNTED, MULTIPLIERS, PRELOADS
from validation.figures_2025_engine import on_cycle
from validation.follower_contours import (
    FACE_FRICTION,
    ROLLER_RADIUS,
    follower_contours,
)
from validation.paper_figure import (
    CRANK,
    MUTED,
    SPEED,
    TORQUE,
    Beside,
    Look,
    PaperCurve,
    PaperFigure,
    PaperPanel,
    beside,
    outline,
)
from validation.published_figures import Target

X, Y = "x, mm", "y, mm"
DESIGN = 242.0
WINDOWS = {
    "120 deg": TWELVE_TEETH,
    "60 deg": TWELVE_VALUES,
    "12 deg": TWELVE_DEGREES,
}
"""Window of a moving average of 12 values, of which the paper does not state the spacing."""
CUT_FOR = {
    "full": "cut for the full engine torque",
    "half": "cut by the printed equations, for half of it",
}
TITLES = {"full": "Full engine torque", "half": "Half of it"}
OUTLINE_POINTS = 360
Cams = Mapping[tuple[str, float], Balanced]


def figures(targets: Mapping[str, Target]) -> tuple[PaperFigure, ...]:
    """Figures 11, 12, 14, 15 and 24 to 29 of the paper."""
    rebuilt = speed_reconstruction.load()
    torque = rebuilt.torque_at(POSITIONS)
    cams = {
        (name, preload): _cam(torque, rebuilt.inertia, multiplier, preload)
        for name, multiplier in MULTIPLIERS.items()
        for preload in PRELOADS
    }
    return (
        _smoothing(targets, torque, rebuilt.inertia),
        _outlines(cams),
        _faces(cams["full", DESIGN]),
        _mechanism(cams["full", DESIGN]),
        _balance(targets, torque, cams["full", DESIGN]),
        *(_preloads(targets, torque, cams, name) for name in MULTIPLIERS),
        _with_and_without(targets, torque, cams),
    )


def _cam(torque: Array, inertia: float, multiplier: float, preload: float) -> Balanced:
    return balanced(
        torque, inertia, speed_reconstruction.SPEED_MEAN, multiplier=multiplier, preload=preload,
        added=MOUNTED * inertia,
    )  # fmt: skip


def _smoothing(targets: Mapping[str, Target], torque: Array, inertia: float) -> PaperFigure:
    curves, values = [on_cycle("engine torque, reconstructed", torque)], []
    for k, (name, smoother) in enumerate(WINDOWS.items(), start=1):
        curves.append(on_cycle(f"mean over {name}", smoothed(torque, smoother), k))
        cam = balanced(
            torque, inertia, speed_reconstruction.SPEED_MEAN, smoother=smoother,
            added=MOUNTED * inertia,
        )  # fmt: skip
        std = float(cam.residual.std())
        values.append(beside(targets, "C25-13", std, note=f"window of {name}"))
    return PaperFigure(
        "c25-smoothing", "C25", "11", "Engine torque and its moving average of 12 values",
        "The paper does not state the spacing of the values: 10 deg of the teeth, 5 deg of both "
        "edges or 1 deg of its simulation. 60 deg is taken in the other figures because it is the "
        "only one near the printed standard deviation of the compensated torque.",
        (PaperPanel(CRANK, TORQUE, tuple(curves)),),
        tuple(values),
    )  # fmt: skip


def _outlines(cams: Cams) -> PaperFigure:
    panels, values = [], []
    for name, words in CUT_FOR.items():
        pitch = cams[name, DESIGN].pitch
        outlines = roller_outlines(pitch, ROLLER_RADIUS)
        panels.append(PaperPanel(X, Y, outlines, title=TITLES[name], kind="outline"))
        radius = np.hypot(*pitch.points(uniform_turn(POSITIONS)))
        values.append(
            Beside(f"minimum radius of the pitch curve, cam {words}", 50.0,
                   1e3 * float(radius.min()), "mm", "imposed")
        )  # fmt: skip
    return PaperFigure(
        "c25-cam", "C25", "12", "Cam with and without a roller",
        "The curve printed as the cam of a flat follower is the path of the roller centre, "
        "(r cos, r sin) of equations 7 and 8; the cam with the 8 mm roller lies inside it. Under a "
        "flat face neither gives the torque: c25-faces has the one that does.",
        tuple(panels),
        tuple(values),
        columns=2,
    )  # fmt: skip


def roller_outlines(pitch: PitchCurve, roller_radius: float) -> tuple[PaperCurve, ...]:
    """Contour under a roller, pitch curve and base circle."""
    theta = uniform_turn(OUTLINE_POINTS)
    contour = RollerContour(pitch, roller_radius).points(theta)
    circle = pitch.radius_base * np.stack([np.cos(theta), np.sin(theta)])
    return (
        PaperCurve("cam with the roller", *outline(contour), 0, "fill"),
        PaperCurve("cam without a roller, as printed", *outline(pitch.points(theta)), 1),
        PaperCurve("circle of the minimum radius", *outline(circle), MUTED, "dotted"),
    )


def _faces(cam: Balanced) -> PaperFigure:
    """Roller and flat faces for the same torque, at the design preload."""
    contours = follower_contours(cam.pitch.lift, speed_reconstruction.SPEED_MEAN / RATIO)
    looks: tuple[Look, ...] = ("fill", "dashed", "line")
    curves = tuple(
        PaperCurve(contour.follower, *outline(contour.points), k, look)
        for k, (contour, look) in enumerate(zip(contours, looks, strict=True))
    )
    return PaperFigure(
        "c25-faces", "C25", "12", "Roller and flat faces for the same torque",
        "Cam cut for the full torque. The torque of the spring, F s', follows from the lift alone "
        "and is the same under each follower; the contour is not. On the radius of the roller's "
        "path a flat face has cusps where r + s + s'' < 0, and cannot follow the lift. The least "
        f"base radius with an undercut factor of {UNDERCUT_FACTOR.default:g} makes a much larger "
        f"cam, with more friction on the face (coefficient {FACE_FRICTION:g}, assumed) and less "
        "load on the guides.",
        (PaperPanel(X, Y, curves, kind="outline"),),
        table=tuple(contour.row for contour in contours),
    )  # fmt: skip


def _mechanism(cam: Balanced) -> PaperFigure:
    loads = cam.loads
    parts: tuple[tuple[str, Array, int, Look], ...] = (
        ("spring alone", -cam.spring_torque, 0, "dashed"),
        ("with friction and inertia", -loads.cam_torque / RATIO, 1, "line"),
        ("friction", -cam.friction_torque, 2, "line"),
        ("inertia of the follower", -cam.inertia_torque, 3, "line"),
    )
    return PaperFigure(
        "c25-mechanism", "C25", "14", "Torque of the mechanism on the crank",
        "Constant speed, preload of 242 N, cam cut for the full engine torque smoothed over "
        "60 deg. Guide friction 0.04 and 0.2 and follower mass of 175 g as printed; the overhang "
        "of 30 mm at full lift is assumed, for the paper gives none.",
        (PaperPanel(CRANK, TORQUE, tuple(on_cycle(*part) for part in parts)),),
    )  # fmt: skip


def _balance(targets: Mapping[str, Target], torque: Array, cam: Balanced) -> PaperFigure:
    about = torque - torque.mean()
    return PaperFigure(
        "c25-balance", "C25", "15", "Engine torque, torque of the mechanism and what is left",
        "Constant speed, preload of 242 N, cam cut for the full torque. Engine torque about its "
        "mean, reconstructed from the printed statistics, which imposes its standard deviation.",
        (
            PaperPanel(CRANK, TORQUE, (
                on_cycle("engine", about, 0),
                on_cycle("mechanism", -cam.loads.cam_torque / RATIO, 3),
                on_cycle("friction", -cam.friction_torque, 2),
                on_cycle("engine and mechanism", cam.residual, 1),
            )),
        ),
        (
            beside(targets, "C25-11", float(about.std()), basis="imposed"),
            beside(targets, "C25-13", float(cam.residual.std())),
        ),
    )  # fmt: skip


def _preloads(targets: Mapping[str, Target], torque: Array, cams: Cams, name: str) -> PaperFigure:
    chosen = {preload: cams[name, preload] for preload in PRELOADS}
    words = [f"{preload:g} N" for preload in PRELOADS]
    before = chosen[DESIGN].study.inertia_alone.speed
    stats = {preload: cam.study.after.statistics for preload, cam in chosen.items()}
    order = " < ".join(f"{p:g}" for p in sorted(PRELOADS, key=lambda p: stats[p].std))
    rows = {121.0: ("C25-22", "C25-23"), 242.0: ("C25-18", "C25-19"), 363.0: ("C25-24", "C25-25")}
    values = [
        value
        for preload, (std, amplitude) in rows.items()
        for value in (
            beside(targets, std, stats[preload].std),
            beside(targets, amplitude, stats[preload].peak_to_peak),
        )
    ]

    def panel(axis: str, without: Array | None, curves: list[Array]) -> PaperPanel:
        lines = [] if without is None else [on_cycle("without the cam", without, MUTED, "dashed")]
        lines += [on_cycle(w, c, k) for k, (w, c) in enumerate(zip(words, curves, strict=True))]
        return PaperPanel(CRANK, axis, tuple(lines))

    remark = (
        "The order of the preloads is the printed one, the ripple is far below it."
        if name == "full"
        else "The ripple is near the measured one at the design preload, the order is not."
    )
    return PaperFigure(
        f"c25-preloads-{name}", "C25", "24, 25 and 29",
        f"Torque, speed and friction torque at three preloads, cam {CUT_FOR[name]}",
        "Above: crank torque about its mean at constant speed. Middle: crank speed, that without "
        "the cam with the inertia of the mechanism. Below: torque lost by friction in the guides. "
        f"{remark}",
        (
            panel(TORQUE, torque - torque.mean(), [cam.residual for cam in chosen.values()]),
            panel(SPEED, before, [cam.study.after.speed for cam in chosen.values()]),
            panel("friction torque, N m", None, [c.friction_torque for c in chosen.values()]),
        ),
        (*values, beside(targets, "C25-26", order)),
    )  # fmt: skip


def _with_and_without(targets: Mapping[str, Target], torque: Array, cams: Cams) -> PaperFigure:
    pair = {name: cams[name, DESIGN] for name in MULTIPLIERS}
    before = cams["full", DESIGN].study.inertia_alone
    labels = ("without the cam", *(f"cam {CUT_FOR[name]}" for name in pair))
    torques = (torque - torque.mean(), *(cam.residual for cam in pair.values()))
    speeds = (before.speed, *(cam.study.after.speed for cam in pair.values()))
    looks: tuple[Look, ...] = ("dashed", "line", "line")
    values = []
    for name, cam in pair.items():
        ripple, note = cam.study.after.statistics, TITLES[name].lower()
        for rows, value in (
            (("C25-14", "C25-16"), float(cam.residual.std())),
            (("C25-15", "C25-17"), float(np.ptp(cam.residual))),
            (("C25-18", "C25-20"), ripple.std),
            (("C25-19", "C25-21"), ripple.peak_to_peak),
        ):
            values += [
                Beside(
                    f"{targets[row].quantity}, {targets[row].kind}; {note}",
                    targets[row].value,
                    value,
                    targets[row].unit,
                    targets[row].basis,
                    row,
                )
                for row in rows
            ]
    return PaperFigure(
        "c25-with-and-without", "C25", "26 to 29", "Torque and speed with and without the cam",
        "Preload of 242 N. The paper prints its measured and its simulated ripple and not the "
        "torque that the cam was cut for; its equations leave out the factor of 2 of the gear "
        "ratio, and cut the cam for half of the engine torque. Neither cam gives the printed "
        "torque and speed ripple together.",
        (
            PaperPanel(CRANK, TORQUE, tuple(
                on_cycle(label, values_, k - 1, look)
                for k, (label, values_, look) in enumerate(zip(labels, torques, looks, strict=True))
            )),
            PaperPanel(CRANK, SPEED, tuple(
                on_cycle(label, values_, k - 1, look)
                for k, (label, values_, look) in enumerate(zip(labels, speeds, looks, strict=True))
            )),
        ),
        tuple(values),
    )  # fmt: skip
