"""A follower on an elastic stem: periodic response, jump and landing, jump speed.

The cam moves the foot by s; a spring K with a damper c carries the mass m, whose way is x, and
the preloaded spring k presses it down:

    m x'' + c_k x' + k x + P = N,    N = K (s - x) + c (s' - x'),    N >= 0.

Time derivatives; the loose foot has no mass. The mass sits P/K below the cam at rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from geometry.arrays import FULL_TURN, Array, finite, freeze, uniform_turn
from geometry.errors import ContactError, InputError
from geometry.lift import Lift

_EVENTS_MAX = 2000
_TOLERANCE = 1e-11


@dataclass(frozen=True)
class ElasticFollower:
    """One mass on an elastic stem, pressed down by a spring.

    Parameters
    ----------
    mass : float             m, kg, > 0
    stiffness : float        K between cam and mass, N/m, > 0
    damping : float          c beside K, N s/m, >= 0
    spring_rate : float      k, N/m, >= 0
    preload : float          P, N, >= 0
    guide_damping : float    c_k between mass and frame, N s/m, >= 0
    """

    mass: float
    stiffness: float
    spring_rate: float
    preload: float
    damping: float = 0.0
    guide_damping: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("mass", "kg"), ("stiffness", "N/m")):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"follower.{name}", getattr(self, name), f"> 0 {unit}")
        for name in ("damping", "spring_rate", "preload", "guide_damping"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"follower.{name}", getattr(self, name), ">= 0")

    @classmethod
    def with_damping_ratio(
        cls, mass: float, stiffness: float, spring_rate: float, preload: float, ratio: float
    ) -> ElasticFollower:
        """The stem's damper given as a share of critical."""
        critical = 2.0 * np.sqrt(mass * (stiffness + spring_rate))
        return cls(mass, stiffness, spring_rate, preload, ratio * float(critical))

    @property
    def natural_frequency(self) -> float:
        """sqrt((K + k)/m) in contact, rad/s."""
        return float(np.sqrt((self.stiffness + self.spring_rate) / self.mass))


@dataclass(frozen=True, eq=False)
class Response:
    """Periodic motion of the mass at `theta` (n,); x in m, by time, and the contact force, N."""

    theta: Array
    position: Array
    velocity: Array
    acceleration: Array
    contact_force: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def lost(self) -> bool:
        """Whether the cam would have to pull somewhere."""
        return bool((self.contact_force < 0.0).any())


def quasi_static(lift: ArrayLike, follower: ElasticFollower) -> Array:
    """x where inertia and damping do nothing, (K s - P)/(K + k), m.

    References
    ----------
    Petrescu and Petrescu, Int. J. Production Management 6(3) (2015): the elastic follower.
    """
    s = finite("lift", lift)
    total = follower.stiffness + follower.spring_rate
    return np.asarray((follower.stiffness * s - follower.preload) / total)


def harmonic_response(lift: Array, cam_speed: float, follower: ElasticFollower) -> Response:
    """Periodic response at constant speed by harmonic balance, the contact never lost.

    Parameters
    ----------
    lift : array (n,)    s at equal angles of one turn from 0, m
    cam_speed : float    rad/s, >= 0

    Raises
    ------
    InputError
        If an undamped follower is driven at resonance, or a value is not finite.
    """
    s = finite("lift", lift)
    n, f = s.size, follower
    w = 1j * float(finite("cam_speed", cam_speed)) * np.fft.rfftfreq(n, 1.0 / n)
    if n % 2 == 0:
        w[-1] = 0.0  # the highest harmonic has no sign, hence no derivative
    total = f.stiffness + f.spring_rate
    dynamic = total + (f.damping + f.guide_damping) * w + f.mass * w**2
    if np.abs(dynamic).min() <= 1e-12 * total:
        raise InputError("cam_speed", cam_speed, "off the resonance of an undamped follower")
    foot = np.fft.rfft(s)
    drive = (f.stiffness + f.damping * w) * foot
    drive[0] -= n * f.preload
    x = drive / dynamic

    def back(spectrum: Any) -> Array:
        return np.fft.irfft(spectrum, n)

    contact = f.stiffness * (foot - x) + f.damping * w * (foot - x)
    return Response(
        theta=uniform_turn(n),
        position=back(x),
        velocity=back(w * x),
        acceleration=back(w**2 * x),
        contact_force=back(contact),
    )


def collocation_response(lift: Array, cam_speed: Array, follower: ElasticFollower) -> Response:
    """Periodic response where the speed varies over the turn: trigonometric collocation.

    Parameters
    ----------
    lift : array (n,)        s at equal angles of one turn from 0, m; n odd serves best
    cam_speed : array (n,)   at the same angles, rad/s, > 0

    Raises
    ------
    InputError
        If a speed is not positive or the shapes differ.
    """
    s = finite("lift", lift)
    speed = finite("cam_speed", cam_speed)
    if speed.shape != s.shape:
        raise InputError("cam_speed", speed.shape, f"of shape {s.shape}")
    if not (speed > 0.0).all():
        raise InputError("cam_speed", float(speed.min()), "> 0 rad/s")
    f, rate = follower, speed[:, None] * _differentiation(s.size)
    total = np.eye(s.size) * (f.stiffness + f.spring_rate)
    system: Array = f.mass * rate @ rate + (f.damping + f.guide_damping) * rate + total
    foot_speed = rate @ s
    x = np.asarray(
        np.linalg.solve(system, f.stiffness * s + f.damping * foot_speed - f.preload), dtype=float
    )
    v = rate @ x
    return Response(
        theta=uniform_turn(s.size),
        position=x,
        velocity=v,
        acceleration=rate @ v,
        contact_force=f.stiffness * (s - x) + f.damping * (foot_speed - v),
    )


def _differentiation(n: int) -> Array:
    """Matrix (n, n) that differentiates a trigonometric interpolant at equal angles, 1/rad.

    References
    ----------
    Trefethen, Spectral Methods in MATLAB (2000), ch. 3.
    """
    k = np.arange(n)
    half = 0.5 * FULL_TURN / n * (k[:, None] - k)
    np.fill_diagonal(half, 1.0)
    slope = np.tan(half) if n % 2 == 0 else np.sin(half)
    matrix = 0.5 * (-1.0) ** (k[:, None] - k) / slope
    np.fill_diagonal(matrix, 0.0)
    return matrix


class Flight(NamedTuple):
    """A loss of contact: cam angles of jump and landing, rad (may pass a turn), way and speed.

    `height` is the largest gap between foot and cam, m; `landing_speed` that at which the gap
    closes, m/s, >= 0.
    """

    jump: float
    landing: float
    height: float
    landing_speed: float


@dataclass(frozen=True, eq=False)
class Bounce:
    """Motion through jumps and landings from given start; arrays (steps,), SI.

    `energy` is kinetic energy plus that of both springs less the work of the cam; without
    damping it stands still. `dissipated` is what the dampers took.
    """

    time: Array
    position: Array
    velocity: Array
    contact_force: Array
    energy: Array
    dissipated: Array
    flights: tuple[Flight, ...]

    def __post_init__(self) -> None:
        names = set(self.__dataclass_fields__) - {"flights"}
        freeze(self, **{name: getattr(self, name) for name in names})

    @property
    def energy_error(self) -> float:
        """Largest change of energy and losses over the greatest energy in it."""
        balance = self.energy + self.dissipated
        return float(np.ptp(balance) / np.abs(self.energy).max())


def bounce(
    lift: Lift,
    cam_speed: float,
    follower: ElasticFollower,
    turns: float = 1.0,
    start: tuple[float, float] | None = None,
) -> Bounce:
    """Motion of the follower in time, contact lost and met again by events.

    In contact and in flight the motion is integrated with dense control to 1e-11; a phase ends
    where the contact force falls to zero, or where the foot, its spring relaxed, meets the cam.

    Parameters
    ----------
    lift : Lift
    cam_speed : float        rad/s, > 0
    follower : ElasticFollower
    turns : float            of the cam
    start : (x, v)           m, m/s at angle 0; the quasi-static state where none is given

    Raises
    ------
    InputError
        If the speed is not positive.
    ContactError
        If the follower hammers: more than 2000 phases.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15; Hairer, Norsett and Wanner,
    Solving Ordinary Differential Equations I (1993): DOP853.
    """
    if not 0.0 < cam_speed < np.inf:
        raise InputError("cam_speed", cam_speed, "> 0 rad/s")
    motion = _Motion(lift, cam_speed, follower)
    end = turns * FULL_TURN / cam_speed
    s, u = motion.foot(0.0)
    if start is None:
        start = (float(quasi_static(s, follower)), u)
    state = np.array([*start, 0.0, 0.0])
    touching = motion.force(0.0, state) >= 0.0
    time, pieces, flights = 0.0, [], []
    for _ in range(_EVENTS_MAX):
        found = motion.phase(time, end, state, touching)
        pieces.append((found.t, found.y, np.full(found.t.size, touching)))
        if not touching:
            flights.append(motion.flight(found))
        time, state = float(found.t[-1]), found.y[:, -1].copy()
        if found.status == 0:
            return motion.record(pieces, tuple(flights))
        if touching:  # the foot, without mass, relaxes at once; its damper takes what was left
            state[3] += 0.5 * follower.stiffness * (motion.foot(time)[0] - state[0]) ** 2
        touching = not touching
    raise ContactError(f"follower: more than {_EVENTS_MAX} losses of contact")


@dataclass(frozen=True, eq=False)
class _Motion:
    """State (x, v, work of the cam, losses) and what moves it."""

    lift: Lift
    speed: float
    follower: ElasticFollower

    def foot(self, time: float) -> tuple[float, float]:
        s, slope = self.lift.derivatives(self.speed * time, 1)
        return float(s), float(slope) * self.speed

    def force(self, time: float, state: Array) -> float:
        s, u = self.foot(time)
        f = self.follower
        return float(f.stiffness * (s - state[0]) + f.damping * (u - state[1]))

    def phase(self, time: float, end: float, state: Array, touching: bool) -> Any:
        """One phase, to its end or the end of time."""
        f = self.follower

        def rates(t: float, y: Array) -> list[float]:
            s, u = self.foot(t)
            approach = u - y[1]
            push = f.stiffness * (s - y[0]) + f.damping * approach if touching else 0.0
            lost = f.guide_damping * y[1] ** 2 + (f.damping * approach**2 if touching else 0.0)
            acceleration = (
                push - f.spring_rate * y[0] - f.preload - f.guide_damping * y[1]
            ) / f.mass
            return [y[1], acceleration, push * u, lost]

        def over(t: float, y: Array) -> float:
            return self.force(t, y) if touching else self.foot(t)[0] - y[0]

        over.terminal = True  # type: ignore[attr-defined]
        over.direction = -1.0 if touching else 1.0  # type: ignore[attr-defined]
        stem = np.sqrt(f.stiffness / f.mass)
        return solve_ivp(
            rates,
            (time, end),
            state,
            method="DOP853",
            events=over,
            rtol=_TOLERANCE,
            atol=[1e-14, 1e-14 * stem, 1e-12, 1e-12],
            max_step=min(0.02 * FULL_TURN / self.speed, end),
        )

    def flight(self, found: Any) -> Flight:
        gaps = [x - self.foot(t)[0] for t, x in zip(found.t, found.y[0], strict=True)]
        closing = self.foot(found.t[-1])[1] - found.y[1, -1]
        return Flight(
            self.speed * float(found.t[0]),
            self.speed * float(found.t[-1]),
            float(max(gaps)),
            float(max(closing, 0.0)),
        )

    def record(self, pieces: list[Any], flights: tuple[Flight, ...]) -> Bounce:
        f = self.follower
        time = np.concatenate([t for t, _, _ in pieces])
        x, v, work, lost = np.concatenate([y for _, y, _ in pieces], axis=1)
        touching = np.concatenate([on for _, _, on in pieces])
        s, slope = self.lift.derivatives(self.speed * time, 1)
        squeeze = np.where(touching, s - x, 0.0)
        push = f.stiffness * squeeze + np.where(touching, f.damping * (self.speed * slope - v), 0.0)
        stored = 0.5 * f.spring_rate * x**2 + f.preload * x + 0.5 * f.stiffness * squeeze**2
        return Bounce(
            time=time,
            position=x,
            velocity=v,
            contact_force=push,
            energy=0.5 * f.mass * v**2 + stored - work,
            dissipated=lost,
            flights=flights,
        )


def elastic_jump_speed(
    lift: Array, follower: ElasticFollower, speed_max: float, steps: int = 160
) -> float:
    """Least cam speed up to `speed_max` at which the contact force falls to zero, rad/s.

    Infinite where it never does; speeds are searched in equal steps, so that resonances narrower
    than one may be passed by.
    """

    def least(speed: float) -> float:
        return float(harmonic_response(lift, speed, follower).contact_force.min())

    before = 0.0
    if least(before) <= 0.0:
        return 0.0
    for speed in np.linspace(0.0, speed_max, steps + 1)[1:]:
        if least(float(speed)) <= 0.0:
            return float(brentq(least, before, float(speed), xtol=1e-6 * speed_max))
        before = float(speed)
    return np.inf
