"""Piecewise-linear pressures: shapes, exact integrals, what is read off them."""

import numpy as np
import pytest

from camwright.geometry.errors import ContactError
from camwright.pipeline.contact.elasticity.pressure_distribution import (
    EllipticShapes,
    PressureShapes,
    fitted_ellipses,
)

KNOTS = np.array([-1.0, -0.7, -0.1, 0.2, 0.9, 1.3])


def test_shapes_are_one_at_their_own_knot_and_straight_between():
    shapes = PressureShapes(KNOTS)
    np.testing.assert_allclose(shapes.values(shapes.centres), np.eye(4), atol=1e-15)
    np.testing.assert_allclose(shapes.values(np.array([0.55]))[:, 0], [0, 0, 0.5, 0.5], atol=1e-15)


def test_open_ends_add_up_to_one():
    shapes = PressureShapes(KNOTS, open_ends=True)
    x = np.linspace(-1, 1.3, 50)
    np.testing.assert_allclose(shapes.values(x).sum(axis=0), 1.0, rtol=1e-14)
    assert shapes.centres.size == 6


def test_shapes_vanish_outside():
    assert (PressureShapes(KNOTS, open_ends=True).values(np.array([-1.1, 1.4])) == 0).all()


@pytest.mark.parametrize("open_ends", [False, True])
def test_integrals_agree_with_quadrature(open_ends):
    shapes = PressureShapes(KNOTS, open_ends=open_ends)
    xi, weights = shapes.quadrature()
    np.testing.assert_allclose(shapes.values(xi) @ weights, shapes.integrals, rtol=1e-14)
    np.testing.assert_allclose(
        shapes.integrated(xi**2, xi, weights), (shapes.values(xi) * xi**2) @ weights
    )


def test_quadrature_is_exact_for_kinks_at_the_breaks():
    shapes = PressureShapes(KNOTS)
    exact = 0.5 * ((1.3 - 0.33) ** 2 + (1.0 + 0.33) ** 2)
    with_break, without = (
        float(np.abs(xi - 0.33) @ weights)
        for xi, weights in (shapes.quadrature([0.33, 7.0, -9.0]), shapes.quadrature())
    )
    np.testing.assert_allclose(with_break, exact, rtol=1e-14)
    assert abs(without / exact - 1) > 1e-4


def test_breaks_on_knots_leave_no_slivers():
    shapes = PressureShapes(KNOTS)
    _, weights = shapes.quadrature(KNOTS + 1e-16)
    assert weights.size == 5 * 6 and weights.min() > 0


@pytest.mark.parametrize("shift", [0.0, 0.21, 0.5, 0.83])
def test_a_sampled_ellipse_is_read_back(shift):
    step = 1 / 16
    knots = (np.arange(-24, 25) + shift) * step
    shapes = PressureShapes(knots)
    pressure = np.sqrt(np.maximum(1 - shapes.centres**2, 0))[None]
    found = fitted_ellipses(shapes, pressure)
    # Chords lie below the ellipse by a share h^(3/2) at the edge: about 1 % of the area.
    np.testing.assert_allclose(found.p0, 1.0, rtol=2e-3)
    np.testing.assert_allclose(found.half_width, 1.0, rtol=8e-3)
    np.testing.assert_allclose(found.centre, 0.0, atol=3e-3)


def test_an_ellipse_off_centre_and_in_other_units():
    knots = np.linspace(-2e-4, 3e-4, 101)
    shapes = PressureShapes(knots)
    centre, width = 4e-5, 1.2e-4
    pressure = 7e8 * np.sqrt(np.maximum(1 - ((shapes.centres - centre) / width) ** 2, 0))
    found = fitted_ellipses(shapes, np.stack([pressure, 2 * pressure]))
    np.testing.assert_allclose(found.p0, [7e8, 14e8], rtol=1e-3)
    np.testing.assert_allclose(found.half_width, width, rtol=6e-3)
    np.testing.assert_allclose(found.centre, centre, atol=1e-3 * width)


def test_too_few_knots_are_no_contact_to_measure():
    shapes = PressureShapes(np.linspace(-1, 1, 9))
    with pytest.raises(ContactError, match="3 pressure knots"):
        fitted_ellipses(shapes, np.array([[0, 0, 1.0, 1.2, 1.0, 0, 0]]))


def test_elliptic_shapes_hold_a_hertz_pressure_on_uneven_knots():
    shapes = EllipticShapes.within(np.linspace(-2.0, 2.0, 23), np.array([-1.1, 0.9]))
    assert shapes.knots[0] == -1.1 and shapes.knots[-1] == 0.9
    assert np.diff(shapes.knots).min() > 0.5 * 4 / 22
    pressure = np.full((1, shapes.knots.size), 7.0)
    assert (pressure @ shapes.integrals)[0] == pytest.approx(7 * np.pi / 2, rel=1e-12)
    xi = np.array([-1.2, -1.1, -0.6, 0.9, 1.0])
    expected = 7 * np.sqrt(np.maximum(1 - (xi + 0.1) ** 2, 0))
    np.testing.assert_allclose(pressure[0] @ shapes.values(xi), expected, atol=1e-7)
    found = fitted_ellipses(shapes, pressure)
    np.testing.assert_allclose([found.p0[0], found.centre[0], found.half_width[0]], [7, -0.1, 1],
                               rtol=1e-12)  # fmt: skip


def test_quadrature_of_elliptic_shapes_takes_the_breaks_of_a_surface():
    shapes = EllipticShapes(np.linspace(-1.0, 1.0, 9))
    xi, weights = shapes.quadrature([-3.0, -0.99, 0.123])
    kink = np.abs(xi - 0.123) * np.sqrt(1 - xi**2)
    x = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 200001))
    dense = np.abs(x - 0.123) * (1 - x**2)
    expected = dense.sum() * np.pi / 200000
    assert kink @ weights == pytest.approx(expected, rel=1e-8)
