"""Pictures of the stress field, rendered off screen by VTK.

Without an OpenGL device some drivers abort the process. Rendering therefore runs in a child process
(this module as a script); if it fails, matplotlib draws the field and the picture says so. The
child renders the raster only; axes, colour bar and scale bar are added afterwards.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import ResultError
from camwright.reports import field_raster
from camwright.reports.report_tables import Record

WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
PATIENCE_S = 120
COLOUR_MAP = "viridis"
CONTACT_REACH = 4.0
ISO_SHARE = (0.2, 0.4, 0.6, 0.8, 0.95)
DECADES = 3.2
FIELD = "von_mises_MPa"


@dataclass(frozen=True, eq=False)
class Field:
    """A stress field on six-node triangles: points (2, n) mm, triangles (6, m), values MPa.

    `displacement` (2, n) mm and `body` (n,) are zero if the file has none; `notes` are the scalars
    of the file, such as ``half_width_mm``.
    """

    points: Array
    triangles: NDArray[np.int64]
    von_mises: Array
    displacement: Array
    body: Array
    notes: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class View:
    """View of a field; lengths in mm.

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
    """Pixels (rows, columns, 3) of a view; `note` states why it is not rendered by VTK."""

    view: View
    pixels: Array
    note: str = ""


def read_field(vtu: Path) -> Field:
    """The field of a VTU file.

    Raises
    ------
    ResultError
        If the file is absent, unreadable, or has no von Mises stress on triangles.
    """
    import pyvista

    if not vtu.is_file():
        raise ResultError(f"{vtu.name}: no such file")
    grid = pyvista.read(vtu)
    if FIELD not in grid.point_data or not grid.n_cells:
        raise ResultError(f"{vtu.name}: no point data {FIELD}")
    cells = next((c for c in grid.cells_dict.values() if c.shape[1] in (3, 6)), None)
    if cells is None:
        raise ResultError(f"{vtu.name}: no triangles")
    zeros = np.zeros((grid.n_points, 3))
    data = grid.point_data
    shift = np.asarray(data["displacement_mm"]) if "displacement_mm" in data else zeros
    body = np.asarray(data["body"]) if "body" in data else zeros[:, 0]
    notes = {
        str(name): float(np.ravel(grid.field_data[name])[0])
        for name in grid.field_data
        if np.size(grid.field_data[name]) == 1
    }
    return Field(
        np.asarray(grid.points, dtype=float).T[:2],
        np.asarray(cells).T,
        np.asarray(data[FIELD], dtype=float),
        np.asarray(shift, dtype=float).T[:2],
        np.asarray(body, dtype=float),
        notes,
    )


def find_contact(field: Field) -> tuple[Array, Array]:
    """Contact point and unit normal towards the follower, each (2,).

    Both are notes of the file. In files without them the roller is the smaller body, a circle about
    the centre of its extent, and the contact is the nearest point of the other body.

    Raises
    ------
    ResultError
        If the field does not hold two bodies.
    """
    names = ("contact_x_mm", "contact_y_mm", "normal_x", "normal_y")
    if all(name in field.notes for name in names):
        x, y, nx, ny = (field.notes[name] for name in names)
        return np.array([x, y]), np.array([nx, ny]) / np.hypot(nx, ny)
    marks = np.unique(field.body)
    if marks.size != 2:
        raise ResultError(f"the field holds {marks.size} bodies, must be 2")
    parts = [field.points[:, field.body == mark] for mark in marks]
    extents = [np.ptp(part, axis=1) for part in parts]
    roller = int(np.argmin([e.max() for e in extents]))
    centre = (parts[roller].min(axis=1) + parts[roller].max(axis=1)) / 2
    away = parts[1 - roller] - centre[:, None]
    nearest = int(np.argmin(np.hypot(*away)))
    point = parts[1 - roller][:, nearest]
    normal = centre - point
    return point, normal / np.hypot(*normal)


def contact_view(field: Field, half_width: float, point: Array, normal: Array) -> View:
    """View of four half-widths on either side of the contact, follower above."""
    away = np.hypot(*(field.points - point[:, None]))
    peak = float(field.von_mises[away < CONTACT_REACH * half_width].max(initial=1e-9))
    reach = CONTACT_REACH * half_width
    return View(
        (float(point[0]), float(point[1])), (float(normal[0]), float(normal[1])),
        (-reach, reach, -0.75 * reach, 0.75 * reach), (0.0, peak), log=False,
        iso=tuple(peak * share for share in ISO_SHARE), anchor=(float(point[0]), float(point[1])),
    )  # fmt: skip


def body_view(field: Field) -> View:
    """View of cam and follower in the frame of the file, logarithmic colours."""
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
    """The contact raster in axes of half-widths; `name` is the upper body."""
    extent = tuple(edge / half_width_mm for edge in raster.view.window)
    return field_raster.framed(
        raster.pixels, (extent[0], extent[1], extent[2], extent[3]),
        ("along the contact, x / a", "along the normal, z / a"), "von Mises stress, MPa",
        COLOUR_MAP, raster.view.clim, raster.view.log, (1.0, f"a = {half_width_mm:.3g} mm"),
        ((name, 0.97), ("cam", 0.40)), above,
    )  # fmt: skip


def frame_body(raster: Raster) -> bytes:
    """The body raster in axes of mm in the frame of the file."""
    x, y = raster.view.centre
    xmin, xmax, ymin, ymax = raster.view.window
    return field_raster.framed(
        raster.pixels, (xmin + x, xmax + x, ymin + y, ymax + y), ("x, mm", "y, mm"),
        "von Mises stress, MPa (logarithmic)", COLOUR_MAP, raster.view.clim, raster.view.log, None,
    )  # fmt: skip


def render(vtu: Path, views: Sequence[View]) -> list[Raster]:
    """Rasters of the views by the first OpenGL window that works, else by matplotlib."""
    for window in WINDOWS:
        with tempfile.TemporaryDirectory() as name:
            out = Path(name)
            (out / "views.json").write_text(json.dumps([asdict(view) for view in views]))
            try:
                child = subprocess.run(  # noqa: S603 - our own interpreter and module
                    [sys.executable, "-m", __name__, str(vtu.resolve()), str(out)],
                    env=os.environ | {"VTK_DEFAULT_OPENGL_WINDOW": window}, check=False,
                    capture_output=True, timeout=PATIENCE_S,
                )  # fmt: skip
            except (OSError, subprocess.TimeoutExpired):
                continue
            if child.returncode == 0:
                pixels = [np.load(out / f"{number}.npy") for number in range(len(views))]
                return [Raster(view, image) for view, image in zip(views, pixels, strict=True)]
    return [flat(read_field(vtu), view) for view in views]


def flat(field: Field, view: View) -> Raster:
    """A view drawn by matplotlib, each six-node triangle as four straight ones."""
    corners = field.triangles[[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]] if len(
        field.triangles
    ) == 6 else field.triangles[None]  # fmt: skip
    straight = np.concatenate(list(corners), axis=1)
    placed = view.placed(deformed(field, view))
    xmin, xmax, ymin, ymax = view.window
    x, y = placed[:, straight]
    seen = (x.max(0) > xmin) & (x.min(0) < xmax) & (y.max(0) > ymin) & (y.min(0) < ymax)
    pixels = field_raster.triangles_picture(
        placed, straight[:, seen], field.von_mises, view.window, view.clim, view.log, COLOUR_MAP
    )
    return Raster(view, pixels, "No OpenGL device is available; drawn by matplotlib.")


def deformed(field: Field, view: View) -> Array:
    """Points (2, n) displaced at true scale relative to the anchor; undeformed without anchor."""
    if view.anchor is None:
        return field.points
    away = np.hypot(*(field.points - np.array(view.anchor)[:, None]))
    held = field.displacement[:, int(np.argmin(away))]
    return field.points + field.displacement - held[:, None]


def _paint(field: Field, view: View) -> Array:
    """Render one view, in the child process."""
    import pyvista

    nodes = len(field.triangles)
    xy = view.placed(deformed(field, view))
    cells = np.hstack([np.full((field.triangles.shape[1], 1), nodes), field.triangles.T])
    kind = pyvista.CellType.QUADRATIC_TRIANGLE if nodes == 6 else pyvista.CellType.TRIANGLE
    grid = pyvista.UnstructuredGrid(
        cells.ravel(), np.full(len(cells), kind), np.column_stack([*xy, np.zeros(xy.shape[1])])
    )
    grid.point_data[FIELD] = np.clip(field.von_mises, *view.clim)
    xmin, xmax, ymin, ymax = view.window
    width, height = view.size
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[width, height], lighting="none")
    plotter.set_background("white")
    surface = grid.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface")
    plotter.add_mesh(
        surface, scalars=FIELD, cmap=COLOUR_MAP, clim=view.clim, log_scale=view.log, n_colors=256,
        lighting=False, show_scalar_bar=False, interpolate_before_map=True,
    )  # fmt: skip
    edges = surface.extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    plotter.add_mesh(edges, color="black", line_width=2.0, lighting=False)
    if view.iso:
        lines = surface.contour(list(view.iso), scalars=FIELD)
        if lines.n_points:
            plotter.add_mesh(lines, color="black", line_width=1.2, lighting=False, opacity=0.5)
    plotter.enable_anti_aliasing("ssaa")
    plotter.enable_parallel_projection()
    middle = ((xmin + xmax) / 2, (ymin + ymax) / 2)
    plotter.camera.position = (*middle, 100.0)
    plotter.camera.focal_point = (*middle, 0.0)
    plotter.camera.up = (0.0, 1.0, 0.0)
    plotter.camera.parallel_scale = (ymax - ymin) / 2
    plotter.camera.clipping_range = (1.0, 200.0)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    return np.asarray(image)[..., :3]


def main(arguments: Sequence[str]) -> int:
    """Child process: render the views of OUT/views.json into OUT/0.npy, OUT/1.npy ..."""
    vtu, out = Path(arguments[0]), Path(arguments[1])
    field = read_field(vtu)
    for number, record in enumerate(json.loads((out / "views.json").read_text())):
        values: Record = {k: tuple(v) if isinstance(v, list) else v for k, v in record.items()}
        np.save(out / f"{number}.npy", _paint(field, View(**values)))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
