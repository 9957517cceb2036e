"""Checks of the assembly: no part within another over the whole turn.

A spring around a guide, and a torsion spring, which stands beside the stem, are not judged.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import cos, isnan, radians, sin, sqrt
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base import levers
from camwright.pipeline.base.stem_layout import SEAT_MOST, StemLayout
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import ASSEMBLY_GAP
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks.cam_shape import lift
from camwright.pipeline.checks.camshaft_strength import camshaft_of, gear_of
from camwright.pipeline.checks.check import NONE, ROUNDING, Demand, check
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import wire_of
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.roller import Roller
from camwright.pipeline.follower.roller_parts import Fork, Pin


class _Length(NamedTuple):
    """A length of a part along the camshaft, m: its middle and half of it."""

    name: str
    middle: float
    half: float

    def gap(self, other: _Length) -> float:
        """Distance of the faces of two parts, m; negative where they overlap."""
        return abs(self.middle - other.middle) - self.half - other.half


def _fork_of(machine: Machine) -> tuple[Roller, Pin | None, Fork]:
    roller = machine.roller
    if roller.fork is None:
        raise InputError("roller.fork", "missing", "described for its checks")
    return roller, roller.pin, roller.fork


def _on_the_shaft(machine: Machine) -> tuple[_Length, ...]:
    """Cam, and follower with pin and fork as far as they are described, along the camshaft."""
    at, follower = camshaft_of(machine).cam_position, machine.follower
    name = follower.word if follower.parts.get("fork") is None else "fork"
    half = follower.half_depth + (follower.axial_offset or 0.0)
    return _Length("cam", at, 0.5 * machine.cam.width), _Length(name, at, half)


def _between(
    gap: Callable[[float], float], least: float, most: float | None, limit: float
) -> tuple[float | None, float | None]:
    """Gap (m) that a number decides of which only bounds are known, and that number.

    At the greatest number the gap is least: within the limit, it is so for every number. At the
    least one it is greatest: beyond the limit, it is so for every number. Else None.
    """
    if most is not None and not gap(most) < limit:
        return gap(most), most
    if gap(least) < limit:
        return gap(least), least
    return None, None


@check(
    ASSEMBLY_GAP,
    title="Axial gap beside the camshaft bearings",
    formula="min |z_i - z_b| - (w_i + B)/2 >= g; z_i, w_i: place and width along the camshaft of"
    " cam, gear, and roller with pin and fork, or face, z_b, B: place and width of a bearing,"
    " camshaft.bearing_width, else at most camshaft.diameter, g: limits.assembly_gap",
    reason="Cam, gear or follower within a bearing cannot be assembled.",
    method="distance of the faces of cam, gear and follower from those of both bearings; the"
    " follower is not passed over a bearing, whose housing is not in the case",
    moved_by_tolerance=False,
    part="camshaft",
    load_cases=NONE,
    levers=(levers.Scaled(("camshaft.bearing_spacing", "camshaft.cam_position"), 1),),
    page="Camshaft",
)
def bearing_gap(solution: Solution) -> Demand:
    """Least axial gap between a camshaft bearing and cam, gear or follower, m."""
    machine, limit = solution.machine, solution.machine.limits[ASSEMBLY_GAP]
    shaft = camshaft_of(machine)
    parts = list(_on_the_shaft(machine))
    if shaft.gear is not None and machine.scope.covers("gear"):
        parts.append(_Length("gear", shaft.gear_position, 0.5 * shaft.gear.width))
    places = {1: 0.0, 2: shaft.bearing_spacing}

    def gaps(width: float) -> Iterator[tuple[float, str]]:
        for number, place in places.items():
            bearing = _Length(f"bearing {number}", place, 0.5 * width)
            for part in parts:
                yield part.gap(bearing), f"{part.name} to {bearing.name}"

    stated = shaft.bearing_width
    if stated is not None:
        value, words = min(gaps(stated))
        return Demand(value, limit, note=words)
    # Ball bearings of the dimension series 02 and 03 are narrower than their bore from 12 mm.
    gap, width = _between(lambda width: min(gaps(width))[0], 0.0, shaft.widest, limit)
    if gap is None or width is None:
        return Demand(None, limit, missing=("camshaft.bearing_width",))
    how = f"bearings taken as {shown(width, 'mm')} wide, as their bore, an upper bound"
    if width == 0.0:
        how = "even with bearings of no width"
    return Demand(gap, limit, note=f"{min(gaps(width))[1]}, {how}")


@check(
    ASSEMBLY_GAP,
    title="Axial gap between the driving gear and cam or {follower}",
    formula="|z_g - z_c| - (w_g + w)/2 >= g; z_g, z_c: places of gear and cam on the camshaft, w_g:"
    " width of gear and pinion, w: width of cam, or of roller with pin and fork, or face, g:"
    " limits.assembly_gap",
    reason="A cam or follower in the plane of gear and pinion strikes them.",
    method="distance of the faces along the camshaft; gear and pinion in one plane",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    levers=(levers.one("camshaft.gear.width", -1, 2.0),),
    page="Camshaft",
)
def gear_gap(solution: Solution) -> Demand:
    """Least axial gap between gear or pinion and cam or follower, m."""
    machine = solution.machine
    shaft = camshaft_of(machine)
    gear = _Length("gear", shaft.gear_position, 0.5 * gear_of(shaft).width)
    value, name = min((part.gap(gear), part.name) for part in _on_the_shaft(machine))
    return Demand(value, machine.limits[ASSEMBLY_GAP], note=f"{name} to gear")


_RATIO = 1e-5  # of one written as a decimal number


@check(
    title="Ratio of the teeth vs. ratio of the mechanism",
    unit="-",
    source="kinematics of gear and pinion",
    method="teeth of the gear over those that the ratio needs, less 1",
    formula="|z/(i z_p) - 1| <= 1e-5; z, z_p: camshaft.gear.teeth and pinion_teeth, i:"
    " mechanism.gear_ratio",
    reason="With other teeth the cam turns at another speed than all loads are computed at.",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    page="Camshaft",
)
def tooth_ratio(solution: Solution) -> Demand:
    """Deviation of the ratio of the teeth from that of the mechanism, relative."""
    gear, ratio = gear_of(camshaft_of(solution.machine)), solution.machine.gear_ratio
    needed = ratio * gear.pinion_teeth
    note = f"camshaft.gear.teeth = {gear.teeth}, {shown(needed, '')} at mechanism.gear_ratio ="
    note += f" {shown(ratio, '')} and camshaft.gear.pinion_teeth = {gear.pinion_teeth}"
    deviation = abs(gear.teeth / needed - 1.0)
    return Demand(deviation, _RATIO, note=note if not deviation <= _RATIO else "")


_TEETH_MIN = 14.0  # of full depth at 20 deg without profile shift; 17.1 in theory


@check(
    title="Least number of teeth against undercut",
    unit="-",
    sense="at_least",
    source="14 teeth of 20 deg, practical limit of unshifted full-depth teeth, Roloff/Matek, gears:"
    " verify",
    method="fewer teeth of gear and pinion; the limit as 1/sin^2 of the pressure angle",
    formula="min(z_1, z_2) >= 14 (sin 20 deg/sin alpha)^2; z: teeth of gear and pinion, alpha:"
    " camshaft.pressure_angle",
    reason="Undercut teeth are thinner at the root than their strength is judged, and mesh less.",
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    page="Camshaft",
)
def tooth_count(solution: Solution) -> Demand:
    """Fewer of the teeth of gear and pinion."""
    shaft = camshaft_of(solution.machine)
    gear, angle = gear_of(shaft), sin(shaft.pressure_angle)
    least = _TEETH_MIN * (sin(radians(20.0)) / angle) ** 2 * (1.0 - ROUNDING) if angle else None
    module = shown(2.0 * shaft.gear_radius / gear.teeth, "mm")
    return Demand(float(min(gear.teeth, gear.pinion_teeth)), least, note=f"module {module}")


def _to_follower(machine: Machine, along: float, across: float) -> float:
    """Distance of a point from the follower at its lowest, m, the worse of an offset either side.

    The follower goes on above its roller or face, as wide as it or as the cheeks of the fork.
    """
    prime, offset = machine.cam.prime_radius, machine.cam.offset
    below = max(sqrt(prime**2 - offset**2) - along, 0.0)
    return min(machine.follower.away(below, abs(across + side)) for side in (offset, -offset))


def _centre_distance(shaft: Camshaft) -> float:
    """Distance of camshaft and machine shaft, m: pitch radii of gear and pinion."""
    gear = gear_of(shaft)
    return shaft.gear_radius * (1.0 + gear.pinion_teeth / gear.teeth)


def room_beside_shaft(machine: Machine) -> float | None:
    """Greatest radius of a cam that passes the machine shaft, m; None where it is not known."""
    shaft = machine.camshaft
    if shaft is None or shaft.gear is None or not machine.scope.covers("gear"):
        return None
    diameter = shaft.gear.machine_shaft_diameter
    if not diameter:
        return None
    return _centre_distance(shaft) - 0.5 * diameter - machine.limits[ASSEMBLY_GAP]


@check(
    ASSEMBLY_GAP,
    title="Gap between cam or {follower} and the machine shaft",
    formula="min(a - max|P|, b) - r >= g; a: centre distance, gear and pinion radius, P: contour,"
    " b: distance of the machine shaft, at camshaft.mesh_angle, from the follower at its lowest, r:"
    " half of camshaft.gear.machine_shaft_diameter, else at most the pinion radius, g:"
    " limits.assembly_gap; none where the diameter is 0, as the shaft ends at its pinion",
    reason="A cam that strikes the machine shaft does not turn.",
    method="centre distance less maximum contour radius, and distance from roller or face with"
    " fork, less the radius of the machine shaft",
    lift_can_help=True,
    moved_by_tolerance=False,
    part="gear",
    load_cases=NONE,
    levers=(levers.one("cam.prime_radius", -1, 2.0), *levers.GENTLER),
    page="Camshaft",
)
def machine_shaft_gap(solution: Solution) -> Demand | None:
    """Least gap between the machine shaft and cam or follower, m; None: it ends at its pinion."""
    machine, limit = solution.machine, solution.machine.limits[ASSEMBLY_GAP]
    shaft = camshaft_of(machine)
    gear, tip = gear_of(shaft), solution.contour.radius_max().value
    stated = gear.machine_shaft_diameter
    if stated == 0.0:
        return None
    centre = _centre_distance(shaft)
    pinion = centre - shaft.gear_radius
    place = centre * cos(shaft.mesh_angle), centre * sin(shaft.mesh_angle)
    room, name = min((centre - tip, "cam"), (_to_follower(machine, *place), machine.follower.word))
    words = f"{name} to machine shaft, centre distance {shown(centre, 'mm')}"
    if isnan(tip):
        return Demand(None, limit)
    if stated is not None:
        return Demand(room - 0.5 * stated, limit, note=words)
    gap, radius = _between(lambda radius: room - radius, 0.0, pinion, limit)
    if gap is None:
        missing = ("camshaft.gear.machine_shaft_diameter",)
        note = f"at most a radius of {shown(room - limit, 'mm')}; 0 mm if it ends at its pinion"
        return Demand(None, limit, missing=missing, note=note)
    how = "even with a shaft of no diameter" if radius == 0.0 else "the shaft as wide as its pinion"
    return Demand(gap, limit, note=f"{words}, {how}")


def _shaft_radius(machine: Machine) -> float:
    """Greatest radius of the camshaft beside the cam, m; without a diameter that of the bore."""
    shaft, radius = machine.camshaft, machine.cam.bore_radius
    if shaft is None:
        return radius
    _, follower = _on_the_shaft(machine)
    beside = [
        0.5 * each.diameter
        for each in shaft.sections
        if abs(each.position - shaft.cam_position) <= follower.half
    ]
    return max(radius, 0.5 * (shaft.diameter or 0.0), *beside)


@check(
    ASSEMBLY_GAP,
    title="Gap between fork and camshaft",
    formula="r_p - h/2 - d/2 >= g; r_p: cam.prime_radius, the least distance of the roller centre"
    " from the cam axis, h: roller.fork.cheek_height, d: diameter of the camshaft beside the cam,"
    " at least its bore, g: limits.assembly_gap",
    reason="Cheeks that reach the shaft stop the follower before it is down.",
    method="roller centre at the least lift less half of the cheek height, the end of the cheeks"
    " round about the pin, and the radius of the shaft",
    moved_by_tolerance=False,
    needs="roller",
    part="fork",
    load_cases=NONE,
    levers=(levers.one("roller.fork.cheek_height", -1), levers.PRIME),
    page="Roller",
)
def fork_shaft_gap(solution: Solution) -> Demand:
    """Least gap between the cheeks of the fork and the camshaft, m."""
    machine = solution.machine
    _, _, fork = _fork_of(machine)
    limit, height = machine.limits[ASSEMBLY_GAP], fork.cheek_height
    if height is None:
        return Demand(None, limit, missing=lacking(fork.table, fork, "cheek_height"))
    radius = _shaft_radius(machine)
    value = machine.cam.prime_radius - 0.5 * height - radius
    return Demand(value, limit, note=f"shaft taken as {shown(2.0 * radius, 'mm')} thick")


@check(
    ASSEMBLY_GAP,
    title="Gap between fork and roller or cam",
    formula="min(f - w/2, l - r, f - b/2 - x) >= g; f: inner face of a cheek from the middle of the"
    " roller, (span - cheek_width)/2 of a straddled pin, span of an overhung one, w, r: width and"
    " radius of the roller, l: roller.fork.cheek_length, b: width of the cam, x:"
    " roller.axial_offset; the last where h/2 > r, h: cheek_height, g: limits.assembly_gap",
    reason="A roller that rubs in its fork does not turn; cheeks beside the cam strike it.",
    method="faces of the cheeks from roller and cam, and bridge from roller",
    moved_by_tolerance=False,
    needs="roller",
    part="fork",
    load_cases=NONE,
    levers=(levers.one("roller.pin.span", most=2.0), levers.one("roller.fork.cheek_length")),
    page="Roller",
)
def fork_gap(solution: Solution) -> Demand:
    """Least gap between the fork and roller or cam, m."""
    machine = solution.machine
    roller, pin, fork = _fork_of(machine)
    limit = machine.limits[ASSEMBLY_GAP]
    lacks = lacking(fork.table, fork, "cheek_height", "cheek_length")
    if pin is None or fork.cheek_height is None or fork.cheek_length is None:
        pins = (Pin.table,) if pin is None else ()
        return Demand(None, limit, missing=(*pins, *lacks))
    inner, _ = fork.faces(pin)
    gaps = [
        (inner - 0.5 * roller.width, "cheek to roller"),
        (fork.cheek_length - roller.radius, "bridge to roller"),
    ]
    if 0.5 * fork.cheek_height > roller.radius:
        aside = 0.5 * machine.cam.width + (roller.axial_offset or 0.0)
        gaps.append((inner - aside, "cheek to cam"))
    value, words = min(gaps)
    return Demand(value, limit, note=words)


def _layout(lift: Value, numbers: Numbers) -> StemLayout:
    """Guides, stem and coil spring at a maximum lift; the spring at its least preload."""
    wire = wire_of(numbers)
    squeezed = numbers["spring.preload_least"] / numbers["spring.rate"]
    return StemLayout(
        overhang=numbers["follower.overhang_at_max_lift"],
        spacing=numbers["guides.spacing"],
        length_a=numbers["guides.a.length"],
        length_b=numbers["guides.b.length"],
        lift=lift,
        extent=numbers["follower.extent"],
        stem_diameter=numbers["follower.stem_diameter"],
        stem_length=numbers.get("follower.stem_length"),
        spring_length=wire.free_length - squeezed,
        spring_bore=wire.mean_diameter - wire.wire_diameter,
    )


_SEAT = "spring.seat_height", "spring.seat_thickness"


def _of_seat(demand: Demand, solution: Solution) -> Demand:
    """With the place of the seat, and what the case lacks to decide the gap."""
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
    place = layout.seated(taken, limit, height)
    where = f"moving seat at {shown(float(np.ravel(place.height)[0]), 'mm')}"
    return replace(demand, at=None, note=f"{where} at maximum lift{how}")


def _seat_gap(lift: Value, numbers: Numbers) -> Value:
    """Least clearance of spring and seats from guides and stem, m; NaN: not known."""
    height, thickness = (numbers.get(key) for key in _SEAT)
    return _layout(lift, numbers).known_gap(thickness, numbers.limit(ASSEMBLY_GAP), height)


def _room_of_gas(lift: Value, numbers: Numbers) -> Value:
    """Lesser clearance of the rod from guide B and of the piston from its end, m."""
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
    formula="between the guides min(s - h - t - a, (D - d - d_s)/2) >= g, s: height of the moving"
    " seat over roller centre or face at maximum lift, spring.seat_height, else b - L + h, under"
    " guide B, h: maximum lift, t: spring.seat_thickness, else at most d_s/2, a, b: upper end of"
    " guide A, lower end of guide B, L = L_0 - P/k: length of the spring at zero lift, D, d: mean"
    " and wire diameter, d_s: of the stem; else above guide B, s - h - t - c >= g, c: its upper"
    " end, s: at most follower.stem_length; g: limits.assembly_gap",
    reason="A spring or seat within a guide cannot be assembled, or stops the follower.",
    method="seats and spring, longest at the least preload, from the ends of the guides at zero"
    " lift, and coils from the stem; the length at maximum lift is that of spring_coil_gap",
    moved_by_tolerance=False,
    part="spring",
    load_cases=NONE,
    values=("spring.rate", "spring.preload"),
    levers=(
        levers.Scaled(("guides.spacing", "follower.stem_length"), 1, 2.0),
        levers.one("follower.stem_length", most=2.0),
    ),
    page="Spring",
).measured("top", value=_seat_gap, remark=_of_seat, deviation=1e-4)(lift)


gas_gap = check(
    ASSEMBLY_GAP,
    id="gas_gap",
    title="Gap of the gas spring over guide B and in its cylinder",
    tier=Tier.SCREENING,
    formula="min(l - h - c, V/A - h) >= g; l: follower.stem_length, on whose end the rod rests, h:"
    " maximum lift, c: upper end of guide B over roller centre or face at maximum lift, V, A:"
    " volume and area of spring.gas, g: limits.assembly_gap",
    reason="A rod that strikes guide B, or a piston the end of its cylinder, stops the follower.",
    method="end of the stem over guide B at zero lift, and column of the gas left at maximum lift;"
    " the stroke that the maker permits is that of gas_stroke",
    moved_by_tolerance=False,
    part="gas_spring",
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
