"""Lift from cam torque: the torque's work is stored in the spring."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, positive, readonly
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import least
from camwright.geometry.lift import Lift, require_uniform_turn
from camwright.geometry.periodic_spline import PeriodicPolynomial, periodic_quintic

Deflection = Callable[[Array], Array]
"""Lift (...), m, at which a spring stores an energy (...), J."""

MEAN_TOLERANCE = 1e-12
"""Maximum mean over the maximum torque: round-off of removing the mean."""


def without_mean(torque: ArrayLike) -> tuple[Array, float]:
    """Torque less its mean, and the mean.

    Only torque of zero mean can be stored and returned within a turn.

    Parameters
    ----------
    torque : array (n,)    N m, at equal steps of one turn

    Returns
    -------
    torque : array (n,)    N m, of zero mean
    mean : float           N m
    """
    values = finite("torque", torque)
    mean = float(values.mean())
    return readonly(values - mean), mean


def stored_energy(theta: ArrayLike, cam_torque: ArrayLike) -> tuple[Array, float]:
    """Energy stored in the spring above its minimum over the turn.

    The exact integral of the periodic quintic through the torque samples; its minimum is that of
    the continuous curve and may lie between samples.

    Parameters
    ----------
    theta : array (n,)         cam angle, rad, equally spaced over [0, 2 pi)
    cam_torque : array (n,)    N m, positive when it loads the spring, of zero mean

    Returns
    -------
    energy : array (n,)    E - min E, J, >= 0
    closure : float        E(2 pi) - E(0), J: round-off for torque of zero mean

    Raises
    ------
    InputError
        If the torque has a mean; NaN included.
    """
    angle = finite("theta", theta)
    curve, gain = _energy_curve(angle, finite("cam_torque", cam_torque))
    lowest = least(curve, 4 * len(angle)).value
    energy = curve(angle)
    return readonly(energy - min(lowest, float(energy.min()))), gain


def lift_from_torque(
    theta: ArrayLike,
    cam_torque: ArrayLike,
    spring_rate: float,
    preload: float,
    initial_energy: float = 0.0,
) -> Lift:
    """Lift whose spring energy balances the torque: E0 + (E - min E) = P s + k s^2 / 2.

    The lift is minimal where the stored energy is. At the samples the spline's torque F_s s'
    differs from the target by its interpolation error, of order h^6 for a sample spacing h: below
    1e-7 of the maximum torque for 720 samples of 30 harmonics of amplitude 1/k.

    Parameters
    ----------
    theta : array (n,)         cam angle, rad, equally spaced over [0, 2 pi)
    cam_torque : array (n,)    N m, positive when it loads the spring, of zero mean
    spring_rate : float        k, N/m, > 0
    preload : float            P, spring force at zero lift, N, >= 0
    initial_energy : float     E0, J, >= 0: stored above the preload at the minimum lift, which
                               is then above zero

    Returns
    -------
    Lift    its `closure` is the difference between the ends of the integral, m

    Raises
    ------
    InputError
        If the torque has a mean, or the spring is slack at the minimum lift.

    References
    ----------
    Cardoso et al., Energies 18 (2025) 3256, sec. 2; step by step there, in closed form here.
    """
    if not 0 <= initial_energy < np.inf:
        raise InputError("spring.initial_energy", initial_energy, ">= 0 J and finite")
    _require_spring(spring_rate, preload)
    if not preload**2 + 2 * spring_rate * initial_energy > 0:
        raise InputError("spring.preload", preload, "> 0 N, or the minimum lift is a corner")
    return lift_of_spring(
        theta,
        cam_torque,
        lambda energy: spring_deflection(energy, spring_rate, preload),
        initial_energy,
    )


def lift_of_spring(
    theta: ArrayLike, cam_torque: ArrayLike, deflection: Deflection, initial_energy: float = 0.0
) -> Lift:
    """Lift whose energy in a spring of any characteristic balances the torque; see
    `lift_from_torque` for the other parameters.

    Parameters
    ----------
    deflection : callable    stored energy (...), J, >= 0 -> lift (...), m
    """
    energy, gain = stored_energy(theta, cam_torque)
    stored = initial_energy + energy
    values = deflection(stored)
    ends = deflection(np.maximum([stored[0], stored[0] + gain], 0))
    return Lift(readonly(theta), values, closure=float(abs(ends[1] - ends[0])))


def spring_deflection(energy: ArrayLike, spring_rate: ArrayLike, preload: ArrayLike) -> Array:
    """Deflection of a spring beyond its preload, from the energy it stores, m.

    Parameters
    ----------
    energy : array (...)         J, >= 0, beyond that of the preload
    spring_rate : array (...)    k, N/m, > 0
    preload : array (...)        P, N, >= 0
    """
    _require_spring(spring_rate, preload)
    stored = finite("spring.energy", energy)
    if not (stored >= 0).all():
        raise InputError("spring.energy", float(stored.min()), ">= 0 J")
    preload = np.asarray(preload, dtype=float)
    force = np.sqrt(preload**2 + 2 * np.asarray(spring_rate) * stored)
    # 2 E / (F + P) equals (F - P) / k without cancellation at small energies
    return readonly(
        np.divide(2 * stored, force + preload, out=np.zeros_like(force), where=force > 0)
    )


def signed_deflection(energy: Array, spring_rate: float, preload: float) -> Array:
    """Lift (n,), m, of a spring that may push or pull the follower, from the energy it stores.

    The spring has no force at the lift s0 = -P/k, and stores k (s - s0)^2/2 above that. A positive
    preload pushes at any lift, see `spring_deflection`. With a negative one the force changes its
    sign wherever the energy has its minimum, if a turn has an even number of minima: the follower
    swings about s0 by sqrt(2 E/k), to the side of the lower energy inwards. Of an odd number the
    spring pulls all over the turn, and the lift is zero where the energy is greatest.

    Parameters
    ----------
    energy : array (n,)    E, J, >= 0, at equal angles of a turn, above its minimum
    spring_rate : float    k, N/m, > 0
    preload : float        P, N, force at zero lift

    Raises
    ------
    InputError
        If the spring is too weak at zero lift: the lift would be negative, or have a corner.
    """
    if preload > 0.0:
        return spring_deflection(energy, spring_rate, preload)
    positive("spring.rate", spring_rate, "N/m")
    stored = finite("spring.energy", energy)
    free, side = -preload / spring_rate, _sides(stored)
    greatest = float(stored.max())
    if side is None:
        least_force = float(np.sqrt(2.0 * spring_rate * greatest))
        if not -preload > least_force * (1.0 + _PRELOAD_ROUND_OFF):
            limit = f"> 0 N, or < {-least_force:.6g} N: the force has to keep its sign"
            raise InputError("spring.preload", f"{preload:.6g} N", limit)
        lift = free - np.sqrt(free**2 - 2.0 * (greatest - stored) / spring_rate)
        return readonly(np.maximum(lift, 0.0))
    lift = free + side * np.sqrt(2.0 * stored / spring_rate)
    inwards = free - float(lift.min())
    if not inwards <= free * (1.0 + _PRELOAD_ROUND_OFF):
        limit = (
            f"> 0 N, or <= {-spring_rate * inwards:.6g} N: it swings {1e3 * inwards:.5g} mm inwards"
        )
        raise InputError("spring.preload", f"{preload:.6g} N", limit)
    return readonly(np.maximum(lift, 0.0))


def _sides(energy: Array) -> Array | None:
    """Side (n,) of its free length on which a spring stores an energy (n,), 1 or -1: it changes at
    each minimum of the energy, between the angles beside it; None of an odd number of them.
    """
    before, after = np.roll(energy, 1), np.roll(energy, -1)
    lowest = (energy <= before) & (energy < after)
    bend = before - 2.0 * energy + after
    away = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=lowest)
    vertex = energy - 0.25 * (before - after) * away
    minima = np.flatnonzero(lowest & (vertex <= _NO_ENERGY * energy.max()))
    if minima.size % 2:
        return None
    changes = np.zeros(energy.size, dtype=int)
    first = (minima + (away[minima] >= 0.0)) % energy.size  # the first angle beyond each minimum
    np.add.at(changes, first, 1)
    side = np.where(np.cumsum(changes) % 2, -1.0, 1.0)
    inner, outer = (float(energy[side == each].max(initial=0.0)) for each in (-1.0, 1.0))
    return side if inner <= outer else -side


_PRELOAD_ROUND_OFF = 1e-9  # of a preload
_NO_ENERGY = 1e-6
"""Energy at a minimum over the greatest up to which it is none: that between two samples."""


def _energy_curve(theta: Array, cam_torque: Array) -> tuple[PeriodicPolynomial, float]:
    """Integral of the torque from angle 0, J, as a function of the angle, and its change over the
    turn, J; theta (n,), rad, cam_torque (n,), N m.

    InputError for unequal angles or a mean torque.
    """
    require_uniform_turn("theta", theta)
    if cam_torque.shape != theta.shape:
        raise InputError("cam_torque", len(cam_torque), f"{len(theta)} values, one per angle")
    mean = float(cam_torque.mean())
    if not abs(mean) <= MEAN_TOLERANCE * float(np.abs(cam_torque).max()):
        raise InputError("cam_torque.mean", mean, "0 N m: the lift must close")
    return periodic_quintic(cam_torque).antiderivative()


def _require_spring(spring_rate: ArrayLike, preload: ArrayLike) -> None:
    """Refuse a rate, N/m, that is not positive, or a negative preload, N."""
    positive("spring.rate", spring_rate, "N/m")
    force = np.asarray(preload, dtype=float)
    if not ((force >= 0) & (force < np.inf)).all():
        raise InputError("spring.preload", float(force.min()), ">= 0 N and finite")
