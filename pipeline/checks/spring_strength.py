"""Checks of the spring design: strength, fatigue, solid length, buckling, surge."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    SPRING_FATIGUE,
    SPRING_SOLID,
    SPRING_SURGE,
    Limit,
)
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.checks.extremes import worst_case
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.spring import HelicalSpring, Spring, surge_harmonics

NOT_WOUND = "no wire, diameter and coils of the spring are given"
RATE_TOLERANCE = 0.05  # of the rate, where the case has none
HARDEST = "preload and rate high"


class Work(NamedTuple):
    """Working range of the hardest spring in tolerance: preload, maximum force, N; travel, m."""

    preload: float
    greatest: float
    travel: float


Measure = Callable[[HelicalSpring, Work], float]


def hardest_work(spring: Spring, design: HelicalSpring, preload: float, travel: float) -> Work:
    """Working range of the hardest spring in tolerance.

    Parameters
    ----------
    preload : float   greatest of the load cases, N
    travel : float    maximum lift, m
    """
    hard = preload * (1.0 + spring.preload_tolerance)
    rate = design.rate * (1.0 + spring.rate_tolerance)
    return Work(hard, hard + rate * travel, travel)


def _wound(
    name: str,
    measure: Measure,
    *,
    title: str,
    method: str,
    limit: Limit | None = None,
    source: str = "",
    lift_can_help: bool = True,
) -> Declaration:
    """Check of the spring design at the upper ends of its tolerances."""

    @check(
        limit,
        id=name,
        title=title,
        unit="-",
        method=method,
        source=source,
        lift_can_help=lift_can_help,
        moved_by_tolerance=False,
    )
    def demand(solution: Solution) -> Demand:
        spring = solution.machine.spring
        design = spring.design
        if design is None:
            return Demand(None, None, note=NOT_WOUND)
        preload = max(machine.spring.preload for machine in solution.machines)
        travel = solution.contour.pitch.lift.highest.value
        bound = 1.0 if limit is None else solution.machine.limits[limit]
        value = measure(design, hardest_work(spring, design, preload, travel))
        return Demand(value, bound, figures=(design.source,), corner=_corner(spring))

    return demand


def _corner(spring: Spring) -> str:
    toleranced = spring.preload_tolerance > 0 or spring.rate_tolerance > 0
    return HARDEST if toleranced else ""


spring_stress = _wound(
    "spring_stress",
    lambda design, work: design.static_use(work.greatest),
    title="Spring shear stress / static strength",
    source="0.56 R_m, EN 13906-1: verify",
    method="Wahl factor, force at maximum lift",
)
spring_fatigue = _wound(
    "spring_fatigue",
    lambda design, work: design.fatigue_safety(work.preload, work.greatest),
    title="Fatigue safety factor of the spring",
    limit=SPRING_FATIGUE,
    method="Wahl factor, from preload to force at maximum lift",
)
spring_solid = _wound(
    "spring_solid",
    lambda design, work: design.solid_clearance(work.preload, work.travel),
    title="Spring solid-height clearance",
    limit=SPRING_SOLID,
    method="free length less solid length less deflection at maximum lift, over that deflection",
)
spring_buckling = _wound(
    "spring_buckling",
    lambda design, _: design.buckling_use,
    title="Spring free length / buckling length",
    source="L0 < 2.63 D over the end factor, Shigley ch. 10",
    method="free length over 2.63 D / end factor",
    lift_can_help=False,
)


@check(
    title="Deviation of the spring design from the spring rate",
    unit="-",
    source="tolerance of the rate in the case, else 5 %",
    method="G d^4/(8 D^3 n) of the spring design against spring.rate",
    moved_by_tolerance=False,
)
def spring_rate(solution: Solution) -> Demand:
    """Deviation of the rate of the spring design from that of the case, relative."""
    spring = solution.machine.spring
    if spring.design is None:
        return Demand(None, None, note=NOT_WOUND)
    allowed = spring.rate_tolerance or RATE_TOLERANCE
    error = abs(spring.design.rate / spring.rate - 1.0)
    figures, corner = (spring.design.source,), _corner(spring)
    return Demand(error, allowed, figures=figures, corner=corner)


@check(
    SPRING_SURGE,
    title="Spring surge frequency / cam frequency",
    method="sqrt(k/m)/2 of the active coils; modes driven by the harmonics of the lift",
    must_have=False,
    moved_by_tolerance=False,
)
def spring_surge(solution: Solution) -> Demand:
    """First natural frequency of the spring over the cam frequency."""
    design = solution.machine.spring.design
    if design is None:
        return Demand(None, None, note=NOT_WOUND)
    lift, fundamental = solution.contour.pitch.lift.values, design.surge_frequency

    def ratio(cycle: Cycle) -> float:
        return surge_harmonics(lift, cycle.cam_speed, fundamental)[1]

    worst = worst_case(solution.cycles, ratio, at_least=True)
    fastest = max(machine.cam_speed for machine in solution.machines)
    highest, _, margin = surge_harmonics(lift, fastest, fundamental)
    surges = [cycle.parts.surge_force for cycle in solution.cycles]
    added = max((float(np.abs(each).max()) for each in surges if each is not None), default=0.0)
    return Demand(
        worst.value,
        solution.machine.limits[SPRING_SURGE],
        worst,
        note=f"highest harmonic of at least 1 % of the acceleration: {highest}; surge lies"
        f" {margin:.2f} times above it and adds up to {shown(added, 'N', 3)}",
    )
