"""Checks of the assembly: no part within another over the whole turn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import reduce
from math import cos, isnan, radians, sin

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base import levers
from camwright.pipeline.base.counterweight_body import CounterweightBody
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.stem_layout import SEAT_MOST, StemLayout, decided
from camwright.pipeline.base.units import shown
from camwright.pipeline.base.verdict import ROUNDING
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.cam_shape import contour_radius, lift
from camwright.pipeline.checks.camshaft_strength import camshaft_of, gear_of
from camwright.pipeline.checks.check import NONE, STATED, Allowed, Demand, check
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.arm_bodies import SPRING, swung_bodies, with_swing
from camwright.pipeline.cycle.cam_balance import balance
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.machine_envelope import (
    counterweight_body,
    density_of_counterweight,
    guide_outer,
    lowest_follower,
    stem_layout,
)
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import Camshaft, Counterweight
from camwright.pipeline.follower.roller_parts import Pin

Gaps = Mapping[str, Value]
"""Gaps by the two parts beside them, m."""


def least_of(gaps: Gaps) -> Value:
    """Least of the gaps (...); NaN if one is."""
    return reduce(np.minimum, gaps.values())


def one(value: Value) -> float:
    """Number of a machine."""
    return float(np.ravel(value)[0])


def narrowest(gaps: Gaps) -> str:
    """Name of the least gap of a machine."""
    return min(gaps, key=lambda name: one(gaps[name]))


def between(one: tuple[Value, Value], other: tuple[Value, Value]) -> Value:
    """Distance of the faces of two parts along the camshaft, m; negative where they overlap.

    Each by its middle and half of its length.
    """
    apart: Value = np.abs(one[0] - other[0]) - one[1] - other[1]
    return apart


def aside(numbers: Numbers) -> Value:
    """Offset of the middle of the follower from that of the cam, m."""
    offset = numbers.get("roller.axial_offset")
    return 0.0 if offset is None else offset


def _on_the_shaft(numbers: Numbers) -> dict[str, tuple[Value, Value]]:
    """Middle and half width along the camshaft, m, of the cam and of the follower, by name; with
    pin and fork as far as they are described.
    """
    case = numbers.known_case
    at, follower = camshaft_of(case).cam_position, case.facing
    name = follower.word if follower.parts.get("fork") is None else "fork"
    half = numbers["follower.half_depth"] + aside(numbers)
    return {"cam": (at, 0.5 * numbers["cam.width"]), name: (at, half)}


def _gear(numbers: Numbers) -> tuple[float, float]:
    """Middle and half width of the gear along the camshaft, m."""
    shaft = camshaft_of(numbers.known_case)
    return shaft.gear_position, 0.5 * gear_of(shaft).width


def _pairs_at_bearings(numbers: Numbers) -> dict[str, tuple[tuple[Value, Value], float]]:
    """Middle and half width of each part on the camshaft, and the place of a bearing, m, by the
    names of both.
    """
    case, parts = numbers.known_case, _on_the_shaft(numbers)
    shaft = camshaft_of(case)
    if shaft.gear is not None and case.scope.covers("gear"):
        parts |= {"gear": _gear(numbers)}
    places = {1: 0.0, 2: shaft.bearing_spacing}
    return {
        f"{name} to bearing {number}": (part, position)
        for number, position in places.items()
        for name, part in parts.items()
    }


def _beside_bearings(numbers: Numbers) -> Gaps:
    """Gaps beside bearings of no width, m."""
    pairs = _pairs_at_bearings(numbers)
    return {name: between(part, (position, 0.0)) for name, (part, position) in pairs.items()}


def _with_bearings(gap: Value, numbers: Numbers) -> Value:
    """Gap (...), m, beside bearings as wide as stated, of `gap` beside bearings of no width;
    without a stated width by bounds of it, NaN where these do not decide.
    """
    shaft, limit = camshaft_of(numbers.known_case), numbers.limit(ASSEMBLY_GAP)
    if shaft.bearing_width is not None:
        return gap - 0.5 * shaft.bearing_width
    # Ball bearings of the dimension series 02 and 03 are narrower than their bore from 12 mm.
    widest = np.nan if shaft.widest is None else shaft.widest
    return decided(gap - 0.5 * widest, gap, limit)


def _of_bearings(demand: Demand, solution: Solution) -> Demand:
    """Demand with the part nearest to a bearing and the numbers of the gap, or the missing width of
    the bearings.
    """
    shaft = camshaft_of(solution.machine)
    if demand.value is None or isnan(demand.value):
        lacks = () if shaft.bearing_width is not None else ("camshaft.bearing_width",)
        return replace(demand, at=None, missing=lacks)
    how, taken = "", shaft.bearing_width
    if taken is None:
        taken = shaft.widest
        wide = "" if taken is None else shown(taken, "mm")
        how = f", bearings taken as {wide} wide, as their bore, an upper bound"
        if demand.allowed is not None and demand.value < demand.allowed:
            how, taken = ", even with bearings of no width", 0.0
    nearest = narrowest(_beside_bearings(solution.numbers))
    (middle, half), position = _pairs_at_bearings(solution.numbers)[nearest]
    stated = {"z_i": one(middle), "z_b": position, "w_i": 2.0 * one(half), "B": taken or 0.0}
    return replace(demand, at=None, note=f"{nearest}{how}", stated=stated)


@check(
    ASSEMBLY_GAP,
    title="Axial gap beside the camshaft bearings",
    tier=Tier.SCREENING,
    formula="min |z_i - z_b| - (w_i + B)/2 >= g; z_i, w_i: place and width along the camshaft of"
    " cam, gear, and roller with pin and fork, or face, z_b, B: place and width of a bearing,"
    " camshaft.bearing_width, else at most camshaft.diameter, g: limits.assembly_gap",
    symbols=dict.fromkeys(("z_i", "z_b", "w_i", "B"), f"{STATED} [mm]"),
    reason="Cam, gear or follower within a bearing cannot be assembled.",
    method="distance of the faces of cam, gear and follower from those of both bearings; the"
    " follower is not passed over a bearing, whose housing is not in the case",
    moved_by_tolerance=False,
    part="camshaft",
    load_cases=NONE,
    levers=(levers.Scaled(("camshaft.bearing_spacing", "camshaft.cam_position"), 1),),
    page="Camshaft",
).measured("case", value=_with_bearings, remark=_of_bearings, deviation=1e-9)
def bearing_gap(cam: LoadedCam) -> Array:
    """Least axial gap of a camshaft bearing, taken without width, to cam, gear or follower, m."""
    return np.asarray(least_of(_beside_bearings(cam.numbers)))


def _beside_gear(numbers: Numbers) -> Gaps:
    gear = _gear(numbers)
    return {f"{name} to gear": between(part, gear) for name, part in _on_the_shaft(numbers).items()}


def _named(gaps: Callable[[Numbers], Gaps]) -> Callable[[Demand, Solution], Demand]:
    """Function that adds the names of the parts with the least of these gaps to a demand."""

    def remark(demand: Demand, solution: Solution) -> Demand:
        known = demand.value is not None
        return replace(demand, at=None, note=narrowest(gaps(solution.numbers)) if known else "")

    return remark


@check(
    ASSEMBLY_GAP,
    title="Axial gap between the driving gear and cam or {follower}",
    tier=Tier.SCREENING,
    formula="|z_g - z_c| - (w_g + w)/2 >= g; z_g, z_c: places of gear and cam on the camshaft, w_g:"
    " width of gear and pinion, w: width of cam, or of roller with pin and fork, or face, g:"
    " limits.assembly_gap",
    symbols={
        "z_g": "camshaft.gear_position",
        "z_c": "camshaft.cam_position",
        "w_g": "camshaft.gear.width",
        "w": "max(cam.width, 2 (follower.half_depth + roller.axial_offset)) [mm]",
    },
    reason="A cam or follower in the plane of gear and pinion strikes them.",
    method="distance of the faces along the camshaft; gear and pinion in one plane",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    levers=(levers.one("camshaft.gear.width", -1, 2.0),),
    page="Camshaft",
).measured("case", remark=_named(_beside_gear), deviation=1e-9)
def gear_gap(cam: LoadedCam) -> Array:
    """Least axial gap between gear or pinion and cam or follower, m."""
    return np.asarray(least_of(_beside_gear(cam.numbers)))


_RATIO = 1e-5  # of one written as a decimal number


def _teeth_needed(numbers: Numbers) -> Value:
    """Teeth of the gear by those of the pinion and the ratio of the mechanism."""
    gear = gear_of(camshaft_of(numbers.known_case))
    return numbers["mechanism.gear_ratio"] * gear.pinion_teeth


def _of_teeth(demand: Demand, solution: Solution) -> Demand:
    """Demand with the numbers of teeth that the ratio needs, where they differ."""
    gear, ratio = gear_of(camshaft_of(solution.machine)), solution.machine.gear_ratio
    needed = float(_teeth_needed(solution.numbers))
    note = f"camshaft.gear.teeth = {gear.teeth}, {shown(needed, '')} at mechanism.gear_ratio ="
    note += f" {shown(ratio, '')} and camshaft.gear.pinion_teeth = {gear.pinion_teeth}"
    off = demand.value is not None and not demand.value <= _RATIO
    return replace(demand, at=None, note=note if off else "")


@check(
    title="Ratio of the teeth vs. ratio of the mechanism",
    unit="-",
    source=Source("kinematics of gear and pinion", confirmed=True),
    tier=Tier.SCREENING,
    method="teeth of the gear over those that the ratio needs, less 1",
    formula="|z/(i z_p) - 1| <= 1e-5; z, z_p: camshaft.gear.teeth and pinion_teeth, i:"
    " mechanism.gear_ratio",
    symbols={
        "z": "camshaft.gear.teeth",
        "z_p": "camshaft.gear.pinion_teeth",
        "i": "mechanism.gear_ratio",
    },
    reason="With other teeth the cam turns at another speed than all loads are computed at.",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    page="Camshaft",
).measured("case", allowed=lambda _: Allowed(_RATIO), remark=_of_teeth, deviation=1e-9)
def tooth_ratio(cam: LoadedCam) -> Array:
    """Relative deviation of the tooth ratio from the ratio of the mechanism."""
    gear = gear_of(camshaft_of(cam.numbers.known_case))
    return np.asarray(np.abs(gear.teeth / _teeth_needed(cam.numbers) - 1.0))


_TEETH_MIN = 14.0  # of full depth at 20 deg without profile shift; 17.1 in theory


def _fewest(numbers: Numbers) -> Allowed:
    """Least number of teeth of full depth without undercut at the pressure angle of the gear."""
    angle = sin(camshaft_of(numbers.known_case).pressure_angle)
    least = _TEETH_MIN * (sin(radians(20.0)) / angle) ** 2 * (1.0 - ROUNDING) if angle else None
    return Allowed(least)


def _with_module(demand: Demand, solution: Solution) -> Demand:
    shaft = camshaft_of(solution.machine)
    module = shown(2.0 * shaft.gear_radius / gear_of(shaft).teeth, "mm")
    return replace(demand, at=None, note=f"module {module}")


@check(
    title="Least number of teeth against undercut",
    unit="-",
    sense="at_least",
    source=Source(
        "14 teeth of 20 deg, practical limit of unshifted full-depth teeth, whose undercut from"
        " 17 teeth down does no harm yet, Roloff/Matek, gears, read second-hand in inggo,"
        " Maschinenelemente, Grenzzaehnezahl",
        confirmed=False,
    ),
    tier=Tier.SCREENING,
    method="fewer teeth of gear and pinion; the limit as 1/sin^2 of the pressure angle",
    formula="min(z_1, z_2) >= 14 (sin(20 deg)/sin(alpha))^2; z: teeth of gear and pinion, alpha:"
    " camshaft.pressure_angle",
    symbols={
        "z_1": "camshaft.gear.teeth",
        "z_2": "camshaft.gear.pinion_teeth",
    },
    reason="Undercut teeth are thinner at the root than their strength is judged, and mesh less.",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    page="Camshaft",
).measured("case", worst="least", allowed=_fewest, remark=_with_module, deviation=1e-9)
def tooth_count(cam: LoadedCam) -> Array:
    """Smaller tooth number of gear and pinion."""
    gear = gear_of(camshaft_of(cam.numbers.known_case))
    return np.array([float(min(gear.teeth, gear.pinion_teeth))])


def from_follower(numbers: Numbers, below: Value, aside: Value) -> Value:
    """Distance of a point from the follower (m): negative within it and anywhere above it.

    The follower goes on above its roller or face, as wide as it or as the cheeks of the fork.

    below : its distance below the reference point, >= 0; aside : from the axis, >= 0
    """
    beyond = np.maximum(aside - numbers["follower.half_flat"], 0.0)
    away: Value = np.hypot(below, beyond) - numbers["follower.round"]
    return away


def _to_follower(numbers: Numbers, along: float, across: float) -> Value:
    """Distance of a point from the follower at its lowest, m; the worse side of an offset."""
    prime, offset = numbers["cam.prime_radius"], numbers["cam.offset"]
    below = np.maximum(np.sqrt(prime**2 - offset**2) - along, 0.0)
    return least_of(
        {
            side: from_follower(numbers, below, np.abs(across + sign * offset))
            for side, sign in (("left", 1.0), ("right", -1.0))
        }
    )


def centre_distance(shaft: Camshaft) -> float:
    """Distance of camshaft and machine shaft, m: pitch radii of gear and pinion."""
    gear = gear_of(shaft)
    return shaft.gear_radius * (1.0 + gear.pinion_teeth / gear.teeth)


def machine_shaft_axis(shaft: Camshaft) -> tuple[float, float]:
    """Place of the machine shaft along and across the follower axis, m, against the cam's turn."""
    centre = centre_distance(shaft)
    return centre * cos(shaft.mesh_angle), -centre * sin(shaft.mesh_angle)


def room_beside_shaft(machine: Machine) -> float | None:
    """Greatest cam radius that clears the machine shaft, m; None without a gear within the scope,
    and where the diameter of the machine shaft is not stated or 0.
    """
    shaft = machine.camshaft
    if shaft is None or shaft.gear is None or not machine.scope.covers("gear"):
        return None
    diameter = shaft.gear.machine_shaft_diameter
    if not diameter:
        return None
    return centre_distance(shaft) - 0.5 * diameter - machine.limits[ASSEMBLY_GAP]


_DIAMETER = "camshaft.gear.machine_shaft_diameter"


def _beside_shaft(tip: Value, numbers: Numbers) -> Gaps:
    """Distances of cam, with its maximum radius `tip`, m, and follower from the axis of the machine
    shaft, m, by name.
    """
    case = numbers.known_case
    shaft = camshaft_of(case)
    axis, gaps = machine_shaft_axis(shaft), {"cam": centre_distance(shaft) - tip}
    if case.follower.arm is None:
        return gaps | {case.facing.word: _to_follower(numbers, *axis)}
    swung = swung_bodies(numbers)
    return gaps | {name: each.from_disc(*axis, 0.0) for name, each in swung.items()}


def _with_shaft(tip: Value, numbers: Numbers) -> Value:
    """Gap (...), m, beside a machine shaft of the stated diameter; else by bounds of its radius,
    NaN where these do not decide.
    """
    room, stated = least_of(_beside_shaft(tip, numbers)), numbers.get(_DIAMETER)
    if stated is not None:
        return room - 0.5 * stated
    shaft = camshaft_of(numbers.known_case)
    pinion = centre_distance(shaft) - shaft.gear_radius
    return decided(room - pinion, room, numbers.limit(ASSEMBLY_GAP))


def _of_shaft(demand: Demand, solution: Solution) -> Demand:
    """Demand with the part nearest to the machine shaft and the numbers of the gap, or the missing
    diameter of the shaft.
    """
    numbers, limit = solution.numbers, solution.machine.limits[ASSEMBLY_GAP]
    shaft, tip = camshaft_of(solution.machine), solution.greatest_radius
    stated = gear_of(shaft).machine_shaft_diameter
    numbers = numbers | with_swing(solution.cams.values())
    gaps = _beside_shaft(tip, numbers)
    if demand.value is None or isnan(demand.value):
        if stated is not None or isnan(tip):
            return demand
        most = shown(float(np.ravel(least_of(gaps))[0]) - limit, "mm")
        note = f"at most a radius of {most}; 0 mm if it ends at its pinion"
        return replace(demand, missing=(_DIAMETER,), note=note)
    centre = shown(centre_distance(shaft), "mm")
    how, thin = "", demand.value < limit
    if stated is None:
        how = ", even with a shaft of no diameter" if thin else ", the shaft as wide as its pinion"
    words = f"{narrowest(gaps)} to machine shaft, centre distance {centre}{how}"
    radius = 0.5 * (stated or 0.0)
    if stated is None and not thin:
        radius = centre_distance(shaft) - shaft.gear_radius
    numbers_of_gap = {
        "a": centre_distance(shaft),
        "b": min((one(gap) for name, gap in gaps.items() if name != "cam"), default=np.inf),
        "r": radius,
    }
    return replace(demand, at=None, note=words, stated=numbers_of_gap)


machine_shaft_gap = check(
    ASSEMBLY_GAP,
    id="machine_shaft_gap",
    title="Gap between cam or {follower} and the machine shaft",
    tier=Tier.SCREENING,
    formula="min(a - max|P|, b) - r >= g; a: centre distance, gear and pinion radius, P: contour,"
    " b: distance of the machine shaft, at camshaft.mesh_angle, from the follower at its lowest, of"
    " an arm from arm, hub, fork, roller and linked spring over the swing, r:"
    " half of camshaft.gear.machine_shaft_diameter, else at most the pinion radius, g:"
    " limits.assembly_gap; none where the diameter is 0, as the shaft ends at its pinion",
    symbols={
        **dict.fromkeys(("a", "b", "r"), f"{STATED} [mm]"),
        "P": "contour_radius_greatest",
    },
    reason="A cam that strikes the machine shaft does not turn.",
    method="centre distance less maximum contour radius, and distance from roller or face with"
    " fork, less the radius of the machine shaft",
    lift_can_help=True,
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    levers=(levers.one("cam.prime_radius", -1, 2.0), *levers.GENTLER),
    closed_by="plate",
    page="Camshaft",
).measured(
    "contour",
    value=_with_shaft,
    applies=lambda _, numbers: np.array(numbers.get(_DIAMETER) != 0.0),
    known=with_swing,
    remark=_of_shaft,
    deviation=1e-4,
)(contour_radius)


@check(
    ASSEMBLY_GAP,
    id="groove_shaft_gap",
    title="Gap between the disc of a groove or {follower} and the machine shaft",
    tier=Tier.SCREENING,
    formula="min(a - R, b) - r >= g; a: centre distance, gear and pinion radius, R:"
    " cam.groove.outer_radius, b: distance of the machine shaft, at camshaft.mesh_angle, from the"
    " follower at its lowest, of an arm from arm, hub, fork, roller and linked spring over the"
    " swing, r: half of camshaft.gear.machine_shaft_diameter, else at most the pinion radius, g:"
    " limits.assembly_gap; none where the diameter is 0, as the shaft ends at its pinion",
    symbols={**dict.fromkeys(("a", "b", "r"), f"{STATED} [mm]"), "R": "cam.groove.outer_radius"},
    reason="A disc that strikes the machine shaft does not turn.",
    method="centre distance less the radius of the disc, and distance from the roller with fork,"
    " less the radius of the machine shaft",
    moved_by_tolerance=False,
    part="gear",
    needs="roller",
    closed_by="groove",
    load_cases=NONE,
    levers=(levers.one("cam.groove.outer_radius", -1, 1.5),),
    page="Camshaft",
).measured(
    "case",
    value=_with_shaft,
    applies=lambda _, numbers: np.array(numbers.get(_DIAMETER) != 0.0),
    known=with_swing,
    remark=_of_shaft,
    deviation=1e-4,
)
def groove_shaft_gap(cam: LoadedCam) -> Array:
    """Radius of the disc around the groove, m."""
    return np.asarray(cam.numbers["cam.groove.outer_radius"])


_WEIGHT = "camshaft.counterweight"
_COUNTERWEIGHT = f"{_WEIGHT}.radius", f"{_WEIGHT}.width"


def _lowest_part(numbers: Numbers) -> str:
    """Part of the follower above a counterweight: the fork, else roller or face."""
    follower = numbers.known_case.facing
    return follower.word if follower.parts.get("fork") is None else "fork"


def beside_counterweight(body: CounterweightBody, numbers: Numbers) -> Gaps:
    """Gaps (...) of a counterweight from bearings, gear, follower and machine shaft, m, by name.

    Bearings are as wide as stated, else at most as their bore. The cam carries it.
    """
    case = numbers.known_case
    shaft = camshaft_of(case)
    wide = shaft.bearing_width if shaft.bearing_width is not None else shaft.widest
    half = np.nan if wide is None else 0.5 * wide
    gaps: dict[str, Value] = {}
    for number, bearing in enumerate((0.0, shaft.bearing_spacing), 1):
        at = bearing - shaft.cam_position
        gaps[f"bearing {number}"] = body.beyond(at - half, at + half)
    deep = numbers["follower.half_depth"] + aside(numbers)
    swung = swung_bodies(numbers)
    spring = swung.pop(SPRING, None)
    for each in swung.values():
        deep = np.fmax(deep, each.beside[0] + each.beside[1])
    gaps[_lowest_part(numbers)] = body.under(deep, lowest_follower(numbers, swung))
    if spring is not None:
        gaps["spring"] = body.under(sum(spring.beside), spring.from_disc(0.0, 0.0, 0.0))
    if shaft.gear is None or not case.scope.covers("gear"):
        return gaps
    gear, half = _gear(numbers)
    at = gear - shaft.cam_position
    gaps["gear"] = body.beyond(at - half, at + half)
    if diameter := shaft.gear.machine_shaft_diameter:
        gaps["machine shaft"] = centre_distance(shaft) - 0.5 * diameter - body.radius
    return gaps


def counterweight_room(body: CounterweightBody, weight: Counterweight, numbers: Numbers) -> Value:
    """Least gap of a counterweight (...), m; NaN where it is below its limit and the size is not
    stated but taken as a bound.
    """
    gap = least_of(beside_counterweight(body, numbers))
    if weight.radius is not None and weight.width is not None:
        return gap
    return np.where(np.asarray(gap) >= numbers.limit(ASSEMBLY_GAP), gap, np.nan)


def _balancing(solution: Solution) -> tuple[Counterweight, float, CounterweightBody] | None:
    """Counterweight, its unbalance, kg m, and the body of it; None without one."""
    weight = camshaft_of(solution.machine).counterweight
    if weight is None:
        return None
    product = weight.set_against(balance(solution.machine.cam, solution.contour).as_made)[0]
    numbers = solution.numbers | with_swing(solution.cams.values())
    return weight, product, counterweight_body(weight, product, numbers)


@check(
    ASSEMBLY_GAP,
    title="Gap between the counterweight and bearings, gear, {follower} or machine shaft",
    formula="min(b, f, c, m) >= g; b: axial gap of the counterweight from the nearer bearing, f:"
    " distance from the follower at its lowest, and from a spring that links its arm, c: axial gap"
    " from gear and pinion, m: distance from the machine shaft; of the stated radius and width,"
    " else of a half ring that has the unbalance and passes below the follower by 2 g, g:"
    " limits.assembly_gap",
    symbols=dict.fromkeys("bfcm", f"{STATED} [mm]"),
    reason="A counterweight that strikes bearing, gear or follower does not turn; one that has no"
    " room leaves the unbalance.",
    method="faces and outer radius of a ring about the camshaft over the whole turn; it may rest on"
    " the cam",
    moved_by_tolerance=False,
    tier=Tier.SCREENING,
    part="camshaft",
    load_cases=NONE,
    values=("cam.material.density", "camshaft.material.density"),
    levers=(
        levers.Scaled(
            ("camshaft.bearing_spacing", "camshaft.cam_position", f"{_WEIGHT}.position"), 1
        ),
    ),
    page="Camshaft",
)
def counterweight_gap(solution: Solution) -> Demand | None:
    """Least gap of the counterweight from other parts, m; None without one."""
    bodies, limit = _balancing(solution), solution.machine.limits[ASSEMBLY_GAP]
    if bodies is None:
        return None
    weight, _, body = bodies
    numbers = solution.numbers | with_swing(solution.cams.values())
    gaps = beside_counterweight(body, numbers)
    room = one(counterweight_room(body, weight, numbers))
    sizes = tuple(shown(one(each), "mm", 3) for each in (body.radius, body.width))
    taken = weight.radius is None or weight.width is None
    words = f"half ring of {sizes[0]} outer radius, {sizes[1]} wide" if taken else ""
    if isnan(room):
        sized = zip(_COUNTERWEIGHT, (weight.radius, weight.width), strict=True)
        missing = tuple(key for key, size in sized if size is None)
        shaft = camshaft_of(solution.machine)
        if shaft.bearing_width is None and shaft.widest is None:
            missing = (*missing, "camshaft.bearing_width")
        narrow = narrowest(gaps) if body.width > 0.0 else "no room about the shaft"
        return Demand(None, limit, missing=missing, note=f"{words}: {narrow}")
    apart = {name: one(gap) for name, gap in gaps.items()}
    stated = {
        "b": min(gap for name, gap in apart.items() if name.startswith("bearing")),
        "f": min(apart[_lowest_part(numbers)], apart.get("spring", np.inf)),
        "c": apart.get("gear", np.inf),
        "m": apart.get("machine shaft", np.inf),
    }
    note = f"{narrowest(gaps)}{f'; taken as a {words}' if taken else ''}"
    return Demand(room, limit, note=note, stated=stated)


@check(
    title="Unbalance of the counterweight vs. that of a half ring of its size",
    unit="g mm",
    source=Source("first moment of a half ring", confirmed=True),
    formula="U <= 2/3 rho (R^3 - a^3) b; U: unbalance that the counterweight has, rho: density of"
    " the camshaft, R, a: outer radius, and bore of the cam, b: width beside the cam",
    symbols={
        "U": f"{STATED} [g mm]",
        "rho": f"{STATED} [kg/m^3]",
        **dict.fromkeys("Rab", f"{STATED} [mm]"),
    },
    reason="A counterweight of more unbalance than its size can have leaves the rest to shaft,"
    " bearings and frame.",
    method="half ring of steel, in which a sector has the unbalance; made where its width is"
    " stated",
    moved_by_tolerance=False,
    tier=Tier.SCREENING,
    part="camshaft",
    load_cases=NONE,
    values=("cam.material.density", "camshaft.material.density"),
    levers=(levers.one(_COUNTERWEIGHT[1]), levers.one(_COUNTERWEIGHT[0])),
    page="Camshaft",
)
def counterweight_unbalance(solution: Solution) -> Demand | None:
    """Unbalance that the counterweight must have, kg m, against that of a body of its size; None
    without one, or without its width.
    """
    bodies = _balancing(solution)
    if bodies is None or bodies[0].width is None:
        return None
    _, product, body = bodies
    capacity = one(body.capacity)
    stated = {
        "U": product,
        "rho": density_of_counterweight(solution.case),
        "R": one(body.radius),
        "a": float(solution.numbers["cam.bore_radius"]),
        "b": one(body.beside),
    }
    note = "" if capacity > 0.0 else "no room about the shaft"
    return Demand(product, capacity if capacity > 0.0 else 0.0, note=note, stated=stated)


def shaft_radius(numbers: Numbers, place: Value = 0.0) -> Value:
    """Greatest radius of the camshaft beside the cam (...), m, within the width of the follower;
    that of the bore without a diameter.

    place : of the middle of the disc from that of the first one, m
    """
    shaft, radius = numbers.known_case.camshaft, numbers["cam.bore_radius"]
    if shaft is None:
        return radius
    half = numbers["follower.half_depth"] + aside(numbers)
    radius = np.maximum(radius, 0.5 * (shaft.diameter or 0.0))
    for each in shaft.sections:
        beside = np.abs(each.position - shaft.cam_position - place) <= half
        radius = np.where(beside, np.maximum(radius, 0.5 * each.diameter), radius)
    return radius


_HEIGHT, _LENGTH = "roller.fork.cheek_height", "roller.fork.cheek_length"


def _of_thickness(demand: Demand, solution: Solution) -> Demand:
    """Demand with the thickness that is taken for the shaft."""
    thick = shown(2.0 * float(np.ravel(shaft_radius(solution.numbers))[0]), "mm")
    words = "" if demand.value is None else f"shaft taken as {thick} thick"
    return replace(demand, at=None, note=words)


@check(
    ASSEMBLY_GAP,
    title="Gap between fork and camshaft",
    tier=Tier.SCREENING,
    formula="r_p - h/2 - d/2 >= g; r_p: cam.prime_radius, the least distance of the roller centre"
    " from the cam axis, h: roller.fork.cheek_height, d: diameter of the camshaft beside the cam,"
    " at least its bore, g: limits.assembly_gap",
    symbols={
        "r_p": "cam.prime_radius",
        "h": "roller.fork.cheek_height",
        "d": "2 cam.bore_radius [mm]",
    },
    reason="Cheeks that reach the shaft stop the follower before it is down.",
    method="roller centre at the least lift less half of the cheek height, the end of the cheeks"
    " round about the pin, and the radius of the shaft",
    moved_by_tolerance=False,
    needs="roller",
    part="fork",
    load_cases=NONE,
    levers=(levers.one("roller.fork.cheek_height", -1), levers.PRIME),
    page="Roller",
).measured("case", needed=(_HEIGHT,), remark=_of_thickness, deviation=1e-9)
def fork_shaft_gap(cam: LoadedCam) -> Array:
    """Least gap between the cheeks of the fork and the camshaft, m."""
    numbers = cam.numbers
    return np.asarray(numbers["cam.prime_radius"] - 0.5 * numbers[_HEIGHT] - shaft_radius(numbers))


def _inner_face(numbers: Numbers) -> float:
    """Inner face of a cheek from the middle of the roller, m."""
    roller = numbers.known_case.roller
    pin, fork = roller.pin, roller.fork
    if pin is None or fork is None:
        raise InputError("roller.fork", "missing", "described with its pin for its checks")
    return fork.faces(pin)[0]


def cheek_to_cam(numbers: Numbers) -> Value:
    """Axial gap between a cheek and the cam, m.

    Raises
    ------
    InputError
        If the case has no fork or no pin.
    """
    return _inner_face(numbers) - 0.5 * numbers["cam.width"] - aside(numbers)


def _in_fork(numbers: Numbers) -> Gaps:
    """Gaps of cheeks and bridge from roller and cam, m."""
    inner, radius, width = _inner_face(numbers), numbers["roller.radius"], numbers["roller.width"]
    other = numbers.get("cam.conjugate.roller_radius")
    other = radius if other is None else other
    least, largest = np.minimum(radius, other), np.maximum(radius, other)
    to_cam = np.where(0.5 * numbers[_HEIGHT] > least, cheek_to_cam(numbers), np.inf)
    groove = numbers.known_case.cam.groove
    nearest: Value = inner
    if groove is not None:
        second = groove.second and numbers.of_part(groove.second)
        to_cam = np.asarray(inner - numbers.of_part(groove).middle(radius, width, second))
        if second is not None:
            nearest = inner + np.minimum(second.beyond(radius), 0.0)
            largest = np.maximum(radius, second.radius)
    return {
        "cheek to roller": nearest - 0.5 * width,
        "bridge to roller": numbers[_LENGTH] - largest,
        "cheek to cam": to_cam,
    }


@check(
    ASSEMBLY_GAP,
    title="Gap between fork and roller or cam",
    tier=Tier.SCREENING,
    formula="min(f - w/2, l - r, f - step(h/2 - r) (b/2 + x)) >= g; f: inner face of a cheek from"
    " the middle of the roller, (span - cheek_width)/2 of a straddled pin, span of an overhung one,"
    " w, r: width and radius of the roller, of a pair the worse, l: roller.fork.cheek_length, h:"
    " cheek_height, beside the cam where h/2 > r, b: width of the cam, x: roller.axial_offset, g:"
    " limits.assembly_gap",
    symbols={
        "?": "roller.pin.mounting straddled; cam.groove None; cam.conjugate None",
        "h": "roller.fork.cheek_height",
        "f": "(roller.pin.span - roller.fork.cheek_width)/2 [mm]",
        "w": "roller.width",
        "l": "roller.fork.cheek_length",
        "r": "roller.radius",
        "b": "cam.width",
        "x": "roller.axial_offset",
    },
    reason="A roller that rubs in its fork does not turn; cheeks beside the cam strike it.",
    method="faces of the cheeks from roller and cam, and bridge from roller",
    moved_by_tolerance=False,
    needs="roller",
    part="fork",
    load_cases=NONE,
    levers=(levers.one("roller.pin.span", most=2.0), levers.one("roller.fork.cheek_length")),
    page="Roller",
).measured("case", needed=(Pin.table, _HEIGHT, _LENGTH), remark=_named(_in_fork), deviation=1e-9)
def fork_gap(cam: LoadedCam) -> Array:
    """Least gap between the fork and roller or cam, m."""
    return np.asarray(least_of(_in_fork(cam.numbers)))


def _layout(lift: Value, numbers: Numbers) -> StemLayout:
    """Guides, stem and coil spring at a maximum lift, with the spring at its least preload."""
    return stem_layout(lift, numbers, numbers["spring.preload_least"])


_SEAT = "spring.seat_height", "spring.seat_thickness"


def _of_seat(demand: Demand, solution: Solution) -> Demand:
    """Demand with the place of the moving spring seat, or the keys that the case lacks to decide
    the gap.
    """
    numbers = solution.numbers
    layout = _layout(solution.contour.lift.highest.value, numbers)
    limit, height, thickness = numbers.limit(ASSEMBLY_GAP), *(numbers.get(key) for key in _SEAT)
    if demand.value is None or isnan(demand.value):
        open_end = bool(np.isnan(layout.seated(0.0, limit, height).gap).all())
        lacks = {"follower.stem_length": open_end, _SEAT[1]: not open_end}
        keys = (key for key, lacked in lacks.items() if lacked and numbers.get(key) is None)
        return replace(demand, at=None, missing=tuple(keys))
    taken, how = thickness, ""
    if taken is None:
        taken = 0.0 if float(demand.value or 0.0) < limit else SEAT_MOST * layout.stem_diameter
        how = f", taken as {shown(float(taken), 'mm')} thick, an upper bound"
        how = ", even of no thickness" if taken == 0.0 else how
    seat = layout.seated(taken, limit, height)
    high, below = one(seat.height), one(layout.guide_a[1])
    where = f"moving seat at {shown(high, 'mm')}"
    between = high <= one(layout.guide_b[0]) and below < high
    stated = {"s": high, "t": float(taken), "a": below} if between else {}
    return replace(demand, at=None, note=f"{where} at maximum lift{how}", stated=stated)


def _seat_gap(lift: Value, numbers: Numbers) -> Value:
    """Least clearance of spring and seats from guides and stem, m; NaN: not known."""
    height, thickness = (numbers.get(key) for key in _SEAT)
    return _layout(lift, numbers).known_gap(thickness, numbers.limit(ASSEMBLY_GAP), height)


def _room_of_gas(lift: Value, numbers: Numbers) -> Value:
    """Lesser clearance (...), m, at a lift (...), m, of the rod of a gas spring from guide B and of
    its piston from the end of the gas column.
    """
    top = numbers["follower.overhang_at_max_lift"] + numbers["guides.spacing"]
    stem = numbers.get("follower.stem_length")
    over = (np.nan if stem is None else stem) - lift - top - 0.5 * numbers["guides.b.length"]
    left = numbers["spring.gas.volume"] / numbers["spring.gas.area"] - lift
    return np.minimum(over, left)


spring_gap = check(
    ASSEMBLY_GAP,
    id="spring_gap",
    title="Gap between the spring with its seats and guides or stem",
    tier=Tier.SCREENING,
    formula="min(s - h - t - a, (D - d - d_s)/2) >= g; between the guides s: height of the moving"
    " seat over roller centre or face at maximum lift, spring.seat_height, else b - L + h, under"
    " guide B, h: maximum lift, t: spring.seat_thickness, else at most d_s/2, a, b: upper end of"
    " guide A, lower end of guide B, L: L_0 - P/k, length of the spring at zero lift, D, d: mean"
    " and wire diameter, d_s: of the stem, or outer diameter of a guide that the coils pass around;"
    " else above guide B, s - h - t - c >= g, c: its upper end, s: at most follower.stem_length; g:"
    " limits.assembly_gap",
    symbols={
        **dict.fromkeys(("s", "t", "a"), f"{STATED} [mm]"),
        "h": "lift_highest",
        "D": "spring.design.mean_diameter",
        "d": "spring.design.wire_diameter",
        "d_s": "follower.stem_diameter",
    },
    reason="A spring or seat within a guide cannot be assembled, or stops the follower.",
    method="seats and spring, longest at the least preload, from the ends of the guides at zero"
    " lift, and coils from the stem; the length at maximum lift is that of spring_coil_gap",
    moved_by_tolerance=False,
    part="spring",
    needs="stem",
    load_cases=NONE,
    values=("spring.rate", "spring.preload"),
    levers=(
        levers.Scaled(("guides.spacing", "follower.stem_length"), 1, 2.0),
        levers.one("follower.stem_length", most=2.0),
    ),
    page="Spring",
).measured("top", value=_seat_gap, remark=_of_seat, deviation=1e-4)(lift)


def _beside_coil(lift: Value, numbers: Numbers) -> tuple[Value, Value]:
    """Gaps (...) of the coil of a torsion spring from the stem and from the guides, m, at a lift
    (...), m.

    Where `spring.seat_height` does not state the height of its pin, at the worst height.
    """

    def of(key: str) -> Value:
        return numbers[f"spring.torsion.{key}"]

    angle, wire = of("arm_angle"), numbers.get("spring.torsion.wire_diameter")
    mean = numbers.get("spring.torsion.mean_diameter")
    radius = np.nan if wire is None or mean is None else 0.5 * (mean + wire)
    away, stem = of("arm") * np.cos(angle), numbers.get("follower.stem_diameter")
    height = numbers.get("spring.seat_height")
    middle, gaps = numbers["follower.overhang_at_max_lift"], list[Value]()
    for side in "ab":
        half = 0.5 * numbers[f"guides.{side}.length"]
        beyond: Value = 0.0
        if height is not None:
            coil = height - lift - of("arm") * np.sin(angle)
            beyond = np.maximum(np.abs(coil - middle) - half, 0.0)
        aside = np.maximum(away - 0.5 * guide_outer(side, numbers), 0.0)
        gaps.append(np.hypot(aside, beyond) - radius)
        middle = middle + numbers["guides.spacing"]
    return away - radius - 0.5 * (np.nan if stem is None else stem), reduce(np.minimum, gaps)


def _torsion_gap(lift: Value, numbers: Numbers) -> Value:
    """Least gap of the coil (...), m, at a lift (...), m; NaN where it depends on a place of the
    coil that is not stated.
    """
    stem, guides = _beside_coil(lift, numbers)
    least = np.minimum(stem, guides) + 0.0 * lift
    if numbers.get("spring.seat_height") is not None:
        return least
    return decided(least, stem, numbers.limit(ASSEMBLY_GAP))


_OF_COIL = (
    *("spring.torsion.wire_diameter", "spring.torsion.mean_diameter", "follower.stem_diameter"),
    *("guides.a.wall", "guides.b.wall"),
)


def _of_coil(demand: Demand, solution: Solution) -> Demand:
    """Demand with the nearest part and both gaps of the coil, or its missing keys."""
    numbers = solution.numbers
    if demand.value is None or isnan(demand.value):
        lacks = tuple(key for key in _OF_COIL if numbers.get(key) is None)
        return replace(demand, at=None, missing=lacks or (_SEAT[0],))
    gaps = _beside_coil(solution.contour.lift.highest.value, numbers)
    stem, guides = one(gaps[0]), float(np.fmax(one(gaps[1]), demand.value))
    note = f"coil to {'stem' if stem <= guides else 'guides'}"
    return replace(demand, at=None, note=note, stated={"a": stem, "b": guides})


torsion_gap = check(
    ASSEMBLY_GAP,
    id="torsion_gap",
    title="Gap between the torsion spring and stem or guides",
    tier=Tier.SCREENING,
    formula="min(a, b) >= g; a, b: distance of the coil from stem and guides, its axis l cos(beta)"
    " beside that of the follower, (D + d)/2 its radius, l, beta, D, d: arm, arm_angle and"
    " diameters of spring.torsion; of the guides at the height of the coil by spring.seat_height,"
    " that of its pin at maximum lift, else at the worst height; g: limits.assembly_gap",
    symbols=dict.fromkeys("ab", f"{STATED} [mm]"),
    reason="A coil within stem or guide cannot be assembled.",
    method="circle of the coil from stem and guides in the plane of the cam",
    moved_by_tolerance=False,
    part="torsion_spring",
    needs="stem",
    load_cases=NONE,
    levers=(levers.one("spring.torsion.arm", most=2.0),),
    page="Spring",
).measured("top", value=_torsion_gap, remark=_of_coil, deviation=1e-4)(lift)


gas_gap = check(
    ASSEMBLY_GAP,
    id="gas_gap",
    title="Gap of the gas spring over guide B and in its cylinder",
    tier=Tier.SCREENING,
    formula="min(l - h - c, V/A - h) >= g; l: follower.stem_length, on whose end the rod rests, h:"
    " maximum lift, c: upper end of guide B over roller centre or face at maximum lift, V, A:"
    " volume and area of spring.gas, g: limits.assembly_gap",
    symbols={
        "l": "follower.stem_length",
        "h": "lift_highest",
        "c": "follower.overhang_at_max_lift + guides.spacing + guides.b.length/2 [mm]",
        "V": "spring.gas.volume",
        "A": "spring.gas.area",
    },
    reason="A rod that strikes guide B, or a piston the end of its cylinder, stops the follower.",
    method="end of the stem over guide B at zero lift, and column of the gas left at maximum lift;"
    " the stroke that the maker permits is that of gas_stroke",
    moved_by_tolerance=False,
    part="gas_spring",
    needs="stem",
    load_cases=NONE,
    levers=(levers.one("follower.stem_length", most=2.0), levers.one("spring.gas.volume")),
    page="Spring",
).measured(
    "top",
    value=_room_of_gas,
    needed=("follower.stem_length",),
    remark=lambda demand, _: replace(demand, at=None),
    deviation=1e-4,
)(lift)
