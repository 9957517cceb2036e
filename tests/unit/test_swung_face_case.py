"""Cases with a flat or curved face on an arm: keys, refusals, preview, screening, synthesis."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from fourth_order import fourth_order
from swung_face import face_text

from camwright.geometry.arm_face import ArmFacePath, CurvedFacePath
from camwright.geometry.arrays import rotation
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Jet
from camwright.pipeline.base.envelope import MechanismSizes
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case_file import parse_case, with_values
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.arm_strength import arm_forces
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.cycle.arm_bodies import swung_bodies
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solved_cam import numbers_of
from camwright.pipeline.follower.pivot_forces import Pressed, Pull
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.workshop_files import notes_of
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.screening.screened_checks import SCREENED
from camwright.reports.drawing.arrangement import (
    DrawnArm,
    DrawnMechanism,
    DrawnMotion,
    cam_turn,
    contact_point,
    drawing,
)

KINDS = ("flat", "curved")
DESCRIBED = """\
width = "28 mm"
depth = "24 mm"
bore = "20 mm"
hub = "36 mm"
material = "case_hardened"
pivot_notch = 2.0

[follower.pivot]
pin_material = "c45"
ambient_temperature = "30 degC"
gravity_angle = "0 deg"

[follower.pivot.bush]
card = "ptfe_lined"
length = "25 mm"
diameter = "16 mm"
wall = "1.5 mm"
clearance = "0.03 mm"
housing_resistance = "2 K/W"
wear_rate = "3e-8 mm^3/N/m"

[follower.face]
"""


@cache
def previewed(kind, swing="with"):
    return preview_case(parse_case(face_text(kind, swing=swing)), corners=swing == "against")


def failed(trial):
    judged = [each for each in trial.checks if each.must_have and not each.judged_at]
    return {each.id for each in judged if each.status != "pass"}


@pytest.mark.parametrize("kind", KINDS)
def test_a_case_has_the_contour_of_its_face(kind):
    case = parse_case(face_text(kind))
    path = case.contour(given_lift(case)).pitch
    if kind == "flat":
        assert isinstance(path, ArmFacePath)
        # the height of the face over the cam axis is the base radius
        assert path.start == pytest.approx(np.arcsin(0.045 / 0.110), rel=1e-12)
    else:
        assert isinstance(path, CurvedFacePath)
        assert path.radius == pytest.approx(0.0235)
    assert case.base_circle == pytest.approx(0.040 if kind == "flat" else 0.0365)
    again = parse_case(case.to_toml())
    assert again.to_toml() == case.to_toml()
    assert again.follower.face == case.follower.face


@pytest.mark.parametrize("kind", KINDS)
def test_the_start_angle_gives_the_prime_radius(kind):
    path = parse_case(face_text(kind)).contour(given_lift(parse_case(face_text(kind)))).pitch
    start = f'"{np.degrees(path.start):.12g} deg"'
    whole = re.sub(r"prime_radius = .*\n", "", face_text(kind))
    whole = whole.replace('swing = "with"', f'swing = "with"\nstart_angle = {start}')
    known = 0.040 if kind == "flat" else 0.060
    assert parse_case(whole).cam.prime_radius == pytest.approx(known, rel=1e-11)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("swing", ["with", "against"])
def test_an_eccentric_disc_is_the_cam(kind, swing):
    whole = face_text(kind, swing=swing)
    start, end = whole.index("[lift]"), whole.index("[spring]")
    whole = whole[:start] + '[lift]\nkind = "eccentric"\neccentricity = "4 mm"\n\n' + whole[end:]
    case = parse_case(whole)
    contour = case.contour(given_lift(case))
    x, y = contour.points(np.linspace(0.0, 6.0, 25))
    middle = contour.centroid()
    radius = case.base_circle + 0.004
    np.testing.assert_allclose(np.hypot(x - middle[0], y - middle[1]), radius, rtol=0, atol=1e-8)
    assert np.hypot(*middle) == pytest.approx(0.004, rel=1e-6)


def changed(kind, old, new):
    whole = face_text(kind)
    assert old in whole
    return whole.replace(old, new)


@pytest.mark.parametrize(("kind", "old", "new", "message"), [
    ("flat", 'offset = "5 mm"\n', "",
     "follower.face.offset = missing, must be given for a flat face along the arm"),
    ("flat", 'offset = "5 mm"', 'offset = "5 mm"\nradius = "20 mm"',
     "follower.face.offset = 5 mm, must be left out with follower.face.radius"),
    ("flat", 'offset = "5 mm"', 'offset = "5 N"', "follower.face.offset = 5 N"),
    ("flat", 'offset = "5 mm"', 'offset = "nan mm"', "follower.face.offset = nan"),
    ("flat", 'offset = "5 mm"', 'offset = "2000 mm"', "follower.face.offset = 2000 mm"),
    ("flat", 'offset = "5 mm"', 'offset = "75 mm"', "cam.prime_radius = 40 mm, must be < 35 mm"),
    ("flat", 'width = "44 mm"', 'width = "12 mm"',
     "follower.face.width = 12 mm, must be > "),
    ("flat", 'swing = "with"', 'swing = "with"\nstart_angle = "30 deg"', "left out"),
    ("curved", 'radius = "23.5 mm"', 'radius = "0 mm"', "follower.face.radius = 0 mm"),
    ("curved", 'radius = "23.5 mm"', 'radius = "61 mm"',
     "follower.face.radius = 61 mm, must be < cam.prime_radius"),
    ("curved", 'width = "24 mm"', 'width = "48 mm"', "follower.face.width = 48 mm, must be <= 47"),
    ("curved", 'thickness = "10 mm"', 'thickness = "2 mm"',
     "follower.face.thickness = 2 mm, must be > 3.2"),
    ("curved", "[lubricant]", '[roller]\nradius = "20 mm"\n\n[lubricant]', "roller"),
])  # fmt: skip
def test_contradictions_are_refused(kind, old, new, message):
    with pytest.raises(InputError) as refused:
        parse_case(changed(kind, old, new))
    assert message in str(refused.value)


def test_a_start_angle_beyond_the_cam_axis_is_refused():
    whole = re.sub(r"prime_radius = .*\n", "", face_text("flat"))
    whole = whole.replace('swing = "with"', 'swing = "with"\nstart_angle = "1 deg"')
    with pytest.raises(InputError, match=r"follower\.arm\.start_angle = 1 deg, must be such that"):
        parse_case(whole)


@pytest.mark.parametrize(("key", "value"), [("offset", "5 mm"), ("radius", "20 mm")])
def test_a_stem_has_a_plain_face(key, value):
    whole = face_text("flat").replace('offset = "5 mm"', f'{key} = "{value}"')
    start, end = whole.index("[follower]"), whole.index("[follower.face]")
    whole = whole[:start] + '[follower]\nkind = "flat"\nmass = "1.1 kg"\n\n' + whole[end:]
    with pytest.raises(InputError) as refused:
        parse_case(whole.replace('["arm"]', '["guides", "stem"]'))
    limit = 'left out, or follower.kind = "oscillating"'
    assert f"follower.face.{key} = {value}, must be {limit}" in str(refused.value)


def test_the_drawing_states_arm_and_face():
    lines = [each for kind in KINDS for each in notes_of(parse_case(face_text(kind)))]
    assert "face 5 mm from the pivot towards the cam" in lines
    assert "face of radius 23.5 mm about the end of the arm" in lines
    assert sum("95 mm to the end of the arm; arm at" in each for each in lines) == 2


@pytest.mark.parametrize("kind", KINDS)
def test_all_that_judges_a_face_judges_it_on_an_arm(kind):
    trial = previewed(kind)
    made = {each.id: each for each in trial.checks}
    assert not failed(trial) - {"contact_temperature"}
    judged = {"face_width", "face_pv", "contact_temperature", "bulk_temperature", "film_ratio",
              "contact_pressure", "undercut", "second_contact", "self_locking"}  # fmt: skip
    assert all(made[name].demand is not None for name in judged)
    of_round = {"pressure_angle", "curvature_ratio"}
    assert {name for name in of_round if name in made} == (of_round if kind == "curved" else set())
    assert not {name for name in made if name.startswith(("guide_", "jam_", "roller_"))}


def levers(contour):
    """Moments of a unit normal force and of a unit force against the sliding about the pivot, m.

    From points of the contour at 7201 cam angles; positive outwards, as the arm swings with the
    cam.
    """
    theta, step = np.linspace(0.0, 2.0 * np.pi, 7201), 1e-5
    pivot = 0.110 * np.stack([np.cos(theta), np.sin(theta)])
    lever = contour.points(theta) - pivot
    along = contour.points(theta + step) - contour.points(theta - step)
    tangent = along / np.hypot(*along)
    # the arm swings outwards clockwise: with the cam
    normal = -(lever[0] * -tangent[0] - lever[1] * tangent[1])
    rubbed = -(lever[0] * -tangent[1] - lever[1] * -tangent[0])
    return normal, -rubbed


@pytest.mark.parametrize("kind", KINDS)
def test_self_locking_by_moments_about_the_pivot(kind):
    """Of the friction along the contour over that of the normal, from points of the contour."""
    trial = previewed(kind)
    normal, rubbed = levers(trial.contour)
    (one,) = (each for each in trial.checks if each.id == "self_locking")
    assert one.demand == pytest.approx(float((0.05 * rubbed / normal).max()), rel=1e-5)


def with_pivot(kind):
    """Text of the case with a pivot of 16 mm that is described."""
    whole = face_text(kind).replace("[follower.face]\n", DESCRIBED, 1)
    return whole[: whole.index("[scope]")] + whole[whole.index("[lubricant]") :]


@pytest.mark.parametrize("kind", KINDS)
def test_self_locking_counts_the_friction_circle_of_the_pivot(kind):
    """By hand: the contact force sqrt(1 + mu^2) at the radius 0.3 of 8 mm, beside 0.05 of a face.

    Against a moment on the arm alone the axial force has a pole at an index of 1.
    """
    rubbing = {f"follower.pivot.bush.friction{end}": 0.3 for end in ("", "_min", "_max")}
    case = with_values(parse_case(with_pivot(kind)), rubbing).with_positions(90)
    trial = preview_case(case, corners=False)
    normal, rubbed = levers(trial.contour)
    circle = 0.3 * 0.008 * np.sqrt(1.0 + 0.05**2)
    (one,) = (each for each in trial.checks if each.id == "self_locking")
    by_hand = float(((0.05 * rubbed + circle) / normal).max())
    assert one.demand == pytest.approx(by_hand, rel=1e-5)
    machine, cam = trial.solution.machine, next(iter(trial.solution.cams.values()))
    pressed, pivot = Pressed.of(cam.motion), machine.arm_pivot
    left, none = 1.0 - cam.motion.lock, np.zeros(cam.slope.shape)
    for used, sign in ((0.999, 1.0), (1.001, -1.0)):
        friction = used * left / replace(pivot, friction=1.0).locking(pressed)
        held = replace(pivot, friction=friction).balanced(
            np.ones(cam.slope.shape), pressed, Pull(none, none), 1.0
        )
        np.testing.assert_allclose(sign * held.axial, 1e3 / left, rtol=1e-9)


def test_an_arm_and_a_pivot_that_are_described_are_judged_with_a_face():
    """No datum of a roller is missed; pivot and face alone lose work by their friction."""
    case = parse_case(with_pivot("flat"))
    trial = preview_case(case.with_positions(90), corners=False)
    assert not failed(trial)
    made = {each.id: each for each in trial.checks}
    assert {"arm_fatigue_pivot", "arm_yield", "data_arm", "data_pivot", "arm_gap"} <= made.keys()
    assert made["friction_balance"].demand < 1e-9
    # the pivot swings as the contour does: a weight or a linked spring acts at the true angle
    machine, theta = trial.solution.machine, np.linspace(0.0, 6.0, 7)
    pitch = trial.contour.pitch
    travel = machine.arm_pivot.direction(pitch.lift(theta))
    np.testing.assert_allclose(travel, pitch.travel(theta), rtol=1e-12)


def test_a_flat_face_twists_and_bends_its_arm_where_it_touches():
    """Normal force at its place: torsion by it, bending as of a beam with the load there."""
    whole = with_pivot("flat").replace(
        'depth = "24 mm"', 'depth = "24 mm"\nplane_offset = "10 mm"', 1
    )
    trial = preview_case(parse_case(whole).with_positions(90), corners=False)
    cam, machine = next(iter(trial.solution.cams.values())), trial.solution.machine
    bar, forces = machine.arm_bar, arm_forces(cam)
    normal, place = cam.normal, cam.motion.from_pivot
    assert np.ptp(place) > 0.005
    section = bar.pivot[-1]
    loads = bar.loads(section, forces)
    touched = normal > 0.0
    away = np.where(touched, cam.follower_moment, 0.0) / normal + 0.010
    np.testing.assert_allclose(loads.twisting, normal * away, rtol=1e-9)
    # beyond the section only the contact, the mass and, at the pivot, no spring
    still = forces._replace(inertia=0.0 * normal, closing=0.0 * normal)
    bent = bar.bending(section.distance, still)
    rub = forces.across * bar.length - normal * place  # moment of the friction of the face
    expected = normal * (place - section.distance) + rub
    np.testing.assert_allclose(bent, expected, rtol=1e-9)
    assert (np.sign(loads.sideways) == np.sign(forces.along)).all()


@pytest.mark.parametrize("kind", KINDS)
def test_the_screening_judges_faces_as_their_previews(kind):
    """Prime radius, rate, preload and friction as arrays, within the stated deviations."""
    case = parse_case(face_text(kind)).with_positions(180)
    base = case.cam.prime_radius
    factors = {
        "cam.prime_radius": np.array([base - 1e-3, base, base + 2e-3]),
        "spring.rate": np.array([100e3, 102e3, 98e3]),
        "spring.preload": np.array([900.0, 1000.0, 1100.0]),
        "follower.face.friction": np.array([0.04, 0.05, 0.06]),
    }
    columns = screen_designs(case, factors)
    compared = set()
    for k in range(3):
        own = replaced(case, {key: float(each[k]) for key, each in factors.items()})
        known = {each.id: each for each in preview_case(own, corners=False).checks}
        assert columns["message"][k] == ""
        for screened in SCREENED:
            one, column = known.get(screened.check), columns.get(f"{screened.check}.demand")
            if one is None or one.demand is None or column is None or np.isnan(column[k]):
                continue
            limit = 0.0 if one.limit is None else in_unit(one.limit, one.unit)
            demand = in_unit(one.demand, one.unit)
            away = abs(float(column[k]) - demand) / max(abs(demand), abs(limit), 1e-12)
            assert not away > screened.deviation, one.id
            compared.add(one.id)
    assert {"contact_pressure", "face_width", "face_pv", "self_locking", "undercut",
            "contact_temperature", "bulk_temperature"} <= compared  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("swing", ["with", "against"])
def test_the_drawn_face_touches_the_drawn_cam(kind, swing):
    """The contact of the drawing, turned back by the cam, is that of the contour; no corner of the
    drawn block is within the cam."""
    case = parse_case(face_text(kind, swing=swing))
    contour, theta, mm = case.contour(given_lift(case)), np.linspace(0.0, 6.0, 25), 1e3
    arm, face, radius = contour.pitch.arm, case.follower.face, case.follower.face.radius
    depth = face.offset if radius is None else radius
    drawn = DrawnArm(mm * arm.centre_distance, mm * arm.length, arm.sense, contour.pitch.start,
                     9.5, mm * depth, radius and mm * radius)  # fmt: skip
    block = mm * face.width, mm * face.thickness
    mechanism = DrawnMechanism(
        mm * contour.polygon(360), 15.0, None, None, 0.0, 0.0, 10.0, None, 0.0, block, 10.0, 50.0,
        (), None, 2.0, MechanismSizes(50.0, 15.0, 0.0, 50.0, 10.0, (22.0, 7.5), 10.0, 50.0, (), ()),
        None, drawn,
    )  # fmt: skip
    lift, alpha = mm * contour.lift(theta), contour.pitch.pressure_angle(theta)
    place = mm * contour.pitch.slide(theta).on_face
    motion = DrawnMotion("", theta, theta, "", lift, alpha, place, {"contact": np.ones(25)})
    touched = contact_point(mechanism, motion)
    for k, angle in enumerate(theta):
        turned = rotation(cam_turn(angle)) @ (mm * contour.points(angle))
        np.testing.assert_allclose(touched[:, k], turned, rtol=0, atol=1e-9)
        (swung,) = (g for g in drawing(mechanism, motion, k).groups if g.name == "follower")
        points = swung.pose.of(swung.shapes[1].lines[0])
        inside = rotation(-cam_turn(angle)) @ points
        polar = np.arctan2(inside[1], inside[0])
        rim = mm * contour.polygon(3600)
        order = np.argsort(np.arctan2(rim[1], rim[0]))
        reach = np.interp(polar, np.arctan2(rim[1], rim[0])[order], np.hypot(*rim)[order])
        assert (np.hypot(*inside) > reach - 1e-2).all()
    assert "face and arm on its pivot" in drawing(mechanism, motion, 7).alt
    across, along = mechanism.envelope.across, mechanism.envelope.along
    assert across[0] <= touched[0].min() and along[0] <= touched[1].min()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("swing", ["with", "against"])
def test_a_torque_is_balanced_by_a_face_on_an_arm(kind, swing):
    """The synthesis keeps all limits on the cam that the preview solves; sliding costs power."""
    trial = preview_case(parse_case(face_text(kind, "cylinder", swing)), corners=False)
    assert trial.synthesis is not None
    assert failed(trial) <= {"friction_power", "contact_temperature"}
    (ripple,) = (each for each in trial.checks if each.id == "torque_reduction")
    assert ripple.demand > 0.3


@pytest.mark.parametrize("kind", KINDS)
def test_the_block_of_a_face_is_within_its_swung_body(kind):
    """Distances of points about the cam from the drawn block at both ends of the swing."""
    case = parse_case(face_text(kind))
    contour = case.contour(given_lift(case))
    arm, face = contour.pitch.arm, case.follower.face
    depth = face.offset if face.radius is None else face.radius
    top = contour.lift.highest.value
    body = swung_bodies(Numbers({"arm.lift": top}, case))["face"]
    radius = face.radius or np.inf
    corners = np.array([
        (along, depth - max(deep, radius - np.sqrt(radius**2 - along**2) if face.radius else 0.0))
        for along in np.linspace(-0.5, 0.5, 41) * face.width
        for deep in np.linspace(0.0, face.thickness, 11)
    ])  # fmt: skip
    for u, v in np.random.default_rng(3).uniform(-0.15, 0.15, (40, 2)):
        near = np.inf
        for lift in (0.0, top):
            angle = contour.pitch.start + lift / arm.length
            along = np.array([-np.cos(angle), arm.sense * np.sin(angle)])
            towards = np.array([-np.sin(angle), -arm.sense * np.cos(angle)])
            points = (arm.length + corners[:, :1]) * along + corners[:, 1:] * towards
            near = min(near, np.hypot(*(points + np.array([arm.centre_distance - u, -v])).T).min())
        assert float(body.from_disc(u, v, 0.0)) <= near + 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_every_measure_is_differentiated_by_a_complex_step(kind):
    """Along a random change of the lift; the reference is a difference of fourth order.

    Where a magnitude has its kink within the step the difference is none: at few angles.
    """
    case = parse_case(face_text(kind))
    states = machines(case)
    numbers, draw = numbers_of(case, states), np.random.default_rng(5)
    theta, waves = np.arange(180) * (2.0 * np.pi / 180), ((2e-3, 1.0), (4e-4, 2.0), (1e-4, 3.0))
    jet = Jet(*(
        0.005 * (k == 0) + sum(size * n**k * np.cos(n * theta + n + 0.5 * np.pi * k)
                               for size, n in waves)
        for k in range(4)
    ))  # fmt: skip
    way = [draw.normal(size=180) * np.abs(each).max() for each in jet]
    tried = set()
    for one in CHECKS:
        how = one.measured
        if how is None or how.reduce in ("case", "top") or not one.concerns(states[0]):
            continue

        def at(step, measure=one.measure):
            moved = Jet(*(a + step * b for a, b in zip(jet, way, strict=True)))
            return measure(LoadedCam(moved, numbers, 0.008))

        exact, h = np.imag(at(1e-30j)) / 1e-30, 1e-4
        difference = fourth_order(at, h)
        scale = np.abs(exact).max() + 1e-4 * np.abs(at(0.0)).max() / h
        assert np.mean(np.abs(exact - difference) <= 1e-8 * scale) > 0.97, one.id
        tried.add(one.id)
    assert {"undercut", "contact_pressure", "face_width", "face_pv", "self_locking",
            "contact_force_margin"} <= tried  # fmt: skip
