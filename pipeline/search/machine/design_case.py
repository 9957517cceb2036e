"""Case file of a design, each part with its reason, each assumption marked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, pi
from pathlib import Path

import numpy as np
import tomli_w

from camwright.pipeline.base import units
from camwright.pipeline.base.cooling import STILL_AIR, housing_area
from camwright.pipeline.base.source import Source, written
from camwright.pipeline.case.cards.card_filling import known_cards, viscosity
from camwright.pipeline.case.cards.shaft_seats import Seat, seat_source
from camwright.pipeline.case.limits import CHORD_SHARE
from camwright.pipeline.case.toml_text import tables_of
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
SEARCHED = 72  # cam angles of a turn in the search
WRITTEN = 144  # in a case file, for the error bars of a run
_AROUND = 0.01  # m of room and wall between parts and outside of the housing
_TOOTH_LOSS = 0.01  # of the torque at the gear
_BEARING_FRICTION = 1.5e-3  # deep-groove ball bearings: moment over force and half the bore
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
    bush: str = "ptfe_lined"
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
        """Heat to still air from a housing about cam, gear and follower, W/K."""
        across = 2.0 * max(self.cam_radius, self.frame.gear_radius)
        height = across + self.frame.stem_length(self.lift)
        sides = (across, height, self.frame.housing_width)
        return STILL_AIR * housing_area(*(each + 2.0 * _AROUND for each in sides))

    @property
    def other_heat(self) -> float:
        """Heat of gear and camshaft bearings at the greatest speed, W."""
        speed = self.task.speeds[1] / self.task.ratio
        force = 0.5 * (self.spring.preload + self.spring.greatest)
        bearings = _BEARING_FRICTION * force * 0.5 * self.frame.seat.bore
        return speed * (_TOOTH_LOSS * self.task.ratio * self.task.demand.ripple + bearings)

    @cached_property
    def oil(self) -> tuple[str, float]:
        """Thinnest oil of sufficient viscosity for the roller bearing; its viscosity, m2/s.

        The thickest one where none does.
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
        _HEAD.format(head=head, name=name, title=_title(design)),
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
{head}#
# A value whose source is not confirmed is to be confirmed before a sign-off; the verdict counts
# them. Numbers carry their units; a card fills in what its table leaves out.

schema_version = 1
name = "{name}"
title = "{title}"
"""


def _title(design: Machinery) -> str:
    task = design.task
    return (
        f"Balancing cam for {units.shown(task.demand.energy_swing, 'J')} of energy swing"
        f" at {units.shown(task.speed, 'rpm')}"
    )


def _source(design: Machinery, file: str) -> str:
    task, demand = design.task, design.task.demand
    return f"""\
# --- The torque: {demand.ripple:.4g} N m of ripple (std), {demand.energy_swing:.4g} J of energy
# swing over {np.degrees(demand.cycle):g} deg of the shaft; its mean of {demand.mean:.4g} N m stays.
[torque]
kind = "table"
file = {_text(file)}
cycle = "{_round(demand.cycle, "deg")}"

[mechanism]
gear_ratio = {task.ratio:.12g}                     # shaft turns per cam turn
"""


def _spring(design: Machinery) -> str:
    point, task = design.spring, design.task
    spring = point.spring
    origin = f"catalogue: spring {spring.name}" if spring.name else "wound for this design"
    surge = spring.surge_ratio(task.cam_speed)
    words = tables_of(spring)
    for key in ("source", "name"):
        words.pop(key, None)
    rows = tomli_w.dumps(words).rstrip("\n")
    return f"""\
# --- Spring: {origin}. It stores {point.energy:.4g} J in {_mm(point.travel)} of lift, and its
# coils surge at {surge:.3g} times the cam's frequency at over-speed.
[spring]
rate = {_text(units.format(spring.rate, "kN/m"))}
preload = {_text(_round(point.preload, "N"))}                      # on the base circle
travel_max = {_text(_mm(design.lift))}
seat_thickness = {_text(_mm(design.frame.seat_thickness))}
source = "chosen: {origin}"

[spring.design]
{rows}
source = {written(_spring_source(spring))}
"""


def _spring_source(spring: HelicalSpring) -> Source:
    origin = f"spring {spring.name} of the catalogue"
    if not spring.name:
        origin = f"wound; wire: {spring.source.text}"
    return Source(f"{origin}; temperature and relaxation assumed", confirmed=False)


def _cam(design: Machinery) -> str:
    frame, seat = design.frame, design.frame.seat
    least, greatest = frame.interferences
    offset = f'offset = "{_mm(design.offset)}"\n' if design.offset else ""
    return f"""\
# --- Cam: the prime radius is that of the roller's CENTRE on the base circle.
[cam]
prime_radius = "{_mm(design.prime_radius)}"
{offset}width = "{_mm(frame.cam_width)}"                   # within the flat of the roller, offset
end = {{ kind = "sharp" }}
bore_radius = "{_mm(0.5 * seat.bore)}"
material = "case_hardened"
roughness = "0.3 um"                 # ground
profile_tolerance = "{units.format(PROFILE, "um")}"           # ground
keyway = {{ width = "{_mm(seat.key_width)}", depth = "{_mm(seat.hub_depth)}"{_root(seat)} }}
source = {_assumed("case-hardened and ground")}

[cam.fit]                            # shrunk on a shaft that is ground to the bore
least_interference = "{1e6 * least:.3g} um"
greatest_interference = "{1e6 * greatest:.3g} um"
source = {_assumed("friction by DIN 7190-1")}

[cam.key]
length = "{_mm(frame.key_length)}"{_chamfer(seat)}
form = "B"
material = "c45"
source = {written(seat_source())}
"""


def _root(seat: Seat) -> str:
    """Root radius of a keyway of a standard width: 1.5 times the least, within DIN 6885-1."""
    row = STANDARD_KEYS.get(round(1e3 * seat.key_width))
    return "" if row is None else f', root_radius = "{_mm(1.5 * row.fillet)}"'


def _chamfer(seat: Seat) -> str:
    """Chamfer of a key of a standard width: the greatest, clear of the root of its keyway."""
    row = STANDARD_KEYS.get(round(1e3 * seat.key_width))
    return "" if row is None else f'\nchamfer = "{_mm(row.chamfer)}"'


def _shaft(design: Machinery) -> str:
    frame, seat = design.frame, design.frame.seat
    spacing = frame.bearing_spacing
    speed = design.task.cam_speed
    rotor = frame.rotor_mass(design.cam_radius)
    residual = _BENCH_UNBALANCE * rotor / speed
    gear, pinion = frame.teeth
    return f"""\
# --- Camshaft: bore, key and bearings {seat.bearing} carry the torque of the cam.
[camshaft]
bearing_spacing = "{_mm(spacing)}"
cam_position = "{_mm(0.5 * spacing)}"              # in the middle
gear_position = "{_mm(frame.gear_position)}"            # overhung
gear_radius = "{_mm(frame.gear_radius)}"                # module {1e3 * frame.module:g} mm
diameter = "{_mm(seat.bore)}"
material = "c45"
bearing_rating = "{units.format(seat.C, "kN")}"           # of two {seat.bearing}
bearing_static_rating = "{units.format(seat.C0, "kN")}"
bearing_width = "{_mm(seat.width)}"
rotor_mass = "{rotor:.3g} kg"                # cam, gear and shaft
counterweight = {{ residual = "{1e6 * residual:.3g} g mm", position = "{_mm(0.5 * spacing)}" }}
source = {_assumed(f"proportions; {seat_source().text}")}

[camshaft.gear]
teeth = {gear}
pinion_teeth = {pinion}
width = "{_mm(frame.gear_width)}"
material = "case_hardened"
bending_limit = "430 MPa"
contact_limit = "1500 MPa"
pinion_bending_limit = "430 MPa"
pinion_contact_limit = "1500 MPa"
machine_shaft_diameter = "0 mm"      # assumed: the machine shaft ends at its pinion
backlash = "0.03 mm"                # assumed: ground teeth of a fit for reversing torque
source = {{ text = "ISO 6336-5, case-hardened steel, quality MQ", confirmed = false }}
"""


def _roller(design: Machinery) -> str:
    frame, card = design.frame, design.frame.card
    oil, value = design.oil
    grade = oil.replace("_", " ").upper()
    inside = card.bore if card.pitch_diameter is None else card.pitch_diameter
    static = card.static_radial_limit or card.C0
    return f"""\
# --- Roller: {card.name}.
[roller]
radius = "{_mm(frame.radius)}"
width = "{_mm(card.width)}"
end = {{ kind = "chamfer", size = "{_mm(ROLLER_CHAMFER)}" }}
hub_radius = "{_mm(0.25 * (card.bore + inside))}"              # shoulder of the inner ring
axial_offset = "{_mm(AXIAL_OFFSET)}"
friction = 0.10                      # oiled steel on steel
roughness = "0.1 um"
material = "bearing_steel"

[roller.bearing]
card = "{frame.roller}"
static_radial_limit = "{units.format(static, "kN")}"
lubrication = "oil"
viscosity = "{value / _CENTISTOKES:.3g} mm^2/s"            # {grade} at {_celsius(design)}
contamination = "normal_cleanliness"

[roller.pin]
diameter = "{_mm(card.bore)}"
span = "{_mm(frame.pin_span)}"                   # between the middles of the cheeks
material = "case_hardened"
source = {_assumed("the bore of the roller")}

[roller.fork]
cheek_width = "{_mm(frame.cheek_width)}"
cheek_height = "{_mm(frame.cheek_height)}"
cheek_length = "{_mm(frame.cheek_length)}"
bridge_length = "{_mm(frame.bridge)}"
material = "c45"
source = {_assumed("proportions")}

[lubricant]
card = "{oil}"
temperature = "{_celsius(design)}"

[cooling]
ambient_temperature = "{units.format(design.task.ambient, "K")}"
conductance = "{design.conductance:.3g} W/K"
heat = "{design.other_heat:.3g} W"                      # of gear and camshaft bearings
source = {_assumed("still air about a housing of cam, gear and follower")}
"""


def _follower(design: Machinery) -> str:
    frame, stem = design.frame, _mm(design.frame.stem)
    bush = f"""\
card = "{design.bush}"
length = "{_mm(frame.bush_length)}"
diameter = "{stem}"
wall = "{_mm(frame.bush_wall)}"
clearance = "0.03 mm"
housing_resistance = "1 K/W"
wear_rate = "3e-8 mm^3/N/m"
source = {_assumed(f"size, clearance, housing, wear; card {design.bush}")}
"""
    return f"""\
# --- Follower and its guides: guided length over twice the overhang, room for
# {_mm(design.lift)} of lift.
[follower]
mass = "{_round(design.mass, "g")}"                     # as drawn, with a third of the spring
stem_diameter = "{stem}"
stem_length = "{_mm(frame.stem_length(design.lift))}"
stem_material = "c45"
overhang_at_max_lift = "{_mm(frame.overhang)}"       # from guide A to the roller's centre
anti_rotation = "guided_fork"
source = {_assumed("proportions")}

[guides]
spacing = "{_mm(frame.spacing(design.lift))}"
ambient_temperature = "{_celsius(design)}"        # in the housing, as warm as the oil

[guides.a]
{bush}
[guides.b]
{bush}
[materials]
case_hardened = {{ card = "case_hardened" }}
bearing_steel = {{ card = "bearing_steel" }}
c45 = {{ card = "c45" }}
"""


def _requirements(design: Machinery, smoothing: str, positions: int) -> str:
    task = design.task
    life = units.format(task.life, "h")
    radius = 1e-3 * np.ceil(1.15e3 * design.cam_radius) if task.space is None else design.room
    room = _assumed("room for the chosen cam") if task.space is None else written(_ROOM)
    tool = 1e-3 * max(2.0, np.floor(0.5e3 * design.frame.radius))
    lived = written(task.source("life"))
    cases = [_load_case("running", task.speed, 1.0, "given")]
    for label, speed in zip(("slowest", "fastest"), task.speeds, strict=True):
        if abs(speed / task.speed - 1.0) > 1e-9:
            cases.append(_load_case(label, speed, 0.0, "given: end of the speed range"))
    return f"""\
# --- The lift of least torque ripple within all limits, at the ends of all tolerances
[smoothing]
{smoothing}
[limits]
overspeed = "{_round(task.overspeed, "rpm")}"
torque_reduction = {task.remove!r}
roller_life = "{life}"
shaft_bearing_life = "{life}"
target_life = "{life}"
tool_radius = "{_mm(tool)}"                # grinding wheel or cutter
cam_radius = "{_mm(float(radius))}"

[limits.sources]
overspeed = {written(task.source("overspeed", "1.2 times the greatest speed"))}
torque_reduction = {written(task.source("remove"))}
roller_life = {lived}
shaft_bearing_life = {lived}
target_life = {lived}
tool_radius = {_assumed("")}
cam_radius = {room}

[sources]
"guides.ambient_temperature" = {_assumed("the temperature of the oil in the same housing")}

[tolerances]
source = {_assumed("ground profile; the rest: defaults")}

[workshop]
table_step = "{_table_step(design):g} deg"              # chords within a quarter of the tolerance

[solver]
positions = {positions}                       # per cam turn; 720 for a sign-off

{"".join(cases)}"""


def _table_step(design: Machinery) -> float:
    """Step of the contour table, deg: chords of a circle, twice as curved as that of the cam."""
    radius, error = 2.0 * design.prime_radius, CHORD_SHARE.default * PROFILE
    return next(
        (s for s in _TABLE_STEPS if radius * np.radians(s) ** 2 / 8.0 <= error), _TABLE_STEPS[-1]
    )


def _load_case(name: str, speed: float, weight: float, source: str) -> str:
    counts = "" if weight else "ripple_weight = 0.0                  # the cam only has to hold\n"
    return f"""\
[[load_case]]
name = "{name}"
speed = "{_round(speed, "rpm")}"
{counts}source = "{source}"

"""


def _mm(length: float) -> str:
    return _round(length, "mm", 6)


def _round(value: float, unit: str, digits: int = 7) -> str:
    return units.rounded(units.format(value, unit), digits)


def _celsius(design: Machinery) -> str:
    return f"{design.oil_temperature - 273.15:g} degC"


def _assumed(what: str) -> str:
    """Source of an assumption, to be confirmed."""
    return written(Source(f"assumed: {what}".removesuffix(": "), confirmed=False))


def _text(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
