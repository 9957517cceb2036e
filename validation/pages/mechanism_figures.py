"""Figures of the mechanism comparison: friction energy, torque and inertia, workspaces."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path

import numpy as np

from camwright.geometry.figures import SERIES, Curve, Figure, HorizontalAxis, Look, Panel
from camwright.pipeline.base.files import write_atomic
from camwright.reports.figure_svg import COLOURS, png, png_of, shipped, style
from camwright.reports.report_tables import Record

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
    label = "friction energy above the best cam, %"
    drawn = {
        "energies": png_of(_energies(document)),
        "turn": png_of(_turn(document)),
        "workspace_slider_crank": _maps(
            space, label, ("slider_crank", "no offset"), ("slider_crank_offset", "offset")
        ),
        "workspace_eccentric_cam": _maps(
            space,
            label,
            ("small_roller", "small roller, no offset"),
            ("big_roller_offset", "big roller, offset"),
            ("small_roller_offset", "small roller, offset"),
        ),
    }
    return tuple(write_atomic(out / f"{name}.png", picture) for name, picture in drawn.items())


def _energies(document: Record) -> Figure:
    rows = []
    for one in document["mechanisms"]:
        rows.append((one["name"], one["losses_J"]))
        rows += [(f"slipping, mu {mu}", losses) for mu, losses in one.get("slipping", {}).items()]
    names, places = tuple(name for name, _ in rows), np.arange(float(len(rows)))
    curves, start = [], np.zeros(len(rows))
    for pair, (label, colour) in _PAIRS.items():
        end = start + np.array([losses[pair] for _, losses in rows])
        curves.append(Curve(end, places, label, colour, "bar", lower=start, notes=names))
        start = end
    axis = HorizontalAxis("friction energy of a turn", "J", (0.0, 1.12 * float(start.max())))
    panel = Panel("", "", tuple(curves), kind="bars")
    return Figure("energies", "Friction energy of a turn", "", (panel,), axis)


def _turn(document: Record) -> Figure:
    looks: tuple[Look, ...] = ("line", "dashed", "dotted")
    angle = np.array(document["phi_deg"])
    panels = [
        Panel(quantity, unit, tuple(
            Curve(angle, np.array(one[key]), one["name"], colour, look)
            for one, colour, look in zip(
                document["mechanisms"], cycle(SERIES), cycle(looks), strict=False
            )
        ), height=1.2)
        for key, quantity, unit in (
            ("motor_torque_Nm", "motor torque", "N m"),
            ("reduced_inertia_kg_m2", "reduced inertia", "kg m²"),
        )
    ]  # fmt: skip
    axis = HorizontalAxis("crank angle", "deg", (0.0, 360.0), 60.0)
    return Figure("turn", "Motor torque and reduced inertia", "", tuple(panels), axis)


def _maps(space: Record, label: str, *wanted: tuple[str, str]) -> bytes:
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
        return png(canvas)
