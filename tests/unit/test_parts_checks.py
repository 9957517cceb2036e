"""Checks of the parts around the cam, on the template's case and on one that names every part."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.tables import table
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.template import template
from camwright.pipeline.checks import camshaft_strength as shaft_checks
from camwright.pipeline.checks import part_strength as part_checks
from camwright.pipeline.checks import spring_strength as spring_checks
from camwright.pipeline.checks.cam_shape import acceleration_step
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import PARTS, all_checks
from camwright.pipeline.checks.torque_balance import friction_balance
from camwright.pipeline.contact.contact_pair import closed_form_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.cycle import closed_form_cycle, finished
from camwright.pipeline.cycle.turn import turn
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.guide_reactions import GuidePair, guide_reactions
from camwright.pipeline.follower.stem_beam import Stem
from camwright.pipeline.results import run_reader

SPRING = """
[spring.design]
wire_diameter = "6 mm"
mean_diameter = "40 mm"
coils = 8.2
free_length = "130 mm"
shear_modulus = "77.2 GPa"
density = "7850 kg/m^3"
strength_at_1mm = "1974 MPa"
strength_exponent = 0.108
treatment = "peened"
"""
PIN = """
[roller.pin]
diameter = "5 mm"
span = "16 mm"
material = "{material}"
"""
KEYWAY = """
[cam.keyway]
width = "6 mm"
depth = "2.8 mm"
"""
SHAFT = """
[camshaft]
bearing_spacing = "60 mm"
cam_position = "20 mm"
gear_position = "-15 mm"
gear_radius = "20 mm"
"""


def text(extra=""):
    return template("parts") + extra


def full_case():
    given = parse_case(template("parts"))
    return parse_case(text(SPRING + PIN.format(material=given.roller.material) + KEYWAY + SHAFT))


def evidence(case, look_ahead=False):
    """A harmonic lift of 20 mm on the template's machine."""
    theta = uniform_turn(case.solver.positions)
    lift = Lift(theta, 0.01 * (1 - np.cos(theta)))
    contour = RollerContour(PitchCurve(lift, case.cam.pitch_base_radius), case.roller.radius)
    cycles = []
    for state in case.load_cases:
        given = turn(case, contour, None, state.name, 72)
        pair = contact_pair(case, contour)
        contact = closed_form_history(pair, given.theta, given.loads.normal_force)
        done = finished(case, contour, given, contact)
        cycles.append(closed_form_cycle(case, contour, given) if look_ahead else done)
    return TrialEvidence(case, contour, tuple(cycles))


@pytest.fixture(scope="module")
def full():
    return evidence(full_case())


@pytest.fixture(scope="module")
def bare():
    return evidence(parse_case(template("parts")))


def found(given):
    return {c.id: c for c in (function(given) for function in PARTS) if c is not None}


def test_every_part_described_is_evaluated(full):
    checks = found(full)
    open_ones = {name for name, check in checks.items() if not check.evaluated}
    # no friction bounds, heat path, balance grade or bearing card in the case
    assert open_ones <= {
        "jam_at_worst_friction",
        "bush_temperature_A",
        "bush_temperature_B",
        "cam_unbalance",
        "roller_ring",
    }
    assert all(check.source and check.method for check in checks.values())


def test_a_must_have_that_is_not_described_is_not_evaluated_and_blocks(bare):
    checks = found(bare)
    must = {"spring_stress", "spring_fatigue", "spring_solid", "spring_buckling", "roller_pin"}
    for name in (*must, "jam_at_worst_friction", "key_pressure", "roller_ring", "spring_surge"):
        assert checks[name].status == "not_evaluated"
        assert checks[name].blocks is (name in must | {"jam_at_worst_friction"})
        assert checks[name].note


def test_a_look_ahead_leaves_the_parts_out():
    given = evidence(parse_case(template("parts")), look_ahead=True)
    assert found(given) == {}


def test_all_checks_contain_the_parts(bare):
    assert {check.id for check in all_checks(bare)} >= set(found(bare))


def test_spring_by_hand(full):
    case, checks = full.case, found(full)
    d, D, n = 6e-3, 40e-3, 8.2
    rate = 77.2e9 * d**4 / (8 * D**3 * n)
    top = case.spring.preload + rate * (1 + case.spring.rate_tolerance) * 0.02
    C = D / d
    wahl = (4 * C - 1) / (4 * C - 4) + 0.615 / C
    stress = wahl * 8 * top * D / (np.pi * d**3)
    strength = 0.56 * 1974e6 * 6**-0.108
    assert checks["spring_stress"].demand == pytest.approx(stress / strength, rel=1e-9)
    deflection = case.spring.preload / rate + 0.02
    room = 0.13 - d * (n + 2) - deflection
    assert checks["spring_solid"].demand == pytest.approx(room / deflection, rel=1e-9)
    assert checks["spring_solid"].must_have


def test_a_spring_that_goes_solid_fails(full):
    short = full.case.spring.design.model_copy(update={"free_length": 70e-3})
    spring = full.case.spring.model_copy(update={"design": short})
    given = replace(full, case=full.case.model_copy(update={"spring": spring}))
    check = spring_checks.spring_solid(given)
    assert check.demand < 0.0
    assert check.status == "fail"
    assert check.blocks


def test_pin_and_key_by_hand(full):
    checks, case = found(full), full.case
    force = max(c.loads.normal_force.max() for c in full.cycles)
    arm = 16e-3 / 4 - case.roller.width / 8
    assert checks["roller_pin"].demand == pytest.approx(
        1e-6 * 32 * force * arm / (np.pi * 5e-3**3), rel=1e-9
    )
    assert checks["roller_pin"].must_have
    torque = max(np.abs(c.loads.cam_torque).max() for c in full.cycles)
    area = 2 * case.cam.bore_radius * 2 * 2.8e-3 * case.cam.width
    assert checks["key_pressure"].demand == pytest.approx(4e-6 * torque / area, rel=1e-9)


def test_a_pin_span_inside_the_bearing_is_refused():
    pin = PIN.format(material="hardened_steel").replace("16 mm", "9 mm")
    with pytest.raises(InputError, match=r"roller\.pin\.span"):
        parse_case(text(pin))


def test_harmonic_cam_reverses_twice(full):
    check = part_checks.torque_reversals(full)
    assert check.demand == 2.0
    assert check.status == "fail"
    assert not check.must_have
    assert "N m/rad" in check.note


def test_worst_friction_is_a_must_where_it_is_bounded(bare):
    guides = bare.case.guides
    rough = {side: getattr(guides, side).model_copy(update={"friction_max": 0.25}) for side in "ab"}
    case = bare.case.model_copy(update={"guides": guides.model_copy(update=rough)})
    given = evidence(case)
    check, worst = part_checks.jam_at_worst_friction(given), given.cycles[0].parts.friction.greatest
    bearing = guide_reactions(
        worst.tangential_force, worst.overhang, Stem.from_case(case), GuidePair.from_case(case)
    )
    rubs = 0.25 * (bearing.rubbing_load_a + bearing.rubbing_load_b)
    rise = worst.lift_slope > 0
    assert check.demand == pytest.approx((rubs / worst.axial_force)[rise].max(), rel=1e-9)
    factor = 0.25 * (1 + 2 * worst.overhang / guides.spacing)
    on_points = factor * np.abs(np.tan(worst.pressure_angle))
    np.testing.assert_allclose(worst.jam_index_statics, on_points, rtol=1e-9, atol=1e-12)
    assert check.must_have


def test_temperature_with_a_heat_path(bare):
    case = bare.case
    guide = case.guides.a.model_copy(update={"thermal_resistance": 2.0})
    material = case.materials[guide.material].model_copy(update={"temperature_limit": 353.15})
    hot = case.model_copy(
        update={
            "guides": case.guides.model_copy(update={"a": guide}),
            "materials": case.materials | {guide.material: material},
        }
    )
    given = evidence(hot)
    check = part_checks.bush_temperature_a(given)
    power = max(c.parts.heat_a.mean_power for c in given.cycles)
    assert check.demand == pytest.approx(20.0 + 2.0 * power, rel=1e-9)
    assert check.limit == pytest.approx(80.0)


def test_columns_of_all_parts(full):
    columns = full.cycles[0].columns(2.0)
    for name in ("bush_peak_A", "spring_stress", "pin_stress", "shaft_bearing_2", "key_pressure"):
        assert np.isfinite(columns[name]).all()
    force = full.cycles[0].loads.normal_force
    np.testing.assert_allclose(columns["bore_pressure"], force / (2 * 10e-3 * 10e-3), rtol=1e-12)
    # the wall of a bush spreads nothing: its peak is above the projected pressure
    guides = full.cycles[0].guides
    loaded = guides.pressure_max_a > 0
    assert (columns["bush_peak_A"][loaded] > guides.pressure_max_a[loaded]).all()


def test_a_card_fills_in_what_the_case_leaves_out():
    rows = template("parts").splitlines()
    start = next(k for k, row in enumerate(rows) if row.startswith("[roller.bearing]"))
    end = next(k for k in range(start + 1, len(rows)) if rows[k].startswith("["))
    head, tail = "\n".join(rows[:start]), "\n".join(rows[end:])

    def case(*lines):
        return parse_case("\n".join([head, "[roller.bearing]", *lines, tail]))

    bearing = case('card = "maker_2_625"', 'C0 = "0.5 kN"').roller.bearing
    assert (bearing.C, bearing.C0) == (1730.0, 500.0)
    assert "verify" in bearing.source
    again = parse_case(case('card = "maker_2_625"').to_toml())
    assert again.roller.bearing.C0 == 670.0
    with pytest.raises(InputError, match="maker_2_625"):
        case('card = "nobody"')


def test_friction_that_the_guides_do_not_have_is_found_out(bare):
    """Loads with the friction of point supports do not close with the heat in the bores."""
    assert friction_balance(bare).demand <= 1e-9
    cycle = bare.cycles[0]
    system = FollowerSystem.from_case(bare.case)
    speed, theta = bare.cam_speed(cycle), cycle.theta
    loads = follower_loads(bare.contour.pitch, system, speed, theta)
    wrong = replace(bare, cycles=(replace(cycle, loads=loads),))
    assert friction_balance(wrong).status == "fail"
    assert friction_balance(wrong).demand > 0.01


def test_columns_of_a_turn_close(bare):
    """What one row says of friction, force, heat and shares adds up: 1e-9 of the greatest."""
    cycle, guides = bare.cycles[0], bare.case.guides
    found = table(run_reader.CYCLE, cycle.columns(bare.case.mechanism.gear_ratio))
    v, rubs = found["velocity_m_per_s"], found["friction_A_N"] + found["friction_B_N"]

    def same(one, other):
        np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(other).max())

    pressed = found["spring_force_N"] + found["inertia_force_N"] + found["viscous_force_N"]
    same(pressed + np.sign(v) * rubs, found["axial_force_N"])
    for side, guide in (("A", guides.a), ("B", guides.b)):
        same(guide.friction * found[f"rubbing_load_{side}_N"], found[f"friction_{side}_N"])
        same(found[f"friction_{side}_N"] * np.abs(v), found[f"friction_heat_{side}_W"])
        changed = found["reaction_by_length_N"] + found["reaction_by_clearance_N"]
        same(found[f"reaction_{side}_statics_N"] + changed, found[f"reaction_{side}_N"])
    changed = found["normal_force_by_length_N"] + found["normal_force_by_clearance_N"]
    same(found["normal_force_statics_N"] + changed, found["normal_force_N"])
    heat = (found["friction_heat_A_W"] + found["friction_heat_B_W"]).mean()
    assert np.mean(found["cam_torque_Nm"]) * bare.cam_speed(cycle) == pytest.approx(heat, rel=1e-9)
    assert found["residual_friction"].max() <= 1e-10
    same(np.radians(found["stem_slope_A_deg"]), cycle.guides.slope_a)


def test_overspeed_jumps_and_lands(bare):
    """Fast enough to leave the cam: the check fails and names the losses of contact."""
    state = bare.case.load_cases[0].model_copy(update={"speed": 2000.0})
    given = evidence(bare.case.model_copy(update={"load_cases": (state,)}))
    elastic = given.cycles[0].parts.elastic
    assert elastic.response.lost
    assert elastic.flights
    assert elastic.force_max > given.cycles[0].loads.spring_force.max()
    check = part_checks.elastic_contact(given)
    assert check.status == "fail"
    assert f"{len(elastic.flights)} losses of contact" in check.note
    highest = max(elastic.flights, key=lambda flight: flight.height)
    assert f"jumps at {np.degrees(highest.jump) % 360:.1f} deg" in check.note
    assert f"{highest.landing_speed:.3g} m/s" in check.note


def test_ring_of_a_card():
    """The stress grows with the load; of Goodman's line, fatigue and tensile strength are asked."""
    bearing = "[roller.bearing]                     # ratings"
    named = template("ring").replace(bearing, '[roller.bearing]\ncard = "maker_1_625_2RS"\n#')
    open_ring = part_checks.roller_ring(evidence(parse_case(named)))
    assert open_ring.status == "not_evaluated"
    assert "not the bearing's outer ring itself" in open_ring.note
    small = named.replace('radius = "16 mm"', 'radius = "8 mm"', 1).replace(
        'hub_radius = "8 mm"', 'hub_radius = "4.2 mm"', 1
    )
    given = evidence(parse_case(small))
    cycle = given.cycles[0]
    ratio = cycle.parts.ring_amplitude / cycle.loads.normal_force
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-12)
    assert (cycle.parts.ring_correction < 0.0).all()
    force = max(c.loads.normal_force.max() for c in given.cycles)
    mean = cycle.parts.ring_mean[0] / cycle.loads.normal_force[0]
    check = part_checks.roller_ring(given)
    assert check.limit == pytest.approx(700.0)
    left = 1.0 - mean * force / 2000e6
    assert check.demand == pytest.approx(1e-6 * ratio[0] * force / left, rel=1e-9)
    assert "verify" in check.source
    ring = given.case.roller.bearing.ring.model_copy(update={"fatigue_bending": None})
    bearing = given.case.roller.bearing.model_copy(update={"ring": ring})
    roller = given.case.roller.model_copy(update={"bearing": bearing})
    unknown = replace(given, case=given.case.model_copy(update={"roller_given": roller}))
    check = part_checks.roller_ring(unknown)
    assert check.status == "not_evaluated"
    assert check.note == "no fatigue strength of the ring is given"


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('diameter = "0 mm"', r"camshaft\.diameter"),
        ("diameter = 17", r"camshaft\.diameter"),
        ('material = "gold"', r"camshaft\.material"),
        ("notch_bending = 0.5", r"camshaft\.notch_bending"),
        ('bearing_rating = "-1 N"', r"camshaft\.bearing_rating"),
        ("[camshaft.gear]\nteeth = 4", r"camshaft\.gear\.teeth"),
        ("[camshaft.gear]\nteeth = 40.5", r"camshaft\.gear\.teeth"),
        ("[camshaft.gear]\nteeth = 40\npinion_teeth = 20\nwidth = '8 mm'\nmaterial = 'x'",
         r"camshaft\.gear\.material"),
    ],
)  # fmt: skip
def test_a_shaft_that_cannot_be_is_refused(line, field):
    with pytest.raises(InputError, match=field):
        parse_case(text(SHAFT + line + "\n"))


@pytest.mark.parametrize(
    ("table", "line", "field"),
    [
        ("[roller.bearing]", "viscosity = 20", r"roller\.bearing\.viscosity"),
        ("[roller.bearing]", 'viscosity = "0 mm^2/s"', r"roller\.bearing\.viscosity"),
        ("[roller.bearing]", 'pitch_diameter = "-1 mm"', r"roller\.bearing\.pitch_diameter"),
        ("[guides.a]", 'wear_rate = "1 mm/N"', r"guides\.a\.wear_rate"),
        ("[guides.b]", 'wear_rate = "-1 mm^3/N/m"', r"guides\.b\.wear_rate"),
        ("[materials.bronze]", "expansion = 1e-5", r"materials\.bronze\.expansion"),
        ("[materials.bronze]", "swelling = 1.0", r"materials\.bronze\.swelling"),
        ("[limits]", "acceleration_step = 0.0", r"limits\.acceleration_step"),
    ],
)
def test_data_of_running_that_cannot_be_are_refused(table, line, field):
    with pytest.raises(InputError, match=field):
        parse_case(text().replace(f"{table}\n", f"{table}\n{line}\n").replace(
            f"{table} ", f"{table}\n{line}\n# "))  # fmt: skip


def test_a_lift_with_a_step_of_acceleration_fails():
    """A parabola changes from one acceleration to its opposite at once, a sine does not."""
    theta = uniform_turn(720)
    turn = theta / (2.0 * np.pi)
    tent = np.where(turn < 0.5, turn, 1.0 - turn) * 2.0
    parabola = np.where(tent < 0.5, 2.0 * tent**2, 1.0 - 2.0 * (1.0 - tent) ** 2)
    for values, status in ((parabola, "fail"), (0.5 * (1 - np.cos(theta)), "pass")):
        contour = RollerContour(PitchCurve(Lift(theta, 0.01 * values), 0.05), 0.008)
        found = acceleration_step(TrialEvidence(full_case(), contour, ()))
        assert found.status == status
        assert found.must_have


def test_a_shaft_with_its_gear_is_judged():
    """Of every load case; the teeth of 20 and 40 with the torque of the cam."""
    given = parse_case(template("parts"))
    more = f"""diameter = "20 mm"
material = "{given.cam.material}"
bearing_rating = "9.95 kN"

[camshaft.gear]
teeth = 40
pinion_teeth = 20
width = "12 mm"
material = "{given.cam.material}"
bending_limit = "300 MPa"
contact_limit = "1200 MPa"
source = "made up"
"""
    trial = evidence(parse_case(text(KEYWAY + SHAFT + more)))
    checks = {f(trial).id: f(trial) for f in shaft_checks.CHECKS}
    assert set(checks) == {
        *("key_shear", "shaft_fatigue", "shaft_bearing_life", "gear_bending", "gear_contact")
    }
    # Neither strength nor a target life is given: open, and the note says so.
    assert checks["shaft_fatigue"].status == "not_evaluated"
    assert "fatigue or tensile" in checks["shaft_fatigue"].note
    assert checks["shaft_bearing_life"].demand > 0
    ratio = checks["gear_bending"].demand / checks["key_shear"].demand
    assert ratio > 0
    assert checks["gear_contact"].unit == "MPa"


def test_guides_that_overlap_are_refused():
    """Two of 24 mm, 24 mm apart in the middle, would touch."""
    with pytest.raises(InputError, match=r"guides\.spacing"):
        parse_case(template("parts").replace('spacing = "80 mm"', 'spacing = "24 mm"'))


@pytest.mark.parametrize("name", ["friction_min", "friction_max"])
def test_friction_bounds_out_of_order_are_refused(name):
    lines = template("parts").replace("friction = 0.04", f"friction = 0.04\n{name} = PUT", 1)
    value = {"friction_min": "0.05", "friction_max": "0.03"}[name]
    with pytest.raises(InputError, match="friction"):
        parse_case(lines.replace("PUT", value))
