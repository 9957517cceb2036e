"""Figures of Petrescu and Petrescu (2015): outlines, shape index and dynamics of valve cams."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.cycle.valve_cam import (
    ElasticValve,
    ValveCam,
    follower_acceleration,
    shaft_speed,
)
from validation.figures_2025_cam import X, Y
from validation.paper_figure import (
    MUTED,
    PUBLISHED,
    PaperCurve,
    PaperFigure,
    PaperPanel,
    beside,
    closed,
    closed_angle,
    outline,
)
from validation.petrescu_2015 import (
    CLASSICAL,
    CRANK_RPM,
    ROLLER,
    SETS,
    STIFFNESS,
    TAPPET,
    CamSet,
)
from validation.published_figures import Target

CAM, ACCELERATION = "cam angle, deg", "acceleration, m/s²"
COUNT, OUTLINE_POINTS, RISE_POINTS = 720, 1440, 200
RPM = {"B1": 5500.0, "B2": 5500.0, "B3": 5000.0, "B4": 5000.0}
"""Crank speed of the dynamic diagrams, printed."""
NOSE_REACH, NOSE_VIEW = np.radians(10.0), 0.4  # rad, mm; about the nose
CRITICAL_ANGLE = 30.0  # deg, of a translating follower in a guide
TRAIN = STIFFNESS[1]  # N/m, of the valve train; assumed, the paper prints none


def figures(targets: Mapping[str, Target]) -> tuple[PaperFigure, ...]:
    """Figures 2 to 4, 6 to 9, 12, 13, 16 and 17 of the paper."""
    return (_outlines(), _index(targets), _dynamics(), _classical(), _classical_cam())


def _described(cam_set: CamSet) -> str:
    return f"stroke {1e3 * cam_set.stroke:g} mm in {cam_set.rise:g} deg"


def _outlines() -> PaperFigure:
    theta, panels = uniform_turn(OUTLINE_POINTS), []
    for name, cam_set in SETS.items():
        pitch = PitchCurve(cam_set.motion.lift(OUTLINE_POINTS), cam_set.base_radius + ROLLER)
        contour = RollerContour(pitch, ROLLER)
        least = 1e3 * contour.least_convex_pitch_radius().value
        cut = contour.undercut().present
        word = "undercut" if cut else "not undercut"
        circle = cam_set.base_radius * np.stack([np.cos(theta), np.sin(theta)])
        panels.append(
            PaperPanel(
                X, Y,
                (
                    PaperCurve("cam", *outline(contour.points(theta)), 1 if cut else 0,
                          "line" if cut else "fill"),
                    PaperCurve("path of the roller centre", *outline(pitch.points(theta)), MUTED,
                          "dashed"),
                    PaperCurve("base circle", *outline(circle), MUTED, "dotted"),
                ),
                title=f"{name}: {_described(cam_set)}",
                note=f"pitch radius from {least:.2f} mm: {word}",
                kind="outline",
            )
        )  # fmt: skip
    panels += [_nose(name) for name in ("B3", "B4")]
    return PaperFigure(
        "p15-cams", "P15", "6, 8, 12 and 16", "Four cams with a roller of 2 mm, cosine law",
        "The minimum convex radius of the path of the roller centre must exceed the radius of the "
        "roller. Sets B3 and B4 are undercut: at the nose, enlarged below, the curve of the paper "
        "crosses itself, and no cam can have it.",
        tuple(panels),
        columns=2,
    )  # fmt: skip


def _nose(name: str) -> PaperPanel:
    """The contour about the end of the rise, enlarged."""
    cam_set = SETS[name]
    pitch = PitchCurve(cam_set.motion.lift(OUTLINE_POINTS), cam_set.base_radius + ROLLER)
    contour, top = RollerContour(pitch, ROLLER), np.radians(cam_set.rise)
    x, y = 1e3 * contour.points(top + np.linspace(-NOSE_REACH, NOSE_REACH, RISE_POINTS))
    centre = 1e3 * contour.points(np.array([top]))[:, 0]
    window = [float(c) + side for c in centre for side in (-NOSE_VIEW, NOSE_VIEW)]
    return PaperPanel(
        X,
        Y,
        (PaperCurve("cam", x, y, 1),),
        title=f"{name}: nose",
        kind="outline",
        window=tuple(window),
    )


def _index(targets: Mapping[str, Target]) -> PaperFigure:
    share = (np.arange(RISE_POINTS) + 0.5) / RISE_POINTS
    index, angle, printed, values = [], [], [], []
    for k, (name, cam_set) in enumerate(SETS.items()):
        cam, row = cam_set.cam, f"P15-{k + 1:02d}"
        phi = share * np.radians(cam_set.rise)
        index.append(PaperCurve(name, share, cam.shape_index(phi), k))
        angle.append(PaperCurve(name, share, np.degrees(cam.pressure_angle(phi)), k))
        printed.append(targets[row].value)
        values.append(beside(targets, row, float(cam.shape_index(cam.rise()).mean())))
    classical = ValveCam(CLASSICAL.motion, CLASSICAL.base_radius, module="C")
    phi = classical.rise()
    flat = float(np.mean(classical.motion(phi, 1) ** 2 / classical.contour_radius_square(phi)))
    axis = "share of the rise, -"
    highest = max(float(np.max(curve.y)) for curve in index)
    steepest = sorted(float(np.max(curve.y)) for curve in angle)
    means = PaperCurve("printed means", np.full(len(printed), 0.5), printed, PUBLISHED, "points")
    limit = PaperCurve(
        f"{CRITICAL_ANGLE:g} deg, guided follower",
        [0.0, 1.0],
        [CRITICAL_ANGLE] * 2,
        MUTED,
        "dashed",
    )
    return PaperFigure(
        "p15-index", "P15", "6 to 17 (yields in the text)",
        "Shape index of equation 6.18, printed as yield, and pressure angle",
        "Above: cos²(α − δ) cos² δ, printed as momentary mechanical yield. It "
        f"never passes {highest:.3f} for any of the cams: no mean of it has the printed values. It "
        "is no efficiency: force and velocity are both projected, and a cam without friction "
        f"transmits all power. The cams reach {steepest[0]:.0f} to {steepest[-1]:.0f} deg of "
        "pressure angle.",
        (
            PaperPanel(axis, "shape index, -", (*index, means)),
            PaperPanel(axis, "pressure angle, deg", (*angle, limit)),
        ),
        (*values, beside(targets, "P15-05", flat)),
    )  # fmt: skip


def _accelerations(cam: ValveCam, speed: float) -> tuple[Array, Array]:
    """Follower acceleration at constant and at uneven cam speed (COUNT + 1,), m/s^2."""
    phi = uniform_turn(COUNT)
    slope, lift_d2 = cam.motion(phi, 1), cam.motion(phi, 2)
    uneven = follower_acceleration(
        slope, lift_d2, cam.speed(phi, speed), cam.angular_acceleration(phi, speed)
    )
    # 360 deg is the end of the dwell, not the beginning of the rise, where the law jumps
    constant, real = (np.append(values, values[-1]) for values in (lift_d2 * speed**2, uneven))
    return constant, real


def _dynamics() -> PaperFigure:
    panels, angle = [], closed_angle(COUNT, 360.0)
    stiff = SETS["B3"]
    rest = stiff.rate * stiff.compression / (STIFFNESS[-1] + stiff.rate)
    for name, cam_set in SETS.items():
        constant, uneven = _accelerations(cam_set.cam, shaft_speed(RPM[name]))
        preload = 1e-3 * cam_set.rate * cam_set.compression
        shown = angle <= 2.5 * cam_set.rise
        panels.append(
            PaperPanel(
                CAM, ACCELERATION,
                (
                    PaperCurve("constant speed", angle[shown], constant[shown], 0, "dashed"),
                    PaperCurve("uneven speed", angle[shown], uneven[shown], 1),
                ),
                title=f"{name}: {_described(cam_set)}",
                note=f"{RPM[name]:g} rpm, preload {preload:g} kN",
            )
        )  # fmt: skip
    return PaperFigure(
        "p15-dynamics", "P15", "7, 9, 13 and 17", "Dynamic diagrams of the four cams",
        "Acceleration of the follower over rise and return, at constant cam speed and at the "
        "uneven speed of a free cam by its reduced inertia (cam 0.2 kg, follower 0.1 kg, printed; "
        "equations reconstructed). Rigid follower: the stiffness of the train is not printed. Of "
        f"{1e-6 * STIFFNESS[-1]:g} N/µm, the preload of B3 alone would compress it by "
        f"{1e3 * rest:.1f} mm, more than the stroke of the cam.",
        tuple(panels),
        columns=2,
    )  # fmt: skip


def _classical() -> PaperFigure:
    cam = ValveCam(CLASSICAL.motion, CLASSICAL.base_radius, module="C")
    speed, angle = shaft_speed(CRANK_RPM), closed_angle(COUNT, 360.0)
    constant, uneven = _accelerations(cam, speed)
    elastic = _elastic(cam, speed)
    turning = PaperCurve("", angle, closed(cam.speed(uniform_turn(COUNT), speed)), 1)
    mean = PaperCurve("", angle, np.full(angle.size, speed), MUTED, "dashed")
    return PaperFigure(
        "p15-classical", "P15", "2 and 4",
        "Classical cam with a flat follower: acceleration and speed",
        f"Stroke 6 mm in 90 deg, {CRANK_RPM:g} rpm of the crank. Elastic: displacement by the work "
        f"over the lift (equation 14, reconstructed) with {1e-6 * TRAIN:g} N/µm of the valve "
        "train, assumed. Below: cam speed by the reduced inertia, and its mean.",
        (
            PaperPanel(CAM, ACCELERATION, (
                PaperCurve("constant speed", angle, constant, 0, "dashed"),
                PaperCurve("uneven speed", angle, uneven, 1),
                PaperCurve("uneven speed, elastic train", *elastic, 2),
            )),
            PaperPanel(CAM, "cam speed, rad/s", (turning, mean)),
        ),
    )  # fmt: skip


def _elastic(cam: ValveCam, speed: float) -> tuple[Array, Array]:
    """Angle, deg, and acceleration of an elastic follower over rise and return, m/s^2.

    By central differences; at the ends of the segments, where the law of motion has corners, NaN.
    """
    train = ElasticValve(TAPPET, TRAIN, CLASSICAL.rate, CLASSICAL.compression)
    step = np.radians(0.25)
    rise = np.radians(CLASSICAL.rise)
    phi = np.arange(1, round(2.0 * rise / step)) * step
    turning, rate = cam.angular_acceleration(phi, speed), cam.speed(phi, speed)
    left, here, right = (
        train.dynamic_lift(cam.motion(at), cam.motion(at, 1), rate)
        for at in (phi - step, phi, phi + step)
    )
    slope, lift_d2 = (right - left) / (2.0 * step), (right - 2.0 * here + left) / step**2
    value = follower_acceleration(slope, lift_d2, rate, turning)
    corner = np.min(np.abs(phi - np.array([[0.0], [rise], [2.0 * rise]])), axis=0) < 1.5 * step
    return np.degrees(phi), np.where(corner, np.nan, value)


def _classical_cam() -> PaperFigure:
    theta = uniform_turn(OUTLINE_POINTS)
    path = FacePath(CLASSICAL.motion.lift(OUTLINE_POINTS), CLASSICAL.base_radius)
    contour = FlatFaceContour(path)
    factor = contour.undercut().factor
    circle = CLASSICAL.base_radius * np.stack([np.cos(theta), np.sin(theta)])
    return PaperFigure(
        "p15-classical-cam", "P15", "3", "Classical cam with a flat follower: outline",
        "Envelope of the flat face, base radius 13 mm. Its radius of curvature r + s + s'' is at "
        f"least {100 * factor:.0f} % of r + s: no undercut.",
        (
            PaperPanel(X, Y, (
                PaperCurve("cam", *outline(contour.points(theta)), 0, "fill"),
                PaperCurve("base circle", *outline(circle), MUTED, "dotted"),
            ), kind="outline"),
        ),
    )  # fmt: skip
