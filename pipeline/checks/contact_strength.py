"""Checks of the contact pressure: endurance, yield, shakedown."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from camwright.geometry.arrays import FULL_TURN
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    CONTACT_SAFETY,
    EDGE_FACTOR,
    SHAKEDOWN_SAFETY,
    TARGET_LIFE,
    YIELD_SAFETY,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import Extreme, greatest
from camwright.pipeline.contact import hertz
from camwright.pipeline.cycle.solution import Solution

PSI = 6894.757293168  # Pa
SHAKEDOWN = 4.0  # p0 / k, free rolling line contact
FIRST_YIELD = 1.79  # p0 / Y, von Mises, line contact, nu = 0.3


def peak_pressure(solution: Solution) -> Extreme:
    """Maximum contact pressure over the turn, Pa."""
    return greatest(solution.cycles, lambda cycle: cycle.contact.p0)


def pressure_allowables(machine: Machine, turns: float) -> dict[str, float]:
    """Allowable contact pressure by check, Pa; checks without data are left out.

    Parameters
    ----------
    turns : float   cam turns of the target life at the fastest load case
    """
    limits, follower, softer = machine.limits, machine.follower, machine.softer
    shear_yield = softer.yield_strength / math.sqrt(3.0) / limits[SHAKEDOWN_SAFETY]
    allowed = {"shakedown": SHAKEDOWN * shear_yield}
    if follower.friction is not None:
        allowed["shakedown_traction"] = shakedown_factor(follower.friction) * shear_yield
    if softer.endurance_pressure is not None:
        endurance = softer.endurance_pressure / limits[CONTACT_SAFETY]
        allowed["contact_pressure"] = endurance
        allowed["edge_pressure"] = endurance / applied_edge_factor(machine)
    card = machine.cam.material
    slope, intercept = card.endurance_slope, card.endurance_intercept
    if limits[TARGET_LIFE] is not None and slope is not None and intercept is not None:
        at_life = pressure_at_life(turns, slope, intercept, machine.contact_modulus)
        allowed["contact_pressure_at_life"] = at_life / limits[CONTACT_SAFETY]
    return allowed


def applied_edge_factor(machine: Machine) -> float:
    """Edge factor on the plane-strain pressure; 1 for a crowned follower."""
    return 1.0 if machine.follower.crowned else machine.limits[EDGE_FACTOR]


def life_turns(machines: tuple[Machine, ...]) -> float:
    """Cam turns in the target life at the fastest load case; 0 without a target life."""
    life = machines[0].limits[TARGET_LIFE] or 0.0
    return life * max(machine.cam_speed for machine in machines) / FULL_TURN


def _allowed(solution: Solution, name: str) -> float | None:
    turns = life_turns(solution.machines)
    return pressure_allowables(solution.machine, turns).get(name)


@check(
    CONTACT_SAFETY,
    id="contact_pressure",
    title="Peak contact pressure vs. endurance limit",
    unit="MPa",
    sense="at_most",
    method="greatest contact pressure over the turn; endurance of the softer body",
    lift_can_help=True,
    forecast=True,
    error="contact",
)
def contact_pressure(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against the endurance of the softer body."""
    worst, softer = peak_pressure(solution), solution.machine.softer
    allowed = _allowed(solution, "contact_pressure")
    return Demand(
        worst.value,
        allowed,
        worst,
        note="" if allowed is not None else _no_endurance(solution),
        figures=(f"{softer.name}: {softer.source}",),
    )


@check(
    YIELD_SAFETY,
    id="first_yield",
    title="Subsurface von Mises stress vs. yield strength",
    unit="MPa",
    method="greatest von Mises stress over the turn; yield strength of the softer body",
    must_have=False,
    lift_can_help=True,
    forecast=True,
    error="contact",
)
def first_yield(solution: Solution) -> Demand:
    """Maximum von Mises stress, Pa; shakedown permits values above first yield."""
    softer = solution.machine.softer
    worst = greatest(solution.cycles, lambda cycle: cycle.contact.von_mises)
    onset = shown(FIRST_YIELD * softer.yield_strength, "MPa")
    return Demand(
        worst.value,
        softer.yield_strength / solution.machine.limits[YIELD_SAFETY],
        worst,
        note=f"first yield at a contact pressure of {onset}; above it the material may shake down",
        figures=(f"{softer.name}: {softer.source}",),
    )


@check(
    SHAKEDOWN_SAFETY,
    id="shakedown",
    title="Peak contact pressure vs. shakedown limit",
    unit="MPa",
    method="greatest contact pressure over the turn; 4.0 k, free rolling, k = Y/sqrt(3) of the"
    " softer body",
    lift_can_help=True,
    forecast=True,
    error="contact",
)
def shakedown(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against elastic shakedown."""
    worst, softer = peak_pressure(solution), solution.machine.softer
    return Demand(
        worst.value,
        _allowed(solution, "shakedown"),
        worst,
        note="without traction; sliding at the surface lowers the limit",
        figures=(f"{softer.name}: {softer.source}",),
    )


@check(
    TARGET_LIFE,
    id="contact_pressure_at_life",
    title="Peak contact pressure vs. endurance limit at target life",
    unit="MPa",
    method="greatest contact pressure over the turn; one load cycle per turn and contour point, all"
    " turns in the worst load case",
    lift_can_help=True,
    error="contact",
)
def contact_pressure_at_life(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against the endurance at the target life."""
    machine, worst = solution.machine, peak_pressure(solution)
    card, missing = machine.cam.material, []
    if machine.limits[TARGET_LIFE] is None:
        missing.append("no target life is given")
    if card.endurance_slope is None:
        missing.append(f"the card of {card.name} gives no slope of endurance")
    allowed = _allowed(solution, "contact_pressure_at_life")
    return Demand(worst.value, allowed, worst, note="; ".join(missing), figures=(card.source,))


def pressure_at_life(cycles: float, slope: float, intercept: float, modulus: float) -> float:
    """Endurance limit of the contact pressure at a number of load cycles, Pa.

    Parameters
    ----------
    cycles : float             n, number of load cycles
    slope, intercept : float   A and B of log10 K = (B - log10 n)/A with K in psi
    modulus : float            E*, Pa

    References
    ----------
    Rothbart, Cam Design Handbook (2004), eq. 9.15; p0 = sqrt(K E*/pi).
    """
    factor = PSI * 10.0 ** ((intercept - math.log10(max(cycles, 1.0))) / slope)
    return math.sqrt(factor * modulus / math.pi)


@check(
    EDGE_FACTOR,
    id="edge_pressure",
    title="Edge pressure of the {follower} vs. endurance limit",
    unit="MPa",
    method="greatest contact pressure times the edge factor; plane strain does not include ends",
    lift_can_help=True,
    error="contact",
)
def edge_pressure(solution: Solution) -> Demand:
    """Contact pressure at the ends of the line contact, Pa, by the edge factor."""
    worst, machine = peak_pressure(solution), solution.machine
    softer, factor = machine.softer, applied_edge_factor(machine)
    endurance = softer.endurance_pressure
    safety = machine.limits[CONTACT_SAFETY]
    return Demand(
        factor * worst.value,
        None if endurance is None else endurance / safety,
        worst,
        note="" if endurance is not None else _no_endurance(solution),
        figures=(f"{softer.name}: {softer.source}",),
        method=f"greatest contact pressure times {factor:g}; plane strain does not include ends",
    )


@check(
    SHAKEDOWN_SAFETY,
    id="shakedown_traction",
    title="Peak contact pressure vs. shakedown limit with sliding",
    unit="MPa",
    method="greatest contact pressure over the turn; traction of full sliding, greatest shear"
    " along the surface <= k of the softer body",
    lift_can_help=True,
    error="contact",
)
def shakedown_traction(solution: Solution) -> Demand:
    """Maximum contact pressure, Pa, against shakedown in full sliding."""
    worst, softer = peak_pressure(solution), solution.machine.softer
    kind = solution.machine.follower
    return Demand(
        worst.value,
        _allowed(solution, "shakedown_traction"),
        worst,
        note=""
        if kind.friction is not None
        else f"no friction of the {kind.word} on the cam is given",
        figures=(f"{softer.name}: {softer.source}",),
    )


@lru_cache(maxsize=64)
def shakedown_factor(friction: float) -> float:
    """p0/k at the limit of elastic shakedown of a sliding line contact: 4 without friction.

    Residual stresses can compensate all components but the shear stress along the surface, which
    is limited by the shear yield strength: the limit is 1/max|tau_xz| at p0 = 1.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 9.2; Melan's theorem.
    """
    x, depth = np.meshgrid(np.linspace(-1.5, 1.5, 601), np.linspace(0.0, 1.5, 301))
    shear = np.abs(hertz.subsurface_stress(x, depth, friction)[2])
    return 1.0 / float(shear.max())


def _no_endurance(solution: Solution) -> str:
    return f"the card of {solution.machine.softer.name} gives no endurance pressure"
