"""Dataset of a study: columns with unit and meaning, shards, table of all rows.

One row per design. A column that no row of the study has is left out; a value that a design does
not have is null.
"""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.store import Format
from camwright.pipeline.base.tables import Column

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.parquet as pq

# Read when Arrow is imported. Its own allocator keeps what is released: a twentieth of the memory
# of a study.
os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")

STUDY, SUMMARY, DATASET = "study.toml", "study.json", "dataset.parquet"
ANSWERS, PAGE = "answers.json", "study.html"
SHARDS, TIMINGS, RUNS, CASES = "shards", "timings", "runs", "cases"
FILES: Mapping[str, str] = {
    STUDY: "copy of the study file",
    f"{CASES}/": "copies of the case files, with the files that they include",
    SUMMARY: "counts by depth, `screen` and verdict, messages, versions, hashes; no clock figure",
    DATASET: "all rows in the order of the designs",
    ANSWERS: "yield, failures, effects of the factors, front, extremes",
    PAGE: "the answers as a page, with the designs",
    f"{SHARDS}/<hash>.parquet": "rows of one task, by the hash of its contents; without `design`",
    f"{TIMINGS}/<hash>.parquet": "clock figures of the rows of a shard: `id`, `depth`, `wall_s`",
    f"{RUNS}/<id>/": "run folder of a design that `keep` names",
}
"""Files of a study folder."""

DESIGN = Column("design", "", "Number of the design, from 0, in the order of the sampling")
ID = Column("id", "", "Content hash of case and factors; equal designs have one id")
DEPTH = Column("depth", "", "Depth of the row: screening, preview, cycle or certified")
SCREEN = Column("screen", "", "fail: an evaluated must-have fails; open: none; error: no result")
VERDICT = Column("verdict", "", "pass, incomplete or fail; null below certified")
GOVERNING = Column("governing", "", "Must-have check of the greatest utilisation, without evidence")
MESSAGE = Column("message", "", "Reason of a design without result; else null")
FIXED: tuple[Column, ...] = (DESIGN, ID, DEPTH, SCREEN, VERDICT, GOVERNING, MESSAGE)
"""Columns of every dataset, in their order."""
_TEXTS = frozenset(each.name for each in FIXED if each is not DESIGN)

FACTOR, HEADLINE, MESH = "factor.", "headline.", "mesh."
FIGURES: Mapping[str, str] = {
    "demand": "Worst demand, tolerance corners included",
    "limit": "Limit",
    "utilisation": "Demand over limit, or limit over demand for a minimum; null if infinite",
    "status": "pass, fail, not_evaluated or waived",
    "error": "Half of the error bar of the nominal demand",
}
"""Columns of each check, ``ID.FIGURE``."""
STATUS = ".status"
_SUFFIXES = (
    ("_J_per_cam_turn", "J"), ("_Nm", "N m"), ("_MPa", "MPa"), ("_percent", "%"), ("_mm", "mm"),
    ("_deg", "deg"), ("_N", "N"),
)  # fmt: skip

Values = NDArray[np.float64] | Sequence[float | str | None]
Rows = Mapping[str, Values]
"""Values (n,) by column name, in the unit of the column."""


def is_text(name: str, units: Mapping[str, str | None]) -> bool:
    """Whether a column holds text; `units`: see `column_of`."""
    if name.startswith(FACTOR):
        return units.get(name.removeprefix(FACTOR), "") is None
    return name in _TEXTS or name.endswith(STATUS)


def column_of(name: str, units: Mapping[str, str | None]) -> Column:
    """Unit and meaning of a column of the dataset.

    Parameters
    ----------
    name : str        of the column
    units : mapping   unit of each factor by dotted key; None: its values are text

    Raises
    ------
    ResultError
        If no dataset has such a column.
    """
    fixed = {each.name: each for each in FIXED}
    if name in fixed:
        return fixed[name]
    if name.startswith(FACTOR):
        key = name.removeprefix(FACTOR)
        return Column(name, units.get(key) or "", f"Factor {key}")
    if name.startswith((HEADLINE, MESH)):
        kind, _, key = name.partition(".")
        unit = next((unit for suffix, unit in _SUFFIXES if key.endswith(suffix)), "")
        words = "Headline of run.json" if kind == "headline" else "Mesh at the greatest pressure"
        return Column(name, unit, f"{words}: {key}")
    check, _, figure = name.rpartition(".")
    declared = _checks().get(check)
    if declared is None or figure not in FIGURES:
        raise ResultError(f"column {name} is unknown")
    title, unit = declared
    unit = "" if figure in ("utilisation", "status") or unit == "-" else unit
    return Column(name, unit, f"{title}: {FIGURES[figure]}")


@cache
def _checks() -> Mapping[str, tuple[str, str]]:
    """Title and unit of each check by id, in the order of the registry."""
    from camwright.pipeline.checks.registry import DECLARED

    known = DECLARED.values()
    return {each.id: (each.title.format(follower="follower"), each.unit) for each in known}


def in_order(names: Sequence[str]) -> list[str]:
    """Column names in dataset order: fixed, factors, headline, mesh, checks."""
    fixed = [each.name for each in FIXED]
    checks = {check: place for place, check in enumerate(_checks())}
    figures = list(FIGURES)

    def place(name: str) -> tuple[int, int, int, str]:
        if name in fixed:
            return 0, fixed.index(name), 0, ""
        for rank, prefix in enumerate((FACTOR, HEADLINE, MESH), start=1):
            if name.startswith(prefix):
                return rank, 0, 0, "" if prefix == FACTOR else name
        check, _, figure = name.rpartition(".")
        return 4, checks[check], figures.index(figure), ""

    return sorted(dict.fromkeys(names), key=place)  # stable: factors as in the study file


def table_of(rows: Rows, units: Mapping[str, str | None]) -> pa.Table:
    """Arrow table of rows: columns in dataset order, unit and meaning in the metadata of the
    fields.

    Columns without a value are left out, except fixed ones and factors; NaN and infinity become
    null.

    Parameters
    ----------
    rows : mapping    values of all rows by name of column
    units : mapping   unit of each factor by dotted key; None: its values are text
    """
    import pyarrow as pa

    fields, arrays = [], []
    always = {each.name for each in FIXED}
    for name in in_order(list(rows)):
        values, column = rows[name], column_of(name, units)
        if is_text(name, units):
            array = _texts(["" if each is None else str(each) for each in values])
        elif name == DESIGN.name:
            array = whole_numbers(np.asarray(values))
        else:
            array = _numbers(np.array([np.nan if v is None else v for v in values], dtype=float))
        if array.null_count == len(array) and name not in always and not name.startswith(FACTOR):
            continue
        metadata = {"unit": column.unit, "meaning": column.meaning}
        fields.append(pa.field(name, array.type, metadata=metadata))
        arrays.append(array)
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields))


# `pyarrow.array` imports pandas, half a second in each process: arrays are made of their buffers.


def whole_numbers(values: NDArray[np.integer[Any]]) -> pa.Array:
    """Arrow array (n,) of integers."""
    import pyarrow as pa

    whole = np.ascontiguousarray(values, dtype=np.int64)
    return pa.Array.from_buffers(pa.int64(), whole.size, [None, pa.py_buffer(whole)])


def _numbers(values: NDArray[np.float64]) -> pa.Array:
    """Arrow array (n,) of floats; NaN and infinity become null."""
    import pyarrow as pa

    numbers = np.ascontiguousarray(values, dtype=float)
    buffers = [_validity(np.isfinite(numbers)), pa.py_buffer(numbers)]
    return pa.Array.from_buffers(pa.float64(), numbers.size, buffers)


def _texts(values: Sequence[str]) -> pa.Array:
    """Arrow array (n,) of texts; empty ones become null."""
    import pyarrow as pa

    parts = [each.encode() for each in values]
    ends = np.cumsum([0, *(len(each) for each in parts)], dtype=np.int32)
    known = np.array([bool(each) for each in parts], dtype=bool)
    buffers = [_validity(known), pa.py_buffer(ends), pa.py_buffer(b"".join(parts))]
    return pa.Array.from_buffers(pa.string(), len(parts), buffers)


def _validity(known: NDArray[np.bool_]) -> pa.Buffer | None:
    """Bits of the values that are not null; None: all are not."""
    import pyarrow as pa

    return None if known.all() else pa.py_buffer(np.packbits(known, bitorder="little"))


def parquet_bytes(table: pa.Table) -> bytes:
    """Parquet file of a table; equal rows give equal bytes."""
    import pyarrow.parquet as pq

    buffer = io.BytesIO()
    pq.write_table(table, buffer, **WRITING)
    return buffer.getvalue()


# A shard has few rows and hundreds of columns: a dictionary or Zstandard, begun anew for each
# column, takes four times as long and saves nothing.
WRITING: Mapping[str, Any] = {
    "compression": "lz4", "use_dictionary": False, "store_schema": True,
    "write_statistics": False, "write_page_checksum": True,
}  # fmt: skip


def timings_of(rows: Rows, walls: Sequence[float]) -> pa.Table:
    """Clock figures of a shard's rows: id, depth, wall time, s."""
    import pyarrow as pa

    texts = {each: _texts([str(value) for value in rows[each]]) for each in (ID.name, DEPTH.name)}
    return pa.table({**texts, "wall_s": _numbers(np.asarray(walls, dtype=float))})


def joined(tables: Sequence[pa.Table]) -> pa.Table:
    """Tables of one dataset concatenated, with the union of their columns in order."""
    import pyarrow as pa

    fields = {field.name: field for table in tables for field in table.schema}
    schema = pa.schema(fields[name] for name in in_order(list(fields)))
    return pa.concat_tables(tables, promote_options="default").select(schema.names).cast(schema)


def table_from(content: bytes) -> pa.Table:
    """Arrow table from the bytes of a Parquet file; ValueError for more rows than a study
    may have.
    """
    import pyarrow.parquet as pq

    from camwright.pipeline.studies.batch.study_file import DESIGNS_MAX

    # `read_table` imports the reader of folders, and with it pandas
    with pq.ParquetFile(io.BytesIO(content), page_checksum_verification=True) as file:
        if file.metadata.num_rows > DESIGNS_MAX:
            raise ValueError(f"claims {file.metadata.num_rows} rows")
        return file.read()


def read_parquet(path: Path) -> pa.Table:
    """Table read from a Parquet file.

    Raises
    ------
    ResultError
        If it is none, or damaged.
    """
    import pyarrow as pa

    try:
        return table_from(path.read_bytes())
    except (OSError, ValueError, pa.ArrowException) as error:
        raise ResultError(f"{path}: {' '.join(str(error).split())[:200]}") from None


TABLE: Format[pa.Table] = Format(".parquet", parquet_bytes, read_parquet)
"""Tables as the files of a store."""


def require_columns(table: pa.Table, fixed: Sequence[Column], path: Path) -> None:
    """Refuse an Arrow table that is not of a study.

    Parameters
    ----------
    table : Table      read from a file
    fixed : sequence   columns that it must have
    path : Path        of the file, for messages

    Raises
    ------
    ResultError
        If one of `fixed` is missing, a column is unknown, or it holds values of another type.
    """
    import pyarrow as pa

    for each in fixed:
        if each.name not in table.column_names:
            raise ResultError(f"{path}: column {each.name} is missing")
    if len(set(table.column_names)) < len(table.column_names):
        raise ResultError(f"{path}: two columns have one name")
    for field in table.schema:
        column_of(field.name, {})
        text, number = pa.types.is_string(field.type), pa.types.is_float64(field.type)
        if field.name == DESIGN.name:
            fits = pa.types.is_int64(field.type) and not table[field.name].null_count
        elif field.name.startswith(FACTOR):
            fits = text or number
        else:
            fits = text if is_text(field.name, {}) else number
        if not fits:
            raise ResultError(f"{path}: column {field.name} holds {field.type}")
    try:
        table.validate(full=True)
    except pa.ArrowException as error:
        raise ResultError(f"{path}: {' '.join(str(error).split())[:200]}") from None


@dataclass(frozen=True, eq=False)
class Dataset:
    """Columns of a dataset: numbers (n,) with NaN for null, texts (n,) with "" for null.

    Parameters
    ----------
    columns : mapping   values by column name, in the order of the file; those of a file are read
                        at each use, so that a dataset is never whole in memory
    units : mapping     unit by column name; "": pure number or text
    meanings : mapping  meaning by column name
    """

    columns: Mapping[str, NDArray[Any]]
    units: Mapping[str, str]
    meanings: Mapping[str, str]

    def __len__(self) -> int:
        return len(self.columns[DESIGN.name])

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self.columns:
            raise ResultError(f"column {name} is missing; there is {', '.join(self.columns)}")
        return self.columns[name]

    @property
    def factors(self) -> tuple[str, ...]:
        """Dotted keys of the factors, in the order of the study file."""
        return tuple(name.removeprefix(FACTOR) for name in self.columns if name.startswith(FACTOR))

    @property
    def checks(self) -> tuple[str, ...]:
        """Ids of the checks with a status, in the order of the registry."""
        return tuple(name.removesuffix(STATUS) for name in self.columns if name.endswith(STATUS))


class _StoredColumns(Mapping[str, NDArray[Any]]):
    """Columns of a Parquet file, each read when it is used."""

    def __init__(self, file: pq.ParquetFile) -> None:
        self._file, self._names = file, tuple(file.schema_arrow.names)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return values_of(self._file.read(columns=[name]).column(0))

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def read_dataset(folder: Path) -> Dataset:
    """Dataset of a study folder.

    Raises
    ------
    ResultError
        If the folder has none, or it is damaged, or no dataset of a study.
    """
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = folder / DATASET
    try:
        file = pq.ParquetFile(path, page_checksum_verification=True)
        require_columns(file.read_row_groups([]), FIXED, path)
        for group in range(file.num_row_groups):
            require_columns(file.read_row_group(group), FIXED, path)
    except (OSError, ValueError, pa.ArrowException) as error:
        raise ResultError(f"{path}: {' '.join(str(error).split())[:200]}") from None
    units: dict[str, str] = {}
    meanings: dict[str, str] = {}
    for field in file.schema_arrow:
        marks = {
            key.decode("utf-8", "replace"): text.decode("utf-8", "replace")
            for key, text in (field.metadata or {}).items()
        }
        units[field.name], meanings[field.name] = marks.get("unit", ""), marks.get("meaning", "")
    return Dataset(_StoredColumns(file), units, meanings)


def values_of(column: pa.ChunkedArray) -> NDArray[Any]:
    """Values (n,) of an Arrow column: numbers with NaN for null, texts with "" for null."""
    import pyarrow as pa

    if pa.types.is_string(column.type):
        return np.array([each or "" for each in column.to_pylist()], dtype=np.str_)
    kind = np.dtype(np.int64 if pa.types.is_int64(column.type) else np.float64)
    parts = [np.empty(0, dtype=kind)]
    # `to_numpy` and `fill_null` import pandas
    for chunk in column.chunks:
        valid, buffer = chunk.buffers()
        part = slice(chunk.offset, chunk.offset + len(chunk))
        numbers = np.frombuffer(buffer or b"", dtype=kind)[part]
        if chunk.null_count:
            known = np.unpackbits(np.frombuffer(valid, np.uint8), bitorder="little")[part]
            numbers = np.where(known, numbers, np.nan)
        parts.append(numbers)
    return np.concatenate(parts)
