"""Picture of an inspected cam: deviation, normal force, contact pressure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.tables import Table, read_table
from camwright.pipeline.results.run_reader import read_run
from camwright.reports.figure_svg import png, shipped

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_EXAGGERATED = 0.12
"""Maximum deviation as drawn on the contour, as a share of the mean radius."""


@shipped()
def draw(run: Path, tolerance_um: float, folder: Path) -> Path:
    """Write ``deviation.png`` of an inspection: deviation, normal force, contact pressure.

    Returns
    -------
    Path   the picture
    """
    from matplotlib.figure import Figure

    deviation, real = read_table(folder / "deviation.csv"), read_table(folder / "cycle.csv")
    nominal = read_run(run).final
    figure = Figure(figsize=(10, 8), layout="constrained")
    _deviation(figure.add_subplot(2, 2, 1), deviation, tolerance_um)
    _part(figure.add_subplot(2, 2, 2), nominal.contour, deviation)
    state = nominal.cycle.load_cases[0]
    for place, header, label in ((3, "normal_force_N", "normal force, N"),
                                 (4, "p0_fe_MPa", "peak contact pressure, MPa")):  # fmt: skip
        axes = figure.add_subplot(2, 2, place)
        for table, name, style in ((nominal.cycle, "drawing", "--"), (real, "measured", "-")):
            rows = table.of_load_case(state)
            axes.plot(rows["cam_angle_deg"], rows[header], style, lw=1, label=name)
        axes.set(xlabel="cam angle, deg", ylabel=label, xlim=(0, 360))
        axes.legend()
    return write_atomic(folder / "deviation.png", png(figure, 120))


def _deviation(axes: Axes, deviation: Table, tolerance_um: float) -> None:
    axes.plot(deviation["cam_angle_deg"], deviation["deviation_um"], ".", ms=2, label="measured")
    axes.plot(deviation["cam_angle_deg"], deviation["form_um"], lw=1, label="form")
    for side in (-0.5, 0.5):
        axes.axhline(side * tolerance_um, ls="--", lw=0.8, color="tab:red")
    axes.set(xlabel="cam angle, deg", ylabel="deviation, µm", xlim=(0, 360))
    axes.legend()


def _part(axes: Axes, contour: Table, deviation: Table) -> None:
    x, y = contour["contour_x_mm"], contour["contour_y_mm"]
    form = np.interp(contour["cam_angle_deg"], deviation["cam_angle_deg"], deviation["form_um"],
                     period=360.0)  # fmt: skip
    greatest = float(np.abs(form).max())
    scale = _EXAGGERATED * float(np.hypot(x, y).mean()) / greatest if greatest > 0 else 0.0
    axes.plot(x, y, "--", lw=0.8)
    axes.plot(x + scale * form * contour["normal_x"], y + scale * form * contour["normal_y"], lw=1)
    axes.set(xlabel="x, mm", ylabel=f"y, mm (deviation x {1e3 * scale:.3g})", aspect="equal")
