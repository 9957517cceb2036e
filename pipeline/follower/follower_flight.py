"""Elastic follower with loss of contact: flights and landings by time integration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import FULL_TURN, Array, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import PeriodicPolynomial
from camwright.pipeline.follower.elastic_follower import ElasticFollower, quasi_static

_EVENTS_MAX = 2000
_TOLERANCE = 1e-11


class Flight(NamedTuple):
    """A flight: cam angles of jump and landing, rad, may exceed a turn.

    `height`: maximum gap between foot and cam, m; `landing_speed`: closing speed of the gap, m/s,
    >= 0.
    """

    jump: float
    landing: float
    height: float
    landing_speed: float


@dataclass(frozen=True, eq=False)
class Bounce:
    """Motion with flights and landings from an initial state; arrays (steps,), SI.

    theta: cam angle, may exceed a turn; `energy`: kinetic energy plus that of both springs less the
    work of cam and load, constant without damping; `dissipated`: energy of the dampers.
    """

    theta: Array
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
        """Range of energy plus losses over maximum energy."""
        balance = self.energy + self.dissipated
        return float(np.ptp(balance) / np.abs(self.energy).max())


def bounce(
    lift: Lift,
    cam_speed: float | PeriodicPolynomial,
    follower: ElasticFollower,
    turns: float = 1.0,
    start: tuple[float, float] | None = None,
) -> Bounce:
    """Motion of the follower over the cam angle with loss of contact.

    Phases in contact and in flight are integrated to a tolerance of 1e-11. A phase ends where the
    contact force, or the gap between cam and the foot on its relaxed stem, decreases to zero.

    Parameters
    ----------
    lift : Lift
    cam_speed : float, or function of the angle   rad/s, > 0
    follower : ElasticFollower
    turns : float            of the cam
    start : (x, v)           m, m/s at angle 0; None: the quasi-static state

    Raises
    ------
    InputError
        If a speed is not positive.
    ContactError
        If there are more than 2000 phases.

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15; Hairer, Norsett and Wanner,
    Solving Ordinary Differential Equations I (1993): DOP853.
    """
    motion = _Motion(lift, _law(cam_speed), follower)
    end = turns * FULL_TURN
    s, u = motion.foot(0.0)
    if start is None:
        start = (float(quasi_static(s, follower)), u)
    state = np.array([*start, 0.0, 0.0, 0.0])
    touching = motion.force(0.0, state) >= 0.0
    angle, phases, flights = 0.0, [], []
    for _ in range(_EVENTS_MAX):
        phase = motion.phase(angle, end, state, touching)
        phases.append(phase)
        if not touching:
            flights.append(motion.flight(phase))
        angle, state = float(phase.theta[-1]), phase.state[:, -1].copy()
        if phase.last:
            return motion.record(phases, tuple(flights))
        if touching:  # the massless stem relaxes at once; its damper dissipates the energy
            state[3] += 0.5 * follower.stiffness * (motion.foot(angle)[0] - state[0]) ** 2
        touching = not touching
    raise ContactError(f"follower: more than {_EVENTS_MAX} phases of contact and flight")


def _law(cam_speed: float | PeriodicPolynomial) -> PeriodicPolynomial:
    """Cam speed over the cam angle, rad/s, > 0."""
    if not isinstance(cam_speed, PeriodicPolynomial):
        cam_speed = PeriodicPolynomial(np.array([[float(cam_speed)]]))
    least = float(cam_speed(np.linspace(0.0, FULL_TURN, 1441)).min())
    if not 0.0 < least < np.inf:
        raise InputError("cam_speed", least, "> 0 rad/s")
    return cam_speed


class _Phase(NamedTuple):
    """Cam angles (k,), rad, and states (5, k) in contact or in flight; whether it is the last."""

    theta: Array
    state: Array
    touching: bool
    last: bool


@dataclass(frozen=True, eq=False)
class _Motion:
    """Equations of motion of the state (x, v, work of cam and load, losses, time)."""

    lift: Lift
    speed: PeriodicPolynomial
    follower: ElasticFollower

    def foot(self, angle: float) -> tuple[float, float]:
        """Lift, m, and its rate, m/s."""
        s, slope = self.lift.derivatives(angle, 1)
        return float(s), float(slope) * float(self.speed(angle))

    def load(self, angle: float) -> float:
        """Weight and external force, N."""
        load = self.follower.load
        return float(load.at(np.asarray(angle))) if load.varies else float(load.force[0])

    def force(self, angle: float, state: Array) -> float:
        """Contact force, N."""
        s, u = self.foot(angle)
        f = self.follower
        return float(f.stiffness * (s - state[0]) + f.damping * (u - state[1]))

    def phase(self, angle: float, end: float, state: Array, touching: bool) -> _Phase:
        """One phase, to the change of contact or the last angle."""
        f = self.follower

        def rates(at: float, y: Array) -> list[float]:
            s, u = self.foot(at)
            pace = 1.0 / float(self.speed(at))
            approach = u - y[1]
            push = f.stiffness * (s - y[0]) + f.damping * approach if touching else 0.0
            load = self.load(at)
            lost = f.guide_damping * y[1] ** 2 + (f.damping * approach**2 if touching else 0.0)
            acceleration = (
                push - f.spring_rate * y[0] - f.preload - load - f.guide_damping * y[1]
            ) / f.mass
            work = push * u - load * y[1]
            return [pace * y[1], pace * acceleration, pace * work, pace * lost, pace]

        stem = np.sqrt(f.stiffness / f.mass)
        solution = scipy.integrate.solve_ivp(
            rates,
            (angle, end),
            state,
            method="DOP853",
            events=_ContactChange(self, touching),
            rtol=_TOLERANCE,
            atol=[1e-14, 1e-14 * stem, 1e-12, 1e-12, 1e-12],
            max_step=min(0.02 * FULL_TURN, end),
        )
        return _Phase(solution.t, solution.y, touching, last=solution.status == 0)

    def flight(self, phase: _Phase) -> Flight:
        theta = phase.theta
        gaps = [x - self.foot(t)[0] for t, x in zip(theta, phase.state[0], strict=True)]
        closing = self.foot(theta[-1])[1] - phase.state[1, -1]
        return Flight(float(theta[0]), float(theta[-1]), float(max(gaps)), float(max(closing, 0.0)))

    def record(self, phases: Sequence[_Phase], flights: tuple[Flight, ...]) -> Bounce:
        f = self.follower
        theta = np.concatenate([phase.theta for phase in phases])
        x, v, work, lost, time = np.concatenate([phase.state for phase in phases], axis=1)
        touching = np.concatenate([np.full(phase.theta.size, phase.touching) for phase in phases])
        s, slope = self.lift.derivatives(theta, 1)
        squeeze = np.where(touching, s - x, 0.0)
        approach = np.where(touching, slope * self.speed(theta) - v, 0.0)
        stored = 0.5 * f.spring_rate * x**2 + f.preload * x + 0.5 * f.stiffness * squeeze**2
        return Bounce(
            theta=theta,
            time=time,
            position=x,
            velocity=v,
            contact_force=f.stiffness * squeeze + f.damping * approach,
            energy=0.5 * f.mass * v**2 + stored - work,
            dissipated=lost,
            flights=flights,
        )


@dataclass(frozen=True, eq=False)
class _ContactChange:
    """Event that ends a phase: the contact force or the gap between foot and cam falls to zero.

    `terminal` and `direction` are read by `solve_ivp`.
    """

    motion: _Motion
    touching: bool
    terminal: bool = True

    @property
    def direction(self) -> float:
        return -1.0 if self.touching else 1.0

    def __call__(self, angle: float, state: Array) -> float:
        if self.touching:
            return self.motion.force(angle, state)
        return self.motion.foot(angle)[0] - float(state[0])
