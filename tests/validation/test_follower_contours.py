"""Figure 12 of Energies 18 (2025): contours of roller and flat faces for the same torque."""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.follower_height import face_height
from validation import speed_reconstruction
from validation.balancing_cam import (
    FOLLOWER_2025,
    POSITIONS,
    PRIME_RADIUS,
    RATIO,
    TWELVE_VALUES,
    designed_pitch,
)
from validation.follower_contours import (
    FACE_FRICTION,
    ROLLER_RADIUS,
    WIDTH,
    follower_contours,
    least_base_radius,
)

SPEED = speed_reconstruction.SPEED_MEAN / RATIO
THETA = uniform_turn(POSITIONS)
MODULUS = 210e9 / (1 - 0.3**2) / 2


@pytest.fixture(scope="module")
def lift():
    torque = speed_reconstruction.load().torque_at(POSITIONS)
    return designed_pitch(torque, 2.0, TWELVE_VALUES, FOLLOWER_2025).lift


@pytest.fixture(scope="module")
def cams(lift):
    return follower_contours(lift, SPEED)


def test_each_contour_gives_the_same_lift_back(lift, cams):
    """A roller let down on its contour, a face on the contour without a cusp; both by polygons."""
    s, at = lift(THETA), slice(None, None, 40)
    roller, cusped, wide = cams
    for height, theta in zip((PRIME_RADIUS + s)[at], THETA[at], strict=True):
        centre = height * np.array([np.cos(theta), np.sin(theta)])
        apart = np.hypot(*(roller.points - centre[:, None])).min()
        # a contour at 720 angles, 0.6 mm apart: 0.6^2 / (8 x 5 mm)
        assert apart == pytest.approx(ROLLER_RADIUS, abs=1e-5)
    stands = face_height(wide.points, THETA[at])
    np.testing.assert_allclose(stands, least_base_radius(lift) + s[at], rtol=0, atol=5e-5)
    # A face on the radius of the roller's cam has cusps, and rests higher than the lift there.
    rests = face_height(cusped.points, THETA[at]) - PRIME_RADIUS - s[at]
    assert rests.max() > 1e-3


def test_table_is_that_of_spring_and_hertz(lift, cams):
    s, slope, bend = lift.derivatives(THETA, 2)
    spring = (242.0 + 24_200.0 * s) * slope / RATIO
    force = 242.0 + 24_200.0 * s + 0.175 * SPEED**2 * bend
    roller, cusped, wide = (each.row for each in cams)
    for row in (roller, cusped, wide):
        assert row["torque_std_of_spring_alone_Nm"] == pytest.approx(spring.std(), rel=1e-9)
    assert roller["pressure_angle_max_deg"] == pytest.approx(
        np.degrees(np.abs(np.arctan(slope / (PRIME_RADIUS + s))).max()), rel=1e-9
    )
    assert wide["face_width_min_mm"] == pytest.approx(2e3 * np.abs(slope).max(), rel=1e-9)
    radius = least_base_radius(lift) + s + bend
    # Guide friction changes the force by a few percent; the paper's guides, on point supports.
    peak = 1e-6 * np.sqrt(force / WIDTH * MODULUS / (np.pi * radius)).max()
    assert wide["p0_max_MPa"] == pytest.approx(peak, rel=0.1)
    assert cusped["p0_max_MPa"] is None
    assert cusped["radius_of_curvature_min_mm"] < 0.0 < wide["radius_of_curvature_min_mm"]
    # work of the friction of a face, mu N (r + s), that of the guides left out
    rubbed = FACE_FRICTION * (force * (least_base_radius(lift) + s)).mean() * 2.0 * np.pi
    assert wide["friction_loss_J"] == pytest.approx(rubbed, rel=0.15)


def test_least_base_radius_is_that_of_the_undercut_factor(lift, cams):
    assert cams[2].row["undercut_factor_min"] == pytest.approx(0.3, abs=1e-4)
    s, _, bend = lift.derivatives(THETA, 2)
    smaller = 0.99 * least_base_radius(lift)
    assert ((smaller + s + bend) / (smaller + s)).min() < 0.3


def test_a_face_needs_three_times_the_cam_of_the_roller(cams):
    """What the figure shows: the same torque, at 42 mm and 144 mm of base radius."""
    roller, _, wide = (each.row for each in cams)
    assert wide["base_radius_mm"] > 3.0 * roller["base_radius_mm"]
    assert wide["guide_reaction_A_max_N"] < 0.5 * roller["guide_reaction_A_max_N"]
    assert wide["friction_loss_J"] > 10.0 * roller["friction_loss_J"]
