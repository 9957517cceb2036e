"""Rocker: lift of its output from that of the follower and back, with lash."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import LAWS

_RAMP = LAWS["polynomial_4567"]  # its jerk is continuous at both ends
_CLOSED = 1e-9
"""Share of the greatest lift of an output up to which it is at rest."""


@dataclass(frozen=True)
class RockerArm:
    """Arm of a rocker whose end moves what slides along a straight line, or turns with the arm.

    Parameters
    ----------
    length : float   l, pivot to the end, m, > 0
    angle : float    beta at zero lift, from square to the line, positive in its outward stroke,
                     rad; None: travel along the arc of the end

    References
    ----------
    s = l (sin(beta + phi) - sin(beta)) of a swing phi, as of a pin that slides across the line, or
    of a round pad on a flat end square to it; else s = l phi.
    """

    length: Value
    angle: float | None = None

    def travel(self, swing: Value) -> Value:
        """Travel (...), m, of a swing, rad."""
        if self.angle is None:
            return self.length * swing
        # the product keeps the digits of a small swing
        half: Value = np.cos(self.angle + 0.5 * swing) * np.sin(0.5 * swing)
        return 2.0 * self.length * half

    def swing(self, travel: Value) -> Value:
        """Swing (...), rad, of a travel, m; NaN beyond the reach of the arm."""
        if self.angle is None:
            return travel / self.length
        sine, start = np.sin(self.angle) + travel / self.length, self.angle
        with np.errstate(invalid="ignore"):
            swing: Value = np.arcsin(sine) - start
        return swing

    def lever(self, swing: Value) -> Value:
        """Travel per swing (...), m/rad."""
        if self.angle is None:
            return self.length + 0.0 * swing
        lever: Value = self.length * np.cos(self.angle + swing)
        return lever

    def levers(self, swing: Value) -> tuple[Value, Value, Value]:
        """Derivatives (...) of the travel by the swing of order 1 to 3, m/rad^k."""
        first = self.lever(swing)
        if self.angle is None:
            return first, 0.0 * first, 0.0 * first
        return first, -self.length * np.sin(self.angle + swing), -first

    @property
    def dead_centre(self) -> float:
        """Swing at which the arm lies along its line, rad; half a turn without a line."""
        return np.pi if self.angle is None else 0.5 * np.pi - self.angle


@dataclass(frozen=True)
class RockerLinkage:
    """Two arms on one pivot: that of the follower, and that of the output, such as a valve.

    Parameters
    ----------
    first, second : RockerArm   on the follower and on the output
    lash : float                clearance at the output, m, >= 0, taken up before it moves
    """

    first: RockerArm
    second: RockerArm
    lash: float = 0.0

    @classmethod
    def of_ratio(cls, ratio: float, lash: float = 0.0) -> RockerLinkage:
        """Of a constant ratio, travel of the output over that of the follower."""
        return cls(RockerArm(1.0), RockerArm(ratio), lash)

    def output(self, lift: Value) -> Value:
        """Travel of the end of the second arm (...), m, at a lift of the follower, m."""
        return self.second.travel(self.first.swing(lift))

    def opening(self, lift: Array) -> Array:
        """Lift of the output (...), m: beyond the lash."""
        beyond = np.asarray(self.output(lift) - self.lash)
        return np.asarray(np.where(np.real(beyond) > 0.0, beyond, 0.0 * beyond))

    def follower(self, travel: Value) -> Value:
        """Lift of the follower (...), m, at a travel of the end of the second arm, m.

        NaN where an arm does not reach it.
        """
        return self.first.travel(self.second.swing(travel))

    def ratio(self, lift: Value) -> Value:
        """Travel of the output per lift of the follower (...)."""
        swing = self.first.swing(lift)
        return self.second.lever(swing) / self.first.lever(swing)

    def travel(self, lift: Value) -> tuple[Value, Value, Value, Value]:
        """Travel of the end of the second arm (...), m, and three derivatives by the lift.

        By those of the inverse of the lift over the swing.
        """
        swing = self.first.swing(lift)
        s1, s2, s3 = self.first.levers(swing)
        v1, v2, v3 = self.second.levers(swing)
        turn = 1.0 / s1
        bend, change = -s2 * turn**3, (3.0 * s2**2 * turn - s3) * turn**4
        return (
            self.second.travel(swing),
            v1 * turn,
            v2 * turn**2 + v1 * bend,
            v3 * turn**3 + 3.0 * v2 * turn * bend + v1 * change,
        )

    @property
    def most_lift(self) -> float:
        """Lift of the follower to the first dead centre of both arms, m."""
        return float(self.first.travel(min(self.first.dead_centre, self.second.dead_centre)))

    def follower_lift(self, opening: Lift, ramp: float) -> Lift:
        """Lift of the follower that opens the output as stated.

        Before and after it moves, the cam takes up and gives back the lash over an angle, by a
        polynomial 4-5-6-7.

        Parameters
        ----------
        opening : Lift   of the output, m
        ramp : float     angle of the cam, rad; used with a lash

        Raises
        ------
        InputError
            If an arm does not reach the lift, or the output rests for less than both ramps.
        """
        travel = opening.values
        if self.lash > 0.0:
            travel = travel + self.lash * _taken_up(opening, ramp)
        lift = np.asarray(self.follower(travel))
        if not np.isfinite(lift).all():
            stated = f"{1e3 * travel.max():.4g} mm"
            raise InputError("rocker lift of the output", stated, "within the reach of its arms")
        return Lift(opening.theta, lift, opening.closure, opening.spacing)


def _taken_up(opening: Lift, ramp: float) -> Array:
    """Share of the lash that is taken up (n,) at the angles of a lift: 1 where the output moves, 0
    at rest, rising over `ramp`, rad of cam angle, before the motion and falling over it after.

    Raises
    ------
    InputError
        If `ramp` is not above 0, or is longer than half the shortest rest of the output.
    """
    values, theta = opening.values, opening.theta
    moves = values > _CLOSED * values.max()
    if moves.all() or not moves.any():
        return np.asarray(moves, dtype=float)
    moving = theta[moves]
    to_next = np.min((moving - theta[:, None]) % FULL_TURN, axis=1)
    since = np.min((theta[:, None] - moving) % FULL_TURN, axis=1)
    rest = float((to_next + since)[~moves].min())
    if not 0.0 < 2.0 * ramp <= rest:
        most = f"> 0, <= {np.degrees(0.5 * rest):.4g} deg, half of the rest of the output"
        raise InputError("rocker.ramp", f"{np.degrees(ramp):.6g} deg", most)
    near = 1.0 - np.minimum(np.minimum(to_next, since) / ramp, 1.0)
    return np.asarray(_RAMP(near))
