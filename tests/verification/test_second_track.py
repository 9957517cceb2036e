"""Second discs against numbers computed independently, and against what the follower fixes.

The conjugate disc of the arm b = 30 + 5 (1 - cos 2a) has published extremes and points; opposite
rollers are a constant distance apart.
"""

import numpy as np
import pytest

from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import greatest, least
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.geometry.second_track import ConjugateArm, OppositeRoller

THETA = uniform_turn(720)
SWING = Lift(THETA, 0.060 * np.radians(5.0) * (1.0 - np.cos(2.0 * THETA)))
FIRST = ArmPath(SWING, Arm(0.080, 0.060, 1.0), np.radians(30.0))
TRACK = ConjugateArm(0.055, np.radians(80.0), 0.012).of(FIRST)
DISC, SECOND = TRACK.contour, TRACK.contour.pitch
WAVE = Lift(THETA, 0.004 * (1.0 - np.cos(3.0 * THETA)) + 0.001 * (1.0 - np.cos(2.0 * THETA)))


@pytest.mark.parametrize(("angle", "x", "y"), [
    (0.0, 35.919220, -33.896462), (30.0, 15.039001, -44.672863), (90.0, -27.164229, -29.096079),
])  # fmt: skip
def test_points_of_the_conjugate_disc(angle, x, y):
    """To the digits printed; the cam of the reference turns counter-clockwise."""
    point = 1e3 * DISC.points(-np.radians(angle))
    assert point == pytest.approx([x, y], abs=6e-7)


def test_extremes_of_the_conjugate_disc():
    """To the digits printed; the cam turns the other way, which mirrors sign and angles."""
    count = SWING.search_count
    for refined, value, angle in ((least, -12.820257, 299.255), (greatest, 8.973595, 32.785)):
        extreme = refined(SECOND.pressure_angle, count)
        assert np.degrees(extreme.value) == pytest.approx(value, abs=6e-7)
        assert np.degrees(-extreme.theta) % 180.0 == pytest.approx(angle % 180.0, abs=1e-3)
    for extreme, length in (
        (least(DISC.radius_of_curvature, count), 34.774786),
        (greatest(DISC.radius_of_curvature, count), 70.050727),
        (DISC.radius_min(), 39.805491),
        (DISC.radius_max(), 49.387857),
    ):
        assert 1e3 * extreme.value == pytest.approx(length, abs=6e-7)


def test_a_symmetric_second_arm_has_the_extremes_of_the_first():
    """Arm 60, roller 10, 70 deg apart: the mirror image, shifted by a quarter turn."""
    same = ConjugateArm(0.060, np.radians(70.0), 0.010).of(FIRST).contour
    first = ArmContour(FIRST, 0.010)
    for measure in ("radius_min", "radius_max"):
        assert getattr(same, measure)().value == pytest.approx(
            getattr(first, measure)().value, rel=1e-9
        )
    most, least_ = same.pitch.pressure_angle_max().value, FIRST.pressure_angle_max().value
    assert most == pytest.approx(least_, rel=1e-9)


@pytest.mark.parametrize("offset", [0.0, 0.006])
def test_opposite_rollers_are_a_constant_distance_apart(offset):
    """Half a turn later the second centre is where the stem has it: the spline's round-off."""
    first = PitchCurve(WAVE, 0.040, offset)
    track = OppositeRoller(0.095, 0.010).of(first)
    apart = first.points(THETA) - track.contour.pitch.points(THETA + track.turn)
    assert np.hypot(*apart) == pytest.approx(0.095, abs=1e-12)
    along = np.stack([np.cos(THETA), np.sin(THETA)])
    assert apart / 0.095 == pytest.approx(along, abs=1e-12)


def test_refusals():
    with pytest.raises(InputError, match=r"arm_angle = 39 deg, must be > 40 deg, the greatest arm"):
        ConjugateArm(0.055, np.radians(39.0), 0.012).of(FIRST)
    path = PitchCurve(WAVE, 0.040)
    with pytest.raises(InputError, match=r"distance = 45 mm, must be > 49\.\d+ mm: beyond"):
        OppositeRoller(0.045, 0.010).of(path)
    with pytest.raises(InputError, match="arm_length = stated, must be left out without an arm"):
        ConjugateArm(0.055, 1.0, 0.012).of(path)
    with pytest.raises(InputError, match="distance = stated, must be left out without a stem"):
        OppositeRoller(0.2, 0.010).of(FIRST)


def centres(track):
    """Both roller centres in the follower's axes (2, n): u along the line of travel or of centres,
    v counter-clockwise, without the kinematics of a follower.
    """
    cos, sin = np.cos(THETA), np.sin(THETA)
    turned = np.array([[cos, sin], [-sin, cos]])
    paths = track.first.points(THETA), track.contour.pitch.points(THETA + track.turn)
    return tuple(np.einsum("ijn,jn->in", turned, each) for each in paths)


@pytest.mark.parametrize("track", [
    TRACK, ConjugateArm(0.070, np.radians(95.0), 0.009).of(FIRST),
    OppositeRoller(0.095, 0.010).of(PitchCurve(WAVE, 0.040, 0.005)),
], ids=["arm", "long_arm", "stem"])  # fmt: skip
def test_force_of_the_second_roller_by_the_normal_of_its_disc(track):
    """Normal from points of the disc, moment about the pivot or force along the stem: 1e-8.

    The axial force of -1 N at the first roller is one that a normal force on the second makes.
    """
    touch, theta = track.touch(THETA), THETA + track.turn
    first, second = centres(track)
    step = 1e-5
    tangent = track.contour.points(theta + step) - track.contour.points(theta - step)
    cos, sin = np.cos(THETA), np.sin(THETA)
    along, across = cos * tangent[0] + sin * tangent[1], cos * tangent[1] - sin * tangent[0]
    normal = np.stack([across, -along]) / np.hypot(along, across)  # outwards of the disc
    contact = second - track.contour.roller_radius * normal
    held = np.einsum("ijn,jn->in", np.array([[cos, sin], [-sin, cos]]), track.contour.points(theta))
    assert contact == pytest.approx(held, abs=1e-9)
    if isinstance(track.first, ArmPath):
        arm, pivot = track.first.arm, np.array([[0.080], [0.0]])
        out = first - pivot
        travel = -arm.sense * np.stack([-out[1], out[0]]) / arm.length
        reach = contact - pivot
        lever = reach[0] * normal[1] - reach[1] * normal[0]
        unit = out[0] * travel[1] - out[1] * travel[0]  # moment of 1 N along the travel
        pressed = -unit / lever
    else:
        travel = np.stack([np.ones(theta.size), np.zeros(theta.size)])
        pressed = -1.0 / normal[0]
    assert (pressed > 0.0).all()
    force = pressed * normal
    clockwise = np.stack([travel[1], -travel[0]])
    normal_force = 1.0 / (touch.slide.lever * np.cos(touch.pressure_angle))
    assert normal_force == pytest.approx(pressed, rel=1e-8)
    assert -touch.slide.pressing == pytest.approx(np.sum(force * travel, axis=0), abs=1e-8)
    assert -touch.slide.side == pytest.approx(np.sum(force * clockwise, axis=0), abs=1e-8)
