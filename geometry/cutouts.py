"""Bore, keyway and counter-hole of the cam; radius of an outline by polar angle."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from camwright.geometry.arrays import Array, readonly, rotation
from camwright.geometry.errors import InputError, in_millimetres


class KeywayLike(Protocol):
    """Slot in the bore: `width` across and `depth` beyond the bore radius, m, at `angle`, rad.

    `fillet` (m) is the radius of its two inner corners; 0: sharp.
    """

    @property
    def width(self) -> float: ...
    @property
    def depth(self) -> float: ...
    @property
    def angle(self) -> float: ...
    @property
    def fillet(self) -> float: ...


class HoleLike(Protocol):
    """Round hole: centre (2,) and radius, m."""

    @property
    def centre(self) -> Array: ...
    @property
    def radius(self) -> float: ...


def keyway_corners(bore_radius: float, keyway: KeywayLike) -> Array:
    """Corners (2, 4) of a keyway without fillets, m, counter-clockwise: on the bore, twice on the
    floor, on the bore.

    Raises
    ------
    InputError
        If the keyway is as wide as the bore.
    """
    half = 0.5 * keyway.width
    if not half < bore_radius:
        shown, most = in_millimetres(keyway.width, 2 * bore_radius)
        raise InputError("cam.keyway.width", shown, f"< {most}, 2 bore radii")
    mouth, floor = np.sqrt(bore_radius**2 - half**2), bore_radius + keyway.depth
    local = np.array([[mouth, floor, floor, mouth], [-half, -half, half, half]])
    return readonly(rotation(keyway.angle) @ local)


def radius_at(outline: Array, turn: float) -> float:
    """Greatest distance from the origin, m, at which a ray at angle `turn`, rad, meets an outline;
    by linear interpolation on its edges.

    Parameters
    ----------
    outline : array (2, n)    polygon around the origin, m, first point not repeated
    """
    along, across = rotation(-turn) @ outline
    to_along, to_across = np.roll(along, -1), np.roll(across, -1)
    crosses = (across <= 0.0) != (to_across <= 0.0)
    share = across[crosses] / (across[crosses] - to_across[crosses])
    return float(np.max(along[crosses] + share * (to_along[crosses] - along[crosses])))
