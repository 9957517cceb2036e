"""The cam analysis sheet: which figures a run shows, and those of torque, shape and contact."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.figures import (
    SERIES,
    AngleFigure,
    Curve,
    Figure,
    LimitLine,
    OutlineFigure,
    Panel,
)
from camwright.reports.part_figures import PART_FIGURES
from camwright.reports.report_tables import quantity, words
from camwright.reports.sheet_turn import Columns, Turn, angle_figure, curves_of

GROUPS = (
    ("Torque", ("torque", "torque-components", "crank-speed")),
    ("Shape", ("outline", "pressure-angle", "face", "lift", "radii")),
    ("Limits", ("limits",)),
    ("Contact", ("pressure", "half-width", "stress")),
    ("Forces and guides", ("normal-force", "forces", "guides", "jamming", "speed")),
    ("Parts", ("bushes", "elastic", "roller", "film", "parts")),
)
LARGEST_RADIUS_MM = 150.0
HARD_STOP_DEG = 45.0
"""Beyond it no translating follower is designed; Rothbart (2004), ch. 6."""
BINDS = 0.997  # share in use from which a limit binds: the synthesis keeps a little in hand
_SHOWN, _MOST = 0.5, 6  # share from which a limit is shown, and how many of them


def groups(turn: Turn) -> tuple[tuple[str, tuple[Figure, ...]], ...]:
    """The figures that a run has columns for, by group, in reading order."""
    makers: tuple[Callable[[Turn], Figure | None], ...] = (
        _torque, _components, _crank_speed, _lift, _outline, _pressure_angle, _face, _radii,
        _limits_strip, _pressure, _half_width, _stress, *PART_FIGURES,
    )  # fmt: skip
    made = (maker(turn) for maker in makers)
    by_id = {figure.id: figure for figure in made if figure is not None}
    grouped = ((title, tuple(by_id[n] for n in names if n in by_id)) for title, names in GROUPS)
    return tuple((title, figures) for title, figures in grouped if figures)


def _torque(turn: Turn) -> Figure | None:
    curves = curves_of(
        turn, ("torque_before_Nm", "engine alone"), ("torque_after_Nm", "with the cam"),
    )  # fmt: skip
    if not curves:
        return None
    cam = turn.columns.get("cam_torque_Nm")
    if cam is not None:
        curves += (Curve("taken by the cam", cam / turn.gear_ratio, "muted", dashed=True),)
    return angle_figure(
        turn, "torque", "Crank torque before and after",
        "Crank torque about its mean, without and with the balancing cam as delivered (guide "
        "friction and follower inertia included).",
        Panel("torque", "N m", curves, height=1.25), mark=False,
    )  # fmt: skip


def _crank_speed(turn: Turn) -> Figure | None:
    speed = turn.speed
    if speed is None or "crank_angle_deg" not in speed:
        return None
    wanted = (
        ("speed_before_rad_per_s", "engine alone", "blue", False),
        ("speed_inertia_alone_rad_per_s", "with the added inertia alone", "muted", True),
        ("speed_after_rad_per_s", "with the cam", "vermillion", False),
    )
    curves = tuple(
        Curve(label, speed[name], colour, dashed)
        for name, label, colour, dashed in wanted if name in speed
    )  # fmt: skip
    return angle_figure(
        turn, "crank-speed", "Crank speed before and after",
        "Speed of the crank over the cycle of the first load case: engine alone, with the "
        "mechanism's turning parts but its follower held off, and with the cam at work.",
        Panel("crank speed", "rad/s", curves, height=1.25), mark=False,
        crank=speed["crank_angle_deg"],
    )  # fmt: skip


def _components(turn: Turn) -> Figure | None:
    if turn.torque is None or "crank_angle_deg" not in turn.torque:
        return None
    parts = [c for c in turn.torque if c not in ("crank_angle_deg", "total_Nm")][: len(SERIES)]
    curves = [
        Curve(words(name.removesuffix("_Nm"))[:24], turn.torque[name], colour)
        for name, colour in zip(parts, SERIES, strict=False)
    ]
    if "total_Nm" in turn.torque:
        curves.append(Curve("total", turn.torque["total_Nm"], "ink", dashed=bool(parts)))
    return angle_figure(
        turn, "torque-components", "What the engine torque is made of",
        "Positive drives the crank. Crank angle 0 is the top dead centre where intake begins; "
        "360 deg is the firing top dead centre.",
        Panel("torque", "N m", tuple(curves), height=1.25), mark=False,
        crank=turn.torque["crank_angle_deg"],
    )  # fmt: skip


def _lift(turn: Turn) -> Figure | None:
    columns = turn.lift
    if "lift_mm" not in columns:
        return None
    rows = (
        ("lift_mm", "s", "mm"), ("lift_d1_mm_per_rad", "s′", "mm/rad"),
        ("lift_d2_mm_per_rad2", "s″", "mm/rad²"), ("lift_d3_mm_per_rad3", "s‴", "mm/rad³"),
    )  # fmt: skip
    panels = [
        Panel(label, unit, (Curve("", columns[name], "blue"),), height=0.62)
        for name, label, unit in rows
        if name in columns
    ]
    return angle_figure(
        turn, "lift", "Lift and its derivatives",
        "Lift s of the follower above its lowest place, with derivatives by cam angle.",
        *panels, mark=False, crank=columns["crank_angle_deg"],
    )  # fmt: skip


def _outline(turn: Turn) -> Figure | None:
    c = turn.contour
    if "contour_x_mm" not in c:
        return None
    theta = turn.columns["cam_angle_deg"][turn.worst]
    distance = np.abs((c["cam_angle_deg"] - theta + 180.0) % 360.0 - 180.0)
    width, depth = (turn.length("cam", "keyway", key) for key in ("width", "depth"))
    angle = turn.length("cam", "keyway", "angle", unit="rad") or 0.0
    worst, name = int(np.argmin(distance)), turn.follower_name
    pitch = np.array([c["pitch_x_mm"], c["pitch_y_mm"]]) if turn.rolls else None
    return OutlineFigure(
        "outline", "Contour and pitch curve" if turn.rolls else "Contour",
        f"The cam seen along its shaft, with the {name} where the contact pressure is greatest."
        f"{_balance_in_words(turn)}",
        np.array([c["contour_x_mm"], c["contour_y_mm"]]), pitch,
        _roller_outline(turn, worst) if turn.rolls else _face_outline(turn, worst), name,
        turn.length("cam", "bore_radius"),
        (width, depth, angle) if width is not None and depth is not None else None,
        worst, f"at {theta:.4g} deg", turn.counter_hole,
    )  # fmt: skip


def _balance_in_words(turn: Turn) -> str:
    """What the cam is out of balance by, and what its counter-hole leaves; "" of older runs."""
    found = turn.balance
    if not isinstance(found.get("unbalance_g_mm"), (int, float)):
        return ""
    said = (
        f" Its unbalance is {quantity(float(found['unbalance_g_mm']), 'g mm')}"
        f" at {found['unbalance_angle_deg']:.4g} deg"
    )
    hole = turn.counter_hole
    if hole is None:
        return f"{said}; {found.get('hole_note') or 'it needs no hole'}."
    x, y, radius, drilled = hole
    left = max(float(found["unbalance_left_g_mm"]), 0.0)
    left = 0.0 if left < 1e-6 * float(found["unbalance_g_mm"]) else left
    return (
        f"{said}; a hole of {2 * radius:.4g} mm at ({x:.4g}, {y:.4g}) mm,"
        f" {'drilled' if drilled else 'proposed (dashed)'}, leaves {quantity(left, 'g mm', 3)}."
    )


def _roller_outline(turn: Turn, at: int) -> Array | None:
    """The roller's circle (2, n), mm, at a row of the contour; None where its radius is unknown."""
    radius, c = turn.length("roller", "radius"), turn.contour
    if radius is None:
        return None
    angle = np.linspace(0.0, 2 * np.pi, 121)
    centre = np.array([c["pitch_x_mm"][at], c["pitch_y_mm"][at]])
    return np.asarray(centre[:, None] + radius * np.array([np.cos(angle), np.sin(angle)]))


def _face_outline(turn: Turn, at: int) -> Array | None:
    """The block of the face (2, 5), mm, at a row of the contour; None where its size is unknown."""
    c, place = turn.contour, turn.columns["place_on_face_mm"][turn.worst]
    width, thick = (turn.length("follower", "face", key) for key in ("width", "thickness"))
    if width is None or thick is None:
        return None
    touch = np.array([c["contour_x_mm"][at], c["contour_y_mm"][at]])
    normal = np.array([c["normal_x"][at], c["normal_y"][at]])
    along = np.array([-normal[1], normal[0]])
    middle = touch - place * along
    corners = [(-0.5, 0.0), (0.5, 0.0), (0.5, 1.0), (-0.5, 1.0), (-0.5, 0.0)]
    return np.array([middle + x * width * along + y * thick * normal for x, y in corners]).T


def _face(turn: Turn) -> Figure | None:
    """Where a face is touched, how fast the cam slides along it, and what that costs."""
    half = turn.length("follower", "face", "width")
    edges = () if half is None else (LimitLine(0.5 * half, "edge"), LimitLine(-0.5 * half, "edge"))
    pv = turn.limit("limit", "MPa m/s", "face_sliding")
    return angle_figure(
        turn, "face", "Contact on the face",
        "Place of the contact from the stem's axis; speed of the cam's surface along the face; "
        "mean contact pressure times that speed.",
        Panel("place", "mm", curves_of(turn, ("place_on_face_mm", "")), edges, height=0.9),
        Panel("sliding", "m/s", curves_of(turn, ("sliding_speed_m_per_s", "")), height=0.7),
        Panel("p v", "MPa m/s", curves_of(turn, ("face_pv_MPam_per_s", "")), pv, height=0.7),
    )  # fmt: skip


def _pressure_angle(turn: Turn) -> Figure | None:
    if not turn.rolls:  # zero at every angle
        return None
    limits = (*turn.limit("limit", "deg", "pressure_angle"), LimitLine(HARD_STOP_DEG, "hard stop"))
    both = limits + tuple(LimitLine(-line.value, line.label) for line in limits)
    return angle_figure(
        turn, "pressure-angle", "Pressure angle",
        "Between the contact normal and the follower's line of travel; positive on the rise.",
        Panel(
            "pressure angle", "deg", curves_of(turn, ("pressure_angle_deg", "")), both, height=1.3
        ),
    )  # fmt: skip


def _radii(turn: Turn) -> Figure | None:
    roller = turn.length("roller", "radius")
    limits: tuple[LimitLine, ...] = ()
    if roller is not None:
        limits = (LimitLine(roller, "roller radius"),)
    ratio = turn.bound("curvature_ratio")
    if roller and ratio:
        limits += (LimitLine(ratio * roller, "least pitch radius"),)
    curves = []
    wanted = [("pitch_radius_mm", "pitch curve"), ("contour_radius_of_curvature_mm", "contour")]
    for (column, label), colour in zip(wanted, SERIES, strict=False):
        if column in turn.columns and (turn.rolls or column != "pitch_radius_mm"):
            curves.append(Curve(label, broken(turn.columns[column], LARGEST_RADIUS_MM), colour))
    return angle_figure(
        turn, "radii", "Radii of curvature",
        f"Signed, positive where convex. The curve leaves the axes above {LARGEST_RADIUS_MM:g} mm, "
        "where the flank is nearly straight.",
        Panel("radius", "mm", tuple(curves), limits, height=1.25, span=_radius_span(curves)),
    )  # fmt: skip


def broken(values: Array, largest: float) -> Array:
    """`values` with NaN where their size exceeds `largest`, so that a pole draws no line."""
    return np.where(np.abs(values) > largest, np.nan, values)


def _radius_span(curves: Sequence[Curve]) -> tuple[float, float]:
    lows = [float(np.nanmin(c.values)) for c in curves if np.isfinite(c.values).any()]
    return min([0.0, *lows]) * 1.05, LARGEST_RADIUS_MM * 1.12


def _pressure(turn: Turn) -> Figure | None:
    limits = turn.limit("endurance", "MPa", "contact_pressure")
    limits += turn.limit("shakedown", "MPa", "shakedown")
    curves = curves_of(
        turn, ("p0_fe_MPa", "finite elements"), ("p0_hertz_MPa", "Hertz"), dashed=(1,)
    )  # fmt: skip
    return angle_figure(
        turn, "pressure", "Greatest contact pressure",
        "p0 by finite elements and by Hertz's closed form, and their difference.",
        Panel("p0", "MPa", curves, limits, height=1.2),
        Panel("difference", "%", curves_of(turn, ("p0_difference_percent", "")), height=0.55),
    )  # fmt: skip


def _half_width(turn: Turn) -> Figure | None:
    curves = curves_of(
        turn, ("half_width_fe_mm", "finite elements"), ("half_width_hertz_mm", "Hertz"), dashed=(1,)
    )  # fmt: skip
    return angle_figure(
        turn, "half-width", "Half-width of the contact",
        "Half the width of the strip over which roller and cam touch.",
        Panel("half-width a", "mm", curves),
    )  # fmt: skip


def _stress(turn: Turn) -> Figure | None:
    stress = curves_of(turn, ("von_mises_MPa", "von Mises"), ("tau_max_MPa", "greatest shear"))
    depth = curves_of(
        turn, ("von_mises_depth_mm", "depth of von Mises"), ("tau_depth_mm", "depth of shear")
    )  # fmt: skip
    return angle_figure(
        turn, "stress", "Stress below the surface, and its depth",
        "Greatest von Mises stress and greatest in-plane shear stress under the contact.",
        Panel("stress", "MPa", stress, turn.limit("yield, von Mises", "MPa", "first_yield")),
        Panel("depth", "mm", depth, height=0.62),
    )  # fmt: skip


def _limits_strip(turn: Turn) -> Figure | None:
    return limits_strip(turn.limits, turn.gear_ratio, strokes=turn.strokes)


def limits_strip(limits: Columns | None, gear_ratio: float, *, strokes: bool) -> Figure | None:
    """A strip for each limit that is used by half or more; None where nothing was recorded.

    Parameters
    ----------
    limits : mapping or None   columns of 2_limits.csv, the most used first
    strokes : bool             whether the strokes of an engine are named
    """
    if limits is None or "cam_angle_deg" not in limits:
        return None
    uses = {name: use for name, use in limits.items() if name != "cam_angle_deg"}
    shown = [name for name, use in uses.items() if use.size and float(np.max(use)) >= _SHOWN]
    panels = tuple(_strip(name, uses[name]) for name in shown[:_MOST])
    if not panels:
        return None
    return AngleFigure(
        "limits", "Which limit binds where",
        "Share in use of each limit as the synthesis sees it, the most used first; thick where "
        "it binds and ripple is given up for it. A limit on a mean of the turn is level.",
        gear_ratio * limits["cam_angle_deg"], panels, gear_ratio, strokes,
    )  # fmt: skip


def _strip(name: str, use: Array) -> Panel:
    """Share in use from nothing to all, and again where it binds."""
    tight = np.where(use >= BINDS, use, np.nan)
    curves = (Curve("share in use", np.clip(use, 0.0, None), "blue"),
              Curve("binds", tight, "vermillion"))  # fmt: skip
    return Panel(words(name), "", curves, (LimitLine(1.0, ""),), height=0.62, span=(0.0, 1.3))
