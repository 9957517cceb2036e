"""External force of the machine on the follower, over the cam angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.errors import InputError

STANDARD_GRAVITY = 9.80665
"""Acceleration of free fall, m/s2."""


@dataclass(frozen=True, eq=False)
class ExternalForce:
    """Force along the follower axis over the cam angle, positive towards the cam.

    Linear between its samples and periodic; it does not depend on the lift. Of one sample:
    constant.

    Parameters
    ----------
    theta : array (n,)   rad, increasing within one turn
    force : array (n,)   N

    Raises
    ------
    InputError
        If the angles do not increase within one turn, or a value is not finite.
    """

    theta: Array
    force: Array

    def __post_init__(self) -> None:
        """Refuse values that are not finite, and angles that do not increase within one turn; the
        arrays become read-only.
        """
        theta = finite("follower.external_force", self.theta)
        force = finite("follower.external_force", self.force)
        if force.shape != theta.shape or not theta.size:
            raise InputError("follower.external_force", force.size, f"{theta.size} values, >= 1")
        steps = np.diff(theta, append=theta[0] + FULL_TURN)
        if not (steps > 0.0).all():
            limit = "at angles that increase within one turn"
            raise InputError("follower.external_force", float(theta[np.argmin(steps)]), limit)
        freeze(self, theta=theta, force=force)

    @classmethod
    def constant(cls, force: float) -> ExternalForce:
        """External force of a constant value, N."""
        return cls(np.zeros(1), np.array([force]))

    def plus(self, constant: float) -> ExternalForce:
        """Sum with a constant force, N, such as a weight."""
        return self if constant == 0.0 else ExternalForce(self.theta, self.force + constant)

    @property
    def varies(self) -> bool:
        """Whether the force depends on the angle."""
        return bool(np.ptp(self.force) > 0.0)

    @property
    def spacing(self) -> float:
        """Least step of its cam angles, rad."""
        return float(np.diff(self.theta, append=self.theta[0] + FULL_TURN).min())

    @property
    def mean(self) -> float:
        """Mean over the turn, N: exact integral of the linear parts."""
        steps = np.diff(self.theta, append=self.theta[0] + FULL_TURN)
        middle = self.force + 0.5 * (np.roll(self.force, -1) - self.force)
        return float(np.sum(steps * middle) / FULL_TURN) if self.varies else float(self.force[0])

    def at(self, theta: Array) -> Array:
        """Force at cam angles (...), rad, in N."""
        if not self.varies:
            return np.full(np.shape(theta), self.force[0])
        return np.asarray(np.interp(theta, self.theta, self.force, period=FULL_TURN))


NO_FORCE = ExternalForce.constant(0.0)
