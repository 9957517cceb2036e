"""Levers of each check: numbers and parts of the case whose change can turn it to pass.

A lever multiplies numbers by a factor or replaces a part by one of the catalogue. Its range is that
of a change that leaves the design what it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

BEARING, CAM_MATERIAL, BUSH_A, BUSH_B = "roller.bearing", "cam.material", "guides.a", "guides.b"
COUNTER_HOLE = "cam.counter_hole.wall"
FACTOR_MOST = 4.0


@dataclass(frozen=True)
class Scaled:
    """Numbers of the case multiplied by a common factor.

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
    """A part replaced by one of the catalogue.

    Parameters
    ----------
    key : str       `BEARING`, `CAM_MATERIAL`, `BUSH_A` or `BUSH_B`
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
    """A counter-hole in a cam without one, with its default wall."""

    key: str = COUNTER_HOLE


@dataclass(frozen=True)
class Crowned:
    """A crown of the follower whose drop relieves the ends; of a crowned one twice and half of it.

    Parameters
    ----------
    first : bool   a straight follower is crowned, too
    """

    first: bool


Lever: TypeAlias = Scaled | Catalogued | Drilled | Crowned

_DRAWN = ("none", "moving_average", "gaussian", "harmonic", "savitzky_golay", "smoothing_spline")
_COMPENSATION_MOST = 20.0  # one twentieth of the torque is next to no cam


def _one(key: str, direction: Literal[1, -1] = 1, most: float = FACTOR_MOST) -> Scaled:
    return Scaled((key,), direction, most)


def _smoothing(direction: Literal[1, -1]) -> tuple[Scaled, ...]:
    """A wider smoother (1) or a narrower one (-1), by the key of its width."""
    away: Literal[1, -1] = -1 if direction == 1 else 1
    return (
        Scaled(("smoothing.spacing",), direction, smoothers=("moving_average", "savitzky_golay")),
        Scaled(("smoothing.width",), direction, smoothers=("gaussian",)),
        Scaled(("smoothing.harmonics",), away, smoothers=("harmonic",)),
        Scaled(("smoothing.cutoff",), direction, smoothers=("smoothing_spline",)),
    )


_GENTLER = (
    *_smoothing(1),
    Scaled(("mechanism.compensation",), -1, _COMPENSATION_MOST, smoothers=_DRAWN),
)
_STRONGER = (
    *_smoothing(-1),
    Scaled(("mechanism.compensation",), 1, _COMPENSATION_MOST, smoothers=_DRAWN),
)
_PRELOADS = ("spring.preload", "load_case[*].preload")
_PRELOAD, _RATE = Scaled(_PRELOADS, 1), _one("spring.rate")
_SPRING = (_PRELOAD, _RATE)
_MASS = _one("follower.mass", -1, 2.0)
_PRIME = _one("cam.prime_radius", most=2.0)
_RADIUS = Scaled(("roller.radius",), 1, along=("cam.prime_radius", "follower.overhang_at_max_lift"))
_WIDTH = Scaled(("cam.width", "roller.width", "roller.pin.span", "follower.face.depth"), 1)
# A cam that ends within the flat of the follower has a lower pressure at its ends.
_NARROWER = Scaled(("cam.width", "cam.key.length"), -1, 1.25)
_PRESSED = Catalogued(BEARING, "C0")
LENGTHS: tuple[Scaled | Catalogued, ...] = (_WIDTH, _NARROWER, _PRESSED)
"""Levers of the length of contact: with a crown each step is a pair of bodies with a new table."""
_CROWNED, _RECROWNED = Crowned(first=True), Crowned(first=False)
_OVERHANG = _one("follower.overhang_at_max_lift", -1, 2.0)
_SPACING = _one("guides.spacing", most=2.0)
_LENGTH_A, _LENGTH_B = _one("guides.a.length", most=2.5), _one("guides.b.length", most=2.5)

_CONTACT = (*_SPRING, _MASS, *_GENTLER)
_JAM: tuple[Lever, ...] = (
    _SPACING,
    _OVERHANG,
    _LENGTH_A,
    Catalogued(BUSH_A, "friction_max", less=True),
    Catalogued(BUSH_B, "friction_max", less=True),
    _PRIME,
    *_SPRING,
    *_GENTLER,
)
_LOAD = (_PRIME, _OVERHANG, _LENGTH_A, *_GENTLER)
_SHAPE = (_PRIME, *_GENTLER)
_PRESSURE: tuple[Lever, ...] = (_WIDTH, _RADIUS, _PRIME, _PRESSED, *_GENTLER)
_ENDURANCE: tuple[Lever, ...] = (Catalogued(CAM_MATERIAL, "endurance_pressure"), *_PRESSURE)
_YIELD: tuple[Lever, ...] = (Catalogued(CAM_MATERIAL, "yield_strength"), *_PRESSURE)
_CASE: tuple[Lever, ...] = (_one("materials.{cam}.case_depth"), *_PRESSURE)
_TOOL = Scaled(("workshop.tool_radius", "limits.tool_radius"), -1)
_SEAT = _one("cam.bore_radius", -1, 2.0)


def _guide(side: Literal["a", "b"], rating: str) -> tuple[Lever, ...]:
    """Levers of the load of a guide."""
    bush, length = (BUSH_A, _LENGTH_A) if side == "a" else (BUSH_B, _LENGTH_B)
    return (Catalogued(bush, rating), length, _OVERHANG, _PRIME, *_SPRING, *_GENTLER)


def _of_guides() -> dict[str, tuple[Lever, ...]]:
    sides: tuple[Literal["a", "b"], ...] = ("a", "b")
    table: dict[str, tuple[Lever, ...]] = {}
    for side in sides:
        name, bush = side.upper(), BUSH_A if side == "a" else BUSH_B
        table |= {
            f"guide_pressure_{name}": _guide(side, "pressure_limit"),
            f"guide_pv_{name}": _guide(side, "pv_limit"),
            f"guide_edge_pressure_{name}": _guide(side, "pressure_limit"),
            f"guide_speed_{name}": (Catalogued(bush, "speed_limit"), *_SPRING, *_GENTLER),
            f"guide_temperature_{name}": (
                _one(f"guides.{side}.housing_resistance", -1),
                *_guide(side, "friction_max"),
            ),
            f"guide_wear_{name}": (_one(f"guides.{side}.wear_rate", -1), *_guide(side, "pv_limit")),
            f"guide_expansion_{name}": (_one(f"guides.{side}.clearance"),),
        }
    return table


LEVERS: Mapping[str, tuple[Lever, ...]] = {
    "torque_reduction": _STRONGER,
    "speed_reduction": _STRONGER,
    "acceleration_step": _smoothing(1),
    "pressure_angle": (*_SHAPE, *_SPRING),
    "curvature_ratio": (_one("roller.radius", -1, 2.0), *_SHAPE),
    "undercut": (_one("roller.radius", -1, 2.0), *_SHAPE),
    "self_intersection": _SHAPE,
    "second_contact": _SHAPE,
    "concave_radius": (_TOOL, *_SHAPE),
    "tool_gouge": (_TOOL, *_SHAPE),
    "minimum_wall": (_SEAT, *_SHAPE),
    "cam_radius": (_one("cam.prime_radius", -1, 2.0), *_SPRING, *_GENTLER),
    "spring_travel": (*_SPRING, *_GENTLER),
    **dict.fromkeys(
        (
            *("contact_force_margin", "contact_at_overspeed", "contact_over_speed"),
            *("elastic_contact", "jump", "jump_speed"),
        ),
        _CONTACT,
    ),
    "jam_index": _JAM,
    "jam_index_friction_max": _JAM,
    "contact_pressure": (_RECROWNED, *_ENDURANCE),
    **dict.fromkeys(
        ("edge_pressure", "contact_pressure_at_life"), (_CROWNED, _NARROWER, *_ENDURANCE)
    ),
    **dict.fromkeys(("shakedown", "shakedown_traction"), (_RECROWNED, *_YIELD)),
    "edge_shakedown": (_CROWNED, _NARROWER, *_YIELD),
    **dict.fromkeys(("hardened_case", "case_shear", "case_depth"), _CASE),
    "roller_static": (Catalogued(BEARING, "C0", inverse=True), *_LOAD),
    "roller_load_share": (Catalogued(BEARING, "C", inverse=True), *_LOAD),
    "roller_life": (Catalogued(BEARING, "C"), *_LOAD),
    "roller_modified_life": (Catalogued(BEARING, "C"), _one("roller.bearing.viscosity"), *_LOAD),
    "roller_radial": (Catalogued(BEARING, "radial_limit", inverse=True), *_LOAD),
    "roller_static_radial": (Catalogued(BEARING, "static_radial_limit", inverse=True), *_LOAD),
    "roller_speed": (Catalogued(BEARING, "speed_limit", inverse=True), *_SPRING, *_GENTLER),
    "roller_ring_fatigue": (Catalogued(BEARING, "C0"), *_LOAD),
    "bearing_lubrication": (_one("roller.bearing.viscosity"),),
    "grease_life": (Catalogued(BEARING, "C"), *_LOAD),
    **_of_guides(),
    "spring_stress": (_one("spring.design.wire_diameter", most=2.0), *_GENTLER),
    "spring_fatigue": (_one("spring.design.wire_diameter", most=2.0), *_GENTLER),
    "spring_solid": (_one("spring.design.free_length", most=2.0), *_GENTLER),
    "spring_coil_gap": (_one("spring.design.free_length", most=2.0), *_GENTLER),
    "spring_solid_stress": (_one("spring.design.free_length", -1, 2.0),),
    "spring_buckling": (_one("spring.design.mean_diameter", most=2.0), *_GENTLER),
    "gas_pressure": (_one("spring.gas.volume", most=2.0), *_GENTLER),
    "gas_stroke": (*_SPRING, *_GENTLER),
    "gas_speed": (*_SPRING, *_GENTLER),
    "torsion_stress": (_one("spring.torsion.wire_diameter", most=2.0), *_GENTLER),
    "torsion_fatigue": (_one("spring.torsion.wire_diameter", most=2.0), *_GENTLER),
    "spring_rate": (_one("spring.design.coils"), _one("spring.design.coils", -1)),
    "roller_pin": (_one("roller.pin.diameter", most=2.0), *_LOAD),
    "roller_pin_fatigue": (_one("roller.pin.diameter", most=2.0), *_LOAD),
    "roller_pin_shear": (_one("roller.pin.diameter", most=2.0), *_LOAD),
    "roller_pin_pressure": (_one("roller.pin.diameter", most=2.0), *_LOAD),
    "cheek_pressure": (_one("roller.fork.cheek_width"), *_LOAD),
    "follower_mass": (_one("follower.mass", most=2.0),),
    "bore_pressure": (_one("cam.width"), _one("cam.bore_radius", most=2.0), *_LOAD),
    "cam_unbalance": (Drilled(),),
    **dict.fromkeys(
        ("key_pressure", "key_pressure_shaft", "key_shear"),
        (Scaled(("cam.key.length", "cam.width"), 1), *_GENTLER),
    ),
    "keyway_root": (_one("cam.keyway.root_radius"), _one("cam.width"), *_GENTLER),
    "cam_slip": (_one("camshaft.slip_torque"), *_GENTLER),
    **dict.fromkeys(
        ("shaft_fatigue", "shaft_yield", "shaft_deflection", "shaft_slope"),
        (_one("camshaft.diameter", most=2.0), *_LOAD),
    ),
    "shaft_bearing_static": (_one("camshaft.bearing_static_rating"), *_LOAD),
    "shaft_bearing_life": (_one("camshaft.bearing_rating"), *_LOAD),
    **dict.fromkeys(
        ("gear_bending", "pinion_bending", "gear_contact"),
        (_one("camshaft.gear.width"), *_GENTLER),
    ),
    "face_width": (_one("follower.face.width"), *_GENTLER),
    "face_pv": (_one("follower.face.depth"), *_GENTLER),
    "guide_gap": (_one("follower.overhang_at_max_lift", most=2.0),),
    "profile_waviness": (_one("cam.profile_tolerance", -1, 10.0), _MASS, *_SPRING),
    "chord_error": (_one("workshop.table_step", -1),),
}
"""Levers by check. A check without levers has no remedy: its data are missing, it verifies the
solution, or what it compares is stated in the case."""
