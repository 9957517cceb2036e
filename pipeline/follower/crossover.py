"""Crossovers of a roller in a groove: flight through the clearance, landing on the other wall."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import floor, inf, isfinite, nan
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, finite, positive
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import shown

INNER, OUTER = 1.0, -1.0
SAME_ANGLE = 1e-9  # rad, between a landing and the take-off of its rebound
_RIPPLE_SHARE = 1e-2
"""Share of the greatest force below which a force of the other sign is none: the ripple of the
spline of a lift where its jerk steps, beside a dwell."""
_LEAVING_ROUND_OFF = 1e-9  # of the clearance, of a roller that leaves a wall
_BENT_MOST = 1e-4  # of the clearance, greatest part of the bend of a wall within a step
_LANDING_STEPS = 100  # to the landing within a step, most of them by halves at a double root
_SAME_SHARE = 1e-13  # of a step
_LANDINGS_MAX = 1000  # a turn
_REST_SHARE = 1e-3  # of the clearance: height of a rebound that counts as none


class Landing(NamedTuple):
    """Landing of the roller on a wall after a flight through the clearance.

    take_off, landing : cam angles, rad; the landing is NaN where none follows within a turn
    start, wall : wall that it leaves, and on which it lands: 1 the inner, -1 the outer
    time : of the flight, s
    speed : against the wall along the travel, m/s, >= 0
    force : that presses it on the wall then, along the travel, N; negative: off it
    rebound : speed off the wall after the landing, m/s; 0 where it stays
    leaving : speed off the wall at the take-off, m/s: of the rebound before
    """

    take_off: float
    landing: float
    start: float
    wall: float
    time: float
    speed: float
    force: float
    rebound: float = 0.0
    leaving: float = 0.0

    def loss(self, mass: float) -> float:
        """Kinetic energy against the wall that the landing of a mass, kg, takes, J."""
        return 0.5 * mass * (self.speed**2 - self.rebound**2)


class Walls(NamedTuple):
    """Two walls with a rigid follower between them, over a turn in equal steps of time, s.

    force : of each wall on the follower that it guides, N, positive outward: inner, outer; forces :
        the same as arrays
    ends : that of the inner wall at begin and end of each step, linear in it, N
    gap, opening : clearance along the travel, m, and its rate, m/s
    mass, kg; stiffness, N/m, and damping, N s/m, against the motion in the clearance
    slack : depth in a wall, m, that is none: by the bend of a wall, taken as straight in a step, a
        roller that leaves it under a force near zero would land on it again at once
    """

    force: tuple[list[float], list[float]]
    forces: tuple[Array, Array]
    ends: tuple[list[float], list[float]]
    gap: list[float]
    opening: list[float]
    mass: float
    step: float
    stiffness: float
    damping: float
    slack: float

    @classmethod
    def of(
        cls,
        required: Array,
        clearance: Array,
        mass: float,
        cam_speed: float,
        stiffness: float = 0.0,
        damping: float = 0.0,
        motion: tuple[Array, Array, Array] | None = None,
    ) -> Walls:
        """Walls by the force of the inner one, at n equal angles of a turn.

        Parameters
        ----------
        required : array (n,)   axial force that the inner wall exerts on the follower that it
                                guides, N, positive outward
        clearance : array (n,)  of the roller along the travel, m, >= 0
        mass : float            kg, > 0
        cam_speed : float       rad/s, > 0
        stiffness, damping : float   of the spring, N/m, and of the guides, N s/m, in the clearance
        motion : arrays (n,)    force without that of inertia, N, lift, m, and velocity, m/s, on the
                                inner wall, which give the inertia of each step where the
                                acceleration jumps; None: the force is linear between the angles

        Raises
        ------
        InputError
            If mass or speed is not positive or a value not finite or out of its bounds.
        """
        positive("follower.mass", mass, "kg")
        positive("cam_speed", cam_speed, "rad/s")
        force, gap = finite("required_force", required), finite("clearance", clearance)
        if not (gap >= 0.0).all():
            raise InputError("clearance", float(gap.min()), ">= 0 m")
        step = FULL_TURN / force.size / cam_speed
        before, after = np.roll(gap, 1), np.roll(gap, -1)
        opening, bend = (after - before) / (2.0 * step), (after - 2.0 * gap + before) / step**2
        outer = force + stiffness * gap + damping * opening + mass * bend
        ends = force, np.roll(force, -1)
        if motion is not None:
            resting, lift, velocity = motion
            first, last = _accelerations(lift, velocity, step)
            ends = resting + mass * first, np.roll(resting, -1) + mass * last
        bent, widest = float(np.abs(after - 2.0 * gap + before).max()), float(gap.max())
        slack = min(max(bent, _LEAVING_ROUND_OFF * widest), _BENT_MOST * widest)
        return cls(
            (force.tolist(), outer.tolist()),
            (force, outer),
            (ends[0].tolist(), ends[1].tolist()),
            gap.tolist(),
            opening.tolist(),
            mass,
            step,
            stiffness,
            damping,
            slack,
        )

    def on(self, wall: float) -> list[float]:
        """Force (n,) of a wall on the follower that it guides, N."""
        return self.force[0 if wall == INNER else 1]

    @staticmethod
    def at(values: list[float], index: float) -> float:
        """Value at an index of the turn, in steps."""
        k = floor(index)
        count, share = len(values), index - k
        return (1.0 - share) * values[k % count] + share * values[(k + 1) % count]

    def landings(self, restitution: float = 0.0) -> tuple[Landing, ...]:
        """Flights of the roller through the clearance with their landings and rebounds, over a turn
        from the greatest force on; where it still rebounds there, from the middle of its longest
        rest on.

        Where the force changes its sign the roller leaves its wall and moves under the force alone,
        which the walls no longer exert; friction of the guides is none without side force. It
        rebounds from a wall until it would rise by less than `_REST_SHARE` of the clearance.

        Parameters
        ----------
        restitution : float   speed off a wall over that of the landing, >= 0, < 1

        Raises
        ------
        InputError
            If the restitution is not within [0, 1), or there are more than `_LANDINGS_MAX`.
        """
        if not 0.0 <= restitution < 1.0:
            raise InputError("follower.restitution", restitution, "in [0, 1)")
        force, _ = self.forces
        begin = int(np.abs(force).argmax())
        flown = self._over(float(begin), INNER if force[begin] > 0.0 else OUTER, restitution)
        if not flown or not flown[-1].rebound > 0.0:
            return flown
        rests = [
            ((after.take_off - one.landing + SAME_ANGLE) % FULL_TURN, one)
            for one, after in pairwise(flown)
            if one.rebound == 0.0
        ]
        if not rests:
            return flown
        longest, one = max(rests)
        middle = (one.landing + 0.5 * longest) % FULL_TURN
        return self._over(middle / FULL_TURN * force.size, one.wall, restitution)

    def _over(self, begin: float, wall: float, restitution: float) -> tuple[Landing, ...]:
        """Landings over a turn from a place, in steps, at which the roller rests on a wall; also
        those by which it rebounds, and leaves again where the force has not yet turned towards the
        wall.
        """
        least = _RIPPLE_SHARE * float(np.abs(self.forces[0]).max())
        index, end = begin, floor(begin) + len(self.gap)
        flown: list[Landing] = []
        off: float | None = None  # speed off the wall; None: at rest on it
        while len(flown) < _LANDINGS_MAX:
            if off is None:
                left = self._leaves(wall, index, end, least)
                if left is None:
                    return tuple(flown)
                index, off = left, 0.0
            landed = self._flown(index, wall, off, restitution)
            flown.append(landed)
            if not isfinite(landed.landing):
                return tuple(flown)
            wall, index = landed.wall, self._index(landed.landing, index)
            leaves = landed.rebound > 0.0 or landed.force < 0.0
            off = landed.rebound if leaves and index < end else None
        raise InputError("clearance", shown(max(self.gap), "mm"), "of fewer landings a turn")

    def _index(self, angle: float, after: float) -> float:
        """Index of a cam angle after another one, in steps."""
        count = len(self.gap)
        return after + (angle / FULL_TURN * count - after) % count

    def _leaves(self, wall: float, index: float, end: int, least: float) -> float | None:
        """Index of the turn, with its fraction, at which the force on the roller changes its sign
        for good, so that it leaves its wall; None: not before the end.

        Parameters
        ----------
        wall : float    on which the roller runs, `INNER` or `OUTER`
        index : float   place of the turn, in steps, from which on
        end : int       last index
        least : float   force towards the other wall that counts, N
        """
        force = self.forces[0 if wall == INNER else 1]
        away = -wall * force[np.arange(floor(index) + 1, end + 1) % force.size]
        beyond = np.flatnonzero(away > least)
        if not beyond.size:
            return None
        pressed = np.flatnonzero(away[: beyond[0]] <= 0.0)
        if not pressed.size:  # from the index itself, where it has just landed
            return index
        k = int(pressed[-1])
        share = -away[k] / (away[k + 1] - away[k])
        return max(index, floor(index) + 1 + k + float(share))

    def _flown(self, start: float, wall: float, off: float, restitution: float) -> Landing:
        """Flight of the roller from a wall, with its landing; without one within a turn the landing
        is NaN.

        Parameters
        ----------
        start : float         place of the turn, in steps, at which it leaves
        wall : float          that it leaves, `INNER` or `OUTER`
        off : float           speed off the wall, m/s
        restitution : float   of the landing
        """
        count = len(self.gap)
        index, position, speed = self._off(start, wall, off)
        while index < start + count:
            arc = self._arc(index, position, speed)
            for side in (INNER, OUTER):
                if arc.room(1.0, side) < -self.slack:
                    landed = self._landed(start, index, wall, side, arc, restitution)
                    return landed._replace(leaving=off)
            index, position, speed = self._free(
                floor(index) + 1, floor(start) + count, arc.position(1.0), arc.velocity(1.0)
            )
        turned = (start % count) / count * FULL_TURN
        return Landing(turned, nan, wall, wall, inf, nan, nan, leaving=off)

    def _off(self, start: float, wall: float, off: float) -> tuple[float, float, float]:
        """Place of the turn, in steps, at which the roller leaves a wall, its distance from the
        inner wall, m, and its speed, m/s; off : its speed off that wall, m/s.
        """
        if wall == INNER:
            return start, 0.0, off
        return start, self.at(self.gap, start), self.at(self.opening, start) - off

    def _free(self, k: int, last: int, position: float, speed: float) -> tuple[float, float, float]:
        """Place, distance and speed, see `_off`, at the begin of the step in which the roller
        lands, from the begin of step k on; by the steps of `_arc`, of which there are thousands.

        last : step that it does not enter
        """
        (begins, ends), gap, step = self.ends, self.gap, self.step
        spring, drag = self.stiffness / self.mass, self.damping / self.mass
        count, sixth = len(gap), step * step / 6.0
        while k < last:
            i, j = k % count, (k + 1) % count
            pulled = spring * position + drag * speed
            first = -begins[i] / self.mass - pulled
            guess = -ends[i] / self.mass - pulled
            ahead = position + speed * step + (2.0 * first + guess) * sixth
            faster = speed + 0.5 * (first + guess) * step
            end = -ends[i] / self.mass - spring * ahead - drag * faster
            ahead = position + speed * step + (2.0 * first + end) * sixth
            if ahead < -self.slack or ahead > gap[j] + self.slack:
                break
            position, speed, k = ahead, speed + 0.5 * (first + end) * step, k + 1
        return float(k), position, speed

    def flight(self, start: float, wall: float, off: float) -> Iterator[tuple[float, FlightStep]]:
        """Motion of the roller in flight without end: places of the turn, in steps, and the motion
        from there to the end of the step.

        Parameters
        ----------
        start, wall, off : place of the turn, in steps, wall that it leaves, and speed off it, m/s
        """
        index, position, speed = self._off(start, wall, off)
        while True:
            arc = self._arc(index, position, speed)
            yield index, arc
            position, speed = arc.position(1.0), arc.velocity(1.0)
            index = floor(index) + 1.0

    def _arc(self, index: float, position: float, speed: float) -> FlightStep:
        """Motion of the roller in flight from a place within a step of the turn to the end of the
        step, with linear acceleration.

        Parameters
        ----------
        index : float      place of the turn, in steps
        position : float   of the roller there, from the inner wall, m
        speed : float      there, m/s
        """
        end_of_step = floor(index) + 1.0
        span = (end_of_step - index) * self.step
        k = floor(index) % len(self.gap)
        before, after = self.ends[0][k], self.ends[1][k]
        before += (index - floor(index)) * (after - before)

        def rate(force: float, at: float, moving: float) -> float:
            return -(force + self.stiffness * at + self.damping * moving) / self.mass

        first, last = rate(before, position, speed), rate(after, position, speed)
        ahead = position + speed * span + (2.0 * first + last) * span**2 / 6.0
        last = rate(after, ahead, speed + 0.5 * (first + last) * span)
        gaps = self.at(self.gap, index), self.at(self.gap, end_of_step)
        return FlightStep(position, speed, first, last, span, gaps)

    def _landed(
        self,
        start: float,
        index: float,
        wall: float,
        side: float,
        arc: FlightStep,
        restitution: float,
    ) -> Landing:
        """Landing of the roller within a step of the turn.

        Parameters
        ----------
        start : float    place of the turn, in steps, at which it left its wall
        index : float    begin of the motion within the step
        wall : float     that it left
        side : float     wall on which it lands
        arc : FlightStep    motion to the end of the step
        restitution : float   of the landing
        """
        high = arc.lands(side)
        count, there = len(self.gap), index + high * (floor(index) + 1.0 - index)
        opening = 0.0 if side == INNER else self.at(self.opening, there)
        speed = max(side * (opening - arc.velocity(high)), 0.0)
        left, landed = (each % count / count * FULL_TURN for each in (start, there))
        force = side * self.at(self.on(side), there)
        time, rebound = (there - start) * self.step, restitution * speed
        least = _REST_SHARE * self.at(self.gap, there)
        if 0.5 * self.mass * rebound**2 < max(force, 0.0) * least:
            rebound = 0.0
        return Landing(left, landed, wall, side, time, speed, force, rebound)


def _accelerations(lift: Array, velocity: Array, step: float) -> tuple[Array, Array]:
    """Acceleration at begin and end of each step (n,), m/s2, linear in it, that gives the lifts,
    m, and velocities, m/s, of a turn in equal steps of time, s.
    """
    after, faster = np.roll(lift, -1), np.roll(velocity, -1)
    mean = (faster - velocity) / step
    bend = 6.0 * (after - lift - velocity * step) / step**2
    return bend - 2.0 * mean, 4.0 * mean - bend


class FlightStep(NamedTuple):
    """Flight within a step: position, m, from the inner wall, speed, m/s, of linear acceleration.

    gaps: of the groove at begin and end, m
    """

    start: float
    speed: float
    first: float
    last: float
    span: float
    gaps: tuple[float, float]

    def position(self, share: float) -> float:
        time, bend = share * self.span, share * (self.last - self.first)
        return self.start + self.speed * time + (self.first / 2.0 + bend / 6.0) * time**2

    def velocity(self, share: float) -> float:
        time, bend = share * self.span, share * (self.last - self.first)
        return self.speed + (self.first + bend / 2.0) * time

    def lands(self, side: float) -> float:
        """Share of the step at which it reaches a wall beyond which it ends, by Newton's steps
        within a bracket.
        """
        low, high, share = 0.0, 1.0, 1.0
        closes = (self.gaps[1] - self.gaps[0]) if side == OUTER else 0.0
        for _ in range(_LANDING_STEPS):
            room = self.room(share, side)
            low, high = (low, share) if room < 0.0 else (share, high)
            rate = side * self.span * self.velocity(share) + closes
            after = share - room / rate if rate else low
            if not low < after < high:
                after = 0.5 * (low + high)
            if abs(after - share) <= _SAME_SHARE:
                return after
            share = after
        return high

    def room(self, share: float, side: float) -> float:
        """Distance from a wall, m; negative beyond it."""
        gap = self.gaps[0] + share * (self.gaps[1] - self.gaps[0])
        return self.position(share) if side == INNER else gap - self.position(share)
