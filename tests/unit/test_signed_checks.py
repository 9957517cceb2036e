"""Checks of over-speed, life, edges, room and manufacture: limits, missing numbers, by hand."""

from dataclasses import replace
from types import SimpleNamespace

import fake_trial as fake
import numpy as np
import pytest

from pipeline.checks import contact, forces, guides, manufacture, roller, room
from pipeline.checks.contact import pressure_at_life, shakedown_factor
from pipeline.checks.everything import all_checks

FUNCTIONS = {
    function(fake.evidence()).id: function
    for function in (
        *forces.SIGNED,
        *contact.SIGNED,
        *room.CHECKS,
        *roller.SIGNED,
        *guides.SIGNED,
        *manufacture.CHECKS,
    )
}
RPM = 30.0 / np.pi
MODULUS = 210e9 / (2.0 * (1.0 - 0.3**2))


def with_limits(**values):
    return {"case": fake.limits(**values)}


def life_case(hours=1e4, **limits):
    base = fake.limits(target_life=None if hours is None else hours * 3600.0, **limits)
    elastic = {"E": 210e9, "nu": 0.3}
    steel = fake.changed(
        base.materials["steel"], endurance_slope=14.15, endurance_intercept=66.22, **elastic
    )
    hard = fake.changed(base.materials["hard"], **elastic)
    return fake.changed(base, materials={"steel": steel, "hard": hard})


def by_steel(name, per_unit):
    def changes(limit):
        base = fake.case()
        value = None if limit is None else limit * per_unit
        steel = fake.changed(base.materials["steel"], **{name: value})
        return {"case": fake.changed(base, materials=base.materials | {"steel": steel})}

    return changes


def by_friction_limit(limit):
    if limit is None:
        base = fake.case()
        return {"case": fake.changed(base, roller=fake.changed(base.roller, friction=None))}
    return by_steel("yield_strength", 1e6 * np.sqrt(3.0) / shakedown_factor(0.1))(limit)


def by_tolerance(limit):
    base = fake.case()
    tolerance = None if limit is None else 4e-6 * limit
    return {"case": fake.changed(base, cam=fake.changed(base.cam, profile_tolerance=tolerance))}


def by_life_safety(limit):
    if limit is None:
        return {"case": life_case(hours=None)}
    bare = FUNCTIONS["contact_pressure_at_life"](fake.evidence(case=life_case()))
    return {"case": life_case(contact_safety=bare.limit / limit)}


def by_rating(limit):
    base = fake.case()
    bearing = fake.changed(base.roller.bearing, radial_limit=limit)
    return {"case": fake.changed(base, roller=fake.changed(base.roller, bearing=bearing))}


CASES = {
    "roller_radial": by_rating,
    "guide_length": lambda limit: with_limits(guide_length=limit),
    "jump_speed": lambda limit: with_limits(
        jump_speed=None if limit is None else limit / (RPM * 2.0 * fake.CAM_SPEED)
    ),
    "contact_at_overspeed": lambda limit: with_limits(contact_force_margin=limit),
    "contact_pressure_at_life": by_life_safety,
    "edge_pressure": by_steel("endurance_pressure", 1e6),
    "shakedown_traction": by_friction_limit,
    "guide_clearance": lambda limit: with_limits(clearance=limit and 1e-3 * limit),
    "cam_envelope": lambda limit: with_limits(cam_radius=limit and 1e-3 * limit),
    "profile_waviness": lambda limit: with_limits(waviness=limit),
    "chord_error": by_tolerance,
    "phase_tolerance": lambda limit: with_limits(torque_reduction=limit),
}


def test_every_check_is_tried_here():
    assert set(FUNCTIONS) == set(CASES)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("utilisation", "status"), [(0.99, "pass"), (1.01, "fail")])
def test_on_both_sides_of_the_limit(name, utilisation, status):
    start = life_case() if name == "contact_pressure_at_life" else fake.case()
    plain = FUNCTIONS[name](fake.evidence(case=start))
    at_most = plain.sense == "at_most"
    limit = plain.demand / utilisation if at_most else plain.demand * utilisation
    given = CASES[name](limit / 1e0 if name != "chord_error" else limit)
    check = FUNCTIONS[name](fake.evidence(**given))
    assert check.demand == pytest.approx(plain.demand)
    assert check.utilisation == pytest.approx(utilisation, rel=1e-6)
    assert check.status == status
    assert check.source and check.method and check.title


@pytest.mark.parametrize("name", CASES)
def test_without_a_limit_nothing_is_evaluated(name):
    assert FUNCTIONS[name](fake.evidence(**CASES[name](None))).status == "not_evaluated"


@pytest.mark.parametrize(
    ("name", "part", "field"),
    [
        ("jump_speed", "loads", "inertia_force"),
        ("contact_at_overspeed", "loads", "spring_force"),
        ("contact_pressure_at_life", "contact", "p0"),
        ("edge_pressure", "contact", "p0"),
        ("shakedown_traction", "contact", "p0"),
        ("roller_radial", "loads", "normal_force"),
        ("profile_waviness", "loads", "normal_force"),
        ("phase_tolerance", None, "torque_before"),
    ],
)
def test_a_nan_is_a_missing_number(name, part, field):
    plain = fake.cycle()
    nan = {field: np.full(fake.POSITIONS, np.nan)}
    bad = nan if part is None else {part: fake.changed(getattr(plain, part), **nan)}
    cycles = (plain, fake.changed(plain, **bad, load_case="bad"))
    given = fake.evidence(case=life_case(), cycles=cycles)
    assert FUNCTIONS[name](given).status == "not_evaluated"


def test_jump_speed_by_hand():
    """F_s = P + k s against m w^2 s'': on 5 mm (1 - cos) the slowing half holds both extremes."""
    check = forces.jump_speed(fake.evidence())
    s, bend = 0.005 * (1.0 - np.cos(fake.THETA)), 0.005 * np.cos(fake.THETA)
    slows = bend < 0
    force = fake.PRELOAD + fake.RATE * s[slows]
    speed = 2.0 * np.sqrt(np.min(force / (-fake.MASS * bend[slows])))
    # The spline of 72 samples has the second derivative of the cosine to 1e-4.
    assert check.demand == pytest.approx(RPM * speed, rel=1e-3)
    assert check.limit == pytest.approx(1.3 * RPM * 2.0 * fake.CAM_SPEED)
    assert "no over-speed is given" in check.note
    over = forces.jump_speed(fake.evidence(case=fake.limits(overspeed=400.0)))
    assert over.limit == pytest.approx(1.3 * RPM * 400.0)


def test_contact_at_overspeed_takes_more_than_the_load_case():
    slow = forces.contact_at_overspeed(fake.evidence())
    fast = forces.contact_at_overspeed(fake.evidence(case=fake.limits(overspeed=1600.0)))
    s, bend = 0.005 * (1.0 - np.cos(fake.THETA)), 0.005 * np.cos(fake.THETA)
    force = fake.PRELOAD + fake.RATE * s + fake.MASS * 800.0**2 * bend
    assert fast.demand == pytest.approx(force.min() / fake.PRELOAD, rel=1e-3)
    assert fast.demand < slow.demand


def test_pressure_at_life_reproduces_the_table_at_1e8():
    """Rothbart's table 9.3 gives K = 13 000 psi and 1790 MPa for induction-hardened 4340."""
    found = pressure_at_life(1e8, 14.15, 66.22, MODULUS)
    assert found == pytest.approx(1790e6, rel=0.02)  # the table's K is rounded
    assert pressure_at_life(1e6, 14.15, 66.22, MODULUS) > found


def test_life_asked_for_sets_the_cycles():
    check = contact.contact_pressure_at_life(fake.evidence(case=life_case(1e4)))
    cycles = 1e4 * 3600.0 * fake.CAM_SPEED / (2.0 * np.pi)
    assert check.limit == pytest.approx(1e-6 * pressure_at_life(cycles, 14.15, 66.22, MODULUS))
    assert check.must_have


def test_edges_raise_the_pressure_of_a_roller_without_a_crown():
    base = fake.case()
    plain = fake.changed(base, roller=fake.changed(base.roller, crowned=False))
    crowned = contact.edge_pressure(fake.evidence())
    assert crowned.demand == pytest.approx(900.0)
    assert contact.edge_pressure(fake.evidence(case=plain)).demand == pytest.approx(1.3 * 900.0)


def test_shakedown_factor_is_johnsons():
    """4 without friction (orthogonal shear p0/4); 1/mu where the surface decides."""
    assert shakedown_factor(0.0) == pytest.approx(4.0, rel=1e-4)
    assert shakedown_factor(0.5) == pytest.approx(2.0, rel=1e-3)
    assert 2.5 < shakedown_factor(0.3) < shakedown_factor(0.1) < 4.0


def test_clearance_by_hand():
    """Roller of 8 mm, guide of 20 mm whose middle is 30 mm off: 12 mm stay."""
    assert room.guide_clearance(fake.evidence()).demand == pytest.approx(12.0, abs=1e-6)


def test_guide_length_by_hand():
    """80 mm apart, 20 mm long, 30 mm over at full lift and 40 mm at none."""
    assert guides.guide_length(fake.evidence()).demand == pytest.approx(100.0 / 40.0)


def test_force_on_the_roller_by_hand():
    assert roller.roller_radial(fake.evidence()).demand == pytest.approx(400.0)


def test_waviness_by_hand():
    """m delta (2 pi v / lambda)^2 over the force on a ring: v = w (R - r), delta half of 4 um."""
    check = manufacture.profile_waviness(fake.evidence())
    assert check.source.startswith("10 to 20 %")
    ring = replace(fake.evidence(), contour=fake.contour(stroke=1e-9))
    flat = SimpleNamespace(normal_force=np.full(fake.POSITIONS, 300.0))
    ring = replace(ring, cycles=(fake.changed(fake.cycle(), loads=flat),))
    wave = fake.MASS * 2e-6 * (2.0 * np.pi * 80.0 * 0.042 / 5e-3) ** 2 / 300.0
    assert manufacture.profile_waviness(ring).demand == pytest.approx(wave, rel=1e-5)


def test_phase_by_hand():
    """sin against half of it, 0.02 rad of cam off: the rest is the root of 1.25 - cos(0.02)."""
    check = manufacture.phase_tolerance(fake.evidence())
    assert check.demand == pytest.approx(1.0 - np.sqrt(1.25 - np.cos(0.02)), rel=1e-9)
    assert not check.must_have
    sharp = fake.changed(fake.case(), tolerances=SimpleNamespace(phase=0.0))
    assert manufacture.phase_tolerance(fake.evidence(case=sharp)).status == "not_evaluated"
    unmoved = fake.cycle(torque_before=None, residual_torque=None)
    assert manufacture.phase_tolerance(fake.evidence(cycles=(unmoved,))) is None


def test_chord_error_by_hand():
    """One step in 720 of a ring of 42 mm: r (pi/360)^2 / 2 / 4."""
    ring = replace(fake.evidence(), contour=fake.contour(stroke=1e-9))
    step = 42e3 * np.pi / 360.0
    assert manufacture.chord_error(ring).demand == pytest.approx(step**2 / (8.0 * 42e3), rel=1e-4)


def test_a_waiver_of_no_check_is_told():
    waiver = SimpleNamespace(check="jmup", name="A. Engineer", reason="proven", date="2025-01-02")
    found = {c.id: c for c in all_checks(fake.evidence(case=fake.case(waivers=(waiver,))))}
    assert found["idle_waivers"].status == "fail"
    assert found["idle_waivers"].note == "jmup"
    assert not found["idle_waivers"].must_have
    assert "idle_waivers" not in {c.id for c in all_checks(fake.evidence())}
