"""Elastic follower with loss of contact: flights and landings by time integration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Values, freeze
from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import PeriodicPolynomial
from camwright.pipeline.follower.elastic_follower import ElasticFollower, quasi_static

_EVENTS_MAX = 2000
_TOLERANCE = 1e-11
_CONTACT_STEP, _FLIGHT_STEP = 0.02 * FULL_TURN, 0.25 * FULL_TURN  # at most
_GAPS_MAX = 100_000  # angles at which the gap of a flight is looked at
LONGEST = 100.0
"""Turns of the cam after which a follower that has not landed counts as one that never does."""


class Flight(NamedTuple):
    """Flight of the follower: cam angles of take-off and landing, rad, may exceed a turn.

    `height`: maximum gap between foot and cam, m; `landing_speed`: closing speed of the gap, m/s,
    >= 0. A follower that has not landed after `LONGEST` turns has an infinite angle of landing, and
    NaN as speed.
    """

    jump: float
    landing: float
    height: float
    landing_speed: float

    @property
    def lands(self) -> bool:
        """Whether the follower lands."""
        return self.landing < np.inf

    @property
    def turns_later(self) -> int:
        """Number of cam turns from take-off to landing."""
        return int(self.landing // FULL_TURN - self.jump // FULL_TURN)


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


def bounce(
    lift: Lift,
    cam_speed: float | PeriodicPolynomial,
    follower: ElasticFollower,
    turns: float = 1.0,
    start: tuple[float, float] | None = None,
    first: float = 0.0,
) -> Bounce:
    """Time integration of the follower over the cam angle with loss of contact.

    Phases in contact and in flight are integrated to a tolerance of 1e-11. A phase ends where the
    contact force, or the gap between cam and the foot on its relaxed stem, decreases to zero; a
    damped stem that has not relaxed ends its flight where the contact force would increase again. A
    flight that has begun is followed to its landing, beyond the last angle and over whole turns, at
    most `LONGEST`.

    Parameters
    ----------
    lift : Lift
    cam_speed : float, or function of the angle   rad/s, > 0
    follower : ElasticFollower
    turns : float            of the cam
    start : (x, v)           m, m/s at the first angle; None: the quasi-static state
    first : float            first cam angle, rad

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
    end = first + turns * FULL_TURN
    s, u = motion.foot(first)
    if start is None:
        start = (float(quasi_static(s, follower, first)), u)
    state = np.array([*start, 0.0, 0.0, 0.0])
    touching = motion.force(first, state) >= 0.0
    angle, phases, flights = first, [], []
    for _ in range(_EVENTS_MAX):
        phase = motion.contact(angle, end, state) if touching else motion.flight(angle, state)
        phases.append(phase)
        if phase.flight is not None:
            flights.append(phase.flight)
        angle, state = float(phase.theta[-1]), phase.state[:, -1].copy()
        if phase.last or angle >= end:
            return motion.record(phases, tuple(flights))
        if touching:  # the massless stem relaxes at once; its damper dissipates the energy
            state[3] += 0.5 * follower.stiffness * (motion.foot(angle)[0] - state[0]) ** 2
        touching = not touching
    raise ContactError(f"follower: more than {_EVENTS_MAX} phases of contact and flight")


def _law(cam_speed: float | PeriodicPolynomial) -> PeriodicPolynomial:
    """Cam speed, rad/s, constant or by the cam angle, as a function of the cam angle; InputError
    where it is not positive.
    """
    if not isinstance(cam_speed, PeriodicPolynomial):
        cam_speed = PeriodicPolynomial(np.array([[float(cam_speed)]]))
    least = float(cam_speed(np.linspace(0.0, FULL_TURN, 1441)).min())
    if not 0.0 < least < np.inf:
        raise InputError("cam_speed", least, "> 0 rad/s")
    return cam_speed


class _Phase(NamedTuple):
    """Cam angles (k,), rad, and states (5, k) of a phase; its flight, None in contact.

    `last`: whether no other phase follows.
    """

    theta: Array
    state: Array
    last: bool
    flight: Flight | None = None


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

    def contact(self, angle: float, end: float, state: Array) -> _Phase:
        """Phase in contact, to the jump or the last angle."""
        solution = self._integrated(angle, end, state, touching=True)
        return _Phase(solution.t, solution.y, last=solution.status == 0)

    def flight(self, angle: float, state: Array) -> _Phase:
        """Phase in flight from take-off at cam angle `angle`, rad, with a state (5,), to the
        landing; the greatest gap is refined between steps.
        """
        solution = self._integrated(angle, angle + LONGEST * FULL_TURN, state, touching=False)
        theta, gaps, shut = self._gaps(solution)
        early = np.flatnonzero(shut & (theta > angle) & (theta < solution.t[-1]))
        if early.size:  # on a nose of the cam within one step, which shows no change of sign
            solution = self._integrated(angle, theta[early[0]], state, touching=False)
            theta, gaps, _ = self._gaps(solution)
        landing, closing = np.inf, np.nan
        if solution.status == 1 or early.size:
            landing = float(solution.t[-1])
            closing = max(self.foot(landing)[1] - float(solution.y[1, -1]), 0.0)
        k = int(np.argmax(gaps))
        around = theta[max(k - 1, 0)], theta[min(k + 1, theta.size - 1)]
        peak = scipy.optimize.minimize_scalar(
            lambda at: self.foot(at)[0] - float(solution.sol(at)[0]),
            bounds=around,
            method="bounded",
        )
        height = max(float(gaps[k]), -float(peak.fun), 0.0)
        flown = Flight(angle, landing, height, closing)
        return _Phase(solution.t, solution.y, last=not flown.lands, flight=flown)

    def shut(self, foot: Values, foot_speed: Values, position: Values, velocity: Values) -> Array:
        """Indentation (...), m, at which a follower in flight is in contact again: positive.

        Of the relaxed stem, or less while its damper still holds the foot off the cam.
        """
        f, indentation = self.follower, foot - position
        held = indentation + f.damping / f.stiffness * (foot_speed - velocity)
        return np.minimum(indentation, held)

    def _gaps(
        self, solution: scipy.optimize.OptimizeResult
    ) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Samples of a flight: cam angles (k,), rad, gaps between foot and cam (k,), m, and whether
        the contact has shut again (k,).

        Parameters
        ----------
        solution : result   of `_integrated` in flight, with its dense output
        """
        first, last = solution.t[0], solution.t[-1]
        count = int((last - first) / FULL_TURN * self.lift.search_count)
        theta = np.linspace(first, last, min(max(64, count), _GAPS_MAX))
        x, v = solution.sol(theta)[:2]
        s, slope = self.lift.derivatives(theta, 1)
        return theta, np.asarray(x - s), self.shut(s, slope * self.speed(theta), x, v) > 0.0

    def _integrated(
        self, angle: float, end: float, state: Array, *, touching: bool
    ) -> scipy.optimize.OptimizeResult:
        """Motion of the follower over the cam angle, to an end or to the change of contact before
        it, by Runge-Kutta of order 8.

        Parameters
        ----------
        angle, end : float   cam angles, rad
        state : array (5,)   at `angle`: x, v, work of cam and load, losses, time
        touching : bool      with the force of the stem on the cam; else in flight
        """
        f = self.follower

        def rates(at: float, y: Array) -> list[float]:
            """Derivative of the state by the cam angle, per rad, at cam angle `at`, rad."""
            pace, load = 1.0 / float(self.speed(at)), self.load(at)
            drag, work = f.guide_damping * y[1], -load * y[1]
            force, lost = -f.spring_rate * y[0] - f.preload - load - drag, drag * y[1]
            if touching:
                s, u = self.foot(at)
                approach = u - y[1]
                push = f.stiffness * (s - y[0]) + f.damping * approach
                force, work, lost = force + push, work + push * u, lost + f.damping * approach**2
            mass, slope = f.moving(y[0])
            force = force - 0.5 * slope * y[1] ** 2
            return [pace * y[1], pace * force / mass, pace * work, pace * lost, pace]

        stem = np.sqrt(f.stiffness / f.mass)
        return scipy.integrate.solve_ivp(
            rates,
            (angle, end),
            state,
            method="DOP853",
            events=_ContactChange(self, touching),
            dense_output=not touching,
            rtol=_TOLERANCE,
            atol=[1e-14, 1e-14 * stem, 1e-12, 1e-12, 1e-12],
            max_step=min(_CONTACT_STEP if touching else _FLIGHT_STEP, end - angle),
        )

    def record(self, phases: Sequence[_Phase], flights: tuple[Flight, ...]) -> Bounce:
        """Motion, contact force and energies at all steps of several phases in turn, m, m/s, N, J.

        Parameters
        ----------
        phases : sequence   in contact and in flight, in their order
        flights : tuple     of these phases
        """
        f = self.follower
        theta = np.concatenate([phase.theta for phase in phases])
        x, v, work, lost, time = np.concatenate([phase.state for phase in phases], axis=1)
        touching = np.concatenate(
            [np.full(phase.theta.size, phase.flight is None) for phase in phases]
        )
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
            energy=0.5 * f.moving(x)[0] * v**2 + stored - work,
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
        """Contact force, N, of a phase in contact, or of one in flight a value that rises through
        zero as the contact shuts; state : (5,) at cam angle `angle`, rad.
        """
        if self.touching:
            return self.motion.force(angle, state)
        return float(self.motion.shut(*self.motion.foot(angle), state[0], state[1]))
