"""Demands by hand, where they are worst, and what the whole set of checks does."""

import datetime as dt
from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
from trial_variants import (
    NAN,
    cycle_with,
    with_bearing,
    with_case,
    with_contact,
    with_cycle,
    with_gap,
    with_guides,
    with_limits,
    with_loads,
    with_material,
    with_part,
    with_rolling,
)

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.requirements_section import Waiver
from camwright.pipeline.checks import (
    all_checks,
    binding,
    cam_shape,
    design_checks,
    jump_and_jamming,
    roller_bearing,
    torque_balance,
    verdict,
)
from camwright.pipeline.checks import contact_strength as contact_checks
from camwright.pipeline.checks import guide_bushes as guides
from camwright.pipeline.checks import solution_verification as evidence_checks
from camwright.pipeline.checks.extremes import greatest, least

ROUND_OFF = 1e-9


def waiver(name: str) -> Waiver:
    return Waiver(check=name, name="A. Engineer", reason="proven", date=dt.date(2025, 1, 2))


def test_the_made_up_trial_passes_and_leaves_nothing_open():
    checks = all_checks(made.evidence())
    assert verdict(checks) == "pass"
    assert binding(checks) == ()
    assert not any(c.status == "not_evaluated" for c in checks)


def test_a_shaft_and_a_key_that_are_not_described_stay_open_and_come_first():
    cam = made.changed(made.case().cam, keyway=None)
    checks = all_checks(made.evidence(case=made.case(cam=cam, camshaft=None)))
    unread = ["key_pressure", "key_shear", "shaft_bearing_life", "shaft_fatigue"]
    assert [c.id for c in checks[:4]] == unread
    assert not any(c.status == "not_evaluated" for c in checks[4:])
    assert not any(c.must_have for c in checks[:4])
    assert verdict(checks) == "pass"


@pytest.mark.parametrize(
    ("limit", "check"),
    [
        ("cam_radius", "cam_envelope"),
        ("target_life", "contact_pressure_at_life"),
        ("roller_life", "roller_life"),
    ],
)
def test_a_must_have_without_its_limit_comes_first_and_fails_the_verdict(limit, check):
    """Must-haves of a sign-off stay so when an input is missing."""
    checks = all_checks(with_limits(**{limit: None}))
    assert (checks[0].id, checks[0].status) == (check, "not_evaluated")
    assert binding(checks) == (check,)
    assert verdict(checks) == "fail"


def test_ids_are_unique_and_records_complete():
    checks = all_checks(made.evidence())
    assert len({check.id for check in checks}) == len(checks)
    for check in checks:
        record = check.as_record()
        assert all(record[key] for key in ("title", "unit", "source", "method")), check.id


def test_what_a_gentler_lift_can_help():
    helped = {check.id for check in all_checks(made.evidence()) if check.lift_can_help}
    assert {
        "pressure_angle",
        "curvature_ratio",
        "contact_pressure",
        "shakedown",
        "contact_force_margin",
        "jam_index",
        "roller_static",
        "bush_pv_A",
    } <= helped
    assert not helped & {"torque_reduction", "closure", "contact_equilibrium", "mesh_angle"}


def test_design_checks_need_neither_mesh_nor_residuals():
    """Nor the parts: as of a cycle by closed forms."""
    plain = made.cycle()
    contact = replace(
        plain.contact, half_width=NAN, residual_equilibrium=NAN, residual_complementarity=NAN
    )
    guides = replace(plain.guides, force_residual=NAN, moment_residual=NAN)
    bare = replace(plain, contact=contact, guides=guides, rolling=None, parts=None)
    preview = made.evidence(cycles=(bare,), mesh_quality=None, certificate=(), benchmarks=None)
    foreseen = {c.id: c.demand for c in design_checks(preview)}
    full = {c.id: c.demand for c in all_checks(made.evidence())}
    assert foreseen == {name: full[name] for name in foreseen}
    assert {"torque_reduction", "pressure_angle", "roller_static", "bush_pv_A"} <= set(foreseen)


# --- where -----------------------------------------------------------------------------------


def test_the_worst_load_case_and_angle_are_named():
    hard = made.cycle(load_case="rated", scale=1.1)
    light = made.cycle(load_case="start", scale=0.5)
    trial = made.of_load_cases(made.cycle(), hard, light)
    check = contact_checks.contact_pressure(trial)
    assert (check.load_case, check.cam_angle_deg) == ("rated", pytest.approx(90.0))
    assert check.demand == pytest.approx(990.0)
    lightest = jump_and_jamming.contact_force_margin(trial)
    assert (lightest.load_case, lightest.cam_angle_deg) == ("start", pytest.approx(270.0))
    assert torque_balance.torque_reduction(trial).load_case == "rated"


def test_equal_load_cases_name_the_first():
    trial = made.of_load_cases(made.cycle(load_case="one"), made.cycle(load_case="two"))
    assert contact_checks.shakedown(trial).load_case == "one"


def test_a_nan_wins_over_every_number():
    jam = {"a": made.WAVE, "b": np.where(made.THETA == 0.0, np.nan, 9.0), "c": 99.0 * made.WAVE}
    cycles = [replace(cycle_with("loads", jam_index=v), load_case=k) for k, v in jam.items()]
    for extreme in (greatest, least):
        worst = extreme(made.of_load_cases(*cycles), lambda cycle: cycle.loads.jam_index)
        assert np.isnan(worst.value)
        assert (worst.load_case, worst.cam_angle_deg) == ("b", 0.0)


# --- geometry --------------------------------------------------------------------------------


def test_pressure_angle_of_an_eccentric_disc():
    # Roller centres on a circle of radius R about a point e off the axis: sin(alpha) = e / R.
    eccentricity, radius = 0.01, 0.06
    theta = uniform_turn(360)
    distance = -eccentricity * np.cos(theta) + np.sqrt(
        radius**2 - (eccentricity * np.sin(theta)) ** 2
    )
    base = radius - eccentricity
    lift = Lift(theta, np.maximum(distance - base, 0.0))
    shape = RollerContour(PitchCurve(lift, base), made.ROLLER)
    trial = made.evidence(contour=shape)
    # 360 quintic pieces follow the disc to 1e-9 of the lift; its derivatives less well.
    angle = cam_shape.pressure_angle(trial)
    assert angle.demand == pytest.approx(np.rad2deg(np.arcsin(eccentricity / radius)), rel=1e-6)
    assert cam_shape.curvature_ratio(trial).demand == pytest.approx(radius / made.ROLLER, rel=1e-4)
    assert cam_shape.undercut(trial).demand == pytest.approx(1 - made.ROLLER / radius, rel=1e-4)
    assert cam_shape.spring_travel(trial).demand == pytest.approx(2e3 * eccentricity, rel=1e-6)
    assert cam_shape.concave_radius(trial) is None


def test_limit_of_thirty_degrees_reads_thirty():
    limit = cam_shape.pressure_angle(with_limits(pressure_angle=np.deg2rad(30)))
    assert limit.limit == 30.0


def test_undercut_cam_is_a_verdict():
    results = (f(made.evidence(contour=made.undercut())) for f in cam_shape.CHECKS)
    checks = {c.id: c for c in results if c is not None}
    assert checks["undercut"].demand < 0
    assert checks["undercut"].utilisation == np.inf
    assert checks["self_intersection"].demand > 0
    for name in ("undercut", "self_intersection", "curvature_ratio", "pressure_angle"):
        assert checks[name].status == "fail", name


def test_second_contact_counts_depth_only():
    trials = (with_gap(-2e-6, 1.0), with_gap(np.inf), with_gap(np.nan))
    cut, clear, unknown = (cam_shape.second_contact(trial) for trial in trials)
    assert [check.status for check in (cut, clear, unknown)] == ["fail", "pass", "not_evaluated"]
    assert cut.demand == pytest.approx(2e-3)
    assert cut.cam_angle_deg == pytest.approx(np.rad2deg(1.0))
    assert clear.cam_angle_deg is None


def test_the_wall_is_thinner_by_the_keyway():
    plain = cam_shape.minimum_wall(with_part("cam", keyway=None))
    assert plain.demand == pytest.approx((made.BASE - made.ROLLER) / 0.0085)
    keyed = cam_shape.minimum_wall(made.evidence())
    assert keyed.demand == pytest.approx((made.BASE - made.ROLLER) / 0.0108)


# --- forces ----------------------------------------------------------------------------------


def test_jump_is_where_inertia_eats_the_spring():
    # Harmonic lift: least s'' = -stroke/2 at full lift, F_s = P + k stroke there.
    relief = made.MASS * made.CAM_SPEED**2 * 0.5 * made.STROKE
    expected = relief / (made.PRELOAD + made.RATE * made.STROKE)
    check = jump_and_jamming.jump(made.evidence())
    assert check.demand == pytest.approx(expected, rel=1e-6)
    assert check.cam_angle_deg == pytest.approx(180.0)


def test_a_follower_pressed_on_all_the_turn_cannot_jump():
    check = jump_and_jamming.jump(with_loads(inertia_force=np.full(made.POSITIONS, 5.0)))
    assert (check.demand, check.status) == (0.0, "pass")


def test_contact_lost_is_worse_than_any_number():
    lost = with_loads(normal_force=np.zeros(made.POSITIONS))
    assert jump_and_jamming.contact_force_margin(lost).utilisation == np.inf


def test_the_return_cannot_jam():
    rising = made.cycle().loads.lift_slope > 0
    trial = with_loads(jam_index=np.where(rising, 0.1, 0.9))
    assert jump_and_jamming.jam_index(trial).demand == pytest.approx(0.1)


# --- contact ---------------------------------------------------------------------------------


def test_limits_are_those_of_the_softer_body():
    trial = made.evidence()
    assert contact_checks.softer(trial)[0] == "steel"
    # 4 Y / sqrt(3) = 2.309 Y for Y = 600 MPa.
    assert contact_checks.shakedown(trial).limit == pytest.approx(1385.64, abs=0.01)
    assert contact_checks.first_yield(trial).limit == 600.0
    assert contact_checks.contact_pressure(trial).limit == 1000.0


def test_structural_steel_shakes_down_to_about_820_mpa():
    # Published order for S355: shakes down to about 0.82 GPa (Johnson 1985, 4 k).
    soft = with_material("steel", yield_strength=355e6)
    assert contact_checks.shakedown(soft).limit == pytest.approx(820, rel=0.005)


def test_first_yield_does_not_decide():
    assert not contact_checks.first_yield(made.evidence()).must_have


# --- roller ----------------------------------------------------------------------------------


def test_static_safety_by_hand():
    check = roller_bearing.roller_static(made.evidence())
    assert check.demand == pytest.approx(600.0 / 400.0)
    assert check.cam_angle_deg == pytest.approx(90.0)


def test_an_unrated_bearing_is_not_evaluated_and_fails():
    plain = with_bearing(name="plain", C=None, C0=None, radial_limit=None, speed_limit=None)
    checks = all_checks(plain)
    missing = {"roller_static", "roller_speed", "roller_life", "roller_radial"}
    assert set(binding(checks)) == missing
    notes = {c.id: c.note for c in checks}
    assert notes["roller_static"] == "no static rating is given for plain"
    assert notes["roller_speed"] == "no limiting speed is given for plain"
    assert "no dynamic rating" in notes["roller_life"]


def test_rating_life_of_a_constant_load_on_a_ring():
    # Constant load and speed: L10 = (C/P)^3 1e6 / n, n = w (R - r) / r.
    steady = cycle_with("loads", made.cycle(made.ring()), normal_force=np.full(72, 570.0))
    trial = made.evidence(contour=made.ring(), cycles=(steady,))
    spin = made.CAM_SPEED * (made.BASE - made.ROLLER) / made.ROLLER
    hours = 8e6 / (spin / (2.0 * np.pi)) / 3600.0
    assert roller_bearing.roller_life(trial).demand == pytest.approx(hours, rel=ROUND_OFF)
    assert roller_bearing.roller_speed(trial).demand == pytest.approx(
        spin * 30.0 / np.pi, rel=ROUND_OFF
    )


def test_a_life_asked_for_is_a_must():
    check = roller_bearing.roller_life(with_limits(roller_life=3600.0 * 1000.0))
    assert check.must_have
    assert check.limit == pytest.approx(1000.0)
    assert check.status == "fail"


def test_a_roller_at_rest_lives_for_ever():
    assert roller_bearing.roller_life(with_cycle(crank_speed=0.0)).demand == np.inf


# --- guides ----------------------------------------------------------------------------------


def test_bush_pressure_by_hand():
    # 500 N on 10 x 20 mm.
    assert guides.bush_pressure_a(made.evidence()).demand == pytest.approx(2.5)
    assert guides.bush_pressure_b(made.evidence()).demand == pytest.approx(1.0)


def test_bush_pv_by_hand():
    # |R v| = 500 N x 0.4 m/s x sin^2, mean one half, on 200 mm^2: 0.5 MPa m/s.
    check = guides.bush_pv_a(made.evidence())
    assert check.demand == pytest.approx(0.5, rel=1e-6)
    assert check.cam_angle_deg is None
    assert guides.bush_pv_b(made.evidence()).demand == pytest.approx(0.2, rel=1e-6)


def test_bush_pv_takes_the_size_of_what_slides_either_way():
    check = guides.bush_pv_a(with_guides(rubbing_load_a=np.full(made.POSITIONS, 500.0)))
    # Mean |sin| over 72 equal steps; 2/pi for many. The signed mean would vanish.
    mean = np.abs(np.sin(made.THETA)).mean()
    assert check.demand == pytest.approx(500.0 * 0.4 * mean / 200.0, rel=1e-6)


# --- function --------------------------------------------------------------------------------


def test_torque_reduction_by_hand():
    trial = made.evidence(cycles=(made.cycle(scale=0.6),))  # std 10 to 3
    assert torque_balance.torque_reduction(trial).demand == pytest.approx(0.7)


def test_speed_reduction_by_hand():
    """The load case with the least, of those whose ripple counts; a NaN is the least of all."""
    ripple = {"idle": (4.0, 1.0), "rated": (2.0, 1.5), "fast": (1.0, 2.0)}
    fast = made.load_case("fast", ripple_weight=0.0)
    states = (made.load_case("idle"), made.load_case("rated"), fast)
    check = torque_balance.speed_reduction(
        made.evidence(case=made.case(load_cases=states), speed_ripple=ripple)
    )
    assert (check.demand, check.load_case) == (pytest.approx(0.25), "rated")
    stalled = made.evidence(speed_ripple=ripple | {"idle": (np.nan, np.nan)})
    assert torque_balance.speed_reduction(stalled).status == "not_evaluated"
    assert torque_balance.speed_reduction(made.evidence(speed_ripple={})) is None
    assert not torque_balance.speed_reduction(with_limits(speed_reduction=None)).must_have


def test_a_cam_that_adds_ripple_has_a_negative_reduction():
    check = torque_balance.torque_reduction(made.evidence(cycles=(made.cycle(scale=3.0),)))
    assert check.demand == pytest.approx(-0.5)
    assert check.utilisation == np.inf
    assert check.status == "fail"


def test_an_engine_without_ripple_leaves_the_reduction_unknown():
    check = torque_balance.torque_reduction(with_cycle(torque_before=np.zeros(made.POSITIONS)))
    assert check.status == "not_evaluated"


def test_a_ring_takes_no_ripple_away_and_owes_no_energy():
    plain = made.cycle(made.ring())
    round_cam = replace(plain, residual_torque=plain.torque_before)
    trial = made.evidence(contour=made.ring(), cycles=(round_cam,))
    assert torque_balance.torque_reduction(trial).status == "fail"
    assert torque_balance.energy_closure(trial).demand == 0.0
    assert torque_balance.friction_balance(trial).demand == 0.0


def test_without_an_engine_there_is_no_torque_check():
    checks = all_checks(with_cycle(torque_before=None, residual_torque=None))
    assert "torque_reduction" not in {check.id for check in checks}
    assert verdict(checks) == "pass"


def test_friction_with_the_wrong_sign_on_the_return_is_seen():
    loads = made.cycle().loads
    pushed = (loads.spring_force + loads.inertia_force + 20.0) * loads.lift_slope
    check = torque_balance.friction_balance(with_loads(cam_torque=pushed))
    assert check.demand == pytest.approx(1.0, rel=1e-6)  # no loss at all where heat is made
    assert check.status == "fail"


# --- evidence --------------------------------------------------------------------------------


@pytest.mark.parametrize("searching", [True, False])
def test_without_certificate_or_mesh_nothing_is_claimed(searching):
    """A trial of a search may go without; an answer without them does not pass."""
    bare = made.evidence(certificate=(), mesh_quality=None, benchmarks=None, searching=searching)
    checks = {c.id: c for c in all_checks(bare)}
    for name in ("certificate_spread", "certificate_gci", "mesh_angle", "mesh_edges", "mesh_p0"):
        assert checks[name].status == "not_evaluated"
        assert checks[name].must_have is not searching
        assert "carries no" in checks[name].note
    assert verdict(checks.values()) == ("pass" if searching else "fail")


def test_the_worst_certified_angle_is_named():
    check = evidence_checks.certificate_spread(made.evidence())
    assert check.demand == pytest.approx(0.4)  # its size, whatever its sign
    assert check.cam_angle_deg == pytest.approx(np.rad2deg(1.5))
    assert check.must_have
    assert evidence_checks.certificate_gci(made.evidence()).cam_angle_deg == pytest.approx(
        np.rad2deg(0.5)
    )


def test_hertz_difference_skips_angles_without_load():
    contact = made.cycle().contact
    hertz, p0 = np.array(contact.p0_hertz), np.array(contact.p0)
    hertz[:3] = p0[:3] = 0.0
    check = evidence_checks.hertz_difference(with_contact(p0=p0, p0_hertz=hertz))
    assert check.demand == pytest.approx(1.0)


# --- waivers and sources ---------------------------------------------------------------------


def test_a_waiver_is_applied_and_says_who_why_and_when():
    travel = made.changed(made.case().spring, travel_max=0.005)
    plain = made.evidence(case=made.case(spring=travel))
    assert binding(all_checks(plain)) == ("spring_travel",)
    waived = made.evidence(case=made.case(spring=travel, waivers=(waiver("spring_travel"),)))
    checks = {c.id: c for c in all_checks(waived)}
    assert checks["spring_travel"].status == "waived"
    assert checks["spring_travel"].waiver == "A. Engineer, 2025-01-02: proven"
    assert verdict(checks.values()) == "pass"


@pytest.mark.parametrize("name", ["contact_equilibrium", "energy_closure", "benchmark_hertz"])
def test_evidence_cannot_be_waived(name):
    """A person may accept a risk, not a wrong number."""
    wrong = cycle_with("contact", residual_equilibrium=np.full(made.POSITIONS, 1e-3))
    trial = made.evidence(case=made.case(waivers=(waiver(name),)), cycles=(wrong,))
    checks = {c.id: c for c in all_checks(trial)}
    assert checks[name].waiver is None
    assert checks["contact_equilibrium"].status == "fail"
    assert checks["idle_waivers"].note == name


def test_the_case_s_own_source_is_printed():
    trial = with_limits(sources={"pressure_angle": "house rule 7"})
    assert cam_shape.pressure_angle(trial).source == "house rule 7"


def test_evidence_is_frozen():
    with pytest.raises(AttributeError):
        made.evidence().case = None


# --- rolling ---------------------------------------------------------------------------------


def check_of(name, trial):
    return next(c for c in all_checks(trial) if c.id == name)


def only_at_one_angle(value):
    return np.where(np.arange(made.POSITIONS) == 5, value, np.nan)


def test_grip_is_half_of_friction():
    check = check_of("roller_grip", made.evidence())
    assert check.demand == pytest.approx(0.03)
    assert check.limit == pytest.approx(0.05)
    assert not check.must_have


def test_grip_counts_where_the_roller_is_loaded():
    trial = with_rolling(traction_demand=only_at_one_angle(0.04))
    assert check_of("roller_grip", trial).demand == 0.04


def test_film_counts_where_the_roller_is_loaded():
    film = replace(made.cycle().rolling.film, ratio=only_at_one_angle(1.3))
    assert check_of("film_ratio", with_rolling(film=film)).demand == 1.3


def test_fatigue_takes_the_greatest_of_the_map():
    check = check_of("surface_fatigue", made.evidence())
    assert (check.demand, check.limit) == pytest.approx((200.0, 300.0))


def test_case_is_used_most_where_strength_falls_faster_than_stress():
    """Half way down the case the yield strength is half way from 600 to 400 MPa."""
    assert check_of("hardened_case", made.evidence()).demand == pytest.approx(400 / 500)


@pytest.mark.parametrize("name", ["roller_grip", "film_ratio", "surface_fatigue", "hardened_case"])
def test_without_the_rolling_of_a_cycle_nothing_is_evaluated(name):
    check = check_of(name, with_cycle(rolling=None))
    assert check.status == "not_evaluated"
    assert not check.blocks


@pytest.mark.parametrize(
    ("name", "section", "field", "word"),
    [
        ("roller_grip", "roller", "friction", "no friction"),
        ("film_ratio", "roller", "roughness", "no roughness of the roller"),
        ("film_ratio", "cam", "roughness", "no roughness of the cam"),
    ],
)
def test_a_missing_input_of_rolling_is_named(name, section, field, word):
    assert word in check_of(name, with_part(section, **{field: None})).note


def test_a_missing_lubricant_is_named():
    assert "no lubricant" in check_of("film_ratio", with_case(lubricant=None)).note


@pytest.mark.parametrize("field", ["fatigue_torsion", "fatigue_bending", "case_depth"])
def test_a_missing_strength_of_the_card_is_named(field):
    name = "surface_fatigue" if field.startswith("fatigue") else "hardened_case"
    check = check_of(name, with_material("steel", **{field: None}))
    assert check.status == "not_evaluated"
    assert "the card of steel" in check.note
