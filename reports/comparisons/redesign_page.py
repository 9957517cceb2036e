"""Pareto front of a redesign: table, figure, page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from camwright.geometry.figures import Curve, Figure, Panel, over
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.judgement_record import is_refused
from camwright.pipeline.records.redesign_document import Against, RedesignDocument
from camwright.reports.figure_svg import png_of
from camwright.reports.page import study_page
from camwright.reports.picture_list import Picture
from camwright.reports.report_content import Note, Pictures, ReportSection, SectionBlock, Tabular
from camwright.reports.report_tables import Cell, Record, ReportTable, Scalar, Status, listed

COLUMNS = (
    ("file", "case"),
    ("verdict", "verdict"),
    ("roller", "roller"),
    ("spring", "spring"),
    ("bush", "bushes"),
    ("ripple_left_Nm", "residual ripple, N m"),
    ("cam_radius_mm", "cam radius, mm"),
    ("mass_g", "mass, g"),
    ("prime_radius_mm", "prime radius, mm"),
    ("lift_max_mm", "lift, mm"),
    ("normal_force_max_N", "maximum normal force, N"),
    ("p0_max_MPa", "p0, MPa"),
    ("binding", "active limits"),
)
AXES: Mapping[Against, tuple[Literal["cam_radius_mm", "mass_g"], str, str]] = {
    "size": ("cam_radius_mm", "maximum cam radius", "mm"),
    "mass": ("mass_g", "mass", "g"),
}
_WIDTH = 7.2  # in, of the picture


def write(folder: Path, document: RedesignDocument) -> Path:
    """Write figure and page of a redesign's front, ``redesign.png`` and ``redesign.html``.

    Parameters
    ----------
    document : dict   contents of ``redesign.json``

    Returns
    -------
    Path   the page
    """
    figure = figure_of(document)
    picture = png_of(figure, _WIDTH)
    write_atomic(folder / "redesign.png", picture)
    shown = Picture(figure.title, alt=figure.alt, png=picture)
    return write_atomic(folder / "redesign.html", _page(document, shown))


def figure_of(document: RedesignDocument) -> Figure:
    """Figure of the ripple left, N m, over size or mass: evaluated designs, front, initial
    design.
    """
    name, quantity, unit = AXES[document["against"]]
    initial, curves = document["given"], list[Curve]()
    tried = [row for row in document["tried"] if not is_refused(row)]
    tried = [row for row in tried if row["feasible"]]
    if tried and not is_refused(initial):
        ripple = initial["ripple_before_Nm"] * np.array([row["ripple_left_share"] for row in tried])
        sizes = np.array([row[name] for row in tried])
        curves.append(Curve(sizes, ripple, "coarse evaluations", "muted", "points"))
    if points := document["points"]:
        x, y = (np.array([row[key] for row in points]) for key in (name, "ripple_left_Nm"))
        notes = tuple(str(k) for k in range(1, len(points) + 1))
        curves.append(Curve(x, y, "front", look="marked", notes=notes))
    if not is_refused(initial):
        x, y = np.array([initial[name]]), np.array([initial["ripple_left_Nm"]])
        words = "initial design, fails" if initial["failing"] else "initial design"
        curves.append(Curve(x, y, words, "vermillion", "spot"))
    panel = Panel("residual torque ripple, std", "N m", tuple(curves), height=2.0, from_zero=True)
    return over("redesign", "Front", "", quantity, unit, [panel], dots=False)


def _page(document: RedesignDocument, picture: Picture) -> str:
    """HTML of the page: points of the front with their picture, designs not on the front and parts
    excluded by bounds, each with the reason.
    """
    title = f"{document['case']}: redesign, ripple against {document['against']}"
    words = (
        "Each point is a case file with the lift of the constrained synthesis, checked by closed "
        "forms as in camwright check. camwright run verifies it by finite elements."
    )
    front_rows: Sequence[Record] = document["points"]
    points = [[_cell(name, row.get(name)) for name, _ in COLUMNS] for row in front_rows]
    refused = [
        [f"{row['roller']}, {row['spring']}, {row['bush']}", str(row["why"])]
        for row in document["refused"]
    ]
    pruned = [[str(row["part"]), str(row["why"])] for row in document["pruned"]]
    excluded = document["without_result"]
    front = [
        *(
            []
            if excluded is None
            else [SectionBlock(Note(f"{line}.")) for line in excluded["lines"]]
        ),
        _table("Points of the front", [words for _, words in COLUMNS], points, 5, 7),
        SectionBlock(Pictures([picture])),
    ]
    return study_page(title, [
        ReportSection("points", "", front),
        ReportSection("refused", "Designs not on the front",
                [_table("Not on the front", ("parts", "reason"), refused, 2)]),
        ReportSection("pruned", "Parts excluded by bounds",
                [_table("Excluded", ("part", "reason"), pruned, 2)]),
    ], words)  # fmt: skip


def _cell(name: str, value: Scalar | Sequence[Scalar]) -> Cell:
    """A value of a point; a verdict as a status."""
    text = listed(value)
    return Status(text, text.upper()) if name == "verdict" else text


def _table(
    label: str, head: Sequence[str], rows: Sequence[Sequence[Cell]], text: int, numbers: int = 0
) -> SectionBlock:
    return SectionBlock(
        Tabular(ReportTable(label, head, rows, text, numbers)) if rows else Note("None.")
    )
