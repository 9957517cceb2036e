"""Solids of the 3-D scene of a disc with a groove in its face, and of the follower before it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.drawing.arrangement import DrawnGroove
from camwright.reports.scene_solids import Solid, box, joined, pin, ring, rod, tube
from camwright.reports.sheet_turn import SheetTurn

_CHEEK = 0.35  # of the width of the roller, where the case states no cheek


@dataclass(frozen=True, eq=False)
class SceneGroove:
    """Places along the shaft in the scene, whose origin is the middle of the roller; mm.

    groove; inner, outer : walls (2, n) at equal cam angles; bore (2, n)
    face : open face of the disc; width of the disc
    roller : width; cheek : middle and width of the cheek that holds the pin, before the face
    """

    groove: DrawnGroove
    inner: Array
    outer: Array
    bore: Array
    face: float
    width: float
    roller: float
    cheek: tuple[float, float]

    @property
    def middle(self) -> float:
        """Middle of the disc."""
        return self.face - 0.5 * self.width

    @property
    def floor(self) -> float:
        """Floor of the groove."""
        return self.face - self.groove.depth

    def walls(self) -> Solid:
        """Both walls: the inner one, then the outer one."""
        height = 0.5 * (self.face + self.floor)
        both = (ring(wall, self.groove.depth).deeper(height) for wall in (self.inner, self.outer))
        return joined(tuple(both))

    def disc(self) -> Solid:
        """Faces, floor of the groove and edge of the disc."""
        edge = self.groove.radius * self.outer / np.hypot(*self.outer)
        back = self.groove.radius * self.bore / np.hypot(*self.bore)
        return joined(
            (
                tube(edge, self.outer, self.face),
                tube(self.outer, self.inner, self.floor),
                tube(self.inner, self.bore, self.face),
                tube(back, self.bore, self.face - self.width),
                ring(edge, self.width).deeper(self.middle),
            )
        )

    def hole(self) -> Solid:
        """Wall of the bore."""
        return ring(self.bore, self.width).deeper(self.middle)

    def follower(self, stem: float, top: float, radius: float) -> Solid:
        """Stem with the cheek that holds the pin of the roller on one side, about the roller
        centre, mm.

        Parameters
        ----------
        stem : float     diameter of the stem
        top : float      height of the end of the stem
        radius : float   of the pin
        """
        cheek_at, wide = self.cheek
        half, bridge = 0.5 * stem, 2.0 * radius
        plate = box((-half, -bridge, cheek_at - 0.5 * wide), (half, bridge, cheek_at + 0.5 * wide))
        reach = 0.5 * (cheek_at + 0.5 * wide + 0.5 * self.roller)
        axle = pin(radius, reach).deeper(reach - 0.5 * self.roller)
        return joined((plate, axle, rod(stem, bridge, top).deeper(cheek_at)))


def scene_groove(
    turn: SheetTurn, groove: DrawnGroove, inner: Array, bore: Array, width: float
) -> SceneGroove:
    """Places of a disc with its groove, of the roller and of the cheek along the shaft, mm.

    Parameters
    ----------
    groove : DrawnGroove   with the outer wall
    inner : array (2, n)   inner wall, at equal cam angles
    bore : array (2, n)    at equal cam angles
    width : float          of the disc
    """
    stations = np.linspace(0.0, 360.0, inner.shape[1], endpoint=False)
    angle = turn.contour["cam_angle_deg"]
    outer = np.stack([np.interp(stations, angle, each, period=360.0) for each in groove.wall])
    corner = turn.length("cam", "groove", "corner_radius") or 0.0
    roller = min(turn.length("roller", "width") or groove.depth, groove.depth - corner)
    face = groove.depth - corner - 0.5 * roller
    wide = turn.length("roller", "fork", "cheek_width") or _CHEEK * roller
    span = turn.length("roller", "pin", "span")
    cheek_at = max(face, 0.5 * roller) + 0.6 * wide if span is None else span
    return SceneGroove(groove, inner, outer, bore, face, width, roller, (cheek_at, wide))
