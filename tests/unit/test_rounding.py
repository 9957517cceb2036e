"""Numbers of few significant digits: up, down, and those that have them already."""

from __future__ import annotations

import numpy as np
import pytest

from camwright.pipeline.base.rounding import to_digits


@pytest.mark.parametrize(
    ("value", "digits", "up", "down"),
    [
        (0.01234, 2, 0.013, 0.012), (0.012, 2, 0.012, 0.012), (12345.0, 2, 13000.0, 12000.0),
        (0.0, 2, 0.0, 0.0), (999.5, 3, 1000.0, 999.0), (1000.0, 1, 1000.0, 1000.0),
        (0.1 * 3.0, 4, 0.3, 0.3), (1.1e-5 * (1.0 + 1e-9), 2, 1.2e-5, 1.1e-5),
    ],
)  # fmt: skip
def test_values_are_rounded_up_and_down(value: float, digits: int, up: float, down: float) -> None:
    assert to_digits(value, digits) == up
    assert to_digits(value, digits, up=False) == down


def test_a_value_of_the_digits_stays() -> None:
    for text in (f"{k}e{power}" for k in (100, 113, 290, 999) for power in range(-12, 13)):
        for factor in (1.0, 1.0 + 2e-16, 1.0 - 2e-16):
            assert to_digits(factor * float(text), 3) == float(text)
            assert to_digits(factor * float(text), 3, up=False) == float(text)


def test_no_value_is_below_its_rounding_up() -> None:
    values = 10.0 ** np.random.default_rng(2).uniform(-9.0, 9.0, 500)
    for value in map(float, values):
        up, down = to_digits(value, 3), to_digits(value, 3, up=False)
        assert down * (1.0 - 1e-11) <= value <= up * (1.0 + 1e-11)
        assert up - down <= 0.0101 * value
