"""The pictures of a report: what they show, in words, and where they lie."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.reports import (
    field_picture,
    field_raster,
    guide_pressure_figure,
    report_tables,
    stress_map,
)
from camwright.reports.report_data import FIGURES, Material

FIELD = Path("fields") / "contact_worst.vtu"


@dataclass(frozen=True, eq=False)
class Picture:
    """A raster on the page, or the words that stand in its place.

    `name` is that of its file in ``figures/``; a picture that could not be drawn has no `png`
    and says why in its `note`.
    """

    title: str
    caption: str = ""
    alt: str = ""
    name: str = ""
    png: bytes = b""
    note: str = ""

    @property
    def data(self) -> str:
        """The picture in base64, for a page."""
        return base64.b64encode(self.png).decode()


@lru_cache(maxsize=1)
def stress_pictures(material: Material) -> Sequence[Picture]:
    """The stress field under the follower and in the whole cam."""
    turn, vtu = material.turn, material.folder / FIELD
    try:
        field = field_picture.read_field(vtu)
        point, normal = field_picture.find_contact(field)
        half_width = field.notes.get("half_width_mm") or turn.half_width
        views = [
            field_picture.contact_view(field, half_width, point, normal),
            field_picture.body_view(field),
        ]
        rasters = field_picture.render(vtu, views)
    except ResultError as error:
        return (Picture("Stress field", note=f"There is no picture of the field: {error}."),)
    given = field.notes.get("cam_angle_deg", turn.columns["cam_angle_deg"][turn.worst])
    angle = report_tables.number(float(given))
    peak = report_tables.quantity(views[0].clim[1], "MPa")
    final = material.run.final
    above = field_raster.over_the_contact(
        final.path / field_raster.PRESSURE, final.cycle, float(given), half_width
    )
    return (
        Picture(
            f"Contact pressure and von Mises stress under the {turn.follower_name}",
            f"At {angle} deg of the cam, where the contact pressure is greatest. Lengths count "
            f"half-widths; lines at 20, 40, 60, 80 and 95 % of the greatest, {peak}. "
            "Shapes are deformed at true scale.",
            f"Von Mises stress within four half-widths of the contact; greatest value {peak}.",
            "field-contact",
            field_picture.frame_contact(rasters[0], half_width, turn.follower_name, above),
            rasters[0].note,
        ),
        Picture(
            "Von Mises stress in the whole cam",
            f"The same angle; colours are logarithmic over {field_picture.DECADES:g} decades, and "
            "what lies below is shown in the darkest one.",
            f"Von Mises stress in the whole cam and {turn.follower_name} on a logarithmic scale.",
            "field-body", field_picture.frame_body(rasters[1]), rasters[1].note,
        ),
    )  # fmt: skip


@lru_cache(maxsize=1)
def envelope_pictures(material: Material) -> Sequence[Picture]:
    """The map of greatest stresses under the contour; older runs have none."""
    file = material.run.final.path / stress_map.FILE
    if not file.exists():
        return ()
    title = "Greatest stress under the contour in one turn"
    try:
        found = stress_map.read_envelope(file, material.turn.load_case)
    except ResultError as error:
        return (Picture(title, note=f"There is no map of the turn: {error}."),)
    contour = material.run.final.contour.columns
    shape = (
        contour["cam_angle_deg"],
        np.stack([contour["contour_x_mm"], contour["contour_y_mm"]]),
        np.stack([contour["normal_x"], contour["normal_y"]]),
    )
    mises, angle, depth = stress_map.worst(found, "von_mises_MPa")
    where = (
        f"{report_tables.quantity(mises, 'MPa')} of von Mises stress at "
        f"{report_tables.number(angle)} deg of the cam, {report_tables.quantity(depth, 'mm')} deep"
    )
    return (
        Picture(
            title,
            f"The contour unrolled, with what each place of the material bears as the load rolls "
            f"over it; greatest {where}. Where the map is brightest the cam will pit first.",
            f"Maps of von Mises stress and shear range by cam angle and depth; greatest {where}.",
            "envelope",
            stress_map.drawn(found),
        ),
        Picture(
            "The same map in its place along the contour",
            "Von Mises stress; angles are those of the cam, depths are drawn larger than they are.",
            f"Map of von Mises stress as a band along the contour; greatest {where}.",
            "envelope-contour",
            stress_map.around(found, *shape),
        ),
    )


@lru_cache(maxsize=1)
def bush_pictures(material: Material) -> Sequence[Picture]:
    """The pressure in both guides; older runs kept none."""
    file = material.run.final.path / guide_pressure_figure.FILE
    if not file.exists():
        return ()
    title = "Pressure in the guides"
    try:
        found = guide_pressure_figure.read_bushes(file, material.turn.load_case)
    except ResultError as error:
        return (Picture(title, note=f"There is no picture of the guides: {error}."),)
    peaks = ", ".join(
        f"guide {bush.name} {report_tables.quantity(bush.peak, 'MPa')} at "
        f"{report_tables.number(bush.worst_angle)} deg of the cam" for bush in found
    )  # fmt: skip
    return (
        Picture(
            title,
            "Left the guide's push on the stem per length over the turn; in the middle the "
            "pressure all round the bore at the angle where it is greatest (dashed on the left), "
            "0 deg facing the side force; right the slice with the greatest pressure, drawn "
            f"outwards from the bore. Greatest: {peaks}. At a mouth with a sharp edge the "
            "pressure is that of a bush whose slices do not help one another.",
            f"Maps of the pressure in both guides; greatest {peaks}.",
            "bush-pressure",
            guide_pressure_figure.drawn(found),
        ),
    )


PICTURES: tuple[Callable[[Material], Sequence[Picture]], ...] = (
    stress_pictures,
    envelope_pictures,
    bush_pictures,
)
"""What the page shows beside the plots, in this order."""


def write_pictures(draw: Callable[[Material], Sequence[Picture]], material: Material) -> list[Path]:
    """Write ``figures/NAME.png`` for each picture that could be drawn."""
    return [
        write_atomic(material.folder / FIGURES / f"{picture.name}.png", picture.png)
        for picture in draw(material)
        if picture.png
    ]
