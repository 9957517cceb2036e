"""Drawing of the second roller or face that pulls the follower back, with its arm or frame, and of
the second disc.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.drawing.drawing_shapes import (
    DrawnOutline,
    Pen,
    Pose,
    Shape,
    ShapeGroup,
    circle,
    rectangle,
)

SLOT, SLOT_SIDE, PAST, FRAME_BAR = 1.15, 0.55, 0.65, 0.6
"""Over bore, stem or roller: slot, plate beside it and past the roller centre, bar of a frame."""
_HALF_ROUND = 25  # points of half a circle


@dataclass(frozen=True, eq=False)
class DrawnSecond:
    """Second roller or face of a follower, fixed to the first; mm.

    Parameters
    ----------
    centre : array (2,)   of the roller or face from the origin of the drawn follower: roller or
                          face of a stem, pivot of an arm
    radius : float        of the roller; None: a face
    disc : array (2, n)   its disc in the frame of the cam; None: the first disc, between two faces
    spacing : float       of its disc from the first along the shaft
    """

    centre: Array
    radius: float | None
    disc: Array | None
    spacing: float

    @property
    def words(self) -> str:
        """Second track in words, for the alternative text."""
        if self.disc is None:
            return "second face of the yoke"
        return f"second disc {self.spacing:.4g} mm beside the first with its roller"

    def reach(self, centre: Array) -> tuple[float, float, float, float]:
        """Left, right, bottom and top of the roller with its centre (2, ...) in the drawing."""
        radius, (x, y) = self.radius or 0.0, centre
        ends = (x.min() - radius, x.max() + radius, y.min() - radius, y.max() + radius)
        return ends[0], ends[1], ends[2], ends[3]

    def roller(self, pin: float, edge: Pen) -> tuple[Shape, ...]:
        """Roller with its pin; nothing of a face."""
        if self.radius is None:
            return ()
        at = float(self.centre[0]), float(self.centre[1])
        hole = min(pin, 0.8 * self.radius)
        rim = circle(self.radius, at), circle(hole, at)
        return (
            DrawnOutline(rim, Pen("ink", edge.width, "card")),
            DrawnOutline((circle(hole, at),), edge),
        )

    def arm(self, half: float, edge: Pen) -> tuple[Shape, ...]:
        """Bar from the pivot to the roller; half: of its depth."""
        x, y = self.centre
        aside = half * np.array([-y, x]) / np.hypot(x, y)
        ends = np.stack([aside, self.centre + aside, self.centre - aside, -aside], axis=1)
        return (DrawnOutline((ends,), edge),)

    def plate(self, lifts: tuple[float, float], bore: float, stem: float, edge: Pen) -> Shape:
        """Plate of a stem that joins both rollers, with a slot around the camshaft.

        Parameters
        ----------
        lifts : tuple   least and greatest height of the first roller over the cam axis, mm
        bore : float    radius of the shaft, mm
        stem : float    diameter of the stem, mm
        """
        slot, foot = SLOT * bore, float(self.centre[1])
        half, turn = slot + SLOT_SIDE * stem, np.linspace(0.0, np.pi, _HALF_ROUND)
        past = PAST * (self.radius or stem)
        around = slot * np.stack([np.cos(turn), np.sin(turn)])
        low, high = -lifts[1], -lifts[0]
        ends = (around + np.array([[0.0], [high]]), np.array([[0.0], [low]]) - around)
        hole = np.hstack(ends)
        outside = rectangle(-half, foot - past, half, past)
        return DrawnOutline((outside, hole), Pen("ink", edge.width, "shade"))

    def frame(self, face: tuple[float, float], room: float, stem: float, edge: Pen) -> Shape:
        """Frame of a yoke that joins both faces around the cam.

        Parameters
        ----------
        face : tuple    width and thickness of a face, mm
        room : float    half of the opening, mm
        """
        wide, thick = face
        foot, half = float(self.centre[1]), max(room, 0.5 * wide)
        outside = half + FRAME_BAR * stem
        opening = rectangle(-half, foot, half, 0.0)
        frame = rectangle(-outside, foot - thick, outside, thick)
        return DrawnOutline((frame, opening), edge)

    def behind(self, turn: float, holes: list[Array], edge: Pen) -> tuple[ShapeGroup, ...]:
        """Group of the second disc behind the first, turned by an angle, rad; none without it."""
        if self.disc is None:
            return ()
        drawn = DrawnOutline((self.disc, *holes), Pen("ink", edge.width, "shade"))
        return (ShapeGroup("second-cam", (drawn,), Pose(turn)),)

    def hidden(self, turn: float, edge: Pen) -> tuple[ShapeGroup, ...]:
        """Group of the edge of the second disc, dashed over the first; none without it."""
        if self.disc is None:
            return ()
        pen = Pen("muted", 0.6 * edge.width, dash="dashed")
        return (ShapeGroup("hidden", (DrawnOutline((self.disc,), pen),), Pose(turn)),)
