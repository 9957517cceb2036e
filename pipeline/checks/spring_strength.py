"""Limits of the spring as it is wound: left out (None) in a look ahead."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camwright.pipeline.checks.check import Check, Sense, not_described
from camwright.pipeline.checks.extremes import TrialEvidence, cited, worst_case
from camwright.pipeline.follower.spring import HelicalSpring, case_spring, surge_harmonics

if TYPE_CHECKING:
    from camwright.pipeline.case.case import Case

RATE_TOLERANCE = 0.05  # of the rate, where the case gives none
NOT_WOUND = "no wire, diameter and coils of the spring are given"


class Work(NamedTuple):
    """Of the hardest spring the tolerances let through: N, N, and m of travel."""

    preload: float
    greatest: float
    travel: float


Measure = Callable[[HelicalSpring, Work], float]


def spring_stress(evidence: TrialEvidence) -> Check | None:
    """Shear stress at full lift against the wire's static strength."""
    return _check(
        evidence,
        id="spring_stress",
        title="Shear stress of the spring over its strength",
        measure=lambda spring, work: spring.static_use(work.greatest),
        limit=1.0,
        source="0.56 R_m, EN 13906-1: verify",
        method="Wahl's factor, force at full lift",
    )


def spring_fatigue(evidence: TrialEvidence) -> Check | None:
    """Safety against fatigue of the wire."""
    return _check(
        evidence,
        id="spring_fatigue",
        title="Fatigue safety of the spring",
        measure=lambda spring, work: spring.fatigue_safety(work.preload, work.greatest),
        limit=evidence.case.limits.spring_fatigue,
        sense="at_least",
        settable=True,
        source="Goodman through Zimmerli's point, infinite life, Shigley ch. 10",
        method="Wahl's factor, preload to force at full lift",
    )


def spring_solid(evidence: TrialEvidence) -> Check | None:
    """Way left to the solid length; negative when the spring goes solid."""
    return _check(
        evidence,
        id="spring_solid",
        title="Clearance of the spring to solid",
        measure=lambda spring, work: spring.solid_clearance(work.preload, work.travel),
        limit=evidence.case.limits.spring_solid,
        sense="at_least",
        settable=True,
        source="10 to 15 % of the greatest working deflection, Shigley ch. 10",
        method="free length less solid length less deflection at full lift, over that deflection",
    )


def spring_buckling(evidence: TrialEvidence) -> Check | None:
    """Free length against that which stays straight."""
    return _check(
        evidence,
        id="spring_buckling",
        title="Free length of the spring over the straight one",
        measure=lambda spring, _: spring.buckling_use,
        limit=1.0,
        source="L0 < 2.63 D over the end factor, Shigley ch. 10",
        method="closed form",
        lift_can_help=False,
    )


def spring_rate(evidence: TrialEvidence) -> Check | None:
    """Whether wire and coils give the rate the case asks for."""
    asked = evidence.case.spring.rate
    tolerance = evidence.case.spring.rate_tolerance or RATE_TOLERANCE
    return _check(
        evidence,
        id="spring_rate",
        title="Miss of the spring's rate",
        measure=lambda spring, _: abs(spring.rate / asked - 1.0),
        limit=tolerance,
        source="tolerance of the rate in the case, else 5 %",
        method="G d^4/(8 D^3 n) against spring.rate",
        lift_can_help=False,
    )


def spring_surge(evidence: TrialEvidence) -> Check | None:
    """First natural frequency of the spring over the cam's turning."""
    parts = evidence.parts
    if parts is None:
        return None
    spring = case_spring(evidence.case)
    if spring is None:
        title = "Surge frequency over that of the cam"
        return not_described("spring_surge", title, "-", NOT_WOUND, must_have=False)
    fundamental = spring.surge_frequency

    def ratio(speed: float) -> tuple[int, float, float]:
        return surge_harmonics(evidence.contour.pitch.lift.values, speed, fundamental)

    worst = worst_case(evidence, lambda c: ratio(evidence.cam_speed(c))[1], at_least=True)
    highest, _, margin = ratio(max(evidence.cam_speed(cycle) for cycle in evidence.cycles))
    surges = [each.surge_force for each in parts.values()]
    adds = max((float(np.abs(surge).max()) for surge in surges if surge is not None), default=0.0)
    return Check(
        id="spring_surge",
        title="Surge frequency over that of the cam",
        demand=worst.value,
        limit=evidence.case.limits.spring_surge,
        unit="-",
        sense="at_least",
        source=evidence.source(
            "spring_surge", "13 to 20 times the cam's frequency, Norton (2009), Shigley ch. 10"
        ),
        method="sqrt(k/m)/2 of the active coils; modes driven by the harmonics of the lift",
        must_have=False,
        note=f"highest harmonic of at least 1 % of the acceleration: {highest};"
        f" surge stands {margin:.2f} times above it and adds up to {adds:.3g} N",
        **worst.place,
    )


def _check(
    evidence: TrialEvidence,
    *,
    id: str,  # noqa: A002 - as Check has it
    title: str,
    measure: Measure,
    limit: float | None,
    source: str,
    method: str,
    sense: Sense = "at_most",
    settable: bool = False,
    lift_can_help: bool = True,
) -> Check | None:
    """The check of a spring's measure; `settable`: its limit is the case's, under the same id."""
    if evidence.parts is None:
        return None
    case = evidence.case
    spring, design = case_spring(case), case.spring.design
    if spring is None or design is None:
        return not_described(id, title, "-", NOT_WOUND, must_have=True)
    travel = evidence.contour.pitch.lift.highest.value
    preload = max(evidence.preload(cycle) for cycle in evidence.cycles)
    demand = measure(spring, hardest_work(case, spring, preload, travel))
    toleranced = case.spring.preload_tolerance > 0 or case.spring.rate_tolerance > 0
    return Check(
        id=id,
        title=title,
        demand=demand,
        limit=limit,
        unit="-",
        sense=sense,
        source=evidence.source(id, source, design.source)
        if settable
        else cited(source, design.source),
        method=method,
        corner="preload and rate high" if toleranced else "",
        corner_demand=demand if toleranced else None,
        lift_can_help=lift_can_help,
    )


def hardest_work(case: Case, spring: HelicalSpring, preload: float, travel: float) -> Work:
    """What the hardest spring within its tolerances does over a travel, m, from a preload, N."""
    hard = preload * (1.0 + case.spring.preload_tolerance)
    rate = spring.rate * (1.0 + case.spring.rate_tolerance)
    return Work(hard, hard + rate * travel, travel)


CHECKS = (
    spring_stress,
    spring_fatigue,
    spring_solid,
    spring_buckling,
    spring_rate,
    spring_surge,
)
