"""Rockers: lift of an output and back, lash, ratio, what the output carries; valve trains."""

from functools import cache

import numpy as np
import pytest
from test_oscillating_case import STEM, text

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.rocker_lift import RockerArm, RockerLinkage
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.spring_kinds import rise
from camwright.pipeline.follower.spring_link import RockerSpring, linked
from camwright.pipeline.results.run_records import lift_columns

STEP = 1e-30
LINKAGES = {
    "constant ratio": RockerLinkage.of_ratio(1.6, 2e-4),
    "arm to valve": RockerLinkage(RockerArm(0.09), RockerArm(0.05, -0.12), 2e-4),
    "push rod to valve": RockerLinkage(RockerArm(0.03, -0.1), RockerArm(0.05, -0.15), 2e-4),
}


@pytest.mark.parametrize("name", LINKAGES)
def test_lift_goes_to_the_output_and_back(name):
    rocker, lift = LINKAGES[name], np.linspace(0.0, 0.012, 49)
    np.testing.assert_allclose(rocker.follower(rocker.output(lift)), lift, rtol=0, atol=1e-16)
    h = 1e-7
    slope = (rocker.output(lift + h) - rocker.output(lift - h)) / (2.0 * h)
    np.testing.assert_allclose(rocker.ratio(lift), slope, rtol=1e-8)
    by_complex = np.imag(rocker.output(lift + 1j * STEP)) / STEP
    np.testing.assert_allclose(rocker.ratio(lift), by_complex, rtol=1e-13)
    opened = np.imag(rocker.opening(lift + 1j * STEP)) / STEP
    np.testing.assert_allclose(opened, np.where(rocker.output(lift) > 2e-4, by_complex, 0.0))


def test_ends_of_the_arms_slide_across_their_lines():
    """Travels by the coordinates of both ends, turned about the pivot."""
    rocker, swing = LINKAGES["push rod to valve"], np.linspace(0.0, 0.2, 9)
    pushed = 0.03 * np.sin(-0.1 + swing) - 0.03 * np.sin(-0.1)
    valve = 0.05 * np.sin(-0.15 + swing) - 0.05 * np.sin(-0.15)
    np.testing.assert_allclose(rocker.output(pushed), valve, rtol=1e-12)
    ratios = rocker.ratio(pushed)
    assert ratios[0] == pytest.approx(0.05 * np.cos(-0.15) / (0.03 * np.cos(-0.1)), rel=1e-14)
    assert np.ptp(ratios) > 0.01  # it changes over the swing


def valve_lift(law="polynomial_4567"):
    return SegmentMotion((
        Segment(law, np.radians(70.0), 0.009), Segment(law, np.radians(70.0), -0.009),
        Segment("dwell", np.radians(220.0)),
    )).lift()  # fmt: skip


@pytest.mark.parametrize("name", LINKAGES)
def test_lift_of_a_valve_is_that_behind_the_cam_of_its_rocker(name):
    """Within 1e-9 m between the samples, too; the valve rests while the lash is taken up."""
    rocker, opening = LINKAGES[name], valve_lift()
    lift = rocker.follower_lift(opening, np.radians(40.0))
    theta = np.linspace(0.0, FULL_TURN, 7919)
    np.testing.assert_allclose(rocker.opening(lift(theta)), opening(theta), rtol=0, atol=1e-9)
    # the ramps end at rest, at the first and last angle at which the valve has moved by 1e-9
    moves = opening.theta[opening.values > 1e-9 * opening.values.max()]
    for side, end in ((-1.0, moves[0]), (1.0, moves[-1])):
        share = np.array([0.0, 0.25, 0.5, 1.0])
        taken = rocker.output(lift(end + side * (1.0 - share) * np.radians(40.0)))
        np.testing.assert_allclose(taken, 2e-4 * taken_up(share), rtol=0, atol=1e-10)
        assert abs(lift(end, 1)) < 1e-6
    assert lift(np.radians(250.0)) == pytest.approx(0.0, abs=1e-15)


def taken_up(x):
    return 35.0 * x**4 - 84.0 * x**5 + 70.0 * x**6 - 20.0 * x**7


def test_without_lash_the_cam_rests_with_its_valve():
    rocker, opening = RockerLinkage(RockerArm(0.09), RockerArm(0.05, -0.12)), valve_lift()
    lift = rocker.follower_lift(opening, np.pi)
    assert np.ptp(lift(np.radians([150.0, 200.0, 300.0]))) < 1e-12


def test_what_a_rocker_cannot_do_is_refused():
    rocker, opening = LINKAGES["arm to valve"], valve_lift()
    for ramp in (0.0, np.radians(111.0), np.nan):
        with pytest.raises(InputError, match=r"rocker\.ramp = .* half of the rest"):
            rocker.follower_lift(opening, ramp)
    short = RockerLinkage(RockerArm(0.09), RockerArm(0.008, 0.0))
    with pytest.raises(InputError, match="within the reach of its arms"):
        short.follower_lift(opening, 0.5)


# --- Cases ---------------------------------------------------------------------------------------
ROCKER = """[rocker]
length = "60 mm"
angle = "-5 deg"
lash = "0.15 mm"
lift = "output"
ramp = "25 deg"

[lubricant]"""


@cache
def rocked():
    return text().replace("[lubricant]", ROCKER, 1)


def test_a_case_states_the_lift_of_its_output():
    case = parse_case(rocked())
    assert parse_case(case.to_toml()).rocker == case.rocker
    plain, lift, theta = given_lift(parse_case(text())), given_lift(case), uniform_turn(1001)
    valve = case.rocker_linkage.opening(lift(theta))
    np.testing.assert_allclose(valve, plain(theta), rtol=0, atol=1e-9)
    swing = np.arcsin(np.sin(np.radians(-5.0)) + (0.010 + 1.5e-4) / 0.060) - np.radians(-5.0)
    assert lift.highest.value == pytest.approx(0.1 * swing, rel=1e-9)
    columns = {key.name: value for key, value in lift_columns(case, lift).items()}
    assert columns["output_lift"].max() == pytest.approx(0.010, abs=1e-9)


@pytest.mark.parametrize("follower", ["arm", "stem"])
def test_mass_and_force_of_the_output_are_those_of_the_follower(follower):
    table = '[rocker]\nratio = 1.5\nmass = "200 g"\nforce = "40 N"\n\n[lubricant]'
    whole = text() if follower == "arm" else text(follower=STEM)
    case = parse_case(whole.replace("[lubricant]", table, 1))
    assert case.follower.mass == pytest.approx(1.1 + 0.2 * 1.5**2, rel=1e-12)
    assert case.follower.external_force == pytest.approx(60.0, rel=1e-12)
    again = parse_case(case.to_toml())
    assert again.follower.mass == pytest.approx(case.follower.mass, rel=1e-12)
    if follower == "stem":
        return
    true = 'length = "60 mm"\nangle = "-5 deg"\nmass = "200 g"'
    case = parse_case(whole.replace("[lubricant]", f"[rocker]\n{true}\n\n[lubricant]", 1))
    ratio = 0.060 * np.cos(np.radians(5.0)) / 0.100
    assert case.follower.mass == pytest.approx(1.1 + 0.2 * ratio**2, rel=1e-12)


@pytest.mark.parametrize(("old", "new", "message"), [
    ('length = "60 mm"', 'length = "60 mm"\nratio = 1.5', "rocker.ratio = 1.5, must be one of"),
    ('length = "60 mm"\nangle = "-5 deg"\n', "", "rocker.ratio = missing, must be one of"),
    ('length = "60 mm"', "ratio = 1.5", "rocker.angle = -5 deg, must be left out"),
    ('angle = "-5 deg"', 'input_length = "30 mm"', "rocker.input_length = 30 mm"),
    ('ramp = "25 deg"\n', "", "rocker.ramp = missing"),
    ('ramp = "25 deg"', 'ramp = "31 deg"', "rocker.ramp = 31 deg, must be > 0, <= 30.25 deg"),
    ('length = "60 mm"', 'length = "9 mm"', "rocker lift of the output = "),
    ('lash = "0.15 mm"', 'lash = "-1 mm"', "rocker.lash = -1 mm"),
    ('angle = "-5 deg"', 'angle = "-80 deg"', "rocker.angle = -80 deg"),
    ('lash = "0.15 mm"', 'mass = "0 g"', "rocker.mass = 0 g, must be > 0 and <= 1e+06 g"),
    ('lash = "0.15 mm"', 'force = "5 N"', "rocker.force = 5 N, must be left out without"),
    ('lash = "0.15 mm"', 'side = "left"', "rocker.side = left"),
])  # fmt: skip
def test_refused_rockers(old, new, message):
    assert old in rocked()
    with pytest.raises(InputError) as error:
        given_lift(parse_case(rocked().replace(old, new, 1)))
    assert str(error.value).startswith(message)


def test_a_rocker_with_a_mass_on_an_arm_without_a_length_names_the_arm():
    whole = rocked().replace('lash = "0.15 mm"', 'mass = "200 g"', 1)
    start = whole.index("[follower.arm]")
    arm = whole[start:].split("\n\n", 1)[0]
    short = "\n".join(line for line in arm.splitlines() if not line.startswith("length"))
    with pytest.raises(InputError, match=r"follower\.arm\.length = missing"):
        parse_case(whole.replace(arm, short, 1))


def test_a_stem_needs_the_length_of_the_arm_that_it_moves():
    whole = text(follower=STEM).replace("[lubricant]", ROCKER, 1)
    with pytest.raises(InputError, match=r"rocker\.input_length = missing"):
        parse_case(whole)
    case = parse_case(whole.replace('length = "60 mm"', 'length = "60 mm"\ninput_length = "45 mm"'))
    assert case.rocker_linkage.first == RockerArm(0.045, 0.0)


@pytest.mark.parametrize("side", ["opposite", "same"])
def test_push_of_the_output_on_the_arm(side):
    """Its power is that of the output against its force; beyond the pivot it points outwards."""
    rocker = Rocker(length=0.06, angle=-0.2, side=side)
    lift, h = np.array([0.0, 0.01]), 1e-6
    force = np.array([100.0, 300.0])
    x, y = rocker.push_on_arm(force, lift, 0.1)
    end = -0.06 if side == "opposite" else 0.06
    linkage = rocker.linkage(0.1)
    rate = (linkage.output(lift + h) - linkage.output(lift - h)) / (2.0 * h)
    moment = end * y  # about the pivot, of the force at the end of the second arm, along the first
    np.testing.assert_allclose(moment, -force * rate * 0.1, rtol=1e-8)
    np.testing.assert_allclose(np.hypot(x, y), force, rtol=1e-12)
    assert (y > 0.0).all() == (side == "opposite")


# --- A spring on the output ----------------------------------------------------------------------
BEHIND = {
    "arm": (Rocker(length=0.06, angle=-0.2), 0.1),
    "stem": (Rocker(length=0.05, angle=-0.15, input_length=0.03, input_angle=-0.1), None),
    "ratio": (Rocker(ratio=1.4), None),
}


def behind(name):
    rocker, length = BEHIND[name]
    spring = RockerSpring(rate=30e3, preload=350.0)
    return linked(spring, None).on_arm(length, rocker)


def valve_travel(name, lift):
    """Travel of the output (n,), m, by the swing of both arms."""
    if name == "ratio":
        return 1.4 * lift
    if name == "arm":
        return 0.06 * (np.sin(-0.2 + lift / 0.1) - np.sin(-0.2))
    swing = np.arcsin(np.sin(-0.1) + lift / 0.03) + 0.1
    return 0.05 * (np.sin(-0.15 + swing) - np.sin(-0.15))


@pytest.mark.parametrize("name", BEHIND)
def test_a_spring_on_the_output_stores_its_own_energy(name):
    """Force and energy by the travel of the output; derivatives by complex steps."""
    shape, lift = behind(name), np.array([1e-4, 0.003, 0.008])
    own = valve_travel(name, lift + 1j * STEP)
    energy = 350.0 * own + 15e3 * own**2
    spring = Spring(rocker=shape.link, rate=shape.rate, preload=shape.preload)
    np.testing.assert_allclose(spring.force(lift), np.imag(energy) / STEP, rtol=1e-11)
    held = [spring.energy(float(each)) for each in lift]
    np.testing.assert_allclose(held, np.real(energy), rtol=1e-11)
    law, by_complex = rise(shape, lift), rise(shape, lift + 1j * STEP)
    np.testing.assert_allclose(np.imag(by_complex.travel) / STEP, law.slope, rtol=1e-11)
    curved = np.imag(by_complex.slope) / STEP
    np.testing.assert_allclose(curved, law.travel_d2, rtol=1e-9, atol=1e-9)
    assert spring.own.rate == pytest.approx(30e3) and spring.own.preload == pytest.approx(350.0)


def test_a_valve_spring_closes_an_arm_by_its_rocker():
    spring = '[spring.rocker]\nrate = "180 kN/m"\npreload = "1700 N"\n\n[spring.design]'
    whole = text().replace('rate = "100 kN/m"\npreload = "1000 N"', "# of the output", 1)
    whole = whole.replace("[spring.design]", spring, 1)
    rocker = '[rocker]\nlength = "60 mm"\nangle = "-5 deg"\n\n[lubricant]'
    case = parse_case(whole.replace("[lubricant]", rocker, 1))
    ratio = 0.060 * np.cos(np.radians(5.0)) / 0.100
    assert case.spring.preload == pytest.approx(1700.0 * ratio, rel=1e-12)
    assert parse_case(case.to_toml()).spring == case.spring
    for table, message in (("[lubricant]", "rocker = missing"),
                           (rocker.replace("[rocker]", '[rocker]\nlash = "0.1 mm"'), "rocker.lash"),
                           ):  # fmt: skip
        with pytest.raises(InputError) as error:
            parse_case(whole.replace("[lubricant]", table, 1))
        assert str(error.value).startswith(message)
