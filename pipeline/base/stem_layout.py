"""Layout along the stem: guides, spring seats, coil spring; default place of the spring.

Lengths in one unit, numbers or arrays (...). Heights are over the reference point of the follower,
roller centre or face, at maximum lift; guide A lies below guide B. The spring reaches from a seat
on the stem up to a fixed seat, at guide B or at the housing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value

SEAT_MOST = 0.5
"""Thickness of a seat over the stem diameter from which it is stronger than the stem.

Shear pi d t sigma/2 round the stem, by Tresca, against compression pi d^2/4 sigma of the stem.
"""


class SeatPlace(NamedTuple):
    """Position of the moving spring seat at maximum lift, m, and least clearance of the spring.

    gap (...): of seats and spring from guides, stem and follower; NaN: on a stem of unknown length.
    """

    height: Array
    gap: Array


def decided(most: Value, none: Value, limit: Value) -> Array:
    """Clearance where bounds of an unknown thickness decide it, (...); NaN where they do not.

    The gap at the greatest size is within the limit, and so at every one; or that at none is not.
    """
    return np.where(most >= limit, most, np.where(none < limit, none, np.nan))


def _overlap(room: Value) -> Array:
    """A room that parts at rest to one another may use up: no clearance unless they overlap."""
    return np.where(np.asarray(room) < 0.0, room, np.inf)


def _around(room: Value, radial: Value) -> Array:
    """As `_overlap`, of coils that pass around a guide with a radial clearance; NaN: not known."""
    return np.where(np.asarray(room) < 0.0, np.fmax(room, radial), np.inf)


def _least(*gaps: Value) -> Array:
    return np.asarray(reduce(np.minimum, gaps))  # NaN of one is NaN of all


@dataclass(frozen=True, eq=False)
class StemLayout:
    """Positions of guides, stem and coil spring along the follower axis, m.

    Parameters
    ----------
    overhang, spacing        of guide A over the reference point at maximum lift; of the guides
    length_a, length_b       of the guides
    lift                     maximum lift
    extent                   of the follower from its reference point towards guide A
    stem_diameter, stem_length   from the reference point to the end; None: not known
    spring_length            between its seats at zero lift
    spring_bore              inner diameter of the coils
    outer_a, outer_b         outer diameters of the guides; NaN: not known
    """

    overhang: Value
    spacing: Value
    length_a: Value
    length_b: Value
    lift: Value
    extent: Value
    stem_diameter: Value
    stem_length: Value | None
    spring_length: Value
    spring_bore: Value
    outer_a: Value
    outer_b: Value

    @property
    def guide_a(self) -> tuple[Value, Value]:
        """Lower and upper end of guide A."""
        return self.overhang - 0.5 * self.length_a, self.overhang + 0.5 * self.length_a

    @property
    def guide_b(self) -> tuple[Value, Value]:
        """Lower and upper end of guide B."""
        middle = self.overhang + self.spacing
        return middle - 0.5 * self.length_b, middle + 0.5 * self.length_b

    @property
    def beside_stem(self) -> Value:
        """Radial clearance of the coils from the stem."""
        return 0.5 * (self.spring_bore - self.stem_diameter)

    def seated(self, thickness: Value, clearance: Value, height: Value | None = None) -> SeatPlace:
        """Position of the moving seat of a given thickness, and least clearance over the turn.

        Where no height is stated the spring rests on guide B from below if it clears guide A and
        the stem by a clearance; else it stands above guide B, on the end of the stem.
        """
        return (
            self._by_rule(thickness, clearance) if height is None else self._at(height, thickness)
        )

    def _by_rule(self, thickness: Value, clearance: Value) -> SeatPlace:
        """Default place of the moving seat of the spring: between the guides if the spring has room
        there, else above guide B; see `seated`.

        Parameters
        ----------
        thickness : (...)   of a seat, m
        clearance : (...)   that the spring needs, m
        """
        between = self.guide_b[0] - self.spring_length + self.lift
        gap = _least(between - self.lift - thickness - self.guide_a[1], self.beside_stem)
        least = self.guide_b[1] + self.lift + thickness
        above = least + clearance if self.stem_length is None else self.stem_length
        free = np.asarray(np.nan if self.stem_length is None else above - least)
        stays = (gap >= clearance) | (free < gap)
        return SeatPlace(np.where(stays, between, above), np.where(stays, gap, free))

    def _at(self, height: Value, thickness: Value) -> SeatPlace:
        """Place of the moving seat of the spring at a stated height, with the least clearance of
        the spring: below guide A, between the guides, or above guide B.

        Coils that reach a guide pass around it.

        Parameters
        ----------
        height : (...)      of the seat over the reference point, at maximum lift, m
        thickness : (...)   of a seat, m
        """
        low, fixed = height - self.lift - thickness, height - self.lift + self.spring_length
        stem = np.nan if self.stem_length is None else self.stem_length
        on_stem = np.nan if self.stem_length is None else _overlap(stem - height)
        # a spring on the end of the stem, or beyond it, has no stem inside
        inside = np.where(np.asarray(height) >= stem, np.inf, self.beside_stem)
        around_a, around_b = (
            _around(guide[0] - fixed, 0.5 * (self.spring_bore - outer))
            for guide, outer in ((self.guide_a, self.outer_a), (self.guide_b, self.outer_b))
        )
        below = _least(
            _overlap(height - thickness - self.extent),
            around_a,
            around_b,
            self.guide_a[0] - height,
        )
        between = _least(low - self.guide_a[1], around_b)
        above = _least(low - self.guide_b[1], on_stem)
        axial = np.where(
            np.asarray(height) <= self.guide_a[0],
            below,
            np.where(np.asarray(height) <= self.guide_b[0], between, above),
        )
        gap = _least(axial, inside) + 0.0 * self.lift
        return SeatPlace(height + 0.0 * gap, gap)

    def known_gap(
        self, thickness: Value | None, clearance: Value, height: Value | None = None
    ) -> Array:
        """Least clearance of the spring (...), m, along the stem and beside it; NaN where it is not
        known.

        Where the thickness of the seats is not known, the thickest and the thinnest decide if both
        are clear or both are not.

        Parameters
        ----------
        thickness : (...) or None   of a seat, m
        clearance : (...)           that the spring needs, m
        height : (...) or None      of the moving seat at maximum lift, m; None: its default place
        """
        if thickness is not None:
            return self.seated(thickness, clearance, height).gap
        widest = self.seated(SEAT_MOST * self.stem_diameter, clearance, height).gap
        none = self.seated(0.0, clearance, height).gap
        return decided(widest, none, clearance)
