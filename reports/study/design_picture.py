"""Picture of a design on one page: torque, front, cam and roller, parts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.design_document import DesignDocument
from camwright.reports.figure_svg import COLOURS, png, shipped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST = 3.0  # of the sizes of the front: candidates further away are left out


def write(path: Path, document: DesignDocument) -> Path:
    """Write the picture of a design as PNG: torque, front, cam with roller, parts.

    Parameters
    ----------
    document : dict   contents of ``design.json``
    """
    return write_atomic(path, drawn(document))


@shipped()
def drawn(document: DesignDocument) -> bytes:
    """PNG of a design: torque before and with the cam, front of ripple and size, cam, values."""
    from matplotlib.figure import Figure

    canvas = Figure(figsize=(11.0, 7.8), layout="constrained")
    axes = canvas.subplots(2, 2)
    _torque(axes[0, 0], document)
    _front(axes[0, 1], document)
    _cam(axes[1, 0], document)
    _words(axes[1, 1], document)
    return png(canvas)


def _torque(axes: Axes, document: DesignDocument) -> None:
    demand, chosen = document["torque"], document["chosen"]
    before = np.array(demand["values_Nm"])
    angle = np.arange(before.size) * (demand["cycle_deg"] / before.size)
    axes.plot(angle, before, color=COLOURS["muted"], lw=1.4, label="torque of the machine")
    if chosen is not None:
        after = np.array(chosen["torque_after_Nm"])
        turn = np.arange(after.size) * (360.0 * demand["ratio"] / after.size)
        shown = turn <= demand["cycle_deg"]
        axes.plot(turn[shown], after[shown], color=COLOURS["blue"], lw=1.6, label="with the cam")
    axes.set_xlabel("shaft angle, deg")
    axes.set_ylabel("torque about its mean, N m")
    _finish(axes, "Torque over one cycle")


def _front(axes: Axes, document: DesignDocument) -> None:
    points, chosen = document["points"], document["chosen"]
    cloud = document["cloud"]
    if points:
        far = _MOST * points[-1]["size_mm"]
        cloud = [each for each in cloud if each[0] <= far]
    for within, words, colour in (
        (False, "screened, beyond a limit", "grid"),
        (True, "screened, within limits", "muted"),
    ):
        own = [each for each in cloud if each[2] is within]
        if own:
            axes.plot([each[0] for each in own], [each[1] for each in own], ".",
                      color=COLOURS[colour], ms=4, label=words)  # fmt: skip
    if points:
        sizes = [row["size_mm"] for row in points]
        axes.plot(sizes, [row["ripple_left_Nm"] for row in points], "o-",
                  color=COLOURS["blue"], lw=1.4, ms=5, label="front, synthesised")  # fmt: skip
    if chosen is not None:
        axes.plot([chosen["size_mm"]], [chosen["ripple_left_Nm"]], "s", mfc="none", ms=11, mew=1.8,
                  color=COLOURS["vermillion"], label="chosen")  # fmt: skip
    allowed = (1.0 - document["remove"]) * document["torque"]["ripple_Nm"]
    axes.axhline(allowed, color=COLOURS["vermillion"], lw=1.0, ls="--", label="allowed")
    if document["space_mm"] is not None:
        axes.axvline(document["space_mm"], color=COLOURS["vermillion"], lw=1.0, ls=":",
                     label="space")  # fmt: skip
    axes.set_ylim(0.0, 2.0 * allowed)
    axes.set_xlabel("size, mm: far side of the cam to the top of the roller")
    axes.set_ylabel("torque ripple left (std), N m")
    _finish(axes, "Ripple against size")


def _cam(axes: Axes, document: DesignDocument) -> None:
    chosen = document["chosen"]
    if chosen is None:
        axes.axis("off")
        return
    axes.set_title("Cam, shaft and roller at the base circle, mm", fontsize=10, loc="left")
    axes.set_axisbelow(True)
    x, y = np.array(chosen["contour_mm"])
    turn = np.linspace(0.0, 2.0 * np.pi, 121)
    axes.fill(x, y, facecolor=COLOURS["grid"], edgecolor=COLOURS["blue"], lw=1.6)
    bore, radius = 0.5 * chosen["bore_mm"], chosen["roller_radius_mm"]
    axes.fill(bore * np.cos(turn), bore * np.sin(turn), facecolor="white",
              edgecolor=COLOURS["muted"], lw=1.2)  # fmt: skip
    centre = np.array(chosen["roller_centre_mm"])
    axes.plot(centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn),
              color=COLOURS["vermillion"], lw=1.6)  # fmt: skip
    axes.plot(*centre, "+", color=COLOURS["vermillion"])
    axes.set_aspect("equal")
    axes.grid(color=COLOURS["grid"], lw=0.4)
    axes.tick_params(labelsize=8)


def _words(axes: Axes, document: DesignDocument) -> None:
    axes.axis("off")
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
    lines += ["", "assumed: " + (", ".join(document["assumed"]) or "nothing")]
    axes.text(0.0, 1.0, "\n".join(lines), va="top", family="monospace", fontsize=9)


def _finish(axes: Axes, title: str) -> None:
    axes.set_title(title, fontsize=10, loc="left")
    axes.grid(color=COLOURS["grid"], lw=0.6)
    axes.legend(fontsize=8, frameon=False)
