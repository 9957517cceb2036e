"""Friction energy of a turn over the sizes of slider-crank and eccentric cams."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.eccentric import Eccentric
from validation.slider_crank_drive import (
    EccentricDrive,
    HoldingSpring,
    Masses,
    PairFriction,
    SliderCrankDrive,
)

CRANKS = np.linspace(0.010, 0.400, 17)
"""l1, m (eq. 43)."""
RATIOS = np.arange(2, 11)
"""l2 / l1 (eq. 44); 17 x 9 = 153 combinations."""
OFFSET_SHARE = 0.75
"""Offset over l1; by eq. 45 for ratios from 3.5."""
BIG, SMALL = 2.0 / 3.0, 1.0 / 3.0
"""Roller radius over l2, the ends of eq. 46."""


@dataclass(frozen=True, eq=False)
class Workspace:
    """Friction energies (cranks, ratios) of a turn, J, of slider-crank and cams; NaN: invalid size.

    big, small: by roller size without offset; *_offset: with an offset of 0.75 l1.
    """

    cranks: Array
    ratios: Array
    slider_crank: Array
    big: Array
    small: Array
    slider_crank_offset: Array
    big_offset: Array
    small_offset: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def combinations(self) -> int:
        """Number of size combinations."""
        return self.big.size

    def above_best(self, name: str) -> Array:
        """Energy over that of the big roller without offset, less one."""
        return np.asarray(getattr(self, name) / self.big - 1.0)

    @property
    def big_is_best(self) -> int:
        """Number of combinations with minimum energy of the big roller without offset."""
        rivals = [name for name in self.__dataclass_fields__ if name not in _AXES]
        lowest = np.nanmin(np.stack([getattr(self, name) for name in rivals]), axis=0)
        return int(np.sum(self.big <= lowest))


_AXES = ("cranks", "ratios", "big")


def workspace(friction: PairFriction, speed: float) -> Workspace:
    """Friction energy of the 153 combinations at one speed (rad/s), without masses.

    References
    ----------
    Energy loss comparison between kinematically equivalent mechanisms (2024), eqs 43 to 46.
    """
    names = ("slider_crank", "big", "small")
    energies = {
        name + suffix: np.full((len(CRANKS), len(RATIOS)), np.nan)
        for name in names
        for suffix in ("", "_offset")
    }
    massless, slack = Masses(slider=0.0), HoldingSpring(0.0, 0.0)
    for i, crank in enumerate(CRANKS):
        for j, ratio in enumerate(RATIOS):
            rod = float(ratio * crank)
            for suffix, offset in (("", 0.0), ("_offset", OFFSET_SHARE * crank)):
                if rod < 2.0 * (crank + offset) * (1.0 - 1e-12):
                    continue
                linkage = Eccentric(float(crank), rod, float(offset))
                common = (friction, massless, slack)
                drives: tuple[SliderCrankDrive | EccentricDrive, ...] = (
                    SliderCrankDrive(linkage, *common),
                    EccentricDrive(linkage, BIG * rod, *common),
                    EccentricDrive(linkage, SMALL * rod, *common),
                )
                for name, drive in zip(names, drives, strict=True):
                    energies[name + suffix][i, j] = drive.losses(speed, 360).total
    return Workspace(CRANKS, RATIOS.astype(float), **energies)
