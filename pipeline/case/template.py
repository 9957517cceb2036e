"""First case of each kind, complete and commented, as written by `camwright new`.

The kinds differ at the source: a cylinder model, a measurement on the engine of that model, the
torque of another machine, or a lift. The mechanism is the same, but for the arm of the kind `arm`
and the groove of `groove`.
"""

from __future__ import annotations

import tomllib
from typing import Literal, NamedTuple, get_args

from camwright.geometry.errors import InputError
from camwright.pipeline.base.missing_kinds import missing_kind
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.case_writer import Filling, filled
from camwright.pipeline.case.load_case_torque import engine_torque
from camwright.pipeline.case.section import SAFE_NAME
from camwright.pipeline.engine.crankshaft import Inertia, crank_motion
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle
from camwright.pipeline.engine.modelled_trace import (
    pressure_text,
    tooth_times_text,
    torque_text,
    voltage_text,
)
from camwright.pipeline.engine.speed_file import WheelTable
from camwright.pipeline.torque.torque import Torque

Kind = Literal[
    "cylinder", "table", "pressure", "speed", "voltage",
    "torque", "harmonics", "compressor", "pump", "press",
    "lift", "eccentric", "arm", "groove",
]  # fmt: skip
KINDS: tuple[Kind, ...] = get_args(Kind)


class FirstCase(NamedTuple):
    """Text of a case file, with name and text of its data file; "" without one."""

    text: str
    data_name: str
    data: str


def first_case(name: str, kind: str = "cylinder") -> FirstCase:
    """Complete, commented case file of a kind, and its data file.

    Parameters
    ----------
    name : str   of the case
    kind : str   one of `KINDS`

    Raises
    ------
    InputError
        If the name is not valid for a folder, or the kind is unknown.
    """
    if not SAFE_NAME.fullmatch(name):
        raise InputError("name", name, "1 to 40 letters, digits, '_', '-' or '.'")
    known = next((each for each in KINDS if each == kind), None)
    if known is None:
        missing = missing_kind("", kind)
        listed = f"; {missing.sentence}" if missing is not None else ""
        raise InputError("--kind", kind, f"one of: {', '.join(KINDS)}{listed}")
    text = _text(name, known)
    if known not in _MEASURED:
        return FirstCase(text, "", "")
    return FirstCase(text, _data_name(name, known), _data(known, _case(text)))


def _text(name: str, kind: Kind) -> str:
    """Text of the first case of a kind: source of the torque or lift, machine, follower,
    requirements.
    """
    balances = kind not in ("lift", "eccentric", "arm", "groove")
    closed = "groove" if kind == "groove" else "spring"
    drive = "slow" if closed == "groove" else "shaft" if kind in _MACHINES else "crank"
    parts = (
        *(_HEAD, _SOURCES[kind], _MECHANISM, _SPRING if closed == "spring" else "", _CAM),
        *(_GROOVE if closed == "groove" else "", _SHAFT, _ARM if kind == "arm" else _STEM),
        *(_SURROUNDINGS, _BALANCE if balances else "", _REQUIREMENTS),
    )
    return filled(
        "\n".join(part for part in parts if part), name=name, data=_data_name(name, kind),
        power="230 W" if kind in _WITHOUT_MEAN else None, reduction=0.4 if balances else None,
        **_SHAFTS[drive], **_CLOSURES[closed],
    )  # fmt: skip


def _data_name(name: str, kind: Kind) -> str:
    return f"{name}_{_MEASURED.get(kind, kind)}.csv"


def _case(text: str) -> Case:
    """A case without its data file, which is still to be written."""
    return case_of(tomllib.loads(text))


def _data(kind: Kind, case: Case) -> str:
    """Text of the data file of a kind: what would be measured on the engine of the kind `cylinder`,
    or on the pump of `pump`.
    """
    if kind == "torque":
        pump = _case(_text("modelled", "pump"))
        return _torque_text(engine_torque(pump, pump.load_cases[0]))
    modelled = _case(_text("modelled", "cylinder"))
    engine, state = modelled.engine, modelled.load_cases[0]
    if not isinstance(engine, CylinderEngine):
        raise InputError("engine.kind", kind, "cylinder")
    if kind == "pressure":
        return pressure_text(working_cycle(engine, state.speed))
    torque = engine_torque(modelled, state)
    if kind == "table" or case.crankshaft is None or not isinstance(case.engine, WheelTable):
        return torque_text(torque)
    inertia = Inertia.constant_only(case.crankshaft.inertia, torque.theta.size)
    speed = crank_motion(torque.total, inertia, state.speed, span=torque.span).speed
    write = voltage_text if kind == "voltage" else tooth_times_text
    return write(speed, case.engine.wheel)


_MEASURED: dict[Kind, str] = {
    "table": "torque", "pressure": "pressure", "speed": "tooth_times", "voltage": "voltage",
    "torque": "torque",
}  # fmt: skip
"""Quantity of the data file of a kind, as in its name."""
_WITHOUT_MEAN = ("table", "speed", "voltage")
_MACHINES = ("torque", "harmonics", "compressor", "pump", "press")
_SHAFTS: dict[str, dict[str, Filling]] = {
    "crank": {
        "gear_ratio": 2.0, "turns": "crank turns per cam turn", "shaft": "crank",
        "speed": "1500 rpm", "overspeed": "1650 rpm", "pinion_teeth": 20, "jerk_weight": 7.0,
    },
    "shaft": {
        "gear_ratio": 1.0, "turns": "shaft turns per cam turn; 2.0: two lobes", "shaft": "shaft",
        "speed": "750 rpm", "overspeed": "825 rpm", "pinion_teeth": 40, "jerk_weight": 2.0,
    },
    "slow": {
        "gear_ratio": 1.0, "turns": "shaft turns per cam turn", "shaft": "shaft",
        "speed": "300 rpm", "overspeed": "330 rpm", "pinion_teeth": 40, "jerk_weight": None,
    },
}  # fmt: skip
"""Drive of the cam, name and speeds of the shaft, teeth of the pinion, jerk weight."""
_CLOSURES: dict[str, dict[str, Filling]] = {
    "spring": {
        "held_by": None, "prime_radius": "60 mm", "at": "smallest radius of the roller's CENTRE",
        "width": "15.5 mm", "wide": "within the flat of the roller at its axial offset",
        "counterweight": {"residual": "20 g mm", "position": "35 mm"}, "beside": "16 mm",
        "mounting": None, "span": "23 mm", "spanned": "between the middles of the cheeks",
        "cheek_width": "5 mm", "cheek_height": "22 mm",
        "tool": "25 mm", "landing": None, "slip": None, "room": "90 mm",
    },
    "groove": {
        "held_by": "groove", "prime_radius": "68 mm", "at": "to the middle of the groove",
        "width": "28 mm", "wide": "18 mm of groove on a web of 10 mm",
        "counterweight": None, "beside": "0 mm",
        "mounting": "overhung", "span": "14 mm", "spanned": "middle of the roller to the cheek's",
        "cheek_width": "10 mm", "cheek_height": "30 mm",
        "tool": None, "landing": "50 mm/s", "slip": "7 m/s", "room": "125 mm",
    },
}  # fmt: skip
"""Cam, pin and limits by what keeps the follower on the cam."""


def _torque_text(torque: Torque) -> str:
    """Shaft angle and torque over a cycle, as text of `read_trace`, on every other degree."""
    values = torque.resampled(180).total
    rows = [f"{2 * k},{value:.3f}" for k, value in enumerate(values)]
    return "\n".join(["shaft_angle_deg,torque_Nm", *rows]) + "\n"


_HEAD = """\
# A first case: complete, and within all limits. Change one thing at a time, and look again:
#   camwright check @name@.toml
#
# A number with a dimension is written as text with its unit: "100 kN/m", "60 deg", "1500 rpm".
# A card fills in what its table leaves out; keys left out have their defaults, and case.toml in
# the run folder states all of them. Values without a source are those of an example.

schema_version = 1
name = @name@
title = "What is this design for?"
"""

_CRANK_DRIVE = """\
bore = "60 mm"
crank_radius = "21 mm"               # half of the stroke
rod_length = "73 mm"
compression_ratio = 8.5
piston_mass = "144 g"                # with rings and pin
rod_mass = "123 g"
"""

_WHEEL = """\
file = @data@
teeth = 36                           # pitches of the wheel, with
missing_teeth = 2                    # a gap
pitch_tolerance = "0 deg"            # these data are computed; remove the line for a real wheel, or
                                     # give a second record: [engine.reference]
"""

_CRANKSHAFT = """
[crankshaft]
inertia = "0.0139 kg m^2"            # of all that turns: times its acceleration it is the torque
"""

_SOURCES: dict[Kind, str] = {
    "cylinder": f"""\
# --- The torque to balance, of a cylinder model. Crank angle 0: top dead centre where intake
# starts; 360 deg: firing.
[engine]
kind = "cylinder"
{_CRANK_DRIVE}\
intake_pressure = "30 kPa"           # at idle the throttle is nearly shut
spark = "335 deg"                    # 25 deg before firing top dead centre
burn_duration = "80 deg"
""",
    "table": """\
# --- The torque to balance, from a table: a column of crank angle over 720 deg, one of torque,
# units in the header. Crank angle 0: top dead centre where intake starts.
[engine]
kind = "table"
file = @data@
""",
    "pressure": f"""\
# --- The torque to balance, from the cylinder pressure: a column of crank angle over 720 deg, one
# of pressure for each cycle. Crank angle 0: top dead centre where intake starts; 360 deg: firing.
[engine]
kind = "pressure"
file = @data@
# intake_pressure = "30 kPa"         # pegs a sensor that does not measure absolute pressure
{_CRANK_DRIVE}""",
    "speed": f"""\
# --- The torque to balance, from the speed of the crank: times of the edges of a trigger wheel,
# rising and falling in turn, a column for each run.
[engine]
kind = "speed"
{_WHEEL}\
reference_angle = "0 deg"            # crank angle of the first rising edge after the gap
{_CRANKSHAFT}""",
    "voltage": f"""\
# --- The torque to balance, from the speed of the crank: voltage of an inductive pick-up at a
# trigger wheel, a column of time and one of voltage for each run.
[engine]
kind = "voltage"
{_WHEEL}\
reference_angle = "0 deg"            # crank angle of the middle of the first tooth after the gap
{_CRANKSHAFT}""",
    "torque": """\
# --- The torque to balance, of any machine: a column of shaft angle over its cycle, one of torque,
# units in the header. Positive drives the shaft; a steady motor or load takes the mean.
[torque]
kind = "table"
file = @data@
cycle = "360 deg"                    # after which the torque repeats
""",
    "harmonics": """\
# --- The torque to balance, by its mean and harmonics: positive drives the shaft.
[torque]
kind = "harmonics"
mean = "-12 N m"                     # a steady motor or load takes it
harmonics = [                        # order: waves per turn of the shaft
    { order = 1, cosine = "9 N m" },
    { order = 2, sine = "8 N m" },
]
""",
    "compressor": """\
# --- The torque to balance, of a compressor. Shaft angle 0: the outer dead centre.
[torque]
kind = "compressor"
cylinders = [                        # several may differ
    { bore = "66 mm", crank_radius = "25 mm", rod_length = "100 mm", clearance = 0.05, \
suction_pressure = "100 kPa", discharge_pressure = "500 kPa", reciprocating_mass = "0.3 kg" },
]
""",
    "pump": """\
# --- The torque to balance, of a piston pump. Shaft angle 0: the outer dead centre.
[torque]
kind = "pump"
cylinders = [                        # several may differ
    { bore = "24 mm", crank_radius = "25 mm", rod_length = "100 mm", \
suction_pressure = "100 kPa", discharge_pressure = "1800 kPa" },
]
""",
    "press": """\
# --- The torque to balance, of a press. Shaft angle 0: upper dead centre of the ram.
[torque]
kind = "press"
eccentric_radius = "30 mm"
rod_length = "200 mm"
force = "0.5 kN"                     # over the end of the stroke; or a file of it
working_travel = "60 mm"              # all of it: a drawing press
ram_mass = "4 kg"
marks = [                            # names of parts of the cycle, in the pictures
    { angle = "0 deg", name = "drawing" },
    { angle = "180 deg", name = "return" },
]
""",
    "lift": """\
# --- The lift: rises, dwells and returns that fill the turn. Other laws: harmonic,
# modified_sine, polynomial_345, polynomial_4567 and more.
[lift]
kind = "segments"
segment = [
    { law = "cycloidal", angle = "120 deg", stroke = "10 mm" },
    { law = "dwell", angle = "60 deg" },
    { law = "cycloidal", angle = "120 deg", stroke = "-10 mm" },
    { law = "dwell", angle = "60 deg" },
]
""",
    "arm": """\
# --- The swing: rises, dwells and returns that fill the turn, as angles of the arm or arcs of the
# roller's centre. Other laws: harmonic, modified_sine, polynomial_345, polynomial_4567 and more.
[lift]
kind = "segments"
segment = [
    { law = "cycloidal", angle = "120 deg", stroke = "5.7 deg" },
    { law = "dwell", angle = "60 deg" },
    { law = "cycloidal", angle = "120 deg", stroke = "-5.7 deg" },
    { law = "dwell", angle = "60 deg" },
]
""",
    "groove": """\
# --- The lift: rises, dwells and returns that fill the turn. Two equal strokes balance the disc.
# Other laws: cycloidal, polynomial_345, polynomial_4567 and more.
[lift]
kind = "segments"
segment = [
    { law = "modified_sine", angle = "70 deg", stroke = "10 mm" },
    { law = "dwell", angle = "20 deg" },
    { law = "modified_sine", angle = "70 deg", stroke = "-10 mm" },
    { law = "dwell", angle = "20 deg" },
    { law = "modified_sine", angle = "70 deg", stroke = "10 mm" },
    { law = "dwell", angle = "20 deg" },
    { law = "modified_sine", angle = "70 deg", stroke = "-10 mm" },
    { law = "dwell", angle = "20 deg" },
]
""",
    "eccentric": """\
# --- The lift: of a circular disc
[lift]
kind = "eccentric"
eccentricity = "5 mm"                # half of the lift
""",
}

_MECHANISM = """\
# --- The mechanism: parts by their cards where there are any, else as drawn
[mechanism]
gear_ratio = @gear_ratio@ # @turns@
"""

_SPRING = """\
[spring]
rate = "100 kN/m"
preload = "1000 N"                   # at the smallest cam radius
travel_max = "16 mm"

[spring.design]
card = "chrome_silicon"              # wire; also music_wire, chrome_vanadium and others
wire_diameter = "8 mm"
mean_diameter = "44 mm"
coils = 4.64
free_length = "86 mm"
treatment = "peened"
temperature = "60 degC"
relaxation = 0.005                   # share of the force lost: ask the maker
"""

_CAM = """\
[cam]
closure = @held_by@ # the follower is pushed and pulled; no spring
prime_radius = @prime_radius@ # @at@
width = @width@ # @wide@
end = { kind = "sharp" }
bore_radius = "15 mm"
material = "case_hardened"
roughness = "0.3 um"
profile_tolerance = "8 um"           # ground
keyway = { width = "8 mm", depth = "3.3 mm", root_radius = "0.25 mm" }  # DIN 6885-1: 0.16 to 0.25
fit = { least_interference = "15 um", greatest_interference = "22 um" }  # negative: clearance
key = { length = "15 mm", chamfer = "0.4 mm", form = "B", material = "c45" }
"""

_GROOVE = """\
[cam.groove]
clearance = "0.02 mm"                # width of the groove less the diameter of the roller
depth = "18 mm"
corner_radius = "0.4 mm"             # of the end mill; less than the chamfer of the roller
outer_radius = "115 mm"              # of the disc around the groove
"""

_SHAFT = """\
[camshaft]
bearing_spacing = "70 mm"
cam_position = "35 mm"               # from the first bearing; overhung places may be negative
gear_position = "-25 mm"
gear_radius = "40 mm"
diameter = "30 mm"
material = "c45"
bearing_rating = "19.5 kN"           # of two 6206
bearing_static_rating = "11.2 kN"
bearing_width = "16 mm"
counterweight = @counterweight@ # balanced on a bench

[camshaft.gear]
teeth = 40
pinion_teeth = @pinion_teeth@
width = "20 mm"
material = "case_hardened"
bending_limit = "430 MPa"
contact_limit = "1500 MPa"
pinion_bending_limit = "430 MPa"
pinion_contact_limit = "1500 MPa"
machine_shaft_diameter = @beside@ # beside the cam; 0 mm where it ends at its pinion
source = { text = "ISO 6336-5, case-hardened steel, quality MQ", confirmed = false }

[roller]
radius = "23.5 mm"
width = "17.5 mm"
end = { kind = "chamfer", size = "0.6 mm" }
hub_radius = "11.5 mm"               # shoulder of the inner ring
axial_offset = "0.3 mm"
friction = 0.10                      # oiled steel on steel
roughness = "0.1 um"
material = "bearing_steel"

[roller.bearing]
card = "track_roller_47x18"          # 47 x 17.5 mm: compare with the maker's table
static_radial_limit = "8.3 kN"
lubrication = "oil"
viscosity = "27 mm^2/s"              # ISO VG 150 at 80 degC
contamination = "normal_cleanliness"

[roller.pin]
diameter = "17 mm"
mounting = @mounting@ # a cheek on the other side would be in the groove
span = @span@ # @spanned@
material = "case_hardened"

[roller.fork]
cheek_width = @cheek_width@
cheek_height = @cheek_height@
cheek_length = "26 mm"
bridge_length = "4 mm"
material = "c45"
"""

_STEM = """\
[follower]
mass = "1.1 kg"                      # all that moves, with a third of a spring
stem_diameter = "20 mm"
stem_length = "220 mm"
stem_material = "c45"
overhang_at_max_lift = "50 mm"       # from guide A to the roller's centre
anti_rotation = "guided_fork"

[guides]
spacing = "132 mm"                   # middle to middle
ambient_temperature = "60 degC"

[guides.a]                           # next to the cam
card = "ptfe_lined"                  # bush; also bronze, sintered_bronze, pom and others
length = "30 mm"
diameter = "20 mm"
wall = "1.5 mm"
clearance = "0.03 mm"
housing_resistance = "1 K/W"
wear_rate = "3e-8 mm^3/N/m"

[guides.b]
card = "ptfe_lined"
length = "30 mm"
diameter = "20 mm"
wall = "1.5 mm"
clearance = "0.03 mm"
housing_resistance = "1 K/W"
wear_rate = "3e-8 mm^3/N/m"
"""

_ARM = """\
[follower]
kind = "oscillating"
mass = "650 g"                       # inertia about the pivot over the square of the arm's length

[follower.arm]
centre_distance = "110 mm"           # pivot to cam axis
length = "100 mm"                    # pivot to the centre of the roller, or of a [follower.face]
swing = "with"                       # outwards, the arm turns as the cam does; or "against"
width = "28 mm"                      # along the cam axis, over the cheeks of the fork
depth = "24 mm"
bore = "23 mm"                       # seat of the bush
hub = "38 mm"
material = "c45"
pivot_notch = 2.0                    # fatigue notch factors: bore in a bar that bends,
roller_notch = 2.2                   # eye filled by its pin

[follower.pivot]
pin_material = "c45"
ambient_temperature = "60 degC"
swinging_mass = "900 g"
mass_distance = "60 mm"              # pivot to the centre of this mass
gravity_angle = "90 deg"             # the pivot beside the cam; left out: no weight

[follower.pivot.bush]                # or [follower.pivot.needle_bearing]
card = "ptfe_lined"                  # bush; also bronze, sintered_bronze, pom and others
length = "25 mm"
diameter = "20 mm"
wall = "1.5 mm"
clearance = "0.03 mm"
housing_resistance = "1 K/W"
wear_rate = "3e-8 mm^3/N/m"
"""

_SURROUNDINGS = """\
[lubricant]
card = "iso_vg_150"
temperature = "80 degC"

[cooling]
ambient_temperature = "30 degC"      # of the housing
conductance = "2 W/K"                # of a housing of 0.13 m2 at 15 W/(m2 K)

[materials]
case_hardened = { card = "case_hardened" }
bearing_steel = { card = "bearing_steel" }
c45 = { card = "c45" }
"""

_BALANCE = """\
# --- The lift of least torque ripple within all limits
[smoothing]
kind = "constrained"                 # or a filter of the torque: moving_average, gaussian, ...
corners = true                       # within the limits at the ends of all tolerances
jerk_weight = @jerk_weight@ # more: smoother lift, less ripple removed
rest_force_weight = 0.2              # more: weaker spring force, less ripple removed
"""

_REQUIREMENTS = """\
# --- Requirements without a default
[limits]
overspeed = @overspeed@ # greatest speed that the machine can reach
torque_reduction = @reduction@ # least reduction of the torque ripple
roller_life = "1000 h"
shaft_bearing_life = "1000 h"
target_life = "1000 h"               # for wear and fatigue
tool_radius = @tool@ # grinding wheel or cutter
landing_speed = @landing@ # in the clearance: noise and wear
crossover_slip = @slip@ # of the roller, which is to turn the other way
cam_radius = @room@ # room for the cam

[tolerances]
source = "the profile is ground; the rest: defaults"

[solver]
positions = 72                       # per cam turn; 720 for a sign-off

# --- Load cases, one table each; standstill and over-speed are judged besides
[[load_case]]
name = "running"
speed = @speed@ # of the @shaft@
power = @power@ # indicated: friction leaves the torque no mean
"""
