"""Synthesis problem of a case with its tolerance corners, and with other rollers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.substitution import with_roller
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.external_load import closing_preload, dead_load, require_closing
from camwright.pipeline.case.limits import OVERSPEED
from camwright.pipeline.case.load_case_torque import engine_torque, require_ripple
from camwright.pipeline.case.machine import Machine, machines
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solved_cam import numbers_in
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.smoothing.allowables import ratings_of
from camwright.pipeline.smoothing.objective import KEYS, Objective, objective_of
from camwright.pipeline.smoothing.scenario import Correction, DesignVariables, Scenario
from camwright.pipeline.smoothing.synthesis_problem import COEFFICIENTS, Problem, per_lobe
from camwright.pipeline.torque.torque import Torque

POINTS = 720
"""Cam angles of a synthesis, about; a whole number in a lobe."""


def problem_of(case: Case, torques: Mapping[str, Torque]) -> Problem:
    """Constrained synthesis problem of a case.

    Parameters
    ----------
    torques : mapping   engine torque by load case

    Raises
    ------
    InputError
        If the case has no engine, no load case whose ripple counts, a torque without ripple in one
        whose ripple counts, or a free preload beside that of a load case.
    """
    if not torques:
        raise InputError("smoothing.kind", "constrained", "a smoother: the case has no engine")
    if not any(state.ripple_weight > 0 for state in case.load_cases):
        raise InputError("load_case.ripple_weight", 0.0, "> 0 in one load case")
    require_ripple(case, torques)
    smoothing = case.smoothing
    if "preload" in smoothing.free and any(s.preload is not None for s in case.load_cases):
        raise InputError("smoothing.free", "preload", "a preload common to all load cases")
    dead = dead_load(case)
    closing_preload(case)  # refuses one that is not positive
    if "preload" in smoothing.free and smoothing.preload_range is not None:
        require_closing("smoothing.preload_range", smoothing.preload_range[0], dead)
    states = machines(case, torques)
    first = {each.spring.preload: each.load_case for each in reversed(states)}
    scenarios = [
        replace(scenario, swept=each.load_case == first[each.spring.preload])
        for each in states
        for scenario in _scenarios(case, each)
    ]
    if smoothing.robust_weight > 0:
        named = {item.name: item for item in scenarios}
        for state in case.load_cases:
            if named[state.name].weight > 0:
                scenarios += _robust(case, state, named[state.name])
    names = {
        "spring_rate": "rate",
        "preload": "preload",
        "prime_radius": "prime_radius",
        "phase": "phase",
    }
    # A force of the machine over the cam angle differs from lobe to lobe.
    lobes = 1 if any(each.external.varies for each in states) else case.period.cycles
    # The second face follows from a minimum lift of zero; half a turn is half of the splines.
    yoked = case.cam.yoke is not None
    even = 2 if yoked else 1
    if yoked and lobes % 2 == 0:
        limit = "odd: the two faces of a yoke touch the cam half a turn apart"
        raise InputError("torque cycles in a cam turn", lobes, limit)
    freed = {
        short: getattr(smoothing, f"{name}_range")
        for name, short in names.items()
        if name in smoothing.free
    }
    return Problem(
        scenarios=tuple(scenarios),
        ratings=ratings_of(case),
        variables=DesignVariables(
            case.spring.rate,
            case.spring.preload,
            case.cam.prime_radius,
            dead_load=dead,
            shape=case.spring.shape,
            of_lift=yoked,
        ),
        gear_ratio=case.mechanism.gear_ratio,
        freed=freed,
        energy=(0.0, np.inf if "initial_energy" in smoothing.free and not yoked else 0.0),
        coefficients=per_lobe(smoothing.coefficients or COEFFICIENTS, lobes) // even * even,
        lobes=lobes,
        convergence=smoothing.ripple_convergence if smoothing.coefficients is None else None,
        points=_points(case),
        objective=_objective(case),
        jerk_weight=smoothing.jerk_weight,
    )


def roller_problems(
    case: Case, torques: Mapping[str, Torque], original: Problem
) -> Iterator[tuple[str, Problem]]:
    """Name and synthesis problem of each roller of the catalogue that fits a case, the smallest
    first; none where the case has a flat face.

    Parameters
    ----------
    case : Case          whose roller is replaced
    torques : mapping    engine torque by load case
    original : Problem   of the case; its corrections are applied to the alternatives

    Raises
    ------
    InputError
        If cards in the folder of the case cannot be read.
    """
    if not case.facing.parts:
        return
    folder = _folder(case)
    rollers = catalogue_of(folder).rollers
    corrections = {item.name: item.correction for item in original.scenarios}
    for name in sorted(rollers, key=lambda name: (rollers[name].outer_diameter, rollers[name].C0)):
        try:
            problem = problem_of(with_roller(case, name, rollers[name], folder), torques)
        except InputError:  # too large for bore or guides
            continue
        scenarios = tuple(
            replace(item, correction=corrections[item.name]) for item in problem.scenarios
        )
        yield name, replace(problem, scenarios=scenarios)


def _objective(case: Case) -> Objective:
    """Terms of the weights of the smoothing; harmonics are of the crank, per turn."""
    smoothing, ratio = case.smoothing, case.mechanism.gear_ratio
    weights = {key: float(getattr(smoothing, f"{key}_weight")) for key in KEYS}
    return objective_of(weights, [round(order * ratio) for order in smoothing.harmonic_orders])


def _scenarios(case: Case, machine: Machine) -> list[Scenario]:
    """Scenarios of a synthesis from one load case: the nominal one and, where the case wants them,
    those of the tolerance corners and of the ends of speed and load.

    Parameters
    ----------
    case : Case         with tolerances and smoothing
    machine : Machine   in the load case
    """
    points, torque = _points(case), machine.torque
    values = np.zeros(points)  # at rest the engine has no torque
    if torque is not None:
        values = torque.without_mean().resampled(points).total
    nominal = Scenario(
        name=machine.load_case,
        torque=values - values.mean(),
        numbers=Numbers(numbers_in(machine)),
        spring_mass=machine.spring_mass,
        preload_factor=machine.spring.preload / case.spring.preload,
        gravity=machine.gravity_along_axis,
        external=machine.external.at(uniform_turn(points if machine.external.varies else 1)),
        weight=0.0 if torque is None else machine.ripple_weight,
        torque_reduction=None if torque is None else machine.torque_reduction,
        duty=machine.duty,
        correction=Correction.none(points),
    )
    if not case.smoothing.corners:
        return [nominal]
    return [nominal, *_corners(case, nominal, machine)]


def _robust(case: Case, state: LoadCase, nominal: Scenario) -> list[Scenario]:
    """Scenarios at the four combinations of the ends of the stated ranges of speed and load of a
    load case, with the robust weight of the case.

    The speed is at most the over-speed. The load is a factor on the intake pressure of a cylinder
    model, else on the engine torque.

    Parameters
    ----------
    case : Case          with the ranges, as factors
    state : LoadCase     the load case
    nominal : Scenario   of this load case
    """
    smoothing, engine, most = case.smoothing, case.engine, case.limits[OVERSPEED]
    modelled = engine if isinstance(engine, CylinderEngine) and state.torque is None else None
    scenarios = []
    for rate, load in product(_ends(smoothing.robust_speed), _ends(smoothing.robust_load)):
        speed, factor = state.speed * rate, load
        speed = speed if most is None else min(speed, most)
        changed: dict[str, float] = {"speed": speed}
        if modelled is not None:
            changed["intake_pressure"] = (state.intake_pressure or modelled.intake_pressure) * load
            factor = 1.0
        torque = engine_torque(case, state.model_copy(update=changed))
        values = factor * torque.without_mean().resampled(_points(case)).total
        scenarios.append(
            replace(
                nominal.at({"cam.speed": speed / case.mechanism.gear_ratio}),
                name=f"{nominal.name}, n x {rate:g}, load x {load:g}",
                torque=values - values.mean(),
                weight=nominal.weight * smoothing.robust_weight,
                torque_reduction=None,
                duty=None if nominal.duty is None else 0.0,
                nominal=False,
                swept=False,
            )
        )
    return scenarios


def _corners(case: Case, nominal: Scenario, machine: Machine) -> list[Scenario]:
    """Scenarios of a load case at its tolerance corners: all combinations of the ends of spring
    rate, preload and friction, then mass and phase one at a time.

    Parameters
    ----------
    case : Case          with the tolerances
    nominal : Scenario   of the load case
    machine : Machine    in it, with the range of the friction
    """
    spring, tolerances, friction = case.spring, case.tolerances, machine.friction
    # Both guides share their lubrication.
    frictions = dict.fromkeys((friction.least, friction.greatest))
    ends = list(product(_ends(spring.rate_tolerance), _ends(spring.preload_tolerance), frictions))
    corners = [
        replace(
            nominal.at(dict(zip(machine.friction_keys, mu, strict=True))),
            corner=number,
            name=f"{nominal.name}, k x {rate:g}, P x {preload:g}, mu {mu[0]:g} and {mu[1]:g}",
            rate_factor=rate,
            preload_factor=preload * nominal.preload_factor,
        )
        for number, (rate, preload, mu) in enumerate(ends, 1)
        if (rate, preload, mu) != (1.0, 1.0, friction.nominal)
    ]
    masses = {
        key: mass
        for key in ("follower.mass", "follower.pivot.swinging_mass")
        if (mass := nominal.numbers.get(key)) is not None
    }
    single = [
        replace(
            nominal.at({key: share * mass for key, mass in masses.items()}),
            name=f"{nominal.name}, m x {share:g}",
        )
        for share in _ends(tolerances.mass)
    ]
    late = tolerances.phase / case.mechanism.gear_ratio
    single += [
        replace(
            nominal,
            name=f"{nominal.name}, phase {np.degrees(shift):+.3g} deg of cam",
            torque=nominal.torque_at(shift)[0],
        )
        for shift in (-late, late)
    ]
    corners += [replace(each, corner=number) for number, each in enumerate(single, len(ends) + 1)]
    return [replace(each, nominal=False) for each in corners]


def _points(case: Case) -> int:
    cycles = case.period.cycles
    return cycles * round(POINTS / cycles)


def _ends(tolerance: float) -> list[float]:
    return [1.0 - tolerance, 1.0 + tolerance]


def _folder(case: Case) -> Path | None:
    """Folder of the case file and its cards; None for a case built in Python."""
    try:
        return case.path("")
    except InputError:
        return None
