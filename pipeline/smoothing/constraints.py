"""Constraints of a synthesis: differentiable utilisation of each limit by cam angle.

The demands are those of the checks, by the same functions of complex numbers: a complex step gives
the derivative to round-off. A constraint is met at a utilisation of at most 1. Where a demand must
be at least its limit, the utilisation is 1 plus the shortfall, which is smooth where the quotient
of limit and demand is not.

The limits are those of the checks that are declared as kept, and of those of `part_constraints`.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.smoothing.cam_state import (
    INAPPLICABLE_USE,
    Constraint,
    Mean,
    ScenarioCam,
    State,
    kept,
    kept_loads,
    kept_strokes,
    loaded,
    second_disc,
    unloaded,
)
from camwright.pipeline.smoothing.part_constraints import PARTS
from camwright.pipeline.smoothing.scenario import DesignVariables, Ratings, Scenario


def shape_utilisations(
    jet: Jet,
    variables: DesignVariables,
    ratings: Ratings,
    names: Container[str] | None = None,
    highest: float = np.nan,
) -> Mapping[str, Array | Mean]:
    """Utilisations (n,) of the limits on the cam's shape, or of those named, by check; of two discs
    (2, n) of those on a contour. highest: maximum lift, m, by which a second disc follows.
    """
    first = unloaded(jet, variables, ratings)
    uses = dict(_utilisations(SHAPE, first, ratings, names))
    if (other := second_disc(first, highest)) is None:
        return uses
    for name, use in _utilisations(_OF_DISCS, other, ratings, names).items():
        both = uses.get(name, INAPPLICABLE_USE), use
        uses[name] = np.stack(np.broadcast_arrays(*both))  # type: ignore[arg-type]
    return uses


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
    """Cam torque F_a s' (n,), N m, with friction, inertia and sliding of a face."""
    return loaded(jet, highest, variables, ratings, scenario).torque


def _utilisations(
    constraints: tuple[Constraint[State], ...],
    state: State,
    ratings: Ratings,
    names: Container[str] | None,
) -> Mapping[str, Array | Mean]:
    """Utilisations of the constraints that the ratings limit, by name: (..., n) at the cam angles,
    or a mean over the turn.

    A constraint that does not apply to the cam is left out.

    Parameters
    ----------
    constraints : tuple         functions of the cam and of their limit, SI
    state : State               cam, unloaded or in a scenario
    ratings : Ratings           with the limits
    names : container or None   constraints to evaluate; None: all
    """
    uses: dict[str, Array | Mean] = {}
    for each in constraints:
        if names is not None and each.name not in names:
            continue
        limit = each.value(ratings)
        use = None if limit is None else each.utilisation(state, limit)
        if use is not None:
            uses[each.name] = use
    return uses


def constraints_of(
    checks: Iterable[Declaration],
) -> tuple[tuple[Constraint[LoadedCam], ...], tuple[Constraint[ScenarioCam], ...]]:
    """Constraints on the unloaded shape, then those on the loads, from the checks declared as kept.

    Of a group one constraint for each kind of follower; of the checks at maximum lift that of the
    spring travel alone, whose bound is the least of `travel_limits`.
    """
    shape: list[Constraint[LoadedCam]] = []
    loads: list[Constraint[ScenarioCam]] = []
    for each in checks:
        how = each.measured
        if how is None or how.kept is None:
            continue
        rule, at_top = how.kept, how.reduce == "top"
        if (rule.group not in ("", each.id) and not rule.needs) or (at_top and not rule.unit):
            continue
        if at_top or rule.unloaded or (how.reduce == "contour" and not rule.once):
            shape += kept(each), *kept_strokes(each)
        else:
            loads.append(kept_loads(each))
    return tuple(shape), tuple(loads)


SHAPE, _MEASURED = constraints_of(CHECKS)
"""Limits on the shape of the cam."""
_OF_DISCS = tuple(each for each in SHAPE if each.discs)
LOADS: tuple[Constraint[ScenarioCam], ...] = (*_MEASURED, *PARTS)
"""Limits on the loads of the cam in one scenario."""

CONSTRAINTS: tuple[Constraint[LoadedCam] | Constraint[ScenarioCam], ...] = (*SHAPE, *LOADS)


def check_of(name: str) -> str:
    """Id of the check whose limit has a given name in a synthesis."""
    return next((each.check for each in CONSTRAINTS if each.name == name), name)
