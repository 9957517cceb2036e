"""A roller that slips where the contact's traction does not suffice."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geometry.arrays import FULL_TURN, Array, finite, freeze
from geometry.errors import ContactError, InputError

_TURNS_MAX = 400
_SETTLED = 1e-9  # change of spin over a turn, of the greatest


@dataclass(frozen=True, eq=False)
class Skid:
    """Periodic spin of the roller; arrays (n,): rad/s, m/s, and the traction on it, N.

    `slip_speed` is the speed of the cam's surface over the roller's; `heat` the loss in the
    contact, W, mean over the turn.
    """

    spin: Array
    slip_speed: Array
    traction: Array
    heat: float

    def __post_init__(self) -> None:
        freeze(self, spin=self.spin, slip_speed=self.slip_speed, traction=self.traction)

    @property
    def share(self) -> float:
        """Share of the angles at which the roller slips."""
        return float(np.mean(self.slip_speed != 0.0))


def skid(
    normal_force: ArrayLike,
    rolling_spin: ArrayLike,
    cam_speed: float,
    inertia: float,
    radius: float,
    friction: float,
    drag: float = 0.0,
) -> Skid:
    """Spin of a roller at equal cam angles, Coulomb traction in the contact.

    At every step the roller keeps to the rolling spin if mu N r can give what its inertia and
    the bearing's drag ask for; else the full traction pulls it that way.

    Parameters
    ----------
    normal_force, rolling_spin : array (n,)   N, >= 0; rad/s without slip
    cam_speed : float                         rad/s, > 0
    inertia : float                           of the outer ring, kg m2, > 0
    radius : float                            m, > 0
    friction : float                          mu, >= 0
    drag : float                              of bearing and seals, N m, >= 0

    Raises
    ------
    InputError
        If a value is out of these bounds.
    ContactError
        If no periodic spin is found within 400 turns.

    References
    ----------
    Rothbart, Cam Design Handbook (2004), eq. 10.7: the condition for rolling.
    """
    force, spin = finite("normal_force", normal_force), finite("roller.spin", rolling_spin)
    for name, value in (("inertia", inertia), ("radius", radius), ("speed", cam_speed)):
        if not 0.0 < value < np.inf:
            raise InputError(f"roller.{name}", value, "> 0")
    for name, value in (("friction", friction), ("drag", drag)):
        if not 0.0 <= value < np.inf:
            raise InputError(f"roller.{name}", value, ">= 0")
    if (force < 0.0).any() or force.shape != spin.shape:
        raise InputError("normal_force", float(force.min()), ">= 0 N, one for each spin")
    step = FULL_TURN / force.size / cam_speed
    now = float(spin[0])
    for _ in range(_TURNS_MAX):
        found, torque = _turn(now, force * friction * radius, spin, step, inertia, drag)
        if abs(found[-1] - now) <= _SETTLED * float(np.abs(spin).max()):
            slip = (spin - np.roll(found, 1)) * radius
            traction = torque / radius
            heat = float(np.mean(np.abs(traction * slip)))
            return Skid(np.roll(found, 1), slip, traction, heat)
        now = float(found[-1])
    raise ContactError(f"roller: no periodic spin within {_TURNS_MAX} turns")


def _turn(
    start: float, grip: Array, spin: Array, step: float, inertia: float, drag: float
) -> tuple[Array, Array]:
    """Spin after each step of a turn, and the torque of the traction during it."""
    found, torque = np.empty_like(spin), np.empty_like(spin)
    aim = np.roll(spin, -1).tolist()
    now = start
    for k, (limit, target) in enumerate(zip(grip.tolist(), aim, strict=True)):
        brake = drag if now > 0.0 else -drag if now < 0.0 else 0.0
        needed = inertia * (target - now) / step + brake
        given = min(max(needed, -limit), limit)
        now = target if given == needed else now + (given - brake) / inertia * step
        found[k], torque[k] = now, given
    return found, torque
