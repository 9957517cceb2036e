"""Outlines of a cam in the direction of its shaft, mm: curves, text, title and caption."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.figures import SERIES, Figure, closed

X_AXIS, Y_AXIS = "x, mm (cam angle 0 points along x)", "y, mm"
_CIRCLE_POINTS = 121  # points of a circle


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
    centre x, y and radius, mm, and whether it is drilled; `groove` outer wall (2, n) and radius of
    the disc, mm. `touches` is the point of contact, of the contour where None. `second` is the
    contour of a second disc, `centre` the roller centre, of the pitch curve where None.
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
    groove: tuple[Array, float] | None = None
    touches: Array | None = None
    second: Array | None = None
    centre: Array | None = None

    @property
    def _disc(self) -> list[OutlineCurve]:
        """Edge of a disc with a groove, and the outer wall of the groove, whose inner wall is the
        contour; [] without a groove.
        """
        if self.groove is None:
            return []
        wall, radius = self.groove
        return [
            OutlineCurve(circle((0.0, 0.0), radius), "blue", "", 1.4, fill="steel"),
            OutlineCurve(closed(wall), "blue", "outer wall", 1.4, fill="card"),
        ]

    @property
    def curves(self) -> tuple[OutlineCurve, ...]:
        """All curves, from the bottom layer to the top one."""
        angle = np.linspace(0.0, 360.0, self.contour.shape[1] + 1)
        name = "cam contour" if self.groove is None else "inner wall"
        curves = [
            *self._disc,
            OutlineCurve(closed(self.contour), "blue", name, 1.4, fill="steel", angle=angle),
            *self._openings(),
        ]  # fmt: skip
        if self.second is not None:
            curves.append(OutlineCurve(closed(self.second), "green", "second disc", 1.2, "dashed"))
        if self.pitch is not None:
            curves.append(OutlineCurve(
                closed(self.pitch), "muted", "pitch curve (roller centre)", 0.9, "dashdot",
                angle=angle,
            ))  # fmt: skip
        for k in self.radii:
            curves.append(
                OutlineCurve(np.stack([np.zeros(2), self.contour[:, k]], 1), "ink", "", 0.7)
            )
            curves.append(OutlineCurve(self.contour[:, k : k + 1], "ink", marker="dot"))
        cross = np.array([[-2.0, 2.0], [0.0, 0.0]])
        curves += [OutlineCurve(cross, "ink", "", 0.7), OutlineCurve(cross[::-1], "ink", "", 0.7)]
        if self.follower is not None:
            label = f"{self.follower_name} {self.worst_label}"
            curves.append(OutlineCurve(self.follower, "vermillion", label, 1.2))
        touch = slice(self.worst, self.worst + 1)
        contact = self.contour[:, touch] if self.touches is None else self.touches[:, None]
        curves.append(OutlineCurve(contact, "vermillion", marker="dot"))
        if self.pitch is not None:
            centre = self.pitch[:, touch] if self.centre is None else self.centre[:, None]
            curves.append(OutlineCurve(centre, "vermillion", marker="cross"))
        return tuple(curves)

    def _openings(self) -> list[OutlineCurve]:
        """Outlines of bore, keyway and counter-hole; a proposed hole, not drilled yet,
        is dashed.
        """
        curves = []
        if self.bore_radius is not None:
            bore = circle((0.0, 0.0), self.bore_radius)
            curves.append(OutlineCurve(bore, "blue", fill="card"))
            if self.keyway is not None:
                slot = _slot(self.bore_radius, *self.keyway)
                curves.append(OutlineCurve(slot, "blue", fill="card"))
        if self.counter_hole is not None:
            x, y, radius, drilled = self.counter_hole
            dash, fill = ("solid", "card") if drilled else ("dashed", "")
            curves.append(OutlineCurve(circle((x, y), radius), "blue", dash=dash, fill=fill))
        return curves

    @property
    def radii(self) -> tuple[int, int]:
        """Rows of the minimum and maximum radius of the contour."""
        radius = np.hypot(*self.contour)
        return int(np.argmin(radius)), int(np.argmax(radius))

    @property
    def texts(self) -> tuple[OutlineText, ...]:
        """Minimum and maximum radius, written along the radius outside the bore."""
        texts = []
        for word, k in zip(("min", "max"), self.radii, strict=True):
            x, y = self.contour[:, k]
            radius = float(np.hypot(x, y))
            share = 0.5 + 0.5 * (self.bore_radius or 0.0) / radius
            turn = (np.degrees(np.arctan2(y, x)) + 90.0) % 180.0 - 90.0  # not upside down
            position = (float(share * x), float(share * y))
            texts.append(OutlineText(f"{word} {radius:.4g} mm", position, float(turn)))
        return tuple(texts)

    @property
    def reach(self) -> float:
        """Half the side of the square about the shaft that is shown, mm."""
        all_curves = (self.contour, self.pitch, self.follower, self.second)
        shown = [c for c in all_curves if c is not None]
        disc = 0.0 if self.groove is None else self.groove[1]
        return 1.06 * max(disc, *(float(np.abs(points).max()) for points in shown))

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
        curves = []
        if self.bore_radius is not None:
            curves.append(OutlineCurve(circle((0.0, 0.0), self.bore_radius), "muted", "", 0.7))
        last = len(self.contours) - 1
        for k, (label, points) in enumerate(self.contours):
            angle = np.linspace(0.0, 360.0, points.shape[1] + 1)
            width, dash = (1.4, "solid") if k == last else (1.0, "dashed")
            curves.append(OutlineCurve(closed(points), SERIES[k], label, width, dash, angle=angle))
        return tuple(curves)

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
    angle = np.linspace(0.0, 2 * np.pi, _CIRCLE_POINTS)
    return np.array(centre)[:, None] + radius * np.stack([np.cos(angle), np.sin(angle)])


def _slot(bore_radius: float, width: float, depth: float, angle: float) -> Array:
    """Open line (2, 4) of a keyway: side, bottom and other side, from the bore outwards; lengths in
    mm, angle of its middle in rad.
    """
    inner, outer = np.sqrt(max(bore_radius**2 - width**2 / 4, 0.0)), bore_radius + depth
    corners = np.array([[inner, outer, outer, inner], np.array([-1, -1, 1, 1]) * width / 2])
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ corners


SheetFigure = Figure | OutlineFigure | ContoursFigure
"""A figure of the analysis sheet."""
