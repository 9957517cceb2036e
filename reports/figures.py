"""Contents of a figure: curves, limits, units, title and caption.

`figure_svg` draws a figure by matplotlib, `interactive` by Plotly. Both take numbers, text, colour
names and dashes from here; sizes and fonts are their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.machine_words import NamedStroke

SERIES = ("blue", "vermillion", "green", "purple", "orange", "sky")
FAR_LIMIT = 1.6
"""A limit within this multiple of the curves' range from them extends the vertical axis."""
WORDS_HEIGHT = 0.09
"""Height of the label of a limit, as a share of the panel."""
CAM_AXIS = "cam angle, deg"
CRANK_STEP, CAM_STEP = 90, 45
"""Spacing of the tick labels on the angle axes, deg."""
X_AXIS, Y_AXIS = "x, mm (cam angle 0 points along x)", "y, mm"
MOST_POINTS = 40
"""Most points of a line that are marked."""
_ROUND = 121  # points of a circle


def closed(values: Array) -> Array:
    """Values (..., n) over a turn, closed by repeating the first: (..., n + 1)."""
    return np.concatenate([values, values[..., :1]], axis=-1)


@dataclass(frozen=True, eq=False)
class Curve:
    """One quantity over the turn.

    `values` (n,) are at the crank angles of the figure; `band` is the minimum and maximum over
    several load cases, drawn as a pale ribbon. `notes` are written at the points of a `LineFigure`.
    """

    label: str
    values: Array
    colour: str = "blue"
    dashed: bool = False
    band: tuple[Array, Array] | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class LimitLine:
    """A horizontal limit, in the unit of the panel."""

    value: float
    label: str

    def words(self, unit: str) -> str:
        """Label of the line: name, value, unit."""
        return f"{self.label} {self.value:.4g} {unit}".strip().replace("-", "\N{MINUS SIGN}")


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes: quantity, unit, curves, limits.

    `span` are the limits of the vertical axis; None derives them from the curves, with zero if
    `from_zero`, as bars need it. `height` is relative to the other panels.
    """

    quantity: str
    unit: str
    curves: tuple[Curve, ...]
    limits: tuple[LimitLine, ...] = ()
    height: float = 1.0
    span: tuple[float, float] | None = None
    from_zero: bool = False

    @property
    def title(self) -> str:
        """Title of the vertical axis."""
        return f"{self.quantity}, {self.unit}" if self.unit else self.quantity

    @property
    def noted(self) -> bool:
        """Whether points of a curve are named."""
        return any(curve.notes for curve in self.curves)

    @property
    def legend_entries(self) -> int:
        """Number of curves with a label."""
        return sum(bool(curve.label) for curve in self.curves)


def vertical_span(panel: Panel, named: bool) -> tuple[float, float]:
    """Vertical axis limits: curves, ribbons, near limits, space for names of marks or points."""
    if panel.span is not None:
        return panel.span
    held = [part for curve in panel.curves for part in (curve.values, *(curve.band or ()))]
    values = np.concatenate(held or [np.zeros(1)])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if low > 0 and (low < 0.5 * high or panel.from_zero):
        low = 0.0
    size = max(high - low, 1e-12 + 1e-3 * max(abs(low), abs(high)))
    for line in panel.limits:
        if low - FAR_LIMIT * size < line.value < high + FAR_LIMIT * size:
            low, high = min(low, line.value), max(high, line.value)
    size = max(high - low, size)
    return low - (0.06 * size if low != 0.0 else 0.0), high + (
        0.16 if named or panel.noted else 0.07
    ) * size


@dataclass(frozen=True)
class PlacedLimits:
    """Limits on a pair of axes.

    `inside` are limits within the axes, each with whether its label is above the line; `beyond` are
    words on those outside, at the upper edge (True) and at the lower one.
    """

    inside: tuple[tuple[LimitLine, bool], ...]
    beyond: tuple[tuple[str, bool], ...]


def placed_limits(panel: Panel, low: float, high: float) -> PlacedLimits:
    """Places of the limits and their labels on axes from `low` to `high`, without overlap."""
    inside = [line for line in panel.limits if low <= line.value <= high]
    beyond = []
    for upwards, way in ((True, "above"), (False, "below")):
        words = [line.words(panel.unit) for line in panel.limits
                 if (line.value > high if upwards else line.value < low)]  # fmt: skip
        if words:
            beyond.append((f"{'; '.join(words)} ({way} this axis)", upwards))
    taken = [0.0 for _, upwards in beyond if not upwards]  # the upper edge is kept free for words
    heights = [(line.value - low) / (high - low) for line in inside]
    wanted = [h < 0.12 or (each.value >= 0 and h < 0.78)
              for h, each in zip(heights, inside, strict=True)]  # fmt: skip
    upper, clear = _sides(heights, wanted, taken, sign=-1.0)
    if not clear:
        upper, _ = _sides(heights, wanted, taken, sign=1.0)
    return PlacedLimits(tuple(zip(inside, upper, strict=True)), tuple(beyond))


def _sides(
    heights: Sequence[float], wanted: Sequence[bool], taken: Sequence[float], sign: float
) -> tuple[list[bool], bool]:
    """Whether each label stands above its line, and whether all are clear of one another.

    `taken` are the places of other words. Labels with only one possible place come first, of
    others the lowest (sign 1) or highest (-1).
    """
    slots = [{True: height, False: height - WORDS_HEIGHT} for height in heights]
    taken, above = list(taken), list(wanted)

    def order(k: int) -> tuple[int, float]:
        return sum(_free(slot, ()) for slot in slots[k].values()), sign * heights[k]

    clear = True
    for k in sorted(range(len(heights)), key=order):
        if not _free(slots[k][above[k]], taken):
            above[k] = above[k] != _free(slots[k][not above[k]], taken)
        clear &= all(abs(slots[k][above[k]] - other) >= WORDS_HEIGHT - 1e-9 for other in taken)
        taken.append(slots[k][above[k]])
    return above, clear


def _free(bottom: float, taken: Sequence[float]) -> bool:
    """Whether a label at this height is within the axes and clear of the others."""
    within = -1e-9 <= bottom <= 1.0 - 2 * WORDS_HEIGHT
    return within and all(abs(bottom - other) >= WORDS_HEIGHT - 1e-9 for other in taken)


@dataclass(frozen=True, eq=False)
class AngleFigure:
    """Panels over one cam turn, shaft angle below and cam angle above; `worst` is marked.

    `crank` (n,) are the shaft angles, deg; `shaft` is the name of the shaft, `marks` are the named
    parts of its turns.
    """

    id: str
    title: str
    caption: str
    crank: Array
    panels: tuple[Panel, ...]
    gear_ratio: float = 2.0
    marks: tuple[NamedStroke, ...] = ()
    shaft: str = "crank"
    worst: float | None = None

    @property
    def period(self) -> float:
        """Crank angle of one turn of the cam, deg."""
        return 360.0 * self.gear_ratio

    @property
    def closed_crank(self) -> Array:
        """Crank angles (n + 1,) of the closed curves, deg."""
        return np.append(self.crank, self.period + self.crank[0])

    @property
    def mark(self) -> float | None:
        """Crank angle of the dotted line, deg, within one turn."""
        return None if self.worst is None else self.worst % self.period

    @property
    def shaft_axis(self) -> str:
        """Title of the lower axis."""
        return f"{self.shaft} angle, deg"

    @property
    def shaft_step(self) -> float:
        """Distance of the ticks of the lower axis, deg: 90 up to two turns."""
        return CRANK_STEP * max(1.0, np.ceil(self.gear_ratio / 2.0 - 1e-9))

    @property
    def legends(self) -> tuple[bool, ...]:
        """Whether each panel has a legend."""
        return shown_legends(self.panels)

    @property
    def alt(self) -> str:
        """Text alternative: range of each curve and angle of its largest magnitude."""
        parts = []
        for panel in self.panels:
            for curve in panel.curves:
                if not np.isfinite(curve.values).any():
                    continue
                low, high = np.nanmin(curve.values), np.nanmax(curve.values)
                where = self.crank[int(np.nanargmax(np.abs(curve.values)))]
                parts.append(
                    f"{panel.quantity}, {curve.label}: {low:.4g} to {high:.4g} {panel.unit},"
                    f" largest magnitude at {where:.4g} degrees {self.shaft}"
                )
            parts += [f"limit {line.label}: {line.value:.4g} {panel.unit}" for line in panel.limits]
        return f"{self.title} over one turn of the cam. " + ". ".join(parts) + "."


@dataclass(frozen=True, eq=False)
class LineFigure:
    """Panels over a common quantity: x (n,), ascending; `whole`: a count.

    Points are marked as `dots`, unless there are many, or drawn as `bars`. `marks` are values of x
    with a name each.
    """

    id: str
    title: str
    caption: str
    quantity: str
    unit: str
    x: Array
    panels: tuple[Panel, ...]
    whole: bool = False
    bars: bool = False
    dots: bool = True
    marks: tuple[tuple[float, str], ...] = ()

    def dotted(self, curve: Curve) -> bool:
        """Whether the points of a curve are marked; a single one always is."""
        return (self.dots and self.x.size <= MOST_POINTS) or np.isfinite(curve.values).sum() == 1

    @property
    def bar_width(self) -> float:
        """Width of the bars of all curves at one x together."""
        return 0.8 * float(np.min(np.diff(self.x), initial=1.0 if self.whole else np.inf))

    @property
    def axis(self) -> str:
        """Title of the horizontal axis."""
        return f"{self.quantity}, {self.unit}" if self.unit else self.quantity

    @property
    def span(self) -> tuple[float, float]:
        """Limits of the horizontal axis."""
        low, high = float(self.x[0]), float(self.x[-1])
        margin = 0.03 * (high - low)
        if self.whole or self.bars:
            margin = 0.5 if self.whole else 0.7 * self.bar_width
        return low - margin, high + margin

    @property
    def legends(self) -> tuple[bool, ...]:
        """Whether each panel has a legend."""
        return shown_legends(self.panels)

    @property
    def alt(self) -> str:
        """Text alternative: range of each curve; every point of a count."""
        parts = []
        for panel in self.panels:
            for curve in panel.curves:
                if not np.isfinite(curve.values).any():
                    continue
                name = f"{panel.quantity}, {curve.label}" if curve.label else panel.quantity
                if self.whole:
                    points = zip(self.x, curve.values, strict=True)
                    notes = [f" ({note})" for note in curve.notes] or [""] * self.x.size
                    shown = ", ".join(
                        f"{value:.4g} {panel.unit}".rstrip() + f" at {at:g}{note}"
                        for (at, value), note in zip(points, notes, strict=True)
                        if np.isfinite(value)
                    )
                else:
                    low, high = np.nanmin(curve.values), np.nanmax(curve.values)
                    shown = f"{low:.4g} to {high:.4g} {panel.unit}".rstrip()
                parts.append(f"{name}: {shown}")
        return f"{self.title} by {self.quantity}. " + ". ".join(parts) + "."


def shown_legends(panels: Sequence[Panel]) -> tuple[bool, ...]:
    """Whether each panel has a legend; one is enough for panels with equal labels."""
    first = [curve.label for curve in panels[0].curves]
    shared = all(len(p.curves) < 2 or [c.label for c in p.curves] == first for p in panels)
    return tuple(p.legend_entries > 1 and not (k and shared) for k, p in enumerate(panels))


@dataclass(frozen=True, eq=False)
class OutlineCurve:
    """A curve of the outline: points (2, n), mm, filled with the colour `fill` if it is named.

    angle (n,) is the cam angle of each point, deg, or None; `dash` is solid, dashed or dashdot,
    `marker` dot, cross or empty.
    """

    points: Array
    colour: str
    label: str = ""
    width: float = 1.0
    dash: str = "solid"
    fill: str = ""
    marker: str = ""
    angle: Array | None = None


@dataclass(frozen=True)
class OutlineText:
    """Text along a line: centre, mm, and rotation, deg counter-clockwise."""

    words: str
    place: tuple[float, float]
    turn: float


@dataclass(frozen=True, eq=False)
class OutlineFigure:
    """The cam in the direction of its shaft, points (2, n) in mm.

    `pitch` is the pitch curve of a roller follower, `follower` the outline of roller or face at
    row `worst`; None if unknown. `keyway` is width and depth, mm, and angle, rad; `counter_hole`
    centre x, y and radius, mm, and whether it is drilled.
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
    def curves(self) -> tuple[OutlineCurve, ...]:
        """All curves, from the bottom layer to the top one."""
        angle = np.linspace(0.0, 360.0, self.contour.shape[1] + 1)
        made = [
            OutlineCurve(closed(self.contour), "blue", "cam contour", 1.4, fill="steel",
                         angle=angle),
            *self._openings(),
        ]  # fmt: skip
        if self.pitch is not None:
            made.append(OutlineCurve(
                closed(self.pitch), "muted", "pitch curve (roller centre)", 0.9, "dashdot",
                angle=angle,
            ))  # fmt: skip
        for k in self.radii:
            made.append(
                OutlineCurve(np.stack([np.zeros(2), self.contour[:, k]], 1), "ink", "", 0.7)
            )
            made.append(OutlineCurve(self.contour[:, k : k + 1], "ink", marker="dot"))
        cross = np.array([[-2.0, 2.0], [0.0, 0.0]])
        made += [OutlineCurve(cross, "ink", "", 0.7), OutlineCurve(cross[::-1], "ink", "", 0.7)]
        if self.follower is not None:
            label = f"{self.follower_name} {self.worst_label}"
            made.append(OutlineCurve(self.follower, "vermillion", label, 1.2))
        touch = slice(self.worst, self.worst + 1)
        made.append(OutlineCurve(self.contour[:, touch], "vermillion", marker="dot"))
        if self.pitch is not None:
            made.append(OutlineCurve(self.pitch[:, touch], "vermillion", marker="cross"))
        return tuple(made)

    def _openings(self) -> list[OutlineCurve]:
        """Bore, keyway and counter-hole; a proposed hole is dashed."""
        made = []
        if self.bore_radius is not None:
            bore = circle((0.0, 0.0), self.bore_radius)
            made.append(OutlineCurve(bore, "blue", fill="card"))
            if self.keyway is not None:
                slot = _slot(self.bore_radius, *self.keyway)
                made.append(OutlineCurve(slot, "blue", fill="card"))
        if self.counter_hole is not None:
            x, y, radius, drilled = self.counter_hole
            dash, fill = ("solid", "card") if drilled else ("dashed", "")
            made.append(OutlineCurve(circle((x, y), radius), "blue", dash=dash, fill=fill))
        return made

    @property
    def radii(self) -> tuple[int, int]:
        """Rows of the minimum and maximum radius of the contour."""
        radius = np.hypot(*self.contour)
        return int(np.argmin(radius)), int(np.argmax(radius))

    @property
    def texts(self) -> tuple[OutlineText, ...]:
        """Minimum and maximum radius, written along the radius outside the bore."""
        made = []
        for word, k in zip(("min", "max"), self.radii, strict=True):
            x, y = self.contour[:, k]
            radius = float(np.hypot(x, y))
            share = 0.5 + 0.5 * (self.bore_radius or 0.0) / radius
            turn = (np.degrees(np.arctan2(y, x)) + 90.0) % 180.0 - 90.0  # not upside down
            place = (float(share * x), float(share * y))
            made.append(OutlineText(f"{word} {radius:.4g} mm", place, float(turn)))
        return tuple(made)

    @property
    def reach(self) -> float:
        """Half the side of the square about the shaft that is shown, mm."""
        shown = [c for c in (self.contour, self.pitch, self.follower) if c is not None]
        return 1.06 * max(float(np.abs(points).max()) for points in shown)

    @property
    def alt(self) -> str:
        """Text alternative."""
        radius = np.hypot(*self.contour)
        return (
            f"{self.title}: cam contour between {radius.min():.4g} and {radius.max():.4g} mm from"
            f" the shaft, with {'' if self.pitch is None else 'pitch curve, '}bore and the"
            f" {self.follower_name} {self.worst_label}."
        )


@dataclass(frozen=True, eq=False)
class ContoursFigure:
    """Contours over each other: label and points (2, n), mm; the last one is the result."""

    id: str
    title: str
    caption: str
    contours: tuple[tuple[str, Array], ...]
    bore_radius: float | None
    texts: tuple[OutlineText, ...] = ()

    @property
    def curves(self) -> tuple[OutlineCurve, ...]:
        """All curves, from the bottom layer to the top one."""
        made = []
        if self.bore_radius is not None:
            made.append(OutlineCurve(circle((0.0, 0.0), self.bore_radius), "muted", "", 0.7))
        last = len(self.contours) - 1
        for k, (label, points) in enumerate(self.contours):
            angle = np.linspace(0.0, 360.0, points.shape[1] + 1)
            width, dash = (1.4, "solid") if k == last else (1.0, "dashed")
            made.append(OutlineCurve(closed(points), SERIES[k], label, width, dash, angle=angle))
        return tuple(made)

    @property
    def reach(self) -> float:
        """Half the side of the square about the shaft that is shown, mm."""
        return 1.06 * max(float(np.abs(points).max()) for _, points in self.contours)

    @property
    def alt(self) -> str:
        """Text alternative: range of the radius of each contour."""
        parts = []
        for label, points in self.contours:
            radius = np.hypot(*points)
            parts.append(f"{label}: {radius.min():.4g} to {radius.max():.4g} mm")
        return f"{self.title}, distance from the shaft. {'. '.join(parts)}."


def circle(centre: tuple[float, float], radius: float) -> Array:
    """Closed circle (2, n)."""
    angle = np.linspace(0.0, 2 * np.pi, _ROUND)
    return np.array(centre)[:, None] + radius * np.stack([np.cos(angle), np.sin(angle)])


def _slot(bore_radius: float, width: float, depth: float, angle: float) -> Array:
    """Sides and bottom (2, 4) of a keyway, open to the bore; angle in rad."""
    inner, outer = np.sqrt(max(bore_radius**2 - width**2 / 4, 0.0)), bore_radius + depth
    corners = np.array([[inner, outer, outer, inner], np.array([-1, -1, 1, 1]) * width / 2])
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ corners


Figure = AngleFigure | LineFigure | OutlineFigure | ContoursFigure
