"""The case of the GX120 with every option that a case may state, at little cost."""

import tomllib
from pathlib import Path

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of

GX120 = Path(__file__).resolve().parents[1] / "cases" / "gx120.toml"
OPTIONS = {
    "cam": {
        "roughness": "0.3 um",
        "profile_tolerance": "0.02 mm",
        "counter_hole": {},
        "key": {"length": "10 mm", "material": "c45"},
    },
    "spring": {"travel_max": "25 mm", "catalogue": "shipped"},
    "camshaft": {
        "bearing_spacing": "60 mm",
        "cam_position": "30 mm",
        "gear_position": "75 mm",
        "gear_radius": "30 mm",
        "drag": "0.05 N m",
        "diameter": "17 mm",
        "material": "c45",
        "bearing_rating": "10.1 kN",
        "bearing_static_rating": "4.75 kN",
        "rotor_mass": "1 kg",
        "slip_torque": "0 N m",
        "counterweight": {"residual": "50 g mm", "position": "10 mm"},
        "sections": [
            {
                "name": "groove",
                "position": "10 mm",
                "diameter": "16 mm",
                "notch_bending": 2.0,
                "notch_torsion": 1.5,
            }
        ],
    },
    "roller": {
        "roughness": "0.1 um",
        "friction": 0.1,
        "crown": {"kind": "circular", "radius": "200 mm"},
        "axial_offset": "0 mm",
        "inertia": "0.3 kg mm^2",
        "pin": {"diameter": "5 mm", "span": "9 mm", "material": "bearing_steel"},
    },
    "follower": {"stiffness": "20000 N/mm", "viscous_damping": "2 N s/m"},
    "lubricant": {
        "viscosity": "15 mPa s",
        "pressure_viscosity": "20 1/GPa",
        "film": "mixed",
    },
    "limits": {"overspeed": "2400 rpm"},  # at the 3960 rpm of the case the follower leaves the cam
    "smoothing": {"kind": "moving_average"},
    "tolerances": {"samples": 0},
    "solver": {"positions": 36, "certificate_positions": 1, "max_trials": 1, "end_elements": 0},
}


def full_case() -> Case:
    tables = tomllib.loads(GX120.read_text(encoding="utf-8"))
    del tables["scope"]  # the options describe what the papers leave out
    for section, values in OPTIONS.items():
        tables[section] = tables.get(section, {}) | values
    for card in tables["materials"].values():
        card.setdefault("hardness_vickers", 600)
    return case_of(tables)
