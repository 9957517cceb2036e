"""Cases and problems of synthesis with an arm: roller, flat and curved face, bearings, springs."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace

from oracle_arms import OracleArm
from oracle_limits import TORQUE_REDUCTION
from swung_face import face_text
from synthesis_problems import nominal, thinned

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.template import first_case
from camwright.pipeline.smoothing.constraints import CONSTRAINTS
from camwright.pipeline.smoothing.objective import TORQUE, Weighted
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.smoothing.synthesis_problem import Problem

ARM = {
    "centre_distance": "110 mm", "length": "95 mm", "swing": "with", "width": "28 mm",
    "depth": "24 mm", "hub": "36 mm", "plane_offset": "1 mm", "material": "c45",
    "pivot_notch": 2.0, "roller_notch": 2.5,
}  # fmt: skip
PIVOT = {
    "pin_material": "case_hardened", "ambient_temperature": "30 degC", "swinging_mass": "1.5 kg",
    "mass_distance": "60 mm", "mass_angle": "8 deg", "gravity_angle": "70 deg",
    "load_distance": "50 mm", "load_angle": "-15 deg", "load_moment": "1.5 N m",
}  # fmt: skip
BEARINGS = {
    "bush": {
        "card": "ptfe_lined", "length": "30 mm", "diameter": "20 mm", "wall": "1.5 mm",
        "clearance": "0.03 mm", "housing_resistance": "2 K/W", "wear_rate": "3e-8 mm^3/N/m",
    },
    "needle_bearing": {
        "length": "20 mm", "diameter": "18 mm", "friction": 0.004, "C": "20 kN", "C0": "30 kN",
    },
}  # fmt: skip
SPRINGS = {
    "coil": {},
    "torsion_pivot": {
        "kind": "torsion_pivot",
        "torsion_pivot": {
            "moment": "95 N m", "angular_rate": "900 N m/rad", "wire_diameter": "16 mm",
            "mean_diameter": "100 mm", "tensile_strength": "1900 MPa", "stress_range": "900 MPa",
        },
    },
    "link": {"link": {
        "arm_radius": "80 mm", "arm_angle": "6 deg", "fixed_radius": "120 mm",
        "fixed_angle": "65 deg", "rate": "140 kN/m", "preload": "1200 N",
    }},
}  # fmt: skip


MASS_ALONE = ("pin_material", "ambient_temperature", "swinging_mass", "mass_distance", "mass_angle")
"""Keys of a pivot about which neither weight nor external forces act."""


def arm_case(
    kind: str, bearing: str, spring: str, swing: str = "with", stated: Mapping[str, object] = PIVOT
) -> Case:
    """Case with the torque of a cylinder, a described arm and pivot.

    kind : roller, flat or curved; stated: keys of the pivot besides its bearing
    """
    if kind == "roller":
        tables = tomllib.loads(first_case("swing", "cylinder").text)
        tables["follower"] = {"kind": "oscillating", "mass": "1.1 kg"}
        del tables["guides"]
    else:
        tables = tomllib.loads(face_text(kind, "cylinder"))
        del tables["scope"]
    tables["follower"] |= {
        "arm": ARM | {"swing": swing}, "pivot": dict(stated) | {bearing: BEARINGS[bearing]}
    }  # fmt: skip
    if spring != "coil":
        tables["spring"] = {"travel_max": "20 mm"} | SPRINGS[spring]
    tables["limits"] = tables.get("limits", {}) | {
        "curvature_rate": "0.5 1/mm^2", "pivot_life": "2000 h",
    }  # fmt: skip
    return case_of(tables)


def arm_problem(
    *about: str,
    coefficients: int,
    points: int,
    weight: bool = False,
    corners: tuple[str, ...] = (),
    **tighter: float,
) -> tuple[Problem, OracleArm]:
    """Synthesis of a cam under an arm, and its formulas, at nominal values.

    about : kind, bearing, spring and sense of the swing of `arm_case`; weight: of what swings;
    corners: words in the names of tolerance corners that are kept, too; tighter: factors on bounds
    """
    keys = (*MASS_ALONE, *(("gravity_angle",) if weight else ()))
    case = arm_case(*about, stated={key: PIVOT[key] for key in keys})
    whole = problem_of(case, engine_torques(case))
    at_corners = [one for one in whole.scenarios if any(word in one.name for word in corners)]
    whole = replace(nominal(whole), scenarios=(*nominal(whole).scenarios, *at_corners))
    problem = thinned(whole, coefficients, points)
    bounds = dict(problem.ratings.bounds)
    for name, factor in tighter.items():
        bounds[name] *= factor
    ratings = replace(problem.ratings, bounds=bounds)
    problem = replace(problem, ratings=ratings, objective=(Weighted(TORQUE, 1.0),))
    arm = OracleArm.of(case, problem)
    kept = {each.check for each in arm.limits} | {TORQUE_REDUCTION}
    left_out = frozenset(each.check for each in CONSTRAINTS) - kept
    return replace(problem, left_out=left_out), arm
