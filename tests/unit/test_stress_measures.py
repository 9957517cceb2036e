"""Scalar measures of stress, and peaks between scattered points."""

import numpy as np

from camwright.pipeline.contact.elasticity.plane_stress_measures import (
    PeakFinder,
    shear_in_plane,
    von_mises,
)


def test_pure_shear():
    np.testing.assert_allclose(shear_in_plane([0.0, 0.0, 3.0]), 3.0)
    np.testing.assert_allclose(von_mises([0.0, 0.0, 3.0], 0.3), 3.0 * np.sqrt(3))


def test_pressure_from_all_sides_of_the_plane():
    assert shear_in_plane([-2.0, -2.0, 0.0]) == 0
    np.testing.assert_allclose(von_mises([-2.0, -2.0, 0.0], 0.3), 2.0 * (1 - 2 * 0.3))


def test_measures_agree_with_principal_stresses():
    rng = np.random.default_rng(1)
    for xx, yy, xy in rng.normal(size=(20, 3)):
        first, second = np.linalg.eigvalsh([[xx, xy], [xy, yy]])
        third = 0.25 * (xx + yy)
        mises = np.sqrt(((first - second) ** 2 + (second - third) ** 2 + (third - first) ** 2) / 2)
        np.testing.assert_allclose(shear_in_plane([xx, yy, xy]), (second - first) / 2, rtol=1e-12)
        np.testing.assert_allclose(von_mises([xx, yy, xy], 0.25), mises, rtol=1e-12)


def scattered():
    rng = np.random.default_rng(7)
    x, z = np.meshgrid(np.linspace(-1, 1, 25), np.linspace(0, 1.5, 20))
    jitter = 0.02 * rng.normal(size=(2, x.size))
    points = np.stack([x.ravel(), z.ravel()]) + jitter
    points[1] = np.abs(points[1])
    return points


def test_peak_of_a_parabola_is_found_exactly_between_the_points():
    points = scattered()
    places = np.array([[0.13, -0.41], [0.77, 0.52]])
    fields = np.stack(
        [
            3
            - (points[0] - x) ** 2
            - 2 * (points[1] - z) ** 2
            + 0.5 * (points[0] - x) * (points[1] - z)
            for x, z in places.T
        ],
        axis=1,
    )
    top, where = PeakFinder(points)(fields)
    np.testing.assert_allclose(top, 3.0, rtol=1e-10)
    np.testing.assert_allclose(where, places, atol=1e-8)


def test_peak_of_a_falling_field_stays_at_the_surface():
    points = scattered()
    field = (2 - points[1])[:, None]
    top, where = PeakFinder(points)(field)
    np.testing.assert_allclose(top, field.max())
    assert where[1, 0] == points[1].min()


def test_nothing_gives_nothing():
    top, _ = PeakFinder(scattered())(np.zeros((500, 3)))
    assert (top == 0).all()
