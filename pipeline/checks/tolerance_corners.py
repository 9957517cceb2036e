"""The final cam at the corners of its tolerances, by closed forms: which corner governs a check.

Every tolerance goes to both ends alone, then a seeded sample takes them all at once. The cam is
the one that was designed; friction, spring, masses, phase and contour are those of the corner. The
demand at a corner is the nominal one times the ratio of the closed forms there and here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError
from camwright.geometry.follower_path import FollowerPath
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.parts_section import Guide
from camwright.pipeline.checks import (
    cam_shape,
    flat_face_sliding,
    manufacture,
    part_strength,
    surface_durability,
    torque_balance,
)
from camwright.pipeline.checks import guide_bushes as guides
from camwright.pipeline.checks import spring_strength as spring
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import DESIGN, PARTS, SIGNED, CheckFunction, checked_by
from camwright.pipeline.cycle.ahead import foreseen_cycle
from camwright.pipeline.cycle.crank_speed import rubbing_of, speed_ripple
from camwright.pipeline.cycle.turn import Turn, turn
from camwright.pipeline.engine.torque import Torque

POSITIONS = 90
"""Angles a turn: a corner asks for the ratio of two demands, not for either."""
UNMOVED: tuple[CheckFunction, ...] = (
    *(torque_balance.energy_closure, torque_balance.friction_balance),
    *(cam_shape.closure, cam_shape.acceleration_step),
    *(cam_shape.self_intersection, cam_shape.second_contact),
    *(cam_shape.spring_travel, guides.guide_length, part_strength.cam_unbalance),
    *spring.CHECKS,
    *(manufacture.chord_error, manufacture.phase_tolerance),
)
"""Checks whose demand no tolerance moves, or which stand at the end of their own already."""
TRIED: tuple[CheckFunction, ...] = tuple(
    check
    for check in (*DESIGN, *surface_durability.CHECKS, *flat_face_sliding.CHECKS, *SIGNED, *PARTS)
    if check not in UNMOVED
)


@dataclass(frozen=True)
class Corner:
    """Where in its tolerances a case stands: factors on the nominal; phase rad, profile m."""

    name: str
    friction_a: float = 1.0
    friction_b: float = 1.0
    rate: float = 1.0
    preload: float = 1.0
    mass: float = 1.0
    inertia: float = 1.0
    phase: float = 0.0
    profile: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """Demands by check id at one corner, or why there are none."""

    corner: Corner
    demands: Mapping[str, float]
    refused: str = ""


def corners_of(case: Case) -> tuple[Corner, ...]:
    """One tolerance at a time to both ends, then the seeded sample of all together."""
    ranges = _ranges(case)
    alone = []
    for label, bounds in ranges.items():
        low = {name: ends[0] for name, ends in bounds.items()}
        high = {name: ends[1] for name, ends in bounds.items()}
        alone += [Corner(f"{label} low", **low), Corner(f"{label} high", **high)]
    if not ranges:
        return ()
    draw = np.random.default_rng(case.tolerances.seed)
    sample = []
    for number in range(case.tolerances.samples):
        values: dict[str, float] = {}
        for bounds in ranges.values():
            place = float(draw.random())  # both guides share the day's oil
            values |= {name: low + place * (high - low) for name, (low, high) in bounds.items()}
        sample.append(Corner(f"sample {number + 1}", **values))
    return (*alone, *sample)


def outcomes(case: Case, torques: Mapping[str, Torque], contour: Contour) -> tuple[Outcome, ...]:
    """The nominal case first, then every corner of it."""
    return tuple(
        _outcome(case, torques, contour, corner)
        for corner in (Corner("nominal"), *corners_of(case))
    )


def governed(checks: Sequence[Check], found: Sequence[Outcome]) -> tuple[Check, ...]:
    """The checks with the corner where each is worst and its demand there.

    Last stands a check of its own: how many that pass at the nominal fail at a corner.
    """
    if len(found) < 2:
        return tuple(checks)
    named = tuple(_governed(check, found) for check in checks)
    return (*named, _robust(named, found))


def record(case: Case, found: Sequence[Outcome]) -> dict[str, Any]:
    """Contents of ``corners.json``."""
    return {
        "seed": case.tolerances.seed,
        "tried": len(found) - 1,
        "positions": POSITIONS,
        "method": "closed forms on the final cam; demands scale the nominal figures of the run",
        "corners": [
            {**asdict(one.corner), "demands": _plain(one.demands), "refused": one.refused}
            for one in found
        ],
    }


def _plain(demands: Mapping[str, float]) -> dict[str, float | None]:
    """As JSON holds them: a demand beyond all bounds is null."""
    return {name: value if np.isfinite(value) else None for name, value in demands.items()}


def _ranges(case: Case) -> dict[str, dict[str, tuple[float, float]]]:
    """Bounds of the fields of `Corner` by what moves together; nothing of no width."""
    tolerances, spring = case.tolerances, case.spring
    share = tolerances.friction

    def friction(guide: Guide) -> tuple[float, float]:
        nominal = guide.friction or 1.0
        low = 1.0 - share if guide.friction_min is None else guide.friction_min / nominal
        high = 1.0 + share if guide.friction_max is None else guide.friction_max / nominal
        return low, high

    def around(tolerance: float) -> tuple[float, float]:
        return 1.0 - tolerance, 1.0 + tolerance

    profile = case.cam.profile_tolerance or 0.0
    inertia = 0.0 if case.crankshaft is None else tolerances.inertia
    found: dict[str, dict[str, tuple[float, float]]] = {
        "friction": {
            "friction_a": friction(case.guides.a),
            "friction_b": friction(case.guides.b),
        },
        "spring rate": {"rate": around(spring.rate_tolerance)},
        "preload": {"preload": around(spring.preload_tolerance)},
        "mass": {"mass": around(tolerances.mass)},
        "crank inertia": {"inertia": around(inertia)},
        "phase": {"phase": (-tolerances.phase, tolerances.phase)},
        "line profile": {"profile": (-0.5 * profile, 0.5 * profile)},
    }
    return {
        label: bounds
        for label, bounds in found.items()
        if any(high > low for low, high in bounds.values())
    }


def _outcome(
    case: Case, torques: Mapping[str, Torque], contour: Contour, corner: Corner
) -> Outcome:
    try:
        at, shape = applied(case, corner), _shape(contour, corner)
        turns = tuple(
            _turned(
                turn(at, shape, torques.get(state.name), state.name, POSITIONS, ahead=True),
                at,
                corner,
            )
            for state in at.load_cases
        )
        cycles = tuple(foreseen_cycle(at, shape, given) for given in turns)
        rubbing = rubbing_of(cycles, corner.phase / case.mechanism.gear_ratio)
        speed = speed_ripple(at, torques, _early(shape.pitch, case, corner.phase), rubbing)
        trial = TrialEvidence(case=at, contour=shape, cycles=cycles, speed_ripple=speed)
        checks = checked_by(trial, TRIED)
    except CamError as error:
        return Outcome(corner, {}, str(error))
    known = {c.id: float(c.demand) for c in checks if c.demand is not None}
    return Outcome(corner, {name: value for name, value in known.items() if not np.isnan(value)})


def applied(case: Case, corner: Corner) -> Case:
    """The case at a corner of its tolerances; the contour is not the case's to change.

    The bounds of a guide's friction stay what they are: jamming is judged at their worst.
    """
    spring, guides, shaft = case.spring, case.guides, case.crankshaft
    # A cam that stands proud by some hundredths presses the spring by as much more.
    more = spring.rate * corner.rate * corner.profile
    states = tuple(
        state
        if state.preload is None
        else state.model_copy(update={"preload": state.preload * corner.preload + more})
        for state in case.load_cases
    )
    preload = spring.preload * corner.preload + more
    return case.model_copy(
        update={
            "load_cases": states,
            "crankshaft": shaft
            and shaft.model_copy(update={"inertia": shaft.inertia * corner.inertia}),
            "spring": spring.model_copy(
                update={"rate": spring.rate * corner.rate, "preload": preload}
            ),
            "follower": case.follower.model_copy(update={"mass": case.follower.mass * corner.mass}),
            "guides": guides.model_copy(
                update={
                    "a": _rubbing(guides.a, corner.friction_a),
                    "b": _rubbing(guides.b, corner.friction_b),
                }
            ),
        }
    )


def _rubbing(guide: Guide, factor: float) -> Guide:
    friction, low, high = guide.friction * factor, guide.friction_min, guide.friction_max
    bounds = {
        "friction_min": None if low is None else min(low, friction),
        "friction_max": None if high is None else max(high, friction),
    }
    return guide.model_copy(update={"friction": friction, **bounds})


def _shape(contour: Contour, corner: Corner) -> Contour:
    return replace(contour, pitch=contour.pitch.enlarged(corner.profile))


def _early(pitch: FollowerPath, case: Case, phase: float) -> FollowerPath:
    """The cam `phase` (rad of crank) early against the engine."""
    if phase == 0.0:
        return pitch
    lift = pitch.lift
    moved = np.maximum(lift(lift.theta + phase / case.mechanism.gear_ratio), 0.0)
    return replace(pitch, lift=Lift(lift.theta, moved))


def _turned(given: Turn, case: Case, corner: Corner) -> Turn:
    """The turn with the engine's torque `phase` (rad of crank) late against the cam."""
    before = given.torque_before
    if before is None or corner.phase == 0.0:
        return given
    ratio = case.mechanism.gear_ratio
    theta = uniform_turn(before.size)
    late = np.interp(theta - corner.phase / ratio, theta, before, period=2.0 * np.pi)
    return replace(given, torque_before=late, residual_torque=late - given.loads.cam_torque / ratio)


def _governed(check: Check, found: Sequence[Outcome]) -> Check:
    nominal = found[0]
    here = nominal.demands.get(check.id)
    if check.demand is None or here is None:
        return check
    sign = 1.0 if check.sense == "at_most" else -1.0
    known = [one for one in found if check.id in one.demands]
    worst = max(known, key=lambda one: sign * one.demands[check.id])
    if worst is nominal:
        return replace(check, corner="nominal", corner_demand=check.demand)
    there = worst.demands[check.id]
    demand = check.demand * there / here if here and np.isfinite(here) else there
    return replace(check, corner=worst.corner.name, corner_demand=float(demand))


def _robust(checks: Sequence[Check], found: Sequence[Outcome]) -> Check:
    refused = [f"{one.corner.name}: {one.refused}" for one in found if one.refused]
    lost = [
        c.id
        for c in checks
        if c.must_have
        and c.status == "pass"
        and c.corner_demand is not None
        and replace(c, demand=c.corner_demand).status == "fail"
    ]
    return Check(
        id="tolerance_corners",
        title="Checks that pass at the nominal and fail at a corner",
        demand=float(len(lost) + len(refused)),
        limit=0.0,
        unit="checks",
        source="tolerances of the case; one at a time and a seeded sample",
        method=f"closed forms at {len(found) - 1} corners; one without an answer counts as a check",
        must_have=False,
        lift_can_help=False,
        note=", ".join((*lost, *refused)),
    )
