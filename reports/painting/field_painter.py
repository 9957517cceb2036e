"""Rasters of a field on triangles by VTK off screen: the child process of `field_picture`.

It imports little of this program, since each report starts it anew.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from camwright.pipeline.base.worker_processes import module_command
from camwright.reports.painting.matplotlib_import import import_matplotlib

PATIENCE_S = 120
_SCALARS = "values"


def paint(view: Mapping[str, NDArray[Any]]) -> NDArray[Any]:
    """Pixels (rows, columns, 3) of a field on triangles, rendered off-screen by VTK.

    Parameters
    ----------
    view : mapping
        points (2, n) and triangles (3, m) in the axes of the view; values (n,), within clim;
        lines (2, k) drawn black; window: xmin, xmax, ymin, ymax; size: pixels; log: colours;
        levels: of lines; colour_map: name
    """
    import_matplotlib()  # as pyvista does
    import pyvista

    xy = view["points"]
    points = np.column_stack([*xy, np.zeros(xy.shape[1])])
    surface = pyvista.PolyData.from_regular_faces(points, view["triangles"].T.astype(int))
    surface.point_data[_SCALARS] = view["values"]
    xmin, xmax, ymin, ymax = view["window"].tolist()
    plotter: Any = pyvista.Plotter(
        off_screen=True, window_size=view["size"].tolist(), lighting="none"
    )
    plotter.set_background("white")
    plotter.add_mesh(
        surface, scalars=_SCALARS, cmap=str(view["colour_map"]), clim=view["clim"].tolist(),
        log_scale=bool(view["log"]), n_colors=256, lighting=False, show_scalar_bar=False,
        interpolate_before_map=True,
    )  # fmt: skip
    lines = np.column_stack([np.full(view["lines"].shape[1], 2), view["lines"].T])
    edges = pyvista.PolyData(points, lines=lines)
    plotter.add_mesh(edges, color="black", line_width=2.0, lighting=False)
    if view["levels"].size:
        levels = surface.contour(view["levels"].tolist(), scalars=_SCALARS)
        if levels.n_points:
            plotter.add_mesh(levels, color="black", line_width=1.2, lighting=False, opacity=0.5)
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


def painted(folder: Path, count: int, window: str) -> bool:
    """Whether a child process has painted the views of a folder, see `main`, in time and without an
    error.

    Parameters
    ----------
    count : int    views, numbered from 0
    window : str   class of VTK's OpenGL window
    """
    try:
        child = subprocess.run(  # noqa: S603 - our own interpreter and module
            module_command(__name__, str(folder), str(count)),
            env=os.environ | {"VTK_DEFAULT_OPENGL_WINDOW": window}, check=False,
            capture_output=True, timeout=PATIENCE_S,
        )  # fmt: skip
    except (OSError, subprocess.TimeoutExpired):
        return False
    return child.returncode == 0


def main(arguments: Sequence[str]) -> int:
    """Child process: paint the views FOLDER/0.npz, FOLDER/1.npz ... into FOLDER/0.npy ..."""
    folder, count = Path(arguments[0]), int(arguments[1])
    for number in range(count):
        with np.load(folder / f"{number}.npz", allow_pickle=False) as view:
            np.save(folder / f"{number}.npy", paint(view))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
