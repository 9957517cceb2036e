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


PINNED = {
    "%": ("0.01", (0, 0, 0, 0, 0)),
    "1/GPa": ("1E-9", (-1, 1, 2, 0, 0)),
    "1/K": ("1", (0, 0, 0, -1, 0)),
    "1/min": ("0.01666666666666666666666666667", (0, 0, -1, 0, 0)),
    "1/mm^2": ("1E+6", (0, -2, 0, 0, 0)),
    "1/s": ("1", (0, 0, -1, 0, 0)),
    "GPa": ("1E+9", (1, -1, -2, 0, 0)),
    "Hz": ("1", (0, 0, -1, 0, 0)),
    "J/kg/K": ("1", (0, 2, -2, -1, 0)),
    "K/W": ("1", (-1, -2, 3, 1, 0)),
    "MJ/kg": ("1E+6", (0, 2, -2, 0, 0)),
    "MN/m": ("1E+6", (1, 0, -2, 0, 0)),
    "MPa m/s": ("1E+6", (1, 0, -3, 0, 0)),
    "N cm": ("0.01", (1, 2, -2, 0, 0)),
    "N m s/rad": ("1", (1, 2, -1, 0, -1)),
    "N m/rad": ("1", (1, 2, -2, 0, -1)),
    "N mm": ("0.001", (1, 2, -2, 0, 0)),
    "N s/m": ("1", (1, 0, -1, 0, 0)),
    "N*mm": ("0.001", (1, 2, -2, 0, 0)),
    "N/cm2": ("1E+4", (1, -1, -2, 0, 0)),
    "N/cm2 m/min": ("166.6666666666666666666666667", (1, 0, -3, 0, 0)),
    "N/mm": ("1E+3", (1, 0, -2, 0, 0)),
    "W/m/K": ("1", (1, 1, -3, -1, 0)),
    "bar": ("1E+5", (1, -1, -2, 0, 0)),
    "cm^3": ("0.000001", (0, 3, 0, 0, 0)),
    "day": ("8.64E+4", (0, 0, 1, 0, 0)),
    "deg": ("0.01745329251994329576923690768", (0, 0, 0, 0, 1)),
    "ft": ("0.3048", (0, 1, 0, 0, 0)),
    "g cm^2": ("1E-7", (1, 2, 0, 0, 0)),
    "g mm": ("0.000001", (1, 1, 0, 0, 0)),
    "g/cm3": ("1E+3", (1, -3, 0, 0, 0)),
    "h": ("3.6E+3", (0, 0, 1, 0, 0)),
    "in": ("0.0254", (0, 1, 0, 0, 0)),
    "inch": ("0.0254", (0, 1, 0, 0, 0)),
    "kN/mm": ("1E+6", (1, 0, -2, 0, 0)),
    "kPa": ("1E+3", (1, -1, -2, 0, 0)),
    "kW": ("1E+3", (1, 2, -3, 0, 0)),
    "kgf": ("9.80665", (1, 1, -2, 0, 0)),
    "kg mm^2": ("0.000001", (1, 2, 0, 0, 0)),
    "kg/m3": ("1", (1, -3, 0, 0, 0)),
    "lb": ("0.45359237", (1, 0, 0, 0, 0)),
    "lb/in3": ("27679.90471020312119364396209", (1, -3, 0, 0, 0)),
    "lbf": ("4.4482216152605", (1, 1, -2, 0, 0)),
    "lbf/in": ("175.1268352464763779527559054", (1, 0, -2, 0, 0)),
    "lbf in": ("0.1129848290276167", (1, 2, -2, 0, 0)),
    "mPa s": ("0.001", (1, -1, -1, 0, 0)),
    "cSt": ("0.000001", (0, 2, -1, 0, 0)),
    "min-1": ("0.01666666666666666666666666667", (0, 0, -1, 0, 0)),
    "mm/rad^2": ("0.001", (0, 1, 0, 0, -2)),
    "mm^2/s": ("0.000001", (0, 2, -1, 0, 0)),
    "mm^3/N/m": ("1E-9", (-1, 1, 2, 0, 0)),
    "mm²": ("0.000001", (0, 2, 0, 0, 0)),
    "mrad": ("0.001", (0, 0, 0, 0, 1)),
    "ms": ("0.001", (0, 0, 1, 0, 0)),
    "nm": ("1E-9", (0, 1, 0, 0, 0)),
    "psi": ("6894.757293168361336722673443", (1, -1, -2, 0, 0)),
    "ksi": ("6894757.293168361336722673443", (1, -1, -2, 0, 0)),
    "atm": ("101325", (1, -1, -2, 0, 0)),
    "hp": ("745.69987158227022", (1, 2, -3, 0, 0)),
    "oz": ("0.028349523125", (1, 0, 0, 0, 0)),
    "rad/s²": ("1", (0, 0, -2, 0, 1)),
    "rpm": ("0.1047197551196597746154214461", (0, 0, -1, 0, 1)),
    "rps": ("6.283185307179586476925286766", (0, 0, -1, 0, 1)),
    "t": ("1E+3", (1, 0, 0, 0, 0)),
    "turn/s": ("6.283185307179586476925286766", (0, 0, -1, 0, 1)),
    "um": ("0.000001", (0, 1, 0, 0, 0)),
    "µm": ("0.000001", (0, 1, 0, 0, 0)),
    "µs": ("0.000001", (0, 0, 1, 0, 0)),
    "°": ("0.01745329251994329576923690768", (0, 0, 0, 0, 1)),
    "hPa": ("1E+2", (1, -1, -2, 0, 0)),
    "mbar": ("1E+2", (1, -1, -2, 0, 0)),
    "daN": ("1E+1", (1, 1, -2, 0, 0)),
    "cP": ("0.001", (1, -1, -1, 0, 0)),
    "MPa^-1": ("0.000001", (-1, 1, 2, 0, 0)),
    "m ^2": ("1", (0, 2, 0, 0, 0)),
    "N·m": ("1", (1, 2, -2, 0, 0)),
}
"""SI value and powers of kg, m, s, K and rad of the units of cases and tests, to 28 digits."""


@pytest.mark.parametrize("unit", PINNED)
def test_a_unit_has_its_exact_factor(unit: str) -> None:
    size, powers = PINNED[unit]
    read = units._unit(unit)
    assert (*read.powers, read.zero) == (*powers, 0, 0)
    # 28 digits of decimal arithmetic, a few operations
    assert abs(read.size / Decimal(size) - 1) < Decimal("1e-26")
    assert float(read.size) == float(Decimal(size))
    assert units.parse(f"3 {unit}", unit, "f") == float(3 * Decimal(size))


@pytest.mark.parametrize(
    "form",
    ["{0}", "1/{0}", "{0} {1}", "{0}*{1}", "{0}/{1}", "{0}^2/{1}", "{1}**2 {0}-1", "{1}/{0}/{1}3"],
)
def test_units_are_composed_from_left_to_right(form: str) -> None:
    forms: dict[str, tuple[int, int]] = {
        "{0}": (1, 0), "1/{0}": (-1, 0), "{0} {1}": (1, 1), "{0}*{1}": (1, 1), "{0}/{1}": (1, -1),
        "{0}^2/{1}": (2, -1), "{1}**2 {0}-1": (-1, 2), "{1}/{0}/{1}3": (-1, -2),
    }  # fmt: skip
    names = list(units._UNITS)
    for first, second in zip(names, names[7:] + names[:7], strict=True):
        one, other = units._UNITS[first], units._UNITS[second]
        read = units._unit(form.format(first, second))
        a, b = forms[form]
        assert abs(read.size / (one.size**a * other.size**b) - 1) < Decimal("1e-26")
        powers = zip(one.powers, other.powers, strict=True)
        assert read.powers == tuple(a * x + b * y for x, y in powers)


def test_byte_is_a_dimension_of_its_own() -> None:
    assert units.parse("20 MB", "MB", "memory") == 20e6 == 20 * units.factor("MB")
    assert not units.same_dimension("MB", "percent")


@pytest.mark.parametrize(
    ("text", "kelvin"),
    [("20 degC", 293.15), ("-40 °C", 233.15), ("-273.15 degC", 0.0), ("68 degF", 293.15),
     ("-40 degF", 233.15), ("-459.67 °F", 0.0), ("70.000001 degC", 343.150001)],
)  # fmt: skip
def test_a_temperature_has_its_zero(text: str, kelvin: float) -> None:
    assert units.parse(text, "K", "temperature") == kelvin
    assert units.same_dimension("degC", "K") and not units.same_dimension("degC", "m")
    with pytest.raises(ValueError, match="degC"):
        units._unit("W/degC")


@pytest.mark.parametrize(
    ("text", "closest"),
    [("3 mn", "mm|mN|min"), ("3 Mpa", "MPa"), ("3 inchs", "inches"), ("3 newton", ""),
     ("3 furlong", "")],
)  # fmt: skip
def test_an_unknown_unit_names_the_closest(text: str, closest: str) -> None:
    with pytest.raises(InputError, match="in a known unit, such as mm") as refused:
        units.parse(text, "mm", "length")
    if closest:
        assert re.search(rf"; did you mean ({closest})\?$", str(refused.value))
    else:
        assert "did you mean" not in str(refused.value)


@pytest.mark.parametrize(
    "text", ["m//s", "m /", "/m", "m*", "m*/s", "1//m", "m**", "m^2^2", " m", "1", "1 m", "m*1/s",
             "m10", "m^0", "kkg", "mmin", "ft²²"],
)  # fmt: skip
def test_what_is_no_unit_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r".*"):
        units._unit(text)


@pytest.mark.parametrize(("text", "value"), [("20", 20e-6), (" -3 ", -3e-6), ("0.02 mm", 20e-6)])
def test_a_bare_number_has_the_unit_of_its_option(text: str, value: float) -> None:
    assert units.parse_or_bare(text, "um", "--tolerance") == pytest.approx(value, rel=1e-12)
    with pytest.raises(InputError, match="--tolerance"):
        units.parse_or_bare(f"{text} s", "um", "--tolerance")
