"""Picture of a design on one page: torque, front, cam and roller, parts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import wrap

import numpy as np

from camwright.geometry.figures import (
    AxisMark,
    Curve,
    Figure,
    HorizontalAxis,
    LimitLine,
    Panel,
    outline,
    outline_panel,
    over,
)
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.design_document import ChosenDesign, DesignDocument
from camwright.reports.figure_svg import draw, png, style
from camwright.reports.outline_figures import circle

_RIPPLE_MOST = 3.0  # of the sizes of the front: candidates further away are left out
_LETTERS = 60  # of a line of words
_PICTURE_WIDTH, _PANEL_HEIGHT = 11.0, 2.1  # in; of a panel over the others of a report


def write(path: Path, document: DesignDocument) -> Path:
    """Write the picture of a design as PNG: torque, front, cam with roller, parts.

    Parameters
    ----------
    document : dict   contents of ``design.json``
    """
    with style("design"):
        canvas = draw(figure_of(document), _PICTURE_WIDTH)
        axes = canvas.axes[-1]
        axes.clear()
        axes.set_axis_off()
        axes.text(0.0, 1.0, _words(document), va="top", family="monospace", fontsize=9)
        return write_atomic(path, png(canvas))


def figure_of(document: DesignDocument) -> Figure:
    """Torque before and with the cam, ripple over size, cam with roller; an empty panel for words.

    Without a design that passes there is no cam.
    """
    chosen = document["chosen"]
    panels = [_torque(document), _front(document)]
    if chosen is not None:
        panels.append(_cam(chosen))
    panel = Panel("", "", (), height=_PANEL_HEIGHT)
    return Figure("design", "Design", "", (*panels, panel), columns=2)


def _torque(document: DesignDocument) -> Panel:
    """Panel of the torque about its mean, N m, over one cycle of the machine, without and with the
    cam.
    """
    demand, chosen = document["torque"], document["chosen"]
    cycle, before = demand["cycle_deg"], np.array(demand["values_Nm"])
    angle = np.arange(before.size, dtype=float) * (cycle / before.size)
    curves = [Curve(angle, before, "torque of the machine", "muted")]
    if chosen is not None:
        after = np.array(chosen["torque_after_Nm"])
        turn = np.arange(after.size, dtype=float) * (360.0 * demand["ratio"] / after.size)
        shown = turn <= cycle
        curves.append(Curve(turn[shown], after[shown], "with the cam"))
    axis = HorizontalAxis("shaft angle", "deg", (0.0, cycle), cycle / 8.0)
    return Panel(
        "torque about its mean", "N m", tuple(curves), height=_PANEL_HEIGHT,
        title="Torque over one cycle", axis=axis,
    )  # fmt: skip


def _front(document: DesignDocument) -> Panel:
    """Panel of the ripple left, N m, over the size, mm: screened designs within and beyond limits,
    synthesised front, chosen design.
    """
    points, chosen, cloud = document["points"], document["chosen"], document["cloud"]
    if points:
        far = _RIPPLE_MOST * points[-1]["size_mm"]
        cloud = [each for each in cloud if each["size_mm"] <= far]
    curves = []
    for within, words, colour in (
        (False, "screened, beyond a limit", "line"),
        (True, "screened, within limits", "muted"),
    ):
        own = [each for each in cloud if each["within_limits"] is within]
        if own:
            x, y = (np.array([each[key] for each in own]) for key in ("size_mm", "ripple_left_Nm"))
            curves.append(Curve(x, y, words, colour, "points"))
    if points:
        x, y = (np.array([row[key] for row in points]) for key in ("size_mm", "ripple_left_Nm"))
        curves.append(Curve(x, y, "front, synthesised", look="marked"))
    if chosen is not None:
        x, y = np.array([chosen["size_mm"]]), np.array([chosen["ripple_left_Nm"]])
        curves.append(Curve(x, y, "chosen", "vermillion", "spot"))
    allowed = (1.0 - document["remove"]) * document["torque"]["ripple_Nm"]
    space = document["space_mm"]
    panel = Panel(
        "torque ripple left (std)", "N m", tuple(curves), (LimitLine(allowed, "allowed"),),
        height=_PANEL_HEIGHT, span=(0.0, 2.0 * allowed), title="Ripple against size",
    )  # fmt: skip
    marks = () if space is None else (AxisMark(space, "space"),)
    words = "size, far side of the cam to the top of the roller"
    over_size = over("front", "", "", words, "mm", [panel], dots=False, marks=marks)
    return replace(panel, axis=over_size.axis)


def _cam(chosen: ChosenDesign) -> Panel:
    x, y = chosen["roller_centre_mm"]
    contour = np.array(chosen["contour_mm"])
    return outline_panel((
        outline(contour, "cam", look="fill"),
        outline(circle((0.0, 0.0), 0.5 * chosen["bore_mm"]), "shaft", "muted"),
        outline(circle((x, y), chosen["roller_radius_mm"]), "roller", "vermillion"),
        Curve(np.array([x]), np.array([y]), colour="vermillion", look="points"),
    ), "Cam, shaft and roller at the base circle")  # fmt: skip


def _words(document: DesignDocument) -> str:
    """Lines of text on demand, screening and the chosen design with its sizes, beside
    the panels.
    """
    chosen, demand = document["chosen"], document["torque"]
    turns = "turn" if demand["ratio"] == 1.0 else "turns"
    lines = [
        f"ripple            {demand['ripple_Nm']:.4g} N m (std)",
        f"energy swing      {demand['energy_swing_J']:.4g} J",
        f"speed             {demand['speed_rpm']:.5g} rpm, over-speed "
        f"{demand['overspeed_rpm']:.5g} rpm",
        f"drive             {demand['ratio']:g} shaft {turns} a cam turn",
        f"designs screened  {document['screened']}, {document['within_limits']} within limits",
        "",
    ]
    if chosen is not None:
        whole = " x ".join(f"{length:.4g}" for length in chosen["envelope_mm"])
        lines += [
            f"ripple left       {chosen['ripple_left_Nm']:.4g} N m, "
            f"{100 * chosen['removed']:.0f} % removed",
            f"size              {chosen['size_mm']:.4g} mm",
            f"whole mechanism   {whole} mm",
            f"prime radius      {chosen['prime_radius_mm']:.4g} mm, offset "
            f"{chosen['offset_mm']:.3g} mm",
            f"lift              {chosen['lift_max_mm']:.4g} mm",
            f"pressure angle    {chosen['pressure_angle_max_deg']:.3g} deg",
            f"roller            {chosen['roller']}",
            f"spring            {chosen['spring']}",
            f"rate, preload     {chosen['spring_rate_N_per_mm']:.4g} N/mm, "
            f"{chosen['preload_N']:.4g} N",
            f"normal force      {chosen['normal_force_max_N']:.4g} N",
            f"stem, bore        {chosen['stem_mm']:g} mm, {chosen['bore_mm']:g} mm",
        ]
    elif (conflict := document["conflict"]) is not None:
        lines.append("the search keeps no design within:")
        lines += [f"  {each}" for each in conflict["limits"]]
        lines += [f"passes with {each['option']} {each['to']}" for each in conflict["relaxations"]]
    assumed = "assumed: " + (", ".join(document["assumed"]) or "nothing")
    return "\n".join([*lines, "", *wrap(assumed, _LETTERS)])
