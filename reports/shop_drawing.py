"""Shop drawing of the cam: ``workshop/drawing.pdf``, one A3 sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError, ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.run_reader import results_sha256
from camwright.pipeline.results.workshop_files import WORKSHOP, CamDimensions, dimensions_of
from camwright.reports import pdf
from camwright.reports.drawing.drawing_shapes import Drawing
from camwright.reports.drawing.part_view import Part, radius_at, scale_words, views
from camwright.reports.report_data import Material
from camwright.reports.report_tables import number, quantity, shortened
from camwright.reports.title_block import title_block

FILE = f"{WORKSHOP}/drawing.pdf"
STEP = 10
"""deg, between the rows of the table of radii."""
_POINTS, _FINE = 1440, 36_000  # of the contour as drawn, and for its radii
_MM = 1e3


@dataclass(frozen=True, eq=False)
class ShopDrawing:
    """Contents of the drawing.

    radii : sequence   polar angle, deg, and radius, mm, as text
    block, facts       names and values of the title block; "" is a field to fill by hand
    """

    short_title: str
    name: str
    drawing: Drawing
    radii: Sequence[tuple[str, str]]
    extremes: Sequence[tuple[str, str]]
    notes: Sequence[str]
    block: Sequence[tuple[str, str]]
    facts: Sequence[tuple[str, str]]
    results: str


def write(material: Material) -> list[Path]:
    """Write the drawing; none of a contour that encloses no body.

    Raises
    ------
    ResultError
        If the file cannot be written.
    """
    content = drawing_content(material)
    if content is None:
        return []
    return [write_atomic(material.folder / FILE, pdf.typeset("drawing.typ", content))]


def drawing_content(material: Material) -> ShopDrawing | None:
    """Contents of the drawing of a run; None if its contour encloses no body."""
    case, contour = drawn_cam(material.run.path)
    try:
        contour.require_no_undercut()
    except ResultError:
        raise
    except CamError:
        return None
    size, hole = dimensions_of(case), material.turn.counter_hole
    part = _part(contour, size, material)
    facts = [
        ("Title", shortened(case.title or case.name, 70)), ("Case", case.name),
        ("Thickness", quantity(_MM * size.thickness, "mm")), ("Card", shortened(size.material, 70)),
        ("Hardness", shortened(size.hardness, 60)),
        ("Roughness", "" if size.roughness is None
         else f"Rq {quantity(in_unit(size.roughness, 'um'), 'µm')}"),
        ("Scale", scale_words(part.scale)), ("General tolerances", ""),
    ]  # fmt: skip
    notes = [
        f"Contour: workshop/contour.dxf, layer cut, arcs within "
        f"{quantity(in_unit(case.workshop.arc_error, 'um'), 'µm')}; points in contour.csv.",
        f"Profile of a line, ISO 1101: zone {quantity(_MM * size.profile_tolerance, 'mm')} wide, "
        "half of it to each side of the nominal contour.",
        "Datum A: axis of the bore." + (" Datum B: middle plane of the keyway; it sets angle "
                                        "zero." if size.keyway_width is not None else ""),
        "Angles grow counter-clockwise from the line marked 0°. In this view the cam turns "
        "clockwise.",
    ]  # fmt: skip
    if hole is not None and hole[3]:
        x, y, radius, _ = hole
        notes.append(f"Counter-hole of {quantity(2.0 * radius, 'mm')} diameter through the cam at "
                     f"x {quantity(x, 'mm')}, y {quantity(y, 'mm')}.")  # fmt: skip
    return ShopDrawing(
        f"Drawing of the cam, {shortened(case.title or case.name, 100)}", case.name, views(part),
        radii_of(contour), _extremes(contour), notes, title_block(material.case), facts,
        results_sha256(material.run.summary["files"]),
    )  # fmt: skip


def radii_of(contour: Contour) -> list[tuple[str, str]]:
    """Radius, mm, of the contour by polar angle, every `STEP` deg."""
    polygon = _MM * contour.polygon(_FINE)
    return [
        (f"{degrees}°", f"{radius_at(polygon, np.radians(degrees)):.4f}")
        for degrees in range(0, 360, STEP)
    ]


def _extremes(contour: Contour) -> list[tuple[str, str]]:
    """Greatest and least radius with their polar angles."""
    rows = []
    for words, extreme in (("greatest", contour.radius_max()), ("least", contour.radius_min())):
        x, y = contour.points(np.array([extreme.theta]))[:, 0]
        polar = float(np.degrees(np.arctan2(y, x))) % 360.0
        rows.append((f"{words}, at {number(polar)}°", f"{_MM * extreme.value:.4f}"))
    return rows


def _part(contour: Contour, size: CamDimensions, material: Material) -> Part:
    hole = material.turn.counter_hole
    roughness = "" if size.roughness is None else number(in_unit(size.roughness, "um"))
    polygon: Array = _MM * contour.polygon(_POINTS)
    return Part(
        polygon, material.turn.keyway, None if hole is None or not hole[3] else hole[:3],
        _MM * size.thickness, size.bore, size.keyway_width, size.keyway_depth,
        None if size.root_radius is None else _MM * size.root_radius,
        number(_MM * size.profile_tolerance), size.datum, roughness,
    )  # fmt: skip
