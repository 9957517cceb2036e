"""Figures and texts of the shipped cases are those of `tests/data/pins`; see `tests/pins.py`."""

from __future__ import annotations

import pytest
from pins import PINS, QUICK, differences


@pytest.mark.parametrize("name", QUICK)
def test_a_pin_holds(name: str) -> None:
    lines = differences(name)
    assert not lines, "\n".join(lines[:30])


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in PINS if name not in QUICK])
def test_a_slow_pin_holds(name: str) -> None:
    lines = differences(name)
    assert not lines, "\n".join(lines[:30])
