"""Checks of an arm's assembly: arm, hub and spring beside cam, camshaft, gear, bearings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import reduce
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Value
from camwright.pipeline.base import levers
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.checks.assembly import (
    centre_distance,
    cheek_to_cam,
    machine_shaft_axis,
    one,
    shaft_radius,
)
from camwright.pipeline.checks.cam_shape import contour_radius
from camwright.pipeline.checks.camshaft_strength import gear_of
from camwright.pipeline.checks.check import NONE, STATED, Demand, check
from camwright.pipeline.checks.extremes import Extreme
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.arm_bodies import (
    ARM_DEPTH,
    ARM_WIDTH,
    FORK,
    HUB,
    SPRING,
    SwungBody,
    swung_bodies,
    with_swing,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution

_OUTER_OF_BEARING = 3.1
"""Outer diameter of ball bearings of the series 02 and 03 over their bore from 12 mm, at most."""
_WORDS = {"arm": "arm", HUB: "hub", FORK: "fork", SPRING: "spring"}


class PartOnShaft(NamedTuple):
    """Part about an axis at u and v: radius, m; middle and half width along
    the camshaft from the middle of the cam, None: all along it."""

    axis: tuple[Value, Value]
    radius: Value
    ends: tuple[Value, Value] | None


class PartGap(NamedTuple):
    """Gaps of two parts, m: in the plane, half of one and radius of the other, and axial."""

    plane: Value
    sizes: tuple[Value, Value]
    axial: Value

    def gap(self, limit: Value) -> Value:
        """Greater of both gaps; NaN where one that is not known can decide it."""
        apart = np.fmax(self.plane, self.axial)
        return np.where(apart >= limit, apart, np.maximum(self.plane, self.axial))


def about_camshaft(tip: Value, numbers: Numbers) -> dict[str, PartOnShaft]:
    """Parts about the camshaft, and the pinion of its gear, by name; the cam has its maximum radius
    `tip`, m; the radius of bearings is NaN without a diameter of the camshaft.
    """
    case, centre = numbers.known_case, (0.0, 0.0)
    discs = {
        "cam": PartOnShaft(centre, tip, (0.0, 0.5 * numbers["cam.width"])),
        "camshaft": PartOnShaft(centre, shaft_radius(numbers), None),
    }
    shaft = case.camshaft
    if shaft is None:
        return discs
    bore = np.nan if shaft.widest is None else shaft.widest
    wide = bore if shaft.bearing_width is None else shaft.bearing_width
    for number, at in enumerate((0.0, shaft.bearing_spacing), 1):
        ends = at - shaft.cam_position, 0.5 * wide
        discs[f"bearing {number}"] = PartOnShaft(centre, 0.5 * _OUTER_OF_BEARING * bore, ends)
    if shaft.gear is not None and case.scope.covers("gear"):
        gear = gear_of(shaft)
        module = 2.0 * shaft.gear_radius / gear.teeth
        ends = shaft.gear_position - shaft.cam_position, 0.5 * gear.width
        pinion = centre_distance(shaft) - shaft.gear_radius + module
        discs["gear"] = PartOnShaft(centre, shaft.gear_radius + module, ends)
        discs["pinion"] = PartOnShaft(machine_shaft_axis(shaft), pinion, ends)
    return discs


def _pairs(tip: Value, numbers: Numbers) -> Iterator[tuple[str, PartGap]]:
    """Gaps of arm, fork, hub and spring to each part about the camshaft, with the names of both;
    but for the hub those to the cam are judged apart.
    """
    bodies = swung_bodies(numbers)
    for name, disc in about_camshaft(tip, numbers).items():
        for which, words in _WORDS.items():
            if which in bodies and not (name == "cam" and which != HUB):
                yield f"{words} to {name}", pair_of(bodies[which], disc)


def pair_of(body: SwungBody, disc: PartOnShaft) -> PartGap:
    plane = body.from_disc(*disc.axis, disc.radius)
    axial = -np.inf if disc.ends is None else body.beyond(disc.ends)
    return PartGap(plane, (body.half, disc.radius), axial)


def _least(tip: Value, numbers: Numbers) -> Value:
    """Least gap, m, of arm, fork, hub and spring to the parts about the camshaft; tip : maximum
    radius of the cam, m. NaN where a width that is not stated decides.
    """
    limit = numbers.limit(ASSEMBLY_GAP)
    gaps = (each.gap(limit) for _, each in _pairs(tip, numbers))
    least: Value = reduce(np.minimum, gaps) + 0.0 * tip
    return least


def numbers_of(pair: PartGap) -> dict[str, float]:
    """Numbers of the formula by symbol; where the parts have no axial gap, "a" is the gap in the
    plane.
    """
    plane, half, radius = one(pair.plane), *map(one, pair.sizes)
    axial = one(pair.axial)
    stated = {"d": plane + half + radius, "h": half, "r": radius}
    return stated | {"a": axial if np.isfinite(axial) else plane}


def _in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the pair of parts that governs and its numbers, or with the missing width of the
    arm.
    """
    numbers = solution.numbers | with_swing(solution.cams.values())
    if demand.missing:
        return replace(demand, at=None)
    if demand.value is None or np.isnan(demand.value):
        shaft = numbers.known_case.camshaft
        lacks = [ARM_WIDTH] if numbers.get(ARM_WIDTH) is None else []
        lacks += ["camshaft.diameter"] if shaft is not None and shaft.diameter is None else []
        return replace(demand, at=None, missing=tuple(lacks))
    tip, limit = solution.contour.radius_max().value, numbers.limit(ASSEMBLY_GAP)
    pairs = dict(_pairs(tip, numbers))
    name = min(pairs, key=lambda each: one(pairs[each].gap(limit)))
    return replace(demand, at=None, note=name, stated=numbers_of(pairs[name]))


_LEVERS = (
    levers.one("follower.arm.hub", -1, 2.0),
    levers.one("follower.arm.depth", -1, 2.0),
    levers.one("follower.arm.width", -1, 2.0),
)

arm_gap = check(
    ASSEMBLY_GAP,
    id="arm_gap",
    title="Gap between arm, hub or spring and camshaft, bearings, gear or cam tip",
    tier=Tier.SCREENING,
    formula="max(d - h - r, a) >= g; of the nearest pair: d: least distance over the swing of the"
    " centre line of arm, cheeks or spring, or of the pivot, from the axis of camshaft, bearing,"
    " gear or pinion, and of the pivot from that of the cam, h: half of follower.arm.depth, of the"
    " height of the cheeks, of follower.arm.hub or of the diameter of a spring that links the arm,"
    " r: radius of the other, max|P| of the cam, a: axial gap of the two, that in the plane for the"
    " camshaft, g: limits.assembly_gap",
    symbols=dict.fromkeys("dhra", f"{STATED} [mm]"),
    reason="An arm, hub or spring within camshaft, bearing, gear or cam cannot be assembled.",
    method="straight arm, cheeks and spring with round ends over the swing from discs about the"
    " camshaft, bearings at most 3.1 times as large as their bore, or faces along the camshaft",
    lift_can_help=True,
    moved_by_tolerance=False,
    needs="arm",
    part="arm",
    load_cases=NONE,
    levers=_LEVERS,
    page="Follower",
).measured(
    "contour",
    value=_least,
    needed=(ARM_DEPTH,),
    known=with_swing,
    remark=_in_words,
    deviation=1e-4,
)(contour_radius)


@check(
    ASSEMBLY_GAP,
    title="Gap between arm or its spring and cam over the turn",
    formula="max(d - h, a) >= g; of arm, cheeks or spring, the nearest: d: least distance of their"
    " centre line, from the pivot to the bridge of the fork or the roller centre, or between the"
    " ends of the spring, from the contour over the turn, h: half of follower.arm.depth, of the"
    " height of the cheeks or of the diameter of the spring, a: axial gap from the cam, of the"
    " inner faces of the cheeks, g: limits.assembly_gap",
    symbols=dict.fromkeys("dha", f"{STATED} [mm]"),
    reason="A lobe of the cam that strikes the arm, between roller and pivot, or its spring is"
    " stopped.",
    method="straight arm, cheeks and spring with round ends from the contour, refined over contour"
    " and turn; not the arm of a face, which is above it",
    lift_can_help=True,
    moved_by_tolerance=False,
    needs="arm",
    part="arm",
    load_cases=NONE,
    levers=(_LEVERS[1], levers.PRIME, *levers.GENTLER),
    page="Follower",
)
def arm_cam_gap(solution: Solution) -> Demand | None:
    """Least gap between arm, fork or spring and cam over the turn, m, with the cam angle of the
    nearest point; None of a face on an arm without such a spring.
    """
    numbers, limit = solution.numbers, solution.machine.limits[ASSEMBLY_GAP]
    bodies, half = swung_bodies(numbers), 0.5 * numbers["cam.width"]
    if solution.machine.follower.slides:
        bodies = {name: body for name, body in bodies.items() if name == SPRING}
        if not bodies:
            return None
    elif "arm" not in bodies:
        return Demand(None, limit, missing=(ARM_DEPTH,))
    pairs, angles = dict[str, PartGap](), dict[str, float]()
    if solution.machine.follower.parts.get("pin") is None:
        bodies.pop(FORK, None)  # what it lacks is told by the check of its data
    for name in ("arm", FORK, SPRING):
        if name in bodies:
            body = bodies[name]
            nearest = body.bar.from_contour(solution.contour)
            beside = cheek_to_cam(numbers) if name == FORK else body.beyond((0.0, half))
            pairs[name] = PartGap(nearest.value - body.half, (body.half, 0.0), beside)
            angles[name] = float(np.mod(nearest.theta, FULL_TURN))
    gaps = {name: one(pair.gap(limit)) for name, pair in pairs.items()}
    if any(map(np.isnan, gaps.values())):
        return Demand(None, limit, missing=(ARM_WIDTH,))
    name = min(gaps, key=gaps.__getitem__)
    stated = {key: value for key, value in numbers_of(pairs[name]).items() if key != "r"}
    in_plane = pairs[name].plane >= pairs[name].axial
    at = Extreme(np.nan, "", angles[name]) if in_plane else None
    return Demand(gaps[name], limit, at, note=f"{_WORDS[name]} to cam", stated=stated)
