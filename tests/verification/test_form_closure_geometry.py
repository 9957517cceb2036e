"""Second tracks against numbers computed independently, and against the circles they must be.

The conjugate disc of the arm b = 30 + 5 (1 - cos 2a) has published extremes and points; a groove
along a circle has circular walls; opposite rollers and a yoke have a constant breadth.
"""

import numpy as np
import pytest

from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import greatest, least
from camwright.geometry.form_closure import (
    Groove,
    SecondArm,
    conjugate_path,
    least_thickness,
    opposite_path,
    yoke_breadth,
)
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve

COUNT = 720
THETA = uniform_turn(COUNT)
SWING = Lift(THETA, 0.060 * np.radians(5.0) * (1.0 - np.cos(2.0 * THETA)))
FIRST = ArmPath(SWING, Arm(0.080, 0.060, 1.0), np.radians(30.0))
SECOND = conjugate_path(FIRST, SecondArm(0.055, np.radians(80.0)))
DISC = ArmContour(SECOND, 0.012)
WAVE = Lift(THETA, 0.004 * (1.0 - np.cos(3.0 * THETA)))


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
    same = ArmContour(conjugate_path(FIRST, SecondArm(0.060, np.radians(70.0))), 0.010)
    first = ArmContour(FIRST, 0.010)
    for measure in ("radius_min", "radius_max", "pressure_angle_max"):
        assert getattr(same, measure)().value == pytest.approx(
            getattr(first, measure)().value, rel=1e-9
        )


def test_a_second_arm_stays_beyond_the_first():
    with pytest.raises(InputError, match=r"second\.angle = 0\.68068 rad, must be > 0\.69813 rad"):
        conjugate_path(FIRST, SecondArm(0.055, np.radians(39.0)))


@pytest.mark.parametrize("offset", [0.0, 0.006])
def test_opposite_rollers_are_a_constant_distance_apart(offset):
    """Half a turn later the second centre is where the stem has it: the spline's round-off."""
    first = PitchCurve(WAVE, 0.040, offset)
    second = opposite_path(first, 0.095)
    apart = first.points(THETA) - second.points(THETA + np.pi)
    assert np.hypot(*apart) == pytest.approx(0.095, abs=1e-12)


def test_a_yoke_of_an_eccentric_has_one_breadth():
    """s = e sin t under a face: the disc of radius R is 2 R wide at every angle."""
    height = 0.030 + 0.005 * np.sin(THETA)
    assert yoke_breadth(height) == pytest.approx(0.060, abs=1e-15)
    with pytest.raises(InputError, match="an even number"):
        yoke_breadth(height[:-1])


def test_a_groove_along_a_circle_has_circular_walls():
    """An eccentric path of radius R: walls of radii R -+ (r + c/2) about its centre."""
    centre = 0.008 * np.cos(THETA) + np.sqrt(0.048**2 - (0.008 * np.sin(THETA)) ** 2)
    groove = Groove(PitchCurve(Lift(THETA, centre - 0.040), 0.040), 0.010, 0.0004)
    theta = np.linspace(0.0, FULL_TURN, 31)
    middle = 0.5 * (groove.pitch.points(0.0) + groove.pitch.points(np.pi))
    for side, radius in (("inner", 0.048 - 0.0102), ("outer", 0.048 + 0.0102)):
        away = np.hypot(*(groove.points(theta, side) - middle[:, None]))
        assert away == pytest.approx(radius, rel=1e-9)
        assert groove.radius_of_curvature(theta, side) == pytest.approx(radius, rel=1e-6)
    assert groove.undercut("inner").factor == pytest.approx(1.0 - 0.0102 / 0.048, rel=1e-6)
    assert groove.undercut("outer").factor == pytest.approx(1.0 + 0.0102 / 0.048, rel=1e-6)
    area, moment = groove.section()
    ring = np.pi * ((0.048 + 0.0102) ** 2 - (0.048 - 0.0102) ** 2)
    assert area == pytest.approx(ring, rel=1e-9)
    assert moment == pytest.approx(ring * middle, rel=1e-7, abs=1e-12)
    assert least_thickness(groove, 0.080).value == pytest.approx(0.080 - 0.0662, rel=1e-9)


def test_the_inner_wall_without_clearance_is_the_cam_under_the_roller():
    """Of a lift with concave flanks, and the outer wall mirrors it about the path."""
    pitch = PitchCurve(WAVE, 0.040, 0.003)
    groove, cam = Groove(pitch, 0.008), RollerContour(pitch, 0.008)
    assert groove.points(THETA, "inner") == pytest.approx(cam.points(THETA), abs=1e-15)
    both = groove.points(THETA, "inner") + groove.points(THETA, "outer")
    assert 0.5 * both == pytest.approx(pitch.points(THETA), abs=1e-15)
    assert groove.undercut("inner").factor == pytest.approx(cam.undercut().factor, rel=1e-12)
    # the area between the walls by their polygons; 720 chords miss 4e-5 of it
    x, y = groove.points(THETA, "outer")
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) - cam.area()
    assert groove.section()[0] == pytest.approx(area, rel=5e-4)
    assert groove.second_contact("outer").clearance > 0.0


def test_cutter_paths():
    """A tool of the groove's width runs along its middle, a smaller one beside both walls."""
    groove = Groove(PitchCurve(WAVE, 0.040), 0.008, 2e-5)
    (middle,) = groove.cutter_paths(groove.half_width, THETA)
    assert middle == pytest.approx(groove.pitch.points(THETA), abs=0.0)
    for path, side in zip(groove.cutter_paths(0.005, THETA), ("inner", "outer"), strict=True):
        away = np.hypot(*(path - groove.points(THETA, side)))
        assert away == pytest.approx(0.005, rel=1e-12)
    with pytest.raises(InputError, match=r"tool\.radius = 8\.1 mm, must be at most half"):
        groove.cutter_paths(0.0081, THETA)
