"""Bounds of the constraints in drawing units; ratings with one bound relaxed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import ROLLER_STATIC_SAFETY, AnyLimit, utilisation_slope
from camwright.pipeline.checks.assembly import machine_shaft_gap
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE, concave_radius
from camwright.pipeline.checks.check import FACTOR_MAX
from camwright.pipeline.checks.demands import NORMAL_FORCE
from camwright.pipeline.checks.manufacture import guide_gap
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.checks.roller_bearing import (
    FIRST_ROLLER,
    SECOND_ROLLER,
    JudgedRoller,
    roller_static,
    second_roller_static,
)
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.follower.roller_motion import BALL_LIFE_EXPONENT
from camwright.pipeline.smoothing.cam_state import Constraint, ScenarioCam
from camwright.pipeline.smoothing.constraints import CONSTRAINTS
from camwright.pipeline.smoothing.scenario import Ratings

AnyConstraint = Constraint[LoadedCam] | Constraint[ScenarioCam]
Change = Callable[[Ratings, float], Ratings]


@dataclass(frozen=True)
class Bound:
    """Bound of one constraint in its drawing unit, with its relaxation.

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
    """Bounds of the constraints of a synthesis in drawing units, by the name of the constraint,
    with slope and relaxation; see `Bound`.

    Constraints that the ratings do not limit are left out. The slope of the contact pressure is
    that of a utilisation proportional to the load; see `prices`.
    """
    bounds = {}
    for each in CONSTRAINTS:
        value = each.value(ratings)
        if value is None:
            continue
        of = _OF_PART.get(each.key, _of_part) if each.row is None else partial(_of_row, each.row)
        bound = of(ratings, each, value)
        if bound is not None:
            bounds[each.name] = bound
    return bounds


def _times(key: str, ratings: Ratings, factor: float) -> Ratings:
    return ratings.times(key, factor)


def _of_row(row: AnyLimit, ratings: Ratings, one: AnyConstraint, value: float) -> Bound:
    """Bound of a constraint whose limit is a row of the limits of the case: in the unit of the row,
    with its slope.

    Parameters
    ----------
    row : AnyLimit        row of the table of limits
    ratings : Ratings     of the synthesis, which name the check that sets the limit
    one : AnyConstraint   the constraint
    value : float         its limit, SI
    """
    unit = row.quantity.unit or "-"
    shown, factor = in_unit(value, unit), min(one.kept.factor_max, one.kept.value_max / value)
    is_fixed = ratings.by.get(one.key) == machine_shaft_gap.id  # no limit of the case moves it
    relaxed = partial(_times, one.key) if factor and not is_fixed else None
    return Bound(row.title, shown, unit, utilisation_slope(row, shown), relaxed, factor)


def _of_part(ratings: Ratings, one: AnyConstraint, value: float) -> Bound:
    """Bound of a constraint that a part of the machine limits, in the unit and words of the check
    that sets it.

    Parameters
    ----------
    ratings : Ratings     of the synthesis, which name that check
    one : AnyConstraint   the constraint
    value : float         its bound, SI
    """
    declared, rule = DECLARED[ratings.by.get(one.key, one.check)], one.kept
    row, shown = declared.limit, in_unit(value, rule.unit)
    words = declared.kept_as or (declared.title if row is None else row.title)
    relaxed = partial(_times, one.key) if rule.falls > 0.0 else None
    return Bound(words, shown, rule.unit, rule.falls / shown, relaxed)


def _normal_force(ratings: Ratings, one: AnyConstraint, value: float) -> Bound:
    """Of the static rating the rating itself, N."""
    statics = roller_static.id, second_roller_static.id
    by_rating = ratings.by.get(one.key, one.check) in statics
    safety = ratings.numbers.get(f"limits.{ROLLER_STATIC_SAFETY.id}") if by_rating else None
    return _of_part(ratings, one, value if safety is None else value * float(safety))


def _guide_gap(ratings: Ratings, one: AnyConstraint, value: float) -> Bound:
    """Utilisation by the gap over the size of the follower."""
    size = in_unit(float(ratings.numbers["follower.size"]), one.kept.unit)
    return replace(_of_part(ratings, one, value), slope=-1.0 / size)


def _bearing_life(ratings: Ratings, one: AnyConstraint, _: float, at: JudgedRoller) -> Bound | None:
    """Bound of the life of the roller bearing, stated as one on its dynamic load rating, N; None
    where the rating is not known.

    At the same fatigue load limit the life grows with the cube of the rating. The third argument,
    the life, is not used.
    """
    rating = ratings.numbers.get(at.key("C"))
    if rating is None:
        return None
    relaxed = partial(_with_rating, at=at)
    return replace(_of_part(ratings, one, float(rating)), relaxed=relaxed)


def _with_rating(ratings: Ratings, factor: float, at: JudgedRoller) -> Ratings:
    """Ratings with the dynamic load rating of the roller bearing times a factor, and the bound of
    its life times the cube of the factor.
    """
    rating, name = at.key("C"), f"{at.name}_life"
    rated = ratings.numbers | {rating: ratings.numbers[rating] * factor}
    with_life = name in ratings.bounds
    life = ratings.times(name, factor**BALL_LIFE_EXPONENT) if with_life else ratings
    return replace(life, numbers=rated)


def _concave_radius(ratings: Ratings, one: AnyConstraint, value: float) -> Bound | None:
    """Bound of the concave radius of the contour, stated as one on the tool radius R, m.

    With kappa the curvature of the contour and a = `TOOL_ALLOWANCE`, the utilisation -kappa (a R -
    r) grows with R, r: radius of the roller. None where the roller is no smaller than a R: the
    limit then never binds.

    Parameters
    ----------
    ratings : Ratings     with the radius of the roller
    one : AnyConstraint   the constraint
    value : float         a R, m
    """
    room = value - float(ratings.numbers["follower.surface"])
    if room <= 0.0:
        return None
    slope = -TOOL_ALLOWANCE / in_unit(room, one.kept.unit)
    return replace(_of_part(ratings, one, value / TOOL_ALLOWANCE), slope=slope)


_OF_PART: Mapping[str, Callable[[Ratings, AnyConstraint, float], Bound | None]] = {
    NORMAL_FORCE: _normal_force,
    guide_gap.id: _guide_gap,
    second_roller_static.id: _normal_force,
    **{
        f"{at.name}_{name}": partial(_bearing_life, at=at)
        for at in (FIRST_ROLLER, SECOND_ROLLER)
        for name in ("life", "modified_life")
    },
    concave_radius.id: _concave_radius,
}
"""Bounds by key, where another number is shown, or the utilisation is no power of it."""
