"""Pictures of the stress field, rendered off-screen by VTK.

Without an OpenGL device some drivers abort the process. Rendering therefore runs in a child process
(`field_painter`); if it fails, matplotlib draws the field and the picture says so. The child
renders the raster only; axes, colour bar and scale bar are added afterwards.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import npz_bytes
from camwright.pipeline.results.field_file import ZONE, FieldStep, read_series
from camwright.reports import field_raster
from camwright.reports.painting import field_painter

WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
COLOUR_MAP = "viridis"
CONTACT_REACH = 4.0
ISO_SHARE = (0.2, 0.4, 0.6, 0.8, 0.95)
DECADES = 3.2
FIELD = "von_mises_MPa"
_CONTACT = ("contact_x_mm", "contact_y_mm", "normal_x", "normal_y")


@dataclass(frozen=True, eq=False)
class Field:
    """Stress field: points (2, n) mm, triangles (3, m), values MPa, displacement (2, n) mm.

    outline (2, k): edges of the bodies; body (n,): 0 cam, 1 follower; `notes` are the data of the
    cam angle, such as ``half_width_mm``.
    """

    points: Array
    triangles: NDArray[np.int64]
    von_mises: Array
    displacement: Array
    body: Array
    outline: NDArray[np.int64]
    notes: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class View:
    """View of a field: window and colour scale; lengths in mm.

    The axes of the view have their origin at `centre` and their y axis along `normal`; `window` is
    (xmin, xmax, ymin, ymax) in these axes. Colours cover `clim`, MPa; `iso` are levels of lines.
    The displacement is shown relative to that of `anchor`; None: undeformed.
    """

    centre: tuple[float, float]
    normal: tuple[float, float]
    window: tuple[float, float, float, float]
    clim: tuple[float, float]
    log: bool
    iso: tuple[float, ...] = ()
    anchor: tuple[float, float] | None = None
    pixels: int = 1200

    @property
    def size(self) -> tuple[int, int]:
        xmin, xmax, ymin, ymax = self.window
        return self.pixels, round(self.pixels * (ymax - ymin) / (xmax - xmin))

    def turned(self, vectors: Array) -> Array:
        """Vectors (2, n) in the axes of the view."""
        nx, ny = self.normal
        return np.array([[ny, -nx], [nx, ny]]) @ vectors

    def placed(self, points: Array) -> Array:
        """Points (2, n) in the axes of the view."""
        return self.turned(points - np.array(self.centre)[:, None])


@dataclass(frozen=True, eq=False)
class Raster:
    """Pixels (rows, columns, 3) of a view; `note`: why VTK did not render it."""

    view: View
    pixels: Array
    note: str = ""


def read_field(path: Path) -> Field:
    """Stress field of a run at the cam angle of the highest Hertzian pressure.

    Parameters
    ----------
    path : path   field file of the run

    Raises
    ------
    ResultError
        If the file is absent, unreadable or no stress field.
    """
    series = read_series(path)
    try:
        number = int(np.nanargmax(series.notes["p0_hertz_MPa"]))
        blocks = series.step(number)
        first, parts, start = next(iter(blocks)), [], 0
        for name, step in blocks.items():
            parts.append((
                step.points, start + step.triangles[:, ~step.hidden], step.data[FIELD],
                step.data["displacement_mm"].T[:2],
                np.full(step.points.shape[1], float(name.removesuffix(ZONE) != first)),
                start + (_surface(step) if name.endswith(ZONE) else _outline(step)),
            ))  # fmt: skip
            start += step.points.shape[1]
    except (KeyError, ValueError, IndexError, StopIteration) as error:
        raise ResultError(f"{path.name}: no stress field ({error})") from None
    notes = {n: float(v[number]) for n, v in series.notes.items() if v.dtype.kind == "f"}
    points, triangles, mises, moved, body, outline = (
        np.concatenate(each, axis=-1) for each in zip(*parts, strict=True)
    )
    return Field(points, triangles, mises, moved, body, outline, notes)


def _outline(step: FieldStep) -> NDArray[np.int64]:
    """Edges (2, k) of the outer boundary of a body as numbers of nodes, without those of hidden
    triangles.
    """
    edges = np.stack([step.triangles, np.roll(step.triangles, -1, axis=0)]).reshape(2, -1)
    _, first, count = np.unique(
        np.sort(edges, axis=0), axis=1, return_index=True, return_counts=True
    )
    outer = first[count == 1]
    return edges[:, outer[~np.tile(step.hidden, 3)[outer]]]


def _surface(step: FieldStep) -> NDArray[np.int64]:
    """Edges (2, k) of the mesh below a contact, without its arc."""
    edges = _outline(step)
    # Nodes of a ring follow one another; edges along the surface lead to the next ring.
    return edges[:, (np.abs(edges[0] - edges[1]) > 1) | (edges == 0).any(axis=0)]


def stated(field: Field, name: str) -> float:
    """Number that the field file states at its cam angle; ResultError without it."""
    try:
        return field.notes[name]
    except KeyError:
        raise ResultError(f"the field does not state {name}") from None


def find_contact(field: Field) -> tuple[Array, Array]:
    """Contact point and unit normal towards the follower, each (2,).

    Raises
    ------
    ResultError
        If the file states neither.
    """
    x, y, nx, ny = (stated(field, name) for name in _CONTACT)
    return np.array([x, y]), np.array([nx, ny]) / np.hypot(nx, ny)


def contact_view(field: Field, half_width: float, point: Array, normal: Array) -> View:
    """View of `CONTACT_REACH` half-widths on either side of the contact, the follower above;
    colours and iso lines go up to the greatest stress in this reach.

    Parameters
    ----------
    half_width : float    of the contact, mm
    point : array (2,)    middle of the contact, mm
    normal : array (2,)   unit normal there, from the cam to the follower
    """
    away = np.hypot(*(field.points - point[:, None]))
    peak = float(field.von_mises[away < CONTACT_REACH * half_width].max(initial=1e-9))
    reach = CONTACT_REACH * half_width
    return View(
        (float(point[0]), float(point[1])), (float(normal[0]), float(normal[1])),
        (-reach, reach, -0.75 * reach, 0.75 * reach), (0.0, peak), log=False,
        iso=tuple(peak * share for share in ISO_SHARE), anchor=(float(point[0]), float(point[1])),
    )  # fmt: skip


def body_view(field: Field) -> View:
    """View of both bodies as a whole in the frame of the file, undeformed, with logarithmic
    colours.
    """
    low, high = field.points.min(axis=1), field.points.max(axis=1)
    centre, half = (low + high) / 2, 0.53 * (high - low)
    peak = float(field.von_mises.max(initial=1e-9))
    return View(
        (float(centre[0]), float(centre[1])), (0.0, 1.0),
        (-float(half[0]), float(half[0]), -float(half[1]), float(half[1])),
        (peak * 10**-DECADES, peak), log=True,
    )  # fmt: skip


def frame_contact(
    raster: Raster,
    half_width_mm: float,
    name: str = "roller",
    above: field_raster.Above | None = None,
) -> bytes:
    """Contact raster in axes of half-widths and mm; `name`: the upper body."""
    extent = tuple(edge / half_width_mm for edge in raster.view.window)
    return field_raster.framed(
        raster.pixels, (extent[0], extent[1], extent[2], extent[3]),
        ("along the contact, x / a", "along the normal, z / a"), "von Mises stress, MPa",
        COLOUR_MAP, raster.view.clim, raster.view.log, (1.0, f"a = {half_width_mm:.3g} mm"),
        ((name, 0.97), ("cam", 0.40)), above, half_width_mm,
    )  # fmt: skip


def frame_body(raster: Raster) -> bytes:
    """Body raster in axes of mm, in the file's frame."""
    x, y = raster.view.centre
    xmin, xmax, ymin, ymax = raster.view.window
    return field_raster.framed(
        raster.pixels, (xmin + x, xmax + x, ymin + y, ymax + y), ("x, mm", "y, mm"),
        "von Mises stress, MPa (logarithmic)", COLOUR_MAP, raster.view.clim, raster.view.log, None,
    )  # fmt: skip


def render(field: Field, views: Sequence[View]) -> list[Raster]:
    """Rasters of the views by the first working OpenGL window, else by matplotlib."""
    for window in WINDOWS:
        with tempfile.TemporaryDirectory() as name:
            out = Path(name)
            for number, view in enumerate(views):
                arrays = npz_bytes(_painted(field, view), compressed=False)
                (out / f"{number}.npz").write_bytes(arrays)
            if field_painter.painted(out, len(views), window):
                pixels = [np.load(out / f"{number}.npy") for number in range(len(views))]
                return [Raster(view, image) for view, image in zip(views, pixels, strict=True)]
    return [flat(field, view) for view in views]


def _painted(field: Field, view: View) -> dict[str, NDArray[Any]]:
    """What the child paints of a view; see `field_painter.paint`."""
    return {
        "points": view.placed(deformed(field, view)), "triangles": field.triangles,
        "values": np.clip(field.von_mises, *view.clim), "lines": field.outline,
        "window": np.array(view.window), "size": np.array(view.size), "clim": np.array(view.clim),
        "log": np.array(view.log), "levels": np.array(view.iso), "colour_map": np.array(COLOUR_MAP),
    }  # fmt: skip


def flat(field: Field, view: View) -> Raster:
    """Raster of a view drawn by matplotlib, where no OpenGL window works."""
    straight = field.triangles
    placed = view.placed(deformed(field, view))
    xmin, xmax, ymin, ymax = view.window
    x, y = placed[:, straight]
    seen = (x.max(0) > xmin) & (x.min(0) < xmax) & (y.max(0) > ymin) & (y.min(0) < ymax)
    pixels = field_raster.triangles_picture(
        placed, straight[:, seen], field.von_mises, view.window, view.clim, view.log, COLOUR_MAP
    )
    return Raster(view, pixels, "No OpenGL device is available; drawn by matplotlib.")


def deformed(field: Field, view: View) -> Array:
    """Points (2, n) with their displacements at true scale, mm, less the displacement of the point
    nearest the anchor of the view; undeformed without an anchor.
    """
    if view.anchor is None:
        return field.points
    away = np.hypot(*(field.points - np.array(view.anchor)[:, None]))
    held = field.displacement[:, int(np.argmin(away))]
    return field.points + field.displacement - held[:, None]
