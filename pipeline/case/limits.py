"""Table of limits: one row for each value of ``[limits]``.

The table is used by the schema of the case file, the checks, the constrained synthesis with its
shadow prices and conflicts, and the documentation. The demand of a limit is bound to it in
`pipeline/checks`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from math import radians
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Literal, overload

from pydantic import Field, create_model, field_validator

from camwright.geometry.lift import CLOSURE_LIMIT
from camwright.pipeline.base.quantities import In, Known, Meaning
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.verdict import Sense
from camwright.pipeline.case.section import Section, StatedSource, refusal, suggestion

Slope = Literal["whole", "rest", "square", "unit"]

_LENGTH = In("mm", above=0, at_most=10_000)
_PRESSURE = In("MPa", above=0, at_most=1e6)
_SAFETY = In(above=0, at_most=100)
_SHARE = In(above=0, at_most=1)
_INNER_SHARE = In(above=0, below=1)
_RATIO = In(at_least=1, at_most=100)
_LIFE = In("h", above=0, at_most=1e6)
_RESIDUAL = In(above=0, at_most=1e-3)
_REQUIREMENT = Source("requirement of the case", confirmed=True)
_DEFAULT_ROUND_OFF = 1e-9  # of units


@dataclass(frozen=True)
class Limit:
    """Row of the table of limits: a limit with a default.

    Parameters
    ----------
    id : str           key in ``[limits]``
    title : str        words for shadow prices and conflicts
    quantity : In      unit as written, and bounds
    default : float    SI
    source : Source       clause or book behind the default
    sense : str        "at_most": a demand at or below it passes; "at_least": at or above it
    slope : str        fall of a utilisation with the limit: "whole" 1/limit, "rest" 1/(1 - limit)
                       for a share that is left, "square" 2/limit where the demand grows with the
                       square, "unit" 1 where the synthesis bounds the difference
    """

    id: str
    title: str
    quantity: In
    default: float
    source: Source
    sense: Sense = "at_most"
    slope: Slope = "whole"


@dataclass(frozen=True)
class OpenLimit:
    """Row of the table of limits without a default: None unless the case sets it.

    found : str          where its value is found
    example : str or float   a value, as in a case file
    """

    id: str
    title: str
    quantity: In
    source: Source
    sense: Sense = "at_most"
    slope: Slope = "whole"
    _: KW_ONLY
    found: str
    example: str | float

    @property
    def default(self) -> None:
        """None: no requirement unless the case sets one."""
        return None


AnyLimit = Limit | OpenLimit


def utilisation_slope(limit: AnyLimit, value: float) -> float:
    """Decrease of the utilisation per unit of its limit, SI, at the value `value` of the limit, by
    the form of the utilisation; negative if a greater limit reduces the margin.
    """
    sign = 1.0 if limit.sense == "at_most" else -1.0
    if limit.slope == "rest":
        return sign / (1.0 - value)
    return sign * {"whole": 1.0 / value, "square": 2.0 / value, "unit": 1.0}[limit.slope]


CLOSURE = Limit(  # as the reader of tables: the last digit of a table in mm with three decimals
    "closure", "lift closure", In("mm", above=0, at_most=1), CLOSURE_LIMIT,
    Source(
        "1 um, the resolution of a lift table; fundamental law of cam design, Norton (2009) ch. 2",
        confirmed=True,
    ),
)  # fmt: skip
PRESSURE_ANGLE = Limit(
    "pressure_angle", "pressure angle", In("deg", above=0, below=90), radians(30.0),
    Source(
        "30 deg as a rule for a translating follower, about 35 deg for an oscillating one:"
        " Norton, Cam Design and Manufacturing Handbook, 2nd ed. 2009, text to fig. 7-2",
        confirmed=True,
    ),
)  # fmt: skip
RETURN_PRESSURE_ANGLE = OpenLimit(  # friction cannot lock a follower that the spring drives
    "return_pressure_angle", "pressure angle on the return", In("deg", above=0, below=90),
    Source(
        "45 deg on the return, where the cam does not drive the follower, textbooks of"
        " mechanisms; without it that of pressure_angle",
        confirmed=False,
    ),
    found="textbooks: the return may be steeper than the rise", example="45 deg",
)  # fmt: skip
CURVATURE_RATIO = Limit(
    "curvature_ratio", "convex pitch radius over roller radius", _RATIO, 2.0,
    Source(
        "2 to 3 roller radii, the safer: lecture notes on cams, read; 1.5 to 3, as recalled of"
        " Norton (2009) ch. 7",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
UNDERCUT_FACTOR = Limit(
    "undercut_factor", "undercut factor", _INNER_SHARE, 0.3,
    Source(
        "0: cusp, Rothbart (ed.), Cam Design Handbook, McGraw-Hill 2004, sec. 6.4.2, p. 170,"
        " fig. 6.10; flat face: sec. 6.4.3, p. 173; the margin above 0 is recalled",
        confirmed=False,
    ), "at_least", "rest",
)  # fmt: skip
SECOND_CONTACT_DEPTH = Limit(  # below the form error of ground cams
    "second_contact_depth", "depth of a second contact", In("mm", above=0, at_most=1), 1e-6,
    Source("one contact at a time, Rothbart (2004) ch. 6", confirmed=True),
)  # fmt: skip
TOOL_RADIUS = OpenLimit(
    "tool_radius", "tool radius for concave flanks", _LENGTH,
    Source(
        "concave radius at least 1.1 tool radii, as recalled of Rothbart (2004) ch. 6",
        confirmed=False,
    ), "at_least",
    found="machine tool", example="25 mm",
)  # fmt: skip
CURVATURE_RATE = OpenLimit(
    "curvature_rate", "rate of change of curvature along the contour",
    In("1/mm^2", above=0, at_most=1e9),
    Source("limit of the case, for grinding and wear", confirmed=True),
    found="grinding machine", example="0.02 1/mm^2",
)  # fmt: skip
MINIMUM_WALL = Limit(  # outer over inner radius of the ring about the bore
    "minimum_wall", "contour radius over bore radius", _RATIO, 1.75,
    Source(
        "hub of 1.75 shaft diameters; for cast iron 6.35 mm more, which is safer, for steel"
        " slightly less than that: Rothbart (ed.), Cam Design Handbook, McGraw-Hill 2004, sec."
        " 6.4.4, p. 173, eq. 6.21",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
CONTACT_SAFETY = Limit(
    "contact_safety", "safety of the contact pressure", _SAFETY, 1.0,
    Source("surface endurance of cam and follower", confirmed=True),
)  # fmt: skip
YIELD_SAFETY = Limit(
    "yield_safety", "safety against first yield", _SAFETY, 1.0,
    Source("yield strength; p0 = 1.79 Y, Johnson (1985) sec. 6.1", confirmed=True),
)  # fmt: skip
SHAKEDOWN_SAFETY = Limit(
    "shakedown_safety", "safety against shakedown", _SAFETY, 1.0,
    Source("elastic shakedown, Johnson (1985) sec. 9.2", confirmed=True),
)  # fmt: skip
CONTACT_FORCE_MARGIN = Limit(
    "contact_force_margin", "minimum contact force over least spring force", _INNER_SHARE, 0.2,
    Source(
        "0.2 to 0.3 of the preload at the highest speed, as recalled of Norton (2009)",
        confirmed=False,
    ), "at_least", "unit",
)  # fmt: skip
JUMP = Limit(
    "jump", "inertia over spring force", _SAFETY, 1.0,
    Source("F_s + m w^2 s'' > 0, follower jump, Norton (2009) and Rothbart (2004)", confirmed=True),
)  # fmt: skip
OVERSPEED = OpenLimit(
    "overspeed", "overspeed", In("rpm", above=0, below=20_000),
    Source("overspeed of the case", confirmed=True),
    found="governor, or engine data sheet: 1.1 times the rated speed", example="3960 rpm",
)  # fmt: skip
JUMP_SPEED = Limit(
    "jump_speed", "jump speed over overspeed", _RATIO, 1.3,
    Source(
        "1.3 times the overspeed, Norton (2009), Rothbart (2004)",
        confirmed=False,
    ), "at_least", "square",
)  # fmt: skip
GUIDE_GAP = Limit(
    "guide_gap", "gap at guide A", In("mm", above=0, at_most=1000), 0.001,
    Source("1 to 2 mm, shop practice", confirmed=False), "at_least",
)  # fmt: skip
ASSEMBLY_GAP = Limit(
    "assembly_gap", "gap between parts that pass one another",
    In("mm", above=0, at_most=1000), 2e-4,
    Source(
        "0.2 mm, tolerance of one length from 6 to 30 mm, DIN ISO 2768-1 medium, table 1,"
        " read in a copy; both parts at their worst ends close a gap by 0.4 mm",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
CAM_RADIUS = OpenLimit(
    "cam_radius", "cam radius", _LENGTH, Source("installation space of the case", confirmed=True),
    found="installation space", example="90 mm",
)  # fmt: skip
LANDING_SPEED = OpenLimit(  # of a roller in a groove
    "landing_speed", "landing speed in the clearance of two tracks",
    In("mm/s", above=0, at_most=1e5),
    Source("bound of the case, noise and wear of the walls", confirmed=True),
    found="requirement of the machine", example="50 mm/s",
)  # fmt: skip
WORN_CLEARANCE = OpenLimit(
    "worn_clearance", "clearance between the tracks of a worn cam that pulls",
    In("mm", above=0, at_most=10),
    Source("bound of the case, play and noise of the machine", confirmed=True),
    found="requirement of the machine", example="0.05 mm",
)  # fmt: skip
CROSSOVER_SLIP = OpenLimit(
    "crossover_slip", "slip of the roller at a crossover", In("m/s", above=0, at_most=1e3),
    Source("bound of the case, wear of the walls", confirmed=True),
    found="requirement of the machine", example="4 m/s",
)  # fmt: skip
TARGET_LIFE = OpenLimit(
    "target_life", "target life", _LIFE,
    Source(
        "log10 K = (B - log10 N)/A, Rothbart (ed.), Cam Design Handbook, McGraw-Hill 2004,"
        " sec. 9.4.4.2, p. 267, eq. 9.15",
        confirmed=True,
    ),
    found="requirement of the machine", example="1000 h",
)  # fmt: skip
END_MEAN_LENGTH = Limit(
    "end_mean_length", "length of the mean pressure at an end with a corner",
    In("mm", at_least=0.02, at_most=10), 1e-4,
    Source(
        "0.1 mm, about a half-width of contact: the mean over it does not depend on the mesh",
        confirmed=True,
    ),
)  # fmt: skip
AXIS_PARALLELISM = Limit(
    "axis_parallelism", "tilt of the cam axis to that of the follower as made",
    In("mrad", at_least=0, at_most=100), 1e-4,
    Source(
        "0.01 mm over 100 mm, bores machined in one setting, ISO 1101",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
CAM_RUN_OUT = Limit(
    "cam_run_out", "axial run-out of the cam on its shaft at the base circle, full reading",
    In("um", at_least=0, at_most=1000), 5e-6,
    Source(
        "5 um: IT3 of seats and shoulders is 3 to 5 um up to 80 mm, 8 um up to 180 mm, NSK,"
        " Rolling bearings, p. A 100, table 11.1, and p. C 22",
        confirmed=True,
    ), "at_least",
)  # fmt: skip
ROLLER_MISALIGNMENT = Limit(
    "roller_misalignment", "angle between the rings of the roller's bearing",
    In("mrad", above=0, at_most=100), 1e-3,
    Source(
        "0.001 to 0.003 rad of deep-groove ball bearings, the lower end: Shigley's Mechanical"
        " Engineering Design, 9th ed., p. 379, table 7-2; 0.0005 to 0.003 by RBC Bearings",
        confirmed=True,
    ),
)  # fmt: skip
ROLLER_CLEARANCE = Limit(  # at either end of it the contact turns the roller back: nothing holds it
    "roller_clearance", "radial clearance in which the roller tilts on its bearing, over its width",
    In("um", at_least=0, at_most=1000), 0.0,
    Source(
        "0 um, the contact force seats the roller on its bearing; one that is not seated has"
        " that of its catalogue, 3 to 18 um of group N at bores of 10 to 18 mm, ISO 5753-1,"
        " read in a maker's table",
        confirmed=False,
    ),
    "at_least",
)  # fmt: skip
WAVINESS = Limit(
    "waviness", "waviness force over contact force", _SHARE, 0.2,
    Source(
        "10 to 20 % of the force, recalled; Rothbart (ed.), Cam Design Handbook, McGraw-Hill"
        " 2004, sec. 10.4.6, p. 295, states no number",
        confirmed=False,
    ),
)  # fmt: skip
CHORD_SHARE = Limit(
    "chord_share", "chord error over profile tolerance", _SHARE, 0.25,
    Source("a quarter of the profile tolerance, geometry", confirmed=True),
)  # fmt: skip
JAM_INDEX = Limit(
    "jam_index", "jam index", _INNER_SHARE, 0.5,
    Source(
        "self-locking at 1, as recalled of Rothbart (2004) eq. 6.8; safety factor 2",
        confirmed=False,
    ),
)  # fmt: skip
ROLLER_STATIC_SAFETY = Limit(
    "roller_static_safety", "static safety of the roller bearing", _SAFETY, 2.0,
    Source(
        "s0 = C0/P0 >= 2 of balls that run quietly, 1.5 under vibration and shocks: NSK, Rolling"
        " bearings, p. A 33, table 5.8; 2 under heavy shocks, SMS, read second-hand. A roller that"
        " leaves the cam or crosses its backlash lands with a shock",
        confirmed=True,
    ), "at_least",
)  # fmt: skip
PIVOT_STATIC_SAFETY = Limit(
    "pivot_static_safety", "static safety of the needle bearing of a pivot", _SAFETY, 3.0,
    Source(
        "s0 = C0/P0 >= 3 of rollers that run quietly or under shocks: NSK, Rolling bearings, table"
        " 5.8, recalled",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
PIVOT_LIFE = OpenLimit(
    "pivot_life", "rating life of the needle bearing of a pivot", _LIFE,
    Source("ISO 281", confirmed=True), "at_least",
    found="requirement of the machine", example="1000 h",
)  # fmt: skip
ROLLER_LIFE = OpenLimit(
    "roller_life", "rating life of the roller bearing", _LIFE,
    Source("ISO 281", confirmed=True), "at_least",
    found="requirement of the machine", example="1000 h",
)  # fmt: skip
ROLLER_RELIABILITY = Limit(
    "roller_reliability", "reliability of the rating life", In(at_least=0.9, at_most=0.9995), 0.9,
    Source("90 %: rating life of ISO 281:2007, table 12", confirmed=True), "at_least",
)  # fmt: skip
ROLLER_LOAD_SHARE = Limit(
    "roller_load_share", "roller load over dynamic rating", _SHARE, 0.5,
    Source(
        "rating life holds up to P = 0.5 C, as recalled of ISO 281:2007, 1",
        confirmed=False,
    ),
)  # fmt: skip
ROLLER_SPEED_SHARE = Limit(
    "roller_speed_share", "roller speed over limiting speed", _SHARE, 0.7,
    Source("share of the limiting speed", confirmed=True),
)  # fmt: skip
PIN_SHARE = Limit(
    "pin_share", "pin stress over yield strength", _SHARE, 0.6,
    Source("0.6 of the yield strength", confirmed=True),
)  # fmt: skip
PIN_FATIGUE_SAFETY = Limit(
    "pin_fatigue_safety", "fatigue safety of the roller pin", _SAFETY, 1.5,
    Source(
        "Goodman, Shigley's Mechanical Engineering Design, 9th ed., ch. 6, endurance half of"
        " R_m, eq. 6-8; 1.5, recalled, covers size and surface of a ground pin",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
PIN_PRESSURE_SHARE = Limit(
    "pin_pressure_share", "pressure in the pin's seats over tensile strength", _SHARE, 0.25,
    Source(
        "0.25 R_m under pulsating load in a seat without sliding, Roloff/Matek, table of pins",
        confirmed=False,
    ),
)  # fmt: skip
FOLLOWER_MASS_RATIO = Limit(
    "follower_mass_ratio", "drawn mass over stated mass of the follower", In(above=0, at_most=2),
    1.03, Source("3 %, scatter of weighed parts, shop practice", confirmed=False),
)  # fmt: skip
SPRING_FATIGUE = Limit(
    "spring_fatigue", "fatigue safety of the spring", _SAFETY, 1.2,
    Source(
        "Goodman line through Zimmerli's point, infinite life of wires below 10 mm: 241/379"
        " MPa, peened 398/534 MPa, Shigley ch. 10, read second-hand; 1.2 recalled",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
SPRING_SOLID = Limit(
    "spring_solid", "solid-height clearance of the spring", In(above=0, at_most=10), 0.25,
    Source(
        "25 % of the greatest working deflection, the safer: lecture notes on the design of"
        " springs, read; 10 to 15 %, as recalled of Shigley ch. 10",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
SPRING_SURGE = Limit(
    "spring_surge", "surge frequency over cam frequency", In(above=0, at_most=1e4), 15.0,
    Source(
        "15 times the cam's frequency, the safer: Analysis and Design of Machine Elements, p. 409;"
        " 15 to 20 by Shigley, ch. 10, read second-hand; 13 by Rockford Spring, Dynamic loading of"
        " springs, and Juvinall and Marshek, Fundamentals of Machine Component Design, 3rd ed.;"
        " VDI 2149-1 takes a mechanism as rigid whose lowest natural frequency is at least 10"
        " times that of its crank",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
KEY_SHARE = Limit(
    "key_share", "key stress over yield strength", _SHARE, 0.9,
    Source("0.9 R_e of the weaker part, DIN 6892 method C, read second-hand", confirmed=False),
)  # fmt: skip
KEY_REVERSAL = Limit(
    "key_reversal", "share of the key stress under reversed torque", _SHARE, 0.25,
    Source(
        "a quarter at 1e9 reversals, the safer: DIN 6892, eq. 3, f_W = 2 N^-0.1 <= 1, read"
        " second-hand; half, textbooks of machine elements, holds to 1e6",
        confirmed=False,
    ),
)  # fmt: skip
KEYWAY_SAFETY = Limit(
    "keyway_safety", "fatigue safety of the keyway root in the cam", _SAFETY, 1.5,
    Source(
        "1.5, recalled; Goodman, Shigley's Mechanical Engineering Design, 9th ed., ch. 6, and"
        " the FKM guideline, local stresses",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
CAM_SLIP = Limit(
    "cam_slip", "slip torque of the cam seat over its torque", _SAFETY, 1.5,
    Source("1.5 against slip under alternating torque, DIN 7190", confirmed=False), "at_least",
)  # fmt: skip
BORE_SHARE = Limit(
    "bore_share", "bore pressure over tensile strength", _SHARE, 0.25,
    Source(
        "0.25 R_m of a pulsating joint without sliding, Roloff/Matek, bolts and pins",
        confirmed=False,
    ),
)  # fmt: skip
SHAFT_SAFETY = Limit(
    "shaft_safety", "fatigue safety of the camshaft", _SAFETY, 1.5,
    Source(
        "1.5, recalled; Goodman, Shigley's Mechanical Engineering Design, 9th ed., sec. 7-4;"
        " notches by its table 7-1, p. 373, K_t = 2.14 in bending and 3.0 in torsion at a"
        " keyway, or DIN 743-2",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
ARM_SAFETY = Limit(
    "arm_safety", "fatigue safety of the arm", _SAFETY, 1.5,
    Source(
        "1.5, recalled, as of the camshaft; Goodman and Marin, Shigley's Mechanical Engineering"
        " Design, 9th ed., ch. 6; notches by Peterson's Stress Concentration Factors",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
ARM_YIELD_SAFETY = Limit(
    "arm_yield_safety", "safety of the arm against yield", _SAFETY, 1.2,
    Source("1.2, as of a shaft by DIN 743-1", confirmed=False),
)  # fmt: skip
SHAFT_RELIABILITY = Limit(
    "shaft_reliability", "reliability of the fatigue strength of camshaft and arm",
    In(at_least=0.5, below=1), 0.99,
    Source(
        "k_e = 0.814 at 99 %, Shigley's Mechanical Engineering Design, 9th ed., p. 293, table"
        " 6-5",
        confirmed=True,
    ), "at_least", "rest",
)  # fmt: skip
SHAFT_YIELD_SAFETY = Limit(
    "shaft_yield_safety", "safety of the camshaft against yield", _SAFETY, 1.2,
    Source("1.2, DIN 743-1", confirmed=False),
)  # fmt: skip
SHAFT_DEFLECTION = Limit(
    "shaft_deflection", "deflection at the cam over bearing spacing", _SHARE, 1.0 / 3000.0,
    Source("l/3000, general machinery, Roloff/Matek", confirmed=False),
)  # fmt: skip
SHAFT_SLOPE = Limit(
    "shaft_slope", "slope of the camshaft at a bearing", In("mrad", above=0, at_most=100), 1e-3,
    Source(
        "0.001 to 0.003 rad of deep-groove ball bearings, the lower end: Shigley's Mechanical"
        " Engineering Design, 9th ed., p. 379, table 7-2",
        confirmed=True,
    ),
)  # fmt: skip
SHAFT_BEARING_STATIC_SAFETY = Limit(
    "shaft_bearing_static_safety", "static safety of the camshaft bearings", _SAFETY, 2.0,
    Source(
        "s0 = C0/P0 >= 2 of balls that run quietly, 1.5 under vibration and shocks: NSK, Rolling"
        " bearings, p. A 33, table 5.8; 2 under heavy shocks, SMS, read second-hand",
        confirmed=True,
    ), "at_least",
)  # fmt: skip
SHAFT_BEARING_LIFE = OpenLimit(
    "shaft_bearing_life", "rating life of the camshaft bearings", _LIFE,
    Source("ISO 281", confirmed=True), "at_least",
    found="requirement of the machine", example="1000 h",
)  # fmt: skip
GEAR_BENDING_SAFETY = Limit(
    "gear_bending_safety", "safety of tooth root bending", _SAFETY, 1.45,
    Source(
        "Lewis (1892); 1.45 by IEC 61400-1:2005, sec. 9.4, read second-hand, the safer for"
        " drives that are not critical; 1.4 for auxiliary drives of ships, ABS, and 1.6 to 1.8 for"
        " their critical and main ones, second-hand; 0.7 for a reversed load, as recalled of ISO"
        " 6336-3",
        confirmed=False,
    ),
)  # fmt: skip
GEAR_CONTACT_SAFETY = Limit(
    "gear_contact_safety", "safety of tooth contact", _SAFETY, 1.2,
    Source(
        "1.2 by IEC 61400-1:2005, sec. 9.4, read second-hand, the safer; 1.0, as recalled of"
        " ISO 6336-2",
        confirmed=False,
    ),
)  # fmt: skip
UNBALANCE = Limit(
    "unbalance", "unbalance of the camshaft", In("mm/s", above=0, at_most=1e4), 6.3e-3,
    Source(
        "e w of grade G 6.3, general machinery, ISO 21940-11:2016, table 1, read second-hand",
        confirmed=False,
    ),
)  # fmt: skip
FILM_RATIO = Limit(
    "film_ratio", "lambda ratio", In(above=0, at_most=100), 1.0,
    Source(
        "below 1 boundary, above 3 to 4 no contact of asperities, mixed between: Norton, Machine"
        " Design, 4th ed., text to fig. 10-13, read second-hand; ESDU 94008, Lubricant film"
        " thickness between disc cams and followers, has a method, by its abstract",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
TRACTION_SHARE = Limit(
    "traction_share", "traction demand over friction", In(above=0, at_most=1), 0.5,
    Source(
        "half of the friction, recalled; Rothbart (ed.), Cam Design Handbook, McGraw-Hill 2004,"
        " p. 308, eq. 10.7, bounds the traction by the whole of it",
        confirmed=False,
    ),
)  # fmt: skip
FATIGUE_SAFETY = Limit(
    "fatigue_safety", "safety against subsurface fatigue", _SAFETY, 1.0,
    Source("fatigue limit in torsion", confirmed=True),
)  # fmt: skip
CASE_SAFETY = Limit(
    "case_safety", "safety of case and core", _SAFETY, 1.0,
    Source("yield strengths of case and core", confirmed=True),
)  # fmt: skip
CASE_DEPTH_RATIO = Limit(
    "case_depth_ratio", "case depth over depth of maximum shear", _SAFETY, 2.0,
    Source("2 to 3 times the depth, shop practice", confirmed=False), "at_least",
)  # fmt: skip
BORE_SAFETY = Limit(
    "bore_safety", "safety of the bore", _SAFETY, 1.0,
    Source("yield strength of the core", confirmed=True),
)  # fmt: skip
VISCOSITY_RATIO = Limit(
    "viscosity_ratio", "viscosity ratio", _SAFETY, 0.1,
    Source(
        "a_ISO of ISO 281 is calculated from kappa = 0.1 to 4 and counts a thin film; SKF,"
        " lubrication condition, advises kappa >= 1, and an oil with EP additives below 0.4",
        confirmed=True,
    ), "at_least",
)  # fmt: skip
WEAR_DEPTH = Limit(
    "wear_depth", "wear depth", _LENGTH, 5e-5,
    Source(
        "0.05 mm, shop practice, safer than 0.127 mm of Ford's service data; Archard (1953)",
        confirmed=False,
    ),
)  # fmt: skip
ACCELERATION_STEP = Limit(  # of the range: less may be rounding of a table to 1 um
    "acceleration_step", "acceleration step", _SHARE, 0.2,
    Source(
        "finite jerk, fundamental law of cam design, Norton (2009) ch. 2; resolution of a table",
        confirmed=True,
    ),
)  # fmt: skip
GUIDE_LENGTH = Limit(
    "guide_length", "guided length over overhang", _SAFETY, 2.0,
    Source(
        "bearing length at least twice the overhang, as recalled of Rothbart (2004) ch. 6",
        confirmed=False,
    ), "at_least",
)  # fmt: skip
TORQUE_REDUCTION = Limit(
    "torque_reduction", "torque ripple reduction", _INNER_SHARE, 0.4,
    _REQUIREMENT, "at_least",
)  # fmt: skip
DRIVE_TORQUE = OpenLimit(
    "drive_torque", "torque that drives the cam", In("N m", above=0, at_most=1e8),
    Source(
        "torque of the drive",
        confirmed=True,
    ), found="drive or motor data sheet", example="10 N m",
)  # fmt: skip
SPEED_REDUCTION = OpenLimit(
    "speed_reduction", "speed ripple reduction", _INNER_SHARE,
    _REQUIREMENT, "at_least",
    found="requirement of the machine", example=0.1,
)  # fmt: skip
CONTACT_TORQUE = Limit(
    "contact_torque", "cam torque from contact pressures", In(above=0, at_most=0.01), 1e-4,
    Source(
        "sum of moments, at most 1 % from contact pressures, ASME V&V 10-2019; flat patch: 1e-4",
        confirmed=True,
    ),
)  # fmt: skip
FRICTION_POWER = Limit(
    "friction_power", "friction power", _SHARE, 0.2,
    Source(
        "a fifth of the power that an engine indicates at idle, all of it friction, goes into"
        " its valve train: the crankshaft has 1.5 to 2 times its friction, the pistons as much as"
        " both, so that a sixth to a fifth is its share, Wong and Tung, Friction 4 (2016) 1, to"
        " fig. 2, read second-hand",
        confirmed=False,
    ),
)  # fmt: skip
SURFACE_TEMPERATURE = Limit(
    "surface_temperature", "temperature of the surfaces", In("K", above=0, at_most=5000), 423.15,
    Source(
        "150 degC: tempering of 16MnCr5 at 150 to 200 degC, Saarstahl, of 100Cr6 from 150"
        " degC on, Lucefin; the layer adsorbed from a mineral oil without additives, on which"
        " a contact without a full film rests, is lost at 120 to 150 degC, textbooks, recalled",
        confirmed=False,
    ),
)  # fmt: skip
FRICTION_BALANCE = Limit(
    "friction_balance", "friction balance", _RESIDUAL, 1e-6,
    Source("conservation of energy over one turn", confirmed=True),
)  # fmt: skip
EQUILIBRIUM = Limit(
    "equilibrium", "equilibrium residual", _RESIDUAL, 1e-9,
    Source(
        "equilibrium and contact conditions, ASME V&V 10-2019, solution verification",
        confirmed=True,
    ),
)  # fmt: skip
COMPLEMENTARITY = Limit(
    "complementarity", "contact law residual", _RESIDUAL, 1e-9,
    Source(
        "equilibrium and contact conditions, ASME V&V 10-2019, solution verification",
        confirmed=True,
    ),
)  # fmt: skip
MESH_UNCERTAINTY = Limit(
    "mesh_uncertainty", "discretisation uncertainty", In(above=0, at_most=1), 0.03,
    Source("grid convergence index, ASME V&V 20-2009, sec. 2-4; <= 3 %", confirmed=True),
)  # fmt: skip

LIMITS: Mapping[str, AnyLimit] = MappingProxyType(
    {row.id: row for row in tuple(globals().values()) if isinstance(row, (Limit, OpenLimit))}
)
"""Every row by its key, in the order of the file."""


def is_weaker(limit: AnyLimit, value: float | None) -> bool:
    """Whether a value, SI, is weaker than the default of its row, or a safety below 1.

    A requirement of the case has no default to be weaker than.
    """
    if value is None or limit.source == _REQUIREMENT:
        return False
    safety = limit.id.endswith("safety")
    floor = safety or limit.sense == "at_least"
    if safety and value < 1.0:
        return True
    default = limit.default
    if default is None:
        return False
    least, most = default * (1.0 - _DEFAULT_ROUND_OFF), default * (1.0 + _DEFAULT_ROUND_OFF)
    return value < least if floor else value > most


class LimitValues(Section):
    """Limits of the checks."""

    sources: Annotated[
        dict[str, StatedSource],
        Known("requirement, standard or textbook", {"cam_radius": "room beside the crankcase"}),
    ] = Field(default_factory=dict)
    """source of single limits by their key"""

    @overload
    def __getitem__(self, limit: Limit) -> float: ...
    @overload
    def __getitem__(self, limit: OpenLimit) -> float | None: ...
    def __getitem__(self, limit: AnyLimit) -> float | None:
        """Value of a limit, SI; None for an open one that the case leaves out."""
        value: float | None = getattr(self, limit.id)
        return value

    def source(self, limit: AnyLimit) -> Source:
        """Source of a value: from the case, else of the default."""
        return self.sources.get(limit.id) or limit.source

    @field_validator("sources")
    @classmethod
    def _name_limits(cls, sources: dict[str, Source]) -> dict[str, Source]:
        """Refuse the source of a limit that does not exist."""
        for key in sources:
            if key not in LIMITS:
                raise refusal(f"a known limit{suggestion(key, LIMITS)}", unknown_key=key)
        return sources


def _field_type(limit: AnyLimit) -> object:
    """Type of the field of a limit in the section `[limits]`, with unit, bounds, meaning and
    example.
    """
    known = (
        Known(str(limit.source)) if isinstance(limit, Limit) else Known(limit.found, limit.example)
    )
    hint = Annotated[float, limit.quantity, Meaning(limit.title), known]
    return hint if isinstance(limit, Limit) else hint | None


if TYPE_CHECKING:
    Limits = LimitValues
else:
    Limits = create_model(
        "Limits",
        __base__=LimitValues,
        __doc__=LimitValues.__doc__,
        **{row.id: (_field_type(row), row.default) for row in LIMITS.values()},
    )
