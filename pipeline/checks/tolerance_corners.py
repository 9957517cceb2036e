"""Tolerance corners of the final cam by closed forms, and the governing corner of a check.

Each tolerance is at both ends in turn, and all that narrow the clearance between two tracks, or
widen it, at once; then a seeded sample varies all. The lift is the nominal one; friction, spring,
masses, phase and contour are those of the corner. The demand at a corner is the nominal demand
times the ratio of the closed forms at the corner and at the nominal.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from itertools import product

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.errors import CamError
from camwright.geometry.extrema import first_greatest
from camwright.geometry.lift import Lift
from camwright.geometry.track_deviation import EXACT
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.machine import Corner, Machine, friction_range
from camwright.pipeline.checks.check import HELD, Check, Declaration, Demand
from camwright.pipeline.checks.lost_loads import checks_on_sound_loads
from camwright.pipeline.checks.registry import TOLERANCE_CORNERS, TOLERANCED, checks_of
from camwright.pipeline.contact.cam_body import NARROWING
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import solve_lengths
from camwright.pipeline.cycle.solution import Solution, solved_turns
from camwright.pipeline.cycle.turn import Turn, TurnInput, turns
from camwright.pipeline.records.corners_document import CornerRecord, CornersDocument

NOMINAL = Corner("nominal")
_ENDS = "low", "high"
_Ranges = Mapping[str, Mapping[str, tuple[float, float]]]
POSITIONS = 90
"""Cam angles per turn, enough for the ratio of two demands."""


@dataclass(frozen=True, repr=False)
class Outcome(Displayed):
    """Demands by check id at one corner, or the reason for its refusal.

    `bounds` are the ids of checks that rest on loads lost there, `lost` in words: their demand is
    that of the other load cases, if there are any.
    """

    corner: Corner
    demands: Mapping[str, float]
    refused: str = ""
    bounds: frozenset[str] = frozenset()
    lost: str = ""


def corners_of(case: Case) -> tuple[Corner, ...]:
    """Corners with one tolerance at its low or high limit each, those of the clearance or
    interference, then a seeded random sample of all together.
    """
    ranges = _ranges(case)
    alone = [_at(ranges, {label: end}) for label in ranges for end in range(len(_ENDS))]
    draw = np.random.default_rng(case.tolerances.seed)
    sample = []
    for number in range(case.tolerances.samples):
        values: dict[str, float] = {}
        for bounds in ranges.values():
            share = float(draw.random())  # both guides share their lubrication
            values |= {name: low + share * (high - low) for name, (low, high) in bounds.items()}
        sample.append(Corner(f"sample {number + 1}", **values))
    return (*alone, *_limits_of_fit(case, ranges), *sample)


def _limits_of_fit(case: Case, ranges: _Ranges) -> Iterator[Corner]:
    """Corners of the least and the greatest clearance or interference of two tracks.

    All that narrows it at every cam angle does so together, or all widens it: the worst case, by
    which ISO 286-1 has the limits of a fit. Its chain is short, and each pair of tracks is adjusted
    for itself; the statistical sum is that of the sample. What narrows it at some angles and widens
    it at others is at both its ends. None where a single tolerance moves it.
    """
    toleranced = [label for label in case.cam.deviations if label in ranges]
    if len(toleranced) < 2:
        return
    either = [label for label in toleranced if label not in NARROWING]
    clear = case.cam.clearance > 0.0
    for narrow in (True, False):
        extreme = "minimum" if narrow is clear else "maximum"
        fit = f"{extreme} {'clearance' if clear else 'interference'}"
        ends = {label: end if narrow else 1 - end for label, end in NARROWING.items()}
        for chosen in product(range(len(_ENDS)), repeat=len(either)):
            beside = dict(zip(either, chosen, strict=True))
            yield _at(ranges, ends | beside, ", ".join((fit, *_words(beside))))


def _words(ends: Mapping[str, int]) -> Iterator[str]:
    return (f"{label} {_ENDS[end]}" for label, end in ends.items())


def _at(ranges: _Ranges, ends: Mapping[str, int], name: str = "") -> Corner:
    """Corner with tolerances at an end, 0 or 1, each; the others are nominal."""
    values = {
        field: bounds[end]
        for label, end in ends.items()
        for field, bounds in ranges.get(label, {}).items()
    }
    return Corner(name or ", ".join(_words(ends)), **values)


def spring_corners(case: Case) -> tuple[Corner, ...]:
    """Corners at which the spring closes the contact with the least and the greatest force.

    Weakest spring and lowest contour with each end of the masses and of the friction; strongest
    spring and highest contour.
    """
    ranges = _ranges(case)
    weak = {"spring rate": 0, "preload": 0, "line profile": 0}
    corners = [
        _at(
            ranges,
            weak | {"mass": mass, "friction": friction},
            f"weakest spring {2 * mass + friction + 1}",
        )
        for mass in (0, 1)
        for friction in (0, 1)
    ]
    strong = _at(ranges, dict.fromkeys(weak, 1), "strongest spring")
    return tuple(dict.fromkeys((*corners, strong)))


def outcomes(
    case: Case,
    states: Sequence[Machine],
    contour: Contour,
    corners: Sequence[Corner] | None = None,
    declarations: Sequence[Declaration] = TOLERANCED,
) -> tuple[Outcome, ...]:
    """Outcome of each corner.

    Parameters
    ----------
    states : sequence         nominal machine in each load case, with its torque
    corners : sequence        None: the nominal, then every corner of the case
    declarations : sequence   of the checks made there
    """
    if corners is None:
        corners = NOMINAL, *corners_of(case)
    try:
        solved = _turns_at(states, contour, corners, declarations)
    except CamError:  # of one corner at least: each on its own
        return tuple(_outcome_alone(case, states, contour, each, declarations) for each in corners)
    return tuple(_outcomes(case, solved, declarations))


def checks_at(
    case: Case,
    states: Sequence[Machine],
    contour: Contour,
    corners: Sequence[Corner],
    declarations: Sequence[Declaration],
) -> tuple[tuple[Check, ...], ...]:
    """Checks at each corner by coarse closed forms, for ratios to their nominal demands.

    Raises
    ------
    CamError
        If a corner cannot be solved.
    """
    solved = _turns_at(states, contour, corners, declarations)
    return tuple(checks_of(_solution(case, *each), declarations) for each in solved)


def governed(checks: Sequence[Check], tried: Sequence[Outcome]) -> tuple[Check, ...]:
    """Checks with their governing corner and the demand there, by which they are judged.

    Parameters
    ----------
    tried : sequence   of `outcomes`, the nominal first
    """
    return tuple(_governed(one, tried) for one in checks)


def unsolved(machine: Machine, tried: Sequence[Outcome]) -> Check:
    """Check of the number of corners without a solution."""
    refused = [f"{one.corner.name}: {one.refused}" for one in tried if one.refused]
    demand = Demand(
        float(len(refused)),
        0.0,
        note="; ".join(refused),
        method=f"closed forms at {len(tried) - 1} corners",
        stated={"n": float(len(refused))},
    )
    return TOLERANCE_CORNERS.judged(machine, demand)


def corners_record(case: Case, tried: Sequence[Outcome]) -> CornersDocument:
    """Record of ``corners.json``: factors of each tolerance corner, and demands there."""
    return {
        "seed": case.tolerances.seed,
        "tried": len(tried) - 1,
        "positions": POSITIONS,
        "method": "closed forms on the final cam; demands scale the nominal figures of the run",
        "corners": [_corner_record(one) for one in tried],
    }


def _corner_record(one: Outcome) -> CornerRecord:
    corner = one.corner
    varied = {name: value for name, value in asdict(corner.deviation).items() if value}
    record: CornerRecord = {
        "name": corner.name,
        "friction_a": corner.friction_a,
        "friction_b": corner.friction_b,
        "rate": corner.rate,
        "preload": corner.preload,
        "mass": corner.mass,
        "inertia": corner.inertia,
        "phase": corner.phase,
        "profile": corner.profile,
        "demands": _plain(one.demands),
        "refused": one.refused,
        "lost": one.lost,
    }
    if varied:
        record["deviation"] = varied
    return record


def _plain(demands: Mapping[str, float]) -> dict[str, float | None]:
    """Demands in the units of the checks; infinity becomes null."""
    units = {declared.id: declared.unit for declared in TOLERANCED}
    return {
        name: in_unit(value, units[name]) if np.isfinite(value) else None
        for name, value in demands.items()
    }


def _ranges(case: Case) -> _Ranges:
    """Least and greatest value of each field of `Corner`, by tolerance and field; zero tolerances
    are left out.
    """
    tolerances, spring = case.tolerances, case.spring
    friction = friction_range(case)

    def around(tolerance: float) -> tuple[float, float]:
        return 1.0 - tolerance, 1.0 + tolerance

    profile = case.cam.profile_tolerance or 0.0
    inertia = 0.0 if case.crankshaft is None else tolerances.inertia
    ranges: dict[str, dict[str, tuple[float, float]]] = {
        "friction": {
            "friction_a": friction.factors(0),
            "friction_b": friction.factors(1),
        },
        "spring rate": {"rate": around(spring.rate_tolerance)},
        "preload": {"preload": around(spring.preload_tolerance)},
        "mass": {"mass": around(tolerances.mass)},
        "crank inertia": {"inertia": around(inertia)},
        "phase": {"phase": (-tolerances.phase, tolerances.phase)},
        "line profile": {"profile": (-0.5 * profile, 0.5 * profile)},
        **{name: dict(ends) for name, ends in case.cam.deviations.items()},
    }
    return {
        label: bounds
        for label, bounds in ranges.items()
        if any(high > low for low, high in bounds.values())
    }


@dataclass(frozen=True, eq=False)
class _Tried:
    """A corner with its contour and its machines in every load case."""

    corner: Corner
    shape: Contour
    inputs: tuple[TurnInput, ...]

    @classmethod
    def at(cls, states: Sequence[Machine], contour: Contour, corner: Corner) -> _Tried:
        shape = _shape(contour, corner)
        inputs = tuple(TurnInput(state.at_corner(corner), shape) for state in states)
        return cls(corner, shape, inputs)


def _turns_at(
    states: Sequence[Machine],
    contour: Contour,
    corners: Sequence[Corner],
    declarations: Sequence[Declaration],
) -> list[tuple[_Tried, tuple[Turn, ...]]]:
    """Turns of every load case at each corner, all solved together, in the order of the corners.

    The bounds of the friction as well, where every check is made there.
    """
    tried = [_Tried.at(states, contour, each) for each in corners]
    bounds = declarations is TOLERANCED
    every = turns(
        [state for each in tried for state in each.inputs], POSITIONS, coarse=True, bounds=bounds
    )
    count = len(tried[0].inputs)
    return [(each, every[k * count : (k + 1) * count]) for k, each in enumerate(tried)]


def _outcome_alone(
    case: Case,
    states: Sequence[Machine],
    contour: Contour,
    corner: Corner,
    declarations: Sequence[Declaration],
) -> Outcome:
    """Demands at one corner solved on its own; the reason where it is refused."""
    try:
        solved = _turns_at(states, contour, (corner,), declarations)
    except CamError as error:
        return Outcome(corner, {}, str(error))
    (outcome,) = _outcomes(case, solved, declarations)
    return outcome


def _solution(case: Case, tried: _Tried, solved: Sequence[Turn]) -> Solution:
    """Solution of the turns at a corner."""
    corner, shape = tried.corner, tried.shape
    advance = corner.phase / case.mechanism.gear_ratio
    return solved_turns(
        case, shape, tuple(_phased(each, corner) for each in solved), Tier.PREVIEW,
        body=True, speed_contour=_advanced(shape, advance), advance=advance, error_bars=False,
    )  # fmt: skip


def _outcomes(
    case: Case,
    turns_at: Sequence[tuple[_Tried, tuple[Turn, ...]]],
    declarations: Sequence[Declaration],
) -> Iterator[Outcome]:
    """Demands at each corner from its turns, in their order; contacts of finite length are solved
    for all corners together.
    """
    solved: list[tuple[Corner, Solution | CamError]] = []
    first: dict[Corner, Solution] = {}  # of each set of loads
    preloaded = case.cam.pulls and not case.cam.clearance > 0.0
    for tried, turns_there in turns_at:
        try:
            there = _solution(case, tried, turns_there)
        except CamError as error:
            solved.append((tried.corner, error))
        else:
            solved.append((tried.corner, there))
            first.setdefault(_of_loads(tried.corner, preloaded=preloaded), there)
    if declarations is TOLERANCED:
        # no check reads that of a turn whose loads end
        every = (cycle for each in first.values() for cycle in each.cycles)
        cycles = [cycle for cycle in every if cycle.end is None]
        with suppress(CamError):  # of one corner at least: each on its own
            solve_lengths(cycles)
    for corner, each in solved:
        if isinstance(each, Solution):
            each.adopt(first[_of_loads(corner, preloaded=preloaded)])
        yield _outcome(corner, each, declarations)


def _of_loads(corner: Corner, *, preloaded: bool) -> Corner:
    """The corner without what changes the crank alone, not the loads of the cam, nor the clearance
    of tracks that are not preloaded.
    """
    exact = {} if preloaded else asdict(EXACT)
    return replace(corner, name="", inertia=1.0, phase=0.0, **exact)


def _outcome(
    corner: Corner, solved: Solution | CamError, declarations: Sequence[Declaration]
) -> Outcome:
    """Demands of the checks at a solved corner by id, NaN left out; the reason where it is
    refused.
    """
    if isinstance(solved, CamError):
        return Outcome(corner, {}, str(solved))
    try:
        checks = tuple(checks_on_sound_loads(declarations, solved))
    except CamError as error:
        return Outcome(corner, {}, str(error))
    demands = {one.id: float(one.demand) for one in checks if one.demand is not None}
    bounds = {one.id: one.without for one in checks if one.without}
    return Outcome(
        corner,
        {name: value for name, value in demands.items() if not np.isnan(value)},
        bounds=frozenset(bounds),
        lost=next(iter(bounds.values()), ""),
    )


def _shape(contour: Contour, corner: Corner) -> Contour:
    if corner.profile == 0.0:
        return contour
    return replace(contour, pitch=contour.pitch.enlarged(corner.profile))


def _advanced(contour: Contour, advance: float) -> Contour:
    """Contour whose lift comes earlier by `advance`, rad of cam, than the nominal one."""
    if advance == 0.0:
        return contour
    lift = contour.pitch.lift
    advanced = np.maximum(lift(lift.theta + advance), 0.0)
    return replace(contour, pitch=replace(contour.pitch, lift=Lift(lift.theta, advanced)))


def _phased(each: Turn, corner: Corner) -> Turn:
    """Turn whose engine torque is delayed by the phase of the corner, rad of crank."""
    before, ratio = each.torque_before, each.machine.gear_ratio
    if before is None or corner.phase == 0.0:
        return each
    theta = uniform_turn(before.size)
    late = np.interp(theta - corner.phase / ratio, theta, before, period=2.0 * np.pi)
    return replace(each, torque_before=late, torque_after=late - each.loads.cam_torque / ratio)


def _with_range(one: Check, tried: Sequence[Outcome]) -> Check:
    """Check of a cam that pulls with the range of its demand over the corners in its note."""
    demands = [each.demands[one.id] for each in tried if one.id in each.demands]
    here = tried[0].demands.get(one.id)
    if one.declaration.closed_by not in HELD or not (here and one.demand):
        return one
    ends = (one.demand / here * end for end in (min(demands), max(demands)))
    low, high = (shown(end, one.unit) for end in ends)
    words = "" if low == high else f"{low} to {high} at the corners"
    return replace(one, note="; ".join(filter(None, (one.note, words))))


def _governed(one: Check, tried: Sequence[Outcome]) -> Check:
    """Check with the corner that governs it, and the demand there; NaN where a solved corner has no
    value.

    The demand of the run times the ratio of the closed forms at the corner and without it; that at
    the corner where the nominal one lacks a load case. Where a load case has no loads at a corner,
    the demand of the others can only fail the check; see `lost_loads`.
    """
    one = _with_range(one, tried)
    nominal = tried[0]
    nominal_demand, here = one.demand, nominal.demands.get(one.id)
    if nominal_demand is None or here is None:
        return one
    solved = [outcome for outcome in tried if not outcome.refused]
    bounds = [outcome for outcome in solved if one.id in outcome.bounds]
    if bounds and not one.without:
        one = replace(
            one, without=f"at the tolerance corner {bounds[0].corner.name} {bounds[0].lost}"
        )
    evaluated = [outcome for outcome in solved if one.id in outcome.demands]
    unknown = [each for each in solved if one.id not in each.demands and one.id not in each.bounds]
    if unknown:
        return replace(one, corner=unknown[0].corner.name, corner_demand=float("nan"))
    sign = 1.0 if one.sense == "at_most" else -1.0
    worst = evaluated[first_greatest([sign * outcome.demands[one.id] for outcome in evaluated])]
    if worst is nominal:
        return replace(one, corner="nominal", corner_demand=one.demand)
    there = worst.demands[one.id]
    # over the same load cases, and on the same side of zero
    comparable = one.id not in nominal.bounds and np.isfinite(here) and nominal_demand * here > 0.0
    demand = nominal_demand * there / here if comparable else there
    if sign * demand < sign * nominal_demand:  # of a corner that lacks a load case of the run
        return replace(one, corner="nominal", corner_demand=one.demand)
    return replace(one, corner=worst.corner.name, corner_demand=float(demand))
