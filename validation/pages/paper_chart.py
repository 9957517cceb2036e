"""A figure of a paper as SVG in the style of the report: panels of curves, outlines or bars."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.geometry.figures import SERIES
from camwright.reports.figure_svg import COLOURS, FIGURE_WIDTH, LEFT, RIGHT, style, themed
from camwright.reports.report_tables import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Canvas

PANEL, LABELS, TITLE, ROW, NOTE, EDGE = 1.62, 0.44, 0.22, 0.17, 0.16, 0.08
"""Heights, inches: panel, ticks and label below, title, row of a legend, note, upper edge."""
BETWEEN = 0.12
"""Height below a panel without tick labels, inches."""
BAR, OUTLINE_MAX = 0.27, 3.5
"""Heights of a bar and of an outline at most, inches."""
LETTER, HANDLE = 0.062, 0.38
"""Widths, inches: a letter of a legend, its sign with the gaps."""
BACKGROUND = {-1: "muted", -2: "ink"}
"""Colours of curves in the background and of published points."""
LINES: dict[str, Any] = {
    "line": "solid", "dashed": (0, (4, 2.4)), "dotted": (0, (1, 1.6)), "thin": "solid",
}  # fmt: skip
WIDTHS = {"line": 1.5, "dashed": 1.3, "dotted": 1.4, "thin": 0.5}
TURNS = ((720.0, 90.0), (360.0, 60.0))
"""End and spacing of the ticks of an angle axis over a cycle or a turn, deg."""
DENSE = 60
"""Points of a record beyond which they are small."""


@dataclass(frozen=True, eq=False)
class Chart:
    """A figure of a paper with its drawing, from an entry of ``figures.json``."""

    record: Record

    @property
    def id(self) -> str:
        return str(self.record["name"])

    @property
    def title(self) -> str:
        return str(self.record["title"])

    @property
    def caption(self) -> str:
        """The caption, after paper and figure number."""
        numbers = self.record["numbers"]
        word = "Figures" if any(mark in numbers for mark in (" and ", " to ", ",")) else "Figure"
        return f"{self.record['paper']}, {word} {numbers}. {self.record['caption']}"

    @property
    def alt(self) -> str:
        """Text alternative: range of each curve."""
        parts = []
        for panel in self.record["panels"]:
            for curve in _labelled(panel):
                name = "x" if panel["kind"] == "bars" else "y"
                values = _values([*curve[name], *curve.get("upper", ())])
                quantity, low, high = panel[name], np.nanmin(values), np.nanmax(values)
                parts.append(f"{quantity}, {curve['label']}: {low:.4g} to {high:.4g}")
        return f"{self.title}. {'. '.join(parts)}."

    @property
    def svg(self) -> str:
        """SVG text in the colours of the light theme."""
        with style(self.id):
            stream = io.StringIO()
            drawn(self.record).savefig(stream, format="svg", metadata={"Date": None})
            return stream.getvalue()

    @property
    def themed(self) -> Markup:
        """The drawing with the colours of the page theme."""
        return Markup(themed(self.svg, self.id))  # noqa: S704 - matplotlib escapes text


def drawn(record: Record) -> Canvas:
    """Matplotlib figure of a paper's record: panels of curves, outlines or bars."""
    from matplotlib.figure import Figure as Canvas

    columns = record["columns"]
    panels = [_Panel(panel, record["panels"]) for panel in record["panels"]]
    for before, panel in zip(panels, panels[columns:], strict=False):
        panel.legend = panel.legend and panel.signs != before.signs
    rows = [panels[k : k + columns] for k in range(0, len(panels), columns)]
    left = max(panel.left for panel in panels)
    width = FIGURE_WIDTH / columns - left - RIGHT
    tops = [max(panel.top(width) for panel in row) for row in rows]
    sizes = [max(panel.size(width) for panel in row) for row in rows]
    shown = [k + 1 == len(rows) or not _same_axis(row, rows[k + 1]) for k, row in enumerate(rows)]
    below = [LABELS if labels else BETWEEN for labels in shown]
    total = sum(tops) + sum(sizes) + sum(below)
    canvas, edge = Canvas(figsize=(FIGURE_WIDTH, total)), total
    for row, top, size, foot, labels in zip(rows, tops, sizes, below, shown, strict=True):
        edge -= top + size
        for column, panel in enumerate(row):
            start = column * FIGURE_WIDTH / columns + left
            axes = canvas.add_axes(
                (start / FIGURE_WIDTH, edge / total, width / FIGURE_WIDTH, size / total)
            )
            panel.draw(axes, width, size)
            axes.tick_params(labelbottom=labels)
            axes.set_xlabel(panel.record["x"] if labels else "", labelpad=2)
        edge -= foot
    return canvas


class _Panel:
    """One pair of axes; `others` are the panels of its figure."""

    def __init__(self, record: Record, others: Sequence[Record]) -> None:
        self.record, self.kind = record, record["kind"]
        self.curves = _labelled(record)
        self.legend = len(self.curves) > 1
        self.others = others

    @property
    def signs(self) -> list[tuple[str, int, str]]:
        """Labels with colour and line, equal ones need one legend."""
        return [(c["label"], c["series"], c["look"]) for c in self.curves]

    @property
    def left(self) -> float:
        """Width left of the axes, inches."""
        longest = max((len(name) for name in self.record["rows"]), default=0)
        return max(LEFT, LETTER * longest + 0.15)

    def top(self, width: float) -> float:
        """Height above the axes for title, legend and note, inches."""
        height = EDGE + (TITLE if self.record["title"] else 0.0)
        height += NOTE if self.record["note"] else 0.0
        return height + (ROW * self._legend_rows(width) + 0.04 if self.legend else 0.0)

    def size(self, width: float) -> float:
        """Height of the axes, inches."""
        if self.kind == "bars":
            return BAR * len(self.record["rows"]) + 0.1
        if self.kind == "outline":
            left, right, low, high = self._box()
            return min(width * (high - low) / (right - left), OUTLINE_MAX)
        return PANEL

    def draw(self, axes: Axes, width: float, size: float) -> None:
        """Curves, axes, legend, title and note."""
        if self.kind == "bars":
            self._bars(axes)
        else:
            self._curves(axes)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        axes.grid(True, axis="x" if self.kind == "bars" else "both", zorder=0)
        axes.set_axisbelow(True)
        above = 0.05
        if self.record["note"]:
            _above(axes, self.record["note"], above, fontsize=7.2, color=COLOURS["muted"])
            above += NOTE
        if self.legend:
            handles = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
            axes.legend(
                [handles[curve["label"]] for curve in self.curves],
                [curve["label"] for curve in self.curves],
                loc="lower left", bbox_to_anchor=(-0.012, 1 + above / size),
                ncols=self._legend_columns(width), frameon=False, borderaxespad=0.0, borderpad=0.0,
                handlelength=1.7, handletextpad=0.5, columnspacing=1.3, labelspacing=0.25,
            )  # fmt: skip
            above += ROW * self._legend_rows(width)
        if self.record["title"]:
            _above(axes, self.record["title"], above + 0.05, fontsize=8.5, fontweight="bold")

    def _legend_rows(self, width: float) -> int:
        return ceil(len(self.curves) / self._legend_columns(width))

    def _legend_columns(self, width: float) -> int:
        """Number of columns so that a row of the legend is as wide as the panel at most."""
        longest = [LETTER * len(curve["label"]) + HANDLE for curve in self.curves]
        for columns in range(len(longest), 1, -1):
            rows = ceil(len(longest) / columns)  # matplotlib fills a legend by columns
            parts = [longest[k : k + rows] for k in range(0, len(longest), rows)]
            if len(parts) == columns and sum(map(max, parts)) <= width + 0.1:
                return columns
        return 1

    def _box(self) -> tuple[float, float, float, float]:
        """Limits of an outline with a margin, mm; one scale for all without a window."""
        if self.record["window"]:
            left, right, low, high = self.record["window"]
            return left, right, low, high
        limits: list[float] = []
        for name in ("x", "y"):
            values = np.concatenate([
                _values(curve[name]) for panel in self.others if not panel["window"]
                for curve in panel["curves"]
            ])  # fmt: skip
            ends = float(np.nanmin(values)), float(np.nanmax(values))
            margin = 0.05 * (ends[1] - ends[0])
            limits += [ends[0] - margin, ends[1] + margin]
        return limits[0], limits[1], limits[2], limits[3]

    def _curves(self, axes: Axes) -> None:
        from matplotlib.ticker import MaxNLocator

        for order, curve in enumerate(self.record["curves"]):
            _curve(axes, curve, 2.0 + 0.1 * order)
        axes.set_ylabel(self.record["y"])
        axes.yaxis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 2.5, 5, 10]))
        axes.xaxis.set_major_locator(MaxNLocator(nbins=6, steps=[1, 2, 2.5, 5, 10]))
        if self.kind == "outline":
            left, right, low, high = self._box()
            axes.set_aspect("equal")
            axes.set_xlim(left, right)
            axes.set_ylim(low, high)
            return
        low, high = axes.get_ylim()
        if low < 0 < high:
            axes.axhline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
        left, right = _span(self.record)
        ends = [t for t in TURNS if _is_angle(self.record["x"]) and 0.9 * t[0] < right <= t[0]]
        if ends:
            axes.set_xlim(0.0, ends[0][0])
            axes.set_xticks(np.arange(0.0, ends[0][0] + 1.0, ends[0][1]))
        else:
            axes.set_xlim(left, right)

    def _bars(self, axes: Axes) -> None:
        """Horizontal bars from `x` to `upper` in the rows `y`, and published points."""
        names = self.record["rows"]
        ends = np.zeros(len(names))
        for curve in self.record["curves"]:
            x, y = _values(curve["x"]), _values(curve["y"])
            colour = COLOURS[_colour(curve["series"])]
            if curve["look"] == "points":
                axes.plot(x, y, "D", color=colour, markersize=4.2, label=curve["label"], zorder=4,
                          markeredgecolor=COLOURS["card"], markeredgewidth=0.8)  # fmt: skip
                continue
            end = _values(curve["upper"])
            axes.barh(y, end - x, left=x, height=0.62, color=colour, label=curve["label"], zorder=3)
            ends[y.astype(int)] = end
        for row, reach in enumerate(ends):
            axes.annotate(f"{reach:.1f}", (reach, row), xytext=(8, 0), textcoords="offset points",
                          va="center", fontsize=7.8)  # fmt: skip
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.45, -0.55)
        axes.set_xlim(0.0, 1.12 * ends.max())


def _above(axes: Axes, words: str, height: float, **look: Any) -> None:
    """Words above the axes, at a height in inches."""
    axes.annotate(
        words, (0.0, 1.0), xycoords="axes fraction", xytext=(0, 72 * height),
        textcoords="offset points", **look,
    )  # fmt: skip


def _curve(axes: Axes, curve: Record, order: float) -> None:
    x, y, look = _values(curve["x"]), _values(curve["y"]), curve["look"]
    colour, label = COLOURS[_colour(curve["series"])], curve["label"] or None
    if look == "points":
        published = curve["series"] == -2
        axes.plot(
            x, y, "D" if published else "o", color=colour, label=label, linestyle="none",
            markersize=1.5 if x.size > DENSE else 3.6, clip_on=False,
            zorder=order + 1 if published else order,
        )  # fmt: skip
    elif look == "band":
        axes.fill_between(
            x, y, _values(curve["upper"]), color=colour, alpha=0.25, linewidth=0, label=label,
            zorder=1.5,
        )  # fmt: skip
    elif look == "fill":
        axes.fill(x, y, facecolor=COLOURS["steel"], edgecolor=colour, linewidth=1.3, label=label,
                  zorder=1.6)  # fmt: skip
    else:
        axes.plot(
            x, y, color=colour, label=label, linestyle=LINES[look], linewidth=WIDTHS[look],
            zorder=1.8 if look == "thin" else order,
        )  # fmt: skip


def _same_axis(row: Sequence[_Panel], following: Sequence[_Panel]) -> bool:
    """Whether the panels of the next row have the same horizontal axis."""
    return len(row) == len(following) and all(
        one.kind == other.kind == "lines" and one.record["x"] == other.record["x"]
        and np.allclose(_span(one.record), _span(other.record), rtol=1e-3)
        for one, other in zip(row, following, strict=True)
    )  # fmt: skip


def _span(panel: Record) -> tuple[float, float]:
    x = np.concatenate([_values(curve["x"]) for curve in panel["curves"]])
    return float(np.nanmin(x)), float(np.nanmax(x))


def _is_angle(axis: str) -> bool:
    return "angle" in axis and axis.endswith("deg")


def _labelled(panel: Record) -> list[Record]:
    return [curve for curve in panel["curves"] if curve["label"]]


def _colour(series: int) -> str:
    return BACKGROUND.get(series) or SERIES[series % len(SERIES)]


def _values(numbers: Sequence[float | None]) -> Array:
    """Numbers of a record; null is a gap."""
    return np.array([np.nan if value is None else value for value in numbers])
