"""Unit strings: exact, no bare numbers, no wrong dimensions."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("24.2 kN/m", "kN/m", 24200.0),
        ("24.2 N/mm", "kN/m", 24200.0),
        ("42 mm", "mm", 0.042),
        ("0.3mm", "mm", 0.0003),
        ("1500 rpm", "rpm", 50.0 * math.pi),
        ("0.5 turn/s", "rpm", math.pi),
        ("180 deg", "deg", math.pi),
        ("20 degC", "K", 293.15),
        ("68 degF", "K", 293.15),
        ("0.105 MPa m/s", "MPa m/s", 105e3),
        ("7850 kg/m3", "kg/m^3", 7850.0),
        ("3 N*mm", "N m", 0.003),
        ("2 mm²", "mm^2", 2e-6),
        ("-1e-3 m", "mm", -0.001),
        ("1_000 N", "kN", 1000.0),
    ],
)
def test_reads_unit_strings(text: str, unit: str, value: float) -> None:
    # Rounded once from decimal arithmetic: equal but for the last place where pi is in it.
    assert units.parse(text, unit, "field") == pytest.approx(value, rel=2.3e-16, abs=0)


def test_decimal_factors_are_exact() -> None:
    assert [units.parse(f"{k} mm", "mm", "f") for k in range(1, 200)] == [
        float(f"{k}e-3") for k in range(1, 200)
    ]


@pytest.mark.parametrize(
    ("text", "limit"),
    [
        (5, "a number with a unit"),
        (5.0, "a number with a unit"),
        (True, "a number with a unit"),
        (None, "a number with a unit"),
        ("5", "a number with a unit"),
        ("", "a number with a unit"),
        ("mm", "a number with a unit"),
        ("x mm", "a number with a unit"),
        ("1 mm " * 40, "a number with a unit"),
        ("5 kg", "in a unit of the dimension of mm"),
        ("5 rad", "in a unit of the dimension of mm"),
        ("5 furlongz", "in a known unit"),
        ("5 (m", "in a known unit"),
        ("5 m^9^9", "in a known unit"),
        ("9**9**9 m", "in a known unit"),
        ("5 m; import os", "in a known unit"),
        ("nan mm", "finite"),
        ("inf mm", "finite"),
        ("1e999 mm", "finite"),
    ],
)
def test_refuses_what_is_not_a_length(text: object, limit: str) -> None:
    with pytest.raises(InputError) as caught:
        units.parse(text, "mm", "roller.radius")
    assert str(caught.value).startswith("roller.radius = ")
    assert limit in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["25 Hz", "25 1/s", "25 s^-1"])
def test_a_frequency_is_no_angular_speed(text: str) -> None:
    with pytest.raises(InputError, match="dimension of rpm"):
        units.parse(text, "rpm", "speed")


@pytest.mark.parametrize("unit", ["mm", "GPa", "deg", "rpm", "kN/m", "K", "MPa m/s", "kg mm^2"])
@settings(deadline=None)
@given(value=st.floats(1e-9, 1e9, allow_subnormal=False))
def test_written_values_read_back_bit_for_bit(unit: str, value: float) -> None:
    assert units.parse(units.format(value, unit), unit, "field") == value


def test_writes_the_shortest_text() -> None:
    assert units.format(0.0055, "mm") == "5.5 mm"
    assert units.format(24200.0, "kN/m") == "24.2 kN/m"
    assert units.format(0.0, "mm") == "0 mm"
    with pytest.raises(InputError):
        units.format(math.nan, "mm")


def test_column_names_carry_the_unit() -> None:
    assert units.column("normal_force", "N") == "normal_force_N"
    assert units.column("line_load", "N/mm") == "line_load_N_per_mm"
    assert units.column("total", "N m") == "total_Nm"
    assert units.column("lift_d2", "mm/rad^2") == "lift_d2_mm_per_rad2"
    assert units.column("jam_index", "") == "jam_index"


def test_factor() -> None:
    assert units.factor("mm") == 0.001
    assert units.factor("N m") == 1.0
    assert units.factor("percent") == 0.01
