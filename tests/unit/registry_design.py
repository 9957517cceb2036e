"""How the checks of shape, forces, contact, roller and guides are tried."""

import hand_calculations as by_hand
import made_trial as made
import numpy as np
from check_tools import by_limit, counted, limited, tried, unlimited
from trial_variants import (
    NAN,
    NO_ROLLING,
    TWO_ENDS,
    coasting,
    cooled,
    hollow,
    lossy,
    open_ended,
    pressed,
    soft,
    unknown,
    wheeled,
    with_bearing,
    with_contact,
    with_cycle,
    with_gap,
    with_guide,
    with_guides,
    with_limits,
    with_loads,
    with_map,
    with_material,
    with_part,
    with_parts,
    with_rolling,
    with_speed,
    without_endurance,
    without_heat,
    without_power,
)

# function
by_limit(
    "torque_reduction",
    "torque_reduction",
    lambda: with_cycle(torque_after=NAN),
    0.5,
    "one sine less half of it",
)
by_limit(
    "speed_reduction",
    "speed_reduction",
    lambda: made.solution(crank_speed={"idle": (2.0, np.nan)}),
    0.5,
    "std 2 to 1 rad/s",
    missing=unlimited("speed_reduction"),
)
for _name, _value, _how in (
    ("contact_torque", 1e-5, "pressures a hundred-thousandth too great"),
    ("contact_work", 1e-5 * by_hand.FRICTION_SHARE, "of the friction work alone"),
):
    by_limit(
        _name,
        "contact_torque",
        lambda: with_contact(pressure=np.full((made.POSITIONS, 2), np.nan), pressure_xi=TWO_ENDS),
        _value,
        _how,
        base=pressed,
    )
by_limit(
    "friction_balance",
    "friction_balance",
    lambda: with_loads(cam_torque=NAN),
    1e-7,
    "one part in ten million more torque than heat",
    base=lossy,
)
by_limit(
    "friction_power",
    "friction_power",
    lambda: with_loads(axial_force=NAN),
    0.5 * 100.0 * 0.5 * made.STROKE * 80.0 / 600.0,
    "100 N sin theta along h/2 sin theta at 80 rad/s, of the 600 W of the machine",
    missing=without_power,
)
tried(
    "drive_torque",
    limited("drive_torque", lambda torque: with_limits(drive_torque=torque)),
    None,  # without a limit in the case there is no check
    lambda: with_loads(cam_torque=NAN),
    float(np.max(np.abs(made.solution().cycles[0].loads.cam_torque))),
    "greatest of the table of the turn",
)
tried(
    "mechanism_temperature",
    limited(
        "mechanism_temperature",
        lambda around: with_part("guides", ambient_temperature=around + 273.15),
    ),
    lambda: cooled(conductance=None, heat=1e4),
    lambda: with_loads(axial_force=NAN),
    25.0 + 0.5 * (0.5 * 100.0 * 0.5 * made.STROKE * 80.0 + 5.0),
    "25 degC, 20 W of the guides and 5 W of other parts over 2 W/K",
)
# geometry
by_limit(
    "closure",
    "closure",
    unknown,
    5e-4,
    "as the lift's source says",
    base=open_ended,
)
by_limit(
    "acceleration_step",
    "acceleration_step",
    unknown,
    0.5,
    "from rest to s'' = a and back to -a: a step of a over a range of 2 a",
    base=coasting,
)
by_limit(
    "pressure_angle",
    "pressure_angle",
    unknown,
    float(np.degrees(np.arctan(np.max(by_hand.SLOPE / by_hand.RADIUS)))),
    "tan alpha = s'/(r + s), Rothbart ch. 6",
)
by_limit(
    "curvature_ratio",
    "curvature_ratio",
    unknown,
    float(by_hand.PITCH_RADIUS.min()) / 8e-3,
    "(r^2 + 2 r'^2 - r r'')/..., Rothbart 6.4.2",
)
by_limit(
    "undercut",
    "undercut_factor",
    unknown,
    1.0 - 8e-3 / float(by_hand.PITCH_RADIUS.min()),
    "1 - r kappa, Rothbart ch. 6",
)
tried(
    "self_intersection",
    counted(made.solution, lambda: made.solution(contour=made.undercut())),
    None,
    None,
    0.0,
    "a disc that nearly is one crosses itself nowhere; a count has no NaN",
)
by_limit(
    "second_contact",
    "second_contact_depth",
    lambda: with_gap(np.nan),
    2e-3,
    "2 um deep",
    base=lambda: with_gap(-2e-6, 1.0),
)
by_limit(
    "concave_radius",
    "tool_radius",
    unknown,
    8.0 + 30.0**2 / (45.0 - 30.0),
    "r + r^2/(r'' - r) in the dwellless valley",
    factor=1.0 / 1.1,
    base=hollow,
    missing=lambda: made.changed_solution(hollow(), case=made.limits(tool_radius=None)),
)
by_limit(
    "tool_gouge",
    "second_contact_depth",
    unknown,
    by_hand.gouge(),
    "of 720 wheels on 14400 points of the contour",
    base=wheeled,
    missing=lambda: made.changed_solution(
        hollow(), case=made.case(limits=made.limits(tool_radius=None).limits)
    ),
)
by_limit(
    "curvature_rate",
    "curvature_rate",
    unknown,
    1e-6 * by_hand.curvature_rate(),
    "differences of the turning of a polygon of the contour",
    missing=unlimited("curvature_rate"),
)
by_limit(
    "minimum_wall",
    "minimum_wall",
    unknown,
    42.0 / 10.8,
    "least contour radius over bore and keyway",
)
tried(
    "spring_travel",
    limited("spring_travel", lambda travel: with_part("spring", travel_max=travel)),
    lambda: with_part("spring", travel_max=None),
    unknown,
    10.0,
    "the stroke",
)
# forces
by_limit(
    "contact_force_margin",
    "contact_force_margin",
    lambda: with_loads(normal_force=NAN),
    200.0 / 242.0,
    "least of 300 + 100 sin",
)
by_limit(
    "jump",
    "jump",
    lambda: with_loads(inertia_force=NAN),
    float(-(by_hand.INERTIA / by_hand.SPRING).min()),
    "-m w^2 s''/F_s, Norton",
)
by_limit(
    "jam_index",
    "jam_index",
    lambda: with_loads(jam_index=NAN),
    0.3,
    "greatest of 0.2 + 0.1 sin on the rise",
)
# contact
tried(
    "contact_pressure",
    limited("contact_pressure", lambda p: with_material("steel", endurance_pressure=p)),
    lambda: without_endurance("steel"),
    lambda: with_contact(p0=NAN),
    900.0,
    "800 + 100 sin",
)
tried(
    "first_yield",
    limited("first_yield", lambda p: with_material("steel", yield_strength=p)),
    lambda: with_rolling(von_mises=None),
    lambda: with_rolling(von_mises=NAN),
    520.0,
    "420 + 100 sin",
)
tried(
    "shakedown",
    limited("shakedown", lambda p: with_material("steel", yield_strength=0.25 * 3**0.5 * p)),
    None,
    lambda: with_contact(p0=NAN),
    900.0,
    "800 + 100 sin; limit 4 Y/sqrt(3), Johnson sec. 9.2",
)
# roller
by_limit(
    "roller_static",
    "roller_static_safety",
    lambda: with_loads(normal_force=NAN),
    1.5,
    "C0/P0 = 600/400, ISO 76",
    missing=lambda: with_bearing(C0=None),
)
by_limit(
    "roller_life",
    "roller_life",
    lambda: with_loads(normal_force=NAN),
    by_hand.mean_life(),
    "ISO 281 over the turn",
    missing=unlimited("roller_life"),
)
by_limit(
    "roller_load_share",
    "roller_load_share",
    lambda: with_loads(normal_force=NAN),
    400.0 / 1140.0,
    "N/C",
    missing=lambda: with_bearing(C=None),
)
by_limit(
    "roller_modified_life",
    "roller_life",
    lambda: with_loads(normal_force=NAN),
    by_hand.modified_life(),
    "ISO 281, 9.3: damage of each position",
    missing=lambda: with_bearing(contamination=None),
)
tried(
    "roller_speed",
    limited("roller_speed", lambda n: with_bearing(speed_limit=n / 0.7)),
    lambda: with_bearing(speed_limit=None),
    lambda: with_speed(np.nan),
    by_hand.RPM * made.CAM_SPEED * (60.0 - 8.0) / 8.0,
    "w (R - r)/r at full lift",
)
# guides: nylon of 60 MPa at 20 degC and 40 MPa at 100 degC, at 56.85 degC
HOT = (56.85 - 20.0) / 80.0
COLD = 1.0 - HOT
WARM = COLD + HOT * 2.0 / 3.0
for _side, _load in (("a", 500.0), ("b", 200.0)):
    _name = f"guide_pressure_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda p, s=_side: with_guide(s, pressure_limit=p / WARM)),
        lambda s=_side: with_guide(s, pressure_limit=None),
        lambda s=_side: with_guides(**{f"line_pressure_{s}": np.full((25, made.POSITIONS), NAN)}),
        _load / 200.0,
        "R/(d l), 10 by 20 mm, on one side over the whole length",
    )
    _name = f"guide_pv_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda p, s=_side: with_guide(s, pv_limit=p)),
        lambda s=_side: with_guide(s, pv_limit=None),
        lambda s=_side: with_guides(**{f"rubbing_load_{s}": NAN}),
        _load * 0.4 / 2.0 / 200.0,
        "mean of R v sin^2, v = 0.4 m/s",
    )
    _name = f"guide_edge_pressure_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda p: with_material("nylon", yield_strength=(p - 40e6 * HOT) / COLD)),
        lambda: with_material("nylon", strength_at=()),
        lambda s=_side: with_parts(**{f"guide_edge_pressure_{s}": NAN}),
        40.0 if _side == "a" else 30.0,
        "greatest of the turn",
    )
    _name = f"guide_temperature_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda t: with_material("nylon", temperature_limit=t + 273.15)),
        lambda: with_material("nylon", temperature_limit=None),
        lambda s=_side: without_heat(s),
        56.85,
        "330 K",
    )
    _name = f"guide_speed_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda v, s=_side: with_guide(s, speed_limit=v)),
        lambda s=_side: with_guide(s, speed_limit=None),
        lambda: with_loads(velocity=NAN),
        0.4,
        "w times half the stroke: 80 rad/s by 5 mm",
    )
tried(
    "anti_rotation",
    counted(made.solution, lambda: with_part("follower", anti_rotation="not_needed")),
    lambda: with_part("follower", anti_rotation=None),
    None,
    0.0,
    "a count has no NaN",
)
# rolling, surface
tried(
    "traction_demand",
    limited("traction_demand", lambda mu: with_part("roller", friction=mu)),
    lambda: with_part("roller", friction=None),
    lambda: with_loads(normal_force=NAN),
    by_hand.traction(),
    "I d2(phi)/dt2 / (r N)",
)
by_limit(
    "traction_reserve",
    "traction_share",
    lambda: with_loads(normal_force=NAN),
    by_hand.traction(),
    "I d2(phi)/dt2 / (r N)",
    factor=1.0 / 0.1,
    missing=lambda: with_part("roller", friction=None),
)
by_limit(
    "film_ratio",
    "film_ratio",
    lambda: with_rolling(film=None),
    1.5,
    "2 + 0.5 sin",
    missing=lambda: with_cycle(rolling=NO_ROLLING),
)
for _name, _field, _value in (
    ("surface_fatigue", "crossland", 200.0),
    ("dang_van", "dang_van", 240.0),
):
    tried(
        _name,
        limited(_name, lambda p: with_material("steel", fatigue_torsion=p)),
        lambda: with_material("steel", fatigue_torsion=None),
        lambda f=_field: with_map(**{f: np.array([[np.nan]])}),
        _value,
        "greatest of the map",
    )
tried(
    "hardened_case",
    limited("hardened_case", lambda u: with_limits(case_safety=1.0 / u)),
    lambda: with_material("steel", case_depth=None),
    lambda: with_map(von_mises=np.full((1, 2), np.nan)),
    0.8,
    "400 MPa half way down from 600 to 400",
)
tried(
    "case_shear",
    limited("case_shear", lambda u: with_limits(fatigue_safety=1.0 / u)),
    lambda: with_material("steel", core_fatigue_torsion=None),
    lambda: with_map(shear_range=np.full((1, 2), np.nan)),
    100.0 / 275.0,
    "half of 200 MPa half way down from 300 to 250",
)
by_limit(
    "case_depth",
    "case_depth_ratio",
    lambda: with_contact(tau_depth=NAN),
    1.0 / (1.25 * 0.0786),
    "1 mm over 0.786 half-widths of 0.1 mm, Johnson sec. 4.2(c), times the factor along the line",
    missing=lambda: with_material("steel", case_depth=None),
)
tried(
    "pressure_by_hardness",
    limited(
        "pressure_by_hardness", lambda p: soft(hardness_brinell=(1e-6 * p + 70.0) / 2.76), soft
    ),
    lambda: soft(hardness_brinell=None),
    lambda: made.changed_solution(soft(), cycles=with_contact(p0=NAN).cycles),
    900.0,
    "2.76 HB - 70 MPa, Shigley ch. 6: 344 MPa at 150 HB",
    base=soft,
)
tried(
    "pressure_by_gear_limits",
    limited(
        "pressure_by_gear_limits",
        lambda p: soft(treatment="induction_hardened", hardness_vickers=(1e-6 * p - 882.0) / 0.541),
    ),
    lambda: soft(treatment=None),
    lambda: with_contact(p0=NAN),
    900.0,
    "0.541 HV + 882 MPa, ISO 6336-5",
)
tried(
    "endurance_rules",
    lambda share: with_material("steel", endurance_pressure=1e9 / share),
    lambda: soft(treatment=None, hardness_brinell=None),
    None,
    1.25,
    "1500 MPa of a carburised flank over 1200 MPa of the card",
)
tried(
    "roller_overlap",
    lambda share: with_part("roller", width=8e-3, axial_offset=1e-3 * share),
    lambda: with_part("roller", axial_offset=None),
    None,
    0.5,
    "half of 10 - 8 mm bears an offset of 1 mm",
    base=lambda: with_part("roller", width=8e-3, axial_offset=0.5e-3),
)
