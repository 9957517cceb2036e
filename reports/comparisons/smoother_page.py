"""Comparison of smoothers on one case: table, figure of the lifts, page."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.files import write_atomic
from camwright.reports.figure_svg import COLOURS, png, shipped, style
from camwright.reports.figures import CAM_STEP, SERIES
from camwright.reports.page import study_page
from camwright.reports.picture_list import Picture
from camwright.reports.report_content import Note, Pictures, ReportSection, SectionBlock, Tabular
from camwright.reports.report_tables import Cell, Record, ReportTable, Scalar, Status, listed, words

Cells = Scalar | Sequence[Scalar]
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
    picture = drawn(lifts)
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
        SectionBlock(
            Pictures([Picture("Lift", alt="Lift over one cam turn by smoother", png=picture)])
        ),
    ]
    return write_atomic(
        folder / "smoothers.html", study_page(title, [ReportSection("", "", content)], lead)
    )


@shipped()
def drawn(lifts: Mapping[str, Array]) -> bytes:
    """PNG of the lift of each smoother over one cam turn."""
    from matplotlib.figure import Figure

    with style("smoothers"):
        canvas = Figure(figsize=(8.0, 3.6), layout="constrained")
        axes = canvas.add_subplot()
        for (label, lift), colour in zip(lifts.items(), cycle(SERIES), strict=False):
            angle = np.arange(lift.size) * (360.0 / lift.size)
            width = 2.2 if label == "constrained" else 1.2
            axes.plot(angle, 1e3 * lift, linewidth=width, color=COLOURS[colour], label=label)
        axes.set(xlabel="cam angle, deg", ylabel="lift, mm", xlim=(0.0, 360.0))
        axes.set_xticks(np.arange(0.0, 361.0, CAM_STEP))
        axes.grid(visible=True, axis="y")
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False)
        return png(canvas)


def _as_text(value: Cells) -> str:
    """A cell of the CSV file; names of a list with semicolons between."""
    return "; ".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


def _cell(name: str, value: Cells, common: Sequence[str]) -> Cell:
    """A cell of the page; the first of the rank is recommended."""
    if name == "missing" and isinstance(value, (list, tuple)):
        value = [one for one in value if one not in common]
    text = listed(value)
    if name == "rank" and value == 1:
        return "1, recommended"
    return Status(text, text.upper()) if name == "verdict" else words(text)
