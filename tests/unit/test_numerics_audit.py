"""Audit of the numerical checks: each demand by a second formulation, each known defect."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest
from made_check import made_check
from trial_variants import with_certificate

from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.contact.elasticity.mesh_convergence import converged

# --- grid convergence index ------------------------------------------------------------------


@pytest.mark.parametrize("order", [0.2, 0.3, 0.5, 0.7, 0.99, 1.0, 1.5, 2.0, 3.0])
def test_the_bar_covers_the_error_of_a_manufactured_sequence(order):
    """f = 1 + C h^p: the exact error of the finest mesh is C h^p, whatever p is."""
    sizes = np.array([4.0, 2.0, 1.0])
    values = 1.0 + 0.01 * sizes**order
    error = (values[2] - 1.0) / values[2]
    assert converged(values, 2.0).gci >= error


@pytest.mark.parametrize("order", [0.3, 0.5, 0.8, 0.99])
def test_an_order_below_one_widens_the_bar(order):
    """Roache's formula with F_s = 3 at p = max(1/2, p); at least twice that of the order 1."""
    sizes = np.array([4.0, 2.0, 1.0])
    values = 5.0 - 0.004 * sizes**order
    step = abs(values[2] - values[1]) / values[2]
    expected = {0.3: 3.0 * step / 0.41421356, 0.5: 3.0 * step / 0.41421356}
    gci = converged(values, 2.0).gci
    assert gci == pytest.approx(expected.get(order, 3.0 * step / (2.0**order - 1.0)))
    assert gci > 2.0 * 1.25 * step


def test_a_printed_bar_of_0_066_per_cent_is_really_0_38():
    """Steps of 0.06824 and 0.0528 %: order 0.37. At the order 1 the bar is 0.066 %."""
    fine = 1000.0
    middle, coarse = fine * (1.0 - 5.28e-4), fine * (1.0 - 5.28e-4 - 6.824e-4)
    assert converged([coarse, middle, fine], 2.0).gci == pytest.approx(3.8244e-3, rel=1e-3)


def test_diverging_meshes_have_no_narrower_bar_than_the_least_order():
    """At |f3 - f2| = |f2 - f1| the order is 0: the bar does not fall across it."""
    slow = converged([1.0, 1.0100001, 1.02], 2.0)
    none = converged([1.0, 1.0099999, 1.02], 2.0)
    assert slow.order is not None
    assert none.order is None
    assert none.gci == pytest.approx(slow.gci, rel=1e-4)


def test_each_error_bar_has_the_index_of_its_own_quantity():
    """1 % on p0, 2 % on the half-width, 3 % on von Mises, 4 % on the maximum shear."""
    shares = {"p0": 0.01, "half_width": 0.02, "von_mises": 0.03, "tau_max": 0.04}
    solution = with_certificate(
        p0_cycle=1.0, **{name: made.converged(gci) for name, gci in shares.items()}
    )
    points = tuple(replace(solution.certificate[-1], theta=each) for each in (0.5, 1.5))
    solution = replace(solution, certificate=points)
    expected = {
        "contact_pressure": 0.01, "edge_pressure": 0.01, "shakedown": 0.01,
        "held_distance": 0.02, "first_yield": 0.03, "hardened_case": 0.03, "dang_van": 0.04,
    }  # fmt: skip
    for name, share in expected.items():
        one = made_check(name, 1.0, 2.0)
        one = replace(one, declaration=replace(one.declaration, error="contact"))
        (barred,) = with_error_bars(solution, [one])
        assert barred.error == pytest.approx(share, rel=1e-6), name
