"""Forces on a translating follower with friction in its guides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Values, finite, freeze, readonly
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.follower_path import FollowerPath, Slide
from camwright.geometry.lift import Lift
from camwright.geometry.second_track import SecondFollower, SecondTrack, Touch, touch_of
from camwright.pipeline.base.external_force import NO_FORCE, ExternalForce
from camwright.pipeline.follower.disc_preload import DiscPreload, Squeezed
from camwright.pipeline.follower.pivot_forces import ArmPivot, PivotBalance, Pressed, Pull
from camwright.pipeline.follower.rocker import RockerOutput
from camwright.pipeline.follower.spring import Spring

REST = 1e-9  # slope over stroke, 1/rad, up to which a spline is in a dwell
_DWELLS = 1e-4, 3e-3  # of greatest slope and inertia: those of a spline in a dwell
LEAVES, LOCKS = "leaves the cam", "locks"
JAM_FLOOR = 0.01  # lower bound of 1 - jam index in the forces


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Friction-relevant load of each guide over axial force and side-load factor, (n,).

    The rubbing load is the sum of the normal forces on both sides of a bore; friction is mu times
    the rubbing load.
    """

    theta: Array
    a: Array
    b: Array

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, a=self.a, b=self.b)

    def at(self, theta: Array) -> tuple[Array, Array]:
        """Loads interpolated linearly at other cam angles."""
        a, b = (np.interp(theta, self.theta, share, period=FULL_TURN) for share in (self.a, self.b))
        return np.asarray(a), np.asarray(b)


@dataclass(frozen=True, eq=False)
class Push:
    """Load of the cam on the stem per unit axial force: side force and lever arm, (n,).

    side : side force, signed like the pressure angle
    arm : distance of the axial force from the stem axis, m; its couple is opposite to `side`
    spacing : of the guides, m
    """

    side: Array
    arm: Array
    spacing: float | Array

    @classmethod
    def of(cls, pitch: FollowerPath, system: FollowerSystem, theta: Array, wall: Array) -> Push:
        """Load through the roller centre, or of a face beside the stem axis with its friction.

        wall : array (n,)   track that carries, see `wall_of`
        """
        return Carried.at(pitch, system, theta, wall).push

    @property
    def side_factor(self) -> Array:
        """Side-load factor: |F_t|/F_a + |M|/(F_a b), >= 0."""
        return np.asarray(np.abs(self.side) + np.abs(self.arm) / self.spacing)

    def on_points(self, factor_a: Array, factor_b: Array) -> tuple[Array, Array]:
        """Reactions of point supports over the axial force, from factors of the side force."""
        tilt = self.arm / self.spacing
        return self.side * factor_a - tilt, self.side * factor_b - tilt

    def rubbing_on_points(self, overhang: Array) -> tuple[Array, Array]:
        """Rubbing load of point supports A and B over axial force and side-load factor."""
        factors, loaded = levers(overhang, self.spacing), self.side_factor
        on_a, on_b = (
            np.divide(np.abs(load), loaded, out=factor.copy(), where=loaded > 0.0)
            for load, factor in zip(self.on_points(*factors), factors, strict=True)
        )
        return on_a, on_b


class LoadEnds(NamedTuple):
    """End of the valid loads of many followers (...): whether, index, whether by take-off."""

    lost: NDArray[np.bool_]
    first: NDArray[np.intp]
    leaves: NDArray[np.bool_]


@dataclass(frozen=True)
class FollowerSystem:
    """Spring, moving mass and guide friction of a follower.

    Parameters
    ----------
    mass : float                    moving mass, kg, >= 0
    spring : Spring                 spring force over the lift
    guide_spacing : float           b, between the middles of guides A and B, m, > 0
    overhang_at_max_lift : float    a, roller centre to middle of A at maximum lift, m, >= 0
    friction_a, friction_b : float  Coulomb coefficients, >= 0
    gravity_along_axis : float      component of g towards the cam, m/s2
    external : ExternalForce        of the machine on the follower, towards the cam
    viscous_damping : float         c3 of the guides, N s/m, >= 0
    face_friction : float           of a flat face sliding on the cam, >= 0; 0: a roller
    rubbing : Rubbing               of guides of finite length, see `guided_loads`; None: of
                                    point supports
    pivot : ArmPivot                of an arm; None: of none, or of one without friction and weight
    held : bool                     the cam pulls the follower, too, as by the walls of a groove
    output : RockerOutput           that a rocker moves, its mass at zero lift part of `mass`; None
    second : SecondFollower           by which it pulls on a track of its own; None: the same roller
                                    does, if any
    preload : DiscPreload           of both tracks; None: they have a clearance

    Raises
    ------
    InputError
        If a value is out of these bounds; NaN included.
    """

    mass: float
    spring: Spring
    guide_spacing: float
    overhang_at_max_lift: float
    friction_a: float
    friction_b: float
    gravity_along_axis: float = 0.0
    external: ExternalForce = NO_FORCE
    viscous_damping: float = 0.0
    face_friction: float = 0.0
    rubbing: Rubbing | None = None
    pivot: ArmPivot | None = None
    held: bool = False
    output: RockerOutput | None = None
    second: SecondFollower | None = None
    preload: DiscPreload | None = None

    def __post_init__(self) -> None:
        """Refuse a spacing that is not positive, a negative mass, overhang, friction or damping,
        and a preload that is not positive of a cam that does not pull.
        """
        if not (self.held or self.spring.preload > 0.0):
            raise InputError(
                "spring.preload", self.spring.preload, "> 0 N of a cam that only pushes"
            )
        if not 0.0 < self.guide_spacing < np.inf:
            raise InputError("follower.guide_spacing", self.guide_spacing, "> 0 m")
        for name, unit in (
            ("mass", "kg"),
            ("overhang_at_max_lift", "m"),
            ("friction_a", ""),
            ("friction_b", ""),
            ("viscous_damping", "N s/m"),
            ("face_friction", ""),
        ):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"follower.{name}", getattr(self, name), f">= 0 {unit}".rstrip())
        finite("follower.gravity_along_axis", self.gravity_along_axis)

    def spring_force(self, lift: Array) -> Array:
        """Force (..., n) of the spring at a lift, N."""
        return self.spring.force(lift)

    def inertia_force(self, lift: Array, velocity: Array, acceleration: Array) -> Array:
        """Inertia force (..., n), N, of the moving mass and, with a rocker, of its output reduced
        by the ratio at the lift.

        Parameters
        ----------
        lift, velocity, acceleration : array (..., n)   of the follower, m, m/s, m/s2
        """
        force = self.mass * acceleration
        if self.output is None:
            return np.asarray(force)
        return np.asarray(force + self.output.inertia(lift, velocity, acceleration))

    def moving_mass(self, lift: Array) -> Array:
        """Mass (...), kg, by the kinetic energy at a lift."""
        beyond = 0.0 if self.output is None else self.output.moving_mass(lift)
        return np.asarray(self.mass + beyond + 0.0 * lift)

    def applied_force(self, theta: Array, lift: Array) -> Array:
        """Weight and external force at cam angles and lifts (n,), N, positive towards the cam."""
        if self.pivot is None:
            return self.load.at(theta)
        return self.pivot.applied(self.external.at(theta), self.pivot.direction(lift))

    @property
    def load(self) -> ExternalForce:
        """Weight and external force over the cam angle, N, towards the cam; of an arm at zero
        lift.
        """
        if self.pivot is None:
            return self.external.plus(self.mass * self.gravity_along_axis)
        force = self.pivot.applied(self.external.force, self.pivot.direction(0.0))
        return ExternalForce(self.external.theta, force)

    @property
    def dead_load(self) -> float:
        """Weight and mean external force, N, positive towards the cam; of an arm at zero lift."""
        return self.load.mean

    def with_friction(self, friction_a: float, friction_b: float) -> Self:
        """With other coefficients of friction of the guides; of an arm the first of its pivot."""
        if self.pivot is None:
            return replace(self, friction_a=friction_a, friction_b=friction_b)
        return replace(self, pivot=replace(self.pivot, friction=friction_a))

    def rubbing_factors(self, push: Push, overhang: Array, theta: Array) -> tuple[Array, Array]:
        """Rubbing load of guides A and B over axial force and side-load factor."""
        if self.rubbing is None:
            return push.rubbing_on_points(overhang)
        return self.rubbing.at(theta)

    def squeezed(self, pitch: FollowerPath, theta: Array) -> Squeezed | None:
        """Preload of both tracks at cam angles (n,), rad; None of tracks with a clearance."""
        track = self.second_track(pitch)
        return None if self.preload is None or track is None else self.preload.at(track, theta)

    def second_track(self, pitch: FollowerPath) -> SecondTrack | None:
        """Track under the second roller, by the path of the first; None without one."""
        return None if self.second is None else self.second.track(pitch)


class Carried(NamedTuple):
    """Contact of the track that carries at each cam angle (n,), over the axial force.

    reach: by which its roller, or the side load of both, is farther from the guides than the first,
    m; turned: its direction of travel from that of the first, rad
    """

    slide: Slide
    push: Push
    pressure_angle: Array
    reach: Array | float
    turned: Array

    @classmethod
    def at(cls, pitch: FollowerPath, system: FollowerSystem, theta: Array, wall: Array) -> Carried:
        """Contact at cam angles, on the track that carries there.

        Parameters
        ----------
        theta : array (n,)   cam angles, rad
        wall : array (n,)    1 where the first track carries, -1 where the second or outer one does,
                             see `wall_of`
        """
        touch, second = touch_of(pitch, theta, system.face_friction), system.second_track(pitch)
        reach: Array | float = 0.0
        if second is not None:
            pulls = wall < 0.0
            touch = _either(pulls, second.touch(theta, system.face_friction), touch)
            reach = np.asarray(second.reach * pulls)
        push = Push(touch.slide.side, touch.push_arm, system.guide_spacing)
        return cls(touch.slide, push, touch.pressure_angle, reach, touch.turned)

    def with_both(self, loads: SideLoads, wall: Array) -> Carried:
        """With the side load of both tracks of a stem, over the sum of their forces."""
        push = replace(self.push, side=loads.side / (wall * loads.force))
        far = np.divide(loads.far, loads.size, out=1.0 * (wall < 0.0), where=loads.size > 0.0)
        return self._replace(push=push, reach=loads.reach * far)


class SideLoads(NamedTuple):
    """Side loads of both tracks of a stem on its guides at cam angles (n,), N.

    Those of opposite rollers have one sign, (s' - e)(A_1/h_1 + A_2/h_2), A: force, h: height of a
    roller: they act on the guides like one load between the rollers.

    force: sum of the forces of both tracks along the travel; side: sum of their side loads, signed;
    size: its magnitude; far: magnitude of that of the second roller; reach: by which this is
    farther from the guides, m
    """

    force: Array
    side: Array
    size: Array
    far: Array
    reach: Array

    @classmethod
    def of(cls, sides: tuple[Array, Array], reach: Array, forces: tuple[Array, Array]) -> SideLoads:
        """Of forces of the first and of the second track (n,), N, >= 0; sides (2, n): side load of
        each over the axial force.
        """
        near, far = forces[0] * sides[0], -forces[1] * sides[1]
        size = np.abs(near) + np.abs(far)
        return cls(forces[0] + forces[1], near + far, size, np.abs(far), reach)


def _either(pulls: NDArray[np.bool_], second: Touch, first: Touch) -> Touch:
    """Contact of the second track where `pulls` (n,) holds, else that of the first."""
    pairs = zip(second.slide, first.slide, strict=True)
    slide = Slide(*(np.where(pulls, *pair) for pair in pairs))
    rest = zip(second[1:], first[1:], strict=True)
    return Touch(slide, *(np.where(pulls, *pair) for pair in rest))


@dataclass(frozen=True, eq=False, repr=False)
class Loads(Displayed):
    """Forces on the follower at each cam angle; arrays (n,), of many followers (..., n), SI.

    `applied_force`: weight and external force, positive towards the cam.
    `tangential_force`: side force on the stem, signed like the pressure angle; `end_moment`: couple
    of the axial force of a face beside the stem axis, N m, positive towards the side force.
    `reaction_*`: reactions of point supports, both with the sign of the side force, although A acts
    against it and B with it. `friction_force_*`: magnitudes, opposite to `velocity`;
    `viscous_force`: signed like `velocity`, opposite to it. `rubbing_*`: rubbing load over axial
    force and side-load factor, which for a roller is |tan alpha|. `jam_index`: friction of the
    guides over axial force; limit 1 where the follower moves outward, elsewhere that of a reversed
    cam. `jam_index_statics`: that of point supports. `sliding_torque`: cam torque of the friction
    of a face; `lock`: share that this friction takes of the axial force of an arm. `lever`: of the
    normal of a flat face over the length of the arm; `pressing`: contact force in the direction of
    the axial force over it. `travel`: that direction from the follower axis, counter-clockwise,
    rad, of an arm; 0 of a stem. `turned`: travel of the roller that carries from that of the first,
    rad. `pivot_load` (2, n): of the arm on its pivot, along and across the
    travel, and `pivot_friction` the moment of its friction over the length of the arm, a magnitude;
    0 of a stem. With a pivot `jam_index` is that over the axial force. `held`: the cam
    pulls the follower, too: the axial force is negative where it does, the normal force its
    magnitude. `second`: roller by which it does, whose pressure angle is that of its own travel. Of
    preloaded discs `idle_force` is the normal force on the one that bears less, and `pressed_along`
    the force of both along the travel beyond the axial force; 0 of others. `stem_force`: axial
    force, of preloaded discs on a stem the sum of the forces of both along the travel, with its
    sign, of which the jam index is a share; `side_load`: size of its load on the guides,
    side-load factor times force. `driving_jam`: jam index where the track that carries drives the
    follower against friction, negative where it does not; of preloaded discs on a stem that of the
    track that drives.
    """

    theta: Array
    lift: Array
    pressure_angle: Array
    overhang: Array
    velocity: Array
    acceleration: Array
    spring_force: Array
    applied_force: Array
    inertia_force: Array
    axial_force: Array
    normal_force: Array
    tangential_force: Array
    friction_force_a: Array
    friction_force_b: Array
    reaction_a: Array
    reaction_b: Array
    cam_torque: Array
    jam_index: Array
    friction_power: Array
    lift_slope: Array
    viscous_force: Array
    rubbing_a: Array
    rubbing_b: Array
    jam_index_statics: Array
    end_moment: Array
    sliding_torque: Array
    travel: Array = field(default_factory=lambda: readonly(0.0))
    lock: Array = field(default_factory=lambda: readonly(0.0))
    lever: Array = field(default_factory=lambda: readonly(1.0))
    pressing: Array = field(default_factory=lambda: readonly(1.0))
    pivot_load: Array = field(default_factory=lambda: readonly(np.zeros((2, 1))))
    pivot_friction: Array = field(default_factory=lambda: readonly(0.0))
    turned: Array = field(default_factory=lambda: readonly(0.0))
    idle_force: Array = field(default_factory=lambda: readonly(0.0))
    pressed_along: Array = field(default_factory=lambda: readonly(0.0))
    stem_force: Array = field(default_factory=lambda: readonly(0.0))
    side_load: Array = field(default_factory=lambda: readonly(0.0))
    driving_jam: Array = field(default_factory=lambda: readonly(0.0))
    held: bool = False
    second: SecondFollower | None = None

    def __post_init__(self) -> None:
        arrays = (name for name in self.__dataclass_fields__ if name not in ("held", "second"))
        freeze(self, **{name: getattr(self, name) for name in arrays})

    @property
    def rubbing(self) -> Rubbing:
        """Rubbing load of the guides over axial force and side-load factor, over the turn."""
        return Rubbing(self.theta, self.rubbing_a, self.rubbing_b)

    @property
    def on_shaft(self) -> Array:
        """Contact force on the follower (2, n), N, along the follower axis and across it.

        That axis is the one of a stem, or runs from the cam axis to the pivot of an arm.
        """
        cos, sin = np.cos(self.travel), np.sin(self.travel)
        along = self.axial_force * self.pressing + self.pressed_along
        across = self.tangential_force
        return np.stack([along * cos + across * sin, across * cos - along * sin])

    @property
    def closing_force(self) -> Array:
        """Spring, weight and external force, N: towards the cam, the follower at rest."""
        return np.asarray(self.spring_force + self.applied_force)

    @property
    def required_force(self) -> Array:
        """Axial force without guide friction, N; negative where the cam would have to pull.

        The preload less its minimum is the preload at which the follower stays on the cam.
        """
        return np.asarray(self.closing_force + self.inertia_force + self.viscous_force)

    @property
    def seat_torque(self) -> Array:
        """Torque that the seat of a disc bears (n,), N m: that of the cam, or that of the preloaded
        disc that bears more.
        """
        if not self.idle_force.any():
            return self.cam_torque
        along = self.normal_force * self.lever * np.cos(self.pressure_angle)
        beyond = self.wall * along - self.axial_force
        return np.asarray(self.cam_torque + beyond * self.lift_slope)

    @property
    def frictionless_force(self) -> Array:
        """Axial force without guide friction, N; 0 where the follower leaves the cam."""
        required = self.required_force
        return required if self.held else np.asarray(np.maximum(required, 0.0))

    @property
    def signed_force(self) -> Array:
        """Force whose sign says which track carries, N: without friction of guides, which does not
        change it, and with that of a pivot or under a preload, which does.
        """
        rubbed = self.pivot_friction.any() or self.idle_force.any()
        return self.axial_force if rubbed else self.required_force

    @property
    def wall(self) -> Array:
        """Track that carries: 1 the first or inner wall, which pushes outward, -1 the second or
        outer.
        """
        return wall_of(self.signed_force, held=self.held)

    @property
    def track_forces(self) -> tuple[Array, Array]:
        """Normal force on the first and on the second of two tracks (n,), N, >= 0."""
        force, pulls = np.maximum(self.normal_force, 0.0), self.wall < 0.0
        return np.where(pulls, self.idle_force, force), np.where(pulls, force, self.idle_force)

    @property
    def normal_direction(self) -> Array:
        """Angle of the contact normal from the follower axis, clockwise, rad."""
        return np.asarray(self.pressure_angle - self.travel - self.turned)

    @property
    def driving_slope(self) -> Array:
        """Slope of the lift, m/rad, > 0 where the cam drives the follower against friction."""
        return np.asarray(self.lift_slope * self.wall)

    @property
    def separated(self) -> NDArray[np.bool_]:
        """Where the follower has no contact with the cam (n,), bool; the forces are zero."""
        return np.asarray((self.normal_force <= 0.0) & (not self.held))

    @property
    def jammed(self) -> NDArray[np.bool_]:
        """Where the follower jams at any force (n,), bool; in guides where the cam drives it."""
        return np.asarray(self.driving_jam + self.lock >= 1.0)

    @property
    def share(self) -> Array:
        """Ratio of the axial force without friction to that with it, see `share_left`."""
        return share_left(1.0, self.driving_jam, self.lock)

    @property
    def bounded(self) -> NDArray[np.bool_]:
        """Where friction bears so much that the forces are bounded, not in equilibrium (n,)."""
        return np.asarray(self.share <= JAM_FLOOR)

    @property
    def ends(self) -> LoadEnds:
        """First angles at which followers leave the cam or lock; the loads end there.

        The angle is the first one of the turn at which one of both begins: the loads of a turn
        before it are those after it in the next one.
        """
        return ends_of(self.separated, self.jammed)

    @property
    def end(self) -> tuple[float, str] | None:
        """Cam angle, rad, where the loads of a single follower end, and why; None: nowhere.

        Where it leaves the cam, the zero of the line through the forces before and after.
        """
        lost, first, leaves = self.ends
        if not lost:
            return None
        theta = float(self.theta[first])
        if not leaves:
            return theta, LOCKS
        before, after = self.required_force[first - 1], self.required_force[first]
        step = float((self.theta[first] - self.theta[first - 1]) % FULL_TURN)
        back = after / (after - before) if after < 0.0 < before else 0.0
        return (theta - float(back) * step) % FULL_TURN, LEAVES

    @property
    def friction_force(self) -> Array:
        """Axial friction of both guides, or of the pivot of an arm, N, >= 0."""
        return np.asarray(self.friction_force_a + self.friction_force_b + self.pivot_friction)

    @property
    def rubbed(self) -> Array:
        """Friction work of a face by the cam angle, N m."""
        return np.asarray(self.sliding_torque + self.lock * self.axial_force * self.lift_slope)

    @property
    def applied_work(self) -> float:
        """Work of the cam against weight and external force over a turn, J.

        That of the weight and of a constant force is zero.
        """
        return turn_integral(self.theta, self.applied_force * self.lift_slope)

    @property
    def friction_loss(self) -> float:
        """Friction loss of guides or pivot and of a face over one cam turn, J."""
        rubbing = self.friction_force * np.abs(self.lift_slope) + self.rubbed
        return turn_integral(self.theta, rubbing + self.viscous_force * self.lift_slope)


def ends_of(separated: NDArray[np.bool_], jammed: NDArray[np.bool_]) -> LoadEnds:
    """Where the valid loads of followers end: whether they do, index of the first position without
    valid loads, and whether by loss of contact rather than jamming, (...) each.

    Parameters
    ----------
    separated : array (..., n)   where contact is lost
    jammed : array (..., n)      where the follower jams
    """
    lost = separated | jammed
    first = np.argmax(lost & ~np.roll(lost, 1, axis=-1), axis=-1)
    leaves = np.take_along_axis(separated, first[..., None], axis=-1)[..., 0]
    return LoadEnds(np.asarray(lost.any(axis=-1)), first, leaves)


def turn_integral(theta: Array, values: Array) -> float:
    """Integral over one turn of a periodic quantity (n,) at angles (n,), rad, by the trapezoidal
    rule.

    Spectrally accurate for smooth values at equal angles.

    Raises
    ------
    InputError
        If the angles do not increase strictly within one turn.
    """
    steps = np.diff(theta, append=theta[0] + FULL_TURN)
    if not (steps > 0.0).all():
        raise InputError("theta", float(theta[np.argmin(steps)]), "increasing within one turn")
    return float(np.sum(0.5 * (steps + np.roll(steps, 1)) * values))


def axial_of_surge(
    pitch: FollowerPath, system: FollowerSystem, loads: Loads, surge: Array
) -> Array:
    """Change of the axial contact force (n,), N, friction included, by a surge of the spring.

    Parameters
    ----------
    pitch : FollowerPath      motion of the follower
    system : FollowerSystem   with the pivot of an arm, if any
    loads : Loads             without the surge
    surge : array (n,)        change of the spring force, N
    """
    pivot = system.pivot
    balance = in_guides(pitch, replace(system, rubbing=loads.rubbing), loads.theta)
    if balance is not None:
        demand = loads.required_force + surge
        return balance(demand, np.sign(loads.lift_slope)) - loads.axial_force
    if pivot is None:
        return np.asarray(surge / loads.share)
    pressed = Pressed.of(Carried.at(pitch, system, loads.theta, loads.wall).slide)
    along, across = loads.pivot_load - loads.axial_force * np.stack([pressed.along, pressed.across])
    added, direction = pivot.of_spring(surge, loads.travel), np.sign(loads.lift_slope)
    pull = Pull(along + added.along, across + added.across)
    whole_force = loads.required_force + surge
    return pivot.balanced(whole_force, pressed, pull, direction).axial - loads.axial_force


def wall_of(required: Values, *, held: bool) -> Array:
    """Wall of the cam that carries a required axial force (...): 1 the inner, -1 the outer.

    Of a cam that does not pull the inner one, its only one, everywhere. Guide friction does not
    move the change of the wall: it is in proportion to the force.
    """
    pulls = np.real(required) < 0.0 if held else np.zeros(np.shape(required), dtype=bool)
    return np.where(pulls, -1.0, 1.0)


class Carrying(NamedTuple):
    """Track that carries at equal cam angles of a turn (..., n), see `wall_of`, and weights of the
    angles, of mean 1, in a mean over the turn of what jumps where another track carries.
    """

    wall: Array
    weights: Array

    @classmethod
    def of(cls, force: Array, closing: Array, slope: Array) -> Carrying:
        """From the force whose sign says which track carries (..., n), N, its part without inertia
        and damping, which is all of it in a dwell, and the slope of the lift, m/rad.

        The weights are those of the trapezoidal rule of each step between two angles, in two parts
        where the force is zero between them, by a straight line: of second order in the step. At
        the end of a dwell, where the third derivative of the lift jumps, the line goes on from the
        motion beside it.
        """
        sizes = np.abs(slope), np.abs(force - closing)
        small = (
            each <= share * each.max(axis=-1, keepdims=True)
            for each, share in zip(sizes, _DWELLS, strict=True)
        )
        dwells = np.logical_and(*small)
        held = np.where(dwells, closing, force)
        before, after, later = (np.roll(held, shift, axis=-1) for shift in (1, -1, -2))
        wall = wall_of(held, held=True)
        start = np.where(dwells, 2.0 * after - later, held)
        change = start - np.where(np.roll(dwells, -1, axis=-1), 2.0 * held - before, after)
        part = np.full(wall.shape, 0.5)
        changes = (wall != np.roll(wall, -1, axis=-1)) & (change != 0.0)
        np.divide(start, change, out=part, where=changes)
        late = np.clip(part, 0.0, 1.0) - 0.5
        return cls(wall, np.asarray(1.0 + late - np.roll(late, 1, axis=-1)))


def share_left(lift_slope: Values | float, jam_index: Array, lock: Values | float = 0.0) -> Array:
    """Ratio of the axial force without friction to that with it, at least `JAM_FLOOR`.

    lock: of a face on an arm, see `Loads`
    """
    share = 1.0 - np.sign(lift_slope) * jam_index - lock
    return np.where(share < JAM_FLOOR, JAM_FLOOR, share)  # NaN stays


def levers(overhang: Values, guide_spacing: float | Array) -> tuple[Values, Values]:
    """Lever ratios |A|/F_t = (a+b)/b and |B|/F_t = a/b (...) of a stem on point supports.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256, eqs 11-14.
    """
    ratio = overhang / guide_spacing
    return 1.0 + ratio, ratio


class RequiredForce(NamedTuple):
    """Axial force without guide friction that a motion of the follower requires, by its parts, N,
    at cam angles (n,); see `Loads`.
    """

    theta: Array
    lift: Array
    lift_slope: Array
    acceleration: Array
    spring_force: Array
    applied_force: Array
    inertia_force: Array
    viscous_force: Array

    @classmethod
    def of(
        cls, system: FollowerSystem, lift: Lift, theta: Array, speed: Array, rate: Array
    ) -> RequiredForce:
        """Force at cam angles, cam speeds, rad/s, and accelerations, rad/s2, (n,)."""
        height, slope, bend = lift.derivatives(theta, 2)
        slope = np.where(np.abs(slope) > REST * lift.stroke, slope, 0.0)
        acceleration = bend * speed**2 + slope * rate
        return cls(
            theta,
            height,
            slope,
            acceleration,
            system.spring_force(height),
            system.applied_force(theta, height),
            system.inertia_force(height, slope * speed, acceleration),
            system.viscous_damping * slope * speed,
        )

    @property
    def resisting_force(self) -> Array:
        """Force without that of inertia, N."""
        return self.spring_force + self.applied_force + self.viscous_force

    @property
    def force(self) -> Array:
        return self.spring_force + self.applied_force + self.inertia_force + self.viscous_force


def follower_loads(
    pitch: FollowerPath,
    system: FollowerSystem,
    cam_speed: ArrayLike,
    theta: ArrayLike,
    cam_acceleration: ArrayLike = 0.0,
) -> Loads:
    r"""Forces on the follower at cam angles, with implicit guide friction.

    The contact force has the axial component F_a and the side force F_t = F_a tan(alpha). The side
    force loads the guides, whose friction c |F_t| opposes the motion: it increases F_a on the
    outward stroke and reduces it on the return:

        F_a = F + sign(v) c |F_t|    hence    F_a = F / (1 - sign(v) c |tan(alpha)|)

    with F = P + k s + F_e + m a + c3 v, F_e: weight and external force. On a flat face F_a acts
    along the stem at s' - e from its axis, and mu F_a along the face in the direction of the cam
    surface: the guides carry the side force mu F_a and the couple (s' - e) F_a, and the cam torque
    includes mu F_a (r + s). On a flat face along an arm F_a is that at its length l, N q / l with q
    the lever of the normal force N; friction takes mu N f of the moment with its lever f, and the
    axial force is F / (1 - sign(v) c |tan(alpha)| - mu f / q), see `Slide`. With an offset, side
    force and motion have independent signs; in a dwell friction is zero. F <= 0: loss of contact;
    all cam and guide forces are zero, spring and inertia force are those of the prescribed lift.
    The denominator is bounded below by `JAM_FLOOR`: close to jamming the forces stay finite, and
    `jam_index` alone indicates the jam. Neglected: the couple of the friction forces about the stem
    axis, the weight across it, rolling friction.

    The friction of the pivot of an arm depends on its whole load, see `ArmPivot.balanced`; where it
    holds the arm off the cam on the return the contact is lost.

    Under a preload of both rollers of a stem both side loads rub, those of the forces A_1 and A_2
    that `Squeezed` makes of F_a: F_a = F + sign(v) (c_1 A_1 + c_2 A_2), c: jam index of a track.

    Parameters
    ----------
    pitch : FollowerPath
    system : FollowerSystem
    cam_speed : float or array (n,)         d theta/dt, rad/s, >= 0; 0 is quasi-static
    theta : array (n,)                      cam angles, rad
    cam_acceleration : float or array (n,)  rad/s2

    Returns
    -------
    Loads

    Raises
    ------
    InputError
        If an angle or speed is not finite, or a speed is negative.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256, eqs 11-14, with friction made implicit; for c of
    guides of finite length see `guided_loads`. Rothbart, Cam Design Handbook (2004), ch. 6;
    Energy loss comparison between kinematically equivalent mechanisms: slider-crank and eccentric
    cam (2024), eq. 40 for c3.
    """
    theta = finite("theta", theta)
    rate, speed = finite("cam_acceleration", cam_acceleration), _forward(cam_speed, theta)
    required = RequiredForce.of(system, pitch.lift, theta, speed, rate)
    lift, slope, acceleration = required.lift, required.lift_slope, required.acceleration
    spring_force, applied_force = required.spring_force, required.applied_force
    inertia_force, viscous_force = required.inertia_force, required.viscous_force
    demand = required.force

    travel, pivot = pitch.travel(theta), system.pivot
    wall, swung, pull = wall_of(demand, held=system.held), None, None
    if pivot is not None:
        pull = pivot.pull(
            spring_force, system.external.at(theta), travel, slope * speed, acceleration
        )
        if system.held:
            swung, wall = _swung(pitch, system, theta)(demand, pull, np.sign(slope))
    guided = in_guides(pitch, system, theta)
    squeeze = system.squeezed(pitch, theta) if guided is None else guided.squeeze
    tracks = () if squeeze is None else _both_carried(pitch, system, theta)
    if guided is not None:
        guided_axial = guided(demand, np.sign(slope))
        wall = wall_of(guided_axial, held=True)
        both = SideLoads.of(*_sides(*tracks), guided.squeeze.forces(guided_axial))
    carrying = Carried.at(pitch, system, theta, wall)
    if guided is not None:
        carrying = carrying.with_both(both, wall)
    slide, push, pressure_angle = carrying.slide, carrying.push, carrying.pressure_angle
    overhang = system.overhang_at_max_lift + (pitch.lift.highest.value - lift) + carrying.reach
    on_points = push.on_points(*levers(overhang, system.guide_spacing))
    rubbing_a, rubbing_b = system.rubbing_factors(push, overhang, theta)
    jam_index = (system.friction_a * rubbing_a + system.friction_b * rubbing_b) * push.side_factor
    carried = demand if system.held else np.maximum(demand, 0.0)
    axial_force = carried / share_left(slope * wall, jam_index, slide.lock)
    pivot_load, pivot_friction = np.zeros((2, theta.size)), np.zeros(theta.size)
    if pivot is not None and pull is not None:
        pressed = Pressed.of(slide)
        held = swung or pivot.clipped(demand, pressed, pull, np.sign(slope), JAM_FLOOR)
        axial_force, jam_index, pivot_friction = held.axial, held.jam_index, held.friction
        pivot_load = np.stack(pressed.total(axial_force, pull))
    stem_force, driving_jam = axial_force, np.sign(slope * wall) * jam_index
    if guided is not None:
        axial_force, stem_force = guided_axial, wall * both.force
        driving_jam = driving(guided.jams, np.sign(slope))
    side_load = stem_force * wall * push.side_factor
    friction_a = system.friction_a * rubbing_a * side_load
    friction_b = system.friction_b * rubbing_b * side_load
    sliding = axial_force * slide.torque
    statics = system.friction_a * np.abs(on_points[0]) + system.friction_b * np.abs(on_points[1])
    friction = friction_a + friction_b + pivot_friction
    friction_power = friction * np.abs(slope) + viscous_force * slope + sliding
    friction_power = friction_power + slide.lock * axial_force * slope
    normal_force = axial_force * wall / (slide.lever * np.cos(pressure_angle))
    tangential_force = stem_force * push.side
    idle_force = pressed_along = np.zeros(theta.size)
    if squeeze is not None:
        forces = squeeze.forces(axial_force)
        along, across = (
            sum(sign * force * np.asarray(getattr(each.slide, name))
                for sign, force, each in zip((1.0, -1.0), forces, tracks, strict=True))
            for name in ("pressing", "side")
        )  # fmt: skip
        normal = [
            force / (each.slide.lever * np.cos(each.pressure_angle))
            for force, each in zip(forces, tracks, strict=True)
        ]
        normal_force, idle_force = (np.where(wall > 0.0, *each) for each in (normal, normal[::-1]))
        tangential_force, pressed_along = across, along - axial_force * slide.pressing
        if pivot is not None and pull is not None:
            pivot_load = np.stack([along + pull.along, across + pull.across])
    return Loads(
        theta=theta,
        lift=lift,
        lift_slope=slope,
        pressure_angle=pressure_angle,
        overhang=overhang,
        velocity=slope * speed,
        acceleration=acceleration,
        spring_force=spring_force,
        applied_force=applied_force,
        inertia_force=inertia_force,
        axial_force=axial_force,
        normal_force=normal_force,
        tangential_force=tangential_force,
        friction_force_a=friction_a,
        friction_force_b=friction_b,
        reaction_a=stem_force * on_points[0],
        reaction_b=stem_force * on_points[1],
        cam_torque=axial_force * slope + sliding,
        jam_index=jam_index,
        friction_power=friction_power * speed,
        viscous_force=viscous_force,
        rubbing_a=rubbing_a,
        rubbing_b=rubbing_b,
        jam_index_statics=jam_index if pivot is not None else statics,
        end_moment=stem_force * push.arm,
        sliding_torque=sliding,
        travel=travel,
        lock=np.asarray(slide.lock),
        lever=np.asarray(slide.lever),
        pressing=np.asarray(slide.pressing),
        pivot_load=pivot_load,
        pivot_friction=pivot_friction,
        turned=carrying.turned,
        idle_force=idle_force,
        pressed_along=pressed_along,
        stem_force=stem_force,
        side_load=side_load,
        driving_jam=driving_jam,
        held=system.held,
        second=system.second,
    )


def torque_on_cam(
    pitch: FollowerPath, system: FollowerSystem, theta: Array
) -> Callable[[Array, Array], Array]:
    """Function for the torque of spring, weight, external force and friction on the cam (n,), N m,
    by cam speed (n,), rad/s, and acceleration (n,), rad/s2.

    That of the inertia of the follower is left out; friction depends on the contact force and thus
    on the motion. As by `follower_loads`, without what does not change at the same cam angles.

    Parameters
    ----------
    pitch : FollowerPath      motion of the follower
    system : FollowerSystem   spring, mass, friction
    theta : array (n,)        cam angles, rad
    """
    still = follower_loads(pitch, system, 0.0, theta)
    slope, lift_d2 = still.lift_slope, pitch.lift.derivatives(theta, 2)[2]
    closing, lock = still.closing_force, still.lock
    external = system.external.at(theta)
    swung, guided = _swung(pitch, system, theta), in_guides(pitch, system, theta)
    pressed = _both_pressed(pitch, system, theta)
    walls = still.wall, -still.wall
    carrying = [Carried.at(pitch, system, theta, wall) for wall in walls]
    arms = [slope + each.slide.torque for each in carrying]
    jams = [still.jam_index, still.jam_index]
    if system.second is not None and system.pivot is None:
        jams[1] = jam_index(pitch, system, theta, walls[1])

    def torque(speed: Array, cam_acceleration: Array) -> Array:
        """Torque on the cam (n,), N m, at its speeds, rad/s, and accelerations, rad/s2, (n,)."""
        acceleration = lift_d2 * speed**2 + slope * cam_acceleration
        inertia_force = system.inertia_force(still.lift, slope * speed, acceleration)
        viscous_force = system.viscous_damping * slope * speed
        demand = closing + inertia_force + viscous_force
        wall = wall_of(demand, held=system.held)
        changed = wall != walls[0]
        jam, arm = np.where(changed, jams[1], jams[0]), np.where(changed, arms[1], arms[0])
        axial = (demand if system.held else np.maximum(demand, 0.0)) / share_left(
            slope * wall, jam, lock
        )
        if guided is not None:
            axial = guided(demand, np.sign(slope))
        if system.pivot is not None:
            pull = system.pivot.pull(
                still.spring_force, external, still.travel, slope * speed, acceleration
            )
            if system.held:
                axial = swung(demand, pull, np.sign(slope))[0].axial
            else:
                axial = system.pivot.clipped(
                    demand, pressed[0], pull, np.sign(slope), JAM_FLOOR
                ).axial
        return np.asarray(inertia_force * slope - axial * arm)

    return torque


def _both_carried(
    pitch: FollowerPath, system: FollowerSystem, theta: Array
) -> tuple[Carried, Carried]:
    """Contact of the first and of the second track at cam angles (n,)."""
    one = np.ones(theta.shape)
    return Carried.at(pitch, system, theta, one), Carried.at(pitch, system, theta, -one)


def _both_pressed(
    pitch: FollowerPath, system: FollowerSystem, theta: Array
) -> tuple[Pressed, Pressed]:
    """Contact forces of the first and of the second track at cam angles (n,)."""
    first, second = _both_carried(pitch, system, theta)
    return Pressed.of(first.slide), Pressed.of(second.slide)


def sides_of(
    pitch: FollowerPath, system: FollowerSystem, theta: Array
) -> tuple[tuple[Array, Array], Array]:
    """Side load of each track over the axial force at cam angles (n,), and by how much the second
    is farther from the guides (n,), m.
    """
    return _sides(*_both_carried(pitch, system, theta))


def _sides(first: Carried, second: Carried) -> tuple[tuple[Array, Array], Array]:
    """`sides_of` both tracks by their contacts."""
    return (first.push.side, second.push.side), np.asarray(second.reach)


class PressedGuides(NamedTuple):
    """Preload of both rollers of a stem (n,), and the jam index of each track (2, n)."""

    squeeze: Squeezed
    jams: tuple[Array, Array]

    def __call__(self, required: Array, direction: Array) -> Array:
        """Axial force (..., n), N, from the one without friction and the direction of the motion.

        direction (..., n): 1 on the rise, -1 on the return, 0 at rest

        While both tracks are pressed friction is linear in the axial force, else a share of it: of
        the three one holds, as the jam index of the track that drives is taken as
        1 - `JAM_FLOOR` at most.
        """
        squeeze, most = self.squeeze, 1.0 - JAM_FLOOR
        first, second = (
            np.where((np.real(way * direction) > 0.0) & (np.real(jam) > most), most, jam)
            for way, jam in zip((1.0, -1.0), self.jams, strict=True)
        )
        mixed = squeeze.share * first - (1.0 - squeeze.share) * second
        pressed = required + direction * squeeze.preload * (first + second)
        held, wall = pressed / (1.0 - direction * mixed), wall_of(required, held=True)
        alone = required / (1.0 - direction * wall * np.where(wall > 0.0, first, second))
        return np.where(squeeze.both(held), held, alone)


def driving(jams: tuple[Array, Array], direction: Array) -> Array:
    """Jam index (..., n) of the track of two that drives a follower; 0 at rest."""
    return np.where(direction > 0.0, jams[0], np.where(direction < 0.0, jams[1], 0.0))


def in_guides(pitch: FollowerPath, system: FollowerSystem, theta: Array) -> PressedGuides | None:
    """Guides of a stem whose rollers are preloaded at cam angles (n,); None of other followers."""
    squeeze, track = system.squeezed(pitch, theta), system.second_track(pitch)
    if squeeze is None or track is None or not track.reach:
        return None
    one = np.ones(theta.shape)
    first, second = (jam_index(pitch, system, theta, wall) for wall in (one, -one))
    return PressedGuides(squeeze, (first, second))


_Swung = Callable[[Array, Pull, Array], tuple[PivotBalance, Array]]


def _swung(pitch: FollowerPath, system: FollowerSystem, theta: Array) -> _Swung:
    """Equilibrium of an arm between its tracks at cam angles (n,), and the track that carries, by
    the required force, the pull and the direction of the motion.
    """
    pivot, squeeze = system.pivot, system.squeezed(pitch, theta)
    pressed = _both_pressed(pitch, system, theta)

    def balance(demand: Array, pull: Pull, direction: Array) -> tuple[PivotBalance, Array]:
        if pivot is None:
            raise InputError("follower.pivot", "missing", "given for its friction")
        if squeeze is None:
            return pivot.between(demand, pressed, pull, direction)
        return pivot.squeezed(demand, pressed, squeeze, pull, direction)

    return balance


def jam_index(pitch: FollowerPath, system: FollowerSystem, theta: Array, wall: Array) -> Array:
    """Jam index (n,) of the guides of a stem at cam angles: their friction over the axial force.

    Parameters
    ----------
    theta : array (n,)   cam angles, rad
    wall : array (n,)    1 where the first track carries, -1 where the second or outer one does, see
                         `wall_of`
    """
    carrying = Carried.at(pitch, system, theta, wall)
    overhang = pitch.lift.highest.value - pitch.lift(theta)
    overhang = system.overhang_at_max_lift + overhang + carrying.reach
    on_a, on_b = system.rubbing_factors(carrying.push, overhang, theta)
    jam: Array = system.friction_a * on_a + system.friction_b * on_b
    return jam * carrying.push.side_factor


def _forward(cam_speed: ArrayLike, theta: Array) -> Array:
    """Cam speed at each angle (n,), rad/s; InputError for a negative one."""
    speed = np.broadcast_to(finite("cam_speed", cam_speed), theta.shape)
    if (speed < 0.0).any():
        raise InputError("cam_speed", float(speed.min()), ">= 0 rad/s")
    return speed
