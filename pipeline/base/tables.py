"""Tables of numbers with a unit in each column name, and their CSV files."""

from __future__ import annotations

import csv
import io
import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, readonly
from camwright.geometry.display import Displayed, html_table
from camwright.geometry.errors import ResultError
from camwright.geometry.figures import DrawnAxes
from camwright.pipeline.base import units
from camwright.pipeline.base.columns import Cells, curves, data_frame
from camwright.pipeline.base.files import read_text

if TYPE_CHECKING:
    import pandas as pd

Texts = NDArray[np.str_]
RANGE = ("column", "least", "greatest")
"""Head of the table of a result with columns."""


@dataclass(frozen=True)
class Column:
    """Column of a table: quantity, unit and meaning.

    Parameters
    ----------
    name : str       without unit
    unit : str       in which it is written; empty for a pure number
    meaning : str    in one phrase
    unknown : bool   whether a value may be unknown, NaN: an empty cell
    """

    name: str
    unit: str = ""
    meaning: str = ""
    unknown: bool = False

    @property
    def header(self) -> str:
        """Name with the unit, as in the file."""
        return units.column(self.name, self.unit)


LOAD_CASE = Column("load_case", "", "Load case")
CAM_ANGLE = Column("cam_angle", "deg", "Cam angle")
CRANK_ANGLE = Column("crank_angle", "deg", "Crank angle")

Values = Mapping[Column, Cells]
"""SI values (n,) by column; texts of `LOAD_CASE` alone."""


@dataclass(frozen=True, eq=False, repr=False)
class Table(Displayed):
    """Columns of equal length by header, each in the unit of its header.

    numbers has those of numbers; rows_of is the load case of each row, None in a table of no load
    case.
    """

    numbers: Mapping[str, Array]
    rows_of: Texts | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        """For a worker process: a read-only mapping cannot be pickled."""
        return _restored, (dict(self.numbers), self.rows_of)

    @property
    def columns(self) -> dict[str, Cells]:
        """Read-only columns (n,) by header, the load case first."""
        owners = {} if self.rows_of is None else {LOAD_CASE.header: self.rows_of}
        return {**owners, **self.numbers}

    @property
    def facts(self) -> Mapping[str, object]:
        """Rows, columns and load cases."""
        known = {"rows": len(self), "columns": len(self.columns)}
        return known | ({"load_cases": ", ".join(self.load_cases)} if self.load_cases else {})

    @overload
    def __getitem__(self, header: Literal["load_case"]) -> Texts: ...  # type: ignore[overload-overlap]
    @overload
    def __getitem__(self, header: str) -> Array: ...
    def __getitem__(self, header: str) -> Cells:
        """Values (n,) of a column by its header, in the unit of the header; ResultError where the
        table lacks it.
        """
        if header == LOAD_CASE.header and self.rows_of is not None:
            return self.rows_of
        if header not in self.numbers:
            raise ResultError(f"column {header} is missing; there is {', '.join(self.keys())}")
        return self.numbers[header]

    def __contains__(self, header: str) -> bool:
        return header in self.columns

    def get(self, header: str) -> Array | None:
        """Optional column of numbers; None where the table lacks it."""
        return self.numbers.get(header)

    def __len__(self) -> int:
        return len(next(iter(self.numbers.values()), ()))

    @property
    def load_cases(self) -> tuple[str, ...]:
        """Names of the load cases, in the order of the rows."""
        return () if self.rows_of is None else tuple(dict.fromkeys(self.rows_of.tolist()))

    def of_load_case(self, name: str) -> Table:
        """Rows of one load case; none if it is unknown."""
        owners = np.full(len(self), "") if self.rows_of is None else self.rows_of
        rows = owners == name
        columns = {header: readonly(values[rows]) for header, values in self.numbers.items()}
        return Table(MappingProxyType(columns), _fixed_texts(owners[rows]))

    def keys(self) -> tuple[str, ...]:
        """Headers of the columns."""
        return tuple(self.columns)

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a data frame of pandas, with the headers of the CSV files.

        Raises
        ------
        ResultError
            If pandas is not installed.
        """
        return data_frame(self.columns)

    def plot(self, *headers: str) -> DrawnAxes:
        """Curves of columns over the first column of numbers, one panel each, by load case.

        Parameters
        ----------
        headers : str   one or more of `keys`; without one the first after the angles

        Returns
        -------
        tuple   axes of the panels, in a figure of pyplot

        Raises
        ------
        InputError
            If there is no such column of numbers.
        """
        return curves(self.columns, headers)

    def ranges(self) -> list[tuple[str, str, str]]:
        """Header, least and greatest value of each column in words; see `RANGE`."""
        return [(header, *_range(cells)) for header, cells in self.columns.items()]

    def _repr_html_(self) -> str:
        return html_table(repr(self), RANGE, self.ranges())

    def to_csv(self) -> str:
        """CSV text; every float reads back bit for bit, NaN is an empty cell."""
        cells = {header: _texts(values) for header, values in self.numbers.items()}
        if self.rows_of is not None:
            cells = {LOAD_CASE.header: self.rows_of.tolist(), **cells}
        buffer = io.StringIO()
        writer = csv.writer(buffer, lineterminator="\n")
        writer.writerow(cells)
        writer.writerows(zip(*cells.values(), strict=True))
        return buffer.getvalue()


class Tabled(Displayed, ABC):
    """Base of results with columns, those of their `table`; see `Table`."""

    @property
    @abstractmethod
    def table(self) -> Table:
        """Columns by header."""

    def keys(self) -> tuple[str, ...]:
        """Headers of the columns."""
        return self.table.keys()

    def __getitem__(self, header: str) -> Cells:
        return self.table[header]

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a data frame of pandas; see `Table.to_pandas`."""
        return self.table.to_pandas()

    def plot(self, *headers: str) -> DrawnAxes:
        """Curves of columns, one panel each; see `Table.plot`."""
        return self.table.plot(*headers)

    def _repr_html_(self) -> str:
        return html_table(repr(self), RANGE, self.table.ranges())


def table(values: Values) -> Table:
    """Table from columns of SI values, converted to the unit of each column.

    Parameters
    ----------
    values : mapping   values (n,) by column

    Raises
    ------
    ResultError
        If a header occurs twice, a column is of another length, or holds a NaN that it may not
        hold.
    """
    made: dict[str, Array] = {}
    rows_of: Texts | None = None
    for column, cells in values.items():
        if column.header in made:
            raise ResultError(f"column {column.header} = twice, must be once")
        if column == LOAD_CASE:
            rows_of = _fixed_texts(cells)
        else:
            made[column.header] = _in_unit(column, np.asarray(cells, dtype=float))
    lengths = {header: len(cells) for header, cells in made.items()}
    if rows_of is not None:
        lengths[LOAD_CASE.header] = len(rows_of)
    if len(set(lengths.values())) > 1:
        shown = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ResultError(f"columns of different length: {shown}")
    return Table(MappingProxyType(made), rows_of)


def read_table(path: Path) -> Table:
    """Table of a CSV file: numbers, NaN for an empty cell, texts in the column ``load_case``.

    Raises
    ------
    ResultError
        If the file is unreadable, ragged, or has a cell that is neither a number nor empty.
    """
    rows = list(csv.reader(io.StringIO(read_text(path))))
    if not rows or len(set(rows[0])) != len(rows[0]):
        raise ResultError(f"{path}: no header, or a column twice")
    for line, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise ResultError(f"{path}, line {line}: {len(row)} cells, must be {len(rows[0])}")
    columns = list(zip(*rows[1:], strict=True)) or [()] * len(rows[0])
    cells = dict(zip(rows[0], columns, strict=True))
    owners = cells.pop(LOAD_CASE.header, None)
    numbers = {header: _parsed(path, header, column) for header, column in cells.items()}
    return Table(MappingProxyType(numbers), None if owners is None else _fixed_texts(owners))


def _in_unit(column: Column, values: Array) -> Array:
    """Values of a column from SI in its unit, read-only; ResultError for a NaN that it may not
    hold.
    """
    if values.ndim != 1 or (np.isnan(values).any() and not column.unknown):
        what = "NaN" if values.ndim == 1 else f"{values.ndim} dimensions"
        raise ResultError(f"column {column.header} holds {what}")
    if column.unit:
        values = values / units.factor(column.unit)
    if column in (CAM_ANGLE, CRANK_ANGLE):
        values = np.round(values, 10)  # 0.5, not 0.49999999999999994
    return readonly(values + 0.0)  # no -0.0, which spreadsheets show


def _parsed(path: Path, header: str, cells: Sequence[str]) -> Array:
    """Numbers (n,) of the cells of a column, NaN for an empty one.

    Parameters
    ----------
    path : Path        of the file, for messages
    header : str       of the column, for messages
    cells : sequence   texts of the rows

    Raises
    ------
    ResultError
        With file and line, for a cell that is neither a number nor empty.
    """
    try:
        _require_digits("".join(cells))
        values = np.array([float(cell) if cell else math.nan for cell in cells])
    except ValueError:
        values = np.array([_number(cell) for cell in cells])
    for row in map(int, np.flatnonzero(np.isnan(values))):
        if cell := cells[row]:
            line = row + 2
            raise ResultError(f"{path}, line {line}: {header} = {cell[:40]!r}, must be a number")
    return readonly(values)


def _require_digits(text: str) -> None:
    """Refuse what Python alone takes for a number: digits of other scripts, 1_000."""
    if not text.isascii() or "_" in text:
        raise ValueError


def _number(cell: str) -> float:
    """Number of a cell; NaN if it is no number."""
    try:
        _require_digits(cell)
        return float(cell)
    except ValueError:
        return math.nan


def _restored(columns: dict[str, Array], rows_of: Texts | None) -> Table:
    """A table from another process."""
    read_only = {header: readonly(values) for header, values in columns.items()}
    return Table(MappingProxyType(read_only), None if rows_of is None else _fixed_texts(rows_of))


def _fixed_texts(values: ArrayLike) -> Texts:
    texts = np.array(values, dtype=np.str_)
    texts.setflags(write=False)
    return texts


def _texts(values: Array) -> list[str]:
    return ["" if math.isnan(value) else repr(value) for value in values.tolist()]


def _range(cells: Cells) -> tuple[str, str]:
    """Least and greatest value of a column of numbers as texts, NaN left out, or the first and last
    of texts; "" where none is known.
    """
    if cells.dtype.kind != "f":
        names = cells.tolist()
        return (str(names[0]), str(names[-1])) if names else ("", "")
    known = cells[~np.isnan(cells.astype(float))].astype(float)
    return (f"{known.min():.6g}", f"{known.max():.6g}") if known.size else ("", "")
