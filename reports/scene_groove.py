"""Solids of the 3-D scene of a disc with a groove in its face, and of the follower before it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import Json
from camwright.reports.drawing.arrangement import DrawnGroove, DrawnStep
from camwright.reports.scene_solids import Solid, box, joined, pin, ring, rod, tube
from camwright.reports.sheet_turn import SheetTurn

_MARK = 0.05  # half of the width of a mark over the radius, and its height over half of the width
_ROLLER_GREY, _MARK_GREY = "#e3e8ed", "#444c55"
_CHEEK = 0.35  # of the width of the roller, where the case states no cheek


class SceneRoller(NamedTuple):
    """Second roller on the pin: radius, and its middle above that of the first; mm."""

    radius: float
    height: float


@dataclass(frozen=True, eq=False)
class SceneGroove:
    """Places along the shaft in the scene, whose origin is the middle of the first roller; mm.

    groove; inner, outer : walls (2, n) at equal cam angles, on which rollers run; bore (2, n)
    face : open face of the disc; width of the disc
    roller : width; cheek : middle and width of the cheek that holds the pin, before the face
    steps : from the face down; second : roller on the pin of the first, if any
    """

    groove: DrawnGroove
    inner: Array
    outer: Array
    bore: Array
    face: float
    width: float
    roller: float
    cheek: tuple[float, float]
    steps: tuple[DrawnStep, ...]
    second: SceneRoller | None = None

    @property
    def middle(self) -> float:
        """Middle of the disc."""
        return self.face - 0.5 * self.width

    def _wall(self, step: DrawnStep, wall: Array) -> Solid:
        height = self.face - 0.5 * (step.top + step.bottom)
        return ring(wall, step.bottom - step.top).deeper(height)

    def walls(self) -> Solid:
        """Both walls on which rollers run: the inner one, then the outer one."""
        every = [(step.carries[k], self._wall(step, step.walls[k])) for k in (0, 1)
                 for step in self.steps]  # fmt: skip
        return joined(tuple(wall for carries, wall in every if carries))

    def disc(self) -> Solid:
        """Faces, floor of the groove with its ledges and other walls, and edge of the disc."""
        edge = self.groove.radius * self.outer / np.hypot(*self.outer)
        back = self.groove.radius * self.bore / np.hypot(*self.bore)
        first, last = self.steps[0], self.steps[-1]
        ledges = [
            tube(*pair, self.face - lower.top)
            for upper, lower in pairwise(self.steps)
            for pair in ((upper.outer, lower.outer), (lower.inner, upper.inner))
        ]
        relieved = [
            self._wall(step, step.walls[k])
            for step in self.steps for k in (0, 1) if not step.carries[k]
        ]  # fmt: skip
        return joined(
            (
                tube(edge, first.outer, self.face),
                tube(last.outer, last.inner, self.face - last.bottom),
                tube(first.inner, self.bore, self.face),
                tube(back, self.bore, self.face - self.width),
                ring(edge, self.width).deeper(self.middle),
                *ledges,
                *relieved,
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
        lowest = -0.5 * self.roller
        if self.second is not None:
            lowest = min(lowest, self.second.height - 0.5 * self.roller)
        reach = 0.5 * (cheek_at + 0.5 * wide - lowest)
        axle = pin(radius, reach).deeper(reach + lowest)
        return joined((plate, axle, rod(stem, bridge, top).deeper(cheek_at)))

    def moving(self, angle: Array, centre: Array, digits: int) -> list[Json]:
        """Records of the second roller with a mark, see `scene_arm.moving`, as it rolls on the
        outer wall without slip all the turn; [] without one.

        Parameters
        ----------
        angle : array (f,)       cam angles, deg
        centre : array (2, f)    of the rollers in the frame of the guides, mm
        """
        second, wall = self.second, self.outer
        if second is None:
            return []
        chords = np.hypot(*np.diff(wall, axis=1, append=wall[:, :1]))
        along = np.r_[0.0, np.cumsum(chords)]
        turned = -np.interp(angle, np.linspace(0.0, 360.0, along.size), along) / second.radius
        half, radius = 0.5 * self.roller, second.radius
        mark = box(
            (-_MARK * radius, 0.5 * radius, -(1.0 + _MARK) * half),
            (_MARK * radius, 0.95 * radius, (1.0 + _MARK) * half),
        )
        bodies = (pin(radius, half), _ROLLER_GREY), (mark, _MARK_GREY)
        return [
            {
                "body": solid.deeper(second.height).as_record(digits), "colour": colour,
                "plain": False, "turn": [round(float(each), digits) for each in turned],
                "x": [round(float(each), digits) for each in centre[0]],
                "y": [round(float(each), digits) for each in centre[1]],
                "stretch": [1.0] * angle.size,
            } for solid, colour in bodies
        ]  # fmt: skip


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
    outer = _at_stations(turn, groove.wall, inner.shape[1])
    corner = turn.length("cam", "groove", "corner_radius") or 0.0
    roller = min(turn.length("roller", "width") or groove.depth, groove.depth - corner)
    face, second = groove.depth - corner - 0.5 * roller, _second(turn)
    steps = tuple(
        each._replace(
            inner=inner if each.carries[0] else _at_stations(turn, each.inner, inner.shape[1]),
            outer=_at_stations(turn, each.outer, inner.shape[1]),
        )
        for each in groove.steps
    )
    if second is not None:
        face -= max(-second.height, 0.0)
    wide = turn.length("roller", "fork", "cheek_width") or _CHEEK * roller
    span = turn.length("roller", "pin", "span")
    cheek_at = max(face, 0.5 * roller) + 0.6 * wide if span is None else span
    return SceneGroove(
        groove, inner, outer, bore, face, width, roller, (cheek_at, wide), steps, second
    )


def _at_stations(turn: SheetTurn, wall: Array, count: int) -> Array:
    """Wall (2, n) of the contour table at equal cam angles (2, count), mm."""
    angle = np.linspace(0.0, 360.0, count, endpoint=False)
    return np.stack(
        [np.interp(angle, turn.contour["cam_angle_deg"], each, period=360.0) for each in wall]
    )


def _second(turn: SheetTurn) -> SceneRoller | None:
    """Second roller on the pin: deeper in the groove than the first unless it is larger; None
    without one.
    """
    radius, spacing, first = (
        turn.length(*path) for path in (
            ("cam", "groove", "second", "radius"), ("cam", "groove", "second", "spacing"),
            ("roller", "radius"))
    )  # fmt: skip
    if radius is None or spacing is None or first is None:
        return None
    return SceneRoller(radius, spacing if radius > first else -spacing)
