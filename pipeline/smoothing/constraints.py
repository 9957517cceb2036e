"""Constraints of a synthesis: utilisation of each limit by cam angle, differentiable.

The demands are those of the checks, by the same functions of complex numbers: a complex step gives
the derivative to round-off. A constraint is met at a utilisation of at most 1. Where a demand must
be at least its limit, the utilisation is 1 plus the shortfall, which is smooth where the quotient
of limit and demand is not.

The limits are those of the checks that are declared as kept, and of those of `part_constraints`.
"""

from __future__ import annotations

from collections.abc import Container, Mapping

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet
from camwright.pipeline.checks.check import Declaration, Measured
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
from camwright.pipeline.smoothing.part_constraints import PARTS
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario


def shape_utilisations(
    jet: Jet, variables: DesignVariables, ratings: Ratings, names: Container[str] | None = None
) -> Mapping[str, Array | Mean]:
    """Utilisations of the limits on the shape of the cam, or of those named, by check; (n,)."""
    return _utilisations(SHAPE, unloaded(jet, variables, ratings), ratings, names)


def utilisations_of(
    loads: ScenarioCam, names: Container[str] | None = None
) -> Mapping[str, Array | Mean]:
    """Utilisations of the limits on the loads, or of those named; each (..., n), or a `Mean`.

    Leading axes are those of stacked scenarios.
    """
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


def _is_of_shape(how: Measured) -> bool:
    """Whether a kept limit is one on the shape of the cam."""
    return (
        how.kept is not None
        and not how.kept.once
        and (how.kept.unloaded or how.reduce in ("contour", "top"))
    )


def is_constraint(declared: Declaration) -> bool:
    """Whether a check is a constraint of its own; of a group one is with each kind of follower.

    Of those at maximum lift that of the spring travel is, which `travel_limits` bounds.
    """
    kept = None if declared.measured is None else declared.measured.kept
    if kept is None or declared.measured is None:
        return False
    if kept.group:
        return declared.id == kept.group or bool(kept.needs)
    return bool(kept.unit) or declared.measured.reduce != "top"


_KEPT = tuple(filter(is_constraint, CHECKS))
SHAPE: tuple[Constraint[LoadedCam], ...] = tuple(
    kept(each) for each in _KEPT if each.measured and _is_of_shape(each.measured)
)
"""Limits on the shape of the cam."""
LOADS: tuple[Constraint[ScenarioCam], ...] = (
    *(kept_loads(each) for each in _KEPT if each.measured and not _is_of_shape(each.measured)),
    *PARTS,
)
"""Limits on the loads of the cam in one scenario."""

CONSTRAINTS: tuple[Constraint[LoadedCam] | Constraint[ScenarioCam], ...] = (*SHAPE, *LOADS)
