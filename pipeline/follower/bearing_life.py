"""Rating life of a roller bearing: lubrication, contamination, reliability, grease."""

from __future__ import annotations

from math import log, pi
from types import MappingProxyType

import numpy as np

from camwright.geometry.arrays import Array, Value, Values
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius
from camwright.pipeline.contact.rolling_bearing import Cleanliness
from camwright.pipeline.follower.roller_motion import BALL_LIFE_EXPONENT

LEAST_VISCOSITY_RATIO, GREATEST_VISCOSITY_RATIO = 0.1, 4.0  # range of a_ISO, ISO 281:2007, 9.3.3
GREATEST_MODIFICATION = 50.0  # a_ISO, ISO 281:2007, 9.3.3
_LARGE = 0.1  # m, pitch diameter from which the second contamination factor applies
CONTAMINATION: MappingProxyType[Cleanliness, tuple[float, float]] = MappingProxyType(
    {
        "extreme_cleanliness": (1.0, 1.0),
        "high_cleanliness": (0.6, 0.8),
        "normal_cleanliness": (0.5, 0.6),
        "slight_contamination": (0.3, 0.4),
        "typical_contamination": (0.1, 0.2),
        "severe_contamination": (0.0, 0.0),
        "very_severe_contamination": (0.0, 0.0),
    }
)
"""e_C below and from 100 mm of pitch diameter, lower ends of ISO 281:2007, table 13: verify."""

SOURCE = Source("v1, e_C and a_ISO of ISO 281:2007", confirmed=False)


_ROLLER_FACTOR = 1.15 * 89.0  # b_m f_c of radial roller bearings, greatest
_STATIC_FACTOR = 44.0  # N/mm2, of radial roller bearings
_ABOVE_STANDARD = 1.5  # makers' ratings over those of the standards
_SLIM = 35.0 / 108.0  # power of the roller diameter: 29/27 - 3/4


def rating_bound(outer_diameter: Value, width: Value) -> Value:
    """Upper bound of the dynamic load rating C of any bearing of a size (...), N.

    b_m f_c L^(7/9) Z^(3/4) D_w^(29/27) of a full complement of Z = pi (D - D_w)/D_w rollers as long
    as the bearing, of the diameter D_w with the greatest rating, times 1.5; ball bearings, with 1.3
    * 60 (i cos(a))^0.7 Z^(2/3) D_w^1.8, are below.

    Parameters
    ----------
    outer_diameter : (...)   D, m
    width : (...)            L, m

    References
    ----------
    ISO 281:2007, 5.1 and 7.1, tables of f_c and b_m, recalled: verify.
    """
    slim = _SLIM / (_SLIM + 0.75)
    factor: float = _ABOVE_STANDARD * _ROLLER_FACTOR * slim**_SLIM * (pi * (1.0 - slim)) ** 0.75
    length: Value = (1e3 * width) ** (7.0 / 9.0)
    diameter: Value = (1e3 * outer_diameter) ** (29.0 / 27.0)
    return factor * length * diameter


def static_rating_bound(outer_diameter: Value, width: Value) -> Value:
    """Upper bound of the static rating C0 of any bearing of a size (...), N; lengths in m.

    44 (1 - D_w/D_pw) Z L D_w < 44 pi D L of a full complement of rollers, times 1.5.

    References
    ----------
    ISO 76:2006, 8.1, recalled: verify.
    """
    area: Value = 1e6 * outer_diameter * width
    return area * (_ABOVE_STANDARD * _STATIC_FACTOR * pi)


_VISCOSITY_LINES = (45_000.0, -0.83), (4500.0, -0.5)
_FAST = 1000.0  # rpm, from which the second line of the rated viscosity holds


def viscosity_line(speed: float) -> tuple[float, float]:
    """Factor and exponent of the speed in `rated_viscosity`, at a speed in rpm."""
    return _VISCOSITY_LINES[speed >= _FAST]


def rated_viscosity(speed: Values, pitch_diameter: float) -> Values:
    """Rated kinematic viscosity v1 of a bearing (...), m2/s, at a speed, rpm, > 0; diameter in m.

    References
    ----------
    ISO 281:2007, 9.3.3.2: 45000 n^-0.83 D^-0.5 below 1000 rpm, 4500 n^-0.5 D^-0.5 above, in
    mm2/s and mm; recalled: verify.
    """
    (slow, of_slow), (fast, of_fast) = _VISCOSITY_LINES
    rated: Values = np.where(np.real(speed) < _FAST, slow * speed**of_slow, fast * speed**of_fast)
    return rated * (1e-6 / float(np.sqrt(1e3 * pitch_diameter)))


def contamination_factor(cleanliness: Cleanliness, pitch_diameter: float) -> float:
    """Contamination factor e_C of a cleanliness class; pitch diameter of the balls in m."""
    small, large = CONTAMINATION[cleanliness]
    return large if pitch_diameter >= _LARGE else small


def reliability_factor(reliability: float) -> float:
    """Life factor a1 of a reliability, 1 at 0.9.

    Weibull distribution with slope 1.5 above a least life of 0.05 L10; within 0.01 of ISO 281:2007,
    table 12, from 90 to 99.95 %.

    Raises
    ------
    InputError
        If the reliability is not between 0.9 and 1.

    References
    ----------
    ISO/TR 1281-2:2008: derivation of the table; recalled: verify.
    """
    if not 0.9 <= reliability < 1.0:
        raise InputError("roller_reliability", reliability, ">= 0.9 and < 1")
    share = log(1.0 / reliability) / log(1.0 / 0.9)
    return float(0.05 + 0.95 * share ** (1.0 / 1.5))


def life_modification(viscosity_ratio: Values, cleanliness_ratio: Values) -> Values:
    """Life modification factor a_ISO of radial ball bearings (...), at most 50.

    A complex step may have changed either ratio.

    Parameters
    ----------
    viscosity_ratio : array (...)     kappa, >= 0.1; above 4 as at 4
    cleanliness_ratio : array (...)   e_C P_u / P, >= 0

    References
    ----------
    ISO 281:2007, eqs 31-33; coefficients compared with a second transcription: verify.
    """
    most = GREATEST_VISCOSITY_RATIO
    kappa = np.where(np.real(viscosity_ratio) > most, most, viscosity_ratio)
    size = np.real(kappa)
    exponent = np.where(size < 0.4, 0.054381, np.where(size < 1.0, 0.19087, 0.071739))
    film = np.where(size < 0.4, 2.2649, 1.9987) / kappa**exponent
    left = 1.0 - (2.5671 - film) ** 0.83 * cleanliness_ratio ** (1.0 / 3.0)
    least = (0.1 / GREATEST_MODIFICATION) ** (1.0 / 9.3)
    modified: Values = 0.1 * np.where(np.real(left) < least, least, left) ** -9.3
    return modified


def life_used(
    force: Values, dynamic_rating: Value, cleanliness_load: Value, viscosity_ratio: Values
) -> Values:
    """(P/C)^3/a_ISO (...): fraction of life per million revolutions.

    Parameters
    ----------
    force : array (...)             P, N, > 0
    dynamic_rating : float          C, N, > 0
    cleanliness_load : float        e_C P_u, N, >= 0
    viscosity_ratio : array (...)   kappa, >= 0.1
    """
    modified = life_modification(viscosity_ratio, cleanliness_load / force)
    return (force / dynamic_rating) ** BALL_LIFE_EXPONENT / modified


def grease_life(
    speed: Array, outer_diameter: Value, load_share: Array, temperature: float
) -> Array:
    """Estimated mean life (...) of grease in a sealed ball bearing with rotating outer ring, s.

    NaN where n D > 500 000 mm/min, P > 0.2 C or T > 120 degC, outside the range of the estimate.
    Values of n D below 125 000 mm/min, of P below 0.05 C and of T below 50 degC count as these
    bounds. n D has the outer diameter in place of the mean one because the outer ring turns.

    Parameters
    ----------
    speed : array (...)            n, rpm
    outer_diameter : array (...)   D, m
    load_share : array (...)       P/C, equivalent load over dynamic load rating
    temperature : float            of the bearing, K

    References
    ----------
    JTEKT, Ball and Roller Bearings, sec. 12: log10 L = 6.10 - 4.40e-6 d n - 2.50 (P/C - 0.05)
    - (0.021 - 1.80e-8 d n) T, L in h, d in mm, n in rpm, T in degC; SKF for the outer ring: n D.
    Both cited from memory, not compared with the print.
    """
    share = np.where(load_share <= HEAVY_GREASE, np.maximum(load_share, _LIGHT_LOAD), np.nan)
    light = _light_grease(speed, outer_diameter, temperature)
    return 3600.0 * np.exp(log(10.0) * (light - _LOSS * (share - _LIGHT_LOAD)))


HEAVY_GREASE = 0.2
"""Greatest P/C of the estimate of the life of the grease."""
_LIGHT_LOAD, _LOSS = 0.05, 2.50
"""Least P/C that shortens the life of the grease; loss of log10 of the life per P/C."""
_NEWTON_STEPS = 60


def _light_grease(speed: Values, outer_diameter: Value, temperature: float) -> Values:
    """log10 of the life of grease in h (...), at low load; NaN outside the range of the curves, see
    `grease_life`.

    Parameters
    ----------
    speed : array (...)      n, rpm
    outer_diameter : (...)   D, m
    temperature : float      of the bearing, K
    """
    size = 1e3 * outer_diameter * speed
    factor = np.where(np.real(size) > 125e3, size, 125e3)
    warm = max(celsius(temperature), 50.0)
    life = 6.10 - 4.40e-6 * factor - (0.021 - 1.80e-8 * factor) * warm
    outside = (np.real(factor) > 500e3) | (warm > 120.0)
    within: Values = np.where(outside, np.nan, life)
    return within


def grease_load_share(
    life: float,
    speed: Values,
    outer_diameter: float,
    temperature: float,
    *,
    unbounded: bool = False,
) -> Values:
    """Greatest equivalent load over dynamic load rating, P/C (...), at which the grease reaches a
    life, within the range of the estimate.

    NaN where no load reaches the life, or speed and temperature are outside the range; see
    `grease_life`.

    Parameters
    ----------
    life : float             s, > 0
    speed : array (...)      rpm, > 0
    outer_diameter : float   of the bearing, m
    temperature : float      of the bearing, K
    unbounded : bool         the load that gives the life by the formula, also beyond its range of
                             P/C; NaN where speed or temperature is outside the range
    """
    light = _light_grease(speed, outer_diameter, temperature)
    share = _LIGHT_LOAD + (light - log(life / 3600.0) / log(10.0)) / _LOSS
    if unbounded:
        return share
    lasts: Values = np.where(np.real(share) < HEAVY_GREASE, share, HEAVY_GREASE)
    return np.where(np.real(share) >= _LIGHT_LOAD, lasts, np.nan)


def grease_load_factor(load_share: Array, allowed_share: Array, duty: Array) -> Array:
    """Factor (...) on the dynamic rating at which the grease lasts under a duty.

    The root f of sum q_i t/L_i = 1 with t/L_i = 10^(2.50 (max(P_i/(C f), 0.05) - x_i)); zero
    without load, and where the life is not reached without load.

    Parameters
    ----------
    load_share : array (..., s)      P_i/C, which a complex step may have changed
    allowed_share : array (..., s)   x_i, P/C at which the grease lasts in the load case alone; see
                                     `grease_load_share`, unbounded
    duty : array (s,)                q_i

    Raises
    ------
    ContactError
        If the root is not found.

    References
    ----------
    Palmgren (1924), Miner (1945): shares of life add up; JTEKT as in `grease_life`.
    """
    running, steep = duty > 0.0, _LOSS * log(10.0)
    share, load = duty[running], load_share[..., running]
    # P/C at which a load case alone takes the whole life
    room = allowed_share[..., running] - np.log(share) / steep
    sizes, least = np.real(load), np.exp(steep * (_LIGHT_LOAD - np.real(room))).sum(axis=-1)
    solvable = (sizes > 0.0).any(axis=-1) & (least < 1.0)
    if not solvable.any():
        return np.zeros(load.shape[:-1], dtype=load.dtype)
    ends = np.full(load.shape, np.inf)
    np.divide(np.real(room), sizes, out=ends, where=sizes > 0.0)
    inverse = np.where(solvable, ends.min(axis=-1), 1.0)

    def next_inverse(load: Array, room: Array) -> Array:
        """Newton's step for the logarithm of the sum, convex and rising in 1/f."""
        heavy = np.real(load) * inverse[..., None] > _LIGHT_LOAD
        used = np.where(heavy, load * inverse[..., None], _LIGHT_LOAD)
        parts: Array = np.exp(steep * (used - room))
        total, slope = parts.sum(axis=-1), steep * (parts * np.where(heavy, load, 0.0)).sum(axis=-1)
        step: Array = np.log(total) * total / np.where(solvable, slope, 1.0)
        return inverse - step

    for _ in range(_NEWTON_STEPS):
        before, inverse = inverse, next_inverse(sizes, np.real(room))
        if not np.any(before - inverse > 1e-15 * before, where=solvable):
            break
    else:
        raise ContactError(f"grease life: the load did not settle in {_NEWTON_STEPS} steps")
    return np.where(solvable, 1.0 / np.where(solvable, next_inverse(load, room), 1.0), 0.0)
