"""Spreadsheets of CSV tables, rounded and ready to print, for office programs."""

from __future__ import annotations

import datetime as dt
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.base.tables import LOAD_CASE, Table, read_table

if TYPE_CHECKING:
    from xlsxwriter import Workbook
    from xlsxwriter.format import Format

SUFFIX = ".xlsx"
DECIMALS = {"_mm": 4, "_deg": 3}
"""Decimals of lengths and angles by the end of the header; others have `DIGITS` digits."""
DIGITS = 6
_A4 = 9  # code of the paper
_CREATED = dt.datetime(1980, 1, 1, tzinfo=dt.UTC)  # not the clock: equal tables, equal bytes
_OPTIONS = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False}


@dataclass(frozen=True)
class Excerpt:
    """Rows of a table for one printed page: every `step` deg of a column.

    beside : mapping   files in the folder of the table by the titles of their sheets, if they are
    """

    title: str
    column: str
    step: float
    beside: Mapping[str, str] = field(default_factory=dict)


def spreadsheet(file: Path, excerpt: Excerpt | None = None) -> bytes:
    """Spreadsheet, as bytes of an xlsx file, of a CSV table; equal tables give equal bytes.

    The header row stays on the screen and on each page. Numbers are rounded, an unknown one is an
    empty cell.

    Parameters
    ----------
    file : Path         of the table
    excerpt : Excerpt   first sheet: rows at steps of an angle, which fit on one page, as do the
                        tables beside it; the whole table follows; None: the whole table alone

    Raises
    ------
    ResultError
        If the table cannot be read.
    """
    import xlsxwriter

    whole, content = read_table(file), io.BytesIO()
    with xlsxwriter.Workbook(content, _OPTIONS) as book:
        book.set_properties({"title": file.stem, "author": "Camwright", "created": _CREATED})
        if excerpt is not None:
            turned = np.mod(whole[excerpt.column], excerpt.step)
            near = np.minimum(turned, excerpt.step - turned) < 1e-6
            _add_sheet(book, excerpt.title, whole, np.flatnonzero(near), pages=1)
            for title, name in excerpt.beside.items():
                if (beside := file.with_name(name)).is_file():
                    more = read_table(beside)
                    _add_sheet(book, title, more, np.arange(len(more)), pages=1)
        _add_sheet(book, "all" if excerpt else file.stem, whole, np.arange(len(whole)), pages=0)
    return content.getvalue()


def _add_sheet(book: Workbook, name: str, whole: Table, rows: NDArray[np.intp], pages: int) -> None:
    """Add a sheet with some rows of a table to a workbook.

    Parameters
    ----------
    book : Workbook     changed
    name : str          of the sheet
    whole : Table       the table
    rows : array (k,)   indices of the rows
    pages : int         on which it is printed; 0: as many as it takes. On a given number of pages
                        unknown cells have a border, to be filled in
    """
    sheet = book.add_worksheet(name[:31])
    head = book.add_format({"bold": True, "text_wrap": True, "valign": "top", "bottom": 1})
    to_fill = book.add_format({"border": 1})
    columns = {} if whole.rows_of is None else {LOAD_CASE.header: whole.rows_of[rows].tolist()}
    formats: dict[str, Format | None] = dict.fromkeys(columns)
    for header, values in whole.numbers.items():
        decimals = next((n for end, n in DECIMALS.items() if header.endswith(end)), None)
        columns[header] = rounded(values[rows], decimals).tolist()
        shown = None if decimals is None else {"num_format": f"0.{decimals * '0'}"}
        formats[header] = book.add_format(shown)
    sheet.set_row(0, 45)
    for k, (header, cells) in enumerate(columns.items()):
        sheet.set_column(k, k, 13)
        sheet.write_string(0, k, header, head)
        for row, cell in enumerate(cells, start=1):
            if isinstance(cell, str):
                sheet.write_string(row, k, cell)
            elif cell == cell:  # else unknown, NaN
                sheet.write_number(row, k, cell, formats[header])
            elif pages:
                sheet.write_blank(row, k, None, to_fill)
    sheet.freeze_panes(1, 0)
    sheet.repeat_rows(0)
    sheet.set_landscape()
    sheet.set_paper(_A4)
    sheet.print_area(0, 0, len(rows), len(columns) - 1)
    sheet.fit_to_pages(1 if pages or len(columns) <= 16 else 0, pages)
    sheet.set_footer("&L&F, &A&RPage &P of &N")


def rounded(values: Array, decimals: int | None) -> Array:
    """Values rounded to `decimals` decimals or, where that is None, to `DIGITS` significant digits;
    no negative zero.
    """
    if decimals is not None:
        return np.asarray(np.round(values, decimals) + 0.0)
    size = np.abs(values)
    known = np.isfinite(size) & (size > 0.0)
    power = np.floor(np.log10(np.where(known, size, 1.0)))
    unit = 10.0 ** (DIGITS - 1 - power)
    return np.asarray(np.round(values * unit) / unit + 0.0)
