"""Guide friction at its bounds: contact force, jam index, heat, temperature, expansion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, finite
from camwright.geometry.errors import InputError
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads
from camwright.pipeline.follower.guide_reactions import Guide

# pv limits of nylon by lubrication, Pa m/s, of a manufacturer of bushes. Dry: 0.105 MPa m/s in
# Mott, Machine Elements in Mechanical Design, table 16-1.
NYLON_PV = {
    "dry": 0.083e6,
    "greased_once": 0.17e6,
    "regularly_greased": 0.33e6,
    "flooded": 0.83e6,
}


def friction_limits(
    friction: ArrayLike, low: ArrayLike | None, high: ArrayLike | None, tolerance: Value
) -> tuple[Array, Array]:
    """Minimum and maximum friction coefficient of a guide, or of many (...).

    Parameters
    ----------
    friction : float or array (...)    nominal
    low, high : float or array (...)   as stated; None or NaN: by the tolerance
    tolerance : float or array (...)   share of the nominal coefficient
    """
    nominal = np.asarray(friction, dtype=float)
    stated = (np.asarray(np.nan if one is None else one, dtype=float) for one in (low, high))
    usual = (1.0 - tolerance) * nominal, (1.0 + tolerance) * nominal
    least, greatest = (
        np.where(np.isnan(one), scattered, one)
        for one, scattered in zip(stated, usual, strict=True)
    )
    return least, greatest


class RubbedBearing(Protocol):
    """Bearing with a coefficient of friction and its bounds; None: by the tolerance."""

    @property
    def friction(self) -> float: ...
    @property
    def friction_min(self) -> float | None: ...
    @property
    def friction_max(self) -> float | None: ...


@dataclass(frozen=True)
class FrictionRange:
    """Friction coefficients of guides A and B, or of a pivot and none: nominal, minimum, maximum.

    Raises
    ------
    InputError
        If the bounds do not enclose the nominal coefficients; NaN included.
    """

    nominal: tuple[float, float]
    least: tuple[float, float]
    greatest: tuple[float, float]

    def __post_init__(self) -> None:
        """Refuse bounds that do not enclose the nominal coefficients."""
        ranges = zip("ab", self.least, self.nominal, self.greatest, strict=True)
        for name, low, middle, high in ranges:
            if not 0.0 <= low <= middle <= high:
                shown = f"{low:g}, {middle:g}, {high:g}"
                limit = "0 <= least <= nominal <= greatest"
                raise InputError(f"guides.{name}.friction", shown, limit)

    @classmethod
    def of(cls, on_a: RubbedBearing, on_b: RubbedBearing, tolerance: float) -> FrictionRange:
        """From the bounds of two bearings; a relative tolerance where one has none."""
        a, b = (
            friction_limits(each.friction, each.friction_min, each.friction_max, tolerance)
            for each in (on_a, on_b)
        )
        return cls(
            nominal=(on_a.friction, on_b.friction),
            least=(float(a[0]), float(b[0])),
            greatest=(float(a[1]), float(b[1])),
        )

    def factors(self, side: int) -> tuple[float, float]:
        """Minimum and maximum over nominal coefficient of guide 0 (A) or 1 (B)."""
        nominal = self.nominal[side] or 1.0
        return self.least[side] / nominal, self.greatest[side] / nominal

    def scaled(self, factor_a: float, factor_b: float) -> FrictionRange:
        """Nominal coefficients times a factor each, bounds extended to include them."""
        a, b = self.nominal[0] * factor_a, self.nominal[1] * factor_b
        return replace(
            self,
            nominal=(a, b),
            least=(min(self.least[0], a), min(self.least[1], b)),
            greatest=(max(self.greatest[0], a), max(self.greatest[1], b)),
        )


@dataclass(frozen=True, eq=False)
class FrictionBounds:
    """Follower loads at minimum, nominal and maximum friction of both guides."""

    least: Loads
    nominal: Loads
    greatest: Loads

    @property
    def normal_force_min(self) -> Array:
        """Minimum contact force (n,) over the friction bounds, N.

        Friction increases the force on the outward stroke and reduces it on the return: the
        extremes are at the bounds.
        """
        return np.minimum(self.least.normal_force, self.greatest.normal_force)

    @property
    def normal_force_max(self) -> Array:
        """Maximum contact force (n,) over the friction bounds, N; NaN where the follower locks."""
        most = np.maximum(self.least.normal_force, self.greatest.normal_force)
        return np.where(self.greatest.bounded, np.nan, most)

    @property
    def jam_index_max(self) -> Array:
        """Jam index (n,) at maximum friction where the follower moves outward; 0 elsewhere."""
        worst = self.greatest
        return np.where(worst.lift_slope > 0.0, worst.jam_index, 0.0)


def friction_bounds(
    solved: Callable[[FollowerSystem], Loads], system: FollowerSystem, friction: FrictionRange
) -> FrictionBounds:
    """Follower loads at minimum, nominal and maximum friction of guides A and B.

    Parameters
    ----------
    solved : function    loads of a system, such as by `follower_loads` or `guided_loads`
    """

    def loads(both: tuple[float, float]) -> Loads:
        return solved(system.with_friction(*both))

    return FrictionBounds(loads(friction.least), loads(friction.nominal), loads(friction.greatest))


def friction_power(friction_force: ArrayLike, velocity: ArrayLike) -> Array:
    """Friction power of a guide (n,), W.

    Parameters
    ----------
    friction_force : array (n,)   N, >= 0
    velocity : array (n,)         of the stem, m/s

    Raises
    ------
    InputError
        If a value is not finite or a force negative.
    """
    force = finite("guide.friction_force", friction_force)
    if (force < 0.0).any():
        raise InputError("guide.friction_force", float(force.min()), ">= 0 N")
    return force * np.abs(finite("velocity", velocity))


def bush_temperature(power: Value, resistance: float | None, ambient: Value | None) -> Value:
    """Steady bush temperature, K, by mean friction power, W.

    resistance: thermal, from rubbing surface to ambient, K/W; NaN where that or the ambient
    temperature, K, is not known.
    """
    if resistance is None or ambient is None:
        return np.nan
    return ambient + resistance * power


def thermal_resistance(guide: Guide) -> float | None:
    """Thermal resistance from the rubbing surface of a guide to the ambient, K/W.

    That of the case, else wall and housing in series; None: not known. All friction heat flows
    through bush and housing: heat flow through the stem lowers the temperature.
    """
    conductivity = guide.material.conductivity
    if guide.thermal_resistance is not None:
        return guide.thermal_resistance
    if guide.wall is None or guide.housing_resistance is None or conductivity is None:
        return None
    wall = bush_resistance(guide.diameter, guide.wall, guide.length, conductivity)
    return wall + guide.housing_resistance


def bush_resistance(bore: float, wall: float, length: float, conductivity: float) -> float:
    """Thermal resistance of the wall of a bush to radial conduction, ln(1 + 2 t/D)/(2 pi lambda l),
    K/W.

    Parameters
    ----------
    bore : float           D, m
    wall : float           t, m
    length : float         l, m
    conductivity : float   lambda, W/(m K)

    Raises
    ------
    InputError
        If a value is not positive.

    References
    ----------
    Incropera and DeWitt, Fundamentals of Heat and Mass Transfer, sec. 3.3: radial conduction.
    """
    values = {"diameter": bore, "wall": wall, "length": length, "conductivity": conductivity}
    for name, value in values.items():
        if not 0.0 < value < np.inf:
            raise InputError(f"guide.{name}", value, "> 0")
    return float(np.log(1.0 + 2.0 * wall / bore) / (2.0 * np.pi * conductivity * length))


def bore_closure(wall_share: float, poisson_ratio: float) -> tuple[float, float]:
    """Closure of a bore over bore and free strain: axially free, and axially restrained.

    The bush expands by an isotropic free strain in a rigid housing: no radial displacement at its
    outer radius, no radial stress at the bore. Axially free is plane stress, held is plane strain.

    Parameters
    ----------
    wall_share : float      wall over bore, > 0
    poisson_ratio : float   nu, 0 <= nu < 0.5

    Raises
    ------
    InputError
        If a value is out of these bounds.

    References
    ----------
    Lame's thick cylinder with a uniform free strain; Timoshenko and Goodier, Theory of Elasticity.
    """
    if not 0.0 < wall_share < np.inf:
        raise InputError("guide.wall", wall_share, "> 0 of the bore")
    if not 0.0 <= poisson_ratio < 0.5:
        raise InputError("guide.poisson_ratio", poisson_ratio, ">= 0 and < 0.5")
    nu, square = poisson_ratio, (1.0 + 2.0 * wall_share) ** 2
    stretched = (square - 1.0) * (1.0 + nu)
    free = stretched / ((1.0 + nu) + (1.0 - nu) * square)
    return free, stretched / (1.0 + (1.0 - 2.0 * nu) * square)
