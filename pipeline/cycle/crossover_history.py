"""Landings of a follower between two tracks in a turn of a load case: force, pressure, energy."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import floor
from typing import NamedTuple

import numpy as np
import scipy

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.second_track import SecondFollower, relative_radius, touch_of
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.conforming_line import concave_line
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.follower.crossover import INNER, OUTER, SAME_ANGLE, Landing, Walls
from camwright.pipeline.follower.follower_forces import Carried, RequiredForce
from camwright.pipeline.follower.shaft_strength import of_disc

FINE = 14400
"""Angles of a turn at which the force of a flight is evaluated."""


class WallImpact(NamedTuple):
    """Landing on a wall, with what it does there.

    flight; force : greatest normal force, N, of the mass on the stiffness of the follower, NaN
    without one; pressure : under it, Pa, of Hertz or conforming; loss : energy that it takes, J
    """

    flight: Landing
    force: float
    pressure: float
    loss: float


class LandingEnergy(NamedTuple):
    """Energy of a rigid follower between its tracks over a turn, J.

    work : of the tracks, by their forces and the impulses of the landings; taken : by spring,
    weight, external and viscous force along the motion with its flights; lost : in the landings;
    gained : kinetic, 0 over a turn; exchanged : half of the work of a turn without flights, without
    regard to its sign
    """

    work: float
    taken: float
    lost: float
    gained: float
    exchanged: float

    @property
    def left(self) -> float:
        """Energy that the works leave unexplained, over the one exchanged."""
        return abs(self.work - self.taken - self.lost - self.gained) / self.exchanged


class Flights(NamedTuple):
    """Landings of a rigid follower between its tracks over a turn, and the forces of the motion
    that the first of them guides, at equal angles.
    """

    walls: Walls
    landings: tuple[Landing, ...]
    required: RequiredForce
    cam_speed: float

    @property
    def energy(self) -> LandingEnergy:
        """Energy over the turn; NaN where a flight does not end within a turn. Of a follower that
        does not come to rest in it from the first take-off to the last landing.

        While a track carries, its force is that against spring, weight, external and viscous force
        with the rate of the momentum; in flight the tracks do no work; a landing of a mass m at v
        that leaves at e v is an impulse m (1 + e) v at the velocity of the track.
        """
        if any(np.isnan(one.landing) for one in self.landings):
            return LandingEnergy(np.nan, np.nan, np.nan, np.nan, self._exchanged)
        walls, required, mass = self.walls, self.required, self.walls.mass
        drawn, gap = required.lift_slope * self.cam_speed, np.array(walls.gap)
        opening, resting = np.array(walls.opening), required.resisting_force
        beside = walls.stiffness * gap + walls.damping * opening
        drained = {
            INNER: _Integral(resting * drawn, walls.step),
            OUTER: _Integral((resting + beside) * (drawn + opening), walls.step),
        }
        work = taken = lost = gained = 0.0
        for number, one in enumerate(self.landings):
            driven, after = (
                self._velocity(one.wall, one.landing),
                (*self.landings, None)[number + 1],
            )
            if after is None and one.rebound > 0.0:
                first = self.landings[0]
                begun = self._velocity(first.start, first.take_off)
                gained = 0.5 * mass * ((driven + one.wall * one.rebound) ** 2 - begun**2)
            else:
                end = (after or self.landings[0]).take_off
                spent = drained[one.wall].between(one.landing, end)
                faster = self._velocity(one.wall, end) ** 2 - driven**2
                work += spent + 0.5 * mass * faster
                taken += spent
            work += mass * (one.speed + one.rebound) * one.wall * driven
            lost += one.loss(mass)
            taken += self._flown(one, resting, drawn)
        return LandingEnergy(work, taken, lost, gained, self._exchanged)

    def _velocity(self, wall: float, angle: float) -> float:
        """Velocity of the follower on a track at a cam angle, rad, m/s: on the inner one by the
        accelerations of the step.
        """
        walls, required, count = self.walls, self.required, len(self.walls.gap)
        index = angle / FULL_TURN * count
        k, share = floor(index) % count, index - floor(index)
        resting = required.resisting_force[k], required.resisting_force[(k + 1) % count]
        first, last = (
            (force[k] - rest) / walls.mass for force, rest in zip(walls.ends, resting, strict=True)
        )
        mean = first + 0.5 * share * (last - first)
        drawn = required.lift_slope[k] * self.cam_speed + mean * share * walls.step
        return float(drawn + (0.0 if wall == INNER else walls.at(walls.opening, index)))

    @property
    def _exchanged(self) -> float:
        required = self.required
        step = FULL_TURN / required.theta.size
        return 0.5 * step * float(np.sum(np.abs(required.force * required.lift_slope)))

    def _flown(self, flight: Landing, resting: Array, drawn: Array) -> float:
        """Work against spring, weight, external and viscous force in a flight, J.

        Parameters
        ----------
        resting, drawn : array (n,)   these forces, N, and the velocity, m/s, on the inner track
        """
        walls, count = self.walls, drawn.size
        force, speed = resting.tolist(), drawn.tolist()
        start = flight.take_off / FULL_TURN * count
        end, taken = start + flight.time / walls.step, 0.0
        for index, arc in walls.flight(start, flight.start, flight.leaving):
            if index >= end:
                return taken
            after = min(floor(index) + 1.0, end)
            share = (after - index) / (floor(index) + 1.0 - index)
            ends = [
                (walls.at(force, at) + walls.stiffness * arc.position(part)
                 + walls.damping * arc.velocity(part))
                * (walls.at(speed, at) + arc.velocity(part))
                for at, part in ((index, 0.0), (after, share))
            ]  # fmt: skip
            taken += 0.5 * (after - index) * walls.step * sum(ends)
        return np.nan


class _Integral:
    """Integral in time of values (n,) at equal angles of a turn, by a periodic cubic spline.

    step : time between the angles, s
    """

    def __init__(self, values: Array, step: float) -> None:
        theta = np.append(uniform_turn(values.size), FULL_TURN)
        closed = np.append(values, values[0])
        spline = scipy.interpolate.CubicSpline(theta, closed, bc_type="periodic")
        self._whole, self._rate = spline.antiderivative(), step * values.size / FULL_TURN

    def between(self, begin: float, end: float) -> float:
        """From one cam angle, rad, on to another; 0 between the same angle."""
        if abs(end - begin) < SAME_ANGLE or FULL_TURN - abs(end - begin) < SAME_ANGLE:
            return 0.0
        turned = self._whole(FULL_TURN) if end < begin else 0.0
        return self._rate * float(turned + self._whole(end) - self._whole(begin))


def flights(machine: Machine, contour: Contour) -> Flights | None:
    """Flights of a rigid follower between its tracks; None at standstill, and of one track."""
    if not (machine.cam.clearance > 0.0 and machine.speed > 0.0):
        return None
    theta, pitch = uniform_turn(FINE), contour.pitch
    speed, still = np.full(FINE, machine.cam_speed), np.zeros(FINE)
    required = RequiredForce.of(machine.system, pitch.lift, theta, speed, still)
    walls = Walls.of(
        required.force,
        machine.clearance_on(pitch, theta) / _along(pitch, machine.cam.second),
        machine.mass,
        machine.cam_speed,
        machine.spring.rate,
        machine.viscous_damping,
        (required.resisting_force, required.lift, required.lift_slope * machine.cam_speed),
    )
    return Flights(walls, walls.landings(machine.rebound_share), required, machine.cam_speed)


@lru_cache(maxsize=8)
def _along(pitch: FollowerPath, second: SecondFollower | None) -> Array:
    """Travel of the follower square to the second track or outer wall, over that of the first, at
    `FINE` angles.
    """
    theta = uniform_turn(FINE)
    touch = touch_of(pitch, theta) if second is None else second.track(pitch).touch(theta)
    return np.asarray(touch.slide.lever * np.cos(touch.pressure_angle))


def impacts(machine: Machine, contour: Contour) -> tuple[WallImpact, ...]:
    """Landings of a rigid follower between its tracks; none at standstill, and of one track."""
    return landed(machine, contour, flights(machine, contour))


def landed(machine: Machine, contour: Contour, flown: Flights | None) -> tuple[WallImpact, ...]:
    """What the landings of flights do to their tracks.

    A mass m that lands at v under a force F on a stiffness k is stopped by
    F + sqrt(F^2 + k m v^2); contact and walls are taken as rigid.
    """
    landings = () if flown is None else flown.landings
    ended = [k for k, one in enumerate(landings) if np.isfinite(one.landing)]
    force, pressure = np.full((2, len(landings)), np.nan)
    if ended:
        force[ended], pressure[ended] = _struck(machine, contour, [landings[k] for k in ended])
    every = zip(landings, force.tolist(), pressure.tolist(), strict=True)
    return tuple(
        WallImpact(one, pushed, pressed, one.loss(machine.mass)) for one, pushed, pressed in every
    )


def _struck(machine: Machine, contour: Contour, landings: Sequence[Landing]) -> tuple[Array, Array]:
    """Greatest normal force (n,), N, and pressure, Pa, of landings (n,), each on its track."""
    theta = np.array([one.landing for one in landings]) % FULL_TURN
    wall, speed = np.array([(one.wall, one.speed) for one in landings]).T
    pressed = np.maximum(np.array([one.force for one in landings]), 0.0)
    stiffness = of_disc(machine.track_stiffnesses, wall < 0.0)
    axial = pressed + np.sqrt(pressed**2 + stiffness * machine.mass * speed**2)
    second = machine.cam.second
    there = Carried.at(contour.pitch, machine.system, theta, wall)
    force = axial / (there.slide.lever * np.cos(there.pressure_angle))
    radius, pressure = relative_radius(contour, second, theta, wall), np.full(theta.size, np.nan)
    sound = np.isfinite(force) & (radius > 0.0)
    if not sound.any():
        return force, pressure
    load, radius = force[sound] / machine.contact_width, radius[sound]
    _, hertzian = hertz.line_contact(load, radius, machine.contact_modulus)
    if contour.rolls:
        first = machine.roller.radius
        other = first if second is None else second.radius
        bodies = (
            Elastic(card.E, card.nu) for card in (machine.roller.material, machine.cam.material)
        )
        carrying = np.where(wall[sound] > 0.0, first, other)
        full, line = concave_line(load, radius, carrying, *bodies)
        if line is not None:
            hertzian = np.array(hertzian)
            hertzian[full] = line.p0
    pressure[sound] = hertzian
    return force, pressure
