"""Friction of the guides between bounds: force, jamming, heat, temperature, PV."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import InputError
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.guide_reactions import WALL_SHARE

# Nylon: Mott, Machine Elements in Mechanical Design, table 16-1 (0.105 MPa m/s dry) and the
# graded limits of a bush maker, of which the dry one is the lower.
NYLON_PV = {
    "dry": 0.083e6,
    "greased_once": 0.17e6,
    "regularly_greased": 0.33e6,
    "flooded": 0.83e6,
}


@dataclass(frozen=True, eq=False)
class FrictionBounds:
    """Loads at the least, nominal and greatest friction of both guides."""

    least: Loads
    nominal: Loads
    greatest: Loads

    @property
    def normal_force_min(self) -> Array:
        """Least contact force at each angle over the bounds, N.

        The force grows with friction on the way out and falls on the way back, so that the
        bounds hold its extremes.
        """
        return np.minimum(self.least.normal_force, self.greatest.normal_force)

    @property
    def normal_force_max(self) -> Array:
        """Greatest contact force at each angle over the bounds, N."""
        return np.maximum(self.least.normal_force, self.greatest.normal_force)

    @property
    def jam_index_max(self) -> Array:
        """At the greatest friction, where the follower moves outward; 0 elsewhere."""
        worst = self.greatest
        return np.where(worst.lift_slope > 0.0, worst.jam_index, 0.0)

    @property
    def jam_margin(self) -> float:
        """Factor by which friction may still grow before the guides lock; infinite without it."""
        worst = float(self.jam_index_max.max(initial=0.0))
        return 1.0 / worst if worst > 0.0 else np.inf


def friction_bounds(
    solved: Callable[[FollowerSystem], Loads],
    system: FollowerSystem,
    least: tuple[float, float],
    greatest: tuple[float, float],
) -> FrictionBounds:
    """Loads with the friction of guides A and B at its bounds and as in `system`.

    Parameters
    ----------
    solved : function    the loads of a system, such as `follower_loads` or `guided_loads` give

    Raises
    ------
    InputError
        If the bounds do not enclose the nominal friction.
    """
    nominal = (system.friction_a, system.friction_b)
    for name, low, middle, high in zip("ab", least, nominal, greatest, strict=True):
        if not 0.0 <= low <= middle <= high:
            raise InputError(
                f"guides.{name}.friction",
                f"{low}, {middle}, {high}",
                "0 <= least <= nominal <= most",
            )

    def loads(friction: tuple[float, float]) -> Loads:
        return solved(replace(system, friction_a=friction[0], friction_b=friction[1]))

    return FrictionBounds(loads(least), loads(nominal), loads(greatest))


@dataclass(frozen=True, eq=False)
class GuideHeat:
    """Heat of one guide: W at each angle (n,); its mean, and the temperature it leads to, K.

    The temperature is NaN where no thermal resistance is known.
    """

    power: Array
    temperature: float

    def __post_init__(self) -> None:
        freeze(self, power=self.power)

    @property
    def mean_power(self) -> float:
        """Over the turn, W."""
        return float(np.mean(self.power))


def guide_heat(
    rubbing_load: ArrayLike,
    velocity: ArrayLike,
    friction: float,
    resistance: float | None,
    ambient: float,
) -> GuideHeat:
    """Heat of the pushes of both sides of the bore, at equal angles, and the bush's temperature.

    Parameters
    ----------
    rubbing_load : array (n,)   N, >= 0; sums both sides of the bore, see `GuideReactions`
    velocity : array (n,)       m/s
    friction : float            mu, >= 0
    resistance : float          from the rubbing surface to the ambient, K/W; None: not known
    ambient : float             K

    Raises
    ------
    InputError
        If a value is not finite or negative.
    """
    load = finite("guide.rubbing_load", rubbing_load)
    if (load < 0.0).any():
        raise InputError("guide.rubbing_load", float(load.min()), ">= 0 N")
    if not 0.0 <= friction < np.inf:
        raise InputError("guide.friction", friction, ">= 0")
    power = friction * load * np.abs(finite("velocity", velocity))
    rise = np.nan if resistance is None else resistance * float(np.mean(power))
    return GuideHeat(power, ambient + rise)


def bush_resistance(bore: float, length: float, conductivity: float) -> float:
    """Heat resistance of a bush's wall to a housing at ambient temperature, K/W.

    ln(D_o/D)/(2 pi lambda l). An estimate: what flows off through the stem lowers, what the
    housing keeps raises the temperature.

    Raises
    ------
    InputError
        If a value is not positive.

    References
    ----------
    Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, sec. 3.3: radial conduction.
    """
    for name, value in (("diameter", bore), ("length", length), ("conductivity", conductivity)):
        if not 0.0 < value < np.inf:
            raise InputError(f"guide.{name}", value, "> 0")
    return float(np.log(1.0 + 2.0 * WALL_SHARE) / (2.0 * np.pi * conductivity * length))
