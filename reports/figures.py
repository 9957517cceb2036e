"""What a figure says, apart from how it is drawn.

A sheet is a tuple of these values. `plots.py` draws them as SVG and PNG; an interactive renderer
can draw the same values, since every curve still carries its numbers, label and unit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array

SERIES = ("blue", "vermillion", "green", "purple", "orange", "sky")
FAR_LIMIT = 1.6
"""A limit farther from the curves than this many times their swing does not stretch the axis."""
WORDS_HEIGHT = 0.09
"""Of a panel: what the words of a limit take up."""
STROKES = ("intake", "compression", "expansion", "exhaust")


@dataclass(frozen=True, eq=False)
class Curve:
    """One quantity over the turn.

    `values` (n,) belong to the figure's crank angles; `band` is the least and greatest over all
    load cases, drawn as a pale ribbon when there is more than one.
    """

    label: str
    values: Array
    colour: str = "blue"
    dashed: bool = False
    band: tuple[Array, Array] | None = None


@dataclass(frozen=True)
class LimitLine:
    """A horizontal limit, in the panel's unit."""

    value: float
    label: str

    def words(self, unit: str) -> str:
        """The limit as written beside its line."""
        return f"{self.label} {self.value:.4g} {unit}".strip().replace("-", "\N{MINUS SIGN}")


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes: a quantity with its unit, the curves, the limits.

    `span` clips the vertical axis to given values; None takes it from the curves.
    """

    quantity: str
    unit: str
    curves: tuple[Curve, ...]
    limits: tuple[LimitLine, ...] = ()
    height: float = 1.0
    span: tuple[float, float] | None = None

    @property
    def legend_entries(self) -> int:
        """Curves with a name."""
        return sum(bool(curve.label) for curve in self.curves)


def vertical_span(panel: Panel, strokes: bool) -> tuple[float, float]:
    """Vertical limits that hold curves, ribbons, near limits, and air for names of strokes."""
    if panel.span is not None:
        return panel.span
    held = [part for curve in panel.curves for part in (curve.values, *(curve.band or ()))]
    values = np.concatenate(held or [np.zeros(1)])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low > 0 and low < 0.5 * high:
        low = 0.0
    size = max(high - low, 1e-12 + 1e-3 * max(abs(low), abs(high)))
    for line in panel.limits:
        if low - FAR_LIMIT * size < line.value < high + FAR_LIMIT * size:
            low, high = min(low, line.value), max(high, line.value)
    size = max(high - low, size)
    return low - (0.06 * size if low != 0.0 else 0.0), high + (0.16 if strokes else 0.07) * size


@dataclass(frozen=True)
class PlacedLimits:
    """Limits within the axes, each with whether its words stand above it; those `beyond` them.

    `beyond` is in words, empty when there is none; `above` tells at which edge they stand.
    """

    inside: tuple[tuple[LimitLine, bool], ...]
    beyond: str
    above: bool


def placed_limits(panel: Panel, low: float, high: float) -> PlacedLimits:
    """Where the limits of a panel and their words go on axes from `low` to `high`."""
    beyond = [line for line in panel.limits if not low <= line.value <= high]
    inside = [line for line in panel.limits if line not in beyond]
    heights = [(line.value - low) / (high - low) for line in inside]
    slots = [{True: height, False: height - WORDS_HEIGHT} for height in heights]
    taken: list[float] = []
    above: dict[int, bool] = {}
    # those first that have no choice
    for k in sorted(range(len(inside)), key=lambda k: sum(_free(s, ()) for s in slots[k].values())):
        wanted = heights[k] < 0.12 or (inside[k].value >= 0 and heights[k] < 0.78)
        swap = not _free(slots[k][wanted], taken) and _free(slots[k][not wanted], taken)
        above[k] = wanted != swap
        taken.append(slots[k][above[k]])
    placed = [(line, above[k]) for k, line in enumerate(inside)]
    upwards = bool(beyond) and beyond[0].value > high
    words = "; ".join(line.words(panel.unit) for line in beyond)
    if words:
        words = f"{words} ({'above' if upwards else 'below'} this axis)"
    return PlacedLimits(tuple(placed), words, upwards)


def _free(bottom: float, taken: Sequence[float]) -> bool:
    """Whether words at this height stay on the axes and clear of others."""
    within = -1e-9 <= bottom <= 1.0 - 2 * WORDS_HEIGHT
    return within and all(abs(bottom - other) >= WORDS_HEIGHT - 1e-9 for other in taken)


@dataclass(frozen=True, eq=False)
class AngleFigure:
    """Panels above one another over a full turn, crank angle below and cam angle above."""

    id: str
    title: str
    caption: str
    crank: Array
    panels: tuple[Panel, ...]
    gear_ratio: float = 2.0
    strokes: bool = True
    worst: float | None = None

    @property
    def one_legend(self) -> bool:
        """Whether the names of the first panel's curves serve all panels."""
        first = [curve.label for curve in self.panels[0].curves]
        return all([c.label for c in p.curves] == first or len(p.curves) < 2 for p in self.panels)

    @property
    def alt(self) -> str:
        """The figure in words: each curve with its range and where its largest size occurs."""
        parts = []
        for panel in self.panels:
            for curve in panel.curves:
                if not np.isfinite(curve.values).any():
                    continue
                low, high = np.nanmin(curve.values), np.nanmax(curve.values)
                where = self.crank[int(np.nanargmax(np.abs(curve.values)))]
                parts.append(
                    f"{panel.quantity}, {curve.label}: {low:.4g} to {high:.4g} {panel.unit},"
                    f" largest size at {where:.4g} degrees crank"
                )
            parts += [f"limit {line.label}: {line.value:.4g} {panel.unit}" for line in panel.limits]
        return f"{self.title} over one turn of the cam. " + ". ".join(parts) + "."


@dataclass(frozen=True, eq=False)
class OutlineFigure:
    """The cam seen along its shaft; lengths in millimetres, points (2, n).

    pitch is the path of the roller's centre, if there is one; follower, the outline of roller or
    face where the worst angle has it.
    """

    id: str
    title: str
    caption: str
    contour: Array
    pitch: Array | None
    follower: Array | None
    follower_name: str
    bore_radius: float | None
    keyway: tuple[float, float, float] | None
    worst: int
    worst_label: str
    counter_hole: tuple[float, float, float, bool] | None = None

    @property
    def radii(self) -> tuple[int, int]:
        """Where the contour is nearest to the shaft, and where farthest."""
        radius = np.hypot(*self.contour)
        return int(np.argmin(radius)), int(np.argmax(radius))

    @property
    def alt(self) -> str:
        """The figure in words."""
        radius = np.hypot(*self.contour)
        return (
            f"{self.title}: cam contour between {radius.min():.4g} and {radius.max():.4g} mm from"
            f" the shaft, with {'' if self.pitch is None else 'pitch curve, '}bore and the"
            f" {self.follower_name} {self.worst_label}."
        )


Figure = AngleFigure | OutlineFigure
