"""Polynomials through designs: exact where they are, honest where they are not."""

from __future__ import annotations

import numpy as np
import pytest

from camwright.geometry.arrays import Array
from camwright.pipeline.screening.response_surface import (
    DEGREE,
    LEAST_ERROR,
    Surface,
    SurfaceFit,
    powers,
    settings,
    terms,
)

COUNT, HELD = 300, 80


@pytest.fixture(scope="module")
def places() -> Array:
    return settings(COUNT, 3, HELD, seed=1)


def test_terms_are_the_products_of_a_total_degree() -> None:
    assert len(powers(3)) == 35  # (3 + 4)! / (3! 4!)
    assert powers(2).sum(axis=1).max() == DEGREE
    at = np.array([[0.3, -0.7]])
    x, y = 2 * 0.3**2 - 1, 4 * (-0.7) ** 3 + 3 * 0.7
    assert terms(at, np.array([[2, 3]]))[0, 0] == pytest.approx(x * y)


def test_settings_fill_the_ranges_and_repeat(places: Array) -> None:
    assert places.shape == (COUNT, 3)
    assert np.abs(places).max() <= 1.0
    assert np.array_equal(places, settings(COUNT, 3, HELD, seed=1))
    dense = np.mean(np.abs(places[:-HELD]) > 0.9, axis=0)
    assert np.all(dense > 0.25)  # of nodes of Chebyshev 0.29, of uniform ones 0.1


@pytest.mark.parametrize("scale", ["linear", "log", "square"])
def test_a_polynomial_on_its_scale_is_found(places: Array, scale: str) -> None:
    polynomial = 2.0 + places[:, 0] ** 3 * places[:, 1] + 0.4 * places[:, 2]
    values = {"linear": polynomial, "log": np.exp(polynomial), "square": np.sqrt(polynomial + 1.0)}
    fit = SurfaceFit(places, HELD)
    surface = fit.surface(values[scale])
    assert surface is not None
    assert surface.scale == scale or surface.error <= LEAST_ERROR * 30
    assert surface(terms(places, fit.exponents)) == pytest.approx(values[scale], rel=1e-9)


def test_the_error_of_a_kink_is_stated(places: Array) -> None:
    """At random designs, at least 95 % are within the error that others stated."""
    values = 10.0 + np.abs(places[:, 0] - 0.2)
    fit = SurfaceFit(places, HELD)
    surface = fit.surface(values)
    assert surface is not None and surface.error > 1e-3
    others = np.random.default_rng(9).uniform(-1.0, 1.0, (400, 3))
    followed = surface(terms(others, fit.exponents))
    away = np.abs(followed - 10.0 - np.abs(others[:, 0] - 0.2))
    bound = surface.error * (followed if surface.share else 1.0)
    assert np.mean(away <= bound) >= 0.95


def test_a_constant_and_too_few_designs(places: Array) -> None:
    fit = SurfaceFit(places, HELD)
    surface = fit.surface(np.full(COUNT, 3.0))
    assert surface is not None
    assert surface.coefficients.tolist() == [3.0]
    few = np.arange(COUNT) % 20 == 0
    assert fit.surface(places[:, 0], few) is None


@pytest.mark.parametrize("scale", ["linear", "log", "square"])
def test_a_surface_in_another_unit(places: Array, scale: str) -> None:
    fit = SurfaceFit(places, HELD)
    coefficients = np.zeros(len(fit.exponents))
    coefficients[:3] = 2.0, 0.3, 0.1
    surface = Surface(scale, coefficients, 0.01, share=scale == "log")
    again = surface.times(1e3)
    at_places = terms(places, fit.exponents)
    assert again(at_places) == pytest.approx(1e3 * surface(at_places))
    assert again.error == (0.01 if scale == "log" else 10.0)


def test_the_error_of_a_surface_is_rounded_up() -> None:
    surface = Surface("linear", np.array([3.0]), 0.0, share=False)
    assert surface.with_error(0.01234).error == 0.013
    assert surface.with_error(0.012).times(1e6).error == 12000.0
