"""Preload and rate of a spring that keeps the follower in contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy.optimize

from camwright.geometry.arrays import Array, positive
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import Extremum, least_argument
from camwright.geometry.lift_parts import LiftParts
from camwright.pipeline.base.external_force import NO_FORCE, ExternalForce
from camwright.pipeline.base.units import shown

PRELOAD_SHARE = 0.25
"""Least preload over the force at full lift: a spring works from 20 to 80 % of its travel,
Associated Spring, Engineering Guide to Spring Design; Shigley ch. 10: verify."""

_RANGE = 6.0
"""Natural logarithm of the greatest rate over the throw per stroke; of the least, its negative."""
_RATE_TOLERANCE = 1e-9
"""Relative, of the least rate: far below the digits to which it is rounded up."""


@dataclass(frozen=True, kw_only=True)
class HoldingCondition:
    """Contact condition at a speed: P + k s + F + m w^2 s'' + c w s' >= share P.

    F is `held` and the force of the machine over the cam angle.

    Parameters
    ----------
    mass : float             m, that moves with the follower, kg, >= 0
    cam_speed : float        w, rad/s, >= 0
    share : float            least contact force over the preload, 0 <= share < 1
    damping : float          c, viscous, N s/m, >= 0
    held : float             of weight and others at every angle, N, towards the cam positive
    rate_factor : float      least rate over the nominal one, > 0
    preload_factor : float   least preload over the nominal one, > 0

    Raises
    ------
    InputError
        If a value is out of these bounds; NaN included.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15: follower jump.
    """

    mass: float
    cam_speed: float
    share: float = 0.0
    damping: float = 0.0
    held: float = 0.0
    rate_factor: float = 1.0
    preload_factor: float = 1.0

    def __post_init__(self) -> None:
        """Refuse values out of bounds."""
        for name, unit in (("mass", "kg"), ("cam_speed", "rad/s"), ("damping", "N s/m")):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(name, getattr(self, name), f">= 0 {unit}")
        if not 0.0 <= self.share < 1.0:
            raise InputError("share", self.share, ">= 0 and < 1")
        if not abs(self.held) < np.inf:
            raise InputError("held", self.held, "finite")
        positive("rate_factor", self.rate_factor)
        positive("preload_factor", self.preload_factor)

    def preload(self, rate: float, s: Array, s1: Array, s2: Array) -> Array:
        """Preload (...), N, required at a cam angle by a rate, N/m."""
        w = self.cam_speed
        throw = -self.mass * w**2 * s2 - self.damping * w * s1 - self.held
        return self._of_force(self.rate_factor * rate * s - throw)

    def preload_under(self, force: ExternalForce, theta: Array) -> Array:
        """Preload (...), N, required by the machine force at cam angles (...), rad."""
        return self._of_force(force.at(theta))

    def _of_force(self, towards: Array) -> Array:
        """Preload (...), N, that a force towards the cam, N, leaves to be had."""
        share: Array = -towards / ((1.0 - self.share) * self.preload_factor)
        return share


class SpringSize(NamedTuple):
    """Rate, N/m, and preload, N."""

    rate: float
    preload: float

    def force(self, lift: float) -> float:
        """Force at a lift, m, in N."""
        return self.preload + self.rate * lift

    def energy(self, lift: float) -> float:
        """Energy at a lift (m) beyond the free length, J."""
        return 0.5 * self.force(lift) ** 2 / self.rate


def preload_needed(
    lift: LiftParts,
    rate: float,
    conditions: Sequence[HoldingCondition],
    force: ExternalForce = NO_FORCE,
) -> Extremum:
    """Least preload for all contact conditions, N, and its cam angle, rad.

    Negative if the rate alone holds it.

    Parameters
    ----------
    lift : LiftParts        its samples no further apart than those of the force
    rate : float            k, N/m, >= 0
    force : ExternalForce   of the machine on the follower
    """
    if not 0.0 <= rate < np.inf:
        raise InputError("spring.rate", rate, ">= 0 N/m")
    return max(
        lift.greatest(partial(each.preload, rate), partial(each.preload_under, force))
        for each in conditions
    )


def smallest_spring(
    lift: LiftParts,
    conditions: Sequence[HoldingCondition],
    *,
    rate: float | None = None,
    force: ExternalForce = NO_FORCE,
) -> SpringSize:
    """Spring of least energy at full lift, hence of least wire at a given stress, that keeps the
    follower in contact.

    The energy (P + k h)^2 / (2 k), h: stroke, with the least preload P(k), a convex function, is
    convex in the rate k: it has one minimum. The preload is at least `PRELOAD_SHARE` of the force
    at full lift.

    Parameters
    ----------
    lift : LiftParts        of the follower
    conditions : sequence   under which contact holds
    rate : float            k, N/m, where it is fixed; None: of the least energy
    force : ExternalForce   of the machine on the follower, as of `preload_needed`

    Raises
    ------
    InputError
        If nothing throws the follower off the cam, so that any spring holds it.
    """
    stroke, least = lift.stroke, PRELOAD_SHARE / (1.0 - PRELOAD_SHARE)

    def spring(each: float) -> SpringSize:
        needed = preload_needed(lift, each, conditions, force).value
        return SpringSize(each, max(needed, least * each * stroke))

    if rate is not None:
        return spring(rate)
    throw = preload_needed(lift, 0.0, conditions, force).value
    if not throw > 0.0:
        limit = "> 0 N at the greatest speed, or spring.rate given"
        raise InputError("force that throws the follower off the cam", throw, limit)
    scale = np.log(throw / stroke)

    def energy(logarithm: float) -> float:
        return spring(float(np.exp(logarithm))).energy(stroke)

    return spring(float(np.exp(least_argument(energy, scale - _RANGE, scale + _RANGE))))


def least_rate(
    lift: LiftParts,
    preload: float,
    conditions: Sequence[HoldingCondition],
    force: ExternalForce = NO_FORCE,
) -> float:
    """Least spring rate at which a given preload keeps the follower in contact, N/m; 0 if the
    preload alone does.

    The preload needed, P(k), falls with the rate: it crosses the given one once.

    Parameters
    ----------
    lift : LiftParts        of the follower
    preload : float         nominal, N, > 0
    conditions : sequence   under which contact holds
    force : ExternalForce   of the machine on the follower, as of `preload_needed`

    Raises
    ------
    InputError
        If the preload holds the follower at no rate, as where it is thrown off at the base circle.
    """
    positive("spring.preload", preload)

    def lacking(rate: float) -> float:
        return preload_needed(lift, rate, conditions, force).value - preload

    throw = lacking(0.0)
    if not throw > 0.0:
        return 0.0
    greatest = float(np.exp(_RANGE)) * (throw + preload) / lift.stroke
    least = lacking(greatest)
    if least > 0.0:
        limit = (
            f">= {shown(preload + least, 'N')}, or the follower leaves the cam at any spring.rate"
        )
        raise InputError("spring.preload", shown(preload, "N"), limit)
    return float(scipy.optimize.brentq(lacking, 0.0, greatest, rtol=_RATE_TOLERANCE))
