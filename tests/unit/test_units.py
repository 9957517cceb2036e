"""Unit strings: exact, no bare numbers, no wrong dimensions."""

from __future__ import annotations

import math
import re
from decimal import Decimal

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


@pytest.mark.parametrize(
    "text",
    ["1500 rpm", "1500 RPM", "1500 1/min", "1500 min^-1", "1500 min-1", "1500 /min", "1500 r/min",
     "1500 rev/min", "1500 U/min", "25 Hz", "25 rev/s", "25 r/s"],
)  # fmt: skip
def test_a_speed_of_rotation_in_turns(text: str) -> None:
    assert units.parse(text, "rpm", "speed") == pytest.approx(2.0 * math.pi * 25.0, rel=1e-15)


@pytest.mark.parametrize("text", ["25 1/s", "25 s^-1", "25 kW"])
def test_what_may_be_radians_is_no_speed(text: str) -> None:
    with pytest.raises(InputError, match=r"rpm: rpm, 1/min, Hz \(turns per second\), rad/s"):
        units.parse(text, "rpm", "speed")


def test_turns_are_those_of_a_speed_alone() -> None:
    assert units.parse("25 Hz", "Hz", "frequency") == 25.0
    assert units.parse("60 1/min", "Hz", "frequency") == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "inches"),
    [("7/16 in", 0.4375), ("1 3/8 in", 1.375), ("1-3/8 in", 1.375), ("-3/4 in", -0.75),
     (" 1  1/2  inch ", 1.5), ("0/8 in", 0.0), ("5/64in", 0.078125)],
)  # fmt: skip
def test_fractions_of_an_inch(text: str, inches: float) -> None:
    assert units.parse(text, "mm", "length") == pytest.approx(inches * 25.4e-3, rel=1e-15)
    assert units.rounded(text) == " ".join(text.split())


@pytest.mark.parametrize("text", ["1/0 in", "7/16", "1 3/8", "1/2/3 in", "1e3/4 in", "1.5 3/8 in"])
def test_refuses_other_fractions(text: str) -> None:
    with pytest.raises(InputError, match="length = "):
        units.parse(text, "mm", "length")


@pytest.mark.parametrize("text", ["0,5 mm", "1'500 mm", "1,500.0 mm"])
def test_a_separator_is_named(text: str) -> None:
    with pytest.raises(InputError, match="decimal point and without separators"):
        units.parse(text, "mm", "length")


def test_a_torque_is_written_in_either_way() -> None:
    for text in ("5 N m", "5 Nm", "5000 Nmm", "0.005 kNm", "5 N*m"):
        assert units.parse(text, "N m", "torque") == 5.0


def test_every_unit_that_a_refusal_names_is_read() -> None:
    for wanted, words in units._ACCEPTED.items():
        for each in re.split(r", | or ", re.sub(r' \(.*?\)|, also ".*"', "", words)):
            assert units.same_dimension(wanted, units._spelled(each, wanted)), each


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


@pytest.mark.parametrize("unit", ["", "-", "deg", "%", "MPa", "degC", "um", "corners", "g mm"])
def test_a_number_of_a_record_is_read_as_it_was_written(unit: str) -> None:
    assert units.from_unit(units.in_unit(0.37, unit), unit) == pytest.approx(0.37, rel=1e-15)


def test_factor() -> None:
    assert units.factor("mm") == 0.001
    assert units.factor("N m") == 1.0
    assert units.factor("percent") == 0.01


def _pint_powers(text: str) -> tuple[float, ...]:
    """Powers of kg, m, s, K and rad of a unit by pint."""
    unit = units._unit(text)
    names = ("[mass]", "[length]", "[time]", "[temperature]")
    return (*(float(unit.dimensionality.get(name, 0)) for name in names), units._angle(unit))


@pytest.mark.parametrize(
    "form",
    ["{0}", "1/{0}", "{0} {1}", "{0}*{1}", "{0}/{1}", "{0}^2/{1}", "{1}**2 {0}-1", "{1}/{0}/{1}3"],
)
def test_table_of_units_agrees_with_pint(form: str) -> None:
    # 28 digits of decimal arithmetic, a few operations
    names = list(units._COMMON)
    pairs = zip(names, names[7:] + names[:7], strict=True)
    for text in (form.format(*pair) for pair in pairs):
        table = units._from_table(text)
        assert table is not None
        assert table.powers == _pint_powers(text), text
        registry = units._registry()
        size = registry.Quantity(Decimal(1), units._unit(text)).to_base_units().magnitude
        assert abs(size / table.size - 1) < Decimal("1e-25"), text


@pytest.mark.parametrize("number", ["20", "-40", "1e3", "0.05", "-273.15", "70.000001"])
def test_a_celsius_temperature_is_that_of_pint(number: str) -> None:
    registry, value = units._registry(), Decimal(number)
    kelvin = registry.Quantity(value, "degC").to("K").magnitude
    assert units._to_si(value, "degC", "K") == kelvin
    assert units._from_si(kelvin, "degC") == registry.Quantity(kelvin, "K").to("degC").magnitude
    assert units.same_dimension("degC", "K") and not units.same_dimension("degC", "m")
    assert units._from_table("W/degC") is None


@pytest.mark.parametrize(
    "text", ["m//s", "m /", "/m", "m*", "m*/s", "1//m", "m**", "m^2^2", " m", "1", "1 m", "m*1/s"]
)
def test_table_of_units_takes_nothing_that_pint_refuses(text: str) -> None:
    assert units._from_table(text) is None
    with pytest.raises(ValueError, match=r".*"):
        units._unit(text)
