"""Demand and limit of the checks of wound, gas and torsion springs, of many designs at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.base.units import celsius
from camwright.pipeline.case.case_values import WoundSprings
from camwright.pipeline.case.limits import (
    SPRING_FATIGUE,
    SPRING_SOLID,
    SPRING_SURGE,
)
from camwright.pipeline.checks.spring_strength import (
    PRELOAD_TOLERANCE,
    RATE_TOLERANCE,
    Work,
    gas_pressure_at,
    hardest_work,
    torsion_stress_at,
)
from camwright.pipeline.follower.spring_kinds import GasSpring, TorsionSpring
from camwright.pipeline.screening.design_arrays import Designs, Judged


def of_spring(
    judged: Callable[[Designs, WoundSprings, Work[Array]], Judged],
) -> Callable[[Designs], Judged | None]:
    """Of the hardest spring in tolerance of each design."""

    def of_designs(designs: Designs) -> Judged | None:
        wound = designs.wound_spring
        if wound is None:
            return None
        preload = np.max([cam.state.preload[:, 0] for cam in designs.cams], axis=0)
        work = hardest_work(designs.case.spring, wound, preload, designs.highest)
        return judged(designs, wound, work)

    return of_designs


def spring_stress(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.stress(work.greatest) / design.static_strength, 1.0


def spring_fatigue(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return 1.0 / design.fatigue_use(work.preload, work.greatest), designs.limit(SPRING_FATIGUE)


def spring_solid(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.solid_clearance(work.preload, work.travel), designs.limit(SPRING_SOLID)


def spring_coil_gap(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.gap_left(work.preload, work.travel), design.minimum_gaps


def spring_solid_stress(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return design.solid_stress(work.rate), design.static_strength


def spring_buckling(_: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    return (design.deflection(work.preload) + work.travel) / design.buckling_deflection, 1.0


def spring_rate(designs: Designs, design: WoundSprings, _: Work[Array]) -> Judged:
    rate = designs.value("spring.rate")[:, 0]
    return np.abs(design.rate / rate - 1.0), designs.case.spring.rate_tolerance or RATE_TOLERANCE


def spring_relaxation(designs: Designs, design: WoundSprings, work: Work[Array]) -> Judged:
    lost = design.relaxed_preload(work.preload, work.greatest)
    allowed = designs.case.spring.preload_tolerance or PRELOAD_TOLERANCE
    return np.full(designs.count, np.nan) if lost is None else np.asarray(lost), allowed


def spring_surge(designs: Designs, design: WoundSprings, _: Work[Array]) -> Judged:
    turns_per_second = designs.fastest / designs.case.mechanism.gear_ratio / FULL_TURN
    return design.surge_frequency / turns_per_second, designs.limit(SPRING_SURGE)


def of_gas(
    demand: Callable[[Designs, GasSpring], Array], allowed: str
) -> Callable[[Designs], Judged | None]:
    """Of a gas spring, against the limit of its maker."""

    def of_designs(designs: Designs) -> Judged | None:
        gas = designs.case.spring.gas
        if gas is None:
            return None
        return demand(designs, gas), getattr(gas, allowed)

    return of_designs


def gas_pressure(designs: Designs, gas: GasSpring) -> Array:
    return gas_pressure_at(designs.case.spring, gas, designs.highest)


def gas_speed(designs: Designs, _: GasSpring) -> Array:
    return designs.worst(lambda cam: np.abs(cam.velocity))


def gas_temperature(designs: Designs) -> Judged | None:
    gas = designs.case.spring.gas
    if gas is None:
        return None
    warm, limit = (
        None if each is None else celsius(each) for each in (gas.temperature, gas.temperature_limit)
    )
    return np.full(designs.count, np.nan if warm is None else warm), limit


def of_torsion(
    demand: Callable[[Array, Array], Array], allowed: Callable[[TorsionSpring], float | None]
) -> Callable[[Designs], Judged | None]:
    """Of the bending stress of a torsion spring at zero and maximum lift."""

    def of_designs(designs: Designs) -> Judged | None:
        spring = designs.case.spring
        if spring.torsion is None:
            return None
        stress = torsion_stress_at(spring, spring.torsion, designs.highest)
        figure = np.full(designs.count, np.nan) if stress is None else demand(*stress)
        return figure, allowed(spring.torsion)

    return of_designs
