"""Drawings of coil, gas and torsion springs between their seats."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import cycle, pairwise
from math import asin, cos, pi, sin, sqrt
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np

from camwright.geometry.arrays import Array
from camwright.reports.drawing.drawing_shapes import (
    DrawnOutline,
    Pen,
    Pose,
    ShapeGroup,
    circle,
    rectangle,
    segment,
)

_EDGE = 0.35  # mm, of a drawn part
_WIRE_EDGE = 0.06  # of the wire
_ROD_SHARE, _WALL_SHARE = 0.45, 0.1  # of the bore of a gas spring


class CaseLengths(Protocol):
    """Lengths that a case states, such as those of a `SheetTurn`."""

    def length(self, *keys: str, unit: str = "mm") -> float | None:
        """Length at a key in a unit; None where it is not stated."""
        ...


class SpringPlaces(NamedTuple):
    """Heights at zero lift where a spring can stand, stroke and diameter of the stem, mm.

    between: on the stem above guide A; end: on the end of the stem
    """

    between: float
    end: float
    stroke: float
    stem: float


def coil_strands(diameter: float, turns: float) -> tuple[list[Array], list[Array]]:
    """Half coils as straight segments (2, 2), those on the far side and those on the near side; x
    in mm, y from 0 to 1.

    Parameters
    ----------
    diameter : float   of the coils, mm
    turns : float      number of all coils
    """
    count = max(round(turns), 2)
    half = 0.5 * diameter
    steps = np.linspace(0.0, 1.0, 2 * count + 1)
    strands = [
        segment((side * half, low), (-side * half, high))
        for side, (low, high) in zip(cycle((-1.0, 1.0)), pairwise(steps), strict=False)
    ]
    return strands[1::2], strands[::2]


def drawn_wire(strands: list[Array], wire: float, fill: str) -> tuple[DrawnOutline, ...]:
    """Outlines of a wire, mm, along given strands: a dark line and a narrower one of colour `fill`
    on it.
    """
    widths = (("ink", wire), (fill, (1.0 - 2.0 * _WIRE_EDGE) * wire))
    return tuple(
        DrawnOutline((strand,), Pen(stroke, width), closed=False)
        for strand in strands
        for stroke, width in widths
    )


@dataclass(frozen=True)
class Coil:
    """Helical spring between the seat on the follower and the fixed seat above; mm.

    seat : height of the moving seat at zero lift; length : between the seats at zero lift;
    turns : all coils
    """

    wire: float
    diameter: float
    turns: float
    seat: float
    length: float

    @property
    def reach(self) -> float:
        """Half of the outer diameter, mm."""
        return 0.5 * (self.diameter + self.wire)

    @property
    def top(self) -> float:
        """Height of the fixed seat, mm."""
        return self.seat + self.length

    def groups(
        self, axis: float, lift: float
    ) -> tuple[tuple[ShapeGroup, ...], tuple[ShapeGroup, ...]]:
        """Groups of shapes behind and before the stem at a lift, on a follower axis at x = `axis`,
        mm.
        """
        pose = self.pose(axis, lift)
        behind, before = coil_strands(self.diameter, self.turns)
        return (
            (ShapeGroup("spring-behind", drawn_wire(behind, self.wire, "muted"), pose),),
            (ShapeGroup("spring-before", drawn_wire(before, self.wire, "steel"), pose),),
        )

    def pose(self, axis: float, lift: float) -> Pose:
        """Place of the coils, which reach from 0 to 1 along y."""
        inside = max(self.length - lift - self.wire, 0.0)
        return Pose(shift=(axis, self.seat + lift + 0.5 * self.wire), stretch=inside)


@dataclass(frozen=True)
class DrawnGasSpring:
    """Gas spring: rod on the seat of the follower, cylinder held above; mm."""

    bore: float
    seat: float
    stroke: float
    body: float

    @classmethod
    def of(cls, area: float, volume: float, seat: float, stroke: float) -> DrawnGasSpring:
        """From the area of the piston, mm2, and the volume of the gas, mm3."""
        bore = 2.0 * sqrt(area / pi)
        inside = min(max(volume / area, 1.2 * stroke), 4.0 * stroke)
        return cls(bore, seat, stroke, inside + 4.0 * _WALL_SHARE * bore)

    @classmethod
    def drawn(cls, case: CaseLengths, at: SpringPlaces) -> DrawnGasSpring:
        """Gas spring of the case on the end of the stem; area and volume that the case does not
        state are scaled from stem and stroke.

        Parameters
        ----------
        at : SpringPlaces   heights where it can stand, stroke, diameter of the stem, mm
        """
        area = case.length("spring", "gas", "area", unit="mm^2") or at.stem**2
        volume = case.length("spring", "gas", "volume", unit="cm^3")
        held = at.stroke * area if volume is None else 1e3 * volume
        return cls.of(area, held, at.end, at.stroke)

    @property
    def reach(self) -> float:
        """Half of the outer diameter, mm."""
        return 0.6 * self.bore

    @property
    def top(self) -> float:
        """Height of the fixed end, mm."""
        return self.seat + 1.25 * self.stroke + self.body

    def groups(
        self, axis: float, lift: float
    ) -> tuple[tuple[ShapeGroup, ...], tuple[ShapeGroup, ...]]:
        """Groups of shapes behind the stem, here none, and before it at a lift, on a follower axis
        at x = `axis`, mm.
        """
        wall = _WALL_SHARE * self.bore
        low, rod = self.top - self.body, 0.5 * _ROD_SHARE * self.bore
        half = 0.5 * self.bore
        piston = low + 1.2 * wall - self.seat
        outside = rectangle(-half - wall, low, half + wall, self.top)
        inside = rectangle(-half, low + wall, half, self.top - wall)
        body = (
            DrawnOutline((outside,), Pen("ink", _EDGE, "steel")),
            DrawnOutline((inside,), Pen("ink", _EDGE, "card")),
        )
        moving = (
            DrawnOutline((rectangle(-rod, 0.0, rod, piston),), Pen("ink", _EDGE, "steel")),
            DrawnOutline(
                (rectangle(-half, piston, half, piston + wall),), Pen("ink", _EDGE, "muted")
            ),
        )
        return (), (
            ShapeGroup("gas-body", body, Pose(shift=(axis, 0.0))),
            ShapeGroup("follower-rod", moving, Pose(shift=(axis, self.seat + lift))),
        )


@dataclass(frozen=True)
class Torsion:
    """Torsion spring beside the follower, its arm on a pin of the follower; mm, rad.

    arm_angle : of the arm at zero lift from square to the axis, positive outwards
    """

    arm: float
    arm_angle: float
    diameter: float
    wire: float
    seat: float

    @classmethod
    def drawn(cls, case: CaseLengths, at: SpringPlaces) -> Torsion:
        """Torsion spring of the case, its pin on the follower between the guides; lengths that the
        case does not state are scaled from the stroke.

        Parameters
        ----------
        at : SpringPlaces   heights where it can stand, stroke, diameter of the stem, mm
        """
        arm = case.length("spring", "torsion", "arm") or 2.0 * at.stroke
        raised = case.length("spring", "torsion", "arm_angle", unit="rad") or 0.0
        diameter = case.length("spring", "torsion", "mean_diameter") or 0.4 * arm
        wire = case.length("spring", "torsion", "wire_diameter") or 0.15 * diameter
        return cls(arm, raised, diameter, wire, at.between)

    @property
    def reach(self) -> float:
        """Distance of the far side of the coil from the follower axis, mm."""
        return self.arm * cos(self.arm_angle) + 0.5 * (self.diameter + self.wire)

    @property
    def top(self) -> float:
        """Greatest height of the coil, mm."""
        return self._pivot(0.0)[1] + 0.5 * (self.diameter + self.wire)

    def _pivot(self, axis: float) -> tuple[float, float]:
        return (
            axis + self.arm * cos(self.arm_angle),
            self.seat - self.arm * sin(self.arm_angle),
        )

    def pose(self, axis: float, lift: float) -> Pose:
        """Place of the arm, which lies along -x from the coil axis at an angle of zero."""
        raised = asin(min(max(sin(self.arm_angle) + lift / self.arm, -1.0), 1.0))
        return Pose(-raised, self._pivot(axis))

    def groups(
        self, axis: float, lift: float
    ) -> tuple[tuple[ShapeGroup, ...], tuple[ShapeGroup, ...]]:
        """Groups of shapes behind the stem, here none, and before it at a lift, on a follower axis
        at x = `axis`, mm.
        """
        half = 0.5 * self.diameter
        coil = DrawnOutline((circle(half + 0.5 * self.wire), circle(half - 0.5 * self.wire)),
                       Pen("ink", _EDGE, "steel"))  # fmt: skip
        strand = segment((0.0, half), (-self.arm, 0.0))
        arm = tuple(
            DrawnOutline((strand,), Pen(stroke, width), closed=False)
            for stroke, width in (
                ("ink", self.wire),
                ("steel", (1.0 - 2.0 * _WIRE_EDGE) * self.wire),
            )
        )
        return (), (
            ShapeGroup("coil", (coil,), Pose(shift=self._pivot(axis))),
            ShapeGroup("spring-arm", arm, self.pose(axis, lift)),
        )


@dataclass(frozen=True)
class NoSpring:
    """In place of a spring where a groove holds the follower, at the height of its seat, mm."""

    seat: float
    reach: float = 0.0

    @property
    def top(self) -> float:
        return self.seat

    def groups(
        self,
        axis: float,  # noqa: ARG002
        lift: float,  # noqa: ARG002
    ) -> tuple[tuple[ShapeGroup, ...], tuple[ShapeGroup, ...]]:
        """Nothing is drawn."""
        return (), ()


class DrawnSpring(Protocol):
    """A spring of any kind; `seat`, `top` and `reach` in mm."""

    @property
    def seat(self) -> float: ...
    @property
    def top(self) -> float: ...
    @property
    def reach(self) -> float: ...
    def groups(
        self, axis: float, lift: float
    ) -> tuple[tuple[ShapeGroup, ...], tuple[ShapeGroup, ...]]: ...


DRAWN: Mapping[str, Callable[[CaseLengths, SpringPlaces], DrawnSpring]] = MappingProxyType(
    {"gas": DrawnGasSpring.drawn, "torsion": Torsion.drawn}
)
"""Springs that are no coils, by `spring.kind`."""
