"""From a case to the synthesis it asks for: its limits, its load cases, what it frees."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product

import numpy as np

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.requirements_section import LoadCase
from camwright.pipeline.cycle.turn import CREEP
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.smoothing.allowables import ratings_of
from camwright.pipeline.smoothing.constrained_synthesis import Problem
from camwright.pipeline.smoothing.scenario import Correction, Machine, Scenario

POINTS = 720


def problem_of(
    case: Case, torques: Mapping[str, Torque], corrections: Mapping[str, Correction] | None = None
) -> Problem:
    """The constrained synthesis of a case.

    Parameters
    ----------
    torques : mapping       engine torque by load case
    corrections : mapping   finite elements over closed forms by load case; none: 1

    Raises
    ------
    InputError
        If the case has no engine.
    """
    if not torques:
        raise InputError("smoothing.kind", "constrained", "another one for a given lift")
    if not any(state.ripple_weight > 0 for state in case.load_cases):
        raise InputError("load_case.ripple_weight", 0.0, "> 0 in one load case")
    smoothing = case.smoothing
    if "preload" in smoothing.free and any(s.preload is not None for s in case.load_cases):
        raise InputError("smoothing.free", "preload", "no load case with a preload of its own")
    found = corrections or {}
    scenarios = [
        scenario
        for state in case.load_cases
        for scenario in _scenarios(case, state, torques.get(state.name), found.get(state.name))
    ]
    names = {
        "spring_rate": "rate",
        "preload": "preload",
        "pitch_base_radius": "prime_radius",
        "phase": "phase",
    }
    freed = {
        short: getattr(smoothing, f"{name}_range")
        for name, short in names.items()
        if name in smoothing.free
    }
    return Problem(
        scenarios=tuple(scenarios),
        ratings=ratings_of(case),
        machine=Machine(case.spring.rate, case.spring.preload, case.cam.pitch_base_radius),
        gear_ratio=case.mechanism.gear_ratio,
        freed=freed,
        energy=(0.0, np.inf if "initial_energy" in smoothing.free else 0.0),
        coefficients=smoothing.coefficients,
        points=POINTS,
        torque_reduction=case.limits.torque_reduction,
        torque_weight=smoothing.torque_weight,
        speed_weight=smoothing.speed_weight,
        jerk_weight=smoothing.jerk_weight,
    )


def _scenarios(
    case: Case, state: LoadCase, torque: Torque | None, correction: Correction | None
) -> list[Scenario]:
    """The load case itself and, where the case asks for corners, its tolerances."""
    follower, guides = case.follower, case.guides
    values = np.zeros(POINTS)  # a cam that stands still has no torque to balance
    if torque is not None:
        values = torque.without_mean().resampled(POINTS).total
    worst = (guides.a.friction_max, guides.b.friction_max)
    nominal = Scenario(
        name=state.name,
        cam_speed=max(state.speed, CREEP) / case.mechanism.gear_ratio,
        torque=values - values.mean(),
        mass=follower.mass,
        guide_spacing=guides.spacing,
        overhang=follower.overhang_at_max_lift,
        friction_a=guides.a.friction,
        friction_b=guides.b.friction,
        viscous_damping=follower.viscous_damping,
        preload_factor=1.0 if state.preload is None else state.preload / case.spring.preload,
        weight=0.0 if torque is None else state.ripple_weight,
        friction_worst=None if worst[0] is None or worst[1] is None else (worst[0], worst[1]),
        correction=correction or Correction.none(POINTS),
    )
    if not case.smoothing.corners:
        return [nominal]
    return [nominal, *_corners(case, nominal)]


def _corners(case: Case, nominal: Scenario) -> list[Scenario]:
    """Every combination of spring and friction at the ends of their tolerances; mass and phase
    at theirs, one at a time.
    """
    spring, tolerances = case.spring, case.tolerances
    product_of = product(
        _ends(spring.rate_tolerance), _ends(spring.preload_tolerance), _frictions(case)
    )
    found = [
        replace(
            nominal,
            name=f"{nominal.name}, k x {rate:g}, P x {preload:g}, mu {mu[0]:g} and {mu[1]:g}",
            rate_factor=rate,
            preload_factor=preload * nominal.preload_factor,
            friction_a=mu[0],
            friction_b=mu[1],
        )
        for rate, preload, mu in product_of
        if (rate, preload, mu) != (1.0, 1.0, (nominal.friction_a, nominal.friction_b))
    ]
    if tolerances.mass > 0:
        found += [
            replace(nominal, name=f"{nominal.name}, m x {share:g}", mass=share * nominal.mass)
            for share in _ends(tolerances.mass)
        ]
    late = tolerances.phase / case.mechanism.gear_ratio
    if late > 0:
        found += [
            replace(
                nominal,
                name=f"{nominal.name}, phase {np.degrees(shift):+.3g} deg of cam",
                torque=nominal.torque_at(shift)[0],
            )
            for shift in (-late, late)
        ]
    return found


def _ends(tolerance: float) -> list[float]:
    return [1.0 - tolerance, 1.0 + tolerance] if tolerance > 0 else [1.0]


def _frictions(case: Case) -> list[tuple[float, float]]:
    """Friction of guides A and B at its least and greatest, both guides in the same oil."""
    guides, share = (case.guides.a, case.guides.b), case.tolerances.friction
    low = [g.friction * (1 - share) if g.friction_min is None else g.friction_min for g in guides]
    high = [g.friction * (1 + share) if g.friction_max is None else g.friction_max for g in guides]
    ends = [(low[0], low[1]), (high[0], high[1])]
    return ends if ends[0] != ends[1] else ends[:1]
