"""Coupling of contact force and friction in guides of finite length."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import ContactError
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.follower.follower_forces import (
    JAM_FLOOR,
    FollowerSystem,
    Loads,
    Push,
    Rubbing,
    follower_loads,
    share_left,
)
from camwright.pipeline.follower.guide_contact import settle
from camwright.pipeline.follower.guide_reactions import (
    KNOTS,
    GuidePair,
    GuideReactions,
    bearing_line,
    guide_reactions,
    require_fit,
)
from camwright.pipeline.follower.stem_beam import Stem

RESIDUAL = 1e-10  # of the axial equilibrium, over the axial force
_ROUNDS_MAX = 100  # bisection alone converges in 40 from the bracket F to F/JAM_FLOOR
_CLIMB = 40  # rounds without bisection at positions that have no upper bound yet

# Values of a fixed-point map at positions, numbered by the second argument.
FixedPointMap = Callable[[Array, NDArray[np.intp]], Array]


@dataclass(frozen=True, eq=False)
class Guided:
    """Loads in equilibrium with the guide reactions, at the same positions.

    residual (n,): of the axial equilibrium over the axial force; rounds: number of solutions of the
    guides.
    """

    loads: Loads
    reactions: GuideReactions
    residual: Array
    rounds: int

    def __post_init__(self) -> None:
        freeze(self, residual=self.residual)


def guided_loads(
    pitch: FollowerPath,
    system: FollowerSystem,
    stem: Stem,
    guides: GuidePair,
    cam_speed: ArrayLike,
    theta: ArrayLike,
    knots: int = KNOTS,
) -> Guided:
    r"""Forces on a follower in guides with length and clearance, with implicit friction.

    Side force F_a tan(alpha) and couple of an axial force beside the stem axis load the edges of
    the guides, with friction mu_A R_A + mu_B R_B, where R is the rubbing load of `guide_reactions`.
    The axial force F_a balances this friction:

        F_a = F / (1 - sign(v) c(F_a) l),    c = (mu_A R_A + mu_B R_B) / (F_a l),

    with the side-load factor l of `Push`, for a roller |tan(alpha)|.

    With clearance c depends on the load: the equation is solved for F_a at all angles at once. On
    the outward stroke F_a lies between F and F/`JAM_FLOOR`, on the return between 0 and F; both
    sides are continuous, so that a solution exists for any friction. On the outward stroke the
    search increases from F: of several solutions it takes the smallest. Below a jam index of
    1 - `JAM_FLOOR` the forces are in equilibrium; above it they are bounded, and `jam_index`
    indicates the jam as in `follower_loads`.

    Parameters
    ----------
    pitch : FollowerPath
    system : FollowerSystem   without its `rubbing`
    stem : Stem
    guides : GuidePair        without its friction, which is that of the system
    cam_speed : float or array (n,)   rad/s, >= 0
    theta : array (n,)        cam angles, rad
    knots : int               per guide

    Raises
    ------
    InputError
        As of `follower_loads` and `guide_reactions`.
    ContactError
        If the residual of an axial equilibrium exceeds 1e-10 of the axial force.
    """
    theta = finite("theta", theta)
    points = follower_loads(pitch, replace(system, rubbing=None), cam_speed, theta)
    free = follower_loads(
        pitch, replace(system, friction_a=0.0, friction_b=0.0, rubbing=None), cam_speed, theta
    )
    require_fit(stem, guides, points.overhang, knots)
    way, slope = Push.of(pitch, system, theta), points.lift_slope
    bores = _Bores(stem, guides, knots, points, way)

    def mapping(push: Array, at: NDArray[np.intp]) -> Array:
        a, b = bores.factors(push, at)
        jam = (system.friction_a * a + system.friction_b * b) * way.side_factor[at]
        return np.asarray(free.axial_force[at] / share_left(slope[at], jam))

    force, outward = free.axial_force, slope > 0.0
    high = np.where(outward, force / JAM_FLOOR, force)
    low, start = np.where(outward, force, 0.0), np.where(outward, force, points.axial_force)
    push, rounds = balanced(mapping, low, high, start)
    everywhere = np.arange(theta.size)
    a, b = bores.factors(push, everywhere)
    loads = follower_loads(pitch, replace(system, rubbing=Rubbing(theta, a, b)), cam_speed, theta)
    reactions = guide_reactions(
        loads.tangential_force,
        loads.overhang,
        stem,
        guides,
        loads.end_moment,
        knots=knots,
        start=bores.state,
    )
    residual = _residual(system, free, loads, reactions)
    if not residual.max(initial=0.0) <= RESIDUAL:
        raise ContactError(
            f"friction: residual = {residual.max():.3g}, must be <= {RESIDUAL:g} of the axial force"
        )
    return Guided(loads, reactions, residual, rounds + 2)


def balanced(mapping: FixedPointMap, low: Array, high: Array, start: Array) -> tuple[Array, int]:
    """Fixed points x = f(x) of continuous functions, each within a bracket.

    With f(low) >= low and f(high) <= high: secant steps within the bracket. Where a step does not
    halve the residual, bisection, once a value with f(x) < x bounds the bracket from above; until
    then steps increase x, by the secant or to f(x).

    Parameters
    ----------
    mapping : function  f of values (k,) and their positions (k,) in the arrays
    low, high : array (n,)
    start : array (n,)

    Returns
    -------
    x : array (n,)    with |x - f(x)| <= 1e-2 of `RESIDUAL` of x
    rounds : int      calls of the function

    Raises
    ------
    ContactError
        If 100 rounds do not converge.
    """
    x, low, high = np.clip(start, low, high), low.copy(), high.copy()
    before, missed = np.full_like(x, np.nan), np.full_like(x, np.inf)
    bounded = np.zeros(x.shape, dtype=bool)
    at = np.flatnonzero(high > 0.0)
    x[high <= 0.0] = 0.0
    for rounds in range(_ROUNDS_MAX):
        if not at.size:
            return x, rounds
        now, value = x[at], mapping(x[at], at)
        miss = now - value
        open_ = np.abs(miss) > 0.01 * RESIDUAL * value
        low[at] = np.where(miss < 0.0, now, low[at])
        high[at] = np.where(miss > 0.0, now, high[at])
        bounded[at] |= miss > 0.0
        with np.errstate(invalid="ignore", divide="ignore"):
            secant = now - miss * (now - before[at]) / (miss - missed[at])
        within = (secant > low[at]) & (secant <= high[at])
        slow = np.abs(miss) > 0.5 * np.abs(missed[at])
        halved = slow & (bounded[at] | (rounds >= _CLIMB))
        next_ = np.where(halved, 0.5 * (low[at] + high[at]), np.where(within, secant, value))
        x[at] = np.where(open_, next_, value)
        before[at], missed[at] = now, miss
        at = at[open_]
    raise ContactError(f"friction: {at.size} positions not converged in {_ROUNDS_MAX} rounds")


class _Bores:
    """Guides at fixed positions, each solution started from the previous one."""

    def __init__(self, stem: Stem, guides: GuidePair, knots: int, points: Loads, way: Push) -> None:
        self.line, _, half_a = bearing_line(stem, guides, knots)
        self.reach, self.knots = points.overhang - half_a, knots
        self.points, self.way = points, way
        self.state: tuple[Array, Array] | None = None

    def factors(self, push: Array, at: NDArray[np.intp]) -> tuple[Array, Array]:
        """Rubbing load over axial force and side-load factor (k,); unloaded: of point supports."""
        start = None
        if self.state is not None:
            start = self.state[0][:, at], self.state[1][:, at]
        side, moment = push * self.way.side[at], push * self.way.arm[at]
        pushes, rigid = settle(self.line, side, moment - side * self.reach[at], start)
        if self.state is None:
            count = self.reach.size
            self.state = np.zeros((len(pushes), count)), np.zeros((2, count))
        self.state[0][:, at], self.state[1][:, at] = pushes, rigid
        rubbed = np.abs(pushes[: self.knots]).sum(axis=0), np.abs(pushes[self.knots :]).sum(axis=0)
        size, on_points = (
            push * self.way.side_factor[at],
            (self.points.rubbing_a[at], self.points.rubbing_b[at]),
        )
        a, b = (
            np.divide(load, size, out=share.copy(), where=size > 0.0)
            for load, share in zip(rubbed, on_points, strict=True)
        )
        return a, b


def _residual(
    system: FollowerSystem, free: Loads, loads: Loads, reactions: GuideReactions
) -> Array:
    """Residual (n,) of the axial equilibrium over the axial force; 0 where that is bounded."""
    rubs = (
        system.friction_a * reactions.rubbing_load_a + system.friction_b * reactions.rubbing_load_b
    )
    miss = loads.axial_force - np.sign(loads.lift_slope) * rubs - free.axial_force
    bounded = share_left(loads.lift_slope, loads.jam_index) <= JAM_FLOOR
    push = np.where(bounded, 0.0, loads.axial_force)
    return np.divide(np.abs(miss), push, out=np.zeros_like(miss), where=push > 0.0)
