"""Crossings of curves whose double points are known in closed form."""

import numpy as np
import pytest

from camwright.geometry.interference import _distinct, crossings, second_contact


def forwards(theta):
    """The factor of a curve that never runs backwards."""
    return np.ones_like(theta)


def limacon(theta):
    radius = 1 + 2 * np.cos(theta)
    return np.stack([radius * np.cos(theta), radius * np.sin(theta)])


def limacon_velocity(theta):
    radius, slope = 1 + 2 * np.cos(theta), -2 * np.sin(theta)
    return np.stack(
        [
            slope * np.cos(theta) - radius * np.sin(theta),
            slope * np.sin(theta) + radius * np.cos(theta),
        ]
    )


@pytest.mark.parametrize("count", [50, 90, 1000])
def test_limacon_passes_through_its_pole_twice(count):
    (pair,) = crossings(limacon, limacon_velocity, forwards, count)
    np.testing.assert_allclose(pair, [2 * np.pi / 3, 4 * np.pi / 3], rtol=1e-14)


def test_lissajous_curve_has_its_seven_double_points():
    """x = cos 2t, y = sin(3t + 0.4) has 2 p q - p - q = 7 of them."""

    def points(theta):
        return np.stack([np.cos(2 * theta), np.sin(3 * theta + 0.4)])

    def velocity(theta):
        return np.stack([-2 * np.sin(2 * theta), 3 * np.cos(3 * theta + 0.4)])

    pairs = np.array(crossings(points, velocity, forwards, 300))
    assert len(pairs) == 7
    np.testing.assert_allclose(points(pairs[:, 0]), points(pairs[:, 1]), rtol=0, atol=1e-14)
    assert (np.diff(pairs, axis=1) > 0).all()
    assert (np.diff(pairs[:, 0]) > 0).all()


def test_crossing_at_the_seam_is_found_once():
    """The limacon turned so that one pass is at angle 0, a corner of the first and last chord."""

    def turned(curve):
        return lambda theta: curve(theta + 2 * np.pi / 3)

    (pair,) = crossings(turned(limacon), turned(limacon_velocity), forwards, 90)
    np.testing.assert_allclose(np.cos(pair), [1, -0.5], rtol=0, atol=1e-12)


def test_pairs_are_ordered_and_told_once():
    """A crossing in a corner of two chords is met by up to four pairs of them."""
    first = np.array([5.0, 1.0, 3.0 + 1e-13, 1.0 + 2 * np.pi])
    second = np.array([2.0, 3.0, 1.0 - 1e-13, 3.0])
    assert _distinct(first, second) == pytest.approx(np.array([(1.0, 3.0), (2.0, 5.0)]))


def test_ellipse_has_no_crossing():
    def points(theta):
        return np.stack([3 * np.cos(theta), np.sin(theta)])

    def velocity(theta):
        return np.stack([-3 * np.sin(theta), np.cos(theta)])

    assert crossings(points, velocity, forwards, 500) == ()


@pytest.mark.parametrize("roller_radius", [0.5, 0.594, 0.606])
def test_second_contact_in_closed_form(roller_radius):
    """In a unit circle the centre 0.3 + 0.1 cos(theta - 1) off the middle is that much nearer."""

    def points(theta):
        return np.stack([np.cos(theta), np.sin(theta)])

    def centres(theta):
        return -(0.3 + 0.1 * np.cos(theta - 1.0)) * points(theta)

    def gap(contact, other):
        return np.hypot(*(points(other) - centres(contact))) - roller_radius

    found = second_contact(gap, 100)
    assert found.clearance == pytest.approx(0.6 - roller_radius, abs=1e-12)
    assert found.theta == pytest.approx(1.0, abs=1e-5)
    assert found.other == pytest.approx(1.0 + np.pi, abs=1e-5)
