"""Bounds of the constraints in the unit of the drawing; ratings with one bound relaxed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.limits import GUIDE_GAP, AnyLimit, utilisation_slope
from camwright.pipeline.checks.cam_shape import TOOL_ALLOWANCE
from camwright.pipeline.checks.check import FACTOR_MAX, Declaration
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.smoothing.constraints import CONSTRAINTS
from camwright.pipeline.smoothing.scenario import Rating, Ratings

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
    bounds = {}
    for each in CONSTRAINTS:
        value, limit = each.value(ratings), each.limit
        if value is None:
            continue
        if not isinstance(limit, Rating):
            bounds[each.check] = _of_row(limit, value, each.factor_max, each.value_max)
            continue
        words = _words(DECLARED[limit.check_of(ratings, each.check)])
        bound = _OF_RATING.get(limit.name, _of_rating)(ratings, words, limit)
        if bound is not None:
            bounds[each.check] = bound
    return bounds


def _words(declared: Declaration) -> str:
    """What the synthesis bounds for a check: of its part, else of its row."""
    row = declared.limit
    return declared.kept_as or (declared.title if row is None else row.title)


def _of_row(row: AnyLimit, value: float, factor_max: float, value_max: float) -> Bound:
    unit = row.quantity.unit or "-"
    shown, factor = in_unit(value, unit), min(factor_max, value_max / value)
    relaxed = _with_limit(row) if factor else None
    return Bound(row.title, shown, unit, utilisation_slope(row, shown), relaxed, factor)


def _of_rating(ratings: Ratings, words: str, rating: Rating) -> Bound | None:
    shown = rating.shown(ratings)
    if shown is None:
        return None
    relaxed = rating.times if rating.power > 0.0 else None
    return Bound(words, shown, rating.unit, rating.power / shown, relaxed)


def _guide_gap(ratings: Ratings, words: str, gap: Rating) -> Bound | None:
    """Utilisation by the gap over the size of the follower."""
    bound, slope = _of_rating(ratings, words, gap), -1.0 / in_unit(ratings.follower_size, gap.unit)
    return bound and replace(bound, slope=slope)


def _modified_life(ratings: Ratings, words: str, _: Rating) -> Bound | None:
    """Modified life grows with the cube of the rating, at the same fatigue load limit."""
    return _of_rating(ratings, words, Rating("modified", "N", "rating"))


def _roller_life(ratings: Ratings, words: str, cubed: Rating) -> Bound | None:
    """Life grows with the cube of the rating."""
    dynamic = Rating("dynamic_rating", "N")

    def with_rating(each: Ratings, factor: float) -> Ratings:
        return dynamic.times(cubed.times(each, factor**3), factor)

    bound = _of_rating(ratings, words, dynamic)
    return bound and replace(bound, relaxed=with_rating)


def _concave_radius(ratings: Ratings, words: str, hollow: Rating) -> Bound | None:
    """Utilisation -kappa (a R_tool - r): it grows with the tool radius."""
    radius = hollow.of(ratings)
    if radius is None or radius <= ratings.roller_radius:
        return None
    shown = in_unit(radius / TOOL_ALLOWANCE, hollow.unit)
    slope = -TOOL_ALLOWANCE / in_unit(radius - ratings.roller_radius, hollow.unit)
    return Bound(words, shown, hollow.unit, slope, hollow.times)


_OF_RATING: Mapping[str, Callable[[Ratings, str, Rating], Bound | None]] = {
    GUIDE_GAP.id: _guide_gap,
    "modified_rate": _modified_life,
    "life_force_cubed": _roller_life,
    "hollow_radius": _concave_radius,
}
"""Bounds by the field of the ratings, where the utilisation is no power of the rating."""


def _with_limit(row: AnyLimit) -> Change:
    def change(ratings: Ratings, factor: float) -> Ratings:
        return replace(ratings, limits={**ratings.limits, row: ratings.limits[row] * factor})

    return change
