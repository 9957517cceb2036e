"""Crossovers of a roller in a groove: flight through the clearance, landing on the other wall."""

from __future__ import annotations

from math import floor, inf, isfinite, nan
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, finite, positive
from camwright.geometry.errors import InputError

INNER, OUTER = 1.0, -1.0
_RIPPLE_SHARE = 1e-2
"""Share of the greatest force below which a force of the other sign is none: the ripple of the
spline of a lift where its jerk steps, beside a dwell."""
_LEAVING_ROUND_OFF = 1e-9  # of the clearance, of a roller that leaves a wall
_LANDING_BISECTIONS = 60  # of the landing within a step
_LANDINGS_MAX = 1000  # a turn


class Landing(NamedTuple):
    """Landing of the roller on a wall after a flight through the clearance.

    take_off, landing : cam angles, rad; the landing is NaN where none follows within a turn
    start, wall : wall that it leaves, and on which it lands: 1 the inner, -1 the outer
    time : of the flight, s
    speed : against the wall along the travel, m/s, >= 0
    force : that presses it on the wall then, along the travel, N; negative: off it
    """

    take_off: float
    landing: float
    start: float
    wall: float
    time: float
    speed: float
    force: float

    @property
    def crosses(self) -> bool:
        """Whether it lands on the other wall."""
        return self.wall != self.start


def landings(
    required: Array,
    clearance: Array,
    mass: float,
    cam_speed: float,
    *,
    stiffness: float = 0.0,
    damping: float = 0.0,
) -> tuple[Landing, ...]:
    """Landings of a rigid follower between two walls over one turn, without rebound.

    The turn begins at the greatest force, on the wall that carries it. Where the force changes its
    sign the roller leaves that wall and moves under the force alone, which the walls no longer
    exert; friction of the guides is none without side force. The force is linear between the
    angles.

    Parameters
    ----------
    required : array (n,)   axial force that the walls exert on the given motion, N, positive
                            outward, at n equal angles of the turn
    clearance : array (n,)  of the roller along the travel, m, >= 0
    mass : float            kg, > 0
    cam_speed : float       rad/s, > 0
    stiffness, damping : float   of the spring, N/m, and of the guides, N s/m, in the clearance

    Raises
    ------
    InputError
        If mass or speed is not positive or a value not finite.
    """
    positive("follower.mass", mass, "kg")
    positive("cam_speed", cam_speed, "rad/s")
    force, gap = finite("required_force", required), finite("clearance", clearance)
    if not (gap >= 0.0).all():
        raise InputError("clearance", float(gap.min()), ">= 0 m")
    step = FULL_TURN / force.size / cam_speed
    return _Turn(force, gap, mass, step, stiffness, damping).landings()


class _Turn(NamedTuple):
    """Forces, N, and clearance, m, of a turn in equal steps of time, s."""

    force: Array
    gap: Array
    mass: float
    step: float
    stiffness: float
    damping: float

    def at(self, values: Array, index: float) -> float:
        """Value at an index of the turn, in steps."""
        k = floor(index)
        count, share = values.size, index - k
        return float((1.0 - share) * values[k % count] + share * values[(k + 1) % count])

    def landings(self) -> tuple[Landing, ...]:
        """Flights of the roller through the clearance with their landings, from the greatest force
        on over a turn; also those by which it rebounds where the force has not yet turned towards
        the wall.

        Raises
        ------
        InputError
            If there are more than `_LANDINGS_MAX`.
        """
        size = np.abs(self.force)
        count, begin = size.size, int(size.argmax())
        wall = INNER if self.force[begin] > 0.0 else OUTER
        index, least = float(begin), _RIPPLE_SHARE * size[begin]
        flown: list[Landing] = []
        while len(flown) < _LANDINGS_MAX:
            left = self._leaves(wall, index, begin + count, least)
            if left is None:
                return tuple(flown)
            landed = self._flown(left, wall)
            flown.append(landed)
            while isfinite(landed.landing) and landed.force < 0.0 and len(flown) < _LANDINGS_MAX:
                index = self._index(landed.landing, left)
                landed = self._flown(index, landed.wall)
                flown.append(landed)
            if not isfinite(landed.landing):
                return tuple(flown)
            wall, index = landed.wall, self._index(landed.landing, left)
        raise InputError("cam.groove.clearance", float(self.gap.max()), "of fewer landings a turn")

    def _index(self, angle: float, after: float) -> float:
        """Index of a cam angle after another one, in steps."""
        count = self.force.size
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
        count = self.force.size
        away = -wall * self.force[np.arange(floor(index) + 1, end + 1) % count]
        beyond = np.flatnonzero(away > least)
        if not beyond.size:
            return None
        pressed = np.flatnonzero(away[: beyond[0]] <= 0.0)
        if not pressed.size:  # from the index itself, where it has just landed
            return index
        k = int(pressed[-1])
        share = -away[k] / (away[k + 1] - away[k])
        return max(index, floor(index) + 1 + k + float(share))

    def _flown(self, start: float, wall: float) -> Landing:
        """Flight of the roller from a wall, with its landing; without one within a turn the landing
        is NaN.

        Parameters
        ----------
        start : float   place of the turn, in steps, at which it leaves
        wall : float    that it leaves, `INNER` or `OUTER`
        """
        count, index, position, speed = self.force.size, start, 0.0, 0.0
        if wall == OUTER:
            k = floor(index)
            position = self.at(self.gap, index)
            speed = float(self.gap[(k + 1) % count] - self.gap[k % count]) / self.step
        while index < start + count:
            arc = self._arc(index, position, speed)
            for side in (INNER, OUTER):
                if arc.room(1.0, side) < -_LEAVING_ROUND_OFF * arc.gaps[1]:
                    return self._landed(start, index, wall, side, arc)
            position, speed = arc.position(1.0), arc.velocity(1.0)
            index = floor(index) + 1.0
        turned = (start % count) / count * FULL_TURN
        return Landing(turned, nan, wall, wall, inf, nan, nan)

    def _arc(self, index: float, position: float, speed: float) -> _Passage:
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
        before, after = self.at(self.force, index), self.at(self.force, end_of_step)

        def rate(force: float, at: float, moving: float) -> float:
            return -(force + self.stiffness * at + self.damping * moving) / self.mass

        first, last = rate(before, position, speed), rate(after, position, speed)
        ahead = position + speed * span + (2.0 * first + last) * span**2 / 6.0
        last = rate(after, ahead, speed + 0.5 * (first + last) * span)
        gaps = self.at(self.gap, index), self.at(self.gap, end_of_step)
        return _Passage(position, speed, first, last, span, gaps)

    def _landed(
        self, start: float, index: float, wall: float, side: float, arc: _Passage
    ) -> Landing:
        """Landing of the roller within a step of the turn, by bisection.

        Parameters
        ----------
        start : float    place of the turn, in steps, at which it left its wall
        index : float    begin of the motion within the step
        wall : float     that it left
        side : float     wall on which it lands
        arc : _Passage   motion to the end of the step
        """
        low, high = 0.0, 1.0
        for _ in range(_LANDING_BISECTIONS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if arc.room(middle, side) < 0.0 else (middle, high)
        count, there = self.force.size, index + high * (floor(index) + 1.0 - index)
        opening = 0.0 if side == INNER else (arc.gaps[1] - arc.gaps[0]) / arc.span
        speed = max(side * (opening - arc.velocity(high)), 0.0)
        left, landed = (each % count / count * FULL_TURN for each in (start, there))
        force = side * self.at(self.force, there)
        time = (there - start) * self.step
        return Landing(left, landed, wall, side, time, speed, force)


class _Passage(NamedTuple):
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

    def room(self, share: float, side: float) -> float:
        """Distance from a wall, m; negative beyond it."""
        gap = self.gaps[0] + share * (self.gaps[1] - self.gaps[0])
        return self.position(share) if side == INNER else gap - self.position(share)
