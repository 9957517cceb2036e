"""The contact patch against the half-plane: compliance, Hertz, stress, every Poisson ratio."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.errors import ContactError
from camwright.pipeline.contact import contact_patch as module
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_patch import contact_patch, solve_patches
from camwright.pipeline.contact.elasticity.halfplane import settlement
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_in_plane, von_mises

# Compressible, steel, nearly incompressible.
POISSON = (0.0, 0.3, 0.49)


def pressed(patches, shares, gap):
    xi, _ = patches[0].shapes.quadrature()
    return solve_patches(patches, shares, gap(xi)[None])


def kernel_compliance(shapes):
    xi, weights = shapes.quadrature()
    found = (shapes.values(xi) * weights) @ settlement(xi, shapes.knots).T
    return (found + found.T) / 2


@pytest.mark.parametrize("poisson", POISSON)
def test_compliance_is_that_of_the_half_plane(poisson):
    # Up to a constant times the resultants, which is the rigid motion: pressures in balance.
    patch = contact_patch(poisson)
    shapes, m = patch.shapes, patch.shapes.integrals
    for number in (0.5, 1, 2):
        pressure = np.cos(number * np.pi * shapes.centres)
        pressure -= (m @ pressure) / m.sum()
        found, exact = (
            pressure @ c @ pressure for c in (patch.compliance, kernel_compliance(shapes))
        )
        np.testing.assert_allclose(found, exact, rtol=4e-3)


@pytest.mark.parametrize("poisson", POISSON)
def test_hertz_with_stress_at_sixteen_edges(poisson):
    # Ladder: p0 and half-width; tau and von Mises within 0.2 %, depth within 0.05 a.
    patch = contact_patch(poisson)
    found = pressed((patch, patch), (0.5, 0.5), np.square)
    np.testing.assert_allclose([found.p0[0], found.half_width[0]], 1.0, atol=5e-4)
    np.testing.assert_allclose(found.centre, 0.0, atol=1e-9)
    total = np.tensordot(patch.stress, found.pressure, axes=(2, 1))
    shear, place = patch.peaks(shear_in_plane(total))
    np.testing.assert_allclose(shear, hertz.SHEAR_MAX, rtol=2e-3)
    np.testing.assert_allclose(place[:, 0], [0.0, hertz.SHEAR_MAX_DEPTH], atol=0.05)
    mises, place = patch.peaks(von_mises(total, poisson))
    peak, depth = hertz.von_mises_peak(poisson)
    # Where the surface is the place the stress there is recovered, not interpolated.
    np.testing.assert_allclose(mises, peak, rtol=2e-3 if depth > 0 else 2e-2)
    np.testing.assert_allclose(place[1], depth, atol=0.05)


def test_eight_edges_meet_the_coarser_gate():
    patch = contact_patch(0.3, 8)
    found = pressed((patch, patch), (0.5, 0.5), np.square)
    np.testing.assert_allclose([found.p0[0], found.half_width[0]], 1.0, atol=5e-3)
    total = np.tensordot(patch.stress, found.pressure, axes=(2, 1))
    np.testing.assert_allclose(patch.peaks(shear_in_plane(total))[0], hertz.SHEAR_MAX, rtol=5e-3)
    np.testing.assert_allclose(
        patch.peaks(von_mises(total, 0.3))[0], hertz.von_mises_peak(0.3)[0], rtol=5e-3
    )


@pytest.mark.parametrize("poisson", POISSON)
def test_whole_field_is_that_of_the_half_plane(poisson):
    patch = contact_patch(poisson)
    found = pressed((patch, patch), (0.5, 0.5), np.square)
    total = np.tensordot(patch.stress, found.pressure, axes=(2, 1))[:, :, 0]
    away = (np.hypot(*patch.points) < 1.4) & (patch.points[1] > 0.2)
    exact = hertz.subsurface_stress(*patch.points)
    # Close to incompressible the mean of the stress scatters; what yields the steel does not.
    np.testing.assert_allclose(total[:, away], exact[:, away], atol=4e-3 if poisson < 0.4 else 3e-2)
    np.testing.assert_allclose(
        shear_in_plane(total[:, away]), shear_in_plane(exact[:, away]), atol=4e-3
    )


@pytest.mark.parametrize("width", [0.97, 1.0, 1.02])
def test_pressure_does_not_oscillate(width):
    # 0.5 % within 0.8 a, 4 % at the last two nodes of either end; the worst of eight places.
    patch = contact_patch(0.3)
    x = patch.shapes.centres
    for shift in np.arange(8) / 8 / 32:
        found = pressed((patch, patch), (0.5, 0.5), lambda x, s=shift: ((x - s) / width) ** 2)
        at = (x - shift) / width
        error = np.abs(found.pressure[0] * width - np.sqrt(np.maximum(1 - at**2, 0)))
        assert error[np.abs(at) < 0.8].max() < 5e-3
        inside = np.flatnonzero(np.abs(at) < 1)
        assert error[inside[[0, 1, -2, -1]]].max() < 0.04
        assert error.max() < 0.04
        np.testing.assert_allclose(
            found.pressure[0] @ patch.shapes.integrals, np.pi / 2, rtol=1e-10
        )


@pytest.mark.parametrize("shape", [np.square, lambda x: x**2 + 0.05 * x**4, lambda x: 0.97 * x**2])
def test_residuals_are_those_of_the_stored_pressure(shape):
    # Force by the trapezoidal rule; gap by the compliance of the template and Simpson's rule.
    patch = contact_patch(0.3)
    knots, step = patch.knots, patch.knots[1] - patch.knots[0]
    found = pressed((patch, patch), (0.5, 0.5), shape)
    stored = found.pressure[0]
    force = np.trapezoid(np.concatenate([[0.0], stored, [0.0]]), knots)
    assert abs(force / (np.pi / 2) - 1) == pytest.approx(found.residual_equilibrium[0], abs=1e-14)
    middles = (knots[1:] + knots[:-1]) / 2
    mean = (shape(knots[1:-1]) + shape(middles[1:]) + shape(middles[:-1])) / 3
    gap = patch.compliance @ stored / step + mean
    gap -= stored @ gap / stored.sum()
    size, loaded = gap.max(), np.abs(knots[1:-1]) < found.half_width[0] - step
    assert found.residual_complementarity[0] < 1e-13
    # No gap in the mean over a function of the ellipse, four knots wide; at single knots there is.
    assert gap.min() > -3e-3 * size
    assert 1e-5 * size < np.abs(gap[loaded]).max() < 3e-3 * size


def test_a_pressure_that_would_overlap_is_not_stored(monkeypatch):
    patch = contact_patch(0.3)
    linear = pressed((patch, patch), (0.5, 0.5), np.square)
    fitted = module.fitted_ellipses

    def narrow(*args):
        ellipses = fitted(*args)
        return replace(ellipses, half_width=0.96 * ellipses.half_width)

    monkeypatch.setattr(module, "fitted_ellipses", narrow)
    found = pressed((patch, patch), (0.5, 0.5), np.square)
    assert found.residual_complementarity[0] < 1e-9
    assert np.abs(found.pressure - linear.pressure).max() > 0.01
    beyond = np.abs(patch.shapes.centres) > 0.961  # the ellipse ends at 0.96
    assert found.pressure[0, beyond].max() > 0


def test_a_contact_that_is_no_ellipse_keeps_its_own_edges():
    # Two bumps: nothing is pressed between them.
    patch = contact_patch(0.3)
    found = pressed((patch, patch), (0.5, 0.5), lambda x: 8 * (x**2 - 0.49) ** 2)
    assert found.pressure[0, np.abs(patch.shapes.centres).argmin()] == 0
    assert (found.pressure >= 0).all()


@pytest.mark.parametrize("ratio", [1.0, 30.0, 1000.0])
def test_unlike_materials_share_the_compliance(ratio):
    patches = (contact_patch(0.49), contact_patch(0.0))
    stiff = np.array([1.0 / (1 - 0.49**2), ratio])
    combined = 1 / (1 / stiff).sum()
    found = pressed(patches, tuple(combined / stiff), np.square)
    np.testing.assert_allclose([found.p0[0], found.half_width[0]], 1.0, atol=2e-3)


def test_contact_edge_between_two_knots_is_found_all_the_same():
    # The contact pushed through one knot spacing: worst of eight places.
    patch = contact_patch(0.3)
    for shift in np.arange(8) / 8 / 32:
        found = pressed((patch, patch), (0.5, 0.5), lambda x, s=shift: (x - s) ** 2)
        np.testing.assert_allclose([found.p0[0], found.half_width[0]], 1.0, atol=1.5e-3)
        np.testing.assert_allclose(found.centre, shift, atol=1e-3)


def test_rounded_punch():
    # Ciavarella, Hills and Monno (1998), b/a = 0.6; here the Hertz half-width of the edge
    # radius is one and the load pi/2, so a follows from the load formula.
    patch = contact_patch(0.3)
    flat = np.arcsin(0.6)
    share = (np.pi - 2 * flat - np.sin(2 * flat)) / np.pi
    a = 1.25
    sharpness = 1 / (a**2 * share)
    edge = 0.6 * a

    def gap(x):
        return np.maximum(np.abs(x) - edge, 0) ** 2 * sharpness

    found = pressed((patch, patch), (0.5, 0.5), gap)
    mean = np.pi / 2 / (2 * a)
    at = np.array([0.0, 0.3, 0.5, 0.7, 0.9])
    # p a / P of the reference, printed for a = 1, P = 8945.9044.
    expected = np.array([3413.910, 3676.129, 4386.731, 6458.072, 4839.904]) / 8945.9044 * 2 * mean
    pressure = found.pressure[0] @ patch.shapes.values(a * at)
    np.testing.assert_allclose(pressure[:3], expected[:3], rtol=5e-3)
    # Next to the edge sixteen knots see the steep end of the pressure to two per cent.
    np.testing.assert_allclose(pressure, expected, rtol=2.5e-2)


def test_surfaces_that_are_not_locally_cylindrical_are_refused():
    patch = contact_patch(0.3)
    with pytest.raises(ContactError, match=r"wider than 1\.4"):
        pressed((patch, patch), (0.5, 0.5), lambda x: np.maximum(np.abs(x) - 1.3, 0) ** 2)
