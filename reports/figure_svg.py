"""Figures drawn by matplotlib: SVG for page and PDF, PNG files on request.

Drawings use the colours of the light theme. For the page each colour becomes a style variable, so
that one SVG serves the light and the dark theme. The hues are those of Okabe and Ito (2008), safe
for colour-blind readers, darkened for contrast on white; dashes distinguish curves as well.
"""

from __future__ import annotations

import hashlib
import io
import pickle
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.reports.analysis_sheet import groups
from camwright.reports.figures import (
    CAM_AXIS,
    CAM_STEP,
    X_AXIS,
    Y_AXIS,
    AngleFigure,
    ContoursFigure,
    Figure,
    LineFigure,
    OutlineFigure,
    Panel,
    closed,
    placed_limits,
    vertical_span,
)
from camwright.reports.painting.matplotlib_import import TEMPLATES, import_matplotlib
from camwright.reports.report_data import FIGURES, ReportMaterial

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas
    from matplotlib.typing import RcKeyType

_CSS = (TEMPLATES / "report.css").read_text(encoding="utf-8")
COLOURS = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", _CSS[: _CSS.index("}")]))
"""Colours of the page's light theme by name."""
STYLE: dict[RcKeyType, str | float] = {
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
LETTER, HANDLE = 0.058, 0.39  # in, of a legend: mean letter, line with its gaps
Dash: TypeAlias = str | tuple[float, tuple[float, ...]]
DASHES: dict[str, Dash] = {"solid": "-", "dashed": "--", "dashdot": (0, (6, 2, 1, 2))}
MARKERS = {"dot": "o", "cross": "+"}


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure with its drawing."""

    figure: Figure
    svg: str

    @property
    def themed(self) -> Markup:
        """The SVG with colours of the page theme."""
        return Markup(themed(self.svg, self.figure.id))  # noqa: S704 - matplotlib escapes text


@lru_cache(maxsize=1)
def drawn_groups(material: ReportMaterial) -> Sequence[tuple[str, Sequence[Drawn]]]:
    """Drawings of the sheet, by group; cached."""

    def drawn(figure: Figure) -> Drawn:
        task = material.ahead.get(content_key(figure)) if material.ahead else None
        return Drawn(figure, svg_of(figure) if task is None else task.result())

    return tuple((title, tuple(map(drawn, figures))) for title, figures in groups(material.turn))


def begun(material: ReportMaterial, workers: Crew) -> dict[str, PendingCall]:
    """Drawings of the sheet handed to worker processes, by the content of each figure."""
    figures = [figure for _, group in groups(material.turn) for figure in group]
    return {content_key(figure): workers.submit(svg_of, figure) for figure in figures}


def content_key(figure: Figure) -> str:
    """SHA-256 of a figure; a figure with other data, limits or words has another key."""
    return hashlib.sha256(pickle.dumps(figure)).hexdigest()


def write(material: ReportMaterial) -> list[Path]:
    """Write ``figures/ID.png`` of each figure."""
    return [
        write_atomic(material.folder / FIGURES / f"{each.id}.png", png_of(each))
        for _, figures in groups(material.turn)
        for each in figures
    ]


@contextmanager
def shipped(settings: Mapping[RcKeyType, str | float] = MappingProxyType({})) -> Iterator[None]:
    """The settings that matplotlib is shipped with, and further ones; none of the user's.

    A drawing depends on no matplotlibrc, of the user or of the working folder. The settings are
    afterwards as before.
    """
    import_matplotlib()
    from matplotlib import rc_context, rcParamsDefault

    own: dict[Any, Any] = dict(rcParamsDefault)
    del own["backend"]
    with rc_context({**own, **settings}):
        yield


@contextmanager
def style(salt: str) -> Iterator[None]:
    """Settings of the drawings; `salt` makes the ids in the SVG unique on a page."""
    with shipped({**STYLE, "svg.hashsalt": salt}):
        yield


def draw(figure: Figure) -> Canvas:
    """The matplotlib figure of a figure."""
    if isinstance(figure, (OutlineFigure, ContoursFigure)):
        return _outline(figure)
    return _angles(figure) if isinstance(figure, AngleFigure) else _lines(figure)


def svg_of(figure: Figure) -> str:
    """SVG text of a figure, in the colours of the light theme."""
    with style(figure.id):
        canvas, svg = draw(figure), io.StringIO()
        canvas.savefig(svg, format="svg", metadata={"Date": None})
        return svg.getvalue()


def png_of(figure: Figure) -> bytes:
    """PNG file of a figure, in the colours of the light theme."""
    with style(figure.id):
        return png(draw(figure))


def png(canvas: Canvas, dpi: int = 150) -> bytes:
    """PNG file of a canvas on white, of 256 colours; equal drawings give equal bytes."""
    from PIL import Image

    stream, small = io.BytesIO(), io.BytesIO()
    canvas.savefig(
        stream, format="png", dpi=dpi, facecolor=COLOURS["card"], metadata={"Software": None},
        pil_kwargs={"compress_level": 0},
    )  # fmt: skip
    with Image.open(stream) as picture:
        few = picture.convert("RGB").quantize(256, dither=Image.Dither.NONE)
    few.save(small, format="png", optimize=True, dpi=(dpi, dpi))
    return small.getvalue()


def themed(svg: str, figure_id: str) -> str:
    """SVG for inclusion in a page: no header, unique ids, two decimals, colours by name."""
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", svg, count=1, flags=re.DOTALL)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r'id="(image|legend)[^"]*"', "", svg)
    svg = re.sub(r"<[^>]+>", lambda tag: re.sub(r"(\d\.\d\d)\d+", r"\1", tag.group()), svg)
    svg = re.sub(r"<!--.*?-->", "", svg, flags=re.DOTALL)
    svg = re.sub(r" font-family: [^;\"]*;| transform=\"rotate\(-0 [^\"]*\"", "", svg)
    svg = re.sub(r'(?<= d=")[MLz\d.\s-]+(?=")', lambda path: _compact(path.group()), svg)
    svg = re.sub(r'(<svg[^>]*?) width="[^"]*"', r"\1", svg, count=1)
    svg = re.sub(r'(<svg[^>]*?) height="[^"]*"', r"\1", svg, count=1)
    svg = svg.replace("<svg", f'<svg role="img" aria-labelledby="{figure_id}-alt"', 1)
    svg = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", svg)
    for name, code in COLOURS.items():
        svg = svg.replace(code, f"var(--{name})")
    return re.sub(r"\n\s*", "\n", svg)


def _compact(path: str) -> str:
    """Straight lines with relative coordinates in tenths of a point; they do not drift."""
    parts, here = [], (0, 0)
    for command, x, y in re.findall(r"([MLz])(?:\s*(-?[\d.]+) (-?[\d.]+))?", path):
        if command == "z":
            parts.append("z")
            continue
        there = round(10.0 * float(x)), round(10.0 * float(y))
        if command == "M":
            parts.append(f"M{there[0] / 10:g} {there[1] / 10:g}")
        elif there != here:
            parts.append(f"l{(there[0] - here[0]) / 10:g} {(there[1] - here[1]) / 10:g}")
        here = there
    return "".join(parts)


def _angles(figure: AngleFigure) -> Canvas:
    """Panels with a common crank axis below and the cam axis above."""
    canvas, axes = _stacked(figure)
    for ax, panel in zip(axes, figure.panels, strict=True):
        _panel(ax, figure, panel)
    _legends(figure, axes)
    for mark in figure.marks:
        axes[0].annotate(
            mark.name, (0.5 * (mark.start + mark.end), 1.0),
            xycoords=("data", "axes fraction"), xytext=(0, -3),
            textcoords="offset points", ha="center", va="top", fontsize=7.0,
            color=COLOURS["muted"],
        )  # fmt: skip
    axes[-1].set_xlabel(figure.shaft_axis, labelpad=2)
    _cam_axis(axes[0], figure.gear_ratio)
    return canvas


def _lines(figure: LineFigure) -> Canvas:
    """Panels with a common axis of another quantity, points marked."""
    from matplotlib.ticker import MaxNLocator

    canvas, axes = _stacked(figure)
    for ax, panel in zip(axes, figure.panels, strict=True):
        for number, curve in enumerate(panel.curves):
            _points(ax, figure, panel, number)
            for note, x, y in zip(curve.notes, figure.x, curve.values, strict=False):
                if not np.isfinite(y):
                    continue
                ax.annotate(
                    note, (x, y), xytext=(0, 4), textcoords="offset points", ha="center",
                    va="bottom", fontsize=7.0, color=COLOURS["muted"], zorder=4,
                )  # fmt: skip
        for at, _ in figure.marks:
            ax.axvline(at, color=COLOURS["muted"], linewidth=0.8, linestyle=(0, (1, 2)), zorder=2)
        _vertical(ax, figure, panel)
        ax.set_xlim(*figure.span)
        ax.xaxis.set_major_locator(MaxNLocator(nbins=8, integer=figure.whole))
    _legends(figure, axes)
    for at, name in figure.marks:
        axes[0].annotate(
            name, (at, 1.0), xycoords=("data", "axes fraction"), xytext=(-2, -3),
            textcoords="offset points", ha="right", va="top", fontsize=7.0, rotation=90,
            color=COLOURS["muted"], bbox=BACKING, zorder=4,
        )  # fmt: skip
    axes[-1].set_xlabel(figure.axis, labelpad=2)
    return canvas


def _points(ax: Axes, figure: LineFigure, panel: Panel, number: int) -> None:
    """One curve of a panel as a line or as bars."""
    curve = panel.curves[number]
    colour = COLOURS[curve.colour]
    if figure.bars:
        width = figure.bar_width / len(panel.curves)
        shift = (number - 0.5 * (len(panel.curves) - 1)) * width
        ax.bar(figure.x + shift, curve.values, width, color=colour, label=curve.label, zorder=3)
        return
    ax.plot(
        figure.x, curve.values, "o-" if figure.dotted(curve) else "-", color=colour,
        label=curve.label, linewidth=1.5, markersize=2.6 if figure.dots else 5.0, zorder=3,
    )  # fmt: skip


def _canvas(height: float) -> Canvas:
    """Empty canvas of the width of all figures; height in inches."""
    from matplotlib.figure import Figure as Canvas

    return Canvas(figsize=(FIGURE_WIDTH, height))


def _stacked(figure: AngleFigure | LineFigure) -> tuple[Canvas, list[Axes]]:
    """Axes of the panels, one below the other."""
    rows = max(-(-panel.legend_entries // _legend_columns(panel)) for panel in figure.panels)
    heights = [panel.height * 1.62 for panel in figure.panels]
    gaps = [GAP + (0.2 if legend else 0.0) for legend in figure.legends]
    named_above = isinstance(figure, AngleFigure)
    top = (TOP - 0.2 if named_above else GAP) + 0.2 * (rows if figure.legends[0] else 0)
    total = top + sum(heights) + sum(gaps[1:]) + BOTTOM
    canvas = _canvas(total)
    edge = total - top
    axes: list[Axes] = []
    for number, height in enumerate(heights):
        edge -= height + (gaps[number] if number else 0.0)
        box = (LEFT / FIGURE_WIDTH, edge / total,
               1 - (LEFT + RIGHT) / FIGURE_WIDTH, height / total)  # fmt: skip
        ax = canvas.add_axes(box)
        axes.append(ax)
        ax.tick_params(labelbottom=number == len(heights) - 1)
    return canvas, axes


def _legends(figure: AngleFigure | LineFigure, axes: Sequence[Axes]) -> None:
    for number, (ax, panel) in enumerate(zip(axes, figure.panels, strict=True)):
        if figure.legends[number]:
            second = number == 0 and isinstance(figure, AngleFigure)  # above the cam axis
            above = (0.42 if second else 0.02) / (panel.height * 1.62)
            _legend(ax, panel, 1 + above)


def _legend_columns(panel: Panel) -> int:
    """Most columns of a legend, up to `LEGEND_ROW`, that the figure is wide enough for."""
    labels = [curve.label for curve in panel.curves if curve.label]
    for columns in range(min(len(labels), LEGEND_ROW), 1, -1):
        longest = sum(max(map(len, part)) for part in np.array_split(labels, columns))
        if longest * LETTER + columns * HANDLE <= FIGURE_WIDTH - LEFT:
            return columns
    return 1


def _legend(ax: Axes, panel: Panel, height: float) -> None:
    ax.legend(
        loc="lower left", bbox_to_anchor=(-0.012, height), ncols=_legend_columns(panel),
        frameon=False, borderaxespad=0.0, borderpad=0.0, handlelength=1.7, handletextpad=0.5,
        columnspacing=1.3, labelspacing=0.25,
    )  # fmt: skip


def _panel(ax: Axes, figure: AngleFigure, panel: Panel) -> None:
    """Curves, limits, grid and the line of the worst angle on one pair of axes."""
    crank = figure.closed_crank
    for mark in figure.marks:
        if mark.shaded:
            ax.axvspan(mark.start, mark.end, color=COLOURS["shade"], linewidth=0, zorder=0)
    for curve in panel.curves:
        colour = COLOURS[curve.colour]
        if curve.band is not None:
            below, above = map(closed, curve.band)
            ax.fill_between(crank, below, above, color=colour, alpha=0.16, linewidth=0, zorder=1)
        ax.plot(
            crank, closed(curve.values), color=colour, label=curve.label,
            linestyle=(0, (4, 3.4)) if curve.dashed else "solid",
            zorder=3.2 if curve.dashed else 3, linewidth=1.1 if curve.dashed else 1.5,
        )  # fmt: skip
    if figure.mark is not None:
        ax.axvline(
            figure.mark, color=COLOURS["ink"], linewidth=0.7, linestyle=(0, (1, 2)), zorder=2
        )
    _vertical(ax, figure, panel)
    ax.set_xlim(0.0, figure.period)
    ax.set_xticks(np.arange(0.0, figure.period + 1.0, figure.shaft_step))


def _vertical(ax: Axes, figure: AngleFigure | LineFigure, panel: Panel) -> None:
    """Vertical axis of a panel with its limits; frame and grid."""
    from matplotlib.ticker import MaxNLocator

    named = bool(figure.marks)
    low, high = vertical_span(panel, named)
    ax.set_ylim(low, high)
    if low < 0 < high:
        ax.axhline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
    _limits(ax, panel, low, high, below_names=named and panel is figure.panels[0])
    ax.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10]))
    ax.grid(True, axis="y", zorder=0)
    ax.set_axisbelow(True)
    ax.set_ylabel(panel.title)
    ax.yaxis.set_label_coords(-0.52 / (FIGURE_WIDTH - LEFT - RIGHT), 0.5)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)


def _limits(ax: Axes, panel: Panel, low: float, high: float, *, below_names: bool) -> None:
    """Limit lines; limits outside the axes are written at their edge, below names of marks."""
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
    shift = -13 if below_names else -3
    for words, above in placed.beyond:
        ax.annotate(
            words, (1.0, 1.0 if above else 0.0),
            xycoords="axes fraction", xytext=(-2, shift if above else 3), zorder=4,
            textcoords="offset points", ha="right", va="top" if above else "bottom",
            color=COLOURS["fail"], fontsize=7.2,
            bbox=BACKING,
        )  # fmt: skip


def _cam_axis(ax: Axes, gear_ratio: float) -> None:
    def to_cam(crank: ArrayLike) -> ArrayLike:
        return np.asarray(crank) / gear_ratio

    def to_crank(cam: ArrayLike) -> ArrayLike:
        return np.asarray(cam) * gear_ratio

    cam = ax.secondary_xaxis("top", functions=(to_cam, to_crank))
    cam.set_xticks(np.arange(0.0, 361.0, CAM_STEP))
    cam.spines["top"].set_color(COLOURS["muted"])
    cam.set_xlabel(CAM_AXIS, labelpad=3)
    cam.xaxis.label.set_color(COLOURS["ink"])


def _outline(figure: OutlineFigure | ContoursFigure) -> Canvas:
    """Curves and text of the outline on equal axes."""
    canvas = _canvas(FIGURE_WIDTH - 0.1)
    ax = canvas.add_axes((LEFT / FIGURE_WIDTH, 0.42 / 5.5, 4.84 / FIGURE_WIDTH, 4.84 / 5.5))
    for order, curve in enumerate(figure.curves, start=1):
        if curve.fill:
            ax.fill(*curve.points, color=COLOURS[curve.fill], linewidth=0, zorder=order)
        ax.plot(
            *curve.points, color=COLOURS[curve.colour], label=curve.label, zorder=order + 0.5,
            linewidth=curve.width, linestyle=DASHES[curve.dash],
            marker=MARKERS.get(curve.marker, ""), markersize=6 if curve.marker == "cross" else 3,
        )  # fmt: skip
    for text in figure.texts:
        ax.annotate(
            text.words, text.place, rotation=text.turn, rotation_mode="anchor", ha="center",
            va="bottom", xytext=(0, 1), textcoords="offset points", fontsize=7.2, zorder=100,
        )  # fmt: skip
    ax.set_aspect("equal")
    ax.set_xlim(-figure.reach, figure.reach)
    ax.set_ylim(-figure.reach, figure.reach)
    ax.set_xlabel(X_AXIS, labelpad=2)
    ax.set_ylabel(Y_AXIS, labelpad=3)
    ax.grid(True)
    ax.set_axisbelow(True)
    ax.legend(
        loc="lower left", bbox_to_anchor=(-0.012, 1.01), ncols=3, frameon=False,
        borderaxespad=0.0, handlelength=2.0, columnspacing=1.3, handletextpad=0.5,
    )  # fmt: skip
    return canvas
