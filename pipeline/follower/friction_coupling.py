"""Coupled contact force and guide friction for guides of finite length."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, finite, freeze
from camwright.geometry.errors import ContactError
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.follower.disc_preload import Squeezed
from camwright.pipeline.follower.follower_forces import (
    JAM_FLOOR,
    FollowerSystem,
    Loads,
    PressedGuides,
    Push,
    Rubbing,
    SideLoads,
    follower_loads,
    in_guides,
    share_left,
    sides_of,
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
_RESIDUAL_SHARE = 0.01  # of `RESIDUAL`, at which a position has converged
_HELD_ROUND_OFF = 1e-9  # N, of a follower that is held without a spring: at rest it bears no more
_CLIMB = 40  # rounds without bisection at positions that have no upper bound yet

# Values of a fixed-point map at positions, numbered by the second argument.
FixedPointMap = Callable[[Array, NDArray[np.intp]], Array]


class MovingFollower(NamedTuple):
    """Follower with its motion over cam angles (n,), rad, at a cam speed, rad/s.

    The system is without its `rubbing`.
    """

    pitch: FollowerPath
    system: FollowerSystem
    cam_speed: ArrayLike
    theta: Array


@dataclass(frozen=True, eq=False)
class Guided:
    """Follower loads in equilibrium with the guide reactions, at equal positions.

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
    r"""Forces on a follower in guides of finite length and clearance, with implicit friction.

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

    Under a preload of both rollers of a stem the friction is sought in place of the force, which
    may change its sign: f = mu_A R_A + mu_B R_B at F_a = F + sign(v) f.

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
    stroke = MovingFollower(pitch, system, cam_speed, finite("theta", theta))
    (guided,) = guided_strokes([stroke], stem, guides, knots)
    return guided


def guided_strokes(
    strokes: Sequence[MovingFollower], stem: Stem, guides: GuidePair, knots: int = KNOTS
) -> tuple[Guided, ...]:
    """Loads of several motions with the reactions of guides of finite length, contact force and
    friction in equilibrium; each as by `guided_loads`, all positions solved together.

    Parameters
    ----------
    strokes : sequence   motions of the follower
    stem : Stem          that bends in the guides
    guides : GuidePair   the same for all motions
    knots : int          per guide
    """
    points = [
        follower_loads(s.pitch, replace(s.system, rubbing=None), s.cam_speed, s.theta)
        for s in strokes
    ]
    required = np.concatenate([each.frictionless_force for each in points])
    first = strokes[0]
    pressed = in_guides(first.pitch, first.system, first.theta) is not None
    way = (_BothTracks if pressed else _OneTrack).of(strokes, points, required)
    require_fit(stem, guides, way.overhang + way.reach, knots)
    sizes = [s.theta.size for s in strokes]
    friction_a = np.repeat([s.system.friction_a for s in strokes], sizes)
    friction_b = np.repeat([s.system.friction_b for s in strokes], sizes)
    bores = _Bores(stem, guides, knots, points, way)

    def mapping(push: Array, at: NDArray[np.intp]) -> Array:
        a, b = bores.factors(push, at)
        return way.balance(friction_a[at] * a + friction_b[at] * b, at)

    held = np.repeat([s.system.held for s in strokes], sizes)
    _, rounds = balanced(mapping, *way.bracket, np.where(held, _HELD_ROUND_OFF, 0.0))
    a, b = bores.last_factors
    ends = np.cumsum([0, *sizes])
    spans = [slice(*span) for span in pairwise(ends)]
    loads = [
        follower_loads(
            s.pitch,
            replace(s.system, rubbing=Rubbing(s.theta, a[span], b[span])),
            s.cam_speed,
            s.theta,
        )
        for s, span in zip(strokes, spans, strict=True)
    ]
    reactions = guide_reactions(
        np.concatenate([each.tangential_force for each in loads]),
        np.concatenate([each.overhang for each in loads]),
        stem,
        guides,
        np.concatenate([each.end_moment for each in loads]),
        knots=knots,
        start=(bores.pushes * way.sense, bores.rigid * way.sense),
    )
    return tuple(
        _guided(stroke.system, each, reactions.part(span.start, span.stop), required[span], rounds)
        for stroke, each, span in zip(strokes, loads, spans, strict=True)
    )


def _guided(
    system: FollowerSystem, loads: Loads, reactions: GuideReactions, free: Array, rounds: int
) -> Guided:
    """Loads and reactions of a motion with the residual of the axial equilibrium; ContactError
    where the residual is too great.

    Parameters
    ----------
    system : FollowerSystem      friction coefficients
    loads : Loads                with the rubbing loads of the guides
    reactions : GuideReactions   under these loads
    free : array (n,)            axial force without friction, N
    rounds : int                 solutions of the guides less one
    """
    residual = _residual(system, free, loads, reactions)
    if not residual.max(initial=0.0) <= RESIDUAL:
        raise ContactError(
            f"friction: residual = {residual.max():.3g}, must be <= {RESIDUAL:g} of the axial force"
        )
    return Guided(loads, reactions, residual, rounds + 1)


class _OnGuides(NamedTuple):
    """Load of the cam on the guides (k,): side force, N, its moment about the roller of `overhang`,
    N m, and the force of which their rubbing loads are multiples, N.
    """

    side: Array
    moment: Array
    size: Array


class _Way(Protocol):
    """Load of the cam on the stem at fixed positions, one motion after another.

    overhang (n,): of the roller, m; reach (n,): by which another one is farther from the guides, m;
    sense (n,): 1, or -1 where the sides of the guides are changed
    over; bracket: least and greatest value of the unknown of `balanced`, and one to start from.
    """

    @property
    def overhang(self) -> Array: ...
    @property
    def reach(self) -> Array: ...
    @property
    def sense(self) -> Array: ...
    @property
    def bracket(self) -> tuple[Array, Array, Array]: ...
    def on_guides(self, unknown: Array, at: NDArray[np.intp]) -> _OnGuides:
        """Load at unknowns (k,) and the indices of their positions."""

    def balance(self, rubs: Array, at: NDArray[np.intp]) -> Array:
        """Unknowns (k,) in equilibrium with a friction of the guides over the size of the load."""


@dataclass(frozen=True, eq=False)
class _OneTrack:
    """Stem under the track that carries: the unknown is the axial force on it, N, >= 0.

    The guides are alike on both sides.
    """

    overhang: Array
    push: Push
    sense: Array
    slope: Array
    force: Array
    lock: Array
    on_points: Array

    @classmethod
    def of(
        cls, strokes: Sequence[MovingFollower], points: Sequence[Loads], required: Array
    ) -> _OneTrack:
        """Of motions and their loads on point supports; required (n,): axial force without
        friction, N.
        """
        ways = [
            Push.of(s.pitch, s.system, s.theta, each.wall)
            for s, each in zip(strokes, points, strict=True)
        ]
        side = np.concatenate([way.side for way in ways])
        arm = np.concatenate([np.broadcast_to(way.arm, way.side.shape) for way in ways])
        wall = np.concatenate([each.wall for each in points])
        return cls(
            overhang=np.concatenate([each.overhang for each in points]),
            push=Push(side, arm, ways[0].spacing),
            sense=wall,
            slope=np.concatenate([each.driving_slope for each in points]),
            force=required * wall,
            lock=np.concatenate([np.broadcast_to(each.lock, each.theta.shape) for each in points]),
            on_points=np.concatenate([each.axial_force for each in points]) * wall,
        )

    @property
    def reach(self) -> Array:
        return np.zeros_like(self.overhang)

    @property
    def bracket(self) -> tuple[Array, Array, Array]:
        free = self.force / share_left(self.slope, np.zeros_like(self.slope), self.lock)
        outward = self.slope > 0.0
        high = np.where(outward, self.force / JAM_FLOOR, free)
        return np.where(outward, free, 0.0), high, np.where(outward, free, self.on_points)

    def on_guides(self, unknown: Array, at: NDArray[np.intp]) -> _OnGuides:
        push = self.push
        side, moment = unknown * push.side[at], unknown * push.arm[at]
        return _OnGuides(side, moment, unknown * push.side_factor[at])

    def balance(self, rubs: Array, at: NDArray[np.intp]) -> Array:
        jam = rubs * self.push.side_factor[at]
        return np.asarray(self.force[at] / share_left(self.slope[at], jam, self.lock[at]))


@dataclass(frozen=True, eq=False)
class _BothTracks:
    """Stem between two preloaded tracks: the unknown is the friction of the guides, N, >= 0."""

    overhang: Array
    sides: tuple[Array, Array]
    reach: Array
    squeeze: Squeezed
    direction: Array
    force: Array
    on_points: Array

    @classmethod
    def of(
        cls, strokes: Sequence[MovingFollower], points: Sequence[Loads], required: Array
    ) -> _BothTracks:
        """As `_OneTrack.of`."""
        pairs = [sides_of(s.pitch, s.system, s.theta) for s in strokes]
        squeezes = [s.system.squeezed(s.pitch, s.theta) for s in strokes]
        near, far = (np.concatenate([sides[k] for sides, _ in pairs]) for k in (0, 1))
        direction = np.sign(np.concatenate([each.lift_slope for each in points]))
        axial = np.concatenate([each.axial_force for each in points])
        overhangs = [
            s.system.overhang_at_max_lift + (s.pitch.lift.highest.value - each.lift)
            for s, each in zip(strokes, points, strict=True)
        ]
        return cls(
            overhang=np.concatenate(overhangs),
            sides=(near, far),
            reach=np.concatenate([reach for _, reach in pairs]),
            squeeze=Squeezed.joined([each for each in squeezes if each is not None]),
            direction=direction,
            force=required,
            on_points=direction * (axial - required),
        )

    @property
    def sense(self) -> Array:
        return np.ones_like(self.force)

    @property
    def bracket(self) -> tuple[Array, Array, Array]:
        preload, share, *_ = self.squeeze
        most = (np.abs(self.force) + preload / (share * (1.0 - share))) / JAM_FLOOR
        return np.zeros_like(most), most, self.on_points

    def on_guides(self, unknown: Array, at: NDArray[np.intp]) -> _OnGuides:
        near, far = self.sides
        forces = self.squeeze.part(at).forces(self.force[at] + self.direction[at] * unknown)
        loads = SideLoads.of((near[at], far[at]), self.reach[at], forces)
        return _OnGuides(loads.side, -np.sign(loads.side) * loads.far * loads.reach, loads.size)

    def balance(self, rubs: Array, at: NDArray[np.intp]) -> Array:
        near, far = (rubs * np.abs(side[at]) for side in self.sides)
        force, direction = self.force[at], self.direction[at]
        axial = PressedGuides(self.squeeze.part(at), (near, far))(force, direction)
        return np.asarray(direction * (axial - force))


def balanced(
    mapping: FixedPointMap, low: Array, high: Array, start: Array, round_off: Array | float = 0.0
) -> tuple[Array, int]:
    """Fixed points x = f(x) of continuous functions, each in a bracket.

    With f(low) >= low and f(high) <= high: secant steps within the bracket. Where a step does not
    halve the residual, bisection, once a value with f(x) < x bounds the bracket from above; until
    then steps increase x, by the secant or to f(x).

    Parameters
    ----------
    mapping : function  f of values (k,) and their positions (k,) in the arrays
    low, high : array (n,)
    start : array (n,)
    round_off : array (n,)   difference |x - f(x)| that counts as none

    Returns
    -------
    x : array (n,)    with |x - f(x)| <= 1e-2 of `RESIDUAL` of x, after 40 rounds 1e-1
    rounds : int      calls of the function

    Raises
    ------
    ContactError
        If 100 rounds do not converge.
    """
    x, low, high = np.clip(start, low, high), low.copy(), high.copy()
    least = np.broadcast_to(round_off, x.shape)
    before, missed = np.full_like(x, np.nan), np.full_like(x, np.inf)
    bounded = np.zeros(x.shape, dtype=bool)
    at = np.flatnonzero(high > 0.0)
    x[high <= 0.0] = 0.0
    for rounds in range(_ROUNDS_MAX):
        if not at.size:
            return x, rounds
        now, value = x[at], mapping(x[at], at)
        miss = now - value
        share = (
            _RESIDUAL_SHARE if rounds < _CLIMB else 10.0 * _RESIDUAL_SHARE
        )  # the guides have round-off as well
        open_ = np.abs(miss) > np.maximum(share * RESIDUAL * value, least[at])
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

    def __init__(
        self, stem: Stem, guides: GuidePair, knots: int, points: Sequence[Loads], way: _Way
    ) -> None:
        """Prepare the stem as a beam in its guides, with the loads of point supports as the start.

        Parameters
        ----------
        stem : Stem          that bends
        guides : GuidePair   of finite length
        knots : int          per guide
        points : sequence    loads of each motion on point supports
        way : _Way           load of the cam on the stem at all positions
        """
        self.line, _, half_a = bearing_line(stem, guides, knots)
        self.reach = way.overhang - half_a
        on_points = [(each.rubbing_a, each.rubbing_b) for each in points]
        self.on_points = np.concatenate(on_points, axis=1)
        self.last_factors = self.on_points.copy()
        self.knots, self.way = knots, way
        count, size = self.reach.size, self.line.positions.size
        self.pushes, self.rigid = np.zeros((size, count)), np.zeros((2, count))
        self.started = False

    def factors(self, unknown: Array, at: NDArray[np.intp]) -> Array:
        """Sums of the normal forces in guides A and B over the size of their load (2, k); those of
        point supports where unloaded.

        Parameters
        ----------
        unknown : array (k,)   of the load, see `_Way`
        at : array (k,)        indices of the positions
        """
        start = (self.pushes[:, at], self.rigid[:, at]) if self.started else None
        side, moment, size = self.way.on_guides(unknown, at)
        pushes, rigid = settle(self.line, side, moment - side * self.reach[at], start)
        self.pushes[:, at], self.rigid[:, at] = pushes, rigid
        self.started = True
        rubbed = np.abs(pushes).reshape(2, self.knots, -1).sum(axis=1)
        factors: Array = np.divide(rubbed, size, out=self.on_points[:, at], where=size > 0.0)
        self.last_factors[:, at] = factors
        return factors


def _residual(
    system: FollowerSystem, free: Array, loads: Loads, reactions: GuideReactions
) -> Array:
    """Residual (n,) of the axial equilibrium with the friction of the guides, over the axial force;
    0 where the axial force is bounded by jamming.

    Parameters
    ----------
    system : FollowerSystem      friction coefficients
    free : array (n,)            axial force without friction, N
    loads : Loads                with the axial force
    reactions : GuideReactions   with the rubbing loads
    """
    rubs = (
        system.friction_a * reactions.rubbing_load_a + system.friction_b * reactions.rubbing_load_b
    )
    rubs = np.sign(loads.lift_slope) * (rubs + loads.pivot_friction)
    miss = loads.axial_force - rubs - loads.lock * loads.axial_force - free
    if system.held:
        miss = np.where(np.abs(miss) > 10.0 * _HELD_ROUND_OFF, miss, 0.0)
    push = np.where(loads.bounded, 0.0, loads.stem_force * loads.wall)
    return np.divide(np.abs(miss), push, out=np.zeros_like(miss), where=push > 0.0)
