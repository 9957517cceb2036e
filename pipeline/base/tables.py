"""Tables of numbers with a unit in each column name, and their CSV files."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.errors import ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import read_text


@dataclass(frozen=True)
class Column:
    """A table column: its name without unit, the unit it is written in."""

    name: str
    unit: str = ""
    optional: bool = False
    may_be_unknown: bool = False

    @property
    def header(self) -> str:
        return units.column(self.name, self.unit)


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of one length by header; numbers as written, in the unit their name carries."""

    columns: Mapping[str, NDArray[Any]]

    def __getitem__(self, header: str) -> Any:
        if header not in self.columns:
            raise ResultError(f"column {header} is missing; there is {', '.join(self.columns)}")
        return self.columns[header]

    def __contains__(self, header: object) -> bool:
        return header in self.columns

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def where(self, header: str, value: object) -> Table:
        """The rows in which a column has a value."""
        rows = self[header] == value
        return Table(MappingProxyType({name: _fixed(c[rows]) for name, c in self.columns.items()}))

    def to_csv(self) -> str:
        """CSV text; every float reads back bit for bit."""
        buffer = io.StringIO()
        writer = csv.writer(buffer, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(zip(*(_texts(column) for column in self.columns.values()), strict=True))
        return buffer.getvalue()


def table(columns: Iterable[Column], values: Mapping[str, ArrayLike]) -> Table:
    """A table from SI values by bare column name, turned into the unit of each column.

    Raises
    ------
    ResultError
        If a column is not given, unknown, of another length, or holds a NaN it may not hold.
    """
    columns = tuple(columns)
    unknown = set(values) - {column.name for column in columns}
    if unknown:
        raise ResultError(f"no such column: {', '.join(sorted(unknown))}")
    made: dict[str, NDArray[Any]] = {}
    for column in columns:
        if column.name not in values:
            if column.optional:
                continue
            raise ResultError(f"column {column.header} was not given")
        made[column.header] = _in_unit(column, np.asarray(values[column.name]))
    if len({len(given) for given in made.values()}) > 1:
        lengths = ", ".join(f"{name} {len(given)}" for name, given in made.items())
        raise ResultError(f"columns of different length: {lengths}")
    return Table(MappingProxyType(made))


def read_table(path: Path, columns: Iterable[Column] = ()) -> Table:
    """A CSV table; a column is of floats unless it is ``load_case``.

    Parameters
    ----------
    columns : Column   the layout: cells of a column that `may_be_unknown` may be empty (NaN)

    Raises
    ------
    ResultError
        If the file is unreadable, ragged, or has a cell that is no number.
    """
    unknown = {column.header for column in columns if column.may_be_unknown}
    rows = list(csv.reader(io.StringIO(read_text(path))))
    if not rows or len(set(rows[0])) != len(rows[0]):
        raise ResultError(f"{path}: no header, or a column twice")
    for line, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise ResultError(f"{path}, line {line}: {len(row)} cells, must be {len(rows[0])}")
    cells = list(zip(*rows[1:], strict=True)) or [()] * len(rows[0])
    return Table(
        MappingProxyType(
            {
                name: _parsed(path, name, cells[k], name in unknown)
                for k, name in enumerate(rows[0])
            },
        )
    )


def _in_unit(column: Column, given: NDArray[Any]) -> NDArray[Any]:
    if given.dtype.kind in "US":
        return _fixed(given.astype(str))
    values = given.astype(float)
    if values.ndim != 1 or (np.isnan(values).any() and not column.may_be_unknown):
        what = "NaN" if values.ndim == 1 else f"{values.ndim} dimensions"
        raise ResultError(f"column {column.header} holds {what}")
    if column.unit:
        values = values / units.factor(column.unit)
    if column.name in ("cam_angle", "crank_angle"):
        values = np.round(values, 10)  # 0.5, not 0.49999999999999994
    return _fixed(values)


def _parsed(path: Path, name: str, cells: Iterable[str], may_be_unknown: bool) -> NDArray[Any]:
    if name == "load_case":
        return _fixed(np.array(list(cells), dtype=str))
    values: list[float] = []
    for line, cell in enumerate(cells, start=2):
        if cell == "" and may_be_unknown:
            values.append(math.nan)
            continue
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if math.isnan(value):
            raise ResultError(f"{path}, line {line}: {name} = {cell[:40]!r}, must be a number")
        values.append(value)
    return _fixed(np.array(values))


def _fixed(values: NDArray[Any]) -> NDArray[Any]:
    values.setflags(write=False)
    return values


def _texts(column: NDArray[Any]) -> Iterable[str]:
    if column.dtype.kind == "U":
        return column.tolist()
    return ("" if math.isnan(value) else repr(value) for value in column.tolist())
