"""Demands by hand, where they are worst, and what the whole set of checks does."""

from dataclasses import replace
from types import SimpleNamespace

import fake_trial as fake
import numpy as np
import pytest

from geometry.arrays import uniform_turn
from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.checks import (
    all_checks,
    binding,
    design_checks,
    forces,
    function,
    geometry,
    guides,
    roller,
    verdict,
)
from pipeline.checks import contact as contact_checks
from pipeline.checks import evidence as evidence_checks
from pipeline.checks.trial import greatest, least

ROUND_OFF = 1e-9


def ring() -> Contour:
    """A cam that lifts nothing."""
    return Contour(PitchCurve(Lift(fake.THETA, np.zeros(fake.POSITIONS)), fake.BASE), fake.ROLLER)


def waiver(name: str):
    return SimpleNamespace(check=name, name="A. Engineer", reason="proven", date="2025-01-02")


def test_the_fake_trial_passes():
    checks = all_checks(fake.evidence())
    assert verdict(checks) == "pass"
    assert binding(checks) == ()
    # Of the standard set a shaft and a key that nobody describes stay open, and say so first.
    shaft = ["key_shear", "shaft_bearing_life", "shaft_fatigue"]
    assert [c.id for c in checks[:3]] == shaft
    assert not any(c.status == "not_evaluated" for c in checks[3:])
    assert not any(c.must_have for c in checks[:3])


@pytest.mark.parametrize(
    ("limit", "check"),
    [
        ("cam_radius", "cam_envelope"),
        ("target_life", "contact_pressure_at_life"),
        ("roller_life", "roller_life"),
    ],
)
def test_what_nobody_asks_for_is_listed_first_and_fails_the_verdict(limit, check):
    """Must-haves of a sign-off stay so when an input is missing."""
    checks = all_checks(fake.evidence(case=fake.limits(**{limit: None})))
    assert (checks[0].id, checks[0].status) == (check, "not_evaluated")
    assert binding(checks) == (check,)
    assert verdict(checks) == "fail"


def test_ids_are_unique_and_records_complete():
    checks = all_checks(fake.evidence())
    assert len({check.id for check in checks}) == len(checks)
    for check in checks:
        record = check.as_record()
        assert all(record[key] for key in ("title", "unit", "source", "method")), check.id


def test_what_a_gentler_lift_can_help():
    helped = {check.id for check in all_checks(fake.evidence()) if check.lift_can_help}
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
    plain = fake.cycle()
    bare = fake.changed(
        plain,
        contact=SimpleNamespace(p0=plain.contact.p0, von_mises=plain.contact.von_mises),
        guides=SimpleNamespace(
            reaction_a=plain.guides.reaction_a,
            reaction_b=plain.guides.reaction_b,
            rubbing_load_a=plain.guides.rubbing_load_a,
            rubbing_load_b=plain.guides.rubbing_load_b,
        ),
    )
    foreseen = {c.id: c.demand for c in design_checks(fake.evidence(cycles=(bare,)))}
    full = {c.id: c.demand for c in all_checks(fake.evidence())}
    assert foreseen == {name: full[name] for name in foreseen}
    assert {"torque_reduction", "pressure_angle", "roller_static", "bush_pv_A"} <= set(foreseen)


# --- where -----------------------------------------------------------------------------------


def test_the_worst_load_case_and_angle_are_named():
    hard = fake.cycle(load_case="rated", scale=1.1)
    trial = fake.evidence(cycles=(fake.cycle(), hard, fake.cycle(load_case="start", scale=0.5)))
    check = contact_checks.contact_pressure(trial)
    assert (check.load_case, check.cam_angle_deg) == ("rated", pytest.approx(90.0))
    assert check.demand == pytest.approx(990.0)
    lightest = forces.contact_force_margin(trial)
    assert (lightest.load_case, lightest.cam_angle_deg) == ("start", pytest.approx(270.0))
    assert function.torque_reduction(trial).load_case == "rated"


def test_equal_load_cases_name_the_first():
    trial = fake.evidence(cycles=(fake.cycle(load_case="one"), fake.cycle(load_case="two")))
    assert contact_checks.shakedown(trial).load_case == "one"


def test_a_nan_wins_over_every_number():
    values = {"a": [1.0, 2.0], "b": [np.nan, 9.0], "c": [99.0, -99.0]}
    cycles = tuple(
        SimpleNamespace(load_case=name, theta=np.array([0.0, np.pi]), values=np.array(v))
        for name, v in values.items()
    )
    trial = fake.evidence(cycles=cycles)
    for extreme in (greatest, least):
        worst = extreme(trial, lambda cycle: cycle.values)
        assert np.isnan(worst.value)
        assert (worst.load_case, worst.cam_angle_deg) == ("b", 0.0)


def test_without_a_cycle_nothing_is_evaluated():
    checks = {c.id: c for c in all_checks(fake.evidence(cycles=()))}
    assert checks["contact_pressure"].status == "not_evaluated"
    assert verdict(checks.values()) == "fail"


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
    shape = Contour(PitchCurve(lift, base), fake.ROLLER)
    trial = fake.evidence(contour=shape)
    # 360 quintic pieces follow the disc to 1e-9 of the lift; its derivatives less well.
    angle = geometry.pressure_angle(trial)
    assert angle.demand == pytest.approx(np.rad2deg(np.arcsin(eccentricity / radius)), rel=1e-6)
    assert geometry.curvature_ratio(trial).demand == pytest.approx(radius / fake.ROLLER, rel=1e-4)
    assert geometry.undercut(trial).demand == pytest.approx(1 - fake.ROLLER / radius, rel=1e-4)
    assert geometry.spring_travel(trial).demand == pytest.approx(2e3 * eccentricity, rel=1e-6)
    assert geometry.concave_radius(trial) is None


def test_limit_of_thirty_degrees_reads_thirty():
    limit = geometry.pressure_angle(fake.evidence(case=fake.limits(pressure_angle=np.deg2rad(30))))
    assert limit.limit == 30.0


def test_undercut_cam_is_a_verdict():
    # A lobe of 12 mm with five cusps in the turn under a large roller.
    lift = Lift(uniform_turn(360), 0.006 * (1.0 - np.cos(5.0 * uniform_turn(360))))
    shape = Contour(PitchCurve(lift, 0.03), 0.02)
    found = (f(fake.evidence(contour=shape)) for f in geometry.CHECKS)
    checks = {c.id: c for c in found if c is not None}
    assert checks["undercut"].demand < 0
    assert checks["undercut"].utilisation == np.inf
    assert checks["self_intersection"].demand > 0
    for name in ("undercut", "self_intersection", "curvature_ratio", "pressure_angle"):
        assert checks[name].status == "fail", name


def test_second_contact_counts_depth_only():
    touching, clear, unknown = (
        SimpleNamespace(clearance=lambda at=at: at, roller_radius=fake.ROLLER)
        for at in ((-2e-6, 1.0), (np.inf, np.nan), (np.nan, np.nan))
    )
    found = [geometry.second_contact(fake.evidence(contour=c)) for c in (touching, clear, unknown)]
    assert [check.status for check in found] == ["fail", "pass", "not_evaluated"]
    assert found[0].demand == pytest.approx(2e-3)
    assert found[0].cam_angle_deg == pytest.approx(np.rad2deg(1.0))
    assert found[1].cam_angle_deg is None


def test_the_wall_is_thinner_by_the_keyway():
    plain = geometry.minimum_wall(fake.evidence())
    assert plain.demand == pytest.approx((fake.BASE - fake.ROLLER) / 0.0085)
    cam = SimpleNamespace(
        bore_radius=0.0085, keyway=SimpleNamespace(depth=0.0023), material="steel"
    )
    keyed = geometry.minimum_wall(fake.evidence(case=fake.case(cam=cam)))
    assert keyed.demand == pytest.approx((fake.BASE - fake.ROLLER) / 0.0108)


# --- forces ----------------------------------------------------------------------------------


def test_jump_is_where_inertia_eats_the_spring():
    # Harmonic lift: least s'' = -stroke/2 at full lift, F_s = P + k stroke there.
    relief = fake.MASS * fake.CAM_SPEED**2 * 0.5 * fake.STROKE
    expected = relief / (fake.PRELOAD + fake.RATE * fake.STROKE)
    check = forces.jump(fake.evidence())
    assert check.demand == pytest.approx(expected, rel=1e-6)
    assert check.cam_angle_deg == pytest.approx(180.0)


def test_a_follower_pressed_on_all_the_turn_cannot_jump():
    plain = fake.cycle()
    pressed = fake.changed(plain.loads, inertia_force=np.full(fake.POSITIONS, 5.0))
    check = forces.jump(fake.evidence(cycles=(fake.changed(plain, loads=pressed),)))
    assert (check.demand, check.status) == (0.0, "pass")


def test_contact_lost_is_worse_than_any_number():
    plain = fake.cycle()
    lost = fake.changed(plain.loads, normal_force=np.zeros(fake.POSITIONS))
    check = forces.contact_force_margin(fake.evidence(cycles=(fake.changed(plain, loads=lost),)))
    assert check.utilisation == np.inf


def test_the_return_cannot_jam():
    plain = fake.cycle()
    slope = plain.loads.lift_slope
    index = np.where(slope > 0, 0.1, 0.9)
    trial = fake.evidence(
        cycles=(fake.changed(plain, loads=fake.changed(plain.loads, jam_index=index)),)
    )
    assert forces.jam_index(trial).demand == pytest.approx(0.1)


# --- contact ---------------------------------------------------------------------------------


def test_limits_are_those_of_the_softer_body():
    trial = fake.evidence()
    assert contact_checks.softer(trial)[0] == "steel"
    # 4 Y / sqrt(3) = 2.309 Y for Y = 600 MPa.
    assert contact_checks.shakedown(trial).limit == pytest.approx(1385.64, abs=0.01)
    assert contact_checks.first_yield(trial).limit == 600.0
    assert contact_checks.contact_pressure(trial).limit == 1000.0


def test_structural_steel_shakes_down_to_about_820_mpa():
    base = fake.case()
    soft = fake.changed(base.materials["steel"], yield_strength=355e6)
    case = fake.changed(base, materials=base.materials | {"steel": soft})
    # Published order for S355: shakes down to about 0.82 GPa (Johnson 1985, 4 k).
    assert contact_checks.shakedown(fake.evidence(case=case)).limit == pytest.approx(820, rel=0.005)


def test_first_yield_does_not_decide():
    assert not contact_checks.first_yield(fake.evidence()).must_have


# --- roller ----------------------------------------------------------------------------------


def test_static_safety_by_hand():
    check = roller.roller_static(fake.evidence())
    assert check.demand == pytest.approx(600.0 / 400.0)
    assert check.cam_angle_deg == pytest.approx(90.0)


def test_an_unrated_bearing_is_not_evaluated_and_fails():
    bearing = SimpleNamespace(
        name="plain", C=None, C0=None, radial_limit=None, speed_limit=None, source=""
    )
    case = fake.case(roller=fake.changed(fake.case().roller, bearing=bearing))
    checks = all_checks(fake.evidence(case=case))
    missing = {"roller_static", "roller_speed", "roller_life", "roller_radial"}
    assert set(binding(checks)) == missing
    notes = {c.id: c.note for c in checks}
    assert notes["roller_static"] == "no static rating is given for plain"
    assert notes["roller_speed"] == "no limiting speed is given for plain"
    assert "no dynamic rating" in notes["roller_life"]


def test_rating_life_of_a_constant_load_on_a_ring():
    # Constant load and speed: L10 = (C/P)^3 1e6 / n, n = w (R - r) / r.
    plain = fake.cycle(ring())
    steady = fake.changed(plain.loads, normal_force=np.full(fake.POSITIONS, 570.0))
    trial = fake.evidence(contour=ring(), cycles=(fake.changed(plain, loads=steady),))
    spin = fake.CAM_SPEED * (fake.BASE - fake.ROLLER) / fake.ROLLER
    hours = 8e6 / (spin / (2.0 * np.pi)) / 3600.0
    assert roller.roller_life(trial).demand == pytest.approx(hours, rel=ROUND_OFF)
    assert roller.roller_speed(trial).demand == pytest.approx(spin * 30.0 / np.pi, rel=ROUND_OFF)


def test_a_life_asked_for_is_a_must():
    check = roller.roller_life(fake.evidence(case=fake.limits(roller_life=3600.0 * 1000.0)))
    assert check.must_have
    assert check.limit == pytest.approx(1000.0)
    assert check.status == "fail"


def test_a_roller_at_rest_lives_for_ever():
    still = fake.cycle(crank_speed=0.0)
    assert roller.roller_life(fake.evidence(cycles=(still,))).demand == np.inf


# --- guides ----------------------------------------------------------------------------------


def test_bush_pressure_by_hand():
    # 500 N on 10 x 20 mm.
    assert guides.bush_pressure_a(fake.evidence()).demand == pytest.approx(2.5)
    assert guides.bush_pressure_b(fake.evidence()).demand == pytest.approx(1.0)


def test_bush_pv_by_hand():
    # |R v| = 500 N x 0.4 m/s x sin^2, mean one half, on 200 mm^2: 0.5 MPa m/s.
    check = guides.bush_pv_a(fake.evidence())
    assert check.demand == pytest.approx(0.5, rel=1e-6)
    assert check.cam_angle_deg is None
    assert guides.bush_pv_b(fake.evidence()).demand == pytest.approx(0.2, rel=1e-6)


def test_bush_pv_takes_the_size_of_what_slides_either_way():
    plain = fake.cycle()
    reaction = fake.changed(plain.guides, rubbing_load_a=np.full(fake.POSITIONS, 500.0))
    check = guides.bush_pv_a(fake.evidence(cycles=(fake.changed(plain, guides=reaction),)))
    # Mean |sin| over 72 equal steps; 2/pi for many. The signed mean would vanish.
    mean = np.abs(np.sin(fake.THETA)).mean()
    assert check.demand == pytest.approx(500.0 * 0.4 * mean / 200.0, rel=1e-6)


# --- function --------------------------------------------------------------------------------


def test_torque_reduction_by_hand():
    trial = fake.evidence(cycles=(fake.cycle(scale=0.6),))  # std 10 to 3
    assert function.torque_reduction(trial).demand == pytest.approx(0.7)


def test_speed_reduction_by_hand():
    """The load case with the least, of those whose ripple counts; a NaN is the least of all."""
    ripple = {"idle": (4.0, 1.0), "rated": (2.0, 1.5), "fast": (1.0, 2.0)}
    fast = SimpleNamespace(name="fast", ripple_weight=0.0, preload=None)
    given = fake.evidence(case=fake.case(load_cases=(fast,)), speed_ripple=ripple)
    check = function.speed_reduction(given)
    assert (check.demand, check.load_case) == (pytest.approx(0.25), "rated")
    stalled = fake.evidence(speed_ripple=ripple | {"idle": (np.nan, np.nan)})
    assert function.speed_reduction(stalled).status == "not_evaluated"
    assert function.speed_reduction(fake.evidence(speed_ripple={})) is None
    unasked = fake.evidence(case=fake.limits(speed_reduction=None))
    assert not function.speed_reduction(unasked).must_have


def test_a_cam_that_adds_ripple_has_a_negative_reduction():
    check = function.torque_reduction(fake.evidence(cycles=(fake.cycle(scale=3.0),)))
    assert check.demand == pytest.approx(-0.5)
    assert check.utilisation == np.inf
    assert check.status == "fail"


def test_an_engine_without_ripple_leaves_the_reduction_unknown():
    silent = fake.cycle(torque_before=np.zeros(fake.POSITIONS))
    check = function.torque_reduction(fake.evidence(cycles=(silent,)))
    assert check.status == "not_evaluated"


def test_a_ring_takes_no_ripple_away_and_owes_no_energy():
    plain = fake.cycle(ring())
    trial = fake.evidence(
        contour=ring(), cycles=(fake.changed(plain, residual_torque=plain.torque_before),)
    )
    assert function.torque_reduction(trial).status == "fail"
    assert function.energy_closure(trial).demand == 0.0
    assert function.friction_balance(trial).demand == 0.0


def test_without_an_engine_there_is_no_torque_check():
    given = fake.cycle(torque_before=None, residual_torque=None)
    checks = all_checks(fake.evidence(cycles=(given,)))
    assert "torque_reduction" not in {check.id for check in checks}
    assert verdict(checks) == "pass"


def test_friction_with_the_wrong_sign_on_the_return_is_seen():
    plain = fake.cycle()
    loads = plain.loads
    pushed = (loads.spring_force + loads.inertia_force + 20.0) * loads.lift_slope
    wrong = fake.changed(plain, loads=fake.changed(loads, cam_torque=pushed))
    check = function.friction_balance(fake.evidence(cycles=(wrong,)))
    assert check.demand == pytest.approx(1.0, rel=1e-6)  # no loss at all where heat is made
    assert check.status == "fail"


# --- evidence --------------------------------------------------------------------------------


@pytest.mark.parametrize("searching", [True, False])
def test_without_certificate_or_mesh_nothing_is_claimed(searching):
    """A trial of a search may go without; an answer without them does not pass."""
    bare = fake.evidence(certificate=(), mesh_quality=None, benchmarks=None, searching=searching)
    checks = {c.id: c for c in all_checks(bare)}
    for name in ("certificate_spread", "certificate_gci", "mesh_angle", "mesh_edges", "mesh_p0"):
        assert checks[name].status == "not_evaluated"
        assert checks[name].must_have is not searching
        assert "carries no" in checks[name].note
    assert verdict(checks.values()) == ("pass" if searching else "fail")


def test_the_worst_certified_angle_is_named():
    check = evidence_checks.certificate_spread(fake.evidence())
    assert check.demand == 0.4  # its size, whatever its sign
    assert check.cam_angle_deg == pytest.approx(np.rad2deg(1.5))
    assert check.must_have
    assert evidence_checks.certificate_gci(fake.evidence()).cam_angle_deg == pytest.approx(
        np.rad2deg(0.5)
    )


def test_hertz_difference_skips_angles_without_load():
    plain = fake.cycle()
    hertz, p0 = np.array(plain.contact.p0_hertz), np.array(plain.contact.p0)
    hertz[:3] = p0[:3] = 0.0
    bare = fake.changed(plain, contact=fake.changed(plain.contact, p0=p0, p0_hertz=hertz))
    check = evidence_checks.hertz_difference(fake.evidence(cycles=(bare,)))
    assert check.demand == pytest.approx(1.0)


# --- waivers and sources ---------------------------------------------------------------------


def test_a_waiver_is_applied_and_says_who_why_and_when():
    travel = fake.changed(fake.case().spring, travel_max=0.005)
    plain = fake.evidence(case=fake.case(spring=travel))
    assert binding(all_checks(plain)) == ("spring_travel",)
    waived = fake.evidence(case=fake.case(spring=travel, waivers=(waiver("spring_travel"),)))
    checks = {c.id: c for c in all_checks(waived)}
    assert checks["spring_travel"].status == "waived"
    assert checks["spring_travel"].waiver == "A. Engineer, 2025-01-02: proven"
    assert verdict(checks.values()) == "pass"


@pytest.mark.parametrize("name", ["contact_equilibrium", "energy_closure", "benchmark_hertz"])
def test_evidence_cannot_be_waived(name):
    """A person may accept a risk, not a wrong number."""
    plain = fake.cycle()
    wrong = fake.changed(plain.contact, residual_equilibrium=np.full(fake.POSITIONS, 1e-3))
    given = fake.evidence(
        case=fake.case(waivers=(waiver(name),)),
        cycles=(fake.changed(plain, contact=wrong),),
    )
    checks = {c.id: c for c in all_checks(given)}
    assert checks[name].waiver is None
    assert checks["contact_equilibrium"].status == "fail"
    assert checks["idle_waivers"].note == name


def test_the_case_s_own_source_is_printed():
    case = fake.case(limits=SimpleNamespace(sources={"pressure_angle": "house rule 7"}))
    assert geometry.pressure_angle(fake.evidence(case=case)).source == "house rule 7"


def test_evidence_is_frozen():
    with pytest.raises(AttributeError):
        replace(fake.evidence()).case = None


def rolling(name, **changes):
    return next(c for c in all_checks(fake.evidence(**changes)) if c.id == name)


def without_rolling():
    return {"cycles": (fake.cycle(rolling=None),)}


def test_grip_is_half_of_friction():
    check = rolling("roller_grip")
    assert check.demand == pytest.approx(0.03)
    assert check.limit == pytest.approx(0.05)
    assert not check.must_have


def test_grip_counts_where_the_roller_is_loaded():
    demand = np.full(fake.POSITIONS, np.nan)
    demand[5] = 0.04
    parts = fake.changed(fake.cycle().rolling, traction_demand=demand)
    assert rolling("roller_grip", cycles=(fake.cycle(rolling=parts),)).demand == 0.04


def test_film_counts_where_the_roller_is_loaded():
    ratio = np.full(fake.POSITIONS, np.nan)
    ratio[5] = 1.3
    parts = fake.changed(fake.cycle().rolling, film=SimpleNamespace(ratio=ratio))
    assert rolling("film_ratio", cycles=(fake.cycle(rolling=parts),)).demand == 1.3


def test_fatigue_takes_the_greatest_of_the_map():
    check = rolling("surface_fatigue")
    assert (check.demand, check.limit) == pytest.approx((200.0, 300.0))


def test_case_is_used_most_where_strength_falls_faster_than_stress():
    """Half way down the case the yield strength is half way from 600 to 400 MPa."""
    assert rolling("hardened_case").demand == pytest.approx(400 / 500)


@pytest.mark.parametrize("name", ["roller_grip", "film_ratio", "surface_fatigue", "hardened_case"])
def test_rolling_that_was_not_looked_at_is_not_evaluated(name):
    check = rolling(name, **without_rolling())
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
def test_what_rolling_misses_is_named(name, section, field, word):
    base = fake.case()
    part = fake.changed(getattr(base, section), **{field: None})
    assert word in rolling(name, case=fake.changed(base, **{section: part})).note


@pytest.mark.parametrize("field", ["fatigue_torsion", "fatigue_bending", "case_depth"])
def test_what_the_card_misses_is_named(field):
    base = fake.case()
    steel = fake.changed(base.materials["steel"], **{field: None})
    name = "surface_fatigue" if field.startswith("fatigue") else "hardened_case"
    check = rolling(name, case=fake.changed(base, materials=base.materials | {"steel": steel}))
    assert check.status == "not_evaluated"
    assert "the card of steel" in check.note
