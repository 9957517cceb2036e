"""Pictures of a report with titles and captions: stress fields, maps, pressures."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.worker_processes import Crew, PendingCall
from camwright.reports import (
    field_picture,
    field_raster,
    pressure_figures,
    report_tables,
    stress_map,
)
from camwright.reports.figure_svg import shipped
from camwright.reports.report_data import FIGURES, ReportMaterial

FIELD = Path("fields") / "stress.vtkhdf"


@dataclass(frozen=True, eq=False)
class Picture:
    """Raster picture, or the reason why it is missing.

    `name` is its file in ``figures/``. A picture that cannot be drawn has no `png` and states the
    reason in `note`.
    """

    title: str
    caption: str = ""
    alt: str = ""
    name: str = ""
    png: bytes = b""
    note: str = ""

    @property
    def data(self) -> str:
        """The picture in base64."""
        return base64.b64encode(self.png).decode()


@lru_cache(maxsize=1)
@shipped()
def stress_pictures(material: ReportMaterial) -> Sequence[Picture]:
    """Pictures of the stress field below the contact and in both bodies, or one entry with the
    reason why they are missing.
    """
    turn, path = material.turn, material.run.path / FIELD
    try:
        field = field_picture.read_field(path)
        point, normal = field_picture.find_contact(field)
        solved, hertz, cam_angle = (
            field_picture.stated(field, name)
            for name in ("half_width_mm", "half_width_hertz_mm", "cam_angle_deg")
        )
        half_width = hertz if np.isnan(solved) else solved
        views = [
            field_picture.contact_view(field, half_width, point, normal),
            field_picture.body_view(field),
        ]
        rasters = field_picture.render(field, views)
    except ResultError as error:
        return (Picture("Stress field", note=f"The stress field is not available: {error}."),)
    angle = report_tables.number(cam_angle)
    peak = report_tables.quantity(views[0].clim[1], "MPa")
    final = material.run.final
    above = field_raster.over_the_contact(
        final.path / field_raster.PRESSURE, final.cycle, cam_angle, half_width
    )
    return (
        Picture(
            f"Contact pressure and von Mises stress below the {turn.follower_name}",
            f"At cam angle {angle} deg, the maximum contact pressure. Lengths in half-widths; "
            f"lines at 20, 40, 60, 80 and 95 % of the maximum, {peak}. Deformation at true scale.",
            f"Von Mises stress within four half-widths of the contact; maximum {peak}.",
            "field-contact",
            field_picture.frame_contact(rasters[0], half_width, turn.follower_name, above),
            rasters[0].note,
        ),
        Picture(
            f"Von Mises stress in cam and {turn.follower_name}",
            f"At the same cam angle. Logarithmic colours over {field_picture.DECADES:g} decades; "
            "lower stress in the darkest colour.",
            f"Von Mises stress in cam and {turn.follower_name} on a logarithmic scale.",
            "field-body", field_picture.frame_body(rasters[1]), rasters[1].note,
        ),
    )  # fmt: skip


@lru_cache(maxsize=1)
@shipped()
def envelope_pictures(material: ReportMaterial) -> Sequence[Picture]:
    """Maps of the maximum stress below the contour over the turn; () for a contour that encloses no
    body, and one entry with the reason where the map is unreadable.
    """
    file = material.run.final.path / stress_map.FILE
    if not file.exists():
        return ()
    title = "Maximum stress below the contour over one turn"
    try:
        envelope = stress_map.read_envelope(file, material.turn.load_case)
    except ResultError as error:
        return (Picture(title, note=f"The stress map is not available: {error}."),)
    contour = material.run.final.contour
    shape = (
        contour["cam_angle_deg"],
        np.stack([contour["contour_x_mm"], contour["contour_y_mm"]]),
        np.stack([contour["normal_x"], contour["normal_y"]]),
    )
    mises, angle, depth = stress_map.worst(envelope, "von_mises_MPa")
    peak = (
        f"Maximum von Mises stress {report_tables.quantity(mises, 'MPa')} at cam angle "
        f"{report_tables.quantity(angle, 'deg')}, depth {report_tables.quantity(depth, 'mm')}."
    )
    return (
        Picture(
            title,
            f"Maximum over the turn at each point of the cam, contour unrolled. {peak} Pitting is "
            "most likely at the maximum.",
            f"Maps of von Mises stress and shear range over cam angle and depth. {peak}",
            "envelope",
            stress_map.drawn(envelope),
        ),
        Picture(
            "Maximum von Mises stress along the contour",
            "Maximum over the turn; cam angles at the contour, depths enlarged.",
            f"Map of von Mises stress as a band along the contour. {peak}",
            "envelope-contour",
            stress_map.around(envelope, *shape),
        ),
    )


@lru_cache(maxsize=1)
@shipped()
def guide_pictures(material: ReportMaterial) -> Sequence[Picture]:
    """Picture of the pressure in both guides; () for a contour that encloses no body, and an entry
    with the reason where it is unreadable.
    """
    file = material.run.final.path / pressure_figures.FILE
    if not file.exists():
        return ()
    title = "Pressure in the guides"
    try:
        guides = pressure_figures.read_guides(file, material.turn.load_case)
    except ResultError as error:
        return (Picture(title, note=f"The guide pressure is not available: {error}."),)
    peaks = ", ".join(
        f"{guide.name} {report_tables.quantity(guide.peak, 'MPa')} at cam angle "
        f"{report_tables.quantity(guide.worst_angle, 'deg')}" for guide in guides
    )  # fmt: skip
    return (
        Picture(
            title,
            "Left: line load on the stem over the turn. Middle: pressure around the bore at the "
            "cam angle of its maximum (dashed on the left), 0 deg in the direction of the side "
            "force. "
            f"Right: slice of maximum pressure, drawn outwards from the bore. Maximum: {peaks}. "
            "The slices are independent: load transfer between them at the sharp end of a bore is "
            "neglected.",
            f"Maps of the pressure in both guides; maximum {peaks}.",
            "guide-pressure",
            pressure_figures.drawn(guides),
        ),
    )


@lru_cache(maxsize=1)
@shipped()
def pivot_pictures(material: ReportMaterial) -> Sequence[Picture]:
    """Picture of the pressure in the bush of a pivot; () without one, and an entry with the reason
    where it is unreadable.
    """
    file = material.run.final.path / pressure_figures.PIVOT
    if not file.exists():
        return ()
    title = "Pressure in the bush of the pivot"
    try:
        bush = pressure_figures.read_pivot(file, material.turn.load_case)
    except ResultError as error:
        return (Picture(title, note=f"The pressure of the pivot is not available: {error}."),)
    peak = (
        f"{report_tables.quantity(bush.peak, 'MPa')} at cam angle "
        f"{report_tables.quantity(bush.worst_angle, 'deg')} of load case {bush.worst_case}"
    )
    zero = "0 deg where the pin presses"
    model = "The pin is rigid along its axis, each slice of the bush an independent pin in a hole."
    if "pivot_edge_pressure_foundation_MPa" in material.turn.columns:
        zero = "0 deg in the plane of the couple of the contact"
        model = "Pin and bush by finite elements; at a sharp end the pressure grows with the mesh."
    return (
        Picture(
            title,
            "Left: line load on the pin over the turn. Middle: pressure around the bore at the cam "
            f"angle of its maximum (dashed on the left), {zero}; upwards the "
            "end that the couple of the contact presses. Right: slice of maximum pressure, drawn "
            f"outwards from the bore. Maximum: {peak}. {model}",
            f"Maps of the pressure in the bush of the pivot; maximum {peak}.",
            "pivot-pressure",
            pressure_figures.drawn([bush]),
        ),
    )


@lru_cache(maxsize=1)
@shipped()
def axial_pictures(material: ReportMaterial) -> Sequence[Picture]:
    """Picture of the pressure along the line of contact; () where the case lacks an end, and an
    entry with the reason where it is unreadable.
    """
    final = material.run.final
    file, follower = final.path / pressure_figures.AXIAL, material.turn.follower_name
    if not file.exists():
        return ()
    title = f"Contact pressure along the {follower}"
    check = next((c for c in final.checks if c["id"] == "edge_pressure"), None)
    records: Sequence[report_tables.Record] = final.record.get("length_certificate") or []
    place, limit = pressure_figures.shown_place(check, records), None
    if check is not None and check["limit"] is not None:
        limit = float(check["limit"])
    try:
        axial = pressure_figures.read_axial(file, material.turn.load_case, place)
    except ResultError as error:
        return (
            Picture(title, note=f"The pressure along the {follower} is not available: {error}."),
        )
    rows = final.cycle.of_load_case(axial.worst_case)
    at = int(np.argmin(np.abs(rows["cam_angle_deg"] - axial.worst_angle)))
    disc = "idle_" if pressure_figures.bears_less(records, axial) else ""
    names = f"{disc}p0_fe_MPa", f"{disc}p0_hertz_MPa"
    values = [float(rows[name][at]) for name in names if name in rows]
    centre = next((value for value in values if np.isfinite(value)), None)
    certified = pressure_figures.certified_pressure(records, axial, centre)
    tiers = (
        "half-spaces"
        if certified is None
        else "half-spaces, and at the greatest moment by finite elements with error bars"
    )
    mean = report_tables.quantity(axial.mean_length, "mm")
    peak = report_tables.quantity(axial.peak, "MPa")
    return (
        Picture(
            title,
            f"Left: at cam angle {axial.worst_angle:g} deg of load case {axial.worst_case}, by "
            f"{tiers}; maximum {peak}. Grey: the last {mean}, over which the pressure at a "
            "corner is averaged, since its peak there depends on the mesh. Right: load case "
            f"{material.turn.load_case} over the turn, at the greatest moment that the guides "
            "can hold.",
            f"Contact pressure over the axial position; maximum {peak}.",
            "axial-pressure",
            pressure_figures.drawn_axial(axial, limit, centre, certified),
        ),
    )


PICTURES: tuple[Callable[[ReportMaterial], Sequence[Picture]], ...] = (
    stress_pictures,
    axial_pictures,
    envelope_pictures,
    guide_pictures,
    pivot_pictures,
)
"""Pictures of the report, in this order."""


def pictures(material: ReportMaterial) -> list[Picture]:
    """Pictures of the report; those begun ahead are taken from their worker."""
    every: list[Picture] = []
    for draw in PICTURES:
        task = material.ahead.get(_key(draw, material))
        every += draw(material) if task is None else task.result()
    return every


def begun(material: ReportMaterial, workers: Crew) -> dict[str, PendingCall]:
    """Pictures independent of the certificate, submitted to workers, by kind and load case."""
    return {
        _key(draw, material): workers.submit(draw, material)
        for draw in PICTURES
        if draw is not axial_pictures  # it shows the certificate, which is not solved yet
    }


def _key(draw: Callable[[ReportMaterial], Sequence[Picture]], material: ReportMaterial) -> str:
    """Kind of a picture and its load case, on which alone of the checks it depends."""
    return f"{draw.__name__}: {material.turn.load_case}"


def write_pictures(
    draw: Callable[[ReportMaterial], Sequence[Picture]], material: ReportMaterial
) -> list[Path]:
    """Write ``figures/NAME.png`` of each picture that is available."""
    return [
        write_atomic(material.folder / FIGURES / f"{picture.name}.png", picture.png)
        for picture in draw(material)
        if picture.png
    ]
