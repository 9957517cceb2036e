"""Radial compliance of pins, holes and bushes under harmonic pressures, plane strain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError


@dataclass(frozen=True)
class SolidBar:
    """Solid round bar loaded on its axis: Young's modulus, Pa, Poisson ratio."""

    modulus: float
    poisson: float

    def __post_init__(self) -> None:
        _elastic("pin", self.modulus, self.poisson)

    @property
    def plane_strain_modulus(self) -> float:
        """E/(1 - nu^2), Pa."""
        return self.modulus / (1.0 - self.poisson**2)


@dataclass(frozen=True)
class Bush(SolidBar):
    """Hole in a body, or bush of a `wall` over its radius, bonded into a rigid housing.

    wall None: the hole in an infinite body.
    """

    wall: float | None = None

    def __post_init__(self) -> None:
        _elastic("bush", self.modulus, self.poisson)
        if self.wall is not None and not 0.0 < self.wall < np.inf:
            raise InputError("bush.wall", self.wall, "> 0 of the radius")


def _elastic(field: str, modulus: float, poisson: float) -> None:
    """Refuse a modulus or Poisson's ratio out of bounds; field: name in the message."""
    if not 0.0 < modulus < np.inf:
        raise InputError(f"{field}.modulus", modulus, "> 0 Pa")
    if not 0.0 <= poisson < 0.5:
        raise InputError(f"{field}.poisson", poisson, ">= 0 and < 0.5")


def pin_compliance(count: int, pin: SolidBar) -> Array:
    """Inward radial displacement of a pin of radius 1 over its pressure cos(n phi), n = 0 to count
    - 1, (count,), 1/Pa.

    The first harmonic, n = 1, is 0: its radial displacement is a rigid translation.

    References
    ----------
    Barber, Elasticity (2010), Michell's solution, tables 8.1 and 9.1.
    """
    shear, kappa = _constants(pin)
    n = np.arange(2.0, count)
    higher = (1.0 / (n - 1.0) + kappa / (n + 1.0)) / (4.0 * shear)
    return np.concatenate([[(kappa - 1.0) / (4.0 * shear), 0.0], higher])


def bush_compliance(count: int, bush: Bush) -> Array:
    """Outward radial displacement of a hole of radius 1 over its pressure cos(n phi), n = 0 to
    count - 1, (count,), 1/Pa; 0 for n = 1, a rigid translation.
    """
    shear, kappa = _constants(bush)
    n = np.arange(2.0, count)
    if bush.wall is None:
        higher = (kappa / (n - 1.0) + 1.0 / (n + 1.0)) / (4.0 * shear)
        return np.concatenate([[1.0 / (2.0 * shear), 0.0], higher])
    outer = 1.0 + bush.wall
    # u = A r + B/r with u(outer) = 0, radial stress -1 at the hole
    uniform = (outer**2 - 1.0) / (2.0 * shear * (2.0 / (kappa - 1.0) + outer**2))
    return np.concatenate([[uniform, 0.0], _bonded(n, outer, kappa) / (2.0 * shear)])


def _bonded(n: Array, outer: float, kappa: float) -> Array:
    """Outward radial displacement of the hole of a bush under a unit pressure cos(n phi), times
    twice the shear modulus, (m,), by Michell's solution; the outer surface is clamped.

    Parameters
    ----------
    n : array (m,)   harmonics, >= 2
    outer : float    outer radius over that of the hole
    kappa : float    Kolosov's constant, 3 - 4 nu
    """
    # Terms that grow with the radius are scaled to 1 at the outer radius, others at the hole.
    grow, decay = outer ** (-n), outer ** (-n)
    zero = np.zeros_like(n)
    stress = [-n * (n - 1) * grow, -(n + 1) * (n - 2) * grow, -n * (n + 1), -(n + 2) * (n - 1)]
    shear = [n * (n - 1) * grow, n * (n + 1) * grow, -n * (n + 1), -n * (n - 1)]
    radial = [-n * grow, (kappa - n - 1) * grow, n + zero, kappa + n - 1]
    radial_out = [
        -n / outer,
        (kappa - n - 1) * outer,
        n * decay / outer,
        (kappa + n - 1) * decay * outer,
    ]
    turning_out = [
        n / outer,
        (kappa + n + 1) * outer,
        n * decay / outer,
        -(kappa - n + 1) * decay * outer,
    ]
    system = np.moveaxis(np.array([stress, shear, radial_out, turning_out]), 2, 0)
    right = np.zeros((n.size, 4, 1))
    right[:, 0] = -1.0
    size = np.abs(system).max(axis=2, keepdims=True)
    coefficients = np.linalg.solve(system / size, right / size)[..., 0]
    return np.asarray(np.sum(coefficients * np.array(radial).T, axis=1))


def _constants(body: SolidBar) -> tuple[float, float]:
    """Shear modulus, Pa, and Kolosov's constant in plane strain."""
    return body.modulus / (2.0 * (1.0 + body.poisson)), 3.0 - 4.0 * body.poisson
