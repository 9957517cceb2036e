"""Loads of key, gear and camshaft bearings; unbalance of the cam, counter-hole."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import FULL_TURN, Array, Value, finite, freeze
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import KeywayLike
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.extrema import refined
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base.material import MadeOf, Material
from camwright.pipeline.base.quantities import (
    Angle,
    Characters,
    Count,
    Force,
    In,
    Known,
    Length,
    Mass,
    Meaning,
    Part,
    Pressure,
    TableSource,
    Used,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.contact.cam_body import KeyFlanks


class KeyStress(NamedTuple):
    """Key pressure on hub and shaft, and key shear stress, Pa, signed like the torque."""

    hub: Array
    shaft: Array
    shear: Array


def key_stress(torque: ArrayLike, shaft_diameter: float, flanks: KeyFlanks) -> KeyStress:
    """p = 2 T/(d l_tr h_tr) on hub and shaft, and tau = 2 T/(d b l_tr), of a parallel key.

    Parameters
    ----------
    torque : array (...)      application factor included, N m
    shaft_diameter : float    d, m, > 0
    flanks : KeyFlanks        l_tr, heights h_tr, width b, m, > 0

    Raises
    ------
    InputError
        If a length is not positive.

    References
    ----------
    DIN 6892, method C (recalled, verify); Shigley's Mechanical Engineering Design, ch. 7.
    """
    for name, value in (("shaft_diameter", shaft_diameter), *flanks._asdict().items()):
        if not 0.0 < value < np.inf:
            raise InputError(f"key.{name}", value, "> 0 m")
    push = 2.0 * finite("torque", torque) / (shaft_diameter * flanks.length)
    return KeyStress(push / flanks.hub_height, push / flanks.shaft_height, push / flanks.width)


class Reversal(NamedTuple):
    """Sign change of the torque: cam angle, rad, and slope, N m/rad."""

    theta: float
    slope: float


NO_TORQUE = 1e-6
"""Torque that moves neither teeth nor key, N m: that of a cam without spring at standstill, or of
round-off in a dwell."""


def torque_reversals(theta: Array, torque: ArrayLike, drag: float = 0.0) -> tuple[Reversal, ...]:
    """Sign changes of the torque through gear and key over a turn, beyond `NO_TORQUE`.

    At each reversal teeth and key cross their backlash; the impact increases with the slope of
    the torque.

    Parameters
    ----------
    theta : array (n,)     increasing cam angles of one turn, rad
    torque : array (n,)    N m
    drag : float           constant torque that keeps the flanks in contact, N m

    Raises
    ------
    InputError
        If an angle or torque is not finite.

    References
    ----------
    Rothbart, Cam Design Handbook (2004): crossover shock.
    """
    angle = finite("theta", theta)
    value = finite("torque", torque) + drag
    lively = np.flatnonzero(np.abs(value) > NO_TORQUE)  # a dwell at zero is one reversal
    reversals = []
    for here, after in zip(lively, np.roll(lively, -1), strict=True):
        if value[here] * value[after] >= 0.0:
            continue
        step = (angle[after] - angle[here]) % FULL_TURN
        slope = (value[after] - value[here]) / step
        reversals.append(
            Reversal(float((angle[here] - value[here] / slope) % FULL_TURN), float(slope))
        )
    return tuple(sorted(reversals))


@dataclass(frozen=True)
class Rotor:
    """Gear and cam on an elastic shaft, the gear before teeth that are springs.

    gear, cam: moments of inertia, kg m2; shaft: stiffness in torsion between both, N m/rad; mesh:
    of the teeth, N/m; radius: of the pitch circle, m.
    """

    gear: float
    cam: float
    shaft: float
    mesh: float
    radius: float

    @property
    def inertia(self) -> float:
        """Of both, kg m2."""
        return self.gear + self.cam


class Impact(NamedTuple):
    """Meeting of the flanks: cam angle, rad; speed, m/s; greatest force on the teeth, N."""

    theta: float
    speed: float
    force: float


def impact(
    theta: Array,
    torque: ArrayLike,
    reversal: Reversal,
    cam_speed: float,
    rotor: Rotor,
    backlash: float,
) -> Impact | None:
    """Flight across the backlash after a reversal, and the impact at its end.

    None where the torque turns the rotor back before, or the backlash is not crossed within a turn.
    The drive turns steadily; no oil brakes the flight, `MESH_DAMPING` the impact. Both phases are
    linear: their modes are integrated in closed form but for the torque, up to the greatest force,
    or half a period of the slower mode.

    Parameters
    ----------
    theta : array (n,)    increasing cam angles of one turn, rad
    torque : array (n,)   of the cam through the teeth, drag included, N m
    reversal : Reversal   angle and slope of the torque where it changes its sign
    cam_speed : float     rad/s, > 0
    rotor : Rotor         gear and cam on the elastic shaft between them
    backlash : float      along the pitch circle, m, >= 0
    """
    value = np.sign(reversal.slope) * finite("torque", torque)

    def push(time: Array) -> Array:
        return np.asarray(
            np.interp(reversal.theta + cam_speed * time, theta, value, period=FULL_TURN)
        )

    gap = backlash / rotor.radius
    # A flight takes a few degrees, or a turn at the most.
    time = FULL_TURN / cam_speed * np.linspace(0.0, 1.0, _FLIGHT) ** 3
    speed = _integrated(push(time), time) / rotor.inertia
    travel = _integrated(speed, time)
    over = int(np.argmax(travel >= gap))
    if travel.max() < gap or (speed[: over + 1] < 0.0).any():
        return None
    time = np.linspace(0.0, _LONGER * time[over] + 1e-9, _FLIGHT)
    load = push(time)
    twist, twisting = _swing(time, load / rotor.cam, np.sqrt(rotor.shaft * rotor.inertia
                             / (rotor.gear * rotor.cam)))  # fmt: skip
    speed = _integrated(load, time) / rotor.inertia
    behind = rotor.cam / rotor.inertia  # the gear, of the twist
    place, pace = _integrated(speed, time) - behind * twist, speed - behind * twisting
    at = max(1, int(np.argmax(place >= gap)))
    share = (gap - place[at - 1]) / (place[at] - place[at - 1])
    met, fast, ahead, opening = (
        float(each[at - 1] + share * (each[at] - each[at - 1]))
        for each in (time, pace, twist, twisting)
    )
    return Impact(
        float((reversal.theta + cam_speed * met) % FULL_TURN),
        fast * rotor.radius,
        _force(
            rotor,
            np.array([0.0, ahead]),
            np.array([fast, fast + opening]),
            lambda after: push(met + after),
        ),
    )


def _force(rotor: Rotor, place: Array, moving: Array, push: Callable[[Array], Array]) -> float:
    """Greatest force on the gear teeth, N, of an impact, from the meeting of the flanks until they
    part; by the two modes of gear and cam on their shaft.

    Parameters
    ----------
    rotor : Rotor         inertias and stiffnesses
    place : array (2,)    angles of gear and cam at the meeting, rad
    moving : array (2,)   their speeds at the meeting, rad/s
    push : callable       times (n,), s -> torque on the cam (n,), N m
    """
    root = np.sqrt([rotor.gear, rotor.cam])
    teeth = rotor.mesh * rotor.radius**2
    stiffness = np.array([[teeth + rotor.shaft, -rotor.shaft], [-rotor.shaft, rotor.shaft]])
    squares, modes = np.linalg.eigh(stiffness / np.outer(root, root))
    time = np.linspace(0.0, np.pi / np.sqrt(squares[0]), _FLIGHT)
    load, gear = push(time), np.zeros(_FLIGHT)
    for square, mode in zip(squares, modes.T, strict=True):
        frequency, slowed = np.sqrt(square), np.sqrt(square * (1.0 - MESH_DAMPING**2))
        swing, _ = _swing(time, mode[1] / root[1] * load, frequency, MESH_DAMPING)
        begin, pace = mode @ (root * place), mode @ (root * moving)
        free = begin * np.cos(slowed * time)
        free += (pace + MESH_DAMPING * frequency * begin) / slowed * np.sin(slowed * time)
        gear += mode[0] / root[0] * (swing + np.exp(-MESH_DAMPING * frequency * time) * free)
    apart = np.flatnonzero(gear[1:] < 0.0)
    end = apart[0] + 1 if apart.size else gear.size
    return float(rotor.mesh * rotor.radius * max(gear[:end].max(), 0.0))


def _swing(time: Array, push: Array, frequency: float, damping: float = 0.0) -> tuple[Array, Array]:
    """Displacement and speed (n,) of an oscillator of unit mass that starts at rest under a varying
    force.

    A swing too fast for the steps of time follows the force.

    Parameters
    ----------
    time : array (n,)   equal steps from 0, s
    push : array (n,)   force over mass
    frequency : float   undamped natural frequency, rad/s
    damping : float     share of the critical damping
    """
    if frequency * time[1] > _FASTEST:
        return push / frequency**2, np.zeros(time.size)
    slowed, growth = frequency * np.sqrt(1.0 - damping**2), np.exp(damping * frequency * time)
    sine, cosine = np.sin(slowed * time), np.cos(slowed * time)
    first = _integrated(push * growth * cosine, time) / growth
    second = _integrated(push * growth * sine, time) / growth
    place = (sine * first - cosine * second) / slowed
    return place, cosine * first + sine * second - damping * frequency * place


def _integrated(values: Array, places: Array) -> Array:
    """Integral of values (n,) from the first place to each (n,), by trapezia."""
    areas = 0.5 * (values[1:] + values[:-1]) * np.diff(places)
    return np.concatenate([[0.0], np.cumsum(areas)])


MESH_DAMPING = 0.03
"""Of teeth in mesh, of the critical: the least of 0.03 to 0.17, Kasuba and Evans, J. Mech. Des. 103
(1981) 398 (recalled, verify)."""
_FLIGHT = 801  # moments of a flight across the backlash, and of the impact at its end
_FASTEST = 0.5  # rad, of a swing in a step
_LONGER = 1.5  # of the flight of a rigid rotor
_ZERO_MOMENT = 1e-9
"""First moment over the area to the power 3/2, up to which the cam is balanced."""
_HOLE_PLACES = 400  # of a counter-hole, tried between bore and contour
_CUTS, _PARTS = 6, 64  # of the step about the outermost place
_HOLE_ZOOMS = 14  # in the search of the greatest hole


@dataclass(frozen=True, kw_only=True)
class CamshaftGear(Part):
    """Spur gear on the camshaft, 20 deg full depth; the pinion is on the crankshaft."""

    table: ClassVar[str] = "camshaft.gear"
    defaults: ClassVar[Mapping[str, str]] = {
        "pinion_material": "that of the gear",
        "machine_shaft_diameter": "at most that of the pinion",
        "backlash": "0.06 mm + 0.0005 a + 0.03 m, a: centre distance, m: module",
    }

    teeth: Annotated[int, Count(10, 1000), Known("gear drawing", 40)]
    """teeth of the gear on the camshaft"""
    pinion_teeth: Annotated[int, Count(10, 1000), Known("gear drawing", 20)]
    """teeth of the pinion on the machine shaft"""
    width: Annotated[Length, Known("gear drawing", "20 mm")]
    """face width of gear and pinion"""
    material: Annotated[MadeOf, Known("gear drawing", "case_hardened")]
    application_factor: Annotated[float, In(at_least=1, at_most=10), Known("DIN 3990")] = 1.5
    """K_A on the torque"""
    bending_limit: Annotated[Pressure | None, Known("ISO 6336-5", "430 MPa")] = None
    """endurance limit of tooth root bending"""
    contact_limit: Annotated[Pressure | None, Known("ISO 6336-5", "1500 MPa")] = None
    """endurance limit of flank contact"""
    pinion_material: Annotated[Material | None, Known("gear drawing", "case_hardened")] = None
    """name of the pinion's material in [materials]"""
    pinion_bending_limit: Annotated[Pressure | None, Known("ISO 6336-5", "430 MPa")] = None
    """endurance limit of tooth root bending of the pinion"""
    pinion_contact_limit: Annotated[Pressure | None, Known("ISO 6336-5", "1500 MPa")] = None
    """endurance limit of flank contact of the pinion"""
    machine_shaft_diameter: Annotated[
        float | None, In("mm", at_least=0, at_most=10_000), Known("drawing", "20 mm")
    ] = None
    """diameter of the machine shaft beside the cam; 0 where it ends at its pinion"""
    backlash: Annotated[
        float | None, In("mm", at_least=0, at_most=10), Known("gear drawing", "0.05 mm")
    ] = None
    """backlash along the pitch circle; 0 of a gear split and braced by a spring"""
    source: TableSource = NO_SOURCE

    def known_backlash(self, radius: float) -> float:
        """Backlash of the gear along the pitch circle, m: as stated, else a usual one by its size.

        Parameters
        ----------
        radius : float   of the pitch circle, m

        References
        ----------
        ANSI/AGMA 2002-B88, least recommended backlash (second-hand, verify); 3 to 6 % of the module
        (Novexa) is less.
        """
        if self.backlash is not None:
            return self.backlash
        distance = radius * (1.0 + self.pinion_teeth / self.teeth)
        return 0.06e-3 + 0.0005 * distance + 0.03 * (2.0 * radius / self.teeth)

    def inertia(self, radius: float) -> float:
        """Moment of inertia of a solid disc of a pitch radius, m, and the width, kg m2."""
        return 0.5 * pi * self.material.density * self.width * radius**4


Surface = Literal["ground", "machined", "hot_rolled", "forged"]
Notch = Annotated[float, In(at_least=1, at_most=10)]
Place = Annotated[float, In("mm", above=-10_000, below=10_000)]
FromBearing = Annotated[Place, Meaning("position from the first bearing")]
MassMoment = Annotated[float, In("g mm", above=0, at_most=1e9)]


@dataclass(frozen=True, kw_only=True)
class ShaftSection(Part):
    """Section of the camshaft beside its seats, or, at the position of a seat, in its place."""

    table: ClassVar[str] = "camshaft.sections"

    name: Annotated[str, Characters(1, 40), Known("own choice", "bearing seat 1")]
    """name of the section in messages"""
    position: Annotated[FromBearing, Known("drawing", "0 mm")]
    diameter: Annotated[Length, Known("drawing", "15 mm")]
    """diameter of the section"""
    notch_bending: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2", 1.9)]
    """fatigue notch factor in bending"""
    notch_torsion: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2", 2.8)]
    """fatigue notch factor in torsion"""


@dataclass(frozen=True, kw_only=True)
class Counterweight(Part):
    """Counterweight on the camshaft, stated in one of two ways.

    It has its own unbalance m e and direction, or the residual of cam and counterweight together.
    """

    table: ClassVar[str] = "camshaft.counterweight"
    defaults: ClassVar[Mapping[str, str]] = {
        "unbalance": "with residual: that of the cam, more by the residual",
        "angle": "with residual: opposite to the unbalance of the cam",
        "residual": "with unbalance: what it leaves of the cam",
        "radius": "below the follower by twice limits.assembly_gap",
        "width": "that of a half ring of its unbalance, beside the cam",
    }

    unbalance: Annotated[MassMoment | None, Known("drawing", "50 g mm")] = None
    """unbalance m e of the counterweight; with angle, without residual"""
    angle: Annotated[Angle | None, Known("drawing", "30 deg")] = None
    """direction of the counterweight in the cam frame"""
    residual: Annotated[MassMoment | None, Known("balancing report, ISO 21940-11", "20 g mm")] = (
        None
    )
    """unbalance left after balancing on a bench; without unbalance and angle"""
    position: Annotated[FromBearing, Known("drawing", "30 mm")]
    radius: Annotated[Length | None, Known("drawing", "32 mm")] = None
    """outer radius"""
    width: Annotated[Length | None, Known("drawing", "30 mm")] = None
    """width along the shaft, from face to face where it holds the cam between two halves"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a counterweight unless it has its unbalance with an angle, or a residual
        without.
        """
        super().__post_init__()
        if (self.unbalance is None) == (self.residual is None):
            count = "neither" if self.residual is None else "both"
            field = f"{self.table}.unbalance, residual"
            raise InputError(field, count, "exactly one of the two")
        field = f"{self.table}.angle"
        if self.residual is None and self.angle is None:
            raise InputError(field, "missing", "given with unbalance")
        if self.residual is not None and self.angle is not None:
            raise InputError(field, shown(self.angle, "deg"), "left out with residual")

    def set_against(self, made: Unbalance) -> tuple[float, float]:
        """Unbalance, kg m, and direction in the cam frame, rad, against a manufactured cam.

        A residual has no known direction: it is taken on the side of the counterweight.
        """
        product, angle = self.against(made.product, made.angle)
        return float(product), float(angle)

    def against(self, product: Value, angle: Value) -> tuple[Value, Value]:
        """As `set_against`, for cams (...) by unbalance, kg m, and direction, rad."""
        if self.unbalance is not None and self.angle is not None:
            return self.unbalance, self.angle
        return product + (self.residual or 0.0), angle + pi


@dataclass(frozen=True, kw_only=True)
class Camshaft(Part):
    """Camshaft: positions from its first bearing, driving gear, two ball bearings.

    The notch factors at cam and gear are those of an end-milled keyway, at the bearings those of a
    shoulder with a sharp fillet. A press fit without a slip torque has that of `cam.fit`. The
    fatigue_bending of its material is that of a polished specimen under rotating bending.
    """

    table: ClassVar[str] = "camshaft"
    defaults: ClassVar[Mapping[str, str]] = {
        "rotor_mass": "that of the cam alone, on the safe side",
        "bearing_width": "at most the diameter of the shaft",
        "slip_torque": "that of cam.fit",
    }

    bearing_spacing: Annotated[Length, Known("drawing", "60 mm")]
    """distance of its two bearings"""
    cam_position: Annotated[Place, Known("drawing", "20 mm")]
    """position of the cam from the first bearing; negative or beyond the spacing: overhung"""
    gear_position: Annotated[Place, Known("drawing", "-15 mm")]
    """position of the driving gear from the first bearing"""
    gear_radius: Annotated[Length, Known("gear drawing", "20 mm")]
    """pitch radius of the driving gear"""
    mesh_angle: Annotated[Angle, Known("drawing")] = pi
    """direction of the gear mesh from the follower axis, positive as the cam turns"""
    pressure_angle: Annotated[float, In("deg", at_least=0, below=45), Known("gear drawing")] = (
        pi / 9.0
    )
    """pressure angle of the teeth"""
    drag: Annotated[float, In("N m", at_least=0, at_most=1e6), Known("bearing catalogue")] = 0.0
    """torque of bearings and seals"""
    diameter: Annotated[Length | None, Known("drawing", "17 mm")] = None
    """diameter of every seat without a section of its own"""
    material: Annotated[MadeOf | None, Known("drawing", "c45")] = None
    surface: Annotated[Surface, Known("drawing")] = "machined"
    """surface finish of the shaft"""
    notch_bending: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2")] = 2.14
    """fatigue notch factor in bending at cam and gear"""
    notch_torsion: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2")] = 3.0
    """fatigue notch factor in torsion at cam and gear"""
    seat_notch_bending: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2")] = 2.7
    """fatigue notch factor in bending at the bearing seats"""
    seat_notch_torsion: Annotated[Notch, Known("Shigley table 7-1; DIN 743-2")] = 2.2
    """fatigue notch factor in torsion at the bearing seats"""
    sections: Annotated[tuple[ShaftSection, ...], Used("checks of the camshaft")] = ()
    """section of the camshaft, or a seat with a diameter of its own"""
    bearing_rating: Annotated[Force | None, Known("bearing catalogue", "9.95 kN")] = None
    """dynamic rating C of each bearing"""
    bearing_static_rating: Annotated[Force | None, Known("bearing catalogue", "4.75 kN")] = None
    """static rating C0 of each bearing"""
    bearing_width: Annotated[Length | None, Known("bearing catalogue", "12 mm")] = None
    """width of each bearing"""
    rotor_mass: Annotated[Mass | None, Known("drawing, or weighed", "900 g")] = None
    """mass of cam, shaft and gear together, for the unbalance"""
    slip_torque: Annotated[
        float | None,
        In("N m", at_least=0, at_most=1e6),
        Known("calculation of the press fit, DIN 7190", "60 N m"),
    ] = None
    """torque at which the cam slips on its seat without the key; 0 for a sliding fit"""
    gear: Annotated[CamshaftGear | None, Used("checks of the gear")] = None
    """spur gear on the camshaft and its pinion on the machine shaft"""
    counterweight: Annotated[Counterweight | None, Used("unbalance, camshaft loads")] = None
    """counterweight against the unbalance of the cam"""
    source: TableSource = NO_SOURCE

    @property
    def widest(self) -> float | None:
        """Greatest diameter of shaft and sections, m; None without the shaft's diameter."""
        if self.diameter is None:
            return None
        return max([self.diameter, *(each.diameter for each in self.sections)])

    @property
    def thinnest(self) -> float | None:
        """Least diameter of shaft and sections, m; None without the shaft's diameter."""
        if self.diameter is None:
            return None
        return min([self.diameter, *(each.diameter for each in self.sections)])


@dataclass(frozen=True, eq=False)
class SecondDisc:
    """Load of the second disc of a cam.

    spacing : from the first disc, m; force (2, n) : on it, N, in the frame of `ShaftLoads`;
    torque (n,) : of that on the cam, what drives it, N m
    """

    spacing: float
    force: Array
    torque: Array

    def __post_init__(self) -> None:
        freeze(self, force=finite("force", self.force), torque=finite("torque", self.torque))


@dataclass(frozen=True, eq=False)
class ShaftLoads:
    """Forces on the camshaft in the engine frame, x along the follower outwards; (2, n), N.

    Loads of `cam`, its first disc, `gear` and `counterweight`, reactions `bearing_1` and
    `bearing_2`; `second`: load of a second disc.
    """

    cam: Array
    gear: Array
    counterweight: Array
    bearing_1: Array
    bearing_2: Array
    second: SecondDisc | None = None

    def __post_init__(self) -> None:
        arrays = (name for name in self.__dataclass_fields__ if name != "second")
        freeze(self, **{name: getattr(self, name) for name in arrays})

    @property
    def load_1(self) -> Array:
        """Load of the first bearing (n,), N, >= 0."""
        return np.asarray(np.hypot(*self.bearing_1))

    @property
    def load_2(self) -> Array:
        """Load of the second bearing (n,), N, >= 0."""
        return np.asarray(np.hypot(*self.bearing_2))


def shaft_loads(
    axial_force: ArrayLike,
    tangential_force: ArrayLike,
    cam_torque: ArrayLike,
    shaft: Camshaft,
    unbalance_force: ArrayLike = 0.0,
    counterweight_force: ArrayLike = 0.0,
    second: SecondDisc | None = None,
) -> ShaftLoads:
    """Bearing loads of the camshaft from contact force and gear force.

    The follower exerts -F_a along its axis and -F_t across it on the cam.

    Parameters
    ----------
    axial_force, tangential_force, cam_torque : array (n,)   N, N, N m
    shaft : Camshaft
    unbalance_force : array (2, n)   N, on the cam
    counterweight_force : array (2, n)   N, on the counterweight, if the shaft has one
    second : SecondDisc      of a pair; the forces before are then those of the first disc, the
                             torque that of both

    Raises
    ------
    InputError
        If a value is not finite.
    """
    along = finite("axial_force", axial_force)
    across = finite("tangential_force", tangential_force)
    torque = finite("cam_torque", cam_torque)
    cam = np.stack([-along, -across]) + finite("unbalance_force", unbalance_force)
    gear = gear_force(torque, shaft)
    weight = np.zeros_like(cam) + finite("counterweight_force", counterweight_force)
    acting = [(shaft.cam_position, cam), (shaft.gear_position, gear)]
    if shaft.counterweight is not None:
        acting.append((shaft.counterweight.position, weight))
    if second is not None:
        acting.append((shaft.cam_position + second.spacing, second.force))
    far = -np.sum([force * (at / shaft.bearing_spacing) for at, force in acting], axis=0)
    near = -np.sum([force for _, force in acting], axis=0) - far
    return ShaftLoads(cam, gear, weight, near, far, second)


def gear_force(torque: Array, shaft: Camshaft) -> Array:
    """Tooth force on the gear of the camshaft (2, ...), N, in the engine frame.

    The tangential force supplies torque and drag; the radial force separates the gears.

    Parameters
    ----------
    torque : array (...)   on the cam, N m
    shaft : Camshaft       gear radius, mesh and pressure angle, drag
    """
    tooth = (torque + shaft.drag) / shaft.gear_radius
    outward = np.array([np.cos(shaft.mesh_angle), np.sin(shaft.mesh_angle)])
    sideways = np.array([-np.sin(shaft.mesh_angle), np.cos(shaft.mesh_angle)])
    apart = magnitude(tooth) * np.tan(shaft.pressure_angle)
    return np.asarray(np.multiply.outer(sideways, tooth) - np.multiply.outer(outward, apart))


@dataclass(frozen=True, eq=False)
class Unbalance:
    """Unbalance of the cam: area, m2, first moment (2,), m3, mass, kg, `product` m e, kg m."""

    area: float
    moment: Array
    mass: float
    product: float

    def __post_init__(self) -> None:
        freeze(self, moment=self.moment)

    def __add__(self, other: Unbalance) -> Unbalance:
        """Of two bodies on one shaft, as if in one plane."""
        moment, mass = self.moment + other.moment, self.mass + other.mass
        area = self.area + other.area
        return Unbalance(area, moment, mass, mass / area * float(np.hypot(*moment)))

    @property
    def angle(self) -> float:
        """Direction of the centre of mass in the cam frame, rad."""
        return float(np.arctan2(self.moment[1], self.moment[0]))

    @property
    def eccentricity(self) -> float:
        """Distance of the centre of mass from the cam axis, m."""
        return float(np.hypot(*self.moment)) / self.area

    @property
    def balanced(self) -> bool:
        """Whether the first moment is round-off, such as by symmetry."""
        return bool(np.hypot(*self.moment) <= _ZERO_MOMENT * self.area**1.5)


def rotating_force(product: Value, direction: Value, cam_speed: Value, theta: Array) -> Array:
    """Centrifugal force of an unbalance (2, ..., n), N, in the frame of `ShaftLoads`.

    It points along the follower at the cam angle of the centre of mass and rotates with the
    cam.

    Parameters
    ----------
    product, direction : (...)   m e, kg m, and its direction in the cam frame, rad
    cam_speed : (...)            rad/s
    theta : array (n,)           cam angles, rad
    """
    turned = finite("theta", theta) - direction
    return np.asarray(product * cam_speed**2 * np.stack([np.cos(turned), np.sin(turned)]))


def unbalance(
    contour: Contour,
    bore_radius: float,
    keyway: KeywayLike | None,
    width: float,
    density: float,
) -> Unbalance:
    """Area, first moment, mass and unbalance of a cam with bore and keyway; other holes are not
    deducted.

    Area and centroid of the contour by line integrals; bore and keyway subtracted in closed form.
    The keyway is a rectangle with its floor `depth` beyond the bore radius.

    Parameters
    ----------
    bore_radius : float       m
    keyway : KeywayLike       or None
    width, density : float    m and kg/m3, > 0

    Raises
    ------
    InputError
        If width or density is not positive.
    """
    for name, value in (("cam.width", width), ("material.density", density)):
        if not 0.0 < value < np.inf:
            raise InputError(name, value, "> 0")
    area = contour.area()
    moment = area * np.asarray(contour.centroid())
    return less_bore(area, moment, bore_radius, keyway, width, density)


def less_bore(
    area: float,
    moment: Array,
    bore_radius: float,
    keyway: KeywayLike | None,
    width: float,
    density: float,
) -> Unbalance:
    """Mass and unbalance of the cam: of the area within its contour, less bore and keyway.

    Parameters
    ----------
    area : float          within the contour, m2
    moment : array (2,)   its first moment about the cam axis, m3
    bore_radius : float   m
    keyway : KeywayLike   in the bore; None: none
    width : float         of the cam, m
    density : float       kg/m3
    """
    area -= np.pi * bore_radius**2
    if keyway is not None:
        cut = keyway_cut(bore_radius, keyway.width, keyway.depth)
        area -= float(cut.area)
        moment = moment - cut.moment * np.array([np.cos(keyway.angle), np.sin(keyway.angle)])
    mass = density * width * area
    return Unbalance(area, moment, mass, float(density * width * np.hypot(*moment)))


class KeywayCut(NamedTuple):
    """Area of a keyway outside the bore, m2, and its first moment about the cam axis, m3."""

    area: Value
    moment: Value


def keyway_cut(bore: Value, width: float, depth: float) -> KeywayCut:
    """Area of a keyway outside the bore (...), m2, and its first moment about the cam axis (...),
    m3.

    Parameters
    ----------
    bore : (...)    radius of the bore, m
    width : float   of the keyway, m
    depth : float   of its floor below the top of the bore, m
    """
    half, floor = 0.5 * width, bore + depth
    chord = np.sqrt(bore**2 - half**2)
    under_arc = half * chord + bore**2 * np.arcsin(half / bore)
    # Across the width the keyway extends from sqrt(bore^2 - y^2) to the floor.
    moment = width * floor**2 / 2.0 - (bore**2 * half - half**3 / 3.0)
    return KeywayCut(width * floor - under_arc, moment)


class CounterHole(NamedTuple):
    """A round hole through the cam: centre (2,), m, and radius, m."""

    centre: Array
    radius: float


def counter_hole(
    contour: Contour,
    unbalance: Unbalance,
    bore_radius: float,
    wall: float,
    keyway_depth: float = 0.0,
) -> CounterHole:
    """Smallest hole that balances a cam, as far out on its heavy side as the wall to the contour
    permits.

    Parameters
    ----------
    contour : Contour       of the cam
    unbalance : Unbalance   without the hole
    bore_radius : float     m
    wall : float            minimum thickness between hole and contour or bore, m, > 0
    keyway_depth : float    added to the bore radius, m

    Raises
    ------
    GeometryError
        If no such hole fits, or the cam has no unbalance.
    """
    if not 0.0 < wall < np.inf:
        raise InputError("cam.wall", wall, "> 0 m")
    need = float(np.hypot(*unbalance.moment))
    if unbalance.balanced:
        raise GeometryError("counter-hole: the cam has no unbalance")
    direction, ring = _heavy_side(unbalance), contour.polygon(1440)

    def spare(place: Array) -> Array:
        """Wall to the contour less the required one (...), m, at hole centres `place`, m."""
        return _wall_outside(ring, direction, place) - np.sqrt(need / (np.pi * place)) - wall

    places = np.linspace(bore_radius, _reach(unbalance, ring), _HOLE_PLACES)
    fits = places[spare(places) >= 0.0]
    if not fits.size:
        raise GeometryError("no counter-hole that balances the cam fits between bore and contour")
    # spare() decreases to zero beyond the outermost feasible place
    inside, outside = fits[-1], places[-1]
    for _ in range(_CUTS):
        between = np.linspace(inside, outside, _PARTS + 1)
        last = int(np.flatnonzero(spare(between) >= 0.0)[-1])
        inside, outside = between[last], between[min(last + 1, _PARTS)]
    outermost = float(inside)
    radius = float(np.sqrt(need / (np.pi * outermost)))
    if outermost - radius - wall < bore_radius + keyway_depth:
        raise GeometryError("no counter-hole that balances the cam fits between bore and contour")
    return CounterHole(outermost * direction, radius)


def greatest_hole(
    contour: Contour,
    unbalance: Unbalance,
    bore_radius: float,
    wall: float,
    keyway_depth: float = 0.0,
) -> CounterHole:
    """Hole in the heavy side of a cam that removes the most unbalance, where none balances fully.

    Parameters
    ----------
    contour : Contour            of the cam
    unbalance : Unbalance        without the hole
    bore_radius : float          m
    wall, keyway_depth : float   as for `counter_hole`

    Raises
    ------
    GeometryError
        If no hole fits within the walls.
    """
    direction, ring = _heavy_side(unbalance), contour.polygon(1440)

    def radius(place: Array) -> Array:
        away = _wall_outside(ring, direction, place)
        return np.asarray(np.minimum(away, place - bore_radius - keyway_depth) - wall)

    def lost(place: Array) -> Array:
        return np.asarray(-(np.maximum(radius(place), 0.0) ** 2) * place)

    places, step = np.linspace(bore_radius, _reach(unbalance, ring), _HOLE_PLACES, retstep=True)
    best = int(np.argmin(lost(places)))
    _, place = refined(lost, places[[best]], float(step), _HOLE_ZOOMS)
    place = np.clip(place, places[0], places[-1])
    if not radius(place)[0] > 0.0:
        raise GeometryError("no hole fits between bore and contour")
    return CounterHole(place[0] * direction, float(radius(place)[0]))


def _wall_outside(ring: Array, direction: Array, place: Array) -> Array:
    """Distance from the contour (2, n) to points (...) along a direction (2,), m."""
    along, square = direction @ ring, (ring**2).sum(axis=0)
    away = square - (2.0 * place[..., None]) * along
    return np.asarray(np.sqrt(np.maximum(away.min(axis=-1) + place**2, 0.0)))


def _heavy_side(unbalance: Unbalance) -> Array:
    """Unit vector (2,) towards the centre of mass."""
    return np.array([np.cos(unbalance.angle), np.sin(unbalance.angle)])


def _reach(unbalance: Unbalance, ring: Array) -> float:
    """Radius of the contour in the direction of the unbalance, m."""
    bearing = np.arctan2(ring[1], ring[0])
    return float(np.interp(unbalance.angle, bearing, np.hypot(*ring), period=2.0 * np.pi))
