"""Unit strings to SI and back: "12.5 mm" <-> 0.0125. The one module that names pint.

Numbers are converted in decimal arithmetic and rounded once, so that "42 mm" is exactly 0.042
and a value that was written out is read back bit for bit. The plane angle counts as a dimension
of its own here: otherwise "25 Hz" would pass for 25 rad/s.

The common units stand in a table, `_COMMON`; pint, whose start takes longer than a preview, reads
all others.
"""

from __future__ import annotations

import re
from decimal import ROUND_CEILING, Decimal, InvalidOperation
from functools import lru_cache
from math import ceil, degrees, isfinite, isnan, log10, radians
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from camwright.geometry.errors import InputError

if TYPE_CHECKING:
    from pint import UnitRegistry
    from pint.facets.plain import PlainUnit

    from camwright.geometry.arrays import Array, Value

_Temperature = TypeVar("_Temperature", float, "Array", "Value")
_NUMBER = (  # no digits of other scripts, of which some look like another one of ours
    r"[+-]?(?:[0-9][0-9_]*(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?"
    r"|[+-]?(?:nan|inf|infinity)"
)
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*", re.IGNORECASE | re.DOTALL)
_FRACTION = re.compile(  # of an inch, also mixed: 7/16, 1 3/8, 1-3/8
    r"\s*([+-]?)(?:([0-9]{1,6})(?:\s+|\s*-\s*))?([0-9]{1,6})\s*/\s*([0-9]{1,6})\s*([A-Za-z].*?)\s*",
    re.DOTALL,
)
_TERM = r"[A-Za-zµμ°Å%]+(?:\s*(?:\^|\*\*)?\s*-?[1-9]|[²³])?"
_UNIT = re.compile(rf"(?:1\s*/\s*)?{_TERM}(?:\s*[*·/ ]\s*{_TERM})*")
_IMPLIED_POWER = re.compile(r"(?<=[A-Za-zµμ])(-?[1-9])")
_ANGLES = (  # endings, since prefixes go before them
    *("radian", "degree", "turn", "arcminute", "arcsecond", "grade"),
    *("revolutions_per_minute", "revolutions_per_second"),
)
_LONGEST_TEXT = 80  # characters of a number with its unit


class _Common(NamedTuple):
    """Coherent SI value of one unit, its powers of kg, m, s, K and rad, and that of its zero."""

    size: Decimal
    powers: tuple[int, int, int, int, int]
    zero: Decimal = Decimal(0)


def _common(size: str, *powers: int) -> _Common:
    kg, m, s, kelvin, rad = (*powers, *(0,) * (5 - len(powers)))
    return _Common(Decimal(size), (kg, m, s, kelvin, rad))


_TURN = 2 * Decimal("3.14159265358979323846264338327950288")
_COMMON = {
    "kg": _common("1", 1),
    "g": _common("1e-3", 1),
    "mg": _common("1e-6", 1),
    "m": _common("1", 0, 1),
    "cm": _common("1e-2", 0, 1),
    "mm": _common("1e-3", 0, 1),
    "um": _common("1e-6", 0, 1),
    "s": _common("1", 0, 0, 1),
    "ms": _common("1e-3", 0, 0, 1),
    "min": _common("60", 0, 0, 1),
    "h": _common("3600", 0, 0, 1),
    "Hz": _common("1", 0, 0, -1),
    "K": _common("1", 0, 0, 0, 1),
    "rad": _common("1", 0, 0, 0, 0, 1),
    "mrad": _common("1e-3", 0, 0, 0, 0, 1),
    "deg": _Common(_TURN / 360, (0, 0, 0, 0, 1)),
    "rpm": _Common(_TURN / 60, (0, 0, -1, 0, 1)),
    "N": _common("1", 1, 1, -2),
    "kN": _common("1e3", 1, 1, -2),
    "Pa": _common("1", 1, -1, -2),
    "kPa": _common("1e3", 1, -1, -2),
    "MPa": _common("1e6", 1, -1, -2),
    "GPa": _common("1e9", 1, -1, -2),
    "mPa": _common("1e-3", 1, -1, -2),
    "bar": _common("1e5", 1, -1, -2),
    "J": _common("1", 1, 2, -2),
    "kJ": _common("1e3", 1, 2, -2),
    "MJ": _common("1e6", 1, 2, -2),
    "W": _common("1", 1, 2, -3),
    "kW": _common("1e3", 1, 2, -3),
    "percent": _common("1e-2"),
}
"""Units read without pint. Reciprocals, products and powers of them are, too."""
_SPEEDS = {
    **dict.fromkeys(("1/min", "/min", "min^-1", "min**-1", "min-1", "min⁻¹"), "rpm"),
    **dict.fromkeys(("RPM", "Rpm", "r/min", "rev/min", "U/min"), "rpm"),
    **dict.fromkeys(("Hz", "r/s", "rev/s", "U/s"), "rps"),
}
"""Units of a speed of rotation in turns, where a speed is wanted. 1/s is none: it may be rad/s."""
_TORQUE = re.compile(r"(k?N)(m?m)(?![A-Za-z])")
_ACCEPTED = {
    "rpm": "rpm, 1/min, Hz (turns per second), rad/s or deg/s",
    "mm": 'mm, um, cm, m or in, also "7/16 in"',
    "N": "N, kN, kgf or lbf",
    "N m": "N m, N mm, kN m or lbf in",
    "N/mm": "N/mm, kN/m, N/m or lbf/in",
    "MPa": "MPa, N/mm^2, GPa, Pa, bar or psi",
    "kg": "kg, g or lb",
    "K": "degC, K or degF",
    "deg": "deg or rad",
    "s": "s, ms, min or h",
}
"""Units that a refusal names, by one of their dimension."""
_CELSIUS, _ZERO_CELSIUS = "degC", Decimal("273.15")
"""Unit with a zero of its own, K, read without pint where it stands alone."""
_COMMON_TERM = re.compile(r"([A-Za-z]+)(?:(?:\^|\*\*)?(-?[1-9]))?")
_BETWEEN = re.compile(r"\s*(?<!\*)([*/])(?!\*)\s*|\s+")


@lru_cache(maxsize=512)
def _from_table(text: str) -> _Common | None:
    """Unit composed of those of the table, from left to right as pint does; None otherwise."""
    if text == _CELSIUS:
        return _COMMON["K"]._replace(zero=_ZERO_CELSIUS)
    if text and (len(text) > _LONGEST_TEXT or not _UNIT.fullmatch(text)):
        return None
    size, powers, sign = Decimal(1), [0] * 5, 1
    if text.startswith("1"):
        sign, text = -1, text.partition("/")[2].lstrip()
    for word in filter(None, _BETWEEN.split(text)):
        if word in ("*", "/"):
            sign = 1 if word == "*" else -1
            continue
        term = _COMMON_TERM.fullmatch(word)
        unit = _COMMON.get(term.group(1)) if term else None
        if term is None or unit is None:
            return None
        power = sign * int(term.group(2) or 1)
        size *= unit.size**power
        powers = [sum_ + power * each for sum_, each in zip(powers, unit.powers, strict=True)]
        sign = 1
    kg, m, s, kelvin, rad = powers
    return _Common(size, (kg, m, s, kelvin, rad))


@lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Decimal]:
    import pint  # half a second, and only a case file with uncommon units needs it

    return pint.UnitRegistry(non_int_type=Decimal)


@lru_cache(maxsize=512)
def _unit(text: str) -> PlainUnit:
    """The pint unit of `text`; ValueError if it is none."""
    if not text:
        return _registry().dimensionless
    if len(text) > _LONGEST_TEXT or not _UNIT.fullmatch(text):
        raise ValueError(text)
    spelled = _IMPLIED_POWER.sub(r"**\1", text.replace("^", "**")).replace("****", "**")
    try:
        return _registry().Unit(spelled)
    except Exception as error:  # pint's parser lets tokenizer errors through
        raise ValueError(text) from error


@lru_cache(maxsize=512)
def _si_unit(text: str) -> PlainUnit:
    """The coherent SI unit of the same dimension as `text`, the angle in rad."""
    unit = _unit(text)
    return _registry().Quantity(Decimal(1), unit).to_base_units().units


def _to_si(number: Decimal, unit: str, wanted: str) -> Decimal:
    known = _from_table(unit)
    if known is not None:
        return number * known.size + known.zero
    converted: Decimal = _registry().Quantity(number, _unit(unit)).to(_si_unit(wanted)).magnitude
    return converted


def _from_si(number: Decimal, unit: str) -> Decimal:
    known = _from_table(unit)
    if known is not None:
        return (number - known.zero) / known.size
    converted: Decimal = _registry().Quantity(number, _si_unit(unit)).to(_unit(unit)).magnitude
    return converted


def same_dimension(unit: str, other: str) -> bool:
    """Whether two units measure the same quantity."""
    first, second = _from_table(unit), _from_table(other)
    if first is not None and second is not None:
        return first.powers == second.powers
    one, two = _unit(unit), _unit(other)
    return bool(one.dimensionality == two.dimensionality and _angle(one) == _angle(two))


def _angle(unit: PlainUnit) -> int:
    """Power of the plane angle in a unit; pint treats the angle as a pure number."""
    from pint.util import to_units_container

    powers = to_units_container(unit).items()
    angles = [power for name, power in powers if name.endswith(_ANGLES)]
    return int(sum(float(power) for power in angles if isinstance(power, (int, float, Decimal))))


def _spelled(stated: str, unit: str) -> str:
    """A unit as this module reads it: a speed in turns where one is wanted, ``Nm`` as ``N m``."""
    if same_dimension(unit, "rpm"):
        return _SPEEDS.get(stated, stated)
    torque = _TORQUE.match(stated)
    return f"{torque[1]} {torque[2]}{stated[torque.end() :]}" if torque else stated


def _accepted(unit: str) -> str:
    """Units of the dimension of `unit` in words, after a colon; "" where none are listed."""
    words = (each for known, each in _ACCEPTED.items() if same_dimension(known, unit))
    return next((f": {each}" for each in words), "")


def _number_and_unit(text: str) -> tuple[Decimal, str] | None:
    """Number and unit of a text; a fraction, ``1 3/8 in``, counts as one number. None: neither."""
    if len(text) > _LONGEST_TEXT:
        return None
    if fraction := _FRACTION.fullmatch(text):
        sign, whole, above, below, unit = fraction.groups()
        number = Decimal(whole or 0) + Decimal(above) / (Decimal(below) or Decimal("nan"))
        return -number if sign == "-" else number, unit
    match = _QUANTITY.fullmatch(text)
    return (Decimal(match[1]), match[2]) if match and match[2] else None


def parse(text: object, unit: str, field: str) -> float:
    """SI value of a text with unit.

    Parameters
    ----------
    text : object   such as ``"24.2 kN/m"`` or ``"7/16 in"``; anything but a string is refused
    unit : str      any unit of the wanted dimension, such as ``"kN/m"``
    field : str     dotted name for the message

    Returns
    -------
    value : float   in m, kg, s, K, rad and units derived from them

    Raises
    ------
    InputError
        If the unit is missing, unknown or of another dimension, or the number is not finite.
    """
    example = f'a number with a unit, such as "1 {unit}"'
    if not isinstance(text, str):
        raise InputError(field, repr(text), example)
    read = _number_and_unit(text)
    if read is None:
        raise InputError(field, text, example)
    number, stated = read
    try:
        stated = _spelled(stated, unit)
        known = same_dimension(stated, unit)
    except ValueError:
        limit = f"in a known unit, such as {unit}{_accepted(unit)}"
        if re.match(r"[,'][0-9]", stated):
            limit = f"written with a decimal point and without separators, such as 1500.5 {unit}"
        raise InputError(field, text, limit) from None
    if not known:
        raise InputError(field, text, f"in a unit of the dimension of {unit}{_accepted(unit)}")
    try:
        value = float(_to_si(number, stated, unit))
    except (InvalidOperation, OverflowError, ValueError):
        value = float("nan")
    if not isfinite(value):
        raise InputError(field, text, "finite")
    return value


@lru_cache(maxsize=512)
def factor(unit: str) -> float:
    """SI value of one `unit`: ``factor("mm")`` is 0.001; not for offset units such as degC."""
    return float(_to_si(Decimal(1), unit, unit))


def format(value: float, unit: str) -> str:  # noqa: A001 - reads as units.format
    """Shortest text with unit that `parse` reads back as exactly `value` (SI)."""
    if not isfinite(value):
        raise InputError("value", value, "finite")
    exact = _from_si(Decimal(value), unit)
    # 18 digits hold any float.
    numbers = (Decimal(f"{exact:.{digits}g}") for digits in range(1, 19))
    shortest = next(n for n in numbers if float(_to_si(n, unit, unit)) == value)
    return f"{_plain(shortest)} {unit}"


def rounded(text: str, digits: int = 4) -> str:
    """Text with its number rounded; unchanged where it has no more digits, or is no number."""
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST_TEXT else None
    number = Decimal(match.group(1)) if match else Decimal("NaN")
    if (
        match is None
        or _FRACTION.fullmatch(text)
        or not number.is_finite()
        or len(number.normalize().as_tuple().digits) <= digits
    ):
        return " ".join(text.split())
    return f"{_plain(Decimal(f'{number:.{digits}g}'))} {match.group(2)}".rstrip()


def _plain(number: Decimal) -> str:
    """Without an exponent where that stays readable: 24200, 0.0055, 2.1e-07."""
    if number == 0:
        return "0"
    exponent = number.adjusted()
    if -5 <= exponent <= 8:
        text = f"{number:f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return f"{number.normalize():e}"


def column(name: str, unit: str) -> str:
    """Name of a table column that carries its unit.

    ``("line_load", "N/mm")`` gives ``line_load_N_per_mm``. Products are written together (``Nm``),
    powers as digits (``mm_per_rad2``).
    """
    if not unit:
        return name
    above, *below = (
        part.replace("·", "").replace("*", "").replace(" ", "").replace("^", "")
        for part in unit.split("/")
    )
    return "_".join([name, above, *(word for part in below for word in ("per", part))])


COUNTS = ("corners", "crossings", "data", "rotations", "waivers")
_PURE = ("", "-", "degC", *COUNTS)  # a Celsius temperature is a number of degrees


def in_unit(value: float, unit: str) -> float:
    """SI value converted to a unit of a record; also ``%``, ``-``, ``degC`` and counted things."""
    if unit in _PURE:
        return value
    if unit == "deg":
        return degrees(value)
    if unit == "%":
        return 100.0 * value
    return value / factor(unit)


def from_unit(value: float, unit: str) -> float:
    """Value in a unit of a record converted to SI; the inverse of `in_unit`."""
    if unit in _PURE:
        return value
    if unit == "deg":
        return radians(value)
    return value * (0.01 if unit == "%" else factor(unit))


def celsius(temperature: _Temperature) -> _Temperature:
    """Temperature (...) in degC, from K."""
    return temperature - float(_ZERO_CELSIUS)


def shown(value: float, unit: str, digits: int = 4) -> str:
    """SI value as text in a unit, such as ``12.5 mm``."""
    number = f"{in_unit(value, unit):.{digits}g}"
    return f"{number} {unit}" if unit not in ("", "-") else number


def shown_up(value: float, unit: str, digits: int = 4) -> str:
    """SI value > 0 as text in a unit, rounded up: for a bound that suffices."""
    number = in_unit(value, unit)
    last = Decimal(1).scaleb(Decimal(number).adjusted() - digits + 1)
    rounded = Decimal(number).quantize(last, rounding=ROUND_CEILING)
    return f"{rounded.normalize():f} {unit}"


def used(utilisation: float | None) -> str:
    """Utilisation of a limit in percent; ``> 999 %`` above, ``-`` for a missing one.

    More digits near 100 %, so that 100.04 % is not written as 100 %.
    """
    if utilisation is None or isnan(utilisation):
        return "-"
    if utilisation > _USED_MOST:
        return f"> {_USED_MOST:.0%}".replace("%", " %")
    if 0.0 < utilisation < 0.005:
        return "< 1 %"
    off = abs(utilisation - 1.0)
    digits = min(ceil(-log10(off)) - 2, 10) if 0.0 < off < 0.005 else 0
    return f"{100.0 * utilisation:.{digits}f} %"


_USED_MOST = 9.99
"""Utilisation above which its value says no more."""
