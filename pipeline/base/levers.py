"""Levers of a check: numbers and parts of a case whose change can turn it to pass.

A lever multiplies numbers by a factor or replaces a part by one of the catalogue. Its range is that
of a change that leaves the design what it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

BEARING, CAM_MATERIAL, BUSH_A, BUSH_B = "roller.bearing", "cam.material", "guides.a", "guides.b"
BUSH_PIVOT = "follower.pivot.bush"
COUNTER_HOLE = "cam.counter_hole.wall"
FACTOR_MOST = 4.0


@dataclass(frozen=True)
class Scaled:
    """Lever: numbers of the case multiplied by a common factor.

    Parameters
    ----------
    keys : tuple        dotted keys; those that the case leaves out are skipped. ``[*]`` means
                        every load case, ``{cam}`` for the material of the cam
    direction : int     1: more of it, -1: less
    most : float        greatest factor, of the increase or of the decrease
    along : tuple       keys that change by the same difference as the first
    smoothers : tuple   smoothers of the torque with which it acts; (): any case
    """

    keys: tuple[str, ...]
    direction: Literal[1, -1]
    most: float = FACTOR_MOST
    along: tuple[str, ...] = ()
    smoothers: tuple[str, ...] = ()


@dataclass(frozen=True)
class Catalogued:
    """Lever: a part exchanged for another one of the catalogue.

    Parameters
    ----------
    key : str       `BEARING`, `CAM_MATERIAL`, `BUSH_A`, `BUSH_B` or `BUSH_PIVOT`
    rating : str    key of the card whose ratio is the size of the change
    less : bool     a smaller rating is the better one
    inverse : bool  the utilisation of the check is inverse to the rating
    """

    key: str
    rating: str
    less: bool = False
    inverse: bool = False


@dataclass(frozen=True)
class Drilled:
    """Lever: a counter-hole with its default wall, in a cam without one."""

    key: str = COUNTER_HOLE


@dataclass(frozen=True)
class Crowned:
    """Lever: a crown of the follower; an existing one is halved and doubled in drop.

    Parameters
    ----------
    first : bool   a straight follower is crowned, too
    """

    first: bool


Side = Literal["A", "B", "pivot"]
Lever: TypeAlias = Scaled | Catalogued | Drilled | Crowned

_DRAWN = ("none", "moving_average", "gaussian", "harmonic", "savitzky_golay", "smoothing_spline")
_COMPENSATION_MOST = 20.0  # one twentieth of the torque is next to no cam


def one(key: str, direction: Literal[1, -1] = 1, most: float = FACTOR_MOST) -> Scaled:
    """Lever of one number of the case."""
    return Scaled((key,), direction, most)


def smoothing(direction: Literal[1, -1]) -> tuple[Scaled, ...]:
    """Levers of a wider (1) or narrower (-1) smoother of the torque."""
    away: Literal[1, -1] = -1 if direction == 1 else 1
    return (
        Scaled(("smoothing.spacing",), direction, smoothers=("moving_average", "savitzky_golay")),
        Scaled(("smoothing.width",), direction, smoothers=("gaussian",)),
        Scaled(("smoothing.harmonics",), away, smoothers=("harmonic",)),
        Scaled(("smoothing.cutoff",), direction, smoothers=("smoothing_spline",)),
    )


GENTLER = (
    *smoothing(1),
    Scaled(("mechanism.compensation",), -1, _COMPENSATION_MOST, smoothers=_DRAWN),
)
STRONGER = (
    *smoothing(-1),
    Scaled(("mechanism.compensation",), 1, _COMPENSATION_MOST, smoothers=_DRAWN),
)
_PRELOADS = ("spring.preload", "load_case[*].preload")
_PRELOAD, _RATE = Scaled(_PRELOADS, 1), one("spring.rate")
SPRING = (_PRELOAD, _RATE)
MASS = one("follower.mass", -1, 2.0)
PRIME = one("cam.prime_radius", most=2.0)
RADIUS = Scaled(
    ("roller.radius",),
    1,
    along=("cam.prime_radius", "follower.overhang_at_max_lift", "roller.fork.cheek_length"),
)
WIDTH = Scaled(("cam.width", "roller.width", "roller.pin.span", "follower.face.depth"), 1)
# A cam that ends within the flat of the follower has a lower pressure at its ends.
NARROWER = Scaled(("cam.width", "cam.key.length"), -1, 1.25)
PRESSED = Catalogued(BEARING, "C0")
LENGTHS: tuple[Scaled | Catalogued, ...] = (WIDTH, NARROWER, PRESSED)
"""Levers of the length of contact: with a crown each step is a pair of bodies with a new table."""
STIFFER_SHAFT = (one("camshaft.diameter", most=2.0), one("camshaft.bearing_spacing", -1, 2.0))
CROWNED, RECROWNED = Crowned(first=True), Crowned(first=False)
OVERHANG = one("follower.overhang_at_max_lift", -1, 2.0)
SPACING = one("guides.spacing", most=2.0)
LENGTH_A, LENGTH_B = one("guides.a.length", most=2.5), one("guides.b.length", most=2.5)

CONTACT = (*SPRING, MASS, *GENTLER)
JAM: tuple[Lever, ...] = (
    SPACING,
    OVERHANG,
    LENGTH_A,
    Catalogued(BUSH_A, "friction_max", less=True),
    Catalogued(BUSH_B, "friction_max", less=True),
    PRIME,
    *SPRING,
    *GENTLER,
)
LOAD = (PRIME, OVERHANG, LENGTH_A, *GENTLER)
LOCK: tuple[Lever, ...] = (
    one("follower.pivot.bush.diameter", -1, 2.0),
    Catalogued(BUSH_PIVOT, "friction_max", less=True),
    one("follower.pivot.needle_bearing.diameter", -1, 2.0),
    *SPRING,
    *GENTLER,
)
SHAPE = (PRIME, *GENTLER)
PRESSURE: tuple[Lever, ...] = (WIDTH, RADIUS, PRIME, PRESSED, *GENTLER)
ENDURANCE: tuple[Lever, ...] = (Catalogued(CAM_MATERIAL, "endurance_pressure"), *PRESSURE)
YIELD: tuple[Lever, ...] = (Catalogued(CAM_MATERIAL, "yield_strength"), *PRESSURE)
CASE: tuple[Lever, ...] = (one("materials.{cam}.case_depth"), *PRESSURE)
TOOL = Scaled(("workshop.tool_radius", "limits.tool_radius"), -1)
SEAT = one("cam.bore_radius", -1, 2.0)


PIVOT: tuple[Lever, ...] = (
    one("follower.pivot.bush.length", most=2.5),
    one("follower.pivot.needle_bearing.length", most=2.5),
    PRIME,
    *SPRING,
    *GENTLER,
)


def guide(side: Side, rating: str) -> tuple[Lever, ...]:
    """Levers of a limit on a guide: bush of a better rating, length, overhang, radius of the cam,
    spring, gentler lift; of the bush of a pivot those of the pivot.

    Parameters
    ----------
    side : str     "a", "b" or "pivot"
    rating : str   of a bush in the catalogue that lowers the utilisation
    """
    if side == "pivot":
        return (Catalogued(BUSH_PIVOT, rating), *PIVOT)
    bush, length = _of(side)
    return (Catalogued(bush, rating), length, OVERHANG, PRIME, *SPRING, *GENTLER)


def rubbing_speed(side: Side) -> tuple[Lever, ...]:
    """Levers of the sliding speed in guide A or B, or on the pin of a pivot."""
    if side == "pivot":
        speed = Catalogued(BUSH_PIVOT, "speed_limit")
        return (speed, one("follower.pivot.bush.diameter", -1, 2.0), *SPRING, *GENTLER)
    return (Catalogued(_of(side)[0], "speed_limit"), *SPRING, *GENTLER)


def _of(side: Side) -> tuple[str, Scaled]:
    """Bush and length of a guide."""
    return (BUSH_A, LENGTH_A) if side == "A" else (BUSH_B, LENGTH_B)
