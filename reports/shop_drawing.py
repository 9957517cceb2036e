"""Shop drawing of the cam: ``workshop/drawing.pdf``, one A3 sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import read_json, write_atomic
from camwright.pipeline.base.fits import size_of
from camwright.pipeline.results.run_reader import results_sha256
from camwright.reports import pdf
from camwright.reports.drawing.drawing_shapes import Drawing
from camwright.reports.drawing.part_view import Part, scale_words, views
from camwright.reports.report_data import Material
from camwright.reports.report_tables import Record, number, quantity, shortened
from camwright.reports.title_block import title_block

FILE = "workshop/drawing.pdf"
DIMENSIONS = "workshop/dimensions.json"
_MM = 1e3


@dataclass(frozen=True, eq=False)
class ShopDrawing:
    """Contents of the drawing.

    radii : sequence   polar angle, deg, and radius, mm, as text
    block, facts       names and values of the title block; "" is a field to fill by hand
    """

    short_title: str
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
    """Contents of the drawing of a run; None if its contour encloses no body.

    Raises
    ------
    ResultError
        If the dimensions of the run are not as `workshop_files` writes them.
    """
    file = material.run.path / DIMENSIONS
    if not file.is_file():
        return None
    record = read_json(file)
    try:
        return _content(material, record)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ResultError(f"{file}: {type(error).__name__}: {error}") from None


def _content(material: Material, record: Record) -> ShopDrawing:
    part, case = _part(material, record), material.case
    title = str(case.get("title") or case["name"])
    roughness, thickness = record["roughness_rq_um"], record["thickness_mm"]
    profile, hole = record["profile_tolerance_mm"], record["counter_hole"]
    facts = [
        ("Title", shortened(title, 70)), ("Case", shortened(str(case["name"]), 40)),
        ("Thickness", quantity(thickness, "mm")), ("Card", shortened(record["material"], 70)),
        ("Hardness", shortened(record["hardness"], 60)),
        ("Roughness", "" if roughness is None else f"Rq {quantity(roughness, 'µm')}"),
        ("Scale", scale_words(part.scale)), ("General tolerances", ""),
    ]  # fmt: skip
    keyed = " Datum B: middle plane of the keyway; it sets angle zero." if part.keyway else ""
    notes = [
        "Contour: workshop/contour.dxf, layer cut, arcs within "
        f"{quantity(record['arc_error_um'], 'µm')}; points in contour.csv.",
        f"Profile of a line, ISO 1101: zone {quantity(profile, 'mm')} wide, half of it to each "
        "side of the nominal contour.",
        f"Datum A: axis of the bore.{keyed}",
        "Angles grow counter-clockwise from the line marked 0°. In this view the cam turns "
        "clockwise.",
    ]
    if hole is not None:
        notes.append(
            f"Counter-hole of {quantity(2.0 * hole['radius_mm'], 'mm')} diameter through the cam "
            f"at x {quantity(hole['x_mm'], 'mm')}, y {quantity(hole['y_mm'], 'mm')}."
        )
    extremes = [
        (f"{words}, at {number(record[name]['polar_angle_deg'])}°",
         f"{record[name]['radius_mm']:.4f}")
        for words, name in (("greatest", "radius_max"), ("least", "radius_min"))
    ]  # fmt: skip
    radii = [(f"{degrees}°", f"{radius:.4f}") for degrees, radius in record["radii_mm"].items()]
    return ShopDrawing(
        f"Drawing of the cam, {shortened(title, 100)}", views(part), radii, extremes, notes,
        title_block(case), facts, results_sha256(material.run.summary["files"]),
    )  # fmt: skip


def _part(material: Material, record: Record) -> Part:
    contour = material.turn.contour
    keyway, hole, roughness = record["keyway"], record["counter_hole"], record["roughness_rq_um"]
    bore = size_of(record["bore"])
    width = depth = None
    if keyway is not None:
        width, depth = size_of(keyway["width"]), size_of(keyway["depth"])
    return Part(
        np.array([contour["contour_x_mm"], contour["contour_y_mm"]]),
        None if width is None or depth is None else (
            _MM * width.nominal, _MM * (depth.nominal - bore.nominal),
            float(np.radians(keyway["angle_deg"])),
        ),
        None if hole is None else (hole["x_mm"], hole["y_mm"], hole["radius_mm"]),
        float(record["thickness_mm"]), bore, width, depth,
        None if keyway is None else keyway["root_radius_mm"],
        number(record["profile_tolerance_mm"]), str(record["datum"]),
        "" if roughness is None else number(roughness),
    )  # fmt: skip
