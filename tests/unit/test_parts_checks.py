"""Checks of the parts around the cam, on the template's case and on one that names every part."""

import re
from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
from small_machine import small_machine
from small_run import named

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.tables import table
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import (
    camshaft_strength,
    gas_spring,
    guide_strength,
    guide_wear,
    jump_and_jamming,
    key_strength,
    part_strength,
    shaped_springs,
    spring_strength,
)
from camwright.pipeline.checks.cam_shape import acceleration_step
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import all_checks, checks_of
from camwright.pipeline.checks.torque_balance import friction_balance
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.follower.follower_forces import follower_loads
from camwright.pipeline.follower.guide_reactions import guide_reactions

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
temperature = "60 degC"
relaxation = 0.01
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

[cam.key]
length = "20 mm"
material = "hardened_steel"
"""
SHAFT = """
[camshaft]
bearing_spacing = "60 mm"
cam_position = "20 mm"
gear_position = "-15 mm"
gear_radius = "20 mm"
"""


def text(extra=""):
    return small_machine("parts") + extra


def declared_in(module):
    return [each for each in vars(module).values() if isinstance(each, Declaration)]


PARTS = (
    jump_and_jamming.jam_index_friction_max,
    jump_and_jamming.elastic_contact,
    guide_strength.guide_edge_pressure_a,
    guide_strength.guide_edge_pressure_b,
    guide_strength.guide_temperature_a,
    guide_strength.guide_temperature_b,
    *declared_in(part_strength),
    *declared_in(key_strength),
    *declared_in(spring_strength),
    *declared_in(gas_spring),
    *declared_in(shaped_springs),
    *declared_in(guide_wear),
)


def full_case():
    plain = parse_case(small_machine("parts"))
    pin = PIN.format(material=plain.roller.material.name)
    return parse_case(text(SPRING + pin + KEYWAY + SHAFT))


def harmonic(case, tier=Tier.CYCLE):
    """A harmonic lift of 20 mm on the template's machine; the contact is that of half-planes."""
    theta = uniform_turn(case.solver.positions)
    contour = case.contour(Lift(theta, 0.01 * (1 - np.cos(theta))))
    preview = solution(case, contour, Tier.PREVIEW, torques={}, positions=72)
    cycles = tuple(
        replace(cycle, contact=replace(cycle.contact, tier=tier)) for cycle in preview.cycles
    )
    return replace(preview, tier=tier, cycles=cycles)


@pytest.fixture(scope="module")
def full():
    return harmonic(full_case())


@pytest.fixture(scope="module")
def bare():
    return harmonic(parse_case(small_machine("parts")))


def parts_checks(solved):
    return {check.id: check for check in checks_of(solved, PARTS)}


def test_every_part_described_is_evaluated(full):
    checks = parts_checks(full)
    open_ones = {name for name, check in checks.items() if not check.evaluated}
    # no heat path, bearing card, fork, fatigue strength, material or fit of the shaft in the case
    assert open_ones <= {
        "jam_index_friction_max",
        *("guide_temperature_A", "guide_expansion_A", "guide_wear_A"),
        *("guide_temperature_B", "guide_expansion_B", "guide_wear_B"),
        *("bore_pressure", "key_pressure_shaft", "keyway_root", "cam_slip"),
        "roller_ring_fatigue",
        "roller_pin_fatigue",
        "roller_pin_pressure",
        "cheek_pressure",
        "follower_mass",
    }
    assert all(check.source and check.method for check in checks.values())


def test_a_must_have_that_is_not_described_is_not_evaluated_and_blocks(bare):
    checks = {check.id: check for check in all_checks(bare)}
    must = {
        *("data_spring", "data_pin", "data_fork", "data_key", "data_camshaft", "data_gear"),
        *("roller_ring_fatigue", "follower_mass"),
    }
    for name in must:
        assert checks[name].status == "not_evaluated"
        assert checks[name].blocks is (name in must)
        assert checks[name].note


def test_all_checks_contain_the_parts(bare):
    assert {check.id for check in all_checks(bare)} >= set(parts_checks(bare))


def test_spring_by_hand(full):
    case, checks = full.case, parts_checks(full)
    d, D, n = 6e-3, 40e-3, 8.2
    rate = 77.2e9 * d**4 / (8 * D**3 * n)
    preload = case.spring.preload * (1 + case.spring.preload_tolerance)
    top = preload + rate * (1 + case.spring.rate_tolerance) * 0.02
    C = D / d
    wahl = (4 * C - 1) / (4 * C - 4) + 0.615 / C
    # 10 mm (1 - cos): the surge adds k (phi / sin(phi) - 1) at the fixed end, phi of the softest
    softest, hardest = 1 - case.spring.rate_tolerance, 1 + case.spring.rate_tolerance
    frequency = 0.5 * np.sqrt(rate / (7850 * 0.25 * np.pi * d**2 * np.pi * D * n))
    fastest = max(machine.cam_speed for machine in full.machines)
    phi = 0.5 * fastest / frequency / np.sqrt(softest)
    top += hardest * rate * 0.01 * (phi / np.sin(phi) - 1)
    stress = wahl * 8 * top * D / (np.pi * d**3)
    strength = 0.56 * 1974e6 * 6**-0.108
    assert checks["spring_stress"].demand == pytest.approx(stress / strength, rel=1e-5)
    deflection = preload / rate + 0.02
    room = 0.13 - d * (n + 2) - deflection
    assert checks["spring_solid"].demand == pytest.approx(room / deflection, rel=1e-9)
    assert checks["spring_solid"].must_have


def test_a_spring_that_goes_solid_fails(full):
    short = replace(full.case.spring.design, free_length=70e-3)
    spring = replace(full.case.spring, design=short)
    case = full.case.model_copy(update={"spring": spring})
    check = spring_strength.spring_solid(replace(full, case=case, machines=machines(case)))
    assert check.demand < 0.0
    assert check.status == "fail"
    assert check.blocks


def test_pin_and_key_by_hand(full):
    checks, case = parts_checks(full), full.case
    force = max(c.loads.normal_force.max() for c in full.cycles)
    arm = 16e-3 / 4 - case.roller.width / 8
    stress = 32 * force * arm / (np.pi * 5e-3**3)
    assert checks["roller_pin"].demand == pytest.approx(stress, rel=1e-9)
    assert checks["roller_pin"].must_have
    torque = max(np.abs(c.loads.cam_torque).max() for c in full.cycles)
    # 6 x 6, 3.5 mm deep in the shaft, 0.4 mm of chamfer; the cam is 10 mm wide
    area = (6 - 3.5 - 0.4) * 1e-3 * 10e-3
    push = 1.5 * torque / case.cam.bore_radius
    assert checks["key_pressure"].demand == pytest.approx(push / area, rel=1e-9)


def test_a_pin_span_inside_the_bearing_is_refused():
    pin = PIN.format(material="hardened_steel").replace("16 mm", "9 mm")
    with pytest.raises(InputError, match=r"roller\.pin\.span"):
        parse_case(text(pin))


def test_harmonic_cam_reverses_twice(full):
    check = part_strength.torque_reversals(full)
    assert check.demand == 2.0
    assert check.status == "fail"
    assert not check.must_have
    assert "N m/rad" in check.note


def test_worst_friction_is_a_must_where_it_is_bounded(bare):
    a, b = (replace(guide, friction_max=0.25) for _, guide in bare.case.guides.both)
    guides = replace(bare.case.guides, a=a, b=b)
    rough = harmonic(bare.case.model_copy(update={"guides": guides}))
    worst = rough.cycles[0].parts.friction.greatest
    check = jump_and_jamming.jam_index_friction_max(rough)
    stem = rough.machine.stem
    bearing = guide_reactions(worst.tangential_force, worst.overhang, stem, guides)
    rubs = 0.25 * (bearing.rubbing_load_a + bearing.rubbing_load_b)
    rise = worst.lift_slope > 0
    assert check.demand == pytest.approx((rubs / worst.axial_force)[rise].max(), rel=1e-9)
    factor = 0.25 * (1 + 2 * worst.overhang / guides.spacing)
    on_points = factor * np.abs(np.tan(worst.pressure_angle))
    np.testing.assert_allclose(worst.jam_index_statics, on_points, rtol=1e-9, atol=1e-12)
    assert check.must_have


def test_temperature_with_a_heat_path(bare):
    guides = bare.case.guides
    material = replace(guides.a.material, temperature_limit=353.15)
    guide = replace(guides.a, thermal_resistance=2.0, material=material)
    hot = harmonic(
        bare.case.model_copy(
            update={"guides": replace(guides, a=guide, ambient_temperature=293.15)}
        )
    )
    check = guide_strength.guide_temperature_a(hot)
    power = max(float(np.mean(c.parts.heat_max_a)) for c in hot.cycles)
    assert check.demand == pytest.approx(20.0 + 2.0 * power, rel=1e-9)
    assert check.limit == pytest.approx(80.0)
    # the mean at every second and every third position, by the grid convergence index
    worst = next(c for c in hot.cycles if c.load_case == check.load_case).parts.heat_max_a
    steps = [step for step in (2, 3) if worst.size % step == 0] or [2]
    off = [6.0 * abs(np.mean(worst[::step]) - power) / (step**2 - 1) for step in steps]
    assert check.error_share == pytest.approx(max(off) / check.demand, rel=1e-6)


def test_columns_of_all_parts(full):
    columns = named(full.cycles[0].columns())
    for name in (
        "guide_edge_pressure_A",
        "spring_stress",
        "pin_stress",
        "shaft_bearing_load_2",
        "key_pressure",
    ):
        assert np.isfinite(columns[name]).all()
    force = full.cycles[0].loads.normal_force
    np.testing.assert_allclose(columns["bore_pressure"], force / (2 * 10e-3 * 10e-3), rtol=1e-12)
    # the wall of a bush spreads nothing: its peak is above the projected pressure
    guides = full.cycles[0].guides
    projected = guides.line_pressure_max_a / full.case.follower.stem_diameter
    loaded = projected > 0
    assert (columns["guide_edge_pressure_A"][loaded] > projected[loaded]).all()


def test_a_card_fills_in_what_the_case_leaves_out():
    rows = small_machine("parts").splitlines()
    start = next(k for k, row in enumerate(rows) if row.startswith("[roller.bearing]"))
    end = next(k for k in range(start + 1, len(rows)) if rows[k].startswith("["))
    head, tail = "\n".join(rows[:start]), "\n".join(rows[end:])

    def case(*lines):
        return parse_case("\n".join([head, "[roller.bearing]", *lines, tail]))

    bearing = case('card = "maker_2_625"', 'C0 = "0.5 kN"').roller.bearing
    assert (bearing.C, bearing.C0) == (1730.0, 500.0)
    assert not bearing.source.confirmed
    again = parse_case(case('card = "maker_2_625"').to_toml())
    assert again.roller.bearing.C0 == 670.0
    with pytest.raises(InputError, match="maker_2_625"):
        case('card = "nobody"')


def test_friction_that_the_guides_do_not_have_fails_the_balance(bare):
    """Loads with the friction of point supports do not close with the heat in the bores."""
    assert friction_balance(bare).demand <= 1e-9
    cycle = bare.cycles[0]
    system, speed = cycle.machine.system, cycle.cam_speed
    loads = follower_loads(bare.contour.pitch, system, speed, cycle.theta)
    wrong = replace(bare, cycles=(made.changed_cycle(cycle, loads=loads),))
    assert friction_balance(wrong).status == "fail"
    assert friction_balance(wrong).demand > 0.01


def test_columns_of_a_turn_close(bare):
    """What one row says of friction, force, heat and shares adds up: 1e-9 of the greatest."""
    cycle, guides = bare.cycles[0], bare.case.guides
    rows = table(cycle.columns())
    v, rubs = (
        rows["follower_velocity_m_per_s"],
        rows["guide_friction_A_N"] + rows["guide_friction_B_N"],
    )

    def same(one, other):
        np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(other).max())

    pressed = rows["spring_force_N"] + rows["inertia_force_N"] + rows["viscous_force_N"]
    same(pressed + np.sign(v) * rubs, rows["axial_force_N"])
    for side, guide in (("A", guides.a), ("B", guides.b)):
        same(guide.friction * rows[f"guide_normal_load_{side}_N"], rows[f"guide_friction_{side}_N"])
        same(rows[f"guide_friction_{side}_N"] * np.abs(v), rows[f"guide_friction_power_{side}_W"])
        changed = rows["guide_reaction_by_length_N"] + rows["guide_reaction_by_clearance_N"]
        same(rows[f"guide_reaction_{side}_statics_N"] + changed, rows[f"guide_reaction_{side}_N"])
    changed = rows["normal_force_by_length_N"] + rows["normal_force_by_clearance_N"]
    same(rows["normal_force_statics_N"] + changed, rows["normal_force_N"])
    heat = (rows["guide_friction_power_A_W"] + rows["guide_friction_power_B_W"]).mean()
    assert np.mean(rows["cam_torque_Nm"]) * cycle.cam_speed == pytest.approx(heat, rel=1e-9)
    assert rows["residual_friction"].max() <= 1e-10
    same(np.radians(rows["stem_slope_A_deg"]), cycle.guides.slope_a)


def test_overspeed_jumps_and_lands(bare):
    """Fast enough to leave the cam: the check fails and names the losses of contact."""
    state = bare.case.load_cases[0].model_copy(update={"speed": 2000.0})
    fast = harmonic(bare.case.model_copy(update={"load_cases": (state,)}))
    elastic = fast.cycles[0].elastic
    assert elastic.response.lost
    assert elastic.flights
    assert elastic.force_max > fast.cycles[0].loads.spring_force.max()
    check = jump_and_jamming.elastic_contact(fast)
    assert check.status == "fail"
    assert f"{len(elastic.flights)} losses of contact" in check.note
    highest = max(elastic.flights, key=lambda flight: flight.height)
    assert f"starts at {np.degrees(highest.jump) % 360:.1f} deg" in check.note
    assert f"{highest.landing_speed:.3g} m/s" in check.note


def test_a_preview_loses_the_contact_but_follows_no_flight(bare):
    """The least force is that of the whole solution; how the follower lands is not computed."""
    state = bare.case.load_cases[0].model_copy(update={"speed": 2000.0})
    case = bare.case.model_copy(update={"load_cases": (state,)})
    preview = harmonic(case, Tier.PREVIEW)
    elastic = preview.cycles[0].elastic
    assert elastic.response.lost
    assert elastic.flights == ()
    check = jump_and_jamming.elastic_contact(preview)
    assert check.status == "fail"
    assert "losses of contact" not in check.note
    assert check.demand == jump_and_jamming.elastic_contact(harmonic(case)).demand


def test_ring_of_a_card():
    """The stress grows with the load; Goodman's line takes fatigue and tensile strength."""
    bearing = "[roller.bearing]                     # ratings"
    named = small_machine("ring").replace(bearing, '[roller.bearing]\ncard = "maker_1_625_2RS"\n#')
    open_ring = part_strength.roller_ring_fatigue(harmonic(parse_case(named)))
    assert open_ring.status == "not_evaluated"
    assert "not the outer ring of the bearing" in open_ring.note
    small = named.replace('radius = "16 mm"', 'radius = "8 mm"', 1).replace(
        'hub_radius = "8 mm"', 'hub_radius = "4.2 mm"', 1
    )
    on_balls = harmonic(parse_case(small))
    cycle = on_balls.cycles[0]
    ratio = cycle.parts.ring_amplitude / cycle.loads.normal_force
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-12)
    assert (cycle.parts.ring_correction < 0.0).all()
    force = max(c.loads.normal_force.max() for c in on_balls.cycles)
    mean = cycle.parts.ring_mean[0] / cycle.loads.normal_force[0]
    check = part_strength.roller_ring_fatigue(on_balls)
    assert check.limit == pytest.approx(700e6)
    left = 1.0 - mean * force / 1570e6
    assert check.demand == pytest.approx(ratio[0] * force / left, rel=1e-9)
    assert "(to be confirmed)" in check.source
    roller = on_balls.case.roller
    ring = replace(roller.bearing.ring, fatigue_bending=None)
    roller = replace(roller, bearing=replace(roller.bearing, ring=ring))
    case = on_balls.case.model_copy(update={"roller_given": roller})
    unknown = replace(on_balls, case=case, machines=machines(case))
    check = part_strength.roller_ring_fatigue(unknown)
    assert check.status == "not_evaluated"
    assert check.missing == ("roller.bearing.ring.fatigue_bending",)


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
        (
            "[materials.bronze]",
            'strength_at = [{ temperature = "10 degC", yield_strength = "1 MPa" }]',
            r"materials\.bronze\.strength_at",
        ),
        ("[guides.a]", 'wall = "0 mm"', r"guides\.a\.wall"),
        ("[guides.b]", 'housing_resistance = "0 K/W"', r"guides\.b\.housing_resistance"),
        ("[guides.b]", 'speed_limit = "-1 m/s"', r"guides\.b\.speed_limit"),
        ("[follower]", 'anti_rotation = "hope"', r"follower\.anti_rotation"),
        ("[limits]", "acceleration_step = 0.0", r"limits\.acceleration_step"),
    ],
)
def test_data_of_running_that_cannot_be_are_refused(table, line, field):
    plain = re.sub(rf"^{line.split()[0]} = .*\n", "", text(), flags=re.MULTILINE)
    with pytest.raises(InputError, match=field):
        parse_case(plain.replace(f"{table}\n", f"{table}\n{line}\n").replace(
            f"{table} ", f"{table}\n{line}\n# "))  # fmt: skip


def test_a_lift_with_a_step_of_acceleration_fails():
    """A parabola changes from one acceleration to its opposite at once, a sine does not."""
    theta = uniform_turn(720)
    turn = theta / (2.0 * np.pi)
    tent = np.where(turn < 0.5, turn, 1.0 - turn) * 2.0
    parabola = np.where(tent < 0.5, 2.0 * tent**2, 1.0 - 2.0 * (1.0 - tent) ** 2)
    for values, status in ((parabola, "fail"), (0.5 * (1 - np.cos(theta)), "pass")):
        contour = RollerContour(PitchCurve(Lift(theta, 0.01 * values), 0.05), 0.008)
        case = full_case()
        check = acceleration_step(
            Solution(case, contour, machines(case), Tier.PREVIEW, mesh=None, cycles=())
        )
        assert check.status == status
        assert check.must_have


def test_a_shaft_with_its_gear_is_judged():
    """Of every load case; the teeth of 20 and 40 with the torque of the cam."""
    steel = parse_case(small_machine("parts")).cam.material.name
    more = f"""diameter = "20 mm"
material = "{steel}"
bearing_rating = "9.95 kN"

[camshaft.gear]
teeth = 40
pinion_teeth = 20
width = "12 mm"
material = "{steel}"
bending_limit = "300 MPa"
contact_limit = "1200 MPa"
source = "made up"
"""
    driven = harmonic(parse_case(text(KEYWAY + SHAFT + more)))
    checks = {check.id: check for check in checks_of(driven, declared_in(camshaft_strength))}
    assert set(checks) == {
        *("shaft_fatigue", "shaft_yield", "shaft_deflection", "shaft_slope"),
        *("shaft_bearing_static", "shaft_bearing_life"),
        *("gear_bending", "pinion_bending", "gear_contact", "gear_impact"),
    }
    # Neither strength nor a target life is stated.
    assert checks["shaft_fatigue"].status == "not_evaluated"
    assert {key.rsplit(".")[-1] for key in checks["shaft_fatigue"].missing} == {
        "fatigue_bending", "tensile_strength",
    }  # fmt: skip
    assert checks["shaft_bearing_life"].demand > 0
    # The pinion of 20 teeth has the thinner root, and no limits of its own are stated.
    ratio = checks["pinion_bending"].demand / checks["gear_bending"].demand
    assert ratio == pytest.approx((0.154 - 0.912 / 40) / (0.154 - 0.912 / 20))
    for name in ("pinion_bending", "gear_contact", "shaft_bearing_static"):
        assert checks[name].status == "not_evaluated"
        assert checks[name].blocks
    assert checks["gear_contact"].unit == "MPa"


def test_guides_that_overlap_are_refused():
    """Two of 24 mm, 24 mm apart in the middle, would touch."""
    with pytest.raises(InputError, match=r"guides\.spacing"):
        parse_case(small_machine("parts").replace('spacing = "80 mm"', 'spacing = "24 mm"'))


@pytest.mark.parametrize("name", ["friction_min", "friction_max"])
def test_friction_bounds_out_of_order_are_refused(name):
    lines = small_machine("parts").replace("friction = 0.04", f"friction = 0.04\n{name} = PUT", 1)
    value = {"friction_min": "0.05", "friction_max": "0.03"}[name]
    with pytest.raises(InputError, match="friction"):
        parse_case(lines.replace("PUT", value))
