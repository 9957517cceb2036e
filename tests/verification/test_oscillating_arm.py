"""Oscillating arms against closed forms, differences, and a search for the first contact.

The references take nothing from the formulas of an arm: a circular disc, points of the contour, an
arm lowered onto them, and the translating follower that a long arm is.
"""

from functools import cache, partial
from itertools import islice

import numpy as np
import pytest
from cam_parts import mesh_area
from fourth_order import assert_complex_steps, fourth_order

from camwright.geometry.arc_polyline import arc_polyline
from camwright.geometry.arm_path import Arm, ArmContour, ArmMotion, ArmPath, disc_lift
from camwright.geometry.arrays import FULL_TURN, rotation, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import greatest
from camwright.geometry.lift import Jet, Lift
from camwright.geometry.measured_contour import inspected, real_contour
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import cam_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.follower.follower_forces import (
    FollowerSystem,
    follower_loads,
    turn_integral,
)
from camwright.pipeline.follower.roller_motion import roller_motion
from camwright.pipeline.follower.spring import Spring

THETA = np.linspace(0.0, FULL_TURN, 97)
WITH, AGAINST = 1.0, -1.0
DISC, ECCENTRICITY, CENTRES = 0.040, 0.010, 0.090


def degrees(*values):
    return np.radians(np.array(values, dtype=float))


# --- A roller under a modified sine -------------------------------------------------------------
SINE = SegmentMotion((
    Segment("modified_sine", np.radians(30.0), 0.075 * 3.0 / 80.0),
    Segment("dwell", np.radians(160.0)),
    Segment("modified_sine", np.radians(30.0), -0.075 * 3.0 / 80.0),
    Segment("dwell", np.radians(140.0)),
))  # fmt: skip
SINE_ARM = Arm(0.080, 0.075, AGAINST)


def exact(theta):
    """Motion of the roller under the law itself, without its spline."""
    jet = Jet(*(SINE(theta, order) for order in range(4)))
    return ArmMotion(jet, SINE_ARM, np.radians(30.0), 0.010)


@pytest.mark.parametrize(("angle", "x", "y"), [
    (0.0, -11.323929288, 28.219343134), (10.0, -18.051262325, 25.503119432),
    (15.0, -21.022295772, 24.247630277), (20.0, -23.303998403, 23.023823304),
    (30.0, -26.314036939, 20.219275227), (205.0, 21.968987597, -23.451507635),
])  # fmt: skip
def test_contour_of_a_modified_sine(angle, x, y):
    cam = ArmContour(ArmPath(SINE.lift(), SINE_ARM, np.radians(30.0)), 0.010)
    # the table has the pivot at -x
    at = -1e3 * cam.points(np.radians(angle))
    np.testing.assert_allclose(at, [x, y], rtol=0, atol=1.5e-9)  # the last digit


def test_pressure_angle_and_curvature_of_a_modified_sine():
    alpha = np.degrees(exact(degrees(0.0, 10.0, 15.237, 205.733)).pressure_angle)
    np.testing.assert_allclose(alpha, [8.135271, 18.844259, 21.102916, -4.167741], atol=6e-7)
    most = greatest(lambda theta: np.abs(exact(theta).pressure_angle), 5760)
    assert np.degrees(most.theta) == pytest.approx(15.237, abs=6e-4)
    radius = 1e3 / exact(degrees(0.0, 20.0)).path_curvature
    np.testing.assert_allclose(radius, [40.406623, 24.222435], rtol=0, atol=6e-7)
    sharpest = greatest(lambda theta: exact(theta).path_curvature, 5760)
    assert 1e3 / sharpest.value == pytest.approx(18.487752, abs=6e-7)
    assert np.degrees(sharpest.theta) == pytest.approx(194.335, abs=1e-3)


def test_a_law_in_closed_form():
    arm, start, size = Arm(0.080, 0.060, AGAINST), np.radians(30.0), 0.010
    swing = np.radians(5.0)

    def motion(a):
        jet = Jet(
            0.06 * swing * (1.0 - np.cos(2.0 * a)), 0.12 * swing * np.sin(2.0 * a),
            0.24 * swing * np.cos(2.0 * a), -0.48 * swing * np.sin(2.0 * a),
        )  # fmt: skip
        return ArmMotion(jet, arm, start, size)

    fine = np.linspace(0.0, FULL_TURN, 200_001)
    alpha = np.degrees(motion(fine).pressure_angle)
    assert -alpha.min() == pytest.approx(21.04685, abs=6e-6)
    assert alpha.max() == pytest.approx(6.80992, abs=6e-6)
    radius = 1e3 * (1.0 / motion(fine).path_curvature - size)
    assert radius.min() == pytest.approx(26.5563, abs=6e-5)
    assert radius.max() == pytest.approx(72.587, abs=6e-4)
    assert 1e3 * motion(fine).contour_radius.min() == pytest.approx(31.06283, abs=6e-6)


# --- A circular disc off its axis ---------------------------------------------------------------
def on_a_disc(beyond):
    """Arm angle over the turn: the disc's centre is e from the axis, along it at cam angle 0."""
    theta = uniform_turn(720)
    along = CENTRES - ECCENTRICITY * np.cos(theta)
    across = ECCENTRICITY * np.sin(theta)
    angle = np.arctan2(across, along) + beyond(np.hypot(along, across))
    return theta, angle


def rolled(radius, length):
    def beyond(distance):
        cosine = distance**2 + length**2 - (DISC + radius) ** 2
        return np.arccos(cosine / (2.0 * distance * length))

    return on_a_disc(beyond)


def swung(theta, angle, length, made):
    start = float(angle.min())
    return made(Lift(theta, length * (angle - start)), Arm(CENTRES, length, AGAINST), start)


TRIED = degrees(0, 45, 90, 135, 180, 270)


def test_disc_under_a_roller():
    theta, angle = rolled(0.012, 0.070)
    cam = swung(theta, angle, 0.070, lambda *path: ArmContour(ArmPath(*path), 0.012))
    here = np.degrees(cam.pitch.start + cam.lift(TRIED) / 0.070)
    known = [39.870081, 43.341092, 41.252098, 35.255455, 29.408280, 28.571715]
    np.testing.assert_allclose(here, known, rtol=0, atol=6e-7)
    known = [9.519578, 5.334260, 4.695954, 14.874473, 19.215425, 4.695954]
    alpha = np.degrees(cam.pitch.pressure_angle(TRIED))
    np.testing.assert_allclose(np.abs(alpha), known, rtol=0, atol=6e-7)
    is_the_disc(cam)


def is_the_disc(cam):
    x, y = cam.points(THETA)
    np.testing.assert_allclose(np.hypot(x - ECCENTRICITY, y), DISC, rtol=0, atol=1e-12)
    np.testing.assert_allclose(cam.radius_of_curvature(THETA), DISC, rtol=1e-8)
    assert cam.area() == pytest.approx(np.pi * DISC**2, rel=1e-12)


# --- Seeded arms in both senses -----------------------------------------------------------------
FEW = 50
COUNTS = [FEW, pytest.param(200, marks=pytest.mark.slow)]


def seeded(number):
    """A contour without undercut under the roller of an arm; None where the draw has none."""
    draw = np.random.default_rng(number)
    sense = (WITH, AGAINST)[number % 2]
    distance = draw.uniform(0.06, 0.14)
    length = distance * draw.uniform(0.7, 1.1)
    radius = draw.uniform(0.4, 0.6) * distance
    swing = np.radians(draw.uniform(3.0, 15.0))
    theta = uniform_turn(720)
    waves = sum(
        draw.uniform(-1.0, 1.0) / k**3 * np.cos(k * theta + draw.uniform(0.0, FULL_TURN))
        for k in (1, 2, 3)
    )
    lift = Lift(theta, length * swing * (waves - waves.min()) / np.ptp(waves))
    arm = Arm(distance, length, sense)
    try:
        size = draw.uniform(0.1, 0.4) * radius
        cam = ArmContour(ArmPath(lift, arm, float(arm.angle(radius))), size)
        if cam.undercut().factor < 0.05 or cam.second_contact().clearance < 0.0:
            return None
    except InputError:
        return None
    return cam


@cache
def arms(count):
    cams = (cam for number in range(420) if (cam := seeded(number)) is not None)
    return list(islice(cams, count))


@pytest.mark.parametrize("count", COUNTS)
def test_arms_swing_in_both_senses(count):
    senses = [cam.pitch.arm.sense for cam in arms(count)]
    assert len(senses) == count
    assert min(senses.count(sense) for sense in (WITH, AGAINST)) > 0.3 * count


def first_contact(cam, theta, points):
    """Arm angle at which an arm lowered onto points of the contour touches them first.

    In axes that are at rest: the cam is turned, the arm stands. The gap at an arm angle is the
    least distance of the points, with a parabola through the three nearest, from the end.
    """
    arm = cam.pitch.arm
    x, y = rotation(-theta) @ points
    pivot = np.array([arm.centre_distance, 0.0])

    def gap(angle):
        along = np.array([-np.cos(angle), arm.sense * np.sin(angle)])
        end = pivot + arm.length * along
        away = np.hypot(x - end[0], y - end[1]) - cam.follower_radius
        k = int(np.argmin(away))
        before, here, after = away[k - 1], away[k], away[(k + 1) % away.size]
        bend = before - 2.0 * here + after
        return here - 0.125 * (after - before) ** 2 / bend

    start = cam.pitch.start + float(cam.lift(theta)) / arm.length
    low, high = start - 0.02, start + 0.02
    for _ in range(45):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if gap(middle) > 0.0 else (middle, high)
    return high


@pytest.mark.parametrize("count", COUNTS)
def test_the_contour_gives_the_swing_back(count):
    worst = 0.0
    for k, cam in enumerate(arms(count)):
        points = cam.points(uniform_turn(14_400))
        arm, swing = cam.pitch.arm, cam.lift.stroke / cam.pitch.arm.length
        for theta in degrees(17.0 + 1.3 * k, 171.0 + 0.7 * k, 293.0 + 0.3 * k):
            known = cam.pitch.start + float(cam.lift(theta)) / arm.length
            worst = max(worst, abs(first_contact(cam, theta, points) - known) / swing)
    assert worst < 1e-6


def test_derivatives_are_those_of_the_points():
    step = 1e-4
    ahead, behind = THETA + step, THETA - step
    for cam in arms(FEW):
        slope = (cam.points(ahead) - cam.points(behind)) / (2.0 * step)
        scale = np.abs(cam.speed(THETA)).max()
        np.testing.assert_allclose(cam.velocity(THETA), slope, rtol=0, atol=1e-6 * scale)
        before, after = cam.tangent(behind), cam.tangent(ahead)
        turned = np.arcsin(before[0] * after[1] - before[1] * after[0]) / (2.0 * step)
        bend = cam.curvature(THETA) * cam.speed(THETA)
        np.testing.assert_allclose(bend, turned, rtol=1e-6, atol=1e-6)
        slope = (cam.curvature(ahead) - cam.curvature(behind)) / (2.0 * step)
        scale = np.abs(slope).max()
        np.testing.assert_allclose(cam.curvature_slope(THETA), slope, rtol=0, atol=2e-5 * scale)


def test_the_contour_of_points_alone_has_the_curvature():
    """Circle through three points, each 1e-3 rad from the next."""
    for cam in arms(FEW)[::5]:
        a, b, c = (cam.points(THETA + step) for step in (-1e-3, 0.0, 1e-3))
        u, v, w = b - a, c - b, c - a
        area = u[0] * v[1] - u[1] * v[0]
        circle = 2.0 * area / (np.hypot(*u) * np.hypot(*v) * np.hypot(*w))
        shorter = [cam.points(THETA + step) for step in (-5e-4, 0.0, 5e-4)]
        u, v, w = shorter[1] - shorter[0], shorter[2] - shorter[1], shorter[2] - shorter[0]
        area = u[0] * v[1] - u[1] * v[0]
        finer = 2.0 * area / (np.hypot(*u) * np.hypot(*v) * np.hypot(*w))
        limit = (4.0 * finer - circle) / 3.0  # of second order in the step
        scale = np.abs(limit).max()
        np.testing.assert_allclose(cam.curvature(THETA), limit, rtol=0, atol=1e-6 * scale)


def test_complex_steps_are_the_differences():
    """Differences of fourth order in the step."""
    for cam in arms(FEW)[::3]:
        assert_complex_steps(partial(rates, cam), cam.lift.jet(THETA), cam.lift.stroke)


def rates(cam, jet):
    motion = cam.motion(jet)
    names = ("height", "pressure_angle", "path_curvature", "sharpness", "gain", "side", "sliding",
             "contour_radius", "contour_speed", "rolling")  # fmt: skip
    return {name: np.asarray(getattr(motion, name), dtype=complex) for name in names}


def plain(sense=WITH):
    """Arm of a roller with a swing of 15 deg."""
    theta = uniform_turn(720)
    lift = Lift(theta, 0.08 * np.radians(7.5) * (1.0 - np.cos(theta)))
    return ArmContour(ArmPath(lift, Arm(0.09, 0.08, sense), np.radians(35.0)), 0.008)


def system():
    spring = Spring(rate=20e3, preload=150.0)
    return FollowerSystem(0.4, spring, 0.1, 0.03, friction_a=0.0, friction_b=0.0)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_contact_force_and_torque_by_moments_about_pivot_and_shaft(sense):
    """Of spring and inertia about the pivot, with levers from the points of the contour."""
    cam, speed = plain(sense), 60.0
    loads = follower_loads(cam.pitch, system(), speed, THETA)
    length, jet = cam.pitch.arm.length, cam.lift.jet(THETA)
    closing = (150.0 + 20e3 * jet.lift + 0.4 * speed**2 * jet.lift_d2) * length
    pivot = cam.pitch.arm.centre_distance * np.stack([np.cos(THETA), np.sin(THETA)])
    frame = cam.local_frame(THETA)
    lever = frame.point - pivot
    about = lever[0] * frame.normal[1] - lever[1] * frame.normal[0]
    np.testing.assert_allclose(loads.normal_force, -sense * closing / about, rtol=1e-11)
    on_cam = -loads.normal_force * frame.normal
    torque = frame.point[0] * on_cam[1] - frame.point[1] * on_cam[0]
    scale = np.abs(torque).max()
    np.testing.assert_allclose(loads.cam_torque, torque, rtol=0, atol=1e-11 * scale)
    # the shaft carries the same force: along the line of centres, and across it clockwise
    along = np.cos(THETA) * on_cam[0] + np.sin(THETA) * on_cam[1]
    across = np.sin(THETA) * on_cam[0] - np.cos(THETA) * on_cam[1]
    np.testing.assert_allclose(-loads.on_shaft, [along, across], rtol=0, atol=1e-8)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_cam_and_spring_exchange_their_energy(sense):
    cam = plain(sense)
    theta = uniform_turn(720)
    loads = follower_loads(cam.pitch, system(), 0.0, theta)
    energy = 150.0 * loads.lift + 10e3 * loads.lift**2
    assert turn_integral(theta, loads.cam_torque) == pytest.approx(0.0, abs=1e-9 * energy.max())

    def stored(by):
        lift = cam.lift(theta + by)
        return 150.0 * lift + 10e3 * lift**2

    rate = fourth_order(stored, 1e-3)
    np.testing.assert_allclose(loads.cam_torque, rate, rtol=0, atol=1e-9 * np.abs(rate).max())


@pytest.mark.parametrize("sense", [WITH, AGAINST])
def test_the_roller_turns_by_the_paths_in_contact(sense):
    """Its turn on the arm over a cam turn is the length of the contour over its radius, less the
    turns that the arm makes in the cam frame; its acceleration is the change of its speed."""
    cam, radius = plain(sense), plain().follower_radius
    theta, step = uniform_turn(720), 1e-5
    motion = roller_motion(cam.pitch, radius, 50.0, theta)
    turned = float(motion.spin.mean()) / 50.0
    assert turned == pytest.approx((cam.perimeter() / FULL_TURN + radius) / radius - 1.0, rel=1e-7)
    before, after = (roller_motion(cam.pitch, radius, 50.0, theta + h).spin for h in (-step, step))
    change = 50.0 * (after - before) / (2.0 * step)
    scale = np.abs(change).max()
    np.testing.assert_allclose(motion.spin_acceleration, change, rtol=0, atol=1e-7 * scale)


def test_an_eccentric_disc_under_an_arm():
    arm = Arm(CENTRES, 0.070, WITH)
    lift = disc_lift(ECCENTRICITY, 0.042, arm)
    cam = ArmContour(ArmPath(lift, arm, float(arm.angle(0.042))), 0.012)
    x, y = cam.points(THETA)
    middle = cam.centroid()
    np.testing.assert_allclose(np.hypot(x - middle[0], y - middle[1]), DISC, rtol=0, atol=1e-9)
    assert np.hypot(*middle) == pytest.approx(ECCENTRICITY, rel=1e-9)
    assert float(lift(0.0)) == pytest.approx(0.0, abs=1e-15)
    with pytest.raises(InputError, match=r"lift\.eccentricity"):
        disc_lift(0.07, 0.05, arm)


# --- A long arm is a translating follower -------------------------------------------------------
LONG = 1e3
EXAMPLE = Lift(uniform_turn(720), 0.005 * (1.0 - np.cos(uniform_turn(720))) ** 2 / 2.0)


@pytest.mark.parametrize("sense", [WITH, AGAINST])
@pytest.mark.parametrize("offset", [0.0, 0.007])
def test_a_long_arm_is_a_translating_roller(sense, offset):
    stem = RollerContour(PitchCurve(EXAMPLE, 0.05, offset), 0.012)
    height, beside = stem.pitch.height_base, LONG - sense * offset
    start = float(np.arctan2(height, beside))
    arm = Arm(float(np.hypot(height, beside)), LONG, sense)
    long = ArmContour(ArmPath(EXAMPLE, arm, start), 0.012)
    away = normal_distance(stem, rotation(-sense * (0.5 * np.pi - start)) @ long.points(THETA))
    assert np.abs(away).max() < 1e-7
    jet = EXAMPLE.jet(THETA)
    ours, theirs = long.motion(jet), stem.motion(jet)
    np.testing.assert_allclose(ours.gain, theirs.gain, rtol=1e-5)
    np.testing.assert_allclose(ours.tangent, theirs.tangent, rtol=0, atol=2e-5)
    np.testing.assert_allclose(ours.rolling, theirs.rolling, rtol=1e-4)
    ours, theirs = (follower_loads(c.pitch, system(), 60.0, THETA) for c in (long, stem))
    np.testing.assert_allclose(ours.normal_force, theirs.normal_force, rtol=1e-5)
    np.testing.assert_allclose(ours.cam_torque, theirs.cam_torque, rtol=1e-12)


def normal_distance(cam, points):
    """Distance of points from a contour along its normal, m."""
    theta = np.unwrap(np.arctan2(points[1], points[0]))
    for _ in range(60):
        frame = cam.local_frame(theta)
        theta = theta + np.sum((points - frame.point) * frame.tangent, axis=0) / cam.speed(theta)
    frame = cam.local_frame(theta)
    return np.sum((points - frame.point) * frame.normal, axis=0)


# --- What works on any contour ------------------------------------------------------------------
CAM = plain()


def test_an_arm_at_rest_leaves_a_circle():
    still = Lift(uniform_turn(720), np.zeros(720))
    cam = ArmContour(ArmPath(still, CAM.pitch.arm, CAM.pitch.start), CAM.follower_radius)
    radius = cam.pitch.radius_base - CAM.follower_radius
    assert cam.area() == pytest.approx(np.pi * radius**2, rel=1e-12)
    np.testing.assert_allclose(cam.curvature(THETA), 1.0 / radius, rtol=1e-12)
    jet = still.jet(THETA)
    np.testing.assert_allclose(cam.motion(jet).radius_at(0.0), radius, rtol=1e-12)


def test_tools_for_contours_take_it():
    xi = np.array([-1e-4, 0.0, 1e-4])
    bend = -0.5 * CAM.curvature(THETA)[:, None] * xi**2
    skew = CAM.curvature_slope(THETA) / CAM.speed(THETA) / CAM.curvature(THETA)
    limit = 2e-4 * np.abs(skew).max() + 1e-5  # the cubic term over the quadratic one
    np.testing.assert_allclose(CAM.surface_offset(THETA, xi), bend, rtol=limit, atol=1e-15)
    assert arc_polyline(CAM).area == pytest.approx(CAM.area(), rel=1e-6)
    np.testing.assert_allclose(
        cutter_path(CAM, CAM.follower_radius, THETA).centre, CAM.pitch.points(THETA), atol=1e-12
    )
    mesh = cam_mesh(CAM, 0.01, None, ElementSize(far_size=4e-3))
    assert mesh_area(mesh) == pytest.approx(CAM.area() - np.pi * 0.01**2, rel=1e-6)


def test_a_measured_cam_is_found_again():
    turned = rotation(0.2) @ CAM.polygon(720)
    fit = inspected(CAM, turned)
    assert fit.phase == pytest.approx(0.2, abs=1e-9)
    real = real_contour(CAM, fit)
    np.testing.assert_allclose(real.lift(THETA), CAM.lift(THETA), rtol=0, atol=1e-9)
    assert real.pitch.start == pytest.approx(CAM.pitch.start, abs=1e-8)


def test_the_same_cam_grown():
    grown = CAM.pitch.enlarged(1e-4)
    assert grown.radius_base == pytest.approx(CAM.pitch.radius_base + 1e-4, rel=1e-12)


@pytest.mark.parametrize(("start", "field"), [
    (0.0, "start_angle"), (np.pi, "start_angle"), (np.nan, "start_angle"), (3.1, "arm angle"),
])  # fmt: skip
def test_a_swing_out_of_reach_is_refused(start, field):
    with pytest.raises(InputError, match=field):
        ArmPath(EXAMPLE, Arm(0.1, 0.08, WITH), start)


def test_every_law_moves_an_arm():
    for law in LAWS:
        motion = SegmentMotion((
            Segment(law, np.radians(120.0), 0.02), Segment("dwell", np.radians(60.0)),
            Segment(law, np.radians(120.0), -0.02), Segment("dwell", np.radians(60.0)),
        ))  # fmt: skip
        cam = ArmContour(ArmPath(motion.lift(), Arm(0.1, 0.09, WITH), 0.5), 0.01)
        assert np.isfinite(cam.points(THETA)).all()
