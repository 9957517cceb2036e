"""Follower on an elastic stem: periodic response, cam speed at loss of contact.

The cam displaces the foot by s; the mass m with displacement x rests on the stem, spring K and
damper c, under the follower spring k with preload P and a load F_e of weight and machine:

    m x'' + c_k x' + k x + P + F_e = N,    N = K (s - x) + c (s' - x'),    N >= 0.

Derivatives by time; the foot has no mass. At rest the mass is displaced by -(P + F_e)/(K + k).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value, finite, freeze, uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.base.external_force import NO_FORCE, ExternalForce
from camwright.pipeline.follower.rocker import RockerOutput

STEADY = 1e-12  # relative variation up to which a speed is constant


@dataclass(frozen=True)
class ElasticFollower:
    """Mass on an elastic stem under a preloaded spring.

    Parameters
    ----------
    mass : float             m, kg, > 0
    stiffness : float        K between cam and mass, N/m, > 0
    damping : float          c beside K, N s/m, >= 0
    spring_rate : float      k, N/m, >= 0
    preload : float          P, N, >= 0
    guide_damping : float    c_k between mass and frame, N s/m, >= 0
    load : ExternalForce     F_e, weight and external force, towards the cam
    output : RockerOutput    whose mass at the follower, part of `mass` at zero lift, changes with
                             the lift; None: none, or of a constant ratio
    """

    mass: float
    stiffness: float
    spring_rate: float
    preload: float
    damping: float = 0.0
    guide_damping: float = 0.0
    load: ExternalForce = NO_FORCE
    output: RockerOutput | None = None

    def __post_init__(self) -> None:
        """Refuse a mass or stiffness that is not positive, and a negative damping, rate or
        preload.
        """
        for name, unit in (("mass", "kg"), ("stiffness", "N/m")):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"follower.{name}", getattr(self, name), f"> 0 {unit}")
        for name in ("damping", "spring_rate", "preload", "guide_damping"):
            if not 0.0 <= getattr(self, name) < np.inf:
                raise InputError(f"follower.{name}", getattr(self, name), ">= 0")

    @classmethod
    def with_damping_ratio(
        cls,
        mass: float,
        stiffness: float,
        spring_rate: float,
        preload: float,
        ratio: float,
        load: ExternalForce = NO_FORCE,
        output: RockerOutput | None = None,
    ) -> ElasticFollower:
        """With the damping of the stem as a share of critical damping, of the mass at zero lift."""
        critical = 2.0 * np.sqrt(mass * (stiffness + spring_rate))
        damping = ratio * float(critical)
        return cls(mass, stiffness, spring_rate, preload, damping, load=load, output=output)

    def moving(self, position: Value) -> tuple[Value, Value]:
        """Mass m(x) (...), kg, and its slope m'(x), kg/m, at positions of it, m.

        The equation of motion has m x'' + m' x'^2/2 in place of m x''.
        """
        if self.output is None:
            return self.mass + 0.0 * position, 0.0 * position
        beyond = self.output.moving_mass(position)
        return self.mass + beyond, 2.0 * self.output.inertia(position, 1.0, 0.0)


@dataclass(frozen=True, eq=False)
class Response:
    """Periodic motion of the mass at `theta` (n,), rad: m, m/s, m/s2; contact force, N."""

    theta: Array
    position: Array
    velocity: Array
    acceleration: Array
    contact_force: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def lost(self) -> bool:
        """Whether the contact force is negative at some angle: loss of contact."""
        return bool((self.contact_force < 0.0).any())


def quasi_static(lift: ArrayLike, follower: ElasticFollower, theta: ArrayLike = 0.0) -> Array:
    """Quasi-static displacement of the mass, (K s - P - F_e)/(K + k), m.

    Parameters
    ----------
    lift : array (...)    s, m
    theta : array (...)   cam angle of the load, rad

    References
    ----------
    Petrescu and Petrescu, Int. J. Production Management 6(3) (2015): the elastic follower.
    """
    s = finite("lift", lift)
    total = follower.stiffness + follower.spring_rate
    held = follower.preload + follower.load.at(np.asarray(theta, dtype=float))
    return np.asarray((follower.stiffness * s - held) / total)


def harmonic_response(lift: Array, cam_speed: float, follower: ElasticFollower) -> Response:
    """Periodic response of a constant mass at constant speed by harmonic balance, with bilateral
    contact.

    Parameters
    ----------
    lift : array (n,)    s at equal angles of one turn from 0, m
    cam_speed : float    rad/s, >= 0

    Raises
    ------
    InputError
        If an undamped follower is at resonance, or a value is not finite.
    """
    s = finite("lift", lift)
    n, f = s.size, follower
    w = 1j * float(finite("cam_speed", cam_speed)) * np.fft.rfftfreq(n, 1.0 / n)
    if n % 2 == 0:
        w[-1] = 0.0  # the derivative of the highest harmonic is not defined
    total = f.stiffness + f.spring_rate
    dynamic = total + (f.damping + f.guide_damping) * w + f.mass * w**2
    if np.abs(dynamic).min() <= 1e-12 * total:
        raise InputError("cam_speed", cam_speed, "off the resonance of an undamped follower")
    foot = np.fft.rfft(s)
    # Solved for the compression s - x: the difference would lose digits on a stiff stem.
    drive = (f.mass * w**2 + f.guide_damping * w + f.spring_rate) * foot
    drive[0] += n * f.preload
    drive += np.fft.rfft(f.load.at(uniform_turn(n)))
    short = drive / dynamic

    def back(spectrum: NDArray[np.complex128]) -> Array:
        return np.fft.irfft(spectrum, n)

    return Response(
        theta=uniform_turn(n),
        position=s - back(short),
        velocity=back(w * (foot - short)),
        acceleration=back(w**2 * (foot - short)),
        contact_force=back((f.stiffness + f.damping * w) * short),
    )


def collocation_response(lift: Array, cam_speed: Array, follower: ElasticFollower) -> Response:
    """Periodic response of a follower on its elastic stem at varying speed of the cam, by
    trigonometric collocation.

    A mass that changes with the lift is that at the lift of the foot, and the square of its speed
    is taken to first order in the speed of the shortening.

    Parameters
    ----------
    lift : array (n,)            s at equal angles of one turn from 0, m; n odd preferred
    cam_speed : array (n,)       at the same angles, rad/s, > 0
    follower : ElasticFollower   mass, stem and spring

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
    foot_speed = rate @ s
    foot_acceleration = rate @ foot_speed
    mass, slope = (np.asarray(each) for each in f.moving(s))
    damping = f.damping + f.guide_damping + slope * foot_speed
    system: Array = mass[:, None] * (rate @ rate) + damping[:, None] * rate
    system[np.diag_indices(s.size)] += f.stiffness + f.spring_rate
    drive = mass * foot_acceleration + 0.5 * slope * foot_speed**2
    drive = drive + f.guide_damping * foot_speed + f.spring_rate * s
    held = f.preload + f.load.at(uniform_turn(s.size))
    short = np.asarray(np.linalg.solve(system, drive + held), dtype=float)
    short_speed = rate @ short
    return Response(
        theta=uniform_turn(s.size),
        position=s - short,
        velocity=foot_speed - short_speed,
        acceleration=foot_acceleration - rate @ short_speed,
        contact_force=f.stiffness * short + f.damping * short_speed,
    )


def periodic_response(lift: Array, cam_speed: Array, follower: ElasticFollower) -> Response:
    """Periodic response of a follower on its elastic stem at n equal cam angles; by harmonic
    balance at constant speed and mass, otherwise by collocation.

    Parameters
    ----------
    lift : array (n,)            of the foot, m
    cam_speed : array (n,)       rad/s
    follower : ElasticFollower   mass, stem and spring
    """
    speed = finite("cam_speed", cam_speed)
    if is_steady(speed) and follower.output is None:
        return harmonic_response(lift, float(speed[0]), follower)
    return collocation_response(lift, speed, follower)


def is_steady(cam_speed: Array) -> bool:
    """Whether a speed over the turn is constant to round-off."""
    return bool(np.ptp(cam_speed) <= STEADY * np.abs(cam_speed).max())


def _differentiation(n: int) -> Array:
    """Matrix (n, n), 1/rad, that differentiates the trigonometric interpolant of n values at equal
    angles of the turn.

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
    return np.asarray(matrix)
