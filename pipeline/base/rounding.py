"""Numbers of few significant digits."""

from __future__ import annotations

from math import ceil, floor, log10

_HAS_THE_DIGITS = 1e-12  # relative, from a number of these digits


def to_digits(value: float, digits: int, *, up: bool = True) -> float:
    """A value >= 0 rounded up, or down, to `digits` significant digits; one that has no more stays
    as it is.
    """
    if value == 0.0:
        return 0.0
    power = floor(log10(value)) + 1 - digits
    scaled = value / 10.0**power
    slack = scaled * _HAS_THE_DIGITS
    return float(f"{ceil(scaled - slack) if up else floor(scaled + slack)}e{power}")
