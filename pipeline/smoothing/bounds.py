"""Bounds of a synthesis in the units of a drawing, and the ratings with a bound relaxed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    CONTACT_FORCE_MARGIN,
    CURVATURE_RATE,
    CURVATURE_RATIO,
    JAM_INDEX,
    JUMP,
    PRESSURE_ANGLE,
    TOOL_RADIUS,
    UNDERCUT_FACTOR,
    AnyLimit,
    utilisation_slope,
)
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.smoothing.scenario import Ratings

FACTOR_MAX = 4.0
_STEEPEST = np.radians(60.0)  # greatest pressure angle of a relaxation
_PRESSURES = {
    "contact_pressure": "contact pressure at the endurance limit",
    "edge_pressure": "edge pressure at the endurance limit",
    "contact_pressure_at_life": "contact pressure at the target life",
    "shakedown": "shakedown pressure",
    "shakedown_traction": "shakedown pressure with sliding",
}
_FORCES = {
    "roller_static": "static load rating of the roller",
    "roller_radial": "radial load limit of the roller's outer ring",
    "roller_pin": "normal force that the roller pin bears",
}

Eased = Callable[[Ratings, float], Ratings]


@dataclass(frozen=True)
class Bound:
    """A bound of one constraint.

    Parameters
    ----------
    words : str      what is bounded
    value : float    in `unit`
    unit : str       "-": a pure number
    slope : float    fall of the utilisation for one more unit where the bound is reached; below
                     zero where a greater value takes room away
    eased : callable   ratings, factor -> ratings with the bound times the factor; None: the
                       bound is not relaxed
    factor_max : float   of a relaxation
    """

    words: str
    value: float
    unit: str
    slope: float
    eased: Eased | None = field(default=None, repr=False, compare=False)
    factor_max: float = FACTOR_MAX


def bounds_of(ratings: Ratings) -> dict[str, Bound]:
    """Bounds of a synthesis by the name of their constraint.

    The slope of the contact pressure is that of a utilisation that is all load; see `prices`.
    """
    steepest = _STEEPEST / (ratings.pressure_angle or _STEEPEST)
    bounds = {
        "pressure_angle": _of_limit(PRESSURE_ANGLE, ratings, "pressure_angle", steepest),
        "jam_index": _of_limit(JAM_INDEX, ratings, "jam_index", FACTOR_MAX),
        "jam_index_friction_max": _of_limit(JAM_INDEX, ratings, "jam_index"),
        "curvature_rate": _of_limit(CURVATURE_RATE, ratings, "curvature_rate"),
        "curvature_ratio": _of_limit(CURVATURE_RATIO, ratings, "curvature_ratio"),
        "undercut": _of_limit(UNDERCUT_FACTOR, ratings, "undercut_factor"),
        "cam_radius": _of_limit(CAM_RADIUS, ratings, "cam_radius", FACTOR_MAX),
        "jump": _of_limit(JUMP, ratings, "jump"),
        "contact_force_margin": _of_limit(CONTACT_FORCE_MARGIN, ratings, "contact_force_margin"),
        "contact_at_overspeed": _of_limit(CONTACT_FORCE_MARGIN, ratings, "contact_force_margin"),
        "spring_travel": _of_part("spring travel", "mm", ratings, "travel"),
        "contact_pressure": _of_part(_PRESSURES[ratings.pressure_by], "MPa", ratings, "pressure"),
        "roller_speed": _of_part("limiting speed of the roller", "rpm", ratings, "roller_spin"),
        "roller_static": _of_part(
            _FORCES[ratings.normal_force_by], "N", ratings, "normal_force", ratings.force_safety
        ),
        "roller_life": _roller_life(ratings),
        "concave_radius": _concave_radius(ratings),
        "jump_speed": _jump_speed(ratings),
    }
    for place, side in enumerate("AB"):
        pressure, product = ratings.guide_pressure[place], ratings.guide_pv[place]
        bounds[f"guide_pressure_{side}"] = _of_guide(
            f"bearing pressure of guide {side}", "MPa", pressure, "guide_pressure", place
        )
        bounds[f"guide_pv_{side}"] = _of_guide(
            f"PV of guide {side}", "MPa m/s", product, "guide_pv", place
        )
    return {name: bound for name, bound in bounds.items() if bound is not None}


def _of_limit(
    limit: AnyLimit, ratings: Ratings, name: str, factor_max: float = 0.0
) -> Bound | None:
    """The bound of a row of the table of limits; relaxed where a greatest factor is given."""
    value: float | None = getattr(ratings, name)
    if value is None:
        return None
    unit = limit.quantity.unit or "-"
    shown = in_unit(value, unit)
    slope = utilisation_slope(limit, shown)
    return Bound(limit.title, shown, unit, slope, _rated(name) if factor_max else None, factor_max)


def _of_part(
    words: str, unit: str, ratings: Ratings, name: str, safety: float = 1.0
) -> Bound | None:
    """The bound that a part sets; `safety` is the factor inside the rating."""
    value: float | None = getattr(ratings, name)
    if value is None:
        return None
    shown = in_unit(value * safety, unit)
    return Bound(words, shown, unit, 1.0 / shown, _rated(name))


def _of_guide(words: str, unit: str, value: float | None, name: str, place: int) -> Bound | None:
    if value is None:
        return None
    shown = in_unit(value, unit)
    return Bound(words, shown, unit, 1.0 / shown, _rated_side(name, place))


def _roller_life(ratings: Ratings) -> Bound | None:
    rating = ratings.dynamic_rating
    if ratings.life_force_cubed is None or rating is None:
        return None
    return Bound("dynamic load rating of the roller", rating, "N", 1.0 / rating, _longer_life)


def _concave_radius(ratings: Ratings) -> Bound | None:
    """The utilisation is -kappa (a R_tool - r): a larger tool takes room away."""
    hollow = ratings.hollow_radius
    if hollow is None or hollow <= ratings.roller_radius:
        return None
    unit = TOOL_RADIUS.quantity.unit
    shown, room = in_unit(hollow / TOOL_ALLOWANCE, unit), hollow - ratings.roller_radius
    slope = -TOOL_ALLOWANCE / in_unit(room, unit)
    return Bound(TOOL_RADIUS.title, shown, unit, slope, _rated("hollow_radius"))


def _jump_speed(ratings: Ratings) -> Bound | None:
    """The utilisation, m w^2 s'' over the spring force, grows with the square of the speed."""
    if ratings.jump_speed is None:
        return None
    shown = in_unit(ratings.jump_speed, "rpm")
    return Bound("cam speed without follower jump", shown, "rpm", -2.0 / shown)


def _rated(name: str) -> Eased:
    def eased(ratings: Ratings, factor: float) -> Ratings:
        return Ratings(**(vars(ratings) | {name: getattr(ratings, name) * factor}))

    return eased


def _rated_side(name: str, place: int) -> Eased:
    def eased(ratings: Ratings, factor: float) -> Ratings:
        both: tuple[float, float] = getattr(ratings, name)
        sides = tuple(each * factor if k == place else each for k, each in enumerate(both))
        return Ratings(**(vars(ratings) | {name: sides}))

    return eased


def _longer_life(ratings: Ratings, factor: float) -> Ratings:
    worn, rating = ratings.life_force_cubed or 0.0, ratings.dynamic_rating or 0.0
    return replace(ratings, life_force_cubed=worn * factor**3, dynamic_rating=rating * factor)
