"""Text of a trace file: lines, units in the header, cells as numbers."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_UNIT_SPELLING = str.maketrans(dict.fromkeys(" ·⋅*.-^_⁻−", "") | {"¹": "1", "º": "°"})


@dataclass(frozen=True)
class TraceText:
    """Text of a trace file: header cells, and rows with their line numbers.

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

    def numbers(self, columns: Sequence[int], *, gaps: bool = False) -> Array:
        """Cells of some columns as numbers, (rows, columns).

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
            cells = [cell.strip() for cell in _cells(line, delimiter)]
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


def trace_text(path: Path, *, headed: bool = True, one_column: bool = False) -> TraceText:
    """Text of a trace file.

    Parameters
    ----------
    headed : bool       whether the first line is a header; without, blanks may separate columns
    one_column : bool   whether a file of one column, without any delimiter, is accepted

    Raises
    ------
    InputError
        For a file that is missing, a folder, empty, binary or over 64 MiB, or a header without
        delimiter.
    """
    lines, name = _text_lines(path), path.name
    delimiter = _delimiter(name, lines, blanks=not headed, one_column=one_column)
    if headed:
        header = [cell.strip() for cell in _cells(lines[0][1], delimiter)]
        return TraceText(name, header, lines[1:], delimiter)
    rows = [(number, line.rstrip(f"{delimiter} ")) for number, line in lines]
    count = len(_cells(rows[0][1], delimiter))
    return TraceText(name, [f"column {at + 1}" for at in range(count)], rows, delimiter)


def _delimiter(
    name: str, lines: Sequence[tuple[int, str]], *, blanks: bool, one_column: bool
) -> str:
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
    """Lines of a text file with their numbers from 1, without empty lines and comments."""
    raw = _bytes(path)
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        raw = raw.decode("utf-16", errors="replace").encode()
    if b"\0" in raw:
        raise InputError(path.name, "a binary file", "text of columns")
    count = raw.count(b"\n")
    if count > ROWS_MAX:
        raise InputError(path.name, f"{count} lines", f"{ROWS_MAX} lines or fewer")
    lines = []
    for number, coded in enumerate(raw.removeprefix(b"\xef\xbb\xbf").splitlines(), start=1):
        line = _decoded(coded).strip(" ")
        if line.strip() and not line.lstrip('"').startswith(("#", "sep=")):
            lines.append((number, line))
    if not lines:
        raise InputError(path.name, "an empty file", "a header and rows")
    return lines


def _bytes(path: Path) -> bytes:
    """Bytes of a file; one that is no file or too large is refused unread."""
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


def _unit(header: str, units: Mapping[str, float]) -> float | None:
    """Factor to SI of the unit at the end of a header: the text in its brackets, else the shortest
    ending that is a unit, so that `M_Nm` is a moment in N m."""
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


def columns_of(header: Sequence[str], quantity: str, prefix: str = "") -> dict[int, float]:
    """Columns of a quantity whose header begins with `prefix`, and their factors to SI."""
    factors = _with_unit(header, QUANTITY_UNITS[quantity])
    return {at: f for at, f in factors.items() if header[at].lower().startswith(prefix.lower())}


def has_angle(header: Sequence[str]) -> bool:
    """Whether a column has a unit of angle."""
    return bool(_with_unit(header, ANGLE_UNITS))


def _with_unit(header: Sequence[str], units: Mapping[str, float]) -> dict[int, float]:
    """Columns whose header ends with one of the units, and their factors to SI."""
    factors = {at: _unit(text, units) for at, text in enumerate(header)}
    return {at: factor for at, factor in factors.items() if factor is not None}


def angle_column(
    name: str, header: Sequence[str], part: Literal["crank", "cam"] = "crank"
) -> tuple[int, float]:
    """Column of the angle of a part, and its factor to rad; of the cam none of the crank."""
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
    """Column of a quantity and its factor to SI."""
    factors = _with_unit(header, QUANTITY_UNITS[quantity])
    columns = list(factors)
    if column is not None:
        columns = [at for at in columns if header[at].lower().startswith(column.lower())]
        columns = [at for at in columns if header[at] == column] or columns
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
