"""Figures of the mechanism comparison: friction energy, torque and inertia, workspaces."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.figures import SERIES
from camwright.pipeline.base.files import write_atomic
from camwright.reports.figure_svg import COLOURS, png, shipped, style
from camwright.reports.report_tables import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

_PAIRS = {
    "shaft": ("shaft", "blue"),
    "guide": ("guide", "green"),
    "pin_a": ("pin A", "orange"),
    "pin_b": ("pin B", "vermillion"),
    "sliding": ("sliding", "purple"),
}


@shipped()
def draw(document: Record, out: Path) -> tuple[Path, ...]:
    """Write the PNG figures of a mechanism comparison: friction energy, torque, workspace."""
    space = document["workspace"]
    drawn = {
        "energies": _energies(document),
        "turn": _turn(document),
        "workspace_slider_crank": _maps(
            space,
            "friction energy above the best cam, %",
            ("slider_crank", "no offset"),
            ("slider_crank_offset", "offset"),
        ),
        "workspace_eccentric_cam": _maps(
            space,
            "friction energy above the best cam, %",
            ("small_roller", "small roller, no offset"),
            ("big_roller_offset", "big roller, offset"),
            ("small_roller_offset", "small roller, offset"),
        ),
    }
    paths = []
    for name, canvas in drawn.items():
        with style(name):
            paths.append(write_atomic(out / f"{name}.png", png(canvas)))
    return tuple(paths)


def _energies(document: Record) -> Canvas:
    from matplotlib.figure import Figure as Canvas

    rows = []
    for one in document["mechanisms"]:
        rows.append((one["name"], one["losses_J"]))
        rows += [(f"slipping, mu {mu}", losses) for mu, losses in one.get("slipping", {}).items()]
    with style("energies"):
        canvas = Canvas(figsize=(6.4, 0.9 + 0.36 * len(rows)), layout="constrained")
        axes = canvas.add_subplot()
        at = np.arange(len(rows))[::-1]
        left = np.zeros(len(rows))
        for pair, (name, colour) in _PAIRS.items():
            width = np.array([losses[pair] for _, losses in rows])
            axes.barh(at, width, left=left, height=0.6, color=COLOURS[colour], label=name)
            left = left + width
        for place, total in zip(at, left, strict=True):
            axes.text(total, place, f" {total:.1f}", va="center")
        axes.set_yticks(at, [name for name, _ in rows])
        axes.set_xlabel("friction energy of a turn, J")
        axes.set_xlim(0, 1.12 * left.max())
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, ncols=5, loc="lower left", bbox_to_anchor=(0, 1))
    return canvas


def _turn(document: Record) -> Canvas:
    from matplotlib.figure import Figure as Canvas

    with style("turn"):
        canvas = Canvas(figsize=(6.4, 4.6), layout="constrained")
        upper, lower = canvas.subplots(2, 1, sharex=True)
        strokes = ("-", "--", ":", "-.")
        for k, one in enumerate(document["mechanisms"]):
            look = {"linestyle": strokes[k % 4], "color": COLOURS[SERIES[k % len(SERIES)]]}
            upper.plot(document["phi_deg"], one["motor_torque_Nm"], label=one["name"], **look)
            lower.plot(document["phi_deg"], one["reduced_inertia_kg_m2"], **look)
        upper.set_ylabel("motor torque, N m")
        lower.set_ylabel("reduced inertia, kg m²")
        lower.set_xlabel("crank angle, deg")
        lower.set_xticks(range(0, 361, 60))
        upper.legend(frameon=False, ncols=3, loc="lower left", bbox_to_anchor=(0, 1))
        for axes in (upper, lower):
            axes.spines[["top", "right"]].set_visible(False)
            axes.grid(visible=True)
    return canvas


def _maps(space: Record, label: str, *wanted: tuple[str, str]) -> Canvas:
    """Friction energy above the best cam over the workspace; white where the sizes do not fit."""
    from matplotlib.figure import Figure as Canvas

    crank, ratio = np.array(space["crank_mm"]), np.array(space["rod_over_crank"])
    tables = [np.array(space[f"{name}_above_best_percent"], dtype=float) for name, _ in wanted]
    with style(label):
        canvas = Canvas(figsize=(6.4, 0.8 + 2.2 * len(wanted)), layout="constrained")
        panels = canvas.subplots(len(wanted), 1, sharex=True, squeeze=False)[:, 0]
        for axes, table, (name, title) in zip(panels, tables, wanted, strict=True):
            # own colour scale each: values differ by a factor of ten between the panels
            mesh = axes.pcolormesh(crank, ratio, table.T, shading="nearest", cmap="cividis")
            canvas.colorbar(mesh, ax=axes, label=label)
            known = table[np.isfinite(table)]
            offset = f" of {space['offset_over_crank']:g} cranks" if "offset" in name else ""
            axes.set_title(
                f"{title}{offset}: {known.min():.1f} to {known.max():.1f} % in {known.size} of "
                f"{table.size} combinations",
                fontsize="medium",
            )
            forbidden = ~np.isfinite(table).any(axis=0)
            if forbidden.any():
                axes.text(crank.mean(), ratio[forbidden].mean(), "sizes do not fit",
                          ha="center", va="center", color=COLOURS["muted"])  # fmt: skip
            axes.set_ylabel("rod over crank")
        panels[-1].set_xlabel("crank or eccentricity, mm; rod: pitch radius of the cam")
    return canvas
