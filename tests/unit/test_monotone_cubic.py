"""The monotone cubic against SciPy's, and its own properties."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from camwright.geometry.errors import InputError
from camwright.geometry.monotone_cubic import MonotoneCubic


@pytest.mark.parametrize("count", [3, 4, 30])
@pytest.mark.parametrize("seed", range(8))
def test_agrees_with_scipy(count, seed):
    """Value and slope, outside too: round-off of the same formula."""
    random = np.random.default_rng(seed)
    places, values = np.sort(random.uniform(0.0, 5.0, count)), random.normal(size=count)
    if seed % 2:
        values = np.sort(values)
    values[1:3] = values[1] if seed % 3 == 0 else values[1:3]  # a level piece
    at = np.concatenate([np.linspace(places[0] - 1.0, places[-1] + 1.0, 501), places])
    ours, theirs = MonotoneCubic(places, values), PchipInterpolator(places, values)
    for derivative in (0, 1):
        expected = theirs(at, derivative)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(ours(at, derivative), expected, rtol=1e-11, atol=1e-13 * scale)


def test_keeps_the_monotony_of_a_step():
    curve = MonotoneCubic(np.arange(6.0), np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]))
    assert (np.diff(curve(np.linspace(0.0, 5.0, 1001))) >= 0.0).all()


@pytest.mark.parametrize(
    ("places", "values", "limit"),
    [
        ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], "strictly increasing"),
        ([0.0, 1.0], [0.0, 1.0], "3 or more"),
        ([0.0, 1.0, 2.0], [0.0, 1.0], "as many values"),
        ([0.0, 1.0, 2.0], [0.0, np.nan, 1.0], "finite"),
    ],
)
def test_refuses(places, values, limit):
    with pytest.raises(InputError, match=limit):
        MonotoneCubic(np.array(places), np.array(values))
