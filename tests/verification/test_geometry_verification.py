"""Geometry against closed forms: the eccentric circle, with and without offset.

An eccentric circular cam is a lift like any other to the program, yet everything about it is
known: one curvature, a circle for a contour, its area, length and centre.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve

ECCENTRICITY, PITCH_RADIUS, ROLLER_RADIUS = 0.020, 0.080, 0.0475
PHASE = 0.7
CENTRE = ECCENTRICITY * np.array([np.cos(PHASE), np.sin(PHASE)])
ANGLE = np.random.default_rng(5).uniform(0, 2 * np.pi, 400)

with_offsets = pytest.mark.parametrize("offset", [0.0, 0.008, -0.010])


def height(theta, offset):
    """d: the roller centre lies on the pitch circle and on the follower's line."""
    psi = theta - PHASE
    root = PITCH_RADIUS**2 - (offset + ECCENTRICITY * np.sin(psi)) ** 2
    return ECCENTRICITY * np.cos(psi) + np.sqrt(root)


def height_slope(theta, offset):
    """d', written out anew from the height."""
    psi = theta - PHASE
    across = offset + ECCENTRICITY * np.sin(psi)
    slope = across * ECCENTRICITY * np.cos(psi) / np.sqrt(PITCH_RADIUS**2 - across**2)
    return -ECCENTRICITY * np.sin(psi) - slope


def eccentric(offset, count=720):
    theta, base = uniform_turn(count), PITCH_RADIUS - ECCENTRICITY
    lift = height(theta, offset) - np.sqrt(base**2 - offset**2)
    return RollerContour(PitchCurve(Lift(theta, lift), base, offset), ROLLER_RADIUS)


@with_offsets
def test_height_and_its_slope(offset):
    pitch = eccentric(offset).pitch
    np.testing.assert_allclose(pitch.height(ANGLE), height(ANGLE, offset), rtol=1e-14)
    slope = height_slope(ANGLE, offset)
    np.testing.assert_allclose(pitch.lift(ANGLE, 1), slope, rtol=0, atol=1e-14)
    tangent = (slope - offset) / height(ANGLE, offset)
    np.testing.assert_allclose(np.tan(pitch.pressure_angle(ANGLE)), tangent, rtol=0, atol=1e-12)


@with_offsets
def test_pitch_curvature_is_constant(offset):
    """rtol: the fourth-order error of s'' at 720 samples is 3e-11."""
    pitch = eccentric(offset).pitch
    np.testing.assert_allclose(pitch.curvature(ANGLE), 1 / PITCH_RADIUS, rtol=1e-10)
    assert pitch.least_convex_radius().value == pytest.approx(PITCH_RADIUS, rel=1e-10)


@with_offsets
def test_curvature_converges_to_fourth_order(offset):
    errors = [
        np.abs(eccentric(offset, n).pitch.curvature(ANGLE) * PITCH_RADIUS - 1).max()
        for n in (45, 90, 180)
    ]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (orders > 3.7).all(), orders


@with_offsets
def test_contour_is_a_circle(offset):
    """Points to 1e-15 m; the normal to the interpolation error of s', 1e-13 of the radius."""
    cam, radius = eccentric(offset), PITCH_RADIUS - ROLLER_RADIUS
    away = cam.points(ANGLE) - CENTRE[:, None]
    np.testing.assert_allclose(np.hypot(*away), radius, rtol=0, atol=1e-15)
    np.testing.assert_allclose(cam.normal(ANGLE), away / radius, rtol=0, atol=5e-13)
    np.testing.assert_allclose(cam.curvature(ANGLE), 1 / radius, rtol=1e-9)


@with_offsets
def test_area_perimeter_and_centre_of_the_circle(offset):
    cam, radius = eccentric(offset), PITCH_RADIUS - ROLLER_RADIUS
    assert cam.area() == pytest.approx(np.pi * radius**2, rel=1e-13)
    assert cam.perimeter() == pytest.approx(2 * np.pi * radius, rel=1e-13)
    np.testing.assert_allclose(cam.centroid(), CENTRE, rtol=0, atol=1e-14)
    assert cam.radius_max().value == pytest.approx(radius + ECCENTRICITY, rel=1e-14)
    assert cam.radius_min().value == pytest.approx(radius - ECCENTRICITY, rel=1e-14)


@with_offsets
def test_pressure_angle_has_its_closed_extreme(offset):
    """sin alpha = -(e + c sin psi) / R: greatest where psi is a quarter turn."""
    value, theta = eccentric(offset).pressure_angle_max()
    greatest = np.arcsin((ECCENTRICITY + abs(offset)) / PITCH_RADIUS)
    assert value == pytest.approx(greatest, rel=1e-12)
    assert abs(np.sin(theta - PHASE)) == pytest.approx(1, abs=1e-10)


@with_offsets
def test_circle_has_neither_hollow_nor_double_point(offset):
    cam = eccentric(offset)
    assert cam.undercut().factor == pytest.approx(1 - ROLLER_RADIUS / PITCH_RADIUS, abs=1e-10)
    assert not cam.undercut().present
    assert cam.self_intersections() == ()
    assert cam.concave_radius_min().value == np.inf
    assert cam.second_contact().clearance == np.inf


@with_offsets
def test_surface_at_the_contact_is_the_circle(offset):
    """The height of a circle over its tangent, free of cancellation, to 1e-15 m."""
    cam, radius = eccentric(offset), PITCH_RADIUS - ROLLER_RADIUS
    xi = np.linspace(-5e-3, 5e-3, 65)
    exact = -(xi**2) / (radius + np.sqrt(radius**2 - xi**2))
    found = cam.surface_offset(ANGLE, xi)
    np.testing.assert_allclose(found, np.broadcast_to(exact, found.shape), rtol=0, atol=1e-15)


def test_second_derivative_of_the_centre_by_complex_step():
    """The analytic height accepts a complex angle: s'' to round-off without a difference."""
    step = 1e-30
    slope = height_slope(ANGLE + 1j * step, 0.008)
    bend = slope.imag / step
    lift = eccentric(0.008).pitch.lift
    np.testing.assert_allclose(lift(ANGLE, 2), bend, rtol=0, atol=1e-11)


def test_roller_centre_rolls_at_the_speed_of_the_contact():
    """Way of the contact along the contour is that along the pitch curve times the factor."""
    cam = eccentric(0.008)
    expected = cam.pitch.speed_and_curvature(ANGLE)[0] * (1 - ROLLER_RADIUS / PITCH_RADIUS)
    np.testing.assert_allclose(cam.speed(ANGLE), expected, rtol=1e-10)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    amplitudes=st.lists(st.floats(-1.5e-3, 1.5e-3), min_size=3, max_size=6),
    phases=st.lists(st.floats(0, 6.28), min_size=6, max_size=6),
    roller_radius=st.floats(2e-3, 0.03),
    offset=st.floats(-0.02, 0.02),
)
def test_no_extreme_hides_between_samples(amplitudes, phases, roller_radius, offset):
    """72 samples a turn against 7 200 angles that miss all of them: none finds a sharper place."""
    theta = uniform_turn(72)
    values = sum(
        a * np.cos(k * theta + p)
        for k, (a, p) in enumerate(zip(amplitudes, phases, strict=False), 1)
    )
    lift = Lift(theta, values - values.min())
    cam = RollerContour(PitchCurve(lift, 0.05, offset), roller_radius)
    dense = uniform_turn(7200) + 1e-4
    assert cam.undercut().factor <= cam.factor(dense).min() + 1e-12
    assert cam.pressure_angle_max().value >= np.abs(cam.pitch.pressure_angle(dense)).max() - 1e-12
    assert cam.pitch.curvature_min().value <= cam.pitch.curvature(dense).min() + 1e-10
    # nearer to zero than this a swallow-tail is smaller than the round-off of its points
    if cam.undercut().factor > 1e-6:
        assert cam.self_intersections() == ()
        assert cam.second_contact().clearance > 0
    if cam.undercut().factor < -1e-6:
        assert cam.self_intersections()
        assert cam.second_contact().clearance <= 0


@pytest.mark.parametrize("turn", [0.1, 2.5])
def test_turning_the_cam_changes_nothing(turn):
    """A lift later by a whole number of samples is the same cam, turned."""
    count = 720
    shift = round(turn / (2 * np.pi) * count)
    theta = uniform_turn(count)
    values = 0.01 * (1 - np.cos(theta)) + 0.012 * np.sin(2 * theta) ** 2
    plain = RollerContour(PitchCurve(Lift(theta, values), 0.05), 0.008)
    later = RollerContour(PitchCurve(Lift(theta, np.roll(values, shift)), 0.05), 0.008)
    angle = theta[shift]
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    np.testing.assert_allclose(
        later.points(ANGLE + angle), turned @ plain.points(ANGLE), rtol=0, atol=1e-15
    )
    assert later.area() == pytest.approx(plain.area(), rel=1e-13)
    assert later.undercut().factor == pytest.approx(plain.undercut().factor, rel=1e-10)
    assert later.second_contact().clearance == pytest.approx(
        plain.second_contact().clearance, rel=1e-6
    )


def wavy():
    theta = uniform_turn(360)
    return Lift(theta, 0.01 + 0.006 * np.cos(2 * theta) + 0.002 * np.sin(3 * theta))


@pytest.mark.parametrize(
    "contour",
    [
        RollerContour(PitchCurve(wavy(), 0.05, 0.004), 0.008),
        FlatFaceContour(FacePath(wavy(), 0.09, 0.004)),
    ],
    ids=["roller", "face"],
)
def test_slope_of_the_curvature_is_its_derivative(contour):
    step = 1e-5
    ends = [contour.curvature(ANGLE + side * step) for side in (1, -1)]
    found = contour.curvature_slope(ANGLE)
    # a central difference of step 1e-5 keeps about 8 digits
    np.testing.assert_allclose(
        (ends[0] - ends[1]) / (2 * step), found, rtol=0, atol=1e-6 * np.abs(found).max()
    )


@with_offsets
def test_curvature_of_a_circle_does_not_change(offset):
    """atol: the third-order error of the third derivative at 720 samples, of 12.5 /m."""
    np.testing.assert_allclose(eccentric(offset).pitch.curvature_slope(ANGLE), 0.0, atol=1e-5)
