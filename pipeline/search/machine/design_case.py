"""Case file of a design, each part with its reason, each assumption marked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, pi
from pathlib import Path

import numpy as np

from camwright.pipeline.base import units
from camwright.pipeline.base.cooling import STILL_AIR, housing_area
from camwright.pipeline.base.source import Source
from camwright.pipeline.case.cards.card_filling import known_cards, viscosity
from camwright.pipeline.case.cards.shaft_seats import seat_source
from camwright.pipeline.case.case_writer import filled, tables_text, value_text
from camwright.pipeline.case.limits import CHORD_SHARE
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.contact.cam_body import STANDARD_KEYS
from camwright.pipeline.follower.bearing_life import rated_viscosity
from camwright.pipeline.follower.spring import HelicalSpring
from camwright.pipeline.search.machine.machine_frame import (
    AXIAL_OFFSET,
    ROLLER_CHAMFER,
    MachineFrame,
)
from camwright.pipeline.search.machine.torque_task import DesignTask
from camwright.pipeline.search.machine.wound_springs import SpringPoint

OIL_WARMER = 20.0  # K of oil and spring above the surroundings
_KAPPA = 1.25  # viscosity ratio of the roller bearing at the least speed
_CENTISTOKES = 1e-6
_ROOM = Source("given: space less the height of the roller at maximum lift", confirmed=True)
_BENCH_UNBALANCE = 3e-3  # m/s, residual unbalance of the bench
PROFILE = 8e-6  # m, tolerance of the ground contour
_RADIUS_STEP = 1e-4  # m, of a prime radius as a drawing states it
SEARCHED = 72  # cam angles of a turn in the search
WRITTEN = 144  # in a case file, for the error bars of a run
_AROUND = 0.01  # m of room and wall between parts and outside of the housing
_TOOTH_LOSS = 0.01  # of the torque at the gear
_BEARING_FRICTION = 1.5e-3  # deep-groove ball bearings: moment over force and half the bore
_BUSH_CARD = "ptfe_lined"  # card of both bushes
_TABLE_STEPS = (0.5, 0.25, 0.2, 0.1)  # deg, of the contour table
SYNTHESIS = """\
kind = "constrained"
corners = true
jerk_weight = 0.2
rest_force_weight = 0.0
"""
"""Smoothing of a design: the lift of least ripple within all limits, at all tolerance ends."""


@dataclass(frozen=True)
class Machinery:
    """Design in numbers, SI: frame, spring, prime radius, offset.

    lift: greatest lift for which the frame has room; cam_radius: that of the cam expected.
    """

    task: DesignTask = field(repr=False)
    frame: MachineFrame
    spring: SpringPoint
    prime_radius: float
    lift: float
    cam_radius: float
    offset: float = 0.0
    oils: Mapping[str, tuple[float, float]] = field(default_factory=dict, repr=False)

    @property
    def mass(self) -> float:
        """Mass of the follower, kg, rounded up."""
        drawn = 1.02 * self.frame.mass(self.lift, self.spring.spring.mass)
        return float(0.005 * np.ceil(200.0 * drawn))

    @property
    def room(self) -> float:
        """Radius available for the cam below the roller, m; infinite without a limit."""
        if self.task.space is None:
            return inf
        return self.task.space - self.height

    @property
    def height(self) -> float:
        """From the camshaft to the top of the roller at maximum lift, m."""
        return self.prime_radius + self.lift + self.frame.radius

    @property
    def least_size(self) -> float:
        """Least distance from the far side of the cam to the top of the roller, m."""
        return self.prime_radius - self.frame.radius + self.height

    @property
    def oil_temperature(self) -> float:
        return self.task.ambient + OIL_WARMER

    @property
    def conductance(self) -> float:
        """Thermal conductance to still air of a box housing about cam, gear and follower, W/K."""
        across = 2.0 * max(self.cam_radius, self.frame.gear_radius)
        height = across + self.frame.stem_length(self.lift)
        sides = (across, height, self.frame.housing_width)
        return STILL_AIR * float(housing_area(*(each + 2.0 * _AROUND for each in sides)))

    @property
    def other_heat(self) -> float:
        """Friction heat, W, of the gear and the bearings of the camshaft at the greatest speed, for
        the balance of the housing.
        """
        speed = self.task.speeds[1] / self.task.ratio
        force = 0.5 * (self.spring.preload + self.spring.greatest)
        bearings = _BEARING_FRICTION * force * 0.5 * self.frame.seat.bore
        return speed * (_TOOTH_LOSS * self.task.ratio * self.task.demand.ripple + bearings)

    @cached_property
    def oil(self) -> tuple[str, float]:
        """Name of the oil, and its kinematic viscosity, m2/s, at the temperature of the oil: the
        thinnest that is viscous enough for the roller bearing at the least speed, `_KAPPA` times
        the rated viscosity; the thickest one where none is.
        """
        card = self.frame.card
        turns = self.task.speeds[0] / self.task.ratio * self.prime_radius / self.frame.radius
        circle = card.pitch_diameter or 0.5 * (card.bore + card.outer_diameter)
        wanted = _KAPPA * float(rated_viscosity(np.asarray(turns * 30.0 / pi), circle))
        values = {
            name: _CENTISTOKES * viscosity(at_40, at_100, self.oil_temperature)
            for name, (at_40, at_100) in self.oils.items()
        }
        order = sorted(values, key=lambda name: values[name])
        name = next((name for name in order if values[name] >= wanted), order[-1])
        return name, values[name]


def drawn_radius(length: float, whole: Callable[[float], int] = round) -> float:
    """Prime radius, m, as a drawing states it: the nearest, or rounded up by `ceil`."""
    return _RADIUS_STEP * whole(length / _RADIUS_STEP)


def oils_of(folder: Path | None) -> dict[str, tuple[float, float]]:
    """Viscosities at 40 and 100 degC of the oils of the cards, mm2/s."""
    return {
        name: (float(str(card["viscosity_40"])), float(str(card["viscosity_100"])))
        for name, card in known_cards(folder)["oils"].items()
    }


def case_text(
    design: Machinery,
    name: str,
    file: str,
    head: str = "",
    smoothing: str = SYNTHESIS,
    positions: int = SEARCHED,
) -> str:
    """Text of the case file of a design.

    Parameters
    ----------
    name : str        of the case
    file : str        of the torque table, in the folder of the case
    head : str        comment lines at the top
    smoothing : str   lines of its section
    positions : int   cam angles of a turn
    """
    parts = (
        head + filled(_HEAD, name=name, title=_title(design)),
        _source(design, file),
        _spring(design),
        _cam(design),
        _shaft(design),
        _roller(design),
        _follower(design),
        _requirements(design, smoothing, positions),
    )
    return "\n".join(parts)


_HEAD = """\
#
# A value whose source is not confirmed is to be confirmed before a sign-off; the verdict counts
# them. Numbers carry their units; a card fills in what its table leaves out.

schema_version = 1
name = @name@
title = @title@
"""


def _title(design: Machinery) -> str:
    task = design.task
    return (
        f"Balancing cam for {units.shown(task.demand.energy_swing, 'J')} of energy swing"
        f" at {units.shown(task.speed, 'rpm')}"
    )


_SOURCE = """\
# --- The torque: @ripple@ N m of ripple (std), @energy_swing@ J of energy
# swing over @degrees@ deg of the shaft; its mean of @mean@ N m stays.
[torque]
kind = "table"
file = @file@
cycle = @cycle@

[mechanism]
gear_ratio = @gear_ratio@ # shaft turns per cam turn
"""


def _source(design: Machinery, file: str) -> str:
    task, demand = design.task, design.task.demand
    return filled(
        _SOURCE, file=file, cycle=_round(demand.cycle, "deg"), gear_ratio=_whole(task.ratio),
        ripple=f"{demand.ripple:.4g}", energy_swing=f"{demand.energy_swing:.4g}",
        degrees=f"{np.degrees(demand.cycle):g}", mean=f"{demand.mean:.4g}",
    )  # fmt: skip


def _whole(ratio: float) -> TomlValue:
    """A ratio of twelve digits, without decimals where it is whole."""
    rounded = float(f"{ratio:.12g}")
    return int(rounded) if rounded.is_integer() else rounded


_SPRING = """\
# --- Spring: @origin@. It stores @energy@ J in @stroke@ of lift, and its
# coils surge at @surge@ times the cam's frequency at over-speed.
[spring]
rate = @rate@
preload = @preload@ # on the base circle
travel_max = @travel_max@
seat_thickness = @seat_thickness@
source = @source@

[spring.design]
"""


def _spring(design: Machinery) -> str:
    """Text of the tables of the spring in the case file."""
    point, task = design.spring, design.task
    spring = point.spring
    origin = f"catalogue: spring {spring.name}" if spring.name else "wound for this design"
    words = tables_of(spring)
    for key in ("source", "name"):
        words.pop(key, None)
    text = filled(
        _SPRING, origin=origin, energy=f"{point.energy:.4g}", stroke=_mm(point.travel),
        surge=f"{spring.surge_ratio(task.cam_speed):.3g}", rate=units.format(spring.rate, "kN/m"),
        preload=_round(point.preload, "N"), travel_max=_mm(design.lift),
        seat_thickness=_mm(design.frame.seat_thickness), source=f"chosen: {origin}",
    )  # fmt: skip
    return f"{text}{tables_text(words)}source = {value_text(_spring_source(spring))}\n"


def _spring_source(spring: HelicalSpring) -> Source:
    """Source of the spring: catalogue or wire, with temperature and relaxation assumed."""
    origin = f"spring {spring.name} of the catalogue"
    if not spring.name:
        origin = f"wound; wire: {spring.source.text}"
    return Source(f"{origin}; temperature and relaxation assumed", confirmed=False)


_CAM = """\
# --- Cam: the prime radius is that of the roller's CENTRE on the base circle.
[cam]
prime_radius = @prime_radius@
offset = @offset@
width = @width@ # within the flat of the roller, offset
end = { kind = "sharp" }
bore_radius = @bore_radius@
material = "case_hardened"
roughness = "0.3 um" # ground
profile_tolerance = @profile@ # ground
keyway = @keyway@
source = @ground@

[cam.fit] # shrunk on a shaft that is ground to the bore
least_interference = @least@
greatest_interference = @greatest@
source = @friction@

[cam.key]
length = @key_length@
chamfer = @chamfer@
form = "B"
material = "c45"
source = @key_source@
"""


def _cam(design: Machinery) -> str:
    """Text of the table of the cam with seat, key and keyway in the case file."""
    frame, seat = design.frame, design.frame.seat
    least, greatest = frame.interferences
    keyway: Tables = {"width": _mm(seat.key_width), "depth": _mm(seat.hub_depth)}
    row = STANDARD_KEYS.get(round(1e3 * seat.key_width))
    if row is not None:  # 1.5 times the least root radius, within DIN 6885-1
        keyway["root_radius"] = _mm(1.5 * row.fillet)
    # The greatest chamfer of the standard clears that root.
    chamfer = None if row is None else _mm(row.chamfer)
    return filled(
        _CAM, prime_radius=_mm(design.prime_radius),
        offset=_mm(design.offset) if design.offset else None, width=_mm(frame.cam_width),
        bore_radius=_mm(0.5 * seat.bore), profile=units.format(PROFILE, "um"), keyway=keyway,
        ground=_assumed("case-hardened and ground"), least=f"{1e6 * least:.3g} um",
        greatest=f"{1e6 * greatest:.3g} um", friction=_assumed("friction by DIN 7190-1"),
        key_length=_mm(frame.key_length), chamfer=chamfer, key_source=seat_source(),
    )  # fmt: skip


_SHAFT = """\
# --- Camshaft: bore, key and bearings @bearing@ carry the torque of the cam.
[camshaft]
bearing_spacing = @spacing@
cam_position = @middle@ # in the middle
gear_position = @gear_position@ # overhung
gear_radius = @gear_radius@ # module @module@ mm
diameter = @bore@
material = "c45"
bearing_rating = @C@ # of two @bearing@
bearing_static_rating = @C0@
bearing_width = @bearing_width@
rotor_mass = @rotor@ # cam, gear and shaft
counterweight = @counterweight@
source = @source@

[camshaft.gear]
teeth = @teeth@
pinion_teeth = @pinion_teeth@
width = @gear_width@
material = "case_hardened"
bending_limit = "430 MPa"
contact_limit = "1500 MPa"
pinion_bending_limit = "430 MPa"
pinion_contact_limit = "1500 MPa"
machine_shaft_diameter = "0 mm" # assumed: the machine shaft ends at its pinion
backlash = "0.03 mm" # assumed: ground teeth of a fit for reversing torque
source = { text = "ISO 6336-5, case-hardened steel, quality MQ", confirmed = false }
"""


def _shaft(design: Machinery) -> str:
    """Text of the tables of camshaft, its bearings, gear and counterweight in the case file."""
    frame, seat = design.frame, design.frame.seat
    rotor = frame.rotor_mass(design.cam_radius)
    residual = _BENCH_UNBALANCE * rotor / design.task.cam_speed
    middle = _mm(0.5 * frame.bearing_spacing)
    gear, pinion = frame.teeth
    return filled(
        _SHAFT, bearing=seat.bearing, spacing=_mm(frame.bearing_spacing), middle=middle,
        gear_position=_mm(frame.gear_position), gear_radius=_mm(frame.gear_radius),
        module=f"{1e3 * frame.module:g}", bore=_mm(seat.bore), C=units.format(seat.C, "kN"),
        C0=units.format(seat.C0, "kN"), bearing_width=_mm(seat.width), rotor=f"{rotor:.3g} kg",
        counterweight={"residual": f"{1e6 * residual:.3g} g mm", "position": middle},
        source=_assumed(f"proportions; {seat_source().text}"), teeth=gear, pinion_teeth=pinion,
        gear_width=_mm(frame.gear_width),
    )  # fmt: skip


_ROLLER = """\
# --- Roller: @name@.
[roller]
radius = @radius@
width = @width@
end = @end@
hub_radius = @hub_radius@ # shoulder of the inner ring
axial_offset = @axial_offset@
friction = 0.10 # oiled steel on steel
roughness = "0.1 um"
material = "bearing_steel"

[roller.bearing]
card = @card@
static_radial_limit = @static@
lubrication = "oil"
viscosity = @viscosity@ # @grade@ at @temperature@
contamination = "normal_cleanliness"

[roller.pin]
diameter = @bore@
span = @span@ # between the middles of the cheeks
material = "case_hardened"
source = @pin_source@

[roller.fork]
cheek_width = @cheek_width@
cheek_height = @cheek_height@
cheek_length = @cheek_length@
bridge_length = @bridge@
material = "c45"
source = @fork_source@

[lubricant]
card = @oil@
temperature = @temperature@

[cooling]
ambient_temperature = @ambient@
conductance = @conductance@
heat = @heat@ # of gear and camshaft bearings
source = @cooling_source@
"""


def _roller(design: Machinery) -> str:
    """Text of the tables of roller, bearing, pin, fork, oil and cooling in the case file."""
    frame, card = design.frame, design.frame.card
    oil, value = design.oil
    inside = card.bore if card.pitch_diameter is None else card.pitch_diameter
    return filled(
        _ROLLER, name=card.name, radius=_mm(frame.radius), width=_mm(card.width),
        end={"kind": "chamfer", "size": _mm(ROLLER_CHAMFER)},
        hub_radius=_mm(0.25 * (card.bore + inside)), axial_offset=_mm(AXIAL_OFFSET),
        card=frame.roller, static=units.format(card.static_radial_limit or card.C0, "kN"),
        viscosity=f"{value / _CENTISTOKES:.3g} mm^2/s", grade=oil.replace("_", " ").upper(),
        temperature=_round(design.oil_temperature, "degC"), bore=_mm(card.bore),
        span=_mm(frame.pin_span), pin_source=_assumed("the bore of the roller"),
        cheek_width=_mm(frame.cheek_width), cheek_height=_mm(frame.cheek_height),
        cheek_length=_mm(frame.cheek_length), bridge=_mm(frame.bridge),
        fork_source=_assumed("proportions"), oil=oil,
        ambient=units.format(design.task.ambient, "K"),
        conductance=f"{design.conductance:.3g} W/K", heat=f"{design.other_heat:.3g} W",
        cooling_source=_assumed("still air about a housing of cam, gear and follower"),
    )  # fmt: skip


_FOLLOWER = """\
# --- Follower and its guides: guided length over twice the overhang, room for
# @lift@ of lift.
[follower]
mass = @mass@ # as drawn, with a third of the spring
stem_diameter = @stem@
stem_length = @stem_length@
stem_material = "c45"
overhang_at_max_lift = @overhang@ # from guide A to the roller's centre
anti_rotation = "guided_fork"
source = @source@

[guides]
spacing = @spacing@
ambient_temperature = @ambient@ # in the housing, as warm as the oil
"""
_BUSH = """\
card = @card@
length = @length@
diameter = @diameter@
wall = @wall@
clearance = @clearance@ # H7/f7, mean
housing_resistance = "1 K/W"
wear_rate = "3e-8 mm^3/N/m"
source = @source@
"""
_MATERIALS = """
[materials]
case_hardened = { card = "case_hardened" }
bearing_steel = { card = "bearing_steel" }
c45 = { card = "c45" }
"""


def _follower(design: Machinery) -> str:
    """Text of the tables of follower, guides and materials in the case file."""
    frame, stem = design.frame, _mm(design.frame.stem)
    text = filled(
        _FOLLOWER, lift=_mm(design.lift), mass=_round(design.mass, "g"), stem=stem,
        stem_length=_mm(frame.stem_length(design.lift)), overhang=_mm(frame.overhang),
        source=_assumed("proportions"), spacing=_mm(frame.spacing(design.lift)),
        ambient=_round(design.oil_temperature, "degC"),
    )  # fmt: skip
    bush = filled(
        _BUSH, card=_BUSH_CARD, length=_mm(frame.bush_length),
        diameter=stem, wall=_mm(frame.bush_wall), clearance=_mm(frame.bush_clearance),
        source=_assumed(f"size, clearance, housing, wear; card {_BUSH_CARD}"),
    )  # fmt: skip
    return text + "".join(f"\n[guides.{side}]\n{bush}" for side in "ab") + _MATERIALS


_REQUIREMENTS = """\

[limits]
overspeed = @overspeed@
torque_reduction = @reduction@
roller_life = @life@
shaft_bearing_life = @life@
target_life = @life@
tool_radius = @tool@ # grinding wheel or cutter
cam_radius = @room@

[limits.sources]
overspeed = @overspeed_source@
torque_reduction = @reduction_source@
roller_life = @life_source@
shaft_bearing_life = @life_source@
target_life = @life_source@
tool_radius = @tool_source@
cam_radius = @room_source@

[sources]
"guides.ambient_temperature" = @ambient_source@

[tolerances]
source = @tolerances@

[workshop]
table_step = @table_step@ # chords within a quarter of the tolerance

[solver]
positions = @positions@ # per cam turn; 720 for a sign-off

"""
_LOAD_CASE = """\
[[load_case]]
name = @name@
speed = @speed@
ripple_weight = @weight@ # the cam only has to hold
source = @source@

"""


def _requirements(design: Machinery, smoothing: str, positions: int) -> str:
    """Text of the tables of smoothing, requirements, limits and load cases in the case file of a
    design.

    Parameters
    ----------
    design : Machinery   task and cam radius
    smoothing : str      lines of `[smoothing]`
    positions : int      cam angles that are solved
    """
    task = design.task
    room = design.room if task.space is not None else 1e-3 * np.ceil(1.15e3 * design.cam_radius)
    cases = [_load_case("running", task.speed, None, "given")]
    for label, speed in zip(("slowest", "fastest"), task.speeds, strict=True):
        if abs(speed / task.speed - 1.0) > 1e-9:
            cases.append(_load_case(label, speed, 0.0, "given: end of the speed range"))
    return _SMOOTHING + smoothing + filled(
        _REQUIREMENTS, overspeed=_round(task.overspeed, "rpm"), reduction=task.remove,
        life=units.format(task.life, "h"), room=_mm(float(room)),
        tool=_mm(1e-3 * max(2.0, np.floor(0.5e3 * design.frame.radius))),
        overspeed_source=task.source("overspeed", "1.2 times the greatest speed"),
        reduction_source=task.source("remove"), life_source=task.source("life"),
        tool_source=_assumed(""),
        room_source=_assumed("room for the chosen cam") if task.space is None else _ROOM,
        ambient_source=_assumed("the temperature of the oil in the same housing"),
        tolerances=_assumed("ground profile; the rest: defaults"),
        table_step=f"{_table_step(design):g} deg", positions=positions,
    ) + "".join(cases)  # fmt: skip


_SMOOTHING = """\
# --- The lift of least torque ripple within all limits, at the ends of all tolerances
[smoothing]
"""


def _table_step(design: Machinery) -> float:
    """Step of the contour table, deg: chords of a circle, twice as curved as that of the cam."""
    radius, error = 2.0 * design.prime_radius, CHORD_SHARE.default * PROFILE
    return next(
        (s for s in _TABLE_STEPS if radius * np.radians(s) ** 2 / 8.0 <= error), _TABLE_STEPS[-1]
    )


def _load_case(name: str, speed: float, weight: float | None, source: str) -> str:
    return filled(_LOAD_CASE, name=name, speed=_round(speed, "rpm"), weight=weight, source=source)


def _mm(length: float) -> str:
    return _round(length, "mm", 6)


def _round(value: float, unit: str, digits: int = 7) -> str:
    return units.rounded(units.format(value, unit), digits)


def _assumed(what: str) -> Source:
    """Source of an assumption, to be confirmed."""
    return Source(f"assumed: {what}".removesuffix(": "), confirmed=False)
