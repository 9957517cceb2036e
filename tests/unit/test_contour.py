"""The contour: offset, undercut, crossings, second contact and the surface at a contact."""

import numpy as np
import pytest
from scipy.optimize import brentq

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve

THETA = uniform_turn(360)
ANGLE = np.random.default_rng(4).uniform(0, 2 * np.pi, 500)

WAVY = Lift(THETA, 0.01 * (1 - np.cos(THETA - 0.4)) + 0.012 * np.sin(2 * THETA) ** 2)
"""Convex and hollow flanks, no undercut at a roller of 8 mm on 50 mm."""

with_offsets = pytest.mark.parametrize("offset", [0.0, 0.012, -0.02])


def contour(lift=WAVY, prime_radius=0.05, roller_radius=0.008, offset=0.0):
    return RollerContour(PitchCurve(lift, prime_radius, offset), roller_radius)


def lobed(phase, lobes=6, height=0.004, count=144):
    """Equal lobes; the crest of each, its sharpest place, at `phase` of a sample interval."""
    theta = uniform_turn(count)
    crest = phase * 2 * np.pi / count
    return Lift(theta, 0.5 * height * (1 + np.cos(lobes * (theta - crest))))


def narrow_lobe(prime_radius):
    """A roller of 2 mm and a lobe 50 mm high: on a foot too small the flanks come too close."""
    theta = uniform_turn(720)
    half = np.abs(np.mod(theta + np.pi, 2 * np.pi) - np.pi)
    step = np.clip((half - 0.15) / 0.41, 0, 1)
    lift = Lift(theta, 0.05 * (1 - step**3 * (10 - 15 * step + 6 * step**2)))
    return contour(lift, prime_radius, roller_radius=0.002)


# Points, normals, curvature ----------------------------------------------------------------


@with_offsets
def test_contour_lies_a_roller_radius_within_the_pitch_curve(offset):
    cam = contour(offset=offset)
    frame = cam.local_frame(ANGLE)
    np.testing.assert_allclose(
        frame.point + 0.008 * frame.normal, cam.pitch.points(ANGLE), rtol=0, atol=3e-17
    )
    np.testing.assert_array_equal(cam.points(ANGLE), frame.point)
    np.testing.assert_allclose(frame.normal, cam.normal(ANGLE), rtol=0, atol=1e-15)
    np.testing.assert_allclose(frame.tangent, cam.tangent(ANGLE), rtol=0, atol=1e-15)


@with_offsets
def test_velocity_is_the_derivative_of_the_points(offset):
    """Eighth-order differences: weights of Fornberg (1988); atol is their round-off."""
    cam, step = contour(offset=offset), 1e-3
    weights = [4 / 5, -1 / 5, 4 / 105, -1 / 280]
    difference = sum(
        w * (cam.points(ANGLE + k * step) - cam.points(ANGLE - k * step)) / step
        for k, w in enumerate(weights, 1)
    )
    np.testing.assert_allclose(cam.velocity(ANGLE), difference, rtol=0, atol=1e-8)


@with_offsets
def test_curvature_is_that_of_a_circle_through_three_points(offset):
    """Menger curvature of points 0.2 mrad apart: rtol is its second-order error."""
    cam, step = contour(offset=offset), 2e-4
    a, b, c = (cam.points(ANGLE + k * step) for k in (-1, 0, 1))
    (ux, uy), (vx, vy), (wx, wy) = b - a, c - b, c - a
    sides = np.hypot(ux, uy) * np.hypot(vx, vy) * np.hypot(wx, wy)
    menger = 2 * (ux * vy - uy * vx) / sides
    np.testing.assert_allclose(cam.curvature(ANGLE), menger, rtol=1e-4, atol=1e-3)


def test_radius_of_curvature_is_a_roller_radius_less_on_both_sides_of_zero():
    cam = contour()
    radius = cam.radius_of_curvature(ANGLE)
    assert (radius > 0).any()
    assert (radius < -0.008).any()
    np.testing.assert_allclose(1 / radius, cam.curvature(ANGLE), rtol=1e-12)
    hollow = cam.pitch.curvature(ANGLE) < 0
    np.testing.assert_array_equal(radius < 0, hollow)


def test_relative_radius_of_the_contact_follows_from_the_factor():
    """1/R = 1/r + 1/R_c = 1 / (r (1 - r kappa)), which Hertz theory needs."""
    cam = contour()
    relative = 1 / 0.008 + cam.curvature(ANGLE)
    np.testing.assert_allclose(relative, 1 / (0.008 * cam.factor(ANGLE)), rtol=1e-12)


def test_hollow_flank_is_found():
    cam = contour()
    radius, theta = cam.concave_radius_min()
    dense = cam.radius_of_curvature(np.linspace(0, 2 * np.pi, 100_001))
    assert radius == pytest.approx(-dense[dense < 0].max(), rel=1e-6)
    assert cam.radius_of_curvature(theta) == pytest.approx(-radius, rel=1e-12)


def test_convex_cam_has_no_hollow():
    assert contour(Lift(THETA, np.zeros(360))).concave_radius_min().value == np.inf


def test_extreme_radii_are_those_of_the_lift():
    cam = contour()
    assert cam.radius_max().value == pytest.approx(0.042 + WAVY.highest.value, rel=1e-12)
    assert cam.radius_min().value == pytest.approx(0.042 + WAVY.lowest.value, rel=1e-12)


def test_polygon_encloses_the_area():
    """A polygon of 20 000 corners misses the smooth area by (2 pi / n)^2 / 6 of it."""
    cam = contour()
    x, y = cam.polygon(20_000)
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    cross = x * y1 - x1 * y
    area = 0.5 * cross.sum()
    assert cam.area() == pytest.approx(area, rel=1e-7)
    assert cam.perimeter() == pytest.approx(np.hypot(x1 - x, y1 - y).sum(), rel=1e-7)
    centre = [((x + x1) * cross).sum() / (6 * area), ((y + y1) * cross).sum() / (6 * area)]
    np.testing.assert_allclose(cam.centroid(), centre, rtol=0, atol=1e-9)


@pytest.mark.parametrize("roller_radius", [0.0, -0.008, np.nan, 0.05, 0.08])
def test_refuses_a_roller(roller_radius):
    with pytest.raises(InputError, match=r"roller.radius"):
        contour(roller_radius=roller_radius)


# Undercut ----------------------------------------------------------------------------------


@pytest.mark.parametrize("phase", [0.0, 0.5, 0.3, 0.125])
def test_undercut_is_judged_at_the_limit(phase):
    """Roller 1 % below and above the least convex radius, which lies at the lobes' crests."""
    lift = lobed(phase)
    limit = PitchCurve(lift, 0.05).least_convex_radius().value
    fits, cuts = (contour(lift, roller_radius=limit * part) for part in (0.99, 1.01))
    assert not fits.undercut().present
    assert fits.undercut().factor == pytest.approx(0.01, rel=1e-9)
    assert fits.self_intersections() == ()
    assert cuts.undercut().present
    assert cuts.undercut().factor == pytest.approx(-0.01, rel=1e-9)
    assert len(cuts.self_intersections()) == 6
    assert contour(lift, roller_radius=limit).undercut().factor == pytest.approx(0, abs=1e-14)


def test_cusp_midway_between_samples_is_caught():
    """The samples see a roller that fits with 1 % to spare; midway it cuts."""
    lift = lobed(0.5, lobes=12, height=0.001)
    sampled = contour(lift).pitch.curvature(lift.theta).max()
    sharpest = contour(lift).pitch.curvature_max()
    half_step = np.pi / 144
    assert np.mod(sharpest.theta, 2 * np.pi / 12) == pytest.approx(half_step, abs=1e-7)
    radius = 1 / (0.5 * (sampled + sharpest.value))
    cam = contour(lift, roller_radius=radius)
    assert (cam.factor(lift.theta) > 0.005).all()
    assert cam.undercut().present
    assert cam.undercut().factor < -0.005
    assert len(cam.self_intersections()) == 12


@pytest.mark.parametrize("excess", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("phase", [0.5, 0.37])
def test_swallow_tail_shorter_than_a_sample_is_found(phase, excess):
    """Near the limit it closes at sqrt(3) times its cusps; the next term is 0.3 of the excess."""
    lift = lobed(phase)
    limit = PitchCurve(lift, 0.05).least_convex_radius().value
    cam = contour(lift, roller_radius=limit * (1 + excess))
    pairs = np.array(cam.self_intersections())
    assert len(pairs) == 6
    np.testing.assert_allclose(cam.points(pairs[:, 0]), cam.points(pairs[:, 1]), rtol=0, atol=1e-16)
    crest = cam.undercut().theta
    left, right = (
        brentq(lambda theta: float(cam.factor(theta)), crest, crest + side) for side in (-0.1, 0.1)
    )
    assert right - left < 2 * np.pi / 144 or excess == 1e-2
    width = np.ptp(pairs, axis=1)
    width = np.minimum(width, 2 * np.pi - width)
    np.testing.assert_allclose(width, np.sqrt(3) * (right - left), rtol=0.5 * excess)


def test_undercut_contour_still_gives_every_result():
    cam = contour(lobed(0.5), roller_radius=0.03)
    assert cam.undercut().factor < -0.2
    assert cam.self_intersections()
    assert cam.second_contact().clearance < -1e-4
    for value in (
        cam.area(),
        cam.perimeter(),
        *cam.centroid(),
        *cam.radius_max(),
        *cam.radius_min(),
    ):
        assert np.isfinite(value)
    assert np.isfinite(cam.points(ANGLE)).all()
    assert np.isfinite(cam.curvature(ANGLE)).all()


# Crossing flanks and second contact --------------------------------------------------------


def test_flanks_of_a_narrow_lobe_cross():
    cam = narrow_lobe(0.003)
    pair = max(cam.self_intersections(), key=np.ptp)
    np.testing.assert_allclose(*cam.points(np.array(pair)).T, rtol=0, atol=1e-16)
    assert sum(pair) == pytest.approx(2 * np.pi, abs=1e-9)
    assert pair[0] == pytest.approx(0.510, abs=1e-3)
    assert cam.second_contact().clearance <= 0


def test_clearance_agrees_with_a_brute_search():
    cam = narrow_lobe(0.006)
    assert cam.self_intersections() == ()
    found = cam.second_contact()
    assert found.clearance > 0
    near = np.linspace(-0.02, 0.02, 401)
    one, two = np.meshgrid(found.theta + near, found.other + near)
    x, y = cam.points(two) - cam.pitch.points(one)
    assert found.clearance == pytest.approx(np.hypot(x, y).min() - 0.002, abs=1e-9)


def test_clearance_and_crossing_agree():
    """The flanks cross just when the roller on one of them cuts into the other."""
    cams = [narrow_lobe(radius) for radius in (0.003, 0.0035, 0.0038, 0.004, 0.005, 0.006)]
    gaps = [cam.second_contact().clearance for cam in cams]
    assert gaps == sorted(gaps)
    crossed = [bool(cam.self_intersections()) for cam in cams]
    assert [gap <= 0 for gap in gaps] == crossed
    assert True in crossed
    assert False in crossed


def test_round_cam_has_no_second_contact():
    found = contour(Lift(THETA, np.zeros(360))).second_contact()
    assert found.clearance == np.inf


# Surface at a contact ----------------------------------------------------------------------


@with_offsets
def test_surface_offset_agrees_with_the_points(offset):
    """Contour points seen from the contact frame give xi and height with no equation solved."""
    cam = contour(offset=offset)
    there = ANGLE[:, None] + np.linspace(-0.02, 0.02, 41)
    frame = cam.local_frame(ANGLE)
    away = cam.points(there) - frame.point[..., None]
    xi = np.sum(away * frame.tangent[..., None], axis=0)
    height = np.sum(away * frame.normal[..., None], axis=0)
    np.testing.assert_allclose(cam.surface_offset(ANGLE, xi), height, rtol=0, atol=1e-15)


def test_surface_offset_has_the_curvature_of_the_contour():
    cam = contour()
    xi = 1e-5
    height = cam.surface_offset(ANGLE, [-xi, 0.0, xi])
    np.testing.assert_allclose(height[:, 1], 0, rtol=0, atol=3e-17)
    curvature = -(height[:, 0] + height[:, 2]) / xi**2
    np.testing.assert_allclose(curvature, cam.curvature(ANGLE), rtol=1e-4, atol=1e-4)


def test_surface_offset_takes_any_shape():
    cam = contour()
    shared = cam.surface_offset(ANGLE[:6].reshape(2, 3), np.linspace(-1e-4, 1e-4, 5))
    assert shared.shape == (2, 3, 5)
    one = cam.surface_offset(ANGLE[1], np.linspace(-1e-4, 1e-4, 5))
    np.testing.assert_allclose(one, shared[0, 1], rtol=0, atol=3e-17)


def test_surface_offset_refuses_what_is_out_of_reach():
    with pytest.raises(GeometryError, match="cam angle"):
        contour().surface_offset(ANGLE, [0.5])
