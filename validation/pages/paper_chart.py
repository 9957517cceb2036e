"""A figure of a paper from its entry in a record, in the style of the report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from markupsafe import Markup

from camwright.geometry.arrays import Array
from camwright.geometry.figures import (
    SERIES,
    Curve,
    Figure,
    HorizontalAxis,
    Panel,
    outline_panel,
    over,
)
from camwright.reports.figure_svg import svg_of, themed
from camwright.reports.report_tables import Record

BACKGROUND = {-1: "muted", -2: "ink"}
"""Colours of curves in the background and of published points."""
TURNS = ((720.0, 90.0), (360.0, 60.0))
"""End and spacing of the ticks of an angle axis over a cycle or a turn, deg."""


@dataclass(frozen=True, eq=False)
class Chart:
    """A figure of a paper, from an entry of ``figures.json``."""

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
    def figure(self) -> Figure:
        """Its panels; those without an axis in common have their own."""
        panels = self.record["panels"]
        made = tuple(_panel(panel, panels) for panel in panels)
        return Figure(self.id, self.title, self.caption, made, columns=self.record["columns"])

    @property
    def alt(self) -> str:
        """Text alternative: range of each curve."""
        return self.figure.alt

    @property
    def themed(self) -> Markup:
        """The drawing with the colours of the page theme."""
        return Markup(themed(svg_of(self.figure), self.id))  # noqa: S704 - matplotlib escapes text


def _panel(record: Record, others: Sequence[Record]) -> Panel:
    """A panel with its axis; outlines without a window have one scale."""
    curves = tuple(_curve(curve, record) for curve in record["curves"])
    if record["kind"] == "outline":
        alike = [_curve(c, p) for p in others if not p["window"] for c in p["curves"]]
        panel = outline_panel(tuple(alike) or curves, record["title"])
        if record["window"]:
            left, right, low, high = record["window"]
            axis = HorizontalAxis("x", "mm", (left, right))
            panel = replace(panel, span=(low, high), axis=axis)
        return replace(panel, curves=curves, note=record["note"])
    quantity, unit = _split(record["x"])
    panel = Panel(*_split(record["y"]), curves, kind=record["kind"], title=record["title"],
                  note=record["note"])  # fmt: skip
    if record["kind"] == "bars":
        axis = HorizontalAxis(quantity, unit, (0.0, 1.12 * float(np.nanmax(panel.ends))))
        return replace(panel, axis=axis)
    axis = over("", "", "", quantity, unit, [panel], dots=False).axis
    end = max(float(np.nanmax(curve.x)) for curve in curves)
    turn = [each for each in TURNS if 0.9 * each[0] < end <= each[0]]
    if turn and unit == "deg" and "angle" in quantity:
        axis = HorizontalAxis(quantity, unit, (0.0, turn[0][0]), turn[0][1])
    return replace(panel, axis=axis)


def _curve(record: Record, panel: Record) -> Curve:
    """A curve; published points are diamonds, bars reach from `x` to `upper`."""
    x, y = _values(record["x"]), _values(record["y"])
    upper = _values(record["upper"]) if "upper" in record else None
    series, look = record["series"], record["look"]
    colour = BACKGROUND.get(series) or SERIES[series % len(SERIES)]
    if look == "bar" and upper is not None:
        rows = tuple(panel["rows"])
        return Curve(upper, y, record["label"], colour, look, lower=x, notes=rows)
    if series == -2 and look == "points":
        look = "given"
    return Curve(x, y, record["label"], colour, look, upper=upper)


def _split(words: str) -> tuple[str, str]:
    """Quantity and unit of the title of an axis."""
    quantity, _, unit = words.rpartition(", ")
    return (quantity, unit) if quantity else (words, "")


def _values(numbers: Sequence[float | None]) -> Array:
    """Numbers of a record; null is a gap."""
    return np.array([np.nan if value is None else value for value in numbers])
