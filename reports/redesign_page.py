"""The front of a redesign on one page: table and figure, from its record alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from camwright.pipeline.base.files import write_atomic
from camwright.reports.figure_svg import COLOURS, png
from camwright.reports.page import study_page
from camwright.reports.picture_list import Picture
from camwright.reports.report_content import Block, Note, Pictures, Section, Tabular
from camwright.reports.report_tables import Table, listed

COLUMNS = (
    ("file", "case"),
    ("roller", "roller"),
    ("spring", "spring"),
    ("bush", "bushes"),
    ("ripple_left_Nm", "ripple left, N m"),
    ("cam_radius_mm", "cam radius, mm"),
    ("mass_g", "mass, g"),
    ("pitch_base_radius_mm", "base radius, mm"),
    ("lift_max_mm", "lift, mm"),
    ("normal_force_max_N", "N max, N"),
    ("p0_max_MPa", "p0, MPa"),
    ("binding", "limits that cost ripple"),
)
AXES = {"size": ("cam_radius_mm", "greatest radius of the cam, mm"), "mass": ("mass_g", "mass, g")}
_ROUGH = {"size": ("cam_radius", 1e3), "mass": ("mass", 1e3)}


def write(folder: Path, document: Mapping[str, Any]) -> Path:
    """``redesign.png`` and ``redesign.html``; the page is given back.

    Parameters
    ----------
    document : mapping   the contents of ``redesign.json``
    """
    picture = drawn(document)
    write_atomic(folder / "redesign.png", picture)
    return write_atomic(folder / "redesign.html", _page(document, picture))


def drawn(document: Mapping[str, Any]) -> bytes:
    """Ripple left over size or mass: what was tried, the front, the case as given; PNG."""
    name, label = AXES[document["against"]]
    canvas = Figure(figsize=(7.2, 4.4), layout="constrained")
    axes = canvas.add_subplot()
    rough, scale = _ROUGH[document["against"]]
    before = document["given"].get("ripple_before_Nm")
    tried = [row for row in document["tried"] if row["feasible"]]
    if tried and before is not None:
        axes.plot([scale * row[rough] for row in tried], [before * row["ripple"] for row in tried],
                  ".", color=COLOURS["muted"], ms=4, label="tried, on a coarse turn")  # fmt: skip
    points = document["points"]
    if points:
        x, y = [row[name] for row in points], [row["ripple_left_Nm"] for row in points]
        axes.plot(x, y, "o-", color=COLOURS["blue"], lw=1.4, ms=5, label="front")
        for k, place in enumerate(zip(x, y, strict=True), start=1):
            axes.annotate(str(k), place, xytext=(5, 5), textcoords="offset points", fontsize=8)
    given = document["given"]
    if given.get(name) is not None:
        words = "as given, fails" if given.get("failing") else "as given"
        axes.plot([given[name]], [given["ripple_left_Nm"]], "x", color=COLOURS["vermillion"],
                  ms=8, mew=2, label=words)  # fmt: skip
    axes.set_xlabel(label)
    axes.set_ylabel("torque ripple left, std, N m")
    axes.set_ylim(bottom=0.0)
    axes.grid(color=COLOURS["grid"], lw=0.6)
    axes.legend(fontsize=8, frameon=False)
    return png(canvas)


def _page(document: Mapping[str, Any], picture: bytes) -> str:
    title = f"{document['case']}: redesign, ripple against {document['against']}"
    words = (
        "Each point is a case file, drawn by constrained synthesis and judged by closed forms, as "
        "camwright check does; camwright run signs it off by finite elements."
    )
    points = [[listed(row.get(name)) for name, _ in COLUMNS] for row in document["points"]]
    refused = [
        [f"{row['roller']}, {row['spring']}, {row['bush']}", str(row["why"])]
        for row in document["refused"]
    ]
    pruned = [[str(row["part"]), str(row["why"])] for row in document["pruned"]]
    alt = f"Torque ripple left over {AXES[document['against']][1]}"
    front = [
        _table("Points of the front", [words for _, words in COLUMNS], points, 4, 7),
        Block(Pictures([Picture("Front", alt=alt, png=picture)])),
    ]
    return study_page(title, [
        Section("points", "", front),
        Section("refused", "Solved whole and not on the front",
                [_table("Not on the front", ("parts", "why"), refused, 2)]),
        Section("pruned", "Left out before anything was solved",
                [_table("Left out", ("part", "why"), pruned, 2)]),
    ], words)  # fmt: skip


def _table(
    label: str, head: Sequence[str], rows: Sequence[Sequence[str]], text: int, numbers: int = 0
) -> Block:
    return Block(Tabular(Table(label, head, rows, text, numbers)) if rows else Note("None."))
