"""Forces on a translating follower whose guides rub."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Values, finite, freeze
from camwright.geometry.errors import InputError
from camwright.geometry.follower_path import FollowerPath
from camwright.pipeline.follower.spring import Spring

REST = 1e-9  # of the stroke per radian: what a spline leaves of the slope of a dwell
JAM_FLOOR = 0.01  # least share of the cam's push that friction is let to leave over


@dataclass(frozen=True, eq=False)
class Rubbing:
    """Load that rubs in guides A and B over the lean of the push, at cam angles; each (n,).

    The load sums the pushes of both sides of a bore, so that friction is its mu-fold.
    """

    theta: Array
    a: Array
    b: Array

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta, a=self.a, b=self.b)

    def at(self, theta: Array) -> tuple[Array, Array]:
        """The same at other angles, straight lines between."""
        a, b = (np.interp(theta, self.theta, share, period=FULL_TURN) for share in (self.a, self.b))
        return np.asarray(a), np.asarray(b)


@dataclass(frozen=True, eq=False)
class Push:
    """How the cam pushes on the stem, per unit of the push's axial part; arrays (n,).

    side : force across the stem, signed like the pressure angle
    arm : way of the push's line from the stem's axis, m; it turns the stem the other way
    spacing : between the guides, m
    """

    side: Array
    arm: Array
    spacing: float

    @classmethod
    def of(cls, pitch: FollowerPath, system: FollowerSystem, theta: Array) -> Push:
        """Through a roller's centre, or on a face beside the axis and dragged by its friction."""
        side = np.tan(pitch.pressure_angle(theta)) + system.face_friction
        return cls(side, pitch.push_arm(theta), system.guide_spacing)

    @property
    def lean(self) -> Array:
        """What presses the stem aside: side force and couple over the guides' spacing, >= 0."""
        return np.asarray(np.abs(self.side) + np.abs(self.arm) / self.spacing)

    def on_points(self, factor_a: Array, factor_b: Array) -> tuple[Array, Array]:
        """Reactions of point supports that answer a side force with these factors of it."""
        tilt = self.arm / self.spacing
        return self.side * factor_a - tilt, self.side * factor_b - tilt


@dataclass(frozen=True)
class FollowerSystem:
    """Spring, mass and rubbing guides of a follower.

    Parameters
    ----------
    mass : float                    moving mass, kg, >= 0
    spring : Spring                 its force over the lift
    guide_spacing : float           b, between the centres of guides A and B, m, > 0
    overhang_at_max_lift : float    a, roller centre to centre of A at the largest lift, m, >= 0
    friction_a, friction_b : float  Coulomb coefficients, >= 0
    gravity_along_axis : float      the part of g that presses the follower on the cam, m/s2
    viscous_damping : float         c3 of the guides, N s/m, >= 0
    face_friction : float           of a flat face sliding on the cam, >= 0; 0: a roller
    rubbing : Rubbing               of guides of finite length, see `guided_loads`; None: of guides
                                    that support the stem at a point

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
    viscous_damping: float = 0.0
    face_friction: float = 0.0
    rubbing: Rubbing | None = None

    def __post_init__(self) -> None:
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

    def guide_factors(self, overhang: ArrayLike) -> tuple[Array, Array]:
        """|A|/F_t and |B|/F_t, see `levers`."""
        return levers(np.asarray(overhang, dtype=float), self.guide_spacing)

    def friction_factor(self, overhang: ArrayLike) -> Array:
        """c = [mu_A (a+b) + mu_B a]/b, friction per unit of side force on point supports."""
        factor_a, factor_b = self.guide_factors(overhang)
        return self.friction_a * factor_a + self.friction_b * factor_b

    def rubs(self, push: Push, overhang: Array, theta: Array) -> tuple[Array, Array]:
        """What guides A and B rub with over the push's lean, as given or on points."""
        if self.rubbing is None:
            return self.rubbing_on_points(push, overhang)
        return self.rubbing.at(theta)

    def rubbing_on_points(self, push: Push, overhang: Array) -> tuple[Array, Array]:
        """What guides A and B that support the stem at points rub with, over the push's lean."""
        factors = self.guide_factors(overhang)
        on_a, on_b = (
            np.divide(np.abs(load), push.lean, out=factor.copy(), where=push.lean > 0.0)
            for load, factor in zip(push.on_points(*factors), factors, strict=True)
        )
        return on_a, on_b


@dataclass(frozen=True, eq=False)
class Loads:
    """Everything that acts on the follower at each cam angle; arrays (n,), SI.

    `tangential_force` is the side force on the stem, signed like the pressure angle;
    `end_moment` turns the stem from its axis towards it, N m: the push of a face beside the axis.
    The reactions are those of point supports and carry the sign of the side force although A
    pushes against it and B with it. The friction forces are magnitudes and oppose `velocity`;
    `viscous_force` is signed like it and opposes it too. `rubbing_*` is the load that rubs over
    the lean of the push, for a roller |tan alpha|, and `jam_index` the guides' friction over the
    axial push; where the follower moves outward it must stay below 1, elsewhere it tells of a cam
    that is turned backwards. `jam_index_statics` is that of point supports. `sliding_torque` is
    what of the cam's torque drags the cam along a face.
    """

    theta: Array
    lift: Array
    pressure_angle: Array
    overhang: Array
    velocity: Array
    acceleration: Array
    spring_force: Array
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

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def rubbing(self) -> Rubbing:
        """What the guides rub with over the lean of the push, over the turn."""
        return Rubbing(self.theta, self.rubbing_a, self.rubbing_b)

    @property
    def separated(self) -> NDArray[np.bool_]:
        """Where nothing presses the follower on the cam (bool): its forces there are zero."""
        return np.asarray(self.normal_force <= 0.0)

    @property
    def jammed(self) -> NDArray[np.bool_]:
        """Where the follower moves outward and no finite force could push it (bool)."""
        return np.asarray((self.jam_index >= 1.0) & (self.lift_slope > 0.0))

    @property
    def friction_force(self) -> Array:
        """Axial friction of both guides, N, >= 0."""
        return np.asarray(self.friction_force_a + self.friction_force_b)

    @property
    def friction_loss(self) -> float:
        """Heat of both guides, and of a face, over one cam turn, J."""
        rubbing = self.friction_force * np.abs(self.lift_slope) + self.sliding_torque
        return turn_integral(self.theta, rubbing + self.viscous_force * self.lift_slope)

    @property
    def cam_work(self) -> float:
        """Work the cam gives to the follower over one turn, J; the friction loss, nothing else."""
        return turn_integral(self.theta, self.cam_torque)


def turn_integral(theta: Array, values: Array) -> float:
    """Integral of a periodic quantity over one turn, by the trapezoidal rule.

    Spectrally accurate for smooth values on uniform angles.

    Raises
    ------
    InputError
        If the angles do not rise strictly within one turn.
    """
    steps = np.diff(theta, append=theta[0] + FULL_TURN)
    if not (steps > 0.0).all():
        raise InputError("theta", float(theta[np.argmin(steps)]), "rising within one turn")
    return float(np.sum(0.5 * (steps + np.roll(steps, 1)) * values))


def jump_speed(
    pitch: FollowerPath, system: FollowerSystem, theta: ArrayLike
) -> tuple[float, float]:
    """Least constant cam speed at which the follower leaves the cam, and where it does.

    sqrt((P + k s + m g) / (-m s'')), least over the angles with s'' < 0.

    Parameters
    ----------
    pitch : FollowerPath
    system : FollowerSystem
    theta : array (n,)   cam angles, rad

    Returns
    -------
    speed : float   rad/s; infinite where nothing would throw the follower off
    theta : float   rad; NaN in that case

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15: follower jump.
    """
    theta = finite("theta", theta)
    lift, _, bend = pitch.lift.derivatives(theta, 2)
    hold = system.spring.force(lift) + system.mass * system.gravity_along_axis
    throw = -system.mass * bend
    square = np.divide(
        np.maximum(hold, 0.0), throw, out=np.full_like(throw, np.inf), where=throw > 0.0
    )
    first = int(np.argmin(square))
    if not np.isfinite(square[first]):
        return np.inf, np.nan
    return float(np.sqrt(square[first])), float(theta[first])


def share_left(lift_slope: Array, jam_index: Array) -> Array:
    """Share of the cam's axial push that friction leaves over: above 1 on the way back."""
    share = 1.0 - np.sign(lift_slope) * jam_index
    return np.where(share < JAM_FLOOR, JAM_FLOOR, share)  # NaN stays


def levers(overhang: Values, guide_spacing: float) -> tuple[Values, Values]:
    """|A|/F_t = (a+b)/b and |B|/F_t = a/b of a stem on two point supports.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256, eqs 11-14.
    """
    ratio = overhang / guide_spacing
    return 1.0 + ratio, ratio


def follower_loads(
    pitch: FollowerPath,
    system: FollowerSystem,
    cam_speed: ArrayLike,
    theta: ArrayLike,
    cam_acceleration: ArrayLike = 0.0,
) -> Loads:
    r"""Forces on the follower, guide friction included, at given cam angles.

    The cam's push has the axial part F_a and the side part F_t = F_a tan(alpha). The side part
    loads the guides, which answer with c |F_t| of friction against the motion; F_a must overcome
    it on the way out and is spared it on the way back:

        F_a = F + sign(v) c |F_t|    hence    F_a = F / (1 - sign(v) c |tan(alpha)|)

    with F = P + k s + m (a + g) + c3 v. A flat face is pushed along the stem, at s' - e off its
    axis, and dragged along itself by mu F_a, always the way the cam's surface goes: on the guides
    the side force mu F_a and the couple (s' - e) F_a act, and mu F_a (r + s) is a torque the cam
    has to pay. With an offset the side force and the motion have
    independent signs; in a dwell friction is taken as zero. F <= 0 means that the follower has
    left the cam: every cam and guide force is then zero, and the spring and inertia forces tell
    of the motion the cam asks for. Close to jamming the denominator is held at `JAM_FLOOR`, so
    that the forces stay finite and `jam_index` alone tells of the jam. Small terms left out: the
    couple of the friction forces about the stem's axis, rolling friction.

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
    speed = _forward(cam_speed, theta)
    lift, slope, bend = pitch.lift.derivatives(theta, 2)
    slope = np.where(np.abs(slope) > REST * pitch.lift.stroke, slope, 0.0)
    acceleration = bend * speed**2 + slope * finite("cam_acceleration", cam_acceleration)
    spring_force = system.spring.force(lift)
    inertia_force = system.mass * acceleration
    viscous_force = system.viscous_damping * slope * speed
    weight = system.mass * system.gravity_along_axis
    demand = spring_force + inertia_force + weight + viscous_force

    pressure_angle = pitch.pressure_angle(theta)
    overhang = system.overhang_at_max_lift + (pitch.lift.highest.value - lift)
    push = Push.of(pitch, system, theta)
    on_points = push.on_points(*system.guide_factors(overhang))
    rubbing_a, rubbing_b = system.rubs(push, overhang, theta)
    jam_index = (system.friction_a * rubbing_a + system.friction_b * rubbing_b) * push.lean
    axial_force = np.maximum(demand, 0.0) / share_left(slope, jam_index)
    leaning = axial_force * push.lean
    friction_a = system.friction_a * rubbing_a * leaning
    friction_b = system.friction_b * rubbing_b * leaning
    sliding = system.face_friction * axial_force * pitch.height(theta)
    friction_power = (friction_a + friction_b) * np.abs(slope) + viscous_force * slope + sliding
    return Loads(
        theta=theta,
        lift=lift,
        lift_slope=slope,
        pressure_angle=pressure_angle,
        overhang=overhang,
        velocity=slope * speed,
        acceleration=acceleration,
        spring_force=spring_force,
        inertia_force=inertia_force,
        axial_force=axial_force,
        normal_force=axial_force / np.cos(pressure_angle),
        tangential_force=axial_force * push.side,
        friction_force_a=friction_a,
        friction_force_b=friction_b,
        reaction_a=axial_force * on_points[0],
        reaction_b=axial_force * on_points[1],
        cam_torque=axial_force * slope + sliding,
        jam_index=jam_index,
        friction_power=friction_power * speed,
        viscous_force=viscous_force,
        rubbing_a=rubbing_a,
        rubbing_b=rubbing_b,
        jam_index_statics=system.friction_a * np.abs(on_points[0])
        + system.friction_b * np.abs(on_points[1]),
        end_moment=axial_force * push.arm,
        sliding_torque=sliding,
    )


def _forward(cam_speed: ArrayLike, theta: Array) -> Array:
    """Cam speed at each angle, refused where the cam turns backwards."""
    speed = np.broadcast_to(finite("cam_speed", cam_speed), theta.shape)
    if (speed < 0.0).any():
        raise InputError("cam_speed", float(speed.min()), ">= 0 rad/s")
    return speed
