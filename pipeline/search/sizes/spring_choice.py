"""Spring rate and preload of an open case: contact at all speeds and tolerances."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.lift_parts import LiftParts
from camwright.pipeline.base.rounding import to_digits
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.external_load import external_force
from camwright.pipeline.case.limits import CONTACT_FORCE_MARGIN, JUMP_SPEED, SPRING_SURGE
from camwright.pipeline.case.machine import machines
from camwright.pipeline.cycle.speed_sweep import highest_speed
from camwright.pipeline.follower.spring import greatest_active_mass
from camwright.pipeline.search.sizes.open_case import PRELOAD, RATE
from camwright.pipeline.search.sizes.spring_size import (
    PRELOAD_SHARE,
    HoldingCondition,
    SpringSize,
    least_rate,
    preload_needed,
    smallest_spring,
)

_SPRING_DIGITS = 4
"""Significant digits of a sized rate or preload."""


def conditions_of(case: Case) -> tuple[HoldingCondition, ...]:
    """Contact conditions of the follower at the worst ends of the tolerances.

    No jump up to `limits.jump_speed` times the greatest speed, and the share
    `limits.contact_force_margin` of the preload left at that speed.
    """
    states, spring = machines(case), case.spring
    speed = highest_speed(states) / case.mechanism.gear_ratio
    mass, spread, gravity = (
        case.follower.mass, case.tolerances.mass, states[0].system.gravity_along_axis
    )  # fmt: skip
    worst = {
        "damping": case.follower.viscous_damping,
        "rate_factor": 1.0 - spring.rate_tolerance,
        "preload_factor": 1.0 - spring.preload_tolerance,
    }
    margin = case.limits[CONTACT_FORCE_MARGIN]
    ways = ({"cam_speed": case.limits[JUMP_SPEED] * speed}, {"cam_speed": speed, "share": margin})
    # a heavier follower is thrown off more, and weighs more: its inertia and weight are of one mass
    return tuple(
        HoldingCondition(mass=each, held=each * gravity, **way, **worst)
        for each in (mass * (1.0 - spread), mass * (1.0 + spread))
        for way in ways
    )


class ChosenSpring(NamedTuple):
    """Rate, N/m, and preload, N, each with its reason in words."""

    rate: float
    preload: float
    rate_by: str = ""
    preload_by: str = ""

    @property
    def size(self) -> SpringSize:
        """Rate and preload alone."""
        return SpringSize(self.rate, self.preload)


def spring_of(
    case: Case, gaps: Sequence[str], lift: LiftParts, stiff: ChosenSpring | None = None
) -> ChosenSpring:
    """Spring for the open keys of a case: of least energy at full lift, or of least preload or
    rate.

    What is stated stays: the preload is the least one that holds the follower beside a stated rate,
    or the rate beside a stated preload. The rate of a spring with a design is that of the design.

    Parameters
    ----------
    case : Case            with speeds, masses and tolerances
    gaps : sequence        its open keys
    lift : LiftParts       of the follower
    stiff : ChosenSpring   whose rate is taken, the preload being sought; None: no rate is imposed

    Raises
    ------
    InputError
        If nothing throws the follower off the cam and neither rate nor preload is stated; if a
        stated preload holds it at no rate.
    """
    design, rate, rate_by = case.spring.design, case.spring.rate, ""
    conditions, force = conditions_of(case), external_force(case)
    lift = lift.finer(force.spacing)
    if stiff is not None:
        rate, rate_by = stiff.rate, stiff.rate_by
    elif RATE in gaps and design is not None:
        rate, rate_by = _nearest(design.rate), "rate of spring.design"
    elif RATE in gaps and PRELOAD not in gaps:
        preload = case.spring.preload
        rate = to_digits(least_rate(lift, preload, conditions, force), _SPRING_DIGITS)
        rate_by = "no follower jump over the speed range at the stated preload"
        if rate == 0.0:
            rate = _nearest(preload / lift.stroke)
            rate_by = "least energy at full lift; the stated preload alone holds the follower"
    elif RATE in gaps:
        rate = _nearest(smallest_spring(lift, conditions, force=force).rate)
        rate_by = "least energy of the spring at full lift without follower jump"
    if PRELOAD not in gaps:
        return ChosenSpring(rate, case.spring.preload, rate_by)
    spring = smallest_spring(lift, conditions, rate=rate, force=force)
    needed = preload_needed(lift, rate, conditions, force).value
    # A rule of thumb beside an open rate, or where the rate alone holds the follower.
    if spring.preload > needed and ((RATE in gaps and design is None) or not needed > 0.0):
        preload_by = f"share of {PRELOAD_SHARE:g} of the force at full lift"
        if not needed > 0.0:
            preload_by += "; the rate alone holds the follower"
        return ChosenSpring(rate, to_digits(spring.preload, _SPRING_DIGITS), rate_by, preload_by)
    preload_by = "no follower jump over the speed range"
    return ChosenSpring(rate, to_digits(needed, _SPRING_DIGITS), rate_by, preload_by)


def more_preload(spring: ChosenSpring, factor: float, reason: str) -> ChosenSpring:
    """Spring with its preload multiplied by `factor` and rounded up; reason in words."""
    preload = to_digits(factor * spring.preload, _SPRING_DIGITS)
    return spring._replace(preload=preload, preload_by=reason)


def stiffer(spring: ChosenSpring, factor: float, reason: str) -> ChosenSpring:
    """Spring with its rate multiplied by `factor` and rounded up; reason in words."""
    rate = to_digits(factor * spring.rate, _SPRING_DIGITS)
    return spring._replace(rate=rate, rate_by=reason)


def _nearest(value: float) -> float:
    return float(f"{value:.{_SPRING_DIGITS}g}")


def greatest_coil_mass(case: Case, rate: float) -> float:
    """Mass of the active coils, kg, at the limit of the surge frequency.

    f1 = sqrt(k/m)/2 at `limits.spring_surge` times the greatest frequency of the cam.
    """
    cam = highest_speed(machines(case)) / case.mechanism.gear_ratio / FULL_TURN
    return greatest_active_mass(rate, case.limits[SPRING_SURGE] * cam)
