"""Cases wrong in one way that a workshop or an engineer sees, and good ones: none is misjudged.

Both are a GX120 balancing cam that passes, with some values changed. Each row says why: of a wrong
one, which check or reader finds it; of a good one, why nothing may fail.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from camwright.geometry.errors import CamError
from camwright.pipeline.base.verdict import within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.preview import preview_case

CASES = Path(__file__).resolve().parents[2] / "cases"
REFUSED = "refused"
POSITIONS = 240

# Changes, what finds them (a check or the reader), and the reason.
WRONG: tuple[tuple[dict[str, Any], str, str], ...] = (
    ({"cam.prime_radius": "34 mm"}, REFUSED, "no base circle is left around the bore"),
    ({"cam.width": "4 mm"}, "edge_pressure", "a cam as narrow as a coin"),
    ({"cam.bore_radius": "28 mm"}, "cam_slip", "a bore of 56 mm on a shaft of 30 mm"),
    ({"cam.material": "ptfe_lined"}, "contact_pressure",
     "a cam of bush liner has no endurance limit"),
    ({"cam.key.length": "2 mm"}, "key_pressure", "a key of 2 mm"),
    ({"cam.fit.greatest_interference": "120 um"}, "fit_yield", "a hub shrunk on by 0.12 mm"),
    ({"spring.preload": "150 N"}, REFUSED, "the lift drives the stem out"),
    ({"spring.preload": "5000 N"}, "spring_stress", "wound for a fifth of that force"),
    ({"spring.travel_max": "5 mm"}, "spring_travel", "the lift is 10 mm"),
    ({"spring.design.wire_diameter": "5 mm"}, "spring_rate", "another wire has another rate"),
    ({"spring.design.free_length": "50 mm"}, "spring_solid", "shorter than its coils allow"),
    ({"spring.design.coils": 12.0}, REFUSED, "longer when solid than when free"),
    ({"spring.design.mean_diameter": "23 mm"}, REFUSED, "an index below 3"),
    ({"spring.design.relaxation": 0.5}, "spring_relaxation", "half of the preload is lost"),
    ({"follower.mass": "7 kg"}, "contact_over_speed", "a follower of 7 kg at 1980 rpm"),
    ({"follower.mass": "20 g"}, REFUSED, "lighter than its share of the spring"),
    ({"follower.stem_length": "110 mm"}, REFUSED, "the stem leaves guide B"),
    ({"follower.overhang_at_max_lift": "12 mm"}, REFUSED, "the roller is in the guide"),
    ({"guides.spacing": "15 mm"}, REFUSED, "bushes of 25 mm 15 mm apart"),
    ({"guides.a.length": "4 mm"}, "guide_pv_A", "a bush of 4 mm"),
    ({"guides.a.clearance": "0.8 mm"}, "edge_pressure", "the stem rattles and tilts the roller"),
    ({"guides.a.friction": 0.8}, REFUSED, "thrice the greatest friction of the liner"),
    ({"guides.ambient_temperature": "250 degC"}, "guide_temperature_A", "above the liner's limit"),
    ({"guides.a.housing_resistance": "60 K/W"}, "guide_temperature_A", "a bush in foam"),
    ({"guides.a.wear_rate": "3e-5 mm^3/N/m"}, "guide_wear_A", "a liner that wears like chalk"),
    ({"roller.bearing.viscosity": "0.9 mm^2/s"}, "bearing_lubrication",
     "water in the bearing, oil at the cam"),
    ({"roller.bearing.contamination": "severe_contamination", "limits.roller_life": "5000 h"},
     "roller_life", "sand in a small bearing for 5000 h"),
    ({"roller.axial_offset": "5 mm"}, "roller_overlap", "the cam runs beside the roller"),
    ({"roller.radius": "45 mm"}, REFUSED, "no base circle is left around the bore"),
    ({"roller.pin.diameter": "4 mm"}, "roller_pin", "a nail for a pin"),
    ({"roller.pin.span": "90 mm"}, "bearing_gap", "bearings 70 mm apart"),
    ({"roller.fork.cheek_width": "0.3 mm"}, "cheek_pressure", "cheeks of sheet"),
    ({"roller.fork.cheek_length": "12 mm"}, "fork_gap", "the roller turns in the bridge"),
    ({"camshaft.bearing_spacing": "24 mm", "camshaft.cam_position": "12 mm"}, "bearing_gap",
     "two bearings of 15 mm around a cam of 15.5 mm"),
    ({"camshaft.cam_position": "64 mm"}, "bearing_gap", "the cam is in bearing 2"),
    ({"camshaft.bearing_rating": "0.7 kN"}, "shaft_bearing_life", "bearings of a toy"),
    ({"camshaft.bearing_rating": "900 kN"}, REFUSED, "no bearing of that size carries it"),
    ({"camshaft.gear.teeth": 60}, "tooth_ratio", "60:20 teeth at a ratio of 2"),
    ({"camshaft.gear.teeth": 12, "camshaft.gear.pinion_teeth": 6}, REFUSED,
     "a pinion of 6 teeth is undercut"),
    ({"camshaft.gear.width": "1 mm"}, "gear_bending", "a gear of sheet"),
    ({"camshaft.gear.machine_shaft_diameter": "70 mm"}, REFUSED,
     "a shaft of 70 mm in a pinion of 40 mm"),
    ({"camshaft.counterweight.residual": "3000 g mm"}, "cam_unbalance", "hardly balanced at all"),
    ({"camshaft.sections[0].diameter": "7 mm"}, "shaft_fatigue", "a journal like a pencil"),
    ({"cooling.conductance": "0.02 W/K"}, "mechanism_temperature", "in a thermos flask"),
    ({"cooling.ambient_temperature": "170 degC"}, "mechanism_temperature", "in an oven"),
    ({"guides.ambient_temperature": "35 degC"}, "mechanism_temperature",
     "bushes in a cooler place than the mechanism that holds them"),
    ({"limits.overspeed": "12000 rpm"}, "contact_over_speed", "thrice the governed speed"),
    ({"limits.cam_radius": "30 mm"}, "cam_radius", "a room smaller than the cam"),
    ({"limits.shaft_bearing_life": "1e6 h"}, "shaft_bearing_life", "a hundred years of a 6205"),
    ({"camshaft.cam_position": "6 mm"}, "bearing_gap", "the cam is in bearing 1"),
    ({"guides.b.wear_rate": "3e-5 mm^3/N/m"}, "guide_wear_B", "a liner that wears like chalk"),
    ({"guides.b.housing_resistance": "60 K/W"}, "guide_temperature_B", "a bush in foam"),
    ({"camshaft.sections[1].diameter": "7 mm"}, "shaft_slope", "a journal like a pencil"),
    ({"limits.target_life": "1e6 h"}, "guide_wear_A", "a hundred years"),
)  # fmt: skip

# Changes and why nothing may fail.
GOOD: tuple[tuple[dict[str, Any], str], ...] = (
    ({}, "the case itself"),
    ({"cam.roughness": "0.2 um"}, "ground finer"),
    ({"cam.profile_tolerance": "5 um"}, "ground closer"),
    ({"cam.keyway.angle": "170 deg"}, "the key elsewhere under the base circle"),
    ({"cam.key.length": "15.4 mm"}, "the key as long as the cam"),
    ({"cam.fit.least_interference": "13 um"}, "a narrower band of the fit"),
    ({"cam.fit.greatest_interference": "21 um"}, "a narrower band of the fit"),
    ({"cam.fit.friction": 0.14}, "seats wiped dry"),
    ({"cam.roughness": "0.25 um"}, "ground a little finer"),
    ({"spring.design.relaxation": 0.003}, "hot set"),
    ({"spring.travel_max": "12 mm"}, "more travel permitted"),
    ({"follower.mass": "600 g"}, "a lighter follower"),
    ({"guides.ambient_temperature": "45 degC", "cooling.ambient_temperature": "20 degC"},
     "a cooler place, and the mechanism with it"),
    ({"guides.a.housing_resistance": "0.5 K/W"}, "a bush better cooled"),
    ({"guides.b.housing_resistance": "0.5 K/W"}, "a bush better cooled"),
    ({"guides.a.wear_rate": "2e-8 mm^3/N/m"}, "a liner that wears less"),
    ({"guides.b.wear_rate": "1e-8 mm^3/N/m"}, "a liner that wears less"),
    ({"guides.a.clearance": "0.025 mm", "guides.b.clearance": "0.025 mm"}, "a closer fit"),
    ({"guides.a.wall": "1.5 mm"}, "a thicker bush"),
    ({"roller.roughness": "0.05 um"}, "a ring honed"),
    ({"roller.friction": 0.08}, "better oiled"),
    ({"roller.axial_offset": "0.1 mm"}, "assembled closer"),
    ({"roller.end.size": "0.5 mm"}, "a smaller chamfer"),
    ({"roller.bearing.contamination": "high_cleanliness"}, "cleaner oil"),
    ({"roller.bearing.static_radial_limit": "9 kN"}, "a stronger roller"),
    ({"roller.fork.cheek_height": "24 mm"}, "stronger cheeks"),
    ({"smoothing.width": "135 deg"}, "smoothed more"),
    ({"roller.hub_radius": "11 mm"}, "a lower shoulder"),
    ({"camshaft.bearing_rating": "15.9 kN"}, "a better 6205"),
    ({"camshaft.bearing_static_rating": "8.3 kN"}, "a better 6205"),
    ({"camshaft.drag": "0.05 N m"}, "seals that drag less"),
    ({"camshaft.sections[0].notch_bending": 2.2}, "a rounder fillet"),
    ({"camshaft.sections[1].notch_bending": 2.2}, "a rounder fillet"),
    ({"camshaft.sections[2].notch_torsion": 2.5}, "a rounder keyway"),
    ({"camshaft.counterweight.residual": "10 g mm"}, "balanced better"),
    ({"camshaft.gear.width": "22 mm"}, "a wider gear"),
    ({"camshaft.gear.contact_limit": "1550 MPa"}, "a harder gear"),
    ({"camshaft.gear.bending_limit": "460 MPa"}, "a stronger gear"),
    ({"camshaft.gear.machine_shaft_diameter": "10 mm"}, "a thin stub beyond the pinion"),
    ({"lubricant.pressure_viscosity": "20 1/GPa"}, "another mineral oil"),
    ({"cooling.conductance": "3 W/K"}, "more fins"),
    ({"cooling.ambient_temperature": "20 degC"}, "a cooler shed"),
    ({"limits.overspeed": "3800 rpm"}, "a lower over-speed"),
    ({"limits.target_life": "900 h"}, "a shorter life"),
    ({"limits.roller_life": "450 h"}, "a shorter life"),
    ({"limits.shaft_bearing_life": "900 h"}, "a shorter life"),
    ({"limits.cam_radius": "95 mm"}, "more room"),
    ({"limits.tool_radius": "20 mm"}, "a smaller wheel"),
    ({"limits.torque_reduction": 0.4}, "a lower requirement"),
    ({"load_case[1].speed": "3500 rpm"}, "governed lower"),
    ({"smoothing.width": "133 deg"}, "smoothed a little more"),
)  # fmt: skip


@lru_cache(maxsize=1)
def passing() -> Case:
    """The GX120 with the smoother that its checks lead to."""
    case = read_case(CASES / "gx120-feedback.toml").with_positions(POSITIONS)
    return with_values(case, {"smoothing.width": "131.5 deg"})


def judged(changes: dict[str, Any]) -> dict[str, str]:
    """Status of the must-have checks by id; `REFUSED` alone where the case is not read or drawn."""
    try:
        trial = preview_case(with_values(passing(), changes))
    except CamError as error:
        return {REFUSED: str(error)}
    return {one.id: one.status for one in within_depth(trial.checks) if one.must_have}


def named(row: tuple[Any, ...]) -> str:
    return "; ".join(f"{key} = {value}" for key, value in row[0].items()) or "unchanged"


@pytest.mark.slow
@pytest.mark.parametrize("row", WRONG, ids=named)
def test_what_is_wrong_does_not_pass(row: tuple[dict[str, Any], str, str]) -> None:
    changes, finder, _ = row
    statuses = judged(changes)
    assert finder in statuses
    assert finder == REFUSED or statuses[finder] in ("fail", "not_evaluated")


@pytest.mark.slow
@pytest.mark.parametrize("row", GOOD, ids=named)
def test_what_is_good_does_not_fail(row: tuple[dict[str, Any], str]) -> None:
    statuses = judged(row[0])
    assert {name for name, status in statuses.items() if status != "pass"} == set()


def test_fifty_of_each() -> None:
    assert len(WRONG) >= 50 and len(GOOD) >= 50
    assert len({named(row) for row in WRONG}) == len(WRONG)
    assert len({named(row) for row in GOOD}) == len(GOOD)
