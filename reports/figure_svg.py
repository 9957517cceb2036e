"""Figures as SVG that follows the page's light or dark theme, and as PNG files.

Every colour has a name. In the SVG it becomes a style variable of the page, so one drawing reads
on white paper and on a dark screen; in the PNG it is the colour of the light theme. The hues are
those of Okabe and Ito (2008), told apart by the colour-blind, the pale ones darkened to stand off
white paper; dashes repeat what hue says.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import MaxNLocator

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import write_atomic
from camwright.reports.analysis_sheet import groups
from camwright.reports.figures import (
    STROKES,
    AngleFigure,
    Figure,
    OutlineFigure,
    Panel,
    placed_limits,
    vertical_span,
)
from camwright.reports.report_data import FIGURES, Material

_CSS = (Path(__file__).parent / "templates" / "report.css").read_text(encoding="utf-8")
COLOURS = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", _CSS[: _CSS.index("}")]))
"""Colours of the page's light theme by name."""
STYLE: dict[str, Any] = {
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 8.5,
    "text.parse_math": False,
    "axes.edgecolor": COLOURS["muted"],
    "axes.labelcolor": COLOURS["ink"],
    "axes.linewidth": 0.6,
    "axes.facecolor": "none",
    "axes.unicode_minus": True,
    "figure.facecolor": "none",
    "text.color": COLOURS["ink"],
    "xtick.color": COLOURS["muted"],
    "ytick.color": COLOURS["muted"],
    "xtick.labelsize": 7.8,
    "ytick.labelsize": 7.8,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "grid.color": COLOURS["grid"],
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.4,
    "lines.solid_joinstyle": "round",
    "legend.fontsize": 8.0,
    "path.simplify_threshold": 0.2,
}
BACKING = {"facecolor": COLOURS["card"], "alpha": 0.75, "linewidth": 0, "pad": 0.6}
FIGURE_WIDTH = 5.6
LEFT, RIGHT, TOP, BOTTOM, GAP = 0.68, 0.16, 0.66, 0.42, 0.14
LEGEND_ROW = 5


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure of the sheet with its drawings."""

    figure: Figure
    svg: str
    png: bytes

    @property
    def themed(self) -> Markup:
        """The SVG in the colours of the page's theme."""
        return Markup(themed(self.svg, self.figure.id))  # noqa: S704 - its texts are escaped


@lru_cache(maxsize=1)
def drawn_groups(material: Material) -> Sequence[tuple[str, Sequence[Drawn]]]:
    """The figures that a run has columns for, by group, in reading order."""
    return tuple((t, tuple(map(_drawn, figures))) for t, figures in groups(material.turn))


def write(material: Material) -> list[Path]:
    """Write ``figures/ID.png`` for every figure of the sheet."""
    return [
        write_atomic(material.folder / FIGURES / f"{one.figure.id}.png", one.png)
        for _, drawn in drawn_groups(material)
        for one in drawn
    ]


def _drawn(figure: Figure) -> Drawn:
    return Drawn(figure, *svg_and_png(figure))


@contextmanager
def style(salt: str) -> Iterator[None]:
    """The house style; `salt` keeps the ids of several drawings on one page apart."""
    settings: Any = STYLE | {"svg.hashsalt": salt}
    with rc_context(settings):
        yield


def draw(figure: Figure) -> Canvas:
    """The matplotlib figure of a sheet figure, closed curves and all."""
    return _angles(figure) if isinstance(figure, AngleFigure) else _outline(figure)


def svg_and_png(figure: Figure) -> tuple[str, bytes]:
    """The figure as SVG text and as a PNG file, both in the colours of the light theme."""
    with style(figure.id):
        canvas = draw(figure)
        svg, png = io.StringIO(), io.BytesIO()
        canvas.savefig(svg, format="svg", metadata={"Date": None})
        canvas.savefig(
            png, format="png", dpi=150, facecolor=COLOURS["card"], metadata={"Software": None}
        )
    return svg.getvalue(), png.getvalue()


def themed(svg: str, figure_id: str) -> str:
    """Matplotlib's SVG made fit for a page: no header, no ids that clash, colours by name."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r'id="(image|legend)[^"]*"', "", svg)
    svg = re.sub(r"<[^>]+>", lambda tag: re.sub(r"(\d\.\d\d)\d+", r"\1", tag.group()), svg)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)
    svg = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", svg, count=1)
    svg = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", svg, count=1)
    svg = svg.replace("<svg", f'<svg role="img" aria-labelledby="{figure_id}-alt"', 1)
    svg = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", svg)
    for name, code in COLOURS.items():
        svg = svg.replace(code, f"var(--{name})")
    return re.sub(r"\n\s*", "\n", svg)


def _angles(figure: AngleFigure) -> Canvas:
    """Panels sharing the crank axis, with the cam axis on top."""
    rows = -(-max(panel.legend_entries for panel in figure.panels) // LEGEND_ROW)
    one_legend = figure.one_legend
    heights = [panel.height * 1.62 for panel in figure.panels]
    gaps = [GAP if one_legend or p.legend_entries < 2 else GAP + 0.2 for p in figure.panels]
    top = TOP - 0.2 + 0.2 * (rows if figure.panels[0].legend_entries > 1 else 0)
    total = top + sum(heights) + sum(gaps[1:]) + BOTTOM
    canvas = Canvas(figsize=(FIGURE_WIDTH, total))
    edge = total - top
    axes: list[Axes] = []
    for number, (panel, height) in enumerate(zip(figure.panels, heights, strict=True)):
        edge -= height + (gaps[number] if number else 0.0)
        box = (LEFT / FIGURE_WIDTH, edge / total,
               1 - (LEFT + RIGHT) / FIGURE_WIDTH, height / total)  # fmt: skip
        ax = canvas.add_axes(box)
        axes.append(ax)
        _panel(ax, figure, panel)
        ax.tick_params(labelbottom=number == len(heights) - 1)
        if panel.legend_entries > 1 and (number == 0 or not one_legend):
            above = (0.42 if number == 0 else 0.02) / height
            _legend(ax, panel, 1 + above)
    if figure.strokes:
        _stroke_names(axes[0])
    axes[-1].set_xlabel("crank angle, deg", labelpad=2)
    _cam_axis(axes[0], figure.gear_ratio)
    return canvas


def _legend(ax: Axes, panel: Panel, height: float) -> None:
    ax.legend(
        loc="lower left", bbox_to_anchor=(-0.012, height), ncols=min(len(panel.curves), LEGEND_ROW),
        frameon=False, borderaxespad=0.0, borderpad=0.0, handlelength=1.7, handletextpad=0.5,
        columnspacing=1.3, labelspacing=0.25,
    )  # fmt: skip


def _panel(ax: Axes, figure: AngleFigure, panel: Panel) -> None:
    """Curves, limits, grid and the mark of the worst angle on one pair of axes."""
    turn = 360.0 * figure.gear_ratio
    crank = np.append(figure.crank, turn + figure.crank[0])
    if figure.strokes:
        for start in (180.0, 540.0):
            ax.axvspan(start, start + 180.0, color=COLOURS["shade"], linewidth=0, zorder=0)
    for curve in panel.curves:
        colour = COLOURS[curve.colour]
        if curve.band is not None:
            below, above = (np.append(edge, edge[0]) for edge in curve.band)
            ax.fill_between(crank, below, above, color=colour, alpha=0.16, linewidth=0, zorder=1)
        ax.plot(
            crank, np.append(curve.values, curve.values[0]), color=colour, label=curve.label,
            linestyle=(0, (4, 3.4)) if curve.dashed else "solid",
            zorder=3.2 if curve.dashed else 3, linewidth=1.1 if curve.dashed else 1.5,
        )  # fmt: skip
    low, high = vertical_span(panel, figure.strokes)
    ax.set_ylim(low, high)
    if low < 0 < high:
        ax.axhline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
    if figure.worst is not None:
        ax.axvline(
            figure.worst % turn,
            color=COLOURS["ink"],
            linewidth=0.7,
            linestyle=(0, (1, 2)),
            zorder=2,
        )
    _limits(ax, panel, low, high)
    ax.set_xlim(0.0, turn)
    ax.set_xticks(np.arange(0.0, turn + 1.0, 90.0))
    ax.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10]))
    ax.grid(True, axis="y", zorder=0)
    ax.set_axisbelow(True)
    ax.set_ylabel(f"{panel.quantity}, {panel.unit}" if panel.unit else panel.quantity)
    ax.yaxis.set_label_coords(-0.52 / (FIGURE_WIDTH - LEFT - RIGHT), 0.5)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)


def _limits(ax: Axes, panel: Panel, low: float, high: float) -> None:
    """Limit lines; one that lies off the axes is told in words at the edge it lies beyond."""
    placed = placed_limits(panel, low, high)
    for line, above in placed.inside:
        ax.axhline(
            line.value, color=COLOURS["fail"], linewidth=0.9, linestyle=(0, (6, 2)), zorder=2.5
        )
        ax.annotate(
            line.words(panel.unit), (1.0, line.value), xycoords=("axes fraction", "data"),
            xytext=(-2, 2 if above else -2), textcoords="offset points", ha="right",
            va="bottom" if above else "top", color=COLOURS["fail"], fontsize=7.2,
            bbox=BACKING, zorder=4,
        )  # fmt: skip
    if placed.beyond:
        above = placed.above
        ax.annotate(
            placed.beyond, (1.0, 1.0 if above else 0.0),
            xycoords="axes fraction", xytext=(-2, -13 if above else 3), zorder=4,
            textcoords="offset points", ha="right", va="top" if above else "bottom",
            color=COLOURS["fail"], fontsize=7.2,
            bbox=BACKING,
        )  # fmt: skip


def _stroke_names(ax: Axes) -> None:
    for number, name in enumerate(STROKES):
        ax.annotate(
            name, (90.0 + 180.0 * number, 1.0), xycoords=("data", "axes fraction"),
            xytext=(0, -3), textcoords="offset points", ha="center", va="top", fontsize=7.0,
            color=COLOURS["muted"],
        )  # fmt: skip


def _cam_axis(ax: Axes, gear_ratio: float) -> None:
    to_cam: Any = lambda crank: crank / gear_ratio  # noqa: E731 - matplotlib wants a pair
    to_crank: Any = lambda cam: cam * gear_ratio  # noqa: E731
    cam = ax.secondary_xaxis("top", functions=(to_cam, to_crank))
    cam.set_xticks(np.arange(0.0, 361.0, 45.0))
    cam.spines["top"].set_color(COLOURS["muted"])
    cam.set_xlabel("cam angle, deg", labelpad=3)
    cam.xaxis.label.set_color(COLOURS["ink"])


def _outline(figure: OutlineFigure) -> Canvas:
    """Contour, pitch curve, bore, keyway and the follower at the worst angle, equal axes."""
    drawn = [c for c in (figure.contour, figure.pitch, figure.follower) if c is not None]
    reach = 1.06 * max(float(np.abs(c).max()) for c in drawn)
    canvas = Canvas(figsize=(FIGURE_WIDTH, FIGURE_WIDTH - 0.1))
    ax = canvas.add_axes((LEFT / FIGURE_WIDTH, 0.42 / 5.5, 4.84 / FIGURE_WIDTH, 4.84 / 5.5))
    closed = np.append(figure.contour, figure.contour[:, :1], axis=1)
    ax.fill(*closed, color=COLOURS["steel"], linewidth=0, zorder=1)
    ax.plot(*closed, color=COLOURS["blue"], label="cam contour", zorder=3)
    if figure.pitch is not None:
        ax.plot(*np.append(figure.pitch, figure.pitch[:, :1], axis=1), color=COLOURS["muted"],
                linewidth=0.9, linestyle=(0, (6, 2, 1, 2)), label="pitch curve (roller centre)",
                zorder=2)  # fmt: skip
        ax.plot(*figure.pitch[:, figure.worst], marker="+", markersize=6,
                color=COLOURS["vermillion"], zorder=6)  # fmt: skip
    _bore(ax, figure)
    _counter_hole(ax, figure)
    _follower(ax, figure)
    radius = np.hypot(*figure.contour)
    for index, word in zip(figure.radii, ("min", "max"), strict=True):
        _radius(
            ax,
            figure.contour[:, index],
            figure.bore_radius or 0.0,
            f"{word} {radius[index]:.4g} mm",
        )
    ax.plot([-2, 2], [0, 0], color=COLOURS["ink"], linewidth=0.7, zorder=5)
    ax.plot([0, 0], [-2, 2], color=COLOURS["ink"], linewidth=0.7, zorder=5)
    ax.set_aspect("equal")
    ax.set_xlim(-reach, reach)
    ax.set_ylim(-reach, reach)
    ax.set_xlabel("x, mm (cam angle 0 points along x)", labelpad=2)
    ax.set_ylabel("y, mm", labelpad=3)
    ax.grid(True)
    ax.set_axisbelow(True)
    ax.legend(
        loc="lower left", bbox_to_anchor=(-0.012, 1.01), ncols=3, frameon=False,
        borderaxespad=0.0, handlelength=2.0, columnspacing=1.3, handletextpad=0.5,
    )  # fmt: skip
    return canvas


def _circle(centre: Array, radius: float) -> Array:
    angle = np.linspace(0.0, 2 * np.pi, 121)
    return centre[:, None] + radius * np.array([np.cos(angle), np.sin(angle)])


def _bore(ax: Axes, figure: OutlineFigure) -> None:
    if figure.bore_radius is None:
        return
    circle = _circle(np.zeros(2), figure.bore_radius)
    ax.fill(*circle, color=COLOURS["card"], linewidth=0, zorder=1.5)
    if figure.keyway is not None:
        width, depth, angle = figure.keyway
        inner = np.sqrt(max(figure.bore_radius**2 - width**2 / 4, 0.0))
        outer = figure.bore_radius + depth
        corners = np.array([[inner, outer, outer, inner], np.array([-1, -1, 1, 1]) * width / 2])
        turned = (
            np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ corners
        )
        ax.fill(*turned, color=COLOURS["card"], linewidth=0, zorder=1.6)
        ax.plot(*turned, color=COLOURS["blue"], linewidth=1.0, zorder=3)
    ax.plot(*circle, color=COLOURS["blue"], linewidth=1.0, zorder=3)


def _counter_hole(ax: Axes, figure: OutlineFigure) -> None:
    """Drilled as the bore is; dashed where it is only proposed."""
    if figure.counter_hole is None:
        return
    x, y, radius, drilled = figure.counter_hole
    circle = _circle(np.array([x, y]), radius)
    if drilled:
        ax.fill(*circle, color=COLOURS["card"], linewidth=0, zorder=1.5)
    ax.plot(
        *circle, color=COLOURS["blue"], linewidth=1.0, linestyle="-" if drilled else "--", zorder=3
    )


def _follower(ax: Axes, figure: OutlineFigure) -> None:
    touch = figure.contour[:, figure.worst]
    if figure.follower is not None:
        ax.plot(*figure.follower, color=COLOURS["vermillion"], linewidth=1.2, zorder=4,
                label=f"{figure.follower_name} {figure.worst_label}")  # fmt: skip
    ax.plot(*touch, marker="o", markersize=3.4, color=COLOURS["vermillion"], zorder=6)


def _radius(ax: Axes, end: Array, inner: float, words: str) -> None:
    ax.plot([0, end[0]], [0, end[1]], color=COLOURS["ink"], linewidth=0.7, zorder=2.5)
    ax.plot(*end, marker="o", markersize=2.6, color=COLOURS["ink"], zorder=6)
    angle = np.degrees(np.arctan2(end[1], end[0]))
    flip = 180.0 if abs(angle) > 90.0 else 0.0
    ax.annotate(
        words, end * (0.5 + 0.5 * inner / np.hypot(*end)), rotation=angle + flip,
        rotation_mode="anchor", ha="center", va="bottom",
        xytext=(0, 1), textcoords="offset points", fontsize=7.2, zorder=6,
    )  # fmt: skip
