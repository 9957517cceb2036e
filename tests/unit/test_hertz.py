"""Hertz line contact: printed numbers, field equations, what a disc adds."""

import numpy as np
import pytest
from scipy.integrate import quad

from camwright.geometry.errors import InputError
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.halfplane import point_force_displacement
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_in_plane, von_mises


def test_steel_cylinder_on_aluminium_block_has_the_published_half_width_and_pressure():
    # NAFEMS R0094 (Konter 2006), case 1: 6.21 mm and 3585 MPa as printed.
    modulus = hertz.contact_modulus(210e9, 0.3, 70e9, 0.3)
    half_width, p0 = hertz.line_contact(35e6, 0.05, modulus)
    np.testing.assert_allclose(half_width, 6.21463e-3, rtol=1e-6)
    np.testing.assert_allclose(p0, 3585.36e6, rtol=1e-6)


def test_pressure_carries_the_load():
    half_width, p0 = hertz.line_contact([1.0, 1e3, 1e7], [1e-3, 1.0, 1e3], 1e11)
    np.testing.assert_allclose(np.pi / 2 * half_width * p0, [1.0, 1e3, 1e7], rtol=1e-14)


def test_no_load_gives_no_contact_and_no_warning():
    half_width, p0 = hertz.line_contact([0.0, 1.0], 0.01, 1e11)
    assert half_width[0] == 0 and p0[0] == 0 and p0[1] > 0


@pytest.mark.parametrize(
    ("load", "radius", "modulus"),
    [(-1.0, 1.0, 1.0), (np.nan, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, np.nan)],
)
def test_bad_line_contacts_are_refused(load, radius, modulus):
    with pytest.raises(InputError):
        hertz.line_contact(load, radius, modulus)


def test_dundurs_constant():
    # By shear moduli and Kolosov's constants, Dundurs (1969); rigid partner, Johnson sec. 5.1.
    def by_kolosov(e1, nu1, e2, nu2):
        ratio = (e1 / (1 + nu1)) / (e2 / (1 + nu2))
        first, second = 3 - 4 * nu1, 3 - 4 * nu2
        return (ratio * (second - 1) - (first - 1)) / (ratio * (second + 1) + first + 1)

    steel, others = (206e9, 0.3), [(70e9, 0.33), (3e9, 0.4), (600e9, 0.22), (1e6, 0.49)]
    for other in others:
        beta = hertz.dundurs_beta(*other, *steel)
        # Dundurs counts it negative where body 1 strains more.
        assert beta == pytest.approx(-by_kolosov(*other, *steel), rel=1e-12)
        assert hertz.dundurs_beta(*steel, *other) == pytest.approx(-beta, rel=1e-12)
    assert hertz.dundurs_beta(206e9, 0.3, 1e30, 0.0) == pytest.approx(0.4 / (2 * 0.7), rel=1e-12)
    assert hertz.dundurs_beta(*steel, *steel) == 0.0


def test_contact_modulus_of_a_rigid_partner_is_the_plane_strain_modulus():
    np.testing.assert_allclose(
        hertz.contact_modulus(210e9, 0.3, 1e30, 0.0), 210e9 / 0.91, rtol=1e-12
    )


@pytest.mark.parametrize(("modulus", "poisson"), [(0.0, 0.3), (1e9, 0.5), (1e9, -0.1)])
def test_bad_materials_are_refused(modulus, poisson):
    with pytest.raises(InputError):
        hertz.contact_modulus(modulus, poisson, 1e9, 0.3)


def test_largest_shear_lies_where_the_constants_say():
    depth = np.linspace(0.7, 0.9, 200_001)
    shear = shear_in_plane(hertz.subsurface_stress(0.0, depth))
    # The maximum is flat: its place is known to the root of its accuracy.
    np.testing.assert_allclose(shear.max(), hertz.SHEAR_MAX, rtol=1e-8)
    np.testing.assert_allclose(depth[shear.argmax()], hertz.SHEAR_MAX_DEPTH, atol=2e-6)


@pytest.mark.parametrize(
    ("poisson", "peak", "depth"),
    [
        (0.0, 1.0, 0.0),
        (0.19, 0.62, 0.0),
        (0.25, 0.579702, 0.654778),
        (0.28, 0.565689, 0.686211),
        (0.30, 0.557516, 0.704292),
        (0.33, 0.546898, 0.727610),
    ],
)
def test_von_mises_peak(poisson, peak, depth):
    # Below nu = 0.2 the surface, at (1 - 2 nu) p0, is the place.
    np.testing.assert_allclose(hertz.von_mises_peak(poisson), (peak, depth), atol=2e-6)


def test_orthogonal_shear_is_a_quarter_of_the_pressure_at_half_depth():
    x = np.linspace(-1.5, 1.5, 3001)
    shear = hertz.subsurface_stress(x, 0.5)[2]
    np.testing.assert_allclose([shear.max(), -shear.min()], 0.25, atol=1e-6)
    np.testing.assert_allclose(abs(x[shear.argmax()]), np.sqrt(0.75), atol=1e-3)


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_subsurface_field_is_in_equilibrium(friction):
    rng = np.random.default_rng(3)
    x, z, h = rng.uniform(-2, 2, 50), rng.uniform(0.1, 2, 50), 1e-4
    by_x = (
        hertz.subsurface_stress(x + h, z, friction) - hertz.subsurface_stress(x - h, z, friction)
    ) / (2 * h)
    by_z = (
        hertz.subsurface_stress(x, z + h, friction) - hertz.subsurface_stress(x, z - h, friction)
    ) / (2 * h)
    # Central differences of a field of order one: error h^2 times its third derivative.
    np.testing.assert_allclose(by_x[0] + by_z[2], 0, atol=1e-5)
    np.testing.assert_allclose(by_x[2] + by_z[1], 0, atol=1e-5)


def test_surface_carries_pressure_inside_and_nothing_outside():
    x = np.array([-1.5, -0.6, 0.0, 0.6, 1.5])
    stress = hertz.subsurface_stress(x, 0.0)
    expected = -np.sqrt(np.maximum(1 - x**2, 0))
    np.testing.assert_allclose(stress[1], expected, atol=1e-12)
    np.testing.assert_allclose(stress[2], 0, atol=1e-12)


def test_displacement_is_that_of_the_point_forces_of_the_pressure():
    # Gauss-Chebyshev sums of Flamant's solution; exact to round-off from a quarter half-width on.
    x, depth = np.meshgrid(np.linspace(-5, 5, 21), [0.25, 0.7, 3.0, 40.0])
    nodes, weights = np.polynomial.chebyshev.chebgauss(300)
    weights = weights * (1 - nodes**2) * 2 / np.pi
    away = np.broadcast_to(depth[..., None], (*x.shape, nodes.size))
    summed = point_force_displacement(x[..., None] - nodes, away, 0.3) @ weights
    np.testing.assert_allclose(hertz.subsurface_displacement(x, depth, 0.3), summed, atol=1e-13)


def test_displacement_of_the_surface_is_a_parabola_under_the_pressure():
    # Johnson (1985), eq. 4.42: the slope of the settlement is -4 x / (pi a) per P'/E'.
    x = np.linspace(-1, 1, 9)
    into = hertz.subsurface_displacement(x, 0.0, 0.3)[1]
    np.testing.assert_allclose(into - into[4], -2 / np.pi * x**2, atol=1e-9)


def test_displacement_above_the_tangent_is_that_of_a_point_force_far_away():
    x, depth = np.array([-200.0, 60.0, 90.0]), np.array([-9.0, -12.0, -1.0])
    displacement = hertz.subsurface_displacement(x, depth, 0.3)
    np.testing.assert_allclose(displacement, point_force_displacement(x, depth, 0.3), atol=5e-5)


def test_sliding_moves_the_largest_von_mises_to_the_surface_beyond_the_known_friction():
    x, z = np.meshgrid(np.linspace(-1.2, 1.2, 481), np.linspace(0, 1.2, 241))
    below, above = (
        von_mises(hertz.subsurface_stress(x, z, friction), 0.3) for friction in (0.25, 0.30)
    )
    np.testing.assert_allclose([below.max(), above.max()], [0.60926, 0.66663], rtol=2e-4)
    assert z.ravel()[below.argmax()] > 0.2 and z.ravel()[above.argmax()] == 0.0


def lowered_stress(x, depth, curvature):
    """Half-plane stress with every element of the pressure as low as the curved surface."""

    def component(index):
        def element(xi):
            z = depth + curvature * (x**2 - xi**2) / 2
            powers = ((x - xi) ** 2, z**2, (x - xi) * z)
            kernel = -2 / np.pi * z / ((x - xi) ** 2 + z**2) ** 2
            return np.sqrt(1 - xi**2) * kernel * powers[index]

        return quad(element, -1, 1, limit=200)[0]

    return np.array([component(k) for k in range(3)])


@pytest.mark.parametrize(("x", "depth"), [(0.0, 0.786), (0.5, 0.4), (-0.9, 0.3), (1.3, 0.6)])
def test_curved_surface_stress_is_the_slope_of_the_lowered_field(x, depth):
    step = 1e-3
    slope = (lowered_stress(x, depth, step) - lowered_stress(x, depth, -step)) / (2 * step)
    np.testing.assert_allclose(hertz.curved_surface_stress(x, depth), slope, atol=1e-6)


def test_curved_surface_stress_is_finite_on_the_surface():
    x = np.linspace(-2, 2, 41)
    assert np.isfinite(hertz.curved_surface_stress(x, 0.0)).all()


def test_far_load_and_rim_of_a_disc_leave_tension_along_the_surface_alone():
    # Timoshenko and Goodier, art. 41: two opposite point forces and a uniform tension P/(pi R).
    radius, depth = 1.0, 1e-3
    other = -2 / (np.pi * (2 * radius - depth))
    along, into = 1 / (np.pi * radius), 1 / (np.pi * radius) + other
    np.testing.assert_allclose([along, into], [1 / np.pi, 0.0], atol=2e-4)
    # Half of their difference, less what the bend of the surface takes away.
    added = float(hertz.disc_correction(1.0, radius))
    xx, zz, _ = lowered_stress(0.0, hertz.SHEAR_MAX_DEPTH, 1e-4)
    lowered = (xx - zz) / 2 - hertz.SHEAR_MAX
    np.testing.assert_allclose(added, (along - into) / 2 + lowered / 1e-4 * 2 / np.pi, rtol=2e-3)


def test_disc_adds_seven_tenths_per_cent_of_the_shear_at_a_hundredth():
    half_width, p0, radius = 0.01, 1.0, 1.0
    share = hertz.disc_correction(np.pi / 2 * half_width * p0, radius) / hertz.SHEAR_MAX
    np.testing.assert_allclose(share, 0.00693, atol=1e-5)
