"""The cam under a flat face, beside its closed forms."""

import numpy as np
import pytest

from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import least
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve

THETA = np.linspace(0, 2 * np.pi, 200)
ECCENTRICITY, RADIUS = 0.004, 0.015


def eccentric_lift():
    """A circle off its axis lifts a flat face by e (1 - cos)."""
    theta = np.arange(720) * 2 * np.pi / 720
    return Lift(theta, ECCENTRICITY * (1 - np.cos(theta)))


def flat(lift, base_radius, offset=0.0):
    return FlatFaceContour(FacePath(lift, base_radius, offset))


@pytest.fixture
def circle():
    return flat(eccentric_lift(), RADIUS - ECCENTRICITY)


def test_circle_keeps_its_radius(circle):
    np.testing.assert_allclose(circle.radius_of_curvature(THETA), RADIUS, rtol=1e-9)
    np.testing.assert_allclose(circle.curvature(THETA), 1 / RADIUS, rtol=1e-9)
    x, y = circle.points(THETA)
    np.testing.assert_allclose(np.hypot(x + ECCENTRICITY, y), RADIUS, rtol=1e-12)


def test_contact_travels_by_the_eccentricity(circle):
    assert circle.face_width_min() == pytest.approx(2 * ECCENTRICITY, rel=1e-9)
    aside = flat(eccentric_lift(), RADIUS - ECCENTRICITY, 1e-3)
    assert aside.face_width_min() == pytest.approx(2 * 5e-3, rel=1e-9)
    np.testing.assert_allclose(aside.points(THETA), circle.points(THETA), atol=0)


@pytest.mark.parametrize("share", [0.99, 0.5, np.nan, -1.0])
def test_face_too_narrow_is_refused(circle, share):
    with pytest.raises(InputError, match=r"follower\.face\.width = .* must be > 8 mm"):
        circle.require_face(share * 2 * ECCENTRICITY)
    circle.require_face(1.01 * 2 * ECCENTRICITY)


def test_velocity_is_the_derivative_of_the_point(circle):
    step = 1e-5
    slope = (circle.points(THETA + step) - circle.points(THETA - step)) / (2 * step)
    np.testing.assert_allclose(circle.velocity(THETA), slope, atol=1e-10)
    assert np.abs(np.sum(circle.velocity(THETA) * circle.normal(THETA), axis=0)).max() < 1e-15


def test_curvature_condition_decides_at_its_limit():
    lift = SegmentMotion(
        (Segment("cycloidal", 1.0, 0.01), Segment("cycloidal", 1.0, -0.01),
         Segment("dwell", 2 * np.pi - 2.0))
    ).lift()  # fmt: skip
    bend = least(lambda theta: lift(theta) + lift(theta, 2), lift.search_count).value
    limit = -bend  # base radius at which r + s + s'' reaches zero
    assert flat(lift, 0.99 * limit).undercut().present
    cut = flat(lift, 0.8 * limit)
    assert cut.self_intersections()
    assert cut.second_contact().clearance <= 0
    sound = flat(lift, 1.01 * limit)
    assert not sound.undercut().present
    assert not sound.self_intersections()
    assert sound.second_contact().clearance == np.inf
    thinnest = least(sound.radius_of_curvature, lift.search_count).value
    assert thinnest == pytest.approx(0.01 * limit, rel=1e-6)


@pytest.mark.parametrize("radius", [0.0, -0.01, np.nan, np.inf])
def test_bad_base_radius_is_refused(radius):
    with pytest.raises(InputError, match=r"cam\.prime_radius"):
        flat(eccentric_lift(), radius)


def test_a_roller_grown_beyond_all_bounds_is_a_face(circle):
    """The contour under ever larger rollers goes to that under the face, with its first power."""
    lift = eccentric_lift()
    missed = []
    for roller in (10.0, 20.0, 40.0):
        drawn = RollerContour(PitchCurve(lift, RADIUS - ECCENTRICITY + roller), roller)
        away = np.hypot(*(drawn.points(THETA) - circle.points(THETA))).max()
        bent = np.abs(drawn.curvature(THETA) - circle.curvature(THETA)).max()
        tilted = np.abs(drawn.pitch.pressure_angle(THETA)).max()
        missed.append((away, bent, tilted))
    ratios = np.array(missed)[1:] / np.array(missed)[:-1]
    np.testing.assert_allclose(ratios, 0.5, rtol=0.01)


def test_height_of_the_contour_over_its_tangent(circle):
    """A circle of the radius R falls off by R - sqrt(R^2 - x^2)."""
    along = np.linspace(-0.5, 0.5, 11) * RADIUS
    fall = RADIUS - np.sqrt(RADIUS**2 - along**2)
    found = circle.surface_offset(THETA[:5], along)
    np.testing.assert_allclose(found, np.broadcast_to(-fall, found.shape), atol=1e-12)
