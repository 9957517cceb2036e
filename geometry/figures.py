"""Contents of a figure: curves, limits, axes, title and caption; `plotted` draws it in a notebook.

`reports.figure_svg` draws the same figure for page and PDF, `reports.interactive` for Plotly. All
take numbers, text, colour names and looks from here; sizes and fonts are their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from camwright.geometry.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DrawnAxes: TypeAlias = "tuple[Axes, ...]"
"""Axes of the panels of a drawn figure."""
Look = Literal[
    "line", "dashed", "dotted", "thin", "marked", "points", "spot", "given", "bar", "band", "fill",
]  # fmt: skip
"""Look of a curve: a line, a line with its points marked, small points, large ones, given values,
bars from `lower` or zero, the region from `lower` to `upper`, a filled outline."""
Kind = Literal["lines", "bars", "outline"]
SERIES = ("blue", "vermillion", "green", "purple", "orange", "sky")
"""Colours of the curves of a panel, in their order."""
CRANK_STEP, CAM_STEP = 90.0, 45.0
"""Spacing of the tick labels on the angle axes, deg."""
MOST_POINTS = 40
"""Most points of a line that are marked."""
_MARGIN, _TEXT_BESIDE = 0.03, 0.05  # of the axis beside curves, of both axes about outlines
_PANEL, _OUTLINE, _BAR = (7.0, 2.4), (5.0, 4.4), 0.3  # inches
_STROKES = {"dashed": "--", "dotted": ":", "points": "none", "given": "none"}
_MARKERS = {"marked": "o", "points": ".", "spot": "o", "given": "D"}
_NAMED = {"muted": "grey", "ink": "black", "fail": "tab:red", "ok": "tab:green",
          "warn": "tab:olive"}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Curve:
    """One quantity over another.

    Parameters
    ----------
    x, y : array (n,)            in the units of the axes; NaN is a gap
    label : str                  in the legend; empty: none
    colour : str                 name of a colour
    lower, upper : array (n,)    edges of a pale ribbon, such as over several load cases; `lower` of
                                 a bar: where it begins
    notes : tuple                written at the points; of horizontal bars the names of all rows
    """

    x: Array
    y: Array
    label: str = ""
    colour: str = "blue"
    look: Look = "line"
    lower: Array | None = None
    upper: Array | None = None
    notes: tuple[str, ...] = ()

    @property
    def reached(self) -> Array:
        """All values of the vertical axis, those of the ribbon included."""
        parts = (self.y, self.lower, self.upper)
        return np.concatenate([part for part in parts if part is not None])

    def bars(self, right: float) -> tuple[Array, Array]:
        """Start and length of horizontal bars, which end at `right` at most."""
        start = np.zeros(self.x.size) if self.lower is None else self.lower
        return start, np.minimum(self.x, right) - start


@dataclass(frozen=True)
class LimitLine:
    """A limit of the values of a panel, in their unit."""

    value: float
    label: str

    def words(self, unit: str) -> str:
        """Label of the line: name, value, unit."""
        return f"{self.label} {self.value:.4g} {unit}".strip().replace("-", "\N{MINUS SIGN}")


@dataclass(frozen=True)
class AxisMark:
    """A part of the horizontal axis from `start` to `end`, or a line at `start`, with its name."""

    start: float
    name: str = ""
    end: float | None = None
    shaded: bool = False


@dataclass(frozen=True)
class SecondAxis:
    """Axis of the same places above the panels; `ratio` is the value of the first over its own."""

    quantity: str
    unit: str
    ratio: float
    step: float

    @property
    def words(self) -> str:
        """Title of the axis."""
        return _titled(self.quantity, self.unit)


@dataclass(frozen=True)
class HorizontalAxis:
    """Horizontal axis: quantity, unit and limits; ticks at multiples of `step`, or at integers.

    counted: of a count, at integers; second: axis above; marks: named parts and places.
    """

    quantity: str
    unit: str
    span: tuple[float, float]
    step: float | None = None
    counted: bool = False
    second: SecondAxis | None = None
    marks: tuple[AxisMark, ...] = ()

    @property
    def words(self) -> str:
        """Title of the axis."""
        return _titled(self.quantity, self.unit)

    @property
    def named(self) -> bool:
        """Whether a mark has a name."""
        return any(mark.name for mark in self.marks)


NO_AXIS = HorizontalAxis("", "", (0.0, 1.0))
"""Axis of a figure whose panels all have their own."""


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes: quantity, unit, curves, limits.

    Parameters
    ----------
    height : float            relative to the other panels
    span : tuple              limits of the vertical axis; None derives them from the curves, with
                              zero if `from_zero`
    kind : str                lines; outline: to one scale; bars: horizontal, x is their end in
                              the quantity of the axis, y the row from the top
    title, note : str         above the panel, the note in small letters
    axis : HorizontalAxis               horizontal axis where it is not that of the figure
    """

    quantity: str
    unit: str
    curves: tuple[Curve, ...]
    limits: tuple[LimitLine, ...] = ()
    height: float = 1.0
    span: tuple[float, float] | None = None
    from_zero: bool = False
    kind: Kind = "lines"
    title: str = ""
    note: str = ""
    axis: HorizontalAxis | None = None

    @property
    def words(self) -> str:
        """Title of the vertical axis."""
        return _titled(self.quantity, self.unit)

    @property
    def labelled(self) -> tuple[Curve, ...]:
        """Curves of the legend."""
        return tuple(curve for curve in self.curves if curve.label)

    @property
    def rows(self) -> tuple[str, ...]:
        """Names of horizontal bars, from the top; none of another kind."""
        named = (curve.notes for curve in self.curves if curve.notes and self.kind == "bars")
        return next(named, ())

    @property
    def ends(self) -> Array:
        """End of the bar in each row (rows,), in the unit of the axis, infinity too; NaN in a row
        without one.
        """
        ends = np.full(
            1 + max((int(np.max(c.y, initial=-1)) for c in self.curves), default=0), -inf
        )
        for curve in self.curves:
            if curve.look == "bar":
                np.fmax.at(ends, curve.y.astype(int), curve.x)
        return np.where(ends > -inf, ends, np.nan)


@dataclass(frozen=True, eq=False)
class Figure:
    """Panels in `columns`, over a common horizontal axis but for those with their own."""

    id: str
    title: str
    caption: str
    panels: tuple[Panel, ...]
    axis: HorizontalAxis = NO_AXIS
    columns: int = 1

    def axis_of(self, panel: Panel) -> HorizontalAxis:
        """Horizontal axis of a panel."""
        return self.axis if panel.axis is None else panel.axis

    @property
    def legends(self) -> tuple[bool, ...]:
        """Whether each panel has a legend (panels,): with two curves or more that have names; the
        first alone where all have the same names.
        """
        first = [curve.label for curve in self.panels[0].curves]
        shared = all(len(p.curves) < 2 or [c.label for c in p.curves] == first for p in self.panels)
        return tuple(len(p.labelled) > 1 and not (k and shared) for k, p in enumerate(self.panels))

    @property
    def alt(self) -> str:
        """Text alternative of the picture: title, range of each curve or every point of a count,
        limits.
        """
        parts = []
        for panel in self.panels:
            axis = self.axis_of(panel)
            for curve in panel.curves:
                values = curve.reached if curve.look == "band" else curve.y
                quantity, unit = panel.quantity, panel.unit
                if panel.kind == "bars":
                    values, quantity, unit = curve.x, axis.quantity, axis.unit
                if not np.isfinite(values).any():
                    continue
                name = f"{quantity}, {curve.label}" if curve.label else quantity
                points = _points(curve, unit) if axis.counted else _range(values, unit)
                parts.append(f"{name}: {points}")
                if axis.second is not None:
                    at = curve.x[int(np.nanargmax(np.abs(curve.y)))]
                    parts[-1] += f", largest magnitude at {at:.4g} {axis.unit} {axis.quantity}"
            unit = self.axis_of(panel).unit if panel.kind == "bars" else panel.unit
            parts += [f"limit {line.words(unit)}" for line in panel.limits]
        over = f" by {self.axis.quantity}" if self.axis.quantity else ""
        over = " over one turn of the cam" if self.axis.second else over
        return f"{self.title}{over}. {'. '.join(parts)}."


def _titled(quantity: str, unit: str) -> str:
    return f"{quantity}, {unit}" if unit else quantity


def _range(values: Array, unit: str) -> str:
    return f"{np.nanmin(values):.4g} to {np.nanmax(values):.4g} {unit}".rstrip()


def _points(curve: Curve, unit: str) -> str:
    """Values of a curve with unit, place and note each, as text; NaN left out."""
    notes = [f" ({note})" for note in curve.notes] or [""] * curve.x.size
    return ", ".join(
        f"{value:.4g} {unit}".rstrip() + f" at {at:g}{note}"
        for at, value, note in zip(curve.x, curve.y, notes, strict=True)
        if np.isfinite(value)
    )


def over_turn(
    figure_id: str, title: str, caption: str, panels: Sequence[Panel], *, ratio: float = 2.0,
    shaft: str = "crank", marks: tuple[AxisMark, ...] = (), worst: float | None = None,
) -> Figure:  # fmt: skip
    """Figure over one turn of the cam, shaft angle below and cam angle above.

    Parameters
    ----------
    panels : sequence    x of the curves is the shaft angle, deg; they are closed at its end
    ratio : float        turns of the shaft in one of the cam
    worst : float        shaft angle that is marked, deg
    """
    period = 360.0 * ratio
    step = CRANK_STEP * max(1.0, float(np.ceil(ratio / 2.0 - 1e-9)))  # 90 deg up to two turns
    if worst is not None:
        marks += (AxisMark(worst % period),)
    second = SecondAxis("cam angle", "deg", ratio, CAM_STEP)
    axis = HorizontalAxis(f"{shaft} angle", "deg", (0.0, period), step, second=second, marks=marks)
    return Figure(figure_id, title, caption, tuple(
        replace(panel, curves=tuple(_closed(curve, period) for curve in panel.curves))
        for panel in panels
    ), axis)  # fmt: skip


def _closed(curve: Curve, period: float) -> Curve:
    """A curve that ends with its first value, a period later."""
    x = np.append(curve.x, period + curve.x[0])
    lower, upper = (None if each is None else closed(each) for each in (curve.lower, curve.upper))
    return replace(curve, x=x, y=closed(curve.y), lower=lower, upper=upper)


def closed(values: Array) -> Array:
    """Values (..., n) over a turn, closed by repeating the first: (..., n + 1)."""
    return np.concatenate([values, values[..., :1]], axis=-1)


def over(
    figure_id: str, title: str, caption: str, quantity: str, unit: str, panels: Sequence[Panel], *,
    counted: bool = False, dots: bool = True, marks: tuple[AxisMark, ...] = (),
) -> Figure:  # fmt: skip
    """Figure of panels over a common quantity, whose limits follow from the curves.

    Parameters
    ----------
    panels : sequence   x of the curves is ascending
    counted : bool      the quantity is a count
    dots : bool         the points of lines are marked unless there are many
    """
    axis = HorizontalAxis(quantity, unit, _span(panels, counted), counted=counted, marks=marks)
    if dots:
        panels = [replace(p, curves=tuple(map(_dotted, p.curves))) for p in panels]
    return Figure(figure_id, title, caption, tuple(panels), axis)


def _span(panels: Sequence[Panel], counted: bool) -> tuple[float, float]:
    """Limits of the horizontal axis about the curves, with a margin, in the unit of the axis."""
    curves = [curve for panel in panels for curve in panel.curves]
    low, high = _ends(curve.x for curve in curves)
    width = max((bar_width(c.x) for c in curves if c.look == "bar"), default=0.0)
    margin = 0.5 if counted else 0.7 * width or _MARGIN * (high - low)
    return low - margin, high + margin


def _ends(values: Iterable[Array]) -> tuple[float, float]:
    """Least and greatest of finite values; 0 and 1 without any."""
    finite = [each[np.isfinite(each)] for each in values]
    reached = np.concatenate(finite) if any(each.size for each in finite) else np.array([0.0, 1.0])
    return float(reached.min()), float(reached.max())


def outline(points: Array, label: str = "", colour: str = "blue", look: Look = "line") -> Curve:
    """Curve through points (2, n), mm."""
    x, y = points
    return Curve(x, y, label, colour, look)


def outline_panel(
    curves: tuple[Curve, ...], title: str = "", names: tuple[str, str] = ("x", "y")
) -> Panel:
    """Panel of outlines, mm, to one scale; names : of the horizontal and the vertical axis."""
    spans = []
    for values in ((curve.x for curve in curves), (curve.y for curve in curves)):
        low, high = _ends(values)
        spans.append((low - _TEXT_BESIDE * (high - low), high + _TEXT_BESIDE * (high - low)))
    axis = HorizontalAxis(names[0], "mm", spans[0])
    return Panel(names[1], "mm", curves, span=spans[1], kind="outline", title=title, axis=axis)


def _dotted(curve: Curve) -> Curve:
    """A line of few points, or of a single one, with its points marked."""
    few = curve.x.size <= MOST_POINTS or np.isfinite(curve.y).sum() == 1
    return replace(curve, look="marked") if few and curve.look == "line" else curve


def bar_width(x: Array) -> float:
    """Width of all bars at one x (n,) together."""
    return 0.8 * float(np.min(np.diff(x), initial=1.0 if x.size < 2 else inf))


def plotted(figure: Figure) -> DrawnAxes:
    """Draw a figure by pyplot, as a notebook shows it: panels one below the other.

    Returns
    -------
    tuple   axes of the panels, in a new figure of pyplot
    """
    import matplotlib.pyplot as plt

    panels = figure.panels
    width = max(_size(panel)[0] for panel in panels)
    heights = [_size(panel)[1] for panel in panels]
    _, grid = plt.subplots(
        len(panels), sharex=all(panel.axis is None for panel in panels), squeeze=False,
        figsize=(width, sum(heights) + 0.6), height_ratios=heights, layout="constrained",
    )  # fmt: skip
    axes: DrawnAxes = tuple(grid[:, 0])
    for number, (ax, panel) in enumerate(zip(axes, panels, strict=True)):
        axis = figure.axis_of(panel)
        for curve in panel.curves:
            _draw(ax, panel, curve, axis.span[1])
        for line in panel.limits:
            (ax.axvline if panel.kind == "bars" else ax.axhline)(
                line.value, color=_NAMED["fail"], linewidth=0.9
            )
        for mark in axis.marks:
            ax.axvline(mark.start, color=_NAMED["ink"], linewidth=0.7)
        heading = "\n".join(filter(None, (panel.title, panel.note)))
        ax.set(xlim=axis.span, ylabel=panel.words, title=heading)
        if panel.kind == "bars":
            _name_rows(ax, panel, axis.span[1])
        elif panel.kind == "outline":
            ax.set_aspect("equal")
        if panel.span is not None:
            ax.set_ylim(panel.span)
        ax.grid(alpha=0.3)
        if figure.legends[number]:
            ax.legend(fontsize="small")
        if number + 1 == len(panels) or panel.axis is not None:
            ax.set_xlabel(axis.words)
    return axes


def _size(panel: Panel) -> tuple[float, float]:
    """Width and height of a panel, inches."""
    if panel.kind == "bars":
        return _PANEL[0], _BAR * len(panel.rows) + 0.4
    return _OUTLINE if panel.kind == "outline" else (_PANEL[0], _PANEL[1] * panel.height)


def _draw(ax: Axes, panel: Panel, curve: Curve, right: float) -> None:
    """Draw a curve with its ribbon in the colours of pyplot; horizontal bars end at `right` at
    most.
    """
    colour = _NAMED.get(curve.colour)
    if colour is None:
        colour = f"C{SERIES.index(curve.colour)}"
    if curve.look == "bar" and panel.kind == "bars":
        start, length = curve.bars(right)
        ax.barh(curve.y, length, left=start, color=colour, label=curve.label)
        return
    if curve.upper is not None:
        lower = curve.y if curve.lower is None else curve.lower
        ax.fill_between(curve.x, lower, curve.upper, color=colour, alpha=0.16)
    ax.plot(
        curve.x, curve.y, color=colour, label=curve.label, marker=_MARKERS.get(curve.look, ""),
        linestyle=_STROKES.get(curve.look, "-"), linewidth=0.8 if curve.look != "line" else None,
    )  # fmt: skip


def _name_rows(ax: Axes, panel: Panel, right: float) -> None:
    """Write the names of horizontal bars beside them, and their ends in figures, at `right` at
    most.
    """
    for row, end in enumerate(panel.ends):
        if not np.isnan(end):
            ax.text(min(end, right), row, f" {end:.4g}", va="center", fontsize="small")
    ax.set_yticks(range(len(panel.rows)), panel.rows, fontsize="small")
    ax.set_ylim(len(panel.rows) - 0.45, -0.55)
