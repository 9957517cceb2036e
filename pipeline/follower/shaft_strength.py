"""Strength of the camshaft: moments, fatigue, yield, deflection; keyway root, gear teeth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, Value, distinct, finite, freeze, uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import from_unit, in_unit
from camwright.pipeline.follower.camshaft_loads import (
    Camshaft,
    SecondDisc,
    ShaftLoads,
    ShaftSection,
    Surface,
)

_SHAFT_FIBRES = 72  # around the shaft, 5 deg apart
_SAME_PLACE = 1e-6  # m
_FINISH: Mapping[Surface, tuple[float, float]] = {
    "ground": (1.58, -0.085),
    "machined": (4.51, -0.265),
    "hot_rolled": (57.7, -0.718),
    "forged": (272.0, -0.995),
}


@dataclass(frozen=True, eq=False)
class Sections:
    """Notched sections of the shaft: positions, diameters and notch factors, arrays (k,).

    place: m from the first bearing; diameter, m; notch_bending, notch_torsion: fatigue notch
    factors.
    """

    place: Array
    diameter: Array
    notch_bending: Array
    notch_torsion: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @classmethod
    def of(cls, sections: Sequence[ShaftSection]) -> Sections:
        """Sections of a shaft side by side."""
        names = ("position", "diameter", "notch_bending", "notch_torsion")
        return cls(*(np.array([getattr(one, name) for one in sections]) for name in names))

    @property
    def modulus(self) -> Array:
        """Section modulus in bending (k,), m3."""
        return np.asarray(np.pi * self.diameter**3 / 32.0)


@lru_cache(maxsize=8)
def judged_sections(
    shaft: Camshaft, diameter: float, cam_reach: float, gear_reach: float, spacing: float = 0.0
) -> tuple[ShaftSection, ...]:
    """Judged shaft sections: cam, gear, bearings, counterweight, and those of the case.

    The bending moment is linear between forces, so its maximum lies at one of them. The seats of
    cam and gear are taken at their middle and, since their force is spread, at both ends.

    Parameters
    ----------
    diameter : float                  of seats that the case does not list, m
    cam_reach, gear_reach : float     half of the length of the seats, m
    spacing : float                   from the cam to a second disc, m; 0 without one
    """
    keyed = (shaft.notch_bending, shaft.notch_torsion)
    shouldered = (shaft.seat_notch_bending, shaft.seat_notch_torsion)
    seats: tuple[tuple[str, float, float, tuple[float, float]], ...] = (
        ("cam", shaft.cam_position, cam_reach, keyed),
        ("gear", shaft.gear_position, gear_reach, keyed),
        ("bearing 1", 0.0, 0.0, shouldered),
        ("bearing 2", shaft.bearing_spacing, 0.0, shouldered),
    )
    if spacing > 0.0:
        seats = (*seats, ("second disc", shaft.cam_position + spacing, cam_reach, keyed))
    weight = shaft.counterweight
    if weight is not None:
        seats = (*seats, ("counterweight", weight.position, 0.0, keyed))
    others, judged = list(shaft.sections), []
    for name, position, reach, (bending, torsion) in seats:
        listed = [one for one in others if abs(one.position - position) < _SAME_PLACE]
        plain = ShaftSection(
            name=name,
            position=position,
            diameter=diameter,
            notch_bending=bending,
            notch_torsion=torsion,
        )
        for seat in listed or [plain]:
            others = [one for one in others if one is not seat]
            steps = (0.0, -reach, reach) if reach > 0.0 else (0.0,)
            judged += [replace(seat, position=position + step) for step in steps]
    return (*judged, *others)


def bending_moment(loads: ShaftLoads, shaft: Camshaft, place: ArrayLike) -> Array:
    """Bending moment of the camshaft (..., 2, n), N m, by both components of the forces over the
    turn.

    Parameters
    ----------
    loads : ShaftLoads    forces (2, n), N
    shaft : Camshaft      with the places of the forces
    place : array (...)   from the first bearing, m
    """
    reach = np.asarray(place, dtype=float)[..., None, None]
    acting = [
        (0.0, loads.bearing_1),
        (shaft.bearing_spacing, loads.bearing_2),
        (shaft.cam_position, loads.cam),
        (shaft.gear_position, loads.gear),
    ]
    if shaft.counterweight is not None:
        acting.append((shaft.counterweight.position, loads.counterweight))
    if loads.second is not None:
        acting.append((shaft.cam_position + loads.second.spacing, loads.second.force))
    return np.asarray(sum(force * np.maximum(reach - at, 0.0) for at, force in acting))


def torque_at(
    torque: Array, shaft: Camshaft, place: ArrayLike, second: SecondDisc | None = None
) -> Array:
    """Torque of the camshaft (..., n), N m: between gear and cam that on the cam and the drag,
    elsewhere 0; between gear and a second disc its own.

    Parameters
    ----------
    torque : array (n,)   on the cam, of both discs, N m
    shaft : Camshaft      with the places of gear and cam
    place : array (...)   from the first bearing, m
    second : SecondDisc   of a pair
    """
    at = np.asarray(place, dtype=float)[..., None]

    def passed(torque: Array, position: float) -> Array:
        """Torque between the gear and a position, elsewhere 0."""
        low, high = sorted((position, shaft.gear_position))
        within = (low - _SAME_PLACE <= at) & (at <= high + _SAME_PLACE)
        return np.where(within, torque, 0.0)

    if second is None:
        return passed(torque + shaft.drag, shaft.cam_position)
    first = passed(torque - second.torque + shaft.drag, shaft.cam_position)
    return first + passed(second.torque, shaft.cam_position + second.spacing)


def surface_factor(surface: Surface, tensile: float) -> float:
    """Marin's surface factor k_a = a R_m^b, at most 1; R_m in Pa.

    References
    ----------
    Shigley's Mechanical Engineering Design, 10th ed., table 6-2 (recalled, verify).
    """
    factor, exponent = _FINISH[surface]
    return float(min(1.0, factor * in_unit(tensile, "MPa") ** exponent))


def size_factor(diameter: Value) -> Value:
    """Marin's size factor k_b (...) of a rotating round section against 7.62 mm; diameter in m.

    References
    ----------
    Shigley's Mechanical Engineering Design, 10th ed., eq. 6-20 (recalled, verify).
    """
    d = np.asarray(diameter) / from_unit(1.0, "mm")
    return np.minimum(1.0, np.where(d <= 51.0, (d / 7.62) ** -0.107, 1.51 * d**-0.157))[()]


def reliability_factor(reliability: float) -> float:
    """Reliability factor k_e = 1 - 0.08 z: 0.814 at 99 %.

    References
    ----------
    Shigley's Mechanical Engineering Design, 10th ed., eq. 6-29: standard deviation of 8 %.
    """
    return float(1.0 - 0.08 * NormalDist().inv_cdf(reliability))


def equivalent_stress(normal: Array, shear: Array) -> Array:
    """Von Mises stress (...) of a normal and a shear stress, Pa; complex for a step."""
    return np.asarray(np.sqrt(normal**2 + 3.0 * shear**2))


def fibre_stresses(
    theta: ArrayLike, moment: Array, torque: Array, sections: Sections
) -> tuple[Array, Array]:
    """Von Mises amplitude and mean, Pa, of m fibres in k sections of a rotating shaft over a turn.

    Loads are in the engine frame, fibres rotate with the shaft.

    Parameters
    ----------
    theta : array (n,)         angles of the shaft over one turn, rad
    moment : array (k, 2, n)   bending moment at each section, two components in the engine frame, N
                               m
    torque : array (k, n)      N m
    sections : Sections        their diameters and notch factors (k,)

    Returns
    -------
    amplitude, mean : array (k, m)   with the notch factors; NaN with an unknown load

    References
    ----------
    Shigley's Mechanical Engineering Design, sec. 7-4: distortion energy.
    """
    angle = finite("theta", theta)
    if not (np.isfinite(moment).all() and np.isfinite(torque).all()):
        unknown = np.full((len(moment), _SHAFT_FIBRES), np.nan)
        return unknown, unknown
    cosine, sine, (x, y) = np.cos(angle), np.sin(angle), np.moveaxis(moment, 1, 0)
    on_shaft = np.stack([x * cosine + y * sine, y * cosine - x * sine], axis=1)
    fibre, modulus = uniform_turn(_SHAFT_FIBRES), sections.modulus
    bending = np.stack([np.cos(fibre), np.sin(fibre)], axis=1) @ on_shaft / modulus[:, None, None]
    shear = torque / (2.0 * modulus)[:, None]

    def equivalent(of_bending: Array, of_torsion: Array) -> Array:
        pull = sections.notch_bending[:, None] * of_bending
        twist = (sections.notch_torsion * of_torsion)[:, None]
        return equivalent_stress(pull, twist)

    high, low = bending.max(axis=2), bending.min(axis=2)
    most, least = shear.max(axis=1), shear.min(axis=1)
    amplitude = equivalent(0.5 * (high - low), 0.5 * (most - least))
    mean = equivalent(0.5 * (high + low), 0.5 * (most + least))
    return amplitude, mean


def fatigue_safety(amplitude: Array, mean: Array, endurance: Array, tensile: float) -> Array:
    """Fatigue safety factor (k,) of a rotating shaft by Goodman's line; see `fibre_stresses`.

    Parameters
    ----------
    amplitude, mean : array (k, m)   of the fibres, Pa
    endurance : array (k,)           fully reversed strength in bending of the sections, Pa
    tensile : float                  tensile strength, Pa

    Returns
    -------
    array (k,)    minimum over the fibres; infinite without load, NaN with an unknown load

    References
    ----------
    Shigley's Mechanical Engineering Design, sec. 7-4: Goodman's line.
    """
    used = (amplitude / endurance[:, None] + mean / tensile).max(axis=1)
    return np.asarray(np.divide(1.0, used, out=np.full_like(used, np.inf), where=used != 0.0))


def greatest_stress(moment: Array, torque: Array, sections: Sections) -> Array:
    """Von Mises stress (k, n), Pa, at the k notched sections of the camshaft.

    Parameters
    ----------
    moment : array (k, 2, n)   bending moment at each section, N m
    torque : array (k, n)      N m
    sections : Sections        diameters and fatigue notch factors

    References
    ----------
    Shigley's Mechanical Engineering Design, 10th ed., eq. 7-15, with the fatigue notch factors.
    """
    modulus = sections.modulus[:, None]
    bending = sections.notch_bending[:, None] * np.hypot(moment[:, 0], moment[:, 1]) / modulus
    shear = sections.notch_torsion[:, None] * torque / (2.0 * modulus)
    return equivalent_stress(bending, shear)


@dataclass(frozen=True, eq=False)
class ShaftBending:
    """Deflection at the cam (2, n), m, of two discs the greater one, and slopes at both bearings
    (2, n), rad, engine frame.
    """

    deflection: Array
    slope_1: Array
    slope_2: Array


def shaft_bending(
    loads: ShaftLoads, shaft: Camshaft, diameter: float, elastic_modulus: float
) -> ShaftBending:
    """Deflection at the cam and slopes at the bearings of a uniform camshaft on two rigid bearings,
    without shear.

    Parameters
    ----------
    loads : ShaftLoads        forces over the turn
    shaft : Camshaft          with their places
    diameter : float          m, > 0
    elastic_modulus : float   E, Pa, > 0

    References
    ----------
    Unit-load method: integral of m M/(E I); exact, since both moments are linear between forces.
    """
    span, cam = shaft.bearing_spacing, shaft.cam_position
    discs = [cam] if loads.second is None else [cam, cam + loads.second.spacing]
    stiffness = elastic_modulus * np.pi * diameter**4 / 64.0
    weight = shaft.counterweight
    beside = cam if weight is None else weight.position
    corners = distinct([0.0, span, *discs, shaft.gear_position, beside])
    start, end = corners[:-1, None], corners[1:, None]
    places = np.hstack([start, 0.5 * (start + end), end])

    def under(disc: float) -> Array:
        """Moment of a unit force at a disc."""
        acting = ((0.0, -(1.0 - disc / span)), (span, -disc / span), (disc, 1.0))
        return np.asarray(sum(force * np.maximum(places - at, 0.0) for at, force in acting))

    # moments of unit couples at the bearings and of unit forces at the discs
    inside = (start >= 0.0) & (end <= span)  # a couple leaves the overhung ends without moment
    couples = inside * (1.0 - places / span), inside * (places / span)
    units = np.stack([*couples, *map(under, discs)])
    simpson, step = np.array([1.0, 4.0, 1.0])[:, None, None], (end - start)[..., None, None]
    moment = bending_moment(loads, shaft, places) * simpson * step / 6.0
    shape = (len(units), places.size, *loads.cam.shape)
    total = (units[..., None, None] * moment).reshape(shape).sum(axis=1)
    slope_1, slope_2, deflection, *others = total / stiffness
    for other in others:
        deflection = np.where(np.hypot(*other) > np.hypot(*deflection), other, deflection)
    return ShaftBending(deflection, slope_1, slope_2)


class CamSlope(NamedTuple):
    """Slope of the shaft at the cam per force at cam, gear and counterweight, rad/N.

    couple: per moment at the cam, rad/(N m), > 0; beside: per force at the other disc of a pair.
    """

    cam: Value
    gear: Value
    counterweight: Value
    couple: Value
    beside: Value = 0.0

    def under(
        self, cam: Array, gear: Array, counterweight: ArrayLike = 0.0, beside: ArrayLike = 0.0
    ) -> Array:
        """Slope (2, ...), rad, under forces (2, ...), N: rise of the deflection from bearing 1."""
        weight = self.counterweight * np.asarray(counterweight, dtype=float)
        other = self.beside * np.asarray(beside, dtype=float)
        return np.asarray(self.cam * cam + self.gear * gear + weight + other)


@lru_cache(maxsize=32)
def cam_slope(
    shaft: Camshaft, diameter: float, elastic_modulus: float, beside: float = 0.0
) -> CamSlope:
    """Slopes of a uniform camshaft at the cam per unit force at cam, gear and counterweight, and
    per unit moment at the cam; the cam is between the bearings or overhung.

    Parameters
    ----------
    shaft : Camshaft          with the places of the forces
    diameter : float          m
    elastic_modulus : float   E, Pa
    beside : float            from the cam to the other disc of a pair, m

    References
    ----------
    Unit-load method, of a unit couple at the cam; exact, see `shaft_bending`.
    """
    span, cam = shaft.bearing_spacing, shaft.cam_position
    weight = cam if shaft.counterweight is None else shaft.counterweight.position
    stiffness = elastic_modulus * np.pi * diameter**4 / 64.0
    corners = distinct([0.0, span, cam, shaft.gear_position, weight, cam + beside])
    start, end = corners[:-1], corners[1:]
    places = np.stack([start, 0.5 * (start + end), end])

    def reacted(at: float, first: float, second: float) -> Array:
        """Moment at the places of forces at the bearings, and of one at a place that they hold."""
        load = -(first + second)
        return np.asarray(
            first * np.maximum(places, 0.0)
            + second * np.maximum(places - span, 0.0)
            + load * np.maximum(places - at, 0.0)
        )

    couple = reacted(cam, 1.0 / span, -1.0 / span) - (start >= cam)
    weights = (end - start) * np.array([[1.0], [4.0], [1.0]]) / (6.0 * stiffness)
    under_cam, under_gear, under_weight, under_other = (
        float(np.sum(weights * couple * reacted(at, at / span - 1.0, -at / span)))
        for at in (cam, shaft.gear_position, weight, cam + beside)
    )
    yields = float(np.sum(weights * couple**2))
    return CamSlope(under_cam, under_gear, under_weight, yields, under_other)


def slope_of(shaft: Camshaft | None, beside: float = 0.0) -> CamSlope | None:
    """Slope at the cam per force of a shaft at its least diameter.

    None without a shaft, or where the case does not state its diameter or material.

    Parameters
    ----------
    beside : float   from the cam to the other disc of a pair, m
    """
    if shaft is None or shaft.thinnest is None or shaft.material is None:
        return None
    return cam_slope(shaft, shaft.thinnest, shaft.material.E, beside)


def slopes_of(shaft: Camshaft | None, spacing: float | None = None) -> tuple[CamSlope, ...]:
    """Slopes at each disc of a cam; () as `slope_of` is None.

    Parameters
    ----------
    spacing : float   of a second disc from the first, m; None: of one disc
    """
    if shaft is None:
        return ()
    slopes = [slope_of(shaft, spacing or 0.0)]
    if spacing is not None:
        there = replace(shaft, cam_position=shaft.cam_position + spacing)
        slopes.append(slope_of(there, -spacing))
    return tuple(each for each in slopes if each is not None)


def of_disc(values: Sequence[Value], pulls: NDArray[np.bool_]) -> Value:
    """Of values (...), one a disc, those of the disc that carries: the second where it pulls."""
    first, *others = values
    return np.where(pulls, others[0], first) if others else first


def couple_compliance(slopes: Sequence[CamSlope], pulls: NDArray[np.bool_]) -> Value:
    """Slope of the shaft at the disc that carries per moment there, rad/(N m); 0 of a rigid one.

    pulls : bool (...)   where the second disc of a pair carries
    """
    return of_disc([each.couple for each in slopes], pulls) if slopes else 0.0


def slope_under(
    slopes: Sequence[CamSlope],
    pushes: Sequence[Array],
    gear: Array,
    counterweight: ArrayLike,
    pulls: NDArray[np.bool_],
) -> Array:
    """Slope (2, ...), rad, of the shaft at the disc that carries, under forces on every disc, gear
    and counterweight (2, ...), N; slopes, pushes : one a disc.
    """
    if len(slopes) == 1:
        return slopes[0].under(pushes[0], gear, counterweight)
    pairs = zip(slopes, pushes, pushes[::-1], strict=True)
    return np.asarray(
        of_disc([at.under(on, gear, counterweight, beside) for at, on, beside in pairs], pulls)
    )


def in_the_normal(slope: Array, pressure_angle: Array) -> Array:
    """Component (...) of a shaft slope (2, ...), rad, in the plane of the contact normal."""
    return np.asarray(slope[0] * np.cos(pressure_angle) + slope[1] * np.sin(pressure_angle))


ROOT_OF_PUSH, ROOT_OF_CONTACT = 0.70, 4.1
_CORNER_EXPONENT = 0.4555
"""1 - lambda of a re-entrant right angle: stress at the root of a small fillet."""


def keyway_root_stress(
    key_pressure: ArrayLike,
    normal_force: ArrayLike,
    width: float,
    wall: float,
    keyway_depth: float,
    root_radius: float,
) -> Array:
    """Upper bound (...) of the greatest principal stress at a hub's keyway root, Pa.

    Both parts scale with (t2/r)^0.4555, as the stress of a sharp right-angled corner does. Their
    factors are the greatest of plane-strain elements of rings with a keyway of DIN 6885-1, bores of
    12 to 50 mm, outer radius 1.75 to 5 times that of the keyway floor, fillets of once and twice
    the least: 0.49 to 0.70 under the pressure of the key, 2.4 to 4.1 under the contact force over
    the wall, at its worst angle to the keyway.

    Parameters
    ----------
    key_pressure, normal_force : array (...)   on the flank in the hub, Pa; of the contact, N; >= 0
    width, wall : float                        of the cam; least between keyway and contour, m, > 0
    keyway_depth, root_radius : float          t2 and r, m, > 0

    References
    ----------
    Williams, J. Appl. Mech. 19 (1952): singularity of a corner; factors by `meshes` and skfem,
    tests/verification/test_camshaft_audit.py.
    """
    for name, value in (("width", width), ("wall", wall), ("root_radius", root_radius)):
        if not 0.0 < value < np.inf:
            raise InputError(f"cam.keyway.{name}", value, "> 0 m")
    spread = np.asarray(normal_force, dtype=float) / (width * wall)
    push = ROOT_OF_PUSH * np.asarray(key_pressure, dtype=float)
    stress = (push + ROOT_OF_CONTACT * spread) * (keyway_depth / root_radius) ** _CORNER_EXPONENT
    return np.asarray(stress)


def tooth_root_stress(force: ArrayLike, width: float, module: float, teeth: int) -> Array:
    """Lewis root bending stress (...) of a 20 deg full-depth spur tooth, Pa: F/(b m pi y).

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
    force : array (...)       F on the pitch circle, application factor included, N, >= 0
    width : float             b of the teeth in contact, m
    pinion_diameter : float   d1, pitch diameter of the smaller gear, m
    ratio : float             u, teeth of the larger over those of the smaller, >= 1
    pressure_angle : float    a, rad
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
