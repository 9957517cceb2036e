"""Polynomials through the values of many designs, with the error at designs that were held out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.base.rounding import to_digits

DEGREE = 4
"""Greatest total degree of a polynomial."""
MARGIN = 1.25
"""Stated error over the greatest one at the designs held out."""
LEAST_ERROR = 1e-6
"""Least stated error, of the greatest value."""
_ERROR_DIGITS = 2
_NO_SLOPE = 1e-9  # spread of the values, of the greatest, below which they are constant


def powers(count: int, degree: int = DEGREE) -> NDArray[np.intp]:
    """Degrees (p, count) of the products of Chebyshev polynomials up to a total degree."""
    every = product(range(degree + 1), repeat=count)
    return np.array([each for each in every if sum(each) <= degree], dtype=np.intp)


def terms(places: Array, exponents: NDArray[np.intp]) -> Array:
    """Products of Chebyshev polynomials (m, p) at places (m, d) in [-1, 1]; exponents (p, d):
    degree of each product along each axis, see `powers`.
    """
    products = np.ones((len(places), len(exponents)))
    for axis, column in enumerate(places.T):
        products *= chebvander(column, int(exponents.max(initial=0)))[:, exponents[:, axis]]
    return products


@dataclass(frozen=True)
class _Scale:
    """A scale on which values are fitted: to it, back from it, and whether it takes them."""

    to: Callable[[Array], Array]
    back: Callable[[Array], Array]
    takes: Callable[[Array], bool]


def _plain(values: Array) -> Array:
    return values


ScaleName = Literal["linear", "log", "square"]
SCALES: Mapping[ScaleName, _Scale] = {
    "linear": _Scale(_plain, _plain, lambda _: True),
    "log": _Scale(np.log, np.exp, lambda v: bool(v.min() > 0.02 * v.max())),
    "square": _Scale(
        np.square, lambda v: np.sqrt(np.maximum(v, 0.0)), lambda v: bool(v.min() >= 0.0)
    ),
}
"""Scales of the values; a standard deviation is smooth by its square."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Polynomial of a quantity over the places of designs.

    Parameters
    ----------
    scale : str             of `SCALES`, on which the polynomial is
    coefficients : array (p,)   of the terms; one alone: a constant
    error : float           greatest error at the designs held out, with `MARGIN`, of the value
    share : bool            the error is a share of the value
    """

    scale: ScaleName
    coefficients: Array
    error: float
    share: bool

    def with_error(self, error: float) -> Surface:
        """With another error, rounded up to two digits."""
        return replace(self, error=to_digits(error, _ERROR_DIGITS))

    def times(self, factor: float) -> Surface:
        """Of the values times a factor > 0, such as that of a unit."""
        coefficients = self.coefficients
        if self.scale == "log" and coefficients.size > 1:
            coefficients = coefficients + np.log(factor) * (np.arange(coefficients.size) == 0)
        else:
            coefficients = coefficients * factor ** (2.0 if self.scale == "square" else 1.0)
        error = self.error if self.share else to_digits(self.error * factor, _ERROR_DIGITS)
        return replace(self, coefficients=rounded(coefficients), error=error)

    def on_scale(self, at_places: Array) -> Array:
        """Values (m,) on its scale, of terms (m, p) at places."""
        if self.coefficients.size == 1:
            return np.full(len(at_places), self.coefficients[0])
        return np.asarray(at_places @ self.coefficients)

    def __call__(self, at_places: Array) -> Array:
        """Values (m,) of terms (m, p) at places."""
        values = self.on_scale(at_places)
        return values if self.coefficients.size == 1 else SCALES[self.scale].back(values)


class SurfaceFit:
    """Fit of the values of designs, of which those last are held out.

    Parameters
    ----------
    places : array (m, d)   of the designs in [-1, 1]
    held_out : int          designs at the end that state the error
    """

    def __init__(self, places: Array, held_out: int) -> None:
        self.exponents = powers(places.shape[1])
        self._terms = terms(places, self.exponents)
        self._held = np.arange(len(places)) >= len(places) - held_out
        self._inverses: dict[bytes, Array] = {}

    def surface(self, values: Array, valued: NDArray[np.bool_] | None = None) -> Surface | None:
        """Surface of values (m,) on the scale of the least error.

        Parameters
        ----------
        valued : array (m,)   designs that have a value; None: all

        Returns
        -------
        Surface   None where too few designs have a value
        """
        there = np.isfinite(values) if valued is None else valued & np.isfinite(values)
        fitted, held = there & ~self._held, there & self._held
        if fitted.sum() < 2 * len(self.exponents) or held.sum() < 0.25 * self._held.sum():
            return None
        most = float(np.abs(values[there]).max())
        if np.ptp(values[there]) <= _NO_SLOPE * most:
            middle = float(np.median(values[there]))
            return Surface("linear", np.array([middle]), LEAST_ERROR * most, share=False)
        inverse = self._inverse(fitted)
        fits = [
            self._on(name, values, fitted, held, inverse)
            for name, scale in SCALES.items()
            if scale.takes(values[there])
        ]
        return min(fits, key=lambda one: one[0])[1]

    def _inverse(self, fitted: NDArray[np.bool_]) -> Array:
        """Inverse (p, k) of the terms at k designs, of least squares; most values share theirs."""
        key = fitted.tobytes()
        if key not in self._inverses:
            self._inverses[key] = np.asarray(np.linalg.pinv(self._terms[fitted]))
        return self._inverses[key]

    def _on(
        self,
        name: ScaleName,
        values: Array,
        fitted: NDArray[np.bool_],
        held: NDArray[np.bool_],
        inverse: Array,
    ) -> tuple[float, Surface]:
        """Rank and surface of values (m,) on the scale `name`, by least squares at the designs
        `fitted` (m,).

        Rank: greatest relative error at the designs `held` out (m,), times a margin; errors below
        `LEAST_ERROR` rank alike. inverse: of the terms at the fitted designs.
        """
        scale = SCALES[name]
        surface = Surface(name, inverse @ scale.to(values[fitted]), 0.0, share=name == "log")
        apart = np.abs(surface(self._terms[held]) - values[held])
        most = float(np.abs(values[fitted | held]).max())
        size = np.abs(values[held]) if surface.share else most
        worst = max(MARGIN * float((apart / size).max()), LEAST_ERROR)
        return worst, replace(surface, error=worst if surface.share else worst * most)


def rounded(coefficients: Array) -> Array:
    """Coefficients to nine digits of the greatest."""
    return np.round(coefficients, 8 - _exponent(float(np.abs(coefficients).max())))


def _exponent(value: float) -> int:
    return int(np.floor(np.log10(value))) if value > 0.0 else 0


def settings(count: int, axes: int, held_out: int, seed: int) -> Array:
    """Places (count, axes) in [-1, 1]: a Halton sequence dense at the ends, then random ones.

    Dense as the nodes of Chebyshev, so that a polynomial does not swing there; those held out are
    uniform.

    Parameters
    ----------
    held_out : int   of the places, the last, random ones
    seed : int       of the random ones
    """
    fitted = count - held_out
    halton = np.stack([_radical_inverse(fitted, base) for base in _PRIMES[:axes]], axis=1)
    random = np.random.default_rng(seed).uniform(-1.0, 1.0, (held_out, axes))
    return np.concatenate([np.cos(np.pi * halton), random])


_PRIMES: Sequence[int] = (2, 3, 5, 7, 11, 13, 17, 19)


def _radical_inverse(count: int, base: int) -> Array:
    """First numbers (count,) of the van der Corput sequence of a base, from 1."""
    left, inverse, share = np.arange(1, count + 1), np.zeros(count), 1.0
    while left.any():
        share /= base
        inverse += share * (left % base)
        left //= base
    return inverse
