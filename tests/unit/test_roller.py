"""Motion of the roller and life of its bearing, against hand calculation and closed curves."""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.follower.roller_motion import (
    equivalent_load,
    rating_life,
    roller_motion,
    static_safety,
)

SPEED = 75.0
RADIUS = 0.008


def wavy_pitch(offset=0.0):
    theta = uniform_turn(720)
    return PitchCurve(Lift(theta, 0.008 * (1 - np.cos(theta + 0.4 * np.sin(theta)))), 0.05, offset)


def eccentric_pitch(crank=0.02, rod=0.08):
    """An eccentric disc: the roller centre keeps the distance `rod` from a turning point."""
    theta = uniform_turn(1440)
    height = crank * np.sin(theta) + np.sqrt(rod**2 - (crank * np.cos(theta)) ** 2)
    return PitchCurve(Lift(theta, height - (rod - crank)), rod - crank)


def test_round_cam_turns_the_roller_like_a_friction_gear():
    """A disc of radius R drives a roller at w R/r; R = 42 mm."""
    theta = uniform_turn(24)
    motion = roller_motion(PitchCurve(Lift(theta, np.zeros(24)), 0.05), RADIUS, SPEED, theta)
    np.testing.assert_allclose(motion.spin, SPEED * 0.042 / 0.008, rtol=1e-14)
    np.testing.assert_allclose(motion.rolling_speed, SPEED * 0.042, rtol=1e-14)
    np.testing.assert_allclose(motion.spin_acceleration, 0.0, atol=1e-9)
    assert motion.spin_mean == pytest.approx(np.abs(motion.spin).max())


@pytest.mark.parametrize("offset", [0.0, 0.012])
def test_velocities_meet_at_the_contact(offset):
    """No slip: cam and roller surfaces have one tangential velocity at the contact point."""
    pitch, theta = wavy_pitch(offset), uniform_turn(90)
    motion = roller_motion(pitch, RADIUS, SPEED, theta)
    u, v = np.eye(2)[:, :, None]
    lean = pitch.pressure_angle(theta)
    # frame of the follower: axis along u, cam turning at -SPEED about the origin
    normal = np.cos(lean) * u - np.sin(lean) * v
    along = np.sin(lean) * u + np.cos(lean) * v
    centre = pitch.height(theta) * u + offset * v
    contact = centre - RADIUS * normal
    cam = -SPEED * np.stack([-contact[1], contact[0]])
    arm = contact - centre
    roller = pitch.lift(theta, 1) * SPEED * u + motion.spin * np.stack([-arm[1], arm[0]])
    # 1e-9: the two ways round differ by round-off alone
    np.testing.assert_allclose((cam * along).sum(0), (roller * along).sum(0), rtol=1e-9)
    np.testing.assert_allclose((cam * normal).sum(0), (roller * normal).sum(0), atol=1e-9)


def test_spin_of_an_eccentric_cam():
    """w (sqrt(d^2 + (d' - e)^2) - r)/r with d of the slider-crank, differentiated by hand."""
    theta, crank, rod, radius = uniform_turn(60), 0.02, 0.08, 0.0475
    root = np.sqrt(rod**2 - (crank * np.cos(theta)) ** 2)
    height = crank * np.sin(theta) + root
    slope = crank * np.cos(theta) + crank**2 * np.sin(theta) * np.cos(theta) / root
    expected = 37.22 * (np.hypot(height, slope) - radius) / radius
    motion = roller_motion(eccentric_pitch(), radius, 37.22, theta)
    np.testing.assert_allclose(motion.spin, expected, rtol=1e-9)


def test_rolled_length_in_a_turn_is_the_perimeter_of_the_contour():
    pitch, theta = wavy_pitch(), uniform_turn(2000)
    motion = roller_motion(pitch, RADIUS, SPEED, theta)
    perimeter = RollerContour(pitch, RADIUS).perimeter()
    assert motion.rolling_speed.mean() * 2 * np.pi / SPEED == pytest.approx(perimeter, rel=1e-6)


def test_rolled_length_on_a_disc_is_its_circumference():
    theta = uniform_turn(1440)
    motion = roller_motion(eccentric_pitch(), 0.0475, 1.0, theta)
    assert motion.rolling_speed.mean() == pytest.approx(0.08 - 0.0475, rel=1e-9)


@pytest.mark.parametrize("offset", [0.0, 0.012])
def test_spin_acceleration_is_the_rate_of_the_spin(offset):
    pitch, theta, step = wavy_pitch(offset), uniform_turn(60), 1e-5
    motion = roller_motion(pitch, RADIUS, SPEED, theta)
    before, after = (roller_motion(pitch, RADIUS, SPEED, theta + h).spin for h in (-step, step))
    rate = (after - before) / (2 * step) * SPEED
    np.testing.assert_allclose(motion.spin_acceleration, rate, atol=1e-6 * np.abs(rate).max())


def test_cam_acceleration_adds_in_the_ratio_of_speeds():
    pitch, theta = wavy_pitch(), uniform_turn(60)
    steady = roller_motion(pitch, RADIUS, SPEED, theta)
    driven = roller_motion(pitch, RADIUS, SPEED, theta, 500.0)
    added = driven.spin_acceleration - steady.spin_acceleration
    np.testing.assert_allclose(added, 500.0 * steady.spin / SPEED, rtol=1e-9)


@pytest.mark.parametrize("radius", [0.0, -0.01, np.nan])
def test_bad_radius_is_refused(radius):
    with pytest.raises(InputError, match=r"roller\.radius"):
        roller_motion(wavy_pitch(), radius, SPEED, [0.0])


def test_equivalent_load_weighs_by_revolutions():
    """Two thirds of the turns at 300 N, one third at 600 N: cube root of the mean cube."""
    load = equivalent_load([300.0, 600.0], [400.0, -200.0])
    assert load == pytest.approx((2 / 3 * 300.0**3 + 1 / 3 * 600.0**3) ** (1 / 3), rel=1e-14)
    assert equivalent_load([500.0] * 4, [1.0, 2.0, 3.0, 4.0]) == pytest.approx(500.0, rel=1e-14)
    rollers = equivalent_load([300.0, 600.0], [1.0, 1.0], 10 / 3)
    assert rollers == pytest.approx((0.5 * 300 ** (10 / 3) + 0.5 * 600 ** (10 / 3)) ** 0.3)
    assert equivalent_load([0.0, 0.0], [1.0, 1.0]) == 0.0


@pytest.mark.parametrize(
    ("force", "spin", "says"),
    [
        ([-1.0, 1.0], [1.0, 1.0], "normal_force"),
        ([1.0, np.nan], [1.0, 1.0], "normal_force"),
        ([1.0, 1.0], [0.0, 0.0], "spin"),
        ([1.0, 1.0], [1.0], "spin"),
    ],
)
def test_bad_cycle_is_refused(force, spin, says):
    with pytest.raises(InputError, match=says):
        equivalent_load(force, spin)


def test_rating_life_by_hand():
    """C = 1140 N at 570 N: 8 million revolutions; at 600 r/min 222.2 hours."""
    life = rating_life([570.0] * 3, [600 * 2 * np.pi / 60] * 3, 1140.0)
    assert life.mean_load == pytest.approx(570.0)
    assert life.revolutions == pytest.approx(8e6, rel=1e-12)
    assert life.seconds == pytest.approx(8e6 / 600 * 60, rel=1e-12)
    assert rating_life([0.0], [1.0], 1140.0).seconds == np.inf


def test_ten_percent_more_load_costs_a_quarter_of_the_life():
    one, more = (rating_life([f], [100.0], 1140.0).seconds for f in (500.0, 550.0))
    assert more / one == pytest.approx(1.1**-3, rel=1e-12)


def test_static_safety_and_its_refusals():
    assert static_safety([100.0, 760.0], 380.0) == 0.5
    assert static_safety([0.0], 380.0) == np.inf
    for call, field in (
        (lambda: static_safety([1.0], 0.0), "C0"),
        (lambda: rating_life([1.0], [1.0], np.nan), r"bearing\.C"),
    ):
        with pytest.raises(InputError, match=field):
            call()
