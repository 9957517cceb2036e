"""Figures of the cam analysis sheet: torque, shape, limits, contact."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, rotation
from camwright.geometry.figures import (
    SERIES,
    Curve,
    Figure,
    LimitLine,
    Look,
    Panel,
    over,
    over_turn,
)
from camwright.pipeline.base.tables import Table
from camwright.pipeline.results.run_reader import TrialRecord
from camwright.reports.machine_words import MachineWords
from camwright.reports.outline_figures import (
    ContoursFigure,
    OutlineFigure,
    SheetFigure,
    circle,
)
from camwright.reports.part_figures import PART_FIGURES, endurance
from camwright.reports.report_tables import isolated, number, quantity, words
from camwright.reports.sheet_turn import SheetTurn, angle_figure, both_ways, curves_of

TRIALS = "Trials"
"""Group of the figures that compare the trials."""
GROUPS = (
    ("Torque", ("torque", "torque-spectrum", "torque-components", "crank-speed", "ripple-map")),
    ("Shape", ("outline", "pressure-angle", "face", "lift", "radii")),
    ("Limits", ("limits",)),
    ("Contact", ("pressure", "half-width", "stress")),
    ("Forces and guides", ("normal-force", "forces", "guides", "pivot", "jamming", "speed")),
    ("Energy, speed and load cases", ("energy", "load-cases", "speed-sweep")),
    (
        "Parts",
        (
            "spring-force",
            "goodman-spring",
            "goodman-camshaft",
            "edge-pressure",
            "elastic",
            "roller",
            "film",
            "parts",
        ),
    ),
    (TRIALS, ("trial-points", "trial-contours", "trial-torque")),
)
LARGEST_RADIUS_MM = 150.0
HARD_STOP_DEG = 45.0
"""Upper bound of the pressure angle of translating followers; Rothbart (2004), ch. 6."""
BINDS = 0.997
"""Utilisation from which a limit is active; the synthesis keeps a small margin."""
_NO_LENGTH = 1e-9  # of the place of a hole over its radius
_ORDERS = 24  # harmonics of a cam turn
_SHOWN, _MOST = 0.5, 6  # utilisation from which a limit is shown, and the number of limits


def groups(turn: SheetTurn) -> tuple[tuple[str, tuple[SheetFigure, ...]], ...]:
    """Figures of the sheet as pairs (title of the group, figures).

    Figures without their columns in the run, and groups without any figure, are left out.
    """
    makers: tuple[Callable[[SheetTurn], SheetFigure | None], ...] = (
        _torque, _spectrum, _components, _crank_speed, _lift, _outline, _pressure_angle, _face,
        _radii, _limits_strip, _pressure, _half_width, _stress, *PART_FIGURES,
        _ripple_map, _trial_points, _trial_contours, _trial_torque,
    )  # fmt: skip
    made = (maker(turn) for maker in makers)
    by_id = {figure.id: figure for figure in made if figure is not None}
    grouped = ((title, tuple(by_id[n] for n in names if n in by_id)) for title, names in GROUPS)
    return tuple((title, figures) for title, figures in grouped if figures)


def _torque(turn: SheetTurn) -> Figure | None:
    """Figure of the shaft torque over the turn, N m: without and with the cam, and the cam torque
    referred to the shaft; None without a machine torque.
    """
    turn = turn.balanced
    curves = curves_of(
        turn, ("torque_before_Nm", turn.words.alone), ("torque_after_Nm", "with the cam"),
    )  # fmt: skip
    if not curves:
        return None
    cam = turn.columns["cam_torque_Nm"] / turn.gear_ratio
    curves += (Curve(turn.crank, cam, f"cam torque at the {turn.words.shaft}", "muted", "dashed"),)
    return angle_figure(
        turn, "torque", f"{turn.words.title} torque",
        f"Deviation of the {turn.words.shaft} torque from its mean, without and with the cam; "
        f"guide friction and follower inertia included. Load case {isolated(turn.load_case)}.",
        Panel("torque", "N m", curves, height=1.25), mark=False,
    )  # fmt: skip


def _spectrum(turn: SheetTurn) -> Figure | None:
    """Figure of the amplitudes of the torque, N m, by harmonic order, periods in a turn of the
    machine's shaft, without and with the cam; None where neither torque is finite over the turn.
    """
    turn = turn.balanced
    names = (("torque_before_Nm", turn.words.alone), ("torque_after_Nm", "with the cam"))
    count = min(_ORDERS, turn.crank.size // 2 - 1)
    order = np.arange(1, count + 1) / turn.gear_ratio
    curves = []
    for (name, label), colour in zip(names, SERIES, strict=False):
        values = turn.columns.get(name)
        if values is not None and np.isfinite(values).all() and count > 0:
            amplitude = 2.0 * np.abs(np.fft.rfft(values))[1 : count + 1] / values.size
            curves.append(Curve(order, amplitude, label, colour, "bar"))
    if not curves:
        return None
    return over(
        "torque-spectrum", "Torque spectrum",
        f"Amplitude of each harmonic of the {turn.words.shaft} torque, by its order: periods in a "
        f"turn of the {turn.words.shaft}. Load case {isolated(turn.load_case)}.",
        "harmonic order", "",
        (Panel("amplitude", "N m", tuple(curves), height=1.1, from_zero=True),),
    )  # fmt: skip


def _crank_speed(turn: SheetTurn) -> Figure | None:
    """Figure of the shaft speed over the turn, rad/s: machine alone, with the added inertia, with
    the cam; None where the run has no speed.
    """
    speed = turn.speed
    if speed is None:
        return None
    wanted: tuple[tuple[str, str, str, Look], ...] = (
        ("speed_before_rad_per_s", turn.words.alone, "blue", "line"),
        ("speed_inertia_alone_rad_per_s", "added inertia, no cam force", "muted", "dashed"),
        ("speed_after_rad_per_s", "with the cam", "vermillion", "line"),
    )
    curves = tuple(
        Curve(speed["crank_angle_deg"], speed[name], label, colour, look)
        for name, label, colour, look in wanted
    )  # fmt: skip
    return angle_figure(
        turn, "crank-speed", f"{turn.words.title} speed",
        f"{turn.words.title} speed over a cam turn in the first load case: {turn.words.alone}, "
        "with the rotating parts of the mechanism but without cam force, and with the cam.",
        Panel(f"{turn.words.shaft} speed", "rad/s", curves, height=1.25), mark=False,
    )  # fmt: skip


def _components(turn: SheetTurn) -> Figure | None:
    """Figure of the parts of the machine torque and their sum, N m, with the band of a measured
    one; None without a torque.
    """
    if turn.torque is None:
        return None
    whole = ("crank_angle_deg", "total_Nm", "error_bar_Nm")
    crank, total = turn.torque["crank_angle_deg"], turn.torque["total_Nm"]
    bar = turn.torque.numbers.get("error_bar_Nm")
    parts = [name for name in turn.torque.numbers if name not in whole][: len(SERIES)]
    curves = [
        Curve(crank, turn.torque[name], words(name.removesuffix("_Nm"))[:24], colour)
        for name, colour in zip(parts, SERIES, strict=False)
    ]
    sum_curve = Curve(crank, total, "total", "ink", "dashed" if parts else "line")
    if bar is not None:
        sum_curve = replace(sum_curve, lower=total - bar, upper=total + bar)
    curves.append(sum_curve)
    return angle_figure(
        turn, "torque-components", "Components of the torque",
        f"Positive torque drives the {turn.words.shaft}. {turn.words.origin}".rstrip()
        + ("" if bar is None else " The band holds the measured torque with 95 % probability."),
        Panel("torque", "N m", tuple(curves), height=1.25), mark=False,
    )  # fmt: skip


def _lift(turn: SheetTurn) -> Figure | None:
    """Figure of the lift s, mm, and its first three derivatives by cam angle, one panel each."""
    columns = turn.lift
    travel = turn.limit("spring travel", "mm", "spring_travel")
    rows = (
        ("lift_mm", "s", "mm", travel), ("lift_d1_mm_per_rad", "s′", "mm/rad", ()),
        ("lift_d2_mm_per_rad2", "s″", "mm/rad²", ()), ("lift_d3_mm_per_rad3", "s‴", "mm/rad³", ()),
    )  # fmt: skip
    panels = [
        Panel(label, unit, (Curve(columns["crank_angle_deg"], columns[name]),), limits, height=0.62)
        for name, label, unit, limits in rows
    ]
    return angle_figure(
        turn, "lift", "Lift and its derivatives",
        "Lift s of the follower above its lowest position and its derivatives by cam angle.",
        *panels, mark=False,
    )  # fmt: skip


def _outline(turn: SheetTurn) -> SheetFigure | None:
    """Figure of the contour, with the pitch curve of a roller, and the follower at the cam angle of
    the maximum contact pressure.
    """
    c = turn.contour
    theta = turn.columns["cam_angle_deg"][turn.worst]
    distance = np.abs((c["cam_angle_deg"] - theta + 180.0) % 360.0 - 180.0)
    worst, name = int(np.argmin(distance)), turn.follower_name
    pitch = np.array([c["pitch_x_mm"], c["pitch_y_mm"]]) if turn.rolls else None
    track, second = turn.track_at(turn.worst), turn.second_disc
    centre = np.array([c[f"{track}pitch_{axis}_mm"][worst] for axis in "xy"]) if track else None
    groove, touch = _groove(turn, worst)
    if track:
        touch = np.array([c[f"{track}contour_{axis}_mm"][worst] for axis in "xy"])
        name = f"second {name}"
    return OutlineFigure(
        "outline", "Contour and pitch curve" if turn.rolls else "Contour",
        f"The cam in the direction of its shaft, with the {name} at the maximum contact pressure."
        f"{_balance(turn)}{'' if second is None else ' Dashed: the second disc.'}",
        np.array([c["contour_x_mm"], c["contour_y_mm"]]), pitch,
        _roller_outline(turn, worst, track) if turn.rolls else _face_outline(turn, worst, track),
        name, turn.length("cam", "bore_radius"), turn.keyway, worst, f"at {theta:.4g} deg",
        turn.counter_hole, groove, touch, second, centre,
    )  # fmt: skip


def _groove(turn: SheetTurn, at: int) -> tuple[tuple[Array, float] | None, Array | None]:
    """Outer wall of a groove cam and its contact point for the outline figure, mm.

    Parameters
    ----------
    at : int   row of the contour at the maximum contact pressure

    Returns
    -------
    groove, touch   outer wall (2, n) with the radius of the disc; point (2,) of that wall at row
                    `at`, None where the inner wall carries there. Both None of a cam without a
                    groove
    """
    wall, walls, radius = turn.outer_wall, turn.walls, turn.length("cam", "groove", "outer_radius")
    if wall is None or walls is None or radius is None:
        return None, None
    return (wall, radius), wall[:, at] if walls[turn.worst] < 0.0 else None


def _balance(turn: SheetTurn) -> str:
    """Sentence on the unbalance of the cam without and with the counter-hole, for a caption."""
    balance = turn.balance
    unbalance = (
        f" Its unbalance is {quantity(float(balance['unbalance_g_mm']), 'g mm')}"
        f" at {quantity(balance['unbalance_angle_deg'], 'deg')}"
    )
    hole = turn.counter_hole
    if turn.walls is not None:  # none is drilled into a cam that pulls
        return f"{unbalance}."
    if hole is None:
        return f"{unbalance}; {balance['hole_note'] or 'no counter-hole is necessary'}."
    x, y, radius, drilled = hole
    x, y = (0.0 if abs(each) < _NO_LENGTH * radius else each for each in (x, y))
    rest = max(float(balance["residual_unbalance_g_mm"]), 0.0)
    rest = 0.0 if rest < 1e-6 * float(balance["unbalance_g_mm"]) else rest
    return (
        f"{unbalance}; with a hole of {quantity(2 * radius, 'mm')} diameter at ({number(x)},"
        f" {number(y)}) mm, {'drilled' if drilled else 'proposed (dashed)'},"
        f" {quantity(rest, 'g mm', 3)}."
    )


def _roller_outline(turn: SheetTurn, at: int, track: str) -> Array | None:
    """Circle (2, n) of the roller of a track, see `SheetTurn.track_at`, about the point of its
    pitch curve at row `at` of the contour, mm; None if its radius is unknown.
    """
    radius, c = turn.length("roller", "radius"), turn.contour
    if track:
        radius = turn.length("cam", "conjugate", "roller_radius")
    if radius is None:
        return None
    x, y = (float(c[f"{track}pitch_{axis}_mm"][at]) for axis in "xy")
    return circle((x, y), radius)


def _face_outline(turn: SheetTurn, at: int, track: str) -> Array | None:
    """Closed outline (2, n) of the face of the follower, mm, touching the contour at its row `at`;
    None if the width or thickness of the face is unknown.

    The face is shifted along itself by the contact offset at the maximum contact pressure; a curved
    face is also turned by the pressure angle.
    """
    c, place = turn.contour, turn.columns["face_contact_offset_mm"][turn.worst]
    width, thick = (turn.length("follower", "face", key) for key in ("width", "thickness"))
    if width is None or thick is None:
        return None
    touch = np.array([c[f"{track}contour_{axis}_mm"][at] for axis in "xy"])
    normal = np.array([c[f"{track}normal_{axis}"][at] for axis in "xy"])
    radius, half = turn.length("follower", "face", "radius"), 0.5 * width
    front = np.linspace(-half, half, 25)
    sunk, high = 0.0 * front, 0.0
    if radius is not None:  # turned about its centre by the pressure angle
        angle = np.arcsin(place / radius)
        normal = rotation(angle) @ normal
        sunk = radius - np.sqrt(np.maximum(radius**2 - front**2, 0.0))
        high = radius - np.sqrt(radius**2 - place**2)
    along = np.array([-normal[1], normal[0]])
    middle = touch - place * along - high * normal
    across = np.array([*front, half, -half, -half])
    above = np.array([*sunk, thick, thick, sunk[0]])
    return np.asarray(middle[:, None] + across * along[:, None] + above * normal[:, None])


def _face(turn: SheetTurn) -> Figure | None:
    """Figure of the contact position, mm, sliding speed, m/s, and mean pressure times speed, MPa
    m/s, of a face follower; None without these columns.
    """
    half = turn.length("follower", "face", "width")
    edges = () if half is None else (LimitLine(0.5 * half, "edge"), LimitLine(-0.5 * half, "edge"))
    pv = turn.limit("limit", "MPa m/s", "face_pv")
    return angle_figure(
        turn, "face", "Contact on the face",
        "Position of the contact from the stem axis, sliding speed of the cam along the face, mean "
        "contact pressure times sliding speed.",
        Panel("position", "mm", curves_of(turn, ("face_contact_offset_mm", "")), edges, height=0.9),
        Panel("sliding", "m/s", curves_of(turn, ("sliding_speed_m_per_s", "")), height=0.7),
        Panel("p v", "MPa m/s", curves_of(turn, ("face_pv_MPam_per_s", "")), pv, height=0.7),
    )  # fmt: skip


def _pressure_angle(turn: SheetTurn) -> Figure | None:
    """Figure of the pressure angle over the turn with its limits on both sides, deg; None of a flat
    face, where it is zero.
    """
    if not turn.rolls and turn.length("follower", "face", "radius") is None:
        return None
    both = (*both_ways(turn.limit("limit", "deg", "pressure_angle")),
            LimitLine(HARD_STOP_DEG, "hard stop"))  # fmt: skip
    return angle_figure(
        turn, "pressure-angle", "Pressure angle",
        "Angle between the contact normal and the direction of follower motion, positive in the "
        "rise.",
        Panel(
            "pressure angle", "deg", curves_of(turn, ("pressure_angle_deg", "")), both, height=1.3
        ),
    )  # fmt: skip


def _radii(turn: SheetTurn) -> Figure | None:
    """Figure of the signed radii of curvature of contour and pitch curve, mm, cut at
    `LARGEST_RADIUS_MM`, with the least radius allowed.
    """
    radius = turn.length("roller", "radius")
    limits: tuple[LimitLine, ...] = ()
    if radius is not None:
        limits = (LimitLine(radius, "roller radius"),)
    ratio = turn.bound("curvature_ratio")
    if radius and ratio:
        limits += (LimitLine(ratio * radius, "minimum pitch radius"),)
    curves = []
    wanted = [
        ("pitch_radius_of_curvature_mm", "pitch curve"),
        ("contour_radius_of_curvature_mm", "contour"),
    ]
    for (column, label), colour in zip(wanted, SERIES, strict=False):
        if turn.rolls or column != "pitch_radius_of_curvature_mm":
            radii = broken(turn.columns[column], LARGEST_RADIUS_MM)
            curves.append(Curve(turn.crank, radii, label, colour))
    if turn.second_disc is not None:
        second = turn.contour["second_contour_radius_of_curvature_mm"]
        away = turn.contour["cam_angle_deg"][:, None] - turn.columns["cam_angle_deg"]
        radii = broken(second[np.abs(away).argmin(axis=0)], LARGEST_RADIUS_MM)
        curves.append(Curve(turn.crank, radii, "second disc", SERIES[len(wanted)]))
    return angle_figure(
        turn, "radii", "Radii of curvature",
        f"Signed radius of curvature, positive where convex. Radii above {LARGEST_RADIUS_MM:g} mm, "
        "on a nearly straight flank, are not shown.",
        Panel("radius", "mm", tuple(curves), limits, height=1.25, span=_radius_span(curves)),
    )  # fmt: skip


def broken(values: Array, largest: float) -> Array:
    """Values with NaN beyond a magnitude, so that no line crosses a pole."""
    return np.where(np.abs(values) > largest, np.nan, values)


def _radius_span(curves: Sequence[Curve]) -> tuple[float, float]:
    """Lower and upper limit of the axis of radii, mm."""
    lows = [float(np.nanmin(c.y)) for c in curves if np.isfinite(c.y).any()]
    return min([0.0, *lows]) * 1.05, LARGEST_RADIUS_MM * 1.12


def _pressure(turn: SheetTurn) -> Figure | None:
    limits = (*endurance(turn), *turn.limit("shakedown", "MPa", "shakedown"))
    curves = curves_of(
        turn, ("p0_fe_MPa", "finite elements"), ("p0_hertz_MPa", "Hertz"), dashed=(1,)
    )  # fmt: skip
    return angle_figure(
        turn, "pressure", "Peak contact pressure",
        "p0 by finite elements and of Hertz theory, and their difference.",
        Panel("p0", "MPa", curves, limits, height=1.2),
        Panel("difference", "%", curves_of(turn, ("p0_difference_percent", "")), height=0.55),
    )  # fmt: skip


def _half_width(turn: SheetTurn) -> Figure | None:
    curves = curves_of(
        turn, ("half_width_fe_mm", "finite elements"), ("half_width_hertz_mm", "Hertz"), dashed=(1,)
    )  # fmt: skip
    return angle_figure(
        turn, "half-width", "Contact half-width",
        "Half-width a of the contact by finite elements and of Hertz theory.",
        Panel("half-width a", "mm", curves),
    )  # fmt: skip


def _stress(turn: SheetTurn) -> Figure | None:
    stress = curves_of(turn, ("von_mises_MPa", "von Mises"), ("tau_max_MPa", "maximum shear"))
    depth = curves_of(
        turn, ("von_mises_depth_mm", "von Mises"), ("tau_depth_mm", "maximum shear")
    )  # fmt: skip
    return angle_figure(
        turn, "stress", "Subsurface stress",
        "Maximum von Mises stress and maximum in-plane shear stress below the contact, and their "
        "depths.",
        Panel("stress", "MPa", stress, turn.limit("yield, von Mises", "MPa", "first_yield")),
        Panel("depth", "mm", depth, height=0.62),
    )  # fmt: skip


def _ripple_map(turn: SheetTurn) -> Figure | None:
    """Figure of the ripple with the cam over that without it, by speed and engine load; None where
    the map is not recorded or was refused.
    """
    record = turn.ripple_map
    if record is None or "refused" in record:
        return None
    pressures, speed = record["intake_pressure_kPa"], np.array(record["crank_speed_rpm"])
    labels = [""] if pressures is None else [f"{value:.4g} kPa" for value in pressures]
    curves = tuple(
        Curve(speed, np.array(values), label, colour)
        for label, values, colour in zip(labels, record["ratio"], SERIES, strict=False)
    )
    loads = "" if pressures is None else " Engine load by intake pressure."
    return over(
        "ripple-map", "Torque ripple by speed and load",
        f"Standard deviation of the {turn.words.shaft} torque with the cam over that of the "
        f"{turn.words.alone}; above 1 the cam adds ripple. Quasi-static cam torque with inertia "
        f"and friction.{loads} "
        f"{record['engine']}",
        f"{turn.words.shaft} speed", "rpm",
        (Panel("ripple ratio", "", curves, (LimitLine(1.0, turn.words.alone),), height=1.1),),
    )  # fmt: skip


def _trial_points(turn: SheetTurn) -> Figure | None:
    """Figure of the torque ripple with the cam, N m, and of the greatest utilisation of the
    required checks that depend on the lift, by number of the trial; None of a single trial.
    """
    if len(turn.points) < 2:
        return None

    def column(name: str) -> Array:
        return np.array([np.nan if p[name] is None else p[name] for p in turn.points], dtype=float)

    number, notes = column("trial"), tuple(words(str(point["limit"])) for point in turn.points)
    panels = (
        Panel("ripple", "N m", (Curve(number, column("ripple_Nm")),), height=0.7),
        Panel("utilisation", "",
              (Curve(number, column("utilisation"), colour="vermillion", notes=notes),),
              (LimitLine(1.0, "limit"),), height=0.9),
    )  # fmt: skip
    return over(
        "trial-points", "Trials",
        f"Standard deviation of the {turn.words.shaft} torque with the cam, and the greatest "
        "utilisation of the required checks that depend on the lift, by trial.",
        "trial", "", panels, counted=True,
    )  # fmt: skip


def _trial_contours(turn: SheetTurn) -> SheetFigure | None:
    """Figure of the contours of the trials over each other, the final one last; None of a single
    trial.
    """
    if len(turn.trials) < 2:
        return None
    contours = tuple(
        (_of_trial(trial), np.array([trial.contour[f"contour_{axis}_mm"] for axis in "xy"]))
        for trial in turn.trials
    )
    return ContoursFigure(
        "trial-contours", "Contours of the trials",
        f"Cam contour of each trial in the direction of the shaft; solid: {contours[-1][0]}, the "
        "result.", contours, turn.length("cam", "bore_radius"),
    )  # fmt: skip


def _trial_torque(turn: SheetTurn) -> Figure | None:
    """Figure of the torque with the cam of each trial over the turn, N m; None of a single trial or
    where a trial has no finite torque.
    """
    turn = turn.balanced
    cycles = [trial.cycle.of_load_case(turn.load_case) for trial in turn.trials]
    after = [cycle.get("torque_after_Nm") for cycle in cycles]
    shown = [values for values in after if values is not None and np.isfinite(values).all()]
    if len(after) < 2 or len(shown) < len(after):
        return None
    curves = tuple(
        Curve(
            turn.crank, values, _of_trial(trial), colour,
            "line" if trial is turn.trials[-1] else "dashed",
        )
        for trial, values, colour in zip(turn.trials, shown, SERIES, strict=False)
    )  # fmt: skip
    return angle_figure(
        turn, "trial-torque", "Torque of the trials",
        f"Deviation of the {turn.words.shaft} torque from its mean with the cam of each trial; "
        f"solid: {curves[-1].label}, the result. Load case {isolated(turn.load_case)}.",
        Panel("torque", "N m", curves, height=1.25), mark=False,
    )  # fmt: skip


def _of_trial(trial: TrialRecord) -> str:
    """Name of a trial in a figure, with the width of its smoother."""
    width = trial.record["smoothing_width_deg"]
    name = f"trial {trial.number}"
    return name if width is None else f"{name}, {quantity(width, 'deg')}"


def _limits_strip(turn: SheetTurn) -> Figure | None:
    return limits_strip(turn.limits, turn.gear_ratio, turn.words)


def limits_strip(limits: Table | None, gear_ratio: float, machine: MachineWords) -> Figure | None:
    """Figure of the utilisation over the turn of the limits that reach at least one half; None
    without a record or such a limit.

    Parameters
    ----------
    limits : Table or None   2_limits.csv, by decreasing utilisation
    gear_ratio : float       turns of the machine's shaft per cam turn
    machine : MachineWords   marks of the cycle, name of the shaft
    """
    if limits is None:
        return None
    uses = {name: use for name, use in limits.numbers.items() if name != "cam_angle_deg"}
    shown = [name for name, use in uses.items() if use.size and float(np.max(use)) >= _SHOWN]
    crank = gear_ratio * limits["cam_angle_deg"]
    panels = tuple(_strip(name, crank, uses[name]) for name in shown[:_MOST])
    if not panels:
        return None
    return over_turn(
        "limits", "Active limits",
        "Utilisation of each limit in the synthesis, highest first; orange where the limit is "
        "active and increases the ripple. A limit on a mean value is constant over the turn.",
        panels, ratio=gear_ratio, shaft=machine.shaft, marks=machine.marks,
    )  # fmt: skip


def _strip(name: str, crank: Array, use: Array) -> Panel:
    """Panel of the utilisation `use` (n,) of a limit over the shaft angle `crank` (n,), deg, drawn
    in a second colour where it binds.
    """
    active = np.where(use >= BINDS, use, np.nan)
    curves = (Curve(crank, np.clip(use, 0.0, None), "utilisation"),
              Curve(crank, active, "active", "vermillion"))  # fmt: skip
    return Panel(words(name), "", curves, (LimitLine(1.0, ""),), height=0.62, span=(0.0, 1.3))
