"""Motion of the roller, its traction demand, rating life of its bearing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value, Values, finite, freeze
from camwright.geometry.errors import InputError
from camwright.geometry.pitch_curve import CentrePath, magnitude

BALL_LIFE_EXPONENT = 3.0  # ISO 281: 3 for ball bearings, 10/3 for roller bearings
RATED_REVOLUTIONS = 1e6  # of the dynamic rating, ISO 281


@dataclass(frozen=True, eq=False)
class RollingRoller:
    """Spin and surface speed of a roller without slip; arrays (n,), SI.

    `spin` and `spin_acceleration`: of the outer ring relative to the follower, rad/s and rad/s2;
    `pitch_speed`: of the roller centre along the pitch curve, m/s; `rolling_speed`: of both
    surfaces through the contact, the entrainment speed, m/s.
    """

    theta: Array
    spin: Array
    spin_acceleration: Array
    pitch_speed: Array
    rolling_speed: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    def where(self, pulls: NDArray[np.bool_], second: RollingRoller) -> RollingRoller:
        """Motion of the roller that carries: of the second one where that pulls (n,)."""
        names = (name for name in self.__dataclass_fields__ if name != "theta")
        pairs = {name: (getattr(second, name), getattr(self, name)) for name in names}
        return RollingRoller(
            self.theta, **{name: np.where(pulls, *pair) for name, pair in pairs.items()}
        )

    @property
    def spin_mean(self) -> float:
        """Mean of |spin|, rad/s."""
        return float(np.mean(np.abs(self.spin)))


@dataclass(frozen=True, eq=False)
class RatingLife:
    """Basic rating life (...): P_m, N; L10 in revolutions and in seconds."""

    mean_load: Array
    revolutions: Array
    seconds: Array


def roller_motion(
    pitch: CentrePath,
    roller_radius: float,
    cam_speed: float,
    theta: ArrayLike,
    cam_acceleration: float = 0.0,
    wall: Value = 1.0,
) -> RollingRoller:
    """Spin and rolling speed of a roller without slip.

    In the cam frame the roller centre moves along the pitch curve at w |P'| and the roller turns at
    w |P'|/r; relative to a stem it turns at w (|P'| - r)/r, relative to an arm by its own turning
    less. The surface speed through the contact is that of the contact point along the contour, w
    |P'| (1 - r kappa). On the outer wall of a groove, -r in place of r, it turns the other way.

    Parameters
    ----------
    pitch : CentrePath
    roller_radius : float        r, m, > 0
    cam_speed : float            w, rad/s
    theta : array (n,)           rad
    cam_acceleration : float     rad/s2
    wall : float or array (n,)   1, or -1 on the outer wall of a groove

    Returns
    -------
    RollingRoller

    Raises
    ------
    InputError
        If the radius is not positive or a value is not finite.

    References
    ----------
    Energy loss comparison between kinematically equivalent mechanisms: slider-crank and eccentric
    cam (2024), eqs 35-37, at any pitch curve.
    """
    if not 0.0 < roller_radius < np.inf:
        raise InputError("roller.radius", roller_radius, "> 0 m")
    theta = finite("theta", theta)
    speed = float(finite("cam_speed", cam_speed))
    motion = pitch.centre_motion(pitch.lift.jet(theta, 2), wall * roller_radius)
    stretch, spin_per_turn = motion.path_speed, np.asarray(motion.rolling)
    return RollingRoller(
        theta=theta,
        spin=speed * spin_per_turn,
        spin_acceleration=speed**2 * motion.slide_slope / (wall * roller_radius)
        + float(finite("cam_acceleration", cam_acceleration)) * spin_per_turn,
        pitch_speed=speed * stretch,
        rolling_speed=speed * stretch * (1.0 - motion.sharpness),
    )


def wear(normal_force: Values, spin: Values, exponent: float = BALL_LIFE_EXPONENT) -> Values:
    """N^p |n|, proportional to fatigue damage per time (ISO 281:2007, 6.2)."""
    return normal_force**exponent * magnitude(spin)


def equivalent_load(
    normal_force: ArrayLike, spin: ArrayLike, exponent: float = BALL_LIFE_EXPONENT
) -> Array:
    """Equivalent constant load P_m (...), N, of a roller bearing over positions equally spaced in
    time.

    P_m = (sum N^p |n| / sum |n|)^(1/p).

    Parameters
    ----------
    normal_force, spin : array (..., n)   N, n: force on the roller, N, and its speed, rad/s
    exponent : float                      p of the life

    Raises
    ------
    InputError
        If a force is negative, the shapes differ, or every spin of a turn is zero.

    References
    ----------
    ISO 281:2007, 5; Cardoso et al., Energies 18 (2025) 3256 for the loads.
    """
    force = finite("normal_force", normal_force)
    turns = np.abs(finite("roller spin", spin))
    if force.shape != turns.shape:
        raise InputError("roller spin", turns.shape, f"of shape {force.shape}")
    if (force < 0.0).any():
        raise InputError("normal_force", float(force.min()), ">= 0 N")
    if not turns.any(axis=-1).all():
        raise InputError("roller spin", 0.0, "> 0 rad/s at some angle")
    largest = force.max(axis=-1, keepdims=True)
    shares = np.divide(force, largest, out=np.zeros_like(force), where=largest > 0.0)
    share = wear(shares, turns, exponent).mean(axis=-1) / turns.mean(axis=-1)
    return np.asarray(largest[..., 0] * share ** (1.0 / exponent))


def rating_life(
    normal_force: ArrayLike,
    spin: ArrayLike,
    dynamic_rating: ArrayLike,
    exponent: float = BALL_LIFE_EXPONENT,
) -> RatingLife:
    """L10 rating life of the bearing under the load of the cycle.

    Parameters
    ----------
    normal_force : array (..., n)   N, at positions equally spaced in time
    spin : array (..., n)           rad/s
    dynamic_rating : array (...)    C, N, > 0
    exponent : float                3 for ball bearings, 10/3 for roller bearings

    Returns
    -------
    RatingLife   infinite without load

    Raises
    ------
    InputError
        If the rating is not positive; see `equivalent_load`.

    References
    ----------
    ISO 281:2007, 6.2: L10 = (C/P)^p million revolutions.
    """
    rating = np.asarray(dynamic_rating, dtype=float)
    if not ((rating > 0.0) & (rating < np.inf)).all():
        raise InputError("roller.bearing.C", float(rating.min()), "> 0 N")
    mean_load = equivalent_load(normal_force, spin, exponent)
    spin_mean = np.mean(np.abs(spin), axis=-1)
    unloaded = np.full(np.broadcast(rating, mean_load).shape, np.inf)
    ratio = np.divide(rating, mean_load, out=unloaded, where=mean_load > 0.0)
    revolutions = np.asarray(RATED_REVOLUTIONS * ratio**exponent)
    return RatingLife(mean_load, revolutions, np.asarray(revolutions * FULL_TURN / spin_mean))


def static_safety(normal_force: ArrayLike, static_rating: float) -> float:
    """Static safety factor s0 = C0 / N_max of the bearing of a roller; infinite without load.

    Parameters
    ----------
    normal_force : array (n,)   N on the roller, N
    static_rating : float       C0, N

    Raises
    ------
    InputError
        If the rating is not positive or a force is not finite.

    References
    ----------
    ISO 76:2006; manufacturers require 0.5 to 2 for ball bearings, 1.5 under shocks.
    """
    if not 0.0 < static_rating < np.inf:
        raise InputError("roller.bearing.C0", static_rating, "> 0 N")
    largest = float(np.max(np.abs(finite("normal_force", normal_force))))
    return static_rating / largest if largest > 0.0 else np.inf
