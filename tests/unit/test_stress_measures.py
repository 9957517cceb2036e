"""Scalar measures of stress, and peaks between scattered points."""

import numpy as np

from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.plane_stress_measures import (
    PeakFinder,
    all_measures,
    shear_any_plane,
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


def half_disc(spacing=0.05):
    x, z = np.meshgrid(np.arange(-1.6, 1.6, spacing), np.arange(0.0, 1.6, spacing))
    points = np.stack([x.ravel(), z.ravel()])
    return points[:, np.hypot(*points) < 1.6]


def test_measures_of_one_stress_are_those_of_each_alone():
    stress = np.random.default_rng(3).normal(size=(3, 40))
    alone = shear_in_plane(stress), shear_any_plane(stress, 0.2), von_mises(stress, 0.2)
    np.testing.assert_array_equal(all_measures(stress, 0.2), alone)


def test_peaks_where_they_are_likely_are_those_over_all_points():
    """Under Hertz pressures, one and two apart, of different sizes."""
    points = half_disc()
    stress = np.stack(
        [
            hertz.subsurface_stress((points[0] - x) / a, points[1] / a)
            + share * hertz.subsurface_stress((points[0] + 0.6) / 0.3, points[1] / 0.3)
            for x, a, share in ((0.0, 1.0, 0.0), (0.02, 1.1, 0.2), (0.6, 0.3, 0.995))
        ],
        axis=2,
    )
    evaluated = set()

    def measured(nodes):
        evaluated.update(nodes.tolist())
        return all_measures(stress[:, nodes], 0.3)

    find = PeakFinder(points)
    for (top, where), field in zip(
        find.where_likely(measured), all_measures(stress, 0.3), strict=True
    ):
        expected, place = find(field)
        np.testing.assert_array_equal(top, expected)
        np.testing.assert_array_equal(where, place)
    assert len(evaluated) < 0.8 * points.shape[1]
