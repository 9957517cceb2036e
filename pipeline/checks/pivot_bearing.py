"""Checks of the pivot of an arm: self-locking by its friction, rating of its needle bearing.

Those of its bush are of `guide_strength` and `guide_wear`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.pipeline.base import levers
from camwright.pipeline.case.limits import JAM_INDEX, PIVOT_LIFE, PIVOT_STATIC_SAFETY
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    BY_DUTY,
    FACTOR_MAX,
    LASTING,
    STATED,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.demands import rating_over
from camwright.pipeline.checks.extremes import cam_of, row_of
from camwright.pipeline.checks.guide_strength import ARM_LENGTH, TILTED
from camwright.pipeline.checks.jump_and_jamming import outward
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.roller_motion import RATED_REVOLUTIONS, wear

_NEEDLES = "follower.pivot.needle_bearing"
_RATING, _STATIC = f"{_NEEDLES}.C", f"{_NEEDLES}.C0"
_EXPONENT = 10.0 / 3.0
"""Of the load in the rating life of line contacts, ISO 281:2007, 7.2."""
_FRICTION = {"mu": STATED, "d": f"{STATED} [mm]", "l": ARM_LENGTH}
_LOCKING = "at 1 the arm locks on the rise and the cam or the arm breaks."


def _has_needles(_: Value, numbers: Numbers) -> NDArray[np.bool_]:
    """Whether the pivot has a needle bearing."""
    return np.array(numbers.get(f"{_NEEDLES}.length") is not None)


def _with_pin(demand: Demand, solution: Solution) -> Demand:
    """With friction and diameter of the pivot."""
    machine = solution.machine
    diameter = np.nan if machine.pivot is None else machine.pivot.bearing.diameter
    return replace(demand, stated={"mu": machine.friction.nominal[0], "d": diameter})


def _at_greatest_friction(demand: Demand, solution: Solution) -> Demand:
    """Demand with friction and diameter of the pivot, and the forces at its angle."""
    demand = _with_pin(demand, solution)
    if demand.at is None or not demand.at.load_case:
        return demand
    cycle, k = row_of(solution.cycles, demand.at)
    loads, mu = cycle.parts.friction.greatest, cycle.machine.friction.greatest[0]
    pushes = np.hypot(*loads.pivot_load[:, k]) * cam_of(solution, cycle).bush_rubbing[k]
    forces = {"R": float(pushes), "F_a": float(loads.axial_force[k])}
    return replace(demand, stated={**demand.stated, "mu": mu, **forces})


def _friction_kept(cam: LoadedCam, limit: float) -> Array | None:
    """Jam index over its limit; no constraint of a stem, whose guides have that limit, too."""
    if cam.pivot is None:
        return None
    return outward(cam, np.asarray(cam.jam * cam.bush_rubbing)) / limit


@check(
    JAM_INDEX,
    title="Maximum jam index of the pivot",
    method="greatest moment of the friction in the pivot over that of the axial cam force about it"
    f" on the rise{TILTED}; an axial force below 1 N counts as 1 N",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="pivot",
    formula="max(mu d R/(2 l F_a)) <= j on the rise; mu: nominal friction of the pivot, d: diameter"
    " of its pin, R: pushes on both sides of its bush, or load of its needles, l: length of the"
    " arm, F_a: axial force of the cam, j: limits.jam_index.",
    symbols=_FRICTION | {"R": "pivot_rubbing_load", "F_a": "axial_force"},
    reason=_LOCKING,
    rests_on="contact",
    values=given.LOADS,
    levers=levers.LOCK,
    closed_by="force",
    page="Pivot",
).measured(
    "angles", remark=_with_pin, deviation=0.01, kept=Kept(_friction_kept, factor_max=FACTOR_MAX)
)
def pivot_jam_index(cam: LoadedCam) -> Array:
    """Moment of the friction in the pivot over that of the cam on the rise."""
    return outward(cam, np.asarray(cam.jam * cam.bush_rubbing))


def _worst_friction_kept(cam: LoadedCam, limit: float) -> Array | None:
    """No constraint of a stem, and where the maximum friction is not known."""
    worst = cam.jam_worst
    if cam.pivot is None or worst is None:
        return None
    return outward(cam, np.asarray(worst * cam.bush_rubbing)) / limit


@check(
    JAM_INDEX,
    title="Maximum jam index of the pivot at maximum friction",
    method="greatest moment of the friction in the pivot over that of the axial cam force about it"
    f" on the rise, at its maximum friction{TILTED}; an axial force below 1 N counts as 1 N",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="pivot",
    formula="max(mu d R/(2 l F_a)) <= j on the rise; mu: friction_max of the pivot or its friction"
    " with the tolerance, d: diameter of its pin, R: pushes on both sides of its bush, or load of"
    " its needles, and F_a: axial force of the cam, both under it, l: length of the arm, j:"
    " limits.jam_index.",
    symbols=_FRICTION | {"R": f"{STATED} [N]", "F_a": f"{STATED} [N]"},
    reason=_LOCKING,
    rests_on="contact",
    values=given.LOADS,
    levers=levers.LOCK,
    closed_by="force",
    page="Pivot",
).measured("angles", remark=_at_greatest_friction, deviation=0.01, kept=Kept(_worst_friction_kept))
def pivot_jam_index_friction_max(cam: LoadedCam) -> Array:
    """Jam index of the pivot at its maximum friction."""
    worst = cam.jam_worst
    if worst is None:
        return np.full_like(cam.jam, np.nan)
    return outward(cam, np.asarray(worst * cam.bush_rubbing))


def _with_maker(demand: Demand, solution: Solution) -> Demand:
    pivot = solution.machine.pivot
    return replace(demand, figures=() if pivot is None else (pivot.bearing.source,))


@check(
    PIVOT_STATIC_SAFETY,
    title="Static safety factor of the pivot's needle bearing",
    method="static rating over the greatest load of the pivot",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="pivot",
    kept_as="static load rating of the pivot",
    formula="C0/R >= S; C0: static rating, R: greatest load of the pivot over all load cases and"
    " angles, S: limits.pivot_static_safety",
    symbols={"C0": _STATIC, "R": "pivot_load"},
    reason="beyond it the needles dent the raceways",
    values=(*given.LOADS, _STATIC),
    levers=(levers.one(_STATIC), *levers.SHAPE),
    page="Pivot",
).measured(
    "angles",
    value=lambda worst, numbers: rating_over(numbers[_STATIC], worst, np.nan),
    bound=lambda limit, numbers: float(numbers[_STATIC]) / limit,
    needed=(_STATIC,),
    applies=_has_needles,
    remark=_with_maker,
    deviation=0.02,
    kept=Kept(unit="N"),
)
def pivot_static(cam: LoadedCam) -> Array:
    """Load of the pivot, N."""
    return cam.pivot_load


def _life(worst: Value, numbers: Numbers) -> Value:
    """L10 (...), s, of a mean R^(10/3) |n|."""
    return rating_over(_rated(numbers), worst, np.inf)


def _rated(numbers: Numbers) -> Value:
    """C^(10/3) million turns, N^(10/3) rad."""
    return numbers[_RATING] ** _EXPONENT * (RATED_REVOLUTIONS * FULL_TURN)


@check(
    PIVOT_LIFE,
    title="L10 rating life of the pivot's needle bearing",
    method="(C/P_m)^(10/3) million turns of the path that the arm swings, P_m the mean of the load"
    " of the pivot over that path to the power 10/3",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="pivot",
    kept_as="dynamic load rating of the pivot",
    formula="(C/P_m)^(10/3) 10^6/n >= L; C: dynamic rating, P_m: mean of the load of the pivot over"
    " the angle that the arm swings, to the power 10/3, n: that angle over a full turn per time, by"
    " which an oscillation of the swing b between its ends counts as b/180 deg of a turn, L:"
    f" limits.pivot_life. Over the load cases {BY_DUTY}.",
    symbols={
        "C": _RATING,
        "P_m": "(mean(pivot_load^(10/3) |follower_velocity|)/mean(|follower_velocity|))^0.3 [N]",
        "n": f"mean(|follower_velocity|)/(2 pi {ARM_LENGTH}) [1/s]",
    },
    reason="the bearing has to last; a swing below the pitch of the needles, which loads a part of"
    " the raceway alone and starves it of grease, is not judged",
    load_cases=LASTING,
    values=(*given.LOADS, _RATING),
    levers=(levers.one(_RATING), *levers.SHAPE),
    page="Pivot",
).measured(
    "life",
    value=_life,
    bound=lambda limit, numbers: float(_rated(numbers)) / limit,
    needed=(_RATING,),
    applies=_has_needles,
    remark=_with_maker,
    deviation=0.05,
    kept=Kept(power=1.0 / _EXPONENT, unit="N"),
)
def pivot_life(cam: LoadedCam) -> Array:
    """R^(10/3) |n|, N^(10/3) rad/s."""
    swung = cam.velocity / cam.numbers[ARM_LENGTH]
    return wear(cam.pivot_load, np.asarray(swung), _EXPONENT)
