"""The pictures of a report: what they show, in words, and where they lie."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path

from geometry.errors import ResultError
from reports import envelope, scene, tables
from reports.output import write_whole
from reports.sheet import Turn

FIELD = Path("fields") / "contact_worst.vtu"


@dataclass(frozen=True, eq=False)
class Picture:
    """A raster on the page, or the words that stand in its place."""

    title: str
    caption: str
    alt: str
    data: str = ""
    note: str = ""


def drawn_pictures(turn: Turn, trial: Path, folder: Path) -> list[Picture]:
    """All pictures of a run, drawn into ``figures/``; words where a picture cannot be drawn."""
    return _fields(turn, folder) + _envelope(turn, trial, folder)


def _fields(turn: Turn, folder: Path) -> list[Picture]:
    """The stress field under the roller and in the whole cam."""
    try:
        field = scene.read_field(folder / FIELD)
        point, normal = scene.find_contact(field)
        half_width = field.notes.get("half_width_mm") or turn.half_width
        views = [scene.contact_view(field, half_width, point, normal), scene.body_view(field)]
        rasters = scene.render(folder / FIELD, views)
    except ResultError as error:
        return [Picture("Stress field", "", "", note=f"There is no picture of the field: {error}.")]
    framed = (scene.frame_contact(rasters[0], half_width), scene.frame_body(rasters[1]))
    for name, png in zip(("field-contact", "field-body"), framed, strict=True):
        write_whole(folder / "figures" / f"{name}.png", png)
    given = field.notes.get("cam_angle_deg", turn.columns["cam_angle_deg"][turn.worst])
    angle = tables.number(float(given))
    peak = tables.quantity(views[0].clim[1], "MPa")
    return [
        Picture(
            "Von Mises stress under the roller",
            f"At {angle} deg of the cam, where the contact pressure is greatest. Lengths count "
            f"half-widths; lines at 20, 40, 60, 80 and 95 % of the greatest, {peak}. "
            "Shapes are deformed at true scale.",
            f"Von Mises stress within four half-widths of the contact; greatest value {peak}.",
            base64.b64encode(framed[0]).decode(), rasters[0].note,
        ),
        Picture(
            "Von Mises stress in the whole cam",
            f"The same angle; colours are logarithmic over {scene.DECADES:g} decades, and what "
            "lies below is shown in the darkest one.",
            "Von Mises stress in the whole cam and roller on a logarithmic scale.",
            base64.b64encode(framed[1]).decode(), rasters[1].note,
        ),
    ]  # fmt: skip


def _envelope(turn: Turn, trial: Path, folder: Path) -> list[Picture]:
    """The map of greatest stresses under the contour; older runs have none."""
    if not (trial / envelope.FILE).exists():
        return []
    title = "Greatest stress under the contour in one turn"
    try:
        found = envelope.read_envelope(trial / envelope.FILE, turn.load_case)
    except ResultError as error:
        return [Picture(title, "", "", note=f"There is no map of the turn: {error}.")]
    png = envelope.drawn(found)
    write_whole(folder / "figures" / "envelope.png", png)
    mises, angle, depth = envelope.worst(found, "von_mises_MPa")
    where = (
        f"{tables.quantity(mises, 'MPa')} of von Mises stress at {tables.number(angle)} deg of "
        f"the cam, {tables.quantity(depth, 'mm')} deep"
    )
    return [
        Picture(
            title,
            f"The contour unrolled, with what each place of the material bears as the load rolls "
            f"over it; greatest {where}. Where the map is brightest the cam will pit first.",
            f"Maps of von Mises stress and shear range by cam angle and depth; greatest {where}.",
            base64.b64encode(png).decode(),
        )
    ]
