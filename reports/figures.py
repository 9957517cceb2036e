"""What a figure says, apart from how it is drawn.

A sheet is a tuple of these values. `plots.py` draws them as SVG and PNG; an interactive renderer
can draw the same values, since every curve still carries its numbers, label and unit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array

SERIES = ("blue", "vermillion", "green", "purple", "orange", "sky")
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
    """The cam seen along its shaft; lengths in millimetres, points (2, n)."""

    id: str
    title: str
    caption: str
    contour: Array
    pitch: Array
    roller_radius: float | None
    bore_radius: float | None
    keyway: tuple[float, float, float] | None
    worst: int
    worst_label: str

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
            f" the shaft, with pitch curve, bore and the roller {self.worst_label}."
        )


Figure = AngleFigure | OutlineFigure
