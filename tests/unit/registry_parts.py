"""How the checks of overspeed, life, shaft, manufacture and parts are tried."""

import hand_calculations as by_hand
import made_trial as made
import numpy as np
from check_tools import by_limit, counted, limit_of, limited, loaded, tried, unlimited
from trial_variants import (
    NAN,
    at_worst_on_pivot,
    beside,
    cycle_with,
    frictionless,
    geared,
    on_arm,
    on_nylon,
    on_pivot,
    reversing,
    rolled,
    stiffened,
    struck,
    unknown,
    unknown_beside,
    weighted,
    with_bearing,
    with_contact,
    with_cycle,
    with_elastic_force,
    with_fit,
    with_fork,
    with_gas_spring,
    with_gear,
    with_guide,
    with_guides,
    with_key,
    with_keyway,
    with_limits,
    with_loads,
    with_material,
    with_part,
    with_ring,
    with_second_arm,
    with_shaft,
    with_speed,
    with_worst_friction,
    without_endurance,
    without_heat,
    without_seat,
)

from camwright.pipeline.follower.camshaft_loads import Counterweight

# Four times the greatest shear along the surface over p0 at a traction coefficient of 0.03, of the
# field of McEwen.
SHAKEDOWN_USE = 4.0 * 0.259034


def with_yield(safety, arm=None):
    """An arm at a safety against yield."""
    arm = arm or on_arm()
    limits = made.changed(arm.case.limits, arm_yield_safety=safety)
    return made.changed_solution(arm, case=made.changed(arm.case, limits=limits))


# overspeed, life and space
by_limit(
    "jump_speed",
    "jump_speed",
    lambda: with_loads(inertia_force=NAN),
    by_hand.RPM
    * 2.0
    * float(
        np.sqrt(
            np.min(
                (by_hand.SPRING / np.where(by_hand.BEND < 0, -made.MASS * by_hand.BEND, np.inf))[
                    by_hand.BEND < 0
                ]
            )
        )
    ),
    "w sqrt(F_s/(-m w^2 s'')), Norton",
    factor=1.0 / (2.0 * made.CAM_SPEED),
    missing=unlimited("overspeed"),
)
by_limit(
    "contact_at_overspeed",
    "contact_force_margin",
    lambda: with_loads(spring_force=NAN),
    float((by_hand.SPRING + by_hand.INERTIA).min()) / made.PRELOAD,
    "F_s + m w^2 s''",
    missing=unlimited("overspeed"),
)
by_limit(
    "contact_over_speed",
    "contact_force_margin",
    unknown,
    by_hand.fast_contact(520.0),
    "P + k a + a |m w^2 - k phi cot(phi)| cos(theta), without friction",
    base=lambda: frictionless(1040.0),
    missing=lambda: with_part("spring", design=None),
)
tried(
    "contact_pressure_at_life",
    limited(
        "contact_pressure_at_life",
        lambda p: with_limits(
            contact_safety=float(
                np.sqrt(
                    6894.757
                    * 10.0 ** ((66.22 - np.log10(by_hand.TURNS)) / 14.15)
                    * by_hand.MODULUS
                    / np.pi
                )
            )
            / p
        ),
    ),
    unlimited("target_life"),
    lambda: with_contact(p0=NAN),
    1.25 * 900.0,
    "800 + 100 sin times the factor along the line; limit by Rothbart eq. 9.15",
)
tried(
    "edge_pressure",
    limited("edge_pressure", lambda p: with_material("steel", endurance_pressure=p)),
    lambda: without_endurance("steel"),
    lambda: with_contact(p0=NAN),
    1.25 * 900.0,
    "800 + 100 sin times the factor along the line, by its own tests",
)
tried(
    "shakedown_traction",
    limited(
        "shakedown_traction",
        lambda p: with_material("steel", yield_strength=0.25 * 3**0.5 * p),
    ),
    lambda: with_part("roller", friction=None),
    lambda: with_contact(p0=NAN),
    900.0 * SHAKEDOWN_USE,
    "800 + 100 sin at a traction of 0.02 + 0.01 sin",
)
tried(
    "edge_shakedown",
    limited("edge_shakedown", lambda p: with_material("steel", yield_strength=0.25 * 3**0.5 * p)),
    lambda: with_part("roller", friction=None),
    lambda: with_contact(p0=NAN),
    1.25 * 900.0 * SHAKEDOWN_USE,
    "the pressure of shakedown_traction times the factor along the line",
)
by_limit(
    "guide_gap",
    "guide_gap",
    unknown,
    3.0,
    "30 mm less half of 20, and less the 12 and 5 of the fork",
)
by_limit(
    "bearing_gap",
    "assembly_gap",
    None,
    4.0,
    "cam at 20 mm less half of 20 of pin and cheek, less half of 12 of the bearing",
    base=lambda: with_shaft(bearing_width=0.012),
    missing=lambda: with_shaft(diameter=None),
)
by_limit(
    "counterweight_gap",
    "assembly_gap",
    None,
    6.5,
    "40 mm and half of 10 up to bearing 2 at 60 mm, half of 17 wide",
    base=weighted,
    missing=lambda: with_shaft(
        diameter=None,
        counterweight=Counterweight(unbalance=2e-4, angle=0.0, position=0.04),
    ),
)
tried(
    "counterweight_unbalance",
    limited(
        "counterweight_unbalance",
        lambda most: weighted(width=most / (7850.0 * (0.025**3 - 0.0085**3) / 1.5)),
        weighted,
    ),
    None,  # without a stated width there is no check
    None,  # of the case alone
    200.0,
    "as stated",
    weighted,
)
by_limit(
    "arm_gap",
    "assembly_gap",
    lambda: rolled(depth=np.nan),
    18.65,
    "50 mm less half of 10 of the cheeks, and of 3.1 times 17 of a bearing in their plane",
    base=rolled,
    missing=lambda: rolled(depth=None),
)
by_limit(
    "arm_cam_gap",
    "assembly_gap",
    lambda: rolled(depth=np.nan),
    3.0,
    "50 mm less 42 of the disc and half of 10 of the cheeks",
    base=rolled,
    missing=lambda: rolled(depth=None),
)
by_limit("gear_gap", "assembly_gap", None, 20.0, "20 + 15 mm less half of 10 and of 20")
by_limit(
    "machine_shaft_gap",
    "assembly_gap",
    unknown_beside,
    13.0,
    "75 mm of centre distance less 50 + 10 - 8 mm of the cam and 10 of the shaft",
    base=lambda: beside(0.02),
    missing=lambda: beside(None),
)
tried(
    "tooth_ratio",
    loaded("tooth_ratio", geared),
    None,
    None,  # whole numbers of the case
    0.25,
    "40 : 20 teeth at a ratio of 1.6",
    base=lambda: geared(0.25),
)
tried(
    "tooth_count",
    limited(
        "tooth_count",
        lambda z: with_shaft(
            pressure_angle=float(np.arcsin(np.sqrt(14.0 / z) * np.sin(np.pi / 9.0)))
        ),
    ),
    None,
    None,  # whole numbers of the case
    20.0,
    "teeth of the pinion",
)
by_limit(
    "fork_shaft_gap",
    "assembly_gap",
    None,
    36.5,
    "50 mm less half of 10 and of 17",
    missing=lambda: with_fork(cheek_height=None),
)
by_limit(
    "fork_gap",
    "assembly_gap",
    None,
    1.0,
    "half of 16 - 4 of the fork and of 10 of the roller",
    missing=lambda: with_fork(cheek_length=None),
)
by_limit(
    "spring_gap",
    "assembly_gap",
    unknown,
    6.0,
    "end of the stem at 140 mm less 10 of lift, 4 of the seat and 30 + 80 + 10 up to guide B's end",
    base=lambda: with_part("spring", seat_thickness=0.004),
    missing=lambda: with_part("follower", stem_length=None),
)
by_limit(
    "gas_gap",
    "assembly_gap",
    None,
    10.0,
    "140 mm less 10 of lift and 120 up to guide B's end; 40 of 50 mm of gas left",
    base=with_gas_spring,
)
by_limit(
    "cam_radius",
    "cam_radius",
    unknown,
    52.0,
    "base 50 and stroke 10 less the roller's 8 mm",
    missing=unlimited("cam_radius"),
)
tried(
    "roller_radial",
    limited("roller_radial", lambda f: with_bearing(radial_limit=f)),
    lambda: with_bearing(radial_limit=None),
    lambda: with_loads(normal_force=NAN),
    400.0,
    "300 + 100 sin",
)
by_limit(
    "roller_misalignment",
    "roller_misalignment",
    lambda: with_loads(axial_force=NAN),
    0.1 + 5.0 / 84.0 + 0.5 * 200.0 / 100.0,
    "parallelism, run-out of 5 um over 84 mm, clearances of 0.1 mm over 100 mm; a rigid shaft",
    base=lambda: with_shaft(diameter=None),
)
tried(
    "roller_static_radial",
    limited("roller_static_radial", lambda f: with_bearing(static_radial_limit=f)),
    lambda: with_bearing(static_radial_limit=None),
    lambda: with_loads(normal_force=NAN),
    400.0,
    "300 + 100 sin",
)
tried(
    "grease_life",
    limited("grease_life", limit_of("target_life")),
    lambda: with_bearing(lubrication=None),
    None,  # the manufacturer's, a constant
    2000.0,
    "as stated; the estimate in test_roller_audit",
)
by_limit("guide_length", "guide_length", unknown, 2.5, "80 + 20 mm over 30 + 10, Rothbart ch. 6")
# shaft
for _name, _area, _strength, _how in (
    ("key_pressure", 9e-3 * (5e-3 - 3e-3 - 0.4e-3), 400e6, "2 K T/(d l (h - t1 - s)), DIN 6892"),
    ("key_pressure_shaft", 9e-3 * (3e-3 - 0.4e-3), 400e6, "2 K T/(d l (t1 - s)), DIN 6892"),
    ("key_shear", 9e-3 * 5e-3, 400e6 / np.sqrt(3.0), "2 K T/(d b l), DIN 6892"),
):
    by_limit(
        _name,
        "key_share",
        lambda: with_loads(cam_torque=NAN),
        1e-6 * by_hand.KEY_PUSH / _area,
        _how,
        factor=1.0 / (0.25 * _strength),
        missing=lambda: with_key(length=None),
    )
tried(
    "key_corner",
    limited("key_corner", lambda p: with_key(chamfer=p)),
    lambda: with_keyway(width=5.3e-3),  # of no standard, without radius and chamfer
    None,  # of the case alone
    0.16,
    "least fillet of a standard keyway of 5 mm",
)
by_limit(
    "keyway_root",
    "keyway_safety",
    lambda: with_loads(cam_torque=NAN),
    by_hand.root_safety(),
    "Goodman at the root, elements in test_camshaft_audit",
    missing=lambda: with_material("steel", fatigue_bending=None),
)
by_limit(
    "cam_slip",
    "cam_slip",
    lambda: with_loads(cam_torque=NAN),
    100.0 / (1.5 * float(by_hand.TORQUE.max())),
    "slip torque over 1.5 T",
    missing=without_seat,
)
tried(
    "fit_yield",
    limited("fit_yield", lambda p: with_fit(core_yield_strength=p), with_fit),
    lambda: with_fit(shaft_material=None),
    None,  # of the case alone
    1e-6 * by_hand.wall_stress(30e-6),
    "Lame's ring of 20 mm on 8.5 mm",
    with_fit,
)
by_limit(
    "bore_pressure",
    "bore_share",
    lambda: with_loads(normal_force=NAN),
    400.0 / (17.0 * 10.0),
    "N/(d w)",
    factor=1.0 / 900e6,
    missing=lambda: with_material("steel", tensile_strength=None),
)
by_limit(
    "shaft_fatigue",
    "shaft_safety",
    lambda: with_loads(cam_torque=NAN),
    by_hand.shaft_safety(),
    "Shigley sec. 7-4",
    missing=lambda: with_material("steel", tensile_strength=None),
)
tried(
    "shaft_yield",
    limited("shaft_yield", lambda p: with_limits(shaft_yield_safety=400e6 / p)),
    lambda: with_shaft(material=None),
    lambda: with_loads(cam_torque=NAN),
    1e-6 * by_hand.shaft_stress(),
    "Mohr's circle at the notch",
)
by_limit(
    "shaft_deflection",
    "shaft_deflection",
    lambda: with_loads(axial_force=NAN),
    by_hand.shaft_sag(),
    "M/(E I) integrated twice",
    missing=lambda: with_shaft(diameter=None),
)
by_limit(
    "shaft_slope",
    "shaft_slope",
    lambda: with_loads(axial_force=NAN),
    by_hand.shaft_slope(),
    "M/(E I) integrated once",
    missing=lambda: with_shaft(diameter=None),
)
by_limit(
    "shaft_bearing_static",
    "shaft_bearing_static_safety",
    lambda: with_loads(axial_force=NAN),
    4750.0 / max(float(load.max()) for load in by_hand.bearing_loads()),
    "C0/P0",
    missing=lambda: with_shaft(bearing_static_rating=None),
)
by_limit(
    "shaft_bearing_life",
    "shaft_bearing_life",
    lambda: with_loads(axial_force=NAN),
    by_hand.bearing_hours(),
    "ISO 281",
    missing=unlimited("shaft_bearing_life"),
)
tried(
    "gear_bending",
    limited("gear_bending", lambda p: with_gear(bending_limit=1.45 / 0.7 * p)),
    lambda: with_gear(bending_limit=None),
    lambda: with_loads(cam_torque=NAN),
    1e-6 * by_hand.TOOTH / (0.01 * 1e-3 * np.pi * (0.154 - 0.912 / 40)),
    "Lewis: F/(b m pi y), module 1 mm",
)
tried(
    "pinion_bending",
    limited("pinion_bending", lambda p: with_gear(pinion_bending_limit=1.45 / 0.7 * p)),
    lambda: with_gear(pinion_bending_limit=None),
    lambda: with_loads(cam_torque=NAN),
    1e-6 * by_hand.TOOTH / (0.01 * 1e-3 * np.pi * (0.154 - 0.912 / 20)),
    "Lewis: F/(b m pi y), module 1 mm",
)
tried(
    "gear_impact",
    limited(
        "gear_impact",
        lambda p: struck(bending_limit=1.45 / 0.7 * p, pinion_bending_limit=1.45 / 0.7 * p),
        struck,
    ),
    lambda: struck(bending_limit=None),
    lambda: struck(np.nan),
    1e-6 * by_hand.struck() / (0.01 * 1e-3 * np.pi * (0.154 - 0.912 / 20)),
    "Lewis, of the energy of the flight and of the teeth",
    struck,
)
tried(
    "gear_contact",
    limited(
        "gear_contact", lambda p: with_gear(contact_limit=1.2 * p, pinion_contact_limit=2.4 * p)
    ),
    lambda: with_gear(contact_limit=None),
    lambda: with_loads(cam_torque=NAN),
    1e-6
    * float(
        np.sqrt(
            by_hand.TOOTH
            / np.cos(np.radians(20))
            / 0.01
            * by_hand.MODULUS
            / np.pi
            * (1 / 0.01 + 1 / 0.02)
            / np.sin(np.radians(20))
        )
    ),
    "Hertz at the pitch point: radii d sin(20 deg)/2 of 20 and 40 mm wheels",
)
# manufacture
by_limit(
    "profile_waviness",
    "waviness",
    lambda: with_loads(normal_force=NAN),
    0.040568761048279486,
    "m delta (2 pi v/lambda)^2 by hand on a ring, test_checks_by_hand",
)
tried(
    "chord_error",
    limited("chord_error", lambda sag: with_part("cam", profile_tolerance=4.0 * sag)),
    None,
    unknown,
    0.5293739447429432,
    "step^2/(8 rho) by hand on a ring, test_checks_by_hand",
)
by_limit(
    "phase_tolerance",
    "torque_reduction",
    lambda: with_cycle(torque_before=NAN),
    1.0 - float(np.sqrt(1.25 - np.cos(0.02))),
    "sin against half of it, 0.02 rad off",
)
# parts
tried(
    "jam_index_friction_max",
    limited("jam_index_friction_max", limit_of("jam_index")),
    None,
    lambda: with_worst_friction(jam_index=NAN),
    0.4,
    "0.3 + 0.1 sin",
)
tried(
    "rigid_follower",
    loaded("rigid_follower", stiffened),
    None,
    lambda: with_part("follower", stiffness=float("nan")),
    np.sqrt(124_200.0 / 0.1181013358435438) / 80.0,
    "100 kN/m of the stem and 24.2 kN/m, 118.1 g without the share of the coils, at 80 rad/s",
    base=lambda: with_part("follower", stiffness=100e3),
)
tried(
    "elastic_contact",
    limited("elastic_contact", limit_of("contact_force_margin")),
    None,
    lambda: with_elastic_force(NAN),
    200.0 / 242.0,
    "300 + 100 sin",
)
by_limit(
    "roller_pin",
    "pin_share",
    lambda: with_loads(normal_force=NAN),
    by_hand.pin_bending(400.0, 1000.0),
    "32 M/(pi d^3), 400 N and 1 N m by summation along the pin",
    factor=1.0 / 1500e6,
    missing=lambda: with_part("roller", pin=None),
)
by_limit(
    "roller_pin_fatigue",
    "pin_fatigue_safety",
    lambda: with_loads(axial_force=NAN),
    by_hand.pin_fatigue(),
    "Goodman, each fibre of the pin, Shigley ch. 6",
    missing=lambda: with_material("hard", fatigue_bending=None),
)
by_limit(
    "arm_fatigue_pivot",
    "arm_safety",
    lambda: on_arm(cycle_with("loads", axial_force=NAN)),
    by_hand.arm_safety("bore", "hub"),
    "Goodman, free body of the arm up to its end, Shigley ch. 6",
    base=on_arm,
    missing=lambda: on_arm(pivot_notch=None),
)
by_limit(
    "arm_fatigue_roller",
    "arm_safety",
    lambda: on_arm(cycle_with("loads", axial_force=NAN)),
    by_hand.arm_safety("cheeks", "eye"),
    "Goodman, the more loaded cheek of the fork and the eye of the pin, Shigley ch. 6",
    base=on_arm,
    missing=lambda: on_arm(material=None),
)
tried(
    "arm_yield",
    limited("arm_yield", lambda p: with_yield(1500e6 / p), on_arm),
    lambda: on_arm(roller_notch=None),
    lambda: on_arm(cycle_with("loads", axial_force=NAN)),
    by_hand.arm_stress(),
    "Mohr's circle at the notch",
    on_arm,
)
by_limit(
    "rocker_fatigue",
    "arm_safety",
    lambda: with_second_arm(depth=NAN),
    by_hand.second_arm_safety(),
    "Goodman, free body of the second arm up to its end, Shigley ch. 6",
    base=with_second_arm,
    missing=lambda: with_second_arm(notch=None),
)
tried(
    "rocker_yield",
    limited(
        "rocker_yield",
        lambda p: with_yield(1500e6 / p, with_second_arm()),
        with_second_arm,
    ),
    lambda: with_second_arm(width=None),
    lambda: with_second_arm(depth=NAN),
    float(np.abs(by_hand.second_arm_stresses()).max()),
    "M/W of a free body of the second arm, times the notch factor",
    with_second_arm,
)
by_limit(
    "roller_pin_shear",
    "pin_share",
    lambda: with_loads(normal_force=NAN),
    4.0 / 3.0 * (200.0 + 1000.0 / 16.0) / (np.pi * 2.5**2),
    "half of 400 N and 1 N m over the span in a round section, 4/3 of the mean, Shigley sec. 3-11",
    factor=3.0**0.5 / 1500e6,
    missing=lambda: with_part("roller", pin=None),
)
by_limit(
    "roller_pin_pressure",
    "pin_pressure_share",
    lambda: with_loads(normal_force=NAN),
    400.0 / (5.0 * 10.0) + 6.0 * 1000.0 / (5.0 * 10.0**2),
    "N/(d b) + 6 C/(d b^2)",
    factor=1.0 / 2000e6,
    missing=lambda: with_material("hard", tensile_strength=None),
)
by_limit(
    "cheek_pressure",
    "pin_pressure_share",
    lambda: with_loads(normal_force=NAN),
    (200.0 + 1000.0 / 16.0) / (5.0 * 4.0),
    "half of 400 N and 1 N m over the span on a cheek of 4 mm",
    factor=1.0 / 900e6,
    missing=lambda: with_part("roller", fork=None),
)
by_limit(
    "follower_mass",
    "follower_mass_ratio",
    None,  # lengths and densities of the case, which refuses a NaN
    by_hand.moving_mass(),
    "volumes times densities",
    factor=1.0 / 0.175,
    missing=lambda: with_part("follower", stem_length=None),
)
tried(
    "roller_ring_fatigue",
    limited("roller_ring_fatigue", lambda p: with_ring(fatigue_bending=p)),
    lambda: with_ring(fatigue_bending=None),
    lambda: with_loads(normal_force=NAN),
    by_hand.ring_amplitude(400.0),
    "Goodman, the solved stress per newton, Shigley ch. 6",
)
tried(
    "torque_reversals",
    counted(lambda: reversing(0), lambda: reversing(1)),
    None,
    None,
    0.0,
    "a count has no NaN",
)
by_limit(
    "cam_unbalance",
    "unbalance",
    lambda: with_speed(np.nan),
    1e3 * float(np.hypot(*by_hand.thrown()).max()) / 80.0 / 0.9,
    "m_cam e w over the 900 g of the rotor; the force is m e w^2",
)
for _side, _load in (("a", 500.0), ("b", 200.0)):
    _name = f"guide_wear_{_side.upper()}"
    by_limit(
        _name,
        "wear_depth",
        lambda s=_side: with_guides(**{f"rubbing_load_{s}": NAN}),
        1e3 * 1e-17 * 1e6 * _load * 0.4 / 2.0 / 200.0 * 3.6e6,
        "Archard: 1e-17 m2/N times PV times 1000 h",
        missing=lambda s=_side: with_guide(s, wear_rate=None),
    )
    _name = f"guide_expansion_{_side.upper()}"
    tried(
        _name,
        limited(_name, lambda gap, s=_side: with_guide(s, clearance=gap)),
        lambda s=_side: with_guide(s, wall=None),
        lambda s=_side: without_heat(s),
        10.0 * (1.25 * 1.4 / 1.45 * (8e-5 * 36.85 + 0.002) + 1.2e-5 * 36.85),
        "Lame, held axially: (k - 1)(1 + nu)/(1 + (1 - 2 nu) k) of k = 1.5^2; and the stem",
    )
by_limit(
    "bearing_lubrication",
    "viscosity_ratio",
    lambda: with_speed(np.nan),
    by_hand.viscosity_ratio(),
    "kappa of ISO 281",
    missing=lambda: with_bearing(viscosity=None),
)


def needles(**values):
    """The solution on an arm in needles."""
    return on_pivot("needle_bearing", **values)


WARM = (56.85 - 20.0) / 80.0  # of the way from the strength of nylon at 20 degC to that at 100


def without_pin():
    """The solution on an arm of which no material of the pin is stated."""
    case = made.arm_case()
    pivot = made.changed(case.follower.pivot, pin_material=None)
    return made.arm_solution(
        case=made.changed(case, follower=made.changed(case.follower, pivot=pivot))
    )


def edgeless():
    """The solution on an arm with unknown pressures in its bush."""
    cycle = cycle_with("parts", made.cycle(made.arm_contour()), pivot_edge_pressure=NAN)
    return made.arm_solution(cycles=(cycle,))


NO_LOAD = {"pivot_load": np.full((2, made.POSITIONS), np.nan)}
# bush of 10 by 20 mm, 500 N sin that presses with 600 N sin on both sides, 0.4 m/s sin by 5 over
# 60 mm on the pin; nylon as of the guides
PIN_SPEED = 0.4 * 5.0 / 60.0
tried(
    "pivot_pressure",
    limited(
        "pivot_pressure",
        lambda p: on_pivot(pressure_limit=p / by_hand.WARM_NYLON),
        made.arm_solution,
    ),
    lambda: on_pivot(pressure_limit=None),
    lambda: on_pivot(loads=NO_LOAD),
    750.0 / 200.0,
    "push over the loaded share of the length, over d L",
    base=made.arm_solution,
)
tried(
    "pivot_edge_pressure",
    limited(
        "pivot_edge_pressure",
        lambda p: on_nylon(yield_strength=(p - 40e6 * WARM) / (1.0 - WARM)),
        made.arm_solution,
    ),
    without_pin,
    edgeless,
    35.0,
    "greatest of the turn",
    base=made.arm_solution,
)
tried(
    "pivot_pv",
    limited("pivot_pv", lambda p: on_pivot(pv_limit=p), made.arm_solution),
    lambda: on_pivot(pv_limit=None),
    lambda: on_pivot(loads=NO_LOAD),
    600.0 * PIN_SPEED / 2.0 / 200.0,
    "mean of R v sin^2 on the pin",
    base=made.arm_solution,
)
tried(
    "pivot_temperature",
    limited(
        "pivot_temperature", lambda t: on_nylon(temperature_limit=t + 273.15), made.arm_solution
    ),
    lambda: on_nylon(temperature_limit=None),
    lambda: at_worst_on_pivot(pivot_friction=NAN),
    56.85,
    "330 K",
    base=made.arm_solution,
)
tried(
    "pivot_speed",
    limited("pivot_speed", lambda v: on_pivot(speed_limit=v), made.arm_solution),
    lambda: on_pivot(speed_limit=None),
    lambda: on_pivot(loads={"velocity": NAN}),
    PIN_SPEED,
    "w times half the stroke, 80 rad/s by 5 mm, by the radius of the pin over the arm",
    base=made.arm_solution,
)
by_limit(
    "pivot_wear",
    "wear_depth",
    lambda: on_pivot(loads=NO_LOAD),
    1e3 * 1e-17 * 1e6 * 600.0 * PIN_SPEED / 2.0 / 200.0 * 3.6e6,
    "Archard: 1e-17 m2/N times PV times 1000 h",
    base=made.arm_solution,
    missing=lambda: on_pivot(wear_rate=None),
)
tried(
    "pivot_expansion",
    limited("pivot_expansion", lambda gap: on_pivot(clearance=gap), made.arm_solution),
    lambda: on_pivot(wall=None),
    lambda: at_worst_on_pivot(pivot_friction=NAN),
    10.0 * (1.25 * 1.4 / 1.45 * (8e-5 * 36.85 + 0.002) + 1.2e-5 * 36.85),
    "Lame as of the guides, and the pin",
    base=made.arm_solution,
)
by_limit(
    "pivot_jam_index",
    "jam_index",
    lambda: on_pivot(loads={"jam_index": NAN}),
    1.2 * 0.3,
    "greatest of 0.2 + 0.1 sin on the rise, by the pushes on both sides",
    base=made.arm_solution,
)
by_limit(
    "pivot_jam_index_friction_max",
    "jam_index",
    lambda: at_worst_on_pivot(jam_index=NAN),
    1.2 * 0.4,
    "0.3 + 0.1 sin, by the pushes on both sides",
    base=made.arm_solution,
)
by_limit(
    "pivot_static",
    "pivot_static_safety",
    lambda: needles(loads=NO_LOAD),
    12_000.0 / 500.0,
    "C0/R",
    base=lambda: made.arm_solution("needle_bearing"),
    missing=lambda: needles(C0=None),
)
by_limit(
    "pivot_life",
    "pivot_life",
    lambda: needles(loads=NO_LOAD),
    by_hand.pivot_life(10_000.0, 500.0, 0.4 / 0.06),
    "(C/P_m)^(10/3) million turns at the mean of |sin|^(13/3)",
    base=lambda: made.arm_solution("needle_bearing"),
    missing=lambda: needles(C=None),
)
