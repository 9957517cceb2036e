"""Unit strings to SI and back: "12.5 mm" <-> 0.0125.

Numbers are converted in decimal arithmetic and rounded once, so that "42 mm" is exactly 0.042
and a value that was written out is read back bit for bit. The plane angle counts as a dimension
of its own here: otherwise "25 Hz" would pass for 25 rad/s.

Units stand in a table, `_UNITS`, with exact factors; a unit string is one of them, a power, a
product or a quotient, read from left to right.
"""

from __future__ import annotations

import difflib
import re
from decimal import ROUND_CEILING, Decimal, InvalidOperation
from functools import lru_cache
from math import ceil, degrees, isfinite, isnan, log10, radians
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from camwright.geometry.errors import InputError

if TYPE_CHECKING:
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
_TERM = r"[A-Za-zµμ°%]+(?:\^?-?[1-9]|[²³])?"
_UNIT = re.compile(rf"(?:1\s*/\s*)?{_TERM}(?:\s*[*·/ ]\s*{_TERM})*")
_POWER = re.compile(r"\s*(?:\^|\*\*)\s*")
_PARTS = re.compile(r"([*·/])|([A-Za-zµμ°%]+)(?:\^?(-?[1-9])|([²³]))?")
_LONGEST_TEXT = 80


class _Unit(NamedTuple):
    """SI value of one unit, its powers of kg, m, s, K, rad and byte, and the value of its zero."""

    size: Decimal
    powers: tuple[int, ...]
    zero: Decimal = Decimal(0)


def _padded(powers: tuple[int, ...]) -> tuple[int, ...]:
    return (*powers, *(0,) * (_DIMENSIONS - len(powers)))


_DIMENSIONS = 6
_TURN = 2 * Decimal("3.14159265358979323846264338327950288")
_INCH, _POUND, _GRAVITY = Decimal("0.0254"), Decimal("0.45359237"), Decimal("9.80665")
_FAHRENHEIT = Decimal(5) / 9
_ZERO_CELSIUS = Decimal("273.15")
_PREFIXES = {
    "": 0, "n": -9, "u": -6, "µ": -6, "μ": -6, "m": -3, "c": -2, "d": -1, "da": 1, "h": 2, "k": 3,
    "M": 6, "G": 9,
}  # fmt: skip
_COHERENT = {  # with prefixes
    "m": (0, 1), "s": (0, 0, 1), "rad": (0, 0, 0, 0, 1), "N": (1, 1, -2), "Pa": (1, -1, -2),
    "J": (1, 2, -2), "W": (1, 2, -3), "Hz": (0, 0, -1),
}  # fmt: skip
_OTHER: tuple[tuple[str, Decimal | float | str, tuple[int, ...]], ...] = (
    ("g", "1e-3", (1,)), ("kg", 1, (1,)), ("mg", "1e-6", (1,)), ("t", 1000, (1,)),
    ("lb", _POUND, (1,)), ("oz", _POUND / 16, (1,)),
    ("in inch inches", _INCH, (0, 1)), ("ft", 12 * _INCH, (0, 1)),
    ("min minute minutes", 60, (0, 0, 1)), ("h hour hours", 3600, (0, 0, 1)),
    ("d day days", 86400, (0, 0, 1)), ("K", 1, (0, 0, 0, 1)),
    ("deg degree degrees °", _TURN / 360, (0, 0, 0, 0, 1)),
    ("turn turns rev", _TURN, (0, 0, 0, 0, 1)),
    ("rpm", _TURN / 60, (0, 0, -1, 0, 1)), ("rps", _TURN, (0, 0, -1, 0, 1)),
    ("kgf kp", _GRAVITY, (1, 1, -2)), ("lbf", _POUND * _GRAVITY, (1, 1, -2)),
    ("bar", 100_000, (1, -1, -2)), ("mbar", 100, (1, -1, -2)), ("atm", 101_325, (1, -1, -2)),
    ("psi", _POUND * _GRAVITY / _INCH**2, (1, -1, -2)),
    ("ksi", 1000 * _POUND * _GRAVITY / _INCH**2, (1, -1, -2)),
    ("hp", 550 * 12 * _INCH * _POUND * _GRAVITY, (1, 2, -3)), ("PS", 75 * _GRAVITY, (1, 2, -3)),
    ("cP", "1e-3", (1, -1, -1)), ("cSt", "1e-6", (0, 2, -1)), ("percent %", "1e-2", ()),
    ("kB", 1e3, (0, 0, 0, 0, 0, 1)), ("MB", 1e6, (0, 0, 0, 0, 0, 1)),
    ("GB", 1e9, (0, 0, 0, 0, 0, 1)),
)  # fmt: skip
_UNITS = {
    prefix + name: _Unit(Decimal(1).scaleb(power), _padded(powers))
    for name, powers in _COHERENT.items()
    for prefix, power in _PREFIXES.items()
} | {
    name: _Unit(Decimal(size), _padded(powers))
    for names, size, powers in _OTHER
    for name in names.split()
}
_ALONE = dict.fromkeys(("degC", "°C"), _UNITS["K"]._replace(zero=_ZERO_CELSIUS)) | dict.fromkeys(
    ("degF", "°F"),
    _UNITS["K"]._replace(size=_FAHRENHEIT, zero=_ZERO_CELSIUS - 32 * _FAHRENHEIT),
)
"""Units with a zero of their own, which stand alone."""
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


@lru_cache(maxsize=512)
def _unit(text: str) -> _Unit:
    """Unit of a text such as ``kN/m`` or ``mm^2``: size in SI and powers of the dimensions;
    ValueError if it is no unit.
    """
    if text in _ALONE:
        return _ALONE[text]
    text = _POWER.sub("^", text)
    if text and (len(text) > _LONGEST_TEXT or not _UNIT.fullmatch(text)):
        raise ValueError(text)
    size, powers, sign = Decimal(1), [0] * _DIMENSIONS, 1
    for between, word, power, raised in _PARTS.findall(text):
        if between:
            sign = -1 if between == "/" else 1
            continue
        if word not in _UNITS:
            raise ValueError(word)
        unit, count = _UNITS[word], sign * int(power or {"²": 2, "³": 3}.get(raised, 1))
        size *= unit.size**count
        powers = [total + count * each for total, each in zip(powers, unit.powers, strict=True)]
        sign = 1
    return _Unit(size, tuple(powers))


def _to_si(number: Decimal, unit: str) -> Decimal:
    return number * _unit(unit).size + _unit(unit).zero


def _from_si(number: Decimal, unit: str) -> Decimal:
    return (number - _unit(unit).zero) / _unit(unit).size


def same_dimension(unit: str, other: str) -> bool:
    """Whether two units measure the same quantity; ValueError if one is unknown."""
    return _unit(unit).powers == _unit(other).powers


def _closest(stated: str) -> str:
    """The unit that is written most alike, in words; "" without one."""
    alike = difflib.get_close_matches(stated, [*_UNITS, *_ALONE], n=1)
    return f"; did you mean {alike[0]}?" if alike else ""


def _spelled(stated: str, unit: str) -> str:
    """Spelling that `_unit` reads of a unit as written in an input, without its number.

    ``Nm`` becomes ``N m``, with more behind it, too; where `unit`, the wanted one, is a speed of
    rotation, ``1/min`` becomes ``rpm``.
    """
    if same_dimension(unit, "rpm"):
        return _SPEEDS.get(stated, stated)
    torque = _TORQUE.match(stated)
    return f"{torque[1]} {torque[2]}{stated[torque.end() :]}" if torque else stated


def _accepted(unit: str) -> str:
    """Units of the dimension of `unit` in words, after a colon; "" where none are listed."""
    words = (each for known, each in _ACCEPTED.items() if same_dimension(known, unit))
    return next((f": {each}" for each in words), "")


def _number_and_unit(text: str) -> tuple[Decimal, str] | None:
    """Number and unit text of a quantity such as ``12.5 mm``; a fraction, ``1 3/8 in``, counts as
    one number. None if the text is no quantity.
    """
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
        limit = f"in a known unit, such as {unit}{_accepted(unit)}{_closest(stated)}"
        if re.match(r"[,'][0-9]", stated):
            limit = f"written with a decimal point and without separators, such as 1500.5 {unit}"
        raise InputError(field, text, limit) from None
    if not known:
        raise InputError(field, text, f"in a unit of the dimension of {unit}{_accepted(unit)}")
    try:
        value = float(_to_si(number, stated))
    except (InvalidOperation, OverflowError, ValueError):
        value = float("nan")
    if not isfinite(value):
        raise InputError(field, text, "finite")
    return value


def with_unit(text: str, unit: str) -> str:
    """Text of a quantity as typed; of a number without a unit with `unit`."""
    try:
        float(text)
    except ValueError:
        return text
    return f"{text.strip()} {unit}"


def parse_or_bare(text: str, unit: str, field: str) -> float:
    """SI value of a text with unit, or of a bare number in `unit`; as `parse`."""
    return parse(with_unit(text, unit), unit, field)


@lru_cache(maxsize=512)
def factor(unit: str) -> float:
    """SI value of one `unit`: ``factor("mm")`` is 0.001; not for offset units such as degC."""
    return float(_to_si(Decimal(1), unit))


def format(value: float, unit: str) -> str:  # noqa: A001 - reads as units.format
    """Shortest text with unit that `parse` reads back as exactly `value` (SI)."""
    if not isfinite(value):
        raise InputError("value", value, "finite")
    exact = _from_si(Decimal(value), unit)
    # 18 digits hold any float.
    numbers = (Decimal(f"{exact:.{digits}g}") for digits in range(1, 19))
    shortest = next(n for n in numbers if float(_to_si(n, unit)) == value)
    return f"{_plain(shortest)} {unit}"


def rounded(text: str, digits: int = 4) -> str:
    """Text of a quantity with its number rounded to `digits` significant digits; unchanged where it
    has no more digits, is a fraction or no number.
    """
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
    """Decimal number as text, without an exponent where it stays readable: 24200, 0.0055,
    2.1e-07.
    """
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
