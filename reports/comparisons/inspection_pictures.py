"""Picture of an inspected cam: deviation, part, normal force, contact pressure."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from camwright.geometry.figures import (
    Curve,
    Figure,
    HorizontalAxis,
    LimitLine,
    Panel,
    closed,
    outline,
    outline_panel,
)
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.tables import Table, read_table
from camwright.pipeline.results.run_reader import read_run
from camwright.reports.figure_svg import png_of

_EXAGGERATED = 0.12
"""Maximum deviation as drawn on the contour, as a share of the mean radius."""
_WIDTH = 10.0  # in


def draw(run: Path, tolerance_um: float, folder: Path) -> Path:
    """Write ``deviation.png`` of an inspection: deviation, normal force, contact pressure.

    Returns
    -------
    Path   the picture
    """
    picture = png_of(figure_of(run, tolerance_um, folder), _WIDTH)
    return write_atomic(folder / "deviation.png", picture)


def figure_of(run: Path, tolerance_um: float, folder: Path) -> Figure:
    """Panels of an inspected cam: measured deviation and form, um; contour, normal force, N, and
    contact pressure, MPa, of the drawn and of the inspected cam.

    Parameters
    ----------
    run : path             run folder of the drawn cam
    tolerance_um : float   width of the tolerance zone, half to each side of the contour, um
    folder : path          folder of the inspection, with ``deviation.csv`` and ``cycle.csv``
    """
    deviation, real = read_table(folder / "deviation.csv"), read_table(folder / "cycle.csv")
    nominal = read_run(run).final
    state = nominal.cycle.load_cases[0]
    angle = deviation["cam_angle_deg"]
    band = tuple(LimitLine(side * tolerance_um, "limit") for side in (0.5, -0.5))
    panels = [
        Panel("deviation", "µm", (
            Curve(angle, deviation["deviation_um"], "measured", "sky", "points"),
            Curve(angle, deviation["form_um"], "form", "vermillion"),
        ), band, height=1.6),
        _part(deviation),
    ]  # fmt: skip
    for header, quantity, unit in (("normal_force_N", "normal force", "N"),
                                   ("p0_fe_MPa", "peak contact pressure", "MPa")):  # fmt: skip
        drawn, made = (table.of_load_case(state) for table in (nominal.cycle, real))
        curves = (Curve(drawn["cam_angle_deg"], drawn[header], "drawing", look="dashed"),
                  Curve(made["cam_angle_deg"], made[header], "measured", "vermillion"))  # fmt: skip
        panels.append(Panel(quantity, unit, curves, height=1.6))
    axis = HorizontalAxis("cam angle", "deg", (0.0, 360.0), 90.0)
    return Figure("inspection", "Inspected cam", "", tuple(panels), axis, columns=2)


def _part(deviation: Table) -> Panel:
    """Panel of the nominal surface and of the inspected one, whose form deviation is exaggerated
    along the normals.

    Parameters
    ----------
    deviation : Table   nominal points, mm, with their normals and the form deviation, um, positive
                        out of the material
    """
    drawn, normal = (
        np.array([deviation[name] for name in names])
        for names in (("nominal_x_mm", "nominal_y_mm"), ("normal_x", "normal_y"))
    )
    form = deviation["form_um"]
    greatest = float(np.abs(form).max())
    scale = _EXAGGERATED * float(np.hypot(*drawn).mean()) / greatest if greatest > 0 else 0.0
    part = drawn + scale * form * normal
    return outline_panel((
        outline(closed(drawn), "drawing", look="dashed"),
        outline(closed(part), f"form, deviation x {1e3 * scale:.3g}", "vermillion"),
    ))  # fmt: skip
