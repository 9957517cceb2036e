"""Smoothers side by side on one page: table and figure."""

from __future__ import annotations

import base64
import csv
import html
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from camwright.geometry.arrays import Array

COLUMNS = (
    ("smoother", "smoother"),
    ("words", "what it does"),
    ("pressure_angle_max_deg", "pressure angle, deg"),
    ("lift_max_mm", "lift, mm"),
    ("normal_force_max_N", "N max, N"),
    ("p0_max_MPa", "p0, MPa"),
    ("residual_std_Nm", "ripple left, std N m"),
    ("residual_p2p_Nm", "ripple left, p-p N m"),
    ("verdict", "verdict"),
    ("binding", "what fails"),
    ("why", "why there is no cam"),
)


def write(
    folder: Path, title: str, rows: Sequence[Mapping[str, Any]], lifts: Mapping[str, Array]
) -> Path:
    """``smoothers.csv``, ``smoothers.png`` and ``smoothers.html``; the page is given back.

    Parameters
    ----------
    rows : sequence of mapping   a value per column name, missing ones left out
    lifts : mapping              label to lift, m, at equal cam angles of one turn
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "smoothers.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([name for name, _ in COLUMNS])
        writer.writerows([[_written(row.get(name, "")) for name, _ in COLUMNS] for row in rows])
    picture = drawn(lifts)
    (folder / "smoothers.png").write_bytes(picture)
    page = folder / "smoothers.html"
    page.write_text(_page(title, rows, picture), encoding="utf-8")
    return page


def drawn(lifts: Mapping[str, Array]) -> bytes:
    """The lifts over one cam turn, PNG."""
    canvas = Figure(figsize=(8.0, 4.0), layout="constrained")
    axes = canvas.add_subplot()
    for label, lift in lifts.items():
        angle = np.arange(lift.size) * (360.0 / lift.size)
        axes.plot(angle, 1e3 * lift, lw=2.2 if label == "constrained" else 1.0, label=label)
    axes.set_xlabel("cam angle, deg")
    axes.set_ylabel("lift, mm")
    axes.set_xlim(0.0, 360.0)
    axes.legend(fontsize=7.5, frameon=False)
    held = io.BytesIO()
    canvas.savefig(held, format="png", dpi=150)
    return held.getvalue()


def _page(title: str, rows: Sequence[Mapping[str, Any]], picture: bytes) -> str:
    head = "".join(f"<th>{html.escape(words)}</th>" for _, words in COLUMNS)
    body = "".join(
        "<tr>" + "".join(f"<td>{_shown(row.get(name))}</td>" for name, _ in COLUMNS) + "</tr>"
        for row in rows
    )
    image = base64.b64encode(picture).decode()
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
        "<style>body{font:15px sans-serif;margin:2em;max-width:70em}td,th{padding:.3em .7em;"
        "text-align:left;border-bottom:1px solid #ccc}img{max-width:100%}</style>"
        f"<h1>{html.escape(title)}</h1><table><tr>{head}</tr>{body}</table>"
        f'<img alt="Lift over one cam turn by smoother" src="data:image/png;base64,{image}"></html>'
    )


def _written(value: Any) -> Any:
    """A value of the table; a list of names as one text."""
    return "; ".join(map(str, value)) if isinstance(value, (list, tuple)) else value


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (list, tuple)):
        return html.escape(", ".join(map(str, value)).replace("_", " ")) or "-"
    return "-" if value is None else html.escape(str(value))
