"""Constraints of a synthesis: utilisation of each limit by cam angle, differentiable.

The demands are those of the checks, by the same functions of complex numbers: a complex step gives
the derivative to round-off. A constraint is met at a utilisation of at most 1. Where a demand must
be at least its limit, the utilisation is 1 plus the shortfall, which is smooth where the quotient
of limit and demand is not.

A check that is kept at a row of the table of limits is one by its declaration, with value, title,
unit and slope of the row; one that is kept at the limit of a part is listed here with its `Rating`.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import Literal

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet
from camwright.pipeline.case.limits import JUMP_SPEED, AnyLimit
from camwright.pipeline.checks import (
    cam_shape,
    contact_strength,
    guide_strength,
    jump_and_jamming,
    manufacture,
    part_strength,
    roller_bearing,
)
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.smoothing.cam_state import (
    Constraint,
    Mean,
    ScenarioCam,
    State,
    kept,
    kept_loads,
    loaded,
    unloaded,
)
from camwright.pipeline.smoothing.part_constraints import (
    PART_SHAPE,
    PARTS,
)
from camwright.pipeline.smoothing.scenario import DesignVariables, Rating, Ratings, Scenario


def shape_utilisations(
    jet: Jet, variables: DesignVariables, ratings: Ratings, names: Container[str] | None = None
) -> Mapping[str, Array | Mean]:
    """Utilisations of the limits on the shape of the cam, or of those named, by check; (n,)."""
    return _utilisations(SHAPE, unloaded(jet, variables, ratings), ratings, names)


def load_utilisations(
    jet: Jet,
    highest: float,
    variables: DesignVariables,
    ratings: Ratings,
    scenario: Scenario,
    names: Container[str] | None = None,
) -> Mapping[str, Array | Mean]:
    """Utilisations of the limits on the loads, or of those named; each (..., n), or a `Mean`.

    Leading axes are those of stacked scenarios.
    """
    return utilisations_of(loaded(jet, highest, variables, ratings, scenario), names)


def utilisations_of(
    loads: ScenarioCam, names: Container[str] | None = None
) -> Mapping[str, Array | Mean]:
    """As `load_utilisations`, of a loaded cam."""
    return _utilisations(LOADS, loads, loads.ratings, names)


def delivered_torque(
    jet: Jet, highest: float, variables: DesignVariables, scenario: Scenario, ratings: Ratings
) -> Array:
    """Cam torque F_a s', friction and inertia included, N m, (n,); with the sliding of a face."""
    return loaded(jet, highest, variables, ratings, scenario).torque


def _utilisations(
    constraints: tuple[Constraint[State], ...],
    state: State,
    ratings: Ratings,
    names: Container[str] | None,
) -> Mapping[str, Array | Mean]:
    uses: dict[str, Array | Mean] = {}
    for each in constraints:
        if names is not None and each.check not in names:
            continue
        limit = each.value(ratings)
        use = None if limit is None else each.utilisation(state, limit)
        if use is not None:
            uses[each.check] = use
    return uses


def kept_at_rows(
    checks: Iterable[Declaration], others: Container[str]
) -> tuple[tuple[Constraint[LoadedCam], ...], tuple[Constraint[ScenarioCam], ...]]:
    """Constraints on shape and loads of the checks that are kept at a row of the table of limits.

    Without others, the least limit of a group, and maximum lift, which `travel_limits` bounds.
    """
    shape, loads = [], []
    for each in checks:
        how = each.measured
        if how is None or how.kept is None or each.limit is None or each.id in others:
            continue
        if how.reduce == "contour":
            shape.append(kept(each))
        elif not how.kept.group and how.reduce not in ("top", "case"):
            loads.append(kept_loads(each))
    return tuple(shape), tuple(loads)


_FORCE = Rating("normal_force", "N", by="normal_force_by", factor="force_safety")
# Listed in the order of the rows of the search, on which its round-off depends; others follow.
_SHAPE: tuple[Constraint[LoadedCam], ...] = (
    kept(cam_shape.spring_travel, Rating("travel", "mm")),
    kept(cam_shape.pressure_angle),
    kept(cam_shape.curvature_ratio),
    kept(cam_shape.undercut),
    kept(cam_shape.concave_radius, Rating("hollow_radius", "mm")),
    kept(cam_shape.curvature_rate),
    kept(manufacture.cam_radius),
    kept(cam_shape.minimum_wall),
    *PART_SHAPE,
)
_LOADS: tuple[Constraint[ScenarioCam], ...] = (
    kept_loads(contact_strength.contact_pressure, Rating("pressure", "MPa", by="pressure_by")),
    kept_loads(jump_and_jamming.contact_force_margin),
    kept_loads(jump_and_jamming.contact_at_overspeed),
    kept_loads(jump_and_jamming.jump),
    kept_loads(jump_and_jamming.jump_speed, Rating(JUMP_SPEED.id, "rpm", power=-2.0)),
    kept_loads(jump_and_jamming.jam_index),
    kept_loads(jump_and_jamming.jam_index_friction_max),
    kept_loads(roller_bearing.roller_static, _FORCE),
    kept_loads(part_strength.bore_pressure, _FORCE, needs="face"),
    kept_loads(roller_bearing.roller_speed, Rating("roller_spin", "rpm")),
    kept_loads(roller_bearing.roller_life, Rating("life_force_cubed", "N^3 rad/s")),
    kept_loads(guide_strength.guide_pressure_a, Rating("guide_pressure", "MPa", 0)),
    kept_loads(guide_strength.guide_pv_a, Rating("guide_pv", "MPa m/s", 0)),
    kept_loads(guide_strength.guide_pressure_b, Rating("guide_pressure", "MPa", 1)),
    kept_loads(guide_strength.guide_pv_b, Rating("guide_pv", "MPa m/s", 1)),
    *PARTS,
)
_LISTED = {each.check for each in _SHAPE} | {each.check for each in _LOADS}
_OTHERS = kept_at_rows(CHECKS, _LISTED)
SHAPE: tuple[Constraint[LoadedCam], ...] = (*_SHAPE, *_OTHERS[0])
"""Limits on the shape of the cam."""
LOADS: tuple[Constraint[ScenarioCam], ...] = (*_LOADS, *_OTHERS[1])
"""Limits on the loads of the cam in one scenario."""

CONSTRAINTS: tuple[Constraint[LoadedCam] | Constraint[ScenarioCam], ...] = (*SHAPE, *LOADS)


def rows_kept(follower: Literal["roller", "face"]) -> tuple[AnyLimit, ...]:
    """Rows of the table of limits that the synthesis keeps with a kind of follower."""
    kept = (each.row for each in CONSTRAINTS if each.needs in ("", follower))
    return tuple(dict.fromkeys(row for row in kept if row is not None))
