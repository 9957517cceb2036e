"""Envelope of the mechanism: bounding box of all parts over a whole turn.

Lengths in one unit. `across` the stem in the plane of the cam, `along` the stem, and `depth` along
the camshaft, from the middle of the cam on its axis.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

Ends = tuple[float, float]


class Box(NamedTuple):
    """Extent of parts across the stem, along the stem and along the camshaft, (low, high), m."""

    across: Ends
    along: Ends
    depth: Ends

    @property
    def size(self) -> tuple[float, float, float]:
        """Lengths across and along the stem and along the camshaft."""
        (left, right), (low, high), (back, front) = self
        return right - left, high - low, front - back


def around(boxes: Iterable[Box]) -> Box:
    """Smallest box, in each direction, that contains several boxes."""
    ends = [tuple(zip(*sides, strict=True)) for sides in zip(*boxes, strict=True)]
    return Box(*((min(lows), max(highs)) for lows, highs in ends))


class Disc(NamedTuple):
    """Part about the camshaft axis: axial distance of its middle from the cam's; width."""

    place: float
    width: float
    diameter: float


class Sleeve(NamedTuple):
    """Part about the stem: ends over the reference point at maximum lift, and diameter, m."""

    low: float
    high: float
    diameter: float


@dataclass(frozen=True)
class MechanismSizes:
    """Dimensions of the parts of the mechanism that a case states.

    Parameters
    ----------
    cam_radius, cam_width   maximum radius of the contour; width
    axis, lowest, lift      place of the follower axis; height of roller centre or face at zero
                            lift; maximum lift
    follower                half of its greatest length across the stem and along the camshaft
    stem_diameter, stem_end   height of the end over the reference point
    sleeves                 guides, and spring with its seats over the turn
    discs                   second disc of the cam, gear, bearings, shaft
    below                   length of the follower below roller centre or face
    """

    cam_radius: float
    cam_width: float
    axis: float
    lowest: float
    lift: float
    follower: tuple[float, float]
    stem_diameter: float
    stem_end: float
    sleeves: tuple[Sleeve, ...]
    discs: tuple[Disc, ...]
    below: float = 0.0

    @property
    def on_shaft(self) -> tuple[Box, ...]:
        """Boxes of the cam and the parts about its shaft."""
        cam = Disc(0.0, self.cam_width, 2.0 * self.cam_radius)
        return tuple(map(self._disc, (cam, *self.discs)))

    @property
    def parts(self) -> tuple[Box, ...]:
        """Boxes of the parts over the turn, the follower from lowest to highest position."""
        highest = self.lowest + self.lift
        half, deep = self.follower
        stem = Sleeve(-self.lift, self.stem_end, self.stem_diameter)
        across = self.axis - half, self.axis + half
        return (
            *self.on_shaft,
            Box(across, (self.lowest - self.below, highest), (-deep, deep)),
            *(self._sleeve(each, highest) for each in (stem, *self.sleeves)),
        )

    @property
    def envelope(self) -> Box:
        """Bounding box of the mechanism over the whole turn."""
        return around(self.parts)

    @staticmethod
    def _disc(disc: Disc) -> Box:
        half, wide = 0.5 * disc.diameter, 0.5 * disc.width
        return Box((-half, half), (-half, half), (disc.place - wide, disc.place + wide))

    def _sleeve(self, sleeve: Sleeve, highest: float) -> Box:
        half = 0.5 * sleeve.diameter
        ends = highest + sleeve.low, highest + sleeve.high
        return Box((self.axis - half, self.axis + half), ends, (-half, half))
