"""What the cam hands on: key, gear and camshaft bearings; and its unbalance."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, minimize_scalar

from camwright.geometry.arrays import FULL_TURN, Array, finite, freeze
from camwright.geometry.contour import Contour
from camwright.geometry.cutouts import KeywayLike
from camwright.geometry.errors import GeometryError, InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Angle, Count, Force, In, Length, Part, Pressure


class KeyStress(NamedTuple):
    """Pressure on the key's flank and shear in its section, Pa, signed like the torque."""

    pressure: Array
    shear: Array


def key_stress(
    torque: ArrayLike, shaft_diameter: float, key_width: float, key_height: float, length: float
) -> KeyStress:
    """p = 4 T/(d h l) and tau = 2 T/(d b l) of a parallel key, half of it in the hub.

    Parameters
    ----------
    torque : array (...)   N m
    shaft_diameter, key_width, key_height, length : float   d, b, h, l, m, > 0

    Raises
    ------
    InputError
        If a length is not positive.

    References
    ----------
    DIN 6892 (recalled, verify); Shigley's Mechanical Engineering Design, ch. 7.
    """
    for name, value in (
        ("shaft_diameter", shaft_diameter),
        ("width", key_width),
        ("height", key_height),
        ("length", length),
    ):
        if not 0.0 < value < np.inf:
            raise InputError(f"key.{name}", value, "> 0 m")
    push = 2.0 * finite("torque", torque) / (shaft_diameter * length)
    return KeyStress(np.asarray(2.0 * push / key_height), np.asarray(push / key_width))


class Reversal(NamedTuple):
    """A change of sign of the torque: cam angle, rad, and slope, N m/rad, there."""

    theta: float
    slope: float


def torque_reversals(theta: Array, torque: ArrayLike, drag: float = 0.0) -> tuple[Reversal, ...]:
    """Where the torque through gear and key changes its sign over a turn.

    At each of them the teeth and the key cross their backlash and meet on the other flank;
    the steeper the torque, the harder.

    Parameters
    ----------
    theta : array (n,)     rising cam angles of one turn, rad
    torque : array (n,)    N m
    drag : float           steady torque that holds the flanks together, N m

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
    lively = np.flatnonzero(value != 0.0)  # a dwell at zero is one crossing, not many
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


_BALANCED = 1e-9
"""Of the area's power 3/2: a first moment that is round-off."""


@dataclass(frozen=True, kw_only=True)
class CamshaftGear(Part):
    """The spur gear on the camshaft; its limits are those of its material for endless life.

    The teeth are of 20 deg full depth; the pinion is on the crank.
    """

    table: ClassVar[str] = "camshaft.gear"

    teeth: Annotated[int, Count(10, 1000)]
    pinion_teeth: Annotated[int, Count(10, 1000)]
    width: Length
    material: Material
    application_factor: Annotated[float, In(at_least=1, at_most=10)] = 1.5
    bending_limit: Pressure | None = None
    contact_limit: Pressure | None = None
    source: str = ""


@dataclass(frozen=True, kw_only=True)
class Camshaft(Part):
    """The cam's shaft: positions from its first bearing, and the gear that drives it.

    A negative position or one beyond the spacing is overhung. The gears mesh at mesh_angle, seen
    from the axis, from the follower's axis counter-clockwise; gear_radius is the pitch radius and
    pressure_angle that of the teeth. The notch factors are those of the keyway under the cam, as
    an end mill cuts it; the rating is the dynamic one, C, of each of its two ball bearings.
    """

    table: ClassVar[str] = "camshaft"

    bearing_spacing: Length
    cam_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_position: Annotated[float, In("mm", above=-10_000, below=10_000)]
    gear_radius: Length
    mesh_angle: Angle = pi
    pressure_angle: Annotated[float, In("deg", at_least=0, below=45)] = pi / 9.0
    drag: Annotated[float, In("N m", at_least=0, at_most=1e6)] = 0.0
    diameter: Length | None = None
    material: Material | None = None
    notch_bending: Annotated[float, In(at_least=1, at_most=10)] = 2.14
    notch_torsion: Annotated[float, In(at_least=1, at_most=10)] = 3.0
    bearing_rating: Force | None = None
    gear: CamshaftGear | None = None
    source: str = ""


@dataclass(frozen=True, eq=False)
class ShaftLoads:
    """Forces in the frame of the engine, x along the follower outwards; arrays (2, n), N.

    `cam` and `gear` act on the shaft, `bearing_1` and `bearing_2` are what the bearings push
    back with.
    """

    cam: Array
    gear: Array
    bearing_1: Array
    bearing_2: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    @property
    def load_1(self) -> Array:
        """Of the first bearing, (n,), N, >= 0."""
        return np.asarray(np.hypot(*self.bearing_1))

    @property
    def load_2(self) -> Array:
        """Of the second bearing, (n,), N, >= 0."""
        return np.asarray(np.hypot(*self.bearing_2))


def shaft_loads(
    axial_force: ArrayLike,
    tangential_force: ArrayLike,
    cam_torque: ArrayLike,
    shaft: Camshaft,
    unbalance_force: ArrayLike = 0.0,
) -> ShaftLoads:
    """Loads of the camshaft's bearings from the cam's contact and the gear.

    The roller presses the cam with -F_a along the follower; F_t pushes the stem to one side and
    the cam to the other. The gear gives the cam torque with its tangential force and presses
    the wheels apart.

    Parameters
    ----------
    axial_force, tangential_force, cam_torque : array (n,)   N, N, N m
    shaft : Camshaft
    unbalance_force : array (2, n)   N, on the cam

    Raises
    ------
    InputError
        If a value is not finite.
    """
    along = finite("axial_force", axial_force)
    across = finite("tangential_force", tangential_force)
    torque = finite("cam_torque", cam_torque)
    cam = np.stack([-along, -across]) + finite("unbalance_force", unbalance_force)
    tooth = torque / shaft.gear_radius
    outward = np.array([np.cos(shaft.mesh_angle), np.sin(shaft.mesh_angle)])[:, None]
    sideways = np.array([-np.sin(shaft.mesh_angle), np.cos(shaft.mesh_angle)])[:, None]
    gear = tooth * sideways - np.abs(tooth) * np.tan(shaft.pressure_angle) * outward
    share_cam = shaft.cam_position / shaft.bearing_spacing
    share_gear = shaft.gear_position / shaft.bearing_spacing
    second = -(cam * share_cam + gear * share_gear)
    return ShaftLoads(cam, gear, -cam - gear - second, second)


@dataclass(frozen=True, eq=False)
class Unbalance:
    """First moment of the cam's area about the axis (2,), m3, and what comes of it."""

    area: float
    moment: Array
    mass: float
    product: float

    def __post_init__(self) -> None:
        freeze(self, moment=self.moment)

    @property
    def angle(self) -> float:
        """Of the heavy side, cam frame, rad."""
        return float(np.arctan2(self.moment[1], self.moment[0]))

    @property
    def eccentricity(self) -> float:
        """Of the centre of mass, m."""
        return float(np.hypot(*self.moment)) / self.area

    @property
    def balanced(self) -> bool:
        """Whether the first moment is round-off, as that of a tripled cam."""
        return bool(np.hypot(*self.moment) <= _BALANCED * self.area**1.5)

    def force(self, cam_speed: float) -> float:
        """m e w^2, N."""
        return self.product * cam_speed**2


def rotating_force(unbalance: Unbalance, cam_speed: float, theta: Array) -> Array:
    """Centrifugal force of an unbalance on the shaft, (2, n), N, in the frame of `ShaftLoads`.

    At the cam angle of the heavy side it points along the follower; from there it turns with
    the cam, in the sense of a positive torque.
    """
    turned = finite("theta", theta) - unbalance.angle
    return unbalance.force(cam_speed) * np.stack([np.cos(turned), np.sin(turned)])


def unbalance(
    contour: Contour,
    bore_radius: float,
    keyway: KeywayLike | None,
    width: float,
    density: float,
) -> Unbalance:
    """Mass and unbalance of the cam with its bore and keyway, holes left out.

    The contour's area and centroid are line integrals on its own curve; bore and keyway are
    taken off in closed form. The keyway is a rectangle from the bore's circle outwards, its
    floor `depth` beyond the bore.

    Parameters
    ----------
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
    area -= np.pi * bore_radius**2
    if keyway is not None:
        cut, arm = _keyway_moment(bore_radius, keyway.width, keyway.depth)
        area -= cut
        moment = moment - arm * np.array([np.cos(keyway.angle), np.sin(keyway.angle)])
    mass = density * width * area
    return Unbalance(area, moment, mass, float(density * width * np.hypot(*moment)))


def _keyway_moment(bore: float, width: float, depth: float) -> tuple[float, float]:
    """Area of a keyway outside the bore, m2, and its first moment about the axis, m3."""
    half, floor = 0.5 * width, bore + depth
    chord = np.sqrt(bore**2 - half**2)
    under_arc = half * chord + bore**2 * np.arcsin(half / bore)
    # Along the width the cut reaches from sqrt(bore^2 - y^2) to the floor.
    return width * floor - under_arc, width * floor**2 / 2.0 - (bore**2 * half - half**3 / 3.0)


class CounterHole(NamedTuple):
    """A round hole through the cam: its middle (2,), m, and radius, m."""

    centre: Array
    radius: float


def counter_hole(
    contour: Contour,
    unbalance: Unbalance,
    bore_radius: float,
    wall: float,
    keyway_depth: float = 0.0,
) -> CounterHole:
    """The smallest hole on the heavy side that takes the whole unbalance away.

    It stands as far out as the wall to the contour allows.

    Parameters
    ----------
    wall : float           least steel between the hole and contour or bore, m, > 0
    keyway_depth : float   added to the bore's wall, m

    Raises
    ------
    GeometryError
        If no such hole fits.
    """
    if not 0.0 < wall < np.inf:
        raise InputError("cam.wall", wall, "> 0 m")
    need = float(np.hypot(*unbalance.moment))
    if unbalance.balanced:
        raise GeometryError("the cam is balanced as it is")
    direction, ring = _heavy_side(unbalance), contour.polygon(1440)

    def spare(place: float) -> float:
        """Wall left to the contour, less the wall asked for, hole's middle at `place`."""
        away = np.hypot(*(ring - (place * direction)[:, None])).min()
        return float(away - np.sqrt(need / (np.pi * place)) - wall)

    places = np.linspace(bore_radius, _reach(unbalance, ring), 400)
    fits = [place for place in places if spare(place) >= 0.0]
    if not fits:
        raise GeometryError("no counter-hole fits between bore and contour")
    # spare() falls to zero beyond the outermost place that fits
    outermost = float(brentq(spare, fits[-1], places[-1]))
    radius = float(np.sqrt(need / (np.pi * outermost)))
    if outermost - radius - wall < bore_radius + keyway_depth:
        raise GeometryError("no counter-hole fits between bore and contour")
    return CounterHole(outermost * direction, radius)


def greatest_hole(
    contour: Contour,
    unbalance: Unbalance,
    bore_radius: float,
    wall: float,
    keyway_depth: float = 0.0,
) -> CounterHole:
    """The hole on the heavy side that takes most of an unbalance away, where none takes all.

    Parameters
    ----------
    wall, keyway_depth : float   as for `counter_hole`

    Raises
    ------
    GeometryError
        If the walls leave no room for any hole.
    """
    direction, ring = _heavy_side(unbalance), contour.polygon(1440)

    def radius(place: float) -> float:
        away = np.hypot(*(ring - (place * direction)[:, None])).min()
        return float(min(away, place - bore_radius - keyway_depth)) - wall

    def taken(place: float) -> float:
        return max(radius(place), 0.0) ** 2 * place

    places = np.linspace(bore_radius, _reach(unbalance, ring), 400)
    best = int(np.argmax([taken(place) for place in places]))
    around = (places[max(best - 1, 0)], places[min(best + 1, places.size - 1)])
    place = float(minimize_scalar(lambda x: -taken(x), bounds=around, method="bounded").x)
    if not radius(place) > 0.0:
        raise GeometryError("no hole fits between bore and contour")
    return CounterHole(place * direction, radius(place))


def _heavy_side(unbalance: Unbalance) -> Array:
    return np.array([np.cos(unbalance.angle), np.sin(unbalance.angle)])


def _reach(unbalance: Unbalance, ring: Array) -> float:
    """Where the contour stands on the heavy side, m: beyond it the distance to it grows again."""
    bearing = np.arctan2(ring[1], ring[0])
    return float(np.interp(unbalance.angle, bearing, np.hypot(*ring), period=2.0 * np.pi))
