"""Demands by hand, where they are worst, and what the whole set of checks does."""

import datetime as dt
from dataclasses import replace

import hand_calculations as by_hand
import made_trial as made
import numpy as np
import pytest
from trial_variants import (
    NAN,
    NO_ROLLING,
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
    with_speed,
)

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.verdict import binding, screen, verdict, within_depth
from camwright.pipeline.case.machine import CREEP
from camwright.pipeline.case.requirements_section import Waiver
from camwright.pipeline.case.scope_section import Scope
from camwright.pipeline.checks import (
    cam_shape,
    contact_strength,
    jump_and_jamming,
    roller_bearing,
    solution_verification,
    surface_durability,
    torque_balance,
)
from camwright.pipeline.checks import guide_strength as guides
from camwright.pipeline.checks.check import Check, Waived
from camwright.pipeline.checks.extremes import greatest, least
from camwright.pipeline.checks.registry import (
    CHECKS,
    FORECAST,
    all_checks,
    checks_of,
)
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solved_cam import ContourCam

ROUND_OFF = 1e-9


def degrees(check: Check) -> float:
    return check.as_record()["cam_angle_deg"]


def waiver(name: str, up_to: str | float = 1.0) -> Waiver:
    date = dt.date(2025, 1, 2)
    return Waiver(check=name, up_to=up_to, name="A. Engineer", reason="proven", date=date)


def test_the_made_up_solution_passes_and_leaves_nothing_open():
    checks = all_checks(made.solution())
    assert verdict(checks) == "pass"
    assert binding(checks) == ()
    assert not any(c.status == "not_evaluated" for c in checks)


def test_a_shaft_and_a_key_that_are_not_described_stay_open_and_come_first():
    cam = made.changed(made.case().cam, keyway=None)
    checks = all_checks(made.solution(case=made.case(cam=cam, camshaft=None)))
    unread = ["bore_pressure", "data_camshaft", "data_camshaft_bearings", "data_gear", "data_key"]
    assert [c.id for c in checks[: len(unread)]] == unread
    assert not any(c.status == "not_evaluated" for c in checks[len(unread) :])
    assert all(c.must_have and c.note for c in checks[: len(unread)])
    assert verdict(checks) == "incomplete"


def test_a_shaft_and_a_key_that_the_scope_leaves_out_are_not_judged():
    cam = made.changed(made.case().cam, keyway=None)
    parts = ("camshaft", "camshaft_bearings", "key", "gear")
    scope = Scope(not_covered=parts, reason="engine shaft of the maker")
    checks = all_checks(made.solution(case=made.case(cam=cam, camshaft=None, scope=scope)))
    assert verdict(checks) == "pass"
    assert not any(c.id.startswith(("shaft", "key", "gear", "pinion", "cam_slip")) for c in checks)


@pytest.mark.parametrize(
    ("limit", "missing"),
    [
        ("cam_radius", {"cam_radius"}),
        ("target_life", {"contact_pressure_at_life", "grease_life"}),
        ("roller_life", {"roller_life", "roller_modified_life"}),
    ],
)
def test_a_must_have_without_its_limit_comes_first_and_leaves_the_verdict_open(limit, missing):
    """Must-haves of a sign-off stay so when an input is missing."""
    checks = all_checks(with_limits(**{limit: None}))
    assert checks[0].id in missing
    assert checks[0].status == "not_evaluated"
    assert missing <= set(binding(checks))
    assert verdict(checks) == "incomplete"


def test_ids_are_unique_and_records_complete():
    checks = all_checks(made.solution())
    assert len({check.id for check in checks}) == len(checks)
    for check in checks:
        record = check.as_record()
        assert all(record[key] for key in ("title", "unit", "source", "method")), check.id


def test_what_a_gentler_lift_can_help():
    helped = {check.id for check in all_checks(made.solution()) if check.lift_can_help}
    assert {
        "pressure_angle",
        "curvature_ratio",
        "contact_pressure",
        "shakedown",
        "contact_force_margin",
        "jam_index",
        "roller_static",
        "guide_pv_A",
    } <= helped
    assert not helped & {"torque_reduction", "closure", "contact_equilibrium", "mesh_angle"}


def test_a_forecast_needs_neither_mesh_nor_residuals():
    """As of a preview: its demands on the design are those of the whole solution."""
    plain = made.cycle()
    contact = replace(
        plain.contact,
        tier=Tier.PREVIEW,
        half_width=NAN,
        residual_equilibrium=NAN,
        residual_complementarity=NAN,
    )
    reactions = replace(plain.guides, force_residual=NAN, moment_residual=NAN)
    rough = made.solution(
        cycles=(made.changed_cycle(plain, contact=contact, guides=reactions),),
        tier=Tier.PREVIEW, mesh=None, certificate=(), benchmarks=None,
    )  # fmt: skip
    # A copy of a cycle has nothing of the rolling and parts that were put into it.
    preview = replace(rough, cycles=tuple(replace(cycle) for cycle in rough.cycles))
    forecast = {c.id: c for c in checks_of(preview, FORECAST)}
    full = {c.id: c.demand for c in all_checks(made.solution())}
    for name in ("torque_reduction", "pressure_angle", "roller_static", "guide_pv_A"):
        assert forecast[name].demand == full[name], name
    assert all(c.must_have or c.demand is None for c in forecast.values())
    # what no lift cures is not forecast, but the reduction that it costs
    assert {name for name, c in forecast.items() if not c.lift_can_help} == {"torque_reduction"}


def test_a_preview_leaves_out_what_only_finite_elements_can_judge():
    preview = made.solution(tier=Tier.PREVIEW, mesh=None, certificate=(), benchmarks=None)
    checks, full = all_checks(preview), all_checks(made.solution())
    by_elements = {declared.id for declared in CHECKS if declared.tier > Tier.PREVIEW}
    assert {"contact_equilibrium", "mesh_p0", "bore_stress"} <= by_elements
    judged = within_depth(checks)
    assert {c.id for c in judged} == {c.id for c in full} - by_elements
    assert all(c.method.startswith("preview: ") for c in judged)
    assert not any(c.method.startswith("preview: ") for c in full)


@pytest.mark.parametrize("tier", list(Tier)[:-1])
def test_a_check_above_the_depth_is_not_evaluated(tier):
    """It says which depth judges it, and keeps the verdict of the checks from PASS."""
    checks = all_checks(made.solution(tier=tier))
    deeper = [c for c in checks if c.declaration.tier > tier]
    assert deeper and set(checks) - set(deeper) == set(within_depth(checks))
    for check in deeper:
        assert (check.status, check.demand) == ("not_evaluated", None)
        assert check.note == f"judged at the depth {check.judged_at}"
        assert check.judged_at == check.declaration.tier.word
    assert verdict(checks) == "incomplete"
    assert (verdict(within_depth(checks)), screen(checks)) == ("pass", "open")
    assert binding(checks) == ()


def test_a_certified_solution_judges_every_check():
    checks = all_checks(made.solution())
    assert within_depth(checks) == checks
    assert verdict(checks) == "pass"


# --- where -----------------------------------------------------------------------------------


def test_the_worst_load_case_and_angle_are_named():
    hard = made.cycle(load_case="rated", scale=1.1)
    light = made.cycle(load_case="start", scale=0.5)
    solution = made.of_load_cases(made.cycle(), hard, light)
    check = contact_strength.contact_pressure(solution)
    assert (check.load_case, degrees(check)) == ("rated", pytest.approx(90.0))
    assert check.demand == pytest.approx(990e6)
    lightest = jump_and_jamming.contact_force_margin(solution)
    place = pytest.approx(270.0, abs=0.05)  # of the closed forms between the made-up forces
    assert (lightest.load_case, degrees(lightest)) == ("start", place)
    assert torque_balance.torque_reduction(solution).load_case == "rated"


def test_equal_load_cases_name_the_first():
    solution = made.of_load_cases(made.cycle(load_case="one"), made.cycle(load_case="two"))
    assert contact_strength.shakedown(solution).load_case == "one"


def test_a_nan_wins_over_every_number():
    jam = {"a": made.WAVE, "b": np.where(made.THETA == 0.0, np.nan, 9.0), "c": 99.0 * made.WAVE}
    cycles = [cycle_with("loads", made.cycle(load_case=k), jam_index=v) for k, v in jam.items()]
    for extreme in (greatest, least):
        worst = extreme(cycles, lambda cycle: cycle.loads.jam_index)
        assert np.isnan(worst.value)
        assert (worst.load_case, worst.cam_angle) == ("b", 0.0)


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
    solution = made.solution(contour=shape)
    # 360 quintic pieces follow the disc to 1e-9 of the lift; its derivatives less well.
    angle = cam_shape.pressure_angle(solution)
    assert angle.demand == pytest.approx(np.arcsin(eccentricity / radius), rel=1e-6)
    assert cam_shape.curvature_ratio(solution).demand == pytest.approx(
        radius / made.ROLLER, rel=1e-4
    )
    assert cam_shape.undercut(solution).demand == pytest.approx(1 - made.ROLLER / radius, rel=1e-4)
    assert cam_shape.spring_travel(solution).demand == pytest.approx(2.0 * eccentricity, rel=1e-6)
    assert cam_shape.concave_radius(solution) is None


@pytest.mark.parametrize("offset", [0.0, 0.004, -0.004])
def test_pressure_angles_of_both_strokes(offset):
    """On the other stroke s' counts as zero, which the bottom of the lift has in any case."""
    lift = SegmentMotion(
        (Segment("cycloidal", 1.2, 0.01), Segment("cycloidal", 2.0 * np.pi - 1.2, -0.01))
    ).lift()
    pitch, theta = PitchCurve(lift, 0.03, offset), np.linspace(0.0, 2.0 * np.pi, 20001)
    cam = ContourCam.at(RollerContour(pitch, 0.01), Numbers({"cam.offset": offset}), theta, 2)
    slope, angle = lift(theta, 1), np.abs(pitch.pressure_angle(theta))
    rise, back = cam_shape.angle_on_rise(cam).max(), cam_shape.angle_on_return(cam).max()
    assert rise == pytest.approx(angle[slope > 0.0].max(), abs=1e-7)
    assert back == pytest.approx(angle[slope < 0.0].max(), abs=1e-7)
    assert max(rise, back) == pytest.approx(pitch.pressure_angle_max().value, abs=1e-7)


def test_pressure_angle_of_the_stroke_that_governs():
    pitch, theta = made.solution().contour.pitch, np.linspace(0.0, 2.0 * np.pi, 20001)
    slope, angle = pitch.lift(theta, 1), np.abs(pitch.pressure_angle(theta))
    rise, back = angle[slope > 0.0].max(), angle[slope < 0.0].max()
    checked = cam_shape.pressure_angle(with_limits(pressure_angle=0.3, return_pressure_angle=1.5))
    assert (checked.limit, checked.note) == (0.3, "on the rise")
    assert checked.demand == pytest.approx(rise, abs=1e-7)
    checked = cam_shape.pressure_angle(with_limits(pressure_angle=1.5, return_pressure_angle=0.3))
    assert (checked.limit, checked.note) == (0.3, "on the return")
    assert checked.demand == pytest.approx(back, abs=1e-7)
    worst = cam_shape.pressure_angle(with_limits(pressure_angle=0.5, return_pressure_angle=0.5))
    assert worst.demand == pytest.approx(pitch.pressure_angle_max().value, abs=1e-12)


def test_limit_of_thirty_degrees_reads_thirty():
    check = cam_shape.pressure_angle(with_limits(pressure_angle=np.deg2rad(30)))
    assert check.as_record()["limit"] == 30.0


def test_undercut_cam_is_a_verdict():
    cusped = made.solution(contour=made.undercut())
    cut, crossed = cam_shape.undercut(cusped), cam_shape.self_intersection(cusped)
    assert cut.demand < 0
    assert cut.utilisation == np.inf
    assert crossed.demand > 0
    steep = (cam_shape.curvature_ratio(cusped), cam_shape.pressure_angle(cusped))
    for check in (cut, crossed, *steep):
        assert check.status == "fail", check.id


def test_second_contact_counts_depth_only():
    solutions = (with_gap(-2e-6, 1.0), with_gap(np.inf), with_gap(np.nan))
    cut, clear, unknown = (cam_shape.second_contact(solution) for solution in solutions)
    assert [check.status for check in (cut, clear, unknown)] == ["fail", "pass", "not_evaluated"]
    assert cut.as_record()["demand"] == pytest.approx(2e-3)
    assert cut.cam_angle == pytest.approx(1.0)
    assert clear.cam_angle is None


def test_the_wall_is_thinner_by_the_keyway():
    plain = cam_shape.minimum_wall(with_part("cam", keyway=None))
    assert plain.demand == pytest.approx((made.BASE - made.ROLLER) / 0.0085)
    keyed = cam_shape.minimum_wall(made.solution())
    assert keyed.demand == pytest.approx((made.BASE - made.ROLLER) / 0.0108)


# --- forces ----------------------------------------------------------------------------------


def test_jump_is_where_inertia_eats_the_spring():
    # Harmonic lift: least s'' = -stroke/2 at full lift, F_s = P + k stroke there.
    relief = made.MASS * made.CAM_SPEED**2 * 0.5 * made.STROKE
    expected = relief / (made.PRELOAD + made.RATE * made.STROKE)
    check = jump_and_jamming.jump(made.solution())
    assert check.demand == pytest.approx(expected, rel=1e-6)
    assert degrees(check) == pytest.approx(180.0)


def test_a_follower_pressed_on_all_the_turn_cannot_jump():
    check = jump_and_jamming.jump(with_loads(inertia_force=np.full(made.POSITIONS, 5.0)))
    assert (check.demand, check.status) == (0.0, "pass")


def test_contact_lost_is_worse_than_any_number():
    lost = with_loads(normal_force=np.zeros(made.POSITIONS))
    assert jump_and_jamming.contact_force_margin(lost).utilisation == np.inf


def test_the_return_cannot_jam():
    rising = made.cycle().loads.lift_slope > 0
    solution = with_loads(jam_index=np.where(rising, 0.1, 0.9))
    assert jump_and_jamming.jam_index(solution).demand == pytest.approx(0.1)


# --- contact ---------------------------------------------------------------------------------


def test_limits_are_the_least_of_both_bodies():
    solution = made.solution()
    # 4 Y / sqrt(3) = 2.309 Y for Y = 600 MPa.
    shakedown = contact_strength.shakedown(solution).as_record()
    assert shakedown["limit"] == pytest.approx(1385.64, abs=0.01)
    assert contact_strength.first_yield(solution).limit == 600e6
    assert contact_strength.contact_pressure(solution).limit == 1200e6
    weak = with_material("hard", endurance_pressure=1000e6, yield_strength=590e6)
    assert contact_strength.contact_pressure(weak).limit == 1000e6
    assert contact_strength.first_yield(weak).limit == 590e6


def test_structural_steel_shakes_down_to_about_820_mpa():
    # Published order for S355: shakes down to about 0.82 GPa (Johnson 1985, 4 k).
    soft = with_material("steel", yield_strength=355e6)
    assert contact_strength.shakedown(soft).limit == pytest.approx(820e6, rel=0.005)


def test_first_yield_does_not_decide():
    assert not contact_strength.first_yield(made.solution()).must_have


# --- roller ----------------------------------------------------------------------------------


def test_static_safety_by_hand():
    check = roller_bearing.roller_static(made.solution())
    assert check.demand == pytest.approx(600.0 / 400.0)
    assert degrees(check) == pytest.approx(90.0)


def test_an_unrated_bearing_is_not_evaluated_and_fails():
    plain = with_bearing(name="plain", C=None, C0=None, radial_limit=None, speed_limit=None)
    checks = all_checks(plain)
    missing = {"roller_static", "roller_speed", "roller_life", "roller_radial"}
    missing |= {"roller_modified_life", "roller_load_share", "data_roller_bearing"}
    assert set(binding(checks)) == missing
    lacks = {c.id: c.missing for c in checks}
    assert lacks["roller_static"] == ("roller.bearing.C0",)
    assert lacks["roller_speed"] == ("roller.bearing.speed_limit",)
    assert lacks["roller_life"] == ("roller.bearing.C",)


def test_rating_life_of_a_constant_load_on_a_ring():
    # Constant load and speed: L10 = (C/P)^3 1e6 / n, n = w (R - r) / r.
    steady = cycle_with("loads", made.cycle(made.ring()), normal_force=np.full(72, 570.0))
    solution = made.solution(contour=made.ring(), cycles=(steady,))
    spin = made.CAM_SPEED * (made.BASE - made.ROLLER) / made.ROLLER
    life, speed = roller_bearing.roller_life(solution), roller_bearing.roller_speed(solution)
    hours = 8e6 / (spin / (2.0 * np.pi)) / 3600.0
    assert life.as_record()["demand"] == pytest.approx(hours, rel=ROUND_OFF)
    assert speed.as_record()["demand"] == pytest.approx(spin * 30.0 / np.pi, rel=ROUND_OFF)


def test_a_required_life_is_a_must():
    check = roller_bearing.roller_life(with_limits(roller_life=3600.0 * 1000.0))
    assert check.must_have
    assert check.as_record()["limit"] == pytest.approx(1000.0)
    assert check.status == "fail"


def test_a_roller_under_a_cam_at_rest_outlives_every_life_that_a_case_may_require():
    """The cam creeps: as many turns at a speed of nearly zero. A case may require 1e6 hours."""
    running = roller_bearing.roller_life(made.solution())
    resting = roller_bearing.roller_life(with_speed(0.0))
    # at rest without the surge, which takes 0.1 % of the life
    turns = 2.0 * made.CAM_SPEED / CREEP
    assert resting.demand == pytest.approx(running.demand * turns, rel=2e-3)
    assert resting.as_record()["demand"] > 1e6


# --- guides ----------------------------------------------------------------------------------


def test_guide_pressure_by_hand():
    # 500 N on 10 x 20 mm.
    assert guides.guide_pressure_a(made.solution()).demand == pytest.approx(2.5e6)
    assert guides.guide_pressure_b(made.solution()).demand == pytest.approx(1.0e6)


def test_guide_pv_by_hand():
    # |R v| = 500 N x 0.4 m/s x sin^2, mean one half, on 200 mm^2: 0.5 MPa m/s.
    check = guides.guide_pv_a(made.solution())
    assert check.demand == pytest.approx(0.5e6, rel=1e-6)
    assert check.cam_angle is None
    assert guides.guide_pv_b(made.solution()).demand == pytest.approx(0.2e6, rel=1e-6)


def test_guide_pv_takes_the_size_of_what_slides_either_way():
    check = guides.guide_pv_a(with_guides(rubbing_load_a=np.full(made.POSITIONS, 500.0)))
    # Mean |sin| over 72 equal steps; 2/pi for many. The signed mean would vanish.
    mean = np.abs(np.sin(made.THETA)).mean()
    demand = check.as_record()["demand"]
    assert demand == pytest.approx(500.0 * 0.4 * mean / 200.0, rel=1e-6)


# --- function --------------------------------------------------------------------------------


def test_torque_reduction_by_hand():
    solution = made.solution(cycles=(made.cycle(scale=0.6),))  # std 10 to 3
    assert torque_balance.torque_reduction(solution).demand == pytest.approx(0.7)


def test_each_load_case_has_its_own_torque_reduction():
    """0.7 of 0.5 leaves 0.6 of the ripple allowed, 0.2 of 0.1 leaves 8/9 of it."""
    cycles = (made.cycle(scale=0.6), made.cycle(load_case="rated", scale=1.6))

    def judged(**rated):
        states = (
            made.load_case("idle", torque_reduction=0.5),
            made.load_case("rated", ripple_weight=0.0, **rated),
        )
        case = made.case(load_cases=states)
        return torque_balance.torque_reduction(made.solution(case=case, cycles=cycles))

    check = judged(torque_reduction=0.1)
    assert (check.status, check.load_case, check.limit) == ("pass", "rated", 0.5)
    assert check.demand == pytest.approx(1.0 - 0.5 * 8.0 / 9.0)
    assert "0.2 in rated, where 0.1 is required" in check.note
    assert judged(torque_reduction=0.199).status == "pass"
    assert judged(torque_reduction=0.201).status == "fail"
    # a weight of zero alone, and a requirement of zero beside a weight, require nothing
    assert (judged().load_case, judged().demand) == ("idle", pytest.approx(0.7))
    free = made.case(load_cases=(made.load_case("idle", torque_reduction=0.0),))
    assert torque_balance.torque_reduction(made.solution(case=free)) is None


def test_each_load_case_has_its_own_speed_reduction():
    """0.75 of 0.5 leaves 0.5 of the ripple allowed, 0.25 of 0.1 leaves 5/6 of it."""
    states = (
        made.load_case("idle", speed_reduction=0.5),
        made.load_case("rated", ripple_weight=0.0, speed_reduction=0.1),
    )
    ripple = {"idle": (4.0, 1.0), "rated": (2.0, 1.5)}
    halved = {"idle": (4.0, 1.0), "rated": (2.0, 1.4)}
    check = torque_balance.speed_reduction(
        made.solution(
            case=made.case(load_cases=states), crank_speed=ripple, crank_speed_halved=halved
        )
    )
    demand = 1.0 - 0.5 * 0.75 / 0.9
    assert (check.load_case, check.limit) == ("rated", 0.5)
    assert check.demand == pytest.approx(demand)
    assert check.error_share == pytest.approx(0.5 * 0.05 / 0.9 / demand)


def test_speed_reduction_by_hand():
    """The load case with the least, of those whose ripple counts; a NaN is the least of all."""
    ripple = {"idle": (4.0, 1.0), "rated": (2.0, 1.5), "fast": (1.0, 2.0)}
    fast = made.load_case("fast", ripple_weight=0.0)
    states = (made.load_case("idle"), made.load_case("rated"), fast)
    check = torque_balance.speed_reduction(
        made.solution(case=made.case(load_cases=states), crank_speed=ripple)
    )
    assert (check.demand, check.load_case) == (pytest.approx(0.25), "rated")
    stalled = made.solution(crank_speed=ripple | {"idle": (np.nan, np.nan)})
    assert torque_balance.speed_reduction(stalled).status == "not_evaluated"
    assert torque_balance.speed_reduction(made.solution(crank_speed={})) is None
    assert not torque_balance.speed_reduction(with_limits(speed_reduction=None)).must_have


def test_a_cam_that_adds_ripple_has_a_negative_reduction():
    check = torque_balance.torque_reduction(made.solution(cycles=(made.cycle(scale=3.0),)))
    assert check.demand == pytest.approx(-0.5)
    assert check.utilisation == np.inf
    assert check.status == "fail"


def test_an_engine_without_ripple_leaves_the_reduction_unknown():
    check = torque_balance.torque_reduction(with_cycle(torque_before=np.zeros(made.POSITIONS)))
    assert check.status == "not_evaluated"


def test_a_ring_takes_no_ripple_away_and_owes_no_energy():
    plain = made.cycle(made.ring())
    round_cam = made.changed_cycle(plain, torque_after=plain.turn.torque_before)
    solution = made.solution(contour=made.ring(), cycles=(round_cam,))
    assert torque_balance.torque_reduction(solution).status == "fail"
    assert torque_balance.contact_torque(solution).demand < 1e-9
    assert torque_balance.contact_work(solution).demand < 1e-9
    assert torque_balance.friction_balance(solution).demand == 0.0


def test_without_an_engine_there_is_no_torque_check():
    checks = all_checks(with_cycle(torque_before=None, torque_after=None))
    assert "torque_reduction" not in {check.id for check in checks}
    assert verdict(checks) == "pass"


def test_friction_with_the_wrong_sign_on_the_return_is_seen():
    loads = made.cycle().loads
    pushed = (loads.spring_force + loads.inertia_force + 20.0) * loads.lift_slope
    check = torque_balance.friction_balance(with_loads(cam_torque=pushed))
    assert check.demand == pytest.approx(1.0, rel=1e-6)  # no loss at all where heat is made
    assert check.status == "fail"


# --- verification ----------------------------------------------------------------------------


@pytest.mark.parametrize("tier", [Tier.CYCLE, Tier.CERTIFIED])
def test_without_certificate_or_mesh_nothing_is_claimed(tier):
    """A trial of a search may go without; an answer without them does not pass."""
    final = tier is Tier.CERTIFIED
    bare = made.solution(certificate=(), mesh=None, benchmarks=None, tier=tier)
    checks = {c.id: c for c in all_checks(bare)}
    for name in ("certificate_spread", "certificate_gci", "mesh_angle", "mesh_edges", "mesh_p0"):
        assert checks[name].status == "not_evaluated"
        assert checks[name].must_have is (final or checks[name].judged_at == "certified")
        assert ("this trial has no" if checks[name].judged_at == "" else "judged at") in (
            checks[name].note
        )
    assert verdict(within_depth(checks.values())) == ("incomplete" if final else "pass")


def test_the_worst_certified_angle_is_named():
    check = solution_verification.certificate_spread(made.solution())
    assert check.as_record()["demand"] == pytest.approx(0.4)  # its size, whatever its sign
    assert check.cam_angle == pytest.approx(1.5)
    assert check.must_have
    gci = solution_verification.certificate_gci(made.solution())
    assert gci.cam_angle == pytest.approx(0.5)


def test_hertz_difference_skips_angles_without_load():
    contact = made.cycle().contact
    hertz, p0 = np.array(contact.p0_hertz), np.array(contact.p0)
    hertz[:3] = p0[:3] = 0.0
    check = solution_verification.hertz_difference(with_contact(p0=p0, p0_hertz=hertz))
    assert check.as_record()["demand"] == pytest.approx(1.0)


# --- waivers and sources ---------------------------------------------------------------------


def test_a_waiver_is_applied_and_says_who_why_and_when():
    travel = made.changed(made.case().spring, travel_max=0.005)
    plain = made.solution(case=made.case(spring=travel))
    assert binding(all_checks(plain)) == ("spring_travel",)

    def checked(up_to: str) -> dict[str, Check]:
        waivers = (waiver("spring_travel", up_to),)
        waived = made.solution(case=made.case(spring=travel, waivers=waivers))
        return {c.id: c for c in all_checks(waived)}

    checks = checked("11 mm")
    assert checks["spring_travel"].status == "waived"
    assert checks["spring_travel"].waiver == Waived("A. Engineer, 2025-01-02: proven", 0.011)
    assert verdict(checks.values()) == "pass"
    assert verdict(checked("9 mm").values()) == "fail"  # the lift is 10 mm
    with pytest.raises(InputError, match=r"waivers\.spring_travel\.up_to = 11, .* unit"):
        checked("11")


@pytest.mark.parametrize("name", ["contact_equilibrium", "contact_torque", "benchmark_hertz"])
def test_a_wrong_number_cannot_be_waived(name):
    """A person may accept a risk, not a wrong number."""
    wrong = cycle_with("contact", residual_equilibrium=np.full(made.POSITIONS, 1e-3))
    solution = made.solution(case=made.case(waivers=(waiver(name),)), cycles=(wrong,))
    checks = {c.id: c for c in all_checks(solution)}
    assert checks[name].waiver is None
    assert checks["contact_equilibrium"].status == "fail"
    assert checks["waivers_without_effect"].note == name


def test_the_case_s_own_source_is_printed():
    solution = with_limits(sources={"pressure_angle": "house rule 7"})
    assert cam_shape.pressure_angle(solution).source == "house rule 7"


def test_a_solution_is_frozen():
    with pytest.raises(AttributeError):
        made.solution().case = None


# --- rolling ---------------------------------------------------------------------------------


def check_of(name, solution):
    return next(c for c in all_checks(solution) if c.id == name)


def only_at_one_angle(value):
    return np.where(np.arange(made.POSITIONS) == 5, value, np.nan)


def test_traction_is_limited_to_friction_and_its_reserve_to_half_of_it():
    grip, reserve = (
        check_of(name, made.solution()) for name in ("traction_demand", "traction_reserve")
    )
    assert grip.demand == reserve.demand == pytest.approx(by_hand.traction(), rel=5e-4)
    assert (grip.limit, reserve.limit) == pytest.approx((0.1, 0.05))
    assert grip.must_have
    assert not reserve.must_have


def test_traction_counts_where_the_roller_is_loaded():
    force, rising = made.cycle().loads.normal_force, np.pi > made.THETA
    demands = [
        surface_durability.traction_demand(with_loads(normal_force=each)).demand
        for each in (force, np.where(rising, force, 0.0), np.where(rising, 0.0, force))
    ]
    assert 0.0 < min(demands) < max(demands) == demands[0]


def test_film_counts_where_the_roller_is_loaded():
    film = replace(made.cycle().rolling.film, ratio=only_at_one_angle(1.3))
    assert check_of("film_ratio", with_rolling(film=film)).demand == 1.3


def test_fatigue_takes_the_greatest_of_the_map():
    check = check_of("surface_fatigue", made.solution())
    assert (check.demand, check.limit) == pytest.approx((200e6, 300e6))


def test_case_is_used_most_where_strength_falls_faster_than_stress():
    """Half way down the case the yield strength is half way from 600 to 400 MPa."""
    assert check_of("hardened_case", made.solution()).demand == pytest.approx(400 / 500)


@pytest.mark.parametrize("name", ["film_ratio", "surface_fatigue", "hardened_case"])
def test_without_the_rolling_of_a_cycle_nothing_is_evaluated(name):
    """As of a contour that is no body."""
    check = check_of(name, with_cycle(rolling=NO_ROLLING))
    assert check.status == "not_evaluated"
    assert check.blocks is (name == "hardened_case")


@pytest.mark.parametrize(
    ("name", "section", "field"),
    [
        ("traction_demand", "roller", "friction"),
        ("film_ratio", "roller", "roughness"),
        ("film_ratio", "cam", "roughness"),
    ],
)
def test_a_missing_input_of_rolling_is_named(name, section, field):
    check = check_of(name, with_part(section, **{field: None}))
    assert check.note == f"missing: {section}.{field}"


def test_a_missing_lubricant_is_named():
    assert check_of("film_ratio", with_case(lubricant=None)).note == "missing: lubricant"


@pytest.mark.parametrize("field", ["fatigue_torsion", "fatigue_bending", "case_depth"])
def test_a_missing_strength_of_the_card_is_named(field):
    name = "surface_fatigue" if field.startswith("fatigue") else "hardened_case"
    check = check_of(name, with_material("steel", **{field: None}))
    assert check.status == "not_evaluated"
    assert f"materials.steel.{field}" in check.missing
