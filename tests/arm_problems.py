"""Cases and problems of synthesis with an arm: roller, flat and curved face, bearings, springs."""

import tomllib

from swung_face import face_text

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.template import first_case

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


def arm_case(kind: str, bearing: str, spring: str, swing: str = "with") -> Case:
    """Case with the torque of a cylinder, a described arm and pivot; kind: roller, flat, curved."""
    if kind == "roller":
        tables = tomllib.loads(first_case("swing", "cylinder").text)
        tables["follower"] = {"kind": "oscillating", "mass": "1.1 kg"}
        del tables["guides"]
    else:
        tables = tomllib.loads(face_text(kind, "cylinder"))
        del tables["scope"]
    tables["follower"] |= {
        "arm": ARM | {"swing": swing}, "pivot": PIVOT | {bearing: BEARINGS[bearing]}
    }  # fmt: skip
    if spring != "coil":
        tables["spring"] = {"travel_max": "20 mm"} | SPRINGS[spring]
    tables["limits"] = tables.get("limits", {}) | {
        "curvature_rate": "0.5 1/mm^2", "pivot_life": "2000 h", "return_pressure_angle": "40 deg",
    }  # fmt: skip
    return case_of(tables)
