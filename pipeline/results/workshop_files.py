"""Workshop files: contour table, drawing, solid, cutter path, inspection sheet."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.cad_drawing import Outline, write_dxf
from camwright.geometry.contour import Contour
from camwright.geometry.cutter_path import cutter_path
from camwright.geometry.errors import CamError
from camwright.meshes.step_solid import write_step
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.tables import Column, table
from camwright.pipeline.case.case import Case
from camwright.pipeline.cycle.cam_balance import drilled_hole

_CONTOUR = (
    Column("cam_angle", "deg"), Column("polar_angle", "deg"), Column("radius", "mm"),
    Column("x", "mm"), Column("y", "mm"), Column("normal_x", ""), Column("normal_y", ""),
    Column("curvature", "1/mm"), Column("pressure_angle", "deg"), Column("lift", "mm"),
    Column("lift_d1", "mm/rad"), Column("lift_d2", "mm/rad^2"), Column("lift_d3", "mm/rad^3"),
)  # fmt: skip
_CUTTER = (
    Column("cam_angle", "deg"), Column("x", "mm"), Column("y", "mm"),
    Column("path_radius", "mm"), Column("tool_radius", "mm"),
)  # fmt: skip
_INSPECTION = (
    "cam_angle_deg", "polar_angle_deg", "nominal_radius_mm", "nominal_x_mm", "nominal_y_mm",
    "normal_x", "normal_y", "deviation_min_mm", "deviation_max_mm",
    "measured_x_mm", "measured_y_mm", "deviation_mm",
)  # fmt: skip

WORKSHOP = "workshop"


def outline_of(case: Case, contour: Contour) -> Outline:
    """Contour, bore, keyway and counter-hole of a case."""
    cam = case.cam
    return Outline(contour, cam.bore_radius, cam.keyway, drilled_hole(cam, contour))


def write_workshop(
    folder: Path,
    case: Case,
    contour: Contour,
    note: Callable[[str], None] = lambda _: None,
) -> None:
    """Write ``contour.csv``, ``contour.dxf``, ``cam.step``, ``cutter.csv``, ``inspection.csv``.

    A file that the contour does not allow, such as the path of a tool larger than a hollow, is
    left out and `note` is told why; all others are written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    outline, order = outline_of(case, contour), case.workshop_order
    tool = order.tool_radius or contour.fitting_tool
    jobs: dict[str, Callable[[Path], object]] = {
        "contour.csv": lambda path: write_atomic(path, contour_table(contour, order.theta)),
        "contour.dxf": lambda path: write_dxf(path, outline, order.chord_error),
        "cam.step": lambda path: write_step(path, outline, case.cam.width),
        "cutter.csv": lambda path: write_atomic(path, cutter_table(contour, tool, order.theta)),
        "inspection.csv": lambda path: write_atomic(
            path, inspection_sheet(contour, order.theta, order.tolerance)
        ),
    }
    for name, write in jobs.items():
        try:
            write(folder / name)
        except CamError as error:
            (folder / name).unlink(missing_ok=True)
            note(f"{WORKSHOP}/{name} is left out: {error}")


def contour_table(contour: Contour, theta: Array) -> str:
    """CSV of the contour and the lift behind it, a row per angle."""
    x, y = contour.points(theta)
    normal = contour.normal(theta)
    lift = contour.pitch.lift.derivatives(theta, 3)
    values = {
        "cam_angle": theta,
        "polar_angle": np.mod(np.arctan2(y, x), 2 * np.pi),
        "radius": np.hypot(x, y),
        "x": x,
        "y": y,
        "normal_x": normal[0],
        "normal_y": normal[1],
        "curvature": contour.curvature(theta),
        "pressure_angle": contour.pitch.pressure_angle(theta),
        **{name: lift[k] for k, name in enumerate(("lift", "lift_d1", "lift_d2", "lift_d3"))},
    }
    return table(_CONTOUR, values).to_csv()


def cutter_table(contour: Contour, tool_radius: float, theta: Array) -> str:
    """CSV of the tool's centre in the cam frame."""
    path = cutter_path(contour, tool_radius, theta)
    values = {
        "cam_angle": path.theta,
        "x": path.centre[0],
        "y": path.centre[1],
        "path_radius": path.radius_of_curvature,
        "tool_radius": np.full(theta.size, tool_radius),
    }
    return table(_CUTTER, values).to_csv()


def inspection_sheet(contour: Contour, theta: Array, tolerance: float) -> str:
    """CSV of nominal points with a tolerance band along the normal, measured columns empty."""
    x, y = contour.points(theta) * 1e3
    normal = contour.normal(theta)
    polar = np.degrees(np.mod(np.arctan2(y, x), 2 * np.pi))
    half = np.full(theta.size, 0.5e3 * tolerance)
    angle = np.round(np.degrees(theta), 10)
    columns = (angle, polar, np.hypot(x, y), x, y, normal[0], normal[1], -half, half)
    rows = [
        ",".join([*(repr(float(value)) for value in row), "", "", ""])
        for row in zip(*columns, strict=True)
    ]
    return "\n".join([",".join(_INSPECTION), *rows]) + "\n"
