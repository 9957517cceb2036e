"""The eccentric circle and its slider-crank, beside finite differences and the cam's geometry."""

import numpy as np
import pytest

from camwright.geometry.contour import RollerContour
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError
from camwright.geometry.linkage import SliderCrank
from camwright.geometry.pitch_curve import PitchCurve

PHI = np.linspace(0, 2 * np.pi, 181)
OFFSETS = pytest.mark.parametrize("offset", [0.0, 0.012, -0.007])
WEIGHTS = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])


def difference(function, h=0.02):
    """First derivative over eight points, order h^8."""
    return WEIGHTS @ function(PHI + h * np.arange(-4, 5)[:, None]) / h


@OFFSETS
def test_rates_are_differences(offset):
    pair = Eccentric(0.02, 0.08, offset)
    for rate, of in (
        (pair.height_rate, pair.height),
        (pair.height_rate_slope, pair.height_rate),
        (pair.rod_rate, pair.rod_angle),
        (pair.rod_rate_slope, pair.rod_rate),
    ):
        np.testing.assert_allclose(rate(PHI), difference(of), rtol=0, atol=1e-9)


@OFFSETS
def test_published_derivatives(offset):
    # eqs 23 and 24 of the paper, signs restored
    l1, l2 = 0.02, 0.08
    pair = Eccentric(l1, l2, offset)
    sin, cos = np.sin(PHI), np.cos(PHI)
    way = l1 * cos - offset
    u = 1 - (way / l2) ** 2
    first = l1 * (cos + way * sin / (l2 * np.sqrt(u)))
    second = -l1 * sin + l1 * (l2**2 * (-l1 * sin**2 + way * cos) * u - l1 * sin**2 * way**2) / (
        l2**3 * u**1.5
    )
    np.testing.assert_allclose(pair.height_rate(PHI), first, rtol=0, atol=1e-15)
    np.testing.assert_allclose(pair.height_rate_slope(PHI), second, rtol=0, atol=1e-14)


@OFFSETS
def test_cam_of_its_lift_is_the_circle(offset):
    pair = Eccentric(0.02, 0.08, offset)
    lift = pair.lift()
    pitch = PitchCurve(lift, pair.prime_radius, offset)
    contour = RollerContour(pitch, 0.0475)
    theta = PHI + 0.5 * np.pi
    np.testing.assert_allclose(pitch.height(theta), pair.height(PHI), rtol=0, atol=1e-12)
    np.testing.assert_allclose(lift(theta, 1), pair.height_rate(PHI), rtol=0, atol=1e-11)
    np.testing.assert_allclose(lift(theta, 2), pair.height_rate_slope(PHI), rtol=0, atol=1e-10)
    np.testing.assert_allclose(pitch.pressure_angle(theta), pair.rod_angle(PHI), atol=1e-10)
    np.testing.assert_allclose(pitch.radius_of_curvature(theta), 0.08, rtol=1e-9)
    np.testing.assert_allclose(contour.radius_of_curvature(theta), 0.0325, rtol=1e-8)
    x, y = contour.points(theta)
    np.testing.assert_allclose(np.hypot(x + 0.02, y), 0.0325, rtol=1e-10)


def test_agrees_with_the_slider_crank_of_the_engine():
    pair, other = Eccentric(0.02, 0.08, 0.01), SliderCrank(0.02, 0.08, 0.01)
    # the engine's crank angle starts on the slider's line, the mirror image of this one's
    travel = other.travel(0.5 * np.pi - PHI)
    np.testing.assert_allclose(other.top - travel, pair.height(PHI), rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("crank", "rod", "offset", "field"),
    [
        (0.0, 0.08, 0.0, "crank"),
        (np.nan, 0.08, 0.0, "crank"),
        (0.02, 0.02, 0.0, "rod"),
        (0.02, 0.08, 0.06, "rod"),
        (0.02, np.nan, 0.0, "rod"),
        (0.02, 0.08, np.nan, "rod"),
        (0.02, np.inf, 0.0, "rod"),
    ],
)
def test_linkage_that_cannot_turn_is_refused(crank, rod, offset, field):
    with pytest.raises(InputError, match=rf"mechanism\.{field}"):
        Eccentric(crank, rod, offset)
