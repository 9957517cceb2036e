"""Factors of many designs: values by dotted key, bounds, grouping by structure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arm_path import Arm
from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import CamError, InputError
from camwright.geometry.flat_face_contour import require_face_width
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import knot_derivatives
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import In
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import with_values
from camwright.pipeline.case.case_values import (
    WIRE,
    following,
    quantity_of,
    replaced,
    value_of,
    wound_spring,
)
from camwright.pipeline.case.consistency import At, check_numbers, rules
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.case.machine import machine
from camwright.pipeline.case.toml_text import TomlValue
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.guide_reactions import require_fit

_GUIDES = ("guides.a", "guides.b")
_RUBBING = (*_GUIDES, "follower.pivot.bush", "follower.pivot.needle_bearing")
ARRAYS: tuple[str, ...] = (
    "spring.rate", "spring.preload", "spring.travel_max",
    *(f"spring.design.{name}" for name in WIRE),
    "cam.prime_radius", "cam.offset", "cam.width", "cam.bore_radius", "cam.profile_tolerance",
    *(f"cam.groove.{name}" for name in ("clearance", "depth", "corner_radius", "outer_radius")),
    *(f"cam.groove.second.{name}" for name in ("radius", "spacing", "step_depth", "relief")),
    *(f"cam.groove.second.bearing.{name}" for name in (
        "C", "C0", "speed_limit", "radial_limit", "static_radial_limit")),
    *(f"cam.conjugate.{name}" for name in (
        "roller_radius", "distance", "arm_length", "arm_angle", "clearance", "interference",
        "spacing")),
    "cam.yoke.clearance",
    "roller.radius", "roller.width", "roller.crown.radius", "roller.bearing.C", "roller.bearing.C0",
    "roller.bearing.speed_limit", "roller.bearing.radial_limit",
    "roller.bearing.static_radial_limit",
    "follower.mass", "follower.overhang_at_max_lift", "follower.viscous_damping",
    *(f"follower.face.{name}" for name in ("width", "depth", "thickness", "friction", "pv_limit")),
    *(f"follower.arm.{name}" for name in (
        "centre_distance", "length", "width", "depth", "bore", "hub", "roller_hub", "plane_offset",
        "spring_distance", "pivot_notch", "roller_notch")),
    *(f"follower.pivot.{name}" for name in (
        "swinging_mass", "mass_distance", "mass_angle", "gravity_angle", "load_distance",
        "load_angle", "load_moment")),
    *(f"follower.pivot.bush.{name}" for name in (
        "length", "diameter", "clearance", "wall", "friction", "friction_min", "friction_max",
        "pressure_limit", "pv_limit", "speed_limit", "wear_rate")),
    *(f"follower.pivot.needle_bearing.{name}" for name in (
        "length", "diameter", "friction", "friction_min", "friction_max", "C", "C0")),
    *(f"spring.link.{name}" for name in (
        "arm_radius", "arm_angle", "fixed_radius", "fixed_angle", "rate", "preload", "diameter",
        "plane_offset")),
    "guides.spacing",
    "guides.a.friction", "guides.a.friction_min", "guides.a.friction_max",
    "guides.b.friction", "guides.b.friction_min", "guides.b.friction_max",
    "crankshaft.inertia", "mechanism.compensation",
    "smoothing.spacing", "smoothing.width", "smoothing.harmonics", "smoothing.taper",
    "smoothing.cutoff",
    "tolerances.mass", "tolerances.inertia", "tolerances.phase",
    *(f"limits.{name}" for name in LIMITS),
)  # fmt: skip
"""Keys with an array path; and preload and speed of each load case."""

Factor = Array | Sequence[TomlValue]


def is_array(case: Case, key: str, values: Factor) -> bool:
    """Whether designs that differ in a key can be solved together as arrays; `values`: of the key,
    one a design.

    True for the keys of `ARRAYS` and for preload and speed of a load case. False still for a key in
    a table that the case leaves out, for a smoothing that is constrained, for a speed that is zero
    in a design, where the engine has no torque, for rate and preload of a gas or torsion spring,
    for a key of an arm or of the link of its spring that the case leaves out, on which the sections
    depend, and for centre distance and length of an arm with a rocker, or with the lift of an
    eccentric disc.
    """
    on_arc = case.spring.shape is not None and not key.startswith("spring.link.")
    if on_arc and key.endswith((".preload", "spring.rate")):
        return False
    if value_of(case, key.rpartition(".")[0]) is None:
        return False
    if key.startswith(("follower.arm.", "spring.link.")) and value_of(case, key) is None:
        return False
    if key in _OF_ARC and (case.rocker is not None or _is_eccentric(case)):
        return False
    if key.startswith("smoothing."):
        return key in ARRAYS and case.smoothing.kind != "constrained"
    if key.startswith("load_case["):
        speeds = (each for each in values if key.endswith(".speed"))
        still = any(_number(In("rpm"), _plain(each)) == 0.0 for each in speeds)
        return key.endswith((".preload", ".speed")) and not still
    return key in ARRAYS


_OF_ARC = ("follower.arm.centre_distance", "follower.arm.length")


def _is_eccentric(case: Case) -> bool:
    return case.lift is not None and case.lift.kind == "eccentric"


@dataclass(frozen=True, eq=False)
class Group:
    """Designs of equal structure, solved together.

    Parameters
    ----------
    case : Case           with the values that all of them share; None: refused
    rows : array (m,)     numbers of the designs
    values : mapping      by key of an array path, SI, each (m,)
    refused : str         reason of a case that is None
    """

    case: Case | None
    rows: NDArray[np.intp]
    values: Mapping[str, Array]
    refused: str = ""


def count_of(factors: Mapping[str, Factor]) -> int:
    """Number of designs, from the length of their factors.

    Raises
    ------
    InputError
        If the factors have different numbers of values, or there is none.
    """
    counts = {key: len(values) for key, values in factors.items()}
    if len(set(counts.values())) != 1:
        raise InputError("factors", str(counts)[:200], "of one length each, at least one factor")
    return next(iter(counts.values()))


def groups(case: Case, factors: Mapping[str, Factor]) -> Iterator[Group]:
    """Groups of designs that are solved together, in order of first appearance.

    Designs of one group differ in keys of array paths alone. A design whose case or values are
    refused is a group of its own with `refused`.

    Parameters
    ----------
    factors : mapping   dotted key -> values, one a design

    Raises
    ------
    InputError
        If a key is unknown, or the factors differ in length.
    """
    count = count_of(factors)
    quantities = {key: quantity_of(key) for key in factors}
    follows = following(factors)
    # what follows, of the distances from which it follows
    tied = {*_OF_ARC, *follows} if follows else set()
    shared = [
        key for key, values in factors.items() if key in tied or not is_array(case, key, values)
    ]
    together: dict[tuple[TomlValue, ...], list[int]] = {}
    for row in range(count):
        together.setdefault(tuple(_plain(factors[key][row]) for key in shared), []).append(row)
    for values, members in together.items():
        rows = np.array(members, dtype=np.intp)
        try:
            own = with_values(case, dict(zip(shared, values, strict=True))) if shared else case
        except CamError as error:
            yield Group(None, rows, {}, str(error))
            continue
        arrays = {key: factors[key] for key in factors if key not in shared}
        unread = {row: words for row in members if (words := _unread(quantities, arrays, row))}
        for row, words in unread.items():
            yield Group(None, np.array([row], dtype=np.intp), {}, words)
        kept = [row for row in members if row not in unread]
        if kept:
            columns = {key: _numbers(quantities[key], each, kept) for key, each in arrays.items()}
            yield Group(own, np.array(kept, dtype=np.intp), columns)


def _unread(quantities: Mapping[str, object], arrays: Mapping[str, Factor], row: int) -> str:
    """Refusal of the first text of a design that is no number with a unit; "" without one.

    Parameters
    ----------
    quantities : mapping   quantity of each key, which has its unit
    arrays : mapping       dotted key -> values, one a design
    row : int              number of the design
    """
    for key, values in arrays.items():
        quantity, value = quantities[key], "" if _is_numeric(values) else _plain(values[row])
        if isinstance(quantity, In) and isinstance(value, str) and value:
            try:
                units.parse(value, quantity.unit, key)
            except InputError as error:
                return str(error)
    return ""


def _is_numeric(values: Factor) -> bool:
    return isinstance(values, np.ndarray) and values.dtype.kind in "fiu"


def _plain(value: object) -> TomlValue:
    """A value of an array as one of a TOML file.

    Raises
    ------
    InputError
        If it is no text, number, true or false.
    """
    plain = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, (str, int, float, bool)):
        return plain
    raise InputError("factors", str(plain)[:80], "text, number, true or false")


def _numbers(quantity: object, values: Factor, rows: Sequence[int]) -> Array:
    """Values of a factor for the designs numbered `rows` (m,), SI; NaN where one cannot be read.

    Raises
    ------
    InputError
        If the values are no numbers and the key is not that of a number.
    """
    if isinstance(values, np.ndarray) and _is_numeric(values):
        return np.asarray(values[rows], dtype=float)
    if not isinstance(quantity, In):
        raise InputError("factors", str(quantity), "the key of a number")
    return np.array([_number(quantity, _plain(values[row])) for row in rows])


def _number(quantity: In, value: TomlValue) -> float:
    """Value of a case file, a number in SI or text with a unit, in SI; NaN where it
    cannot be read.
    """
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        return np.nan
    if not isinstance(value, str):
        return float(value) if abs(value) < 1e308 else np.nan
    try:
        return units.parse(value, quantity.unit, "") if quantity.unit else np.nan
    except InputError:
        return np.nan


def refusals(
    case: Case,
    values: Mapping[str, Array],
    highest: Array,
    travel: Array | None = None,
    lifts: Array | None = None,
) -> list[str]:
    """Reason for the refusal of each design, "" where it is accepted.

    Suspects are found on arrays; the case of each is then made, and names field, value and limit.

    Parameters
    ----------
    values : mapping       by key of an array path, SI, each (m,)
    highest : array (m,)   maximum lift, m; NaN where it is not known
    travel : array (m,)    of the contact on a flat face, m; None: a roller, or not known
    lifts : array (m, n)   m, or (1, n) of all; None: not known
    """
    words = [""] * highest.size
    suspects = _suspects(case, values, highest, travel)
    suspects |= _swing_suspects(case, values, _values(case, values, highest.size), lifts)
    for row in np.flatnonzero(suspects):
        numbers = {key: float(column[row]) for key, column in values.items()}
        try:
            own = replaced(case, numbers)
            check_numbers(own)
            _require_guided(own, float(highest[row]))
            if lifts is not None and own.follower.arm is not None:
                own.contour(Lift(uniform_turn(lifts.shape[-1]), lifts[row % len(lifts)]))
            if travel is not None:
                require_face_width(value_of(own, "follower.face.width"), float(travel[row]))
        except CamError as error:
            words[row] = str(error)
    return words


def _require_guided(case: Case, highest: float) -> None:
    """Refuse guides that the roller enters, or that the stem leaves; `highest`: maximum lift, m."""
    if not isfinite(highest):
        return
    state = machine(case, case.load_cases[0])
    least = state.overhang_at_max_lift
    require_fit(state.stem, state.guides, np.array([least, least + highest]), knots=3)


def _swing_suspects(
    case: Case, values: Mapping[str, Array], at: At, lifts: Array | None
) -> NDArray[np.bool_]:
    """Designs whose arm (m,) may not reach the cam, may leave the turn in which its follower can
    touch it, or have a spring that does not close; lifts (m, n) or (1, n), m, None: not known.
    """
    arm = case.follower.arm
    if arm is None:
        return np.zeros((), dtype=bool)
    distance, length = (at(f"follower.arm.{name}") for name in ("centre_distance", "length"))
    sized = (distance > 0.0) & (length > 0.0)
    linkage = Arm(np.where(sized, distance, 1.0), np.where(sized, length, 1.0), arm.sense)
    offset = None if value_of(case, "follower.face.offset") is None else at("follower.face.offset")
    start = linkage.start_angle(at("cam.prime_radius"), offset)
    lift = np.zeros((1, 1)) if lifts is None else lifts
    angle = np.asarray(start)[:, None] + lift / np.asarray(linkage.length)[:, None]
    most = np.pi if offset is None else 0.5 * np.pi
    within = (angle > _NEAR_CENTRES) & (angle < most - _NEAR_CENTRES)
    if offset is not None:
        arms = replace(linkage, centre_distance=np.asarray(linkage.centre_distance)[:, None])
        within &= np.asarray(arms.face_radius(angle, offset[:, None])) > 0.0
        if lifts is not None:
            rate = knot_derivatives(lifts, 1)[1] / np.asarray(linkage.length)[:, None]
            within &= arm.sense * rate < 1.0 - _NEAR_CENTRES
    wrong = ~(sized & within.all(axis=-1))
    shape = Numbers({key: each[:, None] for key, each in values.items()}, case).spring_shape
    if shape is not None and shape is not case.spring.shape:
        for figure in (shape.preload, shape.rate):
            wrong |= ~(np.broadcast_to(figure, (distance.size, 1))[:, 0] > 0.0)
    return np.asarray(wrong)


_NEAR_CENTRES = 1e-3
"""Angle from a line of centres, rad, at which an arm is tried on its own, between samples, too."""


def _values(case: Case, values: Mapping[str, Array], count: int) -> At:
    """Function that gives the values (m,) of a key in the `count` designs, SI: those of `values`,
    else what the case states; NaN where it states nothing.
    """

    def at(key: str) -> Array:
        """Values of a key (m,), SI; see `_values`."""
        if key in values:
            return values[key]
        stated = value_of(case, key)
        return np.full(count, np.nan if stated is None else stated, dtype=float)

    return at


def _suspects(
    case: Case, values: Mapping[str, Array], highest: Array, travel: Array | None
) -> NDArray[np.bool_]:
    """Designs that may be refused (m,): a value out of bounds, or values that do not fit one
    another; inputs as those of `refusals`.
    """
    count = highest.size
    at = _values(case, values, count)
    wrong = np.zeros(count, dtype=bool)
    for key, column in values.items():
        quantity = quantity_of(key)
        if isinstance(quantity, In):
            wrong |= ~quantity.holds_each(column)
    with np.errstate(invalid="ignore"):  # a comparison with NaN, of a missing value, is false
        if travel is not None:
            wrong |= at("follower.face.width") <= travel
        for rule in rules(case):
            wrong |= rule.breaks(at)
        if (wound := wound_spring(case, at)) is not None:
            wrong |= ~(wound.can_be_coiled & wound.is_open)
        half = 0.5 * (at("guides.a.length") + at("guides.b.length"))
        wrong |= at("guides.spacing") <= half
        for table in _RUBBING if case.follower.pivot is not None else _GUIDES:
            friction = at(f"{table}.friction")
            wrong |= at(f"{table}.friction_min") > friction
            wrong |= at(f"{table}.friction_max") < friction
        if case.follower.arm is not None:
            hub = at("follower.arm.depth" if case.follower.arm.hub is None else "follower.arm.hub")
            wrong |= at("follower.arm.bore") >= hub
        reach = (
            at("follower.overhang_at_max_lift")
            + highest
            + at("guides.spacing")
            + 0.5 * at("guides.b.length")
        )
        wrong |= at("follower.stem_length") < reach
    return np.asarray(wrong)
