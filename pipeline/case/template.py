"""Case file written by `camwright init`: short, commented, ready to run."""

from __future__ import annotations

from camwright.geometry.errors import InputError
from camwright.pipeline.case.section import SAFE_NAME


def template(name: str) -> str:
    """Text of a new case file.

    Raises
    ------
    InputError
        If the name is not valid for a folder.
    """
    if not SAFE_NAME.fullmatch(name):
        raise InputError("name", name, "1 to 40 letters, digits, '_', '-' or '.'")
    return _TEMPLATE.replace("@NAME@", name)


_TEMPLATE = """\
# A balancing cam. Run it with:  camwright run @NAME@.toml --out runs/@NAME@
#
# A number with a dimension is written as text with its unit: "24.2 kN/m", "60 deg", "1500 rpm".
# Keys left out have their defaults; case.toml in the run folder states all of them.

schema_version = 1
name = "@NAME@"
title = "What is this design for?"

# --- The torque to balance. Crank angle 0: top dead centre where intake starts; 360 deg: firing.
# Measured torque instead of a model: kind = "table" and file = "torque.csv", in the same folder,
# with a column of angle and one of torque, units in the header.
[engine]
kind = "cylinder"
bore = "60 mm"
crank_radius = "21 mm"               # half of the stroke
rod_length = "73 mm"
compression_ratio = 8.5
piston_mass = "144 g"                # with rings and pin
rod_mass = "123 g"
intake_pressure = "28 kPa"           # at idle the throttle is nearly shut
spark = "335 deg"                    # 25 deg before firing top dead centre
burn_duration = "80 deg"
# friction_pressure = "165 kPa"      # left out: the friction that closes the torque balance

[mechanism]
gear_ratio = 2.0                     # crank turns per cam turn

# --- The mechanism
[spring]
rate = "24.2 kN/m"
preload = "400 N"                    # at the smallest cam radius
# travel_max = "40 mm"
# catalogue = "shipped"              # or a file: selects the lightest spring for travel_max

[cam]
prime_radius = "60 mm"          # smallest radius of the roller's CENTRE
width = "10 mm"
bore_radius = "10 mm"
material = "hardened_steel"
# [cam.keyway]
# width = "6 mm"
# depth = "2.8 mm"
# [cam.key]                          # height, shaft_depth and chamfer: DIN 6885 by the width
# length = "14 mm"                   # of form A, its round ends included
# material = "hardened_steel"
# [cam.counter_hole]                 # hole that removes the unbalance
# wall = "3 mm"

# [camshaft]                         # for the checks of its fatigue, bearings and gear
# bearing_spacing = "60 mm"
# cam_position = "20 mm"             # from the first bearing; overhung places may be negative
# gear_position = "-15 mm"
# gear_radius = "20 mm"
# diameter = "20 mm"
# material = "hardened_steel"        # with fatigue_bending and tensile_strength
# bearing_rating = "9.95 kN"
# bearing_static_rating = "5.0 kN"
# slip_torque = "0 N m"              # of a press or clamped seat of the cam; 0: sliding fit
# rotor_mass = "1.2 kg"              # of cam, shaft and gear, for the unbalance

[roller]
radius = "16 mm"
width = "11 mm"
chamfer = "0.5 mm"
hub_radius = "8 mm"                  # pin or inner ring
material = "hardened_steel"

[roller.bearing]                     # ratings of its maker; a check without them is not evaluated
name = "track roller, 32 mm"
C = "6.8 kN"
C0 = "8.3 kN"
speed_limit = "6500 rpm"
# fatigue_load_limit = "350 N"       # P_u; with viscosity and contamination for the modified life
# viscosity = "30 mm^2/s"            # of the oil or base oil, in operation
# contamination = "normal_cleanliness"
# lubrication = "grease_for_life"    # or "grease_relubricated", "oil"
# temperature = "343.15 K"           # for the life of the grease
# radial_limit = "4 kN"              # F_r,max and F_0r,max of an outer ring that rolls on a cam
# static_radial_limit = "6 kN"
source = "made up for this template: replace by the maker's table"

# [roller.pin]
# diameter = "10 mm"
# span = "17 mm"                     # between the middles of the cheeks
# material = "hardened_steel"

# [roller.fork]
# cheek_width = "6 mm"               # of each of two cheeks; height, length and bridge for the mass
# cheek_height = "16 mm"
# cheek_length = "22 mm"
# bridge_length = "8 mm"
# material = "hardened_steel"

[follower]
mass = "250 g"                       # with the roller and half of the spring
stem_diameter = "12 mm"
stem_material = "hardened_steel"
overhang_at_max_lift = "30 mm"       # from guide A to the roller's centre
anti_rotation = "flat"               # or key, square, guided_fork; not_needed by a flat face
# kind = "flat"                      # with a table [follower.face] instead of [roller]: see README

[guides]
spacing = "80 mm"                    # middle to middle
ambient_temperature = "40 degC"      # of the air that cools the housing

[guides.a]                           # next to the cam
length = "24 mm"
diameter = "12 mm"
friction = 0.04                      # friction_min and friction_max bound it; of a nylon bush
                                     # lubrication, "dry" to "flooded", grades the PV limit
clearance = "0.05 mm"
wall = "1.5 mm"
housing_resistance = "2 K/W"         # from the outside of the bush to the ambient; assumed
material = "bronze"
pressure_limit = "14 MPa"            # pressure_limit_temperature: where it holds above 20 degC
speed_limit = "6 m/s"                # assumed: take it from the maker's table, as all limits
pv_limit = "1.75 MPa m/s"
# wear_rate = "1e-7 mm^3/N/m"        # of the maker, for the wear at limits.target_life
source = "Mott, Machine Elements in Mechanical Design, porous bronze, oiled"

[guides.b]
length = "24 mm"
diameter = "12 mm"
friction = 0.04
clearance = "0.05 mm"
wall = "1.5 mm"
housing_resistance = "2 K/W"
material = "bronze"
pressure_limit = "14 MPa"
speed_limit = "6 m/s"
pv_limit = "1.75 MPa m/s"
source = "as guide A"

# --- Materials, each with the source of its values
[materials.hardened_steel]
E = "210 GPa"
nu = 0.3
yield_strength = "1200 MPa"
endurance_pressure = "1490 MPa"      # p0 for 1e8 cycles of rolling with some sliding
density = "7850 kg/m^3"
expansion = "1.2e-5 1/K"             # with that of the bush, for the clearance when warm
condition = "AISI 4340, induction hardened, 50 to 58 HRC"
source = "endurance: Rothbart, Cam Design Handbook (2004), table 9.3; yield assumed"

[materials.bronze]
E = "110 GPa"
nu = 0.34
yield_strength = "150 MPa"
# strength_at = [{ temperature = "150 degC", yield_strength = "120 MPa" }]  # above 100 degC
density = "8800 kg/m^3"
conductivity = "60 W/m/K"
temperature_limit = "150 degC"
expansion = "1.8e-5 1/K"
source = "assumed"

# --- Smoothing, limits and solver
[smoothing]
# or none, gaussian, harmonic, savitzky_golay, smoothing_spline; "constrained" minimises ripple
# and loss by their weights within all limits, over the values that `free` names
kind = "moving_average"
points = 12
spacing = "5 deg"                    # crank angle: 12 points make a window of 60 deg

[limits]
pressure_angle = "30 deg"
torque_reduction = 0.4               # minimum reduction of the torque ripple
# curvature_rate = "0.01 1/mm^2"     # maximum change of the contour curvature per length
# tool_radius = "10 mm"              # concave radii at least a tenth above it

[limits.sources]
torque_reduction = "what this design is for"

[solver]
positions = 72                       # per cam turn; 720 for a final run
max_trials = 3                       # number of lifts, each smoother than the last
certificate_positions = 1            # cam angles solved in full

# --- Workshop files
[workshop]
table_step = "0.5 deg"               # step of the contour table, 0.1 to 1 deg
# tool_radius = "10 mm"              # cutter or grinding wheel; left out: that of the roller
# chord_error = "1 um"               # of the polyline of the drawing

# --- Load cases, one table each
[[load_case]]
name = "idle"
speed = "1500 rpm"
# duty = 1.0                         # share of the operating time, 1 in sum, for life and wear
"""
