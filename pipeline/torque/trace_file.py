"""Parsing of trace files: rows, units in the header, cells as numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from math import pi
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Characters

SIZE_MAX = 64 * 2**20  # bytes; checked before the file is opened
ROWS_MAX = 1_000_000

HeaderText = Annotated[str, Characters(0, 80)]
"""A column's header, what it begins with, or a unit in it."""

ANGLE_UNITS: Mapping[str, float] = MappingProxyType(
    {
        "deg": pi / 180.0,
        "degree": pi / 180.0,
        "degrees": pi / 180.0,
        "°": pi / 180.0,
        "grad": pi / 180.0,
        "gradkw": pi / 180.0,
        "°kw": pi / 180.0,
        "degca": pi / 180.0,
        "°ca": pi / 180.0,
        "cad": pi / 180.0,
        "rad": 1.0,
        "radian": 1.0,
        "radians": 1.0,
        "rev": 2.0 * pi,
    }
)

# Without blanks, dots, stars, dashes and carets; exact case is tried first (mPa, MPa).
QUANTITY_UNITS: Mapping[str, Mapping[str, float]] = MappingProxyType(
    {
        "lift": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "in": 0.0254},
        "travel": {"m": 1.0, "mm": 1e-3, "um": 1e-6, "in": 0.0254},
        "force": {
            "N": 1.0,
            "kN": 1e3,
            "MN": 1e6,
            "kgf": 9.80665,
            "tf": 9806.65,
            "lbf": 4.4482216152605,
        },
        "torque": {
            "Nm": 1.0,
            "kNm": 1e3,
            "mNm": 1e-3,
            "MNm": 1e6,
            "Ncm": 1e-2,
            "Nmm": 1e-3,
            "kgfm": 9.80665,
            "lbfft": 1.3558179483314,
            "ftlbf": 1.3558179483314,
            "lbft": 1.3558179483314,
            "ftlb": 1.3558179483314,
        },
        "pressure": {
            "Pa": 1.0,
            "hPa": 1e2,
            "kPa": 1e3,
            "mPa": 1e-3,
            "MPa": 1e6,
            "mbar": 1e2,
            "bar": 1e5,
            "psi": 6894.757293168,
            "atm": 101325.0,
        },
        "speed": {
            "rad/s": 1.0,
            "rads1": 1.0,
            "rads": 1.0,
            "radpers": 1.0,
            "rpm": pi / 30.0,
            "r/min": pi / 30.0,
            "1/min": pi / 30.0,
            "min1": pi / 30.0,
            "deg/s": pi / 180.0,
            "°/s": pi / 180.0,
        },
        "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9},
        "voltage": {"V": 1.0, "mV": 1e-3},
    }
)

_REMARKS = "#", "sep=", "MARK "
"""Beginnings of lines that are no rows: comments, the separator of a spreadsheet, marks that an
engine control writes into its log."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_UNIT_SPELLING = str.maketrans(dict.fromkeys(" ·⋅*.-^_⁻−", "") | {"¹": "1", "º": "°"})


@dataclass(frozen=True)
class TraceText:
    """Cells of a trace file: header, and rows with their line numbers.

    Parameters
    ----------
    name : str        of the file
    header : list     text of each column's header
    rows : list       line number from 1 and text of each row
    delimiter : str   between the columns
    """

    name: str
    header: list[str]
    rows: list[tuple[int, str]]
    delimiter: str

    @property
    def line_numbers(self) -> list[int]:
        return [number for number, _ in self.rows]

    def cells(self, column: int) -> list[str]:
        """Texts of a column; "" where a row is too short."""
        rows = (_stripped(line, self.delimiter) for _, line in self.rows)
        return [row[column] if column < len(row) else "" for row in rows]

    def numbers(self, columns: Sequence[int], *, gaps: bool = False) -> Array:
        """Cells of some columns, by number, as floats (rows, columns), in the units of the file.

        Parameters
        ----------
        gaps : bool   whether a row with an empty cell in these columns is left out

        Raises
        ------
        InputError
            For a row with too few or too many cells, or a cell that is no finite number.
        """
        header, delimiter = self.header, self.delimiter
        table, row = np.empty((len(self.rows), len(columns))), 0
        for number, line in self.rows:
            cells = _stripped(line, delimiter)
            if len(cells) < len(header) or any(cells[len(header) :]):
                limit = f"{len(header)} as in the header"
                raise InputError(f"{self.name} line {number}", f"{len(cells)} cells", limit)
            if gaps and not all(cells[at] for at in columns):
                continue
            for place, at in enumerate(columns):
                cell = cells[at] if delimiter == "," else cells[at].replace(",", ".")
                if not _NUMBER.fullmatch(cell) or not abs(float(cell)) < np.inf:
                    field = f"{self.name} line {number}, {header[at]}"
                    raise InputError(field, cells[at] or "nothing", "a finite number")
                table[row, place] = float(cell)
            row += 1
        return table[:row]


def trace_text(
    path: Path, example: str, *, headed: bool = True, one_column: bool = False
) -> TraceText:
    """Header and rows of a text file of columns.

    The units may stand in a second line of the header, and the header in a comment above the rows.

    Parameters
    ----------
    path : path         of the file
    example : str       header of such a file, shown in the message where it has none
    headed : bool       whether the first line is a header; without, blanks may separate columns,
                        which are called column 1, column 2, ...
    one_column : bool   whether a file of one column, without any delimiter, is accepted

    Raises
    ------
    InputError
        For a file that is missing, a folder, empty, binary or over 64 MiB, or a header without
        delimiter, or of numbers alone.
    """
    (remark, *lines), name = _text_lines(path), path.name
    if headed and _numeric(lines[0][1]):
        number, first = lines[0]
        if _numeric(remark[1]) or len(_parts(remark[1])) != len(_parts(first)):
            raise InputError(f"{name} line {number}", first, f"a header, such as {example}")
        lines = [remark, *lines]
    delimiter = _delimiter(name, lines, blanks=not headed, one_column=one_column)
    if headed:
        header = _stripped(lines[0][1], delimiter)
        units = _units_below(header, _stripped(lines[1][1], delimiter)) if len(lines) > 1 else []
        named = [
            f"{text} [{unit}]" if unit else text
            for text, unit in zip_longest(header, units, fillvalue="")
        ]
        return TraceText(name, named, lines[2:] if units else lines[1:], delimiter)
    rows = [(number, line.rstrip(f"{delimiter} ")) for number, line in lines]
    count = len(_cells(rows[0][1], delimiter))
    return TraceText(name, [f"column {at + 1}" for at in range(count)], rows, delimiter)


def _units_below(header: Sequence[str], second: Sequence[str]) -> list[str]:
    """Units of the columns of a file from the second line of its header; empty if that line is none
    of units.

    Parameters
    ----------
    header : sequence   cells of the first line
    second : sequence   cells of the second line
    """
    units = [re.sub(r"^[\[({](.*)[\])}]$", r"\1", cell) for cell in second]
    known = ANGLE_UNITS, *QUANTITY_UNITS.values()
    if len(units) != len(header) or any(_is_number(unit) for unit in units):
        return []
    seen = (unit_factor(f"[{unit}]", each) for unit in units for each in known)
    return units if any(factor is not None for factor in seen) else []


def _stripped(line: str, delimiter: str) -> list[str]:
    return [cell.strip() for cell in _cells(line, delimiter)]


def _parts(line: str) -> list[str]:
    """Texts between delimiters of any kind."""
    return [part for part in re.split(r"[;\t, ]+", line) if part]


def _numeric(line: str) -> bool:
    """Whether a line holds numbers alone."""
    return all(_is_number(part) for part in _parts(line))


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell.strip(' "').replace(",", ".")))


def _delimiter(
    name: str, lines: Sequence[tuple[int, str]], *, blanks: bool, one_column: bool
) -> str:
    """Character that separates the columns of a file: the first of semicolon, tab and comma that is
    in the header.

    Parameters
    ----------
    name : str          of the file, for the message
    lines : sequence    (number, text) of each line, that of the header first
    blanks : bool       whether blanks separate the columns where none of the three is in the header
    one_column : bool   whether a file of one column is accepted; then ";", as a decimal comma is no
                        delimiter

    Raises
    ------
    InputError
        If nothing separates columns.
    """
    number, head = lines[0]
    for mark in ";\t,":
        if mark in head:
            return mark
    if blanks:
        return " "
    if one_column and not any("," in line for _, line in lines[1:2]):
        return ";"  # a decimal comma is no delimiter
    limit = "a header of columns separated by semicolon, tab or comma"
    raise InputError(f"{name} line {number}", head, limit)


def _text_lines(path: Path) -> list[tuple[int, str]]:
    """Lines of a text file with their numbers from 1, without empty lines and comments; before them
    the last comment above the first one, which may be a header ("" without one).
    """
    raw = _bytes(path)
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raw = raw.decode("utf-16", errors="replace").encode()
    if b"\0" in raw:
        raise InputError(path.name, "a binary file", "text of columns")
    count = raw.count(b"\n")
    if count > ROWS_MAX:
        raise InputError(path.name, f"{count} lines", f"{ROWS_MAX} lines or fewer")
    lines = [(0, "")]
    for number, coded in enumerate(raw.removeprefix(b"\xef\xbb\xbf").splitlines(), start=1):
        line = _decoded(coded).strip(" ")
        if line.strip() and not line.lstrip('"').startswith(_REMARKS):
            lines.append((number, line))
        elif len(lines) == 1 and line.startswith("#"):
            lines = [(number, line.strip("# "))]
    if len(lines) == 1:
        raise InputError(path.name, "an empty file", "a header and rows")
    return lines


def _bytes(path: Path) -> bytes:
    """Content of a file; InputError for a path that is no regular file, cannot be read or is above
    `SIZE_MAX`, which is not read.
    """
    try:
        if path.is_dir():
            raise InputError(path.name, "a folder", "a file")
        if not path.exists():
            raise InputError(path.name, "no such file", "an existing file")
        if not path.is_file():
            raise InputError(path.name, "no regular file", "a regular file")
        size = path.stat().st_size
        if size <= SIZE_MAX:
            with path.open("rb") as stream:
                raw = stream.read(SIZE_MAX + 1)
            size = max(size, len(raw))
    except OSError as error:
        raise InputError(path.name, error.strerror or "unreadable", "a readable file") from error
    if size > SIZE_MAX:
        limit = f"{SIZE_MAX / 2**20:.0f} MiB or less"
        raise InputError(path.name, f"{size / 2**20:.1f} MiB", limit)
    return raw


def _decoded(coded: bytes) -> str:
    """One line as UTF-8, else as Latin-1: a file may mix the two."""
    try:
        return coded.decode("utf-8")
    except UnicodeDecodeError:
        return coded.decode("latin-1")


def _cells(line: str, delimiter: str) -> list[str]:
    if '"' not in line or len(line) >= csv.field_size_limit():
        return line.split(delimiter)
    return next(csv.reader([line], delimiter=delimiter))


def unit_factor(header: str, units: Mapping[str, float]) -> float | None:
    """Factor to SI of the unit at the end of the header of a column; None where it ends with none.

    The unit is the text in its brackets, else the shortest ending that is a unit, so that `M_Nm` is
    a moment in N m. Upper and lower case count only where a unit would else be ambiguous.

    Parameters
    ----------
    header : str      of a column, as "torque [Nm]"
    units : mapping   factor to SI by unit
    """
    bracketed = re.search(r"[\[({](.*)[\])}]\s*$", header)
    if bracketed:
        endings = [bracketed.group(1)]
    else:
        starts = [0, *(match.end() for match in re.finditer(r"[\s_/:]+", header))]
        endings = [header[start:] for start in reversed(starts)]
    for ending in endings:
        unit = ending.translate(_UNIT_SPELLING)
        if unit in units:
            return units[unit]
        alike = {factor for known, factor in units.items() if known.lower() == unit.lower()}
        if len(alike) == 1:
            return alike.pop()
    return None


def has_unit(header: str) -> bool:
    """Whether the header of a column names a unit beside its quantity, as ``torque_Nm`` or ``angle
    [deg]``; a header of one word, such as ``n`` or ``deg``, is a name alone.
    """
    known = ANGLE_UNITS, *QUANTITY_UNITS.values()
    separator = re.search(r"[\s_/:\[({]", header)
    return separator is not None and any(unit_factor(header, units) is not None for units in known)


def columns_of(header: Sequence[str], quantity: str, column: str = "") -> dict[int, float]:
    """Columns of a quantity, restricted to the name `column` if stated; factors to SI."""
    factors = _with_unit(header, QUANTITY_UNITS[quantity])
    return {at: factors[at] for at in named_columns(header, column, factors)}


def named_columns(header: Sequence[str], column: str, among: Iterable[int]) -> list[int]:
    """Columns whose header equals `column` but for its unit, else begins with it."""
    wanted, places = column.lower(), list(among)
    exact = [at for at in places if wanted in {(name := header[at].lower()), without_unit(name)}]
    return exact or [at for at in places if header[at].lower().startswith(wanted)]


def numbered_columns(field: str, column: str, count: int) -> list[int]:
    """Zero-based columns of a file without a header, by numbers such as `2` or `2 to 9`.

    Without any all but the first.

    Parameters
    ----------
    field : str    names the file in messages
    count : int    columns of the file, the first of them the angle

    Raises
    ------
    InputError
        If there are no such columns.
    """
    named = re.fullmatch(r"(?:column )?(\d{1,6})(?: ?(?:to|-) ?(\d{1,6}))?", column)
    first, last = (int(each or named[1]) for each in named.groups()) if named else (0, 0)
    if not column:
        first, last = 2, count
    if not 2 <= first <= last <= count:
        raise InputError("engine.column", column or "missing", _numbers_of(field, count))
    return list(range(first - 1, last))


def _numbers_of(field: str, count: int) -> str:
    return f'the number of a column of {field}, from 2 to {count}, or of several as "2 to {count}"'


def is_series(labels: Iterable[str]) -> bool:
    """Whether headers differ by numbers alone."""
    return len({re.sub(r"\d+", "", label) for label in labels}) < 2


def require_alike(
    name: str, labels: Sequence[str], values: Array, limit: float, *, headed: bool = True
) -> None:
    """Refuse several columns of one quantity that are no repeated runs, where none is named.

    Parameters
    ----------
    name : str             of the file
    labels : sequence      headers (m,)
    values : array (m, n)  over the same angles
    limit : float          greatest rms difference from the greatest column, over its rms; headers
                           alike but for numbers are those of runs in any case
    headed : bool          whether the file has a header, else its columns have numbers alone

    Raises
    ------
    InputError
        By the headers of two columns.
    """
    sizes = np.linalg.norm(values, axis=1)
    first = int(sizes.argmax())
    unlike = np.linalg.norm(values - values[first], axis=1) > limit * sizes[first]
    if unlike.any() and not (headed and is_series(labels)):
        other = labels[int(unlike.argmax())]
        must = f"the beginning of the headers to read in {name}"
        if not headed:
            must = _numbers_of(name, len(labels) + 1)
        must += f": {labels[first]} is unlike {other}"
        raise InputError("engine.column", "missing", must)


def without_unit(header: str) -> str:
    """Header without its bracketed unit."""
    return re.sub(r"\s*[\[({][^\[({]*[\])}]\s*$", "", header)


def has_angle(header: Sequence[str]) -> bool:
    """Whether a column has an angular unit."""
    return bool(_with_unit(header, ANGLE_UNITS))


def _with_unit(header: Sequence[str], units: Mapping[str, float]) -> dict[int, float]:
    """Columns whose header ends with one of the units, and their factors to SI."""
    factors = {at: unit_factor(text, units) for at, text in enumerate(header)}
    return {at: factor for at, factor in factors.items() if factor is not None}


def angle_column(
    name: str, header: Sequence[str], part: Literal["crank", "cam"] = "crank"
) -> tuple[int, float]:
    """Index of the column of the angle of crank or cam in a file, and the factor from its unit to
    rad.

    Parameters
    ----------
    name : str          of the file, for the message
    header : sequence   of each column
    part : str          "crank" or "cam"

    Raises
    ------
    InputError
        If there is not one such column.
    """
    factors = _with_unit(header, ANGLE_UNITS)
    columns = list(factors)
    if len(columns) > 1 or part == "cam":
        columns = [at for at in columns if part in header[at].lower()] or columns
    if part == "cam":
        columns = [at for at in columns if "crank" not in header[at].lower()]
    if len(columns) != 1:
        which = "cam angle" if part == "cam" else "angle"
        limit = f"one column of {which} with its unit (deg, rad or rev)"
        raise InputError(f"{name} header", ", ".join(header), limit)
    return columns[0], factors[columns[0]]


def value_column(
    name: str, header: Sequence[str], quantity: str, column: str | None
) -> tuple[int, float]:
    """Index of the column of a quantity in a file, and the factor from its unit to SI.

    Parameters
    ----------
    name : str             of the file, for the message
    header : sequence      of each column
    quantity : str         key of `QUANTITY_UNITS`, such as "torque"
    column : str or None   beginning of the header; None: the only column of the quantity

    Raises
    ------
    InputError
        If there is not one such column.
    """
    factors = _with_unit(header, QUANTITY_UNITS[quantity])
    columns = list(factors)
    if column is not None:
        columns = named_columns(header, column, columns)
    for word in (quantity, "total"):
        if len(columns) > 1:
            columns = [at for at in columns if word in header[at].lower()] or columns
    if len(columns) > 1 and column is None:
        limit = f"one column of {quantity}, or column = the beginning of its header"
        raise InputError(f"{name} header", ", ".join(header), limit)
    if len(columns) != 1:
        wanted = f"one column of {column or quantity}"
        limit = f"{wanted} with its unit ({', '.join(QUANTITY_UNITS[quantity])})"
        raise InputError(f"{name} header", ", ".join(header), limit)
    return columns[0], factors[columns[0]]
