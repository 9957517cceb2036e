"""Bounds of the constraints in the unit of the drawing; ratings with one bound relaxed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import GUIDE_GAP, TOOL_RADIUS, AnyLimit, utilisation_slope
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.checks.check import FACTOR_MAX
from camwright.pipeline.smoothing.constraints import CONSTRAINTS
from camwright.pipeline.smoothing.scenario import Ratings

_PRESSURES = {
    "contact_pressure": "contact pressure at the endurance limit",
    "edge_pressure": "edge pressure at the endurance limit",
    "contact_pressure_at_life": "contact pressure at the target life",
    "shakedown": "shakedown pressure",
    "shakedown_traction": "shakedown pressure with sliding",
    "edge_shakedown": "edge pressure at shakedown with sliding",
    "hardened_case": "contact pressure at the strength of case and core",
    "case_shear": "contact pressure at the shear fatigue of case and core",
}
_FORCES = {
    "roller_static": "static load rating of the roller",
    "roller_load_share": "share of the dynamic load rating of the roller",
    "roller_radial": "maximum radial load of the roller's outer ring",
    "roller_static_radial": "maximum static radial load of the roller's outer ring",
    "roller_pin": "normal force at the maximum stress of the roller pin",
    "roller_pin_shear": "normal force at the maximum shear stress of the roller pin",
    "roller_pin_pressure": "normal force at the maximum pressure in the bearing's bore",
    "cheek_pressure": "normal force at the maximum pressure of the pin in its fork",
    "roller_ring_fatigue": "normal force at the bending fatigue of the roller's outer ring",
    "bore_pressure": "normal force at the maximum pressure of the cam's bore",
    "roller_pin_fatigue": "normal force at the bending fatigue of the roller pin",
    "case_depth": "normal force at the least case depth",
    "shaft_fatigue": "normal force at the fatigue of the camshaft",
    "shaft_yield": "normal force at the yield of the camshaft",
    "shaft_deflection": "normal force at the maximum deflection of the camshaft",
    "shaft_slope": "normal force at the maximum slope of the camshaft",
    "shaft_bearing_static": "normal force at the static load rating of the camshaft bearings",
    "shaft_bearing_life": "normal force at the rating life of the camshaft bearings",
}
_TORQUES = {
    "key_pressure": "cam torque at the maximum pressure of the key on the cam",
    "key_pressure_shaft": "cam torque at the maximum pressure of the key on the camshaft",
    "key_shear": "cam torque at the maximum shear stress of the key",
    "cam_slip": "cam torque at the slip of the cam's seat",
    "gear_bending": "torque at the maximum root stress of the driving gear",
    "pinion_bending": "torque at the maximum root stress of the pinion",
    "gear_contact": "torque at the maximum flank pressure of the driving gear",
}

Change = Callable[[Ratings, float], Ratings]


@dataclass(frozen=True)
class Bound:
    """A bound of one constraint.

    Parameters
    ----------
    words : str      bounded quantity
    value : float    in `unit`
    unit : str       "-": a pure number
    slope : float    decrease of the utilisation per unit of the bound, at the bound; negative
                     where a greater value tightens the constraint
    relaxed : callable   ratings, factor -> ratings with the bound times the factor; None: fixed
    factor_max : float   maximum factor of a relaxation
    """

    words: str
    value: float
    unit: str
    slope: float
    relaxed: Change | None = field(default=None, repr=False, compare=False)
    factor_max: float = FACTOR_MAX


def bounds_of(ratings: Ratings) -> dict[str, Bound]:
    """Bounds of a synthesis by check.

    The slope of the contact pressure is that of a utilisation proportional to the load; see
    `prices`.
    """
    bounds = {name: bound for name, bound in _of_parts(ratings).items() if bound is not None}
    for each in CONSTRAINTS:
        row, value = each.row, each.value(ratings)
        if row is None or value is None:
            continue
        unit = row.quantity.unit or "-"
        shown, factor = in_unit(value, unit), min(each.factor_max, each.value_max / value)
        slope, relaxed = utilisation_slope(row, shown), _with_limit(row) if factor else None
        bounds[each.check] = Bound(row.title, shown, unit, slope, relaxed, factor)
    return bounds


def _of_parts(ratings: Ratings) -> dict[str, Bound | None]:
    """Bounds set by parts and tools."""
    bounds = {
        "spring_travel": _of_part("spring travel", "mm", ratings.travel, _rating("travel")),
        "contact_pressure": _of_part(
            _PRESSURES[ratings.pressure_by], "MPa", ratings.pressure, _rating("pressure")
        ),
        "roller_speed": _of_part(
            "limiting speed of the roller", "rpm", ratings.roller_spin, _rating("roller_spin")
        ),
        "roller_static" if ratings.face is None else "bore_pressure": _of_part(
            _FORCES[ratings.normal_force_by], "N",
            _times(ratings.normal_force, ratings.force_safety), _rating("normal_force"),
        ),
        "traction_demand": _of_part(
            "friction of the roller on the cam", "-", ratings.friction, _rating("friction")
        ),
        "key_pressure": _of_part(
            _TORQUES[ratings.cam_torque_by], "N m", ratings.cam_torque, _rating("cam_torque")
        ),
        "gear_bending": _of_part(
            _TORQUES[ratings.tooth_torque_by], "N m", ratings.tooth_torque, _rating("tooth_torque")
        ),
        "gas_speed": _of_part(
            "lift per radian at the maximum speed of the gas spring", "mm", ratings.gas_slope,
            _rating("gas_slope"),
        ),
        "guide_gap": _guide_gap(ratings),
        "bearing_lubrication": _roller_spin_least(ratings),
        "roller_modified_life": _modified_life(ratings),
        "grease_life": _grease(ratings),
        "roller_life": _roller_life(ratings),
        "concave_radius": _concave_radius(ratings),
        "jump_speed": _jump_speed(ratings),
    }  # fmt: skip
    for place, side in enumerate("AB"):
        bounds |= _of_guide(ratings, place, side)
    return bounds | _of_face(ratings)


def _of_face(ratings: Ratings) -> dict[str, Bound | None]:
    if ratings.face is None:
        return {}

    def with_width(each: Ratings, factor: float) -> Ratings:
        return replace(each, face=each.face and each.face._replace(width=each.face.width * factor))

    def with_pv(each: Ratings, factor: float) -> Ratings:
        return replace(each, face=each.face and each.face._replace(pv=_times(each.face.pv, factor)))

    return {
        "face_width": _of_part("width of the flat face", "mm", ratings.face.width, with_width),
        "face_pv": _of_part("PV of the flat face", "MPa m/s", ratings.face.pv, with_pv),
    }


def _rating(name: str, place: int | None = None) -> Change:
    """Change of the rating of a name by a factor; place: of guide A, 0, or B, 1."""

    def change(ratings: Ratings, factor: float) -> Ratings:
        value = getattr(ratings, name)
        scaled = _times(value, factor) if place is None else _side_times(value, place, factor)
        return replace(ratings, **{name: scaled})  # type: ignore[arg-type]

    return change


def _of_part(words: str, unit: str, value: float | None, relaxed: Change) -> Bound | None:
    if value is None:
        return None
    shown = in_unit(value, unit)
    return Bound(words, shown, unit, 1.0 / shown, relaxed)


def _of_guide(ratings: Ratings, place: int, side: str) -> dict[str, Bound | None]:
    def bound(words: str, unit: str, name: str) -> Bound | None:
        return _of_part(words, unit, getattr(ratings, name)[place], _rating(name, place))

    expands = ratings.guide_power_by[place] != f"guide_temperature_{side}"
    at = "least clearance" if expands else "greatest temperature"
    return {
        f"guide_pressure_{side}": bound(
            f"bearing pressure of guide {side}", "MPa", "guide_pressure"
        ),
        f"guide_pv_{side}": bound(f"PV of guide {side}", "MPa m/s", "guide_pv"),
        f"guide_wear_{side}": bound(
            f"PV of guide {side} at its wear depth", "MPa m/s", "guide_wear_pv"
        ),
        f"guide_edge_pressure_{side}": bound(
            f"line load of guide {side} at the yield strength", "N/mm", "guide_edge_load"
        ),
        f"guide_temperature_{side}": bound(
            f"friction power of guide {side} at its {at}", "W", "guide_power"
        ),
        f"guide_speed_{side}": bound(
            f"lift per radian at the maximum sliding speed in guide {side}", "mm", "guide_slope"
        ),
    }


def _guide_gap(ratings: Ratings) -> Bound | None:
    """Utilisation by the gap over the size of the follower."""
    if ratings.guide_gap is None:
        return None
    slope = -1.0 / in_unit(ratings.follower_size, "mm")
    return Bound(
        GUIDE_GAP.title, in_unit(ratings.guide_gap, "mm"), "mm", slope, _rating("guide_gap")
    )


def _roller_spin_least(ratings: Ratings) -> Bound | None:
    if ratings.roller_spin_least is None:
        return None
    shown = in_unit(ratings.roller_spin_least, "rpm")
    words = "mean speed of the roller at the least viscosity ratio"
    return Bound(words, shown, "rpm", -1.0 / shown)


def _modified_life(ratings: Ratings) -> Bound | None:
    """Modified life grows with the cube of the rating, at the same fatigue load limit."""
    modified = ratings.modified
    if modified is None or ratings.modified_rate is None:
        return None

    def with_rating(each: Ratings, factor: float) -> Ratings:
        changed = each.modified and each.modified._replace(rating=each.modified.rating * factor)
        return replace(each, modified=changed)

    words = "dynamic load rating of the roller at its modified life"
    return _of_part(words, "N", modified.rating, with_rating)


def _grease(ratings: Ratings) -> Bound | None:
    """The life of the grease follows from the load over the rating."""
    if ratings.grease is None:
        return None

    def with_rating(each: Ratings, factor: float) -> Ratings:
        changed = each.grease and each.grease._replace(rating=each.grease.rating * factor)
        return replace(each, grease=changed)

    words = "dynamic load rating of the roller at the life of its grease"
    return _of_part(words, "N", ratings.grease.rating, with_rating)


def _roller_life(ratings: Ratings) -> Bound | None:
    """Life grows with the cube of the rating."""
    if ratings.life_force_cubed is None:
        return None

    def with_rating(each: Ratings, factor: float) -> Ratings:
        cubed = _times(each.life_force_cubed, factor**3)
        return replace(
            each, life_force_cubed=cubed, dynamic_rating=_times(each.dynamic_rating, factor)
        )

    words = "dynamic load rating of the roller"
    return _of_part(words, "N", ratings.dynamic_rating, with_rating)


def _concave_radius(ratings: Ratings) -> Bound | None:
    """Utilisation -kappa (a R_tool - r): it grows with the tool radius."""
    hollow = ratings.hollow_radius
    if hollow is None or hollow <= ratings.roller_radius:
        return None
    unit = TOOL_RADIUS.quantity.unit
    shown, room = in_unit(hollow / TOOL_ALLOWANCE, unit), hollow - ratings.roller_radius
    slope = -TOOL_ALLOWANCE / in_unit(room, unit)
    return Bound(TOOL_RADIUS.title, shown, unit, slope, _rating("hollow_radius"))


def _jump_speed(ratings: Ratings) -> Bound | None:
    """Utilisation m w^2 s'' over the spring force: it grows with the square of the speed."""
    if ratings.jump_speed is None:
        return None
    shown = in_unit(ratings.jump_speed, "rpm")
    return Bound("cam speed without follower jump", shown, "rpm", -2.0 / shown)


def _with_limit(row: AnyLimit) -> Change:
    def change(ratings: Ratings, factor: float) -> Ratings:
        return replace(ratings, limits={**ratings.limits, row: ratings.limits[row] * factor})

    return change


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _side_times(
    pair: tuple[float | None, float | None], place: int, factor: float
) -> tuple[float | None, float | None]:
    a, b = pair
    return (_times(a, factor), b) if place == 0 else (a, _times(b, factor))
