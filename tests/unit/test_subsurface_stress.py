"""Stress below patches of pressure: Hertz line and point contact, equilibrium of a patch."""

import numpy as np
import pytest

from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells
from camwright.pipeline.contact.finite_length.subsurface_stress import (
    stress_below,
    subsurface_stress,
)


def contact(x, y, pressure):
    ones, zeros = np.ones(1), np.zeros(1)
    cells = PressureCells(x, y)
    return LengthContact(cells, pressure[None], zeros, zeros, ones, zeros, zeros, zeros)


def mean_square_root(edges):
    """Means of sqrt(1 - x^2) over cells."""
    x = np.clip(edges, -1, 1)
    return np.diff(0.5 * (x * np.sqrt(1 - x**2) + np.arcsin(x))) / np.diff(edges)


def test_line_contact_of_hertz():
    x, y = np.linspace(0, 1.25, 41), np.linspace(-400, 400, 41)
    line = contact(x, y, np.tile(mean_square_root(x), (40, 1)))
    stress = subsurface_stress(line, 1.0, 0.3, 20.0, has_corner=False)
    # Johnson (1985), eq. 4.50: 0.300 p0 at 0.786 a; von Mises 0.558 p0 at 0.70 a, nu = 0.3.
    assert stress.centre.shear == pytest.approx(0.3003, abs=5e-4)
    assert stress.centre.shear_depth == pytest.approx(0.786, abs=5e-3)
    assert stress.centre.von_mises == pytest.approx(0.558, abs=1e-3)
    assert stress.centre.von_mises_depth == pytest.approx(0.70, abs=1e-2)
    assert stress.end1.von_mises == pytest.approx(stress.end2.von_mises, rel=1e-6)


def test_an_end_that_a_tilt_lifts_has_the_stress_below_its_last_cell():
    """Cells wider than the stretch: that of the cell, not of none."""
    x, y = np.linspace(0, 1.25, 41), np.concatenate([np.linspace(-10, 8, 10), [9.9, 10.0]])
    pressure = np.tile(mean_square_root(x), (11, 1))
    pressure[:3] = 0.0
    lifted = subsurface_stress(contact(x, y, pressure), 1.0, 0.3, 0.2, has_corner=True)
    assert 0.3 < lifted.end1.von_mises < 0.7
    assert lifted.end2.von_mises > 0.0


@pytest.mark.parametrize(
    ("poisson", "shear", "mises", "depth"),
    [(0.3, 0.3100, 0.6200, 0.481), (0.25, 0.3217, 0.6434, 0.464)],
)
def test_point_contact_of_hertz(poisson, shear, mises, depth):
    edges = np.linspace(-1.25, 1.25, 51)
    fine = np.linspace(-1.25, 1.25, 1001)
    middles = 0.5 * (fine[1:] + fine[:-1])
    dome = np.sqrt(np.maximum(1 - middles[:, None] ** 2 - middles**2, 0))
    pressure = dome.reshape(50, 20, 50, 20).mean(axis=(1, 3))
    sphere = contact(edges[25:], edges, pressure[:, 25:])
    peak = subsurface_stress(sphere, 1.0, poisson, 0.2, has_corner=False).centre
    # Johnson (1985), eqs. 3.45, on the axis: greatest of both stresses, at one depth.
    assert peak.shear == pytest.approx(shear, abs=1e-3)
    assert peak.von_mises == pytest.approx(mises, abs=2e-3)
    assert peak.shear_depth == pytest.approx(depth, abs=1e-2)


def test_stress_of_a_patch_is_the_integral_of_point_loads():
    cells = PressureCells(np.array([0.0, 0.5]), np.array([-0.4, 0.8]))
    y, depth, poisson = np.array([0.3, 1.1]), np.array([0.4]), 0.3
    stress = stress_below(cells, np.ones((1, 1)), poisson, y, depth)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    x1 = 0.5 * nodes
    for row, place in enumerate(y):
        x, dy = np.meshgrid(-x1, place - (0.2 + 0.6 * nodes), indexing="ij")
        z, w = depth[0], 0.3 * np.outer(weights, weights)
        r = np.sqrt(x**2 + dy**2 + z**2)
        # Johnson (1985), eqs. 3.20, of a unit force.
        q, s = x**2 + dy**2, 1 - 2 * poisson
        along, beside = (
            s / q * ((1 - z / r) * (u**2 - v**2) / q + z * v**2 / r**3) - 3 * z * u**2 / r**5
            for u, v in ((dy, x), (x, dy))
        )
        point = {
            (0, 0): beside,
            (1, 1): along,
            (2, 2): -3 * z**3 / r**5,
            (1, 2): -3 * dy * z**2 / r**5,
        }
        for index, values in point.items():
            total = (w * values).sum() / (2 * np.pi)
            assert stress[row, 0][index] == pytest.approx(total, rel=1e-5), index
    np.testing.assert_allclose(stress[:, :, 0, 2], 0, atol=1e-8)


def test_an_uneven_end_pressure_has_its_own_peak():
    x, y = np.linspace(0, 1.25, 21), np.linspace(-10, 10, 41)
    rising = np.outer(1 + 0.5 * (y[1:] > 9), mean_square_root(x))
    stress = subsurface_stress(contact(x, y, rising), 1.0, 0.3, 1.0, has_corner=False)
    assert stress.end2.von_mises > 1.1 * stress.end1.von_mises
    # The middle is that of the even pressure, half a length from the rise.
    even = subsurface_stress(
        contact(x, y, np.tile(rising[0], (40, 1))), 1.0, 0.3, 1.0, has_corner=False
    )
    assert stress.centre.von_mises == pytest.approx(even.centre.von_mises, rel=1e-2)


@pytest.mark.slow
def test_at_a_corner_the_peak_does_not_grow_with_the_mesh():
    """Pressure as the distance from the end to the power -0.4, on cells of 0.1 and of 0.0125."""
    x = np.linspace(0, 1.25, 21)

    def peaks(count, *, has_corner):
        y = np.concatenate([np.linspace(-10, 9, 39), np.linspace(9, 10, count + 1)[1:]])
        line = np.diff((10 - y) ** 0.6) / np.diff(10 - y) / 0.6
        even = contact(x, y, np.outer(line, mean_square_root(x)))
        end = subsurface_stress(even, 1.0, 0.3, 1.0, has_corner=has_corner).end2
        return np.array([end.von_mises, end.shear])

    coarse, fine = (peaks(count, has_corner=True) for count in (10, 80))
    np.testing.assert_allclose(fine, coarse, rtol=0.02)
    assert (peaks(80, has_corner=False) > 1.3 * peaks(10, has_corner=False)).all()
