"""Fatigue safety of the camshaft at the key of the cam; stresses of its gear teeth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite, uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.follower.camshaft_loads import Camshaft, ShaftLoads

_FIBRES = 72


@dataclass(frozen=True)
class Section:
    """Notched section of the shaft.

    Parameters
    ----------
    diameter : float               m
    notch_bending, notch_torsion   fatigue notch factors, >= 1
    endurance : float              fully reversed strength in bending, Pa
    tensile : float                tensile strength, Pa
    """

    diameter: float
    notch_bending: float
    notch_torsion: float
    endurance: float
    tensile: float

    def __post_init__(self) -> None:
        for name in ("diameter", "endurance", "tensile"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"camshaft.{name}", getattr(self, name), "> 0")
        for name in ("notch_bending", "notch_torsion"):
            if not 1.0 <= getattr(self, name) < np.inf:
                raise InputError(f"camshaft.{name}", getattr(self, name), ">= 1")


def bending_moment(loads: ShaftLoads, shaft: Camshaft, place: float) -> Array:
    """Bending moment (2, n), N m, at a place (m from the first bearing), by force component."""
    acting = (
        (0.0, loads.bearing_1),
        (shaft.bearing_spacing, loads.bearing_2),
        (shaft.cam_position, loads.cam),
        (shaft.gear_position, loads.gear),
    )
    return np.asarray(sum(force * (place - at) for at, force in acting if at < place))


def fatigue_safety(theta: ArrayLike, moment: Array, torque: ArrayLike, section: Section) -> float:
    """Fatigue safety factor of a rotating shaft under the loads of a turn.

    Loads are in the engine frame, fibres rotate with the shaft: bending and torsion of each fibre
    over one turn give an amplitude and a mean.

    Parameters
    ----------
    theta : array (n,)     angles of the shaft over one turn, rad
    moment : array (2, n)  N m, in the engine frame
    torque : array (n,)    N m
    section : Section

    Returns
    -------
    float    minimum over the fibres; infinite without load, NaN with an unknown load

    References
    ----------
    Shigley's Mechanical Engineering Design, sec. 7-4: distortion energy and Goodman's line.
    """
    angle, twist = np.asarray(theta, dtype=float), np.asarray(torque, dtype=float)
    if not (np.isfinite(moment).all() and np.isfinite(twist).all()):
        return float(np.nan)
    fibre = uniform_turn(_FIBRES)[:, None] + finite("theta", angle)
    modulus = np.pi * section.diameter**3 / 32.0
    bend = (moment[0] * np.cos(fibre) + moment[1] * np.sin(fibre)) / modulus
    shear = twist / (2.0 * modulus)

    def equivalent(of_bending: Array, of_torsion: float) -> Array:
        pull = section.notch_bending * of_bending
        return np.sqrt(pull**2 + 3.0 * (section.notch_torsion * of_torsion) ** 2)

    high, low = bend.max(axis=1), bend.min(axis=1)
    amplitude = equivalent(0.5 * (high - low), 0.5 * float(np.ptp(shear)))
    mean = equivalent(0.5 * (high + low), 0.5 * float(shear.max() + shear.min()))
    used = float(np.max(amplitude / section.endurance + mean / section.tensile))
    return np.inf if used == 0.0 else 1.0 / used


def tooth_root_stress(force: ArrayLike, width: float, module: float, teeth: int) -> Array:
    """Root bending stress (...) of a spur tooth, 20 deg full depth, Pa: F/(b m pi y).

    Parameters
    ----------
    force : array (...)    on the pitch circle, application factor included, N, >= 0
    width, module : float  m, > 0
    teeth : int            of the gear, >= 10

    References
    ----------
    Lewis (1892): y = 0.154 - 0.912/z for 20 deg full depth; load at the tip of a single tooth.
    """
    if teeth < 10:
        raise InputError("camshaft.gear.teeth", teeth, ">= 10")
    form = np.pi * (0.154 - 0.912 / teeth)
    return np.asarray(force, dtype=float) / (width * module * form)


def tooth_contact_stress(
    force: ArrayLike,
    width: float,
    pinion_diameter: float,
    ratio: float,
    pressure_angle: float,
    contact_modulus: float,
) -> Array:
    """Hertz pressure (...) of two spur teeth at the pitch point, Pa.

    Parameters
    ----------
    force : array (...)       on the pitch circle, application factor included, N, >= 0
    pinion_diameter : float   pitch diameter of the smaller gear, m
    ratio : float             teeth of the larger over those of the smaller, >= 1
    pressure_angle : float    rad
    contact_modulus : float   E*, Pa

    References
    ----------
    ISO 6336-2, sigma_H0 = Z_H Z_E sqrt(F (u + 1)/(b d1 u)), Z_H^2 = 2/(cos^2 a tan a),
    Z_E^2 = E*/pi.
    """
    zone = 2.0 / (np.cos(pressure_angle) ** 2 * np.tan(pressure_angle))
    elastic = contact_modulus / np.pi
    line = np.asarray(force, dtype=float) * (ratio + 1.0) / (width * pinion_diameter * ratio)
    return np.asarray(np.sqrt(zone * elastic * line))
