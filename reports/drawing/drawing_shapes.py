"""Shapes of a line drawing: outlines, arrows and texts in groups with poses; mm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, rotation

HEAD = 3.4
"""Length of an arrow head over the width of its shaft."""
GLYPH = 0.6
"""Greatest mean width of a character over the height of a text."""
_ROUND = 97  # points of a circle


@dataclass(frozen=True)
class Pen:
    """Line style: colours by name, empty for none; width, mm; solid, dashed or dashdot."""

    stroke: str = ""
    width: float = 0.0
    fill: str = ""
    dash: str = "solid"


@dataclass(frozen=True, eq=False)
class DrawnOutline:
    """Lines (2, n), mm; those after a closed first one are its holes."""

    lines: tuple[Array, ...]
    pen: Pen
    closed: bool = True


@dataclass(frozen=True)
class Arrow:
    """Arrow from tail to tip, mm; omitted if shorter than its head."""

    name: str
    tail: tuple[float, float]
    tip: tuple[float, float]
    colour: str
    width: float

    @property
    def head(self) -> float:
        """Length of the head, mm."""
        return HEAD * self.width


@dataclass(frozen=True)
class Text:
    """Text on its baseline; align: start, middle or end; name: of a changing value."""

    words: str
    place: tuple[float, float]
    height: float
    colour: str = "ink"
    align: str = "start"
    bold: bool = False
    name: str = ""

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top, mm; the width is an upper bound."""
        x, y = self.place
        width = GLYPH * self.height * len(self.words)
        left = x - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.align] * width
        return left, y - 0.25 * self.height, left + width, y + 0.8 * self.height


Shape = DrawnOutline | Arrow | Text


@dataclass(frozen=True)
class Pose:
    """Pose of a group: stretch along y, then rotation (rad), then translation (mm)."""

    turn: float = 0.0
    shift: tuple[float, float] = (0.0, 0.0)
    stretch: float = 1.0

    def of(self, points: Array) -> Array:
        """Points (2, n) of the group in the drawing."""
        stretched = points * np.array([[1.0], [self.stretch]])
        return np.asarray(rotation(self.turn) @ stretched + np.array(self.shift)[:, None])


@dataclass(frozen=True, eq=False)
class ShapeGroup:
    """Shapes with a common pose, from bottom to top layer."""

    name: str
    shapes: tuple[Shape, ...]
    pose: Pose = Pose()


@dataclass(frozen=True, eq=False)
class Drawing:
    """Groups of shapes from bottom to top layer, with the bounding box, mm."""

    title: str
    alt: str
    groups: tuple[ShapeGroup, ...]
    box: tuple[float, float, float, float]

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, mm."""
        left, bottom, right, top = self.box
        return right - left, top - bottom

    def texts(self) -> Iterator[Text]:
        """All texts of groups that do not move."""
        for group in self.groups:
            if group.pose == Pose():
                yield from (shape for shape in group.shapes if isinstance(shape, Text))


def circle(radius: float, centre: tuple[float, float] = (0.0, 0.0)) -> Array:
    """Circle (2, n) without a repeated end point."""
    angle = np.linspace(0.0, 2.0 * np.pi, _ROUND)[:-1]
    return np.array(centre)[:, None] + radius * np.stack([np.cos(angle), np.sin(angle)])


def rectangle(left: float, bottom: float, right: float, top: float) -> Array:
    """Corners (2, 4) of a rectangle, counter-clockwise, mm."""
    return np.array([[left, right, right, left], [bottom, bottom, top, top]], dtype=float)


def segment(start: tuple[float, float], end: tuple[float, float]) -> Array:
    """Line from start to end as two points (2, 2), mm."""
    return np.array([start, end], dtype=float).T


def hatching(box: tuple[float, float, float, float], spacing: float) -> tuple[Array, ...]:
    """Lines at 45 deg, each (2, 2), that fill a rectangle (left, bottom, right, top) at a spacing,
    mm: the sign of a fixed part.
    """
    left, bottom, right, top = box
    lines = []
    for cross in np.arange(left - (top - bottom) + 0.5 * spacing, right, spacing):
        start, end = max(cross, left), min(cross + top - bottom, right)
        if end > start:
            lines.append(segment((start, bottom + start - cross), (end, bottom + end - cross)))
    return tuple(lines)


def bore_outline(radius: float, keyway: tuple[float, float, float] | None) -> Array:
    """Bore with keyway (2, n) about the origin as one closed line, mm.

    Parameters
    ----------
    radius : float           of the bore, mm
    keyway : tuple or None   width and depth beyond the bore, mm, and angle of its middle, rad
    """
    if keyway is None:
        return circle(radius)
    width, depth, angle = keyway
    half = np.arcsin(min(0.5 * width / radius, 1.0))
    around = np.linspace(half, 2.0 * np.pi - half, _ROUND)
    arc = radius * np.stack([np.cos(around), np.sin(around)])
    floor = np.array([[radius + depth] * 2, [-0.5 * width, 0.5 * width]])
    return np.asarray(rotation(angle) @ np.hstack([arc, floor]))
