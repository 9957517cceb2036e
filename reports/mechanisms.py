"""Figures of a comparison of mechanisms, from its document alone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas

from reports.plots import COLOURS, style

_PAIRS = {
    "shaft": ("shaft", "blue"),
    "guide": ("guide", "green"),
    "pin_a": ("pin A", "orange"),
    "pin_b": ("pin B", "vermillion"),
    "sliding": ("sliding", "purple"),
}
_DPI = 150


def draw(document: Mapping[str, Any], out: Path) -> tuple[Path, ...]:
    """Energies by pair, torque and reduced inertia over a turn, both workspaces; PNG files."""
    out.mkdir(parents=True, exist_ok=True)
    space = document["workspace"]
    drawn = {
        "energies": _energies(document),
        "turn": _turn(document),
        "workspace_slider_crank": _map(
            space, "slider_crank_above_best_percent", "slider-crank above the best cam, %"
        ),
        "workspace_small_roller": _map(
            space, "small_roller_above_best_percent", "small roller above the big one, %"
        ),
    }
    paths = []
    for name, canvas in drawn.items():
        path = out / f"{name}.png"
        with style(name):
            canvas.savefig(path, dpi=_DPI, facecolor=COLOURS["card"])
        paths.append(path)
    return tuple(paths)


def _energies(document: Mapping[str, Any]) -> Canvas:
    rows = []
    for found in document["mechanisms"]:
        rows.append((found["name"], found["losses_J"]))
        rows += [(f"slipping, mu {mu}", losses) for mu, losses in found.get("slipping", {}).items()]
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


def _turn(document: Mapping[str, Any]) -> Canvas:
    with style("turn"):
        canvas = Canvas(figsize=(6.4, 4.6), layout="constrained")
        upper, lower = canvas.subplots(2, 1, sharex=True)
        strokes = ("-", "--", ":", "-.")
        for k, found in enumerate(document["mechanisms"]):
            look = {"linestyle": strokes[k % 4], "color": list(COLOURS.values())[k % 6]}
            upper.plot(document["phi_deg"], found["motor_torque_Nm"], label=found["name"], **look)
            lower.plot(document["phi_deg"], found["reduced_inertia_kg_m2"], **look)
        upper.set_ylabel("motor torque, N m")
        lower.set_ylabel("reduced inertia, kg m²")
        lower.set_xlabel("crank angle, deg")
        lower.set_xticks(range(0, 361, 60))
        upper.legend(frameon=False, ncols=3, loc="lower left", bbox_to_anchor=(0, 1))
        for axes in (upper, lower):
            axes.spines[["top", "right"]].set_visible(False)
            axes.grid(visible=True)
    return canvas


def _map(space: Mapping[str, Any], values: str, title: str) -> Canvas:
    crank, ratio = np.array(space["crank_mm"]), np.array(space["rod_over_crank"])
    table = np.array(space[values])
    with style(values):
        canvas = Canvas(figsize=(6.4, 3.8), layout="constrained")
        axes = canvas.add_subplot()
        mesh = axes.pcolormesh(crank, ratio, table.T, shading="nearest", cmap="cividis")
        canvas.colorbar(mesh, label=title)
        axes.set_xlabel("crank or eccentricity, mm")
        axes.set_ylabel("rod or pitch radius over crank")
        axes.set_title(f"{table.size} combinations: {table.min():.1f} to {table.max():.1f} %")
    return canvas
