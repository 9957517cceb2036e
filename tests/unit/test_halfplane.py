"""The half-plane in closed form, and contacts solved on it without any mesh."""

import numpy as np
import pytest

from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity import active_set
from camwright.pipeline.contact.elasticity.halfplane import (
    point_force_displacement,
    point_force_stress,
    settlement,
)
from camwright.pipeline.contact.elasticity.pressure_distribution import (
    PressureShapes,
    fitted_ellipses,
)


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.49])
def test_strain_of_the_displacement_is_the_stress(poisson):
    rng = np.random.default_rng(2)
    x, z, h = rng.uniform(-2, 2, 40), rng.uniform(0.3, 2, 40), 1e-5
    by_x = (
        point_force_displacement(x + h, z, poisson) - point_force_displacement(x - h, z, poisson)
    ) / (2 * h)
    by_z = (
        point_force_displacement(x, z + h, poisson) - point_force_displacement(x, z - h, poisson)
    ) / (2 * h)
    # In units of the plane-strain modulus: strain = stress - nu/(1-nu) of the other one.
    xx, zz, xz = point_force_stress(x, z)
    nu = poisson / (1 - poisson)
    np.testing.assert_allclose(by_x[0], xx - nu * zz, atol=1e-8)
    np.testing.assert_allclose(by_z[1], zz - nu * xx, atol=1e-8)
    np.testing.assert_allclose(by_x[1] + by_z[0], 2 * (1 + nu) * xz, atol=1e-8)


def test_point_force_balances():
    angle = np.linspace(-np.pi / 2, np.pi / 2, 2001)
    x, z = 2 * np.sin(angle), 2 * np.cos(angle)
    _, zz, xz = point_force_stress(x, z)
    down = -(xz * np.sin(angle) + zz * np.cos(angle)) * 2
    np.testing.assert_allclose(np.trapezoid(down, angle), 1.0, rtol=1e-6)


def test_settlement_is_the_integral_of_the_point_force():
    knots = np.array([-0.3, 0.1, 0.7])
    shapes = PressureShapes(knots)
    xi, weights = shapes.quadrature(np.linspace(-0.3, 0.7, 400))
    at = np.array([-2.0, 1.5, 4.0])
    kernel = -2 / np.pi * np.log(np.abs(at[:, None] - xi))
    expected = kernel @ (weights * shapes.values(xi)[0])
    found = settlement(at, knots)[0]
    np.testing.assert_allclose(np.diff(found), np.diff(expected), rtol=1e-10)


def pressed(knots, gap, force):
    """Pressures on an elastic half-plane, E / (1 - nu^2) = 1, under a rigid body."""
    shapes = PressureShapes(knots)
    xi, weights = shapes.quadrature()
    compliance = (shapes.values(xi) * weights) @ settlement(xi, knots).T
    found = active_set.solve(
        (compliance + compliance.T) / 2,
        shapes.integrated(gap(xi), xi, weights),
        shapes.integrals,
        [force],
    )
    assert found.equilibrium[0] < 1e-10 and found.complementarity[0] < 1e-9
    return shapes, found.pressure[0]


def test_hertz():
    # Ladder of the acceptance: peak within 1e-5 of the closed form.
    shapes, pressure = pressed(np.linspace(-1.2, 1.2, 481), lambda x: x**2 / 2, np.pi / 4)
    half_width, p0 = hertz.line_contact(np.pi / 4, 1.0, 1.0)
    np.testing.assert_allclose([half_width, p0], [1.0, 0.5], rtol=1e-14)
    found = fitted_ellipses(shapes, pressure[None])
    np.testing.assert_allclose(found.p0, p0, rtol=1e-5)
    np.testing.assert_allclose(found.half_width, half_width, rtol=2e-5)
    np.testing.assert_allclose(pressure[shapes.centres.size // 2], p0, rtol=1e-4)


def edge_graded(a, count):
    """Knots between -a and a, fine towards the ends."""
    return a * np.sin(np.linspace(-np.pi / 2, np.pi / 2, count))


def test_flat_punch_with_rounded_edges():
    # Ciavarella, Hills and Monno (1998): a = 1, b = 0.6, R = 5, E* = 2e5.
    flat, radius, modulus, load = 0.6, 5.0, 2e5, 8945.9044

    def gap(x):
        return np.maximum(np.abs(x) - flat, 0) ** 2 / (2 * radius)

    sides = np.concatenate([np.linspace(-1.02, -0.4, 300), np.linspace(0.4, 1.02, 300)])
    knots = np.unique(np.concatenate([sides, np.linspace(-0.4, 0.4, 121), [-flat, flat]]))
    shapes, pressure = pressed(knots, gap, load / modulus)
    at = np.array([0.0, 0.3, 0.5, 0.7, 0.9])
    expected = [3413.910, 3676.129, 4386.731, 6458.072, 4839.904]
    np.testing.assert_allclose(modulus * pressure @ shapes.values(at), expected, rtol=1e-4)
    # The width of the contact follows from the load: a = 1.
    carrying = shapes.centres[pressure > 0]
    np.testing.assert_allclose(carrying.max(), 1.0, atol=3e-3)


def test_load_of_the_rounded_punch_that_makes_the_contact_one_wide():
    flat = np.arcsin(0.6)
    load = 2e5 / (4 * 5.0) * (np.pi - 2 * flat - np.sin(2 * flat))
    np.testing.assert_allclose(load, 8945.9044, rtol=1e-5)


def test_flat_punch():
    shapes, pressure = pressed(edge_graded(1.0, 161), np.zeros_like, 1.0)
    at = np.linspace(-0.9, 0.9, 19)
    expected = 1 / (np.pi * np.sqrt(1 - at**2))
    np.testing.assert_allclose(pressure @ shapes.values(at), expected, rtol=2e-3)


def test_two_level_punches_on_one_half_plane():
    # Between the punches the gap is so deep that nothing touches.
    inner = 0.4
    half = (1 + inner) / 2 + edge_graded((1 - inner) / 2, 121)
    knots = np.concatenate([-half[::-1], half])

    def gap(x):
        return np.where(np.abs(x) < inner, 1e3, 0.0)

    shapes, pressure = pressed(knots, gap, 1.0)
    at = np.array([0.5, 0.6, 0.7, 0.8, 0.9])
    expected = at / (np.pi * np.sqrt((1 - at**2) * (at**2 - inner**2)))
    np.testing.assert_allclose(pressure @ shapes.values(at), expected, rtol=2e-3)
    np.testing.assert_allclose(pressure @ shapes.values(-at), expected, rtol=2e-3)
