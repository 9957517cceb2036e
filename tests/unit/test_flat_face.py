"""The cam under a flat face, beside its closed forms."""

import numpy as np
import pytest

from geometry.errors import InputError
from geometry.flat_face import FlatFaceContour
from geometry.lift import Lift
from geometry.motion import Motion, Segment

THETA = np.linspace(0, 2 * np.pi, 200)
ECCENTRICITY, RADIUS = 0.004, 0.015


def eccentric_lift():
    """A circle off its axis lifts a flat face by e (1 - cos)."""
    theta = np.arange(720) * 2 * np.pi / 720
    return Lift(theta, ECCENTRICITY * (1 - np.cos(theta)))


@pytest.fixture
def circle():
    return FlatFaceContour(eccentric_lift(), RADIUS - ECCENTRICITY)


def test_circle_keeps_its_radius(circle):
    np.testing.assert_allclose(circle.radius_of_curvature(THETA), RADIUS, rtol=1e-9)
    np.testing.assert_allclose(circle.curvature(THETA), 1 / RADIUS, rtol=1e-9)
    x, y = circle.points(THETA)
    np.testing.assert_allclose(np.hypot(x + ECCENTRICITY, y), RADIUS, rtol=1e-12)


def test_contact_travels_by_the_eccentricity(circle):
    low, high = circle.face_travel()
    assert high.value == pytest.approx(ECCENTRICITY, rel=1e-9)
    assert low.value == pytest.approx(-ECCENTRICITY, rel=1e-9)
    assert circle.face_width_min() == pytest.approx(2 * ECCENTRICITY, rel=1e-9)
    assert circle.face_width_min(1e-4, 1e-3) == pytest.approx(2 * (5e-3 + 1e-4), rel=1e-9)


@pytest.mark.parametrize("share", [0.99, 0.5, np.nan, -1.0])
def test_face_too_narrow_is_refused(circle, share):
    with pytest.raises(InputError, match=r"follower\.face_width = .* must be >= 0\.008"):
        circle.require_face(share * 2 * ECCENTRICITY)
    circle.require_face(1.01 * 2 * ECCENTRICITY)


def test_velocity_is_the_derivative_of_the_point(circle):
    step = 1e-5
    slope = (circle.points(THETA + step) - circle.points(THETA - step)) / (2 * step)
    np.testing.assert_allclose(circle.velocity(THETA), slope, atol=1e-10)
    assert np.abs(np.sum(circle.velocity(THETA) * circle.normal(THETA), axis=0)).max() < 1e-15


def test_curvature_condition_decides_at_its_limit():
    lift = Motion(
        (Segment("cycloidal", 1.0, 0.01), Segment("cycloidal", 1.0, -0.01),
         Segment("dwell", 2 * np.pi - 2.0))
    ).lift()  # fmt: skip
    least = FlatFaceContour(lift, 0.01).base_radius_min()
    assert FlatFaceContour(lift, 0.99 * least).undercut()
    assert FlatFaceContour(lift, 0.8 * least).self_intersections()
    sound = FlatFaceContour(lift, 1.01 * least)
    assert not sound.undercut()
    assert not sound.self_intersections()
    assert sound.radius_of_curvature_min().value == pytest.approx(0.01 * least, rel=1e-6)


@pytest.mark.parametrize("radius", [0.0, -0.01, np.nan, np.inf])
def test_bad_base_radius_is_refused(radius):
    with pytest.raises(InputError, match=r"cam\.base_radius"):
        FlatFaceContour(eccentric_lift(), radius)
