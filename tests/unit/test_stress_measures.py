"""Scalar measures of stress, and peaks between scattered points."""

import numpy as np
import pytest

from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.fitted_stress import fitted_stress, greatest_fitted
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


MODULUS, NU = 210e9, 0.3
Polynomial = np.polynomial.Polynomial


def moved(z, phi, slope, psi):
    """Displacement (2, n), m, of complex potentials."""
    u = ((3 - 4 * NU) * phi - z * np.conj(slope) - np.conj(psi)) * (1 + NU) / MODULUS
    return np.stack([u.real, u.imag])


def below_the_surface(count):
    points = np.random.default_rng(3).uniform((-1.2, -1.7), (1.2, 0.0), (count, 2)).T
    return points, points[0] + 1j * points[1]


def test_stress_of_cubic_potentials_is_fitted_exactly():
    phi, psi = Polynomial([0, 2 + 1j, 0.3 - 0.2j, 0.1j]), Polynomial([0, 1j, -0.4, 0.2])
    points, z = below_the_surface(500)
    own = moved(z, phi(z), phi.deriv()(z), psi(z))
    fit = fitted_stress(points, own, (MODULUS, NU), np.array([0.1, -0.8]), 0.6)
    middle = 2 * phi.deriv()(z).real
    across = np.conj(z) * phi.deriv(2)(z) + psi.deriv()(z)
    exact = np.stack([middle - across.real, middle + across.real, across.imag])
    np.testing.assert_allclose(fit(points), exact, atol=1e-9 * np.abs(exact).max())


def under_a_unit_ellipse(count):
    """Nodes and displacements of a half-plane y < 0 under the pressure sqrt(1 - x^2).

    Muskhelishvili (1953), half-plane: phi' = i (z - sqrt(z^2 - 1))/2, psi = phi - z phi'.
    """
    points, z = below_the_surface(count)
    root = np.sqrt(z - 1) * np.sqrt(z + 1)
    phi = 0.25j * (z**2 - z * root + np.log(z + root))
    slope = 0.5j * (z - root)
    return points, moved(z, phi, slope, phi - z * slope)


@pytest.mark.parametrize("start", [(0.0, -0.6), (0.2, -0.9)])
def test_fitted_maxima_are_those_of_hertz(start):
    points, own = under_a_unit_ellipse(260)  # as many as on four edges per half-width

    def about(place):
        return fitted_stress(points, own, (MODULUS, NU), place, 0.6)

    top, place = greatest_fitted(about, shear_in_plane, np.array(start))
    np.testing.assert_allclose(top, hertz.SHEAR_MAX, rtol=2e-4)
    np.testing.assert_allclose(place, [0.0, -hertz.SHEAR_MAX_DEPTH], atol=0.01)
    mises, _ = greatest_fitted(about, lambda stress: von_mises(stress, NU), np.array(start))
    np.testing.assert_allclose(mises, hertz.von_mises_peak(NU)[0], rtol=2e-4)


def test_no_fit_without_nodes_and_no_maximum_of_a_stress_that_grows():
    points, own = under_a_unit_ellipse(260)
    place = np.array([0.0, -0.8])
    assert fitted_stress(points, own, (MODULUS, NU), place, 0.1) is None
    z = points[0] + 1j * points[1]
    bent = moved(z, 0.1j * z**2, 0.2j * z, 0.0 * z)  # shear grows with the distance

    def about(place):
        return fitted_stress(points, bent, (MODULUS, NU), place, 0.6)

    assert greatest_fitted(about, shear_in_plane, place) is None
