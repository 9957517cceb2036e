"""Differences of fourth order, and complex steps of the motion of a follower against them."""

from collections.abc import Callable

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.lift import Jet


def fourth_order(values: Callable[[float], Array], step: float) -> Array:
    """Derivative at zero of a smooth function, by four of its values a `step` apart."""
    a, b, c, d = (values(k * step) for k in (-2.0, -1.0, 1.0, 2.0))
    return (a - 8.0 * b + 8.0 * c - d) / (12.0 * step)


def assert_complex_steps(rates: Callable[[Jet], dict[str, Array]], jet: Jet, size: float) -> None:
    """Complex steps of quantities of a lift are its differences, within 1e-8 of the greatest.

    Parameters
    ----------
    rates : callable   lift -> quantities by name, complex (n,)
    jet : Jet          of the lift, (n,)
    size : float       of the steps, m; k-fold in the derivative of order k - 1
    """

    def at(by: complex) -> dict[str, Array]:
        return rates(Jet(*(each + by * size * k for k, each in enumerate(jet, 1))))

    exact = at(1e-30j)
    near = fourth_order(lambda by: np.array(np.broadcast_arrays(*at(by).values())), 1e-3)
    for (name, value), difference in zip(exact.items(), near, strict=True):
        scale = np.abs(value.real).max() + np.abs(difference).max()
        np.testing.assert_allclose(
            np.imag(value) / 1e-30, difference, rtol=0, atol=1e-8 * scale, err_msg=name
        )
