"""Lifts through points and near noisy tables."""

import re

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.geometry.lift_fit import (
    BELOW_ZERO,
    estimated_noise,
    fitted_lift,
    lift_through,
    measured_lift,
    overshoot,
)
from camwright.geometry.motion_laws import Segment, SegmentMotion

MOTION = SegmentMotion(
    (Segment("polynomial_4567", np.pi, 0.01), Segment("polynomial_4567", np.pi, -0.01))
)
ROWS = np.arange(720) * 2 * np.pi / 720
NOISE = 5e-6


def noisy(noise=NOISE):
    return MOTION(ROWS) + 1e-4 + np.random.default_rng(7).normal(0, noise, ROWS.size)


def test_spline_passes_through_its_points():
    angle = np.array([0.0, 0.9, 1.7, 2.6, 3.3, 4.4, 5.5])
    value = np.array([0.004, 0.006, 0.009, 0.01, 0.009, 0.007, 0.005])
    lift = lift_through(angle, value)
    np.testing.assert_allclose(lift(angle), value, rtol=0, atol=1e-12)
    for order in range(4):
        assert lift(0.0, order) == pytest.approx(lift(2 * np.pi - 1e-9, order), rel=1e-6, abs=1e-8)


def test_fit_states_its_residual_and_smooths():
    table = noisy()
    fit = fitted_lift(ROWS, table, 1.05 * NOISE)
    np.testing.assert_array_equal(fit.residual, table - fit.lift(ROWS))
    assert 0.9 * NOISE < fit.residual_rms < 1.05 * NOISE
    assert fit.residual_rms < fit.residual_max < 6 * NOISE
    # the truth is nearer than the noise, and the acceleration no longer drowned
    assert np.sqrt(np.mean((fit.lift(ROWS) - MOTION(ROWS) - 1e-4) ** 2)) < 0.4 * NOISE
    worst = np.abs(fit.lift(ROWS, 2) - MOTION(ROWS, 2)).max() / np.abs(MOTION(ROWS, 2)).max()
    assert worst < 0.05


def test_understated_noise_is_refused():
    with pytest.raises(InputError, match=r"lift\.noise"):
        fitted_lift(ROWS, noisy(), 0.1 * NOISE)


def test_exact_table_is_met_by_few_parts():
    theta = np.sort(np.random.default_rng(3).uniform(0, 2 * np.pi, 300))
    fit = fitted_lift(theta, 0.01 * (1 - np.cos(theta)), 1e-6)
    assert fit.parts < 40
    assert fit.residual_max < 5e-6


@pytest.mark.parametrize("noise", [0.0, -1e-6, np.nan, np.inf])
def test_noise_must_be_positive(noise):
    with pytest.raises(InputError, match=r"lift\.noise"):
        fitted_lift(ROWS, noisy(), noise)


def test_bad_tables_are_refused():
    with pytest.raises(InputError, match="rows"):
        fitted_lift(ROWS[::40], MOTION(ROWS[::40]), 1e-6)
    with pytest.raises(InputError, match="points"):
        lift_through([0.0, 1.0, 2.0], [0.0, 1e-3, 0.0])
    with pytest.raises(InputError, match="strictly increasing"):
        lift_through([0.0, 2.0, 1.0, 3.0, 4.0, 5.0, 6.0], np.zeros(7))
    with pytest.raises(InputError, match="must close"):
        lift_through(np.linspace(0, 2 * np.pi, 8), np.linspace(0, 1e-3, 8))
    with pytest.raises(InputError, match="within one turn"):
        lift_through(np.linspace(0, 7, 8), np.zeros(8))
    with pytest.raises(InputError, match="as many"):
        lift_through(np.linspace(0, 6, 8), np.zeros(7))
    with pytest.raises(InputError, match="finite"):
        lift_through(np.linspace(0, 6, 8), np.full(8, np.nan))


@pytest.mark.parametrize("noise", [1e-7, 2e-6, 2e-5])
@pytest.mark.parametrize("law", ["cycloidal", "polynomial_345", "parabolic"])
def test_noise_is_estimated_from_the_differences(noise, law):
    """Within 20 %: three standard errors of the median of 360 correlated differences."""
    half = np.pi / 2
    motion = SegmentMotion(
        (Segment(law, half, 0.01), Segment("dwell", half), Segment(law, half, -0.01),
         Segment("dwell", half))
    )  # fmt: skip
    theta = np.arange(360) * 2 * np.pi / 360
    table = motion(theta) + np.random.default_rng(1).normal(0, noise, theta.size)
    assert estimated_noise(theta, table) == pytest.approx(noise, rel=0.2)
    fit = measured_lift(theta, table)
    assert fit is None or fit.residual_rms <= fit.noise
    assert estimated_noise(np.delete(theta, 3), np.delete(table, 3)) is None


def test_a_value_below_zero_by_more_than_its_errors_is_refused():
    table = noisy() - 1e-4
    deep = table.copy()
    deep[0] = -1.01 * BELOW_ZERO * NOISE
    limit = r"lift\.values = -0\.02525 mm at 0 deg, must be >= -0\.025 mm, 5 times"
    with pytest.raises(InputError, match=limit):
        fitted_lift(ROWS, deep, NOISE)
    deep[0] = -0.99 * BELOW_ZERO * NOISE
    assert fitted_lift(ROWS, deep, 1.1 * NOISE).noise == 1.1 * NOISE


def test_a_spline_that_overshoots_says_where_and_by_how_much():
    angle = np.radians([0, 60, 120, 180, 240, 300.0])
    value = np.array([0, 0, 0.01, 0.01, 0.01, 0.0])
    with pytest.raises(InputError) as error:
        lift_through(angle, value)
    spline = lift_through(angle, value + 0.005)  # the same, above zero
    depth = spline.lowest.value - 0.005
    message = str(error.value)
    assert f"a spline down to {1e3 * depth:.3g}" in message
    place, start, end = (float(each) for each in re.findall(r"([\d.]+) deg", message))
    assert start < place < end
    assert {start % 360.0, end % 360.0} <= set(np.degrees(angle).round(9))
    away, at = overshoot(angle, value + 0.005, spline)
    assert abs(away) >= 0.99 * abs(depth)
    levels = [abs(spline(at) - 0.005 - level) for level in (0.0, 0.01)]
    assert min(levels) == pytest.approx(abs(away))
