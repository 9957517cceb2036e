"""Flat and curved faces on an arm against closed forms, differences and a search for the contact.

The references take nothing from the formulas of an arm: a circular disc, points of the contour, a
face lowered onto them, moments about pivot and shaft, and the translating face that a long arm is.
"""

from dataclasses import replace
from functools import cache, partial
from itertools import islice

import numpy as np
import pytest
from fourth_order import assert_complex_steps, fourth_order

from camwright.geometry.arm_face import (
    ArmFaceContour,
    ArmFaceMotion,
    ArmFacePath,
    CurvedFaceContour,
    CurvedFacePath,
    face_disc_lift,
)
from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import FULL_TURN, rotation, uniform_turn
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.measured_contour import inspected, real_contour
from camwright.pipeline.follower.flat_face_motion import face_motion
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    torque_on_cam,
    turn_integral,
)
from camwright.pipeline.follower.pivot_forces import ArmPivot
from camwright.pipeline.follower.spring import Spring

THETA = np.linspace(0.0, FULL_TURN, 97)
WITH, AGAINST = 1.0, -1.0
DISC, ECCENTRICITY, CENTRES = 0.040, 0.010, 0.090


def degrees(*values):
    return np.radians(np.array(values, dtype=float))


# --- A circular disc off its axis ---------------------------------------------------------------
def disc(offset=0.0, sense=AGAINST, length=0.070):
    """Cam of a flat face on an eccentric disc, by the tangent from the pivot to the disc."""
    theta = uniform_turn(720)
    along = CENTRES - ECCENTRICITY * np.cos(theta)
    across = -sense * ECCENTRICITY * np.sin(theta)
    angle = np.arctan2(across, along) + np.arcsin((DISC + offset) / np.hypot(along, across))
    start = float(angle.min())
    lift = Lift(theta, length * (angle - start))
    return ArmFaceContour(ArmFacePath(lift, Arm(CENTRES, length, sense), start, offset))


def test_disc_under_a_flat_face_through_the_pivot():
    cam, tried = disc(), degrees(0, 45, 90, 135, 180, 270)
    here = np.degrees(cam.pitch.start + cam.lift(tried) / 0.070)
    known = [30.0, 33.598016, 32.554257, 28.432738, 23.578178, 19.873874]
    np.testing.assert_allclose(here, known, rtol=0, atol=6e-7)
    known = [69.282032, 72.987724, 81.240384, 88.728756, 91.651514, 81.240384]
    place = cam.motion(cam.lift.jet(tried)).from_pivot
    np.testing.assert_allclose(1e3 * place, known, rtol=0, atol=6e-7)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
@pytest.mark.parametrize("offset", [-0.006, 0.0, 0.008])
def test_the_cam_under_the_face_is_the_disc(offset, sense):
    cam = disc(offset, sense)
    x, y = cam.points(THETA)
    np.testing.assert_allclose(np.hypot(x - ECCENTRICITY, y), DISC, rtol=0, atol=1e-12)
    np.testing.assert_allclose(cam.radius_of_curvature(THETA), DISC, rtol=1e-7)
    assert cam.area() == pytest.approx(np.pi * DISC**2, rel=1e-12)
    assert cam.second_contact().clearance > 0.0
    lift = face_disc_lift(ECCENTRICITY, DISC - ECCENTRICITY, cam.pitch.arm, offset)
    assert float(lift(0.0)) == pytest.approx(0.0, abs=1e-15)
    start = float(cam.pitch.arm.face_angle(DISC - ECCENTRICITY, offset))
    x, y = ArmFaceContour(ArmFacePath(lift, cam.pitch.arm, start, offset)).points(THETA)
    middle = -ECCENTRICITY * np.array([np.sin(start), sense * np.cos(start)])
    np.testing.assert_allclose(np.hypot(x - middle[0], y - middle[1]), DISC, rtol=0, atol=1e-12)


# --- Seeded faces in both senses ----------------------------------------------------------------
def seeded(number, kind):
    """A contour without undercut and second contact; None where the draw has none."""
    draw = np.random.default_rng([number, kind == "flat"])
    arm = Arm(distance := draw.uniform(0.06, 0.14), distance * draw.uniform(0.6, 1.1),
              (WITH, AGAINST)[number % 2])  # fmt: skip
    radius, swing = draw.uniform(0.4, 0.6) * distance, np.radians(draw.uniform(3.0, 12.0))
    theta = uniform_turn(720)
    waves = sum(
        draw.uniform(-1.0, 1.0) / k**4 * np.cos(k * theta + draw.uniform(0.0, FULL_TURN))
        for k in (1, 2, 3)
    )
    lift = Lift(theta, arm.length * swing * (waves - waves.min()) / np.ptp(waves))
    part = draw.uniform(-0.3, 0.3) * radius
    try:
        cam = on_arm(kind, lift, arm, radius, part)
        if cam.undercut().factor < 0.05 or cam.second_contact().clearance < 0.0:
            return None
    except InputError:
        return None
    return cam


def on_arm(kind, lift, arm, radius, part):
    """Cam of a base or prime radius; part: offset of a flat face, or size of a curved one."""
    if kind == "flat":
        start = float(arm.face_angle(radius, part))
        return ArmFaceContour(ArmFacePath(lift, arm, start, part))
    size = max(abs(part), 0.05 * radius)
    return CurvedFaceContour.of(CurvedFacePath(lift, arm, float(arm.angle(radius)), size))


@cache
def faces(kind, count=10):
    """The first contours of a kind that are one."""
    drawn = (cam for k in range(600) if (cam := seeded(k, kind)) is not None)
    return list(islice(drawn, count))


KINDS = ["flat", "curved"]


def first_contact(cam, theta, points):
    """Arm angle at which a face lowered onto points of the contour touches them first.

    In axes at rest, with the cam turned: the gap is the least distance of the points, with a
    parabola through the three nearest, below the plane of the face or from its centre.
    """
    arm = cam.pitch.arm
    x, y = rotation(-theta) @ points
    x = x - arm.centre_distance

    def gap(angle):
        cos, sin = np.cos(angle), arm.sense * np.sin(angle)
        if cam.follower_curvature:
            away = np.hypot(x + arm.length * cos, y - arm.length * sin) - cam.follower_radius
        else:  # outwards square to the arm
            away = -cam.pitch.offset - (x * np.sin(angle) + arm.sense * y * cos)
        k = int(np.argmin(away))
        before, here, after = away[k - 1], away[k], away[(k + 1) % away.size]
        return here - 0.125 * (after - before) ** 2 / (before - 2.0 * here + after)

    start = cam.pitch.start + float(cam.lift(theta)) / arm.length
    low, high = start - 0.02, start + 0.02
    for _ in range(45):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if gap(middle) > 0.0 else (middle, high)
    return high


def worst_return(cams):
    """Greatest error of the swing by the first contact, over the swing."""
    worst = 0.0
    for k, cam in enumerate(cams):
        points = cam.points(uniform_turn(14_400))
        arm, swing = cam.pitch.arm, cam.lift.stroke / cam.pitch.arm.length
        for theta in degrees(17.0 + 1.3 * k, 171.0 + 0.7 * k, 293.0 + 0.3 * k):
            known = cam.pitch.start + float(cam.lift(theta)) / arm.length
            worst = max(worst, abs(first_contact(cam, theta, points) - known) / swing)
    return worst


@pytest.mark.parametrize("kind", KINDS)
def test_the_contour_gives_the_swing_back(kind):
    cams = faces(kind)
    assert {cam.pitch.arm.sense for cam in cams} == {WITH, AGAINST}
    assert worst_return(cams) < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_hundred_contours_of_each_kind_give_the_swing_back(kind):
    cams = faces(kind, 100)
    senses = [cam.pitch.arm.sense for cam in cams]
    assert len(senses) == 100
    assert min(senses.count(sense) for sense in (WITH, AGAINST)) > 30
    assert worst_return(cams) < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_a_face_stands_on_the_points_at_its_swing(kind):
    for cam in faces(kind)[::3]:
        arc = cam.pitch.arm.length * cam.pitch.start + cam.lift(THETA)
        stands = cam.standing(cam.polygon(2880), THETA)
        np.testing.assert_allclose(stands, arc, rtol=0, atol=1e-6 * cam.lift.stroke)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_are_those_of_the_points(kind):
    step = 1e-4
    ahead, behind = THETA + step, THETA - step
    for cam in faces(kind):
        slope = (cam.points(ahead) - cam.points(behind)) / (2.0 * step)
        scale = np.abs(cam.speed(THETA)).max()
        np.testing.assert_allclose(cam.velocity(THETA), slope, rtol=0, atol=1e-6 * scale)
        slope = (cam.curvature(ahead) - cam.curvature(behind)) / (2.0 * step)
        scale = np.abs(slope).max()
        np.testing.assert_allclose(cam.curvature_slope(THETA), slope, rtol=0, atol=2e-5 * scale)


@pytest.mark.parametrize("kind", KINDS)
def test_the_contour_of_points_alone_has_the_curvature(kind):
    """Circle through three points, at two steps, whose limit is of fourth order."""
    for cam in faces(kind)[::3]:
        wide, fine = (circle(*(cam.points(THETA + k * h) for k in (-1.0, 0.0, 1.0)))
                      for h in (1e-3, 5e-4))  # fmt: skip
        limit = (4.0 * fine - wide) / 3.0
        scale = np.abs(limit).max()
        np.testing.assert_allclose(cam.curvature(THETA), limit, rtol=0, atol=1e-6 * scale)


def circle(a, b, c):
    """Curvature of the circle through three points."""
    u, v, w = b - a, c - b, c - a
    area = u[0] * v[1] - u[1] * v[0]
    return 2.0 * area / (np.hypot(*u) * np.hypot(*v) * np.hypot(*w))


@pytest.mark.parametrize("kind", KINDS)
def test_complex_steps_are_the_differences(kind):
    """Differences of fourth order in the step."""
    for cam in faces(kind)[::3]:
        assert_complex_steps(partial(rates, cam), cam.lift.jet(THETA), cam.lift.stroke)


def rates(cam, jet):
    motion = cam.motion(jet, 0.1)
    names = ("height", "pressure_angle", "path_speed", "sharpness", "gain", "side", "sliding",
             "contour_radius", "contour_speed", "lock", "pressing", "slip", "along_face", "on_face",
             "curvature_slope")  # fmt: skip
    return {name: np.asarray(getattr(motion, name), dtype=complex) for name in names}


# --- Forces -------------------------------------------------------------------------------------
def plain(kind, sense=WITH):
    """Face with a swing of 10 deg; a plane one lies 6 mm from the pivot, towards the cam."""
    theta = uniform_turn(720)
    lift = Lift(theta, 0.08 * np.radians(5.0) * (1.0 - np.cos(theta)))
    return on_arm(kind, lift, Arm(0.09, 0.08, sense), 0.04, 0.006)


def system(friction, mass=0.4):
    spring = Spring(rate=20e3, preload=150.0)
    return FollowerSystem(
        mass, spring, 0.1, 0.03, friction_a=0.0, friction_b=0.0, face_friction=friction
    )


BOTH = pytest.mark.parametrize(
    ("kind", "sense"), [(kind, sense) for kind in KINDS for sense in (WITH, AGAINST)]
)


@BOTH
@pytest.mark.parametrize("friction", [0.0, 0.12])
def test_forces_by_moments_about_pivot_and_shaft(kind, sense, friction):
    """Normal and friction of the face at the points of the contour, in the axes of the cam.

    The friction on the cam is against its motion relative to the face, both as rigid bodies.
    """
    cam, speed = plain(kind, sense), 60.0
    loads = follower_loads(cam.pitch, system(friction), speed, THETA)
    length, jet = cam.pitch.arm.length, cam.lift.jet(THETA)
    closing = (150.0 + 20e3 * jet.lift + 0.4 * speed**2 * jet.lift_d2) * length
    pivot = cam.pitch.arm.centre_distance * np.stack([np.cos(THETA), np.sin(THETA)])
    step = 1e-5
    point = cam.points(THETA)
    tangent = cam.points(THETA + step) - cam.points(THETA - step)
    tangent = tangent / np.hypot(*tangent)
    normal = np.stack([tangent[1], -tangent[0]])
    # relative to the cam the arm turns about the pivot, which moves about the cam axis
    turning = 1.0 - sense * jet.slope / length
    rubbed = turned(pivot) + turning * turned(point - pivot)
    slip = np.sum(rubbed * tangent, axis=0)
    np.testing.assert_allclose(np.sum(rubbed * normal, axis=0), 0.0, rtol=0, atol=1e-11)
    np.testing.assert_allclose(cam.pitch.slide(THETA).slip, slip, rtol=1e-9)
    push = normal - friction * np.sign(slip) * tangent  # on the face, over the normal force
    about = -sense * cross(point - pivot, push)
    np.testing.assert_allclose(loads.normal_force, closing / about, rtol=1e-9)
    on_cam = -loads.normal_force * push
    torque = cross(point, on_cam)
    scale = np.abs(torque).max()
    np.testing.assert_allclose(loads.cam_torque, torque, rtol=0, atol=1e-8 * scale)
    by_speed = torque_on_cam(cam.pitch, system(friction), THETA)
    held = by_speed(np.full(THETA.shape, speed), np.zeros(THETA.shape))
    inertia = 0.4 * speed**2 * jet.lift_d2 * jet.slope
    np.testing.assert_allclose(-held, torque - inertia, rtol=0, atol=1e-8 * scale)
    along = np.cos(THETA) * on_cam[0] + np.sin(THETA) * on_cam[1]
    across = np.sin(THETA) * on_cam[0] - np.cos(THETA) * on_cam[1]
    most = 1e-9 * loads.normal_force.max()
    np.testing.assert_allclose(-loads.on_shaft, [along, across], rtol=0, atol=most)
    jam = friction * np.abs(slip) * loads.normal_force  # power of friction over cam speed
    np.testing.assert_allclose(loads.friction_power / speed, jam, rtol=1e-9, atol=1e-12)


@BOTH
def test_a_face_and_the_pivot_rub_together(kind, sense):
    """Moments about the pivot with the friction of both; the reaction by the sum of the forces."""
    cam, speed = plain(kind, sense), 60.0
    path, theta = cam.pitch, uniform_turn(720)
    pivot = ArmPivot(path.arm.length, sense, path.start, 0.012, 0.2, 0.0, 0.08, 0.0, None, 0.08,
                     0.0, 0.0)  # fmt: skip
    loads = follower_loads(path, replace(system(0.12), pivot=pivot), speed, theta)
    arm, jet = path.arm, cam.lift.jet(theta)
    angle = path.start + jet.lift / arm.length
    u, v = (np.stack([np.cos(theta + k), np.sin(theta + k)]) for k in (0.0, 0.5 * np.pi))
    along = -np.cos(angle) * u + sense * np.sin(angle) * v  # from the pivot along the arm
    travel = np.sin(angle) * u + sense * np.cos(angle) * v
    normal = cam.normal(theta)
    push = loads.normal_force * (normal - 0.12 * turned(normal))
    spring = -(150.0 + 20e3 * jet.lift) * travel
    reaction = np.hypot(*(push + spring))
    np.testing.assert_allclose(np.hypot(*loads.pivot_load), reaction, rtol=1e-10)
    lever = cam.points(theta) - arm.centre_distance * u
    moment = -sense * (cross(lever, push) + arm.length * cross(along, spring))
    resisted = 0.4 * speed**2 * jet.lift_d2 * arm.length
    resisted = resisted + np.sign(loads.lift_slope) * 0.2 * 0.012 * reaction
    scale = np.abs(moment).max()
    np.testing.assert_allclose(moment, resisted, rtol=0, atol=1e-10 * scale)
    work = turn_integral(theta, loads.cam_torque)
    assert work == pytest.approx(loads.friction_loss, rel=1e-9)
    rubbed = 0.2 * 0.012 * reaction * np.abs(jet.slope) / arm.length
    rubbed = rubbed + 0.12 * loads.normal_force * path.slide(theta).slip
    assert work == pytest.approx(turn_integral(theta, rubbed), rel=1e-9)


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def turned(a):
    """A quarter turn counter-clockwise."""
    return np.stack([-a[1], a[0]])


@BOTH
def test_cam_and_spring_exchange_their_energy(kind, sense):
    cam, theta = plain(kind, sense), uniform_turn(720)
    loads = follower_loads(cam.pitch, system(0.0, mass=0.0), 0.0, theta)

    def energy(by):
        lift = cam.lift(theta + by)
        return 150.0 * lift + 10e3 * lift**2

    rate = fourth_order(energy, 1e-3)
    scale = np.abs(rate).max()
    np.testing.assert_allclose(loads.cam_torque, rate, rtol=0, atol=1e-9 * scale)


@BOTH
def test_the_work_of_a_turn_is_that_of_the_friction(kind, sense):
    cam, theta, speed = plain(kind, sense), uniform_turn(720), 60.0
    loads = follower_loads(cam.pitch, system(0.12), speed, theta)
    work = turn_integral(theta, loads.cam_torque)
    assert work == pytest.approx(loads.friction_loss, rel=1e-9)
    moving = face_motion(cam.pitch, speed, theta)
    rubbed = 0.12 * loads.normal_force * moving.sliding / speed
    assert work == pytest.approx(turn_integral(theta, rubbed), rel=1e-9)


@BOTH
def test_the_contact_runs_by_the_lengths_of_both_surfaces(kind, sense):
    """Entrainment is the mean speed of the contact along the cam and along the face."""
    cam, speed, step = plain(kind, sense), 50.0, 1e-5
    motion = face_motion(cam.pitch, speed, THETA)

    def along_face(theta):
        """Arc on the face in its own axes, from the place of the contact."""
        place = cam.pitch.slide(theta).on_face
        radius = getattr(cam, "follower_radius", None)
        return place if radius is None else radius * np.arcsin(place / radius)

    passed = (along_face(THETA + step) - along_face(THETA - step)) / (2.0 * step)
    if kind == "curved":  # a place ahead is one behind the centre
        assert np.abs(passed).max() > 0.0
    along_cam = cam.speed(THETA)
    entrained = np.abs(0.5 * speed * (along_cam + passed))
    np.testing.assert_allclose(motion.entrainment, entrained, rtol=0, atol=1e-8)
    np.testing.assert_allclose(motion.sliding, speed * (along_cam - passed), rtol=1e-7)


def test_a_flat_face_far_before_the_pivot_locks():
    """The friction mu N f takes what the lever q of the normal force gives."""
    theta = uniform_turn(720)
    lift = Lift(theta, 0.03 * np.radians(4.0) * (1.0 - np.cos(theta)))
    arm, offset = Arm(0.09, 0.03, WITH), 0.06
    cam = ArmFaceContour(ArmFacePath(lift, arm, float(arm.face_angle(0.022, offset)), offset))
    lever = cam.motion(lift.jet(theta)).from_pivot
    least = float((lever / offset).min())
    held = follower_loads(cam.pitch, system(0.98 * least), 0.0, theta)
    assert held.end is None
    assert held.lock.max() == pytest.approx(0.98, rel=1e-9)
    locked = follower_loads(cam.pitch, system(1.02 * least), 0.0, theta)
    assert locked.end is not None
    assert locked.end[1] == "locks"
    other = ArmFaceContour(
        ArmFacePath(lift, Arm(0.09, 0.03, AGAINST), cam.pitch.start, offset)
    )  # there the friction pulls the face off
    assert (follower_loads(other.pitch, system(1.02 * least), 0.0, theta).lock < 0.0).all()


# --- A long arm is a translating face -----------------------------------------------------------
LONG = 1e3
EXAMPLE = Lift(uniform_turn(720), 0.005 * (1.0 - np.cos(uniform_turn(720))) ** 2 / 2.0)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
@pytest.mark.parametrize("offset", [0.0, 0.002])
def test_a_long_arm_is_a_translating_flat_face(sense, offset):
    stem = FlatFaceContour(FacePath(EXAMPLE, 0.05, offset))
    # square to the stem in the middle of the lift
    raised, beside = 0.5 * EXAMPLE.stroke, LONG - sense * offset
    middle = float(np.arctan2(0.05 + raised, beside))
    arm = Arm(float(np.hypot(0.05 + raised, beside)), LONG, sense)
    long = ArmFaceContour(ArmFacePath(EXAMPLE, arm, middle - raised / LONG))
    turn = rotation(-sense * (0.5 * np.pi - middle))
    away = normal_distance(stem, turn @ long.points(THETA))
    assert np.abs(away).max() < 1e-7
    np.testing.assert_allclose(
        long.pitch.slide(THETA).on_face, stem.pitch.push_arm(THETA), rtol=0, atol=1e-6
    )
    ours, theirs = (follower_loads(c.pitch, system(0.1), 60.0, THETA) for c in (long, stem))
    scale = np.abs(theirs.cam_torque).max()
    np.testing.assert_allclose(ours.normal_force, theirs.normal_force, rtol=1e-5)
    np.testing.assert_allclose(ours.cam_torque, theirs.cam_torque, rtol=0, atol=1e-5 * scale)


def normal_distance(cam, points):
    """Distance of points from a contour along its normal, m."""
    theta = np.unwrap(np.arctan2(points[1], points[0]))
    for _ in range(60):
        frame = cam.local_frame(theta)
        theta = theta + np.sum((points - frame.point) * frame.tangent, axis=0) / cam.speed(theta)
    frame = cam.local_frame(theta)
    return np.sum((points - frame.point) * frame.normal, axis=0)


# --- What works on any contour ------------------------------------------------------------------
def test_a_curved_face_leaves_the_cam_of_the_roller_of_its_radius():
    cam = plain("curved")
    path = ArmPath(cam.lift, cam.pitch.arm, cam.pitch.start)
    roller = ArmContour(path, cam.follower_radius)
    np.testing.assert_array_equal(cam.points(THETA), roller.points(THETA))
    np.testing.assert_array_equal(cam.curvature_slope(THETA), roller.curvature_slope(THETA))
    assert roller.rolls
    assert not cam.rolls
    with pytest.raises(GeometryError, match="CurvedFaceContour"):
        cam.require_roller()


@pytest.mark.parametrize("kind", KINDS)
def test_tools_for_contours_take_it(kind):
    cam = plain(kind)
    xi = np.array([-1e-4, 0.0, 1e-4])
    bend = -0.5 * cam.curvature(THETA)[:, None] * xi**2
    skew = cam.curvature_slope(THETA) / cam.speed(THETA) / cam.curvature(THETA)
    limit = 2e-4 * np.abs(skew).max() + 1e-5  # the cubic term over the quadratic one
    np.testing.assert_allclose(cam.surface_offset(THETA, xi), bend, rtol=limit, atol=1e-15)
    tool = cutter_path(cam, 0.01, THETA).centre
    np.testing.assert_allclose(tool, cam.points(THETA) + 0.01 * cam.normal(THETA), atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_a_measured_cam_is_recovered(kind):
    cam = plain(kind)
    fit = inspected(cam, rotation(0.2) @ cam.polygon(720))
    assert fit.phase == pytest.approx(0.2, abs=1e-8)
    real = real_contour(cam, fit)
    np.testing.assert_allclose(real.lift(THETA), cam.lift(THETA), rtol=0, atol=1e-8)
    assert real.pitch.start == pytest.approx(cam.pitch.start, abs=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_cam_grown(kind):
    path = plain(kind).pitch
    assert path.enlarged(1e-4).radius_base == pytest.approx(path.radius_base + 1e-4, rel=1e-12)


def test_the_width_of_a_face_covers_its_contact():
    cam = plain("flat")
    place = cam.pitch.slide(uniform_turn(20_000)).on_face
    assert cam.face_width_min() == pytest.approx(2.0 * np.abs(place).max(), rel=1e-7)
    with pytest.raises(InputError, match=r"follower\.face\.width = .* from the end of the arm"):
        cam.require_face(0.99 * cam.face_width_min())
    round_one = plain("curved")
    alpha = np.abs(round_one.pitch.pressure_angle(uniform_turn(20_000))).max()
    chord = 2.0 * round_one.follower_radius * np.sin(alpha)
    assert round_one.face_width_min() == pytest.approx(chord, rel=1e-7)


@pytest.mark.parametrize(("swing", "start", "offset", "field"), [
    (10.0, 85.0, 0.0, "< 90 deg"), (10.0, np.nan, 0.0, "none"),
    (10.0, 20.0, 0.05, "height of the face"), (80.0, 5.0, 0.0, "rad/rad"),
])  # fmt: skip
def test_a_flat_face_out_of_reach_is_refused(swing, start, offset, field):
    theta = uniform_turn(720)
    lift = Lift(theta, 0.08 * np.radians(0.5 * swing) * (1.0 - np.cos(2.0 * theta)))
    with pytest.raises(InputError, match=field):
        ArmFacePath(lift, Arm(0.1, 0.08, WITH), np.radians(start), offset)


def test_motion_of_many_designs_has_their_shape():
    cam = plain("flat")
    jet = cam.lift.jet(THETA)
    starts = np.array([[0.4], [0.5]])
    motion = ArmFaceMotion(jet, cam.pitch.arm, starts, 0.006, 0.1)
    assert motion.radius_at(np.zeros((2, 1))).shape == (2, THETA.size)
    assert motion.contour_radius.shape == (2, THETA.size)
