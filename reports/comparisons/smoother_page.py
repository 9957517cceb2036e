"""Comparison of smoothers on one case: table, figure of the lifts, page."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from itertools import cycle, product
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.figures import (
    CAM_STEP,
    SERIES,
    Curve,
    Figure,
    HorizontalAxis,
    Look,
    Panel,
    closed,
)
from camwright.pipeline.base.files import write_atomic
from camwright.reports.figure_svg import png_of
from camwright.reports.page import study_page
from camwright.reports.picture_list import Picture
from camwright.reports.report_content import Note, Pictures, ReportSection, SectionBlock, Tabular
from camwright.reports.report_tables import Cell, Record, ReportTable, Scalar, Status, listed, words

Cells = Scalar | Sequence[Scalar]
_WIDTH = 8.0  # in, of the picture
COLUMNS = (
    ("rank", "rank"),
    ("smoother", "smoother"),
    ("words", "definition"),
    ("pressure_angle_max_deg", "pressure angle, deg"),
    ("lift_max_mm", "lift, mm"),
    ("normal_force_max_N", "maximum normal force, N"),
    ("p0_max_MPa", "p0, MPa"),
    ("residual_std_Nm", "residual ripple, std, N m"),
    ("residual_p2p_Nm", "residual ripple, peak to peak, N m"),
    ("verdict", "verdict"),
    ("failing", "failing must-have checks, the worst first"),
    ("missing", "further missing data"),
    ("why", "reason without a cam"),
)


def write(
    folder: Path,
    title: str,
    rows: Sequence[Record],
    lifts: Mapping[str, Array],
    *,
    lead: str = "",
    common: Sequence[str] = (),
) -> Path:
    """Write the comparison of smoothers: ``smoothers.csv``, ``.png`` and ``.html``.

    Parameters
    ----------
    rows : sequence of mapping   a value per column name, ranked; missing ones are left out
    lifts : mapping              label to lift, m, at equal cam angles of one turn
    lead : str                   recommendation and rule of the rank, above the table
    common : sequence            ids of the checks without data in every row, listed once

    Returns
    -------
    Path   the page
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow([name for name, _ in COLUMNS])
    writer.writerows([[_as_text(row.get(name, "")) for name, _ in COLUMNS] for row in rows])
    write_atomic(folder / "smoothers.csv", text.getvalue())
    figure = figure_of(lifts)
    picture = png_of(figure, _WIDTH)
    write_atomic(folder / "smoothers.png", picture)
    cells = [[_cell(name, row.get(name), common) for name, _ in COLUMNS] for row in rows]
    table = ReportTable("Smoothers", [title for _, title in COLUMNS], cells, 3, 6)
    content = [
        *(
            [SectionBlock(Note(f"Missing data, whatever the smoother: {listed(common)}."))]
            if common
            else []
        ),
        SectionBlock(Tabular(table)),
        SectionBlock(Pictures([Picture(figure.title, alt=figure.alt, png=picture)])),
    ]
    return write_atomic(
        folder / "smoothers.html", study_page(title, [ReportSection("", "", content)], lead)
    )


def figure_of(lifts: Mapping[str, Array]) -> Figure:
    """Lifts, m, over one cam turn by their labels."""
    looks: tuple[Look, ...] = ("line", "dashed", "dotted")
    signs = cycle(product(looks, SERIES))
    curves = tuple(
        Curve(np.linspace(0.0, 360.0, lift.size + 1), 1e3 * closed(lift), label, colour, look)
        for (label, lift), (look, colour) in zip(lifts.items(), signs, strict=False)
    )
    axis = HorizontalAxis("cam angle", "deg", (0.0, 360.0), CAM_STEP)
    return Figure("smoothers", "Lift", "", (Panel("lift", "mm", curves, height=1.6),), axis)


def _as_text(value: Cells) -> str:
    """A cell of the CSV file; names of a list with semicolons between."""
    return "; ".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


def _cell(name: str, value: Cells, common: Sequence[str]) -> Cell:
    """Value of the column `name` as a cell of the page; the first of the rank is recommended.

    Checks in `common` are left out of the missing ones.
    """
    if name == "missing" and isinstance(value, (list, tuple)):
        value = [one for one in value if one not in common]
    text = listed(value)
    if name == "rank" and value == 1:
        return "1, recommended"
    return Status(text, text.upper()) if name == "verdict" else words(text)
