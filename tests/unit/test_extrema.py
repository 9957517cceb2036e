"""Extremes of periodic functions whose places are known."""

import re
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry import extrema
from camwright.geometry.extrema import (
    first_greatest,
    first_greatest_of_rows,
    first_least,
    greatest,
    least,
    local_minima,
    sampled_greatest,
)


@pytest.mark.parametrize("place", [0.0, 1e-9, 1.234567, 3.0, 6.28])
@pytest.mark.parametrize("sharpness", [1.0, 20.0])
def test_extreme_of_a_lopsided_hump(place, sharpness):
    """Value to round-off; the angle to the root of it, as for any extreme found by values."""

    def hump(theta):
        turned = theta - place
        return np.exp(sharpness * (np.cos(turned + 0.3 * np.sin(turned)) - 1))

    found = greatest(hump, 50)
    assert found.value == pytest.approx(1.0, abs=1e-15)
    assert np.cos(found.theta - place) == pytest.approx(1.0, abs=1e-14)
    assert least(lambda theta: -hump(theta), 50) == (-found.value, found.theta)


def test_every_valley_is_refined():
    """sin 3t + 0.1 sin t: three minima, against the roots of the derivative."""
    values, theta = local_minima(lambda t: np.sin(3 * t) + 0.1 * np.sin(t), 24)
    assert len(values) == 3
    np.testing.assert_allclose(3 * np.cos(3 * theta) + 0.1 * np.cos(theta), 0, atol=1e-6)
    np.testing.assert_allclose(values, np.sin(3 * theta) + 0.1 * np.sin(theta), rtol=1e-14)


@pytest.mark.parametrize("place", np.linspace(0, 2 * np.pi / 24, 7))
def test_sharp_minimum_is_bracketed_to_its_edge(place):
    """A lopsided kink needs every part of its bracket: found to the last one, 1e-9 rad."""

    def valley(theta):
        side = np.sin(theta - place)
        return np.where(side > 0, side, -20 * side) - np.cos(theta - place)

    found = least(valley, 24)
    assert found.value == pytest.approx(-1, abs=1e-8)
    assert np.sin(found.theta - place) == pytest.approx(0, abs=1e-9)


def test_constant_has_its_value():
    assert least(np.ones_like, 5000).value == 1.0


def test_of_a_function_that_is_not_known_everywhere_nothing_is_known():
    def known_but_for_a_gap(theta):
        return np.where(np.abs(theta - 2.0) < 0.1, np.nan, np.cos(theta))

    for extreme in (least, greatest):
        found = extreme(known_but_for_a_gap, 720)
        assert np.isnan(found.value)
        assert abs(found.theta - 2.0) < 0.11


def test_a_maximum_between_samples_is_that_of_the_function() -> None:
    theta = np.arange(180) * (2.0 * np.pi / 180.0)
    values = np.cos(theta - np.array([[0.3], [0.301], [0.317]])) + 2.0
    np.testing.assert_allclose(sampled_greatest(values), 3.0, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("middle", [0.0, 0.5, 1.0])
def test_a_step_between_samples_has_no_maximum_beyond_them(middle: float) -> None:
    """One sample may lie on the flank of the step; the plateau falls slowly."""
    values = np.r_[np.zeros(20), middle, 1.0 - 1e-3 * np.arange(20)]
    assert sampled_greatest(values) == pytest.approx(1.0, abs=1e-3)


def test_a_kink_between_samples_is_bounded_by_its_sides() -> None:
    """Slopes 1 and -3 meet at 0.4 of a step: the value there is 0.4 above the sample before."""
    place = np.arange(-20.0, 20.0)
    values = np.where(place <= 0.4, place, 0.4 - 3.0 * (place - 0.4))
    assert 0.0 <= sampled_greatest(values) <= 0.4 + 1e-12


def test_lowest_of_several_minima_beside_a_plateau():
    """Brackets that cannot hold the lowest minimum are left out; the plateau is not the lowest."""

    def function(theta):
        return np.minimum(0.0, 0.5 - np.cos(theta - 1.0)) - 1e-9 * np.cos(3.0 * theta)

    every, _ = local_minima(function, 720)
    best = least(function, 720)
    assert best.value == every.min()
    assert best.value == pytest.approx(-0.5, abs=2e-9)
    assert best.theta == pytest.approx(1.0, abs=1e-6)
    few, _ = local_minima(function, 720, lowest=True)
    assert len(few) < len(every)


@pytest.mark.parametrize(
    ("values", "place"),
    [
        ([1.0, 3.0, 3.0 + 1e-12, 2.0], 1),
        ([3.0 + 1e-8, 3.0, 3.0 + 2e-8], 2),
        ([-5.0, 1e-12, 0.0], 1),  # round-off of the greatest magnitude
        ([1.0, np.nan, np.inf], 1),
        ([1.0, np.inf, np.inf], 1),
        ([-np.inf, -np.inf], 0),
        ([-np.inf, -2.0, -2.0 + 1e-12], 1),
    ],
)
def test_of_equal_values_the_first_is_the_greatest(values, place):
    assert first_greatest(values) == place
    assert first_least(-np.array(values)) == place
    rows = np.array([values, values[::-1]])
    assert first_greatest_of_rows(rows)[0] == place


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count", [72, 720])
def test_round_off_does_not_move_the_place_of_an_extreme(seed, count):
    """A dwell and two equal humps: value and angle are those without round-off."""

    def dwell(theta):
        return 0.04 * np.where(theta < 2.0, 0.0, np.sin(0.5 * (theta - 2.0)) ** 2)

    def humps(theta):
        return np.cos(2.0 * theta)

    noise = np.random.default_rng(seed)
    for function in (dwell, humps, np.ones_like):
        for extreme in (least, greatest):
            exact = extreme(function, count)
            rough = extreme(
                lambda t, f=function: f(t) * (1 + 1e-15 * noise.normal(size=t.shape)) + 1e-18, count
            )
            assert rough.value == pytest.approx(exact.value, abs=1e-14)
            assert np.cos(rough.theta - exact.theta) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("shift", [0.0, 0.3, 0.5])
def test_a_sampled_peak_is_at_its_vertex(shift):
    """A cosine by 72 samples to 2e-6 and 0.001 deg; a tent within half a step."""
    step = 2.0 * np.pi / 72
    place = (40.0 + shift) * step
    theta = np.arange(72) * step
    round_top = extrema.sampled_peak(np.cos(theta - place))
    assert round_top.value == pytest.approx(1.0, abs=2e-6)
    assert round_top.theta == pytest.approx(place, abs=np.radians(1e-3))
    tent = extrema.sampled_peak(-np.abs(theta - place))
    if shift:  # between two samples; a corner on one of them is that sample
        assert tent.value == pytest.approx(0.0, abs=0.5 * step)
    assert tent.value <= 1e-12
    assert abs(tent.theta - place) <= 0.5 * step


def test_a_sampled_peak_beside_infinity_is_its_sample():
    values = np.array([0.0, 1.0, 2.0, -np.inf, 0.0, 0.0])
    assert extrema.sampled_peak(values) == (2.0, 2.0 * np.pi / 3.0)
    values[0] = np.nan
    assert np.isnan(extrema.sampled_peak(values).value)
    equal = np.array([0.0, 1.0, 0.0, 0.0, 1.0 + 1e-15, 0.0])
    assert extrema.sampled_peak(equal).theta == pytest.approx(np.pi / 3.0)


def test_no_record_rests_on_the_order_of_equal_values():
    """What chooses a place of a solution takes the first of equal ones; see `first_greatest`."""
    root = Path(extrema.__file__).parents[1] / "pipeline"
    files = (file for part in ("checks", "cycle") for file in (root / part).rglob("*.py"))
    assert [file.name for file in files if re.search(r"\barg(max|min)\(", file.read_text())] == []
