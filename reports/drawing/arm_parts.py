"""Drawings of what an arm carries besides its roller or face: second arm, output and spring.

Points are in the frame of the arm, (along, outwards) from its pivot, or in that of the drawing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.rocker_lift import RockerLinkage
from camwright.reports.drawing.drawing_shapes import (
    DrawnOutline,
    Pen,
    Pose,
    ShapeGroup,
    circle,
    hatching,
    rectangle,
    segment,
)
from camwright.reports.drawing.spring_shapes import coil_strands, drawn_wire

_EDGE = 0.35  # mm, of a drawn part
PIN_SHARE, PLATE_SHARE, _EYE_SHARE = (
    0.13,
    0.1,
    0.6,
)  # over the diameter of a spring: pin, seat, eye to its coils
_ROD_SHARE, _WALL_SHARE = 0.45, 0.1  # of the bore of a gas spring
_HEAD_SHARE, _STEM_SHARE = (
    1.4,
    0.5,
)  # half widths of the head and stem of an output over the pad of its arm


@dataclass(frozen=True)
class SecondArm:
    """Second arm of a rocker, with a round pad on the flat end of its output; mm and rad.

    Parameters
    ----------
    length : float             pivot to the middle of the pad
    side : float               of the pivot: 1 that of the first arm, -1 the other
    raised : float             angle at zero lift from square to the line of the output
    pad, rod : float           radius of the pad; length of the output that is drawn
    linkage : RockerLinkage    of both arms, mm
    """

    length: float
    side: float
    raised: float
    pad: float
    rod: float
    linkage: RockerLinkage

    @property
    def end(self) -> Array:
        """Middle of the pad (2,) in the frame of the arm."""
        return np.array([self.side * self.length, 0.0])

    @property
    def line(self) -> Array:
        """Direction (2,) in which the output moves, in the frame of the arm at zero lift."""
        return self.side * np.array([np.sin(self.raised), np.cos(self.raised)])

    def flat(self, lift: float) -> Array:
        """Middle of the flat end of the output (2,) in the frame of the arm at zero lift."""
        opened = float(self.linkage.opening(np.array(lift)))
        return np.asarray(self.end + (self.pad + self.linkage.lash + opened) * self.line)

    @property
    def head(self) -> float:
        """Thickness of the head of the output, mm."""
        return 0.6 * self.pad

    def output(self) -> tuple[DrawnOutline, ...]:
        """Outlines of stem and head of the output, its flat end at the origin and its stem along
        +y, mm.
        """
        edge, wide, thin = (
            Pen("ink", _EDGE, "steel"),
            _HEAD_SHARE * self.pad,
            _STEM_SHARE * self.pad,
        )
        stem = rectangle(-thin, self.head, thin, self.rod)
        head = rectangle(-wide, 0.0, wide, self.head)
        return DrawnOutline((stem,), edge), DrawnOutline((head,), edge)


class BetweenEnds(Protocol):
    """Spring drawn between its two ends, mm."""

    @property
    def half(self) -> float: ...
    def groups(self, moving: Array, fixed: Array) -> tuple[ShapeGroup, ...]: ...


@dataclass(frozen=True)
class LinkCoil:
    """Coil spring; mm. ends: "eyes" on pins where it pulls, "pins" with seats where it pushes,
    "seats" alone on an output.
    """

    wire: float
    diameter: float
    turns: float
    ends: Literal["eyes", "pins", "seats"]

    @property
    def half(self) -> float:
        """Half of the outer diameter, mm."""
        return 0.5 * (self.diameter + self.wire)

    @property
    def fitting(self) -> float:
        """Distance of the first coil from the pin, mm."""
        return (_EYE_SHARE if self.ends == "eyes" else PIN_SHARE) * self.diameter

    def groups(self, moving: Array, fixed: Array) -> tuple[ShapeGroup, ...]:
        """Groups of shapes from back to front: coils behind, coils before, moving and fixed
        fitting.

        Parameters
        ----------
        moving, fixed : array (2,)   ends of the spring in the drawing, mm
        """
        turn, away = _direction(moving, fixed)
        fitting = min(self.fitting, 0.25 * away)
        behind, before = coil_strands(self.diameter, self.turns)
        start = moving + fitting * (fixed - moving) / away
        pose = Pose(turn, _pair(start), away - 2.0 * fitting)
        ends = (("link-end", turn, moving), ("link-anchor", turn + np.pi, fixed))
        return (
            ShapeGroup("link-behind", drawn_wire(behind, self.wire, "muted"), pose),
            ShapeGroup("link-before", drawn_wire(before, self.wire, "steel"), pose),
            *(ShapeGroup(n, self._fitting(fitting), Pose(t, _pair(at))) for n, t, at in ends),
        )

    def _fitting(self, length: float) -> tuple[DrawnOutline, ...]:
        """Pin at the origin with the eye, or with the seat, of the coils along +y; the seat alone
        of a spring on an output.

        Parameters
        ----------
        length : float   from the pin to the first coil, mm
        """
        pin = DrawnOutline((circle(PIN_SHARE * self.diameter),), Pen("ink", _EDGE, "card"))
        if self.ends != "eyes":
            seat = rectangle(-self.half, length - PLATE_SHARE * self.diameter, self.half, length)
            plate = DrawnOutline((seat,), Pen("ink", _EDGE, "steel"))
            return (plate,) if self.ends == "seats" else (plate, pin)
        strand = segment((0.0, PIN_SHARE * self.diameter), (0.0, length))
        return *drawn_wire([strand], self.wire, "steel"), pin


@dataclass(frozen=True)
class LinkGas:
    """Gas spring between pins, its rod on the arm and its cylinder on the fixed end; mm."""

    bore: float
    body: float
    rod: float

    @property
    def half(self) -> float:
        """Half of the outer diameter, mm."""
        return (0.5 + _WALL_SHARE) * self.bore

    def groups(self, moving: Array, fixed: Array) -> tuple[ShapeGroup, ...]:
        """Groups of shapes from back to front: cylinder on the fixed end, rod on the moving one.

        Parameters
        ----------
        moving, fixed : array (2,)   ends of the spring in the drawing, mm
        """
        turn, _ = _direction(moving, fixed)
        wall, thin = _WALL_SHARE * self.bore, 0.5 * _ROD_SHARE * self.bore
        half, edge = 0.5 * self.bore, Pen("ink", _EDGE, "steel")
        card, pin = Pen("ink", _EDGE, "card"), circle(2.0 * PIN_SHARE * self.bore)
        body = (
            DrawnOutline((rectangle(-half - wall, 0.0, half + wall, self.body),), edge),
            DrawnOutline((rectangle(-half, wall, half, self.body - wall),), card),
            DrawnOutline((pin,), card),
        )
        rod = (
            DrawnOutline((rectangle(-thin, 0.0, thin, self.rod - wall),), edge),
            DrawnOutline(
                (rectangle(-half, self.rod - wall, half, self.rod),), Pen("ink", _EDGE, "muted")
            ),
            DrawnOutline((pin,), card),
        )
        return (
            ShapeGroup("link-anchor", body, Pose(turn + np.pi, _pair(fixed))),
            ShapeGroup("link-end", rod, Pose(turn, _pair(moving))),
        )


@dataclass(frozen=True)
class ArmSpring:
    """Spring of an arm; its ends by distance from the pivot and angle from the arm at zero lift,
    positive outwards, mm and rad; arm_end None: on the output of the second arm, fixed at a
    distance, mm, from its head at zero lift.
    """

    shape: BetweenEnds
    arm_end: tuple[float, float] | None
    fixed: tuple[float, float] = (0.0, 0.0)
    distance: float = 0.0


def polar(radius: float, angle: float) -> Array:
    """Point (2,), along the arm and outwards."""
    return radius * np.array([np.cos(angle), np.sin(angle)])


def ground(wide: float, spacing: float, width: float) -> tuple[DrawnOutline, ...]:
    """Hatched ground behind a fixed end at the origin, towards -y; its half width, mm."""
    box = (-wide, -0.9 * wide, wide, -0.4 * wide)
    edge = segment((-wide, -0.4 * wide), (wide, -0.4 * wide))
    return (
        DrawnOutline(hatching(box, spacing), Pen("muted", 0.5 * width), closed=False),
        DrawnOutline((edge,), Pen("ink", width), closed=False),
    )


def _direction(moving: Array, fixed: Array) -> tuple[float, float]:
    """Counter-clockwise turn from y of the line from the moving to the fixed end, rad, and its
    length, mm.
    """
    x, y = fixed - moving
    return float(np.arctan2(-x, y)), float(np.hypot(x, y))


def _pair(point: Array) -> tuple[float, float]:
    return float(point[0]), float(point[1])
