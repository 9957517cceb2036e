"""Three meshes of one quantity."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.contact.elasticity.mesh_convergence import converged, converged_on_two


@pytest.mark.parametrize("order", [1.0, 2.0, 3.0])
def test_a_power_law_gives_its_limit_and_its_order(order):
    sizes = np.array([4.0, 2.0, 1.0])
    found = converged(10 + 0.02 * sizes**order, 2.0)
    np.testing.assert_allclose(found.extrapolated, 10, rtol=1e-12)
    np.testing.assert_allclose(found.order, order, rtol=1e-9)
    # 1.25 times the distance of the finest value from the limit.
    np.testing.assert_allclose(found.gci, 1.25 * 0.02 / found.values[2], rtol=1e-9)


def test_a_falling_power_law_does_so_too():
    found = converged(10 - 0.3 * np.array([16.0, 4.0, 1.0]), 2.0)
    np.testing.assert_allclose(found.extrapolated, 10, rtol=1e-12)


def test_an_order_above_three_is_not_trusted_for_the_error_bar():
    found = converged((1.0 + 0.32, 1.0 + 0.02, 1.0), 2.0)
    assert found.order == pytest.approx(np.log2(15))
    assert found.gci == pytest.approx(1.25 * 0.02 / 7)


@pytest.mark.parametrize("values", [(1.0, 1.02, 1.01), (1.0, 1.0001, 1.00015), (2.0, 2.0, 2.0)])
def test_scatter_has_no_order_and_three_times_its_spread_as_error_bar(values):
    found = converged(values, 2.0)
    assert found.order is None
    assert found.extrapolated == values[2]
    assert found.gci == pytest.approx(3 * (max(values) - min(values)) / values[2])


@pytest.mark.parametrize(
    ("values", "of_pair"),
    [
        ((1.4, 1.1, 1.0), True),  # of an order
        ((1.0, 1.02, 1.01), False),  # scatter: the range of all three, at a gain of 1
        ((1.0, 1.0, 1.2), True),  # diverging: of the least order
    ],
)
def test_the_terms_of_an_index_are_those_of_its_values(values, of_pair):
    found = converged(values, 2.0)
    terms = found.terms
    pair = abs(values[2] - values[1])
    assert terms.difference == pytest.approx(pair if of_pair else max(values) - min(values))
    gain = terms.ratio**terms.order - 1.0
    assert found.gci == pytest.approx(terms.safety * terms.difference / values[2] / gain)
    two = converged_on_two(values[1:], 2.0, [found])
    assert two.terms.added == found.gci and two.gci > found.gci


@pytest.mark.parametrize("values", [(1.0, 2.0), (1.0, np.nan, 2.0), (1.0, 2.0, 3.0, 4.0)])
def test_anything_but_three_finite_values_is_refused(values):
    with pytest.raises(InputError):
        converged(values, 2.0)


def test_a_ratio_too_small_to_tell_anything_is_refused():
    with pytest.raises(InputError):
        converged((3.0, 2.0, 1.0), 1.05)


@pytest.mark.parametrize("order", [1.0, 1.7, 2.0])
def test_two_meshes_of_the_order_elsewhere_give_the_limit(order):
    """A power law of another coefficient; the bar: 3 times the error, and more."""
    sizes = np.array([4.0, 2.0, 1.0])
    elsewhere = converged(7 + 0.001 * sizes**order, 2.0)
    estimate = converged_on_two(10 + 0.02 * sizes[:2] ** order, 2.0, [elsewhere])
    np.testing.assert_allclose(estimate.extrapolated, 10, rtol=1e-12)
    own = 3 * 0.02 * 2.0**order / estimate.values[1]
    np.testing.assert_allclose(estimate.gci, own + elsewhere.gci, rtol=1e-9)


def test_two_meshes_take_the_least_order_and_never_a_narrower_bar():
    fast, slow = converged((1.16, 1.04, 1.01), 2.0), converged((1.4, 1.2, 1.1), 2.0)
    alone, both = (converged_on_two((2.02, 2.01), 2.0, each) for each in ([fast], [fast, slow]))
    assert (alone.order, both.order) == (fast.order, slow.order)
    assert both.gci == pytest.approx(slow.gci + 3 * 0.01 / 2.01)
    assert converged_on_two((2.0, 2.0), 2.0, [fast, slow]).gci == slow.gci


def test_two_meshes_without_an_observed_order_are_not_extrapolated():
    scattered = converged((1.0, 1.02, 1.01), 2.0)
    estimate = converged_on_two((1.0, 1.001), 2.0, [scattered])
    assert (estimate.order, estimate.extrapolated) == (None, 1.001)
    own = 3 * 0.001 / 1.001 / (np.sqrt(2.0) - 1)
    assert estimate.gci == pytest.approx(scattered.gci + own)


@pytest.mark.parametrize("values", [(1.0,), (1.0, np.nan), (1.0, 2.0, 3.0)])
def test_anything_but_two_finite_values_is_refused(values):
    with pytest.raises(InputError):
        converged_on_two(values, 2.0, [converged((3.0, 2.0, 1.5), 2.0)])


def test_two_meshes_alone_are_refused():
    with pytest.raises(InputError, match="observed"):
        converged_on_two((1.0, 2.0), 2.0, [])
