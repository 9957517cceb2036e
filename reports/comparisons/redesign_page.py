"""Pareto front of a redesign: table, figure, page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Literal

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.records.redesign_document import Against, RedesignDocument, is_refused
from camwright.reports.figure_svg import COLOURS, png, shipped
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
AXES: Mapping[Against, tuple[Literal["cam_radius_mm", "mass_g"], str]] = {
    "size": ("cam_radius_mm", "maximum cam radius, mm"),
    "mass": ("mass_g", "mass, g"),
}
_ROUGH: Mapping[Against, Literal["cam_radius", "mass"]] = {"size": "cam_radius", "mass": "mass"}
_SCALE = 1e3
"""Of a length or mass in SI to mm or g."""


def write(folder: Path, document: RedesignDocument) -> Path:
    """Write figure and page of a redesign's front, ``redesign.png`` and ``redesign.html``.

    Parameters
    ----------
    document : dict   contents of ``redesign.json``

    Returns
    -------
    Path   the page
    """
    picture = drawn(document)
    write_atomic(folder / "redesign.png", picture)
    return write_atomic(folder / "redesign.html", _page(document, picture))


@shipped()
def drawn(document: RedesignDocument) -> bytes:
    """PNG of residual ripple over size or mass: evaluated designs, front, initial design."""
    from matplotlib.figure import Figure

    name, label = AXES[document["against"]]
    canvas = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = canvas.add_subplot()
    rough, initial = _ROUGH[document["against"]], document["given"]
    tried = [row for row in document["tried"] if not is_refused(row)]
    tried = [row for row in tried if row["feasible"]]
    if tried and not is_refused(initial):
        before = initial["ripple_before_Nm"]
        axes.plot([_SCALE * row[rough] for row in tried], [before * row["ripple"] for row in tried],
                  ".", color=COLOURS["muted"], ms=4, label="coarse evaluations")  # fmt: skip
    points = document["points"]
    if points:
        x, y = [row[name] for row in points], [row["ripple_left_Nm"] for row in points]
        axes.plot(x, y, "o-", color=COLOURS["blue"], lw=1.4, ms=5, label="front")
        for k, place in enumerate(zip(x, y, strict=True), start=1):
            axes.annotate(str(k), place, xytext=(5, 5), textcoords="offset points", fontsize=8)
    if not is_refused(initial):
        words = "initial design, fails" if initial["failing"] else "initial design"
        axes.plot([initial[name]], [initial["ripple_left_Nm"]], "x", color=COLOURS["vermillion"],
                  ms=8, mew=2, label=words)  # fmt: skip
    axes.set_xlabel(label)
    axes.set_ylabel("residual torque ripple, std, N m")
    axes.set_ylim(bottom=0.0)
    axes.grid(color=COLOURS["grid"], lw=0.6)
    axes.legend(fontsize=8, frameon=False)
    return png(canvas)


def _page(document: RedesignDocument, picture: bytes) -> str:
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
    alt = f"Residual torque ripple over {AXES[document['against']][1]}"
    excluded = document["without_result"]
    front = [
        *(
            []
            if excluded is None
            else [SectionBlock(Note(f"{line}.")) for line in excluded["lines"]]
        ),
        _table("Points of the front", [words for _, words in COLUMNS], points, 5, 7),
        SectionBlock(Pictures([Picture("Front", alt=alt, png=picture)])),
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
