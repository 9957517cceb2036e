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
from functools import lru_cache, partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from camwright.geometry.figures import (
    AxisMark,
    Curve,
    Figure,
    HorizontalAxis,
    Kind,
    Look,
    Panel,
    SecondAxis,
    bar_width,
)
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.reports.analysis_sheet import groups
from camwright.reports.figure_layout import placed_limits, vertical_span
from camwright.reports.outline_figures import (
    X_AXIS,
    Y_AXIS,
    ContoursFigure,
    OutlineFigure,
    SheetFigure,
)
from camwright.reports.painting.matplotlib_import import TEMPLATES, import_matplotlib
from camwright.reports.report_data import FIGURES, ReportMaterial

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.container import BarContainer, Container
    from matplotlib.figure import Figure as Canvas
    from matplotlib.typing import RcKeyType

_CSS = (TEMPLATES / "report.css").read_text(encoding="utf-8")
COLOURS = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", _CSS[: _CSS.index("}")]))
"""Colours of the page's light theme by name."""
_THEME = _CSS[_CSS.index("(prefers-color-scheme: dark)") :]
DARK = dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", _THEME[: _THEME.index("}")]))
"""The same of the dark theme."""
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
LEFT, RIGHT, TOP, BOTTOM, GAP = 0.68, 0.16, 0.46, 0.42, 0.14
"""Widths and heights about the axes, inches; TOP: with an axis above them, else GAP."""
PANEL, BAR, OUTLINE_MAX, LINE = 1.62, 0.27, 3.5, 0.2
"""Heights, inches: axes, horizontal bar, outline at most, line of a legend or title."""
LEGEND_ROW = 5
LETTER, HANDLE = 0.058, 0.39  # in, of a legend: mean letter, line with its gaps
Dash: TypeAlias = str | tuple[float, tuple[float, ...]]
DASHES: dict[str, Dash] = {"solid": "-", "dashed": "--", "dashdot": (0, (6, 2, 1, 2))}
DOTTED: Dash = (0, (1, 2))
LIMIT: Dash = (0, (6, 2))
LOOKS: dict[Look, dict[str, Any]] = {
    "line": {"linewidth": 1.5, "zorder": 3},
    "dashed": {"linewidth": 1.1, "linestyle": (0, (4, 3.4)), "zorder": 3.2},
    "dotted": {"linewidth": 1.4, "linestyle": (0, (1, 1.6)), "zorder": 3.2},
    "thin": {"linewidth": 0.5, "zorder": 2.8},
    "marked": {"linewidth": 1.5, "marker": "o", "markersize": 2.6, "zorder": 3},
    "spot": {"linewidth": 1.5, "marker": "o", "markersize": 5.0, "zorder": 3},
    "points": {"linestyle": "none", "marker": "o", "markersize": 1.5, "zorder": 3},
    "given": {"linestyle": "none", "marker": "D", "markersize": 3.6, "zorder": 4},
}
"""Settings of the lines by look."""
_GRID: dict[Kind, Literal["x", "y", "both"]] = {"lines": "y", "bars": "x", "outline": "both"}
MARKERS = {"dot": "o", "cross": "+"}


@dataclass(frozen=True, eq=False)
class Drawn:
    """A figure with its drawing."""

    figure: SheetFigure
    svg: str

    @property
    def themed(self) -> Markup:
        """The SVG with colours of the page theme."""
        return Markup(themed(self.svg, self.figure.id))  # noqa: S704 - matplotlib escapes text


@lru_cache(maxsize=1)
def drawn_groups(material: ReportMaterial) -> Sequence[tuple[str, Sequence[Drawn]]]:
    """Drawings of the sheet as pairs (title of the group, drawings), those begun ahead taken from
    their worker; cached.
    """

    def drawn(figure: SheetFigure) -> Drawn:
        task = material.ahead.get(content_key(figure)) if material.ahead else None
        return Drawn(figure, svg_of(figure) if task is None else task.result())

    return tuple((title, tuple(map(drawn, figures))) for title, figures in groups(material.turn))


def begun(material: ReportMaterial, workers: Crew) -> dict[str, PendingCall]:
    """Drawings of the sheet handed to worker processes, by the content of each figure."""
    figures = [figure for _, group in groups(material.turn) for figure in group]
    return {content_key(figure): workers.submit(svg_of, figure) for figure in figures}


def content_key(figure: SheetFigure) -> str:
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
    """Context with the settings that matplotlib is shipped with, and further ones; none of the
    user's.

    A drawing thus depends on no matplotlibrc of the user or of the working folder. On leaving, the
    settings are those before.
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


def draw(figure: SheetFigure, width: float = FIGURE_WIDTH) -> Canvas:
    """The matplotlib figure of a figure; `width` in inches."""
    if isinstance(figure, (OutlineFigure, ContoursFigure)):
        return _outline(figure)
    return _panels(figure, width)


def svg_of(figure: SheetFigure, facecolor: str = "none", width: float = FIGURE_WIDTH) -> str:
    """SVG text of a figure, in the colours of the light theme; `width` in inches."""
    with style(figure.id):
        canvas, svg = draw(figure, width), io.StringIO()
        canvas.savefig(svg, format="svg", facecolor=facecolor, metadata={"Date": None})
        return svg.getvalue()


def png_of(figure: SheetFigure, width: float = FIGURE_WIDTH) -> bytes:
    """PNG file of a figure, in the colours of the light theme; `width` in inches."""
    with style(figure.id):
        return png(draw(figure, width))


def write_figure(figure: SheetFigure, out: Path) -> Path:
    """Write a figure on white as PNG, or as SVG by the end of the name."""
    if out.suffix == ".svg":
        return write_atomic(out, svg_of(figure, COLOURS["card"]))
    return write_atomic(out, png_of(figure))


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
    """Path data of straight lines with relative coordinates rounded to tenths of a point; the
    rounded positions are subtracted, so that no error adds up.
    """
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


def _canvas(width: float, height: float) -> Canvas:
    """Empty canvas; sizes in inches."""
    from matplotlib.figure import Figure as Canvas

    return Canvas(figsize=(width, height))


def _panels(figure: Figure, width: float) -> Canvas:
    """Canvas, `width` inches wide, of the panels in rows and columns; an axis that the row below
    has as well has no labels.
    """
    columns, panels = figure.columns, figure.panels
    names = [len(name) for panel in panels for name in panel.rows]
    left = max([LEFT, *(0.15 + LETTER * count for count in names)])
    share = 1 / columns - (left + RIGHT) / width
    inner = share * width
    rows = [range(k, min(k + columns, len(panels))) for k in range(0, len(panels), columns)]
    tops = [max(_top(figure, k, inner) for k in row) for row in rows]
    heights = [max(_height(figure, panels[k], inner) for k in row) for row in rows]
    shared = [*map(partial(_same_axes, figure), rows, rows[1:]), False]
    gaps = [top + BOTTOM * (not above) for top, above in zip(tops[1:], shared, strict=False)]
    total = tops[0] + sum(heights) + sum(gaps) + BOTTOM
    canvas, edge = _canvas(width, total), total - tops[0]
    for row, gap, height, hidden in zip(rows, [0.0, *gaps], heights, shared, strict=True):
        edge -= height + gap
        for column, k in enumerate(row):
            start = column / columns + left / width
            ax = canvas.add_axes((start, edge / total, share, height / total))
            ax.tick_params(labelbottom=not hidden)
            _panel(ax, figure, k, (inner, height))
            if not hidden:
                ax.set_xlabel(figure.axis_of(panels[k]).words, labelpad=2)
    return canvas


def _same_axes(figure: Figure, row: range, below: range) -> bool:
    """Whether the panels of two rows have the same horizontal axes."""
    return len(row) == len(below) and all(
        figure.panels[k].kind == figure.panels[m].kind == "lines"
        and figure.axis_of(figure.panels[k]) == figure.axis_of(figure.panels[m])
        for k, m in zip(row, below, strict=True)
    )


def _second(figure: Figure, k: int) -> SecondAxis | None:
    """Axis above a panel of the first row."""
    return figure.axis_of(figure.panels[k]).second if k < figure.columns else None


def _top(figure: Figure, k: int, inner: float) -> float:
    """Height above a panel for axis, legend and title, inches."""
    lines = _legend_rows(figure.panels[k], inner) if figure.legends[k] else 0
    lines += bool(figure.panels[k].title) + bool(figure.panels[k].note)
    return (TOP if _second(figure, k) else GAP) + LINE * lines


def _height(figure: Figure, panel: Panel, inner: float) -> float:
    """Height of the axes of a panel, inches; `inner`: their width, inches."""
    if panel.kind == "bars":
        return BAR * len(panel.rows) + 0.1
    if panel.kind == "outline":
        (left, right), (low, high) = figure.axis_of(panel).span, vertical_span(panel, False)
        return min(inner * (high - low) / (right - left), OUTLINE_MAX)
    return PANEL * panel.height


def _panel(ax: Axes, figure: Figure, k: int, size: tuple[float, float]) -> None:
    """Draw marks, curves, axes, limits and heading of panel `k` of a figure.

    Parameters
    ----------
    size : tuple   width and height of the axes, inches
    """
    panel = figure.panels[k]
    axis, above = figure.axis_of(panel), k < figure.columns
    for mark in axis.marks:
        _mark(ax, mark)
    signs = [_curve(ax, panel, curve, axis.span[1]) for curve in panel.curves]
    for mark in axis.marks if above else ():
        _mark_name(ax, mark)
    if panel.kind == "bars":
        _rows(ax, panel, axis)
    else:
        _vertical(ax, panel, named=axis.named, below_names=axis.named and above)
    if panel.kind == "outline":
        ax.set_aspect("equal")
    ax.set_ylabel(panel.words)
    ax.yaxis.set_label_coords(-0.52 / size[0], 0.5)
    ax.grid(True, axis=_GRID[panel.kind], zorder=0)
    ax.set_axisbelow(True)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    _horizontal(ax, axis, figure.columns)
    second, height = _second(figure, k), 0.02
    if second is not None:
        _second_axis(ax, second)
        height = 0.42
    if panel.note:
        _above(ax, panel.note, height, fontsize=7.2, color=COLOURS["muted"])
        height += LINE
    if figure.legends[k]:
        drawn = [sign for sign, curve in zip(signs, panel.curves, strict=True) if curve.label]
        _legend(ax, panel, drawn, (size[0], height / size[1]))
        height += LINE * _legend_rows(panel, size[0])
    if panel.title:
        _above(ax, panel.title, height, fontweight="bold")


def _above(ax: Axes, words: str, height: float, **look: Any) -> None:
    """Words above the axes, at a height in inches."""
    ax.annotate(
        words, (0.0, 1.0), xycoords="axes fraction", xytext=(0, 72 * height + 3),
        textcoords="offset points", **look,
    )  # fmt: skip


def _mark(ax: Axes, mark: AxisMark) -> None:
    """Shade of a part of the horizontal axis, or line at a place."""
    if mark.end is None:
        colour, width = ("muted", 0.8) if mark.name else ("ink", 0.7)
        ax.axvline(mark.start, color=COLOURS[colour], linewidth=width, linestyle=DOTTED, zorder=2)
    elif mark.shaded:
        ax.axvspan(mark.start, mark.end, color=COLOURS["shade"], linewidth=0, zorder=0)


def _mark_name(ax: Axes, mark: AxisMark) -> None:
    """Name of a mark at the top of the axes: in the middle of a part, along a line."""
    middle = mark.start if mark.end is None else 0.5 * (mark.start + mark.end)
    offset: dict[str, Any] = {"xytext": (0, -3), "ha": "center"}
    if mark.end is None:
        offset = {"xytext": (-2, -3), "ha": "right", "rotation": 90, "bbox": BACKING, "zorder": 4}
    if mark.name:
        ax.annotate(
            mark.name, (middle, 1.0), xycoords=("data", "axes fraction"), va="top", fontsize=7.0,
            textcoords="offset points", color=COLOURS["muted"], **offset,
        )  # fmt: skip


def _curve(ax: Axes, panel: Panel, curve: Curve, right: float) -> Artist | Container:
    """Draw a curve with its ribbon and notes; returns the artist that stands for it in a legend.

    Parameters
    ----------
    right : float   end of the horizontal axis, at which horizontal bars are cut
    """
    colour = COLOURS[curve.colour]
    if curve.look == "bar":
        return _bars(ax, panel, curve, right)
    if curve.look == "fill":
        (outline,) = ax.fill(curve.x, curve.y, facecolor=COLOURS["steel"], edgecolor=colour,
                             linewidth=1.3, zorder=1.6, label=curve.label)  # fmt: skip
        return outline
    if curve.upper is not None:
        lower = curve.y if curve.lower is None else curve.lower
        ribbon = ax.fill_between(curve.x, lower, curve.upper, color=colour, alpha=0.16,
                                 linewidth=0, zorder=1)  # fmt: skip
        if curve.look == "band":
            return ribbon
    (line,) = ax.plot(curve.x, curve.y, color=colour, label=curve.label, **LOOKS[curve.look])
    if panel.kind != "bars":
        _notes(ax, curve)
    return line


def _notes(ax: Axes, curve: Curve) -> None:
    for note, x, y in zip(curve.notes, curve.x, curve.y, strict=False):
        if np.isfinite(y):
            ax.annotate(
                note, (x, y), xytext=(0, 4), textcoords="offset points", ha="center", va="bottom",
                fontsize=7.0, color=COLOURS["muted"], zorder=4,
            )  # fmt: skip


def _bars(ax: Axes, panel: Panel, curve: Curve, right: float) -> BarContainer:
    """Draw the bars of a curve: in the rows of a panel of bars, else upright beside those of the
    other curves.

    Parameters
    ----------
    right : float   end of the horizontal axis, at which horizontal bars are cut
    """
    look: dict[str, Any] = {"color": COLOURS[curve.colour], "label": curve.label, "zorder": 3}
    if panel.kind == "bars":
        start, length = curve.bars(right)
        return ax.barh(curve.y, length, 0.62, left=start, **look)
    beside = [each for each in panel.curves if each.look == "bar"]
    width = bar_width(curve.x) / len(beside)
    shift = (beside.index(curve) - 0.5 * (len(beside) - 1)) * width
    _notes(ax, curve)
    return ax.bar(curve.x + shift, curve.y, width, **look)


def _rows(ax: Axes, panel: Panel, axis: HorizontalAxis) -> None:
    """Names and values of horizontal bars, and the limits across them."""
    for row, end in enumerate(panel.ends):
        if not np.isnan(end):
            ax.annotate(f"{end:.4g}", (min(end, axis.span[1]), row), xytext=(8, 0),
                        textcoords="offset points", va="center", fontsize=7.8)  # fmt: skip
    for line in panel.limits:
        ax.axvline(line.value, color=COLOURS["fail"], linewidth=0.9, linestyle=LIMIT, zorder=2.5)
        ax.annotate(line.words(axis.unit), (line.value, 1.0), xycoords=("data", "axes fraction"),
                    ha="center", va="bottom", color=COLOURS["fail"], fontsize=7.2)  # fmt: skip
    ax.set_yticks(range(len(panel.rows)), panel.rows)
    ax.set_ylim(len(panel.rows) - 0.45, -0.55)


def _vertical(ax: Axes, panel: Panel, *, named: bool, below_names: bool) -> None:
    """Draw the vertical axis of a panel with its limits.

    Parameters
    ----------
    named : bool         whether the marks of the horizontal axis have names
    below_names : bool   whether these stand in this panel, so that words at its edge go below them
    """
    from matplotlib.ticker import MaxNLocator

    low, high = vertical_span(panel, named)
    ax.set_ylim(low, high)
    if low < 0 < high and panel.kind == "lines":
        ax.axhline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
    _limits(ax, panel, low, high, below_names=below_names)
    ax.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10]))


def _horizontal(ax: Axes, axis: HorizontalAxis, columns: int) -> None:
    """Draw the horizontal axis of a panel: ends and ticks.

    Parameters
    ----------
    columns : int   of panels in the figure, by which the number of ticks is limited
    """
    from matplotlib.ticker import MaxNLocator

    low, high = axis.span
    ax.set_xlim(low, high)
    if axis.step is None:
        ax.xaxis.set_major_locator(MaxNLocator(nbins=8 // columns, integer=axis.counted))
    else:
        first = axis.step * np.ceil(low / axis.step)
        ax.set_xticks(np.arange(first, high + 0.01 * axis.step, axis.step))


def _legend_columns(panel: Panel, inner: float) -> int:
    """Most columns of a legend, up to `LEGEND_ROW`, that fit above axes `inner` inches wide."""
    labels = [curve.label for curve in panel.labelled]
    for columns in range(min(len(labels), LEGEND_ROW), 1, -1):
        longest = sum(max(map(len, part)) for part in np.array_split(labels, columns))
        if longest * LETTER + columns * HANDLE <= inner + RIGHT:
            return columns
    return 1


def _legend_rows(panel: Panel, inner: float) -> int:
    return -(-len(panel.labelled) // _legend_columns(panel, inner))


def _legend(
    ax: Axes, panel: Panel, signs: Sequence[Artist | Container], size: tuple[float, float]
) -> None:
    """Legend above the axes; `size`: their width, inches, and its height above as a share."""
    ax.legend(
        signs, [curve.label for curve in panel.labelled], loc="lower left",
        bbox_to_anchor=(-0.012, 1 + size[1]), ncols=_legend_columns(panel, size[0]),
        frameon=False, borderaxespad=0.0, borderpad=0.0, handlelength=1.7, handletextpad=0.5,
        columnspacing=1.3, labelspacing=0.25,
    )  # fmt: skip


def _limits(ax: Axes, panel: Panel, low: float, high: float, *, below_names: bool) -> None:
    """Draw the limits on axes from `low` to `high`; those outside are written at the edge, below
    names of marks where `below_names`.
    """
    placed = placed_limits(panel, low, high)
    for line, above in placed.inside:
        ax.axhline(line.value, color=COLOURS["fail"], linewidth=0.9, linestyle=LIMIT, zorder=2.5)
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


def _second_axis(ax: Axes, second: SecondAxis) -> None:
    """Draw a horizontal axis above the panel; its values are those of the axis below over
    `second.ratio`.
    """

    def to_second(first: ArrayLike) -> ArrayLike:
        return np.asarray(first) / second.ratio

    def to_first(value: ArrayLike) -> ArrayLike:
        return np.asarray(value) * second.ratio

    above = ax.secondary_xaxis("top", functions=(to_second, to_first))
    above.set_xticks(np.arange(0.0, ax.get_xlim()[1] / second.ratio + 1.0, second.step))
    above.spines["top"].set_color(COLOURS["muted"])
    above.set_xlabel(second.words, labelpad=3)
    above.xaxis.label.set_color(COLOURS["ink"])


def _outline(figure: OutlineFigure | ContoursFigure) -> Canvas:
    """Curves and text of the outline on equal axes."""
    canvas = _canvas(FIGURE_WIDTH, FIGURE_WIDTH - 0.1)
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
