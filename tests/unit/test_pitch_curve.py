"""The roller-centre path: frames, derivatives and extremes."""

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve

THETA = uniform_turn(360)
LIFT = Lift(THETA, 0.01 * (1 - np.cos(THETA - 0.4)) + 0.002 * np.sin(3 * THETA) ** 2)
ANGLE = np.random.default_rng(3).uniform(0, 2 * np.pi, 500)

with_offsets = pytest.mark.parametrize("offset", [0.0, 0.012, -0.02])


def derivative(function, angle, step=1e-3):
    """Central difference of eighth order; its error is step^8, below the round-off in it."""
    weights = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
    return (
        sum(
            w * (function(angle + k * step) - function(angle - k * step))
            for k, w in enumerate(weights, 1)
        )
        / step
    )


@with_offsets
def test_centre_lies_offset_beside_the_follower_axis(offset):
    pitch = PitchCurve(LIFT, 0.05, offset)
    axis = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    x, y = pitch.points(ANGLE)
    np.testing.assert_allclose(axis[0] * y - axis[1] * x, offset, rtol=0, atol=1e-16)
    np.testing.assert_allclose(
        axis[0] * x + axis[1] * y, np.sqrt(0.05**2 - offset**2) + LIFT(ANGLE), rtol=1e-14
    )


def test_prime_radius_is_the_least_radius():
    pitch = PitchCurve(LIFT, 0.05, 0.012)
    lowest = pitch.lift.lowest
    assert lowest.value < 2e-3
    assert np.hypot(*pitch.points(lowest.theta)) == pytest.approx(
        np.hypot(np.sqrt(0.05**2 - 0.012**2) + lowest.value, 0.012), rel=1e-14
    )


@with_offsets
def test_tangent_and_speed_are_the_derivative(offset):
    """rtol 1e-10: eighth-order differences over a spline of degree five."""
    pitch = PitchCurve(LIFT, 0.05, offset)
    velocity = derivative(pitch.points, ANGLE)
    np.testing.assert_allclose(pitch.velocity(ANGLE), velocity, rtol=0, atol=1e-10)
    np.testing.assert_allclose(pitch.speed_and_curvature(ANGLE)[0], np.hypot(*velocity), rtol=1e-9)
    np.testing.assert_allclose(
        pitch.tangent(ANGLE) * pitch.speed_and_curvature(ANGLE)[0], velocity, atol=1e-10
    )


@with_offsets
def test_curvature_is_the_turning_of_the_tangent(offset):
    pitch = PitchCurve(LIFT, 0.05, offset)
    turning = derivative(pitch.tangent, ANGLE)
    left = -pitch.normal(ANGLE)
    np.testing.assert_allclose(
        np.sum(turning * left, axis=0),
        pitch.curvature(ANGLE) * pitch.speed_and_curvature(ANGLE)[0],
        rtol=0,
        atol=1e-6,
    )


@with_offsets
def test_frame_is_right_handed_and_points_outwards(offset):
    pitch = PitchCurve(LIFT, 0.05, offset)
    n, t = pitch.normal(ANGLE), pitch.tangent(ANGLE)
    np.testing.assert_allclose(n[0] * t[1] - n[1] * t[0], 1.0, rtol=1e-14)
    np.testing.assert_allclose(np.sum(n * n, axis=0), 1.0, rtol=1e-14)
    assert (np.sum(n * pitch.points(ANGLE), axis=0) > 0).all()


@with_offsets
def test_pressure_angle_lies_between_axis_and_normal(offset):
    pitch = PitchCurve(LIFT, 0.05, offset)
    axis = np.array([np.cos(ANGLE), np.sin(ANGLE)])
    n = pitch.normal(ANGLE)
    sine = -(axis[0] * n[1] - axis[1] * n[0])
    np.testing.assert_allclose(np.sin(pitch.pressure_angle(ANGLE)), sine, rtol=0, atol=1e-14)
    tangent = (LIFT(ANGLE, 1) - offset) / pitch.height(ANGLE)
    np.testing.assert_allclose(np.tan(pitch.pressure_angle(ANGLE)), tangent, rtol=1e-13)


def test_pressure_angle_is_positive_on_the_rise():
    pitch = PitchCurve(LIFT, 0.05)
    rising = LIFT(ANGLE, 1) > 0
    np.testing.assert_array_equal(pitch.pressure_angle(ANGLE) > 0, rising)


@pytest.mark.parametrize("offset", [0.0, 0.012])
def test_extremes_bound_a_dense_sampling(offset):
    """rel 1e-7: what samples 3e-5 rad apart can miss of an extreme."""
    pitch = PitchCurve(LIFT, 0.05, offset)
    dense = np.linspace(0, 2 * np.pi, 200_001)
    curvature, angle = pitch.curvature(dense), np.abs(pitch.pressure_angle(dense))
    for found, value in [
        (pitch.curvature_max(), curvature.max()),
        (pitch.curvature_min(), curvature.min()),
        (pitch.pressure_angle_max(), angle.max()),
    ]:
        assert found.value == pytest.approx(value, rel=1e-7)
    assert pitch.curvature_max().value >= curvature.max()
    assert pitch.curvature_min().value <= curvature.min()
    assert pitch.least_convex_radius().value == pytest.approx(1 / curvature.max(), rel=1e-7)
    # a rounding apart: sines of one angle alone and of many are not the same to the last bit
    sharpest = pitch.curvature_max()
    assert pitch.curvature(sharpest.theta) == pytest.approx(sharpest.value, rel=1e-14)


def test_circle_has_one_curvature():
    pitch = PitchCurve(Lift(THETA, np.zeros(360)), 0.05)
    np.testing.assert_allclose(pitch.curvature(ANGLE), 20.0, rtol=1e-14)
    assert pitch.pressure_angle_max().value == 0.0


def test_straight_places_have_infinite_radius():
    class Straight(PitchCurve):
        def curvature(self, theta):
            return np.zeros_like(theta)

    assert np.isinf(Straight(LIFT, 0.05).radius_of_curvature(ANGLE)).all()


@pytest.mark.parametrize(
    ("prime_radius", "offset", "field"),
    [
        (0.0, 0.0, "cam.prime_radius"),
        (-0.05, 0.0, "cam.prime_radius"),
        (np.nan, 0.0, "cam.prime_radius"),
        (0.05, 0.05, "cam.offset"),
        (0.05, -0.06, "cam.offset"),
        (0.05, np.nan, "cam.offset"),
    ],
)
def test_refuses(prime_radius, offset, field):
    with pytest.raises(InputError) as caught:
        PitchCurve(LIFT, prime_radius, offset)
    assert caught.value.field == field
